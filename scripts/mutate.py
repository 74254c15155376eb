#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Do the tests notice a small mistake? Makes each mistake of tests/mutants/*.toml in a scratch copy of the working
tree, builds the tests that should notice, and runs them.

usage: mutate.py [--list] [--least PERCENT] [ID|ROOM...]

A mutant is a table [[mutant]] of a file named after the room that it is in:
  id          its name
  file        the file that is changed
  old, new    a text that stands exactly once in the file, and what it becomes
  tests       a list of PROGRAM or PROGRAM:FILTER (GoogleTest's); noticed is what makes one of them fail
  equivalent  why no test can notice (left out: one must)
The exit status is 1 when fewer than PERCENT (97) of those that are not equivalent are noticed, or when the list does
not fit the sources.
"""
import argparse
import fnmatch
import os
import pathlib
import shutil
import subprocess
import sys
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "mutate"
SOURCE = WORK / "source"
BUILD = SOURCE / "build" / "release" # where a checkout has it, so that ccache knows its files
SECONDS_A_TEST = 300


def fail(text):
    sys.exit(f"mutate: {text}")


def read_mutants(wanted):
    mutants = []
    for path in sorted((ROOT / "tests" / "mutants").glob("*.toml")):
        for mutant in tomllib.loads(path.read_text())["mutant"]:
            missing = {"id", "file", "old", "new", "tests"} - mutant.keys()
            if missing:
                fail(f"{path.name}: a mutant without {', '.join(sorted(missing))}: {mutant.get('id', '?')}")
            mutant["room"] = path.stem
            mutants.append(mutant)
    names = [mutant["id"] for mutant in mutants]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        fail(f"named twice: {', '.join(sorted(twice))}")
    for mutant in mutants:
        times = (ROOT / mutant["file"]).read_text().count(mutant["old"])
        if times != 1 or mutant["old"] == mutant["new"]:
            fail(f"{mutant['id']}: the old text stands {times} times in {mutant['file']}; it must stand once")
    unknown = set(wanted) - set(names) - {mutant["room"] for mutant in mutants}
    if unknown:
        fail(f"not in tests/mutants: {', '.join(sorted(unknown))}")
    return [m for m in mutants if not wanted or m["id"] in wanted or m["room"] in wanted]


def copy_sources():
    """Files that did not change keep their time, so that a second run builds only what did."""
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"], cwd=ROOT,
                            check=True, capture_output=True).stdout.decode().split("\0")
    kept = set()
    for name in filter(None, listed):
        source, target = ROOT / name, SOURCE / name
        if not source.is_file():
            continue
        kept.add(target)
        if not target.is_file() or target.read_bytes() != source.read_bytes():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)
    for target in SOURCE.rglob("*"):
        if target.is_file() and target not in kept and BUILD.parent not in target.parents:
            target.unlink()
    # Tests look for it beside the checkout.
    shared = WORK / "shared"
    if (ROOT.parent / "shared").is_dir() and not shared.exists():
        shared.symlink_to(ROOT.parent / "shared")


def build(targets):
    return subprocess.run(["ninja", "-C", str(BUILD), *sorted(targets)], capture_output=True, text=True)


def program(name):
    for folder in ("cpu", "gpu", "unit", "io", "cli", "faults", "fuzz", "lab"):
        path = BUILD / "tests" / folder / name
        if path.is_file():
            return path
    return fail(f"there is no test program {name}")


def failure(test):
    """What the test says where it fails, crashes or hangs; None: it passes."""
    name, _, pattern = test.partition(":")
    command = [str(program(name)), "--gtest_brief=1", "--gtest_fail_fast"]
    if pattern:
        command.append(f"--gtest_filter={pattern}")
    try:
        run = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=SECONDS_A_TEST,
                             cwd=program(name).parent)
    except subprocess.TimeoutExpired:
        return f"longer than {SECONDS_A_TEST} s"
    if run.returncode == 0 and "[  PASSED  ] 0 tests" in run.stdout:
        fail(f"{test}: no such test")
    return run.stdout[-3000:] + run.stderr[-1000:] if run.returncode != 0 else None


def noticed(test):
    return failure(test) is not None


def check_names(tests):
    """A test that got another name would judge nothing any more."""
    listed = {}
    for test in sorted(tests):
        name, _, patterns = test.partition(":")
        if name not in listed:
            run = subprocess.run([str(program(name)), "--gtest_list_tests"], capture_output=True, text=True, check=True)
            suite = ""
            listed[name] = []
            for line in run.stdout.splitlines():
                line = line.partition("#")[0].rstrip()
                suite = line if not line.startswith(" ") else suite
                if line.startswith(" "):
                    listed[name].append(suite + line.strip())
        for pattern in filter(None, patterns.split(":")):
            if not fnmatch.filter(listed[name], pattern):
                fail(f"{test}: no test is called {pattern}")


def targets_of(mutants):
    return {test.partition(":")[0] for mutant in mutants for test in mutant["tests"]}


def prepare(mutants):
    copy_sources()
    if not (BUILD / "build.ninja").is_file():
        configured = subprocess.run(["cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                                     "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
                                     # a mistake may leave a variable unused
                                     "-DVOXTACT_WARNINGS_AS_ERRORS=OFF"],
                                    capture_output=True, text=True)
        if configured.returncode != 0:
            fail(configured.stderr)
    built = build(targets_of(mutants))
    if built.returncode != 0:
        fail(f"the sources do not build as they are:\n{built.stdout[-3000:]}")
    tests = {test for mutant in mutants for test in mutant["tests"]}
    check_names(tests)
    for test in sorted(tests):
        said = failure(test)
        if said is not None:
            fail(f"{test} fails without any mutant:\n{said}")


def judge(mutant):
    path = SOURCE / mutant["file"]
    original = path.read_text()
    path.write_text(original.replace(mutant["old"], mutant["new"]))
    try:
        for test in mutant["tests"]:
            # a program at a time: most mutants are noticed by the first
            built = build({test.partition(":")[0]})
            if built.returncode != 0:
                return "does not compile", built.stdout[-2000:]
            if noticed(test):
                return "noticed", test
        return ("equivalent", mutant["equivalent"]) if "equivalent" in mutant else ("SURVIVED", "")
    finally:
        path.write_text(original)


def main():
    parser = argparse.ArgumentParser(add_help=True, description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--least", type=float, default=97)
    parser.add_argument("wanted", nargs="*")
    arguments = parser.parse_args()
    mutants = read_mutants(arguments.wanted)
    if arguments.list:
        for mutant in mutants:
            print(f"{mutant['room']}: {mutant['id']}: {mutant['file']}")
        print(f"{len(mutants)} mutants")
        return
    os.environ["GTEST_COLOR"] = "no"
    prepare(mutants)
    counts = {}
    for number, mutant in enumerate(mutants, 1):
        begun = time.monotonic()
        verdict, detail = judge(mutant)
        counts[verdict] = counts.get(verdict, 0) + 1
        print(f"{number}/{len(mutants)} {verdict}: {mutant['id']} ({time.monotonic() - begun:.0f} s) {detail}", flush=True)
    if "does not compile" in counts:
        fail(f"{counts['does not compile']} mutants do not compile")
    judged = len(mutants) - counts.get("equivalent", 0)
    share = 100 * counts.get("noticed", 0) / max(judged, 1)
    print(f"{counts.get('noticed', 0)} of {judged} noticed ({share:.1f} %), {counts.get('equivalent', 0)} equivalent")
    if share < arguments.least:
        fail(f"fewer than {arguments.least:g} % are noticed")


if __name__ == "__main__":
    main()
