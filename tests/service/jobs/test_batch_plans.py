"""Which problems a batch is made of, which of them are the same, and what its table tells."""

import csv
import io
import json
import time

import numpy as np
import pytest
from ulid import ULID

from service.api.routes.batch_plans import select_default_metrics
from service.api.routes.batch_schemas import MAX_SAMPLES
from service.jobs.batches import identity
from service.jobs.batches import table as table_module
from service.jobs.batches.plan import NoSuchPlace, Plan
from service.jobs.batches.reading import make_sample_id
from service.jobs.batches.rows import BatchSummary, TableRow
from service.jobs.batches.sampling import Span, sample_evenly, sample_latin_hypercube
from service.jobs.batches.table import Table, build_table, find_unbeaten
from service.jobs.store.states import Status
from synthesis.registry import KINDS, get_first_example, parse_problem

PROBLEM = {"kind": "motion", "positions": [{"x": 0.0, "a/b~": 1}, {"x": 1.0}]}


def plan(fields, values, grid=True, metrics=(), problem=PROBLEM):
    return Plan(problem, fields, values, grid, list(metrics), True)


def csv_of(table):
    return b"".join(table.as_csv()).decode()


def test_evenly_spaced_numbers_are_whole_where_the_ends_and_all_between_are():
    assert sample_evenly(10, 30, 3) == [10, 20, 30]
    assert all(isinstance(value, int) for value in sample_evenly(30, 10, 3))
    assert list(sample_evenly(0, 1, 3)) == [0, 0.5, 1]
    assert sample_evenly(2.0, 3.0, 1) == [2.0]
    spaced = sample_evenly(0.1, 0.7, 7)
    assert (spaced[0], spaced[-1]) == (0.1, 0.7)
    assert np.allclose(spaced, np.linspace(0.1, 0.7, 7), rtol=1e-15)


def test_the_last_field_of_a_grid_varies_fastest():
    grid = plan(["/seed", "/max_designs"], [[1, 2], [3, 4, 5]])
    assert [grid.sample(n) for n in range(grid.total)] == [[a, b] for a in (1, 2) for b in (3, 4, 5)]


def test_a_field_is_set_and_nothing_else_changes():
    before = json.dumps(PROBLEM)
    varied = plan(["/positions/1/x", "/constraints/link_length/min", "/positions/0/a~1b~0"], [[7.0], [1], [None]])
    assert varied.build_statement(0) == {
        "kind": "motion",
        "positions": [{"x": 0.0, "a/b~": None}, {"x": 7.0}],
        "constraints": {"link_length": {"min": 1}},
    }
    assert json.dumps(PROBLEM) == before
    assert Plan.read(varied.dump_statement(), varied.dump_values()) == varied


@pytest.mark.parametrize("field", ["/positions/2/x", "/positions/-1/x", "/positions/01", "/positions/x", "/kind/x"])
def test_a_pointer_to_nowhere_is_told(field):
    with pytest.raises(NoSuchPlace):
        plan([field], [[1.0]]).build_statement(0)


def test_each_part_of_a_range_has_its_sample():
    ranges, listed = sample_latin_hypercube([Span(-2.0, 6.0), ["a", "b", "c", "d"]], 16, 5)
    assert sorted(int((value + 2.0) * 2.0) for value in ranges) == list(range(16))
    assert sorted(listed) == sorted("abcd" * 4)
    again = sample_latin_hypercube([Span(-2.0, 6.0), ["a", "b", "c", "d"]], 16, 5)
    assert [[*values] for values in again] == [[*ranges], [*listed]]
    assert sample_latin_hypercube([Span(-2.0, 6.0)], 16, 6)[0] != ranges


