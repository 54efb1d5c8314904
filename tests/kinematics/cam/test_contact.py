"""Contact search on finished profiles: it gives the program back, and finds what is wrong with a bad one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.finished.contact import Contour
from kinematics.cam.follower import OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.profile import Cam, space_angles
from kinematics.errors import DimensionError, ShapeError
from tests.campaign import sampled
from tests.kinematics.cam.sampling import FOLLOWERS, sound_cam
from tests.oracles.cam_formulas import largest_cutter, least_convex_radius, profile_radius, undercut
from tests.support.kinematics.cam.profile import double_dwell

POINTS = 1440


def measured(cam: Cam, count: int = POINTS) -> Contour:
    return Contour(cam.profile(space_angles(count)))


@pytest.mark.parametrize("kind", FOLLOWERS)
@pytest.mark.parametrize("seed", range(6))
def test_the_profile_gives_the_program_back(kind: str, seed: int) -> None:
    cam = sound_cam(np.random.default_rng(seed), kind)
    angles = space_angles(361) + 1e-3
    found = measured(cam).follow(cam.follower, angles, cam.rotation)
    assert found.valid.all()
    assert found.s == pytest.approx(cam.program.motion(angles).s, abs=1e-7 * cam.program.lift)
    motion = cam.program.motion(angles)
    assert found.v == pytest.approx(motion.v, abs=1e-4 * cam.program.peaks[1].largest)
    # Where the jerk jumps the acceleration bends, which no curve of the fifth degree follows.
    bends = np.abs((angles[:, None] - cam.program.breaks + math.pi) % (2.0 * math.pi) - math.pi).min(axis=1)
    smooth = bends > 4.0 * math.pi / POINTS * 2.0
    largest = cam.program.peaks[2].largest
    assert found.a[smooth] == pytest.approx(motion.a[smooth], abs=1e-3 * largest)
    assert found.a == pytest.approx(motion.a, abs=0.1 * largest)
    assert found.pressure_angle == pytest.approx(np.abs(cam.pressure_angle(angles)), abs=2e-5)
    assert found.normal == pytest.approx(cam.normal(angles), abs=2e-5)
    assert found.point == pytest.approx(cam.profile(angles), abs=1e-5 * cam.size)
    assert 1.0 / found.radius == pytest.approx(1.0 / profile_radius(cam, angles), abs=0.02 / cam.size)


@pytest.mark.campaign
@pytest.mark.parametrize("kind", FOLLOWERS)
def test_many_profiles_give_their_programs_back(kind: str) -> None:
    for seed in range(100, 100 + sampled(200)):
        cam = sound_cam(np.random.default_rng(seed), kind)
        angles = space_angles(721) + 1e-3
        found = measured(cam).follow(cam.follower, angles, cam.rotation)
        assert np.abs(found.s - cam.program.motion(angles).s).max() <= 1e-6 * cam.program.lift
        assert len(measured(cam, 360).crossings) == 0


def brute_stand(cam: Cam, angles: np.ndarray, count: int = 60_000) -> np.ndarray:
    """The follower over a dense polygon, moved outward by halving until it touches nothing."""
    points = cam.profile(space_angles(count))
    sense = 1.0 if cam.rotation == "ccw" else -1.0
    follower, result = cam.follower, []
    for theta in angles:
        ground = points * np.exp(1j * sense * theta)
        if cam.rotation == "ccw":
            ground = np.conj(ground)
        low, high = -0.5 * cam.program.lift, 1.5 * cam.program.lift
        for _ in range(40):
            s = 0.5 * (low + high)
            if isinstance(follower, TranslatingRoller):
                centre = follower.height + s + 1j * follower.offset
                clear = np.abs(ground - centre).min() >= follower.roller_radius
            elif isinstance(follower, OscillatingRoller):
                turn = np.exp(-1j * follower.sense * (follower.start_angle + s))
                clear = np.abs(ground - (follower.pivot_distance - follower.arm * turn)).min() >= follower.roller_radius
            elif isinstance(follower, TranslatingFlat):
                clear = ground.real.max() <= follower.base_radius + s
            else:
                normal = np.exp(1j * follower.sense * (math.pi / 2.0 - follower.start_angle - s))
                face = (follower.pivot_distance * np.conj(normal)).real - follower.face_offset
                clear = (ground * np.conj(normal)).real.max() <= face
            low, high = (low, s) if clear else (s, high)
        result.append(high)
    return np.array(result)


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_contact_agrees_with_a_follower_moved_until_it_is_clear(kind: str) -> None:
    cam = sound_cam(np.random.default_rng(11), kind)
    angles = space_angles(7) + 0.1
    found = measured(cam).follow(cam.follower, angles, cam.rotation)
    assert found.s == pytest.approx(brute_stand(cam, angles), abs=1e-6 * max(cam.size, 1.0) * cam.program.lift)


@pytest.mark.parametrize("offset", [0.0, 0.5])
def test_knife_edges(offset: float) -> None:
    cam = Cam(double_dwell(), TranslatingRoller(2.0, 0.0, offset))
    angles = space_angles(100) + 0.01
    found = measured(cam).follow(cam.follower, angles, cam.rotation)
    assert found.s == pytest.approx(cam.program.motion(angles).s, abs=1e-8)
    assert found.pressure_angle == pytest.approx(np.abs(cam.pressure_angle(angles)), abs=2e-5)


@pytest.mark.parametrize("sense", [1, -1])
def test_a_knife_edge_on_an_arm(sense: int) -> None:
    cam = Cam(double_dwell(0.3), OscillatingRoller(2.0, 0.0, 2.5, 3.0, sense), "cw")
    angles = space_angles(100) + 0.01
    found = measured(cam).follow(cam.follower, angles, "cw")
    assert found.s == pytest.approx(cam.program.motion(angles).s, abs=1e-8)
    assert found.pressure_angle == pytest.approx(np.abs(cam.pressure_angle(angles)), abs=2e-5)


def test_points_may_run_either_way_and_start_anywhere() -> None:
    cam = sound_cam(np.random.default_rng(3), "offset_roller")
    angles = space_angles(50)
    there = measured(cam).follow(cam.follower, angles, cam.rotation)
    back = Contour(np.roll(cam.profile(space_angles(POINTS))[::-1], 17)).follow(cam.follower, angles, cam.rotation)
    assert back.s == pytest.approx(there.s, abs=1e-10)
    assert back.pressure_angle == pytest.approx(there.pressure_angle, abs=2e-5)
    assert 1.0 / back.radius == pytest.approx(1.0 / there.radius, abs=0.02 / cam.size)


def test_a_profile_of_another_program_is_told_apart() -> None:
    """The check can fail: a lift that is a thousandth larger shows."""
    follower = TranslatingRoller(3.0, 0.5)
    found = measured(Cam(double_dwell(1.001), follower)).follow(follower, math.pi)
    assert found.s == pytest.approx(1.001, abs=1e-8)


def test_curvature_of_a_circle_and_of_its_points() -> None:
    circle = Contour(0.3 + 2.0 * np.exp(1j * space_angles(90)))
    assert circle.curvature() == pytest.approx(np.full(360, 0.5), abs=1e-6)
    assert circle.sharpest_turn == pytest.approx(math.radians(4.0))
    assert not circle.has_cusp
    assert len(circle.crossings) == 0


def test_an_undercut_profile_is_found() -> None:
    program = double_dwell(1.0)
    sharpest = least_convex_radius(Cam(program, TranslatingRoller(1.5, 0.0)))
    for share, bad in ((0.95, False), (1.1, True)):
        cam = Cam(program, TranslatingRoller(1.5, share * sharpest))
        contour = measured(cam)
        assert undercut(cam) is bad
        assert contour.has_cusp is bad
        assert (len(contour.crossings) > 0) is bad
        found = contour.follow(cam.follower, space_angles(720), cam.rotation)
        assert bool(np.abs(found.s - program.motion(space_angles(720)).s).max() > 1e-4) is bad


def test_a_cusp_under_a_flat_face_is_found() -> None:
    cam = Cam(double_dwell(1.0), TranslatingFlat(1.0))
    assert undercut(cam)
    assert measured(cam).has_cusp
    assert len(measured(cam).crossings) > 0


def test_a_roller_too_large_for_a_hollow_stands_off() -> None:
    cam = Cam(double_dwell(2.0), TranslatingRoller(4.0, 0.3))
    contour = measured(cam)
    bigger = 2.0 * largest_cutter(cam)
    where = cam.pitch_curvature_extremes.at_least
    shifted = TranslatingRoller(4.0 - 0.3 + bigger, bigger)
    stands = contour.follow(shifted, where, cam.rotation).s
    point = cam.profile(where) * np.exp(1j * where)
    assert stands > point.real + math.sqrt(bigger**2 - point.imag**2) - shifted.height + 1e-4


def test_a_follower_beside_the_cam_touches_nothing() -> None:
    circle = Contour(np.exp(1j * space_angles(360)))
    found = circle.follow(TranslatingRoller(5.0, 0.5, offset=4.0), [0.0, 1.0])
    assert not found.valid.any()
    assert np.isnan(found.s).all()
    edge = circle.follow(TranslatingRoller(5.0, 0.0, offset=4.0), [0.0, 1.0])
    assert not edge.valid.any()
    face = circle.follow(OscillatingFlat(1.0, 3.0), 0.0)
    assert face.s == pytest.approx(0.0, abs=1e-9)


def test_profiles_that_are_none_are_refused() -> None:
    with pytest.raises(ShapeError):
        Contour(np.exp(1j * space_angles(8)))
    with pytest.raises(DimensionError, match="points"):
        Contour(np.where(np.arange(20) == 3, np.nan, np.exp(1j * space_angles(20))))
    with pytest.raises(DimensionError, match="points"):
        Contour(np.append(np.exp(1j * space_angles(20)), np.exp(1j * space_angles(20)[-1])))
    with pytest.raises(DimensionError, match="roller radius"):
        Contour(np.exp(1j * space_angles(20))).follow(TranslatingRoller(2.0, 0.01), 0.0)
