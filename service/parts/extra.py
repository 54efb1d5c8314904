"""Whether the libraries of the extra ``cad`` are there."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec


@cache
def installed() -> bool:
    """Whether solids can be made; nothing is imported."""
    return find_spec("build123d") is not None and find_spec("OCP") is not None
