"""Which links of a fourbar turn all round: at every angle of one the other two are laid across what is left.

Nothing is said of sums of the shortest and the longest link: a link turns through if the triangle of the two others
closes at each of its angles.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

ANGLES = np.linspace(0.0, math.tau, 2880, endpoint=False)
"""Angles of a turn at which triangles are closed, in line with the ground and against it among them."""

CHANGE = 1e-9
"""How near a triangle is to none, as a share of all lengths, at a change point."""


class Turning(NamedTuple):
    """Grashof's class and Barker's code (Norton, Table 2-4)."""

    motion: str
    code: str


def class_of(o2: complex, a: complex, b: complex, o4: complex) -> Turning:
    """The class of a fourbar by its joints: O2 and O4 on the ground, A on the input, B on the output."""
    ground, crank, coupler, output = abs(o4 - o2), abs(a - o2), abs(b - a), abs(b - o4)
    slack = {
        "input": _slack(ground, crank, coupler, output),
        "coupler": _slack(ground, coupler, crank, output),
        "output": _slack(ground, output, coupler, crank),
    }
    if any(abs(spare) <= CHANGE for spare in slack.values()):
        return Turning("change_point", "S")
    turning = {name for name, spare in slack.items() if spare > 0.0}
    if {"input", "output"} <= turning:
        return Turning("double_crank", "GCCC")
    if "input" in turning:
        return Turning("crank_rocker", "GCRR")
    if "output" in turning:
        return Turning("rocker_crank", "GRRC")
    if "coupler" in turning:
        return Turning("double_rocker", "GRCR")
    lengths = (ground, crank, coupler, output)
    return Turning("rocker_rocker", f"RRR{1 + lengths.index(max(lengths))}")


def _slack(ground: float, turning: float, one: float, other: float) -> float:
    """By how much the triangle closes where it is nearest to none, as a share of all lengths; negative: it does not."""
    reach = np.abs(ground + turning * np.exp(1j * ANGLES))
    spare = np.minimum(one + other - reach, reach - abs(one - other))
    return float(spare.min()) / (ground + turning + one + other)
