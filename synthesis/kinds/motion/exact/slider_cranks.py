"""Slider-cranks and inverted slider-cranks that carry the body: pairs of a link and a slider, screened and verified.

Both dyads carry the same body, so all joints at the targets are known, as for fourbars. The screening decides:

* Assembly. A PR dyad's pin stays ahead of the crank pin along its line, or stays behind it; likewise the block at O4
  along the body's line of an RP dyad. If the slider is the input, the crank pin stays on one side of the line from the
  slider to O2.
* Order. The driving crank turns (or the driving slider moves) in one direction through the targets.
* Transmission. With a PR dyad the sine is √(1 − (h/b)²), h the crank pin's distance from the slide's line; with an RP
  dyad √(1 − (ρ/f)²), ρ the pin's distance from the body's line and f its distance from O4; with a driving slider it is
  the sine of the angle between crank and coupler. h, f and the diagonal have their extremes at the ends of the used
  range, or where the crank is perpendicular to the line, collinear with O4, or where the slider passes the foot of O2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Integers, Real
from kinematics.errors import DimensionError
from kinematics.linkage.planar.mechanism import Mechanism, Slide
from kinematics.message import compose, join_messages
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.dyads.candidates import find_side_dyads
from synthesis.kinds.motion.dyads.equations import Dyads
from synthesis.kinds.motion.dyads.finite_sets import SliderDyad
from synthesis.kinds.motion.dyads.slider_dyads import Sliders, find_sliders
from synthesis.kinds.motion.exact.clearance_filter import check_slider_clearance, limit_batches
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices
from synthesis.kinds.motion.task.pivot_regions import inside_mask, list_side_areas
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.kind import Progress
from synthesis.model.linkage.answer import LinkageDesign, LinkageMechanism
from synthesis.model.linkage.conversion import build_inverted_slider_crank, build_slider_crank
from synthesis.results.candidate_log import (
    DEFECT_REASONS,
    LENGTH_REASONS,
    NUMERICAL_REASONS,
    OUTRANKED_REASON,
    CandidateLog,
    report_candidates,
)
from synthesis.results.force_filter import select_bearable
from synthesis.results.ranking import rank_designs, select_most_distinct
from synthesis.verification.measures import LINK_RATIO_SCALE, REACH_SCALE

USABLE_TRANSMISSION_ANGLE = 30.0
"""Transmission angle, degrees; if the client sets no limit, pairs below this are tried only if no pair reaches it."""

MIN_LINK_SHARE = 1e-3
"""Minimum length of a link, relative to the longest; below it the linkage is degenerate."""

MIN_LENGTH = 1e-12
"""Minimum length, in task sizes, in the denominator of the link ratio; shorter links are degenerate anyway."""

SINE_TOLERANCE = 1e-9
"""Relative tolerance of a sine at its limit in the screening; the verification decides exactly."""

MIN_ATTEMPTS = 40
"""Minimum number of pairs driven before the search gives up, or three per requested design if that is more."""

MIN_SEPARATIONS = 0.25 * 0.5 ** np.arange(5)
"""Minimum separations of distinct designs, tried in turn: the largest distance between corresponding joints, in task
sizes. The first value that yields enough designs is used."""

VERDICTS = (
    "sound",
    "degenerate",
    "circuit_defect",
    "order_defect",
    "branch_defect",
    "transmission_angle",
    "link_length",
)
"""Verdicts of the screening."""


class _ScreeningResult(NamedTuple):
    """Verdicts (index into :data:`VERDICTS`) and scores of all pairs, shape (links, sliders).

    Feasible pairs have positive scores.
    """

    verdict: NDArray[np.int64]
    score: Real


LINK_COUNT, SLIDER_COUNT = 500, 160
"""Numbers of links and of sliders if both sides are sampled from families."""

ZONE_OVERSAMPLING = 100
"""Oversampling factor for sliders that must lie in a zone: those inside it are kept, up to the usual number."""

MAX_CLEARANCE_PAIRS, CLEARANCE_BATCH_SIZE, ENOUGH_PAIRS = 60_000, 4000, 400
"""Collision test: maximum number of pairs, batch size, and the number of clear pairs that ends it."""

MAX_FORCE_PAIRS, FORCE_BATCH_SIZE = 4000, 500
"""Force check: maximum number of pairs, and batch size; :data:`ENOUGH_PAIRS` pairs within the limits end it."""

SINGLE_SIDE_COUNT = 6000
"""Number of dyads of a sampled side if the other side is determined."""


def solve_sliders(problem: MotionProblem, kind: Literal["PR", "RP"], progress: Progress) -> MotionResult:
    """Solve for linkages with the requested slider on one side, for two to five positions."""
    task = make_motion_task(problem)
    rng = np.random.default_rng(problem.seed)
    progress(0.0, compose("motion-finding-sliders"))
    side = int(problem.output_side.dyad == kind)
    stated = (problem.input_side, problem.output_side)[side]
    areas = list_side_areas(problem)
    inside_of = areas[side].moving if kind == "PR" else areas[side].fixed
    # Zones are small targets for random samples, so sample more and keep those inside.
    more = ZONE_OVERSAMPLING if problem.space is not None and inside_of else 1
    dyads = find_sliders(task, stated, inverted=kind == "RP", rng=rng, count=SLIDER_COUNT * more)
    if not len(dyads.points):
        return _report_missing_dyads(problem, dyads.reason, complete=dyads.proved)
    progress(0.1, compose("motion-finding-links"))
    count = LINK_COUNT if dyads.sampled else SINGLE_SIDE_COUNT
    links = find_side_dyads(task, problem, 1 - side, areas[1 - side], rng, count)
    if not len(links.dyads.fixed):
        assert links.reason is not None
        reason = links.reason.write("motion-side-with-pins")
        return _report_missing_dyads(problem, reason, complete=links.complete)
    most = SLIDER_COUNT if links.sampled else SINGLE_SIDE_COUNT
    # Only the sliders are sampled: use a larger cloud of them.
    if dyads.sampled and not links.sampled:
        dyads = find_sliders(task, stated, inverted=kind == "RP", rng=rng, count=SINGLE_SIDE_COUNT * min(more, 10))
    inside = np.flatnonzero(inside_mask(task, inside_of, dyads.points))
    inside = inside[:most] if more > 1 else inside
    dyads = dyads._replace(points=dyads.points[inside], angles=dyads.angles[inside])
    return solve_slider_pairs(problem, task, links.dyads, dyads, kind, progress)


def try_sliders(problem: MotionProblem, result: MotionResult, progress: Progress) -> MotionResult:
    """Try sliders for a problem that no fourbar solves, on sides that allow them; return the result with or without.

    If an incomplete search found no fourbar, the result is left unchanged: sliders must then be requested.
    """
    # An incomplete search with candidates might still have a fourbar.
    if result.search.candidates and not result.search.complete:
        return result
    for kind, slider_problem in _propose_slider_problems(problem):
        answer = solve_sliders(slider_problem, kind, lambda fraction, message: progress(1.0, message))
        if answer.designs:
            instead = compose("motion-slider-instead-of-pin", summary=answer.summary)
            return answer.model_copy(update={"summary": join_messages([result.summary, instead])})
    return result


def merge_sliders(
    problem: MotionProblem, result: MotionResult, known: tuple[SliderDyad, ...], progress: Progress
) -> MotionResult:
    """Merge linkages with a slider into the result of a problem whose dyads are all known; ``known`` are sliders.

    They rank equally with the others, and each input side counts as a candidate. Choices that apply only to pins
    exclude sliders.
    """
    parts: list[MotionResult] = []
    kinds = {slider.kind for slider in known}
    met: dict[str, bool] = {}
    for kind, slider_problem in _propose_slider_problems(problem):
        answer = solve_sliders(slider_problem, kind, lambda fraction, message: progress(1.0, message))
        met[kind] = met.get(kind, False) or answer.search.candidates > 0
        # A search without candidates found no dyads; it adds nothing to the counts.
        if answer.search.candidates:
            parts.append(answer)
    if not met:
        return result
    # A known slider that the slider search did not reproduce means that the enumeration is not proved complete.
    missing = {kind for kind in kinds if not met.get(kind, True)}
    sifting = CandidateLog[LinkageDesign](problem)
    for part in (result, *parts):
        sifting.merge_search(part.search)
    designs = [design for part in (result, *parts) for design in part.designs]
    accepted = sifting.accepted - result.search.accepted
    open_questions = missing or {*NUMERICAL_REASONS, OUTRANKED_REASON} & sifting.rejected.keys()
    search = sifting.build_search(
        f"{result.search.method}, slider_search", complete=result.search.complete and not open_questions
    )
    text = join_messages([result.summary, compose("motion-sliders-found", count=accepted)])
    designs = rank_designs(designs, problem.rank_by)[: problem.max_designs]
    return result.model_copy(update={"designs": designs, "search": search, "summary": text})


def _propose_slider_problems(problem: MotionProblem) -> Iterator[tuple[Literal["PR", "RP"], MotionProblem]]:
    """Yield the problem with a slider requested on each side whose dyad is open."""
    for kind in problem.slider_kinds:
        # An inverted slider-crank is driven by its crank, so the slider is on the output side.
        for name in ("output_side", "input_side") if kind == "PR" else ("output_side",):
            choices: DyadChoices = getattr(problem, name)
            # A ground line needs two fixed pivots; a slider has none.
            if choices.dyad != "any" or problem.ground_line is not None:
                continue
            slider_problem = problem.model_copy(update={name: choices.model_copy(update={"dyad": kind})})
            # Choices for pins may exclude a slider.
            if not slider_problem.find_contradictions():
                yield kind, slider_problem


def _report_missing_dyads(problem: MotionProblem, reason: str, *, complete: bool) -> MotionResult:
    """Build the result for a problem in which one side has no dyad at all."""
    search = CandidateLog[LinkageDesign](problem).build_search("slider_search", complete=complete)
    return MotionResult(designs=[], search=search, summary=reason)


def solve_slider_pairs(
    problem: MotionProblem, task: MotionTask, links: Dyads, sliders: Sliders, kind: str, progress: Progress
) -> MotionResult:
    """Screen pairs of an RR link and a slider (``kind`` PR or RP) and verify the best distinct ones.

    The slider is the input if it is requested on the input side.
    """
    driving = problem.input_side.dyad == "PR"
    limit = problem.constraints.min_transmission_angle
    progress(0.3, compose("motion-screening-slider-pairs", count=len(links.fixed) * len(sliders.points)))
    few = len(links.fixed) * len(sliders.points) <= MIN_ATTEMPTS  # all of them can be driven: no filter is needed
    # Few pairs can all be driven, which is more accurate than any filter.
    wanted = (0.0 if few else USABLE_TRANSMISSION_ANGLE) if limit is None else limit
    screened = _screen(problem, task, links, sliders, kind, driving, wanted)
    # Lower the default angle only if no pair reaches it; a limit of the client is never lowered.
    if limit is None and not screened.score.any():
        screened = _screen(problem, task, links, sliders, kind, driving, 0.0)
    sound = int(np.count_nonzero(screened.score))
    # The collision test covers slider-cranks driven by their crank only.
    if kind == "PR" and not driving and not few:
        screened = _filter_by_clearance(problem, task, links, sliders, screened)
    if problem.constraints.force_limits and not few:
        screened = _filter_by_forces(problem, task, links, sliders, screened, kind, driving)
    sifting = CandidateLog[LinkageDesign](problem, DEFECT_REASONS | LENGTH_REASONS)
    counts = np.bincount(screened.verdict.ravel(), minlength=len(VERDICTS))
    for name, count in zip(VERDICTS[1:], counts[1:].tolist(), strict=True):
        sifting.reject(name, count)
    driven = sifting.verify_candidates(
        report_candidates(
            _select_best(task, links, sliders, screened, max(3 * problem.max_designs, MIN_ATTEMPTS)),
            progress,
            (0.5, 1.0),
            "motion-progress-driving-best-pairs",
        ),
        lambda pair: verify(problem, _build_mechanism(problem, task, links, sliders, kind, driving, *pair)),
        enough=problem.max_designs,
    )
    sifting.reject(OUTRANKED_REASON, sound - driven)
    progress(1.0, compose("motion-verified"))
    return MotionResult(
        designs=sifting.select_designs(partial(rank_designs, rank_by=problem.rank_by)),
        search=sifting.build_search("slider_search"),
        summary=_describe_result(sifting, kind),
    )


def _describe_result(sifting: CandidateLog[LinkageDesign], kind: str) -> str:
    if not sifting.accepted:
        reasons = sifting.format_reasons() or compose("motion-none-rejected")
        return compose("motion-no-slider-crank" if kind == "PR" else "motion-no-inverted-slider-crank", reasons=reasons)
    return compose(
        "motion-slider-cranks-verified" if kind == "PR" else "motion-inverted-slider-cranks-verified",
        designs=sifting.accepted,
        pairs=sifting.candidates,
    )


def _screen(
    problem: MotionProblem, task: MotionTask, links: Dyads, sliders: Sliders, kind: str, driving: bool, least: float
) -> _ScreeningResult:
    """Return verdicts and scores of all pairs; the axes of the arrays are link, slider, target."""
    pins = task.images(links.moving)[:, None, :]
    pivots = links.fixed[:, None, None]
    crank = np.abs(links.moving - links.fixed)[:, None]
    if kind == "PR":
        others = task.images(sliders.points)[None]
        reach = others[..., 0] - pins[..., 0]
        line = np.exp(1j * sliders.angles)[None, :, None]
        rod = np.abs(reach)
        lengths = np.stack(np.broadcast_arrays(crank, rod))
        if driving:
            ahead = (np.conj(others - pivots) * (pins - pivots)).imag
            sines, moved, clear = _screen_driving_slider(pins, pivots, others, line, rod)
        else:
            ahead = (np.conj(line) * (others - pins)).real
            moved, turned = _measure_rotation(pins, pivots)
            foot = ((pivots - others[..., :1]) * np.conj(line)).imag[..., 0]
            # h(θ) = foot + a sin(θ − σ): the largest |h| is that of the sine's maximum or minimum over the range.
            start = np.angle((pins[..., :1] - pivots) * np.conj(line))[..., 0]
            farthest = np.maximum(
                foot + crank * _find_max_sine(start, turned), -(foot - crank * _find_max_sine(-start, -turned))
            )
            sines, clear = _compute_sine(farthest, rod), np.abs(farthest) < rod
    else:
        others = np.broadcast_to(sliders.points[None, :, None], (1, len(sliders.points), 1))
        line = np.exp(1j * sliders.angles)[None, :, None] * task.turns
        ahead = (np.conj(line) * (others - pins)).real
        offset = np.abs((np.conj(line) * (others - pins)).imag[..., 0])
        moved, turned = _measure_rotation(pins, pivots)
        ground = np.abs(sliders.points[None, :] - links.fixed[:, None])
        start = np.angle((pins[..., :1] - pivots) * np.conj(others - pivots))[..., 0]
        cosine = _find_max_sine(start + 0.5 * np.pi, turned)
        nearest = np.sqrt(np.maximum(crank**2 + ground**2 - 2.0 * crank * ground * cosine, 0.0))
        with np.errstate(divide="ignore", invalid="ignore"):
            sines = np.sqrt(np.maximum(1.0 - (offset / nearest) ** 2, 0.0))
        clear = nearest > offset
        lengths = np.stack(np.broadcast_arrays(crank, ground, np.maximum(offset, ground * 0.2)))
    return _score_pairs(problem, task, lengths, _PairMotion(ahead, moved, clear, sines), least, links, kind, sliders)


class _PairMotion(NamedTuple):
    """Motions of all pairs.

    The fields are the positions ahead along the slide at the targets, whether the input turns in one direction, whether
    the pair stays clear of toggles, and the sine of the minimum transmission angle.
    """

    ahead: Real
    moved: NDArray[np.bool_]
    clear: NDArray[np.bool_]
    sines: Real


def _score_pairs(
    problem: MotionProblem,
    task: MotionTask,
    lengths: Real,
    motion: _PairMotion,
    least: float,
    links: Dyads,
    kind: str,
    sliders: Sliders,
) -> _ScreeningResult:
    shape = lengths.shape[1:]
    ahead, moved, clear, sines = motion
    limits, ratio = (
        problem.constraints.link_length,
        lengths.max(axis=0) / np.maximum(lengths.min(axis=0), MIN_LENGTH),
    )
    one_side = np.all(ahead > 0.0, axis=-1) | np.all(ahead < 0.0, axis=-1)
    verdict = np.zeros(shape, np.int64)
    # Later assignments overwrite earlier ones: the most fundamental reason comes last.
    verdict[sines < math.sin(math.radians(least)) * (1.0 - SINE_TOLERANCE)] = VERDICTS.index("transmission_angle")
    verdict[~np.broadcast_to(clear, shape)] = VERDICTS.index("branch_defect")
    verdict[~np.broadcast_to(moved, shape)] = VERDICTS.index("order_defect")
    verdict[~one_side] = VERDICTS.index("circuit_defect")
    real = lengths[:2] * task.size
    if limits is not None:
        outside = (real < limits.min) | (real > (limits.max or math.inf))
        verdict[outside.any(axis=0)] = VERDICTS.index("link_length")
    if problem.constraints.max_link_ratio is not None:
        verdict[ratio > problem.constraints.max_link_ratio] = VERDICTS.index("link_length")
    verdict[lengths[:2].min(axis=0) < MIN_LINK_SHARE * lengths.max(axis=0)] = VERDICTS.index("degenerate")
    arms = np.abs(links.moving - task.points[0])[:, None]
    if kind == "PR":
        arms = np.maximum(arms, np.abs(sliders.points - task.points[0])[None])
    reach = np.maximum(lengths.max(axis=0), arms)
    score = sines / ((1.0 + (reach / REACH_SCALE) ** 2) * (1.0 + (ratio / LINK_RATIO_SCALE) ** 2))
    return _ScreeningResult(verdict, np.where(verdict == 0, score, 0.0))


def _measure_rotation(pins: Complex, pivots: Complex) -> tuple[NDArray[np.bool_], Real]:
    """Return whether a crank turns in one direction through the targets, and its rotation to the last one, radians.

    The shapes are (links, 1). If both directions keep the order (two targets), the shorter rotation counts.
    """
    rotation = np.angle((pins - pivots) * np.conj(pins[..., :1] - pivots))
    # Rounding must not turn the first rotation into a full turn.
    rotation[..., 0] = 0.0
    onward = np.mod(rotation, 2.0 * np.pi)
    backward = np.where(onward > 0.0, onward - 2.0 * np.pi, 0.0)
    rises, falls = np.all(np.diff(onward) > 0.0, axis=-1), np.all(np.diff(backward) < 0.0, axis=-1)
    forth, back = onward[..., -1], backward[..., -1]
    both = np.where(np.abs(back) < forth, back, forth)
    return rises | falls, np.where(rises & falls, both, np.where(rises, forth, back))


def _find_max_sine(start: Real, turned: Real) -> Real:
    """Return the maximum sine of an angle that runs from ``start`` by ``turned``, radians."""
    low, high = np.minimum(start, start + turned), np.maximum(start, start + turned)
    crest = np.floor((high - 0.5 * np.pi) / (2.0 * np.pi)) >= np.ceil((low - 0.5 * np.pi) / (2.0 * np.pi))
    return np.where(crest, 1.0, np.maximum(np.sin(low), np.sin(high)))


def _compute_sine(height: Real, rod: Real) -> Real:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sqrt(np.maximum(1.0 - (height / rod) ** 2, 0.0))


def _screen_driving_slider(
    pins: Complex, pivots: Complex, others: Complex, line: Complex, rod: Real
) -> tuple[Real, NDArray[np.bool_], NDArray[np.bool_]]:
    """Screen pairs that are driven by the slider.

    Returns the minimum sine of the angle between crank and coupler, whether the slider moves in one direction, and
    whether its motion is free of dead centres.
    """
    places = ((others - others[..., :1]) * np.conj(line)).real
    steps = np.diff(places)
    moved = np.all(steps > 0.0, axis=-1) | np.all(steps < 0.0, axis=-1)
    crank = np.abs(pins[..., 0] - pivots[..., 0])
    foot = (pivots - others[..., :1]) * np.conj(line)
    low, high = places.min(axis=-1, keepdims=True), places.max(axis=-1, keepdims=True)
    inner = np.clip(foot.real, low, high)
    squares = np.concatenate([(x - foot.real) ** 2 + foot.imag**2 for x in (low, inner, high)], axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = (crank[..., None] ** 2 + rod[..., None] ** 2 - squares) / (2.0 * crank * rod)[..., None]
    worst = np.abs(cosine).max(axis=-1)
    return np.sqrt(np.maximum(1.0 - worst**2, 0.0)), moved, worst < 1.0


def _filter_by_clearance(
    problem: MotionProblem, task: MotionTask, links: Dyads, sliders: Sliders, screened: _ScreeningResult
) -> _ScreeningResult:
    """Drop the pairs that clearly collide in the workspace, and those that are not tested.

    If no pair is clear, all are kept, so that verifying some of them yields the reason.
    """
    if problem.space is None or not problem.space.has_swept_constraints:
        return screened
    score = screened.score.ravel()
    sound = np.flatnonzero(score > 0.0)
    best = sound[np.argsort(-score[sound], kind="stable")]
    # The best pairs lie close together: interleaved batches contain some of the others too.
    best = best[:: -(-len(best) // MAX_CLEARANCE_PAIRS) or 1]
    portions = -(-len(best) // CLEARANCE_BATCH_SIZE)
    fitting = np.zeros_like(score)
    for k in range(limit_batches(problem.space, portions) if portions else 0):
        looked = best[k::portions]
        i, j = np.unravel_index(looked, screened.score.shape)
        joints = np.stack([links.fixed[i], links.moving[i], sliders.points[j]], axis=1)
        kept = looked[check_slider_clearance(problem, task, joints, sliders.angles[j])] if len(looked) else looked
        fitting[kept] = score[kept]
        if np.count_nonzero(fitting) >= ENOUGH_PAIRS:
            break
    return screened._replace(score=fitting.reshape(screened.score.shape)) if fitting.any() else screened


def _filter_by_forces(
    problem: MotionProblem,
    task: MotionTask,
    links: Dyads,
    sliders: Sliders,
    screened: _ScreeningResult,
    kind: str,
    driving: bool,
) -> _ScreeningResult:
    """Drop the pairs that violate a force limit, and those that are not tested.

    If no pair satisfies the limits, all are kept, as in the collision test.
    """
    score = screened.score.ravel()
    sound = np.flatnonzero(score > 0.0)
    best = sound[np.argsort(-score[sound], kind="stable")]
    best = best[:: -(-len(best) // MAX_FORCE_PAIRS) or 1]
    portions = -(-len(best) // FORCE_BATCH_SIZE)
    light = np.zeros_like(score)
    for k in range(portions):
        weighed = best[k::portions]
        i, j = np.unravel_index(weighed, screened.score.shape)
        try:
            mechanism, moved = _build_mechanisms(task, links, sliders, kind, driving, i, j)
        except DimensionError:  # P coincides with a pin of the RP body, whose line then has no direction
            return screened
        kept = weighed[select_bearable(problem, mechanism, moved)]
        light[kept] = score[kept]
        if np.count_nonzero(light) >= ENOUGH_PAIRS:
            break
    return screened._replace(score=light.reshape(screened.score.shape)) if light.any() else screened


def _build_mechanisms(
    task: MotionTask, links: Dyads, sliders: Sliders, kind: str, driving: bool, i: Integers, j: Integers
) -> tuple[Mechanism, Real]:
    """Build a batch of linkages in the problem's coordinates; also return their input motions (radians or length)."""
    o2, a, z = (task.origin + task.size * places for places in (links.fixed[i], links.moving[i], sliders.points[j]))
    angle = sliders.angles[j]
    p = np.full(len(i), task.origin)
    _, turned = _measure_rotation(task.images(links.moving[i])[:, None, :], links.fixed[i, None, None])
    joined: dict[str, tuple[str, ...]]
    if kind == "RP":
        joined = {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "P")}
        block = (Slide("O4", "coupler", z, angle),)
        return Mechanism({"O2": o2, "O4": z, "A": a, "P": p}, joined, "input", block), turned[:, 0]
    joined = {"ground": ("O2",), "crank": ("O2", "A"), "coupler": ("A", "B", "P")}
    mechanism = Mechanism(
        {"O2": o2, "A": a, "B": z, "P": p}, joined, "B" if driving else "crank", (Slide("B", "ground", z, angle),)
    )
    if not driving:
        return mechanism, turned[:, 0]
    places = task.images(sliders.points[j])
    return mechanism, task.size * ((places[:, -1] - places[:, 0]) * np.exp(-1j * angle)).real


