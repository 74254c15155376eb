# SPDX-License-Identifier: MIT
"""Answers: their arrays, and that they are those of the program for the same files."""
import csv
import os
import warnings

import numpy as np
import pytest

import voxtact as vx
from conftest import cube, half_space, placed, program, random_poses

EIGHT = ("--number", 8, "--seed", 7)


@pytest.fixture(scope="module", params=["head", "ct", "noise"])
def files(request, tmp_path_factory):
    """Three kinds of voxels; ct is oblique and anisotropic."""
    folder = tmp_path_factory.mktemp(request.param)
    program("make", "volume", f"builtin:{request.param}:32", "volume.nii.gz", cwd=folder)
    program("make", "mesh", "builtin:scalpel:300", "tool.stl", cwd=folder)
    program("make", "poses", "--volume", "volume.nii.gz", "--mesh", "tool.stl", "--number", 12, "--seed", 7, "--output",
            "poses.txt", cwd=folder)
    return folder, {"head": "40:0,80:1", "ct": "0:0,300:1", "noise": "1500:0,2500:1"}[request.param]


def asked(files):
    folder, opacity = files
    scene = vx.Scene(folder / "volume.nii.gz", opacity=opacity)
    return scene, vx.read_mesh(folder / "tool.stl"), vx.read_poses(folder / "poses.txt")


def ask_program(files, *options, question="count"):
    folder, opacity = files
    return program(question, "--volume", "volume.nii.gz", "--mesh", "tool.stl", "--poses", "poses.txt", "--opacity",
                   opacity, *options, cwd=folder)


def test_counts_are_those_of_the_program(files):
    scene, mesh, poses = asked(files)
    rows = ask_program(files)
    answer = scene.count(mesh, poses)
    assert answer.count.tolist() == [int(row["count"]) for row in rows]
    assert answer.touches.tolist() == [row["touch"] == "1" for row in rows]
    assert answer.count_exact.tolist() == [row["count_exact"] == "1" for row in rows]
    assert answer.touches.any() and not answer.touches.all(), "the poses say nothing"
    assert (answer.method, answer.projection) == ("cpu", "certified")


@pytest.mark.parametrize("projection", ["view", "two-view", "dominant-axis"])
def test_projections_are_those_of_the_program(files, projection):
    scene, mesh, poses = asked(files)
    rows = ask_program(files, "--projection", projection)
    answer = scene.count(mesh, poses, projection=projection)
    assert answer.count.tolist() == [int(row["count"]) for row in rows]
    assert answer.projection == projection


def test_contacts_and_triangles_are_those_of_the_program(files, tmp_path):
    scene, mesh, poses = asked(files)
    ask_program(files, "--contacts", tmp_path / "contacts.csv", "--triangles", tmp_path / "triangles.csv")
    answer = scene.count(mesh, poses, contacts=True, triangles=True)
    expected = list(csv.DictReader((tmp_path / "contacts.csv").open()))
    assert len(answer.contacts) == len(expected) == answer.contacts_found > 0
    for name, columns in (("position", "x y z"), ("normal", "nx ny nz")):
        numbers = np.array([[float(row[column]) for column in columns.split()] for row in expected])
        np.testing.assert_allclose(answer.contacts[name], numbers, atol=2e-6)
    for name in ("depth", "value", "opacity"):
        numbers = np.array([float(row[name]) for row in expected])
        np.testing.assert_allclose(answer.contacts[name], numbers, rtol=1e-5, atol=2e-6)
    assert answer.contacts["pair"].tolist() == [int(row["pose"]) for row in expected]
    for _ in range(4):  # in other memory, each time
        again = scene.count(mesh, poses, contacts=True)
        assert again.contacts.tobytes() == answer.contacts.tobytes()
    assert answer.contacts["triangle"].tolist() == [int(row["triangle"]) for row in expected]
    expected = list(csv.DictReader((tmp_path / "triangles.csv").open()))
    assert answer.triangles.tolist() == [(int(row["pose"]), int(row["triangle"]), int(row["count"])) for row in expected]


