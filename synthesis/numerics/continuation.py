"""Parameter homotopy: follow solutions of a square polynomial system while its parameters move.

A system f(y; p) = 0 with n unknowns has, for almost all complex parameters p, the same number of isolated solutions.
Known solutions at parameters p₀ are followed to p₁ along

    p(t) = (1 − t) p₀ + t p₁ + t (1 − t) b,    0 ≤ t ≤ 1,

where b bends the path: with a random complex b (or generic p₀) no two solutions meet before t = 1, with probability one
(Morgan & Sommese 1989, doi:10.1016/0096-3003(89)90099-4). Every path is followed separately.
A fourth-order Runge–Kutta step of dy/dt = −J⁻¹ f_p ṗ predicts and Newton's method corrects. The first Newton step
shows the error of the prediction (∝ h⁵) and so sets the next step h.

The system is one compiled function, which also does the linear algebra because the structure of J saves time there:

    system(y, low, p, p_low, dp, newton, tangent, work) -> solvable

writes ``newton`` = −J⁻¹ f and ``tangent`` = −J⁻¹ f_p dp, and returns 0 where J is singular; ``work`` is scratch.
``low`` and ``p_low`` are the rounding errors of y and p. A system that computes f at y + low and p + p_low in higher
precision is followed in higher precision, since Newton's steps are added to y and low together. Near an almost
singular solution the parameters need the same precision: there a change of p by 1e-16 moves y by more than a step.
:mod:`synthesis.numerics.elimination` has a dense solver. The type of a system is :data:`SYSTEM`, so that one compiled
tracker serves every system and both are cached on disk.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numba import types

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from synthesis.numerics.double_double import add, multiply

_VECTOR = types.Array(types.complex128, 1, "C")
_INDICES = types.Array(types.int64, 1, "C")

SYSTEM = types.int64(_VECTOR, _VECTOR, _VECTOR, _VECTOR, _VECTOR, _VECTOR, _VECTOR, _VECTOR)
"""The type of a compiled system: y, low, p, p_low, dp, newton, tangent, work."""

System = Callable[[Complex, Complex, Complex, Complex, Complex, Complex, Complex, Complex], int]
"""The same type for a type checker."""

END_REACHED, TOO_MANY_STEPS, STEP_TOO_SMALL, NOT_CONVERGED = range(4)
"""Status of a path's end; only :data:`END_REACHED` is a solution."""

CORRECTOR_TOLERANCE, PRECISE_CORRECTOR_TOLERANCE = 1e-6, 1e-9
"""Relative Newton step at which a point is close enough to its path, in ordinary and in double-double precision. The
error that remains is the square of it."""

MAX_CORRECTIONS, MAX_PRECISE_CORRECTIONS = 3, 6
"""Maximum number of Newton steps after a prediction, in ordinary and in double-double precision."""

REFINEMENT_TOLERANCE = 1e-13
"""Relative Newton step to which an end point is refined, if rounding permits."""

CONVERGENCE_TOLERANCE = 1e-7
"""Relative last Newton step above which a path has not converged: its end is singular, or the path was lost."""

FIRST_STEP, MIN_STEP, MIN_STEP_SHARE = 0.02, 1e-12, 1e-7
"""First step of t, and the step below which a path is abandoned because it runs into a singularity. In double-double
precision the minimum is a share of the remaining path, since nearly singular ends need ever smaller steps."""

OVERFLOW_LIMIT, UNDERFLOW_LIMIT = 1e300, 1e-300
"""Squared size above which a path has diverged, and a number that keeps quotients by zero defined."""

MIN_REMAINING_SHARE = 0.2
"""Share of the remaining progress that each run of all paths leaves to later runs, which are seldom needed."""

CHUNK_SIZE = 16
"""Number of paths that a thread takes at a time: a few milliseconds of work."""


class CompiledSystem(NamedTuple):
    """A system of equations in the form that the tracker needs.

    Attributes
    ----------
    evaluate : compiled function of type :data:`SYSTEM`
        The system; see the module's description.
    groups : int, shape (n,)
        Group number of each unknown. Adjacent unknowns of one group share a scale, to which steps are relative.
    scratch : int
        Number of complex numbers that ``evaluate`` needs as ``work``.
    """

    evaluate: System
    groups: Integers
    scratch: int


class ParameterPath(NamedTuple):
    """Path of the parameters: p₀, p₁ and b, complex, shape (parameters,)."""

    start: Complex
    end: Complex
    bend: Complex


class PathEnds(NamedTuple):
    """Ends of paths.

    Attributes
    ----------
    y, low : complex, shape (paths, n)
        End points and their rounding errors.
    status : int, shape (paths,)
        :data:`END_REACHED`, or the reason why there is no solution.
    steps : int, shape (paths,)
        Number of steps, rejected ones included.
    """

    y: Complex
    low: Complex
    status: Integers
    steps: Integers


