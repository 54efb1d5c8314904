"""Paths by sixbars through HTTP: solved, proved by another formulation, drawn, with every demand; refusals by field."""

from __future__ import annotations

import itertools
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from kinematics.linkage.fourbar import Fourbar, positions
from synthesis.kinds.path import type_selection
from synthesis.kinds.path.design import PathResult
from synthesis.model.answer import Search
from synthesis.model.linkage.sixbars import SIXBAR_NAMES
from synthesis.results.buildability import MIN_RELATIVE_WIDTH
from synthesis.results.practicality import EXTREME_LINK_RATIO, JAMMING_ANGLE
from tests.campaign import further
from tests.oracles.loops import Loops
from tests.support.service.answers import drawn, finished
from tests.support.service.scripted_server import INSTANT
from tests.support.service.sixbar_paths import EIGHT, TASK, TURN, listed

SIXBARS = "watt_1", "stephenson_1", "stephenson_2", "stephenson_3"
SIZE = float(np.abs(EIGHT[:, None] - EIGHT).max())


def answered(client, **more) -> dict[str, Any]:
    body = finished(client, TASK | more)
    assert body["status"] == "succeeded", body
    return body


def passed(body) -> list[dict[str, Any]]:
    return [design for design in body["result"]["designs"] if design["verification"]["passed"]]


def off_the_sides(places, points) -> np.ndarray:
    """Distances of places from the closed polyline through points."""
    sides, gaps = np.roll(points, -1) - points, places[:, None] - points
    share = np.clip((gaps * sides.conj()).real / np.abs(sides) ** 2, 0.0, 1.0)
    return np.abs(gaps - share * sides).min(axis=1)


def once_round(design) -> Any:
    """The design's whole turn by its loops, which know nothing of the product; on one branch."""
    met = Loops(design["mechanism"]["skeleton"]).followed(np.linspace(0.0, 2.0 * np.pi, 721))
    assert met.branch > 0.0
    assert abs(met.points[-1] - met.points[0]) < 1e-8 * SIZE
    return met


def both_ways(curve, points) -> float:
    """Root mean square of distances, curve to points by its length and points to curve."""
    steps = np.abs(np.diff(curve))
    back = off_the_sides(0.5 * (curve[1:] + curve[:-1]), points)
    forth = off_the_sides(points, curve[:-1])
    return math.sqrt(0.5 * (np.mean(forth**2) + (back**2 * steps).sum() / steps.sum()))


def transmission(design, met) -> dict[str, float]:
    """The least transmission angles by links, degrees, of a triad by the forces at all pins."""
    mechanism = design["mechanism"]
    dyads = {"coupler": "B", "link_5": "D" if mechanism["type"] == "stephenson_3" else "E"}
    return Loops(mechanism["skeleton"]).transmission(met, dyads)


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.parametrize("kind", further(SIXBARS, ["stephenson_3"]))
def test_every_type_is_solved_proved_drawn_and_driven(client, kind):
    unclassed = kind == "stephenson_2"
    body = answered(client, mechanisms=[kind], **({"constraints": {}} if unclassed else {}))
    designs = passed(body)
    assert len(designs) == 2
    for design in designs[:1]:
        met, metrics = once_round(design), design["metrics"]
        assert design["mechanism"]["type"] == kind
        assert metrics["grashof"] == (None if unclassed else "crank_rocker")
        assert both_ways(met.points, EIGHT) == pytest.approx(metrics["both_way_rms"], rel=0.05)
        assert metrics["both_way_rms"] < 0.01 * SIZE
        on = next(link for link in design["mechanism"]["skeleton"]["links"] if "P" in link["joints"])
        assert on["name"] == design["point_link"]
        assert not {"O2", "O4", "O6"} & set(on["joints"])
        assert metrics["transmission_angles"] == pytest.approx(transmission(design, met), abs=0.05)
        assert metrics["min_transmission_angle"] >= 20.0
        assert metrics["link_ratio"] <= 10.0 + 1e-6
    assert designs[0]["point_link"] in body["result"]["summary"]
    place = f"/v1/jobs/{body['id']}/designs/0"
    drawn(client, place, designs[0])
    assert SIXBAR_NAMES[kind] in client.get(f"{place}.svg").text
    assert f"a {SIXBAR_NAMES[kind]} with P on" in body["result"]["summary"]
    assert client.post("/v1/analyses", json={"mechanism": designs[0]["mechanism"]}).status_code == 200
    assert client.get(f"/v1/jobs/{body['id']}/report.html").status_code == 200


