"""Results available for pin-jointed fourbars only: cognates, centrodes, curvature, and the sextic of the coupler curve.

Only requested results are computed. Cognates are given in the form of mechanisms in requests.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic import Field

from kinematics.arrays import Complex, Real
from kinematics.errors import DimensionError
from kinematics.linkage.fourbar import (
    ACNODE,
    CROSSED_ASSEMBLY,
    CRUNODE,
    CUSP,
    OPEN_ASSEMBLY,
    Cognate,
    Fourbar,
    build_cognates,
    build_geared_fivebar_cognate,
    build_parallel_motion,
    compute_path_curvature,
    compute_sextic_coefficients,
    coupler_curve_degree,
    curve_unit,
    find_double_points,
    find_pole,
    positions,
)
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from kinematics.message import compose
from synthesis.mechanisms import GivenFourbar, GivenGearedFivebar, GivenSkeleton, MechanismError
from synthesis.model.answer import Answer
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Point

Topic = Literal["cognates", "centrodes", "curvature", "coupler_curve"]
"""Results that can be requested."""

ASSEMBLY = {OPEN_ASSEMBLY: "open", CROSSED_ASSEMBLY: "crossed"}
KIND = {CRUNODE: "crunode", CUSP: "cusp", ACNODE: "acnode"}


class Points(Answer):
    """A point over the positions; null where there is none."""

    x: list[float | None]
    y: list[float | None]


class FourbarCognates(Answer):
    """Mechanisms that trace the same coupler curve, in the configurations that belong to the reference."""

    left: GivenFourbar = Field(description="On O2 and the third pivot; its input turns with the source's coupler.")
    right: GivenFourbar = Field(description="On the third pivot and O4; its input turns with the source's input.")
    geared_fivebar: GivenGearedFivebar
    parallel_motion: GivenSkeleton = Field(description="Watt I: the link P Q moves along the curve without turning.")


class Centrodes(Answer):
    """The coupler's pole over the positions."""

    fixed: Points = Field(description="Coordinates in the global frame.")
    moving: Points = Field(description="Coordinates in the coupler's frame: origin at A, x axis towards B.")


class Curvature(Answer):
    """Curvature of the coupler point's path, and the inflection circle of the coupler."""

    curvature: list[float | None] = Field(
        description="1/length, positive where the path bends to the left while the input angle rises."
    )
    center: Points
    inflection_center: Points = Field(description="Centre of the inflection circle, which passes through the pole.")
    inflection_diameter: list[float | None]


class PassedBy(Answer):
    """A configuration of the fourbar."""

    input_angle: float
    assembly: Literal["open", "crossed"]


class DoublePoint(Answer):
    """A real double point of the coupler curve, and the configurations in which P passes it (none at an acnode)."""

    kind: Literal["crunode", "cusp", "acnode"]
    point: Point
    configurations: list[PassedBy]


class CouplerCurve(Answer):
    """The curve's sextic Σ (real + i imaginary)[j][k] ξ^j ξ̄^k = 0, ξ = (x + i y − O2) / unit, and its double points."""

    degree: int
    unit: float
    real: Annotated[list[list[float]], Field(min_length=4, max_length=4)]
    imaginary: Annotated[list[list[float]], Field(min_length=4, max_length=4)]
    double_points: list[DoublePoint]


class FourbarAnalysis(Answer):
    """Requested results for a fourbar; all others are null."""

    cognates: FourbarCognates | None = None
    centrodes: Centrodes | None = None
    curvature: Curvature | None = None
    coupler_curve: CouplerCurve | None = None


class AssembledFourbar(NamedTuple):
    """A fourbar and its assembly sign."""

    linkage: Fourbar
    assembly: int


