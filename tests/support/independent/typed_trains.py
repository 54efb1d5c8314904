"""Trains of typed stages by loops over their gears: spur, helical, rings, bevel and worm gears, each looked at by
itself.

Nothing is shared with the solver. A ring is tried with its pinion by turning the pinion through its mesh: corners of
teeth are followed as points, and a pair counts where no corner comes into the other gear's teeth. Trains are compared
as fractions, and a train is told from others by which gears drive and which are driven in stages that are stated alike.
"""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from functools import cache
from random import Random
from typing import Any, NamedTuple

DEFAULT_MOST = 100


class Nearest(NamedTuple):
    """The nearest train: signed ratio, relative error, size, and how many trains are exactly as near."""

    ratio: Fraction
    error: Fraction
    size: int
    ties: int


def sense(stage: dict[str, Any]) -> int:
    """Sign that a stage gives the speed, about axes along the power; worm gears by the hand of the worm."""
    kind = stage["type"]
    if kind == "worm":
        return -1 if stage.get("hand") == "left" else 1
    return {"external": -1, "helical": -1, "internal": 1, "bevel": 1}[kind]


def _fewest(stage: dict[str, Any], angle: float) -> int:
    """Fewest teeth whose flank reaches the base circle beyond the rack's tip line, counted upwards."""
    beta = math.radians(stage.get("helix_angle") or 0.0)
    phi = math.atan(math.tan(angle) / math.cos(beta))
    teeth = 3
    while 0.5 * teeth / math.cos(beta) * math.sin(phi) ** 2 < 1.0 - 1e-12:
        teeth += 1
    return teeth


def _limits(statement: dict[str, Any], number: int, place: int) -> tuple[int, int]:
    stage = statement["stages"][number]
    stated = stage.get(("driver", "driven")[place])
    if stated is not None:
        return (stated, stated) if isinstance(stated, int) else (stated["min"], stated["max"])
    teeth = statement.get("teeth") or {}
    if isinstance(teeth, list):
        teeth = teeth[2 * number + place]
    least = teeth.get("min")
    angle = math.radians(statement.get("pressure_angle", 20.0))
    return _fewest(stage, angle) if least is None else least, teeth.get("max", DEFAULT_MOST)


def _involute(angle: float) -> float:
    return math.tan(angle) - angle


@cache
def _start(teeth: int, phi: float) -> float:
    """Where the involute of a rack-cut gear begins, along the line of action; an undercut one by a walk up its "
    "fillet."""
    deep = 1.25
    wide = 0.25 * math.pi - deep * math.tan(phi)
    rounding = min(0.38, wide * math.cos(phi) / (1.0 - math.sin(phi)))
    straight = 0.5 * teeth * math.sin(phi) - (deep - rounding * (1.0 - math.sin(phi))) / math.sin(phi)
    if straight >= 0.0:
        return straight
    r, base = 0.5 * teeth, 0.5 * teeth * math.cos(phi)
    beside = wide + rounding * (math.tan(phi) - 1.0 / math.cos(phi))
    below = deep - rounding

    def point(psi: float) -> tuple[float, float]:
        x, y = r - below - rounding * math.cos(psi), below * math.tan(psi) + rounding * math.sin(psi)
        turn = -(below * math.tan(psi) - beside) / r
        return math.hypot(x, y), math.atan2(y, x) + turn

    def space(radius: float) -> float:
        return 0.5 * math.pi / teeth - _involute(phi) + _involute(math.acos(min(1.0, base / radius)))

    # From the end of the fillet, which lies in the space, back to where it enters the flank.
    high, steps = 0.5 * math.pi - phi, 20000
    last = high
    for k in range(steps, -1, -1):
        psi = high * k / steps
        radius, angle = point(psi)
        if radius <= base or angle > space(radius):
            break
        last = psi
    low = max(last - high / steps, 0.0)
    for _ in range(60):
        middle = 0.5 * (low + last)
        radius, angle = point(middle)
        low, last = (middle, last) if radius <= base or angle > space(radius) else (low, middle)
    return math.sqrt(max(point(last)[0] ** 2 - base**2, 0.0))


