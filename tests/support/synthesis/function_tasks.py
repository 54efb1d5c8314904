"""Tasks of function generation for tests: those of the literature, and planted linkages with their pairs."""

import json
import math
from pathlib import Path

import numpy as np

from kinematics.linkage.fourbar import Fourbar, positions
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.solver import solve_function

CASES = json.loads((Path(__file__).parents[2] / "cases" / "function_generation.json").read_text())
NAMES = {
    "log10": {"name": "logarithm"},
    "x^1.5": {"name": "power", "exponent": 1.5},
    "sin_deg": {"name": "sine"},
    "exp": {"name": "exponential"},
    "1/x": {"name": "reciprocal"},
    "tan_deg": {"name": "tangent"},
}
UNBOUNDED = {"max_link_ratio": None}


def silent(_fraction, _message):
    pass


def solved(**fields):
    problem = FunctionProblem(kind="function", **fields)
    assert problem.find_contradictions() == []
    return solve_function(problem, silent)


def task_of(case):
    inputs = case["inputs"]
    return {
        "function": {**NAMES[inputs["func"]], "x": [inputs["x0"], inputs["x1"]]},
        "input_range": inputs["dphi_deg"],
        "output_range": inputs["dpsi_deg"],
        "constraints": UNBOUNDED,
    }


def planted_fourbar(rng, count, inputs=None):
    """A random fourbar driven over a range without toggles: lengths, pairs in degrees from the ground line."""
    while True:
        a, b, c = np.exp(rng.uniform(-1.0, 1.0, 3))
        start, turned = rng.uniform(-math.pi, math.pi), math.radians(rng.uniform(50.0, 120.0))
        shares = np.sort(rng.uniform(0.0, 1.0, count)) if inputs is None else inputs
        theta = start + turned * shares
        linkage, sign = Fourbar(0.0, 1.0, a, b, c), int(rng.choice([-1, 1]))
        dense = positions(linkage, start + turned * np.linspace(0.0, 1.0, 200), sign)
        sine = np.abs(np.sin(dense.output_angle - dense.coupler_angle))
        at = positions(linkage, theta, sign).output_angle
        if np.all(dense.valid) and sine.min() > 0.3 and np.diff(theta).min() > 0.03:
            moved = np.unwrap(at)
            if np.ptp(moved) > 0.3:
                return (a, b, c), np.degrees(theta), np.degrees(moved)


def proportions(design):
    links = design.mechanism.links
    return np.array([links.input, links.coupler, links.output]) / links.ground


def holds(result, lengths, digits=1e-6):
    """Whether a planted linkage, or its mirror image, is among the designs."""
    return any(np.allclose(proportions(design), lengths, rtol=digits) for design in result.designs)


def pairs_of(inputs, outputs):
    return [{"input": float(x), "output": float(y)} for x, y in zip(inputs, outputs, strict=True)]


def scaled_pairs(rng, lengths_and_pairs):
    """Pairs of a planted linkage on scales that are not told: six keep the input's."""
    lengths, inputs, outputs = lengths_and_pairs
    k, scale = rng.uniform(0.5, 2.0, 2)
    k = 1.0 if len(inputs) == 6 else k
    return lengths, pairs_of((inputs - inputs[0]) / k, (outputs - outputs[0]) / scale)


def measured_function(function, x):
    """Values of a function that a statement names, in its own words."""
    return {
        "logarithm": np.log10,
        "power": lambda x: x ** function.get("exponent", 1.0),
        "sine": lambda x: np.sin(np.radians(x)),
        "exponential": np.exp,
        "reciprocal": lambda x: 1.0 / x,
        "tangent": lambda x: np.tan(np.radians(x)),
    }[function["name"]](x)


def measured(design, problem_task, shares):
    """Structural error in degrees at shares of the range, by the triangle A B O4 and the dials."""
    m, dials = design.mechanism, design.dials
    low, high = problem_task["function"]["x"]
    x = low + (high - low) * shares
    y = measured_function(problem_task["function"], x)
    o2, o4 = complex(*m.fixed_pivots.input), complex(*m.fixed_pivots.output)
    theta = np.radians(dials.input.place + dials.input.scale * (x - dials.input.at))
    away = o4 - o2 - m.links.input * np.exp(1j * theta)
    f = np.abs(away)
    corner = np.arccos((f**2 + m.links.output**2 - m.links.coupler**2) / (2.0 * f * m.links.output))
    output = np.angle(-away) + (-corner if m.assembly == "open" else corner)
    wanted = np.radians(dials.output.place + dials.output.scale * (y - dials.output.at))
    return np.degrees(np.angle(np.exp(1j * (output - wanted))))
