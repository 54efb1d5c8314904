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

Values = Sequence[object]


@dataclass(frozen=True)
class PickedValues(Sequence[object]):
    """A sequence of repeated values: the ``n``-th element is the value at index ``places[n]``.

    Attributes
    ----------
    among : sequence
        The distinct values.
    places : array of type H
        Indices into ``among``, from 0.
    """

    among: Sequence[object]
    places: array[int]

    def __len__(self) -> int:
        return len(self.places)

    def __getitem__(self, number: Any) -> Any:
        return self.among[self.places[number]]


def encode_values(values: Values) -> object:
    """Encode values as JSON-like data for :func:`decode_values`: lists unchanged, arrays and picks in base64."""
    if isinstance(values, PickedValues):
        return {"among": values.among, "places": _encode_numbers(values.places)}
    return {"doubles": _encode_numbers(values)} if isinstance(values, array) else values


def decode_values(data: Any) -> Values:
    """Decode values that :func:`encode_values` has encoded."""
    if isinstance(data, list):
        return data
    return (
        _decode_numbers("d", data["doubles"])
        if "doubles" in data
        else PickedValues(data["among"], _decode_numbers("H", data["places"]))
    )


def _encode_numbers(numbers: array[int] | array[float]) -> str:
    return b64encode(numbers.tobytes()).decode()


def _decode_numbers(type_: str, text: str) -> array[Any]:
    numbers: array[int] | array[float] = array(type_)
    numbers.frombytes(b64decode(text))
    return numbers
