"""Springs of cams through HTTP: what is stated, what is chosen, and what is refused at its field."""

from __future__ import annotations

import math

import httpx
import pytest

from tests.cases import Case, cases
from tests.service.stated.cams import CAM
from tests.support.service.cam_springs import Statement, check, designed, refused

LAWS = {"345": "polynomial_345", "4567": "polynomial_4567", "modsine": "modified_sine"}


@pytest.mark.slow
@pytest.mark.parametrize("case", cases("cam_spring", "dynamics"))
def test_springs_of_norton(client: httpx.Client, case: Case) -> None:
    x = case.inputs or {}
    segments: list[Statement] = []
    for law, angle, lift in x["segments"]:
        move = {"motion": "rise" if lift > 0 else "fall", "angle": float(angle), "lift": abs(lift)}
        segments.append({"motion": "dwell", "angle": float(angle)} if lift == 0 else {**move, "law": LAWS[law]})
    found = {}
    speed = 60.0 / x["cycle_time"]
    for rate in x["rates"]:
        dynamics = {"mass": x["m"], "spring_rate": float(rate), "damping_ratio": x["zeta"]}
        unit, radius = ("in", 0.1) if case.id == "n-p15-2" else ("m", 0.01)
        follower = {"type": "translating_roller", "roller_radius": radius}
        design = designed(client, dynamics, segments=segments, length_unit=unit, follower=follower, speed_rpm=speed)
        forces = design["metrics"]["forces"]
        found |= {f"preload_min_k{rate}": forces["least_preload"], f"wn_k{rate}": forces["natural_frequency"]}
        damped = forces["natural_frequency"] * math.sqrt(1.0 - x["zeta"] ** 2)
        assert forces["damped_frequency"] == pytest.approx(damped)
        found["inertia_force_max"] = x["m"] * (speed * math.tau / 60.0) ** 2 * design["metrics"]["peak_acceleration"]
    case.check(**found)


@pytest.mark.slow
def test_a_free_spring_presses_less_than_any_that_is_stated(client: httpx.Client) -> None:
    dynamics = {"mass": 0.5, "damping_ratio": 0.05, "least_force": 15.0, "max_rpm": 720.0}
    design = designed(client, {**dynamics, "spring_rate": "free"})
    forces = design["metrics"]["forces"]
    chosen = forces["spring"]
    assert design["verification"]["passed"]
    assert chosen["binding"] == ["least_force"]
    assert chosen["bound"] <= forces["max_contact_force"] <= chosen["bound"] * (1.0 + 1e-6)
    assert check(design, "contact_force")["value"] == pytest.approx(15.0)
    assert check(design, "contact_on_profile")["value"] == pytest.approx(15.0, abs=0.1)
    assert forces["jump_speed"] > 720.0
    for share in (0.8, 1.2):
        stated = designed(client, {**dynamics, "spring_rate": share * forces["spring_rate"]})["metrics"]["forces"]
        assert stated["max_contact_force"] > forces["max_contact_force"]
        assert "spring" not in stated
    same = designed(client, {**dynamics, "spring_rate": forces["spring_rate"], "preload": forces["preload"]})
    assert same["verification"]["passed"]
    assert same["metrics"]["forces"]["least_preload"] == pytest.approx(forces["preload"])


@pytest.mark.slow
def test_a_range_and_a_frequency_bind(client: httpx.Client) -> None:
    ranged = designed(client, {"mass": 0.5, "spring_rate": {"min": 8.0, "max": 20.0}})["metrics"]["forces"]
    assert (ranged["spring_rate"], "spring_rate/min" in ranged["spring"]["binding"]) == (8.0, True)
    capped = designed(client, {"mass": 0.5, "spring_rate": {"min": 1.0, "max": 3.0}})["metrics"]["forces"]
    assert (capped["spring_rate"], "spring_rate/max" in capped["spring"]["binding"]) == (3.0, True)
    design = designed(client, {"mass": 0.5, "spring_rate": "free", "min_frequency_ratio": 2.5})
    forces = design["metrics"]["forces"]
    assert forces["frequency_ratio"] == pytest.approx(2.5)
    assert "min_frequency_ratio" in forces["spring"]["binding"]
    assert check(design, "frequency_ratio")["limit"] == 2.5
    stated = designed(client, {"mass": 0.5, "spring_rate": 5.0, "min_frequency_ratio": 2.5})
    assert not check(stated, "frequency_ratio")["passed"]


