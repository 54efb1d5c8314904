"""Checks and report of a linkage that carries a body: targets, motion, and the client's choices for its sides."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices
from synthesis.kinds.motion.task.target_poses import TargetPoses
from synthesis.model.answer import Check, Verification
from synthesis.model.linkage.answer import LinkageDesign, LinkageMechanism, LinkageMetrics, Target
from synthesis.results.remarks import write_quantity
from synthesis.verification.body_motion import BodyMotion
from synthesis.verification.checks import CHOICE_TOLERANCE, check_error, check_maximum, check_targets_reached
from synthesis.verification.constraints import check_constraints
from synthesis.verification.measures import Measures


class Side(NamedTuple):
    """One dyad as measured on the driven linkage.

    Attributes
    ----------
    pivot : complex or None
        The fixed pivot; None if the pin slides on the ground.
    pins : complex, shape (targets,), or None
        The moving pivot at the targets; None if a line of the body slides through the pivot's block.
    slide_angle : float or None
        Angle of the slide's line at the first target, radians; None for a link with two pins.
    """

    pivot: complex | None
    pins: Complex | None
    slide_angle: float | None = None


class DrivenLinkage(NamedTuple):
    """Measurements of the driven linkage at the targets.

    Attributes
    ----------
    points, turns : complex and float, shape (targets,)
        P, and the body's rotation from the first target position, radians.
    offsets : float, shape (targets, 3)
        Deviations in x, y (length units) and angle (radians).
    input_side, output_side : Side
        The dyads.
    pivots : (list of complex, list of complex), optional
        All fixed and all moving pivots at the first target, for a linkage with more pivots than those of its sides.
    """

    points: Complex
    turns: Real
    offsets: Real
    input_side: Side
    output_side: Side
    pivots: tuple[list[complex], list[complex]] | None = None

    @property
    def fixed_pivots(self) -> list[complex]:
        """All fixed pivots."""
        if self.pivots is not None:
            return self.pivots[0]
        return [side.pivot for side in (self.input_side, self.output_side) if side.pivot is not None]

    @property
    def moving_pivots(self) -> list[complex]:
        """All moving pivots at the first target."""
        if self.pivots is not None:
            return self.pivots[1]
        return [complex(side.pins[0]) for side in (self.input_side, self.output_side) if side.pins is not None]


class MeasuredRun(NamedTuple):
    """Motion of the input through the targets.

    Attributes
    ----------
    inputs : float, shape (targets,)
        Inputs at the targets, in one run: degrees, or length units if the input slides.
    on_circuit : bool
        Whether all targets are met on one circuit.
    carried : BodyMotion
        Measurements of the body's motion from the first target to the last.
    slides : bool
        Whether the input slides.
    """

    inputs: Real
    on_circuit: bool
    carried: BodyMotion
    slides: bool = False


def build_linkage_design(
    problem: MotionProblem,
    mechanism: LinkageMechanism,
    target: TargetPoses,
    driven: DrivenLinkage,
    measures: Measures,
    run: MeasuredRun,
    own: Sequence[Check] = (),
) -> LinkageDesign:
    """Build the design of a driven linkage of any type, with its verification and metrics.

    Parameters
    ----------
    problem : MotionProblem
        The problem.
    mechanism : LinkageMechanism
        The dimensions that were driven.
    target, driven, measures
        Target poses of the body, and the measured values.
    run : MeasuredRun
        The motion through the targets.
    own : sequence of Check
        Checks of the linkage's type.
    """
    inputs, on_circuit, carried, slides = run
    travelled = float(inputs[-1] - inputs[0])
    return LinkageDesign(
        mechanism=mechanism,
        targets=_list_targets(inputs, target, driven, slides=slides),
        verification=Verification.from_checks(
            [
                *_check_motion(problem, target, driven, on_circuit),
                *_check_choices(problem, target, driven),
                *check_constraints(problem.constraints, measures, driven.fixed_pivots, driven.moving_pivots),
                *own,
            ]
        ),
        metrics=LinkageMetrics(
            input_rotation=None if slides else travelled,
            input_stroke=travelled if slides else None,
            input_travel=None if slides else math.degrees(carried.input_turn),
            body_travel_ratio=carried.travel_ratio,
            body_turn_ratio=carried.turn_ratio,
            rms_residual=target.rms(driven.offsets),
            **measures.select_fields(LinkageMetrics),
        ),
    )


def _list_targets(inputs: Real, target: TargetPoses, driven: DrivenLinkage, *, slides: bool) -> list[Target]:
    """List the targets with their residuals; inputs in degrees, or in length units if the input slides."""
    residuals = target.residuals(driven.offsets)
    return [
        Target(
            index=k,
            input_angle=None if slides else float(at),
            input_place=float(at) if slides else None,
            residual=float(residual),
            point_residual=math.hypot(offset[0], offset[1]),
            angle_residual=math.degrees(abs(offset[2])),
        )
        for k, (at, residual, offset) in enumerate(zip(inputs, residuals, driven.offsets, strict=True))
    ]


def _check_motion(problem: MotionProblem, target: TargetPoses, driven: DrivenLinkage, on_circuit: bool) -> list[Check]:
    """Check the task itself: exact coordinates are met, others are within tolerance, all on one circuit."""
    checks = []
    if target.exact_mask.any():
        # Only exact coordinates count here; tolerances have a check of their own.
        held = np.where(target.exact_mask, driven.offsets, 0.0)
        reached = check_targets_reached(float(target.residuals(held).max()))
        checks.append(reached.model_copy(update={"detail": _describe_fitted_positions(problem, target, driven)}))
    tolerated = np.isfinite(target.limits) & ~target.exact_mask
    if tolerated.any():
        used = float(np.max(np.abs(driven.offsets[tolerated]) / target.limits[tolerated]))
        checks.append(check_maximum("within_tolerance", used, 1.0))
    return [*checks, Check(name="same_circuit", passed=on_circuit)]


def _describe_fitted_positions(problem: MotionProblem, target: TargetPoses, driven: DrivenLinkage) -> str | None:
    """Describe how far the fitted positions are missed; None if none is fitted."""
    fitted = np.asarray(~np.isfinite(target.limits).all(axis=-1))
    if not fitted.any():
        return None
    offsets = driven.offsets[fitted]
    distance = write_quantity(f"{np.hypot(offsets[:, 0], offsets[:, 1]).max():.3g}", problem.length_unit)
    angle = f"{math.degrees(np.abs(offsets[:, 2]).max()):.3g}"
    return compose(
        "motion-exact-positions-only", exact=int((~fitted).sum()), count=len(fitted), distance=distance, angle=angle
    )


def _check_choices(problem: MotionProblem, target: TargetPoses, driven: DrivenLinkage) -> list[Check]:
    """Check the client's choices for each side; deviations in shares of the task's size, and in radians.

    Points and lines of the body are compared with the body in the first target position, which a fit may miss.
    """
    # Undo the deviation of the first pose, so that body points are compared in the target position.
    back = cmath.exp(-1j * float(driven.turns[0]))
    checks = []
    for name, choices, side in (
        ("input_side", problem.input_side, driven.input_side),
        ("output_side", problem.output_side, driven.output_side),
    ):
        # A side without choices has nothing to compare.
        if choices.count() == 0:
            continue
        point = complex(target.points[0])
        pin = None if side.pins is None else point + back * complex(side.pins[0] - driven.points[0])
        if side.pins is None and side.slide_angle is not None:  # RP: the line belongs to the body and turns with it
            side = side._replace(slide_angle=side.slide_angle - float(driven.turns[0]))
        gap = max(_list_gaps(choices, side, point, pin, target.size))
        checks.append(check_error(name, gap, CHOICE_TOLERANCE))
    if problem.ground_line is not None:
        gap = max(abs(problem.ground_line.offset(pivot)) for pivot in driven.fixed_pivots) / target.size
        checks.append(check_error("ground_line", gap, CHOICE_TOLERANCE))
    return checks


def _list_gaps(choices: DyadChoices, side: Side, point: complex, pin: complex | None, size: float) -> list[float]:
    """List the deviations from each given number; infinite if the dyad lacks that element."""
    gaps = [0.0]
    for pivot, stated in ((side.pivot, choices.fixed_pivot), (pin, choices.moving_pivot)):
        # A missing pivot misses every given coordinate.
        coordinates = (math.inf, math.inf) if pivot is None else (pivot.real, pivot.imag)
        for value, wanted in zip(coordinates, stated or (None, None), strict=True):
            if wanted is not None:
                gaps.append(abs(value - wanted) / size)
    if choices.slide_angle is not None:
        turned = math.inf if side.slide_angle is None else side.slide_angle - math.radians(choices.slide_angle)
        # Lines have no direction, so compare modulo half a turn.
        gaps.append(abs(math.remainder(turned, math.pi)) if math.isfinite(turned) else math.inf)
    links = None if side.pivot is None or side.pins is None else side.pins - side.pivot
    if choices.link_angle is not None:
        gaps.append(math.inf if links is None else _measure_turn(complex(links[0]), choices.link_angle))
    for k, rotation in enumerate(choices.rotations or [], start=1):
        if rotation is not None:
            gaps.append(math.inf if links is None else _measure_turn(complex(links[k] / links[0]), rotation))
    if choices.coupler_vector is not None:
        length, angle = choices.coupler_vector.length, choices.coupler_vector.angle
        if length is not None:
            gaps.append(math.inf if pin is None else abs(abs(point - pin) - length) / size)
        if angle is not None:
            gaps.append(math.inf if pin is None else _measure_turn(point - pin, angle))
    return gaps


def _measure_turn(vector: complex, degrees: float) -> float:
    """Return the angle between a vector and a direction, radians, 0 to π."""
    return abs(cmath.phase(vector * cmath.exp(-1j * math.radians(degrees))))