def extract_fourbar(mechanism: Mechanism) -> AssembledFourbar | None:
    """Extract the pin-jointed fourbar; None for another mechanism.

    The coupler point is the third joint of the coupler, or A if it has none.
    """
    if len(mechanism.links) != 4 or mechanism.slides or mechanism.gears:
        return None
    ground = set(mechanism.links[GROUND])
    outputs = [n for n, j in mechanism.links.items() if n not in (GROUND, mechanism.input) and ground & set(j)]
    if len(outputs) != 1:
        return None
    (output,) = outputs
    (coupler,) = (n for n in mechanism.links if n not in (GROUND, mechanism.input, output))
    pins = []
    for one, other in ((GROUND, mechanism.input), (mechanism.input, coupler), (coupler, output), (output, GROUND)):
        (joint,) = set(mechanism.links[one]) & set(mechanism.links[other])
        pins.append(joint)
    o2, a, b, o4 = (complex(mechanism.joints[joint]) for joint in pins)
    if min(abs(a - o2), abs(b - a), abs(b - o4), abs(o4 - o2)) == 0.0:
        return None
    point = next((complex(mechanism.joints[j]) for j in mechanism.links[coupler] if j not in pins), a)
    length = abs(b - a)
    linkage = Fourbar(o2, o4, abs(a - o2), length, abs(b - o4), (point - a) * length / (b - a))
    return AssembledFourbar(linkage, CROSSED_ASSEMBLY if ((o4 - a).conjugate() * (b - a)).imag < 0.0 else OPEN_ASSEMBLY)


def analyze_fourbar(mechanism: Mechanism, at: Real, topics: list[Topic]) -> JsonObject:
    """Compute the requested results over input angles in radians, in the form of :class:`FourbarAnalysis`.

    Raises
    ------
    MechanismError
        For another mechanism, or a coupler point on a moving pivot, whose curve is a circle.
    """
    stated = extract_fourbar(mechanism)
    if stated is None:
        raise MechanismError("", compose("analyses-only-fourbar-has-topics", topics=_list_topics(topics)))
    reference = float(mechanism.reference_input)
    make: dict[Topic, Callable[[], JsonObject]] = {
        "cognates": lambda: _describe_cognates(stated, reference),
        "centrodes": lambda: _describe_centrodes(stated, at),
        "curvature": lambda: _describe_curvature(stated, at),
        "coupler_curve": lambda: _describe_coupler_curve(stated.linkage),
    }
    try:
        return {topic: describe() if topic in topics else None for topic, describe in make.items()}
    except DimensionError:
        raise MechanismError("", compose("analyses-coupler-point-on-pivot")) from None


def _list_topics(topics: Sequence[Topic]) -> str:
    listed: str = topics[0]
    for topic in topics[1:]:
        listed = compose("analyses-topics", topics=listed, topic=topic)
    return listed


def _describe_cognates(assembled: AssembledFourbar, reference: float) -> JsonObject:
    """Describe the two cognates of Roberts and Chebyshev and the geared fivebar of the same curve as mechanisms."""
    linkage, assembly = assembled
    pair = build_cognates(linkage)
    fivebar = build_geared_fivebar_cognate(linkage)
    here = positions(linkage, reference, assembly)
    a, b, p = (complex(z) for z in (here.a, here.b, here.p))
    coupler = cmath.phase(b - a)
    five_input = coupler + float(fivebar.input_offset)
    five_pin = complex(fivebar.input_pivot) + float(fivebar.input) * cmath.exp(1j * five_input)
    ground = cmath.phase(complex(fivebar.output_pivot) - complex(fivebar.input_pivot))
    five_output = ground + float(fivebar.gear_ratio) * (five_input - ground) + float(fivebar.phase)
    other_pin = complex(fivebar.output_pivot) + float(fivebar.output) * cmath.exp(1j * five_output)
    left_of = ((other_pin - five_pin).conjugate() * (p - five_pin)).imag
    return {
        "left": _describe_cognate(pair.left, reference, assembly),
        "right": _describe_cognate(pair.right, reference, assembly),
        "geared_fivebar": {
            "type": "geared_fivebar",
            "fixed_pivots": {
                "input": _convert_to_pair(fivebar.input_pivot),
                "output": _convert_to_pair(fivebar.output_pivot),
            },
            "links": {
                "input": float(fivebar.input),
                "coupler_1": float(fivebar.coupler_1),
                "coupler_2": float(fivebar.coupler_2),
                "output": float(fivebar.output),
            },
            "gear_ratio": float(fivebar.gear_ratio),
            "phase": math.degrees(float(fivebar.phase)),
            "coupler_point": _convert_to_polar(fivebar.coupler_point),
            "assembly": "crossed" if left_of < 0.0 else "open",
            "reference_input_angle": math.degrees(five_input),
        },
        "parallel_motion": _build_parallel_motion(linkage, a, b, p),
    }


