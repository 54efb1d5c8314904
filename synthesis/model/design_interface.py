"""Interface of the fields that designs of all kinds share, for code that handles any design."""

from __future__ import annotations

from typing import Protocol

from pydantic import BaseModel

from synthesis.model.answer import Verification
from synthesis.model.json_object import JsonObject


class AnyMechanism(Protocol):
    """A mechanism of an answer, a model of its dimensions."""

    @property
    def type(self) -> str:
        """Type of mechanism."""

    def model_dump(self) -> JsonObject:
        """Return the fields by name."""


class AnyDesign(Protocol):
    """A design of an answer of any kind."""

    @property
    def mechanism(self) -> AnyMechanism:
        """Mechanism of the design."""

    @property
    def verification(self) -> Verification:
        """Checks of the design."""

    @property
    def metrics(self) -> BaseModel:
        """Measured properties of the mechanism."""
