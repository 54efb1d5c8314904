"""Trains fitted to centre distances, by a loop over all of them: every pair of gears, every module, a grid of splits.

Nothing is shared with the solver. A pair is looked at with the circles of its teeth alone: where the tips cut the line
of action, where the rack's straight flank ends on it, how thick the tips are. Of every sum of shifts 401 splits are
tried, then the neighbourhood of the best ones again, until no margin is left to gain. Trains are compared as fractions.
"""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from random import Random
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from kinematics.arrays import Real

SPLITS, ROUNDS = 401, 9
"""Splits of a sum in one round, and rounds, each about the best of the one before."""

SUMS = 61
"""Sums of shifts tried in a range of distances."""

SLACK = 1e-9
"""Margin that still counts as kept."""


class Best(NamedTuple):
    """The nearest train: ratio, relative error, and how many trains are exactly as near."""

    ratio: Fraction
    error: float
    ties: int


def _involute(angle: Any) -> Any:
    return np.tan(angle) - angle


def _margins(z: tuple[int, int], x: Real, total: float, distance: float, task: dict[str, Any]) -> Real:
    """The least margin of each split, in modules."""
    phi = math.radians(task["pressure_angle"])
    rounding = min(0.38, (math.pi / 4.0 - 1.25 * math.tan(phi)) / math.tan(math.pi / 4.0 - phi / 2.0))
    straight = 1.25 - rounding * (1.0 - math.sin(phi))
    bases = [0.5 * teeth * math.cos(phi) for teeth in z]
    line = math.sqrt(max(distance**2 - (bases[0] + bases[1]) ** 2, 0.0))
    lost = max(0.0, total - (distance - 0.5 * (z[0] + z[1])))
    shifts = [x, total - x]
    out = []
    left = np.full_like(x, np.inf)
    for teeth, base, shift in zip(z, bases, shifts, strict=True):
        tip = 0.5 * teeth + 1.0 + shift - lost
        out.append(np.sqrt(np.maximum(tip**2 - base**2, 0.0)))
        half = (0.5 * math.pi + 2.0 * shift * math.tan(phi)) / teeth
        angle = np.arccos(np.clip(base / tip, 0.0, 1.0))
        thick = 2.0 * tip * (half + _involute(phi) - _involute(angle))
        for margin in (thick - task["tip"], shift - task["shift"][0], task["shift"][1] - shift, 1.0 + shift - lost):
            left = np.minimum(left, margin)
    for own, mate in ((0, 1), (1, 0)):
        begins = 0.5 * z[own] * math.sin(phi) - (straight - shifts[own]) / math.sin(phi)
        left = np.minimum(left, np.minimum(begins, line - out[mate] - begins))
    return np.minimum(left, out[0] + out[1] - line - task["ratio_of_contact"] * math.pi * math.cos(phi))


def best_margin(z: tuple[int, int], distance: float, task: dict[str, Any]) -> float:
    """The greatest margin of all splits at a distance in modules."""
    phi = math.radians(task["pressure_angle"])
    cosine = 0.5 * (z[0] + z[1]) * math.cos(phi) / distance
    if cosine >= 1.0:
        return -math.inf
    total = (z[0] + z[1]) * (_involute(math.acos(cosine)) - _involute(phi)) / (2.0 * math.tan(phi))
    low, high = task["shift"][0] - 1e-6, task["shift"][1] + 1e-6
    low, high = max(low, total - high), min(high, total - low)
    if low > high:
        return -math.inf
    best = -math.inf
    for _ in range(ROUNDS):
        x = np.linspace(low, high, SPLITS)
        found = _margins(z, x, total, distance, task)
        at = int(found.argmax())
        best = max(best, float(found[at]))
        step = 2.0 * (high - low) / (SPLITS - 1)
        low, high = max(low, x[at] - step), min(high, x[at] + step)
    return best


def _distance_of(z: tuple[int, int], total: float, phi: float) -> float:
    value = _involute(phi) + 2.0 * math.tan(phi) * total / (z[0] + z[1])
    if value <= 0.0:
        return math.nan
    angle = brentq(lambda one: math.tan(one) - one - value, 1e-4, 1.4, xtol=1e-15)
    return 0.5 * (z[0] + z[1]) * math.cos(phi) / math.cos(angle)


