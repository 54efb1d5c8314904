"""Piston engines: exact piston kinematics, harmonics of their forces and moments, firing orders."""

from kinematics.engine.firing import Firing, firing_choices, unevenness
from kinematics.engine.harmonics import Turning, torque_sum, turning_parts
from kinematics.engine.pistons import Rod, acceleration_harmonics, binomial_terms, piston, two_mass_rod

__all__ = [
    "Firing",
    "Rod",
    "Turning",
    "acceleration_harmonics",
    "binomial_terms",
    "firing_choices",
    "piston",
    "torque_sum",
    "turning_parts",
    "two_mass_rod",
    "unevenness",
]
