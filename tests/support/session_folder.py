"""A folder that all processes of a test session share: for what one of them makes and the others read.

The process that starts the session creates it and removes it; the others inherit its path in the environment.
"""

from __future__ import annotations

import json
import os
import pickle
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

VARIABLE = "TEST_SESSION_FOLDER"


def create() -> Callable[[], None]:
    """Create the folder unless another process of the session has, and return the function that removes it."""
    if VARIABLE in os.environ:
        return lambda: None
    folder = os.environ[VARIABLE] = tempfile.mkdtemp(prefix="mechsynth-tests-")

    def remove() -> None:
        os.environ.pop(VARIABLE, None)
        shutil.rmtree(folder, ignore_errors=True)

    return remove


def read_or_build(name: str, build: Callable[[], Any]) -> Any:
    """Return a JSON value that is built once in a session.

    Processes that ask at the same time build it each; all of them write the same.
    """
    place = _find_place(f"{name}.json")
    if place is not None and place.exists():
        return json.loads(place.read_bytes())
    value = build()
    if place is not None:
        _write(place, json.dumps(value).encode())
    return value


def read_pickle(name: str) -> Any | None:
    """Return what another process of the session has kept by this name, or None."""
    place = _find_place(f"{name}.pickle")
    return pickle.loads(place.read_bytes()) if place is not None and place.exists() else None


def keep_pickle(name: str, value: object) -> None:
    """Keep a value for other processes of the session."""
    place = _find_place(f"{name}.pickle")
    if place is not None:
        _write(place, pickle.dumps(value))


def append_line(name: str, line: str) -> None:
    """Append a line to what other processes of the session read by this name."""
    place = _find_place(name)
    if place is not None:
        with place.open("a") as file:
            file.write(f"{line}\n")


def read_lines(name: str) -> list[str]:
    """Return the lines that all processes of the session have appended by this name."""
    place = _find_place(name)
    return place.read_text().splitlines() if place is not None and place.exists() else []


def _find_place(name: str) -> Path | None:
    """Return the path of a file in the folder; None outside a session."""
    return Path(os.environ[VARIABLE]) / name if VARIABLE in os.environ else None


def _write(place: Path, content: bytes) -> None:
    """Write a file at once, so that nobody reads a part of it."""
    scratch = place.with_suffix(f".{os.getpid()}")
    scratch.write_bytes(content)
    scratch.replace(place)
