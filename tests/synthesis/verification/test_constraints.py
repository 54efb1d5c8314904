"""Every constraint against every kind and mechanism: checked in each answer, or refused with a sentence at its field.

All goes through ``solve(parse_problem(...))``. One statement holds every constraint in a form that any linkage meets,
another one in a form that none can meet; classes of fourbars and rotation, which exclude linkages, come one by one.
What is ordered by is restated here from docs/methods/ranking.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import pytest

from kinematics.linkage.fourbar import Fourbar, barker_class
from synthesis.dispatch import solve
from synthesis.model.answer import Check
from synthesis.model.linkage.problem import FORCE_NAMES, Constraints, Region
from synthesis.model.problem import ContradictionError
from synthesis.nearest_miss import check_constraints_of_design
from synthesis.registry import parse_problem
from synthesis.results.buildability import is_buildable
from synthesis.verification.constraints import check_constraints
from synthesis.verification.measures import Measures
from tests.campaign import further
from tests.support.synthesis.constraints import CASES, STEERING

SEARCHED = {
    "motion by a sixbar",
    "path of a slider-crank",
    "path of a geared fivebar",
    "dwell of a rocker",
    "dwell of a slot",
}
"""Cases that take a quarter of a second or more: each is put in one order and asked for one class of Grashof; another
mechanism of its kind is put in all of them."""

FAR_OFF = {
    "path of a slider-crank",
    "path of a geared fivebar",
    "timed path",
    "fitted motion",
    "function",
    "function of a fourbar",
    "function of a slider-crank",
    "ackermann",
    "motion by a sixbar",
    "dwell of a rocker",
    "dwell of a slider",
}
"""Cases that search for seconds for what comes nearest to demands that nothing meets."""

SLOW = {"dwell of a rocker", "dwell of a slider", "path of a slider-crank", "path of a geared fivebar"}
"""Cases that take longer than others which are answered by the same code."""


def often(cases: Iterable[tuple[str, str]], *, in_turn: int = 1) -> list[Any]:
    """Pairs whose first is the name of a case: those of the slow ones are left to the campaign.

    Of the others every ``in_turn``-th stays. Where a case has four pairs and every third is kept, it keeps one or two,
    other ones than its neighbour.
    """
    every = list(cases)
    return further(every, [case for case in every if case[0] not in SLOW][::in_turn])


EVERYWHERE = {"x": [-1e4, 1e4], "y": [-1e4, 1e4]}
NEAR = {"x": [-300.0, 300.0], "y": [-300.0, 300.0]}
"""For motions, whose pivots are drawn at random from a region that is stated."""

NOWHERE = {"x": [1e6, 1e6 + 1.0], "y": [1e6, 1e6 + 1.0]}
REGION = Region.model_validate(NOWHERE)

LOOSE: dict[str, Any] = {
    "min_transmission_angle": 1e-3,
    "link_length": {"min": 1e-6, "max": 2e3},
    "max_link_ratio": 1e5,
    "fixed_pivot_region": EVERYWHERE,
    "moving_pivot_region": EVERYWHERE,
}
TIGHT: dict[str, Any] = {
    "min_transmission_angle": 89.99,
    "link_length": {"min": 1e-9, "max": 1e-6},
    "max_link_ratio": 1.0,
    "fixed_pivot_region": NOWHERE,
    "moving_pivot_region": NOWHERE,
}
OF_PATHS = {"input_pivot_region": EVERYWHERE}
OF_COUPLERS = {"coupler_point": {"along": [-1e7, 1e7], "across": [-1e7, 1e7]}}

CHECKS = {
    "min_transmission_angle": ["transmission_angle"],
    "grashof": ["grashof"],
    "full_rotation": ["full_rotation"],
    "same_branch": ["same_branch"],
    "in_order": ["visits_in_order"],
    "link_length": ["shortest_link", "longest_link"],
    "max_link_ratio": ["link_ratio"],
    "fixed_pivot_region": ["fixed_pivot_region"],
    "moving_pivot_region": ["moving_pivot_region"],
    "input_pivot_region": ["input_pivot_region"],
    "coupler_point": ["coupler_point"],
}

Key = Callable[[Any], float]


def by_quality(design: Any) -> float:
    return -design.metrics.quality


def by_decade(design: Any) -> float:
    """Residuals of one order of magnitude, and those at the level of rounding, count as equal."""
    return math.floor(math.log10(max(1e-12, *(target.residual for target in design.targets))))


ORDERS: dict[str, Key] = {
    "quality": by_quality,
    "accuracy": by_decade,
    "size": lambda design: design.metrics.size,
    "transmission_angle": lambda design: -design.metrics.min_transmission_angle,
}
OWN_ORDERS: dict[tuple[str, str], Key] = {
    ("steering", "quality"): lambda design: design.metrics.steering_error,
    ("steering", "accuracy"): lambda design: design.metrics.steering_error,
    ("straight_line", "quality"): lambda design: design.metrics.straightness_error,
    ("straight_line", "accuracy"): lambda design: design.metrics.straightness_error,
    ("dwell", "accuracy"): lambda design: design.metrics.jitter,
    ("parallel_motion", "accuracy"): lambda design: design.metrics.rms_residual,
    ("quick_return", "accuracy"): by_quality,
    ("function of pairs", "accuracy"): by_quality,
    ("function of a curve", "quality"): lambda design: design.structural_error.max,
    ("function of a curve", "accuracy"): lambda design: design.structural_error.max,
    ("fitted motion", "quality"): lambda design: design.metrics.rms_residual,
}


def order_of(name: str, rank_by: str) -> Key:
    """What the designs of a case rise in."""
    kind = CASES[name]["kind"]
    if kind == "function":
        kind = "function of pairs" if "pairs" in CASES[name] else "function of a curve"
    return OWN_ORDERS.get((name if name == "fitted motion" else kind, rank_by), ORDERS[rank_by])


def answered(name: str, constraints: dict[str, Any], **fields: Any) -> list[Any]:
    statement = CASES[name]
    demands = {**statement.get("constraints", {}), **constraints}
    return list(solve(parse_problem({**statement, "constraints": demands, **fields})).designs)


def pivots_of(design: Any, *, fixed: bool) -> list[complex]:
    """Joints of the ground, or pins A and B, in the skeleton."""
    skeleton = design.mechanism.skeleton
    ground = next(link.joints for link in skeleton.links if link.name == "ground")
    names = ground if fixed else [name for name in ("A", "B") if name in skeleton.joints]
    return [complex(*skeleton.joints[name]) for name in names]


def checks_of(design: Any) -> dict[str, Check]:
    checks = {check.name: check for check in design.verification.checks}
    assert len(checks) == len(design.verification.checks)
    return checks


def refusal(name: str, field: str, constraints: dict[str, Any]) -> bool:
    """Whether a statement is refused, at the field and with a sentence; every other refusal is an error."""
    statement = CASES[name]
    found = parse_problem({**statement, "constraints": constraints}).find_contradictions()
    assert [fault.path for fault in found] in ([], [f"/constraints/{field}"])
    assert all(len(fault.detail.split()) > 3 for fault in found)
    return bool(found)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "rank_by"),
    often(
        [(name, rank_by) for name in CASES for rank_by in ORDERS if name not in SEARCHED]
        + [(name, "transmission_angle") for name in sorted(SEARCHED)],
        in_turn=3,
    ),
)
def test_constraints_are_checked_and_the_order_kept(name: str, rank_by: str) -> None:
    demands = dict(LOOSE)
    if CASES[name]["kind"] == "motion":
        demands |= {"fixed_pivot_region": NEAR, "moving_pivot_region": NEAR}
    if CASES[name]["kind"] == "path":
        demands |= OF_PATHS
        if CASES[name].get("mechanism", "fourbar") == "fourbar":
            demands |= OF_COUPLERS
        else:
            assert refusal(name, "coupler_point", OF_COUPLERS)
    designs = answered(name, demands, rank_by=rank_by)
    assert designs
    wanted = {check for field in ("same_branch", "in_order", *demands) for check in CHECKS[field]}
    for design in designs:
        checks = checks_of(design)
        assert wanted <= checks.keys()
        assert design.verification.passed
        agrees(name, design, demands)
    # Designs that cannot be built are last in every order.
    values = [order_of(name, rank_by)(design) for design in designs if is_buildable(design)]
    keyed = [round(value, 6) for value in values]
    assert keyed == sorted(keyed)


def agrees(name: str, design: Any, demands: dict[str, Any]) -> None:
    """The constraints as judged by the numbers of the answer (synthesis/nearest_miss.py) are the checks of the
    design."""
    statement = CASES[name]
    problem = parse_problem({**statement, "constraints": {**statement.get("constraints", {}), **demands}})
    checks = checks_of(design)
    for name_of_check, check in checks_of(check_constraints_of_design(problem, design).design).items():
        own = checks[name_of_check]
        assert (check.passed, check.limit) == (own.passed, own.limit)
        assert check.value == (None if own.value is None else pytest.approx(own.value, rel=1e-9, abs=1e-9))


@pytest.mark.slow
@pytest.mark.parametrize("name", further(CASES, [name for name in CASES if name not in FAR_OFF][::2]))
def test_what_breaks_a_constraint_fails(name: str) -> None:
    """Hardly anything can meet these (Davis's gear transmits at 90°): what does not, fails the check."""
    for design in answered(name, TIGHT, include_failed=True, max_designs=3):
        agrees(name, design, TIGHT)
        checks = [checks_of(design)[CHECKS[field][-1]] for field in TIGHT]
        for field, check in zip(TIGHT, checks, strict=True):
            if field == "min_transmission_angle":
                kept = check.value >= check.limit * (1.0 - 1e-8)
            elif check.value is not None:
                kept = check.value <= check.limit * (1.0 + 1e-8)
            else:
                kept = all(map(REGION.contains, pivots_of(design, fixed=field == "fixed_pivot_region")))
            assert check.passed == kept
        assert not design.verification.passed


CLASSES = ["crank_rocker", "double_crank", "double_rocker", "non_grashof"]


@pytest.mark.parametrize(
    ("name", "wanted"),
    often(
        (
            (name, wanted)
            for name in CASES
            for wanted in (CLASSES[:1] if name in SEARCHED | {"function", "fitted motion"} else CLASSES)
        ),
        in_turn=3,
    ),
)
def test_classes_of_fourbars(name: str, wanted: str) -> None:
    if refusal(name, "grashof", {"grashof": wanted}):
        return
    for design in answered(name, {"grashof": wanted}, include_failed=True, max_designs=3):
        own = class_of(design)
        expected = own == ("rocker_rocker" if wanted == "non_grashof" else wanted)
        assert checks_of(design)["grashof"].passed == expected
        assert expected or not design.verification.passed


@pytest.mark.slow
@pytest.mark.parametrize("name", further(CASES, [name for name in CASES if name not in SLOW][::2]))
def test_full_rotation(name: str) -> None:
    if refusal(name, "full_rotation", {"full_rotation": True}):
        return
    for design in answered(name, {"full_rotation": True}, include_failed=True, max_designs=3):
        assert checks_of(design)["full_rotation"].passed == design.metrics.full_rotation
        own = class_of(design)
        if own is not None and design.mechanism.type == "fourbar":
            assert design.metrics.full_rotation == (own in ("crank_rocker", "double_crank"))


def class_of(design: Any) -> str | None:
    """Of the fourbar O2 A B O4 that the mechanism is or begins with, from the joints of the skeleton."""
    if design.mechanism.type in (
        "davis",
        "peaucellier",
        "hart",
        "scott_russell",
        "geared_fivebar",
        "inverted_slider_crank",
    ):
        return None
    joints = {joint: complex(*place) for joint, place in design.mechanism.skeleton.joints.items()}
    if not {"O2", "A", "B", "O4"} <= joints.keys():
        return None
    o2, a, b, o4 = (joints[joint] for joint in ("O2", "A", "B", "O4"))
    return barker_class(Fourbar(o2, o4, abs(a - o2), abs(b - a), abs(b - o4))).motion


def test_steering_is_never_of_a_class_of_grashof() -> None:
    for mechanism in ("ackermann", "davis", "auto"):
        problem = parse_problem({**STEERING, "mechanism": mechanism, "constraints": {"grashof": "double_rocker"}})
        assert [fault.path for fault in problem.find_contradictions()] == ["/constraints/grashof"]
        with pytest.raises(ContradictionError):
            solve(problem)


def test_each_constraint_has_a_check_that_fails_by_itself() -> None:
    of_forces = {f"max_{name}" for name in FORCE_NAMES}  # checked where forces are measured, and tested there
    assert {*CHECKS, *of_forces} >= Constraints.model_fields.keys()
    sound = Measures(
        grashof="crank_rocker",
        barker="GCRR",
        min_transmission_angle=40.0,
        transmission_angles={"coupler": 40.0},
        same_branch=True,
        visits_in_order=True,
        full_rotation=True,
        link_ratio=3.0,
        reach=2.0,
        size=5.0,
        quality=0.5,
        used_range=(0.0, 90.0),
        used_stroke=None,
        lengths=[1.0, 3.0],
    )
    region = {"x": [0.0, 1.0], "y": [0.0, 1.0]}
    demands = Constraints.model_validate(
        {
            "min_transmission_angle": 30.0,
            "grashof": "crank_rocker",
            "full_rotation": True,
            "link_length": {"min": 0.5, "max": 4.0},
            "max_link_ratio": 5.0,
            "fixed_pivot_region": region,
            "moving_pivot_region": region,
        }
    )
    inside, outside = [0.5 + 0.5j], [0.5 + 0.5j, 2.0 + 0.5j]
    assert all(check.passed for check in check_constraints(demands, sound, inside, inside))
    broken = {
        "transmission_angle": (sound._replace(min_transmission_angle=29.0), inside, inside),
        "grashof": (sound._replace(grashof=None), inside, inside),
        "full_rotation": (sound._replace(full_rotation=False), inside, inside),
        "same_branch": (sound._replace(same_branch=False), inside, inside),
        "visits_in_order": (sound._replace(visits_in_order=False), inside, inside),
        "shortest_link": (sound._replace(lengths=[0.4, 3.0]), inside, inside),
        "longest_link": (sound._replace(lengths=[1.0, 4.1]), inside, inside),
        "link_ratio": (sound._replace(link_ratio=5.1), inside, inside),
        "fixed_pivot_region": (sound, outside, inside),
        "moving_pivot_region": (sound, inside, outside),
    }
    assert set(broken) == {check.name for check in check_constraints(demands, sound, inside, inside)}
    for name, (measures, fixed, moving) in broken.items():
        checks = check_constraints(demands, measures, fixed, moving)
        assert [check.name for check in checks if not check.passed] == [name]