@cache
def runs_in_ring(pinion: int, ring: int, angle: float) -> bool:
    """Whether a full-depth pinion runs in a ring whose teeth are cut short for the pinion's fillet."""
    if ring <= pinion:
        return False
    line = 0.5 * (ring - pinion) * math.sin(angle)
    base, ring_base = 0.5 * pinion * math.cos(angle), 0.5 * ring * math.cos(angle)
    least = math.hypot(ring_base, line + _start(pinion, angle))
    addendum = min(1.0, math.floor((0.5 * ring - least) * 1e6) / 1e6)
    if addendum < 0.3:
        return False
    inner, outer = 0.5 * ring - addendum, 0.5 * pinion + 1.0
    reach = math.sqrt(outer**2 - base**2)
    along = math.sqrt(inner**2 - ring_base**2) if inner > ring_base else 0.0
    if reach + line - along < math.pi * math.cos(angle) * (1.0 - 1e-12):
        return False
    teeth = min(20, ring // 2)
    cutter = 0.5 * (ring - teeth) * math.sin(angle) + math.sqrt(
        (0.5 * teeth + 1.25) ** 2 - (0.5 * teeth * math.cos(angle)) ** 2
    )
    if line + reach > cutter + 1e-12 * ring:
        return False
    # The cutter that shapes the ring is turned through it as the pinion is.
    if along < 0.5 * (ring - teeth) * math.sin(angle):
        return False
    if not _corners_pass(teeth, ring, angle, inner, 0.5 * teeth + 1.25):
        return False
    return _corners_pass(pinion, ring, angle, inner, outer)


def _corners_pass(pinion: int, ring: int, angle: float, inner: float, outer: float) -> bool:
    """Whether the tip corners of the pinion stay out of the ring's teeth all the way round.

    In the frame of the ring the pinion's corner is followed as a point; where it is farther out than the ring's tips it
    has to lie in a space of the ring.
    """
    apart = 0.5 * (ring - pinion)
    base, ring_base = 0.5 * pinion * math.cos(angle), 0.5 * ring * math.cos(angle)
    if inner >= apart + outer:
        return True
    if inner < ring_base:
        return False
    corner = 0.5 * math.pi / pinion + _involute(angle) - _involute(math.acos(base / outer))
    turned, step = 0.0, 1e-3
    # From where the corner is on the line of centres outwards until it has left the ring's teeth.
    while turned < math.pi:
        x, y = apart + outer * math.cos(turned), outer * math.sin(turned)
        radius = math.hypot(x, y)
        if radius <= inner:
            return True
        # The pinion has turned so that its corner, ahead of its tooth's middle, is here; a space of the ring was there.
        middle = (turned - corner) * pinion / ring
        half = 0.5 * math.pi / ring + _involute(angle) - _involute(math.acos(ring_base / radius))
        ahead = math.atan2(y, x) - middle
        if ahead > half + 1e-7:
            return False
        turned += step
    return True


def allowed(statement: dict[str, Any], number: int) -> list[tuple[int, int]]:
    """Driver and driven gears of a stage that keep all demands on one mesh."""
    stage = statement["stages"][number]
    angle = math.radians(statement.get("pressure_angle", 20.0))
    (low, high), (least, most) = _limits(statement, number, 0), _limits(statement, number, 1)
    found = []
    for a, b in itertools.product(range(low, high + 1), range(least, most + 1)):
        if statement.get("hunting_tooth") == "require" and math.gcd(a, b) > 1:
            continue
        limit = statement.get("max_stage_ratio")
        if limit is not None and stage["type"] != "worm" and Fraction(max(a, b), min(a, b)) > Fraction(str(limit)):
            continue
        if stage["type"] == "internal":
            pinion, ring = (b, a) if stage.get("ring") == "driver" else (a, b)
            if not runs_in_ring(pinion, ring, angle):
                continue
        if stage["type"] == "bevel":
            small, large = min(a, b), max(a, b)
            if small / large + math.cos(math.radians(stage.get("shaft_angle", 90.0))) <= 1e-6:
                continue
        found.append((a, b))
    return found


def _distance(stage: dict[str, Any], a: int, b: int, module: float) -> float:
    count = abs(b - a) if stage["type"] == "internal" else a + b
    return 0.5 * module * count / math.cos(math.radians(stage.get("helix_angle") or 0.0))


def _written_out(stage: dict[str, Any]) -> dict[str, Any]:
    """What tells stages apart, with what is usual where nothing is said."""
    usual: dict[str, dict[str, Any]] = {
        "internal": {"ring": "driven"},
        "bevel": {"shaft_angle": 90.0},
        "worm": {"diameter_quotient": 10.0, "hand": "right", "friction": 0.05},
    }
    said = {k: v for k, v in stage.items() if k not in ("driver", "driven", "face_width") and v is not None}
    return usual.get(stage["type"], {}) | said


def nearest(statement: dict[str, Any]) -> Nearest | None:
    """The nearest train of a statement whose ratio is rational; None where there is none within the tolerance."""
    stages = statement["stages"]
    alike = [_written_out(stage) for stage in stages]
    rows = [allowed(statement, number) for number in range(len(stages))]
    target = Fraction(statement["ratio"])
    sign = math.prod(sense(stage) for stage in stages)
    trains: dict[Any, tuple[Fraction, int]] = {}
    modules = statement.get("module", 1.0)
    choices = modules if isinstance(modules, list) and statement.get("reverted") else [1.0]
    for meshes in itertools.product(*rows):
        gears = [n for mesh in meshes for n in mesh]
        if sum(gears) > statement.get("max_total_teeth", math.inf):
            continue
        ratio = Fraction(math.prod(b for _, b in meshes), math.prod(a for a, _ in meshes))
        size = max(gears) if statement.get("size") == "largest_gear" else sum(gears)
        groups = [alike.index(one) for one in alike]
        if not statement.get("reverted"):
            key: Any = tuple(tuple(sorted(zip(groups, side, strict=True))) for side in zip(*meshes, strict=True))
            trains[key] = ratio, size
            continue
        for picked in itertools.product(choices, repeat=len(stages)):
            apart = [_distance(s, *mesh, m) for s, mesh, m in zip(stages, meshes, picked, strict=True)]
            if max(apart) - min(apart) <= 1e-12 * max(apart):
                trains[tuple(sorted(zip(groups, meshes, picked, strict=True)))] = ratio, size
    if not trains:
        return None
    errors = {key: abs(ratio / abs(target) - 1) for key, (ratio, _) in trains.items()}
    least = min(errors.values())
    tolerance = statement.get("tolerance")
    ratios = [ratio for ratio, _ in trains.values()]
    if tolerance is not None:
        if least > Fraction(str(tolerance)):
            return None
    elif not min(ratios) <= abs(target) <= max(ratios) and least > Fraction(1, 100):
        return None
    best = min((size, ratio) for key, (ratio, size) in trains.items() if errors[key] == least)
    ties = sum(error == least for error in errors.values())
    return Nearest(sign * best[1], least, best[0], ties)


def same_answer(answer: dict[str, Any], best: Nearest | None) -> str | None:
    """What the solver's answer has that the brute force has not; None where they agree."""
    designs = answer["designs"]
    if not answer["search"]["complete"]:
        return "the search is not complete"
    if not designs or best is None:
        return None if not designs and best is None else f"answer {bool(designs)}, brute force {best}"
    made, metrics = designs[0]["mechanism"]["ratio"], designs[0]["metrics"]
    ratio = Fraction(made["numerator"], made["denominator"])
    if not designs[0]["verification"]["passed"]:
        return "the design is not verified"
    if abs(abs(metrics["relative_error"]) - best.error) > 1e-12 or (ratio > 0) != (best.ratio > 0):
        return f"{ratio} against {best}"
    if answer["search"]["ties"] != best.ties:
        return f"{answer['search']['ties']} ties against {best.ties}"
    gears = [stage[name] for stage in designs[0]["mechanism"]["stages"] for name in ("driver", "driven")]
    if best.size not in (sum(gears), max(gears)):
        return f"size {sum(gears)} or {max(gears)} against {best}"
    return None


def statements(number: int, seed: int) -> list[dict[str, Any]]:
    """Random tasks of one to three stages of all types, some of which nothing fulfils."""
    rng, stated = Random(seed), []
    for k in range(number):
        count = rng.choice([1, 2, 2, 2, 3])
        reverted = k % 4 == 1 and count > 1
        kinds = ["external", "internal", "helical", *([] if reverted else ["bevel", "worm"])]
        stages = [_drawn_stage(rng, rng.choice(kinds), count) for _ in range(count)]
        if reverted:
            angle = rng.choice([10.0, 20.0])
            for stage in stages:
                if stage["type"] == "helical":
                    stage["helix_angle"] = rng.choice([-angle, angle])
        if count > 1 and rng.random() < 0.3:
            stages[1] = dict(stages[0])
        least = rng.randint(12, 24)
        statement: dict[str, Any] = {
            "kind": "gear_train",
            "ratio": "1",
            "stages": stages,
            "teeth": {"min": least, "max": least + (rng.randint(6, 9) if count == 3 else rng.randint(10, 26))},
            "pressure_angle": rng.choice([20.0, 20.0, 25.0]),
            "max_designs": 3,
        }
        statement["ratio"] = _drawn_ratio(rng, statement)
        _demand(rng, statement, reverted, count)
        stated.append(statement)
    return stated


def _drawn_ratio(rng: Random, statement: dict[str, Any]) -> str:
    """A ratio that gears of the stages have, whether or not they may mesh, or one near it."""
    ratio = Fraction(1)
    for number in range(len(statement["stages"])):
        driver, driven = (rng.randint(*_limits(statement, number, place)) for place in (0, 1))
        ratio *= Fraction(driven, driver)
    if rng.random() < 0.6:
        ratio = (ratio * Fraction(rng.uniform(0.9, 1.1))).limit_denominator(200) or Fraction(1)
    return f"{ratio.numerator}/{ratio.denominator}"


def _drawn_stage(rng: Random, kind: str, count: int) -> dict[str, Any]:
    stage: dict[str, Any] = {"type": kind}
    if kind == "internal":
        if rng.random() < 0.3:
            stage["ring"] = "driver"
        low = rng.randint(40, 60)
        stage["driver" if "ring" in stage else "driven"] = {"min": low, "max": low + (8 if count == 3 else 30)}
    if kind == "helical":
        stage["helix_angle"] = rng.choice([-1, 1]) * rng.choice([8.0, 15.0, 23.5, 30.0])
    if kind == "bevel":
        stage["shaft_angle"] = rng.choice([60.0, 90.0, 120.0])
        stage["driver"], stage["driven"] = rng.randint(14, 30), {"min": 20, "max": rng.randint(20, 40)}
    if kind == "worm":
        stage["hand"] = rng.choice(["left", "right"])
        stage["driver"], stage["driven"] = rng.randint(1, 6), {"min": 30, "max": rng.randint(30, 50)}
    return stage


def _demand(rng: Random, statement: dict[str, Any], reverted: bool, count: int) -> None:
    if reverted:
        statement["reverted"] = True
        if rng.random() < 0.4 and count == 2:
            statement["module"] = [1.0, 1.25, 2.0]
    if rng.random() < 0.2:
        statement["hunting_tooth"] = "require"
    if rng.random() < 0.2:
        statement["max_stage_ratio"] = round(rng.uniform(1.2, 4.0), 2)
    if rng.random() < 0.2:
        statement["max_total_teeth"] = rng.randint(60, 300)
    if rng.random() < 0.2:
        statement["size"] = "largest_gear"
    if rng.random() < 0.3:
        statement["tolerance"] = 10.0 ** rng.randint(-5, -2)
