"""Planar Geneva drives as parts: wheel, crank with rollers, locking disc, shafts and bases.

An external wheel lies next to the locking disc in the first plane; the crank turns above both, and its rollers hang
into the slots. An internal wheel is a ring on a plate that turns on a shaft of the base. Its crank hangs from a second
base, with the rollers and the locking crescent below it, because nothing inside the ring can be supported by the first
base.

The answer may have no clearance between roller and slot, or between disc and locking arc. Here slots are at least as
wide as the roller with the clearance on each side, and the disc stays off the arcs by at least the clearance.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real
from kinematics.indexing.drag_link import CrankCourse
from kinematics.indexing.locking import Disc as LockingDisc
from kinematics.indexing.locking import build_disc
from kinematics.indexing.wheel import Wheel
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose
from service.parts.assembly.colours import BLOCK_COLOUR, LINK_COLOURS
from service.parts.assembly.descriptions import describe_identifier, describe_name
from service.parts.assembly.fit_sizes import Fitting, Trial, find_fault
from service.parts.assembly.model import Assembly, Carrier, Part, Placement
from service.parts.assembly.plate_stack import GROUND_CARRIER, PlateStack
from service.parts.assembly.sizes import (
    MILLIMETRES_PER_UNIT,
    MIN_WALL_PER_PIN,
    WIDTH_PER_PIN,
    NotMade,
    PartsQuery,
    Sizes,
)
from service.parts.cam.motion import ShaftMotion, make_rest_placement, make_rotation
from service.parts.geometry.regions import Disc, Loop, Outline, Region, make_ring, widen_hull
from synthesis.kinds.indexing.design import GenevaMechanism, IndexingDesign
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.mechanisms.geneva import build_drive

WHEEL_LINK, CRANK_LINK = "wheel", "crank"
ON_WHEEL, ON_CRANK = Carrier(WHEEL_LINK, None), Carrier(CRANK_LINK, None)
WHEEL_COLOUR, CRANK_COLOUR, DISC_COLOUR, ROLLER_COLOUR = LINK_COLOURS[1], LINK_COLOURS[0], LINK_COLOURS[5], BLOCK_COLOUR

MAX_PIN_PER_ROLLER = 0.4
"""Thickest default pin, in roller diameters."""

ARC_TOLERANCE = 1e-9
"""Share of the disc's radius within which a corner counts as lying on its locking arc."""


@dataclass(frozen=True)
class GenevaMotion(ShaftMotion):
    """Wheel and crank over a turn of the crank since a roller entered.

    Attributes
    ----------
    course : Course
    rollers : int
    axis : complex
        Axis of the crank; the wheel's is the origin.
    sense : float
        1 if the wheel turns in the crank's direction, −1 if against it.
    """

    course: CrankCourse
    rollers: int
    axis: complex
    sense: float

    def compute_placement(self, carrier: Carrier, state: Real) -> Placement:
        """Return the displacement of a carrier since the roller entered."""
        if carrier.link == GROUND:
            return make_rest_placement(state)
        if carrier.link == CRANK_LINK:
            return make_rotation(state, self.axis)
        return make_rotation(self.sense * self.course.wheel_motion(state, self.rollers).s)


def make_geneva_parts(design: IndexingDesign, problem: IndexingProblem, query: PartsQuery) -> Assembly:
    """Make the parts of a planar Geneva drive.

    Parameters
    ----------
    design : IndexingDesign
    problem : IndexingProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If a drag link drives the crank, or the parts do not fit.
    """
    mechanism = design.mechanism
    assert isinstance(mechanism, GenevaMechanism)
    if mechanism.drag_link is not None:
        raise NotMade(compose("parts-geneva-with-drag-link"))
    return _GenevaFitting(mechanism, problem, query).build_assembly()


