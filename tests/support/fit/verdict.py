"""Whether a design fits into its room: driven by its skeleton alone in steps of 0.05 degrees, and looked at by shapely.

The drive is that of :mod:`tests.support.independent.drive`, Newton's iteration on what keeps its length.
"""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import shapely

from kinematics.arrays import Complex, Real
from tests.support.fit.room import hulls, polygons
from tests.support.independent.drive import Drive
from tests.support.independent.room import shape_of

STEP = 0.05
"""Degrees of the input from one position to the next."""

ROUNDING = 1e-6
"""Share of the linkage's size that is no violation."""

PIVOTS = {"fixed_pivots": {"input": "O2", "output": "O4"}, "moving_pivots": {"input": "A", "output": "B"}}
"""The joints that zones are of, where the input does not slide."""


def violations(statement: dict[str, Any], design: Any) -> list[str]:
    """What a design that is said to pass does not keep of the room and of the targets, in words; empty where it fits.

    Parameters
    ----------
    statement : dict
        As it was posted, with a ``space`` block that is held over the used range.
    design : a design of the answer
        Of a linkage whose input turns.
    """
    drive = Drive(design.mechanism.skeleton)
    begin, end = _range(drive, design)
    if not drive.follow(min(begin, end), max(begin, end)):
        return ["cannot be driven over its used range"]
    turns = np.linspace(begin, end, math.ceil(abs(math.degrees(end - begin)) / STEP) + 1)
    places = drive.at(turns)
    if not np.isfinite(places).all():
        return ["does not close everywhere in its used range"]
    space = statement["space"]
    slack = ROUNDING * drive.size
    frame = _Body(statement, design, drive) if statement["kind"] == "motion" else None
    broken = _outside_zones(space, drive, frame, slack)
    half = 0.5 * space.get("link_width", 0.0)
    outline = None if frame is None or space.get("body") is None else frame.outline(space["body"]["outline"], places)
    bare = [] if outline is None else [drive.names.index("P")]
    parts: list[tuple[str, Any, float]] = [
        (name, hulls(places[:, [joint for joint in joints if joint not in bare]]), half)
        for name, joints in drive.links.items()
        if name != "ground"
    ]
    if outline is not None:
        parts.append(("body", polygons(outline), 0.0))
    for name, shapes, wide in parts:
        if space.get("box") is not None:
            (left, low), (right, high) = space["box"]
            bounds = shapely.bounds(shapes)
            beyond = np.max([left - bounds[:, 0], low - bounds[:, 1], bounds[:, 2] - right, bounds[:, 3] - high]) + wide
            if beyond > slack:
                broken.append(f"{name} {beyond:.4g} beyond the box")
        for n, zone in enumerate(space.get("obstacles", [])):
            shape, radius = shape_of(zone)
            shapely.prepare(shape)
            apart = float(np.min(shapely.distance(shape, shapes))) - radius - wide
            if apart < space.get("clearance", 0.0) - slack:
                broken.append(f"{name} {apart:.4g} from obstacle {n}")
            # What overlaps is at no distance, and neither is what only touches.
            met = shapely.intersection(shape, shapes) if wide == 0.0 and radius == 0.0 and apart == 0.0 else None
            if met is not None and np.max(shapely.area(met)) > slack * drive.size:
                broken.append(f"{name} overlaps obstacle {n}")
    if frame is not None:
        broken += frame.missed(statement["positions"], design, slack)
    elif statement["kind"] == "path":
        broken += _missed_points(statement, design, drive, begin, slack)
    else:
        broken += _missed_pairs(statement["pairs"], design, drive, begin)
    return broken


def _range(drive: Drive, design: Any) -> tuple[float, float]:
    """Turns of the input from its place in the skeleton at the ends of the used range, radians."""
    begin, end = (math.radians(angle) for angle in design.metrics.used_range)
    away = math.remainder(begin - drive.reference, math.tau)
    return away, away + end - begin


def _at_targets(design: Any, drive: Drive, begin: float) -> tuple[Real, Complex | None]:
    """Inputs at which targets are said to be met, radians, and all joints there; None where they are not reached."""
    inputs = np.radians([target.input_angle for target in design.targets])
    turns = begin + inputs - math.radians(design.metrics.used_range[0])
    if not drive.follow(float(turns.min()), float(turns.max())):
        return inputs, None
    return inputs, drive.at(turns)


def _missed_points(statement: dict[str, Any], design: Any, drive: Drive, begin: float, slack: float) -> list[str]:
    """Points that P misses by more than is allowed or, without tolerances, told; and crank angles and order."""
    inputs, at = _at_targets(design, drive, begin)
    if at is None:
        return ["cannot be driven to its targets"]
    broken = []
    for n, (point, place) in enumerate(zip(statement["points"], at[:, drive.names.index("P")], strict=True)):
        gap = abs(complex(place) - complex(point["x"], point["y"]))
        allowed = point.get("tolerance", design.targets[n].point_residual)
        if gap > allowed + slack:
            broken.append(f"point {n} missed by {gap:.4g}")
    steps = np.diff(inputs)
    if not (np.all(steps >= -ROUNDING) or np.all(steps <= ROUNDING)):
        broken.append("points are not met in order")
    if statement.get("timing") == "prescribed":
        wanted = np.radians([point["crank_angle"] for point in statement["points"]])
        off = (inputs - inputs[0]) - (wanted - wanted[0])
        if np.abs(off - math.tau * np.round(off / math.tau)).max() > ROUNDING:
            broken.append("points are not met at their crank angles")
    return broken


