"""Answers and their designs for interactive use, with drawings, motion and files."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from os import PathLike
from pathlib import Path
from typing import Any

from mechsynth.cycle import Cycle
from service.render import Form, export_design, list_forms, make_heading
from synthesis.model.answer import NearestMiss, Search, Verification
from synthesis.model.answer import Result as Answered
from synthesis.model.problem import ProblemBase
from synthesis.registry import KINDS

Place = str | PathLike[str]

MAX_COLUMNS = 7
"""Maximum number of metrics in a row of a notebook's table."""


class Design:
    """A design of an answer.

    Attributes
    ----------
    model : pydantic model
        All fields of the design in the API, frozen.
    number : int
        Index in the answer, from 0.
    title : str
        Heading of the drawings.
    """

    def __init__(self, model: Any, problem: ProblemBase, label: str | None, number: int) -> None:
        self.model, self.problem, self.number = model, problem, number
        self.title = make_heading(problem, label, number)

    def __repr__(self) -> str:
        verdict = "passed" if self.passed else "FAILED"
        return f"<Design {self.number + 1}: {self.mechanism.type}, {len(self.verification.checks)} checks {verdict}>"

    @property
    def mechanism(self) -> Any:
        """Dimensions of the mechanism, with the names of the API."""
        return self.model.mechanism

    @property
    def metrics(self) -> Any:
        """Metrics by which designs are ranked."""
        return self.model.metrics

    @property
    def verification(self) -> Verification:
        """Checks of the driven mechanism, with measured values."""
        verification: Verification = self.model.verification
        return verification

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return self.verification.passed

    @property
    def forms(self) -> list[Form]:
        """File formats available for the type of mechanism: ``svg``, ``gif``, ``dxf``, ``csv``."""
        return list_forms(self.mechanism.type)

    def draw(self) -> str:
        """Return the labelled drawing as SVG, the same as from the service."""
        return str(self.file("svg"))

    def file(self, form: Form) -> str | bytes:
        """Return a file as the service makes it: text, or bytes for an animation.

        Raises
        ------
        NoSuchExport
            If the type of mechanism has no such file.
        NotBuilt
            If the lengths are near the limits permitted in a problem.
        """
        return export_design(self.model, self.problem, self.title, form)

    def to_svg(self, path: Place) -> Path:
        """Write the drawing as SVG and return its path.

        Raises
        ------
        NoSuchExport, NotBuilt
            As :meth:`file`.
        OSError
            If the file cannot be written.
        """
        return self._write_file("svg", path)

    def to_dxf(self, path: Place) -> Path:
        """Write a DXF file in true dimensions and return its path; raises as :meth:`to_svg`."""
        return self._write_file("dxf", path)

    def to_csv(self, path: Place) -> Path:
        """Write the table of the motion as CSV and return its path; raises as :meth:`to_svg`."""
        return self._write_file("csv", path)

    def to_gif(self, path: Place) -> Path:
        """Write the animation as GIF and return its path; raises as :meth:`to_svg`."""
        return self._write_file("gif", path)

    def _write_file(self, form: Form, path: Place) -> Path:
        content, written = self.file(form), Path(path)
        written.write_bytes(content if isinstance(content, bytes) else content.encode())
        return written

    def motion(self, steps: int = 360) -> Cycle:
        """Analyse the design over its cycle, in ``steps`` equal steps of its input with both ends included.

        A crank turns from the input angle of the first target through a full turn, or through as many turns as its
        gears need to return. Any other input moves from toggle to toggle of the branch that contains the targets. The
        input moves at 1 rad/s, or at 1 length unit/s.

        Raises
        ------
        ValueError
            If ``steps`` is below 1, or if the size of the mechanism exceeds the range of the analyses.
        """
        if steps < 1:
            raise ValueError(f"steps must be at least 1, got {steps}")
        from synthesis.analyses import get_family  # imported on demand: the analysis core takes time to load

        # The analysis validates the mechanism as a client would send it.
        mechanism = self.mechanism.model_dump(mode="json")
        return Cycle.from_lists(get_family(mechanism).request.analyze_cycle(mechanism, steps))

    # Notebooks call this method and the next one.
    def _repr_svg_(self) -> str:
        return self.draw()

    def _repr_html_(self) -> str:
        rows = (
            (check.name, "passed" if check.passed else "FAILED", _format_value(check.value), _format_value(check.limit))
            for check in self.verification.checks
        )
        table = _format_table(("check", "", "value", "limit"), rows)
        return f"<div>{self.draw()}{table}</div>"


class Result:
    """The answer to a problem: its designs, best first, and how they were found.

    Attributes
    ----------
    model : pydantic model
        All fields of ``result`` in the API, frozen.
    problem : ProblemBase
        The solved problem.
    designs : list of Design
    """

    def __init__(self, model: Answered[Any], problem: ProblemBase, label: str | None = None) -> None:
        self.model, self.problem, self.label = model, problem, label
        self.designs = [Design(design, problem, label, n) for n, design in enumerate(model.designs)]

    @classmethod
    def from_json(cls, problem: Mapping[str, object], result: Mapping[str, object], label: str | None = None) -> Result:
        """Build the result from the problem and the result of a job, both in JSON form.

        Raises
        ------
        pydantic.ValidationError
            If the service has another version, whose fields differ.
        """
        kind = KINDS[str(problem["kind"])]
        model = kind.result.model_validate_json(json.dumps(result))
        return cls(model, kind.problem.model_validate_json(json.dumps(problem)), label)

    def __repr__(self) -> str:
        return f"<Result: {self.summary}>"

    @property
    def search(self) -> Search:
        """Method and completeness of the search; ``complete`` is a guarantee."""
        search: Search = self.model.search
        return search

    @property
    def summary(self) -> str:
        """Summary of the answer in a sentence."""
        return self.model.summary

    @property
    def nearest_miss(self) -> NearestMiss[Any] | None:
        """The nearest miss if no design passed, else None."""
        return self.model.nearest_miss

    def to_json(self) -> str:
        """Return the answer as the service would send it, with all digits of its numbers."""
        return self.model.model_dump_json()

    def _repr_html_(self) -> str:
        names = [name for name, value in _iterate_metrics(self.designs) if isinstance(value, int | float | str)][
            :MAX_COLUMNS
        ]
        rows = (
            (
                str(d.number + 1),
                str(d.mechanism.type),
                *(_format_value(getattr(d.metrics, name, None)) for name in names),
            )
            for d in self.designs
        )
        table = (
            _format_table(("", "mechanism", *(name.replace("_", " ") for name in names)), rows) if self.designs else ""
        )
        best = self.designs[0].draw() if self.designs else ""
        return f"<div><p>{escape(self.summary)}</p>{table}{best}</div>"


def _iterate_metrics(designs: Sequence[Design]) -> Iterator[tuple[str, object]]:
    """Yield names and values of the metrics of the best design."""
    for design in designs[:1]:
        yield from ((name, getattr(design.metrics, name)) for name in type(design.metrics).model_fields)


def _format_table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    head = "".join(f"<th>{escape(cell)}</th>" for cell in heads)
    body = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _format_value(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)
