"""Parts of ordinary trains on parallel shafts: spur and helical gears, pinions in rings, idlers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from kinematics.errors import DimensionError
from kinematics.gear.train import OrdinaryTrain, TrainStage
from kinematics.message import compose
from service.parts.assembly.model import Assembly, Carrier, Part
from service.parts.assembly.sizes import NotMade, PartsQuery, Sizes
from service.parts.gears.bevel_pair import make_bevel_parts
from service.parts.gears.housing import Housing, Level, Shaft, describe_support, stack_levels
from service.parts.gears.motion import BodyRotation, TrainMotion
from service.parts.gears.sizing import GearSizing
from service.parts.gears.stand import Arrangement, Clearances, Wheel, find_arrangement
from service.parts.gears.wheels import check_assembly, compute_rim_radius, make_wheel_parts
from service.parts.gears.worm_set import make_worm_parts
from service.render.gears.train_layout import place_in_line
from synthesis.kinds.gear_train.design import GearTrainDesign
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.verification import build_train
from synthesis.model.gears.answer import MeshGeometry

MAX_TURNS = 400
"""Maximum number of input turns in the interference check."""


def make_train_parts(design: GearTrainDesign, problem: GearTrainProblem, query: PartsQuery) -> Assembly:
    """Make the parts of an ordinary train.

    Parameters
    ----------
    design : GearTrainDesign
    problem : GearTrainProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If such a train with non-parallel shafts is not available, or the shafts do not fit.
    """
    stages = build_train(design.mechanism).stages
    plays = find_backlash(stages, design.metrics.meshes)
    widths = [stage.face_width for stage in design.mechanism.stages]
    made = OrdinaryParts(
        stages, math.radians(design.mechanism.pressure_angle), plays, widths, problem.reverted, problem.length_unit
    )
    return made.build_assembly(query)


def find_backlash(stages: Sequence[TrainStage], meshes: Sequence[MeshGeometry]) -> list[float]:
    """Return the minimum backlash of each stage's meshes; 0 if unknown."""
    left = [mesh.backlash or 0.0 for mesh in meshes]
    found: list[float] = []
    for stage in stages:
        count = len(stage.gears) - 1
        found.append(min(left[:count]))
        # Meshes are listed stage by stage.
        left = left[count:]
    return found


@dataclass(frozen=True)
class OrdinaryParts:
    """A train whose parts are requested.

    Attributes
    ----------
    stages : sequence of TrainStage
    pressure_angle : float
        Radians.
    backlash : sequence of float
        Backlash of each stage, 0 without.
    face_widths : sequence of float or None
        Face width of each stage.
    reverted : bool
        Whether the output is coaxial with the input.
    length_unit : str
    """

    stages: Sequence[TrainStage]
    pressure_angle: float
    backlash: Sequence[float]
    face_widths: Sequence[float | None]
    reverted: bool
    length_unit: str

    def build_assembly(self, query: PartsQuery) -> Assembly:
        """Return the parts, after an interference check."""
        sizing = GearSizing(query, self.length_unit)
        train = self._scale_train(sizing.factor)
        if not train.is_parallel:
            return self._build_crossing(train, sizing)
        smallest = min((gear for stage in train.stages for gear in stage.cut_gears(train.pressure_angle)
                        if not gear.internal), key=lambda gear: gear.root_radius)  # fmt: skip
        sizing.check_size(2.0 * sum(train.centre_distances))
        for sizes in sizing.list_sizes(smallest):
            task = _OrdinaryTask(self, train, sizes, sizing)
            stand = task.find_stand()
            if stand is not None:
                return task.build_assembly(stand)
        raise NotMade(
            compose("parts-shafts-obstructed-in-every-arrangement"), sizing.path,
        )  # fmt: skip

    def _build_crossing(self, train: OrdinaryTrain, sizing: GearSizing) -> Assembly:
        """Return the parts of a train with non-parallel shafts."""
        if len(train.stages) > 1:
            raise NotMade(compose("parts-crossing-shafts-single-stage"))
        make = make_worm_parts if train.stages[0].kind == "worm" else make_bevel_parts
        return make(train, self.backlash[0], self.face_widths[0], sizing)

    def _scale_train(self, factor: float) -> OrdinaryTrain:
        try:
            return OrdinaryTrain(
                tuple(replace(stage, module=factor * stage.module) for stage in self.stages), self.pressure_angle
            )
        except DimensionError as error:
            raise NotMade(compose("parts-gears-cannot-be-cut", reason=str(error))) from None


