"""Starting pairs of dyads for constrained fits.

Poses are sampled within the tolerances by a low-discrepancy sequence that begins with the target poses themselves. For
each set of poses many dyads are sampled in the given regions, or around the body, and projected onto dyads that meet
the poses exactly, all sets at once. Dyads that have then left their regions are kept if they are near them: the fit can
use the tolerances to bring them back. All pairs of a set are screened (:mod:`synthesis.kinds.motion.exact.screening`)
by slightly relaxed constraints, and the best distinct pairs are the starts.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.dyads.equations import Dyads
from synthesis.kinds.motion.exact.screening import make_screening_constraints, screen
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices, to_complete_point
from synthesis.kinds.motion.task.pivot_regions import SideAreas, list_side_areas, measure_outside_distance, sample_area
from synthesis.kinds.motion.task.positions import MotionTask, find_given_pivot
from synthesis.kinds.motion.task.random_points import sample_points_around
from synthesis.model.linkage.problem import Constraints, LengthLimits
from synthesis.model.linkage.zones import Area
from synthesis.results.ranking import select_most_distinct

SET_COUNT = 24
"""Number of sets of poses sampled within the tolerances."""

SAMPLES_PER_SET = 1200
"""Number of dyads sampled per side and set."""

MAX_DYADS = 110
"""Maximum number of dyads per side and set that are paired, those nearest to their regions."""

STEP_COUNT = 4
"""Number of Gauss–Newton steps that fit dyads to the poses of their set."""

LENGTH_TOLERANCE = 1e-3
"""Maximum change of a link's length, task sizes, for a dyad that meets the poses of its set."""

RIDGE_SHARE = 1e-9
"""Ridge added to a normal matrix, as a share of its trace, so that a singular one can be solved."""

MAX_DISTANCE = 50.0
"""Maximum distance of a starting pivot, in task sizes."""

HALF_WEIGHT_DISTANCE = 0.1
"""Distance from its region, in task sizes, at which the weight of a pivot is halved."""

ANGLE_RELAXATION, LENGTH_RELAXATION = 0.6, 1.3
"""Relaxation for the screening of starts: factor of the minimum transmission angle, and factor of the limits of lengths
and link ratio."""

POOL_SIZE = 4000
"""Number of best pairs from which distinct ones are selected."""

MIN_SEPARATIONS = 0.3 * 0.5 ** np.arange(8)
"""Minimum separations of distinct starts, in task sizes, tried in turn until one yields enough starts."""


class Start(NamedTuple):
    """A starting linkage.

    ``pivots`` are O2, O4, A and B, shape (4,); A and B with the body in the first target pose. ``deviations``, in units
    of the tolerances, and ``poses``, in task units and radians, have shape (n, 3).
    """

    pivots: Complex
    deviations: Real
    poses: Real


