# SPDX-License-Identifier: MIT
"""The wheel of the Python package, one for all Pythons: CMake builds the library of the C interface, and what Debian's
libraries it needs beyond those of every Linux (libc, libstdc++, zlib) goes into the wheel with its licence.

VOXTACT_PYTHON_BUILD: a folder that CMake has configured already, to take the library from.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:
    from wheel.bdist_wheel import bdist_wheel

ROOT = pathlib.Path(__file__).resolve().parent
# Of every Linux with a C++ program.
COMMON = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+|z))\.so\.\d+")


def version():
    """version.h has it."""
    return ".".join(re.findall(r"define VOXTACT_VERSION_\w+ (\d+)", (ROOT / "include/voxtact/version.h").read_text()))


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def needed(library):
    """The shared libraries that are loaded with a library, by their names."""
    lines = subprocess.run(["ldd", library], check=True, capture_output=True, text=True).stdout.splitlines()
    return {name: pathlib.Path(path) for name, path in re.findall(r"(\S+) => (/\S+)", "\n".join(lines))}


def licence_of(library):
    """Debian's, of the package that a library belongs to; nothing elsewhere."""
    for path in (library, library.resolve()):
        owner = subprocess.run(["dpkg-query", "--search", path], capture_output=True, text=True)
        if owner.returncode == 0:
            return pathlib.Path("/usr/share/doc") / owner.stdout.split(":")[0] / "copyright"
    return None


class CMakeBuild(build_py):
    """The package's files, and what CMake makes for them: the library, and what cffi knows of it."""

    def run(self):
        super().run()
        folder = os.environ.get("VOXTACT_PYTHON_BUILD")
        if not folder:
            folder = ROOT / "build" / "wheel-cmake"
            generator = ["-G", "Ninja"] if shutil.which("ninja") else []
            run("cmake", "-S", ROOT, "-B", folder, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DVOXTACT_BUILD_APP=OFF",
                "-DVOXTACT_BUILD_PYTHON=ON", f"-DVOXTACT_PYTHON={sys.executable}")
        run("cmake", "--build", folder, "--target", "voxtact_python", "--parallel", str(os.cpu_count()))
        package, built = pathlib.Path(self.build_lib) / "voxtact", pathlib.Path(folder).resolve() / "python" / "voxtact"
        for name in ("_cdef.py", "libvoxtact.so"):
            shutil.copy2(built / name, package / name)
        if shutil.which("strip"):
            run("strip", "--strip-unneeded", package / "libvoxtact.so")
        self.bundle(built / "libvoxtact.so", package)

    def bundle(self, built, package):
        """Puts libraries beside ours, which looks there first (RUNPATH is $ORIGIN)."""
        shutil.rmtree(package / "licences", ignore_errors=True)
        for name, path in needed(built).items():
            if COMMON.fullmatch(name):
                continue
            shutil.copy2(path, package / name)
            licence = licence_of(path)
            if licence is not None and licence.exists():
                (package / "licences").mkdir(exist_ok=True)
                shutil.copy2(licence, package / "licences" / f"{name}.txt")
        shutil.copy2(ROOT / "LICENSE", package / "LICENSE")


class Wheel(bdist_wheel):
    """Of every Python 3, on this kind of machine: nothing in it is compiled for a Python."""

    def finalize_options(self):
        super().finalize_options()
        self.root_is_pure = False

    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


class Binary(Distribution):
    """Goes where libraries go."""

    def has_ext_modules(self):
        return True


(ROOT / "build").mkdir(exist_ok=True)
setup(
    version=version(),
    packages=["voxtact"],
    package_dir={"": "src/python"},
    package_data={"voxtact": ["py.typed"]},
    distclass=Binary,
    cmdclass={"build_py": CMakeBuild, "bdist_wheel": Wheel},
    options={"egg_info": {"egg_base": "build"}},
    zip_safe=False,
)
