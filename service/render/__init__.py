"""Drawings of designs: one self-contained, labelled SVG sheet a design."""

from __future__ import annotations

from service.render.sheet import fourbar_sheet
from synthesis.designs import Design
from synthesis.problems import Problem

__all__ = ["drawing"]

SHEETS = {"fourbar": fourbar_sheet}
"""How each mechanism type is drawn."""


def drawing(design: Design, problem: Problem, title: str) -> str:
    """A design as a complete, self-contained SVG document.

    Parameters
    ----------
    design : Design
        What is drawn; a design that failed a check is drawn as it is.
    problem : Problem
        The problem that it answers: demanded positions and length unit.
    title : str
        Heading; any text, characters that XML forbids are left out.

    Returns
    -------
    str
        SVG with a title and a description, without scripts, style sheets, element ids or references, so that it can
        stand in a page beside others. The same arguments give the same text.
    """
    return SHEETS[design.mechanism.type](design, problem, title).write() + "\n"
