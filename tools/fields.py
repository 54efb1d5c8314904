"""Write the reference of all fields of problems, from their schemas: ``python -m tools.fields``.

Types, units, defaults and limits of ``docs/reference/fields.md`` are those that the service checks. A test compares
the page with the schemas.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from service.units import list_symbols
from synthesis.model.dimension import Dimension
from synthesis.model.json_object import JsonObject
from synthesis.model.kind import AnyKind
from synthesis.model.problem import MAX_MAGNITUDE
from synthesis.registry import KINDS

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "fields.md"

HEAD = """# All fields

Every field of every problem with its type, unit, default and limits, as the service checks them. `python -m
tools.fields` writes this page from the schemas. L is the length unit of the problem (`length_unit`, mm by default); in
inches forces of cams are pounds-force. A field without a default is required. The pages of the
[tasks](../tasks/motion.md) explain the fields, and [by machine](../tasks/by-machine.md) has complete requests.

The body of a request is `{"problem": {...}}`. Numbers are at most 10⁹ in magnitude unless a limit is given.
"""

_TYPES = {"number": "number", "integer": "whole number", "string": "text", "boolean": "`true` or `false`"}

_BOUNDS = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}


def build_page() -> str:
    """Build the page: a table for each kind, then one for each object in the problems, by its name."""
    parts, models, objects = [HEAD], dict[str, JsonObject](), dict[str, str]()
    for name, kind in KINDS.items():
        schema, units = kind.problem.model_json_schema(), _list_units(kind)
        for title, model in schema.get("$defs", {}).items():
            # Two kinds may use the same name for different objects.
            own = title if models.setdefault(title, model) == model else f"{title}{name.capitalize()}"
            if own != title:
                schema = json.loads(json.dumps(schema).replace(f'"#/$defs/{title}"', f'"#/$defs/{own}"'))
                schema["$defs"][own] = schema["$defs"].pop(title)
        parts.append(f"## {name}\n\n{_build_table(schema, units)}")
        for title, model in schema.get("$defs", {}).items():
            if model.get("properties"):
                objects.setdefault(title, _build_table(model, units))
    parts.append("## Objects\n\nThe values of fields that are objects, by the names that the tables above give them.\n")
    parts += [f"### {title}\n\n{table}" for title, table in sorted(objects.items())]
    return "\n".join(parts)


def _list_units(kind: AnyKind) -> dict[str, str]:
    """Return the unit of each dimension, with L for the length unit."""
    problem = kind.problem.model_validate({**kind.examples[0], "length_unit": "mm"})
    symbols = {str(dimension): symbol for dimension, symbol in list_symbols(problem).items()}
    return {
        # Grams times millimetres and millimetres per second of balancing do not depend on the length unit.
        dimension: symbol if dimension in (Dimension.UNBALANCE, Dimension.GRADE) else re.sub(r"\bmm", "L", symbol)
        for dimension, symbol in symbols.items()
    } | {Dimension.DISPLACEMENT: "L, or °", Dimension.OUTPUT: "°, or L"}


def _build_table(schema: JsonObject, units: dict[str, str]) -> str:
    lines = ["| field | type | unit | default | meaning |", "|---|---|---|---|---|"]
    for name, field in schema["properties"].items():
        required = name in schema.get("required", ())
        cells = (
            f"`{name}`",
            _describe_type(field),
            units.get(field.get("x-dimension", ""), ""),
            "" if required else _describe_default(field),
            " ".join(field.get("description", "").split()),
        )
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def _describe_type(field: JsonObject) -> str:
    """Describe the type of a field, with its limits."""
    if "$ref" in field:
        title = str(field["$ref"]).rsplit("/", 1)[-1]
        return f"[{title}](#{title.lower()})"
    choices = [choice for choice in _list_choices(field) if choice.get("type") != "null"]
    if choices:
        # A union may contain the same type with different descriptions.
        return " or ".join(dict.fromkeys(map(_describe_type, choices)))
    if "const" in field:
        return f'`"{field["const"]}"`'
    if "enum" in field:
        return ", ".join(f"`{value}`" for value in field["enum"])
    kind = field.get("type")
    if kind == "array":
        return _describe_list(field)
    if kind == "object":
        inner = field.get("additionalProperties")
        return f"object: {_describe_type(inner)} by name" if isinstance(inner, dict) else "object"
    limits = [f"{sign} {bound:g}" for name, sign in _BOUNDS.items() if _is_limit(bound := field.get(name))]
    return " ".join([_TYPES.get(str(kind), "any"), ", ".join(limits)]).strip()


def _list_choices(field: JsonObject) -> Iterator[JsonObject]:
    yield from field.get("anyOf", ())
    yield from field.get("oneOf", ())
    yield from field.get("allOf", ())


def _is_limit(bound: Any) -> bool:
    return bound is not None and abs(bound) < MAX_MAGNITUDE


def _describe_list(field: JsonObject) -> str:
    if "prefixItems" in field:
        return "[" + ", ".join(map(_describe_type, field["prefixItems"])) + "]"
    least, most = field.get("minItems"), field.get("maxItems")
    count = f"{least} to {most}" if least and most else f"at least {least}" if least else f"at most {most}"
    inner = _describe_type(field.get("items", {}))
    return f"list of {inner}" + (f" ({count})" if least or most else "")


def _describe_default(field: JsonObject) -> str:
    default = field.get("default")
    if default is None:
        return "none"
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    return f"`{default}`" if default not in ({}, []) and not isinstance(default, dict) else "empty"


if __name__ == "__main__":
    PAGE.write_text(build_page(), encoding="utf-8")
