"""The sixbar of a fourbar and its driver dyad, built from the positions of pin C and the crank's pivot O6."""

from __future__ import annotations

import cmath
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from synthesis.model.linkage.answer import FourbarMechanism, Link, SixbarMechanism, Skeleton
from synthesis.model.linkage.conversion import to_complex, to_point

SIZE_SCALE = 2.0
"""Scale of the size penalty: the score is halved if the sixbar exceeds the fourbar's size by this many times it."""


def measure_diagonal(points: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Return the diagonal of the box around points along the last axis."""
    return np.asarray(np.hypot(np.ptp(points.real, axis=-1), np.ptp(points.imag, axis=-1)))


def build_rocker_driver(
    mechanism: FourbarMechanism, link: str, c: complex, o6: complex, swing: float
) -> SixbarMechanism:
    """Build the sixbar whose driver moves the input or output link at C (first position); ``swing`` in radians."""
    pivot = to_complex(mechanism.fixed_pivots.input if link == "input" else mechanism.fixed_pivots.output)
    return _build_sixbar("watt_2", mechanism, link, pivot, c, o6, pivot + (c - pivot) * cmath.exp(1j * swing))


def build_coupler_driver(mechanism: FourbarMechanism, c: complex, o6: complex, last: complex) -> SixbarMechanism:
    """Build the sixbar whose driver moves the coupler at C (first position); ``last`` is C in the last position."""
    joints = mechanism.skeleton.joints
    return _build_sixbar("stephenson_3", mechanism, "coupler", to_complex(joints["A"]), c, o6, last)


def _build_sixbar(
    kind: Literal["watt_2", "stephenson_3"],
    mechanism: FourbarMechanism,
    link: str,
    pin: complex,
    c: complex,
    o6: complex,
    last: complex,
) -> SixbarMechanism:
    """Add crank and driver link with dead centres at C and ``last``; ``pin`` is the driven link's pin O2, O4 or A."""
    first, other = abs(c - o6), abs(last - o6)
    # At the nearer end of the path crank and link overlap; at the farther end they are stretched.
    d = o6 + 0.5 * (first - other) * (c - o6) / first
    bar = mechanism.skeleton
    joints = {**bar.joints, "O6": to_point(o6), "C": to_point(c), "D": to_point(d)}
    links = [
        Link(name="ground", joints=["O2", "O4", "O6"]),
        *(
            Link(name=old.name, joints=[*old.joints, "C"]) if old.name == link else old
            for old in bar.links
            if old.name != "ground"
        ),
        Link(name="driver_coupler", joints=["C", "D"]),
        Link(name="crank", joints=["O6", "D"]),
    ]
    pivot = to_complex(mechanism.fixed_pivots.output if link == "output" else mechanism.fixed_pivots.input)
    return SixbarMechanism(
        type=kind,
        fixed_pivots={name: joints[name] for name in ("O2", "O4", "O6")},
        links={
            **mechanism.links.model_dump(),
            "crank": abs(d - o6),
            "driver_coupler": abs(d - c),
            "driver_ground": abs(o6 - pivot),
            "driver_arm": abs(c - pin),
        },
        reference_body_angle=mechanism.reference_body_angle,
        skeleton=Skeleton(joints=joints, links=links, input_link="crank"),
    )
