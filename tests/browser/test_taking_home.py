"""Each kind of problem: stated in the page, solved, seen to move, and every file of it opened with another program."""

import ast
import csv
import io
import json
import re
import zipfile
from html.parser import HTMLParser
from xml.etree import ElementTree

import pytest
from ezdxf import recover
from PIL import Image, ImageChops

from service.parts.export.cad_available import is_installed
from synthesis.registry import KINDS
from tests.browser.numbers import told_as_answered
from tests.support.browser.layout import assert_in_view, inside, watch
from tests.support.browser.studio import drawn, stated, unfold, written
from tests.support.browser.taking_home import EXAMPLES, taken
from tests.support.service.running import until

pytestmark = pytest.mark.browser

# A field of each kind that is changed in the form: its path, what is typed or chosen, and what is stated then.
FIELDS = {
    "motion": ("constraints/min_transmission_angle", "15", 15),
    "path": ("constraints/max_link_ratio", "40", 40),
    "quick_return": ("max_designs", "2", 2),
    "straight_line": ("length", "90", 90),
    "steering": ("lock", "38", 38),
    "dwell": ("output/swing", "48", 48),
    "parallel_motion": ("max_designs", "2", 2),
    "gear_train": ("teeth/max", "90", 90),
    "planetary_train": ("mesh_efficiency", "0.97", 0.97),
    "train_series": ("ratio", "24", 24),
    "gearbox": ("module", "2.5", 2.5),
    "layshaft_gearbox": ("ratios", "3.4, 2.2, 1.5, 1", [3.4, 2.2, 1.5, 1]),
    "function": ("input_range", "85", 85),
    "cam": ("follower/roller_radius", "9", 9),
    "balancing": ("rpm", "900", 900),
    "spring_balancing": ("motion/to", "70", 70),
    "flywheel": ("coefficient", "0.06", 0.06),
    "engine": ("stroke", "74", 74),
    "indexing": ("roller_diameter", "11", 11),
}

DESKTOP = {"width": 1440, "height": 900}

# What has no motion over a cycle: of several speeds one is engaged at a time, and shafts just turn.
STILL = {"gearbox", "layshaft_gearbox", "balancing", "flywheel", "engine"}


def reveal(page, path):
    """Open the groups above a field."""
    unfold(page)
    parts = path.split("/")
    for k in range(1, len(parts)):
        group = page.locator(f'details[data-path="/problem/{"/".join(parts[:k])}"]')
        if group.count():
            group.evaluate("one => { one.open = true; }")
            unfold(page)
            page.wait_for_selector(f'[data-path="/problem/{"/".join(parts[: k + 1])}"]')


def value_at(problem, path):
    for part in path.split("/"):
        problem = problem[int(part)] if isinstance(problem, list) else problem[part]
    return problem


def picture_now(page):
    return page.locator(".moving svg").first.inner_html()


