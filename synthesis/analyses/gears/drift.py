"""Drift of a gear train from its required ratio, in seconds per day, as for a clock."""

from __future__ import annotations

from fractions import Fraction

from pydantic import Field

from synthesis.model.answer import Answer, optional_field
from synthesis.model.gears.ratio_target import parse_target
from synthesis.model.json_object import JsonObject

SECONDS_PER_DAY = 86_400.0

ENCLOSURE_BITS = 256
"""Number of bits of the enclosure of the required ratio, with which errors are correct to all digits of a float."""

WANTED_DESCRIPTION = (
    "Required ratio of the train, a number or an exact expression such as `354375/12000`. The answer then has "
    "`drift`, which compares magnitudes if the signs differ."
)


class Drift(Answer):
    """Gain or loss of a train's output against a train with exactly the required ratio and the same input."""

    relative_error: float = Field(description="Relative error of the ratio, with its sign.")
    seconds_per_day: float = Field(description="Seconds per day; positive if the output is fast.")
    days_per_second: float | None = Field(description="Days until the error is one second; null if it never is.")
    opposite: bool | None = optional_field(
        "Whether ratio and required ratio differ in sign: the train turns the other way, or about axes that are not "
        "parallel. The other fields then compare magnitudes."
    )


def describe_drift(ratio: Fraction | None, wanted: float | str | None) -> JsonObject:
    """Return the field ``drift`` for a train with exactly this ratio; empty if no ratio is required or known."""
    if ratio is None or wanted is None:
        return {}
    sign, target = parse_target(wanted)
    # A ratio of 0 has no meaningful drift.
    if ratio == 0:
        return {}
    low, high = target.enclose(ENCLOSURE_BITS)
    exact = target.rational or (low + high) / 2
    # The output turns by 1/ratio of the input, so with too small a ratio it turns too far.
    gained = exact / abs(ratio) - 1
    seconds = float(gained * Fraction(SECONDS_PER_DAY))
    entries: JsonObject = {
        "relative_error": float(abs(ratio) / exact - 1),
        "seconds_per_day": seconds,
        "days_per_second": None if seconds == 0.0 else 1.0 / abs(seconds),
    }
    if sign * ratio < 0:
        entries["opposite"] = True
    return {"drift": entries}