def test_distances_are_those_of_the_program(files):
    scene, mesh, poses = asked(files)
    rows = ask_program(files, question="distance")
    found = scene.distance(mesh, poses)
    np.testing.assert_allclose(found.lower, [float(row["lower"]) for row in rows], atol=1e-6)
    np.testing.assert_allclose(found.upper, [float(row["upper"]) for row in rows], atol=1e-6)
    assert (found.lower > 0).any() and (found.lower == 0).any(), "the poses say nothing"


def test_areas_are_those_of_the_program(files):
    scene, mesh, poses = asked(files)
    rows = ask_program(files, "--tolerance", "0.01", question="area")
    found = scene.area(mesh, poses, tolerance=0.01)
    np.testing.assert_allclose(found.lower, [float(row["lower"]) for row in rows], atol=1e-6)
    np.testing.assert_allclose(found.upper, [float(row["upper"]) for row in rows], atol=1e-6)
    assert (found.lower > 0).any() and (found.upper == 0).any(), "the poses say nothing"
    np.testing.assert_array_equal(found.lower > 0, [row["touch"] == "1" for row in ask_program(files, question="touch")])


def test_what_was_not_asked_for_is_found_when_it_is_looked_at(scene, knife):
    poses = random_poses(6, 1)
    later, sooner = scene.count(knife, poses), scene.count(knife, poses, contacts=True, triangles=True, bounds=True)
    for name in ("contacts", "triangles", "bounds"):
        np.testing.assert_array_equal(getattr(later, name), getattr(sooner, name))
    assert later.contacts is not None and len(sooner.contacts) > 0
    touched = np.unique(sooner.contacts["pair"])
    assert np.isnan(sooner.bounds).all(axis=(1, 2)).tolist() == [pair not in touched for pair in range(6)]
    first = sooner.contacts[sooner.contacts["pair"] == touched[0]]
    np.testing.assert_allclose(sooner.bounds[touched[0]],
                               [first["position"].min(axis=0), first["position"].max(axis=0)], atol=1e-4)


def test_what_was_not_asked_for_is_not_about_another_scene(scene, knife):
    answer = scene.count(knife, np.eye(4))
    scene.threshold = 0.5
    with pytest.raises(vx.NotReadyError, match="the scene has changed.*contacts=True"):
        answer.contacts


def test_arrays_keep_what_they_show(scene, knife):
    count = scene.count(knife, random_poses(50, 3)).count
    contacts = scene.count(knife, random_poses(50, 3)).contacts
    again = scene.count(knife, random_poses(50, 3), contacts=True)
    np.testing.assert_array_equal(count, again.count)
    np.testing.assert_array_equal(contacts, again.contacts)


def test_shapes_and_types(scene, knife):
    poses = random_poses(5, 4)
    answer = scene.count(knife, poses)
    assert len(answer) == 5
    for array, dtype in ((answer.touches, bool), (answer.undecided, bool), (answer.count_exact, bool), (answer.count, np.uint64),
                         (answer.item, np.uint32), (answer.pose, np.uint32)):
        assert array.shape == (5,) and array.dtype == dtype
    assert answer.bounds.shape == (5, 2, 3)
    assert answer.contacts.dtype.names == ("pair", "triangle", "position", "normal", "depth", "value", "opacity", "label")
    assert answer.contacts.dtype["position"].shape == (3,)
    assert answer.triangles.dtype.names == ("pair", "triangle", "count")
    np.from_dlpack(answer.count)  # what other libraries take
    assert scene.count(knife, poses[0]).count.tolist() == answer.count[:1].tolist()
    assert scene.count(knife, poses.tolist()).count.tolist() == answer.count.tolist()
    assert scene.count(knife, poses.astype(np.float32)).count.shape == (5,)
    np.testing.assert_array_equal(scene.count(knife, np.asfortranarray(poses)).count, answer.count)
    np.testing.assert_array_equal(scene.count(knife, np.repeat(poses, 2, axis=0)[::2]).count, answer.count)
    nothing = scene.count(knife, np.empty((0, 4, 4)))
    assert len(nothing) == 0 and nothing.count.shape == (0,) and nothing.contacts.shape == (0,)


