"""Dwell sixbars: promising starts, the output kept as still as can be, the way made exact, and verification."""

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
"""Longest distance of two pins of a link over the shortest, at most, where the client says nothing."""

TRANSMISSION = 25.0
"""Least transmission angle over the turn, degrees, where the client says nothing."""

ARRIVED = 1e-2
"""Gain of a step, as a share, below which no more are made: the jitter is far below the tolerance, or stays above."""

EVENER = 0.99
"""Share of a demanded link ratio that is used: the output's pivot is moved a little at last, to make the way exact."""

MARGIN = 1.0
"""Degrees by which a demanded transmission angle is exceeded: between the angles that are looked at it is less."""

STARTS, ENOUGH = 8, 5
"""Starts that are refined for each type at most, and sound designs after which no more are."""

STILL_ENOUGH = 8
"""Shapes within the tolerance after which no more are refined, of dwells with places of their own."""

SHAKEN = 4
"""How many of the stillest shapes are shaken at a time."""

ALIKE = 0.02
"""Share of the largest number of a shape by which all numbers of another must not differ for it to be another."""

AGAIN, LARGER_ANGLES = 2, (35.0, 45.0)
"""Refined shapes that are refined once more, and the transmission angles with which, degrees."""

HOPELESS, HOPELESS_DRIVEN = 1.1, 2
"""Movement over the tolerance beyond which a refined shape is not driven, but for some that may come nearest."""

FARTHEST = 4.0
"""Coordinates of P, pivots and slides, in units of the greatest link ratio, at most."""

SLACK = 1e-4
"""Violation of a constraint with which a shape still counts as one; verification decides."""

CURVES = "coupler curves drawn at random, outputs on their arcs and lines"
SIXBARS = "sixbars drawn at random"
"""Where the starts come from, in words."""

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
    """What is looked for together: a type of mechanism, its output, and what its fourbar is, if it has one."""

    name: str
    kind: Kind
    carrier: Carrier
    turning: Turning | None


class _Effort(NamedTuple):
    """What is spent where the stillest of many refined shapes are driven, since few starts lead to sound designs.

    Attributes
    ----------
    starts : int
        That are refined at most.
    shakes : int
        Times that the stillest shapes are shaken.
    shares : tuple of float
        By which share of each number.
    """

    starts: int
    shakes: int
    shares: tuple[float, ...]


ON_CURVES = _Effort(48, 5, (0.06,))
AT_RANDOM = _Effort(160, 8, (0.02, 0.06))
"""For outputs on coupler curves, and for triads: of random sixbars fewer are near to something still, and near these
there is more to be found."""


class _Refined(NamedTuple):
    """A shape, where it was begun, and what its output moves during a dwell, as a share of the way."""

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
        enough = len(sifting.passed) + ENOUGH
        if problem.placed:
            refined, tried = _enough_refined(problem, search.kind, told, rng)
            again = _at_larger_angles(problem, search.kind, refined)
            refined, tried = [*refined, *again], tried + len(again)
            stillest = _worth_driving(problem, refined)
            driven = sifting.sift(stillest, partial(_verified, problem), enough)
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
    """The most promising shapes of a search."""
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
    """Load the kernels: of arcs and pairs by a rocker with two dwells, of lines by a slot with one, and of triads."""
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
    """The verified design that a start leads to."""
    refined = _refined(problem, kind, start)
    return "not_at_rest" if refined is None else _verified(problem, refined)


def _enough_refined(
    problem: DwellProblem, kind: Kind, begun: Iterable[Start], rng: np.random.Generator
) -> tuple[list[_Refined], int]:
    """Refined shapes, until enough of them keep within the tolerance; and how many starts that took.

    Where the starts do not give enough, the stillest shapes are shaken and refined once more.
    """
    found: list[_Refined] = []
    tried = 0
    allowed = problem.allowed / problem.way
    effort = AT_RANDOM if kind == "triad" else ON_CURVES
    for start in chain(begun, _shaken(found, effort, rng)):
        refined = _refined(problem, kind, start)
        tried += 1
        if refined is not None:
            found.append(refined)
        if sum(one.moved <= allowed for one in found) == STILL_ENOUGH:
            break
    return found, tried


