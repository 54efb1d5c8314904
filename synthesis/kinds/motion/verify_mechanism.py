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

from kinematics.errors import MechanismError
from kinematics.linkage.planar.branches import Branch, cycle_on
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import branches, holding_reference, limit_positions
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from synthesis.kinds.motion.chains import chain_gap
from synthesis.kinds.motion.checks import Driven, Side, linkage_design
from synthesis.kinds.motion.closest import SAME_MISS, as_near, closest_inputs
from synthesis.kinds.motion.demanded import Complex, Demanded, Real
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.answer import Check
from synthesis.model.linkage_answer import (
    InvertedSliderCrankMechanism,
    LinkageDesign,
    LinkageMechanism,
    SixbarMechanism,
    SliderCrankMechanism,
)
from synthesis.model.linkages import body_shift
from synthesis.proof.carried import Carried, carried, ease
from synthesis.proof.checks import CHOICE_KEPT, tolerated
from synthesis.proof.closer import GRID, least_angles
from synthesis.proof.constraints import within_zone
from synthesis.proof.measures import barker_within, link_lengths, measured, reach_of
from synthesis.proof.on_branch import OnBranch
from synthesis.proof.rebuilt import rebuilt
from synthesis.proof.space import BODY_POINT, carrier

OWN = 1.5
"""A target is assigned to the reference's branch unless another branch is closer by this factor."""

AT_LIMIT = 1e-7
"""Tolerance, radians, of the driven link's limits beyond its angles at the first and last target. At a limit its angle
varies with the square of the crank's, so this is far above rounding and far below any visible motion."""

END_WITHIN, END_SAMPLES, END_REFINEMENTS = 0.1, 33, 6
"""Search for the crank's dead centre around the last target: range in radians, number of samples, number of grids, each
32 times finer, down to 1e-10 radians. The range is wide because the nearest input is known only to a few hundredths of
a radian if the body turns about a point that the linkage holds nearly still."""

DRIVER = "driver_coupler"
"""Name of the link of a driver dyad."""

RANGE_GRID = 721
"""Number of inputs at which the driven link's rotation is sampled."""


class _Met(NamedTuple):
    """Configurations at the targets: inputs, and index of the branch in the list of all branches."""

    inputs: Real
    rows: NDArray[np.int64]


class _Way(NamedTuple):
    """The motion through the targets: inputs in one continuous run, and whether they are met in order."""

    inputs: Real
    in_order: bool


def verify_mechanism(problem: MotionProblem, design: LinkageMechanism, target: Demanded) -> LinkageDesign | None:
    """Drive a linkage through a problem's targets and measure it; see :mod:`~synthesis.kinds.motion.verification`."""
    mechanism = rebuilt(design)
    if mechanism is None:
        return None
    try:
        listed = branches(mechanism)
    except MechanismError:
        return None
    here = holding_reference(mechanism, listed)
    if here is None:
        return None
    shift = body_shift(design, problem.positions[0].angle)
    bodies = [_Body(mechanism, branch, shift) for branch in listed]
    own = listed.index(here)
    met = _closest(bodies, target, own)
    if met is None:
        return None
    same_branch = bool(np.all(met.rows == own))
    way = _way(mechanism, here, met.inputs) if same_branch else _Way(met.inputs, False)
    joints, turns = _at_targets(bodies, met)
    driven = _driven(design, mechanism, joints, turns, target)
    whole = DRIVER in mechanism.links
    used = (here.low, here.high) if whole else (float(way.inputs.min()), float(way.inputs.max()))
    slides = mechanism.driven_by_slide
    way_of_body = Carried()
    if same_branch:
        span = float(way.inputs.min()), float(way.inputs.max())
        way_of_body = carried(bodies[own].pose, span, joints["P"], turns, target.size, slides=slides)
    measures = measured(
        link_lengths(design),
        reach_of(mechanism),
        target.size,
        least_angles(bodies[own].at, np.linspace(*used, GRID)) if same_branch else {},
        np.array(list(joints.values())),
        barker=barker_within(mechanism) if isinstance(design, SixbarMechanism) else None,
        same_branch=same_branch,
        visits_in_order=way.in_order,
        full_rotation=here.full,
        used=(used if whole else (float(way.inputs[0]), float(way.inputs[-1]))) if same_branch else None,
        slides=slides,
        eased=ease(way_of_body.input_turn, way_of_body.excess),
    )
    return linkage_design(
        problem,
        design,
        target,
        driven,
        measures,
        way.inputs if slides else np.degrees(way.inputs),
        on_circuit=bool(all(listed[row].circuit == here.circuit for row in met.rows)),
        carried=way_of_body,
        slides=slides,
        own=_own_checks(problem, design, mechanism, here, way, joints, target),
    )


