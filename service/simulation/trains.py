"""Gear trains as shafts on hinges, coupled by the teeth in mesh.

All parts that rotate as one piece are one body: a shaft with its gears, a ring, a carrier. Each copy of a planet hangs
from its carrier. A mesh is a relation of its teeth. The motion for comparison has the exact speeds of the analysis.
Relations that follow from others, such as those of further planets, are left out, so that none is redundant.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kinematics.gear.arrangements import ARRANGEMENTS
from kinematics.gear.planetary import Mesh
from kinematics.gear.teeth import Gear
from kinematics.message import compose, join_messages
from service.render.gears.gearbox_layout import arrange_gearbox, arrange_layshaft
from service.render.gears.planetary_layout import place_planetary_gears
from service.render.gears.train_layout import place_gears
from service.simulation.course import DEFAULT_RPM, STEP_COUNT
from service.simulation.model import GROUND, Body, Multibody, Relation, Vector, ensure_masses
from service.simulation.naming import Names
from service.simulation.query import TRAIN_TYPES, NotSimulated, SimulationQuery, check_nonzero, refuse_unused
from synthesis.kinds.gear_train.design import GearTrainDesign, GearTrainMechanism
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.verification import build_train
from synthesis.kinds.gearbox.design import GearboxDesign
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.layshaft_gearbox.design import LayshaftDesign
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem
from synthesis.kinds.planetary_train.design import PlanetaryDesign, PlanetaryMechanism, PlanetaryMetrics
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.train_series.design import TrainSeriesDesign
from synthesis.kinds.train_series.problem import TrainSeriesProblem
from synthesis.model.dynamics.bodies import DENSITIES
from synthesis.model.dynamics.request import METRES_PER_UNIT, LengthUnit

FACE_WIDTH_MODULES = 10.0
"""Default face width of gears, modules."""

RIM_WIDTH_MODULES = 4.0
"""Width of a ring gear outside its pitch circle, modules."""

ARM_WIDTH_SHARE = 0.25
"""Width of a carrier's arms as a share of the distance of its pins from the axis."""

Z: Vector = (0.0, 0.0, 1.0)


@dataclass
class _Shaft:
    """Parts that rotate as one piece; lengths in metres."""

    label: str
    speed: float
    place: complex
    axis: Vector = Z
    parent: str = GROUND
    mass: float = 0.0
    inertia: float = 0.0
    radius: float = 0.0
    width: float = 0.0
    marks: list[complex] = field(default_factory=list)


