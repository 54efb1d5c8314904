"""Analysis of a planetary train of any arrangement: speeds, degrees of freedom, torques, powers and efficiency.

A train is a known arrangement with its teeth, as in a design, or the client's own list of meshes, each with the bodies
of its gears and the carrier of their axes. Speeds are exact. Contradictory and undetermined speeds are reported.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.gear.planetary import GROUND, Speeds, Train, solve_speeds
from kinematics.gear.power import PowerFlow, solve_power_flow
from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family
from synthesis.analyses.gears.drift import WANTED_DESCRIPTION, Drift, describe_drift
from synthesis.analyses.gears.given_planetary_train import Body, GivenPlanetaryTrain
from synthesis.analyses.gears.planet_strength import describe_mesh_strengths, find_strength_errors
from synthesis.analyses.gears.shift_table import (
    MAX_STATES,
    GivenElement,
    ShiftState,
    build_shift_table,
    count_states,
    find_element_errors,
    list_default_elements,
)
from synthesis.model.answer import Answer, optional_field
from synthesis.model.gears.planet_strength import PAIRS_NOTE, PlanetStrength
from synthesis.model.gears.ratio_target import parse_decimal
from synthesis.model.gears.request import ExactRatio
from synthesis.model.gears.strength import PairStrength
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Number


class PlanetaryAnalysisRequest(DrivenRequest[GivenPlanetaryTrain]):
    """A planetary train, its known speeds, and its load."""

    model_config = ConfigDict(
        title="Planetary train: speeds and torques",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "planetary_train",
                        "arrangement": "simple",
                        "teeth": {"sun": 40, "planet": 20, "ring": 80},
                        "input": "sun",
                        "output": "carrier",
                        "fixed": "ring",
                    },
                    "motion": {"at": 0.0, "speed_rpm": 1500.0},
                    "torques": {"sun": 20.0},
                    "mesh_efficiency": 0.99,
                }
            ]
        },
    )

    speeds: dict[Body, Number] | None = Field(
        default=None,
        max_length=24,
        description="Known speeds by body, all in the same unit; 0 for a body at rest. They replace the input that "
        "turns by `motion` and the fixed member.",
    )
    locked: list[tuple[Body, Body]] = Field(
        default=[], max_length=24, description="Pairs of bodies that a clutch connects."
    )
    torques: dict[Body, Number] | None = Field(
        default=None, max_length=24, description="Known torques from outside by member; null: 1 on the input."
    )
    loads: list[Body] | None = Field(
        default=None,
        max_length=24,
        description="Members that are driven, braked or held from outside; null: those with known speeds or torques, "
        "and the output.",
    )
    mesh_efficiency: Annotated[float, Field(strict=True, gt=0.5, le=1.0)] = Field(
        default=0.99, description="Efficiency of every mesh as an ordinary pair."
    )
    include: list[Literal["shift_table"]] = Field(
        default=[],
        max_length=1,
        description="`shift_table`: the ratio between input and output for each choice of engaged clutches and brakes.",
    )
    elements: list[GivenElement] | None = Field(
        default=None,
        min_length=1,
        max_length=40,
        description="The clutches and brakes of the shift table. Left out: a brake on every member but input and "
        "output, and a clutch between any two. Without the mechanism's `input`, clutches to `input` put the input "
        "shaft on a member.",
    )
    wanted_ratio: ExactRatio | None = Field(default=None, description=WANTED_DESCRIPTION)
    length_unit: Literal["mm", "cm", "m", "in"] = Field(default="mm", description="Unit of the module, for `strength`.")
    strength: PlanetStrength | None = Field(
        default=None,
        description="Stresses of every mesh of an arrangement that has `module` and `planets`, under the given "
        "`torques`, N·m, and at the speed of the first position of the motion; at `face_widths`, or at the minimum "
        f"face widths that keep within the allowable stresses. {PAIRS_NOTE}",
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults = [*self.mechanism.find_errors(), *super().find_errors()]
        return faults or self._find_unknown_bodies()

    def _find_unknown_bodies(self) -> list[tuple[str, str]]:
        """Return errors of names in speeds, clutches, torques and loads that the train lacks."""
        train = self.mechanism.build_train()
        named = [
            *((f"/speeds/{body}", body) for body in self.speeds or ()),
            *((f"/locked/{k}", body) for k, pair in enumerate(self.locked) for body in pair),
            *((f"/mechanism/{part}", getattr(self.mechanism, part)) for part in ("input", "output", "fixed")),
        ]
        known = {*train.bodies, GROUND, None}
        faults = [
            (path, compose("analyses-name-unknown", names=", ".join(train.bodies)))
            for path, body in named
            if body not in known
        ]
        loaded = [
            *((f"/torques/{body}", body) for body in self.torques or ()),
            *((f"/loads/{k}", body) for k, body in enumerate(self.loads or ())),
        ]
        faults += [
            (path, compose("analyses-member-unknown", names=", ".join(train.members)))
            for path, body in loaded
            if body not in train.members
        ]
        if self.speeds is None and self.mechanism.input is None and not self.include:
            faults.append(("/speeds", compose("analyses-known-speeds-missing")))
        return faults or [*self._find_table_errors(), *self._find_ratio_errors(), *self._find_strength_errors()]

    def _find_strength_errors(self) -> list[tuple[str, str]]:
        """Return errors of missing or unsuitable fields if the strength is requested."""
        if self.strength is None:
            return []
        faults = find_strength_errors(self.mechanism, self.strength)
        if self.mechanism.input is None:
            faults.append(("/mechanism/input", compose("analyses-strength-needs-input")))
        if self.speeds is not None:
            faults.append(("/speeds", compose("analyses-strength-excludes-speeds")))
        if self.locked:
            faults.append(("/locked", compose("analyses-strength-excludes-clutches")))
        if not any((self.torques or {}).values()) or float(self.motion.list_inputs()[1][0]) == 0.0:
            faults.append(("/strength", compose("analyses-torque-and-speed-missing")))
        return faults

    def _find_ratio_errors(self) -> list[tuple[str, str]]:
        stated, ratio = self.mechanism.ratio, self.mechanism.compute_ratio()
        if stated is not None and ratio is not None and (faults := stated.find_errors(ratio)):
            return faults
        if self.wanted_ratio is None or (self.mechanism.input is not None and self.mechanism.output is not None):
            return []
        return [("/wanted_ratio", compose("analyses-drift-needs-input-and-output"))]

    def _find_table_errors(self) -> list[tuple[str, str]]:
        """Return errors of a requested shift table."""
        if not self.include:
            return [] if self.elements is None else [("/elements", compose("analyses-elements-need-table"))]
        train, driving, driven = self.mechanism.build_train(), self.mechanism.input, self.mechanism.output
        ends = [(part, body) for part, body in (("input", driving), ("output", driven)) if body is not None]
        faults = [
            (f"/mechanism/{part}", compose("analyses-member-unknown", names=", ".join(train.members)))
            for part, body in ends
            if body not in train.members
        ]
        if driven is None:
            faults.append(("/mechanism/output", compose("analyses-table-needs-output")))
        elif driven == driving:
            faults.append(("/mechanism/output", compose("analyses-output-is-input", member=driven)))
        if driving is None and self.elements is None:
            faults.append(("/elements", compose("analyses-table-needs-input")))
        faults += find_element_errors(train, driving, self.elements or [])
        if not faults and (states := count_states(train, driving, self._list_elements())) > MAX_STATES:
            faults.append(("/elements", compose("analyses-too-many-states", count=states, most=MAX_STATES)))
        return faults

    def _list_elements(self) -> list[GivenElement]:
        """Return the elements of the shift table of a valid request."""
        if self.elements is not None:
            return self.elements
        return list_default_elements(
            self.mechanism.build_train(), str(self.mechanism.input), str(self.mechanism.output)
        )

    def build_table(self) -> list[JsonObject]:
        """Build the shift table of a valid request."""
        mechanism = self.mechanism
        train = mechanism.build_train()
        return build_shift_table(
            train, mechanism.input, str(mechanism.output), self._list_elements(), self.mesh_efficiency
        )

    def build_answer(self) -> JsonObject:
        """Build the answer for the train, in the form of :class:`PlanetaryAnalysis`."""
        return _analyze_train(self)


class TurningBody(Answer):
    """A body and its motion; series are given if the input moves by the requested motion."""

    name: str
    planet: bool
    speed: float | None = Field(
        description="Speed in the unit of the known speeds; null if it does not follow from them."
    )
    exact_speed: str | None = Field(description="Speed as a fraction, e.g. -5/2.")
    torque: float | None = Field(
        description="External torque, positive in the direction of positive speeds; null for planets, which have none."
    )
    power: float | None = Field(description="Torque times speed; positive if power enters.")
    angle: list[float] | None = Field(description="Angle from the position at input angle 0, degrees.")
    omega: list[float] | None = Field(description="rad/s")
    alpha: list[float] | None = Field(description="rad/s²")


class LoadedPlanetaryMesh(Answer):
    """A mesh and its load; power is relative to its carrier, positive if the first gear drives."""

    first: str
    second: str
    carrier: str
    first_torque: float | None
    second_torque: float | None
    rolling_power: float | None
    loss: float | None
    strength: PairStrength | None = optional_field(
        "Stresses of one copy of the mesh, if a method is given; left out for an unloaded mesh."
    )


class PlanetaryAnalysis(DrivenAnalysis):
    """Analysis of a planetary train."""

    valid: list[bool] = Field(description="Whether the known speeds agree with the train and determine all others.")
    freedom: int = Field(description="Number of speeds that can be chosen freely.")
    open_speeds: int = Field(description="Speeds that the known ones do not determine.")
    contradiction: str | None = Field(description="The first known speed that the train does not allow.")
    ratio: float | None = Field(description="Input speed over output speed.")
    exact_ratio: str | None
    efficiency: float | None = Field(description="Output power over input power.")
    self_locking: bool | None
    rolling_power: float | None = Field(description="Largest power of a mesh over the input power, without losses.")
    branch_power: float | None = Field(description="Largest power between a row and a member, over the input power.")
    circulating_power: bool | None = Field(description="A warning: a member carries more power than is put in.")
    bodies: list[TurningBody]
    meshes: list[LoadedPlanetaryMesh]
    notes: list[str] = Field(description="Names of fields without a value, with the reason.")
    shift_table: list[ShiftState] | None = optional_field(
        "Shift table, largest ratio first, if requested by `include`."
    )
    drift: Drift | None = optional_field("Given if a required ratio is given.")


def _analyze_train(request: PlanetaryAnalysisRequest) -> JsonObject:
    """Compute the speeds of all bodies, and torques and powers if all speeds are determined."""
    at, speed, time = request.motion.list_inputs()
    mechanism, train = request.mechanism, request.mechanism.build_train()
    # Given speeds are in the client's unit and need no motion. Otherwise the input turns at speed 1, and all is scaled.
    turning = request.speeds is None and mechanism.input is not None
    known = {body: parse_decimal(value) for body, value in (request.speeds or {}).items()}
    if turning:
        held = {} if mechanism.fixed is None else {mechanism.fixed: Fraction(0)}
        known = {**held, str(mechanism.input): Fraction(1)}
    solution = solve_speeds(train, known, request.locked)
    complete = solution.open == 0 and solution.contradiction is None
    # The direction of the power follows from the torques and the speeds at the first position of the motion. The power
    # flow is solved for an input speed of ±1, because only its sign decides which gear of a mesh drives.
    backwards = turning and float(speed[0]) < 0.0
    flow = _compute_flow(request, train, solution, known, -1 if backwards else 1) if complete else None
    unit = abs(float(speed[0])) if turning else 1.0
    ratio = _compute_ratio(request, solution) if complete else None
    bodies = []
    for body in train.bodies:
        rate = solution.values[body]
        share = None if rate is None else float(rate)
        bodies.append(
            {
                **_describe_body(train, flow, body, rate, float(speed[0]) if turning else 1.0),
                **(
                    request.motion.drive_geared(share, at, speed)
                    if turning and share is not None
                    else dict.fromkeys(("angle", "omega", "alpha"))
                ),
            }
        )
    asked: JsonObject = {"shift_table": request.build_table()} if request.include else {}
    # Without a power flow no strength is described, but each mesh keeps its place in the list.
    strong: list[JsonObject | None] = [None] * len(train.meshes)
    if request.strength is not None and flow is not None:
        drive = request.mechanism, request.strength, train, solution.values, flow, float(speed[0])
        strong = describe_mesh_strengths(*drive, request.length_unit)
    return {
        "input_angle": at.tolist(),
        "time": None if time is None else time.tolist(),
        "valid": [complete] * len(at),
        "freedom": solution.freedom,
        "open_speeds": solution.open,
        "contradiction": solution.contradiction,
        "ratio": None if ratio is None else float(ratio),
        "exact_ratio": None if ratio is None else str(ratio),
        "efficiency": None if flow is None or flow.efficiency is None else float(flow.efficiency),
        "self_locking": None if flow is None else flow.self_locking,
        "rolling_power": None if flow is None else float(flow.largest_rolling_power),
        "branch_power": None if flow is None else float(flow.largest_branch_power),
        "circulating_power": None if flow is None else flow.circulates,
        "bodies": bodies,
        "meshes": [
            {**_describe_mesh(train, flow, k, unit), **({} if strong[k] is None else {"strength": strong[k]})}
            for k in range(len(train.meshes))
        ],
        "notes": _describe_undefined(request, solution, ratio, flow),
        **asked,
        **describe_drift(ratio, request.wanted_ratio),
    }


def _describe_undefined(
    request: PlanetaryAnalysisRequest, solution: Speeds, ratio: Fraction | None, flow: PowerFlow | None
) -> list[str]:
    """Describe results that have no value, with the reason."""
    mechanism, notes = request.mechanism, []
    if solution.contradiction is not None:
        notes.append(compose("analyses-speeds-contradict", body=solution.contradiction))
    elif solution.open:
        notes.append(compose("analyses-speeds-open", count=solution.open))
    elif request.locked:
        notes.append(compose("analyses-torques-of-clutches-unknown"))
    elif flow is None:
        notes.append(compose("analyses-torques-undetermined"))
    elif flow.efficiency is None:
        notes.append(compose("analyses-efficiency-without-power"))
    if ratio is None and mechanism.input is not None and mechanism.output is not None:
        if not solution.open and solution.contradiction is None:
            notes.append(compose("analyses-ratio-of-resting-output"))
    elif ratio is None:
        notes.append(compose("analyses-ratio-without-ends"))
    if request.speeds is not None or mechanism.input is None:
        notes.append(compose("analyses-motion-of-given-speeds"))
    return notes


def _describe_body(
    train: Train, flow: PowerFlow | None, body: str, rate: Fraction | None, input_speed: float
) -> JsonObject:
    """Describe speed, torque and power of a body; ``rate`` is its speed over that of the input."""
    loaded = flow is not None and body not in train.planets
    return {
        "name": body,
        "planet": body in train.planets,
        "speed": None if rate is None else float(rate) * input_speed,
        "exact_speed": None if rate is None else str(rate),
        "torque": float(flow.torques[body]) if flow is not None and loaded else None,
        "power": float(flow.powers[body]) * abs(input_speed) if flow is not None and loaded else None,
    }


def _describe_mesh(train: Train, flow: PowerFlow | None, number: int, input_speed: float) -> JsonObject:
    """Describe torques and powers of a mesh; ``input_speed`` is the magnitude of the input speed."""
    mesh = train.meshes[number]
    loads = None if flow is None else flow.meshes[number]
    return {
        "first": mesh.first,
        "second": mesh.second,
        "carrier": mesh.carrier,
        "first_torque": None if loads is None else float(loads.first_torque),
        "second_torque": None if loads is None else float(loads.second_torque),
        "rolling_power": None if loads is None else float(loads.rolling_power) * input_speed,
        "loss": None if loads is None else float(loads.loss) * input_speed,
    }


def _compute_ratio(request: PlanetaryAnalysisRequest, solution: Speeds) -> Fraction | None:
    """Compute the ratio of input speed to output speed; None if one of them is not named or the output is at rest."""
    one, other = request.mechanism.input, request.mechanism.output
    if one is None or other is None or not solution.values[other]:
        return None
    rates = solution.values[one], solution.values[other]
    return None if rates[0] is None or not rates[1] else rates[0] / rates[1]


def _compute_flow(
    request: PlanetaryAnalysisRequest, train: Train, solution: Speeds, known: dict[str, Fraction], sense: int
) -> PowerFlow | None:
    """Compute torques and powers if the known torques determine them.

    Return None if they do not, or if there are clutches. ``sense`` is the sign of the input speed.
    """
    # The torque that a clutch transmits does not follow from the speeds.
    if request.locked:
        return None
    torques = {body: parse_decimal(value) for body, value in (request.torques or {}).items()}
    if request.torques is None and request.mechanism.input is not None:
        # Without given torques use a unit torque on the input, which suffices for the efficiency and power shares.
        torques = {request.mechanism.input: Fraction(1)}
    loads = request.loads
    if loads is None:
        # By default, members that are named anywhere carry external torques; all others carry none.
        stated = [*known, *torques, request.mechanism.input, request.mechanism.output, request.mechanism.fixed]
        loads = [body for body in dict.fromkeys(stated) if body is not None and body in train.members]
    rates = {body: sense * rate for body, rate in solution.values.items() if rate is not None}
    return solve_power_flow(train, rates, loads, torques, parse_decimal(request.mesh_efficiency))


FAMILY = Family(PlanetaryAnalysisRequest, PlanetaryAnalysis)
