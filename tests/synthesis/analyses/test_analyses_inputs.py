"""Each form of input for each type of linkage, as a client states it.

One position, a sweep in equal steps, and a run in time with constant acceleration (Norton's programs FOURBAR, FIVEBAR,
SIXBAR and SLIDER). Positions must keep the constraints of the mechanism, which nothing of the package is asked for;
rates must be the differences of the positions, in a run by the time, in a sweep by the input.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from synthesis.analyses import parse_request
from synthesis.mechanisms import MechanismError
from tests.kinematics.mechanism_sampling import EVERY
from tests.oracles.constraints import Constraints
from tests.oracles.differences import derivative
from tests.support.synthesis.analyses import KINDS, stated

STEPS = 24
WAY = 0.12
"""The input's way in a motion: radians, or parts of the mechanism's size; less on a short branch."""

SPEED, SPEED_UP = 3.0, 0.5
"""Input speed at the start, rad/s (or sizes a second), and the share by which it has risen at the end."""

CLOSE = 2e-8
"""Difference of a rate from that of the positions, as a share of its greatest over the motion and of the scale."""


@dataclass(frozen=True)
class Driven:
    """A mechanism and a motion in the middle of its reference's branch, in the units of the contract."""

    statement: dict[str, Any]
    constraints: Constraints
    reference: float
    slide: bool
    start: float
    way: float
    speed: float
    acceleration: float

    @property
    def duration(self) -> float:
        """Seconds until the way is done."""
        return self.way / (self.speed * (1.0 + 0.5 * SPEED_UP))

    def stated_input(self, way: Any) -> Any:
        """Where the input stands after a way (radians, lengths) from the start: degrees, lengths."""
        return self.start + (way if self.slide else np.degrees(way))

    def misfit(self, found: dict[str, Any]) -> float:
        """Largest misfit of a constraint at the inputs that the answer says, as a share of the size."""
        at = np.array(found["input_angle"])
        unit = self.constraints.size[0]
        way = (at - self.reference) / unit if self.slide else np.radians(at) - self.reference
        every = self.constraints.take(np.zeros(len(at), int))
        return float(every.misfit(joints(found), way).max())


def driven(name: str) -> Driven:
    statement = stated(name)
    request = parse_request({"mechanism": statement})
    mechanism = request.mechanism.build_mechanism()
    slide, reference = mechanism.has_slide_input, float(mechanism.reference_input)
    constraints = Constraints.of(mechanism)
    at = reference if slide else math.degrees(reference)
    listed = parse_request({"mechanism": statement, "motion": {"at": at}}).build_answer()["circuits"]
    (here,) = [branch for circuit in listed for branch in circuit["branches"] if branch["reference"]]
    unit = float(constraints.size[0]) if slide else 1.0
    way = WAY * unit
    if not here["full"]:
        length = here["to"] - here["from"]
        at = (here["from"] if slide else at - (at - here["from"]) % 360.0) + 0.5 * length
        way = min(way, 0.04 * (length if slide else math.radians(length)))
    start = at - 0.5 * (way if slide else math.degrees(way))
    speed = SPEED * unit
    duration = way / (speed * (1.0 + 0.5 * SPEED_UP))
    return Driven(statement, constraints, reference, slide, start, way, speed, SPEED_UP * speed / duration)


def answer(case: Driven, **motion: Any) -> dict[str, Any]:
    """With a point on every link, off the lines of its joints."""
    points = {
        f"on {link['name']}": {"link": link["name"], "distance": 0.4 * case.constraints.size[0], "angle": 50.0}
        for link in case.statement["skeleton"]["links"]
        if link["name"] != "ground"
    }
    request = parse_request({"mechanism": case.statement, "motion": motion, "points": points})
    assert request.find_errors() == []
    found: dict[str, Any] = request.build_answer()
    assert all(found["valid"])
    assert case.misfit(found) < 1e-12
    return found


def joints(found: dict[str, Any], order: str = "", field: str = "joints") -> dict[str, np.ndarray]:
    """Joints as complex numbers; ``order`` is "", "v", "a" or "j"."""
    return {n: np.array(t[f"{order}x"]) + 1j * np.array(t[f"{order}y"]) for n, t in found[field].items()}


