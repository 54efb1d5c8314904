"""Verification of any linkage by its loop closures: slider-cranks, sixbars, and fourbars with a driver dyad.

The analysis core finds the branches of the mechanism by root finding; on each of them the input at which the body is
nearest to each target is searched. A target that several branches meet equally well is assigned to the reference's own
branch. The motion is then one input range on one branch. Over it, or over the whole cycle of a driver's crank, the
minimum transmission angle at each closure is measured.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.errors import MechanismError
from kinematics.linkage.planar.branches import Branch, compute_cycle_on_branch
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import find_branches, find_limit_positions, find_reference_branch
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from kinematics.linkage.refined_extremes import GRID_SIZE, find_min_transmission_angles
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.target_poses import TargetPoses
from synthesis.kinds.motion.verification.chain_match import measure_chain_gap
from synthesis.kinds.motion.verification.checks import DrivenLinkage, MeasuredRun, Side, build_linkage_design
from synthesis.kinds.motion.verification.nearest_pose import MISS_TOLERANCE, find_closest_inputs, is_as_near
from synthesis.model.answer import Check
from synthesis.model.linkage.answer import (
    InvertedSliderCrankMechanism,
    LinkageDesign,
    LinkageMechanism,
    MultiloopMechanism,
    SixbarMechanism,
    SliderCrankMechanism,
)
from synthesis.model.linkage.conversion import compute_body_shift
from synthesis.verification.body_motion import BodyMotion, compute_ease, measure_body_motion
from synthesis.verification.branch_drive import MechanismOnBranch
from synthesis.verification.checks import CHOICE_TOLERANCE, check_error
from synthesis.verification.constraints import check_zone
from synthesis.verification.measures import classify_inner_fourbar, list_link_lengths, measure_linkage, measure_reach
from synthesis.verification.reconstruction import rebuild_mechanism
from synthesis.verification.workspace import BODY_POINT, find_carrier

OWN_BRANCH_FACTOR = 1.5
"""A target is assigned to the reference's branch unless another branch is closer by this factor."""

LIMIT_TOLERANCE = 1e-7
"""Tolerance, radians, of the driven link's limits beyond its angles at the first and last target. At a limit its angle
varies with the square of the crank's, so this is far above rounding and far below any visible motion."""

END_RANGE, END_SAMPLE_COUNT, END_REFINEMENT_COUNT = 0.1, 33, 6
"""Search for the crank's dead centre around the last target: range in radians, number of samples, number of grids, each
32 times finer, down to 1e-10 radians. The range is wide because the nearest input is known only to a few hundredths of
a radian if the body turns about a point that the linkage holds nearly still."""

DRIVER_LINK = "driver_coupler"
"""Name of the link of a driver dyad."""

RANGE_SAMPLE_COUNT = 721
"""Number of inputs at which the driven link's rotation is sampled."""


class _TargetStates(NamedTuple):
    """Configurations at the targets: inputs, and index of the branch in the list of all branches."""

    inputs: Real
    rows: NDArray[np.int64]


class _InputRun(NamedTuple):
    """The motion through the targets: inputs in one continuous run, and whether they are met in order."""

    inputs: Real
    in_order: bool


def verify_mechanism(problem: MotionProblem, design: LinkageMechanism, target: TargetPoses) -> LinkageDesign | None:
    """Drive a linkage through a problem's targets and measure it; see
    :mod:`~synthesis.kinds.motion.verification.verify`."""
    mechanism = rebuild_mechanism(design)
    if mechanism is None:
        return None
    try:
        listed = find_branches(mechanism)
    except MechanismError:
        return None
    here = find_reference_branch(mechanism, listed)
    if here is None:
        return None
    shift = compute_body_shift(design, problem.positions[0].angle)
    bodies = [_Body(mechanism, branch, shift) for branch in listed]
    own = listed.index(here)
    met = _find_closest(bodies, target, own)
    if met is None:
        return None
    same_branch = bool(np.all(met.rows == own))
    way = _order_inputs(mechanism, here, met.inputs) if same_branch else _InputRun(met.inputs, False)
    joints, turns = _collect_joints(bodies, met)
    driven = _describe_sides(design, mechanism, joints, turns, target)
    # A driver's crank turns through its whole cycle; other inputs only through the used range.
    whole = DRIVER_LINK in mechanism.links
    used = (here.low, here.high) if whole else (float(way.inputs.min()), float(way.inputs.max()))
    slides = mechanism.has_slide_input
    way_of_body = BodyMotion()
    if same_branch:
        span = float(way.inputs.min()), float(way.inputs.max())
        way_of_body = measure_body_motion(bodies[own].pose, span, joints["P"], turns, target.size, slides=slides)
    measures = measure_linkage(
        list_link_lengths(design),
        measure_reach(mechanism),
        target.size,
        find_min_transmission_angles(bodies[own].evaluate_motion, np.linspace(*used, GRID_SIZE)) if same_branch else {},
        np.array(list(joints.values())),
        barker=classify_inner_fourbar(mechanism) if isinstance(design, MultiloopMechanism) else None,
        same_branch=same_branch,
        visits_in_order=way.in_order,
        full_rotation=here.full,
        used=(used if whole else (float(way.inputs[0]), float(way.inputs[-1]))) if same_branch else None,
        slides=slides,
        eased=compute_ease(way_of_body.input_turn, way_of_body.excess),
    )
    on_circuit = bool(all(listed[row].circuit == here.circuit for row in met.rows))
    run = MeasuredRun(way.inputs if slides else np.degrees(way.inputs), on_circuit, way_of_body, slides)
    type_checks = _check_sixbar(problem, design, mechanism, here, way, joints, target)
    return build_linkage_design(problem, design, target, driven, measures, run, type_checks)


