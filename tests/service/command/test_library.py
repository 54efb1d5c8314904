"""The library against a running service: the same objects, the same answers, and no solver in the client's process."""

import asyncio
import doctest
import subprocess
import sys
import threading

import numpy as np
import pytest

from mechsynth import AsyncClient, Cancelled, Client, InvalidProblem, JobFailed, Motion, Position, Refused, solve
from tests.support.service.running import PROBLEM, ROOT, environment
from tests.support.service.scripted_server import BROKEN, STEPS

ASKED = Motion(
    positions=[Position(x=0.0, y=0.0, angle=0.0), Position(x=10.0, y=5.0, angle=30.0)], max_designs=2, seed=3
)


@pytest.fixture
def gated(scripted):
    (scripted.folder / "open").unlink(missing_ok=True)
    yield scripted
    (scripted.folder / "open").touch()


def stated(seed):
    return {**PROBLEM, "seed": seed}


@pytest.mark.slow
def test_a_service_and_this_process_give_one_answer(server):
    told = []
    with Client(server.url) as client:
        with server.solving_anew():
            result = client.solve(ASKED, label="both", progress=lambda share, doing: told.append((share, doing)))
        here = solve(ASKED, label="both")
        assert result.to_json() == here.to_json()
        job = server.client.get("/v1/jobs?limit=1").json()["jobs"][0]
        assert job["label"] == "both"
        assert client.result(job["id"]).to_json() == here.to_json()
        moved = [client.service.motion(job["id"], n, steps=24) for n in range(len(result.designs))]
    for n, design in enumerate(result.designs):
        place = f"/v1/jobs/{job['id']}/designs/{n}"
        for form in design.forms if n == 0 else ["svg"]:
            made = design.file(form)
            content = made if isinstance(made, bytes) else made.encode()
            assert server.client.get(f"{place}.{form}").content == content
        cycle = design.motion(24)
        np.testing.assert_array_equal(cycle.input_angle, moved[n]["input_angle"])
        for name, track in moved[n]["joints"].items():
            np.testing.assert_array_equal(cycle.joints[name], np.transpose([track["x"], track["y"]]))


@pytest.mark.parametrize(
    ("problem", "path"),
    [({**PROBLEM, "postions": []}, "/postions"), ({**PROBLEM, "length_unit": "ell"}, "/length_unit")],
)
def test_a_service_says_what_is_wrong_by_field_as_this_process_does(server, problem, path):
    with Client(server.url) as client, pytest.raises(InvalidProblem) as there:
        client.solve(problem)
    with pytest.raises(InvalidProblem) as here:
        solve(problem)
    assert list(there.value.errors) == [path]
    assert there.value.errors == here.value.errors


def test_other_refusals_and_failures_are_those_of_the_service(gated):
    with Client(gated.url) as client:
        with pytest.raises(JobFailed):
            client.solve(stated(BROKEN))
        with pytest.raises(Refused) as refused:
            client.solve(PROBLEM, label="x" * 10_000)
        assert list(refused.value.errors) == ["/label"]


def test_a_job_is_given_up_from_another_thread(gated):
    cancel = threading.Event()
    with Client(gated.url) as client, pytest.raises(Cancelled):
        client.solve(stated(STEPS), label="up", progress=lambda share, _: share and cancel.set(), cancel=cancel)
    job = gated.client.get("/v1/jobs?limit=1").json()["jobs"][0]
    assert (job["label"], job["status"]) == ("up", "cancelled")


def test_many_problems_are_waited_for_on_a_loop(server):
    async def program():
        async with AsyncClient(server.url) as client:
            with pytest.raises(InvalidProblem):
                await client.solve({**PROBLEM, "postions": []})
            told = []
            train = {"kind": "gear_train", "ratio": "7/3", "max_stages": 1}
            results = await asyncio.gather(
                client.solve(ASKED), client.solve(train, progress=lambda share, _: told.append(share))
            )
            job = server.client.get("/v1/jobs?limit=1&kind=gear_train").json()["jobs"][0]
            assert (await client.result(job["id"])).to_json() == results[1].to_json()
            return results, told

    (motion, train), told = asyncio.run(program())
    assert motion.to_json() == solve(ASKED).to_json()
    assert train.designs[0].mechanism.type == "gear_train"
    assert told[-1] == 1.0


@pytest.mark.slow
def test_who_asks_a_service_loads_no_solver(server, tmp_path):
    program = (
        "import sys\n"
        "from mechsynth import Client\n"
        f"result = Client({server.url!r}).solve({{'kind': 'gear_train', 'ratio': '7/3', 'max_stages': 1}})\n"
        "assert result.designs[0].passed\n"
        "heavy = {'numba', 'scipy', 'cvxpy', 'highspy', 'ezdxf', 'PIL', 'fastapi', 'sqlalchemy'}\n"
        "print(*(heavy & set(sys.modules)))\n"
    )
    command = [sys.executable, "-W", "ignore", "-c", program]
    run = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, env=environment(tmp_path))
    assert (run.returncode, run.stdout.split(), run.stderr) == (0, [], "")


@pytest.mark.slow
def test_the_examples_of_the_page_run(server):
    page = ROOT / "docs" / "start" / "library.md"
    outcome = doctest.testfile(str(page), module_relative=False, globs={"url": server.url})
    assert outcome.attempted > 25
    assert outcome.failed == 0
