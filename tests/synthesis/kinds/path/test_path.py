"""Path generation: what is found is driven again by another route, and what the verification must refuse is refused."""

import json
import math

import numpy as np
import pytest
from pydantic import ValidationError

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, positions
from synthesis.dispatch import solve
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.registry import get_first_example, parse_problem
from tests.cases import HERE

CRANK_ROCKER = Fourbar(1.0 - 2.0j, 7.0 + 1.0j, 2.0, 6.0, 5.0, 3.0 + 2.0j)
PUBLISHED = json.loads((HERE / "nine_point.json").read_text(encoding="utf-8"))


def silent(share, message):
    pass


def statement(points, **changes):
    return parse_problem({"kind": "path", "points": [{"x": z.real, "y": z.imag} for z in points], **changes})


def mechanism(linkage, angle, assembly=OPEN_ASSEMBLY):
    at = positions(linkage, angle, assembly)
    joints = (linkage.input_pivot, at.a, at.b, linkage.output_pivot, at.p)
    return build_fourbar(FourbarConfiguration(*map(complex, joints)))


def checks(design):
    return {check.name: check.passed for check in design.verification.checks}


def test_a_linkage_that_draws_the_points_passes():
    angles = np.array([0.3, 0.9, 1.8, 2.2, 3.9, 5.0])
    points = positions(CRANK_ROCKER, angles, OPEN_ASSEMBLY).p
    design = verify_path(statement(points), mechanism(CRANK_ROCKER, angles[0]))
    assert design.verification.passed
    assert np.allclose([math.radians(t.input_angle) for t in design.targets], angles, atol=1e-7)
    assert max(t.residual for t in design.targets) < 1e-12
    assert design.metrics.grashof == "crank_rocker"


def test_a_point_in_line_with_the_crank_is_reached_to_rounding():
    """There the triangle of O2, A and P is flat, and its angle known to half of the digits only."""
    angles = np.array([0.3, 0.9, 1.8, 2.2, 3.9, 5.0])
    at = positions(CRANK_ROCKER, angles[2], OPEN_ASSEMBLY)
    beyond = 3.0 * (at.a - CRANK_ROCKER.input_pivot) / abs(at.a - CRANK_ROCKER.input_pivot)
    aligned = Fourbar(1.0 - 2.0j, 7.0 + 1.0j, 2.0, 6.0, 5.0, complex(beyond * abs(at.b - at.a) / (at.b - at.a)))
    points = positions(aligned, angles, OPEN_ASSEMBLY).p
    design = verify_path(statement(points), mechanism(aligned, angles[0]))
    assert max(t.residual for t in design.targets) < 1e-13
    assert design.verification.passed


def test_points_out_of_order_are_seen():
    points = positions(CRANK_ROCKER, np.array([0.3, 1.8, 0.9, 2.2, 3.9]), OPEN_ASSEMBLY).p
    design = verify_path(statement(points), mechanism(CRANK_ROCKER, 0.3))
    assert not checks(design)["visits_in_order"]
    assert checks(design)["same_circuit"]
    assert verify_path(
        statement(points, constraints={"in_order": False}), mechanism(CRANK_ROCKER, 0.3)
    ).verification.passed


def test_points_of_the_other_circuit_are_seen():
    points = positions(CRANK_ROCKER, np.array([0.3, 0.9, 1.8]), OPEN_ASSEMBLY).p
    points[1] = positions(CRANK_ROCKER, 0.9, -OPEN_ASSEMBLY).p
    design = verify_path(statement(points), mechanism(CRANK_ROCKER, 0.3))
    assert checks(design)["reaches_targets"]
    assert not checks(design)["same_circuit"]


@pytest.mark.parametrize("off", [1e-6, 1e-3, 1.0])
@pytest.mark.parametrize("moved", [0, 2])
def test_a_point_off_the_curve_is_not_reached(off, moved):
    points = positions(CRANK_ROCKER, np.array([0.3, 0.9, 1.8, 2.5]), OPEN_ASSEMBLY).p
    first = mechanism(CRANK_ROCKER, 0.3)
    points[moved] += off * (1.0 + 1.0j)
    design = verify_path(statement(points), first)
    assert design is None or not checks(design)["reaches_targets"]


@pytest.mark.campaign
@pytest.mark.parametrize("case", PUBLISHED[:3], ids=[case["id"] for case in PUBLISHED[:3]])
def test_published_counts_of_usable_linkages(case):
    """Circuits and order of the real triples, counted independently once for the cases."""
    points = [complex(*point) for point in case["inputs"]["points"]]
    expected = case["expected"]
    demands = {"in_order": True, "full_rotation": True}
    result = solve(statement(points, method="exact", constraints=demands), silent)
    assert result.search.complete
    assert result.triples.computed == expected["cognate_triples_complex"]
    assert result.triples.real == expected["cognate_triples_real"]
    assert result.triples.on_one_circuit == expected["real_triples_with_all_points_on_one_circuit"]
    assert bool(result.designs) == bool(expected["of_these_in_order_with_a_rotating_crank"])
    assert result.search.candidates == result.search.accepted + sum(result.search.rejected.values())
    for design in result.designs:
        assert passes_in_order(design, points)


