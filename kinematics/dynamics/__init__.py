"""Inverse dynamics of planar linkages: reactions at every joint, the drive, and the shaking force on the frame.

A :class:`Machine` is a mechanism with its masses and loads. Its :class:`Places` are the positions, velocities and
accelerations of its links in a given motion. From them :func:`reactions` solves the Newton-Euler equations of all
links, and :func:`balance` computes the drive and the shaking force from energy and momentum, independently of the
reactions.
"""

from kinematics.dynamics.balance import Balance, balance
from kinematics.dynamics.bodies import Body, body
from kinematics.dynamics.loads import JointForce, Load, PointForce, Resistance, Torque, TurningResistance, constant
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import Reactions, reactions
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
    "balance",
    "body",
    "constant",
    "reactions",
]
