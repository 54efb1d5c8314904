"""Nearest miss of a problem without designs: the design that violates the constraints least, and reachable values.

The workspace is relaxed first: the clearance before box and obstacles, and these before the zones of pivots, so that
the nearest design avoids as many obstacles as possible and has its pivots in their zones. Then the constraints are
dropped one after another, and the problem is solved again. The value of the dropped constraint in those designs is what
can be reached with all others. If that gives no design, all constraints are dropped together.

A single limit that cannot be reached is then approached by bisection between the reached and the required value: by
continuation from known designs if the kind supports it, otherwise by a whole search. A design found without a
constraint that nevertheless satisfies it is a regular answer. For gears the tolerance is dropped, and a dwell is
shortened. All other problems have their nearest miss among the designs that were driven and failed.

:mod:`synthesis.outcome.allowance` limits the time of all of this; whatever was found by then is reported.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from synthesis.model.answer import Check, Gap, NearestMiss, Reachable, Result, Verification
from synthesis.model.dimension import LENGTH
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_statement import FORCES, Constraints, Region
from synthesis.model.statement import StatedProblem
from synthesis.outcome.allowance import Allowance, Metered
from synthesis.outcome.forces import with_force_checks, with_forces
from synthesis.proof.constraints import constraint_checks, within_zone
from synthesis.proof.measures import Measures, link_lengths
from synthesis.proof.room import judged_by_room
from synthesis.proof.space import ROOM

Solve = Callable[[Any, Progress], Result[Any]]
Verify = Callable[[Any, Any], Any]
Continue = Callable[[Any, Sequence[Any], Progress], Sequence[Any] | None]

MAX_DESIGNS = 20
"""Maximum number of designs of each relaxed problem, the likely nearest ones first."""

MAX_DRIVEN = 10
"""The same maximum for linkages with a driver, which take several times as long to find and to verify."""

UNMEASURED = 1.0
"""Relative gap of a violated constraint without a measure, such as a class of linkage: as large as a whole limit."""

RANK_BY = {"min_transmission_angle": "transmission_angle", "link_length": "size"}
"""Order of designs if a constraint is dropped, so that those close to it come first; by quality for all others."""

APPROACHES = 4
"""Maximum number of bisection steps: they reduce a gap to a sixteenth."""

KNOWN = 0.005
"""Sufficient accuracy of a reachable value, as a share of its limit, or of the task's size for a zone."""

NEAR = 0.05
"""Relative violation of a single constraint up to which it is the only obstacle, so that no other is dropped."""

FEW = 2
"""Maximum number of constraints of which each is dropped in turn in any case."""

REACHABLE: Mapping[str, tuple[str, Callable[[Sequence[float]], float]]] = {
    "min_transmission_angle": ("min_transmission_angle", max),
    "max_link_ratio": ("link_ratio", min),
}
"""Reported measures by constraint, and the function that selects the best value reachable with all others."""

DRIVER_PIVOT_REGION = "driver_pivot_region"
"""Name of the zone of a driver's pivot among the constraints."""

CONSTRAINT_OF: dict[str, str] = {
    "transmission_angle": "min_transmission_angle",
    "grashof": "grashof",
    "full_rotation": "full_rotation",
    "shortest_link": "link_length",
    "longest_link": "link_length",
    "link_ratio": "max_link_ratio",
    "fixed_pivot_region": "fixed_pivot_region",
    "moving_pivot_region": "moving_pivot_region",
    "driver_pivot_region": DRIVER_PIVOT_REGION,
} | {name: f"max_{name}" for name in FORCES}
"""Constraint by name of its check; the zone of a driver's pivot counts as one."""

DRIVER_JOINTS = "O6", "C", "D"
"""Joints of a driver dyad, to which the zones of the linkage's pivots do not apply."""

RATIO_ERRORS = {
    "gear_train": ("ratio_error", "relative_error"),
    "planetary_train": ("ratio", "error"),
    "gearbox": ("speeds", "max_error"),
    "layshaft_gearbox": ("ratios", "max_error"),
}
"""Check of the tolerance and the measure that it compares, by kind of gear problem."""


