"""Which pairs of gears mesh soundly, for whole arrays of tooth numbers; lengths are in half modules.

Standard full-depth teeth at their standard distance. With base radii z cos φ the line of action is tangent to both; an
external tip circle z + 2 must stay inside √(z² cos² φ + (z₁ + z₂)² sin² φ). A ring's teeth are shortened as far as they
would dig into the planet's flank: its addendum is the smaller of 1 and (R − √(R² cos² φ + (R − P)² sin² φ))/2, which
leaves the contact ratio to be watched (Norton, Sec. 9.2–9.5; Colbourne 1987, ch. 8, for tips that foul).

Where contact in fillets is looked at, external gears are cut by the rack of full-depth teeth, rings by a cutter. The
involute then ends where :mod:`kinematics.gear.flanks` says, of undercut gears where the fillet crosses the flank
(:mod:`kinematics.gear.profile`), and the ring's teeth are shortened so far that they do not reach below it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.gear.flanks import CUTTER_ADDENDUM
from kinematics.gear.profile import full_depth_starts

Real = NDArray[np.float64]
Mask = NDArray[np.bool_]

ADDENDUM_STEP = 1e-6
"""Shortened addenda are whole multiples of this: written with six digits they still do not interfere."""

USUAL_CUTTER = 20
"""Teeth of the cutter that shapes a ring where none is stated; half of the ring's where that is less."""

ROUNDING = 1e-12
"""A tip this share of its limit beyond it is on it."""


