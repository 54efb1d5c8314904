"""The room of a linkage is drawn on the canvas, and the answers fit into it."""

import math
import re

import numpy as np
import pytest
import shapely

from synthesis.registry import KINDS, get_first_example
from tests.browser.conftest import PUT
from tests.support.browser.accessibility import violations
from tests.support.browser.room import field
from tests.support.browser.studio import LINKAGES, state, stated
from tests.support.synthesis.space import LID

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

PLANE = "#sketch .canvas"
HALF_PIXEL = 2.5
"""Length units: taken so far away, the canvas of LID shows about two and a half of them in a pixel."""


class Pointer:
    """The mouse by coordinates of the plane: two positions say where they are on the screen."""

    def __init__(self, page, away=2):
        self.page = page
        for _ in range(away):
            page.locator("#sketch").get_by_role("button", name="Zoom out").click()
        (x0, y0), (x1, y1) = (self._middle(name) for name in ("1", "3"))
        first, last = (stated(page)["positions"][k] for k in (0, 2))
        self.scale = (y1 - y0) / (first["y"] - last["y"])
        self.origin = x0 - self.scale * first["x"], y0 + self.scale * first["y"]
        assert x1 == pytest.approx(self.at(last["x"], last["y"])[0], abs=1.0)

    def _middle(self, name):
        box = self.page.locator(f"#sketch .target:has(text:text-is('{name}')) .dot").bounding_box()
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def at(self, x, y):
        return self.origin[0] + self.scale * x, self.origin[1] - self.scale * y

    def click(self, x, y):
        self.page.mouse.click(*self.at(x, y))

    def drag(self, start, end):
        self.page.mouse.move(*self.at(*start))
        self.page.mouse.down()
        self.page.mouse.move(*self.at(*((a + b) / 2 for a, b in zip(start, end, strict=True))))
        self.page.mouse.move(*self.at(*end))
        self.page.mouse.up()


def take(page, role, tool):
    page.select_option("#room-role", role)
    page.get_by_role("button", name=tool, exact=True).click()


def loop(skeleton, inputs):
    """Joints of a fourbar at inputs, radians, by circles: B is the crossing nearest to the last."""
    at = {name: complex(*place) for name, place in skeleton["joints"].items()}
    crank, coupler, output = abs(at["A"] - at["O2"]), abs(at["B"] - at["A"]), abs(at["B"] - at["O4"])
    arm = (at["P"] - at["A"]) / (at["B"] - at["A"])
    places, before = [], at["B"]
    for angle in inputs:
        a = at["O2"] + crank * np.exp(1j * angle)
        across = at["O4"] - a
        along = (coupler**2 - output**2 + abs(across) ** 2) / (2.0 * abs(across))
        up = math.sqrt(max(coupler**2 - along**2, 0.0))
        crossings = [a + across / abs(across) * (along + side * 1j * up) for side in (1, -1)]
        before = min(crossings, key=lambda b: abs(b - before))
        places.append((a, before, a + arm * (before - a)))
    return places


def of(*points):
    return shapely.MultiPoint([(z.real, z.imag) for z in points]).convex_hull


