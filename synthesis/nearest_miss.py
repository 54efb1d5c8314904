"""Nearest miss of a problem without designs: the design that violates the constraints least, and reachable values.

The workspace is relaxed first: the clearance before box and obstacles, and these before the zones of pivots, so that
the nearest design avoids as many obstacles as possible and has its pivots in their zones. Then the constraints are
dropped one after another, and the problem is solved again. The value of the dropped quantity in those designs is the
value that can be reached while all other constraints hold. If that gives no design, all constraints are dropped
together.

A single limit that cannot be reached is then approached by bisection between the reached and the required value: by
continuation from known designs if the kind supports it, otherwise by a whole search. A design found without a
constraint that nevertheless satisfies it is a regular answer. Kinds that declare a ``ratio_check`` (gears) are solved
without their tolerance, and kinds that declare an ``easing`` (dwells) with an easier task. All other problems have
their nearest miss among the designs that were driven and failed.

:mod:`synthesis.results.time_budget` limits the time of the whole search. If the time is up, the best miss found so far
is reported.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

from kinematics.message import compose
from synthesis.model.answer import AnyNearestMiss, AnyResult, Check, Gap, Reachable, Verification
from synthesis.model.dimension import LENGTH
from synthesis.model.json_object import JsonObject
from synthesis.model.kind import AnyKind, Progress, RatioCheck, scale_progress
from synthesis.model.linkage.problem import FORCE_NAMES, Constraints, LinkageProblem, Region
from synthesis.model.problem import ProblemBase
from synthesis.model.protocols import DrivenDesign, HasTolerance, VerifiedDesign
from synthesis.results.forces import check_forces
from synthesis.results.time_budget import MeteredSearch, SearchBudget
from synthesis.verification.constraints import check_constraints, check_zone
from synthesis.verification.measures import Measures, list_link_lengths
from synthesis.verification.shared_constraints import check_workspace_of_design
from synthesis.verification.workspace import WORKSPACE_CHECKS

Design = TypeVar("Design", bound=VerifiedDesign)

Solve = MeteredSearch[[ProblemBase, Progress], AnyResult]
"""The solver of a kind, within the time budget."""

Continuation = MeteredSearch[[ProblemBase, Sequence[DrivenDesign], Progress], Sequence[DrivenDesign] | None]
"""The continuation of a kind (:attr:`synthesis.model.kind.Kind.nearer`), within the time budget."""

Continue = Callable[[LinkageProblem, Sequence[DrivenDesign], Progress], Sequence[DrivenDesign] | None]
"""Callable that finds designs nearer to a stricter limit from known designs.

It returns None if it does not support the problem.
"""

MAX_DESIGNS = 20
"""Maximum number of designs of each relaxed problem, the likely nearest ones first."""

MAX_DRIVEN = 10
"""The same maximum for linkages with a driver, which take several times as long to find and to verify."""

UNMEASURED_GAP = 1.0
"""Relative gap of a violated constraint without a measure, such as a class of linkage: as large as the whole limit."""

RANK_BY = {"min_transmission_angle": "transmission_angle", "link_length": "size"}
"""Value of ``rank_by`` by dropped constraint, so that designs close to its limit come first; otherwise quality."""

MAX_APPROACHES = 4
"""Maximum number of bisection steps: they reduce a gap to a sixteenth."""

LIMIT_ACCURACY = 0.005
"""Sufficient accuracy of a reachable value, as a share of its limit, or of the task's size for a zone."""

NEAR_GAP = 0.05
"""Relative violation of a dropped constraint up to which no other constraint is dropped: it is the only obstacle."""

MAX_SINGLE_CONSTRAINTS = 2
"""Maximum number of constraints up to which each one is dropped in turn.

With more constraints, only those are dropped that the best unconstrained design violates.
"""

REACHABLE_MEASURES: Mapping[str, tuple[Callable[[DrivenDesign], float], Callable[[Sequence[float]], float]]] = {
    "min_transmission_angle": (lambda design: design.metrics.min_transmission_angle, max),
    "max_link_ratio": (lambda design: design.metrics.link_ratio, min),
}
"""Reported measure by constraint, and the function that selects the best of several reached values."""

