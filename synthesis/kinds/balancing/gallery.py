"""Examples of the kind balancing for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Rotor in two planes", "Run smoothly", "Three known masses and the corrections that balance them."),
    NamedExample("Rotor by trial weights", "Run smoothly", "From vibrations measured with and without trial weights."),
    NamedExample("Fourbar without shaking force", "Run smoothly", "Counterweights that keep its centre of mass still."),
    NamedExample(
        "Fourbar without shaking", "Run smoothly", "Neither force nor moment on the frame, by geared counterweights."
    ),
    NamedExample("Fourbar that shakes least", "Run smoothly", "The best counterweights within given bounds."),
)
