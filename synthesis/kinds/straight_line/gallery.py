"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("Straight edge", "Draw a curve", "Hoeken's linkage, as straight as there is over a third of a turn."),
    Named("Exact line", "Draw a curve", "Peaucellier's eight links: no error at all."),
)