class _Miss(NamedTuple):
    """A design, its failed checks, and the size of the task, by which distances from zones are measured."""

    design: Any
    broken: list[Check]
    size: float = 1.0

    @property
    def distance(self) -> float:
        """Sum of the relative gaps, by which misses are compared."""
        return math.fsum(_relative_gap(check, self.size) for check in self.broken)


class Relaxation(NamedTuple):
    """Result of relaxing a problem: designs that satisfy all constraints after all, or the nearest miss."""

    sound: list[Any]
    nearest_miss: NearestMiss[Any] | None


def relaxation(
    problem: StatedProblem,
    solve: Solve,
    progress: Progress,
    verify: Verify | None = None,
    nearer: Continue | None = None,
    allowance: Allowance | None = None,
) -> Relaxation:
    """Find the nearest miss of a problem for which no design was found.

    Parameters
    ----------
    problem : StatedProblem
        A consistent problem.
    solve : callable
        The solver of its kind, which found no design.
    progress : callable
        Progress callback.
    verify : callable, optional
        Measures a finished mechanism against a problem of the kind.
    nearer : callable, optional
        Continues designs of a looser problem to this one; returns None for problems without continuation.
    allowance : Allowance, optional
        Time budget.

    Returns
    -------
    Relaxation
        Designs that satisfy all constraints although they were found without one. If there are none, the nearest miss,
        or None if no design is found without the constraints either.
    """
    reachable: dict[str, Any] = {}
    purse = Allowance() if allowance is None else allowance
    search, onward = purse.sort(solve), purse.sort(_nothing if nearer is None else nearer)
    sound, misses = _without_room(problem, search, part_of(progress, 0.0, 0.4))
    if not sound and not misses:
        sound, misses = _without_constraints(problem, search, onward, part_of(progress, 0.0, 0.8), reachable)
    if sound:
        return Relaxation(sound, None)
    misses = misses or _without_tolerance(problem, search, part_of(progress, 0.0, 0.8), reachable)
    if not misses:
        sound, misses = _with_shorter_dwells(problem, search, verify, part_of(progress, 0.0, 0.8), reachable)
        if sound:
            return Relaxation(sound, None)
    misses = misses or _failed(problem, search, part_of(progress, 0.8, 1.0))
    progress(1.0, "verified")
    if not misses:
        return Relaxation([], None)
    nearest = min(misses, key=lambda miss: miss.distance)
    gaps = [
        Gap(check=check.name, value=check.value, limit=check.limit, dimension=check.dimension)
        for check in nearest.broken
    ]
    return Relaxation([], NearestMiss(design=nearest.design, gaps=gaps, reachable=Reachable(**reachable)))


def _nothing(_problem: Any, _designs: Sequence[Any], _progress: Progress) -> None:
    """Return None: the continuation of kinds that support none."""


def _without_room(problem: Any, solve: Metered, progress: Progress) -> tuple[list[Any], list[_Miss]]:
    """Solve the problem with a relaxed workspace; return designs that fit into the workspace anyway, and the others.

    More of the workspace is dropped only if dropping less gives no design.
    """
    space = getattr(problem, "space", None)
    if space is None:
        return [], []
    touching = space.model_copy(update={"clearance": 0.0})
    zoned = space.model_copy(update={"box": None, "obstacles": []})
    looser = [touching] if space.obstacles and space.clearance > 0.0 else []
    looser += [zoned] if space.swept and zoned.demanding else []
    sound: list[Any] = []
    misses: list[_Miss] = []
    for n, less in enumerate([*looser, None]):
        update = {"space": less, "include_failed": False, "max_designs": _most(problem)}
        span = part_of(progress, n / (len(looser) + 1), (n + 1) / (len(looser) + 1))
        found = solve(problem.model_copy(update=update), span).designs
        judged = [judged_by_room(problem, design) for design in map(_without_room_checks, found)]
        verdicts = [design for design in judged if design is not None]
        broken = [[check for check in design.verification.checks if not check.passed] for design in verdicts]
        sound = [design for design, lacks in zip(verdicts, broken, strict=True) if not lacks]
        size = _size_of(problem)
        misses = [_Miss(design, lacks, size) for design, lacks in zip(verdicts, broken, strict=True) if lacks]
        if sound or misses:
            break
    return sound, misses


