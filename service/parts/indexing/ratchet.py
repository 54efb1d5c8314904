"""Ratchets as parts: the toothed wheel on its shaft, pawls on their pivots next to it, and the base.

Wheel and pawls lie in one plane. The nose of a pawl lies between the face that it holds and a line that clears the
tooth behind at every lift; its body stays outside the tip circle.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np
import shapely

from kinematics.arrays import Real
from kinematics.indexing.ratchet import Ratchet
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose
from service.parts.assembly.colours import LINK_COLOURS
from service.parts.assembly.descriptions import describe_identifier
from service.parts.assembly.fit_sizes import Fitting, Trial, find_fault
from service.parts.assembly.model import Assembly, Carrier, Part, Placement
from service.parts.assembly.plate_stack import GROUND_CARRIER, PlateStack
from service.parts.assembly.sizes import MILLIMETRES_PER_UNIT, WIDTH_PER_PIN, NotMade, PartsQuery, Sizes
from service.parts.cam.motion import FULL_TURN, ShaftMotion, make_rest_placement, make_rotation
from service.parts.geometry.regions import Disc, Loop, Region, make_polygon, widen_hull
from synthesis.kinds.indexing.design import RatchetDesign, RatchetMechanism
from synthesis.kinds.indexing.problem import IndexingProblem

WHEEL_LINK, PAWL_LINK = "wheel", "pawl"
ON_WHEEL = Carrier(WHEEL_LINK, None)
WHEEL_COLOUR, PAWL_COLOUR = LINK_COLOURS[1], LINK_COLOURS[0]

MAX_PIN_PER_WHEEL = 0.15
"""Thickest default pin, in radii of the wheel."""

NOSE_LENGTH = 1.5
"""Length of a pawl's face, in tooth face lengths."""

MIN_NOSE_CLEARANCE, MIN_NOSE_ANGLE = 2.0, 8.0
"""Minimum angle between the nose and the tooth behind, and minimum nose angle, degrees."""

LIFT_SAMPLES = 721
"""Number of positions of a pitch at which the rotation of a pawl relative to the wheel is measured."""


@dataclass(frozen=True)
class RatchetMotion(ShaftMotion):
    """Wheel and pawls over a turn of the wheel, starting where the first pawl holds it.

    Attributes
    ----------
    ratchet : Ratchet
        Dimensions in millimetres.
    pivots : tuple of complex
        Pivots of the pawls.
    stops : tuple of float
        Angle of the wheel from its first stop to the stop of each pawl, radians.
    """

    ratchet: Ratchet
    pivots: tuple[complex, ...]
    stops: tuple[float, ...]

    def sample_inputs(self, count: int) -> Real:
        """Return inputs over a turn plus a pitch, so that they sample all phases of a pitch."""
        return (FULL_TURN + self.ratchet.pitch) / count * np.arange(count, dtype=np.float64)

    def compute_placement(self, carrier: Carrier, state: Real) -> Placement:
        """Return the displacement of a carrier since the first pawl held the wheel."""
        if carrier.link == GROUND:
            return make_rest_placement(state)
        if carrier.link == WHEEL_LINK:
            return make_rotation(state)
        number = int(carrier.link.removeprefix(PAWL_LINK)) - 1
        return make_rotation(
            self.compute_lift(number, np.zeros(1)) - self.compute_lift(number, state), self.pivots[number]
        )

    def compute_lift(self, number: int, state: Real) -> Real:
        """Return the lift of a pawl, radians."""
        return self.ratchet.pawl_lift(state - self.stops[number])


def make_ratchet_parts(design: RatchetDesign, problem: IndexingProblem, query: PartsQuery) -> Assembly:
    """Make the parts of a ratchet.

    Parameters
    ----------
    design : RatchetDesign
    problem : IndexingProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If a nose does not fit between the teeth, or the parts do not fit.
    """
    return _RatchetFitting(design.mechanism, query, MILLIMETRES_PER_UNIT[problem.length_unit]).build_assembly()


