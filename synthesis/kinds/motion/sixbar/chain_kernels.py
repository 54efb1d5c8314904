"""Compiled kernels for sixbars from planar 3R chains: the two constraining cranks, and the drive through the positions.

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

All of these consist of a fourbar O₂ A B O₄, driven by one of its ground links, and a dyad Q₁ J Q₂ on two of its links,
with the body on the first link of the dyad. The links that carry Q₁ and Q₂ define the topology (*make*).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from synthesis.kinds.motion.sixbar.relative_dyads import (
    JIT_OPTIONS,
    MAX_DYADS,
    compute_relative_poses,
    solve_relative_dyads,
)
from synthesis.verification.body_motion import compute_ease
from synthesis.verification.measures import compute_quality

POSITION_COUNT = 5

O2, A, B, O4, Q1, Q2, J = range(7)
"""Indices of a candidate's joints, in the first position."""

GROUND, INPUT, COUPLER, OUTPUT = range(4)
"""Links that may carry Q₁ and Q₂."""

TOPOLOGY_LINKS = np.array(
    [[COUPLER, INPUT], [COUPLER, OUTPUT], [COUPLER, GROUND], [INPUT, OUTPUT], [OUTPUT, INPUT], [INPUT, COUPLER],
     [OUTPUT, COUPLER], [COUPLER, GROUND]]
)  # fmt: skip
"""Links of Q₁ and of Q₂, by topology number. Only :mod:`synthesis.kinds.motion.sixbar.basin_hopping` uses the last
three: two that contain no 3R chain in the sense above, and the Stephenson II, which is described relative to its input
link (:mod:`synthesis.kinds.motion.sixbar.inversion`)."""

WATT_1_IN, WATT_1_OUT, STEPHENSON_3, STEPHENSON_1_IN, STEPHENSON_1_OUT, WATT_1_INVERTED_IN, WATT_1_INVERTED_OUT = range(
    7
)
STEPHENSON_2 = 7

LINK_PINS = np.array([[O2, O4], [O2, A], [A, B], [O4, B]])
"""Pins of each link of the fourbar."""

MIN_SINE, MAX_REACH, MAX_RATIO, MIN_LENGTH, MAX_LENGTH, GRASHOF_CLASS, FULL_TURN = range(7)
FIXED_BOX, MOVING_BOX, JOINT_BOX = 7, 11, 15
"""Indices of limits: minimum sine of a transmission angle; maximum distance of two joints of a link; maximum link
ratio; minimum and maximum link length; Grashof class of the fourbar; 1 if the input must rotate fully; boxes (x min,
x max, y min, y max) of the fixed pivots, of the moving ones in the first position, and of all joints during the motion.
Task coordinates."""

ANY_CLASS, CRANK_ROCKER, DOUBLE_CRANK, DOUBLE_ROCKER, NON_GRASHOF = range(5)
"""Required Grashof classes; a crank-rocker is driven by its crank."""

STEP_COUNT = 60
"""Number of drive steps from the first position to the last."""

MIN_LINK_LENGTH = 0.02
"""Minimum length of a usable link, in task sizes."""

INITIAL_STEP, MAX_STEP, MIN_STEP = 0.3, 0.6, 0.003
"""Standard deviation of a random step: initial, maximum, and the value at which the climb ends; task sizes, or shares
of a length."""

NOISE_STRIDE = 61
"""Offset between the steps of successive chains, which share one table of random numbers."""

MIN_BODY_TURN = math.radians(15.0)
"""Minimum body rotation, radians, in the denominator of the excess rotation, as in
:mod:`synthesis.verification.body_motion`."""


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
def place_on_link(
    link: int, point: complex, joints: Complex, a: complex, into: complex, through: complex, out: complex
) -> complex:
    """Return a point of a link of the fourbar after the rotations ``into``, ``through``, ``out`` of its links."""
    place = point
    if link == INPUT:
        place = joints[O2] + into * (point - joints[O2])
    elif link == COUPLER:
        place = a + through * (point - joints[A])
    elif link == OUTPUT:
        place = joints[O4] + out * (point - joints[O4])
    return place