@pytest.mark.slow
def test_ids_of_samples_are_none_that_are_made_in_the_same_millisecond():
    """These follow one another: the batch, its shares, the next batch, a job."""
    first = ULID.from_str("01K6WM2B7Q3W9Z0V5N8XJ4R1TZ")
    made = [str(ULID.from_int(int(first) + n)) for n in range(20)]
    ids = [make_sample_id(batch, n) for batch in (made[0], made[1], made[17]) for n in range(10_000)]
    assert len({*ids, *made}) == len(ids) + len(made)
    assert ids[:10_000] == sorted(ids[:10_000])
    assert {ULID.from_str(found).milliseconds for found in ids} == {first.milliseconds}


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_equal_problems_have_one_digest(kind, monkeypatch):
    problem = parse_problem(get_first_example(kind))
    spelt_out = json.loads(problem.model_dump_json())
    assert identity.hash_problem(parse_problem(dict(reversed(spelt_out.items())))) == identity.hash_problem(problem)
    assert identity.hash_problem(parse_problem({**get_first_example(kind), "seed": 7})) != identity.hash_problem(
        problem
    )
    before = identity.hash_problem(problem)
    monkeypatch.setattr(identity, "hash_solvers", lambda: "another version")
    assert identity.hash_problem(problem) != before


def test_other_sources_are_another_version(tmp_path, monkeypatch):
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "kernel.py").write_text("x = 1\n")
    monkeypatch.setattr(identity, "files", lambda _package: tmp_path)
    told = identity.hash_solvers.__wrapped__()
    assert identity.hash_solvers.__wrapped__() == told
    (tmp_path / "deep" / "kernel.py").write_text("x = 2\n")
    assert identity.hash_solvers.__wrapped__() != told


def batch(status, total=4, succeeded=0, failed=0):
    return BatchSummary(
        "01K6WM2B7Q3W9Z0V5N8XJ4R1TD", "", "motion", None, status, "", "", "", total, succeeded, failed, 0, 1
    )


@pytest.mark.parametrize(
    ("status", "without"),
    [("queued", "queued"), ("running", "queued"), ("cancelled", "cancelled"), ("succeeded", "failed")],
)
def test_a_row_for_each_sample_whatever_came_of_it(status, without):
    varied = plan(["/seed"], [[1, 2, 3, 4]], metrics=["size"])
    ended = [
        TableRow(1, Status.SUCCEEDED, True, [2, 0.1 + 0.2], None),
        TableRow(3, Status.FAILED, False, None, '{"detail": "no"}'),
    ]
    table = build_table(batch(Status(status)), varied, ended)
    assert table.columns == ["/seed", "status", "cached", "designs", "size", "job", "failure"]
    assert table.rows[0][:6] == [1, without, False, None, None, None]
    ids = [make_sample_id("01K6WM2B7Q3W9Z0V5N8XJ4R1TD", n) for n in (1, 3)]
    assert table.rows[1] == [2, "succeeded", True, 2, 0.1 + 0.2, ids[0], None]
    assert table.rows[3] == [4, "failed", False, None, None, ids[1], "no"]
    read = list(csv.DictReader(io.StringIO(csv_of(table))))
    assert float(read[1]["size"]) == 0.1 + 0.2
    assert [row["/seed"] for row in read] == ["1", "2", "3", "4"]


def test_values_of_any_type_are_in_the_csv():
    varied = plan(["/mechanisms", "/label"], [[["fourbar"], None], ['a,"b"\n', "c"]], grid=False)
    read = list(csv.reader(io.StringIO(csv_of(build_table(batch(Status.QUEUED, 2), varied, [])))))
    assert [row[:2] for row in read[1:]] == [['["fourbar"]', 'a,"b"\n'], ["", "c"]]


def test_a_front_is_what_no_other_beats():
    rng = np.random.default_rng(3)
    for columns, values, rows in ((1, 12, 200), (2, 12, 200), (2, 400, 700), (3, 12, 200), (3, 60, 700), (5, 9, 700)):
        table = rng.integers(-2, values, (rows, columns)) * rng.choice([-1.0, 1.0], columns)
        beaten = [((table <= row).all(axis=1) & (table < row).any(axis=1)).any() for row in table]
        assert find_unbeaten(table) == [n for n, is_beaten in enumerate(beaten) if not is_beaten]
    assert find_unbeaten(np.empty((0, 2))) == []


@pytest.mark.slow
@pytest.mark.parametrize("columns", [2, 4])
def test_the_front_of_the_largest_batch_takes_no_seconds(columns):
    """All rows are in it, which takes the longest: compared one by one they would take more than a second."""
    table = np.random.default_rng(4).random((MAX_SAMPLES, columns))
    table[:, -1] = -table[:, :-1].sum(axis=1)
    began = time.thread_time()
    assert find_unbeaten(table) == list(range(MAX_SAMPLES))
    assert time.thread_time() - began < 1.0