def span(z: tuple[int, int], low: float, high: float, task: dict[str, Any]) -> tuple[float, float] | None:
    """The distances between two that suit a pair, in modules; None: none does."""
    if low == high:
        return (low, high) if best_margin(z, low, task) >= -SLACK else None
    phi = math.radians(task["pressure_angle"])
    ends = [_distance_of(z, 2.0 * x, phi) for x in task["shift"]]
    low = max(low, ends[0] if math.isfinite(ends[0]) else 0.5 * (z[0] + z[1]) * math.cos(phi) * 1.0001)
    high = min(high, ends[1])
    if low > high * (1.0 + 1e-12):
        return None
    high = max(low, high)
    tried = np.linspace(low, high, SUMS)
    found = np.array([best_margin(z, float(one), task) for one in tried])
    for _ in range(8):
        if found.max() >= -SLACK or high == low:
            break
        at = int(found.argmax())
        tried = np.linspace(tried[max(at - 1, 0)], tried[min(at + 1, SUMS - 1)], SUMS)
        found = np.array([best_margin(z, float(one), task) for one in tried])
    sound = np.flatnonzero(found >= -SLACK)
    if not len(sound):
        return None
    return _edge(z, tried, sound[0], -1, task), _edge(z, tried, sound[-1], 1, task)


def _edge(z: tuple[int, int], tried: Real, at: int, way: int, task: dict[str, Any]) -> float:
    if not 0 <= at + way < len(tried):
        return float(tried[at])
    good, bad = float(tried[at]), float(tried[at + way])
    for _ in range(40):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if best_margin(z, middle, task) >= -SLACK else (good, middle)
    return good


def _as_task(statement: dict[str, Any]) -> dict[str, Any]:
    stated = statement.get("centre_distance")
    shift = statement.get("shift") or ({"min": -0.5, "max": 1.0} if stated is not None else {"min": 0.0, "max": 0.0})
    return {
        "pressure_angle": statement.get("pressure_angle", 20.0),
        "shift": (shift["min"], shift["max"]),
        "tip": statement.get("min_tip_thickness", 0.25),
        "ratio_of_contact": statement.get("min_contact_ratio", 1.2),
    }


def _limits(statement: dict[str, Any], stage: int) -> tuple[float, float]:
    stated = statement.get("centre_distance")
    if stated is None:
        return 0.0, math.inf
    if isinstance(stated, dict):
        return stated["min"], stated["max"]
    one = stated[stage] if isinstance(stated, list) else stated
    return one, one


def best_train(statement: dict[str, Any]) -> Best | None:
    """The best train of a statement of two stages at most, its ratio rational; None where there is none."""
    task, modules = _as_task(statement), statement["modules"]
    numbers = range(statement["teeth"]["min"], statement["teeth"]["max"] + 1)
    shared = statement.get("reverted", False) and not isinstance(statement.get("centre_distance"), float)
    stages: list[dict[tuple[int, int], list[tuple[float, float]]]] = []
    for stage in range(statement["max_stages"]):
        low, high = _limits(statement, stage)
        if stage and (low, high) == _limits(statement, 0):
            stages.append(stages[0])
            continue
        fits: dict[tuple[int, int], list[tuple[float, float]]] = {}
        for a, b in itertools.combinations_with_replacement(numbers, 2):
            for module in modules:
                found = span((a, b), low / module, high / module, task)
                if found is not None:
                    for pair in {(a, b), (b, a)}:
                        fits.setdefault(pair, []).append((found[0] * module, found[1] * module))
        stages.append(fits)
    target, tolerance = Fraction(statement["ratio"]), statement.get("tolerance")
    # Trains by what tells them apart: gears, or meshes (with their modules where they agree on a distance).
    trains: dict[Any, Fraction] = {}
    first = 2 if statement.get("reverted") else 1
    for k in range(first, statement["max_stages"] + 1):
        for meshes in itertools.product(*(stage for stage in stages[:k])):
            ratio = Fraction(math.prod(b for _, b in meshes), math.prod(a for a, _ in meshes))
            if shared:
                for spans in itertools.product(*(range(len(stages[i][mesh])) for i, mesh in enumerate(meshes))):
                    ends = [stages[i][mesh][spans[i]] for i, mesh in enumerate(meshes)]
                    if max(end[0] for end in ends) <= min(end[1] for end in ends) * (1.0 + 1e-12):
                        trains[tuple(sorted(zip(meshes, ends, strict=True)))] = ratio
            elif statement.get("reverted"):
                trains[tuple(sorted(meshes))] = ratio
            else:
                trains[tuple(tuple(sorted(side)) for side in zip(*meshes, strict=True))] = ratio
    errors = {train: abs(ratio / target - 1) for train, ratio in trains.items()}
    if not errors:
        return None
    least = min(errors.values())
    if least > Fraction(str(tolerance)) if tolerance is not None else not _within_reach(target, stages, first):
        return None
    nearest = next(train for train, error in errors.items() if error == least)
    return Best(trains[nearest], float(least), sum(error == least for error in errors.values()))


