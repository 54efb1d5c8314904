"""Assembly of a linkage design: planes for given sizes, and a check of all parts in motion.

The planes of :mod:`kinematics.linkage.layout` are assigned with all parts on a pin taken as wide as its collar, so that
washers, heads and rings fit, too. The result is then checked by :mod:`service.parts.overlaps`, which does not know the
planes; an assembly with interference is rejected.

If no planes can separate the parts of a mechanism, however thin its links are, one link is divided: two plates on one
shaft, on either side of a base.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from typing import Any, Literal

import numpy as np

from kinematics.errors import MechanismError
from kinematics.linkage.layout import Division, divisions, laid_out, laid_out_divided
from kinematics.linkage.planar.limits import cycle_from_reference
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from service.parts.building import Planes, Slot, assembled, keyway_reach
from service.parts.fitting import Fitting, Trial, fault_of
from service.parts.geared import pair_wheels
from service.parts.gears.sizing import MOST_PLAY
from service.parts.linkage_motion import LinkageMotion
from service.parts.model import Assembly
from service.parts.sizes import MILLIMETRES, THINNEST_PIN, WIDEST_PIN, NotMade, PartsQuery, Sizes
from synthesis.analyses.cycle import branch_of, cycle_along
from synthesis.proof.rebuilt import rebuilt

DRIVEN = 181
"""Number of inputs at which the mechanism is tested for driving through the motion."""

TRAVELLED = 2881
"""Number of inputs at which the travel of blocks in their slots is measured."""

PIN_SHARE, PIN_OF_LINK = 0.04, 0.35
"""Thickest default pin as a share of the mechanism's size, and of its shortest link."""

THINNEST = 1e-4
"""Width of practically infinitely thin links, as a share of the mechanism's size: links on the thinnest pins in the
largest assembly are hardly thinner.
"""

Shafts = Literal["one_side", "both_sides"]


def linkage_parts(design: Any, problem: Any, query: PartsQuery) -> Assembly:
    """Make the parts of a linkage of pins and slides.

    Parameters
    ----------
    design : LinkageDesign
    problem : LinkageProblem
        Its block ``layout`` provides values that the request omits.
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        The mechanism cannot be driven, no gears have its ratio, or the parts do not fit.
    """
    linkage = _Linkage(design, problem, query)
    ways = linkage.divisions()
    if not ways:
        return linkage.assembly()
    if query.shafts is not None:
        link = ways[0].link
        raise NotMade(
            "The mechanism cannot be built in planes with shafts on one base, nor between two. Omit `shafts`: then "
            "its link "
            f"{link} is divided into two plates on one shaft, on either side of the second base.", "/query/shafts",
        )  # fmt: skip
    return _Divided(design, problem, query, ways).assembly()


