"""Stresses in spur teeth: worked examples of the textbook within their printed digits, laws, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import pytest

from kinematics.gear import strength
from kinematics.gear.teeth import Gear
from synthesis.analyses import parse_request
from synthesis.model.gears.strength import StrengthSpec, Stresses

PSI = 0.006894757293168
HP = 0.745699871582
LBF = 4.4482216152605

STOCK = {"type": "gear_pair", "teeth": [16, 48], "module": 0.125, "face_width": 1.5}
"""Shigley, 8th ed., Example 14-1: 8 teeth an inch, 1.5 in wide, 16 teeth of AISI 1020, 1200 rev/min."""

ENCLOSED = {"type": "gear_pair", "teeth": [17, 52], "module": 0.1, "face_width": 1.5}
"""Shigley, 8th ed., Example 14-4: 10 teeth an inch, 1.5 in wide, 4 hp at 1800 rev/min, quality number 6."""

RING: dict[str, Any] = {"teeth": [20, 60], "internal": True, "addendum": [1.0, 0.75]}

PRINTED = {"bending_geometry": [0.30, 0.40], "form": [0.303, 0.412], "elastic": 2300.0 * math.sqrt(PSI)}


def judged(mechanism: dict[str, Any], speed: float, unit: str = "in", **stated: Any) -> dict[str, Any]:
    request = parse_request({"mechanism": mechanism, "speed_rpm": speed, "length_unit": unit, "strength": stated})
    assert request.find_errors() == []
    found = request.build_answer()["strength"]
    assert isinstance(found, dict)
    return found


def test_rated_power_of_a_stock_gear() -> None:
    """Example 14-1: at 10 kpsi the gear carries W = 365 lbf, 6.95 hp, with K_v = 1.52."""
    found = judged(STOCK, 1200.0, method="lewis", power_kw=6.95 * HP, factors={"form": [0.296, 0.4]})
    assert found["dynamic"] == pytest.approx(1.52, abs=0.005)
    printed = judged(STOCK, 1200.0, method="lewis", power_kw=6.95 * HP, factors={"form": [0.296, 0.4], "dynamic": 1.52})
    assert found["tangential_force"] / LBF == pytest.approx(365.0, abs=0.5)
    assert printed["gears"][0]["bending_stress"] / PSI == pytest.approx(10_000.0, rel=1e-3)
    assert found["gears"][0]["contact_stress"] is None


def test_stresses_of_an_enclosed_pair() -> None:
    """Example 14-4: σ = 6417 and 4854 psi, σ_c = 70 360 and 70 660 psi; four digits of a slide rule's chain."""
    found = judged(ENCLOSED, 1800.0, power_kw=4.0 * HP, factors=PRINTED)
    assert found["tangential_force"] / LBF == pytest.approx(164.8, abs=0.05)
    assert found["pitch_line_velocity"] * 60.0 / 0.3048 == pytest.approx(801.1, abs=0.05)
    assert found["dynamic"] == pytest.approx(1.377, abs=5e-4)
    assert found["load_distribution"] == pytest.approx(1.22, abs=5e-3)
    assert found["contact_geometry"] == pytest.approx(0.121, abs=5e-4)
    sizes = [gear["size_factor"] for gear in found["gears"]]
    assert sizes == pytest.approx([1.043, 1.052], abs=5e-4)
    bending = [gear["bending_stress"] / PSI for gear in found["gears"]]
    assert bending == pytest.approx([6417.0, 4854.0], rel=5e-4)
    contact = [gear["contact_stress"] / PSI for gear in found["gears"]]
    assert contact == pytest.approx([70_360.0, 70_660.0], rel=6e-4)