def passes_in_order(design, points):
    """Whether the finished linkage, swept finely from its dimensions by circles that intersect, meets all in order."""
    m = design.mechanism
    o2, o4 = complex(*m.fixed_pivots.input), complex(*m.fixed_pivots.output)
    turned = np.array([t.input_angle for t in design.targets])
    sweep = np.radians(np.linspace(turned[0], turned[-1], 20_001))
    a = o2 + m.links.input * np.exp(1j * sweep)
    gap = o4 - a
    along = (m.links.coupler**2 - m.links.output**2 + np.abs(gap) ** 2) / (2.0 * np.abs(gap))
    across = np.sqrt(m.links.coupler**2 - along**2)
    b = a + gap / np.abs(gap) * (along + (1j if m.assembly == "open" else -1j) * across)
    p = a + (b - a) / np.abs(b - a) * m.coupler_point.distance * np.exp(1j * math.radians(m.coupler_point.angle))
    nearest = [int(np.abs(p - point).argmin()) for point in points]
    step = np.abs(np.diff(p)).max()
    return nearest == sorted(nearest) and all(np.abs(p - point).min() <= step for point in points)


@pytest.mark.campaign
def test_fewer_points_are_met_by_members_of_their_family():
    problem = parse_problem(get_first_example("path"))
    result = solve(problem, silent)
    assert not result.search.complete
    assert result.search.method == "family_search"
    assert result.designs
    for design in result.designs:
        assert design.verification.passed
        assert passes_in_order(design, [point.point for point in problem.points])
    assert solve(problem, silent) == result


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"points": [{"x": 0.0, "y": 0.0}] * 2}, ("points",)),
        ({"points": [{"x": float(n), "y": 0.0} for n in range(1001)]}, ("points",)),
        ({"timing": "some"}, ("timing",)),
        ({"fixed_pivots": {"input": [1.0, 1.0], "output": [1.0, 1.0]}}, ("fixed_pivots",)),
        ({"rounds": 0}, ("rounds",)),
        ({"points": [{"x": 0.0, "y": 0.0, "angle": 1.0}] * 3}, ("points", 0, "angle")),
    ],
)
def test_ill_formed_statements_name_the_field(changes, where):
    stated = {"kind": "path", "points": [{"x": float(n), "y": n * n * 1.0} for n in range(4)], **changes}
    with pytest.raises(ValidationError) as caught:
        parse_problem(stated)
    assert ("<path>", *where) in [error["loc"] for error in caught.value.errors()]


def turned(*angles, **changes):
    """A statement with prescribed timing: points on a parabola, at these crank angles."""
    points = [{"x": float(n), "y": n * n * 1.0, "crank_angle": angle} for n, angle in enumerate(angles)]
    return parse_problem({"kind": "path", "timing": "prescribed", "points": points, **changes})


@pytest.mark.parametrize(
    ("problem", "where"),
    [
        (statement([0.0j, 1.0 + 1.0j, 2.0 + 0.0j, 1.0 + 1.0j]), "/points/3"),
        (statement([0.0j, 1.0 + 1.0j, 0.0j], method="least_squares"), "/points"),
        (statement([n * n + 1.0j * n for n in range(10)], method="exact"), "/method"),
        (statement([0.0j, 1.0 + 1.0j, 3.0j], crank_phase="absolute"), "/crank_phase"),
        (statement([0.0j, 1.0 + 1.0j, 3.0j], crank_direction="either"), "/crank_direction"),
        (
            statement([0.0j, 1.0 + 1.0j, 3.0j], closed=True, constraints={"grashof": "non_grashof"}),
            "/constraints/grashof",
        ),
        (turned(0.0, 30.0, None), "/points/2/crank_angle"),
        (turned(0.0, 30.0, 360.0), "/points/2/crank_angle"),
        (turned(0.0, 30.0, 60.0, timing="free"), "/points/0/crank_angle"),
        (turned(0.0, 30.0, 20.0, 40.0), "/points"),
        (turned(0.0, 30.0, 60.0, 90.0, 120.0, 150.0, method="exact"), "/method"),
        (turned(0.0, 30.0, 60.0, 90.0, 120.0, method="exact", crank_phase="absolute"), "/method"),
        (turned(0.0, 30.0, 30.0, 0.0, method="least_squares"), "/points"),
        (
            turned(
                0.0,
                30.0,
                60.0,
                fixed_pivots={"input": [5.0, None]},
                constraints={"input_pivot_region": {"x": [0.0, 1.0], "y": [0.0, 1.0]}},
            ),
            "/fixed_pivots/input",
        ),
    ],
)
def test_contradictions_name_the_field(problem, where):
    assert where in [fault.path for fault in problem.find_contradictions()]


@pytest.mark.parametrize(
    ("angles", "run"),
    [
        ((0.0, 30.0, 60.0), (0.0, 30.0, 60.0)),
        ((350.0, 10.0, 30.0), (0.0, 20.0, 40.0)),
        ((20.0, 0.0, 320.0, 200.0), (0.0, -20.0, -60.0, -180.0)),
        ((0.0, 120.0, 240.0, 360.0), (0.0, 120.0, 240.0, 360.0)),
        ((10.0, 10.0 - 1e-12, 50.0), (0.0, 0.0, 40.0)),
    ],
)
def test_prescribed_angles_are_one_run_of_the_crank(angles, run):
    assert np.allclose(turned(*angles).crank_turns, np.radians(run), atol=1e-10)
