"""Descents of sixbars that hold their branch: their rates, and that what arrives does so on one branch, in order."""

from __future__ import annotations

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.motion.sixbar import residuals as rows
from synthesis.kinds.motion.sixbar.dyad_assembly import O4, Q1, Q2, TOPOLOGY_LINKS, A, B, J, compute_signed_sine
from synthesis.registry import parse_problem
from tests.support.sixbars.motion import SIXBARS, anyhow, false_claim, sound, within_a_box

INF = np.inf
LIMITS = {
    "positions": {},
    "angles": {rows.COSINE: 0.6},
    "sizes": {rows.REACH: 1.5, rows.SHORTEST: 0.7, rows.LONGEST: 1.4, rows.RATIO: 1.5},
    "pivots": {n: (-0.5, 0.5)[n % 2 == 0] for n in range(rows.FIXED_BOX.start, rows.JOINT_BOX.start)},
    "room": {n: (-0.5, 0.5)[n % 2 == 0] for n in range(rows.JOINT_BOX.start, rows.JOINT_BOX.stop)},
}
LIMITS["first pose"] = LIMITS["sizes"] | LIMITS["room"] | {rows.TARGET_X: 0.3, rows.TARGET_Y: -0.2}


def drawn(rng: np.random.Generator, make: int, limits: dict[int, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unknowns, later positions (some with tolerances) and a setting."""
    x = rng.normal(size=rows.JOINT_COORDINATE_COUNT + 4)
    x[rows.JOINT_COORDINATE_COUNT :] = np.log(rng.uniform(0.1, 0.5, 4))
    z = x[: rows.JOINT_COORDINATE_COUNT].view(complex)
    setting = np.array([INF if n % 2 == 0 else -INF for n in range(rows.SETTING.size)])
    setting[: rows.FIXED_BOX.start] = make, 1.0, 0.0, 0.0, 1.0, INF, 0.0, INF, INF, 0.1, 0.2
    setting[[rows.FIRST_SIDE, rows.SECOND_SIDE]] = np.sign(
        [compute_signed_sine(z[A], z[O4], z[B]), compute_signed_sine(z[Q1], z[Q2], z[J])]
    )
    for place, limit in limits.items():
        setting[place] = limit
    later = np.column_stack([rng.normal(size=(4, 3)), rng.choice([0.0, 0.1], (4, 3)), rng.uniform(0.1, 2.0, (4, 2))])
    if rows.TARGET_X in limits:
        x = np.concatenate([x, rng.normal(size=rows.FREE_POSE_SIZE)])
    return x, later, setting


@pytest.mark.parametrize("limited", LIMITS)
def test_rates_are_those_of_differences(limited):
    rng = np.random.default_rng(3)
    most, met = rows.count_max_rows(5), 0
    for n in range(400):
        x, later, setting = drawn(rng, n % len(TOPOLOGY_LINKS), LIMITS[limited])
        values, jacobian = np.zeros(most), np.zeros((most, x.size))
        count = rows.evaluate_residuals(x, later, setting, values, jacobian)
        if count < 0:
            continue
        step, ends = 1e-6, []
        for sense in (1.0, -1.0):
            for k in range(x.size):
                moved, there = x.copy(), np.zeros(most)
                moved[k] += sense * step
                same = rows.evaluate_residuals(moved, later, setting, there, jacobian[:0]) == count
                ends.append(there if same else np.full(most, np.nan))
        differences = (np.array(ends[: x.size]) - np.array(ends[x.size :])).T[:count] / (2.0 * step)
        if np.isfinite(differences).all():
            met += 1
            assert np.abs(differences - jacobian[:count]).max() < 1e-6 * (1.0 + np.abs(jacobian[:count]).max())
    assert met > 30


@pytest.mark.slow
@pytest.mark.parametrize(("draw", "seed"), [pytest.param(within_a_box, 3, marks=pytest.mark.campaign), (anyhow, 1)])
def test_what_arrives_does_so_on_one_branch_in_order(draw, seed):
    task = draw(np.random.default_rng(seed))
    problem = parse_problem({"kind": "motion", "positions": task, "max_designs": 2, "mechanisms": SIXBARS})
    designs = sound(solve(problem))
    assert designs
    assert not [fault for design in designs if (fault := false_claim(design, task))]
