"""Files of linkages: the drawing's lengths, joints and splines, and the table of the motion."""

from __future__ import annotations

import csv
import io
import math
from functools import cache
from itertools import pairwise
from typing import Any

import ezdxf
import numpy as np
import pytest

from service.render import export_design
from synthesis.dispatch import solve
from synthesis.registry import parse_problem

THREE = [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 40.0, "y": 15.0, "angle": -25.0},
         {"x": 75.0, "y": 5.0, "angle": -60.0}]  # fmt: skip

PROBLEMS: dict[str, dict[str, Any]] = {
    "fourbar": {},
    "slider_crank": {"output_side": {"dyad": "PR", "slide_angle": 15.0}},
    "inverted_slider_crank": {"output_side": {"dyad": "RP"}},
    "watt_2": {"driver_dyad": True},
    "stephenson_3": {"driver_dyad": {"link": "coupler"}},
}
TYPES = list(PROBLEMS)


@cache
def solved(kind: str, unit: str = "mm") -> tuple[Any, Any]:
    problem = parse_problem({"kind": "motion", "positions": THREE, "max_designs": 1, "length_unit": unit,
                             **PROBLEMS[kind]})  # fmt: skip
    result = solve(problem, lambda _fraction, _message: None)
    assert result.designs[0].mechanism.type == kind
    return result.designs[0], problem


def drawing(kind: str, unit: str = "mm") -> Any:
    document = ezdxf.read(io.StringIO(export_design(*solved(kind, unit), "A linkage", "dxf")))
    auditor = document.audit()
    assert not auditor.has_errors
    assert not auditor.has_fixes
    return document


@pytest.mark.slow
@pytest.mark.parametrize("kind", TYPES)
def test_the_drawing_has_pins_and_links_where_the_skeleton_says(kind: str) -> None:
    design, _ = solved(kind)
    space = drawing(kind).modelspace()
    pins = {complex(c.dxf.center.x, c.dxf.center.y) for c in space.query('CIRCLE[layer=="JOINTS"]')}
    joints = [complex(*place) for place in design.mechanism.skeleton.joints.values()]
    assert len(pins) == len(joints)
    for joint in joints:
        # A driver stands at a toggle at the first target, where the root of a rounding error is left.
        assert min(abs(joint - pin) for pin in pins) < 1e-7 * max(map(abs, joints))
    for link in design.mechanism.skeleton.links:
        if link.name != "ground" and len(link.joints) > 1:
            assert space.query(f'*[layer=="LINK_{link.name.upper()}"]'), link.name
    assert len(space.query('CIRCLE[layer=="TARGETS"]')) == 3


@pytest.mark.parametrize("kind", TYPES)
def test_dimensions_measure_the_true_lengths(kind: str) -> None:
    """What CAD measures between the points of each dimension is a distance between two joints."""
    design, _ = solved(kind)
    measured = sorted(d.get_measurement() for d in drawing(kind).modelspace().query("DIMENSION"))
    joints = {name: complex(*place) for name, place in design.mechanism.skeleton.joints.items()}
    expected = []
    for link in design.mechanism.skeleton.links:
        around = [*link.joints, link.joints[0]] if len(link.joints) > 2 else link.joints
        expected += [abs(joints[p] - joints[q]) for p, q in pairwise(around)]
    np.testing.assert_allclose(measured, sorted(x for x in expected if x > 1e-6), rtol=1e-7)


@pytest.mark.parametrize("kind", TYPES)
def test_the_curve_goes_through_the_targets(kind: str) -> None:
    design, problem = solved(kind)
    document = drawing(kind)
    assert document.header["$INSUNITS"] == 4
    (spline,) = document.modelspace().query('SPLINE[layer=="USED_CURVE"]')
    points = np.array([complex(p.x, p.y) for p in spline.flattening(1e-4)])
    for position in problem.positions:
        near = np.abs(points - position.point).min()
        assert near < 0.5, "between two points of the flattened curve"
    assert document.modelspace().query('SPLINE[layer=="COUPLER_CURVE"]')
    assert design.verification.passed


@pytest.mark.slow
def test_units_are_those_of_the_problem() -> None:
    assert drawing("fourbar", "in").header["$INSUNITS"] == 1


def table(kind: str) -> tuple[list[str], np.ndarray]:
    text = export_design(*solved(kind), "A linkage", "csv")
    rows = list(csv.reader(line for line in text.splitlines() if not line.startswith("#")))
    return rows[0], np.array([[float(x) if x else math.nan for x in row] for row in rows[1:]])


@pytest.mark.parametrize("kind", TYPES)
def test_the_table_keeps_every_link_rigid_and_its_rates_are_differences(kind: str) -> None:
    design, _ = solved(kind)
    names, values = table(kind)
    assert values.shape[0] == 361
    column = {name: values[:, n] for n, name in enumerate(names)}
    slides = {slide.joint for slide in design.mechanism.skeleton.slides}
    inside = np.isfinite(values).all(axis=1)
    assert inside.sum() > 300
    for link in design.mechanism.skeleton.links:
        for p, q in pairwise(link.joints):
            if {p, q} & slides and link.name != "coupler":
                continue
            gap = np.hypot(*(column[f"{p}_{x} [mm]"] - column[f"{q}_{x} [mm]"] for x in "xy"))[inside]
            np.testing.assert_allclose(gap, gap[0], rtol=1e-9)
    at = np.radians(column["input_angle [deg]"])
    middle = slice(40, 320)
    by_differences = np.gradient(column["P_x [mm]"], at)[middle]
    size = np.abs(by_differences).max()
    np.testing.assert_allclose(column["P_vx [mm/rad]"][middle], by_differences, atol=0.02 * size)


@pytest.mark.parametrize(
    "statement",
    [
        {"kind": "quick_return", "mechanism": "fourbar", "time_ratio": 1.2, "swing": 50.0},
        pytest.param(
            {"kind": "path", "points": [{"x": x, "y": y} for x, y in ((0, 0), (10, 6), (22, 8), (33, 5), (40, -3))]},
            marks=pytest.mark.campaign,
        ),
    ],
    ids=lambda statement: statement["kind"],
)
def test_linkages_of_other_kinds_have_the_same_files(statement: dict[str, Any]) -> None:
    problem = parse_problem({**statement, "max_designs": 1})
    design = solve(problem, lambda _fraction, _message: None).designs[0]
    document = ezdxf.read(io.StringIO(export_design(design, problem, "A linkage", "dxf")))
    assert not document.audit().has_errors
    space = document.modelspace()
    assert len(space.query('CIRCLE[layer=="JOINTS"]')) == len(design.mechanism.skeleton.joints)
    assert len(space.query('CIRCLE[layer=="TARGETS"]')) == len(statement.get("points", []))
    text = export_design(design, problem, "A linkage", "csv")
    assert len(text.splitlines()) == 2 + 1 + 361


def test_a_hostile_title_is_only_text() -> None:
    for form in ("dxf", "csv", "svg"):
        text = export_design(*solved("fourbar"), 'A "<b>\x00\n= 1+1', form)
        assert "\x00" not in text
        if form == "dxf":
            assert not ezdxf.read(io.StringIO(text)).audit().has_errors
