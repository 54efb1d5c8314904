"""Ratchets: for each number of teeth and pawls that gives the stops, the wheel of given or minimum size."""

from __future__ import annotations

import cmath
import math
from functools import partial
from typing import cast

from kinematics.indexing.ratchet import Ratchet, find_min_face
from kinematics.message import compose
from synthesis.kinds.indexing.design import (
    IndexingDesign,
    IndexingResult,
    Pawl,
    Profile,
    RatchetDesign,
    RatchetMechanism,
    RatchetMetrics,
    SizedBy,
)
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.kinds.indexing.smallest import find_least_size
from synthesis.kinds.indexing.verification.ratchet import verify_ratchet
from synthesis.model.answer import Verification
from synthesis.model.kind import Progress
from synthesis.model.linkage.conversion import to_point
from synthesis.results.candidate_log import NUMERICAL_REASONS, CandidateLog
from synthesis.results.remarks import append_remark, write_name, write_quantity

MIN_HEIGHT_FACTOR = 1.6
"""Factor on the tooth height of wheels with few teeth: below it the straight back would not fall towards its foot."""

UNPROVEN_REASONS = NUMERICAL_REASONS | {
    "equal_stops",
    "pawls_at_every_stop",
    "locking_as_told",
    "holds_the_torque",
    "pawl_rides",
    "overtravel_as_told",
    "lift_as_told",
    "falls_in",
    "no_face_locks",
}
"""Reasons of rejection that depend on rounding or on values chosen here, so that an empty answer is no proof."""

NO_FACE = "no_face_locks"
"""Reason if the pawl is too short for any face to draw it in."""


def solve_ratchet(problem: IndexingProblem, progress: Progress) -> IndexingResult:
    """Solve a problem of ratchets.

    Returns
    -------
    IndexingResult
        One design for each number of pawls, with the wheel of the given size or the smallest wheel. The answer is
        complete unless a design is rejected for a reason that may depend on a height or length that is not given.
    """
    sifting = CandidateLog[IndexingDesign | RatchetDesign](problem)
    progress(0.0, compose("indexing-sizing"))
    sifting.verify_candidates(problem.teeth_choices, partial(_build_candidate, problem))
    progress(1.0, compose("results-verified"))
    complete = _is_proven(problem, sifting)
    return IndexingResult(
        designs=sifting.select_designs(lambda found: found),
        search=sifting.build_search("closed_form", complete=complete),
        summary=_write_summary(problem, sifting, complete),
    )


def _is_proven(problem: IndexingProblem, sifting: CandidateLog[IndexingDesign | RatchetDesign]) -> bool:
    """Return whether no other choice of omitted values could have satisfied the failed checks."""
    stated = problem.pawl
    if stated.tooth_height is None or stated.length is None:
        # Every constraint depends on the height and the length, which are chosen here.
        return not sifting.rejected
    unproven = UNPROVEN_REASONS if stated.wheel_radius is not None else UNPROVEN_REASONS | {"locking_angle"}
    return not unproven & sifting.rejected.keys()


def build_wheel(problem: IndexingProblem, teeth: int, radius: float) -> Ratchet | None:
    """Build the wheel of a radius with its pawl; None if no face angle draws the pawl in."""
    stated, pitch = problem.pawl, 2.0 * math.pi / teeth
    height = stated.tooth_height
    if height is None:
        height = radius * max(pitch / 3.0, MIN_HEIGHT_FACTOR * (1.0 - math.cos(pitch)))
    # A pawl as long as the radius is the usual proportion.
    length = radius if stated.length is None else stated.length
    if not height < 0.9 * radius:
        return None
    if stated.face_angle is not None:
        wheel = Ratchet(teeth, radius, height, math.radians(stated.face_angle), length)
        return wheel if wheel.reach < length else None
    face = find_min_face(teeth, radius, height, length, _compute_required_angle(problem))
    return None if face is None else Ratchet(teeth, radius, height, face, length)


def _compute_required_angle(problem: IndexingProblem) -> float:
    """Return the minimum locking angle, radians."""
    return math.atan(problem.pawl.friction) + math.radians(problem.pawl.reserve)


def compute_tooth_force(problem: IndexingProblem, wheel: Ratchet) -> float:
    """Return the force of each holding pawl, at the middle of the face and normal to it."""
    # Lever of a force normal to the face.
    arm = problem.scale * wheel.middle * math.cos(wheel.face)
    return problem.load_torque / (problem.pawl.overlap * arm)