class _Train:
    """Shafts and meshes of a train by name."""

    def __init__(self, unit: LengthUnit, query: SimulationQuery) -> None:
        self.scale = METRES_PER_UNIT[unit] * query.built
        self.shafts: dict[str, _Shaft] = {}
        self.relations: list[tuple[tuple[str, float], ...]] = []
        self.material = query.material or "steel"
        self._face = None if query.thickness is None else METRES_PER_UNIT[unit] * query.thickness

    def add_shaft(self, name: str, speed: float, place: complex, axis: Vector = Z, parent: str = GROUND) -> str:
        """Add a shaft at a place in length units; ``speed`` is relative to the parent, as a multiple of the input's."""
        if name not in self.shafts:
            self.shafts[name] = _Shaft(name, speed, self.scale * place, axis, parent)
        return name

    def add_gear(self, shaft: str, gear: Gear, face: float | None) -> None:
        """Add a gear to a shaft: a disc of its pitch radius, or a ring outside it."""
        one = self.shafts[shaft]
        width = self._face or FACE_WIDTH_MODULES * self.scale * gear.module
        if face is not None:
            width = self.scale * face
        inner, outer = 0.0, self.scale * gear.pitch_radius
        if gear.internal:
            inner, outer = outer, outer + RIM_WIDTH_MODULES * self.scale * gear.module
        mass = DENSITIES[self.material] * math.pi * (outer**2 - inner**2) * width
        one.mass += mass
        one.inertia += 0.5 * mass * (outer**2 + inner**2)
        # The largest gear represents the shaft in the picture.
        if outer > one.radius:
            one.radius, one.width = outer, width

    def add_carrier(self, shaft: str, pins: Iterable[complex]) -> None:
        """Make a shaft a carrier: add an arm from the axis to each pin (length units)."""
        one = self.shafts[shaft]
        for pin in pins:
            length = abs(self.scale * pin)
            width = ARM_WIDTH_SHARE * length
            mass = DENSITIES[self.material] * length * width * width
            one.mass += mass
            one.inertia += mass * (length**2 / 3.0 + width**2 / 12.0)
            one.marks.append(one.place + self.scale * pin)
            one.width = one.width or width

    def add_mesh(self, *terms: tuple[str, float]) -> None:
        """Couple shafts such that the weighted sum of their angles stays 0.

        A relation that follows from earlier ones is left out.
        """
        known = list(self.shafts)
        kept: dict[str, float] = {}
        for name, weight in terms:
            if name != GROUND:
                kept[name] = kept.get(name, 0.0) + weight
        rows = [*self.relations, tuple((name, weight) for name, weight in kept.items() if weight != 0.0)]
        matrix = np.array([[dict(row).get(name, 0.0) for name in known] for row in rows])
        # Scale rows to their largest weight: tooth numbers would bias the rank tolerance.
        matrix /= np.abs(matrix).max(axis=1, keepdims=True)
        # Keep the relation only if it is independent of the previous ones.
        if np.linalg.matrix_rank(matrix) == len(rows):
            self.relations = rows

    def build_machine(self, title: str, driven: str, query: SimulationQuery, remarks: Iterable[str] = ()) -> Multibody:
        """Return the machine over one turn of its driven shaft."""
        refuse_unused(query, "simulation-unused-with-gears", "width", "speed")
        if driven not in self.shafts:
            raise NotSimulated(compose("simulation-train-input-fixed"))
        speed = check_nonzero(query.speed_rpm, "speed_rpm") or DEFAULT_RPM
        rate = speed * math.tau / 60.0
        names = Names()
        called = {name: names.make_name("gear", name) for name in self.shafts} | {GROUND: GROUND}
        bodies, given = ensure_masses(
            tuple(self._make_body(called, shaft) for shaft in self.shafts.values()), self._measure_size()
        )
        times = np.linspace(0.0, math.tau / abs(rate), STEP_COUNT + 1)
        # Speeds are normalized to the driven shaft.
        share = self.shafts[driven].speed
        rates = {called[name]: rate * shaft.speed / share for name, shaft in self.shafts.items()}
        notes = [
            compose("simulation-gears-as-discs", material=self.material, density=f"{DENSITIES[self.material]:g}"),
            *remarks,
            compose("simulation-no-gravity"),
        ]
        if given:
            notes.append(compose("simulation-negligible-masses", bodies=join_messages(given, ", ")))
        return Multibody(
            title=title,
            bodies=bodies,
            closures=(),
            relations=tuple(
                Relation(f"mesh_{number}", tuple((called[name], weight) for name, weight in terms))
                for number, terms in enumerate(self.relations, 1)
            ),
            gravity=(0.0, 0.0, 0.0),
            driven=called[driven],
            speed=rate,
            times=times,
            motion={name: own * times for name, own in rates.items()},
            rates=rates,
            size=self._measure_size(),
            remarks=tuple(notes),
        )

    def _measure_size(self) -> float:
        places = [(shaft.place, shaft.radius) for shaft in self.shafts.values()]
        return max(abs(a - b) + r + s for a, r in places for b, s in places)

    def _make_body(self, called: Mapping[str, str], shaft: _Shaft) -> Body:
        place = (shaft.place.real, shaft.place.imag, 0.0)
        return Body(
            name=called[shaft.label],
            label=shaft.label,
            parent=called[shaft.parent],
            sort="hinge",
            place=place,
            axis=shaft.axis,
            mass=shaft.mass,
            centre=place,
            inertia=shaft.inertia,
            marks=(place, *((mark.real, mark.imag, 0.0) for mark in shaft.marks)),
            radius=0.0 if shaft.marks else shaft.radius,
            width=shaft.width,
        )


