"""Loads over the input, resistance, gas, springs and dampers in ``POST /v1/analyses``, against simple machines by hand.

A crank alone carries what acts at its end, so that its drive is that force's moment, turned round; a slider-crank does
with a piston's force what the piston's travel for a radian says.
"""

from __future__ import annotations

import math
from typing import Any

import httpx
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tests.support.service.dynamics import OTHER_TYPES, Statement, agrees, asked, refused
from tests.support.service.dynamics_loads import ALONE, REACH

Real = np.ndarray
ENGINE = OTHER_TYPES["slider_crank"]
TURN = {"from": 0.0, "to": 360.0, "steps": 72, "speed": 5.0}


def at_end(**force: Any) -> Statement:
    return {"loads": [{"joint": "P", "force": force}]}


def drive_of(force: Real, theta: Real) -> Real:
    return -REACH * (np.cos(theta) * force[1] - np.sin(theta) * force[0])


def test_table_is_interpolated_round_the_cycle(client: httpx.Client) -> None:
    rows = [[100.0, 1.0, 5.0], [200.0, -3.0, 0.0], [250.0, 4.0, 2.0]]
    motion = {"from": -100.0, "to": 620.0, "steps": 144}
    found = asked(client, ALONE, at_end(table=rows), motion=motion)
    agrees(found)
    degrees = np.array(found["input_angle"])
    nodes, values = np.array([*(row[0] for row in rows), 460.0]), np.array([*rows, rows[0]])[:, 1:]
    within = 100.0 + (degrees - 100.0) % 360.0
    linear = np.stack([np.interp(within, nodes, values[:, k]) for k in (0, 1)])
    np.testing.assert_allclose(found["dynamics"]["drive"], drive_of(linear, np.radians(degrees)), atol=1e-12)
    smooth = asked(client, ALONE, at_end(table=rows, interpolation="periodic_cubic"), motion=motion)
    spline = CubicSpline(nodes, values, bc_type="periodic")(within).T
    np.testing.assert_allclose(smooth["dynamics"]["drive"], drive_of(spline, np.radians(degrees)), atol=1e-12)
    # One that repeats after two turns, closed by its own last row: its cycle is two turns.
    twice = at_end(table=[[0.0, 0.0, 0.0], [360.0, 0.0, 10.0], [720.0, 0.0, 0.0]], turns=2)
    once, both = (
        asked(client, ALONE, twice, motion=TURN | {"to": to, "steps": steps})["dynamics"]
        for to, steps in ((360.0, 72), (720.0, 144))
    )
    assert once["extremes"]["drive"]["mean"] is None
    assert both["extremes"]["drive"]["mean"] is not None
    torque = {"loads": [{"link": "input", "torque": {"table": [[0.0, 1.0], [90.0, 3.0]], "by": "input_angle"}}]}
    turned = asked(client, ALONE, torque, motion={"at": 45.0})["dynamics"]
    assert turned["drive"] == pytest.approx([-2.0])


def test_table_over_the_place_of_the_slide_that_drives(client: httpx.Client) -> None:
    mechanism = ENGINE | {"driven_by": "slider"}
    rows = [[90.0, 2.0, 0.0], [120.0, 8.0, 0.0]]
    block = {"loads": [{"joint": "B", "force": {"table": rows, "by": "input_position"}}]}
    found = asked(client, mechanism, block, motion={"steps": 12})
    agrees(found)
    strength = np.interp(found["input_angle"], [90.0, 120.0], [2.0, 8.0])
    np.testing.assert_allclose(found["dynamics"]["drive"][1:-1], -strength[1:-1], rtol=1e-9)


@pytest.mark.parametrize("speed", [5.0, -5.0])
def test_resistance_acts_against_the_slide(client: httpx.Client, speed: float) -> None:
    block = {"loads": [{"joint": "B", "force": {"against_motion": {"forward": 250.0, "backward": 50.0}}}]}
    found = asked(client, ENGINE, block, motion=TURN | {"speed": speed})
    agrees(found)
    velocity = np.array(found["joints"]["B"]["vx"])
    force = np.where(velocity > 0.0, -250.0, 50.0)
    np.testing.assert_allclose(found["dynamics"]["drive"], -force * 1e-3 * velocity / speed, atol=1e-9)
    still = asked(client, ENGINE, block, motion={"at": 50.0, "speed": 0.0})["dynamics"]
    assert still["drive"] == [0.0]


