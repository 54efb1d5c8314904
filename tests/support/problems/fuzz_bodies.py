"""Bodies of requests that nobody means: examples of everything, spoilt in one to three places.

The values are those that have broken numerical code before: numbers of 1e±300 and ±1e9, zeros, other types, fields that
are left out, members of lists that are there twice or a hundred times, and pairs of optional blocks that do not belong
together. Every body is made by its number alone, so that a number names a case.
"""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from random import Random
from typing import Any

from synthesis.analyses import get_family, list_families
from synthesis.registry import KINDS, get_first_example
from tests.support.problems.given_mechanisms import STATED

Json = Any
Path = tuple[str | int, ...]

SPOILT: tuple[Any, ...] = (
    0, -1, 1, 2, 7, 0.5, -0.0, 1e9, -1e9, 1e8, 1e6, 1e-9, 1e-300, 5e-324, 1e300, -1e300, 9_999, 10_000, 2**63, 1e-6,
    360.0, 1e5, float("nan"), float("inf"), None, True, "", "x", "1", [], {}, [0.0, 0.0], [[]], {"x": 1}, "a" * 200,
)  # fmt: skip

MOST_COPIES = 100
"""How often a member of a list is repeated at most."""

LAYOUT = {"link_width": 1.0, "pin_diameter": 0.4, "thickness": 0.3}

FOURBAR_AS_SKELETON = {
    "type": "fourbar",
    "skeleton": {
        "joints": {"O2": [0, 0], "O4": [6, 0], "A": [0, 2], "B": [6.5, 4.5]},
        "links": [
            {"name": "ground", "joints": ["O2", "O4"]},
            {"name": "input", "joints": ["O2", "A"]},
            {"name": "coupler", "joints": ["A", "B"]},
            {"name": "output", "joints": ["O4", "B"]},
        ],
        "input_link": "input",
    },
}
"""A fourbar without a coupler point, which targets need."""

BLOCKS: tuple[dict[str, Any], ...] = (
    {"layout": LAYOUT},
    {"layout": {**LAYOUT, "gap": 0.2, "shafts": "both_sides", "over": "cycle"}},
    {"motion": {"from": 0.0, "to": 1e6, "steps": 10}},
    {"motion": {"steps": 9_999}},
    {"motion": {"at": 40.0}},
    {"motion": {"time": {"end": 1.0, "step": 0.01}, "speed_rpm": 60.0}},
    {"motion": {"time": {"start": -1e9, "end": 1e9, "step": 1e9}, "acceleration": 1e9}},
    {"motion": {"speed": 10.0, "acceleration": 3.0, "steps": 36}},
    {"include": ["cognates", "centrodes", "curvature", "coupler_curve"]},
    {"include": ["branches"]},
    {"points": {"Q": {"link": "coupler", "distance": 2.0, "angle": 20.0}}},
    {"targets": [{"x": 1.0, "y": 2.0}, {"x": 2.0, "y": 3.0}]},
    {"targets": [{"input_angle": 30.0, "output": 40.0}, {"input_angle": 60.0, "output": 55.0}]},
    {"targets": [{"x": 1.0, "y": 2.0}, {"x": 2.0, "y": 3.0}], "manufacture": {"tolerances": {"length": 0.1}}},
    {"dynamics": {}},
    {"dynamics": {"links": {"coupler": {"mass": 2.0}}, "report": ["drive", "shaking", "joint_forces", "harmonics"]}},
    {"dynamics": {"friction": {"pins": {"B": {"mu": 0.1, "radius": 0.1}}}}},
    {"dynamics": {"flywheel": {"coefficient": 0.05}, "report": ["flywheel"]}},
    {"load": {"mass": 0.5, "spring_rate": 4.0, "preload": 30.0}},
    {"train": {"mass": 0.5, "stiffness": 1e6, "damping": 10.0}},
    {"cutter": {"radius": 12.0, "chordal_tolerance": 0.05}},
    {"cutter": {"radius": 12.0, "chordal_tolerance": 1e-9}},
    {"length_unit": "m"},
)


def analysis_corpus(solved: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Sound requests: the example of each family, a mechanism of every type, and those of ``solved`` designs."""
    examples = [family.request.model_json_schema()["examples"] for family in list_families()]
    stated = STATED.values() if isinstance(STATED, dict) else STATED
    mechanisms = [*(one[1] if isinstance(one, tuple) else one for one in stated), *solved]
    return [*(one for each in examples for one in each), *({"mechanism": one} for one in mechanisms)]


def job_corpus() -> list[dict[str, Any]]:
    """The example of every kind of problem, as the body of a job."""
    return [{"problem": get_first_example(kind)} for kind in KINDS]


def spoil(corpus: list[dict[str, Any]], number: int, seed: int, blocks: bool = True) -> bytes:
    """The body of a case, as JSON text."""
    rng = Random(f"{seed}/{number}")
    body = copy.deepcopy(corpus[rng.randrange(len(corpus))])
    if blocks and rng.random() < 0.6:
        # Mostly such as the family has, so that they get past the schema.
        fields = get_family(body.get("mechanism")).request.model_fields
        known = [block for block in BLOCKS if fields.keys() >= block.keys()] if rng.random() < 0.85 else BLOCKS
        for block in rng.sample(known, min(rng.choice((1, 1, 2, 2, 3)), len(known))):
            body.update(copy.deepcopy(block))
    for _ in range(rng.choice((0, 0, 1, 1, 1, 2, 3))):
        _spoil_one(body, rng)
    return json.dumps(body).encode()


def _spoil_one(body: Json, rng: Random) -> None:
    places = list(_places(body))
    if not places:
        return
    path = rng.choice(places)
    inside = body
    for step in path[:-1]:
        inside = inside[step]
    act, last = rng.random(), path[-1]
    if act < 0.12:
        del inside[last]
    elif act < 0.24 and isinstance(inside, list):
        inside.extend([copy.deepcopy(inside[int(last)])] * rng.choice((1, 1, 3, MOST_COPIES)))
    elif act < 0.3 and isinstance(inside, dict):
        inside[rng.choice(("extra", "count", "steps", "x", "type"))] = rng.choice(SPOILT)
    elif act < 0.5 and isinstance(inside[last], int | float) and not isinstance(inside[last], bool):
        inside[last] = inside[last] * rng.choice((-1, 1e-9, 1e-3, 10, 1e3, 1e9, 1e300))
    else:
        inside[last] = copy.deepcopy(rng.choice(SPOILT))


def _places(value: Json, path: Path = ()) -> Iterator[Path]:
    """All places in a body; of a long list of numbers the first few."""
    members: Iterator[tuple[str | int, Json]] | list[tuple[str | int, Json]] = []
    if isinstance(value, dict):
        members = list(value.items())
    elif isinstance(value, list):
        members = list(enumerate(value[:6]))
    for step, inner in members:
        yield (*path, step)
        yield from _places(inner, (*path, step))