class _Body(OnBranch):
    """The body on the link with P, on one branch; rotated by ``shift`` from the first target pose, radians."""

    def __init__(self, mechanism: Mechanism, branch: Branch, shift: float) -> None:
        super().__init__(mechanism, branch)
        self._link = carrier(mechanism)
        self._first = float(mechanism.link_angle(self._link)) - shift

    def pose(self, inputs: Real) -> tuple[Complex, Real]:
        """Return P and the body's rotation from the first target pose, at inputs of any shape."""
        motion = self.at(inputs.ravel())
        points = motion.joints["P"][0].reshape(inputs.shape)
        return points, (motion.angles[self._link][0] - self._first).reshape(inputs.shape)


def _closest(bodies: list[_Body], target: Demanded, own: int) -> _Met | None:
    """Find the inputs at which the targets are met best, on the reference's branch if that is as good as any."""
    rows = [own, *(n for n, body in enumerate(bodies) if n != own and body.branch.signs)]
    inputs, misses = [], []
    for n in rows:
        at, missed = closest_inputs(bodies[n].pose, target, *bodies[n].range)
        inputs.append(at)
        misses.append(missed)
    missed = np.stack(misses)
    best = missed.argmin(axis=0)
    best = np.where(missed[0] <= OWN * missed.min(axis=0) + SAME_MISS, 0, best)
    # The reference is the first target's configuration, so the first target must be met on its branch.
    best[0] = 0
    columns = np.arange(missed.shape[1])
    at = np.stack(inputs)[best, columns]
    # At a rest of the body the nearest input is known to half of its digits only; the reference input is exact.
    home = float(bodies[own].mechanism.reference_input)
    if as_near(bodies[own].pose, target, 0, home, at[0]):
        at[0] = home
    if DRIVER in bodies[own].mechanism.links and best[-1] == 0 and math.isfinite(at[-1]):
        end = _dead_centre(bodies[own], float(at[-1]))
        if end is not None and as_near(bodies[own].pose, target, -1, end, at[-1]):
            at[-1] = end
    return _Met(at, np.array(rows)[best]) if np.all(np.isfinite(at)) else None


def _dead_centre(body: _Body, near: float) -> float | None:
    """Find the input near a given one at which a driver's crank and its link are collinear; None if there is none."""
    low, high = near - END_WITHIN, near + END_WITHIN
    for _ in range(END_REFINEMENTS):
        inputs = np.linspace(low, high, END_SAMPLES)
        joints = body.at(inputs).joints
        crank, link = joints["D"][0] - joints["O6"][0], joints["C"][0] - joints["D"][0]
        across = (crank.conjugate() * link).imag
        passed = np.flatnonzero(across[:-1] * across[1:] <= 0.0)
        if not len(passed):
            return None
        k = passed[np.argmin(np.abs(inputs[passed] - near))]
        low, high = inputs[k], inputs[k + 1]
    return float(0.5 * (low + high))