def test_known_counts_and_places():
    """A cube of 2 mm, half of it in voxels of 200: x up to 5.5, where the interpolant falls from 200 to 0."""
    scene = vx.Scene(vx.read_volume(half_space(), axes="zyx", affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)])
    inside, across, outside = placed((3, 4, 4), (6, 4, 4), (9, 4, 4))
    answer = scene.count(cube(), [inside, across, outside], contacts=True, bounds=True)
    assert answer.touches.tolist() == [True, True, False] and not answer.undecided.any()
    touching = answer.contacts[answer.contacts["pair"] == 1]
    assert touching["position"][:, 0].min() >= 5 and touching["position"][:, 0].max() < 5.52
    np.testing.assert_allclose(touching["normal"], np.broadcast_to([1, 0, 0], (len(touching), 3)), atol=1e-6)
    np.testing.assert_allclose(touching["position"][:, 0] + touching["depth"], 5.5, atol=0.02)
    assert np.isnan(answer.bounds[2]).all()
    found = scene.distance(cube(), [outside])
    assert found.lower[0] == pytest.approx(8 - 5.5, abs=0.02) and found.upper[0] - found.lower[0] <= 0.01
    closest = found.closest[0]
    assert closest["mesh"][0] == pytest.approx(8) and closest["per_translation"] == pytest.approx([1, 0, 0], abs=1e-3)
    assert found.closest["triangle"].tolist()[0] >= 0 and found.end.tolist() == ["closed"]
    assert scene.touch(cube(), [outside, across], margin=2).touches.tolist() == [False, True]
    assert scene.touch(cube(), [outside], margin=3).touches.tolist() == [True]


def test_several_meshes(scene, knife, head):
    small = cube(10)
    a, b = random_poses(300, 5), random_poses(40, 6)
    both = scene.count([(knife, a), (small, b)], contacts=True, triangles=True)
    one, other = scene.count(knife, a, contacts=True), scene.count(small, b, contacts=True)
    np.testing.assert_array_equal(both.count, np.concatenate([one.count, other.count]))
    assert both.item.tolist() == [0] * 300 + [1] * 40
    assert both.pose.tolist() == list(range(300)) + list(range(40))
    second = both.contacts[both.contacts["pair"] >= 300]
    np.testing.assert_array_equal(second["position"], other.contacts["position"])
    np.testing.assert_array_equal(second["pair"] - 300, other.contacts["pair"])
    assert len(scene.count([])) == 0


def test_pieces_change_nothing(head):
    """More poses than a first piece has: the rest comes in pieces, whose pairs go on counting."""
    mesh = vx.read_mesh("builtin:ellipsoid:49998")  # a first piece has some twenty poses
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)])
    poses = random_poses(60, 8, reach=180)
    told = []
    answer = scene.count(mesh, poses, contacts=True, max_contacts=2**22, progress=lambda *way: told.append(way))
    assert len(told) >= 2 and told[-1] == (60, 60)
    for pair in (0, 21, 40, 59):
        alone = scene.count(mesh, poses[pair], contacts=True)
        assert alone.count[0] == answer.count[pair]
        np.testing.assert_array_equal(alone.contacts["position"],
                                      answer.contacts["position"][answer.contacts["pair"] == pair])


def test_a_cut_list_of_contacts_says_so(scene, knife):
    poses = random_poses(2000, 9)
    answer = scene.count(knife, poses, contacts=True, max_contacts=100)
    assert len(answer.contacts) == 100
    assert answer.contacts_found == answer.count.sum()


