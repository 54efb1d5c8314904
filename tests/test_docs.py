"""What the pages say is true: their examples run, and the paths that they name exist."""

from __future__ import annotations

import doctest
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from synthesis.analyses import parse_request
from synthesis.dispatch import solve
from synthesis.model.linkage.sixbars import SIXBAR_NAMES
from synthesis.registry import KINDS, parse_problem
from tests.support.loops import check_each
from tests.support.sixbars.names import WRONG_NAME

ROOT = Path(__file__).parents[1]
PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]

PLACES = "kinematics|synthesis|service|mechsynth|tests|benchmarks|docs|tools"

PATH = re.compile(rf"`(?:(?:python -m )?((?:{PLACES})(?:[./][\w<>*-]+)+/?))[^`]*`")
"""A file, folder or module in backticks, from the root of the repository."""

LINK = re.compile(r"\]\((?!https?://|mailto:)([^)#\s]*)(?:#([^)\s]+))?[^)]*\)")
"""A link to a page, a place in it, or both."""

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)

ANALYSIS = "analysis"
"""What a block states that is a request for an analysis, in place of a kind."""


@pytest.mark.parametrize(("page", "least"), [("reference/python.md", 10), ("start/first-answer.md", 8)])
def test_examples_run(page: str, least: int) -> None:
    outcome = doctest.testfile(str(ROOT / "docs" / page), module_relative=False)
    assert outcome.attempted >= least
    assert outcome.failed == 0


def blocks(language: str) -> list[tuple[Path, str]]:
    """All blocks of code of a language, with the pages on which they stand."""
    return [(page, code) for page in PAGES for own, code in BLOCK.findall(page.read_text("utf-8")) if own == language]


def anchors(page: Path) -> set[str]:
    """The places of a page that a link can name: its headings, as GitHub and this project's site name them."""
    text = BLOCK.sub("", page.read_text("utf-8"))
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


def parse_request_body(body: dict[str, Any]) -> str:
    """Parse the body of a request as the service does; return the kind of its problem, or that it is an analysis."""
    if "mechanism" in body:
        request = parse_request(body)
        assert request.find_errors() == []
        return ANALYSIS
    # A body without `problem` is refused by `POST /v1/jobs`.
    problem = parse_problem(body["problem"])
    problem.require_consistent()
    return problem.kind


def test_every_block_of_json_can_be_posted_as_it_stands() -> None:
    """Answers are blocks of another language, ``jsonc``."""
    stated = [parse_request_body(json.loads(code)) for _, code in blocks("json")]
    assert len(set(stated)) >= 19
    assert stated.count(ANALYSIS) > 11
    for _, code in blocks("jsonc"):
        assert not {"problem", "mechanism", "kind"} & set(json.loads(code))


MACHINES = ROOT / "docs" / "tasks" / "by-machine.md"

TRADE_WORDS = (
    "hinge", "wiper", "gripper", "press", "excavator", "landing gear", "knee", "cam follower", "steering", "ratchet",
    "winch", "rotor", "flywheel", "lathe", "clock", "shaper", "stirrer", "door", "tray",
)  # fmt: skip
"""Words with which somebody looks for a mechanism; they must lead to a request."""


