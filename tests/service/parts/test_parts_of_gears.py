"""Parts of trains of gears through HTTP: teeth, bores, every field of the query, and what is refused."""

from __future__ import annotations

import io
import math
from typing import Any

import ezdxf
import numpy as np
import pytest
import shapely

from kinematics.gear.teeth import involute
from service.parts.export.cad_available import is_installed
from tests.campaign import further
from tests.support.service.answers import finished
from tests.support.service.parts import bill, parts, refused
from tests.support.service.parts_of_gears import BEVELS, PAIR, SET, WORM

SIZES = {"bore": 10, "thickness": 5, "face_width": 14, "clearance": 0.1}


@pytest.fixture(scope="module")
def pair(server: Any) -> str:
    """The place of two spur gears."""
    return f"/v1/jobs/{finished(server.client, PAIR)['id']}/designs/0"


def cut(files: dict[str, bytes], name: str) -> ezdxf.layouts.Modelspace:
    document = ezdxf.read(io.StringIO(files[f"dxf/{name}.dxf"].decode()))
    assert not document.audit().has_errors
    assert document.units == ezdxf.units.MM
    return document.modelspace()


def corners(outline: Any) -> np.ndarray:
    return np.array([complex(x, y) for x, y, *_ in outline.get_points("xyb")])


@pytest.mark.slow
def test_a_gear_is_cut_with_its_true_teeth_and_its_keyway(client: Any, pair: str) -> None:
    files = parts(client, pair, **SIZES)
    stage = client.get(pair.rsplit("/designs")[0]).json()["result"]["designs"][0]["mechanism"]["stages"][0]
    for role in ("driver", "driven"):
        teeth, module = stage[role], stage["module"]
        outer, bore = sorted(
            cut(files, f"gear_1_{role}").query("LWPOLYLINE"), key=lambda line: -np.ptp(corners(line).real)
        )
        assert outer.closed
        middle = complex(np.mean(corners(outer)))
        places = corners(outer) - middle
        radii = np.abs(places)
        pitch = 0.5 * module * teeth
        assert radii.max() == pytest.approx(pitch + module, abs=1e-6)
        assert radii.min() == pytest.approx(pitch - 1.25 * module, abs=1e-6)
        # Every corner well above the fillet lies on an involute, half of the play behind that of a tooth without any.
        phi = math.radians(20.0)
        above = places[(radii > pitch - 0.6 * module) & (radii < pitch + 0.999 * module)]
        there = np.arccos(pitch * math.cos(phi) / np.abs(above))
        half = 0.5 * (0.5 * math.pi * module - 0.05) / pitch
        off = half + involute(phi) - (np.tan(there) - there)
        turns = np.angle(above) - middle_of_teeth(places, teeth)
        away = np.abs(np.remainder(turns + math.pi / teeth, 2.0 * math.pi / teeth) - math.pi / teeth)
        assert len(above) >= 2 * teeth
        assert (np.abs(away - off) * np.abs(above)).max() < 1e-9
        # The bore is wider than the shaft by the clearance, and has the keyway of DIN 6885 for 10 mm: 3 wide, 1.4 deep.
        hole = corners(bore)
        assert np.ptp(hole.imag) == pytest.approx(3.2, abs=1e-9)
        bulge = max(b for *_, b in bore.get_points("xyb"))
        chord = 3.2
        radius = chord * (1.0 + bulge**2) / (4.0 * bulge)
        assert radius == pytest.approx(5.1, abs=1e-9)
        assert hole.real.max() - (hole.real.min() - math.sqrt(radius**2 - 1.6**2)) == pytest.approx(5.0 + 1.4 + 0.1)


def middle_of_teeth(places: np.ndarray, teeth: int) -> float:
    """The angle of a tooth's middle, by the mean direction of all corners in the teeth's own turns."""
    tips = places[np.abs(places) > np.abs(places).max() - 1e-6]
    return float(np.angle((tips**teeth).sum()) / teeth)


@pytest.mark.slow
def test_shafts_stand_as_far_apart_as_the_answer_says(client: Any, pair: str) -> None:
    files = parts(client, pair, **SIZES)
    distance = client.get(pair.rsplit("/designs")[0]).json()["result"]["designs"][0]["metrics"]["centre_distances"][0]
    for plate in ("base", "second_base"):
        holes = [complex(one.dxf.center.x, one.dxf.center.y) for one in cut(files, plate).query("CIRCLE")]
        found = [abs(a - b) for n, a in enumerate(holes) for b in holes[n + 1 :]]
        assert len(holes) == 6
        assert min(abs(one - distance) for one in found) < 1e-9