DRIVER_PIVOT_REGION = "driver_pivot_region"
"""Name of the zone of a driver's pivot among the constraints."""

CHECKED_CONSTRAINTS: dict[str, str] = {
    "transmission_angle": "min_transmission_angle",
    "grashof": "grashof",
    "full_rotation": "full_rotation",
    "shortest_link": "link_length",
    "longest_link": "link_length",
    "link_ratio": "max_link_ratio",
    "fixed_pivot_region": "fixed_pivot_region",
    "moving_pivot_region": "moving_pivot_region",
    "driver_pivot_region": DRIVER_PIVOT_REGION,
} | {name: f"max_{name}" for name in FORCE_NAMES}
"""Constraint by the name of its check; the zone of a driver's pivot counts as a constraint."""

DRIVER_JOINTS = "O6", "C", "D"
"""Joints of a driver dyad, to which the zones of the linkage's pivots do not apply."""


class _Miss(NamedTuple, Generic[Design]):
    """A design, its failed checks, and the size of the task, to which distances from zones are related."""

    design: Design
    broken: list[Check]
    size: float = 1.0

    @property
    def distance(self) -> float:
        """Sum of the relative gaps, by which misses are compared."""
        return math.fsum(_compute_relative_gap(check, self.size) for check in self.broken)


class Relaxation(NamedTuple):
    """Result of relaxing a problem: designs that satisfy all constraints after all, or the nearest miss."""

    sound: Sequence[VerifiedDesign]
    nearest_miss: AnyNearestMiss | None


def find_nearest_miss(
    problem: ProblemBase, kind: AnyKind, progress: Progress, allowance: SearchBudget | None = None
) -> Relaxation:
    """Find the nearest miss of a problem for which no design was found.

    Parameters
    ----------
    problem : ProblemBase
        A consistent problem.
    kind : Kind
        Its kind, whose solver found no design. It declares the strategies by which the task can be relaxed.
    progress : callable
        Progress callback.
    allowance : SearchBudget, optional
        Time budget.

    Returns
    -------
    Relaxation
        Designs that satisfy all constraints although they were found without one. If there are none, the nearest miss,
        or None if no design is found without the constraints either.
    """
    reachable: JsonObject = {}
    purse = SearchBudget() if allowance is None else allowance
    search: Solve = purse.meter_search(kind.solve)
    onward: Continuation = purse.meter_search(_continue_nothing if kind.nearer is None else kind.nearer)
    sound: Sequence[VerifiedDesign] = []
    misses: Sequence[_Miss[Any]] = []
    # From the least to the most drastic relaxation; the first that gives designs ends the search.
    if isinstance(problem, LinkageProblem):
        sound, misses = _relax_workspace(problem, search, scale_progress(progress, 0.0, 0.4))
        if not sound and not misses:
            sound, misses = _relax_constraints(problem, search, onward, scale_progress(progress, 0.0, 0.8), reachable)
    if sound:
        return Relaxation(sound, None)
    span = scale_progress(progress, 0.0, 0.8)
    misses = misses or _relax_tolerance(problem, kind.ratio_check, search, span, reachable)
    if not misses:
        sound, misses = _ease_task(problem, kind, search, span, reachable)
        if sound:
            return Relaxation(sound, None)
    misses = misses or _list_failed(problem, search, scale_progress(progress, 0.8, 1.0))
    progress(1.0, compose("results-verified"))
    if not misses:
        return Relaxation([], None)
    nearest = _sort_misses(misses)[0]
    gaps = [Gap.from_check(check) for check in nearest.broken]
    return Relaxation([], AnyNearestMiss(design=nearest.design, gaps=gaps, reachable=Reachable(**reachable)))


def _sort_misses(misses: Iterable[_Miss[Design]]) -> list[_Miss[Design]]:
    """Return the misses, the smallest sum of relative gaps first."""
    return sorted(misses, key=lambda miss: miss.distance)


def _continue_nothing(_problem: ProblemBase, _designs: Sequence[DrivenDesign], _progress: Progress) -> None:
    """Return None, as the continuation of a kind that supports none."""


