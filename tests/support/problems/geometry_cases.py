"""Code that several tests share: geometry cases."""

from __future__ import annotations

import copy
import random
from collections.abc import Callable, Iterator
from typing import Any

from synthesis.registry import KINDS, list_examples

ANGLES = frozenset(
    {
        "angle", "crank_angle", "swing", "dwell_angle", "lock", "min_transmission_angle", "rotations", "link_angle",
        "crank_range", "direction", "ground_angle", "crank_phase", "input_range", "output_range", "pressure_angle",
        "zeros",
    }
)  # fmt: skip
"""Numbers that do not scale with the lengths of a problem."""

INTEGERS = (0, 1, 2, 3, 5, 7, 13, 64, 400, 1000, 10**6, 2**31, -1)
EXTREMES = (0.0, -0.0, 1e-300, 1e-30, 1e-12, 1e-6, 1.0, 89.999999, 90.0, 180.0, 360.0, 1e6, 1e9, -1.0, -1e9, 5e-324)


def case(kind: str, number: int) -> dict[str, Any]:
    """Case ``number`` of a kind: about a third sound variations, the rest with one to four absurdities."""
    rng = random.Random(f"{kind} {number}")
    problem = copy.deepcopy(rng.choice(list_examples(kind)))
    if kind == "path":
        problem["rounds"] = 1
    _varied(problem, rng)
    if rng.random() > 0.33:
        for _ in range(rng.choice((1, 1, 2, 2, 3, 4))):
            rng.choice(ABSURDITIES)(problem, rng)
    return problem


def _numbers(value: Any) -> Iterator[tuple[Any, Any, str]]:
    """Every number with its container, its key there, and the name of the field that it belongs to."""

    def walk(inside: Any, name: str) -> Iterator[tuple[Any, Any, str]]:
        members = inside.items() if isinstance(inside, dict) else enumerate(inside)
        for key, member in list(members):
            field = str(key) if isinstance(inside, dict) else name
            if isinstance(member, dict | list):
                yield from walk(member, field)
            elif isinstance(member, int | float) and not isinstance(member, bool):
                yield inside, key, field

    return walk(value, "")


def _containers(value: Any, wanted: type) -> list[Any]:
    found = [value] if isinstance(value, wanted) else []
    members = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    for member in members:
        found += _containers(member, wanted)
    return found


def _varied(problem: dict[str, Any], rng: random.Random) -> None:
    """Other numbers of about the same size, as another client might have."""
    spread = rng.choice((0.0, 0.01, 0.2, 0.6))
    for inside, key, _ in _numbers(problem):
        if isinstance(inside[key], float):
            inside[key] *= 1.0 + rng.uniform(-spread, spread)


def _scaled(problem: dict[str, Any], rng: random.Random) -> None:
    factor = 10.0 ** rng.uniform(-9.0, 9.0)
    for inside, key, name in _numbers(problem):
        if name not in ANGLES and isinstance(inside[key], float):
            inside[key] *= factor


def _one_scaled(problem: dict[str, Any], rng: random.Random) -> None:
    inside, key, _ = rng.choice(list(_numbers(problem)) or [({"": 0.0}, "", "")])
    inside[key] = inside[key] * 10.0 ** rng.uniform(-9.0, 9.0)


def _extreme(problem: dict[str, Any], rng: random.Random) -> None:
    inside, key, _ = rng.choice(list(_numbers(problem)) or [({"": 0.0}, "", "")])
    inside[key] = rng.choice(INTEGERS) if isinstance(inside[key], int) else rng.choice(EXTREMES)


def _negated(problem: dict[str, Any], rng: random.Random) -> None:
    inside, key, _ = rng.choice(list(_numbers(problem)) or [({"": 0.0}, "", "")])
    inside[key] = -inside[key]


def _far_away(problem: dict[str, Any], rng: random.Random) -> None:
    away = {name: rng.choice((1e3, 1e6, 9e8)) * rng.uniform(-1.0, 1.0) for name in ("x", "y")}
    for inside, key, name in _numbers(problem):
        if name in away and isinstance(inside[key], float):
            inside[key] += away[name]


def _collinear(problem: dict[str, Any], rng: random.Random) -> None:
    slope, start = rng.choice((0.0, 1.0, rng.uniform(-3.0, 3.0))), rng.uniform(-50.0, 50.0)
    nearly = rng.choice((0.0, 0.0, 1e-12, 1e-6))
    for inside in _containers(problem, dict):
        if isinstance(inside.get("x"), float) and isinstance(inside.get("y"), float):
            inside["y"] = start + slope * inside["x"] + nearly * rng.uniform(-1.0, 1.0)


