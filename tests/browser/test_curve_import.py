"""Files that are dropped or chosen become a path, an area or a follower's motion; a picture is traced over."""

import math

import numpy as np
import pytest

from tests.support.browser.accessibility import violations
from tests.support.browser.studio import PLAIN, state, stated
from tests.support.service.drawn_files import dxf
from tests.support.service.drawn_files import page as svg
from tests.support.service.imports import blob, picture

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

PATH = {"kind": "path", "points": [{"x": 0, "y": 0}, {"x": 20, "y": 10}, {"x": 40, "y": 0}], "max_designs": 1}
CAM = {
    "kind": "cam",
    "segments": [
        {"motion": "dwell", "angle": 180},
        {"motion": "rise", "angle": 90, "lift": 5},
        {"motion": "return", "angle": 90},
    ],
    "follower": {"type": "translating_roller", "roller_radius": 5},
    "limits": {"pressure_angle": 30},
}

DROP = """
([name, type, bytes]) => {
  const data = new DataTransfer();
  data.items.add(new File([new Uint8Array(bytes)], name, { type }));
  const place = document.querySelector("#answers");
  for (const event of ["dragover", "drop"]) {
    place.dispatchEvent(new DragEvent(event, { dataTransfer: data, bubbles: true, cancelable: true }));
  }
}
"""


def told(page):
    return page.inner_text("#curves > [role=status]")


def read(page, name):
    page.wait_for_function(
        "name => document.querySelector('#curves > [role=status]').textContent.startsWith(`${name}:`)", arg=name
    )


def drop(page, name, content, media_type=""):
    page.evaluate(DROP, [name, media_type, list(content)])
    read(page, name)


def choose(page, name, content):
    with page.expect_file_chooser() as choosing:
        page.click("#curve-import")
    choosing.value.set_files({"name": name, "mimeType": "", "buffer": content})
    read(page, name)


def test_a_dropped_drawing_becomes_a_path_and_areas(studio):
    page = studio.page
    state(page, PATH)
    drawing = svg(
        '<path id="way" d="M10 90C20 40 60 40 70 80"/><circle id="post" cx="50" cy="20" r="4"/><text id="t">x</text>',
        width="100mm", height="100mm", viewBox="0 0 100 100",
    )  # fmt: skip
    drop(page, "way.svg", drawing)
    assert "2 curves; one unit of the file is 1 mm" in told(page)
    assert "open" in page.inner_text("#curves li:has-text('way')")
    assert page.locator("#curve0 option").evaluate_all("all => all.map(one => one.value)") == ["", "points"]
    assert "obstacle" in page.locator("#curve1 option").evaluate_all("all => all.map(one => one.value)")
    assert page.locator("#curve-place").is_disabled()
    page.locator("#curves summary").click()
    assert "It is text" in page.inner_text("#curves .reasons")
    assert violations(page) == []
    studio.screen("curves-found")
    # Fewer points are read anew.
    page.fill("#curve-points", "9")
    page.press("#curve-points", "Tab")
    page.wait_for_function("() => document.querySelector('#curves li .note').textContent.includes(' 9 points')")
    page.select_option("#curve0", "points")
    page.select_option("#curve1", "obstacle")
    page.click("#curve-place")
    assert "2 curves taken from way.svg" in told(page)
    now = stated(page)
    z = np.array([complex(p["x"], p["y"]) for p in now["points"]])
    assert len(z) == 9
    assert z[[0, -1]] == pytest.approx(np.array([10 + 10j, 70 + 20j]))
    assert now["closed"] is False
    post = np.array(now["space"]["obstacles"][0]["polygon"]) @ np.array([1, 1j])
    assert len(post) > 60  # not the nine that the path is to have
    assert np.abs(post - (50 + 80j)) == pytest.approx(np.full(len(post), 4), rel=1e-6)
    assert page.locator("#sketch .room .area.obstacle").count() == 1


def test_a_dxf_a_table_and_a_picture_become_outlines_with_another_scale(studio):
    page = studio.page
    state(page, PLAIN)
    lid = dxf(lambda space: space.add_lwpolyline([(0, 0), (2, 0), (2, 1), (0, 1)], close=True), units=0)
    choose(page, "lid.dxf", lid)
    assert "states no unit" in told(page)
    page.fill("#curve-scale", "10")
    assert "20 × 10 mm, 4 points, closed" in page.inner_text("#curves li")
    page.select_option("#curve0", "body")
    page.click("#curve-place")
    assert stated(page)["space"]["body"]["outline"] == [[0, 0], [20, 0], [20, 10], [0, 10]]
    choose(page, "post.csv", b"x [cm],y [cm]\n5,40\n6,40\n6,41\n5,40\n")
    page.select_option("#curve0", "obstacle")
    page.click("#curve-place")
    assert stated(page)["space"]["obstacles"][0]["polygon"] == [[50, 400], [60, 400], [60, 410]]
    choose(page, "blob.png", picture(200, blob(), dpi=(254, 254)))
    page.select_option("#curve0", "obstacle")
    page.click("#curve-place")
    z = np.array(stated(page)["space"]["obstacles"][1]["polygon"]) @ np.array([1, 1j]) - (6 + 12j)
    assert np.hypot(z.real / 4, z.imag / 2) == pytest.approx(np.ones(len(z)), abs=0.02)


