"""Flywheel, harmonics, joint force index and what is reported, in ``POST /v1/analyses``."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import httpx
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from synthesis.analyses.linkages.linkage import LinkageAnalysis
from tests.cases import Case, cases
from tests.support.service.dynamics import BLOCK, CRANK, OTHER_TYPES, Statement, asked, refused
from tests.support.service.dynamics_literature import analysed, stated
from tests.support.service.dynamics_loads import ALONE

SPEED = 12.0
TURN = {"from": 0.0, "to": 360.0, "steps": 360, "speed": SPEED}
WAVE = {
    "loads": [
        {
            "link": "input",
            "torque": {
                "table": [[a, -10.0 - 5.0 * math.sin(math.radians(a))] for a in range(0, 360, 10)],
                "interpolation": "periodic_cubic",
            },
        }
    ]
}


def fluctuation(inertia: float) -> float:
    """(ω_max − ω_min)/ω_mean of a shaft that 10 N·m drive against 10 + 5 sin θ, by its equation of motion."""

    def turn(start: float) -> tuple[float, np.ndarray]:
        def motion(_: float, state: np.ndarray) -> list[float]:
            return [state[1], -5.0 * math.sin(state[0]) / inertia]

        def once(_: float, state: np.ndarray) -> float:
            return float(state[0] - 2.0 * math.pi)

        once.terminal = True  # type: ignore[attr-defined]
        run = solve_ivp(motion, (0.0, 10.0), [0.0, start], events=once, rtol=1e-11, atol=1e-12, dense_output=True)
        time = float(run.t_events[0][0])
        return time, run.sol(np.linspace(0.0, time, 4001))[1]

    first = brentq(lambda start: turn(start)[0] - 2.0 * math.pi / SPEED, 0.8 * SPEED, 1.5 * SPEED, xtol=1e-12)
    speeds = turn(first)[1]
    return float(np.ptp(speeds)) / SPEED


def test_flywheel_of_a_sine(client: httpx.Client) -> None:
    block = WAVE | {"flywheel": {"coefficient": 0.2}}
    found = asked(client, ALONE, block, motion=TURN)["dynamics"]["flywheel"]
    assert found["energy"] == pytest.approx(10.0, rel=1e-4)
    assert found["mean_torque"] == pytest.approx(10.0, rel=1e-6)
    assert found["inertia"] == pytest.approx(10.0 / (0.2 * SPEED**2), rel=1e-4)
    assert found["coefficient_exact"] == pytest.approx(fluctuation(found["inertia"]), rel=1e-4)
    assert fluctuation(found["inertia_exact"]) == pytest.approx(0.2, rel=1e-4)
    pulses = sorted(found["pulses"], key=lambda pulse: pulse["area"])
    assert [pulse["area"] for pulse in pulses] == pytest.approx([-10.0, 10.0], rel=1e-3)
    assert (pulses[1]["from"] % 360.0, pulses[1]["to"] % 360.0) == pytest.approx((0.0, 180.0), abs=0.01)
    fitted = asked(
        client, ALONE, WAVE | {"flywheel": {"coefficient": 0.2, "existing_inertia": 0.1}}, motion=TURN
    )["dynamics"]["flywheel"]  # fmt: skip
    assert fitted["inertia"] == pytest.approx(found["inertia"] - 0.1)
    backwards = asked(client, ALONE, block, motion=TURN | {"from": 360.0, "to": 0.0})["dynamics"]["flywheel"]
    assert backwards["inertia_exact"] == pytest.approx(found["inertia_exact"], rel=1e-9)
    steady = asked(client, ALONE, {"flywheel": {"coefficient": 0.2}}, motion=TURN)["dynamics"]["flywheel"]
    assert (steady["energy"], steady["inertia"], steady["inertia_exact"], steady["pulses"]) == (0.0, 0.0, 0.0, [])
    part = asked(client, ALONE, block, motion=TURN | {"to": 100.0})["dynamics"]["flywheel"]
    assert (part["energy"], part["inertia"], part["pulses"]) == (None, None, [])


@pytest.mark.parametrize("case", cases("flywheel", "dynamics"))
def test_flywheels_of_the_books_linkages(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    body = stated(case)
    body["dynamics"]["flywheel"] = {"coefficient": given["fluctuation"]}
    fine, coarse = (
        analysed(client, body | {"motion": {"from": 0.0, "to": 360.0, "steps": steps, "speed": given["speed"]}})
        for steps in (720, 72)
    )
    drive = np.array(coarse["dynamics"]["drive"])
    found = fine["dynamics"]["flywheel"]
    # The table's extremes are those of its own steps of 5 degrees, and its first energy is that of straight lines.
    above, step = drive - drive[:-1].mean(), math.radians(5.0)
    energy = [0.0]
    for before, after in pairwise(above):
        share = before / (before - after) if before * after < 0.0 else 0.0
        energy += [energy[-1] + 0.5 * share * before * step, energy[-1] + 0.5 * (before + after) * step]
    case.check(
        T_max=drive.max(),
        T_min=drive.min(),
        T_mean_exact=found["mean_torque"],
        energy_exact=found["energy"],
        inertia_exact=found["inertia"],
        energy_5deg=np.ptp(energy),
    )


def test_harmonics_of_a_crank_and_of_a_piston(client: httpx.Client) -> None:
    unbalanced = {
        "gravity": {"magnitude": 10.0},
        "bodies": {"input": {"mass": 3.0, "cg": {"distance": 40.0}}},
        "report": ["harmonics"],
    }
    for motion in (TURN, TURN | {"from": 30.0, "to": 750.0, "steps": 96}, TURN | {"from": 360.0, "to": 0.0}):
        found = asked(client, ALONE, unbalanced, motion=motion)["dynamics"]
        assert found.keys() == {
            "units", "length_unit", "extremes", "power", "harmonics", "status", "checks", "warnings",
        }  # fmt: skip
        force, drive = found["harmonics"]["shaking_force"], found["harmonics"]["drive"]
        assert force["1"] == pytest.approx({"forward": 3.0 * 0.04 * SPEED**2, "backward": 0.0}, abs=1e-9)
        assert drive["1"] == pytest.approx({"amplitude": 3.0 * 10.0 * 0.04, "phase": 0.0}, abs=1e-9)
        assert max(drive[order]["amplitude"] for order in drive if order != "1") < 1e-9
        assert ("0.5" in force) == (motion["to"] == 750.0)
    piston = {"point_masses": [{"joint": "B", "mass": 2.0}], "report": ["harmonics", "shaking"]}
    found = asked(client, OTHER_TYPES["slider_crank"], piston, motion=TURN)["dynamics"]
    along = np.array(found["shaking"]["force"]["x"])[:-1]
    angles = np.radians(np.arange(360.0))
    for order in (1, 2, 4):
        amplitude = 2.0 * abs((along * np.exp(-1j * order * angles)).mean())
        wave = found["harmonics"]["shaking_force"][str(order)]
        assert (wave["forward"], wave["backward"]) == pytest.approx((amplitude / 2.0,) * 2)
    open_range = asked(client, ALONE, unbalanced, motion=TURN | {"to": 90.0})["dynamics"]["harmonics"]
    assert open_range == {"shaking_force": None, "shaking_moment": None, "drive": None}


def test_joint_force_index_is_the_geometrys_alone(client: httpx.Client) -> None:
    load = {"joint": "B", "force": {"constant": [-500.0, 0.0]}}
    whole = BLOCK | {"loads": [load, *BLOCK["loads"]], "report": ["joint_force_index"]}
    found = asked(client, CRANK, whole)["dynamics"]
    alone = asked(client, CRANK, {"loads": [load]})["dynamics"]
    largest = np.max(
        [np.hypot(on["x"], on["y"]) for links in alone["joints"].values() for on in links.values()], axis=0
    )
    np.testing.assert_allclose(found["joint_force_index"], largest / 500.0, rtol=1e-9)
    assert found["max_joint_force_index"] == pytest.approx(largest.max() / 500.0, rel=0.02)
    assert found["max_joint_force_index"] >= largest.max() / 500.0
    assert any("joint_force_index" in warning for warning in found["warnings"]) == (largest.max() > 1000.0)
    # A torque: force per metre. The rocker's own pins carry it.
    torque = {"loads": [{"link": "output", "torque": {"constant": 2.5}}], "report": ["joint_force_index"]}
    turned = asked(client, CRANK, torque)["dynamics"]
    assert max(turned["joint_force_index"]) > 1.0 / 0.15
    assert any("above 2" in warning for warning in turned["warnings"])
    toggled = OTHER_TYPES["slider_crank"] | {"driven_by": "slider"}
    pushed = {"loads": [{"link": "crank", "torque": {"constant": 1.0}}], "report": ["joint_force_index"]}
    dead = asked(client, toggled, pushed, motion={"steps": 10, "speed": 1.0})["dynamics"]
    assert dead["joint_force_index"][0] is None
    assert "max_joint_force_index" not in dead or dead["max_joint_force_index"] is None
    assert any("infinite" in warning for warning in dead["warnings"])


def test_only_what_is_wanted_is_reported(client: httpx.Client) -> None:
    block = BLOCK | {"report": ["drive", "flywheel"]}
    answer = asked(client, CRANK, block)
    LinkageAnalysis.model_validate(answer)
    found = answer["dynamics"]
    assert {"drive", "virtual_work_drive", "flywheel"} <= found.keys()
    assert not {"joints", "slides", "gears", "shaking", "harmonics", "joint_force_index"} & found.keys()
    assert found["flywheel"].keys() == {"energy", "mean_torque", "pulses"}


BAD: dict[str, tuple[Statement, Statement, Statement, str]] = {
    "coefficient": (ALONE, {"flywheel": {"coefficient": 0.0}}, TURN, "/dynamics/flywheel/coefficient"),
    "inertia": (
        ALONE, {"flywheel": {"coefficient": 0.1, "existing_inertia": -1.0}}, TURN,
        "/dynamics/flywheel/existing_inertia",
    ),
    "standing": (ALONE, {"flywheel": {"coefficient": 0.1}}, TURN | {"speed": 0.0}, "/dynamics/flywheel"),
    "slide": (
        OTHER_TYPES["slider_crank"] | {"driven_by": "slider"}, {"flywheel": {"coefficient": 0.1}}, {"steps": 3},
        "/dynamics/flywheel",
    ),
    "slide reported": (
        OTHER_TYPES["slider_crank"] | {"driven_by": "slider"}, {"report": ["flywheel"]}, {"steps": 3},
        "/dynamics/report",
    ),
    "index of no load": (ALONE, {"report": ["joint_force_index"]}, TURN, "/dynamics/report"),
    "unknown": (ALONE, {"report": ["stress"]}, TURN, "/dynamics/report/0"),
    "nothing": (ALONE, {"report": []}, TURN, "/dynamics/report"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_reports_are_refused_at_the_field(client: httpx.Client, name: str) -> None:
    mechanism, block, motion, expected = BAD[name]
    assert expected in refused(client, block, mechanism, motion=motion)
