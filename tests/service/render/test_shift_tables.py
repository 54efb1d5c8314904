"""Shift tables of planetary gearboxes and the drift of clock trains, as a client asks for them."""

from __future__ import annotations

from typing import Any

import httpx
import pytest

SIMPSON: dict[str, Any] = {
    "type": "planetary_train",
    "arrangement": "simpson",
    "teeth": {"sun_1": 30, "planet_1": 18, "ring_1": 66, "sun_2": 30, "planet_2": 18, "ring_2": 66},
    "output": "carrier_1",
}
ELEMENTS: list[dict[str, Any]] = [
    {"name": "forward", "clutch": ["input", "ring_1"]},
    {"name": "direct", "clutch": ["sun", "input"]},
    {"name": "band", "brake": "sun"},
    {"name": "low and reverse", "brake": "carrier_2"},
]
SET: dict[str, Any] = {
    "type": "planetary_train",
    "arrangement": "simple",
    "teeth": {"sun": 40, "planet": 20, "ring": 80},
    "input": "sun",
    "output": "carrier",
}


NAMED: dict[str, Any] = {
    "type": "planetary_train",
    "meshes": [{"first": "input", "second": "ring", "carrier": "arm", "first_teeth": 20, "second_teeth": 60}],
}


def told(client: httpx.Client, **body: Any) -> dict[str, Any]:
    answer: dict[str, Any] = client.post("/v1/analyses", json=body).raise_for_status().json()
    return answer


def faults(client: httpx.Client, **body: Any) -> list[str]:
    answer = client.post("/v1/analyses", json=body)
    assert answer.status_code == 422, answer.text
    return [fault["path"] for fault in answer.json()["errors"]]


def test_three_gears_and_reverse_of_simpson(client: httpx.Client) -> None:
    """With ρ = sun/ring the gears are 2 + ρ, 1 + ρ, 1 and −1/ρ (H. W. Simpson, US patent 2,856,794)."""
    table = told(client, mechanism=SIMPSON, include=["shift_table"], elements=ELEMENTS)["shift_table"]
    assert [(state["engaged"], state["exact_ratio"]) for state in table] == [
        (["forward", "low and reverse"], "27/11"),
        (["forward", "band"], "16/11"),
        (["forward", "direct"], "1"),
        (["direct", "low and reverse"], "-11/5"),
    ]
    for state in table:
        assert state["speeds"]["carrier_1"] == pytest.approx(1 / state["ratio"])
        assert set(state["speeds"]) == {"sun", "ring_1", "carrier_1", "carrier_2", "planet_1", "planet_2"}
    assert [state["efficiency"] is None for state in table] == [False, False, True, False]
    # The first gear as the analysis tells it when it is stated with its brake.
    alone = told(client, mechanism={**SIMPSON, "input": "ring_1", "fixed": "carrier_2"})
    assert alone["exact_ratio"] == "27/11"
    assert alone["efficiency"] == pytest.approx(table[0]["efficiency"])
    assert "shift_table" not in alone


def test_without_elements_every_member_can_be_held_and_any_two_joined(client: httpx.Client) -> None:
    table = told(client, mechanism=SET, include=["shift_table"])["shift_table"]
    assert [(state["engaged"], state["exact_ratio"]) for state in table] == [
        (["brake ring"], "3"),
        (["clutch carrier-ring"], "1"),
        (["clutch sun-carrier"], "1"),
        (["clutch sun-ring"], "1"),
    ]
    less = told(client, mechanism=SET, include=["shift_table"], mesh_efficiency=0.9)["shift_table"]
    assert less[0]["efficiency"] < table[0]["efficiency"]


def test_a_member_may_have_any_name(client: httpx.Client) -> None:
    """A clutch to a member named input joins that member, where the input shaft sits on one."""

    def table(name: str, **fields: Any) -> list[tuple[str, float]]:
        meshes = [
            {"first": name, "second": "p", "carrier": "arm", "first_teeth": 30, "second_teeth": 20},
            {"first": "p", "second": "ring", "carrier": "arm", "first_teeth": 20, "second_teeth": 70, "internal": True},
        ]
        mechanism = {"type": "planetary_train", "meshes": meshes, "planet_bodies": ["p"], "output": "ring", **fields}
        held = [{"name": "brake", "brake": name}, {"name": "lock", "clutch": [name, "arm"]}]
        states = told(client, mechanism=mechanism, include=["shift_table"], elements=held)["shift_table"]
        return [(state["exact_ratio"], state["efficiency"]) for state in states]

    assert [ratio for ratio, _ in table("sun", input="arm")] == ["1", "7/10"]
    assert table("input", input="arm") == table("sun", input="arm")


