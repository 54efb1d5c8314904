"""Radial cams as parts: the cam on its shaft, the follower with its guide or pivot, rollers, and the base.

From below: the base; the cam; above it the carrier of the roller, or next to it the flat face. The roller hangs in the
plane of the cam. A groove consists of two walls on a back. One of two conjugate cams is below the follower and the
other above. If the pivot of an arm would be in the cam's way, the arm lies below the cam, whose shaft then passes it.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from kinematics.cam.finished.contact import Contour
from kinematics.cam.follower import Flat, OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.motion.pieces import Motion as CamState
from kinematics.message import compose
from service.parts.assembly.colours import BLOCK_COLOUR, LINK_COLOURS
from service.parts.assembly.descriptions import describe_identifier, name_material
from service.parts.assembly.fasteners import MATERIALS
from service.parts.assembly.fit_sizes import NARROW_FOR_PINS, NARROW_FOR_RUNNER, Fitting, Trial, find_fault
from service.parts.assembly.model import Assembly, Carrier, Part
from service.parts.assembly.plate_stack import GROUND_CARRIER, PlateStack
from service.parts.assembly.sizes import MILLIMETRES_PER_UNIT, NotMade, PartsQuery, Sizes
from service.parts.cam.contours import fit_outline
from service.parts.cam.followers import make_bell_crank, make_face_arm, make_face_slide
from service.parts.cam.motion import CAM, FOLLOWER, CamMotion, Displacement
from service.parts.geometry.regions import Disc, Loop, Outline, Region, make_ring, widen_hull
from service.parts.geometry.solids import Prism
from service.parts.geometry.splines import Curve
from synthesis.kinds.cam.design import CamCurve, CamDesign, CamMechanism
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.profile import build_core_follower, find_stretches, read_points, read_table_angles
from synthesis.mechanisms.cam import build_follower

CAM_COLOURS = LINK_COLOURS[1], LINK_COLOURS[5]
FOLLOWER_COLOUR, ROLLER_COLOUR = LINK_COLOURS[0], LINK_COLOURS[2]

ON_CAM, ON_FOLLOWER = Carrier(CAM, None), Carrier(FOLLOWER, None)

MAX_PIN_PER_ROLLER, MAX_PIN_PER_BASE = 0.8, 0.25
"""Thickest default pin as a share of the radii of roller and base circle."""

GUIDE_LENGTH = 4.0
"""Distance of the two pins of a slide's runner, in pin diameters."""

RIM_WIDTH = 0.25
"""Rim of a cam with a groove outside its outer wall, in addition to a collar, in pin diameters."""

MAX_ARM_ANGLE = math.radians(170.0)
"""Maximum angle between the two arms of a follower of conjugate cams; beyond it the plate has no inner corner."""

DOWEL_COUNT = 3
"""Number of pins that hold the outer wall of a groove cut from sheets."""


class CamPlanes(NamedTuple):
    """Planes of a cam and its follower; ``back`` is that of a groove, ``second`` that of a second cam."""

    cam: int
    follower: int
    back: int | None = None
    second: int | None = None

    @property
    def highest(self) -> int:
        """The highest plane."""
        return max(plane for plane in self if plane is not None)


def make_cam_parts(design: CamDesign, problem: CamProblem, query: PartsQuery) -> Assembly:
    """Make the parts of a radial cam.

    Parameters
    ----------
    design : CamDesign
    problem : CamProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If the contour cannot be cut, or the parts do not fit.
    """
    return _CamFitting(design.mechanism, query, MILLIMETRES_PER_UNIT[problem.length_unit]).build_assembly()


