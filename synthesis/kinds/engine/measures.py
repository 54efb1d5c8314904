"""Measured properties of an arrangement: firing, harmonics, balancers, and forces at a speed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.engine.harmonics import Turning, torque_sum, turning_parts
from kinematics.engine.pistons import acceleration_harmonics, binomial_terms, two_mass_rod
from synthesis.analyses.motions import RAD_PER_S
from synthesis.kinds.engine.arrangement import Cylinders, middle_of
from synthesis.kinds.engine.balancers import balancers_of, overbalance_of
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
from synthesis.kinds.engine.firing_orders import fires, firing_of
from synthesis.kinds.engine.forces import Engine, one_cylinder, whole_engine
from synthesis.kinds.engine.problem import EngineLayout, EngineMasses, EngineProblem
from synthesis.mechanisms import flywheel
from synthesis.model.answer import Verification

Real = NDArray[np.float64]

ORDERS = (1, 2, 3, 4, 6)
"""Reported orders; the third only for the torque."""

EVERY = 4
"""Stride of the listed positions: one degree."""


NOTHING = 1e-12
"""Sums over cylinders below this, in units of one cylinder's, are rounding of zero."""


def _clear(value: float) -> float:
    return 0.0 if abs(value) < NOTHING else float(value)


def measured(
    problem: EngineProblem, layout: EngineLayout, mechanism: EngineMechanism, cylinders: Cylinders
) -> EngineDesign:
    """Measure an arrangement as a design that has not been verified yet."""
    ratio = problem.crank / problem.rod_length
    series = acceleration_harmonics(ratio, max(ORDERS), two_term=problem.method == "two_term")
    firing = firing_of(problem, cylinders)
    given = problem.masses is not None or problem.pressure is not None
    forces, course, wheel = None, None, None
    if given:
        assert problem.speed_rpm is not None, "a statement without contradictions"
        speed = problem.speed_rpm * RAD_PER_S
        engine = whole_engine(problem, cylinders, fires(firing), speed)
        forces = _forces(problem, layout, engine, speed)
        course = _course(problem, engine, speed)
        wheel = _flywheel(problem, cylinders, fires(firing))
    single = problem.cylinders == 1 and problem.masses is not None
    return EngineDesign(
        mechanism=mechanism,
        verification=Verification.of([]),
        metrics=_metrics(problem, cylinders, firing.unevenness, forces),
        firing=firing,
        harmonics=[_harmonic(problem, cylinders, order, series) for order in ORDERS],
        balancers=balancers_of(problem, cylinders, series),
        overbalance=overbalance_of(problem, (problem.speed_rpm or 0.0) * RAD_PER_S) if single else None,
        flywheel=wheel,
        course=course,
    )


def _metrics(problem: EngineProblem, cylinders: Cylinders, uneven: float, forces: EngineForces | None) -> EngineMetrics:
    axis, top = np.radians(cylinders.axis), np.radians(cylinders.top)
    # Moments refer to the middle of the shaft.
    places = cylinders.place - middle_of(cylinders.place)
    return EngineMetrics(
        unevenness=uneven,
        # Counterweights on the shaft cancel the forward part, so only the backward part counts.
        primary_force=_clear(float(np.abs(turning_parts(1, axis, top).backward))),
        primary_moment=_clear(float(np.abs(turning_parts(1, axis, top, places).backward))),
        secondary_force=_clear(float(turning_parts(2, axis, top).major)),
        secondary_moment=_clear(float(turning_parts(2, axis, top, places).major)),
        torque=_clear(max(float(np.abs(torque_sum(k, top))) for k in (1, 2, 3))),
        binomial_terms=binomial_terms(problem.crank / problem.rod_length, 3),
        forces=forces,
        masses=None if problem.masses is None else _lumped(problem, problem.masses),
    )


