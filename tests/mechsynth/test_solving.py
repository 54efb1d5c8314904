"""Problems solved in this process: their answers, drawings, files and motions."""

import sys
import threading
import types
import xml.etree.ElementTree as ET

import ezdxf
import numpy as np
import pytest

import synthesis
from mechsynth import Cancelled, GearTrain, InvalidProblem, Motion, NoSuchExport, Position, solve
from mechsynth.parts import TeethRange
from synthesis.registry import get_first_example, parse_problem

MOTION = {
    "kind": "motion",
    "positions": [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 10.0, "y": 5.0, "angle": 30.0}],
    "max_designs": 2,
}
TRAIN = {"kind": "gear_train", "ratio": "7/3", "max_stages": 1}


@pytest.fixture(scope="module")
def motion():
    return solve(MOTION, label="<gripper>")


@pytest.fixture(scope="module")
def train():
    return solve(TRAIN)


def test_classes_mappings_and_the_solvers_give_one_answer(motion):
    places = [Position(x=0.0, y=0.0, angle=0.0), Position(x=10.0, y=5.0, angle=30.0)]
    expected = synthesis.solve(parse_problem(MOTION)).model_dump_json()
    assert solve(Motion(positions=places, max_designs=2)).to_json() == expected
    assert motion.to_json() == expected
    assert [design.model for design in motion.designs] == motion.model.designs
    assert all(design.passed and design.verification.passed for design in motion.designs)
    assert motion.summary == motion.model.summary
    assert motion.search.seed == 0
    assert motion.nearest_miss is None


def test_a_field_of_a_part_is_stated():
    asked = [
        GearTrain(ratio="7/3", max_stages=1, max_designs=1, teeth=TeethRange(min=least, max=120)) for least in (18, 40)
    ]
    one, other = (solve(problem) for problem in asked)
    assert one.designs[0].mechanism.stages[0].driver < 40 <= other.designs[0].mechanism.stages[0].driver


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"kind": "mangle"}, "/kind"),
        ({"positions": [{"x": 0.0, "y": "a", "angle": 0.0}, MOTION["positions"][1]]}, "/positions/0/y"),
        ({"positions": [MOTION["positions"][1]] * 2}, "/positions/1"),
        ({"postions": []}, "/postions"),
    ],
)
def test_what_is_wrong_is_said_by_field(change, path):
    with pytest.raises(InvalidProblem) as invalid:
        solve({**MOTION, **change})
    assert list(invalid.value.errors) == [path]
    assert path in str(invalid.value)


def test_a_motion_is_arrays_by_name(motion):
    design = motion.designs[0]
    cycle = design.motion(60)
    assert len(cycle) == 61
    assert cycle.valid.all()
    assert set(cycle.joints) == {"O2", "O4", "A", "B", "P"}
    assert set(cycle.links) == {"input", "coupler", "output"}
    for tracks in (cycle.joints, cycle.velocities, cycle.accelerations):
        assert {track.shape for track in tracks.values()} == {(61, 2)}
    assert {angle.shape for angle in cycle.links.values()} == {(61,)}
    at, links = cycle.joints, design.mechanism.links
    for (start, end), link in ((("O2", "A"), "input"), (("A", "B"), "coupler"), (("O4", "B"), "output")):
        along = at[end] - at[start]
        np.testing.assert_allclose(np.hypot(*along.T), getattr(links, link), rtol=1e-9)
        turned = np.degrees(np.arctan2(along[:, 1], along[:, 0])) - cycle.links[link]
        np.testing.assert_allclose(np.cos(np.radians(turned)), 1.0, atol=1e-9)
    # The velocity of A is across the crank, at 1 rad/s.
    across = np.stack((at["O2"][:, 1] - at["A"][:, 1], at["A"][:, 0] - at["O2"][:, 0]), axis=-1)
    np.testing.assert_allclose(cycle.velocities["A"], across, atol=1e-9 * links.input)
    np.testing.assert_allclose(cycle.accelerations["A"], at["O2"] - at["A"], atol=1e-9 * links.input)


