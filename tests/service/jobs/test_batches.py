"""Many problems at once, through HTTP."""

import json
import time

import pytest

from service.api.routes.batch_schemas import EXAMPLE, MAX_SAMPLES
from tests.campaign import further
from tests.support.service.access import client_with
from tests.support.service.access import made as made_key
from tests.support.service.running import PROBLEM, SCRIPTED, SOON_S, RunningServer, until
from tests.support.service.scripted_server import BRIEF, BROKEN, DIES_ONCE, GATED, GREEDY, INSTANT

UNFINISHED = ("queued", "running")
LARGE = 1000  # points of a path; it may have no more


def stated(*seeds, **fields):
    return {"problem": PROBLEM, "vary": [{"field": "/seed", "values": list(seeds)}], "reuse": False, **fields}


def post(client, body, **headers):
    answer = client.post("/v1/batches", json=body, headers=headers)
    assert answer.status_code in (200, 202), answer.text
    assert answer.headers["location"] == f"/v1/batches/{answer.json()['id']}"
    return answer.json()


def get(client, batch):
    answer = client.get(f"/v1/batches/{batch['id']}")
    assert answer.status_code == 200
    return answer.json()


def finished(client, batch, seconds=120.0):
    def there():
        now = get(client, batch)
        return now if now["status"] not in UNFINISHED else None

    return until(there, seconds, "the end of the batch")


def table(client, batch):
    """The rows as objects by column."""
    read = client.get(f"/v1/batches/{batch['id']}/table.json").raise_for_status().json()
    return [dict(zip(read["columns"], row, strict=True)) for row in read["rows"]]


@pytest.mark.slow
@pytest.mark.embedded
def test_a_batch_has_the_answers_of_its_problems(client):
    done = finished(client, post(client, {**EXAMPLE, "reuse": False, "label": "a grid"}))
    assert (done["status"], done["total"], done["done"], done["succeeded"]) == ("succeeded", 15, 15, 15)
    assert (done["kind"], done["label"], done["progress"]["fraction"]) == ("motion", "a grid", 1.0)
    rows = table(client, done)
    expected = [(x, angle) for x in (170, 175, 180, 185, 190) for angle in (-50, -45, -40)]
    assert [(row["/positions/1/x"], row["/positions/1/angle"]) for row in rows] == expected
    for row in rows[::7]:
        problem = json.loads(json.dumps(EXAMPLE["problem"]))
        problem["positions"][1] |= {"x": row["/positions/1/x"], "angle": row["/positions/1/angle"]}
        single = client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": "wait=30"}).json()
        job = client.get(f"/v1/jobs/{row['job']}").json()
        assert (job["problem"], job["result"]) == (single["problem"], single["result"])
        assert (job["batch"], job["cached"], job["label"]) == (done["id"], False, "a grid")
        assert not single.keys() & {"batch", "cached"}
        best = job["result"]["designs"][0]["metrics"]
        assert (row["min_transmission_angle"], row["size"]) == (best["min_transmission_angle"], best["size"])
        assert row["designs"] == len(job["result"]["designs"])
        assert client.get(f"/v1/jobs/{row['job']}/designs/0.svg").text.startswith("<svg")
    front = client.get(f"/v1/batches/{done['id']}/front").json()
    assert (front["least"], front["greatest"]) == (["size"], ["min_transmission_angle"])
    kept = [dict(zip(front["columns"], row, strict=True)) for row in front["rows"]]
    beaten = [
        any(
            other["size"] <= row["size"]
            and other["min_transmission_angle"] >= row["min_transmission_angle"]
            and other != row
            for other in rows
        )
        for row in rows
    ]
    assert kept == [row for row, is_beaten in zip(rows, beaten, strict=True) if not is_beaten]


