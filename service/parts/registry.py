"""Entry point: from a design to the assembly of its parts, by the maker of its mechanism type.

A maker takes a design, its problem and a query, and returns an assembly that :mod:`service.parts.assembly.interference`
has checked, or raises :class:`~service.parts.assembly.sizes.NotMade`. It declares the fields of the query that it
reads; others are refused, so that no option is ignored silently. Makers are imported on first use.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from kinematics.message import compose
from service.parts.assembly.sizes import NotMade, PartsQuery
from synthesis.model.design_interface import AnyDesign
from synthesis.model.problem import ProblemBase

if TYPE_CHECKING:
    from service.parts.assembly.model import Assembly

__all__ = ["NotMade", "make_parts"]

Make = Callable[[Any, Any, PartsQuery], "Assembly"]

LINKAGE_KEY = "linkage"
"""Key of the maker of every mechanism with a skeleton."""


class Maker(NamedTuple):
    """A maker of parts for a type of mechanism: its loader, and the fields of the query that it reads."""

    load: Callable[[], Make]
    fields: frozenset[str]


def _load_linkages() -> Make:
    from service.parts.linkage.maker import make_linkage_parts

    return make_linkage_parts


def _load_trains() -> Make:
    from service.parts.gears.ordinary import make_train_parts

    return make_train_parts


def _load_planetary_trains() -> Make:
    from service.parts.gears.planetary import make_planetary_parts

    return make_planetary_parts


def _load_cams() -> Make:
    from service.parts.cam.radial import make_cam_parts

    return make_cam_parts


def _load_barrels() -> Make:
    from service.parts.cam.barrel import make_barrel_parts

    return make_barrel_parts


def _load_genevas() -> Make:
    from service.parts.indexing.geneva import make_geneva_parts

    return make_geneva_parts


def _load_sphericals() -> Make:
    from service.parts.indexing.spherical_geneva import make_spherical_parts

    return make_spherical_parts


def _load_ratchets() -> Make:
    from service.parts.indexing.ratchet import make_ratchet_parts

    return make_ratchet_parts


CYCLIC_FIELDS = frozenset({"process", "width", "pin", "thickness", "clearance", "scale"})
"""Fields for parts on shafts of one base that rotate continuously."""


def _load_series() -> Make:
    from service.parts.gears.series import make_series_parts

    return make_series_parts


def _load_layshaft_gearboxes() -> Make:
    from service.parts.gears.layshaft import make_layshaft_parts

    return make_layshaft_parts


def _load_sliding_gearboxes() -> Make:
    from service.parts.gears.sliding import make_sliding_parts

    return make_sliding_parts


def _load_flywheels() -> Make:
    from service.parts.flywheel import make_flywheel_parts

    return make_flywheel_parts


GEAR_FIELDS = frozenset({"process", "thickness", "clearance", "bore", "face_width", "scale"})
"""Fields for trains of gears."""

MAKERS: dict[str, Maker] = {
    LINKAGE_KEY: Maker(
        _load_linkages, frozenset({"process", "width", "pin", "thickness", "clearance", "shafts", "over", "scale"})
    ),
    "gear_train": Maker(_load_trains, GEAR_FIELDS),
    "planetary_train": Maker(_load_planetary_trains, GEAR_FIELDS),
    "train_series": Maker(_load_series, GEAR_FIELDS),
    "layshaft_gearbox": Maker(_load_layshaft_gearboxes, GEAR_FIELDS),
    "gearbox": Maker(_load_sliding_gearboxes, GEAR_FIELDS | {"speed"}),
    "flywheel": Maker(_load_flywheels, GEAR_FIELDS - {"face_width"}),
    "cam": Maker(_load_cams, CYCLIC_FIELDS),
    "barrel_cam": Maker(_load_barrels, CYCLIC_FIELDS),
    "geneva_external": Maker(_load_genevas, CYCLIC_FIELDS),
    "geneva_internal": Maker(_load_genevas, CYCLIC_FIELDS),
    "geneva_spherical": Maker(_load_sphericals, CYCLIC_FIELDS),
    "ratchet": Maker(_load_ratchets, CYCLIC_FIELDS),
}
"""Makers by type of mechanism."""


UNAVAILABLE_TYPES = {"rotor": "parts-rotor-without-shape", "engine": "parts-engine-without-widths"}
"""Types of mechanism without parts, and the messages with the reason and an alternative."""


def make_parts(design: AnyDesign, problem: ProblemBase, query: PartsQuery) -> Assembly:
    """Make the parts of a design.

    Parameters
    ----------
    design, problem
        Design and problem of the kind.
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If the mechanism has no maker, the query has a field without meaning for it, or the parts do not fit.
    """
    mechanism = design.mechanism
    maker = _get_maker(hasattr(mechanism, "skeleton"), mechanism.type)
    if maker is None:
        raise NotMade(compose("parts-not-available", reason=compose(UNAVAILABLE_TYPES[mechanism.type])))
    for field in PartsQuery.model_fields:
        # Defaults are not errors: only fields that the client set count.
        if field in query.model_fields_set and getattr(query, field) is not None and field not in maker.fields:
            raise NotMade(compose("parts-field-without-meaning", field=field), f"/query/{field}")
    return maker.load()(design, problem, query)


def _get_maker(linkage: bool, mechanism_type: str) -> Maker | None:
    return MAKERS.get(LINKAGE_KEY if linkage else mechanism_type)
