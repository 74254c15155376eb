#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""clang-tidy on what the build compiles of the given files and folders (src), several files at a time, one process a core.

usage: tidy.py [--all-checks] BUILD_FOLDER [FILE|FOLDER...]

A file that passed is looked at again only when one of the texts that it is compiled from has changed: the file, the
headers of ours that it includes as the last build saw them, its command, the checks, this script, the compiler, or
clang-tidy. What passed is kept as hashes of these in $XDG_CACHE_HOME/voxtact-tidy, else ~/.cache/voxtact-tidy, for all
checkouts, until no run has met it for 60 days. Without --all-checks, the slow one of the checks is left out, and files that the
build compiles alike are looked at as one, since most of the time goes into headers: where something is found, which may
be no more than two equal names, each half by itself, down to one file. With it, each is from the start: checks of main
files alone find more. The exit status is 1 when there was a finding.
"""
import concurrent.futures
import contextlib
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
CONFIG = ROOT / ".clang-tidy"
# As long as all others together, in other people's templates.
SLOW_CHECKS = "-performance-unnecessary-value-param"
TOGETHER = 16
KEPT_DAYS = 60
# What .clang-tidy names, and the sources that are included where they are examined as one.
OURS = r"(src|include|tests)/.*\.(h|cpp)$"


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
            # What CMake writes names files of the checkout, which may be anywhere.
            text = path.read_bytes().replace(f"{ROOT}/".encode(), b"") if path.is_file() else None
            self.known[path] = "none" if text is None else hashlib.sha256(text).hexdigest()
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
    compilers = {shlex.split(entry["command"])[0] for entry in commands.values()}
    version = "".join(subprocess.run([program, "--version"], text=True, capture_output=True, check=True).stdout
                      for program in ["clang-tidy", *sorted(compilers)])
    for source, entry in commands.items():
        output = re.search(r" -o (\S+)", entry["command"])
        parts = sorted({source, CONFIG, pathlib.Path(__file__).resolve(), *deps.get(output[1] if output else "", [])})
        text = version + checks + entry["command"].replace(f"{ROOT}/", "")
        text += "".join(f"{path.relative_to(ROOT)}{hashes.of(path)}" for path in parts)
        yield source, hashlib.sha256(text.encode()).hexdigest()


def groups_of(commands, sources):
    """Sources that may be looked at as one: of a target's that are compiled alike, TOGETHER at a time at most."""
    alike = {}
    united = {folder_of(entry) for entry in commands.values() if "/Unity/" in entry["command"]}
    for source in sources:
        entry = commands[source]
        words = shlex.split(entry["command"])
        output = words[words.index("-o") + 1]
        # What a target whose files the build unites compiles apart clashes with others of it.
        clashes = folder_of(entry) in united and "/Unity/" not in output
        own = output if clashes or includes_itself(source) else folder_of(entry)
        alike.setdefault((own, *words[:words.index("-o")]), []).append(source)
    for members in alike.values():
        parts = -(-len(members) // TOGETHER)
        for part in range(parts):
            yield members[part * len(members) // parts:(part + 1) * len(members) // parts]


def passed_folder():
    """Where the hashes of what passed are kept, without those that are too old."""
    folder = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "voxtact-tidy"
    folder.mkdir(parents=True, exist_ok=True)
    oldest = time.time() - KEPT_DAYS * 24 * 3600
    for key in folder.iterdir():
        with contextlib.suppress(FileNotFoundError):  # another run may remove it first
            if key.stat().st_mtime < oldest:
                key.unlink()
    return folder


def has(key):
    """Whether it is kept; it is met by this."""
    if not key.exists():
        return False
    key.touch()
    return True


def includes_itself(source):
    """What Highway compiles for one processor after the other it does for one file at a time."""
    return "hwy/foreach_target.h" in source.read_text()


def folder_of(entry):
    """That of the objects of an entry's target."""
    return re.search(r" -o (\S*?\.dir)/", entry["command"])[1]


class Tidy:
    def __init__(self, folder, commands, checks):
        self.folder = folder
        self.commands = commands
        self.checks = checks

    def run(self, entry, *options):
        """Whether it finds nothing, and its findings."""
        with tempfile.TemporaryDirectory(dir=self.folder) as database:
            (pathlib.Path(database) / "compile_commands.json").write_text(json.dumps([entry]))
            # The configuration by its name: what is examined may be anywhere.
            done = subprocess.run(["clang-tidy", "--quiet", f"--config-file={CONFIG}", f"--checks={self.checks}", "-p",
                                   database, *options, entry["file"]], text=True, capture_output=True)
        # The count of warnings in other people's headers goes to standard error: of no interest unless it fails.
        return done.returncode == 0, done.stdout + (done.stderr if done.returncode != 0 else "")

    def finds_nothing(self, sources):
        entry = self.commands[sources[0]]
        with tempfile.NamedTemporaryFile("w", dir=self.folder, suffix=".cpp") as whole:
            whole.write("".join(f'#include "{one}" // NOLINT(bugprone-suspicious-include)\n' for one in sources))
            whole.flush()
            words = shlex.split(entry["command"])
            # A file's own variables may have names of another file.
            command = shlex.join([*words[:words.index("-o")], "-Wno-shadow", "-c", whole.name])
            return self.run(entry | {"file": whole.name, "command": command}, f"--header-filter={OURS}")[0]

    def look(self, sources):
        """Of each source whether it is good, and what is said of it."""
        if len(sources) == 1:
            return [(sources[0], *self.run(self.commands[sources[0]]))]
        if self.finds_nothing(sources):
            return [(source, True, "") for source in sources]
        half = len(sources) // 2
        return self.look(sources[:half]) + self.look(sources[half:])


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 0 if len(sys.argv) > 1 else 2
    arguments = sys.argv[1:]
    all_checks = "--all-checks" in arguments
    checks = "" if all_checks else SLOW_CHECKS
    build, *names = [argument for argument in arguments if argument != "--all-checks"]
    build = pathlib.Path(build).resolve()
    passed = passed_folder()
    scratch = build / "tidy"
    scratch.mkdir(exist_ok=True)
    commands = commands_of(build, names or ["src"])
    keys = {source: key for source, key in sorted(hashes_of(build, commands, checks)) if not has(passed / key)}
    work = [[source] for source in keys] if all_checks else list(groups_of(commands, keys))
    found = False
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for looked_at in pool.map(Tidy(scratch, commands, checks).look, work):
            for source, good, text in looked_at:
                print(text, end="")
                if good:
                    (passed / keys[source]).touch()
                found |= not good
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
