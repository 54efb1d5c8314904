"""What answers about cams state, from motion and dimensions (Norton §8.6–8.7, §15.2; Rao §5.4–5.6)."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from tests.support.independent.cam_curves import compare_curves
from tests.support.independent.cam_motion import Move, greatest, least, mean, motion_at, turned
from tests.support.independent.cam_pairs import compare_pair, compare_pushing
from tests.support.independent.cam_springs import Moved, compare_springs
from tests.support.independent.cam_verdicts import compare_roller, compare_smallest, compare_verdicts, sound_radius
from tests.support.independent.comparison import AGREE, Beside
from tests.support.independent.quantities import stated_by

RATES = ("velocity", "acceleration", "jerk")

CONTINUOUS = 1e-6
"""A step up to this share of a rate's peak is none."""

WINDOWS = {"acceleration": (2, 4), "jerk": (3, 8)}
"""Orders of the differences that a check of a peak takes, and their strides, in steps of which a segment has 320."""

ROUNDED = 1e-10
"""Share of the greatest force that is rounding."""

STEPS = 320

STILL = 1e-10
"""Share of the greatest velocity that is rounding where the follower turns back: it rises and falls there."""


class Turn(NamedTuple):
    """The motion over the turn: pieces of all segments that have as many points, stacked, shape (pieces, points)."""

    at: Real
    s: Real
    v: Real
    a: Real
    j: Real


SHARES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 1.0}
"""Of a mass in its effect: newtons ask for metres; pounds of force and their mass for inches."""


def compare_cam(beside: Beside, stated: dict[str, Any], moves: list[Move], proven: bool = False) -> None:
    """Compare metrics, segments, joints, curves and checks of a cam; ``proven``: the answer says none is smaller."""
    design = beside.design
    moves = [turned(move) for move in moves]
    turn = Turn(*(np.concatenate([getattr(move, name) for move in moves]) for name in ("at", "s", "v", "a", "j")))
    unit = math.pi / 180.0 if stated["follower"]["type"].startswith("oscillating") else 1.0
    lift = float(np.ptp(turn.s))
    _compare_motion(beside, turn, moves, lift / unit)
    _compare_segments(beside, moves, unit)
    _compare_joints(beside, moves, unit)
    force = _compare_forces(beside, stated, turn)
    _compare_criterion(beside, stated, moves, force)
    compare_curves(beside, moves, unit)
    found = _shape(turn, design.mechanism)
    if _undercut(found, design.mechanism):
        # A profile that crosses itself has no metrics.
        beside.same("checks.passed", design.verification.passed, False)
        beside.compared |= {name for name in stated_by(design) if name.startswith(("metrics.", "checks."))}
        return
    known = _compare_program(beside, stated, moves, lift)
    for name, value in found.items():
        # A hollow hundreds of times as flat as the cam is large is compared by its curvature.
        scale = 90.0 if "angle" in name else value
        scale *= max(1.0, value / 1000.0) if name == "min_concave_radius" else 1.0
        beside.metric(name, value, scale)
    values = _checked(found, design.mechanism)
    for check, value in values.items():
        beside.check(check, value, 90.0 if "angle" in check else value)
    beside.check("convex", "min_concave_radius" not in found)
    if force is not None:
        known["contact_force"] = force[0]
    compare_verdicts(beside, stated, values | known)
    if proven:
        compare_smallest(beside, stated, lift, lambda other: _checked(_shape(turn, other), other))
    if getattr(design.mechanism, "second", None) is not None:
        inverse = Turn(turn.at, greatest(turn.s) - turn.s, -turn.v, -turn.a, -turn.j)
        compare_pair(beside, lambda other: _shape(inverse, other))
    if "curvature_ratio" in found and stated.get("closure") != "conjugate":
        compare_roller(beside, stated, found["curvature_ratio"] * design.mechanism.follower.roller_radius)
    _compare_shape(beside, turn)


