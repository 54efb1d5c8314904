"""Planar linkages: what a given linkage does.

A linkage of the :mod:`catalogue <kinematics.linkage.planar.catalogue>`, or any other as a :class:`Mechanism`, is driven
by :func:`drive`. The fourbar (:mod:`kinematics.linkage.fourbar`) and the slider-crank
(:mod:`kinematics.linkage.slider_crank`) have closed forms besides, for many designs at once.
"""

from kinematics.linkage import fourbar, slider_crank
from kinematics.linkage.batch import CROSSED, OPEN
from kinematics.linkage.fourbar import Fourbar
from kinematics.linkage.mobility import mobility
from kinematics.linkage.planar import (
    GROUND,
    GearPair,
    Mechanism,
    MechanismMotion,
    Slide,
    TopologyError,
    catalogue,
    drive,
)
from kinematics.linkage.slider_crank import SliderCrank

__all__ = [
    "CROSSED",
    "GROUND",
    "OPEN",
    "Fourbar",
    "GearPair",
    "Mechanism",
    "MechanismMotion",
    "Slide",
    "SliderCrank",
    "TopologyError",
    "catalogue",
    "drive",
    "fourbar",
    "mobility",
    "slider_crank",
]