@pytest.mark.slow
@pytest.mark.embedded
def test_a_batch_of_gears_shows_errors_and_teeth(client):
    """Two stages of few teeth are above or below their ratios: of the errors the size counts, not the sign."""
    problem = {"kind": "gear_train", "ratio": 3.1, "max_stages": 1, "teeth": {"min": 18, "max": 60}, "max_designs": 1}
    ratios = [2.713, 2.719, 3.03, 3.117, 3.141]
    done = finished(client, post(client, {"problem": problem, "vary": [{"field": "/ratio", "values": ratios}]}))
    rows = table(client, done)
    for row in rows:
        best = client.get(f"/v1/jobs/{row['job']}").json()["result"]["designs"][0]["metrics"]
        assert (row["relative_error"], row["total_teeth"]) == (best["relative_error"], best["total_teeth"])
    assert min(row["relative_error"] for row in rows) < 0.0 < max(row["relative_error"] for row in rows)
    front = client.get(f"/v1/batches/{done['id']}/front").json()
    assert (front["least"], front["greatest"]) == (["relative_error", "total_teeth"], [])

    def beats(other, row):
        better = [abs(other["relative_error"]) - abs(row["relative_error"]), other["total_teeth"] - row["total_teeth"]]
        return max(better) <= 0.0 and min(better) < 0.0

    kept = [dict(zip(front["columns"], row, strict=True)) for row in front["rows"]]
    assert kept == [row for row in rows if not any(beats(other, row) for other in rows)]
    nearest = client.get(f"/v1/batches/{done['id']}/front?least=relative_error").json()
    assert [row[0] for row in nearest["rows"]] == [min(rows, key=lambda row: abs(row["relative_error"]))["/ratio"]]


@pytest.mark.slow
@pytest.mark.embedded
def test_equal_problems_are_answered_from_the_store(client):
    problem = {**EXAMPLE["problem"], "seed": 11}

    def of(*values, **fields):
        return finished(client, post(client, {"problem": problem, "vary": [varied(values)], **fields}))

    def varied(values):
        return {"field": "/positions/1/x", "values": [*values]}

    def cached(batch):
        rows = table(client, batch)
        assert batch["cached"] == sum(row["cached"] for row in rows)
        jobs = [client.get(f"/v1/jobs/{row['job']}").json() for row in rows]
        assert [job["cached"] for job in jobs] == [row["cached"] for row in rows]
        assert [job["problem"]["positions"][1]["x"] for job in jobs] == [row["/positions/1/x"] for row in rows]
        return [row["cached"] for row in rows], [job["result"] for job in jobs]

    single = {**problem, "positions": [{**p, "x": 172.25} if p["x"] == 184.0 else p for p in problem["positions"]]}
    job = client.post("/v1/jobs", json={"problem": single}, headers={"Prefer": "wait=30"}).json()
    first = of(171.25, 172.25, 173.25)
    which, results = cached(first)
    assert (which, results[1]) == ([False, True, False], job["result"])
    problem = {"max_designs": 10, **dict(reversed(problem.items()))}  # the default, and another order
    again = of(173.25, 172.25, 174.25, 171.25)
    assert cached(again)[0] == [True, True, False, True]
    assert cached(again)[1][:2] == results[:0:-1]
    anew = of(171.25, 172.25, 173.25, reuse=False)
    assert cached(anew)[0] == [False] * 3
    many = of(*[171.25] * 40)
    assert cached(many) == ([True] * 40, [results[0]] * 40)
    told = [[row["size"] for row in table(client, each)] for each in (first, anew)]
    assert told[0] == told[1]
    for batch in (first, anew, again):
        assert client.delete(f"/v1/batches/{batch['id']}").status_code == 204
    assert cached(many)[1] == [results[0]] * 40, "whatever becomes of the batches that it was taken from"


