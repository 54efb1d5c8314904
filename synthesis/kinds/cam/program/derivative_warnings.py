"""Warnings about the cost of a criterion: peaks of derivatives many times as high as those of a plain law.

The motion of minimum peak acceleration jumps from one acceleration to another, so that its jerk is only bounded by the
grid on which it was found. The motion of minimum peak velocity has such jumps in its velocity. Each move between rests
is compared with the cycloidal move of equal lift and angle (Norton, *Cam Design and Manufacturing Handbook*,
Table 2-2), which has no jump in its acceleration.
"""

from __future__ import annotations

from functools import reduce

from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.segments import build_law_segment
from kinematics.message import compose, make_sentence
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.program.composition import Composition
from synthesis.kinds.cam.statement.segments import Move

PLAIN_LAW = "cycloidal"

MAX_PEAK_RATIO = 10.0
"""Multiple of the plain law's peak above which a warning is given. Common laws stay below six."""

REST_TOLERANCE = 1e-9
"""Maximum velocity at an end, as a share of the peak, of a move that begins or ends at rest."""

DERIVATIVES = ((1, "velocity"), (2, "acceleration"), (3, "jerk"))


def find_excesses(problem: CamProblem, composed: Composition) -> dict[str, float]:
    """Return excessive peaks by name, as multiples of the plain law's, for moves with a law chosen by the criterion."""
    found: dict[str, float] = {}
    for stated, segment in zip(problem.segments, composed.program.segments, strict=True):
        if not isinstance(stated, Move) or not stated.follows_criterion:
            continue
        first, last = segment.pieces.motion(0.0), segment.pieces.motion(segment.angle, before=True)
        moving = max(abs(float(first.v)), abs(float(last.v)))
        # A plain law starts and ends at rest, so that other moves cannot be compared with it.
        if moving > REST_TOLERANCE * segment.extremes(1).largest:
            continue
        plain = build_law_segment(LAWS[PLAIN_LAW], segment.angle, float(first.s), float(last.s))
        for order, name in DERIVATIVES:
            times = segment.extremes(order).largest / plain.extremes(order).largest
            if times >= MAX_PEAK_RATIO:
                found[name] = max(times, found.get(name, 0.0))
    return found


def describe_excesses(problem: CamProblem, composed: Composition) -> str | None:
    """Describe the excessive peaks in a sentence; None if there are none."""
    found = find_excesses(problem, composed)
    if not found:
        return None
    excesses = _join_pairs(
        "cam-peaks-and-peaks",
        [compose("cam-peak-high", derivative=name, times=f"{times:.3g}") for name, times in found.items()],
    )
    # Recommend a limit only if none is given yet.
    unlimited = [name for name in found if getattr(problem.limits, name) is None]
    if not unlimited:
        return make_sentence(compose("cam-peaks-cost", excesses=excesses))
    limits = _join_pairs("cam-limits-or-limits", [compose("cam-derivative", derivative=name) for name in unlimited])
    return make_sentence(compose("cam-peaks-need-limits", excesses=excesses, limits=limits))


def _join_pairs(message_id: str, parts: list[str]) -> str:
    """Join parts of a sentence by a message that joins two."""
    return reduce(lambda first, second: compose(message_id, first=first, second=second), parts)
