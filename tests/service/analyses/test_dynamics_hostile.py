"""Blocks ``dynamics`` that no honest client sends: each field in turn, and several at once, holds something absurd.

What is refused is refused at a field of the block; what is not is answered in numbers. Nothing breaks.
"""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from typing import Any

import httpx
import numpy as np
import pytest

from synthesis.analyses.linkages.linkage import LinkageAnalysis
from tests.support.service.dynamics import CRANK, OTHER_TYPES

Statement = dict[str, Any]
Path = tuple[str | int, ...]

SLIDER = OTHER_TYPES["slider_crank"]
BAR = {"density": 7800.0, "thickness": 10.0, "width": 20.0, "ends": "round", "holes": {"A": 8.0}}
POLYGON = {"density": 2700.0, "thickness": 5.0, "polygon": [[0, 0], [200, 0], [200, 90], [0, 20]]}
PARTS = [
    {"form": "prism", "at": [20.0, 0.0], "length": 40.0, "width": 5.0, "thickness": 5.0, "density": 7800.0},
    {"form": "cylinder", "axis": "normal", "at": [0.0, 0.0], "diameter": 30.0, "length": 10.0, "bore": 8.0},
]
FULL: dict[str, tuple[Statement, Statement]] = {
    "fourbar": (
        CRANK,
        {
            "units": "si",
            "gravity": {"magnitude": 9.81, "angle": 270.0},
            "bodies": {
                "input": {"mass": 0.5, "cg": {"distance": 30.0, "angle": 10.0}, "inertia": 0.001},
                "coupler": {"shape": BAR},
                "output": {"shape": POLYGON},
            },
            "point_masses": [{"joint": "B", "mass": 0.9}],
            "loads": [
                {"link": "coupler", "point": [80.0, 40.0], "frame": "link", "force": {"constant": [3.0, -12.0]}},
                {"link": "output", "torque": {"against_motion": {"forward": 2.0, "backward": 1.0}}},
                {
                    "joint": "B",
                    "force": {
                        "by": "input_angle",
                        "table": [[0, 0, 0], [90, -50, 0], [180, 5, 5]],
                        "interpolation": "periodic_cubic",
                        "turns": 1,
                    },
                },
            ],
            "springs": [
                {
                    "ends": [{"link": "ground", "point": [0, 100]}, {"link": "output", "point": [150, 0]}],
                    "rate": 2000.0,
                    "free_length": 80.0,
                    "preload": 1.0,
                    "damping": 5.0,
                    "one_sided": "pull",
                },
                {"torsion": 3.0, "links": ["ground", "output"], "free_angle": 20.0, "damping": 0.1},
            ],
            "friction": {"pins": {"A": {"mu": 0.1, "radius": 5.0}}},
            "moment_about": [1.0, 2.0],
            "minimum_norm": False,
            "flywheel": {"coefficient": 0.05, "existing_inertia": 0.01},
            "report": ["joint_forces", "drive", "shaking", "flywheel", "joint_force_index", "harmonics"],
            "drive": "torque",
        },
    ),
    "slider-crank": (
        SLIDER,
        {
            "bodies": {"crank": {"shape": {"density": 7800.0, "parts": PARTS}}},
            "loads": [
                {
                    "joint": "B",
                    "force": {
                        "gas": {"cycle": 720, "bore": 76.0, "phase": 0, "pressure": [[0, 3e6], [20, 2e6], [180, 0]]}
                    },
                },
                {"joint": "B", "force": {"against_motion": {"forward": 250.0, "backward": 50.0}}},
            ],
            "friction": {"pins": {"A": {"mu": 0.1, "radius": 5.0}}, "slides": {"0": 0.15}},
        },
    ),
}
MOTION = {"from": 0.0, "to": 360.0, "steps": 8, "speed_rpm": 60.0}

ABSURD: tuple[Any, ...] = (
    *(-1.0, 0, 5, 1e9, -1e9, 1e-9, 1e10, 1e300, 10**400),
    *("NaN", "Infinity", "-1", "", "x" * 2000, "ground", "input", "__proto__", "0"),
    *(True, None, [], {}, [0, 0], [1e9, -1e9], [[0, 0]], {"constant": [1, 1]}, {"$gt": ""}, [None] * 300),
)


def fields(value: Any, path: Path = ()) -> Iterator[Path]:
    """Paths of all values of a block, whole objects and lists among them."""
    if path:
        yield path
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, below in inner:
        yield from fields(below, (*path, key))


def put(block: Statement, path: Path, value: Any) -> Statement:
    """A copy of the block with one value in place of another."""
    spoilt = copy.deepcopy(block)
    place: Any = spoilt
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] = value
    return spoilt


def judged(client: httpx.Client, mechanism: Statement, block: Any, motion: Statement = MOTION) -> tuple[int, list[str]]:
    """Status and paths of the faults; an answer holds what the document says, in numbers."""
    body = json.dumps({"mechanism": mechanism, "motion": motion, "dynamics": block})
    answer = client.post("/v1/analyses", content=body, headers={"Content-Type": "application/json"}, timeout=30.0)
    assert answer.status_code in (200, 400, 422), (block, answer.text)
    assert "NaN" not in answer.text
    assert "Infinity" not in answer.text
    if answer.status_code == 200:
        LinkageAnalysis.model_validate(answer.json())
        return 200, []
    return answer.status_code, [error["path"] for error in answer.json().get("errors", [])]


