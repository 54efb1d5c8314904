"""Counterweights of random linkages: value against bound, what it takes, and random weights that try to beat the bound.

    python -m benchmarks.balancing [fourbars] [sixbars] [samples]

Every problem is solved through the same door as a job's. The value is measured again here on more positions than the
program has seen, on the answer as an analysis would read it. Random weights are drawn from the same set (masses, places
within reach, discs with rings) and measured on the very positions that the bound is for; some start a local search by
coordinates, as is usual in the literature.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from kinematics.arrays import Real
from kinematics.dynamics.reactions import compute_reactions
from synthesis.analyses.linkages.requested_motion import Task, place_machine
from synthesis.dispatch import solve
from synthesis.kinds.balancing.linkage.effects import PARAMETER_COUNT, LinearQuantity
from synthesis.kinds.balancing.linkage.minimize import Minimum, Setting, build_setting, find_minimum
from synthesis.kinds.balancing.linkage.motion import build_balancing_task
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.verification.linkage import build_answer_machine
from tests.support.synthesis.balanced_linkages import crank_rocker, fourbar, sixbar, stated, turning_sixbar

FINER = 2880
"""Positions of the second measurement."""

BATCH = 2000
"""Random weights that are measured at once."""


def random_problem(rng: np.random.Generator, make: Any) -> BalancingProblem:
    """A linkage with goals, norms, caps and weights of random kinds."""
    counted = {"shaking_force": float(rng.uniform(0.2, 1.0))}
    for name in ("shaking_moment", "drive"):
        if rng.random() < 0.6:
            counted[name] = float(rng.uniform(0.1, 1.0))
    objective: dict[str, Any] = {**counted, "norm": str(rng.choice(["max", "max", "rms"]))}
    if rng.random() < 0.3:
        objective["joint_forces"] = {"A": 0.3}
    caps = {} if rng.random() < 0.6 else {"drive": float(rng.uniform(1.0, 1.4))}
    weights: dict[str, Any] = {"total_mass": float(rng.uniform(1.0, 6.0)), "reach": float(rng.uniform(60.0, 200.0))}
    if rng.random() < 0.7:
        weights |= {"density": 7800.0, "thickness": float(rng.uniform(8.0, 40.0))}
    if rng.random() < 0.4:
        weights["max_gyration"] = 1.5 * weights["reach"]
    problem = stated(rng, make, goal="minimize", objective=objective, caps=caps, counterweights=weights)
    if rng.random() < 0.4:
        problem["dynamics"]["gravity"] = {}
    parsed = BalancingProblem.model_validate(problem)
    parsed.require_consistent()
    return parsed


def measured_again(problem: BalancingProblem, task: Task, design: Any) -> float:
    """The value on other positions: a peak between those of the grid is not seen by it."""
    grid = task.list_positions(FINER + 1)
    found = []
    for machine in (task.machine, build_answer_machine(problem, design.mechanism, design.dynamics)):
        found.append(compute_reactions(machine, place_machine(machine, grid, task.speed, task.acceleration)))
    value = 0.0
    for level in design.metrics.levels:
        peaks = []
        for one in found:
            known = one.solved
            if level.name.startswith("joint "):
                series = [np.abs(force[known]) for force in one.joints[level.name[6:]].values()]
            else:
                series = [np.abs(getattr(one, level.name)[known])]
            peaks.append(max(float(s.max()) if level.norm == "max" else float(np.sqrt((s**2).mean())) for s in series))
        value += level.weight * peaks[1] / peaks[0]
    return value


def drawn(rng: np.random.Generator, setting: Setting, count: int) -> Real:
    """Random parameters of the set: masses that keep the total, places within reach, at least a disc's inertia."""
    limits, links = setting.limits, len(setting.links)
    shares = rng.dirichlet(np.ones(links + 1), count)[:, :links]
    whole = limits.total if np.isfinite(limits.total) else float(limits.mass.sum())
    masses = np.minimum(shares * whole * rng.uniform(0.0, 1.0, (count, 1)) ** 0.3, limits.mass)
    arms = limits.reach * np.sqrt(rng.uniform(0.0, 1.0, (count, links)))
    angles = rng.uniform(-np.pi, np.pi, (count, links))
    found = np.zeros((count, PARAMETER_COUNT * links))
    found[:, 0::PARAMETER_COUNT] = masses
    found[:, 1::PARAMETER_COUNT] = masses * arms * np.cos(angles)
    found[:, 2::PARAMETER_COUNT] = masses * arms * np.sin(angles)
    ring = np.where(rng.random((count, links)) < 0.5, 0.0, rng.exponential(0.02, (count, links)))
    found[:, 3::PARAMETER_COUNT] = masses * arms**2 + masses**2 / limits.disc + ring
    return _pushed_inside(setting, found)


def costs(setting: Setting, used: dict[str, list[int]], parameters: Real) -> Real:
    """The objective of weights on the program's positions; infinite where a cap is broken there."""
    total = np.zeros(len(parameters))
    for level in setting.levels:
        if level.mean:
            reached = np.max([_means(part, parameters) for part in level.values], axis=0)
        else:
            reached = np.max([_largest(part, used[level.name], parameters) for part in level.values], axis=0)
        total = total + level.weight * reached
        if level.cap is not None:
            total = np.where(reached > level.cap, np.inf, total)
    return np.asarray(total)


