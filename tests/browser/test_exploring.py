"""A person explores: draws pivots along Burmester's curves, drags pins of any linkage, begins anew with the find."""

import math
import re

import pytest

from synthesis.registry import list_examples
from tests.support.browser.motion_view import number, solved
from tests.support.browser.studio import drag, stated
from tests.support.service.running import until

pytestmark = pytest.mark.browser

FOUR = list_examples("motion")[2]


def at(page, selector):
    return float(page.get_attribute(selector, "cx")), float(page.get_attribute(selector, "cy"))


def test_a_pivot_is_drawn_along_burmesters_curve_and_solved(studio, server):
    page = studio.page
    solved(studio, FOUR)
    first = page.url
    page.click("#tab-curves")
    page.wait_for_selector("#burmester .circle-points")
    curve = page.locator("#burmester .circle-points").evaluate_all(
        "paths => paths.map(one => one.getAttribute('d')).join('')"
    )
    places = [tuple(map(float, pair)) for pair in re.findall(r"([-\d.]+) ([-\d.]+)", curve)]
    before, drawn = at(page, "#burmester .dot.circle"), page.locator(".live .link").first.get_attribute("d")
    assert min(math.dist(before, place) for place in places) < 0.2
    handle = "#burmester .target:has(text:text-is('A'))"
    page.locator(handle).focus()
    for _ in range(4):
        page.keyboard.press("ArrowRight")
    after = at(page, "#burmester .dot.circle")
    assert after != before
    assert min(math.dist(after, place) for place in places) < 0.2, "it stays on the curve"
    until(lambda: "Solved" in page.inner_text("#burmester [role=status]"), 60, "the linkage on these pivots")
    until(lambda: page.locator(".live .link").first.get_attribute("d") != drawn, 30, "the new linkage")
    assert "On these pivots: Fourbar" in page.text_content("#design-title")
    assert page.locator(".checks li").count() >= 4
    studio.screen("burmester")
    page.get_by_role("button", name="Keep this linkage").click()
    until(lambda: page.url != first and page.locator(".card").count() == 1, 30, "the job")
    job = server.job(re.search(r"#job=(\w+)", page.url).group(1))
    chosen = job["problem"]["input_side"]["moving_pivot"]
    (design,) = job["result"]["designs"]
    assert min(math.dist(chosen, joint) for joint in design["mechanism"]["skeleton"]["joints"].values()) < 1e-6
    reached = next(one for one in design["verification"]["checks"] if one["name"] == "reaches_targets")
    assert reached["passed"]


def test_a_pivot_is_dragged_along_burmesters_curve(studio):
    page = studio.page
    solved(studio, FOUR)
    page.click("#tab-curves")
    page.wait_for_selector("#burmester .dot.centre")
    before = at(page, "#burmester .dot.centre")
    moving = at(page, "#burmester .dot.circle")
    drag(page, "#burmester .target:has(text:text-is('O2')) .dot", (30, 20))
    assert at(page, "#burmester .dot.centre") != before
    assert at(page, "#burmester .dot.circle") != moving, "the moving pivot goes with its fixed pivot"
    until(
        lambda: (
            "olved" in page.inner_text("#burmester [role=status]")
            and "being" not in page.inner_text("#burmester [role=status]")
        ),
        60,
        "an answer",
    )
    page.click("#tab-numbers")
    until(lambda: page.inner_text("#design-title") == "Design 1: Fourbar", 30, "the design again")


@pytest.mark.parametrize(
    ("kind", "n", "pin"),
    [
        ("motion", 7, "B"), ("motion", 8, "C"), ("quick_return", 1, "A"), ("quick_return", 0, "B"), ("dwell", 1, "P"),
        ("parallel_motion", 0, "B"), ("straight_line", 1, "A"),
    ],
)  # fmt: skip
def test_the_pins_of_any_linkage_are_dragged(studio, kind, n, pin):
    page = studio.page
    solved(studio, list_examples(kind)[n])
    page.click("#tab-explore")
    until(lambda: page.get_attribute("#exploring .curve", "d"), 30, "the curve")
    curve, angle = page.get_attribute("#exploring .curve", "d"), page.inner_text("#explore .facts")
    page.locator(f"#exploring .target:has(text:text-is('{pin}'))").focus()
    page.keyboard.press("ArrowUp")
    page.keyboard.press("ArrowRight")
    until(
        lambda: page.inner_text("#explore .facts") != angle or page.get_attribute("#exploring .curve", "d") != curve,
        30,
        "another answer",
    )
    assert "Refused" not in page.inner_text("#explore .facts")
    ghost = page.locator("#exploring .faint .link").last
    before = ghost.get_attribute("d")
    page.focus("#explore-scrub")
    for _ in range(3):
        page.keyboard.press("PageUp")
    assert ghost.get_attribute("d") != before, "it moves"
    studio.screen(f"explore-{kind}-{n}")