@njit(cache=True, nogil=True)
def _compute_relative_size(step: Complex, y: Complex, groups: Integers) -> float:
    """Return the size of a step relative to the point: the maximum over the groups of unknowns that share a scale."""
    largest = 0.0
    n = 0
    while n < y.size:
        group = groups[n]
        size, moved = 0.0, 0.0
        while n < y.size and groups[n] == group:
            size = max(size, y[n].real ** 2 + y[n].imag ** 2)
            moved = max(moved, step[n].real ** 2 + step[n].imag ** 2)
            n += 1
        # Written so that NaN counts as overflow, too.
        if not moved <= OVERFLOW_LIMIT:
            return np.inf
        largest = max(largest, moved / (size + UNDERFLOW_LIMIT))
    return math.sqrt(largest)


@njit(cache=True, nogil=True)
def _interpolate_parameters(left: float, start: Complex, end: Complex, bend: Complex, p: Complex, dp: Complex) -> None:
    """Write the parameters at t = 1 − ``left`` and their derivatives by t."""
    t = 1.0 - left
    for k in range(p.size):
        p[k] = left * start[k] + t * end[k] + t * left * bend[k]
        dp[k] = end[k] - start[k] + (left - t) * bend[k]


@njit(cache=True, nogil=True)
def _interpolate_precise_parameters(
    left: float, start: Complex, end: Complex, bend: Complex, p: Complex, p_low: Complex, dp: Complex
) -> None:
    """Write the parameters in double-double precision, as p₁ + (1 − t) (p₀ − p₁ + t b)."""
    t, t_low = add(1.0 + 0j, 0j, complex(-left), 0j)
    for k in range(p.size):
        away, away_low = multiply(t, t_low, bend[k], 0j)
        back, back_low = add(start[k], 0j, -end[k], 0j)
        away, away_low = add(away, away_low, back, back_low)
        away, away_low = multiply(away, away_low, complex(left), 0j)
        p[k], p_low[k] = add(away, away_low, end[k], 0j)
        dp[k] = end[k] - start[k] + (left - t.real) * bend[k]


@njit(
    types.float64(
        types.FunctionType(SYSTEM), _INDICES, _VECTOR, _VECTOR, _VECTOR, _VECTOR, _VECTOR, _VECTOR, _VECTOR, _VECTOR,
    ),
    cache=True,
    nogil=True,
)  # fmt: skip
def _refine(
    system: System,
    groups: Integers,
    y: Complex,
    low: Complex,
    p: Complex,
    p_low: Complex,
    dp: Complex,
    newton: Complex,
    tangent: Complex,
    work: Complex,
) -> float:
    """Run Newton's method in place until its steps are at rounding level; return the relative size of the last step."""
    moved = np.inf
    # Steps shrink quadratically, so that eight suffice; a step that does not shrink has reached rounding level.
    for _ in range(8):
        if system(y, low, p, p_low, dp, newton, tangent, work) == 0:
            break
        now = _compute_relative_size(newton, y, groups)
        if now >= moved:
            break
        moved = now
        for k in range(y.size):
            y[k], low[k] = add(y[k], low[k], newton[k], 0j)
        if moved < REFINEMENT_TOLERANCE:
            break
    return moved


class _Parameters(NamedTuple):
    """The path of the parameters, and buffers for their values, rounding errors and derivatives."""

    start: Complex
    end: Complex
    bend: Complex
    p: Complex
    p_low: Complex
    dp: Complex


class _Buffers(NamedTuple):
    """Buffers for the two steps that a system writes, and its scratch."""

    newton: Complex
    tangent: Complex
    work: Complex


@njit(cache=True, nogil=True)
def _predict(
    system: System, y: Complex, low: Complex, left: float, h: float, precise: bool, parameters: _Parameters,
    buffers: _Buffers, slopes: Complex, at: Complex, rest: Complex,
) -> None:  # fmt: skip
    """Write the point after a step h of Runge–Kutta's classical method into ``at`` and ``rest``.

    ``slopes`` has the slope at the present point in its first row and receives those of the other stages.
    """
    start, end, bend, p, p_low, dp = parameters
    newton, tangent, work = buffers
    # Stages 1 and 2 share the parameters at the middle of the step.
    for stage in range(1, 4):
        reach = h if stage == 3 else 0.5 * h
        if stage != 2 and precise:
            _interpolate_precise_parameters(left - reach, start, end, bend, p, p_low, dp)
        elif stage != 2:
            _interpolate_parameters(left - reach, start, end, bend, p, dp)
        for k in range(y.size):
            at[k] = y[k] + reach * slopes[stage - 1, k]
        system(at, low, p, p_low, dp, newton, tangent, work)
        slopes[stage] = tangent
    for k in range(y.size):
        change = h / 6.0 * (slopes[0, k] + 2.0 * (slopes[1, k] + slopes[2, k]) + slopes[3, k])
        at[k], rest[k] = add(y[k], low[k], change, 0j)


