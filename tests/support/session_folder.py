"""A folder that all processes of a test session share: for what one of them makes and the others read.

The process that starts the session creates it and removes it; the others inherit its path in the environment.
"""

from __future__ import annotations

import json
import os
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
    place = Path(os.environ[VARIABLE]) / f"{name}.json" if VARIABLE in os.environ else None
    if place is not None and place.exists():
        return json.loads(place.read_text("utf-8"))
    value = build()
    if place is not None:
        scratch = place.with_suffix(f".{os.getpid()}")
        scratch.write_text(json.dumps(value), "utf-8")
        scratch.replace(place)
    return value
