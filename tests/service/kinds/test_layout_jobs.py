"""Layouts through HTTP: of designs of several kinds and of given mechanisms, with every field of the block."""

from __future__ import annotations

import math

import pytest

from synthesis.model.linkage.problem import LinkageProblem
from synthesis.registry import KINDS
from tests.service.stated.linkages import BOTH_OPEN, DWELL, LINE, MOTION, PARALLEL, QUICK_RETURN, STEERING
from tests.service.stated.tables import TABLES
from tests.support.service.answers import drawn, finished

BLOCK = {"link_width": 0.1, "pin_diameter": 0.05, "thickness": 5.0, "gap": 0.02}
DRAG_LINK = {"kind": "quick_return", "time_ratio": 1.4, "stroke": 1.0, "mechanism": "drag_link_slider"}
FIVEBAR = {
    "type": "geared_fivebar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 1.0, "coupler_1": 7.0, "coupler_2": 7.0, "output": 1.2},
    "gear_ratio": -2.0,
    "phase": 30.0,
}


def layouts(client, problem, **changes):
    job = finished(client, {**problem, "layout": {**BLOCK, **changes}})
    assert job["status"] == "succeeded", job["error"]
    return [design["layout"] for design in job["result"]["designs"]]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("problem", "width"),
    [(MOTION, 5.0), (QUICK_RETURN, 0.05), (STEERING, 60.0), (DWELL, 1.5)],
    ids=lambda x: str(x)[:20],
)
def test_every_design_is_laid_out_and_still_drawn(client, problem, width):
    block = {"link_width": width, "pin_diameter": 0.4 * width, "thickness": 5.0, "gap": 0.1 * width}
    job = finished(client, {**problem, "layout": block})
    assert job["result"]["designs"]
    for n, design in enumerate(job["result"]["designs"]):
        layout = design["layout"]
        assert layout["buildable"]
        assert layout["least"]
        assert layout["count"] == max(layout["planes"].values())
        assert layout["height"] == pytest.approx(layout["count"] * (5.0 + 0.1 * width))
        assert layout["planes"].keys() == {link["name"] for link in design["mechanism"]["skeleton"]["links"]} - {
            "ground"
        }
        assert ("free_stroke" in layout) == (design["mechanism"]["type"] == "davis") != ("free_range" in layout)
        for low, high in layout["pins"].values():
            assert 0 <= low < high <= layout["count"]
        drawn(client, f"/v1/jobs/{job['id']}/designs/{n}", design)
    report = client.get(f"/v1/jobs/{job['id']}/report.html")
    assert report.status_code == 200, report.text


def test_without_the_block_there_is_no_layout(client):
    job = finished(client, QUICK_RETURN)
    assert job["problem"]["layout"] is None
    assert all("layout" not in design for design in job["result"]["designs"])


def test_clashes_and_free_ranges_are_told(client):
    for layout in layouts(client, DRAG_LINK):
        assert not layout["buildable"]
        (clash,) = layout["clashes"]
        assert set(clash) == {"parts", "distance", "input_angle"}
        assert clash["parts"] in (["input", "pin O4"], ["driven_crank", "pin O2"])
        assert clash["parts"] in layout["crossings"]
        assert clash["distance"] < 0.02
        low, high = layout["free_range"]
        assert 0.0 < high - low < 360.0
        assert not any(low < clash["input_angle"] + turn < high for turn in (-360.0, 0.0, 360.0))


def test_shafts_on_both_sides_may_be_stubs(client):
    one, two = layouts(client, DRAG_LINK), layouts(client, DRAG_LINK, shafts="both_sides")
    assert all(layout["stub_shafts"] == [] for layout in one)
    for layout in two:
        assert layout["buildable"]
        assert layout["stub_shafts"] == ["O2", "O4"]
        assert sorted(end for name in ("O2", "O4") for end in layout["pins"][name])[-1] == layout["count"] + 1


