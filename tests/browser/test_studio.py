"""A person states a problem, solves it, sees it move and takes it home."""

import math
import re

import pytest

from synthesis.registry import KINDS, list_examples
from tests.support.browser.studio import PLAIN, drag, drawn, solved, state, stated, unfold, written
from tests.support.service.running import until

pytestmark = pytest.mark.browser


def link_now(page):
    return page.locator(".moving .live .link").first.get_attribute("d")


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("light", {"color_scheme": "light"}),
        ("dark", {"color_scheme": "dark"}),
        ("phone", {"viewport": {"width": 390, "height": 844}, "has_touch": True}),
    ],
)
def test_a_linkage_is_stated_solved_and_moves(open_studio, name, options):
    studio = open_studio(**options)
    page = studio.page
    state(page, PLAIN)
    studio.solve()
    assert page.locator(".card").count() == 1
    assert "Complete: the search covered everything" in page.inner_text("#result")
    page.wait_for_selector(".moving .live .link")
    before = link_now(page)
    until(lambda: link_now(page) != before, what="another frame")
    until(lambda: drawn(page), 60, "the drawing")
    assert not re.search(r"\b(null|undefined|NaN)\b", written(page))
    speed = "one => [one.selectedOptions[0].text, one.offsetWidth >= 72]"
    assert page.locator("#speed").evaluate(speed) == ["1×", True]
    assert page.locator(".checks .good").count() == page.locator(".checks li").count() > 0
    wider = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert wider <= 0, "the page is wider than the window"
    studio.screen(f"motion-{name}")


def test_the_scrubber_is_worked_by_keys_and_moves_the_marks(studio):
    page = studio.page
    state(page, PLAIN)
    studio.solve()
    page.wait_for_selector(".moving .live .link")
    page.focus("#scrub")
    page.keyboard.press("ArrowRight")
    first, mark = link_now(page), page.locator(".plots .mark").first.get_attribute("transform")
    page.keyboard.press("ArrowRight")
    second, moved = link_now(page), page.locator(".plots .mark").first.get_attribute("transform")
    assert first != second
    assert mark != moved
    page.wait_for_timeout(300)
    assert link_now(page) == second, "it stands still while it is scrubbed"


def test_the_crank_is_led_by_its_pin(studio):
    page = studio.page
    state(page, PLAIN)
    studio.solve()
    page.wait_for_selector(".moving .led")
    page.focus("#scrub")
    page.keyboard.press("Home")
    page.locator(".moving .led").scroll_into_view_if_needed()
    at, before = float(page.input_value("#scrub")), page.locator(".moving .led").bounding_box()
    drag(page, ".moving .led", (80, 0))
    after = page.locator(".moving .led").bounding_box()
    assert abs(float(page.input_value("#scrub")) - at) > 5.0
    assert after["x"] - before["x"] > 20.0, "towards where it was led"


def test_positions_are_dragged_turned_and_moved_by_keys(studio):
    page = studio.page
    state(page, PLAIN)
    drag(page, ".target >> nth=1 >> .dot", (60, -40))
    moved = stated(page)["positions"][1]
    assert moved["x"] > 10.5
    assert moved["y"] > 5.5
    assert moved["angle"] == 30.0
    assert float(page.input_value('[data-path="/problem/positions/1/x"]')) == moved["x"]
    drag(page, ".target >> nth=0 >> .knob", (-40, -40))
    assert 60.0 < stated(page)["positions"][0]["angle"] < 120.0
    page.locator(".target").nth(0).focus()
    page.keyboard.press("ArrowLeft")
    assert stated(page)["positions"][0]["x"] < 0.0
    page.locator(".target").nth(1).focus()
    page.keyboard.press("Delete")
    assert len(stated(page)["positions"]) == 1


def test_a_curve_is_sketched(studio):
    page = studio.page
    page.select_option("#kind", "path")
    page.check("#freehand")
    box = page.locator("#sketch svg").bounding_box()
    page.mouse.move(box["x"] + 30, box["y"] + 30)
    page.mouse.down()
    for k in range(1, 20):
        page.mouse.move(box["x"] + 30 + 15 * k, box["y"] + 30 + 0.4 * k * k)
    page.mouse.up()
    points = stated(page)["points"]
    assert len(points) == 24
    assert points[-1]["x"] > points[0]["x"]
    assert points[-1]["y"] < points[0]["y"], "y is up"


