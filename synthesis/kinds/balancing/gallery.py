"""Examples of the kind balancing for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("Rotor in two planes", "Run smoothly", "Three known masses and the corrections that balance them."),
    Named("Rotor by trial weights", "Run smoothly", "From vibrations measured with and without trial weights."),
    Named("Fourbar without shaking force", "Run smoothly", "Counterweights that keep its centre of mass still."),
    Named(
        "Fourbar without shaking", "Run smoothly", "Neither force nor moment on the frame, by geared counterweights."
    ),
    Named("Fourbar that shakes least", "Run smoothly", "The best counterweights within given bounds."),
)
