"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (Named("Lathe spindle", "Change a speed", "Six speeds from 25 to 800 rev/min, in even ratios."),)
