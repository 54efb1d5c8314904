"""Answers that guide a point or carry a body: where they meet their targets, and what lies between (docs/path.md)."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.independent.comparison import Measured
from benchmarks.independent.drive import Complex, Drive
from benchmarks.independent.extremes import greatest
from benchmarks.independent.linkage import DRIVERS, compare_linkage

Real = NDArray[np.float64]

BULGE = 0.25
"""What a curve may bulge between two points, as a share of their distance."""

PANELS, NODES = 256, 12
"""Panels of Gauss's quadrature along the way, and nodes of each."""

FINE = 20_001
"""Inputs between which a body's turning is added up."""


def span(drive: Drive, design: Any) -> Real:
    """How far the input has moved from the skeleton's configuration at each target."""
    at = np.array([target.at for target in design.targets])
    if drive.slides_in:
        return at
    at = np.radians(at)
    first = (at[0] - drive.reference + math.pi) % math.tau - math.pi
    return np.asarray(at - at[0] + first)


def off_course(places: Complex, points: Complex, closed: bool, allowed: float, share: float) -> Real:
    """Distances of places from the lines through points, less what is allowed and a share of the line's length."""
    starts = points if closed else points[:-1]
    sides = (np.roll(points, -1) if closed else points[1:]) - starts
    gaps = places[:, None] - starts
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.nan_to_num((gaps * np.conj(sides)).real / np.abs(sides) ** 2)
    off = np.abs(gaps - np.clip(along, 0.0, 1.0) * sides) - allowed - share * np.abs(sides)
    least: Real = off.min(axis=1)
    least[np.isnan(places)] = np.nan
    return least


def travelled(drive: Drive, low: float, high: float) -> float:
    """Length of P's path, by quadrature of its speed."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    edges = np.linspace(low, high, PANELS + 1)
    half = 0.5 * np.diff(edges)[:, None]
    turns = 0.5 * (edges[1:] + edges[:-1])[:, None] + half * nodes
    speed = np.abs(drive.rates_at(turns.ravel())[:, drive.names.index("P")]).reshape(turns.shape)
    return float((speed * weights * half).sum())


def body(drive: Drive) -> tuple[int, int]:
    """The two joints of the link with P that are farthest apart."""
    joints = next(
        joints for name, joints in drive.links.items() if name != "ground" and drive.names.index("P") in joints
    )
    pairs = [(i, j) for i in joints for j in joints if i < j]
    return max(pairs, key=lambda pair: abs(drive.home[pair[0]] - drive.home[pair[1]]))


def rotation(drive: Drive, places: Complex) -> Real:
    """Rotation of the body from the skeleton's configuration, radians."""
    i, j = body(drive)
    return np.asarray(np.angle((places[:, j] - places[:, i]) / (drive.home[j] - drive.home[i])))


