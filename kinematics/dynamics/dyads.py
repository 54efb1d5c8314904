"""Drive, largest pin force and shaking of linkages built of dyads, kinematics included, in one compiled sweep.

Used as a fast filter over many positions of many designs of one topology. Reported values come from :mod:`reactions`,
which handles every topology, springs and friction. Positions are computed dyad by dyad from the driving link, forces in
the opposite order.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Integers, Numbers, Real
from kinematics.dynamics import dyad_kernels as kernels
from kinematics.dynamics.loads import JointForce, PointForce, Torque
from kinematics.dynamics.machine import Machine
from kinematics.errors import MechanismError
from kinematics.linkage.planar.closures import CACHE_SIZE
from kinematics.linkage.planar.drive_kernels import JOINT, LINK, OTHER_LINK, OTHER_PIN, PIN
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.linkage.planar.program import build_program


class NoDyadsError(MechanismError, ValueError):
    """A machine that elimination by dyads cannot handle."""


class DyadForces(NamedTuple):
    """Forces over designs × inputs, shape S + (N,); NaN where a closure is open or at a toggle.

    ``pin`` is the largest force of any pin on any of its links; ``drive`` is a force where a slide drives.
    """

    drive: Real
    pin: Real
    shaking_force: Complex
    shaking_moment: Real


class _Numbering(NamedTuple):
    """Numbering shared by all designs of one topology: links with the ground first, joints followed by the origin."""

    links: tuple[str, ...]
    joints: tuple[str, ...]
    bases: Integers
    exact: NDArray[np.bool_]
    gives: Integers


def is_built_of_dyads(machine: Machine) -> bool:
    """Return whether :func:`compute_dyad_forces` handles a machine.

    The machine must close by dyads alone, without a link on two known pins, springs or friction.
    """
    mechanism = machine.mechanism
    if mechanism.redundant or machine.friction.pins or machine.friction.slides:
        return False
    if not all(isinstance(load, PointForce | JointForce | Torque) for load in machine.loads):
        return False
    program = build_program(mechanism)
    # A link on two known pins has no dyad equation for its forces.
    return not program.class_iii and all(step.kind != "carried" for step in program.steps)


@lru_cache(maxsize=CACHE_SIZE)
def _build_numbering(mechanism: Mechanism) -> _Numbering:
    """Build the numbering of links and joints, and find the pin about which each link's moments are taken."""
    program = build_program(mechanism)
    rows, driver = program.code.rows, program.code.driver
    joints = tuple(mechanism.joints)
    # Moments of the ground are taken about the origin, a fictitious joint after the real ones.
    bases = np.full(len(program.links), len(joints))
    exact = np.zeros(len(program.links), np.bool_)
    if driver[0] > 0:
        bases[driver[0]], exact[driver[0]] = driver[1], True
    for row, step in zip(rows, program.steps, strict=True):
        bases[row[LINK]] = row[PIN]
        exact[row[LINK]] = step.kind == "gear"
        if step.kind == "RRR":
            bases[row[OTHER_LINK]] = row[OTHER_PIN]
    return _Numbering(program.links, joints, bases, exact, program.code.gives)


def compute_dyad_forces(
    machine: Machine, input: ArrayLike, speed: ArrayLike = 1.0, acceleration: ArrayLike = 0.0
) -> DyadForces:
    """Compute forces at absolute inputs, in the assemblies of the reference.

    Parameters
    ----------
    machine : Machine
        Designs of shape S for which :func:`is_built_of_dyads` is true.
    input, speed, acceleration : float
        Radians (or positions along the input slide) and their rates, broadcasting with S + (1,).

    Raises
    ------
    NoDyadsError
        For any other machine.
    """
    if not is_built_of_dyads(machine):
        raise NoDyadsError(
            "expected a linkage of dyads without springs and friction; use the general equations for others"
        )
    mechanism, make = machine.mechanism, _build_numbering(machine.mechanism)
    program = build_program(mechanism)
    given = np.broadcast_arrays(*(np.asarray(rate, np.float64) for rate in (input, speed, acceleration)))
    shape = np.broadcast_shapes((*mechanism.shape, 1), given[0].shape)
    input_jet = np.stack([np.broadcast_to(rate, shape) for rate in given])
    moved = input_jet.reshape(3, -1, shape[-1]).copy()
    # The kernel expects rotations from the reference configuration.
    moved[0] -= program.reference_input[:, None]
    if mechanism.has_slide_input:
        # A slide's input is a length, so it scales like all lengths.
        moved *= machine.scale
        input_jet *= machine.scale
    put = _KernelInput(machine, make)
    slide_points, slide_normals = put.lines()
    mass, cg, inertia = put.bodies()
    loads = put.loads(input_jet)
    out = np.empty((5, *moved.shape[1:]))
    kernels.eliminate(
        program.code.rows,
        program.code.ratios,
        make.bases,
        make.exact,
        _find_moved_joints(machine, make, loads.on),
        program.code.driver,
        put.joints,
        slide_points,
        slide_normals,
        np.stack([put.broadcast_value(sign) for sign in program.signs])
        if program.signs
        else np.empty((0, len(mass)), np.int64),
        mass,
        cg,
        inertia,
        put.pin_masses(),
        complex(machine.gravity),
        *loads,
        put.from_origin(machine.about),
        moved,
        out,
    )
    found = out.reshape(5, *shape)
    return DyadForces(
        found[kernels.DRIVE],
        found[kernels.PIN_FORCE],
        found[kernels.SHAKING_X] + 1j * found[kernels.SHAKING_Y],
        found[kernels.MOMENT],
    )