def sound_anywhere(stated: dict[str, Any], moves: list[Move]) -> float | None:
    """A radius with which a cam keeps all limits but that of its size; None where none is found on a grid."""
    turn = Turn(*(np.concatenate([getattr(move, name) for move in moves]) for name in ("at", "s", "v", "a", "j")))
    return sound_radius(stated, float(np.ptp(turn.s)), lambda other: _checked(_shape(turn, other), other))


CHECKED = {"pressure_angle": "max_pressure_angle_rise", "pressure_angle_fall": "max_pressure_angle_fall"}
CHECKED |= {"curvature_ratio": "curvature_ratio", "face_width": "face_width", "clears_pivot": "size"}
CHECKED |= {"min_radius": "min_convex_radius"}
"""Checks whose value is a metric."""


def _shape(turn: Turn, mechanism: Any) -> dict[str, float]:
    """The metrics of a cam that follow from its shape; none where its dimensions make no cam."""
    with np.errstate(invalid="ignore", divide="ignore"):
        try:
            found = _barrel(turn, mechanism) if mechanism.type == "barrel_cam" else _radial(turn, mechanism)
        except ValueError:
            return {}
    return found if all(math.isfinite(value) for value in found.values()) else {}


def _checked(found: dict[str, float], mechanism: Any) -> dict[str, float]:
    """Values by the names of the checks that have them; none where there is no cam."""
    if not found:
        return {}
    values = {check: found[name] for check, name in CHECKED.items() if name in found}
    if mechanism.type == "barrel_cam":
        return values | {"hub_radius": mechanism.cylinder_radius, "size": mechanism.cylinder_radius}
    size = mechanism.prime_radius or mechanism.base_radius
    return values | {"hub_radius": size - (mechanism.follower.roller_radius or 0.0), "size": size}


def _undercut(found: dict[str, float], mechanism: Any) -> bool:
    """Whether a roller or a face cannot touch the profile that it would have to."""
    if not found:
        return True
    if mechanism.type == "barrel_cam":
        return found["curvature_ratio"] <= 1.0
    return found["min_convex_radius"] <= 0.0


def _compare_motion(beside: Beside, turn: Turn, moves: list[Move], lift: float) -> None:
    beside.metric("lift", lift, lift)
    for name, values in zip(RATES, (turn.v, turn.a, turn.j), strict=True):
        peak = greatest(np.abs(values))
        beside.metric(f"peak_{name}", peak, peak)
    rms = math.sqrt(mean(moves, [move.a**2 for move in moves]))
    beside.metric("rms_acceleration", rms, rms)
    torque = greatest(np.abs(turn.v * turn.a))
    beside.metric("peak_inertia_torque", torque, torque)


def _compare_segments(beside: Beside, moves: list[Move], unit: float) -> None:
    """Where each segment begins, what it does, and its peaks."""
    heights = max(float(np.abs(move.s).max()) for move in moves) / unit
    for segment, move in zip(beside.design.segments, moves, strict=True):
        beside.add("segments.start", segment.start, math.degrees(move.start), 360.0)
        beside.add("segments.angle", segment.angle, math.degrees(move.angle), 360.0)
        for height, at in zip(segment.displacement, (move.s[0, 0], move.s[-1, -1]), strict=True):
            beside.add("segments.displacement", height, float(at) / unit, heights)
        for order, name in enumerate(RATES, start=1):
            peak = greatest(np.abs(move.rates(order)))
            beside.add(f"segments.peak_{name}", getattr(segment, f"peak_{name}"), peak, peak)


