"""The stage is in the middle of the window: what moves, its player, progress and Cancel are always in view."""

import pytest

from synthesis.registry import KINDS, list_examples
from tests.browser.conftest import ANSWERED
from tests.campaign import further
from tests.support.browser.layout import assert_in_view, inside, watch
from tests.support.browser.studio import PLAIN, state
from tests.support.browser.taking_home import EXAMPLES
from tests.support.service.running import until

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

SIZES = {"desktop": (1440, 900), "wide": (1920, 1080), "tablet": (1024, 768), "phone": (390, 844)}
EVERYWHERE = ("motion", "cam")
"""Kinds that are looked at in every size, light and dark; the others in one where they are taken home, in the campaign
in all."""

OFTEN = [(kind, size, scheme) for kind in EVERYWHERE for size in SIZES for scheme in ("light", "dark")]
SELDOM = further(
    [
        (kind, size, scheme)
        for kind in KINDS
        for size in SIZES
        for scheme in ("light", "dark")
        if (kind, size, scheme) not in OFTEN
    ],
    (),
)


@pytest.mark.parametrize(("kind", "size", "scheme"), [*OFTEN, *SELDOM])
def test_stage_and_player_and_progress_are_in_view_from_solve_to_the_end(open_studio, kind, size, scheme):
    studio = open_studio(has_touch=size == "phone")
    page = studio.page
    width, height = SIZES[size]
    page.set_viewport_size({"width": width, "height": height})
    page.emulate_media(color_scheme=scheme)
    page.select_option("#kind", kind)
    page.select_option("#example", str(EXAMPLES.get(kind, 0)))
    inside(page, "#solve")
    watch(page)
    page.click("#solve")
    page.wait_for_selector(ANSWERED, state="attached", timeout=200_000)
    assert_in_view(page)
    studio.screen(f"layout-{kind}-{size}-{scheme}")


def test_progress_and_cancel_stand_where_solve_stood(open_studio):
    for size in ("desktop", "tablet", "phone"):
        studio = open_studio(viewport={"width": SIZES[size][0], "height": SIZES[size][1]})
        page = studio.page
        state(page, {**list_examples("path")[0], "rounds": 10})
        before = inside(page, "#solve")
        watch(page)
        page.click("#solve")
        page.wait_for_selector("#cancel")
        bar = inside(page, "progress")
        inside(page, "#cancel")
        assert not page.is_visible("#solve"), "one thing at a time"
        assert abs(bar["y"] - before["y"]) < 60
        assert abs(bar["x"] - before["x"]) < 60
        page.click("#cancel")
        page.get_by_text("The job was cancelled.").wait_for()
        assert page.evaluate("outside") == []
        assert {"progress", "cancel"} <= set(page.evaluate("[...seen]"))
        inside(page, "#solve")


def test_a_phone_goes_to_the_answers_and_keeps_the_stage(open_studio):
    studio = open_studio(viewport={"width": 390, "height": 844}, has_touch=True)
    page = studio.page
    state(page, PLAIN)
    before = inside(page, "#boards")
    assert page.get_attribute("#tab-task", "aria-selected") == "true"
    studio.solve()
    assert page.get_attribute("#tab-answers", "aria-selected") == "true"
    inside(page, ".card")
    for tab in ("numbers", "plots", "files", "jobs", "task"):
        page.click(f"#tab-{tab}")
        assert page.get_attribute(f"#tab-{tab}", "aria-selected") == "true"
        assert inside(page, "#boards") == before, "the stage stays put"
        inside(page, "#scrub")
        inside(page, "#solve")


def test_on_a_tablet_the_drawer_is_opened_and_shut(open_studio):
    studio = open_studio(viewport={"width": 1024, "height": 768})
    page = studio.page
    state(page, PLAIN)
    studio.solve()
    page.wait_for_selector(".moving .live .link")
    assert not page.is_visible("#pane-numbers")
    page.click("#tab-plots")
    inside(page, "#pane-plots")
    inside(page, "#scrub")
    page.click("#tab-plots")
    assert not page.is_visible("#pane-plots")
    page.click("#tab-numbers")
    page.keyboard.press("Escape")
    assert not page.is_visible("#pane-numbers")


