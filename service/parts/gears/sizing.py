"""Sizes of the parts of a train: the options of a request, and values derived from the gears; millimetres."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from kinematics.gear.teeth import Gear
from kinematics.message import compose
from service.parts.assembly.descriptions import describe_identifier
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


class Passage(NamedTuple):
    """The axle of a planet next to a gear that it passes: the distance of its axis from the teeth, millimetres.

    The planet and the gear are given by their names in the arrangement.
    """

    distance: float
    planet: str
    gear: str


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

    def check_size(self, size: float, message_id: str = "parts-train-too-large") -> None:
        """Refuse assemblies larger than the maximum."""
        if size > MAX_ASSEMBLY_SIZE:
            most = round_down(self.query.scale * MAX_ASSEMBLY_SIZE / size)
            raise NotMade(
                compose(
                    message_id,
                    size=f"{size / 1000.0:.4g}",
                    largest=f"{MAX_ASSEMBLY_SIZE / 1000.0:g}",
                    scale=f"{most:g}",
                ),
                "/query/scale",
            )

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
                compose(
                    "parts-face-width-out-of-range",
                    smallest=f"{round_up(least / self.unit):g}",
                    largest=f"{round_down(most / self.unit):g}",
                    unit=self.words,
                    module=f"{module / self.unit:.4g}",
                ),
                "/query/face_width",
            )
        return width

    def list_sizes(self, smallest: Gear, passage: Passage | None = None) -> Iterator[Sizes]:
        """Yield sizes with the requested bore, or with bores that fit the smallest gear, thickest first.

        Parameters
        ----------
        smallest : Gear
        passage : Passage, optional
            The narrowest passage of an axle with its collar or spacer next to a gear.
        """
        query, unit = self.query, self.unit
        room = math.inf if passage is None else passage.distance
        if query.bore is not None:
            sizes = self._make_requested(query.bore * unit, smallest)
            if passage is not None and _measure_clearance(sizes) > room:
                raise NotMade(compose("parts-axle-too-close", **self._describe_passage(passage)), "/query/bore")
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
                compose(
                    "parts-root-circle-too-small",
                    diameter=f"{2.0 * smallest.root_radius / unit:.4g}",
                    unit=self.words,
                    scale=f"{round_up(1.05 * query.scale * needed):g}",
                ),
                "/query/scale",
            )
        fits = [sizes for sizes in fits if _measure_clearance(sizes) <= room]
        if passage is not None and not fits:
            needed = round_up(
                1.05 * query.scale * _measure_clearance(self._make_sizes(PIN_DIAMETERS[0], smallest)) / room
            )
            raise NotMade(
                compose("parts-axle-too-close-at-scale", **self._describe_passage(passage), scale=f"{needed:g}"),
                "/query/scale",
            )
        for sizes in fits[:MAX_TRIED]:
            check_sizes(sizes, unit)
            yield sizes

    def _describe_passage(self, passage: Passage) -> dict[str, str]:
        """Return the values of a message about a passage."""
        return {
            "planet": describe_identifier(passage.planet),
            "gear": describe_identifier(passage.gear),
            "distance": f"{passage.distance / self.unit:.4g}",
            "unit": self.words,
        }

    def _make_requested(self, bore: float, smallest: Gear) -> Sizes:
        unit = self.unit
        if not MIN_PIN <= bore <= MAX_PIN:
            raise NotMade(
                compose(
                    "parts-shaft-not-available",
                    bore=f"{bore / unit:.6g}",
                    unit=self.words,
                    smallest=f"{MIN_PIN / unit:g}",
                    largest=f"{MAX_PIN / unit:g}",
                ),
                "/query/bore",
            )
        sizes = self._make_sizes(bore, smallest)
        check_sizes(sizes, unit)
        if not self._check_fit(sizes, smallest):
            thinner = [
                one
                for one in PIN_DIAMETERS
                if one < bore and self._check_fit(self._make_sizes(one, smallest), smallest)
            ]
            values = {
                "bore": f"{bore / unit:.6g}",
                "unit": self.words,
                "diameter": f"{2.0 * smallest.root_radius / unit:.4g}",
            }
            detail = (
                compose("parts-bore-too-large", **values, thinner=f"{thinner[-1] / unit:g}")
                if thinner
                else compose("parts-bore-too-large-for-any", **values)
            )
            raise NotMade(detail, "/query/bore")
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
                    compose(
                        "parts-tooth-play-too-large",
                        largest=f"{round_down(MAX_TOOTH_PLAY * module / unit):g}",
                        unit=self.words,
                        module=f"{module / unit:.4g}",
                    ),
                    "/query/clearance",
                )
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
