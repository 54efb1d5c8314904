"""Sizes of the parts of a train: the options of a request, and values derived from the gears; millimetres."""

from __future__ import annotations

import math
from collections.abc import Iterator

from kinematics.gear.teeth import Gear
from service.parts.assembly.keys import find_key
from service.parts.assembly.sizes import (
    DEFAULT_CLEARANCES,
    MAX_ASSEMBLY_SIZE,
    MAX_CLEARANCE_PER_PIN,
    MAX_PIN,
    MILLIMETRES_PER_UNIT,
    MIN_CLEARANCE_PER_PIN,
    MIN_PIN,
    MIN_WALL_PER_PIN,
    WIDTH_PER_PIN,
    NotMade,
    PartsQuery,
    Sizes,
    check_sizes,
    choose_sheet,
    round_down,
    round_up,
)
from service.parts.assembly.standard_parts import PIN_DIAMETERS

DEFAULT_FACE_WIDTH = 6.0
"""Default face width, modules, if neither the answer nor the request has one."""

MIN_FACE_WIDTH, MAX_FACE_WIDTH = 0.5, 100.0
"""Minimum and maximum face width, modules."""

MAX_BORE_PER_ROOT = 0.5
"""Thickest default shaft, as a share of the root circle of the smallest gear."""

MIN_TOOTH_WALL = 1.0
"""Minimum wall between a keyway and the roots of the teeth, modules."""

RIM_WIDTH = 2.5
"""Width of a ring outside its roots, modules."""

DEFAULT_TOOTH_PLAY, MAX_TOOTH_PLAY = 0.15, 0.3
"""Maximum play of teeth in modules: of the default, and of a request."""

