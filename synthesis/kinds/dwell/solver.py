"""Dwell sixbars: find promising starts, minimize the output's movement, make the range exact, and verify."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import partial
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.dwell import triad_starts, triads
from synthesis.kinds.dwell.candidates import Asked, Start, starts
from synthesis.kinds.dwell.design import DwellDesign, DwellResult
from synthesis.kinds.dwell.outputs import RESTING, Carrier, Kind, Task, judged
from synthesis.kinds.dwell.placed_starts import placed_starts
from synthesis.kinds.dwell.problem import HIGH, LOW, DwellProblem, Turning
from synthesis.kinds.dwell.shaped import Sixbar, mechanism_of, with_way
from synthesis.kinds.dwell.triad_turn import C
from synthesis.kinds.dwell.verification import verify_dwell
from synthesis.model.counting import counted
from synthesis.model.kind import Progress
from synthesis.model.stated_types import UNCLASSED
from synthesis.numerics.narrowing import narrowest
from synthesis.outcome.placement import put
from synthesis.outcome.ranking import ranked
from synthesis.outcome.sifting import OUTRANKED, Sifting, reported
from synthesis.outcome.usable import usable_first
from synthesis.proof.measures import link_lengths

Real = NDArray[np.float64]

LINK_RATIO = 10.0
"""Default maximum of the longest distance of two pins of a link over the shortest."""

TRANSMISSION = 25.0
"""Default minimum transmission angle over the turn, degrees."""

ARRIVED = 1e-2
"""Relative gain of a step below which refinement stops: the jitter is far below the tolerance, or stays above it."""

EVENER = 0.99
"""Share of a required link ratio that is used: the output's pivot is moved a little at the end, to make the range
exact."""

MARGIN = 1.0
"""Degrees added to a required transmission angle, because it is less between the angles evaluated."""

STARTS, ENOUGH = 8, 5
"""Maximum number of starts refined for each type, and number of sound designs that ends the search."""

STILL_ENOUGH = 8
"""Number of shapes within the tolerance that ends refinement, for dwells with places of their own."""

SHAKEN = 4
"""Number of shapes with the least movement that are perturbed at a time."""

ALIKE = 0.02
"""Two shapes are duplicates if no number differs by more than this share of the largest."""

AGAIN, LARGER_ANGLES = 2, (35.0, 45.0)
"""Number of refined shapes that are refined again, and the larger transmission angles for it, degrees."""

HOPELESS, HOPELESS_DRIVEN = 1.1, 2
"""Movement over the tolerance beyond which a refined shape is not driven, and the number of exceptions that may be the
nearest misses."""

FARTHEST = 4.0
"""Maximum coordinates of P, pivots and slides, in units of the maximum link ratio."""

SLACK = 1e-4
"""Maximum violation of a constraint after refinement; verification decides."""

CURVES = "coupler curves drawn at random, outputs on their arcs and lines"
SIXBARS = "sixbars drawn at random"
"""Sources of the starts, in words."""

KINDS: dict[tuple[str, str], Kind] = {
    ("pseudo_arc", "rocker"): "rocker",
    ("pseudo_arc", "slider"): "slider",
    ("straight_slot", "rocker"): "slot",
    ("watt_2", "rocker"): "rocker",
    ("watt_2", "slider"): "slider",
    (UNCLASSED, "rocker"): "triad",
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


ON_CURVES = _Effort(48, 5, (0.06,))
AT_RANDOM = _Effort(160, 8, (0.02, 0.06))
"""Effort for outputs on coupler curves, and for Stephenson II sixbars: fewer random sixbars are nearly still, but more
solutions lie near these."""


class _Refined(NamedTuple):
    """A shape, its start, and its output's movement during a dwell, as a share of the range."""

    sixbar: Sixbar
    start: Start
    moved: float


def solve_dwell(problem: DwellProblem, progress: Progress) -> DwellResult:
    """Solve a problem of dwells."""
    rng = np.random.default_rng(problem.seed)
    sifting = Sifting[DwellDesign](problem, undriven="crank_does_not_turn")
    searches = _searches(problem)
    for n, search in enumerate(searches):
        name = search.name.replace("_", " ")
        if search.kind == "triad":
            progress(n / len(searches), f"driving random sixbars ({name})")
        else:
            progress(n / len(searches), f"driving outputs on coupler curves ({name})")
        begun = _starts(problem, search, rng)
        span = (n + 1.0 / (len(begun) + 1)) / len(searches), (n + 1.0) / len(searches)
        told = reported(begun, progress, span, "refining {next} of at most {all}")
        # Every type gets its own share of designs, so that none is crowded out by the first.
        enough = len(sifting.passed) + ENOUGH
        # Few starts of placed dwells become still enough: refine many, and drive only the best.
        if problem.placed:
            refined, tried = _enough_refined(problem, search.kind, told, rng)
            again = _at_larger_angles(problem, search.kind, refined)
            refined, tried = [*refined, *again], tried + len(again)
            stillest = _worth_driving(problem, refined)
            driven = sifting.sift(stillest, partial(_verified, problem), enough)
            # Account for the refined shapes that are not driven, so that the counts add up.
            sifting.reject("not_at_rest", tried - len(stillest))
            sifting.reject(OUTRANKED, len(stillest) - driven)
        else:
            sifting.sift(told, partial(_driven, problem, search.kind), enough)
    progress(1.0, "verified")
    drawn = SIXBARS if any(search.kind == "triad" for search in searches) else CURVES
    return DwellResult(
        designs=sifting.designs(partial(_ranked, problem)),
        search=sifting.search(f"{drawn}, sequential linear programming"),
        summary=_summary(problem, sifting),
    )


