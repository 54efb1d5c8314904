"""Pairs of dyads from which linkages are steered into a room: drawn where their pivots may lie.

A dyad that meets its poses but for deviations has a link of one length l. With u the link's direction in a pose, the
deviations (x, y, angle), in units of their tolerances t, change its length by

    u_x t_x δ_x + u_y t_y δ_y + Re(ū i e^{iα} arm) t_α δ_α = σ |δ|        at most,

so that (|A_k − O| − l)/σ_k is the least deviation with which pose k is met. Dyads are drawn in the zones and moved
least to where the squares of these are least, all at once, by Gauss and Newton's method. All pairs of what is left are
screened at the demanded poses; of the best, the least deviations that both links need together are those to start from,
and those that lack least of the room come first.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from synthesis.kinds.motion.areas import SideAreas, outside, side_areas
from synthesis.kinds.motion.dyads import Dyads
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.screening import demands, screen
from synthesis.kinds.motion.stated_dyads import DyadChoices
from synthesis.kinds.motion.steered_starts import EASED_ANGLE, FARTHEST, Start, drawn_pivots, eased
from synthesis.kinds.motion.task import Complex, MotionTask, Real

DRAWN = 6000
"""Dyads of a side that are drawn."""

KEPT = 500
"""Dyads of a side of which pairs are made."""

STEPS = 5
"""Gauss–Newton steps that bring dyads to the poses."""

HELD = 1e-3
"""σ of a pose that is held, task sizes: it is met to rounding later."""

FREE = 0.1
"""Way of a pivot from where it was drawn, task sizes, that counts as much as one tolerance."""

ASTRAY = 0.03
"""Distance from its zone, task sizes, at which a pivot counts half."""

NEEDED = 1.5
"""Deviation of a pose, in tolerances, that a dyad may need by itself."""

OUT_OF_ORDER = 0.3
"""How much a pair counts that does not meet the demanded poses in order."""

POOL = 1000
"""Best pairs of which starts are chosen."""


class _Side(NamedTuple):
    """Dyads of one side, the body in its first demanded pose, and how they weigh by their zones and what they need."""

    dyads: Dyads
    weight: Real


def pairs_in_room(problem: MotionProblem, task: MotionTask, rows: Real) -> tuple[list[Start], Real]:
    """Starts, and their scores, those first that score best.

    Parameters
    ----------
    problem : MotionProblem
        With a room.
    task : MotionTask
        The demanded poses.
    rows : float, shape (n, 6)
        Of :func:`synthesis.kinds.motion.steered_fit.demanded_rows`.
    """
    rng = np.random.default_rng(problem.seed)
    sides, areas = (problem.input_side, problem.output_side), side_areas(problem)
    one, other = (_side(task, rows, sides[k], areas[k], rng) for k in (0, 1))
    if not len(one.dyads.fixed) or not len(other.dyads.fixed):
        return [], np.empty(0)
    least = problem.constraints.min_transmission_angle or 0.0
    wanted = demands(eased(problem.constraints), task, EASED_ANGLE * least, problem.rank_by)
    met = screen(task, one.dyads, other.dyads, wanted).score
    score = met * np.outer(one.weight, other.weight)
    if np.count_nonzero(met) < POOL:
        # Deviations may bring poses that lie close together into order.
        any_order = screen(task, one.dyads, other.dyads, wanted._replace(in_order=False)).score
        score = np.where(met > 0.0, score, OUT_OF_ORDER * any_order * np.outer(one.weight, other.weight))
    best = np.argpartition(-score, min(POOL, score.size - 1), axis=None)[:POOL]
    best = best[score.ravel()[best] > 0.0]
    i, j = np.unravel_index(best, score.shape)
    pivots = np.stack([one.dyads.fixed[i], other.dyads.fixed[j], one.dyads.moving[i], other.dyads.moving[j]], axis=1)
    deviations = _needed(rows, pivots, task.points[0])
    far = np.abs(deviations).max(axis=(1, 2))
    value = score.ravel()[best] / np.maximum(far, 1.0) ** 2
    shares = np.clip(deviations, -1.0, 1.0)
    order = np.argsort(-value, kind="stable")
    poses = rows[:, :3] + shares * rows[:, 3:]
    return [Start(pivots[k], shares[k], poses[k]) for k in order], value[order]


def _side(task: MotionTask, rows: Real, choices: DyadChoices, areas: SideAreas, rng: np.random.Generator) -> _Side:
    """The dyads of one side that need least, in their zones or near to them."""
    fixed, moving, free = drawn_pivots(task, choices, areas, rng, DRAWN)
    fixed, moving, needed = _brought(rows, fixed, moving, task.points[0], free)
    reach = np.maximum(np.abs(fixed), np.abs(moving))
    astray = outside(task, areas.fixed, fixed) + outside(task, areas.moving, moving)
    weight = 1.0 / (1.0 + (astray / ASTRAY) ** 2) / np.maximum(needed, 1.0) ** 2
    sound = (needed <= NEEDED) & (reach < FARTHEST) & np.isfinite(reach)
    order = np.argsort(-np.where(sound, weight, 0.0), kind="stable")[:KEPT]
    order = order[sound[order]]
    return _Side(Dyads(fixed[order].copy(), moving[order].copy()), weight[order])


class _Links(NamedTuple):
    """Links of dyads in all poses, shape (m, n): their vectors, lengths, and what deviations change of these (…, 3)."""

    vectors: Complex
    lengths: Real
    by_deviation: Real


def _links(rows: Real, fixed: Complex, moving: Complex, home: complex) -> _Links:
    places, spins = rows[:, 0] + 1j * rows[:, 1], np.exp(1j * rows[:, 2])
    arms = spins * (moving[:, None] - home)
    vectors = places + arms - fixed[:, None]
    lengths = np.maximum(np.abs(vectors), np.finfo(np.float64).tiny)
    units = vectors / lengths
    by_deviation = np.stack([units.real, units.imag, (units.conj() * 1j * arms).real], axis=-1) * rows[:, 3:]
    return _Links(vectors, lengths, by_deviation)


def _brought(rows: Real, fixed: Complex, moving: Complex, home: complex, free: Real) -> tuple[Complex, Complex, Real]:
    """Dyads moved least to where they need least, and the greatest deviation that one of their poses needs.

    ``free`` is 1 for the coordinates of both pivots that may be moved, else 0; shape (4,).
    """
    spins = np.exp(1j * rows[:, 2])
    drawn = np.stack([fixed.real, fixed.imag, moving.real, moving.imag], axis=1)
    length = np.abs(_links(rows, fixed, moving, home).vectors).mean(axis=1)
    for step in range(STEPS + 1):
        links = _links(rows, fixed, moving, home)
        sigma = np.hypot(np.linalg.norm(links.by_deviation, axis=-1), HELD)
        off = (links.lengths - length[:, None]) / sigma
        if step == STEPS:
            break
        units = links.vectors / links.lengths
        turned = units * np.conj(spins)
        columns = [-units.real * free[0], -units.imag * free[1], turned.real * free[2], turned.imag * free[3]]
        jacobian = np.stack([*columns, -np.ones_like(off)], axis=-1) / sigma[..., None]
        here = np.stack([fixed.real, fixed.imag, moving.real, moving.imag, np.zeros(len(fixed))], axis=1)
        square = jacobian.swapaxes(-1, -2) @ jacobian
        pulled = np.array([FREE, FREE, FREE, FREE, np.inf]) ** -2
        right = -(jacobian.swapaxes(-1, -2) @ off[..., None])[..., 0]
        right[:, :4] -= (here[:, :4] - drawn) * pulled[:4]
        square += np.diag(pulled)
        move = np.linalg.solve(square, right[..., None])[..., 0]
        move /= np.maximum(np.linalg.norm(move[:, :4], axis=1, keepdims=True), 1.0)
        fixed = fixed + (move[:, 0] * free[0] + 1j * move[:, 1] * free[1])
        moving = moving + (move[:, 2] * free[2] + 1j * move[:, 3] * free[3])
        length = length + move[:, 4]
    return fixed, moving, np.abs(off).max(axis=1)


def _needed(rows: Real, pivots: Complex, home: complex) -> Real:
    """The least deviations, in tolerances, with which both links of pairs keep their lengths; shape (m, n, 3)."""
    links = [_links(rows, pivots[:, k], pivots[:, k + 2], home) for k in (0, 1)]
    weights = [1.0 / np.hypot(np.linalg.norm(one.by_deviation, axis=-1), HELD) ** 2 for one in links]
    off = np.stack(
        [
            one.lengths - ((weight * one.lengths).sum(axis=1) / weight.sum(axis=1))[:, None]
            for one, weight in zip(links, weights, strict=True)
        ],
        axis=-1,
    )
    by = np.stack([one.by_deviation for one in links], axis=-2)
    square = by @ by.swapaxes(-1, -2) + HELD**2 * np.eye(2)
    return np.asarray(-(by.swapaxes(-1, -2) @ np.linalg.solve(square, off[..., None]))[..., 0])
