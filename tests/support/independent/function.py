"""Answers whose output follows the input by a function or by pairs (docs/tasks/function.md)."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from kinematics.arrays import Real
from tests.support.independent.comparison import Beside
from tests.support.independent.drive import Drive
from tests.support.independent.extremes import GRID, greatest, least
from tests.support.independent.linkage import Used, compare_linkage
from tests.support.independent.output import Output

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

EXACT = 1e-6
"""Errors below this, degrees or length units, are compared as they are and not by their size."""

PANELS, NODES = 200, 10
"""Panels of the range for the mean square of an error, and nodes of Gauss's quadrature in each."""

LEVEL = 1e-3
"""Extremes within this share of the greatest error have reached it."""


class Dialled:
    """A linkage with its dials: the error of its output over the values of its input."""

    def __init__(self, design: Any, drive: Drive) -> None:
        self.drive, self.dials = drive, design.dials
        self.output = Output(drive, design.mechanism.type)
        # A slider's place is from the foot of the fixed pivot.
        along = np.conj(self.output.along) if not self.output.turns else 1.0
        self.foot = 0.0 if self.output.turns else float(((self.output.point - drive.home[0]) * along).real)
        self.unit = 180.0 / math.pi if self.output.turns else 1.0
        self.began = math.degrees(drive.reference)
        self.shift = 0.0
        first = self.turns(np.array([design.targets[0].input]))
        self.shift = math.tau * round(float(first[0]) / math.tau)

    def place(self, values: Real, side: str) -> Real:
        """Where a dial has values: degrees, or a place along the slide."""
        dial = getattr(self.dials, side)
        return np.asarray(dial.place + dial.scale * (values - dial.at))

    def turns(self, values: Real) -> Real:
        """How far the input has moved from the skeleton's configuration at values of the input."""
        return np.asarray(np.radians(self.place(values, "input") - self.began) - self.shift)

    def error(self, turns: Real, demanded: Real) -> Real:
        """What the output is off the demanded values, degrees or length units."""
        off = self.unit * self.output.at(turns) + self.foot - self.place(demanded, "output")
        return np.asarray((off + 180.0) % 360.0 - 180.0 if self.output.turns else off)


def compare_function(beside: Beside, stated: dict[str, Any]) -> None:
    """Structural errors at the targets and over the range."""
    design = beside.design
    drive, metrics = Drive(design.mechanism.skeleton), design.metrics
    dialled = Dialled(design, drive)
    inputs = np.array([target.input for target in design.targets])
    demanded = np.array([target.output for target in design.targets])
    function = stated.get("function")
    if function is not None and function["name"] not in FUNCTIONS:
        beside.unmeasured(f"functions by {function['name']}")
        return
    ends = inputs if function is None else np.array([float(value) for value in function["x"]])
    turned, whole = dialled.turns(inputs), dialled.turns(ends)
    low, high = float(min(turned.min(), whole.min())), float(max(turned.max(), whole.max()))
    if not drive.follow(low, high):
        beside.unmeasured("could not be driven")
        return
    width = _width(stated, metrics)
    scale = 90.0 if dialled.output.turns else width
    errors = dialled.error(turned, demanded)
    residuals = np.abs(errors) / (dialled.unit if dialled.output.turns else width)
    for k, target in enumerate(design.targets):
        place = dialled.place(demanded[k : k + 1], "output")[0] + errors[k]
        values = {
            "input": _stated_input(stated, design, k),
            "output": target.output if function is None else float(FUNCTIONS[function["name"]](inputs[k], function)),
            "input_angle": float(dialled.place(inputs, "input")[k]),
            "output_place": float(place),
            "error": float(errors[k]),
            "residual": float(residuals[k]),
        }
        scales = {"input": abs(ends[-1] - ends[0]), "output": max(abs(target.output), 1e-3), "input_angle": 360.0}
        scales |= {"output_place": 4.0 * scale, "error": scale, "residual": 1.0}
        for name, value in values.items():
            beside.add(f"targets.{name}", getattr(target, name), value, scales[name])
    beside.check("reaches_targets", float(residuals.max()))
    beside.check("covers_range", True)
    beside.check("dials", _dials_off(stated, dialled))
    beside.metric("rms_residual", math.sqrt(float(np.mean(residuals**2))), 1.0)
    beside.metric("input_rotation", math.degrees(whole[-1] - whole[0]), 360.0)
    at_ends = demanded[[0, -1]] if function is None else FUNCTIONS[function["name"]](ends, function)
    places = dialled.place(at_ends, "output")
    beside.metric("output_range", float(places[1] - places[0]), 4.0 * scale)
    if function is None:
        _compare_pairs(beside, inputs, turned, errors)
    else:
        _compare_errors(beside, dialled, function)
    task = None if dialled.output.turns else width
    steps = np.diff(turned)
    in_order = bool((steps > 0).all() or (steps < 0).all())
    used = Used((float(whole.min()), float(whole.max())), task, drive.at(turned).ravel(), in_order=in_order)
    compare_linkage(beside, stated, drive, used)


