"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("Four in line", "Run smoothly", "What shakes of a four-stroke engine, and in which order it fires."),
    Named("V8", "Run smoothly", "Eight cylinders at 90°: what shakes, and in which order they fire."),
)