def test_the_bill_of_a_pair_names_keys_and_shafts(client: Any, pair: str) -> None:
    rows = bill(parts(client, pair, **SIZES))
    assert rows["key"]["quantity"] == "2"
    assert rows["key"]["standard"] == "DIN 6885 - 3 x 3 x 13.8"
    assert rows["pin_input_shaft"]["standard"] == "EN 10278 - 10 h9"
    assert rows["gear_1_driver"]["holes"] == "bore with keyway 10.2 x 11.6"
    assert rows["gear_1_driver"]["thickness"] == "14"
    assert rows["base"]["thickness"] == "5"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("field", "value"),
    [("bore", 8), ("thickness", 6), ("face_width", 20), ("clearance", 0.2), ("scale", 2.0), ("process", "print")],
)
def test_every_field_counts_for_gears(client: Any, pair: str, field: str, value: Any) -> None:
    base = {**SIZES, "process": "laser", "scale": 1.0}
    if field == "process" and not is_installed():
        assert refused(client, pair, 501, **(base | {field: value}))["type"] == "/problems/no-cad"
        return
    files, others = parts(client, pair, **base), parts(client, pair, **(base | {field: value}))
    rows, changed = bill(files), bill(others)
    if field == "bore":
        assert changed["pin_input_shaft"]["width"] == "8"
    if field == "thickness":
        assert changed["base"]["thickness"] == "6"
    if field == "face_width":
        assert changed["gear_1_driver"]["thickness"] == "20"
    if field == "clearance":
        # Teeth are thinner by half of it each, so that their outline encloses less.
        areas = [shapely.Polygon([(z.real, z.imag) for z in corners(max(
            cut(one, "gear_1_driven").query("LWPOLYLINE"), key=lambda line: np.ptp(corners(line).real)
        ))]).area for one in (files, others)]  # fmt: skip
        assert areas[0] > areas[1]
    if field == "scale":
        assert float(changed["gear_1_driver"]["length"]) == pytest.approx(
            2.0 * float(rows["gear_1_driver"]["length"]), abs=0.2
        )
    if field == "process":
        assert "cap_1" in changed or "cap" in changed
        assert not any(row["standard"].startswith("DIN 471") for row in changed.values())


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("bore", 0), ("bore", 1000), ("bore", 40), ("bore", "nan"), ("face_width", 0), ("face_width", 0.1),
        ("face_width", 1e5), ("thickness", 0.01), ("thickness", 1e5), ("clearance", 0.9), ("clearance", 1e-9),
        ("scale", 0), ("scale", 1e-308), ("scale", 1e5), ("scale", 1e-3), ("process", "cast"),
        ("width", 10), ("pin", 5), ("over", "used"),
        ("shafts", "one_side"),
    ],
)  # fmt: skip
def test_bad_values_of_gears_are_refused_by_their_path(client: Any, pair: str, field: str, value: Any) -> None:
    sizes = {} if field == "scale" and value == 1e-3 else SIZES
    answer = refused(client, pair, 422, **(sizes | {field: value}))
    assert [fault["path"] for fault in answer["errors"]] == [f"/query/{field}"]


@pytest.mark.slow
def test_a_refusal_says_what_works(client: Any, pair: str) -> None:
    (fault,) = refused(client, pair, 422, bore=40)["errors"]
    words = fault["detail"].split()
    assert parts(client, pair, bore=float(words[words.index("use") + 1]))
    (fault,) = refused(client, pair, 422, scale=1e-3)["errors"]
    words = fault["detail"].split()
    assert parts(client, pair, scale=float(words[words.index("scale") + 1]))


@pytest.mark.slow
def test_a_reverted_train_comes_back_to_its_axis(client: Any) -> None:
    job = finished(
        client, {"kind": "gear_train", "ratio": "6", "max_stages": 2, "max_designs": 1, "reverted": True,
                 "teeth": {"min": 17, "max": 60}}
    )  # fmt: skip
    files = parts(client, f"/v1/jobs/{job['id']}/designs/0")
    distance = job["result"]["designs"][0]["metrics"]["centre_distances"][0]
    for plate in ("base", "second_base"):
        holes = [complex(one.dxf.center.x, one.dxf.center.y) for one in cut(files, plate).query("CIRCLE")]
        assert len(holes) == 6
        assert min(abs(abs(a - b) - distance) for n, a in enumerate(holes) for b in holes[n + 1 :]) < 1e-9
    assert b"is held only by the lower plate" in files["README.txt"]
    assert b"is held only by the upper plate" in files["README.txt"]


