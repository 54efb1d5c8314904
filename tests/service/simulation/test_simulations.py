"""Simulations of designs through HTTP: what stands in each file, every field of the query, and what is refused."""

from __future__ import annotations

import ast
import io
import math
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import httpx
import pytest
import shapely

from synthesis.registry import get_first_example
from tests.support.service.answers import finished
from tests.support.service.parts import MOTION, SLIDER

HOSTILE = 'a"<b>&--%s \\"\'\'\'"""; end Machine; {x}\n\x07é -->'
WEIGHED = {
    "gravity": {"magnitude": 9.0, "angle": 180.0},
    "speed_rpm": 30.0,
    "bodies": {"input": {"mass": 0.5, "cg": [0.0, 0.0], "inertia": 0.001}},
    "links": {"density": 1000.0, "thickness": 10.0, "width": 20.0},
    "point_masses": [{"joint": "B", "mass": 0.25}],
    "loads": [{"link": "coupler", "torque": {"constant": 1.0}}],
}
TRAIN = {"kind": "gear_train", "ratio": 1.5, "max_stages": 1, "max_designs": 1, "module": 2.0}
PROBLEMS = {
    "fourbar": MOTION,
    "slider": SLIDER,
    "weighed": {**MOTION, "dynamics": WEIGHED},
    "laid out": {**MOTION, "layout": {"link_width": 9.0, "pin_diameter": 3.0, "thickness": 2.0}},
    "consistent": {**MOTION, "dynamics": {**WEIGHED, "units": "consistent"}},
    "unit size": get_first_example("quick_return"),
    "train": TRAIN,
    "planets": get_first_example("planetary_train"),
    "gearbox": get_first_example("gearbox"),
    "layshaft": get_first_example("layshaft_gearbox"),
    "engine": get_first_example("engine"),
}
FORMS = ("mjcf", "urdf", "mo", "sim.py")


class Designs:
    """The first designs of problems, solved when they are first asked for."""

    def __init__(self, client: httpx.Client) -> None:
        self.client = client
        self._jobs: dict[str, Any] = {}

    def job(self, name: str) -> Any:
        if name not in self._jobs:
            self._jobs[name] = finished(self.client, PROBLEMS[name])
        return self._jobs[name]

    def design(self, name: str) -> Any:
        return self.job(name)["result"]["designs"][0]

    def asked(self, name: str, form: str, **query: Any) -> httpx.Response:
        return self.client.get(f"/v1/jobs/{self.job(name)['id']}/designs/0.{form}", params=query)

    def text(self, name: str, form: str, **query: Any) -> str:
        answer = self.asked(name, form, **query)
        assert answer.status_code == 200, answer.text
        assert answer.headers["x-content-type-options"] == "nosniff"
        # What people read counts from 1.
        assert f'-1.{form}"' in answer.headers["content-disposition"]
        return answer.text

    def model(self, name: str, **query: Any) -> ET.Element:
        return ET.fromstring(self.text(name, "mjcf", **query))

    def fault(self, name: str, form: str, status: int, **query: Any) -> Any:
        answer = self.asked(name, form, **query)
        assert answer.status_code == status, answer.text
        assert answer.headers["content-type"] == "application/problem+json"
        return answer.json()


@pytest.fixture(scope="module")
def designs(server: Any) -> Designs:
    return Designs(server.client)


def numbers(element: ET.Element | None, name: str) -> list[float]:
    assert element is not None
    return [float(part) for part in element.attrib[name].split()]


def placed(model: ET.Element) -> dict[str, tuple[complex, ET.Element]]:
    """The place of each body, and the body."""

    def below(parent: ET.Element, at: complex) -> Iterator[tuple[str, tuple[complex, ET.Element]]]:
        for body in parent.findall("body"):
            x, y, _ = numbers(body, "pos") if "pos" in body.attrib else (0.0, 0.0, 0.0)
            yield body.attrib["name"], (at + complex(x, y), body)
            yield from below(body, at + complex(x, y))

    world = model.find("worldbody")
    assert world is not None
    return dict(below(world, 0j))


