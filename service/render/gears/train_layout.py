"""Positions of the gears of an ordinary train: shaft centres in the plane, and rotations in which all teeth mesh.

The shafts lie on one line. Those of a reverted train alternate between two places, or form a triangle for three stages,
so that the output shaft returns to the input's axis. A ring is placed so that its pinion lies towards the previous
shaft.

Shafts that intersect or cross have no common plane: a train with bevel or worm stages has several *views*, side by
side. Stages of parallel shafts are viewed along their axes, bevel stages are cut by the plane of their shafts, worm
stages by the middle plane of the gear.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from kinematics.arrays import Complex
from kinematics.gear.teeth import Gear
from kinematics.gear.train import OrdinaryTrain, TrainStage
from service.render.gears.crossing import Section, make_bevel_sections, make_worm_section
from service.render.gears.placement import PlacedGear, align_mate, enclose_gears
from service.render.page.svg import Box
from synthesis.kinds.gear_train.design import GearTrainMechanism
from synthesis.kinds.gear_train.verification import build_train

DISTANCE_TOLERANCE = 1e-9
"""Relative difference of centre distances due to rounding up to which a reverted train counts as coaxial."""

VIEW_GAP = 0.15
"""Space between two views, as a share of the wider one."""

RIM_WIDTH = 1.0
"""Width of a ring outside its root circle, modules."""


@dataclass(frozen=True)
class TrainGear(PlacedGear):
    """A gear of an ordinary train; ``speed`` is relative to the input's, ``count`` is its number of teeth or threads.

    ``section`` is the section of a gear that is drawn cut along its axis, ``view`` is the number of its view.
    """

    stage: int
    role: str
    speed: Fraction
    count: int = 0
    view: int = 0
    section: Section | None = field(default=None, compare=False)

    @property
    def reach(self) -> float:
        """Radius of the drawn gear about its centre; does not apply to sections."""
        return self.gear.root_radius + RIM_WIDTH * self.gear.module if self.gear.internal else self.gear.tip_radius

    def get_teeth(self) -> Complex | None:
        """Return the outline about the centre: all teeth, or the outline of the section."""
        return super().get_teeth() if self.section is None else self.section.outline

    def get_corners(self) -> Complex:
        """Return corners of a box around the gear."""
        if self.section is None:
            return super().get_corners()
        return self.centre + np.concatenate([self.section.outline, self.section.axis])


def place_gears(mechanism: GearTrainMechanism, reverted: bool) -> list[TrainGear]:
    """Arrange all gears in the order of the power flow; the input shaft, or the apex of its gears, is at 0."""
    train = build_train(mechanism)
    distances = train.centre_distances
    # Unequal distances cannot return to the input's axis.
    coaxial = reverted and max(distances) - min(distances) <= DISTANCE_TOLERANCE * max(distances)
    placed: list[TrainGear] = []
    shaft, view, before = 0j, 0, True
    for number, stage in enumerate(train.stages):
        # A change between parallel and crossing shafts starts a new view.
        if number and not (before and stage.is_parallel):
            shaft, view = 0j, view + 1
        before = stage.is_parallel
        if not stage.is_parallel:
            placed += _place_crossing(train, number, view)
            continue
        ahead = _find_direction(number, len(train.stages), coaxial)
        placed += (replace(gear, view=view) for gear in place_in_line(train, number, shaft, ahead))
        shaft = placed[-1].centre
    return _arrange_views(placed)


def place_in_line(train: OrdinaryTrain, number: int, shaft: complex, ahead: complex) -> Iterator[TrainGear]:
    """Yield the gears of a stage of parallel shafts, from the driver's shaft in the direction ``ahead``."""
    stage, speeds, distance = train.stages[number], train.speeds[number], train.centre_distances[number]
    roles = ["driver", *("idler" for _ in stage.idlers), "driven"]
    # A pinion meshes with the ring around it on the side away from the ring's axis.
    contact = -ahead if stage.kind == "internal" and stage.driver < stage.driven else ahead
    centre, tooth_at = shaft, cmath.phase(contact)
    previous: Gear | None = None
    # Profile shifts change the centre distance: scale the pitch radii to the true distance.
    wide = 1.0
    if stage.shifts != (0.0, 0.0):
        wide = distance / sum(mesh.standard_distance for mesh in train.meshes[number])
    for role, gear, speed, count in zip(roles, stage.cut_gears(train.pressure_angle), speeds, stage.gears, strict=True):
        if previous is not None:
            apart = previous.pitch_radius + gear.pitch_radius
            if stage.kind == "internal":
                apart = abs(previous.pitch_radius - gear.pitch_radius)
            centre += ahead * apart * wide
            tooth_at = align_mate(previous, tooth_at, gear, cmath.phase(contact))
        yield TrainGear(gear, centre, tooth_at, number + 1, role, speed, count, helix_angle=stage.helix_angle)
        previous = gear


