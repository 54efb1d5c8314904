"""Verification of engines: the slider-crank of each cylinder is driven, and the forces on the frame are measured on it.

No result of the solver is used. Pistons and cranks belong to a closed mechanism, which is driven to get their
accelerations. Harmonics are read from a Fourier transform of the summed accelerations. Torques and pin forces are the
reactions of :mod:`kinematics.dynamics`, and a balancing weight's force is the second derivative of its position.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from kinematics.arrays import Complex, Real
from kinematics.dynamics.bodies import make_body
from kinematics.dynamics.loads import JointForce
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import Reactions, compute_reactions
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from synthesis.analyses.input_motion import RAD_PER_S
from synthesis.kinds.engine.design import Balancer, EngineCourse, EngineCylinder, EngineDesign, EngineFlywheel
from synthesis.kinds.engine.problem import EngineProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ANGLE
from synthesis.verification.checks import check_error, check_maximum
from synthesis.verification.shaft_speed import integrate_speed

SAMPLE_COUNT = 4096
"""Number of positions per turn: far more than the harmonics of a piston, unless the rod is hardly longer than the
crank."""

ROUTE_TOLERANCE = 1e-9
"""Difference of two methods, as a share of one cylinder's magnitudes, that is attributed to rounding."""

EVENNESS_TOLERANCE = 1e-6
"""Unevenness in degrees that is attributed to rounding."""

DEAD_CENTRE_TOLERANCE = 1e-6
"""Permitted distance of a firing from the numerically located top dead centre, degrees."""

COEFFICIENT_TOLERANCE = 1e-6
"""Permitted relative excess of the integrated coefficient of fluctuation over the requested one."""


class _ShakingSpectra(NamedTuple):
    """Fourier coefficients of the accelerations of all pistons, summed: at k with the crank, at −k opposite to it."""

    force: Complex
    moment: Complex
    one: Complex


def verify_engine(problem: EngineProblem, design: EngineDesign) -> Verification:
    """Drive the cylinders of an engine and compare the measurements with the values of the design.

    Parameters
    ----------
    problem : EngineProblem
        The request.
    design : EngineDesign
        Its mechanism defines the engine. All other parts are claims to be verified.
    """
    shaken = _compute_spectra(design)
    # The textbooks' two-term formula deviates by the omitted terms, of the order of λ³ in the second harmonic.
    off = ROUTE_TOLERANCE if problem.method == "exact" else (problem.crank / problem.rod_length) ** 2
    checks = [
        check_error("harmonics", _compare_harmonics(problem, design, shaken), ROUTE_TOLERANCE),
        check_error("piston_series", _compare_series(design, shaken), off),
        check_error("fires_at_top", _measure_firing_error(design), DEAD_CENTRE_TOLERANCE, ANGLE),
        check_error("balancers", _measure_unbalance(design, shaken, off), off),
    ]
    if problem.layout.throws is None and problem.throw_angles is None:
        checks.append(check_error("even_firing", _measure_unevenness(problem, design), EVENNESS_TOLERANCE, ANGLE))
    if problem.firing_order is not None:
        checks.append(Check(name="firing_order", passed=_has_order(problem, design)))
    if design.course is not None:
        checks += _check_forces(problem, design, design.course, off)
    if design.flywheel is not None and problem.flywheel is not None:
        checks += _check_flywheel(problem, design, design.flywheel)
    return Verification.from_checks(checks)


def _drive_cylinder(design: EngineDesign, cylinder: EngineCylinder, angle: Real) -> Complex:
    """Return place, velocity and acceleration by angle of a cylinder's piston, over crank angles; (3, N)."""
    mechanism, axis = design.mechanism, math.radians(cylinder.axis)
    made = catalogue.make_slider_crank(0j, 0j, axis, mechanism.crank, mechanism.rod, axis)
    motion = drive(made, angle - math.radians(cylinder.phase), order=2)
    return np.asarray(motion.joints["B"])


def _turn() -> Real:
    return np.asarray(2.0 * math.pi * np.arange(SAMPLE_COUNT) / SAMPLE_COUNT)


