"""Which problems are the same: by what they mean, and by the version of the solvers that answer them."""

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
"""What the solvers compute with: another version of it may end at other last digits."""

SOURCES = (".py", ".npz")


def digest(problem: ProblemBase) -> str:
    """Equal for problems that have the same answer of the same solvers.

    It goes by what a statement means: the order of its fields, the spelling of its numbers and defaults that are
    written out make no difference.
    """
    stated = problem.model_dump(mode="json", exclude_defaults=True)
    meant = json.dumps([problem.kind, stated], sort_keys=True, separators=(",", ":"))
    return sha256(f"{solvers()}{meant}".encode()).hexdigest()


@cache
def solvers() -> str:
    """The version of the solvers: of their sources, and of the libraries that they compute with."""
    parts = [platform.python_version(), platform.machine(), *(f"{name} {version(name)}" for name in LIBRARIES)]
    told = sha256("\n".join(parts).encode())
    for package in ("kinematics", "synthesis"):
        for name, source in sorted(_sources(files(package), package), key=lambda named: named[0]):
            told.update(f"\n{name}\n".encode())
            told.update(sha256(source.read_bytes()).digest())
    return told.hexdigest()


def _sources(folder: Traversable, name: str) -> list[tuple[str, Traversable]]:
    found = []
    for entry in folder.iterdir():
        place = f"{name}/{entry.name}"
        if entry.is_dir():
            found += _sources(entry, place)
        elif entry.name.endswith(SOURCES):
            found.append((place, entry))
    return found
