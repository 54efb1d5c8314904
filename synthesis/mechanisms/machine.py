"""The analysis core's machine from a stated mechanism and its block ``dynamics``; faults that no single field shows.

Everything is formed in the unit of the forces: in metres for SI, else in the length unit as it is.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from kinematics.dynamics import shapes
from kinematics.dynamics.bodies import Body, body, joined, slenderness_faults
from kinematics.dynamics.loads import JointForce, Load, PointForce, Torque, constant
from kinematics.dynamics.machine import Machine
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from synthesis.model.bodies import Part, Place, PolarPlace, Shape, StatedBody
from synthesis.model.dynamics import DrivenSlide, DynamicsBlock, LengthUnit
from synthesis.model.loads import StatedLoad

Fault = tuple[str, str]


def token(name: str) -> str:
    """A name as a part of a JSON pointer."""
    return name.replace("~", "~0").replace("/", "~1")


class BlockError(ValueError):
    """A block that no machine can be made of; carries the field's path below the request."""

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(f"{path}: {detail}")


def dynamics_faults(block: DynamicsBlock, mechanism: Mechanism) -> list[Fault]:
    """What the block names and the mechanism does not have: (JSON pointer below the request, detail)."""
    faults = list(_faults(block, mechanism))
    if not faults:
        try:
            machine_of(block, mechanism, "m")
        except BlockError as error:
            faults.append((error.path, error.detail))
    return faults


def _faults(block: DynamicsBlock, mechanism: Mechanism) -> Iterator[Fault]:
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
                yield f"{path}/shape/ends", "only a bar of two joints has ends"
    for n, mass in enumerate(block.point_masses):
        if mass.joint not in mechanism.joints:
            yield f"/dynamics/point_masses/{n}/joint", no_joint
    for n, load in enumerate(block.loads):
        if load.link is not None and load.link not in moving:
            yield f"/dynamics/loads/{n}/link", no_link
        if load.joint is not None and load.joint not in mechanism.joints:
            yield f"/dynamics/loads/{n}/joint", no_joint
    yield from _drive_faults(block, mechanism)


def _drive_faults(block: DynamicsBlock, mechanism: Mechanism) -> Iterator[Fault]:
    stated = block.drive
    if stated == "torque" and mechanism.driven_by_slide:
        yield "/dynamics/drive", "a slider drives this mechanism; leave the field out"
    if isinstance(stated, DrivenSlide):
        drives = [n for n, s in enumerate(mechanism.slides) if s.joint == mechanism.input and s.link == GROUND]
        if stated.slide not in drives:
            detail = f"the slide that drives is {drives[0]}" if drives else "a torque on the input link drives this"
            yield "/dynamics/drive/slide", detail


def machine_of(block: DynamicsBlock, mechanism: Mechanism, unit: LengthUnit) -> tuple[Machine, list[str]]:
    """The machine of a block without faults, and what a client should be warned of.

    Raises
    ------
    BlockError
        For a shape that leaves no mass.
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
        tuple(reader.load(load) for load in block.loads),
        scale * about,
        scale,
    )
    return machine, warnings


def first_fixed(mechanism: Mechanism) -> complex:
    """The first fixed pivot, or a point of the first slide where there is none."""
    ground = mechanism.links[GROUND]
    return complex(mechanism.joints[ground[0]] if ground else mechanism.slides[0].point)


class _Reader:
    """Places, bodies and loads of one mechanism in the unit of its forces."""

    def __init__(self, mechanism: Mechanism, scale: float) -> None:
        self.mechanism = mechanism
        self.scale = scale

    def place(self, link: str, stated: Place) -> complex:
        """A place on a link, in the reference configuration."""
        if not isinstance(stated, PolarPlace):
            return self.scale * complex(*stated)
        first, second = (complex(self.mechanism.joints[joint]) for joint in self.mechanism.links[link][:2])
        return self.scale * (first + stated.vector * (second - first) / abs(second - first))

    def body(self, link: str, stated: StatedBody) -> Body:
        """The body of a link."""
        if stated.shape is not None:
            return self._shaped(link, stated.shape)
        first = self.scale * complex(self.mechanism.joints[self.mechanism.links[link][0]])
        centre = first if stated.cg is None else self.place(link, stated.cg)
        return body(stated.mass or 0.0, centre, stated.inertia or 0.0)

    def _shaped(self, link: str, shape: Shape) -> Body:
        joints = {joint: self.scale * complex(self.mechanism.joints[joint]) for joint in self.mechanism.links[link]}
        bodies = [self._part(link, part, shape.density) for part in shape.parts]
        if shape.thickness is not None:
            if shape.polygon is not None:
                plate = shapes.polygon([self.place(link, corner) for corner in shape.polygon])
            elif shape.ends == "square":
                start, end = joints.values()
                plate = shapes.square_bar(start, end, self.scale * (shape.width or 0.0), self.scale * shape.overhang)
            else:
                plate = shapes.widened_hull(list(joints.values()), self.scale * (shape.width or 0.0))
            for joint, diameter in shape.holes.items():
                plate = plate.plus(shapes.disc(joints[joint], self.scale * diameter / 2.0), -1.0)
            path = f"/dynamics/bodies/{token(link)}/shape"
            if not plate.area > 0.0 or not math.isfinite(plate.polar):
                raise BlockError(path, "nothing is left of the plate; is the polygon flat, or are the holes too wide?")
            bodies.append(plate.body(shape.density, self.scale * shape.thickness))
        return joined(bodies)

    def _part(self, link: str, part: Part, density: float) -> Body:
        centre, density = self.place(link, part.at), density if part.density is None else part.density
        length = self.scale * part.length
        if part.form == "prism":
            section = shapes.rectangle(centre, length, self.scale * (part.width or 0.0))
            return section.body(density, self.scale * (part.thickness or 0.0))
        return shapes.cylinder(
            centre,
            self.scale * (part.diameter or 0.0),
            length,
            density,
            bore=self.scale * part.bore,
            in_plane=part.axis == "in_plane",
        )

    def load(self, stated: StatedLoad) -> Load:
        """A load of the analysis core."""
        if stated.torque is not None:
            return Torque(str(stated.link), constant(stated.torque.constant))
        assert stated.force is not None
        course = constant(complex(*stated.force.constant))
        if stated.joint is not None:
            return JointForce(stated.joint, course)
        assert stated.link is not None
        assert stated.point is not None
        place = np.asarray(self.place(stated.link, stated.point))
        return PointForce(stated.link, place, course, stated.frame == "link")
