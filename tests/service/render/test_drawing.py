"""The drawing of a fourbar: what stands where, in words that can be read, whatever the size of the mechanism."""

from __future__ import annotations

import cmath
import math
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from kinematics.linkage.fourbar import CROSSED_ASSEMBLY, OPEN_ASSEMBLY, Fourbar, positions
from service.render import export_design
from service.render.linkage.fourbar import MAX_GHOSTS, MAX_TARGETS
from service.render.page.blocks import FONT_SIZE, CheckRow, make_checks
from service.render.page.svg import Box, clip_polygon, clip_polyline, estimate_text_width, format_number, truncate_text
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ANGLE
from synthesis.model.linkage.answer import LinkageDesign, LinkageMetrics, Target
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar

SVG = "{http://www.w3.org/2000/svg}"

PIXEL = 0.011
"""Coordinates are written to a hundredth of a pixel."""


def drawing(design: LinkageDesign, problem: MotionProblem, title: str) -> str:
    text = export_design(design, problem, title, "svg")
    assert isinstance(text, str)
    return text


def _polar(length: float, degrees: float) -> complex:
    return cmath.rect(length, math.radians(degrees))


def _case(
    linkage: Fourbar, angles: list[float], signs: list[int], unit: str = "mm"
) -> tuple[LinkageDesign, MotionProblem]:
    """A linkage, and the problem whose positions it reaches at these input angles (degrees) in these assemblies."""
    at = [positions(linkage, math.radians(t), s) for t, s in zip(angles, signs, strict=True)]
    assert all(bool(c.valid) for c in at)
    mechanism = build_fourbar(
        FourbarConfiguration(
            o2=complex(linkage.input_pivot),
            a=complex(at[0].a),
            b=complex(at[0].b),
            o4=complex(linkage.output_pivot),
            p=complex(at[0].p),
        )
    )
    problem = MotionProblem.model_validate(
        {
            "kind": "motion",
            "length_unit": unit,
            "positions": [
                {
                    "x": float(c.p.real),
                    "y": float(c.p.imag),
                    "angle": 25.0 + math.degrees(float(c.coupler_angle - at[0].coupler_angle)),
                }
                for c in at
            ],
        }
    )
    passed = len(set(signs)) == 1
    return LinkageDesign(
        mechanism=mechanism,
        targets=[
            Target(index=k, input_angle=t, residual=1e-15, point_residual=1e-13, angle_residual=1e-13)
            for k, t in enumerate(angles)
        ],
        verification=Verification(
            passed=passed,
            checks=[
                Check(name="reaches_targets", passed=True, value=1e-15, limit=1e-9),
                Check(name="same_branch", passed=passed),
                Check(name="transmission_angle", passed=True, value=41.23, limit=30.0, dimension=ANGLE),
            ],
        ),
        metrics=LinkageMetrics(
            grashof="rocker_rocker",
            barker="RRR1",
            min_transmission_angle=41.23,
            transmission_angles={"coupler": 41.23},
            same_branch=passed,
            visits_in_order=True,
            full_rotation=False,
            input_rotation=angles[-1] - angles[0],
            link_ratio=3.0,
            rms_residual=1e-15,
            size=100.0,
            quality=0.5,
        ),
    ), problem


def _norton_5_2(size: float = 1.0) -> tuple[LinkageDesign, MotionProblem]:
    """Norton, Example 5-2 (crossed)."""
    o2, o4 = complex(-1.233833828, -7.771417129) * size, complex(2.736718211, 0.3385457838) * size
    bare = Fourbar(o2, o4, 6.831999238 * size, 1.399320056 * size, 3.199669641 * size)
    first = positions(bare, math.radians(89.5412), CROSSED_ASSEMBLY)
    point = complex((0.0 - first.a) / cmath.exp(1j * float(first.coupler_angle)))
    linkage = Fourbar(o2, o4, bare.input, bare.coupler, bare.output, point)
    return _case(linkage, [89.5412, 71.84, 54.34], [CROSSED_ASSEMBLY] * 3, "in")


