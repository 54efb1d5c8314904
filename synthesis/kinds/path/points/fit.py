"""Fit fourbars to points by least squares: any number of points, with prescribed or free timing, within limits.

A population of random starts descends in rounds, and only the best go on from one round to the next. The best distinct
ones are perturbed and descend again, and are then refined to minima that satisfy the client's limits up to rounding.
The Grashof class is guaranteed by the choice of unknowns (:mod:`synthesis.fit.chart`), and multipliers enforce the
limits (:mod:`synthesis.fit.constraints`), so that no penalties are used for either.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.fit.chart import CRANK_ROCKER, DOUBLE_CRANK, DOUBLE_ROCKER, FOURBAR, POINT, UNKNOWNS, write_unknowns
from synthesis.fit.constraints import FAMILY_INDEX, SIGN_INDEX
from synthesis.kinds.path.points.population import (
    Population,
    drop_duplicates,
    join_populations,
    make_population,
    select_best,
)
from synthesis.kinds.path.points.starts import (
    CLASS_MARGIN,
    DRAW_SIZE,
    FLIP_COUPLER,
    FLIP_FAR_DYAD,
    FLIP_NONE,
    FLIP_OUTPUT,
    assign_nearest_angles,
    compute_path_shares,
    make_free_starts,
    make_perturbed_starts,
    make_timed_starts,
)
from synthesis.kinds.path.points.workspace_starts import (
    WorkspaceStarts,
    draw_workspace_starts,
    is_workspace_constrained,
)
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.constrained_fit import fit_constrained
from synthesis.kinds.path.residuals.constraint_vector import (
    PATH_SETTING_SIZE,
    UsableLimits,
    count_setting_margins,
    pack_path_workspace,
    pack_setting,
    restrict_to_zones,
)
from synthesis.kinds.path.residuals.curve_constraints import measure_violations
from synthesis.kinds.path.residuals.families import compute_joints
from synthesis.kinds.path.residuals.points import compute_path_rows
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.model.kind import Progress
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.numerics.levenberg import descend_each
from synthesis.numerics.portions import run_in_portions
from synthesis.numerics.status import Status
from synthesis.results.ranking import select_distinct

PORTION_SIZE = 16
"""Number of starts that a thread takes at a time: some milliseconds of work."""

TIMED_START_COUNT, FREE_START_COUNT, DENSE_START_COUNT = 6000, 1800, 1300
"""Number of random starts over all classes and assemblies: with prescribed timing, where a start has four random
numbers; with free timing, where it has more; and with free timing and more than :data:`MAX_SPARSE_POINTS` points, where
a descent takes longer."""

MAX_SPARSE_POINTS = 18
"""Maximum number of points for :data:`FREE_START_COUNT`."""

WORKSPACE_START_COUNT = 300
"""Number of additional starts of a family with their pivots in the zones of a workspace."""

TIMED_DESCENT_SHARE = 0.15
"""Share of the starts with prescribed timing from which a descent is made: those with the best linear fit."""

DESCENT_ROUNDS = ((1.0, 8, 1e-3), (0.25, 20, 1e-4), (0.06, 80, 1e-6))
"""Rounds of descents: share of the starts that takes part, number of steps, and tolerance."""

KICK_ROUNDS, MAX_KICKED, COPY_COUNT, KICK_SIZE = 3, 24, 6, 0.5
"""Perturbation of the best: number of rounds, of linkages, of copies of each, and the standard deviation of the change
in the logarithms of lengths."""

FLIP_KICK_SIZE = 0.1
"""Standard deviation of the same change for linkages with a flipped dyad."""

KICK_SPREAD = 0.8
"""Standard deviation of the logarithm of a perturbation's standard deviation: some are small and some are large."""

KICK_DESCENT_ROUNDS = ((1.0, 10, 1e-3), (0.25, 60, 1e-6))
"""As :data:`DESCENT_ROUNDS`, after a perturbation."""

MAX_FINALISTS = 24
"""Maximum number of minima that are refined within the limits and verified."""

RETURN_ROUNDS, MAX_RETURN_REFINED = 1, 10
"""Perturbation of minima within the limits: number of rounds, and maximum number of results that are refined."""

WORKSPACE_TOLERANCE = 1e-9
"""Maximum violation of a workspace, in task sizes, that counts as rounding."""

