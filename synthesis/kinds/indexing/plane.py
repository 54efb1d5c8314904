"""Plane Geneva drives: dimensions for a given center distance, and the constraints that determine its minimum."""

from __future__ import annotations

import math

import numpy as np

from kinematics.indexing.drag_link import CrankCourse
from kinematics.indexing.geneva import Geneva
from kinematics.indexing.locking import Disc, build_crescent, build_disc
from kinematics.indexing.wheel import Wheel
from synthesis.kinds.indexing.design import DragLinkDriver, GenevaMechanism, LockingDisc, Profile
from synthesis.kinds.indexing.problem import IndexingProblem

CRESCENT_RAY_COUNT = 9
"""Number of rays along which the thickness of a crescent is measured."""


def build_wheel(problem: IndexingProblem, drive: Geneva, center_distance: float) -> Wheel:
    """Build the wheel of a drive; its locking arc is NaN if the wall leaves none."""
    internal = problem.drive == "geneva_internal"
    step, radius = math.pi / problem.stations, drive.ratio * center_distance
    half_slot = 0.5 * (problem.roller + problem.clearances.slot)
    entry = center_distance * abs(1.0 - drive.signed * complex(math.cos(drive.half), math.sin(drive.half)))
    # The rim passes through the far side of the entering roller.
    reach = math.hypot(entry, 0.5 * problem.roller)
    end = center_distance + radius + problem.slot_room if internal else center_distance - radius - problem.slot_room
    lock = _compute_lock_radius(internal, step, center_distance, reach, half_slot + problem.wall)
    return Wheel(internal, problem.stations, center_distance, reach, half_slot, end, lock)


def _compute_lock_radius(internal: bool, step: float, center_distance: float, reach: float, apart: float) -> float:
    """Compute the radius of locking arcs at the distance ``apart`` from the axes of the slots."""
    foot = math.hypot(center_distance * math.cos(step), apart)
    # The arc is nearest to the slot's axis at the foot of the perpendicular, if that is on the wheel.
    if (foot <= reach) != internal:
        lock = center_distance * math.sin(step) - apart
        return lock if lock > 0.0 else math.nan
    if apart >= reach * math.sin(step):
        return math.nan
    # Otherwise the arc's corner on the rim is nearest: the law of cosines for its radius.
    beside = step - math.asin(apart / reach)
    return math.sqrt(reach**2 + center_distance**2 - 2.0 * reach * center_distance * math.cos(beside))


def compute_margins(problem: IndexingProblem, drive: Geneva, center_distance: float) -> dict[str, float]:
    """Compute by how much a drive exceeds each of its wall constraints; NaN or negative if it is too small.

    The disc is at least as large as the roller.
    """
    wheel = build_wheel(problem, drive, center_distance)
    shaft = 0.5 * problem.crank_shaft_diameter
    disc = wheel.lock - problem.clearances.locking
    found = {
        # The minimum is NaN if any of the margins is.
        "locking_disc": float(np.min([disc - shaft, disc - 0.5 * problem.roller, wheel.land])),
        "web": wheel.web - problem.wall,
    }
    if wheel.internal:
        found["crescent"] = _compute_crescent_margin(problem, drive, wheel)
    else:
        found["bore"] = wheel.slot_end - wheel.half_slot - 0.5 * problem.wheel_shaft_diameter - problem.wall
        if shaft > 0.0:
            found["crank_shaft"] = center_distance - wheel.reach - problem.relief - shaft
    return found


def _compute_crescent_margin(problem: IndexingProblem, drive: Geneva, wheel: Wheel) -> float:
    """Compute by how much the crescent of an internal drive is thicker than a wall at its thinnest place."""
    if not is_drawable(wheel, problem.clearances.locking):
        return math.nan
    found = build_crescent(wheel, drive, problem.clearances.locking, problem.relief, CRESCENT_RAY_COUNT)
    return float((found.outer - found.inner).min()) - problem.wall


def is_drawable(wheel: Wheel, gap: float) -> bool:
    """Return whether the outline exists: arcs that cut the wheel between slots, and slots that end before its axis."""
    return wheel.lock > gap and wheel.land > 0.0 and wheel.slot_end > wheel.half_slot and wheel.web > 0.0


def compute_size(problem: IndexingProblem, wheel: Wheel, crank_radius: float) -> float:
    """Compute the extent: for an external drive along the line of both axes, for a ring its diameter."""
    if wheel.internal:
        return 2.0 * compute_ring_radius(problem, wheel)
    return wheel.reach + wheel.center_distance + crank_radius + 0.5 * problem.roller


def compute_ring_radius(problem: IndexingProblem, wheel: Wheel) -> float:
    """Compute the outer radius of a ring, one wall beyond the ends of its slots."""
    return wheel.slot_end + wheel.half_slot + problem.wall


def build_mechanism(problem: IndexingProblem, course: CrankCourse, wheel: Wheel, rollers: int) -> GenevaMechanism:
    """Build all dimensions and outlines of a drive that can be drawn."""
    drive = course.geneva
    assert drive.drive != "geneva_spherical"
    gap = problem.clearances.locking
    return GenevaMechanism(
        type=drive.drive,
        stations=problem.stations,
        rollers=rollers,
        center_distance=wheel.center_distance,
        crank_radius=drive.ratio * wheel.center_distance,
        roller_diameter=problem.roller,
        wheel_radius=wheel.reach,
        ring_radius=compute_ring_radius(problem, wheel) if wheel.internal else None,
        slot_width=2.0 * wheel.half_slot,
        slot_end_radius=wheel.slot_end,
        locking_radius=wheel.lock - gap,
        locking_arc_radius=wheel.lock,
        bore=problem.wheel_shaft_diameter,
        drag_link=_build_driver(course, wheel.center_distance),
        profile=Profile(x=wheel.outline.real.tolist(), y=wheel.outline.imag.tolist()),
        disc=_build_disc(build_disc(wheel, drive, rollers, gap, problem.relief)),
    )


def _build_driver(course: CrankCourse, center_distance: float) -> DragLinkDriver | None:
    """Scale the drag link: its output is as long as the crank."""
    link = course.link
    if link is None:
        return None
    # Lengths are relative to the ground; the output must equal the crank radius.
    ground = course.geneva.ratio * center_distance / float(link.output)
    # The line from the input's pivot to the crank's axis points to the wheel, the direction of an external index.
    towards = 0.0 if course.geneva.drive == "geneva_external" else math.pi
    return DragLinkDriver(
        input_pivot=(center_distance + ground, 0.0),
        ground=ground,
        input=float(link.input) * ground,
        coupler=float(link.coupler) * ground,
        output=float(link.output) * ground,
        crank_offset=math.degrees(towards - course.phase),
        entry_angle=math.degrees(course.start),
    )


def _build_disc(found: Disc) -> LockingDisc:
    return LockingDisc(
        angle=np.degrees(found.angle).tolist(), outer_radius=found.outer.tolist(), inner_radius=found.inner.tolist()
    )