def _without_room_checks(design: Any) -> Any:
    """Remove the workspace checks of a design, so that it can be checked against another workspace."""
    checks = [check for check in design.verification.checks if check.name not in ROOM]
    return design.model_copy(update={"verification": Verification.of(checks)})


def _without_constraints(
    problem: Any, solve: Metered, nearer: Metered, progress: Progress, reachable: dict[str, float]
) -> tuple[list[Any], list[_Miss]]:
    """Solve the problem without one of its constraints, or without all if that gives no design.

    Return the designs that satisfy all constraints anyway, and those that do not. ``reachable`` is filled.
    """
    stated = _stated(problem)
    free: list[_Miss] = []
    if len(stated) > FEW:
        # With many constraints drop only those one by one that the best design without any of them violates.
        relaxed = _relaxed(problem, stated, solve, progress)
        if relaxed.sound or not relaxed.misses:
            return relaxed.sound, []
        free = relaxed.misses
        stated = _constraints_of(min(free, key=lambda miss: miss.distance))
    misses: list[_Miss] = []
    exhaustive = searched = True
    for n, name in enumerate(stated):
        if n and not (solve.fits and all(miss.distance > NEAR for miss in misses)):
            break
        span = part_of(progress, n / (len(stated) + 1), (n + 1) / (len(stated) + 1))
        relaxed = _relaxed(problem, [name], solve, span)
        if relaxed.sound:
            return relaxed.sound, []
        exhaustive &= relaxed.complete
        continued = _approached(problem, relaxed.misses, nearer, nearer)
        searched = searched and continued is None
        reached = continued or []
        if reached and not reached[0].broken:
            return [miss.design for miss in reached], []
        misses += [*relaxed.misses, *reached]
        if name in REACHABLE and relaxed.designs:
            measure, best = REACHABLE[name]
            designs = [*relaxed.designs, *(miss.design for miss in reached)]
            reachable[name] = best([getattr(design.metrics, measure) for design in designs])
    if not misses and not free and len(stated) > 1:
        relaxed = _relaxed(problem, stated, solve, progress)
        return relaxed.sound, relaxed.misses
    if searched and not exhaustive:  # if all designs are known, none is nearer
        reached = _approached(problem, misses, lambda eased, _, told: solve(eased, told).designs, solve) or []
        if reached and not reached[0].broken:
            return [miss.design for miss in reached], []
        for miss in reached:
            name = CONSTRAINT_OF[miss.broken[0].name]
            if name in REACHABLE:
                measure, best = REACHABLE[name]
                reachable[name] = best([reachable[name], getattr(miss.design.metrics, measure)])
        misses += reached
    return [], misses or free


def _without_tolerance(problem: Any, solve: Metered, progress: Progress, reachable: dict[str, float]) -> list[_Miss]:
    """Find the most accurate gears if none are within the tolerance."""
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
    problem: Any, solve: Metered, verify: Verify | None, progress: Progress, reachable: dict[str, Any]
) -> tuple[list[Any], list[_Miss]]:
    """Find the longest possible dwell by bisection if no design has the required one.

    Return designs that satisfy all constraints anyway, and those that do not. ``reachable`` is filled.
    """
    if problem.kind != "dwell" or verify is None:
        return [], []
    reached, unreached = 0.0, 1.0
    misses: list[_Miss] = []
    for n in range(APPROACHES):
        if misses and not solve.fits:
            break
        tried = 0.5 * (reached + unreached)
        update = {"include_failed": False, "max_designs": _most(problem)}
        span = part_of(progress, n / APPROACHES, (n + 1) / APPROACHES)
        shorter = problem.shortened(tried)
        found = solve(shorter.model_copy(update=update), span).designs
        if not found:
            unreached = tried
            continue
        reached = tried
        if shorter.dwells is None:
            reachable["dwell_angle"] = shorter.dwell_angle
        else:
            reachable["dwell_angles"] = [dwell.angle for dwell in shorter.dwells]
        verified = [design for one in found if (design := verify(problem, one.mechanism)) is not None]
        sound = [design for design in verified if design.verification.passed]
        if sound:
            return sound, []
        misses = [_Miss(one, [check for check in one.verification.checks if not check.passed]) for one in verified]
    return [], misses


