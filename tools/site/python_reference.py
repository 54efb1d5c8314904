"""Pages of the Python reference; mkdocstrings fills them with the docstrings of the modules that they name."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

LIBRARY = (
    "mechsynth.solving",
    "mechsynth.answers",
    "mechsynth.cycle",
    "mechsynth.statements",
    "mechsynth.progress",
    "service.client",
)
"""Modules of the library that are documented. Its problem classes are the statements in the HTTP reference."""

SOLVERS = ("synthesis.dispatch", "synthesis.registry", "synthesis.analyses")

_FOLDER = Path("reference") / "python"


def written(root: Path, folder: Path) -> list[tuple[str, str]]:
    """Write the pages below a folder; return their titles and paths there for the navigation."""
    pages = [("mechsynth", "The library", LIBRARY), ("synthesis", "Solvers", SOLVERS)]
    for package in sorted(path.parent for path in (root / "kinematics").glob("*/__init__.py")):
        modules = tuple(_modules(root, package))
        pages.append((f"kinematics.{package.name}", f"Kinematics: {package.name}", modules))
    listed = []
    (folder / _FOLDER).mkdir(parents=True, exist_ok=True)
    for name, title, modules in pages:
        path = _FOLDER / f"{name}.md"
        blocks = "".join(f"::: {module}\n\n" for module in modules)
        (folder / path).write_text(f"# {title}\n\n{blocks}", encoding="utf-8")
        listed.append((title, path.as_posix()))
    return listed


def _modules(root: Path, package: Path) -> Iterator[str]:
    """Yield the public modules of a package and its subpackages; kernels are internal and are left out."""
    for path in sorted(package.rglob("*.py")):
        if not path.stem.startswith("_") and not path.stem.endswith(("kernel", "kernels")) and path.stem != "warm":
            yield ".".join(path.relative_to(root).with_suffix("").parts)
