"""Test for the libraries of the extra ``cad``."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec


@cache
def is_installed() -> bool:
    """Return whether solids can be made; this imports nothing."""
    return find_spec("build123d") is not None and find_spec("OCP") is not None
