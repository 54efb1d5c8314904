"""Answers measured by another route than that of the service: every number that both have, and how far they differ.

Linkages: random ordinary tasks (:mod:`benchmarks.demands.ordinary`) are solved; each pin-jointed fourbar of an answer
is rebuilt from the joints of its skeleton alone and driven by Newton's iteration on its two rigid lengths, in steps of
the input from the first target on; extremes over the way are closed in between the steps. Compared so far are answers
about positions and open paths, and quick returns. Cams: random double dwells by laws written out here (Norton, §8.3)
under all followers; pitch curve and profile are those of the textbooks' formulas, at 40 001 angles of each move.

Differences are relative to the scale of each quantity: a right angle for angles, the size for lengths, the value itself
for radii. What an answer states and this does not compare is listed, and so are designs of other types.

    python -m benchmarks.independent --answers 200 --cams 50
"""

from __future__ import annotations

import argparse
import math
from collections import Counter, defaultdict
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.demands.ordinary import tasks
from synthesis.dispatch import solve
from synthesis.registry import parse_problem

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

AGREE = 1e-6
"""Difference, relative to the scale of the quantity, up to which two values are the same."""

STEPS = 1440
"""Steps of the input along the way of a linkage."""

NEWTON = 8
"""Iterations from one step to the next: quadratic convergence needs four."""

NARROWINGS = 60
"""Steps of the golden section that closes in an extreme between two steps."""

DENSE = 40_001
"""Angles of each move of a cam: an extreme between two of them is missed by less than 1e-8 of itself."""


class Difference(NamedTuple):
    """A quantity, how far it differs relative to its scale, and of which design."""

    metric: str
    value: float
    name: str


class Measured:
    """All differences, and what was not compared."""

    def __init__(self) -> None:
        self.differences: dict[str, list[Difference]] = defaultdict(list)
        self.left: Counter[str] = Counter()

    def add(self, metric: str, stated: float | None, found: float, scale: float, name: str) -> None:
        """Compare a stated value; one that is not stated is not compared."""
        if stated is not None:
            self.differences[metric].append(Difference(metric, abs(stated - found) / scale, name))

    def leave(self, design: Any, compared: set[str]) -> None:
        """List the metrics and checks of a design that were not compared."""
        stated = {name for name, value in design.metrics.model_dump().items() if isinstance(value, float)}
        stated |= {f"check {c.name}" for c in design.verification.checks if c.value is not None}
        self.left.update(f"{design.mechanism.type}: {name}" for name in stated - compared)

    @property
    def over(self) -> list[Difference]:
        """Differences of more than :data:`AGREE`, the worst first."""
        found = [d for group in self.differences.values() for d in group if not d.value <= AGREE]
        return sorted(found, key=lambda d: -d.value)

    def report(self) -> str:
        """A line for each quantity."""
        lines = []
        for metric, group in sorted(self.differences.items()):
            worst = max(group, key=lambda d: d.value if d.value == d.value else math.inf)
            over = sum(not d.value <= AGREE for d in group)
            lines.append(f"{metric:34s} {len(group):6d} compared, worst {worst.value:.1e}, {over} over {AGREE:g}")
        lines += [f"  over: {d.metric} {d.value:.1e} {d.name}" for d in self.over[:40]]
        lines += [f"  not compared: {name} ({count})" for name, count in sorted(self.left.items())]
        return "\n".join(lines)


# Linkages