def test_a_zone_and_an_obstacle_are_drawn_and_the_answers_keep_them(studio):
    page = studio.page
    state(page, {**LID, "input_side": {"dyad": "RR"}, "output_side": {"dyad": "RR"}, "max_designs": 3})
    pointer = Pointer(page)
    take(page, "o2", "Rectangle")
    pointer.drag((-500, -50), (-20, 600))
    take(page, "obstacle", "Polygon")
    for corner in ((-260, 300), (-40, 300), (-40, 340), (-260, 340)):
        pointer.click(*corner)
    pointer.click(-260, 300)
    space = stated(page)["space"]
    zone = shapely.Polygon(space["fixed_pivots"]["input"]["polygon"])
    assert np.array(zone.bounds) == pytest.approx([-500, -50, -20, 600], abs=2 * HALF_PIXEL)
    (obstacle,) = (shapely.Polygon(one["polygon"]) for one in space["obstacles"])
    assert np.array(obstacle.bounds) == pytest.approx([-260, 300, -40, 340], abs=2 * HALF_PIXEL)
    field(page, "clearance").fill("5")
    field(page, "link_width").fill("20")
    page.locator("#sketch").scroll_into_view_if_needed()
    studio.screen("room-drawn")
    studio.solve()
    job = page.evaluate("location.hash.slice(5)")
    answer = page.evaluate("id => fetch(`/v1/jobs/${id}`).then(answer => answer.json())", job)
    assert answer["problem"]["space"]["clearance"] == 5
    designs = answer["result"]["designs"]
    assert designs
    for design in designs:
        skeleton = design["mechanism"]["skeleton"]
        assert zone.distance(shapely.Point(skeleton["joints"]["O2"])) < 1e-6
        inputs = np.linspace(*np.radians(design["metrics"]["used_range"]), 241)
        o2, o4 = (complex(*skeleton["joints"][name]) for name in ("O2", "O4"))
        for a, b, p in loop(skeleton, inputs):
            links = [of(o2, a), of(o4, b), of(a, b, p)]
            assert min(link.distance(obstacle) for link in links) - 10.0 >= 5.0 - 1e-3
    page.wait_for_selector(".moving .still .area.obstacle")
    assert page.locator(".moving .still .area").evaluate_all("all => all.map(one => one.classList[1])") == [
        "obstacle",
        "o2",
        "body",
    ]


SHAPES = {
    "o2": ("Circle", (-400, 0), (-400, 100)),
    "o4": ("Rectangle", (100, -100), (300, 0)),
    "a": ("Rectangle", (-300, 400), (-100, 600)),
    "b": ("Circle", (500, 0), (500, 120)),
    "box": ("Rectangle", (700, 620), (-520, -150)),
    "body": ("Rectangle", (-100, -50), (30, 50)),
    "obstacle": ("Circle", (-300, 200), (-300, 250)),
}


def test_every_area_is_drawn_moved_shaped_and_removed(studio):
    """What is drawn stands in the form, and what the form says is drawn."""
    page = studio.page
    state(page, LID)
    pointer = Pointer(page)
    for role, (tool, start, end) in SHAPES.items():
        take(page, role, tool)
        pointer.drag(start, end)
    space = stated(page)["space"]

    def near(*values):
        return pytest.approx(values if len(values) > 1 else values[0], abs=HALF_PIXEL)

    assert space["fixed_pivots"]["input"]["circle"]["center"] == near(-400, 0)
    assert space["fixed_pivots"]["input"]["circle"]["radius"] == near(100)
    assert np.ravel(space["moving_pivots"]["input"]["polygon"]) == near(-300, 400, -100, 400, -100, 600, -300, 600)
    assert np.ravel(space["box"]) == near(-520, -150, 700, 620)
    assert len(space["body"]["outline"]) == 4
    assert field(page, "fixed_pivots/input/circle/center").input_value() == "-400, 0"
    assert field(page, "box").input_value().split("\n")[0] == ", ".join(map(str, space["box"][0]))

    # The obstacle is chosen: drawn last. It is made larger at its radius, and moved.
    pointer.drag((-250, 200), (-200, 200))
    obstacle = stated(page)["space"]["obstacles"][0]["circle"]
    assert obstacle["radius"] == near(100)
    pointer.drag((-330, 200), (-430, 260))
    assert stated(page)["space"]["obstacles"][0]["circle"]["center"] == near(-400, 260)

    # A second zone of a pivot stands beside the first one, and goes again.
    take(page, "o4", "Circle")
    pointer.drag((400, -100), (400, -50))
    assert [list(zone) for zone in stated(page)["space"]["fixed_pivots"]["output"]] == [["polygon"], ["circle"]]
    page.get_by_role("button", name="Delete", exact=True).click()
    assert list(stated(page)["space"]["fixed_pivots"]["output"]) == ["polygon"]

    # A corner is dragged, another one made on a side, and one taken away by its key.
    pointer.click(200, -50)
    assert page.locator("#sketch .grip").count() == 4
    pointer.drag((300, 0), (340, 40))
    assert stated(page)["space"]["fixed_pivots"]["output"]["polygon"][2] == near(340, 40)
    page.mouse.dblclick(*pointer.at(200, -100))
    assert len(stated(page)["space"]["fixed_pivots"]["output"]["polygon"]) == 5
    page.locator("#sketch .grip").nth(1).focus()
    page.keyboard.press("Delete")
    assert len(stated(page)["space"]["fixed_pivots"]["output"]["polygon"]) == 4

    # The form draws too.
    field(page, "fixed_pivots/output/polygon").fill("100, -100\n300, -100\n200, 0")
    assert page.locator("#sketch .grip").count() == 3
    studio.screen("room-form")
    assert violations(page) == []


