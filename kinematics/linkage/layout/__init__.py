"""How a finished linkage is built in planes: what crosses in its motion, and which plate lies where.

A linkage is drawn in one plane, but built in several: links that a pin joins lie on each other, and whatever else meets
in the motion has to be kept apart as well. :mod:`~kinematics.linkage.layout.parts` says what is built,
:mod:`~kinematics.linkage.layout.planes` finds the fewest planes, and :mod:`~kinematics.linkage.layout.plan` sweeps the
motion and puts both together.
"""

from kinematics.linkage.layout.parts import GearDisc, gear_discs
from kinematics.linkage.layout.plan import Clash, Layout, laid_out

__all__ = ["Clash", "GearDisc", "Layout", "gear_discs", "laid_out"]
