"""Motion generation by least squares: more positions than can be met exactly, or positions with tolerances.

Each of many starting dyads (:mod:`synthesis.kinds.motion.least_squares.starts`) is first fitted to all positions by
itself. The best pairs are then fitted together to the true error of the pose
(:mod:`synthesis.kinds.motion.least_squares.pose_fit`), and the linkages are driven and verified like any other. Exact
positions are met to rounding throughout. Lengths are weighted by the task's size and angles by the radian, or both by
the given tolerances.
"""

from __future__ import annotations

import math
from collections import Counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.message import compose, join_messages
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.dyads.equations import Dyads
from synthesis.kinds.motion.exact.screening import SOUND, screen
from synthesis.kinds.motion.exact.screening import make_screening_constraints as screening_demands
from synthesis.kinds.motion.least_squares.constraint_manifold import compute_line, compute_pivots
from synthesis.kinds.motion.least_squares.pose_fit import PoseConstraints, PoseFit, fit_surface
from synthesis.kinds.motion.least_squares.starts import MAX_REACH, Start, as_slider, list_starts
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.kinds.motion.task.ranking import get_rms_error, make_ranking
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.kind import Progress
from synthesis.model.linkage.answer import LinkageDesign, LinkageMechanism
from synthesis.model.linkage.conversion import (
    FourbarConfiguration,
    build_fourbar,
    build_inverted_slider_crank,
    build_slider_crank,
)
from synthesis.results.candidate_log import DEFECT_REASONS, OUTRANKED_REASON, CandidateLog

SINGLE_FIT_COUNT = 40
"""Number of dyads per side that are fitted individually."""

DYAD_COUNT = 36
"""Number of dyads per side that are paired: the best of the fitted dyads and of their starting points."""

REACH_SCALE = 3.0
"""Distance of a pivot, in task sizes, at which the cost of a dyad is multiplied by four. A dyad with a distant pivot
fits the poses well but gives no practical linkage, and would displace better dyads."""

MAX_EXACT_PAIRS = 16
"""Number of pairs fitted if positions or coordinates are exact, which takes several times as long."""

MAX_PARTNERS = 8
"""Maximum number of fitted pairs per dyad, so that one dyad does not fill the list."""

MAX_PAIRS = 48
"""Number of pairs fitted together; the first fit takes a few milliseconds each."""

ROUGH_TOLERANCE, MAX_ROUGH_EVALUATIONS = 1e-4, 25
"""Relative change of the cost at which the first fit of a pair stops, and its maximum number of evaluations."""

REFINED_PAIR_COUNT = 8
"""Number of pairs, the best after the first fit, that are fitted until convergence."""

DUPLICATE_DYAD_TOLERANCE = 0.08
"""Relative difference of the pivots below which two dyads count as the same starting point."""

DUPLICATE_LINKAGE_TOLERANCE = 0.03
"""Relative difference of the pivots below which two linkages count as the same design; the closer one is kept."""

MIN_VERIFIED = 10
"""Minimum number of linkages that are verified, even if fewer designs are requested."""

MIN_LINK_SHARE = 1e-4
"""Minimum length of a link, relative to the longest; below it the linkage is degenerate."""

REASONS = DEFECT_REASONS | {"within_tolerance": "tolerance"}
"""Rejection reason by failed check; other checks use their own name."""


class _Pair(NamedTuple):
    """A pair of dyads to be fitted, its least-squares problem, and its initial cost."""

    one: Start
    other: Start
    problem: PoseFit
    point: Real
    cost: float