def joints(design: Any) -> dict[str, complex]:
    return {name: complex(*place) for name, place in design["mechanism"]["skeleton"]["joints"].items()}


def plate(points: list[complex], width: float) -> Any:
    """A link as a polygon of a hundred corners a quarter, in millimetres."""
    return shapely.MultiPoint([(z.real, z.imag) for z in points]).convex_hull.buffer(0.5 * width, quad_segs=100)


def lengths(values: Any) -> list[float]:
    return sorted(round(value, 9) for value in values)


@pytest.mark.parametrize("name", ["fourbar", "slider"])
def test_a_tree_and_its_closures_have_the_joints_of_the_design(designs: Designs, name: str) -> None:
    design, model = designs.design(name), designs.model(name)
    at, bodies = joints(design), placed(model)
    links = {link["name"]: link["joints"] for link in design["mechanism"]["skeleton"]["links"]}
    (closure,) = model.findall("equality/connect")
    place, _ = bodies[closure.attrib["body1"]]
    x, y, _ = numbers(closure, "anchor")
    pinned = {body: {place} for body, (place, _) in bodies.items()}
    for body, (_, element) in bodies.items():
        # What hangs from a body hangs from one of its joints.
        for child in element.findall("body"):
            pinned[body].add(bodies[child.attrib["name"]][0])
    for body in (closure.attrib["body1"], closure.attrib["body2"]):
        pinned[body].add(place + complex(x, y))
    for link in links:
        if link == "ground":
            continue
        held = [joint for joint in links[link] if sum(joint in listed for listed in links.values()) > 1 or joint == "B"]
        apart = lengths(abs(a - b) for a in pinned[f"link_{link}"] for b in pinned[f"link_{link}"])
        stated = lengths(1e-3 * abs(at[a] - at[b]) for a in held for b in held)
        assert apart == pytest.approx(stated, abs=1e-8)
    sorts = [element.attrib["type"] for _, body in bodies.values() for element in body.findall("joint")]
    assert sorts.count("slide") == (name == "slider")


def test_links_are_plates_of_the_material_where_nothing_says_what_they_weigh(designs: Designs) -> None:
    at = joints(designs.design("fourbar"))
    links = {link["name"]: link["joints"] for link in designs.design("fourbar")["mechanism"]["skeleton"]["links"]}
    bodies = placed(designs.model("fourbar", width=8.0, thickness=3.0))
    for link in ("input", "coupler", "output"):
        shape = plate([at[joint] for joint in links[link]], 8.0)
        inertial = bodies[f"link_{link}"][1].find("inertial")
        mass = 7850e-9 * shape.area * 3.0
        assert numbers(inertial, "mass") == pytest.approx([mass], rel=1e-4)
        # The moment about the centre by splitting into triangles.
        centre = complex(shape.centroid.x, shape.centroid.y)
        total = 0.0
        for triangle in shapely.get_parts(shapely.delaunay_triangles(shape)):
            corners = [complex(*corner) - centre for corner in triangle.exterior.coords[:3]]
            squares = sum(
                abs(a + b) ** 2
                for a, b in ((corners[0], corners[1]), (corners[1], corners[2]), (corners[2], corners[0]))
            )
            total += triangle.area * squares / 12.0
        assert numbers(inertial, "diaginertia")[2] == pytest.approx(7850e-9 * 3.0 * 1e-6 * total, rel=1e-3)
    assert "no gravity" in designs.text("fourbar", "mjcf")


def test_the_block_dynamics_says_masses_gravity_and_speed(designs: Designs) -> None:
    design, model = designs.design("weighed"), designs.model("weighed")
    option = model.find("option")
    assert numbers(option, "gravity") == pytest.approx([-9.0, 0.0, 0.0], abs=1e-12)
    assert numbers(option, "timestep")[0] * 360 * 56 == pytest.approx(
        2.0 if design["metrics"]["full_rotation"] else abs(swept(design)) / math.pi, rel=1e-9
    )
    bodies = placed(model)
    assert numbers(bodies["link_input"][1].find("inertial"), "mass") == [0.5]
    assert numbers(bodies["link_input"][1].find("inertial"), "diaginertia")[2] == 0.001
    at = joints(design)
    links = {link["name"]: link["joints"] for link in design["mechanism"]["skeleton"]["links"]}
    own = {link: 1e-5 * plate([at[joint] for joint in links[link]], 20.0).area for link in ("coupler", "output")}
    found = {link: numbers(bodies[f"link_{link}"][1].find("inertial"), "mass")[0] for link in own}
    assert sum(found.values()) == pytest.approx(sum(own.values()) + 0.25, rel=1e-4)
    assert "Not included: loads" in designs.text("weighed", "mjcf")


