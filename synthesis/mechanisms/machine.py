"""Conversion of a mechanism with its block ``dynamics`` to the analysis core's machine, and errors in the block.

Everything is formed in the unit of the forces: in metres for SI, else in the length unit as it is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.bodies import Body, slenderness_faults
from kinematics.dynamics.friction import Friction, rubbing_joints
from kinematics.dynamics.loads import JointForce, Load, PointForce, Resistance, Torque, TurningResistance
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.springs import NO_LENGTH, Spring, TorsionSpring, rotation_near
from kinematics.errors import MechanismError as KinematicsError
from kinematics.linkage.planar.branches import cycle
from kinematics.linkage.planar.mechanism import GROUND, Mechanism, Real
from synthesis.mechanisms.courses import course_faults, course_of, gas_force, ground_slide
from synthesis.mechanisms.link_bodies import BlockError, LinkBodies, token
from synthesis.model.bodies import Place, PolarPlace
from synthesis.model.dynamics import DrivenSlide, DynamicsBlock, LengthUnit, WeighedLinkage
from synthesis.model.loads import StatedLoad, period_fault
from synthesis.model.springs import StatedSpring

Fault = tuple[str, str]


def dynamics_faults(block: DynamicsBlock, mechanism: Mechanism) -> list[Fault]:
    """What the block names and the mechanism does not have: (JSON pointer below the request, detail)."""
    faults = [*_named_faults(block, mechanism), *_report_faults(block, mechanism), *_drive_faults(block, mechanism)]
    return faults or _unbuildable(block, mechanism)


def weight_faults(block: WeighedLinkage, mechanism: Mechanism) -> list[Fault]:
    """The same of what a linkage weighs and carries alone."""
    return list(_named_faults(block, mechanism)) or _unbuildable(block, mechanism)


def _unbuildable(block: WeighedLinkage, mechanism: Mechanism) -> list[Fault]:
    try:
        machine_of(block, mechanism, "m")
    except BlockError as error:
        return [(error.path, error.detail)]
    return []


def _named_faults(block: WeighedLinkage, mechanism: Mechanism) -> Iterator[Fault]:
    moving = [link for link in mechanism.links if link != GROUND]
    no_link = f"no link in motion; they are {', '.join(moving)}"
    no_joint = f"no joint of the mechanism; they are {', '.join(mechanism.joints)}"
    for name, stated in block.bodies.items():
        path = f"/dynamics/bodies/{token(name)}"
        if name not in moving:
            yield path, no_link
        elif stated.shape is not None:
            for joint in stated.shape.holes:
                if joint not in mechanism.links[name]:
                    yield f"{path}/shape/holes/{token(joint)}", f"no joint of {name}"
            if stated.shape.ends == "square" and len(mechanism.links[name]) != 2:
                yield f"{path}/shape/ends", "only a bar with two joints has ends"
    for n, mass in enumerate(block.point_masses):
        if mass.joint not in mechanism.joints:
            yield f"/dynamics/point_masses/{n}/joint", no_joint
    for n, load in enumerate(block.loads):
        if load.link is not None and load.link not in moving:
            yield f"/dynamics/loads/{n}/link", no_link
        if load.joint is not None and load.joint not in mechanism.joints:
            yield f"/dynamics/loads/{n}/joint", no_joint
        yield from _course_faults(f"/dynamics/loads/{n}", load, mechanism)
    for n, spring in enumerate(block.springs):
        yield from _spring_faults(f"/dynamics/springs/{n}", spring, mechanism)
    yield from _friction_faults(block, mechanism)


def _friction_faults(block: WeighedLinkage, mechanism: Mechanism) -> Iterator[Fault]:
    if block.friction is None:
        return
    if mechanism.redundant:
        yield "/dynamics/friction", "constraints are redundant, so that the forces that cause friction are not unique"
    rubbing = rubbing_joints(mechanism)
    for joint in block.friction.pins:
        if joint not in rubbing:
            yield f"/dynamics/friction/pins/{token(joint)}", f"nothing turns there; pins are {', '.join(rubbing)}"
    for slide in block.friction.slides:
        if int(slide) >= len(mechanism.slides):
            yield (
                f"/dynamics/friction/slides/{slide}",
                f"the mechanism has {len(mechanism.slides)} slides, counted from 0",
            )


def _report_faults(block: DynamicsBlock, mechanism: Mechanism) -> Iterator[Fault]:
    if block.report is not None and "joint_force_index" in block.report and not block.loads:
        yield "/dynamics/report", "the joint force index needs at least one load"
    if block.report is not None and "joint_force_index" in block.report and mechanism.redundant:
        yield "/dynamics/report", "constraints are redundant, so that the joint forces of the index are not unique"
    if mechanism.driven_by_slide:
        detail = "a flywheel needs a driving shaft; a slide drives this mechanism"
        if block.flywheel is not None:
            yield "/dynamics/flywheel", detail
        elif block.reports("flywheel"):
            yield "/dynamics/report", detail


def _course_faults(path: str, load: StatedLoad, mechanism: Mechanism) -> Iterator[Fault]:
    for name, course in (("force", load.force), ("torque", load.torque)):
        if course is not None:
            for below, detail in course_faults(course, mechanism):
                yield f"{path}/{name}{below}", detail
    gas = None if load.force is None else load.force.gas
    if gas is not None:
        fault = period_fault(gas.pressure, float(gas.cycle))
        if fault is not None:
            yield f"{path}/force/gas/pressure", fault


def _spring_faults(path: str, spring: StatedSpring, mechanism: Mechanism) -> Iterator[Fault]:
    no_link = f"no link; they are {', '.join(mechanism.links)}"
    if spring.ends is not None:
        first, second = (end.link for end in spring.ends)
        listed, between = [f"{path}/ends/0/link", f"{path}/ends/1/link"], f"{path}/ends"
    else:
        first, second = spring.links or ("", "")
        listed, between = [f"{path}/links/0", f"{path}/links/1"], f"{path}/links"
    missing = [place for place, link in zip(listed, (first, second), strict=True) if link not in mechanism.links]
    yield from ((place, no_link) for place in missing)
    if first == second:
        yield between, f"a spring acts between two links; both of its ends are on {first}"


def _drive_faults(block: DynamicsBlock, mechanism: Mechanism) -> Iterator[Fault]:
    stated = block.drive
    if stated == "torque" and mechanism.driven_by_slide:
        yield "/dynamics/drive", "a slider drives this mechanism; leave the field out"
    if isinstance(stated, DrivenSlide):
        drives = [n for n, s in enumerate(mechanism.slides) if s.joint == mechanism.input and s.link == GROUND]
        if stated.slide not in drives:
            detail = (
                f"the slide that drives is {drives[0]}"
                if drives
                else "a torque on the input link drives this mechanism"
            )
            yield "/dynamics/drive/slide", detail


def machine_of(block: WeighedLinkage, mechanism: Mechanism, unit: LengthUnit) -> tuple[Machine, list[str]]:
    """The machine of a block without faults, and what a client should be warned of.

    Raises
    ------
    BlockError
        For a shape that leaves no mass, gas on no piston, or a spring without direction.
    """
    scale = block.scale(unit)
    reader = _Reader(mechanism, scale)
    bodies: dict[str, Body] = {}
    warnings: list[str] = []
    for link, stated in block.bodies.items():
        bodies[link] = part = reader.body(link, stated)
        reach = scale * max(
            abs(complex(mechanism.joints[a] - mechanism.joints[b]))
            for a in mechanism.links[link]
            for b in mechanism.links[link]
        )
        if stated.shape is None and slenderness_faults(part, reach):
            warnings.append(f"bodies: {link} has a moment of inertia that no body of its mass and length has")
    massless = [link for link in mechanism.links if link != GROUND and link not in block.bodies]
    if massless:
        warnings.append(f"bodies: without mass are {', '.join(massless)}")
    masses: dict[str, float] = {}
    for stated_mass in block.point_masses:
        masses[stated_mass.joint] = masses.get(stated_mass.joint, 0.0) + stated_mass.mass
    about = first_fixed(mechanism) if block.moment_about is None else complex(*block.moment_about)
    machine = Machine(
        mechanism,
        bodies,
        {joint: np.asarray(mass) for joint, mass in masses.items()},
        0j if block.gravity is None else block.gravity.vector,
        (
            *(reader.load(f"/dynamics/loads/{n}", load) for n, load in enumerate(block.loads)),
            *(reader.spring(f"/dynamics/springs/{n}", spring) for n, spring in enumerate(block.springs)),
        ),
        scale * about,
        scale,
        _friction(block, scale),
    )
    return machine, warnings


def machines_of(block: WeighedLinkage, mechanism: Mechanism, unit: LengthUnit) -> Machine | None:
    """The machines of many designs of one make, shape (n,), as one; None where a load changes, or there are springs or
    friction, or names that the designs do not have.

    A design of which holes leave nothing has no finite mass.
    """
    first_one = _first(mechanism)
    constant = all(getattr(load.force or load.torque, "constant", None) is not None for load in block.loads)
    if not constant or block.springs or block.friction is not None or any(_named_faults(block, first_one)):
        return None
    scale, count = block.scale(unit), mechanism.shape[0]
    mass, inertia = np.zeros((2, len(block.bodies), count))
    cg, places = np.zeros((len(block.bodies), count), np.complex128), np.zeros((len(block.loads), count), np.complex128)
    for n in range(count):
        reader = LinkBodies({joint: place[n] for joint, place in mechanism.joints.items()}, mechanism.links, scale)
        for k, (link, stated) in enumerate(block.bodies.items()):
            try:
                part = reader.body(link, stated)
            except BlockError:
                mass[k, n] = np.inf
                continue
            mass[k, n], cg[k, n], inertia[k, n] = part.mass, part.cg, part.inertia
        for k, load in enumerate(block.loads):
            if load.link is not None and load.point is not None:
                places[k, n] = reader.place(load.link, load.point)
    reading = _Reader(first_one, scale)
    loads = [reading.load(f"/dynamics/loads/{k}", load) for k, load in enumerate(block.loads)]
    masses: dict[str, float] = {}
    for stated_mass in block.point_masses:
        masses[stated_mass.joint] = masses.get(stated_mass.joint, 0.0) + stated_mass.mass
    ground = mechanism.links[GROUND]
    about = np.asarray(mechanism.joints[ground[0]] if ground else mechanism.slides[0].point)
    if block.moment_about is not None:
        about = np.asarray(complex(*block.moment_about))
    return Machine(
        mechanism,
        {link: Body(mass[k], cg[k], inertia[k]) for k, link in enumerate(block.bodies)},
        {joint: np.asarray(each) for joint, each in masses.items()},
        0j if block.gravity is None else block.gravity.vector,
        tuple(replace(load, place=places[k]) if isinstance(load, PointForce) else load for k, load in enumerate(loads)),
        scale * about,
        scale,
    )


def _first(mechanism: Mechanism) -> Mechanism:
    """The first of many designs."""

    def own(value: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(np.broadcast_to(value, mechanism.shape)[0])

    slides = tuple(slide._replace(point=own(slide.point), angle=own(slide.angle)) for slide in mechanism.slides)
    joints = {joint: place[0] for joint, place in mechanism.joints.items()}
    return Mechanism(joints, mechanism.links, mechanism.input, slides, mechanism.gears, mechanism.turns)


def _friction(block: WeighedLinkage, scale: float) -> Friction:
    stated = block.friction
    if stated is None:
        return Friction()
    pins = {joint: (pin.mu, scale * pin.radius) for joint, pin in stated.pins.items() if pin.mu > 0.0}
    return Friction(pins, {int(slide): mu for slide, mu in stated.slides.items() if mu > 0.0})


def first_fixed(mechanism: Mechanism) -> complex:
    """The first fixed pivot, or a point of the first slide where there is none."""
    ground = mechanism.links[GROUND]
    return complex(mechanism.joints[ground[0]] if ground else mechanism.slides[0].point)


def place_on(mechanism: Mechanism, link: str, stated: Place, scale: float = 1.0) -> complex:
    """A place on a link in the reference configuration, in the unit that ``scale`` makes of the mechanism's."""
    return _Reader(mechanism, scale).place(link, stated)


