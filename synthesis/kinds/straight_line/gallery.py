"""Examples of straight lines for the gallery, in the order in which it shows them."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Straight edge", "Draw a curve", "Hoeken's linkage, as straight as possible over a third of a turn."),
    NamedExample("Exact line", "Draw a curve", "Peaucellier's eight links: no error at all."),
)
