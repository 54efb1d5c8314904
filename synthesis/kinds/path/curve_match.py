"""Whole-curve matching: a fourbar whose coupler point draws a given closed curve or open stroke.

1. *Shape.* Some ten thousand linkages are drawn, and their curves compared with the target with position, size and
   rotation removed (:mod:`synthesis.kinds.path.curve_shapes`).
2. *Refinement.* The most alike, placed on the target, go to least squares of the true distance
   (:mod:`synthesis.kinds.path.curve_descent`), at first at equal steps along the target, then at its own points.
3. *Limits.* Where a demand is broken the descent is repeated under it (:mod:`synthesis.kinds.path.curve_limits`).
4. Every linkage is offered with its cognates, which draw the same curve, from either fixed pivot, and verified.

Where fixed pivots are given the shape alone says little, as size and place are not free: linkages are then fitted to
points along the target, from many starts (:mod:`synthesis.kinds.path.point_fit`), and verified as the others.

A closed curve is to be drawn by a crank that turns through; the families of linkages are written so that it does. A
stroke may be drawn by any link, between its toggles.
"""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.fit.chart import CRANK_ROCKER, DOUBLE_CRANK, FOURBAR, natural
from synthesis.fit.coupler_curve import place
from synthesis.fit.demands import LINKS
from synthesis.kinds.path.curve_descent import Descent, descend
from synthesis.kinds.path.curve_families import families_of, joints_of
from synthesis.kinds.path.curve_limits import curve_setting, descend_within, lengths_kept, usable
from synthesis.kinds.path.curve_placement import moved, placement_of, searched, stated
from synthesis.kinds.path.curve_shapes import Starts, alike
from synthesis.kinds.path.curve_target import SHAPE_POINTS, Target
from synthesis.kinds.path.design import CurveSweep, PathDesign, PathResult
from synthesis.kinds.path.harvest import that_differ
from synthesis.kinds.path.point_fit import configuration_of, fitted, point_task
from synthesis.kinds.path.problem import PathPoint, PathProblem
from synthesis.kinds.path.verify_curve import distances, verify_curve
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_statement import LengthLimits
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.outcome.ranking import distinct, ranked
from synthesis.outcome.sifting import Sifting, reported

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

DRAWN = {
    (CRANK_ROCKER, True): 65536,
    (DOUBLE_CRANK, True): 40960,
    (CRANK_ROCKER, False): 4096,
    (DOUBLE_CRANK, False): 4096,
    (FOURBAR, False): 8192,
}
"""Linkages drawn, by family and whether the target is closed; an open one is compared with 216 windows of each."""

MAX_FOLLOWED = 150
"""Starts of a family that are refined at equal steps along the target."""

MAX_REFINED = 20
"""Of these, the best that are refined at the target's own points."""

ROUGH_STEPS, FINE_STEPS = 30, 300
"""Steps of these refinements at most."""

THINNED, ALL = 120, 60
"""More points than this are thinned at first, and all of them then taken for so many steps at most."""

MAX_COST_RATIO, SHAPE_ERROR = 100.0, 1e-3
"""Linkages whose sum of squares at equal steps is this many times the least are given up; below the second, a share of
the size at every point, that sum says nothing, as the steps lie on straight lines between the points."""

CURVE_SAMPLES = 121
"""Places on a candidate's curve at which excursions between the points are looked for."""

MAX_LIMITED = 7
"""Refined linkages of a family, all different, that are brought within the problem's limits."""

NEAREST_SHARE = 0.4
"""A linkage stays in the running while its error is below the best one's over this; demands may choose among them."""

MAX_USABLE = 2
"""Refined linkages of a family that are offered with better force transmission too, at the cost of accuracy."""

MAX_OFFERED = 10
"""Linkages, each with its cognates, that are verified."""

SAME_DESIGN = 1e-4
"""Designs whose joints agree to this share of the curve's size are one and the same: fits of different accuracy."""

EQUALLY_NEAR, NEARER, ERROR_TOLERANCE = 1.1, 1.001, 1e-9
"""Errors within these factors are alike, and quality decides: where the best design is asked for, and where the most
accurate is. Errors below the last, a share of the curve's size, are rounding."""

MIN_LINK = 1e-7
"""Links shorter than this share of the curve's size are no links."""


STEP_ROUNDING = 1e-6
"""Share of a step of nearness that is rounding."""


class _Candidate(NamedTuple):
    """A refined linkage: family, unknowns, sign, crank angle at the first point, and error in curve sizes."""

    family: int
    x: Real
    sign: float
    theta: float
    error: float


