"""A model in tables: every value of a statement or an answer with its name, its unit and what it means.

Glossary:

row     one value of a model: name, value, unit, meaning;
list    the members of a list, or the columns of a table of numbers, below one another; long ones are thinned.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel

from service.render.page.numbers import length
from service.render.page.svg import clean
from synthesis.model.dimension import Dimension, dimensions

MOST_ROWS = 40
"""Rows of a list at most; of longer ones so many are shown, evenly spread, with both ends."""

MOST_NUMBERS = 16
"""Numbers that stand in one row at most."""

COLUMNS = 9
"""Columns of a list at most: more are no table on paper."""


GROUPED = 10_000
"""Whole numbers from here on have their digits in groups of three."""


_ABSENT = re.compile("null|left out|none (where|of)", re.IGNORECASE)
"""What a clause has that speaks of a value that is not there."""


@dataclass(frozen=True)
class Row:
    """A value with its name, unit and meaning."""

    name: str
    value: str
    unit: str = ""
    meaning: str = ""


@dataclass(frozen=True)
class List:
    """Members of a list; ``omitted`` says in words what of it is not shown."""

    title: str
    heads: list[tuple[str, str]]
    rows: list[list[str]]
    omitted: str = ""


@dataclass
class Outline:
    """All of a model: its rows, and its lists after them."""

    rows: list[Row] = field(default_factory=list)
    lists: list[List] = field(default_factory=list)


def words(name: str) -> str:
    """``min_transmission_angle`` as words."""
    text = name.replace("_", " ").strip()
    return text[:1].upper() + text[1:]


def written(value: Any) -> str:
    """A value for reading: six digits, open coordinates as such, points in parentheses."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return (
            f"{value:,}".replace(",", "\u202f").replace("-", "−")
            if abs(value) >= GROUPED
            else str(value).replace("-", "−")
        )
    if isinstance(value, float):
        return length(value) if math.isfinite(value) else "–"
    if isinstance(value, tuple) and value and all(one is None or isinstance(one, int | float) for one in value):
        return f"({', '.join('open' if one is None else written(one) for one in value)})"
    if isinstance(value, list | tuple):
        return ("; " if any(isinstance(one, BaseModel) for one in value) else ", ").join(written(one) for one in value)
    if isinstance(value, Mapping):
        return ", ".join(f"{words(str(key))} {written(one)}" for key, one in value.items())
    if isinstance(value, BaseModel):
        return ", ".join(f"{words(key)} {written(one)}" for key, one in value if one is not None)
    return clean(str(value).replace("_", " "))


def outline(
    model: BaseModel, symbols: Mapping[Dimension, str], leave_out: Iterable[str] = (), last: Iterable[str] = ()
) -> Outline:
    """A model as rows and lists; what is null is left out, and so are the fields of ``leave_out``.

    The fields of ``last`` come after the others.
    """
    found = Outline()
    names = list(type(model).model_fields)
    late = frozenset(last)
    _collect(found, model, symbols, "", frozenset(leave_out) | late)
    _collect(found, model, symbols, "", frozenset(names) - late)
    return found


def _collect(
    found: Outline, model: BaseModel, symbols: Mapping[Dimension, str], prefix: str, leave_out: frozenset[str]
) -> None:
    columns = _columns(model)
    if columns:
        found.lists.append(_table_of_columns(model, columns, symbols, prefix))
    for name, about in type(model).model_fields.items():
        value = getattr(model, name)
        if name in leave_out or name in columns or value is None:
            continue
        measured = dimensions(type(model)).get(name)
        unit = "" if measured is None else symbols[measured]
        title = words(f"{prefix}: {name}" if prefix else name)
        meaning = _meaning(about.description or "")
        if isinstance(value, BaseModel):
            _collect(found, value, symbols, title, frozenset())
        elif isinstance(value, Mapping):
            for key, one in value.items():
                if isinstance(one, BaseModel):
                    _collect(found, one, symbols, f"{title}: {key}", frozenset())
                else:
                    found.rows.append(Row(f"{title}: {clean(str(key).replace('_', ' '))}", written(one), unit, meaning))
                    meaning = ""
        elif isinstance(value, list) and value and all(isinstance(one, BaseModel) for one in value):
            found.lists.append(_table_of_members(title, value, symbols))
        elif isinstance(value, list) and len(value) > MOST_NUMBERS:
            found.rows.append(Row(title, f"{len(value)} values", unit, f"In the JSON of the result. {meaning}".strip()))
        elif isinstance(value, list | tuple) and not value:
            continue
        else:
            found.rows.append(Row(title, written(value), unit if _numeric(value) else "", meaning))