def test_a_pen_is_left_and_corners_are_taken_back(studio):
    page = studio.page
    state(page, LID)
    pointer = Pointer(page)
    take(page, "obstacle", "Polygon")
    pointer.click(-300, 0)
    page.keyboard.press("Escape")
    assert page.locator("#room-tools [aria-pressed=true][data-tool]").count() == 0
    take(page, "obstacle", "Polygon")
    for corner in ((-300, 0), (-200, 0), (-200, 300), (-200, 100)):
        pointer.click(*corner)
    page.keyboard.press("Backspace")
    page.keyboard.press("Backspace")
    pointer.click(-250, 80)
    assert page.locator("#sketch .target").count() == 3, "no click has added a position"
    page.keyboard.press("Enter")
    (obstacle,) = stated(page)["space"]["obstacles"]
    assert len(obstacle["polygon"]) == 3
    assert len(stated(page)["positions"]) == 3


def test_a_room_is_drawn_by_keys_alone(studio):
    page = studio.page
    state(page, LID)
    page.focus("#room-role")
    page.keyboard.type("Obst")
    page.get_by_role("button", name="Circle", exact=True).focus()
    page.keyboard.press("Enter")
    page.keyboard.press("Enter")
    (obstacle,) = stated(page)["space"]["obstacles"]
    page.locator("#sketch .held").focus()
    page.keyboard.press("ArrowRight")
    moved = stated(page)["space"]["obstacles"][0]["circle"]
    assert moved["center"][0] > obstacle["circle"]["center"][0]
    assert field(page, "obstacles/0/circle/center").input_value() == ", ".join(map(str, moved["center"]))
    page.locator("#sketch .grip").focus()
    page.keyboard.press("ArrowRight")
    assert stated(page)["space"]["obstacles"][0]["circle"]["radius"] > moved["radius"]
    page.locator("#sketch .held").focus()
    page.keyboard.press("Delete")
    assert "obstacles" not in stated(page)["space"]


