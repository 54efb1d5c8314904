"""Fit fourbars to points by least squares: any number of points, with prescribed or free timing, within limits.

A population of random starts descends in rounds, and only the best go on from one round to the next. The best distinct
ones are perturbed and descend again, and are then led to minima that satisfy the client's limits up to rounding. The
Grashof class holds by the choice of unknowns (:mod:`synthesis.fit.chart`), and multipliers enforce the limits
(:mod:`synthesis.fit.demands`): neither is a penalty.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.fit.chart import CRANK_ROCKER, DOUBLE_CRANK, DOUBLE_ROCKER, FOURBAR, POINT, UNKNOWNS, from_lengths
from synthesis.fit.demands import FAMILY, SIGN
from synthesis.kinds.path.curve_families import joints_of
from synthesis.kinds.path.curve_limits import all_broken
from synthesis.kinds.path.held import held
from synthesis.kinds.path.limits import SETTING, Usable, limits_of, room_of, setting_of, zoned
from synthesis.kinds.path.point_rows import path_rows
from synthesis.kinds.path.point_starts import (
    CLASS_MARGIN,
    COUPLER,
    DRAWS,
    FAR_DYAD,
    OUTPUT,
    SAME,
    along,
    free_starts,
    kicked,
    reassign,
    timed_starts,
)
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.room_starts import RoomStarts, bounded, room_starts
from synthesis.kinds.path.verification import verify_path
from synthesis.model.kind import Progress
from synthesis.model.linkage_answer import FourbarMechanism
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.numerics.levenberg import descend_each
from synthesis.numerics.portions import in_portions
from synthesis.numerics.status import Status
from synthesis.outcome.ranking import distinct

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Whole = NDArray[np.int64]

PORTION = 16
"""Number of starts that a thread takes at a time: some milliseconds of work."""

TIMED_STARTS, FREE_STARTS, STARTS_OF_MANY = 6000, 1800, 1300
"""Number of random starts, over all classes and assemblies: with prescribed timing, for which a start has four random
numbers; with free timing, for which it has more; and with free timing and more than :data:`MAX_FEW` points, which take
longer."""

MAX_FEW = 18
"""Maximum number of points for :data:`FREE_STARTS`."""

IN_ROOM = 300
"""Number of additional starts of a family with their pivots in the zones of a workspace."""

TIMED_SHARE = 0.15
"""Share of the starts with prescribed timing, those with the best linear fit, that descends."""

THINNING = ((1.0, 8, 1e-3), (0.25, 20, 1e-4), (0.06, 80, 1e-6))
"""Rounds of descents: share of the starts that goes on, number of steps, and tolerance."""

KICKS, KICKED, COPIES, KICK = 3, 24, 6, 0.5
"""Perturbation of the best: number of rounds, of linkages, of copies of each, and the standard deviation of the change
in the logarithms of lengths."""

SAME_COST = 1e-4
"""Relative difference below which costs belong to the same minimum."""

FLIP_KICK = 0.1
"""That standard deviation for linkages with a flipped dyad."""

SPREAD = 0.8
"""Standard deviation of the logarithm of a perturbation's standard deviation: some are small and some are large."""

KICK_THINNING = ((1.0, 10, 1e-3), (0.25, 60, 1e-6))
"""As :data:`THINNING`, after a perturbation."""

MAX_FINALISTS = 24
"""Maximum number of minima that are refined within the limits and verified."""

RETURNS, AGAIN = 1, 10
"""Perturbation of minima within the limits: number of rounds, and maximum number of results that are refined."""

KEPT = 1e-9
"""Violation of a workspace, in task sizes, that counts as none."""

MANY, OF_MANY = 100, 6
"""Number of points above which refinement takes longer, and the maximum number of minima then refined and verified."""

MAX_EXPLORED = 48
"""Maximum number of points in the descents of the population: denser targets are thinned evenly."""

SOFT_WEIGHT = 10.0
"""Weight of limits, in task units, in the descents of the population."""

SAME_FIT = 1e-2
"""Linkages whose joints agree to this share of the task's size are one answer; the nearest is kept."""

_FAMILIES = {
    "double_crank": DOUBLE_CRANK,
    "crank_rocker": CRANK_ROCKER,
    "double_rocker": DOUBLE_ROCKER,
    "non_grashof": FOURBAR,
}


