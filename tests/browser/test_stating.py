"""Stating on the canvas, kind by kind: what stands in the plane is dragged, turned, added and removed."""

import math

import pytest

from synthesis.registry import KINDS, list_examples
from tests.support.browser.studio import drag, state, stated

pytestmark = pytest.mark.browser

PLANAR = ["motion", "path", "function", "quick_return", "straight_line", "steering", "dwell", "parallel_motion"]


def handle(name):
    return f"#sketch .target:has(text:text-is('{name}'))"


def press(page, name, *keys):
    page.locator(handle(name)).focus()
    for key in keys:
        page.keyboard.press(key)


def test_pivots_and_regions_of_a_motion_are_dragged(studio):
    page = studio.page
    problem = {
        **list_examples("motion")[0],
        "ground_line": {"point": [0, -40], "angle": 10},
        "constraints": {"fixed_pivot_region": {"x": [-20, 60], "y": [-70, -10]}},
    }
    state(page, problem)
    drag(page, handle("ground") + " .knob", (0, -60))
    assert stated(page)["ground_line"]["angle"] > 20
    before = stated(page)["constraints"]["fixed_pivot_region"]
    drag(page, handle("fixed pivots") + " .dot", (20, -15))
    region = stated(page)["constraints"]["fixed_pivot_region"]
    assert region["x"][1] > before["x"][1]
    assert region["y"][1] > before["y"][1]
    assert region["x"][0] == before["x"][0]
    page.get_by_role("button", name="Choose O2").click()
    press(page, "O2", "ArrowRight")
    assert len(stated(page)["input_side"]["fixed_pivot"]) == 2
    press(page, "O2", "Delete")
    assert stated(page)["input_side"]["fixed_pivot"] is None
    assert page.locator(handle("O2")).count() == 0


def test_points_of_a_path_are_clicked_and_its_pivots_chosen(studio):
    page = studio.page
    page.select_option("#kind", "path")
    count = len(stated(page)["points"])
    page.locator("#sketch svg").dblclick(position={"x": 60, "y": 60})
    assert len(stated(page)["points"]) == count + 1
    page.get_by_role("button", name="Choose the fixed pivots").click()
    drag(page, handle("O4") + " .dot", (25, 10))
    pivots = stated(page)["fixed_pivots"]
    assert pivots["output"][0] > pivots["input"][0]
    assert pivots["output"][1] < pivots["input"][1]


def test_pairs_of_a_function_are_dragged_on_its_graph(studio):
    page = studio.page
    page.select_option("#kind", "function")
    page.get_by_role("button", name="Use pairs instead").click()
    before = stated(page)["pairs"]
    drag(page, handle("2") + " .dot", (0, -30))
    after = stated(page)["pairs"]
    assert after[1]["output"] > before[1]["output"]
    assert after[1]["input"] == pytest.approx(before[1]["input"], abs=0.5)
    page.get_by_role("button", name="Add a pair").click()
    assert len(stated(page)["pairs"]) == 4
    press(page, "4", "Delete")
    assert len(stated(page)["pairs"]) == 3
    page.click("#solve")
    # Whether there is a fourbar of it depends on where the pair was let go.
    page.wait_for_selector("#result .summary", timeout=110_000)


def test_a_quick_return_is_stated_by_its_limit_positions(studio):
    page = studio.page
    page.select_option("#kind", "quick_return")
    page.get_by_role("button", name="Choose the crank's pivot").click()
    press(page, "O2", "ArrowRight", "PageUp", "PageUp")
    assert stated(page)["ground_angle"] == 10
    press(page, "O2", "Delete")
    page.get_by_role("button", name="Add both limit positions").click()
    drag(page, handle("2") + " .dot", (20, -10))
    positions = stated(page)["positions"]
    assert len(positions) == 2
    assert positions[1]["x"] > positions[0]["x"]
    studio.solve()


def test_a_straight_line_is_drawn_by_its_ends(studio):
    page = studio.page
    page.select_option("#kind", "straight_line")
    before = stated(page)
    drag(page, handle("end") + " .dot", (0, -80))
    after = stated(page)
    assert after["direction"] > 5
    assert after["length"] > before["length"]
    drag(page, handle("start") + " .dot", (30, 0))
    assert stated(page)["start"][0] > 0


def test_a_car_is_drawn_from_above(studio):
    page = studio.page
    page.select_option("#kind", "steering")
    before = stated(page)
    drag(page, handle("kingpin") + " .dot", (15, 0))
    drag(page, handle("rear axle") + " .dot", (0, 12))
    after = stated(page)
    assert after["pivot_distance"] > before["pivot_distance"]
    assert after["wheelbase"] > before["wheelbase"]


def test_the_pivot_of_a_dwell_and_the_linkage_of_a_parallel_motion(studio):
    page = studio.page
    page.select_option("#kind", "dwell")
    press(page, "O2", "ArrowRight", "ArrowUp")
    assert stated(page)["pivot"] != [0, 0]
    page.select_option("#kind", "parallel_motion")
    before = stated(page)["linkage"]
    drag(page, handle("B") + " .dot", (20, -20))
    after = stated(page)["linkage"]
    assert after["links"]["coupler"] != before["links"]["coupler"]
    assert after["links"]["input"] == pytest.approx(before["links"]["input"])
    assert after["coupler_point"]["distance"] == pytest.approx(before["coupler_point"]["distance"])
    studio.solve()
    job = page.evaluate("location.hash.slice(5)")
    found = page.evaluate("id => fetch(`/v1/jobs/${id}`).then(answer => answer.json())", job)
    links = found["problem"]["linkage"]["links"]
    assert links["coupler"] == pytest.approx(after["links"]["coupler"])
    assert math.isfinite(links["output"])


@pytest.mark.parametrize("kind", KINDS)
def test_every_example_stands_on_its_canvas(kept_studio, kind):
    """Each example is one click away, and planar kinds show what they place, if they place anything."""
    page = kept_studio.page
    page.select_option("#kind", kind)
    for n, example in enumerate(list_examples(kind)):
        page.select_option("#example", str(n))
        assert stated(page) == example
        handles = page.locator("#sketch .target").count()
        if kind in ("motion", "path"):
            assert handles >= len(example.get("positions", example.get("points", [])))
        elif kind in ("straight_line", "steering", "dwell", "parallel_motion"):
            assert handles >= 1
        elif kind not in PLANAR:
            assert handles == 0
        labels = page.locator("#sketch .target").evaluate_all("all => all.map(one => one.getAttribute('aria-label'))")
        assert all(label and "NaN" not in label for label in labels)
    if kind in PLANAR:
        kept_studio.screen(f"state-{kind}")


def test_a_pasted_statement_of_another_kind_says_what_it_is_about(studio):
    page = studio.page
    state(page, list_examples("steering")[0])
    assert page.input_value("#kind") == "steering"
    assert "steer" in page.inner_text("#about").lower()
    assert "NaN" not in page.locator("#sketch").inner_html()
