"""Barrel cams as parts: the barrel with its true groove, the follower that slides along its axis, and the base.

From below: the base with a slot for the follower's runner; the follower; its roller, which runs in the groove of the
barrel above. The barrel turns on a shaft along x, in two uprights whose feet are in the base. The uprights and the
parts on the shaft are described in the plane normal to it, whose first direction points down to the roller.

Parts that move in different planes are separated by their sizes: uprights and shaft are outside the follower's path,
and the groove is the envelope of the roller with its clearance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose
from service.parts.assembly.colours import BASE_COLOUR, BLOCK_COLOUR, LINK_COLOURS
from service.parts.assembly.descriptions import describe_name, name_material, name_part
from service.parts.assembly.fasteners import FASTENER_COLOUR, MATERIALS, PinShape, make_fillers, make_pin
from service.parts.assembly.fit_sizes import NARROW_FOR_RUNNER, Fitting, Trial, find_fault
from service.parts.assembly.interference import find_overlaps
from service.parts.assembly.keys import find_key, make_bore, make_key_section, make_shaft_section
from service.parts.assembly.model import Assembly, Carrier, Development, Frame, Part, Placement
from service.parts.assembly.plate_stack import STUB_LENGTH, PlateStack
from service.parts.assembly.sizes import MILLIMETRES_PER_UNIT, MIN_WALL_PER_PIN, NotMade, PartsQuery, Sizes
from service.parts.cam.barrel_groove import Groove
from service.parts.cam.motion import CAM, FOLLOWER, Displacement, ShaftMotion, make_rest_placement, make_rotation
from service.parts.cam.radial import MAX_PIN_PER_ROLLER, ROLLER_COLOUR
from service.parts.geometry.regions import Disc, Loop, Outline, Region, make_polygon, make_ring, widen_hull
from service.parts.geometry.solids import Prism
from service.parts.linkage.builder import measure_keyway_reach
from synthesis.kinds.cam.design import BarrelCamDesign, BarrelCamMechanism
from synthesis.kinds.cam.problem import CamProblem

ON_BARREL, ON_FOLLOWER = Carrier(CAM, None), Carrier(FOLLOWER, None)
UPRIGHT = Carrier(GROUND, "upright")
"""Carrier of the uprights: at rest, in the plane normal to the shaft."""

MIN_EDGE_WIDTH = 1.0
"""Minimum width of a barrel beyond its groove, in shaft diameters."""

FOOT_WIDTH = 2.0
"""Width of the feet of an upright, in its thicknesses."""

MAX_SAG, SAG_CLEARANCE_SHARE = 0.01, 0.1
"""Maximum distance of facets from the groove: millimetres, and share of the roller's clearance."""

CHECK_COUNT = 72
"""Number of inputs of the final interference check; parts with crossing axes are compared at every third."""

WALL_POINTS = 720
"""Number of points of each wall in the barrel's development."""


@dataclass(frozen=True)
class BarrelMotion(ShaftMotion):
    """A barrel on its shaft and a follower that slides along x.

    Attributes
    ----------
    displacement : Displacement
        Millimetres.
    sense : float
        1 if the barrel turns counter-clockwise, seen against x, else −1.
    frame : Frame
        The plane normal to the shaft.
    """

    displacement: Displacement
    sense: float
    frame: Frame

    def compute_placement(self, carrier: Carrier, state: Real) -> Placement:
        """Return the displacement of a carrier from cam angle 0."""
        if carrier == UPRIGHT:
            return make_rest_placement(state)._replace(frame=self.frame)
        if carrier.link == GROUND:
            return make_rest_placement(state)
        if carrier.link == CAM:
            return make_rotation(self.sense * state)._replace(frame=self.frame)
        gone = self.displacement(state) - self.displacement(np.zeros(1))
        return Placement(np.ones(state.shape, np.complex128), np.asarray(gone, np.complex128))


