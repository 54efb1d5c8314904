"""The answers to gear-train problems: demands, reasons, idlers, and the independence of the verification."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from synthesis.dispatch import solve
from synthesis.kinds.gear_train.design import GearTrainMechanism, GearTrainResult, Idler, Stage
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.statement.train import TeethRange
from synthesis.kinds.gear_train.verification import verify
from synthesis.model.gears.answer import Ratio
from synthesis.model.gears.ratio_target import parse_target
from synthesis.registry import parse_problem


def solved(**fields: Any) -> GearTrainResult:
    result = solve(parse_problem({"kind": "gear_train", **fields}), lambda fraction, message: None)
    assert isinstance(result, GearTrainResult)
    assert result.search.complete
    assert all(design.verification.passed for design in result.designs)
    return result


def meshes(result: GearTrainResult, number: int = 0) -> list[tuple[int, int]]:
    return [(stage.driver, stage.driven) for stage in result.designs[number].mechanism.stages]


def test_the_planted_train_is_found() -> None:
    ratio = Fraction(53 * 71 * 89, 17 * 29 * 37)
    result = solved(ratio=f"{ratio.numerator}/{ratio.denominator}", max_stages=3, teeth={"min": 17, "max": 90})
    best = result.designs[0]
    assert best.mechanism.ratio.numerator == -ratio.numerator
    assert best.metrics.relative_error == 0.0
    assert best.metrics.hunting_tooth
    assert result.search.ties == 1


def test_an_idler_turns_the_direction() -> None:
    result = solved(ratio=-70, max_stages=2, teeth={"min": 12, "max": 150})
    best = result.designs[0].mechanism
    assert best.ratio == Ratio(numerator=-70, denominator=1, value=-70.0)
    assert len(best.stages) == 2
    assert len(best.idlers) == 1
    same = solved(ratio=70, max_stages=2, teeth={"min": 12, "max": 150}, direction="same")
    assert same.designs[0].mechanism.idlers == []
    assert same.designs[0].mechanism.ratio.value == 70.0


def test_an_idler_keeps_the_demands_on_meshes() -> None:
    result = solved(
        ratio=-6,
        max_stages=2,
        teeth={"min": 12, "max": 60},
        hunting_tooth="require",
        interference="refuse",
        max_designs=40,
    )
    for design in result.designs:
        assert design.metrics.hunting_tooth
        assert not any(mesh.interferes for mesh in design.metrics.meshes)
        assert len(design.metrics.meshes) == len(design.mechanism.stages) + len(design.mechanism.idlers)


def test_an_idler_comes_from_the_stock() -> None:
    result = solved(ratio=3, direction="same", max_stages=1, stock=[20, 60, 33])
    assert result.designs[0].mechanism.idlers == [Idler(stage=1, teeth=33)]


def test_driver_and_driven_gear_of_an_idler_need_not_mesh() -> None:
    """With a common divisor between themselves, or too different for each other, they mesh with the idler only."""
    hunting = solved(ratio=2, direction="same", max_stages=1, teeth={"min": 12, "max": 24}, hunting_tooth="require")
    assert hunting.search.complete
    assert hunting.search.ties == 1
    (stage,), (idler,) = hunting.designs[0].mechanism.stages, hunting.designs[0].mechanism.idlers
    assert (stage.driver, stage.driven) == (12, 24)
    assert math.gcd(12, idler.teeth) == math.gcd(24, idler.teeth) == 1
    narrow = {"teeth": [{"min": 14, "max": 14}, {"min": 40, "max": 40}], "max_stages": 1, "interference": "refuse"}
    assert solved(ratio="20/7", **narrow).designs == []
    saved = solved(ratio="20/7", direction="same", **narrow).designs[0]
    assert not any(mesh.interferes for mesh in saved.metrics.meshes)


@pytest.mark.parametrize("stock", [[12, 13, 14, 15, 16, 18, 20], [10, 12, 15, 18, 20, 24, 24], [11, 12, 13, 13, 26]])
@pytest.mark.parametrize("ratio", ["-1", "-1.2", "-5/3"])
def test_a_train_that_takes_no_idler_gives_way_to_the_next(stock: list[int], ratio: str) -> None:
    """Every choice of five gears in every order, against the ranking and the count of ties."""
    seen: dict[tuple[object, ...], Fraction] = {}
    for a, b, c, d in itertools.permutations(stock, 4):
        spare = list(stock)
        for n in (a, b, c, d):
            spare.remove(n)
        takes = any(math.gcd(a, n) == math.gcd(n, b) == math.gcd(c, d) == 1 for n in spare)
        if takes:
            error = abs(Fraction(b * d, a * c) / abs(Fraction(ratio)) - 1)
            seen[tuple(sorted((a, c))), tuple(sorted((b, d)))] = error
    one = {Fraction(b, a) for a, b in itertools.permutations(stock, 2) if math.gcd(a, b) == 1}
    errors = sorted([*seen.values(), *(abs(r / abs(Fraction(ratio)) - 1) for r in one)])
    result = solved(ratio=ratio, max_stages=2, stock=stock, hunting_tooth="require", tolerance=0.2, max_designs=1)
    assert result.search.complete
    within = [error for error in errors if error <= Fraction(1, 5)]
    assert [abs(design.metrics.relative_error) for design in result.designs] == pytest.approx(
        [float(error) for error in within[:1]], abs=1e-15
    )
    assert result.search.ties == sum(error == within[0] for error in within)


def test_hunting_teeth_stand_for_both_pairings() -> None:
    result = solved(ratio="841/1000", hunting_tooth="prefer", max_stages=2, stock=[28, 23, 33, 16, 11, 18, 26, 31])
    gears = [
        (sorted(s.driver for s in d.mechanism.stages), sorted(s.driven for s in d.mechanism.stages))
        for d in result.designs
    ]
    assert all(pair not in gears[:k] for k, pair in enumerate(gears))


def test_as_many_trains_as_are_wanted() -> None:
    """Fewer than are wanted lie within the first window of a search without a tolerance."""
    result = solved(ratio="2.51", max_stages=1, teeth={"min": 12, "max": 35}, max_designs=20)
    errors = sorted(abs(Fraction(b, a) / Fraction("2.51") - 1) for a in range(12, 36) for b in range(12, 36))[:20]
    assert [abs(d.metrics.relative_error) for d in result.designs] == pytest.approx([float(e) for e in errors])


def test_reverted_with_modules_of_its_stages() -> None:
    """Rao, Solved Problem 8.5: 20:50 and 25:35 are coaxial if the modules are as 6:7."""
    result = solved(ratio="7/2", max_stages=2, stock=[20, 50, 25, 35], reverted=True, module=[6.0, 7.0], tolerance=0)
    best = result.designs[0]
    assert {(s.driver, s.driven, s.module) for s in best.mechanism.stages} == {(20, 50, 6.0), (25, 35, 7.0)}
    assert best.metrics.centre_distances == [210.0, 210.0]


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"ratio": 1e6, "max_stages": 3}, "out of reach"),
        ({"ratio": 1000, "max_stages": 3, "max_stage_ratio": 5.0}, "0.008 to 125"),
        ({"ratio": 3, "stock": [20]}, "stock of 1 gear is too small"),
        ({"ratio": 3, "direction": "same", "max_stages": 1, "stock": [20, 60]}, "too small"),
        ({"ratio": 3, "stock": [20, 61], "tolerance": 0.001}, "20:61, has a relative error of 0.0167"),
        ({"ratio": -6, "max_stages": 2, "reverted": True}, "allow three stages"),
        ({"ratio": 2, "stock": [20, 40], "hunting_tooth": "require"}, "no two gears"),
        (
            {"ratio": 2, "max_stages": 1, "teeth": {"min": 12, "max": 40}, "max_total_teeth": 30, "tolerance": 0.0},
            "exceeds the tolerance",
        ),
    ],
)
def test_what_cannot_be_is_told_with_the_reason(fields: dict[str, Any], reason: str) -> None:
    result = solved(**fields)
    assert result.designs == []
    assert result.search.complete
    assert reason in result.summary


def test_a_reverted_ratio_in_a_gap() -> None:
    """Every reverted train is farther off than the tolerance: shown by listing them all."""
    ratio, tolerance = Fraction("2.03"), Fraction("0.0001")
    trains = [
        Fraction(b * (total - c), a * c)
        for total in range(24, 37)
        for a in range(12, 19)
        for c in range(12, 19)
        if 12 <= (b := total - a) <= 18 and 12 <= total - c <= 18
    ]
    nearest = min(abs(train / ratio - 1) for train in trains)
    result = solved(ratio="2.03", max_stages=2, teeth={"min": 12, "max": 18}, reverted=True, tolerance=1e-4)
    assert nearest > tolerance
    assert result.designs == []
    assert result.search.least_error == pytest.approx(float(nearest), rel=1e-12)


def test_hunting_teeth_are_preferred_among_ties() -> None:
    plain = solved(ratio=6, max_stages=2, max_designs=30)
    hunting = solved(ratio=6, max_stages=2, max_designs=30, hunting_tooth="prefer")
    assert not plain.designs[0].metrics.hunting_tooth
    assert all(design.metrics.hunting_tooth for design in hunting.designs)
    assert all(design.metrics.relative_error == 0.0 for design in hunting.designs)


def test_the_pareto_set_is_one() -> None:
    result = solved(ratio="pi", max_stages=3, teeth={"min": 12, "max": 60})
    sizes = [train.size for train in result.pareto]
    errors = [abs(train.relative_error) for train in result.pareto]
    assert sizes == sorted(set(sizes))
    assert errors == sorted(set(errors), reverse=True)
    assert errors[-1] == abs(result.designs[0].metrics.relative_error) == result.search.least_error
    assert errors[0] <= 0.01


def test_the_pareto_set_is_that_of_all_trains() -> None:
    """By plain loops over all drivers and driven gears of one and two stages: none is missing, and none too many."""
    sides = {k: list(itertools.combinations_with_replacement(range(15, 31), k)) for k in (1, 2)}
    every = [
        (sum(drivers) + sum(driven), abs(math.prod(driven) / math.prod(drivers) / math.sqrt(2.0) - 1.0))
        for k in sides
        for drivers, driven in itertools.product(sides[k], repeat=2)
    ]
    front: list[tuple[int, float]] = []
    for size, error in sorted(every):
        if error <= 0.01 and (not front or error < front[-1][1] - 1e-14):
            front.append((size, error))
    result = solved(ratio="sqrt(2)", max_stages=2, teeth={"min": 15, "max": 30}, max_designs=1)
    assert len(front) > 3
    assert [train.size for train in result.pareto] == [size for size, _ in front]
    assert [abs(train.relative_error) for train in result.pareto] == pytest.approx([error for _, error in front])


def test_a_number_is_the_decimal_that_was_written() -> None:
    result = solved(ratio=2.54, max_stages=1, teeth={"min": 12, "max": 130}, tolerance=0)
    assert meshes(result) == [(50, 127)]


def test_teeth_without_a_range_are_sound() -> None:
    result = solved(ratio="pi", max_stages=2)
    gears = [n for design in result.designs for s in design.mechanism.stages for n in (s.driver, s.driven)]
    assert min(gears) >= 18
    assert not any(mesh.interferes or mesh.undercut for design in result.designs for mesh in design.metrics.meshes)


def test_a_shift_is_suggested_and_not_applied() -> None:
    result = solved(ratio=5, max_stages=1, teeth={"min": 12, "max": 60}, tolerance=0, rank_by="size")
    mesh = result.designs[0].metrics.meshes[0]
    assert (mesh.driver, mesh.driven, mesh.interferes) == (12, 60, True)
    assert mesh.suggested_shift is not None
    # The straight flank of the rounded rack is 0.99997 modules deep.
    assert mesh.suggested_shift.driver == pytest.approx(1.0 - 6.0 * math.sin(math.radians(20.0)) ** 2, abs=4e-5)
    assert mesh.suggested_shift.driven == -mesh.suggested_shift.driver
    assert mesh.centre_distance == 36.0


BASE = {"kind": "gear_train", "ratio": 6, "max_stages": 2, "teeth": {"min": 12, "max": 60}}
GOOD = GearTrainMechanism(
    stages=[Stage(driver=20, driven=40, module=1.0), Stage(driver=20, driven=60, module=1.0)],
    ratio=Ratio(numerator=6, denominator=1, value=6.0),
)


@pytest.mark.parametrize(
    ("change", "fields", "check"),
    [
        ({"ratio": Ratio(numerator=7, denominator=1, value=7.0)}, {}, "ratio"),
        ({"ratio": Ratio(numerator=-6, denominator=1, value=-6.0)}, {}, "ratio"),
        ({"ratio": Ratio(numerator=6, denominator=1, value=6.1)}, {}, "ratio"),
        ({"stages": [Stage(driver=20, driven=40, module=1.0), Stage(driver=20, driven=61, module=1.0)]}, {}, "ratio"),
        ({}, {"ratio": "6.001", "tolerance": 1e-4}, "ratio_error"),
        ({}, {"ratio": "pi", "tolerance": 0.9}, "ratio_error"),
        ({}, {"direction": "opposite"}, "direction"),
        ({}, {"max_stages": 1}, "stages"),
        ({}, {"teeth": {"min": 12, "max": 59}}, "teeth"),
        ({}, {"teeth": {"min": 21, "max": 60}}, "teeth"),
        ({}, {"teeth": None, "stock": [20, 40, 60]}, "stock"),
        ({}, {"max_stage_ratio": 2.9}, "stage_ratio"),
        ({}, {"max_total_teeth": 139}, "total_teeth"),
        ({}, {"reverted": True}, "coaxial"),
        ({}, {"hunting_tooth": "require"}, "hunting_tooth"),
    ],
)
def test_verification_tells_a_wrong_train(change: dict[str, Any], fields: dict[str, Any], check: str) -> None:
    stated = {name: value for name, value in {**BASE, **fields}.items() if value is not None}
    problem = GearTrainProblem.model_validate(stated)
    sound = verify(GearTrainProblem.model_validate(BASE), GOOD)
    assert sound is not None
    assert sound.verification.passed
    found = verify(problem, GOOD.model_copy(update=change))
    assert found is not None
    assert check in [c.name for c in found.verification.checks if not c.passed]


def test_verification_sees_interference() -> None:
    stages = [Stage(driver=12, driven=36, module=1.0), Stage(driver=20, driven=40, module=1.0)]
    problem = GearTrainProblem.model_validate({**BASE, "interference": "refuse"})
    found = verify(problem, GOOD.model_copy(update={"stages": stages}))
    assert found is not None
    assert [c.name for c in found.verification.checks if not c.passed] == ["interference"]


@pytest.mark.parametrize(
    ("fields", "path"),
    [
        ({"ratio": -6, "direction": "same"}, "/direction"),
        ({"module": 1.0, "diametral_pitch": 10.0}, "/diametral_pitch"),
        ({"stock": [20, 30]}, "/stock"),
        ({"reverted": True, "max_stages": 1}, "/reverted"),
        ({"teeth": [{"min": 12}, {"min": 12}]}, "/teeth"),
        ({"teeth": {"max": 15}}, "/teeth/max"),
        ({"teeth": [{"min": 12}, {"min": 12}, {"max": 12}, {"min": 12}]}, "/teeth/2/max"),
        ({"module": [1.0]}, "/module"),
        ({"module": [1.0, 1.0], "reverted": True}, "/module"),
        ({"module": [1.0, 1.000000000001], "reverted": True}, "/module"),
        ({"max_stages": 4, "teeth": {"min": 12, "max": 400}}, "/teeth"),
        ({"max_stages": 4, "teeth": {"min": 12, "max": 500}, "reverted": True}, "/teeth"),
    ],
)
def test_contradictions_are_told_by_field(fields: dict[str, Any], path: str) -> None:
    problem = GearTrainProblem.model_validate({**BASE, **fields})
    assert path in [contradiction.path for contradiction in problem.find_contradictions()]


@pytest.mark.parametrize(
    "fields",
    [
        {"ratio": 0},
        {"ratio": "2*"},
        {"ratio": 1e10},
        {"ratio": True},
        {"ratio": None},
        {"teeth": {"min": 30, "max": 20}},
        {"teeth": {"min": 2, "max": 20}},
        {"stock": []},
        {"stock": [20, 5000]},
        {"max_stages": 5},
        {"tolerance": -0.1},
        {"max_stage_ratio": 0.5},
        {"pressure_angle": 5.0},
        {"module": 1e-300},
        {"diametral_pitch": 5e-324},
    ],
)
def test_ill_formed_statements_are_refused(fields: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        GearTrainProblem.model_validate({**BASE, **fields})


def test_wide_ranges_stay_exact() -> None:
    """Products beyond 2⁵³ never occur, and beyond 2³¹ nothing wraps round."""
    ratio = Fraction(1999 * 1997, 1987 * 1993)
    teeth = [{"min": 1980, "max": 2000}] * 4
    result = solved(ratio=f"{ratio.numerator}/{ratio.denominator}", max_stages=2, teeth=teeth)
    assert {frozenset((s.driver, s.driven) for s in d.mechanism.stages) for d in result.designs[:1]} <= {
        frozenset({(1987, 1999), (1993, 1997)}),
        frozenset({(1987, 1997), (1993, 1999)}),
    }
    assert result.designs[0].metrics.relative_error == 0.0


def every_set_of_gears(stated: GearTrainProblem) -> list[tuple[Fraction, int, bool]]:
    """Error with its sign, size and whether its teeth can hunt, of every choice of gears, by plain loops."""
    target = parse_target(stated.ratio)[1].rational
    assert target is not None
    assert isinstance(stated.teeth, TeethRange)
    numbers = range(stated.teeth.min or 0, stated.teeth.max + 1)
    most = Fraction(str(stated.max_stage_ratio)) if stated.max_stage_ratio else None
    found = []
    for k in range(1, stated.max_stages + 1):
        sets = list(itertools.combinations_with_replacement(numbers, k))
        for drivers, driven in itertools.product(sets, sets):
            pairings = [
                meshes
                for meshes in (list(zip(drivers, order, strict=True)) for order in itertools.permutations(driven))
                if most is None or all(Fraction(max(mesh), min(mesh)) <= most for mesh in meshes)
            ]
            if not pairings:
                continue
            ratio = Fraction(math.prod(driven), math.prod(drivers))
            hunting = any(all(math.gcd(*mesh) == 1 for mesh in meshes) for meshes in pairings)
            found.append((ratio / target - 1, sum(drivers + driven), hunting))
    return found


def ranked_by(stated: GearTrainProblem, rows: list[tuple[Fraction, int, bool]]) -> list[tuple[Any, ...]]:
    """What the ranking compares, best first: error, hunting and size, or size, error and hunting."""
    prefer = stated.hunting_tooth == "prefer"
    if stated.rank_by == "size":
        return sorted((size, abs(error), prefer and not hunting) for error, size, hunting in rows)
    return sorted((abs(error), prefer and not hunting, size) for error, size, hunting in rows)


@pytest.mark.campaign
def test_preferences_against_plain_loops() -> None:
    """Size, hunting teeth and tolerance in every combination: the keys of the ten best, in order."""
    rng = np.random.default_rng(8)
    answered = 0
    for number in range(60):
        low = int(rng.integers(8, 13))
        numerator, denominator = (int(n) for n in rng.integers(7, 40, 2))
        fields: dict[str, Any] = {
            "ratio": f"{numerator}/{denominator}",
            "max_stages": int(rng.integers(1, 3)),
            "teeth": {"min": low, "max": low + int(rng.integers(4, 11))},
            "tolerance": [None, None, 0.03, 0.0][rng.integers(4)],
            "rank_by": ["error", "size"][number % 2],
            "hunting_tooth": str(rng.choice(["any", "prefer", "prefer", "require"])),
            "max_stage_ratio": float(rng.choice([1.5, 2.0])) if rng.random() < 0.3 else None,
            "max_designs": 10,
        }
        stated = GearTrainProblem(kind="gear_train", **fields)
        rows = every_set_of_gears(stated)
        if stated.hunting_tooth == "require":
            rows = [row for row in rows if row[2]]
        within = Fraction(1, 100) if stated.rank_by == "size" else None
        if stated.tolerance is not None:
            within = Fraction(str(stated.tolerance))
        near = [row for row in rows if within is None or abs(row[0]) <= within]
        result = solved(**fields)
        target = Fraction(numerator, denominator)
        own = [
            (
                abs(abs(Fraction(design.mechanism.ratio.numerator, design.mechanism.ratio.denominator)) / target - 1),
                sum(stage.driver + stage.driven for stage in design.mechanism.stages),
                all(math.gcd(stage.driver, stage.driven) == 1 for stage in design.mechanism.stages),
            )
            for design in result.designs
        ]
        if within is None and not own:
            # Only a ratio beyond all that the gears can make has no nearest train.
            assert not rows or max(row[0] for row in rows) < 0 or min(row[0] for row in rows) > 0, fields
            continue
        assert ranked_by(stated, own) == ranked_by(stated, near)[:10], fields
        keys = [ranked_by(stated, [row])[0] for row in own]
        assert keys == sorted(keys), fields
        answered += bool(own)
    assert answered > 25


def test_a_stock_reaches_no_farther_than_its_gears() -> None:
    """Two stages of 20:100 would give 25; of one gear each the most is 30·100 / (20·25), and the gears are few."""
    stock = [20, 25, 30, 100]
    assert solved(ratio="4", max_stages=2, stock=stock).designs
    beyond = solved(ratio="24", max_stages=2, stock=stock)
    assert beyond.designs == []
    assert "0.166667 to 6 in 2 stages" in beyond.summary


@pytest.mark.parametrize(
    ("fields", "most"),
    [
        # 20:60 has a stage ratio of 3, so that of these gears 30:60 is the most: not the 60·30 / (20·20) of the stock.
        ({"stock": [20, 20, 30, 60], "max_stage_ratio": 2.0}, "2"),
        ({"teeth": {"min": 20, "max": 40}, "max_total_teeth": 100}, "2.25"),
        ({"stock": [20, 22, 40, 42, 60, 62], "reverted": True, "max_stage_ratio": 2.0}, "1.9"),
    ],
)
def test_a_ratio_that_the_demands_put_out_of_reach_has_no_train(fields: dict[str, Any], most: str) -> None:
    """Without a tolerance the nearest is returned between the least and the greatest ratio that trains have, only."""
    within = solved(ratio=most, max_stages=2, **fields)
    beyond = solved(ratio="3.5", max_stages=2, **fields)
    below = solved(ratio="2/7", max_stages=2, **fields)
    assert within.designs
    assert beyond.designs == below.designs == []
    assert beyond.search.complete
    assert "out of reach" in beyond.summary
    assert "out of reach" in below.summary
    assert f"to {most} in 2 stages" in beyond.summary or fields.get("reverted")


@pytest.mark.parametrize(
    "fields",
    [
        {"ratio": "7", "max_stages": 2, "stock": [20, 100, 30, 90, 25]},
        {"ratio": "1.037", "max_stages": 1, "teeth": {"min": 18, "max": 22}},
        {"ratio": "1.037", "max_stages": 1, "teeth": {"min": 18, "max": 30}},
        {"ratio": "1.037", "max_stages": 2, "teeth": {"min": 18, "max": 22}, "reverted": True},
        {"ratio": "1.037", "max_stages": 1, "teeth": {"min": 18, "max": 30}, "tolerance": 0.002},
    ],
)
def test_the_pareto_set_is_within_what_the_page_says(fields: dict[str, Any]) -> None:
    """Within the tolerance, or within 1 % where none is stated, also where all trains are farther off."""
    result = solved(**fields)
    bound = fields.get("tolerance", 0.01)
    assert all(abs(train.relative_error) <= bound for train in result.pareto)
    near = [design for design in result.designs if abs(design.metrics.relative_error) <= bound]
    assert bool(result.pareto) == bool(near)
