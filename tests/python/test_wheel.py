# SPDX-License-Identifier: MIT
"""The wheel, the sources and the installed package: each stands alone."""
import os
import pathlib
import re
import subprocess
import sys
import tarfile
import zipfile

import pytest

from conftest import ROOT

BUILD = os.environ["VOXTACT_BUILD"]

USE = """
import pathlib
import numpy as np
import voxtact as vx
scene = vx.Scene("builtin:head:16", opacity=[(40, 0), (80, 1)])
print(vx.__file__)
print(scene.count(vx.read_mesh("builtin:scalpel:300"), np.eye(4)).touches.shape)
print(*{line.split()[-1] for line in pathlib.Path("/proc/self/maps").read_text().splitlines() if "libhwy.so" in line})
"""


def outside(*command, cwd, **environment):
    """Runs a command that must not find the build tree's package."""
    env = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    return subprocess.run([str(word) for word in command], cwd=cwd, env={**env, **environment}, capture_output=True,
                          text=True)


@pytest.fixture(scope="module")
def distributions(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    done = outside(sys.executable, "-m", "build", "--no-isolation", "--sdist", "--wheel", "--outdir", folder, cwd=ROOT,
                   VOXTACT_PYTHON_BUILD=BUILD)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return folder


def test_the_wheel_in_an_environment_of_its_own(distributions, tmp_path):
    (wheel,) = distributions.glob("*.whl")
    assert re.fullmatch(r"voxtact-\d+\.\d+\.\d+-py3-none-linux_\w+\.whl", wheel.name)
    names = zipfile.ZipFile(wheel).namelist()
    for name in ("voxtact/__init__.py", "voxtact/py.typed", "voxtact/_cdef.py", "voxtact/libvoxtact.so", "voxtact/LICENSE"):
        assert name in names
    bundled = [name for name in names if re.search(r"\.so\.\d+$", name)]
    for name in bundled:  # each with the terms that it comes under
        assert f"voxtact/licences/{name.split('/')[-1]}.txt" in names
    python = tmp_path / "venv" / "bin" / "python"
    # numpy and cffi are the system's; the index is not asked for anything.
    assert outside(sys.executable, "-m", "venv", "--system-site-packages", tmp_path / "venv", cwd=tmp_path).returncode == 0
    done = outside(python, "-m", "pip", "install", "--no-index", wheel, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    done = outside(python, "-c", USE, cwd=tmp_path)
    lines = done.stdout.splitlines()
    assert done.returncode == 0 and lines[1] == "(1,)", done.stderr
    assert str(tmp_path / "venv") in lines[0] and str(tmp_path / "venv") in lines[2], "it uses its own libraries"
    module = next((tmp_path / "venv").rglob("libvoxtact.so"))
    needs = outside("ldd", module, cwd=tmp_path).stdout
    assert "not found" not in needs and "ITK" not in needs and "libvulkan" not in needs
    checked = outside("cmake", f"-DPLACES={module.parent}", "-DREADELF=readelf", f"-DBUILD={BUILD}", "-P",
                      ROOT / "tests/package/runpath.cmake", cwd=tmp_path)
    assert checked.returncode == 0, checked.stderr


def test_the_sources_are_complete(distributions, tmp_path):
    (sources,) = distributions.glob("*.tar.gz")
    with tarfile.open(sources) as archive:
        archive.extractall(tmp_path)
    (folder,) = tmp_path.iterdir()
    assert (folder / "src" / "python" / "make_cdef.py").exists() and not (folder / "tests").exists()
    target = ["--build", tmp_path / "build", "--target", "voxtact_python"]
    done = outside("cmake", "-S", folder, "-B", tmp_path / "build", "-G", "Ninja", "-DVOXTACT_BUILD_APP=OFF", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    # All that is compiled is there; compiling it takes minutes.
    extra = [] if os.environ.get("VOXTACT_TEST_LONG") else ["--", "-n"]
    done = outside("cmake", *target, *extra, cwd=tmp_path)
    assert done.returncode == 0, done.stdout[-3000:]


def test_the_installed_package(tmp_path):
    done = outside("cmake", "--install", BUILD, "--component", "voxtact_python", "--prefix", tmp_path, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    (package,) = tmp_path.rglob("voxtact")
    assert package.parent.name in ("dist-packages", "site-packages")
    done = outside(sys.executable, "-c", USE, cwd=tmp_path, PYTHONPATH=str(package.parent))
    assert done.returncode == 0 and str(tmp_path) in done.stdout, done.stderr
    assert {path.suffix for path in package.iterdir()} <= {".py", ".so", ".typed", ""}


def test_the_library_exports_the_c_interface_alone():
    library = pathlib.Path(BUILD, "python", "voxtact", "libvoxtact.so")
    listed = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    names = {line.split()[-1] for line in listed.splitlines()}
    assert names and all(name.startswith("vxt_") for name in names), sorted(names)[:5]
