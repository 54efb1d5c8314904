"""Errors for invalid calls.

A result that does not exist is no error: a mechanism that cannot be assembled has ``valid`` False.

::

    MechanismError
    ├── DimensionError (also ValueError)   a link length, ratio or count that no mechanism can have
    └── ShapeError     (also ValueError)   arrays that do not broadcast to one batch
"""

from __future__ import annotations


class MechanismError(Exception):
    """Base of all errors that the analysis core raises."""


class DimensionError(MechanismError, ValueError):
    """A dimension that no mechanism can have, with its name and value."""

    def __init__(self, name: str, expected: str, value: object) -> None:
        self.name = name
        self.value = value
        super().__init__(f"{name} must be {expected}, got {value!r}")


class ShapeError(MechanismError, ValueError):
    """Arrays that do not broadcast to one batch, with their shapes."""

    def __init__(self, **shapes: tuple[int, ...]) -> None:
        self.shapes = shapes
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        super().__init__(f"expected arrays that broadcast to one batch of designs, got {listed}")