def torsion_spring(mechanism: Mechanism, links: tuple[str, str]) -> TorsionSpring:
    """A torsion spring of a unit rate between two links.

    Raises
    ------
    BlockError
        Where it cannot be told how far it is wound.
    """
    return TorsionSpring(links, 1.0, near=_Reader(mechanism, 1.0).rotation("/springs", links))


class _Reader(LinkBodies):
    """Places, bodies, loads and springs of one mechanism in the unit of its forces."""

    def __init__(self, mechanism: Mechanism, scale: float) -> None:
        super().__init__(mechanism.joints, mechanism.links, scale)
        self.mechanism = mechanism

    def place(self, link: str, stated: Place) -> complex:
        """A place on a link, in the reference configuration; a ground of slides has no line of its own: x is it."""
        if isinstance(stated, PolarPlace) and len(self.links[link]) < 2:
            return self.scale * (first_fixed(self.mechanism) + stated.vector)
        return super().place(link, stated)

    def load(self, path: str, stated: StatedLoad) -> Load:
        """A load of the analysis core; ``path`` is its own below the request."""
        if stated.torque is not None:
            resisting, link = stated.torque.against_motion, str(stated.link)
            if resisting is not None:
                return TurningResistance(link, resisting.forward, resisting.backward)
            return Torque(link, course_of(stated.torque, self.mechanism, self.scale))
        assert stated.force is not None
        if stated.joint is not None:
            resisting = stated.force.against_motion
            if resisting is not None:
                slide = ground_slide(self.mechanism, stated.joint)
                return Resistance(stated.joint, resisting.forward, resisting.backward, slide)
            if stated.force.gas is not None:
                try:
                    return gas_force(stated.force.gas, self.mechanism, stated.joint, self.scale)
                except ValueError as error:
                    raise BlockError(f"{path}/force/gas", str(error)) from None
            return JointForce(stated.joint, course_of(stated.force, self.mechanism, self.scale))
        assert stated.link is not None
        assert stated.point is not None
        place = np.asarray(self.place(stated.link, stated.point))
        course = course_of(stated.force, self.mechanism, self.scale)
        return PointForce(stated.link, place, course, stated.frame == "link")

    def spring(self, path: str, stated: StatedSpring) -> Load:
        """A spring of the analysis core; ``path`` is its own below the request."""
        if stated.ends is None:
            links = stated.links or (GROUND, GROUND)
            rate, free = stated.torsion or 0.0, math.radians(stated.free_angle)
            return TorsionSpring(links, rate, free, stated.damping, self.rotation(path, links))
        first, second = (np.asarray(self.place(end.link, end.point)) for end in stated.ends)
        size = self.scale * max(
            abs(complex(a - b)) for a in self.mechanism.joints.values() for b in self.mechanism.joints.values()
        )
        if abs(complex(second - first)) <= NO_LENGTH * size and (stated.free_length > 0.0 or stated.preload != 0.0):
            raise BlockError(f"{path}/ends", "both ends coincide in the reference, so that the force has no direction")
        return Spring(
            (stated.ends[0].link, stated.ends[1].link),
            (first, second),
            stated.rate,
            self.scale * stated.free_length,
            stated.preload,
            stated.damping,
            stated.one_sided or None,
        )

    def rotation(self, path: str, links: tuple[str, str]) -> Callable[[Real], Real]:
        """How far one link is turned against another, roughly; ``path`` is the spring's below the request."""
        try:
            period = math.inf if self.mechanism.driven_by_slide else cycle(self.mechanism)
        except KinematicsError as error:
            raise BlockError(path, f"how far the spring is wound cannot be told: {error}") from None
        return rotation_near(self.mechanism, links, period)
