"""The analysis core against printed numbers; the printed precision is the tolerance."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.linkage import compute_mobility
from kinematics.linkage.fourbar import (
    BARKER,
    CROSSED_ASSEMBLY,
    OPEN_ASSEMBLY,
    Fourbar,
    barker_class,
    find_input_limits,
    find_toggle_angles,
    find_transmission_extremes,
    grashof_class,
    motion,
    positions,
    transmission_angle,
)
from tests.cases import Case, cases, load, search_tasks
from tests.oracles.grashof_circuits import count_circuits

ASSEMBLY = {"open": OPEN_ASSEMBLY, "crossed": CROSSED_ASSEMBLY}
NO_INPUTS = {"ch2-mobility-app-2-3", "ch2-mobility-app-2-10", "ch2-mobility-app-2-24", "ch5-P5-15"}
TRADITIONAL = {
    "double_crank": "double-crank",
    "crank_rocker": "crank-rocker",
    "double_rocker": "double-rocker",
    "rocker_crank": "rocker-crank",
    "rocker_rocker": "triple-rocker",
}


def linkage_of(case: Case) -> Fourbar:
    x = case.inputs
    arm = x.get("p", 0.0) * np.exp(1j * np.radians(x.get("delta3", 0.0)))
    return Fourbar.from_lengths(x["a"], x["b"], x["c"], x["d"], arm)


def polar(vector: complex) -> tuple[float, float]:
    return abs(vector), float(np.degrees(np.angle(vector)))


@pytest.mark.parametrize("case", cases("mobility"))
def test_mobility(case: Case) -> None:
    x = case.inputs
    case.check(M=compute_mobility(links=x["L"], full_joints=x["J1"], half_joints=x["J2"], grounded=x["G"]))


@pytest.mark.parametrize("case", cases("grashof_class"))
def test_grashof_class(case: Case) -> None:
    case.check(**{"class": {1: "I", 2: "II", 3: "III"}[int(grashof_class(case.inputs["lengths"]))]})


@pytest.mark.parametrize("case", cases("barker_class"))
def test_barker_class(case: Case) -> None:
    ground, crank, coupler, rocker = (case.inputs[f"r{k}"] for k in (1, 2, 3, 4))
    found = barker_class(Fourbar.from_lengths(crank, coupler, rocker, ground))
    case.check(**{"type": found.type, "class": found.name, "code": found.code})


@pytest.mark.parametrize("case", cases("fourbar_position"))
def test_position(case: Case) -> None:
    at = positions(linkage_of(case), np.radians(case.inputs["theta2"]), ASSEMBLY[case.inputs["circuit"]])
    case.check(theta3=np.degrees(at.coupler_angle), theta4=np.degrees(at.output_angle))


@pytest.mark.parametrize("case", cases("fourbar_velocity"))
def test_velocity(case: Case) -> None:
    x = case.inputs
    found = motion(linkage_of(case), np.radians(x["theta2"]), ASSEMBLY[x["circuit"]], speed=x["omega2"]).velocity
    size, angle = polar(complex(found.p))
    case.check(omega3=found.coupler, omega4=found.output, VP_mag=size, VP_ang=angle)


@pytest.mark.parametrize("case", cases("fourbar_acceleration"))
def test_acceleration(case: Case) -> None:
    x = case.inputs
    found = motion(
        linkage_of(case),
        np.radians(x["theta2"]),
        ASSEMBLY[x["circuit"]],
        speed=x["omega2"],
        acceleration=x["alpha2"],
    ).acceleration
    size, angle = polar(complex(found.p))
    case.check(alpha3=found.coupler, alpha4=found.output, AP_mag=size, AP_ang=angle)


@pytest.mark.parametrize("case", cases("transmission_angle"))
def test_transmission_angle(case: Case) -> None:
    case.check(mu=np.degrees(transmission_angle(linkage_of(case), np.radians(case.inputs["theta2"]))))


@pytest.mark.parametrize("case", cases("transmission_range"))
def test_transmission_range(case: Case) -> None:
    linkage = linkage_of(case)
    least, greatest = find_transmission_extremes(linkage, 0.0, 2.0 * np.pi)
    case.check(mu_min=np.degrees(least), mu_max=np.degrees(greatest), code=barker_class(linkage).code)


@pytest.mark.parametrize("case", cases("toggle"))
def test_toggle(case: Case) -> None:
    linkage = linkage_of(case)
    angles = np.degrees(find_toggle_angles(linkage))
    case.check(theta2_toggle=list(angles[angles > 0.0]))
    np.testing.assert_allclose(angles, -angles[::-1], atol=1e-9)
    limits = find_input_limits(linkage)
    toggles = [limits.lower] * bool(limits.folded_toggle) + [limits.upper] * bool(limits.extended_toggle)
    case.check(theta2_toggle=list(np.degrees(toggles)))


@pytest.mark.parametrize("case", cases("circuits_branches"))
def test_circuits_and_branches(case: Case) -> None:
    linkage = linkage_of(case)
    found = count_circuits(linkage)
    case.check(circuits=found.circuits, branches_per_circuit=found.branches, code=barker_class(linkage).code)


@pytest.mark.parametrize("case", cases("coupler_point"))
def test_symmetrical_coupler_curve(case: Case) -> None:
    """With AB = O4B = BP the curve is symmetrical about the line from O4 to P at θ2 = 180° (Norton 3.4)."""
    a, b, d, gamma = (case.inputs[k] for k in ("a", "b", "d", "gamma"))
    linkage = Fourbar.from_lengths(a, b, b, d, b - b * np.exp(1j * np.radians(gamma)))
    theta = np.linspace(0.0, np.pi, 181)
    axis = positions(linkage, np.pi).p - linkage.output_pivot
    one, other = (positions(linkage, sign * theta).p - linkage.output_pivot for sign in (1, -1))
    mirrored = np.conj(one) * axis / np.conj(axis)
    assert np.ptp(np.abs(one)) > 0.1
    case.check(symmetry_error=np.abs(mirrored - other).max())


@pytest.mark.parametrize("case", cases("straight_line_classic"))
def test_straight_line_type(case: Case) -> None:
    ground, crank, coupler, rocker = (case.inputs[f"L{k}"] for k in (1, 2, 3, 4))
    found = barker_class(Fourbar.from_lengths(crank, coupler, rocker, ground))
    case.check(traditional=TRADITIONAL[found.motion])


def test_barker_table_is_in_order() -> None:
    assert [row.type for row in BARKER] == list(range(1, 15))
    assert [row.code for row in BARKER[:8]] == ["GCCC", "GCRR", "GRCR", "GRRC", "RRR1", "RRR2", "RRR3", "RRR4"]


def test_rows_without_inputs_are_known() -> None:
    """Norton prints answers to figures that carry no dimensions; every other row is evaluated."""
    assert {case.id for case in load() if case.inputs is None} == NO_INPUTS


def test_search_tasks_load() -> None:
    tasks = search_tasks()
    assert len(tasks) == 30
    assert all(len(task["positions"]) == 3 for task in tasks)
