"""Statements of every kind, read off the schema that the service shows: their fields, and values for them.

A field is named by its place: ``constraints.link_length.min``; of the members of a list ``positions[].x``; of one of
several models, where the place alone does not tell which, ``follower<OscillatingFlat>.sense``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from random import Random
from typing import Any

Schema = dict[str, Any]


def resolved(schema: Schema, root: Schema) -> tuple[str, Schema]:
    """A schema behind its references, and the name of the model that it is."""
    name = ""
    while "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        schema = root["$defs"][name]
    return name, schema


def choices(schema: Schema, root: Schema) -> list[tuple[str, Schema]]:
    """What a value may be: the members of a union, without null."""
    name, schema = resolved(schema, root)
    members = schema.get("anyOf") or schema.get("oneOf")
    if members is None:
        return [(name, schema)]
    return [one for member in members for one in choices(member, root) if one[1].get("type") != "null"]


def fields(root: Schema, skip: frozenset[str] = frozenset()) -> dict[str, Schema]:
    """All fields of a statement by their names, with their schemas; those within models of ``skip`` left out."""
    return dict(_fields("", root, root, skip))


def _fields(place: str, schema: Schema, root: Schema, skip: frozenset[str]) -> Iterator[tuple[str, Schema]]:
    for name, value in schema.get("properties", {}).items():
        here = f"{place}.{name}" if place else name
        yield here, value
        yield from _within(here, value, root, skip)


def _within(place: str, value: Schema, root: Schema, skip: frozenset[str]) -> Iterator[tuple[str, Schema]]:
    known = choices(value, root)
    models = [name for name, one in known if "properties" in one]
    for name, one in known:
        if name in skip:
            continue
        if one.get("type") == "array":
            for item in [
                *one.get("prefixItems", [])[:1],
                *([one["items"]] if isinstance(one.get("items"), dict) else []),
            ]:
                yield from _within(f"{place}[]", item, root, skip)
        elif isinstance(one.get("additionalProperties"), dict):
            yield from _within(f"{place}{{}}", one["additionalProperties"], root, skip)
        elif "properties" in one:
            yield from _fields(f"{place}<{name}>" if len(models) > 1 else place, one, root, skip)


WORDS = ("8", "-127/50", "3pi/2", "sun", "ring", "carrier", "planet")
"""Texts that some field or other takes where its schema allows any."""

ABOUT = (0.0, 0.5, 1.0, 2.0, 10.0, 45.0, 120.0)
"""Sizes that numbers of statements have; their neighbourhood is drawn from, as far as the bounds allow."""


def drawn(schema: Schema, root: Schema, rng: Random) -> Any:
    """A value that a schema allows; validators and contradictions may still refuse it."""
    _, schema = resolved(schema, root)
    members = schema.get("anyOf") or schema.get("oneOf")
    if members is not None:
        return drawn(rng.choice(members), root, rng)
    if "const" in schema:
        return schema["const"]
    if "enum" in schema:
        return rng.choice(schema["enum"])
    return _DRAWN[schema["type"]](schema, root, rng)


def _number(schema: Schema, _root: Schema, rng: Random) -> float:
    low = max(schema.get("minimum", -math.inf), schema.get("exclusiveMinimum", -math.inf))
    high = min(schema.get("maximum", math.inf), schema.get("exclusiveMaximum", math.inf))
    value = rng.choice(ABOUT) * rng.uniform(0.5, 1.5) * rng.choice((1, 1, 1, -1))
    return round(value, 6) if low < value < high else round(rng.uniform(max(low, -1e3), min(high, 1e3)), 6)


def _integer(schema: Schema, _root: Schema, rng: Random) -> int:
    low, high = schema.get("minimum", -1000), schema.get("maximum", 1000)
    return rng.randint(low, min(high, max(low + 2, rng.choice((10, 100, high)))))


def _list(schema: Schema, root: Schema, rng: Random) -> list[Any]:
    if "prefixItems" in schema:
        return [drawn(item, root, rng) for item in schema["prefixItems"]]
    least = schema.get("minItems", 0)
    return [
        drawn(schema["items"], root, rng)
        for _ in range(rng.randint(least, min(schema.get("maxItems", least + 3), least + 3)))
    ]


def _object(schema: Schema, root: Schema, rng: Random) -> Schema:
    if isinstance(schema.get("additionalProperties"), dict):
        return {rng.choice(WORDS[3:]): drawn(schema["additionalProperties"], root, rng)}
    if "patternProperties" in schema:
        return {"0": drawn(*schema["patternProperties"].values(), root, rng)}
    wanted = schema.get("required", [])
    return {
        name: drawn(value, root, rng)
        for name, value in schema.get("properties", {}).items()
        if name in wanted or rng.random() < 0.3
    }


_DRAWN = {
    "number": _number,
    "integer": _integer,
    "boolean": lambda schema, root, rng: rng.random() < 0.5,
    "string": lambda schema, root, rng: rng.choice(WORDS),
    "null": lambda schema, root, rng: None,
    "array": _list,
    "object": _object,
}
