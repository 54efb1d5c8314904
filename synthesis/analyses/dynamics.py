"""Forces of a linkage over its motion, as plain lists in the shape of :class:`DynamicsAnswer`."""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.balance import Balance, balance
from kinematics.dynamics.force_index import joint_force_index
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import SINGULAR, Reactions, reactions
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.analyses.cyclic import closes, flywheel_of, harmonics_of, mean, rms
from synthesis.analyses.peaks import Peak, Samples, peaks
from synthesis.mechanisms.courses import repeated_after
from synthesis.mechanisms.machine import first_fixed, machine_of
from synthesis.model.dynamics import DynamicsBlock, LengthUnit, WeighedLinkage

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

HIGH_INDEX = 2.0
"""Joint force index above which a client is warned (Norton, Sec. 11.12)."""

DETERMINED = ("ok", "stick")
"""States of a position at which forces are known, but for a friction that the motion does not determine."""

AGREEMENT = 1e-6
"""Difference of two routes to the same force, as a share of its peak, with which it counts as known. They agree to 1e-9
and better where no joint is near a dead centre."""

NO_LOAD = 1e-6
"""Share of the largest part of a balance below which its sum is nothing that an error could be compared with."""


class Course(NamedTuple):
    """A machine driven to inputs: reactions, balances, and where it could be assembled."""

    valid: NDArray[np.bool_]
    smooth: NDArray[np.bool_]
    speed: Real
    reactions: Reactions
    balance: Balance
    dissipated: Real
    force_index: Real | None


def forces_of(
    mechanism: Mechanism, block: DynamicsBlock, unit: LengthUnit, at: Real, speed: Real, acceleration: float
) -> dict[str, Any]:
    """The answer at inputs (degrees, or lengths along the input slide), their speeds and acceleration."""
    machine, warnings = machine_of(block, mechanism, unit)
    indexed = block.reports("joint_force_index")
    course = _driven(machine, at, speed, acceleration, indexed, block.minimum_norm)
    found, check = course.reactions, course.balance
    closed = closes(mechanism, at, found.drive, repeated_after(block, mechanism))
    drive_peaks, extremes = _extremes(machine, course, at, acceleration, closed, block.minimum_norm)
    reported = _reported(machine)
    power = found.drive * course.speed
    answer: dict[str, Any] = {"units": block.units, "length_unit": unit}
    if block.reports("drive"):
        answer["drive"] = found.drive.tolist()
        answer["virtual_work_drive"] = np.where(found.solved, check.drive, np.nan).tolist()
    if block.reports("joint_forces"):
        answer |= _joint_forces(machine, course, reported, block.friction is not None)
    if block.reports("shaking"):
        about = first_fixed(mechanism) if block.moment_about is None else complex(*block.moment_about)
        answer["shaking"] = {
            "force": _series(found.shaking_force),
            "moment": found.shaking_moment.tolist(),
            "about": (about.real, about.imag),
        }
    answer |= {
        "extremes": {
            "drive": drive_peaks | {"mean": mean(found.drive, closed), "rms": rms(found.drive, closed)},
            "joints": {joint: extremes[f"joint {joint}"] for joint in reported},
            "shaking_force": extremes["shaking force"],
            "shaking_moment": extremes["shaking moment"],
        },
        "power": {"peak": extremes["power"]["max"], "mean": mean(power, closed)},
    }
    if block.reports("flywheel"):
        answer["flywheel"] = flywheel_of(found.drive, at, float(speed[0]), closed, block.flywheel)
    if block.reports("harmonics"):
        answer["harmonics"] = harmonics_of(found, at, closed)
    if course.force_index is not None:
        answer["joint_force_index"] = course.force_index.tolist()
        answer["max_joint_force_index"], told = _largest_index(course, extremes)
        warnings = warnings + told
    return answer | {"status": _status(course), "checks": _checks(found, check), "warnings": warnings}


class Undetermined(ValueError):
    """Forces that are not determined all along a motion; says what stands against them and where."""


