"""Whole-curve matching: a fourbar whose coupler point draws a given closed curve or open stroke.

1. *Shape.* Some ten thousand linkages are drawn, and their curves compared with the target with position, size and
   rotation removed (:mod:`synthesis.kinds.path.curve.shape_matching`).
2. *Refinement.* The most similar ones are placed on the target and refined by least squares of the true distance
   (:mod:`synthesis.kinds.path.residuals.curve_descent`), first at equal steps along the target, then at its own points.
3. *Limits.* If a constraint is violated the descent is repeated under it
  (:mod:`synthesis.kinds.path.residuals.curve_constraints`).
4. Every linkage is offered with its cognates, which draw the same curve, from either fixed pivot, and verified.

If fixed pivots are given, the shape alone is not sufficient, because size and place are not free. Linkages are then
fitted to points along the target from many starts (:mod:`synthesis.kinds.path.points.fit`), and verified like the
others.

A closed curve must be drawn by a crank that turns through; the families of linkages are parametrized so that it does. A
stroke may be drawn by any link, between its toggles.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.fit.chart import CRANK_ROCKER, DOUBLE_CRANK, FOURBAR
from synthesis.fit.constraints import COSINE, LINKS
from synthesis.kinds.path.curve.fits import (
    FIT_DUPLICATE_TOLERANCE,
    Fit,
    build_fit,
    find_constrained_fits,
    get_configuration,
    get_thinning,
    interpolate_all_angles,
    list_cognates,
    select_distinct_fits,
)
from synthesis.kinds.path.curve.placement import (
    describe_placement,
    find_placement,
    relax_constraints,
    transform_problem,
)
from synthesis.kinds.path.curve.shape_matching import (
    ComparedShapes,
    Starts,
    compare_shapes,
    select_most_similar,
)
from synthesis.kinds.path.curve.stance_fit import convert_to_fit, find_stance_fits
from synthesis.kinds.path.design import CurveSweep, PathDesign, PathResult
from synthesis.kinds.path.points.fit import Candidate, PointTask, build_configuration, build_point_task, find_minima
from synthesis.kinds.path.problem import PathPoint, PathProblem
from synthesis.kinds.path.residuals.constraint_vector import restrict_to_zones
from synthesis.kinds.path.residuals.curve_constraints import (
    check_lengths,
    check_shapes,
    descend_constrained,
    descend_softly,
    is_place_constrained,
    measure_violations,
    pack_curve_setting,
    tighten_to_usable,
)
from synthesis.kinds.path.residuals.curve_descent import Descent, LinkageLimits, descend
from synthesis.kinds.path.residuals.families import compute_joints, list_families
from synthesis.kinds.path.results import join_sentences
from synthesis.kinds.path.results import select_distinct_designs as designs_that_differ
from synthesis.kinds.path.task.ranking import (
    ERROR_TOLERANCE,
    FAR_REASON,
    MIN_NEAREST_SHARE,
    rank_by_nearness,
    select_near,
)
from synthesis.kinds.path.task.target_curve import SHAPE_POINT_COUNT, TargetCurve
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.model.linkage.problem import LengthLimits
from synthesis.results.candidate_log import CandidateLog, report_candidates
from synthesis.results.practicality import MAX_LINK_RATIO
from synthesis.results.ranking import select_distinct

DRAW_COUNTS = {
    (CRANK_ROCKER, True): 65536,
    (DOUBLE_CRANK, True): 40960,
    (CRANK_ROCKER, False): 4096,
    (DOUBLE_CRANK, False): 4096,
    (FOURBAR, False): 8192,
}
"""Number of linkages drawn, by family and whether the target is closed. An open target is compared with 216 windows of
each curve."""

MAX_FOLLOWED = 150
"""Maximum number of starts of a family that are refined at equal steps along the target."""

MAX_REFINED = 20
"""Maximum number of the best of these linkages that are refined at the target's own points."""