def build_gear_train(
    design: GearTrainDesign, problem: GearTrainProblem, title: str, query: SimulationQuery
) -> Multibody:
    """Build the machine of an ordinary train."""
    refuse_unused(query, "simulation-unused-with-gear-train", "gear")
    train = _Train(problem.length_unit, query)
    first, _, remarks = _add_ordinary(train, design.mechanism, problem.reverted, "", 1.0, None)
    return train.build_machine(title, first, query, remarks)


def _add_ordinary(
    train: _Train, mechanism: GearTrainMechanism, reverted: bool, prefix: str, share: float, before: str | None
) -> tuple[str, str, list[str]]:
    """Add the shafts of an ordinary train; return the first shaft, the last one, and remarks."""
    built = build_train(mechanism)
    placed = place_gears(mechanism, reverted)
    axes: list[Vector] = [(float(x), float(y), float(z)) for x, y, z in built.axes]
    first = before or train.add_shaft(f"{prefix}shaft 1", share, placed[0].centre, axes[0])
    # A train in a series starts on the previous train's output shaft, so all centres shift by this offset.
    aside = train.shafts[first].place / train.scale - placed[0].centre
    at = first
    for number, stage in enumerate(built.stages):
        gears = [gear for gear in placed if gear.stage == number + 1]
        face = mechanism.stages[number].face_width
        train.add_gear(at, gears[0].gear, face)
        for n, gear in enumerate(gears[1:], 1):
            last = n == len(gears) - 1
            label = f"{prefix}shaft {number + 2}" if last else f"{prefix}idler {number + 1}.{n}"
            train.add_shaft(label, share * float(gear.speed), gear.centre + aside, axes[number + last])
            train.add_gear(label, gear.gear, face)
            # Both gears of a mesh pass the same number of teeth; the sign follows the directions of the shaft axes.
            train.add_mesh((label, float(gear.count)), (at, -float(stage.sense) * gears[n - 1].count))
            at = label
    crossed = not all(stage.is_parallel for stage in built.stages)
    remarks = [compose("simulation-shafts-side-by-side")] if crossed else []
    return first, at, remarks


def build_planetary_train(
    design: PlanetaryDesign, problem: PlanetaryProblem, title: str, query: SimulationQuery
) -> Multibody:
    """Build the machine of a planetary train."""
    refuse_unused(query, "simulation-unused-with-gear-train", "gear")
    train = _Train(problem.length_unit, query)
    mechanism = design.mechanism
    bodies = _add_planetary(train, mechanism, design.metrics, "", 1.0, 0j, {})
    return train.build_machine(title, bodies[mechanism.input], query)


