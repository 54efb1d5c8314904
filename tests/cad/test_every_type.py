"""One design of every kind of problem and type of mechanism: its files as others read them, and its parts in motion.

The list is held against the registry, so that a type that comes to be has its row, or a reason why it has no parts.
"""

from __future__ import annotations

import io
import tempfile
import zipfile
from dataclasses import replace
from functools import cache, lru_cache
from itertools import combinations
from pathlib import Path
from typing import Any

import ezdxf
import pytest
from pydantic import ValidationError

from service.parts.assembly.interference import find_overlaps
from service.parts.assembly.items import list_items
from service.parts.assembly.model import Assembly, Part
from service.parts.assembly.sizes import PartsQuery
from service.parts.export import cad
from service.parts.export.zip_package import write_package
from service.parts.geometry.regions import Disc
from service.parts.geometry.solids import Prism
from service.parts.geometry.splines import Curve
from service.parts.linkage.motion import LinkageMotion
from service.parts.registry import NotMade, make_parts
from synthesis.dispatch import solve
from synthesis.registry import KINDS, parse_problem
from tests.cad.every_type import MADE, NEVER, REFUSED, STAGES, Row
from tests.cad.meshes import looked_through, meshed
from tests.cad.readers import assert_valid_3mf, assert_valid_glb
from tests.cad.room import shared_room

pytestmark = [pytest.mark.cad, pytest.mark.timeout(300)]

ALL = {**MADE, **STAGES}


def _row(key: tuple[str, str]) -> Any:
    """Return a design as a parameter, whose id decides the process: all tests of a design run in one."""
    return pytest.param(key, id="-".join(key))


ROWS = [_row(key) for key in MADE]
CROSSING = [_row(key) for key in STAGES]
ONE_OF_EACH_TYPE = {kind: key for key in reversed(MADE) for kind in (key[1],)}
"""Of a type that several kinds answer with, the first: its solids are those of the others in other sizes."""

WRITTEN = [_row(key) for key in [*ONE_OF_EACH_TYPE.values(), ("spring_balancing", "skeleton")]]
"""Designs whose files are read: one of each type, and the springs that another skeleton has."""

BY_MESH = ("gear", "cam")
"""Sorts of parts whose surfaces the kernel takes seconds to intersect: meshes of them are intersected alone."""


def solved(row: Row) -> tuple[Any, Any]:
    problem = parse_problem(row.statement)
    return problem, solve(problem, lambda _fraction, _message: None).designs[row.number]


@cache
def designed(key: tuple[str, str]) -> tuple[Any, Any]:
    problem, design = solved(ALL[key])
    assert (problem.kind, design.mechanism.type) == (key if key in MADE else ("gear_train", "gear_train"))
    return problem, design


@cache
def assembly(key: tuple[str, str]) -> Assembly:
    """As it is printed: every part is then written as STL and 3MF, beside STEP and DXF."""
    problem, design = designed(key)
    return make_parts(design, problem, PartsQuery(**{"process": "print", **ALL[key].query}))


def solids(key: tuple[str, str]) -> tuple[Any, ...]:
    """Those of the last design are kept: tests of one design follow one another."""
    return cad.make_solids(assembly(key))


@lru_cache(maxsize=1)
def meshes(key: tuple[str, str]) -> list[Any]:
    return meshed(solids(key))


def test_every_type_of_the_registry_has_its_row() -> None:
    known = {(name, mechanism) for name, kind in KINDS.items() for mechanism in kind.mechanisms}
    listed = [*MADE, *REFUSED, *NEVER]
    assert len(listed) == len(set(listed))
    assert set(listed) == known


@pytest.mark.parametrize(("kind", "mechanism"), NEVER)
def test_what_a_kind_never_answers_with_cannot_be_asked_of_it(kind: str, mechanism: str) -> None:
    row = next(row for (name, _), row in MADE.items() if name == kind and "mechanisms" in row.statement)
    with pytest.raises(ValidationError, match="mechanisms"):
        parse_problem({**row.statement, "mechanisms": [mechanism]})


