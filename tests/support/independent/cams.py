"""Random cams under every follower, by laws that are stated and by motions that are optimized.

They are compared with the formulas of the textbooks (:mod:`~tests.support.independent.cam_measures`).
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from typing import Any

import numpy as np

from synthesis.dispatch import solve
from synthesis.model.problem import ContradictionError
from synthesis.registry import parse_problem
from tests.support.independent import cam_demands, cam_laws
from tests.support.independent.cam_measures import RATES, compare_cam, criterion, sound_anywhere
from tests.support.independent.cam_motion import Move, at_rest, by_law, by_polynomial, by_table, greatest
from tests.support.independent.comparison import Measured

Statement = dict[str, Any]

FOLLOWERS = ("translating_roller", "oscillating_roller", "translating_flat", "oscillating_flat", "barrel_roller")

LAWS = ("cycloidal", "modified_sine", "polynomial_345", "polynomial_4567")
"""Laws of the double dwells."""

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
    grooved = stated.get("closure", "force") != "force" or stated["follower"]["type"] == "barrel_roller"
    if not grooved:
        dynamics["least_force"] = float(rng.uniform(0.0, 50.0))
    elif rng.random() < 0.5:
        dynamics["preload"] = float(rng.uniform(0.0, 50.0))
    stated["dynamics"] = dynamics


MIRRORED = {law: name for name, law in cam_laws.MIRRORED.items()}
"""What books call a fall that mirrors a rise by a law: that law."""


def moves_of(stated: Statement, design: Any) -> list[Move]:
    """The segments of a design's program, from the statement, or where a motion is optimized from the table.

    Of automatic segments the answer says by what law they go.
    """
    unit = math.pi / 180.0 if stated["follower"]["type"].startswith("oscillating") else 1.0
    segments = stated["segments"]
    moves: list[Move | None] = []
    joined: list[tuple[float, float, float, float]] = []
    start, height = 0.0, 0.0
    for k, segment in enumerate(segments):
        angle, name = math.radians(segment["angle"]), segment.get("law", segment["motion"])
        after = height + unit * _travel(segment, height / unit)
        if segment["motion"] == "dwell":
            moves.append(at_rest(start, angle, height))
        elif segment["motion"] == "polynomial":
            moves.append(by_polynomial(start, angle, _conditions(segment, unit)))
            after = float(moves[-1].s[-1, -1])
        elif name == "optimal":
            moves.append(by_table(design.mechanism.program, start, angle, unit, stated.get("continuity") == "jerk"))
        else:
            name = design.segments[k].law if name == "auto" else name
            if segment["motion"] in ("fall", "return") and segment["law"] != "auto":
                following = segments[(k + 1) % len(segments)].get("law")
                name = name if following in cam_laws.MIRRORED else MIRRORED.get(name, name)
            moves.append(None if name == "polynomial" else by_law(name, start, angle, height, after))
        joined.append((start, angle, height, after))
        start, height = start + angle, after
    for k, (begin, angle, low, high) in enumerate(joined):
        if moves[k] is None:
            moves[k] = _joining(moves[k - 1], moves[(k + 1) % len(moves)], begin, angle, (low, high))
    return [move for move in moves if move is not None]


def _travel(segment: Statement, height: float) -> float:
    """What a segment adds to the displacement."""
    if segment["motion"] in ("dwell", "polynomial"):
        return 0.0
    lift = float(segment.get("lift", height))
    return -lift if segment["motion"] in ("fall", "return") else lift


def _conditions(segment: Statement, unit: float) -> list[tuple[float, int, float]]:
    """Conditions of a polynomial: shares of the angle, orders and values."""
    return [
        (condition["angle"] / segment["angle"], order, condition[name] * (unit if order == 0 else 1.0))
        for condition in segment["conditions"]
        for order, name in enumerate("svaj")
        if name in condition
    ]


def compare_choice(beside: Any, stated: Statement, moves: list[Move]) -> None:
    """No other law between rests is better than one that the criterion has chosen, within the limits on its rates.

    The criterion is that of the whole cam; size and contact force, for which moves are compared alone, are left out.
    """
    name = stated.get("minimize", "peak_acceleration")
    if name in ("size", "peak_contact_force"):
        return
    segments, chosen = stated["segments"], criterion(name, moves)
    for k, segment in enumerate(segments):
        alone = segments[k - 1]["motion"] == segments[(k + 1) % len(segments)]["motion"] == "dwell"
        if segment.get("law", "") != "auto" or not alone:
            continue
        move = moves[k]
        for law in cam_laws.AT_REST:
            other = by_law(law, move.start, move.angle, float(move.s[0, 0]), float(move.s[-1, -1]))
            rates = {of: greatest(np.abs(other.rates(n))) for n, of in enumerate(RATES, start=1)}
            if all(rates[of] <= stated["limits"].get(of, math.inf) * (1.0 + 1e-9) for of in RATES):
                better = criterion(name, [*moves[:k], other, *moves[k + 1 :]]) < chosen * (1.0 - 1e-6)
                beside.same("mechanism.best_law", (law, better), (law, False))


def _joining(before: Move | None, after: Move | None, start: float, angle: float, ends: tuple[float, float]) -> Move:
    """The polynomial of the fifth degree between the states of its neighbours; rest where one is such itself."""
    enter = (0.0, 0.0) if before is None else (float(before.v[-1, -1]), float(before.a[-1, -1]))
    leave = (0.0, 0.0) if after is None else (float(after.v[0, 0]), float(after.a[0, 0]))
    states = ((0.0, (ends[0], *enter)), (1.0, (ends[1], *leave)))
    return by_polynomial(start, angle, [(at, order, x) for at, state in states for order, x in enumerate(state)])


def cams(count: int, seed: int, result: Measured, every_demand: bool = False, told: bool = False) -> int:
    """Solve and compare random cams; how many were answered.

    ``every_demand`` takes those of :mod:`~tests.support.independent.cam_demands` instead of double dwells; ``told``
    prints a line for each.
    """
    answered = 0
    drawn = (
        cam_demands.statements(count, seed) if every_demand else (("", stated) for stated in statements(count, seed))
    )
    for n, (sort, stated) in enumerate(drawn):
        follower = stated["follower"]["type"]
        begun = time.perf_counter()
        try:
            answer = solve(parse_problem(stated))
        except ContradictionError as refusal:
            result.left[f"cam {n} (seed {seed}), {sort}, refused: {refusal}"] += 1
            continue
        for design in answer.designs:
            motion = OPTIMIZED if any(s.get("law") == "optimal" for s in stated["segments"]) else "by laws"
            name = f"cam {n} (seed {seed}), {sort + ', ' if sort else ''}{follower}, {motion}"
            beside = result.beside("cam", design, name)
            moves = moves_of(stated, design)
            compare_cam(beside, stated, moves, answer.search.sizing_proven)
            compare_choice(beside, stated, moves)
            beside.finish()
            answered += 1
        lawful = all(segment.get("law", "") not in ("auto", "optimal") for segment in stated["segments"])
        if not answer.designs and lawful:
            radius = sound_anywhere(stated, moves_of(stated, None))
            if radius is not None:
                result.left[f"cam {n} (seed {seed}), {sort}: {answer.summary} A radius of {radius} is sound"] += 1
        if told:
            seconds = time.perf_counter() - begun
            print(f"{n} {sort} {follower} {stated.get('minimize', '')} {seconds:.1f} s: {answer.summary}", flush=True)
    return answered
