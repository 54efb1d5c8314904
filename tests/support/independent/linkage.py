"""Measured values of linkages: lengths, reach, box, transmission angles, quality (docs/methods/ranking.md)."""

from __future__ import annotations

import math
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from kinematics.arrays import Complex
from tests.support.independent.comparison import Beside
from tests.support.independent.drive import Drive
from tests.support.independent.mobility import class_of
from tests.support.independent.room import compare_room
from tests.support.independent.transmission import least_angles

PINS = {
    "crank": ("O2", "A"),
    "input_arm": ("O2", "C"),
    "input": ("O2", "A"),
    "coupler": ("A", "B"),
    "rocker": ("O4", "B"),
    "ground": ("O2", "O4"),
}
"""The joints between which a length is measured, where it is not the greatest of its link in the skeleton."""

DWELL = {
    "ground_arm": ("O2", "O6"),
    "ground_side": ("O4", "O6"),
    "coupler_arm": ("A", "P"),
    "coupler_side": ("B", "P"),
    "rocker_arm": ("O4", "P"),
    "rocker_side": ("B", "P"),
}
"""The same where P is a pin."""

OWN_PINS: dict[str, dict[str, tuple[str, str]]] = {
    "fourbar": {"output": ("O4", "B")},
    "crank_shaper": {"rocker": ("O4", "C"), "coupler": ("C", "D")},
    "whitworth": {"rocker": ("O4", "C"), "coupler": ("C", "D")},
    "drag_link_rocker": {"output_ground": ("O4", "O6")},
    "geared_fivebar": {"ground": ("O2", "O5"), "coupler_1": ("A", "C")},
    "dwell_stephenson_2": {
        "output": ("O4", "E"),
        "input_arm": ("O2", "C"),
        "input_side": ("A", "C"),
        "link_3": ("A", "B"),
        "link_4": ("B", "D"),
        "link_4_arm": ("B", "E"),
        "link_4_side": ("D", "E"),
        "link_5": ("C", "D"),
    },
    **dict.fromkeys(("dwell_rocker", "dwell_slider", "dwell_slot", "dwell_watt_rocker", "dwell_watt_slider"), DWELL),
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


class Used(NamedTuple):
    """Over what a design of a kind is measured.

    Attributes
    ----------
    way : tuple of float
        The turns that transmission angles are taken over.
    task : float or None
        The size of the task; None where it has none.
    places : complex
        All joints that the box is around.
    ease : float or None
        The factor of the quality; None where a kind has no quality.
    in_order : bool
        Whether the targets are visited in order.
    """

    way: tuple[float, float]
    task: float | None
    places: Complex
    ease: float | None = 1.0
    in_order: bool = True


def compare_linkage(beside: Beside, stated: dict[str, Any], drive: Drive, used: Used) -> None:
    """Compare what all kinds state, and the checks of constraints."""
    metrics, mechanism = beside.design.metrics, beside.design.mechanism
    lengths = _compare_lengths(beside, drive)
    ratio, reach = max(lengths) / min(lengths), reach_of(drive)
    beside.metric("link_ratio", ratio, ratio)
    beside.metric("size", box(used.places), box(used.places))
    if used.task is not None:
        beside.metric("reach", reach / used.task, reach / used.task)
    checks = {"link_ratio": ratio, "shortest_link": min(lengths), "longest_link": max(lengths)}
    for name, value in checks.items():
        beside.check(name, value, value)
    _compare_regions(beside, stated.get("constraints", {}), drive)
    wanted = stated.get("constraints", {}).get("grashof", "any")
    if {"O2", "A", "B", "O4"} <= set(drive.names) and not drive.slides_in and not _joined_by_a_slide(drive):
        grashof = class_of(*(complex(drive.home[drive.names.index(name)]) for name in ("O2", "A", "B", "O4")))
        if getattr(metrics, "grashof", None) is not None:
            beside.same("metrics.grashof", metrics.grashof, grashof.motion)
            beside.same("metrics.barker", metrics.barker, grashof.code)
        beside.check("grashof", grashof.motion == {"non_grashof": "rocker_rocker"}.get(wanted, wanted))
    if not drive.follow(*used.way):
        beside.unmeasured("could not be driven")
        return
    _compare_used(beside, drive, used.way)
    compare_room(beside, stated, drive, used.way)
    beside.same("metrics.same_branch", getattr(metrics, "same_branch", None), True)
    beside.same("metrics.visits_in_order", getattr(metrics, "visits_in_order", None), used.in_order)
    beside.check("same_branch", True)
    beside.check("same_circuit", True)
    beside.check("visits_in_order", used.in_order)
    if hasattr(metrics, "full_rotation"):
        turns = turns_through(drive, mechanism)
        beside.same("metrics.full_rotation", metrics.full_rotation, turns)
        beside.check("full_rotation", turns)
        beside.check("crank_turns", turns)
    angles = least_angles(drive, *used.way)
    found = min(angles.values())
    beside.metric("min_transmission_angle", found, 90.0)
    beside.check("transmission_angle", found, 90.0)
    for link, angle in getattr(metrics, "transmission_angles", {}).items():
        of_link = [least for links, least in angles.items() if link in links]
        if of_link:
            beside.add("metrics.transmission_angles", angle, of_link[0], 90.0)
        else:
            beside.measured.left[f"{mechanism.type}: transmission angle of {link}"] += 1
    if used.ease is not None:
        far = 0.0 if used.task is None else reach / used.task
        weighed = math.sin(math.radians(found)) / ((1.0 + (far / 3.0) ** 2) * (1.0 + (ratio / 8.0) ** 2))
        beside.metric("quality", used.ease * weighed, 1.0)


def _compare_used(beside: Beside, drive: Drive, way: tuple[float, float]) -> None:
    """The ends of the verified motion; of a whole turn only that it is one, as it may begin anywhere."""
    metrics = beside.design.metrics
    (low, high), stroke, turn = sorted(way), metrics.used_stroke, metrics.used_range
    if stroke is not None:
        for stated, found in zip(sorted(stroke), (low, high), strict=True):
            beside.add("metrics.used_stroke", stated, found, drive.size)
    if turn is not None:
        first, last = sorted(turn)
        beside.add("metrics.used_range", last - first, math.degrees(high - low), 360.0)
        if high - low < math.tau * (1.0 - 1e-9):
            off = math.remainder(first - math.degrees(drive.reference + low), 360.0)
            beside.add("metrics.used_range", first, first - off, 360.0)


def _compare_lengths(beside: Beside, drive: Drive) -> list[float]:
    """Compare the lengths of the links; those that are found."""
    mechanism = beside.design.mechanism
    stated_links = mechanism.links if isinstance(mechanism.links, dict) else mechanism.links.model_dump()
    lengths = []
    for link, stated in stated_links.items():
        found = length_of(drive, mechanism.type, link)
        if found is None:
            beside.measured.left[f"{mechanism.type}: length {link}"] += 1
            continue
        beside.add("mechanism.links", stated, found, max(stated, 1e-6 * drive.size))
        lengths.append(found)
    return [length for length in lengths if length > 1e-12 * drive.size]


def _joined_by_a_slide(drive: Drive) -> bool:
    """Whether O4 and B, or A and B, are joined by a slide and not by links of a fourbar."""
    at = drive.names.index
    return not any({at("A"), at("B")} <= set(joints) for joints in drive.links.values()) or not any(
        {at("O4"), at("B")} <= set(joints) for joints in drive.links.values()
    )


def _compare_regions(beside: Beside, constraints: dict[str, Any], drive: Drive) -> None:
    """How far the pivots are outside of their regions in the skeleton's configuration."""
    kind = beside.design.mechanism.type
    added = {"O6", "C", "D"} if kind in DRIVERS else set()
    ground = {drive.names[joint] for joint in drive.links["ground"]}
    fixed = [drive.home[drive.names.index(name)] for name in drive.names if name in ground - added]
    moving = [drive.home[drive.names.index(name)] for name in drive.names if name not in ground | added | {"P"}]
    for name, pivots in (("fixed_pivot_region", fixed), ("moving_pivot_region", moving)):
        region = constraints.get(name)
        if region is not None:
            beside.check(name, max(outside(region, pivot) for pivot in pivots), drive.size)
    region = constraints.get("input_pivot_region")
    if region is not None:
        beside.check("input_pivot_region", outside(region, fixed[0]) <= 1e-9 * drive.size)


def outside(region: dict[str, Any], place: complex) -> float:
    """How far a place lies outside of a rectangle."""
    (left, right), (low, high) = region["x"], region["y"]
    nearest = complex(min(max(place.real, left), right), min(max(place.imag, low), high))
    return abs(place - nearest)


def turns_through(drive: Drive, mechanism: Any) -> bool:
    """Whether the input turns all round and all joints come home; of gears so many turns as these need."""
    if drive.slides_in:
        return False
    turns = turns_of_gears(mechanism)
    if not drive.follow(0.0, turns * math.tau):
        return False
    back = drive.at(np.array([turns * math.tau]))[0]
    return bool(np.abs(back - drive.home).max() <= 1e-7 * drive.size)


def turns_of_gears(mechanism: Any) -> int:
    """Turns of the input after which all gears stand as before."""
    ratios = [gear.ratio for gear in mechanism.skeleton.gears]
    return next((n for n in range(1, 61) if all(abs(n * r - round(n * r)) < 1e-9 for r in ratios)), 1)
