"""Weights that cancel the primary and secondary harmonics of an engine, and the overbalance of a single cylinder."""

from __future__ import annotations

import cmath
import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from kinematics.arrays import Real
from kinematics.engine.harmonics import compute_turning_parts
from synthesis.kinds.engine.arrangement import Cylinders, compute_middle
from synthesis.kinds.engine.design import Balancer, Overbalance
from synthesis.kinds.engine.forces import build_masses, compute_cylinder
from synthesis.kinds.engine.problem import EngineProblem

NEGLIGIBLE_PART = 1e-9
"""Part of a harmonic, in units of one cylinder's, that counts as zero."""

POSITION_COUNT = 1440
"""Number of positions per turn for peaks, at a spacing of a quarter of a degree."""


def find_balancers(problem: EngineProblem, cylinders: Cylinders, series: dict[int, float]) -> list[Balancer]:
    """Find balancers of the first two orders, forces first; moments are about the middle of the engine."""
    axis, top = np.radians(cylinders.axis), np.radians(cylinders.top)
    # The crank angle is 0 if the first throw is at the top dead centre of an upright cylinder.
    turned = float(np.radians(cylinders.phase[0]))
    places = cylinders.place - compute_middle(cylinders.place)
    found = []
    for order in (1, 2):
        for against, weight in (("force", np.ones(len(axis))), ("moment", places)):
            parts = compute_turning_parts(order, axis, top - turned, weight)
            listed = _build_balancer(
                problem, against, order, complex(parts.forward), complex(parts.backward), series[order]
            )
            if listed is not None:
                found.append(listed)
    return found


def _build_balancer(
    problem: EngineProblem, against: str, order: int, forward: complex, backward: complex, coefficient: float
) -> Balancer | None:
    """Build weights opposite to both parts of a harmonic, with m R (kω)² = part · m_B r ω² A_k."""
    sizes = abs(forward), abs(backward)
    if max(sizes) <= NEGLIGIBLE_PART:
        return None
    # A weight that rotates at k times the crank's speed has k² times the effect.
    share = coefficient / order**2
    form: Literal["crankshaft_weights", "counter_shaft", "lanchester_pair", "shafts"] = "shafts"
    # Equal parts form a planar harmonic; a single part is a rotating vector.
    if abs(sizes[0] - sizes[1]) <= NEGLIGIBLE_PART:
        form = "lanchester_pair"
    elif sizes[1] <= NEGLIGIBLE_PART and order == 1:
        form = "crankshaft_weights"
    elif sizes[0] <= NEGLIGIBLE_PART and order == 1:
        form = "counter_shaft"
    upright = problem.layout.type == "inline" and order == 2 and against == "force"
    return Balancer.model_validate(
        {
            "against": against,
            "order": order,
            "form": form,
            "forward": sizes[0] * share if sizes[0] > NEGLIGIBLE_PART else 0.0,
            "forward_angle": _compute_opposite_angle(forward) if sizes[0] > NEGLIGIBLE_PART else 0.0,
            "backward": sizes[1] * share if sizes[1] > NEGLIGIBLE_PART else 0.0,
            "backward_angle": _compute_opposite_angle(backward) if sizes[1] > NEGLIGIBLE_PART else 0.0,
            "height_difference": problem.rod_length if upright and form == "lanchester_pair" else None,
        }
    )


def _compute_opposite_angle(part: complex) -> float:
    return math.degrees(cmath.phase(-part)) % 360.0


def compute_peak(problem: EngineProblem, speed: float, *, turning: bool, share: float) -> float:
    """Compute the peak shaking force of one cylinder whose counterweight carries a share of m_B.

    ``turning`` is true if all rotating masses are balanced, too (Norton, Sec. 13.10).
    """
    degrees = 360.0 * np.arange(POSITION_COUNT) / POSITION_COUNT
    return _compute_peak_of_force(
        problem, speed, _compute_uncountered_force(problem, speed, degrees, turning=turning), degrees, share
    )


def _compute_uncountered_force(
    problem: EngineProblem, speed: float, degrees: Real, *, turning: bool
) -> NDArray[np.complex128]:
    shaking, masses = compute_cylinder(problem, degrees, speed).shaking, build_masses(problem)
    unit = speed**2 * np.exp(1j * np.radians(degrees))
    own = masses.turning
    if turning:
        # Exact balance cancels both the throw and the rod's part at the crank pin.
        own = -masses.rod.crank_pin * problem.scale * problem.crank
    return np.asarray(shaking + own * unit)


def _compute_peak_of_force(
    problem: EngineProblem, speed: float, force: NDArray[np.complex128], degrees: Real, share: float
) -> float:
    masses = build_masses(problem)
    weight = share * (masses.piston + masses.rod.wrist_pin) * problem.scale * problem.crank * speed**2
    return float(np.abs(force - weight * np.exp(1j * np.radians(degrees))).max())


def find_overbalance(problem: EngineProblem, speed: float) -> Overbalance:
    """Find the share of m_B on the counterweight for the minimum peak, which is a convex function of the share."""
    degrees = 360.0 * np.arange(POSITION_COUNT) / POSITION_COUNT
    force = _compute_uncountered_force(problem, speed, degrees, turning=True)
    best = minimize_scalar(
        lambda share: _compute_peak_of_force(problem, speed, force, degrees, share),
        bounds=(0.0, 1.0),
        options={"xatol": 1e-10},
    )
    return Overbalance(
        share=float(best.x),
        peak=float(best.fun),
        unbalanced_peak=compute_peak(problem, speed, turning=False, share=0.0),
        exact_balance_peak=compute_peak(problem, speed, turning=True, share=0.0),
    )