def test_what_has_no_joints_has_the_rest_of_its_motion(train):
    cycle = train.designs[0].motion(12)
    assert (cycle.joints, cycle.links, cycle.slides) == ({}, {}, {})
    np.testing.assert_allclose(cycle.input_angle, np.linspace(0.0, 360.0, 13))
    assert cycle.answer["shafts"][1]["speed_ratio"] == pytest.approx(-3 / 7)  # the other way round
    with pytest.raises(ValueError, match="steps must be at least 1"):
        train.designs[0].motion(0)


@pytest.mark.slow
def test_designs_are_drawn_and_written(motion, tmp_path):
    design = motion.designs[1]
    assert design.title == "<gripper>, design 2"
    assert design.forms == ["svg", "gif", "dxf", "csv"]
    drawn = ET.fromstring(design.draw())
    assert drawn.tag == "{http://www.w3.org/2000/svg}svg"
    assert design.title in "".join(drawn.itertext())
    assert design.to_svg(tmp_path / "a.svg").read_text(encoding="utf-8") == design.draw() == design._repr_svg_()
    assert ezdxf.readfile(design.to_dxf(tmp_path / "a.dxf")).modelspace()
    assert design.to_csv(str(tmp_path / "a.csv")).read_bytes().decode() == design.file("csv")
    assert design.to_gif(tmp_path / "a.gif").read_bytes().startswith(b"GIF89a")


def test_what_has_no_animation_says_so(tmp_path):
    design = solve(get_first_example("flywheel")).designs[0]
    with pytest.raises(NoSuchExport):
        design.to_gif(tmp_path / "a.gif")
    assert list(tmp_path.iterdir()) == []


def test_a_notebook_shows_them(motion):
    page = ET.fromstring(motion._repr_html_())
    text = "".join(page.itertext())
    assert motion.summary in text
    rows = page.findall(".//tbody/tr")
    assert [row[1].text for row in rows] == [design.mechanism.type for design in motion.designs]
    assert page.find("{http://www.w3.org/2000/svg}svg") is not None
    shown = ET.fromstring(motion.designs[0]._repr_html_())
    checks = motion.designs[0].verification.checks
    assert [row[0].text for row in shown.findall(".//tbody/tr")] == [check.name for check in checks]
    assert "&lt;gripper&gt;" in motion.designs[0]._repr_html_()


def test_an_empty_answer_is_shown_too():
    nothing = solve({**TRAIN, "ratio": "pi", "tolerance": 1e-9})
    assert nothing.designs == []
    assert nothing.search.complete
    assert nothing.summary in "".join(ET.fromstring(nothing._repr_html_()).itertext())


def test_progress_is_told_to_who_asks():
    told = []
    solve(MOTION, progress=lambda share, doing: told.append((share, doing)))
    assert told[-1][0] == 1.0
    assert [share for share, _ in told] == sorted(share for share, _ in told)


def test_progress_is_a_bar_where_tqdm_is_installed(monkeypatch, capsys):
    bars = []

    class Bar:
        def __init__(self, total, **_):
            self.total, self.n, self.said, self.closed = total, 0, [], False
            bars.append(self)

        def set_description(self, said, refresh=True):
            self.said.append(said)

        def update(self, more):
            self.n += more

        def __enter__(self):
            return self

        def __exit__(self, *_):
            self.closed = True

    auto = types.ModuleType("tqdm.auto")
    auto.tqdm = Bar
    monkeypatch.setitem(sys.modules, "tqdm", types.ModuleType("tqdm"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", auto)
    solve(MOTION, progress=True)
    assert [(bar.n, bar.total, bar.closed) for bar in bars] == [(100, 100, True)]
    assert bars[0].said[-1] == "verified"
    assert capsys.readouterr().err == ""


def test_progress_is_lines_where_it_is_not(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    solve(MOTION, progress=True)
    lines = capsys.readouterr().err.splitlines()
    assert lines[-1] == "100 % verified"
    assert len(set(lines)) == len(lines) > 2


def test_a_problem_is_given_up():
    cancel = threading.Event()
    told = []

    def heard(share, _doing):
        told.append(share)
        cancel.set()

    with pytest.raises(Cancelled):
        solve(MOTION, progress=heard, cancel=cancel)
    assert len(told) == 1