def _width(stated: dict[str, Any], metrics: Any) -> float:
    """The range of the output that is asked for."""
    if stated.get("pairs") is not None:
        outputs = [pair["output"] for pair in stated["pairs"]]
        return float(max(outputs) - min(outputs))
    wanted = stated.get("output_range")
    if isinstance(wanted, list | tuple):
        return abs(float(wanted[1] - wanted[0]))
    return abs(float(wanted)) if wanted is not None else 1.0


def _stated_input(stated: dict[str, Any], design: Any, k: int) -> float:
    """The value of the input at a target: of the pair, Chebyshev's, or an equal share of the range."""
    if stated.get("pairs") is not None:
        return float(stated["pairs"][k]["input"])
    low, high = (float(value) for value in stated["function"]["x"])
    count = len(design.targets)
    if any(check.name == "reaches_targets" for check in design.verification.checks):
        if stated.get("spacing") == "equal":
            return design.targets[k].input
        share = 0.5 - 0.5 * math.cos(math.pi * (2 * k + 1) / (2 * count))
    else:
        share = k / (count - 1)
    return low + share * (high - low)


def _dials_off(stated: dict[str, Any], dialled: Dialled) -> float:
    """How far ranges, scales and zeros are from those that are stated: shares of a range, and radians."""
    off = [0.0]
    for side in ("input", "output"):
        scale = getattr(dialled.dials, side).scale
        if stated.get("function") is not None:
            name, x = stated["function"]["name"], np.linspace(*(float(v) for v in stated["function"]["x"]), 4001)
            values = x if side == "input" else FUNCTIONS[name](x, stated["function"])
            turned, wanted = abs(scale) * float(np.ptp(values)), stated.get(f"{side}_range")
            if isinstance(wanted, list | tuple):
                wanted = wanted[1] - wanted[0]
            if wanted is not None:
                off.append(abs(turned / abs(wanted) - 1.0))
            first, begins = float(values[0]), 0.0
        else:
            wanted = (stated.get("scales") or {}).get(side)
            if wanted is not None:
                off.append(abs(scale / wanted - 1.0))
            first = float(stated["pairs"][0][side])
            begins = scale * first
        zeros = stated.get("zeros")
        if isinstance(zeros, dict) and zeros.get(side) is not None:
            dial = getattr(dialled.dials, side)
            stands = dial.place + dial.scale * (first - dial.at)
            if side == "output" and not dialled.output.turns:
                off.append(abs(stands - zeros[side] - begins))
            else:
                drive = dialled.drive
                frame = drive.home[drive.names.index("O4")] - drive.home[0] if dialled.output.turns else None
                lean = math.degrees(float(np.angle(dialled.output.along if frame is None else frame)))
                off.append(math.radians(abs(math.remainder(stands - lean - zeros[side] - begins, 360.0))))
    return max(off)


