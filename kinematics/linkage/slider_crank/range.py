"""Branches, circuits and transmission angle of one slider-crank over a range of crank angles, in closed form.

Everything hangs on the height k_y = a sin(θ − φ) of the pin A over the slide's direction (:mod:`slider_crank`): the
coupler reaches the slide where |c − k_y| ≤ b, stands square to it, a toggle, where these are equal, and its
transmission angle, against the normal of the slide, has the sine √(1 − ((c − k_y)/b)²) (Norton, Sec. 4.10). Over a
range of angles the height is extreme at the ends, or where the crank is square to the slide.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.linkage.slider_crank.closed_form import SliderCrank, crank_limits, full_rotation


def height_range(linkage: SliderCrank, start: float, end: float) -> tuple[float, float]:
    """Least and greatest height of A while the crank turns from ``start`` to ``end``, absolute radians, either way."""
    low, high = sorted((start - float(linkage.slide_angle), end - float(linkage.slide_angle)))
    ends = [math.sin(low), math.sin(high)]
    top, bottom = (shift + math.tau * math.ceil((low - shift) / math.tau) for shift in (0.5 * math.pi, -0.5 * math.pi))
    a = float(linkage.crank)
    return a * (-1.0 if bottom <= high else min(ends)), a * (1.0 if top <= high else max(ends))


def stays_on_branch(linkage: SliderCrank, start: float, end: float) -> bool:
    """Whether the crank turns from ``start`` to ``end`` without meeting a toggle."""
    low, high = height_range(linkage, start, end)
    b, c = float(linkage.coupler), float(linkage.offset)
    return c - b < low and high < c + b


def least_transmission_angle(linkage: SliderCrank, start: float, end: float) -> float:
    """Least transmission angle while the crank turns from ``start`` to ``end``, radians; 0 where it cannot."""
    low, high = height_range(linkage, start, end)
    b, c = float(linkage.coupler), float(linkage.offset)
    across = max(abs(c - low), abs(c - high))
    return math.atan2(math.sqrt(max((b - across) * (b + across), 0.0)), across)


def same_circuit(linkage: SliderCrank, angle: float, assembly: int, other_angle: float, other_assembly: int) -> bool:
    """Whether two configurations (crank angle, assembly sign), both of which close, lie on one circuit.

    A crank that turns through has a circuit for each assembly. One toggle height makes a single circuit; two make two,
    with the pin A ahead of the pivot along the slide, or behind.
    """
    if bool(full_rotation(linkage)):
        return assembly == other_assembly
    limits = crank_limits(linkage)
    if not (limits.lower_toggle and limits.upper_toggle):
        return True
    ahead = np.cos(np.array([angle, other_angle]) - float(linkage.slide_angle)) > 0.0
    return bool(ahead[0] == ahead[1])
