"""Solids of linkages cut from a sheet, and of what one of each type does not show: sizes, names, colours and places."""

from __future__ import annotations

import io
import tempfile
import zipfile
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from service.parts.assembly.items import list_items
from service.parts.assembly.model import Assembly
from service.parts.assembly.sizes import FileRefusal, PartsQuery
from service.parts.export import cad
from service.parts.export.requests import make_file
from service.parts.export.zip_package import write_package
from service.parts.geometry.regions import Disc
from service.parts.linkage.motion import LinkageMotion
from service.parts.registry import make_parts
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.cad.meshes import looked_through, meshed
from tests.cad.orders import order
from tests.cad.readers import assert_valid_3mf, assert_valid_glb
from tests.support.service.parts import MOTION
from tests.support.service.parts_of_geared_linkages import planted

pytestmark = [pytest.mark.cad, pytest.mark.timeout(300)]

GEARED = "geared_fivebar"
"""A linkage with gears of two sizes; the row of :mod:`tests.cad.every_type` has equal ones."""


@cache
def solved(kind: str) -> tuple[Any, Any, Any]:
    if kind == GEARED:
        problem, design = planted(-2.0)
        return problem, None, design
    assert kind == "fourbar"
    problem = parse_problem(MOTION)
    result = solve(problem, lambda _fraction, _message: None)
    assert result.designs[0].mechanism.type == kind
    return problem, result, result.designs[0]


@cache
def assembly(kind: str, process: str = "laser") -> Assembly:
    problem, _, design = solved(kind)
    return make_parts(design, problem, PartsQuery(process=process))


@cache
def solids(kind: str) -> list[Any]:
    return [cad.make_solid(part) for part in assembly(kind).parts]


def test_solids_are_valid_and_as_large_as_the_model_says() -> None:
    for part, solid in zip(assembly(GEARED).parts, solids(GEARED), strict=True):
        assert solid.is_valid
        assert solid.volume == pytest.approx(part.volume, rel=1e-6)
        assert solid.volume > 0.0
        box = solid.bounding_box()
        assert pytest.approx((part.low, part.high), abs=1e-5) == (box.min.Z, box.max.Z)


