"""Forces of a linkage over its motion, as plain lists in the form of :class:`DynamicsAnswer`."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.dynamics.balance import Balance, compute_balance
from kinematics.dynamics.force_index import compute_joint_force_index
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import MAX_CONDITION, Reactions, compute_reactions
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.message import compose
from synthesis.analyses.linkages.cyclic_statistics import (
    compute_mean,
    compute_rms,
    describe_flywheel,
    describe_harmonics,
    is_closed,
)
from synthesis.analyses.linkages.peaks import Peak, Samples, find_peaks
from synthesis.mechanisms.courses import find_period_turns
from synthesis.mechanisms.machine import build_machine, find_first_fixed_pivot
from synthesis.model.dynamics.request import DynamicsBlock, LengthUnit, LoadedLinkage
from synthesis.model.json_object import JsonObject

HIGH_INDEX = 2.0
"""Joint force index above which the client is warned (Norton, Sec. 11.12)."""

DETERMINED_STATUSES = ("ok", "stick")
"""Statuses of a position at which the forces are known; with ``stick``, only the friction is undetermined."""

AGREEMENT = 1e-6
"""Maximum difference between the two computations of a force, as a share of its peak, with which it counts as known.
They agree to 1e-9 or better if no joint is near a dead centre."""

MIN_LOAD_SHARE = 1e-6
"""Share of the largest term of a balance: a smaller sum is not used as the reference of an error."""


class DrivenMachine(NamedTuple):
    """Results of a machine driven to inputs: reactions, balances, and a mask of positions that can be assembled."""

    valid: NDArray[np.bool_]
    smooth: NDArray[np.bool_]
    speed: Real
    reactions: Reactions
    balance: Balance
    dissipated: Real
    force_index: Real | None


def analyze_forces(
    mechanism: Mechanism, block: DynamicsBlock, unit: LengthUnit, at: Real, speed: Real, acceleration: float
) -> JsonObject:
    """Build the answer at inputs ``at`` (degrees, or lengths along the input slide), with speeds and acceleration."""
    machine, warnings = build_machine(block, mechanism, unit)
    indexed = block.is_reported("joint_force_index")
    course = _drive_machine(machine, at, speed, acceleration, indexed, block.minimum_norm)
    found, check = course.reactions, course.balance
    closed = is_closed(mechanism, at, found.drive, find_period_turns(block, mechanism))
    drive_peaks, extremes = _find_extremes(machine, course, at, acceleration, closed, block.minimum_norm)
    reported = _list_reported_joints(machine)
    power = found.drive * course.speed
    answer: JsonObject = {"units": block.units, "length_unit": unit}
    if block.is_reported("drive"):
        answer["drive"] = found.drive.tolist()
        answer["virtual_work_drive"] = np.where(found.solved, check.drive, np.nan).tolist()
    if block.is_reported("joint_forces"):
        answer |= _list_joint_forces(machine, course, reported, block.friction is not None)
    if block.is_reported("shaking"):
        about = find_first_fixed_pivot(mechanism) if block.moment_about is None else complex(*block.moment_about)
        answer["shaking"] = {
            "force": _list_series(found.shaking_force),
            "moment": found.shaking_moment.tolist(),
            "about": (about.real, about.imag),
        }
    answer |= {
        "extremes": {
            "drive": drive_peaks | {"mean": compute_mean(found.drive, closed), "rms": compute_rms(found.drive, closed)},
            "joints": {joint: extremes[f"joint {joint}"] for joint in reported},
            "shaking_force": extremes["shaking force"],
            "shaking_moment": extremes["shaking moment"],
        },
        "power": {"peak": extremes["power"]["max"], "mean": compute_mean(power, closed)},
    }
    if block.is_reported("flywheel"):
        answer["flywheel"] = describe_flywheel(found.drive, at, float(speed[0]), closed, block.flywheel)
    if block.is_reported("harmonics"):
        answer["harmonics"] = describe_harmonics(found, at, closed)
    if course.force_index is not None:
        answer["joint_force_index"] = course.force_index.tolist()
        answer["max_joint_force_index"], index_warnings = _find_largest_index(course, extremes)
        warnings = warnings + index_warnings
    return answer | {"status": _list_status(course), "checks": _compare_routes(found, check), "warnings": warnings}


class UndeterminedForcesError(ValueError):
    """Raised if forces are not determined over a whole motion; the message gives the reason and the input."""


def find_force_peaks(
    mechanism: Mechanism, block: LoadedLinkage, unit: LengthUnit, at: Real, speed: float
) -> tuple[bool, dict[str, Peak]]:
    """Find the peaks of all forces at constant speed.

    Return whether the motion is closed, and the peaks by the names of :func:`_list_quantities`.

    Raises
    ------
    UndeterminedForcesError
        If the forces are undetermined at a position of the motion, or if their two computations disagree.
    """
    machine, _ = build_machine(block, mechanism, unit)
    course = _drive_machine(machine, at, np.full(len(at), speed), 0.0, bool(block.loads))
    for status, position in zip(_list_status(course), at, strict=True):
        if status not in DETERMINED_STATUSES:
            raise UndeterminedForcesError(
                compose("analyses-status-at-position", status=status, position=f"{position:.4g}")
            )
    for name, difference in _compare_routes(course.reactions, course.balance).items():
        if difference is None or not difference <= AGREEMENT:
            raise UndeterminedForcesError(
                compose("analyses-force-check-disagrees", check=name, difference=str(difference))
            )
    closed = is_closed(mechanism, at, course.reactions.drive, find_period_turns(block, mechanism))
    drive_peaks, found = _find_extremes(machine, course, at, 0.0, closed)
    least = Peak(-drive_peaks["min"], drive_peaks["at_min"])
    greatest = Peak(drive_peaks["max"], drive_peaks["at"])
    peaks = {name: Peak(peak["max"], peak["at"]) for name, peak in found.items()}
    return closed, peaks | {"drive": max(greatest, least)}


def _list_joint_forces(machine: Machine, course: DrivenMachine, reported: list[str], rubbing: bool) -> JsonObject:
    """Return the forces in joints, slides and gears, and the friction if there is any."""
    found, slides = course.reactions, machine.mechanism.slides
    answer: JsonObject = {
        "joints": {
            joint: {link: _list_series(force) for link, force in on.items()}
            for joint, on in found.joints.items()
            if joint in reported
        },
        "slides": [
            {"joint": slide.joint, "normal": normal.tolist(), "friction": friction.tolist()}
            for slide, normal, friction in zip(slides, found.slides, _list_slide_frictions(found), strict=True)
        ],
        "gears": [{"torque": torque.tolist()} for torque in found.gears],
    }
    return answer | ({"friction": _describe_friction(course)} if rubbing else {})


def _find_largest_index(course: DrivenMachine, extremes: JsonObject) -> tuple[float | None, list[str]]:
    """Find the maximum joint force index, None if a dead centre makes it infinite; also return warnings."""
    dead = course.valid & ~(course.reactions.condition < MAX_CONDITION) & course.reactions.determined
    if dead.any():
        return None, [compose("analyses-force-index-infinite")]
    largest = extremes["index"]["max"]
    if largest > HIGH_INDEX:
        return largest, [
            compose(
                "analyses-force-index-high",
                index=f"{largest:.3g}",
                limit=f"{HIGH_INDEX:g}",
                position=f"{extremes['index']['at']:.4g}",
            )
        ]
    return largest, []


def _drive_machine(
    machine: Machine, at: Real, speed: Real, acceleration: float, indexed: bool, minimum_norm: bool = False
) -> DrivenMachine:
    mechanism = machine.mechanism
    inputs = at if mechanism.has_slide_input else np.radians(at)
    motion = drive(mechanism, inputs, speed=speed, acceleration=acceleration, order=2)
    paced = drive(mechanism, inputs, order=2)
    return _run_course(machine, motion, paced, indexed, minimum_norm)


def _run_course(
    machine: Machine, motion: MechanismMotion, paced: MechanismMotion, indexed: bool, minimum_norm: bool
) -> DrivenMachine:
    now, by_input = Places(machine.mechanism, motion, machine.scale), Places(machine.mechanism, paced, machine.scale)
    if machine.mechanism.has_slide_input:
        # Work needs the input in the length unit of the forces, for example metres instead of millimetres.
        by_input = Places(machine.mechanism, _slow_motion(paced, machine.scale), machine.scale)
    found = compute_reactions(machine, now, minimum_norm=minimum_norm)
    check = compute_balance(machine, now, by_input, found.rubbing)
    taken = -found.rubbing.work(now)
    index = compute_joint_force_index(machine, now, machine.loads[0]) if indexed else None
    return DrivenMachine(motion.valid, motion.smooth, now.input[1], found, check, taken, index)


def _slow_motion(paced: MechanismMotion, scale: float) -> MechanismMotion:
    """Rescale the motion to an input speed of 1 in the unit that is ``scale`` of the mechanism's."""
    powers = scale ** -np.arange(3.0)

    def scale_jets(jets: JsonObject) -> JsonObject:
        return {name: jet * powers.reshape(3, *(1 for _ in jet.shape[1:])) for name, jet in jets.items()}

    return MechanismMotion(
        paced.valid,
        paced.smooth,
        paced.input,
        scale_jets(paced.angles),
        scale_jets(paced.joints),
        scale_jets(paced.slides),
        paced.sines,
        paced.margins,
    )


