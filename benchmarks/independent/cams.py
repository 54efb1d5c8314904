"""Cams measured by the formulas of the textbooks: random double dwells by laws written out here, under all followers.

Laws are those of Norton, §8.3; pitch curve and profile are taken at 40 001 angles of each move.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.independent.comparison import Measured
from synthesis.dispatch import solve
from synthesis.registry import parse_problem

Real = NDArray[np.float64]

DENSE = 40_001
"""Angles of each move of a cam: an extreme between two of them is missed by less than 1e-8 of itself."""


def law(name: str, u: Real) -> tuple[Real, Real, Real]:
    """s, s′, s″ of unit lift over unit angle (Norton, §8.3)."""
    if name == "cycloidal":
        turn = math.tau * u
        return u - np.sin(turn) / math.tau, 1.0 - np.cos(turn), math.tau * np.sin(turn)
    if name == "modified_sine":
        k, fast, slow = math.pi / (4.0 + math.pi), 4.0 * math.pi * u, (4.0 * u + 1.0) * math.pi / 3.0
        middle, last = (u >= 0.125) & (u <= 0.875), u > 0.875
        s = np.where(middle, 2.0 / math.pi + u - 2.25 / math.pi * np.sin(slow), u - np.sin(fast) / (4.0 * math.pi))
        s = np.where(last, s + 4.0 / math.pi, s)
        v = np.where(middle, 1.0 - 3.0 * np.cos(slow), 1.0 - np.cos(fast))
        return k * s, k * v, 4.0 * math.pi * k * np.where(middle, np.sin(slow), np.sin(fast))
    curve = np.polynomial.Polynomial(POLYNOMIALS[name])
    return curve(u), curve.deriv()(u), curve.deriv(2)(u)


POLYNOMIALS = {"polynomial_345": (0, 0, 0, 10, -15, 6), "polynomial_4567": (0, 0, 0, 0, 35, -84, 70, -20)}
LAWS = ("cycloidal", "modified_sine", *POLYNOMIALS)


class Cam(NamedTuple):
    """A statement and the motion of its two moves: s, v, a of rise and fall."""

    statement: dict[str, Any]
    s: Real
    v: Real
    a: Real


def random_cams(count: int, seed: int) -> Iterator[Cam]:
    """Double dwells under every follower in turn."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        kind = FOLLOWERS[n % len(FOLLOWERS)]
        shares = rng.uniform(0.4, 1.0, 4)
        angles = [round(float(angle), 3) for angle in 360.0 * shares / shares.sum()]
        angles[3] = 360.0 - sum(angles[:3])
        swing = kind.startswith("oscillating")
        lift = round(float(rng.uniform(6.0, 16.0) if swing else rng.uniform(8.0, 30.0)), 3)
        up, down = (str(name) for name in rng.choice(LAWS, 2))
        segments = [
            {"motion": "rise", "angle": angles[0], "lift": lift, "law": up},
            {"motion": "dwell", "angle": angles[1]},
            {"motion": "fall", "angle": angles[2], "lift": lift, "law": down},
            {"motion": "dwell", "angle": angles[3]},
        ]
        follower: dict[str, Any] = {"type": kind}
        if kind.endswith("roller"):
            follower["roller_radius"] = round(float(rng.uniform(4.0, 10.0)), 3)
        if kind == "translating_roller":
            follower["offset"] = round(float(rng.uniform(-8.0, 8.0)), 3)
        if kind == "oscillating_roller":
            follower |= {"arm": 90.0, "pivot_distance": round(float(rng.uniform(110.0, 140.0)), 3)}
        if kind == "oscillating_flat":
            follower |= {"pivot_distance": 180.0, "face_offset": round(float(rng.uniform(0.0, 8.0)), 3)}
        limits = {"min_radius": 3.0} if kind.endswith("flat") else {"pressure_angle": 35.0}
        height = math.radians(lift) if swing else lift
        parts = []
        for name, angle, start, sign in ((up, angles[0], 0.0, 1.0), (down, angles[2], height, -1.0)):
            beta = math.radians(angle)
            s, v, a = law(name, np.linspace(0.0, 1.0, DENSE))
            parts.append((start + sign * height * s, sign * height * v / beta, sign * height * a / beta**2))
        s, v, a = (np.concatenate(columns) for columns in zip(*parts, strict=True))
        yield Cam({"kind": "cam", "segments": segments, "follower": follower, "limits": limits}, s, v, a)


FOLLOWERS = ("translating_roller", "oscillating_roller", "translating_flat", "oscillating_flat", "barrel_roller")


