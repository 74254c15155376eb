# SPDX-License-Identifier: MIT
"""What is refused, and how: one line, by voxtact's own classes, in words of Python. And texts that are not UTF-8."""
import csv
import json
import os
import re
import subprocess

import numpy as np
import pytest

import voxtact as vx
from conftest import PROGRAM, cube, half_space

LATIN_1 = "Hörrinde"
#: As Python has it: what is not UTF-8 is a surrogate escape.
KEPT = "H\udcf6rrinde"
HALF = "\ud800"  # of a character: no file can have it
EYE = np.eye(4)


def say(caught):
    """Its text, which is a line of sensible length, can be printed, and has no names of what is inside."""
    text = str(caught.value)
    text.encode()
    assert "\n" not in text and len(text) < 1000, text
    assert not re.search(r"::|_core|Unable to cast|incompatible function|\b(k|most|max|samples)[A-Z]", text), text
    return text


@pytest.fixture
def files(tmp_path):
    volume = half_space()
    vx.read_volume(volume, axes="zyx", affine=EYE, space="lps").write(tmp_path / "volume.nii")
    vx.read_volume((volume > 0).astype(np.uint8) * 7, axes="zyx", affine=EYE, space="lps").write(tmp_path / "labels.nii")
    cube().write(tmp_path / "cube.stl")
    (tmp_path / "names.txt").write_bytes(f"7 {LATIN_1}\n8 Rinde\n".encode("latin-1"))
    return tmp_path


# Texts


def test_names_of_labels_that_are_not_utf_8(files):
    names = vx.read_label_names(files / "names.txt")
    assert names == {7: KEPT, 8: "Rinde"}
    assert names[7].encode("utf-8", "surrogateescape").decode("latin-1") == LATIN_1
    labels = vx.read_labels(files / "labels.nii", names=files / "names.txt")
    assert labels.number(KEPT) == 7
    scene = vx.Scene(files / "volume.nii", opacity=[(99, 0), (101, 1)], labels=labels)
    assert scene.distance(cube(), EYE, labels=[KEPT]).lower.shape == (1, 1)
    plan = scene.plan((3, 4, 4), avoid=[KEPT], entries=12)
    assert {plan.nearest_name(row) for row in range(len(plan))} == {KEPT}
    with pytest.raises(vx.InvalidArgumentError) as caught:
        labels.number("Horrinde")
    assert "did you mean H\ufffdrrinde, Rinde?" in say(caught)


