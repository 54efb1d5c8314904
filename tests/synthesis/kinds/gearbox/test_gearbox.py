"""Machine-tool and layshaft gearboxes: plain loops over all teeth, the books' boxes, impossible and broken ones."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from kinematics.gear.gearbox import list_spindle_speeds
from kinematics.gear.teeth import Gear, Mesh
from synthesis.dispatch import solve
from synthesis.kinds.gearbox.design import GearboxResult
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.gearbox.stages import select_undominated
from synthesis.kinds.gearbox.structures import Group, format_formula, list_structures
from synthesis.kinds.gearbox.verification import verify
from synthesis.kinds.layshaft_gearbox.design import LayshaftResult
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem
from synthesis.kinds.layshaft_gearbox.verification import verify as verify_layshaft
from synthesis.registry import parse_problem


def gearbox_problem(**stated: Any) -> GearboxProblem:
    problem = parse_problem({"kind": "gearbox", **stated})
    assert isinstance(problem, GearboxProblem)
    return problem


def gearbox(**stated: Any) -> GearboxResult:
    result = solve(gearbox_problem(**stated), lambda fraction, message: None)
    assert isinstance(result, GearboxResult)
    assert result.search.complete
    assert all(design.verification.passed for design in result.designs)
    return result


def layshaft_problem(**stated: Any) -> LayshaftProblem:
    problem = parse_problem({"kind": "layshaft_gearbox", **stated})
    assert isinstance(problem, LayshaftProblem)
    return problem


def layshaft(**stated: Any) -> LayshaftResult:
    result = solve(layshaft_problem(**stated), lambda fraction, message: None)
    assert isinstance(result, LayshaftResult)
    assert result.search.complete
    assert all(design.verification.passed for design in result.designs)
    return result


@pytest.mark.parametrize(
    ("count", "most", "expected"), [(6, 3, 4), (12, 3, 18), (18, 3, 18), (4, 4, 3), (16, 2, 24), (7, 3, 0)]
)
def test_number_of_structures(count: int, most: int, expected: int) -> None:
    """Orders of the factors times orders of the characteristics (Acherkan: 18 structures of 12 speeds)."""
    found = list_structures(count, most)
    assert len(found) == expected
    assert len(set(found)) == expected


@pytest.mark.parametrize("count", [4, 6, 8, 9, 12, 16, 18, 24])
def test_every_structure_gives_every_speed_once(count: int) -> None:
    for structure in list_structures(count, 4):
        steps = itertools.product(*(range(group.pairs) for group in structure))
        places = [sum(k * group.characteristic for k, group in zip(step, structure, strict=True)) for step in steps]
        assert sorted(places) == list(range(count))
    assert format_formula((Group(3, 1), Group(1, 1), Group(2, 3))) == "3(1) 1 2(3)"


def brute(problem: GearboxProblem, shape: tuple[int, ...]) -> dict[int, float]:
    """Least largest deviation of every total tooth sum, by plain loops over all teeth of all stages."""
    low, high = problem.teeth.min, problem.teeth.max
    least, most = problem.stage_ratio.min, problem.stage_ratio.max
    stages = []
    for pairs in shape:
        own = []
        for total in range(problem.tooth_sum.min, problem.tooth_sum.max + 1):
            drivers = [
                z
                for z in range(low, high + 1)
                if low <= total - z <= high
                and least - 1e-12 <= z / (total - z) <= most + 1e-12
                and not Mesh(Gear(z, 1.0), Gear(total - z, 1.0)).interferes
            ]
            own += [(total, chosen) for chosen in itertools.combinations(drivers, pairs)]
        stages.append(own)
    nominal = np.log(problem.speeds.nominal)
    found: dict[int, float] = {}
    for boxes in itertools.product(*stages):
        speeds = np.array([math.log(problem.input_speed)])
        for total, drivers in boxes:
            level = np.log([z / (total - z) for z in drivers])
            speeds = (speeds[:, None] + level).reshape(-1)
        error = float(np.abs(np.sort(speeds) - nominal).max())
        size = sum(total for total, _ in boxes)
        found[size] = min(error, found.get(size, math.inf))
    return found


@pytest.mark.campaign
@pytest.mark.parametrize(
    ("speeds", "shapes", "teeth", "sums"),
    [
        ({"min": 60.0, "ratio": 1.41, "count": 4}, [(2, 2)], (18, 29), (44, 47)),
        ({"min": 60.0, "ratio": 1.3, "count": 4}, [(2, 2)], (18, 31), (47, 49)),
        ({"min": 70.0, "ratio": 1.25, "count": 6}, [(2, 3), (3, 2)], (18, 29), (46, 47)),
    ],
)
def test_against_plain_loops(
    speeds: dict[str, Any], shapes: list[tuple[int, ...]], teeth: tuple[int, int], sums: tuple[int, int]
) -> None:
    stated: dict[str, Any] = {
        "input_speed": 150.0,
        "speeds": speeds,
        "teeth": {"min": teeth[0], "max": teeth[1]},
        "tooth_sum": {"min": sums[0], "max": sums[1]},
        "tolerance": 0.24 * math.log(speeds["ratio"]),
        "max_designs": 200,
    }
    result = gearbox(**stated)
    best: dict[int, float] = {}
    for shape in shapes:
        for size, error in brute(gearbox_problem(**stated), shape).items():
            best[size] = min(error, best.get(size, math.inf))
    front: list[tuple[int, float]] = []
    for size in sorted(best):
        if (not front or best[size] < front[-1][1] - 1e-12) and best[size] <= stated["tolerance"]:
            front.append((size, best[size]))
    own: list[tuple[int, float]] = []
    for size, error in sorted((design.metrics.tooth_sum, design.metrics.max_error) for design in result.designs):
        if not own or error < own[-1][1] - 1e-12:
            own.append((size, error))
    assert own == [(size, pytest.approx(error, abs=1e-12)) for size, error in front]


def test_what_is_worth_having() -> None:
    """Every row left out has one of no greater size that can take its place; none that stays has."""
    rng = np.random.default_rng(5)
    middle, half = rng.uniform(-1.0, 1.0, 400), rng.uniform(0.0, 0.3, 400)
    size = rng.integers(10, 20, 400)
    kept = select_undominated(middle, half, size)
    serves = (half + np.abs(middle - middle[:, None]) <= half[:, None] + 1e-15) & (size <= size[:, None])
    np.fill_diagonal(serves, False)
    assert not serves[np.ix_(kept, kept)].any()
    assert serves[np.ix_(np.setdiff1d(np.arange(400), kept), kept)].any(axis=1).all()


def test_the_books_headstock_is_beaten() -> None:
    """Rao, Solved Problem 8.9: 18 speeds from 352 rev/min; its teeth 24/71 ... 31/25 are off by 0.43 %."""
    book = [[(24, 71), (67, 28)], [(26, 50), (38, 38), (50, 26)], [(25, 31), (28, 28), (31, 25)]]
    stated: dict[str, Any] = {
        "input_speed": 352.0,
        "speeds": {"min": 50.0, "max": 2000.0, "count": 18},
        "tooth_sum": {"min": 50, "max": 100},
        "stage_ratio": {"min": 0.25, "max": 2.5},
    }
    nominal = gearbox_problem(**stated).speeds.nominal
    errors = [abs(math.log(float(s.speed) / n)) for s, n in zip(list_spindle_speeds(352, book), nominal, strict=True)]
    result = gearbox(**stated, max_designs=200)
    assert result.designs[0].metrics.max_error < max(errors)
    assert any(
        design.metrics.max_error <= max(errors) and design.metrics.tooth_sum <= 95 + 76 + 56
        for design in result.designs
    )
    assert len(result.structures) == 18


def test_the_books_six_speeds_are_met_exactly() -> None:
    """Rao, Solved Problem 8.8, with the book's limits: tooth sums up to 120."""
    result = gearbox(
        input_speed=200.0, speeds={"min": 25.0, "max": 800.0, "count": 6}, tooth_sum={"min": 80, "max": 120}
    )
    best = result.designs[0]
    assert best.metrics.max_error == 0.0
    assert best.metrics.tooth_sum < 120 + 90
    assert [speed.speed for speed in best.metrics.speeds] == [25.0, 50.0, 100.0, 200.0, 400.0, 800.0]
    assert best.mechanism.formula == "3(1) 2(3)"
    assert best.metrics.shafts[1].speeds == [100.0, 200.0, 400.0]


