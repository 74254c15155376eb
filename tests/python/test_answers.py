# SPDX-License-Identifier: MIT
"""What all answers have in common: pickled and copied they are the same, and none of them is true or false."""
import concurrent.futures
import copy
import multiprocessing
import pickle

import numpy as np
import pytest

import voxtact as vx
from conftest import noise, oblique, placed, random_poses

WAYS = [lambda of: pickle.loads(pickle.dumps(of)), copy.copy, copy.deepcopy]
#: Of each kind, all that is known of it.
MEMBERS = {
    vx.Touch: ("touches", "undecided", "item", "pose", "device_seconds", "seconds", "method", "witness"),
    vx.Count: ("touches", "undecided", "count", "count_exact", "item", "pose", "device_seconds", "seconds", "method", "projection",
                "triangles", "contacts", "contacts_found", "bounds", "labels"),
    vx.Distance: ("lower", "upper", "end", "labels", "item", "pose", "seconds"),
    vx.Area: ("lower", "upper", "end", "labels", "item", "pose", "seconds"),
    vx.Motion: ("touches", "undecided", "toi_lower", "toi_upper", "impacts", "end", "item", "pose", "seconds"),
    vx.Overlap: ("lower", "upper", "end", "inside", "solid_lower", "solid_upper", "bands", "labels", "item", "pose", "seconds"),
    vx.Plan: ("safe", "undecided", "distance", "entries", "paths", "best", "triangles", "triangle_safe",
              "triangle_distance", "area", "safe_area", "left_out", "seconds"),
}


@pytest.fixture(scope="module")
def labelled(head):
    return vx.Scene(head, opacity=[(40, 0), (80, 1)], labels=vx.read_labels(head, names={70: "Cortex", 120: "Skull"}))


@pytest.fixture(scope="module")
def answers(labelled, knife):
    poses = random_poses(6, 1, 100.0)
    return [labelled.count([(knife, poses[:4]), (knife, poses[4:])], triangles=True, contacts=True, bounds=True, labels=True),
            labelled.distance(knife, poses), labelled.distance(knife, poses, labels=["Skull", 70]),
            labelled.motion(knife, poses), labelled.plan((20, 0, 30), avoid=["Skull"], entries=100, triangle_distances=True),
            labelled.area(knife, poses), labelled.area(knife, poses, labels=["Skull", 70]),
            labelled.area(knife, poses, triangles=True), labelled.touch(knife, poses, witness=True, margin=5),
            labelled.overlap(knife, poses), labelled.overlap(knife, poses, labels=["Skull", 70]),
            labelled.overlap(knife, poses, bands=[20, 70])]


def same(a, b):
    assert type(a) is type(b)
    if isinstance(a, np.ndarray):
        assert a.dtype == b.dtype and a.shape == b.shape
        for name in a.dtype.names or [...]:  # of rows NaN is not NaN
            np.testing.assert_array_equal(a[name], b[name])
    else:
        assert a == b


@pytest.mark.parametrize("way", WAYS, ids=["pickle", "copy", "deepcopy"])
def test_a_copy_is_the_same(answers, way):
    assert 0 < answers[0].touches.sum() < 6 and len(answers[0].contacts), "the poses say nothing"
    for answer in answers:
        for found in (way(answer), way(way(answer))):
            assert type(found) is type(answer) and len(found) == len(answer) and repr(found) == repr(answer)
            for name in MEMBERS[type(answer)]:
                same(getattr(found, name), getattr(answer, name))
    same(way(answers[1]).closest, answers[1].closest)
    same(way(answers[7]).triangles, answers[7].triangles)
    for area in (answers[5], way(answers[6])):
        with pytest.raises(vx.NotReadyError, match="triangles=True"):
            area.triangles
    with pytest.raises(vx.NotReadyError, match="no closest points"):
        way(answers[2]).closest
    plan = answers[4]
    assert [way(plan).nearest_name(row) for row in range(len(plan))] == [plan.nearest_name(row) for row in range(len(plan))]


def test_a_copy_has_what_was_looked_at_and_no_scene(scene, knife):
    poses = random_poses(6, 3, 60.0)
    answer = scene.count(knife, poses)
    with pytest.raises(vx.NotReadyError, match=r"pickled or copied answer has no scene: .*count\(contacts=True\)"):
        copy.copy(answer).contacts
    contacts = answer.contacts
    assert len(contacts)
    found = pickle.loads(pickle.dumps(answer))
    same(found.contacts, contacts)
    assert found.contacts_found == answer.contacts_found
    with pytest.raises(vx.NotReadyError, match=r"count\(bounds=True\)"):
        found.bounds
    with pytest.raises(vx.NotReadyError, match="has no counters"):
        found.counters
    plan = scene.plan((20, 0, 30), avoid_opacity="100:0,160:1", entries=42)
    with pytest.raises(vx.NotReadyError, match="triangle_distances=True"):
        copy.copy(plan).triangle_distance


