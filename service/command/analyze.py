"""``mechsynth analyze``: the analysis of a mechanism in a file, as JSON or as a table."""

from __future__ import annotations

import csv
import io
import json
import sys
from collections.abc import Iterator
from pathlib import Path

from rich.console import Console
from rich.table import Table

from service import client as service
from service.command.inputs import SourceError, read_object
from service.command.local import analyze_here, find_service
from service.command.tables import create_console, flatten_values, format_value
from synthesis.model.json_object import JsonObject


def analyze(source: str, url: str | None, key: str | None, output: Path | None, *, as_json: bool = False) -> None:
    """Print the analysis of a mechanism or request body in a file, or write it to a file.

    Tables are printed, or JSON. Without the URL of a service, and without one on this machine, the mechanism is
    analysed in this process. Numbers in files and in JSON are written in full. A file whose name ends in ``.csv`` has a
    column for each quantity with one value per position of the input, named by its place in the answer:
    ``joints.A.x``.

    Raises
    ------
    SourceError
        If the file contains no mechanism.
    service.ClientError
        If the service does not analyse it.
    """
    content = read_object(source)
    # The motion may be left out: the service has a default.
    request = content if "mechanism" in content else {"mechanism": content}
    if not isinstance(request["mechanism"], dict):
        raise SourceError(f"{source} contains no mechanism")
    place = find_service(url)
    if place is None:
        answer = analyze_here(request)
    else:
        with service.Client(place, key) as client:
            answer = client.analysis(request)
    if output is None and not as_json:
        report(answer, create_console())
        return
    table = output is not None and output.suffix.lower() == ".csv"
    text = _format_table(source, answer) if table else json.dumps(answer, ensure_ascii=False) + "\n"
    if output is None:
        sys.stdout.write(text)
    else:
        output.parent.mkdir(parents=True, exist_ok=True)
        # Written as it is: CSV already has its line ends.
        output.write_text(text, encoding="utf-8", newline="")


def report(answer: JsonObject, console: Console) -> None:
    """Print the single values of an analysis, and the range of each quantity over the motion."""
    inputs = answer.get("input_angle") or []
    table = Table(title="Values")
    for name in ("quantity", "value"):
        table.add_column(name, justify="right" if name == "value" else "left")
    for name, value in flatten_values(answer):
        table.add_row(name, value)
    if table.row_count:
        console.print(table)
    ranges = Table(title=f"Over {len(inputs)} positions of the input")
    for name in ("quantity", "least", "at input", "greatest", "at input"):
        ranges.add_column(name, justify="left" if name == "quantity" else "right")
    for name, values in _iterate_lists("", answer):
        numbers = [
            (value, k)
            for k, value in enumerate(values)
            if isinstance(value, int | float) and not isinstance(value, bool)
        ]
        # Where the mechanism cannot be assembled, the values are null.
        if len(values) != len(inputs) or name == "input_angle" or not numbers:
            continue
        ends = min(numbers), max(numbers, key=lambda number: number[0])
        places = [format_value(x) for value, k in ends for x in (value, inputs[k])]
        ranges.add_row(name, *places)
    if ranges.row_count:
        console.print(ranges)


def _format_table(source: str, answer: JsonObject) -> str:
    count = len(answer.get("input_angle", ()))
    columns = {name: values for name, values in _iterate_lists("", answer) if len(values) == count > 0}
    if not columns:
        raise SourceError(f"{source}: this analysis has no values over the motion; write a .json file")
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(columns)
    rows.writerows(zip(*columns.values(), strict=True))
    return text.getvalue()


def _iterate_lists(place: str, value: object) -> Iterator[tuple[str, list[object]]]:
    """Yield every list of plain values in an answer with its place."""
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from _iterate_lists(f"{place}.{name}" if place else name, inner)
    elif isinstance(value, list) and not any(isinstance(inner, dict | list) for inner in value):
        yield place, value
    elif isinstance(value, list):
        for n, inner in enumerate(value):
            yield from _iterate_lists(f"{place}.{n}", inner)
