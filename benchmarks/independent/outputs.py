"""Answers whose output follows the input (docs/function.md, dwell.md, quick_return.md)."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.independent.comparison import Measured
from benchmarks.independent.drive import Drive
from benchmarks.independent.extremes import greatest, least
from benchmarks.independent.linkage import compare_linkage

Real = NDArray[np.float64]

FUNCTIONS: dict[str, Callable[[Real, dict[str, Any]], Real]] = {
    "linear": lambda x, stated: x,
    "power": lambda x, stated: x ** float(stated["exponent"]),
    "exponential": lambda x, stated: float(stated.get("base", math.e)) ** x,
    "logarithm": lambda x, stated: np.log10(x),
    "sine": lambda x, stated: np.sin(np.radians(x)),
    "cosine": lambda x, stated: np.cos(np.radians(x)),
    "tangent": lambda x, stated: np.tan(np.radians(x)),
    "reciprocal": lambda x, stated: 1.0 / x,
}
"""The functions by their names."""

SWINGS = {
    "fourbar": ("O4", "B"),
    "drag_link_rocker": ("O6", "C"),
    "dwell_rocker": ("O6", "D"),
    "dwell_slot": ("O6", "C"),
}
"""Pivot and pin of outputs that turn."""

EXACT = 1e-6
"""Errors below this, degrees or length units, are compared as they are and not by their size."""

PANELS, NODES = 200, 10
"""Panels of the range for the mean square of an error, and nodes of Gauss's quadrature in each."""


class Output:
    """The output of a driven linkage: an angle, radians, or a place along its slide from the line's point."""

    def __init__(self, drive: Drive, kind: str) -> None:
        self.drive, self.turns = drive, kind in SWINGS
        if self.turns:
            self.pins = tuple(drive.names.index(pin) for pin in SWINGS[kind])
        else:
            self.joint, _, self.point, self.along = next(s for s in drive.slides if s[1] == "ground")

    def at(self, turns: Real) -> Real:
        """The output at turns that follow each other closely, continuous."""
        z = self.drive.at(turns)
        if not self.turns:
            return np.asarray(((z[:, self.joint] - self.point) * np.conj(self.along)).real)
        pivot, pin = self.pins
        # Angles go on from those of the nodes along which the linkage was followed.
        nodes = np.unwrap(np.angle(self.drive.places[:, pin] - self.drive.places[:, pivot]))
        near = nodes[np.clip(np.searchsorted(self.drive.nodes, turns), 0, len(nodes) - 1)]
        return np.asarray(near + np.angle((z[:, pin] - z[:, pivot]) * np.exp(-1j * near)))

    def rate(self, turns: Real) -> Real:
        """Its derivative by the input."""
        z, rates = self.drive.at(turns), self.drive.rates_at(turns)
        if not self.turns:
            return np.asarray((rates[:, self.joint] * np.conj(self.along)).real)
        pivot, pin = self.pins
        return np.asarray((rates[:, pin] / (z[:, pin] - z[:, pivot])).imag)

    def acceleration(self, turns: Real, step: float = 2e-3) -> Real:
        """Its second derivative: differences of the first over two steps, extrapolated twice."""
        first, second, third = (
            (self.rate(turns + h) - self.rate(turns - h)) / (2.0 * h) for h in (step, 0.5 * step, 0.25 * step)
        )
        finer, finest = second + (second - first) / 3.0, third + (third - second) / 3.0
        return finest + (finest - finer) / 15.0


