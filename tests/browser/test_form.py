"""Everything that a problem can say is reached in the form, by keys too; and what is wrong is told where it is."""

import re

import pytest

from synthesis.registry import KINDS, get_first_example, list_examples
from tests.support.browser.form import OPEN_ALL
from tests.support.browser.studio import PLAIN, state, stated
from tests.support.service.running import until

pytestmark = pytest.mark.browser


def at(path):
    return f'[data-path="/problem/{path}"]'


def show(page, problem):
    state(page, problem)
    page.evaluate(OPEN_ALL)


@pytest.mark.parametrize("kind", KINDS)
def test_every_field_of_a_kind_has_its_control(kept_studio, kind):
    """No field is left to the JSON alone, and what is only looked at is not stated with the next change."""
    page = kept_studio.page
    page.select_option("#kind", kind)
    for n, _ in enumerate(list_examples(kind)):
        page.select_option("#example", str(n))
        before = stated(page)
        page.evaluate(OPEN_ALL)
        assert page.inner_text("#fields").count("Stated in the JSON") == 0
        page.fill(at("max_designs"), "7")
        assert stated(page) == {**before, "max_designs": 7}
    names = set(KINDS[kind].problem.model_fields) - {"kind"}
    assert {name for name in names if page.locator(at(name)).count() == 0} == set()
    unlabelled = page.locator("#fields :is(input, select):not([aria-label])").evaluate_all(
        "boxes => boxes.filter(box => !box.labels.length).length"
    )
    assert unlabelled == 0


def test_units_stand_beside_the_fields_and_follow_the_length_unit(studio):
    page = studio.page
    show(page, {**get_first_example("cam"), "dynamics": {"mass": 0.1, "spring_rate": 5.0}})

    def label(path):
        return page.locator(f".field:has(> {at(path)}) > label").inner_text()

    assert label("limits/pressure_angle").startswith("Pressure angle (°)")
    assert label("speed_rpm") == "Speed rpm (1/min)"
    assert label("dynamics/spring_rate") == "Spring rate (N/mm)"
    assert page.locator("th", has_text="Lift").inner_text() == "Lift (mm)"
    page.focus(at("length_unit"))
    page.select_option(at("length_unit"), "in")
    assert label("dynamics/spring_rate") == "Spring rate (lbf/in)"
    assert stated(page)["length_unit"] == "in"
    assert page.evaluate("document.activeElement.dataset.path") == "/problem/length_unit", "the focus stays"


def test_a_number_becomes_a_range_and_a_number_again(studio):
    page = studio.page
    show(page, get_first_example("cam"))
    way = page.get_by_label("Roller radius: form of the value")
    way.select_option("a range")
    page.fill(at("follower/roller_radius/min"), "6")
    page.fill(at("follower/roller_radius/max"), "12")
    assert stated(page)["follower"]["roller_radius"] == {"min": 6, "max": 12}
    page.get_by_label("Roller radius: form of the value").select_option("a number")
    page.fill(at("follower/roller_radius"), "8")
    assert stated(page)["follower"]["roller_radius"] == 8


def test_lists_within_the_rows_of_a_table(studio):
    page = studio.page
    problem = list_examples("cam")[1]
    show(page, problem)
    page.locator(at("segments/0/conditions")).get_by_role("button", name="Add a row").click()
    page.fill(at("segments/0/conditions/0/angle"), "45")
    page.fill(at("segments/0/conditions/0/s"), "0.5")
    assert stated(page)["segments"][0]["conditions"] == [{"angle": 45, "s": 0.5}]
    # What is wrong in it is told in it, wherever it is folded away.
    page.fill(at("segments/0/conditions/0/angle"), "-1")
    page.locator("#fields details").evaluate_all("all => all.forEach(one => { one.open = false; })")
    page.click("#solve")
    page.wait_for_selector(f'{at("segments/0/conditions/0/angle")}[aria-invalid="true"]')
    told = page.locator(at("segments/0/conditions")).locator("> .error").inner_text()
    assert told.startswith("Row 1, angle: ")
    described = page.get_attribute(at("segments/0/conditions/0/angle"), "aria-describedby")
    assert page.inner_text(f"#{described}").strip() == told.strip()
    assert page.evaluate("document.activeElement.dataset.path") == "/problem/segments/0/conditions/0/angle"
    studio.screen("faults")
    assert [text for text in studio.wrong if "422" not in text] == []
    studio.wrong.clear()


def test_a_tolerance_by_coordinate(studio):
    page = studio.page
    show(page, PLAIN)
    page.get_by_role("button", name="Tolerance of row 2 in detail").click()
    page.fill(at("positions/1/tolerance/x"), "0.5")
    assert stated(page)["positions"][1]["tolerance"] == {"x": 0.5}
    assert "tolerance" not in stated(page)["positions"][0]


