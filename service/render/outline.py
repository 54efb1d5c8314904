"""Tables of a model's values: every value of a problem or an answer with its name, unit and meaning.

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

from pydantic import BaseModel

from service.render.page.numbers import format_length
from service.render.page.svg import clean_text
from service.units import list_symbols
from synthesis.model.counting import format_integer
from synthesis.model.dimension import Dimension, collect_dimensions
from synthesis.model.problem import ProblemBase

MAX_ROWS = 40
"""Maximum number of rows of a list; longer lists are thinned evenly to this number, keeping both ends."""

MAX_NUMBERS = 16
"""Maximum number of numbers in one row."""

MAX_COLUMNS = 9
"""Maximum number of columns of a list that fit on paper."""


_ABSENCE_PATTERN = re.compile("null|left out|none (where|of)", re.IGNORECASE)
"""Words in a clause of a description that speaks of a missing value."""


@dataclass(frozen=True)
class Row:
    """A value with its name, unit and meaning."""

    name: str
    value: str
    unit: str = ""
    meaning: str = ""


@dataclass(frozen=True)
class MemberList:
    """Members of a list; ``omitted`` describes in words the part that is not shown."""

    title: str
    heads: list[tuple[str, str]]
    rows: list[list[str]]
    omitted: str = ""


@dataclass
class Outline:
    """A complete model: its rows, then its lists."""

    rows: list[Row] = field(default_factory=list)
    lists: list[MemberList] = field(default_factory=list)


def format_name(name: str) -> str:
    """Return a name such as ``min_transmission_angle`` as words."""
    text = name.replace("_", " ").strip()
    return text[:1].upper() + text[1:]


def format_value(value: object) -> str:
    """Format a value for reading: numbers to six digits, null coordinates as "open", points in parentheses."""
    if value is None:
        return "–"
    # Test bool before int, of which it is a subclass.
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return format_integer(value)
    if isinstance(value, float):
        return format_length(value) if math.isfinite(value) else "–"
    if isinstance(value, tuple) and value and all(entry is None or isinstance(entry, int | float) for entry in value):
        return f"({', '.join('open' if entry is None else format_value(entry) for entry in value)})"
    if isinstance(value, list | tuple):
        separator = "; " if any(isinstance(entry, BaseModel) for entry in value) else ", "
        return separator.join(format_value(entry) for entry in value)
    if isinstance(value, Mapping):
        return ", ".join(f"{format_name(str(key))} {format_value(entry)}" for key, entry in value.items())
    if isinstance(value, BaseModel):
        return ", ".join(f"{format_name(key)} {format_value(entry)}" for key, entry in value if entry is not None)
    return clean_text(str(value).replace("_", " "))


def add_unit(text: str, unit: str) -> str:
    """Append a unit to a number: after a space, but degree signs directly; an empty string stays empty."""
    if not text:
        return ""
    return f"{text}{unit}" if unit in ("", "°") else f"{text} {unit}"


def list_entries(
    model: BaseModel,
    problem: ProblemBase,
    leave_out: Iterable[str] = (),
    titles: Mapping[str, str] = MappingProxyType({}),
) -> list[tuple[str, str]]:
    """Return the rows of a model for a sheet: names in lower case, or as given in ``titles``, and values with units."""
    rows = []
    for row in make_outline(model, list_symbols(problem), leave_out).rows:
        name = row.name[:1].lower() + row.name[1:]
        rows.append((titles.get(name, name), add_unit(row.value, row.unit)))
    return rows


def make_outline(
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
    columns = _find_columns(model)
    if columns:
        # Lists of numbers of equal length, such as a sampled curve, are columns of one table.
        collected.lists.append(_make_column_table(model, columns, units, prefix))
    for name, about in type(model).model_fields.items():
        value = getattr(model, name)
        if name in leave_out or name in columns or value is None:
            continue
        measured = collect_dimensions(type(model)).get(name)
        unit = "" if measured is None else units[measured]
        title = format_name(f"{prefix}: {name}" if prefix else name)
        meaning = _extract_meaning(about.description or "")
        if isinstance(value, BaseModel):
            _collect(collected, value, units, title, frozenset())
        elif isinstance(value, Mapping):
            for key, entry in value.items():
                if isinstance(entry, BaseModel):
                    _collect(collected, entry, units, f"{title}: {key}", frozenset())
                else:
                    collected.rows.append(
                        Row(f"{title}: {clean_text(str(key).replace('_', ' '))}", format_value(entry), unit, meaning)
                    )
                    # The meaning is the same for all entries: give it once.
                    meaning = ""
        elif isinstance(value, list) and value and all(isinstance(entry, BaseModel) for entry in value):
            collected.lists.append(_make_member_table(title, value, units))
        elif isinstance(value, list) and len(value) > MAX_NUMBERS:
            collected.rows.append(
                Row(title, f"{len(value)} values", unit, f"In the JSON of the result. {meaning}".strip())
            )
        elif isinstance(value, list | tuple) and not value:
            continue
        else:
            collected.rows.append(Row(title, format_value(value), unit if _is_numeric(value) else "", meaning))


def _extract_meaning(description: str) -> str:
    """Return the part of a description that applies to a present value; clauses about null are dropped."""
    clauses = re.split(r"(?<=[.;:]) ", description.replace("`", ""))
    kept = " ".join(clause for clause in clauses if not _ABSENCE_PATTERN.search(clause))
    return f"{kept.rstrip(';:.,')}." if kept else ""


def _is_numeric(value: object) -> bool:
    if isinstance(value, list | tuple):
        return any(_is_numeric(entry) for entry in value)
    return isinstance(value, int | float) and not isinstance(value, bool)


def _find_columns(model: BaseModel) -> list[str]:
    """Return the fields that form one table: at least two lists of numbers, long and of equal length."""
    lists = {name: value for name, value in model if isinstance(value, list) and len(value) > MAX_NUMBERS}
    lengths = {len(value) for value in lists.values()}
    numeric = all(_is_numeric(value) for value in lists.values())
    return list(lists) if len(lists) > 1 and len(lengths) == 1 and numeric else []


def _make_head(model: BaseModel, name: str, units: Mapping[Dimension, str], prefix: str = "") -> tuple[str, str]:
    measured = collect_dimensions(type(model)).get(name)
    return format_name(f"{prefix} {name}".strip()), "" if measured is None else units[measured]


def _make_column_table(model: BaseModel, columns: list[str], units: Mapping[Dimension, str], prefix: str) -> MemberList:
    values = [getattr(model, name) for name in columns]
    places, omitted = _select_rows(len(values[0]))
    rows = [[format_value(column[k]) for column in values] for k in places]
    return MemberList(prefix, [_make_head(model, name, units) for name in columns], rows, omitted)


def _make_member_table(title: str, members: Sequence[BaseModel], units: Mapping[Dimension, str]) -> MemberList:
    places, omitted = _select_rows(len(members))
    cells = [_collect_cells(members[k], units, "") for k in places]
    heads: list[tuple[str, str]] = []
    for row in cells:
        heads.extend(head for head in row if head not in heads)
    shown = heads[:MAX_COLUMNS]
    # Name the dropped columns, so that readers know where to find them.
    if len(heads) > MAX_COLUMNS:
        left = ", ".join(name.lower() for name, _ in heads[MAX_COLUMNS:])
        omitted = f"{omitted} In the JSON only: {left}.".strip()
    return MemberList(title, shown, [[row.get(head, "") for head in shown] for row in cells], omitted)


def _collect_cells(model: BaseModel, units: Mapping[Dimension, str], prefix: str) -> dict[tuple[str, str], str]:
    """Return the values of a list member; those of nested models are included with prefixed names."""
    cells = {}
    for name, value in model:
        if value is None or (isinstance(value, list) and not value):
            continue
        if isinstance(value, BaseModel):
            cells.update(_collect_cells(value, units, f"{prefix} {name}"))
        else:
            text = (
                f"{len(value)} values" if isinstance(value, list) and len(value) > MAX_NUMBERS else format_value(value)
            )
            cells[_make_head(model, name, units, prefix)] = text
    return cells


def _select_rows(count: int) -> tuple[list[int], str]:
    if count <= MAX_ROWS:
        return list(range(count)), ""
    # Round evenly spaced indices; the first and last rows are always included.
    places = sorted({round(k * (count - 1) / (MAX_ROWS - 1)) for k in range(MAX_ROWS)})
    return places, f"{len(places)} of {count} are shown; all are in the JSON of the result."
