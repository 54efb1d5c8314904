"""Values of a varied field in the samples, and their stored form.

Lists are stored as JSON. Ten thousand random numbers, or references to a few large objects, would be megabytes of JSON,
and parsing those would take longer than solving some problems. They are arrays of numbers, stored in base64.
"""

from __future__ import annotations

from array import array
from base64 import b64decode, b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

Values = Sequence[Any]


@dataclass(frozen=True)
class Picked(Sequence[Any]):
    """A sequence of repeated values: the ``n``-th element is the value at index ``places[n]``.

    Attributes
    ----------
    among : sequence
        The distinct values.
    places : array of type H
        Indices into ``among``, from 0.
    """

    among: Sequence[Any]
    places: array[int]

    def __len__(self) -> int:
        return len(self.places)

    def __getitem__(self, number: Any) -> Any:
        return self.among[self.places[number]]


def written(values: Values) -> Any:
    """Encode values as JSON-like data for :func:`read`: lists unchanged, arrays and picked values in base64."""
    if isinstance(values, Picked):
        return {"among": values.among, "places": _text(values.places)}
    return {"doubles": _text(values)} if isinstance(values, array) else values


def read(data: Any) -> Values:
    """Decode values that :func:`written` has encoded."""
    if isinstance(data, list):
        return data
    return _array("d", data["doubles"]) if "doubles" in data else Picked(data["among"], _array("H", data["places"]))


def _text(numbers: array[Any]) -> str:
    return b64encode(numbers.tobytes()).decode()


def _array(type_: str, text: str) -> array[Any]:
    numbers: array[Any] = array(type_)
    numbers.frombytes(b64decode(text))
    return numbers
