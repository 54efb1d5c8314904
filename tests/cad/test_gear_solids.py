"""Solids of trains of gears: what one of each type does not show, of stages, bores and planets.

The trains that one of each type does not have are intersected as meshes.
"""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from service.parts.assembly.model import Assembly
from service.parts.assembly.sizes import PartsQuery
from service.parts.export import cad
from service.parts.gears.motion import TrainMotion
from service.parts.geometry.regions import Disc
from service.parts.registry import make_parts
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.cad.meshes import looked_through, meshed
from tests.cad.readers import assert_valid_glb
from tests.support.service.parts_of_gears import SET

pytestmark = [pytest.mark.cad, pytest.mark.timeout(300)]

STAGE = {"kind": "gear_train", "max_designs": 1}
PROBLEMS: dict[str, dict[str, Any]] = {
    "reverted": {**STAGE, "ratio": "6", "max_stages": 2, "reverted": True, "teeth": {"min": 17, "max": 60}},
    "shifted": {**STAGE, "ratio": "2", "max_stages": 1, "centre_distance": 31.0, "teeth": {"min": 15, "max": 45}},
    "internal": {**STAGE, "ratio": "3", "stages": [{"type": "internal"}]},
    "helical": {**STAGE, "ratio": "2", "stages": [{"type": "helical", "helix_angle": 20.0}], "teeth": {"max": 40}},
    "planetary": {**SET, "fixed": "ring"},
    "stepped": {**SET, "ratio": "6", "arrangement": "stepped", "tolerance": 0.05},
}  # fmt: skip
SWEPT = ("helical",)
SOLID = ("internal", "helical")
"""What is measured; the others have no bodies that these or the rows of :mod:`tests.cad.every_type` have not."""

OTHERS = ("reverted", "shifted", "internal", "helical", "stepped")
"""Trains that no row of :mod:`tests.cad.every_type` has."""


@cache
def solved(name: str) -> tuple[Any, Any]:
    problem = parse_problem(PROBLEMS[name])
    return problem, solve(problem, lambda _fraction, _message: None).designs[0]


@cache
def assembly(name: str) -> Assembly:
    problem, design = solved(name)
    return make_parts(design, problem, PartsQuery())


@cache
def solids(name: str) -> dict[str, Any]:
    return {part.name: cad.make_solid(part) for part in assembly(name).parts}


@pytest.mark.parametrize("name", SOLID)
def test_solids_are_valid_and_as_large_as_the_model_says(name: str) -> None:
    for part in assembly(name).parts:
        solid = solids(name)[part.name]
        assert solid.is_valid
        assert solid.volume > 0.0
        assert solid.volume == pytest.approx(part.volume, rel=1e-5 if name in SWEPT else 1e-6)
        box = solid.bounding_box()
        assert pytest.approx((part.low, part.high), abs=1e-5) == (box.min.Z, box.max.Z)
    assert_valid_glb(cad.write_glb(list(solids(name).values()), "assembly"))


@pytest.mark.parametrize("name", ["shifted", "internal"])
def test_bores_are_as_far_apart_as_the_answer_says(name: str) -> None:
    from build123d import GeomType, import_step

    whole = assembly(name)
    _, design = solved(name)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.step"
        path.write_bytes(cad.write_step([*solids(name).values()], "assembly"))
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


@pytest.mark.parametrize("name", OTHERS)
def test_no_two_meshes_share_room_at_72_inputs(name: str) -> None:
    whole = assembly(name)
    looked = looked_through(whole, meshed(list(solids(name).values())), whole.motion.sample_inputs(72))
    assert looked.stood > 72
    assert looked.tried >= len(whole.parts) - 1
    assert looked.overlaps == []


def test_planets_go_round_with_the_carrier_and_turn_about_themselves() -> None:
    """Four turns of the sun are one of the carrier; the planet's place and the carrier's pins go together."""
    whole = assembly("planetary")
    _, design = solved("planetary")
    numbers = {part.name: n for n, part in enumerate(whole.parts)}
    teeth = design.mechanism.teeth
    away = 0.5 * (teeth["sun"] + teeth["planet"])
    for angle in (0.0, 1.0, 7.0):
        placed = cad.place_solids(whole, [*solids("planetary").values()], angle)
        middle = placed[numbers["gear_planet_1"]].center()
        assert abs(complex(middle.X, middle.Y) - away * np.exp(0.25j * angle)) < 1e-6
        axle = placed[numbers["pin_axle_of_planet_1"]].center()
        assert abs(complex(axle.X, axle.Y) - away * np.exp(0.25j * angle)) < 1e-6
    assert isinstance(whole.motion, TrainMotion)
    carrier, planet = (whole.motion.bodies[name] for name in ("carrier", "planet_1"))
    # Past the carrier sun and planet turn as their teeth say: (ω_p - ω_c) z_p = -(ω_s - ω_c) z_s.
    assert (planet.speed - carrier.speed) * teeth["planet"] == pytest.approx(-(1.0 - carrier.speed) * teeth["sun"])
