"""Answers that guide a point or a body: errors at their targets and between them (docs/tasks/path.md)."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from tests.support.independent.cognates import compare_cognates
from tests.support.independent.comparison import Beside
from tests.support.independent.course import Course
from tests.support.independent.drive import Drive
from tests.support.independent.extremes import GRID, greatest, least, root
from tests.support.independent.linkage import DRIVERS, Used, compare_linkage, outside, turns_of_gears
from tests.support.independent.sides import compare_sides

PANELS, NODES = 256, 12
"""Panels of Gauss's quadrature along the way at first, and nodes of each."""

HALVED, SETTLED = 40, 1e-11
"""How often panels are halved at most, and the share of the way by which the halves of a settled one differ from it."""

COURSE = 2881
"""Inputs at which a curve is laid beside the course of its points."""

MIDDLES = 100_001
"""Inputs between which the middles of a curve's steps are compared with the course, for a mean."""

EXACT = 5
"""Positions that are met exactly, where nothing else is stated."""


def span(drive: Drive, design: Any) -> Real:
    """How far the input has moved from the skeleton's configuration at each target."""
    at = np.array([target.position for target in design.targets])
    if drive.slides_in:
        return at
    at = np.radians(at)
    first = (at[0] - drive.reference + math.pi) % math.tau - math.pi
    return np.asarray(at - at[0] + first)


def travelled(drive: Drive, low: float, high: float) -> float:
    """Length of P's path, by quadrature of its speed: panels are halved until their halves say the same.

    Close to a toggle the speed rises steeply, so that no number of equal panels is enough.
    """
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    p = drive.names.index("P")

    def lengths(begin: Real, end: Real) -> Real:
        half = 0.5 * (end - begin)[:, None]
        turns = 0.5 * (begin + end)[:, None] + half * nodes
        speed = np.abs(drive.rates_at(turns.ravel())[:, p]).reshape(turns.shape)
        return np.asarray((speed * weights * half).sum(axis=1))

    edges = np.linspace(low, high, PANELS + 1)
    begin, end = edges[:-1], edges[1:]
    whole = lengths(begin, end)
    total, settled = float(whole.sum()), 0.0
    for _ in range(HALVED):
        middle = 0.5 * (begin + end)
        halves = np.stack([lengths(begin, middle), lengths(middle, end)], axis=1)
        open_ = np.abs(halves.sum(axis=1) - whole) > SETTLED * total
        settled += float(halves[~open_].sum())
        if not open_.any():
            return settled
        begin = np.stack([begin, middle], axis=1)[open_].ravel()
        end = np.stack([middle, end], axis=1)[open_].ravel()
        whole = halves[open_].ravel()
    return settled + float(whole.sum())


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


class Met(NamedTuple):
    """The linkage at its targets.

    Attributes
    ----------
    turns : float, shape (targets,)
        How far the input has moved from the skeleton's configuration.
    joints : complex, shape (targets, joints)
    points, misses : shape (targets,)
        The demanded points, and how far P is from them.
    wrong : float, shape (targets,)
        Differences of the body's angle to the demanded one, radians; 0 where none is demanded.
    used : tuple of float
        The first and the last turn that is used.
    task : float
        The size of the task.
    """

    turns: Real
    joints: Complex
    points: Complex
    misses: Real
    wrong: Real
    used: tuple[float, float]
    task: float


def compare_guided(beside: Beside, stated: dict[str, Any]) -> None:
    """Targets, errors, the whole way and how a body is carried."""
    design = beside.design
    drive = Drive(design.mechanism.skeleton)
    met = _met(beside, stated, drive)
    if met is None:
        return
    worst = np.maximum(met.misses / met.task, np.abs(met.wrong))
    for k, target in enumerate(design.targets):
        beside.add("targets.point_residual", target.point_residual, float(met.misses[k]), met.task)
        beside.add("targets.residual", target.residual, float(worst[k]), 1.0)
        if target.angle_residual is not None:
            wrong = math.degrees(abs(met.wrong[k]))
            beside.add("targets.angle_residual", target.angle_residual, wrong, 180.0)
        _compare_input(beside, drive, target, float(met.turns[k]))
    beside.metric("rms_residual", math.sqrt(float(np.mean((met.misses / met.task) ** 2 + met.wrong**2))), 1.0)
    turned = float(met.turns[-1] - met.turns[0])
    beside.metric("input_rotation", math.degrees(turned), 360.0)
    beside.metric("input_stroke", turned, drive.size)
    ease = 1.0
    if stated["kind"] == "path":
        beside.check("reaches_targets", float(worst.max()))
        _compare_path(beside, stated, drive, met)
    else:
        _compare_tolerances(beside, stated, drive, met)
        ease = _compare_body(beside, drive, met)
        compare_sides(beside, stated, drive, met.task)
    driven = design.mechanism.type in DRIVERS
    way = (0.0, math.tau) if driven else met.used
    steps = np.diff(met.turns)
    in_order = bool((steps >= 0).all() or (steps <= 0).all())
    compare_linkage(beside, stated, drive, Used(way, met.task, met.joints.ravel(), ease, in_order))
    if driven:
        _compare_driver(beside, stated, drive, met)


