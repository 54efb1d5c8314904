"""Forces beside the motion: arrows, drive, plots, hodograph and peaks say what the service says."""

import math
import re
from functools import partial

import numpy as np
import pytest

from tests.browser.conftest import PUT
from tests.support.browser import studio as studio_steps
from tests.support.browser.accessibility import violations
from tests.support.browser.studio import PLAIN
from tests.support.service.running import until

pytestmark = pytest.mark.browser

solved = partial(studio_steps.solved, shown=".moving .force")

STEEL = {"density": 7800.0, "thickness": 10.0, "width": 2.0}
BLOCK = {
    "gravity": {},
    "speed_rpm": 120.0,
    "links": STEEL,
    "loads": [{"joint": "A", "force": {"constant": [3.0, -12.0]}}],
}
START = -113.99447906406018
"""Input of the first position, degrees."""

PLACE = 60
"""Of 361 samples of the forces, where the motion is put."""

LINES = "all => all.map(one => ['x1', 'y1', 'x2', 'y2'].map(name => +one.getAttribute(name)))"
BOX = {"left": 58.0, "width": 300.0 - 68.0}


def forces_of(studio, server, body=None):
    job = re.search(r"#job=(\w+)", studio.page.url).group(1)
    path, steps = f"/v1/jobs/{job}/designs/0/forces", {"steps": 360}
    answer = (
        server.client.get(path, params=steps) if body is None else server.client.post(path, params=steps, json=body)
    )
    assert answer.status_code == 200, answer.text
    return answer.json()


def number(text):
    return float(re.match(r"[−\d.-]+", text).group().replace("−", "-"))


def lead(page, place):
    """Put the motion, of 241 samples, to one of the 361 of the forces."""
    page.locator("#scrub").evaluate(
        "(scrub, at) => { scrub.value = at; scrub.dispatchEvent(new Event('input')); }", place * 240 / 360
    )


def arrows(page):
    """By joint and link: where the arrow begins, and the force that its length and direction stand for."""
    scale = page.locator(".force-scale")
    per_newton = float(scale.get_attribute("data-length")) / float(scale.get_attribute("data-force"))
    ((x1, _, x2, _),) = page.locator(".force-scale line").evaluate_all(LINES)
    assert x2 - x1 == pytest.approx(float(scale.get_attribute("data-length")), abs=0.02)
    assert scale.text_content() == f"{float(scale.get_attribute('data-force')):g} N"
    lines = page.locator(".force line").evaluate_all(LINES)
    names = page.locator(".force").evaluate_all("all => all.map(one => [one.dataset.joint, one.dataset.on])")
    found = {
        (joint, on): ((x1, y1), ((x2 - x1) / per_newton, (y1 - y2) / per_newton))
        for (joint, on), (x1, y1, x2, y2) in zip(names, lines, strict=True)
    }
    return per_newton, found