@pytest.fixture(scope="module")
def trains(server: Any) -> dict[str, dict[str, Any]]:
    """Simple sets by what is held, and where their first designs are."""
    stated = {"ring": SET, "carrier": {**SET, "ratio": "-3"}, "sun": {**SET, "ratio": "4/3"}}
    found = {}
    for held, problem in stated.items():
        job = finished(server.client, {**problem, "fixed": held})
        found[held] = {
            "place": f"/v1/jobs/{job['id']}/designs/0",
            "mechanism": job["result"]["designs"][0]["mechanism"],
        }
    return found


def centres(space: ezdxf.layouts.Modelspace) -> list[complex]:
    return [complex(one.dxf.center.x, one.dxf.center.y) for one in space.query("CIRCLE")]


@pytest.mark.slow
@pytest.mark.parametrize("held", further(["ring", "carrier", "sun"], ["ring"]))
def test_planets_stand_where_the_teeth_want_them(client: Any, trains: Any, held: str) -> None:
    mechanism = trains[held]["mechanism"]
    files = parts(client, trains[held]["place"])
    rows = bill(files)
    teeth = mechanism["teeth"]
    away = 0.5 * (teeth["sun"] + teeth["planet"])
    assert rows["gear_planet"]["quantity"] == "3"
    pins = centres(cut(files, "base" if held == "carrier" else "carrier"))
    middle = sum(pins) / len(pins)
    around = [pin for pin in pins if abs(abs(pin - middle) - away) < 1e-6]
    if held != "carrier":
        assert len(around) == 3
    apart = [abs(a - b) for n, a in enumerate(pins) for b in pins[n + 1 :]]
    assert sum(abs(one - math.sqrt(3.0) * away) < 1e-9 for one in apart) == 3
    ring = rows["gear_ring"]
    assert "contour" in ring["holes"]
    assert ring["holes"].startswith("4 x") == (held == "ring")
    assert ("web_ring" in rows) == (held != "ring")
    assert f"The {held} is fixed" in files["README.txt"].decode()
    # A held sun is keyed to its plate, so that one key more is needed.
    keys = sum(int(row["quantity"]) for name, row in rows.items() if name.startswith("key"))
    assert keys == 2 + (held == "sun")


@pytest.mark.campaign
def test_a_long_planet_goes_through_both_planes_with_nothing_between(client: Any) -> None:
    problem = {"kind": "planetary_train", "ratio": 3, "arrangement": "ravigneaux", "input": "sun_small",
               "output": "ring", "fixed": "carrier", "max_designs": 1}  # fmt: skip
    files = parts(client, f"/v1/jobs/{finished(client, problem)['id']}/designs/0", bore=6, face_width=6)
    rows = bill(files)
    assert rows["gear_planet_long"]["quantity"] == rows["gear_planet_short"]["quantity"] == "3"
    assert float(rows["gear_planet_long"]["thickness"]) > 2 * float(rows["gear_planet_short"]["thickness"]) == 12.0


@pytest.mark.campaign
def test_the_face_width_of_a_plane_is_that_of_the_answer(client: Any) -> None:
    stage = {"type": "helical", "helix_angle": 15.0, "face_width": 21.0}
    job = finished(client, {"kind": "gear_train", "ratio": "2", "stages": [stage], "max_designs": 1})
    rows = bill(parts(client, f"/v1/jobs/{job['id']}/designs/0"))
    assert rows["gear_1_driver"]["thickness"] == rows["gear_1_driven"]["thickness"] == "21"


@pytest.mark.slow
def test_a_ring_and_its_web_are_two_sheets_with_pins_through_the_rim(client: Any) -> None:
    job = finished(client, {"kind": "gear_train", "ratio": "3", "stages": [{"type": "internal"}], "max_designs": 1})
    place = f"/v1/jobs/{job['id']}/designs/0"
    files = parts(client, place)
    ring, web = (centres(cut(files, name)) for name in ("gear_1_driven", "web_1_driven"))
    # The outer edge of both, and the pins.
    assert len(ring) == len(web) == 7
    assert np.allclose(ring, web, rtol=0.0, atol=1e-9)