@pytest.mark.parametrize(
    ("body", "path"),
    [
        ({"mechanism": {**SIMPSON, "output": None}, "elements": ELEMENTS}, "/mechanism/output"),
        ({"mechanism": {**SIMPSON, "output": "planet_1"}, "elements": ELEMENTS}, "/mechanism/output"),
        ({"mechanism": {**SIMPSON, "input": "carrier_1"}}, "/mechanism/output"),
        ({"mechanism": SIMPSON}, "/elements"),
        ({"mechanism": {**SIMPSON, "input": "sun"}, "elements": ELEMENTS}, "/elements/0/clutch"),
        ({"mechanism": SIMPSON, "elements": [*ELEMENTS, {"name": "band", "brake": "ring_1"}]}, "/elements/4/name"),
        ({"mechanism": SIMPSON, "elements": [{"name": "a", "brake": "wheel"}]}, "/elements/0/brake"),
        ({"mechanism": SIMPSON, "elements": [{"name": "a", "clutch": ["sun", "sun"]}]}, "/elements/0/clutch"),
        ({"mechanism": SIMPSON, "elements": [{"name": "a"}]}, "/elements/0"),
        (
            {"mechanism": SIMPSON, "elements": [{"name": "a", "brake": "sun", "clutch": ["sun", "ring_1"]}]},
            "/elements/0",
        ),
        (
            {"mechanism": {**NAMED, "output": "ring"}, "elements": [{"name": "a", "clutch": ["input", "arm"]}]},
            "/elements/0/clutch",
        ),
        ({"mechanism": SIMPSON, "elements": []}, "/elements"),
        ({"mechanism": SET, "include": ["shift_tables"]}, "/include/0"),
    ],
)
def test_a_table_that_cannot_be_meant_names_the_field(client: httpx.Client, body: dict[str, Any], path: str) -> None:
    assert path in faults(client, **{"include": ["shift_table"], **body})


def test_elements_without_a_table_are_not_ignored(client: httpx.Client) -> None:
    assert faults(client, mechanism={**SET, "fixed": "ring"}, elements=ELEMENTS[2:]) == ["/elements"]


CLOCK = {"type": "gear_train", "stages": [{"driver": 20, "driven": 60}, {"driver": 20, "driven": 40}]}


@pytest.mark.parametrize(
    ("mechanism", "wanted"),
    [
        (CLOCK, "6.0001"),
        ({**SET, "fixed": "ring"}, "3.00005"),
        ({"type": "train_series", "units": [{**SET, "fixed": "ring"}, CLOCK]}, "18.0003"),
    ],
)
def test_a_clock_train_gains_or_loses(client: httpx.Client, mechanism: dict[str, Any], wanted: str) -> None:
    """A ratio too small by 1/60000 turns the output too fast: by 86400/60000 seconds a day."""
    drift = told(client, mechanism=mechanism, wanted_ratio=wanted)["drift"]
    assert drift["relative_error"] == pytest.approx(-1 / 60001, rel=1e-9)
    assert drift["seconds_per_day"] == pytest.approx(1.44, rel=1e-9)
    assert drift["days_per_second"] == pytest.approx(1 / 1.44, rel=1e-9)
    slow = told(client, mechanism=mechanism, wanted_ratio=float(wanted) - 0.01)["drift"]
    assert slow["seconds_per_day"] < 0.0
    assert "drift" not in told(client, mechanism=mechanism)
    other = told(client, mechanism=mechanism, wanted_ratio=f"-{wanted}")["drift"]
    assert other == {**drift, "opposite": True}, "it turns the other way"
    assert "opposite" not in drift


def test_a_worm_of_either_hand_drifts_from_the_size_of_a_ratio(client: httpx.Client) -> None:
    """The sign of its ratio is that about axes which cross, not the sense that a wanted ratio could state."""
    worm: dict[str, Any] = {"type": "worm", "driver": 2, "driven": 40}
    for hand in ("right", "left"):
        train = {"type": "gear_train", "stages": [worm | {"hand": hand}]}
        drift = told(client, mechanism=train, wanted_ratio="20.002")["drift"]
        assert drift["relative_error"] == pytest.approx(-1 / 10001, rel=1e-9)
        assert drift.get("opposite", False) == (hand == "left")


def test_a_train_without_error_never_is_off(client: httpx.Client) -> None:
    drift = told(client, mechanism=CLOCK, wanted_ratio="6")["drift"]
    assert drift == {"relative_error": 0.0, "seconds_per_day": 0.0, "days_per_second": None}


def test_a_wanted_ratio_needs_an_output(client: httpx.Client) -> None:
    assert faults(client, mechanism={**SET, "fixed": "ring", "output": None}, wanted_ratio="3") == ["/wanted_ratio"]
    assert faults(client, mechanism=CLOCK, wanted_ratio="six") == ["/wanted_ratio"]
