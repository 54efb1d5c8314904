"""What the analysis core knows of a given mechanism, for a client: request models, and the answer in degrees.

The answer is plain lists, made for speed; :class:`Analysis` documents it. Where the mechanism cannot be assembled
``valid`` is False and the numbers are NaN, which JSON has as null.
"""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Discriminator, Field, Tag

from kinematics.linkage import Fourbar, barker_type
from kinematics.linkage.classification import BARKER
from kinematics.linkage.drive import MechanismMotion, drive
from kinematics.linkage.instant_centers import instant_centers
from kinematics.linkage.limits import branches, holding_reference, limit_positions, toggles
from kinematics.linkage.mechanism import GROUND, Mechanism, TopologyError
from synthesis.designs import Answer
from synthesis.mechanisms import GivenMechanism
from synthesis.problems import Count, Number, Statement

MOST_POSITIONS = 10_000
"""Positions of one analysis at most; a finer run is asked for in parts."""

RAD_PER_S = math.pi / 30.0
"""One revolution a minute in rad/s."""

Real = NDArray[np.float64]


class _Motion(Statement):
    speed: Number | None = Field(default=None, description="Input speed, rad/s (length unit/s for a driven slider).")
    speed_rpm: Number | None = Field(default=None, description="Input speed, revolutions a minute.")
    acceleration: Number = Field(default=0.0, description="Input acceleration, rad/s².")

    @property
    def rate(self) -> float:
        """Input speed, rad/s; 1 where none is stated, so that rates are by the radian."""
        if self.speed is not None:
            return self.speed
        return 1.0 if self.speed_rpm is None else self.speed_rpm * RAD_PER_S


class Sweep(_Motion):
    """Equal steps of the input from one angle to another, both included."""

    model_config = ConfigDict(populate_by_name=True)

    start: Number = Field(default=0.0, alias="from", description="First input angle, degrees.")
    end: Number = Field(default=360.0, alias="to", description="Last input angle, degrees.")
    steps: Annotated[Count, Field(ge=1, le=MOST_POSITIONS - 1)] = 360

    def inputs(self) -> tuple[Real, Real, Real | None]:
        """Inputs, speeds and no times."""
        at = np.asarray(np.linspace(self.start, self.end, self.steps + 1), np.float64)
        return at, np.full(len(at), self.rate), None


class OnePosition(_Motion):
    """One position of the input."""

    at: Number = Field(description="Input angle, degrees.")

    def inputs(self) -> tuple[Real, Real, Real | None]:
        """Input, speed and no time."""
        return np.array([self.at]), np.array([self.rate]), None


class TimeSpan(Statement):
    """Start, end and step of a run, seconds."""

    start: Number = 0.0
    end: Number
    step: Annotated[float, Field(strict=True, gt=0.0, le=1e9)]


class Run(_Motion):
    """A run in time with constant input acceleration, from an angle at time 0."""

    time: TimeSpan
    at: Number = Field(default=0.0, description="Input angle at time 0, degrees.")

    def inputs(self) -> tuple[Real, Real, Real | None]:
        """Inputs, speeds and times."""
        count = math.floor((self.time.end - self.time.start) / self.time.step * (1.0 + 1e-12)) + 1
        t = np.asarray(self.time.start + self.time.step * np.arange(max(count, 1)), np.float64)
        turned = self.rate * t + 0.5 * self.acceleration * t * t
        return np.asarray(self.at + np.degrees(turned)), np.asarray(self.rate + self.acceleration * t), t


def _motion_tag(statement: Any) -> str:
    if isinstance(statement, dict) and "time" in statement:
        return "<run>"
    return "<position>" if isinstance(statement, dict) and "at" in statement else "<sweep>"


StatedMotion = Annotated[
    Annotated[Sweep, Tag("<sweep>")] | Annotated[OnePosition, Tag("<position>")] | Annotated[Run, Tag("<run>")],
    Discriminator(_motion_tag),
]


class AnalysisRequest(Statement):
    """A mechanism and how it is driven; a full turn in 360 steps by default."""

    model_config = ConfigDict(
        title="Analysis request",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "fourbar",
                        "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
                        "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
                        "coupler_point": {"distance": 6.0, "angle": 30.0},
                        "assembly": "open",
                    },
                    "motion": {"from": 0.0, "to": 360.0, "steps": 360, "speed_rpm": 60.0},
                }
            ]
        },
    )

    mechanism: GivenMechanism
    motion: StatedMotion = Sweep()

    def faults(self) -> list[tuple[str, str]]:
        """What no single field shows: (path, detail)."""
        found = []
        if self.motion.speed is not None and self.motion.speed_rpm is not None:
            found.append(("/motion/speed_rpm", "give the speed in rad/s or in revolutions a minute, not both"))
        if isinstance(self.motion, Run):
            span = self.motion.time
            if span.end < span.start:
                found.append(("/motion/time/end", "the end lies before the start"))
            elif (span.end - span.start) / span.step > MOST_POSITIONS - 1:
                found.append(("/motion/time/step", f"more than {MOST_POSITIONS} positions; take larger steps"))
        return found


