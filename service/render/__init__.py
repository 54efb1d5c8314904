"""Files of designs: labelled SVG sheets, DXF drawings and tables, by type of mechanism."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

from service.render.gear_csv import gear_train_table
from service.render.gear_dxf import gear_train_drawing
from service.render.gear_sheet import gear_train_sheet
from service.render.linkage_sheet import linkage_sheet
from service.render.sheet import fourbar_sheet

__all__ = ["NoSuchExport", "exported"]

Form = Literal["svg", "dxf", "csv"]

EXPORTS: dict[str, dict[Form, Callable[[Any, Any, str], str]]] = {
    "fourbar": {"svg": fourbar_sheet},
    "slider_crank": {"svg": linkage_sheet},
    "inverted_slider_crank": {"svg": linkage_sheet},
    "watt_2": {"svg": linkage_sheet},
    "gear_train": {"svg": gear_train_sheet, "dxf": gear_train_drawing, "csv": gear_train_table},
}
"""For each type of mechanism how a design and its problem, under a title, become a file of each form."""


class NoSuchExport(LookupError):
    """This type of mechanism has no file of this form."""


def exported(design: Any, problem: Any, title: str, form: Form) -> str:
    """A design as the text of a file.

    Parameters
    ----------
    design : LinkageDesign or the design of another kind
        What is drawn; a design that failed a check is drawn as it is.
    problem : StatedProblem
        The problem that it answers.
    title : str
        Heading; any text, characters that the form forbids are left out.
    form : {"svg", "dxf", "csv"}
        An SVG has a title and a description, and no scripts, style sheets, element ids or references, so that it can
        stand in a page beside others.

    Returns
    -------
    str
        The same arguments give the same text.

    Raises
    ------
    NoSuchExport
        Where there is no such file of this type of mechanism.
    """
    forms = EXPORTS.get(design.mechanism.type, {})
    if form not in forms:
        raise NoSuchExport(design.mechanism.type, form)
    return forms[form](design, problem, title)
