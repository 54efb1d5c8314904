"""Dwell sixbars: find promising starts, minimize the output's movement, make the range exact, and verify."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import partial
from itertools import chain
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.kinds.dwell.design import DwellDesign, DwellResult
from synthesis.kinds.dwell.motion.outputs import DWELL_SAMPLE_COUNT, Carrier, Kind, Task, evaluate_shapes
from synthesis.kinds.dwell.problem import HIGH_PLACE, LOW_PLACE, DwellProblem, Turning
from synthesis.kinds.dwell.quantities import list_angles, write_output
from synthesis.kinds.dwell.refine import stephenson_2
from synthesis.kinds.dwell.refine.refinement import SixbarShape, adjust_range, build_mechanism
from synthesis.kinds.dwell.refine.stephenson_2_cycle import C
from synthesis.kinds.dwell.starts import stephenson_2_starts
from synthesis.kinds.dwell.starts.coupler_curve_starts import Requirements, Start, find_starts
from synthesis.kinds.dwell.starts.placed_starts import find_placed_starts
from synthesis.kinds.dwell.verification import verify_dwell
from synthesis.model.kind import Progress
from synthesis.model.linkage.type_choice import UNCLASSED_SIXBAR
from synthesis.numerics.narrowing import find_narrowest_band
from synthesis.results.candidate_log import OUTRANKED_REASON, CandidateLog, report_candidates
from synthesis.results.placement import place_mechanism
from synthesis.results.ranking import rank_designs, select_best
from synthesis.verification.measures import list_link_lengths

DEFAULT_LINK_RATIO = 10.0
"""Default maximum of the longest distance of two pins of a link over the shortest."""

DEFAULT_TRANSMISSION_ANGLE = 25.0
"""Default minimum transmission angle over the turn, degrees."""

GAIN_TOLERANCE = 1e-2
"""Relative gain of a step below which refinement stops: the jitter is far below the tolerance, or stays above it."""

LINK_RATIO_SHARE = 0.99
"""Share of the permitted link ratio that is used, because the output's pivot is moved a little at the end to make the
range exact."""

ANGLE_MARGIN = 1.0
"""Margin added to a required transmission angle, degrees, because it is smaller between the crank angles evaluated."""

MAX_STARTS, SUFFICIENT_DESIGNS = 8, 5
"""Maximum number of starts refined for each type, and number of sound designs that ends the search."""

SUFFICIENT_SHAPES = 8
"""Number of shapes within the tolerance that ends refinement, for dwells with places of their own."""

PERTURBED_COUNT = 4
"""Number of shapes with the smallest movement that are perturbed at a time."""

DUPLICATE_TOLERANCE = 0.02
"""Two shapes are duplicates if no number differs by more than this share of the largest."""

REPEATED_COUNT, LARGER_ANGLES = 2, (35.0, 45.0)
"""Number of refined shapes that are refined again, and the larger transmission angles for it, degrees."""

MAX_MOVEMENT_RATIO, NEAREST_MISS_COUNT = 1.1, 2
"""Movement over the tolerance beyond which a refined shape is not driven, and the number of exceptions that may be the
nearest misses."""

MAX_COORDINATE = 4.0
"""Maximum coordinates of P, pivots and slides, in units of the maximum link ratio."""

MAX_VIOLATION = 1e-4
"""Maximum violation of a constraint after refinement; verification decides."""

CURVE_METHOD, RANDOM_METHOD = "dwell-method-from-curves", "dwell-method-from-random-sixbars"
"""Messages that name the method by the source of its starts."""

TYPE_NAMES = {
    "pseudo_arc": "dwell-pseudo-arc",
    "straight_slot": "dwell-straight-slot",
    "watt_2": "dwell-watt-2",
    UNCLASSED_SIXBAR: "dwell-stephenson-2",
}
"""Messages with the names of the types."""

OUTPUT_KINDS: dict[tuple[str, str], Kind] = {
    ("pseudo_arc", "rocker"): "rocker",
    ("pseudo_arc", "slider"): "slider",
    ("straight_slot", "rocker"): "slot",
    ("watt_2", "rocker"): "rocker",
    ("watt_2", "slider"): "slider",
    (UNCLASSED_SIXBAR, "rocker"): "triad",
}
"""The output of each type."""


class _Search(NamedTuple):
    """A joint search: a type of mechanism, its output, and the class of its fourbar, if it has one."""

    name: str
    kind: Kind
    carrier: Carrier
    turning: Turning | None


class _Effort(NamedTuple):
    """Effort of a search that drives the stillest of many refined shapes, because few starts lead to sound designs.

    Attributes
    ----------
    starts : int
        Maximum number of starts refined.
    shakes : int
        Number of times that the stillest shapes are perturbed.
    shares : tuple of float
        Relative perturbations of each number.
    """

    starts: int
    shakes: int
    shares: tuple[float, ...]


CURVE_EFFORT = _Effort(48, 5, (0.06,))
RANDOM_EFFORT = _Effort(160, 8, (0.02, 0.06))
"""Effort for outputs on coupler curves, and for Stephenson II sixbars: fewer random sixbars are nearly still, but more
solutions lie near these."""


class _RefinedShape(NamedTuple):
    """A shape, its start, and its output's movement during a dwell, as a share of the range."""

    sixbar: SixbarShape
    start: Start
    moved: float