def _meaning(description: str) -> str:
    """What a description says of a value that is there: not what it would be if it were left out."""
    clauses = re.split(r"(?<=[.;:]) ", description.replace("`", ""))
    kept = " ".join(clause for clause in clauses if not _ABSENT.search(clause))
    return f"{kept.rstrip(';:.,')}." if kept else ""


def _numeric(value: Any) -> bool:
    if isinstance(value, list | tuple):
        return any(_numeric(one) for one in value)
    return isinstance(value, int | float) and not isinstance(value, bool)


def _columns(model: BaseModel) -> list[str]:
    """The fields of a model that are columns of one table: two and more lists of numbers, long and equally so."""
    lists = {name: value for name, value in model if isinstance(value, list) and len(value) > MOST_NUMBERS}
    lengths = {len(value) for value in lists.values()}
    numeric = all(_numeric(value) for value in lists.values())
    return list(lists) if len(lists) > 1 and len(lengths) == 1 and numeric else []


def _head(model: BaseModel, name: str, symbols: Mapping[Dimension, str], prefix: str = "") -> tuple[str, str]:
    measured = dimensions(type(model)).get(name)
    return words(f"{prefix} {name}".strip()), "" if measured is None else symbols[measured]


def _table_of_columns(model: BaseModel, columns: list[str], symbols: Mapping[Dimension, str], prefix: str) -> List:
    values = [getattr(model, name) for name in columns]
    places, omitted = _thinned(len(values[0]))
    rows = [[written(column[k]) for column in values] for k in places]
    return List(prefix, [_head(model, name, symbols) for name in columns], rows, omitted)


def _table_of_members(title: str, members: Sequence[BaseModel], symbols: Mapping[Dimension, str]) -> List:
    places, omitted = _thinned(len(members))
    cells = [_cells(members[k], symbols, "") for k in places]
    heads: list[tuple[str, str]] = []
    for one in cells:
        heads.extend(head for head in one if head not in heads)
    shown = heads[:COLUMNS]
    if len(heads) > COLUMNS:
        left = ", ".join(name.lower() for name, _ in heads[COLUMNS:])
        omitted = f"{omitted} In the JSON only: {left}.".strip()
    return List(title, shown, [[one.get(head, "") for head in shown] for one in cells], omitted)


def _cells(model: BaseModel, symbols: Mapping[Dimension, str], prefix: str) -> dict[tuple[str, str], str]:
    """The values of a member of a list; those of a model within it stand among them."""
    found = {}
    for name, value in model:
        if value is None or (isinstance(value, list) and not value):
            continue
        if isinstance(value, BaseModel):
            found.update(_cells(value, symbols, f"{prefix} {name}"))
        else:
            text = f"{len(value)} values" if isinstance(value, list) and len(value) > MOST_NUMBERS else written(value)
            found[_head(model, name, symbols, prefix)] = text
    return found


def _thinned(count: int) -> tuple[list[int], str]:
    if count <= MOST_ROWS:
        return list(range(count)), ""
    places = sorted({round(k * (count - 1) / (MOST_ROWS - 1)) for k in range(MOST_ROWS)})
    return places, f"{len(places)} of {count} are shown; all are in the JSON of the result."
