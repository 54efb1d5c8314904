"""A solved job in the form for the processes that answer requests, and the numbers of its designs."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from kinematics.message import compose
from service.refusals import refuse_not_found
from service.requests import load_stored_problem
from synthesis.model.answer import Result
from synthesis.model.problem import ProblemBase
from synthesis.registry import KINDS

_DESIGN_NUMBER = re.compile("[0-9]{1,4}")


@dataclass(frozen=True, slots=True)
class SolvedJob:
    """The fields of a job with a result; ``problem`` and ``result`` are JSON text as stored."""

    id: str
    kind: str
    label: str | None
    created_at: str
    finished_at: str | None
    problem: str
    result: str

    def load_problem(self) -> ProblemBase:
        """Parse the problem."""
        return load_stored_problem(self.kind, self.problem)

    def load_result(self) -> Result[Any]:
        """Parse the result, with its designs."""
        result: Result[Any] = KINDS[self.kind].result.model_validate_json(self.result)
        return result


def parse_design_index(number: str, designs: int) -> int:
    """Parse the design number in a path; ``designs`` is the number of designs.

    Raises
    ------
    Refusal
        404 if there is no such design.
    """
    if not _DESIGN_NUMBER.fullmatch(number) or int(number) >= designs:
        raise refuse_not_found(
            compose("service-design-unknown", number=number[:20], last=str(designs - 1))
            if designs
            else compose("service-job-without-designs")
        )
    return int(number)