def _compare_joints(beside: Beside, moves: list[Move], unit: float) -> None:
    """What steps at a joint, and what is continuous there."""
    peaks = [max(greatest(np.abs(move.rates(order))) for move in moves) for order in range(4)]
    for joint in beside.design.joints:
        before, after = _sides(moves, math.radians(joint.angle))
        beside.add("joints.angle", joint.angle, math.degrees(after[0]), 360.0)
        for order, name in enumerate("svaj"):
            step = after[1 + order] - before[1 + order]
            step = step if abs(step) > CONTINUOUS * peaks[order] or order == 3 else 0.0
            scale = peaks[order] / (unit if order == 0 else 1.0)
            beside.add(f"joints.jump.{name}", getattr(joint.jump, name), step / (unit if order == 0 else 1.0), scale)
            if abs(abs(step) - CONTINUOUS * peaks[order]) > 0.5 * CONTINUOUS * peaks[order]:
                beside.same("joints.continuous", name in joint.continuous, abs(step) <= CONTINUOUS * peaks[order])


def _sides(moves: list[Move], angle: float) -> tuple[list[float], list[float]]:
    """Angle, s, v, a, j on both sides of a joint."""
    ends = [(move, row) for move in moves for row in range(len(move.at))]
    before = min(ends, key=lambda end: abs(math.remainder(end[0].at[end[1], -1] - angle, math.tau)))
    after = min(ends, key=lambda end: abs(math.remainder(end[0].at[end[1], 0] - angle, math.tau)))
    return (
        [float(getattr(before[0], name)[before[1], -1]) for name in ("at", "s", "v", "a", "j")],
        [float(getattr(after[0], name)[after[1], 0]) for name in ("at", "s", "v", "a", "j")],
    )


def _compare_criterion(
    beside: Beside, stated: dict[str, Any], moves: list[Move], force: tuple[float, float] | None
) -> None:
    """The value of what was made least."""
    mechanism = beside.design.mechanism
    name = stated.get("minimize", "peak_acceleration")
    if name == "size" and mechanism.type == "barrel_cam":
        value = mechanism.cylinder_radius
    elif name == "size":
        value = mechanism.prime_radius or mechanism.base_radius
    elif name == "peak_contact_force":
        assert force is not None
        value = force[1]
    else:
        value = criterion(name, moves)
    beside.add("optimality.value", beside.design.optimality.value, value, value)


def criterion(name: str, moves: list[Move]) -> float:
    """The peak or root mean square, over the turn, of a rate or of the torque v a."""
    kind, _, of = name.partition("_")
    values = [move.v * move.a if of == "torque" else move.rates(RATES.index(of) + 1) for move in moves]
    if kind == "peak":
        return max(greatest(np.abs(rates)) for rates in values)
    return math.sqrt(mean(moves, [rates**2 for rates in values]))


