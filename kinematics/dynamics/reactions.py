"""Inverse dynamics: the reactions at every pin, slide and gear, the drive, and the shaking force.

Newton's and Euler's equations of every moving link, Σ F = m a_G and Σ M = I α with moments about a joint of the link
(Norton, *Design of Machinery*, eq. 11.1), solved together at each position. Nothing here is used by :mod:`balance`,
which finds the drive and the shaking force by work and momentum.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Mask, Real, Scalar
from kinematics.dynamics import kernels, redundancy
from kinematics.dynamics.friction import Contact, Rubbing, build_wrenches, compute_factors, is_still, list_contacts
from kinematics.dynamics.friction_kernels import solve_friction
from kinematics.dynamics.loads import Effort
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places, cross
from kinematics.dynamics.system import System, build_system
from kinematics.linkage.planar.mechanism import GROUND, TopologyError

UNKNOWN_FORCE = complex(np.nan, np.nan)
"""An unknown force: NaN in both components."""

MAX_CONDITION = 1e12
"""Condition number above which a position is a dead centre: at most four digits of the reactions remain."""


@dataclass(frozen=True)
class Reactions:
    """Forces over designs × positions, each of shape S + (N,); NaN where ``solved`` is False.

    Attributes
    ----------
    solved : bool
        Where the equations determine all reactions.
    determined : bool
        Where the loads are finite; a spring whose ends meet has no direction. Only these positions are solved.
    condition : float
        Condition number of the equations.
    drive : float
        Torque of the ground on the input link, or force along the input slide.
    joints : dict of dict of complex
        Force of the pin of each joint on each of its links, the ground among them.
    slides : tuple of float
        Force of each slide's line on its pin, along the direction turned by +90°.
    gears : tuple of float
        Torque of each gear pair on its second link; −ratio times that acts on the first, the rest on the ground.
    rubbing : Rubbing
        Friction of each contact.
    jammed : bool
        Where friction permits no solution, or several.
    indeterminate : bool
        Where some joint forces are not unique because constraints are redundant; drive and shaking force still are.
    shaking_force, shaking_moment
        Sum of all forces of the mechanism on the ground, and their moment about the machine's point minus the drive.
    """

    solved: Mask
    determined: Mask
    condition: Real
    drive: Real
    joints: dict[str, dict[str, Complex]]
    slides: tuple[Real, ...]
    gears: tuple[Real, ...]
    shaking_force: Complex
    shaking_moment: Real
    rubbing: Rubbing
    jammed: Mask
    indeterminate: Mask


def collect_efforts(machine: Machine, now: Places) -> list[Effort]:
    """Collect the loads, and the weight and inertia of point masses (d'Alembert's force on the pin)."""
    efforts = [effort for load in machine.loads for effort in load.efforts(now)]
    none = np.zeros(())
    for joint, mass in machine.pin_masses.items():
        at, _, acceleration = now.joints[joint]
        force = np.asarray(mass)[..., None] * (machine.gravity - acceleration)
        efforts.append(Effort("", joint, at, force, none))
    return efforts


class _EquationRows(NamedTuple):
    """The equations of M positions, one after the other, and where their solutions are written."""

    joints: Complex
    directions: Complex
    known: Real
    posed: Mask
    solutions: Real
    conditions: Real


def _solve_with_friction(
    now: Places, system: System, contacts: tuple[Contact, ...], rows: _EquationRows
) -> tuple[Real, Mask]:
    """Solve with friction at the contacts; return their friction, shape (contacts, M), and where the machine jams."""
    shape, size = now.smooth.shape, now.size
    columns = np.array([contact.columns for contact in contacts], np.int64)
    factors = np.stack([np.broadcast_to(compute_factors(c, now, size), shape) for c in contacts])
    factors = factors.reshape(len(contacts), -1)
    terms, coefficients = build_wrenches(contacts, now.mechanism, system, len(now.mechanism.slides) + 1)
    frictions, jammed = np.empty(factors.shape), np.zeros(len(rows.known), np.bool_)
    equations = system.terms, system.coefficients, system.bases
    arguments = (*equations, terms, coefficients, columns, factors, *rows, frictions, jammed)
    solve_friction(*arguments)
    return frictions, jammed


def _solve_machine(machine: Machine, now: Places, system: System, known: Real) -> tuple[_Solution, list[Real]]:
    """Solve the equations of all positions.

    Returns
    -------
    outcome : _Solution
        The solution, NaN where the equations are singular.
    open_forces : list of array
        Self-stresses of a machine with redundant constraints.
    """
    mechanism, shape, size = machine.mechanism, now.smooth.shape, now.size
    slides = len(mechanism.slides)
    along = [now.direction(n)[0] for n in range(slides)]
    directions = np.stack([*(1j * line for line in along), _get_input_direction(now), *along]).reshape(
        2 * slides + 1, -1
    )
    # Lengths as shares of the size make forces and torques comparable, so that the condition number means something.
    joints = np.stack([jet[0] / size for jet in now.joints.values()]).reshape(len(mechanism.joints), -1)
    solutions, conditions = np.empty((known.shape[0], system.columns)), np.empty(len(known))
    determined: Mask = np.asarray(np.isfinite(known).all(axis=1))
    # Solve only where derivatives exist and all loads are finite.
    posed = now.smooth.ravel() & determined
    jammed, stick = np.zeros(len(known), np.bool_), np.zeros(shape, np.bool_)
    frictions = np.empty((0, len(known)))
    rows = _EquationRows(joints, directions, known, posed, solutions, conditions)
    contacts = list_contacts(mechanism, system, machine.friction)
    open_forces: list[Real] = []
    if machine.mechanism.redundant:
        if contacts:
            raise TopologyError("kinematics-friction-undetermined-if-redundant")
        open_forces = redundancy.solve_minimum_norm(system, *rows)
    elif contacts:
        stick = np.logical_or.reduce([np.broadcast_to(is_still(c, now), shape) for c in contacts])
        frictions, jammed = _solve_with_friction(now, system, contacts, rows)
    else:
        kernels.solve_positions(system.terms, system.coefficients, system.bases, *rows)
    # "not <" also marks NaN and infinite condition numbers.
    singular = ~(conditions < MAX_CONDITION)
    solutions[singular], frictions[:, singular], jammed[singular] = np.nan, np.nan, False
    values = [
        friction.reshape(shape) * (1.0 if c.slide >= 0 else size)
        for c, friction in zip(contacts, frictions, strict=True)
    ]
    rubbing = Rubbing(contacts, tuple(values), np.asarray(stick))
    outcome = _Solution(
        [column.reshape(shape) for column in solutions.T],
        conditions.reshape(shape),
        np.asarray(determined.reshape(shape)),
        np.asarray(jammed.reshape(shape)),
        rubbing,
    )
    return outcome, open_forces


def compute_reactions(machine: Machine, now: Places, *, minimum_norm: bool = False) -> Reactions:
    """Compute all reactions of a machine at the positions of a motion.

    With redundant constraints the joint forces that are not determined are NaN or, with ``minimum_norm``, those of the
    smallest sum of squares (:mod:`redundancy`).

    Raises
    ------
    TopologyError
        For friction with redundant constraints: it would depend on forces that are not unique.
    """
    mechanism, system = machine.mechanism, build_system(machine.mechanism)
    shape, size = now.smooth.shape, now.size
    # Loads on pins are collected per joint, since the hub carries them.
    efforts = collect_efforts(machine, now)
    on_pins: dict[str, Complex] = {joint: np.zeros(shape, np.complex128) for joint in mechanism.joints}
    for effort in efforts:
        if effort.joint:
            on_pins[effort.joint] = on_pins[effort.joint] + effort.force
    known = _build_right_sides(machine, now, system, efforts, on_pins, size)
    outcome, open_forces = _solve_machine(machine, now, system, known)
    found = _assemble_reactions(machine, now, system, efforts, on_pins, outcome, size)
    if not machine.mechanism.redundant:
        return found
    # A self-stress is a solution without loads: evaluate it like the forces, to compare component by component.
    nothing = {joint: np.zeros(shape, np.complex128) for joint in mechanism.joints}
    stresses = [
        _assemble_reactions(
            machine, now, system, [], nothing, outcome._replace(unknowns=[c.reshape(shape) for c in forces.T]), size
        )
        for forces in open_forces
    ]
    return _mask_indeterminate(found, stresses, size, keep=minimum_norm)


def _mask_indeterminate(found: Reactions, stresses: list[Reactions], size: Real, *, keep: bool) -> Reactions:
    """Mark the forces that are not unique and, unless ``keep``, replace them by NaN."""
    indeterminate = np.zeros(found.solved.shape, np.bool_)

    def mask_force(force: NDArray[Scalar], parts: list[NDArray[Scalar]]) -> NDArray[Scalar]:
        unique = redundancy.is_unique(force, parts)
        np.logical_or(indeterminate, ~unique, out=indeterminate)
        return force if keep else np.where(unique, force, UNKNOWN_FORCE if np.iscomplexobj(force) else np.nan)

    joints = {
        joint: {
            link: mask_force(force, [stress.joints[joint][link] for stress in stresses]) for link, force in on.items()
        }
        for joint, on in found.joints.items()
    }
    slides = tuple(
        mask_force(normal, [stress.slides[n] for stress in stresses]) for n, normal in enumerate(found.slides)
    )
    gears = tuple(
        mask_force(torque, [stress.gears[n] / size for stress in stresses]) for n, torque in enumerate(found.gears)
    )
    return replace(found, joints=joints, slides=slides, gears=gears, indeterminate=indeterminate)


class _Solution(NamedTuple):
    """Solution of the kernels, over positions of shape S + (N,)."""

    unknowns: list[Real]
    condition: Real
    determined: Mask
    jammed: Mask
    rubbing: Rubbing


def _get_input_direction(now: Places) -> Complex:
    mechanism = now.mechanism
    if not mechanism.has_slide_input:
        return np.zeros(now.smooth.shape, np.complex128)
    return np.asarray(now.direction(_find_input_slide(now))[0])


def _find_input_slide(now: Places) -> int:
    slides = now.mechanism.slides
    return next(n for n, s in enumerate(slides) if s.joint == now.mechanism.input and s.link == GROUND)


def _build_right_sides(
    machine: Machine,
    now: Places,
    system: System,
    efforts: list[Effort],
    on_pins: dict[str, Complex],
    size: Real,
) -> Real:
    """Build the right-hand sides, inertia minus all loads on each moving link; shape (M, 3 × links)."""
    shape = now.smooth.shape
    rows = np.zeros((3 * len(system.moving), *shape))
    number = {link: n for n, link in enumerate(system.moving)}

    def add_wrench(link: str, at: Complex, force: Complex, couple: Real, sign: float) -> None:
        if link == GROUND:
            return
        n, base = number[link], now.joints[now.base(link)][0]
        rows[3 * n] += sign * force.real
        rows[3 * n + 1] += sign * force.imag
        rows[3 * n + 2] += sign * (cross(at - base, force) + couple) / size

    none = np.zeros(())
    for link, part in machine.bodies.items():
        at, _, acceleration = now.point(link, part.cg)
        force = np.asarray(part.mass)[..., None] * (acceleration - machine.gravity)
        add_wrench(link, at, force, np.asarray(part.inertia)[..., None] * now.spins[link][2], 1.0)
    for effort in efforts:
        if not effort.joint:
            add_wrench(effort.link, effort.at, effort.force, effort.couple, -1.0)
    for joint, force in on_pins.items():
        # The hub takes all loads on its pin, by the convention of the system of equations.
        add_wrench(system.hubs[joint], now.joints[joint][0], force, none, -1.0)
    return np.ascontiguousarray(rows.reshape(len(rows), -1).T)


def _assemble_reactions(
    machine: Machine,
    now: Places,
    system: System,
    efforts: list[Effort],
    on_pins: dict[str, Complex],
    outcome: _Solution,
    size: Real,
) -> Reactions:
    """Assemble the forces at all joints, slides and gears from the unknowns of the solution; NaN where unsolved."""
    mechanism, unknowns = machine.mechanism, outcome.unknowns
    solved = (outcome.condition < MAX_CONDITION) & ~outcome.jammed
    slides = tuple(unknowns[system.slides_at : system.slides_at + len(mechanism.slides)])
    gears = tuple(size * torque for torque in unknowns[system.slides_at + len(slides) : system.columns - 1])
    drive = unknowns[-1] if mechanism.has_slide_input else size[..., :] * unknowns[-1]
    on_hub = {joint: np.where(solved, force, UNKNOWN_FORCE) for joint, force in on_pins.items()}
    lines = _compute_line_forces(now, slides, outcome.rubbing)
    for slide, force in zip(mechanism.slides, lines, strict=True):
        on_hub[slide.joint] = on_hub[slide.joint] + force
    if mechanism.has_slide_input:
        on_hub[mechanism.input] = on_hub[mechanism.input] + drive * _get_input_direction(now)
    joints: dict[str, dict[str, Complex]] = {joint: {} for joint in mechanism.joints}
    for n, (joint, link) in enumerate(system.pins):
        force = unknowns[2 * n] + 1j * unknowns[2 * n + 1]
        joints[joint][link] = force
        on_hub[joint] = on_hub[joint] - force
    for joint, hub in system.hubs.items():
        joints[joint][hub] = on_hub[joint]
    # The shaking force is the sum of everything that acts on the frame.
    force, moment = _sum_ground_forces(machine, now, efforts, joints, lines, gears, drive, outcome.rubbing)
    return Reactions(
        solved,
        outcome.determined,
        outcome.condition,
        drive,
        joints,
        slides,
        gears,
        force,
        moment,
        outcome.rubbing,
        outcome.jammed,
        np.zeros(now.smooth.shape, np.bool_),
    )


def _compute_line_forces(now: Places, slides: tuple[Real, ...], rubbing: Rubbing) -> list[Complex]:
    """Compute the force of each slide's line on its pin: normal force and friction."""
    forces = [normal * 1j * now.direction(n)[0] for n, normal in enumerate(slides)]
    for contact, friction in zip(rubbing.contacts, rubbing.frictions, strict=True):
        if contact.slide >= 0:
            forces[contact.slide] = forces[contact.slide] + friction * now.direction(contact.slide)[0]
    return forces


