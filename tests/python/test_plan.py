# SPDX-License-Identifier: MIT
"""Plans: a known case, the program's own answers, and wishes that make no sense."""
import numpy as np
import pytest

import voxtact as vx
from conftest import program

TARGET = (6.0, -4.0, 2.0)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plan")
    program("make", "volume", "builtin:head:32", "volume.nii.gz", cwd=folder)
    volume = vx.read_volume(folder / "volume.nii.gz")
    blocks = np.zeros(volume.shape, dtype=np.uint8)
    blocks[12:20, 12:20, 6:12], blocks[20:25, 8:20, 12:20] = 3, 7
    vx.read_volume(blocks, axes="zyx", affine=volume.affine).write(folder / "labels.nii.gz")
    program("make", "mesh", "builtin:scalpel:100", "tool.stl", cwd=folder)
    return folder


@pytest.fixture(scope="module")
def planned(files):
    labels = vx.read_labels(files / "labels.nii.gz")
    return vx.Scene(files / "volume.nii.gz", opacity=[(40, 0), (80, 1)], labels=labels)


@pytest.mark.parametrize("ways", [
    ((), {}),
    (("--margin", 2, "--max-length", 90, "--max-angle", 40), {"margin": 2, "max_length": 90, "max_angle": 40}),
    (("--entry-radius", 60, "--mesh", "builtin:needle:1.5:90"), {"entry_radius": 60, "needle": (1.5, 90)}),
    (("--avoid-opacity", "150:0,160:1"), {"avoid_opacity": "150:0,160:1"}),
    (("--mesh", "tool.stl", "--tip", "0,0,-90", "--axis", "0,0,1"),
     {"mesh": "tool.stl", "tip": (0, 0, -90), "axis": (0, 0, 1), "max": 3}),
], ids=["label", "limits", "needle", "opacity", "mesh"])
def test_plans_are_those_of_the_program(files, planned, ways):
    arguments, options = ways
    options = {"max": 10, **options}
    rows = program("plan", "--volume", "volume.nii.gz", "--opacity", "40:0,80:1", "--labels", "labels.nii.gz", "--avoid",
                   "3,7", "--target", ",".join(map(str, TARGET)), "--entries", 162, "--max", options["max"],
                   *arguments, cwd=files)
    options = {**options, "mesh": vx.read_mesh(files / options["mesh"])} if "mesh" in options else options
    found = planned.plan(TARGET, avoid=[3, 7], entries=162, **options)
    assert len(found) == len(rows) > 20
    assert found.paths["entry"].tolist() == [int(row["entry"]) for row in rows]
    assert found.paths["safety"].tolist() == [int(row["safe"]) for row in rows]
    np.testing.assert_allclose(found.distance, [[float(row["lower"]), float(row["upper"])] for row in rows],
                               atol=1e-6)
    np.testing.assert_allclose(found.entries, [[float(row[axis]) for axis in "xyz"] for row in rows], atol=1e-5)
    np.testing.assert_allclose(found.paths["length"], [float(row["length"]) for row in rows], atol=1e-5)
    assert [found.nearest_name(i) for i in range(len(rows))] == [row["nearest"] for row in rows]
    assert sum(found.left_out.values()) + len(found) == 162
    assert found.triangles.max() < len(found) and len(found.triangle_safe) == len(found.triangles)
    assert found.safe_area <= found.area * (1 + 1e-9)


def test_entries_where_the_image_ends(files, planned):
    full = vx.read_volume(np.full((9, 9, 9), 200, dtype=np.uint8), axes="zyx", affine=np.eye(4), space="lps")
    cut = vx.Scene(full, opacity=[(99, 0), (101, 1)])
    wish = {"avoid_opacity": [(254, 0), (255, 1)], "entries": 162}
    with pytest.raises(vx.InvalidArgumentError, match="162 enter where the image ends"):
        cut.plan((4, 4, 4), **wish)
    assert len(cut.plan((4, 4, 4), border_entries=True, **wish)) == 162
    assert planned.plan(TARGET, avoid=[3], entries=162).left_out["on_border"] == 0


def test_a_heat_map_lies_over_the_image(files):
    nibabel = pytest.importorskip("nibabel")
    rows = program("plan", "--volume", "volume.nii.gz", "--opacity", "40:0,80:1", "--labels", "labels.nii.gz", "--avoid",
                   "3,7", "--target", ",".join(map(str, TARGET)), "--entries", 2562, "--max", 10, "--heat-map",
                   "map.nii.gz", cwd=files)
    image = nibabel.load(files / "volume.nii.gz")
    heat = nibabel.load(files / "map.nii.gz")
    assert heat.shape == image.shape
    np.testing.assert_array_equal(heat.affine, image.affine)
    assert heat.get_data_dtype() == np.float32
    values = heat.get_fdata()
    assert ((values == -1) | ((values >= 0) & (values <= 10))).all()
    # No path keeps less than the voxel says that it enters through; LPS to RAS.
    entries = np.array([[-float(row["x"]), -float(row["y"]), float(row["z"]), 1] for row in rows])
    at = np.rint(entries @ np.linalg.inv(heat.affine).T)[:, :3].astype(int)
    inside = ((at >= 0) & (at < heat.shape)).all(axis=1)
    there = values[tuple(at[inside].T)]
    assert inside.sum() > 2000 and (there >= 0).mean() > 0.95
    assert (there <= np.array([float(row["upper"]) for row in rows])[inside]).all()


