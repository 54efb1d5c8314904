"""Sixbars from descents that stay on their branch (:mod:`branch_walk`): rounds of descents for one problem."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.motion import branch_fit as fit
from synthesis.kinds.motion import branch_rows as rows
from synthesis.kinds.motion import branch_walk as walk
from synthesis.kinds.motion import chain_kernels as kernels
from synthesis.kinds.motion.branch_values import Poses
from synthesis.kinds.motion.chain_draws import needed
from synthesis.kinds.motion.demanded import Demanded, Real
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.relative_dyads import MOST, dyads, relative
from synthesis.kinds.motion.sixbar_makes import Found
from synthesis.kinds.motion.stated_positions import MOST_HELD
from synthesis.kinds.motion.task import MotionTask

DESCENTS = 1500
"""Number of descents per round for up to five positions, about a third of a second; with more positions the number is
reduced in proportion."""

KEPT = 400
"""Maximum number of linkages kept per round."""

DRAWN = 4, 4, 3, 1, 1, 1, 1, 2
"""Sampling weight of each topology: largest for those that carry a body through most positions."""

FIRST_POSES = 64
"""Number of sampled first poses if the first position has a tolerance; every other one is the target itself."""

REPEATED = 1e-9
"""Smallest singular value of the conditions on a crank, relative to the largest, below which they are dependent."""

WITHIN = 0.98
"""Share of a tolerance that is used; the rest covers rounding and the steps of the drive."""


class Aside(NamedTuple):
    """Margins of a descent from its limits, so that these also hold between the steps of its drive.

    Attributes
    ----------
    angle : float
        Radians added to the minimum transmission angle.
    size : float
        Share of the size limits that is used.
    shortest : float
        Factor of the minimum link length of any sixbar.
    """

    angle: float
    size: float
    shortest: float


AIM, BARE = Aside(math.radians(2.0), 0.96, 1.5), Aside(math.radians(0.02), 0.9999, 1.0)
"""Margins that descents aim at, and minimal ones: the limits themselves, apart from the motion between samples."""

RELAXED_ANGLE, RELAXED_SIZE = math.radians(7.0), 3.0
"""Relaxed defaults: the transmission angle, radians, and the factor of the size limits, if the client gives none."""


class BranchSearch:
    """Rounds of descents for one problem.

    Attributes
    ----------
    descents : int
        Number of descents so far.
    """

    def __init__(
        self, problem: MotionProblem, task: MotionTask, target: Demanded, wanted: NDArray[np.bool_], limits: Real
    ) -> None:
        exactly = len(target.held) == kernels.POSITIONS and bool(target.held.all())
        exactly = exactly and not _many_cranks(task)
        self.cranks = _cranks(task) if exactly else np.empty((0, 2), np.complex128)
        drawn = np.where(wanted, DRAWN, 0)
        # A Stephenson II contains a crank between body and ground: without a crank through five poses none exists.
        if exactly and not len(self.cranks):
            drawn[kernels.STEPHENSON_2] = 0
        self.makes = np.repeat(np.arange(len(wanted)), drawn)
        self.first, self.later = _poses(problem, task, target, np.random.default_rng(problem.seed))
        self.held: NDArray[np.bool_] = np.all(target.held, axis=1)
        self.each = math.ceil(DESCENTS * min(1.0, MOST_HELD / len(self.held)))
        self.needed, self.limits = needed(task), limits
        self.settings = _aims(problem, limits, AIM, relaxed=False), _aims(problem, limits, AIM, relaxed=True)
        self.bare = _aims(problem, limits, BARE, relaxed=False)
        self.pools = _empty(len(self.later)), _empty(len(self.later))
        self.descents = 0

    def round(self, rng: np.random.Generator, *, relaxed: bool) -> Found:
        """Run another round on the current pool; ``relaxed`` drops the default limits."""
        if not len(self.makes):
            return Found.none()
        joints, makes = np.empty((KEPT, 7), np.complex128), np.empty(KEPT, np.int64)
        starts, counts = np.empty(KEPT, np.int64), np.zeros(3, np.int64)
        arrived = walk.Arrived(joints, makes, np.empty(KEPT), starts, counts)
        poses = Poses(self.first, self.later, self.needed, self.limits, self.cranks)
        walk.walked(rng, self.each, self.makes, self.settings[relaxed], poses, self.pools[relaxed], arrived)
        self.descents += int(counts[1])
        n = int(counts[0])
        own = starts[:n]
        places = self.first[own, 0] + 1j * self.first[own, 1]
        return Found(makes[:n], joints[:n], places, self.first[own, 2], arrived.values[:n])

    @property
    def misses(self) -> float:
        """The minimum sum of squares in both pools, with and without the default limits."""
        return min(float(pool.costs[0]) for pool in self.pools)

    def fitted(self) -> Found:
        """Fit the linkages of the pools by least squares until convergence, then empty the pools."""
        found = Found.none()
        poses = Poses(self.first, self.later, self.needed, self.limits, self.cranks)
        for pool in self.pools:
            ends = Found.room(len(pool.costs))
            n = int(fit.fitted(poses, self.held, pool, self.bare, ends))
            found = found.beside(ends.best(np.arange(n)))
            pool.costs[:] = np.inf
        return found


def _many_cranks(task: MotionTask) -> bool:
    """Return whether the conditions on a crank are dependent, as for a body that turns about one point.

    There is a family of cranks then, which :func:`dyads` does not return. With O on the ground and A on the body in the
    first position, |r A + c − O|² = |A − O|² is linear in A, O and A Ō.
    """
    r = task.turns[1:]
    c = task.points[1:] - r * task.points[0]
    on_a = 2.0 * c.conj() * r
    rows = np.stack([on_a.real, -on_a.imag, -2 * c.real, -2 * c.imag, -2 * (r - 1).real, 2 * r.imag, abs(c) ** 2])
    return bool(np.linalg.matrix_rank(rows, tol=REPEATED * np.linalg.norm(rows, 2)) < len(r))


def _cranks(task: MotionTask) -> NDArray[np.complex128]:
    """Find the cranks between body and ground: pins on the body and on the ground, shape (n, 2).

    A Stephenson II contains one of them.
    """
    still, upright = np.zeros(kernels.POSITIONS, np.complex128), np.ones(kernels.POSITIONS, np.complex128)
    shift, spin = np.empty_like(still), np.empty_like(still)
    fixed, moving = np.empty(MOST, np.complex128), np.empty(MOST, np.complex128)
    relative(still, upright, task.points, task.turns, shift, spin)
    none = complex(math.nan, math.nan)
    n = int(dyads(shift, spin, none, none, fixed, moving))
    return np.stack([moving[:n], fixed[:n]], axis=1)


def _poses(problem: MotionProblem, task: MotionTask, target: Demanded, rng: np.random.Generator) -> tuple[Real, Real]:
    """Sample first poses and pack later poses in the form of :class:`branch_walk.Poses`."""
    unit = np.array([target.size, target.size, 1.0])
    first = (
        rng.uniform(-1.0, 1.0, (FIRST_POSES, 3)) * WITHIN * np.where(np.isfinite(target.limits[0]), target.limits[0], 0)
    )
    first[::2] = 0.0
    places = np.stack([task.points.real, task.points.imag, np.angle(task.turns)], axis=1)
    off = np.where(np.isfinite(target.limits), WITHIN * target.limits / unit, 0.0)
    weights = np.ones((len(places), 1)) * (1.0, rows.BY_ANGLE)
    if problem.fitted:
        weights[np.all(target.held, axis=1)] *= fit.OF_HELD
    return first / unit, np.concatenate([places, off, weights], axis=1)[1:]


def _aims(problem: MotionProblem, limits: Real, aside: Aside, *, relaxed: bool) -> Real:
    """Pack the limits that descents aim at into a setting, from :data:`branch_rows.COSINE` on."""
    aims = np.zeros(rows.SETTINGS)
    angle = math.asin(limits[kernels.LEAST_SINE]) + aside.angle
    reach, ratio = limits[[kernels.MOST_REACH, kernels.MOST_RATIO]]
    if relaxed:
        angle = RELAXED_ANGLE if problem.constraints.min_transmission_angle is None else angle
        ratio *= RELAXED_SIZE if problem.constraints.max_link_ratio is None else 1.0
        reach *= RELAXED_SIZE
    aims[rows.COSINE], aims[rows.REACH], aims[rows.RATIO] = math.cos(angle), aside.size * reach, aside.size * ratio
    aims[rows.SHORTEST] = max(aside.shortest * kernels.SHORTEST, limits[kernels.SHORTEST_LINK] / aside.size)
    aims[rows.LONGEST] = aside.size * limits[kernels.LONGEST_LINK]
    aims[rows.FIXED_BOX : rows.WANTED_X] = limits[kernels.FIXED_BOX :]
    return aims


def _empty(later: int) -> walk.Pool:
    unknowns = rows.JOINTS + later
    settings = np.zeros((walk.POOL, rows.SETTINGS))
    return walk.Pool(
        np.zeros((walk.POOL, unknowns)), np.full(walk.POOL, np.inf), settings, np.zeros(walk.POOL, np.int64)
    )
