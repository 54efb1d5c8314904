"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("Hatch lid", "Carry a body", "A lid through three positions, with a transmission angle of 35° at least."),
    Named(
        "Lid with pivots on the frame", "Carry a body", "The same lid; both fixed pivots lie on one line of the frame."
    ),
    Named("Hood, four positions", "Carry a body", "Every pair of pivots there is lies on Burmester's curves."),
    Named("Arm, five positions", "Carry a body", "Five positions leave a few linkages: all of them are found."),
    Named("Lid along seven", "Carry a body", "Seven positions at once: the fourbar that comes nearest to all of them."),
    Named("Lid with tolerances", "Carry a body", "What each position may miss, by coordinate and by angle."),
    Named("Flap with fenced pivots", "Carry a body", "Rough positions, and regions in which the pivots have to lie."),
    Named("Lid on a slide", "Carry a body", "One side turns about a pivot, the other one slides along a straight."),
    Named(
        "Tailgate with crank",
        "Carry a body",
        "Two positions, and two links more: a crank that turns through drives it.",
    ),
    Named(
        "Cover driven at the coupler",
        "Carry a body",
        "A crank of its own drives the coupler from one position to the other.",
    ),
    Named(
        "Platform by six bars", "Carry a body", "Five positions of a body on Watt's and Stephenson's six-bar linkages."
    ),
)
