"""The page is never empty: a machine moves when it opens, and any example of the gallery is two clicks away."""

import json

import pytest

from synthesis.registry import KINDS, list_examples
from tests.browser.conftest import ANSWERED
from tests.campaign import further
from tests.support.browser.accessibility import violations
from tests.support.browser.opening import FIRST_S, MOVES
from tests.support.browser.studio import PLAIN, drag, state, stated
from tests.support.service.running import until

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

REQUESTS = 10
"""At most, for all that the page consists of when it has been opened."""

BUSY = 4.0
"""So many times as long as that on a machine that does other things too."""


def test_a_machine_moves_when_the_page_opens(studio):
    page = studio.page

    def jobs():
        return page.evaluate("fetch('/v1/jobs?limit=100').then(answer => answer.json())")["jobs"]

    before = len(jobs())
    asked = []
    page.on("request", lambda one: asked.append(one.url))
    page.reload()
    took = page.wait_for_function(MOVES, polling="raf").json_value()
    print(f"the first machine moves {took:.2f} s after the page was asked for")
    assert took <= FIRST_S * BUSY
    assert page.inner_text("#caption") == "Example: Hatch lid"
    studio.screen("opening")
    assert page.evaluate("location.hash") == "", "no job was made for it"
    page.wait_for_selector("#jobs li", state="attached")
    sent = [one.removeprefix(studio.url) for one in asked]
    assert len(sent) <= REQUESTS, sent
    assert len(jobs()) == before
    # What is stated beside it is what it answers.
    kept = page.evaluate("fetch('/studio/opening.json').then(answer => answer.json())")
    assert stated(page) == kept["problem"] == list_examples("motion")[0]
    assert page.locator("#design-title").inner_text().startswith("Example: Hatch lid")
    # It makes room for whatever else is stated.
    page.fill('[data-path="/problem/positions/1/angle"]', "-20")
    assert page.is_visible("#sketch .target >> nth=1")
    assert page.locator(".moving .live").count() == 0
    assert page.inner_text("#caption") == ""
    assert page.is_disabled("#mode-watch")


def test_with_little_motion_asked_for_it_stands_still(open_studio):
    page = open_studio().page
    page.emulate_media(reduced_motion="reduce")
    page.reload()
    page.wait_for_selector(".moving .live .link")
    assert page.inner_text(".moving .player button") == "Play"


def test_the_gallery_has_every_example_and_solves_it_by_two_clicks(studio):
    page = studio.page
    page.click("#gallery-open")
    page.wait_for_selector("#gallery[open] .thumbnail")
    cards = page.locator(".gallery-card").evaluate_all(
        "all => all.map(one => [one.dataset.example, one.querySelector('strong').textContent, "
        "one.querySelector('.note').textContent, one.querySelectorAll('.thumbnail *').length])"
    )
    told = page.evaluate("fetch('/v1/problems').then(answer => answer.json())")["problems"]
    named = {f"{kind['kind']}-{n}": one for kind in told for n, one in enumerate(kind["examples"])}
    assert set(named) == {f"{kind}-{n}" for kind in KINDS for n in range(len(list_examples(kind)))}
    assert len(cards) == len(named)
    for key, name, line, drawn in cards:
        assert (name, line) == (named[key]["name"], named[key]["line"])
        assert drawn > 0, f"{key} has no picture"
    headings = page.locator("#gallery h3").all_inner_texts()
    assert headings[:5] == [
        "Carry a body", "Draw a curve", "Make an output follow", "Change a speed", "Lift and rest",
    ]  # fmt: skip
    assert violations(page) == []
    studio.screen("gallery")
    page.click('[data-example="motion-3"]')
    page.wait_for_selector(ANSWERED, timeout=200_000)
    assert stated(page) == list_examples("motion")[3]
    assert page.input_value("#label") == "Arm, five positions"
    page.wait_for_selector(".moving .live .link")


