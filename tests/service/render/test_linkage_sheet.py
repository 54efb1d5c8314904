"""The sheet of slider-cranks and driven fourbars: what stands where, readable from the drawing itself."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

import pytest

from service.render import export_design
from service.render.checks import format_check, make_checks_block
from service.units import list_symbols
from synthesis.dispatch import solve
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.registry import parse_problem

SVG = "{http://www.w3.org/2000/svg}"
POSITIONS = [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 40.0, "y": 15.0, "angle": -25.0},
             {"x": 75.0, "y": 5.0, "angle": -60.0}]  # fmt: skip


@pytest.mark.parametrize(
    ("asked", "kind", "rails"),
    [
        ({"output_side": {"dyad": "PR"}}, "slider_crank", 1),
        ({"input_side": {"dyad": "PR"}}, "slider_crank", 1),
        ({"output_side": {"dyad": "RP"}}, "inverted_slider_crank", 1),
        ({"driver_dyad": True}, "watt_2", 0),
    ],
)
def test_all_links_joints_and_targets_are_drawn(asked: dict[str, Any], kind: str, rails: int) -> None:
    problem = parse_problem({"kind": "motion", "positions": POSITIONS, "max_designs": 1, **asked})
    design = solve(problem, lambda fraction, message: None).designs[0]
    assert design.mechanism.type == kind
    text = export_design(design, problem, "A <title> & more", "svg")
    root = ET.fromstring(text)
    joints = {e.get("data-joint") for e in root.iter(f"{SVG}circle")} - {None}
    assert joints == set(design.mechanism.skeleton.joints)
    moving = {link.name for link in design.mechanism.skeleton.links} - {"ground"}
    for configuration in root.iter(f"{SVG}g"):
        if configuration.get("data-configuration"):
            drawn = {e.get("data-link") for e in configuration.iter() if e.get("data-link")}
            assert drawn == moving
    assert len([g for g in root.iter() if g.get("data-configuration")]) == 3
    assert len([g for g in root.iter() if g.get("data-target")]) == 3
    assert len([g for g in root.iter() if g.get("data-rail")]) == rails
    checks = {g.get("data-check") for g in root.iter() if g.get("data-check")}
    assert checks == {check.name for check in design.verification.checks}
    assert export_design(design, problem, "A <title> & more", "svg") == text


def test_numbers_of_checks_have_the_unit_of_what_they_measure() -> None:
    problem = parse_problem({"kind": "motion", "positions": POSITIONS, "length_unit": "in"})
    stated = [
        Check(name="transmission_angle", passed=True, value=41.234, limit=30.0, dimension=ANGLE),
        Check(name="longest_link", passed=False, value=120.0, limit=100.0, dimension=LENGTH),
        Check(name="reaches_targets", passed=True, value=1.23e-15, limit=1e-9),
        Check(name="same_branch", passed=True),
    ]
    block, _ = make_checks_block(Verification(passed=False, checks=stated), problem)(0.0, 0.0, 370.0)
    words = list(ET.fromstring(block.write()).itertext())
    assert words[0] == "Checks: not all passed"
    assert words[2::2] == ["41.234°  (limit 30°)", "120 in  (limit 100 in)", "1.2e−15  (limit 1e−9)"]


@pytest.mark.parametrize(
    ("value", "limit", "passed", "written"),
    [
        (350.05, 350.0, False, ("350.05 mm", "350 mm")),
        (350.0000004, 350.0, False, ("350.0000004 mm", "350 mm")),
        (350.0000004, 350.0, True, ("350 mm", "350 mm")),
        (0.1 + 0.2, 0.3, False, ("0.30000000000000004 mm", "0.29999999999999999 mm")),
        (350.0, 350.0, False, ("350 mm", "350 mm")),
        (None, 350.0, False, ("", "350 mm")),
    ],
)
def test_a_value_that_misses_its_limit_does_not_read_like_the_limit(
    value: float | None, limit: float, passed: bool, written: tuple[str, str]
) -> None:
    problem = parse_problem({"kind": "motion", "positions": POSITIONS})
    check = Check(name="longest_link", passed=passed, value=value, limit=limit, dimension=LENGTH)
    assert format_check(check, list_symbols(problem)) == written
    block, _ = make_checks_block(Verification(passed=passed, checks=[check]), problem)(0.0, 0.0, 370.0)
    words = list(ET.fromstring(block.write()).itertext())
    assert words[2:] == ([f"{written[0]}  (limit {written[1]})"] if written[0] else [])
