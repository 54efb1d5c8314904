"""Requests to the process that makes parts: files of a design of a stored result."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from pydantic import BaseModel

from service.parts import cad
from service.parts.isometric import isometric_sheet
from service.parts.items import items
from service.parts.made import made
from service.parts.model import Assembly, InputField
from service.parts.package import package, part_file
from service.parts.painted import painted_sheet
from service.parts.sizes import AssemblyQuery, File, NotMade, PartFile, PartsQuery, Process, Refused, ViewQuery
from service.parts.viewed import files_of, viewed
from service.render import heading
from service.render.page.svg import clean
from service.stated import read
from synthesis.registry import KINDS

KEPT = 4
"""Number of cached assemblies: viewers of an assembly usually request its parts next."""


class Order(BaseModel):
    """A design of a stored job, and the options of its parts."""

    kind: str
    problem: str
    label: str | None
    result: str
    number: int
    query: dict[str, Any]


def filled(order: dict[str, Any], file: File) -> bytes | Refused:
    """Make a file of a design; return its bytes, or the reason why it does not exist.

    Parameters
    ----------
    order : dict
        Fields of an :class:`Order` with the query of the file.
    file : {"zip", "step", "glb", "json", "svg"}
    """
    asked = Order.model_validate(order)
    try:
        return _file(asked, file)
    except NotMade as error:
        return Refused(str(error), error.path)


def _file(order: Order, file: File) -> bytes:
    assembly = _assembly(order)
    if file == "zip":
        return package(assembly, _process(order), _title(order), _input(assembly, AssemblyQuery()))
    if file == "json":
        query = ViewQuery.model_validate(order.query)
        return viewed(assembly, query.positions).model_dump_json().encode()
    at = _input(assembly, AssemblyQuery.model_validate(order.query))
    if file == "svg":
        draw = isometric_sheet if assembly.parallel else painted_sheet
        return draw(assembly, _title(order), at).encode()
    solids = cad.placed(assembly, cad.solids_of(assembly), at)
    return cad.step(solids, "assembly") if file == "step" else cad.glb(solids, "assembly")


def part_filled(order: dict[str, Any], name: str, form: PartFile) -> bytes | Refused:
    """Make a file of one item of a design.

    Parameters
    ----------
    order : dict
        Fields of an :class:`Order` whose query is a :class:`PartsQuery`.
    name : str
        Name of the item.
    form : {"dxf", "stl", "step", "3mf"}
    """
    asked = Order.model_validate(order)
    try:
        listed = items(_assembly(asked))
    except NotMade as error:
        return Refused(str(error), error.path)
    item = next((item for item in listed if item.name == name), None)
    if item is None:
        return Refused(
            f"Unknown part. Parts of this design: {', '.join(item.name for item in listed)}.", "", known=False
        )
    if form not in files_of(item.part):
        return Refused(f"{name} has no {form} file.", "", known=False)
    return part_file(item, form, _title(asked))


def _title(order: Order) -> str:
    return clean(heading(read(order.kind, order.problem), order.label, order.number))


def _process(order: Order) -> Process:
    return PartsQuery.model_validate(_sizes(order)).process


def _sizes(order: Order) -> dict[str, Any]:
    """Return the options of the parts themselves, without those of their display."""
    return {name: value for name, value in order.query.items() if name in PartsQuery.model_fields}


def _assembly(order: Order) -> Assembly:
    return _made(order.kind, order.problem, order.result, order.number, tuple(sorted(_sizes(order).items())))


@lru_cache(maxsize=KEPT)
def _made(kind: str, problem: str, result: str, number: int, query: tuple[tuple[str, Any], ...]) -> Assembly:
    design = KINDS[kind].result.model_validate_json(result).designs[number]
    return made(design, read(kind, problem), PartsQuery.model_validate(dict(query)))


def _input(assembly: Assembly, asked: AssemblyQuery) -> float:
    """Return the input at which the assembly is shown, within the range for which its parts were made."""
    motion = assembly.motion
    # The mechanism determines whether the input is an angle or a place.
    name = motion.input_field
    other: InputField = "input_angle" if name == "input_place" else "input_place"
    if getattr(asked, other) is not None:
        raise NotMade(f"The input of this mechanism is given by `{name}`.", f"/query/{other}")
    stated = getattr(asked, name)
    return motion.reference if stated is None else motion.stated(stated, assembly.unit)
