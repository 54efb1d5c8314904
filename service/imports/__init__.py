"""Curves in what other programs made: drawings (SVG, DXF), tables (CSV) and pictures (PNG), as points with y upwards.

A *curve* is a row of points of the plane, open or closed. It stands for what the file draws within a *chord tolerance*:
no piece of the drawn curve is farther than that from the chord between the two points at its ends.

:mod:`service.imports.reading` is the door; it brings the libraries that read files, so it is not imported here.
:mod:`service.imports.desk` has files read by processes of their own, whose time and memory are bounded.
"""

from service.imports.answer import ImportedCurve, ImportedPoint, Imports

__all__ = ["ImportedCurve", "ImportedPoint", "Imports"]
