"""The plan of a batch: a problem, its varied fields, and their values in each sample."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from kinematics.message import compose
from service.jobs.batches.values import Values, decode_values, encode_values
from synthesis.model.json_object import JsonObject


class NoSuchPlace(LookupError):
    """A pointer that leads nowhere; the message is a sentence with the reason."""


@dataclass(frozen=True)
class Plan:
    """Definition of all samples of a batch; it is stored as JSON.

    Attributes
    ----------
    problem : dict
        The problem whose fields are varied.
    fields : sequence of str
        JSON pointers into the problem, one for each varied field.
    values : sequence of sequences
        The values of each field. In a grid the samples are all combinations of them. Otherwise each field has one value
        for every sample.
    grid : bool
        Whether the samples are a grid, in which the last field varies fastest.
    metrics : sequence of str
        Names of the metrics of the best design that the table shows.
    reuse : bool
        Whether stored answers to equal problems are reused.
    """

    problem: JsonObject
    fields: Sequence[str]
    values: Sequence[Values]
    grid: bool
    metrics: Sequence[str]
    reuse: bool

    @property
    def total(self) -> int:
        """Number of samples."""
        return math.prod(map(len, self.values)) if self.grid else len(self.values[0])

    def sample(self, number: int) -> list[object]:
        """Return the values of the varied fields in a sample."""
        if not self.grid:
            return [values[number] for values in self.values]
        chosen = []
        # Mixed-radix digits of the number, last field first, since that one varies fastest.
        for values in reversed(self.values):
            number, place = divmod(number, len(values))
            chosen.append(values[place])
        return chosen[::-1]

    def build_statement(self, number: int) -> object:
        """Return the problem of a sample as a client would post it."""
        return self.fill_statement(self.sample(number))

    def fill_statement(self, values: Values) -> object:
        """Return the problem with these values of the varied fields.

        Raises
        ------
        NoSuchPlace
            If a pointer leads nowhere.
        """
        statement: object = self.problem
        for steps, value in zip(self._steps, values, strict=True):
            statement = _copy_with(statement, steps, value)
        return statement

    @cached_property
    def _steps(self) -> list[list[str]]:
        return [split_pointer(field) for field in self.fields]

    def dump_statement(self) -> str:
        """Return the part of the plan that the API shows, a JSON object: all but the values, which may be very many."""
        return _as_json({name: getattr(self, name) for name in _SHOWN_FIELDS})

    def dump_values(self) -> str:
        """Return the values as JSON for :meth:`decode_values`."""
        return _as_json({"grid": self.grid, "values": [encode_values(values) for values in self.values]})

    @classmethod
    def read(cls, statement_json: str, values: str) -> Plan:
        """Rebuild a plan from the output of :meth:`dump_statement` and :meth:`dump_values`."""
        varied = json.loads(values)
        return cls(
            **json.loads(statement_json), grid=varied["grid"], values=[decode_values(each) for each in varied["values"]]
        )


_SHOWN_FIELDS = ("problem", "fields", "metrics", "reuse")


def _as_json(value: object) -> str:
    return json.dumps(value, separators=(",", ":"))


def split_pointer(pointer: str) -> list[str]:
    """Split a JSON pointer that begins with a slash into its steps."""
    # "~1" before "~0": the other order would turn "~01" into a slash (RFC 6901, section 4).
    return [step.replace("~1", "/").replace("~0", "~") for step in pointer.split("/")[1:]]


def _copy_with(value: object, way: Sequence[str], new: object) -> object:
    """Return a copy of ``value`` with ``new`` at the end of the path ``way``; missing objects are created."""
    if not way:
        return new
    step, *rest = way
    if isinstance(value, dict):
        return {**value, step: _copy_with(value.get(step, {} if rest else None), rest, new)}
    if isinstance(value, list):
        # At most nine digits are converted: int() of a very long text takes time by the square of its length.
        if not (step.isascii() and step.isdecimal() and str(int(step[:9])) == step):
            raise NoSuchPlace(compose("service-index-expected", step=f"{step[:100]!r}"))
        if int(step) >= len(value):
            raise NoSuchPlace(compose("service-element-missing", index=step, length=str(len(value))))
        place = int(step)
        return [*value[:place], _copy_with(value[place], rest, new), *value[place + 1 :]]
    raise NoSuchPlace(compose("service-place-without-members", step=f"{step[:100]!r}"))
