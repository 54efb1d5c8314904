"""Forces in planar linkages that move as given: reactions at every joint, the drive, and what shakes the frame.

A :class:`Machine` is a mechanism with its masses and loads. Driven, its :class:`Places` are those of all points of its
links with two derivatives. From them :func:`reactions` solves Newton's and Euler's equations of all links, and
:func:`balance` finds the drive and the shaking force from energy and momentum, without a reaction: a check on these.
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
