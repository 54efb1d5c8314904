"""The planes of a layout beside the motion: colours, the side view, and what clashes."""

import re

import pytest

from tests.browser.conftest import PUT
from tests.support.browser.accessibility import violations
from tests.support.browser.studio import state

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

DRAG_LINK = {
    "kind": "quick_return",
    "time_ratio": 1.4,
    "stroke": 100.0,
    "mechanism": "drag_link_slider",
    "max_designs": 1,
    "layout": {"link_width": 10.0, "pin_diameter": 5.0, "thickness": 4.0, "gap": 0.5},
}
NUMBERS = "(all, names) => all.map(one => names.map(name => +one.getAttribute(name)))"


def solved(studio, **layout):
    """The design, with its motion at the beginning."""
    page = studio.page
    state(page, {**DRAG_LINK, "layout": {**DRAG_LINK["layout"], **layout}})
    studio.solve()
    page.wait_for_selector(".moving .side")
    page.focus("#scrub")
    page.keyboard.press("Home")
    job = page.evaluate("location.hash.slice(5)")
    return page.evaluate("id => fetch(`/v1/jobs/${id}`).then(answer => answer.json())", job)["result"]["designs"][0]


def test_links_have_the_colour_of_their_plane_and_stand_in_it(open_studio):
    studio = open_studio(reduced_motion="reduce")
    page = studio.page
    design = solved(studio, shafts="both_sides")
    layout, skeleton = design["layout"], design["mechanism"]["skeleton"]
    moving = [link for link in skeleton["links"] if link["name"] != "ground"]
    classes = page.locator(".moving .live .link").evaluate_all("all => all.map(one => one.classList.value)")
    assert [re.search(r"p(\d)", text)[1] for text in classes] == [str(layout["planes"][one["name"]]) for one in moving]
    legend = page.locator(".planes .legend li").evaluate_all("all => all.map(one => one.textContent)")
    assert legend == [
        f"{plane}Plane {plane}: {name.replace('_', ' ').capitalize()}"
        for name, plane in sorted(layout["planes"].items(), key=lambda item: -item[1])
    ]

    # A plane is 4.5 mm above the one below it, each link as long across as its joints are apart.
    bars = dict(
        zip(
            layout["planes"],
            page.locator(".side .slab").evaluate_all(NUMBERS, ["x", "y", "width", "height"]),
            strict=True,
        )
    )
    thick = next(iter(bars.values()))[3] / 4.0
    bottoms = {name: y + height for name, (_, y, _, height) in bars.items()}
    for one, plane in layout["planes"].items():
        for other, above in layout["planes"].items():
            assert bottoms[one] - bottoms[other] == pytest.approx(4.5 * thick * (above - plane), abs=1e-6)
    at = {name: x for name, (x, _) in skeleton["joints"].items()}
    pins = dict(zip(at, page.locator(".moving .live .joined:has(.pin)").evaluate_all(PUT), strict=True))
    scale = (pins["C"][0] - pins["O2"][0]) / (at["C"] - at["O2"])
    for link in moving:
        x, _, width, _ = bars[link["name"]]
        ends = [at[joint] for joint in link["joints"]]
        assert width == pytest.approx(scale * (max(ends) - min(ends) + 10.0), abs=0.3)
        assert x == pytest.approx(pins["O2"][0] + scale * (min(ends) - 5.0 - at["O2"]), abs=0.3)

    # Pins reach from the lowest of their planes to the highest; shafts into a base, those that stop short are hollow.
    spans = dict(zip(layout["pins"], page.locator(".side .shaft").evaluate_all(NUMBERS, ["y", "height"]), strict=True))
    bases = page.locator(".side .base").evaluate_all(NUMBERS, ["y", "height"])
    by_plane = {plane: bars[name] for name, plane in layout["planes"].items()}
    for joint, (low, high) in layout["pins"].items():
        y, height = spans[joint]
        top = by_plane[high][1] if high <= layout["count"] else bases[1][0]
        bottom = by_plane[low][1] + by_plane[low][3] if low else bases[0][0] + bases[0][1]
        assert (y, y + height) == pytest.approx((top, bottom), abs=1e-6)
    assert page.locator(".side .shaft.stub").count() == len(layout["stub_shafts"]) == 2
    assert "Stub shafts at O2, O4" in page.inner_text(".planes")
    assert "No collision" in page.inner_text(".planes")
    assert violations(page) == []
    studio.screen("planes")


def test_a_click_leads_to_where_parts_clash(open_studio):
    studio = open_studio(reduced_motion="reduce", color_scheme="dark", viewport={"width": 390, "height": 844})
    page = studio.page
    layout = solved(studio)["layout"]
    assert not layout["buildable"]
    (clash,) = layout["clashes"]
    assert page.locator(".clashes li").count() == 1
    page.locator(".clashes button").click()
    reading = float(page.inner_text(".moving .reading[for=scrub]").rstrip("°").replace("−", "-"))
    assert (reading - clash["input_angle"] + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=0.06)
    low, high = layout["free_range"]
    assert f"{low:.1f}° to {high:.1f}°" in page.inner_text(".planes")
    assert violations(page) == []
    studio.screen("planes-phone")


def test_without_a_layout_there_are_no_planes(studio):
    page = studio.page
    state(page, {name: value for name, value in DRAG_LINK.items() if name != "layout"})
    studio.solve()
    page.wait_for_selector(".moving .live .link")
    assert page.locator(".planes").count() == 0
    assert page.locator(".moving .link.plane").count() == 0
