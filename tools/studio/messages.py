"""Texts of the studio for translation: ``python -m tools.studio.messages de`` lists missing and obsolete messages.

Texts are collected from their sources: those of the page from its modules and its markup; titles, descriptions and
names of the service from the kinds of problems and their schemas. The key is the English text. Messages in answers and
errors are not among them: the service writes these in the language of the request (:mod:`kinematics.message`).
"""

from __future__ import annotations

import argparse
import inspect
import json
import re
from collections.abc import Iterator
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from synthesis.registry import KINDS

ROOT = Path(__file__).parents[2]
STUDIO = ROOT / "service" / "studio"

_TAG = re.compile(r"(?<![\w$.])t`")
_READ = ("aria-label", "title", "placeholder", "content")
_CHECK = re.compile(
    r"\b(?:Check\(\s*name=|(?:_?check(?:_\w+)?|_?reject(?:_\w+)?)\(\s*|name, \w+ = )"
    r"\"([a-z]\w*)\""
    r"|^[A-Z_]+ = \"([a-z]+_[a-z_]+|outranked)\"$",
    re.MULTILINE,
)
"""Pattern of the names of checks, and of the reasons for excluding candidates, in the source of modules."""

STATES = ("queued", "running", "succeeded", "failed", "cancelled")
"""States of jobs."""

SHAPES = ("polygon", "rectangle", "circle")
"""Shapes of the areas in a workspace."""

UNLISTED_PARTS = {"type", "skeleton", "profile", "pitch_curve", "program", "outer_wall", "lower_wall", "upper_wall"}
"""Parts of a mechanism that the page does not list among the dimensions."""


def read_messages(language: str) -> dict[str, str]:
    """Return the translated messages of a language, by their English texts."""
    read: dict[str, str] = json.loads((STUDIO / "messages" / f"{language}.json").read_text("utf-8"))
    return read


def collect_texts() -> list[str]:
    """Return all texts to be translated, without duplicates."""
    return list(dict.fromkeys([*page_texts(), *service_texts(), *terms()]))


def studio_modules() -> list[Path]:
    """Return the paths of the page's own modules."""
    return [path for path in sorted(STUDIO.rglob("*.js")) if path.parent.name != "vendor"]


def page_texts() -> Iterator[str]:
    """Yield the texts of the page's modules and of its markup."""
    for module in studio_modules():
        yield from tagged_texts(module.read_text("utf-8"))
    markup = _Markup()
    markup.feed((STUDIO / "index.html").read_text("utf-8"))
    yield from markup.texts


def tagged_texts(source: str) -> Iterator[str]:
    """Yield the message keys of the template literals in a module that have the tag ``t``.

    >>> list(tagged_texts("el(t`Design ${n + 1} of ${`${all}`}`, t`none`)"))
    ['Design {0} of {1}', 'none']
    """
    for found in _TAG.finditer(source):
        yield _template(source, found.end())[0]


def _template(source: str, at: int) -> tuple[str, int]:
    """Return the key of the template literal whose text starts at ``at``, and the index after its end."""
    key, values = "", 0
    while source[at] != "`":
        if source.startswith("${", at):
            at = _expression(source, at + 2)
            key += f"{{{values}}}"
            values += 1
        else:
            at += source[at] == "\\"
            key += source[at]
            at += 1
    return key, at + 1


def _expression(source: str, at: int) -> int:
    """Return the index after the end of the expression that starts at ``at`` in a template literal."""
    depth = 1
    while depth:
        if source[at] == "`":
            at = _template(source, at + 1)[1]
        elif source[at] in "\"'":
            at = source.index(source[at], at + 1) + 1
        else:
            depth += {"{": 1, "}": -1}.get(source[at], 0)
            at += 1
    return at


class _Markup(HTMLParser):
    """Collects the texts of a page and of its attributes, except those of ``noscript`` elements."""

    def __init__(self) -> None:
        super().__init__()
        self.texts: list[str] = []
        self.foreign = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Collect the attributes of an element that contain text for readers."""
        self.foreign = tag == "noscript" or (self.foreign and tag != "script")
        attributes = dict(attrs)
        if tag not in ("link", "html") and not (tag == "meta" and attributes.get("name") != "description"):
            self.texts += [_bare(text) for name in _READ if (text := attributes.get(name))]

    def handle_endtag(self, tag: str) -> None:
        """Resume the collection after an element that was skipped."""
        self.foreign = self.foreign and tag != "noscript"

    def handle_data(self, data: str) -> None:
        """Collect a text."""
        if not self.foreign and re.search(r"[A-Za-z]", data):
            self.texts.append(_bare(data))


def _bare(text: str) -> str:
    return " ".join(text.split())


def service_texts() -> Iterator[str]:
    """Yield the titles, one-line texts and descriptions of the kinds of problems, of their examples and fields."""
    for name, kind in KINDS.items():
        yield kind.problem.model_config.get("title") or name
        yield prose(inspect.getdoc(kind.problem) or "")
        for example in kind.gallery:
            yield from (example.name, example.group, example.line)
        for field, root in _fields(_schemas(name)[0]):
            if text := prose(_description(field, root)):
                yield text


@cache
def _schemas(kind: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the JSON schemas of the problems of a kind and of their results."""
    return KINDS[kind].problem.model_json_schema(), KINDS[kind].result.model_json_schema()


