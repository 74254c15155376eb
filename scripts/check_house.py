#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the arrows between the parts of the source.

Each folder of src/ includes only the parts that ARROWS names. Public headers include only the standard library,
vulkan_core.h and each other. Some folders do without Vulkan. No part has two types of one name: no compiler finds two
that no file includes together, and the linker finds them only by chance.
"""

import collections
import pathlib
import re
import sys

ARROWS = {
    "exact": "",
    "core": "exact",
    "host": "core exact",
    "vulkan": "core exact",
    "device": "core exact vulkan",
    "render": "core exact vulkan device",
    "io": "core",
    "step": "io",
    "samples": "core",
    "c": "core host",
    "python": "",
    "cli": "core exact vulkan device host io render samples",
    "viewer": "core exact vulkan device host io render samples cli",
    "bench": "core exact vulkan device host io render samples cli oracle",
}
WITHOUT_VULKAN = ("src/core/", "src/exact/", "src/io/", "src/host/", "src/samples/", "src/step/", "src/viewer/model/")

PARTS = {*ARROWS, "oracle"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
VULKAN = re.compile(r"^(vulkan/|volk)")
C_HEADERS = {"stddef.h", "stdint.h"}
TYPE = re.compile(r"^(?:template <.*> *)?(?:class|struct|enum class) +([A-Z][A-Za-z0-9]+)(?: final)?(?: *:[^:].*)? *\{")


def includes(path):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if found := INCLUDE.match(line):
            yield number, found[1], found[2]


def part_complaints(folder):
    part = folder.name
    may = {part, *ARROWS[part].split()}
    types = collections.Counter()
    for path in sorted([*folder.rglob("*.h"), *folder.rglob("*.cpp")]):
        for number, _, name in includes(path):
            target = name.removeprefix("../").split("/")[0]
            if "/" in name and target in PARTS and target not in may:
                yield f"{path}:{number}: {part} must not include {target}"
            if VULKAN.match(name) and str(path).startswith(WITHOUT_VULKAN):
                yield f"{path}:{number}: no Vulkan here"
        if path.suffix == ".h":
            types.update(found[1] for line in path.read_text().splitlines() if (found := TYPE.match(line)))
    for name, times in types.items():
        if times > 1:
            yield f"{folder}: {times} types are called {name}"


def header_complaints():
    for path in sorted(pathlib.Path("include").rglob("*.h")):
        for number, kind, name in includes(path):
            if kind == "<" and name in C_HEADERS and path.name.startswith("voxtact"):
                continue
            standard = kind == "<" and re.fullmatch(r"[a-z_0-9]+", name)
            if not (standard or name == "vulkan/vulkan_core.h" or (kind == '"' and name.startswith("voxtact/"))):
                yield f"{path}:{number}: public headers include only the standard library, vulkan_core.h and each other"


def main():
    complaints = list(header_complaints())
    for folder in sorted(path for path in pathlib.Path("src").iterdir() if path.is_dir()):
        if folder.name in ARROWS:
            complaints += part_complaints(folder)
        else:
            complaints.append(f"{folder}: not a part of the house; add its arrows to {sys.argv[0]}")
    print("\n".join(complaints), file=sys.stderr, end="\n" if complaints else "")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
