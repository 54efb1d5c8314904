"""Helical, bevel and worm gears: printed dimensions and the relations between them."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kinematics.errors import DimensionError
from kinematics.gear.bevel import GLEASON_TEETH, BevelPair, compute_cone_angles
from kinematics.gear.helical import HelicalGear
from kinematics.gear.teeth import Mesh
from kinematics.gear.worm import WormSet
from tests.cases import Case, cases
from tests.oracles.gear_formulas import (
    crossed_at_distance,
    crossed_by_diameters,
    equivalent_radii,
    helical_replacement,
    helix_angle_for_distance,
    helix_angle_for_face,
    least_crossed_distance,
    smallest_worm,
    worm_of_helix,
    worm_of_lead,
)

rad, deg = math.radians, math.degrees


@pytest.mark.parametrize("case", cases("helical_pair", "gear"))
def test_helical_pair(case: Case) -> None:
    x = case.inputs
    angle = helix_angle_for_distance(x["t"], x["T"], 1.0 / x["pnd"], x["C"])
    one, other = (HelicalGear(z, 1.0 / x["pnd"], angle) for z in (x["t"], x["T"]))
    case.check(
        C=one.pitch_radius + other.pitch_radius,
        R=x["T"] / x["t"],
        ptd=1.0 / one.transverse_module,
        psi=deg(angle),
        D2=2.0 * one.pitch_radius,
        D3=2.0 * other.pitch_radius,
        pnd=1.0 / one.normal_module,
        pt=one.transverse_pitch,
        F_min=one.min_face_width(),
    )


@pytest.mark.parametrize("case", cases("helical_psi_from_width", "gear"))
def test_helix_angle_of_a_face(case: Case) -> None:
    x = case.inputs
    angle = helix_angle_for_face(1.0 / x["pnd"], x["F"])
    case.check(psi=deg(angle), ptd=x["pnd"] * math.cos(angle))
    assert HelicalGear(20, 1.0 / x["pnd"], angle).min_face_width() == pytest.approx(x["F"])


@pytest.mark.parametrize("case", cases("helical_replace", "gear"))
def test_helical_replacement(case: Case) -> None:
    x = case.inputs
    pair = helical_replacement(x["t"], x["T"], 1.0 / x["pd"], x["width"])
    assert pair is not None
    one, other = pair
    case.check(t=one.teeth, T=other.teeth, psi=deg(one.helix_angle), F_min=one.min_face_width())
    assert one.pitch_radius + other.pitch_radius == pytest.approx(0.5 * (x["t"] + x["T"]) / x["pd"])
    assert helical_replacement(7, 11, 1.0, 100.0) is None


@pytest.mark.parametrize("case", cases("crossed_by_diameters", "gear"))
def test_crossed_by_diameters(case: Case) -> None:
    x = case.inputs
    other = 2.0 * x["C"] - x["D2"]
    one_angle, other_angle = crossed_by_diameters(x["ratio"], (x["D2"], other), rad(x["theta"]))
    case.check(D3=other, psi2=deg(one_angle), psi3=deg(other_angle), n_solutions=1)
    modules = (
        x["D2"] * math.cos(one_angle) / x["t2"],
        other * math.cos(other_angle) / (x["ratio"] * x["t2"]),
    )
    assert modules[0] == pytest.approx(modules[1])


@pytest.mark.parametrize("case", cases("crossed_angles", "gear"))
def test_crossed_at_a_distance(case: Case) -> None:
    x = case.inputs
    teeth = x["t2"], round(x["ratio"] * x["t2"])
    found = crossed_at_distance(teeth, 1.0 / x["pnd"], x["C"], rad(x["theta"]))
    values = {"n_solutions": len(found), "C_min": least_crossed_distance(teeth, 1.0 / x["pnd"], rad(x["theta"]))[1]}
    for number, angles in enumerate(found, 1):
        for gear, z, angle in zip((2, 3), teeth, angles, strict=True):
            values[f"psi{gear}_{number}"] = deg(angle)
            values[f"D{gear}_{number}"] = 2.0 * HelicalGear(z, 1.0 / x["pnd"], angle).pitch_radius
    case.check(**values)
    assert crossed_at_distance(teeth, 1.0 / x["pnd"], 0.99 * values["C_min"], rad(x["theta"])) == []


@pytest.mark.parametrize("case", cases("crossed_distance", "gear"))
def test_crossed_distance(case: Case) -> None:
    x = case.inputs
    module = x["DA"] * math.cos(rad(x["psiA"])) / x["tA"]
    one, other = HelicalGear(x["tA"], module, rad(x["psiA"])), HelicalGear(x["tB"], module, rad(x["psiB"]))
    case.check(DB=2.0 * other.pitch_radius, C=one.pitch_radius + other.pitch_radius, theta=round(x["psiA"] + x["psiB"]))


@given(st.integers(12, 60), st.integers(12, 120), st.floats(0.05, 0.7))
def test_helical_teeth_in_the_transverse_plane(first: int, second: int, angle: float) -> None:
    one, other = HelicalGear(first, 2.0, angle), HelicalGear(second, 2.0, -angle)
    assert other.axial_pitch == one.axial_pitch
    mesh = Mesh(one.transverse_gear, other.transverse_gear)
    assert mesh.centre_distance == pytest.approx(one.pitch_radius + other.pitch_radius)
    assert one.transverse_gear.tip_radius - one.pitch_radius == pytest.approx(2.0)
    # The base helix: tan ψ_b = tan ψ cos φ_t, and the normal base pitch is that of the cutter.
    base = math.atan(math.tan(angle) * math.cos(one.transverse_pressure_angle))
    normal = one.transverse_gear.base_pitch * math.cos(base)
    assert normal == pytest.approx(2.0 * math.pi * math.cos(one.normal_pressure_angle))


@pytest.mark.parametrize("case", cases("bevel", "gear"))
def test_cone_angles(case: Case) -> None:
    pinion, gear = compute_cone_angles(rad(case.inputs["theta"]), case.inputs["ratio"])
    case.check(gamma_pinion=deg(pinion), gamma_gear=deg(gear))
    assert math.sin(gear) == pytest.approx(case.inputs["ratio"] * math.sin(pinion))


@pytest.mark.parametrize("case", cases("bevel_set", "gear"))
def test_bevel_pair(case: Case) -> None:
    x = case.inputs
    pair = BevelPair(x["Tp"], x["Tg"], x["pd"], rad(x["phi"]), millimetre=0.1)
    case.check(
        working=pair.working_depth,
        whole=pair.whole_depth,
        aG=pair.addenda[1],
        aP=pair.addenda[0],
        dG=pair.dedenda[1],
        dP=pair.dedenda[0],
        pc=pair.circular_pitch,
        tG=pair.thicknesses[1],
        tP=pair.thicknesses[0],
        gamma2=deg(pair.cones[0]),
        gamma3=deg(pair.cones[1]),
        r2=pair.pitch_radii[0],
        r3=pair.pitch_radii[1],
        re2=equivalent_radii(pair)[0],
        re3=equivalent_radii(pair)[1],
    )
    assert pair.cone_distance * math.sin(pair.cones[0]) == pytest.approx(pair.pitch_radii[0])


def test_equal_bevel_gears_of_gleasons_system_are_alike() -> None:
    """In Rao's they are not: the one that is called the pinion has the longer addendum."""
    pair = BevelPair(20, 20, 4.0, system=GLEASON_TEETH)
    for first, second in (pair.addenda, pair.dedenda, pair.thicknesses):
        assert first == pytest.approx(second, rel=1e-12)
    assert BevelPair(20, 20, 1.0).addenda == (pytest.approx(1.06), pytest.approx(0.94))