def list_starts(problem: MotionProblem, task: MotionTask, tolerances: Real, count: int) -> list[Start]:
    """List the best distinct pairs of dyads, best first.

    Parameters
    ----------
    problem : MotionProblem
        The problem.
    task : MotionTask
        The target poses.
    tolerances : float, shape (n, 3)
        Tolerances of x, y (task units) and angle (radians); 0 for an exact coordinate.
    count : int
        Maximum number of starts.
    """
    rng = np.random.default_rng(problem.seed)
    # Without tolerances every set would be the same.
    shares = sample_deviations(tolerances, SET_COUNT if tolerances.any() else 1)
    demanded = np.stack([task.points.real, task.points.imag, np.angle(task.turns)], axis=1)
    poses = demanded + shares * tolerances
    sides, areas = (problem.input_side, problem.output_side), list_side_areas(problem)
    inputs = _sample_side(task, poses, sides[0], areas[0], rng)
    # Equal choices have equal dyads, so sample them once.
    alike = sides[0] == sides[1] and areas[0] == areas[1]
    outputs = inputs if alike else _sample_side(task, poses, sides[1], areas[1], rng)
    softened = relax_constraints(problem.constraints)
    limit = problem.constraints.min_transmission_angle or 0.0
    constraints = make_screening_constraints(softened, task, ANGLE_RELAXATION * limit, problem.rank_by)
    chosen: list[tuple[Real, Complex, NDArray[np.int64]]] = []
    for k, (one, other) in enumerate(zip(inputs, outputs, strict=True)):
        if not len(one.dyads.fixed) or not len(other.dyads.fixed):
            continue
        set_of = _make_task(poses[k])
        score = screen(set_of, one.dyads, other.dyads, constraints).score * np.outer(one.weight, other.weight)
        # A fixed share per set keeps the variety of poses among the starts.
        best = np.argpartition(-score, min(POOL_SIZE // SET_COUNT, score.size - 1), axis=None)[: POOL_SIZE // SET_COUNT]
        best = best[score.ravel()[best] > 0.0]
        i, j = np.unravel_index(best, score.shape)
        joints = [one.dyads.fixed[i], other.dyads.fixed[j], one.dyads.moving[i], other.dyads.moving[j]]
        chosen.append((score.ravel()[best], np.stack(joints, axis=1), np.full(len(best), k)))
    if not chosen:
        return []
    score, pivots, sets = (np.concatenate(column) for column in zip(*chosen, strict=True))
    # Stable sort: the result is reproducible for equal scores.
    order = np.argsort(-score, kind="stable")
    picked = order[select_most_distinct(pivots[order], count, MIN_SEPARATIONS)]
    found = []
    for n in picked:
        pose = poses[sets[n]]
        # Express the moving pivots with the body in the first target pose, from which deviations are measured.
        first, turn = complex(pose[0, 0], pose[0, 1]), complex(np.exp(-1j * pose[0, 2]))
        body = task.points[0] + turn * (pivots[n, 2:] - first)
        found.append(Start(np.concatenate([pivots[n, :2], body]), shares[sets[n]], pose))
    return found


def sample_deviations(tolerances: Real, sets: int) -> Real:
    """Sample deviations in (−1, 1) of each coordinate with a tolerance, shape (sets, n, 3); all 0 in the first set.

    Roberts' low-discrepancy sequence: multiples of the powers of 1/φ with φ^(d+1) = φ + 1, d coordinates, modulo 1.
    """
    free = tolerances > 0.0
    d = int(free.sum())
    shares = np.zeros((sets, *tolerances.shape))
    if d:
        ratio = 2.0
        # The fixed-point iteration for φ contracts quickly; 60 steps reach double precision for every d.
        for _ in range(60):
            ratio = (1.0 + ratio) ** (1.0 / (d + 1.0))
        powers = ratio ** -np.arange(1.0, d + 1.0)
        # Centred on 0.5, so that the sequence begins away from the limits.
        shares[1:, free] = 2.0 * np.mod(0.5 + np.outer(np.arange(1, sets), powers), 1.0) - 1.0
    return shares


def _make_task(poses: Real) -> MotionTask:
    """Convert a set of poses to a task whose coordinates are those of the first pose."""
    turns = np.exp(1j * (poses[:, 2] - poses[0, 2]))
    return MotionTask(poses[:, 0] + 1j * poses[:, 1], turns, 0j, 1.0)


class _DyadSample(NamedTuple):
    """Dyads that meet the poses of one set (moving pivots in its first pose), and their weights by region."""

    dyads: Dyads
    weight: Real


def _sample_side(
    task: MotionTask, poses: Real, choices: DyadChoices, areas: SideAreas, rng: np.random.Generator
) -> list[_DyadSample]:
    """Sample the dyads of one side for each set of poses."""
    fixed, moving, free = sample_pivots(task, choices, areas, rng, len(poses) * SAMPLES_PER_SET)
    of = np.repeat(np.arange(len(poses)), SAMPLES_PER_SET)
    places, spins = poses[..., 0] + 1j * poses[..., 1], np.exp(1j * poses[..., 2])
    fixed, moving, off = _fit_dyads_to_poses(places[of], spins[of], fixed, moving - task.points[0], free)
    pins = places[of, 0] + spins[of, 0] * moving
    # The farther pivot decides whether the dyad is usable.
    reach = np.maximum(np.abs(fixed), np.abs(pins))
    astray = measure_outside_distance(task, areas.fixed, fixed) + measure_outside_distance(task, areas.moving, pins)
    # The last test also rejects NaN.
    sound = (off <= LENGTH_TOLERANCE) & (reach < MAX_DISTANCE) & np.isfinite(reach)
    rank = np.where(sound, astray, np.inf)
    found = []
    for k in range(len(poses)):
        rows = slice(k * SAMPLES_PER_SET, (k + 1) * SAMPLES_PER_SET)
        best = np.argsort(rank[rows], kind="stable")[:MAX_DYADS]
        best = best[np.isfinite(rank[rows][best])] + k * SAMPLES_PER_SET
        dyads = Dyads(fixed[best].copy(), pins[best].copy())
        # Weight 1 inside the regions, 1/2 at the given distance outside.
        found.append(_DyadSample(dyads, 1.0 / (1.0 + (astray[best] / HALF_WEIGHT_DISTANCE) ** 2)))
    return found


def sample_pivots(
    task: MotionTask, choices: DyadChoices, areas: SideAreas, rng: np.random.Generator, count: int
) -> tuple[Complex, Complex, Real]:
    """Return given or sampled fixed and moving pivots (the body in its first target pose), shape (count,) each.

    The third value is 1 for each of their four coordinates that is open, else 0.
    """
    fixed = _sample_in_areas(task, areas.fixed, complex(task.points.mean()), rng, count)
    moving = _sample_in_areas(task, areas.moving, complex(task.points[0]), rng, count)
    # Given pivots replace the samples and are not moved by the fit.
    stated = [find_given_pivot(task, choices, fixed=side) for side in (True, False)]
    if stated[0] is not None:
        fixed[:] = stated[0]
    if stated[1] is not None:
        moving[:] = stated[1]
    return fixed, moving, np.repeat([pivot is None for pivot in stated], 2).astype(np.float64)


def _sample_in_areas(
    task: MotionTask, areas: tuple[Area, ...], centre: complex, rng: np.random.Generator, count: int
) -> Complex:
    """Sample random pivots in their areas, or around a centre without areas."""
    inside = sample_area(task, areas, rng, count)
    return sample_points_around(centre, rng, count) if inside is None else inside


def _fit_dyads_to_poses(
    places: Complex, spins: Complex, fixed: Complex, arms: Complex, free: Real
) -> tuple[Complex, Complex, Real]:
    """Move dyads by minimum-norm steps until their links have the same length in all poses.

    Parameters
    ----------
    places, spins : complex, shape (m, n)
        P, and the body's rotation relative to the orientation of ``arms``.
    fixed, arms : complex, shape (m,)
        The dyads: fixed pivots, and vectors from P to the moving pivots.
    free : float, shape (4,)
        1 for coordinates of both pivots that may change, else 0.

    Returns
    -------
    fixed, arms : complex, shape (m,)
        The moved dyads.
    off : float, shape (m,)
        The remaining maximum change of the link's length.
    """
    off = np.full(len(fixed), np.inf)
    for step in range(STEP_COUNT + 1):
        links = places + spins * arms[:, None] - fixed[:, None]
        lengths = np.maximum(np.abs(links), np.finfo(np.float64).tiny)
        gaps = lengths[:, 1:] - lengths[:, :1]
        off = np.abs(gaps).max(axis=1)
        if step == STEP_COUNT:
            break
        units = links / lengths
        by_fixed = -(units[:, 1:] - units[:, :1])
        turned = units * np.conj(spins)
        by_arm = turned[:, 1:] - turned[:, :1]
        # Fixed coordinates get zero columns, so that the step does not move them.
        jacobian = np.stack([by_fixed.real, by_fixed.imag, by_arm.real, by_arm.imag], axis=-1) * free
        # Minimum-norm step through JJᵀ; the ridge covers dyads with dependent conditions.
        square = jacobian @ jacobian.swapaxes(-1, -2)
        trace = np.trace(square, axis1=-2, axis2=-1)[:, None, None]
        square += (RIDGE_SHARE * trace + np.finfo(np.float64).tiny) * np.eye(square.shape[-1])
        move = -(jacobian.swapaxes(-1, -2) @ np.linalg.solve(square, gaps[..., None]))[..., 0]
        # Limit a step to one task size: longer ones leave the range of the linearisation.
        move /= np.maximum(np.linalg.norm(move, axis=1, keepdims=True), 1.0)
        fixed = fixed + (move[:, 0] + 1j * move[:, 1])
        arms = arms + (move[:, 2] + 1j * move[:, 3])
    return fixed, arms, off


def relax_constraints(constraints: Constraints) -> Constraints:
    """Return relaxed constraints for screening starts; regions are weighted separately."""
    lengths, ratio = constraints.link_length, constraints.max_link_ratio
    if lengths is not None:
        most = None if lengths.max is None else LENGTH_RELAXATION * lengths.max
        lengths = LengthLimits.model_construct(min=lengths.min / LENGTH_RELAXATION, max=most)
    update = {"link_length": lengths, "max_link_ratio": None if ratio is None else LENGTH_RELAXATION * ratio}
    return constraints.model_copy(update=update)


def list_given_coordinates(task: MotionTask, problem: MotionProblem) -> Real:
    """Return the given coordinates of O2, O4, A and B in task units, NaN if open; shape (8,)."""
    stated = np.full(8, math.nan)
    for side, choices in enumerate((problem.input_side, problem.output_side)):
        for moving, partial in ((False, choices.fixed_pivot), (True, choices.moving_pivot)):
            at = 4 * moving + 2 * side
            # A completely given pivot may also follow from other choices of the side.
            whole = find_given_pivot(task, choices, fixed=not moving)
            if whole is not None:
                stated[at : at + 2] = whole.real, whole.imag
            elif partial is not None and to_complete_point(partial) is None:
                origin = task.origin.real, task.origin.imag
                for axis in (0, 1):
                    value = partial[axis]
                    if value is not None:
                        stated[at + axis] = (value - origin[axis]) / task.size
    return stated
