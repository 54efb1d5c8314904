"""Drawings of other programs are imported into the room: read, assigned, placed as drawn, solved, and taken back."""

import numpy as np
import pytest
import shapely

from tests.support.browser.accessibility import violations
from tests.support.browser.room import field
from tests.support.browser.studio import PLAIN, state, stated
from tests.support.service.drawn_files import dxf
from tests.support.service.drawn_files import page as svg
from tests.support.synthesis.space import LID

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

FRAME = svg(
    '<g id="FRAME"><rect id="lintel" x="-520" y="-480" width="440.25" height="80"/>'
    '<circle id="post" cx="1000" cy="0" r="30"/>'
    '<path id="stroke" d="M0 0h9"/></g>',
    width="50mm",
    height="100mm",
    viewBox="0 0 100 200",
)
"""In half millimetres: a bar of x -260 to -39.875, y 300 to 340 mm, and a post of radius 15 mm about (500, 100) mm."""

WALL = dxf(
    lambda space: space.add_lwpolyline(
        [(-50, -5), (-2, -5), (-2, 60), (-50, 60)], close=True, dxfattribs={"layer": "WALL"}
    ),
    units=5,
)
"""In centimetres."""


def import_(page, name, content):
    with page.expect_file_chooser() as choosing:
        page.get_by_role("button", name="Import drawing").click()
    choosing.value.set_files({"name": name, "mimeType": "", "buffer": content})
    page.wait_for_function(
        "name => document.querySelector('#drawing [role=status]').textContent.startsWith(`${name}:`)", arg=name
    )


def told(page):
    return page.inner_text("#drawing [role=status]")


def test_an_obstacle_and_a_zone_come_from_drawings_and_the_answers_keep_them(studio):
    page = studio.page
    state(page, {**LID, "input_side": {"dyad": "RR"}, "output_side": {"dyad": "RR"}, "max_designs": 2})
    import_(page, "frame.svg", FRAME)
    assert "2 closed outlines" in told(page)
    assert "one unit of the drawing is 0.5 mm" in told(page)
    assert page.input_value("#drawing-scale") == "0.5"
    lintel = page.locator(".drawn li:has-text('lintel on FRAME')")
    assert "220 × 40 mm, 4 corners" in lintel.inner_text()
    assert lintel.locator(".note").get_attribute("title") == "220.125 × 40 mm"
    assert "⌀ 30 mm" in page.inner_text(".drawn li:has-text('post on FRAME')")
    page.locator("#drawing summary").click()
    assert "stroke on FRAME: It is open" in page.inner_text("#drawing .reasons")
    assert page.locator("#drawing-place").is_disabled()
    assert violations(page) == []
    studio.screen("drawing-found")
    page.get_by_label("lintel on FRAME").select_option("obstacle")
    page.get_by_label("post on FRAME").select_option("obstacle")
    page.click("#drawing-place")
    assert "2 areas placed from frame.svg" in told(page)
    import_(page, "wall.dxf", WALL)
    assert "one unit of the drawing is 10 mm" in told(page)
    page.locator(".drawn select").select_option("o2")
    page.click("#drawing-place")

    space = stated(page)["space"]
    zone = shapely.Polygon(space["fixed_pivots"]["input"]["polygon"])
    assert zone.bounds == pytest.approx((-500, -50, -20, 600))
    lintel, post = space["obstacles"]
    assert shapely.Polygon(lintel["polygon"]).bounds == pytest.approx((-260, 300, -39.875, 340))
    assert post["circle"] == {"center": pytest.approx([500, 100]), "radius": 15}
    assert page.locator("#sketch .room .area.obstacle").count() == 2
    assert page.locator("#sketch .held.chosen .area.o2").count() == 1
    field(page, "clearance").fill("5")
    studio.screen("drawing-placed")
    studio.solve()
    job = page.evaluate("location.hash.slice(5)")
    answer = page.evaluate("id => fetch(`/v1/jobs/${id}`).then(answer => answer.json())", job)
    carried = answer["problem"]["space"]
    assert carried["obstacles"][0]["polygon"] == lintel["polygon"]
    assert carried["obstacles"][1]["circle"] == post["circle"]
    assert carried["fixed_pivots"]["input"]["polygon"] == space["fixed_pivots"]["input"]["polygon"]
    assert answer["result"]["designs"]
    for design in answer["result"]["designs"]:
        assert zone.distance(shapely.Point(design["mechanism"]["skeleton"]["joints"]["O2"])) < 1e-6
        kept = {check["name"]: check for check in design["verification"]["checks"]}["obstacles"]
        assert kept["passed"]
        assert kept["value"] >= 5.0


