"""Numbers from the literature, and what the tests compare with them. The format is described in ``README.md``."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

HERE = Path(__file__).parent

DECIMAL = 1e-9
"""Share of a value by which a decimal tolerance may be missed: 28.5 − 28.4 is not 0.1 in binary."""


@dataclass(frozen=True)
class Expected:
    """One value that a source gives. ``tolerance`` is None for words, which must be equal."""

    value: Any
    tolerance: float | None
    modulo_360: bool = False

    def agrees(self, found: Any) -> bool:
        """Whether a computed value (or list of values) is the expected one within the printed precision."""
        return self._agree(found, self.value)

    def _agree(self, found: Any, value: Any) -> bool:
        if isinstance(value, list):
            return len(found) == len(value) and all(self._agree(f, v) for f, v in zip(found, value, strict=True))
        return self._near(found, value)

    def _near(self, found: Any, value: Any) -> bool:
        if self.tolerance is None or isinstance(value, str | bool):
            return bool(found == value)
        difference = float(found) - float(value)
        if self.modulo_360:
            difference = math.remainder(difference, 360.0)
        return abs(difference) <= self.tolerance + DECIMAL * abs(float(value))


@dataclass(frozen=True)
class Case:
    """One row: a source, what goes in and what must come out. ``inputs`` is None where the source has a figure only."""

    id: str
    kind: str
    source: str
    status: str
    note: str
    inputs: dict[str, Any] | None
    expected: dict[str, Expected]

    def check(self, **found: Any) -> None:
        """Compare every expected value with the computed one of the same name."""
        found |= {f"{name}[{k}]": v for name, values in found.items() if _listed(values) for k, v in enumerate(values)}
        missing = self.expected.keys() - found.keys()
        assert not missing, f"{self.id}: not computed: {sorted(missing)}"
        wrong = {
            name: (found[name], expected.value, expected.tolerance)
            for name, expected in self.expected.items()
            if not expected.agrees(found[name])
        }
        assert not wrong, f"{self.id} ({self.source}): found, expected, tolerance: {wrong}"


def _listed(values: Any) -> bool:
    return isinstance(values, list | tuple) or (isinstance(values, np.ndarray) and values.ndim > 0)


@cache
def load(file: str = "linkage") -> tuple[Case, ...]:
    """All rows of one file."""
    rows = json.loads((HERE / f"{file}.json").read_text(encoding="utf-8"))
    return tuple(_case(row) for row in rows)


def cases(kind: str, file: str = "linkage") -> list[Any]:
    """Rows of one kind that can be evaluated, as pytest parameters named after their ids."""
    found = [pytest.param(case, id=case.id) for case in load(file) if case.kind == kind and case.inputs is not None]
    assert found, f"no case of kind {kind!r} in {file}.json"
    return found


@cache
def search_tasks(n: int = 3) -> tuple[dict[str, Any], ...]:
    """The tasks of ``search_n_positions.json``: ``id``, and ``positions`` of x, y, angle; for five also ``planted``."""
    return tuple(json.loads((HERE / f"search_{n}_positions.json").read_text(encoding="utf-8")))


def _gear_case(row: dict[str, Any]) -> Case:
    expected = {
        name: Expected(value.get("likely", value["value"]), value.get("tol_likely", value["tol"]))
        for name, value in row["expected"].items()
    }
    inputs = row["inputs"] if "op" in row else None
    return Case(row["id"], row.get("op", row["kind"]), row["source"], row["status"], row["note"], inputs, expected)


def _cam_case(row: dict[str, Any]) -> Case:
    inputs = dict(row["inputs"])
    values = row.get("oracle", row["expected"])
    expected = {}
    for name, value in values.items():
        if isinstance(value, list):
            limits = row["tolerance"][name]
            limits = limits if isinstance(limits, list) else [limits] * len(value)
            legible = [k for k, printed in enumerate(row["expected"][name]) if printed is not None]
            expected |= {f"{name}[{k}]": Expected(value[k], limits[k]) for k in legible}
        else:
            expected[name] = Expected(value, row["tolerance"][name])
    return Case(row["id"], inputs.pop("task"), row["source"], row["status"], row["note"], inputs, expected)


def _dynamics_case(row: dict[str, Any]) -> Case:
    expected = {
        name: Expected(
            value.get("likely", value["value"]), value.get("tol_likely", value["tol"]), value.get("modulo_360", False)
        )
        for name, value in row["expected"].items()
        if value["status"] != "unverifiable"
    }
    return Case(row["id"], row["kind"], row["source"], row["status"], row["note"], row["inputs"], expected)


def _case(row: dict[str, Any]) -> Case:
    if "given" in row:
        return _dynamics_case(row)
    if "task" in row.get("inputs", {}):
        return _cam_case(row)
    if "tolerance" not in row:
        return _gear_case(row)
    suspect = row.get("suspect_fields", {})
    tolerance, modulo = row["tolerance"], row.get("modulo_360", [])
    expected = {}
    for name, value in row["expected"].items():
        doubted = suspect.get(name, {})
        limit = doubted.get("tolerance", tolerance.get(name))
        expected[name] = Expected(doubted.get("likely", value), limit, name in modulo)
    return Case(row["id"], row["kind"], row["source"], row["status"], row["note"], row.get("inputs"), expected)