def compare_function(result: Measured, stated: dict[str, Any], design: Any, name: str) -> set[str]:
    """Structural errors at the targets and over the range."""
    drive, dials, metrics = Drive(design.mechanism.skeleton), design.dials, design.metrics
    if not (metrics.same_branch and metrics.visits_in_order):
        result.left["designs that leave their branch or order"] += 1
        return set()
    output = Output(drive, design.mechanism.type)
    # A slider's place is from the foot of the fixed pivot.
    foot = 0.0 if output.turns else float(((output.point - drive.home[0]) * np.conj(output.along)).real)
    unit = 180.0 / math.pi if output.turns else 1.0

    def place(values: Real, dial: Any) -> Real:
        return np.asarray(dial.place + dial.scale * (values - dial.at))

    began = math.degrees(drive.reference)
    inputs = np.array([target.input for target in design.targets])
    turned = np.radians(place(inputs, dials.input) - began)
    shift = math.tau * round(float(turned[0]) / math.tau)
    turned -= shift
    low, high = float(turned.min()), float(turned.max())
    result.add("function first input", 0.0, float(turned[0]), math.tau, name)
    if not drive.follow(low, high):
        result.left[f"{design.mechanism.type}: could not be driven"] += 1
        return set()

    def error(turns: Real, demanded: Real) -> Real:
        off = unit * output.at(turns) + foot - place(demanded, dials.output)
        return np.asarray((off + 180.0) % 360.0 - 180.0 if output.turns else off)

    width = abs(metrics.output_range)
    demanded = np.array([target.output for target in design.targets])
    at_targets = error(turned, demanded)
    residuals = np.abs(at_targets) / (unit if output.turns else width)
    for k, target in enumerate(design.targets):
        result.add("function error", target.error, float(at_targets[k]), 90.0 if output.turns else width, name)
        result.add("function residual", target.residual, float(residuals[k]), 1.0, name)
        result.add("function input_angle", target.input_angle, float(place(inputs, dials.input)[k]), 360.0, name)
    result.add("function rms_residual", metrics.rms_residual, math.sqrt(float(np.mean(residuals**2))), 1.0, name)
    result.add("function input_rotation", metrics.input_rotation, math.degrees(turned[-1] - turned[0]), 360.0, name)
    function = stated.get("function")
    if function is None:
        most, rms = float(np.abs(at_targets).max()), math.sqrt(float(np.mean(at_targets**2)))
        ends = place(demanded[[0, -1]], dials.output)
    elif function["name"] not in FUNCTIONS:
        result.left[f"functions by {function['name']}"] += 1
        return set()
    else:
        x = [float(value) for value in function["x"]]

        def off(values: Real) -> Real:
            turns = np.radians(place(values, dials.input) - began) - shift
            return error(np.clip(turns, low, high), FUNCTIONS[function["name"]](values, function))

        most = max(greatest(off, *x).value, -least(off, *x).value)
        nodes, weights = np.polynomial.legendre.leggauss(NODES)
        edges = np.linspace(*x, PANELS + 1)
        values = (0.5 * (edges[1:] + edges[:-1])[:, None] + 0.5 * np.diff(edges)[:, None] * nodes).ravel()
        rms = math.sqrt(float((off(values).reshape(PANELS, NODES) ** 2 @ weights).mean()) / 2.0)
        ends = place(FUNCTIONS[function["name"]](np.array(x), function), dials.output)
        if function["name"] != "sine":
            result.add("function output_range", metrics.output_range, float(ends[1] - ends[0]), 360.0, name)
    result.add("function max_structural_error", metrics.max_structural_error, most, max(most, EXACT), name)
    result.add("function rms_structural_error", metrics.rms_structural_error, rms, max(rms, EXACT), name)
    joints = drive.at(turned).ravel()
    task = None if output.turns else width
    ways = compare_linkage(result, "function", design, drive, name, way=(low, high), task=task, places=joints)
    return ways | {"max_structural_error", "rms_structural_error", "output_range", "rms_residual", "input_rotation"}


