"""What is installed for whom: the lock, and the lines of the container file, since not every machine can build it."""

import re
import tomllib
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name

from tests.support.container_file import CONTAINER, is_let_through, read_instructions, read_stage

ROOT = Path(__file__).parents[1]
SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
PIN = re.compile(
    r"^([a-z0-9-]+)==(\S+)(?: ; [^\n]*)? \\\n(?:    --hash=sha256:[0-9a-f]{64}(?: \\)?\n)+    # via", re.MULTILINE
)
LOCK = (ROOT / "requirements.lock").read_text("utf-8")
PINS = set(PIN.findall(LOCK))
FOR_DEVELOPERS = {"pytest", "mypy", "ruff", "hypothesis", "playwright", "schemathesis", "import-linter", "uv"}
INSTRUCTIONS = read_instructions()
FINAL = read_stage(-1)
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


def test_the_container_runs_as_an_ordinary_user_who_cannot_change_the_programs():
    words = [word for word, _ in FINAL]
    users = [rest for word, rest in FINAL if word == "USER"]
    assert len(users) == 1
    assert int(users[0]) > 0
    assert "HEALTHCHECK" in words
    assert ("RUN", "mechsynth warm") in FINAL[words.index("USER") :]
    assert not [rest for word, rest in FINAL if word == "COPY" and "--chown" in rest]
    assert FINAL[-1] == ("CMD", '["mechsynth", "serve"]')


def test_the_container_installs_the_lock_by_its_hashes():
    assert ("ARG", "EXTRAS=") in INSTRUCTIONS
    for word, rest in INSTRUCTIONS:
        for command in rest.split(" && ") if word == "RUN" else []:
            if "pip install" in command:
                assert "--require-hashes" in command or "--no-deps" in command
    assert not [rest for _, rest in FINAL if "pip" in rest or "--group" in rest]
    assert not [rest for word, rest in INSTRUCTIONS if word == "ADD"]


@pytest.mark.parametrize("stage", [rest for word, rest in INSTRUCTIONS if word == "FROM"])
def test_the_containers_base_is_named_by_its_version(stage):
    image = stage.split()[0]
    assert re.fullmatch(r"python:3\.\d+-slim", image)
    python = image.removeprefix("python:").removesuffix("-slim")
    assert python in SpecifierSet(SETTINGS["project"]["requires-python"])
    assert f"Programming Language :: Python :: {python}" in SETTINGS["project"]["classifiers"]


def test_what_the_container_copies_is_there_and_is_let_through():
    assert (ROOT / ".dockerignore").read_text("utf-8").splitlines()[1] == "*"
    copied = [rest for word, rest in INSTRUCTIONS if word == "COPY" and not rest.startswith("--from")]
    for source in [name for rest in copied for name in rest.split()[:-1]]:
        assert (ROOT / source).exists()
        assert is_let_through(source)


def test_the_version_is_the_same_wherever_it_is_named():
    named = SETTINGS["project"]["version"]
    assert f"\nversion: {named}\n" in (ROOT / "CITATION.cff").read_text("utf-8")
    versions = re.findall(r"^## (\d+\.\d+\.\d+)$", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)
    assert versions[0] == named


def test_the_unit_starts_the_program_and_keeps_its_data():
    unit = (CONTAINER.parent / "mechsynth.service").read_text("utf-8")
    settings = dict(re.findall(r"^(\w+)=(.*)$", unit, re.MULTILINE))
    assert settings["ExecStart"].split("/")[-1] == "mechsynth serve"
    assert f"MECHSYNTH_DATA_DIR=/var/lib/{settings['StateDirectory']} " in unit
    assert f"XDG_CACHE_HOME=/var/cache/{settings['CacheDirectory']}\n" in unit