def _failed(problem: StatedProblem, solve: Metered, progress: Progress) -> list[_Miss]:
    """Return the designs that were driven and fail a check."""
    asked = problem.model_copy(update={"include_failed": True, "max_designs": _most(problem)})
    return [
        _Miss(design, [check for check in design.verification.checks if not check.passed])
        for design in solve(asked, progress).designs
    ]


def _stated(problem: StatedProblem) -> list[str]:
    """Return the constraints beyond a sound motion that differ from their defaults."""
    constraints = getattr(problem, "constraints", None)
    if not isinstance(constraints, Constraints):
        return []
    plain = type(constraints)()
    stated = [
        name
        for name in Constraints.model_fields
        if name not in ("same_branch", "in_order") and getattr(constraints, name) != getattr(plain, name)
    ]
    return stated if _zone_of_driver(problem) is None else [*stated, DRIVER_PIVOT_REGION]


def _zone_of_driver(problem: Any) -> Region | None:
    """Return the zone of a driver's pivot, if one is given."""
    return problem.driver.pivot_region if _driven(problem) else None


def _without(problem: Any, names: Sequence[str]) -> dict[str, Any]:
    """Return the changed fields of a problem without these constraints."""
    plain = type(problem.constraints)()
    left_out = {name: getattr(plain, name) for name in names if name != DRIVER_PIVOT_REGION}
    fields: dict[str, Any] = {"constraints": problem.constraints.model_copy(update=left_out)}
    if DRIVER_PIVOT_REGION in names:
        fields["driver_dyad"] = problem.driver.model_copy(update={"pivot_region": None})
    return fields


class _Relaxed(NamedTuple):
    """Designs of a problem without some of its constraints."""

    designs: list[Any]
    sound: list[Any]
    misses: list[_Miss]
    complete: bool


def _relaxed(problem: Any, left_out: Sequence[str], solve: Metered, progress: Progress) -> _Relaxed:
    """Solve the task without these constraints."""
    rank_by = RANK_BY.get(left_out[0], "quality") if len(left_out) == 1 else problem.rank_by
    update = _without(problem, left_out) | {"rank_by": rank_by, "include_failed": False, "max_designs": _most(problem)}
    result = solve(problem.model_copy(update=update), progress)
    verdicts = [judged(problem, design) for design in result.designs]
    sound = [verdict.design for verdict in verdicts if verdict.design.verification.passed]
    return _Relaxed(result.designs, sound, [verdict for verdict in verdicts if verdict.broken], result.search.complete)


def _constraints_of(miss: _Miss) -> list[str]:
    """Return the constraints that a design violates, in the order of their declaration."""
    broken = {CONSTRAINT_OF[check.name] for check in miss.broken}
    return [name for name in (*Constraints.model_fields, DRIVER_PIVOT_REGION) if name in broken]


def _approached(problem: Any, misses: Sequence[_Miss], further: Continue, spent: Metered) -> list[_Miss] | None:
    """Bring the nearest miss of one limit closer to it, as long as designs are found and another step fits the budget.

    Designs that violate nothing are returned, best first, if any are found. None if there is no such miss, or if
    ``further`` does not support the problem.
    """
    single = sorted((miss for miss in misses if len(miss.broken) == 1), key=lambda miss: miss.distance)
    if not single or single[0].broken[0].value is None or single[0].broken[0].limit is None:
        return None
    check = single[0].broken[0]
    at_hand = [miss for miss in single if miss.broken[0].name == check.name]
    reached, unreached = float(check.value or 0.0), float(check.limit or 0.0)
    for step in range(APPROACHES):
        tried = 0.5 * (reached + unreached)
        eased = _eased(problem, check.name, tried)
        near = abs(reached - unreached) <= KNOWN * _unit(check, at_hand[0].size)
        if eased is None or near or not spent.fits:
            break
        update = eased | {"include_failed": False, "max_designs": _most(problem)}
        found = further(problem.model_copy(update=update), [miss.design for miss in at_hand], _silent)
        if found is None and not step:
            return None
        verdicts = [judged(problem, design) for design in found or ()]
        nearer = [miss for miss in verdicts if len(miss.broken) <= 1 and miss.distance < at_hand[0].distance]
        if nearer:
            at_hand = sorted(nearer, key=lambda miss: miss.distance)
            if not at_hand[0].broken:
                return [miss for miss in at_hand if not miss.broken]
            reached = at_hand[0].broken[0].value or 0.0
        else:
            unreached = tried
    return at_hand[:1]