def swept(design: Any) -> float:
    low, high = design["metrics"]["used_range"]
    return math.radians(high - low)


def test_a_layout_says_how_wide_and_thick_links_are(designs: Designs) -> None:
    at = joints(designs.design("laid out"))
    links = {link["name"]: link["joints"] for link in designs.design("laid out")["mechanism"]["skeleton"]["links"]}
    inertial = placed(designs.model("laid out"))["link_input"][1].find("inertial")
    mass = 7850e-9 * plate([at[joint] for joint in links["input"]], 9.0).area * 2.0
    assert numbers(inertial, "mass") == pytest.approx([mass], rel=1e-4)


def masses(model: ET.Element) -> dict[str, float]:
    return {
        name: numbers(body.find("inertial"), "mass")[0] for name, (_, body) in placed(model).items() if name != "lead"
    }


def rates(model: ET.Element) -> list[float]:
    return numbers(model.find("keyframe/key"), "qvel")


@pytest.mark.parametrize(
    ("name", "field", "value", "share"),
    [
        ("fourbar", "material", "aluminium", 2700 / 7850),
        ("fourbar", "material", "PETG", 1270 / 7850),
        ("fourbar", "thickness", 6.0, 2.0),
        ("train", "thickness", 40.0, 2.0),
        ("train", "material", "aluminium", 2700 / 7850),
        ("train", "scale", 2.0, 8.0),
    ],
)
def test_what_bodies_are_made_of_counts(designs: Designs, name: str, field: str, value: Any, share: float) -> None:
    base = {"thickness": 3.0, "width": 8.0} if name == "fourbar" else {}
    before, after = masses(designs.model(name, **base)), masses(designs.model(name, **base | {field: value}))
    assert before.keys() == after.keys()
    for body, mass in before.items():
        assert after[body] == pytest.approx(share * mass, rel=1e-9)


def test_a_width_and_a_scale_of_linkages_count(designs: Designs) -> None:
    narrow, wide = (masses(designs.model("fourbar", thickness=3.0, width=width)) for width in (6.0, 12.0))
    assert all(wide[body] > 1.3 * mass for body, mass in narrow.items())
    before, larger = designs.model("fourbar"), designs.model("fourbar", scale=3.0)
    for body, mass in masses(before).items():
        assert masses(larger)[body] == pytest.approx(27.0 * mass, rel=1e-9)
        assert placed(larger)[body][0] == pytest.approx(3.0 * placed(before)[body][0], rel=1e-9)


@pytest.mark.parametrize(("name", "query"), [("fourbar", {"speed_rpm": 120.0}), ("train", {"speed_rpm": -120.0})])
def test_a_speed_counts(designs: Designs, name: str, query: Any) -> None:
    # The lead's rate is the last.
    assert rates(designs.model(name))[-1] == pytest.approx(2.0 * math.pi)
    assert rates(designs.model(name, **query))[-1] == pytest.approx(query["speed_rpm"] * math.pi / 30.0)


def test_a_mechanism_of_unit_size_is_built_larger_and_said_to_be(designs: Designs) -> None:
    at = joints(designs.design("unit size"))
    crank = next(
        link for link in designs.design("unit size")["mechanism"]["skeleton"]["links"] if link["name"] == "input"
    )
    length = 1e-3 * abs(at[crank["joints"][0]] - at[crank["joints"][1]])
    bodies = placed(designs.model("unit size"))
    apart = abs(bodies["link_coupler"][0] - bodies["link_input"][0])
    assert f"Built {apart / length:.6g} times larger" in designs.text("unit size", "mjcf")
    assert apart / length >= 10.0
    assert apart / length == pytest.approx(10.0 ** round(math.log10(apart / length)), rel=1e-9)
    for _, body in bodies.values():
        assert numbers(body.find("inertial"), "mass")[0] >= 1e-14
        assert min(numbers(body.find("inertial"), "diaginertia")) >= 0.5e-14


