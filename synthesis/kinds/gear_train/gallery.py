"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("A ratio of π", "Change a speed", "Two stages that come as near to π as whole teeth can."),
    Named("12 : 1, coaxial", "Change a speed", "Exactly twelve, with input and output on one axis."),
    Named("π between given centres", "Change a speed", "On one axis, with standard modules and a distance of 120 mm."),
    Named("12 : 1 for 3 kW", "Change a speed", "Standard modules that are strong enough, by bending and by contact."),
    Named("Helical, ring and spur", "Change a speed", "Three stages of three types for a ratio of 47."),
    Named("Bevel, worm and spur", "Change a speed", "A hundred to one around two corners."),
)
