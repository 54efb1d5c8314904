"""Engines through HTTP: tables of the literature, both jobs, files, the analysis of an engine, refusals by field."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from typing import Any

import httpx
import numpy as np
import pytest

from synthesis.registry import get_first_example, list_examples
from tests.cases import Case, cases
from tests.support.service.answers import SVG, finished

Statement = dict[str, Any]


def layout_of(given: dict[str, Any]) -> Statement:
    """The cylinders of a row as a layout: on shared pins where two of both banks have one place and one phase."""
    axes, phases = given["bank_axes"], given["crank_phases"]
    half = len(axes) // 2
    if not any(axes):
        layout: Statement = {"type": "inline"}
        throws, places = phases, given.get("z")
    else:
        angle = 2.0 * abs(axes[0])
        layout = {"first_bank": "right"}
        layout |= {"type": "opposed"} if angle == 180.0 else {"type": "vee", "vee_angle": angle}
        if axes == [axes[0]] * half + [-axes[0]] * half and phases[:half] == phases[half:]:
            layout["numbering"] = "by_bank"
            throws, places = phases[:half], given.get("z", [])[:half]
        elif half > 1 and axes[0] == axes[1]:
            # Counted bank by bank; along the shaft they alternate.
            layout |= {"pins": "own", "numbering": "by_bank"}
            throws = [phases[k // 2 + half * (k % 2)] for k in range(len(phases))]
            places = None
        else:
            layout["pins"] = "own"
            throws, places = phases, given.get("z")
    stated = {"throws": [float(phase) for phase in throws]}
    return layout | stated | ({"positions": [float(place) for place in places]} if places else {})


def engine(count: int, layout: Statement, **changes: Any) -> Statement:
    base = {"kind": "engine", "cylinders": count, "stroke_cycle": 4, "stroke": 2.0, "rod_ratio": 3.5}
    return base | {"layout": layout} | changes


def solved(client: httpx.Client, problem: Statement) -> Any:
    job = finished(client, problem)
    assert job["status"] == "succeeded", job["error"]
    return job["result"]


def only(client: httpx.Client, problem: Statement) -> Any:
    (design,) = solved(client, problem)["designs"]
    assert design["verification"]["passed"]
    return design


@pytest.mark.slow
@pytest.mark.parametrize("case", cases("engine_layout", "dynamics"))
def test_harmonics_of_the_books_engines(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    design = only(
        client, engine(len(given["bank_axes"]), layout_of(given), rod_ratio=1.0 / given["r_over_l"], max_designs=1)
    )
    found = {}
    for harmonic in design["harmonics"]:
        k = harmonic["order"]
        found[f"torque{k}"] = harmonic["torque"]
        for name in ("force", "moment"):
            found |= {f"{name}{k}_{axis}": harmonic[name][axis] for axis in ("major", "minor")}
    case.check(**found)


@pytest.mark.parametrize("case", cases("firing_order", "dynamics"))
def test_firing_orders_of_the_books_engines(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    problem = engine(len(given["bank_axes"]), layout_of(given), stroke_cycle=given["stroke_cycle"])
    firing = only(client, problem)["firing"]
    case.check(unevenness=firing["unevenness"], patterns_as_even=firing["even_choices"], all_patterns=firing["choices"])
    for order in firing["orders"]:
        by_cylinder = [order["angles"][order["order"].index(k + 1)] for k in range(len(order["order"]))]
        assert any(by_cylinder == pytest.approx(best) for best in given["best_angles_in_cylinder_order"])


@pytest.mark.parametrize("case", cases("firing_check", "dynamics"))
def test_stated_orders_are_checked(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    problem = engine(
        len(given["bank_axes"]),
        layout_of(given),
        firing_order=given["firing_order"],
        firing_angles=[float(angle) for angle in given["power_stroke_angles_in_firing_order"]],
    )
    design = only(client, problem)
    checks = {check["name"]: check["passed"] for check in design["verification"]["checks"]}
    case.check(compatible=float(checks["firing_order"]), unevenness=design["firing"]["stated_unevenness"])
    wrong = problem | {"firing_angles": [angle + 10.0 * (angle > 0.0) for angle in problem["firing_angles"]]}
    refused = solved(client, wrong)
    assert (refused["designs"], refused["search"]["rejected"]) == ([], {"firing_order": 1})
    without = only(client, {name: value for name, value in problem.items() if name != "firing_angles"})
    assert "stated_unevenness" not in without["firing"]


def one_cylinder(given: dict[str, Any], **changes: Any) -> Statement:
    """A cylinder of the book in its consistent units, with gas of constant pressure on an area of 1."""
    gas = given.get("gas_force", 0.0)
    return {
        "kind": "engine",
        "units": "consistent",
        "cylinders": 1,
        "stroke_cycle": 2,
        "bore": math.sqrt(4.0 / math.pi),
        "stroke": 2.0 * given["r"],
        "rod": float(given["l"]),
        "masses": {
            "piston": given["m4"],
            "rod": {"mass": given["m3"], "cg": given["cg3_from_crankpin_over_l"] * given["l"]},
            "crank": {"mass": given["m2"], "cg": given["rG2_over_r"] * given["r"]},
        },
        "layout": {"type": "inline", "throws": [0.0]},
        "pressure": {"table": [[0.0, float(gas)], [180.0, float(gas)]]},
        "speed_rpm": float(given["rpm"]),
    } | changes


@pytest.mark.parametrize("case", cases("engine_pin_forces", "dynamics"))
def test_pin_forces_of_the_book(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    found = {}
    for method, name in (("exact", "exact"), ("two_term", "series")):
        course = only(client, one_cylinder(given, method=method))["course"]
        k = course["angle"].index(float(given["angle"]))
        pins = {"F34": "wrist", "F32": "crank_pin", "F21": "main"}
        found |= {f"{pin}{axis}_{name}": course[f"{field}_{axis}"][k] for pin, field in pins.items() for axis in "xy"}
        found |= {f"F41x_{name}": 0.0, f"F41y_{name}": course["side"][k]}
    case.check(**found)


@pytest.mark.parametrize("case", [row for row in cases("engine_balance", "dynamics") if "r" in row.values[0].inputs])
def test_shaking_of_one_cylinder(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    design = only(client, one_cylinder(given, method="two_term"))
    k = design["course"]["angle"].index(float(given["angle"]))
    peaks = design["overbalance"]
    expected = {name: value.value for name, value in case.expected.items()}
    case.check(
        **expected
        | {
            "Fx_unbalanced": design["course"]["shaking_x"][k],
            "Fy_unbalanced": design["course"]["shaking_y"][k],
            "peak_unbalanced": peaks["unbalanced_peak"],
            "peak_exact_balance": peaks["exact_balance_peak"],
        }
    )
    assert peaks["peak"] <= expected["peak_overbalance_2_3"]


@pytest.mark.parametrize("case", cases("gas_torque", "dynamics"))
def test_gas_torque_of_the_book(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    torque = {}
    for method in ("exact", "two_term"):
        problem = engine(
            1,
            {"type": "inline", "throws": [0.0]},
            units="consistent",
            stroke_cycle=2,
            stroke=2.0 * given["r"],
            rod_ratio=given["l"] / given["r"],
            bore=float(given["bore"]),
            pressure={"table": [[0.0, float(given["pressure"])], [1.0, float(given["pressure"])]]},
            speed_rpm=1.0,
            method=method,
        )
        course = only(client, problem)["course"]
        torque[method] = course["gas_torque"][course["angle"].index(float(given["angle"]))]
        force = -course["wrist_x"][0]
    error = 100.0 * (torque["two_term"] / torque["exact"] - 1.0)
    case.check(
        force=abs(force),
        torque_series=torque["two_term"],
        torque_exact=torque["exact"],
        error_percent=error,
    )


@pytest.mark.parametrize("case", cases("conrod_models", "dynamics"))
def test_masses_that_stand_for_a_rod(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    base = {"r": 3.0, "l": given["l"], "m2": 0.0, "rG2_over_r": 0.0, "m3": given["m"], "m4": 1.0, "rpm": 1.0}
    problem = one_cylinder(base | {"cg3_from_crankpin_over_l": given["cg_from_crankpin"] / given["l"]})
    problem["masses"]["rod"]["inertia"] = given["I"]
    found = only(client, problem)["metrics"]["masses"]
    case.check(
        m_b_exact=found["percussion_wrist_pin"],
        m_p_exact=found["percussion_mass"],
        l_p=found["percussion_distance"],
        l_a=given["cg_from_crankpin"],
        l_b=given["l"] - given["cg_from_crankpin"],
        m_b_approx=found["rod_wrist_pin"],
        m_a_approx=found["rod_crank_pin"],
        I_model=found["rod_inertia"],
        I_error_percent=found["rod_inertia_error"],
    )


@pytest.mark.parametrize("case", cases("crank_static_model", "dynamics"))
def test_the_mass_that_stands_for_a_throw(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    base = {"l": 12.0, "m2": given["m"], "m3": 0.0, "cg3_from_crankpin_over_l": 0.0, "m4": 1.0, "rpm": 1.0}
    problem = one_cylinder(base | {"r": given["r"], "rG2_over_r": given["rG_over_r"]})
    problem["masses"]["crank"]["inertia"] = given["I_pivot"]
    found = only(client, problem)["metrics"]["masses"]
    case.check(
        m2a=found["throw_crank_pin"], I_model=found["throw_inertia"], I_error_percent=found["throw_inertia_error"]
    )


@pytest.mark.parametrize("case", cases("piston_harmonics", "dynamics"))
def test_coefficients_of_the_piston(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    design = only(client, engine(1, {"type": "inline", "throws": [0.0]}, rod_ratio=given["l_over_r"]))
    case.check(**{f"A{harmonic['order']}": harmonic["coefficient"] for harmonic in design["harmonics"]})


@pytest.mark.parametrize("case", cases("binomial", "dynamics"))
def test_terms_of_the_root(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    design = only(client, engine(1, {"type": "inline", "throws": [0.0]}, rod_ratio=1.0 / given["r_over_l"]))
    c2, c4, c6 = design["metrics"]["binomial_terms"]
    case.check(c2=c2, c4=c4, c6=c6)


@pytest.mark.parametrize("case", cases("engine_harmonic_sums", "dynamics"))
def test_sums_over_the_cylinders(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    layout = {"type": "inline", "throws": [float(phase) for phase in given["phases"]]}
    found = {}
    for harmonic in only(client, engine(len(given["phases"]), layout))["harmonics"]:
        k = harmonic["order"]
        found |= {f"{name}{k}": harmonic[name] for name in ("sin", "cos")}
        found |= {f"z_{name}{k}": harmonic[f"place_{name}"] for name in ("sin", "cos")}
    case.check(**found)


@pytest.mark.parametrize("case", cases("engine_moment_balance", "dynamics"))
def test_weights_on_the_crankshaft(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    layout = {"type": "vee", "vee_angle": float(given["vee"]), "throws": [float(one) for one in given["crank_phases"]]}
    design = only(client, engine(6, layout))
    (weights,) = [one for one in design["balancers"] if one["order"] == 1]
    assert weights["against"] == "moment"
    case.check(
        moment_over_mBrw2z=weights["forward"],
        circular=float(weights["form"] == "crankshaft_weights"),
        counterweight_angle_mod_180=weights["forward_angle"] % 180.0,
    )


@pytest.mark.slow
def test_arrangements_are_found_and_the_best_is_drawn(client: httpx.Client) -> None:
    job = finished(client, list_examples("engine")[1])
    result = job["result"]
    assert result["search"]["complete"]
    assert result["count"] == len(result["designs"]) == 6
    assert result["designs"][0]["mechanism"]["throws"] == [0.0, 90.0, 270.0, 180.0]
    place = f"/v1/jobs/{job['id']}/designs/0"
    for form in ("svg", "dxf", "csv"):
        assert client.get(f"{place}.{form}").status_code == 200
    assert client.get(f"/v1/jobs/{job['id']}/report.html").status_code == 200
    motion = client.get(f"{place}/motion?steps=36").raise_for_status().json()
    assert [len(one["place"]) for one in motion["cylinders"]] == [37] * 8


def second_harmonics(client: httpx.Client, pair: Any, weight: float, height: float) -> tuple[float, float]:
    """Of an inline four with balance shafts as geared bodies: the force on the frame, and its roll without the drive.

    Pistons move along x, two of them as one; ``weight`` 0 leaves the shafts without mass.
    """
    crank, rod, at, arm = 36.0, 130.0, math.radians(30.0), 10.0
    joints, links, slides = {"O": [0.0, 0.0]}, [], []
    for n, throw in enumerate((at, at + math.pi), 1):
        x, y = crank * math.cos(throw), crank * math.sin(throw)
        joints |= {f"A{n}": [x, y], f"B{n}": [x + math.sqrt(rod**2 - y**2), 0.0]}
        links.append({"name": f"rod{n}", "joints": [f"A{n}", f"B{n}"]})
        slides.append({"joint": f"B{n}", "link": "ground", "point": [0.0, 0.0], "angle": 0.0})
    shafts = [
        ("ahead", 2.0, pair["forward"], math.radians(pair["forward_angle"]) + 2.0 * at, [0.5 * height, 60.0]),
        ("against", -2.0, pair["backward"], math.radians(pair["backward_angle"]) - 2.0 * at, [-0.5 * height, -60.0]),
    ]
    bodies, gears = {}, []
    for name, ratio, share, turned, (x, y) in shafts:
        end = [x + arm * math.cos(turned), y + arm * math.sin(turned)]
        joints |= {f"S{name}": [x, y], f"T{name}": end}
        links.append({"name": name, "joints": [f"S{name}", f"T{name}"]})
        gears.append({"links": ["crank", name], "ratio": ratio})
        bodies[name] = {"mass": weight * share * crank / arm, "cg": end}
    links += [
        {"name": "ground", "joints": ["O", "Sahead", "Sagainst"]},
        {"name": "crank", "joints": ["O", "A1", "A2"]},
    ]
    skeleton = {"joints": joints, "links": links, "slides": slides, "gears": gears, "input_link": "crank"}
    body = {
        "mechanism": {"type": "skeleton", "skeleton": skeleton},
        "motion": {"from": 0.0, "to": 360.0, "steps": 360, "speed_rpm": 3000.0},
        "dynamics": {"bodies": bodies, "point_masses": [{"joint": f"B{n}", "mass": 2.0} for n in (1, 2)]},
    }
    found = client.post("/v1/analyses", json=body).raise_for_status().json()["dynamics"]
    force = np.array(found["shaking"]["force"]["x"]) + 1j * np.array(found["shaking"]["force"]["y"])
    roll = np.array(found["shaking"]["moment"]) + np.array(found["drive"])
    orders = np.fft.fft(force[:-1]) / 360.0, np.fft.fft(roll[:-1]) / 360.0
    return float(abs(orders[0][2]) + abs(orders[0][-2])), 2.0 * float(abs(orders[1][2]))


@pytest.mark.slow
def test_balance_shafts_are_driven_as_geared_bodies(client: httpx.Client) -> None:
    """The second harmonic of the force goes; that of the roll too, up to A₂/λ − 1, with Nakamura's height alone."""
    (design,) = finished(client, get_first_example("engine"))["result"]["designs"]
    pair = next(one for one in design["balancers"] if one["order"] == 2 and one["against"] == "force")
    force, roll = second_harmonics(client, pair, 0.0, 130.0)
    for height, left in ((pair["height_difference"], 0.03), (0.0, 1.001), (-130.0, 2.05)):
        held, rolled = second_harmonics(client, pair, 1.0, height)
        assert held < 1e-9 * force
        assert left - 0.06 < rolled / roll < left


