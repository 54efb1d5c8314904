"""Sizes of the parts of a train: the options of a request, and values derived from the gears; millimetres."""

from __future__ import annotations

import math
from collections.abc import Iterator

from kinematics.gear.teeth import Gear
from service.parts.gears.keys import key_for
from service.parts.sizes import (
    CLEARANCES,
    LARGEST_ASSEMBLY,
    LOOSEST,
    MILLIMETRES,
    THINNEST_PIN,
    TIGHTEST,
    WALL,
    WIDEST_PIN,
    WIDTH,
    NotMade,
    PartsQuery,
    Sizes,
    judged,
    rounded_down,
    rounded_up,
    sheet_for,
)
from service.parts.standards import PINS

FACE = 6.0
"""Default face width, modules, if neither the answer nor the request has one."""

NARROWEST, WIDEST = 0.5, 100.0
"""Minimum and maximum face width, modules."""

BORE_OF_ROOT = 0.5
"""Thickest default shaft, as a share of the root circle of the smallest gear."""

WALL_OF_TEETH = 1.0
"""Minimum wall between a keyway and the roots of the teeth, modules."""

RIM = 2.5
"""Width of a ring outside its roots, modules."""

PLAY_OF_TEETH, MOST_PLAY = 0.15, 0.3
"""Maximum play of teeth in modules: by default, and as requested."""

TRIED = 6
"""Maximum number of default bores that are tried."""