def test_printed_factors_give_the_printed_stresses() -> None:
    """Example 14-4 with all factors as printed: the digits are the book's."""
    factors = {
        **PRINTED,
        "dynamic": 1.377,
        "size": [1.043, 1.052],
        "load_distribution": 1.22,
        "contact_geometry": 0.121,
    }
    found = judged(ENCLOSED, 1800.0, power_kw=4.0 * HP, factors=factors)
    # The book goes on with the rounded force of 164.8 lbf.
    share = 164.8 / (found["tangential_force"] / LBF)
    assert share * found["gears"][0]["bending_stress"] / PSI == pytest.approx(6417.0, abs=0.5)
    assert share * found["gears"][1]["bending_stress"] / PSI == pytest.approx(4854.0, abs=0.5)
    assert math.sqrt(share) * found["gears"][0]["contact_stress"] / PSI == pytest.approx(70_360.0, abs=5.0)


@pytest.mark.parametrize(
    ("teeth", "form"),
    [
        (12, 0.245),
        (16, 0.296),
        (17, 0.303),
        (20, 0.322),
        (24, 0.337),
        (30, 0.359),
        (43, 0.397),
        (100, 0.447),
        (300, 0.472),
    ],
)
def test_form_factors_of_the_true_profile(teeth: int, form: float) -> None:
    """Shigley, Table 14-2, is for another fillet: the true profile is within 5 % of it."""
    assert strength.compute_lewis_form(Gear(teeth, 2.5)) == pytest.approx(form, rel=0.05)


def test_a_shift_makes_a_pinion_stronger() -> None:
    plain, shifted = ({**ENCLOSED, "shift": shift} for shift in ([0.0, 0.0], [0.4, 0.0]))
    stresses = [judged(pair, 1800.0, power_kw=3.0)["gears"][0]["bending_stress"] for pair in (plain, shifted)]
    assert stresses[1] < 0.9 * stresses[0]


def test_a_torque_bends_a_tooth_alike_at_every_distance() -> None:
    """Fewer than one pair in contact is loaded at its tip, and the normal force is the torque over the base radius."""
    stub = {"type": "gear_pair", "teeth": [17, 52], "module": 2.0, "face_width": 20.0, "addendum": [0.4, 0.4]}
    factors = {"dynamic": 1.2, "load_distribution": 1.3, "size": [1.0, 1.0]}
    stresses = [
        judged(
            {**stub, "pressure_angle": angle, "centre_distance": distance}, 1000.0, "mm", power_kw=2.0, factors=factors
        )
        for angle in (20.0, 25.0)
        for distance in (69.0, 70.4)
    ]
    bending = [found["gears"][0]["bending_stress"] for found in stresses]
    assert bending[1] == pytest.approx(bending[0], rel=1e-9)
    assert bending[3] == pytest.approx(bending[2], rel=1e-9)
    assert stresses[1]["tangential_force"] < 0.99 * stresses[0]["tangential_force"]


def test_the_least_width_is_on_its_limit() -> None:
    pair = {name: value for name, value in ENCLOSED.items() if name != "face_width"}
    allowed: dict[str, Any] = {"allowable_bending": [90.0, 80.0], "allowable_contact": [600.0, 600.0]}
    found = judged(pair, 1800.0, power_kw=3.0, **allowed)
    safeties = [gear[name] for gear in found["gears"] for name in ("bending_safety", "contact_safety")]
    assert min(safeties) == pytest.approx(1.0, abs=1e-9)
    assert found["face_width"] == found["least_face_width"]
    thin = judged({**pair, "face_width": 0.99 * found["least_face_width"]}, 1800.0, power_kw=3.0, **allowed)
    assert min(gear["contact_safety"] for gear in thin["gears"]) < 1.0
    weak = judged(pair, 1800.0, power_kw=3.0, max_face_width=2.0, **allowed)
    assert weak["face_width"] is None
    assert "least_face_width" not in weak
    assert all(gear["bending_stress"] is None for gear in weak["gears"])


