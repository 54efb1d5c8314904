"""Answers whose output goes to and fro in unequal times (docs/tasks/quick_return.md)."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

from kinematics.arrays import Real
from tests.support.independent.comparison import Beside
from tests.support.independent.drive import Drive
from tests.support.independent.extremes import greatest, least, root
from tests.support.independent.linkage import Used, compare_linkage
from tests.support.independent.output import Output

BESIDE = 0.02
"""Radians to either side of an extreme between which the rate goes through nothing."""


def compare_quick_return(beside: Beside, stated: dict[str, Any]) -> None:
    """The limits of the output, and the times between them."""
    design = beside.design
    drive = Drive(design.mechanism.skeleton)
    if not drive.follow(-0.1, math.tau + 0.1):
        beside.unmeasured("could not be driven")
        return
    output = Output(drive, design.mechanism.type)
    unit = 180.0 / math.pi if output.turns else 1.0
    top, foot = (find(output.at, 0.0, math.tau) for find in (greatest, least))
    # Where the output stands still its rate goes through nothing, which is sharper than the extreme itself.
    ends = [root(output.rate, end.at - BESIDE, end.at + BESIDE) for end in (top, foot)]
    apart = (ends[1] - ends[0]) % math.tau
    slow, fast = max(apart, math.tau - apart), min(apart, math.tau - apart)
    way = (top.value - foot.value) * unit
    beside.metric("time_ratio", slow / fast, slow / fast)
    beside.metric("slow_rotation", math.degrees(slow), 360.0)
    beside.metric("fast_rotation", math.degrees(fast), 360.0)
    beside.metric("swing", way, way)
    beside.metric("stroke", way, way)
    # The slow stroke goes from the first limit to the second.
    begins = 0 if apart == slow or abs(apart - math.pi) < 1e-9 else 1
    first = math.radians(design.targets[0].input_angle) - drive.reference
    if abs(slow - fast) < 1e-9 and abs(math.remainder(first - ends[0], math.tau)) > 1.0:
        begins = 1
    for target, limit in zip(design.targets, (begins, 1 - begins), strict=True):
        stands = math.degrees(drive.reference + ends[limit])
        angle = target.input_angle - math.remainder(target.input_angle - stands, 360.0)
        beside.add("targets.input_angle", target.input_angle, angle, 360.0)
        at = (top, foot)[limit].value * unit
        at += 360.0 * round((target.output - at) / 360.0) if output.turns else 0.0
        beside.add("targets.output", target.output, at, way)
    places = drive.at(np.linspace(0.0, math.tau, 1441)).ravel()
    task = way
    if output.turns:
        pivot, pin = output.pins
        task = 2.0 * abs(drive.home[pin] - drive.home[pivot]) * math.sin(0.5 * math.radians(way))
    beside.check("time_ratio", abs(slow / fast / stated["time_ratio"] - 1.0))
    if stated.get("stroke") is not None:
        beside.check("stroke", abs(way / stated["stroke"] - 1.0))
    wanted = stated.get("swing")
    if stated.get("positions") is not None:
        turned = stated["positions"][1]["angle"] - stated["positions"][0]["angle"]
        wanted = abs(math.remainder(turned, 360.0))
        beside.check("reaches_targets", _missed(beside, stated, drive, np.array(ends)))
    if wanted is not None:
        beside.check("swing", abs(way - wanted), 360.0)
    compare_linkage(beside, stated, drive, Used((0.0, math.tau), task, places))


def _missed(beside: Beside, stated: dict[str, Any], drive: Drive, ends: Real) -> float:
    """How far the body on the rocker misses its two positions at the limits: shares of its arm, and radians."""
    z = drive.at(ends)
    at = drive.names.index
    turned = np.angle((z[:, at("B")] - z[:, at("O4")]) / (drive.home[at("B")] - drive.home[at("O4")]))
    begun = math.radians(beside.design.mechanism.reference_body_angle or 0.0)
    size = max(abs(complex(p["x"], p["y"]) - drive.home[at("O4")]) for p in stated["positions"])
    size = max(size, abs(drive.home[at("B")] - drive.home[at("O4")]))

    def missed(k: int, position: dict[str, float]) -> float:
        wrong = cmath.phase(cmath.rect(1.0, begun + float(turned[k]) - math.radians(position["angle"])))
        return max(float(abs(z[k, at("C")] - complex(position["x"], position["y"]))) / size, abs(wrong))

    first, second = stated["positions"]
    return min(max(missed(k, first), missed(1 - k, second)) for k in (0, 1))
