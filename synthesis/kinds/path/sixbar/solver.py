"""Sixbars that guide a point along a curve or past points: shapes compared, the most similar fitted, the best driven.

For every form of the requested types (:data:`~synthesis.kinds.path.sixbar.shape_matching.FORMS`):

1. sixbars are drawn and their curves compared with the target; the most similar are placed on it;
2. they descend on all of their dimensions at equal steps along the target, with the constraints as penalties;
3. copies of the best with changed dimensions descend again: such descents end in many minima.

The best of all forms are then fitted to the points themselves, and to the curve between them if the points define it,
with all constraints enforced. :mod:`synthesis.kinds.path.residuals.sixbar` lists the constraints known to the kernels;
all constraints are verified on the driven sixbar. If no transmission angle is required, at least
:data:`~synthesis.results.simplest_type.SOUND_TRANSMISSION_ANGLE` degrees are the aim.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.kinds.path.curve.fits import get_thinning
from synthesis.kinds.path.curve.stance_fit import pack_target_stance
from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.fallback import solve_exactly_or_fit
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.results import join_sentences
from synthesis.kinds.path.sixbar.fit import CrankSteps, SixbarFits, descend_softly, fit_constrained, pack_sixbar_setting
from synthesis.kinds.path.sixbar.mechanism import build_fitted_sixbar
from synthesis.kinds.path.sixbar.shape_matching import FAMILIES, FORMS, find_similar_sixbars
from synthesis.kinds.path.task.ranking import (
    FAR_REASON,
    MAX_LINK_RATIO,
    build_ordering,
    drop_straying,
    is_exact,
    select_near,
)
from synthesis.kinds.path.task.target_curve import (
    MIN_DEFINING_POINTS,
    MIN_POLYLINE_POINTS,
    SHAPE_POINT_COUNT,
    TargetCurve,
    interpolate_crank_angles,
    sample_smooth_steps,
)
from synthesis.kinds.path.verification.linkage import verify_traced
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.answer import SixbarMechanism
from synthesis.model.linkage.conversion import to_complex
from synthesis.results.candidate_log import CandidateLog, report_candidates
from synthesis.results.ranking import select_distinct
from synthesis.results.simplest_type import SOUND_TRANSMISSION_ANGLE, select_passing

DRAW_COUNT, FOLLOWED_COUNT = 229376, 2100
"""Number of sixbars drawn, and of the most similar that are followed, over all forms."""

MAX_FORM_DRAWS, MAX_FORM_FOLLOWED, OPEN_DRAW_SHARE, EXACT_DRAW_SHARE = 65536, 600, 0.125, 0.25
"""Maximum of the same two numbers for one form; share of the drawn number for a stroke, which is compared with parts of
each curve; and share of the drawn and followed numbers for exact points, which leave much freedom."""

MAX_ROUGH_STEPS, MAX_FINE_STEPS, MAX_KICKED_STEPS = 40, 100, 60
"""Number of steps of descents: of all followed sixbars, of the best of them, and of perturbed copies."""

REFINED_SHARE = 0.125
"""Share of the followed sixbars that are refined, the best ones."""

KICK_ROUNDS, MAX_KICKED, COPY_COUNT, KICK_SIZE, KICK_SPREAD, NON_LOG_KICK_SHARE = 2, 12, 10, 0.15, 0.8, 0.4
"""Perturbed copies: number of rounds, of sixbars, and of copies of each; standard deviation of the change in logarithms
of lengths; standard deviation of the logarithm of this deviation; and share of it for other unknowns."""

MAX_FORM_CANDIDATES, MAX_FITTED, MAX_DRIVEN, MAX_DRIVEN_CONSTRAINED = 8, 32, 16, 32
"""Number of sixbars of a form that remain candidates (more if there are few forms); over all forms, maximum number
fitted to the points; number driven; and number driven if a workspace, planes or forces are constrained, which are
checked on the driven sixbar."""

BACK_STEP_COUNT, ANGLE_STEP_COUNT = 96, 96
"""Number of crank steps at which the curve is compared with the polyline through many points, and at which the
transmission angle is constrained."""

ANGLE_MARGIN = 0.1
"""Degrees added to the minimum transmission angle: the true minimum may lie between the steps of the crank."""

MAX_EXACT_STEPS, EXACT_TOLERANCE = 300, 1e-14
"""Maximum number of steps of descents to exact points, and their tolerance."""

DESIGN_DUPLICATE_TOLERANCE = 1e-3
"""Sixbars whose joints agree to this share of the task's size are duplicates."""


