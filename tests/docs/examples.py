#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the shell examples of the manual, so that what a reader copies works.

  examples.py run PROGRAM PAGE.md       every ```sh block of a page, in order, in one temporary folder
  examples.py options PROGRAM PAGE.md…  every option in the pages is in a --help, and every option of --help in a page;
                                        in that of WHOLE, where a page says that it has them all

An HTML comment before a block, which no reader sees, says what there is to know about it:

  <!-- test: needs head.nii.gz tool.stl -->   make these first, from FILES below; `device` is a Vulkan device,
                                              `tool:NAME` a program and `slurm` Slurm, without which the block is
                                              skipped
  <!-- not run: it installs packages -->      why the block is not run; its voxtact options are checked all the same
  <!-- prints -->                             before a block without a language: exactly what the ```sh block before it
                                              writes to standard output

A block that is neither fit to run nor marked fails the test. Exit status: 0 passed, 1 failed.
"""
import contextlib
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

import slurm

# Small inputs that examples may ask for: the arguments of `voxtact make`, or the text itself.
FILES = {
    "head.nii.gz": ["volume", "builtin:head:32"],
    "ct.nii.gz": ["volume", "builtin:ct:32"],
    "atlas.nii.gz": ["volume", "builtin:head:16"],
    "tool.stl": ["mesh", "builtin:scalpel:300"],
    "poses.txt": ["poses", "--volume", "builtin:head:32", "--mesh", "builtin:scalpel:300", "--number", "8", "--seed",
                  "7", "--output"],
}
WHOLE = {"render.md": "render"}
SUBCOMMANDS = ("touch", "count", "distance", "area", "overlap", "motion", "plan", "compare", "bench",
               "render", "view", "info", "devices", "make")


class Block:
    def __init__(self, line, language, text, comment):
        self.line, self.language, self.text, self.comment = line, language, text, comment

    def directive(self, name):
        match = re.fullmatch(rf"{name}:? *(.*)", self.comment or "", re.DOTALL)
        return None if match is None else match.group(1).strip()


def blocks_of(page):
    found, comment, fence = [], None, None
    for number, line in enumerate(page.read_text().splitlines(), 1):
        if fence is not None:
            if line.startswith("```"):
                found.append(Block(fence[0], fence[1], "\n".join(fence[2]) + "\n", comment))
                fence, comment = None, None
            else:
                fence[2].append(line)
        elif line.startswith("```"):
            fence = (number, line[3:].strip(), [])
        elif match := re.fullmatch(r"<!-- *(.*?) *-->", line):
            comment = match.group(1)
        elif line.strip():
            comment = None
    return found


def commands_of(text):
    """The voxtact calls of a block: the words after `voxtact` of each, beginning with the subcommand."""
    found = []
    for statement in re.sub(r"\\\n", " ", text).splitlines():
        lexer = shlex.shlex(statement, posix=True, punctuation_chars="|;&")
        lexer.whitespace_split, lexer.commenters = True, "#"
        current = None
        for word in lexer:
            if re.fullmatch(r"[|;&]+", word):
                current = None
            elif current is not None:
                current.append(word)
            elif os.path.basename(word) == "voxtact":
                current = []
                found.append(current)
    return [words for words in found if words]


def help_of(program, subcommand):
    out = subprocess.run([program, subcommand, "--help-all"], check=True, capture_output=True, text=True).stdout
    text = out
    if subcommand == "make":  # it has commands of its own
        for kind in ("mesh", "volume", "poses"):
            text += subprocess.run([program, "make", kind, "--help-all"], check=True, capture_output=True, text=True).stdout
    return text


def options_in(help_text):
    """The options of a --help: those at the beginning of a line."""
    return set(re.findall(r"^ +(?:-\w,)?(--[a-z][a-z-]*)", help_text, re.MULTILINE))


def check_options(program, text):
    """What is wrong with the voxtact options of a block."""
    wrong = []
    for words in commands_of(text):
        if words[0] not in SUBCOMMANDS:
            continue
        known = options_in(help_of(program, words[0]))
        for word in words[1:]:
            option = word.split("=")[0]
            if re.fullmatch(r"--[a-z][a-z-]*", option) and option not in known:
                wrong.append(f"voxtact {words[0]} has no {option}")
    return wrong


def environment(program, folder):
    home = folder / ".home"
    home.mkdir()
    kept = {name: value for name, value in os.environ.items() if name not in ("XDG_CACHE_HOME", "HOME")}
    # Mesa's cache of compiled shaders may be the machine's own: what it holds changes no answer.
    mesa = os.environ.get("MESA_SHADER_CACHE_DIR") or os.path.join(
        os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"))
    return {**kept, "HOME": str(home), "MESA_SHADER_CACHE_DIR": mesa,
            "PATH": f"{pathlib.Path(program).resolve().parent}{os.pathsep}{os.environ['PATH']}"}


def has_device(env):
    return subprocess.run(["voxtact", "devices"], env=env, capture_output=True).returncode == 0


def make(name, folder, env):
    """Makes an input; what is wrong, or nothing."""
    if (folder / name).exists():
        return None
    if name not in FILES:
        return f"{name} is not among the files that examples may need: {', '.join(FILES)}"
    done = subprocess.run(["voxtact", "make", *FILES[name], name], cwd=folder, env=env, capture_output=True, text=True)
    return None if done.returncode == 0 else done.stderr


def run_block(block, folder, env, require_device):
    """Runs one block. Returns (what is wrong or None, standard output, skipped)."""
    needs = (block.directive("test: needs") or "").split()
    for name in needs:
        if name == "slurm":
            if not slurm.is_there():
                return None, "", True
        elif name == "device":
            if not has_device(env):
                return ("there is no Vulkan device" if require_device else None), "", True
        elif name.startswith("tool:"):
            if shutil.which(name[len("tool:"):], path=env["PATH"]) is None:
                return None, "", True
        elif wrong := make(name, folder, env):
            return wrong, "", False
    command = ["bash", "-euo", "pipefail", "-c", block.text]
    with slurm.cluster() if "slurm" in needs else contextlib.nullcontext({}) as more:
        done = subprocess.run(command, cwd=folder, env={**env, **more}, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        return f"exit status {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}", done.stdout, False
    return None, done.stdout, False


def run(program, page, require_device):
    failures, printed, before = 0, None, None
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        env = environment(program, folder)
        for block in blocks_of(page):
            where, wrong, words = f"{page.name}:{block.line}", None, ""
            begin = time.monotonic()
            if block.directive("prints") is not None:
                wrong = "there is no block that was run before it" if printed is None else None
                if printed is not None and printed != block.text:
                    wrong = f"the block in line {before} prints\n{printed}"
                words = "as printed"
            elif block.language != "sh":
                continue
            elif (reason := block.directive("not run")) is not None:
                found = check_options(program, block.text)
                wrong = "a reason is missing" if not reason else "; ".join(found) or None
                printed, words = None, f"not run: {reason}"
            else:
                wrong, printed, skipped = run_block(block, folder, env, require_device)
                before, words = block.line, f"{'skipped, ' if skipped else ''}{time.monotonic() - begin:.1f} s"
                printed = None if skipped else printed
            print(f"{where}: {'FAILED' if wrong else 'ok'} ({words})")
            if wrong:
                print(f"{block.text}  --> {wrong}")
                failures += 1
    return failures


def options(program, pages):
    """Both ways between the pages and --help."""
    known = set().union(*(options_in(help_of(program, subcommand)) for subcommand in SUBCOMMANDS))
    known |= {"--help", "--help-all", "--version"}
    told, failures = set(), 0
    for page in pages:
        here = set()
        # Options in backquotes; those of other programs stand in blocks, or behind their program's name.
        for number, line in enumerate(page.read_text().splitlines(), 1):
            for code in re.findall(r"`([^`]*)`", line):
                mine = code.startswith(("--", "voxtact "))
                for option in re.findall(r"(?<![\w-])--[a-z][a-z-]*", code) if mine else []:
                    here.add(option)
                    if option not in known:
                        print(f"{page.name}:{number}: FAILED: no voxtact command has {option}")
                        failures += 1
        if page.name in WHOLE:
            for option in sorted(options_in(help_of(program, WHOLE[page.name])) - here - {"--help", "--help-all"}):
                print(f"FAILED: {option} of voxtact {WHOLE[page.name]} is not in {page.name}")
                failures += 1
        told |= here
    for option in sorted(known - told - {"--help", "--help-all"}):
        print(f"FAILED: {option} is in a --help and in none of {', '.join(page.name for page in pages)}")
        failures += 1
    print(f"{len(known)} options in --help, {len(told)} in the pages")
    return failures


def main(arguments):
    if len(arguments) < 3 or arguments[0] not in ("run", "options"):
        print(__doc__, file=sys.stderr)
        return 2
    pages = [pathlib.Path(path) for path in arguments[2:]]
    if arguments[0] == "options":
        return 1 if options(arguments[1], pages) else 0
    require = os.environ.get("VOXTACT_REQUIRE_DEVICE", "1") not in ("0", "OFF")
    return 1 if sum(run(arguments[1], page, require) for page in pages) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