def test_arrows_and_cursors_say_what_the_service_says(open_studio, server):
    studio = open_studio(reduced_motion="reduce")
    page = studio.page
    solved(studio, {**PLAIN, "dynamics": BLOCK})
    answer = forces_of(studio, server)
    told = answer["dynamics"]
    room = page.locator(".moving > .stage").bounding_box()
    largest = max(np.hypot(one["x"], one["y"]).max() for on in told["joints"].values() for one in on.values())
    for place in (PLACE, 3 * PLACE):
        lead(page, place)
        per_newton, found = arrows(page)
        assert per_newton * largest == pytest.approx(room["height"] / 5.0, abs=0.2), (
            "the peak is a fifth of the drawing"
        )
        assert {joint for joint, _ in found} == set(told["joints"])
        pins = page.locator(".moving .live .joined:has(.pin)").evaluate_all(PUT)
        for (joint, on), (begin, force) in found.items():
            expected = told["joints"][joint][on]
            assert force == pytest.approx((expected["x"][place], expected["y"][place]), abs=0.02 / per_newton)
            assert min(math.dist(begin, pin) for pin in pins) < 0.02
        assert number(page.inner_text(".drive-now output")) == pytest.approx(told["drive"][place], rel=6e-3)
        assert page.inner_text(".drive-now output").endswith(" N·m")
        marks = [u for u, _ in page.locator(".force-plots .mark").evaluate_all(PUT)]
        assert marks == pytest.approx([BOX["left"] + BOX["width"] * place / 360] * len(marks), abs=1e-4)
        assert len(marks) == 4
    page.click("#tab-plots")
    # The free body of a link has the forces of both its pins.
    page.select_option("#force-on", "ground")
    _, found = arrows(page)
    shaking = told["shaking"]["force"]
    total = [sum(force[axis] for _, force in found.values()) for axis in (0, 1)]
    assert total == pytest.approx((shaking["x"][3 * PLACE], shaking["y"][3 * PLACE]), abs=0.1)

    # A click in a plot leads the motion there, and the hodograph goes along.
    plot = page.locator(".force-plots svg").first
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    page.mouse.click(box["x"] + box["width"] * (BOX["left"] + BOX["width"] * 0.25) / 300, box["y"] + box["height"] / 2)
    assert float(page.input_value("#scrub")) == pytest.approx(60.0, abs=1.5)
    lead(page, PLACE)
    page.select_option("#hodograph-of", label="shaking force")
    reach = np.hypot(shaking["x"], shaking["y"]).max()
    dot = page.locator(".hodograph-now").evaluate("dot => [+dot.getAttribute('cx'), +dot.getAttribute('cy')]")
    seen = [(dot[0] - 150.0) * reach / 120.0, (150.0 - dot[1]) * reach / 120.0]
    assert seen == pytest.approx((shaking["x"][PLACE], shaking["y"][PLACE]), abs=1e-6 * reach)

    # Peaks, with their units and the inputs at which they stand.
    rows = page.locator(".peaks tbody tr").evaluate_all(
        "all => all.map(row => [...row.cells].map(one => one.innerText.trim()).concat(row.cells[1].title))"
    )
    extremes = told["extremes"]
    peaks = {
        "Drive torque, maximum": (extremes["drive"]["max"], extremes["drive"]["at"], "N·m"),
        "Drive torque, minimum": (extremes["drive"]["min"], extremes["drive"]["at_min"], "N·m"),
        **{f"Pin force {name}": (one["max"], one["at"], "N") for name, one in extremes["joints"].items()},
        "Shaking force": (*extremes["shaking_force"].values(), "N"),
        "Shaking moment": (*extremes["shaking_moment"].values(), "N·m"),
        "Power of the drive": (told["power"]["peak"], None, "W"),
    }
    assert [row[0] for row in rows] == list(peaks)
    for name, value, at, _, title in rows:
        expected, where, unit = peaks[name]
        assert number(value) == pytest.approx(expected, rel=5.1e-3)
        assert number(title) == pytest.approx(expected, rel=1e-12)
        assert value.split()[-1] == unit
        assert at == "–" if where is None else number(at) == pytest.approx(where, abs=0.051)
    lines = "one => { const all = new Range(); all.selectNodeContents(one); return all.getClientRects().length; }"
    assert page.locator(".peaks tbody th", has_text="Pin force O2").evaluate(lines) == 1, "names have room"
    page.locator(".peaks button").first.click()
    assert number(page.inner_text(".moving .reading[for=scrub]")) == pytest.approx(extremes["drive"]["at"], abs=0.11)
    assert page.locator(".gaps li").count() == 0
    studio.screen("forces")
    # A phone shows all of it, no wider than itself.
    page.set_viewport_size({"width": 390, "height": 844})
    assert page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth") <= 0
    # Closed, it leaves the motion as it was.
    page.locator("#forces summary").first.click()
    page.wait_for_selector(".moving .force", state="detached")
    x, y, *_ = map(float, page.get_attribute(".moving > .stage .canvas", "viewBox").split())
    assert min(x, y) >= 0.0, "the room of the arrows is given back"
    assert max(x, y) > 0.0, "and the linkage alone fills the picture"