def test_yes_or_no(scene, knife):
    poses = random_poses(100, 10)
    answer, counted = scene.touch(knife, poses), scene.count(knife, poses)
    np.testing.assert_array_equal(answer.touches, counted.touches)
    assert [scene.touch(knife, pose).touches[0] for pose in poses[:20]] == counted.touches[:20].tolist()
    first = scene.count(knife, poses, stop_at_first=True)
    assert set(first.count.tolist()) == {0, 1} and answer.touches.any()
    np.testing.assert_array_equal(first.touches, counted.touches)
    np.testing.assert_array_equal(first.contacts, counted.contacts)


def test_witness_points_of_touches(files):
    scene, mesh, poses = asked(files)
    for margin in (0, 2):
        rows = ask_program(files, "--margin", margin, question="touch")
        answer = scene.touch(mesh, poses, witness=True, margin=margin)
        assert np.where(answer.touches, 1, 2 * answer.undecided).tolist() == [int(row["touch"]) for row in rows]
        assert answer.witness["triangle"].tolist() == [int(row["triangle"] or -1) for row in rows]
        at = [[float(row[axis] or "nan") for axis in "xyz"] for row in rows]
        np.testing.assert_allclose(answer.witness["position"], at, atol=2e-6)
    with pytest.raises(vx.NotReadyError, match=r"touch\(witness=True\)"):
        scene.touch(mesh, poses).witness
    with pytest.raises(vx.InvalidArgumentError, match="not both"):
        scene.touch(mesh, poses, witness=True, uncertainty=(1, 1))
    for wrong, error in ((1, TypeError), ("12", TypeError), ((1, "2"), TypeError), ((1, 2, 3), vx.InvalidArgumentError)):
        with pytest.raises(error, match="uncertainty"):
            scene.touch(mesh, poses, uncertainty=wrong)


def test_labels(head, knife):
    labels = vx.read_labels(head, names={90: "brain"})
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], labels=labels)
    answer = scene.count(knife, random_poses(30, 11), labels=True, contacts=True)
    assert answer.labels["count"].sum() == answer.count.sum() > 0
    np.testing.assert_array_equal(answer.contacts["label"], labels.at(answer.contacts["position"]))
    assert set(answer.labels["label"]) <= set(labels.values)
    found = scene.distance(knife, random_poses(5, 11), labels=[90, 120])
    assert found.lower.shape == found.upper.shape == found.end.shape == (5, 2) and found.labels.tolist() == [90, 120]
    assert scene.distance(knife, np.eye(4), labels=True).lower.shape == (1, len(labels.values) - 1)
    with pytest.raises(vx.NotReadyError, match="closest"):
        found.closest
    poses = random_poses(5, 11)
    whole, parts = scene.area(knife, poses, tolerance=1e-3), scene.area(knife, poses, tolerance=1e-3, labels=labels.values.tolist())
    assert parts.lower.shape == parts.upper.shape == parts.end.shape == (5, len(labels.values))
    assert whole.lower.max() > 0 and (parts.lower.sum(axis=1) <= whole.upper).all() and (parts.upper.sum(axis=1) >= whole.lower).all()
    np.testing.assert_array_equal(scene.area(knife, poses, tolerance=1e-3, labels=["brain"]).lower[:, 0],
                                  parts.lower[:, labels.values.tolist().index(90)])


def test_labels_are_taken_as_they_are(head):
    labels = vx.read_labels(np.ones((3, 3, 3), np.uint8), axes="zyx", affine=np.eye(4))
    assert vx.read_labels(labels) is labels
    assert vx.read_labels(labels, names={1: "one"}).names == {1: "one"}
    with pytest.raises(vx.InvalidArgumentError, match="affine="):
        vx.read_labels(labels, axes="zyx", affine=np.eye(4))
    with pytest.raises(TypeError, match="bogus"):
        vx.read_labels(labels, bogus=3)
    for names in ({"one": 1}, {1: 1}, {True: "one"}, {1.0: "one"}):
        with pytest.raises(TypeError, match="names has"):
            vx.read_labels(labels, names=names)


