"""The report of a job: one self-contained page with the problem, the answer, the designs and their verification.

It is designed for print: light, without scripts, with one style sheet inside. The style sheet's hash is part of the
:data:`POLICY` under which the page is served; the page repeats that policy, so that it applies to a saved file, too.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from jinja2 import Environment, StrictUndefined
from markupsafe import Markup
from pydantic import BaseModel

from service.render import NoSuchExport, NotBuilt, export_design
from service.render.checks import format_check
from service.render.outline import Outline, add_unit, format_name, format_value, make_outline
from service.render.page.sheet import UNIT_NAMES
from service.render.page.svg import clean_text
from service.units import list_symbols
from synthesis.model.answer import Check, Result, Search
from synthesis.model.dimension import Dimension, collect_dimensions
from synthesis.model.problem import ProblemBase

_FOLDER = files("service").joinpath("render")
_STYLE = _FOLDER.joinpath("report.css").read_text(encoding="utf-8")
_HASH = base64.b64encode(hashlib.sha256(_STYLE.encode()).digest()).decode()

_OWN_POLICY = f"default-src 'none'; style-src 'sha256-{_HASH}'; base-uri 'none'; form-action 'none'"

POLICY = f"{_OWN_POLICY}; frame-ancestors 'none'"
"""Content security policy that permits only the page's own style sheet; a page cannot declare `frame-ancestors` itself.
"""

MAX_RANKING_QUANTITIES = 4
"""Maximum number of quantities in a row of the table of all designs, limited by the page width."""

_ENVIRONMENT = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
_PAGE = _ENVIRONMENT.from_string(_FOLDER.joinpath("report.html").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class ReportedJob:
    """Data of the reported job that its problem and its result do not contain."""

    job: str
    kind: str
    label: str | None
    accepted: str
    finished: str | None
    version: str

    def line(self) -> str:
        """Describe the job on one line, with times to the second."""
        times = [f"accepted {_format_time(self.accepted)}"]
        if self.finished is not None:
            times.append(f"finished {_format_time(self.finished)}")
        return f"Job {self.job}, {', '.join(times)}; mechsynth {self.version}."


def _format_time(time: str) -> str:
    return f"{time[:19].replace('T', ' ')} UTC"


@dataclass(frozen=True)
class CheckEntry:
    """A check as text."""

    name: str
    passed: bool
    value: str
    limit: str


@dataclass(frozen=True)
class Sheet:
    """A design that is shown in full: its drawing, assembly, checks and numbers.

    Instead of the assembly it may have the reason why there is none. The numbers are grouped by headings.
    """

    number: int
    name: str
    passed: bool
    drawing: str
    assembly: str
    unbuilt: str
    checks: list[CheckEntry]
    parts: list[tuple[str, Outline]]


def report(
    problem: ProblemBase, result: Result[Any], occasion: ReportedJob, most: int, assemblies: Mapping[int, str] = {}
) -> str:
    """Write the report as a page.

    Parameters
    ----------
    problem, result
        The problem and its answer.
    occasion : ReportedJob
        The job.
    most : int
        Maximum number of designs that are shown in full, best first; the table lists all.
    assemblies : mapping of int to str
        By index of a design, the SVG of its assembled parts, or a sentence with the reason why there is none.

    Returns
    -------
    str
        The page as HTML. The same arguments give the same text.
    """
    units = list_symbols(problem)
    title = problem.model_config.get("title") or format_name(occasion.kind)
    # Labels are client text: remove control characters.
    heading = clean_text(occasion.label or "") or title
    sheets = [
        _make_sheet(design, n, problem, f"{heading}, design {n + 1}", units, assemblies.get(n, ""))
        for n, design in enumerate(result.designs[:most])
    ]
    return _PAGE.render(
        title=title,
        heading=heading,
        occasion=occasion,
        length_unit=UNIT_NAMES[problem.length_unit],
        style=Markup(_STYLE),
        policy=_OWN_POLICY,
        about=(type(problem).__doc__ or "").split("\n\n")[0].replace("\n", " ").strip(),
        problem=make_outline(problem, units, leave_out={"kind"}, last=ProblemBase.model_fields.keys() - {"kind"}),
        summary=result.summary,
        proven=_describe_proof(result),
        search=make_outline(result.search, units),
        more=make_outline(result, units, leave_out={"designs", "search", "summary", "curves"}),
        ranking=_rank_designs(result, units),
        sheets=sheets,
    )


def _make_sheet(
    design: Any, n: int, problem: ProblemBase, title: str, units: dict[Dimension, str], assembly: str
) -> Sheet:
    try:
        drawing = export_design(design, problem, title, "svg")
        assert isinstance(drawing, str)
    # The report lists the design even without a drawing.
    except (NoSuchExport, NotBuilt):
        drawing = ""
    own = make_outline(design.mechanism, units, leave_out={"type", "skeleton"})
    parts = [
        ("Dimensions", own),
        ("Quantities", make_outline(design.metrics, units)),
        ("Verified motion", make_outline(design, units, leave_out={"mechanism", "metrics", "verification"})),
    ]
    skeleton = getattr(design.mechanism, "skeleton", None)
    if skeleton is not None:
        # A linkage given by the client has only its skeleton; a designed one is drawn at its first target.
        beside = own.rows or own.lists
        name = "Skeleton: the joints at the first target" if beside else "Dimensions: the joints as given"
        parts.append((f"{name}, and the rigid links", make_outline(skeleton, units)))
    return Sheet(
        number=n + 1,
        name=format_name(design.mechanism.type),
        passed=design.verification.passed,
        drawing=_embed_drawing(drawing) if drawing else "",
        assembly=_embed_drawing(assembly) if assembly.startswith("<") else "",
        unbuilt="" if assembly.startswith("<") else assembly,
        checks=[_make_check_entry(check, units) for check in design.verification.checks],
        parts=[(heading, part) for heading, part in parts if part.rows or part.lists],
    )


def _embed_drawing(drawing: str) -> str:
    """Return a drawing for embedding, without its XML declaration; makers of drawings escape all text."""
    return Markup(drawing[drawing.index("<svg") :])


def _make_check_entry(check: Check, units: dict[Dimension, str]) -> CheckEntry:
    return CheckEntry(format_name(check.name), check.passed, *format_check(check, units))


def _rank_designs(
    result: Result[Any], units: dict[Dimension, str]
) -> list[tuple[int, str, bool, list[tuple[str, str]]]]:
    """Return all designs with the first of their quantities, preferred ones first."""
    ranked = []
    for n, design in enumerate(result.designs):
        metrics: BaseModel = design.metrics
        measures = collect_dimensions(type(metrics))
        plain = [
            (name, value)
            for name, value in metrics
            if isinstance(value, float) or (isinstance(value, int) and not isinstance(value, bool))
        ]
        # A stable sort: preferred quantities first, field order otherwise.
        plain.sort(key=lambda quantity: quantity[0] not in _RANKING_METRICS)
        figures = []
        for name, value in plain[:MAX_RANKING_QUANTITIES]:
            measured = measures.get(name)
            figures.append(
                (format_name(name), add_unit(format_value(value), "" if measured is None else units[measured]))
            )
        ranked.append((n + 1, format_name(design.mechanism.type), design.verification.passed, figures))
    return ranked


_RANKING_METRICS = {
    "quality",
    "min_transmission_angle",
    "rms_residual",
    "max_structural_error",
    "steering_error",
    "relative_error",
    "max_error",
    "error",
    "total_teeth",
    "tooth_sum",
    "size",
    "jitter",
    "deviation",
}
"""Quantities by which designs are preferably compared."""


def _describe_proof(result: Result[Any]) -> list[str]:
    """Return the facts that are proven, as sentences."""
    search: Search = result.search
    passed = sum(design.verification.passed for design in result.designs)
    count = len(result.designs)
    known = []
    if search.complete:
        known.append(
            "The search is complete: it covers everything that the problem allows. The best designs are shown."
            if count
            else "The search is complete: no design satisfies all constraints."
        )
    else:
        known.append(
            "The search is not complete: other designs, even better ones, may exist."
            if count
            else "No design was found; this does not prove that none exists."
        )
    if count:
        known.append(
            f"Verified by driving the finished mechanism from its dimensions alone: {passed} of {count} designs pass "
            "every check."
        )
    if getattr(search, "sizing_proven", False):
        known.append("No smaller cam produces this motion within the limits.")
    return known
