"""A second search for designs that a shop can use, where the most accurate ones cannot be used."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from synthesis.dispatch import solve
from synthesis.kinds.path.design import PathResult
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.solver import solve_path
from synthesis.model.answer import Search
from synthesis.registry import KINDS
from synthesis.results.practicality import MAX_LINK_RATIO, MIN_TRANSMISSION_ANGLE, is_sound, order_designs
from synthesis.usable_search import LIMIT_CHECKS, search_usable

LETTER_D = [(0, 0), (25, 0), (50, 0), (75, 0), (100, 0), (85, 25), (50, 36), (15, 25)]
"""Eight points on a closed curve: linkages meet them exactly, but none that was found transmits well."""


def state(points: list[tuple[float, float]], **fields: Any) -> PathProblem:
    return PathProblem.model_validate({"kind": "path", "points": [{"x": x, "y": y} for x, y in points], **fields})


@pytest.mark.slow
def test_a_sound_fit_precedes_exact_designs_that_are_useless() -> None:
    problem = state(LETTER_D, closed=True)
    shares: list[float] = []
    result = solve(problem, lambda share, _message: shares.append(share))
    first = result.designs[0]
    assert is_sound(first)
    assert first.metrics.curve_distance is not None
    assert problem.measure_error(first) < 0.02
    assert not {check.name for check in first.verification.checks} & set(LIMIT_CHECKS)
    exact = [design for design in result.designs if design.metrics.curve_distance is None]
    assert exact
    assert not any(map(is_sound, exact))
    assert "A second search, which required a transmission angle of 30°" in result.summary
    assert "They come before designs that are more accurate but not sound." in result.summary
    assert "No design found" not in result.summary
    assert result.search.method == "family_search, curve_match"
    assert shares == sorted(shares)
    assert shares[-1] == 1.0

    # A client who asks for exact designs gets nothing else.
    exact_only = KINDS["path"].usable
    assert exact_only is not None
    assert exact_only(state(LETTER_D, closed=True, method="exact")) is None


def solve_second(problem: PathProblem, first: PathResult, second: PathResult) -> Any:
    """The answer after a second search with a given result."""
    seen: list[Any] = []

    def record(statement: PathProblem, _progress: Any) -> PathResult:
        seen.append(statement)
        return second

    kind = replace(KINDS["path"], solve=record)
    return search_usable(problem, first, kind, lambda _share, _message: None), seen


@pytest.fixture(scope="module")
def fitted() -> PathResult:
    """Fits of a flat closed curve, by least squares."""
    problem = state(LETTER_D, closed=True, method="least_squares", max_designs=4)
    return solve_path(problem, lambda _share, _message: None)


def change(result: PathResult, angle: float, rms: float) -> PathResult:
    designs = [
        design.model_copy(
            update={
                "metrics": design.metrics.model_copy(
                    update={
                        "min_transmission_angle": angle,
                        "link_ratio": 3.0,
                        "rms_distance": rms,
                        "excursion": 0.0,
                    }
                )
            }
        )
        for design in result.designs
    ]
    return result.model_copy(update={"designs": designs})


class TestWhenToSearch:
    def test_unsound_designs_are_searched_again_with_limits(self, fitted: PathResult) -> None:
        problem = state(LETTER_D, closed=True, max_designs=4)
        answer, seen = solve_second(problem, change(fitted, 10.0, 0.5), change(fitted, 31.0, 0.8))
        (statement,) = seen
        assert statement.constraints.min_transmission_angle == MIN_TRANSMISSION_ANGLE
        assert statement.constraints.max_link_ratio == MAX_LINK_RATIO
        assert statement.method == "curve_match"
        assert answer.searched
        assert [design.metrics.min_transmission_angle for design in answer.result.designs] == [10.0, 10.0, 31.0, 31.0]
        assert "found 4 designs; their smallest error is 0.8 mm." in answer.result.summary

    def test_far_designs_are_reported_but_not_listed(self, fitted: PathResult) -> None:
        problem = state(LETTER_D, closed=True, max_designs=4)
        answer, _ = solve_second(problem, change(fitted, 10.0, 0.5), change(fitted, 31.0, 9.0))
        assert all(design.metrics.min_transmission_angle == 10.0 for design in answer.result.designs)
        assert "found no design with an error below 9 mm." in answer.result.summary
        # There are sound designs, so that the answer must not say that none was found.
        assert not answer.searched
        assert "None of these designs has" in order_designs(problem, answer.result.designs, searched=False).remark

    def test_only_after_a_search_may_none_have_been_found(self, fitted: PathResult) -> None:
        problem = state(LETTER_D, closed=True, max_designs=4)
        nothing = fitted.model_copy(update={"designs": []})
        answer, _ = solve_second(problem, change(fitted, 10.0, 0.5), nothing)
        assert answer.searched
        assert "No design found has" in order_designs(problem, answer.result.designs).remark

    @pytest.mark.parametrize(
        "fields",
        [
            {"constraints": {"min_transmission_angle": 5.0}},
            {"constraints": {"max_link_ratio": 50.0}},
            {"rank_by": "accuracy"},
            {"method": "exact"},
            {"mechanisms": ["stephenson_3"]},
        ],
    )
    def test_choices_of_the_client_are_kept(self, fitted: PathResult, fields: dict[str, Any]) -> None:
        answer, seen = solve_second(state(LETTER_D, closed=True, **fields), change(fitted, 10.0, 0.5), fitted)
        assert not seen
        assert not answer.searched

    def test_sound_designs_need_no_second_search(self, fitted: PathResult) -> None:
        first = change(fitted, 31.0, 0.5)
        answer, seen = solve_second(state(LETTER_D, closed=True), first, fitted)
        assert not seen
        assert answer.result is first

    def test_searches_are_added(self, fitted: PathResult) -> None:
        problem = state(LETTER_D, closed=True)
        counts = {"candidates": 7, "accepted": 3, "rejected": {"residual": 4}}
        search = Search.model_validate({"method": "curve_match", "complete": False, "seed": 0, **counts})
        second = change(fitted, 31.0, 0.8).model_copy(update={"search": search})
        answer, _ = solve_second(problem, change(fitted, 10.0, 0.5), second)
        assert answer.result.search.candidates == fitted.search.candidates + 7


@pytest.mark.slow
def test_progress_of_several_types_ends_at_one() -> None:
    """A sound and near fourbar ends the search before the other types; the share must not stay at one third."""
    points = [(0, 0), (25, 30), (50, 0), (75, 30), (100, 0)]
    shares: list[float] = []
    solve_path(state(points, mechanisms="auto"), lambda share, _message: shares.append(share))
    assert shares[-1] == 1.0
    assert shares == sorted(shares)
