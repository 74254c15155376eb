#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How many files does a change take? Applies tests/change/method.patch, a dummy counting method, to a copy of the
sources, and counts its files.

usage: change.py [--build]

--build: builds the program of the copy too, and asks it whether the new method passes its self-test and counts what
the others count. That takes as long as a build. The exit status is 1 when the patch does not fit, takes more files than
docs/change.md says, or the method does not count right.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PATCH = ROOT / "tests" / "change" / "method.patch"
METHOD = "swap"
MOST_FILES = 5 # steps 1 to 3 of docs/change.md, "A counting method"
COPIED = ("CMakeLists.txt", "CMakePresets.json", "cmake", "include", "shaders", "src", "third_party", "LICENSE")


def fail(text):
    sys.exit(f"change: {text}")


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True, **options)
    if done.returncode != 0:
        fail(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout


def copy_sources(to):
    to.mkdir(parents=True, exist_ok=True)
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, to / name, dirs_exist_ok=True)
        else:
            shutil.copy2(source, to / name)


def build(source):
    folder = source / "build"
    run("cmake", "-S", source, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DVOXTACT_BUILD_TESTS=OFF")
    run("cmake", "--build", folder, "--target", "voxtact_app")
    return folder / "voxtact"


def check(program):
    devices = json.loads(run(program, "devices", "--format", "json"))
    verdicts = [row for row in devices["rows"] if row["method"] == METHOD]
    if not verdicts or not all(verdict["trusted"] for verdict in verdicts):
        fail(f"the method {METHOD} is not there, or does not pass its self-test: {verdicts}")
    run(program, "compare", "--volume", "builtin:head:32", "--mesh", "builtin:scalpel:500", "--number", 16, "--oracle",
        2, "--sweep", "none", "--size", "96x96", "--cache", "off")
    rows = run(program, "detect", "--volume", "builtin:head:32", "--mesh", "builtin:scalpel:500", "--count", METHOD,
               "--format", "csv")
    if METHOD not in rows:
        fail(f"detect --count {METHOD} printed {rows}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", action="store_true")
    arguments = parser.parse_args()
    # Apart from each other: a test does the one while the other builds for minutes.
    scratch = ROOT / "build" / ("change-build" if arguments.build else "change")
    shutil.rmtree(scratch, ignore_errors=True)
    copy_sources(scratch)
    # The copy lies in a checkout, of which git would take it for a part.
    run("git", "apply", PATCH, cwd=scratch, env={**os.environ, "GIT_CEILING_DIRECTORIES": str(scratch.parent)})
    if f'"{METHOD}"' not in (scratch / "src" / "core" / "method" / "method_table.h").read_text():
        fail("git left the patch out")
    files = [line.split()[1] for line in PATCH.read_text().splitlines() if line.startswith("+++ ")]
    if len(files) > MOST_FILES:
        fail(f"a counting method takes {len(files)} files, more than {MOST_FILES}: {', '.join(files)}")
    if arguments.build:
        check(build(scratch))
    print(f"change: a counting method takes {len(files)} files" + (", and counts" if arguments.build else ""))
    shutil.rmtree(scratch, ignore_errors=True)


if __name__ == "__main__":
    main()
