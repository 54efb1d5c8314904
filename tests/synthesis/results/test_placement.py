"""Linkages whose place is free are put where regions and limits of length let them be, and nowhere else."""

import cmath
import math

import pytest

from synthesis import parse_problem
from synthesis.registry import KINDS
from tests.campaign import further

SWINGS = ("fourbar", "drag_link_rocker")
SLIDES = ("offset_slider_crank", "crank_shaper", "whitworth", "drag_link_slider")
TASKS = {
    **{name: {"kind": "quick_return", "time_ratio": 1.25, "swing": 45.0, "mechanism": name} for name in SWINGS},
    **{name: {"kind": "quick_return", "time_ratio": 1.4, "stroke": 60.0, "mechanism": name} for name in SLIDES},
    "dwell_rocker": {
        "kind": "dwell", "dwell_angle": 60.0, "output": {"type": "rocker", "swing": 60.0}, "mechanism": "pseudo_arc",
    },
    "dwell_slot": {
        "kind": "dwell", "dwell_angle": 50.0, "output": {"type": "rocker", "swing": 50.0}, "mechanism": "straight_slot",
    },
    "dwell_slider": {"kind": "dwell", "dwell_angle": 60.0, "output": {"type": "slider", "stroke": 50.0}},
}  # fmt: skip

QUICK = [name for name in TASKS if not name.startswith("dwell")]

LARGER = 1.7
"""Size of the place that a linkage of free size is to take."""


def designs_of(statement):
    return KINDS[statement["kind"]].solve(parse_problem(statement), lambda fraction, message: None).designs


def box(places):
    margin = 0.01 * max(abs(one - other) for one in places for other in places) + 0.1
    x, y = [place.real for place in places], [place.imag for place in places]
    return {"x": [min(x) - margin, max(x) + margin], "y": [min(y) - margin, max(y) + margin]}


def demands(design, size):
    """Regions around a design that is moved, turned and made larger or smaller."""
    skeleton = design.mechanism.skeleton
    still = next(link.joints for link in skeleton.links if link.name == "ground")
    along = size * cmath.exp(2.3j)
    places = {name: 300.0 - 200.0j + along * complex(*place) for name, place in skeleton.joints.items()}
    return {
        "fixed_pivot_region": box([place for name, place in places.items() if name in still]),
        "moving_pivot_region": box([place for name, place in places.items() if name not in (*still, "P")]),
    }


@pytest.mark.parametrize("name", further(TASKS, QUICK))
def test_a_free_linkage_is_put_into_its_regions(name):
    free = designs_of(TASKS[name])[0]
    own_size = LARGER if name in (*SWINGS, "dwell_rocker", "dwell_slot") else 1.0
    constraints = demands(free, own_size)
    found = designs_of({**TASKS[name], "constraints": constraints})
    assert found
    assert all(design.verification.passed for design in found)
    checked = {check.name for design in found for check in design.verification.checks}
    assert {"fixed_pivot_region", "moving_pivot_region"} <= checked
    # It does there what it does elsewhere.
    same = [d for d in found if math.isclose(d.metrics.quality, free.metrics.quality, rel_tol=1e-6)]
    assert same
    assert same[0].metrics.link_ratio == pytest.approx(free.metrics.link_ratio, rel=1e-9)


@pytest.mark.parametrize("name", further(TASKS, QUICK))
def test_a_linkage_whose_place_is_stated_stays_there(name):
    field = "pivot" if name.startswith("dwell") else "crank_pivot"
    constraints = demands(designs_of(TASKS[name])[0], 1.0)
    assert designs_of({**TASKS[name], field: [0.0, 0.0], "constraints": constraints}) == []


@pytest.mark.parametrize("name", further(["fourbar", "drag_link_rocker", "dwell_rocker"], QUICK))
def test_lengths_within_limits_whatever_the_size_is_by_default(name):
    lengths = {"link_length": {"min": 35.0, "max": 600.0}}
    found = designs_of({**TASKS[name], "constraints": lengths})
    assert found
    for design in found:
        links = design.mechanism.links
        values = list((links if isinstance(links, dict) else links.model_dump()).values())
        assert min(values) >= 35.0 * (1.0 - 1e-9)
        assert max(values) <= 600.0 * (1.0 + 1e-9)
