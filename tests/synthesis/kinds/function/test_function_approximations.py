"""Functions approximated over a range, against the literature, and pairs that no linkage meets exactly."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synthesis.kinds.function.fourbar.error_levelling import equalize_errors
from synthesis.kinds.function.fourbar.minimax_descent import Descent
from synthesis.kinds.function.fourbar.precision_points import solve_many_exact
from synthesis.kinds.function.fourbar.task import make_function_task
from synthesis.kinds.function.problem import FunctionProblem
from tests.campaign import further
from tests.support.synthesis.function_tasks import (
    CASES,
    UNBOUNDED,
    measured,
    pairs_of,
    planted_fourbar,
    proportions,
    solved,
    task_of,
)


class TestApproximations:
    @pytest.mark.slow
    @pytest.mark.parametrize("case", further(CASES, CASES[:2]), ids=lambda case: case["id"])
    def test_the_classical_tasks(self, case):
        task = task_of(case)
        exact, square, minimax = (
            solved(**task, criterion=criterion).designs[0] for criterion in ("precision", "least_squares", "minimax")
        )
        assert minimax.structural_error.max <= 1.01 * case["reference"]["value"]
        # Five free numbers, and so six extremes of one size.
        assert minimax.structural_error.alternations >= 6
        shares = np.linspace(0.0, 1.0, 1001)
        worst, mean = {}, {}
        for name, design in (("exact", exact), ("square", square), ("minimax", minimax)):
            errors = measured(design, task, shares)
            worst[name], mean[name] = np.abs(errors).max(), math.sqrt(np.trapezoid(errors**2, shares))
            assert worst[name] == pytest.approx(design.structural_error.max, rel=2e-3)
            assert mean[name] == pytest.approx(design.structural_error.rms, rel=2e-3)
            assert design.dials.input.scale * (task["function"]["x"][1] - task["function"]["x"][0]) == pytest.approx(
                task["input_range"]
            )
        assert worst["minimax"] <= worst["exact"]
        assert worst["minimax"] <= worst["square"]
        assert mean["square"] <= mean["exact"]
        assert mean["square"] <= mean["minimax"]

    @pytest.mark.slow
    def test_with_zeros_given_four_extremes(self):
        task = task_of(CASES[3])
        design = solved(**task, zeros={"input": 240.0, "output": 220.0}).designs[0]
        assert design.structural_error.alternations >= 4
        assert design.mechanism.reference_input_angle % 360.0 == pytest.approx(240.0)
        square = solved(**task, zeros={"input": 240.0, "output": 220.0}, criterion="least_squares").designs[0]
        assert square.structural_error.rms <= design.structural_error.rms
        assert len({round(d.mechanism.links.coupler, 6) for d in [square]}) == 1

    @pytest.mark.slow
    @pytest.mark.parametrize("sign", further([1.0, -1.0], [-1.0]))
    def test_either_direction_is_tried_where_it_is_open(self, sign):
        # The optima of both directions differ three times.
        either = solved(**task_of(CASES[0]), either_direction=True)
        given = solved(**{**task_of(CASES[0]), "output_range": sign * 60.0})
        there = [d for d in either.designs if d.metrics.output_range * sign > 0.0]
        assert there[0].structural_error.max == pytest.approx(given.designs[0].structural_error.max, rel=1e-3)
        assert either.designs[0].metrics.output_range < 0.0
        assert either.designs[0].structural_error.max == pytest.approx(0.00102, rel=0.005)

    @pytest.mark.campaign
    def test_a_limit_on_the_link_ratio_is_a_part_of_the_task(self):
        # x² from 0 runs to links without end: the more is allowed the smaller the error.
        errors = []
        for ratio in (10.0, 100.0, 1000.0):
            result = solved(
                function={"name": "power", "exponent": 2.0, "x": [0.0, 1.0]},
                input_range=90.0,
                output_range=90.0,
                constraints={"max_link_ratio": ratio},
            )
            for design in result.designs:
                assert design.metrics.link_ratio <= ratio * (1.0 + 1e-9)
            errors.append(result.designs[0].structural_error.max)
        assert errors[0] > 1.5 * errors[1]
        assert errors[1] > 1.2 * errors[2]

    @pytest.mark.campaign
    def test_limits_hold(self):
        limits = {"max_link_ratio": 5.0, "min_transmission_angle": 50.0}
        task = {**task_of(CASES[0]), "constraints": limits}
        for criterion in ("least_squares", "minimax"):
            for design in solved(**task, criterion=criterion).designs:
                assert design.metrics.link_ratio <= 5.0 * (1.0 + 1e-9)
                assert design.metrics.min_transmission_angle >= 50.0 * (1.0 - 1e-9)
        crank = solved(**{**task, "constraints": {"grashof": "crank_rocker"}}).designs[0]
        assert crank.metrics.grashof == "crank_rocker"

    def test_slider_cranks_alternate_too(self):
        result = solved(
            mechanism="slider_crank",
            function={"name": "logarithm", "x": [1.0, 10.0]},
            input_range=80.0,
            output_range=50.0,
        )
        assert result.designs[0].structural_error.alternations >= 6
        assert result.designs[0].structural_error.max <= 0.0081
        assert result.designs[0].metrics.output_range == pytest.approx(50.0)

    @pytest.mark.campaign
    def test_pairs_beyond_what_can_be_met_are_followed(self):
        rng = np.random.default_rng(4)
        lengths, inputs, outputs = planted_fourbar(rng, 12)
        noisy = outputs + rng.normal(0.0, 0.05, 12)
        for criterion in ("least_squares", "minimax"):
            design = solved(pairs=pairs_of(inputs, noisy), criterion=criterion, constraints=UNBOUNDED).designs[0]
            assert design.structural_error.rms < 0.06
        exact = solved(pairs=pairs_of(inputs, outputs), criterion="least_squares", constraints=UNBOUNDED).designs[0]
        assert exact.structural_error.max < 1e-4
        assert np.allclose(proportions(exact), lengths, rtol=1e-2)

    @pytest.mark.campaign
    def test_a_table_is_followed_as_the_function_that_it_lists(self):
        x = np.linspace(1.0, 4.0, 61)
        table = {"name": "table", "points": [{"x": float(v), "y": float(v**1.5)} for v in x]}
        one = solved(**{**task_of(CASES[1]), "function": table}).designs[0]
        other = solved(**task_of(CASES[1])).designs[0]
        assert one.structural_error.max == pytest.approx(other.structural_error.max, abs=2e-4)

    @pytest.mark.campaign
    def test_open_ranges_stay_within_their_limits(self):
        result = solved(function={"name": "logarithm", "x": [1.0, 2.0]}, range_limits=[50.0, 100.0])
        for design in result.designs:
            assert 50.0 - 1e-6 <= abs(design.metrics.input_rotation) <= 100.0 + 1e-6
            assert 50.0 - 0.01 <= abs(design.metrics.output_range) <= 100.0 + 0.01

    @pytest.mark.campaign
    def test_an_answer_near_rounding_is_not_refined_without_end(self, monkeypatch):
        # The error falls to 2e-6 degrees and goes on falling: of two hundred level linkages only the best are improved.
        done = []
        improve = Descent.minimax
        monkeypatch.setattr(Descent, "minimax", lambda *given: done.append(1) or improve(*given))
        function = {"name": "power", "exponent": 1.5, "x": [3.511, 4.147]}
        best = solved(function=function, input_range=60.0, constraints=UNBOUNDED).designs[0]
        assert best.structural_error.max < 1e-5
        assert len(done) <= 30

    @pytest.mark.campaign
    def test_an_open_range_is_one_more_free_number(self):
        result = solved(function={"name": "logarithm", "x": [1.0, 2.0]}, input_range=60.0, rank_by="accuracy")
        best = result.designs[0]
        task = task_of(CASES[0]) | {"output_range": best.metrics.output_range, "rank_by": "accuracy"}
        given = solved(**task).designs[0]
        assert best.structural_error.alternations >= 7
        assert best.structural_error.max <= 1.001 * given.structural_error.max
        # Better, as a share of its range, than what either direction of 60° allows.
        assert best.structural_error.max / abs(best.metrics.output_range) < 0.00102 / 60.0

    @pytest.mark.campaign
    def test_the_same_seed_gives_the_same_answer(self):
        task = {**task_of(CASES[3]), "seed": 5}
        assert solved(**task).model_dump() == solved(**task).model_dump()


def test_levelling_comes_to_the_least_greatest_error_from_anywhere_near():
    # From a linkage through badly spaced points; the errors of what is reached are level and the table's optimum.
    problem = FunctionProblem(kind="function", **task_of(CASES[2]), criterion="minimax")
    task = make_function_task(problem)
    shares = np.array([[0.05, 0.25, 0.45, 0.7, 0.95]])
    turned = math.radians(90.0)
    outputs = problem.function.share(90.0 * shares)
    begun = solve_many_exact(task.closure, turned * shares, turned * outputs, task.zeros)[:, :5]
    begun = np.column_stack([begun, np.full((len(begun), 2), turned)])
    signs = task.samples().signs(begun)[:, 0]
    before = np.degrees(np.abs(task.samples().errors(begun, signs)).max(axis=1).min())
    reached, theirs = equalize_errors(task, begun, signs)
    after = np.degrees(np.abs(task.samples().errors(reached, theirs)).max(axis=1).min())
    assert before > 1.3 * after
    assert after == pytest.approx(CASES[2]["reference"]["value"], rel=0.005)