def _compare_forces(beside: Beside, stated: dict[str, Any], turn: Turn) -> tuple[float, float] | None:
    """The follower as a mass on a spring, at its arm's end; the least and the greatest force."""
    dynamics, forces = stated.get("dynamics"), beside.design.metrics.forces
    if dynamics is None or forces is None:
        return None
    arm = stated["follower"].get("arm", 1.0)
    speed = stated["speed_rpm"] * math.tau / 60.0
    share = SHARES[stated.get("length_unit", "mm")]
    mass, rate = share * dynamics["mass"] * arm**2, forces.spring_rate * arm**2
    damping = 2.0 * dynamics.get("damping_ratio", 0.0) * math.sqrt(mass * rate)
    moved = mass * speed**2 * turn.a + damping * speed * turn.v + rate * turn.s
    lowest = least(moved)
    needed = max(0.0, dynamics.get("least_force", 0.0) * arm - lowest)
    if forces.over_speeds is not None:
        still = Moved(turn.s, turn.v, turn.a, mass, dynamics.get("damping_ratio", 0.0), 0.0)
        top = forces.over_speeds.max_rpm * math.tau / 60.0
        needed = max(needed, dynamics.get("least_force", 0.0) * arm - still.weakest(rate, top))
    grooved = stated.get("closure", "force") != "force" or stated["follower"]["type"] == "barrel_roller"
    preload = dynamics.get("preload")
    preload = preload * arm if preload is not None else (0.0 if grooved else needed)
    force = moved + preload
    torque = force * turn.v
    scale = greatest(np.abs(force)) / arm
    found = {
        "preload": preload / arm,
        "least_preload": needed / arm,
        "min_contact_force": (lowest + preload) / arm,
        "max_contact_force": greatest(force) / arm,
    }
    for name, value in found.items():
        beside.add(f"metrics.forces.{name}", getattr(forces, name), value, scale)
    if forces.over_speeds is None:
        beside.check("contact_force", found["min_contact_force"], scale)
    moving = Moved(turn.s, turn.v, turn.a, mass, dynamics.get("damping_ratio", 0.0), preload)
    compare_springs(beside, stated, moving, arm, speed)
    lever = _slide_lever(stated, beside.design.mechanism, turn)
    if lever is not None:
        moment = greatest(np.abs(force * lever))
        beside.metric("overturning_moment", moment, moment)
        beside.check("overturning_moment", moment, moment)
        beside.check("overturning_on_profile", moment, 1e3 * moment)
    peak = greatest(np.abs(torque))
    beside.add("metrics.forces.min_torque", forces.min_torque, least(torque), peak)
    beside.add("metrics.forces.max_torque", forces.max_torque, greatest(torque), peak)
    natural = math.sqrt(rate / mass)
    beside.add("metrics.forces.natural_frequency", forces.natural_frequency, natural, natural)
    beside.add("metrics.forces.frequency_ratio", forces.frequency_ratio, natural / speed, natural / speed)
    compare_pushing(beside, turn.at.ravel(), force.ravel())
    if forces.wall_changes is not None:
        changes = _changes(turn, force)
        beside.same("metrics.forces.wall_changes", len(forces.wall_changes), len(changes))
        for stated_at, (low, high) in zip(forces.wall_changes, changes, strict=False):
            at = math.radians(stated_at)
            at += math.tau * round((0.5 * (low + high) - at) / math.tau)
            beside.add("metrics.forces.wall_changes", at, min(max(at, low), high), math.tau)
    lowest = found["min_contact_force"]
    if forces.over_speeds is not None:
        lowest = min(lowest, (preload + still.weakest(rate, top)) / arm)
    floor = dynamics.get("least_force", 0.0)
    # A chosen spring leaves exactly the least force, of which rounding is no more and no less.
    lowest = floor if abs(lowest - floor) <= ROUNDED * scale else lowest
    return lowest, found["max_contact_force"]


def _slide_lever(stated: dict[str, Any], mechanism: Any, turn: Turn) -> Real | None:
    """The moment on a slide by the force along it; None where there is no slide, or no overhang."""
    follower = stated["follower"]
    if follower["type"] == "translating_flat":
        return turn.v - (mechanism.follower.offset or 0.0)
    if follower["type"] != "translating_roller" or follower.get("overhang") is None:
        return None
    offset = mechanism.follower.offset
    d = math.sqrt(mechanism.prime_radius**2 - offset**2)
    return (turn.v - offset) / (d + turn.s) * (follower["overhang"] - turn.s)


NOTHING = 1e-6
"""Share of the greatest force that presses nothing."""


def _changes(turn: Turn, force: Real) -> list[tuple[float, float]]:
    """Between which two angles a force changes its sign, in the order in which they come in a turn.

    Where it goes through zero from one point to the next these are one angle, by the chord; where there is no force on
    the way, its last angle and its first.
    """
    at, values = turn.at.ravel(), force.ravel()
    known = np.abs(values) > NOTHING * np.abs(values).max()
    steps = np.diff(np.flatnonzero(known), append=np.flatnonzero(known)[:1] + len(at))
    at, values = at[known], values[known]
    after, following = np.append(at[1:], at[0] + math.tau), np.append(values[1:], values[0])
    found = []
    for k in np.flatnonzero(values * following < 0.0):
        low, high = float(at[k]), float(after[k])
        if steps[k] <= NEXT:
            low = high = low - float(values[k]) * (high - low) / float(following[k] - values[k])
        found.append((low, high))
    return sorted(found, key=lambda pair: pair[1] % math.tau)


NEXT = 3
"""Points from one to another between which a force is taken to be straight."""


