# SPDX-License-Identifier: MIT
"""The wheel of the Python package: CMake builds the module, and what Debian's libraries it needs beyond those of every
Linux (libc, libstdc++, zlib) goes into the wheel with its licence.

VOXTACT_PYTHON_BUILD: a folder that CMake has configured already, to take the module from.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent
# Of every Linux with a C++ program.
COMMON = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+|z))\.so\.\d+")


def version():
    """CMakeLists.txt has it."""
    return re.search(r"project\(voxtact VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def needed(module):
    """The shared libraries that are loaded with a module, by their names."""
    lines = subprocess.run(["ldd", module], check=True, capture_output=True, text=True).stdout.splitlines()
    return {name: pathlib.Path(path) for name, path in re.findall(r"(\S+) => (/\S+)", "\n".join(lines))}


def licence_of(library):
    """Debian's, of the package that a library belongs to; nothing elsewhere."""
    for path in (library, library.resolve()):
        owner = subprocess.run(["dpkg-query", "--search", path], capture_output=True, text=True)
        if owner.returncode == 0:
            return pathlib.Path("/usr/share/doc") / owner.stdout.split(":")[0] / "copyright"
    return None


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        folder = os.environ.get("VOXTACT_PYTHON_BUILD")
        if not folder:
            folder = pathlib.Path(self.build_temp).resolve()
            generator = ["-G", "Ninja"] if shutil.which("ninja") else []
            run("cmake", "-S", ROOT, "-B", folder, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DVOXTACT_BUILD_APP=OFF",
                "-DVOXTACT_BUILD_C=OFF", "-DVOXTACT_BUILD_PYTHON=ON", f"-DVOXTACT_PYTHON={sys.executable}")
        run("cmake", "--build", folder, "--target", "voxtact_python", "--parallel", str(os.cpu_count()))
        module = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve()
        module.parent.mkdir(parents=True, exist_ok=True)
        built = pathlib.Path(folder).resolve() / "python" / "voxtact" / module.name
        shutil.copy2(built, module)
        if shutil.which("strip"):
            run("strip", "--strip-unneeded", module)
        self.bundle(built, module.parent)

    def bundle(self, built, package):
        """Puts libraries beside the module, which looks there first (RUNPATH is $ORIGIN)."""
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


(ROOT / "build").mkdir(exist_ok=True)
setup(
    version=version(),
    packages=["voxtact"],
    package_dir={"": "src/python"},
    package_data={"voxtact": ["*.pyi", "py.typed"]},
    ext_modules=[Extension("voxtact._core", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    options={"egg_info": {"egg_base": "build"}},
    zip_safe=False,
)