class Series(Answer):
    """A quantity over the positions; null where the mechanism cannot be assembled, rates also at toggles."""

    angle: list[float | None]
    omega: list[float | None]
    alpha: list[float | None]
    jerk: list[float | None]


class Track(Answer):
    """A joint over the positions: coordinates and their time derivatives."""

    x: list[float | None]
    y: list[float | None]
    vx: list[float | None]
    vy: list[float | None]
    ax: list[float | None]
    ay: list[float | None]
    jx: list[float | None]
    jy: list[float | None]


class Travel(Answer):
    """A slide over the positions, along its line."""

    position: list[float | None]
    velocity: list[float | None]
    acceleration: list[float | None]
    jerk: list[float | None]


class Points(Answer):
    """A point over the positions."""

    x: list[float | None]
    y: list[float | None]


class Classification(Answer):
    """Grashof and Barker for a fourbar (null for others), and mobility."""

    grashof: str | None
    barker: int | None
    barker_code: str | None
    mobility: int


class BranchRange(Answer):
    """A branch: the input range that it covers; ``full`` where the input turns through."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    start: float = Field(alias="from")
    end: float = Field(alias="to")
    full: bool
    reference: bool = Field(description="Whether the reference configuration lies on it.")


class CircuitBranches(Answer):
    """A circuit and its branches."""

    branches: list[BranchRange]


class Analysis(Answer):
    """Everything the analysis core knows of the mechanism over the motion; degrees, rad/s, length units per second."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    input_angle: list[float]
    time: list[float] | None
    valid: list[bool]
    links: dict[str, Series]
    joints: dict[str, Track]
    slides: dict[str, Travel]
    transmission_angle: list[float | None] = Field(description="Least of the transmission angles, degrees.")
    transmission_angles: dict[str, list[float | None]] = Field(description="At each dyad, by its link.")
    torque_ratio: dict[str, list[float | None]] = Field(
        description="Output torque over input torque without losses: the mechanical advantage of each grounded link."
    )
    instant_centers: dict[str, Points] = Field(
        description="Of every two links, as `link-link`; null where they move parallel. For a single position only."
    )
    classification: Classification
    toggles: list[float]
    circuits: list[CircuitBranches]
    limits: dict[str, list[float] | None] = Field(
        description="Extreme angles (positions) of the grounded links (slides) on the reference's branch; null: turns."
    )


def analyse(request: AnalysisRequest) -> dict[str, Any]:
    """The answer to a request without faults, as plain lists in the shape of :class:`Analysis`.

    Raises
    ------
    MechanismError
        For a mechanism that does not exist.
    """
    mechanism = request.mechanism.mechanism()
    at, speed, time = request.motion.inputs()
    return {
        "time": None if time is None else time.tolist(),
        **analysis(mechanism, at, speed, request.motion.acceleration),
    }


def analysis(mechanism: Mechanism, at: Real, speed: Real, acceleration: float) -> dict[str, Any]:
    """Drive a mechanism to inputs (degrees, or lengths along the input slide) and list all that is known of it."""
    slide = mechanism.driven_by_slide
    motion = drive(mechanism, at if slide else np.radians(at), speed=speed, acceleration=acceleration)
    sines = {link: np.abs(sine) for link, sine in motion.sines.items()}
    transmission = {link: _listed(np.degrees(np.arcsin(np.minimum(sine, 1.0)))) for link, sine in sines.items()}
    with np.errstate(invalid="ignore"):
        least = np.degrees(np.arcsin(np.minimum(np.stack(list(sines.values())).min(axis=0), 1.0))) if sines else None
    return {
        "input_angle": at.tolist(),
        "valid": motion.valid.tolist(),
        "links": {name: _series(jet) for name, jet in motion.angles.items()},
        "joints": {name: _track(jet) for name, jet in motion.joints.items()},
        "slides": {name: _travel(jet) for name, jet in motion.slides.items()},
        "transmission_angle": [math.nan] * len(at) if least is None else _listed(least),
        "transmission_angles": transmission,
        "torque_ratio": _torque_ratios(mechanism, motion),
        "instant_centers": _instant_centers(mechanism, motion) if len(at) == 1 else {},
        "classification": _classification(mechanism),
        **_global(mechanism),
    }


def _listed(values: Real) -> list[float]:
    listed: list[float] = values.tolist()
    return listed