def _compare_program(beside: Beside, stated: dict[str, Any], moves: list[Move], lift: float) -> dict[str, float]:
    """The finished cam does what is stated: the exact motion has no deviation, and limits are its peaks.

    Peaks of optimized motions are differences of what the follower does on the finished profile. Where that is ε off
    the program, a difference of the order n over steps of h is off by 2ⁿ ε/hⁿ at most, and a rate that is read off
    the direction of the profile by 16 ε/Δ, Δ the step between its points: a polynomial that is ε at most over Δ, of the
    fifth degree, has no greater slope inside of it (Markov's is n²·2ε/Δ at its very ends).
    """
    jumps = stated.get("accept_discontinuity", False)
    # No curve through points follows a motion that jumps: a hundred times as far off counts as nothing then.
    near = 100.0 if jumps else 1.0
    beside.check("keeps_the_statement", 0.0)
    for name in ("reproduces_program", "outer_wall_reproduces_program"):
        beside.check(name, 0.0, near)
    for name in ("lower_wall_reproduces_program", "upper_wall_reproduces_program"):
        beside.check(name, 0.0, near)
    pairs = list(zip(moves, stated["segments"], strict=True))
    open_moves = [
        (move, segment) for move, segment in pairs if segment.get("law", "auto") in FOLLOWING and _moves(segment)
    ]
    if not open_moves:
        return {}
    known: dict[str, float] = {}
    checks = {check.name: check.value for check in beside.design.verification.checks}
    off = lift * max(value or 0.0 for name, value in checks.items() if name.endswith("reproduces_program"))
    table = beside.design.mechanism.program
    spacing = math.tau / len(table.angle)
    for order, name in enumerate(RATES, start=1):
        peak = greatest(np.abs(np.concatenate([move.rates(order) for move, _ in open_moves])))
        at_table = _at_table(table, [move for move, _ in open_moves], order)
        known[f"table_{name}"] = at_table
        beside.check(f"table_{name}", at_table, peak)
        even = max(_even(move, order) for move, _ in open_moves)
        known[f"peak_{name}"] = even
        if name == "velocity":
            beside.check("peak_velocity", even, peak + 16.0 * off / spacing / AGREE)
        else:
            n, stride = WINDOWS[name]
            widest = max((2.0**n * off / (stride * move.angle / STEPS) ** n) for move, _ in open_moves)
            beside.check(f"peak_{name}", even, peak + widest / AGREE)
    unit = math.pi / 180.0 if stated["follower"]["type"].startswith("oscillating") else 1.0
    missed = _missed(stated, pairs, unit)
    beside.check("meets_positions", missed[0] / lift, near)
    for order, name in ((1, "meets_velocities"), (2, "meets_accelerations")):
        conditioned = [move for move, segment in open_moves if _states(segment, "sva"[order])]
        if conditioned:
            least_peak = min(greatest(np.abs(move.rates(order))) for move in conditioned)
            h = 2.0 * min(move.angle for move in conditioned) / STEPS
            doubt = 16.0 * off / spacing if order == 1 else 16.0 * off / h**2
            beside.check(name, missed[order], 1.0 + doubt / least_peak / AGREE)
    for order, worst in missed.items():
        beside.add("mechanism.conditions", worst / (lift if order == 0 else 1.0), 0.0, 1.0)
    return known


FOLLOWING = ("auto", "optimal")
"""Laws that are left to the criterion."""


def _moves(segment: dict[str, Any]) -> bool:
    return segment["motion"] in ("rise", "fall", "return")


def _states(segment: dict[str, Any], name: str) -> bool:
    return any(name in condition for condition in segment.get("conditions", ()))


