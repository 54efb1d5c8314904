"""A design of a solved job as a file, and in motion."""

from __future__ import annotations

from pydantic import ValidationError
from pydantic_core import from_json, to_json

from service.answers.job_result import SolvedJob, parse_design_index
from service.answers.numerical import refuse_numerical_errors
from service.refusals import Refusal, refuse_not_found
from service.render import Form


def draw_design(job: SolvedJob, number: str, form: Form) -> str | bytes:
    """The file of design ``number`` in a form.

    Raises
    ------
    Refusal
        404 where there is no such design or file of it, 409 where it is of a size that is not drawn.
    """
    from service import render

    designs = job.load_result().designs
    n = parse_design_index(number, len(designs))
    problem = job.load_problem()
    try:
        return render.export_design(designs[n], problem, render.make_heading(problem, job.label, n), form)
    except render.NoSuchExport:
        raise refuse_not_found(f"There is no .{form} file of this type of mechanism.") from None
    except render.NotBuilt:
        raise Refusal(409, "no-drawing", "No drawing", "This design is of a size that is not drawn.") from None


def move_design(result: str, number: str, steps: int) -> bytes:
    """The motion of design ``number`` of a stored result, in JSON.

    Raises
    ------
    Refusal
        404 where there is no such design, 409 where it is no mechanism that the analysis core would be given.
    """
    from kinematics import errors as kinematics
    from synthesis.analyses import get_family
    from synthesis.mechanisms import MechanismError

    designs = from_json(result)["designs"]
    mechanism = designs[parse_design_index(number, len(designs))]["mechanism"]
    with refuse_numerical_errors("/mechanism"):
        try:
            answer = get_family(mechanism).request.analyze_cycle(mechanism, steps)
        except (ValidationError, MechanismError, kinematics.MechanismError):
            # A design for lengths at the end of what can be stated may itself lie beyond that.
            raise Refusal(409, "no-motion", "No motion", "This design is of a size that is not analysed.") from None
        return to_json(answer, inf_nan_mode="null")
