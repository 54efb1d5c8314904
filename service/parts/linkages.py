"""From a design of a linkage to the assembly of its parts: planes for these sizes, and all parts looked at in motion.

The planes of :mod:`kinematics.linkage.layout` are found with everything that stands on a pin as wide as its collar, so
that washers, heads and rings have their room too. What comes of it is then looked at by :mod:`service.parts.overlaps`,
which knows nothing of planes; an assembly that it finds fault with is not given.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from typing import Any, Literal, NamedTuple

import numpy as np

from kinematics.errors import MechanismError
from kinematics.linkage.layout import Layout, laid_out
from kinematics.linkage.planar.branches import cycle
from kinematics.linkage.planar.mechanism import Mechanism
from service.parts.building import Planes, Slot, assembled
from service.parts.linkage_motion import LinkageMotion
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
from synthesis.analyses.cycle import branch_of, cycle_along
from synthesis.proof.rebuilt import rebuilt

DRIVEN = 181
"""Inputs at which it is seen whether the mechanism can be driven through the motion at all."""

TRAVELLED = 2881
"""Inputs at which it is seen how far blocks go in their slots."""

PIN_SHARE, PIN_OF_LINK = 0.04, 0.35
"""The thickest pin that is tried where none is stated: shares of the mechanism's size and of its shortest link."""

LEAST_FACTOR, STEPS = 2.0**16, 7
"""How much larger a mechanism is tried at most, and how finely the least factor is then found: steps of halving."""

Shafts = Literal["one_side", "both_sides"]


class _Trial(NamedTuple):
    """An assembly, or why there is none."""

    assembly: Assembly | None
    reason: str


def linkage_parts(design: Any, problem: Any, query: PartsQuery) -> Assembly:
    """The parts of a linkage that is made of pins and slides.

    Parameters
    ----------
    design : LinkageDesign
    problem : LinkageProblem
        Its block ``layout`` says what the request leaves out.
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        Where the mechanism has gears, cannot be driven, or leaves no room for such parts.
    """
    unit = MILLIMETRES[problem.length_unit]
    task = _Task(design, problem, query, unit)
    if query.width is None and query.pin is None:
        return task.by_default()
    sizes = task.stated()
    trial = task.tried(sizes, query.scale)
    if trial.assembly is None:
        raise task.refusal(sizes, trial.reason)
    return trial.assembly


class _Task:
    """One request: a mechanism, and what it says of its parts."""

    def __init__(self, design: Any, problem: Any, query: PartsQuery, unit: float) -> None:
        mechanism = rebuilt(design.mechanism, from_skeleton=True)
        if mechanism is None:
            raise NotMade("The design is of a size that is not built.")
        if mechanism.gears:
            raise NotMade("Parts are made of linkages with pins and slides; this one has gears.")
        self._mechanism, self._query, self._unit = mechanism, query, unit
        self._block = getattr(problem, "layout", None)
        over = query.over or getattr(self._block, "over", None)
        self._low, self._high, self._closed = _range(mechanism, design, over)
        places = [complex(z) for z in mechanism.joints.values()]
        self._size = max(abs(z - w) for z, w in combinations(places, 2))
        self._shortest = min(
            (
                length
                for listed in mechanism.links.values()
                for one, other in combinations(listed, 2)
                if (length := abs(complex(mechanism.joints[one] - mechanism.joints[other]))) > 1e-9 * self._size
            ),
            default=self._size,
        )
        largest = self._size * unit * query.scale
        if largest > LARGEST_ASSEMBLY:
            greatest = rounded_down(LARGEST_ASSEMBLY / (self._size * unit))
            raise NotMade(
                f"The mechanism is {largest / 1000.0:.4g} m large at this scale, and parts are made up to "
                f"{LARGEST_ASSEMBLY / 1000.0:g} m; scale {greatest:g} is the greatest that works.",
                "/query/scale",
            )

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
        hole = sizes.block[1] + 2.0 * sizes.clearance if self._mechanism.slides else sizes.hole
        least = hole + 2.0 * WALL * sizes.pin
        if sizes.width < least * (1.0 - 1e-9):
            what = "blocks on pins" if self._mechanism.slides else "pins"
            raise NotMade(
                f"Links with {what} of {sizes.pin / unit:.6g} {words} are to be {rounded_up(least / unit):g} {words} "
                "wide at least, which leaves a wall of a quarter of the pin.",
                "/query/pin" if self._query.width is None else "/query/width",
            )

    def by_default(self) -> Assembly:
        """The assembly with the thickest pins that leave room, those of the problem's block first."""
        scale = self._query.scale
        for sizes in self._of_the_problem():
            trial = self.tried(sizes, scale)
            if trial.assembly is not None:
                return trial.assembly
        most = min(PIN_SHARE * self._size, PIN_OF_LINK * self._shortest) * self._unit * scale
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

    def _of_the_problem(self) -> Iterator[Sizes]:
        block, factor = self._block, self._unit
        if block is not None:
            pin, width = block.pin_diameter * factor, block.link_width * factor
            sizes = self._with(width, pin)
            if self._query.thickness is None:
                sizes = replace(sizes, thickness=block.thickness * factor)
            try:
                self._judged(sizes)
            except NotMade:
                pass
            else:
                if THINNEST_PIN <= pin <= WIDEST_PIN:
                    yield sizes

    # Assemblies

    def tried(self, sizes: Sizes, scale: float) -> _Trial:
        """The assembly in these sizes, on the first choice of bases that can be built."""
        reason = ""
        for shafts in self._shafts():
            trial = self._tried(sizes, scale, shafts)
            if trial.assembly is not None:
                return trial
            reason = "; and between two bases ".join(filter(None, (reason, trial.reason)))
        return _Trial(None, reason)

    def _shafts(self) -> tuple[Shafts, ...]:
        stated = self._query.shafts or getattr(self._block, "shafts", None)
        return ("one_side", "both_sides") if stated is None else (stated,)

    def _tried(self, sizes: Sizes, scale: float, shafts: Shafts) -> _Trial:
        factor = self._unit * scale
        mechanism = _scaled(self._mechanism, factor)
        larger = factor if mechanism.driven_by_slide else 1.0
        motion = LinkageMotion(mechanism, larger * self._low, larger * self._high, self._closed)
        length, width = sizes.block
        try:
            layout = laid_out(
                mechanism,
                motion.low,
                motion.high,
                link_width=sizes.width,
                pin_diameter=sizes.collar,
                gap=sizes.apart,
                through=shafts == "both_sides",
                closed=motion.closed,
                slot_ends=0.5 * (length - width),
                whole=True,
            )
        except MechanismError as error:
            return _Trial(None, str(error))
        if layout.clashes:
            return _Trial(None, self._clashing(layout))
        assembly = assembled(motion, Planes(layout.planes, layout.pins), _slots(motion), sizes, factor, scale)
        thin = too_thin(assembly, 0.99 * WALL * sizes.pin)
        if thin:
            return _Trial(None, f"{_named(thin[0].part)} has too little left around its holes")
        meeting = overlaps(assembly)
        if meeting:
            one, other = (_named(name) for name in meeting[0].parts)
            return _Trial(None, f"{one} and {other} meet at {self._input(meeting[0].at / larger)}")
        return _Trial(assembly, "")

    def _clashing(self, layout: Layout) -> str:
        one, other = layout.clashes[0].parts
        return f"no planes keep {one} and {other} apart at {self._input(layout.clashes[0].at)}"

    def _input(self, at: float) -> str:
        if self._mechanism.driven_by_slide:
            return f"the input's place {at:.4g}"
        return f"an input angle of {math.degrees(at):.1f}°"

    def refusal(self, sizes: Sizes, reason: str, path: str = "") -> NotMade:
        """What is said where parts find no room: the least scale at which they do, and the greatest width at this."""
        scale, unit = self._query.scale, self._unit
        path = path or ("/query/pin" if self._query.width is None else "/query/width")
        known = f"There is no room for links {sizes.width / unit:.4g} {self._words} wide: {reason}."
        least = self._least_scale(sizes, scale)
        if least is None:
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
        factor = 2.0
        while factor <= LEAST_FACTOR and self._size * self._unit * scale * factor <= LARGEST_ASSEMBLY:
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


