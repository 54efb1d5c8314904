"""Files of designs by type of mechanism: labelled SVG sheets, animations, DXF drawings and CSV tables."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, get_args

from service.loading import IMPORTS
from service.render.page.svg import clean

__all__ = ["Form", "NoSuchExport", "NotBuilt", "exported", "forms", "heading"]

Form = Literal["svg", "gif", "dxf", "csv"]

Maker = Callable[[Any, Any, str], str | bytes]
"""Makes a file from a design, its problem and a title."""

LINKAGE = "linkage"
"""Key of the makers that serve every linkage; :mod:`service.render.linkage.kind_tables` adds the content of each kind.
"""

GENEVA = ("geneva_external", "geneva_internal", "geneva_spherical")
"""Types of Geneva drives, which share their makers."""

FILES: dict[str, tuple[Form, ...]] = {
    "cam": ("svg", "gif", "dxf", "csv"),
    "barrel_cam": ("svg", "gif", "dxf", "csv"),
    "gear_train": ("svg", "gif", "dxf", "csv"),
    "planetary_train": ("svg", "gif", "dxf", "csv"),
    "train_series": ("svg", "gif", "dxf", "csv"),
    "gearbox": ("svg", "gif", "dxf", "csv"),
    "layshaft_gearbox": ("svg", "gif", "dxf", "csv"),
    "rotor": ("svg", "dxf", "csv"),
    "flywheel": ("svg", "dxf", "csv"),
    "engine": ("svg", "dxf", "csv"),
    **dict.fromkeys(GENEVA, ("svg", "gif", "dxf", "csv")),
    "ratchet": ("svg", "dxf", "csv"),
}
"""File formats by type of mechanism; linkages are not listed and have all formats."""


class NoSuchExport(LookupError):
    """This type of mechanism has no file of this format."""


class NotBuilt(ValueError):
    """The design cannot be rebuilt: its lengths are at the numeric limits of a statement."""


# The makers of a form are imported when one is first used, so that a starting server loads no drawing library.


def _sheets() -> dict[str, Maker]:
    from service.render.cam.sheet import barrel_sheet, cam_sheet
    from service.render.gears.gearbox_sheet import gearbox_sheet, layshaft_sheet
    from service.render.gears.planetary_sheet import planetary_sheet
    from service.render.gears.series_sheet import series_sheet
    from service.render.gears.train_sheet import gear_train_sheet
    from service.render.linkage.sheet import linkage_sheet
    from service.render.rotor.sheet import rotor_sheet
    from service.render.shafts.engine import engine_sheet
    from service.render.shafts.flywheel import flywheel_sheet
    from service.render.shafts.indexing import indexing_sheet
    from service.render.shafts.ratchet import ratchet_sheet

    return {
        LINKAGE: linkage_sheet,
        "cam": cam_sheet,
        "barrel_cam": barrel_sheet,
        "gear_train": gear_train_sheet,
        "planetary_train": planetary_sheet,
        "train_series": series_sheet,
        "gearbox": gearbox_sheet,
        "layshaft_gearbox": layshaft_sheet,
        "rotor": rotor_sheet,
        "flywheel": flywheel_sheet,
        "engine": engine_sheet,
        **dict.fromkeys(GENEVA, indexing_sheet),
        "ratchet": ratchet_sheet,
    }


def _animations() -> dict[str, Maker]:
    from service.render.cam.animation import barrel_animation, cam_animation
    from service.render.gears.gearbox_animation import gearbox_animation, layshaft_animation
    from service.render.gears.train_animation import gear_train_animation
    from service.render.gears.turning import planetary_animation, series_animation
    from service.render.linkage.animation import linkage_animation
    from service.render.shafts.indexing import indexing_animation

    return {
        LINKAGE: linkage_animation,
        "cam": cam_animation,
        "barrel_cam": barrel_animation,
        "gear_train": gear_train_animation,
        "planetary_train": planetary_animation,
        "train_series": series_animation,
        "gearbox": gearbox_animation,
        "layshaft_gearbox": layshaft_animation,
        **dict.fromkeys(GENEVA, indexing_animation),
    }


def _drawings() -> dict[str, Maker]:
    from service.render.cam.dxf import barrel_drawing, cam_drawing
    from service.render.gears.dxf import gear_train_drawing, planetary_drawing, series_drawing
    from service.render.gears.gearbox_dxf import gearbox_drawing, layshaft_drawing
    from service.render.linkage.dxf import linkage_drawing
    from service.render.rotor.dxf import rotor_drawing
    from service.render.shafts.engine import engine_drawing
    from service.render.shafts.flywheel import flywheel_drawing
    from service.render.shafts.indexing import indexing_drawing
    from service.render.shafts.ratchet import ratchet_drawing

    return {
        LINKAGE: linkage_drawing,
        "cam": cam_drawing,
        "barrel_cam": barrel_drawing,
        "gear_train": gear_train_drawing,
        "planetary_train": planetary_drawing,
        "train_series": series_drawing,
        "gearbox": gearbox_drawing,
        "layshaft_gearbox": layshaft_drawing,
        "rotor": rotor_drawing,
        "flywheel": flywheel_drawing,
        "engine": engine_drawing,
        **dict.fromkeys(GENEVA, indexing_drawing),
        "ratchet": ratchet_drawing,
    }


def _tables() -> dict[str, Maker]:
    from service.render.cam.csv import barrel_table, cam_table
    from service.render.gears.csv import (
        gear_train_table,
        gearbox_table,
        layshaft_table,
        planetary_table,
        series_table,
    )
    from service.render.linkage.csv import function_table, linkage_table
    from service.render.rotor.csv import rotor_table
    from service.render.shafts.engine import engine_table
    from service.render.shafts.flywheel import flywheel_table
    from service.render.shafts.indexing import indexing_table
    from service.render.shafts.ratchet import ratchet_table

    return {
        LINKAGE: linkage_table,
        "function": function_table,
        "cam": cam_table,
        "barrel_cam": barrel_table,
        "gear_train": gear_train_table,
        "planetary_train": planetary_table,
        "train_series": series_table,
        "gearbox": gearbox_table,
        "layshaft_gearbox": layshaft_table,
        "rotor": rotor_table,
        "flywheel": flywheel_table,
        "engine": engine_table,
        **dict.fromkeys(GENEVA, indexing_table),
        "ratchet": ratchet_table,
    }


_MAKERS: dict[Form, Callable[[], dict[str, Maker]]] = {
    "svg": _sheets,
    "gif": _animations,
    "dxf": _drawings,
    "csv": _tables,
}
"""Loaders of the makers of each format, by type of mechanism or kind of problem."""


def heading(problem: Any, label: str | None, number: int) -> str:
    """Return the heading of a design's drawings: the label of its job or the name of its kind, and its number.

    Parameters
    ----------
    problem : pydantic model
    label : str or None
    number : int
        The design's index in the answer, from 0; the heading counts from 1.
    """
    return f"{label or problem.model_config.get('title') or problem.kind}, design {number + 1}"


def forms(mechanism: str) -> list[Form]:
    """Return the file formats available for a type of mechanism."""
    return list(FILES.get(mechanism, get_args(Form)))


def exported(design: Any, problem: Any, title: str, form: Form) -> str | bytes:
    """Write a design as a file: text, or bytes for an animation.

    Parameters
    ----------
    design : LinkageDesign or the design of another kind
        The design to draw; failed checks make no difference.
    problem : StatedProblem
        The problem that the design solves.
    title : str
        Heading; free text, from which forbidden characters are removed.
    form : {"svg", "gif", "dxf", "csv"} An SVG has a title and a description. It has no scripts, style sheets, element
        ids or references, so that several can be embedded in one page.

    Returns
    -------
    str or bytes
        Deterministic: the same arguments give the same file.

    Raises
    ------
    NoSuchExport
        This type of mechanism has no file of this format.
    NotBuilt
        The mechanism cannot be rebuilt from the design.
    """
    mechanism = design.mechanism.type
    if form not in forms(mechanism):
        raise NoSuchExport(mechanism, form)
    # Only one thread of the server imports libraries on demand at a time.
    with IMPORTS:
        makers = _MAKERS[form]()
    # Look up by type first: a kind, such as functions, may have makers of its own for linkages.
    make = makers.get(mechanism) or makers.get(problem.kind) or makers[LINKAGE]
    return make(design, problem, clean(title))