CASES = {
    "norton_5_2": lambda: _norton_5_2(),
    "crank_rocker": lambda: _case(
        Fourbar(0, 100 + 10j, 30, 90, 70, _polar(60, 40)), [30, 120, 200], [OPEN_ASSEMBLY] * 3
    ),
    "two_positions": lambda: _case(Fourbar(0, 10, 35, 30, 40, _polar(25, -70)), [0, 140], [OPEN_ASSEMBLY] * 2),
    "collinear": lambda: _case(Fourbar(0, 80, 40, 60, 55, 110), [40, 70, 100], [CROSSED_ASSEMBLY] * 3),
    "p_at_a": lambda: _case(Fourbar(0, 80, 40, 60, 55, 0), [40, 70, 100], [CROSSED_ASSEMBLY] * 3),
    "far_pivot": lambda: _case(
        Fourbar(0, 5e6 - 3e6j, 12, 30, 5830951.9, _polar(20, 30)), [60, 100, 160], [OPEN_ASSEMBLY] * 3
    ),
    "tiny_crank": lambda: _case(
        Fourbar(0, 1e-4, 2e-6, 9e-5, 6e-5, _polar(5e-5, 50)), [0, 90, 200], [OPEN_ASSEMBLY] * 3, "m"
    ),
    "small_task": lambda: _case(
        Fourbar(0, 1e3, 600, 900, 800, _polar(500, 40)), [60, 60.001, 60.002], [OPEN_ASSEMBLY] * 3
    ),
    "far_from_origin": lambda: _case(
        Fourbar(9e8, 9e8 + 80, 40, 60, 55, _polar(40, 50)), [40, 70, 100], [OPEN_ASSEMBLY] * 3
    ),
    "parallelogram": lambda: _case(Fourbar(0, 80, 40, 80, 40, 40 + 30j), [40, 70, 100], [OPEN_ASSEMBLY] * 3),
    "branch_defect": lambda: _case(
        Fourbar(0, 80, 50, 60, 45, _polar(40, 50)), [60, 85, 50], [OPEN_ASSEMBLY, OPEN_ASSEMBLY, CROSSED_ASSEMBLY]
    ),
}


@pytest.fixture(params=CASES)
def case(request: pytest.FixtureRequest) -> tuple[LinkageDesign, MotionProblem]:
    return CASES[request.param]()


def _parsed(design: LinkageDesign, problem: MotionProblem, title: str = "A design") -> ET.Element:
    return ET.fromstring(drawing(design, problem, title))


class _Main:
    """The main panel, read back through its own viewport."""

    def __init__(self, root: ET.Element) -> None:
        self.panel = next(e for e in root.iter(f"{SVG}svg") if e.get("data-view") == "main")
        self.scale = float(self.panel.attrib["data-scale"])
        self._centre, self._middle = (
            complex(*map(float, self.panel.attrib[f"data-{name}"].split())) for name in ("centre", "middle")
        )

    def back(self, x: float, y: float) -> complex:
        """Mechanism point of a sheet point."""
        return self._centre + (complex(x, y) - self._middle).conjugate() / self.scale

    def joints(self, configuration: int) -> dict[str, complex]:
        group = next(e for e in self.panel if e.get("data-configuration") == str(configuration))
        return {
            e.attrib["data-joint"]: self.back(float(e.attrib["cx"]), float(e.attrib["cy"]))
            for e in group
            if e.get("data-joint")
        }


def test_joints_stand_where_the_dimensions_say(case: tuple[LinkageDesign, MotionProblem]) -> None:
    design, problem = case
    main = _Main(_parsed(design, problem))
    near = PIXEL * math.sqrt(2.0) / main.scale
    drawn = main.joints(1)
    for name, point in design.mechanism.skeleton.joints.items():
        assert abs(drawn[name] - complex(*point)) < near, name
    o2, o4 = drawn["O2"], drawn["O4"]
    links = design.mechanism.links
    for k, target in enumerate(design.targets, 1):
        joints = main.joints(k)
        a, b, p = joints["A"], joints["B"], joints["P"]
        assert abs(abs(a - o2) - links.input) < 2 * near
        assert abs(abs(b - a) - links.coupler) < 2 * near
        assert abs(abs(b - o4) - links.output) < 2 * near
        assert abs(p - problem.positions[target.index].point) < near
        assert abs(a - o2 - _polar(links.input, target.input_angle)) < 2 * near