def prose(description: str) -> str:
    """Return the first paragraph of a description, as the page shows it.

    >>> prose("Of the `crank`,\\nin degrees.\\n\\nMore.")
    'Of the crank, in degrees.'
    """
    return description.split("\n\n")[0].replace("`", "").replace("\n", " ")


def _fields(schema: dict[str, Any]) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """Yield the schemas of all fields at any depth, each with the root schema."""
    for node in _nodes(schema):
        for field in node.get("properties", {}).values():
            yield field, schema


def _nodes(schema: Any) -> Iterator[dict[str, Any]]:
    if isinstance(schema, dict):
        yield schema
    for part in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        yield from _nodes(part)


def _description(field: dict[str, Any], root: dict[str, Any]) -> str:
    """Return the description of a field, or that of its only type other than null."""
    if "description" in field:
        return str(field["description"])
    options = [one for one in _options(field, root) if one.get("type") != "null"]
    return str(options[0].get("description", "")) if len(options) == 1 else ""


def _options(schema: dict[str, Any], root: dict[str, Any]) -> list[dict[str, Any]]:
    if "$ref" in schema:
        return _options(root["$defs"][schema["$ref"].rpartition("/")[2]], root)
    several = schema.get("anyOf") or schema.get("oneOf")
    return [one for option in several for one in _options(option, root)] if several else [schema]


def terms() -> Iterator[str]:
    """Yield the names of fields, choices, metrics, checks and dimensions, in the form used within a sentence."""
    found: set[str] = {*STATES, *SHAPES, *KINDS}
    for kind in KINDS:
        statement, answer = _schemas(kind)
        found |= _named(statement) | _of_designs(answer)
    found |= {one or other for one, other in _CHECK.findall(_synthesis())}
    yield from sorted({name.replace("_", " ") for name in found if name[:1] not in "-+<" and not name.startswith("/")})


def _named(schema: Any) -> set[str]:
    """Return the names of fields, and the words that they may have as values."""
    found: set[str] = set()
    for node in _nodes(schema):
        found |= set(node.get("properties", {}))
        found |= {one for one in (*node.get("enum", []), node.get("const")) if isinstance(one, str)}
    return found


def _of_designs(root: dict[str, Any]) -> set[str]:
    """Return the names of metrics that are a single number or word, and those of the dimensions of mechanisms."""
    found: set[str] = set()
    for definition in root["$defs"].values():
        design = definition.get("properties", {})
        if "mechanism" not in design:
            continue
        found |= _dimensions(design["mechanism"], root, set())
        for metrics in _options(design.get("metrics", {}), root):
            for name, field in metrics.get("properties", {}).items():
                plain = [one for one in _options(field, root) if one.get("type") not in ("array", "object", "null")]
                found |= {name} if plain else set()
                found |= {str(word) for one in plain for word in one.get("enum", [])}
    return found


def _dimensions(schema: Any, root: dict[str, Any], seen: set[str]) -> set[str]:
    found: set[str] = set()
    if isinstance(schema, list):
        return found.union(*(_dimensions(one, root, seen) for one in schema))
    if not isinstance(schema, dict):
        return found
    name = str(schema.get("$ref", "")).rpartition("/")[2]
    if name and name not in seen:
        seen.add(name)
        found |= _dimensions(root["$defs"][name], root, seen)
    found |= {str(word) for word in (*schema.get("enum", []), *([schema["const"]] if "const" in schema else []))}
    for field, inner in schema.get("properties", {}).items():
        if field not in UNLISTED_PARTS:
            found |= {field} | _dimensions(inner, root, seen)
        elif field == "type":
            found |= _dimensions(inner, root, seen)
    for key, inner in schema.items():
        if key not in ("properties", "enum", "const", "$ref"):
            found |= _dimensions(inner, root, seen)
    return found


@cache
def _synthesis() -> str:
    return "\n".join(module.read_text("utf-8") for module in sorted((ROOT / "synthesis").rglob("*.py")))


def main() -> None:
    """Print the missing messages of a language as JSON to be filled in, and its messages that are no longer used."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("language", help="as de")
    here = read_messages(parser.parse_args().language)
    said = collect_texts()
    print(json.dumps({text: "" for text in said if text not in here}, ensure_ascii=False, indent=2))
    for text in here.keys() - set(said):
        print(f"left over: {text}")


if __name__ == "__main__":
    main()
