"""What answers with linkages state, measured: lengths, reach, box, transmission angles, quality (docs/ranking.md)."""

from __future__ import annotations

import math
from itertools import combinations
from typing import Any

import numpy as np

from benchmarks.independent.comparison import Measured
from benchmarks.independent.drive import Complex, Drive
from benchmarks.independent.transmission import least_angles

PINS = {
    "crank": ("O2", "A"),
    "input_arm": ("O2", "C"),
    "input": ("O2", "A"),
    "coupler": ("A", "B"),
    "rocker": ("O4", "B"),
    "ground": ("O2", "O4"),
}
"""The joints between which a length is measured, where it is not the greatest of its link in the skeleton."""

OWN_PINS = {
    "crank_shaper": {"rocker": ("O4", "C"), "coupler": ("C", "D")},
    "whitworth": {"rocker": ("O4", "C"), "coupler": ("C", "D")},
    "drag_link_rocker": {"output_ground": ("O4", "O6")},
    "geared_fivebar": {"ground": ("O2", "O5"), "coupler_1": ("A", "C")},
}
"""The same of single types."""

DRIVERS = ("watt_2", "stephenson_3")
"""Fourbars with a driver dyad."""


def length_of(drive: Drive, kind: str, name: str) -> float | None:
    """A length by its name in ``links``; None if the skeleton does not show it."""
    pins = OWN_PINS.get(kind, {}).get(name) or PINS.get(name)
    if kind in DRIVERS and name in ("crank", "driver_ground", "driver_arm"):
        driven = next(link for link in ("input", "output", "coupler") if drive.names.index("C") in drive.links[link])
        pivot = "O4" if driven == "output" else "O2"
        pins = {
            "crank": ("O6", "D"),
            "driver_ground": ("O6", pivot),
            "driver_arm": ("C", "A" if driven == "coupler" else pivot),
        }[name]
    if kind in DRIVERS and name == "output":
        pins = ("O4", "B")
    if kind == "inverted_slider_crank" and name == "output":
        _, _, point, along = drive.slides[0]
        pin = complex(drive.home[drive.names.index("A")])
        return abs(((point - pin) * along.conjugate()).imag)
    if pins and set(pins) <= set(drive.names):
        one, other = (drive.home[drive.names.index(pin)] for pin in pins)
        return float(abs(one - other))
    joints = drive.links.get(name, [])
    return max((float(abs(drive.home[i] - drive.home[j])) for i, j in combinations(joints, 2)), default=None)


def reach_of(drive: Drive) -> float:
    """Greatest distance between two joints of one link."""
    return max(
        float(abs(drive.home[i] - drive.home[j])) for joints in drive.links.values() for i, j in combinations(joints, 2)
    )


def box(places: Complex) -> float:
    """Diagonal of the box around places."""
    return math.hypot(np.ptp(places.real), np.ptp(places.imag))


def compare_linkage(
    result: Measured,
    kind: str,
    design: Any,
    drive: Drive,
    name: str,
    *,
    way: tuple[float, float],
    task: float | None,
    places: Complex,
    ease: float | None = 1.0,
) -> set[str]:
    """Compare what all kinds state; the names of what was compared.

    ``way`` are the turns that transmission angles are taken over, ``task`` the size of the task (None: it has none),
    ``places`` all joints that the box is around, ``ease`` the factor of the quality (None: not to be compared).
    """
    metrics, mechanism = design.metrics, design.mechanism
    stated_links = mechanism.links if isinstance(mechanism.links, dict) else mechanism.links.model_dump()
    lengths = []
    for link, stated in stated_links.items():
        found = length_of(drive, mechanism.type, link)
        if found is None:
            result.left[f"{mechanism.type}: length {link}"] += 1
            continue
        result.add(f"{kind} length", stated, found, max(stated, 1e-6 * drive.size), name)
        lengths.append(found)
    lengths = [length for length in lengths if length > 1e-12 * drive.size]
    ratio, reach = max(lengths) / min(lengths), reach_of(drive)
    result.add(f"{kind} link_ratio", metrics.link_ratio, ratio, ratio, name)
    compared = {"link_ratio", "check link_ratio", "check shortest_link", "check longest_link", "reach", "size"}
    for check in design.verification.checks:
        lengths_of = {"link_ratio": ratio, "shortest_link": min(lengths), "longest_link": max(lengths)}
        if check.name in lengths_of:
            result.add(f"{kind} check {check.name}", check.value, lengths_of[check.name], lengths_of[check.name], name)
    result.add(f"{kind} size", metrics.size, box(places), box(places), name)
    if task is not None and getattr(metrics, "reach", None) is not None:
        result.add(f"{kind} reach", metrics.reach, reach / task, reach / task, name)
    if not drive.follow(*way):
        result.left[f"{mechanism.type}: could not be driven"] += 1
        return compared
    angles = least_angles(drive, *way)
    found = min(angles.values())
    result.add(f"{kind} min_transmission_angle", metrics.min_transmission_angle, found, 90.0, name)
    compared |= {"min_transmission_angle", "check transmission_angle"}
    for check in design.verification.checks:
        if check.name == "transmission_angle":
            result.add(f"{kind} check transmission_angle", check.value, found, 90.0, name)
    for link, stated in getattr(metrics, "transmission_angles", {}).items():
        of_link = [angle for links, angle in angles.items() if link in links]
        if of_link:
            result.add(f"{kind} transmission_angles", stated, of_link[0], 90.0, name)
        else:
            result.left[f"{mechanism.type}: transmission angle of {link}"] += 1
    quality = getattr(metrics, "quality", None)
    if quality is not None and ease is not None:
        far = 0.0 if task is None else reach / task
        weighed = math.sin(math.radians(found)) / ((1.0 + (far / 3.0) ** 2) * (1.0 + (ratio / 8.0) ** 2))
        result.add(f"{kind} quality", quality, ease * weighed, 1.0, name)
        compared.add("quality")
    return compared
