"""Verify quick-return mechanisms: drive the finished mechanism and find its limit positions.

None of the solvers' formulas is used: the output's rate over a turn of the crank comes from the analysis core, its
roots are the limit positions, and time ratio, swing and stroke follow from these.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from kinematics.errors import MechanismError
from kinematics.linkage.fourbar import Fourbar, barker_class
from kinematics.linkage.fourbar.classification import BarkerClass
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import find_branches, find_reference_branch
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.linkage.planar.strokes import Strokes, find_strokes
from kinematics.linkage.refined_extremes import find_min_transmission_angles, list_full_turn
from synthesis.kinds.quick_return.design import (
    DragLinkMechanism,
    LimitPosition,
    QuickReturnDesign,
    QuickReturnMechanisms,
    QuickReturnMetrics,
)
from synthesis.kinds.quick_return.problem import QuickReturnProblem, RockerPosition
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ANGLE
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.verification.checks import check_error
from synthesis.verification.constraints import check_constraints
from synthesis.verification.measures import (
    list_fixed_pivots,
    list_link_lengths,
    list_moving_pivots,
    measure_linkage,
    measure_reach,
)
from synthesis.verification.reconstruction import rebuild_mechanism

RATIO_TOLERANCE = 1e-9
"""Maximum relative error of the measured time ratio; rounding leaves some 1e-14."""

SWING_TOLERANCE = 1e-9
"""Maximum error of the measured swing, degrees."""

BODY_TOLERANCE = 1e-9
"""Maximum error of the positions of a body on the rocker: share of its distance from the rocker's pivot, and
radians."""

STROKE_TOLERANCE = 1e-9
"""Maximum relative error of the measured stroke."""

OUTPUT_NAMES = {
    "fourbar": "output",
    "slider_crank": "B",
    "crank_shaper": "D",
    "whitworth": "D",
    "drag_link_rocker": "output",
    "drag_link_slider": "C",
}
"""The output of each type: a link that swings, or the joint of a slide."""


def verify_quick_return(problem: QuickReturnProblem, design: QuickReturnMechanisms) -> QuickReturnDesign | None:
    """Drive a mechanism through a turn of its crank and measure it.

    Parameters
    ----------
    problem : QuickReturnProblem
        The problem.
    design : a mechanism
        Only the dimensions are used; for drag links these are the skeleton.

    Returns
    -------
    QuickReturnDesign or None
        None unless the output reverses exactly twice while the crank turns through.
    """
    output = OUTPUT_NAMES[design.type]
    mechanism = rebuild_mechanism(design)
    if mechanism is None:
        return None
    # Only the skeleton contains the body's place on the rocker.
    carrier = None if problem.positions is None else rebuild_mechanism(design, from_skeleton=True)
    if problem.positions is not None and carrier is None:
        return None
    try:
        here = find_reference_branch(mechanism, find_branches(mechanism))
        reversals = find_strokes(mechanism, output)
    except MechanismError:
        return None
    # An output with more than two reversals has no time ratio.
    if reversals is None or here is None or not here.full:
        return None
    inputs = list_full_turn(float(mechanism.reference_input))
    motion = drive(mechanism, inputs, order=1)
    # The point of a body on the rocker is a joint of it, as the point of a coupler is.
    whole = mechanism if carrier is None else carrier
    places = motion.joints if carrier is None else drive(carrier, inputs, order=0).joints
    turns = bool(motion.smooth.all())
    swings = output in mechanism.links
    travel = math.degrees(reversals.travel) if swings else reversals.travel
    measures = measure_linkage(
        list_link_lengths(design),
        measure_reach(whole),
        # Displacement of the output's pin, as the chord of its arc or along its slide.
        2.0 * _get_rocker_length(design) * abs(math.sin(0.5 * reversals.travel)) if swings else travel,
        find_min_transmission_angles(partial(drive, mechanism, order=0), inputs, motion),
        np.concatenate([jet[0] for jet in places.values()]),
        barker=_classify_fourbar(design),
        same_branch=turns,
        visits_in_order=turns,  # the output reverses twice in a turn: there is one order
        full_rotation=turns,
        used=(float(inputs[0]), float(inputs[-1])),
    )
    metrics = QuickReturnMetrics(
        time_ratio=reversals.time_ratio,
        slow_rotation=math.degrees(reversals.slow),
        fast_rotation=math.degrees(reversals.fast),
        swing=travel if swings else None,
        stroke=None if swings else travel,
        **measures.select_fields(QuickReturnMetrics),
    )
    checks = [
        *_check_task(problem, metrics),
        *_check_body(problem, design, carrier, reversals),
        *check_constraints(problem.constraints, measures, list_fixed_pivots(mechanism), list_moving_pivots(mechanism)),
    ]
    return QuickReturnDesign(
        mechanism=design,
        targets=_list_limits(reversals, float(mechanism.reference_input), swings=swings),
        verification=Verification.from_checks(checks),
        metrics=metrics,
    )


def _list_limits(measured: Strokes, reference: float, *, swings: bool) -> list[LimitPosition]:
    """Return the two limit positions of the output as they are reported.

    Input angles belong to the turn in which the first position is nearest to the reference. Angles of links start in
    (−180°, 180°].
    """
    inputs = measured.inputs - 2.0 * math.pi * round((measured.inputs[0] - reference) / (2.0 * math.pi))
    outputs = measured.outputs
    if swings:
        outputs = np.degrees(outputs - 2.0 * math.pi * math.ceil(outputs[0] / (2.0 * math.pi) - 0.5))
    return [LimitPosition(index=k, input_angle=math.degrees(inputs[k]), output=float(outputs[k])) for k in range(2)]


def _check_task(problem: QuickReturnProblem, metrics: QuickReturnMetrics) -> list[Check]:
    off = abs(metrics.time_ratio / problem.time_ratio - 1.0)
    checks = [
        Check(name="crank_turns", passed=metrics.full_rotation),
        check_error("time_ratio", off, RATIO_TOLERANCE),
    ]
    if problem.swing_angle is not None:
        off = math.inf if metrics.swing is None else abs(metrics.swing - problem.swing_angle)
        checks.append(check_error("swing", off, SWING_TOLERANCE, ANGLE))
    if problem.stroke is not None:
        off = math.inf if metrics.stroke is None else abs(metrics.stroke / problem.stroke - 1.0)
        checks.append(check_error("stroke", off, STROKE_TOLERANCE))
    return checks


def _check_body(
    problem: QuickReturnProblem, design: QuickReturnMechanisms, mechanism: Mechanism | None, measured: Strokes
) -> list[Check]:
    """Check that the body on the rocker stands at its two positions when the driven rocker is at its limits.

    The place of the body on the rocker is taken from the skeleton, its only source.
    """
    if problem.positions is None:
        return []
    assert isinstance(design, FourbarMechanism)
    assert mechanism is not None
    motion = drive(mechanism, measured.inputs, order=0)
    points = motion.joints["C"][0]
    turned = motion.angles["output"][0] - mechanism.link_angle("output")
    angles = (design.reference_body_angle or 0.0) + np.degrees(turned)
    size = max(abs(position.point - complex(*design.fixed_pivots.output)) for position in problem.positions)
    # A body near its pole has almost no extent, so the output link gives the minimum size.
    size = max(size, design.links.output)

    def measure_miss(k: int, position: RockerPosition) -> float:
        turn = math.radians(math.remainder(angles[k] - position.angle, 360.0))
        return max(float(abs(points[k] - position.point)) / size, abs(turn))

    first, second = problem.positions
    # Either position may begin the slow stroke.
    worst = min(max(measure_miss(k, first), measure_miss(1 - k, second)) for k in (0, 1))
    return [check_error("reaches_targets", worst, BODY_TOLERANCE)]


def _get_rocker_length(design: QuickReturnMechanisms) -> float:
    """Return the length of the output link of a mechanism whose output swings."""
    return design.links["output"] if isinstance(design.links, dict) else float(design.links.model_dump()["output"])


def _classify_fourbar(design: QuickReturnMechanisms) -> BarkerClass | None:
    """Return Grashof's class and Barker's code of the fourbar that the crank drives."""
    if isinstance(design, FourbarMechanism):
        d, a, b, c = list_link_lengths(design)
    elif isinstance(design, DragLinkMechanism):
        d, a, b, c = (design.links[name] for name in ("ground", "input", "coupler", "driven_crank"))
    else:
        return None
    return barker_class(Fourbar.from_lengths(a, b, c, d))
