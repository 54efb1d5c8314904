"""Designs as a shop makes them: yields against another formulation, derivatives against differences, and refusals."""

from __future__ import annotations

import dataclasses
import json
import math
from functools import cache
from typing import Any

import numpy as np
import pytest

from kinematics.linkage.variation import measure_deviations
from kinematics.linkage.variation.sensitivities import compute_sensitivities
from synthesis.dispatch import solve
from synthesis.manufacture.yield_sampling import compute_interval
from synthesis.registry import KINDS, list_examples, parse_problem
from tests.campaign import further
from tests.kinematics.variation_twin import crank_rocker, slider
from tests.oracles import made_linkages
from tests.service.stated.linkages import BOTH_OPEN, FITTED, MOTION, PATH, TOLERATED
from tests.support.service.space import TURNS

Statement = dict[str, Any]

FINE = {"length": 0.1, "pivot": 0.05}
SLIDES = {**MOTION, **BOTH_OPEN, "output_side": {"dyad": "PR", "slide_angle": 15.0}}
TIMED = list_examples("path")[1]
LOGARITHM = {**list_examples("function")[2], "max_designs": 2}
PAIRS = {**list_examples("function")[1], "constraints": {"max_link_ratio": 10.0}, "max_designs": 2}

TASKS: dict[str, tuple[Statement, Statement]] = {
    "motion": ({**MOTION, **BOTH_OPEN}, {"quality": {"max_error": 0.2, "max_angle_error": 0.2}}),
    "motion, fixed and normal": (
        {**MOTION, **BOTH_OPEN},
        {"quality": {"max_error": 0.2, "max_angle_error": 0.3}, "input": "fixed", "distribution": "normal"},
    ),
    "motion, the angle alone": ({**MOTION, **BOTH_OPEN}, {"quality": {"max_angle_error": 0.05}}),
    "motion, with a slider": (SLIDES, {"quality": {"max_error": 0.2, "max_angle_error": 0.1}}),
    "path": ({**PATH, "max_designs": 2}, {"quality": {"max_error": 0.1}}),
    "path, timed": (TIMED, {"quality": {"max_error": 0.3}}),
    "function, of a slider": (LOGARITHM, {"quality": {"max_error": 0.15}}),
    "function": (PAIRS, {"quality": {"max_angle_error": 0.5}, "tolerances": {"length": 0.004, "pivot": 0.001}}),
}


@cache
def answered(name: str) -> Statement:
    problem, block = TASKS[name]
    stated = {**problem, "manufacture": {"tolerances": FINE, "samples": 8001, **block}}
    return {"problem": stated, **json.loads(solve(parse_problem(stated)).model_dump_json())}


@pytest.mark.parametrize("name", further(TASKS, ["motion", "motion, fixed and normal", "function, of a slider"]))
def test_yields_are_those_of_another_formulation(name: str) -> None:
    answer = answered(name)
    problem, block = answer["problem"], answer["problem"]["manufacture"]
    assert answer["designs"]
    for design in answer["designs"]:
        of = made_linkages.stated(problem, design)
        distribution = block.get("distribution", "uniform")
        rows = made_linkages.samples(of, block["tolerances"], distribution, 3000, 1)
        quality = block["quality"].get("max_error"), block["quality"].get("max_angle_error")
        share = made_linkages.good(of, rows, *quality, fixed=block.get("input") == "fixed").mean()
        told = design["metrics"]["yield"]
        assert told["samples"] == 8001
        assert told["low"] <= told["value"] <= told["high"]
        spread = math.sqrt(max(share * (1.0 - share), 1e-3) * (1.0 / 3000.0 + 1.0 / 8001.0))
        assert abs(told["value"] - share) < 4.5 * spread


@pytest.mark.parametrize("name", further(TASKS, ["path, timed", "function", "function, of a slider"]))
def test_the_block_adds_to_an_answer_and_changes_nothing(name: str) -> None:
    problem, _ = TASKS[name]
    plain, made = json.loads(solve(parse_problem(problem)).model_dump_json()), dict(answered(name))
    del made["problem"]
    for design in made["designs"]:
        del design["manufacture"], design["metrics"]["yield"]
    answered.cache_clear()
    assert made == plain


