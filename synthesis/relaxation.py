"""What there is of a task that no design was found for: the design that breaks its demands least, and what is in reach.

One constraint after another is left out and the task is solved again: what the designs then have of it is what can be
reached beside all other demands. Where that gives none, all constraints are left out together. A limit that alone is
out of reach is then approached: the task is solved with limits between what was reached and what is demanded, by
bisection. A design that satisfies all demands although it was found without one is an answer: no demand hides what the
task without it shows. Of gears it is the tolerance that is left out, and a dwell is made shorter. Everything else has
its nearest miss among the designs that were driven and failed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from synthesis.model.answer import Check, Gap, NearestMiss, Reachable, Result, Verification
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_statement import Constraints
from synthesis.model.statement import StatedProblem
from synthesis.proof.constraints import constraint_checks
from synthesis.proof.measures import Measures, link_lengths

Solve = Callable[[Any, Progress], Result[Any]]
Verify = Callable[[Any, Any], Any]

MAX_DESIGNS = 20
"""Designs of each relaxed task that are looked at."""

UNMEASURED = 1.0
"""Relative gap of a broken demand that has no measure, such as a class of linkage: as much as all of a limit."""

RANK_BY = {"min_transmission_angle": "transmission_angle", "link_length": "size"}
"""How designs are ordered when a constraint is left out, so that those near to it come first; others by quality."""

APPROACHES = 4
"""Steps of the bisection: a gap is known to a sixteenth of what it was."""

FEW = 2
"""Constraints up to which each is left out in turn, whatever the others do."""

REACHABLE: Mapping[str, tuple[str, Callable[[Sequence[float]], float]]] = {
    "min_transmission_angle": ("min_transmission_angle", max),
    "max_link_ratio": ("link_ratio", min),
}
"""By the constraint: the measure whose best value beside all other demands is told."""


CONSTRAINT_OF = {
    "transmission_angle": "min_transmission_angle",
    "grashof": "grashof",
    "full_rotation": "full_rotation",
    "shortest_link": "link_length",
    "longest_link": "link_length",
    "link_ratio": "max_link_ratio",
    "fixed_pivot_region": "fixed_pivot_region",
    "moving_pivot_region": "moving_pivot_region",
}
"""The constraint that a check is of."""

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


class Relaxation(NamedTuple):
    """What a task has without its demands: designs that keep them all the same, or what comes nearest."""

    sound: list[Any]
    nearest_miss: NearestMiss[Any] | None


def relaxation(problem: StatedProblem, solve: Solve, progress: Progress, verify: Verify | None = None) -> Relaxation:
    """What there is of a problem that no design was found for.

    Parameters
    ----------
    problem : StatedProblem
        A consistent statement.
    solve : callable
        The solver of its kind, which found no design.
    progress : callable
        Told how far the work is.
    verify : callable, optional
        Measures a finished mechanism against a statement of the kind, where the kind has one.

    Returns
    -------
    Relaxation
        Designs that satisfy all demands although they were found without one; where there are none, the nearest miss,
        which is None where nothing is found without the demands either.
    """
    reachable: dict[str, float] = {}
    sound, misses = _without_constraints(problem, solve, part_of(progress, 0.0, 0.8), reachable)
    if sound:
        return Relaxation(sound, None)
    misses = misses or _without_tolerance(problem, solve, part_of(progress, 0.0, 0.8), reachable)
    if not misses:
        sound, misses = _with_shorter_dwells(problem, solve, verify, part_of(progress, 0.0, 0.8), reachable)
        if sound:
            return Relaxation(sound, None)
    misses = misses or _failed(problem, solve, part_of(progress, 0.8, 1.0))
    progress(1.0, "verified")
    if not misses:
        return Relaxation([], None)
    nearest = min(misses, key=lambda miss: miss.distance)
    gaps = [
        Gap(check=check.name, value=check.value, limit=check.limit, dimension=check.dimension)
        for check in nearest.broken
    ]
    return Relaxation([], NearestMiss(design=nearest.design, gaps=gaps, reachable=Reachable(**reachable)))


def _without_constraints(
    problem: Any, solve: Solve, progress: Progress, reachable: dict[str, float]
) -> tuple[list[Any], list[_Miss]]:
    """Designs of the task without one of its constraints; without all where that gives none.

    Returns those that keep the constraints all the same, and those that do not. ``reachable`` is filled.
    """
    stated = _stated(problem)
    free: list[_Miss] = []
    if len(stated) > FEW:
        # Of many only those are tried one by one that the best design without any breaks.
        relaxed = _relaxed(problem, stated, solve, progress)
        if relaxed.sound or not relaxed.misses:
            return relaxed.sound, []
        free = relaxed.misses
        stated = _constraints_of(min(free, key=lambda miss: miss.distance))
    misses: list[_Miss] = []
    exhaustive = True
    for n, name in enumerate(stated):
        span = part_of(progress, n / (len(stated) + 1), (n + 1) / (len(stated) + 1))
        relaxed = _relaxed(problem, [name], solve, span)
        if relaxed.sound:
            return relaxed.sound, []
        misses += relaxed.misses
        exhaustive &= relaxed.complete
        if name in REACHABLE and relaxed.designs:
            measure, best = REACHABLE[name]
            reachable[name] = best([getattr(design.metrics, measure) for design in relaxed.designs])
    if not misses and not free and len(stated) > 1:
        relaxed = _relaxed(problem, stated, solve, progress)
        return relaxed.sound, relaxed.misses
    single = [miss for miss in misses if len(miss.broken) == 1]
    if single and not exhaustive:  # where all designs are known none is nearer
        nearest = _approached(problem, min(single, key=lambda miss: miss.distance), solve)
        if not nearest.broken:
            return [nearest.design], []
        (check,) = nearest.broken
        name = CONSTRAINT_OF[check.name]
        if name in REACHABLE and check.value is not None:
            reachable[name] = check.value
        misses.append(nearest)
    return [], misses or free


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


def _with_shorter_dwells(
    problem: Any, solve: Solve, verify: Verify | None, progress: Progress, reachable: dict[str, float]
) -> tuple[list[Any], list[_Miss]]:
    """What rests for longest where nothing rests for as long as is demanded, approached by bisection.

    Returns designs that satisfy all demands all the same, and those that do not. ``reachable`` is filled.
    """
    if problem.kind != "dwell" or verify is None:
        return [], []
    reached, unreached = 0.0, problem.dwell_angle
    misses: list[_Miss] = []
    for n in range(APPROACHES):
        tried = 0.5 * (reached + unreached)
        update = {"dwell_angle": tried, "include_failed": False, "max_designs": MAX_DESIGNS}
        span = part_of(progress, n / APPROACHES, (n + 1) / APPROACHES)
        found = solve(problem.model_copy(update=update), span).designs
        if not found:
            unreached = tried
            continue
        reached = reachable["dwell_angle"] = tried
        verified = [design for one in found if (design := verify(problem, one.mechanism)) is not None]
        sound = [design for design in verified if design.verification.passed]
        if sound:
            return sound, []
        misses = [_Miss(one, [check for check in one.verification.checks if not check.passed]) for one in verified]
    return [], misses


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
    plain = type(constraints)()
    return [
        name
        for name in Constraints.model_fields
        if name not in ("same_branch", "in_order") and getattr(constraints, name) != getattr(plain, name)
    ]


class _Relaxed(NamedTuple):
    """What a task has without some of its constraints."""

    designs: list[Any]
    sound: list[Any]
    misses: list[_Miss]
    complete: bool


def _relaxed(problem: Any, left_out: Sequence[str], solve: Solve, progress: Progress) -> _Relaxed:
    """Solve the task without these constraints."""
    plain = type(problem.constraints)()
    constraints = problem.constraints.model_copy(update={name: getattr(plain, name) for name in left_out})
    rank_by = RANK_BY.get(left_out[0], "quality") if len(left_out) == 1 else problem.rank_by
    update = {"constraints": constraints, "rank_by": rank_by, "include_failed": False, "max_designs": MAX_DESIGNS}
    result = solve(problem.model_copy(update=update), progress)
    verdicts = [judged(problem, design) for design in result.designs]
    sound = [verdict.design for verdict in verdicts if verdict.design.verification.passed]
    return _Relaxed(result.designs, sound, [verdict for verdict in verdicts if verdict.broken], result.search.complete)


def _constraints_of(miss: _Miss) -> list[str]:
    """The constraints that a design breaks, in the order in which they are declared."""
    broken = {CONSTRAINT_OF[check.name] for check in miss.broken}
    return [name for name in Constraints.model_fields if name in broken]


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
        nearer = [other for design in designs if len((other := judged(problem, design)).broken) <= 1]
        if nearer:
            miss = min(nearer, key=lambda other: other.distance)
            if not miss.broken:
                break
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


def judged(problem: Any, design: Any) -> _Miss:
    """A design of a relaxed task with the checks of the constraints that were stated, measured on the answer."""
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
