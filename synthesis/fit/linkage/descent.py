"""Descents of linkages of any topology to targets: with soft constraints, under enforced ones, and by basin hopping.

The rows are those of :mod:`synthesis.fit.linkage.residuals`; the methods are Levenberg and Marquardt's
(:mod:`synthesis.numerics.levenberg`) and multipliers (:mod:`synthesis.numerics.augmented_lagrangian`). Basin hopping
perturbs the best fits (their nodes by a share of the shortest link there, or all unknowns evenly) and descends again; a
better end replaces its parent. Results do not depend on the number of threads.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.fit.linkage.margins import EQUATION_COUNT, count_margins
from synthesis.fit.linkage.residuals import (
    ARM,
    DIRECTION,
    FIRST_NODE,
    FREE,
    KIND,
    PLACE,
    ROOT,
    SECOND_NODE,
    SECOND_TOLERANCE,
    SLOT,
    TARGET_SIZE,
    TOLERANCE,
    X,
    Y,
    compute_linkage_rows,
    count_rows,
)
from synthesis.fit.linkage.setting import BACK, FULL_TURN, ORDER, STEPS, WIDTH
from synthesis.fit.linkage.topology import POINT, Topology
from synthesis.numerics.augmented_lagrangian import descend_constrained
from synthesis.numerics.geodesic import follow_valley
from synthesis.numerics.levenberg import Rows, descend
from synthesis.numerics.portions import run_in_portions
from synthesis.numerics.status import Status

SOFT_WEIGHT, SOFT_TOLERANCE = 10.0, 1e-4
"""Default weight of soft constraints, in the task's unit, and the tolerance of such descents."""

INITIAL_WEIGHT, MAX_VIOLATION = 100.0, 1e-3
"""Weight of enforced constraints in the first descent, and their maximum violation at the end, in their own units; the
verification of the driven linkage decides about small ones."""

MAX_ROUNDS, MAX_CONSTRAINED_STEPS = 8, 60
"""Maximum number of descents under enforced constraints, with a multiplier update after each, and of steps of each."""

MAX_VALLEY_HOP, MAX_VALLEY_DIRECTIONS = 0.6, 5
"""Perturbation along a valley: maximum change of a coordinate, in shortest links at its node, and maximum number of the
directions that change the residuals least."""

GAUGE_TOLERANCE = 1e-12
"""Relative singular value below which a direction only places the linkage and changes nothing else."""

SETTLED_INPUT, MAX_SETTLING_CALLS = 1e-12, 20
"""Last step of a settled input, radians, and maximum number of evaluations that settle it."""

PORTION_SIZE = 4
"""Number of descents that a thread takes at a time."""

HOP_SIZE, HOP_SPREAD = 0.1, 0.9
"""Typical standard deviation of a node's perturbation, in shortest links at the node, and that of its logarithm."""

HOP_RANK = 4.0
"""Mean rank of the fits that are perturbed: better ones are perturbed more often."""

LOADING_MULTIPLIER = 1e9
"""Multiplier that exceeds every margin, so that all limits bear a load."""

MIN_GAIN_SHARE = 1e-3
"""Share of its cost by which a fit must improve to replace its parent: less is the same minimum."""


class Fit(NamedTuple):
    """A linkage fitted to targets: unknowns (u,), inputs of the slots (slots,), and half its sum of squares."""

    topology: Topology
    x: Real
    inputs: Real
    cost: float = math.inf


@dataclass(frozen=True, eq=False)
class FitTask:
    """A fit: targets, limits and form, for linkages of any topology.

    Attributes
    ----------
    targets : float, shape (targets, 10)
        Targets of the traced point (PLACE) and of the output or the heading (DIRECTION, ARM).
        :meth:`pack_topology` fills in the nodes. See :func:`build_point_targets`, :func:`build_pose_targets` and
        :func:`build_function_targets`.
    pack_limits : callable
        Returns the setting of a topology with the limits on its linkages.
    full_turn : bool
        Whether the input turns through.
    steps : int
        Number of steps of the input at which the motion is constrained.
    ordered : bool
        Whether the inputs of the slots must follow one another in one direction. The logarithms of their steps are the
        last unknowns then, so that no step reverses.
    back, width : float
        Weight of the way back, and δ of the robust form; see :mod:`synthesis.fit.linkage.residuals`.
    rows : compiled function
        Rows of the fit, of type :data:`synthesis.numerics.levenberg.ROWS`.
    prefix : float, shape (k,)
        Data that these rows expect before the setting of :func:`~synthesis.fit.linkage.residuals.compute_linkage_rows`.
    prefix_margins : int
        Number of margins that they write before its margins.
    """

    targets: Real
    pack_limits: Callable[[Topology], Real]
    full_turn: bool = True
    steps: int = 36
    ordered: bool = False
    back: float = 0.0
    width: float = 0.0
    rows: Rows = compute_linkage_rows
    prefix: Real = field(default_factory=lambda: np.empty(0))
    prefix_margins: int = 0

    def pack_topology(self, topology: Topology) -> tuple[Real, Real]:
        """Return targets and setting for a topology."""
        targets, setting = self.targets.copy(), self.pack_limits(topology).copy()
        for kind, ends in (
            (PLACE, (topology.point, 0)),
            (DIRECTION, topology.measured_direction),
            (ARM, (topology.triad[0] if topology.triad else 0, topology.fixed_pivots[0])),
        ):
            targets[targets[:, KIND] == kind, FIRST_NODE : SECOND_NODE + 1] = ends
        setting[FULL_TURN], setting[STEPS], setting[BACK] = self.full_turn, self.steps, self.back
        setting[WIDTH], setting[ORDER] = self.width, self.ordered
        return targets, setting