@pytest.mark.parametrize(
    "name", further(["motion", "path", "function, of a slider", "function"], ["motion", "function"])
)
def test_the_worst_case_is_the_worst_corner(name: str) -> None:
    """At every corner by the other formulation: half of a hundredth more is never missed, as much less always is."""
    answer = answered(name)
    block = answer["problem"]["manufacture"]
    design = answer["designs"][0]
    of = made_linkages.stated(answer["problem"], design)
    off = made_linkages.dimensions_off(of, block["tolerances"])
    guided = of.outputs is None
    open_ones = [k for k in range(len(off)) if guided or k < len(off) - 2]
    signs = np.zeros((2 ** len(open_ones), len(off)))
    signs[:, open_ones] = np.array(np.meshgrid(*[[-1.0, 1.0]] * len(open_ones))).reshape(len(open_ones), -1).T
    worst, quality = design["manufacture"]["worst_case"], block["quality"]
    assert worst["assembles"]
    share = max(
        worst[name] / quality[name] for name in ("max_error", "max_angle_error") if name in worst and name in quality
    )
    for scale, all_good in ((1.005, True), (0.995, False)):
        wide = [quality[name] * share * scale if name in quality else None for name in ("max_error", "max_angle_error")]
        assert made_linkages.good(of, of.row + signs * off, *wide).all() == all_good


@pytest.mark.parametrize("make", [crank_rocker, slider])
@pytest.mark.parametrize("sort", ["poses", "points", "outputs"])
@pytest.mark.parametrize("adjusted", [True, False])
def test_derivatives_are_differences(make: Any, sort: str, adjusted: bool) -> None:
    nominal, task = make(sort, adjusted=adjusted)
    found = compute_sensitivities(task, nominal)
    driven = measure_deviations(dataclasses.replace(task, greatest=False), nominal[None])
    assert found.inputs == pytest.approx(driven.inputs[0], abs=1e-5)
    assert found.offsets == pytest.approx(driven.offsets[0], abs=1e-4)
    step = 1e-3
    for k in range(len(nominal)):
        changes = np.eye(len(nominal))[k] * step * np.array([[2.0], [1.0], [-1.0], [-2.0]])
        near = [compute_sensitivities(task, nominal + change) for change in changes]
        off, least = np.array([one.offsets for one in near]), np.array([one.least for one in near])
        difference = (8.0 * (off[1] - off[2]) - (off[0] - off[3])) / (12.0 * step)
        assert found.rates[:, :, k] == pytest.approx(difference, abs=1e-8)
        slope = (8.0 * (least[1] - least[2]) - (least[0] - least[3])) / (12.0 * step)
        assert found.least_rates[k] == pytest.approx(slope, abs=1e-8)


def test_tolerances_that_matter_come_first_and_widen_errors() -> None:
    answer = answered("motion")
    for design in answer["designs"]:
        told = design["manufacture"]
        shares = [one["share"] for one in told["sensitivities"]]
        assert shares == sorted(shares, reverse=True)
        assert sum(shares) == pytest.approx(1.0)
        assert told["matter"] == [one["dimension"] for one in told["sensitivities"][: len(told["matter"])]]
        assert sum(shares[: len(told["matter"])]) >= 0.8 > sum(shares[: len(told["matter"]) - 1])


@pytest.mark.slow
def test_positions_with_tolerances_are_held_where_the_design_passes_them() -> None:
    """The quality is kept about the place as drawn, and the position's own tolerance on top of that."""
    block = {"tolerances": FINE, "samples": 8001}
    stated = {**MOTION, **TOLERATED}
    loose = {**block, "quality": {"max_error": 50.0, "max_angle_error": 90.0}}
    near, own, plain = (
        solve(parse_problem({**problem, "manufacture": {**block, **more}})).designs[0].metrics.yield_.value
        for problem, more in (
            (stated, {"quality": {"max_error": 0.4, "max_angle_error": 0.4}}),
            (stated, {**loose, "tolerances": {"length": 1.0, "pivot": 1.0}}),
            ({**MOTION, **FITTED}, {**loose, "tolerances": {"length": 1.0, "pivot": 1.0}}),
        )
    )
    assert 0.1 < near < 1.0
    # With no quality to speak of, only the tolerances of the positions are broken by samples.
    assert 0.1 < own < plain - 0.1


