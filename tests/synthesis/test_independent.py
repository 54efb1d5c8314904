"""Answers measured by another route: what both state is the same to a millionth."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from benchmarks.demands.ordinary import KINDS
from benchmarks.independent.cams import FOLLOWERS, LAWS, cams, law
from benchmarks.independent.comparison import Measured
from benchmarks.independent.drive import Drive
from benchmarks.independent.extremes import greatest, least
from benchmarks.independent.linkages import compare, linkages
from benchmarks.independent.transmission import least_angles
from synthesis.dispatch import solve
from synthesis.model.linkage_answer import Skeleton
from synthesis.registry import parse_problem
from tests.campaign import sampled


@pytest.mark.parametrize("name", LAWS)
def test_the_laws_written_out_are_motions(name: str) -> None:
    """From nothing to one, and each derivative that of the one before."""
    u = np.linspace(0.0, 1.0, 20_001)
    s, v, a = law(name, u)
    assert (s[0], s[-1]) == pytest.approx((0.0, 1.0), abs=1e-12)
    assert np.gradient(s, u)[1:-1] == pytest.approx(v[1:-1], abs=1e-6)
    assert np.gradient(v, u)[1:-1] == pytest.approx(a[1:-1], abs=1e-4)


PARALLELOGRAM: dict[str, Any] = {
    "joints": {"O2": [0.0, 0.0], "O4": [4.0, 0.0], "A": [0.0, 2.0], "B": [4.0, 2.0], "P": [2.0, 3.0]},
    "links": [
        {"name": "ground", "joints": ["O2", "O4"]},
        {"name": "input", "joints": ["O2", "A"]},
        {"name": "coupler", "joints": ["A", "B", "P"]},
        {"name": "output", "joints": ["O4", "B"]},
    ],
    "input_link": "input",
}


def test_a_linkage_is_driven_as_its_bars_allow() -> None:
    """A parallelogram: B and P move as A does, and the transmission angle is the crank's own."""
    drive, turns = Drive(Skeleton.model_validate(PARALLELOGRAM)), np.linspace(0.0, 1.0, 200)
    assert drive.follow(0.0, 1.0)
    assert np.abs(drive.joint("B", turns) - (4.0 + 2j * np.exp(1j * turns))).max() < 1e-12
    assert np.abs(drive.joint("P", turns) - (2.0 + 1j + 2j * np.exp(1j * turns))).max() < 1e-12
    assert np.abs(drive.rates_at(turns)[:, drive.names.index("P")] + 2.0 * np.exp(1j * turns)).max() < 1e-11
    assert list(least_angles(drive, 0.0, 1.0).values()) == pytest.approx([90.0 - math.degrees(1.0)])


def test_a_linkage_is_not_driven_beyond_its_toggle() -> None:
    """A triangle that opens: the crank of 2 reaches its limit where coupler and output are in line."""
    stated = PARALLELOGRAM | {"joints": {"O2": [0, 0], "O4": [4, 0], "A": [0, 2], "B": [2, 3], "P": [2, 3]}}
    skeleton = Skeleton.model_validate(stated)
    drive = Drive(skeleton)
    bars = math.hypot(2.0, 1.0) + math.hypot(2.0, 3.0)
    toggle = math.acos((16.0 + 4.0 - bars**2) / 16.0) - 0.5 * math.pi
    assert drive.follow(0.0, toggle - 1e-4)
    assert not drive.follow(0.0, toggle + 1e-4)


def test_a_linkage_keeps_to_its_branch_by_a_change_point() -> None:
    """All but a parallelogram: its other branch comes as near as a thousandth of its size, and is not taken."""
    b = 4.0 + 0.5e-6 + 2j  # a crank that is shorter by a millionth
    stated = PARALLELOGRAM | {"joints": PARALLELOGRAM["joints"] | {"A": [0.0, 2.0 - 1e-6], "B": [b.real, b.imag]}}
    drive, turns = Drive(Skeleton.model_validate(stated)), np.linspace(0.0, math.tau, 5000)
    assert drive.follow(0.0, math.tau)
    z = drive.at(turns)
    a, b_at, o4 = (z[:, drive.names.index(name)] for name in ("A", "B", "O4"))
    sense = (np.conj(b_at - a) * (b_at - o4)).imag
    assert np.all(np.sign(sense) == np.sign(sense[0]))


def test_a_block_and_a_slide_are_driven() -> None:
    """Scott-Russell's slider-crank: P stays on its line, and the crank's end is halfway between P and B."""
    skeleton = Skeleton.model_validate(
        {
            "joints": {"O2": [0.0, 0.0], "A": [0.6, 0.8], "B": [1.2, 0.0], "P": [0.0, 1.6]},
            "links": [
                {"name": "ground", "joints": ["O2"]},
                {"name": "crank", "joints": ["O2", "A"]},
                {"name": "coupler", "joints": ["A", "B", "P"]},
            ],
            "slides": [{"joint": "B", "link": "ground", "point": [1.2, 0.0], "angle": 0.0}],
            "input_link": "crank",
        }
    )
    drive, turns = Drive(skeleton), np.linspace(-0.5, 0.5, 100)
    assert drive.follow(-0.5, 0.5)
    assert np.abs(drive.joint("P", turns).real).max() < 1e-12
    assert least(lambda u: drive.joint("P", u).imag, -0.5, 0.5).value == pytest.approx(
        2.0 * math.sin(math.atan2(0.8, 0.6) - 0.5)
    )