def test_a_plan_of_draws_is_small_and_read_as_it_was():
    """Ten thousand times one of two large objects are not written out; doubles keep all their bits."""
    points = [[{"x": 1.0 * k, "y": 0.1 * n} for k in range(80)] for n in (1, 2)]
    drawn = sample_latin_hypercube([points, Span(0.1, 0.7), ["a", None]], MAX_SAMPLES, 0)
    before = plan(["/points", "/x", "/y"], drawn, grid=False, problem={"kind": "path"})
    stored = before.dump_values()
    assert len(stored) < 200_000
    read = Plan.read(before.dump_statement(), stored)
    assert read.total == MAX_SAMPLES
    assert [read.sample(n) for n in range(MAX_SAMPLES)] == [before.sample(n) for n in range(MAX_SAMPLES)]
    assert sum(read.sample(n)[0] == points[1] for n in range(MAX_SAMPLES)) == MAX_SAMPLES // 2


def test_a_table_comes_in_pieces_that_make_one(monkeypatch):
    monkeypatch.setattr(table_module, "CHUNK_ROWS", 3)
    varied = plan(["/seed"], [[*range(8)]], metrics=["size"])
    whole = build_table(batch(Status.QUEUED, 8), varied, [])
    pieces = list(whole.as_json(least=["size"]))
    assert len(pieces) == 5
    assert json.loads(b"".join(pieces)) == {"columns": whole.columns, "least": ["size"], "rows": whole.rows}
    assert [row[0] for row in csv.reader(io.StringIO(csv_of(whole)))] == ["/seed", *map(str, range(8))]
    nothing = Table(["a"], [])
    assert json.loads(b"".join(nothing.as_json())) == {"columns": ["a"], "rows": []}


@pytest.mark.parametrize("kind", KINDS)
def test_no_column_of_a_table_has_the_name_of_another(kind):
    varied = plan(["/seed"], [[1]], metrics=KINDS[kind].metrics)
    columns = build_table(batch(Status.QUEUED, 1), varied, []).columns
    assert len(set(columns)) == len(columns)


def test_rows_without_a_number_are_not_weighed_up():
    varied = plan(["/seed"], [[1, 2, 3, 4]], metrics=["size", "min_transmission_angle"])
    figures = [[1, 5.0, 30.0], [0, None, None], [1, 4.0, 40.0], [1, 6.0, 50.0]]
    ended = [TableRow(n, Status.SUCCEEDED, False, told, None) for n, told in enumerate(figures)]
    table = build_table(batch(Status.SUCCEEDED, succeeded=4), varied, ended)
    assert [row[0] for row in table.select_front(["size"], ["min_transmission_angle"]).rows] == [3, 4]
    assert [row[0] for row in table.select_front(["size"], []).rows] == [3]
    assert [row[0] for row in table.select_front(["min_transmission_angle"], []).rows] == [1]


@pytest.mark.parametrize(
    ("kind", "metrics"),
    [
        ("gear_train", ["relative_error", "total_teeth"]),
        ("planetary_train", ["error", "size"]),
        ("train_series", ["error", "total_teeth"]),
        ("gearbox", ["max_error", "tooth_sum"]),
        ("layshaft_gearbox", ["max_error", "tooth_sum"]),
        ("motion", ["rms_residual", "min_transmission_angle", "size"]),
        ("cam", ["size"]),
        ("flywheel", []),
    ],
)
def test_a_kind_shows_its_error_and_its_size(kind, metrics):
    assert select_default_metrics(KINDS[kind].metrics) == metrics


def test_an_error_with_a_sign_is_weighed_by_its_size():
    table = Table(["error", "total_teeth"], [[-0.5, 40], [0.1, 60], [-0.01, 90], [0.02, 95], [None, 10]])
    assert [row[0] for row in table.select_front(["error", "total_teeth"], []).rows] == [-0.5, 0.1, -0.01]
    assert [row[0] for row in table.select_front([], ["error"]).rows] == [0.1]
