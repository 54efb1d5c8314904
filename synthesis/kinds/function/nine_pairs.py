"""All Watt II sixbars that meet nine pairs of input and output, real and complex.

The solutions of the start are followed to the problem's turns (:mod:`synthesis.kinds.function.nine_pair_system`). What
is reached is brought to its last digits with equations in twice the precision and checked as a whole: that no two paths
ended in one solution (one of them has then jumped, and both are followed again), and that with every solution its
complex conjugate is there, as real turns demand. The conjugates of solutions whose own path was lost are filled in by
that; what is still missing is followed in smaller steps and in twice the precision, and along other ways, on which
every path ends elsewhere. What cannot be found is said: nothing is complete without all of them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import resources
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.function.nine_pair_system import (
    GROUPS,
    PARAMETERS,
    SCRATCH,
    SOLUTIONS,
    UNKNOWNS,
    is_linkage,
    nine_pair_system,
    nine_pair_system_extended,
)
from synthesis.numerics.continuation import CONVERGED, REACHED, follow, further, refine
from synthesis.numerics.known import Known, crowded

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Mask = NDArray[np.bool_]

SAME = 1e-10
"""Solutions whose vectors agree to this share are one."""

NONE, NO_END = 1e-9, 1e9
"""Vectors, in grounds, below which and beyond which there is no solution: paths come to these that lost their way."""

REAL = 1e-6
"""A solution whose conjugate vectors differ by less than this share from conjugates may be real; Newton then decides
with vectors that are."""

BEND = 0.5
"""Size of the random bend of the way."""

THREADS = 2
"""Paths that are followed side by side."""

WAYS = 4
"""Whole runs at most; the first finds all or nearly all in general problems."""

SPECIAL = 0.1
"""Where more than this share of the paths does not end, the pairs are special and have fewer solutions; repeating the
run would find the same."""

FIRST_TOLERANCE, RETRY_TOLERANCES = 2e-3, (2e-4, 1e-5)
"""Relative error of the prediction that a step may have: at first, and when lost paths are followed again."""

PORTION, STEPS, RETRY_STEPS = 512, 5000, 20_000
"""Paths between two reports of progress, and greatest number of steps of one, at first and when followed again."""

RETRIED = 0.9
"""Share of the progress of a way with which the lost paths are followed again."""


class Start(NamedTuple):
    """Solutions, shape (26 370, 8), for the parameters, shape (16,)."""

    y: Complex
    p: Complex


class Watts(NamedTuple):
    """What is known of the Watt II sixbars through nine pairs.

    Attributes
    ----------
    found, lost : int
        Solutions that were computed, real and complex, and those missing from :data:`SOLUTIONS`.
    real : complex, shape (real, 4)
        Of each real one crank and rocker of the first fourbar, input link and output of the second, in the first
        position, with grounds of 1 along +x.
    self_conjugate : bool
        Whether the conjugate of every solution is among them.
    """

    found: int
    lost: int
    real: Complex
    self_conjugate: bool

    @property
    def complete(self) -> bool:
        """Whether these are all."""
        return self.lost == 0 and self.self_conjugate


@cache
def nine_pair_start() -> Start:
    """The stored solutions, which ``tools/watt_start.py`` makes anew, with all their digits."""
    with resources.files(__package__).joinpath("nine_pair_start.npz").open("rb") as opened, np.load(opened) as arrays:
        y, p = arrays["y"].astype(np.complex128), arrays["p"]
    return Start(refine(nine_pair_system, GROUPS, SCRATCH, y, np.zeros_like(y), p)[0], p)


def all_watts(
    inputs: Real,
    outputs: Real,
    rng: np.random.Generator,
    progress: Callable[[float], None],
    *,
    threads: int = THREADS,
    ways: int = WAYS,
) -> Watts:
    """All Watt II sixbars that meet nine pairs.

    Parameters
    ----------
    inputs, outputs : float, shape (9,)
        How far input and output have turned, radians, from any place.
    rng : Generator
        Draws the ways along which the parameters move.
    progress : callable
        Told the share of the paths that are done.
    threads : int
        Paths followed side by side.
    ways : int
        Ways along which all paths are followed at most, while some are missing.
    """
    turned = np.concatenate([inputs[1:] - inputs[0], outputs[1:] - outputs[0]])
    # exp(iθ) − 1 without cancellation.
    p = np.asarray(2j * np.sin(0.5 * turned) * np.exp(0.5j * turned))
    solutions = _Solutions(p)
    for way in range(ways):
        known = len(solutions.y)
        bend = BEND * (rng.normal(size=(PARAMETERS, 2)) @ np.array([1.0, 1.0j]))
        _run(solutions, bend, threads, _part(progress, way))
        if solutions.missing <= 0 or solutions.missing > SPECIAL * SOLUTIONS or len(solutions.y) == known:
            break
    progress(1.0)
    return Watts(
        len(solutions.y),
        solutions.missing,
        _real(solutions),
        solutions.self_conjugate,
    )


def _part(progress: Callable[[float], None], way: int) -> Callable[[float], None]:
    return lambda share: progress(further(way, share))


def conjugate(y: Complex) -> Complex:
    """The complex conjugates of solutions for real turns: the parts of each vector change places."""
    return np.asarray(y[..., [1, 0, 3, 2, 5, 4, 7, 6]].conj())


class _Solutions:
    """The solutions found so far, each once."""

    def __init__(self, p: Complex) -> None:
        self.p = p
        self.turns = np.concatenate([p[:8], p[:8].conj(), p[8:], p[8:].conj()])
        self.y = np.empty((0, UNKNOWNS), np.complex128)
        self._known = Known(2 * UNKNOWNS, SAME)

    @property
    def missing(self) -> int:
        return SOLUTIONS - len(self.y)

    @property
    def self_conjugate(self) -> bool:
        return bool(self._known.holds(_keys(conjugate(self.y))).all())

    def add(self, y: Complex, low: Complex) -> Complex:
        """Add those ends of paths that are sound; the ends as they are told apart, NaN for the others."""
        refined, sound = self.refined(y, low)
        self._join(refined[sound])
        keys = np.full((len(y), 2 * UNKNOWNS), np.nan, np.complex128)
        keys[sound] = _keys(refined[sound])
        return keys

    def refined(self, y: Complex, low: Complex | None = None) -> tuple[Complex, Mask]:
        """Ends with the digits of twice the precision's equations, and which of them are solutions."""
        low = np.zeros_like(y) if low is None else low
        y, _, moved = refine(nine_pair_system_extended, GROUPS, SCRATCH, y, low, self.turns)
        size = np.abs(y)
        inside = (size > NONE).all(axis=-1) & (size < NO_END).all(axis=-1)
        return y, np.asarray((moved < CONVERGED) & inside & is_linkage(y))

    def _join(self, y: Complex) -> None:
        self.y = np.concatenate([self.y, y[self._known.add(_keys(y))]])

    def add_conjugates(self) -> None:
        """Add the conjugate of every solution where it is missing."""
        mirrored = conjugate(self.y)
        y, sound = self.refined(mirrored[~self._known.holds(_keys(mirrored))])
        self._join(y[sound])