def _compute_spectra(design: EngineDesign) -> _ShakingSpectra:
    """Compute the spectra of the pistons' force on the frame, minus their accelerations, for unit mass, speed and r."""
    turn, crank = _turn(), design.mechanism.crank
    force, moment = np.zeros(SAMPLE_COUNT, np.complex128), np.zeros(SAMPLE_COUNT, np.complex128)
    for cylinder in design.mechanism.cylinders:
        push = -_drive_cylinder(design, cylinder, turn)[2] / crank
        force, moment = force + push, moment + cylinder.place * push
    upright = EngineCylinder(number=1, throw=1, axis=0.0, phase=0.0, place=0.0)
    one = -_drive_cylinder(design, upright, turn)[2] / crank
    return _ShakingSpectra(*(np.fft.fft(values) / SAMPLE_COUNT for values in (force, moment, one)))


def _get_moment_reference(problem: EngineProblem, design: EngineDesign) -> float:
    if problem.moment_about == "first_throw":
        return 0.0
    return _compute_middle(design)


def _compute_middle(design: EngineDesign) -> float:
    places = [cylinder.place for cylinder in design.mechanism.cylinders]
    return 0.5 * (min(places) + max(places))


def _compare_harmonics(problem: EngineProblem, design: EngineDesign, shaken: _ShakingSpectra) -> float:
    """Return the largest difference of a rotating part, in units of the first harmonic of one cylinder."""
    about, worst, count = _get_moment_reference(problem, design), 0.0, len(design.mechanism.cylinders)
    # Moments are compared in units of the longest lever.
    reach = max(1.0, *(abs(cylinder.place - about) for cylinder in design.mechanism.cylinders))
    for harmonic in design.harmonics:
        k = harmonic.order
        # The third order is only reported for the torque.
        if k == 3:
            continue
        # The harmonic of one cylinder is planar, so that each of its two rotating parts is half of it.
        whole = 2.0 * abs(shaken.one[k])
        moment = shaken.moment - about * shaken.force
        for spectrum, told, size in ((shaken.force, harmonic.force, 1.0), (moment, harmonic.moment, reach)):
            parts = (spectrum[k], told.forward), (spectrum[-k], told.backward)
            worst = max(worst, *(abs(abs(found) - whole * claimed) / (count * size) for found, claimed in parts))
            worst = max(worst, abs(told.major - told.forward - told.backward) / (count * size))
    return float(worst)


def _compare_series(design: EngineDesign, shaken: _ShakingSpectra) -> float:
    """Return the largest difference of a coefficient of the piston's acceleration."""
    known = {harmonic.order: harmonic.coefficient for harmonic in design.harmonics}
    return max(
        abs(2.0 * float(shaken.one[k].real) - coefficient)
        for k, coefficient in known.items()
        if coefficient is not None
    )


def _measure_firing_error(design: EngineDesign) -> float:
    """Return the largest distance of a firing from the outer dead centre of its piston, degrees."""
    first = design.mechanism.cylinders[0]
    # Crank angle of the first cylinder's top dead centre, the origin of firing angles.
    start = math.radians(first.phase + first.axis)
    worst = 0.0
    for order in design.firing.orders:
        for number, angle in zip(order.order, order.angles, strict=True):
            cylinder = design.mechanism.cylinders[number - 1]
            away = np.exp(-1j * math.radians(cylinder.axis))
            place, slope, bend = (
                _drive_cylinder(design, cylinder, np.array([start + math.radians(angle)]))[:, 0] * away
            ).real
            # One Newton step gives the distance to the dead centre. At the inner one the curvature is positive.
            missed = math.degrees(abs(slope / bend)) if bend < 0.0 and place > 0.0 else 180.0
            worst = max(worst, missed)
    return worst


def _measure_unevenness(problem: EngineProblem, design: EngineDesign) -> float:
    """Return the largest minus the smallest interval of the first order."""
    order = design.firing.orders[0]
    gaps = np.diff([*order.angles, order.angles[0] + problem.cycle])
    return float(gaps.max() - gaps.min())


