"""Quick return: the best mechanism of each requested type, verified, and the range of each type.

Each type has a function that returns the range of its time ratios, with the reason, and one that builds candidates. All
results have been driven and measured.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

from synthesis.kinds.quick_return import crank_rocker, drag_link, offset_slider, slotted_link
from synthesis.kinds.quick_return.design import QuickReturnDesign, QuickReturnMechanisms, QuickReturnResult, RatioRange
from synthesis.kinds.quick_return.problem import QuickReturnProblem
from synthesis.kinds.quick_return.verification import verify_quick_return
from synthesis.model.counting import choose_word, format_count
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


def solve_quick_return(problem: QuickReturnProblem, progress: Progress) -> QuickReturnResult:
    """Solve a problem of quick return."""
    ranges: list[RatioRange] = []
    short: list[str] = []
    sifting = CandidateLog[QuickReturnDesign](problem, LENGTH_REASONS)
    names = problem.types
    for n, name in enumerate(names):
        progress(n / len(names), f"designing: {name.replace('_', ' ')}")
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
    progress(1.0, "verified")
    complete = all(not reach.reaches or TYPE_FUNCTIONS[reach.type].proven for reach in ranges) and _is_proven(
        sifting.rejected
    )
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
            lines.append(
                f"The {_format_type(reach.type)} cannot reach a time ratio of {problem.time_ratio:g}: "
                f"{_describe_range(reach)}."
            )
    within = "" if problem.link_ratio_limit is None else f" with a link ratio of at most {problem.link_ratio_limit:g}"
    lines += [
        f"No {_format_type(name)}{within} exists."
        if TYPE_FUNCTIONS[name].proven
        else f"No {_format_type(name)}{within} was found."
        for name in short
    ]
    if sifting.passed:
        best = select_best(sifting.passed, SORT_KEYS["transmission_angle"])
        count = len(sifting.passed)
        lines.insert(
            0,
            f"{format_count(count, 'design')} {choose_word(count, 'has', 'have')} a measured time ratio of "
            f"{problem.time_ratio:g}. The best minimum transmission angle is "
            f"{best.metrics.min_transmission_angle:.3f}°, of a {_format_type(best.mechanism.type)}.",
        )
    else:
        lines.insert(0, "No design exists." if complete else "No design was found.")
        if sifting.rejected:
            lines.append(f"Rejected: {sifting.format_reasons()}.")
    return " ".join(lines)


def _format_type(name: str) -> str:
    """Return the name of a type in words."""
    return name.replace("_", " ")


def _describe_range(reach: RatioRange) -> str:
    """Describe the range of time ratios of a type and its reason."""
    to = "" if reach.greatest is None else f" to below {reach.greatest:.6g}"
    from_ = f"from {reach.least:g}" if reach.least_included else f"above {reach.least:g}"
    spread = f"{from_}{to}"
    if reach.greatest is not None and reach.greatest <= reach.least:
        spread = "none"
    return f"its range with this output is {spread} ({reach.reason})"
