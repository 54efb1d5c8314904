"""Parts of designs through HTTP: the zip, every field of the query, and what is refused."""

from __future__ import annotations

import io
from itertools import pairwise
from typing import Any

import ezdxf
import pytest

from service.parts.export.cad_available import is_installed
from tests.support.service.answers import finished
from tests.support.service.parts import DRIVEN, MOTION, SIZES, SLIDER, THREE, bill, parts, refused


@pytest.fixture(scope="module")
def jobs(server: Any) -> dict[str, str]:
    """The places of the first designs."""
    found = {}
    for name, problem in (("fourbar", MOTION), ("slider", SLIDER)):
        found[name] = f"/v1/jobs/{finished(server.client, problem)['id']}/designs/0"
    return found


@pytest.mark.slow
def test_the_zip_has_an_outline_of_each_plate_with_holes_where_the_joints_are(client: Any, jobs: Any) -> None:
    files = parts(client, jobs["fourbar"], **SIZES)
    skeleton = client.get(jobs["fourbar"].rsplit("/designs")[0]).json()["result"]["designs"][0]["mechanism"]["skeleton"]
    joints = {name: complex(*place) for name, place in skeleton["joints"].items()}
    for link in skeleton["links"]:
        name = "base" if link["name"] == "ground" else f"link_{link['name']}"
        document = ezdxf.read(io.StringIO(files[f"dxf/{name}.dxf"].decode()))
        assert not document.audit().has_errors
        assert document.units == ezdxf.units.MM
        holes = list(document.modelspace().query("CIRCLE"))
        assert {circle.dxf.radius for circle in holes} == {2.7}
        places = [complex(circle.dxf.center.x, circle.dxf.center.y) for circle in holes]
        found = sorted(abs(a - b) for a, b in pairwise([*places, places[0]]))
        stated = [joints[joint] for joint in link["joints"]]
        expected = sorted(abs(a - b) for a, b in pairwise([*stated, stated[0]]))
        assert found == pytest.approx(expected, rel=1e-9)
        (outline,) = document.modelspace().query("LWPOLYLINE")
        assert outline.closed
        low = min(y for _, y, *_ in outline.get_points("xyb"))
        assert low == pytest.approx(0.0, abs=7.5)


@pytest.mark.slow
def test_the_bill_names_what_is_bought_by_its_standard(client: Any, jobs: Any) -> None:
    rows = bill(parts(client, jobs["fourbar"], **SIZES))
    assert {"base", "link_input", "link_coupler", "link_output"} <= rows.keys()
    assert rows["link_input"]["thickness"] == "4"
    assert rows["link_input"]["width"] == "15"
    assert rows["washer"]["standard"] == "ISO 7089 - 5"
    assert rows["ring"]["standard"] == "DIN 471 - 5 x 0.6"
    assert rows["ring"]["quantity"] == "8"
    assert {row["standard"] for name, row in rows.items() if name.startswith("pin")} == {"EN 10278 - 5 h9"}
    assert rows["link_coupler"]["holes"] == "3 x 5.4"


@pytest.mark.parametrize(
    ("field", "value", "name"),
    [
        ("width", 16, "fourbar"),
        ("pin", 4, "fourbar"),
        ("thickness", 6, "fourbar"),
        ("clearance", 0.1, "fourbar"),
        ("shafts", "both_sides", "fourbar"),
        ("over", "cycle", "slider"),
        ("scale", 1.5, "fourbar"),
        ("process", "print", "fourbar"),
    ],
)
def test_every_field_of_the_query_counts(client: Any, jobs: Any, field: str, value: Any, name: str) -> None:
    base = {**SIZES, "process": "laser", "shafts": "one_side", "over": "used", "scale": 1.0}
    if field == "process" and not is_installed():
        assert refused(client, jobs[name], 501, **(base | {field: value}))["type"] == "/problems/no-cad"
        return
    files, others = parts(client, jobs[name], **base), parts(client, jobs[name], **(base | {field: value}))
    assert files["bom.csv"] != others["bom.csv"]
    rows, changed = bill(files), bill(others)
    if field == "width":
        assert changed["link_input"]["width"] == "16"
    if field == "pin":
        assert changed["link_input"]["holes"] == "2 x 4.4"
    if field == "thickness":
        assert changed["link_input"]["thickness"] == "6"
    if field == "clearance":
        assert changed["link_input"]["holes"] == "2 x 5.2"
    if field == "shafts":
        assert "second_base" in changed
        assert "second_base" not in rows
    if field == "over":
        assert float(changed["base"]["length"]) > float(rows["base"]["length"])
    if field == "scale":
        length = float(rows["link_input"]["length"]) - 15.0
        assert float(changed["link_input"]["length"]) - 15.0 == pytest.approx(1.5 * length, abs=2e-3)


@pytest.mark.parametrize(("field", "value"), [("bore", 5.0), ("face_width", 5.0)])
def test_fields_of_gears_are_none_of_linkages(client: Any, jobs: Any, field: str, value: Any) -> None:
    answer = refused(client, jobs["fourbar"], 422, **(SIZES | {field: value}))
    assert [fault["path"] for fault in answer["errors"]] == [f"/query/{field}"]


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("width", -1), ("width", "nan"), ("width", 1e7), ("width", 6), ("pin", 0), ("pin", 0.1), ("pin", "inf"),
        ("thickness", 0), ("thickness", 0.01), ("thickness", 1e5), ("clearance", 0), ("clearance", 1e-9),
        ("clearance", 2.0), ("shafts", "three"), ("over", "all"), ("scale", 0), ("scale", 1e5),
        ("process", "cast"), ("colour", "red"),
    ],
)  # fmt: skip
def test_bad_values_are_refused_by_their_path(client: Any, jobs: Any, field: str, value: Any) -> None:
    answer = refused(client, jobs["fourbar"], 422, **(SIZES | {field: value}))
    assert [fault["path"] for fault in answer["errors"]] == [f"/query/{field}"]


