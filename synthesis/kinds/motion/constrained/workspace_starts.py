"""Starting pairs of dyads for constrained fits in a workspace, sampled in the permitted areas of their pivots.

A dyad that meets its poses within tolerances has a link of constant length l. With u the link's direction in a pose,
the deviations (x, y, angle), in units of their tolerances t, change its length by

    u_x t_x δ_x + u_y t_y δ_y + Re(ū i e^{iα} arm) t_α δ_α = σ |δ|        at most,

so |(|A_k − O| − l)/σ_k| is the minimum deviation that meets pose k. Dyads are sampled in the zones and moved, all at
once and as little as possible, to minimise the sum of the squared deviations by the Gauss-Newton method. All pairs of
the remaining dyads are screened at the target poses. The starts of the best pairs use the minimum deviations that both
links need together; pairs that need small deviations come first.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.constrained.starts import (
    ANGLE_RELAXATION,
    MAX_DISTANCE,
    Start,
    relax_constraints,
    sample_pivots,
)
from synthesis.kinds.motion.dyads.equations import Dyads
from synthesis.kinds.motion.exact.screening import make_screening_constraints, screen
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices
from synthesis.kinds.motion.task.pivot_regions import SideAreas, list_side_areas, measure_outside_distance
from synthesis.kinds.motion.task.positions import MotionTask

SAMPLE_COUNT = 6000
"""Number of sampled dyads per side."""

MAX_DYADS = 500
"""Maximum number of dyads per side that are paired."""

STEP_COUNT = 5
"""Number of Gauss–Newton steps that fit dyads to the poses."""

EXACT_SIGMA = 1e-3
"""σ of an exact pose, task sizes; the later fit meets it to rounding."""

PIVOT_SIGMA = 0.1
"""Displacement of a pivot from its sampled position, task sizes, that weighs as much as one tolerance."""

HALF_WEIGHT_DISTANCE = 0.03
"""Distance from its zone, task sizes, at which the weight of a pivot is halved."""

MAX_DEVIATION = 1.5
"""Maximum deviation of a pose, in tolerances, that a single dyad may need."""

ORDER_DEFECT_WEIGHT = 0.3
"""Weight of a pair that does not meet the target poses in order."""

POOL_SIZE = 1000
"""Number of best pairs from which starts are selected."""


class _SideDyads(NamedTuple):
    """Dyads of one side with the body in its first target pose, and their weights by zones and needed deviations."""

    dyads: Dyads
    weight: Real


def list_workspace_starts(problem: MotionProblem, task: MotionTask, rows: Real) -> tuple[list[Start], Real]:
    """Return starts and their scores, best first.

    Parameters
    ----------
    problem : MotionProblem
        A problem with a workspace.
    task : MotionTask
        The target poses.
    rows : float, shape (n, 6)
        Result of :func:`synthesis.kinds.motion.constrained.fit.make_target_rows`.
    """
    rng = np.random.default_rng(problem.seed)
    sides, areas = (problem.input_side, problem.output_side), list_side_areas(problem)
    one, other = (_sample_side(task, rows, sides[k], areas[k], rng) for k in (0, 1))
    if not len(one.dyads.fixed) or not len(other.dyads.fixed):
        return [], np.empty(0)
    least = problem.constraints.min_transmission_angle or 0.0
    # Relaxed, because the fit can improve a start that narrowly violates a limit.
    constraints = make_screening_constraints(
        relax_constraints(problem.constraints), task, ANGLE_RELAXATION * least, problem.rank_by
    )
    met = screen(task, one.dyads, other.dyads, constraints).score
    score = met * np.outer(one.weight, other.weight)
    if np.count_nonzero(met) < POOL_SIZE:
        # Poses that lie close together may come into order by deviations: include such pairs at a lower weight.
        any_order = screen(task, one.dyads, other.dyads, constraints._replace(in_order=False)).score
        score = np.where(met > 0.0, score, ORDER_DEFECT_WEIGHT * any_order * np.outer(one.weight, other.weight))
    best = np.argpartition(-score, min(POOL_SIZE, score.size - 1), axis=None)[:POOL_SIZE]
    best = best[score.ravel()[best] > 0.0]
    i, j = np.unravel_index(best, score.shape)
    pivots = np.stack([one.dyads.fixed[i], other.dyads.fixed[j], one.dyads.moving[i], other.dyads.moving[j]], axis=1)
    deviations = _compute_min_deviations(rows, pivots, task.points[0])
    far = np.abs(deviations).max(axis=(1, 2))
    # Deviations within the tolerances cost nothing; larger ones must be removed by the fit.
    value = score.ravel()[best] / np.maximum(far, 1.0) ** 2
    # A start must lie within the tolerances itself.
    shares = np.clip(deviations, -1.0, 1.0)
    order = np.argsort(-value, kind="stable")
    poses = rows[:, :3] + shares * rows[:, 3:]
    return [Start(pivots[k], shares[k], poses[k]) for k in order], value[order]


def _sample_side(
    task: MotionTask, rows: Real, choices: DyadChoices, areas: SideAreas, rng: np.random.Generator
) -> _SideDyads:
    """Sample the dyads of one side that need the smallest deviations, in their zones or near them."""
    fixed, moving, free = sample_pivots(task, choices, areas, rng, SAMPLE_COUNT)
    fixed, moving, needed = _fit_dyads(rows, fixed, moving, task.points[0], free)
    reach = np.maximum(np.abs(fixed), np.abs(moving))
    astray = measure_outside_distance(task, areas.fixed, fixed) + measure_outside_distance(task, areas.moving, moving)
    # Both factors are 1 for a dyad in its zones that needs no more than its tolerances.
    weight = 1.0 / (1.0 + (astray / HALF_WEIGHT_DISTANCE) ** 2) / np.maximum(needed, 1.0) ** 2
    sound = (needed <= MAX_DEVIATION) & (reach < MAX_DISTANCE) & np.isfinite(reach)
    order = np.argsort(-np.where(sound, weight, 0.0), kind="stable")[:MAX_DYADS]
    order = order[sound[order]]
    return _SideDyads(Dyads(fixed[order].copy(), moving[order].copy()), weight[order])


class _Links(NamedTuple):
    """Links of dyads in all poses, shape (m, n): vectors, lengths, and derivatives by the deviations (…, 3)."""

    vectors: Complex
    lengths: Real
    by_deviation: Real


def _compute_links(rows: Real, fixed: Complex, moving: Complex, home: complex) -> _Links:
    places, spins = rows[:, 0] + 1j * rows[:, 1], np.exp(1j * rows[:, 2])
    arms = spins * (moving[:, None] - home)
    vectors = places + arms - fixed[:, None]
    lengths = np.maximum(np.abs(vectors), np.finfo(np.float64).tiny)
    units = vectors / lengths
    by_deviation = np.stack([units.real, units.imag, (units.conj() * 1j * arms).real], axis=-1) * rows[:, 3:]
    return _Links(vectors, lengths, by_deviation)


def _fit_dyads(rows: Real, fixed: Complex, moving: Complex, home: complex, free: Real) -> tuple[Complex, Complex, Real]:
    """Move dyads to minimise their needed deviations; also return the maximum deviation over the poses of each.

    ``free`` is 1 for the coordinates of both pivots that may change, else 0; shape (4,).
    """
    spins = np.exp(1j * rows[:, 2])
    drawn = np.stack([fixed.real, fixed.imag, moving.real, moving.imag], axis=1)
    # The first guess of the link's length: its mean over the poses.
    length = np.abs(_compute_links(rows, fixed, moving, home).vectors).mean(axis=1)
    for step in range(STEP_COUNT + 1):
        links = _compute_links(rows, fixed, moving, home)
        # Standard deviation of the length for unit deviations; exact poses have a small one instead of 0.
        sigma = np.hypot(np.linalg.norm(links.by_deviation, axis=-1), EXACT_SIGMA)
        off = (links.lengths - length[:, None]) / sigma
        if step == STEP_COUNT:
            break
        units = links.vectors / links.lengths
        turned = units * np.conj(spins)
        columns = [-units.real * free[0], -units.imag * free[1], turned.real * free[2], turned.imag * free[3]]
        jacobian = np.stack([*columns, -np.ones_like(off)], axis=-1) / sigma[..., None]
        here = np.stack([fixed.real, fixed.imag, moving.real, moving.imag, np.zeros(len(fixed))], axis=1)
        square = jacobian.swapaxes(-1, -2) @ jacobian
        # A prior keeps the pivots near their samples; the link length, the last unknown, is free.
        pulled = np.array([PIVOT_SIGMA, PIVOT_SIGMA, PIVOT_SIGMA, PIVOT_SIGMA, np.inf]) ** -2
        right = -(jacobian.swapaxes(-1, -2) @ off[..., None])[..., 0]
        right[:, :4] -= (here[:, :4] - drawn) * pulled[:4]
        square += np.diag(pulled)
        move = np.linalg.solve(square, right[..., None])[..., 0]
        # At most one task size per step, as the linearization is not valid farther away.
        move /= np.maximum(np.linalg.norm(move[:, :4], axis=1, keepdims=True), 1.0)
        fixed = fixed + (move[:, 0] * free[0] + 1j * move[:, 1] * free[1])
        moving = moving + (move[:, 2] * free[2] + 1j * move[:, 3] * free[3])
        length = length + move[:, 4]
    return fixed, moving, np.abs(off).max(axis=1)


def _compute_min_deviations(rows: Real, pivots: Complex, home: complex) -> Real:
    """Return the minimum deviations, in tolerances, at which both links of pairs have constant length: (m, n, 3)."""
    links = [_compute_links(rows, pivots[:, k], pivots[:, k + 2], home) for k in (0, 1)]
    weights = [1.0 / np.hypot(np.linalg.norm(one.by_deviation, axis=-1), EXACT_SIGMA) ** 2 for one in links]
    off = np.stack(
        # The weighted mean is the length with the smallest deviations.
        [
            one.lengths - ((weight * one.lengths).sum(axis=1) / weight.sum(axis=1))[:, None]
            for one, weight in zip(links, weights, strict=True)
        ],
        axis=-1,
    )
    by = np.stack([one.by_deviation for one in links], axis=-2)
    # A small ridge keeps exact poses, whose derivatives are 0, solvable.
    square = by @ by.swapaxes(-1, -2) + EXACT_SIGMA**2 * np.eye(2)
    return np.asarray(-(by.swapaxes(-1, -2) @ np.linalg.solve(square, off[..., None]))[..., 0])
