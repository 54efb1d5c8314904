"""Arrangement of a finished linkage in parallel planes: collisions during its motion, and a plane for each plate.

A linkage is drawn in one plane but built in several: links joined by a pin lie on top of each other, and other parts
that would collide during the motion need different planes as well. :mod:`~kinematics.linkage.layout.parts` lists the
parts, :mod:`~kinematics.linkage.layout.planes` minimizes the number of planes, and
:mod:`~kinematics.linkage.layout.plan` sweeps the motion and combines both. If no arrangement between two bases works,
:mod:`~kinematics.linkage.layout.split_links` places parts on both sides of a base.
:mod:`~kinematics.linkage.layout.widths` finds the widest links for which any of these exists.
"""

from kinematics.linkage.layout.parts import Division, GearDisc, Piece, list_gear_discs, list_pieces
from kinematics.linkage.layout.plan import Clash, Layout, arrange_planes
from kinematics.linkage.layout.split_links import DividedLayout, arrange_divided, list_divisions
from kinematics.linkage.layout.widths import find_greatest_width

__all__ = [
    "Clash",
    "DividedLayout",
    "Division",
    "GearDisc",
    "Layout",
    "Piece",
    "arrange_divided",
    "arrange_planes",
    "find_greatest_width",
    "list_divisions",
    "list_gear_discs",
    "list_pieces",
]