class GearSizing:
    """Options of a request for a train, and derived sizes.

    Attributes
    ----------
    factor : float
        Millimetres per length unit of the design, at the built size.
    unit, words : float, str
        Millimetres per length unit of the problem, and the name of that unit.
    path : str
        The field responsible if shafts do not fit.
    """

    def __init__(self, query: PartsQuery, length_unit: str) -> None:
        self.query = query
        self.unit = MILLIMETRES[length_unit]
        self.words = length_unit
        self.factor = self.unit * query.scale
        self.path = "/query/scale" if query.bore is None else "/query/bore"

    def judge_size(self, size: float, what: str = "train") -> None:
        """Refuse assemblies larger than the maximum."""
        if size > LARGEST_ASSEMBLY:
            most = rounded_down(self.query.scale * LARGEST_ASSEMBLY / size)
            raise NotMade(
                f"The {what} is about {size / 1000.0:.4g} m large at this scale, but parts are made up to "
                f"{LARGEST_ASSEMBLY / 1000.0:g} m; use at most scale {most:g}.", "/query/scale",
            )  # fmt: skip

    def face_width(self, module: float, answered: float | None) -> float:
        """Return the face width of a gear: as requested, as in the answer, or the default in modules.

        Parameters
        ----------
        module : float
            Module, millimetres.
        answered : float or None
            Face width of the answer in the unit of the problem, at the original size.
        """
        stated = self.query.face_width
        if stated is None:
            return FACE * module if answered is None else answered * self.factor
        width = stated * self.unit
        least, most = NARROWEST * module, WIDEST * module
        if not least <= width <= most:
            raise NotMade(
                f"The face width must be from {rounded_up(least / self.unit):g} to "
                f"{rounded_down(most / self.unit):g} {self.words} for a module of {module / self.unit:.4g}.",
                "/query/face_width",
            )
        return width

    def offered(self, smallest: Gear, room: float = math.inf, passed: str = "") -> Iterator[Sizes]:
        """Yield sizes with the requested bore, or with bores that fit the smallest gear, thickest first.

        Parameters
        ----------
        smallest : Gear
        room : float
            Distance from the axis of a shaft with its collar or spacer to a gear that it passes, millimetres.
        passed : str
            The shaft and the gear there, in words.
        """
        query, unit = self.query, self.unit
        if query.bore is not None:
            sizes = self._stated(query.bore * unit, smallest)
            if _beside(sizes) > room:
                raise NotMade(self._too_near(room, passed), "/query/bore")
            yield sizes
            return
        most = 2.0 * BORE_OF_ROOT * smallest.root_radius
        # Thickest first: strong shafts are preferred.
        thinner = [self._with(bore, smallest) for bore in reversed(PINS) if bore <= most]
        fits = [sizes for sizes in thinner if self._fits(sizes, smallest)]
        if not fits:
            thinnest = self._with(PINS[0], smallest)
            # Scale at which the thinnest standard shaft satisfies all three conditions.
            needed = max(
                keyway_reach(thinnest) / (smallest.root_radius - WALL_OF_TEETH * smallest.module),
                (keyway_reach(thinnest) + WALL * thinnest.pin) / smallest.root_radius,
                thinnest.pin / most,
            )
            raise NotMade(
                f"The smallest gear has a root circle of {2.0 * smallest.root_radius / unit:.4g} {self.words}, too "
                "small "
                f"for a shaft; use scale {rounded_up(1.05 * query.scale * needed):g} or more.", "/query/scale",
            )  # fmt: skip
        fits = [sizes for sizes in fits if _beside(sizes) <= room]
        if not fits:
            needed = rounded_up(1.05 * query.scale * _beside(self._with(PINS[0], smallest)) / room)
            raise NotMade(f"{self._too_near(room, passed)}; use scale {needed:g} or more.", "/query/scale")
        for sizes in fits[:TRIED]:
            judged(sizes, unit)
            yield sizes

    def _too_near(self, room: float, passed: str) -> str:
        told = f"{room / self.unit:.4g} {self.words}"
        return f"The {passed} at {told} from its axis, too close for a shaft with a spacer"

    def _stated(self, bore: float, smallest: Gear) -> Sizes:
        unit = self.unit
        if not THINNEST_PIN <= bore <= WIDEST_PIN:
            raise NotMade(
                f"Shafts of {bore / unit:.6g} {self.words} are not available; use {THINNEST_PIN / unit:g} to "
                f"{WIDEST_PIN / unit:g} {self.words}.", "/query/bore",
            )  # fmt: skip
        sizes = self._with(bore, smallest)
        judged(sizes, unit)
        if not self._fits(sizes, smallest):
            thinner = [one for one in PINS if one < bore and self._fits(self._with(one, smallest), smallest)]
            works = f"; use {thinner[-1] / unit:g} {self.words}" if thinner else ""
            raise NotMade(
                f"A bore of {bore / unit:.6g} {self.words} with its keyway leaves too thin a wall below the teeth of "
                f"the smallest gear, whose root circle is {2.0 * smallest.root_radius / unit:.4g} "
                f"{self.words}{works}.",
                "/query/bore",
            )
        return sizes

    def _with(self, bore: float, smallest: Gear) -> Sizes:
        """Return sizes with the thickness and clearance of the request."""
        query, unit, module = self.query, self.unit, smallest.module
        # The clearance is also the play of the teeth, which limits it by the module.
        if query.clearance is None:
            usual = min(CLEARANCES[query.process], PLAY_OF_TEETH * module)
            clearance = min(max(usual, 2.0 * TIGHTEST * bore), 0.5 * LOOSEST * bore)
        else:
            clearance = query.clearance * unit
            if clearance > MOST_PLAY * module:
                raise NotMade(
                    "The clearance is also the play of the teeth, and must be at most "
                    f"{rounded_down(MOST_PLAY * module / unit):g} {self.words} for the module "
                    f"{module / unit:.4g}.", "/query/clearance",
                )  # fmt: skip
        thickness = sheet_for(bore) if query.thickness is None else query.thickness * unit
        return Sizes(query.process, WIDTH * bore, bore, thickness, clearance)

    def _fits(self, sizes: Sizes, smallest: Gear) -> bool:
        wall = max(WALL_OF_TEETH * smallest.module, WALL * sizes.pin)
        return keyway_reach(sizes) + wall <= smallest.root_radius


def _beside(sizes: Sizes) -> float:
    """Return the minimum distance from the axis of a shaft with collars and spacers to another part."""
    return 0.5 * sizes.collar + sizes.apart


def keyway_reach(sizes: Sizes) -> float:
    """Return the distance from the axis to the corners of the keyway."""
    key = key_for(sizes.pin)
    return math.hypot(0.5 * sizes.pin + key.in_hub + sizes.clearance, 0.5 * key.width + sizes.clearance)
