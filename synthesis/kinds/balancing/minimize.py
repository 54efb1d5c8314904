"""Counterweights for the least of what counts, with a bound that no weights can go below.

The program is solved on a few positions of a dense grid; positions at which the answer exceeds the level that it was
promised are added (cutting planes), until nothing is exceeded that matters. All of it is linear algebra on the
:mod:`effects`: no mechanism is driven again before the proof.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.analyses.driven import Task, placed
from synthesis.kinds.balancing.driven import moving, pivot
from synthesis.kinds.balancing.effects import PARAMETERS, Linear, quantities
from synthesis.kinds.balancing.force_balance import Weight
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.program import Answer, Level, Limits, best_weights

Real = NDArray[np.float64]

GRID = 2880
"""Positions of the motion on which peaks and means are taken."""

FIRST, MOST_ADDED = 72, 6
"""Positions of the grid that the program begins with, and peaks beyond its level that are added for each quantity."""

ROUNDS = 10
"""Programs that are solved at most."""

CLOSE = 1e-4
"""Share of the value by which the grid may exceed the program when nothing more is added."""

KEPT = 1e-6
"""Share of a cap by which the grid may exceed it, some of the solver's tolerances."""

SENSITIVE = 10.0
"""How many times the share by which a cap is exceeded the value may lie below the bound, which is of weights that keep
the cap; the bound is lowered by it."""

TOLERANCE = 1e-7
"""Share of the dual value, and of the sum of the weights of the objective, that the solver's tolerance may be off: the
bound is the less by it."""

NOTHING = 1e-9
"""Mass as a share of the linkage's, below which a weight is left out; effect of a parameter that counts as none."""

UNCHANGED = 1e-12
"""Peak of a quantity as a share of its changes, below which it is zero without weights: nothing is a share of it."""


class Setting(NamedTuple):
    """The program of a task: its quantities in units of what they are without weights, and the units of parameters."""

    links: list[str]
    levels: list[Level]
    limits: Limits
    units: Real
    grid: Real


class Minimum(NamedTuple):
    """The weights, the bound, and the positions of the last program by quantity; ``violated`` caps where there is none.

    A violated cap comes with the share by which it would have to be raised.
    """

    weights: list[Weight]
    bound: float
    parameters: Real
    used: dict[str, list[int]]
    violated: dict[str, float]
    solved: bool


class NothingToReduce(ValueError):
    """A quantity that counts and is zero without weights."""


class Undetermined(ValueError):
    """What counts or has a cap is known at no position: redundant constraints leave forces in joints open."""


def setting_of(problem: BalancingProblem, task: Task) -> Setting:
    """Quantities over the grid, and the limits of the weights.

    Raises
    ------
    NothingToReduce
        Where a quantity that counts is zero.
    Undetermined
        Where the quantities are known at no position.
    """
    machine, stated = task.machine, problem.counterweights
    scale, mechanism = machine.scale, machine.mechanism
    links = stated.links or moving(mechanism)
    count = max(GRID, problem.motion.steps)
    grid = task.positions(count)
    now = placed(machine, grid, task.speed, task.acceleration)
    counted = {**problem.objective.joint_forces, **problem.caps.joint_forces}
    found = quantities(machine, now, links, list(counted))
    known = np.isfinite(np.concatenate([part.fixed[None] for parts in found.values() for part in parts])).all(axis=0)
    if not known.any():
        raise Undetermined
    mass = sum(float(part.mass) for part in machine.bodies.values()) + sum(map(float, machine.pin_masses.values()))
    places = np.array([scale * complex(z) for z in mechanism.joints.values()])
    size = float(np.abs(places[:, None] - places).max())
    units = np.tile([mass, mass * size, mass * size, mass * size**2], len(links))
    levels = []
    for name, weight, cap in _counted(problem):
        mean = problem.objective.norm == "rms"
        scaled = [Linear(part.fixed[known], units[:, None] * part.by[:, known]) for part in found[name]]
        for of_mean, own_weight, own_cap in (
            (False, 0.0 if mean else weight, cap),
            (True, weight if mean else 0.0, None),
        ):
            if own_weight == 0.0 and own_cap is None:
                continue
            bare = Level(name, scaled, own_weight, own_cap, of_mean)
            unbalanced = float(bare.reached(np.zeros(len(units))))
            largest = max(float(np.abs(part.by).max()) for part in scaled)
            if not unbalanced > UNCHANGED * largest:
                raise NothingToReduce(name.replace("_", " "))
            values = [Linear(part.fixed / unbalanced, part.by / unbalanced) for part in scaled]
            levels.append(replace(bare, values=values))
    return Setting(links, levels, _limits(problem, task, links, levels, mass, size), units, grid[known])


