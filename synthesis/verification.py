"""The proof of a design: it is driven by the analysis core and measured, from its dimensions alone.

Nothing that a solver computed on the way is taken over. For a linkage that guides a body the demanded position of the
coupler at each target gives the pin A, and with it the input angle; the linkage is then driven to that angle in both
assemblies, and what stands there is compared with what was demanded. The motion between the targets is followed in
closed form: toggles have closed-form angles, and so has the least transmission angle over a range.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np

from kinematics.errors import DimensionError
from kinematics.linkage import (
    Traversal,
    barker_class,
    can_assemble,
    positions,
    same_circuit,
    transmission_extremes,
    traverse,
)
from synthesis.designs import (
    Check,
    FourbarLinks,
    FourbarMechanism,
    LinkageDesign,
    LinkageMetrics,
    Target,
    Verification,
)
from synthesis.linkages import DrivenFourbar, driven_fourbar
from synthesis.problems import Constraints, MotionProblem
from synthesis.ranking import quality

TARGET_REACHED = 1e-9
"""Largest residual (share of the task's size; radians) with which a target counts as reached: far below any
manufacturing tolerance, far above the rounding of double precision for a linkage of sensible size."""

CHOICE_KEPT = 1e-8
"""Largest deviation from what the client fixed of a side; angles of short links lose a digit against positions."""

LIMIT_SLACK = 1e-9
"""Relative slack when a measured value is compared with a client's limit, so that a value that is exactly at the limit
does not fail by rounding."""


class _Driven(NamedTuple):
    """What was found at the targets: driven angle, assembly sign and residual of each, and all joints there."""

    angles: np.ndarray
    assemblies: np.ndarray
    residuals: np.ndarray
    joints: np.ndarray


def verify(problem: MotionProblem, mechanism: FourbarMechanism) -> LinkageDesign | None:
    """Drive a mechanism through a problem's targets and measure it.

    Parameters
    ----------
    problem : MotionProblem
        What was asked.
    mechanism : FourbarMechanism
        Dimensions only; the skeleton is not looked at.

    Returns
    -------
    LinkageDesign or None
        The mechanism with its checks and metrics; ``verification.passed`` tells whether it may be used. None where the
        dimensions do not make a linkage that can be assembled and driven at all.
    """
    try:
        fourbar = driven_fourbar(mechanism)
    except DimensionError:
        return None
    if not can_assemble(fourbar.linkage):
        return None
    size = problem.task_size
    driven = _drive(problem, fourbar, size)
    if driven is None:
        return None
    linkage = fourbar.linkage
    way = traverse(linkage, driven.angles, driven.assemblies)
    on_circuit = way.same_branch or bool(
        np.all(same_circuit(linkage, driven.angles[0], driven.assemblies[0], driven.angles, driven.assemblies))
    )
    barker = barker_class(linkage)
    least = float(transmission_extremes(linkage, way.start, way.end)[0]) if way.same_branch else 0.0
    links, point = mechanism.links, complex(linkage.coupler_point)
    lengths = links.ground, links.input, links.coupler, links.output
    reach = max(*lengths, abs(point), abs(point - links.coupler))
    ratio = max(lengths) / min(lengths)
    span = np.ptp(driven.joints.view(np.float64).reshape(-1, 2), axis=0)
    metrics = LinkageMetrics(
        grashof=barker.motion,
        barker=barker.code,
        min_transmission_angle=math.degrees(least),
        same_branch=way.same_branch,
        visits_in_order=on_circuit and way.in_order,
        full_rotation=barker.motion in ("double_crank", "crank_rocker"),
        input_rotation=math.degrees(way.angles[-1] - way.angles[0]),
        link_ratio=ratio,
        size=math.hypot(*span),
        quality=quality(math.sin(least), reach / size, ratio),
    )
    checks = [*_motion_checks(driven, on_circuit), *_choice_checks(problem, driven, size)]
    checks += _constraint_checks(problem.constraints, links, driven, metrics)
    return LinkageDesign(
        mechanism=mechanism,
        targets=_targets(mechanism.reference_input_angle, driven, way),
        verification=Verification(passed=all(check.passed for check in checks), checks=checks),
        metrics=metrics,
    )


def _drive(problem: MotionProblem, fourbar: DrivenFourbar, size: float) -> _Driven | None:
    """Drive the linkage to where each target demands its input, in both assemblies; None if it stands nowhere."""
    linkage = fourbar.linkage
    reference = positions(linkage, fourbar.reference, fourbar.assembly)
    if not reference.valid:
        return None
    points = np.array([p.point for p in problem.positions])
    turns = np.array(problem.turns)
    coupler_angles = reference.coupler_angle + turns
    pins = points - linkage.coupler_point * np.exp(1j * coupler_angles)
    angles = np.angle(pins - linkage.input_pivot)
    signs = np.array([fourbar.assembly, -fourbar.assembly])
    found = positions(linkage, angles, signs)
    turned_off = np.abs(np.angle(np.exp(1j * (found.coupler_angle - coupler_angles))))
    residuals = np.where(found.valid, np.maximum(np.abs(found.p - points) / size, turned_off), np.inf)
    # The first target is met by the reference configuration itself, or not at all.
    residuals[0, 0] = max(residuals[0, 0], abs(complex(reference.p) - points[0]) / size)
    residuals[1, 0] = np.inf
    # The reference's own assembly stands first, and is taken at a toggle, where both meet the target.
    best = residuals.argmin(axis=0), np.arange(len(points))
    if not np.all(np.isfinite(residuals[best])):
        return None
    fixed = [np.full(len(points), complex(pivot)) for pivot in (linkage.input_pivot, linkage.output_pivot)]
    joints = np.array([found.a[best], found.b[best], found.p[best], *fixed])
    return _Driven(angles, signs[best[0]], residuals[best], joints)


def _targets(reference: float, driven: _Driven, way: Traversal) -> list[Target]:
    """Targets with input angles that continue from the mechanism's reference angle (degrees)."""
    angles = np.degrees(way.angles - way.angles[0]) + reference
    return [
        Target(index=k, input_angle=float(angle), residual=float(residual))
        for k, (angle, residual) in enumerate(zip(angles, driven.residuals, strict=True))
    ]


def _motion_checks(driven: _Driven, on_circuit: bool) -> list[Check]:
    """What the task itself demands."""
    residual = float(driven.residuals.max())
    return [
        Check(name="reaches_targets", passed=residual <= TARGET_REACHED, value=residual, limit=TARGET_REACHED),
        Check(name="same_circuit", passed=on_circuit),
    ]


def _choice_checks(problem: MotionProblem, driven: _Driven, size: float) -> list[Check]:
    """Whether the driven linkage keeps what the client fixed of each side: shares of the task's size, and radians."""
    pin_a, pin_b, point, o2, o4 = driven.joints
    checks = []
    for name, choices, pin, pivot in (
        ("input_side", problem.input_side, pin_a, o2[0]),
        ("output_side", problem.output_side, pin_b, o4[0]),
    ):
        if choices.count() == 0:
            continue
        link = pin - pivot
        gaps = [0.0]
        for found, stated in ((pivot, choices.fixed_pivot), (pin[0], choices.moving_pivot)):
            for value, wanted in zip((found.real, found.imag), stated or (None, None), strict=True):
                if wanted is not None:
                    gaps.append(abs(value - wanted) / size)
        if choices.link_angle is not None:
            gaps.append(_turn(link[0], choices.link_angle))
        for k, rotation in enumerate(choices.rotations or [], start=1):
            if rotation is not None:
                gaps.append(_turn(link[k] / link[0], rotation))
        if choices.coupler_vector is not None:
            vector = point[0] - pin[0]
            if choices.coupler_vector.length is not None:
                gaps.append(abs(abs(vector) - choices.coupler_vector.length) / size)
            if choices.coupler_vector.angle is not None:
                gaps.append(_turn(vector, choices.coupler_vector.angle))
        gap = float(max(gaps))
        checks.append(Check(name=name, passed=gap <= CHOICE_KEPT, value=gap, limit=CHOICE_KEPT))
    if problem.ground_line is not None:
        gap = max(abs(problem.ground_line.offset(complex(pivot))) for pivot in (o2[0], o4[0])) / size
        checks.append(Check(name="ground_line", passed=gap <= CHOICE_KEPT, value=gap, limit=CHOICE_KEPT))
    return checks


def _turn(vector: complex, degrees: float) -> float:
    """Angle between a vector and a direction, radians, 0 to π."""
    return abs(cmath.phase(vector * cmath.exp(-1j * math.radians(degrees))))


def _constraint_checks(
    constraints: Constraints, links: FourbarLinks, driven: _Driven, metrics: LinkageMetrics
) -> list[Check]:
    """The client's constraints."""
    checks = []
    if constraints.same_branch:
        checks.append(Check(name="same_branch", passed=metrics.same_branch))
    if constraints.in_order:
        checks.append(Check(name="visits_in_order", passed=metrics.visits_in_order))
    if constraints.min_transmission_angle is not None:
        checks.append(
            _at_least("transmission_angle", metrics.min_transmission_angle, constraints.min_transmission_angle)
        )
    if constraints.grashof != "any":
        wanted = "rocker_rocker" if constraints.grashof == "non_grashof" else constraints.grashof
        checks.append(Check(name="grashof", passed=metrics.grashof == wanted))
    if constraints.full_rotation:
        checks.append(Check(name="full_rotation", passed=metrics.full_rotation))
    if constraints.link_length is not None:
        lengths = links.ground, links.input, links.coupler, links.output
        if constraints.link_length.min > 0.0:
            checks.append(_at_least("shortest_link", min(lengths), constraints.link_length.min))
        if constraints.link_length.max is not None:
            checks.append(_at_most("longest_link", max(lengths), constraints.link_length.max))
    if constraints.max_link_ratio is not None:
        checks.append(_at_most("link_ratio", metrics.link_ratio, constraints.max_link_ratio))
    if constraints.fixed_pivot_region is not None:
        pivots = complex(driven.joints[3, 0]), complex(driven.joints[4, 0])
        checks.append(
            Check(name="fixed_pivot_region", passed=all(map(constraints.fixed_pivot_region.contains, pivots)))
        )
    if constraints.moving_pivot_region is not None:
        pins = complex(driven.joints[0, 0]), complex(driven.joints[1, 0])
        checks.append(
            Check(name="moving_pivot_region", passed=all(map(constraints.moving_pivot_region.contains, pins)))
        )
    return checks


def _at_least(name: str, value: float, limit: float) -> Check:
    return Check(name=name, passed=value >= limit * (1.0 - LIMIT_SLACK), value=value, limit=limit)


def _at_most(name: str, value: float, limit: float) -> Check:
    return Check(name=name, passed=value <= limit * (1.0 + LIMIT_SLACK), value=value, limit=limit)