def _missed(stated: dict[str, Any], pairs: list[tuple[Move, dict[str, Any]]], unit: float) -> dict[int, float]:
    """By how much conditions and bands of optimized moves are missed, by order: lengths or radians of displacements,
    shares of the move's peak of the derivatives. A jerk is what it is on either side."""
    missed = {0: 0.0}
    for move, segment in pairs:
        if not _moves(segment) or segment.get("law", "auto") not in FOLLOWING:
            continue
        for condition in segment.get("conditions", ()):
            at = move.start + math.radians(condition["angle"])
            sides = [motion_at([move], np.array([at + side])) for side in (-1e-7, 0.0, 1e-7)]
            for order, name in enumerate("svaj"):
                if name not in condition:
                    continue
                values = [float(side[order][0]) for side in (sides if order == 3 else sides[1:2])]
                off = min(abs(value - condition[name] * (unit if order == 0 else 1.0)) for value in values)
                scale = greatest(np.abs(move.rates(order))) if order else 1.0
                missed[order] = max(missed.get(order, 0.0), off / scale)
        for band in segment.get("bands", ()):
            low, high = (move.start + math.radians(band[end]) for end in ("start", "end"))
            inside = (move.at >= low) & (move.at <= high)
            ends = motion_at([move], np.array([low, high]))[0]
            values = np.concatenate([move.s[inside], ends])
            if "upper" in band:
                missed[0] = max(missed[0], float(values.max()) - band["upper"] * unit)
            if "lower" in band:
                missed[0] = max(missed[0], band["lower"] * unit - float(values.min()))
    return missed


def _at_table(table: Any, moves: list[Move], order: int) -> float:
    """The greatest rate at the angles of the table within moves."""
    angles = np.radians(np.array(table.angle))
    peak = 0.0
    for move in moves:
        inside = (angles > move.start + 1e-12) & (angles < move.start + move.angle - 1e-12)
        peak = max(peak, float(np.abs(motion_at([move], angles[inside])[order]).max(initial=0.0)))
    return peak


def _even(move: Move, order: int) -> float:
    """The greatest of a rate, or of its means in windows, at even steps of a move."""
    places = move.start + move.angle * np.arange(STEPS + 1) / STEPS
    s, v, _, _ = motion_at([move], places)
    if order == 1:
        return float(np.abs(v).max())
    n, stride = WINDOWS[RATES[order - 1]]
    h = stride * move.angle / STEPS
    count = len(s) - n * stride
    total = sum((-1) ** (n - i) * math.comb(n, i) * s[i * stride : i * stride + count] for i in range(n + 1))
    return float(np.abs(np.asarray(total)).max()) / h**n


def _barrel(turn: Turn, mechanism: Any) -> dict[str, float]:
    """A groove, unrolled."""
    radius, roller = mechanism.cylinder_radius, mechanism.follower.roller_radius
    rest = STILL * float(np.abs(turn.v).max())
    slope = np.degrees(np.arctan(np.abs(turn.v) / radius))
    rho = 1.0 / greatest(radius * np.abs(turn.a) / (radius**2 + turn.v**2) ** 1.5)
    normal = roller * radius / np.hypot(radius, turn.v)
    return {
        "max_pressure_angle_rise": greatest(np.where(turn.v >= -rest, slope, -np.inf)),
        "max_pressure_angle_fall": greatest(np.where(turn.v <= rest, slope, -np.inf)),
        "min_radius": rho,
        "curvature_ratio": rho / roller,
        "groove_width": 2.0 * roller,
        "length": greatest(turn.s + normal) - least(turn.s - normal),
    }