def _select_best(
    task: MotionTask, links: Dyads, sliders: Sliders, screened: _ScreeningResult, count: int
) -> list[tuple[int, int]]:
    """Select the best-scored distinct pairs."""
    score = screened.score.ravel()
    order = np.argsort(-score, kind="stable")[: 20 * count]
    order = order[score[order] > 0.0]
    i, j = np.unravel_index(order, screened.score.shape)
    # A line's angle is defined modulo π, hence the factor 2 in its coordinate.
    joints = np.stack([links.fixed[i], links.moving[i], sliders.points[j], np.exp(2j * sliders.angles[j])], axis=1)
    return [(int(i[k]), int(j[k])) for k in select_most_distinct(joints, count, MIN_SEPARATIONS)]


def _build_mechanism(
    problem: MotionProblem,
    task: MotionTask,
    links: Dyads,
    sliders: Sliders,
    kind: str,
    driving: bool,
    i: int,
    j: int,
) -> LinkageMechanism:
    """Build the linkage of a link and a slider in the problem's coordinates; given pivots keep their exact values."""
    side, slider_side = problem.input_side, problem.output_side
    if driving:
        side, slider_side = slider_side, side
    o2 = task.pivot(side.fixed_pivot, complex(links.fixed[i]))
    a = task.pivot(side.moving_pivot, complex(links.moving[i]))
    z = task.pivot(slider_side.moving_pivot if kind == "PR" else slider_side.fixed_pivot, complex(sliders.points[j]))
    angle = float(sliders.angles[j])
    if kind == "PR":
        return build_slider_crank(o2, a, z, angle, task.origin, driven_by="slider" if driving else "crank")
    return build_inverted_slider_crank(o2, a, z, angle, task.origin)
