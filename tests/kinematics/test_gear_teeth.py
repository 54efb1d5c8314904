"""Spur teeth and meshes: printed values, limits found by geometry, laws of the involute."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from kinematics.errors import DimensionError
from kinematics.gear.teeth import (
    Gear,
    Mesh,
    compute_min_teeth,
    find_largest_gear,
    find_saving_shift,
    invert_involute,
    involute,
)
from tests.cases import Case, cases
from tests.oracles.gear_formulas import (
    INCH,
    arc_of_contact,
    backlash,
    fine_pitch_dedendum,
    largest_addendum,
    least_pinion,
    rack_interferes,
    rack_path,
    trims,
)


def mesh_of(first: int, second: int, pitch: float, degrees: float) -> Mesh:
    return Mesh(*(Gear(n, 1.0 / pitch, math.radians(degrees)) for n in (first, second)))


def gear_by_radii(radius: float, tip: float, pitch: float, degrees: float, internal: bool = False) -> Gear:
    module = pitch / math.pi
    addendum = abs(tip - radius) / module
    return Gear(2.0 * radius / module, module, math.radians(degrees), addendum, internal=internal)


@pytest.mark.parametrize("case", cases("agma_table", "gear"))
def test_tooth_proportions(case: Case) -> None:
    pitch = case.inputs["pd"]
    dedendum = fine_pitch_dedendum(pitch) if pitch >= 20 else 1.25
    gear = Gear(30, 1.0 / pitch, dedendum=dedendum)
    case.check(
        a=gear.addendum * gear.module,
        b=gear.dedendum * gear.module,
        working_depth=2.0 * gear.addendum * gear.module,
        whole_depth=gear.whole_depth,
        thickness=gear.tooth_thickness,
        clearance=Mesh(gear, gear).clearance,
    )


@pytest.mark.parametrize("case", cases("pd_of_module", "gear"))
def test_diametral_pitch_of_module(case: Case) -> None:
    case.check(pd=INCH / case.inputs["m"])


@pytest.mark.parametrize("case", cases("min_rack", "gear"))
def test_least_teeth_with_rack(case: Case) -> None:
    case.check(t_min=compute_min_teeth(math.radians(case.inputs["phi"])))


@pytest.mark.parametrize("case", cases("phi_for_rack", "gear"))
def test_pressure_angle_for_a_rack(case: Case) -> None:
    phi = math.asin(math.sqrt(2.0 / case.inputs["t"]))
    case.check(phi=math.degrees(phi))
    gear = Gear(case.inputs["t"], 1.0, phi)
    assert not rack_interferes(gear, 1.0)
    assert rack_interferes(gear, 1.001)


@pytest.mark.parametrize("case", cases("max_gear", "gear"))
def test_largest_gear(case: Case) -> None:
    pinion, phi = case.inputs["Np"], case.inputs["phi"]
    largest = find_largest_gear(pinion, math.radians(phi))
    case.check(Ng=largest)
    assert not mesh_of(pinion, largest, 1.0, phi).interferes
    assert mesh_of(pinion, largest + 1, 1.0, phi).interferes


@pytest.mark.parametrize("case", cases("spur_pair", "gear"))
def test_spur_pair(case: Case) -> None:
    x = case.inputs
    mesh = mesh_of(x["Np"], x["Ng"], x["pd"], x["phi"])
    case.check(
        Z=mesh.path_of_contact,
        m_p=mesh.contact_ratio,
        dp=2.0 * mesh.pinion.pitch_radius,
        dg=2.0 * mesh.gear.pitch_radius,
        m_G=mesh.gear.teeth / mesh.pinion.teeth,
        interferes=mesh.interferes,
        C=mesh.centre_distance,
        a=mesh.pinion.addendum * mesh.pinion.module,
        b=mesh.pinion.dedendum * mesh.pinion.module,
    )


@pytest.mark.parametrize("case", cases("largest_tooth", "gear"))
def test_largest_tooth(case: Case) -> None:
    x = case.inputs
    teeth = compute_min_teeth(math.radians(x["phi"]))
    if x.get("method") == "pair_integer":
        ratio = x["d_gear"] / x["d_pinion"]
        teeth = next(n for n in range(5, 40) if not mesh_of(n, ratio * n, 1.0, x["phi"]).interferes)
    case.check(teeth=teeth, pd=teeth / x["d_pinion"])


@pytest.mark.parametrize("case", cases("spur_std", "gear"))
def test_standard_gear(case: Case) -> None:
    x = case.inputs
    gear = Gear(x["N"], 1.0 / x["pd"], dedendum=x["b_factor"])
    case.check(
        d=2.0 * gear.pitch_radius,
        r=gear.pitch_radius,
        pc=gear.circular_pitch,
        t=gear.tooth_thickness,
        a=gear.tip_radius - gear.pitch_radius,
        b=gear.pitch_radius - gear.root_radius,
        c=Mesh(gear, gear).clearance,
    )


@pytest.mark.parametrize("case", cases("generation_arc", "gear"))
def test_arc_on_base_circle(case: Case) -> None:
    x = case.inputs
    gear = Gear(25, 2.0 * x["pitch_radius"] / 25, math.radians(x["phi"]))
    case.check(on_base=gear.base_radius * math.radians(x["step_deg"]))


@pytest.mark.parametrize("case", cases("path_pair", "gear"))
def test_path_of_contact(case: Case) -> None:
    x = case.inputs
    mesh = Mesh(
        gear_by_radii(x["r3"], x["R3"], x["pc"], x["phi"]),
        gear_by_radii(x["r2"], x["R2"], x["pc"], x["phi"]),
    )
    recess, approach = (part / math.cos(mesh.pressure_angle) for part in (mesh.recess, mesh.approach))
    turned = arc_of_contact(mesh) / x["r3"]
    case.check(
        rb3=mesh.pinion.base_radius,
        rb2=mesh.gear.base_radius,
        path3=mesh.recess,
        path3_drawn=mesh.recess,
        arc3=recess,
        arc3_drawn=recess,
        arc2=approach,
        arc2_drawn=approach,
        path=mesh.path_of_contact,
        arc=arc_of_contact(mesh),
        pc=mesh.pinion.circular_pitch,
        CR=mesh.contact_ratio,
        angle3_rad=turned,
        angle3_deg=math.degrees(turned),
        limit2=mesh.pinion.base_radius * math.tan(mesh.pressure_angle),
        interferes=mesh.interferes,
    )


@pytest.mark.parametrize("case", cases("path_rack", "gear"))
def test_rack(case: Case) -> None:
    x = case.inputs
    gear = gear_by_radii(x["r"], x["R"], x["pc"], x["phi"])
    path = sum(rack_path(gear, x["a"]))
    case.check(
        rb=gear.base_radius,
        path=path,
        arc=path / math.cos(gear.pressure_angle),
        pc=gear.circular_pitch,
        CR=path / gear.base_pitch,
        interferes=rack_interferes(gear, x["a"]),
    )


@pytest.mark.parametrize("case", cases("rack_drive", "gear"))
def test_least_pressure_angle_of_a_rack_drive(case: Case) -> None:
    x = case.inputs
    module = x["d"] / x["N"]
    phi = math.asin(math.sqrt(x["a"] / (0.5 * x["d"])))
    gear = Gear(x["N"], module, phi, x["a"] / module)
    path = sum(rack_path(gear, x["a"]))
    ratio = path / gear.base_pitch
    case.check(phi=math.degrees(phi), arc=path / math.cos(phi), CR=ratio, min_pairs=math.floor(ratio))
    assert not rack_interferes(gear, x["a"])
    assert rack_interferes(gear, 1.001 * x["a"])


@pytest.mark.parametrize("case", cases("path_internal", "gear"))
def test_internal_pair(case: Case) -> None:
    x = case.inputs
    mesh = Mesh(
        gear_by_radii(x["r"], x["R_tip"], x["pc"], x["phi"]),
        gear_by_radii(x["Rg"], x["Rg_tip"], x["pc"], x["phi"], internal=True),
    )
    case.check(path=mesh.path_of_contact, arc=arc_of_contact(mesh), CR=mesh.contact_ratio)


@pytest.mark.parametrize("case", cases("max_addendum", "gear"))
def test_largest_addendum(case: Case) -> None:
    x = case.inputs
    phi = math.radians(x["phi"])
    found = largest_addendum(x["t"], x["T"], phi)
    case.check(a_pc=found / math.pi)
    for factor, bad in ((1.0, False), (1.001, True)):
        assert Mesh(Gear(x["t"], 1.0, phi), Gear(x["T"], 1.0, phi, factor * found)).interferes is bad


@pytest.mark.parametrize("case", cases("max_arc_equal", "gear"))
def test_longest_arc_of_equal_gears(case: Case) -> None:
    x = case.inputs
    phi, module = math.radians(x["phi"]), 1.0 / x["pd"]
    addendum = largest_addendum(x["N"], x["N"], phi)
    gear = Gear(x["N"], module, phi, addendum)
    case.check(a=addendum * module, arc=arc_of_contact(Mesh(gear, gear)))


@pytest.mark.parametrize("case", cases("teeth_for_arc", "gear"))
def test_teeth_for_an_arc_of_one_pitch(case: Case) -> None:
    phi, ratio = math.radians(case.inputs["phi"]), case.inputs["ratio"]

    def excess(teeth: float, part: str) -> float:
        mesh = Mesh(Gear(teeth, 1.0, phi), Gear(ratio * teeth, 1.0, phi))
        return getattr(mesh, part) - mesh.pinion.circular_pitch * math.cos(phi)

    def crossing(part: str) -> float:
        low, high = 3.0, 200.0
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if excess(middle, part) < 0.0 else (low, middle)
        return low

    real = crossing("recess")
    whole = next(n for n in range(math.ceil(real), 300) if (ratio * n).is_integer())
    case.check(
        t_real=real,
        t=whole,
        T=ratio * whole,
        t_gear_tip=crossing("approach"),
        t_interference=least_pinion(ratio, phi),
    )


@pytest.mark.parametrize("case", cases("min_pair", "gear"))
def test_least_pinion(case: Case) -> None:
    ratio, phi = case.inputs["ratio"], case.inputs["phi"]
    real = least_pinion(ratio, math.radians(phi))
    case.check(t_real=real, t_min=math.ceil(real))
    assert not mesh_of(math.ceil(real), ratio * math.ceil(real), 1.0, phi).interferes
    assert mesh_of(math.floor(real), ratio * math.floor(real), 1.0, phi).interferes


@given(st.floats(0.0, 1.5))
def test_inverse_involute(angle: float) -> None:
    value = involute(angle)
    assert invert_involute(value) == pytest.approx(angle, rel=1e-9, abs=1e-5)
    assert involute(invert_involute(value)) == pytest.approx(value, rel=1e-12, abs=1e-300)


@given(
    teeth=st.tuples(st.integers(12, 60), st.integers(12, 120)),
    shifts=st.tuples(st.floats(-0.2, 0.8), st.floats(-0.2, 0.8)),
    degrees=st.sampled_from([14.5, 20.0, 25.0]),
)
def test_tight_mesh_has_no_backlash(teeth: tuple[int, int], shifts: tuple[float, float], degrees: float) -> None:
    phi = math.radians(degrees)
    # inv φ_w: with shifts so far inwards no distance is tight, and the mesh is refused.
    assume(involute(phi) + 2.0 * math.tan(phi) * sum(shifts) / sum(teeth) > 0.0)
    mesh = Mesh(*(Gear(n, 2.0, phi, shift=x) for n, x in zip(teeth, shifts, strict=True)))
    assert backlash(mesh) == pytest.approx(0.0, abs=1e-9)
    if abs(sum(shifts)) > 1e-6:
        assert (mesh.centre_distance > mesh.standard_distance) == (sum(shifts) > 0.0)


@given(pinion=st.integers(12, 40), more=st.integers(10, 80), shift=st.floats(0.0, 0.5))
def test_tight_internal_mesh_has_no_backlash(pinion: int, more: int, shift: float) -> None:
    mesh = Mesh(Gear(pinion, 1.0, shift=0.5 * shift), Gear(pinion + more, 1.0, shift=shift, internal=True))
    assert backlash(mesh) == pytest.approx(0.0, abs=1e-9)


def test_centre_distance_changes_the_pressure_angle_only() -> None:
    tight = mesh_of(20, 40, 1.0, 20.0)
    wide = Mesh(tight.pinion, tight.gear, given_distance=30.3)
    assert wide.pressure_angle > tight.pressure_angle
    assert backlash(wide) > 0.0
    assert wide.contact_ratio < tight.contact_ratio
    assert wide.pinion.base_radius / math.cos(wide.pressure_angle) == pytest.approx(30.3 / 3.0)


@given(st.integers(6, 40), st.sampled_from([14.5, 20.0, 25.0]), st.sampled_from([0.8, 1.0]))
def test_interference_limits_agree_with_the_mesh(pinion: int, degrees: float, addendum: float) -> None:
    """The closed limits against the mesh of each gear, one by one."""
    phi = math.radians(degrees)
    one = Gear(pinion, 1.0, phi, addendum)
    free = [n for n in range(pinion, 400) if not Mesh(one, Gear(n, 1.0, phi, addendum)).interferes]
    largest = find_largest_gear(pinion, phi, addendum)
    if largest is None:
        assert free[-1] == 399
    elif largest < pinion:
        assert not free
    elif largest < 399:
        assert free[-1] == largest


def flank_points(gear: Gear, count: int = 400) -> np.ndarray:
    """Both flanks of one tooth as polar half-angle over radius, by unwinding a string: no thickness formula is used."""
    base, half = gear.base_radius, gear.tooth_thickness / (2.0 * gear.pitch_radius)
    tip = math.sqrt((gear.tip_radius / base) ** 2 - 1.0)
    roll = np.linspace(0.0, tip, count)
    unwound = base * (1.0 - 1j * roll) * np.exp(1j * roll)
    at_pitch = np.interp(gear.pitch_radius, np.abs(unwound), np.angle(unwound))
    return np.stack([np.abs(unwound), half + at_pitch - np.angle(unwound)])


def test_thickness_by_unwinding() -> None:
    gear = Gear(25, 3.0, shift=0.3)
    for radius, half in flank_points(gear).T[5::40]:
        assert gear.thickness_at(radius) == pytest.approx(2.0 * radius * half, rel=1e-4)


@pytest.mark.parametrize(("pinion", "ring"), [(40, 44), (40, 46), (40, 47), (40, 48), (40, 49), (40, 50), (30, 60)])
def test_tips_of_an_internal_pair(pinion: int, ring: int) -> None:
    """Fouling of the tips against the corner paths, followed by turning the gears in small steps."""
    mesh = Mesh(Gear(pinion, 1.0), Gear(ring, 1.0, internal=True))
    one, two = mesh.pinion, mesh.gear
    turn = np.linspace(-0.5, 1.6, 40001)
    half = one.thickness_at(one.tip_radius) / (2.0 * one.tip_radius)
    corner = mesh.centre_distance + one.tip_radius * np.exp(1j * (turn * ring / pinion + half))
    # A tight mesh: with the middle of a pinion tooth on the line of centres at turn 0, so is the middle of a space.
    in_ring = corner * np.exp(-1j * turn)
    inside = np.abs(in_ring) >= two.tip_radius
    pitch = 2.0 * math.pi / ring
    tooth = two.thickness_at(two.tip_radius) / (2.0 * two.tip_radius)
    at_tip_circle = np.interp(two.tip_radius, *corner_descent(np.abs(in_ring), np.angle(in_ring), turn))
    # The corner leaves the space where the ring's tip circle is passed: clear if still within the half space.
    clear = at_tip_circle <= 0.5 * pitch - tooth + 1e-9
    assert inside.any()
    assert mesh.tips_foul is not bool(clear)


def corner_descent(radius: np.ndarray, angle: np.ndarray, turn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Radius (increasing) and angle of the corner on its way out of the space, on the side where it leads."""
    out = turn >= turn[np.argmax(radius)]
    return radius[out][::-1], np.abs(angle[out])[::-1]


