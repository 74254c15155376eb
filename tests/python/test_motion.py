# SPDX-License-Identifier: MIT
"""Motions between poses, and poses that may be off: known ways, and that the answers are those of the program."""
import numpy as np
import pytest

import voxtact as vx
from conftest import cube, half_space, placed, program, random_poses


def block():
    """Opaque up to x = 5.5, as in test_touch.py."""
    return vx.Scene(vx.read_volume(half_space(), axes="zyx", affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)])


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
                   "--labels", "labels.nii.gz", "--interpolation", interpolation, "--resolution", 0.1, cwd=folder)
    scene = vx.Scene(folder / "volume.nii.gz", opacity=opacity, labels=folder / "labels.nii.gz")
    found = scene.motion(vx.read_mesh(folder / "tool.stl"), vx.read_poses(folder / "poses.txt"), interpolation=interpolation,
                         resolution=0.1)
    assert len(found) == len(rows) == 24
    assert found.touches.any(), "the poses say nothing"
    assert np.where(found.touches, 1, np.where(found.undecided, 2, 0)).tolist() == [int(row["touch"]) for row in rows]
    np.testing.assert_allclose(found.toi_lower, [float(row["toi_lower"]) for row in rows], rtol=1e-9)
    at = [float(row["toi_upper"] or "nan") for row in rows]
    np.testing.assert_allclose(found.toi_upper, at, rtol=1e-9)
    np.testing.assert_array_equal(np.isnan(found.toi_upper), ~found.touches)
    places = [[float(row[axis] or "nan") for axis in "xyz"] for row in rows]
    np.testing.assert_allclose(found.impacts["position"], places, atol=2e-6)
    assert found.impacts["triangle"].tolist() == [int(row["triangle"] or -1) for row in rows]
    assert found.impacts["label"].tolist() == [int(row["label"] or 0) for row in rows]
    assert found.impacts["label"].any()


def test_poses_that_may_be_off_are_those_of_the_program(files):
    folder, opacity = files
    rows = program("touch", "--volume", "volume.nii.gz", "--mesh", "tool.stl", "--poses", "poses.txt", "--opacity", opacity,
                   "--uncertainty", "3,5", cwd=folder)
    scene = vx.Scene(folder / "volume.nii.gz", opacity=opacity)
    asked = vx.read_mesh(folder / "tool.stl"), vx.read_poses(folder / "poses.txt")
    answer = scene.touch(*asked, uncertainty=(3, 5))
    assert np.where(answer.touches, 1, np.where(answer.undecided, 2, 0)).tolist() == [int(row["touch"]) for row in rows]
    touching = scene.count(*asked).touches
    assert not (touching & ~answer.touches).any(), "what touches as it is"


def test_a_straight_way():
    """A cube of 2 mm from x = 20 to x = 6: it touches where its side is at 5.5, and x at 6.5."""
    found = block().motion(cube(), placed((20, 4, 4), (6, 4, 4), (20, 4, 4), (21, 4, 4)), resolution=0.01)
    assert found.touches.tolist() == [True, True, False] and not found.undecided.any()
    first = (20 - 6.5) / 14
    assert first - 0.02 / 14 < found.toi_lower[0] < found.toi_upper[0] < first + 0.02 / 14
    assert 14 * (found.toi_upper[0] - found.toi_lower[0]) <= 0.01
    assert found.impacts["position"][0, 0] == pytest.approx(5.5, abs=0.02)
    assert found.toi_upper[1] == 0 and found.toi_lower[1] == 0, "it begins with a touch"
    assert found.toi_lower[2] == 1 and np.isnan(found.impacts["position"][2]).all()
    assert found.impacts["triangle"][2] == -1 and np.isnan(found.impacts["world_from_object"][2]).all()
    assert found.end.tolist() == ["decided"] * 3
    assert repr(found) == "<voxtact.Motion: 2 of 3 segments touch; the first in segment 0>"


