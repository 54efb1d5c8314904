"""The Python client and ``mechsynth solve``, against real servers."""

import asyncio
import io
import json
import signal
import subprocess
import sys
import threading
import time

import pytest

from service.client import AsyncClient, Client, JobFailed, JobSummary, Progress, Refused, Unreachable
from synthesis.registry import KINDS, get_first_example
from tests.campaign import further
from tests.support.service.running import PROBLEM, REAL, SCRIPTED, RunningServer, environment, until
from tests.support.service.scripted_server import BROKEN, GATED, INSTANT, NATIVE, STEPS


@pytest.fixture(scope="module")
def real(server):
    with Client(server.url) as client:
        yield client


@pytest.fixture
def ours(scripted):
    (scripted.folder / "open").unlink(missing_ok=True)
    with Client(scripted.url) as client:
        yield client
    (scripted.folder / "open").touch()


def stated(seed):
    return {**PROBLEM, "seed": seed}


def test_a_problem_is_solved_and_drawn(real):
    job = real.solve(get_first_example("gear_train"), label="gears")
    assert (job.status, job.kind, job.label) == ("succeeded", "gear_train", "gears")
    assert job.result["search"]["complete"]
    assert real.file(job.id, 0, "svg").startswith(b"<svg")
    assert real.file(job.id, 0, "csv")
    assert real.file(job.id, 999, "svg") is None
    assert real.job(job.id) == job
    assert job.id in [listed.id for listed in real.jobs(kind="gear_train", status="succeeded")]
    real.delete(job.id)
    with pytest.raises(Refused) as refused:
        real.job(job.id)
    assert refused.value.status == 404


def test_a_mechanism_is_analysed_and_moved(real):
    fourbar = {
        "type": "fourbar",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
        "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
    }
    assert len(real.analyse(fourbar, {"steps": 12})["input_angle"]) == 13
    job = real.solve(get_first_example("motion"))
    assert set(real.motion(job.id, 0, steps=10)["joints"]) >= {"O2", "O4", "A", "B"}


def test_the_kinds_are_listed(real):
    assert set(real.problems()) == set(KINDS)


def test_a_refusal_names_the_fields(real):
    with pytest.raises(Refused) as refused:
        real.submit({**PROBLEM, "postions": []})
    assert refused.value.status == 422
    assert list(refused.value.errors) == ["/problem/postions"]
    assert "/problem/postions" in str(refused.value)


def test_a_job_is_followed_to_its_end(ours, scripted):
    job = ours.submit(stated(STEPS))
    heard, seen = [], []
    for news in ours.follow(job.id):
        seen.append(news)
        if isinstance(news, Progress):
            heard.append(news)
            (scripted.folder / "open").touch()
    assert Progress(0.25, "a quarter") in heard
    assert isinstance(seen[-1], JobSummary)
    assert seen[-1].status == "succeeded"
    assert list(ours.follow(job.id))[-1].status == "succeeded"


def test_a_failed_or_cancelled_job_is_told_as_such(ours):
    with pytest.raises(JobFailed) as failed:
        ours.solve(stated(BROKEN))
    assert failed.value.job.status == "failed"
    assert "defect" in str(failed.value)
    job = ours.submit(stated(NATIVE))
    cancelling = threading.Timer(0.3, ours.delete, args=(job.id,))
    cancelling.start()
    assert ours.wait(job.id).status == "cancelled"
    cancelling.join()  # the wait may end before the answer to the request does


@pytest.mark.slow
def test_a_wait_is_given_up_from_another_thread(ours, scripted):
    cancel = threading.Event()
    with pytest.raises(JobFailed) as failed:
        ours.solve(stated(STEPS), progress=lambda heard: heard.fraction and cancel.set(), cancel=cancel)
    assert failed.value.job.status == "cancelled"
    assert scripted.job(failed.value.job.id)["status"] == "cancelled"