def test_resistance_of_a_joint_and_of_a_link(client: httpx.Client) -> None:
    for speed, strength in ((2.0, 30.0), (-2.0, -7.0)):
        block = at_end(against_motion={"forward": 30.0, "backward": 7.0})
        found = asked(client, ALONE, block, motion={"at": 20.0, "speed": speed})["dynamics"]
        assert found["drive"] == pytest.approx([REACH * strength])
        turning = {"loads": [{"link": "input", "torque": {"against_motion": {"forward": 30.0, "backward": 7.0}}}]}
        assert asked(client, ALONE, turning, motion={"at": 20.0, "speed": speed})["dynamics"]["drive"] == [strength]


@pytest.mark.parametrize("speed", [5.0, -5.0])
def test_gas_pushes_the_piston_from_its_dead_centre(client: httpx.Client, speed: float) -> None:
    pressure = [[0.0, 3.0e6], [40.0, 1.0e6], [180.0, 0.0], [540.0, 0.0]]
    gas = {"cycle": 720, "bore": 50.0, "pressure": pressure, "interpolation": "linear", "phase": 0.0}
    found = asked(client, ENGINE, {"loads": [{"joint": "B", "force": {"gas": gas}}]},
                  motion={"from": 0.0, "to": 720.0, "steps": 144, "speed": speed})  # fmt: skip
    agrees(found)
    # Dead centre of an offset slider-crank: crank and rod in one line.
    top = math.degrees(math.asin(10.0 / (40.0 + 120.0)))
    cycle = np.sign(speed) * (np.array(found["input_angle"]) - top) % 720.0
    strength = math.pi / 4.0 * 0.05**2 * np.interp(cycle, [row[0] for row in pressure] + [720.0], [3e6, 1e6, 0, 0, 3e6])
    work = -strength * 1e-3 * np.array(found["joints"]["B"]["vx"]) / speed
    np.testing.assert_allclose(found["dynamics"]["drive"], -work, atol=1e-9 * np.abs(work).max())
    late = asked(client, ENGINE, {"loads": [{"joint": "B", "force": {"gas": gas | {"phase": 360.0}}}]},
                 motion={"at": top + 390.0, "speed": 5.0})  # fmt: skip
    early = asked(client, ENGINE, {"loads": [{"joint": "B", "force": {"gas": gas}}]}, motion={"at": top + 30.0})
    assert late["dynamics"]["drive"] == pytest.approx(early["dynamics"]["drive"], rel=1e-9)


def spring_length(theta: Real) -> tuple[Real, Real]:
    """From (0, 200) mm to the crank's end: length, metres, and its rate for a radian."""
    length = np.abs(REACH * np.exp(1j * theta) - 0.2j)
    return length, -REACH * 0.2 * np.cos(theta) / length


SPRING = {
    "ends": [{"link": "ground", "point": [0.0, 200.0]}, {"link": "input", "point": {"distance": 100.0}}],
    "rate": 2000.0,
    "free_length": 180.0,
    "preload": 12.0,
    "damping": 50.0,
}


@pytest.mark.parametrize("side", [False, "pull", "push"])
def test_spring_and_damper_between_two_points(client: httpx.Client, side: Any) -> None:
    found = asked(client, ALONE, {"springs": [SPRING | {"one_sided": side}]}, motion=TURN)
    agrees(found)
    length, rate = spring_length(np.radians(found["input_angle"]))
    spring = 2000.0 * (length - 0.18) + 12.0
    tension = spring + 50.0 * 5.0 * rate
    if side == "pull":
        tension = np.where(spring > 0.0, np.maximum(tension, 0.0), 0.0)
    if side == "push":
        tension = np.where(spring < 0.0, np.minimum(tension, 0.0), 0.0)
    np.testing.assert_allclose(found["dynamics"]["drive"], tension * rate, atol=1e-10)
    # The frame carries the crank's pin and the other end of the spring: nothing else acts on the mechanism.
    np.testing.assert_allclose(found["dynamics"]["shaking"]["force"]["y"], 0.0, atol=1e-9)


