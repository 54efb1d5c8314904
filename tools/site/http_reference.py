"""Pages of the HTTP reference, generated from the OpenAPI document: operations, and the models of each kind of problem.

A model that only one kind of problem uses is on the page of that kind, under its statement or its answer. Three further
pages have the models shared by several statements, those shared by several answers, and all other models of operations.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

Schema = dict[str, Any]

STATED, ANSWERED, OTHERS = "shared_statements.md", "shared_answers.md", "shared_others.md"
SHARED = {
    STATED: ("Shared in statements", "What the statements of several kinds of problems have in common, by name."),
    ANSWERED: ("Shared in answers", "What the answers of several kinds of problems have in common, by name."),
    OTHERS: ("Jobs, batches, analyses", "What operations take and give beside problems and their answers, by name."),
}
"""Heading and introduction of each page of models that belong to no single kind."""

FOLDER = "reference/http"
OPERATIONS = "operations.md"
_PREFIX = "#/components/schemas/"
_LIMITS = (
    ("minimum", "≥ "),
    ("exclusiveMinimum", "> "),
    ("maximum", "≤ "),
    ("exclusiveMaximum", "< "),
    ("minItems", "at least "),
    ("maxItems", "at most "),
    ("pattern", "matches "),
)


def http_reference(document: Schema) -> dict[str, str]:
    """Return the pages of the reference by file name.

    Parameters
    ----------
    document : dict
        An OpenAPI 3.1 document whose problems are models named ``...Problem`` with their kind as a constant.
    """
    models = document["components"]["schemas"]
    places = _places(models)
    pages = {OPERATIONS: _operations(document, places)}
    for page, kind in {_page(kind): kind for kind in problems(models)}.items():
        pages[page] = _kind_page(page, kind, models, places)
    for page, (title, line) in SHARED.items():
        mine = sorted(name for name, place in places.items() if place == page)
        listed = "".join(_model(name, models[name], places, page, "##") for name in mine)
        pages[page] = f"# {title}\n\n{line}\n\n{listed}"
    return pages


def problems(models: Schema) -> dict[str, str]:
    """Return the name of the problem model of each kind, sorted by kind."""
    found = {}
    for name, model in models.items():
        kind = model.get("properties", {}).get("kind", {}).get("const")
        if name.endswith("Problem") and kind:
            found[kind] = name
    return dict(sorted(found.items()))


def anchor(name: str) -> str:
    """Return the anchor of a model on its page."""
    return f"model-{name.lower().strip('_').replace('_', '-')}"


def _page(kind: str) -> str:
    return f"{kind}.md"


def _result(kind: str, models: Schema) -> str:
    """Return the name of the result model of a kind, which begins like that of its problem model."""
    name: str = problems(models)[kind].removesuffix("Problem") + "Result"
    return name


def _references(schema: Any) -> Iterator[str]:
    """Yield the names of the models to which a schema refers, at any depth."""
    if isinstance(schema, dict):
        target = schema.get("$ref")
        if isinstance(target, str) and target.startswith(_PREFIX):
            yield target.removeprefix(_PREFIX)
        for key, value in schema.items():
            if key != "examples":
                yield from _references(value)
    elif isinstance(schema, list):
        for value in schema:
            yield from _references(value)


def _reached(start: str, models: Schema) -> set[str]:
    seen, left = {start}, [start]
    while left:
        for name in _references(models[left.pop()]):
            if name not in seen:
                seen.add(name)
                left.append(name)
    return seen


def _places(models: Schema) -> dict[str, str]:
    """Return the page of each model, by model name."""
    stating: dict[str, set[str]] = {name: set() for name in models}
    answering: dict[str, set[str]] = {name: set() for name in models}
    for kind, problem in problems(models).items():
        for name in _reached(problem, models):
            stating[name].add(kind)
        for name in _reached(_result(kind, models), models):
            answering[name].add(kind)
    return {name: _place(stating[name], answering[name]) for name in models}


def _place(stating: set[str], answering: set[str]) -> str:
    kinds = stating | answering
    if not kinds:
        return OTHERS
    if len(kinds) == 1:
        return _page(*kinds)
    return STATED if stating else ANSWERED


def _kind_page(page: str, kind: str, models: Schema, places: dict[str, str]) -> str:
    problem, result = problems(models)[kind], _result(kind, models)
    mine = {name for name, place in places.items() if place == page}
    stated = _reached(problem, models) & mine
    answered = mine - stated
    text = [
        f"# `{kind}`\n\nWhat is told in words is on [the page of this kind](../../{guide(kind)}).\n\n## Statement\n\n"
    ]
    text += [_model(name, models[name], places, page, "###") for name in _first(problem, stated)]
    text.append("## Answer\n\n")
    text += [_model(name, models[name], places, page, "###") for name in _first(result, answered)]
    return "".join(text)


GUIDES = {"layshaft_gearbox": "tasks/gearbox.md"}
"""Guide pages of kinds whose page does not have the kind's own name."""


def guide(kind: str) -> str:
    """Return the page of ``docs/`` that describes a kind of problem."""
    return GUIDES.get(kind, f"tasks/{kind}.md")


def _first(head: str, names: set[str]) -> list[str]:
    return [head, *sorted(names - {head})] if head in names else sorted(names)


