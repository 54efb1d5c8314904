"""How far a train is from the ratio that is wanted of it, as a clock shows it: seconds a day."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from pydantic import Field

from synthesis.model.answer import Answer, optional
from synthesis.model.ratio_target import parse_target

SECONDS_PER_DAY = 86_400.0

ACCURATE = 256
"""Bits to which the wanted ratio is enclosed: errors are told to all digits of a float."""

WANTED = (
    "The ratio that the train ought to have, a number or an exact expression such as `354375/12000`: the answer then "
    "has `drift`, of the sizes of both where they differ in sign."
)


class Drift(Answer):
    """What the output of a train gains or loses against one of exactly the wanted ratio, its input kept to time."""

    relative_error: float = Field(description="Of the ratio, with its sign.")
    seconds_per_day: float = Field(description="Positive: the output is fast.")
    days_per_second: float | None = Field(description="Days until it is a second off; null where it never is.")
    opposite: bool | None = optional(
        "True where ratio and wanted ratio differ in sign: the train turns the other way, or about axes that are not "
        "parallel. The rest is then that of their sizes."
    )


def drifting(ratio: Fraction | None, wanted: float | str | None) -> dict[str, Any]:
    """The field ``drift`` for a train of exactly this ratio; nothing where none is wanted."""
    if ratio is None or wanted is None:
        return {}
    sign, target = parse_target(wanted)
    if ratio == 0:
        return {}
    low, high = target.enclosure(ACCURATE)
    exact = target.rational or (low + high) / 2
    # The output turns by 1/ratio of the input: of a ratio that is too small it has turned too far.
    gained = exact / abs(ratio) - 1
    seconds = float(gained * Fraction(SECONDS_PER_DAY))
    told: dict[str, Any] = {
        "relative_error": float(abs(ratio) / exact - 1),
        "seconds_per_day": seconds,
        "days_per_second": None if seconds == 0.0 else 1.0 / abs(seconds),
    }
    if sign * ratio < 0:
        told["opposite"] = True
    return {"drift": told}