def _silent(_fraction: float, _message: str) -> None:
    pass


def _eased(problem: Any, check: str, limit: float) -> dict[str, Any] | None:
    """Return the changed fields of a problem with another limit for a check; None if the check has no limit."""
    constraints: Constraints = problem.constraints
    lengths = constraints.link_length
    update: dict[str, Any]
    match check:
        case "transmission_angle":
            update = {"min_transmission_angle": limit}
        case "link_ratio":
            update = {"max_link_ratio": limit}
        case "shortest_link" if lengths is not None:
            update = {"link_length": lengths.model_copy(update={"min": limit})}
        case "longest_link" if lengths is not None:
            update = {"link_length": lengths.model_copy(update={"max": limit})}
        case "fixed_pivot_region" | "moving_pivot_region":
            update = {check: getattr(constraints, check).widened(limit)}
        case name if name in FORCES:
            update = {f"max_{name}": limit}
        case "driver_pivot_region":
            wider = problem.driver.pivot_region.widened(limit)
            return {"driver_dyad": problem.driver.model_copy(update={"pivot_region": wider})}
        case _:
            return None
    return {"constraints": constraints.model_copy(update=update)}


def judged(problem: Any, design: Any) -> _Miss:
    """Check a design of a relaxed problem against the original constraints, measured on the answer."""
    joints, ground = design.mechanism.skeleton.joints, _ground(design)
    apart = {"P", *(DRIVER_JOINTS if _driven(problem) else ())}
    fixed = [complex(*joints[name]) for name in ground if name not in apart]
    moving = [complex(*place) for name, place in joints.items() if name not in {*ground, *apart}]
    measures: dict[str, Any] = {name: getattr(design.metrics, name, None) for name in Measures._fields}
    measures["lengths"] = link_lengths(design.mechanism)
    stated = problem.constraints.model_copy(update={"same_branch": False, "in_order": False})
    judged = constraint_checks(stated, Measures(**measures), fixed, moving)
    zone = _zone_of_driver(problem)
    if zone is not None:
        judged.append(within_zone("driver_pivot_region", zone, [complex(*joints["O6"])]))
    names = {check.name for check in judged}
    checks = [check for check in design.verification.checks if check.name not in names] + judged
    verified = design.model_copy(update={"verification": Verification.of(checks)})
    if problem.constraints.of_forces:
        verified = with_force_checks(problem.constraints, with_forces(problem, verified))
        judged += [check for check in verified.verification.checks if check.name in problem.constraints.of_forces]
    return _Miss(verified, [check for check in judged if not check.passed], _size_of(problem))


def _ground(design: Any) -> list[str]:
    return next(link.joints for link in design.mechanism.skeleton.links if link.name == "ground")


def _relative_gap(check: Check, size: float) -> float:
    """Return a gap as a share of its unit of measure."""
    if check.value is None or check.limit is None:
        return UNMEASURED
    return abs(check.value - check.limit) / _unit(check, size)


def _unit(check: Check, size: float) -> float:
    """Return the unit of a gap: its limit, or the size of the task if the limit is 0, as for zones."""
    return abs(check.limit or 0.0) or (size if check.dimension == LENGTH else 1.0)


def _size_of(problem: Any) -> float:
    """Return the size of a task in length units; for a task without size, that of its zones."""
    size = getattr(problem, "task_size", None)
    if size is not None:
        return float(size)
    zones = problem.constraints.fixed_pivot_region, problem.constraints.moving_pivot_region
    spans = [math.hypot(zone.x[1] - zone.x[0], zone.y[1] - zone.y[0]) for zone in zones if zone is not None]
    return max(spans, default=0.0) or 1.0


def _driven(problem: Any) -> bool:
    """Return whether a driver dyad is requested."""
    return getattr(problem, "driver", None) is not None


def _most(problem: Any) -> int:
    """Return the maximum number of designs of a relaxed problem."""
    return MAX_DRIVEN if _driven(problem) else MAX_DESIGNS
