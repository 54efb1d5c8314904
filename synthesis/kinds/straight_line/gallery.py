"""Examples of straight lines for the gallery, in the order in which it shows them."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("Straight edge", "Draw a curve", "Hoeken's linkage, as straight as possible over a third of a turn."),
    Named("Exact line", "Draw a curve", "Peaucellier's eight links: no error at all."),
)
