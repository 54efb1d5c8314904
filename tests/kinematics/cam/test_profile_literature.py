"""Followers and profiles against printed numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.follower import OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.motion.extremes import find_extremes
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_dwell, build_law_segment
from kinematics.cam.profile import Cam
from tests.cases import Case, cases
from tests.kinematics.cam.stating import NAMES, program_of, segment_of
from tests.oracles.cam_formulas import pressure_angle_extremes, reach_extremes, undercut

DEGREE = math.pi / 180.0


@pytest.mark.parametrize("case", cases("program_table", "cam"))
def test_tables_of_flat_faced_cams(case: Case) -> None:
    x = case.inputs
    angles = np.array(x["theta_deg"]) * DEGREE
    cam = Cam(program_of(x["segments"]), TranslatingFlat(x["Rb"]), "cw")
    motion, profile = cam.program.motion(angles), cam.profile(angles)
    case.check(f=motion.s, fp=motion.v, x=profile.real, y=profile.imag)


@pytest.mark.parametrize("case", cases("roller", "cam"))
def test_roller_followers(case: Case) -> None:
    x = case.inputs
    cam = Cam(program_of(x["segments"]), TranslatingRoller(x["Rp"], x.get("Rf", 0.0), x["e"]))
    angle, curvature = pressure_angle_extremes(cam), cam.pitch_curvature_extremes
    case.check(
        phi_abs=angle.largest / DEGREE,
        within_limit=angle.largest / DEGREE <= x.get("phi_limit_deg", 90.0),
        rho_min_abs=1.0 / curvature.largest,
        undercut=undercut(cam),
    )


@pytest.mark.parametrize("case", cases("roller_law_segment", "cam"))
def test_one_segment_under_a_roller(case: Case) -> None:
    """Nomograms and charts of one law: the least prime radius comes from the exact worst of v/tan φ − s."""
    x = case.inputs
    law, lift = LAWS[NAMES[x["law"]]], x["h"]
    falling = x.get("fall", False) or x["law"].endswith("_fall")
    segment = build_law_segment(law, x["beta_deg"] * DEGREE, lift if falling else 0.0, 0.0 if falling else lift)
    motion, breaks = segment.pieces.motion, segment.pieces.start
    found = {}
    if "phi_limit_deg" in x:
        slope = math.tan(x["phi_limit_deg"] * DEGREE)
        least = find_extremes(lambda angle: np.abs(motion(angle).v) / slope - motion(angle).s, breaks).greatest
        found = {"Rp_min": least, "L_over_R0": lift / least}
    else:
        follower = TranslatingRoller(x["Rp"], 0.0)
        found["phi_max_abs"] = (
            find_extremes(lambda angle: follower.pressure_angle(motion(angle)), breaks).largest / DEGREE
        )
        curvature = find_extremes(lambda angle: follower.pitch_curvature(motion(angle)), breaks)
        found["rho_min"] = 1.0 / curvature.largest
        found["rho_over_R0"] = found["rho_min"] / x["Rp"]
    case.check(**found)


@pytest.mark.parametrize("case", cases("uniform_R0", "cam"))
def test_prime_radius_of_a_uniform_segment(case: Case) -> None:
    x = case.inputs
    segment = build_law_segment(LAWS["constant_velocity"], x["beta_deg"] * DEGREE, 0.0, x["L"])
    s, v, _, _ = segment.pieces.motion(np.array(x["x"]) * segment.angle)
    case.check(R0=v / math.tan(x["phi_deg"] * DEGREE) - s)


@pytest.mark.parametrize("case", cases("uniform_rho", "cam"))
def test_curvature_of_a_uniform_segment(case: Case) -> None:
    x = case.inputs
    segment = build_law_segment(LAWS["constant_velocity"], x["beta_deg"] * DEGREE, 0.0, x["L"])
    motion = segment.pieces.motion(np.array(x["x"]) * segment.angle)
    case.check(rho=1.0 / TranslatingRoller(x["Rp"], 0.0).pitch_curvature(motion))


@pytest.mark.parametrize("case", cases("flat", "cam"))
def test_flat_faced_sizing(case: Case) -> None:
    x = case.inputs
    program = program_of(x["segments"])
    v = program.peaks[1]
    curve = find_extremes(lambda angle: program.pieces.motion(angle).s + program.pieces.motion(angle).a, program.breaks)
    least = x["rho_min"] - curve.least
    cam = Cam(program, TranslatingFlat(least))
    assert cam.radius_extremes.least == pytest.approx(x["rho_min"], abs=1e-9)
    case.check(Rb_min=least, v_max=v.greatest, symmetric_width=2.0 * reach_extremes(cam).largest)


@pytest.mark.parametrize("case", cases("flat_segment", "cam"))
def test_one_segment_under_a_flat_face(case: Case) -> None:
    x = case.inputs
    segment = segment_of(x["segment"])
    face = TranslatingFlat(x["Rb"]).face
    radius = find_extremes(lambda angle: face(segment.pieces.motion(angle)).radius, segment.pieces.start)
    v = segment.extremes(1).largest
    width = 2.0 * (v + x["clearance"])
    case.check(width=width, rho_min=radius.least, rho_max=radius.greatest, cusp_free=radius.least > 0.0, v_abs=v)


@pytest.mark.parametrize("case", cases("osc", "cam"))
def test_oscillating_followers(case: Case) -> None:
    x = case.inputs
    follower: OscillatingFlat | OscillatingRoller
    if x["type"] == "flat":
        follower = OscillatingFlat(x["Rb"], x["C"])
    else:
        follower = OscillatingRoller(x["Rb"] + x["Rf"], x["Rf"], x["L"], x["C"])
    swing = build_law_segment(LAWS[NAMES[x["law"]]], x["beta_deg"] * DEGREE, 0.0, x["swing_deg"] * DEGREE)
    back = build_law_segment(LAWS["cycloidal"], TURN - swing.angle - 0.5, x["swing_deg"] * DEGREE, 0.0)
    program = Program([swing, back, build_dwell(TURN - swing.angle - back.angle, 0.0)])
    angle = follower.start_angle + program.motion(np.array(x["theta_deg"]) * DEGREE).s
    case.check(psi0_deg=follower.start_angle / DEGREE, psi_deg=angle / DEGREE)