class _GenevaFitting(Fitting):
    """One request for the parts of a Geneva drive."""

    def __init__(self, mechanism: GenevaMechanism, problem: IndexingProblem, query: PartsQuery) -> None:
        self._mechanism, self._problem = mechanism, problem
        reach = mechanism.center_distance + mechanism.crank_radius
        super().__init__(
            query, MILLIMETRES_PER_UNIT[problem.length_unit], max(reach, 2.0 * (mechanism.ring_radius or 0.0))
        )

    @property
    def max_pin(self) -> float:
        """Thickest default pin, as a share of the roller."""
        return MAX_PIN_PER_ROLLER * self._mechanism.roller_diameter

    def try_sizes(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in these sizes."""
        builder = _Builder(self._mechanism, self._problem, sizes, self._unit * scale)
        if builder.wheel.land <= 0.0 or not builder.wheel.web > 0.0:
            return Trial(None, compose("parts-slots-do-not-fit"))
        least, needed = builder.measure_shaft_clearance()
        if least < needed:
            return Trial(
                None,
                (
                    compose(
                        "parts-locking-disc-too-small",
                        reach=f"{least / self._unit:.4g}",
                        unit=self._words,
                        needed=f"{needed / self._unit:.4g}",
                    )
                ),
            )
        assembly = builder.build_assembly(scale)
        fault = find_fault(assembly, sizes)
        return Trial(None, fault) if fault else Trial(assembly, "")


class _Builder:
    """Makes the parts of a drive in given sizes; lengths in millimetres."""

    def __init__(self, mechanism: GenevaMechanism, problem: IndexingProblem, sizes: Sizes, factor: float) -> None:
        self._sizes, self._mechanism, self._factor = sizes, mechanism, factor
        self._internal = mechanism.type == "geneva_internal"
        self._course = build_drive(mechanism)
        self._roller = 0.5 * factor * mechanism.roller_diameter
        self.wheel = Wheel(
            self._internal,
            mechanism.stations,
            factor * mechanism.center_distance,
            factor * mechanism.wheel_radius,
            # Slots are at least a clearance wider than the roller on each side.
            max(0.5 * factor * mechanism.slot_width, self._roller + sizes.clearance),
            factor * mechanism.slot_end_radius,
            factor * mechanism.locking_arc_radius,
        )
        # The locking gap and the relief are at least the clearance.
        self._gap = max(factor * (mechanism.locking_arc_radius - mechanism.locking_radius), sizes.clearance)
        self._relief = max(factor * problem.relief, sizes.clearance)
        self._axis = complex(self.wheel.center_distance)
        self._wheel_shaft = factor * mechanism.bore or sizes.pin
        self._crank_shaft = factor * problem.crank_shaft_diameter or sizes.pin
        self._stack = PlateStack(sizes, (self._wheel_shaft, self._crank_shaft))
        # State as a roller enters: direction of the crank, and rotation of the wheel, one slot of which is along x in
        # its frame.
        sense = -1.0 if self._internal else 1.0
        self._way = -sense * cmath.exp(-1j * self._course.geneva.half)
        self._wheel_turn = cmath.exp(1j * sense * self.wheel.step)
        turns = [cmath.exp(2j * math.pi * n / mechanism.rollers) for n in range(mechanism.rollers)]
        crank = factor * mechanism.crank_radius
        self._rollers = [self._axis + self._way * crank * turn for turn in turns]

    def build_assembly(self, scale: float) -> Assembly:
        """Build the assembly of all parts."""
        parts, planes = (self._make_internal(), 3) if self._internal else (self._make_external(), 2)
        motion = GenevaMotion(
            self._measure_size(), self._course, self._mechanism.rollers, self._axis, 1.0 if self._internal else -1.0
        )
        notes = (compose("parts-geneva-input"),
                 compose("parts-geneva-keyed"))  # fmt: skip
        return Assembly(tuple(parts), motion, planes, 2 if self._internal else 1, self._factor, scale, notes)

    def _measure_size(self) -> float:
        ring_radius = self._factor * (self._mechanism.ring_radius or 0.0)
        return max(self.wheel.center_distance + self._factor * self._mechanism.crank_radius, 2.0 * ring_radius)

    def measure_shaft_clearance(self) -> tuple[float, float]:
        """Return the minimum reach of the locking disc from its axis, and the radius of its bore plus a wall."""
        if self._internal:
            return math.inf, 0.0
        return float(self._compute_locking().outer.min()), self._stack.measure_hub(
            self._crank_shaft
        ) + MIN_WALL_PER_PIN * self._sizes.pin

    def _make_bore(self, place: complex, diameter: float) -> Outline:
        return self._stack.make_bore(place, diameter)

    def _make_crank(self, plane: int) -> Part:
        """Make the arm of the crank; a plate with several corners for several rollers."""
        half = 0.5 * max(self._sizes.width, self._get_shaft_width(self._crank_shaft))
        shape = widen_hull([self._axis, *self._rollers], half)
        holes = [
            self._make_bore(self._axis, self._crank_shaft),
            *(Disc(z, 0.5 * self._sizes.hole) for z in self._rollers),
        ]
        holes += [Disc(z, 0.5 * self._sizes.hole) for z in self._place_crescent_pins()]
        if self._place_crescent_pins():
            shape = widen_hull([self._axis, *self._rollers, *self._place_crescent_pins()], half)
        return self._stack.make_plate(
            "crank",
            compose("parts-crank"),
            "link",
            ON_CRANK,
            Region(shape, tuple(holes)),
            plane,
            CRANK_COLOUR,
            self._way,
        )

    def _get_shaft_width(self, diameter: float) -> float:
        """Return the width of a plate around a shaft."""
        return self._sizes.width if diameter == self._sizes.pin else WIDTH_PER_PIN * diameter

    def _make_rollers(self, plane: int, crank: int) -> list[Part]:
        """Make the rollers and their pins."""
        parts, stack = [], self._stack
        for n, z in enumerate(self._rollers, 1):
            name = "roller" if len(self._rollers) == 1 else f"roller_{n}"
            region = make_ring(z, self._roller, 0.5 * self._sizes.hole)
            parts.append(
                stack.make_plate(name, describe_identifier(name), "block", ON_CRANK, region, plane, ROLLER_COLOUR)
            )
            parts += stack.make_pin(name, describe_identifier(f"pin_{name}"), ON_CRANK, z, (plane, crank))
            parts += stack.make_fillers(name, ON_CRANK, z, [(plane, crank)])
        return parts

    def _make_wheel_shaft(self, span: tuple[int, int], keyed: tuple[int, ...], stub: int) -> list[Part]:
        text = compose("parts-wheel-shaft")
        return self._stack.make_pin(
            "wheel", text, ON_WHEEL, 0j, span, diameter=self._wheel_shaft, keyed=keyed, stub=stub
        )

    def _make_crankshaft(self, span: tuple[int, int], keyed: tuple[int, ...], stub: int) -> list[Part]:
        text = compose("parts-crankshaft")
        return self._stack.make_pin(
            "crank", text, ON_CRANK, self._axis, span, diameter=self._crank_shaft, keyed=keyed, stub=stub
        )

    # A wheel next to the crank

    def _make_external(self) -> list[Part]:
        stack, sizes = self._stack, self._sizes
        wheel = Region(self._make_wheel_outline(), (self._make_bore(0j, self._wheel_shaft),))
        locking = Region(self._make_disc(), (self._make_bore(self._axis, self._crank_shaft),))
        parts = [
            stack.make_plate("wheel", compose("parts-wheel"), "link", ON_WHEEL, wheel, 1, WHEEL_COLOUR),
            stack.make_plate("locking_disc", compose("parts-locking-disc"), "link", ON_CRANK, locking, 1, DISC_COLOUR),
            self._make_crank(2),
            *self._make_rollers(1, 2),
            *self._make_wheel_shaft((0, 1), keyed=(1,), stub=-1),
            *self._make_crankshaft((0, 2), keyed=(1, 2), stub=-1),
        ]
        spans = [(0, 1)] if sizes.process != "print" else []
        parts += stack.make_fillers("wheel", ON_WHEEL, 0j, spans, self._wheel_shaft)
        parts += stack.make_fillers("crank", ON_CRANK, self._axis, [*spans, (1, 2)], self._crank_shaft)
        half = 0.5 * max(
            sizes.width, self._get_shaft_width(self._wheel_shaft), self._get_shaft_width(self._crank_shaft)
        )
        places = ((0j, self._wheel_shaft), (self._axis, self._crank_shaft))
        holes = [Disc(z, 0.5 * stack.get_sizes(diameter).hole) for z, diameter in places]
        bosses = [(z, diameter, 1) for z, diameter in places]
        return [*parts, stack.make_base("base", widen_hull([0j, self._axis], half), holes, bosses)]

    # A ring about the crank

    def _make_internal(self) -> list[Part]:
        stack, sizes = self._stack, self._sizes
        assert self._mechanism.ring_radius is not None
        outside = Disc(0j, self._factor * self._mechanism.ring_radius)
        dowels = self._place_dowels(outside.radius)
        holes = tuple(Disc(z, 0.5 * sizes.hole) for z in dowels)
        crescent = Region(self._make_crescent(), tuple(Disc(z, 0.5 * sizes.hole) for z in self._place_crescent_pins()))
        plate = Region(outside, (self._make_bore(0j, self._wheel_shaft), *holes))
        parts = [
            stack.make_plate("wheel_plate", compose("parts-wheel-plate"), "link", ON_WHEEL, plate, 1, LINK_COLOURS[6]),
            stack.make_plate(
                "wheel",
                compose("parts-wheel-ring"),
                "link",
                ON_WHEEL,
                Region(outside, (self._make_wheel_outline(), *holes)),
                2,
                WHEEL_COLOUR,
            ),
            stack.make_plate("crescent", compose("parts-locking-crescent"), "link", ON_CRANK, crescent, 2, DISC_COLOUR),
            self._make_crank(3),
            *self._make_rollers(2, 3),
            *self._make_wheel_shaft((0, 1), keyed=(1,), stub=-1),
            *self._make_crankshaft((3, 4), keyed=(3,), stub=1),
        ]
        for n, z in enumerate(dowels, 1):
            parts += stack.make_pin(f"dowel_{n}", compose("parts-dowel-pin", number=n), ON_WHEEL, z, (1, 2))
            parts += stack.make_fillers(f"dowel_{n}", ON_WHEEL, z, [(1, 2)])
        for n, z in enumerate(self._place_crescent_pins(), 1):
            parts += stack.make_pin(f"crescent_{n}", compose("parts-crescent-pin", number=n), ON_CRANK, z, (2, 3))
            parts += stack.make_fillers(f"crescent_{n}", ON_CRANK, z, [(2, 3)])
        if sizes.process != "print":
            parts += stack.make_fillers("wheel", ON_WHEEL, 0j, [(0, 1)], self._wheel_shaft)
            parts += stack.make_fillers("crank", ON_CRANK, self._axis, [(3, 4)], self._crank_shaft)
        return parts + self._make_bases(outside.radius)

    def _make_bases(self, radius: float) -> list[Part]:
        """Make both bases, and posts around the ring."""
        stack, sizes = self._stack, self._sizes
        # Posts stay outside the ring at all positions.
        far = radius + 0.5 * sizes.collar + 2.0 * sizes.min_gap
        posts = [far * cmath.exp(0.25j * math.pi * (2 * n + 1)) for n in range(4)]
        parts: list[Part] = []
        for n, z in enumerate(posts, 1):
            parts += stack.make_pin(f"post_{n}", describe_name(f"post {n}"), GROUND_CARRIER, z, (0, 4))
            parts += stack.make_fillers(f"post_{n}", GROUND_CARRIER, z, [(0, 4)])
        outer = widen_hull([*posts, self._axis], 0.5 * sizes.width)
        held = [Disc(z, 0.5 * sizes.hole) for z in posts]
        below = Disc(0j, 0.5 * stack.get_sizes(self._wheel_shaft).hole)
        above = Disc(self._axis, 0.5 * stack.get_sizes(self._crank_shaft).hole)
        return [
            *parts,
            stack.make_base("base", outer, [below, *held], [(0j, self._wheel_shaft, 1)]),
            stack.make_base("second_base", outer, [above, *held], [(self._axis, self._crank_shaft, 3)], plane=4),
        ]

    def _place_dowels(self, outside: float) -> list[complex]:
        """Return the places of the pins that hold the ring to its plate: outside the locking arcs, at most four."""
        n = self._mechanism.stations
        middle = 0.5 * (self.wheel.center_distance + self.wheel.lock + outside)
        # Four dowels suffice for any number of stations.
        chosen = range(n) if n <= 4 else [round(k * n / 4) for k in range(4)]
        return [middle * self._wheel_turn * cmath.exp(1j * self.wheel.step * (2 * k + 1)) for k in chosen]

    def _place_crescent_pins(self) -> list[complex]:
        """Return the places of the pins that hold the crescent below the crank."""
        if not self._internal:
            return []
        found = self._compute_locking()
        # Pins are placed midway between the two edges of the crescent.
        middle = 0.5 * (found.outer + found.inner)
        return [
            self._axis + self._way * complex(middle[k] * np.exp(1j * found.angle[k]))
            for k in (len(middle) // 4, (3 * len(middle)) // 4)
        ]

    # Outlines

    def _make_wheel_outline(self) -> Loop:
        """Return the wheel, or the cut-out of a ring, by its true lines and arcs, as a roller enters."""
        wheel, side = self.wheel, -1.0 if not self._internal else 1.0
        mouth = cmath.rect(wheel.reach, wheel.mouth)
        corner = cmath.rect(wheel.reach, wheel.step - wheel.lock_half)
        end = complex(wheel.slot_end, wheel.half_slot)
        centre = cmath.rect(wheel.center_distance, wheel.step)
        # Corner of the next sector, where the locking arc ends.
        following = corner.conjugate() * cmath.exp(2j * wheel.step)
        swept = cmath.phase((following - centre) / (corner - centre)) % (2.0 * math.pi)
        # The locking arc is concave on an external wheel and convex in a ring.
        arc = math.tan(0.25 * swept) if self._internal else -math.tan(0.25 * (2.0 * math.pi - swept))
        land = math.tan(0.25 * wheel.land)
        sector = (corner.conjugate(), mouth.conjugate(), end.conjugate(), end, mouth, corner)
        corners, bulges = [], []
        for n in range(wheel.stations):
            turn = self._wheel_turn * cmath.exp(2j * wheel.step * n)
            corners += [turn * z for z in sector]
            bulges += [land, 0.0, side, 0.0, land, arc]
        return Loop(tuple(corners), tuple(bulges))

    def _compute_locking(self) -> LockingDisc:
        """Return the disc or crescent in the crank's frame."""
        return build_disc(self.wheel, self._course.geneva, self._mechanism.rollers, self._gap, self._relief)

    def _make_disc(self) -> Loop:
        """Return the locking disc: true arcs, and between them the curve that the passing wheel leaves, as chords."""
        found = self._compute_locking()
        return self._trace_locking(found.angle, found.outer, closed=True)

    def _make_crescent(self) -> Loop:
        """Return the crescent: its arc, and inside the curve that the passing horns leave."""
        found = self._compute_locking()
        arc = self._trace_locking(found.angle, found.outer, closed=False)
        inner = self._axis + self._way * found.inner * np.exp(1j * found.angle)
        back = inner[::-1].tolist()
        return Loop((*arc.corners, *back), (*arc.bulges, *([0.0] * len(back))))

    def _trace_locking(self, angle: Real, radius: Real, *, closed: bool) -> Loop:
        """Return corners about the crank's axis; those on the maximum radius are joined by one arc, others by lines."""
        arc = float(radius.max())
        on = radius >= arc * (1.0 - ARC_TOLERANCE)
        count = len(angle)
        corners: list[complex] = []
        bulges: list[float] = []
        k = 0
        while k < count:
            last = k
            while on[k] and last + 1 < count and on[last + 1]:
                last += 1
            z = self._axis + self._way * cmath.rect(float(radius[k]), float(angle[k]))
            # Divide a run along the arc, so that no arc exceeds half a turn.
            pieces = max(1, math.ceil((angle[last] - angle[k]) / (0.5 * math.pi))) if last > k else 0
            step = (angle[last] - angle[k]) / pieces if pieces else 0.0
            corners.append(z)
            for _ in range(pieces):
                bulges.append(math.tan(0.25 * step))
                corners.append(self._axis + (corners[-1] - self._axis) * cmath.exp(1j * step))
            bulges.append(0.0)
            k = last + 1
        if closed and on[0] and on[-1]:
            bulges[-1] = math.tan(0.25 * float((angle[0] - angle[-1]) % (2.0 * math.pi)))
        if not closed:
            bulges[-1] = 0.0
        return Loop(tuple(corners), tuple(bulges))
