#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the language of the manual, of comments and of the texts that programs print.

usage: check_words.py [FILE...]   default: all files below

  WORDS      idioms, in the manual, in README.md, CONTRIBUTING.md and CHANGELOG.md, in comments, and in help texts
  MANUAL     more of them, in the manual and README.md alone, which also have no sentence of more than LONGEST words

A sentence ends at . ! ? or a colon, in tables and lists also at a semicolon. Code in backquotes is one word. Each finding
is a line with better words. Exit status: 0 nothing found, 1 otherwise.
"""
import pathlib
import re
import sys

LONGEST = 25
# Regular expression: better words.
WORDS = {
    r"\b(for )?whoever\b": "anyone who, or the noun",
    r"\byou learn\b": "begin with the content",
    r"\bbe it\b": "also, or",
    r"\bat large\b": "at random",
    r"\banew\b": "again",
    r"\bafresh\b": "again",
    r"\b(is|are|was|were) put to\b": "the verb",
    r"\b(lives?|alive) for ever\b": "until the process ends",
    r"\bby turns\b": "alternately",
    r"\bwhence\b": "from where",
    r"\bbe had\b": "is available, is supported",
    r"\ball the same\b": "nevertheless",
    r"\bin place of\b": "instead of",
    r"\bthat which\b": "the noun",
    r"\blooked at\b": "tested, read, visited",
    r"\bonce more\b": "again",
}
MANUAL = {
    r"\bmostly\b": "usually, chiefly",
    r"\bthe way of\b": "flow, path, like",
    r"\b(is|are|was|were) told\b": "receives, gets",
    r"\b(a|one|without|by) look\b(?!-)": "a test, a lookup",
    r"\b(at most|first|of|than|every|by|for) so many\b": "N, this number",
    r"\bwhat is (?!a |an |the )": "the noun: opaque region, remaining cells",
    r"\bof what\b": "the noun",
    r"\bsurvivors?\b": "passing fragments",
    r"\bnothing is (given|done|made|said|looked)\b": "an active verb",
    r"\bno longer\b": "no history in the manual",
}
TEXTS = ["docs/*.md", "README.md", "CONTRIBUTING.md", "CHANGELOG.md"]
SOURCES = ["include", "src", "shaders", "tests", "scripts", "docs/example"]
SKIPPED = ("scripts/check_words.py", "tests/fuzz/corpus/")
SLASHES = {".h", ".cpp", ".c", ".glsl", ".comp", ".vert", ".frag"}
HASHES = {".py", ".sh", ".cmake", ".txt"}
PRINTING = ("src/cli/", "src/viewer/", "src/bench/", "src/core/facts/")
STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')


def page_blocks(text):
    """Paragraphs, list items, headings and cells of tables as (lines, is a sentence of prose)."""
    block, is_code, is_comment = [], False, False
    for number, line in enumerate(text.split("\n") + [""], 1):
        stripped = line.strip()
        is_fence = stripped.startswith("```")
        is_code, hidden = is_code != is_fence, is_code or is_fence or is_comment or stripped.startswith("<!--")
        is_comment = (is_comment or stripped.startswith("<!--")) and "-->" not in stripped
        stripped = "" if hidden else stripped
        is_item = re.match(r"([-*]|\d+\.) ", stripped) is not None
        if block and (not stripped or is_item or stripped[0] in "|#"):
            yield block, is_list
            block = []
        if stripped.startswith("|"):
            for cell in re.split(r"(?<!\\)\|", stripped):
                yield [(number, cell)], True
        elif stripped:
            is_list = is_item if not block else is_list
            block.append((number, stripped))


def comment_blocks(text, mark):
    """Comments of consecutive lines."""
    block = []
    for number, line in enumerate(text.split("\n") + [""], 1):
        found = re.search(rf"(?:^|\s){mark}\s?(.*)", line)
        if block and not (found and line.lstrip().startswith(found[0].strip()[:1])):
            yield block
            block = []
        if found:
            block.append((number, found[1]))


def idioms(path, block, words):
    """Each idiom in a block of (line number, text); it may begin on one line and end on the next."""
    text, starts = "", []
    for number, line in block:
        starts.append((len(text), number))
        text += re.sub(r"`[^`]*`", "`", line) + " "
    for pattern, better in words.items():
        for found in re.finditer(pattern, text, re.IGNORECASE):
            number = max(number for start, number in starts if start <= found.start())
            yield f"{path}:{number}: {found[0].strip()} -> {better}"


def long_sentences(path, block, is_list):
    text = re.sub(r"`[^`]*`", "`", " ".join(line for _, line in block))
    text = re.sub(r"!\[[^]]*\]\([^)]*\)", "", text)  # captions of pictures may be long
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", text).replace("*", "")  # links are their text
    for sentence in re.split(r"(?<=[.!?:;])\s+" if is_list else r"(?<=[.!?:])\s+", text):
        words = [word for word in sentence.split() if re.search(r"[\w`]", word)]
        if len(words) > LONGEST:
            yield f"{path}:{block[0][0]}: {' '.join(words[:8])} … -> {len(words)} words; split it"


def findings(path):
    text, name = path.read_text(), path.as_posix()
    if path.suffix == ".md":
        is_page = name == "README.md" or path.parent.name == "docs"
        for block, is_list in page_blocks(text):
            yield from idioms(name, block, {**WORDS, **MANUAL} if is_page else WORDS)
            if is_page:
                yield from long_sentences(name, block, is_list)
        return
    for block in comment_blocks(text, r"//[/!]?<?" if path.suffix in SLASHES else "#+"):
        yield from idioms(name, block, WORDS)
    if name.startswith(PRINTING):
        for number, line in enumerate(text.split("\n"), 1):
            for string in STRING.findall(re.sub(r"//.*", "", line)):
                yield from idioms(name, [(number, string)], WORDS)


def files():
    for pattern in TEXTS:
        yield from sorted(pathlib.Path(".").glob(pattern))
    for folder in SOURCES:
        for path in sorted(pathlib.Path(folder).rglob("*")):
            if path.suffix in SLASHES | HASHES and not path.as_posix().startswith(SKIPPED):
                yield path


def main(arguments):
    found = [line for path in ([pathlib.Path(name) for name in arguments] or files()) for line in findings(path)]
    print("\n".join(found), file=sys.stderr, end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