@pytest.mark.parametrize(("pinion", "gear"), [(10, 40), (12, 20), (14, 112), (17, 300), (9, 12)])
def test_a_shift_saves_a_mesh(pinion: int, gear: int) -> None:
    mesh = mesh_of(pinion, gear, 1.0, 20.0)
    assert mesh.interferes or mesh.pinion.is_undercut
    saved = find_saving_shift(mesh)
    assert saved is not None
    assert not saved.interferes
    assert not saved.pinion.is_undercut
    assert not saved.gear.is_undercut
    assert saved.contact_ratio >= 1.2
    if pinion + gear >= 36:
        assert saved.centre_distance == pytest.approx(mesh.centre_distance)


def test_no_shift_where_none_is_needed_or_none_helps() -> None:
    assert find_saving_shift(mesh_of(20, 40, 1.0, 20.0)) is None
    assert find_saving_shift(mesh_of(5, 5, 1.0, 20.0)) is None


@pytest.mark.slow
def test_loss_of_a_mesh() -> None:
    """The closed loss factor against sliding power integrated over the path of contact, all pairs sharing the load."""
    mesh = mesh_of(22, 57, 1.0, 20.0)
    pitch = mesh.pinion.base_pitch
    starts = -mesh.approach + pitch * (np.arange(20000) + 0.5) / 20000
    lost = 0.0
    for start in starts:
        places = [s for s in start + pitch * np.arange(-3, 4) if -mesh.approach <= s <= mesh.recess]
        lost += sum(abs(s) for s in places) / len(places) / len(starts)
    sliding = lost * (1.0 / mesh.pinion.base_radius + 1.0 / mesh.gear.base_radius)
    assert mesh.loss_factor == pytest.approx(sliding, rel=1e-3)


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda: Gear(0, 1.0), "teeth"),
        (lambda: Gear(20, 0.0), "module"),
        (lambda: Gear(20, 1.0, pressure_angle=2.0), "pressure_angle"),
        (lambda: Gear(20, 1.0, addendum=-1.0), "addendum and dedendum"),
        (lambda: Gear(2, 1.0), "tip and root radius"),
        (lambda: Mesh(Gear(20, 1.0, internal=True), Gear(40, 1.0)), "pinion"),
        (lambda: Mesh(Gear(20, 1.0), Gear(40, 2.0)), "module and pressure angle"),
        (lambda: Mesh(Gear(20, 1.0), Gear(20, 1.0, internal=True)), "internal gear"),
        (lambda: Mesh(Gear(20, 1.0), Gear(40, 1.0), given_distance=20.0), "centre distance"),
        (lambda: invert_involute(-1.0), "value"),
    ],
)
def test_wrong_calls(call: object, name: str) -> None:
    with pytest.raises(DimensionError, match=f"^{name} must be "):
        call()