class _CamFitting(Fitting):
    """One request for the parts of a cam."""

    def __init__(self, mechanism: CamMechanism, query: PartsQuery, unit: float) -> None:
        self._mechanism = mechanism
        self._core = build_core_follower(mechanism)
        # The size covers the cam and, for arms, twice the pivot distance.
        far = max(float(np.abs(read_points(curve)).max()) for curve in (mechanism.profile, mechanism.pitch_curve))
        super().__init__(query, unit, 2.0 * max(far, getattr(self._core, "pivot_distance", 0.0)))

    @property
    def max_pin(self) -> float:
        """Thickest default pin, as a share of the roller or base circle and of the remaining cam."""
        mechanism = self._mechanism
        if mechanism.base_radius is not None:
            return MAX_PIN_PER_BASE * mechanism.base_radius
        assert mechanism.prime_radius is not None
        radius = mechanism.follower.roller_radius
        assert radius is not None
        # The pin must fit the roller, and the shaft the base circle of the cam.
        return min(MAX_PIN_PER_ROLLER * radius, MAX_PIN_PER_BASE * 2.0 * (mechanism.prime_radius - radius))

    def find_opening(self, sizes: Sizes) -> tuple[float, str]:
        """Return the widest opening: the base has a slot for the runner of a slide."""
        if isinstance(self._core, TranslatingRoller | TranslatingFlat):
            return sizes.block[1] + 2.0 * sizes.clearance, NARROW_FOR_RUNNER
        return sizes.hole, NARROW_FOR_PINS

    def try_sizes(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in the first arrangement that fits."""
        reasons = []
        for planes in list_arrangements(self._mechanism):
            assembly = CamBuilder(self._mechanism, sizes, self._unit * scale, planes).build_assembly(scale)
            reason = find_fault(assembly, sizes)
            if not reason:
                return Trial(assembly, "")
            reasons.append(reason)
        if len(reasons) == 1:
            return Trial(None, reasons[0])
        # The second arrangement, if any, has the follower below the cam.
        above, below = reasons
        return Trial(None, compose("parts-fits-neither-above-nor-below", above=above, below=below))


def list_arrangements(mechanism: CamMechanism) -> Iterator[CamPlanes]:
    """Yield the planes to be tried, in order of preference."""
    if mechanism.follower.type.endswith("flat"):
        yield CamPlanes(1, 1)
        return
    if mechanism.second is not None:
        yield CamPlanes(1, 2, second=3)
        return
    groove = mechanism.outer_wall is not None
    yield CamPlanes(2, 3, back=1) if groove else CamPlanes(1, 2)
    if mechanism.follower.type.startswith("oscillating"):
        yield CamPlanes(2, 1, back=3) if groove else CamPlanes(2, 1)


@dataclass(frozen=True)
class _Roller:
    """A roller of the follower: its centre at cam angle 0, its radius, and the plane of its cam."""

    name: str
    centre: complex
    radius: float
    plane: int


class CamBuilder:
    """Builds the assembly of a cam in given sizes.

    Parameters
    ----------
    mechanism : CamMechanism
        Mechanism of a design.
    sizes : Sizes
    factor : float
        Millimetres per length unit of the design, at the built size.
    planes : CamPlanes
    """

    def __init__(self, mechanism: CamMechanism, sizes: Sizes, factor: float, planes: CamPlanes) -> None:
        self._mechanism, self._sizes, self._factor, self._planes = mechanism, sizes, factor, planes
        self._core = build_core_follower(mechanism)
        self._sense = 1.0 if mechanism.rotation == "ccw" else -1.0
        swings = isinstance(self._core, OscillatingRoller | OscillatingFlat)
        self._unit = math.radians(1.0) if swings else factor
        self._displacement = Displacement.from_program(mechanism.program, self._unit)
        self._first = float(self._displacement(np.zeros(1))[0])
        self._stack = PlateStack(sizes, ())
        self._pivot: complex | None = None
        self._way = 0.0
        if isinstance(self._core, OscillatingRoller | OscillatingFlat):
            self._pivot = complex(factor * self._core.pivot_distance)
            # The arm lies above the line of centres if the cam turns clockwise and the arm swings outward with it.
            self._way = -self._sense * self._core.sense

    def build_assembly(self, scale: float) -> Assembly:
        """Build the assembly of all parts."""
        rollers = self._place_rollers()
        contours = [self._fit_contour(self._mechanism.profile, self._inward)]
        if self._mechanism.second is not None:
            contours.append(self._fit_contour(self._mechanism.second.profile, 0.0))
        cams = self._make_cams(contours)
        self._reach = max(_measure_radii(part.region.outer)[1] for part in cams if part.sort == "cam")
        follower, cuts, points = self._make_follower(rollers)
        parts = [*cams, *self._make_shaft(), *follower]
        for roller in rollers:
            parts += self._make_roller(roller)
        outer = widen_hull([0j, *points], 0.5 * self._sizes.width)
        bosses = [(0j, self._sizes.pin, self._first_plane)]
        if self._pivot is not None:
            bosses.append((self._pivot, self._sizes.pin, self._planes.follower))
        parts.append(self._stack.make_base("base", outer, [Disc(0j, 0.5 * self._sizes.hole), *cuts], bosses))
        motion = CamMotion(self._measure_size(points), self._displacement, self._sense,
                           complex(-self._way) if self._pivot is not None else 1.0 + 0.0j, self._pivot)  # fmt: skip
        return Assembly(
            tuple(parts), motion, self._planes.highest, 1, self._factor, scale, self._list_notes(),
            frozenset(self._list_contacts(rollers)),
        )  # fmt: skip

    # The cam

    @property
    def _inward(self) -> float:
        """Offset of the inner wall of a groove from its profile."""
        return -self._sizes.clearance if self._mechanism.outer_wall is not None else 0.0

    @property
    def _first_plane(self) -> int:
        """The lowest plane of a cam."""
        planes = self._planes
        return min(plane for plane in (planes.cam, planes.back, planes.second) if plane is not None)

    def _fit_contour(self, curve: CamCurve, offset: float) -> Curve:
        program = self._mechanism.program
        if list(curve.angle) == list(program.angle):
            breaks = find_stretches(program).breaks
            contour = Contour(read_points(curve), read_table_angles(program), breaks)
        else:
            contour = Contour(read_points(curve))
        return fit_outline(contour, self._factor, offset)

    def _make_bore(self) -> Outline:
        return self._stack.make_bore(0j)

    def _make_cams(self, contours: list[Curve]) -> list[Part]:
        planes, stack, hole = self._planes, self._stack, (self._make_bore(),)
        if planes.back is None:
            names = ["cam"] if len(contours) == 1 else ["cam_1", "cam_2"]
            at = [planes.cam, planes.second or 0]
            return [
                stack.make_plate(name, describe_identifier(name), "cam", ON_CAM, Region(contour, hole), plane, colour)
                for name, contour, plane, colour in zip(names, contours, at, CAM_COLOURS, strict=False)
            ]
        outer = self._mechanism.outer_wall
        # Only a grooved cam has a back.
        assert outer is not None
        wall = self._fit_contour(outer, self._sizes.clearance)
        rim = self._sizes.collar + RIM_WIDTH * self._sizes.pin
        disc = Disc(0j, max(_measure_radii(wall)) + rim)
        # Milling and printing make the groove in one piece; sheets need a back and two walls.
        if self._sizes.process != "laser":
            return [self._make_milled(contours[0], wall, disc)]
        # Dowels are evenly spaced in the rim outside the groove.
        places = [cmath.rect(disc.radius - 0.5 * rim, 2.0 * math.pi * n / DOWEL_COUNT) for n in range(DOWEL_COUNT)]
        dowels = [Disc(z, 0.5 * self._sizes.hole) for z in places]
        levels = min(planes.back, planes.cam), max(planes.back, planes.cam)
        held: list[Part] = []
        for n, z in enumerate(places, 1):
            held += stack.make_pin(f"dowel_{n}", compose("parts-dowel-pin", number=n), ON_CAM, z, levels)
            held += stack.make_fillers(f"dowel_{n}", ON_CAM, z, [levels])
        back = Region(disc, (*hole, *dowels))
        return [
            stack.make_plate("cam_back", compose("parts-cam-back"), "cam", ON_CAM, back, planes.back, CAM_COLOURS[1]),
            stack.make_plate(
                "cam",
                compose("parts-groove-inner-wall"),
                "cam",
                ON_CAM,
                Region(contours[0], hole),
                planes.cam,
                CAM_COLOURS[0],
            ),
            stack.make_plate(
                "cam_wall",
                compose("parts-groove-outer-wall"),
                "cam",
                ON_CAM,
                Region(disc, (wall, *dowels)),
                planes.cam,
                CAM_COLOURS[0],
            ),
            *held,
        ]

    def _make_milled(self, inner: Curve, wall: Curve, disc: Disc) -> Part:
        """Make a cam with its groove in one piece."""
        planes, hole = self._planes, (self._make_bore(),)
        assert planes.back is not None
        (low, high), (bottom, top) = self._stack.get_level(planes.back), self._stack.get_level(planes.cam)
        walls = (high, top) if bottom > high else (bottom, low)
        bodies = (
            Prism(Region(disc, hole), low, high),
            Prism(Region(inner, hole), *walls),
            Prism(Region(disc, (wall,)), *walls),
        )
        span = (min(planes.back, planes.cam), max(planes.back, planes.cam))
        material = name_material(MATERIALS[self._sizes.process][0])
        return Part(
            "cam", compose("parts-grooved-cam"), "cam", ON_CAM, bodies, 1.0 + 0.0j, span, material, CAM_COLOURS[0]
        )

    def _make_shaft(self) -> list[Part]:
        planes = self._planes
        # All plates of the cam rotate with the shaft.
        keyed = sorted(plane for plane in (planes.cam, planes.back, planes.second) if plane is not None)
        parts = self._stack.make_pin("cam", compose("parts-camshaft"), ON_CAM, 0j, (0, keyed[-1]), keyed=keyed, stub=-1)
        spans = [(0, keyed[0])] if self._sizes.process != "print" else []
        if planes.back is None or self._sizes.process == "laser":
            spans += pairwise(keyed)
        return parts + self._stack.make_fillers("cam", ON_CAM, 0j, spans)

    # The follower

    def _place_rollers(self) -> list[_Roller]:
        core, factor, second = self._core, self._factor, self._mechanism.second
        if isinstance(core, TranslatingRoller):
            # The slide moves along x; its line is offset sideways.
            centre = complex(factor * core.height + self._first, -self._sense * factor * core.offset)
        elif isinstance(core, OscillatingRoller):
            assert self._pivot is not None
            swung = core.start_angle + self._first
            centre = self._pivot - factor * core.arm * complex(np.exp(-1j * self._way * swung))
        else:
            return []
        found = [_Roller("roller", centre, factor * core.roller_radius, self._planes.cam)]
        if second is not None:
            assert self._planes.second is not None
            other = build_follower(second.follower.type, second.prime_radius, second.follower)
            assert isinstance(other, TranslatingRoller | OscillatingRoller)
            if isinstance(core, TranslatingRoller):
                opposite = centre - factor * second.roller_distance
            else:
                assert isinstance(other, OscillatingRoller)
                assert self._pivot is not None
                assert second.arm_angle is not None
                turn = complex(np.exp(1j * self._way * math.radians(second.arm_angle)))
                opposite = self._pivot + (centre - self._pivot) * other.arm / core.arm * turn
            found.append(_Roller("roller_2", opposite, factor * other.roller_radius, self._planes.second))
        return found

    def _make_follower(self, rollers: list[_Roller]) -> tuple[list[Part], list[Outline], list[complex]]:
        """Make the follower's parts; return them, cuts in the base, and points that the base must reach."""
        core = self._core
        if isinstance(core, TranslatingRoller | TranslatingFlat):
            return self._make_slide(core, rollers)
        assert self._pivot is not None
        plane, radius = self._planes.follower, 0.5 * self._sizes.width
        shape: Outline
        if isinstance(core, OscillatingFlat):
            shape = self._make_arm_face(core)
        elif len(rollers) == 1:
            shape = widen_hull([self._pivot, rollers[0].centre], radius)
        else:
            arms = [roller.centre - self._pivot for roller in rollers][:: 1 if self._way > 0.0 else -1]
            # A bell crank needs an inner corner between its arms.
            apart = cmath.phase(arms[1] / arms[0])
            if not 0.0 < apart < MAX_ARM_ANGLE or radius / math.tan(0.5 * apart) > min(abs(arm) for arm in arms):
                raise NotMade(compose("parts-follower-arms-angle"))
            crank = make_bell_crank(arms[0], arms[1], radius)
            shape = Loop(tuple(self._pivot + z for z in crank.corners), crank.bulges)
        holes = [Disc(z, 0.5 * self._sizes.hole) for z in (self._pivot, *(roller.centre for roller in rollers))]
        along = _normalize((rollers[0].centre if rollers else 0j) - self._pivot)
        arm = self._stack.make_plate(
            "follower",
            compose("parts-arm"),
            "link",
            ON_FOLLOWER,
            Region(shape, tuple(holes)),
            plane,
            FOLLOWER_COLOUR,
            along,
        )
        on_pivot = self._stack.make_pin("pivot", compose("parts-pivot-pin"), GROUND_CARRIER, self._pivot, (0, plane))
        if self._sizes.process != "print":
            on_pivot += self._stack.make_fillers("pivot", GROUND_CARRIER, self._pivot, [(0, plane)])
        return [arm, *on_pivot], [Disc(self._pivot, 0.5 * self._sizes.hole)], [self._pivot]

    def _make_arm_face(self, core: OscillatingFlat) -> Loop:
        assert self._pivot is not None
        reach = self._factor * core.reach(self._make_state())
        shape = make_face_arm(
            self._factor * core.face_offset, (float(reach.min()), float(reach.max())), self._sizes.width
        )
        along = 1j * self._way * complex(np.exp(1j * self._way * (0.5 * math.pi - core.start_angle - self._first)))
        corners, bulges = shape.corners, shape.bulges
        if self._way < 0.0:
            # Mirroring reverses the orientation: reverse the order as well.
            corners = tuple(z.conjugate() for z in (corners[0], *corners[:0:-1]))
            bulges = bulges[::-1]
        return Loop(tuple(self._pivot + along * z for z in corners), bulges)

    def _make_state(self) -> CamState:
        """Return the program's table as a motion of the core, in radians or the design's unit."""
        program, unit = self._mechanism.program, self._unit if self._pivot is not None else 1.0
        return CamState(unit * np.array(program.s), *(np.array(x) for x in (program.v, program.a, program.j)))

    def _make_slide(
        self, core: TranslatingRoller | TranslatingFlat, rollers: list[_Roller]
    ) -> tuple[list[Part], list[Outline], list[complex]]:
        sizes, stack, plane = self._sizes, self._stack, self._planes.follower
        least, most = (end - self._first for end in self._displacement.extremes)
        line = -self._sense * self._factor * core.offset
        half = 0.5 * sizes.width
        if isinstance(core, TranslatingFlat):
            begin = self._factor * core.base_radius + self._first
            guide = begin + 2.0 * sizes.width
        else:
            # Its pins pass the plane of the cam, outside everything that rotates there.
            begin = rollers[0].centre.real
            guide = max(begin + sizes.width + sizes.collar, self._reach + 0.5 * sizes.collar + sizes.min_gap - least)
        ends = [complex(guide, line), complex(guide + GUIDE_LENGTH * sizes.pin, line)]
        holes: list[Outline] = [Disc(z, 0.5 * sizes.hole) for z in (*ends, *(roller.centre for roller in rollers))]
        if isinstance(core, TranslatingFlat):
            # The contact of a flat face is displaced by the velocity ds/dθ.
            contact = -self._sense * self._factor * np.array(self._mechanism.program.v)
            shape: Outline = make_face_slide(
                begin, line, (float(contact.min()), float(contact.max())), sizes.width, ends[1].real
            )
        else:
            if len(rollers) > 1:
                # The shaft passes through the yoke.
                around = 0.5 * sizes.collar + sizes.clearance
                holes.append(widen_hull([complex(-most), complex(-least)], around))
                half = max(half, abs(line) + around + 0.5 * sizes.pin)
            shape = widen_hull([rollers[-1].centre, ends[1]], half)
        stem = stack.make_plate(
            "follower",
            compose("parts-follower"),
            "link",
            ON_FOLLOWER,
            Region(shape, tuple(holes)),
            plane,
            FOLLOWER_COLOUR,
        )
        wide = 0.5 * sizes.block[1]
        runner = stack.make_plate(
            "runner", compose("parts-runner"), "block", ON_FOLLOWER,
            Region(widen_hull(ends, wide), tuple(Disc(z, 0.5 * sizes.hole) for z in ends)), 0, BLOCK_COLOUR,
        )  # fmt: skip
        parts = [stem, runner]
        for n, z in enumerate(ends, 1):
            parts += stack.make_pin(f"guide_{n}", compose("parts-guide-pin", number=n), ON_FOLLOWER, z, (0, plane))
            parts += stack.make_fillers(f"guide_{n}", ON_FOLLOWER, z, [(0, plane)])
        # The runner's slot covers the whole stroke.
        way = [ends[0] + least, ends[1] + most]
        return parts, [widen_hull(way, wide + sizes.clearance)], way

    def _make_roller(self, roller: _Roller) -> list[Part]:
        sizes, stack, plane = self._sizes, self._stack, self._planes.follower
        levels = min(roller.plane, plane), max(roller.plane, plane)
        region = make_ring(roller.centre, roller.radius, 0.5 * sizes.hole)
        body = Prism(region, *stack.get_level(roller.plane))
        material = name_material({"print": "PETG", "laser": "sheet", "mill": "steel"}[sizes.process])
        part = Part(roller.name, describe_identifier(roller.name), "block", ON_FOLLOWER, (body,), 1.0 + 0.0j,
                    (roller.plane, roller.plane), material, ROLLER_COLOUR, round=True)  # fmt: skip
        pin = stack.make_pin(roller.name, describe_identifier(f"pin_{roller.name}"), ON_FOLLOWER, roller.centre, levels)
        return [part, *pin, *stack.make_fillers(roller.name, ON_FOLLOWER, roller.centre, [levels])]

    # The whole

    def _list_contacts(self, rollers: list[_Roller]) -> Iterator[frozenset[str]]:
        """Yield pairs of parts in permanent contact."""
        if isinstance(self._core, Flat):
            yield frozenset(("cam", "follower"))
        elif len(rollers) > 1:
            yield from (frozenset(pair) for pair in (("cam_1", "roller"), ("cam_2", "roller_2")))
        elif self._planes.back is None:
            yield frozenset(("cam", "roller"))

    def _measure_size(self, points: list[complex]) -> float:
        """Return the distance from the far side of the cam to the far end of the base."""
        return self._reach + max(abs(z) for z in points)

    def _list_notes(self) -> tuple[str, ...]:
        notes = [compose("parts-camshaft-protrudes")]
        if self._planes.back is None and self._planes.second is None:
            notes.append(compose("parts-follower-needs-force"))
        return tuple(notes)


def _measure_radii(outer: Outline) -> tuple[float, float]:
    """Return the minimum and maximum distance of an outline from the origin that it encloses."""
    if isinstance(outer, Curve):
        far = np.abs(outer.make_polygon(beyond=True))
        return float(far.min()), float(far.max())
    assert isinstance(outer, Disc)
    return outer.radius, outer.radius


def _normalize(z: complex) -> complex:
    return z / abs(z)