@pytest.mark.slow
@pytest.mark.embedded
def test_a_hypercube_and_a_zip(client):
    drawn = {
        **EXAMPLE,
        "vary": [
            {"field": "/positions/1/x", "from": 170.0, "to": 190.0},
            {"field": "/constraints/grashof", "values": ["any", "crank_rocker"]},
        ],
        "sampling": "latin_hypercube",
        "samples": 8,
        "seed": 3,
        "metrics": ["size", "grashof"],
    }
    rows = table(client, finished(client, post(client, drawn)))
    assert sorted(int((row["/positions/1/x"] - 170.0) / 2.5) for row in rows) == list(range(8))
    assert sorted(row["/constraints/grashof"] for row in rows) == ["any"] * 4 + ["crank_rocker"] * 4
    for row in rows:
        assert (row["designs"] > 0) == (row["size"] is not None)
        if row["designs"] and row["/constraints/grashof"] == "crank_rocker":
            assert row["grashof"] == "crank_rocker"
    again = table(client, post(client, drawn))
    assert [row["/positions/1/x"] for row in again] == [row["/positions/1/x"] for row in rows]
    other = table(client, post(client, {**drawn, "seed": 4}))
    assert [row["/positions/1/x"] for row in other] != [row["/positions/1/x"] for row in rows]
    zipped = {
        **EXAMPLE,
        "vary": [
            {"field": "/positions/1/x", "from": 170, "to": 190, "count": 3},
            {"field": "/positions/1/angle", "values": [-45, -44.5, -44]},
        ],
        "sampling": "zip",
    }
    rows = table(client, post(client, zipped))
    values = [(row["/positions/1/x"], row["/positions/1/angle"]) for row in rows]
    assert values == [(170, -45), (180, -44.5), (190, -44)]


@pytest.mark.slow
@pytest.mark.embedded
def test_a_sample_that_contradicts_itself_fails_alone(client):
    body = {
        **EXAMPLE,
        "vary": [{"field": "/positions/1", "values": [EXAMPLE["problem"]["positions"][n] for n in (0, 1)]}],
    }
    done = finished(client, post(client, body))
    assert (done["status"], done["succeeded"], done["failed"]) == ("succeeded", 1, 1)
    failed, sound = table(client, done)
    assert (failed["status"], failed["designs"], sound["status"]) == ("failed", None, "succeeded")
    error = client.get(f"/v1/jobs/{failed['job']}").json()["error"]
    assert (error["type"], error["instance"]) == ("/problems/invalid-problem", f"/v1/jobs/{failed['job']}")
    assert error["errors"][0]["path"].startswith("/positions/1")
    assert error["detail"] == failed["failure"]


@pytest.mark.slow
def test_a_broken_sample_fails_and_the_others_do_not(scripted):
    seeds = [INSTANT, BROKEN, GREEDY, *range(BRIEF, BRIEF + 5)]
    done = finished(scripted.client, post(scripted.client, stated(*seeds)))
    rows = table(scripted.client, done)
    assert [row["status"] for row in rows] == ["succeeded", "failed", "failed"] + ["succeeded"] * 5
    types = [scripted.job(row["job"])["error"]["type"] for row in rows[1:3]]
    assert types == ["/problems/internal-error", "/problems/out-of-memory"]
    assert "secret" not in rows[1]["failure"]


@pytest.mark.slow
@pytest.mark.parametrize("moment", further(["before", "after"], ["after"]))
@pytest.mark.parametrize("write", ["store", "begun"])
def test_a_worker_may_die_at_any_write(scripted, moment, write):
    (scripted.folder / f"crash-{moment}-batch-{write}").touch()
    done = finished(scripted.client, post(scripted.client, stated(*range(BRIEF, BRIEF + 30))))
    assert not (scripted.folder / f"crash-{moment}-batch-{write}").exists()
    assert (done["succeeded"], done["failed"]) == (30, 0)
    assert len({row["job"] for row in table(scripted.client, done)}) == 30


@pytest.mark.slow
def test_a_worker_that_dies_takes_no_sample_with_it(scripted):
    (scripted.folder / "died").unlink(missing_ok=True)
    done = finished(scripted.client, post(scripted.client, stated(INSTANT, INSTANT + 1 + BRIEF, DIES_ONCE)))
    assert (scripted.folder / "died").exists()
    assert (done["succeeded"], done["failed"]) == (3, 0)


