"""Limits on forces as margins of fits: what fourbars weigh in compiled code, their peaks and the derivatives."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.linkage.planar.mechanism import Mechanism, Slide
from synthesis.analyses.linkages.dynamics import find_force_peaks
from synthesis.fit.chart import FOURBAR, compute_lengths
from synthesis.fit.fourbar_forces import (
    AIM_SHARE,
    MAX_MARGIN,
    WINDOW_COUNT,
    compute_force_margins,
    compute_force_slopes,
    count_force_margins,
    pack_forces,
)
from synthesis.fit.fourbar_loads import LINKS, pack_loads
from synthesis.mechanisms.fourbar_weights import JOINTS, build_weights
from synthesis.mechanisms.link_bodies import LinkBodies
from synthesis.model.dynamics.request import DesignDynamics
from synthesis.model.linkage.conversion import FOURBAR_LINKS
from synthesis.registry import parse_problem
from synthesis.results.force_filter import select_bearable
from synthesis.results.forces import apply_link_shape
from tests.support.problems.limited_forces import LADEN, SPEED_RPM, fourbar, slider_crank

SPEED = SPEED_RPM * math.tau / 60.0
PLATE = {"density": 7800.0, "thickness": 10.0, "width": 20.0, "holes": {"A": 8.0, "B": 6.0, "P": 3.0}}
SQUARE = {"density": 2700.0, "thickness": 5.0, "width": 12.0, "ends": "square", "overhang": 7.0}
STANDING = {"density": 2700.0, "thickness": 5.0, "polygon": [[0, 0], [200, 0], [200, 90], [0, 20]]}
TURNING = {
    "density": 2700.0,
    "thickness": 5.0,
    "polygon": [{"distance": 0}, {"distance": 80, "angle": 10}, {"distance": 60, "angle": 70}],
    "holes": {"A": 4.0},
}
PARTS = {
    "density": 1000.0,
    "parts": [
        {"form": "prism", "at": [10, 20], "length": 30.0, "width": 10.0, "thickness": 5.0},
        {"form": "cylinder", "at": {"distance": 30, "angle": 20}, "length": 40.0, "diameter": 20.0, "bore": 4.0,
         "axis": "in_plane"},
        {"form": "cylinder", "at": {"distance": 9}, "length": 40.0, "diameter": 20.0, "density": 400.0},
    ],
}  # fmt: skip
GIVEN = {"mass": 1.5, "cg": [40.0, -70.0], "inertia": 0.02}
LOADS = [
    {"link": "output", "point": [30, 40], "force": {"constant": [3.0, 5.0]}, "frame": "link"},
    {"link": "input", "point": {"distance": 12, "angle": 30}, "force": {"constant": [3.0, 5.0]}},
    {"joint": "P", "force": {"constant": [1.0, 5.0]}},
    {"joint": "A", "force": {"constant": [-2.0, 1.0]}},
    {"link": "coupler", "torque": {"constant": 0.2}},
]
EVERY = ("drive_torque", "joint_force", "shaking_force", "shaking_moment", "joint_force_index")


@pytest.mark.parametrize(
    ("of_input", "of_coupler", "of_output"),
    [
        (None, None, None),
        ({"shape": SQUARE}, None, {"shape": STANDING}),
        ({"shape": TURNING}, {"shape": TURNING}, {"shape": PARTS}),
        ({"shape": PARTS}, GIVEN, None),
    ],
)
def test_compiled_weights_are_those_of_the_shapes(of_input, of_coupler, of_output):
    bodies = dict(zip(LINKS, (of_input, of_coupler, of_output), strict=True))
    stated = DesignDynamics.model_validate(
        {"bodies": {link: body for link, body in bodies.items() if body}, "links": PLATE, "speed_rpm": 10.0}
    )
    rng = np.random.default_rng(5)
    joints = 100.0 * (rng.normal(size=(6, 5)) + 1j * rng.normal(size=(6, 5)))
    # P on a pin, on the line of the pins and beyond them.
    joints[:4, 4] = joints[:4, 1] + (joints[:4, 2] - joints[:4, 1]) * [0.0, 1.0, 0.5, -1.0]
    found, general = build_weights(stated, joints, "mm"), apply_link_shape(stated, FOURBAR_LINKS)
    for n, row in enumerate(joints):
        reader = LinkBodies(dict(zip(JOINTS, row, strict=True)), LINKS, 1e-3)
        for k, (link, (first, second, *_)) in enumerate(LINKS.items()):
            body = reader.build_body(link, general.bodies[link])
            start, end = (1e-3 * row[JOINTS.index(joint)] for joint in (first, second))
            told = (complex(body.cg) - start) / ((end - start) / abs(end - start))
            assert found.mass[n, k] == pytest.approx(float(body.mass), rel=1e-11)
            assert found.inertia[n, k] == pytest.approx(float(body.inertia), rel=1e-9, abs=1e-15)
            assert abs(found.cg[n, k] - told) < 1e-11


@pytest.mark.parametrize(
    "changed",
    [
        {"friction": {"pins": {"A": {"mu": 0.1, "radius": 5}}}},
        {"springs": [{"torsion": 1.0, "links": ["ground", "output"]}]},
        {"loads": [{"link": "output", "torque": {"against_motion": {"forward": 1.0, "backward": 1.0}}}]},
        {"bodies": {"crank": {"mass": 0.0}}},
        {"bodies": {"coupler": {"shape": SQUARE}}},
        {"bodies": {"input": {"shape": TURNING | {"polygon": [[0, 0], [9, 0], {"distance": 9, "angle": 50}]}}}},
        {"point_masses": [{"joint": "C", "mass": 1.0}]},
    ],
)
def test_what_the_closed_form_does_not_know_steers_nothing(changed):
    stated = DesignDynamics.model_validate(LADEN | changed)
    assert pack_loads(stated, "mm", 0j) is None
    assert not len(pack_forces(stated, {"drive_torque": 1.0}, "mm", 0j, 100.0))


def _in_chart(mechanism: Mechanism, origin: complex, size: float):
    o2, a, b, o4, p = ((complex(mechanism.joints[joint]) - origin) / size for joint in JOINTS)
    along = (b - a) / abs(b - a)
    point = (p - a) / along
    x = np.array([o2.real, o2.imag, np.angle(o4 - o2), *np.log(np.abs([o4 - o2, a - o2, b - a, b - o4])), 0.0, 0.0])
    x[7:] = point.real, point.imag
    sign = 1.0 if (np.conj(o4 - a) * (b - a)).imag > 0.0 else -1.0
    first = np.angle(a - o2) - x[2]
    return x, sign, np.array([first, first + 1.0])


def _lengths(x):
    lengths, slopes = np.empty(4), np.empty((4, 4))
    compute_lengths(FOURBAR, x, lengths, slopes)
    return lengths, slopes


@pytest.mark.parametrize("seed", range(3))
def test_margins_are_what_is_measured_and_their_derivatives_are_differences(seed):
    rng = np.random.default_rng(seed)
    mechanism = fourbar(rng)
    stated = DesignDynamics.model_validate(LADEN | {"loads": LOADS, "moment_about": [5.0, 7.0]})
    at = math.degrees(float(mechanism.reference_input)) + np.linspace(0.0, 360.0, 73)
    _, measured = find_force_peaks(mechanism, apply_link_shape(stated, mechanism.links), "mm", at, SPEED)
    pins = max(peak.value for name, peak in measured.items() if name.startswith("joint "))
    values = [measured["drive"].value, pins, *(measured[n].value for n in ("shaking force", "shaking moment", "index"))]
    origin, size = 20.0 + 10.0j, 130.0
    forces = pack_forces(stated, dict(zip(EVERY, values, strict=True)), "mm", origin, size)
    count = count_force_margins(forces)
    assert count == len(EVERY) * WINDOW_COUNT
    x, sign, ends = _in_chart(mechanism, origin, size)
    lengths, slopes = _lengths(x)
    margins, rows, turns = np.empty(count), np.empty((count, 9)), rng.normal(size=(2, 9))
    assert compute_force_margins(x, lengths, sign, ends, forces, margins)
    # Each limit is just what the linkage has, but for what is aimed at and what lies between the positions.
    assert margins.reshape(-1, WINDOW_COUNT).min(axis=1) == pytest.approx(math.log(1.0 - AIM_SHARE), abs=1.5e-2)
    compute_force_slopes(x, lengths, slopes, sign, ends, turns, forces, rows)
    step = 1e-5
    for i in range(9):
        both = []
        for side in (step, -step):
            moved = x + side * np.eye(9)[i]
            there = np.empty(count)
            assert compute_force_margins(moved, _lengths(moved)[0], sign, ends + side * turns[:, i], forces, there)
            both.append(there)
        near = (both[0] - both[1]) / (2.0 * step)
        told = margins < MAX_MARGIN
        assert rows[told, i] == pytest.approx(near[told], rel=2e-3, abs=2e-3)


def test_many_slider_cranks_are_weighed_as_each_is_measured():
    rng = np.random.default_rng(2)
    each = [slider_crank(rng) for _ in range(6)]
    joints = {joint: np.array([complex(one.joints[joint]) for one in each]) for joint in each[0].joints}
    points = np.array([complex(one.slides[0].point) for one in each])
    many = Mechanism(joints, each[0].links, "crank", (Slide("B", "ground", points, np.zeros(6)),))
    load = {"joint": "B", "force": {"constant": [-50.0, 3.0]}}
    push = {"link": "coupler", "point": {"distance": 20.0, "angle": 40.0}, "force": {"constant": [5.0, 3.0]}}
    block = LADEN | {"loads": [load, push], "bodies": {"crank": {"shape": SQUARE}}}
    stated = DesignDynamics.model_validate(block)
    names = {"drive_torque": "drive", "shaking_force": "shaking force", "shaking_moment": "shaking moment"}
    measured: dict[str, list[float]] = {name: [] for name in (*names, "joint_force")}
    for one in each:
        at = math.degrees(float(one.reference_input)) + np.linspace(0.0, 360.0, 73)
        _, found = find_force_peaks(one, apply_link_shape(stated, one.links), "mm", at, SPEED)
        for name, told in names.items():
            measured[name].append(found[told].value)
        measured["joint_force"].append(max(peak.value for name, peak in found.items() if name.startswith("joint ")))
    positions = [{"x": 10.0 * k, "y": 0.0, "angle": 5.0 * k} for k in range(3)]
    for name, values in measured.items():
        limit = 1.01 * float(np.median(values))
        problem = parse_problem(
            {"kind": "motion", "positions": positions, "dynamics": block, "constraints": {f"max_{name}": limit}}
        )
        kept = select_bearable(problem, many, np.ones(6))
        assert kept.tolist() == [value <= limit for value in values]
        assert 0 < kept.sum() < 6
