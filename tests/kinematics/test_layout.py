"""Layouts: known linkages, laws, and solids that are moved through the motion."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from kinematics.errors import DimensionError
from kinematics.linkage import Fourbar, GearPair, Mechanism, Slide, TopologyError, catalogue
from kinematics.linkage.layout import Layout, arrange_planes
from kinematics.linkage.layout.parts import build_parts
from tests.campaign import further
from tests.support.problems.layout import Task, drive_of, judged, tasks

TURN = 2.0 * math.pi

CRANK_ROCKER = catalogue.make_fourbar(Fourbar(0.0, 6.0, 2.0, 7.0, 9.0, 3.0 + 1.0j), 0.5)
"""Norton, Table P4-1, row a; the crank sweeps no pivot."""

DRAG_LINK = catalogue.make_fourbar(Fourbar(0.0, 2.0, 6.0, 7.0, 5.0), 0.5)

SMALL: dict[str, Any] = {"link_width": 0.4, "pin_diameter": 0.2, "gap": 0.05}


def over_a_turn(mechanism: Mechanism, **changes: Any) -> Layout:
    at = float(mechanism.reference_input)
    return arrange_planes(mechanism, at, at + TURN, **{**SMALL, "closed": True, **changes})


def test_a_crank_rocker_takes_two_planes() -> None:
    layout = over_a_turn(CRANK_ROCKER)
    assert layout.planes["input"] == layout.planes["output"] != layout.planes["coupler"]
    assert max(layout.planes.values()) == 2
    assert layout.clashes == layout.stub_shafts == []
    assert layout.free == (0.5, 0.5 + TURN)
    # The coupler's pin passes within a link's width of the crank's pivot only where links are wide.
    assert ("coupler", "pin O2") in layout.crossings
    assert layout.pins["O2"] == (0, layout.planes["input"])


def test_the_cranks_of_a_drag_link_turn_on_two_bases() -> None:
    """Each crank sweeps over the pivot of the other (Norton, Sec. 2.13): shafts from one side clash."""
    one = over_a_turn(DRAG_LINK)
    assert one.stub_shafts == []
    (clash,) = one.clashes
    assert clash.distance < 0.0
    assert clash.parts in {("input", "pin O4"), ("output", "pin O2")}
    assert one.free is not None
    assert 0.0 < one.free[1] - one.free[0] < TURN
    both = over_a_turn(DRAG_LINK, through=True)
    assert both.clashes == []
    assert both.stub_shafts == ["O2", "O4"]
    assert {both.pins["O2"], both.pins["O4"]} == {(0, 1), (3, 4)}
    assert both.planes["coupler"] == 2


def test_a_clash_is_told_where_the_parts_come_nearest() -> None:
    """The crank passes over O4 where it points at it, and reaches beyond it."""
    (clash,) = over_a_turn(DRAG_LINK).clashes
    assert clash.parts == ("input", "pin O4")
    assert math.remainder(clash.at, TURN) == pytest.approx(0.0, abs=1e-4)
    assert clash.distance == pytest.approx(-0.3, abs=1e-4), "as far as both are widened"


def test_pins_of_one_link_that_overlap_are_told_wherever_the_input_stands() -> None:
    """A crank of 2 with pins of 2.5 is an eccentric, and not built of a link and pins."""
    layout = over_a_turn(CRANK_ROCKER, link_width=3.0, pin_diameter=2.5)
    assert ("pin O2", "pin A") in [clash.parts for clash in layout.clashes]
    assert layout.free is None
    (clash,) = [clash for clash in layout.clashes if clash.parts == ("pin O2", "pin A")]
    assert clash.distance == pytest.approx(2.0 - 2.5)


@pytest.mark.parametrize(("field", "value"), [("link_width", 0.8), ("pin_diameter", 0.4), ("gap", 0.3)])
def test_every_size_takes_of_the_free_range(field: str, value: float) -> None:
    layouts = over_a_turn(DRAG_LINK), over_a_turn(DRAG_LINK, **{field: value})
    free = [layout.free[1] - layout.free[0] for layout in layouts if layout.free is not None]
    assert free[1] < free[0] - 0.01


def test_a_part_of_the_motion_meets_less() -> None:
    whole, part = over_a_turn(DRAG_LINK), arrange_planes(DRAG_LINK, 1.5, 1.7, **SMALL)
    assert set(part.crossings) < set(whole.crossings)
    assert part.clashes == []
    assert part.free == (1.5, 1.7)


def test_the_free_range_of_a_cycle_may_begin_anywhere_in_it() -> None:
    """It is found whichever input the cycle is said to begin with, and laid out over it nothing clashes."""
    ranges = []
    for start in (0.5, 2.0, 4.0):
        layout = arrange_planes(DRAG_LINK, start, start + TURN, closed=True, **SMALL)
        assert layout.free is not None
        low, high = layout.free
        assert arrange_planes(DRAG_LINK, low, high, **SMALL).clashes == []
        ranges.append((low % TURN, high - low))
    assert np.ptp(ranges, axis=0) == pytest.approx([0.0, 0.0], abs=1e-3)


def test_a_slotted_link_reaches_as_far_as_its_block_does() -> None:
    """Crank-shaper: the block's way in the rocker is from ground − crank to ground + crank beyond O4."""
    shaper = catalogue.make_quick_return(0.0, -5.0j, 2.0, 4.0, 9.0, 3.0j, 0.0, 0.3)
    at = float(shaper.reference_input)
    parts = build_parts(shaper, 0.4, 0.2, at, at + TURN)
    (rocker,) = [plate for plate in parts.plates if plate.name == "rocker"]
    reach = np.abs(rocker.outline.points + 5.0j)
    assert reach.min() == pytest.approx(0.0, abs=1e-9)
    assert reach.max() == pytest.approx(7.0, abs=1e-9)
    (block,) = [pin for pin in parts.pins if pin.joint == "A"]
    assert {parts.plates[n].name for n in block.plates} == {"input", "rocker"}
    (ram,) = [pin for pin in parts.pins if pin.joint == "D"]
    assert ram.grounded


