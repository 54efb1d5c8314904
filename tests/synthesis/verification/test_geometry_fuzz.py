"""A hundred random problems of each kind, most of them absurd; ``benchmarks.geometry_fuzz`` does thousands."""

import math

import pytest

from synthesis.model.problem import MIN_MAGNITUDE
from synthesis.registry import KINDS, parse_problem
from tests.support.problems.geometry_cases import case
from tests.support.problems.geometry_fuzz import run, tally


@pytest.mark.fuzz
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("kind", KINDS)
def test_whatever_is_stated_is_answered_or_refused(kind):
    counted = tally(kind, range(100_000, 100_100))
    assert not counted.wrong
    assert counted.results["designs"] >= 10
    assert counted.results["refused"] >= 10


@pytest.mark.slow
def test_a_case_is_made_again_by_its_number():
    assert case("motion", 7) == case("motion", 7) != case("motion", 8)


def test_a_defect_is_told(monkeypatch):
    from synthesis import dispatch

    def broken(problem, progress):
        raise ZeroDivisionError("a defect")

    monkeypatch.setattr(dispatch, "solve", broken)
    outcomes = [run("gear_train", number) for number in range(20)]
    assert {outcome.what for outcome in outcomes} == {"refused", "exception"}
    assert all(outcome.wrong == (outcome.what == "exception") for outcome in outcomes)


@pytest.mark.parametrize("number", [5e-324, -5e-324, 1e-300, 0.99 * MIN_MAGNITUDE])
def test_what_is_nearly_nothing_is_nothing(number):
    stated = {
        "kind": "motion",
        "positions": [{"x": number, "y": 0.0, "angle": 0.0}, {"x": 1.0, "y": 0.0, "angle": 9.0}],
    }
    read = parse_problem(stated)
    stated["positions"][0]["x"] = 0.0
    assert read == parse_problem(stated)
    assert read.positions[0].x == 0.0
    stated["positions"][0]["x"] = 1.01 * math.copysign(MIN_MAGNITUDE, number)
    assert parse_problem(stated).positions[0].x == stated["positions"][0]["x"]


@pytest.mark.parametrize(
    ("kind", "number"), [("quick_return", 83), ("steering", 32), ("parallel_motion", 70), ("straight_line", 555)]
)
def test_what_was_found(kind, number):
    assert not run(kind, number).wrong
