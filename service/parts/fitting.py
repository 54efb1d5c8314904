"""Sizes with which a mechanism has room for its parts: those of the request, or the thickest pins that fit.

What is built of a mechanism differs by its type; that sizes are stated or found, judged, tried and refused does not. A
subclass of :class:`Fitting` says how an assembly is made in given sizes.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import NamedTuple

from service.parts.model import Assembly
from service.parts.overlaps import overlaps, too_thin
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
    pin_below,
    rounded_down,
    rounded_up,
    sheet_for,
)
from service.parts.standards import PINS

LEAST_FACTOR, STEPS = 2.0**16, 7
"""How much larger a mechanism is tried at most, and how finely the least factor is then found: steps of halving."""


class Trial(NamedTuple):
    """An assembly, or why there is none."""

    assembly: Assembly | None
    reason: str


class Fitting(ABC):
    """One request: a mechanism, and what is asked of its parts.

    Parameters
    ----------
    query : PartsQuery
    unit : float
        Millimetres to a unit of length of the design.
    size : float
        Of the mechanism, in that unit.

    Raises
    ------
    NotMade
        Where it is larger than parts are made.
    """

    def __init__(self, query: PartsQuery, unit: float, size: float) -> None:
        self._query, self._unit, self._size = query, unit, size
        largest, most = size * unit * query.scale, LARGEST_ASSEMBLY / (size * unit)
        if largest > LARGEST_ASSEMBLY:
            raise NotMade(
                f"The mechanism is {largest / 1000.0:.4g} m large at this scale, and parts are made up to "
                f"{LARGEST_ASSEMBLY / 1000.0:g} m; scale {rounded_down(most):g} is the greatest that works.",
                "/query/scale",
            )

    def assembly(self) -> Assembly:
        """The assembly of the request.

        Raises
        ------
        NotMade
            Where there is no room for it.
        """
        if self._query.width is None and self._query.pin is None:
            return self.by_default()
        sizes = self.stated()
        trial = self.tried(sizes, self._query.scale)
        if trial.assembly is None:
            raise self.refusal(sizes, trial.reason)
        return trial.assembly

    # What a type of mechanism says

    @abstractmethod
    def tried(self, sizes: Sizes, scale: float) -> Trial:
        """The assembly in these sizes."""

    @property
    @abstractmethod
    def most(self) -> float:
        """The thickest pin that is tried where none is stated, in units of the design."""

    def opening(self, sizes: Sizes) -> tuple[float, str]:
        """The widest of what links are cut out for, and what it is for."""
        return sizes.hole, "pins"

    def of_the_problem(self) -> Iterator[Sizes]:
        """Sizes that the problem states."""
        yield from ()

    # Sizes

    def stated(self) -> Sizes:
        """The sizes of a request that states the width or the pin; the other follows."""
        query, unit = self._query, self._unit
        width = None if query.width is None else query.width * unit
        pin = None if query.pin is None else query.pin * unit
        if pin is None:
            assert width is not None
            pin = pin_below(width / WIDTH)
            path = "/query/width"
        else:
            path = "/query/pin"
        if not THINNEST_PIN <= pin <= WIDEST_PIN:
            raise NotMade(
                f"Pins of {pin / unit:.6g} {self._words} are none that are made; from {THINNEST_PIN / unit:g} to "
                f"{WIDEST_PIN / unit:g} {self._words} they are.", path,
            )  # fmt: skip
        if width is not None and width > LARGEST_ASSEMBLY:
            raise NotMade(
                f"Parts are made up to {LARGEST_ASSEMBLY / unit:g} {self._words}, and links are narrower than that.",
                "/query/width",
            )
        sizes = self._with(WIDTH * pin if width is None else width, pin)
        self._judged(sizes)
        return sizes

    @property
    def _words(self) -> str:
        return {value: name for name, value in MILLIMETRES.items()}[self._unit]

    def _with(self, width: float, pin: float) -> Sizes:
        """Sizes with what the request states of thickness and clearance."""
        query, unit = self._query, self._unit
        clearance = CLEARANCES[query.process] if query.clearance is None else query.clearance * unit
        if query.clearance is None:
            clearance = min(max(clearance, 2.0 * TIGHTEST * pin), 0.5 * LOOSEST * pin)
        thickness = sheet_for(pin) if query.thickness is None else query.thickness * unit
        return Sizes(query.process, width, pin, thickness, clearance)

    def _judged(self, sizes: Sizes) -> None:
        """Refuse sizes that contradict one another, whatever the mechanism is."""
        unit, words = self._unit, self._words
        judged(sizes, unit)
        hole, what = self.opening(sizes)
        least = hole + 2.0 * WALL * sizes.pin
        if sizes.width < least * (1.0 - 1e-9):
            raise NotMade(
                f"Links with {what} of {sizes.pin / unit:.6g} {words} are to be {rounded_up(least / unit):g} {words} "
                "wide at least, which leaves a wall of a quarter of the pin.",
                "/query/pin" if self._query.width is None else "/query/width",
            )

    def by_default(self) -> Assembly:
        """The assembly with the thickest pins that leave room, those of the problem's block first."""
        scale = self._query.scale
        for sizes in self.of_the_problem():
            trial = self.tried(sizes, scale)
            if trial.assembly is not None:
                return trial.assembly
        most = self.most * self._unit * scale
        offered = [self._with(WIDTH * pin, pin) for pin in PINS if pin <= most]
        offered = offered or [self._with(WIDTH * THINNEST_PIN, THINNEST_PIN)]
        last = ""
        found = None
        # What fits is nearly always a matter of size: the thickest, or else the thinnest, and then between them.
        low, high, at = 0, len(offered), len(offered) - 1
        while low < high:
            self._judged(offered[at])
            trial = self.tried(offered[at], scale)
            if trial.assembly is not None:
                found, low = trial.assembly, at + 1
            else:
                last, high = trial.reason, at
            at = (low + high) // 2 if found else 0
            if found is None and high == 0:
                break
        if found is not None:
            return found
        raise self.refusal(self._with(WIDTH * THINNEST_PIN, THINNEST_PIN), last, "/query/scale")

    # Refusals

    def refusal(self, sizes: Sizes, reason: str, path: str = "") -> NotMade:
        """What is said where parts find no room: the least scale at which they do, and the greatest width at this."""
        scale, unit = self._query.scale, self._unit
        path = path or ("/query/pin" if self._query.width is None else "/query/width")
        known = f"There is no room for links {sizes.width / unit:.4g} {self._words} wide: {reason}."
        least = self._least_scale(sizes, scale)
        if least is None:
            largest = rounded_down(LARGEST_ASSEMBLY / (self._size * unit))
            if self.tried(self._with(WIDTH * THINNEST_PIN, THINNEST_PIN), largest).assembly is not None:
                words = f"{known} Narrower ones fit, but these at no scale up to {largest:g}, the greatest."
                return NotMade(words, path)
            return NotMade(f"{known} Nor is there for narrower ones: the mechanism cannot be built in planes.")
        words = f"{known} These sizes fit from scale {least:.4g} on"
        widest, thinner = sizes.width * scale / least, sizes.pin * scale / least
        if thinner >= THINNEST_PIN:
            words += (
                f"; at scale {scale:g} a width of {rounded_down(widest / unit):g} {self._words} does, with pin, "
                "thickness and clearance in proportion"
            )
        return NotMade(f"{words}.", path)

    def _least_scale(self, sizes: Sizes, scale: float) -> float | None:
        """The least scale, up to a few hundredths, at which these sizes fit."""
        too_small, fits = scale, None
        size, factor = self._size * self._unit * scale, 2.0
        # No mechanism has room for a pin that is twice as thick as all of it is large.
        while 2.0 * size * factor < sizes.pin:
            too_small, factor = scale * factor, 2.0 * factor
        most = LEAST_FACTOR * factor / 2.0
        while factor <= most and size * factor <= LARGEST_ASSEMBLY:
            if self.tried(sizes, scale * factor).assembly is not None:
                fits = scale * factor
                break
            too_small, factor = scale * factor, 2.0 * factor
        if fits is None:
            return None
        for _ in range(STEPS):
            middle = math.sqrt(too_small * fits)
            if self.tried(sizes, middle).assembly is not None:
                fits = middle
            else:
                too_small = middle
        rounded = rounded_up(fits)
        return rounded if self.tried(sizes, rounded).assembly is not None else fits


def fault_of(assembly: Assembly, sizes: Sizes, *, across: bool = True) -> str:
    """Why an assembly cannot be made: too little is left around a hole, or two parts meet; empty where it can.

    Parts whose axes are not parallel are compared where ``across`` says so.
    """
    thin = too_thin(assembly, 0.99 * WALL * sizes.pin)
    if thin:
        return f"{named(thin[0].part)} has too little left around its holes"
    meeting = overlaps(assembly, across=across)
    if not meeting:
        return ""
    (one, other), at = (named(name) for name in meeting[0].parts), meeting[0].at
    if assembly.motion.input_field == "input_place":
        return f"{one} and {other} meet at the input's place {at / assembly.unit:.4g}"
    return f"{one} and {other} meet at an input angle of {math.degrees(at):.1f}°"


def named(part: str) -> str:
    """A part in a sentence."""
    return "the " + part.replace("_", " ")