def test_gleasons_teeth() -> None:
    """A pair of 20 and 40 teeth of module 3 mm; by hand 0.540 · 3 + 0.460 · 3 / 4 = 1.965."""
    pair = BevelPair(20, 40, 1.0 / 3.0, system=GLEASON_TEETH)
    assert pair.addenda == (pytest.approx(4.035), pytest.approx(1.965))
    assert pair.dedenda == (pytest.approx(2.529), pytest.approx(4.599))
    assert pair.whole_depth == pytest.approx(6.564 + 0.002 * 25.4)
    assert sum(pair.thicknesses) == pytest.approx(pair.circular_pitch)


@pytest.mark.parametrize("case", cases("worm_by_lead", "gear"))
def test_worm_by_lead(case: Case) -> None:
    x = case.inputs
    worm = worm_of_lead(x["lead"], x["ratio"], x["C"])
    case.check(Dg=worm.gear_diameter, Dw=worm.worm_diameter)
    assert worm.centre_distance == pytest.approx(x["C"])


@pytest.mark.parametrize("case", cases("worm_smallest", "gear"))
def test_smallest_worm(case: Case) -> None:
    x = case.inputs
    worm = smallest_worm(x["ratio"], x["pa"], x["C"], x["max_threads"])
    assert worm is not None
    case.check(coef=worm.gear_diameter / worm.threads, Dw=worm.worm_diameter)
    assert smallest_worm(400, x["pa"], x["C"], 3) is None


@pytest.mark.parametrize("case", cases("worm_by_helix", "gear"))
def test_worm_by_helix(case: Case) -> None:
    x = case.inputs
    worm = worm_of_helix(x["tw"], x["Tg"], x["Dg"], rad(x["psi_g"]))
    case.check(
        psi_w=round(deg(worm.worm_helix_angle), 9),
        R=worm.ratio,
        Dw=worm.worm_diameter,
        lead=worm.lead,
        lead_angle_check=deg(worm.lead_angle),
    )
    assert not worm.is_locking(0.1)
    assert worm.is_locking(0.4)


@pytest.mark.parametrize(
    "call",
    [
        lambda: HelicalGear(20, 1.0, math.pi / 2.0),
        lambda: HelicalGear(0, 1.0, 0.1),
        lambda: helix_angle_for_distance(20, 30, 1.0, 24.9),
        lambda: helix_angle_for_face(1.0, 3.0),
        lambda: crossed_by_diameters(1.5, (10.0, 25.0), 0.0),
        lambda: compute_cone_angles(0.0, 2.0),
        lambda: compute_cone_angles(1.0, 0.5),
        lambda: BevelPair(30, 20, 2.0),
        lambda: WormSet(1, 20, 1.0, -2.0),
        lambda: worm_of_lead(5.0, 20, 15.0),
    ],
)
def test_wrong_calls(call: object) -> None:
    with pytest.raises(DimensionError):
        call()
