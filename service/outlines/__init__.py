"""Closed outlines in SVG and DXF drawings from other programs, as polygons and circles in a plane with y upwards.

:mod:`service.outlines.reading` is the entry point. It loads the libraries that read drawings, so it is
not imported here.
"""

from service.outlines.answer import DrawingUnit, Outline, Outlines
from service.outlines.faults import DrawingError, ForeignFormat, MalformedDrawing, NoOutline, UnsuitableDrawing

__all__ = [
    "DrawingError",
    "DrawingUnit",
    "ForeignFormat",
    "MalformedDrawing",
    "NoOutline",
    "Outline",
    "Outlines",
    "UnsuitableDrawing",
]