class Drive:
    """A fourbar driven from its skeleton: B keeps its distances from A and O4."""

    def __init__(self, skeleton: Any) -> None:
        at = {name: complex(*place) for name, place in skeleton.joints.items()}
        self.o2, self.o4, self.a, self.b = (at[name] for name in ("O2", "O4", "A", "B"))
        self.p = at.get("P", self.a)
        self.coupler, self.output = abs(self.b - self.a), abs(self.b - self.o4)
        self.reference = math.atan2((self.a - self.o2).imag, (self.a - self.o2).real)

    def stand(self, turn: float, b: complex) -> complex:
        """B after the input has turned from the reference, from a place near it; NaN where it does not close."""
        a = self.o2 + (self.a - self.o2) * np.exp(1j * turn)
        for _ in range(NEWTON):
            u, w = b - a, b - self.o4
            f, g = 0.5 * (abs(u) ** 2 - self.coupler**2), 0.5 * (abs(w) ** 2 - self.output**2)
            det = u.real * w.imag - u.imag * w.real
            if det == 0.0:
                return complex(math.nan, math.nan)
            b -= complex(f * w.imag - g * u.imag, u.real * g - w.real * f) / det
        closed = abs(abs(b - a) - self.coupler) + abs(abs(b - self.o4) - self.output)
        return b if closed <= 1e-9 * (self.coupler + self.output) else complex(math.nan, math.nan)

    def along(self, turns: Real) -> Complex:
        """B at turns that follow each other closely, from the reference on: the first is zero."""
        places = np.empty(len(turns), np.complex128)
        places[0] = b = self.b
        for k in range(1, len(turns)):
            ahead = 2.0 * b - places[k - 2] if k > 1 else b
            b = places[k] = self.stand(float(turns[k]), ahead)
        return places

    def joints(self, turn: float, b: complex) -> tuple[complex, complex]:
        """A and P."""
        a = self.o2 + (self.a - self.o2) * np.exp(1j * turn)
        return a, a + (self.p - self.a) * (b - a) / (self.b - self.a)

    def transmission(self, turn: float, b: complex) -> float:
        """Acute angle between coupler and output, radians."""
        a, _ = self.joints(turn, b)
        angle = abs(np.angle((a - b) / (self.o4 - b)))
        return float(min(angle, math.pi - angle))


def closed_in(function: Any, low: float, middle: float, high: float) -> float:
    """The least value between two places around the least of three, by golden section."""
    share = 0.5 * (math.sqrt(5.0) - 1.0)
    least = function(middle)
    for _ in range(NARROWINGS):
        left, right = high - share * (high - low), low + share * (high - low)
        at_left, at_right = function(left), function(right)
        least = min(least, at_left, at_right)
        if at_left < at_right:
            high = right
        else:
            low = left
    return float(least)


def least_over(drive: Drive, turns: Real, places: Complex, value: Any) -> float:
    """The least of a function of turn and B over a way, closed in at each local minimum of the steps near the least."""
    values = np.array([value(float(t), complex(b)) for t, b in zip(turns, places, strict=True)])
    least = float(values.min())
    for k in range(1, len(turns) - 1):
        if values[k] <= values[k - 1] and values[k] <= values[k + 1] and values[k] <= least + 1e-2:

            def at(turn: float, k: int = k) -> float:
                return float(value(turn, drive.stand(turn, complex(places[k]))))

            least = min(least, closed_in(at, float(turns[k - 1]), float(turns[k]), float(turns[k + 1])))
    return least


