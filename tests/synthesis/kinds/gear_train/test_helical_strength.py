"""Stresses in helical teeth: a worked example of the textbook, lines of contact that are counted, trains that carry."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from kinematics.gear import strength
from synthesis.analyses import parse_request
from synthesis.dispatch import solve
from synthesis.kinds.gear_train.design import GearTrainResult
from synthesis.registry import parse_problem

PSI = 0.006894757293168
HP = 0.745699871582
LBF = 4.4482216152605

ENCLOSED = {"type": "gear_pair", "teeth": [17, 52], "module": 0.1, "helix_angle": 30.0, "face_width": 1.5}
"""Shigley, 8th ed., Example 14-5: the pair of Example 14-4 with helical teeth, 4 hp at 1800 rev/min."""

PRINTED = {"bending_geometry": [0.423, 0.529], "form": [0.303, 0.412], "elastic": 2300.0 * math.sqrt(PSI)}


def judged(mechanism: dict[str, Any], unit: str = "in", **stated: Any) -> dict[str, Any]:
    request = parse_request({"mechanism": mechanism, "speed_rpm": 1800.0, "length_unit": unit, "strength": stated})
    assert request.find_errors() == []
    found = request.build_answer()["strength"]
    assert isinstance(found, dict)
    return found


def test_stresses_of_an_enclosed_helical_pair() -> None:
    """Example 14-5: σ = 3445 and 2779 psi, σ_c = 48 230 psi with I = 0.195, J from charts; V = 925 ft/min."""
    found = judged(ENCLOSED, power_kw=4.0 * HP, factors={**PRINTED, "contact_geometry": 0.195})
    assert found["pitch_line_velocity"] * 60.0 / 0.3048 == pytest.approx(925.0, abs=0.5)
    assert found["tangential_force"] / LBF == pytest.approx(142.7, abs=0.05)
    assert found["dynamic"] == pytest.approx(1.404, abs=5e-4)
    assert found["load_distribution"] == pytest.approx(1.208, abs=5e-4)
    assert [gear["size_factor"] for gear in found["gears"]] == pytest.approx([1.043, 1.052], abs=5e-4)
    # The book goes on with rounded factors.
    assert [gear["bending_stress"] / PSI for gear in found["gears"]] == pytest.approx([3445.0, 2779.0], rel=6e-4)
    assert found["gears"][0]["contact_stress"] / PSI == pytest.approx(48_230.0, rel=6e-4)


def test_the_factor_of_contact_is_the_example_s_on_the_safe_side() -> None:
    """With m_N = p_N / (0.95 Z) the book has 0.195; the least length of contact lines is a little less than 0.95 Z."""
    found = judged(ENCLOSED, power_kw=4.0 * HP, factors=PRINTED)
    assert 0.97 * 0.195 < found["contact_geometry"] <= 0.1955
    spur = judged({**ENCLOSED, "helix_angle": 0.0}, power_kw=4.0 * HP, factors=PRINTED)
    assert "sharing_ratio" not in spur
    assert found["sharing_ratio"] < 0.75


def counted(contact_ratio: float, overlap: float, base_helix: float) -> float:
    """Face over the least length of all lines of contact, base pitch 1: lines drawn in the field of contact."""
    width = overlap / math.tan(base_helix)
    least = math.inf
    for phase in np.linspace(0.0, 1.0, 120, endpoint=False):
        length = 0.0
        for number in range(-int(overlap) - 3, int(contact_ratio) + 4):
            # A line begins at one side of the face at x and moves on by its overlap over the face.
            start = number + phase
            entered = max(0.0, (0.0 - start) / overlap)
            left = min(1.0, (contact_ratio - start) / overlap)
            length += max(0.0, left - entered) * width / math.cos(base_helix)
        least = min(least, length)
    return width / least


@pytest.mark.parametrize("contact_ratio", [1.12, 1.35, 1.5, 1.87, 2.1])
def test_lines_of_contact_are_no_shorter_than_told(contact_ratio: float) -> None:
    nearest = math.inf
    for overlap in np.linspace(1.0, 3.4, 25):
        for helix in (0.15, 0.5):
            told = strength.compute_load_sharing(contact_ratio, 1.0, helix, overlap / math.tan(helix))
            drawn = counted(contact_ratio, float(overlap), helix)
            assert drawn <= told * (1.0 + 1e-9)
            nearest = min(nearest, told / drawn)
    assert nearest < 1.01


def test_contact_is_known_over_faces_that_overlap() -> None:
    """An axial pitch of the pair is 0.628 in; the least face is no less."""
    factors = {**PRINTED, "bending_geometry": None}
    narrow = judged({**ENCLOSED, "face_width": 0.6}, power_kw=4.0 * HP, factors=factors)
    assert narrow["gears"][0]["contact_stress"] is None
    assert "sharing_ratio" not in narrow
    assert judged({**ENCLOSED, "face_width": 0.64}, power_kw=4.0 * HP, factors=factors)["gears"][0]["contact_stress"]
    stated: dict[str, Any] = {"power_kw": 0.1, "allowable_contact": [900.0, 900.0]}
    assert judged({**ENCLOSED, "face_width": None}, **stated)["face_width"] == pytest.approx(0.2 * math.pi, rel=1e-6)


@pytest.mark.parametrize("hand", [1.0, -1.0])
def test_stresses_of_a_helix_that_vanishes_are_those_of_spur_teeth(hand: float) -> None:
    """But for the load that helical teeth share: 17:52 has a contact ratio of 1.6 with full depth."""
    stated: dict[str, Any] = {"power_kw": 3.0, "factors": {"bending_geometry": [0.3, 0.4]}}
    spur = judged({**ENCLOSED, "helix_angle": 0.0, "module": 0.1}, **stated)
    helical = judged({**ENCLOSED, "helix_angle": hand * 0.01, "module": 0.1}, **stated)
    for one, other in zip(spur["gears"], helical["gears"], strict=True):
        assert other["bending_stress"] == pytest.approx(one["bending_stress"], rel=1e-6)
        assert other["form"] == pytest.approx(one["form"], rel=1e-5)


@pytest.mark.parametrize(
    ("mechanism", "stated", "path"),
    [
        ({}, {"method": "lewis"}, "/strength/method"),
        ({}, {"allowable_bending": [200.0, 200.0]}, "/strength/allowable_bending"),
        ({"internal": True}, {}, "/strength"),
    ],
)
def test_what_is_not_known_is_refused(mechanism: dict[str, Any], stated: dict[str, Any], path: str) -> None:
    body = {"mechanism": {**ENCLOSED, **mechanism}, "speed_rpm": 100.0, "strength": {"power_kw": 1.0, **stated}}
    assert path in [place for place, _ in parse_request(body).find_errors()]


TRAIN: dict[str, Any] = {
    "kind": "gear_train",
    "ratio": "3.2",
    "teeth": {"min": 20, "max": 70},
    "stages": [{"type": "helical", "helix_angle": -20.0}],
    "modules": [1.5, 2.0, 2.5, 3.0],
    "shift": {"min": 0.0, "max": 0.0},
    "tolerance": 0.02,
    "max_designs": 4,
    "strength": {
        "power_kw": 21.5,
        "speed_rpm": 1450.0,
        "allowable_contact": [800.0, 750.0],
        "allowable_bending": [180.0, 170.0],
        "max_face_width": 14.0,
        "factors": {"bending_geometry": [0.5, 0.55]},
    },
}


def found(**changes: Any) -> GearTrainResult:
    result = solve(parse_problem({**TRAIN, **changes}), lambda share, message: None)
    assert isinstance(result, GearTrainResult)
    return result


def test_a_train_carries_what_its_pairs_carry() -> None:
    """Every pair of the ratio is judged alone as a `gear_pair`: the nearest that carry, their modules and faces."""
    stated = {name: value for name, value in TRAIN["strength"].items() if name != "speed_rpm"}
    carry = []
    for driver in range(20, 71):
        for driven in range(20, 71):
            error = abs(driven / driver / 3.2 - 1.0)
            if error > 0.02:
                continue
            for module in TRAIN["modules"]:
                pair = {"type": "gear_pair", "teeth": [driver, driven], "module": module, "helix_angle": -20.0}
                body = {"mechanism": pair, "speed_rpm": 1450.0, "strength": stated}
                width = parse_request(body).build_answer()["strength"].get("least_face_width")
                if width is not None:
                    carry.append((error, driver + driven, driver, driven, module, width))
                    break
    result = found()
    assert result.search.rejected["strength"] > 0
    told = []
    for design in result.designs:
        assert design.verification.passed
        stage = design.mechanism.stages[0]
        assert stage.face_width is not None
        told.append((stage.driver, stage.driven, stage.module, stage.face_width))
        assert design.metrics.meshes[0].overlap_ratio == pytest.approx(
            stage.face_width * math.sin(math.radians(20.0)) / (math.pi * stage.module)
        )
    expected = [row[2:] for row in sorted(carry)[: len(told)]]
    assert [one[:3] for one in told] == [one[:3] for one in expected]
    assert [one[3] for one in told] == pytest.approx([one[3] for one in expected], rel=1e-6)


def test_helical_teeth_carry_more_than_spur_teeth() -> None:
    light = {**TRAIN["strength"], "power_kw": 5.0}
    spur = found(strength=light, stages=[{"type": "external"}]).designs[0].mechanism.stages[0]
    helical = found(strength=light).designs[0].mechanism.stages[0]
    assert spur.face_width is not None
    assert helical.face_width is not None
    assert (helical.module, helical.face_width) < (spur.module, spur.face_width)