def test_gearboxes_without_a_formula_are_not_promised() -> None:
    """There are others beyond a quarter of a step, and where a stage of four pairs stands beside another."""
    speeds = {"min": 50.0, "ratio": 1.26, "count": 8}
    for complete, stated in (
        (True, {}),
        (False, {"structure": [4, 2]}),
        (False, {"tolerance": 0.06}),
        (True, {"tolerance": 0.057}),
    ):
        problem = gearbox_problem(input_speed=200.0, speeds=speeds, tooth_sum={"min": 60, "max": 62}, **stated)
        result = solve(problem, lambda fraction, message: None)
        assert result.search.complete == complete
        assert ("not searched" in result.summary) != complete
    single = gearbox(input_speed=100.0, speeds={"min": 50.0, "ratio": 1.26, "count": 4}, structure=[4])
    assert single.search.complete


@pytest.mark.campaign
def test_a_wide_statement_tells_how_far_it_is() -> None:
    """Progress goes on within a structure."""
    problem = gearbox_problem(
        input_speed=352.0,
        speeds={"min": 50.0, "ratio": 1.2423, "count": 18},
        structure=[3, 3, 2],
        teeth={"min": 12, "max": 160},
        tooth_sum={"min": 40, "max": 160},
        stage_ratio={"min": 0.1, "max": 4.0},
    )
    told: list[float] = []
    result = solve(problem, lambda fraction, message: told.append(fraction))
    assert result.search.complete
    assert told == sorted(told)
    assert len(told) > 20
    assert max(after - before for before, after in itertools.pairwise(told)) < 0.2