@pytest.mark.slow
def test_a_batch_is_followed_and_cancelled_and_removed(scripted):
    gate = scripted.folder / "open"
    gate.unlink(missing_ok=True)
    client = scripted.client
    batch = post(client, stated(INSTANT, INSTANT, INSTANT, GATED))
    path = f"/v1/batches/{batch['id']}"
    until(lambda: get(client, batch)["done"] == 3, SOON_S, "all but one")
    with client.stream("GET", f"{path}/events") as events:
        lines = events.iter_lines()
        assert next(lines) == "event: state"
        cancelled = client.delete(path)
        assert (cancelled.status_code, cancelled.json()["status"]) == (202, "cancelled")
        last = [json.loads(line.removeprefix("data: ")) for line in lines if line.startswith("data: ")][-1]
    assert (last["status"], last["done"], last["total"]) == ("cancelled", 3, 4)
    final = f"{get_revision(client, path)}-cancelled"
    assert client.get(f"{path}/events", headers={"Last-Event-ID": final}).status_code == 204
    rows = table(client, batch)
    assert [row["status"] for row in rows] == ["succeeded"] * 3 + ["cancelled"]
    assert scripted.post(INSTANT, wait=20)["status"] == "succeeded", "the worker is free again"
    job = rows[0]["job"]
    refused = client.delete(f"/v1/jobs/{job}")
    assert (refused.status_code, refused.json()["type"]) == (409, "/problems/part-of-batch")
    with client.stream("GET", f"/v1/jobs/{job}/events") as events:
        assert "succeeded" in "".join(events.iter_lines())
    assert client.delete(path).status_code == 204
    for gone in (path, f"{path}/table.csv", f"{path}/front", f"{path}/events", f"/v1/jobs/{job}"):
        assert client.get(gone).status_code == 404, gone
    assert client.delete(path).status_code == 404


def get_revision(client, path):
    answer = client.get(path)
    tag = answer.headers["etag"]
    assert client.get(path, headers={"If-None-Match": tag}).status_code == 304
    return int(tag.removeprefix("W/").strip('"'))


def test_the_same_request_has_one_batch(scripted):
    client, key = scripted.client, {"Idempotency-Key": "a-batch"}
    first = post(client, stated(INSTANT, INSTANT), **key)
    spelt_out = {**stated(INSTANT, INSTANT), "sampling": "grid", "seed": 0}
    assert post(client, dict(reversed(spelt_out.items())), **key)["id"] == first["id"]
    other = client.post("/v1/batches", json=stated(INSTANT), headers=key)
    assert (other.status_code, other.json()["type"]) == (409, "/problems/idempotency-key-reused")


@pytest.mark.slow
def test_single_jobs_do_not_wait_for_the_end_of_a_batch(scripted):
    batch = post(scripted.client, stated(*range(BRIEF, BRIEF + 400)))
    until(lambda: get(scripted.client, batch)["done"] > 0, SOON_S, "its begin")
    for _ in range(5):
        assert scripted.post(INSTANT, wait=20)["status"] == "succeeded"
    now = get(scripted.client, batch)
    assert (now["status"], now["done"] < 300) == ("running", True), "8 s of work"
    assert scripted.client.delete(f"/v1/batches/{batch['id']}").status_code == 202


def test_jobs_and_batches_are_listed_by_themselves(scripted):
    ids = [post(scripted.client, stated(INSTANT, INSTANT))["id"] for _ in range(3)]
    page = scripted.client.get("/v1/batches?limit=2").json()
    assert [batch["id"] for batch in page["batches"]] == ids[:0:-1]
    rest = scripted.client.get(f"/v1/batches?limit=1&cursor={page['next_cursor']}").json()
    assert [batch["id"] for batch in rest["batches"]] == ids[:1]
    done = finished(scripted.client, {"id": ids[-1]})
    jobs = {row["job"] for row in table(scripted.client, done)}
    listed = scripted.client.get("/v1/jobs?limit=100").json()["jobs"]
    assert not jobs & {job["id"] for job in listed}
    assert not any(job["id"] in ids for job in listed)