MAX_TRIED = 6
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
        self.unit = MILLIMETRES_PER_UNIT[length_unit]
        self.words = length_unit
        self.factor = self.unit * query.scale
        self.path = "/query/scale" if query.bore is None else "/query/bore"

    def check_size(self, size: float, what: str = "train") -> None:
        """Refuse assemblies larger than the maximum."""
        if size > MAX_ASSEMBLY_SIZE:
            most = round_down(self.query.scale * MAX_ASSEMBLY_SIZE / size)
            raise NotMade(
                f"The {what} is about {size / 1000.0:.4g} m large at this scale, but parts are made up to "
                f"{MAX_ASSEMBLY_SIZE / 1000.0:g} m; use at most scale {most:g}.", "/query/scale",
            )  # fmt: skip

    def choose_face_width(self, module: float, answered: float | None) -> float:
        """Return the face width of a gear: as requested, as in the answer, or the default in modules.

        Parameters
        ----------
        module : float
            Module, millimetres.
        answered : float or None
            Face width of the answer in the unit of the problem, at the original size.
        """
        requested = self.query.face_width
        if requested is None:
            return DEFAULT_FACE_WIDTH * module if answered is None else answered * self.factor
        width = requested * self.unit
        least, most = MIN_FACE_WIDTH * module, MAX_FACE_WIDTH * module
        if not least <= width <= most:
            raise NotMade(
                f"The face width must be from {round_up(least / self.unit):g} to "
                f"{round_down(most / self.unit):g} {self.words} for a module of {module / self.unit:.4g}.",
                "/query/face_width",
            )
        return width

    def list_sizes(self, smallest: Gear, room: float = math.inf, passed: str = "") -> Iterator[Sizes]:
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
            sizes = self._make_requested(query.bore * unit, smallest)
            if _measure_clearance(sizes) > room:
                raise NotMade(self._describe_obstruction(room, passed), "/query/bore")
            yield sizes
            return
        most = 2.0 * MAX_BORE_PER_ROOT * smallest.root_radius
        # Thickest first: strong shafts are preferred.
        thinner = [self._make_sizes(bore, smallest) for bore in reversed(PIN_DIAMETERS) if bore <= most]
        fits = [sizes for sizes in thinner if self._check_fit(sizes, smallest)]
        if not fits:
            thinnest = self._make_sizes(PIN_DIAMETERS[0], smallest)
            # Scale at which the thinnest standard shaft satisfies all three conditions.
            needed = max(
                measure_keyway_reach(thinnest) / (smallest.root_radius - MIN_TOOTH_WALL * smallest.module),
                (measure_keyway_reach(thinnest) + MIN_WALL_PER_PIN * thinnest.pin) / smallest.root_radius,
                thinnest.pin / most,
            )
            raise NotMade(
                f"The smallest gear has a root circle of {2.0 * smallest.root_radius / unit:.4g} {self.words}, too "
                "small "
                f"for a shaft; use scale {round_up(1.05 * query.scale * needed):g} or more.", "/query/scale",
            )  # fmt: skip
        fits = [sizes for sizes in fits if _measure_clearance(sizes) <= room]
        if not fits:
            needed = round_up(
                1.05 * query.scale * _measure_clearance(self._make_sizes(PIN_DIAMETERS[0], smallest)) / room
            )
            raise NotMade(f"{self._describe_obstruction(room, passed)}; use scale {needed:g} or more.", "/query/scale")
        for sizes in fits[:MAX_TRIED]:
            check_sizes(sizes, unit)
            yield sizes

    def _describe_obstruction(self, room: float, passed: str) -> str:
        distance = f"{room / self.unit:.4g} {self.words}"
        return f"The {passed} at {distance} from its axis, too close for a shaft with a spacer"

    def _make_requested(self, bore: float, smallest: Gear) -> Sizes:
        unit = self.unit
        if not MIN_PIN <= bore <= MAX_PIN:
            raise NotMade(
                f"Shafts of {bore / unit:.6g} {self.words} are not available; use {MIN_PIN / unit:g} to "
                f"{MAX_PIN / unit:g} {self.words}.", "/query/bore",
            )  # fmt: skip
        sizes = self._make_sizes(bore, smallest)
        check_sizes(sizes, unit)
        if not self._check_fit(sizes, smallest):
            thinner = [
                one
                for one in PIN_DIAMETERS
                if one < bore and self._check_fit(self._make_sizes(one, smallest), smallest)
            ]
            works = f"; use {thinner[-1] / unit:g} {self.words}" if thinner else ""
            raise NotMade(
                f"A bore of {bore / unit:.6g} {self.words} with its keyway leaves too thin a wall below the teeth of "
                f"the smallest gear, whose root circle is {2.0 * smallest.root_radius / unit:.4g} "
                f"{self.words}{works}.",
                "/query/bore",
            )
        return sizes

    def _make_sizes(self, bore: float, smallest: Gear) -> Sizes:
        """Return sizes with the thickness and clearance of the request."""
        query, unit, module = self.query, self.unit, smallest.module
        # The clearance is also the play of the teeth, which limits it by the module.
        if query.clearance is None:
            usual = min(DEFAULT_CLEARANCES[query.process], DEFAULT_TOOTH_PLAY * module)
            clearance = min(max(usual, 2.0 * MIN_CLEARANCE_PER_PIN * bore), 0.5 * MAX_CLEARANCE_PER_PIN * bore)
        else:
            clearance = query.clearance * unit
            if clearance > MAX_TOOTH_PLAY * module:
                raise NotMade(
                    "The clearance is also the play of the teeth, and must be at most "
                    f"{round_down(MAX_TOOTH_PLAY * module / unit):g} {self.words} for the module "
                    f"{module / unit:.4g}.", "/query/clearance",
                )  # fmt: skip
        thickness = choose_sheet(bore) if query.thickness is None else query.thickness * unit
        return Sizes(query.process, WIDTH_PER_PIN * bore, bore, thickness, clearance)

    def _check_fit(self, sizes: Sizes, smallest: Gear) -> bool:
        wall = max(MIN_TOOTH_WALL * smallest.module, MIN_WALL_PER_PIN * sizes.pin)
        return measure_keyway_reach(sizes) + wall <= smallest.root_radius


def _measure_clearance(sizes: Sizes) -> float:
    """Return the minimum distance from the axis of a shaft with collars and spacers to another part."""
    return 0.5 * sizes.collar + sizes.min_gap


def measure_keyway_reach(sizes: Sizes) -> float:
    """Return the distance from the axis to the corners of the keyway."""
    key = find_key(sizes.pin)
    return math.hypot(0.5 * sizes.pin + key.in_hub + sizes.clearance, 0.5 * key.width + sizes.clearance)
