"""Closed outlines in drawings that others made, SVG and DXF, as polygons and circles of the plane with y upwards.

:mod:`service.outlines.reading` is the door. It brings the libraries that read drawings, so it is not imported here.
"""

from service.outlines.answer import DrawingUnit, Outline, Outlines
from service.outlines.faults import DrawingError, ForeignFormat, Malformed, NoOutline, Unsuitable

__all__ = [
    "DrawingError",
    "DrawingUnit",
    "ForeignFormat",
    "Malformed",
    "NoOutline",
    "Outline",
    "Outlines",
    "Unsuitable",
]