MAX_FAST_POINTS, MAX_DENSE_FINALISTS = 100, 6
"""Number of points above which refinement takes longer, and the maximum number of minima then refined and verified."""

MAX_EXPLORED_POINTS = 48
"""Maximum number of points in the descents of the population: denser targets are thinned evenly."""

SOFT_WEIGHT = 10.0
"""Weight of limits, in task units, in the descents of the population."""

FIT_DUPLICATE_TOLERANCE = 1e-2
"""Linkages whose joints agree to this share of the task's size are one answer; the nearest is kept."""

_FAMILIES = {
    "double_crank": DOUBLE_CRANK,
    "crank_rocker": CRANK_ROCKER,
    "double_rocker": DOUBLE_ROCKER,
    "non_grashof": FOURBAR,
}


Case = tuple[int, int, float]
"""Direction of the crank, family, and sign of the assembly."""


class PointTask(NamedTuple):
    """Points in task coordinates, with the origin and the unit of these coordinates.

    The rows are (x, y, crank angle in radians, weight).
    If points have tolerances, a weight is the inverse of one, scaled to 1 for the smallest. ``room`` is the packed
    workspace (:mod:`synthesis.fit.workspace`).
    """

    rows: Real
    origin: complex
    size: float
    room: Real


class Candidate(NamedTuple):
    """A linkage during the search.

    It consists of the unknowns, the state (crank angles first), half the sum of squares, the status of the last
    descent, the setting, and the direction of the crank.
    """

    x: Real
    state: Real
    cost: float
    status: Status
    setting: Real
    way: int


def build_point_task(problem: PathProblem) -> PointTask:
    """Return the points relative to their centroid, with the task's size as the unit."""
    z = np.array([point.point for point in problem.points])
    size = problem.task_size
    origin = complex(z[0] + (z - z[0]).mean())
    unit = ((z - z[0]) - (z - z[0]).mean()) / size
    turns = np.array(problem.crank_turns) if problem.prescribed else np.zeros(len(z))
    # Absolute phases start from the first point's own crank angle.
    if problem.prescribed and problem.crank_phase != "free":
        turns = turns + math.radians(math.remainder(problem.points[0].crank_angle or 0.0, 360.0))
    widths = problem.tolerances
    weights = np.ones(len(z)) if widths is None else widths.min() / widths
    rows = np.ascontiguousarray(np.stack([unit.real, unit.imag, turns, weights], axis=1))
    return PointTask(rows, origin, size, pack_path_workspace(problem, origin, size))


def select_families(problem: PathProblem) -> list[int]:
    """Return the families of fourbars to search."""
    wanted = problem.constraints.grashof
    if wanted != "any":
        return [_FAMILIES[wanted]]
    # Double rockers and triple rockers cannot turn through.
    turning = problem.constraints.full_rotation or problem.closed
    return [CRANK_ROCKER, DOUBLE_CRANK] if turning else [CRANK_ROCKER, DOUBLE_CRANK, FOURBAR]


def warm_up() -> None:
    """Compile or load the kernels with a handful of starts."""
    z = np.exp(1j * np.linspace(0.0, 5.0, 6))
    points = [{"x": float(w.real), "y": float(0.7 * w.imag)} for w in z]
    turning = [{**point, "crank_angle": 30.0 * k} for k, point in enumerate(points)]
    for stated in ({"points": points}, {"points": turning, "timing": "prescribed"}):
        problem = PathProblem.model_validate({"kind": "path", "method": "least_squares", **stated})
        task = build_point_task(problem)
        setting = pack_setting(problem, task.origin, task.size, sign=1.0, family=CRANK_ROCKER)
        population = _descend_population(problem, task.rows, setting, 300, np.random.default_rng(0))
        _perturb_population(problem, (population, population), task.rows, setting, np.random.default_rng(0))
        for x, state in zip(population.starts, population.states, strict=True):
            mechanism = build_mechanism(Candidate(x, state, 0.0, Status.STEP_LIMIT, setting, 1), task)
            if mechanism is not None:
                verify_path(problem, mechanism)
    begun = FourbarConfiguration(0j, 0.4 + 0.3j, 2.0 + 1.5j, 2.0 + 0j, 1.0 + 1.5j)
    nearly = PathProblem.model_validate({"kind": "path", "method": "least_squares", "points": points})
    descend_from(begun, nearly, build_point_task(nearly))
    roomy = PathProblem.model_validate({"kind": "path", "points": points, "space": {"box": [[-3, -3], [3, 3]]}})
    task, rng = build_point_task(roomy), np.random.default_rng(0)
    draw_workspace_starts(
        roomy, task.rows[:, 0] + 1j * task.rows[:, 1], task.origin, task.size, CRANK_ROCKER, rng, 4, 64
    )


