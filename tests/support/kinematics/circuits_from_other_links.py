"""Code that several tests share: circuits from other links."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.branches import Branch
from kinematics.linkage.planar.limits import find_branches
from kinematics.linkage.planar.mechanism import Mechanism
from tests.kinematics.mechanism_sampling import CLASS_THREE
from tests.oracles.elimination import Elimination
from tests.oracles.turning import Between, Turning, in_line, three_legs

BY_SLIDER = "slider-crank driven by its slider"
TURNED = (*CLASS_THREE, BY_SLIDER)

CLOSE = 1e-9
"""Difference of the ends of branches, radians, or as a part of the size along a slide."""

STEPHENSON_2 = {
    "ground": ("O2", "A", "C"),
    "link_3": ("A", "B"),
    "link_4": ("B", "D", "E"),
    "link_5": ("C", "D"),
    "output": ("O4", "E"),
    "frame": ("O2", "O4"),
}
"""The chain held at its ternary input link: link_3 closes first the fourbar A B D C, then the dyad from E to O2."""

Joints = Mapping[str, NDArray[np.complex128]]


def turning_of(name: str, mechanism: Mechanism) -> Turning:
    """One design from another link."""
    joints = {joint: complex(z) for joint, z in mechanism.joints.items()}
    reference = float(mechanism.reference_input)

    def turned(found: Joints, pivot: str, tip: str) -> NDArray[np.float64]:
        return np.asarray(np.angle((found[tip] - found[pivot]) / (joints[tip] - joints[pivot])))

    if name == BY_SLIDER:
        (line,) = mechanism.slides
        slide = (line.joint, line.link, complex(line.point), float(line.angle))
        by_crank = Elimination(joints, mechanism.links, [slide], [], "crank")
        _, _, origin, angle = by_crank.slides[0]
        return Turning(
            by_crank,
            in_line("O2", "A", "B"),
            lambda found: np.asarray(((found["B"] - origin) * np.exp(-1j * angle)).real),
            wraps=False,
        )
    if name.startswith("stephenson_3"):
        return Turning(
            Elimination(joints, mechanism.links, [], [], "input"),
            three_legs(("O2", "A"), ("O4", "B"), ("C", "D")),
            lambda found: reference + turned(found, "O6", "D"),
        )
    del joints["P"]
    held = Elimination(joints, STEPHENSON_2, [], [], "link_3")
    if name.endswith("input"):
        legs = three_legs(("A", "B"), ("C", "D"), ("O4", "E"))
        return Turning(held, legs, lambda found: reference - turned(found, "O2", "O4"))
    # The angle at O4 is that of a triangle with two fixed sides: it stands still where the third one, O2 E, does.
    legs = three_legs(("A", "B"), ("C", "D"), ("O2", "E"))
    return Turning(held, legs, lambda found: reference + turned(found, "O4", "E") - turned(found, "O2", "O4"))


def apart(one: Branch, other: Between, unit: float, slide: bool) -> float:
    """How far a branch is from what lies between two toggles: largest difference of its ends."""
    low, high = one.low / unit, one.high / unit
    if one.full or other.full:
        return abs(high - low - other.high + other.low) if one.full and other.full else np.inf
    if slide:
        return max(abs(low - other.low), abs(high - other.high))
    return max(abs(np.exp(1j * low) - np.exp(1j * other.low)), abs(high - low - other.high + other.low))


def same_circuit(own: list[Branch], other: list[Between], unit: float, slide: bool) -> bool:
    """Whether the branches of a circuit are what lies between another's toggles."""
    left = list(other)
    for branch in own:
        near = [between for between in left if apart(branch, between, unit, slide) < CLOSE]
        if not near:
            return False
        left.remove(near[0])
    return not left


def same_circuits(name: str, mechanism: Mechanism) -> int:
    """Branches, whose circuits must be those by elimination from another link; how many there are."""
    found = find_branches(mechanism)
    turning = turning_of(name, mechanism)
    theirs = turning.circuits()
    unit = turning.elimination.size if mechanism.has_slide_input else 1.0
    count = 1 + max(branch.circuit for branch in found)
    assert count == len(theirs)
    for circuit in range(count):
        own = [branch for branch in found if branch.circuit == circuit]
        same = [k for k, other in enumerate(theirs) if same_circuit(own, other, unit, mechanism.has_slide_input)]
        assert same, (circuit, own)
        assert circuit or same[0] == 0, "the first circuit is the reference's"
        theirs[same[0]] = []
    return len(found)
