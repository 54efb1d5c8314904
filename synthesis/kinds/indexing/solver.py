"""Indexing drives: for each number of rollers the drive of the stated size, or the smallest that keeps the demands."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from kinematics.indexing.geneva import Geneva
from synthesis.kinds.indexing import plane, sphere
from synthesis.kinds.indexing.design import (
    GenevaMechanism,
    IndexingCourse,
    IndexingDesign,
    IndexingMetrics,
    IndexingProgram,
    IndexingResult,
    RatchetDesign,
    SizedBy,
    SphericalGenevaMechanism,
)
from synthesis.kinds.indexing.forces import Load, arm, peaks, wheel_torque
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.kinds.indexing.ratchets import solve_ratchet
from synthesis.kinds.indexing.smallest import smallest
from synthesis.kinds.indexing.verification import verify_indexing
from synthesis.model.answer import Verification
from synthesis.model.kind import Progress
from synthesis.outcome.sifting import NUMERICAL, Sifting

SHOWN = 361
"""Positions of a program."""

UNPROVEN = NUMERICAL | {"disc_clears_wheel", "roller_in_slot", "locked_at_rest"}
"""Reasons that rest on outlines of finite steps: with one of them an empty answer is no proof."""

NOT_DRAWABLE = "no_room_for_walls"


def solve_indexing(problem: IndexingProblem, progress: Progress) -> IndexingResult:
    """Solve a problem of indexing drives.

    Returns
    -------
    IndexingResult
        One design for each number of rollers that keeps the demands; complete, since each number has one drive of the
        stated size, or one smallest. ``summary`` says what is in the way where there is none.
    """
    if problem.drive == "ratchet":
        return solve_ratchet(problem, progress)
    sifting = Sifting[IndexingDesign | RatchetDesign](problem)
    numbers = range(1, problem.most_rollers + 1) if problem.rollers is None else [problem.rollers]
    progress(0.0, "sizing")
    sifting.sift(numbers, partial(_candidate, problem))
    progress(1.0, "verified")
    designs = sifting.designs(lambda found: found)
    complete = not UNPROVEN & sifting.rejected.keys()
    return IndexingResult(
        designs=designs,
        search=sifting.search("closed_form", complete=complete),
        summary=_summary(problem, sifting, complete),
    )


def _drive(problem: IndexingProblem) -> Geneva:
    assert problem.drive != "ratchet"
    if problem.crank_radius is not None and problem.center_distance is not None:
        ratio = max(problem.crank_radius / problem.center_distance, math.sin(math.pi / problem.stations))
        return Geneva(problem.drive, problem.stations, ratio)
    return Geneva.shock_free(problem.drive, problem.stations)


def _candidate(problem: IndexingProblem, rollers: int) -> IndexingDesign | str:
    """The drive with a number of rollers, verified; the reason where it cannot be drawn."""
    drive = _drive(problem)
    load = Load(problem.load_inertia, problem.load_torque, problem.crank_speed)
    size, sized_by = problem.sphere_radius if problem.spherical else problem.center_distance, None
    if size is None:
        found = smallest(problem, drive, load)
        if found is None:
            return NOT_DRAWABLE
        size, sized_by = found
    if problem.spherical:
        hemisphere = sphere.hemisphere_of(problem, size)
        if not sphere.drawable(problem, hemisphere):
            return NOT_DRAWABLE
        walls = {"wall": hemisphere.wall, "web": hemisphere.web, "size": 2.0 * size}
        free = hemisphere.inmost - 0.5 * problem.wheel_shaft_diameter
        mechanism: GenevaMechanism | SphericalGenevaMechanism = sphere.mechanism_of(problem, hemisphere)
    else:
        wheel = plane.wheel_of(problem, drive, size)
        if not plane.drawable(wheel, problem.clearances.locking):
            return NOT_DRAWABLE
        walls = {"wall": wheel.wall, "web": wheel.web, "size": plane.size_of(problem, wheel, drive.ratio * size)}
        free = math.inf if wheel.internal else wheel.slot_end - wheel.half_slot - 0.5 * problem.wheel_shaft_diameter
        mechanism = plane.mechanism_of(problem, drive, wheel, rollers)
    metrics = _metrics(problem, drive, load, size, walls, undercut=free < 0.0 or walls["web"] < 0.0, sized_by=sized_by)
    alpha = np.linspace(-drive.half, drive.half, SHOWN)
    motion, torque = drive.motion(alpha), wheel_torque(drive, load, alpha)
    index = math.degrees(2.0 * drive.half)
    design = IndexingDesign(
        mechanism=mechanism,
        verification=Verification.of([]),
        index_angle=index,
        dwell_share=1.0 - rollers * index / 360.0,
        program=IndexingProgram(
            angle=np.degrees(alpha + drive.half).tolist(),
            s=np.degrees(motion.s - motion.s[0]).tolist(),
            v=motion.v.tolist(),
            a=motion.a.tolist(),
            j=motion.j.tolist(),
        ),
        course=IndexingCourse(
            wheel_torque=torque.tolist(),
            drive_torque=(torque * motion.v).tolist(),
            pin_force=(torque / arm(drive, alpha, problem.scale * size)).tolist(),
        ),
        metrics=metrics,
    )
    return verify_indexing(problem, design)


def _metrics(
    problem: IndexingProblem,
    drive: Geneva,
    load: Load,
    size: float,
    walls: dict[str, float],
    *,
    undercut: bool,
    sized_by: SizedBy | None,
) -> IndexingMetrics:
    greatest = peaks(drive, load, problem.scale * size)
    at = drive.half - drive.peak_angle
    return IndexingMetrics(
        peak_velocity=greatest.velocity,
        peak_acceleration=abs(float(drive.motion(np.array(at - drive.half)).a)),
        peak_acceleration_angle=math.degrees(at),
        peak_jerk=greatest.jerk,
        entry_speed=float(drive.motion(np.array(-drive.half)).v),
        peak_wheel_torque=greatest.wheel_torque,
        peak_drive_torque=greatest.drive_torque,
        peak_pin_force=greatest.pin_force,
        undercut=undercut,
        locking_angle=0.0,
        play=0.0,
        sized_by=sized_by,
        **walls,
    )


def _summary(problem: IndexingProblem, sifting: Sifting[IndexingDesign | RatchetDesign], complete: bool) -> str:
    best = sifting.passed[0] if sifting.passed else None
    if not isinstance(best, IndexingDesign):
        told = "None exists" if complete else "None was found"
        return f"{told}: {sifting.listed()}."
    metrics, unit = best.metrics, problem.length_unit
    size = f"its size is {metrics.size:.6g} {unit}"
    if metrics.sized_by is not None:
        size = f"the smallest has the size {metrics.size:.6g} {unit}, set by its {metrics.sized_by.replace('_', ' ')}"
    return (
        f"The wheel turns during {best.index_angle:.6g}° of the crank and rests for {100.0 * best.dwell_share:.4g} % "
        f"of the time; {size}." + sifting.reasons()
    )