def _range(mechanism: Mechanism, design: Any, over: str | None) -> tuple[float, float, bool]:
    """The range of the input that the parts are for, and whether it is a whole cycle.

    Raises
    ------
    NotMade
        Where no motion leads through it.
    """
    slides = mechanism.driven_by_slide
    branch = branch_of(mechanism)
    metrics = design.metrics
    used = getattr(metrics, "used_stroke", None)
    if getattr(metrics, "used_range", None) is not None:
        used = tuple(math.radians(end) for end in metrics.used_range)
    turns = not slides and branch is not None and branch.full
    if over == "cycle" or (over is None and (turns or used is None)):
        used = cycle_along(mechanism, branch)
    if used is None:
        raise NotMade("No motion leads through the used range of this design.", "/query/over")
    low, high = sorted(used)
    inputs = np.linspace(low, high, DRIVEN + 2)[1:-1] if high > low else np.array([low])
    motion = LinkageMotion(mechanism, low, high, False)
    try:
        valid = motion.at(inputs).valid.all()
    except MechanismError as error:
        raise NotMade(f"The mechanism cannot be driven: {error}.") from None
    if not valid:
        raise NotMade("The mechanism cannot be assembled all over the motion.", "/query/over")
    turn = math.inf if slides else cycle(mechanism)
    return low, high, abs(high - low - turn) <= 1e-9 * turn


def _scaled(mechanism: Mechanism, factor: float) -> Mechanism:
    return Mechanism(
        {name: factor * z for name, z in mechanism.joints.items()},
        mechanism.links,
        mechanism.input,
        tuple(slide._replace(point=factor * slide.point) for slide in mechanism.slides),
        mechanism.gears,
        mechanism.turns,
    )


def _slots(motion: LinkageMotion) -> list[Slot]:
    """Where blocks run, from one end of their travel to the other."""
    mechanism = motion.mechanism
    if not mechanism.slides:
        return []
    driven = motion.at(motion.inputs(TRAVELLED))
    found = []
    for slide, name in zip(mechanism.slides, mechanism.slide_names, strict=True):
        places = driven.slides[name][0]
        # Between two inputs it goes farther by less than an eighth of the second difference.
        more = 0.25 * float(np.abs(np.diff(places, 2)).max()) if len(places) > 2 else 0.0
        direction = complex(np.exp(1j * slide.angle))
        point = complex(slide.point)
        ends = point + (float(places.min()) - more) * direction, point + (float(places.max()) + more) * direction
        found.append(Slot(slide.joint, slide.link, direction, ends))
    return found


def _named(part: str) -> str:
    return "the " + part.replace("_", " ")