def build_function_targets(inputs: Real, outputs: Real, roots: Real, length_root: float | None = None) -> Real:
    """Return rows of targets for the directions of the output at inputs (m,), radians from the reference position.

    The whole linkage turns freely, so that outputs (m,) may count from any direction. ``roots`` (m,) are roots of their
    weights. A linkage that is seen from its input link carries the ground; the length of its output, too, is a target,
    with the root ``length_root`` of its weight.
    """
    m = len(inputs)
    targets = np.zeros((m, TARGET_SIZE))
    targets[:, ROOT], targets[:, SLOT] = roots, range(m)
    if length_root is None:
        targets[:, KIND], targets[:, X] = DIRECTION, outputs
    else:
        targets[:, KIND], targets[:, X], targets[:, Y], targets[:, FREE] = ARM, inputs, outputs, length_root
    return targets


def build_pose_targets(points: Complex, angles: Real, tolerances: Real, roots: Real) -> Real:
    """Return rows of targets for the traced point and the heading of its link, two for each pose in turn.

    Parameters
    ----------
    points, angles : complex and float, shape (poses,)
    tolerances : float, shape (poses, 3)
        Those of x, y and angle.
    roots : float, shape (poses,)
        Roots of the weights.

    The reference position is the first pose; the inputs of all others are free.
    """
    n = len(points)
    targets = np.zeros((2 * n, TARGET_SIZE))
    places, headings = targets[::2], targets[1::2]
    places[:, KIND], places[:, X], places[:, Y] = PLACE, points.real, points.imag
    places[:, TOLERANCE], places[:, SECOND_TOLERANCE] = tolerances[:, 0], tolerances[:, 1]
    headings[:, KIND], headings[:, X], headings[:, TOLERANCE] = DIRECTION, angles, tolerances[:, 2]
    targets[:, ROOT], targets[:, SLOT] = np.repeat(roots, 2), np.repeat(np.arange(n), 2)
    targets[2:, FREE] = 1.0
    return targets


def build_point_targets(points: Complex, weights: Real) -> Real:
    """Return rows of targets for places of the traced point, complex (points,), each at a free input."""
    targets = np.zeros((len(points), TARGET_SIZE))
    targets[:, KIND] = PLACE
    targets[:, X], targets[:, Y], targets[:, ROOT] = points.real, points.imag, np.sqrt(weights)
    targets[:, SLOT], targets[:, FREE] = np.arange(len(points)), 1.0
    return targets


def descend_softly(
    fits: Sequence[Fit], task: FitTask, steps: int, tolerance: float = SOFT_TOLERANCE, weight: float = SOFT_WEIGHT
) -> list[Fit]:
    """Descend at most ``steps`` steps with constraints as penalties of a weight, which may remain violated a little.

    Fits that cannot close have an infinite cost.
    """

    def descend_rows(x: Real, targets: Real, setting: Real, multipliers: Real, state: Real, most: int) -> float:
        cost, _ = descend(task.rows, x, targets, setting, multipliers, state, most, steps, tolerance)
        return cost

    return _descend_each(descend_rows, fits, task, weight)


def follow_valleys(fits: Sequence[Fit], task: FitTask, steps: int, weight: float = SOFT_WEIGHT) -> list[Fit]:
    """Descend as :func:`descend_softly`, along the curved valleys of :mod:`synthesis.numerics.geodesic`."""

    def descend_rows(x: Real, targets: Real, setting: Real, multipliers: Real, state: Real, most: int) -> float:
        return follow_valley(task.rows, x, targets, setting, multipliers, state, most, steps)

    return _descend_each(descend_rows, fits, task, weight)


