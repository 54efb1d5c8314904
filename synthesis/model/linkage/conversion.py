"""Conversion between the models (degrees, pairs, names) and the analysis core (radians, complex numbers).

Joints have the usual names: O2, O4 fixed pivots, A, B moving pivots, P the coupler point.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple, TypeVar

from kinematics.linkage.fourbar import CROSSED_ASSEMBLY, OPEN_ASSEMBLY, Fourbar
from synthesis.model.answer import Point
from synthesis.model.linkage.answer import (
    BlockSlide,
    CouplerPoint,
    FixedPivots,
    FourbarLinks,
    FourbarMechanism,
    GearPair,
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

    @property
    def lengths(self) -> tuple[float, float, float, float]:
        """Lengths of input, coupler, output and ground."""
        return abs(self.a - self.o2), abs(self.b - self.a), abs(self.b - self.o4), abs(self.o4 - self.o2)

    def has_no_link_below(self, share: float) -> bool:
        """Return whether every link is longer than this share of the longest one; otherwise it is degenerate."""
        return min(self.lengths) > share * max(self.lengths)


FOURBAR_LINKS = {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B", "P"), "output": ("O4", "B")}
"""The joints on each link of a fourbar."""


def to_point(z: complex) -> Point:
    """Return a complex number as a pair (x, y)."""
    return (float(z.real), float(z.imag))


def to_complex(point: tuple[float, float]) -> complex:
    """Return a pair (x, y) as a complex number."""
    return complex(*point)


def build_skeleton(
    joints: Mapping[str, complex],
    links: Mapping[str, Sequence[str]],
    *,
    slides: Sequence[Slide] = (),
    gears: Sequence[GearPair] = (),
    input_link: str = "input",
) -> Skeleton:
    """Build a skeleton from the joints at the first target and the names of the joints on each link."""
    return Skeleton(
        joints={name: to_point(z) for name, z in joints.items()},
        links=[Link(name=name, joints=list(listed)) for name, listed in links.items()],
        slides=list(slides),
        gears=list(gears),
        input_link=input_link,
    )


def build_slide(joint: str, link: str, point: complex, angle: float) -> Slide:
    """Build a slide: a joint that stays on a line fixed in a link, through a point at an angle (radians)."""
    return Slide(joint=joint, link=link, point=to_point(point), angle=math.degrees(angle))


def build_coupler_point(a: complex, b: complex, p: complex) -> CouplerPoint:
    """Build the coupler point from the positions of A, B and P."""
    # Divide by the unit vector A → B: the frame of the coupler.
    point = (p - a) / ((b - a) / abs(b - a))
    return CouplerPoint(distance=abs(point), angle=math.degrees(cmath.phase(point)))


Pinned = TypeVar("Pinned", FourbarMechanism, SliderCrankMechanism)


def remove_coupler_point(mechanism: Pinned) -> Pinned:
    """Return the mechanism without the joint P in its skeleton, for tasks that guide no point."""
    bare = build_skeleton(
        {name: to_complex(place) for name, place in mechanism.skeleton.joints.items() if name != "P"},
        {link.name: [joint for joint in link.joints if joint != "P"] for link in mechanism.skeleton.links},
        slides=mechanism.skeleton.slides,
        input_link=mechanism.skeleton.input_link,
    )
    return mechanism.model_copy(update={"skeleton": bare})


def build_fourbar(joints: FourbarConfiguration, body_angle: float | None = None) -> FourbarMechanism:
    """Build the fourbar with the given joints at the first target.

    Joints connected by a link must not coincide. A configuration exactly at a toggle counts as open. ``body_angle``,
    degrees, is the angle of the body at the first target if it differs from the requested one.
    """
    o2, a, b, o4, p = joints
    crank, coupler, output, diagonal = a - o2, b - a, b - o4, o4 - a
    return FourbarMechanism(
        fixed_pivots=FixedPivots(input=to_point(o2), output=to_point(o4)),
        links=FourbarLinks(ground=abs(o4 - o2), input=abs(crank), coupler=abs(coupler), output=abs(output)),
        coupler_point=build_coupler_point(a, b, p),
        # The assembly depends on the side of the line A → O4 on which B lies.
        assembly="open" if (diagonal.conjugate() * coupler).imag >= 0.0 else "crossed",
        reference_input_angle=math.degrees(cmath.phase(crank)),
        reference_body_angle=body_angle,
        skeleton=build_skeleton({"O2": o2, "O4": o4, "A": a, "B": b, "P": p}, FOURBAR_LINKS),
    )


def build_slider_crank(
    o2: complex,
    a: complex,
    b: complex,
    slide_angle: float,
    p: complex,
    *,
    driven_by: Literal["crank", "slider"] = "crank",
    body_angle: float | None = None,
) -> SliderCrankMechanism:
    """Build the slider-crank with the given joints at the first target; the angle of the slide is in radians.

    The joints of crank and coupler must not coincide. A configuration exactly at the limit of the crank's reach counts
    as open.
    """
    crank, coupler, along = a - o2, b - a, cmath.exp(1j * slide_angle)
    line = Line(point=to_point(b), angle=math.degrees(slide_angle))
    return SliderCrankMechanism(
        fixed_pivot=to_point(o2),
        links=SliderCrankLinks(crank=abs(crank), coupler=abs(coupler)),
        slide=line,
        offset=((o2 - b) * along.conjugate()).imag,
        coupler_point=build_coupler_point(a, b, p),
        assembly="open" if (coupler * along.conjugate()).real >= 0.0 else "crossed",
        driven_by=driven_by,
        reference_input_angle=math.degrees(cmath.phase(crank)),
        reference_body_angle=body_angle,
        skeleton=build_skeleton(
            {"O2": o2, "A": a, "B": b, "P": p},
            {"ground": ["O2"], "crank": ["O2", "A"], "coupler": ["A", "B", "P"]},
            slides=[build_slide("B", "ground", b, slide_angle)],
            input_link="crank" if driven_by == "crank" else "B",
        ),
    )


def build_inverted_slider_crank(
    o2: complex, a: complex, o4: complex, line_angle: float, p: complex, *, body_angle: float | None = None
) -> InvertedSliderCrankMechanism:
    """Build the inverted slider-crank with the given joints at the first target.

    The body has the pin A, and its line at ``line_angle`` (radians) slides through the block at O4. Relative to the
    block, A moves on a parallel line; B is the foot of O4 on it. A must not coincide with O2 or O4.
    """
    crank, reach = a - o2, a - o4
    along = cmath.exp(1j * line_angle)
    # With the angle of the line from O4 → B at +90°, B lies to the right of the line's direction.
    if (1j * along.conjugate() * reach).real < 0.0:
        # Reverse the line's direction, so that the output length is positive.
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
        skeleton=build_skeleton(
            {"O2": o2, "O4": o4, "A": a, "P": p},
            {"ground": ["O2", "O4"], "input": ["O2", "A"], "coupler": ["A", "P"]},
            slides=[build_slide("O4", "coupler", o4, line_angle)],
        ),
    )


def compute_body_shift(mechanism: LinkageMechanism, demanded: float) -> float:
    """Return the rotation of the body from the first requested angle to the reference configuration, in [−π, π].

    ``demanded`` is the requested angle in degrees; the result is in radians.
    """
    stands = mechanism.reference_body_angle
    # Return the shorter rotation, because angles of a body are known modulo a full turn.
    return 0.0 if stands is None else math.radians(math.remainder(stands - demanded, 360.0))


class DrivenFourbar(NamedTuple):
    """A fourbar for the analysis core: linkage, assembly sign, and input angle (radians) in the reference."""

    linkage: Fourbar
    assembly: int
    reference: float


def build_driven_fourbar(mechanism: FourbarMechanism) -> DrivenFourbar:
    """Convert the dimensions of a fourbar for the analysis core, ignoring its skeleton."""
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
        linkage,
        OPEN_ASSEMBLY if mechanism.assembly == "open" else CROSSED_ASSEMBLY,
        math.radians(mechanism.reference_input_angle),
    )
