"""The checks of a design on its sheet: each number with the unit of what it measures, and in words how many fail."""

from __future__ import annotations

from service.render.page import blocks, sheet
from service.render.page.numbers import length, small
from service.render.page.svg import clean
from service.units import symbols
from synthesis.model.answer import Verification
from synthesis.model.statement import StatedProblem

ROUNDING = 1e-3
"""Values below are residuals, of which two digits tell all; of others four are shown."""


def checks(verification: Verification, problem: StatedProblem) -> blocks.Block:
    """Every check of a design, in the units of its problem."""
    units = symbols(problem)
    listed = []
    for check in verification.checks:
        unit = "" if check.dimension is None else units[check.dimension]
        limit = None if check.value is None else check.limit
        listed.append(blocks.CheckRow(check.name, check.passed, _amount(check.value, unit), _amount(limit, unit)))
    return blocks.checks(listed)


def _amount(value: float | None, unit: str) -> str:
    if value is None:
        return ""
    digits = small(value) if abs(value) < ROUNDING else length(value, digits=4)
    return f"{digits}{unit}" if unit in ("", "°") else f"{digits} {unit}"


def verdict(verification: Verification) -> str:
    """In words, how many checks fail."""
    return sheet.verdict([check.passed for check in verification.checks])


def outcome(verification: Verification) -> str:
    """In a sentence, which checks fail."""
    failed = [clean(check.name.replace("_", " ")) for check in verification.checks if not check.passed]
    return f"Failed checks: {', '.join(failed)}." if failed else "All checks passed."