def _relax_workspace(
    problem: LinkageProblem, solve: Solve, progress: Progress
) -> tuple[list[DrivenDesign], list[_Miss[DrivenDesign]]]:
    """Solve the problem with a relaxed workspace.

    Return the designs that fit into the workspace anyway, and those that do not. More of the workspace is dropped only
    if dropping less gives no design.
    """
    space = problem.space
    if space is None:
        return [], []
    touching = space.model_copy(update={"clearance": 0.0})
    zoned = space.model_copy(update={"box": None, "obstacles": []})
    looser = [touching] if space.obstacles and space.clearance > 0.0 else []
    # Without zones the next step would drop the whole workspace, so skip this one.
    looser += [zoned] if space.has_swept_constraints and zoned.has_constraints else []
    sound: list[DrivenDesign] = []
    misses: list[_Miss[DrivenDesign]] = []
    # The last step drops the workspace altogether.
    for n, less in enumerate([*looser, None]):
        update = {"space": less, "include_failed": False, "max_designs": _limit_designs(problem)}
        span = scale_progress(progress, n / (len(looser) + 1), (n + 1) / (len(looser) + 1))
        found = solve(problem.model_copy(update=update), span).designs
        judged = [check_workspace_of_design(problem, design) for design in map(_drop_workspace_checks, found)]
        verdicts = [design for design in judged if design is not None]
        sound = [design for design in verdicts if not design.verification.failures]
        size = _measure_task(problem)
        misses = [_Miss(design, lacks, size) for design in verdicts if (lacks := design.verification.failures)]
        if sound or misses:
            break
    return sound, misses


def _drop_workspace_checks(design: DrivenDesign) -> DrivenDesign:
    """Remove the workspace checks of a design, so that it can be checked against another workspace."""
    checks = [check for check in design.verification.checks if check.name not in WORKSPACE_CHECKS]
    return design.model_copy(update={"verification": Verification.from_checks(checks)})


def _relax_constraints(
    problem: LinkageProblem, solve: Solve, nearer: Continuation, progress: Progress, reachable: JsonObject
) -> tuple[list[DrivenDesign], list[_Miss[DrivenDesign]]]:
    """Solve the problem without one of its constraints, or without all of them if that gives no design.

    Return the designs that satisfy all constraints anyway, and those that do not. The reached values are stored in
    ``reachable``.
    """
    stated = _list_constraints(problem)
    free: list[_Miss[DrivenDesign]] = []
    if len(stated) > MAX_SINGLE_CONSTRAINTS:
        # With many constraints, drop one by one only those that the best unconstrained design violates.
        relaxed = _solve_relaxed(problem, stated, solve, progress)
        if relaxed.sound or not relaxed.misses:
            return relaxed.sound, []
        free = relaxed.misses
        stated = _list_broken_constraints(_sort_misses(free)[0])
    misses: list[_Miss[DrivenDesign]] = []
    exhaustive = searched = True
    for n, name in enumerate(stated):
        # After the first, continue only while no design is near and another search fits the budget.
        if n and not (solve.fits and all(miss.distance > NEAR_GAP for miss in misses)):
            break
        span = scale_progress(progress, n / (len(stated) + 1), (n + 1) / (len(stated) + 1))
        relaxed = _solve_relaxed(problem, [name], solve, span)
        if relaxed.sound:
            # A design found without the limit may satisfy it by chance.
            return relaxed.sound, []
        exhaustive &= relaxed.complete
        # Continuation from known designs is faster than a new search, if the kind supports it.
        continued = _approach_limit(problem, relaxed.misses, nearer, nearer)
        searched = searched and continued is None
        reached = continued or []
        if reached and not reached[0].broken:
            return [miss.design for miss in reached], []
        misses += [*relaxed.misses, *reached]
        if name in REACHABLE_MEASURES and relaxed.designs:
            measure, best = REACHABLE_MEASURES[name]
            designs = [*relaxed.designs, *(miss.design for miss in reached)]
            reachable[name] = best([measure(design) for design in designs])
    # No single constraint is the obstacle: drop all of them together.
    if not misses and not free and len(stated) > 1:
        relaxed = _solve_relaxed(problem, stated, solve, progress)
        return relaxed.sound, relaxed.misses
    if searched and not exhaustive:  # if all designs are known, none is nearer
        reached = _approach_limit(problem, misses, lambda eased, _, told: solve(eased, told).designs, solve) or []
        if reached and not reached[0].broken:
            return [miss.design for miss in reached], []
        for miss in reached:
            name = CHECKED_CONSTRAINTS[miss.broken[0].name]
            if name in REACHABLE_MEASURES:
                measure, best = REACHABLE_MEASURES[name]
                # The best value reached counts, whether by dropping or by approaching the limit.
                reachable[name] = best([reachable[name], measure(miss.design)])
        misses += reached
    return [], misses or free


