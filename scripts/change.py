#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How many files does a change take? Applies tests/change/method.patch, a dummy counting method, output.patch, a dummy
output, and question.patch, a dummy question, to copies of the sources, and counts their files.

usage: change.py [--build]

--build: builds the programs of the copies too, and asks them whether the new method passes its self-test and counts
what the others count, whether the new output is the count, and whether the new question has options, columns and an
answer. That takes as long as three builds. The exit status is 1
when a patch does not fit, takes more files than docs/change.md says, or what it adds is not right.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
METHOD = "swap"
OUTPUT = "again"
QUESTION = "boxes"
COPIED = ("CMakeLists.txt", "CMakePresets.json", "cmake", "include", "shaders", "src", "tests/oracle", "third_party", "LICENSE")


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


def build(source, with_bench):
    folder = source / "build"
    run("cmake", "-S", source, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DVOXTACT_BUILD_TESTS=OFF",
        f"-DVOXTACT_BUILD_BENCH={'ON' if with_bench else 'OFF'}")
    run("cmake", "--build", folder, "--target", "voxtact_app", *(["voxtact_bench_app"] if with_bench else []))
    return folder / "voxtact"


def check_method(program):
    devices = json.loads(run(program, "devices", "--format", "json"))
    verdicts = [row for row in devices["rows"] if row["method"] == METHOD]
    if not verdicts or not all(verdict["trusted"] for verdict in verdicts):
        fail(f"the method {METHOD} is not there, or does not pass its self-test: {verdicts}")
    run(program, "compare", "--volume", "builtin:head:32", "--mesh", "builtin:scalpel:500", "--number", 16, "--oracle",
        2, "--sweep", "none", "--size", "96x96", "--cache", "off")
    rows = run(program, "count", "--volume", "builtin:head:32", "--mesh", "builtin:scalpel:500", "--method", METHOD,
               "--format", "csv")
    if METHOD not in rows:
        fail(f"count --method {METHOD} printed {rows}")


def check_output(program):
    for method, projection in (("cpu", "certified"), ("cpu", "view"), ("compute", "certified"), ("query", "view")):
        out = run(program, "count", "--volume", "builtin:head:32", "--mesh", "builtin:scalpel:500", "--method", method,
                  "--projection", projection, f"--{OUTPUT}", "--format", "json", "--progress", "never")
        rows = json.loads(out)["rows"]
        if not any(row["count"] for row in rows) or any(row["count"] != row[OUTPUT] for row in rows):
            fail(f"the output {OUTPUT} of {method} {projection} is not the count: {rows}")


def check_question(program):
    if "--border" not in run(program, QUESTION, "--help"):
        fail(f"{QUESTION} --help has no option of the new fact")
    scene = ("--volume", "builtin:head:32", "--mesh", "builtin:ellipsoid:320", "--format", "json", "--progress", "never")
    rows = [json.loads(run(program, QUESTION, *scene, *border))["rows"] for border in ((), ("--border", 1))]
    if not 0 < rows[0][0]["lower"] == rows[0][0]["upper"] < rows[1][0]["lower"]:
        fail(f"the question {QUESTION} is not about the box of the mesh: {rows}")


# Each with what docs/change.md says: the steps 1 to 3 of a counting method, and all of an output but its documentation.
CHANGES = (
    ("a counting method", "method.patch", 5, "src/core/method/method_table.h", f'"{METHOD}"', check_method),
    ("an output", "output.patch", 7, "src/device/outputs/output_parts.cpp", f'"{OUTPUT}"', check_output),
    ("a question", "question.patch", 6, "src/core/facts/facts.h", f'"{QUESTION}"', check_question),
)


def measure(scratch, builds, what, name, most, place, mark, check):
    patch = ROOT / "tests" / "change" / name
    shutil.rmtree(scratch, ignore_errors=True)
    copy_sources(scratch)
    # The copy lies in a checkout, of which git would take it for a part.
    run("git", "apply", patch, cwd=scratch, env={**os.environ, "GIT_CEILING_DIRECTORIES": str(scratch.parent)})
    if mark not in (scratch / place).read_text():
        fail(f"git left {name} out")
    files = [line.split()[1] for line in patch.read_text().splitlines() if line.startswith("+++ ")]
    if len(files) > most:
        fail(f"{what} takes {len(files)} files, more than {most}: {', '.join(files)}")
    if builds:
        check(build(scratch, check is check_method)) # voxtact compare is a program of its own
    print(f"change: {what} takes {len(files)} files" + (", and is right" if builds else ""))
    shutil.rmtree(scratch, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", action="store_true")
    builds = parser.parse_args().build
    # Apart from each other: a test does the one while the other builds for minutes.
    scratch = ROOT / "build" / ("change-build" if builds else "change")
    for change in CHANGES:
        measure(scratch, builds, *change)


if __name__ == "__main__":
    main()