def test_wide_links_thick_pins_and_gaps_get_in_the_way(client):
    # Pins that do not keep the gap fail a check, so that their designs are listed on request only.
    problem = {**QUICK_RETURN, "include_failed": True}
    (plain, *_), fields = layouts(client, problem), {"link_width": 0.9, "gap": 0.6}
    for field, value in fields.items():
        (changed, *_) = layouts(client, problem, **{field: value})
        assert len(changed["crossings"]) > len(plain["crossings"]), field
    (wide, *_) = layouts(client, problem, link_width=0.9)
    (thick, *_) = layouts(client, problem, link_width=0.9, pin_diameter=0.9)
    assert {tuple(clash["parts"]) for clash in thick["clashes"]} > {tuple(clash["parts"]) for clash in wide["clashes"]}
    (stout, *_) = layouts(client, problem, thickness=7.0)
    assert stout["height"] - plain["height"] == pytest.approx(2.0 * plain["count"])


def test_a_limit_of_planes_is_a_demand(client):
    """Drag links take four planes between two bases; with three there is none, and the answer says so."""
    sized = {**BLOCK, "shafts": "both_sides"}
    kept = finished(client, {**DRAG_LINK, "layout": {**sized, "max_planes": 4}})["result"]
    for design in kept["designs"]:
        (check,) = [check for check in design["verification"]["checks"] if check["name"] == "planes"]
        assert check == {"name": "planes", "passed": True, "value": float(design["layout"]["count"]), "limit": 4.0}
    missed = finished(client, {**DRAG_LINK, "layout": {**sized, "max_planes": 3}})["result"]
    assert missed["designs"] == []
    assert missed["search"]["rejected"] == {"planes": len(kept["designs"])}
    assert missed["nearest_miss"]["gaps"] == [{"check": "planes", "value": 4.0, "limit": 3.0}]
    assert missed["nearest_miss"]["design"]["layout"]["count"] == 4


RANKED = {
    "motion": ({**MOTION, **BOTH_OPEN, "max_designs": 40}, 12.0),
    "straight_line": ({**LINE, "mechanism": "auto"}, 4.0),
    "parallel_motion": ({**PARALLEL, "include_cognates": True}, 1.0),
    "quick_return": ({**QUICK_RETURN, "mechanism": "auto", "max_designs": 10}, 0.1),
}
"""Problems whose designs take different numbers of planes, or cannot all be built, and the width of their links."""


@pytest.mark.slow
@pytest.mark.parametrize(("problem", "width"), RANKED.values(), ids=RANKED)
def test_fewest_planes_first(client, problem, width):
    """The designs are those of the usual order, those in as many planes in that order; fewer are the first of them."""
    stated = {**problem, "layout": {**BLOCK, "link_width": width, "pin_diameter": 0.5 * width}}
    usual, by_planes, first = (
        finished(client, {**stated, **fields})["result"]
        for fields in ({}, {"rank_by": "planes"}, {"rank_by": "planes", "max_designs": 1})
    )

    def place(design):
        return design["layout"]["count"] if design["layout"]["buildable"] else math.inf

    assert len({*map(place, usual["designs"])}) > 1
    assert by_planes["designs"] == sorted(usual["designs"], key=place)
    assert first["designs"] == by_planes["designs"][:1]
    assert "Ranked by planes" in by_planes["summary"]
    assert set(by_planes["front"]["designs"]) <= set(range(len(by_planes["designs"])))


def test_planes_rank_beside_other_demands(client):
    """Beside a limit of planes, a limit of the angle and designs that fail: these come last."""
    block = {**BLOCK, "link_width": 4.0, "pin_diameter": 2.0, "max_planes": 3}
    demands = {"constraints": {"min_transmission_angle": 5.0}, "include_failed": True, "rank_by": "planes"}
    designs = finished(client, {**LINE, "mechanism": "auto", "layout": block, **demands})["result"]["designs"]
    passed = [design["verification"]["passed"] for design in designs]
    assert passed == sorted(passed, reverse=True)
    assert set(passed) == {True, False}
    counts = [design["layout"]["count"] for design in designs if design["verification"]["passed"]]
    assert counts == sorted(counts)
    assert counts[-1] <= 3


@pytest.mark.parametrize("kind", [name for name, kind in KINDS.items() if issubclass(kind.problem, LinkageProblem)])
def test_planes_rank_where_a_layout_is_stated(client, kind):
    answer = client.post("/v1/jobs", json={"problem": {**TABLES[kind][0], "rank_by": "planes"}})
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == ["/problem/rank_by"]