def test_trains_that_are_not_built_are_refused_with_the_reason(client: Any) -> None:
    for problem, words in (
        (
            {"kind": "planetary_train", "ratio": "-1", "arrangement": "bevel_differential", "max_designs": 1},
            "one carrier",
        ),
    ):
        job = finished(client, problem)
        answer = refused(client, f"/v1/jobs/{job['id']}/designs/0", 409)
        assert words in answer["detail"]


@pytest.mark.slow
def test_trains_in_series_stand_between_two_plates(client: Any) -> None:
    unit = {"type": "gear_train", "max_stages": 1, "teeth": {"min": 18, "max": 60}}
    job = finished(
        client, {"kind": "train_series", "ratio": 6, "units": [{**unit, "module": 1.5}, unit], "max_designs": 1}
    )
    design = job["result"]["designs"][0]
    files = parts(client, f"/v1/jobs/{job['id']}/designs/0", bore=6)
    rows = bill(files)
    for number, mechanism in enumerate(design["mechanism"]["units"], 1):
        stage = mechanism["stages"][0]
        for role in ("driver", "driven"):
            tip = stage["module"] * (stage[role] + 2)
            assert float(rows[f"gear_{number}_{role}"]["length"]) == pytest.approx(tip, rel=0.01)
    places = centres(cut(files, "base"))
    apart = [abs(a - b) for n, a in enumerate(places) for b in places[n + 1 :]]
    for metrics in design["metrics"]["units"]:
        assert min(abs(one - metrics["centre_distances"][0]) for one in apart) < 1e-9


@pytest.mark.campaign
def test_a_layshaft_gearbox_has_its_first_gear_keyed_and_the_others_free(client: Any) -> None:
    job = finished(
        client, {"kind": "layshaft_gearbox", "ratios": [3.5, 2.1, 1.4], "reverse": 3.3, "module": 3.0,
                 "teeth": {"min": 14, "max": 60}, "tooth_sum": {"min": 50, "max": 70}, "max_designs": 1}
    )  # fmt: skip
    mechanism = job["result"]["designs"][0]["mechanism"]
    place = f"/v1/jobs/{job['id']}/designs/0"
    rows = bill(parts(client, place, face_width=20))
    for number, pair in enumerate(mechanism["gears"], 1):
        holes = rows[f"gear_{number}_main"]["holes"]
        assert holes.startswith("bore with keyway" if number == 1 else "1 x")
        assert rows[f"gear_{number}_layshaft"]["holes"].startswith("bore with keyway")
        tip = 3.0 * (pair["layshaft"] + 2)
        assert float(rows[f"gear_{number}_layshaft"]["length"]) == pytest.approx(tip, rel=0.01)
    assert rows["gear_head_input"]["thickness"] == "20"
    assert "gear_reverse_idler" in rows


def assembled(client: Any, problem: dict[str, Any]) -> tuple[str, dict[str, Any], dict[str, Any]]:
    """Where a design is, itself, and its assembly at nine inputs."""
    job = finished(client, problem)
    place = f"/v1/jobs/{job['id']}/designs/0"
    answer = client.get(f"{place}/assembly", params={"positions": 9})
    assert answer.status_code == 200, answer.text
    return place, job["result"]["designs"][0], answer.json()


def axis(view: dict[str, Any], link: str) -> tuple[np.ndarray, np.ndarray, float]:
    """A point and the direction of a shaft's axis, and how fast it turns over the input."""
    carrier = next(one for one in view["carriers"] if one["link"] == link)
    (origin,), (normal,) = carrier["frame"]["origins"], carrier["frame"]["normals"]
    turned = np.diff(carrier["angles"]) / np.diff(view["input"]["values"])
    assert np.ptp(turned) < 1e-9
    return np.array(origin), np.array(normal), float(turned[0])


@pytest.mark.campaign
def test_a_worm_crosses_under_its_gear_at_the_centre_distance(client: Any) -> None:
    place, design, view = assembled(client, WORM)
    (one, along, first), (other, across, second) = axis(view, "shaft_1"), axis(view, "shaft_2")
    between = np.cross(along, across)
    assert along @ across == pytest.approx(0.0, abs=1e-12)
    assert (other - one) @ between == pytest.approx(design["metrics"]["centre_distances"][0], rel=1e-9)
    # About d × w, d from the worm to its gear: a left-handed worm turns it backwards.
    assert across == pytest.approx(np.cross(other - one, along) / np.linalg.norm(other - one))
    assert (first, second) == (pytest.approx(1.0), pytest.approx(-2.0 / 40.0))
    files = parts(client, place)
    rows = bill(files)
    tips = 1.5 * (10 + 2), 1.5 * (40 + 2)
    assert float(rows["worm_1_driver"]["width"]) == pytest.approx(tips[0], abs=1e-3)
    assert float(rows["gear_1_driven"]["width"]) == pytest.approx(tips[1], abs=1e-3)
    slots = [corners(one) for one in cut(files, "base").query("LWPOLYLINE")]
    assert len(slots) == 5  # the edge, and a slot for each bearing plate
    assert len(cut(files, "base").query("CIRCLE")) == 4
    assert "lead angle 11.31°, left-handed" in files["README.txt"].decode()
    picture = client.get(f"{place}/assembly.svg")
    assert picture.status_code == 200
    assert picture.text.startswith("<svg")