def _met(beside: Beside, stated: dict[str, Any], drive: Drive) -> Met | None:
    """The linkage at its targets; None where it cannot be driven to them."""
    design = beside.design
    poses = stated["positions" if stated["kind"] == "motion" else "points"]
    points = np.array([complex(pose["x"], pose["y"]) for pose in poses])
    task = float(np.abs(points[:, None] - points).max())
    placed = getattr(design, "placement", None)
    if placed is not None:
        points = placed.size * points * cmath.rect(1.0, math.radians(placed.rotation)) + complex(*placed.shift)
    turns = span(drive, design)
    low, high = float(turns.min()), float(turns.max())
    used = (low, high)
    if stated["kind"] == "path" and stated.get("closed") and not drive.slides_in:
        used = (float(turns[0]), float(turns[0]) + math.tau * turns_of_gears(design.mechanism))
    if not drive.follow(min(low, *used), max(high, *used)):
        beside.unmeasured("could not be driven")
        return None
    joints = drive.at(turns)
    wrong = np.zeros(len(points))
    if stated["kind"] == "motion":
        demanded = np.radians([pose["angle"] for pose in poses])
        begun = getattr(design.mechanism, "reference_body_angle", None)
        begun = float(demanded[0]) if begun is None else math.radians(begun)
        wrong = (begun + rotation(drive, joints) - demanded + math.pi) % math.tau - math.pi
    misses = np.abs(joints[:, drive.names.index("P")] - points)
    return Met(turns, joints, points, misses, wrong, used, task)


def _compare_input(beside: Beside, drive: Drive, target: Any, turn: float) -> None:
    """Where the input stands, from the joints on it."""
    if drive.slides_in:
        beside.add("targets.input_place", target.input_place, turn, drive.size)
        return
    joint, (pivot, _) = next(iter(drive.turning.items()))
    arm = drive.at(np.array([turn]))[0]
    off = target.input_angle - math.degrees(float(np.angle(arm[joint] - arm[pivot])))
    beside.add("targets.input_angle", target.input_angle, target.input_angle - math.remainder(off, 360.0), 360.0)


def _compare_path(beside: Beside, stated: dict[str, Any], drive: Drive, met: Met) -> None:
    squares, worst = float((met.misses**2).sum()), float(met.misses.max())
    beside.metric("sum_of_squares", squares, met.task**2)
    beside.metric("rms_distance", math.sqrt(squares / len(met.points)), met.task)
    beside.metric("max_distance", worst, met.task)
    course = Course(met.points, bool(stated.get("closed")))

    def greatest_of(distance: Callable[[Complex], Real]) -> float:
        at = greatest(lambda turns: distance(drive.joint("P", turns)), *met.used, grid=COURSE)
        return max(0.0, at.value) if at.value == at.value else math.nan

    if beside.design.metrics.curve_distance is not None:
        beside.metric("curve_distance", greatest_of(course.distances), met.task)
        beside.metric("excursion", greatest_of(lambda z: course.beyond_bulges(z, worst)), met.task)
    if beside.design.metrics.both_way_rms is not None:
        along = drive.joint("P", np.linspace(*met.used, MIDDLES))
        back = course.distances(0.5 * (along[1:] + along[:-1])) ** 2
        both = 0.5 * (squares / len(met.points) + float(np.average(back, weights=np.abs(np.diff(along)))))
        beside.metric("both_way_rms", math.sqrt(both), met.task)
    if all(point.get("tolerance") is not None for point in stated["points"]):
        tolerances = np.array([point["tolerance"] for point in stated["points"]])
        beside.check("within_tolerance", float((met.misses / tolerances).max()))
        beside.check("curve_within_tolerance", greatest_of(lambda z: course.tolerance_used(z, tolerances)))
    if stated.get("stance") is not None:
        _compare_stance(beside, stated, drive, met)
    compare_demands_of_path(beside, stated, drive, met.task, met.turns[:1])
    compare_cognates(beside, drive, met.turns)


