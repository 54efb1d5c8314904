"""Cognates of a design, driven past the same points, measured, and compared with the design.

Each fourbar has two cognates that trace its curve (:mod:`kinematics.linkage.fourbar.cognates`). They have other fixed
pivots, may be of another Grashof type, and one may pass a toggle between points that another reaches without a toggle.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from kinematics.errors import DimensionError
from kinematics.linkage.fourbar import (
    Cognate,
    barker_class,
    build_cognates,
    find_transmission_extremes,
    positions,
    traverse,
)
from synthesis.kinds.path.design import PathCognate, PathDesign
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.conversion import DrivenFourbar, FourbarConfiguration, build_driven_fourbar, build_fourbar

MIN_INPUT_SEPARATION = 1e-9
"""Separation of inputs, radians, below which two targets are met at the same input."""

ANGLE_TOLERANCE = 0.05
"""Transmission angles that differ by less than this, in degrees, count as equal."""


def add_cognates(design: PathDesign) -> PathDesign:
    """Add to a design its cognates and a comparison of the three.

    Designs that do not pass their points on one branch are unchanged: they have no single motion to compare.
    """
    mechanism = design.mechanism
    # Sixbars and slider-cranks have no cognates of this kind.
    if not isinstance(mechanism, FourbarMechanism) or not design.metrics.same_branch:
        return design
    source = build_driven_fourbar(mechanism)
    try:
        pair = build_cognates(source.linkage)
    except DimensionError:
        text = "P is on a moving pivot, so that its path is a circle or an arc of one, and there are no cognates."
        return design.model_copy(update={"cognate_choice": text})
    measured = (
        _measure_cognate("left", pair.left, source, design),
        _measure_cognate("right", pair.right, source, design),
    )
    driven = [cognate for cognate in measured if cognate is not None]
    return design.model_copy(update={"cognates": driven, "cognate_choice": _describe_choice(design, driven)})


def _measure_cognate(
    side: Literal["left", "right"], cognate: Cognate, source: DrivenFourbar, design: PathDesign
) -> PathCognate | None:
    """Measure a cognate at the design's targets; return None if it has no position there (at a toggle)."""
    inputs = np.radians([target.position for target in design.targets])
    own = positions(source.linkage, inputs, source.assembly)
    at = cognate.configuration(inputs, source.assembly)
    stands = positions(cognate.linkage, at.input_angle[..., None], at.assembly)
    p, a, b = (part[:, 0] for part in (stands.p, stands.a, stands.b))
    if not (np.all(at.valid) and np.all(np.isfinite(p))):
        return None
    # A fit may meet neighbouring points at one place; they count as one target of the motion.
    apart = np.append(True, np.abs(np.diff(inputs)) > MIN_INPUT_SEPARATION)
    way = traverse(cognate.linkage, at.input_angle[apart], at.assembly[apart])
    least = float(find_transmission_extremes(cognate.linkage, way.start, way.end)[0]) if way.same_branch else 0.0
    barker = barker_class(cognate.linkage)
    o2, o4 = complex(cognate.linkage.input_pivot), complex(cognate.linkage.output_pivot)
    return PathCognate(
        side=side,
        mechanism=build_fourbar(FourbarConfiguration(o2, complex(a[0]), complex(b[0]), o4, complex(p[0]))),
        grashof=barker.motion,
        full_rotation=barker.motion in ("double_crank", "crank_rocker"),
        # The input of a cognate turns either with the design's input or with its coupler.
        same_timing=cognate.turns_with[0] == "input",
        same_branch=way.same_branch,
        visits_in_order=way.in_order,
        min_transmission_angle=math.degrees(least),
        deviation=float(np.abs(p - own.p).max()),
    )


def _describe_choice(design: PathDesign, driven: list[PathCognate]) -> str:
    """Describe how the design and its cognates compare in transmission angle, full rotation and defects."""
    ours = design.metrics.min_transmission_angle
    parts = [f"This {_format_motion(design.metrics.grashof)} has a minimum transmission angle of {ours:.1f}°."]
    for cognate in driven:
        (x2, y2), (x4, y4) = cognate.mechanism.fixed_pivots.input, cognate.mechanism.fixed_pivots.output
        name = (
            f"The {cognate.side} cognate, a {_format_motion(cognate.grashof)} on ({x2:.4g}, {y2:.4g}) and ({x4:.4g}, "
            f"{y4:.4g}),"
        )
        if not cognate.same_branch:
            parts.append(f"{name} passes a toggle between the points when its input drives.")
        elif not cognate.visits_in_order:
            parts.append(f"{name} does not meet the points in order when its input turns one way.")
        else:
            gain = cognate.min_transmission_angle - ours
            better = "equal" if abs(gain) <= ANGLE_TOLERANCE else "larger" if gain > 0.0 else "smaller"
            timing = "at the same crank angles" if cognate.same_timing else "its input turning with this one's coupler"
            parts.append(f"{name} guides P through the points {timing}; its minimum transmission angle is {better}: ")
            parts[-1] += f"{cognate.min_transmission_angle:.1f}°."
    return " ".join(parts)


def _format_motion(motion: str | None) -> str:
    return (motion or "linkage").replace("_", "-")
