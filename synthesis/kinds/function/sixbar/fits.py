"""Sixbars of a function task as fits of the engine (:mod:`synthesis.fit.linkage`).

The input is 0 in the reference position, at the middle one of the sample points. The scales k and l of input and output
are constants of a fit: its inputs are k (u − u₀), the targets of the output's direction l v. The linkage turns freely,
so that the output's zero is open; lengths have any unit.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.fit.linkage import setting as fields
from synthesis.fit.linkage.closure import trace_linkage
from synthesis.fit.linkage.descent import (
    MAX_SETTLING_CALLS,
    SETTLED_INPUT,
    Fit,
    FitRows,
    FitTask,
    build_function_targets,
    evaluate_rows,
)
from synthesis.fit.linkage.setting import pack_topology, pack_unlimited
from synthesis.fit.linkage.topology import Topology
from synthesis.kinds.function.fourbar.constraints import DEFAULT_MAX_RATIO, LIMIT_MARGIN
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.statement.mechanism_types import Multiloop
from synthesis.results.practicality import MAX_LINK_RATIO

ANGLE_MARGIN = math.radians(0.02)
"""Margin, radians, added to a required transmission angle at the samples, because it is smaller between them."""

SMALL_ROOT = 1e-5
"""Root of the output's weight relative to the input's that leaves all of a Stephenson II's error to the output."""


@dataclass(frozen=True, eq=False)
class SixbarCandidate:
    """A candidate sixbar or eightbar.

    Attributes
    ----------
    type : str
    fit : Fit
        Its unknowns, and the inputs that drive it at the points of its task.
    inputs : float, shape (m,)
        Inputs u at the points of its fit, increasing.
    reference : float
        Input u₀ of the reference position.
    scales : pair of float
        k and l.
    error : float
        In the criterion's norm, radians.
    """

    type: Multiloop
    fit: Fit
    inputs: Real
    reference: float
    scales: tuple[float, float]
    error: float = math.inf

    @property
    def topology(self) -> Topology:
        """The sixbar's topology."""
        return self.fit.topology

    @property
    def start(self) -> float:
        """The input link's angle at input 0, radians."""
        first, second = self.topology.get_direction("input")
        x = self.fit.x
        return math.atan2(x[2 * second + 1] - x[2 * first + 1], x[2 * second] - x[2 * first]) - (
            self.scales[0] * self.reference
        )

    def compute_rotations(self, inputs: Real) -> Real:
        """Return rotations of the input link from the reference position."""
        return np.asarray(self.scales[0] * (inputs - self.reference))


class SixbarMotion(NamedTuple):
    """Motion of a sixbar through inputs (m,): places of the nodes (m, n), and cosines of the dyads that transmit."""

    places: Complex
    cosines: Real


def build_packer(problem: FunctionProblem, least: float, ratio: float) -> Callable[[Topology], Real]:
    """Return a function that packs the limits on a topology.

    ``least`` is the minimum transmission angle, degrees, and ``ratio`` the maximum link ratio. Limits that depend on
    the place of the sixbar are left out: it is chosen after the search.
    """
    lengths = problem.constraints.link_length
    if lengths is not None and lengths.min > 0.0 and lengths.max is not None:
        ratio = min(ratio, lengths.max / lengths.min)
    cosine = compute_max_cosine(least)

    @cache
    def pack_limits(topology: Topology) -> Real:
        out = pack_topology(topology)
        out[fields.COSINE], out[fields.RATIO] = cosine, ratio / (1.0 + LIMIT_MARGIN)
        return out

    return pack_limits


def list_ratios(problem: FunctionProblem) -> list[float]:
    """Return the maximum link ratios with which linkages are searched, until one search succeeds.

    The default of fourbars, 100, cannot be built; with more loops the error is mostly small without long links.
    """
    given = problem.constraints.max_link_ratio
    widest = DEFAULT_MAX_RATIO if given is None else min(given, DEFAULT_MAX_RATIO)
    is_requested = "max_link_ratio" in problem.constraints.model_fields_set
    return [widest] if is_requested or widest <= MAX_LINK_RATIO else [MAX_LINK_RATIO, widest]


def compute_max_cosine(least: float) -> float:
    """Return the maximum cosine for a minimum transmission angle, degrees, including the margin."""
    return math.cos(math.radians(least) + ANGLE_MARGIN) - LIMIT_MARGIN