def _relax_tolerance(
    problem: ProblemBase, ratio: RatioCheck | None, solve: Solve, progress: Progress, reachable: JsonObject
) -> list[_Miss[VerifiedDesign]]:
    """Find the most accurate gears, if none are within the tolerance; store their error in ``reachable``."""
    if ratio is None or not isinstance(problem, HasTolerance) or problem.tolerance is None:
        return []
    update = {"tolerance": None, "rank_by": "error", "include_failed": False, "max_designs": 1}
    misses = []
    for design in solve(problem.model_copy(update=update), progress).designs:
        error = abs(float(getattr(design.metrics, ratio.metric)))
        # The exact check of the tolerance is done by the kind; here a float comparison suffices to skip it.
        if error <= problem.tolerance:
            continue
        broken = Check(name=ratio.check, passed=False, value=error, limit=problem.tolerance)
        others = [check for check in design.verification.checks if check.name != ratio.check]
        verification = Verification.from_checks([*others, broken])
        misses.append(_Miss(design.model_copy(update={"verification": verification}), [broken]))
        reachable["tolerance"] = error
    return misses


def _ease_task(
    problem: ProblemBase, kind: AnyKind, solve: Solve, progress: Progress, reachable: JsonObject
) -> tuple[list[VerifiedDesign], list[_Miss[VerifiedDesign]]]:
    """Find the largest possible share of the task by bisection, for kinds whose task can be eased.

    Return the designs that satisfy all constraints anyway, and those that do not. The share reached is stored in
    ``reachable``.
    """
    if kind.easing is None or kind.verify is None:
        return [], []
    reached, unreached = 0.0, 1.0
    misses: list[_Miss[VerifiedDesign]] = []
    # Bisect the share of the task.
    for n in range(MAX_APPROACHES):
        if misses and not solve.fits:
            break
        tried = 0.5 * (reached + unreached)
        update = {"include_failed": False, "max_designs": _limit_designs(problem)}
        span = scale_progress(progress, n / MAX_APPROACHES, (n + 1) / MAX_APPROACHES)
        eased = kind.easing.ease(problem, tried)
        found = solve(eased.model_copy(update=update), span).designs
        # Not even this share has a design, so it is an upper bound.
        if not found:
            unreached = tried
            continue
        reached = tried
        reachable.update(kind.easing.list_reached(eased))
        verified: list[VerifiedDesign] = [
            design for one in found if (design := kind.verify(problem, one.mechanism)) is not None
        ]
        sound = [design for design in verified if design.verification.passed]
        if sound:
            return sound, []
        misses = [_Miss(design, design.verification.failures) for design in verified]
    return [], misses


def _list_failed(problem: ProblemBase, solve: Solve, progress: Progress) -> list[_Miss[VerifiedDesign]]:
    """Return the designs that were driven and fail a check."""
    asked = problem.model_copy(update={"include_failed": True, "max_designs": _limit_designs(problem)})
    return [_Miss(design, design.verification.failures) for design in solve(asked, progress).designs]


def _list_constraints(problem: LinkageProblem) -> list[str]:
    """Return the names of constraints that differ from their defaults, except those of a sound motion."""
    constraints = problem.constraints
    plain = type(constraints)()
    stated = [
        name
        for name in Constraints.model_fields
        # Branch and order are never relaxed, because a design without a sound motion is useless.
        if name not in ("same_branch", "in_order") and getattr(constraints, name) != getattr(plain, name)
    ]
    return stated if _get_driver_zone(problem) is None else [*stated, DRIVER_PIVOT_REGION]


def _get_driver_zone(problem: LinkageProblem) -> Region | None:
    """Return the zone of a driver's pivot, if one is given."""
    return None if problem.driver is None else problem.driver.pivot_region


