"""What the process that makes parts is asked for: files of a design of a stored result."""

from __future__ import annotations

from typing import Any

from service.parts import cad
from service.parts.made import made
from service.parts.model import Assembly, InputField
from service.parts.package import package
from service.parts.sizes import AssemblyQuery, File, NotMade, Refused
from service.render import heading
from service.render.page.svg import clean
from service.stated import read
from synthesis.registry import KINDS


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
    name = motion.input_field
    other: InputField = "input_angle" if name == "input_place" else "input_place"
    if getattr(asked, other) is not None:
        raise NotMade(f"The input of this mechanism is stated by {name}.", f"/query/{other}")
    stated = getattr(asked, name)
    return motion.reference if stated is None else motion.stated(stated, assembly.unit)
