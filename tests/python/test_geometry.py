# SPDX-License-Identifier: MIT
"""Boxes, lines through labels, lists of points, and what methods are worth."""
import itertools

import numpy as np
import pytest

import voxtact as vx
from conftest import cube, half_space, placed, random_poses


def share_a_point(a, b):
    return (a[0] <= b[1]).all() and (b[0] <= a[1]).all()


def test_overlapping_pairs_are_those_that_share_a_point():
    generator = np.random.default_rng(11)
    boxes = np.sort(generator.integers(0, 12, (60, 2, 3)), axis=1)  # whole numbers: many only touch
    expected = [(i, j) for i, j in itertools.combinations(range(60), 2) if share_a_point(boxes[i], boxes[j])]
    found = vx.overlapping_pairs(boxes)
    assert found.dtype == np.uint32 and 0 < len(expected) < 1770
    np.testing.assert_array_equal(found, expected)
    between = vx.overlapping_pairs(boxes[:20], boxes[20:])
    np.testing.assert_array_equal(between, [(i, j) for i in range(20) for j in range(40)
                                            if share_a_point(boxes[i], boxes[20 + j])])
    assert vx.overlapping_pairs(np.zeros((0, 2, 3))).shape == (0, 2)
    for wrong in (np.zeros((2, 3)), np.zeros((2, 3, 2)), 5):
        with pytest.raises(vx.InvalidArgumentError, match=r"\(N,2,3\)"):
            vx.overlapping_pairs(wrong)


def test_the_broad_phase_leaves_out_only_what_does_not_touch(scene, head, knife):
    poses = random_poses(200, 12, reach=300)
    near = vx.overlapping_pairs(knife.boxes_at(poses), [head.bounds])[:, 0]
    hit = scene.touch(knife, poses).touches
    assert hit.any() and len(near) < 200
    assert set(np.flatnonzero(hit)) <= set(near)
    np.testing.assert_array_equal(scene.touch(knife, poses[near]).touches, hit[near])


def test_boxes_hold_the_vertices(knife):
    poses = random_poses(5, 13)
    boxes = knife.boxes_at(poses)
    assert boxes.shape == (5, 2, 3)
    np.testing.assert_array_equal(knife.boxes_at(poses[0]), boxes[:1])
    lo, hi = knife.bounds
    corners = np.array([[*corner, 1] for corner in itertools.product(*zip(lo, hi))])
    for pose, box in zip(poses, boxes):
        world = (corners @ pose.T)[:, :3]
        np.testing.assert_allclose(box, [world.min(axis=0), world.max(axis=0)], atol=1e-9)
    with pytest.raises(vx.InvalidArgumentError, match="pose 1"):
        knife.boxes_at(np.stack([np.eye(4), np.full((4, 4), np.nan)]))


def test_the_bounds_of_a_volume_are_its_outermost_faces():
    volume = vx.read_volume(half_space(), axes="zyx", affine=np.diag([0.5, 1, 2, 1]), space="lps")
    np.testing.assert_allclose(volume.bounds, [[-0.25, -0.5, -1], [5.75, 9.5, 15]], atol=1e-12)


def test_labels_along_a_line():
    voxels = np.zeros((3, 3, 8), dtype=np.uint8)
    voxels[:, :, 2:4], voxels[:, :, 5], voxels[:, :, 6:] = 7, 3, 7
    labels = vx.read_labels(voxels, axes="zyx", affine=np.eye(4), space="lps")
    assert labels.along((-9, 1, 1), (20, 1, 1)).tolist() == [7, 3]
    assert labels.along((20, 1, 1), (-9, 1, 1)).tolist() == [7, 3]
    assert labels.along((5, 1, 1), (-9, 1, 1)).tolist() == [3, 7]
    assert labels.along((0, 0, 1), (1, 2, 1)).tolist() == [] and labels.along((5, 0, 0), (5, 2, 2)).dtype == np.int32
    for wrong, text in (((0, 1), r"start.*\(3,\)"), ((np.nan, 0, 0), "finite")):
        with pytest.raises(vx.InvalidArgumentError, match=text):
            labels.along(wrong, (1, 1, 1))


def test_lists_of_points(tmp_path):
    (tmp_path / "targets.txt").write_text("# mm\n1 2 3\n-4.5 5 6 tip\n")
    positions, names = vx.read_points(tmp_path / "targets.txt")
    np.testing.assert_array_equal(positions, [[1, 2, 3], [-4.5, 5, 6]])
    assert names == ("", "tip")
    (tmp_path / "targets.txt").write_text("1 2\n")
    with pytest.raises(vx.FormatError, match="line 1"):
        vx.read_points(tmp_path / "targets.txt")


def test_what_methods_are_worth(device):
    tested = device.self_test()
    assert list(tested) == list(device.methods)
    for name, why in device.methods.items():
        assert tested[name].available == (why is None) and tested[name].text
    assert tested["compute"].trusted and "46 operations" in tested["compute"].text
    assert device.methods[device.default_method] is None
    scene = vx.Scene("builtin:head:16", opacity=[(40, 0), (80, 1)], device=device)
    answer = scene.count(cube(20), placed((0, 0, 80)), projection="view")
    assert answer.method == device.default_method
    assert scene.count(cube(20), placed((0, 0, 80)), projection="view", method="auto").method == answer.method
    assert scene.count(cube(20), placed((0, 0, 80)), method="auto").method == "compute"
    on_host = vx.Scene("builtin:head:16", opacity=[(40, 0), (80, 1)])
    assert on_host.count(cube(20), placed((0, 0, 80)), projection="view", method="auto").method == "cpu"