def _drop_constraints(problem: LinkageProblem, names: Sequence[str]) -> dict[str, object]:
    """Return the fields of a problem that change if these constraints are dropped."""
    plain = type(problem.constraints)()
    left_out = {name: getattr(plain, name) for name in names if name != DRIVER_PIVOT_REGION}
    fields: dict[str, object] = {"constraints": problem.constraints.model_copy(update=left_out)}
    if DRIVER_PIVOT_REGION in names and problem.driver is not None:
        fields["driver_dyad"] = problem.driver.model_copy(update={"pivot_region": None})
    return fields


class _RelaxedResult(NamedTuple):
    """Result of a problem without some of its constraints.

    Attributes
    ----------
    designs : list
        All designs, as solved.
    sound : list
        Designs that satisfy all constraints anyway.
    misses : list
        Designs that violate some constraint.
    complete : bool
        Whether the search found every solution.
    """

    designs: list[DrivenDesign]
    sound: list[DrivenDesign]
    misses: list[_Miss[DrivenDesign]]
    complete: bool


def _solve_relaxed(
    problem: LinkageProblem, left_out: Sequence[str], solve: Solve, progress: Progress
) -> _RelaxedResult:
    """Solve the task without these constraints."""
    # Order by the dropped quantity, so that designs close to its limit come first.
    rank_by = RANK_BY.get(left_out[0], "quality") if len(left_out) == 1 else problem.rank_by
    update = _drop_constraints(problem, left_out) | {
        "rank_by": rank_by,
        "include_failed": False,
        "max_designs": _limit_designs(problem),
    }
    result = solve(problem.model_copy(update=update), progress)
    verdicts = [check_constraints_of_design(problem, design) for design in result.designs]
    sound = [verdict.design for verdict in verdicts if verdict.design.verification.passed]
    return _RelaxedResult(
        result.designs, sound, [verdict for verdict in verdicts if verdict.broken], result.search.complete
    )


def _list_broken_constraints(miss: _Miss[DrivenDesign]) -> list[str]:
    """Return the constraints that a design violates, in the order of their declaration."""
    broken = {CHECKED_CONSTRAINTS[check.name] for check in miss.broken}
    return [name for name in (*Constraints.model_fields, DRIVER_PIVOT_REGION) if name in broken]


def _approach_limit(
    problem: LinkageProblem, misses: Sequence[_Miss[DrivenDesign]], further: Continue, spent: Solve | Continuation
) -> list[_Miss[DrivenDesign]] | None:
    """Bring the design that misses only one limit closer to it, while designs are found and the budget permits.

    Return the designs that satisfy all constraints, best first, if any are found; otherwise the nearest miss. Return
    None if no design misses only one limit, or if ``further`` does not support the problem.
    """
    # A design that violates several limits would need a search in several directions.
    single = _sort_misses(miss for miss in misses if len(miss.broken) == 1)
    # A class of linkage has no value to approach.
    if not single or single[0].broken[0].value is None or single[0].broken[0].limit is None:
        return None
    check = single[0].broken[0]
    at_hand = [miss for miss in single if miss.broken[0].name == check.name]
    reached, unreached = float(check.value or 0.0), float(check.limit or 0.0)
    for step in range(MAX_APPROACHES):
        tried = 0.5 * (reached + unreached)
        eased = _replace_limit(problem, check.name, tried)
        # Closer than this is not worth another search.
        near = abs(reached - unreached) <= LIMIT_ACCURACY * _choose_unit(check, at_hand[0].size)
        if eased is None or near or not spent.fits:
            break
        update = eased | {"include_failed": False, "max_designs": _limit_designs(problem)}
        found = further(problem.model_copy(update=update), [miss.design for miss in at_hand], _ignore_progress)
        # None at the first step means that the kind cannot continue; later it means no design.
        if found is None and not step:
            return None
        verdicts = [check_constraints_of_design(problem, design) for design in found or ()]
        # Accept only designs that improve on the nearest so far and violate no other limit.
        nearer = [miss for miss in verdicts if len(miss.broken) <= 1 and miss.distance < at_hand[0].distance]
        if nearer:
            at_hand = _sort_misses(nearer)
            if not at_hand[0].broken:
                return [miss for miss in at_hand if not miss.broken]
            reached = at_hand[0].broken[0].value or 0.0
        else:
            unreached = tried
    return at_hand[:1]


