"""What answers about cams state, from motion and dimensions (Norton §8.6–8.7, §15.2; Rao §5.4–5.6)."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.independent.cam_motion import Move, greatest, least, mean
from benchmarks.independent.comparison import AGREE, Beside

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

RATES = ("velocity", "acceleration", "jerk")

CONTINUOUS = 1e-6
"""A step up to this share of a rate's peak is none."""

WINDOWS = {"acceleration": (2, 4), "jerk": (3, 8)}
"""Orders of the differences that a check of a peak takes, and their strides, in steps of which a segment has 320."""

STEPS = 320


class Turn(NamedTuple):
    """The motion over the turn: pieces of all segments that have as many points, stacked, shape (pieces, points)."""

    at: Real
    s: Real
    v: Real
    a: Real
    j: Real


def compare_cam(beside: Beside, stated: dict[str, Any], moves: list[Move]) -> None:
    """Compare metrics, segments, joints and checks of a cam."""
    design = beside.design
    turn = Turn(*(np.concatenate([getattr(move, name) for move in moves]) for name in ("at", "s", "v", "a", "j")))
    unit = math.pi / 180.0 if stated["follower"]["type"].startswith("oscillating") else 1.0
    lift = float(np.ptp(turn.s))
    _compare_motion(beside, turn, moves, lift / unit)
    _compare_segments(beside, moves, unit)
    _compare_joints(beside, moves, unit)
    _compare_criterion(beside, stated, turn, moves)
    _compare_forces(beside, stated, turn)
    _compare_program(beside, stated, turn, moves, lift)
    found = (
        _barrel(turn, design.mechanism) if design.mechanism.type == "barrel_cam" else _radial(turn, design.mechanism)
    )
    for name, value in found.items():
        # A hollow hundreds of times as flat as the cam is large is compared by its curvature.
        scale = 90.0 if "angle" in name else value
        scale *= max(1.0, value / 1000.0) if name == "min_concave_radius" else 1.0
        beside.metric(name, value, scale)
    checks = {"pressure_angle": "max_pressure_angle_rise", "pressure_angle_fall": "max_pressure_angle_fall"}
    checks |= {"curvature_ratio": "curvature_ratio", "face_width": "face_width", "clears_pivot": "size"}
    checks |= {"min_radius": "min_convex_radius"}
    for check, name in checks.items():
        if name in found:
            beside.check(check, found[name], 90.0 if "angle" in name else found[name])
    beside.check("convex", "min_concave_radius" not in found)
    roller, mechanism = getattr(design.mechanism.follower, "roller_radius", None) or 0.0, design.mechanism
    if mechanism.type == "barrel_cam":
        hub, size = mechanism.cylinder_radius, mechanism.cylinder_radius
    else:
        size = mechanism.prime_radius or mechanism.base_radius
        hub = size - roller
    beside.check("hub_radius", hub, hub)
    beside.check("size", size, size)
    _compare_shape(beside, turn)


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
            if abs(abs(step) / peaks[order] - CONTINUOUS) > 0.5 * CONTINUOUS:
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


def _compare_criterion(beside: Beside, stated: dict[str, Any], turn: Turn, moves: list[Move]) -> None:
    """The value of what was made least."""
    kind, _, of = stated.get("minimize", "peak_acceleration").partition("_")
    if kind == "size":
        value = beside.design.mechanism.prime_radius or beside.design.mechanism.base_radius
    elif kind == "peak":
        order = RATES.index(of) + 1
        value = greatest(np.abs((turn.s, turn.v, turn.a, turn.j)[order]))
    else:
        value = math.sqrt(mean(moves, [move.rates(RATES.index(of) + 1) ** 2 for move in moves]))
    beside.add("optimality.value", beside.design.optimality.value, value, value)


