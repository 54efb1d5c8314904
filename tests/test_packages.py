"""What is installed for whom: the locks, and the lines of the container file, since not every machine can build it."""

import re
import tomllib
from fnmatch import fnmatch
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
CONTAINER = ROOT / "docs" / "operations" / "deploy" / "Dockerfile"
PIN = re.compile(r"^([a-z0-9-]+)==(\S+)([^\n]*?) \\\n((?:    --hash=sha256:[0-9a-f]{64}(?: \\)?\n)+)", re.MULTILINE)
FOR_DEVELOPERS = {"pytest", "mypy", "ruff", "hypothesis", "playwright", "schemathesis", "import-linter", "uv"}
FOR_THE_SITE = {"mkdocs", "mkdocs-material", "mkdocstrings-python", "nbclient", "ipykernel"}
FOR_SOLIDS = {"build123d", "cadquery-ocp-novtk"}
FOR_CLUSTERS = {"celery", "psycopg", "redis", "opentelemetry-sdk"}


def lock(name: str) -> dict[tuple[str, str, str], str]:
    """The hashes of each package, by its name, version and condition."""
    pins = PIN.findall((ROOT / name).read_text("utf-8"))
    return {(package, version, condition): hashes.replace(" \\", "") for package, version, condition, hashes in pins}


def packages(name: str) -> set[str]:
    return {package for package, _, _ in lock(name)}


USERS, CLUSTERS, DEVELOPERS, SITE = (lock(f"requirements{name}.lock") for name in ("", "-cluster", "-dev", "-docs"))


def test_users_get_the_packages_that_developers_have_tried():
    assert USERS.items() <= CLUSTERS.items() <= DEVELOPERS.items()


def test_users_get_nothing_else():
    assert not packages("requirements.lock") & (FOR_DEVELOPERS | FOR_CLUSTERS)
    assert not packages("requirements-cluster.lock") & FOR_DEVELOPERS
    assert packages("requirements-cluster.lock") >= FOR_CLUSTERS
    assert packages("requirements-dev.lock") >= FOR_DEVELOPERS | {"setuptools"}


def test_the_site_is_made_with_the_versions_that_developers_have_and_packages_of_its_own():
    assert packages("requirements-docs.lock") >= packages("requirements.lock") | FOR_THE_SITE
    assert not packages("requirements-dev.lock") & FOR_THE_SITE
    versions = {(package, version) for package, version, _ in DEVELOPERS}
    shared = {(package, version) for package, version, _ in SITE if package in packages("requirements-dev.lock")}
    assert shared <= versions


def test_solids_are_made_with_the_versions_that_developers_have_and_packages_of_their_own():
    assert packages("requirements-cad.lock") >= packages("requirements.lock") | FOR_SOLIDS
    assert not packages("requirements-dev.lock") & FOR_SOLIDS
    solids = {(package, version) for package, version, _ in lock("requirements-cad.lock")}
    known = {(package, version) for package, version, _ in DEVELOPERS}
    assert {one for one in solids if one[0] in packages("requirements-dev.lock")} <= known


def test_convex_programs_come_with_the_solvers_that_are_called():
    assert packages("requirements-dev.lock") & {"cvxpy", "osqp", "scs"} == set()
    assert packages("requirements.lock") >= {"cvxpy-base", "clarabel", "highspy"}


def test_packages_whose_private_parts_are_used_are_bounded_above():
    stated = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    for package in ("numba", "pebble", "uvicorn"):
        (bounds,) = (each for each in stated["dependencies"] if re.match(rf"{package}\b", each))
        assert "<" in bounds


def instructions() -> list[tuple[str, str]]:
    lines = re.sub(r"^#.*\n", "", CONTAINER.read_text("utf-8"), flags=re.MULTILINE).replace("\\\n", " ")
    return [(word, rest) for word, _, rest in (line.partition(" ") for line in lines.splitlines()) if word]


def final() -> list[tuple[str, str]]:
    """The instructions of the last stage, which are what the image has."""
    every = instructions()
    return every[max(k for k, (word, _) in enumerate(every) if word == "FROM") :]


def test_the_container_runs_as_an_ordinary_user_from_before_anything_is_installed():
    words = [word for word, _ in final()]
    users = [rest for word, rest in final() if word == "USER"]
    assert len(users) == 1
    assert users[0] not in ("root", "0")
    first_installed = next(k for k, (_, rest) in enumerate(final()) if "pip install" in rest)
    assert words.index("USER") < first_installed
    assert final()[-1] == ("CMD", '["mechsynth", "serve"]')


def test_the_container_installs_the_users_lock_by_its_hashes():
    assert ("ARG", "LOCK=requirements.lock") in final()
    for word, rest in instructions():
        if word == "RUN" and "pip install" in rest:
            assert "--no-cache-dir" in rest
            assert "--require-hashes" in rest or "--no-deps" in rest
    assert not [rest for word, rest in final() if "requirements-dev" in rest]
    assert not [rest for word, rest in instructions() if word == "ADD"]


@pytest.mark.parametrize("stage", [rest for word, rest in instructions() if word == "FROM"])
def test_the_containers_base_is_named_by_its_version(stage):
    image = stage.split()[0]
    assert re.fullmatch(r"python:3\.1[123]-slim", image)


def test_what_the_container_copies_is_there_and_is_let_through():
    patterns = (ROOT / ".dockerignore").read_text("utf-8").splitlines()
    assert patterns[1] == "*"
    let_through = [line[1:] for line in patterns if line.startswith("!")]
    copied = [rest for word, rest in instructions() if word == "COPY" and not rest.startswith("--from")]
    for source in [name for rest in copied for name in rest.split()[:-1]]:
        for name in ["requirements.lock", "requirements-cluster.lock"] if source == "${LOCK}" else [source]:
            assert (ROOT / name).exists()
            assert any(fnmatch(name, pattern) for pattern in let_through)
