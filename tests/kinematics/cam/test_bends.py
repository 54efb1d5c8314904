"""Curvature by the normals of contacts: exact on sound profiles however close points stand, worse on wrong ones."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.barrel import BarrelCam
from kinematics.cam.finished.barrel_contact import UnrolledWall
from kinematics.cam.finished.contact import Contour
from kinematics.cam.finished.contact_normals import compute_contact_normals, compute_wall_normals
from kinematics.cam.finished.curvature import ProfileCurvature, measure_profile_curvature, measure_wall_curvature
from kinematics.cam.finished.discretization import Stretches
from kinematics.cam.finished.extreme_values import find_worst_values, find_worst_wall_values
from kinematics.cam.follower import TranslatingRoller
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_knot_segment
from kinematics.cam.profile import Cam, space_angles
from kinematics.errors import DimensionError
from tests.kinematics.cam.sampling import FOLLOWERS, sound_cam
from tests.oracles.cam_formulas import profile_radius

POINTS = 720


def smooth(kind: str, seed: int) -> Cam:
    """A cam under a follower of that kind, whose motion has no breaks."""
    follower = sound_cam(np.random.default_rng(seed), kind).follower
    lift = 0.05 if kind.startswith("oscillating") else 0.2
    return Cam(wavy(lift), follower, "ccw" if seed % 2 else "cw")


def wavy(lift: float) -> Program:
    """lift (1 − cos θ)/2 as polynomials of the fifteenth degree on sixteen pieces."""
    starts = np.linspace(0.0, TURN, 17)
    order = np.arange(16)
    factorial = np.array([math.factorial(k) for k in order], np.float64)
    rows = -0.5 * lift * np.cos(starts[:-1, None] + 0.5 * math.pi * order) / factorial
    rows[:, 0] += 0.5 * lift
    return Program([build_knot_segment(starts, rows)])


def whole(count: int) -> Stretches:
    """A profile without breaks."""
    none = np.zeros(count, np.bool_)
    return Stretches(np.empty(0, np.int64), none, none, none)


@pytest.mark.parametrize("kind", FOLLOWERS)
@pytest.mark.parametrize("seed", range(4))
def test_normals_are_those_of_the_contacts(kind: str, seed: int) -> None:
    cam, at = sound_cam(np.random.default_rng(seed), kind), space_angles(POINTS)
    mirrored = np.conj if cam.rotation == "ccw" else np.asarray
    found = compute_contact_normals(cam.follower, mirrored(cam.profile(at)), at)
    assert np.exp(1j * (at + found.lean)) == pytest.approx(mirrored(cam.normal(at)), abs=1e-11)
    assert (found.arm > 0.0).all()


@pytest.mark.parametrize("side", [1, -1])
def test_normals_of_a_groove_are_those_of_its_slope(side: int) -> None:
    cam = BarrelCam(wavy(20.0), 40.0, 6.0)
    at = space_angles(POINTS)
    found = compute_wall_normals(40.0, 6.0, side, cam.wall(at, -side), at)
    assert np.tan(found.lean) == pytest.approx(cam.program.motion(at).v / 40.0, abs=1e-11)


def test_a_point_off_turns_its_normal_by_the_arm() -> None:
    """Moved square to the line on which the normal does not turn, by the displacement over the arm."""
    follower, at = TranslatingRoller(30.0, 5.0, 4.0), np.array([0.7])
    cam = Cam(wavy(10.0), follower, "cw")
    points = cam.profile(at)
    exact = compute_contact_normals(follower, points, at)
    moved = compute_contact_normals(follower, points + 1e-6j * np.exp(1j * at), at)
    assert abs(moved.lean - exact.lean) == pytest.approx(1e-6 / exact.arm, rel=1e-5)


def test_a_knife_edge_asks_for_no_normal() -> None:
    with pytest.raises(DimensionError, match="knife edge"):
        compute_contact_normals(TranslatingRoller(1.0, 0.0), np.ones(1, np.complex128), np.zeros(1))


def test_a_point_out_of_reach_is_refused() -> None:
    cam = smooth("translating_roller", 0)
    at = space_angles(POINTS)
    with pytest.raises(DimensionError, match="touched by the follower"):
        measure_profile_curvature(Contour(cam.profile(at), 0.5 * at), cam.follower, cam.rotation)


@pytest.mark.parametrize("kind", FOLLOWERS)
@pytest.mark.parametrize("seed", range(4))
def test_curvature_is_that_of_the_formulas(kind: str, seed: int) -> None:
    cam, at = smooth(kind, seed), space_angles(POINTS)
    bends = measure_profile_curvature(Contour(cam.profile(at), at), cam.follower, cam.rotation)
    places = at + 0.3 * TURN / POINTS
    exact = 1.0 / profile_radius(cam, places)
    assert bends.curvature_at(np.arange(POINTS), 0.3) == pytest.approx(exact, rel=1e-9, abs=1e-9 * np.abs(exact).max())
    assert not bends.curvature_discrepancy.any()


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_close_points_leave_curvature_its_digits(kind: str) -> None:
    """Steps of a hundred-thousandth of a radian: of second derivatives rounding leaves four digits."""
    cam = smooth(kind, 1)
    at = np.union1d(space_angles(POINTS), 1.0 + 1e-5 * np.arange(40))
    contour = Contour(cam.profile(at), at)
    close = np.flatnonzero(np.diff(at) < 1.5e-5)[5:-5]
    exact = 1.0 / profile_radius(cam, at[close])
    found = measure_profile_curvature(contour, cam.follower, cam.rotation).curvature_at(close, 0.0)
    assert found == pytest.approx(exact, rel=1e-9)
    assert np.abs(contour.evaluate_at(close, 0.0).curvature / exact - 1.0).max() > 1e-6


def greatest(bends: ProfileCurvature) -> float:
    """Of the curvature by the normals alone."""
    return float(bends.curvature_at(np.arange(len(bends.chords))[:, None], np.linspace(0.0, 1.0, 5)).max())


def wave(at: np.ndarray) -> np.ndarray:
    """Forty waves of a millionth: the curvature changes by a thousandth and more, the profile by nothing to be seen."""
    return 1.0 + 1e-6 * np.cos(40.0 * at)


@pytest.mark.parametrize("kind", FOLLOWERS)
@pytest.mark.parametrize("seed", range(2))
def test_a_profile_that_is_wrong_is_measured_worse(kind: str, seed: int) -> None:
    """Its normals at the given angles are not square to it; the curvature that its points have is stated, or more."""
    cam, at = smooth(kind, seed), space_angles(4 * POINTS)
    contour = Contour(cam.profile(at) * wave(at), at)
    own = float(contour.curvature().max())
    assert greatest(measure_profile_curvature(contour, cam.follower, cam.rotation)) < own * (1.0 - 1e-5)
    assert find_worst_values(contour, cam.follower, cam.rotation, whole(len(at))).convex > own * (1.0 - 1e-7)


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_angles_that_are_wrong_make_a_profile_worse(kind: str) -> None:
    cam, at = smooth(kind, 0), space_angles(4 * POINTS)
    wrong = Contour(cam.profile(at), at + 1e-5 * (1.0 - np.cos(40.0 * at)))
    own = float(wrong.curvature().max())
    assert find_worst_values(wrong, cam.follower, cam.rotation, whole(len(at))).convex > own * (1.0 + 1e-5)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("toward", [1, -1])
def test_a_wall_that_is_wrong_is_measured_worse(side: int, toward: int) -> None:
    cam, at = BarrelCam(wavy(20.0), 40.0, 6.0), space_angles(4 * POINTS)
    wall = UnrolledWall(cam.wall(at, -side) - 1e-5j * toward * np.cos(40.0 * at), TURN * 40.0, at)
    places = np.arange(len(at))[:, None], np.linspace(0.0, 1.0, 5)
    own = float((toward * wall.evaluate_at(*places)[1]).max())
    assert (toward * measure_wall_curvature(wall, 6.0, side).curvature_at(*places)).max() < own * (1.0 - 1e-5)
    found = find_worst_wall_values(wall, 6.0, side, whole(len(at)))
    # What is unexplained is a mean over the middles of two chords, which of a wave of 72 points is less by 6e-4.
    assert (found.up if toward == 1 else found.down) > own * (1.0 - 2e-6)