def test_the_gallery_and_the_sheet_of_keys_work_by_keys(studio):
    page = studio.page
    page.wait_for_selector("#fields .field")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("?")
    sheet = page.locator("#keys")
    assert sheet.is_visible()
    assert violations(page) == []
    studio.screen("keys")
    page.keyboard.press("Escape")
    assert not sheet.is_visible()
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("g")
    assert page.locator("#gallery").is_visible()
    while page.evaluate("document.activeElement.dataset.example") != "cam-0":
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    page.wait_for_selector(ANSWERED, timeout=200_000)
    page.wait_for_selector(".moving .cam")
    page.evaluate("document.activeElement.blur()")
    playing = page.inner_text(".moving .player button")
    page.keyboard.press("Space")
    assert page.inner_text(".moving .player button") != playing
    page.keyboard.press("Home")
    assert float(page.input_value("#scrub")) == 0.0
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Shift+ArrowRight")
    assert float(page.input_value("#scrub")) == pytest.approx(11.0)
    page.keyboard.press("p")
    assert page.is_visible("#pane-plots .plot")
    before = page.get_attribute(".moving .canvas", "viewBox")
    page.keyboard.press("+")
    assert page.get_attribute(".moving .canvas", "viewBox") != before
    page.keyboard.press("f")
    assert page.get_attribute(".moving .canvas", "viewBox") == before
    # A letter that is typed into a field is a letter.
    page.click("#label")
    page.keyboard.type("gnp?")
    assert page.input_value("#label").endswith("gnp?")
    assert not page.locator("#gallery").is_visible()
    # And they can be switched off.
    page.click("#keys-open")
    page.uncheck("#letters")
    page.keyboard.press("Escape")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("g")
    assert not page.locator("#gallery").is_visible()


def test_every_key_of_the_sheet_does_what_it_says(studio):
    page = studio.page
    studio.context.grant_permissions(["clipboard-read", "clipboard-write"])
    state(page, list_examples("motion")[0])
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("Control+Enter")
    page.wait_for_selector(ANSWERED, timeout=200_000)
    page.wait_for_selector(".moving .live .link")
    page.evaluate("document.activeElement.blur()")
    listed = set(page.locator("#keys-list dt").all_text_contents())
    mode, at = "document.querySelector('#stage').dataset.mode", "+document.querySelector('#scrub').value"
    chosen = "document.querySelector('.card[aria-pressed=true]').dataset.design"
    tab = "document.querySelector('.tab[aria-selected=true]').id"
    is_open = "document.querySelector('#{}').open"
    tried = {
        "Space": [(" ", "document.querySelector('.player button').textContent", None)],
        "←or→": [("Home", at, 0), ("ArrowRight", at, None), ("Shift+ArrowRight", at, None), ("ArrowLeft", at, None)],
        "HomeorEnd": [("End", at, None), ("Home", at, 0)],
        "1…9": [("3", chosen, "3"), ("1", chosen, "1")],
        "[or]": [("]", chosen, "2"), ("[", chosen, "1")],
        "K": [("k", "document.querySelector('.pin-button').getAttribute('aria-pressed')", "true")],
        "+or−": [("+", "document.querySelector('.moving .canvas').getAttribute('viewBox')", None)],
        "F": [("f", "document.querySelector('.moving .canvas').getAttribute('viewBox')", None)],
        "R": [("r", "document.querySelectorAll('.moving .ruler-end').length", 2)],
        "SorW": [("s", mode, "state"), ("w", mode, "watch")],
        "P": [("p", tab, "tab-plots")],
        "N": [("n", tab, "tab-numbers")],
        "C": [("c", tab, "tab-compare")],
        "E": [("e", tab, "tab-explore")],
        "L": [("l", "document.querySelector('#link-told').textContent", None)],
        "?": [("?", is_open.format("keys"), True), ("Escape", is_open.format("keys"), False)],
        "G": [("g", is_open.format("gallery"), True), ("Escape", is_open.format("gallery"), False)],
    }  # fmt: skip
    # Solve, steps, Escape and the fold have tests of their own.
    elsewhere = {"CtrlEnter", "CtrlZ", "CtrlShiftZ", "Esc", "T"}
    assert {one.replace(" ", "") for one in listed} == set(tried) | elsewhere
    for name, presses in tried.items():
        for key, told, wanted in presses:
            # A design that was chosen takes the place of the one before when its motion is there.
            page.wait_for_selector("#watch:not(.waiting)", state="attached")
            before = page.evaluate(told)
            page.keyboard.press(key)
            if wanted is None:
                until(lambda told=told, before=before: page.evaluate(told) != before, 10, f"{name}: {key}")
            else:
                until(lambda told=told, wanted=wanted: page.evaluate(told) == wanted, 10, f"{name}: {key}")
            page.evaluate("document.activeElement.blur()")


