"""Base classes of the analyses of all families of mechanisms.

A request is a model that finds its own errors and builds its answer.
"""

from __future__ import annotations

import copy
from abc import ABC, abstractmethod
from typing import Generic, NamedTuple, Self, TypeVar

from pydantic import Field

from synthesis.analyses.input_motion import StatedMotion, Sweep
from synthesis.model.answer import Answer
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Statement


class AnalysisRequest(Statement, ABC):
    """A mechanism and how it is driven; each family has its own fields."""

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find, as pairs (JSON pointer, detail)."""
        return []

    @abstractmethod
    def build_answer(self) -> JsonObject:
        """Build the answer to a valid request, as plain lists and numbers in the form of the family's answer model.

        Raises
        ------
        MechanismError
            For a mechanism that cannot exist.
        """

    @classmethod
    def analyze_cycle(cls, mechanism: JsonObject, steps: int) -> JsonObject:
        """Build the answer for the mechanism of a design, in JSON form, over its cycle.

        The cycle is a full turn of the input at speed 1, in ``steps`` steps.
        """
        return cls.model_validate({"mechanism": mechanism, "motion": {"steps": steps}}).build_answer()

    @classmethod
    def get_example(cls) -> JsonObject:
        """Return the example of the API documentation in JSON form; the configuration of the model states it."""
        schema = cls.model_config["json_schema_extra"]
        assert isinstance(schema, dict)
        examples = schema["examples"]
        assert isinstance(examples, list)
        example = copy.deepcopy(examples[0])
        assert isinstance(example, dict)
        return example

    @classmethod
    def build_example(cls) -> Self:
        """Build the example of the API documentation."""
        return cls.model_validate(cls.get_example())


Given = TypeVar("Given", bound=Statement)


class DrivenRequest(AnalysisRequest, Generic[Given]):
    """A given mechanism and the motion of its input: a full turn in 360 steps by default."""

    mechanism: Given
    motion: StatedMotion = Sweep()

    def find_errors(self) -> list[tuple[str, str]]:
        """Return the errors of the motion."""
        return self.motion.find_errors()


class DrivenAnalysis(Answer):
    """Positions of the input for which all results are given."""

    input_angle: list[float]
    time: list[float] | None


class TurningPart(Answer):
    """What turns at a fixed ratio to the input, over the positions."""

    speed_ratio: float = Field(description="Speed over the speed of the input; negative if it turns the other way.")
    angle: list[float] = Field(description="Angle from the position at input angle 0, degrees.")
    omega: list[float] = Field(description="rad/s")
    alpha: list[float] = Field(description="rad/s²")


class Family(NamedTuple):
    """Family of mechanisms with a common form of request and answer."""

    request: type[AnalysisRequest]
    analysis: type[Answer]