def quantities(found: dict[str, Any]) -> list[tuple[str, float, list[np.ndarray]]]:
    """Everything that moves: a name, whether it is a length, and its value with three rates, angles in radians."""
    moving = []
    for name, link in found["links"].items():
        jet = [np.radians(link["angle"]), *(np.array(link[key]) for key in ("omega", "alpha", "jerk"))]
        moving.append((f"link {name}", False, jet))
    for field in ("joints", "points"):
        for name in found[field]:
            jet = [joints(found, order, field)[name] for order in ("", "v", "a", "j")]
            moving.append((f"{field} {name}", True, jet))
    for name, slide in found["slides"].items():
        jet = [np.array(slide[key]) for key in ("position", "velocity", "acceleration", "jerk")]
        moving.append((f"slide {name}", True, jet))
    return moving


def differences(values: np.ndarray, order: int, step: float) -> np.ndarray:
    """Derivatives at all but the outer four of values in equal steps, by the eight around each."""
    n = len(values)

    def shifted(by: float) -> np.ndarray:
        k = round(by / step)
        return values[4 + k : n - 4 + k]

    return derivative(shifted, order, step)


def same_rates(case: Driven, found: dict[str, Any], expected: Any, seconds: float) -> None:
    """Every rate is what ``expected(values, order)`` makes of the positions; ``seconds`` is the motion's own time."""
    size = float(case.constraints.size[0])
    for name, length, jet in quantities(found):
        for order in (1, 2, 3):
            inner = jet[order][4:-4]
            scale = (size if length else 1.0) / seconds**order + np.abs(jet[order]).max()
            gap = np.abs(inner - expected(jet[0], order)).max() / scale
            assert gap < CLOSE * 10.0 ** (order - 1), (name, order, gap)


@pytest.fixture(params=EVERY, scope="module")
def case(request):
    return driven(request.param)


def test_in_a_run_rates_are_those_of_the_positions_in_time(case):
    """θ = θ0 + ω0 t + α t²/2; velocity, acceleration and jerk of links, joints and slides by differences in t."""
    step = case.duration / STEPS
    found = answer(
        case, time={"start": 0.0, "end": case.duration, "step": step}, at=case.start, speed=case.speed,
        acceleration=case.acceleration,
    )  # fmt: skip
    t = np.array(found["time"])
    assert t == pytest.approx(step * np.arange(STEPS + 1))
    gone = case.speed * t + 0.5 * case.acceleration * t * t
    assert gone[-1] == pytest.approx(case.way)
    assert found["input_angle"] == pytest.approx(list(case.stated_input(gone)))
    driver = case.statement["skeleton"]["input_link"]
    rates = (case.speed + case.acceleration * t, np.full(len(t), case.acceleration), np.zeros(len(t)))
    fields = ("velocity", "acceleration", "jerk") if case.slide else ("omega", "alpha", "jerk")
    for field, rate in zip(fields, rates, strict=True):
        given = found["slides" if case.slide else "links"][driver][field]
        assert given == pytest.approx(list(rate), rel=1e-9, abs=1e-9 * case.acceleration)
    same_rates(case, found, lambda values, order: differences(values, order, step), case.duration)
    for kind, ratios, field in (("links", "torque_ratio", "omega"), ("slides", "force_ratio", "velocity")):
        for name, ratio in found[ratios].items():
            power = np.array(ratio) * np.array(found[kind][name][field])
            assert power == pytest.approx(rates[0]), "what goes in comes out"


def test_a_further_point_keeps_its_place_in_its_link(case):
    """At the stated distance and angle from the joint of the link's angle, and as far from all other joints as ever."""
    found = answer(case, **{"from": case.start, "to": float(case.stated_input(case.way))}, steps=STEPS)
    skeleton, places, points = case.statement["skeleton"], joints(found), joints(found, field="points")
    ground = skeleton["links"][0]["joints"]
    assert skeleton["links"][0]["name"] == "ground"
    for link in skeleton["links"][1:]:
        first, second = link["joints"][:2]
        if link["name"] == skeleton["input_link"] and second in ground:
            first, second = second, first
        arm, line = points[f"on {link['name']}"] - places[first], places[second] - places[first]
        assert np.abs(arm) == pytest.approx(0.4 * case.constraints.size[0])
        assert np.degrees(np.angle(arm / line)) == pytest.approx(50.0)
        for joint in link["joints"]:
            assert np.ptp(np.abs(points[f"on {link['name']}"] - places[joint])) < 1e-12 * case.constraints.size[0]


