# SPDX-License-Identifier: MIT
"""Questions over the workers of a Dask cluster: the answers of one scene."""
import functools

import numpy as np
import pytest

import voxtact as vx
from conftest import random_poses

distributed = pytest.importorskip("dask.distributed")


def scene_of(cells):
    return vx.Scene(f"builtin:head:{cells}", opacity=[(40, 0), (80, 1)], threads=1)


make = functools.partial(scene_of, 30)


@pytest.fixture(scope="module")
def client():
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, \
            distributed.Client(cluster) as client:
        yield client


@pytest.mark.parametrize("question, options, members", [
    ("count", {"contacts": True, "triangles": True}, ("touches", "undecided", "count", "count_exact", "contacts", "triangles", "pose", "item")),
    ("count", {"stop_at_first": True}, ("touches", "count")),
    ("touch", {}, ("touches", "undecided", "pose")),
    ("touch", {"witness": True}, ("touches", "witness")),
    ("overlap", {"bands": [20, 80]}, ("lower", "upper", "bands", "inside")),
    ("distance", {"tolerance": 0.1}, ("lower", "upper", "end", "closest", "pose")),
    ("area", {"triangles": True}, ("lower", "upper", "triangles")),
    ("touch", {"margin": 3}, ("touches", "undecided")),
    ("motion", {"resolution": 0.5}, ("touches", "toi_lower", "impacts", "pose"))])
def test_answers_are_those_of_one_scene(client, knife, question, options, members):
    from voxtact.dask import ask

    poses = random_poses(23, 4, reach=60)
    found = ask(question, make, knife, poses, client, per_task=10, **options)
    expected = getattr(make(), question)(knife, poses, **options)
    assert type(found) is type(expected) and len(found) == len(expected) and repr(found) == repr(expected)
    for name in members:
        a, b = getattr(found, name), getattr(expected, name)
        assert a.dtype == b.dtype and a.shape == b.shape, name
        for field in a.dtype.names or [...]:
            np.testing.assert_array_equal(a[field], b[field])
    assert found.seconds > 0


def test_few_and_none(client, knife):
    from voxtact.dask import ask

    assert len(ask("count", make, knife, np.eye(4), client)) == 1
    assert len(ask("count", make, knife, np.zeros((0, 4, 4)), client, stop_at_first=True)) == 0
    with pytest.raises(vx.InvalidArgumentError, match="question 'picture' is none of touch"):
        ask("picture", make, knife, np.eye(4), client)
    with pytest.raises(vx.NotReadyError, match="contacts=True"):
        ask("count", make, knife, np.eye(4), client).contacts
    wrong = random_poses(5, 1)
    wrong[3, 0, 0] = np.nan
    with pytest.raises(vx.InvalidArgumentError, match="pose 3"):
        ask("count", make, knife, wrong, client)