@pytest.mark.parametrize("key", [pytest.param(key, id="-".join(key)) for key in REFUSED])
def test_what_has_no_parts_says_why(key: tuple[str, str]) -> None:
    row, reason = REFUSED[key]
    problem, design = solved(row)
    assert design.mechanism.type == key[1]
    with pytest.raises(NotMade, match=reason):
        make_parts(design, problem, PartsQuery())


@pytest.mark.parametrize("key", [*ROWS, *CROSSING], scope="module")
def test_no_two_parts_meet_at_72_inputs(key: tuple[str, str]) -> None:
    """By the model that the service looks at, and by the meshes that it exports."""
    whole = assembly(key)
    assert find_overlaps(whole, 72) == []
    looked = looked_through(whole, meshes(key), whole.motion.sample_inputs(72))
    assert looked.stood > 72
    assert looked.tried >= len(whole.parts) - 1
    assert looked.overlaps == []


@pytest.mark.parametrize(
    ("moved", "by", "into"),
    [
        ("gear_1_driver", {"turn": 360.0 / 18 / 3}, "gear_1_driven"),
        ("spacer_input_shaft_0_1", {"up": -1e-3}, "base"),
        ("pin_input_shaft", {"aside": 0.2}, "cap_below_input_shaft"),
    ],
    ids=["teeth", "spacer", "shaft"],
)
def test_what_is_not_where_it_belongs_is_seen_in_its_mesh(moved: str, by: dict[str, float], into: str) -> None:
    """A gear by a third of its pitch, a spacer by a micrometre, a shaft in its cap by two tenths of a millimetre."""
    key = ("gear_train", "gear_train")
    whole, found = assembly(key), list(meshes(key))
    number = next(k for k, part in enumerate(whole.parts) if part.name == moved)
    shift = (by.get("aside", 0.0), 0.0, by.get("up", 0.0))
    found[number] = found[number].rotate((0.0, 0.0, by.get("turn", 0.0))).translate(shift)
    overlapping = {frozenset(one.parts) for one in looked_through(whole, found, whole.motion.sample_inputs(3)).overlaps}
    assert frozenset((moved, into)) in overlapping
    assert all(moved in pair for pair in overlapping)