def test_spring_alone_does_no_work_and_a_damper_takes_some(client: httpx.Client) -> None:
    ends = {"ends": [{"link": "ground", "point": [30.0, 90.0]}, {"link": "coupler", "point": [70.0, 40.0]}]}
    torsion = {"torsion": 3.0, "links": ["crank", "coupler"], "free_angle": 20.0}
    free = [ends | {"rate": 900.0, "free_length": 40.0}, torsion | {"links": ["ground", "coupler"]}]
    motion = TURN | {"steps": 360}
    found = asked(client, ENGINE, {"springs": free}, motion=motion)
    agrees(found)
    extremes = found["dynamics"]["extremes"]["drive"]
    assert abs(extremes["mean"]) < 1e-9 * extremes["max"]
    damped = asked(client, ENGINE, {"springs": [ends | {"damping": 4.0}, torsion | {"torsion": 0.0, "damping": 0.1}]},
                   motion=motion)  # fmt: skip
    agrees(damped)
    assert min(damped["dynamics"]["drive"]) > 0.0
    # Wound up between the crank and the coupler, which turns against it turn by turn.
    wound = asked(client, ENGINE, {"springs": [torsion]}, motion={"from": -400.0, "to": 800.0, "steps": 240})
    agrees(wound)
    omega = np.array(wound["links"]["coupler"]["omega"]) - 1.0
    relative = np.unwrap(np.radians(np.array(wound["links"]["coupler"]["angle"]) - np.array(wound["input_angle"])))
    first = next(joint for joint in wound["skeleton"]["links"] if joint["name"] == "coupler")["joints"]
    a, b = (complex(*wound["skeleton"]["joints"][joint]) for joint in first[:2])
    crank = complex(*wound["skeleton"]["joints"]["A"]) - complex(*wound["skeleton"]["joints"]["O2"])
    reference = np.angle(b - a) - np.angle(crank)
    nearest = int(np.argmin(np.abs(np.array(wound["input_angle"]) - np.degrees(np.angle(crank)))))
    relative += 2.0 * np.pi * np.round((reference - relative[nearest]) / (2.0 * np.pi))
    expected = 3.0 * (relative - reference - math.radians(20.0)) * omega
    np.testing.assert_allclose(wound["dynamics"]["drive"], expected, atol=1e-9 * np.abs(expected).max())


def test_spring_whose_ends_meet_has_no_direction(client: httpx.Client) -> None:
    ends = [{"link": "ground", "point": [0.0, 100.0]}, {"link": "input", "point": {"distance": 100.0}}]
    block = {"springs": [{"ends": ends, "rate": 1000.0, "free_length": 5.0}]}
    found = asked(client, ALONE, block, motion={"from": 80.0, "to": 100.0, "steps": 2})["dynamics"]
    assert found["status"] == ["ok", "load_undetermined", "ok"]
    assert found["drive"][1] is None
    # Without a free length its force is the rate times the span, also where that vanishes: it carries a weight.
    balanced = {"springs": [{"ends": ends, "rate": 1000.0}], "gravity": {"magnitude": 10.0},
                "point_masses": [{"joint": "P", "mass": 10.0}]}  # fmt: skip
    carried = asked(client, ALONE, balanced, motion={"from": 0.0, "to": 360.0, "steps": 36, "speed": 0.0})["dynamics"]
    assert max(abs(torque) for torque in carried["drive"]) < 1e-12
    assert set(carried["status"]) == {"ok"}


def load(**force: Any) -> Statement:
    return {"loads": [{"joint": "P", "force": force}]}


