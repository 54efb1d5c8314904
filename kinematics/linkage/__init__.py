"""Planar linkages: analysis of a given linkage.

A linkage of the :mod:`catalogue <kinematics.linkage.planar.catalogue>`, or any other :class:`Mechanism`, is driven by
:func:`drive`. For many designs at once, the fourbar (:mod:`kinematics.linkage.fourbar`) and the slider-crank
(:mod:`kinematics.linkage.slider_crank`) also have closed forms.
"""

from kinematics.linkage import fourbar, slider_crank
from kinematics.linkage.batch import CROSSED_ASSEMBLY, OPEN_ASSEMBLY
from kinematics.linkage.fourbar import Fourbar
from kinematics.linkage.mobility import compute_mobility
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
    "CROSSED_ASSEMBLY",
    "GROUND",
    "OPEN_ASSEMBLY",
    "Fourbar",
    "GearPair",
    "Mechanism",
    "MechanismMotion",
    "Slide",
    "SliderCrank",
    "TopologyError",
    "catalogue",
    "compute_mobility",
    "drive",
    "fourbar",
    "slider_crank",
]