def _descend_each(
    descend_rows: Callable[[Real, Real, Real, Real, Real, int], float],
    fits: Sequence[Fit],
    task: FitTask,
    weight: float,
) -> list[Fit]:
    """Apply a descent in place, which returns its cost, to every fit."""
    packed = _pack_each(fits, task)

    def descend_one(fit: Fit) -> Fit:
        targets, setting, limits, most = packed[id(fit.topology)]
        x, state = fit.x.copy(), np.concatenate([fit.inputs, np.zeros(limits)])
        multipliers = np.zeros(limits + 1)
        multipliers[limits] = weight
        cost = descend_rows(x, targets, setting, multipliers, state, most)
        return Fit(fit.topology, x, state[: len(fit.inputs)], cost)

    return _run_each(descend_one, fits, PORTION_SIZE)


class FitRows(NamedTuple):
    """Rows of a fit without limits, and its margins: residuals (m,), Jacobian (m, u), settled inputs; finite margins
    (g,) and their derivatives (g, u)."""

    residuals: Real
    jacobian: Real
    inputs: Real
    margins: Real
    gradients: Real


def evaluate_rows(fit: Fit, task: FitTask) -> FitRows | None:
    """Evaluate a fit and all of its constraints; None if it does not close."""
    targets, setting, limits, most = _pack_each([fit], task)[id(fit.topology)]
    state = np.concatenate([fit.inputs, np.zeros(limits)])
    residuals, jacobian = np.zeros(most), np.zeros((most, len(fit.x)))
    # A huge multiplier loads every limit, so that the derivatives of all of them are written.
    multipliers = np.full(limits + 1, LOADING_MULTIPLIER)
    multipliers[limits] = 1.0
    count = task.rows(fit.x, targets, setting, multipliers, state, residuals, jacobian)
    if count < 0:
        return None
    margins = state[len(fit.inputs) :]
    margins = margins[np.isfinite(margins)]
    own = count - len(margins)
    return FitRows(
        residuals[:own], jacobian[:own], state[: len(fit.inputs)].copy(), margins.copy(), -jacobian[own:count]
    )


def settle_inputs(fit: Fit, task: FitTask) -> Fit:
    """Return a fit with the nearest inputs of its free slots, and its cost without constraints."""
    for _ in range(MAX_SETTLING_CALLS):
        rows = evaluate_rows(fit, task)
        if rows is None:
            return fit._replace(cost=math.inf)
        change = float(np.abs(rows.inputs - fit.inputs).max())
        fit = fit._replace(inputs=rows.inputs, cost=0.5 * float(rows.residuals @ rows.residuals))
        if change < SETTLED_INPUT:
            break
    return fit


def fit_constrained(
    fits: Sequence[Fit], task: FitTask, rounds: int = MAX_ROUNDS, steps: int = MAX_CONSTRAINED_STEPS
) -> list[Fit]:
    """Refit linkages under all constraints; an infinite cost marks the fits that fail."""
    packed = _pack_each(fits, task)

    def descend_one(fit: Fit) -> Fit:
        targets, setting, limits, most = packed[id(fit.topology)]
        x, state, ended = fit.x.copy(), np.concatenate([fit.inputs, np.zeros(limits)]), np.empty(1)
        status = descend_constrained(
            task.rows, x, targets, setting, state, most, limits, EQUATION_COUNT, INITIAL_WEIGHT, rounds, steps, ended
        )
        inputs, margins = state[: len(fit.inputs)], state[len(fit.inputs) :]
        failed = status == Status.IMPOSSIBLE or not margins.min() > -MAX_VIOLATION
        return Fit(fit.topology, x, inputs, math.inf if failed else float(ended[0]))

    return _run_each(descend_one, fits, 1)


def _pack_each(fits: Sequence[Fit], task: FitTask) -> dict[int, tuple[Real, Real, int, int]]:
    """Return targets, setting, and the numbers of margins and of rows, by the identity of the topologies."""
    packed = {}
    for topology in {fit.topology for fit in fits}:
        targets, setting = task.pack_topology(topology)
        limits = int(count_margins(setting)) + task.prefix_margins
        most = int(count_rows(len(targets), setting)) + task.prefix_margins
        packed[id(topology)] = targets, np.concatenate([task.prefix, setting]), limits, most
    return packed


def _run_each(descend_one: Callable[[Fit], Fit], fits: Sequence[Fit], portion: int) -> list[Fit]:
    """Apply a descent to every fit, on two threads."""
    ends: list[Fit] = list(fits)

    def process_portion(rows: slice) -> None:
        for k in range(*rows.indices(len(ends))):
            ends[k] = descend_one(fits[k])

    run_in_portions(process_portion, len(ends), portion)
    return ends


