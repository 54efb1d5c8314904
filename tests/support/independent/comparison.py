"""Stated values beside those measured here: how far they differ, and what was not compared."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from typing import Any, NamedTuple

from tests.support.independent.quantities import COMPARED, NOT_MEASURED, stated_by

AGREE = 1e-6
"""Difference, relative to the scale of the quantity, up to which two values are the same."""


class Difference(NamedTuple):
    """A quantity, how far it differs relative to its scale, of which design, and both values."""

    metric: str
    value: float
    name: str
    stated: Any = math.nan
    found: Any = math.nan


class Measured:
    """All differences, and what was not compared."""

    def __init__(self) -> None:
        self.differences: dict[str, list[Difference]] = defaultdict(list)
        self.left: Counter[str] = Counter()
        self.without: Counter[str] = Counter()
        self.designs: Counter[str] = Counter()

    def beside(self, kind: str, design: Any, name: str) -> Beside:
        """A design of an answer to a problem of this kind, and what it is called where it differs."""
        self.designs[f"{kind} {design.mechanism.type}"] += 1
        return Beside(self, kind, design, name)

    @property
    def over(self) -> list[Difference]:
        """Differences of more than :data:`AGREE`, the worst first."""
        found = [d for group in self.differences.values() for d in group if not d.value <= AGREE]
        return sorted(found, key=lambda d: -d.value if d.value == d.value else -math.inf)

    def report(self) -> str:
        """A line for each quantity."""
        lines = [f"{count:6d} designs: {name}" for name, count in sorted(self.designs.items())]
        for metric, group in sorted(self.differences.items()):
            worst = max(group, key=lambda d: d.value if d.value == d.value else math.inf)
            over = sum(not d.value <= AGREE for d in group)
            lines.append(f"{metric:52s} {len(group):6d} compared, worst {worst.value:.1e}, {over} over {AGREE:g}")
        lines += [
            f"  over: {d.metric} {d.value:.1e} {d.name}: {d.stated!r} stated, {d.found!r}" for d in self.over[:40]
        ]
        lines += [f"  no measure: {name} ({count})" for name, count in sorted(self.without.items())]
        lines += [f"  not compared: {name} ({count})" for name, count in sorted(self.left.items())]
        compared, worst_of_all = (
            sum(map(len, self.differences.values())),
            max((d.value for d in self._all()), default=0),
        )
        lines.append(
            f"{self.designs.total()} designs, {compared} comparisons of {len(self.differences)} quantities: largest "
            f"difference {worst_of_all:.1e}, {len(self.over)} over {AGREE:g}; {self.left.total()} not compared"
        )
        return "\n".join(lines)

    def _all(self) -> list[Difference]:
        return [d for group in self.differences.values() for d in group]


class Beside:
    """A design beside what is measured of it; quantities have their paths in the design, without indices of lists."""

    def __init__(self, measured: Measured, kind: str, design: Any, name: str) -> None:
        self.measured, self.kind, self.design, self.name = measured, kind, design, name
        self.compared: set[str] = set()

    def add(self, quantity: str, stated: float | None, found: float, scale: float) -> None:
        """Compare a stated value; one that is not stated is not compared."""
        if stated is None:
            return
        self._put(quantity, abs(stated - found) / scale if scale else float(stated != found), stated, found)

    def same(self, quantity: str, stated: Any, found: Any) -> None:
        """Compare what is no number, such as a class: it is the same or not."""
        if stated is not None:
            self._put(quantity, float(stated != found), stated, found)

    def metric(self, name: str, found: float, scale: float) -> None:
        """Compare a number of the metrics that a design may state."""
        self.add(f"metrics.{name}", getattr(self.design.metrics, name, None), found, scale)

    def check(self, name: str, found: float | bool, scale: float = 1.0) -> None:
        """Compare the value of a check, or where it has none whether it passed, if the design has the check."""
        for check in self.design.verification.checks:
            if check.name == name:
                if check.value is None:
                    self.same(f"checks.{name}", check.passed, bool(found))
                else:
                    self.add(f"checks.{name}", check.value, float(found), scale)

    def without(self, quantity: str, why: str) -> None:
        """A quantity that is stated, but has no measure for this design."""
        self.compared.add(quantity)
        self.measured.without[f"{self.kind} {quantity}: {why}"] += 1

    def unmeasured(self, why: str) -> None:
        """The design cannot be measured here at all."""
        self.measured.left[f"{self.kind} {self.design.mechanism.type}: {why} ({self.name})"] += 1
        self.compared = stated_by(self.design)

    def finish(self) -> None:
        """List what the design states and what was not compared, though it is a measure."""
        left = stated_by(self.design) - self.compared - set(NOT_MEASURED)
        self.measured.left.update(f"{self.kind} {self.design.mechanism.type}: {name}" for name in left)

    def _put(self, quantity: str, off: float, stated: Any, found: Any) -> None:
        if quantity not in COMPARED[self.kind]:
            raise ValueError(f"{quantity} of {self.kind} is not listed as compared")
        self.compared.add(quantity)
        metric = f"{self.kind} {quantity}"
        self.measured.differences[metric].append(Difference(metric, off, self.name, stated, found))
