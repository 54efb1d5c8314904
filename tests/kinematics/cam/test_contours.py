"""Cams of specified contour against printed numbers, differences and the contact search; barrel cams."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.barrel import BarrelCam
from kinematics.cam.contours import (
    Arc,
    Flank,
    SpecifiedContour,
    build_circular_arc_cam,
    build_eccentric_circle,
    build_tangent_cam,
    compute_flank_radius,
)
from kinematics.cam.finished.contact import Contour
from kinematics.cam.follower import TranslatingFlat, TranslatingRoller
from kinematics.cam.motion.extremes import find_extremes
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_dwell
from kinematics.cam.profile import Rotation, space_angles
from kinematics.errors import DimensionError
from tests.cases import Case, cases
from tests.oracles.cam_formulas import least_groove_radius
from tests.oracles.differences import derivative
from tests.support.kinematics.cam.profile import double_dwell

DEGREE = math.pi / 180.0

# Convex everywhere but the last: an eccentric, arcs, straight and hollow flanks.
CONTOURS = {
    "eccentric": build_eccentric_circle(3.5, 1.2),
    "arcs": build_circular_arc_cam(3.25, 1.5, 3.0, 6.25),
    "tangent": build_tangent_cam(2.25, 1.8, 1.7),
    "hollow": build_circular_arc_cam(2.0, 0.8, 2.6, -5.0),
}


@pytest.mark.parametrize("case", cases("eccentric", "cam"))
def test_eccentric_cams(case: Case) -> None:
    x = case.inputs
    contour = build_eccentric_circle(x["Rc"], x["E"])
    follower = TranslatingRoller(x["Rc"] - x["E"] + x["Rr"], x["Rr"])
    worst = find_extremes(
        lambda angle: follower.pressure_angle(contour.motion(follower, angle)), contour.breaks(follower)
    )
    case.check(
        l=x["Rc"] + x["Rr"],
        l_over_E=(x["Rc"] + x["Rr"]) / x["E"],
        phi_max=worst.largest / DEGREE,
        theta_phi_max_deg=sorted([worst.at_least / DEGREE, worst.at_greatest / DEGREE]),
    )


@pytest.mark.parametrize("case", cases("arc_cam", "cam"))
def test_circular_arc_cams(case: Case) -> None:
    """The row's arcs, whose printed half action of 75° is 75.32° when they are to be tangent."""
    x = case.inputs
    base, distance = x["max_radius"] - x["L"], x["max_radius"] - x["rhoN"]
    radius = compute_flank_radius(base, x["rhoN"], distance, 75.32 * DEGREE)
    contour = build_circular_arc_cam(base, x["rhoN"], distance, radius)
    assert radius == pytest.approx(base + x["E"], rel=1e-3)
    follower = TranslatingRoller(base + x["Rr"], x["Rr"])
    assert contour.motion(follower, 0.0).s == pytest.approx(x["L"])
    flank = contour.parts[1]
    assert isinstance(flank, Arc)
    case.check(E2=abs(flank.centre), Rc=contour.base_radius)


@pytest.mark.parametrize("case", cases("arc_cam_rho", "cam"))
def test_least_radius_of_a_tangent_cam(case: Case) -> None:
    x = case.inputs
    case.check(cam_rho_min=build_tangent_cam(x["Rc"], x["rhoN"], x["E"]).least_radius)


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
@pytest.mark.parametrize("offset", [0.0, 0.4])
@pytest.mark.parametrize("name", CONTOURS)
def test_motion_of_a_roller_agrees_with_the_contact_search(name: str, offset: float, rotation: Rotation) -> None:
    contour = CONTOURS[name]
    follower = TranslatingRoller(contour.base_radius + 0.9, 0.9, offset)
    angles = space_angles(180) + 0.003
    found = Contour(contour.points(2000)).follow(follower, angles, rotation)
    motion = contour.motion(follower, angles, rotation)
    assert found.s == pytest.approx(motion.s, abs=1e-6)
    assert found.pressure_angle == pytest.approx(np.abs(follower.pressure_angle(motion)), abs=1e-3)


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
@pytest.mark.parametrize("name", ["eccentric", "arcs", "tangent"])
def test_motion_of_a_face_agrees_with_the_contact_search(name: str, rotation: Rotation) -> None:
    contour = CONTOURS[name]
    follower = TranslatingFlat(contour.base_radius)
    angles = space_angles(180) + 0.003
    found = Contour(contour.points(4000)).follow(follower, angles, rotation)
    assert found.s == pytest.approx(contour.motion(follower, angles, rotation).s, abs=2e-6)


