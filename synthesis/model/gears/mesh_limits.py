"""Interference and contact limits of gear pairs, vectorised over tooth numbers; lengths are in half modules.

All gears have standard full-depth teeth and run at their standard distance.

The line of action is tangent to both base circles, of
radius z cos φ. An external tip circle of radius z + 2 must stay inside √(z² cos² φ + (z₁ + z₂)² sin² φ). A ring's teeth
are shortened so that they do not dig into the planet's flank: the addendum is the smaller of 1 and
(R − √(R² cos² φ + (R − P)² sin² φ))/2, so that the contact ratio has to be checked (Norton, Sec. 9.2–9.5; Colbourne
1987, ch. 8, for tip interference).

For contact in fillets, external gears are cut by the rack of full-depth teeth and rings by a cutter. The involute then
ends as in :mod:`kinematics.gear.flanks`; for undercut gears it ends where the fillet crosses the flank
(:mod:`kinematics.gear.profile`). The ring's teeth are shortened so that they do not reach below the involute.
"""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Mask, Real
from kinematics.gear.flanks import CUTTER_ADDENDUM
from kinematics.gear.profile import find_full_depth_starts

ADDENDUM_STEP = 1e-6
"""Step to which shortened addenda are rounded down, modules: with six decimals they still do not interfere."""

DEFAULT_CUTTER_TEETH = 20
"""Default number of teeth of the cutter that shapes a ring; half of the ring's teeth if that is less."""

ROUNDING_TOLERANCE = 1e-12
"""Relative tolerance of a tip circle at its limit, for rounding."""