@njit(**JIT_OPTIONS)
def close_dyad(pin: complex, other: complex, first: float, second: float, side: float) -> tuple[complex, float]:
    """Close a dyad: return the joint of two links on two pins; ``side`` is +1 to the left of the line between these.

    The second value is the cosine of the angle between the links; it is outside ±1 if they do not meet.
    """
    base = other - pin
    square = base.real * base.real + base.imag * base.imag
    cosine = (first * first + second * second - square) / (2.0 * first * second)
    # Negated, so that NaN counts as not closing.
    if not abs(cosine) < 1.0:
        return pin, cosine
    along, height = (
        0.5 * (first * first - second * second + square) / square,
        first * second * _compute_sine(cosine) / square,
    )
    return pin + base * complex(along, side * height), cosine


@njit(**JIT_OPTIONS)
def _compute_sine(cosine: float) -> float:
    """Return the sine of the angle between two links, or a negative measure of the gap if they do not meet."""
    return math.sqrt((1.0 - cosine) * (1.0 + cosine)) if abs(cosine) < 1.0 else 1.0 - abs(cosine)


@njit(**JIT_OPTIONS)
def compute_signed_sine(pin: complex, other: complex, joint: complex) -> float:
    """Return the sine of the angle between two links, negative if their joint is to the right of the pins' line."""
    one, two = joint - pin, joint - other
    return (one.conjugate() * two).imag / (abs(one) * abs(two))


@njit(**JIT_OPTIONS)
def find_input_run(input_turns: Complex, demanded: NDArray[np.bool_], inputs: Real) -> float:
    """Write the input rotations at the positions in one continuous run that meets the target positions in order.

    Returns
    -------
    float
        0 if there is such a run; otherwise a value down to −1, decreasing with the angle that the input reverses.
    """
    # The input may turn either way; the shorter run wins.
    best, shorter = -1.0, 2.0 * math.pi
    for way in (1.0, -1.0):
        at, back, before = 0.0, 0.0, input_turns[0]
        for k in range(1, len(demanded)):
            if demanded[k]:
                turned = measure_angle(before, input_turns[k]) * way
                # Backward steps must go round the long way; they are also summed as a measure of infeasibility.
                back += min(turned, 0.0)
                at += turned if turned >= 0.0 else turned + 2.0 * math.pi
                before = input_turns[k]
        # More than one turn in total is infeasible, too, but less so the closer it is to a turn.
        best = max(best, (back if back < 0.0 else 2.0 * math.pi - at) / (math.pi * len(demanded)))
        if at >= shorter:
            continue
        shorter, at, before = at, 0.0, input_turns[0]
        for k in range(1, len(demanded)):
            if demanded[k]:
                turned = measure_angle(before, input_turns[k]) * way
                at += turned if turned >= 0.0 else turned + 2.0 * math.pi
                before, inputs[k] = input_turns[k], way * at
    return 0.0 if shorter < 2.0 * math.pi else min(best, 0.0)


@njit(**JIT_OPTIONS)
def measure_angle(before: complex, after: complex) -> float:
    """Return the angle from one direction to another, radians, −π to π."""
    step = after * before.conjugate()
    return math.atan2(step.imag, step.real)


@njit(**JIT_OPTIONS)
def measure_outside(point: complex, box: Real) -> float:
    """Return the distance of a point from a box; 0 inside."""
    across = max(box[0] - point.real, point.real - box[1], 0.0)
    return math.hypot(across, max(box[2] - point.imag, point.imag - box[3], 0.0))


@njit(**JIT_OPTIONS)
def _measure_class_gap(lengths: Real, wanted: float) -> float:
    """Return a fourbar's distance from a Grashof class, as a share of the sum of its links; 0 within the class.

    ``lengths`` are input, coupler, output, ground.
    """
    total, shortest, longest = lengths.sum(), lengths.min(), lengths.max()
    # Shortest plus longest over the mean of all pairs: positive if not Grashof.
    over = 2.0 * (shortest + longest) / total - 1.0
    if wanted == NON_GRASHOF:
        return float(max(-over, 0.0))
    # The link that must be the shortest in this class.
    own = lengths[0] if wanted == CRANK_ROCKER else (lengths[3] if wanted == DOUBLE_CRANK else lengths[1])
    return float(max(over, 0.0) + (own - shortest) / total)


