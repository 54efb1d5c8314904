"""Flywheels through HTTP: cases of the literature, files, the analysis of a wheel, refusals by field."""

from __future__ import annotations

import math
from typing import Any

import httpx
import numpy as np
import pytest

from synthesis.registry import get_first_example, list_examples
from tests.cases import Case, cases
from tests.support.service.answers import finished
from tests.support.service.dynamics_literature import stated

RAD_PER_S = math.pi / 30.0
PULSE = {"table": [[0.0, 0.0], [120.0, 300.0], [240.0, 0.0]]}


@pytest.mark.parametrize("case", cases("flywheel", "dynamics"))
def test_flywheels_of_the_books_linkages(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    body = stated(case)
    problem = {
        "kind": "flywheel",
        "length_unit": "in",
        "units": "consistent",
        "machine": {"mechanism": body["mechanism"], "dynamics": body["dynamics"]},
        "speed_rpm": float(given["speed"]) / RAD_PER_S,
        "coefficient": given["fluctuation"],
        "density": 7.3e-4,
        "limits": {"radius": {"max": 20.0}},
    }
    job = finished(client, problem)
    found, (design,) = job["result"]["fluctuation"], job["result"]["designs"]
    assert design["verification"]["passed"]
    # The table's extremes are those of its own steps of 5 degrees.
    torque = np.array(design["course"]["torque"])
    expected = {name: value.value for name, value in case.expected.items()}
    assert torque.max() == pytest.approx(expected["T_max"], abs=0.02 * np.ptp(torque))
    assert torque.min() == pytest.approx(expected["T_min"], abs=0.02 * np.ptp(torque))
    case.check(
        **expected
        | {
            "T_mean_exact": found["mean_torque"],
            "energy_exact": found["energy"],
            "inertia_exact": found["first_order_inertia"],
        }
    )


@pytest.mark.parametrize("case", cases("flywheel_disk", "dynamics"))
def test_the_mass_of_discs_by_their_slenderness(client: httpx.Client, case: Case) -> None:
    """Of given r/t a disc's mass goes with its inertia to the power 3/5; the table's are of inertia 1."""
    given: dict[str, Any] = case.inputs or {}
    found = {}
    for quotient in given["ratio_r_over_t"]:
        problem = {
            "kind": "flywheel",
            "torque": PULSE,
            "speed_rpm": 200.0,
            "coefficient": 0.02,
            "density": float(given["density"]),
            "limits": {"radius_to_thickness": {"max": float(quotient)}},
        }
        (design,) = finished(client, problem)["result"]["designs"]
        assert design["metrics"]["at_limits"] == ["radius_to_thickness"]
        metrics = design["metrics"]
        found[f"mass_{quotient}"] = metrics["mass"] * (given["I"] / metrics["inertia"]) ** 0.6
    case.check(**found)


def test_files_and_motion_of_a_design(client: httpx.Client) -> None:
    job = finished(client, get_first_example("flywheel"))
    place = f"/v1/jobs/{job['id']}/designs/0"
    for form, size in (("svg", 5_000), ("dxf", 5_000), ("csv", 5_000)):
        file = client.get(f"{place}.{form}")
        assert file.status_code == 200, file.text
        assert len(file.content) > size
    assert client.get(f"{place}.gif").status_code == 404
    assert client.get(f"/v1/jobs/{job['id']}/report.html").status_code == 200
    motion = client.get(f"{place}/motion?steps=12").raise_for_status().json()
    assert motion["angle"][-1] == 360.0
    metrics = job["result"]["designs"][0]["metrics"]
    assert (motion["mass"], motion["inertia"]) == pytest.approx((metrics["mass"], metrics["inertia"]))


def test_a_wheel_is_analysed(client: httpx.Client) -> None:
    wheel = {"type": "flywheel", "radius": 10.0, "inner_radius": 6.0, "thickness": 2.0, "density": 3.0}
    body = {"mechanism": wheel, "units": "consistent", "motion": {"at": 30.0, "speed": 4.0}}
    found = client.post("/v1/analyses", json=body).raise_for_status().json()
    assert found["mass"] == pytest.approx(3.0 * math.pi * 64.0 * 2.0)
    assert found["inertia"] == pytest.approx(0.5 * found["mass"] * 136.0)
    assert found["kinetic_energy"] == pytest.approx([8.0 * found["inertia"]])
    metres = client.post("/v1/analyses", json=body | {"units": "si", "length_unit": "cm"}).raise_for_status().json()
    assert metres["mass"] == pytest.approx(1e-6 * found["mass"])
    refused = client.post("/v1/analyses", json=body | {"mechanism": wheel | {"inner_radius": 10.0}})
    assert refused.status_code == 422
    assert [error["path"] for error in refused.json()["errors"]] == ["/mechanism/inner_radius"]


def by_machine(**changes: Any) -> dict[str, Any]:
    problem = list_examples("flywheel")[1]
    return problem | {"machine": problem["machine"] | changes}


LOST = {"point_masses": [{"joint": "Q", "mass": 1.0}]}
CRANK = list_examples("flywheel")[1]["machine"]["mechanism"]


@pytest.mark.parametrize(
    ("problem", "path"),
    [
        (get_first_example("flywheel") | {"limits": {}}, "/problem/limits"),
        (get_first_example("flywheel") | {"coefficient": 0.0}, "/problem/coefficient"),
        (get_first_example("flywheel") | {"coefficient": 1e-30}, "/problem/coefficient"),
        (get_first_example("flywheel") | {"speed_rpm": -3.0}, "/problem/speed_rpm"),
        (get_first_example("flywheel") | {"density": 1e10}, "/problem/density"),
        (get_first_example("flywheel") | {"torque": {"table": [[10.0, 1.0], [5.0, 2.0]]}}, "/problem/torque/table"),
        (get_first_example("flywheel") | {"torque": {"table": [[0.0, 1.0], [360.0, 2.0]]}}, "/problem/torque/table"),
        (
            get_first_example("flywheel") | {"limits": {"thickness": {"min": 3.0, "max": 2.0}}},
            "/problem/limits/thickness",
        ),
        (by_machine(mechanism={"type": "fourbar", "links": 3}), "/problem/machine/mechanism/fixed_pivots"),
        (by_machine(mechanism={}), "/problem/machine/mechanism/skeleton"),
        (by_machine(mechanism=CRANK | {"driven_by": "slider"}), "/problem/machine/mechanism"),
        (by_machine(mechanism=CRANK | {"offset": 77.0}), "/problem/machine/mechanism/offset"),
        (by_machine(dynamics=LOST), "/problem/machine/dynamics/point_masses/0/joint"),
        (by_machine(dynamics={"units": "consistent"}), "/problem/machine/dynamics/units"),
        (by_machine(dynamics={"bodies": {"crank": {"mass": -1.0}}}), "/problem/machine/dynamics/bodies/crank/mass"),
    ],
)
def test_a_refusal_names_the_field(client: httpx.Client, problem: dict[str, Any], path: str) -> None:
    answer = client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422, answer.text
    assert path in [error["path"] for error in answer.json()["errors"]]
