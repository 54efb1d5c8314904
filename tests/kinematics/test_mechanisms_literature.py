"""Slider-cranks, their inversion, geared fivebars and straight-line linkages against printed numbers."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.linkage.fourbar import CROSSED_ASSEMBLY, OPEN_ASSEMBLY, Fourbar
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import Mechanism
from tests.cases import Case, cases

ASSEMBLY = {"open": OPEN_ASSEMBLY, "crossed": CROSSED_ASSEMBLY}


def degrees(angle: np.ndarray) -> float:
    return float(np.degrees(angle))


def polar(vector: complex) -> tuple[float, float]:
    return abs(vector), float(np.degrees(np.angle(vector)))


def driven(case: Case, mechanism: Mechanism) -> MechanismMotion:
    x = case.inputs
    found = drive(
        mechanism, np.radians([x["theta2"]]), speed=x.get("omega2", 1.0), acceleration=x.get("alpha2", 0.0), order=2
    )
    assert found.smooth.all()
    return found


# -- slider-crank (Norton 4.16 and 4.17, 6.22, 7.16) -------------------------------------------------------------------


def slider_crank(case: Case) -> MechanismMotion:
    x = case.inputs
    theta = np.radians(x["theta2"])
    return driven(
        case, catalogue.make_slider_crank(0j, 1j * x["c"], 0.0, x["a"], x["b"], theta, ASSEMBLY[x["circuit"]])
    )


@pytest.mark.parametrize("case", cases("slider_crank_position"))
def test_slider_crank_position(case: Case) -> None:
    """Norton's θ3 is measured at the slider: from B to A."""
    found = slider_crank(case)
    case.check(theta3=degrees(found.angles["coupler"][0, 0]) + 180.0, d=found.slides["B"][0, 0])


@pytest.mark.parametrize("case", cases("slider_crank_velocity"))
def test_slider_crank_velocity(case: Case) -> None:
    found = slider_crank(case)
    size, angle = polar(found.joints["A"][1, 0])
    case.check(VA_mag=size, VA_ang=angle, omega3=found.angles["coupler"][1, 0], VB=found.slides["B"][1, 0])


@pytest.mark.parametrize("case", cases("slider_crank_acceleration"))
def test_slider_crank_acceleration(case: Case) -> None:
    found = slider_crank(case)
    size, angle = polar(found.joints["A"][2, 0])
    slider, way = polar(found.joints["B"][2, 0])
    case.check(AA_mag=size, AA_ang=angle, alpha3=found.angles["coupler"][2, 0], AB_mag=slider, AB_ang=way)


@pytest.mark.parametrize("case", cases("slider_crank_position"))
def test_slider_crank_driven_by_its_slider(case: Case) -> None:
    """Pushed by its slider from a quarter turn away, it comes to the same place when the crank is on the same side."""
    x = case.inputs
    forward = slider_crank(case)
    made = catalogue.make_slider_crank(
        0j, 1j * x["c"], 0.0, x["a"], x["b"], np.radians(x["theta2"]), ASSEMBLY[x["circuit"]], driven_by="slider"
    )
    back = drive(made, forward.slides["B"][0])
    assert back.valid.all()
    np.testing.assert_allclose(back.joints["A"][0], forward.joints["A"][0], atol=1e-12)
    np.testing.assert_allclose(back.angles["crank"][1] * forward.slides["B"][1], 1.0, rtol=1e-12)


# -- inverted slider-crank (Norton 4.18, 6.23, 7.19) -------------------------------------------------------------------


def inverted_slider_crank(case: Case) -> MechanismMotion:
    x = case.inputs
    theta, gamma = np.radians(x["theta2"]), np.radians(x["gamma"])
    return driven(
        case,
        catalogue.make_inverted_slider_crank(0j, x["d"], x["a"], x["c"], gamma, theta, ASSEMBLY[x["circuit"]]),
    )


@pytest.mark.parametrize("case", cases("inverted_slider_crank_position"))
def test_inverted_slider_crank_position(case: Case) -> None:
    """b, from B to the pin A along the slide, is signed; θ3 = θ4 + γ on both circuits."""
    found = inverted_slider_crank(case)
    output = degrees(found.angles["output"][0, 0])
    case.check(theta3=output + case.inputs["gamma"], theta4=output, b=found.slides["A"][0, 0])


@pytest.mark.parametrize("case", cases("inverted_slider_crank_velocity"))
def test_inverted_slider_crank_velocity(case: Case) -> None:
    found = inverted_slider_crank(case)
    turning = found.angles["output"][1, 0]
    case.check(omega3=turning, omega4=turning, Vslip=found.slides["A"][1, 0])


@pytest.mark.parametrize("case", cases("inverted_slider_crank_acceleration"))
def test_inverted_slider_crank_acceleration(case: Case) -> None:
    found = inverted_slider_crank(case)
    turning = found.angles["output"][2, 0]
    case.check(alpha3=turning, alpha4=turning, Aslip=found.slides["A"][2, 0])


# -- geared fivebar (Norton 4.24, 6.26, 7.29) --------------------------------------------------------------------------


def geared_fivebar(case: Case) -> MechanismMotion:
    x = case.inputs
    return driven(
        case,
        catalogue.make_geared_fivebar(
            0j,
            x["f"],
            x["a"],
            x["b"],
            x["c"],
            x["d"],
            x["lambda"],
            np.radians(x["phi"]),
            np.radians(x["theta2"]),
            ASSEMBLY[x["circuit"]],
        ),
    )