def _missed_pairs(pairs: list[dict[str, float]], design: Any, drive: Drive, begin: float) -> list[str]:
    """Pairs that are missed by more than is told, read off the links themselves from the first pair on."""
    inputs, at = _at_targets(design, drive, begin)
    if at is None:
        return ["cannot be driven to its targets"]
    arm = at[:, drive.names.index("B")] - at[:, drive.names.index("O4")]
    told = [target.error for target in design.targets]
    scales = design.dials.input.scale, design.dials.output.scale
    broken = []
    for n, (pair, place) in enumerate(zip(pairs, arm, strict=True)):
        turned = math.degrees(inputs[n] - inputs[0]) - scales[0] * (pair["input"] - pairs[0]["input"])
        moved = math.degrees(cmath.phase(complex(place / arm[0]))) - scales[1] * (pair["output"] - pairs[0]["output"])
        off = math.remainder(moved - (told[n] - told[0]), 360.0)
        if max(abs(math.remainder(turned, 360.0)), abs(off)) > math.degrees(ROUNDING):
            broken.append(f"pair {n} is off by {turned:.4g}° and {off:.4g}°")
    return broken


def _outside_zones(space: dict[str, Any], drive: Drive, frame: _Body | None, slack: float) -> list[str]:
    broken = []
    for field, sides in PIVOTS.items():
        for side, joint in sides.items():
            zones = (space.get(field) or {}).get(side)
            if zones is None:
                continue
            away = []
            for zone in zones if isinstance(zones, list) else [zones]:
                place = drive.home[drive.names.index(joint)]
                if frame is not None and zone.get("frame") == "body":
                    place = frame.as_demanded(place)
                shape, radius = shape_of(zone)
                away.append(float(shape.distance(shapely.Point(place.real, place.imag))) - radius)
            if min(away) > slack:
                broken.append(f"{joint} {min(away):.4g} outside its zones")
    return broken


class _Body:
    """The body on the coupler: where it is in the skeleton's own configuration, and where its first position asks."""

    def __init__(self, statement: dict[str, Any], design: Any, drive: Drive) -> None:
        first = statement["positions"][0]
        stood = design.mechanism.reference_body_angle
        self.drive = drive
        self.demanded = complex(first["x"], first["y"])
        self.angle = first["angle"] if stood is None else stood
        self.turn = cmath.exp(1j * math.radians(self.angle - first["angle"]))
        self.a, self.b, self.p = (drive.names.index(name) for name in "ABP")
        self.met = drive.home[self.p]

    def as_demanded(self, place: complex) -> complex:
        """Where a place of the linkage lies on the body as it is demanded first."""
        return self.demanded + (place - self.met) / self.turn

    def outline(self, corners: list[list[float]], places: Complex) -> Complex:
        """The outline of the body in positions (n, joints), shape (n, corners)."""
        drawn = np.array([complex(*corner) for corner in corners])
        home = self.met + self.turn * (drawn - self.demanded)
        bar = self.drive.home[self.b] - self.drive.home[self.a]
        share = (home - self.drive.home[self.a]) / bar
        a, b = places[:, self.a, None], places[:, self.b, None]
        return np.asarray(a + share * (b - a))

    def missed(self, positions: list[dict[str, Any]], design: Any, slack: float) -> list[str]:
        """Positions that are missed by more than is allowed, at the inputs at which they are said to be met."""
        inputs = np.radians([target.input_angle for target in design.targets])
        begin, _ = _range(self.drive, design)
        turns = begin + inputs - math.radians(design.metrics.used_range[0])
        low, high = float(turns.min()), float(turns.max())
        if not self.drive.follow(low, high):
            return ["cannot be driven to its targets"]
        at = self.drive.at(turns)
        bar = self.drive.home[self.b] - self.drive.home[self.a]
        angles = self.angle + np.degrees(np.angle((at[:, self.b] - at[:, self.a]) / bar))
        broken = []
        for n, position in enumerate(positions):
            gap = complex(at[n, self.p]) - complex(position["x"], position["y"])
            off = math.remainder(float(angles[n]) - position["angle"], 360.0)
            allowed = position.get("tolerance") or {}
            for name, value, rounding in (
                ("x", gap.real, slack),
                ("y", gap.imag, slack),
                ("angle", off, math.degrees(ROUNDING)),
            ):
                if abs(value) > allowed.get(name, 0.0) + rounding:
                    broken.append(f"position {n} missed by {value:.4g} in {name}")
        return broken
