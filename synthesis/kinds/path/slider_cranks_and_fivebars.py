"""Slider-cranks and geared fivebars that guide a point: exactly, by least squares, or along a whole curve.

The same search serves all three: shapes of many linkages are compared with a curve through the points, the most similar
ones are refined by least squares at the points with the crank angle at each as an unknown, and the results are driven.
At most as many points as a linkage has dimensions are met exactly (eight by a slider-crank, eleven by a geared fivebar
of given ratio). The freedom that fewer points leave goes into the constraints and the ranking.

A geared fivebar of ratio +1 that draws the curve of a fourbar is known from it (Norton, Sec. 3.7 and Fig. 3-28): O2 A P
A′ and O4 B P B′ are parallelograms, the cranks O2 A′ and O4 B′ turn with the fourbar's coupler, and P is the pin of the
couplers A′ P and B′ P. For whole curves these cognates of the best fourbars are offered too.
"""

from __future__ import annotations

import cmath
import math
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.fit.chart import GEARED_FIVEBAR, SLIDER_CRANK, SLIDER_ROCKER, compute_lengths
from synthesis.fit.coupler_curve import place_linkage
from synthesis.kinds.path.curve.fits import list_cognates
from synthesis.kinds.path.curve.random_linkages import compute_cycle
from synthesis.kinds.path.curve.shape_matching import compare_shapes, select_most_similar
from synthesis.kinds.path.curve.solver import solve_curve_match
from synthesis.kinds.path.curve.stance_fit import fit_simple_stance, pack_no_stance, pack_stance
from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.curve_constraints import compute_pivot_limits
from synthesis.kinds.path.residuals.curve_descent import Descent, LinkageLimits, descend, measure_pivot_violations
from synthesis.kinds.path.results import join_sentences
from synthesis.kinds.path.task.ranking import FAR_REASON, build_ordering, drop_straying
from synthesis.kinds.path.task.target_curve import interpolate_crank_angles, sample_smooth_steps
from synthesis.kinds.path.verification.linkage import verify_traced
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.answer import (
    CouplerPoint,
    FivebarLinks,
    FixedPivots,
    GearedFivebarMechanism,
    GearPair,
    SliderCrankMechanism,
)
from synthesis.model.linkage.conversion import (
    FourbarConfiguration,
    build_skeleton,
    build_slider_crank,
    to_complex,
    to_point,
)
from synthesis.numerics.portions import run_in_portions
from synthesis.results.candidate_log import CandidateLog, report_candidates
from synthesis.results.practicality import MIN_USABLE_ANGLE
from synthesis.results.ranking import select_distinct

Mechanism = SliderCrankMechanism | GearedFivebarMechanism

CLOSED_DRAW_COUNT, OPEN_DRAW_COUNT = 49152, 8192
"""Number of linkages of a family drawn for a closed curve, and for a stroke, with which parts of each curve are
compared."""

MAX_FOLLOWED, MAX_REFINED, MAX_DRIVEN = 150, 24, 16
"""Maximum numbers: of similar linkages that are fitted to the points; of the best of them that are refined; and of
those that are driven."""

KICK_ROUNDS, MAX_KICKED, COPY_COUNT, KICK_SIZE, KICK_SPREAD = 4, 24, 8, 0.3, 0.8
"""Perturbation of the best for exact points: number of rounds, of linkages, of copies of each; standard deviation of
the change of their unknowns, and of its logarithm: some changes are small and some are large."""

NON_LOG_KICK_SHARE = 0.4
"""Share of that standard deviation for unknowns that are not logarithms of lengths."""

MAX_FOLLOWED_RETRY = 600
"""Maximum number of similar linkages fitted if none of the first few meets the points."""

MAX_ROUGH_STEPS, MAX_KICKED_STEPS, MAX_STEPS = 40, 150, 250
"""Maximum number of least-squares steps: of all followed linkages, of perturbed copies, and of the best."""

COST_TOLERANCE = 1e-22
"""Sum of squared distances, in squares of the task's size, at which exact points count as met."""

GEAR_RATIOS = (1.0, -1.0, 2.0, -2.0)
"""Gear ratios that are tried if none is given."""

DESIGN_DUPLICATE_TOLERANCE = 1e-4
"""Designs whose joints agree to this share of the task's size are duplicates."""

MAX_COGNATES = 3
"""Maximum number of fourbars whose geared cognates, up to three for each, are offered."""

