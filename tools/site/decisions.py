"""The index page of the decisions in ``docs/decisions/``."""

from __future__ import annotations

import re
from pathlib import Path

FOLDER = "decisions"


def written(source: Path, folder: Path) -> list[tuple[str, str]]:
    """Write the list of all decisions below a folder; return their titles and paths there for the navigation."""
    listed = [(path, *_titled(path)) for path in sorted(source.glob("[0-9]*.md"))]
    lines = "".join(f"{number}. [{title}]({path.name})\n" for path, number, title in listed)
    told = "What binds this project, and why it was decided so.\n\n"
    (folder / FOLDER).mkdir(parents=True, exist_ok=True)
    (folder / FOLDER / "index.md").write_text(f"# Decisions\n\n{told}{lines}", encoding="utf-8")
    pages = [(f"{number}. {title.replace('`', '')}", f"{FOLDER}/{path.name}") for path, number, title in listed]
    return [("", f"{FOLDER}/index.md"), *pages]


def _titled(path: Path) -> tuple[int, str]:
    """Return the number of a decision from its file name, and its heading without the number."""
    heading = path.read_text("utf-8").split("\n", 1)[0].removeprefix("# ")
    return int(path.stem.split("-")[0]), re.sub(r"^\d+\. ", "", heading)
