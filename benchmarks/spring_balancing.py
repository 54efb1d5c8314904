"""Springs of random linkages: value against bound, what it takes, and random springs that try to beat the bound.

    python -m benchmarks.spring_balancing [problems] [samples]

Levers and fourbars are planted: zero-free-length springs are known that balance them exactly, with one end or both to
be found in areas. Of slider-cranks, and of fourbars whose areas do not hold the places that would do, nothing is known
beforehand. Each value is measured again here, by the reactions on positions that no program has seen. Random springs
are drawn from the same set, by a fourth near the best, and measured on the grid that the bound is for.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np

from kinematics.arrays import Real
from kinematics.dynamics.reactions import compute_reactions
from synthesis.analyses.linkages.requested_motion import place_machine
from synthesis.dispatch import solve
from synthesis.kinds.spring_balancing.design import SprungDesign
from synthesis.kinds.spring_balancing.effects import Setting, compute_effects
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.kinds.spring_balancing.program import compute_norm
from synthesis.kinds.spring_balancing.requested_springs import SoughtSpring
from synthesis.kinds.spring_balancing.verification import build_answer_machine
from tests.support.synthesis.sprung_linkages import both_open, fourbar, lever, missed, slider_crank

FINER = 7200
"""Positions of the second measurement."""

THINNED = 240
"""Positions on which random springs are measured first; those that do well, on the whole grid."""

FAMILIES: dict[str, Any] = {
    "levers, an end open": lever,
    "levers, both ends open": lambda rng: lever(rng, both=True),
    "fourbars, planted": fourbar,
    "fourbars, an end open": missed,
    "fourbars, both ends open": both_open,
    "slider-cranks, real springs": slider_crank,
}


def measured_again(problem: SpringBalancingProblem, setting: Setting, design: SprungDesign) -> float:
    """The value on other positions."""
    grid = setting.task.list_positions(FINER + 1)
    drives = []
    for machine in (setting.task.machine, build_answer_machine(problem, design.mechanism, design.dynamics)):
        found = compute_reactions(machine, place_machine(machine, grid, setting.task.speed, setting.task.acceleration))
        drives.append(found.drive[found.solved])
    return compute_norm(drives[1], problem.norm) / compute_norm(drives[0], problem.norm)


def drawn(rng: np.random.Generator, setting: Setting, spring: SoughtSpring, best: Any) -> Real:
    """What a random spring of the set asks of the drive, (N,); one near the best where there is one."""
    near = best is not None and rng.random() < 0.25
    low, high = spring.rates
    rate = rng.uniform(low, high if high is not None else 2.0 * best.rate if best is not None else 1.0)
    if near:
        rate = float(np.clip(best.rate * (1.0 + 0.02 * rng.normal()), low, np.inf if high is None else high))
    ends = []
    for n, corners in enumerate(setting.list_corners(spring)):
        at = complex(rng.dirichlet(np.ones(len(corners))) @ corners)
        if near:
            own = setting.task.machine.scale * complex(*best.ends[n].point)
            at = own + (at - own) * rng.uniform(0.0, 0.05)
        ends.append(np.array([at]))
    effects = compute_effects(setting, spring, ends)
    if spring.is_superposable:
        return np.asarray(rate * effects.drive[0])
    scale = setting.task.machine.scale
    shortest, longest = spring.free_lengths
    free = scale * rng.uniform(shortest, longest if longest is not None else 2.0 * shortest)
    parameters = np.array([rate, rate * free, rng.uniform(*spring.preloads)])
    if near:
        parameters[1] = rate * scale * best.free_length * (1.0 + 0.02 * rng.normal())
        parameters[2] = best.preload
    if (effects.rows @ parameters > effects.limits + 1e-12 * np.abs(effects.limits)).any():
        return np.full(len(setting.at), np.inf)  # not of the set
    return np.asarray(parameters @ effects.drive)


def least_by_chance(rng: np.random.Generator, setting: Setting, design: SprungDesign, samples: int) -> float:
    """The least value of random springs."""
    few, norm = setting.thin_positions(THINNED), setting.problem.norm
    whole, least = compute_norm(setting.fixed, norm), np.inf
    known = {spring.number: spring for spring in design.springs}
    for _ in range(samples):
        state = rng.bit_generator.state
        parts = [drawn(rng, few, spring, known.get(n)) for n, spring in enumerate(setting.problem.springs)]
        left = few.fixed + np.sum(parts, axis=0)
        if np.isfinite(left).all() and compute_norm(left, norm) < least * whole:
            again = np.random.default_rng()
            again.bit_generator.state = state
            parts = [drawn(again, setting, spring, known.get(n)) for n, spring in enumerate(setting.problem.springs)]
            least = min(least, compute_norm(setting.fixed + np.sum(parts, axis=0), norm) / whole)
    return least


def run(name: str, make: Any, count: int, samples: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows, exact, proved = [], 0, 0
    for _ in range(count):
        problem = SpringBalancingProblem.model_validate(make(rng))
        problem.require_consistent()
        begun = time.process_time()
        result = solve(problem)
        taken = time.process_time() - begun
        if not result.designs:
            raise AssertionError(result.summary)
        design = result.designs[0]
        metrics, setting = design.metrics, Setting(problem)
        exact, proved = exact + metrics.exact, proved + result.search.complete
        chance = least_by_chance(rng, setting, design, samples)
        bound = metrics.bound or 0.0
        gap = metrics.gap or 0.0
        again = 1.0 if metrics.exact else measured_again(problem, setting, design) / metrics.value
        rows.append((taken, metrics.value - bound, gap, again, chance - bound))
    taken, above, gap, again, chance = np.array(rows).T
    print(f"{name}: {count} verified, {exact} exact, {proved} proved")
    print(f"  CPU of a problem, s: median {np.median(taken):.3f}, most {taken.max():.3f}")
    print(f"  value less bound: least {above.min():.2e}; gap: median {np.median(gap):.2e}, largest {gap.max():.2e}")
    print(f"  measured between the positions, over the value: at most {again.max():.6f}")
    print(f"  least of {samples} random springs each, less the bound: {chance.min():.2e}")


def main() -> None:
    words = sys.argv[1:3]
    count, samples = (int(word) for word in (*words, *("50", "2000")[len(words) :]))
    solve(SpringBalancingProblem.model_validate(lever(np.random.default_rng(0))))  # what is loaded once is not counted
    for seed, (name, make) in enumerate(FAMILIES.items()):
        run(name, make, count, samples, seed)


if __name__ == "__main__":
    main()