@pytest.mark.slow
def test_a_demanded_yield_is_a_check_and_ranks() -> None:
    open_ones = {**MOTION, **BOTH_OPEN, "max_designs": 4}
    block = {"tolerances": FINE, "quality": {"max_error": 0.2, "max_angle_error": 0.2}, "samples": 2001}
    usual = solve(parse_problem({**open_ones, "max_designs": 40, "manufacture": block})).designs
    ranked = solve(parse_problem({**open_ones, "rank_by": "yield", "manufacture": block}))
    assert "Ranked by yield" in ranked.summary
    best = sorted((design.metrics.yield_.value for design in usual), reverse=True)[:4]
    assert [design.metrics.yield_.value for design in ranked.designs] == best
    limit = 0.5 * (best[0] + min(design.metrics.yield_.value for design in usual))
    block["quality"] = {**block["quality"], "yield": limit}
    held = solve(parse_problem({**open_ones, "manufacture": block}))
    assert held.search.rejected["yield"] > 0
    for design in held.designs:
        (check,) = [check for check in design.verification.checks if check.name == "yield"]
        assert check.passed
        assert check.value == design.metrics.yield_.low >= check.limit == limit


def test_a_yield_out_of_reach_is_the_nearest_miss() -> None:
    block = {"tolerances": FINE, "quality": {"max_error": 0.02, "max_angle_error": 0.2, "yield": 0.99}, "samples": 8001}
    answer = solve(parse_problem({**MOTION, "manufacture": block}))
    assert answer.designs == []
    (gap,) = answer.nearest_miss.gaps
    assert (gap.check, gap.limit) == ("yield", 0.99)
    assert answer.nearest_miss.design.metrics.yield_.low == gap.value < 0.99


@pytest.mark.parametrize(
    ("count", "low", "high"), [(0, 0.0, 0.4113), (1, 0.0005, 0.5443), (5, 0.1283, 0.8717), (10, 0.5887, 1.0)]
)
def test_the_interval_holds_what_the_binomial_says(count: int, low: float, high: float) -> None:
    """Of 10 at 99 %: each end is where as many or more (fewer) good ones have a chance of a half per cent."""
    ends = compute_interval(count, 10)
    assert ends == pytest.approx((low, high), abs=6e-5)
    for end, counts in ((ends[0], range(count, 11)), (ends[1], range(count + 1))):
        chance = sum(math.comb(10, k) * end**k * (1.0 - end) ** (10 - k) for k in counts)
        assert end in (0.0, 1.0) or chance == pytest.approx(0.005)


def test_the_same_seed_gives_the_same_yield_and_another_another() -> None:
    block = {"tolerances": FINE, "quality": {"max_error": 0.2}, "samples": 2000}

    def told(own: Statement, **more: Any) -> tuple[float, int]:
        (design,) = solve(parse_problem({**MOTION, **more, "manufacture": {**block, **own}})).designs
        return design.metrics.yield_.value, design.manufacture.seed

    assert told({}) == told({})
    assert told({})[1] == 0
    assert told({}, seed=5) == told({"seed": 5}) != told({})


@pytest.mark.parametrize("kind", [kind for kind in KINDS if hasattr(KINDS[kind].problem, "made")])
def test_a_kind_takes_the_block_or_refuses_it_by_its_path(kind: str) -> None:
    problem = parse_problem({**list_examples(kind)[0], "manufacture": {"tolerances": {"length": 0.1}}})
    faults = [fault for fault in problem.find_contradictions() if fault.path.startswith("/manufacture")]
    assert bool(faults) == (kind not in ("motion", "path", "function"))
    for fault in faults:
        assert fault.path == "/manufacture"
        assert "motion, path and function" in fault.detail