def _has_order(problem: EngineProblem, design: EngineDesign) -> bool:
    """Return whether the cylinders can fire in the requested order, each at a top dead centre and any given angle."""
    order, cylinders = problem.firing_order or [], design.mechanism.cylinders
    tops = [math.fmod(cylinders[k - 1].phase + cylinders[k - 1].axis, 360.0) for k in order]
    tops = [(top - tops[0]) % 360.0 for top in tops]
    if problem.firing_angles is not None:
        start = problem.firing_angles[0]
        missed = (math.remainder(at - start - top, 360.0) for at, top in zip(problem.firing_angles, tops, strict=True))
        turned = [(at - start) % problem.cycle for at in problem.firing_angles]
        return max(map(abs, missed)) <= EVENNESS_TOLERANCE and turned == sorted(turned)
    at = 0.0
    for top in tops[1:]:
        # Advance to the next top dead centre of this cylinder; two cylinders may fire at the same time.
        at += (
            (top - at - EVENNESS_TOLERANCE) % 360.0 + EVENNESS_TOLERANCE
            if (top - at) % 360.0 > EVENNESS_TOLERANCE
            else 0.0
        )
    return at < problem.cycle - EVENNESS_TOLERANCE or len(order) == 1


def _measure_unbalance(design: EngineDesign, shaken: _ShakingSpectra, none: float) -> float:
    """Return the remainder of the balanced harmonics, in units of one cylinder's first."""
    turn, worst = _turn(), 0.0
    first = design.mechanism.cylinders[0]
    moment = shaken.moment - _compute_middle(design) * shaken.force
    left = {"force": shaken.force.copy(), "moment": moment.copy()}
    for balancer in design.balancers:
        left[balancer.against] += (
            np.fft.fft(_compute_balancer_force(balancer, turn - math.radians(first.phase))) / SAMPLE_COUNT
        )
    reach = max(1.0, *(abs(cylinder.place) for cylinder in design.mechanism.cylinders))
    for spectrum in left.values():
        worst = max(worst, *(abs(spectrum[k]) for k in (1, -1, 2, -2)))
    return float(worst) / (len(design.mechanism.cylinders) * reach)


def _compute_balancer_force(balancer: Balancer, angle: Real) -> Complex:
    """Compute a balancer's force at unit speed: minus its weights' acceleration, by a Fourier transform."""
    k = balancer.order
    place = balancer.forward * np.exp(1j * (k * angle + math.radians(balancer.forward_angle)))
    place = place + balancer.backward * np.exp(1j * (math.radians(balancer.backward_angle) - k * angle))
    number = np.fft.fftfreq(len(angle), 1.0 / len(angle))
    return np.asarray(np.fft.ifft(number**2 * np.fft.fft(place)))


def _check_forces(problem: EngineProblem, design: EngineDesign, course: EngineCourse, off: float) -> list[Check]:
    """Check torque, shaking force and pins of the curves, by the reactions in each cylinder's slider-crank."""
    assert problem.speed_rpm is not None, "a statement without contradictions"
    angle = np.array(course.angle)
    speed = problem.speed_rpm * RAD_PER_S
    torque, shaking, alone = _sum_reactions(problem, design, angle, speed)
    told = np.array(course.gas_torque) + np.array(course.inertia_torque)
    shake = np.array(course.shaking_x) + 1j * np.array(course.shaking_y)
    along = {
        "wrist": (alone.joints["B"]["coupler"] * -1.0, np.array(course.wrist_x) + 1j * np.array(course.wrist_y)),
        "pin": (alone.joints["A"]["crank"], np.array(course.crank_pin_x) + 1j * np.array(course.crank_pin_y)),
        "main": (alone.joints["O2"]["ground"], np.array(course.main_x) + 1j * np.array(course.main_y)),
        "side": (-alone.slides[0] * 1j, 1j * np.array(course.side)),
    }
    carried = max(float(np.abs(found).max()) for found, _ in along.values())
    size = carried * problem.scale * problem.crank
    worst = max(float(np.abs(found - claimed).max()) for found, claimed in along.values())
    return [
        check_error("torque", float(np.abs(torque - told).max()) / (size or 1.0), off),
        check_error("shaking_force", float(np.abs(shaking - shake).max()) / (carried or 1.0), off),
        check_error("pin_forces", worst / (carried or 1.0), off),
    ]


