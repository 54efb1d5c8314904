"""Parts of cams and indexing drives through HTTP: contours, slots and teeth, every field, and what is refused."""

from __future__ import annotations

import io
import math
from typing import Any

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.math import bulge_center

from kinematics.cam.finished.contact import Contour
from service.parts.assembly.interference import find_thin_walls
from service.parts.assembly.sizes import MIN_WALL_PER_PIN, Sizes
from service.parts.cam.contours import fit_outline
from service.parts.cam.radial import CamBuilder, CamPlanes
from service.parts.export.cad_available import is_installed
from service.parts.registry import NotMade
from synthesis.analyses.cams.cam import CamAnalysisRequest
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.support.service.answers import finished
from tests.support.service.parts import bill, parts, refused
from tests.support.service.parts_of_cams import DRIVE, PROBLEMS

SIZES = {"width": 16, "pin": 6, "thickness": 4, "clearance": 0.1, "process": "laser", "scale": 1.0}
THIN = {"pin": 4, "width": 10}
"""Pins that a roller of 12 and a wheel of a ratchet have room for."""


class Jobs:
    """Places and mechanisms of the first designs, each solved when it is first asked for."""

    def __init__(self, client: Any) -> None:
        self._client, self._found = client, {}  # type: Any, dict[str, tuple[str, dict[str, Any]]]

    def __getitem__(self, name: str) -> tuple[str, dict[str, Any]]:
        if name not in self._found:
            job = finished(self._client, PROBLEMS[name])
            mechanism = job["result"]["designs"][0]["mechanism"]
            self._found[name] = f"/v1/jobs/{job['id']}/designs/0", mechanism
        return self._found[name]


@pytest.fixture(scope="module")
def jobs(server: Any) -> Jobs:
    """The designs of this file."""
    return Jobs(server.client)


def drawn(files: dict[str, bytes], name: str) -> Any:
    document = ezdxf.read(io.StringIO(files[f"dxf/{name}.dxf"].decode()))
    assert not document.audit().has_errors
    assert document.units == ezdxf.units.MM
    return document.modelspace()


def bored(space: Any) -> tuple[complex, float]:
    """Centre and radius of the bore with a keyway."""
    for line in space.query("LWPOLYLINE"):
        points = list(line.get_points("xyb"))
        arcs = [k for k, (*_, bulge) in enumerate(points) if bulge]
        if len(points) == 4 and len(arcs) == 1:
            start, end = points[arcs[0]], points[(arcs[0] + 1) % 4]
            centre = bulge_center(start[:2], end[:2], start[2])
            return complex(centre.x, centre.y), math.dist((centre.x, centre.y), start[:2])
    raise AssertionError("there is no bore")


def contour(space: Any) -> np.ndarray:
    """Points of the spline of a drawing."""
    (spline,) = space.query("SPLINE")
    curve = spline.construction_tool()
    points = np.array([(p.x, p.y) for p in curve.points(np.linspace(0.0, curve.max_t, 1081)[:-1])])
    return np.asarray(points[:, 0] + 1j * points[:, 1])


