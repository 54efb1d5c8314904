"""True profiles of shifted and helical teeth: of a pair through HTTP, and on the sheets of fitted trains."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from typing import Any

import httpx
import numpy as np
import pytest
from shapely.affinity import translate
from shapely.geometry import Polygon

from tests.support.service.answers import finished

PAIRS: list[dict[str, Any]] = [
    {"teeth": [20, 50]},
    {"teeth": [14, 33], "shift": [0.5, -0.2], "module": 2.0},
    {"teeth": [17, 29], "shift": [0.3, 0.1], "helix_angle": 25.0},
    {"teeth": [9, 40], "helix_angle": -35.0, "pressure_angle": 17.5},
    {"teeth": [24, 60], "internal": True, "shift": [0.2, 0.2], "addendum": [1.0, 0.85]},
    {"teeth": [20, 71], "internal": True, "helix_angle": 15.0, "addendum": [1.0, 0.9]},
]


def told(client: httpx.Client, **body: Any) -> dict[str, Any]:
    answer: dict[str, Any] = client.post("/v1/analyses", json=body).raise_for_status().json()
    return answer


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: f"{pair['teeth']}")
def test_profiles_of_a_pair_touch_and_do_not_overlap(client: httpx.Client, pair: dict[str, Any]) -> None:
    """Without play the outlines of both gears touch, and overlap by no more than the chords between their points."""
    mechanism = {"type": "gear_pair", **pair}
    answer = told(client, mechanism=mechanism, include=["profiles"])
    module = pair.get("module", 1.0)
    shapes = []
    for profile, gear in zip(answer["profiles"], answer["gears"], strict=True):
        space = np.array(profile["x"]) + 1j * np.array(profile["y"])
        radii = np.abs(space)
        assert radii.max() == pytest.approx(0.5 * max(gear["tip_diameter"], gear["root_diameter"]), rel=1e-3)
        pitch = 2j * np.pi / gear["teeth"]
        outline = np.concatenate([space[:-1] * np.exp(pitch * k) for k in range(gear["teeth"])])
        shapes.append(Polygon(np.column_stack([outline.real, outline.imag])))
    internal = pair.get("internal", False)
    second = translate(shapes[1], -answer["centre_distance"] if internal else answer["centre_distance"])
    overlap = shapes[0].difference(second) if internal else shapes[0].intersection(second)
    assert overlap.area < 2e-3 * module**2
    assert shapes[0].exterior.distance(second.exterior) < 2e-3 * module
    assert "profiles" not in told(client, mechanism=mechanism)


def test_a_helix_changes_the_fillet(client: httpx.Client) -> None:
    """The plane of rotation shows the rounded corner of the rack stretched: the fillet is not that of a spur gear."""
    spur, helical = (
        told(client, mechanism={"type": "gear_pair", "teeth": [20, 50], "helix_angle": angle}, include=["profiles"])
        for angle in (0.0, 30.0)
    )
    assert spur["profiles"][0] != helical["profiles"][0]


def test_an_unknown_part_is_refused(client: httpx.Client) -> None:
    answer = client.post("/v1/analyses", json={"mechanism": {"type": "gear_pair", "teeth": [20, 50]}, "include": ["x"]})
    assert answer.status_code == 422
    assert [fault["path"] for fault in answer.json()["errors"]] == ["/include/0"]


def test_the_sheet_of_a_fitted_train_shows_its_teeth(client: httpx.Client) -> None:
    stated = {"kind": "gear_train", "ratio": "2.2", "max_stages": 1, "teeth": {"min": 17, "max": 50}, "max_designs": 1}
    lengths = []
    for more in ({}, {"centre_distance": 33.0, "shift": {"min": 0.05, "max": 0.9}}):
        job = finished(client, stated | more)
        sheet = ElementTree.fromstring(client.get(f"/v1/jobs/{job['id']}/designs/0.svg").raise_for_status().text)
        lengths.append(max(len(one.get("d", "")) for one in sheet.iter() if one.tag.endswith("path")))
    assert lengths[1] > 10 * lengths[0]
