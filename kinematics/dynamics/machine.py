"""A machine: a mechanism with its masses and loads."""

from __future__ import annotations

from dataclasses import dataclass, field

from kinematics.arrays import Complex, Real
from kinematics.dynamics.bodies import Body
from kinematics.dynamics.friction import Friction
from kinematics.dynamics.loads import Load
from kinematics.linkage.planar.mechanism import Mechanism


@dataclass(frozen=True)
class Machine:
    """A mechanism with masses and loads, in consistent units (SI or any other set).

    Attributes
    ----------
    mechanism : Mechanism
        Designs of shape S, in their own length unit, which is ``scale`` of the length units of all other data.
    bodies : dict of str to Body
        Bodies by moving link, points in the reference configuration; a link without an entry has no mass.
    pin_masses : dict of str to float, shape S
        Point masses by joint.
    gravity : complex
        Acceleration of gravity.
    loads : tuple of Load
        Forces, torques, springs.
    friction : Friction
        Friction of pins and slides.
    about : complex, or of shape S
        Point about which the shaking moment is taken.
    scale : float
        Length unit of the mechanism, in the length unit of all other data.
    """

    mechanism: Mechanism
    bodies: dict[str, Body] = field(default_factory=dict)
    pin_masses: dict[str, Real] = field(default_factory=dict)
    gravity: complex = 0j
    loads: tuple[Load, ...] = ()
    about: complex | Complex = 0j
    scale: float = 1.0
    friction: Friction = field(default_factory=Friction)
