"""A problem's constraints on sixbars and eightbars, packed for the engine (:mod:`synthesis.fit.linkage`)."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from kinematics.arrays import Real
from synthesis.fit import constraints
from synthesis.fit.linkage import setting as fields
from synthesis.fit.linkage.setting import pack_topology
from synthesis.fit.linkage.topology import Topology
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.curve_constraints import pack_curve_setting

WORKSPACE_MARGIN = 1e-4
"""Share of the task's size by which a box is shrunk: a joint may leave it between the steps of the crank."""

CLASS_LINKS = {"any": -1, "double_crank": 0, "crank_rocker": 1}
"""Shortest link of the first fourbar by the required class, in the order ground, input, coupler, output; −1 for any.
Other classes do not rotate fully."""


def build_packer(
    problem: PathProblem, centre: complex, size: float, degrees: float, ratio: float
) -> Callable[[Topology], Real]:
    """Return a function that packs the constraints for a topology.

    Parameters
    ----------
    problem : PathProblem
    centre, size : complex, float
        Origin and unit of the fits.
    degrees : float
        Least transmission angle.
    ratio : float
        Greatest link ratio.
    """
    # The constraints that do not depend on the type are those of fits of fourbars.
    plain = pack_curve_setting(problem, centre, size)
    # Only the box is constrained in fits; obstacles are checked on the driven linkage.
    room = None if problem.space is None else problem.space.shrink_box_for_joints(WORKSPACE_MARGIN * size)
    packed: dict[int, Real] = {}

    def pack_limits(topology: Topology) -> Real:
        if id(topology) not in packed:
            packed[id(topology)] = _pack_topology(topology, problem, plain, degrees, ratio)
            if room is not None:
                inside = (np.array(room) - np.repeat([centre.real, centre.imag], 2)) / size
                _narrow_boxes(packed[id(topology)], inside)
        return packed[id(topology)]

    return pack_limits


def _pack_topology(topology: Topology, problem: PathProblem, plain: Real, degrees: float, ratio: float) -> Real:
    """Pack the constraints without the workspace."""
    out = pack_topology(topology)
    if topology.families:
        out[fields.FAMILY] = CLASS_LINKS[problem.constraints.grashof]
    out[fields.COSINE] = min(plain[constraints.COSINE], math.cos(math.radians(degrees)))
    out[fields.RATIO] = min(plain[constraints.RATIO], ratio)
    out[fields.LINKS] = plain[constraints.LINKS]
    out[fields.INPUT_BOX], out[fields.PIVOT_BOX] = plain[constraints.INPUT_BOX], plain[constraints.OUTPUT_BOX]
    out[fields.GIVEN_PIVOTS], out[fields.MOVING_BOX] = plain[constraints.GIVEN_PIVOTS], plain[constraints.MOVING]
    return out


def _narrow_boxes(packed: Real, inside: Real) -> None:
    """Restrict all joints, and the boxes of fixed pivots, to a box."""
    packed[fields.WORKSPACE_BOX] = inside
    for box in (fields.INPUT_BOX, fields.PIVOT_BOX):
        # Minima are raised, maxima lowered.
        packed[box] = np.where(np.arange(4) % 2, np.minimum(packed[box], inside), np.maximum(packed[box], inside))
