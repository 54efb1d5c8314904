"""Answers that lead a point along a line, or a body along a curve (docs/straight_line.md, parallel_motion.md)."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.independent.comparison import Measured
from benchmarks.independent.drive import Drive
from benchmarks.independent.extremes import greatest, least
from benchmarks.independent.linkage import box, compare_linkage
from benchmarks.independent.transmission import least_angles

Real = NDArray[np.float64]


def compare_line(result: Measured, stated: dict[str, Any], design: Any, name: str) -> set[str]:
    """How straight and how evenly P runs along the line."""
    drive, metrics = Drive(design.mechanism.skeleton), design.metrics
    length = float(stated["length"])
    start, along = (
        complex(*stated.get("start", (0.0, 0.0))),
        cmath.rect(1.0, math.radians(stated.get("direction", 0.0))),
    )
    inputs = np.radians([target.input_angle for target in design.targets])
    first = (inputs[0] - drive.reference + math.pi) % math.tau - math.pi
    turns = inputs - inputs[0] + first
    low, high = sorted((float(turns[0]), float(turns[-1])))
    if not drive.follow(low, high):
        result.left[f"{design.mechanism.type}: could not be driven"] += 1
        return set()

    def across(at: Real) -> Real:
        return np.asarray(((drive.joint("P", at) - start) * np.conj(along)).imag)

    def rate(at: Real) -> Real:
        return np.asarray((drive.rates_at(at)[:, drive.names.index("P")] * np.conj(along)).real)

    for target, turn in zip(design.targets, turns, strict=True):
        p = drive.joint("P", np.array([turn]))[0]
        result.add("straight_line ends", 0.0, abs(p - complex(target.x, target.y)), length, name)
        result.add(
            "straight_line deviation of an end", target.deviation, abs(float(across(np.array([turn]))[0])), length, name
        )
    top, foot = greatest(across, low, high).value, least(across, low, high).value
    result.add("straight_line deviation", metrics.deviation, max(top, -foot), length, name)
    result.add(
        "straight_line straightness_error", metrics.straightness_error, 100.0 * (top - foot) / length, 100.0, name
    )
    ends = drive.joint("P", turns[[0, -1]])
    sense = math.copysign(1.0, float(turns[-1] - turns[0]))
    mean = float(((ends[1] - ends[0]) * np.conj(along)).real) / abs(float(turns[-1] - turns[0]))
    middle = sense * float(rate(np.array([0.5 * (low + high)]))[0])
    spread = greatest(rate, low, high).value - least(rate, low, high).value
    result.add("straight_line mean_velocity", metrics.mean_velocity, mean, mean, name)
    result.add("straight_line middle_velocity", metrics.middle_velocity, middle, mean, name)
    result.add("straight_line velocity_variation", metrics.velocity_variation, 100.0 * spread / mean, 100.0, name)
    turned = math.degrees(turns[-1] - turns[0])
    result.add("straight_line input_rotation", metrics.input_rotation, turned, 360.0, name)
    places = drive.at(np.linspace(low, high, 1441)).ravel()
    ways = compare_linkage(result, "straight_line", design, drive, name, way=(low, high), task=length, places=places)
    if metrics.cycle_transmission_angle is not None and drive.follow(0.0, math.tau):
        found = min(least_angles(drive, 0.0, math.tau).values())
        result.add("straight_line cycle_transmission_angle", metrics.cycle_transmission_angle, found, 90.0, name)
    for check in design.verification.checks:
        if check.name == "exact_line":
            result.add("straight_line check exact_line", check.value, max(top, -foot) / length, 1.0, name)
    names = (
        "check exact_line",
        "deviation",
        "straightness_error",
        "mean_velocity",
        "middle_velocity",
        "velocity_variation",
    )
    return ways | set(names) | {"input_rotation", "cycle_transmission_angle"}


def compare_parallel(result: Measured, stated: dict[str, Any], design: Any, name: str) -> set[str]:
    """How far the body turns, and the curve that it goes along."""
    drive, metrics = Drive(design.mechanism.skeleton), design.metrics
    begin, end = (math.radians(angle) - drive.reference for angle in metrics.input_range)
    off = math.tau * round(0.5 * (begin + end) / math.tau) if end - begin < math.tau - 1e-9 else 0.0
    if end - begin >= math.tau - 1e-9:
        begin, end, off = 0.0, math.tau, 0.0
    begin, end = begin - off, end - off
    if not drive.follow(begin, end):
        result.left[f"{design.mechanism.type}: could not be driven"] += 1
        return set()
    p, q = drive.names.index("P"), drive.names.index("Q")
    home = drive.home[q] - drive.home[p]

    def turn(at: Real) -> Real:
        z = drive.at(at)
        return np.abs(np.angle((z[:, q] - z[:, p]) / home))

    result.add(
        "parallel_motion rotation", metrics.rotation, math.degrees(greatest(turn, begin, end).value), 180.0, name
    )
    result.add("parallel_motion translation", 0.0, abs(complex(*metrics.translation) - home), abs(home), name)
    z = drive.at(np.linspace(begin, end, 1441))
    task = box(z[:, p]) if stated.get("path") is None else None
    if task is None:
        points = np.array([complex(point["x"], point["y"]) for point in stated["path"]["points"]])
        task = float(np.abs(points[:, None] - points).max())
    result.add("parallel_motion input_rotation", metrics.input_rotation, math.degrees(end - begin), 360.0, name)
    for check in design.verification.checks:
        if check.name == "translates":
            result.add("parallel_motion check translates", check.value, greatest(turn, begin, end).value, 1.0, name)
    ways = compare_linkage(
        result, "parallel_motion", design, drive, name, way=(begin, end), task=task, places=z.ravel()
    )
    return ways | {"rotation", "input_rotation", "check translates"}
