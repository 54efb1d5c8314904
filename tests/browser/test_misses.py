"""Where no design satisfies all demands, a button states what the nearest miss has, and that has an answer."""

import pytest

from synthesis.registry import list_examples
from tests.browser.conftest import ANSWERED
from tests.support.browser.studio import state, stated

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

THREE = [{"x": 0, "y": 0, "angle": 0}, {"x": 20, "y": 10, "angle": 25}, {"x": 45, "y": 8, "angle": 60}]
MOTION = {"kind": "motion", "positions": THREE, "max_designs": 2}
BLOCK = {"link_width": 0.1, "pin_diameter": 0.05, "thickness": 5.0, "gap": 0.02, "shafts": "both_sides"}

# What none keeps, what the first button says, and where the statement has another value after it.
MISSED = {
    "zone": (
        {**MOTION, "constraints": {"fixed_pivot_region": {"x": [300, 310], "y": [-5, 5]}}},
        "Solve with fixed pivot region wider by",
        ("constraints", "fixed_pivot_region", "x"),
    ),
    "two limits": (
        {**MOTION, "constraints": {"min_transmission_angle": 85, "max_link_ratio": 1.05}},
        "Solve with",
        ("constraints",),
    ),
    "gears": (
        {"kind": "gear_train", "ratio": "pi", "tolerance": 0.0, "max_stages": 1},
        "Solve with tolerance",
        ("tolerance",),
    ),
    "planes": (
        {
            "kind": "quick_return", "time_ratio": 1.4, "stroke": 1.0, "mechanism": "drag_link_slider",
            "layout": {**BLOCK, "max_planes": 3},
        },
        "Solve with planes 4",
        ("layout", "max_planes"),
    ),
    "dwell": (
        {**list_examples("dwell")[1], "count": 1, "dwell_angle": 300.0, "max_designs": 1},
        "Solve with dwell angle",
        ("dwell_angle",),
    ),
}  # fmt: skip


def at(problem, path):
    for name in path:
        problem = problem[name]
    return problem


@pytest.mark.parametrize("name", MISSED)
def test_what_the_nearest_miss_has_is_offered_and_has_an_answer(studio, name):
    page = studio.page
    problem, said, path = MISSED[name]
    state(page, problem)
    studio.solve()
    page.wait_for_selector("#miss")
    assert page.locator("#miss .bad").count() > 0
    button = page.locator("#miss button").first
    assert button.inner_text().startswith(said)
    button.click()
    page.wait_for_selector("#result .card", timeout=200_000)
    page.wait_for_selector(ANSWERED)
    assert page.locator("#miss").count() == 0
    assert at(stated(page), path) != at(problem, path)
    assert page.locator(".card .bad").count() == 0
