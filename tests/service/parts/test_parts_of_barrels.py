"""Parts of barrel cams: the groove against the answer's walls, its development and its touch, and all of it by HTTP."""

from __future__ import annotations

import io
import math
from dataclasses import replace
from functools import cache
from typing import Any
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest

from service.parts.assembly.interference import find_overlaps
from service.parts.assembly.model import Assembly
from service.parts.assembly.sizes import PartsQuery
from service.parts.cam.barrel import BarrelMotion
from service.parts.cam.barrel_groove import Groove
from service.parts.drawings.depth_buffer import draw_rendered_sheet
from service.parts.geometry.regions import Disc, make_ring
from service.parts.geometry.solids import Mesh, Prism
from service.parts.registry import make_parts
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.support.service.answers import finished
from tests.support.service.parts import bill, parts, refused
from tests.support.service.parts_of_barrels import BARREL

SIZES = {"pin": 6, "width": 18, "thickness": 4, "clearance": 0.1, "scale": 1.0}


@cache
def solved() -> tuple[Any, Any]:
    problem = parse_problem(BARREL)
    return problem, solve(problem, lambda _fraction, _message: None).designs[0]


@cache
def assembly() -> Assembly:
    problem, design = solved()
    return make_parts(design, problem, PartsQuery(pin=6.0, thickness=4.0, clearance=0.1))


@pytest.mark.campaign
def test_walls_on_the_cylinder_of_the_rollers_middle_are_those_of_the_answer() -> None:
    """The answer has parallels of the unrolled pitch curve; the roller touches at the same heights there."""
    mechanism = solved()[1].mechanism
    motion = assembly().motion
    assert isinstance(motion, BarrelMotion)
    radius, roller = mechanism.cylinder_radius, mechanism.follower.roller_radius
    # The answer's walls are told at its own cam angles; a clockwise barrel comes by the other way.
    theta = np.radians(mechanism.program.angle)
    groove = Groove(lambda at: (motion.displacement(at), motion.displacement.compute_slope(at)), roller, 1.0, 2.0)
    for side, told in ((-1, mechanism.lower_wall), (1, mechanism.upper_wall)):
        slope = np.array(mechanism.program.v)
        away = np.hypot(radius, roller * slope / np.hypot(radius, slope))
        found = [groove.compute_wall(theta[k : k + 1], float(away[k]), side) for k in range(len(theta))]
        heights = np.array([float(wall.height[0]) for wall in found])
        lateral = np.array([float(away[k] * np.sin(wall.angle[0] - theta[k])) for k, wall in enumerate(found)])
        assert heights == pytest.approx(np.array(told.y), abs=1e-6)
        assert radius * theta + lateral == pytest.approx(np.array(told.x), abs=1e-6)


@pytest.mark.slow
def test_the_barrel_is_a_closed_surface_and_moves_across_the_follower() -> None:
    barrel = next(part for part in assembly().parts if part.name == "barrel")
    (mesh,) = barrel.bodies
    assert isinstance(mesh, Mesh)
    edges = np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]])
    assert len(np.unique(edges, axis=0)) == len(edges)
    assert {tuple(edge) for edge in edges.tolist()} == {tuple(edge[::-1]) for edge in edges.tolist()}
    state = assembly().motion.compute_state(np.array([0.0, 1.0, 2.0]))
    placed = {part.name: assembly().motion.compute_placement(part.carrier, state) for part in assembly().parts}
    assert placed["barrel"].turn == pytest.approx(np.exp(-1j * np.array([0.0, 1.0, 2.0])))
    assert placed["barrel"].frame is placed["upright_1"].frame
    assert placed["follower"].frame is None
    assert placed["follower"].shift.imag == pytest.approx(0.0)


@pytest.mark.slow
def test_the_pictures_lie_on_their_panels() -> None:
    picture = ElementTree.fromstring(draw_rendered_sheet(assembly(), "A barrel", 0.0))
    drawn = [(element.tag.rpartition("}")[2], element.get("data-panel")) for element in picture]
    images = [n for n, (tag, _) in enumerate(drawn) if tag == "image"]
    assert [drawn[n - 1] for n in images] == [("g", "seen_1"), ("g", "seen_2")]


@pytest.mark.campaign
@pytest.mark.parametrize(("grown", "meets"), [(0.07, False), (0.13, True)])
def test_the_roller_has_its_clearance_in_the_groove_and_no_more(grown: float, meets: bool) -> None:
    whole = assembly()
    roller = next(part for part in whole.parts if part.name == "roller")
    (body,) = roller.bodies
    assert isinstance(body, Prism)
    assert isinstance(body.region.outer, Disc)
    wide = body.region.outer.radius + grown
    wider = replace(roller, bodies=(body._replace(region=make_ring(body.region.outer.centre, wide, 3.0)),))
    barrel = next(part for part in whole.parts if part.name == "barrel")
    pair = replace(whole, parts=(wider, barrel))
    assert bool(find_overlaps(pair)) == meets


@pytest.mark.campaign
def test_a_barrel_cam_is_had_as_parts(server: Any) -> None:
    client = server.client
    job = finished(client, BARREL)
    place = f"/v1/jobs/{job['id']}/designs/0"
    files = parts(client, place, **SIZES)
    assert {"barrel", "base_upright", "follower", "runner", "roller", "base", "key_cam"} <= set(bill(files))
    document = ezdxf.read(io.StringIO(files["dxf/barrel.dxf"].decode()))
    assert not document.audit().has_errors
    space = document.modelspace()
    assert {entity.dxf.layer for entity in space.query("SPLINE")} == {"LOWER_WALL", "UPPER_WALL", "ROLLER"}
    (edge,) = space.query("LWPOLYLINE")
    width, height = np.ptp([point[:2] for point in edge.get_points()], axis=0)
    radius = job["result"]["designs"][0]["mechanism"]["cylinder_radius"] + 0.5 * SIZES["thickness"] - SIZES["clearance"]
    assert width == pytest.approx(math.tau * radius, rel=1e-9)
    assert height == pytest.approx(20.0 + 2.0 * (8.0 + 0.1 + 6.0), rel=1e-6)
    picture = ElementTree.fromstring(files["isometric.svg"])
    assert len(picture.findall(".//{http://www.w3.org/2000/svg}image")) == 2
    drawn = client.get(f"{place}/assembly.svg", params={"input_angle": 90.0})
    assert drawn.status_code == 200
    told = client.get(f"{place}/assembly", params={"positions": 8}).json()
    frames = {part["name"]: told["carriers"][part["carrier"]]["frame"] for part in told["parts"]}
    assert frames["barrel"]["normals"][0] == [1.0, 0.0, 0.0]
    assert frames["follower"] is None
    answer = refused(client, place, 422, pin=14.0)
    assert answer["errors"][0]["path"] == "/query/pin"