def test_stated_structure_cluster_and_series() -> None:
    stated: dict[str, Any] = {
        "input_speed": 250.0,
        "speeds": {"min": 50.0, "series": "R10", "count": 6},
        "tooth_sum": {"min": 60, "max": 80},
    }
    result = gearbox(**stated, structure=[3, 1, 2], cluster_difference=4, max_designs=200)
    for design in result.designs:
        assert [len(stage.pairs) for stage in design.mechanism.stages] == [3, 1, 2]
        drivers = sorted(pair.driver for pair in design.mechanism.stages[0].pairs)
        assert drivers[2] - drivers[1] >= 4
        assert [speed.standard for speed in design.metrics.speeds] == [50.0, 63.0, 80.0, 100.0, 125.0, 160.0]
    by_size = gearbox(**stated, rank_by="size", max_designs=200)
    sizes = [design.metrics.tooth_sum for design in by_size.designs]
    assert sizes == sorted(sizes)


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        ({"speeds": {"min": 50.0, "ratio": 1.26, "count": 7}}, "cannot be made"),
        ({"speeds": {"min": 50.0, "ratio": 1.41, "count": 16}, "max_pairs": 2}, "No gearbox (24 structures"),
        ({"speeds": {"min": 0.5, "ratio": 1.26, "count": 6}}, "No gearbox (4 structures"),
        (
            {"speeds": {"min": 50.0, "ratio": 1.26, "count": 6}, "teeth": {"min": 30, "max": 31}},
            "No gearbox (4 structures",
        ),
    ],
)
def test_impossible_gearboxes_are_proven(stated: dict[str, Any], words: str) -> None:
    result = gearbox(input_speed=100.0, **stated)
    assert not result.designs
    assert words in result.summary


