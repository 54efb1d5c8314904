"""Weights that cancel the primary and secondary harmonics of an engine, and the overbalance of a single cylinder."""

from __future__ import annotations

import cmath
import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from kinematics.engine.harmonics import turning_parts
from synthesis.kinds.engine.arrangement import Cylinders, middle_of
from synthesis.kinds.engine.design import Balancer, Overbalance
from synthesis.kinds.engine.forces import masses_of, one_cylinder
from synthesis.kinds.engine.problem import EngineProblem

Real = NDArray[np.float64]

NONE = 1e-9
"""Part of a harmonic, in units of one cylinder's, that counts as zero."""

QUARTERS = 1440
"""Number of positions of a turn over which peaks are taken: a quarter of a degree apart."""


def balancers_of(problem: EngineProblem, cylinders: Cylinders, series: dict[int, float]) -> list[Balancer]:
    """Find balancers of the first two orders, forces first; moments are about the middle of the engine."""
    axis, top = np.radians(cylinders.axis), np.radians(cylinders.top)
    # The crank angle is 0 when its first throw is: at the top dead centre of an upright cylinder there.
    turned = float(np.radians(cylinders.phase[0]))
    places = cylinders.place - middle_of(cylinders.place)
    found = []
    for order in (1, 2):
        for against, weight in (("force", np.ones(len(axis))), ("moment", places)):
            parts = turning_parts(order, axis, top - turned, weight)
            listed = _balancer(problem, against, order, complex(parts.forward), complex(parts.backward), series[order])
            if listed is not None:
                found.append(listed)
    return found


def _balancer(
    problem: EngineProblem, against: str, order: int, forward: complex, backward: complex, coefficient: float
) -> Balancer | None:
    """Build weights opposite to both parts: m R (kω)² = part · m_B r ω² A_k."""
    sizes = abs(forward), abs(backward)
    if max(sizes) <= NONE:
        return None
    # A weight at k times the crank's speed has k² times the effect.
    share = coefficient / order**2
    form: Literal["crankshaft_weights", "counter_shaft", "lanchester_pair", "shafts"] = "shafts"
    # The form follows from the parts: equal ones are a planar harmonic, a single one rotates.
    if abs(sizes[0] - sizes[1]) <= NONE:
        form = "lanchester_pair"
    elif sizes[1] <= NONE and order == 1:
        form = "crankshaft_weights"
    elif sizes[0] <= NONE and order == 1:
        form = "counter_shaft"
    upright = problem.layout.type == "inline" and order == 2 and against == "force"
    return Balancer.model_validate(
        {
            "against": against,
            "order": order,
            "form": form,
            "forward": sizes[0] * share if sizes[0] > NONE else 0.0,
            "forward_angle": _opposite(forward) if sizes[0] > NONE else 0.0,
            "backward": sizes[1] * share if sizes[1] > NONE else 0.0,
            "backward_angle": _opposite(backward) if sizes[1] > NONE else 0.0,
            "height_difference": problem.rod_length if upright and form == "lanchester_pair" else None,
        }
    )


def _opposite(part: complex) -> float:
    return math.degrees(cmath.phase(-part)) % 360.0


def peak_of_shares(problem: EngineProblem, speed: float, *, turning: bool, share: float) -> float:
    """Compute the peak shaking force of one cylinder whose counterweight carries a share of m_B.

    ``turning``: whether all rotating masses are balanced too. Norton, Sec. 13.10; peaks over quarters of a degree.
    """
    degrees = 360.0 * np.arange(QUARTERS) / QUARTERS
    return _peak(problem, speed, _uncounted(problem, speed, degrees, turning=turning), degrees, share)


def _uncounted(problem: EngineProblem, speed: float, degrees: Real, *, turning: bool) -> NDArray[np.complex128]:
    shaking, masses = one_cylinder(problem, degrees, speed).shaking, masses_of(problem)
    unit = speed**2 * np.exp(1j * np.radians(degrees))
    own = masses.turning
    if turning:
        # Balanced exactly: neither the throw nor the rod's part at its pin remains.
        own = -masses.rod.crank_pin * problem.scale * problem.crank
    return np.asarray(shaking + own * unit)


def _peak(problem: EngineProblem, speed: float, force: NDArray[np.complex128], degrees: Real, share: float) -> float:
    masses = masses_of(problem)
    weight = share * (masses.piston + masses.rod.wrist_pin) * problem.scale * problem.crank * speed**2
    return float(np.abs(force - weight * np.exp(1j * np.radians(degrees))).max())


def overbalance_of(problem: EngineProblem, speed: float) -> Overbalance:
    """Find the share of minimum peak, in which the peak is convex."""
    degrees = 360.0 * np.arange(QUARTERS) / QUARTERS
    force = _uncounted(problem, speed, degrees, turning=True)
    best = minimize_scalar(
        lambda share: _peak(problem, speed, force, degrees, share), bounds=(0.0, 1.0), options={"xatol": 1e-10}
    )
    return Overbalance(
        share=float(best.x),
        peak=float(best.fun),
        unbalanced_peak=peak_of_shares(problem, speed, turning=False, share=0.0),
        exact_balance_peak=peak_of_shares(problem, speed, turning=True, share=0.0),
    )
