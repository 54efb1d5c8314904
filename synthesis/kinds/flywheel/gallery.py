"""Examples of the kind flywheel for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Punch press", "Run smoothly", "A flywheel that keeps the speed within 5 % through the blow."),
    NamedExample("Pump with one cylinder", "Run smoothly", "The rim that evens out a slider-crank and its load."),
)
