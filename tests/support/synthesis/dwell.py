"""Code that several tests share: dwell."""

from __future__ import annotations

import math

import numpy as np

from synthesis.kinds.dwell.design import DwellDesign
from synthesis.kinds.dwell.problem import DwellProblem
from tests.oracles.loops import Loops
from tests.oracles.positions import meet


def rocker(swing: float) -> dict[str, object]:
    return {"type": "rocker", "swing": swing}


def slider(stroke: float) -> dict[str, object]:
    return {"type": "slider", "stroke": stroke}


def output_over_a_turn(design: DwellDesign, steps: int) -> np.ndarray:
    """Output (degrees, or length) from the lengths alone: pins by circles, the slot by an angle, a triad by loops."""
    mechanism = design.mechanism
    if mechanism.type == "dwell_stephenson_2":
        return np.degrees(Loops(mechanism.skeleton.model_dump()).turned(steps)["output"])
    joints = {name: complex(*z) for name, z in mechanism.skeleton.joints.items()}
    start = np.angle(joints["A"] - joints["O2"])
    links, point = mechanism.links, mechanism.coupler_point
    a = joints["O2"] + links["input"] * np.exp(1j * (start + np.linspace(0.0, 2.0 * np.pi, steps)))

    def side(one: str, other: str, pin: str) -> int:
        base, arm = joints[other] - joints[one], joints[pin] - joints[one]
        return 1 if (base.conjugate() * arm).imag > 0.0 else -1

    b = meet(a, joints["O4"], links["coupler"], links["rocker"], side("A", "O4", "B"))
    if point is None:
        on_rocker = (joints["P"] - joints["O4"]) / (joints["B"] - joints["O4"])
        p = joints["O4"] + on_rocker * (b - joints["O4"])
    else:
        p = a + point.distance * np.exp(1j * math.radians(point.angle)) * (b - a) / links["coupler"]
    assert np.isfinite(p).all()
    if mechanism.type == "dwell_slot":
        return np.degrees(np.unwrap(np.angle(p - joints["O6"])))
    if mechanism.type in ("dwell_rocker", "dwell_watt_rocker"):
        d = meet(p, joints["O6"], links["link_5"], links["output"], side("P", "O6", "D"))
        return np.degrees(np.unwrap(np.angle(d - joints["O6"])))
    (slide,) = mechanism.skeleton.slides
    along = np.exp(1j * math.radians(slide.angle))
    local = (p - complex(*slide.point)) * along.conjugate()
    at = (joints["P"] - complex(*slide.point)) * along.conjugate()
    sign = 1.0 if at.real < 0.0 else -1.0
    return local.real + sign * np.sqrt(links["link_5"] ** 2 - local.imag**2)


def assert_measured(problem: DwellProblem, design: DwellDesign) -> None:
    """Way, jitter, widths and accelerations of a design against another route to its motion."""
    assert design.verification.passed
    steps = 7201
    out = output_over_a_turn(design, steps)
    assert abs(out[-1] - out[0]) < 1e-6 * problem.way
    assert np.isclose(np.ptp(out), problem.way, rtol=1e-5)
    per = (steps - 1) / 360.0
    start = design.mechanism.reference_input_angle
    periodic = np.concatenate([out[:-1], out[:-1]])
    for rest in design.targets:
        first = round(((rest.input_angle - start) % 360.0) * per)
        demanded = problem.dwell_requests[rest.index].angle
        held = periodic[first : first + round(demanded * per) + 1]
        assert np.ptp(held) <= problem.max_movement
        assert np.isclose(np.ptp(held), rest.jitter, rtol=0.02, atol=1e-9 * problem.way)
        assert rest.width >= demanded - 0.2
        place = problem.dwell_requests[rest.index].place
        if place is None:
            assert rest.off_end <= 0.05
        else:
            share = (held.mean() - out.min()) / np.ptp(out)
            assert abs(share - place) <= 0.051
            assert np.isclose(design.dwells[rest.index].at, share, atol=1e-3)
    second = np.diff(out, 2) / math.radians(1.0 / per) ** 2
    second = np.radians(second) if problem.output.type == "rocker" else second
    assert np.isclose(np.abs(second).max(), design.metrics.peak_acceleration, rtol=1e-2)
    assert design.metrics.full_rotation
    assert design.metrics.grashof in {turning for _, turning in problem.searches}