class _Body(MechanismOnBranch):
    """The body on the link with P, on one branch; rotated by ``shift`` from the first target pose, radians."""

    def __init__(self, mechanism: Mechanism, branch: Branch, shift: float) -> None:
        super().__init__(mechanism, branch)
        self._link = find_carrier(mechanism)
        self._first = float(mechanism.link_angle(self._link)) - shift

    def pose(self, inputs: Real) -> tuple[Complex, Real]:
        """Return P and the body's rotation from the first target pose, at inputs of any shape."""
        motion = self.evaluate_motion(inputs.ravel())
        points = motion.joints["P"][0].reshape(inputs.shape)
        return points, (motion.angles[self._link][0] - self._first).reshape(inputs.shape)


def _find_closest(bodies: list[_Body], target: TargetPoses, own: int) -> _TargetStates | None:
    """Find the inputs at which the targets are met best, on the reference's branch if that is as good as any."""
    # Own branch first, so that index 0 means the reference's branch.
    rows = [own, *(n for n, body in enumerate(bodies) if n != own and body.branch.signs)]
    inputs, misses = [], []
    for n in rows:
        at, missed = find_closest_inputs(bodies[n].pose, target, *bodies[n].range)
        inputs.append(at)
        misses.append(missed)
    missed = np.stack(misses)
    best = missed.argmin(axis=0)
    best = np.where(missed[0] <= OWN_BRANCH_FACTOR * missed.min(axis=0) + MISS_TOLERANCE, 0, best)
    # The reference is the first target's configuration, so the first target must be met on its branch.
    best[0] = 0
    columns = np.arange(missed.shape[1])
    at = np.stack(inputs)[best, columns]
    # At a rest of the body the nearest input is known to half of its digits only; the reference input is exact.
    home = float(bodies[own].mechanism.reference_input)
    if is_as_near(bodies[own].pose, target, 0, home, at[0]):
        at[0] = home
    # A driver's last target is a dead centre of its crank, which can be located more exactly.
    if DRIVER_LINK in bodies[own].mechanism.links and best[-1] == 0 and math.isfinite(at[-1]):
        end = _find_dead_centre(bodies[own], float(at[-1]))
        if end is not None and is_as_near(bodies[own].pose, target, -1, end, at[-1]):
            at[-1] = end
    return _TargetStates(at, np.array(rows)[best]) if np.all(np.isfinite(at)) else None


def _find_dead_centre(body: _Body, near: float) -> float | None:
    """Find the input near a given one at which a driver's crank and its link are collinear; None if there is none."""
    low, high = near - END_RANGE, near + END_RANGE
    for _ in range(END_REFINEMENT_COUNT):
        inputs = np.linspace(low, high, END_SAMPLE_COUNT)
        joints = body.evaluate_motion(inputs).joints
        crank, link = joints["D"][0] - joints["O6"][0], joints["C"][0] - joints["D"][0]
        across = (crank.conjugate() * link).imag
        # No sign change: crank and link are never collinear nearby.
        passed = np.flatnonzero(across[:-1] * across[1:] <= 0.0)
        if not len(passed):
            return None
        k = passed[np.argmin(np.abs(inputs[passed] - near))]
        low, high = inputs[k], inputs[k + 1]
    return float(0.5 * (low + high))