@dataclass(frozen=True)
class _OrdinaryTask:
    """A train in millimetres, and the sizes of its shafts and plates."""

    asked: OrdinaryParts
    train: OrdinaryTrain
    sizes: Sizes
    sizing: GearSizing

    @cached_property
    def levels_of(self) -> list[tuple[int, int | None]]:
        """Level of each stage, and of its ring's web, which is on the side of the ring's shaft."""
        found: list[tuple[int, int | None]] = []
        level = 0
        for stage in self.train.stages:
            level += 1
            web = None
            if stage.kind == "internal":
                # The web lies on the side of the ring's shaft, so that the pinion's shaft does not pass it.
                if stage.driver > stage.driven:
                    web, level = level, level + 1
                    found.append((level, web))
                else:
                    found.append((level, level + 1))
                    level += 1
                continue
            found.append((level, web))
        return found

    @property
    def highest(self) -> int:
        """Highest level of a wheel."""
        return max(max(level, web or 0) for level, web in self.levels_of)

    def find_stand(self) -> Arrangement | None:
        """Return the arrangement of all wheels and shafts, or None."""
        room = Clearances(0.5 * self.sizes.pin, 0.5 * self.sizes.collar, self.sizes.min_gap)
        return find_arrangement(self._place_stage, len(self.train.stages), self.highest, room, self.asked.reverted)

    def _place_stage(self, number: int, axis: complex, ahead: complex) -> list[Wheel]:
        """Return the wheels of a stage; shafts of idlers are numbered after those of the train."""
        level, web = self.levels_of[number]
        before = sum(len(one.idlers) for one in self.train.stages[:number])
        wheels = []
        idler = len(self.train.stages) + 1 + before
        # The answer's backlash is increased to the clearance if it is smaller.
        play = 0.5 * max(self.sizes.clearance - self.sizing.factor * self.asked.backlash[number], 0.0)
        for gear in place_in_line(self.train, number, axis, ahead):
            shaft = number + (gear.role == "driven")
            role: str = gear.role
            if gear.role == "idler":
                shaft = idler
                role = f"idler_{idler - len(self.train.stages) - before}"
                idler += 1
            ring = gear.gear.internal
            outer = compute_rim_radius(gear.gear, self.sizes) if ring else gear.gear.tip_radius
            # Gears in external mesh have opposite hands.
            helix = gear.helix_angle * (1.0 if gear.role == "driver" else -1.0)
            words = _describe_gear(role, number + 1, gear.count, ring=ring)
            wheels.append(
                Wheel(
                    f"gear_{number + 1}_{role}", words, gear.gear, shaft, level, gear.centre, gear.tooth_at, outer,
                    float(gear.speed), 2 * number + (role == "driven"), helix, web if ring else None, play,
                    web_described=compose("parts-web-of-ring"),
                )
            )  # fmt: skip
        return wheels

    def build_assembly(self, stand: Arrangement) -> Assembly:
        """Build the assembly of an arrangement and check it for interference."""
        levels = self._make_levels()
        shafts = [self._make_shaft(number, stand) for number in range(len(stand.axes))]
        housing = Housing(
            self.sizes, levels, tuple(shafts), tuple((wheel.centre, wheel.outer) for wheel in stand.wheels)
        )
        parts: list[Part] = []
        for wheel in stand.wheels:
            parts += make_wheel_parts(wheel, Carrier(self._name_body(wheel.shaft), None), levels, self.sizes)
        assembly = Assembly(
            (*parts, *housing.make_parts()), self._make_motion(stand), self.highest, 2, self.sizing.factor,
            self.sizing.query.scale, self._list_notes(stand),
        )  # fmt: skip
        return check_assembly(assembly, self.sizes, self.sizing)

    def _name_body(self, shaft: int) -> str:
        count = len(self.train.stages) + 1
        return f"shaft_{shaft + 1}" if shaft < count else f"idler_{shaft - count + 1}"

    def _describe_shaft(self, number: int) -> str:
        count = len(self.train.stages) + 1
        if number == 0:
            return compose("parts-input-shaft")
        if number == count - 1:
            return compose("parts-output-shaft")
        if number < count:
            return compose("parts-numbered-shaft", number=number + 1)
        return compose("parts-idler-axle", number=number - count + 1)

    def _make_shaft(self, number: int, stand: Arrangement) -> Shaft:
        count = len(self.train.stages) + 1
        name = self._describe_shaft(number)
        # A ring is keyed by its web.
        keyed = [wheel.level if wheel.web is None else wheel.web for wheel in stand.wheels if wheel.shaft == number]
        return Shaft(
            name, Carrier(self._name_body(number), None), stand.axes[number], stand.reaches[number], tuple(keyed),
            ends=number in (0, count - 1), below=number == 0,
        )  # fmt: skip

    def _make_levels(self) -> tuple[Level, ...]:
        heights = [self.sizes.thickness] * (self.highest + 2)
        for number, (level, _) in enumerate(self.levels_of):
            heights[level] = self.sizing.choose_face_width(
                self.train.stages[number].module, self.asked.face_widths[number]
            )
        return stack_levels(heights, self.sizes)

    def _make_motion(self, stand: Arrangement) -> TrainMotion:
        bodies = {self._name_body(wheel.shaft): BodyRotation(wheel.centre, wheel.speed) for wheel in stand.wheels}
        passing = [abs(wheel.speed) * wheel.gear.teeth for wheel in stand.wheels]
        size = max(
            abs(one.centre - other.centre) + one.outer + other.outer for one in stand.wheels for other in stand.wheels
        )
        return TrainMotion(bodies, size, min(math.ceil(1.0 / min(passing)), MAX_TURNS))

    def _list_notes(self, stand: Arrangement) -> tuple[str, ...]:
        notes = [compose("parts-wheels-keyed")]
        for number, reach in enumerate(stand.reaches):
            if reach != (0, self.highest + 1):
                notes.append(describe_support(self._describe_shaft(number), lower=reach[0] == 0))
        return tuple(notes)


def _describe_gear(role: str, stage: int, teeth: int, *, ring: bool) -> str:
    """Return the description of a gear or ring by its role in a stage: driver, driven, or an idler with its number."""
    if role == "driver":
        return compose("parts-ring-driver" if ring else "parts-gear-driver", stage=stage, teeth=teeth)
    if role == "driven":
        return compose("parts-ring-driven" if ring else "parts-gear-driven", stage=stage, teeth=teeth)
    return compose("parts-gear-idler", stage=stage, number=role.removeprefix("idler_"), teeth=teeth)
