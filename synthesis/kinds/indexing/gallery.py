"""Examples of the kind indexing for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Geneva wheel, six stations", "Lift and rest", "A step of 60° for each turn of the crank."),
    NamedExample("Geneva wheel, eight stations", "Lift and rest", "The smallest for given shafts and walls."),
    NamedExample("Inner Geneva wheel", "Lift and rest", "The wheel around its crank: long steps, short rests."),
    NamedExample("Spherical Geneva wheel", "Lift and rest", "Steps about an axis that crosses that of the crank."),
    NamedExample(
        "Geneva wheel behind a drag link", "Lift and rest", "Different times of step and rest with the same wheel."
    ),
    NamedExample("Ratchet", "Lift and rest", "Thirty-six stops against a load that would turn it back."),
)
