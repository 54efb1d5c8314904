"""Second search for designs that a shop can use, if the first one found none.

A search by accuracy ends where linkages are most accurate, often near a toggle. If no design is sound
(:func:`~synthesis.results.practicality.is_sound`), the task is solved again with a minimum transmission angle and a
maximum link ratio as constraints, which steer the search. Only after that may an answer say that no such design was
found.
"""

from __future__ import annotations

from typing import NamedTuple

from kinematics.message import compose
from synthesis.model.answer import AnyResult, Verification
from synthesis.model.kind import AnyKind, Progress
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.protocols import DrivenDesign
from synthesis.results.practicality import (
    ERROR_BAND,
    MAX_LINK_RATIO,
    MIN_TRANSMISSION_ANGLE,
    is_judged,
    is_sound,
    measure_target_error,
    write_error,
)
from synthesis.results.remarks import append_remark
from synthesis.results.simplest_type import merge_searches

LIMIT_CHECKS = "transmission_angle", "link_ratio"
"""Names of the checks of the two constraints, which the client has not requested."""


MAX_ERROR = 0.05
"""Error, as a share of the task's size, up to which sound designs are listed, or twice the smallest error if that is
more."""


class UsableSearch(NamedTuple):
    """An answer with the designs of a second search, and whether sound designs were searched for at all."""

    result: AnyResult
    searched: bool


def search_usable(problem: LinkageProblem, result: AnyResult, kind: AnyKind, progress: Progress) -> UsableSearch:
    """Search for sound designs if none was found; return the answer unchanged if the client decides on limits.

    Parameters
    ----------
    problem : LinkageProblem
        The problem as searched.
    result : result
        Its answer.
    kind : Kind
        Its kind; without :attr:`~synthesis.model.kind.Kind.usable` no second search is made.
    progress : callable
        Progress callback.
    """
    passed = [design for design in result.designs if design.verification.passed]
    if not passed or not is_judged(problem) or any(map(is_sound, passed)):
        return UsableSearch(result, result.search.complete)
    limits = {"min_transmission_angle": MIN_TRANSMISSION_ANGLE, "max_link_ratio": MAX_LINK_RATIO}
    limited = problem.model_copy(update={"constraints": problem.constraints.model_copy(update=limits)})
    statement = None if kind.usable is None else kind.usable(limited)
    if statement is None or statement.find_contradictions():
        return UsableSearch(result, result.search.complete)
    # All solutions are known: only another method or type could add designs.
    if result.search.complete and statement == limited:
        return UsableSearch(result, True)
    second = kind.solve(statement, progress)
    found = [_drop_limits(design) for design in second.designs if design.verification.passed]
    # The second search does not change whether the first one found all solutions of the task.
    search = merge_searches(result.search, second.search).model_copy(update={"complete": result.search.complete})
    result = result.model_copy(update={"search": search})
    if not found:
        return UsableSearch(result, True)
    worst = max(MAX_ERROR, ERROR_BAND * min(map(problem.measure_error, passed)))
    near = [design for design in found if problem.measure_error(design) <= worst]
    given = {
        "angle": f"{MIN_TRANSMISSION_ANGLE:.0f}",
        "ratio": f"{MAX_LINK_RATIO:.0f}",
        "error": write_error(problem, min(map(problem.measure_error, found))),
    }
    remark = compose("results-sound-found-by-limits", count=len(near), **given)
    if not near:
        remark = compose("results-sound-found-far", **given)
        # Sound designs exist, so that no remark may say that none was found.
        return UsableSearch(result.model_copy(update={"summary": append_remark(result.summary, remark)}), False)
    classes = [min(map(problem.classify_design, designs)) for designs in (near, passed)]
    if classes[0] < classes[1]:
        remark = append_remark(remark, compose("results-sound-before-accurate"))
    # Both searches keep a share of the places, as a client may prefer either.
    near = near[: max(problem.max_designs - len(result.designs), (problem.max_designs + 1) // 2)]
    listed = result.designs
    if len(listed) + len(near) > problem.max_designs:
        # The design nearest at the targets is kept wherever it is listed.
        nearest = min(passed, key=measure_target_error)
        kept = max(problem.max_designs - len(near) - 1, 0)
        listed = [nearest, *[design for design in passed if design is not nearest][:kept]]
    designs = [*listed, *near][: problem.max_designs]
    summary = append_remark(result.summary, remark)
    return UsableSearch(result.model_copy(update={"designs": designs, "summary": summary}), True)


def _drop_limits(design: DrivenDesign) -> DrivenDesign:
    """Return a design without the checks of constraints that only steered the search."""
    kept = [check for check in design.verification.checks if check.name not in LIMIT_CHECKS]
    return design.model_copy(update={"verification": Verification.from_checks(kept)})
