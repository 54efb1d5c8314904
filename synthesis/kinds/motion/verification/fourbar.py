"""Verification of the fourbar in closed form.

If all targets are exact, the target position of the coupler gives pin A, and with it the input angle; the linkage is
then driven to that angle in both assemblies, and its position is compared with the target. If targets are fitted, the
input at which the body comes nearest is searched in both assemblies. The motion between the targets is checked in
closed form: toggle angles and the minimum transmission angle over a range have closed-form expressions.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.errors import DimensionError
from kinematics.linkage.fourbar import BARKER, Fourbar, barker_type, find_transmission_extremes, positions, traverse
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.target_poses import TargetPoses
from synthesis.kinds.motion.verification.checks import DrivenLinkage, Side, build_linkage_design
from synthesis.kinds.motion.verification.nearest_pose import Motion, find_closest_inputs, is_as_near
from synthesis.model.linkage.answer import FourbarMechanism, LinkageDesign
from synthesis.model.linkage.conversion import DrivenFourbar, build_driven_fourbar, compute_body_shift
from synthesis.verification.body_motion import BodyMotion, compute_ease, measure_body_motion
from synthesis.verification.measures import (
    ROTATING_INPUT_CLASSES,
    list_link_lengths,
    measure_fourbar_reach,
    measure_linkage,
)

OWN_ASSEMBLY_FACTOR = 1.5
"""A fitted target is assigned to the reference's own assembly unless the other one is closer by this factor."""


class _TargetStates(NamedTuple):
    """The linkage at the targets: input angles, assembly signs, rotations of the body, and all joints there."""

    angles: Real
    assemblies: NDArray[np.int64]
    turns: Real
    joints: Complex


def verify_fourbar(problem: MotionProblem, mechanism: FourbarMechanism, target: TargetPoses) -> LinkageDesign | None:
    """Drive a fourbar through a problem's targets and measure it; see
    :mod:`~synthesis.kinds.motion.verification.verify`."""
    try:
        fourbar = build_driven_fourbar(mechanism)
    except DimensionError:
        return None
    linkage = fourbar.linkage
    kind = int(barker_type(linkage))
    # Type 0: the lengths cannot be assembled.
    if not kind:
        return None
    shift = compute_body_shift(mechanism, problem.positions[0].angle)
    met = (
        _drive_to_exact_targets(target, fourbar, shift)
        if target.exact_mask.all()
        else _drive_to_nearest(target, fourbar, shift)
    )
    # Exact targets determine the input; fitted ones need a search.
    if met is None:
        return None
    way = traverse(linkage, met.angles, met.assemblies)
    barker = BARKER[kind - 1]
    least = float(find_transmission_extremes(linkage, way.start, way.end)[0]) if way.same_branch else 0.0
    pin_a, pin_b, p, o2, o4 = met.joints
    driven = DrivenLinkage(
        p,
        met.turns,
        target.offsets(p, met.turns),
        Side(complex(o2[0]), pin_a),
        Side(complex(o4[0]), pin_b),
    )
    way_of_body = BodyMotion(abs(way.end - way.start))
    if way.same_branch:

        def compute_pose(inputs: Real) -> tuple[Complex, Real]:
            at = positions(linkage, inputs, int(met.assemblies[0]))
            return np.where(at.valid, at.p, np.nan), at.coupler_angle

        way_of_body = measure_body_motion(compute_pose, (way.start, way.end), p, met.turns, target.size, slides=False)
    inputs = np.degrees(way.angles)
    # Report angles in the turn of the reference, as the client knows it.
    inputs += 360.0 * np.round((mechanism.reference_input_angle - inputs[0]) / 360.0)
    away = math.radians(inputs[0]) - float(way.angles[0])
    measures = measure_linkage(
        list_link_lengths(mechanism),
        measure_fourbar_reach(linkage),
        target.size,
        {"coupler": least},
        met.joints,
        barker=barker,
        same_branch=way.same_branch,
        visits_in_order=way.in_order,
        full_rotation=barker.motion in ROTATING_INPUT_CLASSES,
        used=(way.start + away, way.end + away) if way.same_branch else None,
        eased=compute_ease(way_of_body.input_turn, way_of_body.excess),
    )
    return build_linkage_design(
        problem, mechanism, target, driven, measures, inputs, on_circuit=way.same_circuit, carried=way_of_body
    )


