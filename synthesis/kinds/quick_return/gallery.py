"""Examples of quick return for the gallery, in the order in which it shows them."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample(
        "Wiper", "Make an output follow", "A rocker swings back and forth; forth takes a quarter longer than back."
    ),
    NamedExample(
        "Pump",
        "Make an output follow",
        "A stroke of 100 mm, slow forth and fast back, by the best type of linkage.",
    ),
    NamedExample(
        "Flap, even timing", "Make an output follow", "Two limit positions of a body, with equal times forth and back."
    ),
    NamedExample(
        "Shaper drive",
        "Make an output follow",
        "A drag link before a slider, in planes that its links can be built in.",
    ),
)
