"""Titles and captions of the function examples, in display order."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample(
        "Power law",
        "Make an output follow",
        "The output follows the power 1.5 of the input, with the smallest maximum error.",
    ),
    NamedExample("Three settings", "Make an output follow", "Three pairs of angles, met exactly."),
    NamedExample("Log scale on a slide", "Make an output follow", "A slider that moves as a logarithm."),
    NamedExample(
        "Log scale by six bars", "Make an output follow", "A logarithm by a Watt six-bar, closer than any four-bar."
    ),
)
