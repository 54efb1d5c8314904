"""Vibration of followers through HTTP: it rests on the train between cam and mass, and is not told without one."""

from __future__ import annotations

import math

import httpx
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.service.stated.cams import CAM
from tests.support.service.answers import finished
from tests.support.service.cam_springs import FAST, designed, refused

LOAD = {"mass": 0.5, "spring_rate": 8.0, "preload": 60.0}


def test_a_soft_return_spring_alone_is_no_reason_to_warn(client: httpx.Client) -> None:
    forces = designed(client, LOAD)["metrics"]["forces"]
    assert forces["frequency_ratio"] < 10.0
    assert "warning" not in forces
    assert "train" not in forces


def test_a_soft_train_is_warned_of(client: httpx.Client) -> None:
    soft = designed(client, {**LOAD, "train_stiffness": 60.0})["metrics"]["forces"]
    natural = math.sqrt((60.0 + 8.0) / 0.5e-3)
    assert soft["train"]["natural_frequency"] == pytest.approx(natural)
    assert soft["train"]["frequency_ratio"] == pytest.approx(natural / (20.0 * math.pi))
    # A move takes a quarter of a tenth of a second.
    assert soft["train"]["period_ratio"] == pytest.approx(math.tau / natural / 0.025)
    assert "follower train" in soft["warning"]
    stiff = designed(client, {**LOAD, "train_stiffness": 6000.0})["metrics"]["forces"]
    assert "warning" not in stiff
    assert stiff["train"]["residual_amplitude"] < 0.01 * soft["train"]["residual_amplitude"]
    damped = designed(client, {**LOAD, "train_stiffness": 60.0, "train_damping_ratio": 0.1})["metrics"]["forces"]
    assert damped["train"]["damped_frequency"] == pytest.approx(natural * math.sqrt(0.99))
    assert damped["train"]["residual_amplitude"] < soft["train"]["residual_amplitude"]


@pytest.mark.slow
def test_the_contact_force_is_that_of_an_integrated_follower(client: httpx.Client) -> None:
    """Forty turns from rest, damped enough to have settled, by a Runge-Kutta method on the table of the answer."""
    stiffness, ratio = 150.0, 0.2
    design = designed(client, {**LOAD, "train_stiffness": stiffness, "train_damping_ratio": ratio})
    program, train = design["mechanism"]["program"], design["metrics"]["forces"]["train"]
    speed, mass = 20.0 * math.pi, 0.5e-3
    damping = 2.0 * ratio * math.sqrt((stiffness + 8.0) * mass)
    angle = np.radians([*program["angle"], 360.0])
    s, v = (np.array([*program[name], program[name][0]]) for name in ("s", "v"))

    def force(time: float, x: float, rate: float) -> float:
        at = math.fmod(speed * time, math.tau)
        lag = x - float(np.interp(at, angle, s))
        return -stiffness * lag - damping * (rate - speed * float(np.interp(at, angle, v)))

    def derivative(time: float, state: np.ndarray) -> list[float]:
        return [state[1], (force(time, *state) - 8.0 * state[0] - 60.0) / mass]

    times = np.linspace(0.7, 0.8, 1441)
    solved = solve_ivp(derivative, (0.0, 0.8), [0.0, 0.0], t_eval=times, rtol=1e-7, atol=1e-7, max_step=2e-4)
    forces = [force(*point) for point in zip(solved.t, *solved.y, strict=True)]
    assert train["min_contact_force"] == pytest.approx(min(forces), rel=0.01)
    assert train["max_contact_force"] == pytest.approx(max(forces), rel=0.01)


def test_a_damping_without_a_train_is_refused(client: httpx.Client) -> None:
    assert refused(client, {**LOAD, "train_damping_ratio": 0.1}) == ["/problem/dynamics/train_damping_ratio"]
    assert refused(client, {**LOAD, "train_stiffness": 60.0, "train_damping_ratio": 1.0})
    assert refused(client, {**LOAD, "train_stiffness": 0.0})


def test_a_train_that_hardly_follows_is_said_to_vibrate_and_no_more(client: httpx.Client) -> None:
    forces = designed(client, {**LOAD, "spring_rate": 0.0, "train_stiffness": 1e-9})["metrics"]["forces"]
    assert "residual_amplitude" not in forces["train"]
    assert "vibrate" in forces["warning"]


def test_forces_are_on_every_sheet(client: httpx.Client) -> None:
    """Chosen springs and trains come in files and reports like all other numbers."""
    dynamics = {"mass": 0.5, "spring_rate": "free", "train_stiffness": 90.0, "max_rpm": 700.0, "least_force": 4.0}
    job = finished(client, {**FAST, "dynamics": dynamics})
    place = f"/v1/jobs/{job['id']}/designs/0"
    sheet = client.get(f"{place}.svg").raise_for_status().text
    assert "jump speed" in sheet.lower()
    for form in ("csv", "dxf"):
        assert client.get(f"{place}.{form}").status_code == 200
    report = client.get(f"/v1/jobs/{job['id']}/report.html")
    assert report.status_code == 200
    assert "train" in report.text.lower()


def test_a_groove_has_a_train_too(client: httpx.Client) -> None:
    forces = designed(client, {"mass": 0.5, "train_stiffness": 90.0}, closure="form", segments=CAM["segments"])
    assert "follower train" in forces["metrics"]["forces"]["warning"]