def _order_inputs(mechanism: Mechanism, here: Branch, inputs: Real) -> _InputRun:
    """Arrange the inputs in one run through the targets; on a full branch in the direction that meets them in order."""
    if not here.full or mechanism.has_slide_input:
        # Without a full rotation there is only one way through the inputs.
        steps = np.diff(inputs)
        return _InputRun(inputs, bool(np.all(steps > 0.0) or np.all(steps < 0.0)))
    period = compute_cycle_on_branch(mechanism, here)
    onward = np.mod(inputs - inputs[0], period)
    onward[0] = 0.0
    backward = np.where(onward > 0.0, onward - period, 0.0)
    ways = [way for way in (onward, backward) if np.all(np.diff(way) > 0.0) or np.all(np.diff(way) < 0.0)]
    if not ways:
        return _InputRun(inputs, False)
    # Both directions meet the targets in order: take the shorter run.
    return _InputRun(inputs[0] + min(ways, key=lambda way: abs(float(way[-1]))), True)


def _collect_joints(bodies: list[_Body], met: _TargetStates) -> tuple[dict[str, Complex], Real]:
    """Return all joints and the body's rotations at the targets."""
    joints: dict[str, list[complex]] = {}
    turns = []
    for at, row in zip(met.inputs[:, None], met.rows, strict=True):
        for name, point in bodies[row].evaluate_motion(at).joints.items():
            joints.setdefault(name, []).append(complex(point[0, 0]))
        turns.append(float(bodies[row].pose(at)[1][0]))
    return {name: np.array(points) for name, points in joints.items()}, np.array(turns)


def _describe_sides(
    design: LinkageMechanism, mechanism: Mechanism, joints: dict[str, Complex], turns: Real, target: TargetPoses
) -> DrivenLinkage:
    """Describe the linkage at the targets by its two sides."""
    link = Side(complex(joints["O2"][0]), joints["A"])
    if isinstance(design, SliderCrankMechanism):
        slide = Side(None, joints["B"], math.radians(design.slide.angle))
        sides = (slide, link) if design.driven_by == "slider" else (link, slide)
    elif isinstance(design, InvertedSliderCrankMechanism):
        sides = (link, Side(complex(joints["O4"][0]), None, float(mechanism.slides[0].angle)))
    else:
        sides = (link, Side(complex(joints["O4"][0]), joints["B"]))
    offsets = target.offsets(joints["P"], turns)
    if isinstance(design, MultiloopMechanism) and DRIVER_LINK not in mechanism.links:
        ground = mechanism.links[GROUND]
        fixed = [complex(joints[name][0]) for name in ground]
        moving = [complex(joints[name][0]) for name in joints if name != BODY_POINT and name not in ground]
        return DrivenLinkage(joints["P"], turns, offsets, *sides, pivots=(fixed, moving))
    return DrivenLinkage(joints["P"], turns, offsets, *sides)


def _check_sixbar(
    problem: MotionProblem,
    design: LinkageMechanism,
    mechanism: Mechanism,
    here: Branch,
    way: _InputRun,
    joints: dict[str, Complex],
    target: TargetPoses,
) -> list[Check]:
    """Return the checks of a sixbar: those of its driver, or of the chain that carries the body."""
    if not isinstance(design, SixbarMechanism):
        return []
    if DRIVER_LINK in mechanism.links:
        return _check_driver(problem, design, mechanism, here, way)
    if problem.chain is None:
        return []
    gap = measure_chain_gap(problem.chain, mechanism.links, joints, target.size)
    return [check_error("chain", gap, CHOICE_TOLERANCE)]


def _check_driver(
    problem: MotionProblem, design: SixbarMechanism, mechanism: Mechanism, here: Branch, way: _InputRun
) -> list[Check]:
    """Check that a driver's crank rotates fully and its driven link has its limits at the first and last target."""
    held = next(name for name, listed in mechanism.links.items() if "C" in listed and name != DRIVER_LINK)
    # A driven coupler may reverse its rotation; the fourbar's input does not, so measure that instead.
    driven = "input" if held == "coupler" else held
    run = np.linspace(way.inputs[0], way.inputs[-1], RANGE_SAMPLE_COUNT)
    turned = np.unwrap(drive(mechanism, run, order=0).angles[driven][0])
    (span,), _ = find_limit_positions(mechanism, here, [driven], [])
    # Both end positions lie within the swing, so comparing its size with their difference is sufficient.
    beyond = math.inf if span is None else (span[1] - span[0]) - abs(float(turned[-1] - turned[0]))
    checks = [
        Check(name="crank_turns", passed=here.full),
        check_error("limits", beyond, LIMIT_TOLERANCE),
    ]
    wanted = problem.driver
    if wanted is not None and wanted.pivot_region is not None:
        checks.append(check_zone("driver_pivot_region", wanted.pivot_region, [complex(*design.fixed_pivots["O6"])]))
    return checks
