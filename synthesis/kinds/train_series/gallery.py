"""Examples of the kind train_series for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Two planetary sets, 25 : 1", "Change a speed", "Exactly twenty-five, by two sets in series."),
    NamedExample("Three planetary sets, 333 : 1", "Change a speed", "A large ratio in a short train."),
    NamedExample(
        "Spur and planetary, 40 : 1",
        "Change a speed",
        "A pair of gears before a planetary set; the output turns in the opposite direction.",
    ),
)