def test_units_of_length_change_nothing() -> None:
    metric = {**ENCLOSED, "module": 2.54, "face_width": 38.1}
    inch, millimetre = judged(ENCLOSED, 1800.0, power_kw=3.0), judged(metric, 1800.0, "mm", power_kw=3.0)
    for one, other in zip(inch["gears"], millimetre["gears"], strict=True):
        assert one["bending_stress"] == pytest.approx(other["bending_stress"])
        assert one["contact_stress"] == pytest.approx(other["contact_stress"])


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"method": "lewis"}, "bending_stress"),
        ({"power_kw": 4.0}, "bending_stress"),
        ({"quality": 9.0}, "bending_stress"),
        ({"factors": {"overload": 1.5}}, "contact_stress"),
        ({"factors": {"dynamic": 1.1}}, "contact_stress"),
        ({"factors": {"size": [1.2, 1.2]}}, "bending_stress"),
        ({"factors": {"load_distribution": 1.6}}, "contact_stress"),
        ({"factors": {"rim": 1.3}}, "bending_stress"),
        ({"factors": {"form": [0.3, 0.4]}}, "size_factor"),
        ({"factors": {"bending_geometry": [0.3, 0.4]}}, "bending_stress"),
        ({"factors": {"contact_geometry": 0.1}}, "contact_stress"),
        ({"factors": {"elastic": 160.0}}, "contact_stress"),
        ({"allowable_bending": [200.0, 200.0]}, "bending_safety"),
        ({"allowable_contact": [900.0, 900.0]}, "contact_safety"),
    ],
)
def test_every_field_counts(changes: dict[str, Any], told: str) -> None:
    plain = judged(ENCLOSED, 1800.0, power_kw=3.0)
    changed = judged(ENCLOSED, 1800.0, **{"power_kw": 3.0, **changes})
    assert changed["gears"][0][told] != plain["gears"][0][told]


@pytest.mark.parametrize(
    ("mechanism", "body", "path"),
    [
        ({"helix_angle": 10.0, "internal": True}, {}, "/strength"),
        ({}, {"speed_rpm": 0.0}, "/speed_rpm"),
        ({"face_width": None}, {}, "/mechanism/face_width"),
        (
            {},
            {"strength": {"method": "lewis", "power_kw": 1.0, "allowable_contact": [1.0, 1.0]}},
            "/strength/allowable_contact",
        ),
        *(
            (
                {},
                {"strength": {"method": "lewis", "power_kw": 1.0, "factors": {name: value}}},
                f"/strength/factors/{name}",
            )
            for name, value in {
                "size": [1.1, 1.1],
                "load_distribution": 1.2,
                "rim": 1.3,
                "bending_geometry": [0.3, 0.4],
                "contact_geometry": 0.1,
                "elastic": 160.0,
            }.items()
        ),
        ({}, {"strength": {"method": "lewis", "power_kw": 1.0, "quality": 9.0}}, "/strength/quality"),
        (RING, {"strength": {"power_kw": 1.0, "allowable_bending": [200.0, 1.0]}}, "/strength/allowable_bending"),
        (
            RING,
            {
                "strength": {
                    "method": "lewis",
                    "power_kw": 1.0,
                    "allowable_bending": [200.0, 1.0],
                    "factors": {"overload": 1.5},
                }
            },
            "/strength/allowable_bending",
        ),
    ],
)
def test_faults(mechanism: dict[str, Any], body: dict[str, Any], path: str) -> None:
    stated = {"mechanism": {**ENCLOSED, **mechanism}, "speed_rpm": 100.0, "strength": {"power_kw": 1.0}, **body}
    assert [fault[0] for fault in parse_request(stated).find_errors()] == [path]


@pytest.mark.parametrize(("method", "name"), [("agma", "bending_geometry"), ("lewis", "form")])
def test_the_width_of_a_ring_keeps_its_stated_bending(method: str, name: str) -> None:
    pair = {"type": "gear_pair", **RING, "module": 2.0}
    stated: dict[str, Any] = {"method": method, "power_kw": 3.0, "max_face_width": 50.0}
    factors = {name: [0.35, 0.5]}
    wide, narrow = (
        judged(pair, 1000.0, "mm", **stated, allowable_bending=[200.0, allowable], factors=factors)
        for allowable in (60.0, 150.0)
    )
    assert wide["gears"][1]["bending_safety"] == pytest.approx(1.0)
    assert wide["least_face_width"] > narrow["least_face_width"]