def test_gears_are_tied_by_their_teeth(designs: Designs) -> None:
    (stage,) = designs.design("train")["mechanism"]["stages"]
    coupled = {joint.attrib["name"]: joint for joint in designs.model("train").findall("equality/joint")}
    assert numbers(coupled["mesh_1"], "polycoef")[1] == pytest.approx(-stage["driver"] / stage["driven"], rel=1e-15)
    assert numbers(coupled["drive"], "polycoef") == [0.0, 1.0, 0.0, 0.0, 0.0]
    places = [place for name, (place, _) in placed(designs.model("train")).items() if name != "lead"]
    distance = 0.5 * stage["module"] * (stage["driver"] + stage["driven"])
    assert abs(places[1] - places[0]) == pytest.approx(1e-3 * distance)


def test_planets_hang_from_their_carrier_and_roll_on_both_gears(designs: Designs) -> None:
    mechanism, model = designs.design("planets")["mechanism"], designs.model("planets")
    bodies = placed(model)
    hanging = [body.attrib["name"] for body in bodies["gear_carrier"][1].findall("body")]
    assert len(hanging) == mechanism["planets"]
    teeth = mechanism["teeth"]
    rolling = next(t for t in model.findall("tendon/fixed") if "turn_gear_sun" in {j.attrib["joint"] for j in t})
    weights = {joint.attrib["joint"]: float(joint.attrib["coef"]) for joint in rolling}
    assert weights["turn_gear_sun"] == teeth["sun"]
    assert weights["turn_gear_carrier"] == -teeth["sun"]
    assert weights[f"turn_{hanging[0]}"] == teeth["planet"]


@pytest.mark.parametrize(("name", "measure"), [("gearbox", "speeds"), ("layshaft", "errors")])
def test_each_speed_of_a_gearbox_can_be_engaged(designs: Designs, name: str, measure: str) -> None:
    design = designs.design(name)
    count = len(design["metrics"][measure])
    shares = []
    for gear in range(1, count + 1):
        model = designs.model(name, gear=gear)
        names = [body for body in placed(model) if body != "lead"]
        turned = dict(zip(names, rates(model), strict=False))
        output = turned["gear_spindle" if name == "gearbox" else "gear_main_shaft"]
        shares.append(output / turned["gear_input"])
    if name == "gearbox":
        told = [speed["speed"] / design["mechanism"]["input_speed"] for speed in design["metrics"]["speeds"]]
        assert [abs(share) for share in shares] == pytest.approx(told, rel=1e-9)
    else:
        ratios = [gear["ratio"]["value"] for gear in design["mechanism"]["gears"]]
        back = design["mechanism"]["reverse"]
        ratios += [] if back is None else [back["ratio"]["value"]]
        assert [1.0 / share for share in shares] == pytest.approx(ratios, rel=1e-9)
    assert designs.fault(name, "mjcf", 422, gear=count + 1)["errors"][0]["path"] == "/query/gear"


