"""Files of designs by type of mechanism: labelled SVG sheets, animations, DXF drawings and CSV tables."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, get_args

from service.loading import IMPORTS
from service.render.page.svg import clean_text
from synthesis.model.design_interface import AnyDesign
from synthesis.model.problem import ProblemBase

__all__ = ["Form", "NoSuchExport", "NotBuilt", "export_design", "list_forms", "make_heading"]

Form = Literal["svg", "gif", "dxf", "csv"]

Maker = Callable[[Any, Any, str], str | bytes]
"""Makes a file from a design, its problem and a title."""

LINKAGE_KEY = "linkage"
"""Key of the makers that serve every linkage; :mod:`service.render.linkage.kind_tables` adds the content of each kind.
"""

GENEVA_TYPES = ("geneva_external", "geneva_internal", "geneva_spherical")
"""Types of Geneva drives, which share their makers."""

FORMS_BY_TYPE: dict[str, tuple[Form, ...]] = {
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
    **dict.fromkeys(GENEVA_TYPES, ("svg", "gif", "dxf", "csv")),
    "ratchet": ("svg", "dxf", "csv"),
}
"""File formats by type of mechanism; linkages are not listed and have all formats."""


class NoSuchExport(LookupError):
    """This type of mechanism has no file of this format."""


class NotBuilt(ValueError):
    """The design cannot be rebuilt: its lengths are at the numeric limits of a statement."""


# The makers of a form are imported when one is first used, so that a starting server loads no drawing library.


def load_sheets() -> dict[str, Maker]:
    """Import and return the functions that draw designs, by type of mechanism."""
    from service.render.cam.sheet import draw_barrel_sheet, draw_cam_sheet
    from service.render.gears.gearbox_sheet import draw_gearbox_sheet, draw_layshaft_sheet
    from service.render.gears.planetary_sheet import draw_planetary_sheet
    from service.render.gears.series_sheet import draw_series_sheet
    from service.render.gears.train_sheet import draw_gear_train_sheet
    from service.render.linkage.sheet import draw_linkage_sheet
    from service.render.rotor.sheet import draw_rotor_sheet
    from service.render.shafts.engine import draw_engine_sheet
    from service.render.shafts.flywheel import draw_flywheel_sheet
    from service.render.shafts.indexing import draw_indexing_sheet
    from service.render.shafts.ratchet import draw_ratchet_sheet

    return {
        LINKAGE_KEY: draw_linkage_sheet,
        "cam": draw_cam_sheet,
        "barrel_cam": draw_barrel_sheet,
        "gear_train": draw_gear_train_sheet,
        "planetary_train": draw_planetary_sheet,
        "train_series": draw_series_sheet,
        "gearbox": draw_gearbox_sheet,
        "layshaft_gearbox": draw_layshaft_sheet,
        "rotor": draw_rotor_sheet,
        "flywheel": draw_flywheel_sheet,
        "engine": draw_engine_sheet,
        **dict.fromkeys(GENEVA_TYPES, draw_indexing_sheet),
        "ratchet": draw_ratchet_sheet,
    }


def _load_animations() -> dict[str, Maker]:
    from service.render.cam.animation import draw_barrel_animation, draw_cam_animation
    from service.render.gears.gearbox_animation import draw_gearbox_animation, draw_layshaft_animation
    from service.render.gears.train_animation import draw_gear_train_animation
    from service.render.gears.turning import draw_planetary_animation, draw_series_animation
    from service.render.linkage.animation import draw_linkage_animation
    from service.render.shafts.indexing import draw_indexing_animation

    return {
        LINKAGE_KEY: draw_linkage_animation,
        "cam": draw_cam_animation,
        "barrel_cam": draw_barrel_animation,
        "gear_train": draw_gear_train_animation,
        "planetary_train": draw_planetary_animation,
        "train_series": draw_series_animation,
        "gearbox": draw_gearbox_animation,
        "layshaft_gearbox": draw_layshaft_animation,
        **dict.fromkeys(GENEVA_TYPES, draw_indexing_animation),
    }


def _load_drawings() -> dict[str, Maker]:
    from service.render.cam.dxf import write_barrel_dxf, write_cam_dxf
    from service.render.gears.dxf import write_gear_train_dxf, write_planetary_dxf, write_series_dxf
    from service.render.gears.gearbox_dxf import write_gearbox_dxf, write_layshaft_dxf
    from service.render.linkage.dxf import write_linkage_dxf
    from service.render.rotor.dxf import write_rotor_dxf
    from service.render.shafts.engine import write_engine_dxf
    from service.render.shafts.flywheel import write_flywheel_dxf
    from service.render.shafts.indexing import write_indexing_dxf
    from service.render.shafts.ratchet import write_ratchet_dxf

    return {
        LINKAGE_KEY: write_linkage_dxf,
        "cam": write_cam_dxf,
        "barrel_cam": write_barrel_dxf,
        "gear_train": write_gear_train_dxf,
        "planetary_train": write_planetary_dxf,
        "train_series": write_series_dxf,
        "gearbox": write_gearbox_dxf,
        "layshaft_gearbox": write_layshaft_dxf,
        "rotor": write_rotor_dxf,
        "flywheel": write_flywheel_dxf,
        "engine": write_engine_dxf,
        **dict.fromkeys(GENEVA_TYPES, write_indexing_dxf),
        "ratchet": write_ratchet_dxf,
    }


def _load_tables() -> dict[str, Maker]:
    from service.render.cam.csv import write_barrel_table, write_cam_table
    from service.render.gears.csv import (
        write_gear_train_table,
        write_gearbox_table,
        write_layshaft_table,
        write_planetary_table,
        write_series_table,
    )
    from service.render.linkage.csv import write_function_table, write_linkage_table
    from service.render.rotor.csv import write_rotor_table
    from service.render.shafts.engine import write_engine_table
    from service.render.shafts.flywheel import write_flywheel_table
    from service.render.shafts.indexing import write_indexing_table
    from service.render.shafts.ratchet import write_ratchet_table

    return {
        LINKAGE_KEY: write_linkage_table,
        "function": write_function_table,
        "cam": write_cam_table,
        "barrel_cam": write_barrel_table,
        "gear_train": write_gear_train_table,
        "planetary_train": write_planetary_table,
        "train_series": write_series_table,
        "gearbox": write_gearbox_table,
        "layshaft_gearbox": write_layshaft_table,
        "rotor": write_rotor_table,
        "flywheel": write_flywheel_table,
        "engine": write_engine_table,
        **dict.fromkeys(GENEVA_TYPES, write_indexing_table),
        "ratchet": write_ratchet_table,
    }


_MAKER_LOADERS: dict[Form, Callable[[], dict[str, Maker]]] = {
    "svg": load_sheets,
    "gif": _load_animations,
    "dxf": _load_drawings,
    "csv": _load_tables,
}
"""Loaders of the makers of each format, by type of mechanism or kind of problem."""


def make_heading(problem: ProblemBase, label: str | None, number: int) -> str:
    """Return the heading of a design's drawings: the label of its job or the name of its kind, and its number.

    Parameters
    ----------
    problem : pydantic model
    label : str or None
    number : int
        The design's index in the answer, from 0; the heading counts from 1.
    """
    return f"{label or problem.model_config.get('title') or problem.kind}, design {number + 1}"


def list_forms(mechanism: str) -> list[Form]:
    """Return the file formats available for a type of mechanism."""
    return list(FORMS_BY_TYPE.get(mechanism, get_args(Form)))


def export_design(design: AnyDesign, problem: ProblemBase, title: str, form: Form) -> str | bytes:
    """Write a design as a file: text, or bytes for an animation.

    Parameters
    ----------
    design : LinkageDesign or the design of another kind
        The design to draw; failed checks make no difference.
    problem : ProblemBase
        The problem that the design solves.
    title : str
        Heading; free text, from which forbidden characters are removed.
    form : {"svg", "gif", "dxf", "csv"}
        File format. An SVG has a title and a description. It has no scripts, style sheets, element ids or references,
        so that several can be embedded in one page.

    Returns
    -------
    str or bytes
        Content of the file. The same arguments give the same content.

    Raises
    ------
    NoSuchExport
        This type of mechanism has no file of this format.
    NotBuilt
        If the mechanism cannot be rebuilt from the design.
    """
    mechanism = design.mechanism.type
    if form not in list_forms(mechanism):
        raise NoSuchExport(mechanism, form)
    # Only one thread of the server imports libraries on demand at a time.
    with IMPORTS:
        makers = _MAKER_LOADERS[form]()
    # Look up by type first: a kind, such as functions, may have makers of its own for linkages.
    make = makers.get(mechanism) or makers.get(problem.kind) or makers[LINKAGE_KEY]
    return make(design, problem, clean_text(title))