@pytest.mark.slow
def test_who_is_told_how_far_a_job_is_may_give_it_up(ours, scripted):
    class GivenUp(Exception):
        pass

    def told(progress):
        if progress.fraction:
            raise GivenUp

    with pytest.raises(GivenUp):
        ours.solve(stated(STEPS), label="given up", progress=told)
    job = scripted.client.get("/v1/jobs?limit=1").json()["jobs"][0]
    assert job["label"] == "given up"
    scripted.reaches(job["id"], "cancelled")


@pytest.mark.slow
def test_many_jobs_are_waited_for_on_one_loop(ours, scripted):
    async def program():
        async with AsyncClient(scripted.url) as client:
            heard = []
            solving = [client.solve(stated(INSTANT), label=str(n)) for n in range(5)]
            jobs = await asyncio.gather(*solving, client.solve(stated(STEPS), progress=heard_and_opened(heard)))
            with pytest.raises(JobFailed):
                await client.solve(stated(BROKEN))
            with pytest.raises(Refused) as refused:
                await client.submit({**PROBLEM, "postions": []})
            assert list(refused.value.errors) == ["/problem/postions"]
            return jobs, heard

    def heard_and_opened(heard):
        def told(progress):
            heard.append(progress)
            if progress.fraction:
                (scripted.folder / "open").touch()

        return told

    jobs, heard = asyncio.run(program())
    assert [job.label for job in jobs] == [*"01234", None]
    assert {job.status for job in jobs} == {"succeeded"}
    assert Progress(0.25, "a quarter") in heard
    assert [ours.job(job.id) for job in jobs] == jobs


def test_a_task_that_is_cancelled_cancels_its_job(ours, scripted):
    async def program():
        async with AsyncClient(scripted.url) as client:
            running = asyncio.Event()
            solving = asyncio.create_task(
                client.solve(stated(STEPS), label="left", progress=lambda heard: heard.fraction and running.set())
            )
            await running.wait()
            solving.cancel()
            with pytest.raises(asyncio.CancelledError):
                await solving

    asyncio.run(program())
    job = scripted.client.get("/v1/jobs?limit=1").json()["jobs"][0]
    assert job["label"] == "left"
    scripted.reaches(job["id"], "cancelled")


@pytest.mark.slow
def test_lists_are_read_page_by_page(ours):
    created = [ours.submit(stated(INSTANT)).id for _ in range(25)]
    listed = []
    for job in ours.jobs():
        listed.append(job.id)
        if len(listed) == 25:
            break
    assert listed == created[::-1]


@pytest.mark.slow
@pytest.mark.campaign
def test_a_restart_of_the_service_is_survived(tmp_path):
    server = RunningServer(tmp_path, SCRIPTED, workers=1)
    port = server.url.rpartition(":")[2]
    with Client(server.url) as client:
        job = client.submit(stated(GATED))
        heard, ended = [], []
        waiting = threading.Thread(target=lambda: ended.append(client.wait(job.id, heard.append)))
        waiting.start()
        until(lambda: heard)
        server.kill()
        server = RunningServer(tmp_path, SCRIPTED, workers=1, port=port)
        try:
            (tmp_path / "open").touch()
            waiting.join(20)
            assert [job.status for job in ended] == ["succeeded"]
        finally:
            assert server.stop() == 0


def test_no_service_is_said_after_some_attempts():
    with Client("http://127.0.0.1:1") as client:
        began = time.monotonic()
        with pytest.raises(Unreachable, match="no answer from"):
            client.submit(PROBLEM)
        assert 1.0 < time.monotonic() - began < 10.0


