"""Whole-curve matching: a fourbar whose coupler point draws a given closed curve or open stroke.

1. *Shape.* Some ten thousand linkages are drawn, and their curves compared with the target with position, size and
   rotation removed (:mod:`synthesis.kinds.path.curve_shapes`).
2. *Refinement.* The most similar ones, placed on the target, go to least squares of the true distance
   (:mod:`synthesis.kinds.path.curve_descent`), first at equal steps along the target, then at its own points.
3. *Limits.* If a constraint is violated the descent is repeated under it (:mod:`synthesis.kinds.path.curve_limits`).
4. Every linkage is offered with its cognates, which draw the same curve, from either fixed pivot, and verified.

If fixed pivots are given the shape alone says little, because size and place are not free: linkages are then fitted to
points along the target, from many starts (:mod:`synthesis.kinds.path.point_fit`), and verified like the others.

A closed curve must be drawn by a crank that turns through; the families of linkages are parametrized so that it does. A
stroke may be drawn by any link, between its toggles.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from synthesis.fit.chart import CRANK_ROCKER, DOUBLE_CRANK, FOURBAR
from synthesis.fit.demands import COSINE, LINKS
from synthesis.kinds.path.curve_descent import Descent, descend
from synthesis.kinds.path.curve_families import families_of, joints_of
from synthesis.kinds.path.curve_fits import (
    SAME_FIT,
    Fit,
    at_all_points,
    configuration,
    fit_of,
    fits_within,
    that_differ,
    thinning,
    with_cognates,
)
from synthesis.kinds.path.curve_limits import (
    all_broken,
    bounds_places,
    curve_setting,
    descend_softly,
    descend_within,
    lengths_kept,
    shapes_kept,
    usable,
)
from synthesis.kinds.path.curve_placement import moved, placement_of, searched, stated
from synthesis.kinds.path.curve_shapes import Compared, Starts, alike, compared, most_alike
from synthesis.kinds.path.curve_target import SHAPE_POINTS, Target
from synthesis.kinds.path.design import CurveSweep, PathDesign, PathResult
from synthesis.kinds.path.harvest import that_differ as designs_that_differ
from synthesis.kinds.path.limits import zoned
from synthesis.kinds.path.nearness import (
    ERROR_TOLERANCE,
    FAR,
    MOST_UNEVEN,
    NEAREST_SHARE,
    choice,
    near_the_nearest,
    ranked_by_nearness,
)
from synthesis.kinds.path.point_fit import Candidate, PointTask, configuration_of, fitted, point_task
from synthesis.kinds.path.problem import PathPoint, PathProblem
from synthesis.kinds.path.stance_fit import as_fit, fits_in_stance
from synthesis.kinds.path.verification import verify_path
from synthesis.model.counting import agreeing, counted, grouped
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_statement import LengthLimits
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.outcome.ranking import distinct
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
"""Number of linkages drawn, by family and whether the target is closed; an open one is compared with 216 windows of
each."""

MAX_FOLLOWED = 150
"""Maximum number of starts of a family that are refined at equal steps along the target."""

MAX_REFINED = 20
"""Maximum number of these, the best, that are refined at the target's own points."""

ROUGH_STEPS, FINE_STEPS = 30, 300
"""Maximum number of steps of these two refinements."""

ALL = 60
"""Maximum number of steps with all points, after a refinement with thinned ones."""

MAX_COST_RATIO, SHAPE_ERROR = 100.0, 1e-3
"""Linkages whose sum of squares at equal steps exceeds the minimum by this factor are dropped. Below the second number,
a share of the size at every point, the sum is not decisive, because the steps lie on straight lines between the points.
"""

MAX_FREE = 14
"""Maximum number of distinct refined linkages of a family that go on."""

MAX_SUITED = 60
"""Maximum number of linkages of a family that satisfy the constraints on shape and start constrained fits."""

USABLE, MAX_USABLE = (20.0, 30.0, 40.0), 3
"""Transmission angles, degrees, for which designs are offered next to the nearest one if none is required, and the
maximum number with each: free fits tend to change points, where the transmission angle vanishes."""

MAX_OFFERED = 10
"""Maximum number of linkages, each with its cognates, that are verified."""

SAME_DESIGN = 1e-4
"""Designs whose joints agree to this share of the curve's size are duplicates: fits of different accuracy."""

MIN_LINK = 1e-7
"""Linkages with a link shorter than this share of the curve's size are degenerate."""


