"""A guided task is done by keys alone, step by step, and can be left at any time."""

import pytest

from tests.browser.conftest import ANSWERED
from tests.support.browser.accessibility import violations
from tests.support.browser.studio import stated
from tests.support.service.running import until

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]


def told(page):
    return page.inner_text("#guide .note")


def begun(page, name):
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("g")
    page.wait_for_selector("#gallery[open]")
    while not page.evaluate("document.activeElement.textContent").startswith(name):
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    page.wait_for_selector("#guide:visible")


def test_a_lid_is_led_through_by_keys(studio):
    page = studio.page
    begun(page, "A lid on a cabinet")
    assert told(page) == "A lid on a cabinet, 1 of 4"
    assert page.evaluate("document.activeElement.textContent") == "Go there"
    assert violations(page) == []
    studio.screen("guide")
    before = stated(page)["positions"][2]
    page.keyboard.press("Enter")
    page.keyboard.press("ArrowRight")
    assert stated(page)["positions"][2]["x"] > before["x"]
    until(lambda: told(page).endswith("2 of 4"), 10, "the step is seen to be done")
    page.get_by_role("button", name="Rectangle", exact=True).focus()
    page.keyboard.press("Enter")
    page.keyboard.press("Enter")
    assert stated(page)["space"]["fixed_pivots"]["input"]["polygon"]
    until(lambda: told(page).endswith("3 of 4"), 10, "the zone is seen")
    # What was done is undone as everything is, and a step can be left out.
    page.click("#undo")
    assert "input" not in (stated(page).get("space") or {}).get("fixed_pivots", {})
    page.keyboard.press("Control+Enter")
    page.wait_for_selector(ANSWERED)
    until(lambda: told(page).endswith("4 of 4"), 10, "the answers are seen")
    page.locator("#guide").get_by_role("button", name="Go there").press("Enter")
    page.wait_for_selector("#choosing .spot")
    assert page.evaluate("document.activeElement.closest('#choosing') !== null")
    page.locator(".spot[tabindex='0']").focus()
    for key in ("ArrowRight", "ArrowLeft", "ArrowUp"):
        page.keyboard.press(key)
    until(lambda: told(page) == "A lid on a cabinet", 10, "the end")
    page.locator("#guide").get_by_role("button", name="Done").press("Enter")
    assert not page.is_visible("#guide")


def pressed(page, key, until_there, most=80):
    """Press a key until the focus is where it is to be."""
    for _ in range(most):
        if page.evaluate(f"document.activeElement.matches({until_there!r})"):
            return
        page.keyboard.press(key)
    raise AssertionError(f"{key} never leads to {until_there}: {page.evaluate('document.activeElement.outerHTML')}")


def gone_to(page, step):
    """The guide has come to a step, and its button leads there."""
    until(lambda: told(page).endswith(step), 200, f"step {step}")
    page.locator("#guide").get_by_role("button", name="Go there").focus()
    page.keyboard.press("Enter")


def ended(page):
    until(lambda: " of " not in told(page), 30, "the end")
    page.locator("#guide").get_by_role("button", name="Done").focus()
    page.keyboard.press("Enter")
    assert not page.is_visible("#guide")


def test_a_valve_cam_is_led_through_by_keys(studio):
    page = studio.page
    begun(page, "A valve cam")
    gone_to(page, "1 of 4")
    for row in (0, 1):
        pressed(page, "Tab", f'[data-path="/problem/segments/{row}/lift"]')
        page.keyboard.press("Control+a")
        page.keyboard.type("8")
    assert [one["lift"] for one in stated(page)["segments"][:2]] == [8, 8]
    gone_to(page, "2 of 4")
    pressed(page, "Tab", '[data-path="/problem/limits/min_radius"]')
    page.keyboard.press("Control+a")
    page.keyboard.type("6")
    assert stated(page)["limits"]["min_radius"] == 6
    until(lambda: told(page).endswith("3 of 4"), 10, "the limit is seen")
    page.keyboard.press("Control+Enter")
    gone_to(page, "4 of 4")
    page.wait_for_selector("#plots .plot")
    job = page.evaluate("id => fetch(`/v1/jobs/${id}`).then(answer => answer.json())", page.url[-26:])
    assert job["result"]["designs"][0]["metrics"]["min_convex_radius"] >= 6.0 - 1e-6
    ended(page)


def test_a_foot_that_walks_is_led_through_by_keys(studio):
    page = studio.page
    begun(page, "A foot that walks")
    gone_to(page, "1 of 4")
    assert page.evaluate("document.activeElement.id") == "freehand"
    # Whoever has no mouse moves a point of the path.
    before = stated(page)["points"]
    pressed(page, "Shift+Tab", "#sketch .target")
    page.keyboard.press("ArrowUp")
    assert stated(page)["points"] != before
    until(lambda: told(page).endswith("2 of 4"), 10, "the path is seen")
    page.keyboard.press("Control+Enter")
    gone_to(page, "3 of 4")
    assert page.evaluate("document.activeElement.id") == "compare-with"
    page.keyboard.press("ArrowDown")
    gone_to(page, "4 of 4")
    pressed(page, "Tab", "#downloads button")
    while page.evaluate("document.activeElement.textContent") != "DXF":
        page.keyboard.press("Tab")
    with page.expect_download():
        page.keyboard.press("Enter")
    ended(page)


def test_a_guided_task_is_left_at_any_time_and_stands_beside_its_thing(open_studio):
    for options in ({}, {"viewport": {"width": 390, "height": 844}, "has_touch": True}):
        page = open_studio(**options).page
        for name in ("A valve cam", "A foot that walks"):
            begun(page, name)
            count = int(told(page)[-1])
            for _ in range(count):
                note = page.locator("#guide").bounding_box()
                size = page.viewport_size
                assert note["x"] >= 0
                assert note["y"] >= 0
                assert note["x"] + note["width"] <= size["width"]
                assert note["y"] + note["height"] <= size["height"]
                page.locator("#guide").get_by_role("button", name="Skip").click()
            begun(page, name)
            page.wait_for_selector(".guided")
            page.keyboard.press("Escape")
            assert not page.is_visible("#guide")
            assert page.locator(".guided").count() == 0
            assert page.evaluate("document.activeElement.id") == "gallery-open"