@pytest.mark.campaign
@pytest.mark.timeout(300)
@pytest.mark.parametrize("kind", ["stephenson_3", "stephenson_2"])
def test_all_demands_are_kept_together(client, kind):
    box, region = [[-90.0, -80.0], [110.0, 120.0]], {"x": [-80.0, 60.0], "y": [-70.0, 100.0]}
    limits = {
        "grashof": "crank_rocker",
        "min_transmission_angle": 28.0,
        "max_link_ratio": 7.0,
        "link_length": {"min": 12.0, "max": 150.0},
        "fixed_pivot_region": region,
        "input_pivot_region": {"x": [-80.0, 20.0], "y": [-70.0, 100.0]},
    }
    room = {"box": box, "link_width": 6.0}
    if kind == "stephenson_2":
        limits.pop("grashof")
    designs = passed(answered(client, mechanisms=[kind], constraints=limits, space=room, max_designs=1))
    assert designs
    for design in designs:
        met = once_round(design)
        joints = design["mechanism"]["skeleton"]["joints"]
        for name, (x, y) in joints.items():
            if name.startswith("O"):
                assert -80.0 <= x <= 60.0
                assert -70.0 <= y <= 100.0
        assert joints["O2"][0] <= 20.0
        lengths = design["mechanism"]["links"].values()
        assert 12.0 <= min(lengths) <= max(lengths) <= 150.0
        assert max(lengths) <= 7.0 * min(lengths)
        if kind == "stephenson_2":
            assert min(transmission(design, met).values()) >= 27.9
        else:
            assert min(met.angles[key] for key in met.angles if key[0] in ("B", "D") and "ground" not in key) >= 27.9
        assert met.points.real.min() >= -87.0
        assert met.points.real.max() <= 107.0
        names = {check["name"] for check in design["verification"]["checks"]}
        assert {"box", "transmission_angle", "link_ratio", "shortest_link", "fixed_pivot_region"} <= names


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "limits"), [("stephenson_3", TASK["constraints"]), ("stephenson_2", {})])
def test_points_are_met_exactly_in_order(client, kind, limits):
    stated = {"points": listed(FEW), "method": "auto", "closed": False, "constraints": limits}
    designs = passed(answered(client, mechanisms=[kind], **stated))
    assert designs
    for design in designs:
        inputs = np.radians([target["input_angle"] for target in design["targets"]])
        assert np.all(np.diff(inputs) > 0.0) or np.all(np.diff(inputs) < 0.0)
        met = Loops(design["mechanism"]["skeleton"]).followed(inputs - inputs[0])
        assert np.abs(met.points - FEW).max() < 1e-6 * SIZE
        assert met.branch > 0.0


@pytest.mark.campaign
def test_a_stroke_is_drawn_within_tolerances_from_a_given_pivot(client):
    along = np.linspace(0.0, 1.0, 13)
    stroke = [point | {"tolerance": 0.5} for point in listed(100.0 * along + 15.0j * np.sin(2.0 * np.pi * along))]
    designs = passed(answered(client, points=stroke, closed=False, fixed_pivots={"input": [50.0, -60.0]}))
    assert designs
    assert all(design["mechanism"]["skeleton"]["joints"]["O2"] == pytest.approx([50.0, -60.0]) for design in designs)
    assert all(target["point_residual"] <= 0.5 for design in designs for target in design["targets"])


FEW = [40 + 30j, 32 + 42j, 20 + 45j, 8 + 40j, 2 + 30j, 6 + 20j]
POINTS = {"points": listed(FEW), "method": "auto", "closed": False, "constraints": {}}


def ends_of(design) -> np.ndarray:
    return np.array(list(design["mechanism"]["skeleton"]["joints"].values()))