@pytest.mark.slow
@pytest.mark.campaign
@pytest.mark.embedded
def test_a_batch_outlives_its_server(tmp_path):
    key = made_key(tmp_path, "acme")
    body = stated(*range(BRIEF, BRIEF + 60))
    server = RunningServer(tmp_path, SCRIPTED, workers=1)
    with client_with(server, key) as client:
        batch = post(client, body, **{"Idempotency-Key": "once"})
        until(lambda: get(client, batch)["done"] > 10, SOON_S, "a part of it")
        server.kill()
    server = RunningServer(tmp_path, SCRIPTED, workers=1)
    try:
        with client_with(server, key) as client, client_with(server, made_key(tmp_path, "globex")) as other:
            assert post(client, body, **{"Idempotency-Key": "once"})["id"] == batch["id"]
            done = finished(client, batch)
            assert (done["status"], done["succeeded"], done["failed"]) == ("succeeded", 60, 0)
            assert len({row["job"] for row in table(client, done)}) == 60
            until(lambda: other.get("/v1/jobs").status_code == 200, 5.0, "the new key")
            path = f"/v1/batches/{batch['id']}"
            for about in (path, f"{path}/table.json", f"{path}/table.csv", f"{path}/front", f"{path}/events"):
                answers = [client.get(about), other.get(about)]
                assert [answer.status_code for answer in answers] == [200, 404], about
            assert other.delete(path).status_code == 404
            assert other.get("/v1/batches").json()["batches"] == []
            assert other.get(f"/v1/jobs/{table(client, done)[0]['job']}").status_code == 404
    finally:
        assert server.stop() == 0