def solve_dwell(problem: DwellProblem, progress: Progress) -> DwellResult:
    """Solve a problem of dwells."""
    rng = np.random.default_rng(problem.seed)
    sifting = CandidateLog[DwellDesign](problem, undriven="crank_does_not_turn")
    searches = _list_searches(problem)
    for n, search in enumerate(searches):
        name = compose(TYPE_NAMES[search.name])
        if search.kind == "triad":
            progress(n / len(searches), compose("dwell-driving-random-sixbars", type=name))
        else:
            progress(n / len(searches), compose("dwell-driving-outputs", type=name))
        begun = _find_starts(problem, search, rng)
        span = (n + 1.0 / (len(begun) + 1)) / len(searches), (n + 1.0) / len(searches)
        candidates = report_candidates(begun, progress, span, "dwell-refining")
        # Every type gets its own share of designs, so that none is crowded out by the first.
        enough = len(sifting.passed) + SUFFICIENT_DESIGNS
        # Few starts of placed dwells become still enough: refine many, and drive only the best.
        if problem.has_placed_dwells:
            refined, tried = _refine_starts(problem, search.kind, candidates, rng)
            again = _refine_at_larger_angles(problem, search.kind, refined)
            refined, tried = [*refined, *again], tried + len(again)
            stillest = _select_for_driving(problem, refined)
            driven = sifting.verify_candidates(stillest, partial(_verify_shape, problem), enough)
            # Account for the refined shapes that are not driven, so that the counts add up.
            sifting.reject("not_at_rest", tried - len(stillest))
            sifting.reject(OUTRANKED_REASON, len(stillest) - driven)
        else:
            sifting.verify_candidates(candidates, partial(_drive_start, problem, search.kind), enough)
    progress(1.0, compose("dwell-verified"))
    method = RANDOM_METHOD if any(search.kind == "triad" for search in searches) else CURVE_METHOD
    designs = sifting.select_designs(partial(_rank_designs, problem))
    return DwellResult(
        designs=designs,
        search=sifting.build_search(compose(method)),
        summary=_describe_result(problem, designs, sifting),
    )


def _list_searches(problem: DwellProblem) -> list[_Search]:
    return [
        _Search(name, OUTPUT_KINDS[name, problem.output.type], "rocker" if name == "watt_2" else "coupler", turning)
        for name, turning in problem.searches
        if problem.constraints.grashof in ("any", turning)
    ]


def _find_starts(problem: DwellProblem, search: _Search, rng: np.random.Generator) -> list[Start]:
    """Return the most promising shapes of a search."""
    way = math.nan if problem.slides else math.radians(problem.way)
    dwells = tuple(math.radians(wanted.angle) for wanted in problem.dwell_requests)
    places = tuple(math.nan if wanted.place is None else wanted.place for wanted in problem.dwell_requests)
    if problem.dwells is None and len(dwells) == 2:
        places = LOW_PLACE, HIGH_PLACE
    requirements = Requirements(dwells, places, way, _get_min_transmission(problem), _get_max_link_ratio(problem))
    if not problem.has_placed_dwells:
        return find_starts(search.kind, requirements, rng, MAX_STARTS)
    kind, carrier, turning = search[1:]
    if turning is None:
        return stephenson_2_starts.find_triad_starts(requirements, rng, RANDOM_EFFORT.starts)
    return find_placed_starts(kind, carrier, turning, requirements, rng, CURVE_EFFORT.starts)


