"""Function generation: exact linkages against planted ones, approximations against the literature."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from kinematics.linkage import Fourbar, SliderCrank, positions, slider_crank
from synthesis.function.solver import solve_function
from synthesis.problems import FunctionProblem

CASES = json.loads((Path(__file__).parents[1] / "cases" / "function_generation.json").read_text())
NAMES = {
    "log10": {"name": "logarithm"},
    "x^1.5": {"name": "power", "exponent": 1.5},
    "sin_deg": {"name": "sine"},
    "exp": {"name": "exponential"},
    "1/x": {"name": "reciprocal"},
    "tan_deg": {"name": "tangent"},
}
UNBOUNDED = {"max_link_ratio": None}


def silent(_fraction, _message):
    pass


def solved(**fields):
    problem = FunctionProblem(kind="function", **fields)
    assert problem.contradictions() == []
    return solve_function(problem, silent)


def task_of(case):
    inputs = case["inputs"]
    return {
        "function": {**NAMES[inputs["func"]], "x": [inputs["x0"], inputs["x1"]]},
        "input_range": inputs["dphi_deg"],
        "output_range": inputs["dpsi_deg"],
        "constraints": UNBOUNDED,
    }


def rotations(problem_outputs):
    """Outputs from the first, without full turns."""
    return np.degrees(np.unwrap(np.radians(problem_outputs)) - np.radians(problem_outputs[0]))


def planted_fourbar(rng, count, inputs=None):
    """A random fourbar driven over a range without toggles: lengths, pairs in degrees from the ground line."""
    while True:
        a, b, c = np.exp(rng.uniform(-1.0, 1.0, 3))
        start, turned = rng.uniform(-math.pi, math.pi), math.radians(rng.uniform(50.0, 120.0))
        shares = np.sort(rng.uniform(0.0, 1.0, count)) if inputs is None else inputs
        theta = start + turned * shares
        linkage, sign = Fourbar(0.0, 1.0, a, b, c), int(rng.choice([-1, 1]))
        dense = positions(linkage, start + turned * np.linspace(0.0, 1.0, 200), sign)
        sine = np.abs(np.sin(dense.output_angle - dense.coupler_angle))
        at = positions(linkage, theta, sign).output_angle
        if np.all(dense.valid) and sine.min() > 0.3 and np.diff(theta).min() > 0.03:
            moved = np.unwrap(at)
            if np.ptp(moved) > 0.3:
                return (a, b, c), np.degrees(theta), np.degrees(moved)


def proportions(design):
    links = design.mechanism.links
    return np.array([links.input, links.coupler, links.output]) / links.ground


def holds(result, lengths, digits=1e-6):
    """Whether a planted linkage, or its mirror image, is among the designs."""
    return any(np.allclose(proportions(design), lengths, rtol=digits) for design in result.designs)


def pairs_of(inputs, outputs):
    return [{"input": float(x), "output": float(y)} for x, y in zip(inputs, outputs, strict=True)]


def drive_again(design, pairs):
    """Outputs at the pairs of a design rebuilt from its lengths, by closure in a triangle: degrees."""
    m = design.mechanism
    o2, o4 = complex(*m.fixed_pivots.input), complex(*m.fixed_pivots.output)
    theta = math.radians(m.reference_input_angle) + np.radians([p["input"] - pairs[0]["input"] for p in pairs])
    pin = o2 + m.links.input * np.exp(1j * theta)
    away = o4 - pin
    f = np.abs(away)
    corner = np.arccos((f**2 + m.links.output**2 - m.links.coupler**2) / (2.0 * f * m.links.output))
    sense = -1.0 if m.assembly == "open" else 1.0
    return np.degrees(np.unwrap(np.angle(-away) + sense * corner))


class TestPrecisionPoints:
    @pytest.mark.parametrize("case", CASES, ids=lambda case: case["id"])
    def test_five_chebyshev_points_have_the_solutions_of_the_table(self, case):
        result = solved(**task_of(case), precision_points=5)
        assert result.search.complete
        listed = [entry for entry in case["published"] if entry["method"].startswith("5 Chebyshev")]
        assert len(result.designs) == len(listed)
        for design, entry in zip(
            sorted(result.designs, key=lambda d: d.structural_error.max),
            sorted(listed, key=lambda e: e["value"]),
            strict=True,
        ):
            assert np.allclose(proportions(design), entry["dims"][:3], rtol=1e-8)
            assert design.structural_error.max == pytest.approx(entry["value"], rel=entry["tol"])

    def test_three_pairs_from_the_ground_line(self):
        # Freudenstein's equation is linear for these, and has one solution.
        rng = np.random.default_rng(1)
        for _ in range(20):
            lengths, inputs, outputs = planted_fourbar(rng, 3)
            result = solved(pairs=pairs_of(inputs, outputs), constraints=UNBOUNDED)
            assert result.search.complete
            (design,) = result.designs
            assert np.allclose(proportions(design), lengths, rtol=1e-8)
            assert design.mechanism.reference_input_angle % 360.0 == pytest.approx(inputs[0] % 360.0)

    @pytest.mark.parametrize(("count", "most"), [(4, 2), (5, 3)])
    def test_planted_linkages_come_back(self, count, most):
        rng = np.random.default_rng(count)
        for _ in range(20):
            lengths, inputs, outputs = planted_fourbar(rng, count)
            zeros = {"output": 0.0} if count == 4 else {}
            pairs = pairs_of(inputs, outputs)
            result = solved(pairs=pairs, zeros=zeros, constraints=UNBOUNDED)
            assert result.search.complete
            assert len(result.designs) <= most
            assert holds(result, lengths)
            for design in result.designs:
                assert np.allclose(
                    rotations(drive_again(design, pairs)), rotations([p["output"] for p in pairs]), atol=1e-7
                )

    def test_two_and_four_pairs_leave_a_family(self):
        for pairs in (
            [(30.0, 40.0), (80.0, 100.0)],
            [(0.0, 0.0), (20.0, 12.0), (50.0, 35.0), (70.0, 55.0)],
        ):
            stated = pairs_of(*zip(*pairs, strict=True))
            result = solved(pairs=stated, constraints={"min_transmission_angle": 30.0, "max_link_ratio": 8.0})
            assert len(result.designs) == 10
            assert not result.search.complete
            for design in result.designs:
                assert design.verification.passed
                assert design.metrics.min_transmission_angle >= 30.0
                assert np.allclose(
                    rotations(drive_again(design, stated)), rotations([p["output"] for p in stated]), atol=1e-7
                )

    def test_a_reversed_link_is_found_and_said(self):
        # The planted input dial is the extension of the link beyond its pivot.
        rng = np.random.default_rng(7)
        lengths, inputs, outputs = planted_fourbar(rng, 3)
        turned = pairs_of(inputs + 180.0, outputs)
        (design,) = solved(pairs=turned, constraints=UNBOUNDED).designs
        assert np.allclose(proportions(design), lengths, rtol=1e-8)
        stated = solved(pairs=turned, zeros={"input": 0.0, "output": 0.0}, constraints=UNBOUNDED)
        assert stated.designs == []
        assert stated.search.rejected == {"reversed_link": 1}

    def test_slider_cranks_come_back(self):
        rng = np.random.default_rng(3)
        for count in (3, 4, 5):
            for _ in range(10):
                a, b, e = 10.0, rng.uniform(14.0, 40.0), rng.uniform(-3.0, 3.0)
                linkage = SliderCrank(0.0, 1j * e, 0.0, a, b)
                inputs = np.sort(rng.uniform(20.0, 150.0, count))
                if np.diff(inputs).min() < 4.0:
                    continue
                travel = slider_crank.positions(linkage, np.radians(inputs)).travel
                zeros = {3: None, 4: {"output": 0.0}, 5: None}[count]
                result = solved(
                    mechanism="slider_crank", pairs=pairs_of(inputs, travel), zeros=zeros, constraints=UNBOUNDED
                )
                assert result.search.complete
                found = [
                    (d.mechanism.links.crank, d.mechanism.links.coupler, -d.mechanism.offset) for d in result.designs
                ]
                assert any(np.allclose(one, (a, b, e), rtol=1e-6, atol=1e-6) for one in found)