def _largest(part: LinearQuantity, at: list[int], parameters: Real) -> Real:
    """The largest magnitude at positions."""
    fixed, by = part.fixed[at], part.by[:, at]
    squares = (fixed.real + parameters @ by.real) ** 2
    if np.any(fixed.imag) or np.any(by.imag):
        squares += (fixed.imag + parameters @ by.imag) ** 2
    return np.asarray(np.sqrt(squares.max(axis=1)))


def _means(part: LinearQuantity, parameters: Real) -> Real:
    """Roots of the mean square, by the matrix of the quadratic form."""
    rows = np.concatenate([part.by, part.fixed[None]])
    form = (rows @ rows.conj().T).real / len(part.fixed)
    whole = np.concatenate([parameters, np.ones((len(parameters), 1))], axis=1)
    return np.asarray(np.sqrt(np.maximum(0.0, np.einsum("ki,ij,kj->k", whole, form, whole))))


def least_by_chance(rng: np.random.Generator, setting: Setting, found: Minimum, samples: int) -> float:
    """The least objective of random weights, and of local searches around the optimum and the best of them."""
    least, best = np.inf, found.parameters
    for _ in range(max(samples // BATCH, 1)):
        batch = drawn(rng, setting, BATCH)
        reached = costs(setting, found.used, batch)
        n = int(np.argmin(reached))
        if reached[n] < least:
            least, best = float(reached[n]), batch[n]
    for _ in range(20):
        near = (best if rng.random() < 0.5 else found.parameters) * (1.0 + 0.05 * rng.normal(size=(500, len(best))))
        near = _pushed_inside(setting, near)
        reached = costs(setting, found.used, near)
        n = int(np.argmin(reached))
        if reached[n] < least:
            least, best = float(reached[n]), near[n]
    return least


def _pushed_inside(setting: Setting, parameters: Real) -> Real:
    """Parameters with masses, places and inertias brought within the set."""
    limits, inside = setting.limits, parameters.copy()
    masses = np.clip(inside[:, 0::PARAMETER_COUNT], 0.0, limits.mass)
    if np.isfinite(limits.total):
        masses *= np.minimum(1.0, limits.total / np.maximum(masses.sum(axis=1, keepdims=True), 1e-300))
    moments = np.hypot(inside[:, 1::PARAMETER_COUNT], inside[:, 2::PARAMETER_COUNT])
    shrink = np.minimum(1.0, limits.reach * masses / np.maximum(moments, 1e-300))
    inside[:, 0::PARAMETER_COUNT] = masses
    inside[:, 1::PARAMETER_COUNT] *= shrink
    inside[:, 2::PARAMETER_COUNT] *= shrink
    least = (moments * shrink) ** 2 / np.maximum(masses, 1e-300) + masses**2 / limits.disc
    inside[:, 3::PARAMETER_COUNT] = np.maximum(inside[:, 3::PARAMETER_COUNT], least)
    # A weight that is too wide for its radius of gyration is none at all.
    widest = np.where(np.isfinite(limits.gyration), limits.gyration, 1e9)
    wide = inside[:, 3::PARAMETER_COUNT] > masses * widest**2
    for n in range(PARAMETER_COUNT):
        inside[:, n::PARAMETER_COUNT] = np.where(wide, 0.0, inside[:, n::PARAMETER_COUNT])
    return inside


def run(name: str, makes: Sequence[Any], count: int, samples: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows, empty = [], 0
    solve(random_problem(np.random.default_rng(0), makes[0]))  # what is loaded once is not counted
    for n in range(count):
        problem = random_problem(rng, makes[n % len(makes)])
        begun = time.process_time()
        result = solve(problem)
        taken = time.process_time() - begun
        if not result.designs:
            if not result.search.complete:
                raise AssertionError(result.summary)
            empty += 1
            continue
        design = result.designs[0]
        task = build_balancing_task(problem)
        setting = build_setting(problem, task)
        found = find_minimum(setting, task)
        again = measured_again(problem, task, design)
        chance = least_by_chance(rng, setting, found, samples)
        metrics = design.metrics
        rows.append((taken, metrics.value, metrics.bound, metrics.gap, again, chance - metrics.bound))
    taken, value, bound, gap, again, chance = np.array(rows).T
    print(f"{name}: {len(rows)} solved and verified, {empty} proved to have none")
    print(f"  CPU of a problem, s: median {np.median(taken):.3f}, most {taken.max():.3f}")
    print(f"  value less bound: least {np.min(value - bound):.2e}; largest gap {gap.max():.2e}")
    print(f"  measured between the positions, over the value: at most {np.max(again / value):.6f}")
    print(f"  least of {samples} random weights and local searches less the bound: {chance.min():.2e}")


def main() -> None:
    words = sys.argv[1:4]
    fourbars, sixbars, samples = (int(word) for word in (*words, *("100", "20", "100000")[len(words) :]))
    run("fourbars", (fourbar, crank_rocker), fourbars, samples, 1)
    run("sixbars", (sixbar, turning_sixbar), sixbars, samples, 2)


if __name__ == "__main__":
    main()
