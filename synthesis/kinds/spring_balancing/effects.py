"""Effects of springs on the drive, which are linear in the parameters of springs with known ends.

With the length L of a spring over the input q, L' = dL/dq, its tension is k (L − L₀) + P, and its share of the drive is

    k L L' − k L₀ L' + P L',

linear in the rate k, in k L₀ and in the preload P; for a torsion spring over the rotation φ it is κ φ φ' − κ φ₀ φ'.
Without a free length it is ½ k (L²)', and then the ends can be optimized as well: for an end p = Σ λ_v p_v between
corners fixed in one link, and q fixed in another,

    |q − p|² = Σ λ_v |q − p_v|² − Σ λ_v |p − p_v|²,

where the last sum is constant. A spring at p is therefore equivalent to a set of springs of the rates μ_v = λ_v k at
the corners, and the best place within an area is found together with the rate (the potential energies of
zero-free-length springs add up to that of one such spring: Herder, *Energy-free Systems*, 2001). With both ends open,
the corners are taken in pairs. The set μ_uv ≥ 0 then contains all such springs and others, so that it gives a bound.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.dynamics.balance import compute_balance
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import compute_reactions
from kinematics.linkage.planar.mechanism import GROUND
from synthesis.analyses.linkages.requested_motion import Task, build_task, pace_machine, place_machine
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.kinds.spring_balancing.requested_springs import SoughtSpring
from synthesis.mechanisms.machine import build_torsion_spring, locate_on_link

GRID_SIZE = 2880
"""Number of positions of the motion for peaks and means; the motion's steps if these are more."""

MIN_LENGTH_SHARE = 1e-9
"""Length of a spring, as a share of the size, at which its ends coincide and its force has no direction."""


class Carrier(NamedTuple):
    """A link over positions; its points are place + turn · z, with both also per unit of the input's motion."""

    place: Complex
    turn: Complex
    place_rate: Complex
    turn_rate: Complex

    def move_points(self, of: Complex) -> tuple[Complex, Complex]:
        """Return points of the reference over positions, shape (len(of), N), and their rates."""
        z = np.asarray(of)[:, None]
        return self.place + self.turn * z, self.place_rate + self.turn_rate * z


class Effects(NamedTuple):
    """The K parameters of a spring: their effects on the drive by positions, and their limits.

    Attributes
    ----------
    drive : float, shape (K, N)
        Drive per unit of each parameter.
    rows, limits : float, shapes (R, K), (R,)
        rows · x ≤ limits.
    stiff : float, shape (K,)
        Cost of each parameter as a rate.
    spans : complex, shape (K, N), or None
        Vectors from end to end of springs at the corners, if lengths or forces of their sum are limited.
    longest, strongest : float
        Limits of that sum as a length, and as a force; infinite without a limit.
    """

    drive: Real
    rows: Real
    limits: Real
    stiff: Real
    spans: Complex | None = None
    longest: float = np.inf
    strongest: float = np.inf


class Setting:
    """A linkage over the motion of a problem, and the effects of springs between its links, in units of its forces.

    Attributes
    ----------
    at : float, shape (N,)
        Positions at which all forces are known.
    fixed : float, shape (N,)
        The drive without the requested springs.
    parts : float
        The maximum sum of the magnitudes of all parts of that drive.
    size : float
        Size of the linkage.
    """

    def __init__(self, problem: SpringBalancingProblem) -> None:
        self.problem = problem
        self.task: Task = build_task(problem.mechanism, problem.dynamics, problem.length_unit, problem.motion)
        machine = self.task.machine
        grid = self.task.list_positions(max(GRID_SIZE, problem.motion.steps))
        now = place_machine(machine, grid, self.task.speed, self.task.acceleration)
        self._paced = pace_machine(machine, grid)
        found = compute_reactions(machine, now)
        check = compute_balance(machine, now, self._paced, found.rubbing)
        self._known = found.solved & np.isfinite(check.drive)
        self.at = grid[self._known]
        self.fixed = check.drive[self._known]
        self.parts = float(check.scale[self._known].max(initial=0.0))
        self.size = float(np.max(now.size))
        self._carriers: dict[str, Carrier] = {}

    @cached_property
    def peak(self) -> float:
        """The maximum drive without springs."""
        return float(np.abs(self.fixed).max(initial=0.0))

    def list_corners(self, spring: SoughtSpring) -> list[Complex]:
        """List the corners of the areas of both ends of a spring, one for a given end; none for a torsion spring."""
        machine = self.task.machine
        return [
            find_hull(
                np.array([locate_on_link(machine.mechanism, end.link, corner, machine.scale) for corner in end.corners])
            )
            for end in spring.ends or ()
        ]

    def thin_positions(self, count: int) -> Setting:
        """Return the same setting on ``count`` of its positions, spread evenly."""
        few = copy(self)
        kept = np.unique(np.linspace(0, len(self.at) - 1, count).astype(int))
        few.at, few.fixed = self.at[kept], self.fixed[kept]
        few._known = np.zeros_like(self._known)
        few._known[np.flatnonzero(self._known)[kept]] = True
        # Cached carriers belong to the full set of positions.
        few._carriers = {}
        return few

    def get_carrier(self, link: str) -> Carrier:
        """Return a link over the known positions."""
        if link not in self._carriers:
            self._carriers[link] = _build_carrier(self._paced, link, self._known)
        return self._carriers[link]

    def compute_lengths(self, spring: SoughtSpring, ends: Sequence[complex]) -> Real:
        """Compute the lengths of a spring between two points."""
        assert spring.ends is not None
        one, other = (
            self.get_carrier(end.link).move_points(np.array([at]))[0][0]
            for end, at in zip(spring.ends, ends, strict=True)
        )
        return np.asarray(np.abs(other - one))

    def compute_rotation(self, links: tuple[str, str]) -> tuple[Real, Real]:
        """Compute the rotation of the second link relative to the first from the reference, and its rate."""
        spring = build_torsion_spring(self.task.machine.mechanism, links)
        turned = spring.rotation(self._paced)[self._known]
        rates = [np.broadcast_to(self._paced.spins[link][1], self._known.shape)[self._known] for link in links]
        return np.asarray(turned), np.asarray(rates[1] - rates[0])