BAD = [
    ({"problem": None}, "/problem"),
    ({"problem": {"kind": "motor"}}, "/problem/kind"),
    ({"problem": {}}, "/problem/kind"),
    ({"problem": {**PROBLEM, "positions": []}}, "/problem/positions"),
    ({"problem": {**PROBLEM, "colour": "red"}}, "/problem/colour"),
    ({"problem": {**PROBLEM, "positions": PROBLEM["positions"][:1] * 2}}, "/problem/positions/1"),
    ({"vary": []}, "/vary"),
    ({"vary": [{"field": "/seed"}]}, "/vary/0"),
    ({"vary": [{"field": "/seed", "values": []}]}, "/vary/0/values"),
    ({"vary": [{"field": "/seed", "values": [1], "from": 0}]}, "/vary/0"),
    ({"vary": [{"field": "/seed", "values": [1], "count": 3}]}, "/vary/0"),
    ({"vary": [{"field": "/seed", "from": 0, "to": 9}]}, "/vary/0"),
    ({"vary": [{"field": "/seed", "from": 0, "to": 9, "count": 0}]}, "/vary/0/count"),
    ({"vary": [{"field": "/seed", "from": 0, "to": 1e300, "count": 2}]}, "/vary/0/to"),
    ({"vary": [{"field": "/seed", "from": "0", "to": 2, "count": 2}]}, "/vary/0/from"),
    ({"vary": [{"field": "seed", "values": [1]}]}, "/vary/0/field"),
    ({"vary": [{"field": "/", "values": [1]}]}, "/vary/0/field"),
    ({"vary": [{"field": "/a~2", "values": [1]}]}, "/vary/0/field"),
    ({"vary": [{"field": "/positions/1/x~", "values": [1]}]}, "/vary/0/field"),
    ({"vary": [{"field": "/seed/x", "values": [1]}]}, "/vary/0/field"),
    ({"vary": [{"field": "/sead", "values": [1]}]}, "/vary/0/field"),
    ({"vary": [{"field": "/constraints/sead", "values": [1]}]}, "/vary/0/field"),
    ({"vary": [{"field": "/positions/7/x", "values": [1.0]}]}, "/vary/0/field"),
    ({"vary": [{"field": "/positions/one/x", "values": [1.0]}]}, "/vary/0/field"),
    ({"vary": [{"field": "/kind", "values": ["motion", "path"]}]}, "/vary/0/field"),
    ({"vary": [{"field": "/seed", "values": [1, -1]}]}, "/vary/0/values/1"),
    ({"vary": [{"field": "/seed", "from": 0.5, "to": 1.5, "count": 2}]}, "/vary/0"),
    ({"vary": [{"field": "/positions/1/x", "values": [1.0, 1e99]}]}, "/vary/0/values/1"),
    ({"vary": [{"field": "/positions/1/x", "values": [1.0, "2"]}]}, "/vary/0/values/1"),
    ({"vary": [{"field": "/positions/1", "values": [{"x": 1.0}]}]}, "/vary/0/values/0/y"),
    (
        {
            "vary": [{"field": "/positions/1/x", "values": [1.0, 1e99]}],
            "sampling": "latin_hypercube",
            "samples": 20,
        },
        "/vary/0/values/1",
    ),
    ({"vary": [{"field": "/seed", "values": [1]}, {"field": "/seed", "values": [2]}]}, "/vary/1/field"),
    ({"vary": [{"field": "/positions/1", "values": [1]}, {"field": "/positions/1/x", "values": [2]}]}, "/vary/1/field"),
    ({"vary": [{"field": f"/positions/{n}/x", "from": 0.0, "to": 1.0, "count": 101} for n in (0, 1)]}, "/vary"),
    ({"vary": [{"field": "/seed", "values": [1], "extra": 1}]}, "/vary/0/extra"),
    ({"sampling": "sobol"}, "/sampling"),
    ({"sampling": "latin_hypercube"}, "/samples"),
    ({"sampling": "latin_hypercube", "samples": MAX_SAMPLES + 1}, "/samples"),
    ({"sampling": "latin_hypercube", "samples": 0}, "/samples"),
    ({"samples": 3}, "/samples"),
    ({"seed": 3}, "/seed"),
    (
        {
            "sampling": "zip",
            "vary": [{"field": "/seed", "values": [1, 2]}, {"field": "/max_designs", "values": [1, 2, 3]}],
        },
        "/vary/1",
    ),
    (
        {"sampling": "latin_hypercube", "samples": 2, "vary": [{"field": "/seed", "from": 0, "to": 1, "count": 2}]},
        "/vary/0/count",
    ),
    ({"metrics": ["size", "weight"]}, "/metrics/1"),
    ({"metrics": ["size", "size"]}, "/metrics/1"),
    ({"reuse": "no"}, "/reuse"),
    ({"label": "a\0b"}, "/label"),
    ({"colour": "red"}, "/colour"),
]


@pytest.mark.parametrize(("changes", "path"), BAD)
def test_what_is_wrong_is_told_by_its_place(scripted, changes, path):
    before = len(scripted.client.get("/v1/batches?limit=100").json()["batches"])
    answer = scripted.client.post("/v1/batches", json={**stated(1, 2), **changes})
    assert answer.status_code == 422, answer.text
    paths = [fault["path"] for fault in answer.json()["errors"]]
    assert path in paths or any(found.startswith(f"{path}/") for found in paths), paths
    assert len(scripted.client.get("/v1/batches?limit=100").json()["batches"]) == before