class _Loads(NamedTuple):
    """Loads in the form that the kernel expects."""

    on: Integers
    arms: Complex
    strengths: Complex
    couples: Real


class _KernelInput:
    """A machine's designs in rows, in the length unit of the forces.

    Points are relative to the first joint, since a distant origin would cost digits.
    """

    def __init__(self, machine: Machine, make: _Numbering) -> None:
        self.machine, self.make = machine, make
        self.designs = int(np.prod(machine.mechanism.shape, dtype=np.int64))
        joints = machine.mechanism.joints
        self.zero = machine.scale * self.broadcast_value(joints[make.joints[0]])
        placed = [self.from_origin(machine.scale * place) for place in joints.values()]
        self.joints = np.stack([*placed, np.zeros(self.designs, np.complex128)], axis=1)

    def broadcast_value(self, value: ArrayLike) -> Numbers:
        """Broadcast a value to every design, shape (D,)."""
        return np.broadcast_to(np.asarray(value), self.machine.mechanism.shape).ravel()

    def from_origin(self, place: ArrayLike) -> Complex:
        """Return a point of every design relative to the first joint."""
        return np.asarray(self.broadcast_value(place) - self.zero, np.complex128)

    def _from_pin(self, link: str, place: ArrayLike) -> Complex:
        return np.asarray(self.from_origin(place) - self.joints[:, self.make.bases[self.make.links.index(link)]])

    def lines(self) -> tuple[Complex, Complex]:
        """Return points of the slides' lines relative to the pins of their links, and normals; shape (D, slides)."""
        slides = self.machine.mechanism.slides
        points, normals = np.empty((2, self.designs, len(slides)), np.complex128)
        for n, slide in enumerate(slides):
            points[:, n] = self._from_pin(slide.link, self.machine.scale * slide.point)
            normals[:, n] = 1j * np.exp(1j * self.broadcast_value(slide.angle))
        return points, normals

    def bodies(self) -> tuple[Real, Complex, Real]:
        """Return masses, centres of gravity and moments of inertia, shape (D, links)."""
        mass, inertia = np.zeros((2, self.designs, len(self.make.links)))
        cg = np.zeros(mass.shape, np.complex128)
        for link, part in self.machine.bodies.items():
            k = self.make.links.index(link)
            mass[:, k], cg[:, k], inertia[:, k] = (
                self.broadcast_value(part.mass),
                self._from_pin(link, part.cg),
                self.broadcast_value(part.inertia),
            )
        return mass, cg, inertia

    def pin_masses(self) -> Real:
        """Return point masses, shape (D, joints)."""
        masses = np.zeros(self.joints.shape)
        for joint, mass in self.machine.pin_masses.items():
            masses[:, self.make.joints.index(joint)] = self.broadcast_value(mass)
        return masses

    def loads(self, input_jet: Real) -> _Loads:
        """Return the loads at an input of shape (3,) + S + (N,)."""
        shape, links = input_jet.shape[1:], self.make.links
        flat = self.designs, shape[-1]
        turning = any(isinstance(load, Torque) for load in self.machine.loads)
        couples = np.zeros((len(links), *flat) if turning else (0, 0, 0))
        on: list[tuple[int, int, int]] = []
        arms: list[Complex] = []
        strengths: list[Complex] = []
        for load in self.machine.loads:
            if not isinstance(load, PointForce | JointForce | Torque):
                continue
            # Loads are functions of the input: evaluate them once for all positions.
            course = np.broadcast_to(load.course(input_jet), shape).reshape(flat)
            if isinstance(load, Torque):
                couples[links.index(load.link)] += course.real
                continue
            strengths.append(course.astype(np.complex128))
            if isinstance(load, PointForce):
                on.append((kernels.ON_LINK, links.index(load.link), int(load.turning)))
                arms.append(self._from_pin(load.link, load.place))
            else:
                on.append((kernels.ON_JOINT, self.make.joints.index(load.joint), 0))
                arms.append(np.zeros(self.designs, np.complex128))
        return _Loads(
            np.array(on, np.int64).reshape(-1, 3),
            np.ascontiguousarray(np.array(arms, np.complex128).reshape(len(on), self.designs).T),
            np.array(strengths, np.complex128).reshape(len(on), *flat),
            couples,
        )


def _find_moved_joints(machine: Machine, make: _Numbering, on: Integers) -> Integers:
    """List the joints that each link determines, limited to those that a closure, mass or load uses."""
    code = build_program(machine.mechanism).code
    # Skipping joints without any role saves their motion in every lane.
    used = {int(code.driver[1])} | {int(joint) for row in code.rows for joint in row[[PIN, JOINT, OTHER_PIN]]}
    used |= {make.joints.index(joint) for joint in machine.pin_masses}
    used |= {int(which) for kind, which, _ in on if kind == kernels.ON_JOINT}
    carried = np.zeros_like(make.gives)
    for link, listed in enumerate(make.gives):
        kept = [int(joint) for joint in listed[1 : listed[0] + 1] if int(joint) in used]
        carried[link, : len(kept) + 1] = len(kept), *kept
    return carried