def _list_status(course: DrivenMachine) -> list[str]:
    found = course.reactions
    undetermined = course.valid & course.smooth & ~found.determined
    reasons = {
        "not_assembled": ~course.valid,
        "load_undetermined": undetermined,
        "friction_jam": found.jammed,
        "dead_centre": ~found.solved,
        "statically_indeterminate": found.indeterminate,
        "stick": np.broadcast_to(found.rubbing.stick, course.valid.shape),
    }
    return [str(status) for status in np.select(list(reasons.values()), list(reasons), "ok")]


def _list_slide_frictions(found: Reactions) -> list[Real]:
    """Return the friction force of each slide's line on its pin, along the direction of the slide."""
    frictions = [0.0 * normal for normal in found.slides]
    for contact, friction in zip(found.rubbing.contacts, found.rubbing.frictions, strict=True):
        if contact.slide >= 0:
            frictions[contact.slide] = friction
    return frictions


def _describe_friction(course: DrivenMachine) -> JsonObject:
    pins: dict[str, dict[str, Real]] = {}
    for contact, friction in zip(course.reactions.rubbing.contacts, course.reactions.rubbing.frictions, strict=True):
        if contact.slide < 0:
            on = pins.setdefault(contact.joint, {})
            on[contact.link] = on.get(contact.link, 0.0) + friction
            on[contact.against] = on.get(contact.against, 0.0) - friction
    listed = {joint: {link: moment.tolist() for link, moment in on.items()} for joint, on in pins.items()}
    lost = np.where(course.reactions.solved, course.dissipated, np.nan)
    return {"pins": listed, "power": lost.tolist()}