@pytest.mark.campaign
def test_moving_pivots_full_turns_the_order_and_those_that_failed_are_as_stated(client):
    region = {"x": [-10.0, 50.0], "y": [-10.0, 60.0]}
    limits = {"moving_pivot_region": region, "full_rotation": True}
    stated = POINTS | {"constraints": limits, "include_failed": True, "rank_by": "size", "max_designs": 30}
    designs = answered(client, **stated)["result"]["designs"]
    kept = [design for design in designs if design["verification"]["passed"]]
    assert len(kept) >= 5
    assert designs[: len(kept)] == kept
    assert len(designs) > len(kept)
    for design in designs:
        joints = design["mechanism"]["skeleton"]["joints"]
        inside = all(
            -10.0 <= x <= 50.0 and -10.0 <= y <= 60.0
            for name, (x, y) in joints.items()
            if name[0] != "O" and name != "P"
        )
        checks = {check["name"]: check["passed"] for check in design["verification"]["checks"]}
        assert checks["moving_pivot_region"] == inside
        assert inside or not design["verification"]["passed"]
        assert checks["full_rotation"]
    assert once_round(kept[0]).branch > 0.0
    # Linkages that cannot be built, or that jam, are last in any order.
    workable = [
        design["metrics"]["relative_link_width"] >= MIN_RELATIVE_WIDTH
        and design["metrics"]["min_transmission_angle"] >= JAMMING_ANGLE
        and design["metrics"]["link_ratio"] <= EXTREME_LINK_RATIO
        for design in kept
    ]
    assert workable == sorted(workable, reverse=True)
    sizes = [design["metrics"]["size"] for design in kept]
    for own in (sizes[: sum(workable)], sizes[sum(workable) :]):
        assert own == sorted(own)
    quality = [design["metrics"]["quality"] for design in kept]
    assert quality != sorted(quality, reverse=True)


class Seen(Loops):
    """Loops that keep where all joints were."""

    def __init__(self, skeleton) -> None:
        super().__init__(skeleton)
        self.seen: list[dict[str, complex]] = []

    def _note(self, places, angles) -> None:
        self.seen.append(places)
        super()._note(places, angles)


BOX = {"box": [[-2.0, -2.0], [60.0, 60.0]], "link_width": 2.0}
OBSTACLE = {"clearance": 1.0, "obstacles": [{"polygon": [[8.0, 8.0], [12.0, 8.0], [12.0, 12.0], [8.0, 12.0]]}]}


def kept_room(design) -> list[bool]:
    """Whether a design keeps within the box in x, and in y, and off the obstacle, from the first point to the last."""
    inputs = np.radians([target["input_angle"] for target in design["targets"]])
    loops = Seen(design["mechanism"]["skeleton"])
    assert loops.followed(inputs - inputs[0]).branch > 0.0
    places = {name: np.array([seen[name] for seen in loops.seen]) for name in loops.joints}
    ways = np.concatenate(list(places.values()))
    within = [way.min() >= -1.0 - 1e-6 and way.max() <= 59.0 + 1e-6 for way in (ways.real, ways.imag)]
    share = np.linspace(0.0, 1.0, 60)[:, None]
    off = np.inf
    for link, on in loops.links.items():
        for one, other in itertools.combinations(on if link != "ground" else [], 2):
            along = places[one] + share * (places[other] - places[one]) - (10.0 + 10.0j)
            off = min(
                off, np.hypot(np.maximum(abs(along.real) - 2.0, 0.0), np.maximum(abs(along.imag) - 2.0, 0.0)).min()
            )
    return [*within, off >= 2.0 - 1e-3]


