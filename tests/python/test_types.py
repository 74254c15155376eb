# SPDX-License-Identifier: MIT
"""Types and docstrings."""
import inspect
import os
import pathlib
import pydoc
import subprocess
import sys

import voxtact as vx
from conftest import ROOT

SOURCE = ROOT / "src" / "python" / "voxtact"

USER = '''
import numpy as np
import voxtact as vx

scene = vx.Scene(vx.read_volume("head.nii"), opacity=[(40, 0), (80, 1)], threshold=0.1)
mesh: vx.Mesh = vx.read_mesh((np.zeros((3, 3)), np.array([[0, 1, 2]])))
answer: vx.Count = scene.count(mesh, np.eye(4), contacts=True, projection="view")
hits: int = int(answer.touches.sum())
nearest: float = float(scene.distance([(mesh, np.eye(4))]).lower.min())
scene.edit(ball=(0, 0, 0, 5), value=-1000)
look: vx.Look = vx.look("mr", scene.volume)
shown: int = int(scene.picture([(mesh, np.eye(4))], clip=["left", ("near", 3), (1, 0, 0, 5)], colours=look.colours,
                               triangles=answer.triangles, show="triangles", lighting="eye").max())
near: list[int] = vx.overlapping_pairs(mesh.boxes_at(np.eye(4)), [scene.volume.bounds])[:, 0].tolist()
first: vx.QuestionInfo = vx.questions()[0]
lower: float = float(scene.ask(first.name, mesh, np.eye(4), **{one.name: one.default for one in vx.settings("area")})["pairs"]["lower"][0])
trusted: bool = vx.Device().self_test()["compute"].trusted
'''


def mypy(*arguments, cwd):
    return subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", str(cwd.parent / "mypy_cache"), *map(str, arguments)], cwd=cwd,
                          env={**os.environ, "MYPYPATH": str(SOURCE.parent)}, capture_output=True, text=True)


def test_the_package_passes_mypy(tmp_path):
    done = mypy("--strict", "--ignore-missing-imports", SOURCE, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_user_is_checked(tmp_path):
    (tmp_path / "user.py").write_text(USER)
    done = mypy("--strict", "--ignore-missing-imports", "user.py", cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    (tmp_path / "wrong.py").write_text(USER.replace('projection="view"', 'projection="sideways"')
                                       .replace("nearest: float", "nearest: str"))
    done = mypy("--strict", "--ignore-missing-imports", "wrong.py", cwd=tmp_path)
    assert done.stdout.count("error:") == 2, done.stdout


def test_everything_public_says_what_it_is():
    for name in vx.__all__:
        thing = getattr(vx, name)
        if inspect.isclass(thing) or inspect.isfunction(thing):
            assert inspect.getdoc(thing), name
            assert thing.__module__ == "voxtact", name
        if inspect.isclass(thing) and not issubclass(thing, (Exception, tuple)):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    assert inspect.getdoc(value), f"{name}.{member}"
    assert (pathlib.Path(vx.__file__).parent / "py.typed").exists()


def test_help_reads_well():
    text = pydoc.plain(pydoc.render_doc(vx))
    for word in ("class Scene", "touch(self, mesh", "count(self, mesh", "LPS", "read_volume(source", "(N,4,4)"):
        assert word in text, word
    for ugly in ("cdata", "_core.Scene", "arg0"):
        assert ugly not in text, ugly