def solve_curve_match(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation by matching the whole curve."""
    target = Target(problem)
    sought = searched(problem)
    setting = curve_setting(sought, target.centre, target.size)
    sweep = None
    if sought.fixed_pivots.given():
        linkages = _at_given_pivots(sought, target, progress)
    else:
        candidates, sweep = _alike(problem, target, setting, progress)
        linkages = [joints for candidate in candidates for joints in with_cognates(_joints(candidate))]
    sifting = Sifting[PathDesign](problem)
    sifting.sift(
        reported(linkages, progress, (0.8, 1.0), "{done} of {all} linkages verified"),
        partial(_verified, problem, target, setting),
    )
    sifting.withdraw(near_the_nearest(sifting.passed, problem), "far_from_the_curve")
    progress(1.0, "verified")
    return PathResult(
        designs=sifting.designs(
            partial(ranked_by_nearness, problem=problem),
            partial(that_differ, count=problem.max_designs, apart=SAME_DESIGN * problem.task_size),
        ),
        search=sifting.search("curve_match"),
        summary=_summary(problem, sifting, sweep),
        sweep=sweep,
    )


def _alike(
    problem: PathProblem, target: Target, setting: Real, progress: Progress
) -> tuple[list[_Candidate], CurveSweep]:
    """The linkages in the running of those whose curves have the target's shape."""
    families = families_of(problem)
    candidates: list[_Candidate] = []
    least = math.inf
    drawn = swept = followed = 0
    for n, family in enumerate(families):
        count = DRAWN[family, problem.closed]

        def compared(share: float, n: int = n, count: int = count) -> None:
            fraction = (n + 0.7 * share) / len(families)
            progress(0.8 * fraction, f"{round(count * share)} of {count} linkages compared")

        starts = alike(
            family,
            target.steps,
            problem.closed,
            count,
            MAX_FOLLOWED,
            longest=float(setting[LINKS + 1]),
            seed=problem.seed % 2**32,
            progress=compared,
        )
        drawn, swept, followed = drawn + count, swept + starts.swept, followed + len(starts.x)
        refined, least = _refined(target, starts, setting, least, traded=problem.rank_by != "accuracy")
        candidates += refined
        progress(0.8 * (n + 1.0) / len(families), "best shapes refined")
    return _running(candidates), CurveSweep(linkages=drawn, curves=swept, refined=followed)


def _at_given_pivots(problem: PathProblem, target: Target, progress: Progress) -> list[FourbarConfiguration]:
    """Linkages with fixed pivots where they are demanded, fitted to points along the target; in the target's unit.

    They are fitted to the target's own points, and where these are not many to equal steps too: between points that lie
    far apart the nearest linkages may go far astray.
    """
    lengths = problem.constraints.link_length or LengthLimits()
    demands = problem.constraints.model_copy(
        update={"link_length": lengths.model_copy(update={"max": problem.longest_link})}
    )
    fits = [target.points, target.steps] if len(target.points) < SHAPE_POINTS else [target.points]
    linkages = []
    for n, along in enumerate(fits):
        part = part_of(progress, 0.8 * n / len(fits), 0.8 * (n + 1) / len(fits))
        points = [PathPoint(x=float(z.real), y=float(z.imag)) for z in target.centre + target.size * along]
        changes = {"method": "least_squares", "points": points, "constraints": demands}
        task = point_task(fit := problem.model_copy(update=changes))
        for candidate in fitted(fit, task, np.random.default_rng(problem.seed), part):
            joints = configuration_of(candidate, task)
            if joints is not None:
                linkages.append(FourbarConfiguration(*((joint - target.centre) / target.size for joint in joints)))
    return linkages


def warm_up() -> None:
    """Load the compiled kernels on a small circle, closed and open."""
    circle = np.exp(2j * np.pi * np.arange(SHAPE_POINTS) / SHAPE_POINTS)
    stated = {"points": [{"x": z.real, "y": z.imag} for z in circle]}
    problem = PathProblem.model_validate({"kind": "path", "method": "curve_match", **stated})
    setting = curve_setting(problem, 0j, 1.0)
    for family, closed in ((CRANK_ROCKER, True), (FOURBAR, False)):
        starts = alike(family, circle, closed, 64, 2)
        fit = descend(family, starts.x, starts.sign, starts.theta, circle, iterations=2)
        start = Descent(fit.x[0], fit.theta[0], fit.cost[0])
        descend_within(family, start, float(starts.sign[0]), circle, np.ones(SHAPE_POINTS), setting)


def _refined(
    target: Target, starts: Starts, setting: Real, least: float, *, traded: bool
) -> tuple[list[_Candidate], float]:
    """The starts' linkages after least squares, and the least cost at equal steps, of earlier families too.

    ``traded``: with linkages among them that trade accuracy for force transmission.
    """
    if not len(starts.x):
        return [], least
    family, longest = starts.family, float(setting[LINKS + 1])
    rough = descend(family, starts.x, starts.sign, starts.theta, target.steps, longest=longest, iterations=ROUGH_STEPS)
    least = min(least, float(rough.cost.min()))
    best = np.argsort(rough.cost, kind="stable")[:MAX_REFINED]
    best = best[rough.cost[best] <= MAX_COST_RATIO * max(least, SHAPE_POINTS * SHAPE_ERROR**2)]
    if not len(best):
        return [], least
    theta = np.array([target.angles(rough.theta[k]) for k in best])
    thin = slice(None, None, math.ceil(len(target.fitted) / THINNED))
    fine = descend(
        family,
        rough.x[best],
        starts.sign[best],
        theta[:, thin],
        target.fitted[thin],
        weights=target.weights[thin],
        longest=longest,
        iterations=FINE_STEPS,
    )
    signs = starts.sign[best]
    order = [k for k in np.argsort(fine.cost, kind="stable") if math.isfinite(fine.cost[k])]
    order = [
        order[k]
        for k in _distinct([_rough(family, fine.x[k], float(signs[k]), fine.theta[k]) for k in order], 2 * MAX_LIMITED)
    ]
    if len(target.fitted) > THINNED:
        fine = _at_all_points(target, family, fine, signs, thin, longest, order)
    free = [(_candidate(target, family, fine.x[k], float(signs[k]), fine.theta[k]), k) for k in order]
    free.sort(key=lambda pair: pair[0].error)
    demanded, offered = [], list[_Candidate]()
    practical = usable(setting) if traded else None
    for candidate, k in free[:MAX_LIMITED]:
        descent = Descent(fine.x[k], fine.theta[k], fine.cost[k])
        kept = descend_within(family, descent, candidate.sign, target.fitted, target.weights, setting)
        if kept is None:
            continue
        demanded.append(
            candidate if kept is descent else _candidate(target, family, kept.x, candidate.sign, kept.theta)
        )
        if practical is not None and len(demanded) <= MAX_USABLE:
            better = descend_within(family, kept, candidate.sign, target.fitted, target.weights, practical)
            if better is not None and better is not kept:
                offered.append(_candidate(target, family, better.x, candidate.sign, better.theta))
    return demanded + offered, least


def _at_all_points(
    target: Target, family: int, thinned: Descent, sign: Real, thin: slice, longest: float, rows: list[int]
) -> Descent:
    """Descents from a part of the points go on with all of them."""
    x, cost = thinned.x.copy(), thinned.cost.copy()
    theta = np.empty((len(x), len(target.fitted)))
    every = np.arange(len(target.fitted))
    known = every[thin]
    for k in rows:
        angles, at = thinned.theta[k], known
        if target.closed:
            turn = math.copysign(2.0 * math.pi, angles[-1] - angles[0])
            angles, at = np.append(angles, angles[0] + turn), np.append(known, len(every))
        theta[k] = np.interp(every, at, angles)
    whole = descend(
        family, x[rows], sign[rows], theta[rows], target.fitted, weights=target.weights, longest=longest, iterations=ALL
    )
    x[rows], theta[rows], cost[rows] = whole.x, whole.theta, whole.cost
    return Descent(x, theta, cost)


def _rough(family: int, x: Real, sign: float, theta: Real) -> _Candidate:
    """A linkage whose error is not known yet."""
    return _Candidate(family, x, sign, float(theta[0]), math.inf)


def _candidate(target: Target, family: int, x: Real, sign: float, theta: Real) -> _Candidate:
    """A linkage with its error at the target's own points."""
    lengths, chart = np.zeros(4), np.zeros((4, 4))
    natural(family, x, lengths, chart)
    angles = theta[: len(target.points)]
    misses = [
        abs(place(family, x, lengths, sign, 0.0, float(at))[1] - point)
        for point, at in zip(target.points, angles, strict=True)
    ]
    end = angles[0] + 2.0 * math.pi if target.closed else angles[-1]
    run = np.linspace(angles[0], end, CURVE_SAMPLES)
    curve = np.array([place(family, x, lengths, sign, 0.0, float(at))[1] for at in run])
    _, beyond = distances(curve, target.points, target.closed, max(misses))
    error = math.hypot(math.sqrt(float(np.mean(np.square(misses)))), float(beyond.max()))
    return _Candidate(family, x, sign, float(theta[0]), error)


def _distinct(candidates: list[_Candidate], count: int) -> list[int]:
    """Rows of candidates that differ, in their order."""
    return distinct([_joints(candidate) for candidate in candidates], count, SAME_DESIGN)


def _running(candidates: list[_Candidate]) -> list[_Candidate]:
    """Candidates with an error near the least, the best first, each once."""
    ordered = sorted(candidates, key=lambda candidate: candidate.error)
    if not ordered:
        return []
    worst = max(ordered[0].error / NEAREST_SHARE, ERROR_TOLERANCE)
    ordered = [candidate for candidate in ordered if candidate.error <= worst]
    return [ordered[k] for k in _distinct(ordered, MAX_OFFERED)]


def _joints(candidate: _Candidate) -> FourbarConfiguration:
    return joints_of(candidate.family, candidate.x, candidate.sign, candidate.theta)[1]


def with_cognates(joints: FourbarConfiguration) -> list[FourbarConfiguration]:
    """A fourbar and its two cognates (Roberts), each with either fixed pivot as the input's, in one configuration.

    With ζ = (P − A)/(B − A) the third pivot is O2 + ζ (O4 − O2), and O2 A P A′ is a parallelogram (Norton, Sec. 3.7).
    """
    cognates = []
    o2, a, b, o4, p = joints
    for start, pin, other, far in ((o2, a, b, o4), (o4, b, a, o2)):
        cognates.append(FourbarConfiguration(start, pin, other, far, p))
        if abs(p - pin) == 0.0 or abs(other - pin) == 0.0:
            continue
        zeta = (p - pin) / (other - pin)
        third = start + zeta * (far - start)
        new_pin = start + (p - pin)
        new_other = new_pin + zeta * (pin - start)
        cognates.append(FourbarConfiguration(start, new_pin, new_other, third, p))
        cognates.append(FourbarConfiguration(third, new_other, new_pin, start, p))
    return cognates


def _verified(
    problem: PathProblem, target: Target, setting: Real, joints: FourbarConfiguration
) -> PathDesign | str | None:
    """A linkage in the target's unit, driven and measured; or why it is not driven."""
    links = joints.lengths
    if min(links) < MIN_LINK:
        return "degenerate"
    if not lengths_kept(setting, links):
        return "link_length"
    if problem.closed and 2.0 * (max(links) + min(links)) > sum(links) * (1.0 + ERROR_TOLERANCE):
        return "full_rotation"
    drawn = FourbarConfiguration(*(target.centre + target.size * joint for joint in joints))
    alpha, beta = placement_of(problem, drawn)
    there = FourbarConfiguration(*(alpha * joint + beta for joint in drawn))
    at = stated(alpha, beta)
    design = verify_curve(problem if at is None else moved(problem, alpha, beta), fourbar_mechanism(there))
    return design if design is None or at is None else design.model_copy(update={"placement": at})


def _summary(problem: PathProblem, sifting: Sifting[PathDesign], sweep: CurveSweep | None) -> str:
    counts = f"{sifting.accepted} of {sifting.candidates}"
    if sweep is None:
        text = (
            "Linkages on the given pivots were fitted to points along the curve from many starts; "
            f"{counts} satisfy all demands."
        )
    else:
        text = (
            f"{sweep.curves} curves of {sweep.linkages} linkages were compared with the target, {sweep.refined} "
            f"refined; {counts} designs, cognates included, satisfy all demands."
        )
    if sifting.passed:
        best = ranked_by_nearness(sifting.passed, problem)[0].metrics
        unit = problem.length_unit
        text += f" The best draws it with an rms distance of {best.rms_distance:.3g} {unit}, "
        text += f"at most {best.max_distance:.3g}."
        if sweep is not None:
            text += (
                " Cognates draw the same curve, and quality chose among them: pivots near the curve, force "
                "transmission, even links."
            )
    return text + sifting.reasons()


def error_of(design: PathDesign, problem: PathProblem) -> float:
    """How far a design is from the curve: its rms distance from the points, and how far it goes astray between them."""
    return max(
        ERROR_TOLERANCE * problem.task_size, math.hypot(design.metrics.rms_distance, design.metrics.excursion or 0.0)
    )


def near_the_nearest(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Designs whose error is not beyond the least one over :data:`NEAREST_SHARE`."""
    least = min((error_of(design, problem) for design in designs), default=0.0)
    return [design for design in designs if error_of(design, problem) <= least / NEAREST_SHARE]


def ranked_by_nearness(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Designs in the order asked for: the nearest first, among those equally near by quality, unless size or
    transmission angle are asked for: then these decide among designs whose error is less than twice the least."""
    factor = math.log(NEARER if problem.rank_by == "accuracy" else EQUALLY_NEAR)
    least = min((error_of(design, problem) for design in designs), default=0.0)

    def nearness(design: PathDesign) -> int:
        return math.floor(math.log(error_of(design, problem) / least) / factor + STEP_ROUNDING)

    if problem.rank_by in ("size", "transmission_angle"):
        return ranked(designs, problem.rank_by, group=lambda design: error_of(design, problem) > 2.0 * least)
    nearest_first = sorted(designs, key=lambda design: error_of(design, problem))
    return ranked(nearest_first, problem.rank_by, {"quality": nearness, "accuracy": nearness})
