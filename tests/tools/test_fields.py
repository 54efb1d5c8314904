"""The reference of all fields, and the limits that pages quote, are those of the schemas."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from service.api.http.body import MAX_VALUES
from synthesis.registry import KINDS
from tools.fields import PAGE, build_page

DOCS = Path(__file__).parents[2] / "docs"


def test_the_page_is_that_of_the_schemas() -> None:
    assert PAGE.read_text("utf-8") == build_page(), "run python -m tools.fields"


def test_every_quantity_has_a_unit() -> None:
    """Fields whose description names a unit have one in the table."""
    rows = re.findall(r"^\| `(\w+)` \| ([^|]*) \| ([^|]*) \|", PAGE.read_text("utf-8"), re.MULTILINE)
    assert len(rows) > 500
    angles = [(name, unit) for name, kind, unit in rows if name.endswith("_angle") and "number" in kind]
    assert angles
    assert [name for name, unit in angles if "°" not in unit] == []
    ends = ("_radius", "_length", "_diameter", "_distance")
    lengths = [(name, unit) for name, kind, unit in rows if name.endswith(ends) and "number" in kind]
    assert lengths
    assert [name for name, unit in lengths if unit != "L"] == []


def find_limit(kind: str, model: str | None, field: str, keyword: str) -> int:
    """A limit of a field in the schema of a kind; ``model`` None for the problem itself."""
    schema = KINDS[kind].problem.model_json_schema()
    found: list[int] = []

    def search(value: Any) -> None:
        if isinstance(value, dict):
            found.extend([value[keyword]] if keyword in value else [])
            for inner in value.values():
                search(inner)
        elif isinstance(value, list):
            for inner in value:
                search(inner)

    search((schema if model is None else schema["$defs"][model])["properties"][field])
    return max(found)


@pytest.mark.parametrize(
    ("page", "words", "limit"),
    [
        ("mechanisms/space.md", "at most {} corners", find_limit("motion", "Zone", "polygon", "maxItems")),
        ("mechanisms/space.md", "at most {} obstacles", find_limit("motion", "Space", "obstacles", "maxItems")),
        ("mechanisms/manufacture.md", "permitted lengths of moving links, at most {};",
         find_limit("motion", "Stock", "links", "maxItems")),
        ("mechanisms/manufacture.md", "100 to {};", find_limit("motion", "Manufacture", "samples", "maximum")),
        ("reference/imports.md", "by default {}, the limit of a path",
         find_limit("path", None, "points", "maxItems")),
        ("tasks/path.md", "3 to {} points", find_limit("path", None, "points", "maxItems")),
        ("tasks/motion.md", "at most {} positions", find_limit("motion", None, "positions", "maxItems")),
        ("tasks/cam.md", "[...]}}`, up to {} |", find_limit("cam", "Polynomial", "conditions", "maxItems")),
        ("operations/service.md", "at most {} values", MAX_VALUES),
    ],
)  # fmt: skip
def test_limits_that_pages_quote_are_those_of_the_schema(page: str, words: str, limit: int) -> None:
    text = " ".join((DOCS / page).read_text("utf-8").split())
    head, _, tail = words.replace("{{", "{").replace("}}", "}").partition("{}")
    quoted = re.search(re.escape(head) + r"([\d ]*\d)" + re.escape(tail), text)
    assert quoted is not None, (page, words)
    assert int(quoted[1].replace(" ", "")) == limit