def test_no_least_width_without_all_stresses() -> None:
    """A tooth that its load does not bend has no bending stress; stated allowable stresses cannot be kept then."""
    unknown = {"bending_safety": None, "contact_safety": 2.0}
    known = {"bending_safety": 1.5, "contact_safety": None}
    load = strength.Load(1.0, 1.0, 1.0, 1.0, 1.0)
    assert not Stresses(load, 1.0, None, None, [unknown, unknown]).has_safeties(["bending_safety"])
    assert not Stresses(load, 1.0, None, None, [unknown, known]).has_safeties(["bending_safety"])
    assert Stresses(load, 1.0, None, None, [known, known]).has_safeties(["bending_safety"])
    assert StrengthSpec(power_kw=1.0, allowable_bending=(1.0, 1.0)).required_safeties == ["bending_safety"]


def test_a_ring_is_judged_by_contact() -> None:
    ring = {"type": "gear_pair", "teeth": [20, 60], "internal": True, "addendum": [1.0, 0.7], "shift": [0.3, 0.3]}
    found = judged({**ring, "module": 2.0, "face_width": 20.0}, 1000.0, "mm", power_kw=2.0)
    assert found["gears"][0]["bending_stress"] > 0.0
    assert found["gears"][1]["bending_stress"] is None
    assert found["gears"][1]["contact_stress"] > 0.0


def test_a_stage_of_a_train_has_the_stresses_of_its_pair() -> None:
    """A train of the pair of Example 14-4 carries its power as the pair alone does; so do shifted stages and idlers."""
    stage = {"driver": 17, "driven": 52, "module": 2.54, "face_width": 38.1}
    pair = judged({**ENCLOSED, "module": 2.54, "face_width": 38.1}, 1800.0, "mm", power_kw=3.0)
    torque = 3000.0 / (1800.0 * math.pi / 30.0)
    body: dict[str, Any] = {
        "mechanism": {"type": "gear_train", "stages": [stage, {**stage, "driver": 20, "driven": 60}]},
        "motion": {"at": 0.0, "speed_rpm": 1800.0},
        "input_torque": torque,
        "mesh_efficiency": 1.0,
        "strength": {},
    }
    request = parse_request(body)
    assert request.find_errors() == []
    first, second = (mesh["strength"] for mesh in request.build_answer()["meshes"])
    for one, other in zip(first["gears"], pair["gears"], strict=True):
        assert {name: one[name] for name in one} == pytest.approx(other)
    assert second["tangential_force"] * second["pitch_line_velocity"] == pytest.approx(3000.0)
    assert second["pitch_line_velocity"] == pytest.approx(1800.0 * math.pi / 30.0 * 17 / 52 * 0.0254)
    shifted = {**stage, "shift": {"driver": 0.3, "driven": -0.1}}
    body["mechanism"] = {"type": "gear_train", "stages": [shifted]}
    alone = {**ENCLOSED, "module": 2.54, "face_width": 38.1, "shift": [0.3, -0.1]}
    said = parse_request(body).build_answer()["meshes"][0]["strength"]
    wanted = judged(alone, 1800.0, "mm", power_kw=3.0)
    for one, other in zip(said["gears"], wanted["gears"], strict=True):
        assert one["bending_stress"] == pytest.approx(other["bending_stress"])
        assert one["contact_stress"] == pytest.approx(other["contact_stress"])


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"input_torque": 0.0}, "/strength"),
        ({"motion": {"at": 0.0, "speed_rpm": 0.0}}, "/strength"),
        ({}, "/mechanism/stages/0/face_width"),
    ],
)
def test_faults_of_a_train(changes: dict[str, Any], path: str) -> None:
    train = {"type": "gear_train", "stages": [{"driver": 17, "driven": 52, "module": 2.54}]}
    stated = {"mechanism": train, "motion": {"at": 0.0, "speed_rpm": 100.0}, "strength": {}, **changes}
    assert path in [fault[0] for fault in parse_request(stated).find_errors()]
