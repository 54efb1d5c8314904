"""Model of the simulated machine: bodies on hinges and slides, closures of loops, and the analysed motion to compare.

Glossary, in SI units (metres, kilograms, radians, seconds), at the *start* of the motion:

body      moves against its parent, or the ground, by one joint: a hinge or a slide;
closure   a pin between two bodies of the tree, which closes a loop;
relation  a weighted sum of joint coordinates that stays 0: gears that mesh;
drive     the body whose joint moves at constant speed.

All frames are parallel to the ground's at the start, where every joint coordinate is 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Real

Vector = tuple[float, float, float]

MIN_MASS_SHARE = 1e-6
"""Minimum mass of a body as a share of the heaviest one's, and minimum inertia as a share of that mass times size².
Simulators need positive values; these change forces by a few millionths at most.
"""

GROUND = "ground"


@dataclass(frozen=True)
class Body:
    """A rigid body and the joint by which it moves.

    Attributes
    ----------
    name : str
        Letters, digits and underscores; unique.
    label : str
        The design's name for it.
    parent : str
        Name of a body, or :data:`GROUND`.
    sort : {"hinge", "slide"}
    place : (x, y, z)
        Origin of its frame at the start, on the hinge's axis.
    axis : (x, y, z)
        Unit vector of the hinge or slide.
    mass, inertia : float
        The inertia is about the axis through the centre of mass, normal to the plane of motion.
    centre : (x, y, z)
        Centre of mass.
    marks : tuple of (x, y, z)
        Positions of its joints; bars are drawn between them.
    radius, width : float
        Dimensions of the body's picture: those of a disc if the radius is positive. Otherwise the body is drawn as
        bars, and ``width`` is half their thickness.
    """

    name: str
    label: str
    parent: str
    sort: Literal["hinge", "slide"]
    place: Vector
    axis: Vector
    mass: float
    centre: Vector
    inertia: float
    marks: tuple[Vector, ...] = ()
    radius: float = 0.0
    width: float = 0.0

    @property
    def joint(self) -> str:
        """Name of the body's joint."""
        return f"{'turn' if self.sort == 'hinge' else 'travel'}_{self.name}"

    @property
    def unit(self) -> str:
        """Unit of the joint's coordinate."""
        return "rad" if self.sort == "hinge" else "m"


class Closure(NamedTuple):
    """A pin between two bodies, at its place at the start."""

    name: str
    first: str
    second: str
    place: Vector


class Relation(NamedTuple):
    """A constraint: the weighted sum of joint coordinates stays 0."""

    name: str
    terms: tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Multibody:
    """A machine that is driven through a motion at constant speed.

    Attributes
    ----------
    title : str
        Free text.
    bodies : tuple of Body
        Parents before their children.
    gravity : (x, y, z)
    driven : str
        The body whose joint is driven.
    speed : float
        Speed of the drive, rad/s or m/s.
    times : float, shape (n + 1,)
        Evenly spaced from 0, seconds.
    motion : dict of str to float, shape (n + 1,)
        Joint coordinate of each body at the times, from the kinematic analysis.
    rates : dict of str to float
        Rate of each joint coordinate at the start.
    size : float
        Size of the machine, metres.
    remarks : tuple of str
        Assumptions and omissions, as sentences.
    """

    title: str
    bodies: tuple[Body, ...]
    closures: tuple[Closure, ...]
    relations: tuple[Relation, ...]
    gravity: Vector
    driven: str
    speed: float
    times: Real
    motion: dict[str, Real]
    rates: dict[str, float]
    size: float
    remarks: tuple[str, ...]

    @property
    def by_name(self) -> dict[str, Body]:
        """Bodies by name."""
        return {body.name: body for body in self.bodies}

    @property
    def duration(self) -> float:
        """Duration of the motion, seconds."""
        return float(self.times[-1])

    @property
    def lead(self) -> float:
        """Inertia of the flywheel, or mass of the carriage, that leads the drive.

        It is so large that the speed of the lead changes by at most a billionth.
        """
        # Energy scale of gravity per unit mass.
        weight = float(np.linalg.norm(self.gravity)) * self.size
        heaviest = max(body.mass for body in self.bodies)
        arm = self.size**2 if self.by_name[self.driven].sort == "hinge" else 1.0
        energy = heaviest * (arm + weight / self.speed**2)
        return 1e9 * energy


def ensure_masses(bodies: tuple[Body, ...], size: float) -> tuple[tuple[Body, ...], tuple[str, ...]]:
    """Give every body the minimum mass and inertia; return the bodies and the labels of those that were changed."""
    heaviest = max(body.mass for body in bodies)
    mass, inertia = MIN_MASS_SHARE * heaviest, MIN_MASS_SHARE * heaviest * size**2
    given = tuple(body.label for body in bodies if body.mass < mass or body.inertia < inertia)
    return tuple(replace(body, mass=max(body.mass, mass), inertia=max(body.inertia, inertia)) for body in bodies), given