@pytest.mark.slow
def test_contact_is_kept_up_to_the_greatest_speed(client: httpx.Client) -> None:
    dynamics = {"mass": 0.5, "spring_rate": 6.0, "preload": 10.0}
    slow = designed(client, dynamics)
    jump = slow["metrics"]["forces"]["jump_speed"]
    assert slow["verification"]["passed"]
    assert designed(client, {**dynamics, "max_rpm": 0.999 * jump})["verification"]["passed"]
    fast = designed(client, {**dynamics, "max_rpm": 1.01 * jump})
    assert not check(fast, "contact_force")["passed"]
    assert fast["metrics"]["forces"]["over_speeds"]["rpm"] == pytest.approx(1.01 * jump)


@pytest.mark.slow
def test_a_stated_preload_that_is_too_small_fails_by_name(client: httpx.Client) -> None:
    lost = designed(client, {"mass": 0.5, "spring_rate": 6.0, "preload": 10.0, "least_force": 12.0})
    assert not check(lost, "contact_force")["passed"]
    assert check(lost, "contact_force")["limit"] == 12.0
    held = designed(client, {"mass": 0.5, "spring_rate": 6.0, "preload": 14.0, "least_force": 12.0})
    assert held["verification"]["passed"]
    none = designed(client, {"mass": 0.5, "spring_rate": "free", "preload": 10.0, "least_force": 12.0})
    assert not check(none, "contact_force")["passed"]
    assert "bound" not in none["metrics"]["forces"]["spring"]


def test_an_arm_has_its_spring_at_its_end(client: httpx.Client) -> None:
    follower = {"type": "oscillating_roller", "roller_radius": 5.0, "arm": 80.0, "pivot_distance": 100.0}
    segments = [{**segment, "lift": 10.0} if "lift" in segment else segment for segment in CAM["segments"]]
    changes = {"follower": follower, "segments": segments}
    dynamics = {"mass": 0.5, "least_force": 5.0, "max_rpm": 700.0}
    free = designed(client, {**dynamics, "spring_rate": "free"}, **changes)
    assert free["verification"]["passed"]
    rate = free["metrics"]["forces"]["spring_rate"]
    stated = designed(client, {**dynamics, "spring_rate": rate}, **changes)["metrics"]["forces"]
    assert stated["max_contact_force"] == pytest.approx(free["metrics"]["forces"]["spring"]["bound"])


SOUGHT = [{**segment, **({"law": "optimal"} if "law" in segment else {})} for segment in CAM["segments"]]


@pytest.mark.parametrize(
    ("dynamics", "changes", "path"),
    [
        ({"spring_rate": {"min": 4.0, "max": 2.0}}, {}, "/dynamics/spring_rate/max"),
        ({"spring_rate": "soft"}, {}, "/dynamics/spring_rate"),
        ({"spring_rate": "free"}, {"closure": "form"}, "/dynamics/spring_rate"),
        ({"max_rpm": 700.0}, {"closure": "form"}, "/dynamics/max_rpm"),
        ({"max_rpm": 500.0}, {}, "/dynamics/max_rpm"),
        ({"max_rpm": -1.0}, {}, "/dynamics/max_rpm"),
        ({"min_frequency_ratio": -1.0}, {}, "/dynamics/min_frequency_ratio"),
        (
            {"spring_rate": {"min": 1.0, "max": 2.0}, "min_frequency_ratio": 9.0},
            {},
            "/dynamics/min_frequency_ratio",
        ),
        (
            {"spring_rate": "free"},
            {"segments": SOUGHT, "minimize": "peak_contact_force"},
            "/dynamics/spring_rate",
        ),
        (
            {"spring_rate": 4.0, "max_rpm": 700.0},
            {"segments": SOUGHT, "minimize": "peak_contact_force"},
            "/dynamics/max_rpm",
        ),
    ],
)
def test_what_is_refused(client: httpx.Client, dynamics: Statement, changes: Statement, path: str) -> None:
    paths = refused(client, {"mass": 0.5, **dynamics}, **changes)
    assert any(found.startswith(f"/problem{path}") for found in paths), paths


@pytest.mark.slow
def test_optimal_motions_by_another_criterion_take_a_free_spring(client: httpx.Client) -> None:
    dynamics = {"mass": 0.5, "spring_rate": "free", "least_force": 5.0, "max_rpm": 650.0}
    design = designed(client, dynamics, segments=SOUGHT, limits={"jerk": 3000.0})
    assert design["verification"]["passed"]
    given = designed(client, dynamics, minimize="peak_contact_force")
    forces = given["metrics"]["forces"]
    assert given["optimality"]["value"] == pytest.approx(forces["spring"]["max_contact_force"])
