"""The values that a field has in the samples, and how the store has them.

Lists are JSON. Ten thousand numbers that were drawn, or as many times one of a few large objects, would be megabytes of
it, and reading them again would take longer than solving some problems; they are arrays of numbers, written in base64.
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
    """Some of few values, each any number of times: the one at ``places[n]`` is the ``n``-th.

    Attributes
    ----------
    among : sequence
        The values.
    places : array of type H
        Numbers of values, from 0.
    """

    among: Sequence[Any]
    places: array[int]

    def __len__(self) -> int:
        return len(self.places)

    def __getitem__(self, number: Any) -> Any:
        return self.among[self.places[number]]


def written(values: Values) -> Any:
    """Values as JSON-like data for :func:`read`: lists as they are, arrays of doubles and what is picked in base64."""
    if isinstance(values, Picked):
        return {"among": values.among, "places": _text(values.places)}
    return {"doubles": _text(values)} if isinstance(values, array) else values


def read(data: Any) -> Values:
    """The values of which :func:`written` has made this."""
    if isinstance(data, list):
        return data
    return _array("d", data["doubles"]) if "doubles" in data else Picked(data["among"], _array("H", data["places"]))


def _text(numbers: array[Any]) -> str:
    return b64encode(numbers.tobytes()).decode()


def _array(type_: str, text: str) -> array[Any]:
    numbers: array[Any] = array(type_)
    numbers.frombytes(b64decode(text))
    return numbers
