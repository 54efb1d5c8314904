"""How a finished linkage is built in planes: what crosses in its motion, and which plate lies where.

A linkage is drawn in one plane, but built in several: links that a pin joins lie on each other, and whatever else meets
in the motion has to be kept apart as well. :mod:`~kinematics.linkage.layout.parts` says what is built,
:mod:`~kinematics.linkage.layout.planes` finds the fewest planes, and :mod:`~kinematics.linkage.layout.plan` sweeps the
motion and puts both together. What no planes between two bases can part, :mod:`~kinematics.linkage.layout.divided` lays
out on either side of a base.
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
