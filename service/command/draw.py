"""``mechsynth draw``: draws a design from the output of ``mechsynth solve --json``, without a service."""

from __future__ import annotations

import json
from pathlib import Path
from typing import get_args

from pydantic import ValidationError

from service.command.inputs import SourceError, read_object
from service.render import Form, NoSuchExport, NotBuilt, export_design, list_forms, make_heading
from service.requests import load_stored_problem
from synthesis.model.design_interface import AnyDesign
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import ProblemBase
from synthesis.registry import KINDS


def draw(source: str, number: int, output: Path) -> None:
    """Write a design of an answer, counted from 1, to a file in the format of its suffix.

    Raises
    ------
    SourceError
        If there is no such answer, design or format.
    """
    known: tuple[Form, ...] = get_args(Form)
    form = next((form for form in known if output.suffix.lower() == f".{form}"), None)
    if form is None:
        raise SourceError(f"{output}: the name must end in one of: {', '.join(f'.{form}' for form in known)}")
    job = read_object(source)
    problem, designs = _read_answer(source, job)
    if not 1 <= number <= len(designs):
        raise SourceError(f"design {number} does not exist; {source} has designs 1 to {len(designs)}")
    # The command line counts from 1, the API from 0.
    design = designs[number - 1]
    try:
        content = export_design(design, problem, make_heading(problem, job.get("label"), number - 1), form)
    except NoSuchExport:
        there = ", ".join(list_forms(design.mechanism.type))
        raise SourceError(f"{design.mechanism.type} has no .{form} file; available: {there}") from None
    except NotBuilt:
        raise SourceError("the size of this design is beyond the range for drawings") from None
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_bytes(content if isinstance(content, bytes) else content.encode())


def _read_answer(source: str, job: JsonObject) -> tuple[ProblemBase, list[AnyDesign]]:
    problem, result = job.get("problem"), job.get("result")
    if not isinstance(problem, dict) or not isinstance(result, dict) or problem.get("kind") not in KINDS:
        raise SourceError(f"{source} contains no answer; mechsynth solve --json writes one")
    kind = problem["kind"]
    try:
        return load_stored_problem(kind, json.dumps(problem)), KINDS[kind].result.model_validate_json(
            json.dumps(result)
        ).designs
    except ValidationError as error:
        raise SourceError(f"{source} contains no answer of this version: {error.errors()[0]['msg']}") from None
