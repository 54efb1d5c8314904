"""Spherical Geneva drives as parts: a hemispherical shell as the wheel, and a crank with a roller aimed at its centre.

The sphere's centre is the origin. The crankshaft lies along x and the wheel's shaft along y, each in two bearing plates
over one base (:mod:`service.parts.gears.upright`); distances along a shaft are measured from the centre. The wheel is
turned; its slots and hollows are milled with tools whose axes point to the centre, so that both are as accurate at the
inside of the shell as at its outside, which is the sphere of the answer. The crank is a disc outside the sphere, in one
piece with its locking cap; the roller's pin is fixed in an inclined hole of the disc, and passes through the shell.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real
from kinematics.indexing.drag_link import CrankCourse
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose
from service.parts.assembly.colours import BLOCK_COLOUR, LINK_COLOURS
from service.parts.assembly.descriptions import name_material, name_part
from service.parts.assembly.fasteners import FASTENER_COLOUR, MATERIALS, PIN_COLOUR
from service.parts.assembly.fit_sizes import Fitting, Trial, find_fault
from service.parts.assembly.interference import find_overlaps
from service.parts.assembly.keys import find_key, make_bore
from service.parts.assembly.model import Assembly, Carrier, Development, Frame, Part, Placement, Sort
from service.parts.assembly.sizes import (
    MILLIMETRES_PER_UNIT,
    MIN_WALL_PER_PIN,
    WIDTH_PER_PIN,
    NotMade,
    PartsQuery,
    Sizes,
)
from service.parts.assembly.standard_parts import name_bar
from service.parts.cam.motion import ShaftMotion, make_rest_placement, make_rotation
from service.parts.gears.housing import Level
from service.parts.gears.upright import FIRST_SHAFT_PLANE, FLOOR_CLEARANCE, Axle, UprightHousing, make_frame
from service.parts.geometry.cut_solids import BoreCut, ConeCut, Cut, CutBody, HalfSpaceCut, SlotCut
from service.parts.geometry.regions import Loop, make_ring
from service.parts.geometry.solids import Body, Prism
from synthesis.kinds.indexing.design import IndexingDesign, SphericalGenevaMechanism
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.mechanisms.geneva import build_drive

CRANK_LINK, WHEEL_LINK = "shaft_1", "shaft_2"
"""Bodies that rotate with either shaft, by the names of the axles."""

ON_ROLLER = Carrier(CRANK_LINK, "roller")
"""Carrier of the parts about the roller's axis, which revolves with the crank."""

MAX_PIN_PER_ROLLER = 0.4
"""Thickest default pin, in roller diameters."""

MIN_BORE_LENGTH, BEARING_SPAN, HUB_WALL = 1.2, 2.5, 0.4
"""Minimum length of a bore, distance between two bearing plates, and wall of a hub, in shaft diameters."""

CRANK_THICKNESS, MIN_SPACER_LENGTH = 1.5, 0.2
"""Thickness of the crank's disc, and minimum length of the spacer between disc and roller, in pin diameters."""

CHECK_COUNT = 216
"""Number of inputs of the final interference check; parts with crossing axes are compared at every third."""

EDGE_POINTS = 33
"""Number of points of half an edge in the development of the wheel."""


@dataclass(frozen=True)
class SphericalMotion(ShaftMotion):
    """Wheel and crank over a turn of the crank since the roller entered.

    Attributes
    ----------
    course : Course
    cone : float
        Angle of the roller's axis from the crank's, radians.
    frames : pair of Frame
        The planes normal to crankshaft and wheel shaft.
    """

    course: CrankCourse
    cone: float
    frames: tuple[Frame, Frame]

    def compute_placement(self, carrier: Carrier, state: Real) -> Placement:
        """Return the displacement of a carrier since the roller entered."""
        if carrier.link == GROUND:
            return make_rest_placement(state)
        if carrier == ON_ROLLER:
            return make_rest_placement(state)._replace(frame=self._find_roller_frame(state))
        frame = self.frames[carrier.link.endswith("2")]
        if carrier.link == CRANK_LINK:
            return make_rotation(state)._replace(frame=frame)
        if carrier.link == WHEEL_LINK:
            return make_rotation(-self.course.wheel_motion(state, 1).s)._replace(frame=frame)
        return make_rest_placement(state)._replace(frame=frame)

    def _find_roller_frame(self, state: Real) -> Frame:
        """Return the plane normal to the roller's axis, which starts directly below the crank's."""
        theta, zero = state - 0.5 * math.pi, np.zeros(state.shape)
        sine, cosine = math.sin(self.cone), np.full(state.shape, math.cos(self.cone))
        along = np.stack([sine * np.cos(theta), sine * np.sin(theta), cosine], axis=-1)
        across = np.stack([-np.sin(theta), np.cos(theta), zero], axis=-1)
        axes = np.stack([across, np.cross(along, across), along], axis=-1)
        return Frame(np.zeros((len(state), 3)), self.frames[0].axes @ axes)


