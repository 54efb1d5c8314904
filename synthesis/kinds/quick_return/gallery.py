"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("Wiper", "Make an output follow", "A rocker swings to and fro; forth takes a quarter longer than back."),
    Named(
        "Pump",
        "Make an output follow",
        "A stroke of 100 mm, slow forth and fast back, by whichever linkage does it best.",
    ),
    Named(
        "Flap, even timing", "Make an output follow", "Two limit positions of a body, with as much time forth as back."
    ),
    Named(
        "Shaper drive",
        "Make an output follow",
        "A drag link before a slider, in planes that its links can be built in.",
    ),
)
