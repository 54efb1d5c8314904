"""Tools of the canvas and of the plots: grid, snapping, ruler, shapes of a curve, numbers taken home."""

import csv
import math
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.support.browser.studio import PLAIN, drag, solved, state, stated
from tests.support.service.running import until

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]


def middle(page, selector):
    box = page.locator(selector).bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def lead(page, selector, to):
    page.mouse.move(*middle(page, selector))
    page.mouse.down()
    page.mouse.move(to[0] + 3, to[1] + 2)
    page.mouse.up()


def test_places_snap_and_a_ruler_measures(studio):
    page = studio.page
    state(page, PLAIN)
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("r")
    assert page.evaluate("document.activeElement.dataset.grip") == "ruler1"
    # Each end is caught by what it is let go beside.
    for end, position in ((0, 0), (1, 1)):
        lead(
            page,
            f'#sketch [data-grip="ruler{end}"] .ruler-end',
            middle(page, f"#sketch .target >> nth={position} >> .dot"),
        )
    length, angle = re.fullmatch(r"([\d.]+) mm, ([\d.]+)°", page.text_content("#sketch .ruler-text")).groups()
    assert float(length) == pytest.approx(math.hypot(10, 5), abs=0.05)
    assert float(angle) == pytest.approx(math.degrees(math.atan2(5, 10)), abs=0.05)
    assert page.text_content("#sketch .ruler title").startswith(f"{math.hypot(10, 5):.10f}"[:10])
    page.locator('#sketch [data-grip="ruler1"]').focus()
    page.keyboard.press("Delete")
    assert page.locator("#sketch .ruler, #sketch .grip").count() == 0, "nothing of it is left for the keys to reach"
    assert page.evaluate("document.activeElement.dataset.tool") == "ruler"

    step = float(re.search(r"snap to ([\d.]+)", page.get_attribute("[data-tool=snap]", "title")).group(1))
    page.click("[data-tool=snap]")
    drag(page, ".target >> nth=1 >> .dot", (37, -23))
    drag(page, ".target >> nth=1 >> .knob", (9, -31))
    moved = stated(page)["positions"][1]
    assert moved["x"] != 10.0
    assert [moved[c] / step for c in ("x", "y")] == pytest.approx(
        [round(moved[c] / step) for c in ("x", "y")], abs=1e-9
    )
    assert moved["angle"] % 15 == 0
    page.keyboard.down("Alt")
    drag(page, ".target >> nth=1 >> .dot", (41, -29))
    page.keyboard.up("Alt")
    freed = stated(page)["positions"][1]
    assert any(abs(freed[c] / step - round(freed[c] / step)) > 1e-6 for c in ("x", "y"))
    page.click("[data-tool=snap]")
    assert page.locator("#sketch line.grid").count() > 0
    page.click("[data-tool=grid]")
    assert page.locator("#sketch line.grid").count() == 0
    page.click("[data-tool=grid]")


def test_what_is_taken_hold_of_is_large_enough_and_named(open_studio):
    for options, least in (({}, 24), ({"viewport": {"width": 390, "height": 844}, "has_touch": True}, 44)):
        page = open_studio(**options).page
        zone = {"polygon": [[-30, -30], [-10, -30], [-10, -10], [-30, -10]]}
        state(page, {**PLAIN, "space": {"obstacles": [zone]}})
        page.locator("#sketch .held").focus()
        page.keyboard.press("Tab")
        sizes = page.locator("#sketch .hit").evaluate_all(
            "all => all.filter(one => !one.closest('[hidden]')).map(one => Math.min(one.getBoundingClientRect().width, "
            "one.getBoundingClientRect().height))"
        )
        assert len(sizes) >= 2 * 2 + 4
        assert min(sizes) >= least - 0.5
        unnamed = page.locator("#sketch :is(.target, .grip, .held)").evaluate_all(
            "all => all.filter(one => !one.getAttribute('aria-label') || one.tabIndex !== 0).length"
        )
        assert unnamed == 0