def _equal_members(problem: dict[str, Any], rng: random.Random) -> None:
    lists = [inside for inside in _containers(problem, list) if len(inside) > 1]
    if lists:
        chosen = rng.choice(lists)
        one, other = rng.sample(range(len(chosen)), 2)
        chosen[one] = copy.deepcopy(chosen[other])
        if rng.random() < 0.2:
            chosen[:] = [copy.deepcopy(chosen[0]) for _ in chosen]


def _other_length(problem: dict[str, Any], rng: random.Random) -> None:
    lists = [inside for inside in _containers(problem, list) if inside]
    if lists:
        chosen = rng.choice(lists)
        if rng.random() < 0.5:
            del chosen[rng.randrange(len(chosen))]
        else:
            chosen.insert(rng.randrange(len(chosen) + 1), copy.deepcopy(rng.choice(chosen)))


def _reversed(problem: dict[str, Any], rng: random.Random) -> None:
    lists = [inside for inside in _containers(problem, list) if len(inside) > 1]
    if lists:
        rng.choice([list.reverse, rng.shuffle])(rng.choice(lists))


def _limits(problem: dict[str, Any], rng: random.Random) -> None:
    """Limits the other way round, equal, or a hair apart."""
    ranges = [inside for inside in _containers(problem, dict) if {"min", "max"} <= inside.keys()]
    if ranges:
        chosen = rng.choice(ranges)
        least, greatest = chosen["min"], chosen["max"]
        chosen["min"], chosen["max"] = rng.choice(
            ((greatest, least), (least, least), (greatest, greatest), (least, least * (1.0 + 1e-12)))
        )


def _left_out(problem: dict[str, Any], rng: random.Random) -> None:
    inside = rng.choice(_containers(problem, dict))
    names = [name for name in inside if name not in ("kind", "type", "motion")]
    if names:
        del inside[rng.choice(names)]


def _option(problem: dict[str, Any], rng: random.Random) -> None:
    """Another option of some field, also of one that was left out."""
    schema = KINDS[problem["kind"]].problem.model_json_schema()
    fields = [(name, list(_options(field, schema))) for name, field in schema["properties"].items() if name != "kind"]
    name, options = rng.choice([(name, options) for name, options in fields if options])
    problem[name] = copy.deepcopy(rng.choice(options))


def _options(field: dict[str, Any], schema: dict[str, Any]) -> Iterator[Any]:
    """What a field of a JSON schema can be, as far as that can be counted; of numbers some."""
    for part in field.get("anyOf", ()):
        yield from _options(part, schema)
    if "$ref" in field:
        yield from _options(schema["$defs"][field["$ref"].rpartition("/")[2]], schema)
    yield from field.get("enum", ())
    yield from field.get("examples", ())
    match field.get("type"):
        case "boolean":
            yield from (True, False)
        case "null":
            yield None
        case "integer":
            yield from (1, 2, 3, 10)
        case "number":
            yield from (1e-6, 0.5, 1.0, 2.0, 30.0, 100.0)


def _constrained(problem: dict[str, Any], rng: random.Random) -> None:
    """A constraint of linkages; other kinds refuse it as a field that they do not have."""
    low, width = rng.uniform(-100.0, 100.0), rng.choice((0.0, 1e-9, 10.0, 1e4))
    chosen = rng.choice(
        (
            {"min_transmission_angle": rng.choice((0.0, 10.0, 45.0, 89.9, 90.0))},
            {"grashof": rng.choice(("crank_rocker", "double_crank", "double_rocker", "non_grashof"))},
            {"full_rotation": True},
            {"link_length": {"min": abs(low), "max": abs(low) + width}},
            {"max_link_ratio": rng.choice((1.0, 1.0001, 3.0, 1e9))},
            {"fixed_pivot_region": {"x": [low, low + width], "y": [low, low + width]}},
            {"moving_pivot_region": {"x": [low, low + width], "y": [low, low + width]}},
        )
    )
    constraints = problem.setdefault("constraints", {})
    if isinstance(constraints, dict):
        constraints.update(chosen)


ABSURDITIES: tuple[Callable[[dict[str, Any], random.Random], None], ...] = (
    _scaled, _one_scaled, _extreme, _negated, _far_away, _collinear, _equal_members, _other_length, _reversed, _limits,
    _left_out, _option, _option, _option, _constrained,
)  # fmt: skip