def test_a_stroke_whose_ends_meet_is_a_closed_curve(studio):
    page = studio.page
    state(page, {"kind": "path", "points": [{"x": 0, "y": 0}, {"x": 100, "y": 0}, {"x": 100, "y": 60}]})
    page.check("#freehand")
    box = page.locator("#sketch svg").bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(middle[0] + 120, middle[1])
    page.mouse.down()
    for k in range(1, 40):
        page.mouse.move(middle[0] + 120 * math.cos(k * math.pi / 20), middle[1] - 80 * math.sin(k * math.pi / 20))
    page.mouse.up()
    drawn = stated(page)
    assert (drawn["closed"], drawn["method"]) == (True, "curve_match")
    points = [(one["x"], one["y"]) for one in drawn["points"]]
    assert len(set(points)) == 24
    steps = [math.dist(one, points[(k + 1) % 24]) for k, one in enumerate(points)]
    assert max(steps) < 1.5 * min(steps), "evenly, from the last to the first too"
    assert "Closed: the designs match the whole curve" in page.inner_text("#sketch")
    page.get_by_role("button", name="Leave it free").click()
    assert not {"closed", "method"} & set(stated(page))
    assert page.get_by_role("button", name="Leave it free").count() == 0


def test_rows_are_pasted_from_a_spreadsheet(studio):
    page = studio.page
    state(page, PLAIN)
    page.locator('[data-path="/problem/positions/0/x"]').evaluate(
        """cell => {
          const clipboard = new DataTransfer();
          clipboard.setData("text/plain", "1,5\\t2\\t10\\n3\\t4.25\\t20\\n5\\t6\\t-30");
          cell.dispatchEvent(new ClipboardEvent("paste", {clipboardData: clipboard, bubbles: true, cancelable: true}));
        }"""
    )
    assert stated(page)["positions"] == [
        {"x": 1.5, "y": 2, "angle": 10},
        {"x": 3, "y": 4.25, "angle": 20},
        {"x": 5, "y": 6, "angle": -30},
    ]


def test_a_fault_stands_at_its_field(studio):
    page = studio.page
    unfold(page)
    page.fill('[data-path="/problem/max_designs"]', "0")
    page.fill('[data-path="/problem/positions/1/angle"]', "1e12")
    page.click("#solve")
    page.wait_for_selector('[data-path="/problem/max_designs"][aria-invalid="true"]')
    field = page.locator(".field", has=page.locator('> [data-path="/problem/max_designs"]'))
    assert "at least 1" in field.locator("> .error").inner_text()
    assert page.get_attribute('[data-path="/problem/positions/1/angle"]', "aria-invalid") == "true"
    # The browser itself reports the answer 422; nothing else may have gone wrong.
    assert [text for text in studio.wrong if "422" not in text] == []
    studio.wrong.clear()
    page.fill('[data-path="/problem/max_designs"]', "1")
    page.fill('[data-path="/problem/positions/1/angle"]', "-25")
    studio.solve()
    assert page.locator("[aria-invalid]").count() == 0


def without_empty(value, example):
    """A statement without objects that say nothing, but for those of the example."""
    if not isinstance(value, dict) or not isinstance(example, dict):
        return value
    return {
        name: without_empty(part, example.get(name)) for name, part in value.items() if part != {} or name in example
    }


@pytest.mark.parametrize("kind", KINDS)
def test_the_form_changes_nothing_that_nobody_edits(kept_studio, kind):
    page = kept_studio.page
    page.select_option("#kind", kind)
    for n, example in enumerate(list_examples(kind)):
        page.select_option("#example", str(n))
        page.locator("#fields").evaluate(
            "form => form.querySelectorAll('details').forEach(one => { one.open = true; })"
        )
        page.fill('[data-path="/problem/max_designs"]', "7")
        assert without_empty(stated(page), example) == {**example, "max_designs": 7}


