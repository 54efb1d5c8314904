"""Two to four positions with tolerances: they are used, and kept by every design."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from kinematics.linkage.fourbar import Fourbar, positions
from synthesis.kinds.motion.constrained.residuals import (
    ASSEMBLY,
    BOXES,
    COSINE,
    DIRECTION,
    FIXED_RESIDUAL_COUNT,
    GIVEN_COORDINATES,
    HOME_PIVOTS,
    HOME_WEIGHT_INDEX,
    LINE,
    MAX_LINK,
    MIN_LINK,
    RATIO,
    SHORTEST,
    STEPS,
    count_equations,
    count_pose_margins,
    evaluate_rows,
)
from synthesis.kinds.motion.design import MotionResult
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.support.synthesis.motion_search import run
from tests.support.synthesis.planted import plant

HATCH: dict[str, Any] = {
    "positions": [
        {"x": 0.0, "y": 0.0, "angle": 0.0},
        {"x": 230.0, "y": 240.0, "angle": 40.0, "tolerance": {"x": 40.0, "y": 40.0, "angle": 15.0}},
        {"x": 190.0, "y": 470.0, "angle": 85.0, "tolerance": {"x": 30.0, "y": 30.0, "angle": 3.0}},
    ],
    "constraints": {
        "fixed_pivot_region": {"x": [-250.0, -30.0], "y": [120.0, 290.0]},
        "moving_pivot_region": {"x": [-60.0, -10.0], "y": [-280.0, 280.0]},
    },
}
"""A lid: closed exactly, half open and open within tolerances, with all pivots in narrow zones."""

SWEEP = 20_001
"""Inputs of a dense sweep over the used range."""


def within(design: LinkageDesign, stated: list[dict[str, Any]]) -> tuple[list[float], float]:
    """The greatest share of a tolerance that each position needs, by a dense sweep of plain complex arithmetic.

    Of an exact position it is the distance, over the design's size, or the angle in radians. Then: the least
    transmission angle on the way, degrees.
    """
    joints = {name: complex(*z) for name, z in design.mechanism.skeleton.joints.items()}
    o2, a, b, o4, p = (joints[name] for name in ("O2", "A", "B", "O4", "P"))
    reference = design.mechanism.reference_body_angle
    shift = 0.0 if reference is None else reference - stated[0]["angle"]
    ends = [target.input_angle for target in design.targets]
    turns = np.radians(np.linspace(min(ends), max(ends), SWEEP)) - np.angle(a - o2)
    turns = np.union1d(turns, np.radians(ends) - np.angle(a - o2))
    pins = o2 + (a - o2) * np.exp(1j * turns)
    base = o4 - pins
    coupler, output = abs(b - a), abs(b - o4)
    along = (np.abs(base) ** 2 + coupler**2 - output**2) / (2.0 * np.abs(base))
    across = np.sqrt(coupler**2 - along**2)
    side = math.copysign(1.0, ((o4 - a).conjugate() * (b - a)).imag)
    others = pins + base / np.abs(base) * (along + 1j * side * across)
    spins = (others - pins) / (b - a)
    places = pins + (p - a) * spins
    angles = np.degrees(np.angle(spins)) + shift
    shares = []
    for pose in stated:
        off = np.stack(
            [
                places.real - pose["x"],
                places.imag - pose["y"],
                np.mod(angles - (pose["angle"] - stated[0]["angle"]) + 180.0, 360.0) - 180.0,
            ]
        )
        widths = pose.get("tolerance")
        if widths is None:
            units = np.array([design.metrics.size, design.metrics.size, math.degrees(1.0)])
        else:
            units = np.array([widths["x"], widths["y"], widths["angle"]])
        shares.append(float((np.abs(off) / units[:, None]).max(axis=0).min()))
    cosines = np.abs(coupler**2 + output**2 - np.abs(base) ** 2) / (2.0 * coupler * output)
    return shares, math.degrees(math.acos(cosines.max()))


def confirm_tolerated(result: MotionResult, stated: list[dict[str, Any]]) -> None:
    """Every design keeps every tolerance, and holds what has none, as a sweep of the tests' own finds."""
    assert result.designs
    for design in result.designs:
        assert design.verification.passed
        shares, least = within(design, stated)
        for share, pose in zip(shares, stated, strict=True):
            # Between two inputs of the sweep an exact position is missed by the way between them.
            assert share <= (1.0 + 1e-3 if "tolerance" in pose else 1e-6)
        assert least == pytest.approx(design.metrics.min_transmission_angle, abs=1e-3)


