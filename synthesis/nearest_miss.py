"""The nearest miss: where no design satisfies all demands, the one that breaks them least, and what is within reach.

One constraint after another is left out and the task is solved again: what the designs then have of it is what can be
reached beside all other demands. Where that gives none, all constraints are left out together. A limit that alone is
out of reach is then approached: the task is solved with limits between what was reached and what is demanded, by
bisection. Of gears it is the tolerance that is left out. Everything else has its nearest miss among the designs that
were driven and failed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from synthesis.model.answer import Check, Gap, NearestMiss, Result, Verification
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_statement import Constraints
from synthesis.model.statement import StatedProblem
from synthesis.proof.constraints import constraint_checks
from synthesis.proof.measures import Measures, link_lengths

Solve = Callable[[Any, Progress], Result[Any]]

MAX_DESIGNS = 20
"""Designs of each relaxed task that are looked at."""

UNMEASURED = 1.0
"""Relative gap of a broken demand that has no measure, such as a class of linkage: as much as all of a limit."""

RANK_BY = {"min_transmission_angle": "transmission_angle", "link_length": "size"}
"""How designs are ordered when a constraint is left out, so that those near to it come first; others by quality."""

APPROACHES = 5
"""Steps of the bisection: a gap is known to a thirtieth of what it was."""

REACHABLE: Mapping[str, tuple[str, Callable[[Sequence[float]], float]]] = {
    "min_transmission_angle": ("min_transmission_angle", max),
    "max_link_ratio": ("link_ratio", min),
}
"""By the constraint: the measure whose best value beside all other demands is told."""


REACHED_BY = {"transmission_angle": "min_transmission_angle", "link_ratio": "max_link_ratio"}
"""The constraint that a check is of, where its best value is told."""


RATIO_ERRORS = {
    "gear_train": ("ratio_error", "relative_error"),
    "planetary_train": ("ratio", "error"),
    "gearbox": ("speeds", "max_error"),
    "layshaft_gearbox": ("ratios", "max_error"),
}
"""Of each kind of gears: the check of its tolerance, and the measure that it compares."""


class _Miss(NamedTuple):
    """A design and the checks that it breaks."""

    design: Any
    broken: list[Check]

    @property
    def distance(self) -> float:
        """Sum of the relative gaps: what misses are compared by."""
        return math.fsum(map(_relative_gap, self.broken))


def nearest_miss(problem: StatedProblem, solve: Solve, progress: Progress) -> NearestMiss[Any] | None:
    """What comes nearest to a problem that has no design.

    Parameters
    ----------
    problem : StatedProblem
        A consistent statement that ``solve`` found no design for.
    solve : callable
        The solver of its kind.
    progress : callable
        Told how far the work is.

    Returns
    -------
    NearestMiss or None
        None where nothing is found without the demands either.
    """
    reachable: dict[str, float] = {}
    misses = _without_constraints(problem, solve, part_of(progress, 0.0, 0.8), reachable)
    misses = misses or _without_tolerance(problem, solve, part_of(progress, 0.0, 0.8), reachable)
    misses = misses or _failed(problem, solve, part_of(progress, 0.8, 1.0))
    progress(1.0, "verified")
    if not misses:
        return None
    nearest = min(misses, key=lambda miss: miss.distance)
    gaps = [
        Gap(check=check.name, value=check.value, limit=check.limit, dimension=check.dimension)
        for check in nearest.broken
    ]
    return NearestMiss(design=nearest.design, gaps=gaps, reachable=reachable)


def _without_constraints(problem: Any, solve: Solve, progress: Progress, reachable: dict[str, float]) -> list[_Miss]:
    """Designs of the task without one of its constraints; without all where that gives none."""
    stated = _stated(problem)
    attempts = [[name] for name in stated] + ([stated] if len(stated) > 1 else [])
    misses: list[_Miss] = []
    exhaustive = True
    for n, left_out in enumerate(attempts):
        if misses and len(left_out) > 1:
            break
        span = part_of(progress, n / (len(attempts) + 1), (n + 1) / (len(attempts) + 1))
        result = solve(_relaxed(problem, left_out), span)
        designs, exhaustive = result.designs, exhaustive and result.search.complete
        misses += [miss for design in designs if (miss := _judged(problem, design)).broken]
        if len(left_out) == 1 and left_out[0] in REACHABLE and designs:
            measure, best = REACHABLE[left_out[0]]
            reachable[left_out[0]] = best([getattr(design.metrics, measure) for design in designs])
    single = [miss for miss in misses if len(miss.broken) == 1]
    if single and not exhaustive:  # where all designs are known none is nearer
        nearest = _approached(problem, min(single, key=lambda miss: miss.distance), solve)
        (check,) = nearest.broken
        if check.name in REACHED_BY and check.value is not None:
            reachable[REACHED_BY[check.name]] = check.value
        misses.append(nearest)
    return misses


def _without_tolerance(problem: Any, solve: Solve, progress: Progress, reachable: dict[str, float]) -> list[_Miss]:
    """The most exact gears where none are within the tolerance."""
    if problem.kind not in RATIO_ERRORS or problem.tolerance is None:
        return []
    name, measure = RATIO_ERRORS[problem.kind]
    update = {"tolerance": None, "rank_by": "error", "include_failed": False, "max_designs": 1}
    misses = []
    for design in solve(problem.model_copy(update=update), progress).designs:
        error = abs(float(getattr(design.metrics, measure)))
        if error <= problem.tolerance:
            continue
        broken = Check(name=name, passed=False, value=error, limit=problem.tolerance)
        others = [check for check in design.verification.checks if check.name != name]
        verification = Verification.of([*others, broken])
        misses.append(_Miss(design.model_copy(update={"verification": verification}), [broken]))
        reachable["tolerance"] = error
    return misses


def _failed(problem: StatedProblem, solve: Solve, progress: Progress) -> list[_Miss]:
    """Designs that were driven and break a check."""
    asked = problem.model_copy(update={"include_failed": True, "max_designs": MAX_DESIGNS})
    return [
        _Miss(design, [check for check in design.verification.checks if not check.passed])
        for design in solve(asked, progress).designs
    ]


def _stated(problem: StatedProblem) -> list[str]:
    """The constraints that demand more than a sound motion."""
    constraints = getattr(problem, "constraints", None)
    if not isinstance(constraints, Constraints):
        return []
    plain = Constraints()
    return [
        name
        for name in Constraints.model_fields
        if name not in ("same_branch", "in_order") and getattr(constraints, name) != getattr(plain, name)
    ]


def _relaxed(problem: Any, left_out: Sequence[str]) -> Any:
    """The statement without these constraints."""
    plain = Constraints()
    constraints = problem.constraints.model_copy(update={name: getattr(plain, name) for name in left_out})
    rank_by = RANK_BY.get(left_out[0], "quality") if len(left_out) == 1 else problem.rank_by
    update = {"constraints": constraints, "rank_by": rank_by, "include_failed": False, "max_designs": MAX_DESIGNS}
    return problem.model_copy(update=update)


def _approached(problem: Any, miss: _Miss, solve: Solve) -> _Miss:
    """A miss of one limit, brought nearer to it as long as designs are found."""
    (check,) = miss.broken
    if check.value is None or check.limit is None:
        return miss
    reached, unreached = check.value, check.limit
    for _ in range(APPROACHES):
        limit = 0.5 * (reached + unreached)
        eased = _eased(problem.constraints, check.name, limit)
        if eased is None:
            break
        update = {"constraints": eased, "include_failed": False, "max_designs": MAX_DESIGNS}
        designs = solve(problem.model_copy(update=update), _silent).designs
        nearer = [other for design in designs if len((other := _judged(problem, design)).broken) == 1]
        if nearer:
            miss = min(nearer, key=lambda other: other.distance)
            reached = miss.broken[0].value or 0.0
        else:
            unreached = limit
    return miss


def _silent(_fraction: float, _message: str) -> None:
    pass


def _eased(constraints: Constraints, check: str, limit: float) -> Constraints | None:
    """The constraints with another limit in place of the one that a check is of; None where it has none."""
    lengths = constraints.link_length
    match check:
        case "transmission_angle":
            return constraints.model_copy(update={"min_transmission_angle": limit})
        case "link_ratio":
            return constraints.model_copy(update={"max_link_ratio": limit})
        case "shortest_link" if lengths is not None:
            return constraints.model_copy(update={"link_length": lengths.model_copy(update={"min": limit})})
        case "longest_link" if lengths is not None:
            return constraints.model_copy(update={"link_length": lengths.model_copy(update={"max": limit})})
        case "fixed_pivot_region" | "moving_pivot_region":
            return constraints.model_copy(update={check: getattr(constraints, check).widened(limit)})
    return None


def _judged(problem: Any, design: Any) -> _Miss:
    """A design of a relaxed task with the checks of the constraints that were stated."""
    joints, ground = design.mechanism.skeleton.joints, _ground(design)
    fixed = [complex(*joints[name]) for name in ground]
    moving = [complex(*place) for name, place in joints.items() if name not in (*ground, "P")]
    measures: dict[str, Any] = {name: getattr(design.metrics, name, None) for name in Measures._fields}
    measures["lengths"] = link_lengths(design.mechanism)
    stated = problem.constraints.model_copy(update={"same_branch": False, "in_order": False})
    judged = constraint_checks(stated, Measures(**measures), fixed, moving)
    names = {check.name for check in judged}
    checks = [check for check in design.verification.checks if check.name not in names] + judged
    verified = design.model_copy(update={"verification": Verification.of(checks)})
    return _Miss(verified, [check for check in judged if not check.passed])


def _ground(design: Any) -> list[str]:
    return next(link.joints for link in design.mechanism.skeleton.links if link.name == "ground")


def _relative_gap(check: Check) -> float:
    if check.value is None or check.limit is None:
        return UNMEASURED
    return abs(check.value - check.limit) / (abs(check.limit) or 1.0)