def peaks_of(
    mechanism: Mechanism, block: WeighedLinkage, unit: LengthUnit, at: Real, speed: float
) -> tuple[bool, dict[str, Peak]]:
    """The peaks of all forces at constant speed, by the names of :func:`_quantities`; and whether the motion closes.

    Raises
    ------
    Undetermined
        Where the motion has a position without forces, or both routes to them disagree.
    """
    machine, _ = machine_of(block, mechanism, unit)
    course = _driven(machine, at, np.full(len(at), speed), 0.0, bool(block.loads))
    for status, position in zip(_status(course), at, strict=True):
        if status not in DETERMINED:
            raise Undetermined(f"{status} at {position:.4g}")
    for name, difference in _checks(course.reactions, course.balance).items():
        if difference is None or not difference <= AGREEMENT:
            raise Undetermined(f"the check {name} finds a difference of {difference}")
    closed = closes(mechanism, at, course.reactions.drive, repeated_after(block, mechanism))
    drive_peaks, found = _extremes(machine, course, at, 0.0, closed)
    least = Peak(-drive_peaks["min"], drive_peaks["at_min"])
    greatest = Peak(drive_peaks["max"], drive_peaks["at"])
    peaks = {name: Peak(peak["max"], peak["at"]) for name, peak in found.items()}
    return closed, peaks | {"drive": max(greatest, least)}


def _joint_forces(machine: Machine, course: Course, reported: list[str], rubbing: bool) -> dict[str, Any]:
    """Forces in joints, slides and gears, and friction."""
    found, slides = course.reactions, machine.mechanism.slides
    answer: dict[str, Any] = {
        "joints": {
            joint: {link: _series(force) for link, force in on.items()}
            for joint, on in found.joints.items()
            if joint in reported
        },
        "slides": [
            {"joint": slide.joint, "normal": normal.tolist(), "friction": friction.tolist()}
            for slide, normal, friction in zip(slides, found.slides, _slide_frictions(found), strict=True)
        ],
        "gears": [{"torque": torque.tolist()} for torque in found.gears],
    }
    return answer | ({"friction": _friction(course)} if rubbing else {})


def _largest_index(course: Course, extremes: dict[str, Any]) -> tuple[float | None, list[str]]:
    """The largest joint force index, None where a dead centre makes it infinite; and what to warn of."""
    dead = course.valid & ~(course.reactions.condition < SINGULAR) & course.reactions.determined
    if dead.any():
        return None, ["joint_force_index: infinite at a dead centre"]
    largest = extremes["index"]["max"]
    if largest > HIGH_INDEX:
        return largest, [f"joint_force_index: {largest:.3g}, above {HIGH_INDEX:g}, at {extremes['index']['at']:.4g}"]
    return largest, []


def _driven(
    machine: Machine, at: Real, speed: Real, acceleration: float, indexed: bool, minimum_norm: bool = False
) -> Course:
    mechanism = machine.mechanism
    inputs = at if mechanism.driven_by_slide else np.radians(at)
    motion = drive(mechanism, inputs, speed=speed, acceleration=acceleration, order=2)
    paced = drive(mechanism, inputs, order=2)
    return _course(machine, motion, paced, indexed, minimum_norm)


def _course(
    machine: Machine, motion: MechanismMotion, paced: MechanismMotion, indexed: bool, minimum_norm: bool
) -> Course:
    now, by_input = Places(machine.mechanism, motion, machine.scale), Places(machine.mechanism, paced, machine.scale)
    if machine.mechanism.driven_by_slide:
        # A unit of the input is one of the mechanism's own: the work of a metre is wanted, not of a millimetre.
        by_input = Places(machine.mechanism, _slowed(paced, machine.scale), machine.scale)
    found = reactions(machine, now, minimum_norm=minimum_norm)
    check = balance(machine, now, by_input, found.rubbing)
    taken = -found.rubbing.work(now)
    index = joint_force_index(machine, now, machine.loads[0]) if indexed else None
    return Course(motion.valid, motion.smooth, now.input[1], found, check, taken, index)


def _slowed(paced: MechanismMotion, scale: float) -> MechanismMotion:
    """The motion at an input speed of 1 in the unit that is ``scale`` of the mechanism's."""
    powers = scale ** -np.arange(3.0)

    def slowed(jets: dict[str, Any]) -> dict[str, Any]:
        return {name: jet * powers.reshape(3, *(1 for _ in jet.shape[1:])) for name, jet in jets.items()}

    return MechanismMotion(
        paced.valid,
        paced.smooth,
        paced.input,
        slowed(paced.angles),
        slowed(paced.joints),
        slowed(paced.slides),
        paced.sines,
        paced.margins,
    )


def _status(course: Course) -> list[str]:
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