def solve_least_squares(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Fit linkages to the positions of a problem, some of which may be exact."""
    task = make_motion_task(problem)
    demands = make_pose_constraints(problem, task)
    rng = np.random.default_rng(problem.seed)
    progress(0.0, compose("motion-fitting-dyads"))
    sides = problem.input_side, problem.output_side
    # With equal choices for both sides the dyads are interchangeable, so fit them once.
    alike = sides[0] == sides[1]
    inputs = _fit_dyads(task, demands, problem, 0, rng)
    outputs = inputs if alike else _fit_dyads(task, demands, problem, 1, rng)
    progress(0.3, compose("motion-pairing-dyads"))
    pairs = _select_pairs(problem, task, demands, inputs, outputs)
    run = _FitLog(problem, task, demands, alike=alike)
    # First stop every fit early, then spend the effort on the few pairs that look best.
    rough: list[_Pair] = []
    for n, pair in enumerate(pairs):
        progress(0.35 + 0.3 * n / len(pairs), compose("motion-fitting-pair", number=n + 1, count=len(pairs)))
        ended = pair.problem.minimize(pair.point, tolerance=ROUGH_TOLERANCE, evaluations=MAX_ROUGH_EVALUATIONS)
        if ended is None:
            run.reject("positions_not_held")
        elif math.isfinite(ended.cost):
            rough.append(pair._replace(point=ended.point, cost=ended.cost))
    rough.sort(key=lambda pair: pair.cost)
    # Slots are replaced in place: the list is sorted again below, because refinement changes the order.
    for n, pair in enumerate(rough[:REFINED_PAIR_COUNT]):
        progress(
            0.65 + 0.2 * n / REFINED_PAIR_COUNT, compose("motion-refining-pair", number=n + 1, count=REFINED_PAIR_COUNT)
        )
        ended = pair.problem.minimize(pair.point)
        # A refinement that loses the exact positions keeps the rough fit.
        rough[n] = pair if ended is None else pair._replace(point=ended.point, cost=ended.cost)
    for n, pair in enumerate(sorted(rough, key=lambda pair: pair.cost)):
        progress(0.85 + 0.15 * n / len(rough), compose("motion-verifying-fits"))
        run.drive(pair)
    progress(1.0, compose("motion-verified"))
    return run.build_result()


def make_pose_constraints(problem: MotionProblem, task: MotionTask) -> PoseConstraints:
    """Return positions and tolerances in task units; without a tolerance the task's size and the radian replace it."""
    poses = np.stack([task.points.real, task.points.imag, np.array(problem.turns)], axis=1)
    limits = np.array(problem.limits)
    tolerances = np.stack([limits[:, 0] / task.size, limits[:, 1] / task.size, np.radians(limits[:, 2])], axis=1)
    # Infinite tolerances mean that the client gave none: weigh by the task's size and the radian.
    return PoseConstraints(poses, np.where(np.isfinite(tolerances), tolerances, 1.0))


def _fit_dyads(
    task: MotionTask, demands: PoseConstraints, problem: MotionProblem, side: int, rng: np.random.Generator
) -> list[Start]:
    """Return the best dyads of one side, among the starting points and their fits to all positions."""
    choices = (problem.input_side, problem.output_side)[side]
    listed = list_starts(task, demands, choices, rng)
    rough = _select_dyads(demands, listed, SINGLE_FIT_COUNT)
    fits = []
    for start in rough:
        numbers = fit_surface(demands, start.surface, start.numbers, start.fixed).point
        if np.all(np.isfinite(numbers)):
            fits.append(start._replace(numbers=numbers))
            # An almost straight circle means a distant pivot: offer the slider that replaces it, too.
            if choices.dyad == "any" and abs(numbers[4]) * MAX_REACH < 1.0 and not start.fixed.any():
                fits.append(as_slider(fits[-1]))
    # Rough starts stay in the list, because a fit to all poses can run away from a good start.
    return _select_dyads(demands, [*fits, *rough], DYAD_COUNT)


def _select_dyads(demands: PoseConstraints, listed: list[Start], count: int) -> list[Start]:
    """Select the distinct dyads with the smallest weighted distance from the poses."""
    cost = [
        # At REACH_SCALE the factor is 4 (see there); it grows with the square beyond.
        _evaluate_single_cost(demands, start) * (1.0 + 3.0 * _measure_reach(start) ** 2 / REACH_SCALE**2)
        for start in listed
    ]
    kept: list[Start] = []
    for k in np.argsort(cost, kind="stable"):
        start = listed[int(k)]
        if len(kept) == count or not math.isfinite(cost[int(k)]):
            break
        place = _get_coordinates(start)
        if all(
            k.dyad != start.dyad
            or np.abs(place - _get_coordinates(k)).max() > DUPLICATE_DYAD_TOLERANCE * (1.0 + abs(place).max())
            for k in kept
        ):
            kept.append(start)
    return kept


def _evaluate_single_cost(demands: PoseConstraints, start: Start) -> float:
    # All five numbers are fixed: only the cost of the start is evaluated.
    fitted = fit_surface(demands, start.surface, start.numbers, np.ones(5, np.bool_))
    return fitted.cost


def _measure_reach(start: Start) -> float:
    """Return the distance of the farther pivot, or of the slider's point, from the origin, in task sizes."""
    if start.surface.curved:
        return max(map(abs, compute_pivots(start.surface, start.numbers)))
    return float(np.hypot(start.numbers[0], start.numbers[1]))


def _get_coordinates(start: Start) -> Real:
    """Return the coordinates by which dyads of one type are compared: pivots, or the slider's point and line."""
    if start.surface.curved:
        fixed, moving = compute_pivots(start.surface, start.numbers)
        return np.array([fixed.real, fixed.imag, moving.real, moving.imag])
    point, foot, angle = compute_line(start.surface, start.numbers)
    along = complex(math.cos(angle), math.sin(angle))
    return np.array(
        # The angle of a line has the period π, so compare its double angle by sine and cosine.
        [point.real, point.imag, (foot * along.conjugate()).imag, math.sin(2.0 * angle), math.cos(2.0 * angle)]
    )


def _select_pairs(
    problem: MotionProblem, task: MotionTask, demands: PoseConstraints, inputs: list[Start], outputs: list[Start]
) -> list[_Pair]:
    """Select the pairs to fit together: half by lowest cost, half by lowest cost among those that pass the screening.

    At most one side has a slider.
    """
    alike = inputs is outputs
    sound = _screen_pairs(problem, task, inputs, outputs)
    if alike:
        # A pair may be driven from either side, so it passes if either order does.
        sound |= sound.T
    pairs = []
    for i, one in enumerate(inputs):
        for j, other in enumerate(outputs):
            # Skip a dyad with itself and repeated pairs; two sliders cannot be assembled to a linkage of this kind.
            if (alike and j <= i) or (one.dyad != "RR" and other.dyad != "RR"):
                continue
            fitting = PoseFit(demands, (one.surface, other.surface), (one.fixed, other.fixed))
            point = fitting.start(one.numbers, other.numbers)
            # First order is fast enough for all pairs, and orders them well.
            cost = fitting.cost(point, first_order=True)
            if math.isfinite(cost):
                pairs.append((not sound[i, j], _Pair(one, other, fitting, point, cost)))
    partners: Counter[int] = Counter()
    kept: dict[int, _Pair] = {}
    count = MAX_EXACT_PAIRS if demands.exact_count.max() > 1 else MAX_PAIRS
    by_cost = sorted(range(len(pairs)), key=lambda n: pairs[n][1].cost)
    # Half of the places go by cost alone, because the screening can err for pairs that do not yet meet the positions.
    for order, size in ((by_cost, count // 2), (sorted(by_cost, key=lambda n: pairs[n][0]), count)):
        for n in order:
            pair = pairs[n][1]
            if len(kept) == size:
                break
            if n not in kept and max(partners[id(pair.one)], partners[id(pair.other)]) < MAX_PARTNERS:
                partners.update((id(pair.one), id(pair.other)))
                kept[n] = pair
    return list(kept.values())


def _screen_pairs(
    problem: MotionProblem, task: MotionTask, inputs: list[Start], outputs: list[Start]
) -> NDArray[np.bool_]:
    """Return a mask of the pairs that pass the screening as if they met all positions exactly; sliders always pass."""
    links = []
    for listed in (inputs, outputs):
        # Sliders have no second pivot: unit dummies fill the table, and their verdict is overruled below.
        pivots = [compute_pivots(s.surface, s.numbers) if s.surface.curved else (0j, 1.0 + 0j) for s in listed]
        table = np.array(pivots, np.complex128).reshape(-1, 2)
        links.append(Dyads(table[:, 0].copy(), table[:, 1].copy()))
    limit = problem.constraints.min_transmission_angle
    wanted = screening_demands(problem.constraints, task, limit or 0.0)
    verdict = screen(task, links[0], links[1], wanted).verdict
    sliders = np.array([[i.dyad != "RR" or o.dyad != "RR" for o in outputs] for i in inputs], np.bool_)
    sliders = sliders.reshape(verdict.shape)
    return np.asarray((verdict == SOUND) | sliders)


class _FitLog(CandidateLog[LinkageDesign]):
    """Record of the fitted pairs: designs, rejections, and linkages already verified."""

    def __init__(self, problem: MotionProblem, task: MotionTask, demands: PoseConstraints, *, alike: bool) -> None:
        super().__init__(problem, REASONS)
        self.problem, self.task, self.demands, self.alike = problem, task, demands, alike
        self.seen: list[Real] = []

    def drive(self, pair: _Pair) -> None:
        """Verify the linkage of a fitted pair, unless another pair has converged to the same linkage."""
        one = pair.one._replace(numbers=pair.point[:5])
        other = pair.other._replace(numbers=pair.point[5:10])
        # Sort the dyads, so that the same linkage with exchanged sides is recognised.
        places = np.concatenate(sorted((_get_coordinates(one), _get_coordinates(other)), key=lambda z: float(z[0])))
        # Different numbers of coordinates mean different types of dyads.
        if any(
            len(places) == len(s) and np.abs(places - s).max() < DUPLICATE_LINKAGE_TOLERANCE * (1.0 + abs(s).max())
            for s in self.seen
        ):
            return
        self.seen.append(places)
        # Later pairs have higher costs, so they cannot rank before those that passed; without that order, verify all.
        if self.problem.is_least_squares and len(self.passed) >= max(self.problem.max_designs, MIN_VERIFIED):
            self.reject(OUTRANKED_REASON)
            return
        pose = pair.problem.poses(pair.point)[0]
        best: LinkageDesign | None = None
        reason = "cannot_be_driven"
        # If both sides have the same choices, either may be the input: keep the better of the two.
        for first, second in ((one, other), (other, one)) if self.alike else ((one, other),):
            mechanism = self._build_mechanism(first, second, pose)
            design = None if mechanism is None else verify(self.problem, mechanism)
            if design is None:
                reason = "degenerate" if mechanism is None else reason
            elif best is None or _is_better(design, best):
                best = design
        self.record_candidate(reason if best is None else best)

    def _build_mechanism(self, one: Start, other: Start, pose: Real) -> LinkageMechanism | None:
        """Build the linkage of two fitted dyads at the body's first pose; None if it is degenerate or has no input."""
        place, turn = complex(pose[0], pose[1]), complex(math.cos(pose[2]), math.sin(pose[2]))
        target = self.demands.poses[0]
        exact = abs(place - complex(target[0], target[1])) == 0.0 and pose[2] == target[2]
        # A body angle is stored only if the fit turned the body away from its given first angle.
        angle = None if exact else self.problem.positions[0].angle + math.degrees(float(pose[2] - target[2]))
        p = self.task.to_problem(place)

        def to_ground(z: complex) -> complex:
            return self.task.to_problem(place + turn * z)

        # The linkage is built with its slider on the output side; exchange the sides and drive the slider instead.
        if one.dyad != "RR":
            if one.dyad == "RP" or other.dyad != "RR":
                return None
            one, other = other, one
            driven_by = "slider"
        else:
            driven_by = "crank"
        fixed, moving = compute_pivots(one.surface, one.numbers)
        o2, a = self.task.to_problem(fixed), to_ground(moving)
        if other.dyad == "RR":
            fixed, moving = compute_pivots(other.surface, other.numbers)
            o4, b = self.task.to_problem(fixed), to_ground(moving)
            joints = FourbarConfiguration(o2, a, b, o4, p)
            return build_fourbar(joints, angle) if joints.has_no_link_below(MIN_LINK_SHARE) else None
        point, _, line = compute_line(other.surface, other.numbers)
        if other.dyad == "PR":
            b = to_ground(point)
            if min(abs(a - o2), abs(b - a)) <= MIN_LINK_SHARE * max(abs(a - o2), abs(b - a)):
                return None
            return build_slider_crank(
                o2, a, b, line, p, driven_by="slider" if driven_by == "slider" else "crank", body_angle=angle
            )
        o4 = self.task.to_problem(point)
        if min(abs(a - o2), abs(o4 - o2), abs(a - o4)) <= MIN_LINK_SHARE * max(abs(a - o2), abs(o4 - o2)):
            return None
        return build_inverted_slider_crank(o2, a, o4, line + float(pose[2]), p, body_angle=angle)

    def build_result(self) -> MotionResult:
        """Build the result with its ranked designs and summary."""
        return MotionResult(
            designs=self.select_designs(make_ranking(self.problem)),
            search=self.build_search("least_squares"),
            summary=self._describe_result(),
        )

    def _describe_result(self) -> str:
        if self.passed:
            share = 100.0 * min(map(get_rms_error, self.passed))
            found = [
                compose(
                    "motion-fits-feasible",
                    passed=len(self.passed),
                    candidates=self.candidates,
                    positions=len(self.problem.positions),
                ),
                compose("motion-best-error", error=f"{share:.3g}"),
            ]
        else:
            reasons = self.format_reasons() or compose("motion-none-rejected")
            found = [compose("motion-no-fit-feasible", candidates=self.candidates, reasons=reasons)]
        return join_messages([*found, compose("motion-closer-possible")])


def _is_better(design: LinkageDesign, other: LinkageDesign) -> bool:
    """Return whether a design is better than the same linkage with the other input side."""
    ours, theirs = design.verification.passed, other.verification.passed
    return ours > theirs or (ours == theirs and design.metrics.quality > other.metrics.quality)