def test_a_zone_is_drawn_by_touch(open_studio):
    studio = open_studio(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    page = studio.page
    state(page, LID)
    pointer = Pointer(page)
    take(page, "o4", "Polygon")
    corners = [(-400, -50), (-100, -50), (-100, 250)]
    for corner in [*corners, (-395, -45)]:
        page.touchscreen.tap(*pointer.at(*corner))
    polygon = stated(page)["space"]["fixed_pivots"]["output"]["polygon"]
    assert np.array(polygon) == pytest.approx(np.array(corners), abs=6.0)
    studio.screen("room-phone")


@pytest.mark.parametrize("kind", KINDS)
def test_every_linkage_has_room_and_nothing_else(kept_studio, kind):
    page = kept_studio.page
    state(page, get_first_example(kind))
    assert page.locator("#room-tools").count() == (kind in LINKAGES)
    if kind not in LINKAGES:
        return
    roles = page.locator("#room-role option").evaluate_all("all => all.map(one => one.value)")
    assert ("body" in roles) == (kind == "motion")
    before = stated(page)
    page.select_option("#room-role", "obstacle")
    page.get_by_role("button", name="Rectangle", exact=True).click()
    page.keyboard.press("Enter")
    assert len(stated(page)["space"]["obstacles"][0]["polygon"]) == 4
    after = {name: value for name, value in stated(page).items() if name != "space" and value != {}}
    assert after == {name: value for name, value in before.items() if value != {}}


def test_the_view_is_led(studio):
    page = studio.page
    state(page, LID)
    before = Pointer(page, away=0)
    page.get_by_role("button", name="Zoom out").click()
    farther = Pointer(page, away=0)
    assert farther.scale == pytest.approx(before.scale / 1.5, rel=0.02)
    farther.drag((-250, -50), (-150, -50))
    dragged = Pointer(page, away=0)
    assert dragged.origin[0] - farther.origin[0] == pytest.approx(100 * farther.scale, abs=2.0)
    page.get_by_role("button", name="Fit everything").click()
    assert Pointer(page, away=0).scale == pytest.approx(before.scale, rel=0.02)


BODIED = {
    **LID,
    "input_side": {"fixed_pivot": [-170.0, 500.0]},
    "output_side": {"fixed_pivot": [-195.0, 368.0]},
    "max_designs": 1,
    "space": {"body": {"outline": [[0.0, -100.0], [60.0, -100.0], [60.0, 80.0], [-30.0, 80.0]]}, "link_width": 16.0},
}


def test_the_body_goes_with_its_coupler_and_the_sweep_is_played(open_studio):
    studio = open_studio(reduced_motion="reduce")
    page = studio.page
    state(page, BODIED)
    studio.solve()
    page.wait_for_selector(".moving .still .area.body")
    job = page.evaluate("location.hash.slice(5)")
    answer = page.evaluate("id => fetch(`/v1/jobs/${id}`).then(answer => answer.json())", job)
    used = answer["result"]["designs"][0]["metrics"]["used_range"]
    goals = page.locator(".moving .goal").evaluate_all(PUT)
    positions = LID["positions"]
    demanded = np.array([complex(one["x"], one["y"]) for one in positions])
    drawn = np.array([complex(u, -v) for u, v in goals])
    scale = (drawn[2] - drawn[0]) / (demanded[2] - demanded[0])
    outline = np.array([complex(*corner) for corner in BODIED["space"]["body"]["outline"]])

    def corners():
        numbers = re.findall(r"-?[\d.]+", page.get_attribute(".moving .still .area.body", "d"))
        pairs = np.array(numbers, dtype=float).reshape(-1, 2)
        return demanded[0] + (pairs[:, 0] - 1j * pairs[:, 1] - drawn[0]) / scale

    page.focus("#scrub")
    page.keyboard.press("Home")
    assert np.abs(corners() - outline).max() < HALF_PIXEL
    page.locator("#scrub").evaluate(
        "(one, at) => { one.value = at; one.dispatchEvent(new Event('input')); }", (used[1] - used[0]) / 360 % 1 * 240
    )
    turned = demanded[2] + np.exp(1j * math.radians(positions[2]["angle"])) * outline
    assert np.abs(corners() - turned).max() < 2 * HALF_PIXEL
    assert page.locator(".moving .sweep").evaluate("one => one.hasAttribute('hidden')")
    page.check("#sweep")
    assert page.locator(".moving .sweep .swept").count() == 4
    width = float(page.get_attribute(".moving .swept.input", "stroke-width"))
    assert width == pytest.approx(abs(scale) * 16.0, rel=1e-3)
    low, high = sorted(used)
    # By keys, and not by a name that the press itself changes: a click that is tried again finds no Play.
    assert page.inner_text("#play") == "Play", "who asks for little motion is asked first"
    page.press("#play", "Enter")
    page.wait_for_function("document.querySelector('#play').textContent === 'Pause'")
    page.select_option("#speed", "4")
    seen = []
    for _ in range(40):
        page.wait_for_timeout(50)
        seen.append(float(page.inner_text(".moving .reading[for=scrub]").rstrip("°").replace("−", "-")))
    unwound = [low + (angle - low) % 360.0 for angle in seen]
    assert max(min(angle - high, low + 360.0 - angle) for angle in unwound) < 1.5, "it keeps to the used range"
    assert max(unwound) - min(unwound) > 0.5 * (high - low)
    studio.screen("sweep")
    page.uncheck("#sweep")
    assert page.locator(".moving .sweep").evaluate("one => one.hasAttribute('hidden')")
