# SPDX-License-Identifier: MIT
"""Questions by their names: `Scene.ask` answers like the methods, and lists what can be asked."""
import copy
import pickle
import warnings

import numpy as np
import pytest

import voxtact as vx
from conftest import random_poses

NAMES = ("touch", "count", "distance", "area", "overlap", "motion")
#: Settings, and arguments of the method where they differ.
ASKED = [("touch", {}, {}), ("touch", {"margin": 3, "witness": True}, {}),
         ("touch", {"uncertainty_distance": 1, "uncertainty_angle": 2}, {"uncertainty": (1, 2)}), ("touch", {"solid": True}, {}),
         ("count", {"projection": "certified"}, {"projection": "certified"}), ("count", {}, {"projection": "view"}),
         ("count", {"projection": "dominant-axis", "samples_per_voxel": 2}, {}), ("distance", {"tolerance": 0.1, "max": 40}, {}),
         ("area", {"tolerance": 0.5}, {}), ("overlap", {}, {}), ("motion", {"interpolation": "slerp", "resolution": 0.5}, {})]


@pytest.fixture(scope="module")
def labelled(head):
    return vx.Scene(head, opacity=[(40, 0), (80, 1)], labels=vx.read_labels(head, names={70: "Cortex", 120: "Skull"}))


@pytest.fixture(autouse=True, scope="module")
def in_small_pieces():
    """The first piece is small; so is each later one."""
    from voxtact import _engine

    before, _engine._MAX_HOST_PAIRS = _engine._MAX_HOST_PAIRS, 7
    yield
    _engine._MAX_HOST_PAIRS = before