@pytest.mark.parametrize(
    ("stated", "path"),
    [
        ({"structure": [2, 2]}, "/structure"),
        ({"structure": [1, 1, 3, 2]}, "/structure"),
        ({"structure": [3, 2], "fixed_stage": True}, "/fixed_stage"),
        ({"teeth": {"min": 40, "max": 30}}, "/teeth/max"),
        ({"tooth_sum": {"min": 90, "max": 500}}, "/tooth_sum/max"),
        ({"tooth_sum": {"min": 20, "max": 400}, "teeth": {"min": 5, "max": 395}}, "/tooth_sum/max"),
        ({"tolerance": 0.116}, "/tolerance"),
        ({"speeds": {"min": 1.0, "ratio": 9.0, "count": 8}}, "/speeds"),
    ],
)
def test_contradictions_name_their_field(stated: dict[str, Any], path: str) -> None:
    problem = gearbox_problem(**{"input_speed": 100.0, "speeds": {"min": 50.0, "ratio": 1.26, "count": 6}} | stated)
    assert [found.path for found in problem.find_contradictions()] == [path]


def test_broken_gearboxes_do_not_pass() -> None:
    stated: dict[str, Any] = {"input_speed": 200.0, "speeds": {"min": 25.0, "max": 800.0, "count": 6}}
    problem = gearbox_problem(**stated)
    good = gearbox(**stated).designs[0].mechanism

    def failing(
        demands: GearboxProblem = problem, driver: int = 0, driven: int = 0, input_speed: float = 200.0
    ) -> set[str]:
        stage = good.stages[0]
        pair = stage.pairs[0]
        pair = pair.model_copy(update={"driver": pair.driver + driver, "driven": pair.driven + driven})
        stages = [stage.model_copy(update={"pairs": [pair, *stage.pairs[1:]]}), *good.stages[1:]]
        changed = good.model_copy(update={"stages": stages, "input_speed": input_speed})
        return {check.name for check in verify(demands, changed).checks if not check.passed}

    assert failing() == set()
    assert "equal_tooth_sums" in failing(driver=1)
    assert "speeds" in failing(driver=8, driven=-8)
    assert failing(input_speed=260.0) == {"speeds"}
    assert failing(gearbox_problem(**stated, teeth={"min": 30, "max": 96})) == {"tooth_limits"}
    assert failing(gearbox_problem(**stated, stage_ratio={"min": 0.6, "max": 2.0})) == {"stage_ratios"}
    assert failing(gearbox_problem(**stated, structure=[2, 3])) == {"structure"}
    assert failing(gearbox_problem(**stated, cluster_difference=20)) == {"cluster_difference"}
    assert "interference" in failing(driver=-17, driven=17)


def brute_layshaft(problem: LayshaftProblem) -> dict[int, Fraction]:
    """Least largest error of every tooth sum, by plain loops in exact fractions."""
    low, high = problem.teeth.min, problem.teeth.max
    targets = [Fraction(str(ratio)) for ratio in problem.ratios if ratio != 1.0]
    found = {}
    for size in range(problem.tooth_sum.min, problem.tooth_sum.max + 1):
        own = [z for z in range(low, high + 1) if low <= size - z <= high]
        back = {
            Fraction(g, e)
            for e, g in itertools.product(range(low, high + 1), repeat=2)
            if e + g + 4 < size and any(e + 2 * f + g >= size for f in range(low, high + 1))
        }
        best = None
        for a in own:
            turned = Fraction(size - a, a)
            errors = [min(abs(turned * Fraction(size - c, c) / t - 1) for c in own) for t in targets]
            if problem.reverse is not None:
                errors.append(min(abs(turned * q / Fraction(str(problem.reverse)) - 1) for q in back))
            best = max(errors) if best is None else min(best, max(errors))
        if best is not None:
            found[size] = best
    return found