def _counted(problem: BalancingProblem) -> list[tuple[str, float, float | None]]:
    """Quantities with their weights and caps."""
    objective, caps = problem.objective, problem.caps
    listed: list[tuple[str, float, float | None]] = [
        (name, getattr(objective, name), getattr(caps, name)) for name in ("shaking_force", "shaking_moment", "drive")
    ]
    for joint in {**objective.joint_forces, **caps.joint_forces}:
        listed.append((f"joint {joint}", objective.joint_forces.get(joint, 0.0), caps.joint_forces.get(joint)))
    return [(name, weight, cap) for name, weight, cap in listed if weight > 0.0 or cap is not None]


def _limits(
    problem: BalancingProblem, task: Task, links: list[str], levels: list[Level], mass: float, size: float
) -> Limits:
    stated, scale, count = problem.counterweights, task.machine.scale, len(links)
    most = math.inf if stated.max_mass is None else stated.max_mass
    disc = math.inf
    if stated.density is not None and stated.thickness is not None:
        areal = stated.density * scale * stated.thickness
        # J of a disc is μ²/(2πρt): in units of mass and size.
        disc = 2.0 * math.pi * areal * size**2 / mass
        if stated.max_disc_radius is not None:
            most = min(most, math.pi * areal * (scale * stated.max_disc_radius) ** 2)
    reach = 1.0 if stated.reach is None else scale * stated.reach / size
    gyration = math.inf if stated.max_gyration is None else scale * stated.max_gyration / size
    reach = min(reach, gyration)  # no weight is nearer to its joint, by its gyration, than its centre
    counts = np.zeros(PARAMETERS * count)
    for level in levels:
        for part in level.values:
            counts = np.maximum(counts, np.abs(part.by).max(axis=1))
    matters = counts > NOTHING
    return Limits(
        np.full(count, most / mass),
        np.full(count, reach),
        np.full(count, disc),
        np.full(count, gyration),
        math.inf if stated.total_mass is None else stated.total_mass / mass,
        matters[3::PARAMETERS],
        matters[0::PARAMETERS],
    )


def minimum(setting: Setting, task: Task) -> Minimum:
    """The best weights of a setting."""
    levels, count = setting.levels, len(setting.grid)
    used = {level.name: np.unique(np.linspace(0, count - 1, FIRST).astype(int)).tolist() for level in levels}
    weighed = sum(level.weight for level in levels)
    bound, best, least = 0.0, None, math.inf
    for _ in range(ROUNDS):
        found = best_weights(levels, setting.limits, used, relaxed=False)
        if found.solution.status == "infeasible":
            return _violated(setting, used)
        if found.solution.status != "solved":
            break
        dual = found.solution.dual
        bound = max(bound, dual - TOLERANCE * (abs(dual) + weighed))
        parameters = _lightest(setting, found.parameters)
        reached = [level.of(parameters) for level in levels]
        value = sum(level.weight * float(of.max()) for level, of in zip(levels, reached, strict=True))
        beyond = max(
            (float(of.max()) / level.cap - 1.0 for level, of in zip(levels, reached, strict=True) if level.cap),
            default=0.0,
        )
        if beyond <= KEPT and value < least:
            best, least = parameters, value
        if beyond <= KEPT and value - bound <= CLOSE * max(value, NOTHING * weighed):
            break
        if not _add(levels, reached, found, used):
            break
    if best is None:
        return Minimum([], bound, np.zeros(len(setting.units)), used, {}, solved=False)
    if bound <= least * (1.0 + SENSITIVE * KEPT):
        bound = min(bound, least)
    return Minimum(_weights(setting, task, best), bound, best, used, {}, solved=True)


