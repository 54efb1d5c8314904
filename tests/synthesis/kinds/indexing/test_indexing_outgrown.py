"""Sizes of Geneva drives that outlines ask for, and the roller of a hemisphere beside the resting wheel."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.indexing.design import SphericalGenevaMechanism
from synthesis.kinds.indexing.smallest import enlarge_until_verified
from synthesis.kinds.indexing.spherical_drive import _list_edges, measure_on_sphere
from synthesis.registry import list_examples, parse_problem
from tests.campaign import further

STATED = {"kind": "indexing", "drive": "geneva_external", "rollers": 1, "speed_rpm": 60.0, "load_inertia": 0.02}


HELD: list[tuple[dict[str, Any], str, str]] = [
    ({"stations": 8, "roller_diameter": 6.0, "wall_thickness": 1.0, "clearances": {"locking": 1.0}}, "play", "play"),
    (
        {"drive": "geneva_spherical", "stations": 6, "roller_diameter": 6.0, "clearances": {"locking": 1.5}},
        "locked_rest",
        "locked_at_rest",
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize(("fields", "by", "check"), further(HELD, HELD[1:]))
def test_a_size_is_found_at_which_the_wheel_is_held(fields: dict[str, Any], by: str, check: str) -> None:
    """The walls alone would do with less, but the wheel would rattle, or be held for too short."""
    (design,) = solve(parse_problem({**STATED, **fields})).designs
    assert design.metrics.sized_by == by
    name = "sphere_radius" if fields.get("drive") == "geneva_spherical" else "center_distance"
    size = getattr(design.mechanism, name)
    result = solve(parse_problem({**STATED, **fields, name: 0.99 * size, "include_failed": True}))
    (smaller,) = result.designs
    assert [one.name for one in smaller.verification.checks if not one.passed] == [check]


@pytest.mark.parametrize(
    ("broken_beyond", "mended_from", "found"),
    [
        (None, 3.0, 3.0),  # a larger drive has less play
        (2.5, 3.0, 1.0),  # before the play is gone something else breaks, which the first size keeps
        (2.5, 2.0, 2.0),
    ],
)
@pytest.mark.parametrize("undrawn", [False, True])
def test_a_larger_drive_that_breaks_something_else_is_not_taken(
    broken_beyond: float | None, mended_from: float, found: float, undrawn: bool
) -> None:
    def of_size(size: float, _: str) -> Any:
        beyond = broken_beyond is not None and size > broken_beyond
        if beyond and undrawn:
            return "not_drawable"
        names = ["play"] * (size < mended_from) + ["box"] * beyond
        checks = [SimpleNamespace(name=name, passed=False) for name in names]
        return SimpleNamespace(size=size, verification=SimpleNamespace(checks=checks))

    assert enlarge_until_verified((1.0, "wall"), of_size).size == pytest.approx(found, rel=1e-5)


def test_a_roller_that_has_no_room_beside_a_horn_is_refused() -> None:
    """With an oblique entry the slot has to be wide, whatever the size is."""
    oblique = {
        **STATED,
        "stations": 4,
        "roller_diameter": 12.0,
        "crank_radius": 85.0,
        "center_distance": 100.0,
        "clearances": {"slot": 2.0},
        "constraints": {"shock_free": False},
    }
    assert solve(parse_problem(oblique)).designs
    narrow = {**oblique, "clearances": {"slot": 0.5}}
    result = solve(parse_problem(narrow))
    assert not result.designs
    assert "roller_clears_wheel" in result.search.rejected


@pytest.mark.parametrize("off", [0.0, 1.5])
def test_a_roller_is_seen_to_pass_the_resting_hemisphere(off: float) -> None:
    """By dense points the roller's axis is as far from all edges in space; a crank that leans over is noticed."""
    stated = next(one for one in list_examples("indexing") if one["drive"] == "geneva_spherical")
    (design,) = solve(parse_problem(stated)).designs
    mechanism = design.mechanism
    assert isinstance(mechanism, SphericalGenevaMechanism)
    changed = mechanism.model_copy(update={"cone_angle": mechanism.cone_angle + off})
    cone, turn = math.radians(changed.cone_angle), math.radians(changed.cone_angle)
    alpha = np.linspace(0.5, 1.5, 721) * math.pi
    axis = np.stack([np.full(721, math.cos(cone)), math.sin(cone) * np.sin(alpha), math.sin(cone) * np.cos(alpha)])
    edges = _list_edges(changed)
    x = edges[:, 0] * math.cos(turn) - edges[:, 1] * math.sin(turn)
    y = edges[:, 0] * math.sin(turn) + edges[:, 1] * math.cos(turn)
    along = np.stack([x, y, edges[:, 2]], 1) @ axis
    least = changed.sphere_radius * float(np.sqrt(np.maximum(1.0 - along**2, 0.0))[along > 0.0].min())
    found = measure_on_sphere(changed)["passing"]
    assert found <= least + 1e-9
    assert found == pytest.approx(least, abs=0.05 * mechanism.roller_diameter)
    assert (found < 0.5 * mechanism.roller_diameter - 1e-6) == (off > 0.0)