def test_a_urdf_is_a_tree_whose_loop_stands_beside(designs: Designs) -> None:
    model = designs.model("fourbar")
    robot = ET.fromstring(designs.text("fourbar", "urdf"))
    links = {link.attrib["name"] for link in robot.findall("link")}
    # Gazebo holds a root of this name fast, and leaves out any other that has no mass, with all that hangs from it.
    assert links == {"world", *(name for name in placed(model) if name != "lead")}
    at, parents = {"world": 0j}, {}
    for joint in robot.findall("joint"):
        parent, child = (joint.find(end) for end in ("parent", "child"))
        assert parent is not None
        assert child is not None
        x, y, _ = numbers(joint.find("origin"), "xyz")
        at[child.attrib["link"]] = at[parent.attrib["link"]] + complex(x, y)
        parents[child.attrib["link"]] = parent.attrib["link"]
    assert parents.keys() == links - {"world"}
    for name, (place, body) in placed(model).items():
        if name != "lead":
            assert at[name] == pytest.approx(place, abs=1e-15)
            mass = robot.find(f"link[@name='{name}']/inertial/mass")
            assert numbers(mass, "value") == numbers(body.find("inertial"), "mass")
    (loop,) = robot.findall("gazebo/joint")
    ends = [loop.findtext("parent", ""), loop.findtext("child", "")]
    assert set(ends) <= links
    x, y, *_ = (float(part) for part in loop.findtext("pose", "").split())
    closure = model.find("equality/connect")
    assert closure is not None
    first, _ = placed(model)[closure.attrib["body1"]]
    ahead, aside, _ = numbers(closure, "anchor")
    assert at[ends[1]] + complex(x, y) == pytest.approx(first + complex(ahead, aside), abs=1e-15)
    mimic = ET.fromstring(designs.text("train", "urdf")).find("joint/mimic")
    (stage,) = designs.design("train")["mechanism"]["stages"]
    assert numbers(mimic, "multiplier") == pytest.approx([-stage["driver"] / stage["driven"]])


def test_a_modelica_model_closes_its_loop_in_the_plane(designs: Designs) -> None:
    text = designs.text("fourbar", "mo")
    assert text.count("RevolutePlanarLoopConstraint") == 1
    assert text.count("Joints.Revolute ") == 3
    assert "Relation" not in text
    train = designs.text("train", "mo")
    (stage,) = designs.design("train")["mechanism"]["stages"]
    assert f"Relation mesh_1(weights = {{{stage['driven']}, {stage['driver']}}});" in train


def test_a_script_has_the_model_and_the_motion_of_the_analysis(designs: Designs) -> None:
    text = designs.text("fourbar", "sim.py")
    stated = {
        node.targets[0].id: node.value
        for node in ast.parse(text).body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
    }
    assert ast.literal_eval(stated["MODEL"]) == designs.text("fourbar", "mjcf")
    names, motion = ast.literal_eval(stated["JOINTS"]), ast.literal_eval(stated["MOTION"])
    assert motion[0] == [0.0] * len(names)
    design = designs.design("fourbar")
    assert not design["metrics"]["full_rotation"]
    # It goes counter-clockwise, whichever way the targets lie.
    low, high = sorted(design["metrics"]["used_range"])
    asked = {"mechanism": design["mechanism"], "motion": {"from": low, "to": high, "steps": 360}}
    links = designs.client.post("/v1/analyses", json=asked).raise_for_status().json()["links"]
    turned = {link: [angle - of["angle"][0] for angle in of["angle"]] for link, of in links.items()}
    for link, parent in (("input", None), ("output", None), ("coupler", "input")):
        found = [row[names.index(f"turn_link_{link}")] for row in motion]
        carried = [0.0] * 361 if parent is None else turned[parent]
        apart = [q - math.radians(own - by) for q, own, by in zip(found, turned[link], carried, strict=True)]
        assert [math.remainder(one, math.tau) for one in apart] == pytest.approx([0.0] * 361, abs=1e-9)
    assert motion[-1][names.index("turn_link_input")] == pytest.approx(math.radians(high - low))


