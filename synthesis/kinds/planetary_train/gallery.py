"""Examples of the kind planetary_train for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Planetary hub", "Change a speed", "Sun, planets and ring for 5.5 : 1."),
    NamedExample("Planetary hub for 5 kW", "Change a speed", "The same ratio, strong enough within a face of 12 mm."),
)
