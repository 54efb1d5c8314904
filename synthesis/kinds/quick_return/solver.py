"""Quick return: the best mechanism of each requested type, verified, and the range of each type.

Each type has a function that returns the range of its time ratios, with the reason, and one that builds candidates. All
results have been driven and measured.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

from synthesis.kinds.quick_return import crank_rocker, drag_link, offset_slider, slotted
from synthesis.kinds.quick_return.design import QuickReturnDesign, QuickReturnMechanisms, QuickReturnResult, RatioRange
from synthesis.kinds.quick_return.problem import QuickReturnProblem
from synthesis.kinds.quick_return.verification import verify_quick_return
from synthesis.model.counting import agreeing, counted
from synthesis.model.kind import Progress
from synthesis.outcome.placement import put
from synthesis.outcome.ranking import ranked
from synthesis.outcome.sifting import LENGTHS, Sifting
from synthesis.proof.measures import link_lengths


class _Type(NamedTuple):
    """Functions of one type; ``proven``: its first candidate is the best possible, or none exists."""

    reachable: Callable[[QuickReturnProblem], RatioRange]
    candidates: Callable[[QuickReturnProblem], Sequence[QuickReturnMechanisms]]
    proven: bool


TYPES: dict[str, _Type] = {
    "fourbar": _Type(crank_rocker.reachable, crank_rocker.crank_rockers, proven=True),
    "drag_link_rocker": _Type(drag_link.rocker_reachable, drag_link.drag_link_rockers, proven=False),
    "offset_slider_crank": _Type(offset_slider.reachable, offset_slider.offset_slider_cranks, proven=True),
    "crank_shaper": _Type(slotted.crank_shaper_reachable, slotted.crank_shapers, proven=False),
    "whitworth": _Type(slotted.whitworth_reachable, slotted.whitworths, proven=False),
    "drag_link_slider": _Type(drag_link.slider_reachable, drag_link.drag_link_sliders, proven=False),
}
"""Every type by its name."""


def solve_quick_return(problem: QuickReturnProblem, progress: Progress) -> QuickReturnResult:
    """Solve a problem of quick return."""
    ranges: list[RatioRange] = []
    short: list[str] = []
    sifting = Sifting[QuickReturnDesign](problem, LENGTHS)
    names = problem.types
    for n, name in enumerate(names):
        progress(n / len(names), f"designing: {name.replace('_', ' ')}")
        of_type = TYPES[name]
        reach = of_type.reachable(problem)
        ranges.append(reach)
        if not reach.reaches:
            continue
        candidates = of_type.candidates(problem)
        if not candidates:
            short.append(name)
        sifting.sift((_put(problem, one) for one in candidates), partial(verify_quick_return, problem))
    progress(1.0, "verified")
    complete = all(not reach.reaches or TYPES[reach.type].proven for reach in ranges) and _as_derived(sifting.rejected)
    return QuickReturnResult(
        designs=sifting.designs(partial(_ordered, problem)),
        search=sifting.search("quick_return", complete=complete),
        summary=_summary(problem, ranges, sifting, short, complete=complete),
        reachable=ranges,
    )


def _put(problem: QuickReturnProblem, mechanism: QuickReturnMechanisms) -> QuickReturnMechanisms:
    """Place a mechanism to satisfy regions and limits of length, as far as the problem leaves that open."""
    # Place, direction and size are already determined.
    if problem.placed:
        return mechanism
    sized = not problem.slides and problem.rocker_length is None
    turned = problem.ground_angle is None
    return put(problem.constraints, mechanism, link_lengths(mechanism), sized=sized, turned=turned)


def _as_derived(rejected: Counter[str]) -> bool:
    """Return True if every rejection is by a limit that the optimum provably approaches best."""
    return rejected.keys() <= {"transmission_angle"}


_KEYS: dict[str, Callable[[QuickReturnDesign], float]] = {
    "accuracy": lambda design: 0.0,  # all are exact
    "transmission_angle": lambda design: -round(design.metrics.min_transmission_angle, 6),
}


def _ordered(problem: QuickReturnProblem, designs: list[QuickReturnDesign]) -> list[QuickReturnDesign]:
    """Return designs in the requested order; of those that passed no type takes more than its share of the answer."""
    # Rounded up, so that the shares fill the answer.
    share = -(-problem.max_designs // len(problem.types))
    of_type: Counter[str] = Counter()
    chosen = []
    for design in ranked(designs, problem.rank_by, _KEYS):
        of_type[design.mechanism.type] += 1
        if of_type[design.mechanism.type] <= share or not design.verification.passed:
            chosen.append(design)
    return chosen


def _summary(
    problem: QuickReturnProblem,
    ranges: list[RatioRange],
    sifting: Sifting[QuickReturnDesign],
    short: list[str],
    *,
    complete: bool,
) -> str:
    lines = []
    for reach in ranges:
        if not reach.reaches:
            lines.append(
                f"The {_words(reach.type)} cannot reach a time ratio of {problem.time_ratio:g}: {_said(reach)}."
            )
    within = "" if problem.link_ratio_limit is None else f" with a link ratio of at most {problem.link_ratio_limit:g}"
    lines += [
        f"No {_words(name)}{within} exists." if TYPES[name].proven else f"No {_words(name)}{within} was found."
        for name in short
    ]
    if sifting.passed:
        best = max(sifting.passed, key=lambda design: design.metrics.min_transmission_angle)
        count = len(sifting.passed)
        lines.insert(
            0,
            f"{counted(count, 'design')} {agreeing(count, 'has', 'have')} a measured time ratio of "
            f"{problem.time_ratio:g}. The "
            f"best minimum transmission angle is {best.metrics.min_transmission_angle:.3f}°, of a "
            f"{_words(best.mechanism.type)}.",
        )
    else:
        lines.insert(0, "No design exists." if complete else "No design was found.")
        if sifting.rejected:
            lines.append(f"Rejected: {sifting.listed()}.")
    return " ".join(lines)


def _words(name: str) -> str:
    """Return the name of a type in words."""
    return name.replace("_", " ")


def _said(reach: RatioRange) -> str:
    """Describe the range of time ratios of a type and its reason."""
    to = "" if reach.greatest is None else f" to below {reach.greatest:.6g}"
    from_ = f"from {reach.least:g}" if reach.least_included else f"above {reach.least:g}"
    spread = f"{from_}{to}"
    if reach.greatest is not None and reach.greatest <= reach.least:
        spread = "none"
    return f"its range with this output is {spread} ({reach.reason})"
