"""What is installed for whom: the lock, and the lines of the container file, since not every machine can build it."""

import re
import tomllib
from fnmatch import fnmatch
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]
CONTAINER = ROOT / "docs" / "operations" / "deploy" / "Dockerfile"
SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
PIN = re.compile(
    r"^([a-z0-9-]+)==(\S+)(?: ; [^\n]*)? \\\n(?:    --hash=sha256:[0-9a-f]{64}(?: \\)?\n)+    # via", re.MULTILINE
)
LOCK = (ROOT / "requirements.lock").read_text("utf-8")
PINS = set(PIN.findall(LOCK))
FOR_DEVELOPERS = {"pytest", "mypy", "ruff", "hypothesis", "playwright", "schemathesis", "import-linter", "uv"}
FOR_CLUSTERS = {"psycopg", "opentelemetry-sdk"}

USERS = SETTINGS["project"]["dependencies"]
EXTRAS = SETTINGS["project"]["optional-dependencies"]
GROUPS = SETTINGS["dependency-groups"]


def closure(stated: list[str]) -> set[str]:
    """The packages that requirements bring, with all that these require."""
    found: set[str] = set()
    seen: set[tuple[str, str]] = set()
    waiting = [(Requirement(text), "") for text in stated]
    while waiting:
        requirement, extra = waiting.pop()
        if requirement.marker is not None and not requirement.marker.evaluate({"extra": extra}):
            continue
        name = canonicalize_name(requirement.name)
        found.add(name)
        for wanted in ("", *requirement.extras):
            if (name, wanted) not in seen:
                seen.add((name, wanted))
                waiting += [(Requirement(text), wanted) for text in requires(name) or []]
    return found


def installed_version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def test_every_package_of_the_lock_has_a_version_and_hashes():
    assert len(re.findall(r"^[a-z0-9]", LOCK, re.MULTILINE)) == len(PIN.findall(LOCK)) > 150
    assert "://" not in LOCK


def test_the_lock_has_the_packages_of_all_extras_and_groups():
    stated = [*USERS, *(text for group in [*EXTRAS.values(), *GROUPS.values()] for text in group)]
    locked = {name for name, _ in PINS}
    assert {canonicalize_name(Requirement(text).name) for text in stated} <= locked


def test_developers_try_the_versions_that_users_get():
    names = closure([*USERS, *EXTRAS["cluster"], *EXTRAS["telemetry"], *GROUPS["dev"]])
    assert {(name, installed_version(name)) for name in names} <= PINS


def test_users_get_nothing_else():
    users = closure(USERS)
    assert not users & (FOR_DEVELOPERS | FOR_CLUSTERS)
    clusters = closure([*USERS, *EXTRAS["cluster"], *EXTRAS["telemetry"]])
    assert not clusters & FOR_DEVELOPERS
    assert clusters >= users | FOR_CLUSTERS


def test_convex_programs_come_with_the_solvers_that_are_called():
    assert closure([*USERS, *GROUPS["dev"]]) & {"cvxpy", "osqp", "scs"} == set()
    assert closure(USERS) >= {"cvxpy-base", "clarabel", "highspy"}


def test_packages_whose_private_parts_are_used_are_bounded_above():
    for package in ("numba", "pebble", "uvicorn"):
        (bounds,) = (each for each in USERS if re.match(rf"{package}\b", each))
        assert "<" in bounds


def instructions() -> list[tuple[str, str]]:
    lines = re.sub(r"^#.*\n", "", CONTAINER.read_text("utf-8"), flags=re.MULTILINE).replace("\\\n", " ")
    return [(word, rest) for word, _, rest in (line.partition(" ") for line in lines.splitlines()) if word]


def final() -> list[tuple[str, str]]:
    """The instructions of the last stage, which are what the image has."""
    every = instructions()
    return every[max(k for k, (word, _) in enumerate(every) if word == "FROM") :]


def test_the_container_runs_as_an_ordinary_user_who_cannot_change_the_programs():
    words = [word for word, _ in final()]
    users = [rest for word, rest in final() if word == "USER"]
    assert len(users) == 1
    assert users[0] not in ("root", "0")
    assert ("RUN", "mechsynth warm") in final()[words.index("USER") :]
    assert not [rest for word, rest in final() if word == "COPY" and "--chown" in rest]
    assert final()[-1] == ("CMD", '["mechsynth", "serve"]')


def test_the_container_installs_the_lock_by_its_hashes():
    assert ("ARG", "EXTRAS=") in instructions()
    for word, rest in instructions():
        for command in rest.split(" && ") if word == "RUN" else []:
            if "pip install" in command:
                assert "--require-hashes" in command or "--no-deps" in command
    assert not [rest for _, rest in final() if "pip" in rest or "--group" in rest]
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
        assert (ROOT / source).exists()
        assert any(fnmatch(source, pattern) for pattern in let_through)
