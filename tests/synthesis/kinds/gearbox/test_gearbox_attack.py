"""Random small gearboxes against brute force that shares nothing with the solvers: every choice of teeth is tried.

Speeds are measured as a client would: all of them, sorted, beside the nominal ones. Interference is measured by where
the tips cut the line of action.
"""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem
from synthesis.registry import parse_problem

EVEN = 1e-12
"""Logarithms of speeds that differ by less are equal."""


def sound(one: int, other: int, degrees: float) -> bool:
    """Whether no tip passes the point where the line of action touches the mate's base circle; half modules."""
    angle = math.radians(degrees)
    whole = (one + other) * math.sin(angle)
    reach = [math.sqrt((z + 2) ** 2 - (z * math.cos(angle)) ** 2) for z in (one, other)]
    return max(reach) <= whole * (1.0 + 1e-12)


def drivers(problem: GearboxProblem, total: int) -> list[int]:
    low, high = problem.teeth.min, problem.teeth.max
    slow, fast = problem.stage_ratio.min, problem.stage_ratio.max
    return [
        z
        for z in range(low, high + 1)
        if low <= total - z <= high
        and slow * (1 - EVEN) <= z / (total - z) <= fast * (1 + EVEN)
        and sound(z, total - z, problem.pressure_angle)
    ]