def test_every_demanded_position_is_drawn_at_its_point_and_angle(case: tuple[LinkageDesign, MotionProblem]) -> None:
    design, problem = case
    root = _parsed(design, problem)
    found = {e.attrib["data-target"]: e for e in root.iter() if "data-target" in e.attrib}
    assert sorted(found) == [str(k + 1) for k in range(len(problem.positions))]
    for k, position in enumerate(problem.positions):
        stroke = next(iter(found[str(k + 1)].iter(f"{SVG}line")))
        x1, y1, x2, y2 = (float(stroke.attrib[name]) for name in ("x1", "y1", "x2", "y2"))
        drawn = math.degrees(math.atan2(y1 - y2, x2 - x1))
        assert abs(math.remainder(drawn - position.angle, 360.0)) < 0.05
        ring = next(iter(found[str(k + 1)].iter(f"{SVG}circle")))
        assert (ring.attrib["cx"], ring.attrib["cy"]) == (stroke.attrib["x1"], stroke.attrib["y1"])


def test_the_body_line_lies_in_the_demanded_direction_when_it_is_met() -> None:
    root = _parsed(*CASES["branch_defect"]())
    for k in "123":
        body = next(e for e in root.iter() if e.get("data-body-line") == k)
        demanded = next(iter(next(e for e in root.iter() if e.get("data-target") == k).iter(f"{SVG}line")))
        directions = [
            math.atan2(float(e.attrib["y2"]) - float(e.attrib["y1"]), float(e.attrib["x2"]) - float(e.attrib["x1"]))
            for e in (body, demanded)
        ]
        assert directions[0] == pytest.approx(directions[1], abs=1e-3)


def test_labels_and_tables_say_what_it_is(case: tuple[LinkageDesign, MotionProblem]) -> None:
    design, problem = case
    root = _parsed(design, problem, "Gripper for jars")
    labels = {e.attrib["data-label"] for e in root.iter(f"{SVG}text") if "data-label" in e.attrib}
    assert {"O2", "O4", "A", "B", "P"} <= labels
    assert {str(k + 1) for k in range(len(problem.positions))} <= labels
    words = [" ".join(e.itertext()) for e in root.iter(f"{SVG}text")]
    assert "Gripper for jars" in words
    assert f"Dimensions ({problem.length_unit})" in words
    for needed in ("assembly", design.mechanism.assembly, "reference input angle", "41.23°  (limit 30°)"):
        assert needed in words
    marks = [e.attrib["data-passed"] for e in root.iter() if "data-passed" in e.attrib]
    assert marks == [str(check.passed).lower() for check in design.verification.checks]
    assert root.get("role") == "img"
    assert root.find(f"{SVG}title") is not None
    assert root.find(f"{SVG}desc") is not None


def test_lengths_are_written_to_six_digits_in_the_unit() -> None:
    words = [" ".join(e.itertext()) for e in _parsed(*_norton_5_2()).iter(f"{SVG}text")]
    for value in ("6.832", "1.39932", "3.19967", "9.02977", "(−1.23383, −7.77142)", "89.541°", "crossed"):
        assert value in words


def test_coordinates_far_from_the_origin_tell_the_pivots_apart() -> None:
    words = ["".join(e.itertext()) for e in _parsed(*CASES["far_from_origin"]()).iter(f"{SVG}text")]
    assert "(900000000, 0)" in words
    assert "(900000080, 0)" in words


def test_the_scale_bar_is_as_long_as_it_says(case: tuple[LinkageDesign, MotionProblem]) -> None:
    root = _parsed(*case)
    for panel in (e for e in root.iter(f"{SVG}svg") if "data-view" in e.attrib):
        bar = next(e for e in panel.iter() if "data-scale-bar" in e.attrib)
        cells = [e for e in bar.iter(f"{SVG}rect") if "stroke" in e.attrib]
        drawn = sum(float(cell.attrib["width"]) for cell in cells)
        assert drawn == pytest.approx(float(bar.attrib["data-scale-bar"]) * float(panel.attrib["data-scale"]), abs=0.05)


