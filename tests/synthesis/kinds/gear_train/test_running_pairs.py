"""Pairs of gears as they run: against gears that a rack and a cutter left, printed examples, and by laws."""

from __future__ import annotations

import math
from typing import Any

import pytest

from synthesis.analyses import parse_request
from synthesis.mechanisms.base import MechanismError
from tests.campaign import further
from tests.support.independent.cut_gears import external, involute_radius, rack
from tests.support.problems.gears import Compared, compare_pair, compare_pairs


def analysed(**fields: Any) -> dict[str, Any]:
    request = parse_request({"mechanism": {"type": "gear_pair", **fields}, "speed_rpm": 60.0})
    assert request.find_errors() == []
    return request.build_answer()


PAIRS: list[dict[str, Any]] = [
    {"teeth": [20, 50], "shift": [0.4, 0.1]},
    {"teeth": [14, 33], "shift": [0.5, -0.2], "pressure_angle": 25.0, "play": 0.12},
    {"teeth": [12, 40], "shift": [0.0, 0.0]},
    {"teeth": [20, 60], "shift": [0.3, 0.3], "internal": True, "addendum": [1.0, 0.7], "cutter_teeth": 20},
    {
        "teeth": [24, 70],
        "shift": [0.1, 0.2],
        "internal": True,
        "addendum": [1.0, 0.7],
        "cutter_teeth": 30,
        "play": -0.1,
    },
    {"teeth": [30, 60], "shift": [0.0, 0.0], "internal": True, "addendum": [1.0, 1.0], "cutter_teeth": 20},
]


@pytest.mark.parametrize("pair", further(PAIRS, PAIRS[::3]))
def test_cut_gears_show_the_same(pair: dict[str, Any]) -> None:
    stated = {"type": "gear_pair", "pressure_angle": 20.0, "internal": False, **pair}
    play = stated.pop("play", None)
    said = analysed(**stated)
    if play is not None:
        stated["centre_distance"] = said["tight_distance"] + play
        said = analysed(**stated)
    found = Compared()
    compare_pair(stated, said, found)
    assert found.faults == []
    faulty = any(gear["undercut"] or gear["fillet_interference"] for gear in said["gears"])
    assert found.measured == (not faulty)


@pytest.mark.campaign
@pytest.mark.timeout(1800)
def test_500_random_pairs() -> None:
    found = compare_pairs(500, 1)
    assert found.faults == []
    assert found.sound > 250
    assert found.in_fillet > 10
    assert found.undercut > 20


@pytest.mark.parametrize("teeth", [9, 13, 15, 16, 17, 20])
@pytest.mark.parametrize("shift", [-0.3, 0.0])
def test_the_involute_of_an_undercut_gear_begins_where_the_fillet_crosses_it(teeth: int, shift: float) -> None:
    """As a rack cut the gear, point by point."""
    told = analysed(teeth=[teeth, 40], shift=[shift, 0.0])["gears"][0]
    assert told["undercut"] == (teeth < 18 or shift < 0.0)
    cut = external(teeth, shift, 1.0, rack(math.radians(20.0)))
    assert 0.5 * told["form_diameter"] == pytest.approx(involute_radius(cut), abs=5e-5)
    assert 0.5 * told["form_diameter"] > 0.5 * told["base_diameter"]


def test_a_ring_reaches_below_the_involute_of_an_undercut_pinion() -> None:
    """A ring whose tip stops at the base circle of its pinion still meets what the rack has taken away."""
    told = analysed(teeth=[13, 40], internal=True, addendum=[1.0, 0.647271])
    pinion = told["gears"][0]
    assert pinion["undercut"]
    assert pinion["fillet_interference"]
    assert pinion["involute_left"] < -0.3
    short = analysed(teeth=[13, 40], internal=True, addendum=[1.0, 0.52])
    assert not short["gears"][0]["fillet_interference"]