def make_barrel_parts(design: BarrelCamDesign, problem: CamProblem, query: PartsQuery) -> Assembly:
    """Make the parts of a barrel cam.

    Parameters
    ----------
    design : BarrelCamDesign
    problem : CamProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If the roller cannot cut the groove, or the parts do not fit.
    """
    return _BarrelFitting(design.mechanism, query, MILLIMETRES_PER_UNIT[problem.length_unit]).build_assembly()


class _BarrelFitting(Fitting):
    """One request for the parts of a barrel cam."""

    def __init__(self, mechanism: BarrelCamMechanism, query: PartsQuery, unit: float) -> None:
        self._mechanism = mechanism
        lift = max(mechanism.program.s) - min(mechanism.program.s)
        super().__init__(query, unit, max(2.0 * mechanism.cylinder_radius, lift) + lift)
        # A step larger than the radius between two table angles is a jump, not a steep move.
        if max(abs(jump) for jump in np.diff(mechanism.program.s)) > mechanism.cylinder_radius:
            raise NotMade(compose("parts-groove-with-step"))

    @property
    def max_pin(self) -> float:
        """Thickest default pin, as a share of the roller."""
        return MAX_PIN_PER_ROLLER * float(self._mechanism.follower.roller_radius)

    def find_opening(self, sizes: Sizes) -> tuple[float, str]:
        """Return the widest opening: the base has a slot for the runner."""
        return sizes.block[1] + 2.0 * sizes.clearance, NARROW_FOR_RUNNER

    def try_sizes(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in these sizes."""
        builder = _Builder(self._mechanism, sizes, self._unit * scale)
        if not 0.5 * sizes.collar < builder.roller:
            return Trial(None, compose("parts-roller-too-narrow"))
        if builder.groove.floor < measure_keyway_reach(sizes) + MIN_WALL_PER_PIN * sizes.pin:
            return Trial(None, compose("parts-groove-leaves-thin-wall"))
        if not builder.groove.is_sound():
            return Trial(None, compose("parts-groove-undercut"))
        assembly = builder.build_assembly(scale)
        fault = find_fault(assembly, sizes, across=False)
        return Trial(None, fault) if fault else Trial(assembly, "")

    def build_assembly(self) -> Assembly:
        """Return the assembly of the request; crossing axes are compared only once, for speed."""
        made = super().build_assembly()
        meeting = find_overlaps(made, CHECK_COUNT)
        if meeting:
            one, other = (name_part(part) for part in meeting[0].parts)
            raise NotMade(compose("parts-parts-collide", first=one, second=other))
        return made


class _Builder:
    """Makes the parts in given sizes; lengths in millimetres."""

    def __init__(self, mechanism: BarrelCamMechanism, sizes: Sizes, factor: float) -> None:
        self._sizes, self._factor = sizes, factor
        self._stack = PlateStack(sizes, ())
        self._sense = 1.0 if mechanism.rotation == "ccw" else -1.0
        self._displacement = Displacement.from_program(mechanism.program, factor)
        self._middle = factor * mechanism.cylinder_radius
        self.roller = factor * mechanism.follower.roller_radius
        half = 0.5 * sizes.thickness
        self.groove = Groove(
            self._compute_course,
            self.roller + sizes.clearance,
            self._middle - half - sizes.end - sizes.clearance,
            self._middle + half - sizes.clearance,
        )
        self._first = float(self._displacement(np.zeros(1))[0])
        self._least, self._most = self._displacement.extremes
        # The shaft is above the roller, whose middle is at that of its plane.
        self._axis = sum(self._stack.get_level(2)) * 0.5 + self._middle
        self._key = find_key(sizes.pin)
        wide = self.groove.half + MIN_EDGE_WIDTH * sizes.pin
        self._barrel = self._least - wide, self._most + wide
        gap = self._stack.get_level(1)[0]
        self._uprights = (
            (self._barrel[0] - gap - sizes.thickness, self._barrel[0] - gap),
            (self._barrel[1] + gap, self._barrel[1] + gap + sizes.thickness),
        )

    def _compute_course(self, at: Real) -> tuple[Real, Real]:
        """Return the groove over angles of the barrel, which passes under the roller against its rotation."""
        theta = -self._sense * at
        return self._displacement(theta), -self._sense * self._displacement.compute_slope(theta)

    def build_assembly(self, scale: float) -> Assembly:
        """Build the assembly of all parts."""
        # First direction down to the roller, third along the shaft.
        axes = np.column_stack([(0.0, 0.0, -1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)])
        frame = Frame(np.array([0.0, 0.0, self._axis]), axes)
        motion = BarrelMotion(self._measure_size(), self._displacement, self._sense, frame)
        parts = (*self._make_follower(), *self._make_rotating(), *self._make_fixed())
        notes = (
            compose("parts-groove-milling"),
            compose("parts-glue-uprights"),
        )
        return Assembly(parts, motion, 2, 1, self._factor, scale, notes)

    def _measure_size(self) -> float:
        return max(2.0 * self.groove.surface, self._barrel[1] - self._barrel[0])

    # The follower

    def _make_follower(self) -> list[Part]:
        sizes, stack = self._sizes, self._stack
        place = complex(self._first)
        away = sizes.collar + sizes.min_gap
        pins = [place - away, place + away]
        hole, wide = 0.5 * sizes.hole, 0.5 * sizes.block[1]
        plate = Region(widen_hull(pins, 0.5 * sizes.width), tuple(Disc(z, hole) for z in (*pins, place)))
        runner = Region(widen_hull(pins, wide), tuple(Disc(z, hole) for z in pins))
        body = Prism(make_ring(place, self.roller, hole), *stack.get_level(2))
        material = name_material({"print": "PETG", "laser": "sheet", "mill": "steel"}[sizes.process])
        parts = [
            stack.make_plate("follower", compose("parts-follower"), "link", ON_FOLLOWER, plate, 1, LINK_COLOURS[0]),
            stack.make_plate("runner", compose("parts-runner"), "block", ON_FOLLOWER, runner, 0, BLOCK_COLOUR),
            Part(
                "roller",
                compose("parts-roller"),
                "block",
                ON_FOLLOWER,
                (body,),
                1.0 + 0.0j,
                (2, 2),
                material,
                ROLLER_COLOUR,
                round=True,
            ),
            *stack.make_pin("roller", compose("parts-roller-pin"), ON_FOLLOWER, place, (1, 2)),
            *stack.make_fillers("roller", ON_FOLLOWER, place, [(1, 2)]),
        ]
        for n, z in enumerate(pins, 1):
            parts += stack.make_pin(f"guide_{n}", compose("parts-guide-pin", number=n), ON_FOLLOWER, z, (0, 1))
            parts += stack.make_fillers(f"guide_{n}", ON_FOLLOWER, z, [(0, 1)])
        return parts

    # Rotating parts

    def _make_rotating(self) -> list[Part]:
        sizes, pin = self._sizes, self._sizes.pin
        low, high = self._barrel
        # Circumscribed polygon: the meshed bore must not be tighter than the true one.
        bore = make_polygon(make_bore(0j, pin, self._key, sizes.clearance), beyond=True)
        mesh = self.groove.make_barrel(low, high, bore, min(MAX_SAG, SAG_CLEARANCE_SHARE * sizes.clearance))
        material = name_material(MATERIALS["print" if sizes.process == "print" else "mill"][0])
        barrel = Part(
            "barrel",
            compose("parts-grooved-barrel"),
            "cam",
            ON_BARREL,
            (mesh,),
            1.0 + 0.0j,
            (2, 2),
            material,
            LINK_COLOURS[1],
            unrolled=self._make_development(),
        )
        seat = Prism(Region(make_shaft_section(0j, pin, self._key)), low, high)
        ends = self._uprights[0][0], self._uprights[1][1]
        parts = [
            barrel,
            *make_pin(
                "cam",
                compose("parts-camshaft"),
                ON_BARREL,
                0j,
                ends,
                (2, 2),
                sizes,
                PinShape([seat], STUB_LENGTH * pin),
            ),
        ]
        told = self._key.standard and f"{self._key.standard} x {high - low:.4g}"
        key = (Prism(Region(make_key_section(0j, pin, self._key)), low, high),)
        parts.append(
            Part(
                "key_cam",
                compose("parts-key"),
                "key",
                ON_BARREL,
                key,
                1.0 + 0.0j,
                (2, 2),
                name_material(MATERIALS[sizes.process][1]),
                FASTENER_COLOUR,
                told,
            )
        )
        for n, gap in enumerate(((self._uprights[0][1], low), (high, self._uprights[1][0]))):
            parts += make_fillers("cam", ON_BARREL, 0j, gap, (n, n + 1), sizes)
        return parts

    def _make_development(self) -> Development:
        """Return the barrel's unrolled surface, seen from outside: x around it, y along the axis."""
        groove, (low, high) = self.groove, self._barrel
        at = np.linspace(0.0, 2.0 * math.pi, WALL_POINTS + 1)
        lines = []
        for name, side in (("LOWER_WALL", -1), ("UPPER_WALL", 1)):
            wall = groove.compute_wall(at, groove.surface, side)
            lines.append((name, tuple((groove.surface * wall.angle + 1j * (wall.height - low)).tolist())))
        middle = groove.surface * at + 1j * (self._compute_course(at)[0] - low)
        lines.append(("ROLLER", tuple(middle.tolist())))
        return Development(2.0 * math.pi * groove.surface, high - low, tuple(lines))

    # Fixed parts

    def _make_fixed(self) -> list[Part]:
        sizes, stack = self._sizes, self._stack
        notch = 0.5 * max(sizes.width, sizes.collar) + sizes.min_gap
        inner = notch + MIN_WALL_PER_PIN * sizes.pin + sizes.clearance
        outer = inner + FOOT_WIDTH * sizes.thickness
        half = max(outer + 0.5 * sizes.thickness, 0.5 * sizes.width)
        # Coordinates of an upright: distance below the shaft + i · sideways.
        top, floor, foot = -0.5 * sizes.width, self._axis, self._axis + sizes.thickness
        above = floor - stack.get_level(2)[0]
        right = [
            (above, notch), (floor, notch), (floor, inner), (foot, inner), (foot, outer), (floor, outer), (floor, half),
            (top, half),
        ]  # fmt: skip
        corners = [complex(a, b) for a, b in right]
        corners = [*corners, *(z.conjugate() for z in corners[::-1])]
        outline = Loop(tuple(corners), (0.0,) * len(corners))
        parts = []
        for n, (low, high) in enumerate(self._uprights, 1):
            body = Prism(Region(outline, (Disc(0j, 0.5 * sizes.hole),)), low, high)
            parts.append(
                Part(f"upright_{n}", describe_name(f"upright {n}"), "base", UPRIGHT, (body,), 1.0 + 0.0j, (0, 2),
                     name_material(MATERIALS[sizes.process][0]), BASE_COLOUR, like="upright")
            )  # fmt: skip
        away = sizes.collar + sizes.min_gap
        way = [complex(self._least - away), complex(self._most + away)]
        cuts: list[Outline] = [widen_hull(way, 0.5 * sizes.block[1] + sizes.clearance)]
        c = sizes.clearance
        points = list(way)
        for low, high in self._uprights:
            for side in (-1.0, 1.0):
                near, far = sorted((side * (inner - c), side * (outer + c)))
                box = (complex(low - c, near), complex(high + c, near), complex(high + c, far), complex(low - c, far))
                cuts.append(Loop(box, (0.0,) * 4))
                points += box
        parts.append(stack.make_base("base", widen_hull(points, 0.5 * sizes.width), cuts, ()))
        return parts