def refused_in_the_block(client: httpx.Client, mechanism: Statement, block: Any, motion: Statement = MOTION) -> None:
    status, paths = judged(client, mechanism, block, motion)
    if status == 422:
        assert paths
        assert all(path.startswith("/dynamics") for path in paths), (block, paths)


CASES = [(name, path) for name, (_, block) in FULL.items() for path in fields(block)]


@pytest.mark.parametrize("name", FULL)
def test_the_blocks_are_good_before_they_are_spoilt(client: httpx.Client, name: str) -> None:
    assert judged(client, *FULL[name])[0] == 200


def test_every_fourth_field_holds_something_absurd(client: httpx.Client) -> None:
    for n, (name, path) in enumerate(CASES[::4]):
        mechanism, block = FULL[name]
        refused_in_the_block(client, mechanism, put(block, path, ABSURD[n % len(ABSURD)]))


@pytest.mark.fuzz
@pytest.mark.timeout(1800)
@pytest.mark.parametrize(("name", "path"), CASES)
def test_every_field_holds_everything_absurd(client: httpx.Client, name: str, path: Path) -> None:
    mechanism, block = FULL[name]
    for value in ABSURD:
        refused_in_the_block(client, mechanism, put(block, path, value))


@pytest.mark.fuzz
@pytest.mark.timeout(1800)
def test_several_fields_at_once_hold_something_absurd(client: httpx.Client) -> None:
    rng = np.random.default_rng(20)
    for _ in range(1000):
        name = str(rng.choice(list(FULL)))
        mechanism, block = FULL[name]
        for _ in range(int(rng.integers(2, 5))):
            paths = list(fields(block))
            block = put(block, paths[int(rng.integers(len(paths)))], ABSURD[int(rng.integers(len(ABSURD)))])
            if not isinstance(block, dict) or not list(fields(block)):
                break
        speed = float(rng.choice([0.0, 60.0, -1e9, 1e9, 1e-9]))
        refused_in_the_block(client, mechanism, block, MOTION | {"speed_rpm": speed})


NAMED: dict[str, tuple[str, Path, Any, str]] = {
    "negative mass": ("fourbar", ("bodies", "input", "mass"), -0.5, "/dynamics/bodies/input/mass"),
    "negative point mass": ("fourbar", ("point_masses", 0, "mass"), -1e-12, "/dynamics/point_masses/0/mass"),
    "mass as text": ("fourbar", ("point_masses", 0, "mass"), "NaN", "/dynamics/point_masses/0/mass"),
    "inertia as text": ("fourbar", ("bodies", "input", "inertia"), "Infinity", "/dynamics/bodies/input/inertia"),
    "mass above a thousand million": ("fourbar", ("point_masses", 0, "mass"), 1.1e9, "/dynamics/point_masses/0/mass"),
    "table out of order": (
        "fourbar",
        ("loads", 2, "force", "table"),
        [[0, 0, 0], [180, 1, 1], [90, 2, 2]],
        "/dynamics/loads/2/force/table",
    ),
    "angle twice in a table": (
        "fourbar",
        ("loads", 2, "force", "table"),
        [[0, 0, 0], [90, 1, 1], [90, 2, 2]],
        "/dynamics/loads/2/force/table",
    ),
    "pressure out of order": (
        "slider-crank",
        ("loads", 0, "force", "gas", "pressure"),
        [[0, 1e6], [90, 2e6], [20, 0]],
        "/dynamics/loads/0/force/gas/pressure",
    ),
    "unknown link": ("fourbar", ("loads", 0, "link"), "rocker", "/dynamics/loads/0/link"),
    "unknown link of a spring": ("fourbar", ("springs", 0, "ends", 1, "link"), "x", "/dynamics/springs/0/ends/1/link"),
    "unknown joint": ("fourbar", ("point_masses", 0, "joint"), "Z", "/dynamics/point_masses/0/joint"),
    "coefficient of 5": ("fourbar", ("friction", "pins", "A", "mu"), 5.0, "/dynamics/friction/pins/A/mu"),
    "coefficient of 5 on a slide": ("slider-crank", ("friction", "slides", "0"), 5.0, "/dynamics/friction/slides/0"),
    "no such slide": ("slider-crank", ("friction", "slides", "3"), 0.1, "/dynamics/friction/slides/3"),
    "negative rate": ("fourbar", ("springs", 0, "rate"), -1.0, "/dynamics/springs/0/rate"),
    "negative bore": ("slider-crank", ("loads", 0, "force", "gas", "bore"), -76.0, "/dynamics/loads/0/force/gas/bore"),
}


@pytest.mark.parametrize("fault", NAMED)
def test_faults_are_told_at_their_field(client: httpx.Client, fault: str) -> None:
    name, path, value, told = NAMED[fault]
    mechanism, block = FULL[name]
    status, paths = judged(client, mechanism, put(block, path, value))
    assert status == 422
    assert any(found == told or found.startswith(f"{told}/") for found in paths), paths
