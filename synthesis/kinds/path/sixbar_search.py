"""Sixbars that guide a point along a curve or past points: shapes compared, the most similar fitted, the best driven.

For every form of the requested types (:data:`~synthesis.kinds.path.sixbar_shapes.FORMS`):

1. sixbars are drawn and their curves compared with the target; the most similar are placed on it;
2. they descend on all of their dimensions at equal steps along the target, with the constraints as penalties;
3. copies of the best with changed dimensions descend again: such descents end in many minima.

The best of all forms are then fitted to the points themselves, and to the way between them if the points show it, and
led to satisfy the constraints. :mod:`synthesis.kinds.path.sixbar_rows` lists the constraints known to the kernels; all
constraints are verified on the driven sixbar. Without a required transmission angle, at least
:data:`~synthesis.outcome.simplest.SOUND` degrees are the aim.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.path.curve_fits import thinning
from synthesis.kinds.path.curve_target import DENSE, FEW_POINTS, SHAPE_POINTS, Target, angles_at, smooth_steps
from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.fallback import exact_or_fitted
from synthesis.kinds.path.nearness import FAR, MOST_UNEVEN, meets_the_points, near_the_nearest, order_of, steady
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.sixbar_fit import Fits, descended, held, sixbar_setting
from synthesis.kinds.path.sixbar_mechanism import fitted_sixbar
from synthesis.kinds.path.sixbar_shapes import FAMILIES, FORMS, alike_sixbars
from synthesis.kinds.path.stance_fit import stance_of_target
from synthesis.kinds.path.verify_traced import verify_traced
from synthesis.model.counting import agreeing, counted, grouped
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_answer import SixbarMechanism
from synthesis.model.linkages import to_complex
from synthesis.model.sixbars import IN_WORDS
from synthesis.outcome.ranking import distinct
from synthesis.outcome.sifting import Sifting, reported
from synthesis.outcome.simplest import SOUND, passing

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

DRAWN, FOLLOWED = 229376, 2100
"""Number of sixbars drawn, and of the most similar that are followed, over all forms."""

MOST_DRAWN, MOST_FOLLOWED, OPEN_SHARE, EXACT_SHARE = 65536, 600, 0.125, 0.25
"""The same for one form, at most; the share of the first for a stroke, which is compared with parts of each curve; and
the share of both for points to be met exactly, which leave much freedom."""

ROUGH_STEPS, FINE_STEPS, KICKED_STEPS = 40, 100, 60
"""Number of steps of descents: of all followed sixbars, of the best of them, and of changed copies."""

REFINED_SHARE = 0.125
"""Share of the followed sixbars, the best, that are refined."""

KICKS, KICKED, COPIES, KICK, SPREAD, ELSEWHERE = 2, 12, 10, 0.15, 0.8, 0.4
"""Changed copies: rounds, sixbars, copies of each; standard deviation of the change of their logarithms of lengths,
that of its own logarithm, and the share of it for other unknowns."""

RUNNING, BROUGHT, MAX_DRIVEN, MAX_JUDGED = 8, 32, 16, 32
"""Number of sixbars of a form that remain candidates (more if there are few forms); over all forms, maximum number
fitted to the points; number driven; and number driven if a workspace, planes or forces are constrained, which are
checked on the driven sixbar."""

BACK, TURNS = 96, 96
"""Number of crank steps at which the curve is compared with the polyline through many points, and at which the
transmission angle is constrained."""

MARGIN = 0.1
"""Degrees added to the minimum transmission angle: the true minimum may lie between the steps of the crank."""

EXACT_STEPS, EXACT_TOLERANCE = 300, 1e-14
"""Maximum number of steps of descents to exact points, and their tolerance."""

SAME_DESIGN = 1e-3
"""Sixbars whose joints agree to this share of the task's size are duplicates."""


class _Candidate(NamedTuple):
    """A sixbar of a type, alone in its fits; ``cost`` is half its sum of squares at equal steps."""

    kind: str
    fits: Fits
    cost: float