def _compare_stance(beside: Beside, stated: dict[str, Any], drive: Drive, met: Met) -> None:
    """Height and speed of P from the first point of a stance to its last; the speed is that of the loops' equations."""
    (first, last), foot = stated["stance"]["points"], drive.names.index("P")
    start, end = float(met.turns[first]), float(met.turns[last])
    if first > last:
        end += math.copysign(met.used[1] - met.used[0], float(met.turns[-1] - met.turns[0]))
    if not drive.follow(min(start, end), max(start, end)):
        beside.unmeasured("could not be driven through its stance")
        return
    off = -cmath.phase(met.points[last] - met.points[first])
    ways = np.exp(1j * off) * drive.at(np.array([start, end]))[:, foot]
    mean = float(np.diff(ways.real)[0]) / (end - start)

    def height(turns: Real) -> Real:
        return np.asarray((np.exp(1j * off) * drive.at(turns)[:, foot]).imag)

    def over_mean(turns: Real) -> Real:
        return np.asarray((np.exp(1j * off) * drive.rates_at(turns)[:, foot]).real / mean)

    low, high = min(start, end), max(start, end)
    flatness = greatest(height, low, high).value - least(height, low, high).value
    uneven = max(greatest(over_mean, low, high).value - 1.0, 1.0 - least(over_mean, low, high).value)
    beside.metric("stance_flatness", flatness, met.task)
    beside.metric("stance_speed_deviation", uneven, 1.0)
    beside.metric("stance_rotation", math.degrees(high - low), 360.0)
    beside.check("stance_flatness", flatness, met.task)
    beside.check("stance_speed", uneven)


def compare_demands_of_path(
    beside: Beside, stated: dict[str, Any], drive: Drive, task: float, first_turn: Real
) -> None:
    """Pivots that are given, P's place on the coupler, the crank's phase, and links that a match may have."""
    at = {name: complex(place) for name, place in zip(drive.names, drive.home, strict=True)}
    pivots = stated.get("fixed_pivots", {})
    gaps = [
        abs(value - wanted) / task
        for name, joint in (("input", "O2"), ("output", "O4" if "O4" in at else "O5"))
        for value, wanted in zip((at.get(joint, 0j).real, at.get(joint, 0j).imag), pivots.get(name) or (), strict=False)
        if wanted is not None
    ]
    if gaps:
        beside.check("fixed_pivots", max(gaps))
    limits = stated.get("constraints", {}).get("coupler_point")
    if limits is not None:
        along = (at["B"] - at["A"]) / abs(at["B"] - at["A"])
        place = (at["P"] - at["A"]) * along.conjugate()
        box = {"x": limits.get("along", (-math.inf, math.inf)), "y": limits.get("across", (-math.inf, math.inf))}
        beside.check("coupler_point", outside(box, place) <= 1e-9 * drive.size)
    if stated.get("crank_phase", "free") != "free":
        first = drive.at(first_turn)[0]
        stands = cmath.phase(complex(first[drive.names.index("A")]) - at["O2"])
        stands -= cmath.phase(at["O4"] - at["O2"]) if stated["crank_phase"] == "ground_line" else 0.0
        signs = (1.0, -1.0) if stated.get("crank_direction") == "either" else (1.0,)
        wanted = math.radians(stated["points"][0]["crank_angle"])
        beside.check("crank_phase", min(abs(math.remainder(stands - sign * wanted, math.tau)) for sign in signs))