def test_full_depth_ring_reaches_into_the_fillet_of_its_pinion() -> None:
    """The tip of a ring reaches deeper than the rack that cut the pinion; a shorter addendum does not."""
    full = analysed(teeth=[30, 60], internal=True)
    assert [gear["fillet_interference"] for gear in full["gears"]] == [True, False]
    assert not full["sound"]
    short = analysed(teeth=[30, 60], internal=True, addendum=[1.0, 0.8])
    assert short["sound"]
    assert short["contact_ratio"] < full["contact_ratio"]


def test_a_small_cutter_leaves_its_fillet_in_the_way() -> None:
    """The ring's involute ends where the cutter's tip left it: a large pinion comes near it."""
    large = analysed(teeth=[40, 80], internal=True, addendum=[1.0, 0.7], cutter_teeth=40)
    small = analysed(teeth=[40, 80], internal=True, addendum=[1.0, 0.7], cutter_teeth=14)
    assert small["gears"][1]["involute_left"] < large["gears"][1]["involute_left"]


def test_play_is_exact_and_not_linear() -> None:
    """Norton's estimate 2 ΔC tan φ (eq. 9.3) is 3 % off for so small a change."""
    apart = 0.2
    found = analysed(teeth=[20, 50], centre_distance=35.0 + apart)
    linear = 2.0 * apart * math.tan(math.radians(20.0))
    assert found["backlash"] == pytest.approx(0.149517, abs=1e-6)
    assert linear / found["backlash"] == pytest.approx(0.974, abs=1e-3)


def test_units_and_scale() -> None:
    one = analysed(teeth=[17, 39], shift=[0.3, 0.2], centre_distance=29.0)
    large = analysed(teeth=[17, 39], shift=[0.3, 0.2], centre_distance=29.0e6, module=1e6)
    for name in ("backlash", "tip_shortening", "clearance", "tight_distance"):
        assert large[name] == pytest.approx(1e6 * one[name])
    assert large["contact_ratio"] == pytest.approx(one["contact_ratio"])


def test_helical_gears_in_the_plane_of_rotation() -> None:
    """With no shift it is what `helical_pair` says of the same gears."""
    found = analysed(teeth=[20, 50], module=3.0, helix_angle=18.0, face_width=40.0)
    pair = {"type": "helical_pair", "teeth": [20, 50], "normal_module": 3.0, "helix_angle": 18.0, "face_width": 40.0}
    other = parse_request({"mechanism": pair}).build_answer()
    assert found["centre_distance"] == pytest.approx(other["centre_distance"])
    assert found["contact_ratio"] == pytest.approx(other["transverse_contact_ratio"])
    assert found["overlap_ratio"] == pytest.approx(other["face_contact_ratio"])


def test_shifted_pair_of_iso_21771_practice() -> None:
    """SDP/SI, Elements of Metric Gear Technology, Table 4-4: m 3, 12 and 24 teeth, x 0.6 and 0.36."""
    found = analysed(teeth=[12, 24], module=3.0, shift=[0.6, 0.36])
    assert found["working_pressure_angle"] == pytest.approx(26.0886, abs=5e-5)
    assert found["centre_distance"] == pytest.approx(56.4999, abs=5e-5)
    assert [gear["tip_diameter"] for gear in found["gears"]] == pytest.approx([44.840, 79.4], abs=0.005)
    assert [gear["root_diameter"] for gear in found["gears"]] == pytest.approx([32.1, 66.66], abs=0.005)


@pytest.mark.parametrize(
    ("fields", "path"),
    [
        ({"teeth": [60, 20], "internal": True}, "/mechanism/teeth"),
        ({"teeth": [20, 60], "cutter_teeth": 20}, "/mechanism/cutter_teeth"),
        ({"teeth": [20, 60], "internal": True, "cutter_teeth": 60}, "/mechanism/cutter_teeth"),
    ],
)
def test_faults(fields: dict[str, Any], path: str) -> None:
    request = parse_request({"mechanism": {"type": "gear_pair", **fields}})
    assert [fault[0] for fault in request.find_errors()] == [path]


def test_shafts_too_near_one_another() -> None:
    request = parse_request({"mechanism": {"type": "gear_pair", "teeth": [20, 50], "centre_distance": 30.0}})
    with pytest.raises(MechanismError, match="base circles"):
        request.build_answer()
