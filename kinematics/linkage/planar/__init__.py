"""Planar linkages of any number of links, as dyads and triads: description and motion.

Branches and circuits are in :mod:`kinematics.linkage.planar.limits`, which is not imported here to save start-up time.
"""

from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import GROUND, GearPair, Mechanism, Slide, TopologyError

__all__ = [
    "GROUND",
    "GearPair",
    "Mechanism",
    "MechanismMotion",
    "Slide",
    "TopologyError",
    "catalogue",
    "drive",
]