def _compare_tolerances(beside: Beside, stated: dict[str, Any], drive: Drive, met: Met) -> None:
    """How much of their tolerances the positions use, and how exactly the others are met."""
    fitted = len(stated["positions"]) > EXACT or stated.get("method") == "least_squares"
    toleranced = any(pose.get("tolerance") is not None for pose in stated["positions"])
    held, used = 0.0, 0.0
    off = met.joints[:, drive.names.index("P")] - met.points
    for k, pose in enumerate(stated["positions"]):
        offsets = np.array([off[k].real, off[k].imag, met.wrong[k]])
        limits = np.full(3, math.inf if fitted and not toleranced and not pose.get("exact") else 0.0)
        tolerance = pose.get("tolerance")
        if isinstance(tolerance, dict):
            limits[:] = [tolerance.get(name) or 0.0 for name in ("x", "y", "angle")]
            limits[2] = math.radians(limits[2])
        elif tolerance is not None:
            limits[:] = [tolerance, tolerance, min(tolerance / met.task, math.pi)]
        exact = np.where(limits == 0.0, offsets, 0.0)
        held = max(held, float(np.hypot(exact[0], exact[1])) / met.task, abs(exact[2]))
        some = (limits > 0.0) & np.isfinite(limits)
        used = max(used, float((np.abs(offsets[some]) / limits[some]).max(initial=0.0)))
    beside.check("reaches_targets", held)
    beside.check("within_tolerance", used)


def _compare_body(beside: Beside, drive: Drive, met: Met) -> float:
    """How the body is carried; the factor of the quality."""
    low, high = float(met.turns.min()), float(met.turns.max())
    p, turned = met.joints[:, drive.names.index("P")], rotation(drive, met.joints)
    travel = 0.0 if drive.slides_in else math.degrees(high - low)
    beside.metric("input_travel", travel, 360.0)
    way, needed = travelled(drive, low, high), float(np.abs(np.diff(p)).sum())
    turning = _turning(drive, low, high)
    steps = np.diff(turned)
    needed_turn = float(np.abs((steps + math.pi) % math.tau - math.pi).sum())
    beside.metric("body_travel_ratio", way / needed, way / needed)
    if needed_turn > 0.0:
        beside.metric("body_turn_ratio", turning / needed_turn, turning / needed_turn)
    excess = max((way - needed) / max(needed, met.task), (turning - needed_turn) / max(needed_turn, math.radians(15.0)))
    return 1.0 / ((1.0 + (travel / 180.0) ** 2) * (1.0 + excess**2))


def _turning(drive: Drive, low: float, high: float) -> float:
    """All that the body turns: its rate, by quadrature between the places where that changes its sign."""
    i, j = body(drive)

    def rate(turns: Real) -> Real:
        z, rates = drive.at(turns), drive.rates_at(turns)
        return np.asarray(((rates[:, j] - rates[:, i]) / (z[:, j] - z[:, i])).imag)

    places = np.linspace(low, high, GRID)
    sign = np.sign(rate(places))
    inside = [
        root(rate, float(places[k]), float(places[k + 1])) for k in np.flatnonzero(sign[1:] * sign[:-1] < 0.0).tolist()
    ]
    ends = np.array([low, *inside, high])
    turned = np.unwrap(rotation(drive, drive.at(np.sort(np.concatenate([places, ends])))))
    at_ends = turned[np.searchsorted(np.sort(np.concatenate([places, ends])), ends)]
    return float(np.abs(np.diff(at_ends)).sum())


def _compare_driver(beside: Beside, stated: dict[str, Any], drive: Drive, met: Met) -> None:
    """The driven link goes from its place at the first target to that at the last, and no farther."""
    names = drive.names.index
    driven = next(name for name in ("input", "output", "coupler") if names("C") in drive.links[name])
    pivot, pin = (names("O4"), names("B")) if driven == "output" else (names("O2"), names("A"))
    nodes = np.unwrap(np.angle(drive.places[:, pin] - drive.places[:, pivot]))

    def angle(turns: Real) -> Real:
        near = np.interp(turns, drive.nodes, nodes)
        z = drive.at(turns)
        return np.asarray(near + np.angle((z[:, pin] - z[:, pivot]) * np.exp(-1j * near)))

    swing = greatest(angle, 0.0, math.tau).value - least(angle, 0.0, math.tau).value
    ends = angle(met.turns[[0, -1]])
    beside.check("limits", swing - abs(float(ends[1] - ends[0])), 1.0)
    wanted = stated.get("driver_dyad")
    if isinstance(wanted, dict) and wanted.get("pivot_region") is not None:
        place = complex(drive.home[names("O6")])
        beside.check("driver_pivot_region", outside(wanted["pivot_region"], place) <= 1e-9 * drive.size)
