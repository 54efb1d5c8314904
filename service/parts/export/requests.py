"""Requests to the process that makes parts: files of a design of a stored result."""

from __future__ import annotations

from functools import lru_cache

from pydantic import BaseModel

from kinematics.message import compose
from service.parts.assembly.items import list_items
from service.parts.assembly.model import Assembly, InputField
from service.parts.assembly.sizes import (
    AssemblyQuery,
    File,
    FileRefusal,
    NotMade,
    PartFile,
    PartsQuery,
    Process,
    ViewQuery,
)
from service.parts.drawings.depth_buffer import draw_rendered_sheet
from service.parts.drawings.isometric import draw_isometric_sheet
from service.parts.export import cad
from service.parts.export.viewer_model import list_files, make_view
from service.parts.export.zip_package import write_item_file, write_package
from service.parts.registry import make_parts
from service.render import make_heading
from service.render.page.svg import clean_text
from service.requests import load_stored_problem
from synthesis.model.json_object import JsonObject
from synthesis.registry import KINDS

MAX_CACHED = 4
"""Number of cached assemblies: viewers of an assembly usually request its parts next."""


class PartsRequest(BaseModel):
    """A design of a stored job, and the options of its parts."""

    kind: str
    problem: str
    label: str | None
    result: str
    number: int
    query: JsonObject


def make_file(order: JsonObject, file: File) -> bytes | FileRefusal:
    """Make a file of a design; return its bytes, or the reason why it does not exist.

    Parameters
    ----------
    order : dict
        Fields of an :class:`PartsRequest` with the query of the file.
    file : {"zip", "step", "glb", "json", "svg"}
    """
    request = PartsRequest.model_validate(order)
    try:
        return _make_file(request, file)
    except NotMade as error:
        return FileRefusal(str(error), error.path)


def _make_file(order: PartsRequest, file: File) -> bytes:
    assembly = _get_assembly(order)
    if file == "zip":
        return write_package(
            assembly, _get_process(order), _make_title(order), _choose_input(assembly, AssemblyQuery())
        )
    if file == "json":
        query = ViewQuery.model_validate(order.query)
        return make_view(assembly, query.positions).model_dump_json().encode()
    at = _choose_input(assembly, AssemblyQuery.model_validate(order.query))
    if file == "svg":
        draw = draw_isometric_sheet if assembly.parallel else draw_rendered_sheet
        return draw(assembly, _make_title(order), at).encode()
    solids = cad.place_solids(assembly, cad.make_solids(assembly), at)
    return cad.write_step(solids, "assembly") if file == "step" else cad.write_glb(solids, "assembly")


def make_item_file(order: JsonObject, name: str, form: PartFile) -> bytes | FileRefusal:
    """Make a file of one item of a design.

    Parameters
    ----------
    order : dict
        Fields of an :class:`PartsRequest` whose query is a :class:`PartsQuery`.
    name : str
        Name of the item.
    form : {"dxf", "stl", "step", "3mf"}
    """
    request = PartsRequest.model_validate(order)
    try:
        listed = list_items(_get_assembly(request))
    except NotMade as error:
        return FileRefusal(str(error), error.path)
    item = next((item for item in listed if item.name == name), None)
    if item is None:
        return FileRefusal(
            compose("parts-unknown-part", parts=", ".join(item.name for item in listed)), "", known=False
        )
    if form not in list_files(item.part):
        return FileRefusal(compose("parts-no-such-file", part=name, format=form), "", known=False)
    return write_item_file(item, form, _make_title(request))


def _make_title(order: PartsRequest) -> str:
    return clean_text(make_heading(load_stored_problem(order.kind, order.problem), order.label, order.number))


def _get_process(order: PartsRequest) -> Process:
    return PartsQuery.model_validate(_select_size_options(order)).process


def _select_size_options(order: PartsRequest) -> JsonObject:
    """Return the options of the parts themselves, without those of their display."""
    return {name: value for name, value in order.query.items() if name in PartsQuery.model_fields}


def _get_assembly(order: PartsRequest) -> Assembly:
    return _make_assembly(
        order.kind, order.problem, order.result, order.number, tuple(sorted(_select_size_options(order).items()))
    )


@lru_cache(maxsize=MAX_CACHED)
def _make_assembly(
    kind: str, problem: str, result: str, number: int, query: tuple[tuple[str, object], ...]
) -> Assembly:
    design = KINDS[kind].result.model_validate_json(result).designs[number]
    return make_parts(design, load_stored_problem(kind, problem), PartsQuery.model_validate(dict(query)))


def _choose_input(assembly: Assembly, query: AssemblyQuery) -> float:
    """Return the input at which the assembly is shown, within the range for which its parts were made."""
    motion = assembly.motion
    # The mechanism determines whether the input is an angle or a place.
    name = motion.input_field
    other: InputField = "input_angle" if name == "input_place" else "input_place"
    if getattr(query, other) is not None:
        raise NotMade(compose("parts-input-field", field=name), f"/query/{other}")
    input_value = getattr(query, name)
    return motion.reference if input_value is None else motion.convert_input(input_value, assembly.unit)
