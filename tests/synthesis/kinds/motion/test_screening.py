"""The screening kernel against a plain twin that drives every pair with the analysis core."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from synthesis.kinds.motion.dyads.candidates import find_side_dyads
from synthesis.kinds.motion.exact.screening import REASONS, make_screening_constraints, screen
from synthesis.kinds.motion.task.pivot_regions import list_side_areas
from synthesis.kinds.motion.task.positions import make_motion_task
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.registry import parse_problem
from synthesis.results.ranking import select_distinct
from synthesis.verification.measures import compute_quality
from tests.support.synthesis.planted import plant
from tests.support.synthesis.screening import excess_of

BY_CHECK = {
    "longest_link": "link_length",
    "shortest_link": "link_length",
    "same_circuit": "circuit_defect",
    "same_branch": "branch_defect",
    "visits_in_order": "order_defect",
}
IN_KERNEL_ORDER = (
    "shortest_link",
    "longest_link",
    "link_ratio",
    "grashof",
    "full_rotation",
    "same_circuit",
    "same_branch",
    "visits_in_order",
    "transmission_angle",
)


@pytest.mark.campaign
@pytest.mark.parametrize(
    ("n", "constraints"),
    [
        (2, {}),
        (3, {}),
        (3, {"min_transmission_angle": 40.0}),
        (3, {"grashof": "crank_rocker"}),
        (3, {"grashof": "non_grashof", "max_link_ratio": 5.0}),
        (3, {"grashof": "double_rocker"}),
        (2, {"full_rotation": True, "link_length": {"min": 1.0, "max": 30.0}}),
        (3, {"in_order": False}),
    ],
)
def test_verdicts_agree_with_the_analysis_core(n: int, constraints: dict[str, Any]) -> None:
    rng = np.random.default_rng(n)
    compared = sound = 0
    for trial in range(2):
        planted = plant(rng, n, 5.0)
        problem = parse_problem({"kind": "motion", "positions": planted.positions, "constraints": constraints})
        task = make_motion_task(problem)
        one, other = (
            find_side_dyads(
                task, problem, 0, list_side_areas(problem)[0], np.random.default_rng(10 * trial + k), 16
            ).dyads
            for k in (0, 1)
        )
        screening = screen(
            task,
            one,
            other,
            make_screening_constraints(problem.constraints, task, constraints.get("min_transmission_angle", 0)),
        )
        for i in range(len(one.fixed)):
            for j in range(len(other.fixed)):
                joints = [complex(z) for z in (one.fixed[i], one.moving[i], other.moving[j], other.fixed[j])]
                if np.abs(np.diff([*joints, joints[0]])).min() < 1e-3:
                    continue
                problem_joints = (task.to_problem(z) for z in joints)
                design = verify(problem, build_fourbar(FourbarConfiguration(*problem_joints, task.origin)))
                assert design is not None
                failed = [c.name for c in design.verification.checks if not c.passed]
                first = next((name for name in IN_KERNEL_ORDER if name in failed), None)
                expected = "sound" if first is None else BY_CHECK.get(first, first)
                found = REASONS[screening.verdict[i, j]]
                if found == "order_defect":
                    # The input dyad alone may decide it, before anything else that is wrong with the pair.
                    assert not design.metrics.visits_in_order
                else:
                    assert found == expected, (i, j, failed)
                compared += 1
                if found == "sound":
                    sound += 1
                    # What the body travels and turns is measured of designs only.
                    measured = design.metrics.quality * (1.0 + excess_of(design, planted.positions, task.size) ** 2)
                    assert screening.score[i, j] == pytest.approx(measured, rel=1e-3)
    assert compared > 200
    assert sound > 10


def test_quality_rises_with_transmission_and_falls_with_size_and_ratio() -> None:
    assert compute_quality(1.0, 0.0, 1.0) == pytest.approx(64.0 / 65.0)
    assert compute_quality(0.5, 1.0, 2.0) == pytest.approx(compute_quality(1.0, 1.0, 2.0) / 2.0)
    assert compute_quality(1.0, 3.0, 1.0) == pytest.approx(compute_quality(1.0, 0.0, 1.0) / 2.0)
    assert compute_quality(1.0, 1.0, 8.0) < compute_quality(1.0, 1.0, 4.0)


def test_distinct_choice_keeps_the_best_of_each_neighbourhood() -> None:
    joints = np.array([[0.0], [0.1], [1.0], [1.05], [5.0]], np.complex128)
    assert select_distinct(joints, 10, 0.5) == [0, 2, 4]
    assert select_distinct(joints, 2, 0.5) == [0, 2]
    assert select_distinct(joints, 10, 0.01) == [0, 1, 2, 3, 4]
    assert select_distinct(joints[:0], 3, 1.0) == []
