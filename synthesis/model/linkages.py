"""The one place between the models (degrees, pairs, names) and the analysis core (radians, complex numbers).

Joints carry the field's names: O2, O4 fixed pivots, A, B moving pivots, P the coupler point.
"""

from __future__ import annotations

import cmath
import math
from typing import Literal, NamedTuple

from kinematics.linkage import CROSSED, OPEN, Fourbar
from synthesis.model.answer import Point
from synthesis.model.linkage_answer import (
    BlockSlide,
    CouplerPoint,
    FixedPivots,
    FourbarLinks,
    FourbarMechanism,
    InvertedLinks,
    InvertedSliderCrankMechanism,
    Line,
    Link,
    LinkageMechanism,
    Skeleton,
    Slide,
    SliderCrankLinks,
    SliderCrankMechanism,
)


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


def fourbar_mechanism(joints: FourbarConfiguration, body_angle: float | None = None) -> FourbarMechanism:
    """Dimensions of the fourbar whose joints stand as given at the first target.

    The joints must not coincide where a link lies between them. A configuration exactly on a toggle counts as open.
    ``body_angle``, degrees, is that of the body there, where it is not the demanded one.
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
        reference_body_angle=body_angle,
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


def slider_crank_mechanism(
    o2: complex,
    a: complex,
    b: complex,
    slide_angle: float,
    p: complex,
    *,
    driven_by: Literal["crank", "slider"] = "crank",
    body_angle: float | None = None,
) -> SliderCrankMechanism:
    """Dimensions of the slider-crank whose joints stand as given at the first target; the slide's angle in radians.

    The joints of crank and coupler must not coincide. A configuration exactly at the limit of the crank's reach counts
    as open.
    """
    crank, coupler, along = a - o2, b - a, cmath.exp(1j * slide_angle)
    point = (p - a) / (coupler / abs(coupler))
    line = Line(point=to_point(b), angle=math.degrees(slide_angle))
    return SliderCrankMechanism(
        fixed_pivot=to_point(o2),
        links=SliderCrankLinks(crank=abs(crank), coupler=abs(coupler)),
        slide=line,
        offset=((o2 - b) * along.conjugate()).imag,
        coupler_point=CouplerPoint(distance=abs(point), angle=math.degrees(cmath.phase(point))),
        assembly="open" if (coupler * along.conjugate()).real >= 0.0 else "crossed",
        driven_by=driven_by,
        reference_input_angle=math.degrees(cmath.phase(crank)),
        reference_body_angle=body_angle,
        skeleton=Skeleton(
            joints={"O2": to_point(o2), "A": to_point(a), "B": to_point(b), "P": to_point(p)},
            links=[
                Link(name="ground", joints=["O2"]),
                Link(name="crank", joints=["O2", "A"]),
                Link(name="coupler", joints=["A", "B", "P"]),
            ],
            slides=[Slide(joint="B", link="ground", point=line.point, angle=line.angle)],
            input_link="crank" if driven_by == "crank" else "B",
        ),
    )


def inverted_slider_crank_mechanism(
    o2: complex, a: complex, o4: complex, line_angle: float, p: complex, *, body_angle: float | None = None
) -> InvertedSliderCrankMechanism:
    """Dimensions of the inverted slider-crank as it stands at the first target.

    The body has the pin A, and its line at ``line_angle`` (radians) slides through the block at O4. In the block A
    moves on a parallel line; B is the foot of O4 on it. A must not coincide with O2 or O4.
    """
    crank, reach = a - o2, a - o4
    along = cmath.exp(1j * line_angle)
    # With the angle of the line from O4 → B at +90°, B lies to the right of the line's direction.
    if (1j * along.conjugate() * reach).real < 0.0:
        along = -along
    output = (1j * along.conjugate() * reach).real
    point = (p - a) / (-reach / abs(reach))
    return InvertedSliderCrankMechanism(
        fixed_pivots=FixedPivots(input=to_point(o2), output=to_point(o4)),
        links=InvertedLinks(ground=abs(o4 - o2), input=abs(crank), output=output),
        slide=BlockSlide(angle=90.0),
        coupler_point=CouplerPoint(distance=abs(point), angle=math.degrees(cmath.phase(point))),
        assembly="open" if (along.conjugate() * reach).real >= 0.0 else "crossed",
        reference_input_angle=math.degrees(cmath.phase(crank)),
        reference_body_angle=body_angle,
        skeleton=Skeleton(
            joints={"O2": to_point(o2), "O4": to_point(o4), "A": to_point(a), "P": to_point(p)},
            links=[
                Link(name="ground", joints=["O2", "O4"]),
                Link(name="input", joints=["O2", "A"]),
                Link(name="coupler", joints=["A", "P"]),
            ],
            slides=[Slide(joint="O4", link="coupler", point=to_point(o4), angle=math.degrees(line_angle))],
            input_link="input",
        ),
    )


def body_shift(mechanism: LinkageMechanism, demanded: float) -> float:
    """How far the body is turned in the reference from the first demanded angle (degrees), radians in [−π, π]."""
    stands = mechanism.reference_body_angle
    return 0.0 if stands is None else math.radians(math.remainder(stands - demanded, 360.0))


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
