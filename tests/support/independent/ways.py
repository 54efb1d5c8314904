"""Answers that lead a point along a line, or a body along a curve (docs/tasks/straight_line.md, parallel_motion.md)."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

from kinematics.arrays import Complex, Real
from tests.support.independent.comparison import Beside
from tests.support.independent.drive import Drive
from tests.support.independent.extremes import greatest, least
from tests.support.independent.guided import compare_demands_of_path
from tests.support.independent.linkage import Used, box, compare_linkage
from tests.support.independent.transmission import least_angles


def compare_line(beside: Beside, stated: dict[str, Any]) -> None:
    """How straight and how evenly P runs along the line."""
    design = beside.design
    drive, metrics = Drive(design.mechanism.skeleton), design.metrics
    length = float(stated["length"])
    start = complex(*stated.get("start", (0.0, 0.0)))
    along = cmath.rect(1.0, math.radians(stated.get("direction", 0.0)))
    inputs = np.radians([target.input_angle for target in design.targets])
    first = (inputs[0] - drive.reference + math.pi) % math.tau - math.pi
    turns = inputs - inputs[0] + first
    low, high = sorted((float(turns[0]), float(turns[-1])))
    if not drive.follow(low, high):
        beside.unmeasured("could not be driven")
        return

    def across(at: Real) -> Real:
        return np.asarray(((drive.joint("P", at) - start) * np.conj(along)).imag)

    def rate(at: Real) -> Real:
        return np.asarray((drive.rates_at(at)[:, drive.names.index("P")] * np.conj(along)).real)

    ends = drive.joint("P", turns[[0, -1]])
    for k, target in enumerate(design.targets):
        at = complex(ends[k])
        beside.add("targets.x", target.x, at.real, length)
        beside.add("targets.y", target.y, at.imag, length)
        beside.add("targets.deviation", target.deviation, abs(float(across(turns[k : k + 1])[0])), length)
        stands = drive.at(turns[k : k + 1])[0]
        joint, (pivot, _) = next(iter(drive.turning.items()))
        off = target.input_angle - math.degrees(float(np.angle(stands[joint] - stands[pivot])))
        beside.add("targets.input_angle", target.input_angle, target.input_angle - math.remainder(off, 360.0), 360.0)
    gone = ((ends - start) * np.conj(along)).real
    beside.check("reaches_ends", max(abs(float(gone[0])), abs(float(gone[1]) - length)) / length)
    top, foot = greatest(across, low, high).value, least(across, low, high).value
    beside.metric("deviation", max(top, -foot), length)
    beside.check("deviation", max(top, -foot), length)
    beside.check("exact_line", max(top, -foot) / length)
    beside.metric("straightness_error", 100.0 * (top - foot) / length, 100.0)
    sense = math.copysign(1.0, float(turns[-1] - turns[0]))
    mean = float(gone[1] - gone[0]) / abs(float(turns[-1] - turns[0]))
    fastest, slowest = greatest(rate, low, high).value, least(rate, low, high).value
    beside.metric("mean_velocity", mean, mean)
    beside.metric("middle_velocity", sense * float(rate(np.array([0.5 * (low + high)]))[0]), mean)
    beside.metric("velocity_variation", 100.0 * (fastest - slowest) / mean, 100.0)
    beside.check("velocity_variation", 100.0 * (fastest - slowest) / mean, 100.0)
    beside.metric("input_rotation", math.degrees(turns[-1] - turns[0]), 360.0)
    if stated.get("rotation", "any") != "any":
        beside.check("rotation", (sense > 0.0) == (stated["rotation"] == "ccw"))
    places = drive.at(np.linspace(low, high, 1441)).ravel()
    in_order = min(sense * fastest, sense * slowest) > 0.0
    compare_linkage(beside, stated, drive, Used((low, high), length, places, in_order=in_order))
    if metrics.cycle_transmission_angle is not None:
        found = min(least_angles(drive, 0.0, math.tau).values()) if drive.follow(0.0, math.tau) else math.nan
        beside.metric("cycle_transmission_angle", found, 90.0)


def compare_parallel(beside: Beside, stated: dict[str, Any]) -> None:
    """How far the body turns, and the curve that it goes along."""
    design = beside.design
    drive, metrics = Drive(design.mechanism.skeleton), design.metrics
    begin, end = (math.radians(angle) - drive.reference for angle in metrics.input_range)
    whole = end - begin >= math.tau - 1e-9
    off = math.tau * round(0.5 * (begin + end) / math.tau)
    begin, end = (0.0, math.tau) if whole else (begin - off, end - off)
    if not drive.follow(min(begin, end), max(begin, end)):
        beside.unmeasured("could not be driven")
        return
    p, q = drive.names.index("P"), drive.names.index("Q")
    home = drive.home[q] - drive.home[p]

    def turn(at: Real) -> Real:
        z = drive.at(at)
        return np.abs(np.angle((z[:, q] - z[:, p]) / home))

    turned = greatest(turn, min(begin, end), max(begin, end)).value
    beside.metric("rotation", math.degrees(turned), 180.0)
    beside.check("translates", turned)
    beside.add("metrics.translation", abs(complex(*metrics.translation) - home), 0.0, abs(home))
    z = drive.at(np.linspace(begin, end, 1441))
    curve = box(z[:, p])
    path, task = stated.get("path"), curve
    if path is not None:
        points = np.array([complex(point["x"], point["y"]) for point in path["points"]])
        task = float(np.abs(points[:, None] - points).max())
        _compare_targets(beside, path, drive, points, task)
        stated = {**stated, "constraints": {**path.get("constraints", {}), **stated.get("constraints", {})}}
    else:
        beside.metric("rms_residual", 0.0, 1.0)
        missed = off_curve(stated["linkage"], z[:, p])
        beside.metric("curve_distance", missed, curve)
        beside.check("on_curve", missed / curve)
    beside.metric("input_rotation", math.degrees(end - begin), 360.0)
    beside.add("metrics.input_range", *_range(metrics, drive, whole), 360.0)
    compare_linkage(beside, stated, drive, Used((min(begin, end), max(begin, end)), task, z.ravel()))


def _range(metrics: Any, drive: Drive, whole: bool) -> tuple[float, float]:
    """The first input angle, and where a whole turn begins or the linkage is driven to; both are the same."""
    first, last = metrics.input_range
    if whole:
        stands = math.degrees(drive.reference)
        return first, first - math.remainder(first - stands, 360.0)
    return last, first + metrics.input_rotation


def _compare_targets(beside: Beside, path: dict[str, Any], drive: Drive, points: Complex, task: float) -> None:
    """The points of the path as P meets them."""
    inputs = np.radians([target.position for target in beside.design.targets])
    first = (inputs[0] - drive.reference + math.pi) % math.tau - math.pi
    turns = inputs - inputs[0] + first
    if not drive.follow(float(turns.min()), float(turns.max())):
        beside.unmeasured("could not be driven to its points")
        return
    z = drive.at(turns)
    misses = np.abs(z[:, drive.names.index("P")] - points)
    joint, (pivot, _) = next(iter(drive.turning.items()))
    stands = np.degrees(np.angle(z[:, joint] - z[:, pivot]))
    for k, target in enumerate(beside.design.targets):
        beside.add("targets.point_residual", target.point_residual, float(misses[k]), task)
        beside.add("targets.residual", target.residual, float(misses[k]) / task, 1.0)
        off = math.remainder(target.position - float(stands[k]), 360.0)
        beside.add("targets.input_angle", target.position, target.position - off, 360.0)
    beside.metric("rms_residual", math.sqrt(float(np.mean((misses / task) ** 2))), 1.0)
    beside.check("reaches_targets", float(misses.max()) / task)
    compare_demands_of_path(beside, path, drive, task, turns[:1])


STARTS, NEWTON = 24, 40
"""Angles of the input from which Newton's iteration starts, and its steps."""