def test_the_cycle_is_looked_at_where_it_is_asked_for(client):
    used, whole = (layouts(client, MOTION, link_width=5.0, pin_diameter=2.0, over=over) for over in ("used", "cycle"))
    for one, other in zip(used, whole, strict=True):
        assert other["free_range"][1] - other["free_range"][0] > one["free_range"][1] - one["free_range"][0]


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"link_width": 0.0}, "/link_width"),
        ({"link_width": -1.0}, "/link_width"),
        ({"link_width": 1e10}, "/link_width"),
        ({"pin_diameter": 0.0}, "/pin_diameter"),
        ({"pin_diameter": 0.2}, "/pin_diameter"),
        ({"thickness": 0.0}, "/thickness"),
        ({"gap": -0.1}, "/gap"),
        ({"max_planes": 0}, "/max_planes"),
        ({"max_planes": 21}, "/max_planes"),
        ({"max_planes": 2.5}, "/max_planes"),
        ({"shafts": "none"}, "/shafts"),
        ({"over": "all"}, "/over"),
        ({"planes": 3}, "/planes"),
    ],
    ids=str,
)
def test_a_refusal_names_the_field(client, changes, path):
    answer = client.post("/v1/jobs", json={"problem": {**QUICK_RETURN, "layout": {**BLOCK, **changes}}})
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == [f"/problem/layout{path}"]


@pytest.mark.parametrize("field", ["link_width", "pin_diameter", "thickness"])
def test_what_links_are_made_of_has_to_be_stated(client, field):
    block = {name: value for name, value in BLOCK.items() if name != field}
    answer = client.post("/v1/jobs", json={"problem": {**QUICK_RETURN, "layout": block}})
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == [f"/problem/layout/{field}"]


def test_the_path_of_a_parallel_motion_has_no_layout_of_its_own(client):
    path = {"kind": "path", "points": [{"x": 0.0, "y": 0.0}, {"x": 10.0, "y": 5.0}, {"x": 20.0, "y": 0.0}]}
    answer = client.post("/v1/jobs", json={"problem": {"kind": "parallel_motion", "path": {**path, "layout": BLOCK}}})
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == ["/problem/path/layout"]


def test_links_wider_than_the_linkage_have_an_answer_that_says_why(client):
    for layout in layouts(client, QUICK_RETURN, link_width=50.0, pin_diameter=20.0):
        assert not layout["buildable"]
        assert "free_range" not in layout
        assert ["pin O2", "pin A"] in [clash["parts"] for clash in layout["clashes"]]


def test_a_given_mechanism_is_laid_out(client):
    body = {"mechanism": FIVEBAR, "layout": {"link_width": 0.4, "pin_diameter": 0.2, "thickness": 0.3}}
    answer = client.post("/v1/analyses", json=body)
    assert answer.status_code == 200, answer.text
    layout = answer.json()["layout"]
    assert layout["planes"]["gear of input"] == layout["planes"]["gear of output"]
    assert layout["planes"]["gear of input"] not in (layout["planes"]["input"], layout["planes"]["output"])
    assert "layout" not in client.post("/v1/analyses", json={"mechanism": FIVEBAR}).json()
    for changes, path in [({"pin_diameter": 0.5}, "/layout/pin_diameter"), ({"max_planes": 2}, "/layout/max_planes")]:
        answer = client.post("/v1/analyses", json={**body, "layout": {**body["layout"], **changes}})
        assert answer.status_code == 422
        assert [error["path"] for error in answer.json()["errors"]] == [path]


@pytest.mark.parametrize(
    ("field", "value"),
    [("link_width", 2.0), ("pin_diameter", 0.4), ("thickness", 0.4), ("gap", 0.1), ("shafts", "both_sides"),
     ("over", "cycle")],
)  # fmt: skip
def test_every_field_counts_for_a_given_mechanism_too(client, field, value):
    mechanism = {
        "type": "fourbar",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [2.0, 0.0]},
        "links": {"input": 6.0, "coupler": 7.0, "output": 5.0},
        "reference_input_angle": 40.0,
    }
    block = {"link_width": 0.4, "pin_diameter": 0.2, "thickness": 0.3}
    body = {"mechanism": mechanism, "motion": {"from": 0.0, "to": 350.0, "steps": 10}}
    plain, changed = (
        client.post("/v1/analyses", json={**body, "layout": stated}).raise_for_status().json()["layout"]
        for stated in (block, {**block, field: value})
    )
    assert plain != changed
