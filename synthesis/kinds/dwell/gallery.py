"""Examples of dwells for the gallery, in the order in which it shows them."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Indexing arm", "Lift and rest", "An arm swings by 90° and rests while the crank turns by 60°."),
    NamedExample("Press with two rests", "Lift and rest", "A rocker that rests at both of its ends."),
    NamedExample(
        "Two rests of unlike length", "Lift and rest", "A rocker that rests longer at one end than at the other."
    ),
)
