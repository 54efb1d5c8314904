"""The store of the studio: what changes the statement, what is told of it, and the steps between which one goes."""

import json
import shutil
import subprocess

import pytest

from service.requests import fill_defaults
from synthesis.registry import KINDS, list_examples
from tests.support.service.running import ROOT

STUDIO = ROOT / "service" / "studio"

PROGRAM = """
import { Store } from "./core/store.js";
const store = new Store();
store.kinds = [
  { kind: "path", schema: { type: "object", properties: { kind: {}, points: {}, seed: { default: 0 } } },
    example: { kind: "path" } },
  { kind: "cam", schema: { type: "object", properties: { kind: {} } }, example: { kind: "cam" } },
];
let time = 0;
performance.now = () => time;
const told = [];
store.listen(({ stated, by, edited, begun }) => told.push([stated, by, edited, begun]));
const tries = (act) => { try { act(); return "no fault"; } catch (fault) { return fault.constructor.name; } };
const seen = {};
store.begin({ kind: "path", points: [[0, 0]] });
const first = store.problem;
for (const x of [1, 2, 3]) store.change((statement) => (statement.points[0][0] = x), "canvas");
seen.before = first.points;
time = 1000;
store.change((statement) => statement.points.push([5, 5]), "form");
seen.origin = store.origin;
seen.written = tries(() => store.problem.points.push([6, 6]));
seen.failed = tries(() => store.change((statement) => { statement.points = []; throw new RangeError(); }));
seen.now = store.problem.points;
store.recordSubmission("A", store.problem);
store.recordAnswer("A");
time = 2000;
store.change((statement) => (statement.seed = 0));
seen.defaults = store.stale;
store.undo();
store.undo();
seen.back = store.problem.points;
seen.stale = store.stale;
store.redo();
seen.forth = store.problem.points;
store.undo();
store.undo();
seen.all = [store.problem.points, store.past.steps.past.length, store.past.steps.future.length];
store.replace({ kind: "cam" }, "text");
seen.kind = [store.kind.kind, store.past.steps.future.length, store.matchesSchema({ kind: "lid" })];
console.log(JSON.stringify({ ...seen, told }));
"""

pytestmark = [pytest.mark.browser, pytest.mark.timeout(60)]


def test_changes_make_statements_steps_and_news(tmp_path):
    shutil.copytree(STUDIO, tmp_path, dirs_exist_ok=True)
    (tmp_path / "package.json").write_text('{"type": "module"}')
    (tmp_path / "program.js").write_text(PROGRAM)
    done = subprocess.run(["node", "program.js"], cwd=tmp_path, capture_output=True, text=True, timeout=30)
    assert done.returncode == 0, done.stderr
    seen = json.loads(done.stdout)
    # Statements stay as they were, whoever writes into them, and what fails changes nothing.
    assert seen["before"] == [[0, 0]]
    assert (seen["written"], seen["failed"]) == ("TypeError", "RangeError")
    assert seen["now"] == [[3, 0], [5, 5]]
    assert seen["origin"] == 1
    # A burst is one step; a default that is written out makes no answer stale.
    assert seen["defaults"] is False
    assert (seen["back"], seen["forth"]) == ([[3, 0]], [[3, 0], [5, 5]])
    assert seen["stale"] is True
    assert seen["all"] == [[[0, 0]], 0, 3]
    assert seen["kind"] == ["cam", 0, False]
    begun, canvas, form = [True, None, False, True], [True, "canvas", True, False], [True, "form", True, False]
    other = [True, None, True, False]
    answered, written = [False, None, False, False], [True, "text", True, True]
    assert seen["told"] == [begun, *3 * [canvas], form, answered, *6 * [other], written]


SPELT = """
import { readFileSync } from "node:fs";
import { canonicalText } from "./core/schema.js";
const cases = JSON.parse(readFileSync("cases.json"));
console.log(JSON.stringify(cases.map(([schema, ...both]) => both.map((one) => canonicalText(one, schema)))));
"""


def test_an_example_whose_defaults_are_written_out_is_the_example_yet(tmp_path):
    cases = [
        [KINDS[kind].problem.model_json_schema(), one, json.loads(fill_defaults(kind, json.dumps(one)))]
        for kind in KINDS
        for one in list_examples(kind)
    ]
    shutil.copytree(STUDIO / "core", tmp_path / "core")
    (tmp_path / "cases.json").write_text(json.dumps(cases))
    (tmp_path / "package.json").write_text('{"type": "module"}')
    (tmp_path / "spelt.js").write_text(SPELT)
    done = subprocess.run(["node", "spelt.js"], cwd=tmp_path, capture_output=True, text=True, timeout=30)
    assert done.returncode == 0, done.stderr
    for (_, stated, _), (plain, filled) in zip(cases, json.loads(done.stdout), strict=True):
        assert filled == plain, stated["kind"]
