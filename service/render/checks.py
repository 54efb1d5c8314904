"""The checks of a design with values, limits and units, and the number of failed checks in words."""

from __future__ import annotations

from collections.abc import Mapping

from service.render.outline import add_unit
from service.render.page import blocks, sheet
from service.render.page.numbers import format_length, format_small
from service.render.page.svg import clean_text
from service.units import list_symbols
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import Dimension
from synthesis.model.problem import ProblemBase

VALUE_DIGITS, MAX_DIGITS = 6, 17
"""Significant digits of a number, and those that distinguish any two double-precision numbers."""

TOLERANCE_RATIO = 1e-3
"""Ratio of value to limit below which two digits suffice; a dimensionless limit below it is a numerical tolerance."""


def format_check(check: Check, units: Mapping[Dimension, str]) -> tuple[str, str]:
    """Return value and limit of a check with their unit; empty strings if the check has none.

    If the check fails although both would print the same, digits are added until they differ.
    """
    unit = "" if check.dimension is None else units[check.dimension]
    digits = VALUE_DIGITS
    value, limit = _read(check, digits)
    # A failed check whose value reads like its limit would confuse readers.
    while not check.passed and value == limit and check.value != check.limit and digits < MAX_DIGITS:
        digits += 1
        value, limit = _read(check, digits)
    return add_unit(value, unit), add_unit(limit, unit)


def _read(check: Check, digits: int) -> list[str]:
    return ["" if number is None else format_length(number, digits=digits) for number in (check.value, check.limit)]


def make_checks_block(verification: Verification, problem: ProblemBase) -> blocks.Block:
    """Return the block of all checks of a design, in the units of its problem."""
    units = list_symbols(problem)
    listed = []
    for check in verification.checks:
        value, limit = format_check(check, units)
        if check.value is not None and check.limit is not None:
            # Two digits suffice for a rounding error or a tolerance, and leave space for the check's name.
            unit = "" if check.dimension is None else units[check.dimension]
            tolerance = check.passed and not unit and abs(check.limit) < TOLERANCE_RATIO
            if tolerance or abs(check.value) < TOLERANCE_RATIO * abs(check.limit):
                value = add_unit(format_small(check.value), unit)
            if tolerance:
                limit = format_small(check.limit)
        # A limit without a value is no measurement; the name of such a check contains the requirement.
        listed.append(blocks.CheckRow(check.name, check.passed, value, limit if value else ""))
    return blocks.make_checks(listed)


def describe_verdict(verification: Verification) -> str:
    """Return the number of failed checks in words."""
    return sheet.describe_verdict([check.passed for check in verification.checks])


def describe_failures(verification: Verification) -> str:
    """Return a sentence that lists the failed checks."""
    failed = [clean_text(check.name.replace("_", " ")) for check in verification.checks if not check.passed]
    return f"Failed checks: {', '.join(failed)}." if failed else "All checks passed."