def _add_planetary(
    train: _Train, mechanism: PlanetaryMechanism, metrics: PlanetaryMetrics, prefix: str, share: float, axis: complex,
    joined: Mapping[str, str],
) -> dict[str, str]:  # fmt: skip
    """Add the bodies of a planetary train about an axis, and return their names by member.

    ``joined`` maps members to existing bodies of another train.
    """
    arrangement, speeds = ARRANGEMENTS[mechanism.arrangement], metrics.speeds
    placed = place_planetary_gears(mechanism)
    if not placed:
        raise NotSimulated(compose("simulation-gears-do-not-fit"))
    # The fixed member is the ground; members joined to another train are its shafts.
    bodies = {mechanism.fixed: GROUND, **joined}
    for member in arrangement.members:
        if member not in bodies:
            bodies[member] = train.add_shaft(prefix + member, share * speeds[member], axis)
    copies: dict[str, dict[int, str]] = {}
    faces = mechanism.face_widths or []
    for gear in placed:
        carrier = arrangement.carriers.get(gear.body)
        plane = gear.planes[0] - 1
        face = faces[plane] if plane < len(faces) else None
        name = bodies.get(gear.body, "")
        if carrier is not None:
            # Every copy of a planet is a body of its own.
            name = f"{prefix}{gear.body.replace('_', ' ')} {gear.copy + 1}"
            centre = gear.centre
            # Bevel planets turn about their arm, all others about the train's axis.
            own: Vector = Z
            if arrangement.bevel:
                ahead = gear.centre / abs(gear.centre)
                own = (ahead.real, ahead.imag, 0.0)
            relative = speeds[gear.body] - speeds[carrier]
            train.add_shaft(name, share * relative, axis + centre, own, bodies[carrier])
            copies.setdefault(gear.body, {})[gear.copy] = name
        if name != GROUND:
            train.add_gear(name, gear.gear, face)
    for carrier in dict.fromkeys(arrangement.carriers.values()):
        if bodies[carrier] != GROUND:
            carried = [gear.centre for gear in placed if arrangement.carriers.get(gear.body) == carrier]
            train.add_carrier(bodies[carrier], dict.fromkeys(carried))
    for copy in range(mechanism.planets):
        for mesh in arrangement.build_train(mechanism.teeth).meshes:
            _add_planet_mesh(train, mesh, bodies, copies, copy)
    return bodies


def _add_planet_mesh(
    train: _Train, mesh: Mesh, bodies: Mapping[str, str], copies: Mapping[str, Mapping[int, str]], copy: int
) -> None:
    """Add the mesh of one copy of the planets; planet angles are relative to their carrier."""
    terms = []
    for body, weight in ((mesh.first, mesh.first_teeth), (mesh.second, -mesh.sense * mesh.second_teeth)):
        if body in copies:
            terms.append((copies[body][copy], float(weight)))
        else:
            terms += [(bodies[body], float(weight)), (bodies[mesh.carrier], -float(weight))]
    train.add_mesh(*terms)


def build_train_series(
    design: TrainSeriesDesign, problem: TrainSeriesProblem, title: str, query: SimulationQuery
) -> Multibody:
    """Build the machine of trains in series: the output of each is the input of the next, about one axis."""
    refuse_unused(query, "simulation-unused-with-gear-train", "gear")
    train = _Train(problem.length_unit, query)
    mechanism, metrics = design.mechanism, design.metrics
    remarks: list[str] = []
    joined: str | None = None
    first = ""
    for number, unit in enumerate(mechanism.units):
        prefix, share = f"unit {number + 1} ", metrics.speeds[number]
        if isinstance(unit, PlanetaryMechanism):
            existing = {} if joined is None else {unit.input: joined}
            # Each unit continues on the output shaft of the previous one.
            axis = 0j if joined is None else train.shafts[joined].place / train.scale
            measured = metrics.units[number]
            assert isinstance(measured, PlanetaryMetrics)
            bodies = _add_planetary(train, unit, measured, prefix, share, axis, existing)
            start, joined = bodies[unit.input], bodies[unit.output]
        else:
            start, joined, added = _add_ordinary(train, unit, problem.units[number].reverted, prefix, share, joined)
            remarks += added
        first = first or start
    return train.build_machine(title, first, query, dict.fromkeys(remarks))