def solve_sixbars(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation by sixbars of the types that it names."""
    if problem.fitted:
        return _solved(problem, progress)
    return exact_or_fitted(problem, progress, _solved, _solved)


def warm_up() -> None:
    """Compile or load the kernels on a small circle."""
    circle = np.exp(2j * np.pi * np.arange(SHAPE_POINTS) / SHAPE_POINTS)
    stated = {"points": [{"x": z.real, "y": z.imag} for z in circle], "mechanisms": ["stephenson_3"]}
    problem = PathProblem.model_validate({"kind": "path", "method": "curve_match", "closed": True, **stated})
    setting = sixbar_setting(problem, 0j, 1.0, SOUND, MOST_UNEVEN)
    for kind in ("stephenson_3", "stephenson_2"):
        form = FORMS[kind][0]
        alike = alike_sixbars(form, circle, True, 256, 2, np.random.default_rng(0))
        fits = Fits(form, alike.x, alike.signs, alike.theta, np.zeros(len(alike.x)))
        fits = descended(fits, circle, np.ones(SHAPE_POINTS), setting, steps=2)
        held(fits, circle, np.ones(SHAPE_POINTS), setting, back=SHAPE_POINTS, turns=SHAPE_POINTS, rounds=1, steps=2)


def _solved(problem: PathProblem, progress: Progress) -> PathResult:
    target = Target(problem)
    limits = problem.constraints
    asked = limits.min_transmission_angle
    # Without a required angle sixbars would often end next to a toggle, where they are useless.
    least = MARGIN + (SOUND if asked is None else asked)
    ratio = MOST_UNEVEN if limits.max_link_ratio is None else limits.max_link_ratio
    setting = sixbar_setting(problem, target.centre, target.size, least, ratio)
    steps, places = target.steps, target.places
    # Few points define no curve: a spline through them serves as the target of the comparison.
    if len(target.points) < FEW_POINTS and not problem.matched:
        steps, places = smooth_steps(target.points, target.closed)
    begun = _begun(problem, steps, target.size, setting, part_of(progress, 0.0, 0.7))
    ends = _brought(problem, target, places, begun, setting)
    mechanisms = [
        made
        for kind, fits, _ in ends
        if (
            made := fitted_sixbar(
                kind, fits.form, fits.x[0], fits.signs[0], float(fits.theta[0, 0]), target.centre, target.size
            )
        )
    ]
    return _answer(problem, mechanisms, part_of(progress, 0.8, 1.0))


def _begun(problem: PathProblem, steps: Complex, size: float, setting: Real, progress: Progress) -> list[_Candidate]:
    """Find sixbars near a target, fitted at equal steps along it, nearest first; ``size`` is the target's unit."""
    families = FAMILIES[problem.constraints.grashof]
    tasks = [(kind, form) for kind in problem.sixbars for form in FORMS[kind] if form.family in families]
    # Points to be met exactly leave a family of solutions, which fewer samples find.
    share = 1.0 if problem.fitted else EXACT_SHARE
    drawn = round(share * min(MOST_DRAWN, DRAWN // len(tasks)))
    drawn = drawn if problem.closed else round(OPEN_SHARE * drawn)
    followed = round(share * min(MOST_FOLLOWED, FOLLOWED // len(tasks)))
    rng = np.random.default_rng(problem.seed)
    longest, weights = problem.longest_link / size, np.ones(SHAPE_POINTS)
    found: list[_Candidate] = []
    for n, (kind, form) in enumerate(tasks):
        progress(n / len(tasks), f"{kind}: {drawn} sixbars compared, {followed} fitted")
        alike = alike_sixbars(form, steps, problem.closed, drawn, followed, rng, longest)
        if not len(alike.x):
            continue
        fits = Fits(form, alike.x, alike.signs, alike.theta, np.zeros(len(alike.x)))
        fits = descended(fits, steps, weights, setting, steps=ROUGH_STEPS)
        fits = fits.chosen(_best(fits, math.ceil(REFINED_SHARE * followed)))
        fits = descended(fits, steps, weights, setting, steps=FINE_STEPS)
        # Basin hopping: each round perturbs the best of all previous ones.
        for _ in range(KICKS):
            fits = _kicked(fits, steps, weights, setting, rng)
        order = _best(fits, KICKED * COPIES)
        kept = order[distinct(fits.x[order], max(RUNNING, BROUGHT // len(tasks)), SAME_DESIGN)]
        found += [_Candidate(kind, fits.chosen(kept[k : k + 1]), float(fits.cost[kept[k]])) for k in range(len(kept))]
    return sorted(found, key=lambda one: one.cost)


def _best(fits: Fits, count: int) -> NDArray[np.int64]:
    """Return the rows of the nearest fits that close."""
    order = np.argsort(fits.cost, kind="stable")[:count]
    return np.asarray(order[np.isfinite(fits.cost[order])])


def _kicked(fits: Fits, points: Complex, weights: Real, setting: Real, rng: np.random.Generator) -> Fits:
    """Descend from changed copies of the best; return the old fits and the new ends."""
    rows = np.repeat(_best(fits, KICKED), COPIES)
    if not len(rows):
        return fits
    change = KICK * np.exp(SPREAD * rng.normal(size=(len(rows), 1))) * rng.normal(size=(len(rows), fits.x.shape[1]))
    # Places and directions are absolute numbers; a change of the logarithms' size would destroy the shape.
    change[:, NO_LOGARITHMS] *= ELSEWHERE
    copies = Fits(fits.form, fits.x[rows] + change, fits.signs[rows], fits.theta[rows], fits.cost[rows])
    ends = descended(copies, points, weights, setting, steps=KICKED_STEPS)
    return Fits(fits.form, *(np.concatenate(both) for both in zip(fits[1:], ends[1:], strict=True)))


NO_LOGARITHMS = [0, 1, 2, 7, 8, 9, 10, 13, 14]
"""Indices of unknowns that are places and directions, not logarithms of lengths."""


def _brought(
    problem: PathProblem, target: Target, places: Real, begun: Sequence[_Candidate], setting: Real
) -> list[_Candidate]:
    """Fit the best to the points under all constraints; the ones that fail follow the feasible ones."""
    count = len(target.points)
    # Only a dense closed polyline defines the curve between its points.
    dense = problem.fitted and problem.closed and count >= DENSE
    fitted = len(target.fitted) if problem.matched else count
    part: slice | NDArray[np.int64] = thinning(target)
    stance: Real | None = None
    if problem.stance is not None:
        part, stance = stance_of_target(problem, target, fitted)
    points, weights = target.fitted[:fitted][part], target.weights[:fitted][part]
    within: list[_Candidate] = []
    beyond: list[_Candidate] = []
    for kind, fits, _ in begun[:BROUGHT]:
        theta = angles_at(places, fits.theta[0], problem.closed, math.tau)
        at = fits._replace(theta=np.concatenate([theta, fits.theta[0]])[None, :fitted][:, part])
        if not problem.fitted:
            at = descended(at, points, weights, setting, steps=EXACT_STEPS, turns=TURNS, tolerance=EXACT_TOLERANCE)
        end = held(at, points, weights, setting, back=BACK if dense else 0, turns=TURNS, stance=stance)
        if math.isfinite(end.cost[0]):
            within.append(_Candidate(kind, end, float(end.cost[0])))
        else:
            beyond.append(_Candidate(kind, at, float(fits.cost[0])))
    return [*sorted(within, key=lambda one: one.cost), *beyond]


def _answer(problem: PathProblem, mechanisms: list[SixbarMechanism], progress: Progress) -> PathResult:
    """Drive the sixbars, rank those that pass, and build the result."""
    # Constraints that the fits do not know reject many sixbars: drive more of them.
    judged = problem.space is not None or problem.layout is not None or bool(problem.constraints.of_forces)
    joints = [[to_complex(joint) for joint in one.skeleton.joints.values()] for one in mechanisms]
    chosen = distinct(joints, MAX_JUDGED if judged else MAX_DRIVEN, SAME_DESIGN * problem.task_size)
    sifting = Sifting[PathDesign](problem)
    sifting.sift(
        reported([mechanisms[n] for n in chosen], progress, (0.0, 1.0), "{done} of {all} sixbars driven"),
        partial(verify_traced, problem),
    )
    if problem.fitted:
        sifting.withdraw(near_the_nearest(steady(sifting.passed, problem), problem), FAR)
    progress(1.0, "verified")
    fitted = counted(sifting.candidates, "sixbar that was", "sixbars that were")
    satisfy = agreeing(sifting.accepted, "satisfies", "satisfy")
    text = f"{grouped(sifting.accepted)} of {fitted} fitted {satisfy} all constraints."
    text += sifting.reasons()
    if not sifting.passed:
        text += " None was found; some may still exist."
    return PathResult(
        designs=sifting.designs(order_of(problem)),
        search=sifting.search("sixbar_shapes"),
        summary=text,
    )


def best_sixbar(problem: PathProblem, designs: Sequence[PathDesign]) -> str:
    """Describe the best feasible sixbar of a result in a sentence; empty if there is none."""
    sixbars = [one for one in passing(designs) if isinstance(one.mechanism, SixbarMechanism)]
    if not sixbars:
        return ""
    best = sixbars[0]
    text = f" The best sixbar is a {IN_WORDS[best.mechanism.type]} with P on {best.point_link}"
    if meets_the_points(best):
        text += ", which meets the points"
    else:
        text += f"; its rms distance is {best.metrics.rms_distance:.3g} {problem.length_unit}"
    if best.metrics.both_way_rms is not None:
        text += f", {best.metrics.both_way_rms:.3g} both ways"
    return f"{text}."