def _compute_margin(problem: IndexingProblem, teeth: int, name: str, radius: float) -> float:
    wheel = build_wheel(problem, teeth, radius)
    if wheel is None:
        return math.nan
    if name == "locking_angle":
        return wheel.locking_angle - _compute_required_angle(problem)
    if name == "web":
        return wheel.thickness - problem.wall
    if name == "bore":
        return wheel.radius - wheel.height - 0.5 * problem.wheel_shaft_diameter - problem.wall
    limit = problem.constraints.pin_force
    assert limit is not None
    return limit - compute_tooth_force(problem, wheel)


def _find_smallest(problem: IndexingProblem, teeth: int) -> tuple[float, SizedBy] | None:
    names = ["web", "bore"]
    if problem.constraints.pin_force is not None:
        names.append("pin_force")
    if problem.pawl.face_angle is not None:
        # A face that is found has this angle at any size.
        names.append("locking_angle")
    least: dict[str, float] = {}
    for name in names:
        found = find_least_size(partial(_compute_margin, problem, teeth, name), problem.wall)
        if found is not None:
            least[name] = found
        elif name != "locking_angle":
            return None
        # A face that locks at no size is reported by its check.
    setting = max(least, key=lambda name: least[name])
    return least[setting], cast(SizedBy, setting)


def _build_candidate(problem: IndexingProblem, choice: tuple[int, int]) -> RatchetDesign | str:
    """Build the ratchet of a number of teeth and pawls, verified; the reason if there is none."""
    teeth, pawls = choice
    radius, sized_by = problem.pawl.wheel_radius, None
    if radius is None:
        found = _find_smallest(problem, teeth)
        if found is None:
            return NO_FACE
        radius, sized_by = found
    wheel = build_wheel(problem, teeth, radius)
    if wheel is None:
        return NO_FACE
    outline = wheel.outline
    mechanism = RatchetMechanism(
        stations=problem.stations,
        teeth=teeth,
        overlap=problem.pawl.overlap,
        wheel_radius=radius,
        tooth_height=wheel.height,
        face_angle=math.degrees(wheel.face),
        pawl_length=wheel.pawl,
        bore=problem.wheel_shaft_diameter,
        pawls=_place_pawls(wheel, pawls, problem.pawl.overlap),
        profile=Profile(x=outline.real.tolist(), y=outline.imag.tolist()),
    )
    metrics = RatchetMetrics(
        step=360.0 / problem.stations,
        tooth_force=compute_tooth_force(problem, wheel),
        locking_angle=math.degrees(wheel.locking_angle),
        friction_angle=math.degrees(math.atan(problem.pawl.friction)),
        tooth_thickness=wheel.thickness,
        lift=math.degrees(wheel.lift),
        overtravel=math.degrees(wheel.overtravel),
        size=2.0 * radius,
        sized_by=sized_by,
    )
    design = RatchetDesign(mechanism=mechanism, verification=Verification.from_checks([]), metrics=metrics)
    return verify_ratchet(problem, design)


def _place_pawls(wheel: Ratchet, count: int, overlap: int) -> list[Pawl]:
    """Place pawls around the wheel as evenly as whole pitches permit, with their groups staggered."""
    # Pawls of one group act together, different groups stop at different fractions of a pitch.
    groups, placed = count // overlap, []
    for number in range(count):
        stagger = number % groups
        around = wheel.pitch * round(number * wheel.teeth / count)
        turn = cmath.exp(1j * (around + wheel.pitch * stagger / groups))
        placed.append(
            Pawl(
                pivot=to_point(turn * wheel.pivot),
                nose=to_point(turn * wheel.foot),
                stop=math.degrees(wheel.pitch) * stagger / groups,
            )
        )
    return placed


def _write_summary(
    problem: IndexingProblem, sifting: CandidateLog[IndexingDesign | RatchetDesign], complete: bool
) -> str:
    best = sifting.passed[0] if sifting.passed else None
    if not isinstance(best, RatchetDesign):
        verdict = "indexing-none-exists" if complete else "indexing-none-found"
        return compose(verdict, reasons=sifting.format_reasons())
    mechanism, metrics, unit = best.mechanism, best.metrics, problem.length_unit
    diameter = write_quantity(f"{metrics.size:.6g}", unit)
    if metrics.sized_by is None:
        size = compose("indexing-wheel-diameter", diameter=diameter)
    else:
        limit = write_name(metrics.sized_by.replace("web", "teeth"))
        size = compose("indexing-smallest-wheel-diameter", diameter=diameter, limit=limit)
    wheel = compose(
        "indexing-ratchet",
        teeth=mechanism.teeth,
        pawls=len(mechanism.pawls),
        step=f"{metrics.step:.6g}",
        size=size,
        angle=f"{mechanism.face_angle:.4g}",
    )
    return append_remark(wheel, sifting.describe_reasons())