def test_a_drawn_curve_is_made_smooth_and_symmetric(studio):
    page = studio.page
    rng = np.random.default_rng(4)
    turn = 2 * np.pi * np.arange(24) / 24
    oval = np.exp(0.4j) * (80 * np.cos(turn) + 30j * np.sin(turn)) + rng.normal(0, 2, 24) + 1j * rng.normal(0, 2, 24)
    for closed in (False, True):
        drawn = oval if closed else oval[:13]
        points = [{"x": round(z.real, 3), "y": round(z.imag, 3)} for z in drawn]
        state(page, {"kind": "path", "points": points, **({"closed": True, "method": "curve_match"} if closed else {})})

        def curve():
            return np.array([complex(one["x"], one["y"]) for one in stated(page)["points"]])

        def rough(z):
            return np.abs(np.diff(z, 2)).sum()

        before = curve()
        page.get_by_role("button", name="Smooth").click()
        after = curve()
        assert rough(after) < 0.8 * rough(before)
        if not closed:
            assert np.abs(after - before)[[0, -1]].max() < 0.1, "its ends stay, as far as the screen tells"
        page.get_by_role("button", name="Symmetric").click()
        made = curve()
        # The best mirror of all lines through the middle maps it onto itself.
        centre = made.mean() if closed else (made[0] + made[-1]) / 2
        best = min(
            np.abs(centre + np.exp(1j * two) * np.conj(made - centre) - np.roll(made[::-1], shift)).max()
            for two in np.linspace(0, 2 * np.pi, 3601)
            for shift in (range(24) if closed else (0,))
        )
        assert best < 0.6
        assert np.abs(made - after).max() < 12.0, "and it is still that curve"


def test_a_plot_is_looked_at_nearer_and_taken_home(studio):
    page = studio.page
    solved(studio, PLAIN)
    page.click("#tab-plots")
    plot = page.locator("#plots .plot", has_text="Velocity of P")
    plot.locator("summary").click()
    motion = page.evaluate(
        "id => fetch(`/v1/jobs/${id}/designs/0/motion?steps=240`).then(answer => answer.json())",
        page.evaluate("location.hash.slice(5)"),
    )
    with page.expect_download() as waiting:
        plot.get_by_role("button", name="Download the numbers").click()
    head, *rows = csv.reader(Path(waiting.value.path()).read_text().splitlines())
    assert head == ["Input (°)", *(f"Velocity of P (mm/rad): {name}" for name in ("total", "x", "y"))]
    told = [[float(cell) if cell else None for cell in row] for row in rows]
    assert [row[0] for row in told] == motion["input_angle"]
    assert [row[2] for row in told] == motion["joints"]["P"]["vx"]
    with page.expect_download() as waiting:
        plot.get_by_role("button", name="Download the picture").click()
    with Image.open(waiting.value.path()) as picture:
        assert picture.width == 1200
        assert len(picture.convert("RGB").getcolors(1 << 20)) > 10
    ends = plot.locator("svg .tick").all_text_contents()[-2:]
    plot.get_by_role("button", name="Zoom in").click()
    nearer = plot.locator("svg .tick").all_text_contents()[-2:]
    whole, part = (
        float(two[1].rstrip("°").replace("−", "-")) - float(two[0].rstrip("°").replace("−", "-"))
        for two in (ends, nearer)
    )
    assert part == pytest.approx(whole / 2, abs=2.0)
    assert page.evaluate("document.activeElement.getAttribute('aria-label')").startswith("Zoom in"), "the focus stays"
    # What stands at the pointer is read while it rests there.
    box = plot.locator("svg").bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert "°: " in plot.locator(".reading").inner_text()
    page.mouse.move(0, 0)
    assert "°: " not in plot.locator(".reading").inner_text()


def test_the_wheel_brings_the_plane_nearer_and_places_are_then_finer(studio):
    page = studio.page
    state(page, PLAIN)
    picture = page.locator("#sketch .canvas")
    picture.scroll_into_view_if_needed()
    grip = page.locator("#sketch .target >> nth=1 >> .dot")
    box = grip.bounding_box()
    still = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    other = page.locator("#sketch .target >> nth=0 >> .dot").bounding_box()
    page.mouse.move(*still)
    page.mouse.wheel(0, -600)
    # What lies under the pointer stays there; all else goes away from it by 1.0015 a step.
    until(lambda: page.locator("#sketch .canvas").get_attribute("viewBox").startswith("0 0 "), 10, "the plane anew")
    assert middle(page, "#sketch .target >> nth=1 >> .dot") == pytest.approx(still, abs=1.5)
    before = math.hypot(other["x"] + other["width"] / 2 - still[0], other["y"] + other["height"] / 2 - still[1])
    away = math.dist(middle(page, "#sketch .target >> nth=0 >> .dot"), still)
    assert away / before == pytest.approx(1.0015**600, rel=0.02)
    lead(page, "#sketch .target >> nth=1 >> .dot", (still[0] + 20, still[1]))
    moved = stated(page)["positions"][1]
    assert moved["x"] > 10.0
    assert moved["y"] == pytest.approx(5.0, abs=0.5)
    page.locator("#sketch").get_by_role("button", name="Fit everything").click()
    assert math.dist(
        middle(page, "#sketch .target >> nth=0 >> .dot"), middle(page, "#sketch .target >> nth=1 >> .dot")
    ) == pytest.approx(before, rel=0.5)