@pytest.mark.parametrize("key", WRITTEN, scope="module")
def test_solids_are_valid_and_every_file_is_read_by_another_library(key: tuple[str, str]) -> None:
    import trimesh
    from build123d import import_step

    whole = assembly(key)
    volumes = {part.name: solid.volume for part, solid in zip(whole.parts, solids(key), strict=True)}
    distinct = {item.part.name for item in list_items(whole)}
    for part, solid in zip(whole.parts, solids(key), strict=True):
        # Other parts of an item have the same bodies elsewhere.
        assert part.name not in distinct or solid.is_valid
        assert volumes[part.name] > 0.0
        assert volumes[part.name] == pytest.approx(part.volume, rel=1e-6 if is_exact(part) else 1e-3)
        box = solid.bounding_box()
        assert pytest.approx((part.low, part.high), abs=1e-5) == (box.min.Z, box.max.Z)
    with zipfile.ZipFile(io.BytesIO(write_package(whole, "print", "A", whole.motion.reference))) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    by_folder = {name.partition("/")[0] for name in files}
    assert by_folder >= {"dxf", "stl", "3mf", "assembly.step", "assembly.svg", "isometric.svg", "bom.csv"}
    for name, content in files.items():
        if name.startswith("stl/"):
            mesh = trimesh.load_mesh(io.BytesIO(content), file_type="stl")
            assert mesh.is_watertight, name
            assert mesh.volume > 0.0, name
        elif name.startswith("3mf/"):
            assert_valid_3mf(content)
        elif name.startswith("dxf/"):
            document = ezdxf.read(io.StringIO(content.decode()))
            assert not document.audit().has_errors, name
            assert len(document.modelspace()) > 0, name
    placed = cad.place_solids(whole, solids(key), whole.motion.reference)
    assert_valid_glb(cad.write_glb(placed, "assembly"))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "assembly.step"
        path.write_bytes(files["assembly.step"])
        read = {child.label: child for child in import_step(path).children}
    assert read.keys() == {part.name for part in whole.parts}
    for part, solid in zip(whole.parts, placed, strict=True):
        # The kernel integrates over the splines of a file another way than over the cones that they were.
        assert read[part.name].is_valid
        assert read[part.name].volume == pytest.approx(volumes[part.name], rel=1e-6 if is_exact(part) else 1e-3)
        colour = [int(part.colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
        assert tuple(read[part.name].color)[:3] == pytest.approx(colour, abs=0.01)
        (a, b), (c, d) = ((box.min, box.max) for box in (one.bounding_box() for one in (solid, read[part.name])))
        assert max(abs(p - q) for p, q in zip((*a, *b), (*c, *d), strict=True)) < 1e-4, part.name
    if isinstance(whole.motion, LinkageMotion):
        assert holes_are_as_far_apart_as_the_joints(whole, read) > 0


@pytest.mark.parametrize("key", CROSSING, scope="module")
def test_gears_of_crossing_shafts_are_as_large_as_the_model_says(key: tuple[str, str]) -> None:
    whole = assembly(key)
    for part, solid in zip(whole.parts, solids(key), strict=True):
        assert solid.is_valid
        # Bevel teeth are meshes in the model.
        assert solid.volume == pytest.approx(part.volume, rel=2e-4 if part.sort == "gear" else 1e-6)
    assert_valid_glb(cad.write_glb(cad.place_solids(whole, solids(key), 0.3), "assembly"))


def is_exact(part: Part) -> bool:
    """Return whether a part consists of lines and arcs, which the kernel integrates exactly."""
    return all(
        isinstance(body, Prism) and not any(isinstance(one, Curve) for one in (body.region.outer, *body.region.holes))
        for body in part.bodies
    )


def holes_are_as_far_apart_as_the_joints(whole: Assembly, read: dict[str, Any]) -> int:
    """In every link of the file; says how many distances there were."""
    from build123d import GeomType

    assert isinstance(whole.motion, LinkageMotion)
    mechanism, found = whole.motion.mechanism, 0
    for part in whole.parts:
        if part.sort not in ("link", "base"):
            continue
        bores = [face for face in read[part.name].faces() if face.geom_type == GeomType.CYLINDER]
        axes = [complex(at.X, at.Y) for at in (face.axis_of_rotation.position for face in bores)]
        held = [hole.centre for hole in part.region.holes if isinstance(hole, Disc)]
        joints = [complex(mechanism.joints[name]) for name in mechanism.links.get(part.carrier.link, ())]
        for a, b in combinations([z for z in joints if any(abs(z - w) < 1e-9 * whole.size for w in held)], 2):
            one, other = (min(axes, key=lambda axis, z=z: abs(axis - z)) for z in (a, b))
            assert abs(one - other) == pytest.approx(abs(a - b), rel=1e-6)
            found += 1
    return found


@pytest.mark.parametrize("key", [_row(key) for key in ONE_OF_EACH_TYPE.values()], scope="module")
def test_the_kernel_sees_no_plate_in_another(key: tuple[str, str]) -> None:
    """Which has true arcs where a mesh has chords."""
    whole = assembly(key)
    plates = [k for k, part in enumerate(whole.parts) if part.sort not in BY_MESH]
    whole = replace(whole, parts=tuple(whole.parts[k] for k in plates))
    made_ = [solids(key)[k] for k in plates]
    tried, found = shared_room(whole, made_, whole.motion.sample_inputs(72)[[5, 29, 53]])
    assert tried > 0
    assert sum(found.values()) < 1e-6 * min(solid.volume for solid in made_), found
