"""Pages of the site from ``docs/``, and a page for each source file to which they link."""

from __future__ import annotations

import json
import os
import re
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path

SOURCES = "sources"
"""Folder of the pages that show source files."""

TASKS = "tasks.md"
"""Page of all tasks, generated from the table in the README."""

_LINK = re.compile(r"(\]\()((?:\.\./)+[^)\s#]+)(#[^)\s]*)?(\))")
_CHECK = re.compile(r"^\| (`\w[^|]*`) \|", re.MULTILINE)
_LANGUAGES = {".py": "python", ".toml": "toml", ".json": "json", ".lock": "text"}
_FOLDER = re.compile(r"^(?P<indent> +)- (?:(?P<title>[^:\n]+): )?(?P<folder>\S+)/$", re.MULTILINE)


def gathered(root: Path, folder: Path) -> None:
    """Copy everything in ``docs/`` that the site shows into a folder.

    Links to files outside ``docs/`` are changed to point to pages that show these files; those pages are written, too.
    """
    docs = root / "docs"
    linked: set[str] = set()
    for source in sorted(docs.rglob("*")):
        place = source.relative_to(docs)
        if source.is_dir() or place.parts[0] == "gallery" or source.suffix == ".ipynb":
            continue
        target = folder / place
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.suffix == ".md":
            text, sources = _within_the_site(source.read_text("utf-8"), place.parent, root)
            if place.name == "checks.md":
                text = anchored(text)
            target.write_text(text, encoding="utf-8")
            linked |= sources
        else:
            shutil.copyfile(source, target)
    for name in sorted(linked):
        _write_source(root, name, folder / SOURCES / f"{name}.md")
    (folder / TASKS).write_text(_tasks((root / "README.md").read_text("utf-8"), docs), encoding="utf-8")
    shutil.copytree(Path(__file__).with_name("theme"), folder / "theme", dirs_exist_ok=True)


def _within_the_site(text: str, at: Path, root: Path) -> tuple[str, set[str]]:
    """Return a page with links to source files changed to their pages, and the paths of these files from the root."""
    linked = set()

    def turned(found: re.Match[str]) -> str:
        name = os.path.normpath(Path("docs") / at / found[2])
        if name == "README.md":
            return f"{found[1]}{os.path.relpath(TASKS, at)}{found[4]}"
        if name.startswith("docs" + os.sep) or not (root / name).is_file():
            return found[0]
        linked.add(name)
        return f"{found[1]}{os.path.relpath(Path(SOURCES) / name, at)}.md{found[4]}"

    return _LINK.sub(turned, text), linked


def _tasks(readme: str, docs: Path) -> str:
    """Return the README's section "What it solves" as a page, with the headings of the linked pages as link texts."""
    section = readme.split("## What it solves\n", 1)[1].split("\n## ", 1)[0]

    def named(link: re.Match[str]) -> str:
        heading = (docs / link[2]).read_text("utf-8").split("\n", 1)[0].removeprefix("# ")
        return f"[{heading.split(':')[0]}]({link[2]}{link[3]})"

    linked = re.sub(r"\[(docs/[^\]]+)\]\(docs/([^)#]+)([^)]*)\)", named, section)
    return "# All tasks\n" + linked.replace("](docs/", "](")


def check_anchor(name: str) -> str:
    """Return the anchor of a check on the page of checks.

    Checks that differ only in a number, or in the name of a joint, share an anchor.
    """
    own = re.sub(r"^max_joint_.+", "max_joint_n", re.sub(r"^unit_\d+_", "", name))
    return "check-" + re.sub(r"<\w+>|(?<=_)\d+", "n", own).replace("_", "-")


def anchored(text: str) -> str:
    """Return the page of checks with an anchor at the first occurrence of each name in the first columns of tables."""
    known: set[str] = set()

    def marked(row: re.Match[str]) -> str:
        cells = []
        for name in re.findall(r"`([^`]+)`", row[1]):
            anchor = check_anchor(name)
            cells.append(f"`{name}`" if anchor in known else f'<a id="{anchor}"></a>`{name}`')
            known.add(anchor)
        return f"| {', '.join(cells)} |"

    head, checks = text.split("## Checks of linkages", 1)
    return f"{head}## Checks of linkages{_CHECK.sub(marked, checks)}"


def _write_source(root: Path, name: str, page: Path) -> None:
    source = root / name
    page.parent.mkdir(parents=True, exist_ok=True)
    language = _LANGUAGES.get(source.suffix, "text")
    code = source.read_text("utf-8")
    page.write_text(
        f"---\nsearch: {{exclude: true}}\n---\n# `{name}`\n\n```{language}\n{code}\n```\n", encoding="utf-8"
    )


def settings(template: str, folders: Mapping[str, Iterable[tuple[str, str]]]) -> str:
    """Return the settings of the site with a complete navigation.

    Parameters
    ----------
    template : str
        Settings in which an entry of the navigation that ends in a slash stands for all pages of a folder.
    folders : mapping
        Title and path of each page, by folder. With an empty title, the heading of the page is used.
    """

    def entries(found: re.Match[str]) -> str:
        indent, title = found["indent"], found["title"]
        inner = indent + ("    " if title else "")
        lines = [f"{indent}- {title}:"] if title else []
        for name, path in folders[found["folder"]]:
            lines.append(f"{inner}- {json.dumps(name, ensure_ascii=False)}: {path}" if name else f"{inner}- {path}")
        return "\n".join(lines)

    return _FOLDER.sub(entries, template)
