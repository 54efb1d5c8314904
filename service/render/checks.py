"""The block of a design's checks, as the answer has them."""

from __future__ import annotations

from collections.abc import Callable

from service.render.page import blocks, sheet
from service.render.page.svg import clean
from synthesis.model.answer import Check, Verification


def checks(verification: Verification, written: Callable[[Check, float], str]) -> blocks.Block:
    """Every check of a design; ``written`` says how the numbers of a check are."""

    def amount(check: Check, value: float | None) -> str:
        return "" if value is None else written(check, value)

    listed = []
    for check in verification.checks:
        limit = "" if check.value is None else amount(check, check.limit)
        listed.append(blocks.CheckRow(check.name, check.passed, amount(check, check.value), limit))
    return blocks.checks(listed)


def verdict(verification: Verification) -> str:
    """In words, how many checks fail."""
    return sheet.verdict([check.passed for check in verification.checks])


def outcome(verification: Verification) -> str:
    """In a sentence, which checks fail."""
    failed = [clean(check.name.replace("_", " ")) for check in verification.checks if not check.passed]
    return f"Failed checks: {', '.join(failed)}." if failed else "All checks passed."
