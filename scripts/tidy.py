#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""clang-tidy on what the build compiles of the given files and folders (src), one process a core.

usage: tidy.py BUILD_FOLDER [FILE|FOLDER...]

A file that passed is looked at again only when one of the texts that it is compiled from has changed: the file, the
headers of ours that it includes as the last build saw them, its command, the checks, or clang-tidy. What passed is kept
in the build folder as hashes of these. The exit status is 1 when there was a finding.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CONFIGS = [ROOT / ".clang-tidy"]


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


def wanted(build, names):
    """(source, what it is compiled from as one hash) of every wanted file that the build compiles."""
    roots = [(ROOT / name).resolve() for name in names]
    deps = headers_of_objects(build)
    hashes = Hashes()
    version = subprocess.run(["clang-tidy", "--version"], text=True, capture_output=True, check=True).stdout
    for command in json.loads((build / "compile_commands.json").read_text()):
        source = pathlib.Path(command["file"]).resolve()
        if source.suffix != ".cpp" or not any(source.is_relative_to(root) for root in roots):
            continue
        output = re.search(r" -o (\S+)", command["command"])
        parts = sorted({source, *CONFIGS, *deps.get(output[1] if output else "", [])})
        text = version + command["command"] + "".join(f"{path}{hashes.of(path)}" for path in parts)
        yield source, hashlib.sha256(text.encode()).hexdigest()


def tidy(build, source):
    done = subprocess.run(["clang-tidy", "--quiet", "-p", build, source], text=True, capture_output=True)
    # The count of warnings in other people's headers goes to standard error: of no interest unless it fails.
    return done.returncode == 0, done.stdout + (done.stderr if done.returncode != 0 else "")


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 0 if len(sys.argv) > 1 else 2
    build = pathlib.Path(sys.argv[1]).resolve()
    passed = build / "tidy"
    passed.mkdir(exist_ok=True)
    files = {}
    for source, key in wanted(build, sys.argv[2:] or ["src"]):
        # A source that is compiled twice is looked at once, as clang-tidy does with all of its commands.
        files.setdefault(source, hashlib.sha256()).update(key.encode())
    left = [(source, key.hexdigest()) for source, key in sorted(files.items()) if not (passed / key.hexdigest()).exists()]
    found = False
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for (source, key), (good, text) in zip(left, pool.map(lambda one: tidy(build, one[0]), left)):
            print(text, end="")
            if good:
                (passed / key).touch()
            found |= not good
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