def _slide_frictions(found: Reactions) -> list[Real]:
    """Friction of each slide's line on its pin, along the slide's direction."""
    frictions = [0.0 * normal for normal in found.slides]
    for contact, friction in zip(found.rubbing.contacts, found.rubbing.frictions, strict=True):
        if contact.slide >= 0:
            frictions[contact.slide] = friction
    return frictions


def _friction(course: Course) -> dict[str, Any]:
    pins: dict[str, dict[str, Real]] = {}
    for contact, friction in zip(course.reactions.rubbing.contacts, course.reactions.rubbing.frictions, strict=True):
        if contact.slide < 0:
            on = pins.setdefault(contact.joint, {})
            on[contact.link] = on.get(contact.link, 0.0) + friction
            on[contact.against] = on.get(contact.against, 0.0) - friction
    listed = {joint: {link: moment.tolist() for link, moment in on.items()} for joint, on in pins.items()}
    lost = np.where(course.reactions.solved, course.dissipated, np.nan)
    return {"pins": listed, "power": lost.tolist()}


def _reported(machine: Machine) -> list[str]:
    """Joints that join links, or carry a slide, a mass or a load."""
    mechanism = machine.mechanism
    carrying = {slide.joint for slide in mechanism.slides} | set(machine.pin_masses)
    carrying |= {load.joint for load in machine.loads if hasattr(load, "joint")}
    return [
        joint
        for joint in mechanism.joints
        if joint in carrying or sum(joint in listed for listed in mechanism.links.values()) > 1
    ]


def _quantities(machine: Machine, course: Course) -> Samples:
    """What has a peak, by name."""
    found = course.reactions
    return {
        "drive": found.drive,
        "least drive": -found.drive,
        "power": np.abs(found.drive * course.speed),
        "shaking force": np.abs(found.shaking_force),
        "shaking moment": np.abs(found.shaking_moment),
        **{
            f"joint {joint}": np.abs(np.stack(list(found.joints[joint].values()))).max(axis=0)
            for joint in _reported(machine)
        },
        **({} if course.force_index is None else {"index": course.force_index}),
    }


def _extremes(
    machine: Machine, course: Course, at: Real, acceleration: float, closed: bool, minimum_norm: bool = False
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Of the drive, and of everything else by name."""

    def measure(inputs: Real, speeds: Real, machine: Machine) -> Samples:
        indexed = course.force_index is not None
        return _quantities(machine, _driven(machine, inputs, speeds, acceleration, indexed, minimum_norm))

    speed = course.speed / (machine.scale if machine.mechanism.driven_by_slide else 1.0)
    found = peaks(at, speed, _quantities(machine, course), partial(measure, machine=machine), closed)

    def listed(peak: Peak) -> dict[str, float]:
        return {"max": peak.value, "at": peak.at}

    least = found["least drive"]
    drive_peaks = {**listed(found["drive"]), "min": -least.value, "at_min": least.at}
    return drive_peaks, {name: listed(peak) for name, peak in found.items()}


def _checks(found: Reactions, check: Balance) -> dict[str, float | None]:
    """Largest differences of the two routes, as shares of the peaks."""
    if not found.solved.any():
        return {"virtual_work": None, "momentum": None}
    known = found.solved
    reach = max(_peak(found.drive[known]), NO_LOAD * _peak(check.scale[known]))
    force, moment = (_peak(values[known]) for values in (found.shaking_force, found.shaking_moment))
    carried = max(
        (_peak(values[known & np.isfinite(values)]) for on in found.joints.values() for values in on.values()),
        default=0.0,
    )
    force, moment = max(force, NO_LOAD * carried), max(moment, NO_LOAD * _peak(check.scale[known]), NO_LOAD * reach)
    return {
        "virtual_work": _share(_peak((found.drive - check.drive)[known]), reach),
        "momentum": max(
            _share(_peak((found.shaking_force - check.shaking_force)[known]), force),
            _share(_peak((found.shaking_moment - check.shaking_moment)[known]), moment),
        ),
    }


def _peak(values: Real | Complex) -> float:
    return float(np.abs(values).max(initial=0.0))


def _share(part: float, whole: float) -> float:
    return part / whole if whole > 0.0 else 0.0


def _series(force: Complex) -> dict[str, list[float]]:
    return {"x": force.real.tolist(), "y": force.imag.tolist()}
