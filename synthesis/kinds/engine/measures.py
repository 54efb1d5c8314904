"""Measured properties of an arrangement: firing, harmonics, balancers, and forces at a speed."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Real
from kinematics.engine.harmonics import TurningParts, compute_turning_parts, sum_torque
from kinematics.engine.pistons import build_two_mass_rod, compute_acceleration_harmonics, compute_binomial_terms
from synthesis.analyses.input_motion import RAD_PER_S
from synthesis.kinds.engine.arrangement import Cylinders, compute_middle
from synthesis.kinds.engine.balancers import find_balancers, find_overbalance
from synthesis.kinds.engine.design import (
    EngineCourse,
    EngineDesign,
    EngineFlywheel,
    EngineForces,
    EngineHarmonic,
    EngineMechanism,
    EngineMetrics,
    LumpedMasses,
    VectorHarmonic,
)
from synthesis.kinds.engine.firing_orders import find_firing, list_firing_angles
from synthesis.kinds.engine.forces import Engine, compute_cylinder, compute_engine
from synthesis.kinds.engine.problem import EngineLayout, EngineMasses, EngineProblem
from synthesis.mechanisms import flywheel
from synthesis.model.answer import Verification

REPORTED_ORDERS = (1, 2, 3, 4, 6)
"""Reported orders of harmonics; the third order only for the torque."""

CURVE_STRIDE = 4
"""Stride of the reported positions of curves: one degree."""


ZERO_TOLERANCE = 1e-12
"""Sum over cylinders, in units of one cylinder's value, below which it is attributed to rounding."""


def _clear_rounding(value: float) -> float:
    return 0.0 if abs(value) < ZERO_TOLERANCE else float(value)


def measure_engine(
    problem: EngineProblem, layout: EngineLayout, mechanism: EngineMechanism, cylinders: Cylinders
) -> EngineDesign:
    """Measure an arrangement as a design that has not been verified yet."""
    ratio = problem.crank / problem.rod_length
    series = compute_acceleration_harmonics(ratio, max(REPORTED_ORDERS), two_term=problem.method == "two_term")
    firing = find_firing(problem, cylinders)
    given = problem.masses is not None or problem.pressure is not None
    forces, course, wheel = None, None, None
    if given:
        assert problem.speed_rpm is not None, "a statement without contradictions"
        speed = problem.speed_rpm * RAD_PER_S
        engine = compute_engine(problem, cylinders, list_firing_angles(firing), speed)
        forces = _compute_forces(problem, layout, engine, speed)
        course = _build_curves(problem, engine, speed)
        wheel = _size_flywheel(problem, cylinders, list_firing_angles(firing))
    single = problem.cylinders == 1 and problem.masses is not None
    return EngineDesign(
        mechanism=mechanism,
        verification=Verification.from_checks([]),
        metrics=_compute_metrics(problem, cylinders, firing.unevenness, forces),
        firing=firing,
        harmonics=[_compute_harmonic(problem, cylinders, order, series) for order in REPORTED_ORDERS],
        balancers=find_balancers(problem, cylinders, series),
        overbalance=find_overbalance(problem, (problem.speed_rpm or 0.0) * RAD_PER_S) if single else None,
        flywheel=wheel,
        course=course,
    )


def _compute_metrics(
    problem: EngineProblem, cylinders: Cylinders, uneven: float, forces: EngineForces | None
) -> EngineMetrics:
    axis, top = np.radians(cylinders.axis), np.radians(cylinders.top)
    # Moments refer to the middle of the shaft.
    places = cylinders.place - compute_middle(cylinders.place)
    return EngineMetrics(
        unevenness=uneven,
        # Counterweights on the shaft cancel the forward part, so only the backward part counts.
        primary_force=_clear_rounding(float(np.abs(compute_turning_parts(1, axis, top).backward))),
        primary_moment=_clear_rounding(float(np.abs(compute_turning_parts(1, axis, top, places).backward))),
        secondary_force=_clear_rounding(float(compute_turning_parts(2, axis, top).major)),
        secondary_moment=_clear_rounding(float(compute_turning_parts(2, axis, top, places).major)),
        torque=_clear_rounding(max(float(np.abs(sum_torque(k, top))) for k in (1, 2, 3))),
        binomial_terms=compute_binomial_terms(problem.crank / problem.rod_length, 3),
        forces=forces,
        masses=None if problem.masses is None else _lump_masses(problem, problem.masses),
    )


def _lump_masses(problem: EngineProblem, masses: EngineMasses) -> LumpedMasses:
    """Compute Norton's models of the rod (two masses at the pins, or two with one at the wrist pin) and the throw."""
    scale, stated, throw = problem.scale, masses.rod, masses.crank
    crank, rod = scale * problem.crank, scale * problem.rod_length
    # Distance from the rod's centre of gravity to the wrist pin.
    to_wrist = rod - scale * stated.cg
    two = build_two_mass_rod(rod, stated.mass, scale * stated.cg, stated.inertia)
    # The masses at the pins imply an inertia of m a b about the centre of gravity.
    own = stated.mass * scale * stated.cg * to_wrist
    found: dict[str, float] = {"rod_crank_pin": two.crank_pin, "rod_wrist_pin": two.wrist_pin, "rod_inertia": own}
    if stated.inertia and to_wrist > 0.0 and stated.mass > 0.0:
        # Distance from the centre of gravity to the centre of percussion with the wrist pin as pivot.
        distance = stated.inertia / (stated.mass * to_wrist)
        found |= {
            "rod_inertia_error": 100.0 * (own / stated.inertia - 1.0),
            "percussion_distance": distance / scale,
            "percussion_mass": stated.mass * to_wrist / (distance + to_wrist),
            "percussion_wrist_pin": stated.mass * distance / (distance + to_wrist),
        }
    if throw is not None:
        at_pin = throw.mass * scale * throw.cg / crank
        found |= {"throw_crank_pin": at_pin, "throw_inertia": at_pin * crank**2}
        if throw.inertia:
            found["throw_inertia_error"] = 100.0 * (at_pin * crank**2 / throw.inertia - 1.0)
    return LumpedMasses(**found)