def test_no_poses(scene, knife):
    assert len(scene.count(knife, []).count) == 0
    assert len(scene.count([(knife, []), (knife, np.eye(4))]).count) == 1
    for answer in (scene.distance(knife, []).lower, scene.area(knife, []).lower, scene.touch(knife, [], margin=1).touches,
                   scene.touch(knife, [], uncertainty=(1, 1)).touches):
        assert len(answer) == 0
    with pytest.raises(TypeError, match="generator"):
        scene.count(knife, (pose for pose in [np.eye(4)]))


def test_bounds_of_distances(scene, knife):
    far = placed((1000, 0, 0))
    beyond = scene.distance(knife, far, max=5)
    assert beyond.lower[0] == 5 and beyond.upper[0] == np.inf and beyond.end[0] == "beyond"
    assert beyond.closest["triangle"].tolist() == [-1] and np.isnan(beyond.closest["mesh"]).all()
    tight, loose = scene.distance(knife, far, tolerance=1e-3), scene.distance(knife, far, tolerance=1)
    assert tight.upper[0] - tight.lower[0] <= 1e-3 and loose.lower[0] <= tight.upper[0] and tight.lower[0] <= loose.upper[0]
    with pytest.raises(vx.InvalidArgumentError, match="tolerance"):
        scene.distance(knife, far, tolerance=0)


def test_bounds_of_areas(scene, knife):
    inside = placed((0, 0, 0))
    tight, loose = scene.area(knife, inside, tolerance=1e-3), scene.area(knife, inside, tolerance=10)
    assert tight.end.tolist() == loose.end.tolist() == ["closed"]
    assert 0 < tight.upper[0] - tight.lower[0] <= 1e-3 and loose.lower[0] <= tight.upper[0] and tight.lower[0] <= loose.upper[0]
    few = scene.area(knife, inside, tolerance=1e-6, max_steps=1)
    assert few.end.tolist() == ["budget"] and few.lower[0] <= tight.upper[0] and tight.lower[0] <= few.upper[0]
    faces = knife.vertices[knife.faces].astype(float)
    surface = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1).sum() / 2
    assert tight.lower[0] < surface
    assert scene.area(knife, placed((1000, 0, 0))).upper.tolist() == [0]
    poses = placed((0, 0, 0), (1000, 0, 0), (0, 0, 20))
    found = scene.area([(knife, poses[:2]), (knife, poses[2:])], triangles=True)
    np.testing.assert_array_equal(found.lower, scene.area(knife, poses).lower)
    parts = found.triangles
    assert set(parts["pair"]) == {0, 2} and (np.diff(parts["pair"].astype(int)) >= 0).all()
    for pair in (0, 2):
        own = parts[parts["pair"] == pair]
        np.testing.assert_allclose([own["lower"].sum(), own["upper"].sum()], [found.lower[pair], found.upper[pair]], rtol=1e-9)
        areas = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1)[own["triangle"]] / 2
        np.testing.assert_allclose(own["whole"], areas, rtol=1e-5, atol=1e-9)
    with pytest.raises(vx.InvalidArgumentError, match="in labels or of triangles"):
        scene.area(knife, inside, labels=[1], triangles=True)
    for wrong in (0, -1, np.nan, np.inf):
        with pytest.raises(vx.InvalidArgumentError, match="tolerance"):
            scene.area(knife, inside, tolerance=wrong)
    with pytest.raises(vx.InvalidArgumentError, match="areas in labels need a scene with labels="):
        scene.area(knife, inside, labels=[1])
    with pytest.raises(vx.InvalidArgumentError, match="max_steps"):
        scene.area(knife, inside, max_steps=0)


def test_a_camera(scene, knife):
    from_front = vx.View(np.array([[0.01, 0, 0, 0], [0, 0, -0.01, 0], [0, 0.002, 0, 0.5], [0, 0, 0, 1]]), 256, 128)
    answer = scene.count(knife, random_poses(20, 12), projection="view", view=from_front)
    assert answer.touches.any()
    with pytest.raises(vx.InvalidArgumentError, match="singular|inverted"):
        scene.count(knife, np.eye(4), projection="view", view=vx.View(np.zeros((4, 4))))


