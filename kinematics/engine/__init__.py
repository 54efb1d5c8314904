"""Piston engines: exact piston kinematics, harmonics of their forces and moments, firing orders."""

from kinematics.engine.firing import Firing, compute_unevenness, list_firing_choices
from kinematics.engine.harmonics import TurningParts, compute_turning_parts, sum_torque
from kinematics.engine.pistons import (
    Rod,
    build_two_mass_rod,
    compute_acceleration_harmonics,
    compute_binomial_terms,
    compute_piston_motion,
)

__all__ = [
    "Firing",
    "Rod",
    "TurningParts",
    "build_two_mass_rod",
    "compute_acceleration_harmonics",
    "compute_binomial_terms",
    "compute_piston_motion",
    "compute_turning_parts",
    "compute_unevenness",
    "list_firing_choices",
    "sum_torque",
]
