"""Assembly of a linkage design: planes for given sizes, and a check of all parts in motion.

The planes of :mod:`kinematics.linkage.layout` are assigned with all parts on a pin taken as wide as its collar, so that
washers, heads and rings fit, too. The result is then checked by :mod:`service.parts.assembly.interference`, which does
not know the planes; an assembly with interference is rejected.

If no planes can separate the parts of a mechanism, however thin its links are, one link is divided: two plates on one
shaft, on either side of a base.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from typing import Literal

import numpy as np

from kinematics.errors import MechanismError
from kinematics.linkage.layout import Division, arrange_divided, arrange_planes, list_divisions
from kinematics.linkage.planar.limits import find_cycle_from_reference
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from kinematics.message import compose
from service.parts.assembly.descriptions import describe_name
from service.parts.assembly.fit_sizes import (
    NARROW_FOR_BLOCKS,
    NARROW_FOR_PINS,
    NARROW_FOR_SHAFTS,
    Fitting,
    Trial,
    find_fault,
)
from service.parts.assembly.model import Assembly
from service.parts.assembly.sizes import MAX_PIN, MILLIMETRES_PER_UNIT, MIN_PIN, NotMade, PartsQuery, Sizes
from service.parts.gears.sizing import MAX_TOOTH_PLAY
from service.parts.linkage.builder import Planes, Slot, build_assembly, measure_keyway_reach
from service.parts.linkage.gears import make_pair_wheels
from service.parts.linkage.motion import LinkageMotion
from synthesis.analyses.linkages.cycle import find_built_range, get_used_range
from synthesis.model.design_interface import AnyDesign
from synthesis.model.problem import ProblemBase
from synthesis.verification.reconstruction import rebuild_mechanism

DRIVE_INPUTS = 181
"""Number of inputs at which the mechanism is tested for driving through the motion."""

TRAVEL_INPUTS = 2881
"""Number of inputs at which the travel of blocks in their slots is measured."""

MAX_PIN_PER_SIZE, MAX_PIN_PER_LINK = 0.04, 0.35
"""Thickest default pin as a share of the mechanism's size, and of its shortest link."""

MIN_WIDTH_SHARE = 1e-4
"""Width of links that are practically infinitely thin, as a share of the mechanism's size. Links on the thinnest pins
in the largest assembly are hardly thinner.
"""

Shafts = Literal["one_side", "both_sides"]