class PointTask(NamedTuple):
    """Points in task coordinates: rows (x, y, crank angle in radians, weight); the origin's place, the unit's length.

    If points have tolerances, a weight is the inverse of one, scaled to 1 for the smallest. ``room`` is the packed
    workspace (:mod:`synthesis.fit.room`).
    """

    rows: Real
    origin: complex
    size: float
    room: Real


class Candidate(NamedTuple):
    """A linkage during the search: unknowns, state (crank angles first), half the sum of squares, status of its last
    descent, its setting, and the crank's direction."""

    x: Real
    state: Real
    cost: float
    status: Status
    setting: Real
    way: int


def point_task(problem: PathProblem) -> PointTask:
    """Return the points about their centroid, with the task's size as the unit."""
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
    return PointTask(rows, origin, size, room_of(problem, origin, size))


def families(problem: PathProblem) -> list[int]:
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
        task = point_task(problem)
        setting = setting_of(problem, task.origin, task.size, sign=1.0, family=CRANK_ROCKER)
        population = _descended(problem, task.rows, setting, 300, np.random.default_rng(0))
        _kicked(problem, (population, population), task.rows, setting, np.random.default_rng(0))
        for x, state in zip(population.starts, population.states, strict=True):
            mechanism = mechanism_of(Candidate(x, state, 0.0, Status.STEP_LIMIT, setting, 1), task)
            if mechanism is not None:
                verify_path(problem, mechanism)
    begun = FourbarConfiguration(0j, 0.4 + 0.3j, 2.0 + 1.5j, 2.0 + 0j, 1.0 + 1.5j)
    nearly = PathProblem.model_validate({"kind": "path", "method": "least_squares", "points": points})
    descended_from(begun, nearly, point_task(nearly))
    roomy = PathProblem.model_validate({"kind": "path", "points": points, "space": {"box": [[-3, -3], [3, 3]]}})
    task, rng = point_task(roomy), np.random.default_rng(0)
    room_starts(roomy, task.rows[:, 0] + 1j * task.rows[:, 1], task.origin, task.size, CRANK_ROCKER, rng, 4, 64)


def fitted(
    problem: PathProblem,
    task: PointTask,
    rng: np.random.Generator,
    progress: Progress,
    *,
    finalists: int = MAX_FINALISTS,
    usable: Usable | None = None,
) -> list[Candidate]:
    """Find minima within the limits, nearest first: at most ``finalists``, within additional limits if ``usable`` is
    given."""
    thinned = _thinned(task)
    # Free timing finds the direction of the crank by itself.
    ways = (1, -1) if problem.prescribed and problem.crank_direction == "either" else (1,)
    cases = [(way, family, sign) for way in ways for family in families(problem) for sign in (1.0, -1.0)]
    settings = [
        zoned(setting_of(problem, task.origin, task.size, sign=sign, family=family, usable=usable))
        for _, family, sign in cases
    ]
    drawn: dict[int, RoomStarts] = {}
    if bounded(problem) and not problem.prescribed:
        points = thinned.rows[:, 0] + 1j * thinned.rows[:, 1]
        for family in families(problem):
            drawn[family] = room_starts(problem, points, task.origin, task.size, family, rng, IN_ROOM)
    populations = []
    for n, ((way, _, _), setting) in enumerate(zip(cases, settings, strict=True)):
        progress(0.4 * n / len(cases), f"class {n + 1} of {len(cases)}: fitting from random starts")
        own = drawn.get(int(setting[FAMILY]))
        populations.append(_descended(problem, _directed(thinned.rows, way), setting, len(cases), rng, own))
    for kick in range(KICKS):
        progress(0.4 + 0.2 * kick / KICKS, "perturbing the best fits")
        bases = [_different(_best(population, 4 * KICKED), KICKED) for population in populations]
        for n, (way, _, sign) in enumerate(cases):
            # Cases alternate in the assembly, so that the neighbour is the same case with the other assembly.
            pair = bases[n], bases[n + 1 if sign > 0.0 else n - 1]
            rows = _directed(thinned.rows, way)
            populations[n] = _joined([populations[n], _kicked(problem, pair, rows, settings[n], rng)])
    pool = [
        Candidate(x, state, float(cost), Status(status), setting, way)
        for (way, _, _), setting, population in zip(cases, settings, populations, strict=True)
        for x, state, cost, status in zip(*_different(_best(population, len(population.costs)), finalists), strict=True)
    ]
    pool.sort(key=lambda candidate: candidate.cost)
    most = finalists if len(task.rows) <= MANY else OF_MANY
    minima = _all_held(_distinct(pool, most), task, thinned, lambda share: progress(0.6 + 0.2 * share, "refining fits"))
    for _ in range(RETURNS if thinned is task else 0):
        # A perturbation may leave a minimum on a limit for a better one that no descent within the limits would find.
        again: list[Candidate] = []
        # The minima of this case, and those of the other assembly, which may be flipped into it.
        for n, (way, family, sign) in enumerate(cases):
            progress(0.8 + 0.1 * n / len(cases), "perturbing the best fits")
            held = _population_of(minima, (way, family, sign)), _population_of(minima, (way, family, -sign))
            population = _kicked(problem, held, _directed(thinned.rows, way), settings[n], rng)
            again += [
                Candidate(x, state, float(cost), Status(status), settings[n], way)
                for x, state, cost, status in zip(*_different(_best(population, KICKED), KICKED), strict=True)
            ]
        again.sort(key=lambda candidate: candidate.cost)
        minima += _all_held(_distinct(again, AGAIN), task, thinned, lambda share: progress(0.9, "refining fits"))
    return sorted(minima, key=lambda candidate: candidate.cost)


