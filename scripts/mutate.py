#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Do the tests notice a small mistake? Makes mistakes in a scratch copy of the working tree, one at a time, builds the
tests of the room that the file is in, and runs them. A mutant that survives asks for a test, unless it changes nothing.

usage: mutate.py [--list] [--number N] [--seed S] [--least PERCENT] [ROOM|PLACE...]

ROOM is a name of ROOMS below, default all: of each, N (10) mutants are drawn by the seed (1). PLACE is a file, FILE:LINE
or the whole name of a mutant, FILE:LINE:COLUMN:OPERATOR: all mutants there are made. --list names them, and makes none.
The exit status is 1 when fewer than PERCENT (75) of those that compile are noticed, or when a room, a test or a line of
MISTAKES fits nothing.
"""
import argparse
import collections
import pathlib
import random
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "mutate"
SOURCE = WORK / "source"
BUILD = SOURCE / "build" / "release" # where a checkout has it, so that ccache knows its files
SECONDS_A_TEST = 300

GPU = "voxtact_gpu_tests:AnalyticTest*:*Agreement*:CertifiedTest*:OutputsTest*:EditTest*:BricksTest*:QueuesTest*"
# Files as globs, and what judges them: PROGRAM or PROGRAM:FILTER (GoogleTest's). The first room that has a file counts.
ROOMS = {
    "core": (["src/core/**/*"], ["voxtact_unit_tests", "voxtact_cpu_tests:Opaque*:Clusters*:CpuOutputs*"]),
    "exact": (["src/exact/*"], ["voxtact_unit_tests", "voxtact_cpu_tests:*Text*:Oracle*:Analytic*:Agreement*:Certified*"]),
    "render": (["src/render/**/*", "shaders/render/*"], ["voxtact_gpu_tests:Render*:Paint*:Creases*"]),
    "device": (["src/device/**/*", "src/vulkan/**/*", "shaders/*/*"],
               ["voxtact_faults_tests", GPU]),
    "overlap": (["src/host/overlap/*"], ["voxtact_cpu_tests:Overlap*"]),
    "area": (["src/host/area/*"], ["voxtact_cpu_tests:*Area*:Uv*"]),
    "search": (["src/host/search/**/*"], ["voxtact_cpu_tests:Clearance*"]),
    "motion": (["src/host/motion/*"], ["voxtact_cpu_tests:*Motion*:*Tolerance*:Large*"]),
    "plan": (["src/host/plan/*"], ["voxtact_cpu_tests:*Plan*:Direction*"]),
    "host": (["src/host/**/*"], ["voxtact_cpu_tests"]),
    "files": (["src/io/**/*"], ["voxtact_io_tests"]),
    "bench": (["src/bench/**/*"], ["voxtact_lab_tests", "voxtact_cli_tests:MakeTest*"]),
    "cli": (["src/cli/**/*"], ["voxtact_cli_tests"]),
}
# A name, what it finds in a line, and what that becomes. Layout is clang-format's: operators stand between spaces.
NUMBER = r"(?<![\w.])"
OPERATORS = [
    ("<", r" < ", " <= "), ("<=", r" <= ", " < "), (">", r" > ", " >= "), (">=", r" >= ", " > "),
    ("==", r" == ", " != "), ("!=", r" != ", " == "),
    ("+", r" \+ ", " - "), ("-", r" - ", " + "), ("*", r" \* ", " / "), ("/", r" / ", " * "), ("%", r" % ", " / "),
    ("+=", r" \+= ", " -= "), ("-=", r" -= ", " += "), ("|=", r" \|= ", " = "), ("<<", r" << (?=\w)", " >> "),
    ("&&", r" && ", " || "), ("||", r" \|\| ", " && "), ("!", r"(?<=[( ])!(?=[\w(])", ""),
    ("one", NUMBER + r"1\b(?![.'])", "2"), ("zero", NUMBER + r"0\b(?!\.)", "1"), ("real", NUMBER + r"\d+\.\d+", "0.25"),
    ("min", r"\bmin\(", "max("), ("max", r"\bmax\(", "min("), ("Min", r"Min\(", "Max("), ("Max", r"Max\(", "Min("),
    ("floor", r"\bfloor\(", "ceil("), ("ceil", r"\bceil\(", "floor("), ("abs", r"\babs\(", "("),
    ("lo", r"\.lo\b", ".hi"), ("hi", r"\.hi\b", ".lo"), ("x", r"\.x\b", ".y"), ("y", r"\.y\b", ".z"), ("z", r"\.z\b", ".x"),
    ("front", r"\bfront\(\)", "back()"), ("back", r"\bback\(\)", "front()"),
    ("true", r"\btrue\b", "false"), ("false", r"\bfalse\b", "true"),
    ("term", r" [+-] [\w.\[\]]+(?:\([\w.]*\))?(?=[;,)])", ""), ("factor", r"[\w.\[\]]+ \* (?=\w)", ""),
    ("conjunct", r" && [^&|;{]+?(?=\) \{|;)", ""), ("disjunct", r" \|\| [^&|;{]+?(?=\) \{|;)", ""),
    ("first", r"((?:return|=) )[^?:]+ \? ([^?:]+) : [^?:]+;", r"\1\2;"),
    ("second", r"((?:return|=) )[^?:]+ \? [^?:]+ : ([^?:]+);", r"\1\2;"),
    ("if", r"\bif \((.+)\) \{$", r"if (!(\1)) {"), ("call", r"^ +[\w.:>-]+\(.*\);$", ""),
    ("assignment", r"^ +[\w.\[\]>-]+ [+|&-]?= [^={]*;$", ""), ("continue", r"\bcontinue;", ""), ("break", r"\bbreak;", ""),
]
# What no operator does: room, name, a pattern that some line of the room has, and what it becomes. Each is always made.
MISTAKES = [
    ("device", "query-not-precise", r"VK_QUERY_CONTROL_PRECISE_BIT", "0"),
    ("device", "barrier-for-nobody", r"VK_ACCESS_2_MEMORY_WRITE_BIT", "0"),
    ("device", "lower-bound-is-exact", r"desc\.stopAtFirst \? Exactness::LowerBound : ", ""),
    ("device", "negatives-in-order", r"\? ~bits : ", "? bits : "),
    ("exact", "lost-bits", r"lost != 0u", "lost == 0xffffffffu"),
    ("core", "rounded-to-the-nearest", r"std::nextafter\(value, -kInfinity\)", "value"),
    ("core", "direction-transposed", r"\[3 \* a \+ static_cast<std::size_t>\(r\)\]", "[3 * static_cast<std::size_t>(r) + a]"),
    ("exact", "fill-rule-of-one-edge", r"\(by == ay && bx > ax\)", "(by == ay && bx < ax)"),
    ("host", "count-of-the-last-part", r"certain\.fetch_add\(", "certain.store("),
    ("host", "what-was-thrown-is-kept", r"std::rethrow_exception\(std::exchange\(thrown_, nullptr\)\)", "thrown_ = nullptr"),
    ("host", "wrong-possible", r"certain == 0 && undecided", "undecided"),
    ("overlap", "solid-not-rounded", r"std::max\(volume - error, 0\.0\)", "volume"),
    ("overlap", "displacement-forgotten", r"kDown - error, 0\.0\)", "kDown, 0.0)"),
    ("overlap", "winding-by-parity", r"\(\*front \+ weight != 0 \? 1 : 0\) - \(\*front != 0 \? 1 : 0\)",
     "((*front + weight) % 2 != 0 ? 1 : 0) - (*front % 2 != 0 ? 1 : 0)"),
    ("overlap", "mirrored-pose", r"jump == kUnknownJump \|\| isMirrored \?", "jump == kUnknownJump ?"),
    ("overlap", "border-of-whole-voxels", r"number == 0 \? 0\.5 : number", "number"),
    ("overlap", "limit-in-the-band-below", r"\{\{limit, 0\}, \{limit, 1\}\}",
     "{{limit, 0}, {std::nextafter(limit, kInfinity), 1}}"),
    ("overlap", "label-at-another-place", r"double middle = box\.cell(.*) \+ 0\.5;",
     "double middle = box.cell[static_cast<std::size_t>(axis)] + 0.625;"),
    ("overlap", "bend-forgotten", r"change \* change \* std::abs\(along\.b\)", "0 * change"),
    ("overlap", "halves-uncut", r"\(isCut \? parts_ : left\)", "parts_"),
    ("overlap", "holes-allowed", r"made\.solid->facts\.holes > 0", "made.solid->facts.holes > 9"),
    ("files", "stopped-for-once", r"std::exchange\(stopped_, true\)", "stopped_"),
    ("render", "normals-by-the-matrix", r"transposed\(\*object_from_world\)", "*object_from_world"),
]
SKIPPED = re.compile(r"^\s*(#|//|/\*|\*|using |template|static_assert|import|namespace|public:|private:|\}|$)")


# Its place, FILE:LINE:COLUMN:OPERATOR, is its name; `line` is the mistaken one.
Mutant = collections.namedtuple("Mutant", "room path number name line")


def fail(text):
    sys.exit(f"mutate: {text}")


def code_of(line):
    """Without its comment, and with strings that no operator matches."""
    masked = re.sub(r'"(\\.|[^"\\])*"|\'(\\.|[^\'\\])*\'', lambda found: "\v" * len(found.group()), line)
    return masked.split("//")[0].rstrip()


def lines_of(path):
    return [(path, number, line) for number, line in enumerate((ROOT / path).read_text().split("\n"), 1)]


def mutants_of(room, path, number, line):
    if SKIPPED.match(line):
        return
    for name, pattern, new in OPERATORS:
        for found in re.finditer(pattern, code_of(line)):
            changed = line[:found.start()] + found.expand(new) + line[found.end():]
            if "\v" not in changed and changed != line:
                yield Mutant(room, path, number, f"{path}:{number}:{found.start() + 1}:{name}", changed)


def sample(room, files, number, seed):
    """One of a line at most."""
    draw = random.Random(f"{seed} {room}")
    lines = [line for path in files for line in lines_of(path)]
    draw.shuffle(lines)
    found = []
    while lines and len(found) < number:
        found += draw.sample(some, 1) if (some := list(mutants_of(room, *lines.pop()))) else []
    return found


def mistakes_of(room, files):
    for name, pattern, new in (mistake[1:] for mistake in MISTAKES if mistake[0] == room):
        yield next((Mutant(room, path, number, f"{path}:{number}:1:{name}", re.sub(pattern, lambda _: new, line))
                    for file in files for path, number, line in lines_of(file) if re.search(pattern, line)),
                   None) or fail(f"MISTAKES: no line of the room {room} has what {name} changes: {pattern}")


def choose(wanted, number, seed):
    chosen, taken, places = [], set(), [place for place in wanted if place not in ROOMS]
    for room, (globs, _) in ROOMS.items():
        files = sorted({str(path.relative_to(ROOT)) for glob in globs for path in ROOT.glob(glob)
                        if path.suffix in (".cpp", ".h", ".glsl", ".comp", ".vert", ".frag")} - taken)
        taken |= set(files)
        if not files:
            fail(f"ROOMS: {room} has no file: {', '.join(globs)}")
        for path in files:
            for place in places:
                if place.split(":")[0] == path:
                    chosen += [m for line in lines_of(path) for m in mutants_of(room, *line)
                               if f"{m.name}:".startswith(place + ":")]
        mistakes = list(mistakes_of(room, files))
        if room in wanted or not wanted:
            chosen += mistakes + sample(room, files, number, seed)
    if places and not chosen:
        fail(f"neither a room ({', '.join(ROOMS)}) nor a place with a mutant: {', '.join(places)}")
    return chosen


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


def build(test):
    return subprocess.run(["ninja", "-C", str(BUILD), test.partition(":")[0]], capture_output=True, text=True)


def failure(test):
    """What the test prints where it fails, crashes or hangs; None: it passes."""
    name, _, pattern = test.partition(":")
    program = next((BUILD / "tests").glob(f"*/{name}"), None) or fail(f"there is no test program {name}")
    command = [str(program), "--gtest_brief=1", "--gtest_color=no", "--gtest_fail_fast", f"--gtest_filter={pattern or '*'}"]
    try:
        run = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=SECONDS_A_TEST,
                             cwd=program.parent)
    except subprocess.TimeoutExpired:
        return f"longer than {SECONDS_A_TEST} s"
    if "[  PASSED  ] 0 tests" in run.stdout:
        fail(f"{test}: no such test")
    return run.stdout[-3000:] + run.stderr[-1000:] if run.returncode != 0 else None


def prepare(tests):
    copy_sources()
    if not (BUILD / "build.ninja").is_file(): # a mistake may leave a variable unused
        configured = subprocess.run(["cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                                     "-DVOXTACT_WARNINGS_AS_ERRORS=OFF"], capture_output=True, text=True)
        if configured.returncode != 0:
            fail(configured.stderr)
    for test in tests:
        built = build(test)
        if built.returncode != 0:
            fail(f"the sources do not build as they are:\n{built.stdout[-3000:]}")
        if said := failure(test):
            fail(f"{test} fails without any mutant:\n{said}")


def judge(mutant):
    path = SOURCE / mutant.path
    original = path.read_text()
    lines = original.split("\n")
    lines[mutant.number - 1] = mutant.line
    path.write_text("\n".join(lines))
    try:
        for test in ROOMS[mutant.room][1]:
            if build(test).returncode != 0:
                return "does not compile"
            if failure(test) is not None:
                return "noticed"
        return "SURVIVED"
    finally:
        path.write_text(original)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--number", type=int, default=10)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--least", type=float, default=75)
    parser.add_argument("wanted", nargs="*")
    arguments = parser.parse_args()
    mutants = choose(arguments.wanted, arguments.number, arguments.seed)
    if not arguments.list:
        prepare(dict.fromkeys(test for mutant in mutants for test in ROOMS[mutant.room][1]))
    verdicts = []
    for number, mutant in enumerate(mutants, 1):
        begun = time.monotonic()
        if not arguments.list:
            verdicts.append(judge(mutant))
        print(f"{number}/{len(mutants)} {mutant.room} {mutant.name}: {mutant.line.strip()}",
              *[f"({verdicts[-1]}, {time.monotonic() - begun:.0f} s)"] if verdicts else [], flush=True)
    if verdicts:
        judged = len(verdicts) - verdicts.count("does not compile")
        share = 100 * verdicts.count("noticed") / max(judged, 1)
        print(f"{verdicts.count('noticed')} of {judged} noticed ({share:.1f} %)")
        if share < arguments.least:
            fail(f"fewer than {arguments.least:g} % are noticed")


if __name__ == "__main__":
    main()
