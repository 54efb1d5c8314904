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
from typing import Any

import numpy as np

from kinematics.indexing.drag_link import Course
from kinematics.indexing.locking import disc
from kinematics.indexing.wheel import Wheel
from kinematics.linkage.planar.mechanism import GROUND
from service.parts.cam_motion import Turning, still, turned
from service.parts.colours import BLOCK_COLOUR, LINK_COLOURS
from service.parts.fitting import Fitting, Trial, fault_of
from service.parts.model import Assembly, Carrier, Part, Placed, Real
from service.parts.shapes import Disc, Loop, Outline, Region, ring, widened
from service.parts.sizes import MILLIMETRES, WALL, WIDTH, NotMade, PartsQuery, Sizes
from service.parts.stack import STILL, Stack
from synthesis.kinds.indexing.design import GenevaMechanism
from synthesis.mechanisms.geneva import course_of

WHEEL, CRANK = "wheel", "crank"
ON_WHEEL, ON_CRANK = Carrier(WHEEL, None), Carrier(CRANK, None)
WHEEL_COLOUR, CRANK_COLOUR, DISC_COLOUR, ROLLER_COLOUR = LINK_COLOURS[1], LINK_COLOURS[0], LINK_COLOURS[5], BLOCK_COLOUR

PIN_OF_ROLLER = 0.4
"""Thickest default pin, in roller diameters."""

ON_ARC = 1e-9
"""Share of the disc's radius within which a corner counts as lying on its locking arc."""


@dataclass(frozen=True)
class GenevaMotion(Turning):
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

    course: Course
    rollers: int
    axis: complex
    sense: float

    def placed(self, carrier: Carrier, state: Real) -> Placed:
        """Return the displacement of a carrier since the roller entered."""
        if carrier.link == GROUND:
            return still(state)
        if carrier.link == CRANK:
            return turned(state, self.axis)
        return turned(self.sense * self.course.turned(state, self.rollers).s)


def geneva_parts(design: Any, problem: Any, query: PartsQuery) -> Assembly:
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
        A drag link drives the crank, or the parts do not fit.
    """
    if design.mechanism.drag_link is not None:
        raise NotMade(
            "Parts are only available for Geneva drives whose crank is the input; the coupler of this drag link would "
            "collide with the shafts on both sides."
        )
    return _Geneva(design.mechanism, problem, query).assembly()


class _Geneva(Fitting):
    """One request for the parts of a Geneva drive."""

    def __init__(self, mechanism: GenevaMechanism, problem: Any, query: PartsQuery) -> None:
        self._mechanism, self._problem = mechanism, problem
        reach = mechanism.center_distance + mechanism.crank_radius
        super().__init__(query, MILLIMETRES[problem.length_unit], max(reach, 2.0 * (mechanism.ring_radius or 0.0)))

    @property
    def most(self) -> float:
        """Thickest default pin, as a share of the roller."""
        return PIN_OF_ROLLER * self._mechanism.roller_diameter

    def tried(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in these sizes."""
        builder = _Builder(self._mechanism, self._problem, sizes, self._unit * scale)
        if builder.wheel.land <= 0.0 or not builder.wheel.web > 0.0:
            return Trial(None, "slots with this clearance do not fit into the wheel")
        least, needed = builder.about_shaft()
        if least < needed:
            return Trial(None, (
                f"the locking disc reaches {least / self._unit:.4g} {self._words} from its axis where the wheel passes "
                f"it, but the bore for the crankshaft with its key needs {needed / self._unit:.4g}; use a thinner "
                "crankshaft or a larger center distance"
            ))  # fmt: skip
        assembly = builder.assembled(scale)
        fault = fault_of(assembly, sizes)
        return Trial(None, fault) if fault else Trial(assembly, "")


