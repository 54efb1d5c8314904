"""Examples of parallel motion for the gallery."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (NamedExample("Level platform", "Carry a body", "A body that follows a coupler curve and never tilts."),)
