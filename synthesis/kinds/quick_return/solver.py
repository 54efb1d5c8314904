"""Quick return: the best mechanism of each requested type, verified, and the range of each type.

Each type has a function that returns the range of its time ratios, with the reason, and one that builds candidates. All
results have been driven and measured.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

from kinematics.message import compose, join_messages
from synthesis.kinds.quick_return import crank_rocker, drag_link, offset_slider, slotted_link
from synthesis.kinds.quick_return.design import QuickReturnDesign, QuickReturnMechanisms, QuickReturnResult, RatioRange
from synthesis.kinds.quick_return.problem import ROCKER_TYPES, QuickReturnProblem
from synthesis.kinds.quick_return.verification import verify_quick_return
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import LENGTH_REASONS, CandidateLog
from synthesis.results.placement import place_mechanism
from synthesis.results.ranking import SORT_KEYS, rank_designs, select_best
from synthesis.verification.measures import list_link_lengths


class _TypeFunctions(NamedTuple):
    """Functions of one type; ``proven``: its first candidate is the best possible, or none exists."""

    reachable: Callable[[QuickReturnProblem], RatioRange]
    candidates: Callable[[QuickReturnProblem], Sequence[QuickReturnMechanisms]]
    proven: bool


TYPE_FUNCTIONS: dict[str, _TypeFunctions] = {
    "fourbar": _TypeFunctions(crank_rocker.compute_ratio_range, crank_rocker.build_crank_rockers, proven=True),
    "drag_link_rocker": _TypeFunctions(drag_link.compute_rocker_range, drag_link.build_drag_link_rockers, proven=False),
    "offset_slider_crank": _TypeFunctions(
        offset_slider.compute_ratio_range, offset_slider.build_offset_slider_cranks, proven=True
    ),
    "crank_shaper": _TypeFunctions(
        slotted_link.compute_crank_shaper_range, slotted_link.build_crank_shapers, proven=False
    ),
    "whitworth": _TypeFunctions(slotted_link.compute_whitworth_range, slotted_link.build_whitworths, proven=False),
    "drag_link_slider": _TypeFunctions(drag_link.compute_slider_range, drag_link.build_drag_link_sliders, proven=False),
}
"""Every type by its name."""

TYPE_NAMES = {
    "fourbar": "quick_return-fourbar",
    "drag_link_rocker": "quick_return-drag-link-rocker",
    "offset_slider_crank": "quick_return-offset-slider-crank",
    "slider_crank": "quick_return-slider-crank",
    "crank_shaper": "quick_return-crank-shaper",
    "whitworth": "quick_return-whitworth",
    "drag_link_slider": "quick_return-drag-link-slider",
}
"""Messages with the names of the types. A mechanism of the type offset_slider_crank has the type slider_crank."""


def solve_quick_return(problem: QuickReturnProblem, progress: Progress) -> QuickReturnResult:
    """Solve a problem of quick return."""
    ranges: list[RatioRange] = []
    short: list[str] = []
    sifting = CandidateLog[QuickReturnDesign](problem, LENGTH_REASONS)
    names = problem.types
    for n, name in enumerate(names):
        progress(n / len(names), compose("quick_return-designing", type=compose(TYPE_NAMES[name])))
        of_type = TYPE_FUNCTIONS[name]
        reach = of_type.reachable(problem)
        ranges.append(reach)
        if not reach.reaches:
            continue
        candidates = of_type.candidates(problem)
        if not candidates:
            short.append(name)
        sifting.verify_candidates(
            (_place_mechanism(problem, one) for one in candidates), partial(verify_quick_return, problem)
        )
    progress(1.0, compose("quick_return-verified"))
    complete = all(not reach.reaches or TYPE_FUNCTIONS[reach.type].proven for reach in ranges) and _is_proven(
        sifting.rejected
    )
    complete |= _find_transmission_bound(problem) is not None
    return QuickReturnResult(
        designs=sifting.select_designs(partial(_select_designs, problem)),
        search=sifting.build_search("quick_return", complete=complete),
        summary=_describe_result(problem, ranges, sifting, short, complete=complete),
        reachable=ranges,
    )


def _place_mechanism(problem: QuickReturnProblem, mechanism: QuickReturnMechanisms) -> QuickReturnMechanisms:
    """Place a mechanism to satisfy regions and limits of length, as far as the problem leaves that open."""
    # Place, direction and size are already determined.
    if problem.is_positioned:
        return mechanism
    sized = not problem.slides and problem.rocker_length is None
    turned = problem.ground_angle is None
    return place_mechanism(problem.constraints, mechanism, list_link_lengths(mechanism), sized=sized, turned=turned)


def _find_transmission_bound(problem: QuickReturnProblem) -> float | None:
    """Return the bound of the transmission angle, degrees, if the problem requires more; None otherwise.

    A rocker of swing ψ is that of a crank-rocker, alone or behind a drag link. Its transmission angle is below
    90° − ψ/2, which it approaches with a long coupler.
    """
    demanded = problem.constraints.min_transmission_angle
    if demanded is None or problem.swing_angle is None or set(problem.types) - set(ROCKER_TYPES):
        return None
    bound = 90.0 - 0.5 * problem.swing_angle
    return bound if demanded >= bound else None


def _is_proven(rejected: Counter[str]) -> bool:
    """Return True if every rejection is by a limit that the optimum provably approaches best."""
    return rejected.keys() <= {"transmission_angle"}


_RANK_KEYS: dict[str, Callable[[QuickReturnDesign], float]] = {
    "accuracy": lambda design: 0.0,  # all are exact
    "transmission_angle": lambda design: -round(design.metrics.min_transmission_angle, 6),
}


def _select_designs(problem: QuickReturnProblem, designs: list[QuickReturnDesign]) -> list[QuickReturnDesign]:
    """Return designs in the requested order, limited so that no type takes more than its share of the answer."""
    # Rounded up, so that the shares fill the answer.
    share = -(-problem.max_designs // len(problem.types))
    of_type: Counter[str] = Counter()
    chosen = []
    for design in rank_designs(designs, problem.rank_by, _RANK_KEYS):
        of_type[design.mechanism.type] += 1
        if of_type[design.mechanism.type] <= share or not design.verification.passed:
            chosen.append(design)
    return chosen


def _describe_result(
    problem: QuickReturnProblem,
    ranges: list[RatioRange],
    sifting: CandidateLog[QuickReturnDesign],
    short: list[str],
    *,
    complete: bool,
) -> str:
    lines = []
    for reach in ranges:
        if not reach.reaches:
            lines.append(_describe_range(problem.time_ratio, reach))
    lines += [_describe_failure(name, problem.link_ratio_limit) for name in short]
    if sifting.passed:
        best = select_best(sifting.passed, SORT_KEYS["transmission_angle"])
        count = len(sifting.passed)
        lines.insert(
            0,
            compose(
                "quick_return-designs-found",
                count=count,
                ratio=f"{problem.time_ratio:g}",
                angle=f"{best.metrics.min_transmission_angle:.3f}",
                type=compose(TYPE_NAMES[best.mechanism.type]),
            ),
        )
    else:
        lines.insert(0, compose("quick_return-no-design-exists" if complete else "quick_return-no-design-found"))
        bound = _find_transmission_bound(problem)
        if bound is not None:
            lines.append(
                compose("quick_return-transmission-bound", swing=f"{problem.swing_angle:g}", bound=f"{bound:g}")
            )
        lines.append(sifting.describe_reasons().lstrip())
    return join_messages(lines)


def _describe_failure(name: str, link_ratio: float | None) -> str:
    """Describe in a sentence that a type has no member, or none with a link ratio of at most ``link_ratio``."""
    proven, name = TYPE_FUNCTIONS[name].proven, compose(TYPE_NAMES[name])
    if link_ratio is None:
        return compose("quick_return-type-does-not-exist" if proven else "quick_return-type-not-found", type=name)
    return compose(
        "quick_return-link-ratio-impossible" if proven else "quick_return-link-ratio-not-found",
        type=name,
        link_ratio=f"{link_ratio:g}",
    )


def _describe_range(time_ratio: float, reach: RatioRange) -> str:
    """Describe in a sentence why a type cannot reach a time ratio: its range and the reason."""
    name, ratio = compose(TYPE_NAMES[reach.type]), f"{time_ratio:g}"
    if reach.greatest is not None and reach.greatest <= reach.least:
        return compose("quick_return-type-without-range", type=name, ratio=ratio, reason=reach.reason)
    least = f"{reach.least:g}"
    if reach.greatest is None:
        spread = compose("quick_return-from" if reach.least_included else "quick_return-above", least=least)
    else:
        spread = compose(
            "quick_return-from-to-below" if reach.least_included else "quick_return-above-to-below",
            least=least,
            greatest=f"{reach.greatest:.6g}",
        )
    return compose("quick_return-ratio-out-of-range", type=name, ratio=ratio, range=spread, reason=reach.reason)