def _describe_cognate(cognate: Cognate, reference: float, assembly: int) -> JsonObject:
    linkage, here = cognate.linkage, cognate.configuration(reference, assembly)
    return {
        "type": "fourbar",
        "fixed_pivots": {
            "input": _convert_to_pair(linkage.input_pivot),
            "output": _convert_to_pair(linkage.output_pivot),
        },
        "links": {
            "input": float(linkage.input),
            "coupler": float(linkage.coupler),
            "output": float(linkage.output),
        },
        "coupler_point": _convert_to_polar(linkage.coupler_point),
        "assembly": ASSEMBLY[int(here.assembly)],
        "reference_input_angle": math.degrees(float(here.input_angle)),
    }


def _build_parallel_motion(linkage: Fourbar, a: complex, b: complex, p: complex) -> JsonObject:
    """Build the sixbar whose link moves parallel to itself along the coupler curve."""
    translating = build_parallel_motion(linkage)
    o2 = complex(linkage.input_pivot)
    joints = {
        "O2": o2,
        "O4": complex(linkage.output_pivot),
        "A": a,
        "B": b,
        "P": p,
        "C": o2 + complex(translating.crank_point) * (a - o2) / float(linkage.input),
        "Q": p + complex(translating.translation),
    }
    links = {
        "ground": ["O2", "O4"],
        "input": ["O2", "A", "C"],
        "coupler": ["A", "B", "P"],
        "output": ["O4", "B"],
        "guide": ["C", "Q"],
        "translating": ["P", "Q"],
    }
    return {
        "type": "watt_1",
        "skeleton": {
            "joints": {name: _convert_to_pair(z) for name, z in joints.items()},
            "links": [{"name": name, "joints": listed} for name, listed in links.items()],
            "input_link": "input",
        },
    }


def _describe_centrodes(assembled: AssembledFourbar, at: Real) -> JsonObject:
    poles = find_pole(assembled.linkage, at, assembled.assembly)
    return {"fixed": _list_points(poles.point), "moving": _list_points(np.where(poles.finite, poles.moving, np.nan))}


def _describe_curvature(assembled: AssembledFourbar, at: Real) -> JsonObject:
    path = compute_path_curvature(assembled.linkage, at, assembled.assembly)
    circle = find_pole(assembled.linkage, at, assembled.assembly)
    return {
        "curvature": path.curvature.tolist(),
        "center": _list_points(path.center),
        "inflection_center": _list_points(0.5 * (circle.point + circle.inflection_pole)),
        "inflection_diameter": circle.inflection_diameter.tolist(),
    }


def _describe_coupler_curve(linkage: Fourbar) -> JsonObject:
    coefficients, double = compute_sextic_coefficients(linkage), find_double_points(linkage)
    listed = []
    for n in np.flatnonzero(double.valid):
        passed = [
            {"input_angle": math.degrees(angle), "assembly": ASSEMBLY[int(sign)]}
            for angle, sign in zip(double.input_angle[n].tolist(), double.assembly[n], strict=True)
            if not math.isnan(angle)
        ]
        kind = KIND[int(double.kind[n])]
        configurations = passed[:1] if kind == "cusp" else passed
        listed.append({"kind": kind, "point": _convert_to_pair(double.point[n]), "configurations": configurations})
    return {
        "degree": coupler_curve_degree(4),
        "unit": float(curve_unit(linkage)),
        "real": coefficients.real.tolist(),
        "imaginary": coefficients.imag.tolist(),
        "double_points": listed,
    }


def _list_points(z: Complex) -> dict[str, list[float]]:
    return {"x": z.real.tolist(), "y": z.imag.tolist()}


def _convert_to_pair(z: Complex | complex) -> tuple[float, float]:
    return complex(z).real, complex(z).imag


def _convert_to_polar(z: Complex) -> dict[str, float]:
    return {"distance": abs(complex(z)), "angle": math.degrees(cmath.phase(complex(z)))}
