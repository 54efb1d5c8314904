"""Gear trains of the textbooks: ratios, distances, exhaustive lists, best trains."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from kinematics.gear.train import OrdinaryTrain, TrainStage
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search.search import Outcome, search
from synthesis.kinds.gear_train.search.task import build_task
from synthesis.kinds.gear_train.solver import solve_gear_train
from synthesis.model.gears.ratio_target import parse_target
from tests.cases import Case, cases


def silent(fraction: float, message: str) -> None:
    pass


def found(ratio: str, tolerance: Fraction | None, wanted: int, **fields: object) -> Outcome:
    problem = GearTrainProblem(kind="gear_train", ratio=ratio, **fields)
    return search(build_task(problem, False), tolerance, wanted, silent)


def only(case: Case, **values: object) -> None:
    """Compare the expected values of these names; the others belong to a book's own algorithm."""
    wrong = {name: value for name, value in values.items() if not case.expected[name].agrees(value)}
    assert not wrong, f"{case.id}: found {wrong}, expected {[case.expected[name] for name in wrong]}"


def book_train(case: Case) -> OrdinaryTrain:
    x = case.inputs
    pitches = x.get("pd", 1.0)
    pitches = pitches if isinstance(pitches, list) else [pitches] * len(x["drivers"])
    meshes = zip(x["drivers"], x["driven"], pitches, strict=True)
    return OrdinaryTrain(tuple(TrainStage(a, b, 1.0 / pitch) for a, b, pitch in meshes), math.radians(25.0))


@pytest.mark.parametrize("case", cases("train", "gear"))
def test_train(case: Case) -> None:
    train = book_train(case)
    values: dict[str, float] = {"ratio": abs(float(train.ratio))}
    for number, (stage, distance) in enumerate(zip(train.stages, train.centre_distances, strict=True), 1):
        values[f"r{number}"] = stage.driven / stage.driver
        values[f"K{number}"] = stage.driver + stage.driven
        values[f"C{number}"] = distance
        values[f"d_driver{number}"] = stage.driver * stage.module
        values[f"d_driven{number}"] = stage.driven * stage.module
    if "x0" in case.expected:
        values["x0"], values["x1"] = (1.0 / values[f"r{number}"] for number in (5, 8))
    case.check(**values)


@pytest.mark.parametrize("case", cases("simple_train", "gear"))
def test_idlers_change_only_the_direction(case: Case) -> None:
    first, *idlers, last = case.inputs["N"]
    train = OrdinaryTrain((TrainStage(first, last, 1.0, tuple(idlers)),))
    case.check(m_V=float(1 / train.ratio))


@pytest.mark.parametrize("case", cases("same_pair_power", "gear"))
def test_equal_stages(case: Case) -> None:
    x = case.inputs
    ratio = abs(float(OrdinaryTrain((TrainStage(x["driver"], x["driven"]),) * x["k"]).ratio))
    case.check(ratio=ratio, error_percent=100.0 * abs(ratio / x["ratio"] - 1.0))


@pytest.mark.parametrize("case", cases("table_rows", "gear"))
def test_table_of_trains(case: Case) -> None:
    target = parse_target(case.inputs["target"])[1].rational
    values: dict[str, float] = {}
    for number, (a, b, c, d) in enumerate(case.inputs["rows"], 1):
        ratio = OrdinaryTrain((TrainStage(a, b), TrainStage(c, d))).ratio
        values[f"r1_{number}"], values[f"r2_{number}"], values[f"m_{number}"] = b / a, d / c, float(ratio)
        values[f"err_{number}"] = abs(float(ratio - target))
        values[f"serr_{number}"] = float(target - ratio)
        values[f"pct_{number}"] = 100.0 * float(target - ratio) / float(target)
    case.check(**values)


@pytest.mark.parametrize("case", cases("two_stage_set", "gear"))
def test_list_is_exhaustive(case: Case) -> None:
    """All trains within an absolute error, against the printed list of them."""
    x = case.inputs
    target = parse_target(x["target"])[1]
    low, high = target.enclose(200)
    tolerance = Fraction(x["eps"]) / ((low + high) / 2)
    outcome = found(x["target"], tolerance, 100, max_stages=2, teeth={"min": x["lo"], "max": x["hi"]})
    trains = {(tuple(sorted(t.drivers)), tuple(sorted(t.driven))) for t in outcome.trains if len(t.drivers) == 2}
    printed = {(tuple(sorted((a, c))), tuple(sorted((b, d)))) for a, b, c, d in x["rows"]}
    values = {
        "n": len(trains),
        "listed": len(trains & printed),
        "missing": len(trains - printed),
        "extra": len(printed - trains),
    }
    only(case, **{name: value for name, value in values.items() if name in case.expected})


