"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("Rotor in two planes", "Run smoothly", "Three known masses, and what balances them."),
    Named(
        "Rotor by trial weights", "Run smoothly", "From vibrations that were measured with and without trial weights."
    ),
    Named("Fourbar without shaking force", "Run smoothly", "Counterweights that keep its centre of mass still."),
    Named(
        "Fourbar without shaking", "Run smoothly", "Neither force nor moment on the frame, by counterweights that turn."
    ),
    Named("Fourbar that shakes least", "Run smoothly", "The best of counterweights that have bounds."),
)
