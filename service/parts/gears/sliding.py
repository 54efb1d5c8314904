"""Parts of a gearbox with sliding gears, in one of its speeds.

The shafts are arranged for all speeds: a sliding gear is checked in all levels that it can occupy. Every gear has a
tooth at its keyway, and whole shafts are rotated so that the engaged pairs mesh. Thus the parts of all speeds are
identical, and only their positions differ.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from kinematics.errors import DimensionError
from kinematics.gear.teeth import Gear
from kinematics.message import compose, join_messages
from service.parts.assembly.colours import LINK_COLOURS
from service.parts.assembly.descriptions import name_material
from service.parts.assembly.fasteners import MATERIALS
from service.parts.assembly.keys import find_key, make_bore
from service.parts.assembly.model import Assembly, Carrier, Part
from service.parts.assembly.sizes import MIN_WALL_PER_PIN, NotMade, PartsQuery, Sizes
from service.parts.gears.clusters import Cluster, make_clusters
from service.parts.gears.housing import Housing, Level, Shaft, describe_support, stack_levels
from service.parts.gears.motion import BodyRotation, TrainMotion
from service.parts.gears.ordinary import MAX_TURNS
from service.parts.gears.sizing import GearSizing, measure_keyway_reach
from service.parts.gears.stand import Arrangement, Clearances, Wheel, find_arrangement
from service.parts.gears.wheels import check_assembly, make_wheel_parts
from service.parts.geometry.regions import Disc, Region
from service.parts.geometry.solids import Prism
from service.render.gears.placement import align_mate
from synthesis.kinds.gearbox.design import GearboxDesign
from synthesis.kinds.gearbox.problem import GearboxProblem

Teeth = tuple[tuple[tuple[int, int], ...], ...]
"""Driver and driven teeth by stage and pair."""


def make_sliding_parts(design: GearboxDesign, problem: GearboxProblem, query: PartsQuery) -> Assembly:
    """Make the parts of a gearbox in the requested speed.

    Parameters
    ----------
    design : GearboxDesign
    problem : GearboxProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If the gearbox has no such speed, or the shafts do not fit.
    """
    speeds = design.metrics.speeds
    number = 1 if query.speed is None else query.speed
    if number > len(speeds):
        raise NotMade(compose("parts-speed-out-of-range", count=len(speeds)), "/query/speed")
    sizing = GearSizing(query, problem.length_unit)
    teeth = tuple(tuple((pair.driver, pair.driven) for pair in stage.pairs) for stage in design.mechanism.stages)
    module, angle = sizing.factor * design.mechanism.module, math.radians(design.mechanism.pressure_angle)
    gears = {count: Gear(count, module, angle) for pairs in teeth for pair in pairs for count in pair}
    sizing.check_size(module * sum(sum(pairs[0]) for pairs in teeth))
    description = compose(
        "parts-speed-shown", number=number, count=len(speeds), speed=f"{speeds[number - 1].speed:.6g}"
    )
    smallest = min(gears.values(), key=lambda gear: gear.root_radius)
    for sizes in sizing.list_sizes(smallest):
        task = _SlidingTask(teeth, gears, tuple(speeds[number - 1].engaged), description, sizes, sizing)
        stand = task.find_stand()
        if stand is not None:
            try:
                return task.build_assembly(stand)
            except DimensionError as error:
                raise NotMade(compose("parts-gears-cannot-be-cut", reason=str(error))) from None
    raise NotMade(
        compose("parts-shafts-obstructed-in-some-speed"), sizing.path,
    )  # fmt: skip


@dataclass(frozen=True)
class _SlidingTask:
    """A gearbox in millimetres, the engaged pair of each stage, and the sizes of its shafts and plates."""

    teeth: Teeth
    gears: dict[int, Gear]
    engaged: tuple[int, ...]
    told: str
    sizes: Sizes
    sizing: GearSizing

    @cached_property
    def clusters(self) -> tuple[Cluster, ...]:
        """All clusters, from below."""
        return make_clusters([len(pairs) for pairs in self.teeth])

    @property
    def highest(self) -> int:
        """Highest level of a wheel."""
        return self.clusters[-1].top

    @cached_property
    def speeds(self) -> tuple[Fraction, ...]:
        """Speed of each shaft relative to the input's; every mesh reverses the direction."""
        found = [Fraction(1)]
        for pairs, engaged in zip(self.teeth, self.engaged, strict=True):
            # Exact fractions avoid drift of the phase.
            found.append(-found[-1] * Fraction(*pairs[engaged]))
        return tuple(found)

    def find_stand(self) -> Arrangement | None:
        """Return the arrangement of the shafts, with each sliding gear in every level that it can occupy, or None."""
        room = Clearances(0.5 * self.sizes.pin, 0.5 * self.sizes.collar, self.sizes.min_gap)
        return find_arrangement(self._place_stage, len(self.teeth), self.highest, room, polygon=False)

    def _place_stage(self, number: int, axis: complex, ahead: complex) -> list[Wheel]:
        """Return all gears of a stage in all their levels; the last one is on the next shaft."""
        found: list[Wheel] = []
        one, other = self.teeth[number][0]
        beyond = axis + (self.gears[one].pitch_radius + self.gears[other].pitch_radius) * ahead
        for cluster in (cluster for cluster in self.clusters if cluster.stage == number):
            for place, pair in enumerate(cluster.pairs):
                driver, driven = self.teeth[number][pair]
                # A sliding gear must be unobstructed in every level.
                for level in cluster.list_levels(place):
                    found.append(self._make_wheel(number, pair, "driver", driver, level, axis))
                found.append(self._make_wheel(number, pair, "driven", driven, cluster.get_fixed_level(place), beyond))
        return found

    def _make_wheel(self, stage: int, pair: int, role: str, teeth: int, level: int, centre: complex) -> Wheel:
        shaft, gear = stage + (role == "driven"), self.gears[teeth]
        message_id = "parts-pair-driver" if role == "driver" else "parts-pair-driven"
        words = compose(message_id, stage=stage + 1, pair=pair + 1, teeth=teeth)
        return Wheel(
            f"gear_{stage + 1}_{pair + 1}_{role}", words, gear, shaft, level, centre, 0.0, gear.tip_radius,
            float(self.speeds[shaft]), 2 * stage + (role == "driven"), play=0.5 * self.sizes.clearance,
        )  # fmt: skip

    def find_key_directions(self, axes: tuple[complex, ...]) -> list[complex]:
        """Return the direction of each shaft's keys with which the engaged pairs mesh."""
        angles = [0.0]
        for stage, (pairs, engaged) in enumerate(zip(self.teeth, self.engaged, strict=True)):
            driver, driven = (self.gears[count] for count in pairs[engaged])
            ahead = cmath.phase(axes[stage + 1] - axes[stage])
            # Each shaft is rotated so that its engaged gear meshes with the previous shaft's.
            angles.append(align_mate(driver, angles[-1], driven, ahead))
        return [cmath.rect(1.0, angle) for angle in angles]

    def build_assembly(self, stand: Arrangement) -> Assembly:
        """Build the assembly of an arrangement and check it for interference."""
        face = self.sizing.choose_face_width(next(iter(self.gears.values())).module, None)
        levels = stack_levels([self.sizes.thickness, *[face] * self.highest, self.sizes.thickness], self.sizes)
        towards = self.find_key_directions(stand.axes)
        shafts = [self._make_shaft(number, stand, way) for number, way in enumerate(towards)]
        around = tuple((wheel.centre, wheel.outer) for wheel in stand.wheels)
        housing = Housing(self.sizes, levels, tuple(shafts), around)
        wheels = {wheel.name: wheel for wheel in stand.wheels}
        parts: list[Part] = []
        for cluster in self.clusters:
            for role in ("driver", "driven"):
                own = []
                for place, pair in enumerate(cluster.pairs):
                    wheel = wheels[f"gear_{cluster.stage + 1}_{pair + 1}_{role}"]
                    level = cluster.get_level(place, self.engaged[cluster.stage]) if role == "driver" else wheel.level
                    own.append(wheel._replace(level=level, tooth_at=cmath.phase(towards[wheel.shaft])))
                made = [
                    part
                    for wheel in own
                    for part in make_wheel_parts(
                        wheel, _make_carrier(wheel.shaft), levels, self.sizes, towards=towards[wheel.shaft]
                    )
                ]
                # Only the sliding gears of a cluster form one piece.
                joined = role == "driver" and len(own) > 1
                parts += self._merge_cluster(cluster, own, made, levels, towards[own[0].shaft]) if joined else made
        size = max(abs(a.centre - b.centre) + a.outer + b.outer for a in wheels.values() for b in wheels.values())
        slowest = min(abs(wheel.speed) * wheel.gear.teeth for wheel in wheels.values())
        bodies = {
            _make_carrier(shaft).link: BodyRotation(axis, float(self.speeds[shaft]))
            for shaft, axis in enumerate(stand.axes)
        }
        motion = TrainMotion(bodies, size, min(math.ceil(1.0 / slowest), MAX_TURNS))
        assembly = Assembly(
            (*parts, *housing.make_parts()), motion, self.highest, 2, self.sizing.factor, self.sizing.query.scale,
            self._list_notes(levels, shafts),
        )  # fmt: skip
        return check_assembly(assembly, self.sizes, self.sizing)

    def _merge_cluster(
        self, cluster: Cluster, wheels: list[Wheel], made: list[Part], levels: tuple[Level, ...], towards: complex
    ) -> list[Part]:
        """Make two gears that slide together, with a hub between them: one piece, or three if cut from sheets."""
        sizes, (lower, upper) = self.sizes, wheels
        name = f"{cluster.stage + 1}_{cluster.pairs[0] + 1}"
        numbers = {"stage": cluster.stage + 1, "first": cluster.pairs[0] + 1, "second": cluster.pairs[1] + 1}
        bore = make_bore(lower.centre, sizes.pin, find_key(sizes.pin), sizes.clearance, towards)
        region = Region(Disc(lower.centre, measure_keyway_reach(sizes) + MIN_WALL_PER_PIN * sizes.pin), (bore,))
        hub = Prism(region, levels[lower.level].high, levels[upper.level].low)
        colour, carrier = LINK_COLOURS[lower.tint % len(LINK_COLOURS)], _make_carrier(lower.shaft)
        material, planes = name_material(MATERIALS[sizes.process][0]), (lower.level, upper.level)
        # Sheets cannot form one piece: the hub is a separate part.
        if sizes.process == "laser":
            between = Part(
                f"hub_{name}", compose("parts-cluster-hub", **numbers), "wheel", carrier, (hub,), towards,
                (lower.level, lower.level), material, colour,
            )  # fmt: skip
            return [made[0], between, made[1]]
        bodies = (*made[0].bodies, hub, *made[1].bodies)
        description = compose("parts-cluster", **numbers, lower=f"{lower.gear.teeth:g}", upper=f"{upper.gear.teeth:g}")
        return [Part(f"cluster_{name}", description, "gear", carrier, bodies, towards, planes, material, colour)]

    def _make_shaft(self, number: int, stand: Arrangement, towards: complex) -> Shaft:
        last = len(self.teeth)
        keyed = [
            cluster.get_fixed_level(place)
            for cluster in self.clusters
            for place in range(len(cluster.pairs))
            if cluster.stage + 1 == number or (cluster.stage == number and not cluster.slides)
        ]
        sliding = [
            (cluster.low, cluster.top) for cluster in self.clusters if cluster.slides and cluster.stage == number
        ]
        if number == 0:
            name = compose("parts-input-shaft")
        elif number == last:
            name = compose("parts-output-shaft")
        else:
            name = compose("parts-numbered-shaft", number=number + 1)
        return Shaft(
            name, _make_carrier(number), stand.axes[number], stand.reaches[number], tuple(keyed),
            ends=number in (0, last), below=number == 0, towards=towards, sliding=tuple(sliding),
        )  # fmt: skip

    def _list_notes(self, levels: tuple[Level, ...], shafts: list[Shaft]) -> tuple[str, ...]:
        pairs = [
            compose(
                "parts-engaged-pair",
                pair=engaged + 1,
                stage=stage + 1,
                driver=teeth[engaged][0],
                driven=teeth[engaged][1],
            )
            for stage, (teeth, engaged) in enumerate(zip(self.teeth, self.engaged, strict=True))
        ]
        ratio = float(1 / abs(self.speeds[-1]))
        notes = [compose("parts-speed-ratio", speed=self.told, pairs=join_messages(pairs, "; "), ratio=f"{ratio:.6g}")]
        if any(cluster.slides for cluster in self.clusters):
            step = levels[2].low - levels[1].low
            notes += [
                compose("parts-other-speeds"),
                compose("parts-cluster-positions", step=f"{step:.4g}"),
                compose("parts-feather-keys-retain"),
            ]
            doubles = any(cluster.slides and len(cluster.pairs) > 1 for cluster in self.clusters)
            if doubles and self.sizes.process == "laser":
                notes.append(compose("parts-cluster-bonded"))
            elif doubles:
                notes.append(compose("parts-cluster-one-piece"))
        for shaft in shafts:
            if shaft.reach != (0, self.highest + 1):
                notes.append(describe_support(shaft.name, lower=shaft.reach[0] == 0))
        return tuple(notes)


def _make_carrier(shaft: int) -> Carrier:
    return Carrier(f"shaft_{shaft + 1}", None)
