"""Checks that springs break: each is broken by a spring that differs in one value, and by no other."""

from __future__ import annotations

import math
from typing import Any

import pytest

from synthesis.kinds.spring_balancing.effects import Setting
from synthesis.kinds.spring_balancing.spring_parameters import Spring
from synthesis.kinds.spring_balancing.verification import verify_springs
from synthesis.registry import list_examples
from tests.support.synthesis.sprung_linkages import GRAVITY, problem_of

Statement = dict[str, Any]

LEVER = list_examples("spring_balancing")[0]


def test_a_spring_that_is_another_fails_the_proof() -> None:
    setting = Setting(problem_of(LEVER))
    right = Spring(0, (0.25j, complex(0.2)), 5.0 * GRAVITY * 0.3 / (0.25 * 0.2), 0.0, 0.0)

    def broken(spring: Spring, bound: float = 0.0) -> set[str]:
        design = verify_springs(setting, [spring], bound, proved=True)
        assert not isinstance(design, str)
        return {check.name for check in design.verification.checks if not check.passed}

    assert broken(right) == set()
    assert broken(right._replace(rate=1.01 * right.rate)) == {"gap"}
    assert broken(right._replace(rate=1.01 * right.rate), bound=0.5) == {"bound"}
    assert broken(right._replace(rate=2000.0)) == {"gap", "rate"}
    assert broken(right._replace(ends=(0.25j, complex(0.21)), rate=right.rate / 1.05)) == {"ends"}


def broken_checks(statement: Statement, springs: list[Spring]) -> set[str]:
    """The checks that springs break, of which nothing is claimed to be the best."""
    design = verify_springs(Setting(problem_of(statement)), springs, None, proved=False)
    assert not isinstance(design, str)
    return {check.name for check in design.verification.checks if not check.passed}


@pytest.mark.parametrize(
    ("stated", "free"),
    [({"free_angle": -30.0}, -30.0), ({"min_free_angle": -40.0, "max_free_angle": 25.0}, 25.0), ({}, 3600.0)],
)
def test_a_torsion_spring_of_another_free_angle_fails_the_proof(stated: Statement, free: float) -> None:
    turning = {**LEVER, "springs": [{"links": ["ground", "lever"], "max_torsion": 100.0, **stated}]}
    for off, names in ((0.0, set()), (1e-4, {"free_angle"})):
        spring = Spring(0, (), 10.0, math.radians(free + off), 0.0)
        assert broken_checks(turning, [spring]) == names


def test_a_demanded_spring_that_is_missing_fails_the_proof() -> None:
    ends = [{"link": "ground", "point": [0.0, 250.0]}, {"link": "lever", "point": [150.0, 0.0]}]
    both = [{"ends": ends, "min_rate": 1.0}, {"links": ["ground", "lever"]}]
    spring, other = Spring(0, (0.25j, complex(0.15)), 100.0, 0.0, 0.0), Spring(1, (), 1.0, 0.0, 0.0)
    assert broken_checks({**LEVER, "springs": both}, [spring, other]) == set()
    assert broken_checks({**LEVER, "springs": both}, [spring]) == set()
    assert broken_checks({**LEVER, "springs": both}, [other]) == {"demanded_springs"}
    both[1]["torsion"] = 1.0
    assert broken_checks({**LEVER, "springs": both}, [spring]) == {"demanded_springs"}
    real = {**both[0], "min_rate": 0.0, "preload": 5.0, "max_free_length": 60.0}
    assert broken_checks({**LEVER, "springs": [real]}, []) == {"demanded_springs"}


@pytest.mark.parametrize(
    ("changed", "name"),
    [
        ({"rate": 1.00005 * 200.0}, "rate"),
        ({"rate": 0.99995 * 100.0}, "rate"),
        ({"free": 1.00005 * 0.06}, "free_length"),
        ({"free": 0.99995 * 0.05}, "free_length"),
        ({"preload": 1.00005 * 6.0}, "preload"),
        ({"preload": 0.99995 * 5.0}, "preload"),
    ],
)
def test_what_has_no_positions_is_kept_to_rounding(changed: dict[str, float], name: str) -> None:
    ends = [{"link": "ground", "point": [0.0, 250.0]}, {"link": "lever", "point": [150.0, 0.0]}]
    limits = {
        "min_rate": 100.0,
        "max_rate": 200.0,
        "min_free_length": 50.0,
        "max_free_length": 60.0,
        "preload": 5.0,
        "max_preload": 6.0,
    }
    stated = {**LEVER, "springs": [{"ends": ends, **limits}]}
    spring = Spring(0, (0.25j, complex(0.15)), 150.0, 0.055, 5.5)
    assert broken_checks(stated, [spring]) == set()
    assert broken_checks(stated, [spring._replace(**changed)]) == {name}


def test_nothing_may_be_beyond_a_limit_of_zero() -> None:
    ends = [{"link": "ground", "point": [0.0, 250.0]}, {"link": "lever", "point": [150.0, 0.0]}]
    stated = {**LEVER, "springs": [{"ends": ends, "max_free_length": 60.0}]}
    spring = Spring(0, (0.25j, complex(0.15)), 150.0, 0.055, 0.0)
    assert broken_checks(stated, [spring]) == set()
    assert broken_checks(stated, [spring._replace(preload=5.0)]) == {"preload"}
