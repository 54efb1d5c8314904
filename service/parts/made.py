"""Entry point: from a design to the assembly of its parts, by the maker of its mechanism type.

A maker takes a design, its problem and a query, and returns an assembly that :mod:`service.parts.overlaps` has checked,
or raises :class:`~service.parts.sizes.NotMade`. It declares the fields of the query that it reads; others are refused,
so that no option is ignored silently. Makers are imported on first use.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from service.parts.sizes import NotMade, PartsQuery

if TYPE_CHECKING:
    from service.parts.model import Assembly

__all__ = ["NotMade", "made"]

Make = Callable[[Any, Any, PartsQuery], "Assembly"]

LINKAGE = "linkage"
"""Key of the maker of every mechanism with a skeleton."""


class Maker(NamedTuple):
    """A maker of parts for a type of mechanism: its loader, and the fields of the query that it reads."""

    load: Callable[[], Make]
    fields: frozenset[str]


def _linkages() -> Make:
    from service.parts.linkages import linkage_parts

    return linkage_parts


def _trains() -> Make:
    from service.parts.gears.ordinary import train_parts

    return train_parts


def _planetary_trains() -> Make:
    from service.parts.gears.planetary import planetary_parts

    return planetary_parts


def _cams() -> Make:
    from service.parts.cams import cam_parts

    return cam_parts


def _barrels() -> Make:
    from service.parts.barrel import barrel_parts

    return barrel_parts


def _genevas() -> Make:
    from service.parts.geneva import geneva_parts

    return geneva_parts


def _sphericals() -> Make:
    from service.parts.spherical import spherical_parts

    return spherical_parts


def _ratchets() -> Make:
    from service.parts.ratchets import ratchet_parts

    return ratchet_parts


ONE_CYCLE = frozenset({"process", "width", "pin", "thickness", "clearance", "scale"})
"""Fields for parts on shafts of one base that rotate continuously."""


def _series() -> Make:
    from service.parts.gears.series import series_parts

    return series_parts


def _layshaft_gearboxes() -> Make:
    from service.parts.gears.layshaft import layshaft_parts

    return layshaft_parts


def _sliding_gearboxes() -> Make:
    from service.parts.gears.sliding import sliding_parts

    return sliding_parts


def _flywheels() -> Make:
    from service.parts.flywheel import flywheel_parts

    return flywheel_parts


OF_GEARS = frozenset({"process", "thickness", "clearance", "bore", "face_width", "scale"})
"""Fields for trains of gears."""

MAKERS: dict[str, Maker] = {
    LINKAGE: Maker(
        _linkages, frozenset({"process", "width", "pin", "thickness", "clearance", "shafts", "over", "scale"})
    ),
    "gear_train": Maker(_trains, OF_GEARS),
    "planetary_train": Maker(_planetary_trains, OF_GEARS),
    "train_series": Maker(_series, OF_GEARS),
    "layshaft_gearbox": Maker(_layshaft_gearboxes, OF_GEARS),
    "gearbox": Maker(_sliding_gearboxes, OF_GEARS | {"speed"}),
    "flywheel": Maker(_flywheels, OF_GEARS - {"face_width"}),
    "cam": Maker(_cams, ONE_CYCLE),
    "barrel_cam": Maker(_barrels, ONE_CYCLE),
    "geneva_external": Maker(_genevas, ONE_CYCLE),
    "geneva_internal": Maker(_genevas, ONE_CYCLE),
    "geneva_spherical": Maker(_sphericals, ONE_CYCLE),
    "ratchet": Maker(_ratchets, ONE_CYCLE),
}
"""Makers by type of mechanism."""


NOT_BUILT = {
    "rotor": "a rotor's answer contains masses, radii and angles to correct a rotor with, but no shape of it; use "
    "`designs/{n}.csv` or `.dxf`, which contain these, to correct the existing rotor",
    "engine": "an engine's answer contains crank angles, a firing order and balancing masses, but no diameter or "
    "width of a bore, journal or web; use `designs/{n}.csv` or `.dxf`, which contain these, or request the parts of "
    "one cylinder as a slider-crank of `kind` `motion`",
}
"""Types of mechanism without parts, with the reason and an alternative."""


def made(design: Any, problem: Any, query: PartsQuery) -> Assembly:
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
        The mechanism has no maker, the query has a field without meaning for it, or the parts do not fit.
    """
    mechanism = design.mechanism
    maker = _maker(hasattr(mechanism, "skeleton"), mechanism.type)
    if maker is None:
        raise NotMade(f"Parts of this type of mechanism are not available: {NOT_BUILT[mechanism.type]}.")
    for field in PartsQuery.model_fields:
        # Defaults are not errors: only fields that the client set count.
        if field in query.model_fields_set and getattr(query, field) is not None and field not in maker.fields:
            raise NotMade(f"Parts of this type of mechanism have no `{field}`; leave it out.", f"/query/{field}")
    return maker.load()(design, problem, query)


def _maker(linkage: bool, mechanism_type: str) -> Maker | None:
    return MAKERS.get(LINKAGE if linkage else mechanism_type)
