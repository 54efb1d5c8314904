"""Analyses that nobody means are refused at their field or answered soon; none takes the server down or hangs."""

from __future__ import annotations

import copy
import json
import time
from typing import Any

import httpx
import pytest

from service.answers.numerical import refuse_numerical_errors
from service.refusals import Refusal
from synthesis.analyses import list_families
from tests.support.problems.fuzz_bodies import BLOCKS, FOURBAR_AS_SKELETON, analysis_corpus, spoil
from tests.support.service.running import until

FOURBAR = {
    "type": "fourbar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
    "assembly": "open",
}
SLIDER = {
    "type": "slider_crank", "fixed_pivot": [0.0, 0.0], "links": {"crank": 2.0, "coupler": 7.0},
    "slide": {"point": [0.0, 1.0], "angle": 0.0}, "driven_by": "slider",
}  # fmt: skip
SCOTCH_YOKE = {
    "type": "skeleton",
    "skeleton": {
        "joints": {"O": [0, 0], "A": [1, 1], "B": [1, 0], "C": [2, 0]},
        "links": [
            {"name": "ground", "joints": ["O"]},
            {"name": "input", "joints": ["O", "A"]},
            {"name": "yoke", "joints": ["B", "C"]},
        ],
        "slides": [
            {"joint": "B", "link": "ground", "point": [0, 0], "angle": 0},
            {"joint": "C", "link": "ground", "point": [0, 0], "angle": 0},
            {"joint": "A", "link": "yoke", "point": [1, 0], "angle": 90},
        ],
        "input_link": "input",
    },
}
LAYOUT = {"link_width": 1, "pin_diameter": 0.4, "thickness": 0.3}
TARGETS = [{"x": 1.0, "y": 2.0}, {"x": 2.0, "y": 3.0}]
SOON_S = 60.0
"""On a machine that others use too, where kernels may have to be compiled first."""


pytestmark = pytest.mark.timeout(600)


@pytest.fixture(autouse=True, scope="module")
def _loaded(server: Any) -> None:
    """Wait until the core is loaded, which is no matter of these tests and may take a minute on a busy machine."""
    until(lambda: post(server.client, {"mechanism": FOURBAR}).status_code == 200, 300.0, "an analysis")


def post(client: httpx.Client, body: Any) -> httpx.Response:
    return client.post("/v1/analyses", json=body, timeout=SOON_S)


def paths(answer: httpx.Response) -> list[str]:
    return [error["path"] for error in answer.json()["errors"]]


@pytest.mark.parametrize("end", [1e6, 1e8, 1e9])
def test_a_layout_over_many_turns_is_that_of_one(client: httpx.Client, end: float) -> None:
    once = post(client, {"mechanism": FOURBAR, "layout": LAYOUT})
    often = post(client, {"mechanism": FOURBAR, "layout": LAYOUT, "motion": {"from": 0, "to": end, "steps": 10}})
    assert once.status_code == often.status_code == 200
    assert often.json()["layout"] == once.json()["layout"]


def test_a_range_too_long_for_a_layout_is_refused_with_the_longest_that_would_do(client: httpx.Client) -> None:
    geared = copy.deepcopy(SLIDER)
    answer = post(client, {"mechanism": geared, "layout": LAYOUT, "motion": {"from": -1e9, "to": 1e9, "steps": 10}})
    assert answer.status_code in (200, 422)  # the slider does not go so far: its remark says so
    if answer.status_code == 200:
        assert answer.json()["layout"]["remark"]


@pytest.mark.parametrize("more", [{}, {"layout": LAYOUT}, {"dynamics": {}}, {"include": ["branches"]}])
def test_a_yoke_that_slides_alone_hold_is_refused_by_its_links(client: httpx.Client, more: dict[str, Any]) -> None:
    answer = post(client, {"mechanism": SCOTCH_YOKE, **more})
    assert answer.status_code == 422
    assert "yoke" in answer.text


def test_a_point_of_a_cam_far_away_is_refused(client: httpx.Client) -> None:
    example = next(f.request for f in list_families() if "Camshaft" in f.request.__name__).model_json_schema()[
        "examples"
    ][0]
    for far in (1e9, -1e9, 1e8):
        body = copy.deepcopy(example)
        body["mechanism"]["cams"][1]["cam"]["profile"]["x"][0] = far
        answer = post(client, body)
        assert answer.status_code == 422
        assert all(path.startswith("/mechanism") for path in paths(answer))


