"""System of equations for all reactions of a mechanism: which unknown acts on which link, and with which arm.

The unknowns are, at each joint, the force of its pin on every link except the first one named there, the hub; for each
slide the force of its line on the pin, normal to the line; for each gear pair the torque that couples it; last the
drive. The equations are the sums of forces and of moments of each moving link (Norton 11.1). The force of a pin on its
hub follows from the pin's own balance: the loads on the pin minus its m·a and minus the forces on the other links. So
pins of three or more links need no special convention, and a mobility of 1 makes the equations square.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.kernels import DIRECTED_FORCE, FORCE, TORQUE
from kinematics.linkage.planar.closures import CACHE_SIZE
from kinematics.linkage.planar.mechanism import GROUND, Mechanism


@dataclass(frozen=True)
class System:
    """Columns and terms of the equations.

    Attributes
    ----------
    moving : tuple of str
        The moving links, with three equations each.
    hubs : dict of str to str
        The hub of each joint.
    pins : tuple of (joint, link)
        Pins with their links: two columns for each, in this order, then one for each slide, one for each gear pair,
        and one for the drive.
    terms : int, shape (T, 5)
        Kind, column, link (by number in ``moving``), joint, direction. See :mod:`kernels`.
    coefficients : float, shape (T,)
        Factor of each term.
    bases : int, shape (links,)
        The joint about which a link's moments are taken.
    columns : int
        Number of unknowns.
    """

    moving: tuple[str, ...]
    hubs: dict[str, str]
    pins: tuple[tuple[str, str], ...]
    terms: NDArray[np.int64]
    coefficients: NDArray[np.float64]
    bases: NDArray[np.int64]
    columns: int

    @property
    def slides_at(self) -> int:
        """First column of the slides."""
        return 2 * len(self.pins)


@lru_cache(maxsize=CACHE_SIZE)
def build_system(mechanism: Mechanism) -> System:
    """Build the equations of a mechanism."""
    links = mechanism.links
    moving = tuple(link for link in links if link != GROUND)
    number = {link: n for n, link in enumerate(moving)}
    joint_number = {joint: n for n, joint in enumerate(mechanism.joints)}
    # Any link of a joint could be the hub; the first one makes the choice reproducible.
    hubs = {joint: next(link for link, listed in links.items() if joint in listed) for joint in mechanism.joints}
    pins = tuple(
        (joint, link)
        for joint in mechanism.joints
        for link, listed in links.items()
        if joint in listed and link != hubs[joint]
    )
    terms: list[tuple[int, int, int, int, int]] = []
    coefficients: list[float] = []

    def add_term(kind: int, column: int, link: str, joint: int, direction: int, coefficient: float) -> None:
        # The ground has no equations; its forces follow from the others.
        if link != GROUND and coefficient != 0.0:
            terms.append((kind, column, number[link], joint, direction))
            coefficients.append(coefficient)

    for n, (joint, link) in enumerate(pins):
        add_term(FORCE, 2 * n, link, joint_number[joint], -1, 1.0)
        # Reaction on the hub.
        add_term(FORCE, 2 * n, hubs[joint], joint_number[joint], -1, -1.0)
    column = 2 * len(pins)
    for n, slide in enumerate(mechanism.slides):
        add_term(DIRECTED_FORCE, column, hubs[slide.joint], joint_number[slide.joint], n, 1.0)
        add_term(DIRECTED_FORCE, column, slide.link, joint_number[slide.joint], n, -1.0)
        column += 1
    for gear in mechanism.gears:
        add_term(TORQUE, column, gear.second, -1, -1, 1.0)
        # The couple does no work: T ω₂ − ratio T ω₁ = 0.
        add_term(TORQUE, column, gear.first, -1, -1, -gear.ratio)
        column += 1
    if mechanism.has_slide_input:
        add_term(
            DIRECTED_FORCE, column, hubs[mechanism.input], joint_number[mechanism.input], len(mechanism.slides), 1.0
        )
    else:
        add_term(TORQUE, column, mechanism.input, -1, -1, 1.0)
    return System(
        moving,
        hubs,
        pins,
        np.array(terms, np.int64).reshape(-1, 5),
        np.array(coefficients, np.float64),
        np.array([joint_number[mechanism.link_line(link)[0]] for link in moving], np.int64),
        column + 1,
    )