def make_spherical_parts(design: IndexingDesign, problem: IndexingProblem, query: PartsQuery) -> Assembly:
    """Make the parts of a spherical Geneva drive.

    Parameters
    ----------
    design : IndexingDesign
    problem : IndexingProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If the parts do not fit.
    """
    mechanism = design.mechanism
    assert isinstance(mechanism, SphericalGenevaMechanism)
    return _SphericalFitting(mechanism, problem, query).build_assembly()


class _SphericalFitting(Fitting):
    """One request for the parts of a spherical drive."""

    def __init__(self, mechanism: SphericalGenevaMechanism, problem: IndexingProblem, query: PartsQuery) -> None:
        self._mechanism, self._problem = mechanism, problem
        size = 4.0 * mechanism.sphere_radius / math.cos(math.radians(mechanism.cone_angle))
        super().__init__(query, MILLIMETRES_PER_UNIT[problem.length_unit], size)

    @property
    def max_pin(self) -> float:
        """Thickest default pin, as a share of the roller."""
        return MAX_PIN_PER_ROLLER * self._mechanism.roller_diameter

    def try_sizes(self, sizes: Sizes, scale: float) -> Trial:
        """Build the assembly in these sizes."""
        builder = _Builder(self._mechanism, self._problem, sizes, self._unit * scale)
        fault = builder.find_fault()
        if fault:
            return Trial(None, fault)
        assembly = builder.build_assembly(scale)
        fault = find_fault(assembly, sizes, across=False)
        return Trial(None, fault) if fault else Trial(assembly, "")

    def build_assembly(self) -> Assembly:
        """Return the assembly of the request; crossing axes are compared only once, for speed."""
        made = super().build_assembly()
        meeting = find_overlaps(made, CHECK_COUNT)
        if meeting:
            one, other = (name_part(part) for part in meeting[0].parts)
            raise NotMade(
                compose(
                    "parts-parts-collide-at-angle", first=one, second=other, angle=f"{math.degrees(meeting[0].at):.1f}"
                )
            )
        return made


