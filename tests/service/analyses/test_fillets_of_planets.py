"""Contact in the fillets of planetary trains, through HTTP: refused, told, and as the analysis of each pair has it."""

from __future__ import annotations

from typing import Any

import httpx
import pytest

from tests.support.service.answers import finished

STATED: dict[str, Any] = {
    "kind": "planetary_train",
    "ratio": 4.7,
    "arrangement": "simple",
    "teeth": {"min": 17, "max": 60, "ring_max": 150},
    "max_designs": 4,
}


def solved(client: httpx.Client, **stated: Any) -> dict[str, Any]:
    job = finished(client, STATED | stated)
    assert job["status"] == "succeeded", job["error"]
    result: dict[str, Any] = job["result"]
    return result


def pair_of(mechanism: dict[str, Any], gears: list[str]) -> dict[str, Any]:
    """A mesh of a design as the analysis of pairs takes it, the ring second."""
    names = sorted(gears, key=lambda name: name.startswith("ring"))
    return {
        "type": "gear_pair",
        "teeth": [mechanism["teeth"][name] for name in names],
        "internal": any(name.startswith("ring") for name in names),
        "pressure_angle": mechanism["pressure_angle"],
        "addendum": [mechanism["addendum"][name] for name in names],
    }


@pytest.mark.slow
@pytest.mark.parametrize("arrangement", ["simple", "wolfrom"])
@pytest.mark.parametrize("angle", [15.0, 20.0])
def test_every_mesh_is_told_as_the_analysis_of_its_pair_has_it(
    client: httpx.Client, arrangement: str, angle: float
) -> None:
    narrow = {"min": 17, "max": 30, "ring_max": 90}
    stated = {"arrangement": arrangement, "pressure_angle": angle, "min_contact_ratio": 1.05}
    stated |= {"teeth": narrow} if arrangement == "wolfrom" else {}
    found = {}
    for fillets in ("report", "refuse"):
        designs = solved(client, fillets=fillets, **stated)["designs"]
        assert designs
        found[fillets] = [mesh["fillet_interference"] for design in designs for mesh in design["metrics"]["meshes"]]
        for design in designs[:2]:
            for mesh in design["metrics"]["meshes"]:
                pair = {"mechanism": pair_of(design["mechanism"], mesh["gears"])}
                told = client.post("/v1/analyses", json=pair).raise_for_status().json()
                assert mesh["fillet_interference"] == any(gear["fillet_interference"] for gear in told["gears"])
                assert mesh["tip_depth"] <= 1e-6 or mesh["fillet_interference"]
    assert any(found["report"]), "full-depth rings reach into the fillets of their planets, undercut ones too"
    assert not any(found["refuse"])


def test_teeth_of_rings_are_shortened_where_fillets_are_refused(client: httpx.Client) -> None:
    plain, refused = solved(client, fillets="report"), solved(client, fillets="refuse")
    assert [one["mechanism"] for one in solved(client)["designs"]] == [one["mechanism"] for one in refused["designs"]]
    assert plain["designs"][0]["metrics"]["meshes"][1]["tip_depth"] == pytest.approx(0.003, abs=1e-4)
    assert [mesh["tip_depth"] for mesh in refused["designs"][0]["metrics"]["meshes"]] == [0.0, 0.0]
    assert plain["designs"][0]["mechanism"]["teeth"] == refused["designs"][0]["mechanism"]["teeth"]
    assert refused["designs"][0]["mechanism"]["addendum"]["ring"] < plain["designs"][0]["mechanism"]["addendum"]["ring"]
    assert "fillet_interference" in [check["name"] for check in refused["designs"][0]["verification"]["checks"]]
    # What the teeth are shortened by is missing in contact.
    ratios = [mesh["contact_ratio"] for mesh in refused["designs"][0]["metrics"]["meshes"]]
    fuller = [mesh["contact_ratio"] for mesh in plain["designs"][0]["metrics"]["meshes"]]
    assert ratios[1] < fuller[1]


def test_planets_of_many_teeth_reach_the_fillets_of_a_ring(client: httpx.Client) -> None:
    """The usual cutter of 20 teeth leaves too little involute for planets of 130 and more."""
    teeth = {"min": 40, "max": 160, "ring_max": 380, "gears": {"planet": {"min": 150, "max": 160}}}
    assert solved(client, ratio=9.0, teeth=teeth, fillets="report")["designs"]
    refused = solved(client, ratio=9.0, teeth=teeth, fillets="refuse")
    told = solved(client, ratio=9.0, teeth=teeth)["designs"]
    assert told
    assert all(any(mesh["fillet_interference"] for mesh in one["metrics"]["meshes"]) for one in told)
    assert refused["designs"] == []
    assert refused["search"]["complete"]
    assert refused["search"]["rejected"]["fillet_interference"] > 0


def test_undercut_planets_are_met_above_their_fillets(client: httpx.Client) -> None:
    """Their involutes begin where the fillet crosses the flank, above the base circle."""
    teeth = {"min": 9, "max": 60, "ring_max": 120, "gears": {"planet": {"min": 10, "max": 15}}}
    members = {"input": "sun", "output": "carrier", "fixed": "ring"}
    stated = {"ratio": 3.0, "teeth": teeth, "max_designs": 100, "fillets": "refuse", **members}
    designs = solved(client, **stated, min_contact_ratio=1.0)["designs"]
    undercut = [design for design in designs if design["metrics"]["undercut"]]
    assert undercut
    for design in undercut[:12]:
        for mesh in design["metrics"]["meshes"]:
            pair = {"mechanism": pair_of(design["mechanism"], mesh["gears"])}
            told = client.post("/v1/analyses", json=pair).raise_for_status().json()
            assert min(gear["involute_left"] for gear in told["gears"]) > -1e-6


def test_an_unknown_word_is_refused(client: httpx.Client) -> None:
    answer = client.post("/v1/jobs", json={"problem": STATED | {"fillets": "ignore"}})
    assert answer.status_code == 422
    assert [fault["path"] for fault in answer.json()["errors"]] == ["/problem/fillets"]
