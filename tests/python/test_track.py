# SPDX-License-Identifier: MIT
"""A mesh that moves by little, distances to labels at any opacity, and counters of a device."""
import pickle

import numpy as np
import pytest

import voxtact as vx
from conftest import cube, half_space, placed, random_poses


def wall():
    """Opaque where x is less than 5.5 mm (the middle between 200 and 0 is half opaque); a voxel is 1 mm."""
    volume = vx.read_volume(half_space(shape=(40, 40, 40)), axes="zyx", affine=np.eye(4), space="lps")
    return vx.Scene(volume, opacity=[(99, 0), (101, 1)], threshold=0.5)


def test_a_tracker_says_at_each_pose_what_touch_and_distance_say():
    scene, mesh = wall(), cube()
    tracker = scene.tracker(mesh)
    searched = []
    for x in np.arange(25.0, 4.0, -0.05):
        pose = placed((x, 20, 20))[0]
        found = tracker.update(pose)
        assert isinstance(found, vx.Tracked) and found.lower <= found.upper
        assert found.touches == scene.touch(mesh, pose).touches[0], x
        assert found.free == (not (found.touches or found.undecided))
        true = scene.distance(mesh, pose)
        assert found.lower <= true.upper[0] and found.upper >= true.lower[0], x
        searched.append(found.searched)
    assert found.touches and found.lower == found.upper == 0
    assert 1 < sum(searched) < len(searched) / 3, "most answers need no look"


def test_a_tracker_sees_changes_of_the_scene():
    scene = wall()
    tracker, near = scene.tracker(cube()), placed((9, 20, 20))[0]
    assert tracker.update(near).free and not tracker.update(near).searched
    scene.edit(ball=(9, 20, 20, 2), value=200)
    assert tracker.update(near).touches
    scene.opacity = [(249, 0), (251, 1)]
    assert tracker.update(near).free
    scene.opacity = [(99, 0), (101, 1)]
    scene.threshold = 1.0
    assert tracker.update(near).touches
    scene.close()
    with pytest.raises(vx.NotReadyError, match="closed"):
        tracker.update(near)


def test_what_a_tracker_refuses(scene, knife):
    tracker = scene.tracker(knife, max=50, resolution=1 / 8, max_steps=100)
    assert repr(tracker) == f"<voxtact.Tracker of {knife.name!r}>" and tracker.mesh is knife
    before = tracker.update(placed((0, 0, 300))[0])
    bad = np.eye(4)
    bad[0, 0] = np.nan
    for pose, text in ((bad, "not finite"), (np.eye(3), "shape"), (np.zeros((2, 4, 4)), "shape"), (np.ones((4, 4)), "0 0 0 1")):
        with pytest.raises(vx.InvalidArgumentError, match=text):
            tracker.update(pose)
    assert tracker.update(placed((0, 0, 300))[0])[:4] == before[:4]
    for wrong in ({"max": 0}, {"max": np.nan}, {"resolution": 0}, {"resolution": 2}, {"max_steps": 0},
                  {"max_steps": -1}):
        with pytest.raises(vx.InvalidArgumentError):
            scene.tracker(knife, **wrong)
    with pytest.raises(TypeError, match="read_mesh"):
        scene.tracker("tool.stl")
    with pytest.raises(TypeError, match="voxtact.Tracker cannot be pickled"):
        pickle.dumps(tracker)


def test_a_tracker_keeps_its_scene(head, knife):
    tracker = vx.Scene(head, opacity=[(40, 0), (80, 1)]).tracker(knife)
    assert tracker.update(placed((0, 0, 0))[0]).touches


def test_labels_at_any_opacity():
    labels = vx.read_labels(vx.read_volume(np.where(np.arange(40) >= 20, 4, 0)[None, None, :].astype(np.uint8).repeat(40, 0).repeat(40, 1),
                                           axes="zyx", affine=np.eye(4), space="lps"))
    volume = vx.read_volume(half_space(shape=(40, 40, 40)), axes="zyx", affine=np.eye(4), space="lps")
    scene = vx.Scene(volume, opacity=[(99, 0), (101, 1)], labels=labels)
    pose = placed((12, 20, 20))  # the cube ends at 13, and voxel 20 begins at 19.5
    opaque = scene.distance(cube(), pose, labels=[4])
    assert opaque.lower[0, 0] == np.inf, "nothing of the label is opaque"
    every = scene.distance(cube(), pose, labels=[4], any_opacity=True)
    assert every.lower[0, 0] <= 6.5 <= every.upper[0, 0] + 1e-9 and every.upper[0, 0] - every.lower[0, 0] <= 0.01
    assert scene.distance(cube(), pose, labels=[4]).lower[0, 0] == np.inf, "the one is not taken for the other"
    with pytest.raises(vx.InvalidArgumentError, match="give labels="):
        scene.distance(cube(), pose, any_opacity=True)
    with pytest.raises(TypeError, match="labels is a str; a sequence is needed"):
        scene.distance(cube(), pose, labels="4")
    with pytest.raises(TypeError, match="labels is a dict_like; a sequence is needed"):
        scene.distance(cube(), pose, labels=type("dict_like", (), {"__getitem__": lambda self, key: {}[key]})())


def test_counters_are_a_devices(device, head, knife):
    there = vx.Scene(head, opacity=[(40, 0), (80, 1)], device=device)
    poses = random_poses(40, 31)
    answer = there.count(knife, poses, counters=True)
    counters = answer.counters
    assert isinstance(counters, vx.Counters)
    np.testing.assert_array_equal(answer.count, there.count(knife, poses).count)
    # Clusters of 64 triangles: 300 of them are 5, once for each pose.
    assert counters.clusters == 5 * len(poses) and 0 < counters.clusters_kept <= counters.clusters
    assert counters.cells_listed <= counters.cells_seen and counters.rounds >= 1 and counters.room > 0
    assert counters.peak_clusters <= counters.clusters_kept
    # Pieces add up: those of each half are those of all.
    halves = [there.count(knife, half, counters=True).counters for half in (poses[:20], poses[20:])]
    for name in ("clusters", "clusters_kept", "runs_kept", "cells_seen", "cells_listed"):
        assert sum(getattr(half, name) for half in halves) == getattr(counters, name), name
    with pytest.raises(vx.NotReadyError, match=r"count\(counters=True\)"):
        there.count(knife, poses[:1]).counters
    with pytest.raises(vx.UnsupportedError, match="device="):
        vx.Scene(head).count(knife, poses[:1], counters=True)
    with pytest.raises(vx.InvalidArgumentError):
        there.count(knife, poses[:1], counters=True, projection="view")