def test_a_deep_copy_keeps_its_numbers(scene, knife):
    answer = scene.distance(knife, placed((0, 0, 300)))
    found = copy.deepcopy(answer)
    before = float(answer.lower[0])
    found.lower[0] = -1
    assert answer.lower[0] == before


def work(number):
    scene = vx.Scene("builtin:head:16", opacity=[(40, 0), (80, 1)], threads=1)
    mesh, pose = vx.read_mesh("builtin:scalpel:300"), placed((0, 0, 50.0 + number), (0, 0, 80))
    return scene.count(mesh, pose), scene.distance(mesh, pose), scene.motion(mesh, pose)


def test_workers_can_return_them():
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as workers:
        for number, (answer, left, way) in enumerate(workers.map(work, range(2))):
            here = work(number)
            same(answer.count, here[0].count)
            same(left.lower, here[1].lower)
            same(way.toi_lower, here[2].toi_lower)


def test_none_is_true_or_false(answers):
    asked = {vx.Count: ".touches", vx.Touch: ".touches", **dict.fromkeys((vx.Distance, vx.Area, vx.Overlap), ".lower and .upper"),
             vx.Motion: ".touches", vx.Plan: ".safe"}
    for answer in [*answers, copy.copy(answers[0])]:
        with pytest.raises(TypeError) as caught:
            bool(answer)
        text = f"a voxtact.{type(answer).__name__} is neither true nor false: it has rows; look at {asked[type(answer)]}"
        assert str(caught.value).startswith(text)


def test_labels_that_no_voxel_has_are_warned_of(labelled, knife, recwarn):
    pose = placed((0, 0, 300))
    labelled.distance(knife, pose, labels=[0, 70, "Skull"])
    labelled.distance(knife, pose, labels=True)
    assert not recwarn.list
    with pytest.warns(UserWarning, match="^labels: no voxel of the label map has the label 254; distances to it are infinite$"):
        left = labelled.distance(knife, pose, labels=[254, 70, 254])
    assert np.isinf(left.lower[0, 0]) and np.isfinite(left.lower[0, 1])
    with pytest.warns(UserWarning, match="has the labels 253, 254; distances to them are infinite") as caught:
        labelled.distance(knife, pose, labels=[254, 253], any_opacity=True)
    assert caught[0].filename == __file__
    with pytest.warns(UserWarning, match="^labels: no voxel of the label map has the label 254; areas in it are 0$") as caught:
        assert labelled.area(knife, pose, labels=[254]).upper.tolist() == [[0]]
    with pytest.warns(UserWarning, match="labels 300, 301, 302, 303, 304, 305, 306, 307, 308, 309 and 2 more; areas in them are 0$"):
        labelled.area(knife, pose, labels=range(300, 312))
    with pytest.warns(UserWarning, match="label 254; areas") as caught:
        labelled.area(knife, pose, labels=[254])
    assert caught[0].filename == __file__


@pytest.mark.parametrize("way", WAYS, ids=["pickle", "copy", "deepcopy"])
def test_a_copy_says_what_the_answer_said_of_what_it_has_not(labelled, knife, way):
    touch = labelled.touch(knife, np.eye(4), margin=1.0)
    for answer in (touch, way(touch), way(way(touch))):
        with pytest.raises(vx.NotReadyError, match=r"no witness points; ask with touch\(witness=True\)"):
            answer.witness


@pytest.mark.parametrize("way", WAYS, ids=["pickle", "copy", "deepcopy"])
def test_a_copy_of_a_volume_and_a_mesh(head, knife, way):
    sheared = np.eye(4)
    sheared[0, 1] = 0.3
    for volume in (head, vx.read_volume(noise(), affine=oblique()), vx.read_volume(noise(), affine=sheared)):
        found = way(volume)
        assert (found.name, found.notes) == (volume.name, volume.notes)
        for name in ("array", "spacing", "origin", "direction", "affine", "range"):
            same(np.asarray(getattr(found, name)), np.asarray(getattr(volume, name)))
    found = way(knife)
    assert (found.name, found.notes) == (knife.name, knife.notes)
    same(found.vertices, knife.vertices)
    same(found.faces, knife.faces)
