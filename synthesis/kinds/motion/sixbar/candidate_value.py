"""Values of sixbar candidates: how far they move through the positions, and how good their motion is.

A candidate is given by its joints in the first position and by the rotations of its input and output at the positions.
It is driven from the first position to the last, which finds toggles and collisions with boxes on the way.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.kinds.motion.sixbar.dyad_assembly import (
    GROUND,
    LINK_PINS,
    O2,
    O4,
    Q1,
    Q2,
    TOPOLOGY_LINKS,
    A,
    B,
    J,
    close_dyad,
    compute_signed_sine,
    compute_sine,
    place_on_link,
)
from synthesis.kinds.motion.sixbar.relative_dyads import JIT_OPTIONS
from synthesis.numerics.array_layout import ArrayLayout
from synthesis.verification.body_motion import SMALL_BODY_TURN, compute_ease
from synthesis.verification.measures import compute_quality

LIMITS = ArrayLayout(
    min_sine=1,
    max_reach=1,
    max_ratio=1,
    min_length=1,
    max_length=1,
    grashof_class=1,
    full_turn=1,
    fixed_box=4,
    moving_box=4,
    joint_box=4,
)
"""Limits on a sixbar, in task coordinates."""

MIN_SINE = LIMITS.index("min_sine")
"""Minimum sine of a transmission angle."""

MAX_REACH = LIMITS.index("max_reach")
"""Maximum distance of two joints of a link."""

MAX_RATIO = LIMITS.index("max_ratio")
"""Maximum link ratio."""

MIN_LENGTH, MAX_LENGTH = LIMITS.index("min_length"), LIMITS.index("max_length")
"""Minimum and maximum link length."""

GRASHOF_CLASS = LIMITS.index("grashof_class")
"""Grashof class of the fourbar."""

FULL_TURN = LIMITS.index("full_turn")
"""1 if the input must rotate fully."""

FIXED_BOX, MOVING_BOX = LIMITS.slice("fixed_box"), LIMITS.slice("moving_box")
"""Boxes (x min, x max, y min, y max) of the fixed pivots, and of the moving ones in the first position."""

JOINT_BOX = LIMITS.slice("joint_box")
"""Box of all joints during the motion."""

BOXES = LIMITS.slice("fixed_box", "joint_box")
"""All boxes."""

ANY_CLASS, CRANK_ROCKER, DOUBLE_CRANK, DOUBLE_ROCKER, NON_GRASHOF = range(5)
"""Required Grashof classes; a crank-rocker is driven by its crank."""

STEP_COUNT = 60
"""Number of drive steps from the first position to the last."""

MIN_LINK_LENGTH = 0.02
"""Minimum length of a usable link, in task sizes."""


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
def _measure_class_gap(lengths: Real, grashof_class: float) -> float:
    """Return a fourbar's distance from a Grashof class, as a share of the sum of its links; 0 within the class.

    ``lengths`` are input, coupler, output, ground.
    """
    total, shortest, longest = lengths.sum(), lengths.min(), lengths.max()
    # Shortest plus longest over the mean of all pairs: positive if not Grashof.
    over = 2.0 * (shortest + longest) / total - 1.0
    if grashof_class == NON_GRASHOF:
        return float(max(-over, 0.0))
    # The link that must be the shortest in this class.
    own = lengths[0] if grashof_class == CRANK_ROCKER else (lengths[3] if grashof_class == DOUBLE_CRANK else lengths[1])
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
        sine = compute_sine(cosine)
        # Far from closing counts at least one full unit, so that the sum measures the missing part of the turn.
        if sine <= 0.0:
            missing += sine - 1.0
            continue
        through, out = (b - a) / (joints[B] - joints[A]), (b - joints[O4]) / (joints[B] - joints[O4])
        one = place_on_link(c1, joints[Q1], joints, a, into, through, out)
        two = place_on_link(c2, joints[Q2], joints, a, into, through, out)
        missing += min(compute_sine(close_dyad(one, two, lengths[4], lengths[5], second_side)[1]), 0.0)
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
    """Drive from the first position to the last, and find toggles between the targets.

    Returns
    -------
    flattest : float
        Minimum sine of a transmission angle, at most the given one.
    beyond : float
        Sum of the gaps of dyads that do not close.
    travelled, turned : float
        Path of P and rotation of the body.
    outside : float
        Maximum distance of a joint from its box.
    """
    beyond = 0.0
    travelled = turned = outside = 0.0
    place_before, turn_before = point, 1.0 + 0.0j
    for n in range(1, STEP_COUNT + 1):
        rotation = last * n / STEP_COUNT
        into = complex(math.cos(rotation), math.sin(rotation))
        a = joints[O2] + into * (joints[A] - joints[O2])
        b, cosine = close_dyad(a, joints[O4], lengths[1], lengths[2], first_side)
        sine = compute_sine(cosine)
        flattest = min(flattest, sine)
        if sine <= 0.0:
            # A dyad that does not close leaves the positions of the others undefined: continue with the next step.
            beyond += 2.0 * sine - 1.0
            continue
        through, out = (b - a) / (joints[B] - joints[A]), (b - joints[O4]) / (joints[B] - joints[O4])
        one = place_on_link(c1, joints[Q1], joints, a, into, through, out)
        two = place_on_link(c2, joints[Q2], joints, a, into, through, out)
        j, cosine = close_dyad(one, two, lengths[4], lengths[5], second_side)
        sine = compute_sine(cosine)
        flattest, beyond = min(flattest, sine), beyond + min(sine, 0.0)
        # Once a toggle was passed, path and rotation have no meaning.
        if flattest <= 0.0:
            continue
        body = (j - one) / (joints[J] - joints[Q1])
        p = one + body * (point - joints[Q1])
        outside = max(
            outside,
            measure_outside(a, limits[JOINT_BOX]),
            measure_outside(b, limits[JOINT_BOX]),
            measure_outside(one, limits[JOINT_BOX]),
        )
        outside = max(
            outside,
            measure_outside(two, limits[JOINT_BOX]),
            measure_outside(j, limits[JOINT_BOX]),
            measure_outside(p, limits[JOINT_BOX]),
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
    """Return the maximum distance of a joint from its box in the first position, at least the given one."""
    for joint in range(7):
        fixed = joint in (O2, O4) or (joint == Q2 and c2 == GROUND)
        outside = max(
            outside,
            measure_outside(joints[joint], limits[FIXED_BOX] if fixed else limits[MOVING_BOX]),
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
    excess = max((travelled - needed[0]) / max(needed[0], 1.0), (turned - needed[1]) / max(needed[1], SMALL_BODY_TURN))
    return 1.0 + compute_ease(abs(last), max(excess, 0.0)) * compute_quality(flattest, reach, ratio)