def test_every_use_of_an_outline_its_scale_and_its_undoing(studio):
    page = studio.page
    before = {"clearance": 2, "obstacles": [{"circle": {"center": [90, 90], "radius": 1}}]}
    state(page, {**PLAIN, "space": before})
    shapes = svg(
        '<path id="bar" d="M0 0h4v-2h-4z"/><circle id="ring" cx="10" cy="-5" r="3"/>'
        '<rect id="all" width="20" height="10"/>'
    )
    import_(page, "shapes.svg", shapes)
    assert "states no unit; its numbers are taken as mm" in told(page)
    uses = {
        name: page.get_by_label(name, exact=True).locator("option").evaluate_all("all => all.map(one => one.value)")
        for name in ("bar", "ring", "all")
    }
    assert uses["bar"] == uses["all"] == ["", "o2", "o4", "a", "b", "obstacle", "box", "body"]
    assert uses["ring"] == ["", "o2", "o4", "a", "b", "obstacle", "box"]
    page.fill("#drawing-scale", "0")
    page.get_by_label("bar", exact=True).select_option("body")
    assert page.locator("#drawing-place").is_disabled()
    page.fill("#drawing-scale", "5")
    assert "20 × 10 mm" in page.inner_text(".drawn li:has-text('bar')")
    page.select_option("#drawing-all", "obstacle")
    page.get_by_label("bar", exact=True).select_option("body")
    page.get_by_label("all", exact=True).select_option("box")
    page.click("#drawing-place")
    space = stated(page)["space"]
    assert np.array(space["body"]["outline"]).tolist() == [[0, 0], [20, 0], [20, 10], [0, 10]]
    assert space["box"] == [[0, -50], [100, 0]]
    assert space["obstacles"][1:] == [{"circle": {"center": [50, 25], "radius": 15}}]
    assert space["clearance"] == 2

    def unfolded(space):
        return {name: value for name, value in space.items() if value not in ({}, None)}

    page.click("#drawing-undo")
    assert unfolded(stated(page)["space"]) == before
    assert told(page) == "Undone."
    # What has been done since is not undone with it.
    import_(page, "shapes.svg", shapes)
    page.get_by_label("ring", exact=True).select_option("box")
    page.click("#drawing-place")
    assert stated(page)["space"]["box"] == [[7, 2], [13, 8]]
    field(page, "clearance").fill("3")
    page.click("#drawing-undo")
    assert "changed since" in told(page)
    assert stated(page)["space"]["box"] == [[7, 2], [13, 8]]


def test_a_drawing_that_is_refused_says_why(studio):
    page = studio.page
    state(page, LID)
    statement = stated(page)
    import_(page, "open.svg", svg('<path id="gap" d="M0 0h9v9"/>'))
    assert "no closed outline" in told(page)
    assert "gap: It is open: its ends are 12.73 apart." in page.inner_text("#drawing .reasons")
    import_(page, "part.dxf", b"AutoCAD Binary DXF\r\n\x1a\x00")
    assert "save it as text (ASCII) DXF" in told(page)
    import_(page, "<b>.svg", svg('<rect id="&lt;i&gt;" width="9" height="9"/>'))
    assert page.locator("#drawing b, #drawing i").count() == 0
    assert page.get_by_label("<i>", exact=True).count() == 1
    page.get_by_role("button", name="Close").click()
    assert page.locator(".drawn").count() == 0
    assert stated(page) == statement
    # The browser itself reports answers 4xx; nothing else may have gone wrong.
    assert [text for text in studio.wrong if "422" not in text and "415" not in text] == []
    studio.wrong.clear()