def test_words_of_the_trade_lead_to_a_complete_request() -> None:
    text = MACHINES.read_text("utf-8")
    rows = re.findall(r"^\| ([^|]+) \| \[([^\]]+)\]\(#([\w-]+)\) \|$", text, re.MULTILINE)
    assert [word.lower() for word, _, _ in rows] == sorted(word.lower() for word, _, _ in rows)
    words = " ".join(word for word, _, _ in rows)
    assert [word for word in TRADE_WORDS if word not in words] == []
    sections = dict(re.findall(r"^## ([^\n]+)\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL))
    # Every title in the table has a section with one request, and every section is in the table.
    assert {title for _, title, _ in rows} == set(sections)
    kinds = []
    for title, section in sections.items():
        (body,) = (code for language, code in BLOCK.findall(section) if language == "json")
        kinds.append(parse_request_body(json.loads(body)))
        assert LINK.search(section), title
    assert set(kinds) == set(KINDS)


@pytest.mark.slow
def test_requests_of_machines_are_answered_with_designs() -> None:
    for page, code in blocks("json"):
        if page == MACHINES:
            result = solve(parse_problem(json.loads(code)["problem"]))
            assert any(design.verification.passed for design in result.designs), code


SHELL = blocks("sh")


def test_shell_examples_are_marked_as_such() -> None:
    plain = [(page.name, code) for page, code in blocks("") if re.match(r"(curl|mechsynth|make|export|docker) ", code)]
    assert plain == []


@pytest.mark.parametrize(("page", "code"), SHELL, ids=[f"{page.name}-{n}" for n, (page, _) in enumerate(SHELL)])
def test_shell_examples_are_well_formed_and_post_what_the_service_takes(page: Path, code: str) -> None:
    subprocess.run(["bash", "-n"], input=code, text=True, check=True)
    for named in re.findall(rf"(?<![\w/])(?:{PLACES})/[\w./-]+", code):
        assert (ROOT / named).exists()
    for target in re.findall(r"^make ([\w-]+)", code, re.MULTILINE):
        assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)
    for command in re.findall(r"(?:^| )mechsynth ([a-z]+)", code, re.MULTILINE):
        assert f'add_parser("{command}"' in (ROOT / "service" / "command" / "cli.py").read_text("utf-8")
    for body in re.findall(r"-d '\n(\{.*?\})'", code, re.DOTALL):
        parse_problem(json.loads(body)["problem"])


def test_the_program_of_the_first_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (program,) = (code for page, code in blocks("python") if page.name == "index.md" and page.parent == ROOT / "docs")
    monkeypatch.chdir(tmp_path)
    exec(compile(program, "index.md", "exec"), {})
    assert (tmp_path / "gripper.dxf").stat().st_size > 1000


def test_programs_on_pages_are_well_formed() -> None:
    programs = [(page, code) for page, code in blocks("python") if ">>>" not in code]
    assert programs
    for page, code in programs:
        compile(code, str(page), "exec")


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


def test_every_path_that_a_page_names_exists() -> None:
    def check(page: Path) -> None:
        text = page.read_text(encoding="utf-8")
        assert [name for name in PATH.findall(text) if not exists(name)] == []
        assert [link for link, _ in LINK.findall(text) if not (page.parent / link).exists()] == []
        named = [(page.parent / link if link else page, place) for link, place in LINK.findall(text) if place]
        assert [(str(to), place) for to, place in named if to.suffix == ".md" and place not in anchors(to)] == []

    check_each(PAGES, check)


@pytest.mark.slow
def test_the_door_for_python_costs_nothing_until_it_is_used() -> None:
    program = (
        "import sys, synthesis\n"
        "print(*({'numpy', 'pydantic', 'synthesis.registry'} & set(sys.modules)))\n"
        "synthesis.parse_problem, synthesis.solve\n"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT)
    assert run.stdout.split() == []


def test_sixbars_are_called_by_one_name_on_pages_sheets_and_in_statements() -> None:
    sources = [path for folder in ("synthesis", "service", "kinematics") for path in (ROOT / folder).rglob("*.py")]
    texts = {path.name: path.read_text("utf-8") for path in [*PAGES, *sources]}
    assert {name: WRONG_NAME.search(text).group() for name, text in texts.items() if WRONG_NAME.search(text)} == {}
    for kind, name in SIXBAR_NAMES.items():
        chain, number = kind.split("_")
        assert name == f"{chain.capitalize()} {'I' * int(number)} sixbar"
        assert name.removesuffix(" sixbar").split()[0] in texts["glossary.md"]