@njit(cache=True, nogil=True)
def _correct(
    system: System, groups: Integers, at: Complex, rest: Complex, parameters: _Parameters, buffers: _Buffers,
    tolerance: float, precise: bool,
) -> tuple[bool, float]:  # fmt: skip
    """Run Newton's method in place; return whether it converged, and the relative size of its first step."""
    p, p_low, dp = parameters.p, parameters.p_low, parameters.dp
    newton, tangent, work = buffers
    # Higher precision pays only if the corrector uses it: tighter tolerance, more steps.
    close, corrections = (
        (PRECISE_CORRECTOR_TOLERANCE, MAX_PRECISE_CORRECTIONS) if precise else (CORRECTOR_TOLERANCE, MAX_CORRECTIONS)
    )
    missed = 0.0
    for correction in range(corrections):
        if system(at, rest, p, p_low, dp, newton, tangent, work) == 0:
            break
        moved = _compute_relative_size(newton, at, groups)
        if correction == 0:
            missed = moved
        # A large correction may lead to a neighbouring path: reject the step.
        if not moved <= tolerance:
            break
        for k in range(at.size):
            at[k], rest[k] = add(at[k], rest[k], newton[k], 0j)
        if moved < close:
            return True, missed
    return False, missed


@njit(
    types.UniTuple(types.int64, 2)(
        types.FunctionType(SYSTEM), _INDICES, _VECTOR, _VECTOR, _VECTOR, _VECTOR, _VECTOR, types.float64, types.int64,
        types.int64, types.boolean,
    ),
    cache=True,
    nogil=True,
)  # fmt: skip
def _follow(
    system: System,
    groups: Integers,
    y: Complex,
    low: Complex,
    start: Complex,
    end: Complex,
    bend: Complex,
    tolerance: float,
    most_steps: int,
    scratch: int,
    precise: bool,
) -> tuple[int, int]:
    """Follow one path in place, from the start ``y`` to the end; return status and number of steps."""
    n = y.size
    p, dp = np.empty(start.size, np.complex128), np.empty(start.size, np.complex128)
    p_low = np.zeros(start.size, np.complex128)
    slopes = np.empty((4, n), np.complex128)
    newton, tangent, work = np.empty(n, np.complex128), np.empty(n, np.complex128), np.empty(scratch, np.complex128)
    at, rest = np.empty(n, np.complex128), np.zeros(n, np.complex128)
    parameters, buffers = _Parameters(start, end, bend, p, p_low, dp), _Buffers(newton, tangent, work)
    left, h, tried, grown = 1.0, FIRST_STEP, 0, 2.0
    _interpolate_parameters(left, start, end, bend, p, dp)
    system(y, low, p, p_low, dp, newton, tangent, work)
    slopes[0] = tangent
    while left > 0.0:
        if tried >= most_steps:
            return TOO_MANY_STEPS, tried
        # Near a singular end the steps shrink with the remaining path; a fixed minimum would end it too early.
        if h < (MIN_STEP_SHARE * left if precise else MIN_STEP):
            return STEP_TOO_SMALL, tried
        tried += 1
        # The last step ends exactly at t = 1.
        h = min(h, left)
        _predict(system, y, low, left, h, precise, parameters, buffers, slopes, at, rest)
        accepted, missed = _correct(system, groups, at, rest, parameters, buffers, tolerance, precise)
        # The prediction error is of order h⁵; aim at 0.4 of the tolerance.
        scale = (0.4 * tolerance / (missed + UNDERFLOW_LIMIT)) ** 0.2 if missed < OVERFLOW_LIMIT else 0.2
        if accepted:
            left -= h
            for k in range(n):
                y[k], low[k] = at[k], rest[k]
                slopes[0, k] = tangent[k]
            # Growth is limited to 2.5, because the error estimate rests on a single step.
            h *= min(max(scale, 0.5), grown)
            grown = 2.5
        else:
            # After a rejected step the next accepted one must not grow, or it would fail at the same place.
            h *= min(max(scale, 0.2), 0.6)
            grown = 1.0
    moved = _refine(system, groups, y, low, p, p_low, dp, newton, tangent, work)
    return (END_REACHED if moved < CONVERGENCE_TOLERANCE else NOT_CONVERGED), tried


