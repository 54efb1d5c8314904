"""Write the studio's types of the API: ``python -m tools.studio.types``, after ``docs/openapi.json`` has changed.

They are what openapi-typescript makes of the kept document, without its descriptions, which have no part in a type.
What has a default is optional in the types of requests, and an answer has it always, if the default is not null.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TypeAlias, cast

Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"

ROOT = Path(__file__).parents[2]
DOCUMENT = ROOT / "docs" / "openapi.json"
TYPES = ROOT / "service" / "studio" / "types" / "api.d.ts"
GENERATOR = ROOT / "tests" / "node" / "node_modules" / ".bin" / "openapi-typescript"

PROSE = frozenset({"description", "title", "summary", "example", "examples"})
"""What of a schema says nothing about the type."""

NAMED = frozenset({"properties", "schemas"})
"""Where the names are of fields and of schemas, and not of the vocabulary."""

_SCHEMAS = "#/components/schemas/"


def shaped(document: dict[str, Json]) -> dict[str, Json]:
    """The document as its types are made of it.

    >>> shaped({"components": {"schemas": {"Gear": {"title": "Gear", "properties": {"title": {"type": "string"}}}}}})
    {'components': {'schemas': {'Gear': {'properties': {'title': {'type': 'string'}}}}}}
    """
    bare = cast(dict[str, Json], _bare(document))
    schemas = cast(dict[str, dict[str, dict[str, Json]]], bare["components"])["schemas"]
    requested = _stated(bare, schemas)
    for name, schema in schemas.items():
        for field in cast(dict[str, dict[str, Json]], schema.get("properties", {})).values():
            if name in requested or field.get("default") is None:
                field.pop("default", None)
    return bare


def written(document: Path, place: Path) -> None:
    """Write the types that a document states.

    Raises
    ------
    subprocess.CalledProcessError
        Where openapi-typescript refuses the document.
    """
    with tempfile.TemporaryDirectory() as folder:
        plain = Path(folder) / "openapi.json"
        plain.write_text(json.dumps(shaped(json.loads(document.read_text("utf-8")))), encoding="utf-8")
        place.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run([GENERATOR, plain, "-o", place], check=True, capture_output=True, text=True)


def _bare(value: Json, named: bool = False) -> Json:
    if isinstance(value, list):
        return [_bare(one) for one in value]
    if isinstance(value, dict):
        return {key: _bare(one, key in NAMED and not named) for key, one in value.items() if named or key not in PROSE}
    return value


def _stated(document: dict[str, Json], schemas: Mapping[str, Json]) -> set[str]:
    """The names of the schemas that a request consists of."""
    found: set[str] = set()
    new = [name for body in _under(document.get("paths"), "requestBody") for name in _references(body)]
    while new:
        name = new.pop()
        if name not in found:
            found.add(name)
            new += _references(schemas[name])
    return found


def _under(value: Json, name: str) -> list[Json]:
    inner = value if isinstance(value, list) else list(value.values()) if isinstance(value, dict) else []
    own = [value[name]] if isinstance(value, dict) and name in value else []
    return own + [one for part in inner for one in _under(part, name)]


def _references(value: Json) -> list[str]:
    return [one.removeprefix(_SCHEMAS) for one in _under(value, "$ref") if isinstance(one, str)]


def main() -> None:
    """Write the types beside the page's modules."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    written(DOCUMENT, TYPES)


if __name__ == "__main__":
    main()