def test_targets_of_a_fourbar_without_dimensions_are_refused(client: httpx.Client) -> None:
    held = {"targets": TARGETS, "manufacture": {"tolerances": {}}}
    answer = post(client, {"mechanism": FOURBAR_AS_SKELETON, **held})
    assert answer.status_code == 422
    assert post(client, {"mechanism": FOURBAR_AS_SKELETON, "targets": TARGETS}).status_code == 422


def test_an_answer_that_would_be_too_large_is_refused_at_the_steps(client: httpx.Client) -> None:
    points = {f"Q{n}": {"link": "coupler", "distance": 1.0, "angle": 10.0 * n} for n in range(20)}
    body = {"mechanism": FOURBAR, "points": points, "motion": {"steps": 9_999}}
    answer = post(client, body)
    assert answer.status_code == 422
    assert paths(answer) == ["/motion/steps"]
    most = int(answer.json()["errors"][0]["detail"].split("At most ")[1].split()[0])
    assert post(client, {**body, "motion": {"steps": most - 1}}).status_code == 200


NESTED = {
    "lists": ('{"mechanism": {"type": "fourbar", "links": ' + "[" * 300 + "]" * 300 + "}}", "/mechanism/links"),
    "objects": ('{"mechanism": ' + '{"a":' * 300 + "0" + "}" * 300 + "}", "/mechanism/a"),
    "many": ('{"mechanism": {"profile": [' + "0," * 30_000 + "0]}}", "/mechanism/profile"),
    "many lists": ('{"mechanism": {"profile": [' + "[]," * 30_000 + "0]}}", "/mechanism/profile"),
}


@pytest.mark.parametrize("name", NESTED)
def test_too_deep_or_too_many_names_the_field(client: httpx.Client, name: str) -> None:
    body, where = NESTED[name]
    answer = client.post("/v1/analyses", content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code in (400, 422)
    assert paths(answer)[0].startswith(where)


def test_numerical_errors_that_escape_are_refused_and_marked_as_defects() -> None:
    for error in (ZeroDivisionError(), OverflowError(), ValueError("array is too big"), IndexError()):
        with pytest.raises(Refusal) as refused, refuse_numerical_errors():
            raise error
        assert (refused.value.status, refused.value.defect) == (422, type(error).__name__)
    with pytest.raises(Refusal) as passed, refuse_numerical_errors():
        raise Refusal(409, "x", "service-title-busy", "x")
    assert passed.value.defect is None
    with pytest.raises(KeyError), refuse_numerical_errors():  # what no numbers bring about stays a defect
        raise KeyError


def test_what_waits_and_runs_is_measured(server: Any) -> None:
    for pool in ("analyses", "drawings", "files", "parts"):
        assert server.sample("mechsynth_calls", pool=pool, state="waiting") == 0.0


@pytest.mark.slow
def test_every_family_with_every_pair_of_blocks_is_answered_or_refused_at_a_field(client: httpx.Client) -> None:
    corpus = analysis_corpus([])
    for n, body in enumerate(corpus):
        for k in range(3):
            sent = {**body, **BLOCKS[(n + 7 * k) % len(BLOCKS)], **BLOCKS[(3 * n + 5 * k) % len(BLOCKS)]}
            answer = post(client, sent)
            assert answer.status_code in (200, 422), (json.dumps(sent)[:2000], answer.text[:500])
            assert answer.status_code == 200 or paths(answer)


@pytest.mark.slow
def test_spoilt_analyses_are_answered_or_refused_at_a_field(client: httpx.Client) -> None:
    corpus = analysis_corpus([])
    began = time.monotonic()
    for number in range(300):
        body = spoil(corpus, number, seed=7)
        answer = client.post("/v1/analyses", content=body, headers={"Content-Type": "application/json"}, timeout=SOON_S)
        assert answer.status_code in (200, 422), (body[:2000], answer.text[:500])
        assert answer.status_code == 200 or paths(answer), body[:2000]
        if time.monotonic() - began > 240.0:  # a very busy machine: what has been seen is enough
            break
