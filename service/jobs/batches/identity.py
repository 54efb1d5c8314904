"""Identity of problems: equal content, answered by the same version of the solvers."""

from __future__ import annotations

import json
import platform
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from synthesis.model.problem import ProblemBase

LIBRARIES = ("numpy", "scipy", "numba", "cvxpy-base", "clarabel", "highspy", "pydantic")
"""Libraries that the solvers compute with; another version may change the last digits of an answer."""

SOURCE_SUFFIXES = (".py", ".npz")


def hash_problem(problem: ProblemBase) -> str:
    """Return a hash that is equal for problems to which the same solvers give the same answer.

    The order of fields, the spelling of numbers and explicitly written defaults make no difference.
    """
    content = problem.model_dump(mode="json", exclude_defaults=True)
    statement = json.dumps([problem.kind, content], sort_keys=True, separators=(",", ":"))
    return sha256(f"{hash_solvers()}{statement}".encode()).hexdigest()


@cache
def hash_solvers() -> str:
    """Return a hash of the solvers' sources and of the versions of the libraries they compute with."""
    parts = [platform.python_version(), platform.machine(), *(f"{name} {version(name)}" for name in LIBRARIES)]
    source_hash = sha256("\n".join(parts).encode())
    for package in ("kinematics", "synthesis"):
        # Sorted, because the order of a folder's entries differs between file systems.
        for name, source in sorted(_list_sources(files(package), package), key=lambda named: named[0]):
            source_hash.update(f"\n{name}\n".encode())
            source_hash.update(sha256(source.read_bytes()).digest())
    return source_hash.hexdigest()


def _list_sources(folder: Traversable, name: str) -> list[tuple[str, Traversable]]:
    found = []
    for entry in folder.iterdir():
        place = f"{name}/{entry.name}"
        if entry.is_dir():
            found += _list_sources(entry, place)
        elif entry.name.endswith(SOURCE_SUFFIXES):
            found.append((place, entry))
    return found
