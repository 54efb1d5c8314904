"""``mechsynth solve``: solves a problem from a file, prints the answer as tables, writes the drawings."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from functools import partial
from pathlib import Path

from pydantic import ValidationError
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from service import client as service
from service.command.inputs import STANDARD_INPUT, SourceError, read_problem
from service.command.local import draw_here, find_service, solve_here
from service.command.tables import MAX_COLUMNS, create_console, flatten_values, format_value
from service.units import list_symbols
from synthesis.model.counting import format_count
from synthesis.model.json_object import JsonObject
from synthesis.registry import parse_problem

Draw = Callable[[int, str], bytes | None]
"""Function that draws a design, counted from 0, in a format; None if the design has no such file."""


class SolveFailure(Exception):
    """The problem was not solved; the message has the reason."""


def solve(
    source: str, url: str | None, key: str | None, output: Path | None, forms: Sequence[str], *, as_json: bool = False
) -> None:
    """Solve the problem in a file (``-``: standard input), print the answer and write the drawings.

    Without the URL of a service, and without one on this machine, the problem is solved in this process. The answer is
    printed as tables, or as JSON: the job with its problem and its result, every number in full.

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
    place = find_service(url)
    try:
        if place is None:
            job, draw = _solve_locally(problem, label)
            written = _report_and_draw(job, draw, folder, forms, as_json=as_json)
        else:
            with service.Client(place, key) as client:
                job = _solve_with_progress(client, problem, label)
                draw = partial(client.file, job.id)
                written = _report_and_draw(job, draw, folder, forms, as_json=as_json)
    except service.Refused as refusal:
        raise SolveFailure(f"the request was refused: {refusal}") from None
    except service.ClientError as error:
        raise SolveFailure(str(error)) from None
    if written:
        print(f"\nwritten: {folder}/ {', '.join(written)}", file=sys.stderr if as_json else sys.stdout)


def _report_and_draw(job: service.Job, draw: Draw, folder: Path, forms: Sequence[str], *, as_json: bool) -> list[str]:
    """Print the answer and write the drawings; return the names of the files."""
    if as_json:
        print(json.dumps(asdict(job), ensure_ascii=False))
    else:
        report(job, create_console())
    return list(_write_drawings(draw, job, folder, forms))


def _solve_locally(problem: JsonObject, label: str | None) -> tuple[service.Job, Draw]:
    """Solve a problem in this process; return its job and the function that draws its designs."""
    try:
        with _create_bar() as bar:
            task = bar.add_task("loading", total=1.0)
            job, read = solve_here(
                problem, label, lambda share, message: bar.update(task, completed=share, description=message)
            )
    except KeyboardInterrupt:
        raise SolveFailure("interrupted") from None
    return job, partial(draw_here, job, read)


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
    for name, value in flatten_values(best["mechanism"]):
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
    return f"{format_value(value)}{unit}" if unit in ("", "°") else f"{format_value(value)} {unit}"


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
    columns = (telling or plain)[:MAX_COLUMNS]
    table = Table(title=f"{format_count(len(designs), 'design')}, best first")
    table.add_column("", justify="right")
    table.add_column("mechanism")
    for name in columns:
        table.add_column(name.replace("_", " "), justify="right")
    for n, design in enumerate(designs):
        metrics = design["metrics"]
        table.add_row(str(n + 1), design["mechanism"]["type"], *(format_value(metrics.get(name)) for name in columns))
    return table


def _write_drawings(draw: Draw, job: service.Job, folder: Path, forms: Sequence[str]) -> Iterator[str]:
    assert job.result is not None
    for n in range(len(job.result["designs"])):
        for form in forms:
            content = draw(n, form)
            if content is not None:
                # Only now, so that an answer without files leaves no empty folder.
                folder.mkdir(parents=True, exist_ok=True)
                (folder / f"design-{n + 1}.{form}").write_bytes(content)
                yield f"design-{n + 1}.{form}"
