"""Search for sizes at which the parts of a mechanism fit: those of the request, or the thickest pins that fit.

Only the assembly depends on the type of mechanism. The handling of sizes, from the request to a possible refusal, is
the same for all types. A subclass of :class:`Fitting` builds an assembly in given sizes.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import NamedTuple

from kinematics.message import compose, join_messages
from service.parts.assembly.descriptions import name_part
from service.parts.assembly.interference import find_overlaps, find_thin_walls
from service.parts.assembly.model import Assembly
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
    choose_pin,
    choose_sheet,
    round_down,
    round_up,
)
from service.parts.assembly.standard_parts import PIN_DIAMETERS

MAX_FACTOR, BISECTION_STEPS = 2.0**16, 7
"""Maximum trial scale, and number of bisection steps that refine the minimum scale."""

NARROW_FOR_PINS, NARROW_FOR_RUNNER = "parts-links-narrow-for-pins", "parts-links-narrow-for-runner"
NARROW_FOR_BLOCKS, NARROW_FOR_SHAFTS = "parts-links-narrow-for-blocks", "parts-links-narrow-for-shafts"
"""Messages that links are too narrow for their widest opening."""


class Trial(NamedTuple):
    """An assembly, or the reason why there is none."""

    assembly: Assembly | None
    reason: str


class Fitting(ABC):
    """One request: a mechanism, and the options of its parts.

    Parameters
    ----------
    query : PartsQuery
    unit : float
        Millimetres per length unit of the design.
    size : float
        Size of the mechanism, in that unit.

    Raises
    ------
    NotMade
        If the mechanism exceeds the maximum size of parts.
    """

    def __init__(self, query: PartsQuery, unit: float, size: float) -> None:
        self._query, self._unit, self._size = query, unit, size
        largest, most = size * unit * query.scale, MAX_ASSEMBLY_SIZE / (size * unit)
        if largest > MAX_ASSEMBLY_SIZE:
            raise NotMade(
                compose(
                    "parts-mechanism-too-large",
                    size=f"{largest / 1000.0:.4g}",
                    largest=f"{MAX_ASSEMBLY_SIZE / 1000.0:g}",
                    scale=f"{round_down(most):g}",
                ),
                "/query/scale",
            )

    def build_assembly(self) -> Assembly:
        """Return the assembly of the request.

        Raises
        ------
        NotMade
            If the parts do not fit.
        """
        if self._query.width is None and self._query.pin is None:
            return self.find_default()
        sizes = self.get_requested_sizes()
        trial = self.try_sizes(sizes, self._query.scale)
        if trial.assembly is None:
            raise self.make_refusal(sizes, trial.reason)
        return trial.assembly

    # Methods that depend on the type of mechanism

    @abstractmethod
    def try_sizes(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in these sizes."""

    @property
    @abstractmethod
    def max_pin(self) -> float:
        """Thickest default pin that is tried, in units of the design."""

    def find_opening(self, sizes: Sizes) -> tuple[float, str]:
        """Return the widest opening in the links, and the id of the message that links are too narrow for it."""
        return sizes.hole, NARROW_FOR_PINS

    def list_problem_sizes(self) -> Iterator[Sizes]:
        """Yield the sizes that the problem contains."""
        yield from ()

    # Sizes

    def get_requested_sizes(self) -> Sizes:
        """Return the sizes of a request that gives the width or the pin; the other one follows."""
        query, unit = self._query, self._unit
        width = None if query.width is None else query.width * unit
        pin = None if query.pin is None else query.pin * unit
        if pin is None:
            assert width is not None
            pin = choose_pin(width / WIDTH_PER_PIN)
            path = "/query/width"
        else:
            path = "/query/pin"
        if not MIN_PIN <= pin <= MAX_PIN:
            raise NotMade(
                compose(
                    "parts-pin-not-available",
                    pin=f"{pin / unit:.6g}",
                    unit=self._words,
                    smallest=f"{MIN_PIN / unit:g}",
                    largest=f"{MAX_PIN / unit:g}",
                ),
                path,
            )
        if width is not None and width > MAX_ASSEMBLY_SIZE:
            raise NotMade(
                compose("parts-links-too-wide", largest=f"{MAX_ASSEMBLY_SIZE / unit:g}", unit=self._words),
                "/query/width",
            )
        sizes = self._with(WIDTH_PER_PIN * pin if width is None else width, pin)
        self._check_sizes(sizes)
        return sizes

    @property
    def _words(self) -> str:
        return {value: name for name, value in MILLIMETRES_PER_UNIT.items()}[self._unit]

    def _with(self, width: float, pin: float) -> Sizes:
        """Return sizes with the thickness and clearance of the request."""
        query, unit = self._query, self._unit
        clearance = DEFAULT_CLEARANCES[query.process] if query.clearance is None else query.clearance * unit
        if query.clearance is None:
            # The process's default is adapted to very thin and very thick pins.
            clearance = min(max(clearance, 2.0 * MIN_CLEARANCE_PER_PIN * pin), 0.5 * MAX_CLEARANCE_PER_PIN * pin)
        thickness = choose_sheet(pin) if query.thickness is None else query.thickness * unit
        return Sizes(query.process, width, pin, thickness, clearance)

    def _check_sizes(self, sizes: Sizes) -> None:
        """Refuse sizes that contradict one another for any mechanism."""
        unit, words = self._unit, self._words
        check_sizes(sizes, unit)
        hole, message_id = self.find_opening(sizes)
        # One wall on each side of the hole.
        least = hole + 2.0 * MIN_WALL_PER_PIN * sizes.pin
        if sizes.width < least * (1.0 - 1e-9):
            raise NotMade(
                compose(message_id, pin=f"{sizes.pin / unit:.6g}", unit=words, width=f"{round_up(least / unit):g}"),
                "/query/pin" if self._query.width is None else "/query/width",
            )

    def find_default(self) -> Assembly:
        """Return the assembly with the thickest pins that fit; sizes in the problem come first."""
        scale = self._query.scale
        for sizes in self.list_problem_sizes():
            trial = self.try_sizes(sizes, scale)
            if trial.assembly is not None:
                return trial.assembly
        most = self.max_pin * self._unit * scale
        offered = [self._with(WIDTH_PER_PIN * pin, pin) for pin in PIN_DIAMETERS if pin <= most]
        # Try at least the thinnest pin, for a meaningful error.
        offered = offered or [self._with(WIDTH_PER_PIN * MIN_PIN, MIN_PIN)]
        last = ""
        found = None
        # Fit is almost monotonic in size: try the thickest pin, then the thinnest, then bisect between them.
        low, high, at = 0, len(offered), len(offered) - 1
        while low < high:
            self._check_sizes(offered[at])
            trial = self.try_sizes(offered[at], scale)
            if trial.assembly is not None:
                found, low = trial.assembly, at + 1
            else:
                last, high = trial.reason, at
            # After the first failure try the thinnest, to detect impossible mechanisms early.
            at = (low + high) // 2 if found else 0
            if found is None and high == 0:
                break
        if found is not None:
            return found
        raise self.make_refusal(self._with(WIDTH_PER_PIN * MIN_PIN, MIN_PIN), last, "/query/scale")

    # Refusals

    def make_refusal(self, sizes: Sizes, reason: str, path: str = "") -> NotMade:
        """Return the error for parts that do not fit.

        Its message has the minimum scale at which they fit, and the maximum width at the requested scale.
        """
        scale, unit = self._query.scale, self._unit
        path = path or ("/query/pin" if self._query.width is None else "/query/width")
        known = compose("parts-links-do-not-fit", width=f"{sizes.width / unit:.4g}", unit=self._words, reason=reason)
        least = self._find_min_scale(sizes, scale)
        if least is None:
            largest = round_down(MAX_ASSEMBLY_SIZE / (self._size * unit))
            if self.try_sizes(self._with(WIDTH_PER_PIN * MIN_PIN, MIN_PIN), largest).assembly is not None:
                return NotMade(join_messages([known, compose("parts-only-narrower-fit", scale=f"{largest:g}")]), path)
            return NotMade(join_messages([known, compose("parts-no-links-fit")]))
        widest, thinner = sizes.width * scale / least, sizes.pin * scale / least
        if thinner >= MIN_PIN:
            remedy = compose(
                "parts-larger-scale-or-narrower-fits",
                least=f"{least:.4g}",
                scale=f"{scale:g}",
                width=f"{round_down(widest / unit):g}",
                unit=self._words,
            )
        else:
            remedy = compose("parts-larger-scale-fits", least=f"{least:.4g}")
        return NotMade(join_messages([known, remedy]), path)

    def _find_min_scale(self, sizes: Sizes, scale: float) -> float | None:
        """Find the minimum scale, to a few hundredths, at which these sizes fit."""
        too_small, fits = scale, None
        size, factor = self._size * self._unit * scale, 2.0
        # Skip scales at which a single pin would be twice as thick as the whole mechanism is large.
        while 2.0 * size * factor < sizes.pin:
            too_small, factor = scale * factor, 2.0 * factor
        most = MAX_FACTOR * factor / 2.0
        while factor <= most and size * factor <= MAX_ASSEMBLY_SIZE:
            if self.try_sizes(sizes, scale * factor).assembly is not None:
                fits = scale * factor
                break
            too_small, factor = scale * factor, 2.0 * factor
        if fits is None:
            return None
        for _ in range(BISECTION_STEPS):
            # Bisect on a logarithmic scale.
            middle = math.sqrt(too_small * fits)
            if self.try_sizes(sizes, middle).assembly is not None:
                fits = middle
            else:
                too_small = middle
        # Prefer a round scale, if it works.
        rounded = round_up(fits)
        return rounded if self.try_sizes(sizes, rounded).assembly is not None else fits


def find_fault(assembly: Assembly, sizes: Sizes, *, across: bool = True) -> str:
    """Return the reason why an assembly cannot be made (thin walls or interference), or an empty string.

    Parts with non-parallel axes are compared only if ``across`` is true.
    """
    thin = find_thin_walls(assembly, 0.99 * MIN_WALL_PER_PIN * sizes.pin)
    if thin:
        return compose("parts-walls-too-thin", part=name_part(thin[0].part))
    meeting = find_overlaps(assembly, across=across)
    if not meeting:
        return ""
    (one, other), at = (name_part(name) for name in meeting[0].parts), meeting[0].at
    if assembly.motion.input_field == "input_place":
        return compose("parts-collide-at-place", first=one, second=other, place=f"{at / assembly.unit:.4g}")
    return compose("parts-collide-at-angle", first=one, second=other, angle=f"{math.degrees(at):.1f}")
