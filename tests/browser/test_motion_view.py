"""A design that moves: both circuits, toggles, the gauge of transmission, plots that lead the motion, cognates."""

import math
import re

import pytest

from synthesis.registry import list_examples
from tests.support.browser import studio as studio_steps
from tests.support.browser.motion_view import motion_of, number, solved
from tests.support.browser.studio import PLAIN
from tests.support.service.running import until

pytestmark = pytest.mark.browser

TIMED = list_examples("path")[1]
"""A crank-rocker through five points; its right cognate is one too, with the same crank angles."""


NUMBER = r"−?[\d.]+(?:·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?"


def curve(page, selector):
    return [
        [float(x) for x in pair] for pair in re.findall(r"([-\d.]+) ([-\d.]+)", page.get_attribute(selector, "d") or "")
    ]


def test_the_other_circuit_is_drawn_faint_and_goes_with_the_crank(studio, server):
    page = studio.page
    solved(studio, TIMED)
    assert "moves on circuit 1 of 2" in page.inner_text(".beside")
    own, other = curve(page, ".moving > .stage .canvas > .curve"), curve(page, ".others .curve.other")
    assert len(own) > 100
    assert len(other) > 100
    assert min(math.dist(own[0], place) for place in other) > 5.0, "another curve"
    ghost = page.locator(".others .faint .link").first
    before, standing = ghost.get_attribute("d"), page.get_attribute(".live .joined", "transform")
    for _ in range(5):
        page.keyboard.press("PageUp")
    assert ghost.get_attribute("d") != before
    # Both circuits have the same crank.
    assert ghost.get_attribute("d") == page.locator(".live .link").first.get_attribute("d")
    assert page.get_attribute(".live .joined", "transform") == standing, "the fixed pivot stands"
    page.uncheck("#circuits")
    assert not page.locator(".others").is_visible()


@pytest.mark.parametrize("problem", [TIMED, list_examples("dwell")[1]], ids=["path", "dwell"])
@pytest.mark.parametrize("width", [390, 1360])
def test_nothing_below_moves_while_the_motion_plays(studio, problem, width):
    """Numbers grow and shrink; a button below that moved under the hand would be missed."""
    page = studio.page
    page.set_viewport_size({"width": width, "height": 900})
    solved(studio, problem)
    until(lambda: studio_steps.drawn(page), 90, "the drawing")
    places = page.evaluate("""async () => {
      const below = ["#scrub", "#solve", ".player button", ".columns", ".checks li:last-child", ".plot:last-child svg"];
      const places = Object.fromEntries(below.map(one => [one, new Set()]));
      for (const tab of ["numbers", "plots"]) {
        document.querySelector(`#tab-${tab}`).click();
        for (let left = 120; left > 0; left--) {
          await new Promise(requestAnimationFrame);
          for (const one of below) {
            const found = [...document.querySelectorAll(one)].at(-1).getBoundingClientRect();
            if (found.height) places[one].add(`${found.left} ${found.top}`);
          }
        }
      }
      return Object.fromEntries(below.map(one => [one, [...places[one]]]));
    }""")
    assert all(len(found) == 1 for found in places.values()), places


def test_a_rocker_shows_its_toggles(studio, server):
    page = studio.page
    solved(studio, list_examples("function")[1])
    motion = motion_of(studio, server)
    assert page.locator(".stop").count() == len(motion["toggles"]) > 0
    assert page.locator(".faint.toggle").count() == 2, "the linkage at both ends of its branch"
    title = page.locator(".stop title").first.text_content()
    assert str(round(motion["toggles"][0], 1)).rstrip("0").rstrip(".") in title


def test_the_gauge_and_the_plots_say_what_the_analysis_says(studio, server):
    page = studio.page
    solved(studio, PLAIN)
    motion = motion_of(studio, server)
    for _ in range(3):
        page.keyboard.press("PageUp")
    assert float(page.input_value("#scrub")) == 30
    expected = motion["transmission_angle"][30]
    assert number(page.inner_text(".gauge .reading")) == pytest.approx(expected, abs=0.05)
    plotted = page.locator(".plot", has_text="Transmission angle").locator(".reading")
    assert number(plotted.inner_text()) == pytest.approx(expected, rel=5e-3)
    page.click("#tab-plots")
    page.select_option("#part", "link output")
    for title, series in (("Angle of output", "angle"), ("Angular velocity", "omega"), ("Angular accel", "alpha")):
        reading = page.locator(".plot", has_text=title).locator(".reading").inner_text()
        assert number(reading) == pytest.approx(motion["links"]["output"][series][30], rel=5e-3, abs=1e-3)


