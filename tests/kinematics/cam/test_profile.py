"""Profiles against other routes: envelopes by brute force, differences, mirror images; refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.follower import OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_dwell, build_law_segment
from kinematics.cam.profile import Cam, space_angles
from kinematics.errors import DimensionError
from tests.kinematics.cam.sampling import FOLLOWERS, sound_cam
from tests.oracles.cam_formulas import (
    cutter_path,
    largest_cutter,
    least_convex_radius,
    pressure_angle_extremes,
    profile_radius,
    reach_extremes,
    undercut,
)
from tests.oracles.differences import derivative
from tests.support.kinematics.cam.profile import double_dwell

ROLLERS = ("translating_roller", "offset_roller", "oscillating_roller")
FLATS = ("translating_flat", "oscillating_flat")


def smooth_angles(cam: Cam, count: int, margin: float) -> np.ndarray:
    angles = space_angles(count) + 1e-4
    return angles[np.abs(angles[:, None] - cam.program.breaks).min(axis=1) > margin]


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_curvature_agrees_with_differences(kind: str) -> None:
    cam = sound_cam(np.random.default_rng(1), kind)
    step = 1e-3
    angles = smooth_angles(cam, 120, 4.5 * step)
    first = derivative(lambda h: cam.profile(angles + h), 1, step)
    second = derivative(lambda h: cam.profile(angles + h), 2, step)
    sign = -1.0 if cam.rotation == "ccw" else 1.0
    curvature = sign * (np.conj(first) * second).imag / np.abs(first) ** 3
    assert 1.0 / profile_radius(cam, angles) == pytest.approx(curvature, abs=1e-6 / cam.size, rel=1e-6)


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_normals_stand_on_the_profile(kind: str) -> None:
    cam = sound_cam(np.random.default_rng(2), kind)
    angles = smooth_angles(cam, 60, 5e-3)
    tangent = derivative(lambda h: cam.profile(angles + h), 1, 1e-3)
    cosine = (tangent * np.conj(cam.normal(angles))).real / np.abs(tangent)
    assert cosine == pytest.approx(np.zeros(len(angles)), abs=1e-8)
    assert np.all((cam.normal(angles) * np.conj(cam.profile(angles))).real > 0.0)


def motion_of_the_contact(cam: Cam, angles: np.ndarray) -> np.ndarray:
    """Direction in which the follower's own point at the contact moves, in the cam's frame: by differences."""
    sense = 1.0 if cam.rotation == "ccw" else -1.0
    profile, follower = cam.profile(angles), cam.follower
    ground = profile * np.exp(1j * sense * angles)
    if isinstance(follower, TranslatingRoller | TranslatingFlat):
        direction = np.ones(len(angles), dtype=complex)
    else:
        arm = ground - follower.pivot_distance
        if isinstance(follower, OscillatingRoller):
            # A roller's contact force goes through its centre, which is what moves.
            arm = cam.pitch_curve(angles) * np.exp(1j * sense * angles) - follower.pivot_distance
        direction = 1j * sense * follower.sense * arm / np.abs(arm)
    return direction * np.exp(-1j * sense * angles)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", FOLLOWERS)
def test_pressure_angle_is_between_normal_and_motion(kind: str, seed: int) -> None:
    cam = sound_cam(np.random.default_rng(seed), kind)
    angles = smooth_angles(cam, 90, 5e-3)
    tangent = derivative(lambda h: cam.profile(angles + h), 1, 1e-3)
    normal = tangent / np.abs(tangent) * (1j if cam.rotation == "ccw" else -1j)
    direction = motion_of_the_contact(cam, angles)
    between = np.abs(np.angle(normal / direction))
    assert np.abs(cam.pressure_angle(angles)) == pytest.approx(between, abs=1e-7)


@pytest.mark.parametrize("kind", ROLLERS)
def test_profile_is_the_envelope_of_the_roller(kind: str) -> None:
    """Every profile point lies on the roller of its own angle, and in no other roller."""
    cam = sound_cam(np.random.default_rng(3), kind)
    centres = cam.pitch_curve(space_angles(7200))
    profile = cam.profile(space_angles(240))
    nearest = np.abs(profile[:, None] - centres).min(axis=1)
    assert nearest == pytest.approx(np.full(240, cam.roller_radius), abs=1e-5 * cam.size)


@pytest.mark.parametrize("kind", FLATS)
def test_profile_is_the_envelope_of_the_face(kind: str) -> None:
    """The greatest reach of the profile along each face's normal is that face's distance."""
    cam = sound_cam(np.random.default_rng(4), kind)
    profile = cam.profile(space_angles(7200))
    at = space_angles(90)
    normal = cam.normal(at)
    reach = (profile[:, None] * np.conj(normal)).real.max(axis=0)
    assert reach == pytest.approx((cam.profile(at) * np.conj(normal)).real, abs=1e-6 * cam.size)


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_the_other_rotation_is_the_mirror_image(kind: str) -> None:
    cam = sound_cam(np.random.default_rng(5), kind)
    other = Cam(cam.program, cam.follower, "cw" if cam.rotation == "ccw" else "ccw")
    angles = space_angles(50)
    assert other.profile(angles) == pytest.approx(np.conj(cam.profile(angles)), abs=1e-12)
    assert pressure_angle_extremes(other) == pressure_angle_extremes(cam)


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_worst_points_bound_a_fine_grid(kind: str) -> None:
    for seed in range(5):
        cam = sound_cam(np.random.default_rng(seed), kind)
        grid = space_angles(20_000)
        worst, found = pressure_angle_extremes(cam), cam.pressure_angle(grid)
        assert worst.least <= found.min() + 1e-12
        assert worst.greatest >= found.max() - 1e-12
        assert worst.largest == pytest.approx(np.abs(found).max(), abs=1e-5)
        curvature = cam.pitch_curvature(grid)
        assert 1.0 / least_convex_radius(cam) >= curvature.max() * (1.0 - 1e-12)
        assert 1.0 / least_convex_radius(cam) == pytest.approx(curvature.max(), rel=1e-4)


def test_face_width_of_a_translating_face_is_the_range_of_the_velocity() -> None:
    cam = Cam(double_dwell(), TranslatingFlat(8.0))
    reach = reach_extremes(cam)
    assert (reach.least, reach.greatest) == pytest.approx((-4.0 / math.pi, 4.0 / math.pi))


def test_eccentric_circle_from_harmonic_motion() -> None:
    """Harmonic rise and fall of half a turn each under a flat face make an eccentric circle (Norton Fig 8-10)."""
    half = TURN / 2.0
    law = LAWS["simple_harmonic"]
    cam = Cam(
        Program([build_law_segment(law, half, 0.0, 1.0), build_law_segment(law, half, 1.0, 0.0)]), TranslatingFlat(2.0)
    )
    profile = cam.profile(space_angles(36))
    assert np.abs(profile - (-0.5)) == pytest.approx(np.full(36, 2.5), abs=1e-12)


def test_cutters_touch_where_the_roller_does() -> None:
    cam = sound_cam(np.random.default_rng(6), "offset_roller")
    angles = space_angles(12)
    for radius in (0.1, 0.3, 2.0):
        assert np.abs(cutter_path(cam, angles, radius) - cam.profile(angles)) == pytest.approx(np.full(12, radius))
    assert np.abs(cam.outer_wall(angles) - cam.profile(angles)) == pytest.approx(np.full(12, 2.0 * cam.roller_radius))


def test_largest_cutter_just_fits_the_hollow() -> None:
    """A cutter a little smaller than the hollow stays clear of the profile elsewhere nearby; a larger one does not."""
    cam = Cam(double_dwell(2.0), TranslatingRoller(4.0, 0.5))
    radius = largest_cutter(cam)
    assert math.isfinite(radius)
    assert -1.0 / cam.pitch_curvature_extremes.least == pytest.approx(
        -profile_radius(cam, space_angles(72_000))[np.argmin(cam.pitch_curvature(space_angles(72_000)))]
        - cam.roller_radius,
        rel=1e-6,
    )
    where = cam.pitch_curvature_extremes.at_least
    near = cam.profile(where + np.linspace(-0.05, 0.05, 401))
    for scale, clear in ((0.98, True), (1.02, False)):
        centre = cutter_path(cam, where, scale * radius)
        assert bool((np.abs(near - centre) >= scale * radius * (1.0 - 1e-9)).all()) is clear


def test_undercut_begins_where_the_pitch_curve_is_as_sharp_as_the_roller() -> None:
    program = double_dwell(1.0)
    radius = least_convex_radius(Cam(program, TranslatingRoller(1.5, 0.0)))
    assert not undercut(Cam(program, TranslatingRoller(1.5, radius * (1.0 - 1e-6))))
    assert undercut(Cam(program, TranslatingRoller(1.5, radius)))
    curve = program.peaks[2].least
    assert undercut(Cam(program, TranslatingFlat(0.5)))
    assert not undercut(Cam(program, TranslatingFlat(1.0 - curve)))


def test_dwell_alone_is_a_circle() -> None:
    cam = Cam(Program([build_dwell(TURN, 0.0)]), TranslatingRoller(2.0, 0.5, offset=0.3))
    assert np.abs(cam.profile(space_angles(7))) == pytest.approx(np.full(7, 1.5))
    assert not undercut(cam)
    assert least_convex_radius(cam) == pytest.approx(2.0)
    assert largest_cutter(cam) == math.inf
    flat = Cam(Program([build_dwell(TURN, 0.0)]), TranslatingFlat(2.0))
    assert reach_extremes(flat).largest == 0.0


def test_dimensions_without_a_follower_are_refused() -> None:
    for make in (
        lambda: TranslatingRoller(1.0, 1.0),
        lambda: TranslatingRoller(1.0, -0.1),
        lambda: TranslatingRoller(math.nan, 0.1),
        lambda: TranslatingRoller(1.0, 0.1, offset=1.0),
        lambda: TranslatingRoller(1.0, 0.1, offset=math.nan),
        lambda: TranslatingFlat(0.0),
        lambda: OscillatingRoller(1.0, 0.1, arm=1.0, pivot_distance=3.0),
        lambda: OscillatingRoller(1.0, 0.1, arm=-1.0, pivot_distance=1.5),
        lambda: OscillatingRoller(1.0, 0.1, arm=1.0, pivot_distance=1.5, sense=0),
        lambda: OscillatingRoller(1.0, 0.1, arm=1.0, pivot_distance=math.inf),
        lambda: OscillatingFlat(2.0, 1.5),
        lambda: OscillatingFlat(1.0, 1.5, face_offset=-1.2),
    ):
        with pytest.raises(DimensionError):
            make()


def test_programs_that_a_follower_cannot_make_are_refused() -> None:
    down = double_dwell(-2.0)
    for follower in (TranslatingRoller(1.5, 0.1), TranslatingFlat(1.5), OscillatingRoller(1.5, 0.1, 2.0, 3.0)):
        with pytest.raises(DimensionError, match="displacement"):
            Cam(down, follower)
    with pytest.raises(DimensionError, match="velocity"):
        Cam(double_dwell(0.9), OscillatingFlat(0.5, 2.0))
    with pytest.raises(DimensionError, match="rotation"):
        Cam(double_dwell(), TranslatingFlat(1.5), "both")
    with pytest.raises(DimensionError, match="flat-faced"):
        _ = Cam(double_dwell(), TranslatingRoller(2.0, 0.1)).radius_extremes
    with pytest.raises(DimensionError, match="roller"):
        _ = Cam(double_dwell(), TranslatingFlat(9.0)).pitch_curvature_extremes
