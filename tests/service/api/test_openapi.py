"""The OpenAPI document: it changes only on purpose, has every route, and names every refusal."""

import json
from contextlib import asynccontextmanager

import pytest

from service.server.app import build_application
from tests.support.service.api_document import read_api_document
from tests.support.sixbars.names import WRONG_NAME
from tools.contract import CONTRACT, contract_lines

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def document():
    return read_api_document()


def test_the_api_keeps_its_contract(document):
    kept, current = CONTRACT.read_text(encoding="utf-8").splitlines(), contract_lines(document)
    changed = sorted({line.split(":")[0] for line in {*kept} ^ {*current}})
    assert not changed, (
        f"The API changed: {', '.join(changed)}. If this is intended, run `make openapi`, review the difference of "
        f"{CONTRACT.name}, and commit it."
    )
    assert kept == current, "the order differs: run `make openapi`"


def test_sixbars_have_one_name_in_the_document(document):
    assert WRONG_NAME.findall(json.dumps(document)) == []


def test_every_route_for_tenants_is_in_the_document(document):
    """So that what enumerates the document, as the tests of tenants do, forgets no route."""

    @asynccontextmanager
    async def lifespan(app):
        yield

    app = build_application(lifespan)
    served = {route.path for route in app.state.routes if getattr(route, "path", "").startswith("/v1")}
    assert served == {path for path in document["paths"] if path.startswith("/v1")}


def test_every_operation_says_with_what_it_may_be_refused(document):
    """By its connection: 408, 431; for want of a key, of room or of a store: 401, 403, 429, 503; for its body: 4xx."""
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            expected = {"408", "431"}
            if path.startswith("/v1/"):
                expected |= {"401", "403", "422", "429", "503"}
            if "requestBody" in operation:
                expected |= {"400", "413", "415", "422"}
            assert expected <= operation["responses"].keys(), f"{method} {path}"
            for status in expected & {"429", "503"}:
                assert "Retry-After" in operation["responses"][status]["headers"], f"{method} {path} {status}"
            for status in expected:
                assert list(operation["responses"][status]["content"]) == ["application/problem+json"]
