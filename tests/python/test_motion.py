# SPDX-License-Identifier: MIT
"""Motions between poses, and poses that may be off: known ways, and that the answers are those of the program."""
import numpy as np
import pytest

import voxtact as vx
from conftest import cube, half_space, placed, program, random_poses


def block():
    """Opaque up to x = 5.5, as in test_detect.py."""
    return vx.Scene(vx.read_volume(half_space(), affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)])


@pytest.fixture(scope="module", params=["head", "ct", "noise"])
def files(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    program("make", "volume", f"builtin:{request.param}:32", "volume.nii.gz", cwd=folder)
    program("make", "volume", f"builtin:{request.param}:24", "labels.nii.gz", cwd=folder)
    program("make", "mesh", "builtin:scalpel:300", "tool.stl", cwd=folder)
    program("make", "poses", "--volume", "volume.nii.gz", "--mesh", "tool.stl", "--number", 25, "--seed", 11, "--output",
            "poses.txt", cwd=folder)
    return folder, {"head": "40:0,80:1", "ct": "0:0,300:1", "noise": "1500:0,2500:1"}[request.param]


@pytest.mark.parametrize("interpolation", ["screw", "slerp"])
def test_motions_are_those_of_the_program(files, interpolation):
    folder, opacity = files
    rows = program("motion", "--volume", "volume.nii.gz", "--mesh", "tool.stl", "--poses", "poses.txt", "--opacity", opacity,
                   "--labels", "labels.nii.gz", "--interpolation", interpolation, "--resolution-mm", 0.1, cwd=folder)
    scene = vx.Scene(folder / "volume.nii.gz", opacity=opacity, labels=folder / "labels.nii.gz")
    found = scene.motion(vx.read_mesh(folder / "tool.stl"), vx.read_poses(folder / "poses.txt"), interpolation=interpolation,
                         resolution=0.1)
    assert len(found) == len(rows) == 24
    assert found.hit.any(), "the poses say nothing"
    assert np.where(found.hit, 1, np.where(found.possible, 2, 0)).tolist() == [int(row["hit"]) for row in rows]
    np.testing.assert_allclose(found.free_until, [float(row["free_until"]) for row in rows], rtol=1e-9)
    at = [float(row["touch_at"] or "nan") for row in rows]
    np.testing.assert_allclose(found.touch_at, at, rtol=1e-9)
    np.testing.assert_array_equal(np.isnan(found.touch_at), ~found.hit)
    places = [[float(row[axis] or "nan") for axis in "xyz"] for row in rows]
    np.testing.assert_allclose(found.touches["position"], places, atol=2e-6)
    assert found.touches["triangle"].tolist() == [int(row["triangle"] or -1) for row in rows]
    assert found.touches["label"].tolist() == [int(row["label"] or 0) for row in rows]
    assert found.touches["label"].any()


def test_poses_that_may_be_off_are_those_of_the_program(files):
    folder, opacity = files
    rows = program("detect", "--volume", "volume.nii.gz", "--mesh", "tool.stl", "--poses", "poses.txt", "--opacity", opacity,
                   "--pose-tolerance", "3,5", cwd=folder)
    scene = vx.Scene(folder / "volume.nii.gz", opacity=opacity)
    asked = vx.read_mesh(folder / "tool.stl"), vx.read_poses(folder / "poses.txt")
    answer = scene.around(*asked, distance=3, angle=5)
    assert np.where(answer.hit, 1, np.where(answer.possible, 2, 0)).tolist() == [int(row["hit"]) for row in rows]
    touching = scene.detect(*asked).hit
    assert not (touching & ~answer.hit).any(), "what touches as it is"
    with pytest.raises(vx.NotReadyError, match=r"around\(\) have no contacts"):
        answer.contacts


def test_a_straight_way():
    """A cube of 2 mm from x = 20 to x = 6: it touches where its side is at 5.5, and x at 6.5."""
    found = block().motion(cube(), placed((20, 4, 4), (6, 4, 4), (20, 4, 4), (21, 4, 4)), resolution=0.01)
    assert found.hit.tolist() == [True, True, False] and not found.possible.any()
    first = (20 - 6.5) / 14
    assert first - 0.02 / 14 < found.free_until[0] < found.touch_at[0] < first + 0.02 / 14
    assert 14 * (found.touch_at[0] - found.free_until[0]) <= 0.01
    assert found.touches["position"][0, 0] == pytest.approx(5.5, abs=0.02)
    assert found.touch_at[1] == 0 and found.free_until[1] == 0, "it begins with a touch"
    assert found.free_until[2] == 1 and np.isnan(found.touches["position"][2]).all()
    assert found.touches["triangle"][2] == -1 and np.isnan(found.touches["world_from_object"][2]).all()
    assert found.end.tolist() == ["decided"] * 3
    assert repr(found) == "<voxtact.Motion: 2 of 3 segments touch; the first in segment 0>"


def test_the_pose_of_a_touch_touches():
    """At the parameter that is said it is pose_between(), and detect() says the same of it."""
    scene, mesh = block(), cube()
    poses = random_poses(40, 3, reach=12)
    poses[:, 0, 3] += 9
    for interpolation in ("screw", "slerp"):
        found = scene.motion(mesh, poses, interpolation=interpolation)
        assert 5 < found.hit.sum() < 39
        for segment in np.flatnonzero(found.hit):
            touch = found.touches[segment]
            between = vx.pose_between(poses[segment], poses[segment + 1], touch["at"], interpolation=interpolation,
                                      mesh=mesh)
            np.testing.assert_allclose(touch["world_from_object"], between, atol=1e-9)
        assert scene.detect(mesh, found.touches["world_from_object"][found.hit]).hit.all()
        for segment in np.flatnonzero(found.free_until > 0):
            way = vx.pose_between(poses[segment], poses[segment + 1], np.linspace(0, found.free_until[segment], 9),
                                  interpolation=interpolation, mesh=mesh)
            assert not scene.detect(mesh, way).hit.any(), "free is free"


def test_poses_between():
    first, second = placed((0, 0, 0), (10, 0, 0))
    np.testing.assert_allclose(vx.pose_between(first, second, 0.3)[:3, 3], [3, 0, 0], atol=1e-12)
    assert vx.pose_between(first, second, [0, 0.5, 1]).shape == (3, 4, 4)
    np.testing.assert_array_equal(vx.pose_between(first, second, 1), second)
    half_turn = np.diag([-1.0, -1, 1, 1])
    turned = vx.pose_between(first, half_turn, 0.5)
    np.testing.assert_allclose(np.abs(turned[:3, :3]), [[0, 1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)
    for wrong, text in ((dict(at=1.5), "outside of 0 to 1"), (dict(at=[[0]]), "at has the shape"),
                        (dict(at=0, interpolation="slerp"), "slerp needs mesh="),
                        (dict(at=0, interpolation="straight"), "interpolation 'straight' is none of screw, slerp")):
        with pytest.raises(vx.InvalidArgumentError, match=text):
            vx.pose_between(first, second, **wrong)
    with pytest.raises(vx.InvalidArgumentError, match="rigid"):
        vx.pose_between(first, 2 * second + np.diag([0, 0, 0, -1]), 0.5)


def test_a_pose_that_may_be_off():
    """The cube's middle is 3.5 mm from what is opaque: moved it is 1 mm nearer, turned its corners reach 1.73 mm."""
    scene, poses = block(), placed((9, 4, 4))
    for distance, angle, hit in ((2, 0, False), (2.6, 0, True), (2, 90, True), (1.7, 90, False), (0, 180, False)):
        answer = scene.around(cube(), poses, distance=distance, angle=angle)
        assert (answer.hit[0], answer.possible[0]) == (hit, False), (distance, angle)


def test_several_meshes_and_pieces(scene, knife):
    small = cube(10)
    a, b = random_poses(400, 5), random_poses(31, 6)
    told = []
    both = scene.motion([(knife, a), (small, b)], resolution=0.5, progress=lambda *way: told.append(way))
    assert len(both) == 399 + 30 and told[-1] == (429, 429) and len(told) >= 2
    assert both.item.tolist() == [0] * 399 + [1] * 30
    assert both.pose.tolist() == list(range(399)) + list(range(30))
    one, other = scene.motion(knife, a, resolution=0.5), scene.motion(small, b, resolution=0.5)
    np.testing.assert_array_equal(both.free_until, np.concatenate([one.free_until, other.free_until]))
    for name in both.touches.dtype.names:
        np.testing.assert_array_equal(both.touches[name], np.concatenate([one.touches[name], other.touches[name]]))
    around = scene.around([(knife, a[:3]), (small, b[:2])], distance=1, angle=1)
    assert len(around) == 5 and around.item.tolist() == [0, 0, 0, 1, 1]


def test_what_is_refused(scene, knife):
    for poses in (np.eye(4), placed((1, 2, 3)), np.empty((0, 4, 4))):
        with pytest.raises(vx.InvalidArgumentError, match="a motion needs two or more"):
            scene.motion(knife, poses)
    with pytest.raises(vx.InvalidArgumentError, match="item 1: .* needs two or more"):
        scene.motion([(knife, random_poses(3, 1)), (knife, np.eye(4))])
    scaled = random_poses(400, 2)
    scaled[390, :3, :3] *= 1.5
    with pytest.raises(vx.InvalidArgumentError, match="^poses 389 and 390: .*rigid"):
        scene.motion(knife, scaled)
    poses = random_poses(2, 1)
    for wrong in (dict(resolution=0), dict(resolution=np.nan), dict(most_steps=0), dict(interpolation="straight")):
        with pytest.raises(vx.InvalidArgumentError):
            scene.motion(knife, poses, **wrong)
    for wrong in (dict(distance=-1, angle=0), dict(distance=0, angle=181), dict(distance=np.inf, angle=0)):
        with pytest.raises(vx.InvalidArgumentError):
            scene.around(knife, poses, **wrong)
    with pytest.raises(TypeError, match="poses are missing"):
        scene.motion(knife)


def test_a_graze_and_a_budget(scene):
    """Along a face, a hundredth of a millimetre beside it, with a coarser resolution; and with a single step."""
    side = block()
    graze = side.motion(cube(), placed((6.505, 2, 4), (6.505, 6, 4)), resolution=1)
    assert not graze.possible.any() and graze.free_until[0] == 1
    poor = side.motion(cube(), placed((20, 4, 4), (6, 4, 4)), most_steps=1)
    assert poor.possible.tolist() == [True] and poor.end.tolist() == ["budget"] and poor.free_until[0] < 1


def test_plots_and_arrays(scene, knife):
    found = scene.motion(knife, random_poses(9, 14), resolution=1)
    np.from_dlpack(found.free_until)
    assert found.touches.dtype.names == ("at", "triangle", "position", "label", "world_from_object")
    assert found.touches.dtype["world_from_object"].shape == (4, 4) and found.seconds > 0
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert found.plot().get_xlabel() == "segment"