class _Builder:
    """Makes the parts of a drive in given sizes; lengths in millimetres."""

    def __init__(self, mechanism: GenevaMechanism, problem: Any, sizes: Sizes, factor: float) -> None:
        self._sizes, self._mechanism, self._factor = sizes, mechanism, factor
        self._internal = mechanism.type == "geneva_internal"
        self._course = course_of(mechanism)
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
        self._stack = Stack(sizes, (self._wheel_shaft, self._crank_shaft))
        # State as a roller enters: direction of the crank, and rotation of the wheel, one slot of which is along x in
        # its frame.
        sense = -1.0 if self._internal else 1.0
        self._way = -sense * cmath.exp(-1j * self._course.geneva.half)
        self._wheel_turn = cmath.exp(1j * sense * self.wheel.step)
        turns = [cmath.exp(2j * math.pi * n / mechanism.rollers) for n in range(mechanism.rollers)]
        crank = factor * mechanism.crank_radius
        self._rollers = [self._axis + self._way * crank * turn for turn in turns]

    def assembled(self, scale: float) -> Assembly:
        """Build the assembly of all parts."""
        parts, planes = (self._ring(), 3) if self._internal else (self._wheel_beside(), 2)
        motion = GenevaMotion(
            self._size(), self._course, self._mechanism.rollers, self._axis, 1.0 if self._internal else -1.0
        )
        notes = ("The input is the crank; at an input angle of 0 a roller enters a slot.",
                 "All rotating parts are keyed to their shafts, which protrude beyond the bases.")  # fmt: skip
        return Assembly(tuple(parts), motion, planes, 2 if self._internal else 1, self._factor, scale, notes)

    def _size(self) -> float:
        ring_radius = self._factor * (self._mechanism.ring_radius or 0.0)
        return max(self.wheel.center_distance + self._factor * self._mechanism.crank_radius, 2.0 * ring_radius)

    def about_shaft(self) -> tuple[float, float]:
        """Return the minimum reach of the locking disc from its axis, and the radius of its bore plus a wall."""
        if self._internal:
            return math.inf, 0.0
        return float(self._locking().outer.min()), self._stack.hub(self._crank_shaft) + WALL * self._sizes.pin

    def _hub(self, place: complex, diameter: float) -> Outline:
        return self._stack.bore(place, diameter)

    def _crank(self, plane: int) -> Part:
        """Make the arm of the crank; a plate with several corners for several rollers."""
        half = 0.5 * max(self._sizes.width, self._of_shaft(self._crank_shaft))
        shape = widened([self._axis, *self._rollers], half)
        holes = [self._hub(self._axis, self._crank_shaft), *(Disc(z, 0.5 * self._sizes.hole) for z in self._rollers)]
        holes += [Disc(z, 0.5 * self._sizes.hole) for z in self._crescent_pins()]
        if self._crescent_pins():
            shape = widened([self._axis, *self._rollers, *self._crescent_pins()], half)
        return self._stack.plate("crank", "crank", "link", ON_CRANK, Region(shape, tuple(holes)), plane, CRANK_COLOUR,
                                 self._way)  # fmt: skip

    def _of_shaft(self, diameter: float) -> float:
        """Return the width of a plate around a shaft."""
        return self._sizes.width if diameter == self._sizes.pin else WIDTH * diameter

    def _on_rollers(self, plane: int, crank: int) -> list[Part]:
        """Make the rollers and their pins."""
        parts, stack = [], self._stack
        for n, z in enumerate(self._rollers, 1):
            name = "roller" if len(self._rollers) == 1 else f"roller_{n}"
            region = ring(z, self._roller, 0.5 * self._sizes.hole)
            parts.append(stack.plate(name, name.replace("_", " "), "block", ON_CRANK, region, plane, ROLLER_COLOUR))
            parts += stack.pin(name, f"pin {name.replace('_', ' ')}", ON_CRANK, z, (plane, crank))
            parts += stack.between(name, ON_CRANK, z, [(plane, crank)])
        return parts

    # A wheel next to the crank

    def _wheel_beside(self) -> list[Part]:
        stack, sizes = self._stack, self._sizes
        wheel = Region(self._outline(), (self._hub(0j, self._wheel_shaft),))
        locking = Region(self._disc(), (self._hub(self._axis, self._crank_shaft),))
        parts = [
            stack.plate("wheel", "wheel", "link", ON_WHEEL, wheel, 1, WHEEL_COLOUR),
            stack.plate("locking_disc", "locking disc", "link", ON_CRANK, locking, 1, DISC_COLOUR),
            self._crank(2),
            *self._on_rollers(1, 2),
            *stack.pin("wheel", "wheel shaft", ON_WHEEL, 0j, (0, 1), diameter=self._wheel_shaft, keyed=(1,), stub=-1),
            *stack.pin("crank", "crankshaft", ON_CRANK, self._axis, (0, 2), diameter=self._crank_shaft, keyed=(1, 2),
                       stub=-1),
        ]  # fmt: skip
        spans = [(0, 1)] if sizes.process != "print" else []
        parts += stack.between("wheel", ON_WHEEL, 0j, spans, self._wheel_shaft)
        parts += stack.between("crank", ON_CRANK, self._axis, [*spans, (1, 2)], self._crank_shaft)
        half = 0.5 * max(sizes.width, self._of_shaft(self._wheel_shaft), self._of_shaft(self._crank_shaft))
        places = ((0j, self._wheel_shaft), (self._axis, self._crank_shaft))
        holes = [Disc(z, 0.5 * stack.of(diameter).hole) for z, diameter in places]
        bosses = [(z, diameter, 1) for z, diameter in places]
        return [*parts, stack.base("base", widened([0j, self._axis], half), holes, bosses)]

    # A ring about the crank

    def _ring(self) -> list[Part]:
        stack, sizes = self._stack, self._sizes
        assert self._mechanism.ring_radius is not None
        outside = Disc(0j, self._factor * self._mechanism.ring_radius)
        dowels = self._dowels(outside.radius)
        holes = tuple(Disc(z, 0.5 * sizes.hole) for z in dowels)
        crescent = Region(self._crescent(), tuple(Disc(z, 0.5 * sizes.hole) for z in self._crescent_pins()))
        plate = Region(outside, (self._hub(0j, self._wheel_shaft), *holes))
        parts = [
            stack.plate("wheel_plate", "plate of the wheel", "link", ON_WHEEL, plate, 1, LINK_COLOURS[6]),
            stack.plate("wheel", "wheel, a ring", "link", ON_WHEEL, Region(outside, (self._outline(), *holes)), 2,
                        WHEEL_COLOUR),
            stack.plate("crescent", "locking crescent", "link", ON_CRANK, crescent, 2, DISC_COLOUR),
            self._crank(3),
            *self._on_rollers(2, 3),
            *stack.pin("wheel", "wheel shaft", ON_WHEEL, 0j, (0, 1), diameter=self._wheel_shaft, keyed=(1,), stub=-1),
            *stack.pin("crank", "crankshaft", ON_CRANK, self._axis, (3, 4), diameter=self._crank_shaft, keyed=(3,),
                       stub=1),
        ]  # fmt: skip
        for n, z in enumerate(dowels, 1):
            parts += stack.pin(f"dowel_{n}", f"pin dowel {n}", ON_WHEEL, z, (1, 2))
            parts += stack.between(f"dowel_{n}", ON_WHEEL, z, [(1, 2)])
        for n, z in enumerate(self._crescent_pins(), 1):
            parts += stack.pin(f"crescent_{n}", f"pin crescent {n}", ON_CRANK, z, (2, 3))
            parts += stack.between(f"crescent_{n}", ON_CRANK, z, [(2, 3)])
        if sizes.process != "print":
            parts += stack.between("wheel", ON_WHEEL, 0j, [(0, 1)], self._wheel_shaft)
            parts += stack.between("crank", ON_CRANK, self._axis, [(3, 4)], self._crank_shaft)
        return parts + self._bases(outside.radius)

    def _bases(self, radius: float) -> list[Part]:
        """Make both bases, and posts around the ring."""
        stack, sizes = self._stack, self._sizes
        # Posts stay outside the ring at all positions.
        far = radius + 0.5 * sizes.collar + 2.0 * sizes.apart
        posts = [far * cmath.exp(0.25j * math.pi * (2 * n + 1)) for n in range(4)]
        parts: list[Part] = []
        for n, z in enumerate(posts, 1):
            parts += stack.pin(f"post_{n}", f"post {n}", STILL, z, (0, 4))
            parts += stack.between(f"post_{n}", STILL, z, [(0, 4)])
        outer = widened([*posts, self._axis], 0.5 * sizes.width)
        held = [Disc(z, 0.5 * sizes.hole) for z in posts]
        below = Disc(0j, 0.5 * stack.of(self._wheel_shaft).hole)
        above = Disc(self._axis, 0.5 * stack.of(self._crank_shaft).hole)
        return [
            *parts,
            stack.base("base", outer, [below, *held], [(0j, self._wheel_shaft, 1)]),
            stack.base("second_base", outer, [above, *held], [(self._axis, self._crank_shaft, 3)], plane=4),
        ]

    def _dowels(self, outside: float) -> list[complex]:
        """Return the places of the pins that hold the ring to its plate: outside the locking arcs, at most four."""
        n = self._mechanism.stations
        middle = 0.5 * (self.wheel.center_distance + self.wheel.lock + outside)
        # Four dowels suffice for any number of stations.
        chosen = range(n) if n <= 4 else [round(k * n / 4) for k in range(4)]
        return [middle * self._wheel_turn * cmath.exp(1j * self.wheel.step * (2 * k + 1)) for k in chosen]

    def _crescent_pins(self) -> list[complex]:
        """Return the places of the pins that hold the crescent below the crank."""
        if not self._internal:
            return []
        found = self._locking()
        # Pins are placed midway between the two edges of the crescent.
        middle = 0.5 * (found.outer + found.inner)
        return [
            self._axis + self._way * complex(middle[k] * np.exp(1j * found.angle[k]))
            for k in (len(middle) // 4, (3 * len(middle)) // 4)
        ]

    # Outlines

    def _outline(self) -> Loop:
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

    def _locking(self) -> Any:
        """Return the disc or crescent in the crank's frame."""
        return disc(self.wheel, self._course.geneva, self._mechanism.rollers, self._gap, self._relief)

    def _disc(self) -> Loop:
        """Return the locking disc: true arcs, and between them the curve that the passing wheel leaves, as chords."""
        found = self._locking()
        return self._traced(found.angle, found.outer, closed=True)

    def _crescent(self) -> Loop:
        """Return the crescent: its arc, and inside the curve that the passing horns leave."""
        found = self._locking()
        arc = self._traced(found.angle, found.outer, closed=False)
        inner = self._axis + self._way * found.inner * np.exp(1j * found.angle)
        back = inner[::-1].tolist()
        return Loop((*arc.corners, *back), (*arc.bulges, *([0.0] * len(back))))

    def _traced(self, angle: Real, radius: Real, *, closed: bool) -> Loop:
        """Return corners about the crank's axis; those on the maximum radius are joined by one arc, others by lines."""
        arc = float(radius.max())
        on = radius >= arc * (1.0 - ON_ARC)
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
