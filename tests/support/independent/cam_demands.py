"""Random cams with what else a statement can ask for: every law, polynomials, stretches of constant velocity, automatic
laws, every criterion, conditions and bands of all orders, free and stated dimensions, both senses, and all units.

A statement has one sort of motion; the follower, the dimensions, the units and the load are drawn for each.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any, get_args

import numpy as np

from synthesis.kinds.cam.problem import Criterion
from tests.support.independent.cam_laws import AT_REST, MIRRORED

Statement = dict[str, Any]
Segments = list[Statement]

FOLLOWERS = ("translating_roller", "oscillating_roller", "translating_flat", "oscillating_flat", "barrel_roller")

UNITS = {"mm": 1.0, "cm": 0.1, "m": 1e-3, "in": 1.0 / 25.4}
"""Of the statement, in a millimetre."""

CRITERIA: tuple[str, ...] = get_args(Criterion)

RATES = {"velocity": 2.5, "acceleration": 9.0, "jerk": 75.0}
"""Limits on a motion, of unit lift over unit angle, that a good law keeps."""


class _Draw:
    """One statement in the making: lengths are millimetres until its end, angles of an arm degrees."""

    def __init__(self, rng: np.random.Generator, follower: str) -> None:
        self.rng, self.follower = rng, follower
        self.swings = follower.startswith("oscillating")
        low, high = (6.0, 16.0) if self.swings else (8.0, 30.0)
        self.lift = round(float(rng.uniform(low, high)), 3)
        self.stated: Statement = {"kind": "cam", "include_failed": True}
        self.limits: Statement = {}

    @property
    def unit(self) -> float:
        """A stated displacement times this is what rates are the derivatives of."""
        return math.pi / 180.0 if self.swings else 1.0

    def chance(self, share: float) -> bool:
        return bool(self.rng.random() < share)

    def one(self, names: Any) -> Any:
        return names[int(self.rng.integers(len(names)))]

    def angles(self, count: int) -> list[float]:
        shares = self.rng.uniform(0.5, 1.0, count)
        angles = [round(float(angle), 3) for angle in 360.0 * shares / shares.sum()]
        return [*angles[:-1], 360.0 - sum(angles[:-1])]

    def slowest(self, segments: Segments) -> None:
        """Limits on the rates, by the shortest move."""
        moves = [segment for segment in segments if segment["motion"] in ("rise", "fall", "return")]
        scales = [(self.unit * segment.get("lift", self.lift), math.radians(segment["angle"])) for segment in moves]
        for order, (name, share) in enumerate(RATES.items(), start=1):
            self.limits[name] = share * max(lift / angle**order for lift, angle in scales)


def _double_dwell(draw: _Draw, up: str, down: str) -> Segments:
    angles, lift = draw.angles(4), draw.lift
    falls = {"motion": "fall", "lift": lift} if draw.chance(0.5) else {"motion": "return"}
    return [
        {"motion": "rise", "angle": angles[0], "lift": lift, "law": up},
        {"motion": "dwell", "angle": angles[1]},
        {**falls, "angle": angles[2], "law": down},
        {"motion": "dwell", "angle": angles[3]},
    ]


def _laws(draw: _Draw) -> Segments:
    return _double_dwell(draw, draw.one(AT_REST), draw.one(AT_REST))


def _rise_fall(draw: _Draw) -> Segments:
    """A rise that ends with an acceleration, and the fall that mirrors it."""
    law = draw.one(("double_harmonic", "eighth_power", "simple_harmonic"))
    if law == "simple_harmonic":
        angles = [180.0, 180.0]
    else:
        angle = round(float(draw.rng.uniform(80.0, 140.0)), 3)
        angles = [angle, angle, 360.0 - 2.0 * angle]
    segments: Segments = [
        {"motion": "rise", "angle": angles[0], "lift": draw.lift, "law": law},
        {"motion": "fall", "angle": angles[1], "lift": draw.lift, "law": law},
    ]
    return segments if len(angles) == 2 else [*segments, {"motion": "dwell", "angle": angles[2]}]


def _jumps(draw: _Draw) -> Segments:
    """Accelerations that jump; under a face velocities too, where they go up."""
    draw.stated["accept_discontinuity"] = True
    if draw.follower.endswith("flat") and draw.chance(0.4):
        return _double_dwell(draw, "half_harmonic_end", draw.one(AT_REST))
    laws = ("constant_acceleration", "simple_harmonic", "polynomial_23", "double_harmonic", "eighth_power", *MIRRORED)
    return _double_dwell(draw, draw.one(laws), draw.one(laws))


def _constant_velocity(draw: _Draw) -> Segments:
    """A stretch of constant velocity between two half laws."""
    angles, lift = draw.angles(6), draw.lift
    harmonic = draw.chance(0.3)
    if harmonic:
        draw.stated["accept_discontinuity"] = True
    halves = (
        ("half_harmonic_start", "half_harmonic_end") if harmonic else ("half_cycloidal_start", "half_cycloidal_end")
    )
    share = 0.5 * math.pi if harmonic else 2.0
    parts = np.array([angles[0] / share, angles[1], angles[2] / share])
    lifts = [float(x) for x in lift * parts / parts.sum()]
    middle: Statement = {"motion": "constant_velocity", "angle": angles[1], "lift": lifts[1]}
    if draw.chance(0.5):
        middle = {"motion": "rise", "angle": angles[1], "lift": lifts[1], "law": "constant_velocity"}
    return [
        {"motion": "rise", "angle": angles[0], "lift": lifts[0], "law": halves[0]},
        middle,
        {"motion": "rise", "angle": angles[2], "lift": lifts[2], "law": halves[1]},
        {"motion": "dwell", "angle": angles[3]},
        {"motion": "return", "angle": angles[4], "law": draw.one(AT_REST)},
        {"motion": "dwell", "angle": angles[5]},
    ]


def _up_and_down(draw: _Draw, law: str) -> Segments:
    """A rise and a fall, and a rest or none."""
    angles = draw.angles(2 if draw.chance(0.3) else 3)
    segments: Segments = [
        {"motion": motion, "angle": angle, "lift": draw.lift, "law": law}
        for motion, angle in zip(("rise", "fall"), angles, strict=False)
    ]
    return segments if len(angles) == 2 else [*segments, {"motion": "dwell", "angle": angles[2]}]


def _condition(angle: float, **values: float) -> Statement:
    return {"angle": angle, **values}


def _polynomials(draw: _Draw) -> Segments:
    """Polynomials through conditions at their ends and on the way; some rise and fall in one."""
    lift, rest = draw.lift, {"v": 0.0, "a": 0.0}
    if draw.chance(0.5):
        angles = draw.angles(2)
        place = float(draw.rng.uniform(0.4, 0.6)) * angles[0]
        conditions = [
            _condition(0.0, s=0.0, **rest),
            _condition(place, s=lift, v=0.0),
            _condition(angles[0], s=0.0, **rest),
        ]
        return [
            {"motion": "polynomial", "angle": angles[0], "conditions": conditions},
            {"motion": "dwell", "angle": angles[1]},
        ]
    angles = draw.angles(4)
    share = float(draw.rng.uniform(0.4, 0.6))
    way = _condition(share * angles[0], s=lift * (share + float(draw.rng.uniform(-0.05, 0.05))))
    if draw.chance(0.5):
        way = _condition(0.5 * angles[0], v=1.8 * draw.unit * lift / math.radians(angles[0]), a=0.0)
    up = [_condition(0.0, s=0.0, **rest), way, _condition(angles[0], s=lift, **rest)]
    down = [_condition(0.0, s=lift, **rest), _condition(angles[2], s=0.0, j=0.0, **rest)]
    return [
        {"motion": "polynomial", "angle": angles[0], "conditions": up},
        {"motion": "dwell", "angle": angles[1]},
        {"motion": "polynomial", "angle": angles[2], "conditions": down},
        {"motion": "dwell", "angle": angles[3]},
    ]


def _criterion(draw: _Draw, *left_out: str) -> None:
    """Any criterion that the follower allows."""
    draw.stated["minimize"] = name = draw.one([name for name in CRITERIA if name not in left_out])
    if name == "peak_contact_force":
        draw.stated["dynamics"] = {}


def _automatic(draw: _Draw) -> Segments:
    """Laws that the criterion chooses: alone between rests, beside a constant velocity, or in a row."""
    grooved = ("peak_contact_force",) if draw.follower == "barrel_roller" else ()
    _criterion(draw, *grooved)
    sort = draw.rng.random()
    if sort < 0.4:
        segments = _double_dwell(draw, "auto", "auto" if draw.chance(0.7) else draw.one(AT_REST))
    elif sort < 0.7:
        angles = draw.angles(3)
        segments = [
            {"motion": "constant_velocity", "angle": angles[0], "lift": draw.lift},
            {"motion": "rise", "angle": angles[1], "lift": round(0.6 * draw.lift, 3), "law": "auto"},
            {"motion": "return", "angle": angles[2], "law": "auto"},
        ]
    else:
        segments = _up_and_down(draw, "auto")
    if draw.chance(0.3):
        draw.slowest(segments)
    return segments


def _optimal(draw: _Draw) -> Segments:
    """Motions that are optimized, under limits: between rests, in a row, or beside a constant velocity."""
    left_out = []
    if draw.swings or draw.follower == "barrel_roller":
        left_out.append("size")
    if draw.follower == "barrel_roller":
        left_out.append("peak_contact_force")
    _criterion(draw, *left_out)
    sort = draw.rng.random()
    if sort < 0.6:
        segments = _double_dwell(draw, "optimal", "optimal" if draw.chance(0.7) else draw.one(AT_REST))
        _on_the_way(draw, segments)
        draw.slowest(segments)
    elif sort < 0.8:
        segments = _up_and_down(draw, "optimal")
        draw.slowest(segments)
    else:
        angles = draw.angles(2)
        segments = [
            {"motion": "constant_velocity", "angle": angles[0], "lift": draw.lift},
            {"motion": "return", "angle": angles[1], "law": "optimal"},
        ]
        angle = math.radians(angles[1])
        draw.limits |= {"jerk": 300.0 * draw.unit * draw.lift / angle**3}
    if draw.chance(0.3):
        draw.stated["continuity"] = "jerk"
    return segments


def _on_the_way(draw: _Draw, segments: Segments) -> None:
    """Conditions of one order each, and bands with one end, of the optimized moves."""
    lift = draw.lift
    for segment in segments:
        if segment.get("law") != "optimal":
            continue
        sign = 1.0 if segment["motion"] == "rise" else -1.0
        angle, begin = segment["angle"], 0.0 if sign > 0.0 else lift
        span, travel = math.radians(angle), sign * lift * draw.unit
        sort = int(draw.rng.integers(6))
        if sort == 0:
            segment["conditions"] = [_condition(0.5 * angle, a=0.0), _condition(0.25 * angle, a=4.0 * travel / span**2)]
        elif sort == 1:
            segment["conditions"] = [_condition(0.5 * angle, v=1.7 * travel / span, j=-30.0 * travel / span**3)]
        elif sort == 2:
            segment["conditions"] = [_condition(0.45 * angle, s=begin + sign * 0.42 * lift)]
        elif sort == 3:
            segment["bands"] = [
                {"start": 0.3 * angle, "end": 0.6 * angle, "upper": begin + (0.7 if sign > 0 else -0.3) * lift}
            ]
        elif sort == 4:
            segment["bands"] = [
                {"start": 0.4 * angle, "end": angle, "lower": begin + (0.4 if sign > 0 else -1.0) * lift}
            ]


def _below(draw: _Draw) -> Segments:
    """A fall first, so that displacements are negative; or rises with a rest between them."""
    angles, lift = draw.angles(6), draw.lift
    if draw.chance(0.5):
        angles = draw.angles(4)
        return [
            {"motion": "fall", "angle": angles[0], "lift": lift, "law": draw.one(AT_REST)},
            {"motion": "dwell", "angle": angles[1]},
            {"motion": "rise", "angle": angles[2], "lift": lift, "law": draw.one(AT_REST)},
            {"motion": "dwell", "angle": angles[3]},
        ]
    first = round(float(draw.rng.uniform(0.3, 0.7)) * lift, 3)
    return [
        {"motion": "dwell", "angle": angles[0]},
        {"motion": "rise", "angle": angles[1], "lift": first, "law": draw.one(AT_REST)},
        {"motion": "dwell", "angle": angles[2]},
        {"motion": "rise", "angle": angles[3], "lift": round(lift - first, 3), "law": draw.one(AT_REST)},
        {"motion": "return", "angle": angles[4], "law": draw.one(AT_REST)},
        {"motion": "dwell", "angle": angles[5]},
    ]


SORTS: tuple[tuple[str, Callable[[_Draw], Segments]], ...] = (
    ("every law", _laws),
    ("optimal", _optimal),
    ("automatic", _automatic),
    ("polynomials", _polynomials),
    ("constant velocity", _constant_velocity),
    ("optimal", _optimal),
    ("rise and fall", _rise_fall),
    ("automatic", _automatic),
    ("jumps", _jumps),
    ("below", _below),
)
"""Sorts of motion; those that follow a criterion are asked twice as often."""


def statements(count: int, seed: int) -> Iterator[tuple[str, Statement]]:
    """Sorts of motion in turn, each under every follower; with the sort's name."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        name, motion = SORTS[n % len(SORTS)]
        follower = FOLLOWERS[(n + n // len(SORTS)) % len(FOLLOWERS)]
        draw = _Draw(rng, follower)
        segments = motion(draw)
        stated = draw.stated
        stated |= {"segments": segments, "follower": _follower(draw), "limits": _limits(draw) | draw.limits}
        if draw.chance(0.5):
            stated["rotation"] = "cw"
        if draw.chance(0.2):
            stated["profile_points"] = int(rng.integers(180, 1500))
        optimized = any(segment.get("law") in ("auto", "optimal") for segment in segments)
        if not optimized and "minimize" not in stated and draw.chance(0.6):
            grooved = ("peak_contact_force",) if follower == "barrel_roller" else ()
            _criterion(draw, *grooved)
        if follower in FOLLOWERS[:2] and "dynamics" not in stated and draw.chance(0.2):
            stated["closure"] = "form" if n % 3 else "conjugate"
        if "dynamics" in stated or draw.chance(0.4):
            _loaded(draw)
        yield name, in_units(stated, "mm" if draw.chance(0.4) else draw.one(list(UNITS)))


def _follower(draw: _Draw) -> Statement:
    """Dimensions that are stated, free, or a range."""
    rng, kind = draw.rng, draw.follower
    follower: Statement = {"type": kind}
    given = draw.chance(0.2)
    if kind.endswith("roller"):
        radius = round(float(rng.uniform(3.0, 9.0)), 3)
        ranged = kind != "barrel_roller" and draw.chance(0.25)
        follower["roller_radius"] = {"min": radius, "max": round(1.8 * radius, 3)} if ranged else radius
    if kind == "translating_roller":
        offset = round(float(rng.uniform(-10.0, 10.0)), 3)
        follower["offset"] = "free" if not given and draw.chance(0.35) else offset
        if given:
            follower["prime_radius"] = round(float(rng.uniform(2.5, 5.0)) * draw.lift + 12.0, 3)
    if kind == "oscillating_roller":
        pivot = round(float(rng.uniform(110.0, 140.0)), 3)
        ranged = not given and draw.chance(0.35)
        follower |= {"arm": 90.0, "pivot_distance": {"min": 100.0, "max": pivot + 10.0} if ranged else pivot}
        if given:
            follower["prime_radius"] = round(float(rng.uniform(pivot - 50.0, pivot - 30.0)), 3)
    if kind == "translating_flat" and given:
        follower["base_radius"] = round(float(rng.uniform(3.0, 8.0)) * draw.lift, 3)
    if kind == "oscillating_flat":
        follower |= {"pivot_distance": 180.0, "face_offset": round(float(rng.uniform(-8.0, 8.0)), 3)}
        if given:
            follower["base_radius"] = round(float(rng.uniform(60.0, 100.0)), 3)
    if kind == "barrel_roller" and given:
        follower["cylinder_radius"] = round(float(rng.uniform(2.0, 4.0)) * draw.lift, 3)
    if draw.swings and draw.chance(0.4):
        follower["sense"] = -1
    return follower


def _limits(draw: _Draw) -> Statement:
    rng, limits = draw.rng, {}
    if draw.follower.endswith("flat"):
        limits = {"min_radius": round(float(rng.uniform(0.0, 8.0)), 3)}
        if draw.chance(0.3):
            limits["face_width"] = round(float(rng.uniform(3.0, 6.0)) * (draw.lift if not draw.swings else 12.0), 3)
    else:
        limits = {"pressure_angle": round(float(rng.uniform(25.0, 40.0)), 2)}
        limits["curvature_ratio"] = round(float(rng.uniform(0.0, 3.0)), 2)
        if draw.chance(0.4):
            limits["pressure_angle_fall"] = round(float(rng.uniform(20.0, 50.0)), 2)
    if draw.chance(0.3):
        limits["hub_radius"] = round(float(rng.uniform(5.0, 60.0)), 3)
    if draw.chance(0.2):
        limits["size"] = round(float(rng.uniform(30.0, 200.0)), 3)
    return limits


def _loaded(draw: _Draw) -> None:
    """Mass, spring, damping, and a preload or a least force."""
    rng, stated = draw.rng, draw.stated
    stated["speed_rpm"] = float(rng.uniform(60.0, 600.0))
    dynamics = {"mass": float(rng.uniform(0.2, 3.0))}
    if draw.chance(0.85):
        dynamics["spring_rate"] = float(np.exp(rng.uniform(math.log(0.5), math.log(50.0))))
    if draw.chance(0.5):
        dynamics["damping_ratio"] = float(rng.uniform(0.0, 0.2))
    grooved = stated.get("closure", "force") != "force" or draw.follower == "barrel_roller"
    if not grooved and draw.chance(0.6):
        dynamics["least_force"] = float(rng.uniform(0.0, 50.0))
    if draw.chance(0.4):
        dynamics["preload"] = float(rng.uniform(0.0, 100.0))
    stated["dynamics"] = dynamics
    if not grooved and stated.get("minimize") != "peak_contact_force":
        _sprung(draw, dynamics)


def _sprung(draw: _Draw, dynamics: Statement) -> None:
    """A spring that is free, speeds up to which it holds, a frequency that it has; other draws stay what they were."""
    own = np.random.default_rng(int(1e6 * dynamics["mass"]))
    if own.random() < 0.3:
        dynamics["spring_rate"] = "free"
    elif own.random() < 0.3:
        dynamics["spring_rate"] = {"min": 1.0, "max": 20.0}
    if own.random() < 0.4:
        dynamics["max_rpm"] = round(float(own.uniform(1.0, 1.6)) * draw.stated["speed_rpm"] + 0.01, 2)
    if own.random() < 0.3 and not isinstance(dynamics.get("spring_rate"), dict):
        dynamics["min_frequency_ratio"] = round(float(own.uniform(0.2, 3.0)), 3)
    if own.random() < 0.4:
        dynamics["train_stiffness"] = round(float(own.uniform(100.0, 9000.0)), 1)
        dynamics["train_damping_ratio"] = round(float(own.uniform(0.0, 0.3)), 3)


def in_units(stated: Statement, unit: str) -> Statement:
    """A statement of millimetres in another unit; forces stay the same numbers, for they are of no account here."""
    if unit == "mm":
        return stated
    scale = UNITS[unit]
    follower = stated["follower"]
    swings = follower["type"].startswith("oscillating")

    def scaled(value: Any) -> Any:
        if isinstance(value, dict):
            return {name: scaled(x) for name, x in value.items()}
        return value * scale if isinstance(value, float) else value

    lengths = {name: x if name in ("type", "sense") else scaled(x) for name, x in follower.items()}
    own = {"min_radius", "face_width", "hub_radius", "size", *(() if swings else RATES)}
    limits = {name: x * scale if name in own else x for name, x in stated["limits"].items()}
    segments = stated["segments"] if swings else [_scaled_segment(segment, scale) for segment in stated["segments"]]
    found = {**stated, "length_unit": unit, "follower": lengths, "limits": limits, "segments": segments}
    if "dynamics" in stated and "spring_rate" in stated["dynamics"]:
        rate = stated["dynamics"]["spring_rate"]
        if isinstance(rate, dict):
            rate = {name: x / scale for name, x in rate.items()}
        rate = rate / scale if isinstance(rate, float) else rate
        found["dynamics"] = {**stated["dynamics"], "spring_rate": rate}
    if unit == "in" and "dynamics" in stated:
        # lbf s²/in where kilograms and metres were meant.
        found["dynamics"] = {**found["dynamics"], "mass": found["dynamics"]["mass"] * 1e-3 / scale}
    return found


def _scaled_segment(segment: Statement, scale: float) -> Statement:
    """Displacements and their derivatives in another unit."""
    found = dict(segment)
    if "lift" in found:
        found["lift"] *= scale
    for name in ("conditions", "bands"):
        if name in found:
            kept = ("angle", "start", "end")
            found[name] = [{key: x if key in kept else x * scale for key, x in each.items()} for each in found[name]]
    return found