MIN_TRANSMISSION_ANGLE, ANGLE_MARGIN = 3.0, 0.01
"""Minimum transmission angle, degrees, of every slider-crank whose crank turns through, and the margin added to a
required one."""

MIN_LINK = 1e-6
"""Linkages with a link shorter than this share of the task's size are degenerate."""

_Fit = tuple[tuple[bool, float], Mechanism]
"""Sort key of a fit (whether other constraints fail, and the sum of squares), and the linkage."""


class _Search(NamedTuple):
    """The problem of a search, and the coordinates in which it is solved.

    Attributes
    ----------
    problem : PathProblem
    tasks : list of tuple
        Family and gear ratio.
    centre, size : complex, float
        The points' centroid, and the unit of the fits, in length units.
    """

    problem: PathProblem
    tasks: list[tuple[int, float]]
    centre: complex
    size: float


def solve_other_linkages(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation by a slider-crank or geared fivebar."""
    given = np.array([point.point for point in problem.points])
    turns = problem.closed or problem.constraints.full_rotation
    tasks: list[tuple[int, float]]
    if problem.mechanism == "slider_crank":
        # The crank of a slider-rocker does not turn through.
        tasks = [(SLIDER_CRANK, 0.0)] if turns else [(SLIDER_CRANK, 0.0), (SLIDER_ROCKER, 0.0)]
    else:
        tasks = [
            (GEARED_FIVEBAR, ratio) for ratio in (GEAR_RATIOS if problem.gear_ratio is None else (problem.gear_ratio,))
        ]
    search = _Search(problem, tasks, complex(given.mean()), problem.task_size)
    drawn = CLOSED_DRAW_COUNT if problem.closed else OPEN_DRAW_COUNT
    # Four gear ratios would take four times as long; half the draws each are enough.
    few = drawn // (1 if len(tasks) < 3 else 2)
    fits = _find_fits(search, few, MAX_FOLLOWED, 0, scale_progress(progress, 0.0, 0.7 if problem.is_fitted else 0.35))
    if not (fits or problem.is_fitted) and problem.gear_ratio is not None:
        # No exact member found: try once more with many more starts and another seed.
        fits = _find_fits(search, CLOSED_DRAW_COUNT, MAX_FOLLOWED_RETRY, 1, scale_progress(progress, 0.35, 0.7))
    fits.sort(key=lambda fit: fit[0])
    mechanisms = _select_distinct([mechanism for _, mechanism in fits], search.size)
    if problem.is_matched and (GEARED_FIVEBAR, 1.0) in tasks:
        mechanisms += _build_from_fourbars(problem, progress)
    return _build_result(problem, mechanisms, progress)


def _find_fits(search: _Search, drawn: int, followed: int, again: int, progress: Progress) -> list[_Fit]:
    """Fit linkages to the points; exact points are met by all linkages returned.

    ``drawn`` linkages of each family are generated, and the ``followed`` most similar ones fitted; ``again`` counts the
    repetitions and changes the seed.
    """
    problem, tasks, centre, size = search
    points = (np.array([point.point for point in problem.points]) - centre) / size
    target, places = sample_smooth_steps(points, problem.closed)
    within = compute_pivot_limits(problem, centre, size)
    longest = problem.longest_link / size
    fits: list[_Fit] = []
    for n, (family, ratio) in enumerate(tasks):

        def report_comparison(share: float, n: int = n) -> None:
            progress((n + 0.8 * share) / len(tasks), compose("path-shapes-compared"))

        rng = np.random.default_rng([problem.seed, n + len(tasks) * again])
        compared = compare_shapes(
            family,
            target,
            problem.closed,
            drawn,
            ratio=ratio,
            seed=int(rng.integers(2**31)),
            progress=report_comparison,
        )
        starts = select_most_similar(compared, followed, longest)
        if not len(starts.x):
            continue
        cycle = compute_cycle(ratio) if family == GEARED_FIVEBAR else 0.0
        # Slider-cranks repeat after one turn; their cycle of 0 only switches off the jam check.
        span = cycle or 2.0 * math.pi
        theta = np.array([interpolate_crank_angles(places, angles, problem.closed, span) for angles in starts.theta])
        limits = LinkageLimits(ratio, longest, cycle, within)
        rough = descend(family, starts.x, starts.sign, theta, points, limits, iterations=MAX_ROUGH_STEPS)
        begun = _PartialFits(rough.x, starts.sign, rough.theta, rough.cost)
        # Geared fivebars have so many dimensions that most descents to exact points end in local minima.
        if family == GEARED_FIVEBAR and not problem.is_fitted:
            begun = _perturb_best(begun, points, limits, rng)
        best = np.argsort(begun.cost, kind="stable")[: MAX_REFINED if problem.is_fitted else None]
        best = best[np.isfinite(begun.cost[best])]
        if not len(best):
            continue
        fine = descend(family, begun.x[best], begun.sign[best], begun.theta[best], points, limits, iterations=MAX_STEPS)
        # No angle is enforced for a rocker: if one is required, linkages that satisfy it come first.
        sign, arrived = begun.sign[best], np.full(len(best), problem.constraints.min_transmission_angle is None)
        if problem.stance is not None or (problem.is_fitted and (family == SLIDER_CRANK or np.isfinite(within).any())):
            fine, sign, arrived = _fit_constrained(search, family, fine, sign, points, limits)
        for k in np.argsort(fine.cost, kind="stable"):
            if math.isfinite(fine.cost[k]) and (problem.is_fitted or fine.cost[k] <= COST_TOLERANCE):
                theta_k = float(fine.theta[k, 0])
                mechanism = _build_mechanism(family, fine.x[k], float(sign[k]), ratio, theta_k, centre, size)
                if mechanism is not None:
                    fits.append(((not arrived[k], float(fine.cost[k])), mechanism))
        progress((n + 1.0) / len(tasks), compose("path-linkages-fitted", count=len(fits)))
    return fits


def _list_min_angles(problem: PathProblem) -> list[float]:
    """Return the minimum transmission angles, degrees, to enforce on slider-cranks.

    The required angle if given; otherwise one that avoids change points, and a usable one.
    """
    stated = problem.constraints.min_transmission_angle
    if stated is not None:
        return [stated + ANGLE_MARGIN]
    return (
        [MIN_TRANSMISSION_ANGLE]
        if problem.rank_by == "accuracy"
        else [MIN_TRANSMISSION_ANGLE, MIN_USABLE_ANGLE + ANGLE_MARGIN]
    )


def _fit_constrained(
    search: _Search, family: int, fits: Descent, sign: Real, points: Complex, limits: LinkageLimits
) -> tuple[Descent, Real, NDArray[np.bool_]]:
    """Refit linkages under the stance, the required fixed pivots and one or more transmission angles.

    In an unconstrained descent the distances of pivots and of points trade against each other. Both vanish for exact
    points, but not for fits.

    Returns
    -------
    tuple
        All ends for all angles, their assembly signs, and the mask of successful ones; the others are unchanged.
    """
    problem = search.problem
    if problem.stance is None:
        spec = pack_no_stance(len(points))
    else:
        first, last = problem.stance.points
        spec = pack_stance(problem, search.size, first, last, limits.cycle or 2.0 * math.pi)
    within = limits.within
    given = np.flatnonzero(within[:, 0] == within[:, 1])
    angles = _list_min_angles(problem) if family == SLIDER_CRANK else [0.0]
    # Every fit is tried with every angle; the better ones are selected after verification.
    cosines = np.repeat(np.cos(np.radians(angles)), len(sign))
    x, theta, cost = (np.concatenate([column] * len(angles)) for column in fits)
    signs, arrived = np.tile(sign, len(angles)), np.zeros(len(cost), np.bool_)

    def process_portion(some: slice) -> None:
        for k in range(*some.indices(len(x))):
            # Fits that already satisfy the constraints need no further descent.
            if problem.stance is None and _check_constraints(family, x[k], within, float(cosines[k])):
                arrived[k] = True
            elif math.isfinite(cost[k]):
                end = fit_simple_stance(
                    family, x[k], float(signs[k]), theta[k], points, spec, limits, float(cosines[k])
                )
                if end is not None:
                    x[k], theta[k], cost[k], arrived[k] = end.x, end.theta, 2.0 * end.cost, True
                    # The multipliers meet given coordinates only up to their tolerance; set them exactly.
                    x[k, given] = within[given, 0]

    run_in_portions(process_portion, len(x), 1)
    return Descent(x, theta, cost), signs, arrived


def _check_constraints(family: int, x: Real, within: Real, cosine: float) -> bool:
    """Return whether a fit satisfies the limits of its fixed pivots and, as a slider-crank, the transmission angle."""
    lengths, chart = np.zeros(4), np.zeros((4, 4))
    compute_lengths(family, x, lengths, chart)
    off, slopes = np.zeros(4), np.zeros((4, len(x)))
    placed = measure_pivot_violations(family, x, lengths, chart, within, off, slopes) == 0.0
    return placed and (family != SLIDER_CRANK or lengths[0] + abs(lengths[2]) <= cosine * lengths[1])


class _PartialFits(NamedTuple):
    """Linkages during the search.

    They consist of unknowns (n, m), assembly signs (n,), crank angles (n, points) and sums of squares (n,).
    """

    x: Real
    sign: Real
    theta: Real
    cost: Real


def _perturb_best(ends: _PartialFits, points: Complex, limits: LinkageLimits, rng: np.random.Generator) -> _PartialFits:
    """Perturb the best geared fivebars and descend again, until enough meet the points; return old and new ends.

    Places and angles are in the points' unit and in radians; logarithms of lengths are changed the most.
    """
    found = ends
    logs = slice(4, 8)
    for _ in range(KICK_ROUNDS):
        if np.count_nonzero(found.cost <= COST_TOLERANCE) >= MAX_DRIVEN:
            break
        best = np.argsort(found.cost, kind="stable")[:MAX_KICKED]
        chosen = np.repeat(best[np.isfinite(found.cost[best])], COPY_COUNT)
        if not len(chosen):
            break
        reach = KICK_SIZE * np.exp(KICK_SPREAD * rng.normal(size=(len(chosen), 1)))
        change = reach * rng.normal(size=(len(chosen), found.x.shape[1]))
        change[:, : logs.start] *= NON_LOG_KICK_SHARE
        change[:, logs.stop :] *= NON_LOG_KICK_SHARE
        x, sign = found.x[chosen] + change, found.sign[chosen]
        near = descend(GEARED_FIVEBAR, x, sign, found.theta[chosen], points, limits, iterations=MAX_KICKED_STEPS)
        more = _PartialFits(near.x, sign, near.theta, near.cost)
        found = _PartialFits(*(np.concatenate(both) for both in zip(found, more, strict=True)))
    return found


def _build_from_fourbars(problem: PathProblem, progress: Progress) -> list[Mechanism]:
    """Return the geared fivebars that draw the curves of the best fourbars."""
    fourbar_problem = problem.model_copy(
        update={"mechanism": "fourbar", "gear_ratio": None, "max_designs": MAX_COGNATES, "layout": None, "stance": None}
    )
    fourbars = solve_curve_match(fourbar_problem, lambda share, message: progress(0.7, message))
    cognates: list[Mechanism] = []
    for design in fourbars.designs:
        joints = (to_complex(design.mechanism.skeleton.joints[name]) for name in ("O2", "A", "B", "O4", "P"))
        cognates += build_cognate_fivebars(FourbarConfiguration(*joints))
    return _select_distinct(cognates, problem.task_size)


def build_cognate_fivebars(joints: FourbarConfiguration) -> list[GearedFivebarMechanism]:
    """Return the geared fivebars of ratio +1 that draw a fourbar's coupler curve, in its configuration."""
    fivebars = []
    for o2, a, b, o4, p in list_cognates(joints):
        # O2 A P A′ and O4 B P B′ are parallelograms, so that both cranks turn with the fourbar's coupler.
        mechanism = build_geared_fivebar(o2, o2 + p - a, p, o4 + p - b, o4, p, 1.0, cmath.phase(p - a))
        if mechanism is not None:
            fivebars.append(mechanism)
    return fivebars


def build_geared_fivebar(
    o2: complex, a: complex, c: complex, b: complex, o5: complex, p: complex, ratio: float, input_angle: float
) -> GearedFivebarMechanism | None:
    """Return the dimensions of the geared fivebar with the given joints; None if a link has no length.

    ``input_angle`` is the crank's, radians; its full turns count if the gear ratio is not an integer.
    """
    ground, coupler = o5 - o2, c - a
    if min(abs(ground), abs(a - o2), abs(coupler), abs(c - b), abs(b - o5)) == 0.0:
        return None
    along = cmath.phase(ground)
    point = (p - a) / (coupler / abs(coupler))
    # Angles are measured from the ground line, so that the phase does not depend on the place in the plane.
    phase = cmath.phase(b - o5) - along - ratio * (input_angle - along)
    joints = {"O2": o2, "O5": o5, "A": a, "B": b, "C": c, "P": p}
    return GearedFivebarMechanism(
        fixed_pivots=FixedPivots(input=to_point(o2), output=to_point(o5)),
        links=FivebarLinks(
            ground=abs(ground), input=abs(a - o2), coupler_1=abs(coupler), coupler_2=abs(c - b), output=abs(b - o5)
        ),
        gear_ratio=ratio,
        phase=math.degrees(math.remainder(phase, 2.0 * math.pi)),
        coupler_point=CouplerPoint(distance=abs(point), angle=math.degrees(cmath.phase(point)) if point else 0.0),
        assembly="open" if ((b - a).conjugate() * coupler).imag >= 0.0 else "crossed",
        reference_input_angle=math.degrees(input_angle),
        skeleton=build_skeleton(
            joints,
            {
                "ground": ["O2", "O5"],
                "input": ["O2", "A"],
                "coupler_1": ["A", "C", "P"],
                "coupler_2": ["B", "C"],
                "output": ["O5", "B"],
            },
            gears=[GearPair(links=("input", "output"), ratio=ratio)],
        ),
    )


def _build_mechanism(
    family: int, x: Real, sign: float, ratio: float, theta: float, centre: complex, size: float
) -> Mechanism | None:
    """Return the dimensions of a fit in the problem's coordinates.

    Returns None if a link is shorter than :data:`MIN_LINK`.
    """
    lengths, chart = np.zeros(4), np.zeros((4, 4))
    compute_lengths(family, x, lengths, chart)
    closes, p, unit = place_linkage(family, x, lengths, sign, ratio, theta)
    if not closes:
        return None

    def place_point(z: complex) -> complex:
        return complex(centre + size * z)

    o2 = complex(x[0], x[1])
    a = o2 + cmath.rect(float(lengths[0]), theta)
    if family == GEARED_FIVEBAR:
        o5 = complex(x[2], x[3])
        b, c = o5 + cmath.rect(float(lengths[3]), ratio * theta + float(x[8])), a + lengths[1] * unit
        if min(*lengths, abs(o5 - o2)) < MIN_LINK:
            return None
        return build_geared_fivebar(
            place_point(o2),
            place_point(a),
            place_point(c),
            place_point(b),
            place_point(o5),
            place_point(p),
            ratio,
            theta,
        )
    if min(lengths[0], lengths[1]) < MIN_LINK:
        return None
    return build_slider_crank(
        place_point(o2), place_point(a), place_point(a + lengths[1] * unit), float(x[2]), place_point(p)
    )


def _select_distinct(mechanisms: list[Mechanism], size: float) -> list[Mechanism]:
    """Return the first distinct mechanisms, at most :data:`MAX_DRIVEN`."""
    joints = [[to_complex(joint) for joint in mechanism.skeleton.joints.values()] for mechanism in mechanisms]
    return [mechanisms[n] for n in select_distinct(joints, MAX_DRIVEN, DESIGN_DUPLICATE_TOLERANCE * size)]


def _build_result(problem: PathProblem, mechanisms: list[Mechanism], progress: Progress) -> PathResult:
    """Drive the mechanisms, rank the ones that pass, and build the result."""
    in_rank = build_ordering(problem)
    sifting = CandidateLog[PathDesign](problem)
    sifting.verify_candidates(
        report_candidates(mechanisms, progress, (0.7, 1.0), "path-linkages-driven"),
        partial(verify_traced, problem),
    )
    if problem.is_fitted:
        sifting.withdraw(drop_straying(sifting.passed, problem), FAR_REASON)
    progress(1.0, compose("path-verified"))
    sentences = [
        compose(
            "path-slider-cranks-passed" if problem.mechanism == "slider_crank" else "path-geared-fivebars-passed",
            passed=sifting.accepted,
            count=sifting.candidates,
        )
    ]
    if sifting.passed and problem.is_fitted:
        best = in_rank(sifting.passed)[0].metrics
        sentences.append(
            compose("path-best-distance", rms_distance=f"{best.rms_distance:.3g}", unit=problem.length_unit)
        )
    sentences.append(sifting.describe_reasons())
    if not sifting.passed:
        sentences.append(compose("path-none-found"))
    method = "curve_match" if problem.is_matched else "least_squares" if problem.is_fitted else "family_search"
    return PathResult(
        designs=sifting.select_designs(in_rank),
        search=sifting.build_search(method),
        summary=join_sentences(sentences),
    )
