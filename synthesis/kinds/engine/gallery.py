"""Examples of the kind engine for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Four in line", "Run smoothly", "Shaking forces and firing order of a four-stroke engine."),
    NamedExample("V8", "Run smoothly", "Eight cylinders at 90°: shaking forces and firing orders."),
)
