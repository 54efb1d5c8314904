"""Designs on the grid of a shop, or of links in stock: the best near each design, verified like any other.

A search finds exact designs; for each of them the linkages on the grid near it are driven, the nearest to the task
first, until one keeps every demand. What was to be met exactly is met as nearly as can be by these, and within the
quality where one is stated.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.model.answer import Check, Gap, NearestMiss, Reachable, Result, Verification
from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.model.linkage_answer import ExactDesign
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.manufacture import Held
from synthesis.outcome.held import held_to_all
from synthesis.outcome.manufacture import branch_range, errors_of, exact_design
from synthesis.proof.checks import at_most

Nearly = Callable[[Any, Any, Any], Any]

ON_GRID = "on_grid"
"""Reason of a design near which no linkage on the grid could be driven at all."""

DRIVEN, JUDGED = 100, 40
"""Linkages near a design, at most, that are verified, and that are held to the demands that come after that."""

FAR = 0.05
"""Share of the task's size, and radians, by which a target may be missed where no quality is stated."""

WORSE = 2.0
"""What an exact design misses may be missed so many times; of a fit that misses by more than :data:`FAR`."""


class _Rounded(NamedTuple):
    """The best linkage on the grid near a design, and why it is rejected; empty where it passed."""

    design: Any
    reason: str


def on_grid(problem: LinkageProblem, result: Result[Any], nearly: Nearly | None) -> Result[Any]:
    """An answer whose designs are those on the grid that the problem states, the exact ones beside them.

    Parameters
    ----------
    problem : LinkageProblem
        What was asked, with as many designs as are wanted.
    result : Result
        Exact designs; those that break a check stay as they are, after the others.
    nearly : callable
        What the kind declares as :attr:`synthesis.model.kind.Kind.nearly`.
    """
    stated = problem.manufacture
    if stated is None or not stated.gridded or nearly is None:
        return result
    passed = [design for design in result.designs if design.verification.passed]
    failed = [design for design in result.designs if not design.verification.passed]
    if not passed:
        return result
    found: list[Any] = []
    missed: list[_Rounded] = []
    for design in passed:
        if len(found) >= problem.max_designs:
            break
        rounded = _rounded(problem, design, nearly)
        if rounded.reason:
            missed.append(rounded)
        else:
            found.append(rounded.design)
    lost = Counter(rounded.reason for rounded in missed)
    search = result.search
    account = {
        "complete": False,
        "accepted": search.accepted - len(missed),
        "rejected": dict(Counter(search.rejected) + lost),
    }
    told = f" Rounded: near {len(found)} of {len(found) + len(missed)} of them"
    told += " there is a linkage on the grid that keeps all demands."
    if problem.include_failed:
        failed = [rounded.design for rounded in missed if rounded.design is not None] + failed
    return result.model_copy(
        update={
            "designs": [*found, *(failed if problem.include_failed else [])][: problem.max_designs],
            "search": search.model_copy(update=account),
            "summary": result.summary + told,
            "nearest_miss": result.nearest_miss if found else _nearest_miss(missed),
        }
    )


def _rounded(problem: LinkageProblem, design: Any, nearly: Nearly) -> _Rounded:
    """The best linkage on the grid near a design."""
    # Only who states the block waits for the import.
    from synthesis.manufacture.grid import mechanism_of, nearest_on_grid, with_dimensions
    from synthesis.manufacture.linkage import linkage_of

    linkage = linkage_of(design.mechanism)
    if linkage is None or problem.manufacture is None:
        return _Rounded(None, ON_GRID)
    exact, held = exact_design(problem, design), problem.held_to(design)
    limits = _limits(problem, held, exact)
    near = nearest_on_grid(linkage, held, problem.manufacture, branch_range(problem, design), limits)
    if isinstance(near, str):
        return _Rounded(None, ON_GRID)
    first, judged = _Rounded(None, ON_GRID), 0
    for n in range(min(len(near.rows), DRIVEN)):
        mechanism = mechanism_of(linkage, near, n)
        driven = None if mechanism is None else nearly(problem, design, mechanism)
        if driven is None:
            continue
        checks = [*_quality_checks(problem, driven, exact), *driven.verification.checks]
        rounded = driven.model_copy(
            update={
                "mechanism": with_dimensions(driven.mechanism, near.rows[n]),
                "exact": exact,
                "verification": Verification.of(checks),
            }
        )
        if rounded.verification.passed:
            judged += 1
            rounded = held_to_all(problem, rounded)
            if rounded is None:
                continue
        broken = [check.name for check in rounded.verification.checks if not check.passed]
        if not broken:
            return _Rounded(rounded, "")
        if first.design is None:
            first = _Rounded(rounded, broken[0])
        if judged >= JUDGED:
            break
    return first


def _quality_checks(problem: LinkageProblem, design: Any, exact: ExactDesign) -> list[Check]:
    """How far targets without a tolerance of their own are missed: against the quality, or what is still an answer."""
    error, angle = errors_of(problem, design)
    held = problem.held_to(design)
    own = _own_limits(held)
    if own is not None:
        free = [target for target, has in zip(design.targets, own, strict=True) if not has]
        error = max((target.point_residual for target in free), default=None)
        angle = max((target.angle_residual for target in free if target.angle_residual is not None), default=None)
    distance, turn = _limits(problem, held, exact)
    checks = []
    if error is not None:
        checks.append(at_most("max_error", error, distance, LENGTH))
    if angle is not None:
        checks.append(at_most("max_angle_error", angle, math.degrees(turn), ANGLE))
    return checks


def _limits(problem: LinkageProblem, held: Held, exact: ExactDesign) -> tuple[float, float]:
    """Distance and angle (radians) by which targets may be missed: the quality, or what is still an answer."""
    quality = None if problem.manufacture is None else problem.manufacture.quality
    distance = max(FAR * held.size, WORSE * (exact.max_error or 0.0))
    angle = max(FAR, WORSE * math.radians(exact.max_angle_error or 0.0))
    if quality is not None and quality.max_error is not None:
        distance = quality.max_error
    if quality is not None and quality.max_angle_error is not None:
        angle = math.radians(quality.max_angle_error)
    return distance, angle


def _own_limits(held: Held) -> NDArray[np.bool_] | None:
    """Which targets have a tolerance of their own; None where none has."""
    limits = held.limits
    if limits is None:
        return None
    own = np.asarray(((limits > 0.0) & np.isfinite(limits)).any(axis=1))
    return own if own.any() else None


def _nearest_miss(missed: list[_Rounded]) -> NearestMiss[Any] | None:
    """The linkage on the grid that breaks the fewest checks, the nearest to the task of those."""
    known = [rounded.design for rounded in missed if rounded.design is not None]
    if not known:
        return None

    def broken(design: Any) -> list[Check]:
        return [check for check in design.verification.checks if not check.passed]

    best = min(known, key=lambda design: (len(broken(design)), design.metrics.rms_residual))
    gaps = [
        Gap(check=check.name, value=check.value, limit=check.limit, dimension=check.dimension) for check in broken(best)
    ]
    return NearestMiss[Any](design=best, gaps=gaps, reachable=Reachable())
