"""What the pages say is true: their examples run, and the paths that they name exist."""

from __future__ import annotations

import doctest
import re
import subprocess
import sys
from pathlib import Path

import pytest

from synthesis.model.sixbars import IN_WORDS

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]

PLACES = "kinematics|synthesis|service|mechsynth|tests|benchmarks|docs|tools"

PATH = re.compile(rf"`(?:(?:python -m )?((?:{PLACES})(?:[./][\w<>*-]+)+/?))[^`]*`")
"""A file, folder or module in backticks, from the root of the repository."""

LINK = re.compile(r"\]\((?!https?://|mailto:|#)([^)#\s]+)[^)]*\)")


@pytest.mark.parametrize("page", ["python.md"])
def test_examples_run(page: str) -> None:
    outcome = doctest.testfile(str(ROOT / "docs" / page), module_relative=False)
    assert outcome.attempted > 10
    assert outcome.failed == 0


def exists(name: str) -> bool:
    """Whether a file, a folder, a module, or a name in a module is there; ``<kind>`` stands for any."""
    pattern = re.sub(r"<\w+>", "*", name.rstrip("/"))
    if "/" in pattern:
        return any(ROOT.glob(pattern))
    parts = pattern.split(".")
    if any(ROOT.glob("/".join(parts) + ending) for ending in ("", ".py")):
        return True
    modules = ROOT.joinpath(*parts[:-1]).with_suffix(".py"), ROOT.joinpath(*parts[:-1], "__init__.py")
    word = re.compile(rf"\b{re.escape(parts[-1])}\b")
    return any(module.exists() and word.search(module.read_text("utf-8")) for module in modules)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_path_that_a_page_names_exists(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert [name for name in PATH.findall(text) if not exists(name)] == []
    assert [link for link in LINK.findall(text) if not (page.parent / link).exists()] == []


def test_the_door_for_python_costs_nothing_until_it_is_used() -> None:
    program = (
        "import sys, synthesis\n"
        "print(*({'numpy', 'pydantic', 'synthesis.registry'} & set(sys.modules)))\n"
        "synthesis.parse_problem, synthesis.solve\n"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT)
    assert run.stdout.split() == []


NO_NAME = re.compile(r"\b(Watt|Stephenson)('s)?\s+(dwell\s+)?sixbars?\b|\b(Watt|Stephenson)'s\s+(first|second|third)\b")
"""What a sixbar of Watt's or Stephenson's chain is not called: it has one name, which says which it is."""


def test_sixbars_are_called_by_one_name_on_pages_sheets_and_in_statements() -> None:
    sources = [path for folder in ("synthesis", "service", "kinematics") for path in (ROOT / folder).rglob("*.py")]
    texts = {path.name: path.read_text("utf-8") for path in [*PAGES, *sources, ROOT / "docs" / "openapi.json"]}
    assert {name: NO_NAME.search(text).group() for name, text in texts.items() if NO_NAME.search(text)} == {}
    for kind, name in IN_WORDS.items():
        chain, number = kind.split("_")
        assert name == f"{chain.capitalize()} {'I' * int(number)} sixbar"
        assert name.removesuffix(" sixbar").split()[0] in texts["glossary.md"]