def find_minima(
    problem: PathProblem,
    task: PointTask,
    rng: np.random.Generator,
    progress: Progress,
    *,
    finalists: int = MAX_FINALISTS,
    usable: UsableLimits | None = None,
) -> list[Candidate]:
    """Find at most ``finalists`` minima within the limits, nearest first.

    The limits of ``usable``, if given, apply in addition.
    """
    thinned = _reduce_points(task)
    # Free timing finds the direction of the crank by itself.
    ways = (1, -1) if problem.prescribed and problem.crank_direction == "either" else (1,)
    cases = [(way, family, sign) for way in ways for family in select_families(problem) for sign in (1.0, -1.0)]
    settings = [
        restrict_to_zones(pack_setting(problem, task.origin, task.size, sign=sign, family=family, usable=usable))
        for _, family, sign in cases
    ]
    populations = _search_populations(problem, task, thinned, cases, settings, rng, progress)
    pool = [
        candidate
        for (way, _, _), setting, population in zip(cases, settings, populations, strict=True)
        for candidate in _list_candidates(
            drop_duplicates(select_best(population, len(population.costs)), finalists), setting, way
        )
    ]
    pool.sort(key=lambda candidate: candidate.cost)
    most = finalists if len(task.rows) <= MAX_FAST_POINTS else MAX_DENSE_FINALISTS
    minima = _solve_all_constrained(
        _select_distinct(pool, most),
        task,
        thinned,
        lambda share: progress(0.6 + 0.2 * share, compose("path-refining-fits")),
    )
    for _ in range(RETURN_ROUNDS if thinned is task else 0):
        again = _perturb_minima(problem, minima, thinned, cases, settings, rng, progress)
        minima += _solve_all_constrained(
            _select_distinct(again, MAX_RETURN_REFINED),
            task,
            thinned,
            lambda share: progress(0.9, compose("path-refining-fits")),
        )
    return sorted(minima, key=lambda candidate: candidate.cost)


def _search_populations(
    problem: PathProblem,
    task: PointTask,
    thinned: PointTask,
    cases: list[Case],
    settings: list[Real],
    rng: np.random.Generator,
    progress: Progress,
) -> list[Population]:
    """Descend from random starts in every case, and perturb the best results."""
    drawn: dict[int, WorkspaceStarts] = {}
    if is_workspace_constrained(problem) and not problem.prescribed:
        points = thinned.rows[:, 0] + 1j * thinned.rows[:, 1]
        for family in select_families(problem):
            drawn[family] = draw_workspace_starts(
                problem, points, task.origin, task.size, family, rng, WORKSPACE_START_COUNT
            )
    populations = []
    for n, ((way, _, _), setting) in enumerate(zip(cases, settings, strict=True)):
        progress(0.4 * n / len(cases), compose("path-fitting-class", number=n + 1, count=len(cases)))
        own = drawn.get(int(setting[FAMILY_INDEX]))
        populations.append(_descend_population(problem, _orient_rows(thinned.rows, way), setting, len(cases), rng, own))
    for kick in range(KICK_ROUNDS):
        progress(0.4 + 0.2 * kick / KICK_ROUNDS, compose("path-perturbing-fits"))
        bases = [drop_duplicates(select_best(population, 4 * MAX_KICKED), MAX_KICKED) for population in populations]
        for n, (way, _, sign) in enumerate(cases):
            # Cases alternate in the assembly, so that the neighbour is the same case with the other assembly.
            pair = bases[n], bases[n + 1 if sign > 0.0 else n - 1]
            rows = _orient_rows(thinned.rows, way)
            populations[n] = join_populations(
                [populations[n], _perturb_population(problem, pair, rows, settings[n], rng)]
            )
    return populations