def _build_carrier(now: Places, link: str, known: NDArray[np.bool_]) -> Carrier:
    count = int(known.sum())
    if link == GROUND:
        return Carrier(*(np.full(count, value, np.complex128) for value in (0.0, 1.0, 0.0, 0.0)))
    turn, turn_rate = (part[known] for part in now.turns[link][:2])
    base = now.base(link)
    place, rate = (part[known] for part in now.joints[base][:2])
    about = complex(now.reference(base))
    return Carrier(place - about * turn, turn, rate - about * turn_rate, turn_rate)


def find_hull(points: Complex) -> Complex:
    """Return the corners of the convex hull of points, counter-clockwise; two for a line, one for a point."""
    distinct = sorted({complex(z) for z in points}, key=lambda z: (z.real, z.imag))
    if len(distinct) < 3:
        return np.array(distinct)
    chains: list[list[complex]] = []
    # Andrew's monotone chain: lower and upper hull in one pass each over the sorted points.
    for ordered in (distinct, distinct[::-1]):
        chain: list[complex] = []
        for z in ordered:
            while len(chain) > 1 and ((chain[-1] - chain[-2]).conjugate() * (z - chain[-1])).imag <= 0.0:
                chain.pop()
            chain.append(z)
        chains.append(chain[:-1])
    return np.array([*chains[0], *chains[1]])


def compute_effects(setting: Setting, spring: SoughtSpring, ends: Sequence[Complex]) -> Effects:
    """Compute the effects of a spring with ends between corners; only a superposed spring may have several."""
    if spring.links is not None:
        return _compute_torsion(setting, spring)
    assert spring.ends is not None
    one, other = (
        setting.get_carrier(end.link).move_points(corners) for end, corners in zip(spring.ends, ends, strict=True)
    )
    span = (other[0][None] - one[0][:, None]).reshape(-1, len(setting.at))
    rate = (other[1][None] - one[1][:, None]).reshape(span.shape)
    along = span.real * rate.real + span.imag * rate.imag
    if spring.is_superposable:
        return _compute_superposed(setting, spring, span, along)
    return _compute_single(setting, spring, span[0], along[0])