def choose_cutter_teeth(ring: Real | float) -> Real:
    """Return the default number of teeth of the cutter for a ring with ``ring`` teeth."""
    return np.asarray(np.minimum(DEFAULT_CUTTER_TEETH, ring // 2))


def has_no_external_interference(pinion: Real, gear: Real, angle: float) -> Mask:
    """Return whether external gears with these tooth numbers mesh without interference; ``angle`` is in radians."""
    squared, span = np.sin(angle) ** 2, (pinion + gear) ** 2
    limits = [np.sqrt(z * z * (1.0 - squared) + span * squared) for z in (pinion, gear)]
    return np.asarray(
        (pinion + 2.0 <= limits[0] * (1.0 + ROUNDING_TOLERANCE))
        & (gear + 2.0 <= limits[1] * (1.0 + ROUNDING_TOLERANCE)),
        np.bool_,
    )


def compute_external_contact_ratio(pinion: Real, gear: Real, angle: float) -> Real:
    """Compute the contact ratio of two external gears."""
    cosine, sine = np.cos(angle), np.sin(angle)
    tips = [np.sqrt((z + 2.0) ** 2 - (z * cosine) ** 2) for z in (pinion, gear)]
    return np.asarray((tips[0] + tips[1] - (pinion + gear) * sine) / (2.0 * np.pi * cosine))


def has_clear_external_fillets(pinion: Real, gear: Real, angle: float) -> Mask:
    """Return whether neither tip of two external gears reaches below the involute that a rack leaves on the other."""
    clear = np.ones(np.broadcast(pinion, gear).shape, np.bool_)
    for own, mate in ((pinion, gear), (gear, pinion)):
        reached = (pinion + gear) * np.sin(angle) - np.sqrt((mate + 2.0) ** 2 - (mate * np.cos(angle)) ** 2)
        clear &= reached >= _compute_rack_form(own, angle) - ROUNDING_TOLERANCE * own
    return clear


def has_clear_ring_fillet(planet: Real, ring: Real, angle: float) -> Mask:
    """Return whether a planet's tip stays within the involute that the sharp-edged default cutter leaves on a ring."""
    cutter = choose_cutter_teeth(ring)
    cosine, sine = np.cos(angle), np.sin(angle)
    reached = (ring - planet) * sine + np.sqrt((planet + 2.0) ** 2 - (planet * cosine) ** 2)
    form = (ring - cutter) * sine + np.sqrt((cutter + 2.0 * CUTTER_ADDENDUM) ** 2 - (cutter * cosine) ** 2)
    return np.asarray(reached <= form + ROUNDING_TOLERANCE * ring, np.bool_)


def _compute_rack_form(teeth: Real, angle: float) -> Real:
    """Compute the start of the involute that a rack leaves, on the line of action from the tangent point."""
    # The start is expensive to compute, so compute it once per distinct tooth number.
    numbers, places = np.unique(teeth, return_inverse=True)
    return np.asarray(2.0 * find_full_depth_starts(numbers, angle)[places].reshape(teeth.shape))


def compute_ring_addendum(planet: Real, ring: Real, angle: float, fillets: bool = False) -> Real:
    """Compute the maximum addendum of a ring (modules, at most 1) that does not dig into its planet.

    With ``fillets`` the ring's tips do not reach into the planet's fillets either.
    """
    return _compute_addendum_reaching(
        ring, (ring - planet) * np.sin(angle) + (_compute_rack_form(planet, angle) if fillets else 0.0), angle
    )


def compute_untrimmed_addendum(ring: Real, angle: float) -> Real:
    """Compute the maximum addendum of a ring (modules, at most 1) whose tips the default cutter does not trim.

    The tips end where the involute of the cutter begins.
    """
    return _compute_addendum_reaching(ring, (ring - choose_cutter_teeth(ring)) * np.sin(angle), angle)


def _compute_addendum_reaching(ring: Real, reached: Real, angle: float) -> Real:
    """Compute the addendum of a ring whose tips reach ``reached`` on the line of action from the tangent point."""
    limit = np.sqrt((ring * np.cos(angle)) ** 2 + reached**2)
    return np.asarray(np.minimum(1.0, np.floor(0.5 * (ring - limit) / ADDENDUM_STEP) * ADDENDUM_STEP))


def compute_internal_contact_ratio(planet: Real, ring: Real, addendum: Real, angle: float) -> Real:
    """Compute the contact ratio of a planet and a ring with this addendum, modules."""
    cosine, sine = np.cos(angle), np.sin(angle)
    tip = ring - 2.0 * addendum
    own = np.sqrt((planet + 2.0) ** 2 - (planet * cosine) ** 2)
    far = np.sqrt(np.maximum(tip**2 - (ring * cosine) ** 2, 0.0))
    return np.asarray((own - far + (ring - planet) * sine) / (2.0 * np.pi * cosine))


def has_clear_tips(planet: Real, ring: Real, addendum: Real, angle: float) -> Mask:
    """Return whether the tips of a planet and of a ring with this addendum (modules) pass each other.

    Tips collide only if the ring is hardly larger than its planet.
    """
    return _has_passing_tips(planet, ring, planet + 2.0, ring - 2.0 * addendum, angle)


def is_ring_untrimmed(ring: Real, addendum: Real, angle: float) -> Mask:
    """Return whether the default cutter leaves the tips of a ring with this addendum (modules) untrimmed.

    Off the line of action, the cutter's tips must pass the ring's tips. On that line, the ring's tips must not reach
    beyond the cutter's involutes.
    """
    cutter, inner = choose_cutter_teeth(ring), ring - 2.0 * addendum
    reached = np.sqrt(np.maximum(inner**2 - (ring * np.cos(angle)) ** 2, 0.0))
    passed = _has_passing_tips(cutter, ring, cutter + 2.0 * CUTTER_ADDENDUM, inner, angle)
    return np.asarray(passed & (reached >= (ring - cutter) * np.sin(angle)), np.bool_)


def _has_passing_tips(planet: Real, ring: Real, tip: Real, inner: Real, angle: float) -> Mask:
    """Return whether tips on a circle of radius ``tip`` pass a ring's tips on a circle of radius ``inner``.

    The gears run at their standard distance.
    """
    apart, base, ring_base = ring - planet, planet * np.cos(angle), ring * np.cos(angle)
    inside = inner >= apart + tip
    meets = (inner > np.abs(apart - tip)) & (inner >= ring_base)

    def compute_involute(cosine: Real) -> Real:
        flank = np.arccos(np.clip(cosine, -1.0, 1.0))
        return np.asarray(np.tan(flank) - flank)

    at_planet = np.arccos(np.clip((inner**2 - tip**2 - apart**2) / (2.0 * tip * apart), -1.0, 1.0))
    at_ring = np.arccos(np.clip((apart**2 + inner**2 - tip**2) / (2.0 * inner * apart), -1.0, 1.0))
    room = planet * (compute_involute(base / tip) + at_planet) - ring * (compute_involute(ring_base / inner) + at_ring)
    room = room + apart * (np.tan(angle) - angle)
    return np.asarray(inside | (meets & (room >= 0.0)), np.bool_)