def _compare_forces(beside: Beside, stated: dict[str, Any], turn: Turn) -> None:
    """The follower as a mass on a spring, at its arm's end."""
    dynamics, forces = stated.get("dynamics"), beside.design.metrics.forces
    if dynamics is None or forces is None:
        return
    arm = stated["follower"].get("arm", 1.0)
    speed = stated["speed_rpm"] * math.tau / 60.0
    mass, rate = 1e-3 * dynamics["mass"] * arm**2, dynamics["spring_rate"] * arm**2
    damping = 2.0 * dynamics.get("damping_ratio", 0.0) * math.sqrt(mass * rate)
    moved = mass * speed**2 * turn.a + damping * speed * turn.v + rate * turn.s
    lowest = least(moved)
    needed = max(0.0, dynamics.get("least_force", 0.0) * arm - lowest)
    grooved = stated.get("closure") == "form" or stated["follower"]["type"] == "barrel_roller"
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
    beside.check("contact_force", found["min_contact_force"], scale)
    peak = greatest(np.abs(torque))
    beside.add("metrics.forces.min_torque", forces.min_torque, least(torque), peak)
    beside.add("metrics.forces.max_torque", forces.max_torque, greatest(torque), peak)
    natural = math.sqrt(rate / mass)
    beside.add("metrics.forces.natural_frequency", forces.natural_frequency, natural, natural)
    beside.add("metrics.forces.frequency_ratio", forces.frequency_ratio, natural / speed, natural / speed)
    if forces.wall_changes is not None:
        changes = _changes(turn, force)
        beside.same("metrics.forces.wall_changes", len(forces.wall_changes), len(changes))
        for stated_at, at in zip(forces.wall_changes, changes, strict=False):
            beside.add("metrics.forces.wall_changes", stated_at, math.degrees(at), 360.0)


def _changes(turn: Turn, force: Real) -> list[float]:
    """Angles at which a force changes its sign, by the chord between two points."""
    small = 1e-12 * float(np.abs(force).max())
    at, values = turn.at.ravel(), np.where(np.abs(force.ravel()) <= small, 0.0, force.ravel())
    known = values != 0.0
    at, values = at[known], values[known]
    k = np.flatnonzero(values[1:] * values[:-1] < 0.0)
    found = at[k] - values[k] * (at[k + 1] - at[k]) / (values[k + 1] - values[k])
    # Where a rest without force lies between, the sign changes where the first motion after it begins, or before.
    found = [
        float(x) if b - a < 0.01 else float(b if b - a > 0.01 else x)
        for x, a, b in zip(found, at[k], at[k + 1], strict=True)
    ]
    if len(values) and values[0] * values[-1] < 0.0:
        found.append(0.0)
    return sorted(x % math.tau for x in found)


def _compare_program(beside: Beside, stated: dict[str, Any], turn: Turn, moves: list[Move], lift: float) -> None:
    """The finished cam does what is stated: the exact motion has no deviation, and limits are its peaks.

    Peaks of optimized motions are differences of what the follower does on the finished profile. Where that is ε off
    the program, a difference of the order n over steps of h is off by 2ⁿ ε/hⁿ at most, and a rate that is read off
    the direction of the profile by 16 ε/Δ, Δ the step between its points: a polynomial that is ε at most over Δ, of the
    fifth degree, has no greater slope inside of it (Markov's is n²·2ε/Δ at its very ends).
    """
    for name in ("keeps_the_statement", "reproduces_program", "outer_wall_reproduces_program", "meets_positions"):
        beside.check(name, 0.0)
    for name in ("lower_wall_reproduces_program", "upper_wall_reproduces_program"):
        beside.check(name, 0.0)
    open_moves = [
        move for move, segment in zip(moves, stated["segments"], strict=True) if segment.get("law") == "optimal"
    ]
    if not open_moves:
        return
    checks = {check.name: check.value for check in beside.design.verification.checks}
    off = lift * max(value or 0.0 for name, value in checks.items() if name.endswith("reproduces_program"))
    table = beside.design.mechanism.program
    spacing = math.tau / len(table.angle)
    for order, name in enumerate(RATES, start=1):
        peak = greatest(np.abs(np.concatenate([move.rates(order) for move in open_moves])))
        beside.check(f"table_{name}", _at_table(table, open_moves, order), peak)
        if name == "velocity":
            beside.check(
                "peak_velocity", max(_even(move, 1) for move in open_moves), peak + 16.0 * off / spacing / AGREE
            )
        else:
            n, stride = WINDOWS[name]
            widest = max((2.0**n * off / (stride * move.angle / STEPS) ** n) for move in open_moves)
            beside.check(f"peak_{name}", max(_even(move, order) for move in open_moves), peak + widest / AGREE)
    peak = greatest(np.abs(open_moves[0].v))
    beside.check("meets_velocities", 0.0, 1.0 + 16.0 * off / spacing / peak / AGREE)