@pytest.mark.parametrize("case", cases("best_two", "gear"))
def test_best_train(case: Case) -> None:
    x = case.inputs
    problem = GearTrainProblem(
        kind="gear_train", ratio=x["target"], max_stages=2, teeth={"min": x["lo"], "max": x["hi"]}
    )
    result = solve_gear_train(problem, silent)
    best = result.designs[0]
    ratio, stages = best.mechanism.ratio, best.mechanism.stages
    case.check(
        abs_error=abs(best.metrics.error),
        rel_error=abs(best.metrics.relative_error),
        fraction=f"{abs(ratio.numerator)}/{ratio.denominator}",
        n=result.search.ties,
        teeth=[sorted(s.driver for s in stages), sorted(s.driven for s in stages)],
    )
    assert result.search.complete
    assert best.verification.passed


@pytest.mark.parametrize("case", cases("reverted_better", "gear"))
def test_reverted_trains_nearer_than_the_book_s(case: Case) -> None:
    x = case.inputs
    tolerance = Fraction(x["than"]) / Fraction(x["target"])
    teeth = {"min": x["lo"], "max": x["hi"]}
    case.check(n=len(found(x["target"], tolerance, 100, max_stages=2, teeth=teeth, reverted=True).trains))


@pytest.mark.slow
@pytest.mark.parametrize("case", cases("norton_defect", "gear"))
@pytest.mark.campaign
def test_exhaustive_where_the_book_s_loop_is_not(case: Case) -> None:
    x = case.inputs
    target = Fraction(x["target"])
    teeth = {"min": x["lo"], "max": x["hi"]}
    eps = Fraction(case.expected["eps_used"].value).limit_denominator(10**9) if "eps_used" in case.expected else None
    outcome = found(x["target"], (eps or Fraction(x["eps"])) / target, 20000, max_stages=2, teeth=teeth)
    only(case, exhaustive=sum(len(train.drivers) == 2 for train in outcome.trains))


@pytest.mark.parametrize("case", cases("reverted_exact", "gear"))
def test_exact_reverted_trains(case: Case) -> None:
    x = case.inputs
    teeth = {"min": x["lo"], "max": x["hi"]}
    outcome = found(str(x["ratio"]), Fraction(0), 200, max_stages=2, teeth=teeth, reverted=True)
    best = outcome.trains[0]
    sums = [sum(mesh) for mesh in best.meshes]
    assert len(set(sums)) == 1
    case.check(n=len(outcome.trains), K_min=sums[0], teeth_min=sorted(list(mesh) for mesh in best.meshes))
    assert outcome.ties == len(outcome.trains)


@pytest.mark.parametrize("case", cases("clock_train", "gear"))
def test_clock_train(case: Case) -> None:
    x = case.inputs
    problem = GearTrainProblem(
        kind="gear_train",
        ratio=12,
        max_stages=2,
        teeth={"min": x["lo"], "max": x["hi"]},
        reverted=True,
        tolerance=0.0,
        diametral_pitch=float(x["pd"]),
        pressure_angle=float(x["phi"]),
        length_unit="in",
        max_designs=100,
    )
    result = solve_gear_train(problem, silent)
    best = result.designs[0]
    distance = best.metrics.centre_distances[0]
    # Norton, eq. 9.4: the working pressure angle of shafts that are off by dC.
    train = book_train(Case("", "", "", "", "", {"drivers": [12], "driven": [48], "pd": x["pd"]}, {}))
    mesh = train.meshes[0][0]
    angles = [
        math.degrees(type(mesh)(mesh.pinion, mesh.gear, distance + shift).pressure_angle)
        for shift in (x["dC"], -x["dC"])
    ]
    case.check(
        n=len(result.designs),
        K=best.mechanism.stages[0].driver + best.mechanism.stages[0].driven,
        C=distance,
        teeth=sorted([s.driver, s.driven] for s in best.mechanism.stages),
        phi_plus=angles[0],
        phi_minus=angles[1],
    )


@pytest.mark.parametrize("case", cases("exact_min_teeth", "gear"))
def test_least_teeth(case: Case) -> None:
    x = case.inputs
    problem = GearTrainProblem(
        kind="gear_train",
        ratio=float(x["ratio"]),
        max_stages=x["stages"],
        teeth={"min": x["lo"], "max": x["hi"]},
        max_stage_ratio=float(x["max_stage"]),
        rank_by="size",
        tolerance=0.0,
    )
    result = solve_gear_train(problem, silent)
    case.check(total=result.designs[0].metrics.total_teeth)


@pytest.mark.parametrize("case", cases("stock_ok", "gear"))
def test_change_gears(case: Case) -> None:
    """The book's choice, and whether it is among those of a stock that has each wheel once."""
    x = case.inputs
    meshes = list(zip(x["drivers"], x["driven"], strict=True))
    ratio = abs(OrdinaryTrain(tuple(TrainStage(a, b) for a, b in meshes)).ratio)
    gears = x["drivers"] + x["driven"]
    repeats = len(gears) - len(set(gears))
    case.check(
        ratio=float(ratio),
        exact=ratio == Fraction(x["target"]),
        in_stock=set(gears) <= set(x["stock"]),
        repeats=repeats,
    )
    outcome = found(x["target"], Fraction(0), 200, max_stages=2, stock=x["stock"])
    key = sorted(x["drivers"]), sorted(x["driven"])
    sets = [(sorted(train.drivers), sorted(train.driven)) for train in outcome.trains]
    assert (key in sets) == (repeats == 0)