@njit(**JIT_OPTIONS)
def _measure_rotation_gap(
    joints: Complex, c1: int, c2: int, lengths: Real, first_side: float, second_side: float
) -> float:
    """Return 0 if the input rotates fully, otherwise a negative measure of the gaps over a full turn."""
    missing = 0.0
    for n in range(STEP_COUNT):
        angle = 2.0 * math.pi * n / STEP_COUNT
        into = complex(math.cos(angle), math.sin(angle))
        a = joints[O2] + into * (joints[A] - joints[O2])
        b, cosine = close_dyad(a, joints[O4], lengths[1], lengths[2], first_side)
        sine = _compute_sine(cosine)
        # Far from closing counts at least one full unit, so that the sum measures the missing part of the turn.
        if sine <= 0.0:
            missing += sine - 1.0
            continue
        through, out = (b - a) / (joints[B] - joints[A]), (b - joints[O4]) / (joints[B] - joints[O4])
        one = place_on_link(c1, joints[Q1], joints, a, into, through, out)
        two = place_on_link(c2, joints[Q2], joints, a, into, through, out)
        missing += min(_compute_sine(close_dyad(one, two, lengths[4], lengths[5], second_side)[1]), 0.0)
    return missing / STEP_COUNT


@njit(**JIT_OPTIONS)
def _measure_links(joints: Complex, c1: int, c2: int, tip: complex, lengths: Real) -> tuple[float, float, float]:
    """Write the lengths of the dyads' links; return the shortest and longest link, and the reach with P (``tip``)."""
    lengths[0], lengths[1] = abs(joints[A] - joints[O2]), abs(joints[B] - joints[A])
    lengths[2], lengths[3] = abs(joints[B] - joints[O4]), abs(joints[O4] - joints[O2])
    lengths[4], lengths[5] = abs(joints[J] - joints[Q1]), abs(joints[J] - joints[Q2])
    shortest, longest = lengths.min(), lengths.max()
    # The reach covers P, the ratio below only pins: P is a point of the body, not a pin.
    reach = max(longest, abs(tip - joints[Q1]), abs(tip - joints[J]))
    for n in range(2):
        link, point = (c1, joints[Q1]) if n == 0 else (c2, joints[Q2])
        one, two = LINK_PINS[link, 0], LINK_PINS[link, 1]
        near, far = abs(point - joints[one]), abs(point - joints[two])
        shortest, longest = min(shortest, near, far), max(longest, near, far)
    reach = max(reach, longest)
    return shortest, longest, reach


@njit(**JIT_OPTIONS)
def _drive_to_last(
    joints: Complex, c1: int, c2: int, lengths: Real, point: complex, last: float, first_side: float,
    second_side: float, flattest: float, limits: Real,
) -> tuple[float, float, float, float, float]:  # fmt: skip
    """Drive from the first position to the last, and look for toggles between the targets.

    Returns
    -------
    flattest : float
        Minimum sine of a transmission angle, at most the given one.
    beyond : float
        Sum of what closures lack.
    travelled, turned : float
        Path of P and rotation of the body.
    outside : float
        Greatest distance of a joint from its box.
    """
    beyond = 0.0
    travelled = turned = outside = 0.0
    place_before, turn_before = point, 1.0 + 0.0j
    for n in range(1, STEP_COUNT + 1):
        rotation = last * n / STEP_COUNT
        into = complex(math.cos(rotation), math.sin(rotation))
        a = joints[O2] + into * (joints[A] - joints[O2])
        b, cosine = close_dyad(a, joints[O4], lengths[1], lengths[2], first_side)
        sine = _compute_sine(cosine)
        flattest = min(flattest, sine)
        if sine <= 0.0:
            # A dyad that does not close leaves the positions of the others undefined: continue with the next step.
            beyond += 2.0 * sine - 1.0
            continue
        through, out = (b - a) / (joints[B] - joints[A]), (b - joints[O4]) / (joints[B] - joints[O4])
        one = place_on_link(c1, joints[Q1], joints, a, into, through, out)
        two = place_on_link(c2, joints[Q2], joints, a, into, through, out)
        j, cosine = close_dyad(one, two, lengths[4], lengths[5], second_side)
        sine = _compute_sine(cosine)
        flattest, beyond = min(flattest, sine), beyond + min(sine, 0.0)
        # Once a toggle was passed, path and rotation have no meaning.
        if flattest <= 0.0:
            continue
        body = (j - one) / (joints[J] - joints[Q1])
        p = one + body * (point - joints[Q1])
        outside = max(
            outside,
            measure_outside(a, limits[JOINT_BOX:]),
            measure_outside(b, limits[JOINT_BOX:]),
            measure_outside(one, limits[JOINT_BOX:]),
        )
        outside = max(
            outside,
            measure_outside(two, limits[JOINT_BOX:]),
            measure_outside(j, limits[JOINT_BOX:]),
            measure_outside(p, limits[JOINT_BOX:]),
        )
        travelled += abs(p - place_before)
        turned += abs(measure_angle(turn_before, body))
        place_before, turn_before = p, body
    return flattest, beyond, travelled, turned, outside


