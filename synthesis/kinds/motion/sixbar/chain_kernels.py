"""Compiled search of sixbars from planar 3R chains: the two constraining cranks, and the climb of the best chains.

A chain G–H₁–H₂ carries the body M at H₂; for each of five positions the given side of the elbow determines its links 1
and 2. Two more cranks leave it one freedom (Soh & McCarthy, Mech. Mach. Theory 43 (2008) 160,
doi:10.1016/j.mechmachtheory.2006.11.004). Each crank is a dyad between two bodies with known poses, and itself becomes
a body with known poses:

    ground–2, then 1–M             Watt I
    ground–2, then its crank–M     Watt I
    ground–2, then ground–M        Stephenson III
    ground–M, then its crank–1     Stephenson I

Between bodies that one link of the chain joins, that link itself is one of the four dyads, so at least one other is
real: every chain gives a Watt I.

The body is on the first link of the dyad Q₁ J Q₂ (:mod:`synthesis.kinds.motion.sixbar.dyad_assembly`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from synthesis.kinds.motion.sixbar.candidate_value import evaluate_candidate
from synthesis.kinds.motion.sixbar.dyad_assembly import (
    O2,
    O4,
    Q1,
    Q2,
    STEPHENSON_1_IN,
    STEPHENSON_1_OUT,
    STEPHENSON_3,
    WATT_1_IN,
    WATT_1_OUT,
    A,
    B,
    J,
)
from synthesis.kinds.motion.sixbar.relative_dyads import (
    JIT_OPTIONS,
    MAX_DYADS,
    compute_relative_poses,
    solve_relative_dyads,
)

POSITION_COUNT = 5

INITIAL_STEP, MAX_STEP, MIN_STEP = 0.3, 0.6, 0.003
"""Standard deviation of a random step: initial, maximum, and the value at which the climb ends; task sizes, or shares
of a length."""

NOISE_STRIDE = 61
"""Offset between the steps of successive chains, which share one table of random numbers."""


@njit(**JIT_OPTIONS)
def _move_point(point: complex, place: Complex, turn: Complex, k: int) -> complex:
    carried: complex = place[k] + turn[k] * (point - place[0])
    return carried


@njit(**JIT_OPTIONS)
def _compute_crank_poses(
    fixed: complex,
    moving: complex,
    one: Complex,
    one_turn: Complex,
    other: Complex,
    other_turn: Complex,
    place: Complex,
    turn: Complex,
) -> None:
    """Compute the poses of a link that is pinned to two bodies."""
    for k in range(POSITION_COUNT):
        place[k] = _move_point(fixed, one, one_turn, k)
        turn[k] = _move_point(moving, other, other_turn, k) - place[k]
    # Rotations count from the first position.
    first = turn[0]
    for k in range(POSITION_COUNT):
        turn[k] /= first


@njit(**JIT_OPTIONS)
def compute_chain_poses(
    points: Complex,
    turns: Complex,
    pivot: complex,
    pin: complex,
    first: float,
    second: float,
    elbow: float,
    place: Complex,
    turn: Complex,
) -> bool:
    """Compute the poses (3, 5) of the chain's links 1 and 2 and of the body; return False if it does not reach.

    ``elbow`` is +1 if H₁ lies to the left of the line from G to H₂.
    """
    for k in range(POSITION_COUNT):
        place[2, k], turn[2, k] = points[k], turns[k]
        end = points[k] + turns[k] * (pin - points[0])
        reach = end - pivot
        square = reach.real * reach.real + reach.imag * reach.imag
        # The law of cosines, divided by the squared reach: the knee's place along the line from G to H₂.
        along = (first * first - second * second + square) / (2.0 * square)
        height = first * first / square - along * along
        # The links are too short or too long for this position; also true for NaN.
        if not height > 0.0:
            return False
        knee = pivot + reach * complex(along, elbow * math.sqrt(height))
        place[0, k], turn[0, k] = pivot, knee - pivot
        place[1, k], turn[1, k] = knee, end - knee
    for link in range(2):
        start = turn[link, 0]
        for k in range(POSITION_COUNT):
            turn[link, k] /= start
    return True


@njit(**JIT_OPTIONS)
def _record_candidate(
    bar: Complex,
    make: int,
    value: float,
    joints: Complex,
    makes: Integers,
    scores: Real,
    found: Real,
    owners: Integers,
) -> None:
    """Record a candidate: update the chain's best value, and store it if it moves through all positions.

    Infeasible candidates may use only half of the rows, so that feasible ones always find space.
    """
    if value > found[0]:
        found[0] = value
    n = int(found[1])
    # Infeasible candidates are kept as a fallback, but never fill the array.
    if n < (len(makes) if value >= 1.0 else (len(makes) // 2 if value > 0.0 else 0)):
        joints[n], makes[n], scores[n], owners[n] = bar, make, value, int(found[3])
        found[1] = n + 1
    found[2] += 1


class ChainConstraints(NamedTuple):
    """Constraints of a chain search.

    Attributes
    ----------
    points, turns : complex, shape (n, 5)
        Poses of the body for each chain.
    demanded : bool, shape (5,)
        Mask of the target positions; the others only help to find dyads.
    needed : float, shape (2,)
        Path length and rotation that the body needs at least.
    requested : bool, shape (8,)
        Mask of the requested topologies.
    limits : float
        See :data:`synthesis.kinds.motion.sixbar.candidate_value.LIMITS`.
    """

    points: Complex
    turns: Complex
    demanded: NDArray[np.bool_]
    needed: Real
    requested: NDArray[np.bool_]
    limits: Real


class ChainResults(NamedTuple):
    """Output arrays of a chain search.

    Attributes
    ----------
    joints, makes, scores
        Candidates that move through all positions, with their values: shapes (most, 7), (most,), (most,). Infeasible
        ones fill at most half of the rows.
    found : float, shape (4,)
        Best value of the last chain; number of filled rows; total number of candidates; number of the chain.
    owners : int, shape (most,)
        The chain of each row.
    """

    joints: Complex
    makes: Integers
    scores: Real
    found: Real
    owners: Integers


@njit(**JIT_OPTIONS)
def _try_input(
    bar: Complex, make: int, driver: int, turn: Complex, n: int, given: ChainConstraints, results: ChainResults
) -> None:
    """Evaluate and record a sixbar of chain n; ``driver``: 0 if link 1 of the chain is the input, 1 if the crank."""
    every_points, every_turns, demanded, needed, _, limits = given
    joints, makes, scores, found, owners = results
    if driver:
        bar[A], bar[B], bar[O2], bar[O4] = bar[B], bar[A], bar[O4], bar[O2]
    value = evaluate_candidate(
        bar, make, turn[3 * driver], turn[3 - 3 * driver], every_points[n], every_turns[n], demanded, needed, limits
    )
    _record_candidate(bar, make, value, joints, makes, scores, found, owners)


@njit(**JIT_OPTIONS)
def evaluate_chain(chain: Real, n: int, given: ChainConstraints, results: ChainResults) -> float:
    """Evaluate all sixbars of one chain; return the value of the best (:func:`evaluate_candidate`).

    Parameters
    ----------
    chain : float, shape (7,)
        Ground pivot G and H₂ in the first position, x and y; lengths of the two links; elbow.
    n : int
        Number of the chain.
    given, results
        Constraints and output.
    """
    points, turns, requested, found = given[0][n], given[1][n], given.requested, results.found
    found[3] = n
    # Lower than any value of a candidate.
    found[0] = -4.0
    place, turn = np.empty((4, POSITION_COUNT), np.complex128), np.empty((4, POSITION_COUNT), np.complex128)
    pivot, pin = complex(chain[0], chain[1]), complex(chain[2], chain[3])
    if not compute_chain_poses(points, turns, pivot, pin, chain[4], chain[5], chain[6], place, turn):
        return float(found[0])
    still, upright = np.zeros(POSITION_COUNT, np.complex128), np.ones(POSITION_COUNT, np.complex128)
    shift, spin = np.empty(POSITION_COUNT, np.complex128), np.empty(POSITION_COUNT, np.complex128)
    fixed, moving = np.empty((4, MAX_DYADS), np.complex128), np.empty((4, MAX_DYADS), np.complex128)
    none, knee = complex(math.nan, math.nan), place[1, 0]
    bar = np.empty(7, np.complex128)
    # Dyads on body M are shared by several types; compute them once per chain.
    with_m = with_1 = 0
    if requested[STEPHENSON_3] or requested[STEPHENSON_1_IN]:
        compute_relative_poses(still, upright, place[2], turn[2], shift, spin)
        with_m = solve_relative_dyads(shift, spin, none, none, fixed[0], moving[0])
    if requested[WATT_1_IN]:
        # Between link 1 and M, link 2 itself is a dyad and is excluded.
        compute_relative_poses(place[0], turn[0], place[2], turn[2], shift, spin)
        with_1 = solve_relative_dyads(shift, spin, knee, pin, fixed[1], moving[1])
    if requested[WATT_1_IN] or requested[STEPHENSON_3]:
        compute_relative_poses(still, upright, place[1], turn[1], shift, spin)
        for i in range(solve_relative_dyads(shift, spin, pivot, knee, fixed[2], moving[2])):
            _compute_crank_poses(fixed[2, i], moving[2, i], still, upright, place[1], turn[1], place[3], turn[3])
            # The three rows of the table above: to the ground, to link 1, to the crank itself.
            for sort in range(3):
                count = with_m if sort == 0 else with_1
                if sort == 2:
                    compute_relative_poses(place[3], turn[3], place[2], turn[2], shift, spin)
                    count = 0
                    if requested[WATT_1_IN]:
                        count = solve_relative_dyads(shift, spin, moving[2, i], pin, fixed[3], moving[3])
                for second in range(count):
                    row = 0 if sort == 0 else (1 if sort == 1 else 3)
                    # Try both inputs: the chain's link 1, or the crank.
                    for driver in range(2):
                        bar[B], bar[O2], bar[O4] = moving[2, i], pivot, fixed[2, i]
                        bar[A], bar[Q1], bar[Q2], bar[J] = knee, pin, fixed[row, second], moving[row, second]
                        make = (
                            STEPHENSON_3 if sort == 0 else (WATT_1_IN if (sort == 1) == (driver == 0) else WATT_1_OUT)
                        )
                        if requested[make]:
                            _try_input(bar, make, driver, turn, n, given, results)
    # Stephenson I: the second crank joins the first one to link 1 of the chain.
    if requested[STEPHENSON_1_IN]:
        for i in range(with_m):
            _compute_crank_poses(fixed[0, i], moving[0, i], still, upright, place[2], turn[2], place[3], turn[3])
            compute_relative_poses(place[3], turn[3], place[0], turn[0], shift, spin)
            for second in range(solve_relative_dyads(shift, spin, fixed[0, i], pivot, fixed[3], moving[3])):
                for driver in range(2):
                    bar[A], bar[B], bar[O2], bar[O4] = moving[3, second], fixed[3, second], pivot, fixed[0, i]
                    bar[Q1], bar[Q2], bar[J] = moving[0, i], knee, pin
                    make = STEPHENSON_1_IN if driver else STEPHENSON_1_OUT
                    _try_input(bar, make, driver, turn, n, given, results)
    return float(found[0])


@njit(**JIT_OPTIONS)
def search_chains(
    chains: Real, noise: Real, climbing: int, given: ChainConstraints, results: ChainResults, values: Real
) -> None:
    """Evaluate chains, and improve the best of them by random steps (a stochastic hill climb).

    Parameters
    ----------
    chains : float, shape (n, 7)
        Replaced in place by better ones.
    noise : float, shape (steps, 6)
        Random steps, 0 for given values; scaled down after failures and up after successes.
    climbing : int
        Number of chains that are improved.
    given, results
        Constraints and output.
    values : float, shape (n,)
        Output: value of each chain.
    """
    tried, order = np.empty(7), np.zeros(len(chains), np.bool_)
    for n in range(len(chains)):
        values[n] = evaluate_chain(chains[n], n, given, results)
    # Rank by the values before climbing, so that the order does not change on the way.
    before = values.copy()
    for m in range(climbing):
        n = -1
        for k in range(len(chains)):
            if not order[k] and (n < 0 or before[k] > before[n]):
                n = k
        order[n] = True
        size = INITIAL_STEP
        for k in range(len(noise)):
            # A stride through one table: cheaper than new random numbers, and different for each chain.
            step = noise[(m * NOISE_STRIDE + k) % len(noise)]
            tried[:] = chains[n]
            # Coordinates change by steps, lengths by factors, so that they stay positive.
            tried[:4] += size * step[:4]
            tried[4] *= math.exp(0.5 * size * step[4])
            tried[5] *= math.exp(0.5 * size * step[5])
            value = evaluate_chain(tried, n, given, results)
            if value > values[n]:
                values[n], chains[n] = value, tried
                # Grow after success, shrink slowly after failure: about one success in seven keeps the size constant.
                size = min(1.7 * size, MAX_STEP)
            else:
                size *= 0.93
                if size < MIN_STEP:
                    break
