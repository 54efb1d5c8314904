"""Inputs of the command line: problems as JSON or tables, requests, and answers written by it."""

from __future__ import annotations

import csv
import io
import json
import sys
from pathlib import Path

from synthesis.model.json_object import JsonObject
from synthesis.registry import KINDS

STANDARD_INPUT = "-"


class SourceError(Exception):
    """A file cannot be used; the message has the reason."""


_TABLES = {name: kind.columns for name, kind in KINDS.items() if kind.columns is not None}
"""Columns of tables by kind. A table states a problem of the first kind whose columns it has."""

_SEPARATORS = ",;\t"


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
    # The most frequent separator of the header is that of the table.
    head = text.partition("\n")[0]
    rows = csv.DictReader(io.StringIO(text), delimiter=max(_SEPARATORS, key=head.count), skipinitialspace=True)
    names = {(name or "").strip() for name in rows.fieldnames or ()}
    kind = next((kind for kind, columns in _TABLES.items() if names >= set(columns.required)), None)
    if kind is None:
        known = "; ".join(f"{', '.join(columns.required)} ({kind})" for kind, columns in _TABLES.items())
        raise SourceError(f"{source}: the first line must name the columns: {known}")
    listed = []
    for row in rows:
        # The csv module collects surplus cells under None.
        if None in row:
            raise SourceError(f"{source}, line {rows.line_num}: more cells than columns")
        cells = ((name.strip(), (cell or "").strip()) for name, cell in row.items())
        listed.append({name: _parse_value(source, rows.line_num, name, cell) for name, cell in cells if cell})
    return {"kind": kind, _TABLES[kind].field: [cells for cells in listed if cells]}


def _parse_value(source: str, line: int, name: str, cell: str) -> object:
    try:
        # As JSON, so that tables and JSON files accept the same numbers.
        value = json.loads(cell, parse_constant=float)
    except ValueError:
        value = None
    if not isinstance(value, bool | int | float) or value != value or abs(value) == float("inf"):
        raise SourceError(f"{source}, line {line}: {name} is not a number: {cell}")
    return value