def _add(levels: list[Level], reached: list[Real], found: Answer, used: dict[str, list[int]]) -> bool:
    """Add the positions of the highest peaks beyond the level that the program has promised."""
    grown = False
    for level, of, promised in zip(levels, reached, found.levels.tolist(), strict=True):
        if level.mean:
            continue
        most = promised * (1.0 + 0.1 * CLOSE)
        if level.cap is not None:
            most = min(most, level.cap * (1.0 + 0.01 * KEPT))
        peaks = np.flatnonzero((of >= np.roll(of, 1)) & (of >= np.roll(of, -1)) & (of > most))
        for at in peaks[np.argsort(-of[peaks])][:MOST_ADDED].tolist():
            if at not in used[level.name]:
                used[level.name].append(at)
                grown = True
    return grown


def _violated(setting: Setting, used: dict[str, list[int]]) -> Minimum:
    """Which caps cannot be kept: those that stand at the least share by which all would have to be raised."""
    found = best_weights(setting.levels, setting.limits, used, relaxed=True)
    share = found.excess
    caps = {}
    for level in setting.levels:
        if level.cap is not None and float(level.reached(found.parameters)) >= level.cap * (1.0 + 0.9 * share):
            caps[level.name] = share
    return Minimum([], 0.0, found.parameters, used, caps, solved=False)


def _lightest(setting: Setting, parameters: Real) -> Real:
    """The parameters well inside the set, which the solver keeps to a tolerance; no mass that has no effect.

    Where the mass of a weight does not count and its inertia neither, it is the least for its first moment.
    """
    limits, inside = setting.limits, parameters.copy()
    for n in range(len(setting.links)):
        mass, first, inertia = _of(inside, n)
        mass, moment = min(max(mass, 0.0), float(limits.mass[n])), float(np.hypot(*first))
        if moment > mass * limits.reach[n]:
            first = first * (mass * limits.reach[n] / moment)
            moment = mass * limits.reach[n]
        if not limits.carried[n] and not limits.turns(n):
            mass = moment / limits.reach[n]
        least = (moment**2 / mass if mass > 0.0 else 0.0) + mass**2 / limits.disc[n]
        own = mass, *first, max(least, inertia) if limits.turning[n] else least
        inside[PARAMETERS * n : PARAMETERS * (n + 1)] = own
    whole = float(inside[0::PARAMETERS].sum())
    # A smaller weight of the same shape is in the set, too.
    return inside * (limits.total / whole) if whole > limits.total else inside


def _of(parameters: Real, n: int) -> tuple[float, Real, float]:
    own = parameters[PARAMETERS * n : PARAMETERS * (n + 1)]
    return float(own[0]), own[1:3], float(own[3])


def _weights(setting: Setting, task: Task, parameters: Real) -> list[Weight]:
    """The parameters as weights at places of the reference."""
    mechanism, scale = task.machine.mechanism, task.machine.scale
    own = setting.units * parameters
    listed = []
    for n, link in enumerate(setting.links):
        mass, first, inertia = _of(own, n)
        about = scale * complex(mechanism.joints[pivot(mechanism, link)])
        if float(parameters[PARAMETERS * n]) <= NOTHING and float(parameters[PARAMETERS * n + 3]) <= NOTHING:
            continue
        arm = complex(*first) / mass if mass > 0.0 else 0j
        disc = float(parameters[PARAMETERS * n] ** 2 / setting.limits.disc[n] * setting.units[PARAMETERS * n + 3])
        listed.append(Weight(link, mass, about + arm, max(disc, inertia - mass * abs(arm) ** 2)))
    return listed
