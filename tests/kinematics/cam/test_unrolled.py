"""Walls of a barrel cam's groove: the roller laid on them gives the program back, and brute force agrees."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.barrel import BarrelCam
from kinematics.cam.finished.barrel_contact import UnrolledWall
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_dwell, build_law_segment
from kinematics.cam.profile import space_angles
from kinematics.errors import DimensionError
from tests.oracles.cam_formulas import least_groove_radius

QUARTER = 0.25 * TURN


def barrel(scale: float = 1.0) -> BarrelCam:
    segments = [
        build_law_segment(LAWS["cycloidal"], QUARTER, 0.0, 20.0 * scale),
        build_dwell(QUARTER, 20.0 * scale),
        build_law_segment(LAWS["modified_sine"], 1.5 * QUARTER, 20.0 * scale, 0.0),
        build_dwell(0.5 * QUARTER, 0.0),
    ]
    return BarrelCam(Program(segments), 40.0 * scale, 6.0 * scale)


def wall(cam: BarrelCam, side: int, count: int = 1440) -> UnrolledWall:
    return UnrolledWall(cam.wall(space_angles(count), side), TURN * cam.radius)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("side", [1, -1])
def test_the_program_comes_back(side: int, scale: float) -> None:
    """The lower wall carries the roller from below, the upper one holds it from above; angles beyond a turn too."""
    cam = barrel(scale)
    theta = np.linspace(-1.0, 8.0, 1001)
    touch = wall(cam, -side).follow(cam.radius * theta, cam.roller_radius, 1 if side == 1 else -1)
    motion = cam.program.motion(theta)
    assert np.abs(touch.y - motion.s).max() < 1e-7 * 20.0 * scale
    assert np.abs(cam.radius * touch.tangent.imag / touch.tangent.real - motion.v).max() < 1e-4 * 20.0 * scale


def test_brute_force_agrees() -> None:
    """The greatest height that any of very many points of the exact wall asks for."""
    cam = barrel()
    dense = cam.wall(space_angles(200_000), -1)
    for theta in (0.3, 1.1, 2.9, 4.4, 6.0):
        across = dense.real - cam.radius * theta
        across -= TURN * cam.radius * np.round(across / (TURN * cam.radius))
        near = np.abs(across) < cam.roller_radius
        asked = float((dense.imag[near] + np.sqrt(cam.roller_radius**2 - across[near] ** 2)).max())
        found = wall(cam, -1).follow(np.array(cam.radius * theta), cam.roller_radius, 1)
        assert float(found.y) == pytest.approx(asked, abs=1e-6)


def test_a_straight_groove() -> None:
    n, period = 64, 10.0
    level = UnrolledWall(period * np.arange(n) / n + 2.0j, period)
    touch = level.follow(np.array([0.0, 3.3, 27.0]), 1.0, 1)
    assert touch.y == pytest.approx([3.0, 3.0, 3.0])
    assert touch.curvature == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    assert level.follow(np.array([5.0]), 1.0, -1).y == pytest.approx([1.0])


def test_an_undercut_wall_is_cusped() -> None:
    cam = barrel()
    assert not wall(cam, -1).has_cusp
    small = BarrelCam(cam.program, 6.0, 6.0)
    assert least_groove_radius(small) <= small.roller_radius
    assert wall(small, 1, 4000).has_cusp or wall(small, -1, 4000).has_cusp


@pytest.mark.parametrize(
    ("points", "period"),
    [(np.arange(20.0) + 0j, 0.0), (np.full(20, 1.0 + 0j), 5.0), (np.append(np.arange(20.0), math.nan) + 0j, 30.0)],
)
def test_what_is_no_wall_is_refused(points: np.ndarray, period: float) -> None:
    with pytest.raises(DimensionError):
        UnrolledWall(points, period)
    with pytest.raises(DimensionError):
        wall(barrel(), 1, 32).follow(np.zeros(1), 0.1, 1)