def test_pistons_stand_on_their_throws(client: httpx.Client) -> None:
    """An inline four: the outer pistons are at their top and the inner ones at their bottom, a stroke lower."""
    job = finished(client, get_first_example("engine"))
    root = ET.fromstring(client.get(f"/v1/jobs/{job['id']}/designs/0.svg").raise_for_status().text)
    tops = {
        mark.get("data-side"): min(float(pair.split(",")[1]) for pair in str(mark.get("points")).split())
        for mark in root.iter(f"{SVG}polygon")
        if mark.get("data-side")
    }
    assert sorted(tops) == ["1", "2", "3", "4"]
    pins = {mark.get("data-throw"): float(mark.get("y2", "nan")) for mark in root.iter(f"{SVG}line")}
    stroke = pins["2"] - pins["1"]
    assert stroke > 20.0
    assert tops["4"] == tops["1"]
    assert tops["3"] == tops["2"] == pytest.approx(tops["1"] + stroke, abs=0.3)
    # From the front those behind one another are drawn once.
    assert sum(mark.get("data-piston") is not None for mark in root.iter(f"{SVG}polygon")) == 2


def test_the_example_with_all_its_parts(client: httpx.Client) -> None:
    job = finished(client, get_first_example("engine"))
    (design,) = job["result"]["designs"]
    names = [check["name"] for check in design["verification"]["checks"]]
    assert {"torque", "shaking_force", "pin_forces", "coefficient"} <= set(names)
    pair = next(one for one in design["balancers"] if one["order"] == 2 and one["against"] == "force")
    # Four pistons: two shafts that each carry A₂/(2·4)·4 of m_B r, Nakamura's height apart.
    assert (pair["form"], pair["height_difference"]) == ("lanchester_pair", 130.0)
    second = next(one for one in design["harmonics"] if one["order"] == 2)
    assert pair["forward"] == pytest.approx(second["coefficient"] / 2.0)
    forces = design["metrics"]["forces"]
    rows = client.get(f"/v1/jobs/{job['id']}/designs/0.csv").text.splitlines()
    assert len(rows) == 722
    assert forces["max_torque"] > forces["mean_torque"] > 0.0 > forces["min_torque"]
    assert forces["two_mass_torque_difference"] > 0.0


