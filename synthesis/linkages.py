"""The one place between the models (degrees, pairs, names) and the analysis core (radians, complex numbers).

Joints carry the field's names: O2, O4 fixed pivots, A, B moving pivots, P the coupler point.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

from kinematics.linkage import CROSSED, OPEN, Fourbar
from synthesis.designs import CouplerPoint, FixedPivots, FourbarLinks, FourbarMechanism, Link, Point, Skeleton


class FourbarConfiguration(NamedTuple):
    """Joints of a fourbar in one position, complex, in length units."""

    o2: complex
    a: complex
    b: complex
    o4: complex
    p: complex


def to_point(z: complex) -> Point:
    """The pair (x, y) of a complex number."""
    return (float(z.real), float(z.imag))


def to_complex(point: tuple[float, float]) -> complex:
    """The complex number of a pair (x, y)."""
    return complex(*point)


def fourbar_mechanism(joints: FourbarConfiguration) -> FourbarMechanism:
    """Dimensions of the fourbar whose joints stand as given at the first target.

    The joints must not coincide where a link lies between them. A configuration exactly on a toggle counts as open.
    """
    o2, a, b, o4, p = joints
    crank, coupler, output, diagonal = a - o2, b - a, b - o4, o4 - a
    point = (p - a) / (coupler / abs(coupler))
    return FourbarMechanism(
        fixed_pivots=FixedPivots(input=to_point(o2), output=to_point(o4)),
        links=FourbarLinks(ground=abs(o4 - o2), input=abs(crank), coupler=abs(coupler), output=abs(output)),
        coupler_point=CouplerPoint(distance=abs(point), angle=math.degrees(cmath.phase(point))),
        assembly="open" if (diagonal.conjugate() * coupler).imag >= 0.0 else "crossed",
        reference_input_angle=math.degrees(cmath.phase(crank)),
        skeleton=Skeleton(
            joints={"O2": to_point(o2), "O4": to_point(o4), "A": to_point(a), "B": to_point(b), "P": to_point(p)},
            links=[
                Link(name="ground", joints=["O2", "O4"]),
                Link(name="input", joints=["O2", "A"]),
                Link(name="coupler", joints=["A", "B", "P"]),
                Link(name="output", joints=["O4", "B"]),
            ],
            input_link="input",
        ),
    )


class DrivenFourbar(NamedTuple):
    """A fourbar ready to be driven: the linkage, the assembly sign and the input angle (radians) of the reference."""

    linkage: Fourbar
    assembly: int
    reference: float


def driven_fourbar(mechanism: FourbarMechanism) -> DrivenFourbar:
    """The analysis core's value of a fourbar's dimensions; the skeleton is not looked at."""
    links, point = mechanism.links, mechanism.coupler_point
    linkage = Fourbar(
        to_complex(mechanism.fixed_pivots.input),
        to_complex(mechanism.fixed_pivots.output),
        links.input,
        links.coupler,
        links.output,
        cmath.rect(point.distance, math.radians(point.angle)),
    )
    return DrivenFourbar(
        linkage, OPEN if mechanism.assembly == "open" else CROSSED, math.radians(mechanism.reference_input_angle)
    )