def usual_cutter(ring: Real | float) -> Real:
    """Teeth of the cutter that shapes a ring of so many teeth where none is stated."""
    return np.asarray(np.minimum(USUAL_CUTTER, ring // 2))


def external_sound(pinion: Real, gear: Real, angle: float) -> Mask:
    """Whether neither of two external gears digs into the other."""
    squared, span = np.sin(angle) ** 2, (pinion + gear) ** 2
    limits = [np.sqrt(z * z * (1.0 - squared) + span * squared) for z in (pinion, gear)]
    return np.asarray(
        (pinion + 2.0 <= limits[0] * (1.0 + ROUNDING)) & (gear + 2.0 <= limits[1] * (1.0 + ROUNDING)), np.bool_
    )


def external_contact(pinion: Real, gear: Real, angle: float) -> Real:
    """Contact ratio of two external gears."""
    cosine, sine = np.cos(angle), np.sin(angle)
    tips = [np.sqrt((z + 2.0) ** 2 - (z * cosine) ** 2) for z in (pinion, gear)]
    return np.asarray((tips[0] + tips[1] - (pinion + gear) * sine) / (2.0 * np.pi * cosine))


def external_fillets_clear(pinion: Real, gear: Real, angle: float) -> Mask:
    """Whether neither tip of two external gears reaches below the involute that a rack leaves on the other."""
    clear = np.ones(np.broadcast(pinion, gear).shape, np.bool_)
    for own, mate in ((pinion, gear), (gear, pinion)):
        reached = (pinion + gear) * np.sin(angle) - np.sqrt((mate + 2.0) ** 2 - (mate * np.cos(angle)) ** 2)
        clear &= reached >= _rack_form(own, angle) - ROUNDING * own
    return clear


def ring_fillet_clear(planet: Real, ring: Real, angle: float) -> Mask:
    """Whether a planet's tip stays within the involute that the usual cutter, with sharp corners, leaves on a ring."""
    cutter = usual_cutter(ring)
    cosine, sine = np.cos(angle), np.sin(angle)
    reached = (ring - planet) * sine + np.sqrt((planet + 2.0) ** 2 - (planet * cosine) ** 2)
    form = (ring - cutter) * sine + np.sqrt((cutter + 2.0 * CUTTER_ADDENDUM) ** 2 - (cutter * cosine) ** 2)
    return np.asarray(reached <= form + ROUNDING * ring, np.bool_)


def _rack_form(teeth: Real, angle: float) -> Real:
    """Where the involute begins that a rack leaves, from the base circle's tangent point on."""
    numbers, places = np.unique(teeth, return_inverse=True)
    return np.asarray(2.0 * full_depth_starts(numbers, angle)[places].reshape(teeth.shape))


def ring_addendum(planet: Real, ring: Real, angle: float, fillets: bool = False) -> Real:
    """Addendum of a ring, in modules, that just does not dig into its planet, or its fillet, at most 1."""
    return _reaching(ring, (ring - planet) * np.sin(angle) + (_rack_form(planet, angle) if fillets else 0.0), angle)


def untrimmed_addendum(ring: Real, angle: float) -> Real:
    """Addendum of a ring, in modules, that just ends where the involute of the usual cutter begins, at most 1."""
    return _reaching(ring, (ring - usual_cutter(ring)) * np.sin(angle), angle)


def _reaching(ring: Real, reached: Real, angle: float) -> Real:
    """Addendum of a ring whose tips reach so far on the line of action, from the base circle's tangent point on."""
    limit = np.sqrt((ring * np.cos(angle)) ** 2 + reached**2)
    return np.asarray(np.minimum(1.0, np.floor(0.5 * (ring - limit) / ADDENDUM_STEP) * ADDENDUM_STEP))


def internal_contact(planet: Real, ring: Real, addendum: Real, angle: float) -> Real:
    """Contact ratio of a planet and a ring of this addendum, modules."""
    cosine, sine = np.cos(angle), np.sin(angle)
    tip = ring - 2.0 * addendum
    own = np.sqrt((planet + 2.0) ** 2 - (planet * cosine) ** 2)
    far = np.sqrt(np.maximum(tip**2 - (ring * cosine) ** 2, 0.0))
    return np.asarray((own - far + (ring - planet) * sine) / (2.0 * np.pi * cosine))


def tips_clear(planet: Real, ring: Real, addendum: Real, angle: float) -> Mask:
    """Whether the tips of a planet and a ring of this addendum, modules, pass each other.

    It is a matter of rings hardly larger than their planets.
    """
    return _tips_pass(planet, ring, planet + 2.0, ring - 2.0 * addendum, angle)


def ring_untrimmed(ring: Real, addendum: Real, angle: float) -> Mask:
    """Whether the usual cutter takes nothing off the tips of a ring of this addendum, modules.

    Its own tips pass them outside the line of action, and on that line the ring's reach no farther than its involutes.
    """
    cutter, inner = usual_cutter(ring), ring - 2.0 * addendum
    reached = np.sqrt(np.maximum(inner**2 - (ring * np.cos(angle)) ** 2, 0.0))
    passed = _tips_pass(cutter, ring, cutter + 2.0 * CUTTER_ADDENDUM, inner, angle)
    return np.asarray(passed & (reached >= (ring - cutter) * np.sin(angle)), np.bool_)


def _tips_pass(planet: Real, ring: Real, tip: Real, inner: Real, angle: float) -> Mask:
    """Whether tips on a circle ``tip`` pass those of a ring on a circle ``inner``, of the pitch circles' distance."""
    apart, base, ring_base = ring - planet, planet * np.cos(angle), ring * np.cos(angle)
    inside = inner >= apart + tip
    meets = (inner > np.abs(apart - tip)) & (inner >= ring_base)

    def involute(cosine: Real) -> Real:
        flank = np.arccos(np.clip(cosine, -1.0, 1.0))
        return np.asarray(np.tan(flank) - flank)

    at_planet = np.arccos(np.clip((inner**2 - tip**2 - apart**2) / (2.0 * tip * apart), -1.0, 1.0))
    at_ring = np.arccos(np.clip((apart**2 + inner**2 - tip**2) / (2.0 * inner * apart), -1.0, 1.0))
    room = planet * (involute(base / tip) + at_planet) - ring * (involute(ring_base / inner) + at_ring)
    room = room + apart * (np.tan(angle) - angle)
    return np.asarray(inside | (meets & (room >= 0.0)), np.bool_)
