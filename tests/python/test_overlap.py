# SPDX-License-Identifier: MIT
"""Overlaps: the opaque volume inside closed meshes, by bands of values and by labels."""
import warnings

import numpy as np
import pytest

import voxtact as vx
from conftest import cube, half_space, placed, program, random_poses


def constant():
    """20 mm along each side, the first voxel's centre at the origin."""
    volume = vx.read_volume(np.full((20, 20, 20), 200, np.uint8), axes="zyx", affine=np.eye(4), space="lps")
    return vx.Scene(volume, opacity=[(99, 0), (101, 1)])


def inside(lower, upper, truth):
    return lower <= truth * (1 + 1e-6) and upper >= truth * (1 - 1e-6)


def ball_scene():
    """An opaque ball of 4 mm around (10, 10, 10)."""
    z, y, x = np.indices((21, 21, 21))
    far = np.sqrt((x - 10) ** 2 + (y - 10) ** 2 + (z - 10) ** 2)
    volume = vx.read_volume(np.clip(200 - 50 * (far - 2), 0, 255).astype(np.uint8), axes="zyx", affine=np.eye(4), space="lps")
    return vx.Scene(volume, opacity=[(99, 0), (101, 1)])


def holed(size=4.0, missing=1):
    mesh = cube(size)
    return vx.read_mesh((mesh.vertices, mesh.faces[missing:]), space="lps")


def test_a_box_in_a_constant_image():
    found = constant().overlap(cube(4), placed((10, 10, 10), (100, 0, 0)), tolerance=0.01)
    assert len(found) == 2 and inside(found.lower[0], found.upper[0], 64) and found.upper[0] - found.lower[0] <= 0.01
    assert found.lower[1] == found.upper[1] == 0
    for row in range(2):
        assert inside(found.solid_lower[row], found.solid_upper[row], 64)
    assert found.inside.tolist() == ["some", "none"] and found.end.tolist() == ["closed", "closed"]
    assert found.bands.shape == (0, 2) and found.labels.shape == (0,) and found.seconds > 0
    assert repr(found).startswith("<voxtact.Overlap of 2 poses: max 6")
    dark = constant()
    dark.edit(box=(0, 0, 0, 20, 20, 20), value=0)
    assert dark.overlap(cube(4), np.eye(4)).upper.tolist() == [0]


def test_overlaps_are_those_of_the_program(tmp_path):
    program("make", "volume", "builtin:head:32", "volume.nii.gz", cwd=tmp_path)
    program("make", "mesh", "builtin:scalpel:300", "tool.stl", cwd=tmp_path)
    program("make", "poses", "--volume", "volume.nii.gz", "--mesh", "tool.stl", "--number", 6, "--seed", 7, "--output", "poses.txt",
            cwd=tmp_path)
    rows = program("overlap", "--volume", "volume.nii.gz", "--mesh", "tool.stl", "--poses", "poses.txt", "--opacity", "40:0,80:1",
                   cwd=tmp_path)
    found = vx.Scene(tmp_path / "volume.nii.gz", opacity="40:0,80:1").overlap(vx.read_mesh(tmp_path / "tool.stl"),
                                                                               vx.read_poses(tmp_path / "poses.txt"))
    for name in ("lower", "upper", "solid_lower", "solid_upper"):
        np.testing.assert_allclose(getattr(found, name), [float(row[name]) for row in rows], rtol=1e-6, atol=1e-6)
    assert found.inside.tolist() == [row["inside"] for row in rows] and (found.lower > 0).any()


def test_bands_sum_up(scene, knife):
    poses = random_poses(5, 3, reach=40)
    found = scene.overlap(knife, poses, bands=[20, 60, 120], tolerance=0.5)
    assert found.lower.shape == found.upper.shape == found.end.shape == (5, 4) and found.inside.shape == (5,)
    assert found.bands.tolist() == [[-np.inf, 20], [20, 60], [60, 120], [120, np.inf]]
    # Beyond the image there are no values.
    assert (found.lower.sum(axis=1) <= found.solid_upper).all() and found.lower.max() > 0
    half = vx.Scene(vx.read_volume(half_space(), axes="zyx", affine=np.eye(4), space="lps"), opacity=[(100, 0), (100, 1)])
    found = half.overlap(cube(), placed((5.5, 4, 4)), bands=[100], tolerance=0.01)
    np.testing.assert_allclose(found.lower.sum(axis=1), 8, atol=0.02)
    np.testing.assert_allclose(found.upper, [[4, 4]], atol=0.02)
    whole = half.overlap(cube(), placed((5.5, 4, 4)), tolerance=0.01)
    assert whole.lower[0] <= found.upper[0, 1] and found.lower[0, 1] <= whole.upper[0]