def sort_fits(fits: Sequence[Fit]) -> list[Fit]:
    """Return the fits that close, the nearest first."""
    return sorted((fit for fit in fits if math.isfinite(fit.cost)), key=lambda fit: fit.cost)


def measure_shortest(fit: Fit) -> Real:
    """Return the length of the shortest link at each node; 0 for views, which have no coordinates of their own."""
    nodes, places = fit.topology.nodes, fit.x[: 2 * len(fit.topology.nodes)].reshape(-1, 2)
    shortest = np.full(len(nodes), math.inf)
    pairs = [*fit.topology.pairs]
    # A point of a link, such as the traced one, is at a distance from the two pins that place it.
    pairs += [np.array([k, end]) for k, (kind, *ends, _) in enumerate(nodes) if kind == POINT for end in ends]
    for pair in pairs:
        length = float(np.hypot(*(places[pair[0]] - places[pair[1]])))
        shortest[pair] = np.minimum(shortest[pair], length)
    shortest[~np.isfinite(shortest)] = 0.0
    return shortest


def perturb_fit(fit: Fit, size: float, rng: np.random.Generator) -> Fit:
    """Move every node of a linkage at random, by ``size`` times the shortest link at the node."""
    shortest, moved = measure_shortest(fit), fit.x.copy()
    moved[: 2 * len(shortest)] += (size * shortest[:, None] * rng.normal(size=(len(shortest), 2))).ravel()
    return fit._replace(x=moved, cost=math.inf)


def perturb_evenly(fit: Fit, size: float, rng: np.random.Generator) -> Fit:
    """Change all unknowns of a linkage at random by the same ``size``, in units of the task."""
    return fit._replace(x=fit.x + size * rng.normal(size=len(fit.x)), cost=math.inf)


def perturb_along_valley(fit: Fit, task: FitTask, rng: np.random.Generator) -> Fit:
    """Move a linkage along the directions that change its residuals little, without those that change nothing."""
    rows, sizes = evaluate_rows(fit, task), np.repeat(measure_shortest(fit), 2)
    if rows is None:
        return fit
    _, values, along = np.linalg.svd(rows.jacobian[:, : len(sizes)] * sizes, full_matrices=False)
    # Directions that change nothing, such as another reference position, lead to the same linkage.
    along = along[values > GAUGE_TOLERANCE * values[0]]
    if not len(along):
        return fit
    taken = int(rng.integers(1, min(MAX_VALLEY_DIRECTIONS, len(along)) + 1))
    step, moved = along[-taken:].T @ rng.normal(size=taken), fit.x.copy()
    # A random length, but never so short that the same minimum is found again.
    moved[: len(sizes)] += rng.uniform(0.1, 1.0) * MAX_VALLEY_HOP * sizes * step / np.abs(step).max()
    return fit._replace(x=moved, cost=math.inf)


def hop_basins(
    fits: Sequence[Fit], task: FitTask, hops: int, steps: int, rng: np.random.Generator, halvings: int = 0,
    weight: float = SOFT_WEIGHT, *, tolerance: float = SOFT_TOLERANCE, goal: float = 0.0, rank: float = HOP_RANK,
    size: float = HOP_SIZE, perturb: Callable[[Fit, float, np.random.Generator], Fit] = perturb_fit,
) -> list[Fit]:  # fmt: skip
    """Perturb fits ``hops`` times, chosen by rank, and descend from each copy; return the pool, the nearest first.

    If a copy does not close, others with half the perturbation are tried, up to ``halvings`` times. ``weight`` is that
    of the constraints. Copies whose cost falls below ``goal`` join the pool instead of replacing their parent. ``rank``
    is the mean rank of the parents, and ``size`` the median size of a perturbation.
    """
    pool = sort_fits(fits)
    if not pool:
        return pool
    parents = np.minimum(rng.exponential(rank, hops).astype(np.int64), len(pool) - 1)
    sizes = size * np.exp(HOP_SPREAD * rng.normal(size=hops))
    children, waiting = dict[int, Fit](), list(range(hops))
    for _ in range(halvings + 1):
        copies = [perturb(pool[parents[k]], float(sizes[k]), rng) for k in waiting]
        children |= zip(waiting, descend_softly(copies, task, steps, tolerance, weight), strict=True)
        waiting = [k for k in waiting if not math.isfinite(children[k].cost)]
        sizes *= 0.5
    ended = []
    for k, parent in enumerate(parents):
        if children[k].cost < goal:
            ended.append(children[k])
        elif children[k].cost < (1.0 - MIN_GAIN_SHARE) * pool[parent].cost:
            pool[parent] = children[k]
    return sort_fits([*pool, *ended])