def _lumped(problem: EngineProblem, masses: EngineMasses) -> LumpedMasses:
    """Compute Norton's models: two masses at the pins, two with one at the wrist pin, one at the crank pin."""
    scale, stated, throw = problem.scale, masses.rod, masses.crank
    crank, rod = scale * problem.crank, scale * problem.rod_length
    # Distance from the rod's centre of gravity to the wrist pin.
    to_wrist = rod - scale * stated.cg
    two = two_mass_rod(rod, stated.mass, scale * stated.cg, stated.inertia)
    # The masses at the pins imply an inertia of m a b about the centre of gravity.
    own = stated.mass * scale * stated.cg * to_wrist
    found: dict[str, float] = {"rod_crank_pin": two.crank_pin, "rod_wrist_pin": two.wrist_pin, "rod_inertia": own}
    if stated.inertia and to_wrist > 0.0 and stated.mass > 0.0:
        # The centre of percussion for the wrist pin as pivot lies this far from the centre of gravity.
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


def _harmonic(problem: EngineProblem, cylinders: Cylinders, order: int, series: dict[int, float]) -> EngineHarmonic:
    axis, top = np.radians(cylinders.axis), np.radians(cylinders.top)
    about = 0.0 if problem.moment_about == "first_throw" else middle_of(cylinders.place)
    place = cylinders.place - about
    waves, moments = torque_sum(order, top), torque_sum(order, top, place)
    return EngineHarmonic(
        order=order,
        coefficient=series.get(order),
        force=_told(turning_parts(order, axis, top)),
        moment=_told(turning_parts(order, axis, top, place)),
        torque=_clear(float(np.abs(waves))),
        cos=_clear(float(waves.real)),
        sin=_clear(float(-waves.imag)),
        place_cos=_clear(float(moments.real)),
        place_sin=_clear(float(-moments.imag)),
    )


def _told(parts: Turning) -> VectorHarmonic:
    return VectorHarmonic(
        forward=_clear(float(np.abs(parts.forward))),
        backward=_clear(float(np.abs(parts.backward))),
        major=_clear(float(parts.major)),
        minor=_clear(float(parts.minor)),
    )


def _forces(problem: EngineProblem, layout: EngineLayout, engine: Engine, speed: float) -> EngineForces:
    torque = engine.gas + engine.inertia
    one = one_cylinder(problem, engine.angle, speed)
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


def _course(problem: EngineProblem, engine: Engine, speed: float) -> EngineCourse:
    angle = engine.angle[::EVERY]
    one = one_cylinder(problem, angle, speed)
    return EngineCourse(
        angle=angle.tolist(),
        gas_torque=engine.gas[::EVERY].tolist(),
        inertia_torque=engine.inertia[::EVERY].tolist(),
        shaking_x=engine.shaking.real[::EVERY].tolist(),
        shaking_y=engine.shaking.imag[::EVERY].tolist(),
        side=one.side.tolist(),
        wrist_x=one.wrist.real.tolist(),
        wrist_y=one.wrist.imag.tolist(),
        crank_pin_x=one.pin.real.tolist(),
        crank_pin_y=one.pin.imag.tolist(),
        main_x=one.main.real.tolist(),
        main_y=one.main.imag.tolist(),
    )


def _flywheel(problem: EngineProblem, cylinders: Cylinders, fire: Real) -> EngineFlywheel | None:
    wanted = problem.flywheel
    if wanted is None:
        return None
    speed = wanted.speed_rpm * RAD_PER_S
    engine = whole_engine(problem, cylinders, fire, speed)
    # The engine's torque drives the shaft, so a machine takes its negative.
    found = flywheel.table_fluctuation(np.radians(engine.angle), -(engine.gas + engine.inertia), smooth=True)
    exact = flywheel.exact_inertia(found, speed, wanted.coefficient)
    whole = flywheel.first_order_inertia(found.energy, speed, wanted.coefficient)
    own = _existing_inertia(problem, len(np.unique(cylinders.throw)))
    # A heavy crankshaft may already have more inertia than required.
    present = max(exact, own)
    return EngineFlywheel(
        speed=wanted.speed_rpm,
        energy=found.energy,
        inertia=max(0.0, exact - own),
        first_order_inertia=max(0.0, whole - own),
        coefficient=flywheel.exact_coefficient(found, present, speed) if present > 0.0 else 0.0,
    )


def _existing_inertia(problem: EngineProblem, throws: int) -> float:
    """Sum the shaft's inertia without a flywheel: the given one, and its throws."""
    throw = None if problem.masses is None else problem.masses.crank
    stated = 0.0 if problem.flywheel is None else problem.flywheel.existing_inertia
    return stated + (0.0 if throw is None or throw.inertia is None else throws * throw.inertia)