def test_an_engine_is_analysed(client: httpx.Client) -> None:
    body = {
        "mechanism": {"type": "engine", "crank": 3.0, "rod": 12.0, "cylinders": [{"phase": 0.0}, {"axis": 90.0}]},
        "motion": {"at": math.degrees(200.0), "speed": 200.0},
    }
    found = client.post("/v1/analyses", json=body).raise_for_status().json()
    assert found["cylinders"][0]["acceleration"] == pytest.approx([-42679.272], abs=5e-4)
    slider = {
        "type": "slider_crank",
        "fixed_pivot": [0.0, 0.0],
        "links": {"crank": 3.0, "coupler": 12.0},
        "slide": {"point": [0.0, 0.0], "angle": 90.0},
    }
    driven = client.post("/v1/analyses", json={"mechanism": slider, "motion": body["motion"]}).json()["joints"]["B"]
    assert found["cylinders"][1]["place"] == pytest.approx(driven["y"])
    assert found["cylinders"][1]["velocity"] == pytest.approx(driven["vy"])
    refused = client.post("/v1/analyses", json=body | {"mechanism": body["mechanism"] | {"rod": 3.0}})
    assert [error["path"] for error in refused.json()["errors"]] == ["/mechanism/rod"]


INLINE = {"type": "inline", "throws": [0.0, 180.0, 180.0, 0.0]}


