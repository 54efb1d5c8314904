"""Examples of the kind spring_balancing for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Lamp arm", "Run smoothly", "A spring that balances a lever in every position."),
    NamedExample(
        "Gate with two springs",
        "Run smoothly",
        "A coil and a torsion spring, both within limits, hold a loaded linkage.",
    ),
    NamedExample("Gate, spring placed freely", "Run smoothly", "The best ends of a spring, each within a region."),
    NamedExample(
        "Gate, bounded spring",
        "Run smoothly",
        "An extension spring with a limited free length; the rms drive is minimized.",
    ),
)
