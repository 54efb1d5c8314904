"""Errors for invalid calls.

A result that does not exist is no error: a mechanism that cannot be assembled has ``valid`` False.

The texts are messages. Searches raise and catch many of these errors, so an error carries the id and the values of its
message, and the text is composed when somebody reads it.

::

    MechanismError
    ├── DimensionError (also ValueError)   a link length, ratio or count that no mechanism can have
    └── ShapeError     (also ValueError)   arrays that do not broadcast to one batch
"""

from __future__ import annotations

from kinematics.message import compose

ID_PREFIX = "kinematics-"
"""Beginning of the ids of this package's messages, which distinguishes them from texts."""


class MechanismError(Exception):
    """Base of all errors that the analysis core raises.

    Parameters
    ----------
    detail : str
        Id of a message of this package, or a text.
    **values : str or int
        Values of the message.
    """

    def __init__(self, detail: str, /, **values: str | int) -> None:
        super().__init__(detail)
        self._detail = detail
        self._values = values

    def __str__(self) -> str:
        return _write(self._detail, self._values)


class DimensionError(MechanismError, ValueError):
    """A dimension that no mechanism can have, with its name and value.

    Parameters
    ----------
    name : str
        Name of the dimension: that of a field, or the id of a message.
    expected : str
        Id of the message that completes "must be", or a text.
    value : object
        Value that was given.
    **values : str or int
        Values of the messages.
    """

    def __init__(self, name: str, expected: str, value: object, /, **values: str | int) -> None:
        super().__init__(expected, **values)
        self.name = name
        self.value = value
        # Arguments with which pickle creates a copy; it copies the values as attributes.
        self.args = name, expected, value

    def __str__(self) -> str:
        return compose(
            "kinematics-dimension-required",
            name=_write(self.name, self._values),
            expected=_write(self._detail, self._values),
            value=repr(self.value),
        )


class ShapeError(MechanismError, ValueError):
    """Arrays that do not broadcast to one batch, with their shapes."""

    def __init__(self, **shapes: tuple[int, ...]) -> None:
        self.shapes = shapes
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        super().__init__(f"expected arrays that broadcast to one batch of designs, got {listed}")


def _write(text: str, values: dict[str, str | int]) -> str:
    return compose(text, **values) if text.startswith(ID_PREFIX) else text
