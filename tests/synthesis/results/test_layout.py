"""Designs laid out in planes: what the block adds to an answer, and what its demand does to a search."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from synthesis.analyses import parse_request
from synthesis.model.answer import Result
from synthesis.registry import KINDS, parse_problem
from tests.campaign import further
from tests.service.stated.linkages import DRIVEN, DWELL, LINE, MOTION, PARALLEL, PATH, QUICK_RETURN, STEERING
from tests.support.answers import solve

Statement = dict[str, Any]


def block(link_width: float, **more: Any) -> Statement:
    return {"link_width": link_width, "pin_diameter": 0.5 * link_width, "thickness": 5.0, **more}


def answer(problem: Statement, layout: Statement | None = None) -> Result[Any]:
    return solve(parse_problem({**problem, "layout": layout} if layout else problem))


def bare(design: Any) -> Any:
    """A design without what follows from a layout: the check of its pins, and the widths over the used range."""
    checks = [check for check in design.verification.checks if check.name != "pin_distance"]
    measures = dict.fromkeys(("min_pin_distance", "max_link_width", "relative_link_width"))
    return design.model_copy(
        update={
            "layout": None,
            "verification": design.verification.model_copy(update={"checks": checks}),
            "metrics": design.metrics.model_copy(update=measures),
        }
    )


TASKS: dict[str, tuple[Statement, float]] = {
    "motion": (MOTION, 6.0),
    "motion, with a crank": ({**MOTION, **DRIVEN, "driver_dyad": True}, 1.0),
    "path": (PATH, 3.0),
    "quick_return": (QUICK_RETURN, 0.05),
    "straight_line": (LINE, 6.0),
    "straight_line, exact": ({**LINE, "mechanism": "peaucellier", "crank_range": 90.0}, 3.0),
    "steering": (STEERING, 60.0),
    "dwell": (DWELL, 1.5),
    "parallel_motion": ({**PARALLEL, "include_cognates": True}, 4.0),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", further(TASKS, TASKS.keys() - {"dwell", "path"}))
def test_a_layout_is_all_that_the_block_adds(name: str) -> None:
    problem, width = TASKS[name]
    plain, laid = answer(problem), answer(problem, block(width))
    assert laid.designs
    assert [bare(design) for design in laid.designs] == [bare(design) for design in plain.designs]
    assert laid.search == plain.search
    for design in laid.designs:
        layout = design.layout
        links = {link.name for link in design.mechanism.skeleton.links} - {"ground"}
        assert layout.remark is None
        assert layout.planes.keys() == links
        assert layout.count == max(layout.planes.values())
        assert set(layout.planes.values()) == set(range(1, layout.count + 1))
        assert layout.height == pytest.approx(5.0 * layout.count)
        assert layout.buildable == (not layout.clashes)
        if layout.buildable:
            free = layout.free_range or layout.free_stroke
            used = design.metrics.used_range or design.metrics.used_stroke
            assert free == pytest.approx(sorted(used), abs=1e-9 * max(map(abs, used)))


@pytest.mark.parametrize("kind", ["motion", "path", "function"])
def test_without_the_block_nothing_is_said(kind: str) -> None:
    for design in answer(KINDS[kind].examples[1]).designs:
        assert "layout" not in design.model_dump()


def test_a_limit_of_planes_is_kept_by_all_designs_and_told() -> None:
    """Two poses leave thousands of fourbars: there are such with two planes, and they are found."""
    problem = {**MOTION, "positions": MOTION["positions"][:2], "input_side": {}, "output_side": {}, "max_designs": 4}
    loose = answer(problem, block(24.0))
    assert 3 in {design.layout.count for design in loose.designs}
    held = answer(problem, block(24.0, max_planes=2))
    assert len(held.designs) == 4
    assert held.search.rejected["planes"] > 0
    assert held.search.candidates == held.search.accepted + sum(held.search.rejected.values())
    for design in held.designs:
        assert design.layout.count == 2
        (check,) = [check for check in design.verification.checks if check.name == "planes"]
        assert (check.passed, check.value, check.limit) == (True, 2.0, 2.0)


def test_where_no_design_keeps_the_limit_the_nearest_is_told() -> None:
    held = answer({**LINE, "mechanism": "peaucellier", "crank_range": 90.0}, block(3.0, max_planes=2))
    assert held.designs == []
    assert held.search.rejected == {"planes": 1}
    assert held.nearest_miss is not None
    assert [(gap.check, gap.value, gap.limit) for gap in held.nearest_miss.gaps] == [("planes", 4.0, 2.0)]
    assert held.nearest_miss.design.layout.count == 4


@pytest.mark.slow
def test_a_linkage_with_a_driver_is_held_to_its_planes_and_not_its_fourbar() -> None:
    problem = {**MOTION, **DRIVEN, "driver_dyad": True, "include_failed": True}
    counts = [design.layout.count for design in answer(problem, block(1.0)).designs]
    held = answer(problem, block(1.0, max_planes=min(counts)))
    for design in held.designs:
        assert design.verification.passed == (design.layout.buildable and design.layout.count <= min(counts))
        assert design.mechanism.type in ("watt_2", "stephenson_3")


def test_what_cannot_be_built_breaks_the_limit_without_a_value() -> None:
    """Links as wide as the linkage is: everything meets, whatever the number of planes."""
    problem = {**QUICK_RETURN, "include_failed": True}
    held = answer(problem, block(1.5, max_planes=20))
    assert held.designs
    for design in held.designs:
        assert not design.layout.buildable
        (check,) = [check for check in design.verification.checks if check.name == "planes"]
        assert (check.passed, check.value, check.limit) == (False, None, 20.0)
        for clash in design.layout.clashes:
            assert len(set(clash.parts)) == 2
            low, high = design.metrics.used_range
            assert low <= clash.input_angle <= high


def test_a_drag_link_stands_between_two_bases() -> None:
    problem = {"kind": "quick_return", "time_ratio": 1.4, "stroke": 100.0, "mechanism": "drag_link_slider"}
    one, two = (answer(problem, block(3.0, shafts=shafts)) for shafts in ("one_side", "both_sides"))
    assert not any(design.layout.buildable for design in one.designs)
    for design in two.designs:
        assert design.layout.buildable
        assert design.layout.stub_shafts == ["O2", "O4"]
        top = design.layout.count + 1
        assert {design.layout.pins[name][0] == 0 for name in ("O2", "O4")} == {True, False}
        assert {design.layout.pins[name][1] == top for name in ("O2", "O4")} == {True, False}


def test_the_cycle_is_wider_than_the_used_range() -> None:
    used, whole = (answer(MOTION, block(6.0, over=over)) for over in ("used", "cycle"))
    for one, other in zip(used.designs, whole.designs, strict=True):
        assert one.mechanism == other.mechanism
        assert set(map(tuple, one.layout.crossings)) <= set(map(tuple, other.layout.crossings))
        assert np.ptp(other.layout.free_range) > np.ptp(one.layout.free_range)


def test_an_input_that_slides_has_places() -> None:
    for design in answer(STEERING, block(60.0)).designs:
        assert design.layout.free_range is None
        low, high = design.layout.free_stroke
        assert high - low == pytest.approx(2.0 * design.metrics.bar_travel)


DRAG_LINK = {
    "type": "fourbar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [20.0, 0.0]},
    "links": {"input": 60.0, "coupler": 70.0, "output": 50.0},
    "coupler_point": {"distance": 30.0, "angle": 10.0},
    "reference_input_angle": 40.0,
}

GEARED = {
    "type": "geared_fivebar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [60.0, 0.0]},
    "links": {"input": 10.0, "coupler_1": 70.0, "coupler_2": 70.0, "output": 12.0},
    "gear_ratio": 2.0,
    "phase": 30.0,
}


def analysed(mechanism: Statement, layout: Statement, **motion: Any) -> Any:
    request = parse_request({"mechanism": mechanism, "motion": motion or {}, "layout": layout})
    assert request.find_errors() == []
    return request.build_answer()["layout"]


def test_a_given_mechanism_is_laid_out_over_its_motion() -> None:
    whole = analysed(DRAG_LINK, block(4.0))
    assert not whole["buildable"]
    (clash,) = whole["clashes"]
    assert tuple(clash["parts"]) == ("input", "pin O4")
    assert clash["input_angle"] % 360.0 == pytest.approx(0.0, abs=0.01) or clash["input_angle"] == pytest.approx(360.0)
    low, high = whole["free_range"]
    part = analysed(DRAG_LINK, block(4.0), **{"from": low, "to": high})
    assert part["buildable"]
    assert part["free_range"] == pytest.approx((low, high))
    assert not analysed(DRAG_LINK, block(4.0), **{"from": low - 1.0, "to": high})["buildable"]
    cycle = analysed(DRAG_LINK, block(4.0, over="cycle"), **{"from": 90.0, "to": 91.0})["free_range"]
    assert np.subtract(cycle, (low, high)) == pytest.approx([360.0, 360.0], abs=0.02), "the cycle begins at 40°"


def test_a_given_mechanism_that_cannot_be_laid_out_says_why() -> None:
    rocker = {**DRAG_LINK, "links": {"input": 60.0, "coupler": 30.0, "output": 40.0}}
    assert "cannot be assembled" in analysed(rocker, block(4.0))["remark"]
    told = analysed({**GEARED, "gear_ratio": 0.0}, block(2.0))
    assert not told["buildable"]
    assert "a ratio other than 0" in told["remark"]


def test_the_gears_of_a_fivebar_take_a_plane() -> None:
    planes = analysed(GEARED, block(4.0))["planes"]
    assert planes["gear of input"] == planes["gear of output"] == planes["idler"]
    assert planes["gear of input"] not in (planes["input"], planes["output"])
