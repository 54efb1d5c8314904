"""Branches, circuits and transmission angle of one slider-crank over a range of crank angles, in closed form.

All results depend on the height k_y = a sin(θ − φ) of the pin A over the slide's direction (:mod:`closed_form`). The
coupler reaches the slide where |c − k_y| ≤ b, and is normal to it (a toggle) at equality. Its transmission angle,
against the normal of the slide, has the sine √(1 − ((c − k_y)/b)²) (Norton, Sec. 4.10). Over a range of angles the
extremes of the height occur at the ends, or where the crank is normal to the slide.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.linkage.slider_crank.closed_form import SliderCrank, find_crank_limits, has_full_rotation


def find_height_range(linkage: SliderCrank, start: float, end: float) -> tuple[float, float]:
    """Find the minimum and maximum height of A while the crank turns from ``start`` to ``end``, absolute radians."""
    low, high = sorted((start - float(linkage.slide_angle), end - float(linkage.slide_angle)))
    ends = [math.sin(low), math.sin(high)]
    # First angles in the range at which the crank points up and down from the slide.
    top, bottom = (shift + math.tau * math.ceil((low - shift) / math.tau) for shift in (0.5 * math.pi, -0.5 * math.pi))
    a = float(linkage.crank)
    return a * (-1.0 if bottom <= high else min(ends)), a * (1.0 if top <= high else max(ends))


def stays_on_branch(linkage: SliderCrank, start: float, end: float) -> bool:
    """Return whether the crank turns from ``start`` to ``end`` without meeting a toggle."""
    low, high = find_height_range(linkage, start, end)
    b, c = float(linkage.coupler), float(linkage.offset)
    return c - b < low and high < c + b


def find_min_transmission_angle(linkage: SliderCrank, start: float, end: float) -> float:
    """Find the minimum transmission angle while the crank turns from ``start`` to ``end``, radians.

    It is 0 if the crank meets a toggle on the way.
    """
    low, high = find_height_range(linkage, start, end)
    b, c = float(linkage.coupler), float(linkage.offset)
    across = max(abs(c - low), abs(c - high))
    # arccos(across/b) without loss of digits near a toggle.
    return math.atan2(math.sqrt(max((b - across) * (b + across), 0.0)), across)


def is_same_circuit(linkage: SliderCrank, angle: float, assembly: int, other_angle: float, other_assembly: int) -> bool:
    """Return whether two valid configurations (crank angle, assembly sign) lie on one circuit.

    A crank that rotates fully has a circuit for each assembly. One toggle height gives a single circuit; two give two
    circuits, with the pin A ahead of the pivot along the slide, or behind it.
    """
    if bool(has_full_rotation(linkage)):
        return assembly == other_assembly
    limits = find_crank_limits(linkage)
    if not (limits.lower_toggle and limits.upper_toggle):
        return True
    ahead = np.cos(np.array([angle, other_angle]) - float(linkage.slide_angle)) > 0.0
    return bool(ahead[0] == ahead[1])
