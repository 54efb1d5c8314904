"""The assembly of a design for who shows it: shapes as its files have them, places as the analysis does, pictures."""

from __future__ import annotations

import io
from itertools import pairwise
from typing import Any
from xml.etree import ElementTree

import ezdxf
import httpx
import numpy as np
import pytest

from service.parts.export.cad_available import is_installed
from service.parts.export.viewer_schema import AssemblyView
from synthesis.registry import list_examples
from tests.support.service.answers import SVG, finished
from tests.support.service.parts import DRIVEN, MOTION, SIZES, SLIDER, parts, refused

CASES = {"fourbar": MOTION, "slider": SLIDER, "driven": DRIVEN}


@pytest.fixture(scope="module")
def jobs(server: Any) -> dict[str, Any]:
    """The jobs by name."""
    return {name: finished(server.client, problem) for name, problem in CASES.items()}


def place(job: Any) -> str:
    return f"/v1/jobs/{job['id']}/designs/0"


def seen(client: httpx.Client, job: Any, **query: Any) -> Any:
    answer = client.get(f"{place(job)}/assembly", params=query)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "application/json"
    AssemblyView.model_validate_json(answer.content)
    return answer.json()


def outline(edge: Any) -> tuple[str, Any]:
    """An outline of the answer with what of it does not depend on where it lies."""
    if edge["form"] == "circle":
        return "circle", edge["radius"]
    corners = np.array(edge["corners"]) @ (1.0, 1j)
    return "loop", sorted(np.abs(np.diff(corners, append=corners[0])))


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_the_shapes_are_those_that_are_cut(client: Any, jobs: Any, name: str) -> None:
    answer, files = seen(client, jobs[name], **SIZES), parts(client, place(jobs[name]), **SIZES)
    cut = [part for part in answer["parts"] if "dxf" in part["files"]]
    assert {f"dxf/{part['item']}.dxf" for part in cut} == {name for name in files if name.endswith(".dxf")}
    for part in cut:
        (shape,) = part["shapes"]
        space = ezdxf.read(io.StringIO(files[f"dxf/{part['item']}.dxf"].decode())).modelspace()
        drawn = [("circle", circle.dxf.radius) for circle in space.query("CIRCLE")]
        for line in space.query("LWPOLYLINE"):
            points = np.array([complex(x, y) for x, y, _ in line.get_points("xyb")])
            drawn.append(("loop", sorted(np.abs(np.diff(points, append=points[0])))))
        told = [outline(edge) for edge in (shape["outer"], *shape["holes"])]
        for (form, value), (kind, size) in zip(sorted(told, key=str), sorted(drawn, key=str), strict=True):
            assert form == kind
            assert value == pytest.approx(size, rel=1e-9)
        assert shape["high"] - shape["low"] == pytest.approx(SIZES["thickness"])


