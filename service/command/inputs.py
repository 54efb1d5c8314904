"""Inputs of the command line: problems as JSON or tables, requests, and answers written by it."""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import get_args

from service.imports.table import replace_comma, split_unit
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import ProblemBase
from synthesis.registry import KINDS

STANDARD_INPUT = "-"


class SourceError(Exception):
    """A file cannot be used; the message has the reason."""


_TABLES = {name: kind.columns for name, kind in KINDS.items() if kind.columns is not None}
"""Columns of tables by kind. A table states a problem of the first kind whose columns it has."""

_SEPARATORS = ",;\t"

_LENGTH_UNITS: tuple[str, ...] = get_args(ProblemBase.model_fields["length_unit"].annotation)

_DEGREES = {"deg", "degree", "degrees", "°"}

MIN_CLOSED_POINTS = 3
"""Number of points above which a path that ends where it began is closed."""


def read_problem(source: str) -> tuple[JsonObject, str | None]:
    """Read the problem and its label from a problem, a request body, or a table in a ``.csv`` file."""
    # The name of the file is the label of the job, unless the request has one.
    label = None if source == STANDARD_INPUT else Path(source).stem
    if Path(source).suffix.lower() == ".csv":
        return _parse_table(source, read_text(source)), label
    content = read_object(source)
    inner = content.get("problem")
    if isinstance(inner, dict):  # a request body
        return inner, content.get("label")
    return content, label


def read_object(source: str) -> JsonObject:
    """Read the JSON object in a file."""
    try:
        content = json.loads(read_text(source))
    except ValueError as error:
        raise SourceError(f"{source} is not JSON: {error}") from None
    if not isinstance(content, dict):
        raise SourceError(f"{source} contains no JSON object")
    return content


def read_text(source: str) -> str:
    """Read the text of a file or of standard input."""
    try:
        # Spreadsheets put a byte order mark first, which `utf-8-sig` skips.
        return sys.stdin.read() if source == STANDARD_INPUT else Path(source).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8"
        raise SourceError(f"cannot read {source} ({reason})") from None


def _parse_table(source: str, text: str) -> JsonObject:
    """Parse a table with names of fields in its first line, with the rules of the service for tables of curves.

    Unless commas separate the cells, numbers may have decimal commas. Text after # is a comment. Columns may have
    units, ``x [mm]``. A path that ends where it began is closed.
    """
    lines = [line.partition("#")[0].rstrip() for line in text.splitlines()]
    # Comments and empty lines may precede the names.
    start = next((n for n, line in enumerate(lines) if line.strip()), 0)
    # The most frequent separator of the header is that of the table.
    head = lines[start] if lines else ""
    separator = max(_SEPARATORS, key=head.count)
    rows = csv.DictReader(lines[start:], delimiter=separator, skipinitialspace=True)
    stated = [split_unit((name or "").strip()) for name in rows.fieldnames or ()]
    rows.fieldnames = [name for name, _ in stated]
    names = set(rows.fieldnames)
    kind = next((kind for kind, columns in _TABLES.items() if names >= set(columns.required)), None)
    if kind is None:
        known = "; ".join(f"{', '.join(columns.required)} ({kind})" for kind, columns in _TABLES.items())
        raise SourceError(f"{source}: the first line must name the columns: {known}")
    listed = []
    for row in rows:
        # The csv module collects surplus cells under None.
        if None in row:
            raise SourceError(f"{source}, line {start + rows.line_num}: more cells than columns")
        cells = ((name, replace_comma((cell or "").strip(), separator != ",")) for name, cell in row.items())
        listed.append({name: _parse_value(source, start + rows.line_num, name, cell) for name, cell in cells if cell})
    found = [cells for cells in listed if cells]
    problem: JsonObject = {"kind": kind, _TABLES[kind].field: found}
    unit = _find_length_unit(source, stated)
    if unit is not None:
        problem["length_unit"] = unit
    ends = [{name: cells.get(name) for name in ("x", "y")} for cells in (found[:1] + found[-1:])]
    if _TABLES[kind].closes and len(found) > MIN_CLOSED_POINTS and ends[0] == ends[1]:
        found.pop()
        problem["closed"] = True
    return problem


def _find_length_unit(source: str, columns: Sequence[tuple[str, str | None]]) -> str | None:
    """Return the length unit of the columns; None if they state none."""
    units = {name: unit for name, unit in columns if unit is not None}
    wrong = next((name for name in units if "angle" in name and units[name].lower() not in _DEGREES), None)
    if wrong is not None:
        raise SourceError(f"{source}: {wrong} is in {units[wrong]}; angles are in degrees")
    lengths = {unit for name, unit in units.items() if unit.lower() not in _DEGREES}
    if len(lengths) > 1:
        raise SourceError(f"{source}: the columns have different units: {', '.join(sorted(lengths))}")
    unit = next(iter(lengths), None)
    if unit is not None and unit not in _LENGTH_UNITS:
        raise SourceError(f"{source}: unknown length unit {unit}; known: {', '.join(_LENGTH_UNITS)}")
    return unit


def _parse_value(source: str, line: int, name: str, cell: str) -> object:
    try:
        # As JSON, so that tables and JSON files accept the same numbers.
        value = json.loads(cell, parse_constant=float)
    except ValueError:
        value = None
    if not isinstance(value, bool | int | float) or value != value or abs(value) == float("inf"):
        raise SourceError(f"{source}, line {line}: {name} is not a number: {cell}")
    return value