def build_gearbox(design: GearboxDesign, problem: GearboxProblem, title: str, query: SimulationQuery) -> Multibody:
    """Build the machine of a machine-tool gearbox with the gear pairs of one speed engaged."""
    engaged_speed = _get_engaged_number(query, len(design.metrics.speeds))
    found = design.metrics.speeds[engaged_speed - 1]
    train = _Train(problem.length_unit, query)
    layout, mechanism = arrange_gearbox(design.mechanism), design.mechanism
    shares = [1.0]
    for stage, pair in zip(mechanism.stages, found.engaged, strict=True):
        teeth = stage.pairs[pair]
        shares.append(-shares[-1] * teeth.driver / teeth.driven)
    for shaft, share in zip(layout.shafts, shares, strict=True):
        train.add_shaft(shaft.name, share, shaft.centre)
    for gear in layout.gears:
        train.add_gear(layout.shafts[gear.shaft].name, gear.gear, None)
    for number, pair in enumerate(found.engaged):
        one, other = layout.shafts[number].name, layout.shafts[number + 1].name
        teeth = mechanism.stages[number].pairs[pair]
        train.add_mesh((other, float(teeth.driven)), (one, float(teeth.driver)))
    if query.speed_rpm is None:
        query = query.model_copy(update={"speed_rpm": mechanism.input_speed})
    return train.build_machine(
        title,
        "input",
        query,
        [compose("simulation-speed-engaged", number=engaged_speed, count=len(design.metrics.speeds))],
    )


def build_layshaft_gearbox(
    design: LayshaftDesign, problem: LayshaftProblem, title: str, query: SimulationQuery
) -> Multibody:
    """Build the machine of a layshaft gearbox with one gear engaged; reverse comes after the last gear."""
    mechanism = design.mechanism
    count = len(mechanism.gears) + (mechanism.reverse is not None)
    number = _get_engaged_number(query, count)
    train = _Train(problem.length_unit, query)
    layout, head = arrange_layshaft(mechanism), mechanism.head
    # External meshes reverse the direction of rotation.
    on_layshaft = -head.driver / head.driven
    back = mechanism.reverse
    pair = None if number > len(mechanism.gears) else mechanism.gears[number - 1]
    if pair is None:
        assert back is not None
        output = on_layshaft * back.layshaft / back.mainshaft
    elif pair.layshaft is None or pair.mainshaft is None:
        output = 1.0
    else:
        output = -on_layshaft * pair.layshaft / pair.mainshaft
    shares = {"input": 1.0, "layshaft": on_layshaft, "main shaft": output}
    if back is not None:
        shares["idler"] = -on_layshaft * back.layshaft / back.idler
    for shaft in layout.shafts:
        train.add_shaft(shaft.name, shares[shaft.name], shaft.centre)
    for gear in layout.gears:
        train.add_gear(layout.shafts[gear.shaft].name, gear.gear, None)
    train.add_mesh(("layshaft", float(head.driven)), ("input", float(head.driver)))
    if back is not None:
        train.add_mesh(("idler", float(back.idler)), ("layshaft", float(back.layshaft)))
    if pair is None:
        assert back is not None
        train.add_mesh(("main shaft", float(back.mainshaft)), ("idler", float(back.idler)))
    elif pair.layshaft is None or pair.mainshaft is None:
        train.add_mesh(("main shaft", 1.0), ("input", -1.0))
    else:
        train.add_mesh(("main shaft", float(pair.mainshaft)), ("layshaft", float(pair.layshaft)))
    name = "reverse" if pair is None else f"gear {number}"
    remarks = [compose("simulation-gear-engaged", gear=name)]
    return train.build_machine(title, "input", query, remarks)


def _get_engaged_number(query: SimulationQuery, count: int) -> int:
    # Without a choice the first gear is engaged.
    number = 1 if query.gear is None else query.gear
    if number > count:
        raise NotSimulated(compose("simulation-gear-out-of-range", count=count), "/query/gear")
    return number


TRAIN_BUILDERS: dict[str, Callable[[Any, Any, str, SimulationQuery], Multibody]] = dict(
    zip(
        TRAIN_TYPES,
        (build_gear_train, build_planetary_train, build_train_series, build_gearbox, build_layshaft_gearbox),
        strict=True,
    )
)
"""Machine builders of trains, by type of mechanism."""