def solve_curve_match(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation by matching the whole curve."""
    target = Target(problem)
    setting = curve_setting(searched(problem), target.centre, target.size)
    linkages, sweep = _drawing(problem, target, setting, progress)
    sifting = Sifting[PathDesign](problem)
    sifting.sift(
        reported(linkages, progress, (0.8, 1.0), "{done} of {all} linkages verified"),
        partial(_verified, problem, target, setting),
    )
    # Sound but inaccurate designs are counted as rejected instead of silently dropped.
    sifting.withdraw(near_the_nearest(sifting.passed, problem), FAR)
    progress(1.0, "verified")
    return PathResult(
        designs=sifting.designs(
            partial(ranked_by_nearness, problem=problem),
            partial(designs_that_differ, count=problem.max_designs, apart=SAME_DESIGN * problem.task_size),
        ),
        search=sifting.search("curve_match"),
        summary=_summary(problem, sifting, sweep),
        sweep=sweep,
    )


def fitted_by_shape(problem: PathProblem, progress: Progress) -> list[FourbarConfiguration]:
    """Return linkages whose whole curves are near the course of a problem's points, cognates included; not yet
    driven."""
    target = Target(problem)
    setting = curve_setting(problem, target.centre, target.size)
    linkages, _ = _drawing(problem, target, setting, progress)
    return [_in_place(target, joints) for joints in linkages if min(joints.lengths) >= MIN_LINK]


def stanced_by_points(
    problem: PathProblem, candidates: Sequence[Candidate], task: PointTask
) -> list[FourbarConfiguration]:
    """Lead fits of a problem's points to its stance; return them in the problem's coordinates, not yet driven."""
    target = Target(problem)
    if len(target.points) < len(problem.points):
        return []  # the last point repeats the first, and fits of a whole curve merge the two
    begun = [as_fit(candidate, task, target) for candidate in candidates]
    setting = curve_setting(problem, target.centre, target.size)
    ended = fits_in_stance(problem, target, begun, families_of(problem), setting)
    return [_in_place(target, configuration(fit)) for fit in ended]


def _drawing(
    problem: PathProblem, target: Target, setting: Real, progress: Progress
) -> tuple[list[FourbarConfiguration], CurveSweep | None]:
    """Return the linkages to be driven, in the target's unit, and the account of the curves compared for them."""
    sought = searched(problem)
    # Given pivots fix place and size, which the comparison of shapes ignores: fit points instead.
    if sought.fixed_pivots.given():
        return _at_given_pivots(sought, target, progress), None
    candidates, sweep = _alike(problem, target, setting, progress)
    return [joints for candidate in candidates for joints in with_cognates(configuration(candidate))], sweep


def _in_place(target: Target, joints: FourbarConfiguration) -> FourbarConfiguration:
    """Return a linkage in the problem's coordinates."""
    return FourbarConfiguration(*(target.centre + target.size * joint for joint in joints))


def _alike(problem: PathProblem, target: Target, setting: Real, progress: Progress) -> tuple[list[Fit], CurveSweep]:
    """Find the linkages whose curves have the target's shape and whose error is near the minimum."""
    families = families_of(problem)
    longest = float(setting[LINKS + 1])
    free: list[Fit] = []
    library: list[Compared] = []
    least = math.inf
    drawn = swept = followed = 0
    for n, family in enumerate(families):
        count = DRAWN[family, problem.closed]

        def told(share: float, n: int = n, count: int = count) -> None:
            # Comparing takes about 70 % of a family's time, refinement the rest.
            fraction = (n + 0.7 * share) / len(families)
            progress(0.6 * fraction, f"{round(count * share)} of {count} linkages compared")

        seed = problem.seed % 2**32
        library.append(compared(family, target.steps, problem.closed, count, seed=seed, progress=told))
        starts = most_alike(library[-1], MAX_FOLLOWED, longest)
        drawn, swept, followed = drawn + count, swept + starts.swept, followed + len(starts.x)
        fits, least = _free_fits(target, starts, longest, least)
        free += fits
        progress(0.6 * (n + 1.0) / len(families), "best shapes refined")
    free.sort(key=lambda fit: fit.error)

    def suited(demands: Real) -> list[Starts]:
        chosen = []
        for one in library:
            kept = shapes_kept(one.family, one.drawn.x, demands)
            chosen.append(most_alike(one, MAX_SUITED, longest, kept))
            if bounds_places(demands):

                def lost(x: Real, theta: Real, sign: Real, family: int = one.family) -> Real:
                    return all_broken(family, x, theta, sign, zoned(demands))

                # Shapes that are less similar may lie where the constraints on place require them.
                chosen.append(most_alike(one, MAX_SUITED, longest, kept, lost))
        return chosen

    asked = fits_within(target, free, partial(suited, setting), families, setting, MAX_OFFERED)
    traded: list[Fit] = []
    if problem.rank_by != "accuracy" and not math.isfinite(setting[COSINE]):
        # Without a required transmission angle accuracy alone would lead to change points, so usable linkages compete
        # as well.
        for k, degrees in enumerate(USABLE):
            progress(0.65 + 0.1 * k / len(USABLE), f"fitting with a transmission angle of {degrees:g}°")
            demands = usable(setting, degrees, MOST_UNEVEN)
            traded += fits_within(target, asked, partial(suited, demands), families, demands, MAX_USABLE)
    sweep = CurveSweep(linkages=drawn, curves=swept, refined=followed)
    if problem.stance is not None:
        progress(0.75, "fitting the stance")
        kept = fits_in_stance(problem, target, [*asked, *traded, *free], families, setting)
        if kept:
            return kept, sweep
    return _running(asked, traded), sweep


def _at_given_pivots(problem: PathProblem, target: Target, progress: Progress) -> list[FourbarConfiguration]:
    """Fit linkages with given fixed pivots to points along the target; return them in the target's unit.

    They are fitted to the target's own points and, if these are few, to equal steps too: between distant points the
    nearest linkages may stray far.
    """
    lengths = problem.constraints.link_length or LengthLimits()
    demands = problem.constraints.model_copy(
        update={"link_length": lengths.model_copy(update={"max": problem.longest_link})}
    )
    fits = [target.points, target.steps] if len(target.points) < SHAPE_POINTS else [target.points]
    linkages: list[FourbarConfiguration] = []
    begun: list[Fit] = []
    for n, along in enumerate(fits):
        part = part_of(progress, 0.8 * n / len(fits), 0.8 * (n + 1) / len(fits))
        points = [PathPoint(x=float(z.real), y=float(z.imag)) for z in target.centre + target.size * along]
        changes = {"method": "least_squares", "points": points, "constraints": demands, "stance": None}
        task = point_task(fit := problem.model_copy(update=changes))
        for candidate in fitted(fit, task, np.random.default_rng(problem.seed), part):
            joints = configuration_of(candidate, task)
            if joints is not None:
                linkages.append(FourbarConfiguration(*((joint - target.centre) / target.size for joint in joints)))
                # Only fits at the target's own points have crank angles there, as the stance needs.
                begun += [as_fit(candidate, task, target)] if along is target.points else []
    if problem.stance is not None:
        setting = curve_setting(problem, target.centre, target.size)
        return [
            configuration(fit) for fit in fits_in_stance(problem, target, begun, families_of(problem), setting)
        ] or linkages
    return linkages


def warm_up() -> None:
    """Compile or load the kernels, on a small circle, closed and open."""
    circle = np.exp(2j * np.pi * np.arange(SHAPE_POINTS) / SHAPE_POINTS)
    stated = {"points": [{"x": z.real, "y": z.imag} for z in circle]}
    problem = PathProblem.model_validate({"kind": "path", "method": "curve_match", **stated})
    setting = curve_setting(problem, 0j, 1.0)
    for family, closed in ((CRANK_ROCKER, True), (FOURBAR, False)):
        starts = alike(family, circle, closed, 64, 2)
        fit = descend(family, starts.x, starts.sign, starts.theta, circle, iterations=2)
        descend_within(family, fit.x[0], fit.theta[0], float(starts.sign[0]), circle, np.ones(SHAPE_POINTS), setting)
        descend_softly(family, fit.x, fit.theta, starts.sign, circle, setting, 1)


def _free_fits(target: Target, starts: Starts, longest: float, least: float) -> tuple[list[Fit], float]:
    """Refine the starts by least squares without constraints; return the fits, nearest first, and the minimum cost so
    far.

    ``least`` is the minimum cost at equal steps of earlier families; links longer than ``longest`` are penalized.
    """
    if not len(starts.x):
        return [], least
    family = starts.family
    rough = descend(family, starts.x, starts.sign, starts.theta, target.steps, longest=longest, iterations=ROUGH_STEPS)
    least = min(least, float(rough.cost.min()))
    best = np.argsort(rough.cost, kind="stable")[:MAX_REFINED]
    # The minimum over all families counts, so that a family without good shapes costs no refinement.
    best = best[rough.cost[best] <= MAX_COST_RATIO * max(least, SHAPE_POINTS * SHAPE_ERROR**2)]
    if not len(best):
        return [], least
    theta = np.array([target.angles(rough.theta[k]) for k in best])
    thin = thinning(target)
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
    joints = [joints_of(family, fine.x[k], float(signs[k]), float(fine.theta[k, 0]))[1] for k in order]
    order = [order[k] for k in distinct(joints, MAX_FREE, SAME_FIT)]
    # Thinned descents found the minimum; a few steps with all points remove the thinning error.
    if len(fine.theta[0]) < len(target.fitted):
        fine = _at_all_points(target, family, fine, signs, thin, longest, order)
    fits = [fit_of(target, family, fine.x[k], float(signs[k]), fine.theta[k]) for k in order]
    return sorted(fits, key=lambda fit: fit.error), least


def _at_all_points(
    target: Target, family: int, thinned: Descent, sign: Real, thin: slice, longest: float, rows: list[int]
) -> Descent:
    """Continue descents from a part of the points with all of them."""
    x, cost = thinned.x.copy(), thinned.cost.copy()
    theta = np.empty((len(x), len(target.fitted)))
    for k in rows:
        theta[k] = at_all_points(target, thinned.theta[k], thin)
    whole = descend(
        family, x[rows], sign[rows], theta[rows], target.fitted, weights=target.weights, longest=longest, iterations=ALL
    )
    x[rows], theta[rows], cost[rows] = whole.x, whole.theta, whole.cost
    return Descent(x, theta, cost)


def _running(fits: list[Fit], traded: list[Fit]) -> list[Fit]:
    """Return the distinct fits with an error near the minimum, nearest first."""
    ordered = sorted([*fits, *traded], key=lambda fit: fit.error)
    if not ordered:
        return []
    # Verification is the slowest step: only fits that could still be the answer take part.
    worst = max(ordered[0].error / NEAREST_SHARE, ERROR_TOLERANCE)
    return that_differ([fit for fit in ordered if fit.error <= worst], len(ordered))


def _verified(
    problem: PathProblem, target: Target, setting: Real, joints: FourbarConfiguration
) -> PathDesign | str | None:
    """Drive and measure a linkage given in the target's unit; return its design, or the reason for its rejection."""
    links = joints.lengths
    if min(links) < MIN_LINK:
        return "degenerate"
    if not lengths_kept(setting, links):
        return "link_length"
    # Grashof's condition: no link of such a fourbar turns through.
    if problem.closed and 2.0 * (max(links) + min(links)) > sum(links) * (1.0 + ERROR_TOLERANCE):
        return "full_rotation"
    drawn = _in_place(target, joints)
    alpha, beta = placement_of(problem, drawn)
    there = FourbarConfiguration(*(alpha * joint + beta for joint in drawn))
    at = stated(alpha, beta)
    design = verify_path(problem if at is None else moved(problem, alpha, beta), fourbar_mechanism(there))
    return design if design is None or at is None else design.model_copy(update={"placement": at})


def _summary(problem: PathProblem, sifting: Sifting[PathDesign], sweep: CurveSweep | None) -> str:
    satisfy = f"{agreeing(sifting.accepted, 'satisfies', 'satisfy')} all constraints"
    counts = f"{grouped(sifting.accepted)} of {grouped(sifting.candidates)}"
    if sweep is None:
        text = (
            f"Linkages on the given pivots were fitted to points along the curve from many starts. {counts} {satisfy}."
        )
    else:
        text = (
            f"{grouped(sweep.curves)} curves of {counted(sweep.linkages, 'linkage')} were compared with the target and "
            f"{grouped(sweep.refined)} of them refined. {counts} designs, cognates included, {satisfy}."
        )
    if sifting.passed:
        ordered = ranked_by_nearness(sifting.passed, problem)
        best = ordered[0].metrics
        unit = problem.length_unit
        text += f" The best draws the curve with an rms distance of {best.rms_distance:.3g} {unit} "
        text += f"and a maximum distance of {best.max_distance:.3g}.{choice(ordered, problem)}"
        if sweep is not None:
            text += (
                " Cognates draw the same curve; the one with pivots near the curve, good force transmission and even "
                "links comes first."
            )
    return text + sifting.reasons()
