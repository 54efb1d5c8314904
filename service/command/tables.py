"""Tables of the command line: the console on which they are printed, and the texts of their values."""

from __future__ import annotations

import sys
from collections.abc import Iterator

from rich.console import Console

MAX_COLUMNS = 7
"""Maximum number of metrics in a row on a terminal; the files have all of them."""

_FILE_WIDTH = 10_000
"""Width of the output in a file, characters; more than any table needs."""

_OMITTED_KEYS = {"skeleton", "profile", "pitch_curve", "program", "type"}


def create_console() -> Console:
    """Return the console for tables: as wide as the terminal, or for a file wide enough for any table."""
    return Console(soft_wrap=True) if sys.stdout.isatty() else Console(soft_wrap=True, width=_FILE_WIDTH)


def flatten_values(value: object, name: str = "") -> Iterator[tuple[str, str]]:
    """Yield every dimension with the path of its name; long lists and derived data are left to the files."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in _OMITTED_KEYS:
                yield from flatten_values(inner, f"{name} {key}".strip().replace("_", " "))
    elif isinstance(value, list) and any(isinstance(inner, (dict, list)) for inner in value):
        for n, inner in enumerate(value):
            yield from flatten_values(inner, f"{name} {n}")
    elif isinstance(value, list):
        if value and len(value) <= MAX_COLUMNS:
            yield name, ", ".join(map(format_value, value))
    elif value is not None:
        yield name, format_value(value)


def format_value(value: object) -> str:
    """Write a value with six digits; an empty text for none."""
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)