def by_method(scene, question, *where, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return getattr(scene, question)(*where, **options)


def same(rows, others):
    for name in rows.dtype.names:
        np.testing.assert_array_equal(rows[name], others[name])


@pytest.mark.parametrize("question, settings, others", ASKED)
def test_answers_are_those_of_the_methods(labelled, knife, question, settings, others):
    poses = random_poses(25, 4, reach=60)
    answer = labelled.ask(question, knife, poses, **settings)
    expected = by_method(labelled, question, knife, poses, **(others if "uncertainty" in others else {**settings, **others}))
    assert answer.question == question and answer.tables[-1] == "totals" and answer.seconds > 0
    rows = answer["segments" if question == "motion" else "pairs"]
    assert len(answer) == len(rows) == len(expected) == 25 - (question == "motion")
    for name in ("item", "pose"):
        assert rows[name].tolist() == getattr(answer, name).tolist() == getattr(expected, name).tolist()
    if "touch" in rows.dtype.names:
        assert (rows["touch"] == 1).tolist() == expected.touches.tolist()
        assert (rows["touch"] == 2).tolist() == expected.undecided.tolist()
    for name in ("lower", "upper", "count", "solid_lower", "toi_lower", "toi_upper"):
        if name in rows.dtype.names:
            np.testing.assert_array_equal(rows[name], getattr(expected, name))
    assert len(answer["totals"]) == 1 and answer["totals"]["wall_milliseconds"][0] == pytest.approx(1000 * answer.seconds)


def test_other_tables(labelled, knife):
    poses = random_poses(25, 4, reach=60)
    items = [(knife, poses[:10]), (knife, poses[:0]), (knife, poses[10:])]
    count = labelled.ask("count", items, projection="certified", triangles=True, contacts=np.True_, bounds=1, labels=True)
    expected = labelled.count(items, triangles=True, contacts=True, labels=True)
    assert count.tables == ("pairs", "triangles", "contacts", "bounds", "labels", "totals")
    for name in ("triangles", "contacts", "labels"):
        same(count[name], getattr(expected, name))
    assert len(count["contacts"]) == count["totals"]["contacts_found"][0] and len(count["bounds"]) == 25
    assert set(count["pairs"]["item"]) == {0, 2} and count["pairs"]["pose"].tolist() == [*range(10), *range(15)]
    cut = labelled.ask("count", items, projection="certified", contacts=True, max_contacts=20)["contacts"]
    assert len(cut) == 20
    overlap, limits = labelled.ask("overlap", items, bands=[20, 60]), [-np.inf, 20, 60, np.inf]
    bands = overlap["bands"].reshape(25, 3)
    assert (bands["pair"] == np.arange(25)[:, None]).all() and (bands["pose"] == overlap.pose[:, None]).all()
    assert (bands["from"] == limits[:-1]).all() and (bands["below"] == limits[1:]).all()
    np.testing.assert_array_equal(bands["lower"], labelled.overlap(items, bands=[20, 60]).lower)
    for question in ("distance", "area", "overlap"):
        answer, expected = (ask(items, labels=["Skull", 70]) for ask in (
            lambda mesh, **settings: labelled.ask(question, mesh, **settings), getattr(labelled, question)))
        rows = answer["labels"].reshape(25, 2)
        assert (rows["label"] == [120, 70]).all() and (rows["item"] == answer.item[:, None]).all()
        np.testing.assert_array_equal(rows["upper"], expected.upper)
        assert len(answer) == 25
    segments = labelled.ask("motion", [(knife, poses[:10]), (knife, poses[10:])])["segments"]
    assert segments["pose"].tolist() == [*range(9), *range(14)] and segments["item"].tolist() == [0] * 9 + [1] * 14


@pytest.mark.parametrize("way", [lambda of: pickle.loads(pickle.dumps(of)), copy.copy, copy.deepcopy],
                         ids=["pickle", "copy", "deepcopy"])
def test_a_copy_is_the_same(labelled, knife, way):
    for question in NAMES:
        answer = labelled.ask(question, knife, random_poses(9, 1))
        for found in (way(answer), way(way(answer))):
            assert repr(found) == repr(answer) and found.tables == answer.tables and len(found) == len(answer)
            for table in answer.tables:
                assert found[table].dtype == answer[table].dtype
                same(found[table], answer[table])
    assert repr(labelled.ask("area", knife, np.eye(4))) == "<voxtact.Answer: area, 1 rows; tables pairs, triangles, labels, totals>"
    with pytest.raises(TypeError, match="neither true nor false"):
        bool(answer)
    with pytest.raises(TypeError, match="makes one"):
        vx.Answer([])
    with pytest.raises(vx.InvalidArgumentError, match="table 'pairs' is none of segments, totals"):
        answer["pairs"]


def test_all_that_can_be_asked(labelled, knife):
    assert tuple(one.name for one in vx.questions()) == NAMES and all(one.text for one in vx.questions())
    for question in NAMES:
        found = vx.settings(question)
        assert all(one.text and one.range and one.kind for one in found)
        defaults = {one.name: one.default for one in found}
        poses = random_poses(3, 1)
        answer, expected = labelled.ask(question, knife, poses, **defaults), labelled.ask(question, knife, poses)
        same(answer[answer.tables[0]], expected[answer.tables[0]])
    (tolerance, *_) = vx.settings("distance")
    assert tolerance[:4] == ("tolerance", "number", 0.01, "mm") and "1e-06" in tolerance.range
    (projection, *_) = vx.settings("count")
    assert projection[:3] == ("projection", "choice", "view") and "dominant-axis" in projection.range
    with pytest.raises(vx.InvalidArgumentError, match="question 'nothing' is none of touch, count"):
        vx.settings("nothing")


def test_the_library_refuses(labelled, scene, knife):
    pose = np.eye(4)
    for question, settings, text in (
            ("nothing", {}, "there is no question 'nothing'; there are touch, count"),
            ("nothing", {"tolerance": "x"}, "there is no question"), ("plan", {}, "there is no question 'plan'"),
            ("distance", {"nothing": [1]}, "distance has no setting 'nothing'; it has .*tolerance"),
            ("distance", {"tolerance": 0}, "tolerance 0 mm is not a number from"),
            ("area", {"max_steps": 0}, "max_steps is 0; a whole number from 1 to"),
            ("count", {"projection": "sideways"}, "'sideways'; it is one of view"),
            ("touch", {"solid": 2}, "solid.* 2.* 0 or 1"), ("overlap", {"bands": [3, 2]}, "band")):
        with pytest.raises(vx.InvalidArgumentError, match=text):
            labelled.ask(question, knife, pose, **settings)
    for question, settings in (("distance", {"tolerance": "fine"}), ("distance", {"tolerance": True}), ("area", {"max_steps": 1.5}),
                               ("touch", {"solid": "yes"}), ("overlap", {"bands": "1,2"}), ("distance", {"labels": "Skull"}), (3, {}),
                               ("count", {"projection": 3})):
        with pytest.raises(TypeError):
            labelled.ask(question, knife, pose, **settings)
    with pytest.raises(vx.InvalidArgumentError, match="^labels need a scene with labels="):
        scene.ask("distance", knife, pose, labels=[1])
    with pytest.raises(vx.InvalidArgumentError, match="a motion needs two or more"):
        scene.ask("motion", knife, pose)
    with pytest.raises(vx.InvalidArgumentError, match="^pose 1: "):
        scene.ask("area", knife, np.stack([pose, np.full((4, 4), np.nan)]))
    assert len(scene.ask("distance", knife, [])) == len(scene.ask("distance", [])) == 0


def test_progress(scene, knife):
    told = []
    scene.ask("motion", knife, random_poses(20, 1), progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (19, 19) and len(told) > 1