class _Linkage(Fitting):
    """One request: a mechanism, and the options of its parts."""

    def __init__(self, design: Any, problem: Any, query: PartsQuery) -> None:
        mechanism = rebuilt(design.mechanism, from_skeleton=True)
        if mechanism is None:
            raise NotMade("The dimensions of this design do not assemble to a mechanism.")
        if len(mechanism.gears) > 1 or any(gear.first != mechanism.input for gear in mechanism.gears):
            raise NotMade("Parts are available for linkages with at most one gear pair, which the input must drive.")
        self._mechanism = mechanism
        self._block = getattr(problem, "layout", None)
        over = query.over or getattr(self._block, "over", None)
        self._low, self._high, self._closed = _range(mechanism, design, over)
        places = [complex(z) for z in mechanism.joints.values()]
        size = max(abs(z - w) for z, w in combinations(places, 2))
        super().__init__(query, MILLIMETRES[problem.length_unit], size)

    def divisions(self) -> list[Division]:
        """Return the divisions of a link with which the mechanism can be built, if it cannot be built undivided."""
        ways = divisions(self._mechanism)
        if not ways:
            return []
        # Practically infinitely thin links show whether any arrangement exists.
        width = THINNEST * self._size
        pin, gap = 0.5 * width, 0.1 * width
        mechanism, low, high = self._mechanism, self._low, self._high
        try:
            for through in (False, True):
                whole = laid_out(
                    mechanism, low, high, link_width=width, pin_diameter=pin, gap=gap, through=through, whole=True
                )
                if not whole.clashes:
                    return []
            return [
                way
                for way in ways
                if not laid_out_divided(mechanism, low, high, way, link_width=width, pin_diameter=pin, gap=gap).clashes
            ]
        except MechanismError:
            return []

    # Sizes

    @property
    def most(self) -> float:
        """Thickest default pin, from shares of the mechanism's size and of its shortest link."""
        return min(PIN_SHARE * self._size, PIN_OF_LINK * self._shortest([*self._mechanism.links]))

    def _shortest(self, links: Sequence[str]) -> float:
        """Return the minimum distance of two joints of a link."""
        at = {name: complex(z) for name, z in self._mechanism.joints.items()}
        pairs = (pair for link in links for pair in combinations(self._mechanism.links[link], 2))
        lengths = (abs(at[one] - at[other]) for one, other in pairs)
        return min((length for length in lengths if length > 1e-9 * self._size), default=self._size)

    def opening(self, sizes: Sizes) -> tuple[float, str]:
        """Return the widest opening: slots are wider than holes."""
        if self._mechanism.slides:
            return sizes.block[1] + 2.0 * sizes.clearance, "blocks on pins"
        if self._mechanism.gears:
            return 2.0 * keyway_reach(sizes), "keyed shafts"
        return sizes.hole, "pins"

    def of_the_problem(self) -> Iterator[Sizes]:
        """Yield the sizes of the problem's block, if they are consistent."""
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

    def tried(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in these sizes, with the first choice of bases that works."""
        reason = ""
        for shafts in self._shafts():
            trial = self._tried(sizes, scale, shafts)
            if trial.assembly is not None:
                return trial
            reason = "; with two bases: ".join(filter(None, (reason, trial.reason)))
        return Trial(None, reason)

    def _shafts(self) -> tuple[Shafts, ...]:
        stated = self._query.shafts or getattr(self._block, "shafts", None)
        return ("one_side", "both_sides") if stated is None else (stated,)

    def _tried(self, sizes: Sizes, scale: float, shafts: Shafts) -> Trial:
        factor = self._unit * scale
        mechanism = _scaled(self._mechanism, factor)
        larger = factor if mechanism.driven_by_slide else 1.0
        wheels = [wheel for pair in mechanism.gears for wheel in pair_wheels(mechanism, pair)]
        module = max((wheel.gear.module for wheel in wheels), default=0.0)
        if wheels and sizes.clearance > MOST_PLAY * module:
            return Trial(None, f"the clearance, also the play of the teeth, exceeds {MOST_PLAY:g} of their module")
        idlers = {wheel.name: (wheel.centre, wheel.speed) for wheel in wheels if wheel.joint is None}
        motion = LinkageMotion(mechanism, larger * self._low, larger * self._high, self._closed, idlers)
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
                addendum=module,
                whole=True,
            )
        except MechanismError as error:
            return Trial(None, str(error))
        if layout.clashes:
            return Trial(None, self._clashing(layout.clashes[0].parts, layout.clashes[0].at))
        # A second base lies above all planes, if any pin reaches that high.
        above = max(layout.planes.values()) + 1
        bases = (0, above) if any(high == above for _, high in layout.pins.values()) else (0,)
        planes = Planes(layout.planes, layout.pins, bases)
        assembly = assembled(motion, planes, _slots(motion), wheels, sizes, factor, scale)
        return _looked_at(assembly, sizes)

    def _clashing(self, parts: tuple[str, str], at: float) -> str:
        one, other = parts
        return f"no arrangement in planes separates {one} and {other} at {self._input(at)}"

    def _input(self, at: float) -> str:
        if self._mechanism.driven_by_slide:
            return f"the input's place {at:.4g}"
        return f"an input angle of {math.degrees(at):.1f}°"


class _Divided(_Linkage):
    """A linkage with one link divided into two plates on either side of a base, in one of several ways."""

    def __init__(self, design: Any, problem: Any, query: PartsQuery, ways: Sequence[Division]) -> None:
        super().__init__(design, problem, query)
        self._ways = ways

    @property
    def most(self) -> float:
        """Thickest default pin; only moving links count, because close fixed pivots are not in one base."""
        moving = [link for link in self._mechanism.links if link != GROUND]
        return min(PIN_SHARE * self._size, PIN_OF_LINK * self._shortest(moving))

    def opening(self, sizes: Sizes) -> tuple[float, str]:
        """Return the widest opening: slots of slides, or keyways."""
        return max(super().opening(sizes), (2.0 * keyway_reach(sizes), "keyed shafts"))

    def tried(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in these sizes, in the first way that works."""
        trials = []
        for way in self._ways:
            trial = self._in(way, sizes, scale)
            if trial.assembly is not None:
                return trial
            trials.append(trial)
        return trials[0]

    def _in(self, way: Division, sizes: Sizes, scale: float) -> Trial:
        factor = self._unit * scale
        mechanism = _scaled(self._mechanism, factor)
        larger = factor if mechanism.driven_by_slide else 1.0
        motion = LinkageMotion(mechanism, larger * self._low, larger * self._high, self._closed)
        length, width = sizes.block
        try:
            layout = laid_out_divided(
                mechanism,
                motion.low,
                motion.high,
                way,
                link_width=sizes.width,
                pin_diameter=sizes.collar,
                gap=sizes.apart,
                slot_ends=0.5 * (length - width),
            )
        except MechanismError as error:
            return Trial(None, str(error))
        if layout.clashes:
            return Trial(None, self._clashing(layout.clashes[0].parts, layout.clashes[0].at))
        planes = Planes(layout.planes, layout.pins, (0, layout.base), way)
        return _looked_at(assembled(motion, planes, _slots(motion), (), sizes, factor, scale), sizes)


def _looked_at(assembly: Assembly, sizes: Sizes) -> Trial:
    """Return the assembly, or the reason why it cannot be made."""
    fault = fault_of(assembly, sizes)
    return Trial(None, fault) if fault else Trial(assembly, "")


def _range(mechanism: Mechanism, design: Any, over: str | None) -> tuple[float, float, bool]:
    """Return the range of the input for which the parts are made, and whether it is a full cycle.

    Raises
    ------
    NotMade
        The mechanism cannot move through the range.
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
        raise NotMade("The mechanism cannot move through the used range of this design.", "/query/over")
    low, high = sorted(used)
    # The ends may be toggles: test the interior only.
    inputs = np.linspace(low, high, DRIVEN + 2)[1:-1] if high > low else np.array([low])
    motion = LinkageMotion(mechanism, low, high, False)
    try:
        valid = motion.at(inputs).valid.all()
    except MechanismError as error:
        raise NotMade(f"The mechanism cannot be driven: {error}.") from None
    if not valid:
        raise NotMade("The mechanism cannot be assembled over the whole motion.", "/query/over")
    turn = math.inf if slides else cycle_from_reference(mechanism)
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
    """Return the slots of blocks, from one end of their travel to the other."""
    mechanism = motion.mechanism
    if not mechanism.slides:
        return []
    driven = motion.at(motion.inputs(TRAVELLED))
    found = []
    for slide, name in zip(mechanism.slides, mechanism.slide_names, strict=True):
        # Positions of the block along its slide.
        places = driven.slides[name][0]
        # Between two inputs a block goes beyond the samples by less than an eighth of the second difference.
        more = 0.25 * float(np.abs(np.diff(places, 2)).max()) if len(places) > 2 else 0.0
        direction = complex(np.exp(1j * slide.angle))
        point = complex(slide.point)
        ends = point + (float(places.min()) - more) * direction, point + (float(places.max()) + more) * direction
        found.append(Slot(slide.joint, slide.link, direction, ends))
    return found
