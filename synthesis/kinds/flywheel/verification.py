"""Verification of flywheels: the speed of the shaft is integrated over two cycles with the finished wheel.

The equation I ω dω/dθ = T̄ − T(θ) and the time are integrated by the Runge-Kutta method on a grid that includes all
rows of the table. The initial speed is chosen so that the mean over time is the requested one. Mass and inertia are
sums over thin rings. The wheel is also compared with a grid of all wheels that the limits permit: none may be lighter.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicSpline

from kinematics.arrays import Real
from synthesis.analyses.input_motion import RAD_PER_S
from synthesis.kinds.flywheel.course import UnknownTorque, compute_machine_torque
from synthesis.kinds.flywheel.design import FlywheelDesign, FlywheelMechanism, FlywheelMetrics, Limit, SpeedCurve
from synthesis.kinds.flywheel.problem import FlywheelProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import LENGTH, SPEED
from synthesis.verification.checks import check_error, check_maximum, check_minimum
from synthesis.verification.shaft_speed import CYCLE_COUNT, SpeedHistory, integrate_speed

STEPS_PER_TURN = 2048
"""Equal steps of a turn, in addition to the rows of a table."""

COEFFICIENT_TOLERANCE = 1e-6
"""Permitted relative excess of the integrated coefficient of fluctuation over the requested one."""

REPEAT_TOLERANCE = 1e-7
"""Permitted relative difference of the speed after a cycle, due to the method's error at corners of the torque."""

RING_COUNT = 64
"""Number of rings in the sums, each with three Gauss points, which are exact for cubic integrands."""

SAMPLE_COUNT = 400
"""Number of inner and of outer radii of the wheels with which the answer is compared."""

MASS_TOLERANCE = 1e-6
"""Share by which a compared wheel may be lighter, in proportion to the tolerance of the coefficient."""

ACTIVE_TOLERANCE = 1e-9
"""Share of a limit within which the limit counts as active."""

CURVE_POINT_COUNT = 361
"""Number of positions of the speed curve in an answer."""


def verify_flywheel(problem: FlywheelProblem, wheel: FlywheelMechanism) -> FlywheelDesign | None:
    """Integrate the speed of a shaft with a wheel and compare the wheel with its limits and with others.

    Parameters
    ----------
    problem : FlywheelProblem
        The request.
    wheel : FlywheelMechanism
        Dimensions only.

    Returns
    -------
    FlywheelDesign or None
        None if the shaft would stop, or the energy balance does not determine the torque of a linkage.
    """
    mass, inertia = _sum_rings(problem, wheel)
    try:
        angle, middle, last = _sample_torque(problem)
    except UnknownTorque:
        return None
    mean_speed = problem.speed_rpm * RAD_PER_S
    run = integrate_speed(angle, middle, last, inertia + problem.existing_inertia, mean_speed)
    if run is None:
        return None
    coefficient = (run.greatest - run.least) / mean_speed
    rim = run.greatest * wheel.radius * problem.scale
    # Samples per cycle.
    count = len(run.speed) // CYCLE_COUNT
    checks = [
        check_maximum("coefficient", coefficient, problem.coefficient, slack=COEFFICIENT_TOLERANCE),
        check_error("speed_repeats", float(abs(run.speed[count] - run.speed[0])) / mean_speed, REPEAT_TOLERANCE),
        *_check_limits(problem, wheel, rim),
        check_minimum(
            "lightest", _search_lighter(problem, inertia, run.greatest, wheel.form) / mass, 1.0, slack=MASS_TOLERANCE
        ),
    ]
    metrics = FlywheelMetrics(
        mass=mass,
        inertia=inertia,
        coefficient=coefficient,
        least_speed=run.least / RAD_PER_S,
        greatest_speed=run.greatest / RAD_PER_S,
        rim_speed=rim,
        at_limits=_list_active_limits(problem, wheel, rim),
    )
    return FlywheelDesign(
        mechanism=wheel,
        verification=Verification.from_checks(checks),
        metrics=metrics,
        course=_build_curve(problem, run),
    )


def _sum_rings(problem: FlywheelProblem, wheel: FlywheelMechanism) -> tuple[float, float]:
    """Compute mass and moment of inertia, summed over rings."""
    scale = problem.scale
    nodes, weights = np.polynomial.legendre.leggauss(3)
    edges = scale * np.linspace(wheel.inner_radius, wheel.radius, RING_COUNT + 1)
    half = 0.5 * np.diff(edges)[:, None]
    # Gauss nodes of every ring.
    radius = 0.5 * (edges[1:] + edges[:-1])[:, None] + half * nodes
    ring = 2.0 * math.pi * wheel.density * scale * wheel.thickness * radius * half * weights
    return float(ring.sum()), float((ring * radius**2).sum())


