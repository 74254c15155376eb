#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""clang-tidy on what the build compiles of the given files and folders (src), one process a core.

usage: tidy.py [--all-checks] BUILD_FOLDER [FILE|FOLDER...]

A file that passed is looked at again only when one of the texts that it is compiled from has changed: the file, the
headers of ours that it includes as the last build saw them, its command, the checks, or clang-tidy. What passed is kept
in the build folder as hashes of these. Without --all-checks, the slow one of the checks is left out. The exit status is
1 when there was a finding.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CONFIGS = [ROOT / ".clang-tidy"]
# As long as all others together, in other people's templates.
SLOW_CHECKS = "-performance-unnecessary-value-param"


def headers_of_objects(build):
    """Of each object that ninja knows: the files of ours that it was compiled from."""
    listed = subprocess.run(["ninja", "-C", build, "-t", "deps"], text=True, capture_output=True, check=True).stdout
    found = {}
    for line in listed.splitlines():
        named = re.match(r"(\S+): #deps \d+, .*\((VALID|STALE)\)$", line)
        if named:
            files = found.setdefault(named[1], [])
        elif line.startswith("    "):
            path = (build / line.strip()).resolve()
            if path.is_relative_to(ROOT):
                files.append(path)
    return found


class Hashes:
    def __init__(self):
        self.known = {}

    def of(self, path):
        if path not in self.known:
            self.known[path] = hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "none"
        return self.known[path]


def plain(command):
    """A command of the build as clang-tidy can follow it: the compiler first, and no header that GCC has precompiled."""
    words = shlex.split(command)
    compiler = next(i for i, word in enumerate(words) if re.search(r"(g|c|clang)\+\+(-\d+)?$", word))
    kept = []
    for word in words[compiler:]:
        if word in ("-Winvalid-pch", "-fpch-preprocess"):
            continue
        if word.endswith("/cmake_pch.hxx"):
            kept.pop()  # its -include
            continue
        kept.append(word)
    return shlex.join(kept)


def apart(entry):
    """The source of an entry, with it; of files that are compiled together (CMake's UNITY_BUILD), each with its own."""
    source = pathlib.Path(entry["file"]).resolve()
    if not re.fullmatch(r"unity_\d+_cxx\.cxx", source.name):
        return [(source, entry)]
    sources = re.findall(r'^#include "(.*)"$', source.read_text(), re.MULTILINE)
    return [(pathlib.Path(one).resolve(),
             entry | {"file": one, "command": entry["command"].replace(f" -c {entry['file']}", f" -c {one}")})
            for one in sources]


def commands_of(build, names):
    """The build's commands, plain, of every wanted file that it compiles; of one that it compiles twice the first."""
    roots = [(ROOT / name).resolve() for name in names]
    found = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        for source, own in apart(entry | {"command": plain(entry["command"])}):
            if source.suffix == ".cpp" and any(source.is_relative_to(root) for root in roots):
                found.setdefault(source, own)
    return found


def hashes_of(build, commands, checks):
    """Of each source: all that it is compiled from and looked at by, as one hash."""
    deps = headers_of_objects(build)
    hashes = Hashes()
    version = subprocess.run(["clang-tidy", "--version"], text=True, capture_output=True, check=True).stdout
    for source, entry in commands.items():
        output = re.search(r" -o (\S+)", entry["command"])
        parts = sorted({source, *CONFIGS, *deps.get(output[1] if output else "", [])})
        text = version + checks + entry["command"] + "".join(f"{path}{hashes.of(path)}" for path in parts)
        yield source, hashlib.sha256(text.encode()).hexdigest()


def tidy(database, checks, source):
    command = ["clang-tidy", "--quiet", f"--checks={checks}", "-p", database, source]
    done = subprocess.run(command, text=True, capture_output=True)
    # The count of warnings in other people's headers goes to standard error: of no interest unless it fails.
    return done.returncode == 0, done.stdout + (done.stderr if done.returncode != 0 else "")


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 0 if len(sys.argv) > 1 else 2
    arguments = sys.argv[1:]
    checks = "" if "--all-checks" in arguments else SLOW_CHECKS
    build, *names = [argument for argument in arguments if argument != "--all-checks"]
    build = pathlib.Path(build).resolve()
    passed = build / "tidy"
    passed.mkdir(exist_ok=True)
    commands = commands_of(build, names or ["src"])
    (passed / "compile_commands.json").write_text(json.dumps(list(commands.values())))
    left = [one for one in sorted(hashes_of(build, commands, checks)) if not (passed / one[1]).exists()]
    found = False
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for (_, key), (good, text) in zip(left, pool.map(lambda one: tidy(passed, checks, one[0]), left)):
            print(text, end="")
            if good:
                (passed / key).touch()
            found |= not good
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