def compare_fourbar(result: Measured, stated: dict[str, Any], design: Any, name: str) -> None:
    """Whatever a fourbar's answer states and its skeleton shows."""
    drive, metrics = Drive(design.mechanism.skeleton), design.metrics
    links = [abs(drive.o4 - drive.o2), abs(drive.a - drive.o2), drive.coupler, drive.output]
    compared = {"link_ratio"}
    result.add("link_ratio", metrics.link_ratio, max(links) / min(links), max(links) / min(links), name)
    targets = getattr(design, "targets", None) or []
    inputs = np.radians([target.input_angle for target in targets if target.input_angle is not None])
    same_branch = getattr(metrics, "same_branch", False) and getattr(metrics, "visits_in_order", False)
    if len(inputs) >= 2 and same_branch and stated["kind"] in ("motion", "path") and not stated.get("closed"):
        compared |= {"min_transmission_angle", "input_rotation", "targets"}
        turns = inputs - inputs[0]
        result.add("input_rotation", metrics.input_rotation, math.degrees(turns[-1]), 360.0, name)
        off = (inputs[0] - drive.reference + math.pi) % math.tau - math.pi
        result.add("input_angle of the first target", 0.0, off, 1.0, name)
        way = np.union1d(np.linspace(0.0, turns[-1], STEPS), turns)
        way = way if turns[-1] >= 0.0 else way[::-1]
        places = drive.along(way)
        least = math.degrees(least_over(drive, way, places, drive.transmission))
        result.add("min_transmission_angle", metrics.min_transmission_angle, least, 90.0, name)
        poses = stated["positions" if stated["kind"] == "motion" else "points"]
        if not any("tolerance" in pose for pose in poses) and design.verification.passed:
            wide = max(abs(complex(q["x"] - poses[0]["x"], q["y"] - poses[0]["y"])) for q in poses)
            exact = [c.value for c in design.verification.checks if c.name == "reaches_targets"]
            for turn, pose in zip(turns, poses, strict=True) if exact else ():
                b = complex(places[np.abs(way - turn).argmin()])
                _, p = drive.joints(float(turn), b)
                result.add("targets, position", 0.0, abs(p - complex(pose["x"], pose["y"])), wide, name)
    if stated["kind"] == "quick_return" and hasattr(metrics, "time_ratio"):
        compared |= {"time_ratio", "swing", "min_transmission_angle"}
        whole = np.linspace(0.0, math.tau, STEPS + 1)
        places = drive.along(whole)
        swings = np.unwrap(np.angle(places - drive.o4))
        ends = []
        for sign in (1.0, -1.0):
            k = int((sign * swings)[:-1].argmin())
            low, high = float(whole[k] - whole[1]), float(whole[k] + whole[1])

            def output(turn: float, k: int = k, sign: float = sign) -> float:
                b = drive.stand(turn, complex(places[k]))
                return sign * (float(swings[k]) + float(np.angle((b - drive.o4) / (places[k] - drive.o4))))

            def slope(turn: float, k: int = k) -> float:
                b = drive.stand(turn, complex(places[k]))
                a, _ = drive.joints(turn, b)
                # The output stands still where crank and coupler are in line.
                return float(((a - drive.o2) * np.conj(b - a)).imag)

            falls = slope(low) > 0.0
            for _ in range(NARROWINGS):
                middle = 0.5 * (low + high)
                if (slope(middle) > 0.0) == falls:
                    low = middle
                else:
                    high = middle
            ends.append((0.5 * (low + high), output(0.5 * (low + high))))
        apart = (ends[1][0] - ends[0][0]) % math.tau
        ratio = max(apart, math.tau - apart) / min(apart, math.tau - apart)
        result.add("time_ratio", metrics.time_ratio, ratio, ratio, name)
        if getattr(metrics, "swing", None) is not None:
            result.add("swing", metrics.swing, math.degrees(-ends[1][1] - ends[0][1]), 90.0, name)
        least = math.degrees(least_over(drive, whole, places, drive.transmission))
        result.add("min_transmission_angle", metrics.min_transmission_angle, least, 90.0, name)
    result.leave(design, compared)


def linkages(answers: int, kinds: tuple[str, ...], seed: int, result: Measured) -> int:
    """Solve ordinary tasks and compare their designs until so many designs are compared."""
    count = 0
    for task in tasks(100 * answers, seed):
        if kinds and task.statement["kind"] not in kinds:
            continue
        for k, design in enumerate(solve(parse_problem(task.statement)).designs):
            if design.mechanism.type == "fourbar":
                compare_fourbar(result, task.statement, design, f"{task.name}, design {k}")
            else:
                result.left[f"designs of type {design.mechanism.type}"] += 1
            count += 1
        if count >= answers:
            break
    return count


# Cams


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


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--answers", type=int, default=200)
    parser.add_argument("--cams", type=int, default=50)
    parser.add_argument("--kinds", default="", help="kinds of linkage problems, with commas; all if left out")
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    result = Measured()
    kinds = tuple(filter(None, args.kinds.split(",")))
    designs = linkages(args.answers, kinds, args.seed, result) if args.answers else 0
    answered = cams(args.cams, args.seed, result)
    print(f"{designs} designs of linkages, {answered} of {args.cams} cams")
    print(result.report())


if __name__ == "__main__":
    main()