def script(text: str, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What a script defines, MuJoCo being away."""
    absent = SimpleNamespace(mjtConstraint=SimpleNamespace(mjCNSTR_EQUALITY=0))
    monkeypatch.setitem(sys.modules, "mujoco", absent)
    scope: dict[str, Any] = {"__name__": "script"}
    exec(text, scope)
    monkeypatch.setattr(sys, "argv", ["script.py"])
    return scope


@pytest.mark.parametrize(("off", "status"), [(0.0, 0), (0.9e-4, 0), (1.1e-4, 1), (-1.1e-4, 1), (math.nan, 1)])
def test_the_status_of_a_script_tells_what_misses_the_analysis(
    designs: Designs, monkeypatch: pytest.MonkeyPatch, off: float, status: int
) -> None:
    scope = script(designs.text("fourbar", "sim.py"), monkeypatch)
    rows = [(float(n), list(row), 1.0) for n, row in enumerate(scope["MOTION"])]
    rows[200][1][1] += off
    scope["simulated"] = lambda: iter(rows)
    assert scope["main"]() == status


def test_a_script_runs_where_the_console_has_not_the_letters_of_its_title(
    designs: Designs, monkeypatch: pytest.MonkeyPatch
) -> None:
    posted = designs.client.post("/v1/jobs", json={"problem": TRAIN, "label": "Räder"}, headers={"Prefer": "wait=30"})
    text = designs.client.get(f"/v1/jobs/{posted.json()['id']}/designs/0.sim.py").raise_for_status().text
    scope = script(text, monkeypatch)
    scope["simulated"] = lambda: ((float(n), row, 1.0) for n, row in enumerate(scope["MOTION"]))
    printed = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(printed, encoding="ascii", write_through=True))
    assert scope["main"]() == 0
    assert b"R?der" in printed.getvalue()


def test_whatever_a_label_holds_every_file_is_well_formed(designs: Designs) -> None:
    posted = designs.client.post("/v1/jobs", json={"problem": TRAIN, "label": HOSTILE}, headers={"Prefer": "wait=30"})
    place = f"/v1/jobs/{posted.json()['id']}/designs/0"
    texts = {form: designs.client.get(f"{place}.{form}").raise_for_status().text for form in FORMS}
    assert ET.fromstring(texts["mjcf"]).attrib["model"].startswith('a"<b>&--%s')
    assert ET.fromstring(texts["urdf"]).attrib["name"].startswith('a"<b>&--%s')
    title = next(node for node in ast.parse(texts["sim.py"]).body if isinstance(node, ast.Assign))
    assert ast.literal_eval(title.value).startswith('a"<b>&--%s')
    assert texts["mo"].isprintable() or all(line.isprintable() for line in texts["mo"].splitlines())
    (head,) = (line for line in texts["mo"].splitlines() if line.startswith("model "))
    assert head.startswith('model Machine "a\\"<b>&--%s \\\\\\"')
    assert texts["mo"].rstrip().endswith("end Machine;")


@pytest.mark.parametrize(
    ("name", "query", "path"),
    [
        ("fourbar", {"gear": 1}, "/query/gear"),
        ("fourbar", {"speed": 1.0}, "/query/speed"),
        ("fourbar", {"speed_rpm": 0.0}, "/query/speed_rpm"),
        ("fourbar", {"scale": 1e-4}, "/query/scale"),
        ("fourbar", {"material": "gold"}, "/query/material"),
        ("fourbar", {"width": -1.0}, "/query/width"),
        ("fourbar", {"width": 1e-300}, "/query/width"),
        ("fourbar", {"speed_rpm": 1e-300}, "/query/speed_rpm"),
        ("train", {"scale": 1e-300}, "/query/scale"),
        ("fourbar", {"colour": "red"}, "/query/colour"),
        ("weighed", {"scale": 2.0}, "/query/scale"),
        ("train", {"width": 5.0}, "/query/width"),
        ("train", {"gear": 1}, "/query/gear"),
        ("train", {"speed_rpm": 0.0}, "/query/speed_rpm"),
        ("fourbar", {"speed_rpm": 1e7}, "/query/speed_rpm"),
    ],
)
def test_a_field_that_does_not_fit_is_told(designs: Designs, name: str, query: Any, path: str) -> None:
    told = designs.fault(name, "mjcf", 422, **query)
    assert [fault["path"] for fault in told["errors"]] == [path]


def test_what_has_no_simulation_is_told(designs: Designs) -> None:
    for form in FORMS:
        assert designs.fault("engine", form, 404)["type"] == "/problems/not-found"
    told = designs.fault("fourbar", "sim.py", 409, speed_rpm=1e6)
    assert "the limit for MuJoCo" in told["detail"]
    assert designs.asked("fourbar", "urdf", speed_rpm=1e6).status_code == 200
    told = designs.fault("consistent", "mjcf", 409)
    assert told["type"] == "/problems/no-simulation"
    assert "units" in told["detail"]
    missing = designs.client.get(f"/v1/jobs/{designs.job('train')['id']}/designs/9.mjcf")
    assert missing.status_code == 404