def _drive_to_exact_targets(target: TargetPoses, fourbar: DrivenFourbar, shift: float) -> _TargetStates | None:
    """Drive the linkage to the input that each target determines, in both assemblies; None if it is not assembled."""
    linkage = fourbar.linkage
    reference = positions(linkage, fourbar.reference, fourbar.assembly)
    if not reference.valid:
        return None
    coupler_angles = target.turns + (float(reference.coupler_angle) - shift)
    pins = target.points - complex(linkage.coupler_point) * np.exp(1j * coupler_angles)
    angles = np.angle(pins - complex(linkage.input_pivot))
    signs = np.array([fourbar.assembly, -fourbar.assembly])
    driven = positions(linkage, angles, signs)
    off = driven.coupler_angle - coupler_angles
    # Compare angles modulo a full turn, in the same scale as distances in task sizes.
    turned_off = np.abs(off - 2.0 * np.pi * np.round(off / (2.0 * np.pi)))
    residuals = np.where(driven.valid, np.maximum(np.abs(driven.p - target.points) / target.size, turned_off), np.inf)
    # The first target must be met by the reference configuration itself.
    first = abs(complex(reference.p) - target.points[0]) / target.size
    off_reference = residuals[0, 0] < first
    residuals[0, 0] = max(residuals[0, 0], first)
    residuals[1, 0] = np.inf
    # The reference's own assembly comes first, so argmin prefers it at a toggle, where both meet the target.
    best = residuals.argmin(axis=0), np.arange(len(target.points))
    if not np.all(np.isfinite(residuals[best])):
        return None
    turns = driven.coupler_angle[best] - reference.coupler_angle + shift
    points = driven.p[best]
    if off_reference:
        points[0], turns[0] = reference.p, shift
    return _TargetStates(angles, signs[best[0]], turns, _stack_joints(linkage, driven.a[best], driven.b[best], points))


def _drive_to_nearest(target: TargetPoses, fourbar: DrivenFourbar, shift: float) -> _TargetStates | None:
    """Drive the linkage to the input at which the body is nearest to each target; None if it cannot be assembled."""
    linkage = fourbar.linkage
    reference = positions(linkage, fourbar.reference, fourbar.assembly)
    if not reference.valid:
        return None
    signs = np.array([fourbar.assembly, -fourbar.assembly])

    def make_motion(assembly: int) -> Motion:
        def compute_pose(inputs: Real) -> tuple[Complex, Real]:
            at = positions(linkage, inputs.ravel(), assembly)
            p = np.where(at.valid, at.p, np.nan).reshape(inputs.shape)
            return p, (at.coupler_angle - reference.coupler_angle + shift).reshape(inputs.shape)

        return compute_pose

    closest = [find_closest_inputs(make_motion(int(sign)), target, -math.pi, math.pi) for sign in signs]
    misses = np.stack([missed for _, missed in closest])
    row = np.where(misses[0] <= OWN_ASSEMBLY_FACTOR * misses[1], 0, 1)
    # The first target defines the reference, hence its assembly.
    row[0] = 0
    angles = np.stack([inputs for inputs, _ in closest])[row, np.arange(len(row))]
    # The minimum of a smooth deviation is known to half of the digits only; the reference input is exact.
    if is_as_near(make_motion(fourbar.assembly), target, 0, fourbar.reference, float(angles[0])):
        angles[0] = fourbar.reference
    if not np.all(np.isfinite(angles)):
        return None
    at = positions(linkage, angles, signs)
    best = row, np.arange(len(row))
    turns = at.coupler_angle[best] - reference.coupler_angle + shift
    return _TargetStates(angles, signs[row], turns, _stack_joints(linkage, at.a[best], at.b[best], at.p[best]))


def _stack_joints(linkage: Fourbar, a: Complex, b: Complex, p: Complex) -> Complex:
    fixed = [np.full(len(p), complex(pivot)) for pivot in (linkage.input_pivot, linkage.output_pivot)]
    return np.array([a, b, p, *fixed])
