"""Families of fourbars whose curves are compared with a path, and the joints of a member."""

from __future__ import annotations

import cmath

import numpy as np

from kinematics.arrays import Real
from synthesis.fit.chart import CRANK_ROCKER, DOUBLE_CRANK, FOURBAR, compute_lengths
from synthesis.fit.coupler_curve import place_linkage
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage.conversion import FourbarConfiguration


def list_families(problem: PathProblem) -> list[int]:
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


def compute_joints(family: int, x: Real, sign: float, theta: float) -> tuple[bool, FourbarConfiguration]:
    """Return whether a member closes, away from a toggle, with its crank at ``theta``, radians, and its joints."""
    lengths, chart = np.zeros(4), np.zeros((4, 4))
    compute_lengths(family, x, lengths, chart)
    closes, p, unit = place_linkage(family, x, lengths, sign, 0.0, theta)
    o2 = complex(x[0], x[1])
    a = o2 + cmath.rect(float(lengths[1]), theta)
    o4 = o2 + cmath.rect(float(lengths[0]), float(x[2]))
    return closes, FourbarConfiguration(o2, a, a + lengths[2] * unit, o4, p)
