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
    assert answer.json()["detail"] == "/problem/max_desings: Unknown field; did you mean `max_designs`?"


def test_fields_are_suggested_at_every_depth(client):
    problem = {**MOTION, "constraints": {"min_transmision": 30.0}, "positionz": []}
    problem["positions"] = [{**position, "agle": 1.0} for position in MOTION["positions"][:1]]
    answer = client.post("/v1/jobs", json={"problem": problem, "lable": "lid"})
    assert read_errors(answer) == {
        "/problem/constraints/min_transmision": "Unknown field; did you mean `min_transmission_angle`?",
        "/problem/positions/0/agle": "Unknown field; did you mean `angle`? "
        "The fields are `x`, `y`, `angle`, `tolerance` and `exact`.",
        "/problem/positionz": "Unknown field; did you mean `positions`?",
        "/lable": "Unknown field; did you mean `label`? The fields are `problem` and `label`.",
    }
    assert answer.json()["detail"].endswith(" 3 other fields are invalid.")


def test_few_fields_are_listed_if_none_is_similar(client):
    problem = {**MOTION, "positions": [{**position, "q": 1} for position in MOTION["positions"]]}
    details = set(read_errors(client.post("/v1/jobs", json={"problem": problem})).values())
    assert details == {"Unknown field; the fields are `x`, `y`, `angle`, `tolerance` and `exact`."}


def test_many_fields_are_listed_if_none_is_similar(client):
    errors = read_errors(client.post("/v1/jobs", json={"problem": {**MOTION, "qqq": 1}}))
    fields = KINDS["motion"].problem.model_fields
    assert errors["/problem/qqq"].startswith("Unknown field; the fields are `kind`, ")
    assert all(f"`{field.alias or name}`" in errors["/problem/qqq"] for name, field in fields.items())


def test_names_of_any_length_are_answered(client):
    long = "max_designs" * 9000
    errors = read_errors(client.post("/v1/jobs", json={"problem": {**MOTION, long: 1}}))
    ((path, detail),) = errors.items()
    assert path == f"/problem/{long[:100]}"
    assert detail.startswith("Unknown field; the fields are ")


@pytest.mark.parametrize("family", list_families(), ids=lambda family: family.request.__name__)
def test_analyses_suggest_the_fields_of_their_family(family):
    with pytest.raises(Refusal) as refused:
        analyse({**family.request.get_example(), "mechanizm": {}})
    assert refused.value.status == 422
    ((path, detail),) = refused.value.errors
    assert path == "/mechanizm"
    assert detail.startswith("Unknown field; did you mean `mechanism`?")


def test_queries_suggest_their_parameters(client):
    answer = client.get("/v1/jobs/01K6WM2B7Q3W9Z0V5N8XJ4R1TD/designs/0/parts?thicknes=3")
    assert read_errors(answer) == {"/query/thicknes": "Unknown field; did you mean `thickness`?"}


def test_a_batch_suggests_fields(client):
    vary = [{"field": "/seed", "values": [1, 2]}]
    answer = client.post("/v1/batches", json={"problem": {**MOTION, "max_desings": 3}, "vary": vary})
    assert read_errors(answer) == {"/problem/max_desings": "Unknown field; did you mean `max_designs`?"}
    answer = client.post("/v1/batches", json={"problem": MOTION, "vary": [{"field": "/seed", "value": [1, 2]}]})
    assert read_errors(answer)["/vary/0/value"].startswith("Unknown field; did you mean `values`? The fields are ")
