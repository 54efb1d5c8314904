"""Verification finds what is wrong with a mechanism: it is shown good ones, damaged ones and defective ones."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.linkage.answer import FourbarMechanism, LinkageDesign
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.registry import parse_problem
from tests.oracles.continuation import drive
from tests.support.synthesis.planted import Planted, plant


def problem_of(planted: Planted, **more: Any) -> MotionProblem:
    return parse_problem({"kind": "motion", "positions": planted.positions, **more})


def mechanism_of(planted: Planted) -> FourbarMechanism:
    one, other = planted.input_side, planted.output_side
    point = complex(planted.positions[0]["x"], planted.positions[0]["y"])
    return build_fourbar(
        FourbarConfiguration(one.fixed_pivot, one.moving_pivot, other.moving_pivot, other.fixed_pivot, point)
    )


def verified(problem: MotionProblem, mechanism: FourbarMechanism) -> LinkageDesign:
    design = verify(problem, mechanism)
    assert design is not None
    return design


def failed(design: LinkageDesign) -> set[str]:
    return {check.name for check in design.verification.checks if not check.passed}


def changed(mechanism: FourbarMechanism, part: str, **values: Any) -> FourbarMechanism:
    data = mechanism.model_dump()
    if part:
        data[part].update(values)
    else:
        data.update(values)
    return FourbarMechanism.model_validate(data)


@pytest.mark.slow
def test_planted_linkages_pass_with_the_right_input_angles() -> None:
    rng = np.random.default_rng(1)
    for _ in range(100):
        planted = plant(rng, int(rng.integers(2, 4)), 10.0 ** rng.uniform(-3.0, 3.0))
        design = verified(problem_of(planted), mechanism_of(planted))
        assert design.verification.passed
        start = design.mechanism.reference_input_angle
        turned = [target.input_angle - start for target in design.targets]
        assert turned == pytest.approx([0.0, *planted.input_side.rotations], abs=1e-7)


def test_the_skeleton_is_not_believed() -> None:
    rng = np.random.default_rng(2)
    planted = plant(rng, 3)
    mechanism = mechanism_of(planted)
    lying = changed(mechanism, "skeleton", joints=dict.fromkeys(("O2", "O4", "A", "B", "P"), (0.0, 0.0)))
    honest, other = verified(problem_of(planted), mechanism), verified(problem_of(planted), lying)
    assert honest.verification == other.verification
    assert honest.metrics == other.metrics


@pytest.mark.parametrize(
    ("part", "field", "change"),
    [
        ("links", "input", 1e-6),
        ("links", "coupler", 1e-6),
        ("links", "output", 1e-6),
        ("coupler_point", "distance", 1e-6),
        ("coupler_point", "angle", 1e-4),
        ("", "reference_input_angle", 1e-4),
    ],
)
def test_a_wrong_dimension_is_found(part: str, field: str, change: float) -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        planted = plant(rng, 3)
        mechanism = mechanism_of(planted)
        data = mechanism.model_dump()
        value = (data[part] if part else data)[field]
        design = verify(problem_of(planted), changed(mechanism, part, **{field: value * (1.0 + change) + change}))
        assert design is None or "reaches_targets" in failed(design)


def test_the_wrong_assembly_is_found() -> None:
    rng = np.random.default_rng(4)
    for _ in range(20):
        planted = plant(rng, 3)
        mechanism = mechanism_of(planted)
        other = "crossed" if mechanism.assembly == "open" else "open"
        design = verify(problem_of(planted), changed(mechanism, "", assembly=other))
        assert design is None or not design.verification.passed


def test_moved_pivot_is_found() -> None:
    rng = np.random.default_rng(5)
    planted = plant(rng, 3)
    mechanism = mechanism_of(planted)
    x, y = mechanism.fixed_pivots.output
    design = verify(problem_of(planted), changed(mechanism, "fixed_pivots", output=(x + 1e-6, y)))
    assert design is None or "reaches_targets" in failed(design)


@pytest.mark.campaign
def test_every_defect_by_independent_continuation() -> None:
    """Random pairs of dyads: circuit, branch, order and transmission are as the continuation finds them."""
    from synthesis.kinds.motion.dyads.candidates import find_side_dyads
    from synthesis.kinds.motion.task.pivot_regions import list_side_areas
    from synthesis.kinds.motion.task.positions import make_motion_task

    rng = np.random.default_rng(6)
    seen: dict[tuple[bool, bool, bool], int] = {}
    for trial in range(12):
        planted = plant(rng, 3, 10.0)
        problem = problem_of(planted)
        task = make_motion_task(problem)
        areas = list_side_areas(problem)
        sides = [
            find_side_dyads(task, problem, k, areas[k], np.random.default_rng(trial + 100 * k), 40).dyads
            for k in (0, 1)
        ]
        designs = []
        for i in range(min(len(sides[0].fixed), len(sides[1].fixed))):
            joints = [
                task.to_problem(complex(z[i]))
                for z in (sides[0].fixed, sides[0].moving, sides[1].moving, sides[1].fixed)
            ]
            lengths = [abs(joints[k] - joints[k - 1]) for k in range(4)]
            if min(lengths) > 0.02 * max(lengths):
                design = verify(problem, build_fourbar(FourbarConfiguration(*joints, task.origin)))
                if design is not None and abs(excess(lengths)) > 1e-4 * sum(lengths):
                    designs.append(design)
        found = drive([design.mechanism.model_dump() for design in designs], planted.positions)
        for design, truth in zip(designs, found, strict=True):
            check = {c.name: c.passed for c in design.verification.checks}
            assert check["reaches_targets"]
            assert check["same_circuit"] == truth.same_circuit
            assert check["same_branch"] == truth.same_branch
            if truth.same_branch:
                assert check["visits_in_order"] == truth.in_order
                least = design.metrics.min_transmission_angle
                if truth.in_order:
                    # The continuation samples the sine; the verification knows its least value.
                    assert least <= math.degrees(truth.least_transmission) + 1e-6
            key = (truth.same_circuit, truth.same_branch, truth.in_order)
            seen[key] = seen.get(key, 0) + 1
    assert seen[(True, True, True)] > 20
    assert seen[(True, False, True)] + seen.get((True, False, False), 0) > 20
    assert sum(count for key, count in seen.items() if not key[0]) > 20


def excess(lengths: list[float]) -> float:
    ordered = sorted(lengths)
    return ordered[0] + ordered[3] - ordered[1] - ordered[2]


@pytest.mark.parametrize(
    ("constraints", "name"),
    [
        ({"min_transmission_angle": 89.0}, "transmission_angle"),
        ({"max_link_ratio": 1.01}, "link_ratio"),
        ({"link_length": {"max": 1e-3}}, "longest_link"),
        ({"link_length": {"min": 1e3}}, "shortest_link"),
        ({"fixed_pivot_region": {"x": [1e3, 1e4], "y": [1e3, 1e4]}}, "fixed_pivot_region"),
        ({"moving_pivot_region": {"x": [1e3, 1e4], "y": [1e3, 1e4]}}, "moving_pivot_region"),
    ],
)
def test_broken_limits_fail_their_check_and_are_returned_on_demand(constraints: dict[str, Any], name: str) -> None:
    planted = plant(np.random.default_rng(8), 3)
    statement = {
        "constraints": constraints,
        "input_side": planted.input_side.choices("b2", "b3"),
        "output_side": planted.output_side.choices("b2", "b3"),
    }
    quiet = solve(problem_of(planted, **statement), lambda fraction, message: None)
    assert quiet.designs == []
    assert quiet.search.complete
    assert sum(quiet.search.rejected.values()) == 1
    shown = solve(problem_of(planted, **statement, include_failed=True), lambda fraction, message: None)
    assert failed(shown.designs[0]) == {name}
    assert not shown.designs[0].verification.passed


def test_choices_that_are_not_kept_are_found() -> None:
    planted = plant(np.random.default_rng(9), 3)
    mechanism = mechanism_of(planted)
    for names in (("fixed",), ("moving",), ("b2", "b3"), ("theta", "z"), ("z", "phi")):
        kept = problem_of(planted, input_side=planted.input_side.choices(*names))
        assert verified(kept, mechanism).verification.passed
        other = problem_of(planted, input_side=planted.output_side.choices(*names))
        assert failed(verified(other, mechanism)) == {"input_side"}


def test_demands_of_the_motion_can_be_dropped() -> None:
    """A linkage with a branch defect fails by default and is reported as a metric when the client drops the demand."""
    from synthesis.kinds.motion.dyads.candidates import find_side_dyads
    from synthesis.kinds.motion.task.pivot_regions import list_side_areas
    from synthesis.kinds.motion.task.positions import make_motion_task

    rng = np.random.default_rng(10)
    planted = plant(rng, 3)
    problem = problem_of(planted)
    relaxed = problem_of(planted, constraints={"same_branch": False, "in_order": False})
    task, areas = make_motion_task(problem), list_side_areas(problem)
    one, other = (find_side_dyads(task, problem, 0, areas[0], np.random.default_rng(k), 60) for k in (0, 1))
    found = 0
    for i in range(50):
        joints = [complex(z[i]) for z in (one.dyads.fixed, one.dyads.moving, other.dyads.moving, other.dyads.fixed)]
        mechanism = build_fourbar(FourbarConfiguration(*(task.to_problem(z) for z in joints), task.origin))
        strict, loose = verify(problem, mechanism), verify(relaxed, mechanism)
        if strict is None or loose is None or "same_circuit" in failed(strict) or not failed(strict):
            continue
        found += 1
        assert loose.verification.passed
        assert not (loose.metrics.same_branch and loose.metrics.visits_in_order)
    assert found > 3
