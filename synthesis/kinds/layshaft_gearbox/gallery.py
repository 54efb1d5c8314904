"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (Named("Car gearbox", "Change a speed", "Four gears and reverse on one layshaft."),)
