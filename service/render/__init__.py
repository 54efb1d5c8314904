"""Files of designs: labelled SVG sheets, animations, DXF drawings and tables, by type of mechanism."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Literal, get_args

from service.loading import IMPORTS
from service.render.page.svg import clean

__all__ = ["Form", "NoSuchExport", "NotBuilt", "exported", "forms"]

Form = Literal["svg", "gif", "dxf", "csv"]

_LINKAGE: dict[Form, str] = {
    "svg": "service.render.linkage.sheet:linkage_sheet",
    "gif": "service.render.linkage.animation:linkage_animation",
    "dxf": "service.render.linkage.dxf:linkage_drawing",
    "csv": "service.render.linkage.csv:linkage_table",
}

_UNDRAWN: dict[Form, str] = {form: maker for form, maker in _LINKAGE.items() if form != "svg"}
"""Of types whose sheet is that of a kind of problem."""

EXPORTS: dict[str, dict[Form, str]] = {
    "cam": {
        "svg": "service.render.cam.sheet:cam_sheet",
        "gif": "service.render.cam.animation:cam_animation",
        "dxf": "service.render.cam.dxf:cam_drawing",
        "csv": "service.render.cam.csv:cam_table",
    },
    "barrel_cam": {
        "svg": "service.render.cam.barrel_sheet:barrel_sheet",
        "gif": "service.render.cam.animation:barrel_animation",
        "dxf": "service.render.cam.barrel_exports:barrel_drawing",
        "csv": "service.render.cam.barrel_exports:barrel_table",
    },
    "fourbar": {**_LINKAGE, "svg": "service.render.linkage.fourbar_sheet:fourbar_sheet"},
    "slider_crank": _LINKAGE,
    "geared_fivebar": _LINKAGE,
    "inverted_slider_crank": _LINKAGE,
    "watt_2": _LINKAGE,
    "stephenson_3": _LINKAGE,
    "crank_shaper": _UNDRAWN,
    "whitworth": _UNDRAWN,
    "drag_link_rocker": _UNDRAWN,
    "drag_link_slider": _UNDRAWN,
    "davis": _UNDRAWN,
    "peaucellier": _UNDRAWN,
    "hart": _UNDRAWN,
    "scott_russell": _UNDRAWN,
    "dwell_rocker": _UNDRAWN,
    "dwell_slider": _UNDRAWN,
    "dwell_slot": _UNDRAWN,
    "watt_1": _UNDRAWN,
    "gear_train": {
        "svg": "service.render.gears.train_sheet:gear_train_sheet",
        "gif": "service.render.gears.train_animation:gear_train_animation",
        "dxf": "service.render.gears.train_dxf:gear_train_drawing",
        "csv": "service.render.gears.csv:gear_train_table",
    },
    "planetary_train": {
        "svg": "service.render.gears.planetary_sheet:planetary_sheet",
        "dxf": "service.render.gears.planetary_dxf:planetary_drawing",
        "csv": "service.render.gears.csv:planetary_table",
    },
    "gearbox": {
        "svg": "service.render.gears.gearbox_sheet:gearbox_sheet",
        "dxf": "service.render.gears.gearbox_dxf:gearbox_drawing",
        "csv": "service.render.gears.csv:gearbox_table",
    },
    "layshaft_gearbox": {
        "svg": "service.render.gears.gearbox_sheet:layshaft_sheet",
        "dxf": "service.render.gears.gearbox_dxf:layshaft_drawing",
        "csv": "service.render.gears.csv:layshaft_table",
    },
}
"""For each type of mechanism what makes a file of each form of a design, its problem and a title: ``module:function``,
imported when it is needed, so that a server that starts does not wait for a drawing library."""


EXPORTS_OF_KIND: dict[str, dict[Form, str]] = {
    "function": {
        "svg": "service.render.linkage.function_sheet:function_sheet",
        "csv": "service.render.linkage.function_csv:function_table",
    },
    "quick_return": {"svg": "service.render.linkage.stroke_sheet:stroke_sheet"},
    "steering": {"svg": "service.render.linkage.steering_sheet:steering_sheet"},
    "straight_line": {"svg": "service.render.linkage.line_sheet:line_sheet"},
    "dwell": {"svg": "service.render.linkage.dwell_sheet:dwell_sheet"},
    "parallel_motion": {"svg": "service.render.linkage.parallel_sheet:parallel_sheet"},
}
"""The same by the kind of problem, where that and not the type of mechanism decides what is shown; looked at first."""


class NoSuchExport(LookupError):
    """This type of mechanism has no file of this form."""


class NotBuilt(ValueError):
    """The design is of a size that is not taken for a mechanism's: one for lengths at the end of what can be stated."""


def forms(kind: str, mechanism: str) -> list[Form]:
    """The forms of files that there are of a type of mechanism in answers to a kind of problem."""
    makers = _makers(kind, mechanism)
    return [form for form in get_args(Form) if form in makers]


def _makers(kind: str, mechanism: str) -> dict[Form, str]:
    return {**EXPORTS.get(mechanism, {}), **EXPORTS_OF_KIND.get(kind, {})}


def exported(design: Any, problem: Any, title: str, form: Form) -> str | bytes:
    """A design as the text of a file, or its bytes where it is an animation.

    Parameters
    ----------
    design : LinkageDesign or the design of another kind
        What is drawn; a design that failed a check is drawn as it is.
    problem : StatedProblem
        The problem that it answers.
    title : str
        Heading; any text, characters that the form forbids are left out.
    form : {"svg", "gif", "dxf", "csv"}
        An SVG has a title and a description, and no scripts, style sheets, element ids or references, so that it can
        stand in a page beside others.

    Returns
    -------
    str or bytes
        The same arguments give the same file.

    Raises
    ------
    NoSuchExport
        Where there is no such file of this type of mechanism.
    NotBuilt
        Where the design cannot be built.
    """
    makers = _makers(problem.kind, design.mechanism.type)
    if form not in makers:
        raise NoSuchExport(design.mechanism.type, form)
    module, function = makers[form].split(":")
    with IMPORTS:
        make = getattr(import_module(module), function)
    file: str | bytes = make(design, problem, clean(title))
    return file
