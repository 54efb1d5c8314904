"""Write the studio's types of the API to ``service/studio/types/api.d.ts``: ``python -m tools.studio.types``.

openapi-typescript makes them from the OpenAPI document without its descriptions, which have no part in a type. A field
with a default is optional in the types of requests; an answer always has it, if the default is not null.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
from pathlib import Path
from typing import cast

from service.server.app import build_api_document
from tools.contract import Json, JsonObject, strip_prose

ROOT = Path(__file__).parents[2]
TYPES = ROOT / "service" / "studio" / "types" / "api.d.ts"
GENERATOR = ROOT / "tests" / "node" / "node_modules" / ".bin" / "openapi-typescript"

_SCHEMAS = "#/components/schemas/"


def drop_optional_defaults(document: JsonObject) -> JsonObject:
    """Return a document without the defaults that make openapi-typescript require a field.

    A default in the schema of a request is dropped, and so is a default that is null.

    >>> schemas = {"Gear": {"properties": {"teeth": {"default": 17}, "note": {"default": None}}}}
    >>> drop_optional_defaults({"components": {"schemas": schemas}})
    {'components': {'schemas': {'Gear': {'properties': {'teeth': {'default': 17}, 'note': {}}}}}}
    """
    schemas = cast(JsonObject, cast(JsonObject, document["components"])["schemas"])
    requested = _request_schemas(document, schemas)
    for name, schema in schemas.items():
        for field in cast(dict[str, JsonObject], cast(JsonObject, schema).get("properties", {})).values():
            if name in requested or field.get("default") is None:
                field.pop("default", None)
    return document


def write_types(path: Path) -> None:
    """Write the types of the current code's API.

    Raises
    ------
    subprocess.CalledProcessError
        If openapi-typescript refuses the document.
    """
    shapes = drop_optional_defaults(strip_prose(json.loads(build_api_document())))
    with tempfile.TemporaryDirectory() as folder:
        plain = Path(folder) / "openapi.json"
        plain.write_text(json.dumps(shapes), encoding="utf-8")
        path.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run([GENERATOR, plain, "-o", path], check=True, capture_output=True, text=True)


def _request_schemas(document: JsonObject, schemas: JsonObject) -> set[str]:
    """Return the names of the schemas that requests consist of."""
    found: set[str] = set()
    new = [name for body in _find_values(document.get("paths"), "requestBody") for name in _references(body)]
    while new:
        name = new.pop()
        if name not in found:
            found.add(name)
            new += _references(schemas[name])
    return found


def _find_values(value: Json, name: str) -> list[Json]:
    inner = value if isinstance(value, list) else list(value.values()) if isinstance(value, dict) else []
    own = [value[name]] if isinstance(value, dict) and name in value else []
    return own + [one for part in inner for one in _find_values(part, name)]


def _references(value: Json) -> list[str]:
    return [one.removeprefix(_SCHEMAS) for one in _find_values(value, "$ref") if isinstance(one, str)]


def main() -> None:
    """Write the types next to the page's modules."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    write_types(TYPES)


if __name__ == "__main__":
    main()
