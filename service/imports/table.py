"""Points from a table of two columns of numbers, one point in each row, with or without a header."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Complex
from kinematics.message import compose
from service.imports.limits import MAX_COLUMNS, MAX_CURVES, MAX_POINTS
from service.outlines.faults import ForeignFormat, MalformedDrawing, UnsuitableDrawing
from service.outlines.formats import MILLIMETRES_PER_UNIT
from service.outlines.limits import MAX_COORDINATE

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_UNIT = re.compile(r"(.*?)\s*[\[(]\s*([A-Za-z]+|°)\s*[\])]")
MAX_CELL_LENGTH = 64
"""Maximum length of a number, or of a name with its unit, characters."""


@dataclass(frozen=True)
class Table:
    """Curves as points x + iy, one for each block of rows; names of the columns; millimetres in their unit."""

    curves: list[Complex]
    names: tuple[str, str] | None
    millimetres: float | None


def read_table(content: bytes) -> Table:
    """Read the points in a table.

    The separator is the first of semicolon, tab, comma and blank that occurs in the first row. Unless it is the comma,
    numbers may have a decimal comma. A first row without numbers names the columns: those named x and y are read,
    otherwise the first two. Both may have a unit: ``x [mm]``. An empty row begins another curve, and text after # is a
    comment.

    Raises
    ------
    ForeignFormat
        If it is not text.
    MalformedDrawing
        If a cell is not a number; the message has its line.
    UnsuitableDrawing
        If there are no points, or too many.
    """
    lines = _decode_text(content).splitlines()
    rows = [(n, line.partition("#")[0].strip()) for n, line in enumerate(lines, 1)]
    first = next((line for _, line in rows if line), None)
    if first is None:
        raise UnsuitableDrawing(compose("imports-table-empty"))
    separator = next((one for one in ";\t," if one in first), None)
    decimal_comma = separator != ","
    names, millimetres, columns = None, None, (0, 1)
    curves: list[list[complex]] = [[]]
    count = 0
    for n, line in rows:
        if not line:
            if curves[-1]:
                curves.append([])
            continue
        cells = [cell.strip().strip('"').strip() for cell in line.split(separator, MAX_COLUMNS)]
        if names is None and not count and _has_names(cells, decimal_comma):
            names, columns, millimetres = _find_columns(cells)
            continue
        if len(cells) <= max(columns) or len(cells) > MAX_COLUMNS:
            raise MalformedDrawing(compose("imports-table-columns", line=f"{n}"))
        curves[-1].append(complex(*(_parse_number(cells[k], decimal_comma, n) for k in columns)))
        count += 1
        if count > MAX_POINTS or len(curves) > MAX_CURVES:
            raise UnsuitableDrawing(compose("imports-table-too-long", points=MAX_POINTS, curves=MAX_CURVES))
    found = [np.array(curve) for curve in curves if curve]
    if not found:
        raise UnsuitableDrawing(compose("imports-table-without-points"))
    return Table(found, names, millimetres)


def _decode_text(content: bytes) -> str:
    encoding = "utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    try:
        text = content.decode(encoding)
    except UnicodeDecodeError:
        # An old 8-bit encoding: only the names can contain other letters, and Latin-1 decodes any bytes.
        text = content.decode("latin-1")
    if any(code < " " and code not in "\t\r\n\f\v" for code in set(text)):
        raise ForeignFormat(compose("imports-foreign-format"))
    return text


def _has_names(cells: list[str], decimal_comma: bool) -> bool:
    return not any(_NUMBER.fullmatch(replace_comma(cell, decimal_comma)) for cell in cells)


def split_unit(cell: str) -> tuple[str, str | None]:
    """Return the name of a column and its unit, as in ``x [mm]``; None if it has no unit."""
    found = _UNIT.fullmatch(cell) if len(cell) <= MAX_CELL_LENGTH else None
    return (found[1], found[2]) if found else (cell, None)


def _find_columns(cells: list[str]) -> tuple[tuple[str, str], tuple[int, int], float | None]:
    """Return the names, indices and unit of the two columns to read."""
    parted = [split_unit(cell) for cell in cells]
    names = [name for name, _ in parted]
    lower = [name.lower() for name in names]
    columns = (lower.index("x"), lower.index("y")) if {"x", "y"} <= set(lower) else (0, 1)
    if len(cells) < 2:
        raise UnsuitableDrawing(compose("imports-table-single-column"))
    stated = {parted[k][1] or "" for k in columns}
    units: dict[str, float] = {unit: MILLIMETRES_PER_UNIT[unit] for unit in MILLIMETRES_PER_UNIT}
    return (names[columns[0]], names[columns[1]]), columns, units.get(stated.pop()) if len(stated) == 1 else None


def replace_comma(cell: str, decimal_comma: bool) -> str:
    """Return the text of a number with a decimal point; ``decimal_comma`` permits a comma in its place."""
    return cell.replace(",", ".", 1) if decimal_comma else cell


def _parse_number(cell: str, decimal_comma: bool, line: int) -> float:
    spelt = replace_comma(cell[: MAX_CELL_LENGTH + 1], decimal_comma)
    if not _NUMBER.fullmatch(spelt) or len(spelt) > MAX_CELL_LENGTH:
        raise MalformedDrawing(compose("imports-table-cell-not-number", line=f"{line}"))
    value = float(spelt)
    if not abs(value) <= MAX_COORDINATE:
        raise UnsuitableDrawing(compose("imports-table-number-too-large", line=f"{line}", limit=f"{MAX_COORDINATE:g}"))
    return value