def compare_dwell(result: Measured, stated: dict[str, Any], design: Any, name: str) -> set[str]:
    """How the output rests, and how it goes."""
    drive, metrics = Drive(design.mechanism.skeleton), design.metrics
    if not drive.follow(-0.1, math.tau + math.pi):
        result.left[f"{design.mechanism.type}: could not be driven"] += 1
        return set()
    output = Output(drive, design.mechanism.type)
    unit = 180.0 / math.pi if output.turns else 1.0
    top, foot = greatest(output.at, 0.0, math.tau).value, least(output.at, 0.0, math.tau).value
    way = (top - foot) * unit
    result.add("dwell way", metrics.way, way, way, name)
    angle = math.radians(stated["dwell_angle"])
    jitters = []
    for rest in design.targets:
        begin = (math.radians(rest.input_angle) - drive.reference) % math.tau
        begin = begin - math.tau if begin > math.tau - 0.05 else begin
        over, under = (find(output.at, begin, begin + angle).value for find in (greatest, least))
        jitters.append((over - under) * unit)
        result.add("dwell jitter of a rest", rest.jitter, jitters[-1], way, name)
        level = 0.5 * (over + under) * unit
        turns = round((rest.level - level) / 360.0) * 360.0 if output.turns else 0.0
        result.add("dwell level", rest.level, level + turns, way, name)
    result.add("dwell jitter", metrics.jitter, max(jitters), way, name)
    for metric, function in (("peak_velocity", output.rate), ("peak_acceleration", output.acceleration)):
        peak = greatest(_magnitude(function), 0.0, math.tau).value
        result.add(f"dwell {metric}", getattr(metrics, metric), peak, peak, name)
    places = drive.at(np.linspace(0.0, math.tau, 2881)).ravel()
    task = way if not output.turns else 2.0 * abs(drive.home[drive.names.index("A")] - drive.home[0])
    ways = compare_linkage(result, "dwell", design, drive, name, way=(0.0, math.tau), task=task, places=places)
    checks = {f"check {c.name}" for c in design.verification.checks if c.name in ("dwell_1", "dwell_2")}
    for k, check in enumerate(c for c in design.verification.checks if c.name in ("dwell_1", "dwell_2")):
        result.add("dwell check dwell", check.value, jitters[k], way, name)
    for check in design.verification.checks:
        if check.name == "way":
            wanted = stated["output"].get("swing", stated["output"].get("stroke"))
            result.add("dwell check way", check.value, abs(way / wanted - 1.0), 1.0, name)
    return ways | checks | {"way", "jitter", "peak_velocity", "peak_acceleration", "check way"}


def compare_quick_return(result: Measured, stated: dict[str, Any], design: Any, name: str) -> set[str]:
    """The limits of the output, and the times between them."""
    drive, metrics = Drive(design.mechanism.skeleton), design.metrics
    if not drive.follow(-0.1, math.tau + 0.1):
        result.left[f"{design.mechanism.type}: could not be driven"] += 1
        return set()
    output = Output(drive, design.mechanism.type)
    unit = 180.0 / math.pi if output.turns else 1.0
    top, foot = (find(output.at, 0.0, math.tau) for find in (greatest, least))
    # Where the output stands still its rate goes through nothing, which is sharper than the extreme itself.
    ends = [_root(output.rate, end.at) for end in (top, foot)]
    apart = (ends[1] - ends[0]) % math.tau
    slow, fast = max(apart, math.tau - apart), min(apart, math.tau - apart)
    way = (top.value - foot.value) * unit
    result.add("quick_return time_ratio", metrics.time_ratio, slow / fast, slow / fast, name)
    result.add("quick_return slow_rotation", metrics.slow_rotation, math.degrees(slow), 360.0, name)
    result.add("quick_return fast_rotation", metrics.fast_rotation, math.degrees(fast), 360.0, name)
    result.add("quick_return swing", metrics.swing, way, way, name)
    result.add("quick_return stroke", metrics.stroke, way, way, name)
    places = drive.at(np.linspace(0.0, math.tau, 1441)).ravel()
    task = way
    if output.turns:
        pivot, pin = output.pins
        task = 2.0 * abs(drive.home[pin] - drive.home[pivot]) * math.sin(0.5 * math.radians(way))
    ways = compare_linkage(result, "quick_return", design, drive, name, way=(0.0, math.tau), task=task, places=places)
    for check in design.verification.checks:
        of = {"time_ratio": slow / fast, "swing": way, "stroke": way}.get(check.name)
        if of is not None and stated.get(check.name) is not None:
            result.add(f"quick_return check {check.name}", check.value, abs(of / stated[check.name] - 1.0), 1.0, name)
    ways |= {"check time_ratio", "check swing", "check stroke"}
    return ways | {"time_ratio", "slow_rotation", "fast_rotation", "swing", "stroke"}


def _root(function: Callable[[Real], Real], near: float, width: float = 0.02) -> float:
    """Where a function that changes its sign about a place is nothing, by ever finer grids."""
    low, high = near - width, near + width
    sign = np.sign(function(np.array([low])))
    for _ in range(9):
        places = np.linspace(low, high, 41)
        beyond = np.flatnonzero(np.sign(function(places[1:-1])) != sign)
        k = int(beyond[0]) + 1 if len(beyond) else 40
        low, high = float(places[k - 1]), float(places[k])
    return 0.5 * (low + high)


def _magnitude(function: Callable[[Real], Real]) -> Callable[[Real], Real]:
    return lambda turns: np.abs(function(turns))