class _RatchetFitting(Fitting):
    """One request for the parts of a ratchet."""

    def __init__(self, mechanism: RatchetMechanism, query: PartsQuery, unit: float) -> None:
        self._mechanism = mechanism
        far = max(abs(complex(*pawl.pivot)) for pawl in mechanism.pawls)
        super().__init__(query, unit, 2.0 * max(far, mechanism.wheel_radius))

    @property
    def max_pin(self) -> float:
        """Thickest default pin, as a share of the wheel."""
        return MAX_PIN_PER_WHEEL * self._mechanism.wheel_radius

    def try_sizes(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in these sizes."""
        assembly = _Builder(self._mechanism, sizes, self._unit * scale).build_assembly(scale, self._size)
        pawl = next(part for part in assembly.parts if part.carrier.link.startswith(PAWL_LINK))
        # An outline that crosses itself is no part.
        around = make_polygon(pawl.region.outer, beyond=True)
        if not shapely.Polygon(np.column_stack([around.real, around.imag])).is_valid:
            return Trial(None, compose("parts-pawl-overlaps-nose"))
        fault = find_fault(assembly, sizes)
        return Trial(None, fault) if fault else Trial(assembly, "")


class _Builder:
    """Makes the parts of a ratchet in given sizes; lengths in millimetres."""

    def __init__(self, mechanism: RatchetMechanism, sizes: Sizes, factor: float) -> None:
        self._sizes, self._factor = sizes, factor
        self._ratchet = Ratchet(
            mechanism.teeth,
            factor * mechanism.wheel_radius,
            factor * mechanism.tooth_height,
            math.radians(mechanism.face_angle),
            factor * mechanism.pawl_length,
        )
        self._shaft = factor * mechanism.bore or sizes.pin
        self._stack = PlateStack(sizes, (self._shaft,))
        self._pawls = mechanism.pawls
        self._pivots = tuple(factor * complex(*pawl.pivot) for pawl in mechanism.pawls)

    def build_assembly(self, scale: float, size: float) -> Assembly:
        """Build the assembly of all parts."""
        stops = tuple(math.radians(pawl.stop) for pawl in self._pawls)
        motion = RatchetMotion(self._factor * size, self._ratchet, self._pivots, stops)
        stack, sizes = self._stack, self._sizes
        corners = tuple(self._ratchet.outline.tolist())
        wheel = Region(Loop(corners, (0.0,) * len(corners)), (stack.make_bore(0j, self._shaft),))
        names = ["pawl"] if len(self._pawls) == 1 else [f"pawl_{n}" for n in range(1, len(self._pawls) + 1)]
        parts = [
            stack.make_plate("wheel", compose("parts-ratchet-wheel"), "link", ON_WHEEL, wheel, 1, WHEEL_COLOUR),
            *stack.make_pin(
                "wheel", compose("parts-wheel-shaft"), ON_WHEEL, 0j, (0, 1), diameter=self._shaft, keyed=(1,), stub=-1
            ),
        ]
        for number, name in enumerate(names):
            parts += self._make_pawl(name, number, float(motion.compute_lift(number, np.zeros(1))[0]))
        if sizes.process != "print":
            parts += stack.make_fillers("wheel", ON_WHEEL, 0j, [(0, 1)], self._shaft)
        half = 0.5 * max(sizes.width, sizes.width if self._shaft == sizes.pin else WIDTH_PER_PIN * self._shaft)
        holes = [Disc(0j, 0.5 * stack.get_sizes(self._shaft).hole), *(Disc(z, 0.5 * sizes.hole) for z in self._pivots)]
        bosses = [(0j, self._shaft, 1), *((z, sizes.pin, 1) for z in self._pivots)]
        parts.append(stack.make_base("base", widen_hull([0j, *self._pivots], half), holes, bosses))
        notes = (compose("parts-ratchet-input"),
                 compose("parts-pawls-need-force"),
                 compose("parts-ratchet-keyed"))  # fmt: skip
        touching = frozenset(frozenset(("wheel", name)) for name in names)
        return Assembly(tuple(parts), motion, 1, 1, self._factor, scale, notes, touching)

    def _make_pawl(self, name: str, number: int, lift: float) -> list[Part]:
        stack, pivot = self._stack, self._pivots[number]
        # Rotation that takes the first pawl, while it holds the wheel, to the position of this pawl at that moment.
        turn = pivot / self._ratchet.pivot * cmath.exp(-1j * lift)
        shape = self._make_pawl_outline()
        corners = tuple(pivot + turn * (z - self._ratchet.pivot) for z in shape.corners)
        region = Region(Loop(corners, shape.bulges), (Disc(pivot, 0.5 * self._sizes.hole),))
        along = turn * (self._ratchet.foot - self._ratchet.pivot)
        carrier = Carrier(f"{PAWL_LINK}{number + 1}", None)
        parts = [
            stack.make_plate(
                name, describe_identifier(name), "link", carrier, region, 1, PAWL_COLOUR, along / abs(along)
            )
        ]
        parts += stack.make_pin(name, describe_identifier(f"pin_{name}"), GROUND_CARRIER, pivot, (0, 1))
        if self._sizes.process != "print":
            parts += stack.make_fillers(name, GROUND_CARRIER, pivot, [(0, 1)])
        return parts

    def _make_pawl_outline(self) -> Loop:
        """Return the first pawl while it holds the wheel: its nose, and the round end about its pivot."""
        ratchet, radius = self._ratchet, 0.5 * self._sizes.width
        foot, pivot = ratchet.foot, ratchet.pivot
        face = (ratchet.tip - foot) / abs(ratchet.tip - foot)
        back = ratchet.tip * cmath.exp(-1j * ratchet.pitch) - foot
        # Maximum rotation of the pawl relative to the wheel, towards the tooth behind, until it drops in again.
        wheel = np.linspace(0.0, ratchet.pitch + ratchet.overtravel, LIFT_SAMPLES)[:-1]
        closing = float((wheel + ratchet.pawl_lift(wheel)).max()) + math.radians(MIN_NOSE_CLEARANCE)
        inner = back / abs(back) * cmath.exp(1j * closing)
        if cmath.phase(face / inner) < math.radians(MIN_NOSE_ANGLE):
            raise NotMade(compose("parts-too-few-teeth-for-pawl"))
        # From the foot out of the tip circle, and on to the pivot.
        out = ratchet.radius + self._sizes.min_gap
        along = (foot * inner.conjugate()).real
        # Intersection of the inner line with the circle outside the tips.
        beyond = foot + inner * (-along + math.sqrt(along**2 + out**2 - abs(foot) ** 2))
        end = foot + NOSE_LENGTH * abs(ratchet.tip - foot) * face
        if abs(end) < out:
            end = foot + face * (abs(ratchet.tip - foot) + self._sizes.min_gap + 0.5 * ratchet.height)
        inside = [beyond]
        tangent = -1j * beyond / abs(beyond)
        first = _find_tangent(beyond - pivot, radius, 1.0)
        if ((pivot + cmath.rect(radius, first) - beyond) * beyond.conjugate()).real < 0.0:
            # A straight line to the pivot's round end would re-enter the tip circle.
            inside.append(beyond + tangent * max(((pivot - beyond) * tangent.conjugate()).real - radius, 0.0))
            first = _find_tangent(inside[1] - pivot, radius, 1.0)
        last = _find_tangent(end - pivot, radius, -1.0)
        # The round end runs counter-clockwise between the two tangents.
        turn = (last - first) % (2.0 * math.pi)
        around = [pivot + radius * cmath.exp(1j * (first + share * turn)) for share in (0.0, 0.5, 1.0)]
        bulge = math.tan(0.125 * turn)
        return Loop((foot, *inside, *around, end), (*(0.0,) * (1 + len(inside)), bulge, bulge, 0.0, 0.0))


def _find_tangent(point: complex, radius: float, side: float) -> float:
    """Return the direction, from the origin, of the tangent point on a circle about it for a tangent from a point."""
    return cmath.phase(point) + side * math.acos(min(1.0, radius / abs(point)))