def build_fit_task(
    topology: Topology, rotations: Real, outputs: Real, roots: Real, pack_limits: Callable[[Topology], Real], steps: int
) -> FitTask:
    """Build the fit of one topology to outputs at rotations of the input, both (m,) in radians."""
    if not topology.triad:
        targets = build_function_targets(rotations, outputs, roots)
        return FitTask(targets, pack_limits, full_turn=False, steps=steps)
    # A linkage that carries its ground is constrained at its targets.
    targets = build_function_targets(rotations, outputs, roots, float(roots.max()))
    return FitTask(targets, pack_limits, full_turn=False, steps=len(rotations) if steps > 0 else 0)


def _build_exact_task(
    one: SixbarCandidate, inputs: Real, outputs: Real, pack_limits: Callable[[Topology], Real], steps: int
) -> FitTask:
    """Build a task whose linkage is closed: the output alone has errors, of weight :data:`SMALL_ROOT` squared."""
    roots, length_root = np.full(len(inputs), SMALL_ROOT), 1.0 if one.topology.triad else None
    targets = build_function_targets(one.compute_rotations(inputs), one.scales[1] * outputs, roots, length_root)
    return FitTask(targets, pack_limits, full_turn=False, steps=steps)


def evaluate_errors(one: SixbarCandidate, inputs: Real, outputs: Real) -> tuple[Fit, Real, Real] | None:
    """Return the fit at inputs (m,), the errors of its output (m,), and their derivatives by its unknowns (m, u).

    None if the sixbar cannot be assembled at one of them.
    """
    inverted, task = bool(one.topology.triad), _build_exact_task(one, inputs, outputs, pack_unlimited, 0)
    thetas = np.interp(inputs, one.inputs, one.fit.inputs) if inverted else one.compute_rotations(inputs)
    fit = one.fit._replace(inputs=np.ascontiguousarray(thetas))
    for _ in range(MAX_SETTLING_CALLS):
        rows = evaluate_rows(fit, task)
        if rows is None:
            return None
        before, fit = fit.inputs, fit._replace(inputs=rows.inputs)
        if not inverted:
            return fit, rows.residuals / SMALL_ROOT, rows.jacobian / SMALL_ROOT
        # Residuals alternate between the output's length and its direction.
        if np.abs(rows.inputs - before).max() < SETTLED_INPUT:
            return fit, rows.residuals[1::2] / SMALL_ROOT, rows.jacobian[1::2] / SMALL_ROOT
    return None


def evaluate_margins(
    one: SixbarCandidate, ends: Real, pack_limits: Callable[[Topology], Real], steps: int
) -> FitRows | None:
    """Return the margins of a sixbar at equal steps between two inputs; None if it cannot be assembled there."""
    # A linkage that carries its ground is constrained at its targets.
    inputs = np.linspace(ends[0], ends[1], steps) if one.topology.triad else ends
    zeros = np.zeros(len(inputs))
    evaluated = evaluate_errors(one, inputs, zeros)
    if evaluated is None:
        return None
    return evaluate_rows(evaluated[0], _build_exact_task(one, inputs, zeros, pack_limits, steps))


def measure_motion(one: SixbarCandidate, inputs: Real) -> SixbarMotion | None:
    """Drive a sixbar through inputs (m,); None if it cannot be assembled at one of them."""
    zeros = np.zeros(len(inputs))
    evaluated = evaluate_errors(one, inputs, zeros)
    if evaluated is None:
        return None
    nodes, m = one.topology.nodes, len(inputs)
    places, cosines = np.empty((m, len(nodes), 2)), np.zeros((m, len(nodes)))
    trace_linkage(nodes, one.fit.x, evaluated[0].inputs, places, cosines)
    joints = places[..., 0] + 1j * places[..., 1]
    if one.topology.triad:
        # The input link sees all joints; the ground sees those that are not its own turned with it.
        first, second = one.topology.fixed_pivots
        pivot, ground = joints[:, first, None].copy(), joints[:, second].copy()
        joints = pivot + np.exp(1j * one.compute_rotations(inputs))[:, None] * (joints - pivot)
        joints[:, second] = ground
    return SixbarMotion(joints, cosines[:, one.topology.transmitting])
