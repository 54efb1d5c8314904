"""The assembly in three dimensions: it is drawn, moves with the drawing, comes apart, and its parts are taken home."""

import io
import zipfile

import ezdxf
import pytest
from PIL import Image, ImageChops

from service.parts.export.cad_available import is_installed
from tests.support.browser.accessibility import violations
from tests.support.browser.studio import state
from tests.support.browser.taking_home import taken as taken_of_design
from tests.support.service.parts import MOTION
from tests.support.service.parts_of_gearboxes import BOX
from tests.support.service.running import until

pytestmark = [pytest.mark.browser, pytest.mark.timeout(400)]

CANVAS = "#built canvas"
PLACES = "#built, #assembly"
ORANGE, BLUE = (0, 1, 2), (2, 1, 0)
NO_WEBGL = """
const had = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (form, ...more) {
  return form.startsWith("webgl") ? null : had.call(this, form, ...more);
};
"""


def opened(studio, problem=MOTION):
    """The assembly of the first design, at the beginning of its motion."""
    page = studio.page
    state(page, problem)
    studio.solve()
    page.wait_for_selector("#scrub")
    page.focus("#scrub")
    page.keyboard.press("Home")
    page.click("#tab-assembly")
    page.wait_for_selector("#assembly .parts li", timeout=120_000)
    return page


def picture(page):
    """What the canvas shows, when it has been drawn as it is now."""
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return Image.open(io.BytesIO(page.locator(CANVAS).screenshot())).convert("RGB")


def differs(one, other):
    return ImageChops.difference(one, other).getbbox() is not None


def coloured(image):
    """How many pixels have a colour: neither the ground nor shadows nor grey parts have."""
    return sum(count for count, (r, g, b) in image.getcolors(1 << 24) if max(r, g, b) - min(r, g, b) > 60)


def taken(page, described):
    with page.expect_download(timeout=90_000) as waiting:
        page.locator(PLACES).get_by_role("button", name=described, exact=True).click()
    return waiting.value


def test_it_is_drawn_moves_comes_apart_and_is_taken_home(open_studio):
    studio = open_studio(reduced_motion="reduce")
    page = opened(studio)
    first = picture(page)
    assert coloured(first) > 3000
    assert len(first.getcolors(1 << 24)) > 200

    # It goes where the drawing goes, by the one clock that there is.
    page.fill("#scrub", "200")
    page.evaluate("document.querySelector('#scrub').dispatchEvent(new Event('input'))")
    assert differs(first, picture(page))
    assert page.locator("#boards input[type=range]:visible").count() == 2, "the clock's, and how far it is apart"
    page.fill("#scrub", "0")
    assert not differs(first, picture(page))

    # Each way of looking at it is another.
    seen = [first]
    for name in ("Top", "Front", "Side"):
        page.locator(PLACES).get_by_role("button", name=name, exact=True).click()
        seen.append(picture(page))
    assert all(differs(one, other) for k, one in enumerate(seen) for other in seen[:k])
    assert all(coloured(one) > 300 for one in seen)
    page.locator(PLACES).get_by_role("button", name="Isometric", exact=True).click()

    # Parts come apart: the same parts reach higher.
    together = picture(page)
    page.fill("#explode", "1")
    apart = picture(page)
    assert differs(together, apart)
    page.locator(PLACES).get_by_role("button", name="Fit", exact=True).click()
    picture(page)
    studio.screen("assembly")
    with Image.open(taken(page, "Save picture").path()) as saved:
        assert saved.format == "PNG"
        assert coloured(saved.convert("RGB")) > 0.02 * saved.width * saved.height
    page.fill("#explode", "0")

    document = ezdxf.readfile(taken(page, "coupler as DXF").path())
    assert len(document.modelspace().query("CIRCLE")) == 3
    with zipfile.ZipFile(taken(page, "All files as a zip").path()) as archive:
        assert {"bom.csv", "isometric.svg"} <= set(archive.namelist())
    assert page.locator(PLACES).get_by_role("button", name="coupler as STL").count() == int(is_installed())
    report = taken_of_design(page, "Report").read_text(encoding="utf-8")
    assert 'data-panel="isometric"' in report