def _list_reported_joints(machine: Machine) -> list[str]:
    """Return the joints that connect links, or carry a slide, a mass or a load."""
    mechanism = machine.mechanism
    carrying = {slide.joint for slide in mechanism.slides} | set(machine.pin_masses)
    carrying |= {load.joint for load in machine.loads if hasattr(load, "joint")}
    return [
        joint
        for joint in mechanism.joints
        if joint in carrying or sum(joint in listed for listed in mechanism.links.values()) > 1
    ]


def _list_quantities(machine: Machine, course: DrivenMachine) -> Samples:
    """Return the quantities whose peaks are found, by name."""
    found = course.reactions
    return {
        "drive": found.drive,
        "least drive": -found.drive,
        "power": np.abs(found.drive * course.speed),
        "shaking force": np.abs(found.shaking_force),
        "shaking moment": np.abs(found.shaking_moment),
        **{
            f"joint {joint}": np.abs(np.stack(list(found.joints[joint].values()))).max(axis=0)
            for joint in _list_reported_joints(machine)
        },
        **({} if course.force_index is None else {"index": course.force_index}),
    }


def _find_extremes(
    machine: Machine, course: DrivenMachine, at: Real, acceleration: float, closed: bool, minimum_norm: bool = False
) -> tuple[JsonObject, JsonObject]:
    """Find the extremes of the drive, and of every other quantity by name."""

    def measure(inputs: Real, speeds: Real, machine: Machine) -> Samples:
        indexed = course.force_index is not None
        return _list_quantities(machine, _drive_machine(machine, inputs, speeds, acceleration, indexed, minimum_norm))

    speed = course.speed / (machine.scale if machine.mechanism.has_slide_input else 1.0)
    found = find_peaks(at, speed, _list_quantities(machine, course), partial(measure, machine=machine), closed)

    def list_peak(peak: Peak) -> dict[str, float]:
        return {"max": peak.value, "at": peak.at}

    least = found["least drive"]
    drive_peaks = {**list_peak(found["drive"]), "min": -least.value, "at_min": least.at}
    return drive_peaks, {name: list_peak(peak) for name, peak in found.items()}


def _compare_routes(found: Reactions, check: Balance) -> dict[str, float | None]:
    """Compute the maximum differences between reactions and balances, as shares of the peaks."""
    if not found.solved.any():
        return {"virtual_work": None, "momentum": None}
    known = found.solved
    reach = max(_find_peak(found.drive[known]), MIN_LOAD_SHARE * _find_peak(check.scale[known]))
    force, moment = (_find_peak(values[known]) for values in (found.shaking_force, found.shaking_moment))
    carried = max(
        (_find_peak(values[known & np.isfinite(values)]) for on in found.joints.values() for values in on.values()),
        default=0.0,
    )
    force, moment = (
        max(force, MIN_LOAD_SHARE * carried),
        max(moment, MIN_LOAD_SHARE * _find_peak(check.scale[known]), MIN_LOAD_SHARE * reach),
    )
    return {
        "virtual_work": _compute_share(_find_peak((found.drive - check.drive)[known]), reach),
        "momentum": max(
            _compute_share(_find_peak((found.shaking_force - check.shaking_force)[known]), force),
            _compute_share(_find_peak((found.shaking_moment - check.shaking_moment)[known]), moment),
        ),
    }


def _find_peak(values: Real | Complex) -> float:
    return float(np.abs(values).max(initial=0.0))


def _compute_share(part: float, whole: float) -> float:
    return part / whole if whole > 0.0 else 0.0


def _list_series(force: Complex) -> dict[str, list[float]]:
    return {"x": force.real.tolist(), "y": force.imag.tolist()}