def descended_from(start: FourbarConfiguration, problem: PathProblem, task: PointTask) -> list[Candidate]:
    """Descend from a given linkage to minima within the limits, nearest first; it is put into the required class first.

    If any class is allowed, the descent may leave that of the start: there is one minimum then.
    """
    thinned, rows = _thinned(task), _thinned(task).rows
    joints = [(joint - task.origin) / task.size for joint in start]
    o2, a, b, o4, p = joints
    lengths = np.abs([o4 - o2, a - o2, b - a, b - o4])
    sign = math.copysign(1.0, ((o4 - a).conjugate() * (b - a)).imag)
    ground, arm = o4 - o2, (p - a) * abs(b - a) / (b - a)
    found = []
    wanted = families(problem)
    for family in [FOURBAR] if FOURBAR in wanted else wanted:
        setting = zoned(setting_of(problem, task.origin, task.size, sign=sign, family=family))
        population = _empty(1, UNKNOWNS[FOURBAR], len(rows), limits_of(setting))
        x, angles = population.starts[0], population.states[0, : len(rows)]
        x[:2], x[2] = (o2.real, o2.imag), math.atan2(ground.imag, ground.real)
        x[POINT:] = arm.real, arm.imag
        angles[:] = float(np.angle((a - o2) / ground))
        # The given linkage cannot be moved into this class.
        if not from_lengths(lengths, family, CLASS_MARGIN, x):
            continue
        population.costs[0] = reassign(x, rows, setting, angles)
        for _, steps, tolerance in THINNING:
            _descend(population, rows, setting, steps, tolerance)
        kept = _best(population, 1)
        found += [Candidate(*row, setting, 1) for row in zip(*kept, strict=True)]
    held = _all_held(found, task, thinned, lambda share: None)
    return sorted(held, key=lambda candidate: candidate.cost)


def _all_held(
    chosen: list[Candidate], task: PointTask, thinned: PointTask, report: Callable[[float], None]
) -> list[Candidate]:
    """Lead candidates to minima within their limits; drop those that fail."""
    minima: list[Candidate | None] = [None] * len(chosen)

    def work(some: slice) -> None:
        minima[some] = [_held(candidate, task, thinned) for candidate in chosen[some]]

    report(0.0)
    in_portions(work, len(chosen), 1)
    return [candidate for candidate in minima if candidate is not None]


def _population_of(minima: list[Candidate], case: tuple[int, int, float]) -> _Population:
    """Return the best distinct candidates of a case: the crank's direction, the family and the assembly."""
    way, family, sign = case
    own = [c for c in minima if c.way == way and c.setting[FAMILY] == family and c.setting[SIGN] == sign]
    own.sort(key=lambda candidate: candidate.cost)
    if not own:
        return _empty(0, UNKNOWNS[FOURBAR], 0, 0)
    population = _Population(*(np.array(column) for column in list(zip(*own, strict=True))[:4]))
    return _different(population, KICKED)


def _thinned(task: PointTask) -> PointTask:
    """Return the task with at most :data:`MAX_EXPLORED` of its points."""
    n = len(task.rows)
    if n <= MAX_EXPLORED:
        return task
    return task._replace(rows=np.ascontiguousarray(task.rows[np.linspace(0, n - 1, MAX_EXPLORED).round().astype(int)]))


