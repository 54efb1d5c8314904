"""The analysis of a given mechanism, from the body of a request to the JSON of its answer."""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError
from pydantic_core import to_json

from service.answers.numerical import refuse_numerical_errors
from service.error_messages import sentence
from service.refusals import invalid_body, invalid_mechanism, invalid_request


def analyse(body: Any) -> bytes:
    """Analyse the mechanism that a body states.

    Raises
    ------
    Refusal
        422, with the place of each fault.
    """
    from kinematics import errors as kinematics
    from synthesis.analyses import parse_request
    from synthesis.analyses.budget import BudgetError
    from synthesis.mechanisms import MechanismError

    with refuse_numerical_errors():
        try:
            request = parse_request(body)
        except ValidationError as error:
            raise invalid_body(error, body) from None
        contradictions = request.find_errors()
        if contradictions:
            raise invalid_request([(path, sentence(detail)) for path, detail in contradictions])
        try:
            answer = request.build_answer()
        except BudgetError as error:
            raise invalid_request([(error.path, sentence(error.detail))]) from None
        except MechanismError as error:
            raise invalid_mechanism([(f"/mechanism{error.path}", sentence(error.detail))]) from None
        except kinematics.MechanismError as error:
            raise invalid_mechanism([("/mechanism", sentence(str(error)))]) from None
        return to_json(answer, inf_nan_mode="null")
