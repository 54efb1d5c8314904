"""Inverse dynamics of planar linkages: reactions at every joint, the drive, and the shaking force on the frame.

A :class:`Machine` is a mechanism with its masses and loads. Its :class:`Places` are the positions, velocities and
accelerations of its links in a given motion. From them :func:`compute_reactions` solves the Newton-Euler equations of
all links, and :func:`compute_balance` computes the drive and the shaking force from energy and momentum, independently
of the reactions.
"""

from kinematics.dynamics.balance import Balance, compute_balance
from kinematics.dynamics.bodies import Body, make_body
from kinematics.dynamics.loads import JointForce, Load, PointForce, Resistance, Torque, TurningResistance, make_constant
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import Reactions, compute_reactions
from kinematics.dynamics.springs import Spring, TorsionSpring

__all__ = [
    "Balance",
    "Body",
    "JointForce",
    "Load",
    "Machine",
    "Places",
    "PointForce",
    "Reactions",
    "Resistance",
    "Spring",
    "Torque",
    "TorsionSpring",
    "TurningResistance",
    "compute_balance",
    "compute_reactions",
    "make_body",
    "make_constant",
]
