"""Flywheels: the torque over a cycle, the required inertia, and the lightest wheels that have it."""

from __future__ import annotations

from functools import partial
from typing import Literal

from kinematics.message import compose, join_messages
from synthesis.analyses.input_motion import RAD_PER_S
from synthesis.kinds.flywheel.course import TorqueCycle, UnknownTorque, compute_torque_cycle
from synthesis.kinds.flywheel.design import Fluctuation, FlywheelDesign, FlywheelMechanism, FlywheelResult
from synthesis.kinds.flywheel.problem import FlywheelProblem
from synthesis.kinds.flywheel.sizing import Bounds, find_lightest
from synthesis.kinds.flywheel.verification import verify_flywheel
from synthesis.mechanisms import flywheel
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.ranking import select_best, sort_designs
from synthesis.results.remarks import append_remark, write_name, write_quantity


def solve_flywheel(problem: FlywheelProblem, progress: Progress) -> FlywheelResult:
    """Solve a problem of flywheels.

    Returns
    -------
    FlywheelResult
        Complete whenever the torque is known, since each form has one lightest wheel. There are no designs if no
        flywheel is needed or the limits permit none; ``summary`` gives the reason.
    """
    sifting = CandidateLog[FlywheelDesign](problem)
    progress(0.0, compose("flywheel-computing-torque"))
    try:
        course = compute_torque_cycle(problem)
    except UnknownTorque as error:
        text = compose("flywheel-torque-unknown", reason=str(error))
        return FlywheelResult(designs=[], search=sifting.build_search("exact"), summary=text, fluctuation=None)
    found = flywheel.compute_table_fluctuation(course.angle, course.demand, smooth=course.smooth)
    progress(0.3, compose("flywheel-sizing"))
    fluctuation = _compute_fluctuation(problem, course, found)
    remarks = []
    wheels = []
    for form in problem.forms if fluctuation.inertia > 0.0 else ():
        wheel = _size_wheel(problem, found, fluctuation.inertia, form)
        if wheel is None:
            remarks.append(compose("flywheel-form-does-not-fit", form=form))
        else:
            wheels.append(wheel)
    progress(0.5, compose("flywheel-integrating-speed"))
    sifting.verify_candidates(wheels, partial(verify_flywheel, problem))
    progress(1.0, compose("results-verified"))
    return FlywheelResult(
        designs=sifting.select_designs(lambda designs: sort_designs(designs, _get_mass)),
        search=sifting.build_search("exact", complete=not sifting.rejected),
        summary=join_messages([_write_summary(problem, fluctuation, sifting), *remarks]),
        fluctuation=fluctuation,
    )


def _compute_fluctuation(problem: FlywheelProblem, course: TorqueCycle, found: flywheel.Fluctuation) -> Fluctuation:
    """Compute the inertias that the torque requires in addition to the shaft's own."""
    speed, present = problem.speed_rpm * RAD_PER_S, problem.existing_inertia
    whole = flywheel.compute_first_order_inertia(found.energy, speed, problem.coefficient)
    exact = flywheel.find_exact_inertia(found, speed, problem.coefficient)
    # Report torques with the sign of the requested side, demand or supply.
    sign = 1.0 if problem.torque is None or problem.torque.side == "demand" else -1.0
    listed = flywheel.list_pulses(found, float(course.angle[-1] - course.angle[0]))
    return Fluctuation.model_validate(
        {
            "mean_torque": sign * found.mean,
            "energy": found.energy,
            "inertia": max(0.0, exact - present),
            "first_order_inertia": max(0.0, whole - present),
            "first_order_coefficient": flywheel.compute_exact_coefficient(found, max(whole, present), speed),
            "pulses": [pulse | {"area": sign * pulse["area"]} for pulse in listed],
        }
    )


def _size_wheel(
    problem: FlywheelProblem, found: flywheel.Fluctuation, inertia: float, form: Literal["disc", "rim"]
) -> FlywheelMechanism | None:
    """Size the lightest wheel of a form; None if the limits permit none."""
    scale, limits = problem.scale, problem.limits
    ends = flywheel.find_extreme_speeds(found, inertia + problem.existing_inertia, problem.speed_rpm * RAD_PER_S)
    assert ends is not None, "the inertia was found by this speed"
    radii = [] if limits.radius is None else [scale * limits.radius.max]
    # The rim speed limit applies at the maximum speed of the cycle.
    radii += [] if limits.rim_speed is None else [limits.rim_speed.max / ends[1]]
    thickness = limits.thickness
    bounds = Bounds(
        radius=min(radii, default=None),
        thinnest=None if thickness is None or thickness.min is None else scale * thickness.min,
        thickest=None if thickness is None or thickness.max is None else scale * thickness.max,
        wall=None if limits.wall is None else scale * limits.wall.min,
        flattest=None if limits.radius_to_thickness is None else limits.radius_to_thickness.max,
    )
    wheel = find_lightest(inertia, problem.density, bounds, rim=form == "rim")
    if wheel is None:
        return None
    return FlywheelMechanism(
        form=form,
        radius=wheel.radius / scale,
        inner_radius=wheel.inner / scale,
        thickness=wheel.thickness / scale,
        density=problem.density,
    )


def _get_mass(design: FlywheelDesign) -> float:
    return design.metrics.mass


def _write_summary(problem: FlywheelProblem, fluctuation: Fluctuation, sifting: CandidateLog[FlywheelDesign]) -> str:
    joule, kilogram, inertia = ("J", "kg", "kg·m²") if problem.units == "si" else ("", "", "")
    text = [compose("flywheel-energy", energy=write_quantity(f"{fluctuation.energy:.6g}", joule))]
    if fluctuation.mean_torque < 0.0:
        text.append(compose("flywheel-mean-torque-negative"))
    if fluctuation.inertia == 0.0:
        text.append(compose("flywheel-not-needed"))
    elif sifting.passed:
        best = select_best(sifting.passed, _get_mass)
        text.append(
            compose(
                "flywheel-lightest-wheel",
                form=best.mechanism.form,
                mass=write_quantity(f"{best.metrics.mass:.6g}", kilogram),
                inertia=write_quantity(f"{best.metrics.inertia:.6g}", inertia),
                limits=join_messages(map(write_name, best.metrics.at_limits), ", "),
            )
        )
    return append_remark(join_messages(text), sifting.describe_reasons())
