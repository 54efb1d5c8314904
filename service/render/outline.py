"""A model as tables: every value of a statement or an answer with its name, unit and meaning.

Glossary:

row     one value of a model: name, value, unit, meaning;
list    the members of a list, or the columns of a table of numbers, as rows; long ones are thinned.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from pydantic import BaseModel

from service.render.page.numbers import length
from service.render.page.svg import clean
from service.units import symbols
from synthesis.model.counting import grouped
from synthesis.model.dimension import Dimension, dimensions
from synthesis.model.statement import StatedProblem

MOST_ROWS = 40
"""Maximum number of rows of a list; longer lists are thinned evenly to this number, keeping both ends."""

MOST_NUMBERS = 16
"""Maximum number of numbers in one row."""

COLUMNS = 9
"""Maximum number of columns of a list that fit on paper."""


_ABSENT = re.compile("null|left out|none (where|of)", re.IGNORECASE)
"""Words in a clause of a description that speaks of a missing value."""


@dataclass(frozen=True)
class Row:
    """A value with its name, unit and meaning."""

    name: str
    value: str
    unit: str = ""
    meaning: str = ""


@dataclass(frozen=True)
class List:
    """Members of a list; ``omitted`` describes in words the part that is not shown."""

    title: str
    heads: list[tuple[str, str]]
    rows: list[list[str]]
    omitted: str = ""


@dataclass
class Outline:
    """A complete model: its rows, then its lists."""

    rows: list[Row] = field(default_factory=list)
    lists: list[List] = field(default_factory=list)


def words(name: str) -> str:
    """Return a name such as ``min_transmission_angle`` as words."""
    text = name.replace("_", " ").strip()
    return text[:1].upper() + text[1:]


def written(value: Any) -> str:
    """Format a value for reading: numbers to six digits, null coordinates as "open", points in parentheses."""
    if value is None:
        return "–"
    # Test bool before int, of which it is a subclass.
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return grouped(value)
    if isinstance(value, float):
        return length(value) if math.isfinite(value) else "–"
    if isinstance(value, tuple) and value and all(entry is None or isinstance(entry, int | float) for entry in value):
        return f"({', '.join('open' if entry is None else written(entry) for entry in value)})"
    if isinstance(value, list | tuple):
        separator = "; " if any(isinstance(entry, BaseModel) for entry in value) else ", "
        return separator.join(written(entry) for entry in value)
    if isinstance(value, Mapping):
        return ", ".join(f"{words(str(key))} {written(entry)}" for key, entry in value.items())
    if isinstance(value, BaseModel):
        return ", ".join(f"{words(key)} {written(entry)}" for key, entry in value if entry is not None)
    return clean(str(value).replace("_", " "))


def with_unit(text: str, unit: str) -> str:
    """Append a unit to a number: after a space, but degree signs directly; an empty string stays empty."""
    if not text:
        return ""
    return f"{text}{unit}" if unit in ("", "°") else f"{text} {unit}"


def entries(
    model: BaseModel,
    problem: StatedProblem,
    leave_out: Iterable[str] = (),
    titles: Mapping[str, str] = MappingProxyType({}),
) -> list[tuple[str, str]]:
    """Return the rows of a model for a sheet: names in lower case, or as given in ``titles``, and values with units."""
    rows = []
    for row in outline(model, symbols(problem), leave_out).rows:
        name = row.name[:1].lower() + row.name[1:]
        rows.append((titles.get(name, name), with_unit(row.value, row.unit)))
    return rows


def outline(
    model: BaseModel, units: Mapping[Dimension, str], leave_out: Iterable[str] = (), last: Iterable[str] = ()
) -> Outline:
    """Return a model as rows and lists, without null values and the fields of ``leave_out``.

    The fields of ``last`` come after the others.
    """
    collected = Outline()
    names = list(type(model).model_fields)
    late = frozenset(last)
    # Two passes: the late fields follow all others.
    _collect(collected, model, units, "", frozenset(leave_out) | late)
    _collect(collected, model, units, "", frozenset(names) - late)
    return collected


def _collect(
    collected: Outline, model: BaseModel, units: Mapping[Dimension, str], prefix: str, leave_out: frozenset[str]
) -> None:
    columns = _columns(model)
    if columns:
        # Lists of numbers of equal length, such as a sampled curve, are columns of one table.
        collected.lists.append(_table_of_columns(model, columns, units, prefix))
    for name, about in type(model).model_fields.items():
        value = getattr(model, name)
        if name in leave_out or name in columns or value is None:
            continue
        measured = dimensions(type(model)).get(name)
        unit = "" if measured is None else units[measured]
        title = words(f"{prefix}: {name}" if prefix else name)
        meaning = _meaning(about.description or "")
        if isinstance(value, BaseModel):
            _collect(collected, value, units, title, frozenset())
        elif isinstance(value, Mapping):
            for key, entry in value.items():
                if isinstance(entry, BaseModel):
                    _collect(collected, entry, units, f"{title}: {key}", frozenset())
                else:
                    collected.rows.append(
                        Row(f"{title}: {clean(str(key).replace('_', ' '))}", written(entry), unit, meaning)
                    )
                    # The meaning is the same for all entries: give it once.
                    meaning = ""
        elif isinstance(value, list) and value and all(isinstance(entry, BaseModel) for entry in value):
            collected.lists.append(_table_of_members(title, value, units))
        elif isinstance(value, list) and len(value) > MOST_NUMBERS:
            collected.rows.append(
                Row(title, f"{len(value)} values", unit, f"In the JSON of the result. {meaning}".strip())
            )
        elif isinstance(value, list | tuple) and not value:
            continue
        else:
            collected.rows.append(Row(title, written(value), unit if _numeric(value) else "", meaning))


def _meaning(description: str) -> str:
    """Return the part of a description that applies to a present value; clauses about null are dropped."""
    clauses = re.split(r"(?<=[.;:]) ", description.replace("`", ""))
    kept = " ".join(clause for clause in clauses if not _ABSENT.search(clause))
    return f"{kept.rstrip(';:.,')}." if kept else ""


def _numeric(value: Any) -> bool:
    if isinstance(value, list | tuple):
        return any(_numeric(entry) for entry in value)
    return isinstance(value, int | float) and not isinstance(value, bool)


def _columns(model: BaseModel) -> list[str]:
    """Return the fields that form one table: at least two lists of numbers, long and of equal length."""
    lists = {name: value for name, value in model if isinstance(value, list) and len(value) > MOST_NUMBERS}
    lengths = {len(value) for value in lists.values()}
    numeric = all(_numeric(value) for value in lists.values())
    return list(lists) if len(lists) > 1 and len(lengths) == 1 and numeric else []


def _head(model: BaseModel, name: str, units: Mapping[Dimension, str], prefix: str = "") -> tuple[str, str]:
    measured = dimensions(type(model)).get(name)
    return words(f"{prefix} {name}".strip()), "" if measured is None else units[measured]


def _table_of_columns(model: BaseModel, columns: list[str], units: Mapping[Dimension, str], prefix: str) -> List:
    values = [getattr(model, name) for name in columns]
    places, omitted = _thinned(len(values[0]))
    rows = [[written(column[k]) for column in values] for k in places]
    return List(prefix, [_head(model, name, units) for name in columns], rows, omitted)


def _table_of_members(title: str, members: Sequence[BaseModel], units: Mapping[Dimension, str]) -> List:
    places, omitted = _thinned(len(members))
    cells = [_cells(members[k], units, "") for k in places]
    heads: list[tuple[str, str]] = []
    for row in cells:
        heads.extend(head for head in row if head not in heads)
    shown = heads[:COLUMNS]
    # Name the dropped columns, so that readers know where to find them.
    if len(heads) > COLUMNS:
        left = ", ".join(name.lower() for name, _ in heads[COLUMNS:])
        omitted = f"{omitted} In the JSON only: {left}.".strip()
    return List(title, shown, [[row.get(head, "") for head in shown] for row in cells], omitted)


def _cells(model: BaseModel, units: Mapping[Dimension, str], prefix: str) -> dict[tuple[str, str], str]:
    """Return the values of a list member; those of nested models are included with prefixed names."""
    cells = {}
    for name, value in model:
        if value is None or (isinstance(value, list) and not value):
            continue
        if isinstance(value, BaseModel):
            cells.update(_cells(value, units, f"{prefix} {name}"))
        else:
            text = f"{len(value)} values" if isinstance(value, list) and len(value) > MOST_NUMBERS else written(value)
            cells[_head(model, name, units, prefix)] = text
    return cells


def _thinned(count: int) -> tuple[list[int], str]:
    if count <= MOST_ROWS:
        return list(range(count)), ""
    # Round evenly spaced indices; the first and last rows are always included.
    places = sorted({round(k * (count - 1) / (MOST_ROWS - 1)) for k in range(MOST_ROWS)})
    return places, f"{len(places)} of {count} are shown; all are in the JSON of the result."
