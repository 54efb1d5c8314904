"""Parts of two straight bevel gears: a single-stage train whose shafts intersect.

Each gear is overhung: from the apex outwards follow its teeth, its hub and two bearing plates. Its teeth run in
straight lines to the apex, with the profile on the back cone (:func:`~service.parts.gears.teeth.make_bevel_teeth`), and
end on the back cones of the large and the small end. Distances d are measured along a shaft from the apex.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from kinematics.errors import DimensionError
from kinematics.gear.teeth import Gear
from kinematics.gear.train import OrdinaryTrain, TrainStage
from kinematics.message import compose
from service.parts.assembly.colours import LINK_COLOURS
from service.parts.assembly.descriptions import name_material
from service.parts.assembly.fasteners import MATERIALS
from service.parts.assembly.keys import find_key, make_bore
from service.parts.assembly.model import Assembly, Part
from service.parts.assembly.sizes import NotMade, Sizes, round_down
from service.parts.gears.housing import Level
from service.parts.gears.motion import TrainMotion
from service.parts.gears.sizing import DEFAULT_FACE_WIDTH, GearSizing
from service.parts.gears.teeth import make_bevel_teeth
from service.parts.gears.upright import FIRST_SHAFT_PLANE, FLOOR_CLEARANCE, Axle, UprightHousing, make_frame
from service.parts.gears.wheels import check_assembly
from service.parts.geometry.regions import Disc, Region
from service.parts.geometry.solids import Body, Prism, TaperedBody

DEFAULT_FACE_SHARE, MAX_FACE_SHARE = 1.0 / 3.0, 0.5
"""Maximum face width as a share of the cone distance: by default, and in any case."""

ADDENDUM, DEDENDUM = 1.0, 1.25
"""Addendum and dedendum at the large end, modules."""

LARGE_END_EXTENSION, SMALL_END_EXTENSION = 0.5, 0.25
"""Extension of the back cones of large and small end below the roots, modules of that end."""

MIN_BORE_LENGTH, MIN_HUB_LENGTH, BEARING_SPAN = 1.2, 0.5, 2.5
"""Minimum length of a bore, minimum length of a hub, and distance of two bearing plates, in shaft diameters."""

HUB_WALL = 0.4
"""Wall of a hub around its shaft, in shaft diameters."""


def make_bevel_parts(train: OrdinaryTrain, backlash: float, face_width: float | None, sizing: GearSizing) -> Assembly:
    """Make the parts of two bevel gears.

    Parameters
    ----------
    train : OrdinaryTrain
        A single-stage train, in millimetres.
    backlash : float
        Minimum backlash of the answer, in its unit.
    face_width : float or None
        Face width of the answer, in its unit.
    sizing : GearSizing

    Raises
    ------
    NotMade
        If the parts do not fit.
    """
    (stage,) = train.stages
    cones = stage.cones(train.pressure_angle)
    sizing.check_size(2.0 * cones.cone_distance)
    wide = sizing.choose_face_width(stage.module, face_width)
    if sizing.query.face_width is None and face_width is None:
        # Long bevel teeth would become too thin at the small end.
        wide = min(DEFAULT_FACE_WIDTH * stage.module, DEFAULT_FACE_SHARE * cones.cone_distance)
    if wide > MAX_FACE_SHARE * cones.cone_distance:
        most = round_down(MAX_FACE_SHARE * cones.cone_distance / sizing.unit)
        raise NotMade(
            compose("parts-bevel-face-too-wide", largest=f"{most:g}", unit=sizing.words),
            "/query/face_width",
        )
    blanks = [
        Blank(teeth, stage.module, cone, cones.cone_distance, wide)
        for teeth, cone in zip((stage.driver, stage.driven), cones.cones, strict=True)
    ]
    # The smaller uncut core limits the shaft.
    core = min(blank.core for blank in blanks)
    # A spur gear with the same root radius stands for the core.
    smallest = Gear(2.0 * (core / stage.module + DEDENDUM), stage.module, train.pressure_angle)
    refused = None
    for sizes in sizing.list_sizes(smallest):
        play = 0.5 * max(sizes.clearance - sizing.factor * backlash, 0.0)
        try:
            return _Pair(stage, train.pressure_angle, (blanks[0], blanks[1]), play, sizes, sizing).build_assembly()
        except DimensionError as error:
            raise NotMade(compose("parts-gears-cannot-be-cut", reason=str(error))) from None
        except NotMade as error:
            # Try the next thinner shaft; report the last refusal if none works.
            refused = error
    assert refused is not None
    raise refused


@dataclass(frozen=True)
class Blank:
    """A bevel gear before its teeth are cut: radii and distances d as complex numbers, radius + i d.

    Attributes
    ----------
    teeth : int
    module : float
        Module at the large end, millimetres.
    cone : float
        Pitch cone angle, radians.
    distance, face_width : float
        Cone distance of the large end, and the length of the teeth along it.
    """

    teeth: int
    module: float
    cone: float
    distance: float
    face_width: float

    def find_back_cone_point(self, height: float) -> complex:
        """Return a point of the back cone of the large end, ``height`` modules above the pitch cone."""
        pitch = self.distance * complex(math.sin(self.cone), math.cos(self.cone))
        return pitch + height * self.module * complex(math.cos(self.cone), -math.sin(self.cone))

    @property
    def share(self) -> float:
        """Ratio of the small end's size to that of the large end."""
        return 1.0 - self.face_width / self.distance

    @property
    def corners(self) -> tuple[complex, complex, complex, complex]:
        """Inner and outer corner of the small end, outer and inner corner of the large end."""
        return (
            self.share * self.find_back_cone_point(-DEDENDUM - SMALL_END_EXTENSION),
            self.share * self.find_back_cone_point(ADDENDUM),
            self.find_back_cone_point(ADDENDUM),
            self.find_back_cone_point(-DEDENDUM - LARGE_END_EXTENSION),
        )

    @property
    def core(self) -> float:
        """Maximum radius that remains uncut."""
        return self.corners[0].real

    @property
    def cones(self) -> tuple[float, float]:
        """Angles of the tip cone and the root cone, radians."""
        tip, root = (math.atan(height * self.module / self.distance) for height in (ADDENDUM, DEDENDUM))
        return self.cone + tip, self.cone - root

    def make_virtual_gear(self, pressure_angle: float) -> Gear:
        """Return the spur gear of the back cone."""
        return Gear(self.teeth / math.cos(self.cone), self.module, pressure_angle, ADDENDUM, DEDENDUM)


