"""Forces of an engine at a speed: one cylinder's in closed form, and their sums over the engine.

For one cylinder, x is along its axis away from the crank and y to the left of it, with the crank at θ after top dead
centre (Norton, *Design of Machinery*, eq. 13.6, 13.15, 13.20-13.23). m_B is the whole reciprocating mass, m_p the
piston's part of it, and m_3a, m_3b are the equivalent masses of the rod at the crank pin and at the wrist pin:

    side force of the piston on the wall     −(m_B a + F_g) tan φ
    rod on piston                            (m_p a + F_g, side)
    rod on crank                             −(rod on piston) − m_3b a x̂ − m_3a a_A
    torque given                             −(m_B a + F_g) dx/dθ, of the gas and of inertia

The rod's moment of inertia beyond that of two masses adds ΔI φ̈ over l cos φ to the forces across the axis, and
−ΔI φ̈ dφ/dθ to the torque.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from kinematics.arrays import Complex, Real
from kinematics.engine.pistons import Rod, build_two_mass_rod, compute_piston_motion
from synthesis.kinds.engine.arrangement import Cylinders, compute_middle
from synthesis.kinds.engine.problem import EngineProblem
from synthesis.model.dynamics.loads import PairRows

STEPS_PER_TURN = 1440
"""Number of positions per turn."""


class Cylinder(NamedTuple):
    """One cylinder over its cycle, from the top dead centre of its firing; shape (N,)."""

    side: Real
    wrist: Complex
    pin: Complex
    main: Complex
    gas: Real
    inertia: Real
    shaking: Complex
    two_mass: Real


class Engine(NamedTuple):
    """An engine over its cycle, shape (N,): its torques, and the forces on its frame."""

    angle: Real
    gas: Real
    inertia: Real
    shaking: Complex
    moment: Complex
    two_mass: Real


class Masses(NamedTuple):
    """Masses of one cylinder; ``turning`` is the mass times radius of its throw, without the rod's part."""

    piston: float
    rod: Rod
    turning: float


def build_masses(problem: EngineProblem) -> Masses:
    """Build the masses in the units of the forces; zero if none are given."""
    stated, scale = problem.masses, problem.scale
    if stated is None:
        return Masses(0.0, Rod(0.0, 0.0, 0.0), 0.0)
    length = scale * problem.rod_length
    # The exact rod is two masses at its pins plus an excess moment of inertia.
    rod = build_two_mass_rod(length, stated.rod.mass, scale * stated.rod.cg, stated.rod.inertia)
    turning = 0.0 if stated.crank is None else stated.crank.mass * scale * stated.crank.cg
    return Masses(stated.piston, rod, turning)


def compute_gas_force(problem: EngineProblem, angle: Real) -> Real:
    """Compute the gas force on a piston towards the crank, over degrees after the top dead centre of its firing."""
    if problem.pressure is None or problem.bore is None:
        return np.zeros_like(angle)
    rows: PairRows = problem.pressure.table
    at, value = (np.array(column) for column in zip(*rows, strict=True))
    # Close the table with its first row if it does not cover the whole cycle.
    if at[-1] - at[0] < problem.cycle:
        at, value = np.append(at, at[0] + problem.cycle), np.append(value, value[0])
    value[-1] = value[0]
    # Fold angles into the table's cycle.
    within = at[0] + np.mod(angle - at[0], problem.cycle)
    area = math.pi / 4.0 * (problem.scale * problem.bore) ** 2
    if problem.pressure.interpolation == "linear":
        return np.asarray(area * np.interp(within, at, value))
    return np.asarray(area * CubicSpline(at, value, bc_type="periodic")(within))


def compute_cylinder(problem: EngineProblem, degrees: Real, speed: float) -> Cylinder:
    """Compute the forces of one cylinder at angles after the top dead centre of its firing; speed in rad/s."""
    theta = np.radians(degrees)
    scale = problem.scale
    crank, length, masses = scale * problem.crank, scale * problem.rod_length, build_masses(problem)
    moved = compute_piston_motion(theta, crank, length, two_term=problem.method == "two_term")
    rod, square = masses.rod, speed**2
    to_and_fro = masses.piston + rod.wrist_pin
    gas, inertia = compute_gas_force(problem, degrees), to_and_fro * square * moved.bend
    # The rod's angle, sin φ = (r/l) sin θ, is exact in both methods. The excess inertia only counts in the exact one.
    excess = rod.excess if problem.method == "exact" else 0.0
    lean = np.arcsin(crank / length * np.sin(theta))
    swing = crank / length * np.cos(theta) / np.cos(lean)
    bend = (-crank / length * np.sin(theta) + swing**2 * np.sin(lean)) / np.cos(lean)
    across = excess * square * bend / (length * np.cos(lean))
    side = -(inertia + gas) * moved.lean + across
    wrist = masses.piston * square * moved.bend + gas + 1j * side
    pin_turning = crank * square * np.exp(1j * theta)
    pin = -wrist - rod.wrist_pin * square * moved.bend + rod.crank_pin * pin_turning
    main = pin + masses.turning * square * np.exp(1j * theta)
    return Cylinder(
        side=side,
        wrist=wrist,
        pin=np.asarray(pin, np.complex128),
        main=np.asarray(main, np.complex128),
        gas=-gas * moved.slope,
        inertia=-inertia * moved.slope - excess * square * bend * swing,
        shaking=np.asarray(-inertia + rod.crank_pin * pin_turning, np.complex128),
        two_mass=excess * square * bend * swing,
    )


def compute_engine(
    problem: EngineProblem, cylinders: Cylinders, fires: Real, speed: float, steps: int = STEPS_PER_TURN
) -> Engine:
    """Sum torques and forces over an engine firing at angles ``fires``, degrees; moments are force times spacing."""
    count = round(steps * problem.cycle / 360.0)
    angle = problem.cycle * np.arange(count + 1) / count
    gas, inertia, two_mass = np.zeros(count + 1), np.zeros(count + 1), np.zeros(count + 1)
    shaking, moment = np.zeros(count + 1, np.complex128), np.zeros(count + 1, np.complex128)
    about = 0.0 if problem.moment_about == "first_throw" else compute_middle(cylinders.place)
    for axis, place, fire in zip(cylinders.axis, cylinders.place, fires, strict=True):
        one = compute_cylinder(problem, angle - fire, speed)
        force = one.shaking * np.exp(1j * math.radians(axis))
        gas, inertia, two_mass = gas + one.gas, inertia + one.inertia, two_mass + one.two_mass
        shaking, moment = shaking + force, moment + (place - about) * force
    turning = build_masses(problem).turning * speed**2
    # The rotating mass belongs to the throw: it counts once even if several cylinders share it.
    for throw in np.unique(cylinders.throw):
        k = int(np.argmax(cylinders.throw == throw))
        # At the firing of its first cylinder, the throw points along that cylinder's axis.
        force = turning * np.exp(1j * np.radians(angle - fires[k] + cylinders.axis[k]))
        shaking, moment = shaking + force, moment + (cylinders.place[k] - about) * force
    return Engine(angle, gas, inertia, shaking, moment, two_mass)
