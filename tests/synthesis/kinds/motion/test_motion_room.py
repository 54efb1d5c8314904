"""Positions with tolerances in a room: slopes of margins, where a motion ends, and planted tasks held by shapely."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from kinematics.arrays import Real
from synthesis.dispatch import solve
from synthesis.fit.workspace_margins import count_margins
from synthesis.kinds.motion.constrained.clearance_residuals import CHART_SIZE, ENDS, compute_chart
from synthesis.kinds.motion.constrained.fit import (
    ConstrainedFit,
    make_constrained_fit,
    make_target_rows,
    measure_workspace_margins,
    pack_task_workspace,
    verify_fit,
)
from synthesis.kinds.motion.constrained.residuals import (
    ASSEMBLY,
    FIXED_RESIDUAL_COUNT,
    STEPS,
    count_pose_margins,
    evaluate_rows,
)
from synthesis.kinds.motion.constrained.workspace_starts import list_workspace_starts
from synthesis.kinds.motion.dyads.candidates import find_side_dyads
from synthesis.kinds.motion.exact import slider_cranks
from synthesis.kinds.motion.exact.clearance_filter import check_slider_clearance
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.pivot_regions import list_side_areas
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.kinds.motion.verification.verify import make_target_poses, verify
from synthesis.registry import parse_problem
from synthesis.verification.shared_constraints import check_workspace_of_design
from tests.campaign import further
from tests.support.fit import sliders
from tests.support.fit.motion import GROUPS, statement
from tests.support.fit.task import generator
from tests.support.fit.verdict import violations

POSITIONS = [
    {"x": 0.0, "y": 0.0, "angle": 0.0},
    {"x": 60.0, "y": 50.0, "angle": 25.0, "tolerance": {"x": 12.0, "y": 12.0, "angle": 8.0}},
    {"x": 90.0, "y": 130.0, "angle": 60.0, "tolerance": {"x": 12.0, "y": 12.0, "angle": 8.0}},
]

SPACE: dict[str, Any] = {
    "fixed_pivots": {"input": {"circle": {"center": [-60, 80], "radius": 30}}},
    "moving_pivots": {"output": {"polygon": [[-80, -60], [0, -60], [0, 20], [-80, 20]], "frame": "body"}},
    "box": [[-160, -90], [150, 190]],
    "body": {"outline": [[-10, -40], [10, -40], [10, 40], [-10, 40]]},
    "obstacles": [{"circle": {"center": [0, 120], "radius": 40}}, {"polygon": [[60, -60], [140, -60], [140, 20]]}],
    "clearance": 4.0,
    "link_width": 8.0,
}


def begun_in_room(over: str) -> tuple[MotionProblem, MotionTask, Real, list[ConstrainedFit]]:
    """Linkages that are to be steered into the room above."""
    stated = {"kind": "motion", "positions": POSITIONS, "space": {**SPACE, "over": over}}
    problem = parse_problem(stated)
    assert isinstance(problem, MotionProblem)
    task = make_motion_task(problem)
    rows, room = make_target_rows(problem, task), pack_task_workspace(problem, task)
    listed, scores = list_workspace_starts(problem, task, rows)
    assert len(listed) == len(scores) > 50
    assert list(scores) == sorted(scores, reverse=True)
    return problem, task, rows, [make_constrained_fit(problem, task, rows, start, room) for start in listed[:200:25]]


def evaluated(linkage: ConstrainedFit, x: Real, rows: Real) -> tuple[Real, Real, Real]:
    """All margins, and residuals and slopes of those of the room that bear a load."""
    n = len(rows)
    roomy = count_margins(linkage.setting[STEPS + n - 1 :])
    count = roomy + count_pose_margins(n)
    multipliers, state = np.zeros(count + 1), np.empty(count)
    multipliers[count] = 1.0
    residuals = np.zeros(len(x) + FIXED_RESIDUAL_COUNT + count)
    jacobian = np.zeros((len(residuals), len(x)))
    assert evaluate_rows(x, rows, linkage.setting, multipliers, state, residuals, jacobian) > 0
    first = len(x) - 8 + FIXED_RESIDUAL_COUNT
    loaded = int(np.count_nonzero(state[:roomy] < 0.0))
    return state[:roomy], residuals[first : first + loaded], jacobian[first : first + loaded]


@pytest.mark.parametrize(("over", "share"), [("used", 0.85), ("cycle", 0.7)])
def test_rows_of_a_room_have_the_slopes_of_differences(over: str, share: float) -> None:
    agreed = looked_at = 0
    _, _, rows, linkages = begun_in_room(over)
    for linkage in linkages:
        values, residuals, jacobian = evaluated(linkage, linkage.x, rows)
        loaded = np.flatnonzero(values < 0.0)
        assert residuals == pytest.approx(-values[loaded])
        differences = np.empty((len(loaded), len(linkage.x)))
        for i in range(len(linkage.x)):
            step = np.zeros(len(linkage.x))
            step[i] = 1e-6
            after, before = (evaluated(linkage, linkage.x + way * step, rows)[0] for way in (1.0, -1.0))
            differences[:, i] = (after[loaded] - before[loaded]) / 2e-6
        # The angle at a toggle, where a cycle may end, moves with the lengths; its slope is left out.
        agreed += int((np.abs(jacobian + differences).max(axis=1) < 1e-3).sum())
        looked_at += len(loaded)
    assert looked_at > 30
    # At a kink a difference is the slope of neither side.
    assert agreed > share * looked_at


def test_a_motion_ends_where_the_greatest_share_of_a_tolerance_is_least() -> None:
    problem, task, rows, linkages = begun_in_room("used")
    target, ended = make_target_poses(problem), 0
    for linkage in linkages:
        design = verify_fit(problem, task, rows, linkage.x, target)
        if design is None or isinstance(design, str) or not design.verification.passed:
            continue
        chart, beyond = np.empty(CHART_SIZE), np.full(2, np.nan)
        steps = linkage.setting[STEPS : STEPS + len(rows) - 1].copy()
        assert compute_chart(linkage.x, rows, linkage.setting[ASSEMBLY], steps, beyond, chart)
        mine = np.degrees(chart[ENDS : ENDS + 2] + chart[2])
        off = mine - np.array([design.targets[0].input_angle, design.targets[-1].input_angle])
        # A start meets its poses to first order only, and the drive goes by the finished linkage.
        assert np.abs(off - 360.0 * np.round(off / 360.0)).max() < 1.0
        ended += 1
    assert ended > 2


@pytest.mark.slow
def test_what_lacks_nothing_of_the_room_is_found_to_fit() -> None:
    """The least margin of a finished linkage says what the sweep says, but for the narrow aim."""
    stated = {**statement(generator(1, 6), *GROUPS[6]), "max_designs": 2}
    problem = parse_problem(stated)
    assert isinstance(problem, MotionProblem)
    task = make_motion_task(problem)
    rows, room = make_target_rows(problem, task), pack_task_workspace(problem, task)
    listed, _ = list_workspace_starts(problem, task, rows)
    linkages = [make_constrained_fit(problem, task, rows, start, room) for start in listed[:40]]
    left = measure_workspace_margins(linkages, rows, room)
    assert np.isfinite(left).sum() > 20
    assert (left < 0.0).sum() > 10
    assert np.isinf(measure_workspace_margins(linkages, rows, np.zeros(0))).all()


@pytest.mark.slow
@pytest.mark.parametrize("number", further(range(4, 27), [8]))
def test_a_planted_motion_is_answered_in_its_room(number: int) -> None:
    stated = {**statement(generator(1, number), *GROUPS[number % len(GROUPS)]), "max_designs": 2}
    result = solve(parse_problem(stated))
    passed = [design for design in result.designs if design.verification.passed]
    assert passed
    assert result.search.candidates == result.search.accepted + sum(result.search.rejected.values())
    for design in passed:
        assert violations(stated, design) == []
    assert math.isfinite(passed[0].metrics.quality)


@pytest.mark.slow
@pytest.mark.parametrize("number", further(range(3, 30), [3]))
def test_a_planted_slider_crank_is_answered_in_its_room(number: int) -> None:
    """Exact positions, of which the best slider-cranks without the room all meet what is in the way."""
    stated = sliders.statement(generator(1, number), sliders.GROUPS[number % len(sliders.GROUPS)])
    result = solve(parse_problem(stated))
    passed = [design for design in result.designs if design.verification.passed]
    assert passed
    assert result.search.candidates == result.search.accepted + sum(result.search.rejected.values())
    for design in passed:
        assert "B" in {slide.joint for slide in design.mechanism.skeleton.slides}
        assert violations(stated, design) == []


@pytest.mark.slow
@pytest.mark.parametrize("over", further(["used", "cycle"], ["cycle"]))
def test_slider_cranks_that_are_left_out_of_a_room_would_fail_in_it(over: str) -> None:
    """The sweep says so too, and of the others that some fit."""
    stated = sliders.statement(generator(1, 3), 2)
    first = stated["positions"][0]
    post = {"circle": {"center": [first["x"] + 400.0, first["y"]], "radius": 150.0}}
    stated["space"] = {"obstacles": [post], "link_width": 8.0, "over": over}
    problem = parse_problem(stated)
    assert isinstance(problem, MotionProblem)
    task, rng = make_motion_task(problem), np.random.default_rng(5)
    lines = slider_cranks.find_sliders(task, problem.output_side, inverted=False, rng=rng, count=40)
    links = find_side_dyads(task, problem, 0, list_side_areas(problem)[0], rng, 40).dyads
    screened = slider_cranks._screen(problem, task, links, lines, "PR", False, 30.0)
    i, j = (some[::7][:60] for some in np.nonzero(screened.score))
    joints = np.stack([links.fixed[i], links.moving[i], lines.points[j]], axis=1)
    fit = check_slider_clearance(problem, task, joints, lines.angles[j])
    told = []
    for n in range(len(fit)):
        pair = int(i[n]), int(j[n])
        design = verify(problem, slider_cranks._build_mechanism(problem, task, links, lines, "PR", False, *pair))
        assert design is not None
        judged = check_workspace_of_design(problem, design)
        assert judged is not None
        checks = {check.name: check.passed for check in judged.verification.checks}
        told.append(checks["obstacles"])
    assert not np.any(np.array(told) & ~fit)
    assert 0 < np.count_nonzero(fit) < len(fit)
    assert np.count_nonzero(told) >= 0.6 * np.count_nonzero(fit)
