"""Examples of steering for the gallery."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample(
        "Car steering",
        "Make an output follow",
        "Both front wheels turn about one point, as near as four links can do it.",
    ),
)
