"""What the service promises is kept with the source: it does not change by the way."""

import json
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from service.server.app import build_api_document, build_application

KEPT = Path(__file__).parents[3] / "docs" / "openapi.json"


def parts(document):
    """The document in parts that a message can name."""
    named = {f"paths {path}": value for path, value in document["paths"].items()}
    for section, members in document["components"].items():
        named |= {f"components/{section}/{name}": value for name, value in members.items()}
    return {**named, "the rest": {key: document[key] for key in document if key not in ("paths", "components")}}


@pytest.mark.slow
def test_the_document_is_the_one_that_is_kept():
    says, kept = parts(json.loads(build_api_document())), parts(json.loads(KEPT.read_text(encoding="utf-8")))
    changed = sorted(name for name in says.keys() | kept.keys() if says.get(name) != kept.get(name))
    assert not changed, (
        f"docs/openapi.json is not what the service says. If the change is meant, run `make openapi` and commit the "
        f"file with it. Different: {', '.join(changed)}"
    )


@pytest.mark.slow
def test_the_document_is_written_the_same_way_each_time():
    assert KEPT.read_text(encoding="utf-8") == build_api_document()


def test_every_route_for_tenants_is_in_the_document():
    """So that what enumerates the document, as the tests of tenants do, forgets no route."""

    @asynccontextmanager
    async def lifespan(app):
        yield

    app = build_application(lifespan)
    served = {route.path for route in app.state.routes if getattr(route, "path", "").startswith("/v1")}
    assert served == {path for path in json.loads(KEPT.read_text(encoding="utf-8"))["paths"] if path.startswith("/v1")}


def test_every_operation_says_with_what_it_may_be_refused():
    """By its connection: 408, 431; for want of a key, of room or of a store: 401, 403, 429, 503; for its body: 4xx."""
    document = json.loads(KEPT.read_text(encoding="utf-8"))
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            expected = {"408", "431"}
            if path.startswith("/v1/"):
                expected |= {"401", "403", "429", "503"}
            if "requestBody" in operation:
                expected |= {"400", "413", "415", "422"}
            assert expected <= operation["responses"].keys(), f"{method} {path}"
            for status in expected & {"429", "503"}:
                assert "Retry-After" in operation["responses"][status]["headers"], f"{method} {path} {status}"
            for status in expected:
                assert list(operation["responses"][status]["content"]) == ["application/problem+json"]