def test_in_a_sweep_rates_are_those_of_the_positions_by_the_input(case):
    """At one speed ω and acceleration α everywhere: v = ω x', a = ω² x'' + α x', j = ω³ x''' + 3 ω α x''."""
    end = float(case.stated_input(case.way))
    found = answer(
        case, **{"from": case.start, "to": end}, steps=STEPS, speed=case.speed, acceleration=case.acceleration
    )
    assert found["time"] is None
    assert found["input_angle"] == pytest.approx(list(np.linspace(case.start, end, STEPS + 1)))
    w, alpha, step = case.speed, case.acceleration, case.way / STEPS

    def expected(values: np.ndarray, order: int) -> np.ndarray:
        first, second, third = (differences(values, k, step) for k in (1, 2, 3))
        return (w * first, w * w * second + alpha * first, w**3 * third + 3.0 * w * alpha * second)[order - 1]

    same_rates(case, found, expected, case.duration)


def test_one_position_is_a_row_of_the_sweep(case):
    motion = {"speed": case.speed, "acceleration": case.acceleration}
    end = float(case.stated_input(case.way))
    swept = answer(case, **{"from": case.start, "to": end}, steps=STEPS, **motion)
    one = answer(case, at=float(swept["input_angle"][STEPS // 2]), **motion)
    assert one["valid"] == [True]
    for (name, length, single), (_, _, every) in zip(quantities(one), quantities(swept), strict=True):
        for order in range(4):
            here, there = single[order][0], every[order][STEPS // 2]
            turn = 0.0 if length or order else 2.0 * math.pi * round((here - there) / (2.0 * math.pi))
            assert here - turn == pytest.approx(there, rel=1e-7, abs=1e-9), (name, order)
    assert one["transmission_angle"] == pytest.approx([swept["transmission_angle"][STEPS // 2]], nan_ok=True)


def test_revolutions_a_minute_are_for_what_turns(case):
    rpm = 60.0 * case.speed / (2.0 * math.pi)
    if case.slide:
        with pytest.raises(MechanismError, match="slider drives"):
            answer(case, at=case.start, speed_rpm=rpm)
        return
    by_rpm, by_radian = answer(case, at=case.start, speed_rpm=rpm), answer(case, at=case.start, speed=case.speed)
    for (_, _, one), (_, _, other) in zip(quantities(by_rpm), quantities(by_radian), strict=True):
        assert one[1] == pytest.approx(other[1], rel=1e-12)
        assert one[3] == pytest.approx(other[3], rel=1e-12)


def test_at_rest_ratios_and_instant_centres_are_those_of_the_position(case):
    """A run from rest: at its start nothing moves yet, but what a torque would bring is known."""
    still, moving = answer(case, at=case.start, speed=0.0, acceleration=2.0), answer(case, at=case.start)
    for name, joint in joints(still, "v").items():
        assert abs(joint[0]) == 0.0, name
    for field in ("torque_ratio", "force_ratio"):
        assert still[field].keys() == moving[field].keys()
        for name, ratio in moving[field].items():
            assert math.isfinite(ratio[0])
            assert still[field][name] == pytest.approx(ratio, rel=1e-9)
    for pair, point in moving["instant_centers"].items():
        for axis in ("x", "y"):
            assert still["instant_centers"][pair][axis] == pytest.approx(point[axis], rel=1e-9, nan_ok=True)


def test_every_type_of_the_contract_is_here():
    """Also the words of the contract: watt and stephenson with each input, drag links, dwells, Peaucellier."""
    named = {KINDS.get(name, name.split()[0]) for name in EVERY}
    assert named >= {
        "fourbar", "slider_crank", "inverted_slider_crank", "crank_shaper", "whitworth", "geared_fivebar", "watt_1",
        "watt_2", "stephenson_1", "stephenson_2", "stephenson_3", "drag_link_rocker", "drag_link_slider",
        "dwell_rocker", "dwell_slider", "dwell_slot", "peaucellier",
    }  # fmt: skip