def compare_guided(result: Measured, stated: dict[str, Any], design: Any, name: str) -> set[str]:
    """Targets, errors, the whole way and how a body is carried."""
    kind, metrics, drive = stated["kind"], design.metrics, Drive(design.mechanism.skeleton)
    poses = stated["positions" if kind == "motion" else "points"]
    points = np.array([complex(pose["x"], pose["y"]) for pose in poses])
    task = float(np.abs(points[:, None] - points).max())
    placed = getattr(design, "placement", None)
    if placed is not None:
        points = placed.size * points * cmath.rect(1.0, math.radians(placed.rotation)) + complex(*placed.shift)
    turns = span(drive, design)
    if not (metrics.same_branch and metrics.visits_in_order):
        result.left["designs that leave their branch or order"] += 1
        return set()
    closed = bool(stated.get("closed"))
    low, high = float(turns.min()), float(turns.max())
    used = (low, high)
    if kind == "path" and closed and not drive.slides_in:
        gears = [abs(g.ratio) for g in design.mechanism.skeleton.gears]
        if any(ratio != round(ratio) for ratio in gears):
            result.left["geared fivebars of broken ratio, closed"] += 1
            return set()
        used = (float(turns[0]), float(turns[0]) + math.tau)
    if not drive.follow(min(low, *used), max(high, *used)):
        result.left[f"{design.mechanism.type}: could not be driven"] += 1
        return set()
    steps = np.diff(turns)
    result.add(f"{kind} visits_in_order", 1.0, float((steps >= 0).all() or (steps <= 0).all()), 1.0, name)
    joints = drive.at(turns)
    p = joints[:, drive.names.index("P")]
    misses = np.abs(p - points)
    wrong = np.zeros(len(points))
    if kind == "motion" and all(pose.get("angle") is not None for pose in poses):
        demanded = np.radians([pose["angle"] for pose in poses])
        begun = getattr(design.mechanism, "reference_body_angle", None)
        begun = float(demanded[0]) if begun is None else math.radians(begun)
        wrong = (begun + rotation(drive, joints) - demanded + math.pi) % math.tau - math.pi
    for k, target in enumerate(design.targets):
        result.add(f"{kind} point_residual", target.point_residual, float(misses[k]), task, name)
        result.add(f"{kind} residual", target.residual, max(misses[k] / task, abs(wrong[k])), 1.0, name)
        if target.angle_residual is not None:
            result.add(f"{kind} angle_residual", abs(target.angle_residual), math.degrees(abs(wrong[k])), 180.0, name)
    compared = {"rms_residual", "input_rotation", "input_stroke", "check reaches_targets"}
    rms = math.sqrt(float(np.mean((misses / task) ** 2 + wrong**2)))
    result.add(f"{kind} rms_residual", metrics.rms_residual, rms, 1.0, name)
    turned = float(turns[-1] - turns[0])
    result.add(f"{kind} input_rotation", metrics.input_rotation, math.degrees(turned), 360.0, name)
    result.add(f"{kind} input_stroke", metrics.input_stroke, turned, drive.size, name)
    for check in design.verification.checks:
        if check.name == "reaches_targets" and check.value is not None:
            far = max(float(misses.max()) / task, float(np.abs(wrong).max()))
            result.add(f"{kind} check reaches_targets", check.value, far, 1.0, name)
        if check.name == "within_tolerance" and kind == "path":
            shares = misses / np.array([pose["tolerance"] for pose in poses])
            result.add("path check within_tolerance", check.value, float(shares.max()), 1.0, name)
            compared.add("check within_tolerance")
    ease = 1.0
    if kind == "path":
        compared |= _compare_path(result, design, drive, points, p, closed, used, task, name)
    else:
        ease, more = _compare_body(result, design, drive, p, rotation(drive, joints), used, task, name)
        compared |= more
    way = (0.0, math.tau) if design.mechanism.type in DRIVERS else used
    return compared | compare_linkage(
        result, kind, design, drive, name, way=way, task=task, places=joints.ravel(), ease=ease
    )


def _compare_path(
    result: Measured,
    design: Any,
    drive: Drive,
    points: Complex,
    p: Complex,
    closed: bool,
    used: tuple[float, float],
    task: float,
    name: str,
) -> set[str]:
    metrics, misses = design.metrics, np.abs(p - points)
    squares, worst = float((misses**2).sum()), float(misses.max())
    result.add("path sum_of_squares", metrics.sum_of_squares, squares, task**2, name)
    result.add("path rms_distance", metrics.rms_distance, math.sqrt(squares / len(points)), task, name)
    result.add("path max_distance", metrics.max_distance, worst, task, name)

    def beyond(allowed: float, share: float) -> float:
        at = greatest(lambda u: off_course(drive.joint("P", u), points, closed, allowed, share), *used)
        return max(0.0, at.value) if at.value == at.value else math.nan

    if metrics.curve_distance is not None:
        result.add("path curve_distance", metrics.curve_distance, beyond(0.0, 0.0), task, name)
        result.add("path excursion", metrics.excursion, beyond(worst, BULGE), task, name)
    return {"sum_of_squares", "rms_distance", "max_distance", "curve_distance", "excursion"}


def _compare_body(
    result: Measured,
    design: Any,
    drive: Drive,
    p: Complex,
    turned: Real,
    used: tuple[float, float],
    task: float,
    name: str,
) -> tuple[float, set[str]]:
    """How the body is carried; the factor of the quality."""
    metrics = design.metrics
    travel = 0.0 if drive.slides_in else math.degrees(used[1] - used[0])
    if not drive.slides_in:
        result.add("motion input_travel", metrics.input_travel, travel, 360.0, name)
    way, needed = travelled(drive, *used), float(np.abs(np.diff(p)).sum())
    angles = np.unwrap(rotation(drive, drive.at(np.linspace(*used, FINE))))
    turning = float(np.abs(np.diff(angles)).sum())
    steps = np.diff(turned)
    needed_turn = float(np.abs((steps + math.pi) % math.tau - math.pi).sum())
    result.add("motion body_travel_ratio", metrics.body_travel_ratio, way / needed, way / needed, name)
    if needed_turn > 0.0:
        ratio = turning / needed_turn
        result.add("motion body_turn_ratio", metrics.body_turn_ratio, ratio, ratio, name)
    excess = max((way - needed) / max(needed, task), (turning - needed_turn) / max(needed_turn, math.radians(15.0)))
    ease = 1.0 / ((1.0 + (travel / 180.0) ** 2) * (1.0 + excess**2))
    return ease, {"input_travel", "body_travel_ratio", "body_turn_ratio"}