def ball_beside():
    """A ball of 5 mm at x = 20, in voxels of 1 mm of which the one at the origin is the world's."""
    z, y, x = np.meshgrid(*[np.arange(-30, 31)] * 3, indexing="ij")
    ball = (x - 20) ** 2 + y**2 + z**2 <= 25
    affine = np.eye(4)
    affine[:3, 3] = -30
    return vx.read_volume(np.where(ball, 200, 0).astype(np.uint8), axes="zyx", affine=affine, space="lps")


def test_a_ball_beside_the_way():
    """Seen from the origin the ball is half as wide as asin(5 / 20): what points away from it is safe."""
    scene = vx.Scene(ball_beside(), opacity=[(99, 0), (101, 1)])
    found = scene.plan((0, 0, 0), avoid_opacity=[(99, 0), (101, 1)], entry_radius=28, entries=642, needle=(1, 40), margin=1)
    towards = found.entries[:, 0] / 28
    assert not found.safe[towards > np.cos(np.arcsin(4 / 20))].any(), "straight into it"
    assert found.safe[towards < np.cos(np.arcsin(8.5 / 20))].all(), "far beside it"
    assert found.best is not None and found.safe[found.best]
    assert found.paths["lower"][found.best] == found.paths["lower"][found.safe].max()
    assert (found.paths["obstacle"][np.isfinite(found.paths["upper"])] == 1).all()
    assert 0 < found.safe_area < found.area < 4 * np.pi * 28**2
    assert found.triangle_safe.any() and found.safe[found.triangles[found.triangle_safe]].all()
    with pytest.raises(vx.NotReadyError, match="triangle_distances=True"):
        found.triangle_distance
    more = scene.plan((0, 0, 0), avoid_opacity=[(99, 0), (101, 1)], entry_radius=28, entries=642, needle=(1, 40), margin=1,
                      triangle_distances=True)
    keeps = more.triangle_distance
    assert keeps.shape == (len(more.triangles),) and (keeps[more.triangle_safe] >= 1).all() and keeps.min() == 0
    assert (keeps <= more.paths["upper"][more.triangles].min(axis=1)).all(), "no more than the worst of its corners"
    assert repr(found).startswith(f"<voxtact.Plan: {found.safe.sum()} of 642 paths are safe")

    scene.edit(ball=(20, 0, 0, 9), value=0)
    assert scene.plan((0, 0, 0), avoid_opacity=[(99, 0), (101, 1)], entry_radius=28, entries=162).safe.all()
    again = scene.plan((0, 0, 0), avoid_opacity=[(99, 0), (101, 1)], avoid_volume=scene.volume, entry_radius=28,
                       entries=162)
    assert not again.safe.all(), "the volume as it was given"


def test_labels_by_name(files):
    labels = vx.read_labels(files / "labels.nii.gz", names={7: "Outer", 3: "Twin", 4: "Twin"})
    scene = vx.Scene(files / "volume.nii.gz", opacity=[(40, 0), (80, 1)], labels=labels)
    assert labels.number("Outer") == labels.number(7) == 7
    with pytest.raises(vx.InvalidArgumentError, match="0 labels are called 'Outr'; did you mean Outer"):
        scene.plan(TARGET, avoid=["Outr"])
    with pytest.raises(vx.InvalidArgumentError, match="2 labels are called 'Twin'"):
        scene.plan(TARGET, avoid=["Twin"])


@pytest.mark.parametrize("wish,said", [
    ({}, "what to avoid"),
    ({"avoid": [3], "entry_label": 3, "entry_radius": 5}, "leave out one"),
    ({"avoid": [3], "tip": (0, 0, 0)}, "are of a mesh"),
    ({"avoid": [3], "mesh": True, "tip": (0, 0, 0)}, "comes with tip= and axis="),
    ({"avoid": [3], "avoid_volume": "builtin:head:8"}, "needs avoid_opacity"),
    ({"avoid": [3], "entries": 0}, "entries"),
    ({"avoid": [3], "entries": 2**32}, "a whole number from 1 to 3994242"),
    ({"avoid": [3], "margin": float("nan")}, "margin"),
    ({"avoid": [3], "margin": -1}, "margin"),
    ({"avoid": [3], "needle": (2, 1)}, "needle"),
    ({"avoid": [3], "needle": (float("inf"), float("inf"))}, "needle"),
    ({"avoid": [3], "entry_radius": 0}, "radius"),
    ({"avoid": [3], "tolerance": 0}, "tolerance"),
    ({"avoid": [3], "max": 0}, "the max 0 mm"),
    ({"avoid": [3], "max_angle": 91}, "angle"),
])
def test_wishes_that_make_no_sense(planned, knife, wish, said):
    if "mesh" in wish:
        wish = {**wish, "mesh": knife}
    with pytest.raises(vx.InvalidArgumentError, match=said):
        planned.plan(TARGET, **wish)


def test_wishes_of_the_wrong_kind(planned):
    with pytest.raises(vx.InvalidArgumentError):
        planned.plan((0, 0), avoid=[3])
    with pytest.raises(vx.InvalidArgumentError, match="target"):
        planned.plan((0, float("nan"), 0), avoid=[3])
    with pytest.raises(TypeError, match="read_mesh"):
        planned.plan(TARGET, avoid=[3], mesh="tool.stl", tip=(0, 0, 0), axis=(0, 0, 1))
    with pytest.raises(vx.InvalidArgumentError, match="labels="):
        vx.Scene("builtin:head:16").plan(TARGET, avoid=[3])
