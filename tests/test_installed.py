"""The wheel, installed into a virtual environment, works in an empty folder and leaves the packages as they are."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from service.client import Client
from tests.support.service.running import until

ROOT = Path(__file__).parents[1]
PROJECT = ("kinematics", "synthesis", "service", "mechsynth", "pyproject.toml", "README.md", "LICENSE")
STARTS = (
    "from synthesis.kinds.path.exact.continuation_starts import load_nine_point_start as start; print(len(start().y))"
)

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(900)]


def run(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, text=True, **options).stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    """Built of a copy of the sources, since building writes beside them."""
    folder = tmp_path_factory.mktemp("sources")
    for name in PROJECT:
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        copy(ROOT / name, folder / name)
    pip = (getattr(sys, "_base_executable", sys.executable), "-m", "pip", "--python", sys.executable)
    run(*pip, "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", folder / "dist", folder)
    (built,) = (folder / "dist").glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(tmp_path_factory, wheel) -> Path:
    """The programs of an environment with the users' packages and the wheel, and nothing else."""
    environment = tmp_path_factory.mktemp("installed") / "environment"
    run(sys.executable, "-m", "venv", "--without-pip", environment)
    uv = (Path(sys.executable).with_name("uv"), "pip", "install", "--python", environment / "bin" / "python")
    locked = ("--require-hashes", "--constraints", ROOT / "requirements.lock")
    run(*uv, "--quiet", *locked, "-r", ROOT / "pyproject.toml")
    run(*uv, "--quiet", "--no-deps", wheel)
    return environment / "bin"


@pytest.fixture
def outside(tmp_path) -> dict[str, str]:
    """An environment in which nothing points to the checkout or to other caches."""
    kept = {key: os.environ[key] for key in ("PATH", "LANG", "TZ") if key in os.environ}
    return {**kept, "HOME": str(tmp_path / "home"), "MECHSYNTH_PORT": "0", "MECHSYNTH_COMPILE_AHEAD": "false"}


def test_what_is_installed_solves_a_problem_in_an_empty_folder(installed, outside, tmp_path):
    folder = tmp_path / "empty"
    folder.mkdir()
    (tmp_path / "home").mkdir()
    announced = tmp_path / "announced"
    with announced.open("wb") as out:
        server = subprocess.Popen([installed / "mechsynth", "serve"], cwd=folder, env=outside, stdout=out)
    try:
        url = until(lambda: "ready on" in announced.read_text() and announced.read_text().split()[-1], 400.0)
        with Client(url) as client:
            job = client.solve(client.problems()["motion"]["example"])
            drawing = client.file(job.id, 0, "svg")
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
    assert {path.name for path in folder.iterdir()} == {"var"}
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