class _Candidate(NamedTuple):
    """A sixbar of a type, alone in its fits; ``cost`` is half its sum of squares at equal steps."""

    kind: str
    fits: SixbarFits
    cost: float


def solve_sixbars(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation by sixbars of the types that it names."""
    if problem.is_fitted:
        return _solve_by_sixbars(problem, progress)
    return solve_exactly_or_fit(problem, progress, _solve_by_sixbars, _solve_by_sixbars)


def warm_up() -> None:
    """Compile or load the kernels on a small circle."""
    circle = np.exp(2j * np.pi * np.arange(SHAPE_POINT_COUNT) / SHAPE_POINT_COUNT)
    stated = {"points": [{"x": z.real, "y": z.imag} for z in circle], "mechanisms": ["stephenson_3"]}
    problem = PathProblem.model_validate({"kind": "path", "method": "curve_match", "closed": True, **stated})
    setting = pack_sixbar_setting(problem, 0j, 1.0, SOUND_TRANSMISSION_ANGLE, MAX_LINK_RATIO)
    for kind in ("stephenson_3", "stephenson_2"):
        form = FORMS[kind][0]
        alike = find_similar_sixbars(form, circle, True, 256, 2, np.random.default_rng(0))
        fits = SixbarFits(form, alike.x, alike.signs, alike.theta, np.zeros(len(alike.x)))
        fits = descend_softly(fits, circle, np.ones(SHAPE_POINT_COUNT), setting, steps=2)
        fit_constrained(
            fits,
            circle,
            np.ones(SHAPE_POINT_COUNT),
            setting,
            CrankSteps(SHAPE_POINT_COUNT, SHAPE_POINT_COUNT),
            rounds=1,
            steps=2,
        )


def _solve_by_sixbars(problem: PathProblem, progress: Progress) -> PathResult:
    target = TargetCurve(problem)
    limits = problem.constraints
    required_angle = limits.min_transmission_angle
    # Without a required angle sixbars would often end next to a toggle, where they are useless.
    least = ANGLE_MARGIN + (SOUND_TRANSMISSION_ANGLE if required_angle is None else required_angle)
    ratio = MAX_LINK_RATIO if limits.max_link_ratio is None else limits.max_link_ratio
    setting = pack_sixbar_setting(problem, target.centre, target.size, least, ratio)
    steps, places = target.steps, target.places
    # Few points define no curve: a spline through them serves as the target of the comparison.
    if len(target.points) < MIN_DEFINING_POINTS and not problem.is_matched:
        steps, places = sample_smooth_steps(target.points, target.closed)
    begun = _find_candidates(problem, steps, target.size, setting, scale_progress(progress, 0.0, 0.7))
    ends = _fit_candidates(problem, target, places, begun, setting)
    mechanisms = [
        made
        for kind, fits, _ in ends
        if (
            made := build_fitted_sixbar(
                kind, fits.form, fits.x[0], fits.signs[0], float(fits.theta[0, 0]), target.centre, target.size
            )
        )
    ]
    return _build_result(problem, mechanisms, scale_progress(progress, 0.8, 1.0))


def _find_candidates(
    problem: PathProblem, steps: Complex, size: float, setting: Real, progress: Progress
) -> list[_Candidate]:
    """Find sixbars near a target, fitted at equal steps along it, nearest first; ``size`` is the target's unit."""
    families = FAMILIES[problem.constraints.grashof]
    tasks = [(kind, form) for kind in problem.sixbars for form in FORMS[kind] if form.family in families]
    # Points to be met exactly leave a family of solutions, which fewer samples find.
    share = 1.0 if problem.is_fitted else EXACT_DRAW_SHARE
    drawn = round(share * min(MAX_FORM_DRAWS, DRAW_COUNT // len(tasks)))
    drawn = drawn if problem.closed else round(OPEN_DRAW_SHARE * drawn)
    followed = round(share * min(MAX_FORM_FOLLOWED, FOLLOWED_COUNT // len(tasks)))
    rng = np.random.default_rng(problem.seed)
    longest, weights = problem.longest_link / size, np.ones(SHAPE_POINT_COUNT)
    found: list[_Candidate] = []
    for n, (kind, form) in enumerate(tasks):
        progress(n / len(tasks), compose("path-sixbars-fitted", type=kind, compared=drawn, fitted=followed))
        alike = find_similar_sixbars(form, steps, problem.closed, drawn, followed, rng, longest)
        if not len(alike.x):
            continue
        fits = SixbarFits(form, alike.x, alike.signs, alike.theta, np.zeros(len(alike.x)))
        fits = descend_softly(fits, steps, weights, setting, steps=MAX_ROUGH_STEPS)
        fits = fits.select_rows(_select_best(fits, math.ceil(REFINED_SHARE * followed)))
        fits = descend_softly(fits, steps, weights, setting, steps=MAX_FINE_STEPS)
        # Basin hopping: each round perturbs the best of all previous ones.
        for _ in range(KICK_ROUNDS):
            fits = _perturb_best(fits, steps, weights, setting, rng)
        order = _select_best(fits, MAX_KICKED * COPY_COUNT)
        kept = order[
            select_distinct(
                fits.x[order], max(MAX_FORM_CANDIDATES, MAX_FITTED // len(tasks)), DESIGN_DUPLICATE_TOLERANCE
            )
        ]
        found += [
            _Candidate(kind, fits.select_rows(kept[k : k + 1]), float(fits.cost[kept[k]])) for k in range(len(kept))
        ]
    return sorted(found, key=lambda one: one.cost)


def _select_best(fits: SixbarFits, count: int) -> NDArray[np.int64]:
    """Return the rows of the nearest fits that can be assembled."""
    order = np.argsort(fits.cost, kind="stable")[:count]
    return np.asarray(order[np.isfinite(fits.cost[order])])


def _perturb_best(
    fits: SixbarFits, points: Complex, weights: Real, setting: Real, rng: np.random.Generator
) -> SixbarFits:
    """Descend from perturbed copies of the best fits; return the old fits and the new ones."""
    rows = np.repeat(_select_best(fits, MAX_KICKED), COPY_COUNT)
    if not len(rows):
        return fits
    change = (
        KICK_SIZE
        * np.exp(KICK_SPREAD * rng.normal(size=(len(rows), 1)))
        * rng.normal(size=(len(rows), fits.x.shape[1]))
    )
    # Places and directions are absolute numbers; a change of the logarithms' size would destroy the shape.
    change[:, NON_LOG_UNKNOWNS] *= NON_LOG_KICK_SHARE
    copies = SixbarFits(fits.form, fits.x[rows] + change, fits.signs[rows], fits.theta[rows], fits.cost[rows])
    ends = descend_softly(copies, points, weights, setting, steps=MAX_KICKED_STEPS)
    return SixbarFits(fits.form, *(np.concatenate(both) for both in zip(fits[1:], ends[1:], strict=True)))


NON_LOG_UNKNOWNS = [0, 1, 2, 7, 8, 9, 10, 13, 14]
"""Indices of unknowns that are places and directions, not logarithms of lengths."""


def _fit_candidates(
    problem: PathProblem, target: TargetCurve, places: Real, begun: Sequence[_Candidate], setting: Real
) -> list[_Candidate]:
    """Fit the best candidates to the points under all constraints; failed ones follow the feasible ones."""
    count = len(target.points)
    # Only a dense closed polyline defines the curve between its points.
    dense = problem.is_fitted and problem.closed and count >= MIN_POLYLINE_POINTS
    fitted = len(target.fitted) if problem.is_matched else count
    part: slice | NDArray[np.int64] = get_thinning(target)
    stance: Real | None = None
    if problem.stance is not None:
        part, stance = pack_target_stance(problem, target, fitted)
    points, weights = target.fitted[:fitted][part], target.weights[:fitted][part]
    within: list[_Candidate] = []
    beyond: list[_Candidate] = []
    for kind, fits, _ in begun[:MAX_FITTED]:
        theta = interpolate_crank_angles(places, fits.theta[0], problem.closed, math.tau)
        at = fits._replace(theta=np.concatenate([theta, fits.theta[0]])[None, :fitted][:, part])
        if not problem.is_fitted:
            at = descend_softly(
                at,
                points,
                weights,
                setting,
                steps=MAX_EXACT_STEPS,
                crank_steps=CrankSteps(0, ANGLE_STEP_COUNT),
                tolerance=EXACT_TOLERANCE,
            )
        end = fit_constrained(
            at, points, weights, setting, CrankSteps(BACK_STEP_COUNT if dense else 0, ANGLE_STEP_COUNT), stance=stance
        )
        if math.isfinite(end.cost[0]):
            within.append(_Candidate(kind, end, float(end.cost[0])))
        else:
            beyond.append(_Candidate(kind, at, float(fits.cost[0])))
    return [*sorted(within, key=lambda one: one.cost), *beyond]


def _build_result(problem: PathProblem, mechanisms: list[SixbarMechanism], progress: Progress) -> PathResult:
    """Drive the sixbars, rank those that pass, and build the result."""
    # Constraints that the fits do not know reject many sixbars: drive more of them.
    judged = problem.space is not None or problem.layout is not None or bool(problem.constraints.force_limits)
    joints = [[to_complex(joint) for joint in one.skeleton.joints.values()] for one in mechanisms]
    chosen = select_distinct(
        joints, MAX_DRIVEN_CONSTRAINED if judged else MAX_DRIVEN, DESIGN_DUPLICATE_TOLERANCE * problem.task_size
    )
    sifting = CandidateLog[PathDesign](problem)
    sifting.verify_candidates(
        report_candidates([mechanisms[n] for n in chosen], progress, (0.0, 1.0), "path-sixbars-driven"),
        partial(verify_traced, problem),
    )
    if problem.is_fitted:
        sifting.withdraw(select_near(drop_straying(sifting.passed, problem), problem), FAR_REASON)
    progress(1.0, compose("path-verified"))
    summary = join_sentences(
        [
            compose("path-sixbars-passed", passed=sifting.accepted, count=sifting.candidates),
            sifting.describe_reasons(),
            "" if sifting.passed else compose("path-none-found"),
        ]
    )
    return PathResult(
        designs=sifting.select_designs(build_ordering(problem)),
        search=sifting.build_search("sixbar_shapes"),
        summary=summary,
    )


def describe_best_sixbar(problem: PathProblem, designs: Sequence[PathDesign]) -> str:
    """Describe the best feasible sixbar of a result in a sentence; empty if there is none."""
    sixbars = [one for one in select_passing(designs) if isinstance(one.mechanism, SixbarMechanism)]
    if not sixbars:
        return ""
    best = sixbars[0]
    name, link = compose("path-sixbar-name", type=best.mechanism.type), best.point_link or ""
    if is_exact(best):
        return compose("path-best-sixbar-exact", type=name, link=link)
    rms_distance, unit = f"{best.metrics.rms_distance:.3g}", problem.length_unit
    if best.metrics.both_way_rms is None:
        return compose("path-best-sixbar", type=name, link=link, rms_distance=rms_distance, unit=unit)
    return compose(
        "path-best-sixbar-both-ways",
        type=name,
        link=link,
        rms_distance=rms_distance,
        unit=unit,
        both_way_rms=f"{best.metrics.both_way_rms:.3g}",
    )