def test_peaks_between_the_steps_are_found() -> None:
    """Of two peaks the higher one lies between two places of the grid."""
    at, value = greatest(lambda x: np.maximum(np.cos(x - 1.2345678), 0.9995 * np.cos(x - 4.0)), 0.0, 6.0, grid=61)
    assert (at, value) == pytest.approx((1.2345678, 1.0), abs=1e-6)
    assert math.isnan(greatest(lambda x: np.where(x > 1.0, np.nan, x), 0.0, 2.0).value)


def test_a_difference_is_seen() -> None:
    result = Measured()
    result.add("size", 1.0 + 2e-6, 1.0, 1.0, "off")
    result.add("size", 1.0 + 2e-7, 1.0, 1.0, "near")
    result.add("size", None, 1.0, 1.0, "not stated")
    result.add("angle", math.nan, 1.0, 1.0, "unknown")
    assert {difference.name for difference in result.over} == {"off", "unknown"}


def test_cams_of_every_follower_agree() -> None:
    result = Measured()
    assert cams(2 * len(FOLLOWERS), 7, result) == 2 * len(FOLLOWERS)
    assert not result.over, result.report()
    assert sum(map(len, result.differences.values())) > 60


QUICK = (
    "three positions",
    "function",
    "pairs",
    "quick return",
    "straight line",
    "dwell",
    "steering",
    "parallel motion",
)
"""Names of tasks whose answers take less than a second each."""


@pytest.mark.parametrize("name", QUICK)
def test_a_linkage_of_a_kind_agrees(name: str) -> None:
    result = Measured()
    assert linkages(1, (name,), 3, result, most=4)
    assert not result.over, result.report()
    assert sum(map(len, result.differences.values())) >= 8


DYADS = [
    {"output_side": {"dyad": "RP"}},
    {"output_side": {"dyad": "PR", "slide_angle": 15}},
    {"input_side": {"dyad": "PR"}},
    *({"driver_dyad": {"link": link}} for link in ("input", "output", "coupler")),
]


@pytest.mark.parametrize("asked", DYADS, ids=str)
def test_sliders_and_drivers_agree(asked: dict[str, Any]) -> None:
    poses = [{"x": 0, "y": 0, "angle": 0}, {"x": 40, "y": 15, "angle": -25}, {"x": 75, "y": 5, "angle": -60}]
    stated, result = {"kind": "motion", "positions": poses, **asked}, Measured()
    designs = solve(parse_problem(stated)).designs[:3]
    assert designs
    for k, design in enumerate(designs):
        compare(result, stated, design, f"design {k}")
    assert not result.over, result.report()
    assert len(result.differences["motion transmission_angles"]) >= len(designs)


@pytest.mark.campaign
def test_many_cams_agree() -> None:
    result = Measured()
    assert cams(200, 11, result) >= 190
    assert not result.over, result.report()


SLOW = ("four points", "ten points")
"""Names of tasks whose answers take many seconds."""


@pytest.mark.campaign
@pytest.mark.parametrize("name", [name for name, _ in KINDS if name not in SLOW])
def test_many_linkages_agree(name: str) -> None:
    result = Measured()
    linkages(sampled(12), (name,), 11, result, most=3)
    assert not result.over, result.report()


POINTS = [(0, 0, 0), (20, 12, 20), (42, 16, 42), (60, 10, 60), (75, -3, 85)]

OTHERS: dict[str, dict[str, Any]] = {
    "timed path": {
        "kind": "path",
        "timing": "prescribed",
        "points": [{"x": x, "y": y, "crank_angle": angle} for x, y, angle in POINTS],
    },
    "slider-crank along a path": {
        "kind": "path",
        "mechanism": "slider_crank",
        "points": [{"x": x, "y": y} for x, y, _ in POINTS],
    },
    "slider-crank by a function": {
        "kind": "function",
        "mechanism": "slider_crank",
        "function": {"name": "sine", "x": [0, 60]},
        "input_range": 60,
        "output_range": 50,
    },
    "slider that dwells": {"kind": "dwell", "dwell_angle": 40, "output": {"type": "slider", "stroke": 50}},
    "two dwells": {"kind": "dwell", "dwell_angle": 30, "count": 2, "output": {"type": "rocker", "swing": 40}},
    "slot that dwells": {
        "kind": "dwell",
        "dwell_angle": 40,
        "output": {"type": "rocker", "swing": 40},
        "mechanism": "straight_slot",
    },
    "rockers that return quickly": {"kind": "quick_return", "time_ratio": 1.25, "swing": 45.0, "mechanism": "auto"},
    "a line with an even velocity": {"kind": "straight_line", "length": 80, "optimize": "velocity", "direction": 30},
}


@pytest.mark.campaign
@pytest.mark.parametrize("name", OTHERS)
def test_other_types_agree(name: str) -> None:
    result = Measured()
    designs = solve(parse_problem(OTHERS[name])).designs[:2]
    assert designs
    for k, design in enumerate(designs):
        compare(result, OTHERS[name], design, f"{name}, design {k}")
    assert not result.over, result.report()
    assert result.differences
