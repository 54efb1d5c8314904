"""Examples of the kind gearbox for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Lathe spindle", "Change a speed", "Six speeds from 25 to 800 rev/min in geometric progression."),
)
