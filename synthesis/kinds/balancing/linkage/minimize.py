"""Counterweights that minimize the objective, with a lower bound for all permitted weights.

The program is solved on a few positions of a dense grid. Positions at which the solution exceeds the promised level
are added (cutting planes) until no relevant excess remains. Every step is linear algebra on the quantities of
:mod:`effects`: the mechanism is not driven again before the verification.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.analyses.linkages.requested_motion import Task, place_machine
from synthesis.kinds.balancing.linkage.conic_program import Answer, Level, Limits, find_best_weights
from synthesis.kinds.balancing.linkage.effects import PARAMETER_COUNT, LinearQuantity, compute_quantities
from synthesis.kinds.balancing.linkage.force_balance import Weight
from synthesis.kinds.balancing.linkage.motion import find_pivot, list_moving_links
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.results.remarks import write_name

GRID_SIZE = 2880
"""Number of positions of the motion at which peaks and means are evaluated."""

INITIAL_POSITIONS, MAX_ADDED_PEAKS = 72, 6
"""Number of grid positions of the first program, and maximum number of peaks added per quantity and round."""

MAX_ROUNDS = 10
"""Maximum number of programs solved."""

GRID_TOLERANCE = 1e-4
"""Excess of the value on the grid over that of the program, as a share, up to which no positions are added."""

CAP_TOLERANCE = 1e-6
"""Permitted excess over a cap on the grid, as a share of the cap: a few times the solver's tolerance."""

CAP_SENSITIVITY = 10.0
"""Maximum ratio of the value's shortfall below the bound to the share by which a cap is exceeded. The bound holds for
weights that keep the cap; it is lowered by this amount."""

DUAL_TOLERANCE = 1e-7
"""Possible error of the solver, as a share of the dual value plus the sum of the objective's weights. The bound is
reduced by it."""

NEGLIGIBLE_SHARE = 1e-9
"""Mass of a weight, as a share of the linkage's mass, that is negligible; also the negligible effect of a parameter."""

ZERO_TOLERANCE = 1e-12
"""Peak of a quantity, as a share of its changes by the weights, below which it is zero without weights and cannot be
reduced."""


class Setting(NamedTuple):
    """The program of a task: its quantities in units of their unbalanced values, and the units of its parameters."""

    links: list[str]
    levels: list[Level]
    limits: Limits
    units: Real
    grid: Real


class Minimum(NamedTuple):
    """The best weights, the lower bound, and the positions of the last program by quantity; or the ``violated`` caps.

    Each violated cap is given with the share by which it would have to be raised.
    """

    weights: list[Weight]
    bound: float
    parameters: Real
    used: dict[str, list[int]]
    violated: dict[str, float]
    solved: bool


class NothingToReduce(ValueError):
    """A quantity in the objective is zero without weights."""


class UndeterminedForces(ValueError):
    """A quantity is known at no position: redundant constraints leave joint forces undetermined."""


def build_setting(problem: BalancingProblem, task: Task) -> Setting:
    """Build the quantities over the grid, and the limits of the weights.

    Raises
    ------
    NothingToReduce
        If a quantity in the objective is zero.
    UndeterminedForces
        If the quantities are known at no position.
    """
    machine, stated = task.machine, problem.counterweights
    scale, mechanism = machine.scale, machine.mechanism
    links = stated.links or list_moving_links(mechanism)
    count = max(GRID_SIZE, problem.motion.steps)
    grid = task.list_positions(count)
    now = place_machine(machine, grid, task.speed, task.acceleration)
    counted = {**problem.objective.joint_forces, **problem.caps.joint_forces}
    found = compute_quantities(machine, now, links, list(counted))
    known = np.isfinite(np.concatenate([part.fixed[None] for parts in found.values() for part in parts])).all(axis=0)
    if not known.any():
        raise UndeterminedForces
    # The linkage's mass and size are the units of the parameters.
    mass = sum(float(part.mass) for part in machine.bodies.values()) + sum(map(float, machine.pin_masses.values()))
    places = np.array([scale * complex(z) for z in mechanism.joints.values()])
    size = float(np.abs(places[:, None] - places).max())
    # Scaled parameters keep the program's numbers near one.
    units = np.tile([mass, mass * size, mass * size, mass * size**2], len(links))
    levels = []
    for name, weight, cap in _list_counted(problem):
        mean = problem.objective.norm == "rms"
        scaled = [LinearQuantity(part.fixed[known], units[:, None] * part.by[:, known]) for part in found[name]]
        # If the objective uses means, a cap still applies to the peak, which then is a level of its own.
        for of_mean, own_weight, own_cap in (
            (False, 0.0 if mean else weight, cap),
            (True, weight if mean else 0.0, None),
        ):
            if own_weight == 0.0 and own_cap is None:
                continue
            bare = Level(name, scaled, own_weight, own_cap, of_mean)
            unbalanced = float(bare.evaluate_level(np.zeros(len(units))))
            largest = max(float(np.abs(part.by).max()) for part in scaled)
            if not unbalanced > ZERO_TOLERANCE * largest:
                raise NothingToReduce(write_quantity_name(name))
            values = [LinearQuantity(part.fixed / unbalanced, part.by / unbalanced) for part in scaled]
            levels.append(replace(bare, values=values))
    return Setting(links, levels, _build_limits(problem, task, links, levels, mass, size), units, grid[known])


