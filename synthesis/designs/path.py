"""Answers to problems of path generation."""

from __future__ import annotations

from pydantic import Field

from synthesis.designs.base import Answer, Result
from synthesis.designs.linkage import LinkageDesign


class CognateTriples(Answer):
    """What was computed of the 1442 triples of cognate fourbars through nine points, in all rounds together."""

    rounds: int = Field(description="Sets of nine points that were solved; 1 where nine were given.")
    computed: int = Field(description="Triples found, real and complex; 1442 a round where none is missing.")
    real: int
    on_one_circuit: int = Field(description="Real triples with all demanded points on one circuit.")
    largest_residual: float = Field(description="Of the equations, with points of unit mean distance.")
    closed_under_conjugation: bool = Field(description="Whether complex solutions come in pairs, as they must.")


class PathResult(Result[LinkageDesign]):
    """Linkages whose coupler point goes through the points."""

    triples: CognateTriples
