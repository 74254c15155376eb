#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What can be checked of the manual without running it.

  pages.py links ROOT     every relative link of README.md, CONTRIBUTING.md, CHANGELOG.md and docs/*.md leads to a file,
                          and its #anchor to a heading
  pages.py headers ROOT   docs/api.md explains every public header
  pages.py pictures ROOT  the pictures that scripts draw are as the scripts draw them now

Exit status: 0 passed, 1 failed.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

DRAWN = {"idea.py": None, "draw.py": ("flow.svg", "passes.svg", "spaces.svg")}  # None: to standard output


def without_code(text):
    return re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)


def anchors(page):
    """The headings as GitHub makes anchors of them."""
    out = set()
    for heading in re.findall(r"^#+ +(.*)$", without_code(page.read_text()), re.MULTILINE):
        words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).lower()
        out.add(re.sub(r"[^\w\- ]", "", words).strip().replace(" ", "-"))
    return out


def links(root):
    wrong = []
    pages = [root / "README.md", root / "CONTRIBUTING.md", root / "CHANGELOG.md", *sorted((root / "docs").glob("*.md"))]
    for page in pages:
        for address, anchor in re.findall(r"\]\((?!https?:)([^)#\s]*)(?:#([^)]*))?\)", without_code(page.read_text())):
            target = (page.parent / address) if address else page
            if not target.exists():
                wrong.append(f"{page.name}: there is no {address}")
            elif anchor and anchor not in anchors(target):
                wrong.append(f"{page.name}: {target.name} has no heading #{anchor}")
    return wrong


def headers(root):
    told = (root / "docs" / "api.md").read_text()
    return [f"api.md does not explain {header.name}" for header in sorted((root / "include" / "voxtact").glob("*.h"))
            if not re.search(rf"^\|.*`{re.escape(header.name)}`", told, re.MULTILINE)]


def pictures(root):
    wrong, images = [], root / "docs" / "images"
    for script, names in DRAWN.items():
        with tempfile.TemporaryDirectory() as folder:
            arguments = [] if names is None else [folder]
            out = subprocess.run([sys.executable, images / script, *arguments], check=True, capture_output=True).stdout
            drawn = {"idea.svg": out} if names is None else {n: (pathlib.Path(folder) / n).read_bytes() for n in names}
        wrong += [f"{name} is not what {script} draws" for name, picture in drawn.items()
                  if (images / name).read_bytes() != picture]
    return wrong


def main(arguments):
    checks = {"links": links, "headers": headers, "pictures": pictures}
    if len(arguments) != 2 or arguments[0] not in checks:
        print(__doc__, file=sys.stderr)
        return 2
    wrong = checks[arguments[0]](pathlib.Path(arguments[1]))
    print("\n".join(wrong) or f"{arguments[0]}: ok")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
