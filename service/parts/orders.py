"""What the process that makes parts is asked for: files of a design of a stored result."""

from __future__ import annotations

import math
from typing import Any

from service.parts import cad
from service.parts.made import NotMade, made
from service.parts.model import Assembly
from service.parts.package import package
from service.parts.sizes import AssemblyQuery, File, Refused
from service.render import heading
from service.render.page.svg import clean
from service.stated import read
from synthesis.registry import KINDS

ROUNDED = 1e-9
"""Share of its range by which a stated input may lie outside: an answer's own first and last are at its ends."""


def filled(
    kind: str, problem: str, label: str | None, result: str, number: int, query: dict[str, Any], file: File
) -> bytes | Refused:
    """A file of a design, as the process gives it back.

    Parameters
    ----------
    kind, problem, label, result : str
        Of the job, as they are stored.
    number : int
        The design's.
    query : dict
        Of an :class:`AssemblyQuery`.
    file : {"zip", "step", "glb"}
    """
    statement = read(kind, problem)
    design = KINDS[kind].result.model_validate_json(result).designs[number]
    asked = AssemblyQuery.model_validate(query)
    try:
        if file == "zip":
            return package(design, statement, asked, clean(heading(statement, label, number)))
        assembly = made(design, statement, asked)
        solids = cad.placed(assembly, [cad.solid(part) for part in assembly.parts], _input(assembly, asked))
    except NotMade as error:
        return Refused(str(error), error.path)
    return cad.step(solids, "assembly") if file == "step" else cad.glb(solids, "assembly")


def _input(assembly: Assembly, asked: AssemblyQuery) -> float:
    """The input at which the assembly is shown, in the range that its parts were made for."""
    motion = assembly.motion
    slides = motion.mechanism.driven_by_slide
    name, other = ("input_place", "input_angle") if slides else ("input_angle", "input_place")
    if getattr(asked, other) is not None:
        raise NotMade(f"The input of this mechanism is stated by {name}.", f"/query/{other}")
    stated = getattr(asked, name)
    if stated is None:
        return float(motion.mechanism.reference_input)
    # Places are of the design, and the assembly may be larger.
    unit = assembly.unit if slides else math.pi / 180.0
    low, high = motion.low / unit, motion.high / unit
    near = ROUNDED * (high - low)
    if not slides:
        stated = low + (stated - low + near) % 360.0 - near
    if motion.closed:
        return float(stated * unit)
    if not low - near <= stated <= high + near:
        raise NotMade(f"The input goes from {low:.5g} to {high:.5g}.", f"/query/{name}")
    return float(min(max(stated, low), high) * unit)