def _sample_torque(problem: FlywheelProblem) -> tuple[Real, Real, Real]:
    """Return angles of a cycle, the demand at the middle of each step, and at all step ends."""
    if problem.torque is not None:
        rows, turns = np.array(problem.torque.table, np.float64), problem.torque.turns
        start, period = math.radians(rows[0, 0]), 2.0 * math.pi * turns
        own, smooth = np.radians(rows[:, 0]), problem.torque.interpolation == "periodic_cubic"
        values = rows[:, 1] if problem.torque.side == "demand" else -rows[:, 1]
    else:
        # Use positions halfway between the solver's, and the energy balance instead of the reactions.
        course = compute_machine_torque(problem, "virtual_work_drive", 0.5)
        own, values, smooth = course.angle, course.demand, True
        start, period = float(own[0]), float(own[-1] - own[0])
        turns = round(period / (2.0 * math.pi))
    own, kept = np.unique(np.append(own, start + period), return_index=True)
    values = np.append(values, values[0])[kept]
    values[-1] = values[0]
    angle = np.union1d(own, start + period * np.arange(STEPS_PER_TURN * turns + 1) / (STEPS_PER_TURN * turns))
    angle = angle[(angle >= start) & (angle <= own[-1])]
    middle = 0.5 * (angle[1:] + angle[:-1])
    if smooth:
        spline = CubicSpline(own, values, bc_type="periodic")
        return angle, np.asarray(spline(middle)), np.asarray(spline(angle))
    return angle, np.interp(middle, own, values), np.interp(angle, own, values)


def _check_limits(problem: FlywheelProblem, wheel: FlywheelMechanism, rim: float) -> list[Check]:
    limits, checks = problem.limits, []
    if limits.radius is not None:
        checks.append(check_maximum("radius", wheel.radius, limits.radius.max, LENGTH))
    if limits.thickness is not None and limits.thickness.min is not None:
        checks.append(check_minimum("min_thickness", wheel.thickness, limits.thickness.min, LENGTH))
    if limits.thickness is not None and limits.thickness.max is not None:
        checks.append(check_maximum("max_thickness", wheel.thickness, limits.thickness.max, LENGTH))
    if limits.wall is not None and wheel.form == "rim":
        checks.append(check_minimum("wall", wheel.radius - wheel.inner_radius, limits.wall.min, LENGTH))
    if limits.rim_speed is not None:
        checks.append(check_maximum("rim_speed", rim, limits.rim_speed.max, SPEED, slack=COEFFICIENT_TOLERANCE))
    if limits.radius_to_thickness is not None:
        checks.append(
            check_maximum("radius_to_thickness", wheel.radius / wheel.thickness, limits.radius_to_thickness.max)
        )
    return checks


def _list_active_limits(problem: FlywheelProblem, wheel: FlywheelMechanism, rim: float) -> list[Limit]:
    """List the active limits of a wheel."""
    names: dict[str, Limit] = {
        "radius": "radius",
        "min_thickness": "min_thickness",
        "max_thickness": "max_thickness",
        "wall": "wall",
        "rim_speed": "rim_speed",
        "radius_to_thickness": "radius_to_thickness",
    }
    return [
        names[check.name]
        for check in _check_limits(problem, wheel, rim)
        if check.value is not None
        and check.limit is not None
        and abs(check.value - check.limit)
        <= (COEFFICIENT_TOLERANCE if check.name == "rim_speed" else ACTIVE_TOLERANCE) * check.limit
    ]


def _search_lighter(problem: FlywheelProblem, inertia: float, greatest: float, form: str) -> float:
    """Return the minimum mass of a grid of wheels with this inertia within the limits; infinite if there is none."""
    scale, limits = problem.scale, problem.limits
    c = 2.0 * inertia / (math.pi * problem.density)
    widest = [] if limits.radius is None else [scale * limits.radius.max]
    widest += [] if limits.rim_speed is None else [limits.rim_speed.max / greatest]
    # Without a radius limit the grid extends far beyond a wheel as thick as it is wide.
    outer = min(widest, default=1e3 * c**0.2) * np.geomspace(1e-3, 1.0, SAMPLE_COUNT)[:, None]
    inner = outer * (np.linspace(0.0, 1.0, SAMPLE_COUNT, endpoint=False) if form == "rim" else np.zeros(1))
    ring = outer**4 - inner**4
    with np.errstate(divide="ignore", invalid="ignore"):
        thickness = c / ring
        allowed = ring > 0.0
        if limits.thickness is not None and limits.thickness.min is not None:
            allowed &= thickness >= scale * limits.thickness.min
        if limits.thickness is not None and limits.thickness.max is not None:
            allowed &= thickness <= scale * limits.thickness.max
        if limits.wall is not None and form == "rim":
            allowed &= outer - inner >= scale * limits.wall.min
        if limits.radius_to_thickness is not None:
            allowed &= outer <= limits.radius_to_thickness.max * thickness
        mass = math.pi * problem.density * thickness * (outer**2 - inner**2)
    return float(mass[allowed].min()) if allowed.any() else math.inf


def _build_curve(problem: FlywheelProblem, run: SpeedHistory) -> SpeedCurve:
    """Build the speed curve of a cycle at equal steps."""
    at = run.angle[0] + run.cycle * np.arange(CURVE_POINT_COUNT) / (CURVE_POINT_COUNT - 1)
    sign = 1.0 if problem.torque is None or problem.torque.side == "demand" else -1.0
    return SpeedCurve(
        angle=np.degrees(at).tolist(),
        torque=(sign * np.interp(at, run.angle, run.demand)).tolist(),
        speed=(np.interp(at, run.angle, run.speed) / RAD_PER_S).tolist(),
    )
