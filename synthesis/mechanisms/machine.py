"""Conversion of a mechanism with its block ``dynamics`` to a machine of the analysis core, and errors of the block.

All quantities are in the length unit of the forces: metres for SI, otherwise the length unit of the request.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real, Scalar
from kinematics.dynamics.bodies import Body, is_too_slender
from kinematics.dynamics.friction import Friction, find_rubbing_joints
from kinematics.dynamics.loads import JointForce, Load, PointForce, Resistance, Torque, TurningResistance
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.springs import MIN_LENGTH, Spring, TorsionSpring, follow_rotation
from kinematics.errors import MechanismError as KinematicsError
from kinematics.linkage.planar.branches import compute_cycle
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from kinematics.message import compose
from synthesis.mechanisms.courses import build_course, build_gas_force, find_course_errors, find_ground_slide
from synthesis.mechanisms.link_bodies import BlockError, LinkBodies, escape_pointer
from synthesis.model.dynamics.bodies import Place, PolarPoint
from synthesis.model.dynamics.loads import LoadSpec, find_period_error
from synthesis.model.dynamics.request import DrivenSlide, DynamicsBlock, LengthUnit, LoadedLinkage
from synthesis.model.dynamics.springs import SpringSpec

Fault = tuple[str, str]


def find_dynamics_errors(block: DynamicsBlock, mechanism: Mechanism) -> list[Fault]:
    """Find errors of a block for a mechanism, such as unknown names, as pairs (JSON pointer in the request, detail)."""
    faults = [
        *_find_name_errors(block, mechanism),
        *_find_report_errors(block, mechanism),
        *_find_drive_errors(block, mechanism),
    ]
    # The last checks build the machine, which is possible only without the errors above.
    return faults or _find_build_errors(block, mechanism)


def find_weight_errors(block: LoadedLinkage, mechanism: Mechanism) -> list[Fault]:
    """Find errors of the masses and loads of a linkage, as :func:`find_dynamics_errors`."""
    return list(_find_name_errors(block, mechanism)) or _find_build_errors(block, mechanism)


def _find_build_errors(block: LoadedLinkage, mechanism: Mechanism) -> list[Fault]:
    try:
        # The unit does not affect the errors.
        build_machine(block, mechanism, "m")
    except BlockError as error:
        return [(error.path, error.detail)]
    return []


def _find_name_errors(block: LoadedLinkage, mechanism: Mechanism) -> Iterator[Fault]:
    moving = [link for link in mechanism.links if link != GROUND]

    # Usually there is no error, so texts are composed only when one is found.
    def describe_link() -> str:
        return compose("mechanisms-unknown-moving-link", links=", ".join(moving))

    def describe_joint() -> str:
        return compose("mechanisms-unknown-joint", joints=", ".join(mechanism.joints))

    for name, stated in block.bodies.items():
        path = f"/dynamics/bodies/{escape_pointer(name)}"
        if name not in moving:
            yield path, describe_link()
        elif stated.shape is not None:
            for joint in stated.shape.holes:
                if joint not in mechanism.links[name]:
                    yield (
                        f"{path}/shape/holes/{escape_pointer(joint)}",
                        compose("mechanisms-joint-of-other-link", link=name),
                    )
            if stated.shape.ends == "square" and len(mechanism.links[name]) != 2:
                yield f"{path}/shape/ends", compose("mechanisms-ends-without-bar")
    for n, mass in enumerate(block.point_masses):
        if mass.joint not in mechanism.joints:
            yield f"/dynamics/point_masses/{n}/joint", describe_joint()
    for n, load in enumerate(block.loads):
        if load.link is not None and load.link not in moving:
            yield f"/dynamics/loads/{n}/link", describe_link()
        if load.joint is not None and load.joint not in mechanism.joints:
            yield f"/dynamics/loads/{n}/joint", describe_joint()
        yield from _find_course_errors(f"/dynamics/loads/{n}", load, mechanism)
    for n, spring in enumerate(block.springs):
        yield from _find_spring_errors(f"/dynamics/springs/{n}", spring, mechanism)
    yield from _find_friction_errors(block, mechanism)


def _find_friction_errors(block: LoadedLinkage, mechanism: Mechanism) -> Iterator[Fault]:
    if block.friction is None:
        return
    # With redundant constraints the joint forces, and so the friction, are not determined.
    if mechanism.redundant:
        yield "/dynamics/friction", compose("mechanisms-friction-with-redundancy")
    rubbing = find_rubbing_joints(mechanism)
    for joint in block.friction.pins:
        if joint not in rubbing:
            yield (
                f"/dynamics/friction/pins/{escape_pointer(joint)}",
                compose("mechanisms-friction-without-rotation", pins=", ".join(rubbing)),
            )
    for slide in block.friction.slides:
        if int(slide) >= len(mechanism.slides):
            yield (
                f"/dynamics/friction/slides/{slide}",
                compose("mechanisms-unknown-slide", count=len(mechanism.slides)),
            )


def _find_report_errors(block: DynamicsBlock, mechanism: Mechanism) -> Iterator[Fault]:
    if block.report is not None and "joint_force_index" in block.report and not block.loads:
        yield "/dynamics/report", compose("mechanisms-index-needs-load")
    if block.report is not None and "joint_force_index" in block.report and mechanism.redundant:
        yield "/dynamics/report", compose("mechanisms-index-with-redundancy")
    if mechanism.has_slide_input and block.is_reported("flywheel"):
        path = "/dynamics/report" if block.flywheel is None else "/dynamics/flywheel"
        yield path, compose("mechanisms-flywheel-with-driving-slide")


def _find_course_errors(path: str, load: LoadSpec, mechanism: Mechanism) -> Iterator[Fault]:
    for name, course in (("force", load.force), ("torque", load.torque)):
        if course is not None:
            for below, detail in find_course_errors(course, mechanism):
                yield f"{path}/{name}{below}", detail
    gas = None if load.force is None else load.force.gas
    if gas is not None:
        fault = find_period_error(gas.pressure, float(gas.cycle))
        if fault is not None:
            yield f"{path}/force/gas/pressure", fault


def _find_spring_errors(path: str, spring: SpringSpec, mechanism: Mechanism) -> Iterator[Fault]:
    if spring.ends is not None:
        first, second = (end.link for end in spring.ends)
        listed, between = [f"{path}/ends/0/link", f"{path}/ends/1/link"], f"{path}/ends"
    else:
        first, second = spring.links or ("", "")
        listed, between = [f"{path}/links/0", f"{path}/links/1"], f"{path}/links"
    for place, link in zip(listed, (first, second), strict=True):
        if link not in mechanism.links:
            yield place, compose("mechanisms-unknown-link", links=", ".join(mechanism.links))
    if first == second:
        yield between, compose("mechanisms-spring-on-one-link", link=first)


def _find_drive_errors(block: DynamicsBlock, mechanism: Mechanism) -> Iterator[Fault]:
    stated = block.drive
    if stated == "torque" and mechanism.has_slide_input:
        yield "/dynamics/drive", compose("mechanisms-torque-with-driving-slider")
    if isinstance(stated, DrivenSlide):
        drives = [n for n, s in enumerate(mechanism.slides) if s.joint == mechanism.input and s.link == GROUND]
        if stated.slide not in drives:
            detail = (
                compose("mechanisms-other-slide-drives", slide=str(drives[0]))
                if drives
                else compose("mechanisms-input-link-drives")
            )
            yield "/dynamics/drive/slide", detail


def build_machine(block: LoadedLinkage, mechanism: Mechanism, unit: LengthUnit) -> tuple[Machine, list[str]]:
    """Build the machine of a block without errors, and list warnings for the client.

    Raises
    ------
    BlockError
        For a shape that leaves no mass, gas without a piston, or a spring without direction.
    """
    scale = block.scale(unit)
    reader = _MachineBuilder(mechanism, scale)
    bodies: dict[str, Body] = {}
    warnings: list[str] = []
    for link, stated in block.bodies.items():
        bodies[link] = part = reader.build_body(link, stated)
        reach = scale * max(
            abs(complex(mechanism.joints[a] - mechanism.joints[b]))
            for a in mechanism.links[link]
            for b in mechanism.links[link]
        )
        # Only a given inertia can be impossible, because shapes are consistent by construction.
        if stated.shape is None and is_too_slender(part, reach):
            warnings.append(compose("mechanisms-impossible-inertia", link=link))
    massless = [link for link in mechanism.links if link != GROUND and link not in block.bodies]
    if massless:
        warnings.append(compose("mechanisms-massless-links", links=", ".join(massless)))
    masses: dict[str, float] = {}
    # Several masses at one joint add up.
    for stated_mass in block.point_masses:
        masses[stated_mass.joint] = masses.get(stated_mass.joint, 0.0) + stated_mass.mass
    about = find_first_fixed_pivot(mechanism) if block.moment_about is None else complex(*block.moment_about)
    machine = Machine(
        mechanism,
        bodies,
        {joint: np.asarray(mass) for joint, mass in masses.items()},
        0j if block.gravity is None else block.gravity.vector,
        (
            *(reader.build_load(f"/dynamics/loads/{n}", load) for n, load in enumerate(block.loads)),
            *(reader.build_spring(f"/dynamics/springs/{n}", spring) for n, spring in enumerate(block.springs)),
        ),
        scale * about,
        scale,
        _build_friction(block, scale),
    )
    return machine, warnings


def build_machines(block: LoadedLinkage, mechanism: Mechanism, unit: LengthUnit) -> Machine | None:
    """Build the machines of many designs of one topology, shape (n,), as one machine.

    Return None if loads vary, if there are springs or friction, or if the designs lack a link or joint of the block. A
    design whose holes leave nothing of a plate gets an infinite mass.
    """
    first_one = _select_first(mechanism)
    constant = all(load.is_constant for load in block.loads)
    # Variable loads, springs and friction depend on the motion of each design and are not vectorized.
    if not constant or block.springs or block.friction is not None or any(_find_name_errors(block, first_one)):
        return None
    scale, count = block.scale(unit), mechanism.shape[0]
    mass, inertia = np.zeros((2, len(block.bodies), count))
    cg, places = np.zeros((len(block.bodies), count), np.complex128), np.zeros((len(block.loads), count), np.complex128)
    for n in range(count):
        reader = LinkBodies({joint: place[n] for joint, place in mechanism.joints.items()}, mechanism.links, scale)
        for k, (link, stated) in enumerate(block.bodies.items()):
            try:
                part = reader.build_body(link, stated)
            except BlockError:
                # An infinite mass makes this design violate every limit, without affecting the others.
                mass[k, n] = np.inf
                continue
            mass[k, n], cg[k, n], inertia[k, n] = part.mass, part.cg, part.inertia
        for k, load in enumerate(block.loads):
            if load.link is not None and load.point is not None:
                places[k, n] = reader.resolve_place(load.link, load.point)
    reading = _MachineBuilder(first_one, scale)
    # The loads of all designs are the same, except for their points of application, which are replaced below.
    loads = [reading.build_load(f"/dynamics/loads/{k}", load) for k, load in enumerate(block.loads)]
    masses: dict[str, float] = {}
    for stated_mass in block.point_masses:
        masses[stated_mass.joint] = masses.get(stated_mass.joint, 0.0) + stated_mass.mass
    ground = mechanism.links[GROUND]
    # Without fixed pivots, moments are taken about the first slide.
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


def _select_first(mechanism: Mechanism) -> Mechanism:
    """Return the first of many designs as a mechanism of its own."""

    def take_first(value: NDArray[Scalar]) -> NDArray[Scalar]:
        return np.asarray(np.broadcast_to(value, mechanism.shape)[0])

    slides = tuple(
        slide._replace(point=take_first(slide.point), angle=take_first(slide.angle)) for slide in mechanism.slides
    )
    joints = {joint: place[0] for joint, place in mechanism.joints.items()}
    return Mechanism(joints, mechanism.links, mechanism.input, slides, mechanism.gears, mechanism.turns)


def _build_friction(block: LoadedLinkage, scale: float) -> Friction:
    stated = block.friction
    if stated is None:
        return Friction()
    # Entries without friction are left out, because they would only slow down the iteration.
    pins = {joint: (pin.mu, scale * pin.radius) for joint, pin in stated.pins.items() if pin.mu > 0.0}
    return Friction(pins, {int(slide): mu for slide, mu in stated.slides.items() if mu > 0.0})


def find_first_fixed_pivot(mechanism: Mechanism) -> complex:
    """Return the first fixed pivot, or a point of the first slide if there is none."""
    ground = mechanism.links[GROUND]
    return complex(mechanism.joints[ground[0]] if ground else mechanism.slides[0].point)


def locate_on_link(mechanism: Mechanism, link: str, place: Place, scale: float = 1.0) -> complex:
    """Return a point of a link in the reference configuration, in length units times ``scale``."""
    return _MachineBuilder(mechanism, scale).resolve_place(link, place)


def build_torsion_spring(mechanism: Mechanism, links: tuple[str, str]) -> TorsionSpring:
    """Build a torsion spring of unit rate between two links.

    Raises
    ------
    BlockError
        If the rotation of the links relative to each other cannot be determined.
    """
    return TorsionSpring(links, 1.0, near=_MachineBuilder(mechanism, 1.0).measure_rotation("/springs", links))


class _MachineBuilder(LinkBodies):
    """Builder of the points, bodies, loads and springs of one mechanism, in the unit of the forces."""

    def __init__(self, mechanism: Mechanism, scale: float) -> None:
        super().__init__(mechanism.joints, mechanism.links, scale)
        self.mechanism = mechanism

    def resolve_place(self, link: str, place_spec: Place) -> complex:
        """Return a point of a link in the reference configuration, in the unit of the forces.

        Angles on a link with fewer than two joints, such as a ground with one pivot, are measured from the x axis.
        """
        if isinstance(place_spec, PolarPoint) and len(self.links[link]) < 2:
            return self.scale * (find_first_fixed_pivot(self.mechanism) + place_spec.vector)
        return super().resolve_place(link, place_spec)

    def build_load(self, path: str, load_spec: LoadSpec) -> Load:
        """Build a load of the analysis core; ``path`` is the JSON pointer of the load in the request."""
        if load_spec.torque is not None:
            resisting, link = load_spec.torque.against_motion, str(load_spec.link)
            if resisting is not None:
                return TurningResistance(link, resisting.forward, resisting.backward)
            return Torque(link, build_course(load_spec.torque, self.mechanism, self.scale))
        assert load_spec.force is not None
        if load_spec.joint is not None:
            resisting = load_spec.force.against_motion
            if resisting is not None:
                slide = find_ground_slide(self.mechanism, load_spec.joint)
                # Resistance opposes the velocity, which for a joint on a slide is along the slide.
                return Resistance(load_spec.joint, resisting.forward, resisting.backward, slide)
            if load_spec.force.gas is not None:
                try:
                    return build_gas_force(load_spec.force.gas, self.mechanism, load_spec.joint, self.scale)
                except ValueError as error:
                    raise BlockError(f"{path}/force/gas", str(error)) from None
            return JointForce(load_spec.joint, build_course(load_spec.force, self.mechanism, self.scale))
        assert load_spec.link is not None
        assert load_spec.point is not None
        place = np.asarray(self.resolve_place(load_spec.link, load_spec.point))
        course = build_course(load_spec.force, self.mechanism, self.scale)
        return PointForce(load_spec.link, place, course, load_spec.frame == "link")

    def build_spring(self, path: str, spring_spec: SpringSpec) -> Load:
        """Build a spring of the analysis core; ``path`` is the JSON pointer of the spring in the request."""
        if spring_spec.ends is None:
            links = spring_spec.links or (GROUND, GROUND)
            rate, free = spring_spec.torsion or 0.0, math.radians(spring_spec.free_angle)
            return TorsionSpring(links, rate, free, spring_spec.damping, self.measure_rotation(path, links))
        first, second = (np.asarray(self.resolve_place(end.link, end.point)) for end in spring_spec.ends)
        size = self.scale * max(
            abs(complex(a - b)) for a in self.mechanism.joints.values() for b in self.mechanism.joints.values()
        )
        # Without free length and preload, the force is proportional to the vector between the ends and needs no
        # direction.
        if abs(complex(second - first)) <= MIN_LENGTH * size and (
            spring_spec.free_length > 0.0 or spring_spec.preload != 0.0
        ):
            raise BlockError(f"{path}/ends", compose("mechanisms-spring-without-direction"))
        return Spring(
            (spring_spec.ends[0].link, spring_spec.ends[1].link),
            (first, second),
            spring_spec.rate,
            self.scale * spring_spec.free_length,
            spring_spec.preload,
            spring_spec.damping,
            spring_spec.one_sided or None,
        )

    def measure_rotation(self, path: str, links: tuple[str, str]) -> Callable[[Real], Real]:
        """Return a function that computes the approximate rotation of one link relative to another.

        ``path`` is the JSON pointer of the spring in the request, for errors.
        """
        try:
            # The motion of an input slide does not repeat by turns, so its period is infinite.
            period = math.inf if self.mechanism.has_slide_input else compute_cycle(self.mechanism)
        except KinematicsError as error:
            raise BlockError(path, compose("mechanisms-torsion-spring-not-followed", reason=str(error))) from None
        return follow_rotation(self.mechanism, links, period)
