"""What is simulated: bodies on hinges and slides, the loops that close them, and the motion that they are held against.

Glossary, in SI units (metres, kilograms, radians, seconds), at the *start* of the motion:

body      moves against its parent, or the ground, by one joint: a hinge or a slide;
closure   a pin between two bodies of the tree, which closes a loop;
relation  a weighted sum of joint coordinates that stays 0: gears that mesh;
drive     the body whose joint is led at constant speed.

All frames are parallel to the ground's at the start, where every joint coordinate is 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Vector = tuple[float, float, float]

LEAST_SHARE = 1e-6
"""Least mass of a body as a share of the heaviest one's, and least inertia as a share of that mass times size²: every
body of a simulation needs some, and this much changes no force by more than a few millionths."""

GROUND = "ground"


@dataclass(frozen=True)
class Body:
    """A rigid body and the joint that it moves by.

    Attributes
    ----------
    name : str
        Of letters, digits and underscores, unique.
    label : str
        As the design calls it.
    parent : str
        A body, or :data:`GROUND`.
    sort : {"hinge", "slide"}
    place : (x, y, z)
        Where its frame stands at the start, on the hinge's axis.
    axis : (x, y, z)
        Of the hinge or slide, of length 1.
    mass, inertia : float
        The inertia about the axis through the centre that is square to the plane of motion.
    centre : (x, y, z)
        Centre of mass.
    marks : tuple of (x, y, z)
        Its joints, between which it is drawn.
    radius, width : float
        Of what is drawn: of a disc where it has a radius, else half the thickness of bars.
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
        """The name of its joint."""
        return f"{'turn' if self.sort == 'hinge' else 'travel'}_{self.name}"

    @property
    def unit(self) -> str:
        """Of its joint's coordinate."""
        return "rad" if self.sort == "hinge" else "m"


class Closure(NamedTuple):
    """A pin between two bodies at a place of the start."""

    name: str
    first: str
    second: str
    place: Vector


class Relation(NamedTuple):
    """Bodies and weights: the weighted sum of their joint coordinates stays 0."""

    name: str
    terms: tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Multibody:
    """A machine that is driven through a motion at constant speed.

    Attributes
    ----------
    title : str
        Of any characters.
    bodies : tuple of Body
        Parents before their children.
    gravity : (x, y, z)
    driven : str
        The body whose joint is led.
    speed : float
        Of the drive, rad/s or m/s.
    times : float, shape (n + 1,)
        From 0 on, evenly.
    motion : dict of str to float, shape (n + 1,)
        Joint coordinate of each body at the times, by the analysis.
    rates : dict of str to float
        Rate of each joint coordinate at the start.
    size : float
        Of the machine.
    remarks : tuple of str
        What was assumed and what is left out; whole sentences.
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
        """Its bodies."""
        return {body.name: body for body in self.bodies}

    @property
    def duration(self) -> float:
        """How long the motion takes, seconds."""
        return float(self.times[-1])

    @property
    def lead(self) -> float:
        """Inertia (mass) of the flywheel (carriage) that leads the drive: its speed changes by a billionth."""
        weight = float(np.linalg.norm(self.gravity)) * self.size
        heaviest = max(body.mass for body in self.bodies)
        arm = self.size**2 if self.by_name[self.driven].sort == "hinge" else 1.0
        energy = heaviest * (arm + weight / self.speed**2)
        return 1e9 * energy


def weighty(bodies: tuple[Body, ...], size: float) -> tuple[tuple[Body, ...], tuple[str, ...]]:
    """Bodies of which each has some mass and inertia, and the labels of those that were given any."""
    heaviest = max(body.mass for body in bodies)
    mass, inertia = LEAST_SHARE * heaviest, LEAST_SHARE * heaviest * size**2
    given = tuple(body.label for body in bodies if body.mass < mass or body.inertia < inertia)
    return tuple(replace(body, mass=max(body.mass, mass), inertia=max(body.inertia, inertia)) for body in bodies), given
