# SPDX-License-Identifier: MIT
"""What mkdocs does not do by itself: pages from outside docs/, links into the source, and tables as GitHub reads them."""
import pathlib
import re
import shutil

from mkdocs.structure.files import File, Files

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
MADE = ROOT / "build" / "site-pages"
OUTSIDE_PAGES = ("CONTRIBUTING.md", "CHANGELOG.md")
TOOLS = ("Doxyfile", "mainpage.dox", "reference.css", "doxygen_filter.awk", "mkdocs_hooks.py")  # of the manual, and no part of it
REFERENCE = "# Reference\n\nThe public headers, by Doxygen: <a href='reference/index.html'>open the reference</a>.\n"
LINK = re.compile(r"\]\((?!https?:)([^)#\s]+)(#[^)]*)?\)")


def folder_of(name):
    return ROOT if name in OUTSIDE_PAGES else DOCS


def in_site(address, folder):
    """Where in the site a link of a page in a folder leads, or None where it is fine as it is; and the source file that
    it needs there."""
    file = (folder / address).resolve()
    if not file.exists():
        return None, None
    if file.is_relative_to(DOCS):
        return file.relative_to(DOCS).as_posix(), None
    if file.name in OUTSIDE_PAGES:
        return file.name, None
    if file == ROOT / "README.md":
        return "index.md", None
    return f"source/{file.relative_to(ROOT).as_posix()}.txt", file


def on_config(config):
    # A page that is not there (yet) is no entry of the menu.
    def kept(entries):
        out = []
        for entry in entries:
            ((title, target),) = entry.items()
            if isinstance(target, list):
                out.append({title: kept(target)})
            elif target in (*OUTSIDE_PAGES, "reference.md") or (DOCS / target).exists():
                out.append(entry)
        return out

    config["nav"] = kept(config["nav"])
    return config


def on_files(files, config):
    shutil.rmtree(MADE, ignore_errors=True)
    MADE.mkdir(parents=True)
    (MADE / "reference.md").write_text(REFERENCE)
    outside = {"reference.md": MADE, **{name: ROOT for name in OUTSIDE_PAGES}}
    for path in [*DOCS.glob("*.md"), *(ROOT / name for name in OUTSIDE_PAGES)]:
        for address, _ in LINK.findall(path.read_text()):
            name, source = in_site(address, folder_of(path.name))
            if source is not None:
                (MADE / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, MADE / name)
                outside[name] = MADE
    kept = [file for file in files if file.src_path not in TOOLS]
    made = [File(name, str(folder), config["site_dir"], config["use_directory_urls"]) for name, folder in outside.items()]
    return Files(kept + made)


def on_page_markdown(markdown, page, config, files):
    def target(match):
        name, _ = in_site(match.group(1), folder_of(page.file.src_path))
        return match.group(0) if name is None else f"]({name}{match.group(2) or ''})"

    # In a table GitHub wants \| even in code; Python's Markdown wants it bare there.
    rows = (re.sub(r"`[^`]*`", lambda code: code.group(0).replace("\\|", "|"), line) if line.startswith("|") else line
            for line in LINK.sub(target, markdown).split("\n"))
    return "\n".join(rows)