def test_the_pose_of_a_touch_touches():
    """At the parameter that is said it is pose_between(), and count() says the same of it."""
    scene, mesh = block(), cube()
    poses = random_poses(40, 3, reach=12)
    poses[:, 0, 3] += 9
    for interpolation in ("screw", "slerp"):
        found = scene.motion(mesh, poses, interpolation=interpolation)
        assert 5 < found.touches.sum() < 39
        for segment in np.flatnonzero(found.touches):
            touch = found.impacts[segment]
            between = vx.pose_between(poses[segment], poses[segment + 1], touch["at"], interpolation=interpolation,
                                      mesh=mesh)
            np.testing.assert_allclose(touch["world_from_object"], between, atol=1e-9)
        assert scene.count(mesh, found.impacts["world_from_object"][found.touches]).touches.all()
        for segment in np.flatnonzero(found.toi_lower > 0):
            way = vx.pose_between(poses[segment], poses[segment + 1], np.linspace(0, found.toi_lower[segment], 9),
                                  interpolation=interpolation, mesh=mesh)
            assert not scene.count(mesh, way).touches.any(), "free is free"


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
        answer = scene.touch(cube(), poses, uncertainty=(distance, angle))
        assert (answer.touches[0], answer.undecided[0]) == (hit, False), (distance, angle)


def test_several_meshes_and_pieces(scene, knife):
    small = cube(10)
    a, b = random_poses(400, 5), random_poses(31, 6)
    told = []
    both = scene.motion([(knife, a), (small, b)], resolution=0.5, progress=lambda *way: told.append(way))
    assert len(both) == 399 + 30 and told[-1] == (429, 429) and len(told) >= 2
    assert both.item.tolist() == [0] * 399 + [1] * 30
    assert both.pose.tolist() == list(range(399)) + list(range(30))
    one, other = scene.motion(knife, a, resolution=0.5), scene.motion(small, b, resolution=0.5)
    np.testing.assert_array_equal(both.toi_lower, np.concatenate([one.toi_lower, other.toi_lower]))
    for name in both.impacts.dtype.names:
        np.testing.assert_array_equal(both.impacts[name], np.concatenate([one.impacts[name], other.impacts[name]]))
    around = scene.touch([(knife, a[:3]), (small, b[:2])], uncertainty=(1, 1))
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
    for wrong in (dict(resolution=0), dict(resolution=np.nan), dict(max_steps=0), dict(interpolation="straight")):
        with pytest.raises(vx.InvalidArgumentError):
            scene.motion(knife, poses, **wrong)
    for wrong in ((-1, 0), (0, 181), (np.inf, 0), (1, 2, 3)):
        with pytest.raises(vx.InvalidArgumentError):
            scene.touch(knife, poses, uncertainty=wrong)
    with pytest.raises(TypeError, match="poses are missing"):
        scene.motion(knife)


def test_a_graze_and_a_budget(scene):
    """Along a face, a hundredth of a millimetre beside it, with a coarser resolution; and with a single step."""
    side = block()
    graze = side.motion(cube(), placed((6.505, 2, 4), (6.505, 6, 4)), resolution=1)
    assert not graze.undecided.any() and graze.toi_lower[0] == 1
    poor = side.motion(cube(), placed((20, 4, 4), (6, 4, 4)), max_steps=1)
    assert poor.undecided.tolist() == [True] and poor.end.tolist() == ["budget"] and poor.toi_lower[0] < 1


def test_plots_and_arrays(scene, knife):
    found = scene.motion(knife, random_poses(9, 14), resolution=1)
    np.from_dlpack(found.toi_lower)
    assert found.impacts.dtype.names == ("at", "triangle", "position", "label", "world_from_object")
    assert found.impacts.dtype["world_from_object"].shape == (4, 4) and found.seconds > 0
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert found.plot().get_xlabel() == "segment"
