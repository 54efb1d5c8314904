"""Stated values beside those measured here: how far they differ, and what was not compared."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from typing import Any, NamedTuple

AGREE = 1e-6
"""Difference, relative to the scale of the quantity, up to which two values are the same."""


class Difference(NamedTuple):
    """A quantity, how far it differs relative to its scale, of which design, and both values."""

    metric: str
    value: float
    name: str
    stated: float = math.nan
    found: float = math.nan


class Measured:
    """All differences, and what was not compared."""

    def __init__(self) -> None:
        self.differences: dict[str, list[Difference]] = defaultdict(list)
        self.left: Counter[str] = Counter()

    def add(self, metric: str, stated: float | None, found: float, scale: float, name: str) -> None:
        """Compare a stated value; one that is not stated is not compared."""
        if stated is not None:
            off = abs(stated - found) / scale
            self.differences[metric].append(Difference(metric, off, name, stated, found))

    def leave(self, design: Any, compared: set[str]) -> None:
        """List the metrics and checks of a design that were not compared."""
        stated = {name for name, value in design.metrics.model_dump().items() if isinstance(value, float)}
        stated |= {f"check {c.name}" for c in design.verification.checks if c.value is not None}
        self.left.update(f"{design.mechanism.type}: {name}" for name in stated - compared)

    @property
    def over(self) -> list[Difference]:
        """Differences of more than :data:`AGREE`, the worst first."""
        found = [d for group in self.differences.values() for d in group if not d.value <= AGREE]
        return sorted(found, key=lambda d: -d.value if d.value == d.value else -math.inf)

    def report(self) -> str:
        """A line for each quantity."""
        lines = []
        for metric, group in sorted(self.differences.items()):
            worst = max(group, key=lambda d: d.value if d.value == d.value else math.inf)
            over = sum(not d.value <= AGREE for d in group)
            lines.append(f"{metric:44s} {len(group):6d} compared, worst {worst.value:.1e}, {over} over {AGREE:g}")
        lines += [
            f"  over: {d.metric} {d.value:.1e} {d.name}: {d.stated!r} stated, {d.found!r}" for d in self.over[:40]
        ]
        lines += [f"  not compared: {name} ({count})" for name, count in sorted(self.left.items())]
        return "\n".join(lines)