@pytest.mark.campaign
@pytest.mark.timeout(300)
def test_boxes_obstacles_masses_planes_and_seeds_are_as_stated(client):
    plain = passed(answered(client, **POINTS, max_designs=16))
    masses = {"links": {"density": 7.85e-6, "thickness": 4.0, "width": 6.0}, "speed_rpm": 60.0}
    roomy = passed(answered(client, **POINTS, space=BOX | OBSTACLE, dynamics=masses, max_designs=2))
    assert len(roomy) == 2
    assert all(all(kept_room(design)) for design in roomy)
    assert all(design["forces"]["drive_torque"]["max"] > 0.0 for design in roomy)
    assert not all(kept_room(plain[0]))
    assert not any("forces" in design for design in plain)

    planes = {"link_width": 2.0, "pin_diameter": 1.0, "thickness": 1.0}
    designs = passed(answered(client, **POINTS, seed=7, layout=planes, rank_by="planes", max_designs=32))
    # Those that cannot be built with these widths have no number of planes, and follow.
    arranged = [design for design in designs if design["layout"]["buildable"]]
    assert designs[: len(arranged)] == arranged
    taken = [max(design["layout"]["planes"].values()) for design in arranged]
    assert taken == sorted(taken)
    assert taken[0] < taken[-1]
    quality = [design["metrics"]["quality"] for design in designs]
    assert quality != sorted(quality, reverse=True)
    apart = [np.abs(ends_of(one) - ends_of(other)).max() for one in plain for other in designs]
    assert min(apart) > 1e-6 * SIZE


NINE = [40 + 30j, 32 + 42j, 20 + 45j, 8 + 40j, 2 + 30j, 6 + 20j, 12 + 14j, 24 + 12j, 30 + 20j]


@pytest.mark.campaign
def test_sixbars_that_meet_the_points_stand_before_a_slider_crank_that_is_fitted_to_them(client):
    mixed = {"mechanisms": ["slider_crank", "stephenson_3"], "constraints": {"min_transmission_angle": 20.0}}
    nine = {"points": listed(NINE), "method": "auto", "closed": False, "max_designs": 3}
    result = answered(client, **nine, **mixed)["result"]
    designs = result["designs"]
    # Only a sixbar that cannot be built stands behind a slider-crank that can.
    fitted = next(n for n, design in enumerate(designs) if design["mechanism"]["type"] == "slider_crank")
    assert all(
        (design["metrics"]["relative_link_width"] or 0.0) < MIN_RELATIVE_WIDTH for design in designs[fitted + 1 :]
    )
    assert fitted >= 1
    designs.append(designs.pop(fitted))
    assert [design["mechanism"]["type"] for design in designs] == ["stephenson_3", "stephenson_3", "slider_crank"]
    errors = [design["metrics"]["max_distance"] for design in designs]
    assert max(errors[:2]) < 1e-9 * SIZE < errors[2]
    assert "curve_distance" not in designs[0]["metrics"]
    assert "curve_distance" in designs[2]["metrics"]
    assert "No linkage" not in result["summary"]
    assert f"with P on {designs[0]['point_link']}, which meets the points" in result["summary"]


@pytest.mark.campaign
@pytest.mark.timeout(300)
def test_a_type_without_a_class_is_left_out_beside_one(client):
    result = answered(client, mechanisms=["stephenson_2", "stephenson_3"], max_designs=1)["result"]
    assert "Stephenson II sixbars were not searched: they do not support constraints.grashof." in result["summary"]
    assert {design["mechanism"]["type"] for design in result["designs"]} == {"stephenson_3"}
    alone = answered(client, max_designs=1)["result"]
    assert result["designs"] == alone["designs"]


def test_auto_takes_the_fourbar_where_one_is_near_and_sound(client):
    known = Fourbar(0j, 60.0 + 0j, 20.0, 55.0, 45.0, 30.0 + 20.0j)
    points = positions(known, np.array([0.3, 0.8, 1.3, 1.8, 2.3])).p
    pivots = {"input": [0.0, 0.0], "output": [60.0, 0.0]}
    plain = {k: v for k, v in TASK.items() if k not in ("mechanisms", "constraints")}
    plain |= {"method": "auto", "closed": False, "points": listed(points), "fixed_pivots": pivots}
    without = finished(client, plain)["result"]
    assert max(design["metrics"]["min_transmission_angle"] for design in without["designs"]) >= 20.0
    assert finished(client, plain | {"mechanisms": "auto"})["result"] == without
    assert {design["mechanism"]["type"] for design in without["designs"]} == {"fourbar"}


