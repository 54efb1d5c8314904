"""Analysis of a given mechanism, from the request body to the JSON answer."""

from __future__ import annotations

from pydantic import ValidationError
from pydantic_core import to_json

from kinematics.message import make_sentence
from service.answers.numerical import refuse_numerical_errors
from service.error_messages import explain_kind
from service.refusals import refuse_invalid_body, refuse_invalid_mechanism, refuse_invalid_request


def analyse(body: object) -> bytes:
    """Analyse the mechanism in a request body.

    Raises
    ------
    Refusal
        422, with the place of each fault, if the body is not a valid analysis request.
    """
    from kinematics import errors as kinematics
    from synthesis.analyses import get_family, list_types
    from synthesis.analyses.budget import BudgetError
    from synthesis.mechanisms import MechanismError

    with refuse_numerical_errors():
        mechanism = body.get("mechanism") if isinstance(body, dict) else None
        if isinstance(mechanism, dict) and "type" in mechanism and mechanism["type"] not in (types := list_types()):
            raise refuse_invalid_mechanism([("/mechanism/type", explain_kind(mechanism["type"], types))])
        model = get_family(mechanism).request
        try:
            request = model.model_validate(body)
        except ValidationError as error:
            raise refuse_invalid_body(error, body, model) from None
        contradictions = request.find_errors()
        if contradictions:
            raise refuse_invalid_request([(path, make_sentence(detail)) for path, detail in contradictions])
        try:
            answer = request.build_answer()
        except BudgetError as error:
            raise refuse_invalid_request([(error.path, make_sentence(error.detail))]) from None
        except MechanismError as error:
            raise refuse_invalid_mechanism([(f"/mechanism{error.path}", make_sentence(error.detail))]) from None
        except kinematics.MechanismError as error:
            raise refuse_invalid_mechanism([("/mechanism", make_sentence(str(error)))]) from None
        return to_json(answer, inf_nan_mode="null")