def exact(cam: Cam, mechanism: Any) -> dict[str, float]:
    """Worst values of a cam from its motion and its dimensions (Norton §8.6–8.7; Rao §5.4–5.6)."""
    s, v, a, follower = cam.s, cam.v, cam.a, mechanism.follower
    up, down = v >= 0.0, v <= 0.0
    if follower.type == "barrel_roller":
        radius = mechanism.cylinder_radius
        slope = np.degrees(np.arctan(np.abs(v) / radius))
        least = ((radius**2 + v**2) ** 1.5 / np.maximum(radius * np.abs(a), 1e-12)).min()
        angles = {"max_pressure_angle_rise": slope[up].max(), "max_pressure_angle_fall": slope[down].max()}
        return angles | {"min_radius": least, "curvature_ratio": least / follower.roller_radius}
    if follower.type == "translating_flat":
        rho, reach = mechanism.base_radius + s + a, v
        return {"min_convex_radius": rho.min(), "face_width": np.ptp(reach)}
    if follower.type == "oscillating_flat":
        pivot, offset = follower.pivot_distance, follower.face_offset or 0.0
        psi, rate = math.asin((mechanism.base_radius + offset) / pivot) + s, 1.0 - (follower.sense or 1) * v
        x, y = pivot * np.cos(psi), pivot * np.sin(psi)
        rho = y - offset + (x * a / rate - y * v**2) / rate**2
        return {"min_convex_radius": rho.min(), "face_width": np.ptp(x / rate)}
    roller = follower.roller_radius
    if follower.type == "translating_roller":
        p = math.sqrt(mechanism.prime_radius**2 - follower.offset**2) + s + 1j * follower.offset
        p1, p2, motion = v + 0j, a + 0j, np.ones_like(p)
    else:
        sense, arm, pivot = follower.sense or 1, follower.arm, follower.pivot_distance
        start = math.acos((pivot**2 + arm**2 - mechanism.prime_radius**2) / (2.0 * pivot * arm))
        swung = -arm * np.exp(-1j * sense * (start + s))
        p, p1, p2 = pivot + swung, -1j * sense * v * swung, (-1j * sense * a - v**2) * swung
        motion = -1j * sense * swung / arm
    # In the frame of the ground the cam turns below the follower: z′ = p′ + i p.
    z1, z2 = p1 + 1j * p, p2 + 2j * p1 - p
    normal = -1j * z1 / np.abs(z1)
    leans = np.abs(np.angle(normal * np.conj(motion)))
    steep = np.degrees(np.minimum(leans, math.pi - leans))
    bend = (np.conj(z1) * z2).imag / np.abs(z1) ** 3
    convex, hollow = 1.0 / bend.max(), -1.0 / bend.min() if bend.min() < 0.0 else math.inf
    found = {
        "max_pressure_angle_rise": steep[up].max(),
        "max_pressure_angle_fall": steep[down].max(),
        "min_convex_radius": convex - roller,
        "curvature_ratio": min(convex, hollow) / roller,
        "size": np.abs(p - roller * normal).max(),
    }
    return found | ({"min_concave_radius": hollow + roller} if math.isfinite(hollow) else {})


def compare_cam(result: Measured, cam: Cam, design: Any, name: str) -> None:
    """Metrics and the checks of the same quantities."""
    found = exact(cam, design.mechanism) | {
        "peak_velocity": float(np.abs(cam.v).max()),
        "peak_acceleration": float(np.abs(cam.a).max()),
        "peak_inertia_torque": float(np.abs(cam.v * cam.a).max()),
    }
    kind = design.mechanism.follower.type
    for metric, value in found.items():
        # A hollow hundreds of times as flat as the cam is large is compared by its curvature.
        scale = 90.0 if "angle" in metric else float(value)
        scale *= max(1.0, value / 1000.0) if metric == "min_concave_radius" else 1.0
        result.add(f"{kind} {metric}", getattr(design.metrics, metric), float(value), scale, name)
    names = {"pressure_angle": "max_pressure_angle_rise", "pressure_angle_fall": "max_pressure_angle_fall"}
    names |= {"min_radius": "min_convex_radius", "curvature_ratio": "curvature_ratio", "face_width": "face_width"}
    for check in design.verification.checks:
        metric = names.get(check.name, "")
        if check.value is not None and metric in found:
            scale = 90.0 if "angle" in metric else float(found[metric])
            result.add(f"{kind} check {check.name}", check.value, float(found[metric]), scale, name)
    result.leave(design, set(found) | {f"check {name}" for name in names})


def cams(count: int, seed: int, result: Measured) -> int:
    """Solve and compare random cams; how many were answered."""
    answered = 0
    for n, cam in enumerate(random_cams(count, seed)):
        for design in solve(parse_problem(cam.statement)).designs:
            compare_cam(result, cam, design, f"cam {n}")
            answered += 1
    return answered