def write_quantity_name(name: str) -> str:
    """Write the name of a quantity of the objective or the caps in words."""
    if name.startswith("joint "):
        return compose("balancing-joint-force", joint=name.removeprefix("joint "))
    return write_name(name)


def _list_counted(problem: BalancingProblem) -> list[tuple[str, float, float | None]]:
    """List the counted quantities with their weights in the objective and their caps."""
    objective, caps = problem.objective, problem.caps
    listed: list[tuple[str, float, float | None]] = [
        (name, getattr(objective, name), getattr(caps, name)) for name in ("shaking_force", "shaking_moment", "drive")
    ]
    for joint in {**objective.joint_forces, **caps.joint_forces}:
        listed.append((f"joint {joint}", objective.joint_forces.get(joint, 0.0), caps.joint_forces.get(joint)))
    return [(name, weight, cap) for name, weight, cap in listed if weight > 0.0 or cap is not None]


def _build_limits(
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
    reach = min(reach, gyration)  # the radius of gyration about the joint is at least the centre's distance
    counts = np.zeros(PARAMETER_COUNT * count)
    for level in levels:
        for part in level.values:
            counts = np.maximum(counts, np.abs(part.by).max(axis=1))
    matters = counts > NEGLIGIBLE_SHARE
    return Limits(
        np.full(count, most / mass),
        np.full(count, reach),
        np.full(count, disc),
        np.full(count, gyration),
        math.inf if stated.total_mass is None else stated.total_mass / mass,
        matters[3::PARAMETER_COUNT],
        matters[0::PARAMETER_COUNT],
    )


def find_minimum(setting: Setting, task: Task) -> Minimum:
    """Find the best weights of a setting."""
    levels, count = setting.levels, len(setting.grid)
    used = {
        level.name: np.unique(np.linspace(0, count - 1, INITIAL_POSITIONS).astype(int)).tolist() for level in levels
    }
    # The objective's value without counterweights is its scale.
    weighed = sum(level.weight for level in levels)
    bound, best, least = 0.0, None, math.inf
    for _ in range(MAX_ROUNDS):
        found = find_best_weights(levels, setting.limits, used, relaxed=False)
        if found.solution.status == "infeasible":
            return _find_violated_caps(setting, used)
        if found.solution.status != "solved":
            break
        dual = found.solution.dual
        # Subtract the solver's tolerance, by which the dual value may be too large.
        bound = max(bound, dual - DUAL_TOLERANCE * (abs(dual) + weighed))
        parameters = _move_inside(setting, found.parameters)
        reached = [level.evaluate_positions(parameters) for level in levels]
        value = sum(level.weight * float(of.max()) for level, of in zip(levels, reached, strict=True))
        beyond = max(
            (float(of.max()) / level.cap - 1.0 for level, of in zip(levels, reached, strict=True) if level.cap),
            default=0.0,
        )
        # Only weights that keep all caps are answers. Keep the best of all rounds.
        if beyond <= CAP_TOLERANCE and value < least:
            best, least = parameters, value
        if beyond <= CAP_TOLERANCE and value - bound <= GRID_TOLERANCE * max(value, NEGLIGIBLE_SHARE * weighed):
            break
        if not _add_peaks(levels, reached, found, used):
            break
    if best is None:
        return Minimum([], bound, np.zeros(len(setting.units)), used, {}, solved=False)
    # Weights slightly above a cap may have a value below the bound: that is not a contradiction.
    if bound <= least * (1.0 + CAP_SENSITIVITY * CAP_TOLERANCE):
        bound = min(bound, least)
    return Minimum(_build_weights(setting, task, best), bound, best, used, {}, solved=True)


def _add_peaks(levels: list[Level], reached: list[Real], found: Answer, used: dict[str, list[int]]) -> bool:
    """Add the positions of the highest peaks above the promised level; return whether any were added."""
    grown = False
    for level, of, promised in zip(levels, reached, found.levels.tolist(), strict=True):
        if level.mean:
            continue
        most = promised * (1.0 + 0.1 * GRID_TOLERANCE)
        if level.cap is not None:
            most = min(most, level.cap * (1.0 + 0.01 * CAP_TOLERANCE))
        peaks = np.flatnonzero((of >= np.roll(of, 1)) & (of >= np.roll(of, -1)) & (of > most))
        for at in peaks[np.argsort(-of[peaks])][:MAX_ADDED_PEAKS].tolist():
            if at not in used[level.name]:
                used[level.name].append(at)
                grown = True
    return grown


def _find_violated_caps(setting: Setting, used: dict[str, list[int]]) -> Minimum:
    """Find the caps that cannot be kept: those that are active at the smallest feasible common raise."""
    found = find_best_weights(setting.levels, setting.limits, used, relaxed=True)
    share = found.excess
    caps = {}
    for level in setting.levels:
        if level.cap is not None and float(level.evaluate_level(found.parameters)) >= level.cap * (1.0 + 0.9 * share):
            caps[level.name] = share
    return Minimum([], 0.0, found.parameters, used, caps, solved=False)


def _move_inside(setting: Setting, parameters: Real) -> Real:
    """Move the parameters into the feasible set, which the solver satisfies only to its tolerance.

    Masses without effect are dropped: if neither the mass nor the inertia of a weight counts, it gets the minimum mass
    for its first moment.
    """
    limits, inside = setting.limits, parameters.copy()
    for n in range(len(setting.links)):
        mass, first, inertia = _read_parameters(inside, n)
        mass, moment = min(max(mass, 0.0), float(limits.mass[n])), float(np.hypot(*first))
        if moment > mass * limits.reach[n]:
            first = first * (mass * limits.reach[n] / moment)
            moment = mass * limits.reach[n]
        if not limits.carried[n] and not limits.has_inertia(n):
            mass = moment / limits.reach[n]
        least = (moment**2 / mass if mass > 0.0 else 0.0) + mass**2 / limits.disc[n]
        own = mass, *first, max(least, inertia) if limits.turning[n] else least
        inside[PARAMETER_COUNT * n : PARAMETER_COUNT * (n + 1)] = own
    whole = float(inside[0::PARAMETER_COUNT].sum())
    # Scaling a feasible weight down keeps it feasible.
    return inside * (limits.total / whole) if whole > limits.total else inside


def _read_parameters(parameters: Real, n: int) -> tuple[float, Real, float]:
    own = parameters[PARAMETER_COUNT * n : PARAMETER_COUNT * (n + 1)]
    return float(own[0]), own[1:3], float(own[3])


def _build_weights(setting: Setting, task: Task, parameters: Real) -> list[Weight]:
    """Convert the parameters to weights with positions in the reference pose."""
    mechanism, scale = task.machine.mechanism, task.machine.scale
    own = setting.units * parameters
    listed = []
    for n, link in enumerate(setting.links):
        mass, first, inertia = _read_parameters(own, n)
        about = scale * complex(mechanism.joints[find_pivot(mechanism, link)])
        if (
            float(parameters[PARAMETER_COUNT * n]) <= NEGLIGIBLE_SHARE
            and float(parameters[PARAMETER_COUNT * n + 3]) <= NEGLIGIBLE_SHARE
        ):
            continue
        arm = complex(*first) / mass if mass > 0.0 else 0j
        disc = float(
            parameters[PARAMETER_COUNT * n] ** 2 / setting.limits.disc[n] * setting.units[PARAMETER_COUNT * n + 3]
        )
        listed.append(Weight(link, mass, about + arm, max(disc, inertia - mass * abs(arm) ** 2)))
    return listed