@pytest.mark.campaign
def test_auto_offers_sixbars_where_no_fourbar_is_near(client):
    result = answered(client, mechanisms="auto", constraints={}, max_designs=4)["result"]
    types = {design["mechanism"]["type"] for design in result["designs"]}
    assert types & set(SIXBARS)
    assert "are listed with it" in result["summary"]


@pytest.mark.campaign
@pytest.mark.parametrize(("kind", "more"), [("slider_crank", {}), ("geared_fivebar", {"gear_ratio": 1.0})])
def test_types_with_one_closure_are_looked_for_too(client, kind, more):
    stated = {"points": listed(40.0 * np.exp(1j * TURN)), "constraints": {}, **more}
    result = answered(client, mechanisms=[kind], **stated)["result"]
    assert {design["mechanism"]["type"] for design in result["designs"]} == {kind}


def _as_of(error: float, least: float) -> SimpleNamespace:
    """As much of a design as decides what is offered."""
    metrics = SimpleNamespace(
        min_transmission_angle=least, rms_distance=error, excursion=0.0, link_ratio=2.0,
        curve_distance=error if error else None,
    )  # fmt: skip
    return SimpleNamespace(metrics=metrics, verification=SimpleNamespace(passed=True), mechanism=None)


@pytest.mark.parametrize(
    ("fourbars", "sixbars", "most", "offered", "told"),
    [
        (
            [(4.0, 30.0)],
            [(1.0, 30.0), (3.0, 30.0)],
            5,
            [1.0, 4.0],
            "have at most half of it and are listed with it.",
        ),
        ([(4.0, 30.0)], [(3.0, 30.0)], 5, [4.0], "no sixbar that was found has half of it."),
        (
            [(4.0, 10.0)],
            [(3.0, 25.0)],
            5,
            [3.0, 4.0],
            "No fourbar that was found is sound; sound sixbars were found and are listed",
        ),
        ([(4.0, 10.0)], [(3.0, 15.0)], 5, [4.0], "no sixbar that was found has half of it."),
        ([], [(3.0, 15.0)], 5, [3.0], "No fourbar was found that satisfies all constraints; sixbars do."),
        ([], [], 5, [], "No fourbar or sixbar was found that satisfies all constraints."),
        ([(4.0, 30.0)], [(1.0, 30.0)], 1, [1.0], "listed in its place."),
        ([(4.0, 30.0)], [(0.0, 30.0)], 1, [0.0], "The error of the best fourbar is 4 mm; sixbars have at most half"),
        ([(0.0, 10.0)], [(0.0, 15.0)], 5, [0.0], "No fourbar that was found is sound, and no sixbar is."),
    ],
)
def test_what_is_offered_beside_a_fourbar_is_what_is_told(monkeypatch, fourbars, sixbars, most, offered, told):
    monkeypatch.setattr(type_selection, "build_ordering", lambda _: lambda designs: sorted(designs, key=_error))
    limits = SimpleNamespace(min_transmission_angle=None)
    problem = SimpleNamespace(
        max_designs=most, task_size=100.0, length_unit="mm", constraints=limits, is_listed_later=False
    )
    results = [
        PathResult.model_construct(
            designs=[_as_of(*both) for both in designs],
            search=Search(method="a", complete=False, candidates=9, accepted=len(designs),
                          rejected={"residual": 9 - len(designs)}, seed=0),
            summary="",
        )
        for designs in (fourbars, sixbars)
    ]  # fmt: skip
    answer = type_selection.combine_results(problem, *results, ["fourbar"], "sixbar")
    assert [_error(design) for design in answer.designs] == offered
    assert told in answer.summary
    assert answer.search.accepted == len(offered)
    assert answer.search.candidates == 18 == answer.search.accepted + sum(answer.search.rejected.values())


def _error(design) -> float:
    return design.metrics.rms_distance


ROUNDED = {"round": {"length": 0.5, "coordinates": 0.5}}
TIMED = [{"x": x, "y": x * x, "crank_angle": 30.0 * x} for x in (0.0, 1.0, 2.0)]