def test_labels(scene, knife, head):
    labelled = vx.Scene(head, opacity=[(40, 0), (80, 1)], labels=vx.read_labels(head, names={120: "brain"}))
    poses = random_poses(3, 3, reach=30)
    found = labelled.overlap(knife, poses, labels=["brain", 70])
    assert found.lower.shape == found.upper.shape == found.inside.shape == (3, 2) and found.labels.tolist() == [120, 70]
    assert (found.lower.sum(axis=1) <= labelled.overlap(knife, poses).upper).all()
    with pytest.warns(UserWarning, match="label 254; overlaps with it are 0$"):
        assert labelled.overlap(knife, poses[0], labels=[254]).upper.tolist() == [[0]]
    part = vx.read_volume(head.array[1:-1, 2:-2, 3:-3].copy(), axes="zyx", space="ras",
                          affine=head.affine @ np.array([[1, 0, 0, 3], [0, 1, 0, 2], [0, 0, 1, 1], [0, 0, 0, 1.0]]))
    on_a_part = vx.Scene(head, opacity=[(40, 0), (80, 1)], labels=part)
    cropped = on_a_part.overlap(knife, poses, labels=[120, 70])
    assert np.array_equal(cropped.lower, found.lower) and np.array_equal(cropped.upper, found.upper)
    with pytest.raises(vx.InvalidArgumentError, match="overlaps with labels need a scene with labels="):
        scene.overlap(knife, poses, labels=[1])
    with pytest.raises(vx.InvalidArgumentError, match="bands= or labels=, not both"):
        labelled.overlap(knife, poses, labels=[70], bands=[3])


def test_a_mesh_with_a_hole():
    """Half a side of a cube of 4 mm is missing: 8 mm² are added."""
    scene, pose = constant(), placed((10, 10, 10))
    with pytest.raises(vx.InvalidArgumentError, match="the mesh has 1 hole with 3 open edges"):
        scene.overlap(holed(), pose)
    with pytest.warns(UserWarning, match=r"^arrays: holes filled, area added: 8 mm²$") as caught:
        found = scene.overlap(holed(), pose, fill_holes=True)
    assert caught[0].filename == __file__ and inside(found.lower[0], found.upper[0], 64)
    with pytest.warns(UserWarning, match="area added: 16 mm²") as caught:
        several = scene.overlap([(cube(4), pose), (holed(missing=2), pose)], fill_holes=True)
    assert len(caught) == 1 and several.item.tolist() == [0, 1]
    np.testing.assert_allclose(several.lower, [64, 64], atol=1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.overlap(cube(4), pose, fill_holes=True)


def test_an_enclosed_ball():
    scene = ball_scene()
    found = scene.overlap(cube(16), placed((10, 10, 10), (17, 10, 10), (200, 0, 0)))
    assert found.inside.tolist() == ["all", "some", "none"]
    assert 4 / 3 * np.pi * 3.5**3 < found.lower[0] <= found.upper[0] < 4 / 3 * np.pi * 4.5**3
    assert not scene.distance(cube(16), placed((10, 10, 10))).lower[0] == 0, "its surface touches nothing"


def test_solids():
    scene, poses = ball_scene(), placed((10, 10, 10), (17, 10, 10), (200, 0, 0))
    found = scene.touch(cube(16), poses, solid=True, witness=True)
    assert found.touches.tolist() == [True, True, False] and not found.undecided.any()
    assert found.witness["triangle"][0] == -1 and found.witness["triangle"][1] >= 0
    assert np.linalg.norm(found.witness["position"][0] - 10) < 4.2 and np.isnan(found.witness["position"][2]).all()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert scene.touch(cube(16), poses[0], solid=True).touches.tolist() == [True]
    far = scene.distance(cube(16), poses, solid=True)
    assert far.upper.tolist()[:2] == [0, 0] and far.lower[2] == scene.distance(cube(16), poses[2]).lower[0]
    inside = far.closest[0]
    assert inside["triangle"] == -1 and (inside["mesh"] == inside["volume"]).all() and not inside["per_translation"].any()
    with pytest.raises(vx.InvalidArgumentError, match="1 hole"):
        scene.touch(holed(16.0), poses, solid=True)
    labelled = vx.Scene(scene.volume, opacity=[(99, 0), (101, 1)], labels=vx.read_labels(scene.volume))
    with pytest.raises(vx.InvalidArgumentError, match="leave out solid"):
        labelled.distance(cube(16), poses, labels=[200], solid=True)


def test_refusals(scene, knife):
    pose = np.eye(4)
    for wrong, text in (({"bands": []}, "bands"), ({"bands": [[1, 2]]}, "bands"), ({"bands": [3, 2]}, "band"), ({"bands": [np.nan]}, "band"),
                        ({"tolerance": 0}, "tolerance"), ({"tolerance": -1}, "tolerance"),
                        ({"tolerance": np.nan}, "tolerance"), ({"max_steps": 0}, "max_steps")):
        with pytest.raises(vx.InvalidArgumentError, match=text):
            scene.overlap(knife, pose, **wrong)
    with pytest.raises(vx.LimitExceededError, match="at most 64"):
        scene.overlap(knife, pose, bands=np.arange(65))
    for wrong in ({"bands": "12"}, {"bands": ["a"]}, {"tolerance": "fine"}, {"max_steps": 1.5}):
        with pytest.raises(TypeError):
            scene.overlap(knife, pose, **wrong)
    assert len(scene.overlap(knife, [], bands=[3]).lower) == 0
    assert scene.overlap(knife, pose, tolerance=1e-6, max_steps=1).end.tolist() == ["budget"]
    assert scene.overlap(knife, pose, tolerance=None, max_steps=None).lower == scene.overlap(knife, pose).lower


def test_plots(scene, knife):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    poses = random_poses(3, 14, reach=30)
    assert scene.overlap(knife, poses).plot().get_ylabel() == "mm³"
    axes = scene.overlap(knife, poses, bands=[40, 80]).plot()
    assert axes.get_xlabel() == "value" and [text.get_text() for text in axes.get_xticklabels()] == ["< 40", "40 to 80", "≥ 80"]