@pytest.mark.parametrize("follower_kind", ["roller", "face"])
@pytest.mark.parametrize("name", CONTOURS)
def test_velocities_agree_with_differences(name: str, follower_kind: str) -> None:
    if (name, follower_kind) == ("hollow", "face"):
        with pytest.raises(DimensionError, match="flat face"):
            CONTOURS[name].motion(TranslatingFlat(CONTOURS[name].base_radius), 0.0)
        return
    contour, step = CONTOURS[name], 1e-3
    follower = (
        TranslatingRoller(contour.base_radius + 0.9, 0.9, 0.2)
        if follower_kind == "roller"
        else TranslatingFlat(contour.base_radius)
    )
    angles = space_angles(120) + 0.001
    breaks = contour.breaks(follower, "cw")
    angles = angles[np.abs(angles[:, None] - breaks).min(axis=1) > 5.0 * step]
    found = contour.motion(follower, angles, "cw")
    for order in (1, 2, 3):
        by_differences = derivative(lambda h: contour.motion(follower, angles + h, "cw").s, order, step)
        assert found[order] == pytest.approx(by_differences, abs=(1e-9, 1e-7, 1e-4)[order - 1])


@pytest.mark.parametrize("name", CONTOURS)
def test_rise_and_dwell_of_contours(name: str) -> None:
    contour = CONTOURS[name]
    follower = TranslatingRoller(contour.base_radius + 0.9, 0.9)
    motion = contour.motion(follower, np.array([0.0, math.pi]))
    top = abs(contour.points(4000)).max() - contour.base_radius
    assert motion.s == pytest.approx([top, 0.0], abs=1e-5)
    at = contour.breaks(follower)[1:-1]
    before, after = contour.motion(follower, at - 1e-9), contour.motion(follower, at + 1e-9)
    assert before.s == pytest.approx(after.s, abs=1e-7)
    assert before.v == pytest.approx(after.v, abs=1e-6)


def test_flank_radius_for_a_half_action() -> None:
    for name, half_action in (("arcs", 75.32), ("tangent", None)):
        contour = CONTOURS[name]
        if half_action is None:
            half_action = math.degrees(math.acos((2.25 - 1.8) / 1.7))
            assert abs(compute_flank_radius(2.25, 1.8, 1.7, half_action * DEGREE)) > 1e12
        else:
            assert compute_flank_radius(3.25, 1.5, 3.0, half_action * DEGREE) == pytest.approx(6.25, abs=5e-3)
        assert contour.least_radius in (1.5, 1.8)


def test_contours_that_are_none_are_refused() -> None:
    for make in (
        lambda: build_eccentric_circle(1.0, 1.0),
        lambda: build_eccentric_circle(1.0, -0.1),
        lambda: build_tangent_cam(2.0, 0.5, 1.0),
        lambda: build_tangent_cam(-2.0, 0.5, 3.0),
        lambda: build_tangent_cam(2.0, 0.0, 3.0),
        lambda: build_circular_arc_cam(3.25, 1.5, 3.0, 3.3),
        lambda: build_circular_arc_cam(3.25, 1.5, 3.0, math.nan),
        lambda: compute_flank_radius(3.25, 1.5, 3.0, 4.0),
        lambda: SpecifiedContour(1.0, (Arc(0j, 1.0, 0.0), Arc(0.1 + 0j, 1.0, math.pi))),
        lambda: SpecifiedContour(1.0, (Arc(0j, 1.0, 0.0), Flank(2.0, 1.0))),
        lambda: SpecifiedContour(1.0, (Flank(1.0, 0.0), Flank(1.0, 2.0))),
        lambda: CONTOURS["arcs"].motion(TranslatingRoller(3.0, 0.1), 0.0),
        lambda: CONTOURS["hollow"].motion(TranslatingRoller(7.5, 5.5), 0.0),
    ):
        with pytest.raises(DimensionError):
            make()


def test_barrel_cams() -> None:
    program = double_dwell(2.0)
    barrel = BarrelCam(program, 3.0, 0.2)
    steepest = find_extremes(barrel.pressure_angle, program.breaks).greatest
    assert steepest == pytest.approx(math.atan(4.0 / (math.pi / 2.0) / 3.0))
    angles = space_angles(200) + 1e-3
    angles = angles[np.abs(angles[:, None] - program.breaks).min(axis=1) > 5e-3]
    slope = derivative(lambda h: barrel.pitch_curve(angles + h), 1, 1e-3)
    assert barrel.pressure_angle(angles) == pytest.approx(np.angle(slope), abs=1e-9)
    curve = derivative(lambda h: barrel.pitch_curve(angles + h), 2, 1e-3)
    curvature = np.abs((np.conj(slope) * curve).imag) / np.abs(slope) ** 3
    assert least_groove_radius(barrel) <= 1.0 / curvature.max()
    assert least_groove_radius(barrel) == pytest.approx(1.0 / curvature.max(), rel=1e-3)
    for side in (1, -1):
        assert np.abs(barrel.wall(angles, side) - barrel.pitch_curve(angles)) == pytest.approx(
            np.full(len(angles), 0.2)
        )
    assert (barrel.wall(0.0, 1) - barrel.wall(0.0, -1)).imag == pytest.approx(0.4)
    assert least_groove_radius(BarrelCam(Program([build_dwell(TURN, 0.0)]), 3.0, 1.0)) == math.inf
    with pytest.raises(DimensionError, match="cylinder"):
        BarrelCam(program, 0.0)
    with pytest.raises(DimensionError, match="roller"):
        BarrelCam(program, 1.0, -1.0)