@dataclass(frozen=True)
class _Pair:
    """Two gears whose shafts intersect at 0, in millimetres."""

    stage: TrainStage
    pressure_angle: float
    blanks: tuple[Blank, Blank]
    play: float
    sizes: Sizes
    sizing: GearSizing

    def build_assembly(self) -> Assembly:
        """Build the assembly and check it for interference."""
        sizes = self.sizes
        tips = [blank.corners[2] for blank in self.blanks]
        below = (
            max(*(tip.real for tip in tips), 0.5 * sizes.width, 0.5 * sizes.collar)
            + sizes.min_gap
            + FLOOR_CLEARANCE * sizes.pin
        )
        parts = [self._make_gear(number) for number in range(2)]
        parts += UprightHousing(sizes, self.axles, -below).make_parts()
        size = 2.0 * max(abs(axle.levels[end].low) for axle in self.axles for end in (0, -1))
        motion = TrainMotion(self.axles[0].bodies | self.axles[1].bodies, size, math.ceil(1.0 / self.stage.driver))
        assembly = Assembly(
            tuple(parts),
            motion,
            FIRST_SHAFT_PLANE + 1,
            1,
            self.sizing.factor,
            self.sizing.query.scale,
            self._list_notes(),
        )
        return check_assembly(assembly, sizes, self.sizing)

    def _measure_hub(self, number: int) -> tuple[float, float, float]:
        """Return the distances of a gear's start, of its hub's start, and of its hub's end."""
        front, *_, back = (corner.imag for corner in self.blanks[number].corners)
        # The bore through teeth and hub needs a minimum length.
        length = max(MIN_HUB_LENGTH * self.sizes.pin, MIN_BORE_LENGTH * self.sizes.pin - (back - front))
        return front, back, back + length

    @cached_property
    def axles(self) -> tuple[Axle, Axle]:
        """Both shafts: the driver's along x to the apex, the driven one's away from there."""
        sizes, angle = self.sizes, self.stage.shaft_angle
        found = []
        for number, name in enumerate((compose("parts-input-shaft"), compose("parts-output-shaft"))):
            front, _, end = self._measure_hub(number)
            near = end + sizes.gap
            far = near + sizes.thickness + max(BEARING_SPAN * sizes.pin, sizes.gap)
            outwards = [(front, end), (near, near + sizes.thickness), (far, far + sizes.thickness)]
            along = np.array([-math.cos(angle), math.sin(angle), 0.0])
            levels = tuple(Level(*pair) for pair in outwards)
            if number == 0:
                along = np.array([1.0, 0.0, 0.0])
                # The driver points towards the apex: its heights are negative.
                levels = tuple(Level(-high, -low) for low, high in reversed(outwards))
            speed = 1.0 if number == 0 else self.stage.driver / self.stage.driven
            frame = make_frame(along, np.zeros(3))
            found.append(Axle(name, number, frame, levels, 0 if number else 2, speed, stub_below=number == 0))
        return found[0], found[1]

    def _make_gear(self, number: int) -> Part:
        blank, sizes, axle = self.blanks[number], self.sizes, self.axles[number]
        _, back, end = self._measure_hub(number)
        # Heights are signed distances; those of the driver are negative.
        way = 1.0 if number else -1.0
        at = way * blank.corners[2].imag
        # A space of the driven gear faces a tooth of the driver.
        tooth_at = math.pi / blank.teeth if number else 0.0
        teeth = make_bevel_teeth(
            blank.make_virtual_gear(self.pressure_angle), blank.teeth, blank.cone, abs(at), tooth_at, self.play
        )
        bore = make_bore(0j, sizes.pin, find_key(sizes.pin), sizes.clearance)
        inner, tip, large, rim = blank.corners
        outline = [complex(0.0, inner.imag), inner, tip, large, rim, complex(0.0, rim.imag)]
        if number == 0:
            # Mirroring reverses the orientation: reverse the order as well.
            outline = [z.conjugate() for z in reversed(outline)]
        hub = Region(Disc(0j, min(rim.real, (0.5 + HUB_WALL) * sizes.pin + find_key(sizes.pin).in_hub)), (bore,))
        low, high = sorted((way * back, way * end))
        bodies: tuple[Body, ...] = (
            TaperedBody(Region(teeth, (bore,)), tuple(outline), 0.0, at, blank.teeth),
            Prism(hub, low, high),
        )
        role = "driven" if number else "driver"
        described = compose("parts-bevel-driven" if number else "parts-bevel-driver", teeth=blank.teeth)
        return Part(
            f"gear_1_{role}", described, "gear", axle.carrier, bodies, 1.0 + 0.0j,
            (axle.plane, axle.plane), name_material(MATERIALS[sizes.process][1]), LINK_COLOURS[number],
        )  # fmt: skip

    def _list_notes(self) -> tuple[str, ...]:
        notes = [
            compose(
                "parts-bevel-dimensions",
                angle=f"{math.degrees(self.stage.shaft_angle):.6g}",
                distance=f"{self.blanks[0].distance:.6g}",
                width=f"{self.blanks[0].face_width:.6g}",
                module=f"{self.stage.module:.6g}",
            )
        ]
        for number, (message_id, blank) in enumerate(
            zip(("parts-bevel-driver-sizes", "parts-bevel-driven-sizes"), self.blanks, strict=True)
        ):
            tip, root = (math.degrees(angle) for angle in blank.cones)
            notes.append(
                compose(
                    message_id,
                    teeth=blank.teeth,
                    pitch=f"{math.degrees(blank.cone):.4f}",
                    tip=f"{tip:.4f}",
                    root=f"{root:.4f}",
                    diameter=f"{2.0 * blank.corners[2].real:.6g}",
                    distance=f"{self._measure_hub(number)[2]:.6g}",
                )
            )
        notes.append(compose("parts-glue-bearing-plates"))
        return tuple(notes)