def test_where_a_force_is_not_determined_there_is_a_gap_with_its_reason(open_studio, server):
    studio = open_studio(reduced_motion="reduce")
    page = studio.page
    friction = {"pins": {name: {"mu": 0.5, "radius": 20.0} for name in ("O2", "O4", "A", "B")}}
    solved(studio, {**PLAIN, "dynamics": {**BLOCK, "friction": friction}})
    answer = forces_of(studio, server)
    told, inputs = answer["dynamics"], answer["input_angle"]
    jammed = [k for k, one in enumerate(told["status"]) if one != "ok"]
    low, high = jammed[0], jammed[-1]
    assert {told["status"][k] for k in range(low, high + 1)} == {"friction_jam"}
    assert PLACE < low < high < 360, "one gap within the motion"
    (gap,) = page.locator(".gaps li").all_inner_texts()
    said = [float(one.replace("−", "-")) for one in re.findall(r"([−\d.]+)°", gap)]
    assert said == pytest.approx([inputs[low], inputs[high]], abs=0.051)
    reason = "friction jams it"
    assert gap.endswith(f"° {reason}")
    lead(page, PLACE)
    assert page.locator(".force:not([hidden])").count() == 4
    assert number(page.inner_text(".drive-now output")) == pytest.approx(told["drive"][PLACE], rel=6e-3)
    assert page.inner_text(".drive-now .note") == ""
    page.click("#tab-plots")
    page.locator(".gaps button").click()
    assert page.inner_text(".drive-now output") == "–"
    assert page.inner_text(".drive-now .note") == reason
    assert page.locator(".force:not([hidden])").count() == 0
    # Each plot has the gap, in its line too.
    assert page.locator(".force-plots .plot").count() == page.locator(".force-plots .gap").count() == 4
    path = page.locator(".force-plots .series").first.get_attribute("d")
    assert [len(part.split("L")) for part in path.split("M")[1:]] == [low, 360 - high]


def test_a_block_that_does_not_fit_a_design_is_told_so(studio):
    page = studio.page
    block = {**BLOCK, "point_masses": [{"joint": "Z", "mass": 1.0}]}
    studio_steps.solved(studio, {**PLAIN, "dynamics": block}, shown=".moving .live .link")
    page.click("#tab-plots")
    page.wait_for_selector(".borne .error")
    assert "/dynamics/point_masses/0/joint: no joint of the mechanism" in page.inner_text(".borne .error")


def test_a_load_is_stated_on_the_drawing_and_a_fault_is_told_at_its_field(open_studio, server):
    studio = open_studio(reduced_motion="reduce")
    page = studio.page
    studio_steps.solved(studio, PLAIN, shown=".moving .live .link")
    page.click("#tab-plots")
    page.locator("#forces summary").first.press("Enter")
    assert "states no masses and loads" in page.inner_text(".borne")
    assert page.locator(".peaks").count() == 0, "nothing is shown that nobody has stated"
    for path, value in {"speed_rpm": 60, "links/density": 7800, "links/thickness": 10, "links/width": 2}.items():
        page.fill(f'[data-path="/dynamics/{path}"]', str(value))
    block = {
        "gravity": {"magnitude": 9.80665, "angle": 270.0},
        "speed_rpm": 60.0,
        "links": STEEL,
        "point_masses": [],
        "loads": [],
    }

    def torques():
        page.wait_for_selector(".moving .force")
        lead(page, PLACE)
        told = forces_of(studio, server, {"dynamics": block})["dynamics"]["drive"][PLACE]
        until(lambda: number(page.inner_text(".drive-now output")) == pytest.approx(told, rel=6e-3), what="the torque")
        return told

    page.press('[data-path="/dynamics/speed_rpm"]', "Enter")
    bare = torques()

    # A force where the drawing is clicked, and a mass at a joint from the list.
    page.click("text=Add a force")
    pins = page.locator(".moving .live .pin")
    joints = page.locator(".moving .live text").all_text_contents()
    pins.nth(joints.index("B")).scroll_into_view_if_needed()
    box = pins.nth(joints.index("B")).bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2 + 3, box["y"] + box["height"] / 2)
    assert page.input_value('[data-path="/dynamics/loads/0/joint"]') == "B"
    assert page.locator('.load-editor [aria-pressed="true"]').count() == 0
    page.fill('[data-path="/dynamics/loads/0/force/constant/1"]', "-50")
    page.click("text=Add a point mass")
    page.select_option('[data-path="/dynamics/point_masses/0/joint"]', "A")
    page.fill('[data-path="/dynamics/point_masses/0/mass"]', "0.5")
    page.click("text=Add a torque")
    page.select_option('[data-path="/dynamics/loads/1/link"]', "output")
    page.fill('[data-path="/dynamics/loads/1/torque/constant"]', "1.5")
    block["loads"] = [
        {"joint": "B", "force": {"constant": [0.0, -50.0]}},
        {"link": "output", "torque": {"constant": 1.5}},
    ]
    block["point_masses"] = [{"joint": "A", "mass": 0.5}]
    page.click("text=Show the forces")
    loaded = torques()
    assert abs(loaded - bare) > 0.1 * abs(bare)

    # What is wrong is said at its field, in words: what a field holds first, and what fields want of one another then.
    page.fill('[data-path="/dynamics/point_masses/0/mass"]', "-1")
    page.fill('[data-path="/dynamics/links/thickness"]', "")
    page.click("text=Show the forces")
    page.wait_for_selector('[data-path="/dynamics/point_masses/0/mass"][aria-invalid="true"]')
    mass = page.locator(".field", has=page.locator('> [data-path="/dynamics/point_masses/0/mass"]'))
    assert "at least 0" in mass.locator("> .error").inner_text()
    page.fill('[data-path="/dynamics/point_masses/0/mass"]', "0.5")
    page.click("text=Show the forces")
    page.wait_for_selector('[data-path="/dynamics/links"][aria-invalid="true"]')
    assert "needs a thickness" in page.inner_text('[data-path="/dynamics/links"] > .error')
    assert "the earlier masses and loads" in page.inner_text(".load-editor")
    page.set_viewport_size({"width": 390, "height": 844})
    assert page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth") <= 0
    assert violations(page) == []
    assert [text for text in studio.wrong if "422" not in text] == []
    studio.wrong.clear()
    studio.screen("forces-stated")