def _at_table(table: Any, moves: list[Move], order: int) -> float:
    """The greatest rate at the angles of the table within moves."""
    angles = np.radians(np.array(table.angle))
    peak = 0.0
    for move in moves:
        inside = (angles > move.start + 1e-12) & (angles < move.start + move.angle - 1e-12)
        rows = np.searchsorted(move.at[:, 0], angles[inside] - 1e-11)
        rows = rows[rows < len(move.at)]
        peak = max(peak, float(np.abs(move.rates(order)[rows, 0]).max(initial=0.0)))
    return peak


def _even(move: Move, order: int) -> float:
    """The greatest of a rate, or of its means in windows, at even steps of a move."""
    at, s, v = move.at.ravel(), move.s.ravel(), move.v.ravel()
    places = move.start + move.angle * np.arange(STEPS + 1) / STEPS
    k = np.clip(np.searchsorted(at, places) - 1, 0, len(at) - 2)
    wide = at[k + 1] - at[k]
    k = np.where(wide > 0.0, k, np.maximum(k - 1, 0))
    wide, u = at[k + 1] - at[k], 0.0
    u = (places - at[k]) / wide
    if order == 1:
        return float(np.abs(v[k] + u * (v[k + 1] - v[k])).max())
    cubic = (1.0 + 2.0 * u) * (1.0 - u) ** 2 * s[k] + u * (1.0 - u) ** 2 * wide * v[k]
    cubic += u**2 * (3.0 - 2.0 * u) * s[k + 1] - u**2 * (1.0 - u) * wide * v[k + 1]
    n, stride = WINDOWS[RATES[order - 1]]
    h = stride * move.angle / STEPS
    count = len(cubic) - n * stride
    total = sum((-1) ** (n - i) * math.comb(n, i) * cubic[i * stride : i * stride + count] for i in range(n + 1))
    return float(np.abs(np.asarray(total)).max()) / h**n


def _barrel(turn: Turn, mechanism: Any) -> dict[str, float]:
    """A groove, unrolled."""
    radius, roller = mechanism.cylinder_radius, mechanism.follower.roller_radius
    slope = np.degrees(np.arctan(np.abs(turn.v) / radius))
    rho = 1.0 / greatest(radius * np.abs(turn.a) / (radius**2 + turn.v**2) ** 1.5)
    normal = roller * radius / np.hypot(radius, turn.v)
    return {
        "max_pressure_angle_rise": greatest(np.where(turn.v >= 0.0, slope, -np.inf)),
        "max_pressure_angle_fall": greatest(np.where(turn.v <= 0.0, slope, -np.inf)),
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
        x, y = pivot * np.cos(psi), pivot * np.sin(psi)
        rho = y - offset + (x * a / rate - y * v**2) / rate**2
        # The contact is x/rate along the face from the pivot's foot, the cam's centre x.
        size = greatest(np.hypot(y - offset, x / rate - x))
        reach = x / rate
        return {"min_convex_radius": least(rho), "face_width": greatest(reach) - least(reach), "size": size}
    roller = follower.roller_radius
    p, z1, z2, motion = _pitch(turn, mechanism)
    normal = -1j * z1 / np.abs(z1)
    leans = np.abs(np.angle(normal * np.conj(motion)))
    steep = np.degrees(np.minimum(leans, math.pi - leans))
    bend = (np.conj(z1) * z2).imag / np.abs(z1) ** 3
    convex, hollow = 1.0 / greatest(bend), -1.0 / least(bend) if least(bend) < 0.0 else math.inf
    found = {
        "max_pressure_angle_rise": greatest(np.where(v >= 0.0, steep, -np.inf)),
        "max_pressure_angle_fall": greatest(np.where(v <= 0.0, steep, -np.inf)),
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