def analysed(mechanism: dict[str, Any], points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cam angles, and what the follower does on a contour by its points alone."""
    given = {name: mechanism[name] for name in ("type", "follower", "rotation", "prime_radius", "base_radius")
             if mechanism.get(name) is not None}  # fmt: skip
    given["profile"] = {"x": points.real.tolist(), "y": points.imag.tolist()}
    answer = CamAnalysisRequest.model_validate({"mechanism": given}).build_answer()
    return np.array(answer["input_angle"]), np.array(answer["follower"]["position"])


@pytest.mark.slow
@pytest.mark.parametrize("name", further(["roller", "arm", "flat", "flat_arm", "conjugate"], ["roller", "flat_arm"]))
def test_a_follower_on_the_contour_that_is_cut_does_what_the_program_says(client: Any, jobs: Any, name: str) -> None:
    """The analysis lays the follower against points of the drawing's spline."""
    place, mechanism = jobs[name]
    files = parts(client, place, **SIZES)
    space = drawn(files, "cam_1" if name == "conjugate" else "cam")
    centre, radius = bored(space)
    assert radius == pytest.approx(3.1, abs=1e-9)
    at, s = analysed(mechanism, contour(space) - centre)
    program = mechanism["program"]
    expected = np.interp(at, [*program["angle"], 360.0], [*program["s"], program["s"][0]])
    # Millimetres, or degrees of an arm that is as long as that a contour is off by some of its thousandths.
    assert np.abs(s - expected).max() < 2e-3


@pytest.mark.slow
def test_a_groove_is_wider_than_its_roller_by_the_clearance(client: Any, jobs: Any) -> None:
    place, mechanism = jobs["groove"]
    files = parts(client, place, **SIZES)
    centre, _ = bored(drawn(files, "cam"))
    inner = contour(drawn(files, "cam")) - centre
    space = drawn(files, "cam_wall")
    (outside,) = (circle for circle in space.query("CIRCLE") if circle.dxf.radius > 20.0)
    outer = contour(space) - complex(outside.dxf.center.x, outside.dxf.center.y)
    walls = [shapely.LinearRing(np.column_stack([line.real, line.imag])) for line in (inner, outer)]
    for x, y in zip(mechanism["pitch_curve"]["x"][::20], mechanism["pitch_curve"]["y"][::20], strict=True):
        for wall in walls:
            assert wall.distance(shapely.Point(x, y)) == pytest.approx(10.1, abs=3e-3)


def test_a_geneva_wheel_has_slots_for_its_roller_and_arcs_for_its_disc(client: Any, jobs: Any) -> None:
    place, mechanism = jobs["external"]
    files = parts(client, place, **(SIZES | THIN))
    wheel, disc = drawn(files, "wheel"), drawn(files, "locking_disc")
    points = max(([*line.get_points("xyb")] for line in wheel.query("LWPOLYLINE")), key=len)
    ends = [bulge for *_, bulge in points if bulge == pytest.approx(-1.0)]
    assert len(ends) == mechanism["stations"] == 5
    for k, (x, y, bulge) in enumerate(points):
        if bulge == pytest.approx(-1.0):
            assert math.dist((x, y), points[(k + 1) % len(points)][:2]) == pytest.approx(12.2, abs=1e-9)
    around = max(([*line.get_points("xyb")] for line in disc.query("LWPOLYLINE")), key=len)
    centre, _ = bored(disc)
    far = max(abs(complex(x, y) - centre) for x, y, _ in around)
    assert far == pytest.approx(mechanism["locking_arc_radius"] - 0.1, abs=1e-9)
    shafts = [complex(c.dxf.center.x, c.dxf.center.y) for c in drawn(files, "base").query("CIRCLE")]
    assert abs(shafts[0] - shafts[1]) == pytest.approx(mechanism["center_distance"], rel=1e-12)


def test_a_ratchet_has_its_teeth_and_pawls_on_their_pivots(client: Any, jobs: Any) -> None:
    place, mechanism = jobs["ratchet"]
    files = parts(client, place, **(SIZES | THIN))
    space = drawn(files, "wheel")
    centre, radius = bored(space)
    assert radius == pytest.approx(10.1)
    (teeth,) = (line for line in space.query("LWPOLYLINE") if len(line) > 4)
    far = [abs(complex(x, y) - centre) for x, y in teeth.get_points("xy")]
    assert len(far) == 2 * mechanism["teeth"]
    assert max(far) == pytest.approx(mechanism["wheel_radius"], rel=1e-9)
    holes = [(c.dxf.radius, complex(c.dxf.center.x, c.dxf.center.y)) for c in drawn(files, "base").query("CIRCLE")]
    (shaft,) = (z for r, z in holes if r == pytest.approx(10.1))
    found = sorted(abs(z - shaft) for r, z in holes if r == pytest.approx(2.1))
    assert found == pytest.approx([math.hypot(*pawl["pivot"]) for pawl in mechanism["pawls"]], rel=1e-9)
    assert {"pawl_1", "pawl_2"} <= bill(files).keys()


CHANGED = [
    ("width", 20, ("follower", "width", "20")),
    ("pin", 5, ("follower", "holes", "3 x 5.2")),
    ("thickness", 6, ("cam", "thickness", "6")),
    ("clearance", 0.2, ("roller", "holes", "1 x 6.4")),
    ("scale", 1.5, ("roller", "width", "30")),
    ("process", "print", None),
]


@pytest.mark.parametrize(("field", "value", "cell"), CHANGED)
def test_every_field_counts_for_a_cam(client: Any, jobs: Any, field: str, value: Any, cell: Any) -> None:
    place, _ = jobs["roller"]
    if field == "process" and not is_installed():
        assert refused(client, place, 501, **(SIZES | {field: value}))["type"] == "/problems/no-cad"
        return
    rows, others = bill(parts(client, place, **SIZES)), bill(parts(client, place, **(SIZES | {field: value})))
    assert rows != others
    if cell:
        name, column, told = cell
        assert rows[name][column] != told
        assert others[name][column] == told


@pytest.mark.parametrize("field", ["width", "pin", "thickness", "clearance", "scale"])
@pytest.mark.parametrize("name", further(["external", "ratchet"], ["external"]))
def test_every_field_counts_for_an_indexing_drive(client: Any, jobs: Any, name: str, field: str) -> None:
    place, base = jobs[name][0], SIZES | THIN
    value = {"width": 12, "pin": 3, "thickness": 5, "clearance": 0.2, "scale": 1.2}[field]
    rows, others = bill(parts(client, place, **base)), bill(parts(client, place, **(base | {field: value})))
    plate, column = {
        "width": ("crank" if name == "external" else "pawl_1", "width"),
        "pin": ("crank" if name == "external" else "pawl_1", "holes"),
        "thickness": ("wheel", "thickness"),
        "clearance": ("wheel", "holes"),
        "scale": ("wheel", "length"),
    }[field]
    assert rows[plate][column] != others[plate][column]


@pytest.mark.parametrize(
    ("field", "value"), [("shafts", "both_sides"), ("over", "cycle"), ("bore", 8), ("face_width", 8)]
)
@pytest.mark.parametrize("name", ["roller", "external", "ratchet"])
def test_what_means_nothing_here_is_refused_by_its_path(
    client: Any, jobs: Any, name: str, field: str, value: Any
) -> None:
    answer = refused(client, jobs[name][0], 422, **{field: value})
    assert [fault["path"] for fault in answer["errors"]] == [f"/query/{field}"]


@pytest.mark.slow
@pytest.mark.parametrize("name", further(["roller", "external", "ratchet"], ["roller"]))
def test_too_thick_pins_are_refused_with_the_scale_that_works(client: Any, jobs: Any, name: str) -> None:
    (fault,) = refused(client, jobs[name][0], 422, pin=25)["errors"]
    assert fault["path"] == "/query/pin"
    words = fault["detail"].split()
    scale = float(words[words.index("scale") + 1])
    assert scale > 1.0
    assert parts(client, jobs[name][0], pin=25, scale=scale)


@pytest.mark.parametrize(("field", "value"), [("clearance", 5.0), ("thickness", 1e4), ("width", 3), ("pin", 0.1)])
def test_sizes_that_contradict_one_another_are_refused(client: Any, jobs: Any, field: str, value: float) -> None:
    answer = refused(client, jobs["roller"][0], 422, **(SIZES | {field: value}))
    assert [fault["path"] for fault in answer["errors"]] == [f"/query/{field}"]


@pytest.mark.slow
@pytest.mark.parametrize("sizes", [{"width": 40, "pin": 4}, {"width": 1e6}, {"width": 1e4, "pin": 20}])
def test_pawls_that_are_wider_than_long_are_refused(client: Any, jobs: Any, sizes: dict[str, float]) -> None:
    (fault,) = refused(client, jobs["ratchet"][0], 422, **sizes)["errors"]
    assert fault["path"] == "/query/width"
    assert "cannot be built" not in fault["detail"]


@pytest.mark.slow
def test_however_small_a_mechanism_is_the_scale_that_works_is_told(client: Any, jobs: Any) -> None:
    (fault,) = refused(client, jobs["ratchet"][0], 422, scale=1e-6)["errors"]
    assert fault["path"] == "/query/scale"
    words = fault["detail"].rstrip(".").split()
    assert parts(client, jobs["ratchet"][0], pin=0.5, scale=float(words[words.index("scale") + 1]))


SIZED = ["roller", "external", "arm", "flat", "groove", "internal", "ratchet"]


@pytest.mark.parametrize("name", further(SIZED, ["roller", "external"]))
def test_sizes_are_found_where_none_are_stated(client: Any, jobs: Any, name: str) -> None:
    files = parts(client, jobs[name][0])
    rows = bill(files)
    assert "base" in rows
    assert any(part.startswith("key") for part in rows)
    assert b"shaft" in files["README.txt"]


@pytest.mark.campaign
def test_what_is_not_built_says_why(client: Any) -> None:
    linked = {name: value for name, value in DRIVE.items() if name != "rollers"} | {
        "driver": "drag_link",
        "stations": 4,
    }
    job = finished(client, linked)
    answer = refused(client, f"/v1/jobs/{job['id']}/designs/0", 409)
    assert "drag link" in answer["detail"]


@pytest.mark.campaign
def test_the_inner_wall_of_a_groove_in_one_piece_is_looked_at() -> None:
    design = solve(parse_problem(PROBLEMS["groove"]), lambda _fraction, _message: None).designs[0]
    for pin, thin in ((8.0, False), (26.0, True)):
        sizes = Sizes("mill", 2.5 * pin, pin, 5.0, 0.1)
        whole = CamBuilder(design.mechanism, sizes, 1.0, CamPlanes(2, 3, back=1)).build_assembly(1.0)
        assert ("cam" in {found.part for found in find_thin_walls(whole, MIN_WALL_PER_PIN * pin)}) == thin


def test_a_contour_with_an_edge_is_not_drawn_as_a_spline() -> None:
    square = np.concatenate(
        [np.linspace(a, b, 20, endpoint=False) for a, b in ((1, 1j), (1j, -1), (-1, -1j), (-1j, 1))]
    )
    with pytest.raises(NotMade, match="edge"):
        fit_outline(Contour(40.0 * square), 1.0)


def test_the_studio_is_told_that_cams_and_drives_are_had_as_parts(client: Any) -> None:
    told = client.get("/v1/problems").json()["parts"]
    assert {"cam", "barrel_cam", "geneva_external", "geneva_internal", "geneva_spherical", "ratchet"} <= set(told)