def off_curve(linkage: dict[str, Any], places: Complex) -> float:
    """How far P is from the curve of a fourbar: the coupler is laid with P on each place, A on the input's circle.

    Newton's iteration turns the input until P is as far from A as it must be; B then misses the output's circle.
    """
    o2, o4 = (complex(*linkage["fixed_pivots"][side]) for side in ("input", "output"))
    a, b, c = (linkage["links"][name] for name in ("input", "coupler", "output"))
    arm = cmath.rect(linkage["coupler_point"]["distance"], math.radians(linkage["coupler_point"]["angle"]))
    turn = np.broadcast_to(np.linspace(0.0, math.tau, STARTS, endpoint=False), (len(places), STARTS)).copy()
    for _ in range(NEWTON):
        reach = places[:, None] - o2 - a * np.exp(1j * turn)
        f = np.abs(reach) ** 2 - abs(arm) ** 2
        slope = 2.0 * (np.conj(reach) * -1j * a * np.exp(1j * turn)).real
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = turn - np.clip(np.nan_to_num(f / slope), -0.5, 0.5)
    pin = o2 + a * np.exp(1j * turn)
    met = np.abs(np.abs(places[:, None] - pin) - abs(arm)) < 1e-9 * abs(arm)
    end = pin + b * (places[:, None] - pin) / arm
    missed = np.where(met, np.abs(np.abs(end - o4) - c), np.inf)
    return float(missed.min(axis=1).max())
