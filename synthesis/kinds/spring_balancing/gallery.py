"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("Lamp arm", "Run smoothly", "A spring that carries a lever in every position."),
    Named(
        "Gate with two springs",
        "Run smoothly",
        "A coil and a torsion spring, each within bounds, hold a loaded linkage.",
    ),
    Named("Gate, spring placed freely", "Run smoothly", "Where the ends of a spring are to be, each within a region."),
    Named(
        "Gate, bounded spring",
        "Run smoothly",
        "An extension spring of a length between two; what is left is least in the mean.",
    ),
)
