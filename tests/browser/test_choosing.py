"""Among the designs of an answer one is chosen: by two quantities, by bounds, by pins, and beside another one."""

import numpy as np
import pytest

from synthesis.registry import list_examples
from tests.browser.conftest import ANSWERED, PUT
from tests.support.browser.accessibility import violations
from tests.support.browser.studio import state
from tests.support.service.running import until

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

SPOTS = """all => all.map(one => {
  const box = one.querySelector(".spot-mark").getBoundingClientRect();
  return [one.dataset.grip, box.x + box.width / 2, box.y + box.height / 2, one.getAttribute("aria-label")];
})"""

TICKS = """all => all.filter(one => !one.closest(".spot")).map(one => {
  const line = one.parentElement.querySelector("line").getBoundingClientRect();
  return [one.textContent, one.getAttribute("text-anchor"), line.x + line.width / 2, line.y + line.height / 2];
})"""


def answer(page):
    job = page.evaluate("location.hash.slice(5)")
    return page.evaluate("id => fetch(`/v1/jobs/${id}`).then(answer => answer.json())", job)["result"]


def spots(page):
    """Places of the designs in the picture, in their order, and what is said of them."""
    found = page.locator(".spot").evaluate_all(SPOTS)
    return [row[1:] for row in sorted(found, key=lambda row: int(row[0].removeprefix("spot")))]


def chosen(page):
    return page.locator('.card[aria-pressed="true"]').get_attribute("data-design")


def shown_cards(page):
    return page.locator(".card:visible").evaluate_all("all => all.map(one => Number(one.dataset.design))")


@pytest.fixture
def answered(studio):
    state(studio.page, list_examples("motion")[0])
    studio.solve()
    studio.page.wait_for_selector(".moving .live .link")
    studio.page.evaluate("document.activeElement.blur()")
    studio.page.keyboard.press("c")
    studio.page.wait_for_selector("#choosing .spot")
    return studio


def test_designs_are_chosen_by_two_quantities_by_bounds_and_by_pins(answered):
    page = answered.page
    designs = answer(page)["designs"]
    sizes = np.array([one["metrics"]["size"] for one in designs])
    angles = np.array([one["metrics"]["min_transmission_angle"] for one in designs])
    page.select_option("#axis-across", label="Size")
    page.select_option("#axis-up", label="Min transmission angle")
    assert violations(page) == []
    answered.screen("choosing")
    # Points and ticks lie on one scale.
    places = spots(page)
    x = np.polyfit(sizes, [one[0] for one in places], 1)
    y = np.polyfit(angles, [one[1] for one in places], 1)
    assert np.polyval(x, sizes) == pytest.approx([one[0] for one in places], abs=0.5)
    assert np.polyval(y, angles) == pytest.approx([one[1] for one in places], abs=0.5)
    assert x[0] > 0.0 > y[0], "more is to the right, and up"
    ticks = page.locator(".scatter .tick").evaluate_all(TICKS)
    for text, anchor, u, v in ticks:
        if anchor == "middle":
            assert np.polyval(x, float(text)) == pytest.approx(u, abs=0.7)
        else:
            assert np.polyval(y, float(text)) == pytest.approx(v, abs=0.7)
    assert len(ticks) >= 4
    assert page.locator(".axis-name").all_text_contents() == ["Min transmission angle (°)", "Size (mm)"]
    for n, (_, _, told) in enumerate(places):
        assert told.startswith(f"Design {n + 1}, Min transmission angle {angles[n]:.3g}°, Size {sizes[n]:.3g} mm")

    # A click chooses, and the arrow keys go on to the next larger and the next better one.
    order = list(np.argsort(sizes))
    page.locator(f'[data-grip="spot{order[1]}"]').click()
    assert chosen(page) == str(order[1] + 1)
    page.keyboard.press("ArrowRight")
    assert chosen(page) == str(order[2] + 1)
    assert page.evaluate("document.activeElement.dataset.grip") == f"spot{order[2]}"
    better = [n for n in np.argsort(angles) if angles[n] > angles[order[2]]]
    page.keyboard.press("ArrowUp")
    assert chosen(page) == str((better or [order[2]])[0] + 1)

    # A bound hides what is beyond it.
    slider = page.get_by_label("Size", exact=True)
    slider.focus()
    for _ in range(40):
        page.keyboard.press("ArrowLeft")
    limit = sizes.max() - 0.4 * (sizes.max() - sizes.min())
    within = [n + 1 for n in range(len(designs)) if sizes[n] <= limit]
    assert shown_cards(page) == within
    assert page.locator(".spot.beyond").count() == len(designs) - len(within)
    assert f"{len(within)} of {len(designs)} designs meet the bounds" in page.inner_text(".known")
    page.get_by_role("button", name="Show all").click()
    assert shown_cards(page) == list(range(1, len(designs) + 1))

    # What is pinned comes first, and stays with the job.
    page.get_by_role("button", name="Pin design 4").click()
    assert shown_cards(page)[0] == 4
    page.reload()
    page.wait_for_selector(ANSWERED)
    assert shown_cards(page) == [4, 1, 2, 3, 5]
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("4")
    assert chosen(page) == "4", "a design keeps its number"
    page.keyboard.press("k")
    assert shown_cards(page) == [1, 2, 3, 4, 5]