def _perturb_minima(
    problem: PathProblem,
    minima: list[Candidate],
    thinned: PointTask,
    cases: list[Case],
    settings: list[Real],
    rng: np.random.Generator,
    progress: Progress,
) -> list[Candidate]:
    """Perturb minima within the limits, and return the results, nearest first.

    A perturbation may leave a minimum on a limit for a better one that no descent within the limits would find.
    """
    again: list[Candidate] = []
    for n, (way, family, sign) in enumerate(cases):
        progress(0.8 + 0.1 * n / len(cases), compose("path-perturbing-fits"))
        # The minima of this case, and those of the other assembly, which may be flipped into it.
        held = _select_population(minima, (way, family, sign)), _select_population(minima, (way, family, -sign))
        population = _perturb_population(problem, held, _orient_rows(thinned.rows, way), settings[n], rng)
        again += _list_candidates(drop_duplicates(select_best(population, MAX_KICKED), MAX_KICKED), settings[n], way)
    again.sort(key=lambda candidate: candidate.cost)
    return again


def _list_candidates(population: Population, setting: Real, way: int) -> list[Candidate]:
    return [
        Candidate(x, state, float(cost), Status(status), setting, way)
        for x, state, cost, status in zip(*population, strict=True)
    ]


def descend_from(start: FourbarConfiguration, problem: PathProblem, task: PointTask) -> list[Candidate]:
    """Descend from a given linkage to minima within the limits, nearest first.

    The linkage is first moved into the required class. If any class is permitted, the descent may leave that of the
    start, and there is only one minimum.
    """
    thinned, rows = _reduce_points(task), _reduce_points(task).rows
    joints = [(joint - task.origin) / task.size for joint in start]
    o2, a, b, o4, p = joints
    lengths = np.abs([o4 - o2, a - o2, b - a, b - o4])
    sign = math.copysign(1.0, ((o4 - a).conjugate() * (b - a)).imag)
    ground, arm = o4 - o2, (p - a) * abs(b - a) / (b - a)
    found = []
    wanted = select_families(problem)
    for family in [FOURBAR] if FOURBAR in wanted else wanted:
        setting = restrict_to_zones(pack_setting(problem, task.origin, task.size, sign=sign, family=family))
        population = make_population(1, UNKNOWNS[FOURBAR], len(rows), count_setting_margins(setting))
        x, angles = population.starts[0], population.states[0, : len(rows)]
        x[:2], x[2] = (o2.real, o2.imag), math.atan2(ground.imag, ground.real)
        x[POINT:] = arm.real, arm.imag
        angles[:] = float(np.angle((a - o2) / ground))
        # The given linkage cannot be moved into this class.
        if not write_unknowns(lengths, family, CLASS_MARGIN, x):
            continue
        population.costs[0] = assign_nearest_angles(x, rows, setting, angles)
        for _, steps, tolerance in DESCENT_ROUNDS:
            _descend(population, rows, setting, steps, tolerance)
        kept = select_best(population, 1)
        found += [Candidate(*row, setting, 1) for row in zip(*kept, strict=True)]
    held = _solve_all_constrained(found, task, thinned, lambda share: None)
    return sorted(held, key=lambda candidate: candidate.cost)


def _solve_all_constrained(
    chosen: list[Candidate], task: PointTask, thinned: PointTask, report: Callable[[float], None]
) -> list[Candidate]:
    """Refine candidates to minima within their limits; drop those that fail."""
    minima: list[Candidate | None] = [None] * len(chosen)

    def process_portion(some: slice) -> None:
        minima[some] = [_solve_constrained(candidate, task, thinned) for candidate in chosen[some]]

    report(0.0)
    run_in_portions(process_portion, len(chosen), 1)
    return [candidate for candidate in minima if candidate is not None]


def _select_population(minima: list[Candidate], case: Case) -> Population:
    """Return the best distinct candidates of a case: the crank's direction, the family and the assembly."""
    way, family, sign = case
    own = [c for c in minima if c.way == way and c.setting[FAMILY_INDEX] == family and c.setting[SIGN_INDEX] == sign]
    own.sort(key=lambda candidate: candidate.cost)
    if not own:
        return make_population(0, UNKNOWNS[FOURBAR], 0, 0)
    population = Population(*(np.array(column) for column in list(zip(*own, strict=True))[:4]))
    return drop_duplicates(population, MAX_KICKED)


def _reduce_points(task: PointTask) -> PointTask:
    """Return the task with at most :data:`MAX_EXPLORED_POINTS` of its points."""
    n = len(task.rows)
    if n <= MAX_EXPLORED_POINTS:
        return task
    return task._replace(
        rows=np.ascontiguousarray(task.rows[np.linspace(0, n - 1, MAX_EXPLORED_POINTS).round().astype(int)])
    )


