"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named(
        "Power law",
        "Make an output follow",
        "The output turns by the power 1.5 of the input, with the least greatest error.",
    ),
    Named("Three settings", "Make an output follow", "Three pairs of angles, met exactly."),
    Named("Log scale on a slide", "Make an output follow", "A slider that moves as a logarithm."),
    Named(
        "Log scale by six bars", "Make an output follow", "A logarithm by Watt's six-bar, nearer than four bars can."
    ),
)