def warm_up() -> None:
    """Compile or load the kernels.

    A rocker with two dwells covers arcs and pairs, a slotted link with one dwell covers lines; triads follow.
    """
    rng = np.random.default_rng(0)
    one, two = (
        Requirements(count * (0.5,), (LOW_PLACE, HIGH_PLACE)[:count], 0.7, 0.3, DEFAULT_LINK_RATIO) for count in (1, 2)
    )
    find_placed_starts("slider", "rocker", "crank_rocker", one._replace(way=math.nan), rng, 1)
    find_starts("rocker", two, rng, 1)
    find_starts("slot", one, rng, 1)
    stephenson_2_starts.warm_up()


def _get_min_transmission(problem: DwellProblem) -> float:
    stated = problem.constraints.min_transmission_angle
    return math.radians(DEFAULT_TRANSMISSION_ANGLE if stated is None else min(stated + ANGLE_MARGIN, 89.0))


def _get_max_link_ratio(problem: DwellProblem) -> float:
    stated = problem.constraints.max_link_ratio
    return DEFAULT_LINK_RATIO if stated is None else max(LINK_RATIO_SHARE * stated, 1.0)


def _get_jitter(design: DwellDesign) -> float:
    return design.metrics.jitter


def _rank_designs(problem: DwellProblem, designs: list[DwellDesign]) -> list[DwellDesign]:
    return rank_designs(designs, problem.rank_by, {"accuracy": _get_jitter})


def _drive_start(problem: DwellProblem, kind: Kind, start: Start) -> DwellDesign | str | None:
    """Refine a start and return its verified design, or the reason for its rejection."""
    refined = _refine_start(problem, kind, start)
    return "not_at_rest" if refined is None else _verify_shape(problem, refined)


def _refine_starts(
    problem: DwellProblem, kind: Kind, begun: Iterable[Start], rng: np.random.Generator
) -> tuple[list[_RefinedShape], int]:
    """Refine starts until enough shapes are within the tolerance; return them and the number of starts used.

    If the starts do not suffice, the stillest shapes are perturbed and refined again.
    """
    found: list[_RefinedShape] = []
    tried = 0
    allowed = problem.max_movement / problem.way
    effort = RANDOM_EFFORT if kind == "triad" else CURVE_EFFORT
    # The generator perturbs what has been found by then, so that it must stay lazy.
    for start in chain(begun, _perturb_stillest(found, effort, rng)):
        refined = _refine_start(problem, kind, start)
        tried += 1
        if refined is not None:
            found.append(refined)
        if sum(one.moved <= allowed for one in found) == SUFFICIENT_SHAPES:
            break
    return found, tried


def _perturb_stillest(found: list[_RefinedShape], effort: _Effort, rng: np.random.Generator) -> Iterator[Start]:
    """Yield perturbations of the stillest shapes known at the time of each request."""
    for _ in range(effort.shakes):
        for one in sorted(found, key=lambda one: one.moved)[:PERTURBED_COUNT]:
            for share in effort.shares:
                shape = one.sixbar.shape * (1.0 + share * rng.standard_normal(len(one.sixbar.shape)))
                yield one.start._replace(shape=shape)


def _refine_at_larger_angles(problem: DwellProblem, kind: Kind, refined: list[_RefinedShape]) -> list[_RefinedShape]:
    """Refine the stillest shapes again with larger transmission angles, to offer designs that transmit better."""
    best = sorted(refined, key=lambda one: one.moved)[:REPEATED_COUNT]
    stated = _get_min_transmission(problem)
    larger = [angle for angle in map(math.radians, LARGER_ANGLES) if angle > stated]
    again = [
        _refine_start(problem, kind, one.start._replace(shape=one.sixbar.shape), angle)
        for angle in larger
        for one in best
    ]
    return [one for one in again if one is not None and one.moved <= problem.max_movement / problem.way]


def _select_for_driving(problem: DwellProblem, refined: list[_RefinedShape]) -> list[_RefinedShape]:
    """Return distinct refined shapes, the stillest first; of those beyond the tolerance only the best."""
    ordered: list[_RefinedShape] = []
    for one in sorted(refined, key=lambda one: one.moved):
        if not any(_is_duplicate(one.sixbar, other.sixbar) for other in ordered):
            ordered.append(one)
    hopeful = sum(one.moved <= MAX_MOVEMENT_RATIO * problem.max_movement / problem.way for one in ordered)
    return ordered[: hopeful + NEAREST_MISS_COUNT]