GAS = {"bore": 50.0, "pressure": [[0.0, 1.0], [90.0, 0.0]]}
BAD: dict[str, tuple[Statement, Statement, str]] = {
    "table out of order": (ALONE, load(table=[[10, 0, 0], [5, 0, 0]]), "/dynamics/loads/0/force/table"),
    "table of one row": (ALONE, load(table=[[10, 0, 0]]), "/dynamics/loads/0/force/table"),
    "table too long": (ALONE, load(table=[[0, 0, 0], [361, 0, 0]]), "/dynamics/loads/0/force/table"),
    "table not closed": (ALONE, load(table=[[0, 0, 0], [360, 1, 0]]), "/dynamics/loads/0/force/table"),
    "constant and table": (
        ALONE, load(constant=[0, 0], table=[[0, 0, 0], [1, 0, 0]]), "/dynamics/loads/0/force",
    ),
    "interpolated constant": (ALONE, load(constant=[0, 0], interpolation="periodic_cubic"), "/dynamics/loads/0/force"),
    "turns": (ALONE, load(table=[[0, 0, 0], [1, 0, 0]], turns=0), "/dynamics/loads/0/force/turns"),
    "by place": (ALONE, load(table=[[0, 0, 0], [1, 0, 0]], by="input_position"), "/dynamics/loads/0/force/by"),
    "negative resistance": (
        ALONE, load(against_motion={"forward": -1, "backward": 0}), "/dynamics/loads/0/force/against_motion/forward",
    ),
    "resistance of a point": (
        ALONE,
        {"loads": [{"link": "input", "point": [1, 0], "force": {"against_motion": {"forward": 1, "backward": 0}}}]},
        "/dynamics/loads/0",
    ),
    "gas on no piston": (ALONE, load(gas=GAS), "/dynamics/loads/0/force/gas"),
    "gas of a table too long": (
        ENGINE, {"loads": [{"joint": "B", "force": {"gas": GAS | {"pressure": [[0, 1], [400, 0]]}}}]},
        "/dynamics/loads/0/force/gas/pressure",
    ),
    "gas without bore": (
        ENGINE, {"loads": [{"joint": "B", "force": {"gas": GAS | {"bore": 0.0}}}]}, "/dynamics/loads/0/force/gas/bore",
    ),
    "gas with a slide that drives": (
        ENGINE | {"driven_by": "slider"}, {"loads": [{"joint": "B", "force": {"gas": GAS}}]},
        "/dynamics/loads/0/force/gas",
    ),
    "spring on no link": (
        ALONE, {"springs": [SPRING | {"ends": [{"link": "rocker", "point": [0, 0]}, SPRING["ends"][1]]}]},
        "/dynamics/springs/0/ends/0/link",
    ),
    "spring in one link": (
        ALONE, {"springs": [SPRING | {"ends": [SPRING["ends"][0]] * 2}]}, "/dynamics/springs/0/ends",
    ),
    "spring without length": (
        ALONE,
        {"springs": [SPRING | {"ends": [{"link": "ground", "point": [100, 0]}, {"link": "input", "point": [100, 0]}]}]},
        "/dynamics/springs/0/ends",
    ),
    "negative rate": (ALONE, {"springs": [SPRING | {"rate": -1.0}]}, "/dynamics/springs/0/rate"),
    "neither sort of spring": (ALONE, {"springs": [{"rate": 3.0}]}, "/dynamics/springs/0"),
    "both sorts of spring": (ALONE, {"springs": [SPRING | {"free_angle": 3.0}]}, "/dynamics/springs/0"),
    "torsion between no links": (ALONE, {"springs": [{"torsion": 3.0}]}, "/dynamics/springs/0"),
    "torsion on no link": (
        ALONE, {"springs": [{"torsion": 3.0, "links": ["ground", "rocker"]}]}, "/dynamics/springs/0/links/1",
    ),
    "torsion in one link": (
        ALONE, {"springs": [{"torsion": 3.0, "links": ["input", "input"]}]}, "/dynamics/springs/0/links",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_loads_and_springs_are_refused_at_the_field(client: httpx.Client, name: str) -> None:
    mechanism, block, expected = BAD[name]
    motion = {"steps": 4} if "driven_by" in mechanism else TURN
    assert expected in refused(client, block, mechanism, motion=motion)