@pytest.mark.parametrize(
    ("title", "shown"),
    [
        ("<script>alert(1)</script>", "<script>alert(1)</script>"),
        ("\"quoted\" & 'single' ]]> <!-- x", "\"quoted\" & 'single' ]]> <!-- x"),
        ("nul\x00 bell\x07 esc\x1b\x9b \ud800\udfff\ufffe\uffff end", "nul bell esc end"),
        ("two\nlines\tand\r\nmore", "two lines and more"),
        ("turned \u202eround\u2066", "turned round"),
        ("连杆机构 ä ∠ 𝛼", "连杆机构 ä ∠ 𝛼"),
        ("\x00", "Fourbar linkage"),
    ],
)
def test_any_title_is_text_and_nothing_else(title: str, shown: str) -> None:
    document = drawing(*_norton_5_2(), title)
    document.encode()
    root = ET.fromstring(document)
    assert root.findtext(f"{SVG}title") == shown
    assert shown in ["".join(e.itertext()) for e in root.iter(f"{SVG}text")]
    assert {e.tag.removeprefix(SVG) for e in root.iter()} <= {
        *("svg", "title", "desc", "g", "rect", "text", "tspan", "line", "circle", "path", "polygon"),
    }


def test_a_long_title_is_cut_on_the_sheet_and_whole_in_the_description() -> None:
    title = "Lifting table " * 40
    root = _parsed(*_norton_5_2(), title)
    assert root.findtext(f"{SVG}title") == title.strip()
    heading = next(iter(root.iter(f"{SVG}text")))
    assert heading.text is not None
    assert heading.text.endswith("…")
    assert estimate_text_width(heading.text, float(heading.attrib["font-size"])) < float(root.attrib["width"])


def test_the_document_stands_alone(case: tuple[LinkageDesign, MotionProblem]) -> None:
    document = drawing(*case, "A design")
    assert document.count("http") == 1  # the name space
    assert not re.search(r"url\(|href|<style|<script|\bid=|\bon\w+=", document)