QUICK_RETURN = {
    "kind": "quick_return",
    "mechanism": "crank_shaper",
    "time_ratio": 1.25,
    "stroke": 45.0,
    "max_designs": 1,
}
PUSHED = {**PLAIN, "input_side": {"dyad": "PR"}, "output_side": {}, "max_designs": 1}
"""Driven by a slide."""


def test_the_line_of_a_slide_pushes_its_pin_as_the_pin_pushes_its_link(open_studio, server):
    studio = open_studio(reduced_motion="reduce")
    page = studio.page
    solved(studio, {**QUICK_RETURN, "dynamics": {"links": STEEL, "speed_rpm": 600.0}})
    told = forces_of(studio, server)["dynamics"]
    for place in (PLACE, 3 * PLACE):
        lead(page, place)
        per_newton, found = arrows(page)
        lines = {joint: force for (joint, on), (_, force) in found.items() if on == f"pin {joint}"}
        assert set(lines) == {one["joint"] for one in told["slides"]} == {"A", "D"}
        for joint, force in lines.items():
            # Without mass a pin hands on what the line does to it; the rocker's line turns, and so does the force.
            (other,) = [force for (at, on), (_, force) in found.items() if at == joint and on != f"pin {joint}"]
            assert force == pytest.approx(other, abs=0.05 / per_newton)
        assert math.hypot(*lines["A"]) * per_newton > 10.0, "an arrow that can be seen"


def test_a_slide_that_drives_has_a_force_over_its_place(open_studio, server):
    studio = open_studio(reduced_motion="reduce")
    page = studio.page
    studio_steps.solved(studio, {**PUSHED, "dynamics": {"links": STEEL, "speed": 500.0}}, shown=".moving .live .link")
    page.wait_for_selector(".moving .force", state="attached")
    extremes = forces_of(studio, server)["dynamics"]["extremes"]["drive"]
    page.click("#tab-plots")
    page.focus("#scrub")
    # The design moves beyond what it was verified along; there it has no forces.
    page.keyboard.press("Home")
    assert "the range in which the design was verified" in page.inner_text(".drive-now .note")
    assert page.locator(".force:not([hidden])").count() == 0
    page.locator(".peaks button").first.click()
    assert number(page.inner_text(".drive-now output")) == pytest.approx(extremes["max"], rel=2e-2)
    assert page.inner_text(".drive-now output").endswith(" N")
    assert page.locator(".force:not([hidden])").count() > 0
    assert {text.split()[-1] for text in page.locator(".peaks button").all_inner_texts()} == {"mm"}
