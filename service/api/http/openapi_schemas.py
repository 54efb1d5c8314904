"""Changes to the schemas of the OpenAPI document, so that validators and generators of clients accept it."""

from __future__ import annotations

from synthesis.model.json_object import JsonObject

DEFAULT_KEY = "x-default"
"""Keyword for a default that is an object."""

_NAMED = frozenset({"properties", "schemas", "parameters", "headers", "responses"})
"""Keywords whose value maps names, so that the keys below them are no keywords."""

_DATA = frozenset({"default", "enum", "const", "example", "examples", "mapping", DEFAULT_KEY})
"""Keywords whose value is data of clients or of the service, and no schema."""


def simplify_schemas(document: JsonObject) -> None:
    """Remove the titles of schemas and rename the keyword of defaults that are objects, in place.

    Generators name a class by the title of its schema, and drop a schema whose title another one has. Without titles
    they take the name of the component, which is unique. They also drop a schema with an object as a default.
    """
    for schemas in (document["paths"], document["components"]):
        _visit(schemas, are_names=True)


def _visit(value: object, are_names: bool = False) -> None:
    if isinstance(value, list):
        for item in value:
            _visit(item)
    elif isinstance(value, dict):
        if not are_names:
            _simplify(value)
        for key, item in value.items():
            if are_names or key not in _DATA:
                _visit(item, are_names=key in _NAMED and not are_names)


def _simplify(schema: JsonObject) -> None:
    schema.pop("title", None)
    if isinstance(schema.get("default"), dict):
        schema[DEFAULT_KEY] = schema.pop("default")