def make_linkage_parts(design: AnyDesign, problem: ProblemBase, query: PartsQuery) -> Assembly:
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
        If the mechanism cannot be driven, no gears have its ratio, or the parts do not fit.
    """
    linkage = _LinkageFitting(design, problem, query)
    ways = linkage.find_divisions()
    if not ways:
        return linkage.build_assembly()
    if query.shafts is not None:
        link = ways[0].link
        raise NotMade(
            compose("parts-needs-divided-link", link=link), "/query/shafts",
        )  # fmt: skip
    return _DividedLinkageFitting(design, problem, query, ways).build_assembly()


class _LinkageFitting(Fitting):
    """One request: a mechanism, and the options of its parts."""

    def __init__(self, design: AnyDesign, problem: ProblemBase, query: PartsQuery) -> None:
        mechanism = rebuild_mechanism(design.mechanism, from_skeleton=True)
        if mechanism is None:
            raise NotMade(compose("parts-does-not-assemble"))
        if len(mechanism.gears) > 1 or any(gear.first != mechanism.input for gear in mechanism.gears):
            raise NotMade(compose("parts-too-many-gear-pairs"))
        self._mechanism = mechanism
        self._block = getattr(problem, "layout", None)
        over = query.over or getattr(self._block, "over", None)
        self._low, self._high, self._closed = _find_range(mechanism, design, over)
        places = [complex(z) for z in mechanism.joints.values()]
        size = max(abs(z - w) for z, w in combinations(places, 2))
        super().__init__(query, MILLIMETRES_PER_UNIT[problem.length_unit], size)

    def find_divisions(self) -> list[Division]:
        """Return the divisions of a link with which the mechanism can be built, if it cannot be built undivided."""
        ways = list_divisions(self._mechanism)
        if not ways:
            return []
        # Practically infinitely thin links show whether any arrangement exists.
        width = MIN_WIDTH_SHARE * self._size
        pin, gap = 0.5 * width, 0.1 * width
        mechanism, low, high = self._mechanism, self._low, self._high
        try:
            for through in (False, True):
                whole = arrange_planes(
                    mechanism, low, high, link_width=width, pin_diameter=pin, gap=gap, through=through, whole=True
                )
                if not whole.clashes:
                    return []
            return [
                way
                for way in ways
                if not arrange_divided(mechanism, low, high, way, link_width=width, pin_diameter=pin, gap=gap).clashes
            ]
        except MechanismError:
            return []

    # Sizes

    @property
    def max_pin(self) -> float:
        """Thickest default pin, from shares of the mechanism's size and of its shortest link."""
        return min(MAX_PIN_PER_SIZE * self._size, MAX_PIN_PER_LINK * self._find_shortest([*self._mechanism.links]))

    def _find_shortest(self, links: Sequence[str]) -> float:
        """Return the minimum distance of two joints of a link."""
        at = {name: complex(z) for name, z in self._mechanism.joints.items()}
        pairs = (pair for link in links for pair in combinations(self._mechanism.links[link], 2))
        lengths = (abs(at[one] - at[other]) for one, other in pairs)
        return min((length for length in lengths if length > 1e-9 * self._size), default=self._size)

    def find_opening(self, sizes: Sizes) -> tuple[float, str]:
        """Return the widest opening: slots are wider than holes."""
        if self._mechanism.slides:
            return sizes.block[1] + 2.0 * sizes.clearance, NARROW_FOR_BLOCKS
        if self._mechanism.gears:
            return 2.0 * measure_keyway_reach(sizes), NARROW_FOR_SHAFTS
        return sizes.hole, NARROW_FOR_PINS

    def list_problem_sizes(self) -> Iterator[Sizes]:
        """Yield the sizes of the problem's block, if they are consistent."""
        block, factor = self._block, self._unit
        if block is not None:
            pin, width = block.pin_diameter * factor, block.link_width * factor
            sizes = self._with(width, pin)
            if self._query.thickness is None:
                sizes = replace(sizes, thickness=block.thickness * factor)
            try:
                self._check_sizes(sizes)
            except NotMade:
                pass
            else:
                if MIN_PIN <= pin <= MAX_PIN:
                    yield sizes

    # Assemblies

    def try_sizes(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in these sizes, with the first choice of bases that works."""
        reasons = []
        for shafts in self._list_shaft_options():
            trial = self._try_shafts(sizes, scale, shafts)
            if trial.assembly is not None:
                return trial
            reasons.append(trial.reason)
        if len(reasons) == 1:
            return Trial(None, reasons[0])
        one_base, two_bases = reasons
        return Trial(None, compose("parts-fits-on-neither-bases", one=one_base, two=two_bases))

    def _list_shaft_options(self) -> tuple[Shafts, ...]:
        requested = self._query.shafts or getattr(self._block, "shafts", None)
        return ("one_side", "both_sides") if requested is None else (requested,)

    def _try_shafts(self, sizes: Sizes, scale: float, shafts: Shafts) -> Trial:
        factor = self._unit * scale
        mechanism = _scale_mechanism(self._mechanism, factor)
        larger = factor if mechanism.has_slide_input else 1.0
        wheels = [wheel for pair in mechanism.gears for wheel in make_pair_wheels(mechanism, pair)]
        module = max((wheel.gear.module for wheel in wheels), default=0.0)
        if wheels and sizes.clearance > MAX_TOOTH_PLAY * module:
            return Trial(None, compose("parts-clearance-exceeds-tooth-play", share=f"{MAX_TOOTH_PLAY:g}"))
        idlers = {wheel.name: (wheel.centre, wheel.speed) for wheel in wheels if wheel.joint is None}
        motion = LinkageMotion(mechanism, larger * self._low, larger * self._high, self._closed, idlers)
        length, width = sizes.block
        try:
            layout = arrange_planes(
                mechanism,
                motion.low,
                motion.high,
                link_width=sizes.width,
                pin_diameter=sizes.collar,
                gap=sizes.min_gap,
                through=shafts == "both_sides",
                closed=motion.closed,
                slot_ends=0.5 * (length - width),
                addendum=module,
                whole=True,
            )
        except MechanismError as error:
            return Trial(None, str(error))
        if layout.clashes:
            return Trial(None, self._describe_clash(layout.clashes[0].parts, layout.clashes[0].at))
        # A second base lies above all planes, if any pin reaches that high.
        above = max(layout.planes.values()) + 1
        bases = (0, above) if any(high == above for _, high in layout.pins.values()) else (0,)
        planes = Planes(layout.planes, layout.pins, bases)
        assembly = build_assembly(motion, planes, _find_slots(motion), wheels, sizes, factor, scale)
        return _check_assembly(assembly, sizes)

    def _describe_clash(self, parts: tuple[str, str], at: float) -> str:
        one, other = (describe_name(part) for part in parts)
        if self._mechanism.has_slide_input:
            return compose("parts-not-separated-at-place", first=one, second=other, place=f"{at:.4g}")
        return compose("parts-not-separated-at-angle", first=one, second=other, angle=f"{math.degrees(at):.1f}")


class _DividedLinkageFitting(_LinkageFitting):
    """A linkage with one link divided into two plates on either side of a base, in one of several ways."""

    def __init__(self, design: AnyDesign, problem: ProblemBase, query: PartsQuery, ways: Sequence[Division]) -> None:
        super().__init__(design, problem, query)
        self._ways = ways

    @property
    def max_pin(self) -> float:
        """Thickest default pin; only moving links count, because close fixed pivots are not in one base."""
        moving = [link for link in self._mechanism.links if link != GROUND]
        return min(MAX_PIN_PER_SIZE * self._size, MAX_PIN_PER_LINK * self._find_shortest(moving))

    def find_opening(self, sizes: Sizes) -> tuple[float, str]:
        """Return the widest opening: slots of slides, or keyways."""
        return max(super().find_opening(sizes), (2.0 * measure_keyway_reach(sizes), NARROW_FOR_SHAFTS))

    def try_sizes(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in these sizes, in the first way that works."""
        trials = []
        for way in self._ways:
            trial = self._try_division(way, sizes, scale)
            if trial.assembly is not None:
                return trial
            trials.append(trial)
        return trials[0]

    def _try_division(self, way: Division, sizes: Sizes, scale: float) -> Trial:
        factor = self._unit * scale
        mechanism = _scale_mechanism(self._mechanism, factor)
        larger = factor if mechanism.has_slide_input else 1.0
        motion = LinkageMotion(mechanism, larger * self._low, larger * self._high, self._closed)
        length, width = sizes.block
        try:
            layout = arrange_divided(
                mechanism,
                motion.low,
                motion.high,
                way,
                link_width=sizes.width,
                pin_diameter=sizes.collar,
                gap=sizes.min_gap,
                slot_ends=0.5 * (length - width),
            )
        except MechanismError as error:
            return Trial(None, str(error))
        if layout.clashes:
            return Trial(None, self._describe_clash(layout.clashes[0].parts, layout.clashes[0].at))
        planes = Planes(layout.planes, layout.pins, (0, layout.base), way)
        return _check_assembly(build_assembly(motion, planes, _find_slots(motion), (), sizes, factor, scale), sizes)


def _check_assembly(assembly: Assembly, sizes: Sizes) -> Trial:
    """Return the assembly, or the reason why it cannot be made."""
    fault = find_fault(assembly, sizes)
    return Trial(None, fault) if fault else Trial(assembly, "")


def _find_range(
    mechanism: Mechanism, design: AnyDesign, over: Literal["used", "cycle"] | None
) -> tuple[float, float, bool]:
    """Return the range of the input for which the parts are made, and whether it is a full cycle.

    Raises
    ------
    NotMade
        If the mechanism cannot move through the range.
    """
    used = find_built_range(mechanism, get_used_range(design.metrics), over)
    if used is None:
        raise NotMade(compose("parts-used-range-impossible"), "/query/over")
    low, high = used
    # The ends may be toggles: test the interior only.
    inputs = np.linspace(low, high, DRIVE_INPUTS + 2)[1:-1] if high > low else np.array([low])
    motion = LinkageMotion(mechanism, low, high, False)
    try:
        valid = motion.compute_state(inputs).valid.all()
    except MechanismError as error:
        raise NotMade(compose("parts-cannot-be-driven", reason=str(error))) from None
    if not valid:
        raise NotMade(compose("parts-not-assembled-over-motion"), "/query/over")
    turn = math.inf if mechanism.has_slide_input else find_cycle_from_reference(mechanism)
    return low, high, abs(high - low - turn) <= 1e-9 * turn


def _scale_mechanism(mechanism: Mechanism, factor: float) -> Mechanism:
    return Mechanism(
        {name: factor * z for name, z in mechanism.joints.items()},
        mechanism.links,
        mechanism.input,
        tuple(slide._replace(point=factor * slide.point) for slide in mechanism.slides),
        mechanism.gears,
        mechanism.turns,
    )


def _find_slots(motion: LinkageMotion) -> list[Slot]:
    """Return the slots of blocks, from one end of their travel to the other."""
    mechanism = motion.mechanism
    if not mechanism.slides:
        return []
    driven = motion.compute_state(motion.sample_inputs(TRAVEL_INPUTS))
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