def _compare_pairs(beside: Beside, inputs: Real, turned: Real, errors: Real) -> None:
    """The errors at pairs: the greatest, the mean square, and those that alternate."""
    error = beside.design.structural_error
    most, rms = float(np.abs(errors).max()), math.sqrt(float(np.mean(errors**2)))
    _compare_error(beside, most, rms)
    for stated, listed in (("extremes", error.extremes), ("curve", None)):
        values = [e.input for e in listed] if listed is not None else error.curve.input
        found = [e.error for e in listed] if listed is not None else error.curve.error
        angles = [e.input_angle for e in listed] if listed is not None else error.curve.input_angle
        for k in range(len(inputs)):
            beside.add(f"structural_error.{stated}.input", values[k], float(inputs[k]), max(abs(inputs[k]), 1.0))
            beside.add(f"structural_error.{stated}.error", found[k], float(errors[k]), max(most, EXACT))
            beside.add(f"structural_error.{stated}.input_angle", angles[k], beside.design.targets[k].input_angle, 360.0)
    if most > EXACT:
        reached = np.sign(errors[np.abs(errors) >= (1.0 - LEVEL) * most])
        beside.same("structural_error.alternations", error.alternations, 1 + int((np.diff(reached) != 0.0).sum()))
    else:
        beside.without("structural_error.alternations", "errors that are rounding")


def _compare_error(beside: Beside, most: float, rms: float) -> None:
    error = beside.design.structural_error
    beside.metric("max_structural_error", most, max(most, EXACT))
    beside.metric("rms_structural_error", rms, max(rms, EXACT))
    beside.add("structural_error.max", error.max, most, max(most, EXACT))
    beside.add("structural_error.rms", error.rms, rms, max(rms, EXACT))


def _compare_errors(beside: Beside, dialled: Dialled, function: dict[str, Any]) -> None:
    """The error over the range: the greatest, the mean square, its extremes and its curve."""
    x = [float(value) for value in function["x"]]
    ends = dialled.turns(np.array(x))

    def off(values: Real) -> Real:
        turns = np.clip(dialled.turns(values), ends.min(), ends.max())
        return dialled.error(turns, FUNCTIONS[function["name"]](values, function))

    most = max(greatest(off, *x).value, -least(off, *x).value)
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    edges = np.linspace(*x, PANELS + 1)
    values = (0.5 * (edges[1:] + edges[:-1])[:, None] + 0.5 * np.diff(edges)[:, None] * nodes).ravel()
    rms = math.sqrt(float((off(values).reshape(PANELS, NODES) ** 2 @ weights).mean()) / 2.0)
    _compare_error(beside, most, rms)
    error, scale = beside.design.structural_error, max(most, EXACT)
    shown = np.array(error.curve.input)
    for name, listed, at in (
        ("curve", np.array(error.curve.error), shown),
        ("extremes", np.array([e.error for e in error.extremes]), np.array([e.input for e in error.extremes])),
    ):
        worst = int(np.abs(off(at) - listed).argmax())
        beside.add(f"structural_error.{name}.error", float(listed[worst]), float(off(at[worst : worst + 1])[0]), scale)
        angles = np.array(error.curve.input_angle if name == "curve" else [e.input_angle for e in error.extremes])
        gap = int(np.abs(dialled.place(at, "input") - angles).argmax())
        beside.add(
            f"structural_error.{name}.input_angle",
            float(angles[gap]),
            float(dialled.place(at[gap : gap + 1], "input")[0]),
            360.0,
        )
    even = np.linspace(*x, len(shown))
    beside.add("structural_error.curve.input", float(np.abs(shown - even).max()), 0.0, abs(x[1] - x[0]))
    peaks = _extremes(off, x)
    # An extreme is as sharp as the error is there: its place is compared by the error that it has.
    heights = off(np.array(peaks))
    at_peaks = [float(np.abs(off(np.array([e.input]))[0] - heights).min()) for e in error.extremes]
    beside.add("structural_error.extremes.input", max(at_peaks), 0.0, scale)
    if most > EXACT:
        reached = np.sign(heights[np.abs(heights) >= (1.0 - LEVEL) * most])
        beside.same("structural_error.alternations", error.alternations, 1 + int((np.diff(reached) != 0.0).sum()))
    else:
        beside.without("structural_error.alternations", "errors that are rounding")


def _extremes(off: Callable[[Real], Real], x: list[float]) -> list[float]:
    """The ends of the range, and the places between them where the error turns."""
    places = np.linspace(*x, GRID)
    steps = np.diff(off(places))
    found = [x[0]]
    for k in np.flatnonzero(steps[1:] * steps[:-1] < 0.0).tolist():
        find = greatest if steps[k] > 0.0 else least
        found.append(find(off, float(places[k]), float(places[k + 2]), grid=21).at)
    return [*found, x[1]]