def _orient_rows(rows: Real, way: int) -> Real:
    """Return the rows with the signs of the crank angles reversed if ``way`` is negative."""
    return rows if way > 0 else rows * np.array([1.0, 1.0, -1.0, 1.0])


def _descend_population(
    problem: PathProblem,
    rows: Real,
    setting: Real,
    cases: int,
    rng: np.random.Generator,
    drawn: WorkspaceStarts | None = None,
) -> Population:
    """Generate the population of one class and assembly, and descend from it.

    The starts are random ones and, if ``drawn`` is given, those drawn in a workspace.
    """
    n = len(rows)
    free = FREE_START_COUNT if n <= MAX_SPARSE_POINTS else DENSE_START_COUNT
    count = (TIMED_START_COUNT if problem.prescribed else free) // cases
    phased = problem.prescribed and problem.crank_phase == "free"
    unknowns = UNKNOWNS[FOURBAR] + phased
    draws = np.concatenate([rng.normal(size=(count, 4)), rng.uniform(-1.0, 1.0, (count, DRAW_SIZE - 4))], axis=1)
    population = make_population(count, unknowns, n, count_setting_margins(setting))
    if problem.prescribed:
        make_timed_starts(draws, rows, setting, unknowns, population.starts, population.costs)
        count = math.ceil(TIMED_DESCENT_SHARE * count)
    else:
        runs = np.zeros((count, n))
        places = compute_path_shares(rows)

        def make_starts(some: slice) -> None:
            make_free_starts(
                draws[some], places, rows, setting, population.starts[some], runs[some], population.costs[some]
            )

        run_in_portions(make_starts, count, PORTION_SIZE)
        # The first n state entries of a start are its crank angles.
        population.states[:, :n] = runs
        if drawn is not None:
            population = join_populations([population, _select_workspace_starts(drawn, n, setting)])
    for share, steps, tolerance in DESCENT_ROUNDS:
        # Successive halving: most starts are hopeless after a few steps.
        population = select_best(population, max(math.ceil(share * count), 1))
        _descend(population, rows, setting, steps, tolerance)
    return population


def _select_workspace_starts(drawn: WorkspaceStarts, points: int, setting: Real) -> Population:
    """Return the starts of one assembly that were drawn in a workspace."""
    own = drawn.sign == setting[SIGN_INDEX]
    population = make_population(int(own.sum()), drawn.x.shape[1], points, count_setting_margins(setting))
    population.starts[:] = drawn.x[own]
    population.states[:, :points] = drawn.theta[own] - drawn.x[own, 2, None]
    return population


def _perturb_population(
    problem: PathProblem, bases: tuple[Population, Population], rows: Real, setting: Real, rng: np.random.Generator
) -> Population:
    """Descend from perturbed copies of the best members of a case.

    Flipped copies of the best members of the same case with the other assembly are added.
    """
    n, sign = len(rows), float(setting[SIGN_INDEX])
    parts = []
    for flip, base, its_sign, copies in (
        (FLIP_NONE, bases[0], sign, COPY_COUNT),
        (FLIP_FAR_DYAD, bases[0], sign, 1),
        (FLIP_OUTPUT, bases[1], -sign, 1),
        (FLIP_COUPLER, bases[1], -sign, 1),
    ):
        # Flipping a dyad changes the crank angles, which prescribed timing fixes.
        if not len(base.costs) or (problem.prescribed and flip != FLIP_NONE):
            continue
        size = len(base.costs) * copies
        part = make_population(size, base.starts.shape[1], n, count_setting_margins(setting))
        runs = np.ascontiguousarray(base.states[:, :n])
        part.states[:, :n] = runs[np.arange(size) % len(runs)]
        reach = (KICK_SIZE if flip == FLIP_NONE else FLIP_KICK_SIZE) * np.exp(KICK_SPREAD * rng.normal(size=(size, 1)))
        draws = reach * rng.normal(size=(size, 4))
        make_perturbed_starts(base.starts, part.states, its_sign, flip, draws, rows, setting, part.starts, part.costs)
        parts.append(part)
    near = (
        join_populations(parts) if parts else make_population(0, UNKNOWNS[FOURBAR], n, count_setting_margins(setting))
    )
    for share, steps, tolerance in KICK_DESCENT_ROUNDS:
        near = select_best(near, math.ceil(share * len(near.costs)))
        _descend(near, rows, setting, steps, tolerance)
    return near