def test_a_slot_for_a_longer_block_reaches_farther() -> None:
    shaper = catalogue.make_quick_return(0.0, -5.0j, 2.0, 4.0, 9.0, 3.0j, 0.0, 0.3)
    at = float(shaper.reference_input)
    plates = build_parts(shaper, 0.4, 0.2, at, at + TURN, slot_ends=0.75).plates
    (rocker,) = [plate for plate in plates if plate.name == "rocker"]
    assert np.abs(rocker.outline.points + 5.0j).max() == pytest.approx(7.75, abs=1e-9)


def test_where_only_the_whole_motion_will_do_no_free_range_is_looked_for() -> None:
    known, asked = over_a_turn(DRAG_LINK), over_a_turn(DRAG_LINK, whole=True)
    assert (asked.free, [clash.parts for clash in asked.clashes]) == (None, [clash.parts for clash in known.clashes])
    assert over_a_turn(CRANK_ROCKER, whole=True) == over_a_turn(CRANK_ROCKER)


def test_a_coupler_point_is_part_of_its_plate_and_no_pin() -> None:
    parts = build_parts(CRANK_ROCKER, 0.4, 0.2, 0.0, 1.0)
    (coupler,) = [plate for plate in parts.plates if plate.name == "coupler"]
    assert set(coupler.outline.points) == {complex(CRANK_ROCKER.joints[name]) for name in "ABP"}
    assert sorted(pin.joint for pin in parts.pins) == ["A", "B", "O2", "O4"]


def test_a_joint_of_three_links_has_one_pin_through_all_of_them() -> None:
    cell = catalogue.make_peaucellier(0.0, -2.0, 2.0, 6.0, 3.0, 0.4)
    layout = arrange_planes(cell, 0.1, 0.7, **SMALL)
    planes = [layout.planes[name] for name in ("input", "side_1", "side_2")]
    assert len(set(planes)) == 3
    assert layout.pins["A"] == (min(planes), max(planes))


def five_bar(ratio: float, o5: complex = 6.0) -> Mechanism:
    return catalogue.make_geared_fivebar(0.0, o5, 1.0, 7.0, 7.0, 1.0, ratio, 0.6, 0.3)


@pytest.mark.parametrize(
    ("ratio", "radii", "centres"),
    [(-1.0, [3.0, 3.0], [0.0, 6.0]), (-2.0, [4.0, 2.0], [0.0, 6.0]), (1.0, [1.5, 1.5, 1.5], [0.0, 6.0, 3.0]),
     (2.0, [2.4, 1.2, 1.2], [0.0, 6.0, 3.6])],
)  # fmt: skip
def test_gears_touch_on_the_line_of_their_pivots(ratio: float, radii: list[float], centres: list[float]) -> None:
    parts = build_parts(five_bar(ratio), 0.4, 0.2, 0.3, 0.4)
    (mesh,) = parts.meshes
    outlines = [parts.plates[n].outline for n in mesh]
    assert [outline.radius for outline in outlines] == pytest.approx(radii)
    assert [complex(outline.points[0]) for outline in outlines] == pytest.approx(centres)


def test_gears_lie_in_one_plane_apart_from_their_cranks() -> None:
    layout = over_a_turn(five_bar(2.0))
    gears = {layout.planes[name] for name in ("gear of input", "gear of output", "idler")}
    assert len(gears) == 1
    assert not gears & {layout.planes["input"], layout.planes["output"]}
    assert layout.pins["idler"] == (0, *gears)
    assert ("gear of input", "gear of output") not in layout.crossings


@pytest.mark.parametrize("mechanism", [five_bar(0.0), five_bar(1.0, 0.0)], ids=["no ratio", "one shaft"])
def test_gears_that_cannot_be(mechanism: Mechanism) -> None:
    with pytest.raises(TopologyError, match="gears of"):
        build_parts(mechanism, 0.4, 0.2, 0.3, 0.4)