def _model(name: str, model: Schema, places: dict[str, str], page: str, level: str) -> str:
    """Return the section of a model: heading, description and a table of its fields."""
    lines = [f"{level} {name} {{ #{anchor(name)} }}\n"]
    if model.get("description"):
        lines.append(f"{_plain(model['description'])}\n")
    fields = model.get("properties")
    if not fields:
        lines.append(f"{_type(model, places, page)}\n")
        return "\n".join(lines) + "\n"
    required = set(model.get("required", ()))
    lines += ["| field | is | left out | meaning |", "|---|---|---|---|"]
    lines += [
        f"| `{field}` | {_type(schema, places, page)} | {_default(field, schema, required)} | {_meaning(schema)} |"
        for field, schema in fields.items()
    ]
    return "\n".join(lines) + "\n\n"


def _plain(text: str) -> str:
    """Convert a description to Markdown: double backticks become single ones, and brackets are escaped."""
    parts = text.replace("``", "`").strip().split("`")
    return "`".join(part if n % 2 else part.replace("[", "\\[") for n, part in enumerate(parts))


def _cell(text: str) -> str:
    return " ".join(_plain(text).split()).replace("|", "\\|")


def _type(schema: Schema, places: dict[str, str], page: str) -> str:
    """Describe the type of a value, with links to the models in it."""
    if "$ref" in schema:
        name = schema["$ref"].removeprefix(_PREFIX)
        where = "" if places[name] == page else places[name]
        return f"[{name}]({where}#{anchor(name)})"
    if "const" in schema:
        return f"`{json.dumps(schema['const'])}`"
    if "enum" in schema:
        return ", ".join(f"`{json.dumps(value)}`" for value in schema["enum"])
    for key in ("anyOf", "oneOf"):
        if key in schema:
            return " or ".join(dict.fromkeys(_type(member, places, page) for member in schema[key]))
    return _simple(schema, places, page)


def _simple(schema: Schema, places: dict[str, str], page: str) -> str:
    kind = schema.get("type", "any JSON value")
    limits = ", ".join(_limit(schema, key, words) for key, words in _LIMITS if key in schema)
    if kind == "array":
        if "prefixItems" in schema:
            members = "; ".join(_type(member, places, page) for member in schema["prefixItems"])
            return f"[{members}]"
        inner = _type(schema.get("items", {}), places, page)
        return f"list of {inner}" + (f" ({limits})" if limits else "")
    if kind == "object":
        named = schema.get("additionalProperties")
        return f"object of {_type(named, places, page)}" if isinstance(named, dict) and named else "object"
    return f"{kind} {limits}".strip()


def _limit(schema: Schema, key: str, words: str) -> str:
    value = schema[key]
    return words + (f"`{value}`".replace("|", "\\|") if isinstance(value, str) else f"{value:.16g}")


def _default(field: str, schema: Schema, required: set[str]) -> str:
    if field in required:
        return "required"
    if "default" not in schema:
        return "—"
    written = json.dumps(schema["default"], ensure_ascii=False).replace("|", "\\|")
    return f"`{written}`"


def _meaning(schema: Schema) -> str:
    measured = schema.get("x-dimension")
    words = [_cell(schema.get("description", ""))]
    if measured and measured not in words[0]:
        words.append(f"*{measured}*")
    return " ".join(filter(None, words))


def _operations(document: Schema, places: dict[str, str]) -> str:
    """Return the page of all operations, grouped by tag."""
    text = [f"# Operations\n\n{_plain(document['info']['description'])}\n\n"]
    for tag in document["tags"]:
        text.append(f"## {tag['name'].capitalize()}\n\n{tag.get('description', '')}\n\n")
        for path, methods in document["paths"].items():
            text += [
                _operation(path, method, operation, places)
                for method, operation in methods.items()
                if tag["name"] in operation.get("tags", ())
            ]
    return "".join(text)


def _operation(path: str, method: str, operation: Schema, places: dict[str, str]) -> str:
    lines = [f"### {operation['summary']} {{ #{operation['operationId'].replace('_', '-')} }}\n"]
    lines += [f"```http\n{method.upper()} {path}\n```\n", f"{_plain(operation.get('description', ''))}\n"]
    if operation.get("parameters"):
        lines += ["| parameter | in | is | meaning |", "|---|---|---|---|"]
        lines += [
            f"| `{each['name']}` | {each['in']} | {_type(each['schema'], places, OPERATIONS)} | "
            f"{_cell(each.get('description') or each['schema'].get('description', ''))} |"
            for each in operation["parameters"]
        ]
        lines.append("")
    for media, content in operation.get("requestBody", {}).get("content", {}).items():
        lines.append(f"Body, `{media}`: {_type(content.get('schema', {}), places, OPERATIONS)}.\n")
    lines += ["| status | body | when |", "|---|---|---|"]
    for status, response in sorted(operation["responses"].items()):
        bodies = [
            f"`{media}` {_type(content['schema'], places, OPERATIONS)}" if content.get("schema") else f"`{media}`"
            for media, content in response.get("content", {}).items()
        ]
        lines.append(f"| {status} | {', '.join(bodies)} | {_cell(response.get('description', ''))} |")
    return "\n".join(lines) + "\n\n"


def written(document: Schema, folder: Path) -> list[tuple[str, str]]:
    """Write the pages for a document below a folder; return their titles and paths there for the navigation."""
    pages = http_reference(document)
    (folder / FOLDER).mkdir(parents=True, exist_ok=True)
    for name, text in pages.items():
        (folder / FOLDER / name).write_text(text, encoding="utf-8")
    titles = {OPERATIONS: "Operations", **{name: title for name, (title, _) in SHARED.items()}}
    return [(titles.get(name, name.removesuffix(".md")), f"{FOLDER}/{name}") for name in pages]