def test_names_of_options_are_listed(scene, knife):
    for option in ("projection", "method", "filter", "boundary"):
        with pytest.raises(vx.InvalidArgumentError, match=f"{option} 'nonsense' is none of "):
            scene.count(knife, np.eye(4), **{option: "nonsense"})
    with pytest.raises(vx.UnsupportedError, match="query needs a Vulkan device"):
        scene.count(knife, np.eye(4), method="query")


def test_refusals_name_what_is_wrong(scene, knife):
    with pytest.raises(vx.InvalidArgumentError, match="touched labels need a scene with labels="):
        scene.count(knife, np.eye(4), labels=True)
    with pytest.raises(vx.InvalidArgumentError, match="item 1, pose 0: the last row"):
        scene.count([(knife, np.eye(4)), (knife, np.zeros((4, 4)))])
    with pytest.raises(TypeError, match="item 1 of the list is no pair"):
        scene.count([(knife, np.eye(4)), ("tool.stl", np.eye(4))])
    with pytest.raises(TypeError, match="mesh is a str; voxtact.read_mesh"):
        scene.count("tool.stl")
    with pytest.raises(TypeError, match="threshold is 'high'; a number is needed"):
        scene.threshold = "high"
    with pytest.raises(TypeError, match="margin is None"):
        scene.touch(knife, np.eye(4), margin=None)


def test_poses_that_are_not_finite_are_refused_wherever_that_is(scene, knife):
    for row in range(4):
        for column in range(4):
            for wrong in (np.nan, np.inf, -np.inf):
                poses = np.tile(np.eye(4), (3, 1, 1))
                poses[2, row, column] = wrong
                with pytest.raises(vx.InvalidArgumentError, match="^pose 2: "):
                    scene.count(knife, poses)


def test_progress(scene, knife):
    class Bar:  # what tqdm's has
        total = None
        n = 0
        closed = False

        def __init__(self, total=None):
            self.total = total
            bars.append(self)

        def update(self, more):
            self.n += more

        def close(self):
            self.closed = True

    bars = []
    poses = random_poses(1000, 13)
    mine = Bar()
    scene.count(knife, poses, progress=mine)
    assert (mine.n, mine.total, mine.closed) == (1000, 1000, False)
    scene.distance(knife, poses[:20], max=1, progress=Bar)
    assert (bars[-1].n, bars[-1].total, bars[-1].closed) == (20, 20, True)
    with pytest.raises(TypeError, match="progress"):
        scene.count(knife, poses, progress=3)

    def stop(done, of):
        told.append(done)
        raise StopIteration("enough")

    told = []
    with pytest.raises(StopIteration, match="enough"):
        scene.count(knife, np.tile(poses, (50, 1, 1)), progress=stop)
    assert len(told) == 1 and told[0] < 50_000, "it ended with the first piece"
    assert len(scene.count(knife, poses)) == 1000, "and the scene is as good as ever"
    told.clear()
    with pytest.raises(StopIteration, match="enough"):  # few triangles, which may go through all of the volume
        scene.count(vx.read_mesh(([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]])), poses, progress=stop)
    assert len(told) == 1 and told[0] <= max(64, os.cpu_count())
    tqdm = pytest.importorskip("tqdm").tqdm
    scene.touch(knife, poses, margin=1, progress=tqdm)


def test_plots(scene, knife):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = scene.count(knife, random_poses(9, 14)).plot()
    assert axes.get_xlabel() == "pose"
    assert scene.touch(knife, random_poses(9, 14)).plot().get_ylabel() == "touches"
    assert scene.distance(knife, random_poses(9, 14), max=3).plot().get_ylabel() == "mm"
    assert scene.area(knife, random_poses(9, 14)).plot().get_ylabel() == "mm²"


