"""Random cams under every follower, by laws that are stated and by motions that are optimized.

They are compared with the formulas of the textbooks (:mod:`~benchmarks.independent.cam_measures`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from benchmarks.independent.cam_measures import compare_cam
from benchmarks.independent.cam_motion import LAWS, Move, at_rest, by_law, by_table
from benchmarks.independent.comparison import Measured
from synthesis.dispatch import solve
from synthesis.registry import parse_problem

Statement = dict[str, Any]

FOLLOWERS = ("translating_roller", "oscillating_roller", "translating_flat", "oscillating_flat", "barrel_roller")

OPTIMIZED = "optimized"
"""What the name of a cam with optimized motions ends with."""

CRITERIA = ("peak_acceleration", "peak_jerk", "rms_acceleration", "rms_jerk", "peak_velocity")
"""What optimized motions make least."""


def statements(count: int, seed: int) -> Iterator[Statement]:
    """Double dwells under every follower in turn; in each fourth round of the followers the motions are optimized."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        kind = FOLLOWERS[n % len(FOLLOWERS)]
        optimal = (n // len(FOLLOWERS)) % 4 == 3
        shares = rng.uniform(0.4, 1.0, 4)
        angles = [round(float(angle), 3) for angle in 360.0 * shares / shares.sum()]
        angles[3] = 360.0 - sum(angles[:3])
        swing = kind.startswith("oscillating")
        lift = round(float(rng.uniform(6.0, 16.0) if swing else rng.uniform(8.0, 30.0)), 3)
        up, down = ("optimal", "optimal") if optimal else (str(name) for name in rng.choice(LAWS, 2))
        segments = [
            {"motion": "rise", "angle": angles[0], "lift": lift, "law": up},
            {"motion": "dwell", "angle": angles[1]},
            {"motion": "fall", "angle": angles[2], "lift": lift, "law": down},
            {"motion": "dwell", "angle": angles[3]},
        ]
        limits: Statement = {"min_radius": 3.0} if kind.endswith("flat") else {"pressure_angle": 35.0}
        if rng.random() < 0.3:
            limits |= {"hub_radius": 5.0, "size": 5000.0}
            limits |= {"face_width": 5000.0} if kind.endswith("flat") else {"pressure_angle_fall": 45.0}
        stated: Statement = {"kind": "cam", "segments": segments, "follower": _follower(rng, kind), "limits": limits}
        if optimal:
            _optimized(rng, stated, angles, lift * (math.pi / 180.0 if swing else 1.0))
        if kind.endswith("roller") and kind != "barrel_roller" and rng.random() < 0.25:
            stated["closure"] = "form"
        if rng.random() < 0.5:
            _loaded(rng, stated)
        yield stated


def _follower(rng: np.random.Generator, kind: str) -> Statement:
    follower: Statement = {"type": kind}
    if kind.endswith("roller"):
        follower["roller_radius"] = round(float(rng.uniform(4.0, 10.0)), 3)
    if kind == "translating_roller":
        follower["offset"] = round(float(rng.uniform(-8.0, 8.0)), 3)
    if kind == "oscillating_roller":
        follower |= {"arm": 90.0, "pivot_distance": round(float(rng.uniform(110.0, 140.0)), 3)}
    if kind == "oscillating_flat":
        follower |= {"pivot_distance": 180.0, "face_offset": round(float(rng.uniform(0.0, 8.0)), 3)}
    return follower


def _optimized(rng: np.random.Generator, stated: Statement, angles: list[float], lift: float) -> None:
    """What the motions make least, under limits that a good law would keep, and a condition on the way."""
    shortest = math.radians(min(angles[0], angles[2]))
    stated["minimize"] = str(rng.choice(CRITERIA))
    stated["limits"] |= {
        "velocity": 2.5 * lift / shortest,
        "acceleration": 9.0 * lift / shortest**2,
        "jerk": 70.0 * lift / shortest**3,
    }
    if rng.random() < 0.5:
        stated["segments"][0]["conditions"] = [
            {"angle": 0.5 * angles[0], "s": 0.5 * stated["segments"][0]["lift"]},
            {"angle": 0.4 * angles[0], "v": 1.6 * lift / math.radians(angles[0])},
        ]
        stated["segments"][0]["bands"] = [
            {
                "start": 0.2 * angles[0],
                "end": 0.3 * angles[0],
                "lower": 0.0,
                "upper": 0.4 * stated["segments"][0]["lift"],
            }
        ]
    if rng.random() < 0.3:
        stated["continuity"] = "jerk"


def _loaded(rng: np.random.Generator, stated: Statement) -> None:
    """Mass, spring, damping, and a preload or a least force."""
    stated["speed_rpm"] = float(rng.uniform(60.0, 600.0))
    dynamics = {"mass": float(rng.uniform(0.2, 3.0)), "spring_rate": float(rng.uniform(0.5, 20.0))}
    if rng.random() < 0.5:
        dynamics["damping_ratio"] = float(rng.uniform(0.0, 0.2))
    grooved = stated.get("closure") == "form" or stated["follower"]["type"] == "barrel_roller"
    if not grooved:
        dynamics["least_force"] = float(rng.uniform(0.0, 50.0))
    elif rng.random() < 0.5:
        dynamics["preload"] = float(rng.uniform(0.0, 50.0))
    stated["dynamics"] = dynamics


def moves_of(stated: Statement, program: Any) -> list[Move]:
    """The segments of a design's program, from the statement, or where a motion is optimized from the table."""
    unit = math.pi / 180.0 if stated["follower"]["type"].startswith("oscillating") else 1.0
    moves: list[Move] = []
    start, height = 0.0, 0.0
    for segment in stated["segments"]:
        angle = math.radians(segment["angle"])
        after = height + {"rise": 1.0, "fall": -1.0, "dwell": 0.0}[segment["motion"]] * unit * segment.get("lift", 0.0)
        if segment["motion"] == "dwell":
            moves.append(at_rest(start, angle, height))
        elif segment["law"] == "optimal":
            moves.append(by_table(program, start, angle, unit))
        else:
            moves.append(by_law(segment["law"], start, angle, height, after))
        start, height = start + angle, after
    return moves


def cams(count: int, seed: int, result: Measured) -> int:
    """Solve and compare random cams; how many were answered."""
    answered = 0
    for n, stated in enumerate(statements(count, seed)):
        for design in solve(parse_problem(stated)).designs:
            motion = OPTIMIZED if stated["segments"][0]["law"] == "optimal" else "by laws"
            name = f"cam {n} (seed {seed}), {stated['follower']['type']}, {motion}"
            beside = result.beside("cam", design, name)
            compare_cam(beside, stated, moves_of(stated, design.mechanism.program))
            beside.finish()
            answered += 1
    return answered