GRID = {"round": {"length": 0.5, "coordinates": 0.5}}
FINE_GRID = {"round": {"length": 0.05, "coordinates": 0.05}}
ON_GRID: dict[str, tuple[Statement, Statement]] = {
    "motion, with a slider": (SLIDES, GRID),
    "function": (TURNS, FINE_GRID),
    "function, of a slider": (LOGARITHM, GRID),
}


def exact_of(problem: Statement, design: Statement) -> made_linkages.Stated:
    """The exact design beside one on the grid, with its own inputs at the targets."""
    plain = json.loads(solve(parse_problem(problem)).model_dump_json())
    return next(
        made_linkages.stated(problem, one)
        for one in plain["designs"]
        if one["mechanism"] == design["exact"]["mechanism"]
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", ON_GRID)
def test_no_linkage_within_two_steps_is_nearer(name: str) -> None:
    problem, block = ON_GRID[name]
    stated = parse_problem({**problem, "manufacture": block})
    answer = json.loads(solve(stated).model_dump_json())
    design = answer["designs"][0]
    of = exact_of({**problem, "max_designs": 12}, design)
    step = block["round"]["length"]
    guided = of.outputs is None
    steps = np.array([step] * (len(of.row) - 2) + [step if guided else 0.0] * 2)
    rows = made_linkages.neighbours(of, steps)
    assert len(rows) >= 4 ** (7 if of.slides and guided else 5)
    size = getattr(stated, "task_size", 1.0) if guided else (50.0 if of.slides else 1.0)
    rms = design["metrics"]["rms_residual"]
    most = rms**2 * len(of.inputs)
    # Some that are searched lie a little farther away.
    squares = made_linkages.squares(of, rows, size, most * 4.0)
    assert math.sqrt(squares.min() / len(of.inputs)) >= rms * (1.0 - 1e-4)
    assert np.isfinite(squares.min())
    row = of.row.copy()
    told = list(design["manufacture"]["dimensions"].values())
    row[: len(told)] = told
    assert row[: len(told)] / step == pytest.approx(np.round(row[: len(told)] / step), abs=1e-9)
    own = made_linkages.squares(of, row[None], size)[0]
    assert math.sqrt(own / len(of.inputs)) == pytest.approx(rms, rel=1e-4)


@pytest.mark.slow
def test_a_fourbar_on_the_grid_is_not_rounded_one_by_one() -> None:
    problem = {**MOTION, **BOTH_OPEN, "max_designs": 1}
    (design,) = solve(parse_problem({**problem, "manufacture": GRID})).designs
    told = design.manufacture
    exact = json.loads(design.exact.model_dump_json())
    of = exact_of({**problem, "max_designs": 12}, {"exact": exact})
    one_by_one = made_linkages.squares(of, np.round(of.row[None] / 0.5) * 0.5, 76.0)[0]
    assert design.metrics.rms_residual < 0.5 * math.sqrt(one_by_one / 3.0)
    # Near the grid's best there are worse ones, as many as are looked at; within one step all are worse.
    row = np.array(list(told.dimensions.values()))
    near = row + 0.5 * np.random.default_rng(0).integers(-1, 2, (2000, 9))
    size = parse_problem(problem).task_size
    best = made_linkages.squares(of, row[None], size)[0]
    within = (np.abs(near - of.row) <= 1.0).all(axis=1)
    assert within.sum() > 100
    assert made_linkages.squares(of, near[within], size).min() >= best * (1.0 - 1e-6)
    assert math.sqrt(best / 3.0) == pytest.approx(design.metrics.rms_residual, rel=1e-4)
    assert told.cost.rms_residual == pytest.approx(design.metrics.rms_residual, abs=1e-12)
    assert design.exact.rms_residual < 1e-9
    links = design.mechanism.links
    assert [links.input, links.coupler, links.output] == [
        told.dimensions[f"links.{n}"] for n in ("input", "coupler", "output")
    ]


@pytest.mark.slow
def test_links_in_stock_meet_exact_positions_with_free_pivots() -> None:
    """Nine dimensions, six conditions: three links may be chosen, and pivots and P still meet all positions."""
    stock = [40.0, 60.0, 80.0, 100.0]
    block = {"stock": {"links": stock}}
    for design in solve(parse_problem({**MOTION, **BOTH_OPEN, "max_designs": 1, "manufacture": block})).designs:
        links = design.mechanism.links
        assert {links.input, links.coupler, links.output} <= set(stock)
        assert design.metrics.rms_residual < 1e-8
    both = {**block, **GRID}
    for design in solve(parse_problem({**MOTION, **BOTH_OPEN, "max_designs": 1, "manufacture": both})).designs:
        links = design.mechanism.links
        assert {links.input, links.coupler, links.output} <= set(stock)
        assert 1e-6 < design.metrics.rms_residual < 5e-3
        pivots = np.array([design.mechanism.fixed_pivots.input, design.mechanism.fixed_pivots.output])
        assert np.all(pivots * 2.0 == np.round(pivots * 2.0))


def test_stated_pivots_stay_and_other_demands_hold_on_the_grid() -> None:
    stated = {
        "input_side": {"fixed_pivot": [0.3, -60.1]},
        "output_side": {},
        "constraints": {"min_transmission_angle": 30.0},
    }
    block = {**GRID, "quality": {"max_error": 0.5, "max_angle_error": 0.5}}
    designs = solve(parse_problem({**MOTION, **stated, "max_designs": 2, "manufacture": block})).designs
    assert designs
    for design in designs:
        assert design.mechanism.fixed_pivots.input == (0.3, -60.1)
        checks = {check.name: check for check in design.verification.checks}
        assert {"input_side", "max_error", "max_angle_error", "transmission_angle"} <= checks.keys()
        assert "reaches_targets" not in checks
        assert checks["max_error"].value == max(target.point_residual for target in design.targets) <= 0.5


@pytest.mark.slow
def test_a_quality_that_no_grid_keeps_is_the_nearest_miss() -> None:
    block = {"round": {"length": 10.0, "coordinates": 10.0}, "quality": {"max_error": 0.001}}
    stated = {**LOGARITHM, "max_designs": 1, "manufacture": block}
    answer = solve(parse_problem(stated))
    assert answer.designs == []
    assert answer.search.rejected["max_error"] > 0
    (gap,) = answer.nearest_miss.gaps
    assert (gap.check, gap.limit, gap.dimension) == ("max_error", 0.001, "length")
    assert answer.nearest_miss.design.exact is not None
    failed = solve(parse_problem({**stated, "include_failed": True}))
    assert [design.verification.passed for design in failed.designs] == [False]


def test_a_grid_too_coarse_for_the_task_has_no_answer() -> None:
    block = {"round": {"length": 1e6, "coordinates": 1e6}}
    answer = solve(parse_problem({**LOGARITHM, "max_designs": 1, "manufacture": block}))
    assert answer.designs == []
    assert "max_error" in {gap.check for gap in answer.nearest_miss.gaps}


@pytest.mark.slow
def test_linkages_on_the_grid_are_ordered_by_yield() -> None:
    block = {**GRID, "tolerances": FINE, "quality": {"max_error": 0.8}, "samples": 2000}
    stated = {**LOGARITHM, "max_designs": 3, "manufacture": block}
    ranked = solve(parse_problem({**stated, "rank_by": "yield"})).designs
    values = [design.metrics.yield_.value for design in ranked]
    assert len(values) == 3
    assert values == sorted(values, reverse=True)
    assert all(design.exact is not None for design in ranked)
    assert values[0] >= max(design.metrics.yield_.value for design in solve(parse_problem(stated)).designs)


CLEARANCE = 0.05
PLAYS = {
    "motion": ({**MOTION, **BOTH_OPEN, "max_designs": 2}, CLEARANCE),
    "motion, with a slider": ({**SLIDES, "max_designs": 2}, CLEARANCE),
    "path": ({**PATH, "max_designs": 2}, CLEARANCE),
    "function": ({**TURNS, "max_designs": 2}, CLEARANCE),
    "function, of a slider": ({**LOGARITHM, "max_designs": 2}, CLEARANCE),
}


@pytest.mark.parametrize("name", further(PLAYS, ["motion, with a slider", "function", "function, of a slider"]))
def test_play_holds_all_places_that_clearance_links_lead_to(name: str) -> None:
    """Every pin's clearance link is turned by chance, and the loop closed by roots: all within, and near the bound."""
    problem, clearance = PLAYS[name]
    stated = {**problem, "manufacture": {"tolerances": {"pin_clearance": clearance}}}
    answer = json.loads(solve(parse_problem(stated)).model_dump_json())
    rng = np.random.default_rng(4)
    for design in answer["designs"]:
        of = made_linkages.stated(problem, design)
        assert len(design["manufacture"]["play"]) == len(of.inputs)
        for k, told in enumerate(design["manufacture"]["play"]):
            links = clearance * np.exp(2j * np.pi * rng.random((4, 4000)))
            links[:, :1000] *= rng.random((4, 1000))
            place, phi, output = made_linkages.with_clearances(of, links, k)
            stands = made_linkages.with_clearances(of, np.zeros((4, 1), complex), k)
            if of.outputs is None:
                away = np.abs(place - stands[0])
                assert 0.8 * told["max_error"] < away.max() <= told["max_error"]
                corners = np.array([complex(*corner) for corner in told["outline"]])
                sides = np.roll(corners, -1) - corners
                inside = ((place - corners[:, None]) * np.conj(sides)[:, None]).imag >= 0.0
                assert inside.all()
                if of.turns is not None:
                    turned = np.degrees(np.abs(np.angle(np.exp(1j * (phi - stands[1])))))
                    assert 0.8 * told["max_angle_error"] < turned.max() <= told["max_angle_error"]
            elif of.slides:
                away = np.abs(output - stands[2])
                assert 0.8 * told["max_error"] < away.max() <= told["max_error"]
            else:
                turned = np.degrees(np.abs(np.angle(np.exp(1j * (output - stands[2])))))
                assert 0.8 * told["max_angle_error"] < turned.max() <= told["max_angle_error"]


@pytest.mark.slow
def test_the_widest_tolerances_still_give_the_yield_and_no_wider_ones_do() -> None:
    demanded = 0.9
    quality = {"max_error": 0.4, "max_angle_error": 0.4, "yield": demanded}
    block = {"tolerances": FINE, "quality": quality, "samples": 8001}
    stated = {**MOTION, **BOTH_OPEN, "max_designs": 1}
    (plain,) = solve(parse_problem({**stated, "manufacture": block})).designs
    answer = solve(parse_problem({**stated, "manufacture": {**block, "widest": True}}))
    design = json.loads(answer.model_dump_json())["designs"][0]
    assert "widest" not in json.loads(plain.model_dump_json())["manufacture"]
    told = design["manufacture"]["widest"]
    assert {one["by"] for one in told} == {"dimension", "sort", "scale"}
    costs = [one["cost"] for one in told]
    assert costs == sorted(costs)
    assert costs[0] < 1.0
    assert told[-1]["by"] == "scale"
    of = made_linkages.stated(stated, design)
    share = made_linkages.samples(of, {"length": 1.0, "pivot": 1.0}, "uniform", 6000, 2) - of.row
    for one in told:
        tolerances = np.array(list(one["tolerances"].values()))
        assert one["yield"]["low"] >= demanded
        assert one["yield"]["value"] < demanded + 0.02
        values = [made_linkages.good(of, of.row + share * width * tolerances, 0.4, 0.4).mean() for width in (1.0, 1.15)]
        assert values[0] > demanded - 0.01
        assert values[1] < demanded
        assert one["cost"] == pytest.approx(np.mean(made_linkages.dimensions_off(of, FINE) / tolerances))
    by_sort = next(one["tolerances"] for one in told if one["by"] == "sort")
    assert len(set(by_sort.values())) == 2


def test_of_a_design_without_the_yield_it_is_told_which_tolerances_would_give_it() -> None:
    block = {"tolerances": FINE, "quality": {"max_error": 0.02, "yield": 0.99}, "samples": 4000, "widest": True}
    design = solve(parse_problem({**MOTION, "manufacture": block})).nearest_miss.design
    for one in design.manufacture.widest:
        assert one.cost > 1.0
        assert one.yield_.low >= 0.99
    assert len(design.manufacture.widest) == 3