def _is_duplicate(one: SixbarShape, other: SixbarShape) -> bool:
    """Return whether two sixbars of a search are nearly equal, regardless of when their dwells begin in the turn."""
    first, second = _get_distinguishing_numbers(one), _get_distinguishing_numbers(other)
    return one.sign == other.sign and float(np.abs(first - second).max()) <= DUPLICATE_TOLERANCE * float(
        np.abs(first).max()
    )


def _get_distinguishing_numbers(sixbar: SixbarShape) -> Real:
    """Return numbers that distinguish sixbars.

    For a Stephenson II these are C on the crank and the distances of pins, which do not depend on the crank's angle.
    """
    if sixbar.kind != "triad":
        return sixbar.shape[: -sixbar.dwells]
    return np.append(stephenson_2.compute_pin_distances(sixbar.shape[None])[0], sixbar.shape[C : C + 2])


def _verify_shape(problem: DwellProblem, refined: _RefinedShape) -> DwellDesign | str | None:
    """Make the range of a shape exact, place it, and verify it."""
    sixbar = refined.sixbar
    if sixbar.kind != "slider":
        # Refinement meets the swing only up to its tolerance.
        shaped = adjust_range(sixbar, math.radians(problem.way))
        if shaped is None:
            return "not_at_rest"
        sixbar = shaped
    mechanism = build_mechanism(problem, sixbar)
    if problem.pivot is None:
        sized = not problem.slides and problem.crank is None
        mechanism = place_mechanism(
            problem.constraints, mechanism, list_link_lengths(mechanism), sized=sized, turned=True
        )
    return verify_dwell(problem, mechanism)


def _refine_start(
    problem: DwellProblem, kind: Kind, start: Start, transmission: float | None = None
) -> _RefinedShape | None:
    """Minimize the output's movement during the dwells near a start, with nearly the required range."""
    ratio = _get_max_link_ratio(problem)
    way = math.nan if kind == "slider" else math.radians(problem.way)
    dwells = tuple(math.radians(wanted.angle) for wanted in problem.dwell_requests)
    sine = math.sin(_get_min_transmission(problem) if transmission is None else transmission)
    task = Task(kind, start.sign, dwells, start.places, way, sine, ratio, start.carrier, start.turning)
    # Chebyshev's nodes are dense at the ends, where the movement is largest.
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(DWELL_SAMPLE_COUNT) / (DWELL_SAMPLE_COUNT - 1))
    if kind == "triad":
        judge, (low, high) = stephenson_2.evaluate_shapes, stephenson_2.get_bounds(len(start.shape), ratio)
    else:
        judge, (low, high) = evaluate_shapes, _get_bounds(kind, start, ratio)
    best = find_narrowest_band(partial(judge, task, nodes), start.shape, low, high, arrived=GAIN_TOLERANCE)
    if best is None or best.violation > MAX_VIOLATION:
        return None
    return _RefinedShape(
        SixbarShape(kind, start.sign, best.shape, start.carrier, len(dwells)), start, 2.0 * best.half_width
    )


def _get_bounds(kind: Kind, start: Start, ratio: float) -> tuple[Real, Real]:
    """Return minimum and maximum numbers of a shape with a fourbar O2 A B O4."""
    high = np.full(len(start.shape), MAX_COORDINATE * ratio)
    low = -high
    # The crank of 1 is the shortest link of a crank-rocker.
    low[:3], high[:3] = 1.0, ratio
    if start.turning == "double_crank":
        low[:3], high[2] = 1.0 / ratio, 1.0
    if kind != "slot":
        low[5], high[5] = low[2], ratio
    if kind == "rocker":
        low[8], high[8] = low[2], ratio
    return low, high


def _describe_result(problem: DwellProblem, designs: list[DwellDesign], sifting: CandidateLog[DwellDesign]) -> str:
    if not sifting.passed:
        return compose("dwell-none-found", reasons=sifting.format_reasons() or compose("dwell-none-rests"))
    if problem.is_listed_later:
        best, message = select_best(sifting.passed, _get_jitter), "dwell-sixbars-found-stillest"
    else:
        best, message = designs[0], "dwell-sixbars-found"
    return compose(
        message,
        count=len(sifting.passed),
        movement=write_output(problem, f"{best.metrics.jitter:.2g}"),
        tolerance=write_output(problem, f"{problem.max_movement:.3g}"),
        angles=list_angles([f"{rest.width:.1f}" for rest in best.targets]),
    )