def _way(mechanism: Mechanism, here: Branch, inputs: Real) -> _Way:
    """Arrange the inputs in one run through the targets; on a full branch in the direction that meets them in order."""
    if not here.full or mechanism.driven_by_slide:
        steps = np.diff(inputs)
        return _Way(inputs, bool(np.all(steps > 0.0) or np.all(steps < 0.0)))
    period = cycle_on(mechanism, here)
    onward = np.mod(inputs - inputs[0], period)
    onward[0] = 0.0
    backward = np.where(onward > 0.0, onward - period, 0.0)
    ways = [way for way in (onward, backward) if np.all(np.diff(way) > 0.0) or np.all(np.diff(way) < 0.0)]
    if not ways:
        return _Way(inputs, False)
    return _Way(inputs[0] + min(ways, key=lambda way: abs(float(way[-1]))), True)


def _at_targets(bodies: list[_Body], met: _Met) -> tuple[dict[str, Complex], Real]:
    """Return all joints and the body's rotations at the targets."""
    joints: dict[str, list[complex]] = {}
    turns = []
    for at, row in zip(met.inputs[:, None], met.rows, strict=True):
        for name, point in bodies[row].at(at).joints.items():
            joints.setdefault(name, []).append(complex(point[0, 0]))
        turns.append(float(bodies[row].pose(at)[1][0]))
    return {name: np.array(points) for name, points in joints.items()}, np.array(turns)


def _driven(
    design: LinkageMechanism, mechanism: Mechanism, joints: dict[str, Complex], turns: Real, target: Demanded
) -> Driven:
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
    if isinstance(design, SixbarMechanism) and DRIVER not in mechanism.links:
        ground = mechanism.links[GROUND]
        fixed = [complex(joints[name][0]) for name in ground]
        moving = [complex(joints[name][0]) for name in joints if name != BODY_POINT and name not in ground]
        return Driven(joints["P"], turns, offsets, *sides, pivots=(fixed, moving))
    return Driven(joints["P"], turns, offsets, *sides)


def _own_checks(
    problem: MotionProblem,
    design: LinkageMechanism,
    mechanism: Mechanism,
    here: Branch,
    way: _Way,
    joints: dict[str, Complex],
    target: Demanded,
) -> list[Check]:
    """Return the checks of a sixbar: those of its driver, or of the chain that carries the body."""
    if not isinstance(design, SixbarMechanism):
        return []
    if DRIVER in mechanism.links:
        return _driver_checks(problem, design, mechanism, here, way)
    if problem.chain is None:
        return []
    gap = chain_gap(problem.chain, mechanism.links, joints, target.size)
    return [tolerated("chain", gap, CHOICE_KEPT)]


def _driver_checks(
    problem: MotionProblem, design: SixbarMechanism, mechanism: Mechanism, here: Branch, way: _Way
) -> list[Check]:
    """Check that a driver's crank rotates fully and its driven link has its limits at the first and last target."""
    held = next(name for name, listed in mechanism.links.items() if "C" in listed and name != DRIVER)
    # A driven coupler may reverse its rotation; the fourbar's input does not, so measure that instead.
    driven = "input" if held == "coupler" else held
    run = np.linspace(way.inputs[0], way.inputs[-1], RANGE_GRID)
    turned = np.unwrap(drive(mechanism, run, order=0).angles[driven][0])
    (span,), _ = limit_positions(mechanism, here, [driven], [])
    # Both end positions lie within the swing, so comparing its size with their difference is sufficient.
    beyond = math.inf if span is None else (span[1] - span[0]) - abs(float(turned[-1] - turned[0]))
    checks = [
        Check(name="crank_turns", passed=here.full),
        tolerated("limits", beyond, AT_LIMIT),
    ]
    wanted = problem.driver
    if wanted is not None and wanted.pivot_region is not None:
        checks.append(within_zone("driver_pivot_region", wanted.pivot_region, [complex(*design.fixed_pivots["O6"])]))
    return checks