MAX_ROUGH_STEPS, MAX_FINE_STEPS = 30, 300
"""Maximum number of steps of these two refinements."""

MAX_FULL_STEPS = 60
"""Maximum number of steps with all points, after a refinement with thinned ones."""

MAX_COST_RATIO, MIN_SHAPE_ERROR = 100.0, 1e-3
"""Maximum ratio of a linkage's sum of squares at equal steps to the minimum, and the error at each point, as a share of
the size, below which the sum is not decisive, because the steps lie on straight lines between the points."""

MAX_FREE = 14
"""Maximum number of distinct refined linkages of a family that are processed further."""

MAX_SUITABLE = 60
"""Maximum number of linkages of a family that satisfy the constraints on shape and start constrained fits."""

USABLE_ANGLES, MAX_USABLE = (20.0, 30.0, 40.0), 3
"""Transmission angles, degrees, for which designs are offered in addition to the nearest one if none is required, and
the maximum number of designs for each. Free fits tend to change points, where the transmission angle vanishes."""

MAX_OFFERED = 10
"""Maximum number of linkages, each with its cognates, that are verified."""

DESIGN_DUPLICATE_TOLERANCE = 1e-4
"""Designs whose joints agree to this share of the curve's size are duplicates: fits of different accuracy."""

MIN_LINK = 1e-7
"""Linkages with a link shorter than this share of the curve's size are degenerate."""


