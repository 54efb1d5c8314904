"""The table of what is compared by another route is complete: a new metric or check has to be measured, or listed."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import synthesis
from synthesis.registry import KINDS, list_examples, parse_problem
from tests.support.answers import solve
from tests.support.independent.comparison import Measured
from tests.support.independent.quantities import COMPARED, NEVER_STATED, NOT_MEASURED, fields_of, models_of

GEARS = {
    "gear_train",
    "planetary_train",
    "train_series",
    "gearbox",
    "layshaft_gearbox",
    "balancing",
    "spring_balancing",
    "flywheel",
    "engine",
    "indexing",
}
"""Kinds that design no motion: their answers are numbers of teeth, wheels, or masses of mechanisms that there are."""

SOURCES = Path(synthesis.__file__).parent

NAMED_ELSEWHERE = {
    "verification/checks.py": 4,  # reaches_targets; whoever calls the others gives the name
    "verification/constraints.py": 1,  # fixed_pivot_region, moving_pivot_region
    "verification/workspace.py": 1,  # fixed_pivot_zones, moving_pivot_zones
    "kinds/motion/verification/checks.py": 1,  # input_side, output_side
    "kinds/cam/verification/reproduction.py": 1,  # the caller's
    "kinds/cam/verification/rates.py": 1,  # meets_velocities, meets_accelerations
    "kinds/cam/verification/verify.py": 3,  # outer_wall_reproduces_program
}
"""How many checks of a file have a name from elsewhere: a new one has to be entered in the table by hand."""


def called(path: Path) -> Iterator[ast.expr]:
    """What stands for the name wherever a check is made."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if name == "Check":
                yield next(keyword.value for keyword in node.keywords if keyword.arg == "name")
            elif name in ("check_maximum", "check_minimum", "check_error") or (name == "check" and node.args):
                yield node.args[0]


def pattern(name: ast.expr) -> str | None:
    """The name of a check as a regular expression; None where it is a variable."""
    if isinstance(name, ast.Constant):
        return re.escape(str(name.value))
    if isinstance(name, ast.JoinedStr):
        return "".join(re.escape(part.value) if isinstance(part, ast.Constant) else r"\w+" for part in name.values)
    return None


@pytest.mark.parametrize("kind", sorted(set(KINDS) - GEARS))
def test_every_field_is_compared_or_listed(kind: str) -> None:
    designs = models_of(KINDS[kind].result.model_fields["designs"].annotation)
    fields = set().union(*(fields_of(design) for design in designs if "verification" in design.model_fields))
    listed = COMPARED[kind] | set(NOT_MEASURED) | set(NEVER_STATED.get(kind, "").split())
    assert fields
    assert not fields - listed, "measure these, or list them in tests/support/independent/quantities.py"
    stale = {name for name in COMPARED[kind] - fields if not name.startswith(("checks.", "mechanism."))}
    assert not stale


@pytest.mark.slow
@pytest.mark.parametrize("kind", sorted(set(KINDS) - GEARS))
def test_every_check_is_compared_or_listed(kind: str) -> None:
    known = {name.removeprefix("checks.") for name in [*COMPARED[kind], *NEVER_STATED.get(kind, "").split()]}
    for path in (SOURCES / "kinds" / kind).rglob("*.py"):
        for name in map(pattern, called(path)):
            assert name is None or any(re.fullmatch(name, check) for check in known), f"{name} in {path.name}"


def test_every_check_of_all_kinds_is_compared() -> None:
    for path in (SOURCES / "verification").rglob("*.py"):
        for name in map(pattern, called(path)):
            assert name is None or f"checks.{name}" in COMPARED["motion"], f"{name} in {path.name}"


@pytest.mark.slow
def test_names_from_elsewhere_are_few() -> None:
    found = {}
    for path in [*(SOURCES / "verification").rglob("*.py"), *(SOURCES / "kinds").rglob("*.py")]:
        variables = sum(pattern(name) is None for name in called(path))
        if variables and not GEARS & set(path.parts):
            found[path.relative_to(SOURCES).as_posix()] = variables
    assert found == NAMED_ELSEWHERE


def test_what_is_stated_and_not_compared_is_told() -> None:
    result = Measured()
    design = solve(parse_problem(list_examples("quick_return")[0])).designs[0]
    beside = result.beside("quick_return", design, "nothing")
    beside.metric("size", design.metrics.size, 1.0)
    beside.finish()
    assert result.left["quick_return fourbar: metrics.time_ratio"] == 1
    assert result.left["quick_return fourbar: checks.time_ratio"] == 1
    assert not any("metrics.size" in name or "metrics.family" in name for name in result.left)
    with pytest.raises(ValueError, match="not listed"):
        beside.add("metrics.beauty", 1.0, 1.0, 1.0)