def test_a_statement_begins_with_what_was_found(studio):
    page = studio.page
    solved(studio, {**list_examples("motion")[0], "constraints": {"full_rotation": True}})
    page.click("#tab-explore")
    page.wait_for_selector("#explore button:has-text('positions')")
    assert page.locator("#explore .checks li").count() == 2
    given = stated(page)["positions"]
    drag(page, "#exploring .target:has(text:text-is('B')) .dot", (12, -9))
    page.get_by_role("button", name="the positions it reaches").click()
    taken = stated(page)["positions"]
    assert len(taken) == len(given)
    assert taken != given
    assert taken[0]["angle"] == pytest.approx(given[0]["angle"], abs=2.5)
    page.get_by_role("button", name="path problem with its curve").click()
    begun = stated(page)
    assert begun["kind"] == "path"
    assert begun["closed"] is True
    assert len(begun["points"]) == 24
    page.wait_for_selector("#sketch .target >> nth=23")


def test_what_cannot_be_assembled_is_said(studio):
    """A link of no length drives nothing: the reason stands there, and the page goes on."""
    page = studio.page
    solved(studio, list_examples("quick_return")[0])
    page.click("#tab-explore")
    until(lambda: page.get_attribute("#exploring .curve", "d"), 30, "the curve")
    pivot, pin = "#exploring .target:has(text:text-is('O2')) .dot", "#exploring .target:has(text:text-is('A')) .dot"
    (u, v), (x, y) = at(page, pivot), at(page, pin)
    box = page.locator("#exploring .canvas").bounding_box()
    _, _, width, height = map(float, page.get_attribute("#exploring .canvas", "viewBox").split())
    scale = min(box["width"] / width, box["height"] / height)
    drag(page, pin, ((u - x) * scale, (v - y) * scale))
    angle = page.locator("#explore dd")
    until(lambda: angle.count() > 0, 30, "an answer")
    drag(page, pivot, (-30, 0))
    until(lambda: "Minimum" in page.inner_text("#explore .facts"), 30, "figures again")
    assert number(page.locator("#explore dt:has-text('Minimum') + dd").inner_text()) >= 0.0
    # The browser itself reports an answer 422, where the linkage was refused on the way.
    assert [text for text in studio.wrong if "422" not in text] == []
    studio.wrong.clear()


def sizes(page):
    """The dimensions that the explorer lists, by their names."""
    rows = page.locator(".sizes-of input[type=number]").evaluate_all(
        "all => all.map(one => [one.getAttribute('aria-label'), one.valueAsNumber])"
    )
    return dict(rows)


def type_in(page, name, value):
    field = page.locator(f".sizes-of input[aria-label='{name}']")
    field.fill(str(value))
    field.press("Enter")


def test_dimensions_are_typed_held_and_made_equal_and_the_fit_goes_on_from_there(studio, server):
    page = studio.page
    solved(studio, {**list_examples("path")[0], "rounds": 1, "max_designs": 1})
    page.click("#tab-explore")
    until(lambda: page.get_attribute("#exploring .curve", "d"), 30, "the curve")
    first = sizes(page)
    assert {"Ground O2–O4", "Input O2–A", "Coupler A–B", "Coupler A–P", "Coupler ∠BAP", "Output O4–B"} == set(first)
    # One is typed, and the others stay.
    wanted = round(1.03 * first["Coupler A–B"], 3)
    type_in(page, "Coupler A–B", wanted)
    until(lambda: sizes(page)["Coupler A–B"] == wanted, 10, "the dimension")
    typed = sizes(page)
    for name in set(first) - {"Coupler A–B"}:
        assert typed[name] == pytest.approx(first[name], rel=1e-4), name
    # What no linkage has is refused, and changes nothing.
    type_in(page, "Output O4–B", 1000 * typed["Output O4–B"])
    page.get_by_text("No linkage near this one has all these dimensions.").wait_for()
    assert sizes(page) == typed
    # Held, it stays while a pin is drawn; others do not.
    page.get_by_label("Hold Coupler A–B").check()
    grip = page.locator("#exploring .target:has(text:text-is('B'))")
    grip.focus()
    page.keyboard.press("ArrowUp")
    drawn = sizes(page)
    assert drawn["Coupler A–B"] == wanted
    assert drawn["Output O4–B"] != typed["Output O4–B"]
    # Equal, the two have one value from then on.
    page.get_by_label("Coupler A–P equals").select_option(label="A–B")
    assert sizes(page)["Coupler A–P"] == pytest.approx(wanted, rel=1e-5)
    page.get_by_label("Hold Coupler A–B").uncheck()
    type_in(page, "Coupler A–B", round(0.99 * wanted, 3))
    assert sizes(page)["Coupler A–P"] == pytest.approx(round(0.99 * wanted, 3), rel=1e-5)
    studio.screen("explore-dimensions")
    begun = sizes(page)
    before = page.url
    # A fit knows nothing of what is equal or held, and its button says so.
    assert page.get_by_role("button", name="Optimise from here, with held dimensions free").count() == 1
    page.get_by_role("button", name="Optimise from here").click()
    until(lambda: page.evaluate("location.href") != before, 30, "the job")
    studio.answered()
    job = server.job(re.search(r"#job=(\w+)", page.url).group(1))
    start = {name: complex(*at) for name, at in job["problem"]["start"].items()}
    assert abs(start["B"] - start["A"]) == pytest.approx(begun["Coupler A–B"], rel=1e-4)
    assert abs(start["P"] - start["A"]) == pytest.approx(begun["Coupler A–P"], rel=1e-4)
    assert "from the given start" in job["result"]["summary"]
