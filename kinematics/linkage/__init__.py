"""Planar linkages: the fourbar's motion, classification, transmission angle, circuits, and mobility by counting."""

from kinematics.linkage.circuits import (
    Circuits,
    InputLimits,
    Traversal,
    count_circuits,
    full_rotation,
    input_limits,
    same_circuit,
    stays_on_branch,
    toggle_angles,
    traverse,
)
from kinematics.linkage.classification import (
    BARKER,
    BarkerClass,
    barker_class,
    barker_type,
    can_assemble,
    grashof_class,
    grashof_excess,
)
from kinematics.linkage.fourbar import CROSSED, OPEN, Derivatives, Fourbar, Motion, Positions, motion, positions
from kinematics.linkage.mobility import mobility
from kinematics.linkage.transmission import transmission_angle, transmission_extremes

__all__ = [
    "BARKER",
    "CROSSED",
    "OPEN",
    "BarkerClass",
    "Circuits",
    "Derivatives",
    "Fourbar",
    "InputLimits",
    "Motion",
    "Positions",
    "Traversal",
    "barker_class",
    "barker_type",
    "can_assemble",
    "count_circuits",
    "full_rotation",
    "grashof_class",
    "grashof_excess",
    "input_limits",
    "mobility",
    "motion",
    "positions",
    "same_circuit",
    "stays_on_branch",
    "toggle_angles",
    "transmission_angle",
    "transmission_extremes",
    "traverse",
]
