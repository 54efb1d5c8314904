"""Compiled evaluation of a sixbar from a descent: feasibility and quality in one number."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.kinds.motion.sixbar.candidate_value import (
    FIXED_BOX,
    JOINT_BOX,
    MAX_LENGTH,
    MAX_RATIO,
    MAX_REACH,
    MIN_BODY_TURN,
    MIN_LENGTH,
    MIN_LINK_LENGTH,
    MIN_SINE,
    MOVING_BOX,
    STEP_COUNT,
    evaluate_candidate,
    measure_angle,
    measure_outside,
)
from synthesis.kinds.motion.sixbar.dyad_assembly import Q2, STEPHENSON_2, J
from synthesis.kinds.motion.sixbar.residuals import (
    FIRST_X,
    FIRST_Y,
    INPUT_DIRECTION,
    JOINT_COORDINATE_COUNT,
    JOINT_PAIRS,
    P_INDEX,
    TOPOLOGY,
    compute_dimensions,
    drive_linkage,
)
from synthesis.verification.body_motion import compute_ease
from synthesis.verification.measures import compute_quality


class Poses(NamedTuple):
    """Target poses of the body, with sampled first poses within the first tolerance.

    Attributes
    ----------
    first : float, shape (n, 3)
        P and the body's angle in the first position; each linkage uses one row.
    later : float, shape (k, POSE.size)
        Later positions in the form of :data:`~synthesis.kinds.motion.sixbar.residuals.POSE`, with angles from the first
        target position.
    needed : float, shape (2,)
        Path length and rotation that the body needs at least.
    limits : float
        See :data:`synthesis.kinds.motion.sixbar.candidate_value.LIMITS`.
    cranks : complex, shape (m, 2)
        For five exact positions: the pins, in the first one, of all cranks between body and ground.
    """

    first: Real
    later: Real
    needed: Real
    limits: Real
    cranks: Complex


@njit(cache=True, nogil=True, error_model="numpy")
def evaluate_sixbar(x: Real, points: Real, setting: Real, poses: Poses, joints: Complex) -> float:
    """Return the value of a linkage that meets the positions; write its joints in the first one."""
    at, turns = np.empty(6, np.complex128), np.ones(4, np.complex128)
    places = len(points) + 1
    into, out = np.ones(places, np.complex128), np.ones(places, np.complex128)
    place, turn = np.empty(places, np.complex128), np.ones(places, np.complex128)
    demanded = np.ones(places, np.bool_)
    for j in range(7):
        joints[j] = complex(x[2 * j], x[2 * j + 1])
    lengths, inverses = np.empty(4), np.empty(4, np.complex128)
    compute_dimensions(joints, lengths, inverses)
    place[0] = complex(setting[FIRST_X], setting[FIRST_Y])
    angle = 0.0
    for k in range(1, places):
        angle += math.exp(x[JOINT_COORDINATE_COUNT + k - 1])
        drive_linkage(joints, lengths, inverses, setting, setting[INPUT_DIRECTION] * angle, at, turns)
        place[k], turn[k], into[k], out[k] = at[5], turns[3], turns[0], turns[2]
    make = int(setting[TOPOLOGY])
    # The general evaluation assumes a fourbar on the ground, which a Stephenson II lacks.
    if make == STEPHENSON_2:
        return _evaluate_stephenson_2(joints, lengths, inverses, setting, angle, poses)
    return float(evaluate_candidate(joints, make, into, out, place, turn, demanded, poses.needed, poses.limits))


@njit(cache=True, nogil=True, error_model="numpy")
def _evaluate_stephenson_2(
    joints: Complex, lengths: Real, inverses: Complex, setting: Real, angle: float, poses: Poses
) -> float:
    """Return the value of a Stephenson II, which has no fourbar with a Grashof class; full rotations are not checked.

    Negative values are degenerate (−3), not closing (−1) or turning more than once (−2); 1 and more is feasible.
    """
    limits, start = poses.limits, complex(setting[FIRST_X], setting[FIRST_Y])
    shortest, longest, reach = np.inf, 0.0, 0.0
    for i, k in JOINT_PAIRS[STEPHENSON_2]:
        # The list is padded with −1.
        if i < 0:
            break
        length = abs(joints[i] - (start if k == P_INDEX else joints[k]))
        reach = max(reach, length)
        # P belongs to the body, so its distances are no link lengths.
        if k != P_INDEX:
            shortest, longest = min(shortest, length), max(longest, length)
    if not shortest > MIN_LINK_LENGTH:
        return -3.0
    at, turns = np.empty(6, np.complex128), np.ones(4, np.complex128)
    flattest, beyond, input_turn, travelled, bent = 1.0, 0.0, 0.0, 0.0, 0.0
    input_before, body_before, place_before = 1.0 + 0.0j, 1.0 + 0.0j, start
    for n in range(STEP_COUNT + 1):
        cosine, other = drive_linkage(
            joints, lengths, inverses, setting, setting[INPUT_DIRECTION] * angle * n / STEP_COUNT, at, turns
        )
        # The linkage jams on the way, or passes a toggle of the triad.
        if not (abs(cosine) < 1.0 and abs(other) < 1.0):
            return -1.0
        flattest = min(flattest, math.sqrt((1.0 - cosine) * (1.0 + cosine)))
        for k in range(6):
            beyond = max(beyond, measure_outside(at[k], limits[JOINT_BOX]))
        input_turn += measure_angle(input_before, turns[0])
        bent += abs(measure_angle(body_before, turns[3]))
        travelled += abs(at[5] - place_before)
        input_before, body_before, place_before = turns[0], turns[3], at[5]
    # The input must not pass the same position twice.
    if not abs(input_turn) < 2.0 * math.pi:
        return -2.0
    ratio = longest / shortest
    over = max(reach / limits[MAX_REACH], ratio / limits[MAX_RATIO])
    over = max(over, limits[MIN_LENGTH] / shortest, longest / limits[MAX_LENGTH])
    for k in range(7):
        box = limits[FIXED_BOX] if k in (Q2, J) else limits[MOVING_BOX]
        beyond = max(beyond, measure_outside(joints[k], box))
    over = max(over, 1.0) + beyond
    # Below 1 the value grows towards feasibility, which guides the search.
    if not (flattest >= limits[MIN_SINE] and over <= 1.0):
        return float(min(flattest, 0.999) / over)
    excess = max(
        # Denominators have a floor, so that short motions do not exaggerate the excess.
        (travelled - poses.needed[0]) / max(poses.needed[0], 1.0),
        (bent - poses.needed[1]) / max(poses.needed[1], MIN_BODY_TURN),
    )
    return 1.0 + float(compute_ease(abs(input_turn), max(excess, 0.0)) * compute_quality(flattest, reach, ratio))