def _searches(problem: DwellProblem) -> list[_Search]:
    return [
        _Search(name, KINDS[name, problem.output.type], "rocker" if name == "watt_2" else "coupler", turning)
        for name, turning in problem.searches
        if problem.constraints.grashof in ("any", turning)
    ]


def _starts(problem: DwellProblem, search: _Search, rng: np.random.Generator) -> list[Start]:
    """Return the most promising shapes of a search."""
    way = math.nan if problem.slides else math.radians(problem.way)
    dwells = tuple(math.radians(wanted.angle) for wanted in problem.wanted)
    places = tuple(math.nan if wanted.place is None else wanted.place for wanted in problem.wanted)
    if problem.dwells is None and len(dwells) == 2:
        places = LOW, HIGH
    asked = Asked(dwells, places, way, _transmission(problem), _link_ratio(problem))
    if not problem.placed:
        return starts(search.kind, asked, rng, STARTS)
    kind, carrier, turning = search[1:]
    if turning is None:
        return triad_starts.triad_starts(asked, rng, AT_RANDOM.starts)
    return placed_starts(kind, carrier, turning, asked, rng, ON_CURVES.starts)


def warm_up() -> None:
    """Compile or load the kernels: of arcs and pairs by a rocker with two dwells, of lines by a slot with one, and of
    triads."""
    rng = np.random.default_rng(0)
    one, two = (Asked(count * (0.5,), (LOW, HIGH)[:count], 0.7, 0.3, LINK_RATIO) for count in (1, 2))
    placed_starts("slider", "rocker", "crank_rocker", one._replace(way=math.nan), rng, 1)
    starts("rocker", two, rng, 1)
    starts("slot", one, rng, 1)
    triad_starts.warm_up()


def _transmission(problem: DwellProblem) -> float:
    stated = problem.constraints.min_transmission_angle
    return math.radians(TRANSMISSION if stated is None else min(stated + MARGIN, 89.0))


def _link_ratio(problem: DwellProblem) -> float:
    stated = problem.constraints.max_link_ratio
    return LINK_RATIO if stated is None else max(EVENER * stated, 1.0)


def _ranked(problem: DwellProblem, designs: list[DwellDesign]) -> list[DwellDesign]:
    return ranked(designs, problem.rank_by, {"accuracy": lambda design: design.metrics.jitter})


def _driven(problem: DwellProblem, kind: Kind, start: Start) -> DwellDesign | str | None:
    """Refine a start and return its verified design, or the reason for its rejection."""
    refined = _refined(problem, kind, start)
    return "not_at_rest" if refined is None else _verified(problem, refined)


def _enough_refined(
    problem: DwellProblem, kind: Kind, begun: Iterable[Start], rng: np.random.Generator
) -> tuple[list[_Refined], int]:
    """Refine starts until enough shapes are within the tolerance; return them and the number of starts used.

    If the starts do not suffice, the stillest shapes are perturbed and refined again.
    """
    found: list[_Refined] = []
    tried = 0
    allowed = problem.allowed / problem.way
    effort = AT_RANDOM if kind == "triad" else ON_CURVES
    # The generator perturbs what has been found by then, so that it must stay lazy.
    for start in chain(begun, _shaken(found, effort, rng)):
        refined = _refined(problem, kind, start)
        tried += 1
        if refined is not None:
            found.append(refined)
        if sum(one.moved <= allowed for one in found) == STILL_ENOUGH:
            break
    return found, tried


def _shaken(found: list[_Refined], effort: _Effort, rng: np.random.Generator) -> Iterator[Start]:
    """Yield perturbations of the stillest shapes known at the time of each request."""
    for _ in range(effort.shakes):
        for one in sorted(found, key=lambda one: one.moved)[:SHAKEN]:
            for share in effort.shares:
                shape = one.sixbar.shape * (1.0 + share * rng.standard_normal(len(one.sixbar.shape)))
                yield one.start._replace(shape=shape)


