"""What many fourbars weigh and carry, as the closed form of :mod:`kinematics.dynamics.fourbar` takes it."""

from __future__ import annotations

import numpy as np

from kinematics.dynamics.fourbar import COUPLER, OUTPUT, PIN_A, PIN_B, Fourbars, Weights
from kinematics.dynamics.fourbar import INPUT as CRANK
from kinematics.linkage.planar.mechanism import Complex, Real
from synthesis.mechanisms.link_bodies import BlockError, LinkBodies
from synthesis.model.dynamics import DesignDynamics, LengthUnit
from synthesis.model.linkages import FOURBAR_LINKS
from synthesis.model.loads import StatedLoad

LINKS = {link: joints for link, joints in FOURBAR_LINKS.items() if link != "ground"}
ON_LINK = {"input": CRANK, "coupler": COUPLER, "output": OUTPUT}
ON_PIN = {"A": PIN_A, "B": PIN_B, "P": COUPLER}
FIXED = "O2", "O4"
JOINTS = "O2", "A", "B", "O4", "P"


def closed_form(stated: DesignDynamics) -> bool:
    """Whether a block has nothing that the closed form leaves out: springs, friction, loads that change."""
    courses = [load.force or load.torque for load in stated.loads]
    constant = all(course is not None and course.constant is not None for course in courses)
    named = {*stated.bodies, *(load.link for load in stated.loads if load.link)} <= ON_LINK.keys()
    joints = {mass.joint for mass in stated.point_masses} | {load.joint for load in stated.loads if load.joint}
    on_pins = joints <= {*ON_PIN, *FIXED}
    return constant and named and on_pins and not stated.springs and stated.friction is None


def fourbars(joints: Complex, span: Real, scale: float) -> Fourbars:
    """Fourbars by their joints O2, A, B, O4, P in the reference, shape (n, 5), that turn by ``span`` from there."""
    o2, a, b, o4, p = (scale * column for column in joints.T)
    line = (b - a) / np.abs(b - a)
    sign = np.where((np.conj(o4 - a) * (b - a)).imag >= 0.0, 1.0, -1.0)
    return Fourbars(
        o2, o4, np.abs(a - o2), np.abs(b - a), np.abs(b - o4), (p - a) / line, sign, np.angle(a - o2), np.asarray(span)
    )


def weights(stated: DesignDynamics, joints: Complex, unit: LengthUnit) -> Weights:
    """What fourbars weigh and carry by a block in :func:`closed_form`.

    Parameters
    ----------
    stated : DesignDynamics
        With the shapes of all links in ``bodies``.
    joints : complex, shape (n, 5)
        O2, A, B, O4, P in the reference, length units.
    unit : str
        The length unit.
    """
    count, scale = len(joints), stated.scale(unit)
    loads = [load for load in stated.loads if load.force is not None and load.joint not in FIXED]
    mass, inertia = np.zeros((count, 3)), np.zeros((count, 3))
    cg = np.zeros((count, 3), np.complex128)
    arm, force = np.zeros((2, count, len(loads)), np.complex128)
    for n, row in enumerate(joints):
        read = LinkBodies(dict(zip(JOINTS, map(complex, row), strict=True)), LINKS, scale)
        frames = [_Frame(read, link) for link in LINKS]
        for k, link in enumerate(LINKS):
            if link not in stated.bodies:
                continue
            try:
                part = read.body(link, stated.bodies[link])
            except BlockError:
                mass[n, k] = np.inf  # its holes leave nothing of it
                continue
            mass[n, k], inertia[n, k], cg[n, k] = part.mass, part.inertia, frames[k].told(complex(part.cg))
        for k, load in enumerate(loads):
            arm[n, k], force[n, k] = _placed(load, read, frames)
    pins = np.zeros((count, 3))
    for point_mass in stated.point_masses:
        if point_mass.joint not in FIXED:
            pins[:, "ABP".index(point_mass.joint)] += point_mass.mass
    couples = np.zeros(3)
    for load in stated.loads:
        if load.torque is not None and load.link is not None:
            couples[list(LINKS).index(load.link)] += load.torque.constant or 0.0
    about = joints[:, 0] if stated.moment_about is None else np.full(count, complex(*stated.moment_about))
    return Weights(
        mass,
        cg,
        inertia,
        pins,
        0j if stated.gravity is None else stated.gravity.vector,
        np.array([_acts_on(load) for load in loads], np.int64),
        arm,
        force,
        np.array([load.frame == "link" for load in loads], np.bool_),
        couples,
        scale * about,
    )


class _Frame:
    """A link's first joint and direction in the reference."""

    def __init__(self, read: LinkBodies, link: str) -> None:
        first, second = (read.joints[joint] for joint in read.links[link][:2])
        self.origin = read.scale * first
        self.direction = (second - first) / abs(second - first)

    def told(self, place: complex) -> complex:
        """A place from the first joint, over the direction."""
        return complex((place - self.origin) / self.direction)


def _acts_on(load: StatedLoad) -> int:
    return ON_PIN[load.joint] if load.joint is not None else ON_LINK[load.link or ""]


def _placed(load: StatedLoad, read: LinkBodies, frames: list[_Frame]) -> tuple[complex, complex]:
    """Where a force acts, and its components over the direction of its link where it turns with that."""
    acting = complex(*((load.force.constant if load.force else None) or (0.0, 0.0)))
    if load.joint is not None:
        on_coupler = load.joint == "P"
        place = frames[1].told(read.scale * read.joints["P"]) if on_coupler else 0j
        return place, acting
    link = load.link or ""
    frame = frames[list(LINKS).index(link)]
    assert load.point is not None
    place = frame.told(read.place(link, load.point))
    return place, acting / frame.direction if load.frame == "link" else acting
