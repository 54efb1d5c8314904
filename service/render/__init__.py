"""Files of designs: labelled SVG sheets, animations, DXF drawings and tables, by type of mechanism."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, get_args

from service.loading import IMPORTS
from service.render.page.svg import clean

__all__ = ["Form", "NoSuchExport", "NotBuilt", "exported", "forms"]

Form = Literal["svg", "gif", "dxf", "csv"]

Maker = Callable[[Any, Any, str], str | bytes]
"""Makes a file of a design, its problem and a title."""

Loader = Callable[[], Maker]
"""Gives a maker, which it imports when it is called: a server that starts does not wait for a drawing library."""

Files = dict[Form, Loader]


class NoSuchExport(LookupError):
    """This type of mechanism has no file of this form."""


class NotBuilt(ValueError):
    """The design is of a size that is not taken for a mechanism's: one for lengths at the end of what can be stated."""


def _linkage_sheet() -> Maker:
    from service.render.linkage.sheet import linkage_sheet

    return linkage_sheet


def _linkage_animation() -> Maker:
    from service.render.linkage.animation import linkage_animation

    return linkage_animation


def _linkage_drawing() -> Maker:
    from service.render.linkage.dxf import linkage_drawing

    return linkage_drawing


def _linkage_table() -> Maker:
    from service.render.linkage.csv import linkage_table

    return linkage_table


def _function_table() -> Maker:
    from service.render.linkage.csv import function_table

    return function_table


def _cam_sheet() -> Maker:
    from service.render.cam.sheet import cam_sheet

    return cam_sheet


def _cam_animation() -> Maker:
    from service.render.cam.animation import cam_animation

    return cam_animation


def _cam_drawing() -> Maker:
    from service.render.cam.dxf import cam_drawing

    return cam_drawing


def _cam_table() -> Maker:
    from service.render.cam.csv import cam_table

    return cam_table


def _barrel_sheet() -> Maker:
    from service.render.cam.barrel_sheet import barrel_sheet

    return barrel_sheet


def _barrel_animation() -> Maker:
    from service.render.cam.animation import barrel_animation

    return barrel_animation


def _barrel_drawing() -> Maker:
    from service.render.cam.barrel_exports import barrel_drawing

    return barrel_drawing


def _barrel_table() -> Maker:
    from service.render.cam.barrel_exports import barrel_table

    return barrel_table


def _gear_train_sheet() -> Maker:
    from service.render.gears.train_sheet import gear_train_sheet

    return gear_train_sheet


def _gear_train_animation() -> Maker:
    from service.render.gears.train_animation import gear_train_animation

    return gear_train_animation


def _gear_train_drawing() -> Maker:
    from service.render.gears.train_dxf import gear_train_drawing

    return gear_train_drawing


def _gear_train_table() -> Maker:
    from service.render.gears.csv import gear_train_table

    return gear_train_table


def _planetary_sheet() -> Maker:
    from service.render.gears.planetary_sheet import planetary_sheet

    return planetary_sheet


def _planetary_drawing() -> Maker:
    from service.render.gears.planetary_dxf import planetary_drawing

    return planetary_drawing


def _planetary_table() -> Maker:
    from service.render.gears.csv import planetary_table

    return planetary_table


def _gearbox_sheet() -> Maker:
    from service.render.gears.gearbox_sheet import gearbox_sheet

    return gearbox_sheet


def _gearbox_drawing() -> Maker:
    from service.render.gears.gearbox_dxf import gearbox_drawing

    return gearbox_drawing


def _gearbox_table() -> Maker:
    from service.render.gears.csv import gearbox_table

    return gearbox_table


def _layshaft_sheet() -> Maker:
    from service.render.gears.gearbox_sheet import layshaft_sheet

    return layshaft_sheet


def _layshaft_drawing() -> Maker:
    from service.render.gears.gearbox_dxf import layshaft_drawing

    return layshaft_drawing


def _layshaft_table() -> Maker:
    from service.render.gears.csv import layshaft_table

    return layshaft_table


_LINKAGE: Files = {
    "svg": _linkage_sheet,
    "gif": _linkage_animation,
    "dxf": _linkage_drawing,
    "csv": _linkage_table,
}
"""Of every linkage; what its kind shows on the sheet stands in :mod:`service.render.linkage.kind_tables`."""

FILES: dict[str, Files] = {
    "function": {**_LINKAGE, "csv": _function_table},
    "cam": {"svg": _cam_sheet, "gif": _cam_animation, "dxf": _cam_drawing, "csv": _cam_table},
    "barrel_cam": {"svg": _barrel_sheet, "gif": _barrel_animation, "dxf": _barrel_drawing, "csv": _barrel_table},
    "gear_train": {
        "svg": _gear_train_sheet,
        "gif": _gear_train_animation,
        "dxf": _gear_train_drawing,
        "csv": _gear_train_table,
    },
    "planetary_train": {"svg": _planetary_sheet, "dxf": _planetary_drawing, "csv": _planetary_table},
    "gearbox": {"svg": _gearbox_sheet, "dxf": _gearbox_drawing, "csv": _gearbox_table},
    "layshaft_gearbox": {"svg": _layshaft_sheet, "dxf": _layshaft_drawing, "csv": _layshaft_table},
}
"""What makes the files of a type of mechanism, or of all designs of a kind, that are not those of any linkage."""


def forms(kind: str, mechanism: str) -> list[Form]:
    """The forms of files that there are of a type of mechanism in answers to a kind of problem."""
    files = _files(kind, mechanism)
    return [form for form in get_args(Form) if form in files]


def _files(kind: str, mechanism: str) -> Files:
    return FILES.get(mechanism) or FILES.get(kind) or _LINKAGE


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
    files = _files(problem.kind, design.mechanism.type)
    if form not in files:
        raise NoSuchExport(design.mechanism.type, form)
    with IMPORTS:
        make = files[form]()
    return make(design, problem, clean(title))