def _series(jet: Real) -> dict[str, list[float]]:
    return {
        "angle": _listed(np.degrees(_unwrapped(jet[0]))),
        "omega": _listed(jet[1]),
        "alpha": _listed(jet[2]),
        "jerk": _listed(jet[3]),
    }


def _unwrapped(angle: Real) -> Real:
    """Angles without jumps of a full turn, the first in (−π, π]; gaps are passed over."""
    known = np.isfinite(angle)
    out = angle.copy()
    if known.any():
        values = np.unwrap(angle[known])
        out[known] = values + (np.angle(np.exp(1j * values[0])) - values[0])
    return out


def _track(jet: NDArray[np.complex128]) -> dict[str, list[float]]:
    names = (("x", "y"), ("vx", "vy"), ("ax", "ay"), ("jx", "jy"))
    return {
        name: _listed(part)
        for pair, row in zip(names, jet, strict=True)
        for name, part in zip(pair, (row.real, row.imag), strict=True)
    }


def _travel(jet: Real) -> dict[str, list[float]]:
    return dict(zip(("position", "velocity", "acceleration", "jerk"), map(_listed, jet), strict=True))


def _torque_ratios(mechanism: Mechanism, motion: MechanismMotion) -> dict[str, list[float]]:
    found = {}
    for name in _grounded(mechanism):
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = motion.input[1] / motion.angles[name][1]
        found[name] = _listed(np.where(np.isfinite(ratio), ratio, np.nan))
    return found


def _instant_centers(mechanism: Mechanism, motion: MechanismMotion) -> dict[str, dict[str, list[float]]]:
    return {
        f"{one}-{other}": {"x": _listed(center.point.real), "y": _listed(center.point.imag)}
        for (one, other), center in instant_centers(mechanism, motion).items()
    }


def _grounded(mechanism: Mechanism) -> list[str]:
    """Links pinned to the ground, but for the input."""
    ground = set(mechanism.links[GROUND])
    return [n for n, listed in mechanism.links.items() if n not in (GROUND, mechanism.input) and ground & set(listed)]


def _classification(mechanism: Mechanism) -> dict[str, Any]:
    kind = 0
    linkage = fourbar_of(mechanism)
    if linkage is not None:
        kind = int(barker_type(linkage))
    row = BARKER[kind - 1] if kind else None
    return {
        "grashof": None if row is None else row.motion,
        "barker": None if row is None else row.type,
        "barker_code": None if row is None else row.code,
        "mobility": mechanism.mobility,
    }


def fourbar_of(mechanism: Mechanism) -> Fourbar | None:
    """The pin-jointed fourbar that a mechanism is, or None."""
    if len(mechanism.links) != 4 or mechanism.slides or mechanism.gears:
        return None
    output = _grounded(mechanism)
    if len(output) != 1:
        return None
    (coupler,) = (n for n in mechanism.links if n not in (GROUND, mechanism.input, output[0]))
    places = []
    for one, other in (
        (GROUND, mechanism.input),
        (mechanism.input, coupler),
        (coupler, output[0]),
        (output[0], GROUND),
    ):
        (joint,) = set(mechanism.links[one]) & set(mechanism.links[other])
        places.append(complex(mechanism.joints[joint]))
    o2, a, b, o4 = places
    if min(abs(a - o2), abs(b - a), abs(b - o4), abs(o4 - o2)) == 0.0:
        return None
    return Fourbar(o2, o4, abs(a - o2), abs(b - a), abs(b - o4))


def _global(mechanism: Mechanism) -> dict[str, Any]:
    """Toggles, circuits and limits; empty where the mechanism's circuits cannot be listed."""
    try:
        found = branches(mechanism)
    except TopologyError:
        return {"toggles": [], "circuits": [], "limits": {}}
    scale = (lambda x: x) if mechanism.driven_by_slide else math.degrees
    here = holding_reference(mechanism, found)
    circuits: dict[int, list[dict[str, Any]]] = {}
    for branch in found:
        listed = circuits.setdefault(branch.circuit, [])
        listed.append(
            {"from": scale(branch.low), "to": scale(branch.high), "full": branch.full, "reference": branch == here}
        )
    limits: dict[str, list[float] | None] = {}
    if here is not None:
        links = _grounded(mechanism)
        slides = [s.joint for s in mechanism.slides if s.link == GROUND and s.joint != mechanism.input]
        angles, travels = limit_positions(mechanism, here, links, slides)
        for name, span in zip(links, angles, strict=True):
            limits[name] = None if span is None else [math.degrees(x) for x in span]
        for name, span in zip(slides, travels, strict=True):
            limits[name] = None if span is None else list(span)
    return {
        "toggles": [scale(x) for x in toggles(mechanism, found)],
        "circuits": [{"branches": listed} for listed in circuits.values()],
        "limits": limits,
    }
