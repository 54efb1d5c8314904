"""Examples of the kind gear_train for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("A ratio of π", "Change a speed", "Two stages that approximate π as closely as whole teeth allow."),
    NamedExample("12 : 1, coaxial", "Change a speed", "Exactly twelve, with input and output on one axis."),
    NamedExample(
        "π between given centres", "Change a speed", "Coaxial, with standard modules and a centre distance of 120 mm."
    ),
    NamedExample("12 : 1 for 3 kW", "Change a speed", "Standard modules with sufficient bending and contact strength."),
    NamedExample("Helical, ring and spur", "Change a speed", "Three stages of three types for a ratio of 47."),
    NamedExample("Bevel, worm and spur", "Change a speed", "A ratio of one hundred around two corners."),
)
