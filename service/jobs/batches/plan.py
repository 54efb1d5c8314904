"""The plan of a batch: a problem, the fields of it that are varied, and the values that they have in each sample."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from service.jobs.batches.values import Values, read, written


class NoSuchPlace(LookupError):
    """A pointer leads nowhere; the message says why, in a sentence."""


@dataclass(frozen=True)
class Plan:
    """What a batch is made of. All that is written of it is JSON.

    Attributes
    ----------
    problem : dict
        The statement that is varied.
    fields : sequence of str
        JSON pointers into it.
    values : sequence of sequences
        The values of each field: all combinations of them in a grid, otherwise one of each for every sample.
    grid : bool
        Whether it is one. The last field varies fastest.
    metrics : sequence of str
        What of the best design is noted, by the names of its metrics.
    reuse : bool
        Whether answers of equal problems are taken from the store.
    """

    problem: Mapping[str, Any]
    fields: Sequence[str]
    values: Sequence[Values]
    grid: bool
    metrics: Sequence[str]
    reuse: bool

    @property
    def total(self) -> int:
        """How many samples there are."""
        return math.prod(map(len, self.values)) if self.grid else len(self.values[0])

    def sample(self, number: int) -> list[Any]:
        """The values of the fields in a sample."""
        if not self.grid:
            return [values[number] for values in self.values]
        chosen = []
        for values in reversed(self.values):
            number, place = divmod(number, len(values))
            chosen.append(values[place])
        return chosen[::-1]

    def statement(self, number: int) -> Any:
        """The statement of a sample, as a client would post it."""
        return self.stated(self.sample(number))

    def stated(self, values: Values) -> Any:
        """The problem with these values of the fields.

        Raises
        ------
        NoSuchPlace
            Where a pointer leads nowhere.
        """
        statement: Any = self.problem
        for steps, value in zip(self._steps, values, strict=True):
            statement = _with(statement, steps, value)
        return statement

    @cached_property
    def _steps(self) -> list[list[str]]:
        return [steps(field) for field in self.fields]

    def stated_as_json(self) -> str:
        """What is shown of the plan, as an object in JSON: all but the values, of which there may be very many."""
        return _as_json({name: getattr(self, name) for name in _SHOWN})

    def values_as_json(self) -> str:
        """The values in JSON, for :meth:`read`."""
        return _as_json({"grid": self.grid, "values": [written(values) for values in self.values]})

    @classmethod
    def read(cls, stated: str, values: str) -> Plan:
        """The plan of which :meth:`stated_as_json` and :meth:`values_as_json` have written these."""
        varied = json.loads(values)
        return cls(**json.loads(stated), grid=varied["grid"], values=[read(each) for each in varied["values"]])


_SHOWN = ("problem", "fields", "metrics", "reuse")


def _as_json(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"))


def steps(pointer: str) -> list[str]:
    """The steps of a JSON pointer that begins with a slash."""
    return [step.replace("~1", "/").replace("~0", "~") for step in pointer.split("/")[1:]]


def _with(value: Any, way: Sequence[str], new: Any) -> Any:
    """A copy of ``value`` with something new at the end of the way; objects that are missing on it are made."""
    if not way:
        return new
    step, *rest = way
    if isinstance(value, dict):
        return {**value, step: _with(value.get(step, {} if rest else None), rest, new)}
    if isinstance(value, list):
        if not (step.isascii() and step.isdecimal() and str(int(step[:9])) == step):
            raise NoSuchPlace(f"{step[:100]!r} is no place in a list; count from 0.")
        if int(step) >= len(value):
            raise NoSuchPlace(f"The list there has {len(value)} elements; {step} is none of them.")
        place = int(step)
        return [*value[:place], _with(value[place], rest, new), *value[place + 1 :]]
    raise NoSuchPlace(f"What is stated before {step[:100]!r} has no fields.")