def test_a_step_file_has_all_parts_by_name_with_holes_at_the_joints() -> None:
    from build123d import GeomType, import_step

    whole, made_ = assembly(GEARED), solids(GEARED)
    text = cad.write_step(made_, "assembly")
    assert b"AP242_MANAGED_MODEL_BASED_3D_ENGINEERING" in text
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.step"
        path.write_bytes(text)
        read = import_step(path)
    found = {child.label: child for child in read.children}
    assert found.keys() == {part.name for part in whole.parts}
    assert isinstance(whole.motion, LinkageMotion)
    mechanism = whole.motion.mechanism
    for part in whole.parts:
        one = found[part.name]
        assert one.volume == pytest.approx(part.volume, rel=1e-6)
        colour = [int(part.colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
        assert tuple(one.color)[:3] == pytest.approx(colour, abs=0.01)
        if part.sort != "link":
            continue
        bores = [face for face in one.faces() if face.geom_type == GeomType.CYLINDER]
        axes = {complex(round(a.X, 7), round(a.Y, 7)) for a in (face.axis_of_rotation.position for face in bores)}
        joints = [complex(mechanism.joints[joint]) for joint in mechanism.links[part.carrier.link]]
        held = {hole.centre for hole in part.region.holes if isinstance(hole, Disc)}
        for a, b in combinations([z for z in joints if any(abs(z - w) < 1e-9 * whole.size for w in held)], 2):
            assert abs(nearest(axes, a) - nearest(axes, b)) == pytest.approx(abs(a - b), rel=1e-6)


def nearest(places: set[complex], joint: complex) -> complex:
    return min(places, key=lambda place: abs(place - joint))


def test_geared_links_have_room_at_72_inputs() -> None:
    whole = assembly(GEARED)
    looked = looked_through(whole, meshed(solids(GEARED)), whole.motion.sample_inputs(72))
    assert looked.stood > 72
    assert looked.tried >= len(whole.parts) - 1
    assert looked.overlaps == []


def test_printed_parts_are_watertight_meshes_that_lie_on_the_plate() -> None:
    import trimesh

    whole = assembly("fourbar", "print")
    at = whole.motion.reference
    with zipfile.ZipFile(io.BytesIO(write_package(whole, "print", "A", at))) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    listed = list_items(whole)
    assert {name for name in files if name.startswith("stl/")} == {f"stl/{item.name}.stl" for item in listed}
    for item in listed:
        mesh = trimesh.load_mesh(io.BytesIO(files[f"stl/{item.name}.stl"]), file_type="stl")
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.volume == pytest.approx(item.part.volume, rel=0.02)
        assert mesh.bounds[0] == pytest.approx([0.0, 0.0, 0.0], abs=0.02)
        assert mesh.bounds[0][2] == pytest.approx(0.0, abs=1e-6)
        vertices, triangles, unit = three_mf(files[f"3mf/{item.name}.3mf"])
        assert unit == "millimeter"
        assert_valid_3mf(files[f"3mf/{item.name}.3mf"])
        other = trimesh.Trimesh(vertices, triangles)
        assert other.is_watertight
        assert other.volume == pytest.approx(item.part.volume, rel=0.02)


def three_mf(content: bytes) -> tuple[Any, Any, str | None]:
    """Vertices, triangles and unit of the one mesh in a 3MF file."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        root = ElementTree.fromstring(archive.read("3D/3dmodel.model"))
    space = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
    vertices = [[float(v.get(axis, "nan")) for axis in "xyz"] for v in root.iter(f"{space}vertex")]
    triangles = [[int(t.get(name, "-1")) for name in ("v1", "v2", "v3")] for t in root.iter(f"{space}triangle")]
    return np.array(vertices), np.array(triangles), root.get("unit")


def test_a_file_that_is_cut_short_is_not_valid() -> None:
    with pytest.raises(AssertionError, match="GLB_"):
        assert_valid_glb(cad.write_glb(solids("fourbar")[:1], "assembly")[:-8])


def test_a_glb_file_is_in_metres_with_the_shafts_along_y_and_moves_with_the_input() -> None:
    import trimesh

    problem, result, _ = solved("fourbar")
    whole = assembly("fourbar")
    stated = [float(np.degrees(x)) for x in (whole.motion.low, whole.motion.high)]
    bounds = []
    for degrees in stated:
        content = make_file(order(problem, result, {"input_angle": degrees}), "glb")
        assert isinstance(content, bytes)
        assert_valid_glb(content)
        scene = trimesh.load(io.BytesIO(content), file_type="glb")
        assert set(scene.geometry) or scene.graph
        bounds.append(scene.bounds)
        extents = scene.bounds[1] - scene.bounds[0]
        heights = max(part.high for part in whole.parts) - min(part.low for part in whole.parts)
        assert extents[1] == pytest.approx(0.001 * heights, rel=1e-3)
    assert np.abs(bounds[0] - bounds[1]).max() > 1e-3


@pytest.mark.parametrize(
    ("query", "path"),
    [({"input_place": 1.0}, "/query/input_place"), ({"input_angle": 0.0}, "/query/input_angle")],
)
def test_an_input_that_is_none_is_refused_by_its_path(query: dict[str, float], path: str) -> None:
    problem, result, _ = solved("fourbar")
    low, high = (
        float(np.degrees(x)) % 360.0 for x in (assembly("fourbar").motion.low, assembly("fourbar").motion.high)
    )
    if "input_angle" in query:
        query = {"input_angle": 0.5 * (low + high) + (0.0 if high < low else 180.0)}
    answer = make_file(order(problem, result, query), "step")
    assert isinstance(answer, FileRefusal)
    assert answer.path == path
