"""People count designs from 1, in what they read and in the names of files; addresses have the index in the answer."""

import re

import pytest

from synthesis.registry import list_examples


@pytest.fixture(scope="module")
def job(server):
    answer = server.client.post(
        "/v1/jobs",
        json={"problem": {**list_examples("motion")[3], "max_designs": 2}, "label": "lid"},
        headers={"Prefer": "wait=60"},
        timeout=120.0,
    ).json()
    assert len(answer["result"]["designs"]) == 2
    return answer["id"]


@pytest.mark.slow
def test_drawings_are_numbered_from_one(client, job):
    for number in (0, 1):
        drawing = client.get(f"/v1/jobs/{job}/designs/{number}.svg").text
        assert set(re.findall(r"lid, design (\d+)", drawing)) == {str(number + 1)}


@pytest.mark.slow
def test_the_report_is_numbered_from_one(client, job):
    report = client.get(f"/v1/jobs/{job}/report.html", params={"designs": 5}).text
    assert re.findall(r"<h2>Design (\d+)", report) == ["1", "2"]
    assert re.findall(r'<th scope="row">(\d+)</th><td>Fourbar', report) == ["1", "2"]
    assert set(re.findall(r"lid, design (\d+)", report)) == {"1", "2"}


@pytest.mark.slow
def test_files_are_named_from_one(client, job):
    parts = client.get(f"/v1/jobs/{job}/designs/1/parts", params={"process": "laser"})
    assert parts.status_code == 200, parts.text
    assert parts.headers["content-disposition"] == 'attachment; filename="motion-2-parts.zip"'