def _descend(population: Population, rows: Real, setting: Real, steps: int, tolerance: float) -> None:
    if not len(population.costs):
        return
    limits = count_setting_margins(setting)
    multipliers = np.zeros(limits + 1)
    # Zero multipliers with a moderate weight: the limits guide the population without stopping it.
    multipliers[limits] = SOFT_WEIGHT
    most = 2 * len(rows) + limits

    def process_portion(some: slice) -> None:
        starts, states = population.starts[some], population.states[some]
        costs, statuses = population.costs[some], population.statuses[some]
        descend_each(
            compute_path_rows, starts, rows, setting, multipliers, states, most, steps, tolerance, costs, statuses
        )

    run_in_portions(process_portion, len(population.costs), PORTION_SIZE)


def _select_distinct(pool: list[Candidate], count: int) -> list[Candidate]:
    """Return the best distinct candidates."""
    return [
        pool[n]
        for n in select_distinct([_locate_joints(candidate) for candidate in pool], count, FIT_DUPLICATE_TOLERANCE)
    ]


def _locate_joints(candidate: Candidate) -> Complex:
    """Return O2, A, B, O4 and P at the first point, in task coordinates; NaN beyond a toggle."""
    x, setting = candidate.x, candidate.setting
    theta = float(candidate.state[0] + x[2])
    closes, joints = compute_joints(int(setting[FAMILY_INDEX]), x, float(setting[SIGN_INDEX]), theta)
    return np.array(joints) if closes else np.full(5, np.nan + 0j)


def _solve_constrained(candidate: Candidate, task: PointTask, thinned: PointTask) -> Candidate | None:
    """Find the minimum within the limits nearest to a candidate, over all points; None if the limits cannot be met.

    The workspace along the motion is constrained only if the minimum without it violates it.
    """
    n, few = len(task.rows), len(thinned.rows)
    angles = candidate.state[:n]
    if n > few:
        # The thinned points were evenly chosen by index.
        angles = np.interp(np.arange(n), np.linspace(0, n - 1, few).round(), candidate.state[:few])
    found = _solve_within_setting(candidate, angles, candidate.setting, task)
    if found is None or not len(task.room):
        return found
    roomy = np.concatenate([candidate.setting[:PATH_SETTING_SIZE], task.room])
    turned = found.state[None, :n] + found.x[2]
    much = measure_violations(
        int(roomy[FAMILY_INDEX]), found.x[None], turned, roomy[SIGN_INDEX : SIGN_INDEX + 1], roomy
    )[0]
    if much <= WORKSPACE_TOLERANCE:
        return found
    kept = _solve_within_setting(found, found.state[:n], roomy, task)
    # Members of a population that is perturbed need states of equal length: drop the workspace's margins.
    return kept and kept._replace(state=np.concatenate([kept.state[:n], found.state[n:]]))


def _solve_within_setting(candidate: Candidate, angles: Real, setting: Real, task: PointTask) -> Candidate | None:
    """Find the minimum within a setting nearest to a candidate, from crank angles at all points."""
    x, n = candidate.x.copy(), len(task.rows)
    state = np.zeros(3 * n + count_setting_margins(setting))
    state[:n] = angles
    status, cost = fit_constrained(x, _orient_rows(task.rows, candidate.way), setting, state)
    if status in (Status.IMPOSSIBLE, Status.INFEASIBLE) or not math.isfinite(cost):
        return None
    return candidate._replace(x=x, state=state, cost=cost, status=status)


def build_configuration(candidate: Candidate, task: PointTask) -> FourbarConfiguration | None:
    """Return a candidate's joints at the first point, in the problem's coordinates."""
    joints = _locate_joints(candidate)
    if not np.all(np.isfinite(joints)):
        return None
    return FourbarConfiguration(*(complex(z) for z in task.origin + task.size * joints))


def build_mechanism(candidate: Candidate, task: PointTask) -> FourbarMechanism | None:
    """Return a candidate's dimensions in the problem's coordinates."""
    configuration = build_configuration(candidate, task)
    return None if configuration is None else build_fourbar(configuration)
