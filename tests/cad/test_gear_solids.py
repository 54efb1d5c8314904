"""Solids of trains of gears: valid, as large as the model says, on their axes, and never in one another.

Teeth in one another are looked for in their sections by another library, at 72 inputs; the kernel's own intersection of
two toothed solids takes seconds, and is made at two inputs of one pair.
"""

from __future__ import annotations

import io
import math
import tempfile
import zipfile
from functools import cache, partial
from itertools import combinations, pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

from service.parts import cad
from service.parts.gears.motion import TrainMotion
from service.parts.items import items
from service.parts.made import made
from service.parts.model import Assembly, Part
from service.parts.package import package
from service.parts.shapes import Disc, arc
from service.parts.sizes import PartsQuery
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.cad.readers import assert_valid_3mf, assert_valid_glb
from tests.service.test_parts_of_gears import PAIR, SET

pytestmark = [pytest.mark.cad, pytest.mark.timeout(300)]

STAGE = {"kind": "gear_train", "max_designs": 1}
PROBLEMS: dict[str, dict[str, Any]] = {
    "pair": PAIR,
    "reverted": {**STAGE, "ratio": "6", "max_stages": 2, "reverted": True, "teeth": {"min": 17, "max": 60}},
    "shifted": {**STAGE, "ratio": "2", "max_stages": 1, "centre_distance": 31.0, "teeth": {"min": 15, "max": 45}},
    "internal": {**STAGE, "ratio": "3", "stages": [{"type": "internal"}]},
    "helical": {**STAGE, "ratio": "2", "stages": [{"type": "helical", "helix_angle": 20.0}], "teeth": {"max": 40}},
    "planetary": {**SET, "fixed": "ring"},
    "stepped": {**SET, "ratio": "6", "arrangement": "stepped", "tolerance": 0.05},
}  # fmt: skip
SWEPT = ("helical",)
SOLID = ("pair", "internal", "helical", "planetary")
"""What is made as solids; the others have no bodies that these have not."""


@cache
def solved(name: str) -> tuple[Any, Any]:
    problem = parse_problem(PROBLEMS[name])
    return problem, solve(problem, lambda _fraction, _message: None).designs[0]


@cache
def assembly(name: str) -> Assembly:
    problem, design = solved(name)
    return made(design, problem, PartsQuery())


@cache
def solids(name: str) -> dict[str, Any]:
    return {part.name: cad.solid(part) for part in assembly(name).parts}


@pytest.mark.parametrize("name", SOLID)
def test_solids_are_valid_and_as_large_as_the_model_says(name: str) -> None:
    for part in assembly(name).parts:
        solid = solids(name)[part.name]
        assert solid.is_valid
        assert solid.volume > 0.0
        assert solid.volume == pytest.approx(part.volume, rel=1e-5 if name in SWEPT else 1e-6)
        box = solid.bounding_box()
        assert pytest.approx((part.low, part.high), abs=1e-5) == (box.min.Z, box.max.Z)


@pytest.mark.parametrize("name", SOLID)
def test_the_validator_of_khronos_finds_no_fault_in_glb_files(name: str) -> None:
    assert_valid_glb(cad.glb(list(solids(name).values()), "assembly"))


@pytest.mark.parametrize("name", ["pair", "internal"])
def test_bores_are_as_far_apart_as_the_answer_says(name: str) -> None:
    from build123d import GeomType, import_step

    whole = assembly(name)
    _, design = solved(name)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.step"
        path.write_bytes(cad.step([*solids(name).values()], "assembly"))
        found = {child.label: child for child in import_step(path).children}
    assert found.keys() == {part.name for part in whole.parts}
    outer = next(part for part in whole.parts if part.name == "pin_input_shaft").region.outer
    assert isinstance(outer, Disc)
    shaft = outer.radius
    for number, distance in enumerate(design.metrics.centre_distances, 1):
        axes = []
        for role in ("driver", "driven"):
            webbed = f"web_{number}_{role}"
            one = found[webbed if webbed in found else f"gear_{number}_{role}"]
            bores = [
                face
                for face in one.faces()
                if face.geom_type == GeomType.CYLINDER and shaft < face.radius < 1.1 * shaft
            ]
            bore = max(bores, key=lambda face: face.area)
            axes.append(complex(bore.axis_of_rotation.position.X, bore.axis_of_rotation.position.Y))
        assert abs(axes[0] - axes[1]) == pytest.approx(distance, rel=1e-6)


def section(part: Part, height: float) -> shapely.Geometry | None:
    """A part at a height, its arcs as fine polygons that keep to neither side."""
    found = []
    for body in part.bodies:
        if body.low < height < body.high:
            for region in body.within(height, height):
                outer, *holes = (dense(outline) for outline in (region.outer, *region.holes))
                found.append(shapely.Polygon(outer, holes))
    return shapely.union_all(found) if found else None


def around(section: shapely.Geometry) -> tuple[complex, float]:
    """The middle of what encloses a section, and how far it reaches from there."""
    left, low, right, high = section.bounds
    middle = complex(0.5 * (left + right), 0.5 * (low + high))
    return middle, float(np.abs(shapely.get_coordinates(section) @ (1.0, 1j) - middle).max())


def turned(xy: np.ndarray, turn: complex, shift: complex = 0j) -> np.ndarray:
    z = turn * (xy @ (1.0, 1j)) + shift
    return np.column_stack([z.real, z.imag])