def test_a_click_in_a_plot_leads_the_motion(studio):
    page = studio.page
    solved(studio, PLAIN)
    page.click("#tab-plots")
    picture = page.locator(".plot svg").nth(1)
    picture.scroll_into_view_if_needed()
    box = picture.bounding_box()
    # The plot's own edges: 58 of 300 at the left, 10 at the right.
    middle = (58 + 0.5 * 232) / 300 * box["width"]
    page.mouse.click(box["x"] + middle, box["y"] + box["height"] / 2)
    assert float(page.input_value("#scrub")) == pytest.approx(120, abs=1.5)
    marks = page.locator(".plot .mark").evaluate_all("marks => marks.map(one => one.getAttribute('transform'))")
    assert len(set(marks)) == 1, "all plots stand at the same input"
    assert page.inner_text(".player button") == "Play", "it stands still"


def test_a_peak_that_is_cut_is_marked_and_told(studio, server):
    """Towards a toggle rates grow beyond all bounds."""
    page = studio.page
    solved(studio, list_examples("function")[1])
    page.click("#tab-plots")
    page.select_option("#part", "link output")
    motion = motion_of(studio, server)
    known = [one for one in motion["links"]["output"]["alpha"] if one is not None]
    plot = page.locator(".plot", has_text="Angular accel")
    button = plot.locator(".cut")
    told = [number(one) for one in re.findall(NUMBER, button.inner_text())]
    assert told
    for value in told:
        assert min(abs(value / extreme - 1.0) for extreme in (min(known), max(known))) < 6e-3
    assert plot.locator(".beyond-mark").count() >= len(told)
    ticks = [number(one) for one in plot.locator(".tick").all_text_contents()[:2]]
    assert max(map(abs, ticks)) < max(map(abs, known))
    page.focus("#scrub")
    page.keyboard.press("PageUp")
    reading = plot.locator(".reading").inner_text()
    button.click()
    ticks = [number(one) for one in plot.locator(".tick").all_text_contents()[:2]]
    # What is a millionth of the range is nothing.
    assert ticks == pytest.approx([min(known), max(known)], rel=6e-3, abs=1e-6 * (max(known) - min(known)))
    assert plot.locator(".beyond-mark").count() == 0
    assert plot.locator(".reading").inner_text() == reading
    before = plot.locator(".mark").get_attribute("transform")
    page.keyboard.press("Escape")
    page.focus("#scrub")
    page.keyboard.press("PageUp")
    assert plot.locator(".mark").get_attribute("transform") != before, "it goes on with the motion"


@pytest.mark.parametrize(
    ("kind", "n", "title"), [("function", 1, "Structural error"), ("steering", 0, "Steering error")]
)
def test_the_error_of_a_function_is_plotted_over_its_range(studio, server, kind, n, title):
    page = studio.page
    solved(studio, list_examples(kind)[n])
    line = page.locator(".plot", has_text=title).locator(".series").get_attribute("d")
    xs = [float(x) for x in re.findall(r"[ML]([\d.]+) ", line)]
    motion = motion_of(studio, server)
    inside = (max(xs) - min(xs)) / 244.0
    job = server.job(re.search(r"#job=(\w+)", page.url).group(1))
    design = job["result"]["designs"][0]
    angles = [target["input_angle"] for target in design["targets"]]
    share = (max(angles) - min(angles)) / (motion["input_angle"][-1] - motion["input_angle"][0])
    assert inside == pytest.approx(share, abs=0.02)


def test_cognates_are_switched_in_place(studio):
    page = studio.page
    solved(studio, TIMED)
    pivot = page.locator(".live g:has(> .ground)").first
    own, before = curve(page, ".canvas > .curve"), pivot.get_attribute("transform")
    page.get_by_label("Right cognate").check()
    until(lambda: pivot.get_attribute("transform") != before, what="other pivots")
    traced = curve(page, ".canvas > .curve")
    assert len(traced) == len(own)
    assert max(math.dist(one, other) for one, other in zip(own, traced, strict=True)) < 0.3, "pixels"
    assert "keeps the crank angles" in page.inner_text("#cognates")
    studio.screen("cognate")
    page.get_by_label("Left cognate").check()
    until(lambda: "other crank angles" in page.inner_text("#cognates"), what="its note")
    left = curve(page, ".canvas > .curve")
    away = [min(math.dist(one, other) for other in own) for one in left]
    assert max(away) < 6.0, "the samples lie elsewhere on the same curve"
    page.check("#cognate-0")
    assert curve(page, ".canvas > .curve") == own


def least_transmission(lengths):
    """Of a crank-rocker over a turn, degrees: the law of cosines at the two places of the crank along the ground."""
    crank, coupler, rocker, ground = (lengths[name] for name in ("input", "coupler", "output", "ground"))
    angles = [
        math.degrees(math.acos((coupler**2 + rocker**2 - base**2) / (2.0 * coupler * rocker)))
        for base in (ground - crank, ground + crank)
    ]
    return min(min(angle, 180.0 - angle) for angle in angles)


