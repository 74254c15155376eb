# SPDX-License-Identifier: MIT
"""The binding itself: what cffi knows is in the library, each column of each answer is an array, and the defaults of the
package are those of the table of facts."""
import gc
import inspect
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest

import voxtact as vx
from conftest import ROOT, cube, random_poses
from voxtact import _library
from voxtact._library import FACTS, ffi, lib

HEADERS = sorted((ROOT / "include" / "voxtact").glob("voxtact*.h"))


def test_every_function_is_in_the_library():
    text = "".join(header.read_text() for header in HEADERS)
    declared = set(re.findall(r"^VXT_(?:API|CHECKED)[^;(]*?\b(vxt_\w+)\(", text, re.MULTILINE))
    assert len(declared) > 200
    known = {name for name in dir(lib) if name.startswith("vxt_")}
    assert known == declared
    for name in declared:
        assert ffi.typeof(getattr(lib, name)).kind == "function"


def test_structs_are_as_large_as_in_c(tmp_path):
    """Of each struct that has its size in it, and of all others, as the C compiler has them."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("there is no C compiler")
    names = [name for name in ffi.list_types()[0] if name.startswith("vxt_") and ffi.typeof(name).kind == "struct"
             and ffi.typeof(name).fields is not None]
    assert len(names) > 50
    lines = "".join(f'printf("{name} %zu\\n", sizeof({name}));\n' for name in names)
    (tmp_path / "sizes.c").write_text('#include "voxtact/voxtact_vulkan.h"\n#include <stdio.h>\n'
                                      f"int main(void) {{\n{lines}return 0;\n}}\n")
    subprocess.run([compiler, f"-I{ROOT / 'include'}", tmp_path / "sizes.c", "-o", tmp_path / "sizes"], check=True)
    printed = subprocess.run([tmp_path / "sizes"], check=True, capture_output=True, text=True).stdout
    assert dict(line.split() for line in printed.splitlines()) == {name: str(ffi.sizeof(name)) for name in names}


@pytest.fixture(scope="module")
def answers(head, knife):
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], labels=head)
    poses = random_poses(8, 3)
    return {"count": scene.count(knife, poses, contacts=True, triangles=True, bounds=True, labels=True),
            "touch": scene.touch(knife, poses),
            "distance": scene.distance(knife, poses[:2], labels=True), "area": scene.area(knife, poses, triangles=True),
            "overlap": scene.overlap(knife, poses[:2], bands=[50]),
            "motion": scene.motion(knife, poses), "plan": scene.plan((0, 0, 0), avoid=[255], entries=42)}


TABLES = {"count": {"pairs", "triangles", "contacts", "bounds", "labels", "totals"}, "touch": {"pairs", "totals"},
          "distance": {"pairs", "labels", "totals"}, "area": {"pairs", "triangles", "labels", "totals"},
          "overlap": {"pairs", "bands", "labels", "totals"}, "motion": {"segments", "totals"}, "plan": {"paths", "triangles", "totals"}}


@pytest.mark.parametrize("question", TABLES)
def test_every_column_is_an_array(answers, question):
    tables = answers[question]._tables
    (handle,) = tables.handles()
    column = _library.struct("column")
    seen = set()
    for index in range(lib.vxt_answer_columns(handle)):
        _library.check(lib.vxt_answer_column(handle, index, column))
        table, name = (_library.text_of(text) for text in (column.table, column.name))
        seen.add(table)
        rows = tables.rows(table)
        assert len(rows) == column.rows and rows.dtype.itemsize == column.stride
        assert rows[name].shape == ((column.rows,) if column.elements == 1 else (column.rows, column.elements))
        assert rows[name].size == 0 or rows[name].ctypes.data == int(ffi.cast("uintptr_t", column.data)), "not a view"
        assert _library.text_of(column.text)
        choices = _library.text_of(column.choices)
        assert not choices or (rows[name] < len(choices.split(","))).all()
    assert seen == TABLES[question]
    assert len(tables.rows("totals")) == 1


def test_an_array_keeps_its_answer(head, knife):
    rows = vx.Scene(head, opacity=[(40, 0), (80, 1)]).count(knife, random_poses(50, 3))._tables.rows("pairs")
    before = rows.copy()
    gc.collect()
    others = [np.full(400, 7.5) for _ in range(500)]
    assert (rows == before).all() and others


#: Arguments of the package by the fact that is their default.
ARGUMENTS = {("scene", "opacity_threshold"): (vx.Scene.__init__, "threshold"), ("scene", "deflection"): (vx.read_mesh, "deflection"),
             ("plan", "tolerance"): (vx.Scene.plan, "tolerance"), ("plan", "margin"): (vx.Scene.plan, "margin")}
#: The package has its own default, or does not offer the setting.
OTHERS = {("count", "projection"), ("overlap", "max_steps"), ("motion", "touch_resolution"), ("distance", "resolution"),
          ("area", "resolution")}


def test_defaults_are_the_facts():
    names = {one.name for one in vx.questions()}
    assert {question for question, _ in FACTS} == names | {"scene", "plan"}
    for (question, name), fact in FACTS.items():
        assert fact.range and fact.text and fact.name == name, name
        if fact.default is not None and (question, name) not in OTHERS:
            function, argument = ARGUMENTS.get((question, name)) or (getattr(vx.Scene, question), name)
            assert inspect.signature(function).parameters[argument].default == fact.default, (question, name)
    assert OTHERS <= set(FACTS) and set(ARGUMENTS) <= set(FACTS)


def test_a_zero_is_no_default(head, knife):
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)])
    for ask in (lambda: scene.count(knife, np.eye(4), resolution=0), lambda: scene.distance(knife, np.eye(4), tolerance=0),
                lambda: scene.distance(knife, np.eye(4), max=0), lambda: scene.area(knife, np.eye(4), tolerance=0),
                lambda: scene.motion(knife, random_poses(2, 1), resolution=0), lambda: scene.overlap(knife, np.eye(4), tolerance=0),
                lambda: scene.touch(knife, np.eye(4), resolution=0), lambda: scene.tracker(knife, max=0),
                lambda: scene.tracker(knife, resolution=0), lambda: scene.plan((0, 0, 0), avoid_opacity="0:0,1:1", tolerance=0),
                lambda: scene.plan((0, 0, 0), avoid_opacity="0:0,1:1", max_length=0)):
        with pytest.raises(vx.InvalidArgumentError, match="0 .*is not a number (from|above)"):
            ask()
    with pytest.raises(vx.InvalidArgumentError, match="needle"):
        scene.plan((0, 0, 0), avoid_opacity="0:0,1:1", needle=(0, 200))
    with pytest.raises(vx.InvalidArgumentError, match="domain 0:0"):
        vx.Scene(head, domain=(0, 0))
    with pytest.raises(vx.InvalidArgumentError, match="scale=0"):
        vx.read_mesh("none.stl", scale=0)


def test_a_threshold_of_zero_is_no_default(head, knife):
    far = np.eye(4)
    far[:3, 3] = 60
    scene = vx.Scene(head, opacity=[(254, 0), (255, 1)], threshold=0)
    pose = np.eye(4)
    assert scene.touch(knife, pose).touches[0] and scene.count(knife, [pose]).touches[0]
    assert scene.distance(knife, pose).upper[0] == 0 and math.isfinite(scene.distance(knife, far).upper[0])


def test_one_pose_is_as_many(head, knife):
    """A yes or no about one pose has a way of its own."""
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)])
    poses = random_poses(60, 5)
    many = scene.touch(knife, poses)
    for number, pose in enumerate(poses):
        one = scene.touch(knife, pose)
        for name in ("touches", "undecided", "item"):
            assert getattr(one, name).dtype == getattr(many, name).dtype
            np.testing.assert_array_equal(getattr(one, name), getattr(many, name)[number:number + 1])
        assert (one.method, one.item.tolist(), one.pose.tolist()) == ("cpu", [0], [0])
        assert one.seconds > 0 and len(one) == 1
    for row, wrong in ((0, np.nan), (3, 0.5)):
        pose = np.eye(4)
        pose[row, 1] = wrong
        with pytest.raises(vx.InvalidArgumentError, match="^pose 0: "):
            scene.touch(knife, pose)


def test_garbage_in_any_order(device, head):
    """A device that ends in a cycle with what is on it ends after it."""
    for _ in range(3):
        loop = [vx.Device(device.info.number)]
        loop.append(vx.Scene(head, opacity=[(40, 0), (80, 1)], device=loop[0]))
        loop[1].count(cube(), np.eye(4))
        loop[1].picture(size=(8, 8))
        loop.append(loop)
        bound = len(_library._bound)
        del loop
        gc.collect()
        assert len(_library._bound) < bound
        assert not _library._waiting


ELSEWHERE = "import voxtact as vx; print(vx.__version__)"


def test_a_library_of_ones_own(tmp_path):
    beside = pathlib.Path(vx.__file__).parent / "libvoxtact.so"
    other = shutil.copy2(beside, tmp_path / "other.so")
    for place, status in ((other, 0), (tmp_path / "none.so", 1)):
        done = subprocess.run([sys.executable, "-c", ELSEWHERE], env={**os.environ, "VOXTACT_LIBRARY": str(place)}, capture_output=True,
                              text=True)
        assert done.returncode == status, done.stderr
    assert "the library of voxtact cannot be loaded" in done.stderr