def dense(outline: Any) -> list[tuple[float, float]]:
    if isinstance(outline, Disc):
        turns = np.exp(2j * math.pi * np.arange(180) / 180)
        places = (outline.centre + outline.radius * turns).tolist()
    else:
        places = []
        for start, end, bulge in outline.edges():
            places.append(start)
            if bulge:
                centre, angle = arc(start, end, bulge)
                steps = max(2, math.ceil(abs(angle) / 0.05))
                places += [centre + (start - centre) * np.exp(1j * angle * k / steps) for k in range(1, steps)]
    return [(z.real, z.imag) for z in places]


@pytest.mark.parametrize("name", PROBLEMS)
def test_no_two_parts_share_room_at_72_inputs(name: str) -> None:
    """In the middle of every height between two faces of any parts, at inputs of the test's own."""
    whole = assembly(name)
    faces = sorted({round(z, 9) for part in whole.parts for body in part.bodies for z in (body.low, body.high)})
    heights = [0.5 * (a + b) for a, b in pairwise(faces)]
    state = whole.motion.at(np.linspace(0.0, whole.motion.high, 72, endpoint=False) + 0.1234)
    placed = {part.carrier: whole.motion.placed(part.carrier, state) for part in whole.parts}
    tried = 0
    for height in heights:
        cut = [(part, found) for part in whole.parts if (found := section(part, height)) is not None]
        for (one, first), (other, second) in combinations(cut, 2):
            a, b = placed[one.carrier], placed[other.carrier]
            count = 1 if one.carrier == other.carrier else 72
            # The second as the first sees it, which stays where it is; only what is near enough is looked at.
            turn, shift = b.turn / a.turn, (b.shift - a.shift) / a.turn
            (at, reach), (where, wide) = around(first), around(second)
            near = np.flatnonzero(np.abs(turn * where + shift - at)[:count] < reach + wide)
            for k in near:
                moved = shapely.transform(second, partial(turned, turn=turn[k], shift=shift[k]))
                tried += 1
                if shapely.intersects(first, moved):
                    shared = shapely.area(shapely.intersection(first, moved))
                    assert shared < 1e-9 * whole.size**2, (one.name, other.name)
    assert tried > 300


def test_teeth_that_bite_would_be_found() -> None:
    """A gear turned by a third of a pitch stands in its mate."""
    whole = assembly("pair")
    driver, driven = (
        next(part for part in whole.parts if part.name == f"gear_1_{role}") for role in ("driver", "driven")
    )
    height = 0.5 * (driver.low + driver.high)
    one, other = section(driver, height), section(driven, height)
    assert shapely.area(shapely.intersection(one, other)) == 0.0
    pitch = 360.0 / 18
    bitten = shapely.transform(one, lambda xy: turned(xy, np.exp(1j * math.radians(pitch / 3.0))))
    assert shapely.area(shapely.intersection(bitten, other)) > 0.1


@pytest.mark.parametrize("at", [0.0, 2.345])
def test_the_kernel_sees_no_solid_of_a_pair_in_another(at: float) -> None:
    whole = assembly("pair")
    placed = cad.placed(whole, [*solids("pair").values()], at)
    near = [one for one, part in zip(placed, whole.parts, strict=True) if part.sort in ("gear", "key", "pin", "washer")]
    for one, other in combinations(near, 2):
        a, b = one.bounding_box(), other.bounding_box()
        if all(min(getattr(a.max, x), getattr(b.max, x)) - max(getattr(a.min, x), getattr(b.min, x)) > 1e-4
               for x in "XYZ"):  # fmt: skip
            common = one.intersect(other)
            assert sum(getattr(body, "volume", 0.0) for body in ([] if common is None else common)) < 1e-6


@pytest.mark.parametrize("name", ["pair", "internal"])
def test_printed_gears_are_watertight_meshes(name: str) -> None:
    import trimesh

    problem, design = solved(name)
    whole = made(design, problem, PartsQuery(process="print"))
    with zipfile.ZipFile(io.BytesIO(package(whole, "print", "A", whole.motion.reference))) as archive:
        files = {one: archive.read(one) for one in archive.namelist()}
    listed = items(whole)
    assert {one for one in files if one.startswith("stl/")} == {f"stl/{item.name}.stl" for item in listed}
    for item in listed:
        assert_valid_3mf(files[f"3mf/{item.name}.3mf"])
        mesh = trimesh.load_mesh(io.BytesIO(files[f"stl/{item.name}.stl"]), file_type="stl")
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(item.part.volume, rel=0.02)
        assert mesh.bounds[0][2] == pytest.approx(0.0, abs=1e-6)


def test_planets_go_round_with_the_carrier_and_turn_about_themselves() -> None:
    """Four turns of the sun are one of the carrier; the planet's place and the carrier's pins go together."""
    whole = assembly("planetary")
    _, design = solved("planetary")
    numbers = {part.name: n for n, part in enumerate(whole.parts)}
    teeth = design.mechanism.teeth
    away = 0.5 * (teeth["sun"] + teeth["planet"])
    for angle in (0.0, 1.0, 7.0):
        placed = cad.placed(whole, [*solids("planetary").values()], angle)
        middle = placed[numbers["gear_planet_1"]].center()
        assert abs(complex(middle.X, middle.Y) - away * np.exp(0.25j * angle)) < 1e-6
        axle = placed[numbers["pin_axle_of_planet_1"]].center()
        assert abs(complex(axle.X, axle.Y) - away * np.exp(0.25j * angle)) < 1e-6
    assert isinstance(whole.motion, TrainMotion)
    carrier, planet = (whole.motion.bodies[name] for name in ("carrier", "planet_1"))
    # Past the carrier sun and planet turn as their teeth say: (ω_p - ω_c) z_p = -(ω_s - ω_c) z_s.
    assert (planet.speed - carrier.speed) * teeth["planet"] == pytest.approx(-(1.0 - carrier.speed) * teeth["sun"])