class Words(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.words, self.tags = [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)

    def handle_data(self, data):
        self.words.append(data)


def check_svg(path, job):
    root = ElementTree.parse(path).getroot()
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert len(list(root.iter())) > 20
    assert float(root.get("width")) > 100.0


def check_dxf(path, job):
    document, auditor = recover.readfile(path)
    assert not auditor.has_errors
    assert not auditor.has_fixes
    assert document.units == 4, "millimetres"
    kinds = {entity.dxftype() for entity in document.modelspace()}
    assert "CIRCLE" in kinds or "LWPOLYLINE" in kinds
    assert len(document.modelspace()) > 3


def check_csv(path, job):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    rows = list(csv.reader(io.StringIO("\n".join(lines))))
    assert len(rows) > 1
    assert len({len(row) for row in rows}) == 1
    assert len(rows[0]) == len(set(rows[0]))


def check_gif(path, job):
    with Image.open(path) as gif:
        assert gif.n_frames >= 30
        first = gif.convert("RGB")
        gif.seek(gif.n_frames // 3)
        assert ImageChops.difference(first, gif.convert("RGB")).getbbox(), "its frames differ"


def check_png(path, job):
    with Image.open(path) as picture:
        assert picture.format == "PNG"
        assert picture.width >= 1600
        assert len(picture.convert("RGB").getcolors(1 << 22)) > 20, "more than an empty sheet"


def check_json(path, job):
    content = json.loads(path.read_text())
    assert KINDS[content["problem"]["kind"]].problem.model_validate(content["problem"])
    assert KINDS[content["problem"]["kind"]].result.model_validate(content["result"]).designs


def check_report(path, job):
    page = Words(path.read_text(encoding="utf-8"))
    text = " ".join(page.words)
    assert job in text
    assert page.tags.count("figure") >= 1
    assert "script" not in page.tags
    assert all(heading in text for heading in ("Answer", "Problem", "Search", "Checks", "Dimensions"))


def check_mujoco(path, job):
    root = ElementTree.parse(path).getroot()
    assert root.tag == "mujoco"
    assert root.find("equality/joint[@name='drive']") is not None


def check_urdf(path, job):
    assert ElementTree.parse(path).getroot().tag == "robot"


def check_modelica(path, job):
    assert path.read_text().rstrip().endswith("end Machine;")


def check_script(path, job):
    names = [node.targets[0].id for node in ast.parse(path.read_text()).body if isinstance(node, ast.Assign)]
    assert {"MODEL", "MOTION"} <= set(names)


SIMULATIONS = {"mjcf": "MuJoCo", "urdf": "URDF", "mo": "Modelica", "sim.py": "Simulation"}
CHECKS = {
    "MuJoCo": check_mujoco, "URDF": check_urdf, "Modelica": check_modelica, "Simulation": check_script,
    "SVG": check_svg, "DXF": check_dxf, "CSV": check_csv, "GIF": check_gif,
    "PNG": check_png, "JSON": check_json, "Report": check_report,
}  # fmt: skip


@pytest.mark.timeout(300)
@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_is_stated_solved_moves_and_is_taken_home(studio, kind):
    page = studio.page
    page.set_viewport_size(DESKTOP)
    page.select_option("#kind", kind)
    page.select_option("#example", str(EXAMPLES.get(kind, 0)))
    inside(page, "#solve")
    path, typed, value = FIELDS[kind]
    reveal(page, path)
    page.fill(f'[data-path="/problem/{path}"]', typed)
    assert value_at(stated(page), path) == value
    watch(page)
    # The statement is sent by the key that ends every form.
    page.press(f'[data-path="/problem/{path}"]', "Enter")
    studio.answered()
    assert_in_view(page)
    assert page.locator(".card .good").count() >= 1
    until(lambda: drawn(page), 90, "the drawing")
    assert not re.search(r"\b(null|undefined|NaN)\b", written(page))
    # Counts have their digits in groups.
    told = page.inner_text("#answers .known")
    assert not re.search(r"(?<![\d.])\d{5}|\d,\d{3}", told), told
    if kind not in STILL:
        page.wait_for_selector(".moving svg")
        before = picture_now(page)
        until(lambda: picture_now(page) != before, 30, "another frame")
    # What plays is drawn without end, which takes most of the processor; everything else is looked at standing still.
    player = page.locator(".moving .player button").first
    if player.inner_text() == "Pause":
        player.click()
    studio.screen(f"kind-{kind}")
    told_as_answered(page, kind)
    job = page.url.rpartition("=")[2]
    design = json.loads(taken(page, "JSON").read_text())["result"]["designs"][0]
    offered = [one.inner_text() for one in page.locator("#downloads button").all()]
    told = page.evaluate("() => fetch('/v1/problems').then((answer) => answer.json())")
    linkage = "skeleton" in design["mechanism"]
    parts = ["Parts", "Printed parts"] if linkage or design["mechanism"]["type"] in told["parts"] else []
    parts += ["PMKS+"] if linkage else []
    forms = next(one for one in told["problems"] if one["kind"] == kind)["files"][design["mechanism"]["type"]]
    files = [*(SIMULATIONS.get(form, form.upper()) for form in forms), "PNG", "JSON"]
    assert offered == [*files, *parts, "Report"]
    for name in [*files, "Report"]:
        CHECKS[name](taken(page, name), job)
    assert page.locator("#downloads .error").inner_text() == ""


def test_the_report_opens_in_a_page_of_its_own_and_looks_as_it_should(studio):
    page = studio.page
    page.select_option("#kind", "gear_train")
    studio.solve()
    page.click("#tab-files")
    with studio.context.expect_page() as opening:
        page.get_by_role("link", name="Open the report").click()
    report = opening.value
    report.on("console", lambda said: studio.wrong.append(said.text) if said.type in ("error", "warning") else None)
    report.reload()
    report.wait_for_selector("figure svg")
    assert report.evaluate("getComputedStyle(document.querySelector('h2')).borderBottomStyle") == "solid", "its style"
    assert report.evaluate("document.querySelectorAll('script').length") == 0
    wider = report.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert wider <= 0
    studio.screen("report", report)
    report.emulate_media(media="print")
    pages = report.pdf(format="A4").count(b"/Type /Page\n")
    designs = report.locator("section.design").count()
    assert pages >= 1 + designs, "each design on a page of its own"


def test_parts_are_taken_home_and_printed_ones_where_solids_are_made(studio):
    page = studio.page
    page.select_option("#kind", "motion")
    page.select_option("#example", "3")
    studio.solve()
    with zipfile.ZipFile(taken(page, "Parts")) as archive:
        assert {"bom.csv", "assembly.svg", "dxf/base.dxf"} <= set(archive.namelist())
    printed = page.locator("#downloads").get_by_role("button", name="Printed parts", exact=True)
    assert printed.is_enabled() == is_installed()
    assert ("without its extra cad" in printed.get_attribute("title")) != is_installed()


def test_what_leaves_no_room_for_parts_is_said_beside_the_button(studio):
    page = studio.page
    page.select_option("#kind", "parallel_motion")
    studio.solve()
    # The last design is one that cannot be arranged in planes.
    page.locator(".card").last.click()
    page.click("#tab-files")
    page.locator("#downloads").get_by_role("button", name="Parts", exact=True).click()
    said = page.locator("#downloads .error")
    until(lambda: "wide do not fit" in said.inner_text(), 90, "the reason")
    assert [text for text in studio.wrong if "409" not in text] == []
    studio.wrong.clear()


def test_no_file_is_offered_that_there_is_not(studio):
    page = studio.page
    page.select_option("#kind", "flywheel")
    studio.solve()
    page.click("#tab-files")
    offered = page.locator("#downloads").get_by_role("button", name="DXF", exact=True)
    offered.first.wait_for()
    assert page.locator("#downloads").get_by_role("button", name="GIF", exact=True).count() == 0
