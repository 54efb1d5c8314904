"""Cams under their followers and gears in mesh, turning as the analyses say."""

import math
import re

import pytest

from synthesis.registry import list_examples
from tests.support.browser.motion_view import motion_of, number
from tests.support.browser.studio import solved
from tests.support.service.running import until

pytestmark = pytest.mark.browser

ARM = {
    "kind": "cam",
    "segments": [
        {"motion": "rise", "angle": 120, "lift": 20, "law": "cycloidal"},
        {"motion": "dwell", "angle": 60},
        {"motion": "return", "angle": 180, "law": "cycloidal"},
    ],
    "rotation": "cw",
}
FOLLOWERS = {
    "translating_roller": list_examples("cam")[0],
    "oscillating_roller": {
        **ARM,
        "follower": {"type": "oscillating_roller", "roller_radius": 8, "arm": 80, "pivot_distance": 100},
    },
    "translating_flat": list_examples("cam")[3],
    "oscillating_flat": {**ARM, "follower": {"type": "oscillating_flat", "pivot_distance": 100, "face_offset": 5}},
}


def scrub(page, to):
    page.locator("#scrub").evaluate(
        "(slider, to) => { slider.value = to; slider.dispatchEvent(new Event('input')); }", to
    )


def centre(page, selector):
    return float(page.get_attribute(selector, "cx")), float(page.get_attribute(selector, "cy"))


def placed(page, selector, n=0):
    """Translation, and turn in degrees (counter-clockwise, as the eye sees it), of a drawn part."""
    transform = page.locator(selector).nth(n).get_attribute("transform")
    u, v, turn = map(float, re.match(r"translate\(([-\d.]+) ([-\d.]+)\) rotate\(([-\d.]+)\)", transform).groups())
    return u, v, -turn


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_the_follower_touches_the_turning_cam(studio, server, kind):
    page = studio.page
    solved(studio, FOLLOWERS[kind])
    motion = motion_of(studio, server, steps=360)
    near = """([u, v]) => {
        const path = document.querySelector(".cam .profile");
        const to = path.getCTM().inverse().multiply(document.querySelector(".touch").getCTM());
        const at = new DOMPoint(u, v).matrixTransform(to);
        let least = Infinity;
        for (let s = 0, end = path.getTotalLength(); s < end; s += 0.5) {
          const there = path.getPointAtLength(s);
          least = Math.min(least, Math.hypot(there.x - at.x, there.y - at.y));
        }
        return least;
      }"""
    for degrees in (0, 37, 100, 215, 300):
        scrub(page, degrees)
        touch = centre(page, ".touch")
        assert page.evaluate(near, touch) < 1.0, "on the profile, pixels"
        if kind.endswith("roller"):
            u, v, _ = placed(page, ".roller")
            assert math.dist((u, v), touch) == pytest.approx(float(page.get_attribute(".tyre", "r")), abs=0.5)
        reading = page.inner_text(".beside .facts dd")
        assert reading.endswith(" mm" if kind.startswith("translating") else "°")
        told = number(reading.removesuffix(" mm"))
        assert told == pytest.approx(motion["follower"]["position"][degrees], rel=2e-3, abs=0.02)
        if kind != "translating_flat":
            shown = number(page.inner_text(".gauge .reading"))
            assert shown == pytest.approx(motion["pressure_angle"][degrees], abs=0.06)
    studio.screen(f"cam-{kind}")


def test_the_roller_rolls_without_slip(studio, server):
    """In a dwell a roller turns back by R/r of what the cam turns."""
    page = studio.page
    solved(studio, FOLLOWERS["translating_roller"])
    mechanism = server.job(re.search(r"#job=(\w+)", page.url).group(1))["result"]["designs"][0]["mechanism"]
    roller = mechanism["follower"]["roller_radius"]
    ratio = (mechanism["prime_radius"] - roller) / roller
    scrub(page, 10)
    before = placed(page, ".roller")[2]
    scrub(page, 50)
    assert placed(page, ".roller")[2] - before == pytest.approx(-40.0 * ratio, rel=2e-3)


def test_the_diagrams_have_their_marks_and_lead(studio, server):
    page = studio.page
    solved(studio, FOLLOWERS["translating_roller"])
    page.click("#tab-plots")
    names = page.locator(".plot figcaption").all_inner_texts()
    assert [name.split()[0] for name in names] == ["Displacement", "Velocity", "Acceleration", "Jerk", "Pressure"]
    job = server.job(re.search(r"#job=(\w+)", page.url).group(1))
    program = job["result"]["designs"][0]["mechanism"]["program"]
    scrub(page, 130)
    at = program["angle"].index(130.0)
    for n, name in enumerate("sva"):
        reading = number(page.locator(".plot .reading").nth(n).inner_text())
        assert reading == pytest.approx(program[name][at], rel=6e-3, abs=1e-3)
    box = page.locator(".plot svg").first.bounding_box()
    page.mouse.click(box["x"] + (58 + 0.25 * 232) / 300 * box["width"], box["y"] + 20)
    assert float(page.input_value("#scrub")) == pytest.approx(90, abs=2)