def test_every_card_of_the_gallery_is_reached_by_tab(studio):
    page = studio.page
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("g")
    page.wait_for_selector("#gallery[open] .gallery-card")
    cards = page.locator(".gallery-card").evaluate_all("all => all.map(one => one.dataset.example)")
    reached = []
    for _ in range(len(cards) + 12):
        page.keyboard.press("Tab")
        found = page.evaluate("document.activeElement.dataset.example ?? null")
        reached += [found] if found else []
    assert reached[: len(cards)] == cards


@pytest.mark.parametrize(
    ("kind", "n"), further([(kind, n) for kind in KINDS for n in range(len(list_examples(kind)))], ())
)
def test_each_example_is_solved_by_two_clicks(studio, kind, n):
    page = studio.page
    page.click("#gallery-open")
    page.click(f'[data-example="{kind}-{n}"]')
    page.wait_for_selector(ANSWERED, timeout=280_000)
    assert page.locator(".card .good").count() >= 1
    page.wait_for_selector(".moving .stage .canvas")


def test_steps_of_a_statement_are_undone_and_done_again(studio):
    page = studio.page
    state(page, PLAIN)
    page.wait_for_timeout(800)
    first = stated(page)
    drag(page, ".target >> nth=1 >> .dot", (60, -40))
    dragged = stated(page)
    assert dragged != first
    page.wait_for_timeout(800)
    page.fill('[data-path="/problem/positions/0/angle"]', "12")
    typed = stated(page)
    page.keyboard.press("Control+z")
    assert stated(page) == dragged
    assert page.input_value('[data-path="/problem/positions/0/angle"]') == "0"
    page.click("#undo")
    assert stated(page) == first
    page.keyboard.press("Control+Shift+Z")
    assert stated(page) == dragged
    page.click("#redo")
    assert stated(page) == typed
    assert page.is_disabled("#redo")
    # Another kind is one step, too.
    page.select_option("#kind", "cam")
    assert stated(page)["kind"] == "cam"
    page.click("#undo")
    assert stated(page) == typed
    assert page.input_value("#kind") == "motion"
    until(lambda: json.loads(page.input_value("#json-text")) == typed, what="the JSON")


def test_the_gallery_opens_for_who_asks_before_the_service_has_told_its_examples(own_studio):
    page = own_studio.page
    held = []
    page.route("**/v1/problems", lambda route: held.append(route))
    page.goto(f"{own_studio.url}/")
    # The first machine moves already; what its numbers measure is told by the service.
    size = page.get_by_role("row", name="Size").locator("td")
    size.wait_for()
    assert size.inner_text().replace(".", "").isdigit()
    page.keyboard.press("g")
    assert not page.is_visible("#gallery")
    until(lambda: page.evaluate("1") and held, 30, "the page asks for the examples")
    held.pop().continue_()
    page.wait_for_selector("#gallery[open] .gallery-card")
    assert size.inner_text().endswith(" mm")