def _place_crossing(train: OrdinaryTrain, number: int, view: int) -> list[TrainGear]:
    """Return a bevel or worm stage in a view of its own."""
    stage, (first, last) = train.stages[number], train.speeds[number]
    driver, driven = stage.driver, stage.driven
    if stage.kind == "bevel":
        pair = stage.cones(train.pressure_angle)
        one, two = (
            Gear(teeth, stage.module, train.pressure_angle, math.cos(cone), 1.25 * math.cos(cone))
            for teeth, cone in zip((driver, driven), pair.cones, strict=True)
        )
        sections = make_bevel_sections(pair)
        return [
            TrainGear(one, 0j, 0.0, number + 1, "driver", first, driver, view, sections[0]),
            TrainGear(two, 0j, 0.0, number + 1, "driven", last, driven, view, sections[1]),
        ]
    worm = stage.worm(train.pressure_angle)
    threads = Gear(stage.quotient, stage.module, train.pressure_angle)
    # A space of the gear faces the worm above it.
    facing_worm = 0.5 * math.pi + math.pi / driven
    return [
        TrainGear(
            threads, 1j * worm.centre_distance, 0.0, number + 1, "driver", first, driver, view, make_worm_section(worm)
        ),
        TrainGear(worm.gear, 0j, facing_worm, number + 1, "driven", last, driven, view),
    ]


def _arrange_views(gears: list[TrainGear]) -> list[TrainGear]:
    """Arrange the views of a train side by side, the first in place."""
    placed: list[TrainGear] = []
    right = 0.0
    for view in range(gears[-1].view + 1):
        own = [gear for gear in gears if gear.view == view]
        box = enclose_gears(own)
        aside = 0j if not placed else complex(right + VIEW_GAP * max(box.width, box.height) - box.left)
        right = box.right + aside.real
        placed += (replace(gear, centre=gear.centre + aside) for gear in own)
    return placed


def describe_views(gears: Sequence[TrainGear], stages: Sequence[TrainStage]) -> list[tuple[Box, str]]:
    """Return the caption of each view and the box around it; an empty list for a train in one plane."""
    words = []
    for view in range(gears[-1].view + 1):
        own = [gear for gear in gears if gear.view == view]
        numbers = sorted({gear.stage for gear in own})
        kind = stages[numbers[0] - 1].kind
        named = f"stage {numbers[0]}" if len(numbers) == 1 else f"stages {numbers[0]} to {numbers[-1]}"
        shown = {"bevel": "bevel, in the plane of its shafts", "worm": "worm, in its gear's middle plane"}
        words.append((enclose_gears(own), f"{named}: {shown.get(kind, 'along the shafts')}"))
    return words if any(not stage.is_parallel for stage in stages) else []


def assign_caption_rows(spans: Sequence[tuple[float, float]], apart: float) -> list[int]:
    """Return for each caption its row, from 0, such that captions of a row keep the distance ``apart``."""
    ends: list[float] = []
    rows = []
    for left, right in spans:
        # First row with enough space, or a new row.
        row = next((k for k, end in enumerate(ends) if end + apart <= left), len(ends))
        ends[row : row + 1] = [right]
        rows.append(row)
    return rows


def shift_section(gear: TrainGear, stage: TrainStage, pressure_angle: float, turned: float) -> Complex:
    """Return the outline of a section after a rotation of the input (radians): a worm's threads move along its axis."""
    assert gear.section is not None
    if stage.kind != "worm":
        return gear.section.outline
    worm = stage.worm(pressure_angle)
    # The gear below turns counter-clockwise if its speed is positive, and moves the threads to the left.
    along = -float(gear.speed) * turned * worm.dimensions.lead / math.tau * stage.sense
    return np.asarray(make_worm_section(worm, along).outline)


def _find_direction(number: int, stages: int, coaxial: bool) -> complex:
    """Return the unit vector from one shaft to the next."""
    if not coaxial:
        return 1.0 + 0j
    if stages == 3:
        # Three equal distances close a triangle.
        return cmath.exp(2j * math.pi * number / 3.0)
    # Two places: forwards and backwards in turn.
    return complex((-1) ** number)