def _sum_ground_forces(
    machine: Machine,
    now: Places,
    efforts: list[Effort],
    joints: dict[str, dict[str, Complex]],
    lines: list[Complex],
    gears: tuple[Real, ...],
    drive: Real,
    rubbing: Rubbing,
) -> tuple[Complex, Real]:
    """Sum the force of the mechanism on the ground, and its moment about the machine's point."""
    mechanism = machine.mechanism
    total = np.zeros(now.smooth.shape, np.complex128)
    moment = np.zeros(now.smooth.shape)
    pushes = [(now.joints[joint][0], on[GROUND]) for joint, on in joints.items() if GROUND in on]
    for slide, force in zip(mechanism.slides, lines, strict=True):
        if slide.link == GROUND:
            pushes.append((now.joints[slide.joint][0], -force))
    for contact, friction in zip(rubbing.contacts, rubbing.frictions, strict=True):
        if contact.slide < 0 and GROUND in (contact.link, contact.against):
            moment = moment + (friction if contact.link == GROUND else -friction)
    # The drive reacts on the ground, as a force along the slide or as a couple.
    if mechanism.has_slide_input:
        pushes.append((now.joints[mechanism.input][0], -drive * _get_input_direction(now)))
    else:
        moment = moment - drive
    for gear, torque in zip(mechanism.gears, gears, strict=True):
        share = {gear.second: 1.0}
        share[gear.first] = share.get(gear.first, 0.0) - gear.ratio
        # Both gear torques are supported by the ground's bearings; a gear fixed to the ground is no moving link.
        moment = moment - torque * sum(factor for link, factor in share.items() if link != GROUND)
    for effort in efforts:
        if effort.link == GROUND and not effort.joint:
            pushes.append((effort.at, effort.force))
            moment = moment + effort.couple
    for at, force in pushes:
        total = total + force
        moment = moment + cross(at - machine.about, force)
    return total, moment