@pytest.mark.campaign
@pytest.mark.parametrize("reverse", [None, 3.1])
def test_layshaft_against_plain_loops(reverse: float | None) -> None:
    stated: dict[str, Any] = {
        "ratios": [3.4, 2.05, 1.37, 1.0, 0.82],
        "reverse": reverse,
        "teeth": {"min": 14, "max": 36},
        "tooth_sum": {"min": 44, "max": 52},
        "interference": "report",
        "max_designs": 200,
    }
    result = layshaft(**stated)
    best = brute_layshaft(layshaft_problem(**stated))
    front: list[tuple[int, Fraction]] = []
    for size, error in sorted(best.items()):
        if not front or error < front[-1][1]:
            front.append((size, error))
    assert [(one.tooth_sum, one.max_error) for one in result.pareto] == [(s, pytest.approx(float(e))) for s, e in front]
    assert result.designs[0].metrics.max_error == pytest.approx(float(min(best.values())))
    errors = [design.metrics.max_error for design in result.designs]
    assert errors == sorted(errors)


@pytest.mark.slow
def test_layshaft_demands() -> None:
    stated: dict[str, Any] = {"ratios": [3.5, 2.1, 1.4, 1.0], "reverse": 3.3}
    by_size = layshaft(**stated, rank_by="size", tolerance=0.02, max_designs=50)
    sizes = [design.metrics.tooth_sum for design in by_size.designs]
    assert sizes == sorted(set(sizes))
    assert all(design.metrics.max_error <= 0.02 for design in by_size.designs)
    assert not by_size.designs[0].metrics.interfering
    assert by_size.designs[0].mechanism.reverse is not None
    geared = layshaft(ratios=[2.0, 1.0], direct=False).designs[0].mechanism
    assert geared.gears[1].layshaft is not None
    none = layshaft(**stated, tolerance=1e-9)
    assert not none.designs
    assert "the best has an error of" in none.summary
    narrow = layshaft(**stated, teeth={"min": 40, "max": 41}, tooth_sum={"min": 50, "max": 60})
    assert "No gearbox keeps the limits" in narrow.summary
    paths = [found.path for found in layshaft_problem(ratios=[2.0, 2.5], rank_by="size").find_contradictions()]
    assert paths == ["/ratios/1", "/tolerance"]


def test_broken_layshaft_gearboxes_do_not_pass() -> None:
    stated: dict[str, Any] = {"ratios": [3.5, 2.1, 1.4, 1.0], "reverse": 3.3, "tolerance": 0.01}
    problem = layshaft_problem(**stated)
    good = layshaft(**stated).designs[0].mechanism
    assert good.reverse is not None

    def failing(demands: LayshaftProblem = problem, **changed: Any) -> set[str]:
        checks = verify_layshaft(demands, good.model_copy(update=changed)).checks
        return {check.name for check in checks if not check.passed}

    assert failing() == set()
    first = good.gears[0]
    assert first.layshaft is not None
    moved = first.model_copy(update={"layshaft": first.layshaft + 1})
    assert failing(gears=[moved, *good.gears[1:]]) == {"ratios", "equal_tooth_sums"}
    assert "ratios" in failing(gears=good.gears[1:])
    assert "ratios" in failing(reverse=None)
    assert "reverse_fits" in failing(
        reverse=good.reverse.model_copy(update={"layshaft": 5, "idler": 5, "mainshaft": 5})
    )
    big = good.reverse.model_copy(update={"layshaft": 60, "mainshaft": 60})
    assert "reverse_fits" in failing(reverse=big)
    assert "interference" in failing(head=good.head.model_copy(update={"driver": 8}))
    assert failing(layshaft_problem(**stated, teeth={"min": 30, "max": 80})) == {"tooth_limits"}