def _sum_reactions(
    problem: EngineProblem, design: EngineDesign, angle: Real, speed: float
) -> tuple[Real, Complex, Reactions]:
    """Sum torque and shaking force of the engine at angles (degrees); also return one cylinder's reactions there."""
    order = design.firing.orders[0]
    torque, shaking = np.zeros(len(angle)), np.zeros(len(angle), np.complex128)
    turning: set[int] = set()
    for number, fire in zip(order.order, order.angles, strict=True):
        cylinder = design.mechanism.cylinders[number - 1]
        # The mass of a throw counts for the first of its cylinders only.
        heavy = cylinder.throw not in turning
        turning.add(cylinder.throw)
        found = _compute_reactions(problem, design, angle - fire, speed, heavy=heavy)
        torque = torque - found.drive
        gas = _compute_gas_force(problem, angle - fire)
        # Gas pushes the cylinder head as strongly as the piston.
        shaking = shaking + (found.shaking_force + gas) * np.exp(1j * math.radians(cylinder.axis))
    return torque, shaking, _compute_reactions(problem, design, angle, speed, heavy=True)


def _compute_reactions(
    problem: EngineProblem, design: EngineDesign, after: Real, speed: float, *, heavy: bool
) -> Reactions:
    """Compute the reactions of one upright cylinder at degrees after the top dead centre of its firing."""
    scale, crank, rod = problem.scale, design.mechanism.crank, design.mechanism.rod
    made = catalogue.make_slider_crank(0j, 0j, 0.0, crank, rod, 0.0)
    bodies, pins = {}, {}
    if problem.masses is not None:
        stated = problem.masses.rod
        own = stated.mass * scale**2 * stated.cg * (rod - stated.cg)
        place = scale * (crank + stated.cg) + 0j
        bodies["coupler"] = make_body(stated.mass, place, own if stated.inertia is None else stated.inertia)
        pins["B"] = np.asarray(problem.masses.piston)
        throw = problem.masses.crank
        if throw is not None and heavy:
            bodies["crank"] = make_body(throw.mass, complex(scale * throw.cg))
    gas = _compute_gas_force(problem, after)
    loads = (JointForce("B", lambda input: np.asarray(-gas, np.complex128)),)
    machine = Machine(made, bodies, pins, loads=loads, scale=scale)
    motion = drive(made, np.radians(after), speed=np.full(len(after), speed), acceleration=0.0, order=2)
    return compute_reactions(machine, Places(made, motion, scale))


def _compute_gas_force(problem: EngineProblem, after: Real) -> Real:
    """Compute the gas force from the table itself."""
    if problem.pressure is None or problem.bore is None:
        return np.zeros(len(after))
    rows = [list(row) for row in problem.pressure.table]
    if rows[-1][0] < rows[0][0] + problem.cycle:
        rows.append([rows[0][0] + problem.cycle, rows[0][1]])
    at, value = np.array(rows).T
    value[-1] = value[0]
    within = (after - at[0]) % problem.cycle + at[0]
    area = math.pi * (0.5 * problem.bore * problem.scale) ** 2
    if problem.pressure.interpolation == "periodic_cubic":
        return np.asarray(area * CubicSpline(at, value, bc_type="periodic")(within))
    return np.asarray(area * np.interp(within, at, value))


def _check_flywheel(problem: EngineProblem, design: EngineDesign, wheel: EngineFlywheel) -> list[Check]:
    """Check the coefficient by integrating the speed of the shaft over two cycles."""
    assert problem.flywheel is not None
    count = round(4.0 * problem.cycle)
    degrees = problem.cycle * np.arange(count + 1) / count
    speed = wheel.speed * RAD_PER_S
    torque, _, _ = _sum_reactions(problem, design, degrees, speed)
    inertia = wheel.inertia + problem.flywheel.existing_inertia
    throw = None if problem.masses is None else problem.masses.crank
    if throw is not None and throw.inertia is not None:
        inertia += throw.inertia * len(design.mechanism.throws)
    # Corners of the gas pressure lie between the positions, so that both methods use a cubic through the positions.
    spline = CubicSpline(np.radians(degrees), np.append(-torque[:-1], -torque[0]), bc_type="periodic")
    fine = np.radians(problem.cycle * np.arange(2 * count + 1) / (2 * count))
    run = (
        integrate_speed(fine, spline(0.5 * (fine[1:] + fine[:-1])), spline(fine), inertia, speed)
        if inertia > 0.0
        else None
    )
    coefficient = math.inf if run is None else (run.greatest - run.least) / speed
    return [check_maximum("coefficient", coefficient, problem.flywheel.coefficient, slack=COEFFICIENT_TOLERANCE)]
