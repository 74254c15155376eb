# SPDX-License-Identifier: MIT
"""The examples run, and so does the Python in the manual, as a reader would."""
import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest

from conftest import ROOT, program

EXAMPLES = sorted((ROOT / "docs" / "example" / "python").glob("*.py"))
FEWER = {"regions": ["2000"], "dask_poses": ["20000"]}
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


def run(script, cwd, *arguments):
    env = {**os.environ, "MPLBACKEND": "Agg"}
    done = subprocess.run([sys.executable, "-W", "error::DeprecationWarning:__main__", script, *arguments], cwd=cwd, env=env,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


@pytest.mark.parametrize("script", EXAMPLES, ids=lambda path: path.stem)
def test_example(script, tmp_path):
    if script.stem == "dask_poses":
        pytest.importorskip("dask.distributed")
    text = script.read_text()
    assert text.splitlines()[1:3] == ["# %% [markdown]", text.splitlines()[2]] and "\n# %%\n" in text, "not in cells"
    printed = run(script, tmp_path, *FEWER.get(script.stem, []))
    assert printed
    if script.stem in ("insertion", "motion"):
        assert (tmp_path / f"{script.stem}.png").stat().st_size > 10_000
    if script.stem == "slicer":
        check_slicer(tmp_path, printed)


def check_slicer(folder, printed):
    """VTK reads the points, and the box holds them."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(folder / "contacts.vtp"))
    reader.Update()
    points = vtk_to_numpy(reader.GetOutput().GetPoints().GetData())
    assert len(points) == int(printed.split()[0]) > 100
    assert vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("depth")).max() > 0
    markups = json.loads((folder / "contacts.mrk.json").read_text())["markups"]
    box = markups[1]
    axes = np.reshape(box["orientation"], (3, 3))
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(axes) > 0
    assert (np.abs((points - box["center"]) @ axes) <= np.array(box["size"]) / 2 + 1e-6).all()
    np.testing.assert_allclose(markups[0]["controlPoints"][0]["position"], points[0])


@pytest.mark.parametrize("page", [page for page in PAGES if BLOCK.search(page.read_text())], ids=lambda path: path.stem)
def test_page(page, tmp_path):
    """Its blocks in order, as one script, with the small files that they name."""
    program("make", "volume", "builtin:head:32", "head.nii.gz", cwd=tmp_path)
    program("make", "mesh", "builtin:scalpel:300", "tool.stl", cwd=tmp_path)
    program("make", "poses", "--volume", "head.nii.gz", "--mesh", "tool.stl", "--number", 8, "--seed", 7, "--output",
            "poses.txt", cwd=tmp_path)
    (tmp_path / "page.py").write_text("\n".join(BLOCK.findall(page.read_text())))
    assert run(tmp_path / "page.py", tmp_path)


def test_the_page_names_every_example():
    text = (ROOT / "docs" / "python.md").read_text()
    for script in EXAMPLES:
        assert f"(example/python/{script.name})" in text