def _shaken(found: list[_Refined], effort: _Effort, rng: np.random.Generator) -> Iterator[Start]:
    """Starts near the stillest of the shapes that were found by the time it is asked."""
    for _ in range(effort.shakes):
        for one in sorted(found, key=lambda one: one.moved)[:SHAKEN]:
            for share in effort.shares:
                shape = one.sixbar.shape * (1.0 + share * rng.standard_normal(len(one.sixbar.shape)))
                yield one.start._replace(shape=shape)


def _at_larger_angles(problem: DwellProblem, kind: Kind, refined: list[_Refined]) -> list[_Refined]:
    """The stillest of refined shapes once more, with larger transmission angles: the front tells what these cost."""
    best = sorted(refined, key=lambda one: one.moved)[:AGAIN]
    stated = _transmission(problem)
    larger = [angle for angle in map(math.radians, LARGER_ANGLES) if angle > stated]
    again = [
        _refined(problem, kind, one.start._replace(shape=one.sixbar.shape), angle) for angle in larger for one in best
    ]
    return [one for one in again if one is not None and one.moved <= problem.allowed / problem.way]


def _worth_driving(problem: DwellProblem, refined: list[_Refined]) -> list[_Refined]:
    """Refined shapes that differ, the stillest first; of those that do not keep within the tolerance only the best."""
    ordered: list[_Refined] = []
    for one in sorted(refined, key=lambda one: one.moved):
        if not any(_alike(one.sixbar, other.sixbar) for other in ordered):
            ordered.append(one)
    hopeful = sum(one.moved <= HOPELESS * problem.allowed / problem.way for one in ordered)
    return ordered[: hopeful + HOPELESS_DRIVEN]


def _alike(one: Sixbar, other: Sixbar) -> bool:
    """Whether two sixbars of a search are nearly the same; when in the turn their dwells begin is not looked at."""
    first, second = _numbers(one), _numbers(other)
    return one.sign == other.sign and float(np.abs(first - second).max()) <= ALIKE * float(np.abs(first).max())


def _numbers(sixbar: Sixbar) -> Real:
    """What tells sixbars apart; of a triad C on the crank beside the distances, which its mirror image has too."""
    if sixbar.kind != "triad":
        return sixbar.shape[: -sixbar.dwells]
    return np.append(triads.pin_distances(sixbar.shape[None])[0], sixbar.shape[C : C + 2])


def _verified(problem: DwellProblem, refined: _Refined) -> DwellDesign | str | None:
    """The design of a shape, with exactly the demanded way."""
    sixbar = refined.sixbar
    if sixbar.kind != "slider":
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
    """The shape near a start whose output moves least during the dwells, with nearly the demanded way."""
    ratio = _link_ratio(problem)
    way = math.nan if kind == "slider" else math.radians(problem.way)
    dwells = tuple(math.radians(wanted.angle) for wanted in problem.wanted)
    sine = math.sin(_transmission(problem) if transmission is None else transmission)
    task = Task(kind, start.sign, dwells, start.places, way, sine, ratio, start.carrier, start.turning)
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
    """Least and greatest numbers of a shape with a fourbar O2 A B O4."""
    high = np.full(len(start.shape), FARTHEST * ratio)
    low = -high
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
        return f"No dwell sixbar was found that meets every demand ({reasons}); that none exists is not proven."
    shown, count = _ranked(problem, sifting.passed), len(sifting.passed)
    if problem.listed_later:
        best, which = min(shown, key=lambda design: design.metrics.jitter), "stillest"
    else:
        best, which = usable_first(problem, shown[: problem.max_designs]).designs[0], "first"
    widths = " and ".join(f"{rest.width:.1f}°" for rest in best.targets)
    return (
        f"{counted(count, 'dwell sixbar')}; in the {which} the output moves by {best.metrics.jitter:.2g}{unit} at most "
        f"while it rests, and keeps within {problem.allowed:.3g}{unit} over {widths} of the crank."
    )