def solve(folder, url, *arguments, stdin=None, **settings):
    return subprocess.run(
        [sys.executable, *REAL, "solve", "--url", url, *arguments],
        env=environment(folder, **settings),
        cwd=folder,
        input=stdin,
        capture_output=True,
        text=True,
        timeout=120,
    )


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["motion", "gear_train"])
def test_the_command_prints_the_answer_and_writes_the_drawings(server, tmp_path, kind):
    (tmp_path / "task.json").write_text(json.dumps(get_first_example(kind)))
    done = solve(tmp_path, server.url, "task.json")
    assert done.returncode == 0, done.stderr
    job = server.client.get("/v1/jobs?limit=1").json()["jobs"][0]
    result = server.job(job["id"])["result"]
    assert job["label"] == "task"
    assert result["summary"] in done.stdout
    assert f"{len(result['designs'])} designs, best first" in done.stdout
    mechanism = result["designs"][0]["mechanism"]
    dimension = mechanism["links"]["coupler"] if kind == "motion" else mechanism["ratio"]["value"]
    assert f"{dimension:.6g}" in done.stdout
    for check in result["designs"][0]["verification"]["checks"]:
        assert check["name"] in done.stdout
    for n in range(len(result["designs"])):
        drawn = (tmp_path / "task-designs" / f"design-{n + 1}.svg").read_bytes()
        assert drawn == server.client.get(f"/v1/jobs/{job['id']}/designs/{n}.svg").content


@pytest.mark.slow
def test_every_kind_can_be_printed(real):
    from rich.console import Console

    from service.command.solve import report

    for kind in ("cam", "planetary_train", "gearbox", "layshaft_gearbox", "quick_return", "function"):
        if kind in KINDS:
            console = Console(record=True, width=200, file=io.StringIO())
            job = real.solve(get_first_example(kind))
            report(job, console)
            printed = console.export_text()
            design = job.result["designs"][0]
            assert design["mechanism"]["type"] in printed
            units = {"angle": "°", "length": " mm", "velocity": " mm/rad", None: ""}
            for check in design["verification"]["checks"]:
                if "value" in check:
                    amount = f"{check['value']:.6g}{units[check.get('dimension')]}"
                    cells = [[cell.strip() for cell in line.split("│")] for line in printed.splitlines()]
                    verdict = "passed" if check["passed"] else "FAILED"
                    assert any(row[1:4] == [check["name"], verdict, amount] for row in cells), check


@pytest.mark.slow
def test_the_command_takes_the_body_of_a_request_from_standard_input(server, tmp_path):
    body = json.dumps({"problem": get_first_example("gear_train"), "label": "piped"})
    done = solve(tmp_path, server.url, "-", "--forms", "csv", "--output", "tables", stdin=body)
    assert done.returncode == 0, done.stderr
    assert {path.suffix for path in (tmp_path / "tables").iterdir()} == {".csv"}
    assert server.client.get("/v1/jobs?limit=1").json()["jobs"][0]["label"] == "piped"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("content", "says"),
    further(
        [
            ("{", "not JSON"),
            ("[]", "no JSON object"),
            ('{"kind": "motion"}', "/problem/positions"),
            (None, "cannot read"),
        ],
        [('{"kind": "motion"}', "/problem/positions")],
    ),
)
def test_the_command_says_what_is_wrong(server, tmp_path, content, says):
    if content is not None:
        (tmp_path / "task.json").write_text(content)
    done = solve(tmp_path, server.url, "task.json")
    assert done.returncode == 1
    assert says in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_the_command_cancels_its_job_when_interrupted(scripted, tmp_path):
    (scripted.folder / "open").unlink(missing_ok=True)
    (tmp_path / "task.json").write_text(json.dumps(stated(GATED)))
    with subprocess.Popen(
        # Processes of a test that is dealt out to several ignore interrupts, and so would their children.
        ["env", "--default-signal=INT", sys.executable, *REAL, "solve", "--url", scripted.url, "task.json"],
        env=environment(tmp_path),
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        job = until(lambda: scripted.client.get("/v1/jobs?status=running").json()["jobs"], 60.0)[0]
        time.sleep(2.0)  # past the first second, which it waits by Prefer
        process.send_signal(signal.SIGINT)
        assert "cancelled" in process.communicate(timeout=60)[1]
    assert process.returncode == 1
    assert scripted.job(job["id"])["status"] == "cancelled"
    (scripted.folder / "open").touch()