MOTION = f'{{"problem": {json.dumps(PROBLEM)}, "vary": [{{"field": "/seed", '


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ('{"problem": {"kind": "motion", "seed": NaN}, "vary": [{"field": "/seed", "values": [1]}]}', "/problem/seed"),
        (MOTION + '"values": [1e999]}]}', "/vary/0/values/0"),
        (MOTION + '"values": [1, 2, {"a": [0, -Infinity]}]}]}', "/vary/0/values/2/a/1"),
        (MOTION + f'"values": [{"1, " * 9000} NaN]}}]}}', "/vary/0/values/9000"),
        (MOTION + '"from": 0, "to": NaN, "count": 2}]}', "/vary/0/to"),
        (MOTION.replace("/seed", "/" + "a/" * 240) + '"values": [1]}]}', "/vary/0/field"),
        (MOTION + '"values": [' + "[" * 150 + "]" * 150 + "]}]}", "/vary/0/values/0"),
        (MOTION + '"values": [1' + "0" * 3000 + "]}]}", "/vary/0/values/0"),
        (MOTION + '"field": "/seed", "values": [1]}]}', "/vary/0/field"),
        (MOTION + '"values": [' + "[" * 5000 + "]" * 5000 + "]}]}", None),
        (MOTION + '"values": ["\\ud800"]}]}', None),
        ('[{"problem": 1}]', ""),
    ],
)
def test_hostile_bodies_are_refused(scripted, text, path):
    answer = scripted.client.post("/v1/batches", content=text, headers={"Content-Type": "application/json"})
    if path is None:
        assert (answer.status_code, answer.json()["type"]) == (400, "/problems/malformed-json"), answer.text
        return
    assert answer.status_code == 422, answer.text
    assert answer.json()["type"] in ("/problems/invalid-request", "/problems/invalid-problem")
    paths = [fault["path"] for fault in answer.json()["errors"]]
    assert path in paths, paths


@pytest.mark.parametrize(
    "query",
    [
        "least=weight",
        "greatest=size&greatest=status",
        "by=size",
        "least=/seed",
        "least=size&greatest=size",
        "least=size&least=size",
        "greatest=size&greatest=size",
    ],
)
def test_a_front_is_of_metrics_of_the_batch(scripted, query):
    batch = post(scripted.client, stated(INSTANT))
    answer = scripted.client.get(f"/v1/batches/{batch['id']}/front?{query}")
    assert answer.status_code == 422
    nothing = post(scripted.client, {**stated(INSTANT), "metrics": []})
    assert scripted.client.get(f"/v1/batches/{nothing['id']}/front").status_code == 422
    assert scripted.client.get(f"/v1/batches/{batch['id']}/front?least=size").json()["rows"] == []


@pytest.mark.slow
def test_a_batch_of_large_problems_is_taken_at_once(scripted):
    """They lie far off the right place, which fails each: only what the statement is by itself is looked at."""
    points = {"kind": "path", "points": [{"x": 1.0 * n, "y": 0.1 * n * n} for n in range(LARGE)]}
    vary = [{"field": "/seed", "from": 0, "to": MAX_SAMPLES - 1, "count": MAX_SAMPLES}]
    began = time.monotonic()
    answer = scripted.client.post("/v1/batches", json={"problem": points, "vary": vary})
    assert time.monotonic() - began < SOON_S
    assert answer.status_code == 202, answer.text
    assert scripted.client.delete(answer.headers["location"]).status_code == 202


@pytest.mark.parametrize("sampling", [{}, {"sampling": "latin_hypercube", "samples": MAX_SAMPLES}])
def test_a_table_of_very_large_values_is_refused(scripted, sampling):
    points = [{"x": 1.0 * n, "y": 0.1 * n * n} for n in range(LARGE)]
    seeds = {"field": "/seed", "from": 0, "to": MAX_SAMPLES - 1} | ({} if sampling else {"count": MAX_SAMPLES})
    body = {"problem": {"kind": "path"}, "vary": [{"field": "/points", "values": [points]}, seeds], **sampling}
    refused = scripted.client.post("/v1/batches", json=body)
    assert (refused.status_code, refused.json()["errors"][0]["path"]) == (422, "/vary")


def test_the_largest_batch_is_taken_at_once(scripted):
    ranges = [{"field": f"/positions/{n}/x", "from": 1.0 + n, "to": 1.5 + n, "count": 100} for n in (0, 1)]
    began = time.monotonic()
    batch = post(scripted.client, {**stated(), "vary": ranges})
    assert time.monotonic() - began < SOON_S
    assert batch["total"] == MAX_SAMPLES
    assert scripted.client.delete(f"/v1/batches/{batch['id']}").json()["status"] == "cancelled"
    assert len(table(scripted.client, batch)) == MAX_SAMPLES
    assert scripted.client.delete(f"/v1/batches/{batch['id']}").status_code == 204