@pytest.mark.slow
def test_bevel_gears_meet_at_the_apex_with_true_teeth(client: Any) -> None:
    place, design, view = assembled(client, BEVELS)
    (one, along, first), (other, away, second) = axis(view, "shaft_1"), axis(view, "shaft_2")
    # Both axes go through the apex; the driven gear's leads away from there.
    assert np.allclose(one, other)
    assert -(along @ away) == pytest.approx(math.cos(math.radians(75.0)))
    assert (first, second) == (pytest.approx(1.0), pytest.approx(2.0 / 3.0))
    mesh = design["metrics"]["meshes"][0]
    for role in ("driver", "driven"):
        gear = next(part for part in view["parts"] if part["name"] == f"gear_1_{role}")
        teeth, *_ = gear["shapes"]
        assert {"form": teeth["form"], "hub": gear["shapes"][1]["form"]} == {"form": "mesh", "hub": "prism"}
        places = np.array(teeth["corners"])
        edges = [tuple(sorted(pair)) for a, b, c in teeth["triangles"] for pair in ((a, b), (b, c), (c, a))]
        assert all(edges.count(edge) == 2 for edge in edges[:60])
        # No point is farther from the apex's axis than the tip cone, and the tips are as high as full depth says.
        gamma = math.radians(mesh["cone_angle"][role])
        cone = np.arctan2(np.hypot(places[:, 0], places[:, 1]), np.abs(places[:, 2]))
        assert cone.max() == pytest.approx(gamma + math.atan(2.0 / mesh["cone_distance"]), abs=1e-5)
        count = design["mechanism"]["stages"][0][role]
        tips = places[cone > cone.max() - 1e-6]
        turns = np.cos(count * np.angle(tips[:, 0] + 1j * tips[:, 1]))
        # Where they mesh, the driver has the middle of a tooth and the driven gear that of a space.
        assert (turns > 0.0).all() if role == "driver" else (turns < 0.0).all()
    told = parts(client, place)["README.txt"].decode()
    assert f"pitch cone {mesh['cone_angle']['driver']:.4f}°" in told
    assert "mounting distance" in told


def test_bevel_teeth_are_half_of_the_cone_distance_wide_at_most(client: Any) -> None:
    job = finished(client, BEVELS)
    (fault,) = refused(client, f"/v1/jobs/{job['id']}/designs/0", 422, face_width=40)["errors"]
    assert fault["path"] == "/query/face_width"
    assert "half the cone distance" in fault["detail"]


def test_crossing_stages_among_others_are_refused_with_the_reason(client: Any) -> None:
    stages = [{"type": "bevel", "driver": 20, "driven": 30}, {"type": "external"}]
    job = finished(client, {"kind": "gear_train", "ratio": 3, "stages": stages, "max_designs": 1})
    assert "single-stage trains" in refused(client, f"/v1/jobs/{job['id']}/designs/0", 409)["detail"]


@pytest.mark.slow
def test_the_axles_of_a_ravigneaux_set_are_as_thick_as_its_sun_lets_them(client: Any) -> None:
    problem = {"kind": "planetary_train", "ratio": -4, "arrangement": "ravigneaux", "fixed": "ring", "max_designs": 1}
    place = f"/v1/jobs/{finished(client, problem)['id']}/designs/0"
    (fault,) = refused(client, place, 422, bore=3)["errors"]
    assert fault["path"] == "/query/bore"
    assert "passes the sun large at 1.5 mm from its axis" in fault["detail"]
    (fault,) = refused(client, place, 422, scale=0.1)["errors"]
    assert fault["path"] == "/query/scale"
    words = fault["detail"].split()
    rows = bill(parts(client, place, scale=float(words[words.index("scale") + 1])))
    assert rows["gear_planet_short"]["quantity"] == rows["gear_planet_long"]["quantity"] == "3"
