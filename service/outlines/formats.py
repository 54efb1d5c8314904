"""Detection of the format of a drawing, and conversion of its curves to the requested unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinematics.message import Message, compose
from service.outlines import dxf, svg
from service.outlines.answer import DrawingUnit
from service.outlines.curves import Curve, Source
from service.outlines.drawing import Drawing
from service.outlines.faults import ForeignFormat
from service.outlines.limits import MAX_COORDINATE

MILLIMETRES_PER_UNIT: dict[DrawingUnit, float] = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

_TEXT_DXF_PATTERN = re.compile(rb"\s*(?:0|999)[ \t]*\r?\n")
_COMPRESSED_SIGNATURES = (b"\x1f\x8b", b"PK\x03\x04")


class DrawingCurves(NamedTuple):
    """The curves of a drawing in the unit of the answer; ``scale`` is the number of those units in a drawing unit."""

    curves: list[Curve]
    left_out: list[tuple[Source, Message]]
    scale: float
    unit: DrawingUnit | None


def read_drawing(content: bytes) -> Drawing | None:
    """Read an SVG or DXF file; return None if the content begins like neither.

    Raises
    ------
    DrawingError
        If the content is invalid in the format that its first bytes indicate, or that format is not supported.
    """
    if content.startswith(b"AutoCAD Binary DXF"):
        raise ForeignFormat(compose("outlines-binary-dxf"))
    if content.startswith(b"AC10"):
        raise ForeignFormat(compose("outlines-dwg"))
    if content.startswith(_COMPRESSED_SIGNATURES):
        raise ForeignFormat(compose("outlines-compressed"))
    # Editors on Windows write a byte-order mark before UTF-8.
    bare = content.removeprefix(b"\xef\xbb\xbf")
    if bare.lstrip()[:1] == b"<" or content[:4] in (b"\xff\xfe<\0", b"\xfe\xff\0<"):
        return svg.read_curves(content)
    if _TEXT_DXF_PATTERN.match(bare):
        return dxf.read_curves(bare)
    return None


def convert_units(drawing: Drawing, length_unit: DrawingUnit | None) -> DrawingCurves:
    """Convert the curves to a unit, if the drawing gives its own; leave out curves with coordinates out of range."""
    scale, unit = 1.0, None
    if length_unit is not None and drawing.millimetres is not None:
        scale, unit = drawing.millimetres / MILLIMETRES_PER_UNIT[length_unit], length_unit
    left_out = list(drawing.left_out)
    out_of_range = Message("outlines-coordinates-out-of-range", {"limit": f"{MAX_COORDINATE:g}"})
    curves = []
    for one in drawing.curves:
        curve = one.scale_by(scale)
        if curve.finite:
            curves.append(curve)
        else:
            left_out.append((one.source, out_of_range))
    return DrawingCurves(curves, left_out, scale, unit)


def measure_extent(curves: Sequence[Curve]) -> float:
    """Return the larger side of the box around all curves."""
    if not curves:
        return 0.0
    low, high = np.array([one.corners for one in curves]).T
    return float(max(high.real.max() - low.real.min(), high.imag.max() - low.imag.min()))