def test_choices_names_and_stocks(studio):
    page = studio.page
    show(page, get_first_example("path"))
    page.locator(at("placement_free")).get_by_label("rotation").check()
    page.locator(at("placement_free")).get_by_label("position").check()
    assert stated(page)["placement_free"] == ["position", "rotation"]

    show(page, get_first_example("gear_train"))
    page.fill(at("stock"), "20, 24 × 3; 30")
    assert stated(page)["stock"] == [20, {"teeth": 24, "count": 3}, 30]

    show(page, get_first_example("planetary_train"))
    page.get_by_label("Name of a new entry").fill("sun")
    page.locator(at("teeth/gears")).get_by_role("button", name="Add").click()
    page.fill(at("teeth/gears/sun/min"), "20")
    assert stated(page)["teeth"]["gears"]["sun"]["min"] == 20

    show(page, get_first_example("dwell"))
    page.select_option(at("output/type"), "slider")
    page.fill(at("output/stroke"), "30")
    assert stated(page)["output"] == {"type": "slider", "stroke": 30}

    show(page, list_examples("dwell")[2])
    page.fill(at("dwells/0/angle"), "80")
    page.fill(at("dwells/1/at"), "0.6")
    assert stated(page)["dwells"] == [{"angle": 80, "at": "low"}, {"angle": 40, "at": 0.6}]
    page.fill(at("dwells/1/at"), "high")
    page.locator('[data-path="/problem/dwells"]').get_by_role("button", name="Add a row").click()
    assert len(stated(page)["dwells"]) == 3
    assert stated(page)["dwells"][1]["at"] == "high"


def test_the_page_is_worked_by_keys_alone(studio):
    page = studio.page
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Skip to the answers"
    state(page, {**PLAIN, "input_side": {"fixed_pivot": [0.0, -20.0], "rotations": [None]}, "max_designs": 4})
    page.click("h1")

    def tab_to(condition, most=120, key="Tab"):
        for _ in range(most):
            page.keyboard.press(key)
            assert page.evaluate("document.activeElement !== document.body"), "the way of the keys ends"
            if page.evaluate(f"(one => {condition})(document.activeElement)"):
                return
        raise AssertionError(condition)

    tab_to("one.id === 'kind'")
    tab_to("one.dataset.path === '/problem/positions/1/angle'")
    page.keyboard.press("Control+A")
    page.keyboard.type("28")
    assert stated(page)["positions"][1]["angle"] == 28
    tab_to("one.matches('.target')")
    page.keyboard.press("ArrowRight")
    assert stated(page)["positions"][0]["x"] > 0.0
    page.keyboard.press("Control+Enter")
    studio.answered()
    cards = page.locator(".card")
    assert cards.count() > 1
    tab_to("one.matches('.card')")
    page.keyboard.press("Home")
    page.keyboard.press("ArrowRight")
    assert cards.nth(1).evaluate("one => one === document.activeElement")
    page.wait_for_selector("#design-title:has-text('Design 2')")
    assert cards.nth(1).get_attribute("aria-pressed") == "true"
    assert cards.nth(0).get_attribute("aria-pressed") == "false"
    page.wait_for_selector(".moving svg")
    tab_to("one.id === 'scrub'", key="Shift+Tab")
    before = page.input_value("#scrub")
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    assert page.input_value("#scrub") != before
    tab_to("one.matches('[role=tab]')")
    # Plots, Explore, Compare, Assembly, Files.
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    assert page.evaluate("document.activeElement.id") == "tab-files"
    tab_to("one.matches('#downloads button') && one.textContent === 'SVG'")
    with page.expect_download() as waiting:
        page.keyboard.press("Enter")
    assert re.fullmatch(r"motion-\d+\.svg", waiting.value.suggested_filename)
    tab_to("one.matches('[role=tab]')", key="Shift+Tab")
    page.keyboard.press("End")
    tab_to("one.matches('#job-words')")
    page.keyboard.type("succeeded")
    assert page.locator(".jobs li:visible").count() > 0


def test_the_focus_stays_where_it_is_while_another_design_is_awaited(studio):
    page = studio.page
    state(page, {**PLAIN, "input_side": {"fixed_pivot": [0.0, -20.0], "rotations": [None]}, "max_designs": 2})
    studio.solve()
    page.wait_for_selector("#scrub")
    held = []
    page.route("**/designs/1/motion*", lambda route: held.append(route))
    page.locator(".card").nth(1).click()
    page.wait_for_selector("#watch.waiting .live")
    page.focus("#scrub")
    page.locator("#scrub").evaluate("one => { one.dataset.before = 'yes'; }")
    until(lambda: page.evaluate("1") and held, 30, "the motion is asked for")
    held.pop().continue_()
    page.wait_for_selector("#watch:not(.waiting) .live")
    assert page.evaluate("document.activeElement.id") == "scrub"
    assert page.evaluate("document.activeElement.dataset.before") is None, "it is the player of the other design"