def _within_reach(target: Fraction, stages: list[Any], first: int) -> bool:
    """Whether a ratio lies between the least and the greatest that the meshes of all stages give."""
    ends = []
    for k in range(first, len(stages) + 1):
        ratios = [[Fraction(b, a) for a, b in stage] for stage in stages[:k]]
        if all(ratios):
            ends.append((math.prod(min(one) for one in ratios), math.prod(max(one) for one in ratios)))
    return min(low for low, _ in ends) <= target <= max(high for _, high in ends)


def same_answer(answer: dict[str, Any], best: Best | None, decided: bool) -> str | None:
    """What the solver's answer has that the brute force has not; None where they agree.

    ``decided``: whether the sums of shifts are, so that the answer has to be complete.
    """
    designs = answer["designs"]
    if answer["search"]["complete"] != decided:
        return f"the search is {'not ' if decided else ''}complete"
    if not designs or best is None:
        return None if not designs and best is None else f"answer {bool(designs)}, brute force {best}"
    ratio = designs[0]["mechanism"]["ratio"]
    error = designs[0]["metrics"]["relative_error"]
    if abs(abs(error) - best.error) > 1e-12 * (1.0 + best.error):
        return f"{ratio['value']} against {best}"
    if answer["search"]["ties"] != best.ties:
        return f"{answer['search']['ties']} ties against {best.ties}"
    if best.ties == 1 and abs(Fraction(ratio["numerator"], ratio["denominator"])) != abs(best.ratio):
        return f"{ratio['numerator']}/{ratio['denominator']} against {best.ratio}"
    return None


def statements(number: int, seed: int) -> list[dict[str, Any]]:
    """Random tasks with distances and shifts, some of which nothing fulfils."""
    rng, stated = Random(seed), []
    for k in range(number):
        least = rng.randint(12, 22)
        statement: dict[str, Any] = {
            "kind": "gear_train",
            "ratio": f"{rng.randint(100, 240)}/{rng.randint(100, 240)}",
            "max_stages": rng.choice([1, 2, 2]),
            "teeth": {"min": least, "max": least + rng.randint(6, 14)},
            "modules": sorted(rng.sample([1.0, 1.25, 1.5, 2.0, 2.5], rng.randint(1, 3))),
            "pressure_angle": rng.choice([20.0, 20.0, 25.0]),
            "max_designs": 3,
        }
        mean = statement["modules"][0] * (2 * least + 10)
        middle = round(0.5 * mean * rng.uniform(0.95, 1.35), 2)
        sort = k % 5
        if sort == 0:
            statement["centre_distance"] = middle
        elif sort == 1:
            statement["centre_distance"] = {"min": middle, "max": round(middle + rng.uniform(0.05, 3.0), 2)}
        elif sort == 2:
            statement["centre_distance"] = [
                round(middle * rng.uniform(0.95, 1.1), 2) for _ in range(statement["max_stages"])
            ]
        elif sort == 3:
            statement["shift"] = {"min": round(rng.uniform(-0.4, 0.0), 2), "max": round(rng.uniform(0.0, 0.6), 2)}
        else:
            statement["centre_distance"] = float(middle)
            statement["shift"] = {"min": round(rng.uniform(-0.3, 0.0), 2), "max": round(rng.uniform(0.1, 0.8), 2)}
            statement["min_tip_thickness"] = round(rng.uniform(0.2, 0.6), 2)
            statement["min_contact_ratio"] = round(rng.uniform(1.1, 1.6), 2)
        if statement["max_stages"] == 2 and sort != 2 and rng.random() < 0.5:
            statement["reverted"] = True
        if rng.random() < 0.3:
            statement["tolerance"] = 10.0 ** rng.randint(-5, -2)
        stated.append(statement)
    return stated
