"""Examples of the kind layshaft_gearbox for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (NamedExample("Car gearbox", "Change a speed", "Four gears and reverse on one layshaft."),)
