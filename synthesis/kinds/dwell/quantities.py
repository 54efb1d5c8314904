"""Quantities in the sentences about dwells: angles, lengths and lists of angles."""

from __future__ import annotations

from collections.abc import Sequence

from kinematics.message import compose
from synthesis.kinds.dwell.problem import DwellProblem


def write_output(problem: DwellProblem, value: str) -> str:
    """Write a formatted value of the output with its unit."""
    if problem.output.type == "slider":
        return compose("dwell-length", length=value, unit=problem.length_unit)
    return compose("dwell-angle", angle=value)


def list_angles(angles: Sequence[str]) -> str:
    """Write formatted angles, degrees, with "and" between them; empty if there are none.

    >>> list_angles(["60", "45.5"])
    '60° and 45.5°'
    """
    text = ""
    for angle in angles:
        last = compose("dwell-angle", angle=angle)
        text = compose("dwell-angle-and-angle", first=text, last=last) if text else last
    return text