@pytest.mark.parametrize(
    ("mechanisms", "paths"),
    [
        ([], {"/problem/mechanisms"}),
        (["watt_2"], {"/problem/mechanisms/0"}),
        ("best", {"/problem/mechanisms"}),
    ],
)
def test_what_names_no_type_is_refused(scripted, mechanisms, paths):
    answer = scripted.client.post("/v1/jobs", json={"problem": TASK | {"mechanisms": mechanisms}})
    assert answer.status_code == 422, answer.text
    assert {fault["path"] for fault in answer.json()["errors"]} == paths


@pytest.mark.parametrize(
    ("stated", "path", "of_one"),
    [
        ({"mechanism": "slider_crank", "constraints": {}}, "/mechanism", {}),
        ({"gear_ratio": 2.0, "constraints": {}}, "/gear_ratio", {"mechanism": "geared_fivebar"}),
        ({"placement_free": ["size"]}, "/placement_free", {}),
        ({"constraints": {"coupler_point": {"along": [0.0, 1.0]}}}, "/constraints/coupler_point", {}),
        ({"constraints": {"grashof": "double_rocker"}, "closed": False}, "/constraints/grashof", {}),
        ({"space": {"fixed_pivots": {"input": {"polygon": [[0, 0], [9, 0], [9, 9]]}}}}, "/space/fixed_pivots", {}),
        ({"space": {"moving_pivots": {"input": {"polygon": [[0, 0], [9, 0], [9, 9]]}}}}, "/space/moving_pivots", {}),
        ({"manufacture": ROUNDED}, "/manufacture", {}),
        ({"manufacture": {"tolerances": {"length": 0.1}}}, "/manufacture", {}),
        ({"mechanisms": ["fourbar", "slider_crank"], "fixed_pivots": {"output": [1.0, 2.0]}, "constraints": {}},
         "/fixed_pivots/output", {}),
        ({"method": "auto", "timing": "prescribed", "closed": False, "points": TIMED}, "/timing", {}),
        ({"mechanisms": ["stephenson_2"]}, "/constraints/grashof", {}),
        ({"mechanisms": ["stephenson_2"], "constraints": {}, "stance": {"points": [2, 4], "flatness": 3.0}},
         "/stance", {}),
    ],
)  # fmt: skip
def test_what_types_cannot_be_asked_is_refused_at_its_field_and_is_none_without_them(scripted, stated, path, of_one):
    problem = TASK | {"seed": INSTANT} | stated
    answer = scripted.client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422, answer.text
    assert [fault["path"] for fault in answer.json()["errors"]] == [f"/problem{path}"]
    alone = {name: value for name, value in problem.items() if name != "mechanisms"} | of_one
    answer = scripted.client.post("/v1/jobs", json={"problem": alone})
    assert answer.status_code == 202, answer.text


@pytest.mark.campaign
@pytest.mark.timeout(300)
@pytest.mark.parametrize(
    ("stated", "field"),
    [
        pytest.param({"placement_free": ["size"]}, "placement_free", marks=pytest.mark.campaign),
        pytest.param(
            {"manufacture": {"round": {"length": 0.5, "coordinates": 0.5}}}, "manufacture", marks=pytest.mark.campaign
        ),
        ({"constraints": {"grashof": "double_rocker"}, "closed": False}, "constraints.grashof"),
        ({"space": {"fixed_pivots": {"input": {"polygon": [[-99, -99], [99, -99], [0, 99]]}}}}, "space.fixed_pivots"),
    ],
)
def test_auto_takes_what_sixbars_cannot_keep_and_says_that_it_has_none(client, stated, field):
    plain = {key: value for key, value in TASK.items() if key != "mechanisms"} | {"max_designs": 1, "constraints": {}}
    without = finished(client, plain | stated)["result"]
    auto = finished(client, plain | stated | {"mechanisms": "auto"})["result"]
    assert auto["designs"] == without["designs"]
    assert auto["search"] == without["search"]
    assert f"Sixbars were not searched: they do not support {field}." in auto["summary"]
    assert "Sixbars" not in without["summary"]
