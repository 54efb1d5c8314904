"""Arrangement of a finished linkage in parallel planes: collisions during its motion, and a plane for each plate.

A linkage is drawn in one plane but built in several: links joined by a pin lie on top of each other, and other parts
that would collide during the motion need different planes as well. :mod:`~kinematics.linkage.layout.parts` lists the
parts, :mod:`~kinematics.linkage.layout.planes` minimizes the number of planes, and
:mod:`~kinematics.linkage.layout.plan` sweeps the motion and combines both. If no arrangement between two bases works,
:mod:`~kinematics.linkage.layout.divided` places parts on both sides of a base.
"""

from kinematics.linkage.layout.divided import DividedLayout, divisions, laid_out_divided
from kinematics.linkage.layout.parts import Division, GearDisc, Piece, gear_discs, pieces
from kinematics.linkage.layout.plan import Clash, Layout, laid_out

__all__ = [
    "Clash",
    "DividedLayout",
    "Division",
    "GearDisc",
    "Layout",
    "Piece",
    "divisions",
    "gear_discs",
    "laid_out",
    "laid_out_divided",
    "pieces",
]
