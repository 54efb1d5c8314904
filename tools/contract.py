"""Write the OpenAPI document and the contract of the API: ``python -m tools.contract``.

The document is written to ``var/openapi.json`` for reading. The contract is committed to the repository. It has one
line for each operation and each schema, with the names of its parameters or fields and a digest of its whole shape. A
test compares the contract with the service, so that no field, type, limit or default changes unnoticed and every
process writes the same order. Descriptions are not part of the contract and may change freely.
"""

from __future__ import annotations

import argparse
import hashlib
import json
from pathlib import Path
from typing import TypeAlias, cast

from service.server.app import build_api_document

Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"
JsonObject: TypeAlias = "dict[str, Json]"

ROOT = Path(__file__).parents[1]
DOCUMENT = ROOT / "var" / "openapi.json"
CONTRACT = ROOT / "tests" / "service" / "api" / "contract.txt"

PROSE = frozenset({"description", "title", "summary", "example", "examples"})
"""Keywords of OpenAPI that document a schema and do not affect its type."""

NAMED = frozenset({"properties", "schemas"})
"""Keywords of OpenAPI whose value maps names of fields or schemas, so that the keys below them are not keywords."""


def strip_prose(document: JsonObject) -> JsonObject:
    """Return a document without texts and examples.

    >>> strip_prose({"schemas": {"Gear": {"title": "Gear", "properties": {"title": {"type": "string"}}}}})
    {'schemas': {'Gear': {'properties': {'title': {'type': 'string'}}}}}
    """
    return cast(JsonObject, _strip_prose(document))


def contract_lines(document: JsonObject) -> list[str]:
    """Return the lines of the contract: operations, schemas, then everything else in one line.

    >>> field = {"type": "string"}
    >>> schemas = {"Gear": {"required": ["name"], "properties": {"name": field, "note": field}}}
    >>> contract_lines({"paths": {}, "components": {"schemas": schemas}})
    ['Gear: name note? 9d6c7af3', 'other: eee4f195']
    """
    shapes = strip_prose(document)
    paths = cast(dict[str, dict[str, JsonObject]], shapes.pop("paths"))
    schemas = cast(dict[str, JsonObject], cast(JsonObject, shapes["components"]).pop("schemas"))
    operations = [
        _line(f"{method.upper()} {path}", _parameters(operation), operation)
        for path, methods in paths.items()
        for method, operation in methods.items()
    ]
    models = [_line(name, _fields(schema), schema) for name, schema in schemas.items()]
    return [*operations, *models, _line("other", [], shapes)]


def _strip_prose(value: Json, is_named: bool = False) -> Json:
    if isinstance(value, list):
        return [_strip_prose(item) for item in value]
    if isinstance(value, dict):
        return {
            key: _strip_prose(item, key in NAMED and not is_named)
            for key, item in value.items()
            if is_named or key not in PROSE
        }
    return value


def _line(name: str, members: list[str], shape: JsonObject) -> str:
    digest = hashlib.sha256(json.dumps(shape).encode()).hexdigest()[:8]
    return " ".join([f"{name}:", *members, digest])


def _parameters(operation: JsonObject) -> list[str]:
    parameters = cast(list[JsonObject], operation.get("parameters", []))
    return [f"{parameter['name']}{'' if parameter.get('required') else '?'}" for parameter in parameters]


def _fields(schema: JsonObject) -> list[str]:
    required = cast(list[str], schema.get("required", []))
    return [f"{name}{'' if name in required else '?'}" for name in cast(JsonObject, schema.get("properties", {}))]


def main() -> None:
    """Write both files."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    text = build_api_document()
    DOCUMENT.parent.mkdir(exist_ok=True)
    DOCUMENT.write_text(text, encoding="utf-8")
    CONTRACT.write_text("".join(f"{line}\n" for line in contract_lines(json.loads(text))), encoding="utf-8")


if __name__ == "__main__":
    main()