def test_all_numbers_are_finite_and_of_the_sheet(case: tuple[LinkageDesign, MotionProblem]) -> None:
    document = drawing(*case, "A design")
    assert not re.search(r"\b(nan|inf|infinity)\b", document, re.IGNORECASE)
    root = ET.fromstring(document)
    reach = 2.0 * max(float(root.attrib["width"]), float(root.attrib["height"]))
    for e in root.iter():
        for name in ("x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "r", "width", "height", "points", "d"):
            for value in re.findall(r"-?[\d.]+(?:e[+-]?\d+)?", e.get(name, "")):
                assert abs(float(value)) < reach


@pytest.mark.parametrize("size", [2.0**20, 2.0**-20, 1e6, 1e-6, 1e7])
def test_the_picture_does_not_depend_on_the_size_of_the_mechanism(size: float) -> None:
    def strokes(root: ET.Element) -> np.ndarray:
        main = _Main(root).panel
        drawn = [e for e in main.iter() if e.tag != f"{SVG}rect" and "data-scale-bar" not in e.attrib]
        values = [
            float(value)
            for e in drawn
            if e.tag != f"{SVG}text" or "data-label" in e.attrib
            for name in ("x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "points", "d")
            for value in re.findall(r"-?[\d.]+", e.get(name, ""))
        ]
        return np.array(values)

    plain, scaled = strokes(_parsed(*_norton_5_2())), strokes(_parsed(*_norton_5_2(size)))
    assert plain.shape == scaled.shape
    assert np.abs(plain - scaled).max() < 2 * PIXEL


def test_the_same_design_gives_the_same_text(case: tuple[LinkageDesign, MotionProblem]) -> None:
    assert drawing(*case, "A design") == drawing(*case, "A design")


def test_a_target_of_the_other_branch_is_shown_with_the_assembly_that_meets_it() -> None:
    design, problem = CASES["branch_defect"]()
    root = _parsed(design, problem)
    own = {
        e.attrib["data-configuration"]: e.attrib["data-own-assembly"]
        for e in root.iter()
        if "data-own-assembly" in e.attrib
    }
    assert own == {"1": "true", "2": "true", "3": "false"}
    words = ["".join(e.itertext()) for e in root.iter(f"{SVG}text")]
    assert "only in the other assembly (dashed)" in words
    assert "Checks: not all passed" in words
    assert any("fails 1 of 3 checks" in line for line in words)


def test_a_target_out_of_reach_has_no_ghost_but_is_still_demanded() -> None:
    design, problem = _norton_5_2()
    targets = [
        *design.targets[:2],
        Target(index=2, input_angle=-120.0, residual=math.inf, point_residual=math.inf, angle_residual=math.inf),
    ]
    root = _parsed(design.model_copy(update={"targets": targets}), problem)
    drawn = {e.get("data-configuration") for e in root.iter()} - {None}
    assert drawn == {"1", "2"}
    assert {e.get("data-target") for e in root.iter()} - {None} == {"1", "2", "3"}
    assert "cannot be assembled here" in ["".join(e.itertext()) for e in root.iter(f"{SVG}text")]


def test_limits_are_ticked_for_a_rocker_and_not_for_a_crank() -> None:
    def ticks(name: str) -> list[float]:
        return [float(e.attrib["data-limit"]) for e in _parsed(*CASES[name]()).iter() if "data-limit" in e.attrib]

    assert ticks("crank_rocker") == []
    # Both toggles of Norton's 5-2: f = b + c and |b − c| on the diagonal, by the cosine law.
    d, a, b, c = abs(complex(3.970552039, 8.1099629128)), 6.831999238, 1.399320056, 3.199669641
    ground = math.degrees(math.atan2(8.1099629128, 3.970552039))
    extended = math.degrees(math.acos((a * a + d * d - (b + c) ** 2) / (2 * a * d)))
    assert ticks("norton_5_2") == pytest.approx([ground - extended, ground + extended], abs=1e-6)


def test_the_curve_passes_through_the_positions_it_is_used_for() -> None:
    design, problem = _norton_5_2()
    main = _Main(_parsed(design, problem))
    curve = next(e for e in main.panel.iter() if e.get("data-curve") == "used")
    pairs = re.findall(r"(-?[\d.]+) (-?[\d.]+)", curve.attrib["d"])
    points = np.array([main.back(float(x), float(y)) for x, y in pairs])
    outer = [position.point for position in (problem.positions[0], problem.positions[-1])]
    assert abs(points[0] - outer[0]) < 2 * PIXEL / main.scale
    assert abs(points[-1] - outer[1]) < 2 * PIXEL / main.scale
    assert np.abs(points - problem.positions[1].point).min() < 5.0 / main.scale


def _boxes(root: ET.Element) -> list[tuple[str, Box]]:
    """Estimated boxes of all lines of text, a little smaller than the estimate of their glyphs."""
    found = []
    for e in root.iter(f"{SVG}text"):
        words, size = "".join(e.itertext()), float(e.attrib["font-size"])
        sub = e.find(f"{SVG}tspan")
        width = (
            estimate_text_width(words, size)
            if sub is None
            else estimate_text_width(e.text or "", size) + estimate_text_width(sub.text or "", 0.75 * size)
        )
        share = {"middle": 0.5, "end": 1.0}.get(e.get("text-anchor", "start"), 0.0)
        x, y = float(e.attrib["x"]) - share * width, float(e.attrib["y"])
        found.append((words, Box(x + 0.3, y - 0.7 * size, x + width - 0.3, y + 0.1 * size)))
    return found


def test_no_text_overlaps_other_text_or_leaves_the_sheet(case: tuple[LinkageDesign, MotionProblem]) -> None:
    root = _parsed(*case, "A title of ordinary length for a design")
    boxes = _boxes(root)
    sheet = Box(0.0, 0.0, float(root.attrib["width"]), float(root.attrib["height"]))
    clashes = [
        (one, other) for k, (one, box) in enumerate(boxes) for other, beside in boxes[:k] if box.overlaps(beside)
    ]
    assert clashes == []
    assert [words for words, box in boxes if not (sheet.holds(box.centre) and box.intersect_with(sheet) == box)] == []


def test_clipping_keeps_what_is_inside() -> None:
    box = Box(0.0, 0.0, 10.0, 10.0)
    pieces = clip_polyline(np.array([-5 + 5j, 5 + 5j, 5 + 15j, 8 + 15j, 8 + 5j, np.nan, 1 + 1j, 2 + 2j]), box)
    assert [piece.tolist() for piece in pieces] == [[5j, 5 + 5j, 5 + 10j], [8 + 10j, 8 + 5j], [1 + 1j, 2 + 2j]]
    assert clip_polyline(np.array([20 + 0j, 30 + 5j]), box) == []
    corners = clip_polygon([-1e9 - 1e9j, 1e9 - 1e9j, 1e9 + 1e9j, -1e9 + 1e9j], box)
    assert {(round(c.real, 6), round(c.imag, 6)) for c in corners} == {(0, 0), (10, 0), (10, 10), (0, 10)}


def test_of_many_targets_some_are_drawn_evenly_spread_with_both_ends() -> None:
    angles = list(np.linspace(30.0, 330.0, 200))
    design, problem = _case(Fourbar(0, 80, 25, 70, 60, _polar(40, 50)), angles, [OPEN_ASSEMBLY] * 200)
    root = _parsed(design, problem)
    main = _Main(root)
    drawn = sorted(int(e.attrib["data-configuration"]) for e in main.panel.iter() if e.get("data-configuration"))
    assert drawn[0] == 1
    assert drawn[-1] == 200
    assert 3 < len(drawn) <= MAX_GHOSTS + 1
    for count in (1, drawn[3], 200):
        pose, at = problem.positions[count - 1], main.joints(count)
        assert abs(at["P"] - pose.point) * main.scale < 2.0 * PIXEL
    words = " ".join(e.text or "" for e in root.iter(f"{SVG}text"))
    assert f"{MAX_TARGETS} of 200 targets" in words
    assert float(root.attrib["height"]) < 1200.0
    description = root.find(f"{SVG}desc")
    assert description is not None
    assert f"shown at 200 of 200 target positions, of which {MAX_TARGETS} are drawn" in (description.text or "")


def test_numbers_and_cut_text() -> None:
    assert [format_number(v) for v in (-0.001, 1.0, 2.345678, -3.5)] == ["0", "1", "2.35", "-3.5"]
    with pytest.raises(ValueError, match="finite"):
        format_number(math.nan)
    assert truncate_text("short", 10.0, 100.0) == "short"
    cut = truncate_text("a rather long line of text", 10.0, 60.0)
    assert cut.endswith("…")
    assert estimate_text_width(cut, 10.0) <= 60.0


@pytest.mark.parametrize(("width", "lines"), [(480.0, 1), (240.0, 2)])
def test_the_name_of_a_check_is_whole_and_clear_of_its_value(width: float, lines: int) -> None:
    row = CheckRow("max_overturning_moment", True, "12.3456 N·m", "120.125 N·m")
    block, end = make_checks([row])(0.0, 0.0, width)
    _, empty = make_checks([])(0.0, 0.0, width)
    root = ET.fromstring(block.write())
    name, measure = (e for e in root.iter("text") if e.get("font-weight") is None)
    assert (name.text, measure.text) == ("max overturning moment", "12.3456 N·m  (limit 120.125 N·m)")
    apart = float(measure.attrib["y"]) - float(name.attrib["y"])
    assert (apart > 0.0) == (lines == 2)
    reach = float(name.attrib["x"]) + estimate_text_width(name.text, FONT_SIZE)
    assert lines == 2 or reach < width - estimate_text_width(measure.text, FONT_SIZE)
    assert end - empty > apart