TRIMMING = {
    15: 34, 16: 34, 17: 35, 18: 36, 19: 37, 20: 38, 21: 39, 22: 40, 24: 42, 25: 43, 27: 45, 28: 46, 30: 48, 31: 49,
    32: 50, 38: 56, 40: 58, 42: 60, 48: 66, 50: 68, 56: 74, 60: 78, 66: 84, 80: 98, 96: 114, 100: 118,
}  # fmt: skip
"""Fewest teeth of a standard ring that a pinion cutter of so many teeth does not trim at 20° (SDP/SI, Elements of
Metric Gear Technology, Table 5-3a). The cutter's addendum is 1.25 modules."""


@pytest.mark.parametrize(("cutter", "ring"), TRIMMING.items())
def test_trimming(cutter: int, ring: int) -> None:
    def trimmed(teeth: int) -> bool:
        return trims(Mesh(Gear(cutter, 1.0, addendum=1.25), Gear(teeth, 1.0, internal=True)))

    assert not any(trimmed(teeth) for teeth in (ring, ring + 1, ring + 10, 3 * ring))
    # With so few teeth of difference that the cutter is larger than the hole there is no other answer.
    assert all(trimmed(teeth) for teeth in range(cutter + 1, ring))


@pytest.mark.parametrize("pinion", [20, 30, 40, 60, 100])
def test_tips_pass_from_nine_teeth_of_difference_on(pinion: int) -> None:
    """Standard gears at 20° have no trochoid interference above 9 (the same source, Sec. 5.2)."""

    def foul(difference: int) -> bool:
        gear = Gear(pinion + difference, 1.0, internal=True)
        return gear.tip_radius >= gear.base_radius and Mesh(Gear(pinion, 1.0), gear).tips_foul

    assert not any(foul(difference) for difference in range(10, 40))
    assert all(foul(difference) for difference in (4, 5, 6, 7) if pinion >= 40)
