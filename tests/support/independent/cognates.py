"""The cognates of an answer: each is taken by its coupler point along the design's path, and its links are watched.

Nothing is used of how cognates are made. P is held on a place of the design's curve, and the coupler turned about it
until the links to O2 and O4 have their lengths; Newton's iteration finds that from place to place. What it says of the
motion of the input is then driven at the input.
"""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

from kinematics.arrays import Complex, Real
from tests.support.independent.comparison import Beside
from tests.support.independent.drive import Drive
from tests.support.independent.mobility import class_of
from tests.support.independent.transmission import least_angles

STEPS = 1921, 61_441
"""Places along the way of the design, and where the coupler turns too fast between them."""

NEWTON, CLOSED = 20, 1e-13
"""Iterations at most, and the step, radians, at which they end."""

NEAR = 0.05
"""Radians by which the coupler may be turned from where the last two places let it be expected."""

STILL = 1e-9
"""Radians that are no step of an input."""

MET = 1e-6
"""Share of the design's size within which a cognate meets a target."""

TIMED = 1e-6
"""Radians within which two inputs turn together."""


def compare_cognates(beside: Beside, drive: Drive, turns: Real) -> None:
    """Class, motion and least transmission angle of each cognate, and how far its P is from the design's."""
    for cognate in getattr(beside.design, "cognates", []):
        _compare(beside, drive, turns, cognate)


def _compare(beside: Beside, drive: Drive, turns: Real, cognate: Any) -> None:
    own = Drive(cognate.mechanism.skeleton)
    place = dict(zip(own.names, (complex(z) for z in own.home), strict=True))
    grashof = class_of(*(place[name] for name in ("O2", "A", "B", "O4")))
    beside.same("cognates.grashof", cognate.grashof, grashof.motion)
    turning = grashof.motion in ("double_crank", "crank_rocker")
    beside.same("cognates.full_rotation", cognate.full_rotation, turning)
    forward = bool(turns[-1] >= turns[0])
    for steps in STEPS:
        way = np.union1d(np.linspace(float(turns.min()), float(turns.max()), steps), turns)
        way = way if forward else way[::-1]
        p = drive.joint("P", way)
        followed = _followed(place, p)
        if followed is not None:
            break
    else:
        beside.measured.left[f"path {cognate.side} cognate: could not be followed ({beside.name})"] += 1
        return
    a, b, lacks = followed
    at = np.searchsorted(way, turns) if forward else len(way) - 1 - np.searchsorted(way[::-1], turns)
    inputs = np.unwrap(np.angle((a - place["O2"]) / (place["A"] - place["O2"])))
    inputs -= math.tau * round(float(inputs[at[0]]) / math.tau)
    timed = np.abs((inputs - inputs[0]) - (way - way[0])).max() < TIMED
    beside.same("cognates.same_timing", cognate.same_timing, bool(timed))
    sense, turned = np.sign((np.conj(b - a) * (b - place["O4"])).imag), np.diff(inputs)
    # Two targets may be met at one input, but for rounding.
    free = bool((sense == sense[0]).all() and ((turned > -STILL).all() or (turned < STILL).all()))
    met, wanted = inputs[at], p[at]
    low, high = float(met.min()), float(met.max())
    # Where the design's way leads out of the branch and into it again, the input may reach the targets the other way.
    driven = own.follow(low, high)
    off = float(np.abs(own.joint("P", met) - wanted).max()) if driven else math.inf
    held = free or off < MET * drive.size
    beside.same("cognates.same_branch", cognate.same_branch, held)
    if not (held and cognate.same_branch):
        _compare_unfree(beside, cognate, held, float(lacks[at].max()))
        return
    steps_on = np.diff(met)
    in_order = free or bool((steps_on > -STILL).all() or (steps_on < STILL).all())
    beside.same("cognates.visits_in_order", cognate.visits_in_order, in_order)
    if not driven:
        beside.measured.left[f"path {cognate.side} cognate: could not be driven ({beside.name})"] += 1
        return
    least = min(least_angles(own, low, high).values())
    beside.add("cognates.min_transmission_angle", cognate.min_transmission_angle, least, 90.0)
    beside.add("cognates.deviation", cognate.deviation, off, drive.size)


def _compare_unfree(beside: Beside, cognate: Any, free: bool, lacks: float) -> None:
    """A cognate that passes a toggle on its way: there is no one range that an angle could be taken over."""
    why = "a cognate whose own input does not drive it through the points"
    beside.without("cognates.visits_in_order", why)
    if not free and not cognate.same_branch:
        beside.add("cognates.min_transmission_angle", cognate.min_transmission_angle, 0.0, 90.0)
    beside.add("cognates.deviation", cognate.deviation, lacks, beside.design.metrics.size)


def _followed(place: dict[str, complex], p: Complex) -> tuple[Complex, Complex, Real] | None:
    """A, B and what both links lack while P goes from place to place, from the first one on; None where they jump.

    The coupler turns about P until both links have their lengths; only where P is its instant centre, at a cusp of the
    curve, that says nothing.
    """
    o2, o4 = place["O2"], place["O4"]
    first, second = place["A"] - place["P"], place["B"] - place["P"]
    arm, link = abs(place["A"] - o2), abs(place["B"] - o4)
    turns: list[float] = []
    lacks = []
    for target in p.tolist():
        turn = expected = 2.0 * turns[-1] - turns[-2] if len(turns) > 1 else turns[-1] if turns else 0.0
        for _ in range(NEWTON):
            reached, held = cmath.rect(1.0, turn) * first, cmath.rect(1.0, turn) * second
            one, other = target + reached - o2, target + held - o4
            f, g = abs(one) - arm, abs(other) - link
            df, dg = (one.conjugate() * 1j * reached).real / abs(one), (other.conjugate() * 1j * held).real / abs(other)
            if df == dg == 0.0:
                break
            step = -(f * df + g * dg) / (df * df + dg * dg)
            turn += step
            if abs(step) <= CLOSED:
                break
        if not abs(turn - expected) <= NEAR:
            return None
        turns.append(turn)
        lacks.append(math.hypot(f, g))
    turned = np.exp(1j * np.array(turns))
    return np.asarray(p + first * turned), np.asarray(p + second * turned), np.array(lacks)
