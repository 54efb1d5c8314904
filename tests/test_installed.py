"""What the container file installs works in an empty folder and leaves the packages as they are."""

import os
import re
import socket
import subprocess
from pathlib import Path

import httpx
import pytest

from service.client import Client
from tests.support.container_file import read_stage, run_first_stage
from tests.support.service.running import until

STARTS = (
    "from synthesis.kinds.path.exact.continuation_starts import load_nine_point_start as start; print(len(start().y))"
)

FOURBAR = {
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
}

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(900)]


def run(*command, **options):
    return subprocess.run(
        command if len(command) > 1 else command[0], check=True, capture_output=True, text=True, **options
    ).stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory) -> Path:
    """The programs of the environment that the container file makes: users' packages and the project, no more."""
    return run_first_stage(tmp_path_factory.mktemp("image")) / "bin"


@pytest.fixture
def outside(tmp_path) -> dict[str, str]:
    """An environment in which nothing points to the checkout or to other caches."""
    kept = {key: os.environ[key] for key in ("PATH", "LANG", "TZ") if key in os.environ}
    return {**kept, "HOME": str(tmp_path / "home"), "MECHSYNTH_PORT": "0", "MECHSYNTH_COMPILE_AHEAD": "false"}


def describe_readiness(url):
    """What a server says that it waits for; an empty string before it listens."""
    try:
        return httpx.get(f"{url}/readyz").json().get("detail", "")
    except httpx.TransportError:
        return ""


def test_what_is_installed_solves_a_problem_in_an_empty_folder(installed, outside, tmp_path):
    folder = tmp_path / "empty"
    folder.mkdir()
    # Another program's module of this name does not matter.
    (folder / "service.py").write_text("raise RuntimeError('a module of the folder in which the service starts')")
    (tmp_path / "home").mkdir()
    announced, log = tmp_path / "announced", tmp_path / "log"
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        url = f"http://127.0.0.1:{free.getsockname()[1]}"
    outside = {**outside, "MECHSYNTH_PORT": url.rpartition(":")[2]}
    with announced.open("wb") as out, log.open("wb") as err:
        server = subprocess.Popen([installed / "mechsynth", "serve"], cwd=folder, env=outside, stdout=out, stderr=err)
    try:
        until(lambda: "kernels are being compiled" in describe_readiness(url), 200.0)
        until(lambda: "ready on" in announced.read_text(), 400.0)
        assert "numerical kernels are not compiled yet" in log.read_text()
        (health,) = (rest for word, rest in read_stage(-1) if word == "HEALTHCHECK")
        checking = {**outside, "PATH": f"{installed}:{outside['PATH']}"}
        run("sh", "-c", health.partition(" CMD ")[2], env=checking)
        with Client(url) as client:
            job = client.solve(client.problems()["motion"]["example"])
            drawing = client.file(job.id, 0, "svg")
            assert client.analyse({"type": "fourbar", **FOURBAR}, {"steps": 12})["valid"]
        assert job.result["designs"][0]["verification"]["passed"]
        assert drawing.startswith(b"<")
        page = httpx.get(url)
        assert "<title>" in page.text
        for name in ("studio.bundle.js", "studio.css"):
            (address,) = re.findall(rf'"(/studio/{re.escape(name)}[^"]*)"', page.text)
            assert httpx.get(f"{url}{address}").status_code == 200
    finally:
        server.terminate()
        assert server.wait(60) == 0
    assert {path.name for path in folder.iterdir()} == {"service.py", "var"}
    assert [*(tmp_path / "home").rglob("*.nbi")]
    assert not [*installed.parent.rglob("mechsynth*/**/*.nbi"), *installed.parent.rglob("kinematics/**/*.nbi")]


def test_starts_and_licence_are_in_the_wheel(installed, outside):
    assert int(run(installed / "python", "-c", STARTS, env=outside)) > 1000
    (licence,) = installed.parent.rglob("mechsynth-*.dist-info/licenses/LICENSE")
    assert licence.read_text().startswith("MIT License")


def test_the_library_is_in_the_wheel_with_its_types(installed, outside, tmp_path):
    program = (
        "from mechsynth import GearTrain, solve\n"
        "design = solve(GearTrain(ratio='7/3', max_stages=1)).designs[0]\n"
        "print(design.to_svg('train.svg').read_text()[:4], len(design.motion(12)))\n"
    )
    assert run(installed / "python", "-c", program, cwd=tmp_path, env=outside).split() == ["<svg", "13"]
    for package in ("kinematics", "synthesis", "service", "mechsynth"):
        assert [*installed.parent.glob(f"lib/python*/site-packages/{package}/py.typed")]


def test_no_part_of_the_tests_is_in_the_wheel(installed):
    packages = {path.parent.name for path in installed.parent.glob("lib/python*/site-packages/*/__init__.py")}
    assert packages >= {"kinematics", "synthesis", "service", "mechsynth"}
    assert not packages & {"tests", "benchmarks", "tools"}
