"""Messages on unknown fields name the field that was probably meant, or the fields that exist."""

import pytest

from service.answers.analysis import analyse
from service.refusals import Refusal
from synthesis.analyses import list_families
from synthesis.registry import KINDS, get_first_example

MOTION = get_first_example("motion")


def read_errors(answer):
    assert answer.status_code == 422
    return {error["path"]: error["detail"] for error in answer.json()["errors"]}


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_suggests_its_fields(client, kind):
    answer = client.post("/v1/jobs", json={"problem": {**get_first_example(kind), "max_desings": 3}})
    assert read_errors(answer) == {"/problem/max_desings": "Unknown field; did you mean `max_designs`?"}
    assert answer.json()["detail"] == "1 field of the request is invalid."


def test_fields_are_suggested_at_every_depth(client):
    problem = {**MOTION, "constraints": {"min_transmision": 30.0}, "positionz": []}
    problem["positions"] = [{**position, "agle": 1.0} for position in MOTION["positions"][:1]]
    answer = client.post("/v1/jobs", json={"problem": problem, "lable": "lid"})
    assert read_errors(answer) == {
        "/problem/constraints/min_transmision": "Unknown field; did you mean `min_transmission_angle`?",
        "/problem/positions/0/agle": "Unknown field; did you mean `angle`?",
        "/problem/positionz": "Unknown field; did you mean `positions`?",
        "/lable": "Unknown field; did you mean `label`?",
    }
    assert answer.json()["detail"] == "4 fields of the request are invalid."


def test_few_fields_are_listed_if_none_is_similar(client):
    problem = {**MOTION, "positions": [{**position, "q": 1} for position in MOTION["positions"]]}
    details = set(read_errors(client.post("/v1/jobs", json={"problem": problem})).values())
    assert details == {"Unknown field; the fields are `x`, `y`, `angle`, `tolerance` and `exact`."}


def test_many_fields_are_not_listed(client):
    errors = read_errors(client.post("/v1/jobs", json={"problem": {**MOTION, "qqq": 1}}))
    assert errors == {"/problem/qqq": "Unknown field; check its name."}


def test_names_of_any_length_are_answered(client):
    long = "max_designs" * 9000
    errors = read_errors(client.post("/v1/jobs", json={"problem": {**MOTION, long: 1}}))
    assert errors == {f"/problem/{long[:100]}": "Unknown field; check its name."}


@pytest.mark.parametrize("family", list_families(), ids=lambda family: family.request.__name__)
def test_analyses_suggest_the_fields_of_their_family(family):
    with pytest.raises(Refusal) as refused:
        analyse({**family.request.get_example(), "mechanizm": {}})
    assert refused.value.status == 422
    assert refused.value.errors == [("/mechanizm", "Unknown field; did you mean `mechanism`?")]


def test_queries_suggest_their_parameters(client):
    answer = client.get("/v1/jobs/01K6WM2B7Q3W9Z0V5N8XJ4R1TD/designs/0/parts?thicknes=3")
    assert read_errors(answer) == {"/query/thicknes": "Unknown field; did you mean `thickness`?"}


def test_a_batch_suggests_fields(client):
    vary = [{"field": "/seed", "values": [1, 2]}]
    answer = client.post("/v1/batches", json={"problem": {**MOTION, "max_desings": 3}, "vary": vary})
    assert read_errors(answer) == {"/problem/max_desings": "Unknown field; did you mean `max_designs`?"}
    answer = client.post("/v1/batches", json={"problem": MOTION, "vary": [{"field": "/seed", "value": [1, 2]}]})
    assert read_errors(answer)["/vary/0/value"] == "Unknown field; did you mean `values`?"
