"""The page of fields and checks names all that there are, and none more."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path

import pytest

from synthesis.kinds.function.problem import FunctionConstraints
from synthesis.kinds.path.problem import PathConstraints
from synthesis.model.linkage.problem import FORCE_NAMES, Constraints, LinkageProblem
from synthesis.model.problem import ProblemBase
from synthesis.registry import KINDS
from synthesis.verification.checks import REACHES_TARGETS
from synthesis.verification.workspace import WORKSPACE_CHECKS

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "reference" / "checks.md").read_text("utf-8")

MAKERS = {"Check", "check_minimum", "check_maximum", "check_error", "check_zone", "check"}
"""What makes a check: its name is the first argument, or is called so."""

LIMITED = ("rate", "free_length", "preload", "min_length", "max_length", "max_force", "max_torque", "max_deflection")

MADE_OF = {
    ("kinds/balancing/verification/minimum.py", "f\"max_{level.name.replace(' ', '_')}\""): (
        "max_shaking_force",
        "max_shaking_moment",
        "max_drive",
        "max_joint_<joint>",
    ),
    ("kinds/cam/verification/rates.py", "f'peak_{name}'"): ("peak_velocity", "peak_acceleration", "peak_jerk"),
    ("kinds/cam/verification/rates.py", "name"): ("meets_velocities", "meets_accelerations"),
    ("kinds/cam/verification/reproduction.py", "f'table_{dimension}'"): (
        "table_velocity",
        "table_acceleration",
        "table_jerk",
    ),
    ("kinds/cam/verification/reproduction.py", "name"): (),
    ("kinds/cam/verification/verify.py", "name"): ("outer_wall_reproduces_program",),
    ("kinds/dwell/verification.py", "f'dwell_{rest.index + 1}'"): ("dwell_<n>",),
    ("kinds/dwell/verification.py", "f'dwell_{rest.index + 1}_at_end'"): ("dwell_<n>_at_end",),
    ("kinds/dwell/verification.py", "f'dwell_{rest.index + 1}_at_place'"): ("dwell_<n>_at_place",),
    ("kinds/gear_train/verification.py", "name"): ("contact_ratio", "tip_thickness"),
    ("kinds/motion/verification/checks.py", "name"): ("input_side", "output_side"),
    ("kinds/spring_balancing/verification.py", "name"): (*LIMITED, "extension", "compression"),
    ("results/forces.py", "name"): FORCE_NAMES,
    ("results/layout.py", "PLANES"): ("planes",),
    ("results/manufacture.py", "YIELD"): ("yield",),
    ("verification/checks.py", "REACHES_TARGETS"): (REACHES_TARGETS,),
    ("verification/checks.py", "name"): (),
    ("verification/constraints.py", "name"): ("fixed_pivot_region", "moving_pivot_region"),
    ("verification/workspace.py", "WORKSPACE_CHECKS[moving]"): WORKSPACE_CHECKS[:2],
    ("nearest_miss.py", "ratio.check"): ("ratio", "ratio_error", "ratios", "speeds"),
}
"""The names that are no literals where a check is made, by file and expression. Empty: names that others hand over."""


def named(call: ast.Call) -> ast.expr | None:
    """The name that a call gives a check."""
    function = call.func.id if isinstance(call.func, ast.Name) else getattr(call.func, "attr", "")
    if function not in MAKERS or (isinstance(call.func, ast.Attribute) and function != "check"):
        return None
    return next((word.value for word in call.keywords if word.arg == "name"), call.args[0] if call.args else None)


def made() -> set[str]:
    """The names of all checks that the sources make."""
    names: set[str] = set()
    places = set()
    for path in sorted((ROOT / "synthesis").rglob("*.py")):
        place = path.relative_to(ROOT / "synthesis").as_posix()
        if place == "kinds/spring_balancing/effects.py":  # rows of a convex program, by the same word
            continue
        for call in (node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Call)):
            name = named(call)
            if isinstance(name, ast.Constant) and isinstance(name.value, str):
                names.add(name.value)
            elif name is not None:
                places.add((place, ast.unparse(name)))
    assert places == MADE_OF.keys()
    return names | {name for several in MADE_OF.values() for name in several}


def rows(heading: str) -> list[list[str]]:
    """The cells of the rows of all tables whose first column has a heading."""
    found, inside = [], False
    for line in PAGE.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if not cells:
            inside = False
        elif cells[0] == heading:
            inside = True
        elif inside and set(cells[0]) != {"-"}:
            found.append(cells)
    return found


def names_in(cell: str) -> list[str]:
    return re.findall(r"`([^`]+)`", cell)


@pytest.mark.slow
def test_the_page_names_every_check_once_and_none_more() -> None:
    listed = [name for cells in rows("check") for name in names_in(cells[0])]
    once_more = {"shaking_force", "shaking_moment", "drive_torque", "size"}
    assert {name for name in listed if listed.count(name) > 1} <= once_more
    assert set(listed) == made()


def test_every_kind_that_the_page_says_has_a_check_is_one() -> None:
    words = {name for cells in rows("check") for name in names_in(cells[1]) if name.isidentifier()}
    blocks = {"space", "layout", "manufacture", "dynamics", "constraints", "limits", "caps", "max_planes"}
    assert words <= {*KINDS, *blocks, "closed", "shock_free", "counterweights", "stance"}


def test_the_page_names_every_field_that_kinds_have_in_common() -> None:
    listed = [names_in(cells[0])[0] for cells in rows("field") if len(cells) == 3]
    assert sorted(listed) == sorted(LinkageProblem.model_fields)
    assert listed[: len(ProblemBase.model_fields)] == list(ProblemBase.model_fields)
    (of_linkages,) = re.findall(r"^(`motion`.*?) have these too", PAGE, re.MULTILINE | re.DOTALL)
    assert set(names_in(of_linkages)) == {
        kind.name for kind in KINDS.values() if issubclass(kind.problem, LinkageProblem)
    }


def test_the_page_names_every_constraint_with_its_default_and_its_check() -> None:
    listed = {names_in(cells[0])[0]: cells for cells in rows("field of `constraints`")}
    assert set(listed) == Constraints.model_fields.keys() | PathConstraints.model_fields.keys()
    checks = {name for cells in rows("check") for name in names_in(cells[0])}
    for name, (_, left_out, _, of_checks) in listed.items():
        default = PathConstraints.model_fields[name].default
        assert left_out.startswith("none" if default is None else f"`{json.dumps(default)}`")
        assert {*names_in(of_checks)} <= checks
    assert FunctionConstraints.model_fields["max_link_ratio"].default == 100.0
    assert listed["max_link_ratio"][1] == "none; 100 for `function`"


def test_every_field_of_every_problem_has_the_default_that_the_page_tells() -> None:
    told = {names_in(cells[0])[0]: cells[1] for cells in rows("field") if len(cells) == 3}
    for kind in KINDS.values():
        for name in ProblemBase.model_fields.keys() - {"kind"}:
            assert told[name].strip("`") == json.dumps(kind.problem.model_fields[name].default)