@pytest.mark.slow
def test_a_lid_is_guided_within_its_tolerances() -> None:
    result = run(**HATCH)
    assert len(result.designs) == 10
    confirm_tolerated(result, HATCH["positions"])
    assert result.designs[0].metrics.min_transmission_angle > 65.0
    assert not result.search.complete
    assert "samples poses within the tolerances" in result.summary
    assert result.search.candidates == result.search.accepted + sum(result.search.rejected.values())


def test_the_same_positions_exactly_have_no_such_linkage() -> None:
    exact = [{name: value for name, value in pose.items() if name != "tolerance"} for pose in HATCH["positions"]]
    assert run(positions=exact, constraints=HATCH["constraints"]).designs == []


def off_planted(n: int, seed: int) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Positions of a planted linkage, all but the first off by part of their tolerance, and zones around its pivots."""
    rng = np.random.default_rng([n, seed])
    planted = plant(rng, n, 20.0, complex(*rng.uniform(-50.0, 50.0, 2)))
    stated: list[dict[str, Any]] = [dict(planted.positions[0])]
    size = max(abs(complex(p["x"] - q["x"], p["y"] - q["y"])) for p in planted.positions for q in planted.positions)
    for pose in planted.positions[1:]:
        width, angle = 0.05 * size, 5.0
        off = rng.uniform(-1.0, 1.0, 3) * [width, width, angle]
        tolerance = {"x": width, "y": width, "angle": angle}
        place = {name: pose[name] + float(by) for name, by in zip(("x", "y", "angle"), off, strict=True)}
        stated.append({**place, "tolerance": tolerance})
    sides = planted.input_side, planted.output_side

    def zone(pivots: list[complex]) -> dict[str, list[float]]:
        margin = 0.2 * abs(pivots[1] - pivots[0])
        x, y = [z.real for z in pivots], [z.imag for z in pivots]
        return {"x": [min(x) - margin, max(x) + margin], "y": [min(y) - margin, max(y) + margin]}

    regions = {
        "fixed_pivot_region": zone([side.fixed_pivot for side in sides]),
        "moving_pivot_region": zone([side.moving_pivot for side in sides]),
    }
    return stated, regions


@pytest.mark.slow
@pytest.mark.parametrize("n", [2, 3, 4])
@pytest.mark.parametrize("seed", further([0, 1, 2], [0]))
def test_positions_off_a_planted_linkage_are_answered(n: int, seed: int) -> None:
    stated, regions = off_planted(n, seed)
    result = run(positions=stated, constraints=regions)
    confirm_tolerated(result, stated)
    for design in result.designs:
        checks = {check.name: check for check in design.verification.checks}
        assert checks["fixed_pivot_region"].passed
        assert checks["moving_pivot_region"].passed


@pytest.mark.slow
def test_least_squares_may_be_asked_for_and_exact_positions_too() -> None:
    assert parse_problem({"kind": "motion", **HATCH, "method": "least_squares"}).find_contradictions() == []
    assert run(**HATCH, method="exact").designs == []
    bare = [{name: value for name, value in pose.items() if name != "tolerance"} for pose in HATCH["positions"]]
    (fault,) = parse_problem({"kind": "motion", "positions": bare, "method": "least_squares"}).find_contradictions()
    assert fault.path == "/method"


@pytest.mark.campaign
def test_a_tolerated_first_position_is_said_where_the_body_stands_otherwise() -> None:
    stated, regions = off_planted(4, 1)
    stated[0]["tolerance"] = {"x": 1.0, "y": 1.0, "angle": 2.0}
    result = run(positions=stated, constraints=regions)
    confirm_tolerated(result, stated)
    assert any(design.mechanism.reference_body_angle is not None for design in result.designs)


@pytest.mark.campaign
def test_what_is_stated_of_a_side_is_kept() -> None:
    stated, regions = off_planted(3, 0)
    box = regions["fixed_pivot_region"]
    pivot = [0.5 * sum(box["x"]), 0.5 * sum(box["y"])]
    result = run(positions=stated, input_side={"fixed_pivot": pivot})
    confirm_tolerated(result, stated)
    for design in result.designs:
        assert list(design.mechanism.fixed_pivots.input) == pivot
    line = {"point": pivot, "angle": 20.0}
    result = run(positions=stated, ground_line=line)
    confirm_tolerated(result, stated)
    assert any(design.mechanism.reference_body_angle is None for design in result.designs)
    for design in result.designs:
        assert {check.name for check in design.verification.checks if check.passed} >= {"ground_line"}


@pytest.mark.campaign
def test_limits_hold_in_steered_linkages() -> None:
    stated, _ = off_planted(4, 2)
    free = run(positions=stated)
    best = free.designs[0].metrics
    constraints = {"min_transmission_angle": min(best.min_transmission_angle, 40.0), "max_link_ratio": 4.0}
    result = run(positions=stated, constraints=constraints)
    for design in result.designs:
        assert design.metrics.min_transmission_angle >= constraints["min_transmission_angle"] - 1e-6
        assert design.metrics.link_ratio <= 4.0 + 1e-6
    confirm_tolerated(result, stated)


def test_margins_are_those_of_the_driven_linkage() -> None:
    """The kernel's margins, by their values at a driven fourbar: closures, deviations, transmission, zones, order."""
    linkage = Fourbar(0.3 - 0.2j, 2.4 + 0.5j, 0.8, 2.0, 1.7, complex(0.7, 0.4))
    inputs = np.array([0.2, 0.9, 1.7])
    at = positions(linkage, inputs, 1)
    first = float(at.coupler_angle[0])
    body = [complex(z - at.p[0]) for z in (at.a[0], at.b[0])]
    off = np.array([[0.0, 0.0, 0.0], [0.2, -0.4, 0.6], [0.5, 0.1, -0.3]])
    widths = np.array([[0.0, 0.0, 0.0], [0.1, 0.1, 0.2], [0.1, 0.1, 0.2]])
    poses = np.stack([at.p.real, at.p.imag, at.coupler_angle - first], axis=1) - off * widths
    origin = complex(poses[0, 0], poses[0, 1])
    pivots = [0.3 - 0.2j, 2.4 + 0.5j, origin + body[0], origin + body[1]]
    x = np.concatenate([np.array(pivots).view(np.float64), off[1:].ravel()])
    setting = np.full(STEPS + 2, np.inf)
    setting[STEPS:] = np.diff(inputs)
    setting[DIRECTION], setting[SHORTEST], setting[COSINE] = 1.0, 1.0, 0.9
    setting[ASSEMBLY] = math.copysign(1.0, ((at.b[0] - at.a[0]).conjugate() * (at.b[0] - pivots[1])).imag)
    setting[MIN_LINK], setting[MAX_LINK], setting[RATIO] = 0.5, 3.0, 4.0
    fixed, moving = [0.0, 3.0, -1.0, 1.0], [-np.inf, np.inf, -np.inf, np.inf]
    setting[BOXES] = [*fixed, *fixed, *moving, *moving]
    setting[GIVEN_COORDINATES] = setting[LINE] = np.nan
    setting[HOME_PIVOTS], setting[HOME_WEIGHT_INDEX] = x[:8], 0.3
    count = count_pose_margins(3)
    margins, residuals = np.empty(count), np.empty(len(x) + FIXED_RESIDUAL_COUNT + count)
    jacobian, multipliers = np.zeros((len(residuals), len(x))), np.zeros(count + 1)
    multipliers[-1] = 1.0
    rows = np.ascontiguousarray(np.concatenate([poses, widths], axis=1))
    assert evaluate_rows(x, rows, setting, multipliers, margins, residuals, jacobian) > 0
    closures = margins[count - count_equations(3) : count - count_equations(3) + 4]
    assert np.abs(closures).max() < 1e-12
    used = margins[:18].reshape(3, 3, 2)
    assert np.all(np.isinf(used[0]))
    assert used[1:, :, 0] == pytest.approx(1.0 - off[1:], abs=1e-6)
    assert used[1:, :, 1] == pytest.approx(1.0 + off[1:], abs=1e-6)
    assert margins[18:22] == pytest.approx([0.3, 2.7, 0.8, 1.2], abs=1e-12)
    lengths = np.array([abs(pivots[1] - pivots[0]), 0.8, 2.0, 1.7])
    assert margins[34:42] == pytest.approx(
        np.stack([np.log(lengths / 0.5), np.log(3.0 / lengths)], axis=1).ravel(), abs=1e-6
    )
    swept = positions(linkage, np.linspace(inputs[0], inputs[-1], 2001), 1)
    cosines = (2.0**2 + 1.7**2 - np.abs(pivots[1] - swept.a) ** 2) / (2.0 * 2.0 * 1.7)
    cosine_margins = margins[54:62]
    known = cosine_margins[np.isfinite(cosine_margins)]
    assert known.min() == pytest.approx(0.9 - np.abs(cosines).max(), abs=1e-6)
    order = margins[62 + 3 + 3 : 62 + 3 + 3 + 3]
    assert order == pytest.approx([0.7 - 1e-3, 0.8 - 1e-3, math.tau - 1e-3 - 1.5], abs=1e-9)