def test_every_number_beside_a_cognate_is_the_cognates_own(studio, server):
    page = studio.page
    solved(studio, TIMED)
    job = server.job(re.search(r"#job=(\w+)", page.url).group(1))
    design = job["result"]["designs"][0]
    cognate = next(each for each in design["cognates"] if each["side"] == "left")
    used, own = round(cognate["min_transmission_angle"], 1), round(design["metrics"]["min_transmission_angle"], 1)
    assert abs(used - own) > 5.0, "the test could not tell them apart"

    def gauge():
        return page.inner_text(".gauge").replace("\n", " ")

    def crank():
        return float(re.search(r"Links input\s+([\d.]+)", page.inner_text("#design")).group(1))

    checked = page.locator("#design .checks li").count()
    assert checked > 0
    assert f"minimum {own:g}°" in gauge()
    page.get_by_label("Left cognate").check()
    until(lambda: f"minimum {used:g}°" in gauge(), what="the cognate's own angle")
    assert crank() == pytest.approx(cognate["mechanism"]["links"]["input"], rel=1e-3)
    assert crank() != pytest.approx(design["mechanism"]["links"]["input"], rel=1e-3)
    assert page.locator("#design .checks li").count() == 0, "its checks are the design's"
    assert page.locator(".drawing img").count() == 0
    least = page.get_by_role("row", name="Min transmission angle").locator("td").first
    assert float(least.get_attribute("title").rstrip("°")) == cognate["min_transmission_angle"]
    assert float(least.inner_text().rstrip("°")) == float(f"{cognate['min_transmission_angle']:.3g}")
    page.get_by_label("Right cognate").check()
    page.click("#tab-explore")
    facts = page.locator("#explore .facts")
    right = next(each for each in design["cognates"] if each["side"] == "right")
    whole = least_transmission(right["mechanism"]["links"])
    until(lambda: re.search(r"Minimum transmission angle\s+[\d.]+°", facts.inner_text()), what="the explorer's answer")
    told = float(re.search(r"Minimum transmission angle\s+([\d.]+)°", facts.inner_text()).group(1))
    assert told == pytest.approx(whole, abs=0.1)
    page.click("#tab-numbers")
    page.check("#cognate-0")
    until(lambda: f"minimum {own:g}°" in gauge(), what="the design's angle again")
    assert page.locator("#design .checks li").count() == checked


@pytest.mark.parametrize(
    ("kind", "n", "kind_of_link"),
    [
        ("motion", 7, ".live .block"),
        ("motion", 8, ".others .curve.other"),
        ("quick_return", 1, ".live .block"),
        ("parallel_motion", 0, ".others .curve.other"),
        ("dwell", 1, ".live .block"),
        ("straight_line", 1, ".faint.toggle"),
    ],
)
def test_other_linkages_have_their_parts(studio, kind, n, kind_of_link):
    page = studio.page
    solved(studio, list_examples(kind)[n])
    assert page.locator(kind_of_link).count() >= 1
    assert page.locator(".gauge .reading").inner_text().endswith("°")
    links = page.locator(".live .link").evaluate_all("links => links.map(one => one.getAttribute('d'))")
    assert all(links), "every link is drawn"
    studio.screen(f"view-{kind}-{n}")


LINKS = """all => all.map(one => one.getAttribute("d").match(/-?[0-9.]+/g).map(Number))"""


def test_a_stephenson_ii_rests_on_the_page_while_its_crank_turns(studio):
    problem = {
        "kind": "dwell",
        "mechanism": "stephenson_2",
        "dwell_angle": 60,
        "output": {"type": "rocker", "swing": 45},
        "max_designs": 1,
    }
    solved(studio, problem)
    page = studio.page
    begin = page.locator(".moving .live .link").evaluate_all(LINKS)
    page.evaluate("""() => {
        const scrub = document.querySelector("#scrub");
        const { min, max } = scrub;
        scrub.value = Number(min) + (Number(max) - Number(min)) * 50 / 360;
        scrub.dispatchEvent(new Event("input", { bubbles: true }));
    }""")
    page.wait_for_timeout(300)
    later = page.locator(".moving .live .link").evaluate_all(LINKS)
    assert len(begin) == len(later) == 5
    moved = sorted(
        max(abs(a - b) for a, b in zip(one, other, strict=True)) for one, other in zip(begin, later, strict=True)
    )
    assert moved[0] < 0.5, "the output rests"
    assert moved[1] > 2.0, "all others move"
    studio.screen("dwell-stephenson-2")
