"""Examples of path generation for the gallery, in the order in which it shows them."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Arc through five", "Draw a curve", "A point of the coupler passes through five points."),
    NamedExample("Five points on time", "Draw a curve", "Each point is reached at its own crank angle."),
    NamedExample("Timed loop", "Draw a curve", "A closed curve of nine points, on time, by a crank-rocker."),
    NamedExample("Foot path", "Draw a curve", "The whole closed curve is matched, wherever a crank begins on it."),
)
