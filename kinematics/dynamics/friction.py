"""Coulomb friction at pins and slides: the contacts, and their work on the motion.

A pin's moment on a link is −sign(ω) μ r |F|, ω the link's speed against the hub (the first link that the mechanism
names there; of a pin on a slide the block, which turns with the line), F the pin's force on it. A slide's force on its
pin is −sign(v) μ |N| along the line (Norton, *Design of Machinery*, eq. 11.6c, 11.10e; with N instead of |N| friction
would push along the motion where N < 0). At rest friction is not determined and is set to zero.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.dynamics.kernels import DIRECTED_FORCE, TORQUE
from kinematics.dynamics.places import Places
from kinematics.dynamics.system import System
from kinematics.linkage.planar.mechanism import GROUND, Mechanism


@dataclass(frozen=True)
class Friction:
    """Coefficient and radius by joint, and coefficient by the number of a slide."""

    pins: dict[str, tuple[float, float]] = field(default_factory=dict)
    slides: dict[int, float] = field(default_factory=dict)

    def __bool__(self) -> bool:
        """Return whether there is any friction."""
        return bool(self.pins or self.slides)


class Contact(NamedTuple):
    """A contact with friction: a moment between ``link`` and ``against`` at a joint, or a force along a slide.

    With ``slide`` ≥ 0 the friction acts on the pin along the line of that slide.
    Friction is ``lever`` times the norm of the unknowns in ``columns`` (−1: none).
    """

    joint: str
    link: str
    against: str
    slide: int
    columns: tuple[int, int]
    lever: float


class Rubbing(NamedTuple):
    """Friction of each contact at all positions, shape S + (N,), and a mask where any contact is at rest."""

    contacts: tuple[Contact, ...]
    frictions: tuple[Real, ...]
    stick: NDArray[np.bool_]

    def work(self, places: Places) -> Real:
        """Return the work of friction per unit of time, or of the input if ``places`` move at an input speed of 1."""
        total = np.zeros(places.smooth.shape)
        for contact, friction in zip(self.contacts, self.frictions, strict=True):
            total = total + friction * compute_contact_speed(contact, places)
        return total


NO_RUBBING = Rubbing((), (), np.zeros((), np.bool_))


def find_rubbing_joints(mechanism: Mechanism) -> list[str]:
    """Find the joints at which a link or block turns on a pin."""
    return [
        joint
        for joint in mechanism.joints
        if sum(joint in listed for listed in mechanism.links.values()) > 1
        or any(slide.joint == joint for slide in mechanism.slides)
    ]


def list_contacts(mechanism: Mechanism, system: System, friction: Friction) -> tuple[Contact, ...]:
    """List all contacts of a mechanism."""
    found = []
    for joint, (coefficient, radius) in friction.pins.items():
        # The moment of friction is the coefficient times the pin's radius times the force.
        hub, lever = system.hubs[joint], coefficient * radius
        for n, (at, link) in enumerate(system.pins):
            if at == joint:
                found.append(Contact(joint, link, hub, -1, (2 * n, 2 * n + 1), lever))
        for n, slide in enumerate(mechanism.slides):
            if slide.joint == joint:
                # The block transmits normal force and friction of the line: √(1 + μ²) times the normal force.
                whole = lever * float(np.hypot(1.0, friction.slides.get(n, 0.0)))
                found.append(Contact(joint, hub, slide.link, -1, (system.slides_at + n, -1), whole))
    for n, coefficient in friction.slides.items():
        slide = mechanism.slides[n]
        found.append(
            Contact(slide.joint, system.hubs[slide.joint], slide.link, n, (system.slides_at + n, -1), coefficient)
        )
    return tuple(found)


def compute_contact_speed(contact: Contact, places: Places) -> Real:
    """Compute the speed of a contact: of one link relative to the other, or along the slide."""
    if contact.slide >= 0:
        return np.asarray(places.slides[contact.slide][1])
    return np.asarray(places.spins[contact.link][1] - places.spins[contact.against][1])


def is_still(contact: Contact, places: Places) -> NDArray[np.bool_]:
    """Return where a contact is at rest."""
    # Linear and angular speeds have different thresholds.
    rest = places.rest if contact.slide >= 0 else places.turning_rest
    return np.asarray(np.abs(compute_contact_speed(contact, places)) <= rest)


def compute_factors(contact: Contact, places: Places, size: Real) -> Real:
    """Compute friction per unit of the norm, against the motion; moments are divided by the mechanism's size."""
    lever = contact.lever / (1.0 if contact.slide >= 0 else size)
    # At rest friction is undetermined; 0 keeps the equations solvable.
    sense = np.where(is_still(contact, places), 0.0, -np.sign(compute_contact_speed(contact, places)))
    return np.asarray(lever * sense)


def build_wrenches(
    contacts: tuple[Contact, ...], mechanism: Mechanism, system: System, tangent: int
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Build the contacts' terms, one column each, in the form of :mod:`system`.

    ``tangent`` is the index of the direction of slide 0.
    """
    numbers = {link: n for n, link in enumerate(system.moving)}
    joints = {joint: n for n, joint in enumerate(mechanism.joints)}
    terms, coefficients = [], []
    for column, contact in enumerate(contacts):
        kind, direction = (DIRECTED_FORCE, tangent + contact.slide) if contact.slide >= 0 else (TORQUE, -1)
        # Action and reaction; the ground has no equations.
        for link, sense in ((contact.link, 1.0), (contact.against, -1.0)):
            if link != GROUND:
                terms.append((kind, column, numbers[link], joints[contact.joint], direction))
                coefficients.append(sense)
    return np.array(terms, np.int64).reshape(-1, 5), np.array(coefficients, np.float64)
