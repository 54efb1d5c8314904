"""Solids of cams and indexing drives: what one of each type does not show, of axes, contact and clearance."""

from __future__ import annotations

import io
import tempfile
import zipfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from service.parts.assembly.items import list_items
from service.parts.assembly.model import Assembly, Part
from service.parts.assembly.sizes import PartsQuery
from service.parts.export import cad
from service.parts.export.requests import make_file
from service.parts.export.zip_package import write_package
from service.parts.geometry.regions import Disc
from service.parts.geometry.splines import Curve
from service.parts.registry import make_parts
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.cad.meshes import looked_through, meshed, places
from tests.cad.orders import order
from tests.cad.readers import assert_valid_3mf, assert_valid_glb
from tests.support.service.parts_of_barrels import BARREL
from tests.support.service.parts_of_cams import PROBLEMS

pytestmark = [pytest.mark.cad, pytest.mark.timeout(600)]

ALL = {**PROBLEMS, "barrel": BARREL}
OTHERS = ("arm", "flat", "flat_arm", "groove", "conjugate")
"""Followers that no row of :mod:`tests.cad.every_type` has."""


@cache
def solved(name: str) -> tuple[Any, Any, Any]:
    problem = parse_problem(ALL[name])
    result = solve(problem, lambda _fraction, _message: None)
    return problem, result, result.designs[0]


@cache
def assembly(name: str, process: str = "laser") -> Assembly:
    problem, _, design = solved(name)
    return make_parts(design, problem, PartsQuery(process=process))


@cache
def solids(name: str) -> list[Any]:
    return [cad.make_solid(part) for part in assembly(name).parts]


def curved(part: Part) -> bool:
    return any(isinstance(one, Curve) for body in part.bodies for one in (body.region.outer, *body.region.holes))


def volume(shape: Any) -> float:
    """By a mesh: what the kernel integrates over a face with a long spline is off by as much as a hundredth."""
    corners, triangles = shape.tessellate(0.002, 0.05)
    places = np.array([(p.X, p.Y, p.Z) for p in corners])
    a, b, c = (places[np.array(triangles)[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


@pytest.mark.parametrize("name", OTHERS)
def test_solids_are_valid_and_as_large_as_the_model_says(name: str) -> None:
    for part, solid in zip(assembly(name).parts, solids(name), strict=True):
        assert solid.is_valid
        if curved(part):
            assert volume(solid) == pytest.approx(part.volume, rel=1e-3)
        else:
            assert solid.volume == pytest.approx(part.volume, rel=1e-6)
        box = solid.bounding_box()
        assert pytest.approx((part.low, part.high), abs=1e-5) == (box.min.Z, box.max.Z)
    assert_valid_glb(cad.write_glb(solids(name), "assembly"))


@pytest.mark.parametrize("name", OTHERS)
def test_no_two_meshes_share_room_at_72_inputs(name: str) -> None:
    whole = assembly(name)
    looked = looked_through(whole, meshed(solids(name)), whole.motion.sample_inputs(72))
    assert looked.stood > 72
    assert looked.tried >= len(whole.parts) - 1
    assert looked.overlaps == []


@pytest.mark.parametrize("name", ["external", "ratchet"])
def test_a_step_file_has_all_parts_by_name_and_its_shafts_on_their_axes(name: str) -> None:
    from build123d import GeomType, import_step

    whole = assembly(name)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.step"
        path.write_bytes(cad.write_step(solids(name), "assembly"))
        found = {child.label: child for child in import_step(path).children}
    assert found.keys() == {part.name for part in whole.parts}
    base = next(part for part in whole.parts if part.name == "base")
    stated = [hole.centre for hole in base.region.holes if isinstance(hole, Disc)]
    bores = [face for face in found["base"].faces() if face.geom_type == GeomType.CYLINDER]
    axes = [complex(face.axis_of_rotation.position.X, face.axis_of_rotation.position.Y) for face in bores]
    assert stated
    for place in stated:
        assert min(abs(axis - place) for axis in axes) < 1e-6
    mechanism = solved(name)[2].mechanism
    if name == "external":
        assert abs(stated[0] - stated[1]) == pytest.approx(mechanism.center_distance, rel=1e-9)
    if name == "ratchet":
        expected = sorted(abs(complex(*pawl.pivot)) for pawl in mechanism.pawls)
        assert sorted(abs(place - stated[0]) for place in stated[1:]) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("name", ["roller", "arm", "flat", "flat_arm", "conjugate"])
def test_a_follower_stays_in_touch_with_its_cam(name: str) -> None:
    """The kernel's own distances, at places that no equal steps of the check came to."""
    whole = assembly(name)
    at = {part.name: k for k, part in enumerate(whole.parts)}
    for input_ in (0.3, 1.1, 2.9, 4.4):
        shown = cad.place_solids(whole, solids(name), input_)
        for pair in whole.touching:
            one, other = (shown[at[part]] for part in pair)
            assert one.distance_to(other) < 3e-3


def test_the_roller_of_a_barrel_has_its_clearance_from_both_walls_of_its_groove() -> None:
    """And in chords of roller and groove a few hundredths less or more."""
    whole = assembly("barrel")
    at = {part.name: k for k, part in enumerate(whole.parts)}
    roller, barrel = meshed([solids("barrel")[at[name]] for name in ("roller", "barrel")])
    inputs = whole.motion.sample_inputs(72)
    towards = np.linalg.inv(places(whole, whole.parts[at["barrel"]], inputs)) @ places(
        whole, whole.parts[at["roller"]], inputs
    )
    gaps = [barrel.min_gap(roller.transform(np.ascontiguousarray(one[:3])), 1.0) for one in towards]
    assert min(gaps) > 0.1 - cad.DEFLECTION
    assert max(gaps) < 0.1 + cad.DEFLECTION


def test_a_printed_cam_with_its_groove_is_a_watertight_mesh_on_the_plate() -> None:
    import trimesh

    whole = assembly("groove", "print")
    with zipfile.ZipFile(io.BytesIO(write_package(whole, "print", "A", whole.motion.reference))) as archive:
        files = {file: archive.read(file) for file in archive.namelist()}
    for item in list_items(whole):
        mesh = trimesh.load_mesh(io.BytesIO(files[f"stl/{item.name}.stl"]), file_type="stl")
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(item.part.volume, rel=0.02)
        assert mesh.bounds[0][2] == pytest.approx(0.0, abs=1e-6)
        assert_valid_3mf(files[f"3mf/{item.name}.3mf"])


def test_an_assembly_is_shown_at_the_input_that_is_asked_for() -> None:
    import trimesh

    problem, result, _ = solved("external")

    def shown(degrees: float) -> Any:
        query = {"input_angle": degrees}
        content = make_file(order(problem, result, query), "glb")
        assert isinstance(content, bytes)
        return trimesh.load(io.BytesIO(content), file_type="glb").bounds

    assert shown(40.0) == pytest.approx(shown(400.0), abs=1e-9)
    assert np.abs(shown(40.0) - shown(60.0)).max() > 1e-3
