"""Conversion of requested loads to load functions of the analysis core: tables over the input, and gas on a piston.

Tables are in the units of the request. The load functions of the core take its input: radians, or the position along
the slide in the length unit of the forces.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from kinematics.arrays import Real
from kinematics.dynamics.loads import Course, JointForce
from kinematics.errors import MechanismError as KinematicsError
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import find_cycle_from_reference
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from kinematics.message import compose
from synthesis.model.dynamics.loads import (
    FULL_TURN,
    ForceCurve,
    GasPressure,
    Interpolation,
    TorqueCurve,
    find_period_error,
)
from synthesis.model.dynamics.request import LoadedLinkage

Fault = tuple[str, str]

STEP_COUNT = 360
"""Number of positions of a turn. The best of them is the start of Newton's method for a dead centre."""


def count_turns(course: ForceCurve | TorqueCurve, mechanism: Mechanism) -> int:
    """Return the number of input turns after which a table repeats."""
    # A table without a given number of turns repeats with the mechanism.
    return course.turns or round(find_cycle_from_reference(mechanism) / (2.0 * math.pi))


def find_period_turns(block: LoadedLinkage, mechanism: Mechanism) -> int:
    """Return the number of input turns after which mechanism and loads repeat; 0 if they never do or a slide drives."""
    if mechanism.has_slide_input:
        return 0
    try:
        turns = [round(find_cycle_from_reference(mechanism) / (2.0 * math.pi))]
    except KinematicsError:
        return 0
    for load in block.loads:
        course = load.force or load.torque
        if course is not None and course.table is not None:
            turns.append(count_turns(course, mechanism))
        if load.force is not None and load.force.gas is not None:
            turns.append(load.force.gas.cycle // round(FULL_TURN))
    # All of them repeat together after the least common multiple of their periods.
    return math.lcm(*turns)


def find_course_errors(course: ForceCurve | TorqueCurve, mechanism: Mechanism) -> Iterator[Fault]:
    """Yield errors of a table over the input, as pairs (path within the course, detail)."""
    if course.table is None:
        return
    slide = mechanism.has_slide_input
    if slide != (course.by == "input_position"):
        # Further checks would only repeat this error in other words.
        yield "/by", compose("mechanisms-slide-drives" if slide else "mechanisms-link-drives")
        return
    if slide:
        if course.interpolation != "linear":
            yield "/interpolation", compose("mechanisms-slide-not-periodic")
        if course.turns is not None:
            yield "/turns", compose("mechanisms-slide-does-not-turn")
        return
    try:
        period = FULL_TURN * count_turns(course, mechanism)
    except KinematicsError as error:
        # The period is unknown, for example with gears of irrational ratio.
        yield "/turns", compose("mechanisms-table-period-unknown", reason=str(error))
        return
    fault = find_period_error(course.table, period)
    if fault is not None:
        yield "/table", fault


def interpolate_table(table: Real, period: float, interpolation: Interpolation) -> Course:
    """Return the load function of a table over the absolute input angle, degrees.

    It is periodic. A table with two value columns, x and y, gives a complex function.
    """
    angles, values = table[:, 0], table[:, 1] if table.shape[1] == 2 else table[:, 1] + 1j * table[:, 2]
    # A table may end before its period, or repeat its first row at the end. The interpolation needs the repeated row.
    if angles[-1] - angles[0] < period:
        angles, values = np.append(angles, angles[0] + period), np.append(values, values[0])
    else:
        # Copy the first value to the end, because a rounded last row would leave a step.
        values = np.append(values[:-1], values[0])
    start = angles[0]
    if interpolation == "linear":
        # Reduce the angle to the period of the table, which need not start at 0.
        return lambda input: np.interp(start + (np.degrees(input[0]) - start) % period, angles, values)
    spline = CubicSpline(angles, values, bc_type="periodic")
    return lambda input: np.asarray(spline(start + (np.degrees(input[0]) - start) % period))


def interpolate_along_slide(table: Real, scale: float) -> Course:
    """Return the load function of a table over the position of the input slide.

    ``scale`` is the length unit of the table in the length unit of the forces.
    """
    places, values = scale * table[:, 0], table[:, 1] if table.shape[1] == 2 else table[:, 1] + 1j * table[:, 2]
    return lambda input: np.interp(input[0], places, values)


def build_course(course: ForceCurve | TorqueCurve, mechanism: Mechanism, scale: float) -> Course:
    """Build the load function of a table or a constant."""
    if course.table is not None:
        table = np.array(course.table, np.float64)
        if course.by == "input_position":
            return interpolate_along_slide(table, scale)
        return interpolate_table(table, FULL_TURN * count_turns(course, mechanism), course.interpolation)
    stated = course.constant
    value = complex(*stated) if isinstance(stated, tuple) else float(stated or 0.0)
    return lambda input: np.full(input.shape[1:], value)


def find_ground_slide(mechanism: Mechanism, joint: str) -> int | None:
    """Return the index of the ground slide that carries a joint; None if there is none."""
    return next((n for n, s in enumerate(mechanism.slides) if s.joint == joint and s.link == GROUND), None)


def find_top_dead_centre(mechanism: Mechanism, slide: int) -> tuple[float, complex]:
    """Find the top dead centre of a joint on a ground slide.

    Return the input angle in [0, 2π) at which the joint is farthest from the crank's pivot, and the unit vector of the
    motion back.

    Raises
    ------
    ValueError
        If no crank moves the joint, or if the crank cannot make a full turn.
    """
    if mechanism.has_slide_input:
        raise ValueError(compose("mechanisms-gas-with-driving-slide"))
    name = mechanism.slide_names[slide]
    at = 2.0 * math.pi * np.arange(STEP_COUNT) / STEP_COUNT
    motion = drive(mechanism, at, order=0)
    if not motion.valid.all():
        raise ValueError(compose("mechanisms-gas-without-full-turn"))
    along = motion.slides[name][0]
    line = mechanism.slides[slide]
    direction = complex(np.exp(1j * line.angle))
    pivot = complex(mechanism.joints[mechanism.input_pivot])
    centre = ((pivot - complex(line.point)) * direction.conjugate()).real
    # The top dead centre is at the end of the stroke that is farther from the crank's pivot.
    outward = 1.0 if abs(along.max() - centre) >= abs(along.min() - centre) else -1.0
    step = 2.0 * math.pi / STEP_COUNT
    top = float(at[np.argmax(outward * along)])
    # Newton's method for zero velocity. From half a degree away, four steps reach rounding level.
    for _ in range(4):
        _, velocity, acceleration = drive(mechanism, [top], order=2).slides[name][:, 0]
        # At a toggle, or if the joint is at rest, keep the sampled position.
        if not np.isfinite(acceleration) or acceleration == 0.0:
            break
        # Limit the step to one sample, so that Newton's method cannot leave this extreme.
        top -= float(np.clip(velocity / acceleration, -step, step))
    return top % (2.0 * math.pi), -outward * direction


def build_gas_force(gas: GasPressure, mechanism: Mechanism, joint: str, scale: float) -> JointForce:
    """Build the gas force on the pin of a joint: gauge pressure times the area of the bore.

    Raises
    ------
    ValueError
        If the joint is not on a ground slide, or if no crank moves it.
    """
    slide = find_ground_slide(mechanism, joint)
    if slide is None:
        raise ValueError(compose("mechanisms-gas-without-piston", joint=joint))
    top, way = find_top_dead_centre(mechanism, slide)
    area = math.pi / 4.0 * (scale * gas.bore) ** 2
    pressure = interpolate_table(np.array(gas.pressure, np.float64), float(gas.cycle), gas.interpolation)
    phase = math.radians(gas.phase)

    def evaluate_force(input: Real) -> NDArray[np.complex128]:
        # An engine that runs backwards passes through its indicator diagram in the same order of events.
        sense = np.where(input[1] < 0.0, -1.0, 1.0)
        return np.asarray(way * area * pressure(np.asarray([sense * (input[0] - top) + phase])), np.complex128)

    return JointForce(joint, evaluate_force)
