"""Families of fourbars whose curves are compared with a path, and the joints of a member."""

from __future__ import annotations

import cmath

import numpy as np
from numpy.typing import NDArray

from synthesis.fit.chart import CRANK_ROCKER, DOUBLE_CRANK, FOURBAR, natural
from synthesis.fit.coupler_curve import place
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkages import FourbarConfiguration

Real = NDArray[np.float64]


def families_of(problem: PathProblem) -> list[int]:
    """Return the families of :mod:`synthesis.fit.chart` that may contain an answer."""
    grashof = problem.constraints.grashof
    if grashof == "crank_rocker":
        return [CRANK_ROCKER]
    if grashof == "double_crank":
        return [DOUBLE_CRANK]
    if problem.closed or problem.constraints.full_rotation:
        # Only these families have an input that turns through, which a closed curve requires.
        return [CRANK_ROCKER, DOUBLE_CRANK]
    return [FOURBAR] if grashof in ("double_rocker", "non_grashof") else [CRANK_ROCKER, FOURBAR]


def joints_of(family: int, x: Real, sign: float, theta: float) -> tuple[bool, FourbarConfiguration]:
    """Return whether a member closes, away from a toggle, with its crank at ``theta`` (radians); and its joints
    there."""
    lengths, chart = np.zeros(4), np.zeros((4, 4))
    natural(family, x, lengths, chart)
    closes, p, unit = place(family, x, lengths, sign, 0.0, theta)
    o2 = complex(x[0], x[1])
    a = o2 + cmath.rect(float(lengths[1]), theta)
    o4 = o2 + cmath.rect(float(lengths[0]), float(x[2]))
    return closes, FourbarConfiguration(o2, a, a + lengths[2] * unit, o4, p)