def couplers(found: MechanismMotion, order: int) -> tuple[float, float]:
    return float(found.angles["coupler_1"][order, 0]), float(found.angles["coupler_2"][order, 0])


@pytest.mark.parametrize("case", cases("geared_fivebar_position"))
def test_geared_fivebar_position(case: Case) -> None:
    found = geared_fivebar(case)
    one, other = couplers(found, 0)
    case.check(theta3=np.degrees(one), theta4=np.degrees(other))
    x = case.inputs
    fifth = x["lambda"] * x["theta2"] + x["phi"] - degrees(found.angles["output"][0, 0])
    assert fifth / 360.0 == pytest.approx(round(fifth / 360.0), abs=1e-12)


@pytest.mark.parametrize("case", cases("geared_fivebar_velocity"))
def test_geared_fivebar_velocity(case: Case) -> None:
    one, other = couplers(geared_fivebar(case), 1)
    case.check(omega3=one, omega4=other)


@pytest.mark.parametrize("case", cases("geared_fivebar_acceleration"))
def test_geared_fivebar_acceleration(case: Case) -> None:
    one, other = couplers(geared_fivebar(case), 2)
    case.check(alpha3=one, alpha4=other)


# -- straight lines (Norton 3.8) ---------------------------------------------------------------------------------------


def off_line(points: np.ndarray) -> float:
    """Largest distance from the points' best line, as a share of their spread."""
    centred = points - points.mean()
    flat = np.stack([centred.real, centred.imag])
    across = np.linalg.svd(flat, full_matrices=False)[2][-1] * np.linalg.svd(flat, compute_uv=False)[-1]
    return float(np.abs(across).max() / np.abs(centred).max())


def exact_line(case: Case) -> np.ndarray:
    """Points of the exact line, over as much of a turn as the linkage allows."""
    x = case.inputs
    theta = np.linspace(0.0, 2.0 * np.pi, 181)
    if x["mechanism"] == "peaucellier":
        made = catalogue.make_peaucellier(0j, -1.0, 1.0, 3.0, 1.25, 0.4)
        found = drive(made, theta, order=0)
        return found.joints["P"][0][found.valid]
    a, b = x["link2"], x["link3"]
    made = catalogue.make_geared_fivebar(0j, x["link1"], a, b, b, a, x["lambda"], np.radians(x["phi"]), 0.4)
    found = drive(made, theta, order=0)
    return found.joints["C"][0][found.valid]


@pytest.mark.parametrize("case", cases("straight_line_exact"))
def test_exact_straight_line(case: Case) -> None:
    points = exact_line(case)
    assert len(points) > 50
    assert np.ptp(np.abs(points - points[0])) > 1.0
    case.check(deviation=off_line(points))


def hoeken(ground: float, coupler: float) -> Mechanism:
    """Links L1, L2 = 1, L3 = L4 = BP with A, B, P in line (Norton Fig. 3-29, Table 3-1)."""
    linkage = Fourbar.from_lengths(1.0, coupler, coupler, ground, 2.0 * coupler)
    return catalogue.make_fourbar(linkage, np.pi)


def line_errors(ground: float, coupler: float, beta: float, step: float) -> dict[str, float]:
    """Length of the line, and errors across it and of the velocity along it in percent, by the table's sampling."""
    theta = np.radians(np.arange(180.0 - beta / 2.0, 180.0 + beta / 2.0 + step / 2.0, step))
    found = drive(hoeken(ground, coupler), theta, order=1)
    point, velocity = found.joints["P"]
    dx = np.ptp(point.real)
    speed = np.abs(velocity.real)
    return {
        "dx": dx,
        "dCy_pct": 100.0 * np.ptp(point.imag) / dx,
        "dV_pct": 100.0 * np.ptp(speed) / speed.mean(),
    }


@pytest.mark.parametrize("case", cases("straight_line_optimum"))
def test_hoeken_table(case: Case) -> None:
    x = case.inputs
    errors = line_errors(x["L1_over_L2"], x["L3_over_L2_exact"], x["dbeta"], x["step_deg"])
    case.check(theta_start=180.0 - x["dbeta"] / 2.0, pct_cycle=x["dbeta"] / 3.6, **errors)


@pytest.mark.parametrize("case", cases("straight_line_vx_column"))
def test_hoeken_velocity_column(case: Case) -> None:
    """The lengths of the table lie on 2 L3 = 3 L1 − L2."""
    x = case.inputs
    found = {}
    for beta, ground in zip(x["dbeta"], x["L1_over_L2"], strict=True):
        motion = drive(hoeken(ground, (3.0 * ground - 1.0) / 2.0), [np.pi], order=1)
        found[f"Vx_{beta}"] = abs(motion.joints["P"][1, 0].real)
    case.check(**found)


@pytest.mark.parametrize("case", cases("straight_line_design"))
def test_hoeken_design(case: Case) -> None:
    x = case.inputs
    crank = x["dx"] / x["dx_over_L2"]
    ground = x["L1_over_L2"]
    errors = line_errors(ground, (3.0 * ground - 1.0) / 2.0, x["dbeta"], 2.0)
    case.check(
        L2=crank,
        L1=crank * ground,
        L3=crank * x["L3_over_L2"],
        dCy_abs=errors["dCy_pct"] * x["dx"] / 100.0,
        dCy_pct=errors["dCy_pct"],
        dV_pct=errors["dV_pct"],
    )