@njit(**JIT_OPTIONS)
def _measure_other_assembly(
    joints: Complex, c1: int, c2: int, points: Complex, turns: Complex, input_turns: Complex, output_turns: Complex,
    inputs: Real, demanded: NDArray[np.bool_], first_side: float, second_side: float,
) -> tuple[float, float]:  # fmt: skip
    """Return the sum of sines, not positive, of dyads in another assembly at a target, and the last input."""
    other, last = 0.0, 0.0
    for k in range(1, len(points)):
        if not demanded[k]:
            continue
        last = inputs[k]
        into, out = input_turns[k], output_turns[k]
        a, b = joints[O2] + into * (joints[A] - joints[O2]), joints[O4] + out * (joints[B] - joints[O4])
        through = (b - a) / (joints[B] - joints[A])
        one, two = (
            place_on_link(c1, joints[Q1], joints, a, into, through, out),
            place_on_link(c2, joints[Q2], joints, a, into, through, out),
        )
        # Both dyads must be on the same side at every target; wrong ones are summed as a guide for the climb.
        j = points[k] + turns[k] * (joints[J] - points[0])
        other += min(first_side * compute_signed_sine(a, joints[O4], b), 0.0)
        other += min(second_side * compute_signed_sine(one, two, j), 0.0)
    return other, last


@njit(**JIT_OPTIONS)
def _measure_outside_boxes(joints: Complex, c2: int, outside: float, limits: Real) -> float:
    """Return the greatest distance of a joint from its box in the first position, at least the given one."""
    for joint in range(7):
        fixed = joint in (O2, O4) or (joint == Q2 and c2 == GROUND)
        outside = max(
            outside,
            measure_outside(joints[joint], limits[FIXED_BOX:MOVING_BOX] if fixed else limits[MOVING_BOX:JOINT_BOX]),
        )
    return outside


