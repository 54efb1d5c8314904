"""Function generation through precision points: exact linkages against planted ones and the literature."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.linkage import SliderCrank, slider_crank
from synthesis.kinds.function.fourbar.closure import FOURBAR
from synthesis.kinds.function.fourbar.precision_points import solve_many_exact
from tests.campaign import further, sampled
from tests.support.synthesis.function_tasks import (
    CASES,
    UNBOUNDED,
    holds,
    pairs_of,
    planted_fourbar,
    proportions,
    scaled_pairs,
    solved,
    task_of,
)


def rotations(problem_outputs):
    """Outputs from the first, without full turns."""
    return np.degrees(np.unwrap(np.radians(problem_outputs)) - np.radians(problem_outputs[0]))


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

    def test_zeros_that_are_left_out_are_open_where_held_ones_have_no_answer(self):
        rng = np.random.default_rng(41)
        demands = {"min_transmission_angle": 25.0, "max_link_ratio": 6.0}
        held = opened = 0
        for _ in range(8):
            _, inputs, outputs = planted_fourbar(rng, 3)
            # Read off dials that stand anywhere on the links.
            pairs = pairs_of(inputs + rng.uniform(-180.0, 180.0), outputs + rng.uniform(-180.0, 180.0))
            result = solved(pairs=pairs, constraints=demands)
            assert result.designs
            for design in result.designs:
                assert design.verification.passed
                assert np.allclose(
                    rotations(drive_again(design, pairs)), rotations([p["output"] for p in pairs]), atol=1e-7
                )
            if "were read as angles from the ground line" in result.summary:
                held += 1
                dial = result.designs[0].dials.input
                assert math.remainder(dial.place - dial.at, 180.0) == pytest.approx(0.0, abs=1e-7)
            else:
                opened += 1
                assert "With the zeros left open" in result.summary
                assert not result.search.complete
        assert opened >= 4

    def test_null_leaves_zeros_open_at_once(self):
        _, inputs, outputs = planted_fourbar(np.random.default_rng(1), 3)
        pairs = pairs_of(inputs, outputs)
        result = solved(pairs=pairs, zeros=None, constraints=UNBOUNDED)
        assert not result.search.complete
        assert len(result.designs) == 10
        held = solved(pairs=pairs, constraints=UNBOUNDED)
        assert len(held.designs) == 1
        assert "the zeros may be left open instead" in held.summary

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

    @pytest.mark.parametrize("count", further([3, 5, 7], [3, 5]))
    def test_angles_may_go_on_from_360_with_0(self, count):
        rng = np.random.default_rng(30 + count)
        for _ in range(3):
            lengths, inputs, outputs = planted_fourbar(rng, count)
            middle = inputs[count // 2], outputs[count // 2]
            shifted = np.mod(inputs - middle[0], 360.0), np.mod(outputs - middle[1], 360.0)
            zeros = {"input": middle[0], "output": middle[1]} if count == 3 else "auto"
            for order in (slice(None), slice(None, None, -1)):
                stated = pairs_of(shifted[0][order], shifted[1][order])
                assert holds(solved(pairs=stated, zeros=zeros, constraints=UNBOUNDED), lengths, 1e-5)

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
                zeros = {3: "auto", 4: {"output": 0.0}, 5: None}[count]
                result = solved(
                    mechanism="slider_crank", pairs=pairs_of(inputs, travel), zeros=zeros, constraints=UNBOUNDED
                )
                assert result.search.complete
                found = [
                    (d.mechanism.links.crank, d.mechanism.links.coupler, -d.mechanism.offset) for d in result.designs
                ]
                assert any(np.allclose(one, (a, b, e), rtol=1e-6, atol=1e-6) for one in found)


class TestOpenScales:
    @pytest.mark.slow
    @pytest.mark.parametrize("count", [6, 7])
    def test_planted_linkages_come_back(self, count):
        rng = np.random.default_rng(count)
        for _ in range(6):
            lengths, pairs = scaled_pairs(rng, planted_fourbar(rng, count))
            result = solved(pairs=pairs, constraints=UNBOUNDED, max_designs=50)
            assert holds(result, lengths, 1e-5)
            for design in result.designs:
                assert design.targets[-1].residual <= 1e-9

    @pytest.mark.campaign
    @pytest.mark.timeout(400)
    @pytest.mark.parametrize("count", [6, 7])
    def test_a_hundred_planted_linkages_come_back(self, count):
        rng = np.random.default_rng(100 + count)
        for n in range(sampled(100)):
            lengths, pairs = scaled_pairs(rng, planted_fourbar(rng, count))
            result = solved(pairs=pairs, constraints=UNBOUNDED, max_designs=50)
            assert holds(result, lengths, 1e-5), n

    @pytest.mark.slow
    @pytest.mark.parametrize("count", [6, 7])
    def test_pairs_on_their_own_scales_come_first(self, count):
        rng = np.random.default_rng(20 + count)
        for _ in range(3):
            lengths, inputs, outputs = planted_fourbar(rng, count)
            result = solved(pairs=pairs_of(inputs, outputs), constraints=UNBOUNDED, max_designs=1)
            assert np.allclose(proportions(result.designs[0]), lengths, rtol=1e-6)

    def test_one_open_scale_has_the_roots_that_a_fine_scan_shows(self):
        # By another way: of every five of the six pairs all linkages, and whether the sixth is met.
        rng = np.random.default_rng(5)
        shown = 0
        for _ in range(3):
            _, pairs = scaled_pairs(rng, planted_fourbar(rng, 6))
            result = solved(pairs=pairs, constraints=UNBOUNDED, max_designs=50, include_failed=True)
            found = np.sort([design.dials.output.scale for design in result.designs])
            inputs, outputs = np.radians([[p["input"] for p in pairs], [p["output"] for p in pairs]])
            scales = np.geomspace(0.25, min(4.0, math.radians(359.0) / np.ptp(outputs)), 4001)
            some = solve_many_exact(
                FOURBAR, np.tile(inputs[:5], (4001, 1)), scales[:, None] * outputs[:5], (None, None)
            )
            at = scales[some[:, 5].astype(int)]
            a, b, c, phi, psi = some[:, :5].T
            gap = np.abs(1.0 + c * np.exp(1j * (psi + at * outputs[5])) - a * np.exp(1j * (phi + inputs[5])))
            miss = (gap - b) / b
            for scale in found:
                near = np.abs(at / scale - 1.0) < 2e-3
                assert miss[near].min() < 0.0 < miss[near].max()
                shown += 1
        assert shown >= 3

    def test_a_slider_crank_with_the_input_on_an_open_scale(self):
        rng = np.random.default_rng(8)
        for _ in range(5):
            a, b, e = 10.0, rng.uniform(15.0, 30.0), rng.uniform(-3.0, 3.0)
            inputs = 20.0 + 110.0 * (np.arange(6) + rng.uniform(-0.2, 0.2, 6)) / 5.0
            travel = slider_crank.positions(SliderCrank(0.0, 1j * e, 0.0, a, b), np.radians(inputs)).travel
            stated = pairs_of((inputs - inputs[0]) / 1.3, travel)
            result = solved(mechanism="slider_crank", pairs=stated, constraints=UNBOUNDED, max_designs=50)
            found = [(d.mechanism.links.crank, d.mechanism.links.coupler, -d.mechanism.offset) for d in result.designs]
            assert any(np.allclose(one, (a, b, e), rtol=1e-5, atol=1e-5) for one in found)
