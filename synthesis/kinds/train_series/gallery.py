"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("Two planetary sets, 25 : 1", "Change a speed", "Exactly twenty-five, by two sets one after the other."),
    Named("Three planetary sets, 333 : 1", "Change a speed", "A large ratio in a short row."),
    Named(
        "Spur and planetary, 40 : 1",
        "Change a speed",
        "A pair of gears before a planetary set; the output turns the other way.",
    ),
)
