"""Curves in files of other programs: drawings (SVG, DXF), tables (CSV) and pictures (PNG), as points with y upwards.

A *curve* is a sequence of points of the plane, open or closed. It represents the drawn curve within a *chord
tolerance*: no piece of the drawn curve is farther than that from the chord between the points at its ends.

:mod:`service.imports.reading` is the entry point; it imports the libraries that read files, so it is not imported here.
:mod:`service.imports.desk` reads files in processes with bounded time and memory.
"""

from service.imports.answer import ImportedCurve, ImportedPoint, Imports

__all__ = ["ImportedCurve", "ImportedPoint", "Imports"]