@njit(**JIT_OPTIONS)
def evaluate_candidate(
    joints: Complex,
    make: int,
    input_turns: Complex,
    output_turns: Complex,
    points: Complex,
    turns: Complex,
    demanded: NDArray[np.bool_],
    needed: Real,
    limits: Real,
) -> float:
    """Evaluate a candidate's feasibility and quality.

    Returns
    -------
    float
        From 1 on: feasible, with the quality added. From 0 on: it moves through all positions; the value is the sine of
        the minimum transmission angle, reduced by violated size limits. From −1: it passes a toggle. From −2: not all
        positions belong to one assembly. From −3: the input reverses, or a link is too short.
    """
    c1, c2 = TOPOLOGY_LINKS[make, 0], TOPOLOGY_LINKS[make, 1]
    lengths = np.empty(6)
    shortest, longest, reach = _measure_links(joints, c1, c2, points[0], lengths)
    if not shortest > MIN_LINK_LENGTH:
        return -3.0
    inputs = np.zeros(len(points))
    back: float = find_input_run(input_turns, demanded, inputs)
    if back < 0.0:
        return -2.0 + back
    # The signed sine between two links is positive exactly if their joint is to the left of the pins' line.
    first_sine = compute_signed_sine(joints[A], joints[O4], joints[B])
    second_sine = compute_signed_sine(joints[Q1], joints[Q2], joints[J])
    # Assemblies of the first position, which all others must share.
    first_side, second_side = math.copysign(1.0, first_sine), math.copysign(1.0, second_sine)
    other, last = _measure_other_assembly(
        joints, c1, c2, points, turns, input_turns, output_turns, inputs, demanded, first_side, second_side
    )
    if other < 0.0:
        return float(-1.0 + other / (2.0 * len(points)))
    # Drive from the first position to the last: toggles may lie between the targets.
    flattest = min(abs(first_sine), abs(second_sine))
    flattest, beyond, travelled, turned, outside = _drive_to_last(
        joints, c1, c2, lengths, points[0], last, first_side, second_side, flattest, limits
    )
    if flattest <= 0.0:
        # Map the accumulated gap to (−1, 0): smaller gaps guide the climb towards a motion without toggles.
        beyond /= STEP_COUNT
        return float(beyond / (1.0 - beyond))
    ratio = longest / shortest
    # All size limits as ratios: the largest one measures the violation.
    over = max(reach / limits[MAX_REACH], ratio / limits[MAX_RATIO])
    over = max(over, limits[MIN_LENGTH] / shortest, longest / limits[MAX_LENGTH])
    # Ratios below 1 are satisfied and must not compensate violations of boxes.
    over = max(over, 1.0) + _measure_outside_boxes(joints, c2, outside, limits)
    if limits[GRASHOF_CLASS] != ANY_CLASS:
        over += _measure_class_gap(lengths[:4], limits[GRASHOF_CLASS])
    if limits[FULL_TURN]:
        over -= _measure_rotation_gap(joints, c1, c2, lengths, first_side, second_side)
    # The cap at 0.999 keeps infeasible candidates below 1, where feasible ones begin.
    if not (flattest >= limits[MIN_SINE] and over <= 1.0):
        return float(min(flattest, 0.999) / over)
    excess = max((travelled - needed[0]) / max(needed[0], 1.0), (turned - needed[1]) / max(needed[1], MIN_BODY_TURN))
    return 1.0 + compute_ease(abs(last), max(excess, 0.0)) * compute_quality(flattest, reach, ratio)


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
    wanted : bool, shape (8,)
        Mask of the requested topologies.
    limits : float, shape (19,)
        See :data:`MIN_SINE`.
    """

    points: Complex
    turns: Complex
    demanded: NDArray[np.bool_]
    needed: Real
    wanted: NDArray[np.bool_]
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
    points, turns, wanted, found = given[0][n], given[1][n], given.wanted, results.found
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
    if wanted[STEPHENSON_3] or wanted[STEPHENSON_1_IN]:
        compute_relative_poses(still, upright, place[2], turn[2], shift, spin)
        with_m = solve_relative_dyads(shift, spin, none, none, fixed[0], moving[0])
    if wanted[WATT_1_IN]:
        # Between link 1 and M, link 2 itself is a dyad and is excluded.
        compute_relative_poses(place[0], turn[0], place[2], turn[2], shift, spin)
        with_1 = solve_relative_dyads(shift, spin, knee, pin, fixed[1], moving[1])
    if wanted[WATT_1_IN] or wanted[STEPHENSON_3]:
        compute_relative_poses(still, upright, place[1], turn[1], shift, spin)
        for i in range(solve_relative_dyads(shift, spin, pivot, knee, fixed[2], moving[2])):
            _compute_crank_poses(fixed[2, i], moving[2, i], still, upright, place[1], turn[1], place[3], turn[3])
            # The three rows of the table above: to the ground, to link 1, to the crank itself.
            for sort in range(3):
                count = with_m if sort == 0 else with_1
                if sort == 2:
                    compute_relative_poses(place[3], turn[3], place[2], turn[2], shift, spin)
                    count = 0
                    if wanted[WATT_1_IN]:
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
                        if wanted[make]:
                            _try_input(bar, make, driver, turn, n, given, results)
    # Stephenson I: the second crank joins the first one to link 1 of the chain.
    if wanted[STEPHENSON_1_IN]:
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