@njit(
    types.void(
        types.FunctionType(SYSTEM), _INDICES, types.Array(types.complex128, 2, "C"),
        types.Array(types.complex128, 2, "C"), _VECTOR, types.int64, types.Array(types.float64, 1, "C"),
    ),
    cache=True,
    nogil=True,
)  # fmt: skip
def _refine_all(
    system: System, groups: Integers, y: Complex, low: Complex, p: Complex, scratch: int, moved: Real
) -> None:
    """Refine all solutions in place; ``moved`` receives the relative size of each one's last step."""
    work, still = np.empty(scratch, np.complex128), np.zeros(p.size, np.complex128)
    newton, tangent = np.empty(y.shape[1], np.complex128), np.empty(y.shape[1], np.complex128)
    for n in range(y.shape[0]):
        moved[n] = _refine(system, groups, y[n], low[n], p, still, still, newton, tangent, work)


@njit(
    types.void(
        types.FunctionType(SYSTEM), _INDICES, types.Array(types.complex128, 2, "C"),
        types.Array(types.complex128, 2, "C"), _VECTOR, _VECTOR, _VECTOR,
        types.float64, types.int64, types.int64, types.boolean, _INDICES, _INDICES,
    ),
    cache=True,
    nogil=True,
)  # fmt: skip
def _follow_all(
    system: System,
    groups: Integers,
    y: Complex,
    low: Complex,
    start: Complex,
    end: Complex,
    bend: Complex,
    tolerance: float,
    most_steps: int,
    scratch: int,
    precise: bool,
    status: Integers,
    steps: Integers,
) -> None:
    """Follow all paths in place; ``status`` and ``steps`` receive the outcome of each."""
    for path in range(y.shape[0]):
        status[path], steps[path] = _follow(
            system, groups, y[path], low[path], start, end, bend, tolerance, most_steps, scratch, precise
        )


def follow(
    system: CompiledSystem,
    y: Complex,
    path: ParameterPath,
    *,
    tolerance: float = 5e-3,
    most_steps: int = 5000,
    threads: int = 1,
    precise: bool = False,
) -> PathEnds:
    """Follow solutions from one set of parameters to another.

    Parameters
    ----------
    system : CompiledSystem
        The equations.
    y : complex, shape (paths, n)
        Solutions at the start of the path.
    path : ParameterPath
        Path of the parameters.
    tolerance : float
        Maximum relative error of a prediction. A smaller one takes more steps but seldom jumps to another path.
    most_steps : int
        Number of steps after which an unfinished path is abandoned.
    threads : int
        Number of threads. Paths are independent, and the kernel releases the interpreter's lock.
    precise : bool
        Whether to compute the parameters in double-double precision, for a system that uses it.

    Returns
    -------
    PathEnds
        In the order of ``y``.
    """
    ends = np.array(y, np.complex128, order="C")
    low = np.zeros_like(ends)
    count = len(ends)
    status, steps = np.zeros(count, np.int64), np.zeros(count, np.int64)
    # Compiled kernels require contiguous arrays.
    start, end, bend = (np.ascontiguousarray(p, np.complex128) for p in path)

    def follow_chunk(first: int) -> None:
        # Slices of the same arrays: each thread writes its own rows.
        chunk = slice(first, first + CHUNK_SIZE)
        _follow_all(
            system.evaluate,
            system.groups,
            ends[chunk],
            low[chunk],
            start,
            end,
            bend,
            tolerance,
            most_steps,
            system.scratch,
            precise,
            status[chunk],
            steps[chunk],
        )

    if threads == 1:
        for first in range(0, count, CHUNK_SIZE):
            follow_chunk(first)
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(follow_chunk, range(0, count, CHUNK_SIZE)))
    return PathEnds(ends, low, status, steps)


def refine(system: CompiledSystem, y: Complex, low: Complex, p: Complex) -> tuple[Complex, Complex, Real]:
    """Refine approximate solutions at the parameters ``p`` by Newton's method.

    Returns
    -------
    y, low : complex, shape (solutions, n)
        The refined solutions and their rounding errors.
    moved : float, shape (solutions,)
        Relative size of the last step. After convergence it is about the rounding error times the condition number.
    """
    y, low = np.array(y, np.complex128, order="C"), np.array(low, np.complex128, order="C")
    moved = np.empty(len(y))
    p = np.ascontiguousarray(p, np.complex128)
    _refine_all(system.evaluate, system.groups, y, low, p, system.scratch, moved)
    return y, low, moved


def estimate_progress(way: int, share: float) -> float:
    """Return the progress of a search that may follow all paths several times, with ``share`` of run ``way`` done.

    The number of runs is not known in advance, so that each run takes a fixed share of the remaining progress; the
    progress therefore never decreases.

    >>> estimate_progress(0, 0.0), estimate_progress(0, 1.0), estimate_progress(1, 0.0)
    (0.0, 0.8, 0.8)
    """
    return 1.0 - MIN_REMAINING_SHARE**way * (1.0 - (1.0 - MIN_REMAINING_SHARE) * share)