def _compute_harmonic(
    problem: EngineProblem, cylinders: Cylinders, order: int, series: dict[int, float]
) -> EngineHarmonic:
    axis, top = np.radians(cylinders.axis), np.radians(cylinders.top)
    about = 0.0 if problem.moment_about == "first_throw" else compute_middle(cylinders.place)
    place = cylinders.place - about
    waves, moments = sum_torque(order, top), sum_torque(order, top, place)
    return EngineHarmonic(
        order=order,
        coefficient=series.get(order),
        force=_describe_harmonic(compute_turning_parts(order, axis, top)),
        moment=_describe_harmonic(compute_turning_parts(order, axis, top, place)),
        torque=_clear_rounding(float(np.abs(waves))),
        cos=_clear_rounding(float(waves.real)),
        sin=_clear_rounding(float(-waves.imag)),
        place_cos=_clear_rounding(float(moments.real)),
        place_sin=_clear_rounding(float(-moments.imag)),
    )


def _describe_harmonic(parts: TurningParts) -> VectorHarmonic:
    return VectorHarmonic(
        forward=_clear_rounding(float(np.abs(parts.forward))),
        backward=_clear_rounding(float(np.abs(parts.backward))),
        major=_clear_rounding(float(parts.major)),
        minor=_clear_rounding(float(parts.minor)),
    )


def _compute_forces(problem: EngineProblem, layout: EngineLayout, engine: Engine, speed: float) -> EngineForces:
    torque = engine.gas + engine.inertia
    one = compute_cylinder(problem, engine.angle, speed)
    spacing = None if layout.spacing is None else problem.scale * layout.spacing
    return EngineForces(
        shaking_force=float(np.abs(engine.shaking).max()),
        shaking_moment=None if spacing is None else float(np.abs(engine.moment).max()) * spacing,
        # The last sample repeats the first.
        mean_torque=float(torque[:-1].mean()),
        max_torque=float(torque.max()),
        min_torque=float(torque.min()),
        side_force=float(np.abs(one.side).max()),
        wrist_pin_force=float(np.abs(one.wrist).max()),
        crank_pin_force=float(np.abs(one.pin).max()),
        two_mass_torque_difference=float(np.abs(engine.two_mass).max()),
    )


def _build_curves(problem: EngineProblem, engine: Engine, speed: float) -> EngineCourse:
    angle = engine.angle[::CURVE_STRIDE]
    one = compute_cylinder(problem, angle, speed)
    return EngineCourse(
        angle=angle.tolist(),
        gas_torque=engine.gas[::CURVE_STRIDE].tolist(),
        inertia_torque=engine.inertia[::CURVE_STRIDE].tolist(),
        shaking_x=engine.shaking.real[::CURVE_STRIDE].tolist(),
        shaking_y=engine.shaking.imag[::CURVE_STRIDE].tolist(),
        side=one.side.tolist(),
        wrist_x=one.wrist.real.tolist(),
        wrist_y=one.wrist.imag.tolist(),
        crank_pin_x=one.pin.real.tolist(),
        crank_pin_y=one.pin.imag.tolist(),
        main_x=one.main.real.tolist(),
        main_y=one.main.imag.tolist(),
    )


def _size_flywheel(problem: EngineProblem, cylinders: Cylinders, fire: Real) -> EngineFlywheel | None:
    wanted = problem.flywheel
    if wanted is None:
        return None
    speed = wanted.speed_rpm * RAD_PER_S
    engine = compute_engine(problem, cylinders, fire, speed)
    # The engine's torque drives the shaft, so a machine takes its negative.
    found = flywheel.compute_table_fluctuation(np.radians(engine.angle), -(engine.gas + engine.inertia), smooth=True)
    exact = flywheel.find_exact_inertia(found, speed, wanted.coefficient)
    whole = flywheel.compute_first_order_inertia(found.energy, speed, wanted.coefficient)
    own = _sum_existing_inertia(problem, len(np.unique(cylinders.throw)))
    # A heavy crankshaft may already have more inertia than required.
    present = max(exact, own)
    return EngineFlywheel(
        speed=wanted.speed_rpm,
        energy=found.energy,
        inertia=max(0.0, exact - own),
        first_order_inertia=max(0.0, whole - own),
        coefficient=flywheel.compute_exact_coefficient(found, present, speed) if present > 0.0 else 0.0,
    )


def _sum_existing_inertia(problem: EngineProblem, throws: int) -> float:
    """Return the shaft's moment of inertia without a flywheel: the given one plus that of the throws."""
    throw = None if problem.masses is None else problem.masses.crank
    stated = 0.0 if problem.flywheel is None else problem.flywheel.existing_inertia
    return stated + (0.0 if throw is None or throw.inertia is None else throws * throw.inertia)