def test_parts_are_hidden_chosen_and_led_by_keys(open_studio):
    studio = open_studio(reduced_motion="reduce")
    page = opened(studio)
    whole = picture(page)
    kinds = page.locator("#assembly .parts li").count()
    page.locator(PLACES).get_by_role("checkbox", name="Show coupler").uncheck()
    without = picture(page)
    assert coloured(without) < coloured(whole)
    page.locator(PLACES).get_by_role("button", name="Hide all").click()
    assert coloured(picture(page)) == 0
    page.locator(PLACES).get_by_role("button", name="Show all").click()
    assert not differs(picture(page), whole)
    assert page.locator("#assembly .parts li > input:checked").count() == kinds

    # Of equal parts each is hidden at its own place.
    rings = page.locator('#assembly li[data-item="ring"]')
    rings.locator("summary").click()
    places = rings.locator(".places input")
    places.first.uncheck()
    assert differs(picture(page), whole)
    assert places.evaluate_all("all => all.filter(one => one.checked).length") == places.count() - 1
    assert rings.locator("> input").evaluate("one => one.indeterminate && !one.checked")
    rings.locator("> input").check()
    page.mouse.move(0, 0)
    assert not differs(picture(page), whole)

    # Links have their colours of the stage: a click on one chooses it in the list, and the picture shows the choice.
    box = page.locator(CANVAS).bounding_box()
    chosen = page.locator('#assembly .called[aria-pressed="true"]')
    for name, tone in (("input", ORANGE), ("coupler", BLUE)):
        places = ((x, y) for y in range(9, whole.height - 9, 3) for x in range(9, whole.width - 9, 3))
        place = next(one for one in places if within(whole, tone, *one))
        page.mouse.click(box["x"] + place[0], box["y"] + place[1])
        assert chosen.inner_text() == name
    assert differs(picture(page), whole)
    chosen.press("Enter")
    assert chosen.count() == 0
    page.mouse.move(0, 0)
    assert not differs(picture(page), whole)

    # By keys: the canvas has the arrows, and the list all else.
    page.focus(CANVAS)
    for key in ("ArrowLeft", "ArrowUp", "+", "Shift+ArrowRight"):
        before = picture(page)
        page.keyboard.press(key)
        assert differs(picture(page), before), key
    page.keyboard.press("Home")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "explode"
    page.keyboard.press("End")
    assert page.locator("#explode").input_value() == "1"
    page.locator("#show-link_coupler").press("Space")
    assert not page.locator("#show-link_coupler").is_checked()
    page.locator("#show-link_coupler").press("Space")
    for scheme, width in (("dark", 1360), ("light", 390)):
        page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
        page.set_viewport_size({"width": width, "height": 900})
        assert violations(page) == [], (scheme, width)
        wider = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert wider <= 0
        # The whole picture is on the stage, and the player below it.
        drawn, stage = (page.locator(one).bounding_box() for one in (CANVAS, "#boards"))
        assert drawn["y"] + drawn["height"] <= stage["y"] + stage["height"], (scheme, width)
        assert drawn["height"] >= 140
        assert page.is_visible("#watch .player")
        picture(page)
        studio.screen(f"assembly-{scheme}-{width}")


def within(image, tone, x, y):
    """Whether a place lies well within what has a tone: its channels from the strongest to the weakest."""
    around = [image.getpixel((x + u, y + v)) for u in (-6, 0, 6) for v in (-6, 0, 6)]
    return all(one[tone[0]] > one[tone[1]] + 40 > one[tone[2]] + 50 for one in around)


def test_what_leaves_no_room_is_said_with_a_button_for_the_scale_that_works(open_studio):
    studio = open_studio(reduced_motion="reduce")
    page = opened(studio)
    page.fill("#assembly-width", "60")
    page.locator("#assembly-width").press("Enter")
    fault = page.locator("#assembly-fault")
    until(lambda: "Links 60 mm wide do not fit" in fault.inner_text(), 90, "the reason")
    assert page.locator("#assembly-width").get_attribute("aria-invalid") == "true"
    assert not page.locator(CANVAS).is_visible()
    fault.get_by_role("button").click()
    page.locator(CANVAS).wait_for(timeout=120_000)
    scale = float(page.input_value("#assembly-scale"))
    assert scale > 1.0
    assert f"{scale:g} times the size of the design" in page.locator("#assembly .note[role=status]").inner_text()
    assert fault.inner_text() == ""
    assert [text for text in studio.wrong if "422" not in text] == []
    studio.wrong.clear()


def test_without_webgl_the_parts_are_listed(own_studio):
    own_studio.page.add_init_script(NO_WEBGL)
    own_studio.load()
    page = opened(own_studio)
    assert "cannot draw in three dimensions" in page.locator("#built").inner_text()
    assert page.locator(CANVAS).count() == 0
    assert ezdxf.readfile(taken(page, "base as DXF").path()).modelspace().query("CIRCLE")


def test_a_gearbox_is_shown_in_the_speed_that_is_chosen(open_studio):
    page = opened(open_studio(reduced_motion="reduce"), BOX)
    notes = page.locator(".solids .note")
    assert notes.filter(has_text="Speed 1 of 3 is shown").count() == 1
    first = picture(page)
    # What is engaged in the drawing is engaged in the assembly, too.
    slowest = page.inner_text("#beside .speeds")
    page.select_option("#engaged", "2")
    notes.filter(has_text="Speed 3 of 3 is shown").wait_for(timeout=120_000)
    assert differs(first, picture(page))
    assert page.inner_text("#beside .speeds") != slowest
