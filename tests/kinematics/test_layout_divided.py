"""Linkages on both sides of a base: quick returns by their own closed form, and every way to build them."""

from __future__ import annotations

import math
from functools import cache
from itertools import combinations, permutations, product

import numpy as np
import pytest
import shapely

from kinematics.linkage import Fourbar, Mechanism, catalogue
from kinematics.linkage.layout import Division, arrange_divided, arrange_planes, list_divisions

TURN = 2.0 * math.pi

INPUTS = np.linspace(0.0, TURN, 361)

SIDES = {"crank": ("input", "slotted"), "ram": ("outer", "coupler")}
"""Plates of either half: the lever is two of them."""

PINS = {
    "O2": ("input",), "A": ("input", "slotted"), "O4": ("slotted", "outer"), "C": ("outer", "coupler"),
    "D": ("coupler",),
}  # fmt: skip
GROUNDED = ("O2", "O4", "D")


def quick_return(ground: float, crank: float, arm: float, coupler: float) -> Mechanism:
    """A Whitworth where the crank is longer than the ground, and a crank shaper where it is shorter."""
    return catalogue.make_quick_return(1j * ground, 0j, crank, arm, coupler, 0j, 0.0, 0.3)


def cores(ground: float, crank: float, arm: float, coupler: float) -> dict[str, np.ndarray]:
    """Plates as lines and pins as points over a turn, from the triangle of the crank alone."""
    a = 1j * ground + crank * np.exp(1j * INPUTS)
    along = a / np.abs(a)
    c = arm * along
    d = c.real + np.sqrt(coupler**2 - c.imag**2) + 0j
    still = np.zeros_like(a)
    ends = {
        "input": (still + 1j * ground, a), "slotted": (still, (crank + ground) * along),
        "outer": (still, c), "coupler": (c, d),
    }  # fmt: skip
    points = {"O2": still + 1j * ground, "O4": still, "A": a, "C": c, "D": d}
    lines = {
        name: shapely.linestrings(np.stack([np.column_stack([z.real, z.imag]) for z in pair], axis=1))
        for name, pair in ends.items()
    }
    return lines | {name: shapely.points(z.real, z.imag) for name, z in points.items()}


def buildable(lines: dict[str, np.ndarray], width: float, pin: float, gap: float) -> dict[str, bool]:
    """By trying everything: whether there are planes with the half of the crank, or of the ram, between the bases."""

    @cache
    def meet(one: str, other: str) -> bool:
        radii = sum(0.5 * (pin if name in PINS else width) for name in (one, other))
        return bool(shapely.distance(lines[one], lines[other]).min() - radii < gap)

    found = dict.fromkeys(SIDES, False)
    for inside, (first, second) in (("crank", ("crank", "ram")), ("ram", ("ram", "crank"))):
        free = "O2" if inside == "crank" else "D"
        for below, above, hung in product(permutations(SIDES[first]), permutations(SIDES[second]), (False, True)):
            plane = {name: n for n, name in enumerate(["base", *below, "second", *above])}
            base = {joint: "base" if joint == free and not hung else "second" for joint in GROUNDED}
            clash = False
            for joint, plates in PINS.items():
                held = [plane[name] for name in plates] + ([plane[base[joint]]] if joint in base else [])
                between = [name for name in (*below, *above) if min(held) <= plane[name] <= max(held)]
                clash |= any(name not in plates and meet(name, joint) for name in between)
            for one, other in combinations(PINS, 2):
                shared = {*PINS[one]} & {*PINS[other]} or base.get(one, one) == base.get(other, other)
                clash |= bool(shared) and meet(one, other)
            found[inside] |= not clash
    return found


def test_planes_are_found_where_any_arrangement_has_room() -> None:
    """Of random Whitworths and crank shapers on pins from thin to far too thick."""
    rng = np.random.default_rng(71)
    seen: dict[str, set[bool]] = {"crank": set(), "ram": set()}
    for _ in range(12):
        crank, arm = rng.uniform(1.0, 3.0, 2)
        ground = crank * rng.uniform(0.1, 2.0)
        sizes = ground, crank, arm, arm * rng.uniform(1.2, 4.0)
        width = rng.uniform(0.1, 0.9) * crank
        pin, gap = 0.5 * width, 0.03
        lines = cores(*sizes)
        expected = buildable(lines, width, pin, gap + 2e-3)
        if expected != buildable(lines, width, pin, gap - 2e-3):
            continue
        mechanism = quick_return(*sizes)
        ways = list_divisions(mechanism)
        assert {way.inside for way in ways} == {frozenset({"input"}), frozenset({"coupler"})}
        for way in ways:
            layout = arrange_divided(mechanism, 0.0, TURN, way, link_width=width, pin_diameter=pin, gap=gap)
            side = "crank" if "input" in way.inside else "ram"
            assert (not layout.clashes) == expected[side], (sizes, width)
            seen[side].add(expected[side])
    assert all(both == {True, False} for both in seen.values())


def test_the_lever_of_a_whitworth_is_on_either_side_of_a_base() -> None:
    mechanism = quick_return(0.5, 2.0, 2.5, 9.0)
    for through in (False, True):
        whole = arrange_planes(
            mechanism, 0.0, TURN, link_width=1e-3, pin_diameter=5e-4, gap=1e-4, through=through, whole=True
        )
        assert whole.clashes
    lower = frozenset({"O4", "A"})
    (way,) = (way for way in list_divisions(mechanism) if way.inside == {"input"})
    assert way == Division("rocker", "O4", lower, frozenset({"O4", "C"}), frozenset({"input"}))
    layout = arrange_divided(mechanism, 0.0, TURN, way, link_width=0.5, pin_diameter=0.3, gap=0.02)
    assert layout.clashes == []
    assert layout.planes == {"input": 1, "lower rocker": 2, "upper rocker": 4, "coupler": 5}
    assert layout.pins == {"O2": (0, 1), "A": (1, 2), "O4": (2, 4), "C": (4, 5), "D": (3, 5)}
    assert layout.base == 3


@pytest.mark.parametrize(
    "mechanism",
    [
        catalogue.make_fourbar(Fourbar(0.0, 6.0, 2.0, 7.0, 9.0, 3.0 + 1.0j), 0.5),
        catalogue.make_geared_fivebar(0j, 5.0, 2.0, 4.0, 4.0, 2.0, 2.0, 0.3, 0.5),
    ],
    ids=["nothing hangs by one link", "gears"],
)
def test_links_that_hold_nothing_apart_are_not_divided(mechanism: Mechanism) -> None:
    assert list_divisions(mechanism) == []