def test_a_link_restores_a_job(studio):
    page = studio.page
    state(page, PLAIN)
    page.fill("#label", "hinge of a lid")
    studio.solve()
    address = page.url
    assert "#job=" in address
    page.reload()
    page.wait_for_selector(".card")
    assert page.input_value("#label") == "hinge of a lid"
    # Defaults, which the service writes out, are left to it again.
    assert stated(page)["positions"] == PLAIN["positions"]
    assert set(stated(page)) == set(PLAIN)
    page.click("#tab-jobs")
    page.fill("#job-words", "hinge")
    shown = page.locator(".jobs li:visible")
    assert shown.count() == 1
    assert address.endswith(shown.locator("a").get_attribute("href"))


def test_a_job_is_cancelled(studio):
    page = studio.page
    problem = KINDS["path"].problem.model_config["json_schema_extra"]["examples"][0]
    state(page, {**problem, "rounds": 10})
    page.click("#solve")
    page.click("#cancel")
    page.get_by_text("The job was cancelled.").wait_for()


def test_a_pin_is_dragged_and_the_analysis_follows(studio):
    page = studio.page
    state(page, PLAIN)
    studio.solve()
    page.wait_for_selector(".moving .live .link")
    page.click("#tab-explore")
    page.wait_for_selector("#exploring .curve[d]")
    until(lambda: page.locator("#explore dd").count() == 5, 30, "the figures")
    curve, figures = page.get_attribute("#exploring .curve", "d"), page.inner_text("#explore .facts")
    drag(page, "#exploring .target:has(text:text-is('O4')) .dot", (40, 25))
    until(lambda: page.get_attribute("#exploring .curve", "d") != curve, 30, "another curve")
    until(lambda: page.inner_text("#explore .facts") != figures, 30, "other figures")
    page.get_by_role("button", name="Start a problem with these fixed pivots").click()
    begun = stated(page)
    assert begun["input_side"]["fixed_pivot"] == [0, -20]
    assert begun["output_side"]["fixed_pivot"][0] > 20
    assert begun["output_side"]["fixed_pivot"][1] < -20
    studio.screen("explore")


def test_where_nothing_is_found_the_page_shows_what_comes_nearest(studio):
    page = studio.page
    state(page, {**list_examples("quick_return")[0], "constraints": {"min_transmission_angle": 88.5}})
    studio.solve()
    page.wait_for_selector("#miss")
    told = page.inner_text("#miss")
    gap = re.search(r"Transmission angle ([\d.]+)°, required 88.5°", told)
    reach = re.search(r"min transmission angle (\d+\.\d+)", told, re.IGNORECASE)
    assert gap is not None, told
    assert float(gap.group(1)) == pytest.approx(float(reach.group(1)), abs=0.01)
    assert page.locator("#miss svg").count() == 1
    studio.screen("nearest-miss")
    # It is offered, and has an answer.
    page.get_by_role("button", name="Solve with").click()
    page.wait_for_selector("#answers:not([aria-busy]) .card", timeout=100_000)
    eased = stated(page)["constraints"]["min_transmission_angle"]
    assert eased <= float(reach.group(1)) + 0.005
    assert eased == pytest.approx(float(gap.group(1)), abs=0.02)
    assert page.locator("#miss").count() == 0


def test_answers_to_an_earlier_statement_say_so(studio):
    page = studio.page
    solved(studio, PLAIN)
    note = page.locator("#stale")
    assert not note.is_visible()
    state(page, {**PLAIN, "input_side": {**PLAIN["input_side"], "rotations": [55.0]}})
    until(note.is_visible, what="the note")
    page.get_by_role("button", name="Restore it").click()
    until(lambda: not note.is_visible(), what="the statement of the answers again")
    assert stated(page)["input_side"]["rotations"] == PLAIN["input_side"]["rotations"]
    state(page, {**PLAIN, "length_unit": "in"})
    until(note.is_visible, what="the note")
    studio.solve()
    until(lambda: not note.is_visible(), what="answers to the new statement")
    page.reload()
    page.wait_for_selector("#scrub")
    assert not note.is_visible()