def test_two_designs_are_compared_in_numbers_and_on_the_stage(answered):
    page = answered.page
    one, other = (answer(page)["designs"][n] for n in (0, 2))
    page.select_option("#compare-with", label="Design 3")
    rows = page.locator(".side-by-side tr:has(td)").evaluate_all(
        "all => all.map(row => [row.firstChild.firstChild.textContent, row.className, "
        "...[...row.querySelectorAll('td')].map(cell => cell.textContent)])"
    )
    told = {name: cells for name, *cells in rows}
    for name in ("min_transmission_angle", "size", "link_ratio", "quality"):
        marked, *cells = told[name.replace("_", " ").capitalize()]
        values = [design["metrics"][name] for design in (one, other)]
        assert [float(cell.split()[0].rstrip("°")) for cell in cells] == pytest.approx(values, rel=5e-3)
        assert (marked == "differs") == (values[0] != values[1])
    assert told["Rms residual"] == ["", "exact", "exact"]
    unit = {"Size": " mm", "Min transmission angle": "°"}
    for name, symbol in unit.items():
        assert all(cell.endswith(symbol) for cell in told[name][1:])

    page.get_by_role("button", name="Side by side").click()
    page.wait_for_selector("#other .live .link")
    assert page.inner_text("#other .second-name") == "Design 3: Fourbar"
    assert violations(page) == []

    def moved(selector):
        page.focus("#scrub")
        page.keyboard.press("Home")
        before = page.get_attribute(selector, "d")
        for _ in range(5):
            page.keyboard.press("ArrowRight")
        return page.get_attribute(selector, "d") != before

    assert moved("#other .live .link >> nth=0"), "one clock moves both"
    answered.screen("compared")
    page.get_by_role("button", name="Overlay").click()
    page.wait_for_selector("#watch .overlaid .link")
    assert not page.is_visible("#other")
    assert moved("#watch .overlaid .link >> nth=0")
    # Where the fixed pivots of the other lie in the picture of the first is where the answers have them.
    pins = page.locator("#watch :is(.live, .overlaid) g:has(> .ground)").evaluate_all(PUT)
    pivots = [design["mechanism"]["fixed_pivots"][side] for design in (one, other) for side in ("input", "output")]
    scale = np.hypot(*np.subtract(pins[1], pins[0])) / np.hypot(*np.subtract(pivots[1], pivots[0]))
    for pin, pivot in zip(pins, pivots, strict=True):
        away = np.subtract(pivot, pivots[0]) * (scale, -scale)
        assert np.add(pins[0], away) == pytest.approx(pin, abs=0.5)
    page.click("#tab-numbers")
    until(lambda: page.locator(".overlaid").count() == 0, 30, "one design alone")
    # Answers say that they are of another statement.
    assert not page.is_visible("#answers .outdated")
    page.fill('[data-path="/problem/positions/1/angle"]', "-20")
    assert page.is_visible("#answers .outdated")
