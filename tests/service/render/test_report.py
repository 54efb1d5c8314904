"""The report: whole, self-contained, and with the numbers of the answer in it."""

import base64
import hashlib
import json
import re
from html.parser import HTMLParser

import pytest

from service.render.outline import MAX_ROWS, make_outline
from service.render.page.numbers import format_length
from service.render.report import POLICY, ReportedJob, report
from service.units import list_symbols
from synthesis.registry import KINDS, list_examples, parse_problem
from tests.support.answers import solve

VOID = {"meta", "link", "br", "img", "input", "hr"}
OCCASION = ReportedJob("01K6WM2B7Q3W9Z0V5N8XJ4R1TD", "", None, "2026-01-31T12:00:00.000000Z", None, "1.2.3")

# The examples of each kind that are solved at once.
QUICK = {"motion": 3, "path": 1, "function": 1, "cam": 0, "straight_line": 1, "quick_return": 0}
SLOW = {"dwell"}


class Page(HTMLParser):
    """A page read again: its text, its tables and its elements; fails where elements are not closed in order."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.tags, self.attributes, self.words, self.rows = [], [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs
        if tag not in VOID:
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th") and self.rows:
            self.rows[-1].append("")

    def handle_startendtag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "style" in self.open:
            return
        self.words.append(data)
        if {"td", "th"} & set(self.open):
            self.rows[-1][-1] += data

    @property
    def text(self):
        return " ".join(" ".join(self.words).split())


def solved(kind, n):
    problem = parse_problem(list_examples(kind)[n])
    return problem, solve(problem)


def check_self_contained(text):
    page = Page(text)
    assert not {"script", "iframe", "link", "img", "object", "form"} & set(page.tags)
    assert not [name for name, _ in page.attributes if name.startswith("on") or name in ("src", "href", "style")]
    assert not re.findall(r"(?:https?:)?//[\w-]+\.\w+", text.replace("http://www.w3.org/2000/svg", ""))
    # The policy lets in the page's one style sheet and nothing else.
    (style,) = re.findall("<style>(.*?)</style>", text, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    assert f"style-src 'sha256-{digest}'" in POLICY
    assert POLICY.startswith("default-src 'none'")
    assert "unsafe" not in POLICY
    assert ("content", POLICY.removesuffix("; frame-ancestors 'none'")) in page.attributes
    return page


@pytest.mark.parametrize("kind", [pytest.param(k, marks=pytest.mark.slow) if k in SLOW else k for k in KINDS])
def test_the_report_of_each_kind_has_problem_answer_drawings_checks_and_dimensions(kind):
    problem, result = solved(kind, QUICK.get(kind, 0))
    text = report(problem, result, OCCASION, 2)
    assert text == report(problem, result, OCCASION, 2), "the same page each time"
    page = check_self_contained(text)
    assert result.designs
    shown = result.designs[:2]
    assert page.tags.count("figure") == len(shown)
    assert not re.search(r"\b(None(?! of )|nan|inf|null|True|False)\b|<[\w.]+ object", page.text)
    assert " ".join(result.summary.split()) in page.text
    assert ("The search is complete" in page.text) == result.search.complete
    for design in shown:
        for check in design.verification.checks:
            name = check.name.replace("_", " ")
            assert any(
                row[0].lower() == name and row[1] in ("✓ passed", "✗ failed") for row in page.rows if len(row) > 1
            )
    # Every number of the mechanism that is a row of its own is there, with its unit beside it.
    units = list_symbols(problem)
    rows = [
        row for design in shown for row in make_outline(design.mechanism, units, leave_out={"type", "skeleton"}).rows
    ]
    # A linkage that is stated by its skeleton has no dimensions beside it.
    assert rows or all(set(type(design.mechanism).model_fields) == {"type", "skeleton"} for design in shown)
    for row in rows:
        assert [row.name, row.value, row.unit, row.meaning] in page.rows


def test_lengths_have_their_unit_and_angles_theirs():
    problem = parse_problem({**list_examples("motion")[3], "length_unit": "in"})
    result = solve(problem)
    page = Page(report(problem, result, OCCASION, 1))
    mechanism = result.designs[0].mechanism
    assert any(row[:3] == ["Links: coupler", format_length(mechanism.links.coupler), "in"] for row in page.rows)
    assert any(
        row[:3] == ["Coupler point: angle", format_length(mechanism.coupler_point.angle), "°"] for row in page.rows
    )
    assert any(row[:3] == ["Constraints: min transmission angle", "20", "°"] for row in page.rows) == (
        problem.constraints.min_transmission_angle == 20.0
    )


def test_long_lists_are_thinned_with_both_ends_and_say_so():
    problem = parse_problem(list_examples("cam")[0])
    result = solve(problem)
    (program,) = [
        one for one in make_outline(result.designs[0].mechanism, list_symbols(problem)).lists if one.title == "Program"
    ]
    table = result.designs[0].mechanism.program
    assert [head for head, _ in program.heads] == ["Angle", "S", "V", "A", "J"]
    assert [unit for _, unit in program.heads] == ["°", "mm", "mm/rad", "mm/rad²", "mm/rad³"]
    assert len(program.rows) == MAX_ROWS
    assert program.rows[0][0] == "0"
    assert program.rows[-1][0] == format_length(table.angle[-1])
    assert f"{MAX_ROWS} of {len(table.angle)}" in program.omitted


def test_where_nothing_was_found_the_report_says_whether_that_is_a_proof():
    problem, result = solved("gear_train", 0)
    none = result.model_copy(update={"designs": []})
    assert "no design satisfies" in Page(report(problem, none, OCCASION, 5)).text
    open_search = result.search.model_copy(update={"complete": False})
    unproven = none.model_copy(update={"search": open_search})
    said = Page(report(problem, unproven, OCCASION, 5)).text
    assert "does not prove that none exists" in said
    assert "no design satisfies" not in said


def test_a_design_that_fails_a_check_is_shown_to_fail():
    problem, result = solved("gear_train", 0)
    design = result.designs[0]
    checks = [design.verification.checks[0].model_copy(update={"passed": False}), *design.verification.checks[1:]]
    failed = design.model_copy(
        update={"verification": design.verification.model_copy(update={"passed": False, "checks": checks})}
    )
    text = Page(report(problem, result.model_copy(update={"designs": [failed]}), OCCASION, 5)).text
    assert "0 of 1 designs pass every check" in text
    assert "Fails a check." in text
    assert "✗ failed" in text


def test_the_report_by_http(server, client):
    label = '<script>alert("x")</script> & "hinge"'
    job = server.post(wait=20, problem=list_examples("motion")[3], label=label)
    answer = client.get(f"/v1/jobs/{job['id']}/report.html")
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    assert answer.headers["content-security-policy"] == POLICY
    assert answer.headers["x-content-type-options"] == "nosniff"
    page = check_self_contained(answer.text)
    assert label in page.text, "the label as text"
    assert job["id"] in page.text
    assert page.tags.count("figure") == len(job["result"]["designs"])
    one = client.get(f"/v1/jobs/{job['id']}/report.html", params={"designs": 1})
    assert one.text.count("<figure>") == 1
    listed = [row for row in Page(one.text).rows if len(row) == 4 and row[2] in ("passes all", "fails")]
    assert len(listed) == len(job["result"]["designs"])


def test_what_cannot_be_reported_is_refused(server, client):
    assert client.get("/v1/jobs/01K6WM2B7Q3W9Z0V5N8XJ4R1TD/report.html").status_code == 404
    job = server.post(wait=20, problem=list_examples("motion")[3])
    refused = client.get(f"/v1/jobs/{job['id']}/report.html", params={"designs": 21})
    assert refused.status_code == 422
    assert refused.json()["errors"][0]["path"] == "/query/designs"
    assert json.loads(refused.text)["type"]


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_the_kinds_tell_which_files_there_are(client, kind):
    (told,) = [one for one in client.get("/v1/problems").json()["problems"] if one["kind"] == kind]
    assert told["files"]
    assert all(forms[0] == "svg" for forms in told["files"].values())