def test_a_barrels_roller_stays_in_its_groove(studio, server):
    page = studio.page
    solved(studio, list_examples("cam")[4])
    heights = []
    for degrees in (0, 75, 165, 250):
        scrub(page, degrees)
        heights.append(float(page.locator("circle.tyre").get_attribute("cy")))
    assert heights[0] > heights[1] > heights[2], "up is up"
    assert heights[3] > heights[2]
    studio.screen("cam-barrel")


@pytest.mark.parametrize(
    ("kind", "n"),
    [
        ("gear_train", 0),
        ("gear_train", 1),
        ("planetary_train", 0),
        ("train_series", 2),
        ("gearbox", 0),
        ("layshaft_gearbox", 0),
    ],
)
def test_gears_turn_at_their_speeds(studio, server, kind, n):
    page = studio.page
    solved(studio, list_examples(kind)[n])
    motion = motion_of(studio, server, steps=360)
    wheels = page.locator(".wheel:not(.idle)")
    names = [name.split(":")[0] for name in wheels.locator("title").all_text_contents()]
    scrub(page, 0)
    before = [placed(page, ".wheel:not(.idle)", k) for k in range(len(names))]
    scrub(page, 20)
    after = [placed(page, ".wheel:not(.idle)", k) for k in range(len(names))]
    turned = {name: (b[2] - a[2]) / 20.0 for name, a, b in zip(names, before, after, strict=True)}
    if kind == "gear_train":
        expected = {f"Stage {gear['stage']} {gear['role']}": gear["speed_ratio"] for gear in motion["gears"]}
    elif kind == "planetary_train":
        speeds = {body["name"]: body["speed"] for body in motion["bodies"]}
        expected = {name: speeds[name.split()[0]] for name in names}
        places = {name: b[:2] for name, b in zip(names, after, strict=True)}
        there = dict(zip(names, before, strict=True))["planet 1"]
        axis = places["sun"]
        angle = [math.atan2(-(p[1] - axis[1]), p[0] - axis[0]) for p in (there, places["planet 1"])]
        assert math.degrees(angle[1] - angle[0]) == pytest.approx(20.0 * speeds["carrier"], abs=0.05)
    elif kind == "train_series":
        shafts = [shaft["speed_ratio"] for shaft in motion["shafts"]]
        expected = {}
        for n, (share, unit) in enumerate(zip(shafts[:-1], motion["units"], strict=True), 1):
            for gear in unit.get("gears", []):
                expected[f"Unit {n}, Stage {gear['stage']} {gear['role']}"] = share * gear["speed_ratio"]
            speeds = {body["name"]: body["speed"] for body in unit.get("bodies", [])}
            own = [name for name in names if speeds and name.startswith(f"Unit {n}, ")]
            expected |= {name: share * speeds[name.split()[2]] for name in own}
    else:
        ratios = [shaft["speed_ratio"] for shaft in motion["shafts"]]
        assert {round(x, 3) for x in turned.values()} == {round(x, 3) for x in ratios}
        return
    assert turned == pytest.approx(expected, abs=1e-3)
    studio.screen(f"gears-{kind}-{n}")


def test_meshing_gears_have_teeth_in_spaces(studio):
    """Between two gears that mesh the tooth of one stands where the other has a space."""
    page = studio.page
    solved(studio, list_examples("gear_train")[0])
    for at in (0, 7, 133):
        scrub(page, at)
        one, other = placed(page, ".wheel", 0), placed(page, ".wheel", 1)
        phase = (0.0 - one[2]) / (360.0 / 25) % 1.0
        facing = (180.0 - other[2]) / (360.0 / 51) % 1.0
        # Seen from both centres the contact lies as far from a tooth of one as from a space of the other.
        assert (phase + facing) % 1.0 == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize(("kind", "least"), [("gearbox", 6), ("layshaft_gearbox", 5)])
def test_another_gear_is_engaged(studio, kind, least):
    page = studio.page
    solved(studio, list_examples(kind)[0])
    assert page.locator("#engaged option").count() == least
    before = page.inner_text(".speeds")
    page.select_option("#engaged", "1")
    until(lambda: page.inner_text(".speeds") != before, what="other speeds")
    chosen = page.locator("#engaged option").nth(1).inner_text()
    output = page.locator(".speeds dd").last.inner_text()
    assert number(output.split()[0]) == pytest.approx(number(chosen.split(": ")[1].split()[0]), rel=1e-3)
    studio.screen(f"engaged-{kind}")


@pytest.mark.parametrize("arrangement", ["stepped", "ravigneaux", "double_planet", "two_stage", "bevel_differential"])
def test_every_planetary_arrangement_is_drawn(studio, arrangement):
    page = studio.page
    ratio = {"bevel_differential": 2.0, "ravigneaux": 2.5, "two_stage": 12.0}.get(arrangement, 5.0)
    problem = {"kind": "planetary_train", "ratio": ratio, "arrangement": arrangement, "tolerance": 0.2}
    solved(studio, problem)
    if "Complete: no design" in page.inner_text("#result"):
        pytest.fail("the problem of this test has no design")
    assert page.locator(".wheel").count() >= 3
    assert "NaN" not in page.locator(".moving").inner_html()
    studio.screen(f"planetary-{arrangement}")