def _directed(rows: Real, way: int) -> Real:
    """Return the rows with the signs of the crank angles reversed if ``way`` is negative."""
    return rows if way > 0 else rows * np.array([1.0, 1.0, -1.0, 1.0])


def _descended(
    problem: PathProblem,
    rows: Real,
    setting: Real,
    cases: int,
    rng: np.random.Generator,
    drawn: RoomStarts | None = None,
) -> _Population:
    """Generate and descend the population of one class and assembly, from random starts and from those in a
    workspace."""
    n = len(rows)
    free = FREE_STARTS if n <= MAX_FEW else STARTS_OF_MANY
    count = (TIMED_STARTS if problem.prescribed else free) // cases
    phased = problem.prescribed and problem.crank_phase == "free"
    unknowns = UNKNOWNS[FOURBAR] + phased
    draws = np.concatenate([rng.normal(size=(count, 4)), rng.uniform(-1.0, 1.0, (count, DRAWS - 4))], axis=1)
    population = _empty(count, unknowns, n, limits_of(setting))
    if problem.prescribed:
        timed_starts(draws, rows, setting, unknowns, population.starts, population.costs)
        count = math.ceil(TIMED_SHARE * count)
    else:
        runs = np.zeros((count, n))
        places = along(rows)

        def begin(some: slice) -> None:
            free_starts(draws[some], places, rows, setting, population.starts[some], runs[some], population.costs[some])

        in_portions(begin, count, PORTION)
        # The first n state entries of a start are its crank angles.
        population.states[:, :n] = runs
        if drawn is not None:
            population = _joined([population, _in_room(drawn, n, setting)])
    for share, steps, tolerance in THINNING:
        # Successive halving: most starts are hopeless after a few steps.
        population = _best(population, max(math.ceil(share * count), 1))
        _descend(population, rows, setting, steps, tolerance)
    return population


def _in_room(drawn: RoomStarts, points: int, setting: Real) -> _Population:
    """Return the starts of one assembly that were drawn in a workspace."""
    own = drawn.sign == setting[SIGN]
    population = _empty(int(own.sum()), drawn.x.shape[1], points, limits_of(setting))
    population.starts[:] = drawn.x[own]
    population.states[:, :points] = drawn.theta[own] - drawn.x[own, 2, None]
    return population


def _kicked(
    problem: PathProblem, bases: tuple[_Population, _Population], rows: Real, setting: Real, rng: np.random.Generator
) -> _Population:
    """Descend from perturbed copies of the best of a case, and from flipped copies of the best of its other
    assembly."""
    n, sign = len(rows), float(setting[SIGN])
    parts = []
    for flip, base, its_sign, copies in (
        (SAME, bases[0], sign, COPIES),
        (FAR_DYAD, bases[0], sign, 1),
        (OUTPUT, bases[1], -sign, 1),
        (COUPLER, bases[1], -sign, 1),
    ):
        # Flipping a dyad changes the crank angles, which prescribed timing fixes.
        if not len(base.costs) or (problem.prescribed and flip != SAME):
            continue
        size = len(base.costs) * copies
        part = _empty(size, base.starts.shape[1], n, limits_of(setting))
        runs = np.ascontiguousarray(base.states[:, :n])
        part.states[:, :n] = runs[np.arange(size) % len(runs)]
        reach = (KICK if flip == SAME else FLIP_KICK) * np.exp(SPREAD * rng.normal(size=(size, 1)))
        draws = reach * rng.normal(size=(size, 4))
        kicked(base.starts, part.states, its_sign, flip, draws, rows, setting, part.starts, part.costs)
        parts.append(part)
    near = _joined(parts) if parts else _empty(0, UNKNOWNS[FOURBAR], n, limits_of(setting))
    for share, steps, tolerance in KICK_THINNING:
        near = _best(near, math.ceil(share * len(near.costs)))
        _descend(near, rows, setting, steps, tolerance)
    return near


class _Population(NamedTuple):
    """Starts that descend together: unknowns (k, unknowns), states (k, 3 points + limits), costs (k,), and the status
    of the last descent of each (k,)."""

    starts: Real
    states: Real
    costs: Real
    statuses: Whole


def _empty(count: int, unknowns: int, points: int, limits: int) -> _Population:
    return _Population(
        np.zeros((count, unknowns)),
        np.zeros((count, 3 * points + limits)),
        np.full(count, np.inf),
        np.full(count, Status.STEP_LIMIT, np.int64),
    )