@pytest.mark.slow
def test_too_wide_links_are_refused_with_the_scale_that_works(client: Any, jobs: Any) -> None:
    answer = refused(client, jobs["fourbar"], 422, width=60)
    (fault,) = answer["errors"]
    assert fault["path"] == "/query/width"
    words = fault["detail"].split()
    scale = float(words[words.index("scale") + 1])
    width = float(words[words.index("width") + 2])
    assert parts(client, jobs["fourbar"], width=60, scale=scale)
    assert refused(client, jobs["fourbar"], 422, width=60, scale=0.97 * scale)
    assert width == pytest.approx(60.0 / scale, rel=0.01)


@pytest.mark.slow
def test_a_mechanism_of_unit_size_is_refused_with_a_scale(client: Any) -> None:
    tiny = {"kind": "motion", "max_designs": 1, "length_unit": "mm",
            "positions": [{"x": 0.01 * p["x"], "y": 0.01 * p["y"], "angle": p["angle"]} for p in THREE]}  # fmt: skip
    place = f"/v1/jobs/{finished(client, tiny)['id']}/designs/0"
    (fault,) = refused(client, place, 422)["errors"]
    assert fault["path"] == "/query/scale"
    words = fault["detail"].split()
    assert parts(client, place, scale=float(words[words.index("scale") + 1]))


def test_blocks_and_slots_of_slides(client: Any, jobs: Any) -> None:
    rows = bill(parts(client, jobs["slider"], **SIZES))
    # A block leaves a quarter of its pin beside the hole, and a slot the clearance beside the block.
    assert rows["block_b"]["width"] == "7.9"
    assert "slot 8.3 x" in rows["base"]["holes"]


def test_without_the_extra_there_are_outlines_alone(client: Any, jobs: Any) -> None:
    files = parts(client, jobs["fourbar"], **SIZES)
    assert ("assembly.step" in files) == is_installed()
    assert (b"without its extra" in files["README.txt"]) != is_installed()
    for form in ("step", "glb"):
        assert client.get(f"{jobs['fourbar']}.{form}").status_code == (200 if is_installed() else 501)


def test_there_are_no_parts_of_no_design(client: Any, jobs: Any) -> None:
    assert client.get(f"{jobs['fourbar'][:-1]}7/parts").status_code == 404


@pytest.mark.slow
def test_the_block_of_the_problem_says_what_is_left_out(client: Any) -> None:
    block = {"link_width": 18.0, "pin_diameter": 6.0, "thickness": 7.0, "shafts": "both_sides"}
    job = finished(client, {**MOTION, "layout": block})
    rows = bill(parts(client, f"/v1/jobs/{job['id']}/designs/0"))
    assert (rows["link_input"]["width"], rows["link_input"]["thickness"]) == ("18", "7")
    assert rows["link_input"]["holes"] == "2 x 6.2"
    assert "second_base" in rows


@pytest.mark.cad
@pytest.mark.parametrize(
    ("name", "problem", "field", "other"),
    [("crank", MOTION, "input_angle", "input_place"), ("slide", DRIVEN, "input_place", "input_angle")],
)
def test_an_assembly_stands_where_it_is_asked_to(client: Any, name: str, problem: Any, field: str, other: str) -> None:
    """Files of the same input are alike, those of two inputs are not."""
    job = finished(client, problem)
    place = f"/v1/jobs/{job['id']}/designs/0"
    inputs = [target[field] for target in job["result"]["designs"][0]["targets"]]

    def shown(form: str, **query: Any) -> bytes:
        answer = client.get(f"{place}.{form}", params=query)
        assert answer.status_code == 200, answer.text
        return bytes(answer.content)

    at = [shown("glb", **{field: value}) for value in (inputs[0], inputs[-1])]
    for off in (-1e-11, 1e-11):  # these inputs are the ends of the range, and who states them has rounded them
        shown("glb", **{field: inputs[0] + off})
        shown("glb", **{field: inputs[-1] + off})
    assert shown("glb", **{field: inputs[0]}) == at[0]
    assert at[0] != at[1]
    assert shown("step", **{field: inputs[0]}) != shown("step", **{field: inputs[-1]})
    for query, path in (({other: 1.0}, f"/query/{other}"), ({field: 1e12}, f"/query/{field}")):
        answer = client.get(f"{place}.glb", params=query)
        assert answer.status_code == 422, answer.text
        assert [error["path"] for error in answer.json()["errors"]] == [path]


@pytest.mark.cad
@pytest.mark.parametrize(("field", "value"), [("width", 16), ("pin", 4), ("thickness", 6), ("clearance", 0.1),
                                              ("shafts", "both_sides"), ("scale", 1.5)])  # fmt: skip
def test_every_field_counts_in_an_assembly(client: Any, jobs: Any, field: str, value: Any) -> None:
    base = {**SIZES, "shafts": "one_side", "over": "used", "scale": 1.0}
    files = [client.get(f"{jobs['fourbar']}.glb", params=query) for query in (base, base | {field: value})]
    assert [file.status_code for file in files] == [200, 200]
    assert files[0].content != files[1].content