def _radial(turn: Turn, mechanism: Any) -> dict[str, float]:
    """A radial cam under any follower."""
    s, v, a, follower = turn.s, turn.v, turn.a, mechanism.follower
    if follower.type == "translating_flat":
        rho = mechanism.base_radius + s + a
        size = greatest(np.hypot(mechanism.base_radius + s, v))
        return {"min_convex_radius": least(rho), "face_width": greatest(v) - least(v), "size": size}
    if follower.type == "oscillating_flat":
        pivot, offset = follower.pivot_distance, follower.face_offset or 0.0
        psi, rate = math.asin((mechanism.base_radius + offset) / pivot) + s, 1.0 - (follower.sense or 1) * v
        if psi.min() < math.asin(max(offset, 0.0) / pivot):
            raise ValueError("the face touches beyond the pivot, or on the far side of the line of centres")
        x, y = pivot * np.cos(psi), pivot * np.sin(psi)
        rho = y - offset + (x * a / rate - y * v**2) / rate**2
        # The contact is x/rate along the face from the pivot's foot, the cam's centre x.
        size = greatest(np.hypot(y - offset, x / rate - x))
        reach = x / rate
        return {"min_convex_radius": least(rho), "face_width": greatest(reach) - least(reach), "size": size}
    roller, rest = follower.roller_radius, STILL * float(np.abs(v).max())
    p, z1, z2, motion = _pitch(turn, mechanism)
    normal = -1j * z1 / np.abs(z1)
    leans = np.abs(np.angle(normal * np.conj(motion)))
    steep = np.degrees(np.minimum(leans, math.pi - leans))
    bend = (np.conj(z1) * z2).imag / np.abs(z1) ** 3
    convex, hollow = 1.0 / greatest(bend), -1.0 / least(bend) if least(bend) < 0.0 else math.inf
    found = {
        "max_pressure_angle_rise": greatest(np.where(v >= -rest, steep, -np.inf)),
        "max_pressure_angle_fall": greatest(np.where(v <= rest, steep, -np.inf)),
        "min_convex_radius": convex - roller,
        "curvature_ratio": min(convex, hollow) / roller,
        "size": greatest(np.abs(p - roller * normal)),
    }
    return found | ({"min_concave_radius": hollow + roller} if math.isfinite(hollow) else {})


def _pitch(turn: Turn, mechanism: Any) -> tuple[Complex, Complex, Complex, Complex]:
    """The roller's centre, the pitch curve's two derivatives in the ground's frame, and the way of motion."""
    s, v, a, follower = turn.s, turn.v, turn.a, mechanism.follower
    if follower.type == "translating_roller":
        p = math.sqrt(mechanism.prime_radius**2 - follower.offset**2) + s + 1j * follower.offset
        p1, p2, motion = v + 0j, a + 0j, np.ones_like(p)
    else:
        sense, arm, pivot = follower.sense or 1, follower.arm, follower.pivot_distance
        start = math.acos((pivot**2 + arm**2 - mechanism.prime_radius**2) / (2.0 * pivot * arm))
        swung = -arm * np.exp(-1j * sense * (start + s))
        p, p1, p2 = pivot + swung, -1j * sense * v * swung, (-1j * sense * a - v**2) * swung
        motion = -1j * sense * swung / arm
    # The cam turns below the follower: z′ = p′ + i p.
    return p, p1 + 1j * p, p2 + 2j * p1 - p, motion


def _compare_shape(beside: Beside, turn: Turn) -> None:
    """The profile is smooth and crosses itself nowhere: its curvature is finite, and chords that are no neighbours stay
    apart."""
    mechanism = beside.design.mechanism
    beside.check("no_cusp", True)
    beside.check("touches_everywhere", True)
    if mechanism.type == "barrel_cam":
        return
    walls = {"does_not_cross_itself": mechanism.profile, "outer_wall_is_sound": mechanism.outer_wall}
    for name, curve in walls.items():
        if curve is not None:
            beside.check(name, not _crosses(np.array(curve.x) + 1j * np.array(curve.y)))


def _crosses(points: Complex) -> bool:
    """Whether the closed polygon through points crosses itself."""
    points = points[:: max(1, len(points) // 1000)]
    ahead = np.roll(points, -1)

    def side(a: Complex, b: Complex, c: Complex) -> Real:
        return np.sign((np.conj(b - a) * (c - a)).imag)

    p, q, r, t = points[:, None], ahead[:, None], points[None], ahead[None]
    crossed = (side(p, q, r) * side(p, q, t) < 0.0) & (side(r, t, p) * side(r, t, q) < 0.0)
    return bool(crossed.any())
