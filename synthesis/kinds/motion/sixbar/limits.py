"""A problem's constraints on sixbars that carry a body, packed for the engine (:mod:`synthesis.fit.linkage`)."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from synthesis.fit.linkage import setting as fields
from synthesis.fit.linkage.setting import pack_topology
from synthesis.fit.linkage.topology import Topology
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.model.linkage.problem import Region
from synthesis.results.simplest_type import SOUND_TRANSMISSION_ANGLE

MIN_LINK_LENGTH = 0.02
"""Minimum length of a usable link, in task sizes."""

MAX_REACH, MAX_RATIO = 5.0, 20.0
"""Default limits: maximum distance of two joints of a link, in task sizes, and maximum link ratio."""

RELAXED_ANGLE, RELAXED_SIZE_FACTOR = 7.0, 3.0
"""Relaxed defaults: the transmission angle, degrees, and the factor of the size limits, if the client gives none."""

MAX_ANGLE = 89.9
"""Largest transmission angle that is aimed at, degrees: at 90° the cosine would demand perfection."""

ANGLE_STEP, MAX_TIGHTENED_ANGLE, SIZE_FACTOR = 5.7, 80.0, 0.85
"""Tighter aims: increase of the transmission angle and its maximum, degrees; factor of reach and link ratio."""

GRASHOF_LIMITS = {
    "any": (-1, 0.0),
    "double_crank": (0, 1.0),
    "crank_rocker": (1, 1.0),
    "double_rocker": (2, 1.0),
    "non_grashof": (-1, -1.0),
}
"""Shortest link of the fourbar by its class, in the order ground, input, coupler, output, −1 for any; and whether the
Grashof condition must be satisfied (1), violated (−1) or neither (0)."""


class Aims(NamedTuple):
    """Transmission angle, degrees, and maximum sizes that a fit aims at.

    ``reach`` is in task sizes. ``share`` is the fraction of each length limit that the search uses.
    """

    angle: float
    reach: float
    ratio: float
    share: float

    def tighten(self) -> Aims:
        """Return aims at a larger angle and smaller sizes."""
        angle = max(self.angle, min(self.angle + ANGLE_STEP, MAX_TIGHTENED_ANGLE))
        return self._replace(angle=angle, reach=SIZE_FACTOR * self.reach, ratio=SIZE_FACTOR * self.ratio)


class Limits(NamedTuple):
    """Limits of a problem, as aims with a margin.

    The margins of the search leave room for the motion between its steps; those of :attr:`bare_aims` only for rounding.
    """

    problem: MotionProblem
    task: MotionTask

    @property
    def aims(self) -> Aims:
        """The limits with the margins of the search."""
        return self._move_aims(angle=2.0, share=0.96)

    @property
    def bare_aims(self) -> Aims:
        """The limits themselves, apart from rounding."""
        return self._move_aims(angle=0.02, share=0.9999)

    @property
    def relaxed_aims(self) -> Aims:
        """The client's own limits, and wide defaults for the others."""
        constraints, aims = self.problem.constraints, self.aims
        if constraints.min_transmission_angle is None:
            aims = aims._replace(angle=RELAXED_ANGLE)
        if constraints.max_link_ratio is None:
            aims = aims._replace(ratio=RELAXED_SIZE_FACTOR * aims.ratio)
        return aims._replace(reach=RELAXED_SIZE_FACTOR * aims.reach)

    def _move_aims(self, angle: float, share: float) -> Aims:
        constraints = self.problem.constraints
        min_angle = constraints.min_transmission_angle
        ratio = MAX_RATIO if constraints.max_link_ratio is None else constraints.max_link_ratio
        min_angle = SOUND_TRANSMISSION_ANGLE if min_angle is None else min_angle
        return Aims(min(min_angle + angle, MAX_ANGLE), share * MAX_REACH, share * ratio, share)

    def build_packer(self, aims: Aims) -> Callable[[Topology], Real]:
        """Return a function that packs the limits with some aims for a topology."""

        @cache
        def pack_limits(topology: Topology) -> Real:
            return self._pack_topology(topology, aims)

        return pack_limits

    def _pack_topology(self, topology: Topology, aims: Aims) -> Real:
        problem, task = self.problem, self.task
        constraints, lengths = problem.constraints, problem.constraints.link_length
        out = pack_topology(topology)
        if topology.families:
            out[fields.FAMILY], out[fields.GRASHOF] = GRASHOF_LIMITS[constraints.grashof]
        out[fields.COSINE], out[fields.RATIO] = math.cos(math.radians(aims.angle)), aims.ratio
        shortest = 0.0 if lengths is None else lengths.min / task.size / aims.share
        longest = math.inf if lengths is None or lengths.max is None else aims.share * lengths.max / task.size
        shortest = max(shortest, MIN_LINK_LENGTH / aims.share)
        # The reach is a default, which gives way to a required length.
        reach = max(aims.reach, shortest)
        out[fields.LINKS], out[fields.REACH] = (shortest, min(longest, reach)), reach
        fixed = self._scale_region(constraints.fixed_pivot_region)
        out[fields.INPUT_BOX] = out[fields.PIVOT_BOX] = fixed
        out[fields.MOVING_BOX] = self._scale_region(constraints.moving_pivot_region)
        box = None if problem.space is None else problem.space.shrink_box_for_joints()
        if box is not None:
            out[fields.WORKSPACE_BOX] = self._scale_box(*box)
        return out

    def _scale_region(self, region: Region | None) -> Real:
        if region is None:
            return np.array([-math.inf, math.inf, -math.inf, math.inf])
        return self._scale_box(*region.x, *region.y)

    def _scale_box(self, left: float, right: float, low: float, high: float) -> Real:
        """Convert a box to task coordinates: minimum and maximum x, minimum and maximum y."""
        first, last = self.task.to_task(complex(left, low)), self.task.to_task(complex(right, high))
        return np.array([first.real, last.real, first.imag, last.imag])