def test_a_table_becomes_the_motion_of_a_follower_and_is_solved(studio):
    page = studio.page
    state(page, CAM)
    angle = np.linspace(0, 360, 25)
    table = "".join(f"{a:g};{20 + 8 * (1 - math.cos(math.radians(a))):.6f}\n" for a in angle)
    drop(page, "lift.csv", table.replace(".", ",").encode())
    page.select_option("#curve0", "motion")
    page.click("#curve-place")
    segments = stated(page)["segments"]
    assert len(segments) == 24
    assert sum(one["angle"] for one in segments) == pytest.approx(360)
    for k, one in enumerate(segments):
        at = math.radians(angle[k])
        assert one["conditions"][0]["s"] == pytest.approx(8 * (1 - math.cos(at)), abs=1e-5)
        assert one["conditions"][0]["v"] == pytest.approx(8 * math.sin(at), abs=2e-3)
        assert one["conditions"][0]["a"] == pytest.approx(8 * math.cos(at), abs=0.06)
        assert one["conditions"][1]["s"] == segments[(k + 1) % 24]["conditions"][0]["s"]
    studio.solve()
    assert page.locator(".card").count() == 1
    # What is no motion says why.
    for content, word in ((b"0 0\n9 9\n20 3\n30 0\n25 1\n", "turns back"), (b"0 0\n9 9\n20 3\n30 5\n", "must end")):
        choose(page, "odd.csv", content)
        page.select_option("#curve0", "motion")
        page.click("#curve-place")
        assert word in told(page)
    assert stated(page)["segments"] == segments


def test_a_picture_is_laid_behind_the_canvas_scaled_by_two_points_and_traced(studio):
    page = studio.page
    state(page, PATH)
    drop(page, "blob.png", picture(200, blob()), "image/png")
    assert "states no scale" in told(page)
    page.click("#curve-behind")
    page.wait_for_selector("#sketch image.backdrop")
    # The picture shows: it is decoded, and where the ellipse is it is dark.
    assert page.locator("#sketch image.backdrop").get_attribute("href").startswith("blob:")
    page.click("#backdrop-pick")
    assert "Click one end" in page.inner_text("#backdrop")
    page.locator("#sketch .canvas").scroll_into_view_if_needed()
    box = page.locator("#sketch image.backdrop").bounding_box()
    # The ends of the ellipse, 80 pixels of 200 apart.
    for share in (0.1, 0.5):
        page.mouse.click(box["x"] + share * box["width"], box["y"] + 0.4 * box["height"])
    assert page.locator("#sketch .marks .mark").count() == 2
    studio.screen("backdrop")
    page.fill("#backdrop-distance", "40")
    page.click("#backdrop-set")
    assert float(page.input_value("#backdrop-width")) == pytest.approx(100, rel=0.02)
    assert violations(page) == []
    # Nothing was drawn by these clicks; and its contour is where the picture lies.
    assert stated(page)["points"] == PATH["points"]
    page.select_option("#curve0", "points")
    page.click("#curve-place")
    now = stated(page)
    assert now["closed"] is True
    z = np.array([complex(p["x"], p["y"]) for p in now["points"]])
    assert np.ptp(z.real) == pytest.approx(40, rel=0.05)
    assert np.ptp(z.imag) == pytest.approx(20, rel=0.05)
    image = page.locator("#sketch image.backdrop").bounding_box()
    trail = page.locator("#sketch .trail").bounding_box()
    assert trail["x"] + trail["width"] / 2 == pytest.approx(image["x"] + 0.3 * image["width"], abs=5)
    assert trail["y"] + trail["height"] / 2 == pytest.approx(image["y"] + 0.4 * image["height"], abs=5)
    page.fill("#backdrop-width", "200")
    page.press("#backdrop-width", "Tab")
    assert "One pixel is 1 mm" in page.inner_text("#backdrop")
    page.click("#backdrop-clear")
    assert page.locator("#sketch image.backdrop").count() == 0


def test_what_cannot_be_read_says_why(studio):
    page = studio.page
    state(page, PATH)
    before = stated(page)
    drop(page, "<b>.svg", svg('<text id="&lt;i&gt;">x</text>'))
    assert "no curve" in told(page)
    assert "<i>: It is text; turn it into paths." in page.inner_text("#curves .reasons")
    assert page.locator("#curves b, #curves i").count() == 0
    drop(page, "part.csv", b"0,0\n1,b\n")
    assert "Line 2" in told(page)
    assert stated(page) == before
    assert [text for text in studio.wrong if "422" not in text and "400" not in text] == []
    studio.wrong.clear()
