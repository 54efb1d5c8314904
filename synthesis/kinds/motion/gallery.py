"""Titles and captions of the motion examples, in display order."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample(
        "Hatch lid", "Carry a body", "A lid through three positions, with a transmission angle of at least 35°."
    ),
    NamedExample(
        "Lid with pivots on the frame", "Carry a body", "The same lid; both fixed pivots lie on one line of the frame."
    ),
    NamedExample("Hood, four positions", "Carry a body", "All possible pivot pairs lie on Burmester's curves."),
    NamedExample("Arm, five positions", "Carry a body", "Five positions leave only a few linkages; all are found."),
    NamedExample(
        "Lid along seven", "Carry a body", "Seven positions at once: the fourbar that comes closest to all of them."
    ),
    NamedExample("Lid with tolerances", "Carry a body", "A tolerance for each position, by coordinate and by angle."),
    NamedExample(
        "Flap with fenced pivots", "Carry a body", "Wide tolerances, and regions that must contain the pivots."
    ),
    NamedExample(
        "Lid on a slide", "Carry a body", "One side turns about a pivot, the other slides along a straight line."
    ),
    NamedExample(
        "Tailgate with crank",
        "Carry a body",
        "Two positions and two added links: a fully rotating crank drives it.",
    ),
    NamedExample(
        "Cover driven at the coupler",
        "Carry a body",
        "A separate crank drives the coupler from one position to the other.",
    ),
    NamedExample(
        "Platform by six bars", "Carry a body", "Five positions of a body on Watt and Stephenson six-bar linkages."
    ),
)
