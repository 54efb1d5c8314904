"""Files and motion of a design of a solved job."""

from __future__ import annotations

from pydantic import ValidationError
from pydantic_core import from_json, to_json

from kinematics.message import compose
from service.answers.job_result import SolvedJob, parse_design_index
from service.answers.numerical import refuse_numerical_errors
from service.refusals import Refusal, refuse_not_found
from service.render import Form


def draw_design(job: SolvedJob, number: str, form: Form) -> str | bytes:
    """Return the file of design ``number`` in a format.

    Raises
    ------
    Refusal
        404 if there is no such design or file, 409 if the size of the design is beyond the range for drawings.
    """
    from service import render

    designs = job.load_result().designs
    n = parse_design_index(number, len(designs))
    problem = job.load_problem()
    try:
        return render.export_design(designs[n], problem, render.make_heading(problem, job.label, n), form)
    except render.NoSuchExport:
        raise refuse_not_found(compose("service-file-unavailable", form=form)) from None
    except render.NotBuilt:
        detail = compose("service-design-too-large-to-draw")
        raise Refusal(409, "no-drawing", "service-title-no-drawing", detail) from None


def move_design(result: str, number: str, steps: int) -> bytes:
    """Return the motion of design ``number`` of a stored result as JSON.

    Raises
    ------
    Refusal
        404 if there is no such design, 409 if the analysis core does not accept its mechanism.
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
            # A design for a problem with lengths near the permitted limits may exceed these limits itself.
            detail = compose("service-design-too-large-to-analyse")
            raise Refusal(409, "no-motion", "service-title-no-motion", detail) from None
        return to_json(answer, inf_nan_mode="null")