def test_they_are_the_bytes_that_the_program_writes(files):
    (files / "pose.txt").write_text(" ".join(map(str, EYE.reshape(-1))) + "\n")
    done = subprocess.run([PROGRAM, "count", "--label-counts", "--volume", "volume.nii", "--opacity", "99:0,101:1", "--mesh", "cube.stl", "--poses",
                           "pose.txt", "--labels", "labels.nii", "--label-names", "names.txt", "--contacts", "contacts.csv"],
                          cwd=files, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert f"{KEPT}:".encode("utf-8", "surrogateescape") in done.stdout
    with open(files / "contacts.csv", encoding="utf-8", errors="surrogateescape", newline="") as text:
        assert {row["label_name"] for row in csv.DictReader(text) if row["label"] == "7"} == {KEPT}


def test_names_of_points_that_are_not_utf_8(tmp_path):
    (tmp_path / "points.txt").write_bytes(f"1 2 3 {LATIN_1}\n4 5 6\n".encode("latin-1"))
    points = vx.read_points(tmp_path / "points.txt")
    assert points.names == (KEPT, "") and points.positions.tolist() == [[1, 2, 3], [4, 5, 6]]


def test_names_of_files_that_are_not_utf_8(files):
    volume, mesh = files / os.fsdecode(b"volume\xff.nii"), files / os.fsdecode(b"cube\xff.stl")
    (files / "volume.nii").rename(volume)
    (files / "cube.stl").rename(mesh)
    read = vx.read_volume(volume)
    assert read.name == volume.name and repr(volume.name) in repr(read)
    assert all(text.encode("utf-8", "surrogateescape") for text in read.notes)
    tool = vx.read_mesh(os.fsencode(mesh))
    assert tool.name == mesh.name
    assert vx.read_mesh(tool, space="ras").name == mesh.name
    for thing in (read, tool, vx.Scene(read), vx.Scene(read).tracker(tool), vx.read_labels(read)):
        repr(thing).encode()  # it can be printed
    with pytest.raises(vx.FileError, match="\ufffdno.nii"):
        vx.read_volume(files / os.fsdecode(b"\xffno.nii"))


@pytest.mark.parametrize("ask", [
    lambda: vx.read_volume(f"/tmp/{HALF}.nii"), lambda: vx.read_mesh(f"/tmp/{HALF}.stl"),
    lambda: vx.read_poses(f"/tmp/{HALF}"), lambda: vx.read_label_names(HALF), lambda: vx.read_points(HALF),
    lambda: vx.read_camera(HALF), lambda: vx.read_colours(HALF), lambda: vx.read_opacity(HALF),
    lambda: vx.Scene("builtin:head:8", opacity=HALF), lambda: vx.Scene("builtin:head:8", opacity=f"0:0,{HALF}:1"),
    lambda: vx.read_volume(f"builtin:{HALF}"), lambda: vx.read_mesh(f"builtin:{HALF}"),
    lambda: vx.read_volume("/tmp", series=HALF), lambda: vx.Device(HALF), lambda: cube().write(f"{HALF}.stl"),
    lambda: vx.pose_between(EYE, EYE, 0, interpolation=HALF),
    lambda: vx.look(HALF, vx.read_volume("builtin:head:8")),
    lambda: vx.Scene("builtin:head:8").picture(clip=HALF)])
def test_texts_that_are_none(ask):
    with pytest.raises(vx.InvalidArgumentError) as caught:
        ask()
    assert r"\ud800" in say(caught)


# Numbers


@pytest.mark.parametrize("frame", [-1, 2**40, 2**70, 1.5, True, np.True_, "1", np.array([0])])
def test_frames_that_are_none(files, frame):
    error, text = (vx.InvalidArgumentError, " from 0 to ") if type(frame) is int else (TypeError, " is needed")
    with pytest.raises(error, match=f"frame is .*; a whole number{text}") as caught:
        vx.read_volume(files / "volume.nii", frame=frame)
    say(caught)


def test_a_frame(files):
    for frame in (0, np.int64(0)):
        assert vx.read_volume(files / "volume.nii", frame=frame).shape == (8, 10, 12)


NUMBERS = {
    "margin": lambda scene, wrong: scene.touch(cube(), EYE, margin=wrong),
    "tolerance": lambda scene, wrong: scene.distance(cube(), EYE, tolerance=wrong),
    "max": lambda scene, wrong: scene.distance(cube(), EYE, max=wrong),
    "uncertainty[0]": lambda scene, wrong: scene.touch(cube(), EYE, uncertainty=(wrong, 1)),
    "uncertainty[1]": lambda scene, wrong: scene.touch(cube(), EYE, uncertainty=(1, wrong)),
    "resolution": lambda scene, wrong: scene.count(cube(), EYE, resolution=wrong),
    "max_depth": lambda scene, wrong: scene.count(cube(), EYE, max_depth=wrong),
    "resolution of a motion": lambda scene, wrong: scene.motion(cube(), [EYE, EYE], resolution=wrong),
    "resolution of a tracker": lambda scene, wrong: scene.tracker(cube(), resolution=wrong),
    "threshold": lambda scene, wrong: vx.Scene(scene.volume, threshold=wrong),
    "threshold, set": lambda scene, wrong: setattr(scene, "threshold", wrong),
    "value": lambda scene, wrong: scene.edit(box=(0, 0, 0, 1, 1, 1), value=wrong),
    "scale": lambda scene, wrong: vx.read_mesh("builtin:scalpel:300", scale=wrong),
    "scale of a file": lambda scene, wrong: vx.read_mesh("there_is_none.stl", scale=wrong),
    "margin of a plan": lambda scene, wrong: scene.plan((0, 0, 0), avoid_opacity="1:0,2:1", margin=wrong),
    "max_length": lambda scene, wrong: scene.plan((0, 0, 0), avoid_opacity="1:0,2:1", max_length=wrong),
    "max_angle": lambda scene, wrong: scene.plan((0, 0, 0), avoid_opacity="1:0,2:1", max_angle=wrong),
    "entry_radius": lambda scene, wrong: scene.plan((0, 0, 0), avoid_opacity="1:0,2:1", entry_radius=wrong),
    "view": lambda scene, wrong: vx.view_from((wrong, 0), scene.volume),
    "through": lambda scene, wrong: scene.picture(through=wrong),
}


@pytest.mark.parametrize("what", NUMBERS)
@pytest.mark.parametrize("wrong", ["1", b"1", True, np.True_, 1j, np.complex64(1)])
def test_numbers_that_are_none(scene, what, wrong):
    with pytest.raises(TypeError, match=re.escape(f"{what.split()[0].strip(',')} is {wrong!r}; a number is needed")) as caught:
        NUMBERS[what](scene, wrong)
    say(caught)


WHOLE = {
    "samples_per_voxel": ("1 to 16", lambda scene, wrong: scene.count(cube(), EYE, projection="dominant-axis", samples_per_voxel=wrong)),
    "max_contacts": ("0 to 4294967295", lambda scene, wrong: scene.count(cube(), EYE, max_contacts=wrong)),
    "max_steps": ("1 to 4294967295", lambda scene, wrong: scene.tracker(cube(), max_steps=wrong)),
    "threads": ("0 to 4096", lambda scene, wrong: vx.Scene(scene.volume, threads=wrong)),
    "table_size": ("2 to 16777216", lambda scene, wrong: vx.Scene(scene.volume, table_size=wrong)),
    "entries": ("1 to 3994242", lambda scene, wrong: scene.plan((0, 0, 0), avoid_opacity="1:0,2:1", entries=wrong)),
    "width": ("1 to 4294967295", lambda scene, wrong: scene.count(cube(), EYE, projection="view", view=vx.View(EYE, wrong, 5))),
}


@pytest.mark.parametrize("what", WHOLE)
@pytest.mark.parametrize("wrong", ["1", True, np.True_, 1.0, 2j, None, [1, 2]])
def test_whole_numbers_that_are_none(scene, what, wrong):
    if what == "table_size" and wrong is None:
        pytest.skip("the default")
    with pytest.raises(TypeError, match=re.escape(f"{what} is {wrong!r}; a whole number is needed")) as caught:
        WHOLE[what][1](scene, wrong)
    say(caught)


@pytest.mark.parametrize("what", WHOLE)
@pytest.mark.parametrize("wrong", [-1, 2**40])
def test_whole_numbers_beyond_their_limits(scene, what, wrong):
    limits, ask = WHOLE[what]
    with pytest.raises(vx.InvalidArgumentError, match=re.escape(f"{what} is {wrong}; a whole number from {limits} is needed")) as caught:
        ask(scene, wrong)
    say(caught)


def test_samples_of_a_projection_that_has_none(scene):
    for projection in ("certified", "view", "two-view"):
        with pytest.raises(vx.InvalidArgumentError, match=f"samples_per_voxel is for projection='dominant-axis', not for '{projection}'") as caught:
            scene.count(cube(), EYE, projection=projection, samples_per_voxel=2)
        say(caught)


@pytest.mark.parametrize("projection, options, message", [
    ("certified", dict(view=vx.View(EYE, 32, 32)), "view is for projection='view' and 'two-view', not for 'certified'"),
    ("dominant-axis", dict(view=vx.View(EYE, 32, 32)), "view is for projection='view' and 'two-view', not for 'dominant-axis'"),
    ("view", dict(resolution=0.5), "resolution is for projection='certified', not for 'view'"),
    ("certified", dict(boundary="clamp"), "boundary='clamp' is not for projection='certified'")])
def test_what_a_projection_does_not_ask(scene, projection, options, message):
    with pytest.raises(vx.InvalidArgumentError, match=message) as caught:
        scene.count(cube(), EYE, projection=projection, **options)
    say(caught)


def test_an_array_for_a_number_is_told_in_one_line(scene):
    with pytest.raises(TypeError, match="margin is array.*; a number is needed") as caught:
        scene.touch(cube(), EYE, margin=EYE)
    say(caught)


def test_labels_that_are_none(files):
    scene = vx.Scene(files / "volume.nii", labels=files / "labels.nii")
    for wrong, error in ((True, TypeError), (2**40, vx.InvalidArgumentError), (-2**31 - 1, vx.InvalidArgumentError)):
        with pytest.raises(error, match="a label is ") as caught:
            scene.distance(cube(), EYE, labels=[wrong])
        say(caught)
    for wrong in ([7.0], [None], [True]):
        with pytest.raises(TypeError, match="a label of avoid is .*; its number or its name is needed") as caught:
            scene.plan((3, 4, 4), avoid=wrong)
        say(caught)
    with pytest.raises(vx.InvalidArgumentError, match="^avoid: the label -1 is to be avoided, which the label map has not") as caught:
        scene.plan((3, 4, 4), avoid=[-1])
    say(caught)


# Words


@pytest.mark.parametrize("ask, text", [
    (lambda scene: scene.distance(cube(), EYE, max_steps=0), "max_steps is 0; a whole number from 1"),
    (lambda scene: scene.motion(cube(), [EYE, EYE], max_steps=0), "max_steps is 0; a whole number from 1"),
    (lambda scene: scene.tracker(cube(), max_steps=0), "max_steps is 0; a whole number from 1"),
    (lambda scene: scene.plan((0, 0, 0), avoid_opacity="1:0,2:1", max_steps=0), "max_steps is 0; a whole number from 1"),
    (lambda scene: scene.plan((0, 0, 0), avoid_opacity="1:0,2:1", entries=2**31), "entries is 2147483648; a whole number from 1 to 3994242"),
    (lambda scene: scene.count(cube(), EYE, projection="dominant-axis", samples_per_voxel=17), "samples_per_voxel is 17; a whole number from 1 to 16"),
    (lambda scene: scene.count(cube(), EYE, contacts=True, max_depth=-1), "max_depth is -1.0; it must be positive"),
    (lambda scene: scene.count(cube(), EYE, max_depth=-1.5), "max_depth is -1.5; it must be positive"),
    (lambda scene: scene.count(cube(), EYE, contacts=True, stop_at_first=True), "a yes or no ends"),
    (lambda scene: scene.count(cube(), EYE, projection="view", view=vx.View(EYE, 10**6, 5)), "1000000x5"),
    (lambda scene: vx.Scene(scene.volume, threads=5000), "threads is 5000; a whole number from 0 to 4096"),
    (lambda scene: vx.Scene(scene.volume, table_size=2**31), "table_size is 2147483648; a whole number from 2 to 16777216"),
    (lambda scene: vx.Scene(scene.volume, domain=(np.nan, 2)), "domain nan:2 is not finite"),
    (lambda scene: vx.Scene(scene.volume, domain=(0, np.inf)), "domain 0:inf is not finite"),
    (lambda scene: scene.picture(background=(2, 0, 0)), "from 0 to 1"),
])
def test_messages_are_in_words(scene, ask, text):
    with pytest.raises(vx.Error, match=text) as caught:
        ask(scene)
    say(caught)


def test_messages_of_a_device_are_in_words(head, device):
    scene = vx.Scene(head, device=device)
    for ask, text in ((lambda: scene.count(cube(), EYE, overestimate=True), "the overestimate is for"),
                      (lambda: scene.count(cube(), EYE, projection="view", counters=True), "counters are of"),
                      (lambda: scene.picture(clip=["left"] * 7), "7 clip planes"),
                      (lambda: scene.picture(clip=(0, 0, 0, 1)), "clip plane 0"),
                      (lambda: scene.picture(cube(), mesh_colours=[(0, 0, 3)]), "mesh_colours")):
        with pytest.raises(vx.InvalidArgumentError, match=text) as caught:
            ask()
        say(caught)


def test_bad_json_is_not_told_whole(tmp_path):
    (tmp_path / "mesh.gltf").write_text(json.dumps({"buffers": [{"uri": "data:;base64," + "A" * 100000}]})[:-5])
    (tmp_path / "opacity.json").write_text('{"points": "' + "A" * 100000)
    for read, name in ((vx.read_mesh, "mesh.gltf"), (vx.read_opacity, "opacity.json")):
        with pytest.raises(vx.FormatError, match="parse error at line 1, column 1") as caught:
            read(tmp_path / name)
        assert len(say(caught).replace(str(tmp_path), "")) < 400


def test_a_threshold_is_written_without_the_locale():
    scene = vx.Scene(vx.read_volume("builtin:head:16"))
    with pytest.raises(vx.InvalidArgumentError, match=r"threshold is -0\.5;"):
        scene.threshold = -0.5