def test_what_is_hardly_meant_to_be_opaque_is_warned_of():
    values = np.full((8, 8, 8), 40, np.int16)
    values[0, 0, 0] = 32767
    ct = vx.read_volume(values, axes="zyx", affine=np.eye(4))
    vessel = vx.read_volume(np.where(values == 40, np.int16(200), values), axes="zyx", affine=np.eye(4))
    scene = vx.Scene(vessel, opacity=[(150, 0), (200, 1), (250, 0)])
    with pytest.warns(UserWarning, match="opacity: none reaches the threshold 0.1"):
        scene.opacity = [(0, 0), (1, 0.05)]
    with pytest.warns(UserWarning, match="none of the volume's values, 40 to 32767, is opaque") as said:
        vx.Scene(ct, opacity=[(0, 1), (10, 1), (20, 0)])
    assert said[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene = vx.Scene(ct, opacity=[(20, 0), (40, 1)])
        with pytest.raises(vx.InvalidArgumentError, match="threshold"):
            vx.Scene(ct, opacity=[(20, 0), (40, 1)], threshold=2)
        with pytest.raises(UserWarning):
            scene.opacity = [(0, 0), (1, 0)]
        assert np.array_equal(scene.opacity, [(20, 0), (40, 1)])
        scene.plan((4, 4, 4), avoid_opacity=[(20, 0), (40, 1)], entries=42, border_entries=True)
        with pytest.raises(UserWarning, match="^avoid_opacity: none of the volume's values"):
            scene.plan((4, 4, 4), avoid_opacity=[(50000, 0), (60000, 1)], entries=42)


def test_what_is_enclosed_is_warned_of():
    scene = vx.Scene(vx.read_volume(half_space(), axes="zyx", affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)])
    with pytest.warns(UserWarning, match="arrays encloses an opaque region at"):
        answer = scene.count(cube(100), np.eye(4))
    assert not answer.touches.any() and answer.count_exact.all()
    with pytest.warns(UserWarning, match=r"ask touch\(solid=True\)"):
        assert not vx.Scene(scene.volume, opacity=[(99, 0), (101, 1)]).touch(cube(100), np.eye(4)).touches[0]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.count(cube(100), np.eye(4))  # said once
        other = vx.Scene(scene.volume, opacity=[(99, 0), (101, 1)])
        assert other.count(cube(), placed((3, 4, 4), (30, 30, 30))).touches.tolist() == [True, False]
        mesh = cube(100)
        other.count(vx.read_mesh((mesh.vertices, mesh.faces[:-1])), np.eye(4))  # open


def test_a_mesh_is_examined_for_enclosed_regions_once(monkeypatch):
    asked = []
    monkeypatch.setattr(vx._scene, "enclosed", lambda *arguments: asked.append(arguments))
    scene = vx.Scene(vx.read_volume(half_space(), axes="zyx", affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)])
    mesh, other = cube(), cube(2)
    away = placed((500, 0, 0))
    for _ in range(3):
        scene.touch(mesh, away)
        scene.count(mesh, away)
    assert len(asked) == 1
    scene.touch(other, away)
    assert len(asked) == 2


def test_spaces_that_nobody_has_said_are_warned_of():
    def scene(**said):
        return vx.Scene(vx.read_volume(half_space(), axes="zyx", affine=np.eye(4), **said), opacity=[(99, 0), (101, 1)])

    mesh = cube()
    assumed, said = (vx.read_mesh((mesh.vertices, mesh.faces), **more) for more in ({}, {"space": "lps"}))
    for ask in ("touch", "count", "distance", "area", "overlap"):
        with pytest.warns(UserWarning, match="space="):
            getattr(scene(), ask)(assumed, np.eye(4))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene().count(said, np.eye(4))
        scene(space="ras").count(assumed, np.eye(4))
        vx.Scene("builtin:head:16").count(assumed, np.eye(4))
