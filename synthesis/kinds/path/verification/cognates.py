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
from kinematics.message import compose, join_messages
from synthesis.kinds.path.design import PathCognate, PathDesign
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.conversion import DrivenFourbar, FourbarConfiguration, build_driven_fourbar, build_fourbar

MIN_INPUT_SEPARATION = 1e-9
"""Separation of inputs, radians, below which two targets are met at the same input."""

ANGLE_TOLERANCE = 0.05
"""Transmission angles that differ by less than this, in degrees, count as equal."""

MOTION_NAMES = {
    "double_crank": "path-double-crank",
    "crank_rocker": "path-crank-rocker",
    "rocker_crank": "path-rocker-crank",
    "double_rocker": "path-double-rocker",
    "rocker_rocker": "path-rocker-rocker",
    "change_point": "path-change-point",
}
"""Messages with the names of the motions in Barker's classification."""


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
        text = compose("path-no-cognates")
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
    motion = design.metrics.grashof
    sentences = [
        compose("path-transmission-of-linkage", angle=f"{ours:.1f}")
        if motion is None
        else compose("path-transmission-of-type", type=compose(MOTION_NAMES[motion]), angle=f"{ours:.1f}")
    ]
    for cognate in driven:
        name = _name_cognate(cognate)
        if not cognate.same_branch:
            sentences.append(compose("path-cognate-passes-toggle", cognate=name))
        elif not cognate.visits_in_order:
            sentences.append(compose("path-cognate-out-of-order", cognate=name))
        else:
            gain = cognate.min_transmission_angle - ours
            sentences.append(
                compose(
                    "path-cognate-with-same-timing" if cognate.same_timing else "path-cognate-with-other-timing",
                    cognate=name,
                    comparison="equal" if abs(gain) <= ANGLE_TOLERANCE else "larger" if gain > 0.0 else "smaller",
                    angle=f"{cognate.min_transmission_angle:.1f}",
                )
            )
    return join_messages(sentences)


def _name_cognate(cognate: PathCognate) -> str:
    """Return the beginning of a sentence about a cognate: its side, its type and its fixed pivots."""
    pivots = cognate.mechanism.fixed_pivots
    return compose(
        "path-left-cognate" if cognate.side == "left" else "path-right-cognate",
        type=compose(MOTION_NAMES[cognate.grashof]),
        input_x=f"{pivots.input[0]:.4g}",
        input_y=f"{pivots.input[1]:.4g}",
        output_x=f"{pivots.output[0]:.4g}",
        output_y=f"{pivots.output[1]:.4g}",
    )