def solve_curve_match(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation by matching the whole curve."""
    target = TargetCurve(problem)
    setting = pack_curve_setting(relax_constraints(problem), target.centre, target.size)
    linkages, sweep = _find_linkages(problem, target, setting, progress)
    sifting = CandidateLog[PathDesign](problem)
    sifting.verify_candidates(
        report_candidates(linkages, progress, (0.8, 1.0), "path-linkages-verified"),
        partial(_verify_linkage, problem, target, setting),
    )
    # Sound but inaccurate designs are counted as rejected instead of silently dropped.
    sifting.withdraw(select_near(sifting.passed, problem), FAR_REASON)
    progress(1.0, compose("path-verified"))
    designs = sifting.select_designs(
        partial(rank_by_nearness, problem=problem),
        partial(designs_that_differ, count=problem.max_designs, apart=DESIGN_DUPLICATE_TOLERANCE * problem.task_size),
    )
    return PathResult(
        designs=designs,
        search=sifting.build_search("curve_match"),
        summary=_describe_result(problem, designs, sifting, sweep),
        sweep=sweep,
    )


def fit_by_shape(problem: PathProblem, progress: Progress) -> list[FourbarConfiguration]:
    """Return linkages, with their cognates, whose whole curves are near the course of a problem's points.

    They are not yet driven.
    """
    target = TargetCurve(problem)
    setting = pack_curve_setting(problem, target.centre, target.size)
    linkages, _ = _find_linkages(problem, target, setting, progress)
    return [_place_in_plane(target, joints) for joints in linkages if min(joints.lengths) >= MIN_LINK]


def fit_stance_from_points(
    problem: PathProblem, candidates: Sequence[Candidate], task: PointTask
) -> list[FourbarConfiguration]:
    """Refit fits of a problem's points under its stance; return them in the problem's coordinates, not yet driven."""
    target = TargetCurve(problem)
    if len(target.points) < len(problem.points):
        return []  # the last point repeats the first, and fits of a whole curve merge the two
    begun = [convert_to_fit(candidate, task, target) for candidate in candidates]
    setting = pack_curve_setting(problem, target.centre, target.size)
    ended = find_stance_fits(problem, target, begun, list_families(problem), setting)
    return [_place_in_plane(target, get_configuration(fit)) for fit in ended]


def _find_linkages(
    problem: PathProblem, target: TargetCurve, setting: Real, progress: Progress
) -> tuple[list[FourbarConfiguration], CurveSweep | None]:
    """Return the linkages to be driven, in the target's unit, and the account of the curves compared for them."""
    sought = relax_constraints(problem)
    # Given pivots fix place and size, which the comparison of shapes ignores: fit points instead.
    if sought.fixed_pivots.count_given():
        return _fit_at_given_pivots(sought, target, progress), None
    candidates, sweep = _match_shapes(problem, target, setting, progress)
    return [joints for candidate in candidates for joints in list_cognates(get_configuration(candidate))], sweep


def _place_in_plane(target: TargetCurve, joints: FourbarConfiguration) -> FourbarConfiguration:
    """Return a linkage in the problem's coordinates."""
    return FourbarConfiguration(*(target.centre + target.size * joint for joint in joints))


def _match_shapes(
    problem: PathProblem, target: TargetCurve, setting: Real, progress: Progress
) -> tuple[list[Fit], CurveSweep]:
    """Find the linkages whose curves have the target's shape and whose error is near the minimum."""
    families = list_families(problem)
    longest = float(setting[LINKS][1])
    free: list[Fit] = []
    library: list[ComparedShapes] = []
    least = math.inf
    drawn = swept = followed = 0
    for n, family in enumerate(families):
        count = DRAW_COUNTS[family, problem.closed]

        def report_share(share: float, n: int = n, count: int = count) -> None:
            # Comparing takes about 70 % of a family's time, refinement the rest.
            fraction = (n + 0.7 * share) / len(families)
            progress(0.6 * fraction, compose("path-linkages-compared", done=round(count * share), count=count))

        seed = problem.seed % 2**32
        library.append(compare_shapes(family, target.steps, problem.closed, count, seed=seed, progress=report_share))
        starts = select_most_similar(library[-1], MAX_FOLLOWED, longest)
        drawn, swept, followed = drawn + count, swept + starts.swept, followed + len(starts.x)
        fits, least = _refine_free(target, starts, longest, least)
        free += fits
        progress(0.6 * (n + 1.0) / len(families), compose("path-best-shapes-refined"))
    free.sort(key=lambda fit: fit.error)

    def select_suitable(demands: Real) -> list[Starts]:
        chosen = []
        for one in library:
            kept = check_shapes(one.family, one.drawn.x, demands)
            chosen.append(select_most_similar(one, MAX_SUITABLE, longest, kept))
            if is_place_constrained(demands):

                def evaluate_violation(x: Real, theta: Real, sign: Real, family: int = one.family) -> Real:
                    return measure_violations(family, x, theta, sign, restrict_to_zones(demands))

                # Shapes that are less similar may lie where the constraints on place require them.
                chosen.append(select_most_similar(one, MAX_SUITABLE, longest, kept, evaluate_violation))
        return chosen

    constrained = find_constrained_fits(target, free, partial(select_suitable, setting), families, setting, MAX_OFFERED)
    traded: list[Fit] = []
    if problem.rank_by != "accuracy" and not math.isfinite(setting[COSINE]):
        # Without a required transmission angle accuracy alone would lead to change points, so usable linkages compete
        # as well.
        for k, degrees in enumerate(USABLE_ANGLES):
            progress(0.65 + 0.1 * k / len(USABLE_ANGLES), compose("path-fitting-with-angle", angle=f"{degrees:g}"))
            demands = tighten_to_usable(setting, degrees, MAX_LINK_RATIO)
            traded += find_constrained_fits(
                target, constrained, partial(select_suitable, demands), families, demands, MAX_USABLE
            )
    sweep = CurveSweep(linkages=drawn, curves=swept, refined=followed)
    if problem.stance is not None:
        progress(0.75, compose("path-fitting-stance"))
        kept = find_stance_fits(problem, target, [*constrained, *traded, *free], families, setting)
        if kept:
            return kept, sweep
    return _select_candidates(constrained, traded), sweep


def _fit_at_given_pivots(problem: PathProblem, target: TargetCurve, progress: Progress) -> list[FourbarConfiguration]:
    """Fit linkages with given fixed pivots to points along the target; return them in the target's unit.

    They are fitted to the target's own points and, if these are few, to equal steps too: between distant points the
    nearest linkages may stray far.
    """
    lengths = problem.constraints.link_length or LengthLimits()
    demands = problem.constraints.model_copy(
        update={"link_length": lengths.model_copy(update={"max": problem.longest_link})}
    )
    fits = [target.points, target.steps] if len(target.points) < SHAPE_POINT_COUNT else [target.points]
    linkages: list[FourbarConfiguration] = []
    begun: list[Fit] = []
    for n, along in enumerate(fits):
        part = scale_progress(progress, 0.8 * n / len(fits), 0.8 * (n + 1) / len(fits))
        points = [PathPoint(x=float(z.real), y=float(z.imag)) for z in target.centre + target.size * along]
        changes = {"method": "least_squares", "points": points, "constraints": demands, "stance": None}
        task = build_point_task(fit := problem.model_copy(update=changes))
        for candidate in find_minima(fit, task, np.random.default_rng(problem.seed), part):
            joints = build_configuration(candidate, task)
            if joints is not None:
                linkages.append(FourbarConfiguration(*((joint - target.centre) / target.size for joint in joints)))
                # Only fits at the target's own points have crank angles there, as the stance needs.
                begun += [convert_to_fit(candidate, task, target)] if along is target.points else []
    if problem.stance is not None:
        setting = pack_curve_setting(problem, target.centre, target.size)
        return [
            get_configuration(fit) for fit in find_stance_fits(problem, target, begun, list_families(problem), setting)
        ] or linkages
    return linkages


def warm_up() -> None:
    """Compile or load the kernels, on a small circle, closed and open."""
    circle = np.exp(2j * np.pi * np.arange(SHAPE_POINT_COUNT) / SHAPE_POINT_COUNT)
    stated = {"points": [{"x": z.real, "y": z.imag} for z in circle]}
    problem = PathProblem.model_validate({"kind": "path", "method": "curve_match", **stated})
    setting = pack_curve_setting(problem, 0j, 1.0)
    for family, closed in ((CRANK_ROCKER, True), (FOURBAR, False)):
        starts = select_most_similar(compare_shapes(family, circle, closed, 64), 2)
        fit = descend(family, starts.x, starts.sign, starts.theta, circle, iterations=2)
        descend_constrained(
            family, fit.x[0], fit.theta[0], float(starts.sign[0]), circle, np.ones(SHAPE_POINT_COUNT), setting
        )
        descend_softly(family, fit.x, fit.theta, starts.sign, circle, setting, 1)


def _refine_free(target: TargetCurve, starts: Starts, longest: float, least: float) -> tuple[list[Fit], float]:
    """Refine starts by least squares without constraints; return the fits, nearest first, and the minimum cost.

    ``least`` is the minimum cost at equal steps of earlier families; links longer than ``longest`` are penalized.
    """
    if not len(starts.x):
        return [], least
    family, limits = starts.family, LinkageLimits(longest=longest)
    rough = descend(family, starts.x, starts.sign, starts.theta, target.steps, limits, iterations=MAX_ROUGH_STEPS)
    least = min(least, float(rough.cost.min()))
    best = np.argsort(rough.cost, kind="stable")[:MAX_REFINED]
    # The minimum over all families counts, so that a family without good shapes costs no refinement.
    best = best[rough.cost[best] <= MAX_COST_RATIO * max(least, SHAPE_POINT_COUNT * MIN_SHAPE_ERROR**2)]
    if not len(best):
        return [], least
    theta = np.array([target.interpolate_angles(rough.theta[k]) for k in best])
    thin = get_thinning(target)
    fine = descend(
        family,
        rough.x[best],
        starts.sign[best],
        theta[:, thin],
        target.fitted[thin],
        limits,
        weights=target.weights[thin],
        iterations=MAX_FINE_STEPS,
    )
    signs = starts.sign[best]
    order = [k for k in np.argsort(fine.cost, kind="stable") if math.isfinite(fine.cost[k])]
    joints = [compute_joints(family, fine.x[k], float(signs[k]), float(fine.theta[k, 0]))[1] for k in order]
    order = [order[k] for k in select_distinct(joints, MAX_FREE, FIT_DUPLICATE_TOLERANCE)]
    # Thinned descents found the minimum; a few steps with all points remove the thinning error.
    if len(fine.theta[0]) < len(target.fitted):
        fine = _continue_with_all_points(target, family, fine, signs, thin, longest, order)
    fits = [build_fit(target, family, fine.x[k], float(signs[k]), fine.theta[k]) for k in order]
    return sorted(fits, key=lambda fit: fit.error), least


def _continue_with_all_points(
    target: TargetCurve, family: int, thinned: Descent, sign: Real, thin: slice, longest: float, rows: list[int]
) -> Descent:
    """Continue descents that used thinned points with all points."""
    x, cost = thinned.x.copy(), thinned.cost.copy()
    theta = np.empty((len(x), len(target.fitted)))
    for k in rows:
        theta[k] = interpolate_all_angles(target, thinned.theta[k], thin)
    whole = descend(
        family,
        x[rows],
        sign[rows],
        theta[rows],
        target.fitted,
        LinkageLimits(longest=longest),
        weights=target.weights,
        iterations=MAX_FULL_STEPS,
    )
    x[rows], theta[rows], cost[rows] = whole.x, whole.theta, whole.cost
    return Descent(x, theta, cost)


def _select_candidates(fits: list[Fit], traded: list[Fit]) -> list[Fit]:
    """Return the distinct fits with an error near the minimum, nearest first."""
    ordered = sorted([*fits, *traded], key=lambda fit: fit.error)
    if not ordered:
        return []
    # Verification is the slowest step: only fits that could still be the answer take part.
    worst = max(ordered[0].error / MIN_NEAREST_SHARE, ERROR_TOLERANCE)
    return select_distinct_fits([fit for fit in ordered if fit.error <= worst], len(ordered))


def _verify_linkage(
    problem: PathProblem, target: TargetCurve, setting: Real, joints: FourbarConfiguration
) -> PathDesign | str | None:
    """Drive and measure a linkage given in the target's unit; return its design, or the reason for its rejection."""
    links = joints.lengths
    if min(links) < MIN_LINK:
        return "degenerate"
    if not check_lengths(setting, links):
        return "link_length"
    # Grashof's condition: no link of such a fourbar turns through.
    if problem.closed and 2.0 * (max(links) + min(links)) > sum(links) * (1.0 + ERROR_TOLERANCE):
        return "full_rotation"
    drawn = _place_in_plane(target, joints)
    alpha, beta = find_placement(problem, drawn)
    there = FourbarConfiguration(*(alpha * joint + beta for joint in drawn))
    at = describe_placement(alpha, beta)
    design = verify_path(problem if at is None else transform_problem(problem, alpha, beta), build_fourbar(there))
    return design if design is None or at is None else design.model_copy(update={"placement": at})


def _describe_result(
    problem: PathProblem, designs: Sequence[PathDesign], sifting: CandidateLog[PathDesign], sweep: CurveSweep | None
) -> str:
    if sweep is None:
        sentences = [
            compose("path-curve-fitted-on-pivots"),
            compose("path-some-passed", passed=sifting.accepted, count=sifting.candidates),
        ]
    else:
        sentences = [
            compose("path-curves-compared", curves=sweep.curves, linkages=sweep.linkages, refined=sweep.refined),
            compose("path-designs-and-cognates-passed", passed=sifting.accepted, count=sifting.candidates),
        ]
    if sifting.passed:
        best = designs[0].metrics
        sentences += [
            compose(
                "path-best-curve",
                rms_distance=f"{best.rms_distance:.3g}",
                max_distance=f"{best.max_distance:.3g}",
                unit=problem.length_unit,
            ),
            "" if sweep is None else compose("path-cognates-ranked"),
        ]
    return join_sentences([*sentences, sifting.describe_reasons()])