def _at_larger_angles(problem: DwellProblem, kind: Kind, refined: list[_Refined]) -> list[_Refined]:
    """Refine the stillest shapes again with larger transmission angles: the trade-off shows the cost of these."""
    best = sorted(refined, key=lambda one: one.moved)[:AGAIN]
    stated = _transmission(problem)
    larger = [angle for angle in map(math.radians, LARGER_ANGLES) if angle > stated]
    again = [
        _refined(problem, kind, one.start._replace(shape=one.sixbar.shape), angle) for angle in larger for one in best
    ]
    return [one for one in again if one is not None and one.moved <= problem.allowed / problem.way]


def _worth_driving(problem: DwellProblem, refined: list[_Refined]) -> list[_Refined]:
    """Return distinct refined shapes, the stillest first; of those beyond the tolerance only the best."""
    ordered: list[_Refined] = []
    for one in sorted(refined, key=lambda one: one.moved):
        if not any(_alike(one.sixbar, other.sixbar) for other in ordered):
            ordered.append(one)
    hopeful = sum(one.moved <= HOPELESS * problem.allowed / problem.way for one in ordered)
    return ordered[: hopeful + HOPELESS_DRIVEN]


def _alike(one: Sixbar, other: Sixbar) -> bool:
    """Return whether two sixbars of a search are nearly equal, regardless of when their dwells begin in the turn."""
    first, second = _numbers(one), _numbers(other)
    return one.sign == other.sign and float(np.abs(first - second).max()) <= ALIKE * float(np.abs(first).max())


def _numbers(sixbar: Sixbar) -> Real:
    """Return numbers that distinguish sixbars; for a triad C on the crank and the distances, which its mirror image
    shares."""
    if sixbar.kind != "triad":
        return sixbar.shape[: -sixbar.dwells]
    return np.append(triads.pin_distances(sixbar.shape[None])[0], sixbar.shape[C : C + 2])


def _verified(problem: DwellProblem, refined: _Refined) -> DwellDesign | str | None:
    """Make the range of a shape exact, place it, and verify it."""
    sixbar = refined.sixbar
    if sixbar.kind != "slider":
        # Refinement meets the swing only up to its tolerance.
        shaped = with_way(sixbar, math.radians(problem.way))
        if shaped is None:
            return "not_at_rest"
        sixbar = shaped
    mechanism = mechanism_of(problem, sixbar)
    if problem.pivot is None:
        sized = not problem.slides and problem.crank is None
        mechanism = put(problem.constraints, mechanism, link_lengths(mechanism), sized=sized, turned=True)
    return verify_dwell(problem, mechanism)


def _refined(problem: DwellProblem, kind: Kind, start: Start, transmission: float | None = None) -> _Refined | None:
    """Minimize the output's movement during the dwells near a start, with nearly the required range."""
    ratio = _link_ratio(problem)
    way = math.nan if kind == "slider" else math.radians(problem.way)
    dwells = tuple(math.radians(wanted.angle) for wanted in problem.wanted)
    sine = math.sin(_transmission(problem) if transmission is None else transmission)
    task = Task(kind, start.sign, dwells, start.places, way, sine, ratio, start.carrier, start.turning)
    # Chebyshev's nodes are dense at the ends, where the movement is largest.
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(RESTING) / (RESTING - 1))
    if kind == "triad":
        judge, (low, high) = triads.judged, triads.bounds(len(start.shape), ratio)
    else:
        judge, (low, high) = judged, _bounds(kind, start, ratio)
    best = narrowest(partial(judge, task, nodes), start.shape, low, high, arrived=ARRIVED)
    if best is None or best.violation > SLACK:
        return None
    return _Refined(Sixbar(kind, start.sign, best.shape, start.carrier, len(dwells)), start, 2.0 * best.half_width)


def _bounds(kind: Kind, start: Start, ratio: float) -> tuple[Real, Real]:
    """Return minimum and maximum numbers of a shape with a fourbar O2 A B O4."""
    high = np.full(len(start.shape), FARTHEST * ratio)
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


def _summary(problem: DwellProblem, sifting: Sifting[DwellDesign]) -> str:
    unit = f" {problem.length_unit}" if problem.output.type == "slider" else "°"
    if not sifting.passed:
        reasons = sifting.listed() or "none comes to rest"
        return f"No dwell sixbar was found that satisfies all constraints ({reasons}). One may still exist."
    shown, count = _ranked(problem, sifting.passed), len(sifting.passed)
    if problem.listed_later:
        best, which = min(shown, key=lambda design: design.metrics.jitter), "stillest"
    else:
        best, which = usable_first(problem, shown[: problem.max_designs]).designs[0], "first"
    widths = " and ".join(f"{rest.width:.1f}°" for rest in best.targets)
    return (
        f"{counted(count, 'dwell sixbar')} found. In the {which} the output moves by at most "
        f"{best.metrics.jitter:.2g}{unit} during the dwell, and stays within {problem.allowed:.3g}{unit} over {widths} "
        "of the crank."
    )