def test_the_stage_is_brought_nearer_led_along_and_fitted(studio):
    page = studio.page
    state(page, PLAIN)
    studio.solve()
    picture = page.locator(".moving .stage .canvas")
    picture.wait_for()
    page.click(".player button")
    box = picture.bounding_box()

    def pin():
        at = page.locator(".moving .live .pin").first.bounding_box()
        return at["x"] + at["width"] / 2, at["y"] + at["height"] / 2

    x, y = pin()
    page.mouse.move(x, y)
    page.mouse.wheel(0, -400)
    assert pin() == pytest.approx((x, y), abs=1.5), "what is under the pointer stays there"
    nearer = picture.get_attribute("viewBox").split()
    assert float(nearer[2]) < 0.8 * box["width"]
    page.mouse.move(box["x"] + 12, box["y"] + 12)
    page.mouse.down()
    page.mouse.move(box["x"] + 52, box["y"] + 42)
    page.mouse.up()
    assert pin() == pytest.approx((x + 40, y + 30), abs=1.5)
    page.get_by_role("button", name="Fit everything").click()
    assert pin() == pytest.approx((x, y), abs=1.5)
    links = page.locator(".moving .live .link").first
    assert links.evaluate("one => getComputedStyle(one).vectorEffect") == "non-scaling-stroke"


def test_what_moves_fills_the_stage_of_another_window(own_studio):
    """Something high in a wide window, which is then made narrow and high: its empty sides are not kept."""
    page = own_studio.page
    page.set_viewport_size({"width": 1920, "height": 700})
    state(page, list_examples("spring_balancing")[0])
    own_studio.solve()
    page.wait_for_selector(".moving .springs .spring")
    for size in ((1920, 700), (560, 1000)):
        page.set_viewport_size({"width": size[0], "height": size[1]})
        stage, way = (page.locator(f".moving .stage {part}").bounding_box() for part in (".canvas", ".trail"))
        share = max(way["width"] / stage["width"], way["height"] / stage["height"])
        assert share > 0.75, size
    # The spring holds where the answer says, and goes with its lever.
    assert page.inner_text("#design-title") == "Design 1: Sprung linkage"
    page.keyboard.press("Home")
    lever = page.locator(".moving .live .link.input")
    coil, bar = page.locator(".moving .spring").bounding_box(), lever.bounding_box()
    assert coil["x"] >= bar["x"] - 6
    page.click("#tab-numbers")
    assert "N/m" in page.inner_text("#numbers")
    # What is left of a drive that is balanced exactly is rounding, and nothing; the pin bears the arm all the same.
    page.click("#tab-plots")
    peaks = dict(
        page.locator(".peaks tbody tr").evaluate_all(
            "all => all.map(one => [one.cells[0].textContent, one.cells[1].textContent])"
        )
    )
    assert peaks["Drive torque, maximum"] == peaks["Drive torque, minimum"] == "0 N·m"
    assert peaks["Pin force O"] == "81 N"


def test_the_task_folds_away_where_there_is_little_room(own_studio):
    page = own_studio.page
    page.click("#mode-state")
    assert not page.is_visible("#fold")
    page.set_viewport_size({"width": 1024, "height": 768})
    room = "document.querySelector('#boards').clientWidth"
    before = page.evaluate(room)
    page.click("#fold")
    assert not page.is_visible("#statement")
    assert page.evaluate(room) > before + 260
    drawn = "+document.querySelector('#sketch .canvas').getAttribute('viewBox').split(' ')[2]"
    assert page.evaluate(drawn) == page.evaluate(room), "what is stated has the room"
    assert page.is_visible("#solve")
    own_studio.screen("folded")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("t")
    assert page.is_visible("#statement")
    page.set_viewport_size({"width": 1200, "height": 768})
    until(lambda: page.evaluate(drawn) == page.evaluate(room) > before, 20, "the canvas has the new size")