class _LimitRows:
    """Collects the linear limits of parameters."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.rows: list[list[float]] = []
        self.limits: list[float] = []

    def add_maximum(self, row: Sequence[float], limit: float = 0.0) -> None:
        self.rows.append(list(row))
        self.limits.append(limit)

    def add_range(self, row: Sequence[float], low: float, high: float | None) -> None:
        self.add_maximum([-entry for entry in row], -low)
        if high is not None:
            self.add_maximum(row, high)

    @property
    def matrix(self) -> Real:
        return np.array(self.rows, np.float64).reshape(-1, self.count)


def _compute_superposed(setting: Setting, spring: SoughtSpring, span: Complex, along: Real) -> Effects:
    """Compute the effects of rates at the pairs of corners."""
    count, scale = len(span), setting.task.machine.scale
    kept = _LimitRows(count)
    for n in range(count):
        kept.add_maximum([-1.0 if k == n else 0.0 for k in range(count)])
    ones = np.ones(count)
    kept.add_range(ones.tolist(), *spring.rates)
    # Without a free length the deflection is the length.
    lengths = [limit for limit in (spring.max_length, spring.max_deflection) if limit is not None]
    longest = scale * min(lengths, default=np.inf)
    strongest = np.inf if spring.max_force is None else spring.max_force
    if count > 1:
        limited = span if np.isfinite(min(longest, strongest)) else None
        return Effects(along, kept.matrix, np.array(kept.limits), ones, limited, longest, strongest)
    length = np.abs(span[0])
    # A single spring beyond its length limit cannot exist at all: its rate must be zero.
    if length.max() > longest * (1.0 + MIN_LENGTH_SHARE):
        kept.add_maximum([1.0])
    if np.isfinite(strongest):
        kept.add_maximum([float(length.max()) / strongest], 1.0)
    return Effects(along, kept.matrix, np.array(kept.limits), ones)


def compute_free_limits(spring: SoughtSpring, scale: float, length: Real) -> tuple[float, float]:
    """Compute the range of free lengths of a spring with these lengths; the minimum exceeds the maximum if none fits.

    An extension spring is never shorter, a compression spring never longer, and none exceeds its stroke.
    """
    least, most = spring.free_lengths
    low, high = float(length.min()), float(length.max())
    least, most = scale * least, np.inf if most is None else scale * most
    if spring.form == "extension":
        most = min(most, low)
    if spring.form == "compression":
        least = max(least, high)
    if spring.max_deflection is not None:
        stroke = scale * spring.max_deflection
        least, most = max(least, high - stroke), min(most, low + stroke)
    return least, most


def _compute_single(setting: Setting, spring: SoughtSpring, span: Complex, along: Real) -> Effects:
    """Compute the effects of rate, rate times free length, and preload."""
    scale = setting.task.machine.scale
    length = np.abs(span)
    low, high = float(length.min()), float(length.max())
    # L' = (L²)'/(2 L); a spring of no length has no direction.
    lengthening = along / np.where(length > 0.0, length, 1.0)
    kept = _LimitRows(3)
    kept.add_range([1.0, 0.0, 0.0], *spring.rates)
    kept.add_range([0.0, 0.0, 1.0], *spring.preloads)
    # Free length limits are linear in rate and rate × free length: low · k ≤ k L₀ ≤ high · k.
    shortest, free = compute_free_limits(spring, scale, length)
    none = shortest > free * (1.0 + MIN_LENGTH_SHARE)
    kept.add_maximum([shortest, -1.0, 0.0])
    kept.add_maximum([-max(free, shortest), 1.0, 0.0])
    if spring.max_force is not None:
        # The tension is monotonic in the length: its extremes are at the shortest and the longest.
        for end in (low, high):
            kept.add_maximum([end, -1.0, 1.0], spring.max_force)
            kept.add_maximum([-end, 1.0, -1.0], spring.max_force)
    least = 0.0 if spring.min_length is None else scale * spring.min_length
    most = np.inf if spring.max_length is None else scale * spring.max_length
    if (
        none
        or low < max(least * (1.0 - MIN_LENGTH_SHARE), MIN_LENGTH_SHARE * setting.size)
        or high > most * (1.0 + MIN_LENGTH_SHARE)
    ):
        # No such spring is possible at these places.
        kept.add_maximum([1.0, 0.0, 0.0])
        kept.add_maximum([0.0, 0.0, 1.0])
    drive = np.stack([along, -lengthening, lengthening])
    return Effects(drive, kept.matrix, np.array(kept.limits), np.array([1.0, 0.0, 1.0]))


def _compute_torsion(setting: Setting, spring: SoughtSpring) -> Effects:
    """Compute the effects of rate, and rate times free angle."""
    assert spring.links is not None
    rotation, rate = setting.compute_rotation(spring.links)
    kept = _LimitRows(2)
    kept.add_range([1.0, 0.0], *spring.rates)
    least, most = np.radians(spring.free_angles)
    kept.add_maximum([float(least), -1.0])
    kept.add_maximum([-float(most), 1.0])
    if spring.max_torque is not None:
        for end in (float(rotation.min()), float(rotation.max())):
            kept.add_maximum([end, -1.0], spring.max_torque)
            kept.add_maximum([-end, 1.0], spring.max_torque)
    drive = np.stack([rotation * rate, -rate])
    return Effects(drive, kept.matrix, np.array(kept.limits), np.array([1.0, 0.0]))