class _Builder:
    """Makes the parts in given sizes; lengths in millimetres, angles in radians."""

    def __init__(
        self, mechanism: SphericalGenevaMechanism, problem: IndexingProblem, sizes: Sizes, factor: float
    ) -> None:
        self._sizes, self._factor, self._stations = sizes, factor, mechanism.stations
        self._course, clearance = build_drive(mechanism), sizes.clearance
        self._step, self._cone = math.pi / mechanism.stations, math.radians(mechanism.cone_angle)
        self._outside = factor * mechanism.sphere_radius
        self._inside = self._outside - sizes.thickness
        self._roller = 0.5 * factor * mechanism.roller_diameter
        # At least a clearance on both sides of the roller.
        self._half_slot = max(0.5 * factor * mechanism.slot_width, self._roller + clearance)
        self._lock = math.radians(mechanism.locking_arc_angle)
        # A clearance as an angle is smallest at the inside of the shell.
        apart = clearance / max(self._inside, clearance)
        self._slot_end = max(math.radians(mechanism.slot_end_angle), self._cone + apart)
        self._cap = min(math.radians(mechanism.cap_angle), self._lock - apart)
        relief = factor * problem.relief
        self._cap_offset = factor * mechanism.cap_offset - relief + max(relief, clearance)
        self._shafts = (
            self._get_sizes(factor * problem.crank_shaft_diameter or sizes.pin),
            self._get_sizes(factor * mechanism.bore or sizes.pin),
        )
        crank, wheel = self._shafts
        self._hub = (0.5 + HUB_WALL) * wheel.pin + find_key(wheel.pin).in_hub
        self._flat = 0.5 * wheel.collar + wheel.min_gap
        self._pocket = 0.5 * crank.collar + crank.min_gap
        self._cap_begins = self._inside * math.cos(self._lock) - sizes.min_gap
        # Start and end along the roller's axis. The end of the crankshaft stays outside the sphere.
        self._reach = (math.sqrt(max(self._inside**2 - self._half_slot**2, 0.0)) - clearance, self._outside + clearance)
        slope = 0.5 * sizes.collar * math.sin(self._cone)
        past = self._reach[1] + sizes.play + MIN_SPACER_LENGTH * sizes.pin
        low = max(self._outside + sizes.min_gap + crank.end, past * math.cos(self._cone) + slope)
        self._disc = low, low + max(sizes.thickness, CRANK_THICKNESS * sizes.pin, MIN_BORE_LENGTH * crank.pin)

    def _get_sizes(self, diameter: float) -> Sizes:
        """Return the sizes of parts on a shaft of a diameter."""
        sizes = self._sizes
        if diameter == sizes.pin:
            return sizes
        return Sizes(sizes.process, WIDTH_PER_PIN * diameter, diameter, sizes.thickness, sizes.clearance)

    def find_fault(self) -> str:
        """Return the reason why something does not fit in the wheel or on the crank, or an empty string."""
        wall, inside, end = MIN_WALL_PER_PIN * self._sizes.pin, self._inside, self._slot_end
        if not 0.5 * self._sizes.collar < self._roller:
            return compose("parts-roller-too-narrow")
        if inside * math.sin(self._step - self._lock) - self._half_slot < wall:
            return compose("parts-shell-wall-beside-slot")
        if 2.0 * (inside * math.cos(end) * math.sin(self._step) - self._half_slot) < wall:
            return compose("parts-shell-wall-between-slots")
        if not self._flat < inside or not self._hub < self._outside:
            return compose("parts-wheel-shaft-too-thick")
        places = (self._hub, math.sqrt(self._outside**2 - self._hub**2)), (self._flat, self._floor)
        if min(height * math.cos(end) - radius * math.sin(end) for radius, height in places) < self._half_slot + wall:
            return compose("parts-hub-between-slots")
        cap = self._cap_begins * math.tan(max(self._cap, 0.0))
        if cap < max(self._pocket + wall, self._cap_offset):
            return compose("parts-cap-around-crankshaft")
        if self._disc[0] * math.tan(self._cone) - 0.5 * self._sizes.hole / math.cos(self._cone) < self._pocket + wall:
            return compose("parts-roller-pin-beside-crankshaft")
        return ""

    @property
    def _floor(self) -> float:
        """Height of the flat inside of the hub."""
        return math.sqrt(self._inside**2 - self._flat**2)

    @property
    def _rim(self) -> float:
        """Radius of the crank's disc."""
        hole = self._disc[1] * math.tan(self._cone) + 0.5 * self._sizes.hole / math.cos(self._cone)
        return hole + 2.0 * MIN_WALL_PER_PIN * self._sizes.pin

    def build_assembly(self, scale: float) -> Assembly:
        """Build the assembly of all parts."""
        axles = self._make_axles()
        sizes = self._sizes
        # The base lies below everything that rotates.
        lowest = max(self._rim, self._outside, *(0.5 * max(each.width, each.collar) for each in self._shafts))
        below = lowest + sizes.min_gap + FLOOR_CLEARANCE * sizes.pin
        parts = (
            self._make_wheel(),
            self._make_crank(),
            *self._make_roller_parts(),
            *UprightHousing(sizes, axles, -below).make_parts(),
        )
        motion = SphericalMotion(
            2.0 * max(axle.levels[-1].high for axle in axles),
            self._course,
            self._cone,
            (axles[0].frame, axles[1].frame),
        )
        return Assembly(parts, motion, FIRST_SHAFT_PLANE + 1, 1, self._factor, scale, self._list_notes())

    def _make_axles(self) -> tuple[Axle, Axle]:
        """Make crankshaft and wheel shaft, each with its wheel next to the centre."""
        top = max(self._floor + MIN_BORE_LENGTH * self._shafts[1].pin, self._outside + self._sizes.min_gap)
        levels, found = (self._disc, (self._floor, top)), []
        for number, (name, sizes) in enumerate(
            zip((compose("parts-crankshaft"), compose("parts-wheel-shaft")), self._shafts, strict=True)
        ):
            near = levels[number][1] + sizes.gap
            far = near + sizes.thickness + max(BEARING_SPAN * sizes.pin, sizes.gap)
            ends = levels[number], (near, near + sizes.thickness), (far, far + sizes.thickness)
            frame = make_frame(np.eye(3)[number], np.zeros(3))
            heights = tuple(Level(*pair) for pair in ends)
            speed = 1.0 / self._stations if number else 1.0
            found.append(Axle(name, number, frame, heights, 0, speed, stub_below=False, sizes=sizes))
        return found[0], found[1]

    def _make_wheel(self) -> Part:
        """Make the shell with its hub, slots and hollows, in the position in which the roller enters a slot."""
        outside, inside, hub, flat = self._outside, self._inside, self._hub, self._flat
        shoulder, floor = math.sqrt(outside**2 - hub**2), self._floor
        top = max(floor + MIN_BORE_LENGTH * self._shafts[1].pin, outside + self._sizes.min_gap)
        corners = (
            complex(inside), complex(outside), complex(hub, shoulder), complex(hub, top), complex(0.0, top),
            complex(0.0, floor), complex(flat, floor),
        )  # fmt: skip
        turns = math.atan2(shoulder, hub), math.atan2(floor, flat)
        profile = Loop(corners, (0.0, math.tan(0.25 * turns[0]), 0.0, 0.0, 0.0, 0.0, -math.tan(0.25 * turns[1])))
        pin = self._shafts[1].pin
        cuts: list[Cut] = [BoreCut(make_bore(0j, pin, find_key(pin), self._sizes.clearance))]
        for k in range(self._stations):
            # As the roller enters, the line of centres lies midway between two slots.
            at = math.pi + (2 * k + 1) * self._step
            cuts.append(SlotCut(at, self._slot_end, self._half_slot, open=True))
            cuts.append(ConeCut(at + self._step, self._lock))
        body = CutBody(profile, tuple(cuts))
        return self._make_part(
            "wheel",
            compose("parts-hemisphere-wheel"),
            Carrier(WHEEL_LINK, None),
            (body,),
            LINK_COLOURS[1],
            1,
            self._make_development(),
        )

    def _make_crank(self) -> Part:
        """Make the disc with its inclined hole, and the cap opposite the roller."""
        low, high = self._disc
        pin, hole = self._shafts[0].pin, 0.5 * self._sizes.hole
        disc = (complex(0.0, low), complex(self._rim, low), complex(self._rim, high), complex(0.0, high))
        bores: tuple[Cut, ...] = (
            BoreCut(make_bore(0j, pin, find_key(pin), self._sizes.clearance)),
            SlotCut(-0.5 * math.pi, 0.5 * math.pi - self._cone, hole, open=False),
        )
        begins, beyond = self._cap_begins, (self._outside + self._sizes.min_gap) * math.cos(self._cap)
        wide = math.tan(self._cap)
        cap = (
            complex(self._pocket, begins), complex(begins * wide, begins), complex(beyond * wide, beyond),
            complex(beyond * wide, low), complex(self._pocket, low),
        )  # fmt: skip
        bodies = (
            CutBody(Loop(disc, (0.0,) * 4), bores),
            CutBody(Loop(cap, (0.0,) * 5), (HalfSpaceCut(0.5 * math.pi, self._cap_offset),)),
        )
        return self._make_part(
            "crank", compose("parts-crank-with-cap"), Carrier(CRANK_LINK, None), bodies, LINK_COLOURS[0], 0
        )

    def _make_part(
        self, name: str, described: str, carrier: Carrier, bodies: tuple[Body, ...], colour: str, number: int,
        unrolled: Development | None = None,
    ) -> Part:  # fmt: skip
        material = name_material(MATERIALS["print" if self._sizes.process == "print" else "mill"][0])
        plane = FIRST_SHAFT_PLANE + number
        return Part(name, described, "cam", carrier, bodies, 1.0 + 0.0j, (plane, plane), material, colour,
                    unrolled=unrolled)  # fmt: skip

    def _make_roller_parts(self) -> list[Part]:
        """Make the roller, its pin, the fastener inside the shell, and the spacer to the crank's disc."""
        sizes, (low, high), plane = self._sizes, self._reach, (FIRST_SHAFT_PLANE, FIRST_SHAFT_PLANE)
        shank, collar, hole = 0.5 * sizes.pin, 0.5 * sizes.collar, 0.5 * sizes.hole
        sine, cosine = math.sin(self._cone), math.cos(self._cone)
        # Neither the spacer nor the end of the pin protrudes from a face of the disc.
        spacer = high + sizes.play, (self._disc[0] - collar * sine) / cosine
        end = (self._disc[1] - shank * sine) / cosine
        steel = name_material(MATERIALS[sizes.process][1])
        bottom = low - sizes.play

        def make_part(
            name: str, what: str, sort: Sort, bodies: Sequence[Prism], colour: str, standard: str = ""
        ) -> Part:
            return Part(
                name, what, sort, ON_ROLLER, tuple(bodies), 1.0 + 0.0j, plane, steel, colour, standard, round=True
            )  # fmt: skip

        found = [
            make_part(
                "roller",
                compose("parts-roller"),
                "block",
                [Prism(make_ring(0j, self._roller, hole), low, high)],
                BLOCK_COLOUR,
            ),
            make_part(
                "spacer_roller",
                compose("parts-spacer"),
                "spacer",
                [Prism(make_ring(0j, collar, hole), *spacer)],
                FASTENER_COLOUR,
            ),
        ]
        if sizes.process == "print":
            stack = [(collar, bottom - sizes.cap, bottom), (shank, bottom, end)]
        else:
            held = sizes.ring
            groove, foot = 0.5 * held.groove, bottom - held.width
            stack = [(shank, foot - held.beyond, foot), (groove, foot, bottom), (shank, bottom, end)]
            around = Prism(make_ring(0j, 0.5 * held.diameter, groove), bottom - held.thickness, bottom)
            found.append(
                make_part(
                    "ring_roller",
                    compose("parts-retaining-ring", pin=compose("parts-roller-pin")),
                    "ring",
                    [around],
                    FASTENER_COLOUR,
                    held.standard,
                )
            )
        bodies = [Prism(make_ring(0j, radius), a, b) for radius, a, b in stack]
        sold = "" if sizes.process == "print" else name_bar(sizes.pin)
        return [*found, make_part("pin_roller", compose("parts-roller-pin"), "pin", bodies, PIN_COLOUR, sold)]

    def _make_development(self) -> Development:
        """Return the outside of the wheel: azimuth and latitude, both times the radius."""
        radius, half, end = self._outside, self._half_slot, self._slot_end
        up = np.linspace(0.0, end, EDGE_POINTS)
        side = np.column_stack([np.sqrt(np.maximum((radius * np.cos(up)) ** 2 - half**2, 0.0)),
                                np.full(EDGE_POINTS, half), radius * np.sin(up)])  # fmt: skip
        turn = np.linspace(0.0, math.pi, EDGE_POINTS)[1:-1]
        out = math.sqrt(radius**2 - half**2)
        tip = np.column_stack([
            out * math.cos(end) - half * np.sin(turn) * math.sin(end),
            half * np.cos(turn),
            out * math.sin(end) + half * np.sin(turn) * math.cos(end),
        ])  # fmt: skip
        # The straight sides end where the round end starts.
        side = side[side[:, 2] < out * math.sin(end)]
        slot = np.concatenate([side, tip, side[::-1] * (1.0, -1.0, 1.0)])
        around = np.linspace(0.0, math.pi, EDGE_POINTS)
        hollow = radius * np.column_stack([
            np.full(EDGE_POINTS, math.cos(self._lock)),
            math.sin(self._lock) * np.cos(around),
            math.sin(self._lock) * np.sin(around),
        ])  # fmt: skip
        # Start in the middle of a land.
        first = 0.5 * (math.asin(half / radius) + self._step - self._lock)
        lines = []
        for k in range(self._stations):
            for name, points, at in (("SLOTS", slot, 0.0), ("HOLLOWS", hollow, self._step)):
                azimuth = np.arctan2(points[:, 1], points[:, 0]) + at + first + 2 * k * self._step
                places = radius * (azimuth + 1j * np.arcsin(points[:, 2] / radius))
                lines.append((name, tuple(places.tolist())))
        return Development(2.0 * math.pi * radius, radius * math.acos(self._hub / radius), tuple(lines))

    def _list_notes(self) -> tuple[str, ...]:
        return (
            compose(
                "parts-spherical-wheel-dimensions",
                inner=f"{2.0 * self._inside:.6g}",
                outer=f"{2.0 * self._outside:.6g}",
                width=f"{2.0 * self._half_slot:.6g}",
                slot=f"{math.degrees(self._slot_end):.5g}",
                hollow=f"{math.degrees(self._lock):.5g}",
            ),
            compose(
                "parts-spherical-crank-dimensions",
                angle=f"{math.degrees(self._cone):.6g}",
                cap=f"{math.degrees(self._cap):.5g}",
                offset=f"{self._cap_offset:.5g}",
            ),
            compose("parts-spherical-wheel-drawing"),
            compose("parts-spherical-input"),
            compose("parts-glue-bearing-plates"),
        )
