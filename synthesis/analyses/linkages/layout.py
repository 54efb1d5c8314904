"""Arrangement of a linkage in planes, in the form of an answer."""

from __future__ import annotations

import math

import numpy as np

from kinematics.errors import MechanismError
from kinematics.linkage import layout as core
from kinematics.linkage.clearance.scene import RangeError
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import find_cycle_from_reference
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.message import compose
from synthesis.analyses.linkages.cycle import find_cycle
from synthesis.model.json_object import JsonObject
from synthesis.model.layout import LayoutSizes
from synthesis.model.linkage.answer import Layout, LayoutClash

PROBE_COUNT = 181
"""Number of inputs at which to test whether the mechanism can be assembled over the motion."""

CYCLE_TOLERANCE = 1e-9
"""Tolerance with which a motion counts as closed, as a share of a cycle, for rounding."""


def lay_out_mechanism(mechanism: Mechanism, sizes: LayoutSizes, used: tuple[float, float] | None) -> Layout:
    """Arrange a linkage in planes; a range that is too long to be examined gives an empty layout with a remark.

    Parameters
    ----------
    mechanism : Mechanism
        One design, in its reference configuration.
    sizes : LayoutSizes
        Sizes of links and pins.
    used : pair of float or None
        First and last input of the used range, radians or positions along the input slide; None if no motion passes
        through the targets.
    """
    try:
        return lay_out_range(mechanism, sizes, used)
    except RangeError as error:
        return _build_empty_layout(str(error))


def lay_out_range(mechanism: Mechanism, requested: LayoutSizes, used: tuple[float, float] | None) -> Layout:
    """Arrange a linkage in planes for a range of its input; a range longer than a cycle is reduced to one cycle.

    Raises
    ------
    RangeError
        For a range that is too long to be examined.
    """
    slides = mechanism.has_slide_input
    try:
        if requested.over == "cycle":
            used = find_cycle(mechanism)
        if used is None:
            return _build_empty_layout(compose("analyses-layout-range-blocked"))
        turn = math.inf if slides else find_cycle_from_reference(mechanism)
        low, high = sorted(used)
        high = min(high, low + turn)
        inputs = np.linspace(low, high, PROBE_COUNT + 2)[1:-1] if high > low else np.array([low])
        if not drive(mechanism, inputs, order=0).valid.all():
            return _build_empty_layout(compose("analyses-layout-not-assembled"))
        found = core.arrange_planes(
            mechanism,
            low,
            high,
            link_width=requested.link_width,
            pin_diameter=requested.pin_diameter,
            gap=requested.gap,
            through=requested.shafts == "both_sides",
            closed=math.isfinite(turn) and abs(high - low - turn) <= CYCLE_TOLERANCE * turn,
        )
    except RangeError:
        raise
    except MechanismError as error:
        return _build_empty_layout(str(error))
    count = max(found.planes.values())
    unit = 1.0 if slides else 180.0 / math.pi
    free = None if found.free is None else (unit * found.free[0], unit * found.free[1])

    def place(at: float) -> JsonObject:
        return {"input_place": at} if slides else {"input_angle": math.degrees(at)}

    return Layout(
        buildable=not found.clashes,
        planes=found.planes,
        count=count,
        least=True,
        height=count * (requested.thickness + requested.gap),
        pins=found.pins,
        stub_shafts=found.stub_shafts,
        crossings=found.crossings,
        clashes=[LayoutClash(parts=one.parts, distance=one.distance, **place(one.at)) for one in found.clashes],
        free_range=None if slides else free,
        free_stroke=free if slides else None,
    )


def _build_empty_layout(reason: str) -> Layout:
    return Layout(
        buildable=False,
        planes={},
        count=0,
        least=False,
        height=0.0,
        pins={},
        stub_shafts=[],
        crossings=[],
        clashes=[],
        remark=reason,
    )
