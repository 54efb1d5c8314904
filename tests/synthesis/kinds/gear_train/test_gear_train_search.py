"""The search for tooth numbers against plain exhaustive search in Python's fractions and in numpy."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
import pytest

from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search import candidates
from synthesis.kinds.gear_train.search.search import Outcome, search
from synthesis.kinds.gear_train.search.task import build_task
from synthesis.model.gears.ratio_target import parse_target


def problem(**fields: object) -> GearTrainProblem:
    return GearTrainProblem(kind="gear_train", **fields)


def searched(wanted: int = 10, **fields: object) -> Outcome:
    stated = problem(**fields)
    stated.require_consistent()
    task = build_task(stated, stated.hunting_tooth == "require")
    return search(task, stated.exact_tolerance, wanted, lambda fraction, message: None)


class Plain:
    """Every train of one or two stages as integers: products of the driven gears and of the drivers, and the size."""

    def __init__(self, low: int, high: int) -> None:
        columns = []
        for k in (1, 2):
            gears = np.array(list(itertools.combinations_with_replacement(range(low, high + 1), k)))
            first, second = np.meshgrid(np.arange(len(gears)), np.arange(len(gears)), indexing="ij")
            products, sums = gears.prod(axis=1), gears.sum(axis=1)
            columns.append((products[first], products[second], sums[first] + sums[second]))
        self.over, self.under, self.size = (np.concatenate([c[i].ravel() for c in columns]) for i in range(3))

    def ranked(self, ratio: str, wanted: int) -> list[tuple[Fraction, int]]:
        """Error and size of the best trains; a rational target."""
        target = parse_target(ratio)[1].rational
        assert target is not None
        error = np.abs(self.over * target.denominator - self.under * target.numerator) / self.under
        bound = np.partition(error, wanted)[wanted]
        near = np.flatnonzero(error <= bound * (1.0 + 1e-9))
        exact = [Fraction(int(self.over[i]), int(self.under[i])) for i in near]
        found = [(abs(value - target) / target, int(self.size[i])) for value, i in zip(exact, near, strict=True)]
        return sorted(found)[:wanted]


@pytest.fixture(scope="module")
def plain() -> Plain:
    return Plain(12, 40)


@pytest.mark.parametrize("fields", [{}, {"rank_by": "size", "tolerance": 0.01}, {"size": "largest_gear"}])
@pytest.mark.parametrize("ratio", ["pi", "29/11"])
def test_finishing_at_once_is_the_same(ratio: str, fields: dict[str, object], monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    for many in (0, 10**18):
        monkeypatch.setattr(candidates, "MIN_SORTED_TRAINS", many)
        found.append(searched(wanted=25, ratio=ratio, max_stages=3, teeth={"min": 12, "max": 40}, **fields))
    assert found[0] == found[1]
    assert len(found[0].pareto) > 4


@pytest.mark.campaign
def test_two_stages_against_plain_search(plain: Plain) -> None:
    """200 random targets: the ten best by error and size."""
    rng = np.random.default_rng(1)
    for value in np.exp(rng.uniform(np.log(1 / 10), np.log(10), 200)):
        ratio = f"{value:.6f}"
        outcome = searched(ratio=ratio, max_stages=2, teeth={"min": 12, "max": 40})
        target = parse_target(ratio)[1].rational
        found = [(abs(train.ratio - target) / target, train.size(False)) for train in outcome.trains]
        assert found == plain.ranked(ratio, 10)[: len(found)], ratio
        assert found


def best_of_three(target: float, low: int, high: int) -> float:
    """Least error of three stages by another way: all pairs of meshes, sorted, and the third mesh by bisection."""
    gears = np.arange(low, high + 1)
    meshes = np.unique((gears[:, None] / gears[None, :]).round(15))
    pairs = np.unique(np.multiply.outer(meshes, meshes)[np.triu_indices(len(meshes))].round(15))
    at = np.searchsorted(pairs, target / meshes)
    best = math.inf
    for shift in (-1, 0):
        near = pairs[np.clip(at + shift, 0, len(pairs) - 1)] * meshes
        best = min(best, float(np.abs(near / target - 1.0).min()))
    return best


def test_three_stages_against_meshes_by_bisection() -> None:
    rng = np.random.default_rng(2)
    for value in np.exp(rng.uniform(np.log(1 / 30), np.log(30), 12)):
        best = searched(ratio=float(value), max_stages=3, teeth={"min": 12, "max": 45}).trains[0]
        error = abs(parse_target(float(value))[1].compute_relative_error(best.ratio))
        assert error == pytest.approx(best_of_three(float(value), 12, 45), abs=3e-14)


@pytest.mark.campaign
def test_three_stages_of_the_usual_range() -> None:
    rng = np.random.default_rng(3)
    for value in np.exp(rng.uniform(np.log(1 / 100), np.log(100), 12)):
        best = searched(ratio=float(value), max_stages=3, teeth={"min": 12, "max": 100}).trains[0]
        error = abs(parse_target(float(value))[1].compute_relative_error(best.ratio))
        assert error == pytest.approx(best_of_three(float(value), 12, 100), abs=3e-14)


def gears_of(train: Sequence[tuple[int, int, int]], reverted: bool) -> tuple[object, ...]:
    """What tells a train (driver, driven gear, module of each stage) from others."""
    if reverted:
        return tuple(sorted(train))
    return tuple(sorted(a for a, _, _ in train)), tuple(sorted(b for _, b, _ in train))


def brute(
    stated: GearTrainProblem, stages: tuple[int, ...], ranges: list[range]
) -> tuple[list[tuple[Fraction, int]], dict[int, Fraction], int, dict[tuple[object, ...], Fraction]]:
    """Errors and sizes of every train that keeps the demands, least error by size, and the number of the nearest.

    And of every choice of gears the smallest largest stage ratio of all pairings.
    ``ranges`` are the tooth numbers of all positions; the demands are read from the statement and tried anew.
    """
    target = stated.target.rational
    assert target is not None
    seen: dict[tuple[object, ...], tuple[Fraction, int]] = {}
    pairings: dict[tuple[object, ...], Fraction] = {}
    limit = stated.max_stage_ratio and Fraction(str(stated.max_stage_ratio))
    stock = stated.count_stock()
    modules = stated.list_exact_modules()
    for k in stages:
        meshes = [
            [(a, b, m) for a in ranges[2 * i] for b in ranges[2 * i + 1] for m in range(len(modules))]
            if stated.reverted
            else [(a, b, 0) for a in ranges[2 * i] for b in ranges[2 * i + 1]]
            for i in range(k)
        ]
        for train in itertools.product(*meshes):
            gears = [n for a, b, _ in train for n in (a, b)]
            if stock and any(gears.count(n) > stock[n] for n in gears):
                continue
            if limit and any(Fraction(max(a, b), min(a, b)) > limit for a, b, _ in train):
                continue
            if stated.hunting_tooth == "require" and any(math.gcd(a, b) > 1 for a, b, _ in train):
                continue
            if stated.reverted and len({modules[m] * (a + b) for a, b, m in train}) > 1:
                continue
            if stated.max_total_teeth and sum(gears) > stated.max_total_teeth:
                continue
            ratio = Fraction(math.prod(b for _, b, _ in train), math.prod(a for a, _, _ in train))
            key = gears_of(train, stated.reverted)
            widest = max(Fraction(max(a, b), min(a, b)) for a, b, _ in train)
            pairings[key] = min(widest, pairings.get(key, widest))
            seen[key] = (abs(ratio - target) / target, max(gears) if stated.size == "largest_gear" else sum(gears))
    listed = sorted(seen.values())
    least: dict[int, Fraction] = {}
    for error, size in listed:
        least.setdefault(size, error)
    nearest = sum(error == listed[0][0] for error, _ in listed) if listed else 0
    return listed, least, nearest, pairings


SMALL = {"min": 8, "max": 15}
DEMANDS = {
    "plain": {"max_stages": 2, "teeth": SMALL},
    "stage_ratio": {"max_stages": 2, "teeth": SMALL, "max_stage_ratio": 1.3},
    "hunting": {"max_stages": 2, "teeth": SMALL, "hunting_tooth": "require"},
    "total": {"max_stages": 2, "teeth": SMALL, "max_total_teeth": 41},
    "total_largest": {"max_stages": 2, "teeth": SMALL, "max_total_teeth": 41, "size": "largest_gear"},
    "largest": {"max_stages": 2, "teeth": SMALL, "size": "largest_gear"},
    "stock": {"max_stages": 2, "stock": [8, 9, 9, 11, {"teeth": 12, "count": 2}, 15]},
    "stock_hunting": {"max_stages": 2, "stock": [8, 9, 9, 11, 12, 12, 15], "hunting_tooth": "require"},
    "positions": {
        "max_stages": 2,
        "teeth": [{"min": 8, "max": 12}, {"min": 14, "max": 20}, {"min": 8, "max": 10}, {"min": 9, "max": 30}],
    },
    "positions_hunting": {
        "max_stages": 2,
        "teeth": [{"min": 8, "max": 12}, {"min": 14, "max": 20}, {"min": 8, "max": 10}, {"min": 9, "max": 20}],
        "hunting_tooth": "require",
    },
    "positions_alike": {
        "max_stages": 2,
        "teeth": [{"min": 8, "max": 12}, {"min": 8, "max": 14}, {"min": 9, "max": 13}, {"min": 10, "max": 13}],
    },
    "positions_limited": {
        "max_stages": 2,
        "teeth": [{"min": 8, "max": 12}, {"min": 8, "max": 14}, {"min": 9, "max": 13}, {"min": 10, "max": 13}],
        "max_stage_ratio": 1.4,
    },
    "reverted_alike": {
        "max_stages": 2,
        "teeth": [{"min": 8, "max": 12}, {"min": 8, "max": 14}, {"min": 8, "max": 13}, {"min": 8, "max": 13}],
        "reverted": True,
        "module": [1.0, 1.25],
    },
    "reverted": {"max_stages": 2, "teeth": {"min": 8, "max": 17}, "reverted": True},
    "reverted_3": {"max_stages": 3, "teeth": {"min": 8, "max": 12}, "reverted": True},
    "reverted_modules": {"max_stages": 2, "teeth": SMALL, "reverted": True, "module": [1.0, 1.25, 0.8]},
    "reverted_stock": {"max_stages": 2, "stock": [8, 9, 10, 11, 12, 13, 12], "reverted": True},
    "reverted_largest": {"max_stages": 2, "teeth": {"min": 8, "max": 17}, "reverted": True, "size": "largest_gear"},
    "reverted_positions": {
        "max_stages": 2,
        "teeth": [{"min": 8, "max": 12}, {"min": 14, "max": 20}, {"min": 8, "max": 10}, {"min": 14, "max": 30}],
        "reverted": True,
    },
    "by_size": {"max_stages": 2, "teeth": SMALL, "rank_by": "size", "tolerance": 0.004},
    "by_size_limited": {
        "max_stages": 2,
        "teeth": SMALL,
        "rank_by": "size",
        "tolerance": 0.03,
        "hunting_tooth": "require",
    },
    "tolerance": {"max_stages": 2, "teeth": SMALL, "tolerance": 0.0021},
}


@pytest.mark.slow
@pytest.mark.parametrize("demands", DEMANDS.values(), ids=DEMANDS.keys())
@pytest.mark.parametrize(("ratio", "at_once"), [("1", False), ("1.37", True), ("2/3", True), ("2.25", False)])
def test_every_demand_against_plain_search(
    ratio: str, at_once: bool, demands: dict[str, object], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ranking, Pareto set and number of ties of small problems with every demand.

    ``at_once``: what is left is finished in one pass as soon as it can be, as large problems are.
    """
    if at_once:
        monkeypatch.setattr(candidates, "MIN_SORTED_TRAINS", 0)
    stated = problem(ratio=ratio, **demands)
    k = stated.max_stages
    if stated.stock is not None:
        ranges = [sorted(stated.count_stock())] * (2 * k)
    else:
        ranges = [range(low, high + 1) for low, high in stated.list_position_ranges()]
    listed, least, nearest, pairings = brute(stated, (2, 3)[: k - 1] if stated.reverted else (1, 2)[:k], ranges)
    outcome = searched(8, ratio=ratio, **demands)
    tolerance = stated.exact_tolerance
    if tolerance is not None:
        listed = [entry for entry in listed if entry[0] <= tolerance]
    if stated.rank_by == "size":
        listed = sorted(listed, key=lambda entry: (entry[1], entry[0]))
    target = stated.target.rational
    found = [
        (abs(train.ratio - target) / target, train.size(stated.size == "largest_gear")) for train in outcome.trains
    ]
    assert found == listed[: len(found)]
    bound = Fraction(1, 100) if tolerance is None else tolerance
    near = [entry for entry in listed if entry[0] <= bound]
    if near:
        within_reach = outcome.reach is not None and outcome.reach[0] <= target <= outcome.reach[1]
        assert len(found) == min(8, len(listed if tolerance is None and within_reach else near))
        assert outcome.ties == nearest
        front: list[tuple[Fraction, int]] = []
        for size in sorted(least):
            if least[size] <= bound and (not front or least[size] < front[-1][0]):
                front.append((least[size], size))
        pareto = [
            (abs(train.ratio - target) / target, train.size(stated.size == "largest_gear")) for train in outcome.pareto
        ]
        assert pareto == front
    keys = [
        gears_of([(*mesh, mark) for mesh, mark in zip(train.meshes, train.marks, strict=True)], stated.reverted)
        for train in outcome.trains
    ]
    assert len(set(keys)) == len(keys), "the same gears are listed twice"
    for key, train in zip(keys, outcome.trains, strict=True):
        assert max(Fraction(max(mesh), min(mesh)) for mesh in train.meshes) == pairings[key]
        assert all(a in ranges[2 * i] and b in ranges[2 * i + 1] for i, (a, b) in enumerate(train.meshes))
        if stated.max_stage_ratio:
            assert all(max(mesh) <= stated.max_stage_ratio * min(mesh) for mesh in train.meshes)
        if stated.hunting_tooth == "require":
            assert all(math.gcd(*mesh) == 1 for mesh in train.meshes)
        if stated.reverted:
            modules = stated.list_exact_modules()
            marks = zip(train.meshes, train.marks, strict=True)
            assert len({modules[mark] * sum(mesh) for mesh, mark in marks}) == 1