def test_holes_lie_as_far_apart_as_the_joints_of_the_design(client: Any, jobs: Any) -> None:
    skeleton = jobs["fourbar"]["result"]["designs"][0]["mechanism"]["skeleton"]
    answer = seen(client, jobs["fourbar"], **SIZES, scale=2.0)
    assert (answer["unit"], answer["scale"]) == (2.0, 2.0)
    by_name = {part["name"]: part for part in answer["parts"]}
    for link in skeleton["links"]:
        joints = np.array([skeleton["joints"][joint] for joint in link["joints"]])
        (shape,) = by_name["base" if link["name"] == "ground" else f"link_{link['name']}"]["shapes"]
        holes = np.array([hole["centre"] for hole in shape["holes"]])
        apart = [np.sort(np.hypot(*(z[:, None] - z).reshape(-1, 2).T)) for z in (2.0 * joints, holes)]
        np.testing.assert_allclose(apart[0], apart[1], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", CASES)
def test_parts_are_where_the_analysis_has_them(client: Any, jobs: Any, name: str) -> None:
    """Holes of links, and pins, moved as the answer says, lie on the joints that `POST /v1/analyses` gives."""
    design = jobs[name]["result"]["designs"][0]
    answer = seen(client, jobs[name], **SIZES, positions=5)
    skeleton = design["mechanism"]["skeleton"]
    links = {f"link_{link['name']}": link["joints"] for link in skeleton["links"]}
    looked_at = 0
    for k, value in enumerate(answer["input"]["values"]):
        analysed = client.post("/v1/analyses", json={"mechanism": design["mechanism"], "motion": {"at": value}})
        assert analysed.status_code == 200, analysed.text
        tracks = analysed.json()["joints"]
        joints = {one: complex(track["x"][0], track["y"][0]) for one, track in tracks.items()}
        for part in answer["parts"]:
            carrier = answer["carriers"][part["carrier"]]
            turn = np.exp(1j * np.radians(carrier["angles"][k]))
            at, pivot = complex(*carrier["places"][k]), complex(*carrier["pivot"])
            if part["sort"] == "pin":
                (centre,) = {tuple(shape["outer"]["centre"]) for shape in part["shapes"]}
                moved, on = [at + turn * (complex(*centre) - pivot)], [part["described"].removeprefix("pin ")]
            elif part["name"] in links:
                (shape,) = part["shapes"]
                holes = [hole["centre"] for hole in shape["holes"] if hole["form"] == "circle"]
                moved, on = [at + turn * (complex(*hole) - pivot) for hole in holes], links[part["name"]]
            else:
                continue
            looked_at += len(moved)
            assert all(min(abs(z - joints[joint]) for joint in on) < 1e-6 for z in moved), (part["name"], k)
    assert looked_at >= 5 * (len(links) - 1)


def test_a_follower_goes_as_its_cam_is_analysed_to_lift_it(client: Any) -> None:
    job = finished(client, list_examples("cam")[0])
    answer = seen(client, job, positions=12)
    assert answer["input"]["values"] == pytest.approx([30.0 * k for k in range(12)])
    lift = client.get(f"{place(job)}/motion", params={"steps": 12}).json()["follower"]["position"][:12]
    follower = next(part for part in answer["parts"] if part["name"] == "follower")
    places = np.array(answer["carriers"][follower["carrier"]]["places"]) @ (1.0, 1j)
    assert np.abs(places - places[0]) == pytest.approx(np.abs(np.array(lift) - lift[0]), abs=1e-6)
    cam = next(part for part in answer["parts"] if part["sort"] == "cam")
    assert np.abs(np.diff(answer["carriers"][cam["carrier"]]["angles"])) == pytest.approx(np.full(11, 30.0))


def test_angles_have_no_jumps_and_a_cycle_comes_back(client: Any, jobs: Any) -> None:
    answer = seen(client, jobs["slider"], **SIZES, over="cycle")
    assert (answer["input"]["closed"], answer["input"]["endless"]) == (True, False)
    assert len(answer["input"]["values"]) == 72
    for carrier in answer["carriers"]:
        assert np.abs(np.diff(carrier["angles"])).max() < 90.0
    crank = next(one for one in answer["carriers"] if one["link"] == "crank")
    assert abs(crank["angles"][-1] - crank["angles"][0]) == pytest.approx(355.0)
    assert np.ptp(np.array(crank["places"]), axis=0) == pytest.approx([0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize(
    ("field", "value", "name"),
    [
        ("width", 16, "fourbar"), ("pin", 4, "fourbar"), ("thickness", 6, "fourbar"), ("clearance", 0.1, "fourbar"),
        ("shafts", "both_sides", "fourbar"), ("over", "cycle", "slider"), ("scale", 1.5, "fourbar"),
        ("process", "print", "fourbar"),
    ],
)  # fmt: skip
def test_every_field_counts(client: Any, jobs: Any, field: str, value: Any, name: str) -> None:
    base = {**SIZES, "process": "laser", "shafts": "one_side", "over": "used", "scale": 1.0, "positions": 3}
    one, other = (seen(client, jobs[name], **query) for query in (base, base | {field: value}))
    assert one != other
    plates = [next(part for part in answer["parts"] if part["sort"] == "link") for answer in (one, other)]
    (shape,), (changed,) = (plate["shapes"] for plate in plates)
    if field == "width":
        assert max(changed["outer"]["corners"]) != max(shape["outer"]["corners"])
    if field in ("pin", "clearance"):
        assert changed["holes"][0]["radius"] == pytest.approx({"pin": 2.2, "clearance": 2.6}[field])
    if field == "thickness":
        assert changed["high"] - changed["low"] == pytest.approx(6.0)
    if field == "shafts":
        assert (one["bases"], other["bases"]) == (1, 2)
    if field == "over":
        assert (one["input"]["closed"], other["input"]["closed"]) == (False, True)
    if field == "process":
        assert {part["material"] for part in other["parts"]} == {"PETG"}


def test_as_many_positions_as_are_asked_for(client: Any, jobs: Any) -> None:
    for positions in (1, 7):
        answer = seen(client, jobs["fourbar"], **SIZES, positions=positions)
        assert len(answer["input"]["values"]) == positions
        assert {len(one["angles"]) for one in answer["carriers"]} == {positions}
        assert {len(one["places"]) for one in answer["carriers"]} == {positions}
        low, high = answer["input"]["low"], answer["input"]["high"]
        assert all(low <= value <= high for value in answer["input"]["values"])


@pytest.mark.parametrize(
    ("field", "value"),
    [("positions", 0), ("positions", 721), ("positions", "many"), ("width", -1), ("scale", 0), ("input_angle", 3.0)],
)
def test_bad_values_are_refused_by_their_path(client: Any, jobs: Any, field: str, value: Any) -> None:
    answer = client.get(f"{place(jobs['fourbar'])}/assembly", params={**SIZES, field: value})
    assert answer.status_code == 422
    assert [fault["path"] for fault in answer.json()["errors"]] == [f"/query/{field}"]


@pytest.mark.slow
def test_what_leaves_no_room_is_refused_with_the_scale_that_works(client: Any, jobs: Any) -> None:
    answer = client.get(f"{place(jobs['fourbar'])}/assembly", params={"width": 60})
    (fault,) = answer.json()["errors"]
    assert (answer.status_code, fault["path"]) == (422, "/query/width")
    words = fault["detail"].split()
    assert seen(client, jobs["fourbar"], width=60, scale=float(words[words.index("scale") + 1]))
    assert refused(client, place(jobs["fourbar"]), 422, width=60)["errors"] == [fault]


def test_where_planes_are_drawn_apart_their_order_stays(client: Any, jobs: Any) -> None:
    answer = seen(client, jobs["fourbar"], **SIZES)
    plates = sorted((part for part in answer["parts"] if part["sort"] in ("base", "link")), key=lambda p: p["planes"])
    lifts = [part["lift"] for part in plates]
    assert all(b - a >= SIZES["thickness"] for a, b in pairwise(lifts))
    top = max(part["lift"] + max(shape["high"] for shape in part["shapes"]) for part in plates)
    for part in answer["parts"]:
        if part["sort"] == "pin":
            assert part["lift"] + min(shape["low"] for shape in part["shapes"]) > top


def test_a_single_part_is_the_one_in_the_zip(client: Any, jobs: Any) -> None:
    files = parts(client, place(jobs["fourbar"]), **SIZES)
    one = client.get(f"{place(jobs['fourbar'])}/parts/link_coupler.dxf", params=SIZES)
    assert one.status_code == 200
    assert one.headers["content-type"] == "image/vnd.dxf"
    assert one.content == files["dxf/link_coupler.dxf"]
    wider = client.get(f"{place(jobs['fourbar'])}/parts/link_coupler.dxf", params={**SIZES, "width": 16})
    assert wider.content != one.content
    for name, form in (("nothing", "dxf"), ("washer", "dxf"), ("link_coupler", "dwg")):
        answer = client.get(f"{place(jobs['fourbar'])}/parts/{name}.{form}", params=SIZES)
        assert answer.status_code == 404, answer.text
    for form in ("stl", "step", "3mf"):
        answer = client.get(f"{place(jobs['fourbar'])}/parts/link_coupler.{form}", params=SIZES)
        assert answer.status_code == (200 if is_installed() else 501), answer.text


@pytest.mark.cad
def test_a_single_solid_is_as_large_as_its_part(client: Any, jobs: Any) -> None:
    import trimesh

    answer = seen(client, jobs["fourbar"], **SIZES)
    for item in ("link_coupler", "washer"):
        at = f"{place(jobs['fourbar'])}/parts/{item}"
        part = next(part for part in answer["parts"] if part["item"] == item)
        mesh = trimesh.load_mesh(io.BytesIO(client.get(f"{at}.stl", params=SIZES).content), file_type="stl")
        assert mesh.is_watertight
        low, high = (end(shape[name] for shape in part["shapes"]) for end, name in ((min, "low"), (max, "high")))
        assert mesh.extents[2] == pytest.approx(high - low, abs=1e-6)
        assert client.get(f"{at}.3mf", params=SIZES).content[:2] == b"PK"
        assert b"AP242" in client.get(f"{at}.step", params=SIZES).content


def picture(client: httpx.Client, job: Any, **query: Any) -> str:
    answer = client.get(f"{place(job)}/assembly.svg", params=query)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "image/svg+xml"
    assert "sandbox" in answer.headers["content-security-policy"]
    return answer.text


def test_the_picture_shows_every_part_twice_and_where_it_is_asked_to(client: Any, jobs: Any) -> None:
    text = picture(client, jobs["fourbar"], **SIZES)
    assert parts(client, place(jobs["fourbar"]), **SIZES)["isometric.svg"].decode() == text
    root = ElementTree.fromstring(text)
    assert [panel.get("data-panel") for panel in root.iter(f"{SVG}g") if panel.get("data-panel")] == ["isometric"] * 2
    shown = [path.get("data-part") for path in root.iter(f"{SVG}path") if path.get("data-part")]
    answer = seen(client, jobs["fourbar"], **SIZES)
    assert {name: shown.count(name) >= 2 for name in (part["name"] for part in answer["parts"])} == dict.fromkeys(
        (part["name"] for part in answer["parts"]), True
    )
    assert len(text) < 600_000
    values = answer["input"]["values"]
    assert picture(client, jobs["fourbar"], **SIZES, input_angle=values[0]) != picture(
        client, jobs["fourbar"], **SIZES, input_angle=values[-1]
    )
    faults = client.get(f"{place(jobs['fourbar'])}/assembly.svg", params={**SIZES, "input_place": 1.0}).json()["errors"]
    assert [fault["path"] for fault in faults] == ["/query/input_place"]


@pytest.mark.slow
def test_a_report_shows_assemblies_where_they_are_asked_for(client: Any, jobs: Any) -> None:
    """As the picture that is had by itself; what cannot be built is told, and the rest of the report is there."""
    at = f"/v1/jobs/{jobs['fourbar']['id']}/report.html"
    plain, whole, none = (client.get(at, params=query).text for query in ({}, {"assemblies": True}, {"designs": 0}))
    assert 'data-panel="isometric"' not in plain + none
    drawing = picture(client, jobs["fourbar"])
    assert drawing[drawing.index("<svg") :] in whole
    assert whole.replace(drawing[drawing.index("<svg") :], "").count("<svg") == plain.count("<svg")
    narrow = {"kind": "quick_return", "time_ratio": 1.5, "stroke": 40.0, "max_designs": 1}
    told = client.get(f"/v1/jobs/{finished(client, narrow)['id']}/report.html", params={"assemblies": True}).text
    assert "<h3>Assembly</h3>" in told
    assert ("wide do not fit" in told) != ('data-panel="isometric"' in told)
    assert client.get(at, params={"assemblies": "perhaps"}).status_code == 422


def test_a_train_turns_its_gears_as_its_teeth_say_and_goes_on(client: Any) -> None:
    job = finished(client, {"kind": "gear_train", "ratio": "7/3", "max_stages": 1})
    answer = seen(client, job, positions=24)
    assert (answer["input"]["closed"], answer["input"]["endless"]) == (False, True)
    gears = {
        part["carrier"]: len(part["shapes"][0]["outer"]["corners"])
        for part in answer["parts"]
        if part["sort"] == "gear"
    }
    few, many = sorted(gears, key=gears.__getitem__)
    pinion, wheel = (np.array(answer["carriers"][k]["angles"]) for k in (few, many))
    assert np.diff(pinion) / np.diff(wheel) == pytest.approx(np.full(23, -7.0 / 3.0))
    turned = np.diff(answer["input"]["values"])
    assert np.abs(np.diff(pinion)) == pytest.approx(turned, rel=1e-9)
    text = picture(client, job)
    assert len(text) < 2_000_000
    assert "second base" in text
