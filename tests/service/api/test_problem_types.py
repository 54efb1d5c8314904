"""Each type of problem details has a page at its address."""

import re
from pathlib import Path

import pytest

import service
from service.api.pages.problem_types import PROBLEM_TYPES
from service.server import connections

SOURCES = Path(service.__file__).parent
USED = re.compile(r'Refusal\(\s*(\d{3}), "([a-z-]+)"|(\d{3}), "/problems/([a-z-]+)"|()"/problems/([a-z-]+)"')


def used_types():
    """The names of all types in the code, with the statuses next to them."""
    found = {}
    for source in SOURCES.rglob("*.py"):
        for match in USED.finditer(source.read_text("utf-8")):
            status, name = (text for text in match.groups() if text is not None)
            found.setdefault(name, set()).update({int(status)} if status else ())
    return found


def test_every_type_that_the_code_uses_is_explained():
    used = used_types()
    assert used.keys() == PROBLEM_TYPES.keys()
    assert all(PROBLEM_TYPES[name].status in statuses for name, statuses in used.items() if statuses)


def test_faults_of_connections_have_the_titles_of_their_types():
    for fault in (connections.TOO_SLOW, connections.NOT_HTTP, connections.AMBIGUOUS_HOST, connections.HEAD_TOO_LARGE):
        kind = PROBLEM_TYPES[fault.type.removeprefix("/problems/")]
        assert (kind.status, kind.title_id) == (fault.status, f"service-title-{fault.type.removeprefix('/problems/')}")


@pytest.mark.parametrize(("language", "title"), [("en", "Not found"), ("de", "Nicht gefunden")])
def test_an_error_leads_to_its_page(client, language, title):
    refused = client.get("/v1/jobs/none", headers={"Accept-Language": language}).json()
    page = client.get(refused["type"], headers={"Accept-Language": language})
    assert (page.status_code, page.headers["content-type"]) == (200, "text/html; charset=utf-8")
    assert f'<html lang="{language}">' in page.text
    assert f"<h1>{title}</h1>" in page.text
    assert "HTTP 404" in page.text


def test_an_unknown_type_has_no_page(client):
    assert client.get("/problems/bad-weather").status_code == 404