def test_a_gear_needs_a_shaft() -> None:
    joints = {"O2": 0.0, "O4": 6.0, "A": 1.0 + 1.0j, "B": 5.0 + 3.0j, "C": 2.0 + 4.0j}
    links = {
        "ground": ("O2", "O4"),
        "input": ("O2", "A"),
        "coupler": ("A", "C"),
        "arm": ("B", "C"),
        "output": ("O4", "B"),
    }
    mechanism = Mechanism(joints, links, "input", gears=(GearPair("input", "coupler", -1.0),))
    with pytest.raises(TopologyError, match="no shaft"):
        build_parts(mechanism, 0.4, 0.2, 0.3, 0.4)


def test_joints_of_one_link_at_one_place_have_one_pin() -> None:
    """A body pinned to the coupler at B, where the rocker is: one pin for three."""
    joints = {"O2": 0.0, "O4": 6.0, "A": 1.0 + 1.0j, "B": 5.0 + 3.0j, "C": 5.0 + 3.0j, "D": 8.0 + 4.0j}
    links = {
        "ground": ("O2", "O4"),
        "input": ("O2", "A"),
        "coupler": ("A", "B", "C"),
        "output": ("O4", "B"),
        "link_5": ("C", "D"),
    }
    slide = Slide("D", "ground", np.asarray(8.0 + 4.0j), np.asarray(0.2))
    parts = build_parts(Mechanism(joints, links, "input", (slide,)), 0.4, 0.2, 0.75, 0.8)
    (pin,) = [pin for pin in parts.pins if pin.joint in ("B", "C")]
    assert {parts.plates[n].name for n in pin.plates} == {"coupler", "output", "link_5"}


@pytest.mark.parametrize("turn", [0.0, 2.0, -1.1])
@pytest.mark.parametrize("scale", [1.0, 1e-3, 1e4])
def test_size_and_place_change_nothing(turn: float, scale: float) -> None:
    along, shift = scale * np.exp(1j * turn), scale * (3.0 - 40.0j)
    moved = Mechanism({name: shift + along * z for name, z in DRAG_LINK.joints.items()}, DRAG_LINK.links, "input")
    there = over_a_turn(moved, **{name: scale * size for name, size in SMALL.items()})
    here = over_a_turn(DRAG_LINK)
    assert there.planes == here.planes
    assert there.crossings == here.crossings
    assert here.free is not None
    assert there.free is not None
    assert np.mod(np.subtract(there.free, here.free) - turn + 1.0, TURN) == pytest.approx([1.0, 1.0], abs=1e-3)


RANDOM, ALWAYS = 30, 10


@cache
def random_tasks(count: int) -> list[Any]:
    """The first linkages with their drives; to find them takes a second or so each."""
    return list(tasks(count, seed=5))


@pytest.mark.slow
@pytest.mark.parametrize("number", further(range(RANDOM), range(ALWAYS)))
def test_solids_in_motion_agree(number: int) -> None:
    verdict = judged(*random_tasks(ALWAYS if number < ALWAYS else RANDOM)[number])
    assert verdict.said == ""


def test_a_wrong_layout_is_seen() -> None:
    """The comparison itself: with one plane for all, or another number of planes, it says so."""
    task = Task("fourbar", DRAG_LINK, 0.1, 1.2, False, 0.4, 0.2, 0.05, False)
    drive = drive_of(DRAG_LINK)
    assert drive.follow(task.low, task.high)

    assert judged(task, drive).said == ""
    right = task.answer()

    def said_of(wrong: Layout) -> str:
        class Wrong(Task):
            def answer(self) -> Layout:
                return wrong

        return judged(Wrong(*task), drive).said

    assert "solids meet" in said_of(replace(right, planes={"input": 1, "coupler": 1, "output": 1}))
    assert "planes where" in said_of(replace(right, planes={"input": 1, "coupler": 2, "output": 5}))
    assert "crossings differ" in said_of(replace(right, crossings=[("input", "pin B")]))


def many_pivots(count: int) -> Mechanism:
    """Rockers in a row, each driven from the one before: plates and pivots as many as are wanted."""
    joints: dict[str, Any] = {"O0": 0.0, "J0": 1.0 + 0.3j}
    links: dict[str, tuple[str, ...]] = {"ground": tuple(f"O{k}" for k in range(count)), "input": ("O0", "J0")}
    for k in range(1, count):
        joints |= {f"O{k}": 3.0 * k, f"J{k}": 3.0 * k + 0.2 + (2.5 + 0.1 * k) * 1j}
        links |= {f"coupler_{k}": (f"J{k - 1}", f"J{k}"), f"rocker_{k}": (f"O{k}", f"J{k}")}
    return Mechanism(joints, links, "input")


def test_what_takes_too_long_is_refused_and_not_begun() -> None:
    row = many_pivots(6)
    low, high = float(row.reference_input), float(row.reference_input) + 0.01
    assert max(arrange_planes(row, low, high, **SMALL).planes.values()) >= 2
    with pytest.raises(DimensionError, match="stub shafts must be fewer"):
        arrange_planes(row, low, high, through=True, **{**SMALL, "link_width": 6.0})
    with pytest.raises(DimensionError, match="plates must be at most 12"):
        arrange_planes(many_pivots(8), low, high, **SMALL)