def shapes(problem: GearboxProblem) -> list[tuple[int, ...]]:
    """Numbers of pairs of the stages, in every order."""
    if problem.structure is not None:
        return [tuple(problem.structure)]

    def split(count: int) -> list[tuple[int, ...]]:
        if count == 1:
            return [()]
        return [(k, *rest) for k in range(2, problem.max_pairs + 1) if count % k == 0 for rest in split(count // k)]

    return [((1,) if problem.fixed_stage else ()) + shape for shape in split(problem.speeds.count)]


def brute(problem: GearboxProblem) -> list[tuple[int, float]]:
    """Tooth sum and least error, where no smaller sum has as little."""
    nominal = np.log(problem.speeds.nominal)
    best: dict[int, float] = {}
    for shape in shapes(problem):
        stages = []
        for pairs in shape:
            levels, sizes = [], []
            for total in range(problem.tooth_sum.min, problem.tooth_sum.max + 1):
                for chosen in itertools.combinations(drivers(problem, total), pairs):
                    if pairs > 2 and chosen[-1] - chosen[-2] < problem.cluster_difference:
                        continue
                    levels.append([math.log(z / (total - z)) for z in chosen])
                    sizes.append(total)
            stages.append((np.array(levels).reshape(-1, pairs), np.array(sizes, dtype=np.int64)))
        if not all(len(sizes) for _, sizes in stages):
            continue
        first, *others = stages
        for level, size in zip(*first, strict=True):
            speeds, sizes = level[None, :] + math.log(problem.input_speed), np.array([size])
            for levels, own in others:
                speeds = speeds[:, None, :, None] + levels[None, :, None, :]
                speeds = speeds.reshape(speeds.shape[0] * speeds.shape[1], -1)
                sizes = (sizes[:, None] + own).reshape(-1)
            errors = np.abs(np.sort(speeds, axis=1) - nominal).max(axis=1)
            for total in np.unique(sizes).tolist():
                best[total] = min(best.get(total, math.inf), float(errors[sizes == total].min()))
    return front((size, error) for size, error in best.items() if error <= problem.widest + EVEN)


def front(rows: Any) -> list[tuple[int, float]]:
    """The rows of less error than every smaller size."""
    kept: list[tuple[int, float]] = []
    for size, error in sorted(rows):
        if not kept or error < kept[-1][1] - EVEN:
            kept.append((size, error))
    return kept


def random_gearbox(rng: np.random.Generator) -> dict[str, Any]:
    count, shape = [(2, [2]), (3, [3]), (4, [2, 2]), (6, [2, 3]), (6, [3, 2]), (4, [2, 1, 2]), (8, [2, 2, 2])][
        rng.integers(7)
    ]
    low = int(rng.integers(14, 19))
    middle = int(rng.integers(2 * low + 14, 2 * low + 24))
    width = int(rng.integers(0, 3)) if count < 8 else 0
    ratio = float(rng.choice([1.12, 1.26, 1.41, round(rng.uniform(1.1, 1.5), 3)]))
    # A lowest speed that teeth in the lower part of the range have, so that many statements have an answer.
    slowest = 100.0 * math.prod(z / (middle - z) for z in rng.integers(low, (low + middle // 2) // 2 + 2, len(shape)))
    stated: dict[str, Any] = {
        "kind": "gearbox",
        "input_speed": 100.0,
        "speeds": {"min": round(slowest, 3), "ratio": ratio, "count": count},
        "teeth": {"min": low, "max": int(rng.integers(middle // 2 + 2, middle - low + 1))},
        "tooth_sum": {"min": middle, "max": middle + width},
        "stage_ratio": {"min": float(rng.choice([0.25, 0.4])), "max": float(rng.choice([1.5, 2.0, 3.0]))},
        "tolerance": round(float(rng.uniform(0.05, 0.3)) * math.log(ratio), 6),
        "pressure_angle": float(rng.choice([20.0, 25.0])),
        "rank_by": str(rng.choice(["error", "size"])),
        "max_designs": 200,
    }
    if rng.random() < 0.5:
        stated["structure"] = shape
    elif count < 8:
        stated["fixed_stage"] = bool(rng.random() < 0.2)
    if rng.random() < 0.3:
        stated["cluster_difference"] = int(rng.integers(1, 6))
    return stated


def check_gearbox(stated: dict[str, Any]) -> bool:
    """Compare one statement; whether it has an answer."""
    problem = parse_problem(stated)
    assert isinstance(problem, GearboxProblem)
    assert not problem.find_contradictions(), stated
    result: Any = solve(problem, lambda fraction, message: None)
    quarter = 0.25 * math.log(problem.speeds.progression_ratio)
    assert result.search.complete == (problem.widest < quarter)
    found = [(design.metrics.tooth_sum, design.metrics.max_error) for design in result.designs]
    # Beyond a quarter of a step brute force finds gearboxes without a structure, and the answer says so.
    own, every = ([row for row in rows if row[1] < quarter] for rows in (front(found), brute(problem)))
    assert own == [(size, pytest.approx(error, abs=1e-11)) for size, error in every], stated
    keys = [(e, s) if problem.rank_by == "error" else (s, e) for s, e in found]
    assert all(one <= other or one[0] - other[0] < EVEN for one, other in itertools.pairwise(keys)), stated
    return bool(found)


@pytest.mark.campaign
def test_random_gearboxes() -> None:
    rng = np.random.default_rng(11)
    answered = sum(check_gearbox(random_gearbox(rng)) for _ in range(30))
    assert 5 <= answered <= 25


def brute_layshaft(problem: LayshaftProblem) -> list[tuple[int, Fraction]]:
    """Least largest error of every tooth sum by loops over all teeth of all gears, exact."""
    low, high = problem.teeth.min, problem.teeth.max
    refuse, angle = problem.interference == "refuse", problem.pressure_angle
    geared = [Fraction(str(t)) for t in problem.ratios if not (problem.direct and t == 1.0)]
    found = []
    for total in range(problem.tooth_sum.min, problem.tooth_sum.max + 1):
        pairs = [
            (z, total - z)
            for z in range(low, high + 1)
            if low <= total - z <= high and not (refuse and not sound(z, total - z, angle))
        ]
        backs = None
        if problem.reverse is not None:
            backs = {
                Fraction(g, e)
                for e, f, g in itertools.product(range(low, high + 1), repeat=3)
                # Tips of e and g pass each other, and both reach the idler.
                if e + g + 4 < total <= e + 2 * f + g
                and not (refuse and not (sound(e, f, angle) and sound(f, g, angle)))
            }
            if not backs:
                continue
        least = None
        for a, b in pairs:
            worst = Fraction(0)
            for target in geared:
                worst = max(worst, min(abs(Fraction(b * d, a * c) / target - 1) for c, d in pairs))
            if backs is not None:
                wanted = Fraction(str(problem.reverse))
                worst = max(worst, min(abs(Fraction(b, a) * q / wanted - 1) for q in backs))
            least = worst if least is None else min(least, worst)
        if least is not None:
            found.append((total, least))
    return found


def random_layshaft(rng: np.random.Generator) -> dict[str, Any]:
    low = int(rng.integers(12, 20))
    middle = int(rng.integers(2 * low, 2 * low + 20))
    count = int(rng.integers(1, 5))
    ratios = sorted({round(float(rng.uniform(0.5, 5.0)), 2) for _ in range(count)}, reverse=True)
    if rng.random() < 0.4:
        ratios = sorted({*ratios, 1.0}, reverse=True)
    return {
        "kind": "layshaft_gearbox",
        "ratios": ratios,
        "reverse": round(float(rng.uniform(0.6, 4.0)), 2) if rng.random() < 0.6 else None,
        "direct": bool(rng.random() < 0.7),
        "teeth": {"min": low, "max": low + int(rng.integers(4, 26))},
        "tooth_sum": {"min": middle, "max": middle + int(rng.integers(0, 5))},
        "interference": str(rng.choice(["refuse", "report"])),
        "pressure_angle": float(rng.choice([20.0, 25.0])),
        "tolerance": round(float(rng.uniform(0.01, 0.6)), 3),
        "rank_by": str(rng.choice(["error", "size"])),
        "max_designs": 50,
    }


def check_layshaft(stated: dict[str, Any]) -> bool:
    """Compare one statement; whether it has an answer."""
    problem = parse_problem(stated)
    assert isinstance(problem, LayshaftProblem)
    result: Any = solve(problem, lambda fraction, message: None)
    assert result.search.complete
    every = brute_layshaft(problem)
    limit = Fraction(str(problem.tolerance))
    served = [(total, error) for total, error in every if error <= limit]
    assert bool(result.designs) == bool(served), stated
    first: list[tuple[int, Fraction]] = []
    for total, error in every:
        if not first or error < first[-1][1]:
            first.append((total, error))
    assert [(row.tooth_sum, row.max_error) for row in result.pareto] == [
        (total, pytest.approx(float(error), abs=1e-14)) for total, error in first
    ], stated
    if not served:
        return False
    found = [(design.metrics.tooth_sum, design.metrics.max_error) for design in result.designs]
    if problem.rank_by == "error":
        assert found[0][1] == pytest.approx(float(min(error for _, error in served)), abs=1e-14), stated
        assert [error for _, error in found] == sorted(error for _, error in found), stated
    else:
        assert found == [(total, pytest.approx(float(error), abs=1e-14)) for total, error in served], stated
    return True


@pytest.mark.campaign
def test_random_layshaft_gearboxes() -> None:
    rng = np.random.default_rng(12)
    answered = sum(check_layshaft(random_layshaft(rng)) for _ in range(40))
    assert 10 <= answered <= 39