def _keys(y: Complex) -> Complex:
    """By what solutions are told apart: logarithm of the length and direction of every vector."""
    return np.concatenate([np.log(np.abs(y)).astype(np.complex128), y / np.abs(y)], axis=-1)


def _run(solutions: _Solutions, bend: Complex, threads: int, progress: Callable[[float], None]) -> None:
    """Follow all paths along one way and add what they reach, and then those again that were lost."""
    keys = np.full((SOLUTIONS, 2 * UNKNOWNS), np.nan, np.complex128)
    lost = 0
    for first in range(0, SOLUTIONS, PORTION):
        some = np.arange(first, min(first + PORTION, SOLUTIONS))
        keys[some] = _follow(solutions, some, bend, FIRST_TOLERANCE, threads)
        lost += int(np.isnan(keys[some, 0]).sum())
        progress(RETRIED * (first + len(some)) / SOLUTIONS)
        if lost > PORTION + SPECIAL * SOLUTIONS:
            return
    solutions.add_conjugates()
    again = _astray(keys)
    for n, tolerance in enumerate(RETRY_TOLERANCES):
        for first in range(0, len(again), PORTION):
            if solutions.missing <= 0:
                return
            some = again[first : first + PORTION]
            _follow(solutions, some, bend, tolerance, threads, again=True)
            solutions.add_conjugates()
            done = (n + (first + len(some)) / len(again)) / len(RETRY_TOLERANCES)
            progress(RETRIED + (1.0 - RETRIED) * done)


def _astray(keys: Complex) -> NDArray[np.int64]:
    """Paths that have no end, and all of those that have one in common: one of them at most has come to its own."""
    ended = np.flatnonzero(~np.isnan(keys[:, 0]))
    astray = np.ones(len(keys), np.bool_)
    astray[ended] = crowded(keys[ended], SAME)
    return np.flatnonzero(astray)


def _follow(
    solutions: _Solutions,
    some: NDArray[np.int64],
    bend: Complex,
    tolerance: float,
    threads: int,
    *,
    again: bool = False,
) -> Complex:
    """Follow some solutions of the start to the problem; returns their ends as they are told apart, NaN for none."""
    begun = nine_pair_start()
    ends = follow(
        nine_pair_system_extended if again else nine_pair_system,
        GROUPS,
        SCRATCH,
        begun.y[some],
        begun.p,
        solutions.p,
        bend,
        tolerance=tolerance,
        most_steps=RETRY_STEPS if again else STEPS,
        threads=threads,
        precise=again,
    )
    keys = np.full((len(some), 2 * UNKNOWNS), np.nan, np.complex128)
    reached = ends.status == REACHED
    keys[reached] = solutions.add(ends.y[reached], ends.low[reached])
    return keys


def _real(solutions: _Solutions) -> Complex:
    """The vectors a, c, d, e of the real solutions, shape (real, 4)."""
    y = solutions.y
    apart = np.abs(y[:, ::2] - y[:, 1::2].conj()).max(axis=-1, initial=0.0)
    near = y[apart <= REAL * np.abs(y).max(axis=-1, initial=0.0)].copy()
    near[:, ::2] = 0.5 * (near[:, ::2] + near[:, 1::2].conj())
    near[:, 1::2] = near[:, ::2].conj()
    near, real = solutions.refined(near)
    return np.asarray(near[real][:, ::2])