def _ignore_progress(_fraction: float, _message: str) -> None:
    pass


def _replace_limit(problem: LinkageProblem, check: str, limit: float) -> dict[str, object] | None:
    """Return the fields of a problem that change if a check gets another limit; None if it cannot have one."""
    constraints: Constraints = problem.constraints
    lengths = constraints.link_length
    update: dict[str, object]
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
            # A zone is approached from outside: widen it by the tried distance.
            update = {check: getattr(constraints, check).widen(limit)}
        case name if name in FORCE_NAMES:
            update = {f"max_{name}": limit}
        case "driver_pivot_region" if problem.driver is not None and problem.driver.pivot_region is not None:
            wider = problem.driver.pivot_region.widen(limit)
            return {"driver_dyad": problem.driver.model_copy(update={"pivot_region": wider})}
        case _:
            return None
    return {"constraints": constraints.model_copy(update=update)}


def check_constraints_of_design(problem: LinkageProblem, design: DrivenDesign) -> _Miss[DrivenDesign]:
    """Check a design of a relaxed problem against the original constraints, by the measured values of its answer."""
    joints, ground = design.mechanism.skeleton.joints, _list_ground_joints(design)
    # P and the driver's joints are not subject to the zones of the linkage's pivots.
    apart = {"P", *(() if problem.driver is None else DRIVER_JOINTS)}
    fixed = [complex(*joints[name]) for name in ground if name not in apart]
    moving = [complex(*place) for name, place in joints.items() if name not in {*ground, *apart}]
    measures = Measures.from_metrics(design.metrics, list_link_lengths(design.mechanism))
    # The motion itself has been verified already, in the kind's own checks.
    stated = problem.constraints.model_copy(update={"same_branch": False, "in_order": False})
    judged = check_constraints(stated, measures, fixed, moving)
    zone = _get_driver_zone(problem)
    if zone is not None:
        judged.append(check_zone("driver_pivot_region", zone, [complex(*joints["O6"])]))
    names = {check.name for check in judged}
    # Replace the checks of the relaxed constraints by those of the original ones.
    checks = [check for check in design.verification.checks if check.name not in names] + judged
    verified = design.model_copy(update={"verification": Verification.from_checks(checks)})
    if problem.constraints.force_limits:
        verified = check_forces(problem, verified)
        judged += [check for check in verified.verification.checks if check.name in problem.constraints.force_limits]
    return _Miss(verified, [check for check in judged if not check.passed], _measure_task(problem))


def _list_ground_joints(design: DrivenDesign) -> list[str]:
    return next(link.joints for link in design.mechanism.skeleton.links if link.name == "ground")


def _compute_relative_gap(check: Check, size: float) -> float:
    """Return the gap of a failed check, relative to its limit or to the size of the task."""
    # A failed check without numbers counts as a whole limit.
    if check.value is None or check.limit is None:
        return UNMEASURED_GAP
    return abs(check.value - check.limit) / _choose_unit(check, size)


def _choose_unit(check: Check, size: float) -> float:
    """Return the value to which a gap is related: its limit, or the size of the task if that is 0, as for zones."""
    return abs(check.limit or 0.0) or (size if check.dimension == LENGTH else 1.0)


def _measure_task(problem: LinkageProblem) -> float:
    """Return the size of a task in length units; for a task without size, the size of its zones, or 1."""
    # Functions, for example, have no size, but may have zones.
    if problem.task_size is not None:
        return problem.task_size
    zones = problem.constraints.fixed_pivot_region, problem.constraints.moving_pivot_region
    spans = [math.hypot(zone.x[1] - zone.x[0], zone.y[1] - zone.y[0]) for zone in zones if zone is not None]
    return max(spans, default=0.0) or 1.0


def _limit_designs(problem: ProblemBase) -> int:
    """Return the maximum number of designs of a relaxed problem."""
    return MAX_DRIVEN if isinstance(problem, LinkageProblem) and problem.driver is not None else MAX_DESIGNS
