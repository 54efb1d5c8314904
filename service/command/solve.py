"""``mechsynth solve``: solves a problem from a file, prints the answer as tables, writes the drawings."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path

from pydantic import ValidationError
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from service import client as service
from service.command.inputs import STANDARD_INPUT, SourceError, read_problem
from service.units import list_symbols
from synthesis.model.counting import format_count
from synthesis.model.json_object import JsonObject
from synthesis.registry import parse_problem

_MAX_COLUMNS = 7
"""Maximum number of metrics in a row on a terminal; the files have all of them."""

_FILE_WIDTH = 10_000
"""Width of the output in a file, characters; more than any table needs."""

_OMITTED_KEYS = {"skeleton", "profile", "pitch_curve", "program", "type"}


class SolveFailure(Exception):
    """The problem was not solved; the message has the reason."""


def solve(
    source: str, url: str, key: str | None, output: Path | None, forms: Sequence[str], *, as_json: bool = False
) -> None:
    """Solve the problem in a file (``-``: standard input), print the answer and write the drawings.

    The answer is printed as tables, or as JSON: the job with its problem and its result, every number in full.

    Raises
    ------
    SolveFailure
        If the file contains no problem, or the service does not solve it.
    """
    try:
        problem, label = read_problem(source)
    except SourceError as error:
        raise SolveFailure(str(error)) from None
    folder = (
        output
        if output is not None
        else Path("designs" if source == STANDARD_INPUT else f"{Path(source).stem}-designs")
    )
    with service.Client(url, key) as client:
        try:
            job = _solve_with_progress(client, problem, label)
            if as_json:
                print(json.dumps(asdict(job), ensure_ascii=False))
            else:
                report(job, _create_console())
            written = list(_write_drawings(client, job, folder, forms))
        except service.Refused as refusal:
            raise SolveFailure(f"the service refused the request: {refusal}") from None
        except service.ClientError as error:
            raise SolveFailure(str(error)) from None
    if written:
        print(f"\nwritten: {folder}/ {', '.join(written)}", file=sys.stderr if as_json else sys.stdout)


def _create_console() -> Console:
    """Return the console for tables: as wide as the terminal, or for a file wide enough for any table."""
    return Console(soft_wrap=True) if sys.stdout.isatty() else Console(soft_wrap=True, width=_FILE_WIDTH)


def _solve_with_progress(client: service.Client, problem: JsonObject, label: str | None) -> service.Job:
    # Brief problems end within this second and need no bar.
    job = client.submit(problem, label=label, wait_s=1)
    if not job.finished:
        with _cancel_on_interrupt(client, job.id), _create_bar() as bar:
            task = bar.add_task("queued", total=1.0)
            job = client.wait(job.id, lambda p: bar.update(task, completed=p.fraction, description=p.message))
    if job.result is None:
        raise service.JobFailed(job)
    return job


@contextmanager
def _cancel_on_interrupt(client: service.Client, job_id: str) -> Iterator[None]:
    try:
        yield
    except KeyboardInterrupt:
        # Left alone, the job might keep a worker busy for minutes.
        client.delete(job_id)
        raise SolveFailure("interrupted; the job is cancelled") from None


def _create_bar() -> Progress:
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:>3.0f} %"))
    # On standard error, so that the output can be redirected to a file.
    return Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True), transient=True)


def report(job: service.Job, console: Console) -> None:
    """Print the result of the search, a comparison of the designs, and the best design in full."""
    result = job.result or {}
    search, designs = result["search"], result["designs"]
    known = "complete: no other designs exist" if search["complete"] else "not complete: other designs may exist"
    # Texts of the service may contain square brackets, which rich would take as markup.
    console.print(result["summary"], markup=False, highlight=False)
    console.print(f"Search: {search['method']}, {known}.", markup=False, highlight=False)
    if not designs:
        return
    console.print()
    console.print(_compare_designs(designs))
    best = designs[0]
    unit = job.problem.get("length_unit")
    table = Table(title=f"Design 1: {best['mechanism']['type']}" + (f", lengths in {unit}" if unit else ""))
    table.add_column("dimension")
    table.add_column("value", justify="right")
    for name, value in _flatten_dimensions(best["mechanism"]):
        table.add_row(name, value)
    console.print(table)
    table = Table(title="Checks of design 1, when driven")
    for name in ("check", "", "value", "limit"):
        table.add_column(name, justify="right" if name in ("value", "limit") else "left")
    units = _find_units(job.problem)
    for check in best["verification"]["checks"]:
        unit = units.get(check.get("dimension"), "")
        verdict = "passed" if check["passed"] else "FAILED"
        table.add_row(check["name"], verdict, *(_format_amount(check.get(name), unit) for name in ("value", "limit")))
    console.print(table)


def _format_amount(value: float | None, unit: str) -> str:
    if value is None:
        return ""
    return f"{_format_value(value)}{unit}" if unit in ("", "°") else f"{_format_value(value)} {unit}"


def _find_units(problem: JsonObject) -> dict[str, str]:
    """Return unit symbols by dimension; none for a problem of a newer service, which this client cannot parse."""
    try:
        return {str(dimension): symbol for dimension, symbol in list_symbols(parse_problem(dict(problem))).items()}
    except ValidationError:
        return {}


def _compare_designs(designs: Sequence[JsonObject]) -> Table:
    plain = [name for name, value in designs[0]["metrics"].items() if isinstance(value, (int, float, str))]
    # Metrics that are equal for all designs do not help to choose one.
    telling = [name for name in plain if len({str(design["metrics"].get(name)) for design in designs}) > 1]
    columns = (telling or plain)[:_MAX_COLUMNS]
    table = Table(title=f"{format_count(len(designs), 'design')}, best first")
    table.add_column("", justify="right")
    table.add_column("mechanism")
    for name in columns:
        table.add_column(name.replace("_", " "), justify="right")
    for n, design in enumerate(designs):
        metrics = design["metrics"]
        table.add_row(str(n + 1), design["mechanism"]["type"], *(_format_value(metrics.get(name)) for name in columns))
    return table


def _flatten_dimensions(value: object, name: str = "") -> Iterator[tuple[str, str]]:
    """Yield every dimension with the path of its name; long lists and derived data are left to the files."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in _OMITTED_KEYS:
                yield from _flatten_dimensions(inner, f"{name} {key}".strip().replace("_", " "))
    elif isinstance(value, list) and any(isinstance(inner, (dict, list)) for inner in value):
        for n, inner in enumerate(value):
            yield from _flatten_dimensions(inner, f"{name} {n}")
    elif isinstance(value, list):
        if value and len(value) <= _MAX_COLUMNS:
            yield name, ", ".join(map(_format_value, value))
    elif value is not None:
        yield name, _format_value(value)


def _format_value(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _write_drawings(client: service.Client, job: service.Job, folder: Path, forms: Sequence[str]) -> Iterator[str]:
    assert job.result is not None
    for n in range(len(job.result["designs"])):
        for form in forms:
            content = client.file(job.id, n, form)
            if content is not None:
                # Only now, so that an answer without files leaves no empty folder.
                folder.mkdir(parents=True, exist_ok=True)
                (folder / f"design-{n + 1}.{form}").write_bytes(content)
                yield f"design-{n + 1}.{form}"