@pytest.mark.parametrize(
    ("problem", "path"),
    [
        (engine(4, INLINE, rod_ratio=1.0), "/rod_ratio"),
        (engine(4, INLINE, rod=1.0, rod_ratio=None), "/rod"),
        (engine(4, INLINE, rod=9.0), "/rod"),
        (engine(4, INLINE, stroke=-1.0), "/stroke"),
        (engine(4, INLINE, rod_ratio=1e7), "/rod_ratio"),
        (engine(17, {"type": "inline"}), "/cylinders"),
        (engine(5, INLINE), "/layout/throws"),
        (engine(5, {"type": "vee", "vee_angle": 60.0}), "/cylinders"),
        (engine(4, {"type": "vee"}), "/layout/vee_angle"),
        (engine(4, {"type": "vee", "vee_angle": 180.0}), "/layout/vee_angle"),
        (engine(4, {"type": "inline", "vee_angle": 60.0}), "/layout/vee_angle"),
        (engine(4, {"type": "radial", "pins": "own"}), "/layout/pins"),
        (engine(4, INLINE | {"positions": [0.0]}), "/layout/positions"),
        (engine(4, INLINE, other_layouts=[{"type": "radial"}]), "/other_layouts"),
        (engine(4, {"type": "inline"}, other_layouts=[INLINE]), "/other_layouts/0/throws"),
        (engine(4, INLINE, throw_angles=[0.0]), "/throw_angles"),
        (engine(12, {"type": "inline"}, throw_angles=[0.0, 90.0, 180.0]), "/throw_angles"),
        (engine(4, INLINE, firing_order=[1, 2, 3, 3]), "/firing_order"),
        (engine(4, INLINE, firing_angles=[0.0]), "/firing_angles"),
        (engine(4, INLINE, pressure={"table": [[0.0, 1.0], [720.0, 2.0]]}, bore=1.0, speed_rpm=1.0), "/pressure/table"),
        (engine(4, INLINE, pressure={"table": [[0.0, 1.0], [20.0, 2.0]]}, speed_rpm=1.0), "/bore"),
        (engine(4, INLINE, masses={"piston": 1.0, "rod": {"mass": 1.0, "cg": 1.0}}), "/speed_rpm"),
        (engine(4, INLINE, masses={"piston": 1.0, "rod": {"mass": 1.0, "cg": 9.0}}, speed_rpm=1.0), "/masses/rod/cg"),
        (engine(4, INLINE, masses={"piston": 0.0, "rod": {"mass": 1.0, "cg": 1.0}}, speed_rpm=1.0), "/masses/piston"),
        (engine(4, INLINE, flywheel={"coefficient": 0.1, "speed_rpm": 1.0}), "/flywheel"),
    ],
)
def test_a_refusal_names_the_field(client: httpx.Client, problem: Statement, path: str) -> None:
    answer = client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422, answer.text
    assert f"/problem{path}" in [error["path"] for error in answer.json()["errors"]]