def _joined(populations: list[_Population]) -> _Population:
    return _Population(*(np.concatenate(parts) for parts in zip(*populations, strict=True)))


def _best(population: _Population, count: int) -> _Population:
    """Return copies of the best members with finite costs."""
    kept = np.argsort(population.costs, kind="stable")[:count]
    kept = kept[np.isfinite(population.costs[kept])]
    return _Population._make(column[kept] for column in population)


def _different(population: _Population, count: int) -> _Population:
    """Drop members whose cost equals the previous one's (same minimum); best first."""
    kept = np.flatnonzero(np.diff(population.costs, prepend=-1.0) > SAME_COST * population.costs)[:count]
    return _Population._make(column[kept] for column in population)


def _descend(population: _Population, rows: Real, setting: Real, steps: int, tolerance: float) -> None:
    if not len(population.costs):
        return
    limits = limits_of(setting)
    multipliers = np.zeros(limits + 1)
    # Zero multipliers with a moderate weight: the limits guide the population without stopping it.
    multipliers[limits] = SOFT_WEIGHT
    most = 2 * len(rows) + limits

    def work(some: slice) -> None:
        starts, states = population.starts[some], population.states[some]
        costs, statuses = population.costs[some], population.statuses[some]
        descend_each(path_rows, starts, rows, setting, multipliers, states, most, steps, tolerance, costs, statuses)

    in_portions(work, len(population.costs), PORTION)


def _distinct(pool: list[Candidate], count: int) -> list[Candidate]:
    """Return the best distinct candidates."""
    return [pool[n] for n in distinct([_joints(candidate) for candidate in pool], count, SAME_FIT)]


def _joints(candidate: Candidate) -> Complex:
    """Return O2, A, B, O4 and P at the first point, in task coordinates; NaN beyond a toggle."""
    x, setting = candidate.x, candidate.setting
    theta = float(candidate.state[0] + x[2])
    closes, joints = joints_of(int(setting[FAMILY]), x, float(setting[SIGN]), theta)
    return np.array(joints) if closes else np.full(5, np.nan + 0j)


def _held(candidate: Candidate, task: PointTask, thinned: PointTask) -> Candidate | None:
    """Find the minimum within the limits nearest to a candidate, over all points; None if the limits cannot be met.

    The workspace along the motion is constrained only if the minimum without it violates it.
    """
    n, few = len(task.rows), len(thinned.rows)
    angles = candidate.state[:n]
    if n > few:
        # The thinned points were evenly chosen by index.
        angles = np.interp(np.arange(n), np.linspace(0, n - 1, few).round(), candidate.state[:few])
    found = _held_within(candidate, angles, candidate.setting, task)
    if found is None or not len(task.room):
        return found
    roomy = np.concatenate([candidate.setting[:SETTING], task.room])
    turned = found.state[None, :n] + found.x[2]
    much = all_broken(int(roomy[FAMILY]), found.x[None], turned, roomy[SIGN : SIGN + 1], roomy)[0]
    if much <= KEPT:
        return found
    kept = _held_within(found, found.state[:n], roomy, task)
    # Members of a population that is perturbed need states of equal length: drop the workspace's margins.
    return kept and kept._replace(state=np.concatenate([kept.state[:n], found.state[n:]]))


def _held_within(candidate: Candidate, angles: Real, setting: Real, task: PointTask) -> Candidate | None:
    """Find the minimum within a setting nearest to a candidate, from crank angles at all points."""
    x, n = candidate.x.copy(), len(task.rows)
    state = np.zeros(3 * n + limits_of(setting))
    state[:n] = angles
    status, cost = held(x, _directed(task.rows, candidate.way), setting, state)
    if status in (Status.IMPOSSIBLE, Status.INFEASIBLE) or not math.isfinite(cost):
        return None
    return candidate._replace(x=x, state=state, cost=cost, status=status)


def configuration_of(candidate: Candidate, task: PointTask) -> FourbarConfiguration | None:
    """Return a candidate's joints at the first point, in the problem's coordinates."""
    joints = _joints(candidate)
    if not np.all(np.isfinite(joints)):
        return None
    return FourbarConfiguration(*(complex(z) for z in task.origin + task.size * joints))


def mechanism_of(candidate: Candidate, task: PointTask) -> FourbarMechanism | None:
    """Return a candidate's dimensions in the problem's coordinates."""
    configuration = configuration_of(candidate, task)
    return None if configuration is None else fourbar_mechanism(configuration)
