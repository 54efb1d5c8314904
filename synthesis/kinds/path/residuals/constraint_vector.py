"""Pack a client's limits on a fourbar that guides a point as constraints of a fit (:mod:`synthesis.fit.constraints`).

Limits are in task coordinates, and tightened by a margin, so that a fit that ends on a limit meets it after rounding.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from synthesis.fit.constraints import (
    CHANGE_POINT,
    COSINE,
    FAMILY_INDEX,
    FULL_TURN_INDEX,
    GIVEN_PIVOTS,
    INPUT_BOX,
    LIMIT_COUNT,
    LINKS,
    MOVING,
    OUTPUT_BOX,
    POINT_BOX,
    RATIO,
    SETTING_SIZE,
    SIGN_INDEX,
)
from synthesis.fit.fourbar_forces import pack_forces
from synthesis.fit.workspace import pack_workspace, select_zones
from synthesis.fit.workspace_margins import count_margins
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage.problem import Region
from synthesis.numerics.array_layout import ArrayLayout

PATH_SETTING = ArrayLayout(SETTING_SIZE, timing=1, phase_reference=1, order=1)
"""Setting of a fit to points, behind the constraints."""

TIMING_INDEX = PATH_SETTING.index("timing")
"""Whether timing is prescribed."""

PHASE_REFERENCE_INDEX = PATH_SETTING.index("phase_reference")
"""Line from which crank angles are measured."""

ORDER_INDEX = PATH_SETTING.index("order")
"""Whether points are met in order."""

PATH_SETTING_SIZE = PATH_SETTING.size
"""Number of values of a setting; the packed workspace (:mod:`synthesis.fit.workspace`), if any, follows them."""

PHASE_FREE, PHASE_ABSOLUTE, PHASE_GROUND_LINE = range(3)
"""The line from which prescribed crank angles are measured."""

MAX_LINK = 50.0
"""Maximum link length, in task sizes, if the client gives no limit; without a limit fits tend to sliders."""

MIN_LINK = 1e-4
"""Shortest link, in task sizes; a shorter one could not be drawn, let alone be built."""

MIN_GRASHOF = 1e-6
"""Minimum of s₁, s₂ and s₃ as a share of the sum of all links; below it a linkage counts as at a change point."""

LIMIT_WEIGHT = 1e3
"""Weight of limits, in task units, in the first descent of
:func:`synthesis.numerics.augmented_lagrangian.descend_constrained`."""

LIMIT_MARGIN = 1e-10
"""Relative margin by which limits are tightened."""


REGION_MARGIN = 1e-7
"""Margin by which regions are shrunk, a share of the task's size, so that a pivot on their edge is inside after
rounding."""


class UsableLimits(NamedTuple):
    """Limits of a usable linkage if the client gives none: minimum transmission angle (degrees), maximum link ratio,
    and longest link (task sizes)."""

    transmission: float
    ratio: float
    longest: float


def pack_setting(
    problem: PathProblem, origin: complex, size: float, *, sign: float, family: int, usable: UsableLimits | None = None
) -> Real:
    """Pack a problem's limits for one class of fourbars and one assembly, with ``origin`` at 0 and ``size`` at 1."""
    # All lengths are divided by the task's size; angles and ratios stay.
    limits = problem.constraints
    out = np.full(PATH_SETTING_SIZE, math.inf)
    out[FAMILY_INDEX], out[SIGN_INDEX], out[FULL_TURN_INDEX] = family, sign, problem.closed
    out[TIMING_INDEX], out[CHANGE_POINT] = problem.prescribed, MIN_GRASHOF
    out[PHASE_REFERENCE_INDEX] = ("free", "absolute", "ground_line").index(problem.crank_phase)
    out[ORDER_INDEX] = limits.in_order
    least, most = MIN_LINK, MAX_LINK
    if limits.link_length is not None:
        least = max(limits.link_length.min / size, MIN_LINK)
        most = MAX_LINK if limits.link_length.max is None else limits.link_length.max / size
    if usable is not None:
        # Twice the client's shortest link keeps the range of lengths from becoming empty.
        most = min(most, max(usable.longest, 2.0 * least))
        out[RATIO] = usable.ratio
        out[COSINE] = math.cos(math.radians(usable.transmission))
    out[LINKS] = least * (1.0 + LIMIT_MARGIN), most * (1.0 - LIMIT_MARGIN)
    if limits.max_link_ratio is not None:
        out[RATIO] = min(out[RATIO], limits.max_link_ratio * (1.0 - LIMIT_MARGIN))
    out[INPUT_BOX] = _intersect_regions([limits.fixed_pivot_region, limits.input_pivot_region], origin, size)
    out[OUTPUT_BOX] = _intersect_regions([limits.fixed_pivot_region], origin, size)
    out[POINT_BOX] = -math.inf, math.inf, -math.inf, math.inf
    if limits.coupler_point is not None:
        for k, interval in enumerate((limits.coupler_point.along, limits.coupler_point.across)):
            if interval is not None:
                out[POINT_BOX][2 * k : 2 * k + 2] = interval[0] / size, interval[1] / size
    if limits.min_transmission_angle is not None:
        out[COSINE] = min(out[COSINE], math.cos(math.radians(limits.min_transmission_angle)) * (1.0 - LIMIT_MARGIN))
    out[MOVING] = _intersect_regions([limits.moving_pivot_region], origin, size)
    # NaN marks a coordinate that is not given.
    out[GIVEN_PIVOTS] = math.nan
    for k, pivot in enumerate((problem.fixed_pivots.input, problem.fixed_pivots.output)):
        x, y = pivot or (None, None)
        if x is not None:
            out[GIVEN_PIVOTS][2 * k] = (x - origin.real) / size
        if y is not None:
            out[GIVEN_PIVOTS][2 * k + 1] = (y - origin.imag) / size
    return np.concatenate([out, pack_path_workspace(problem, origin, size)])


def pack_path_workspace(problem: PathProblem, origin: complex, size: float) -> Real:
    """Pack the constraints along the motion, with ``origin`` at 0 and ``size`` at 1: the workspace, and limits on
    forces."""
    limits = problem.constraints.force_limits
    forces = pack_forces(problem.dynamics, limits, problem.length_unit, origin, size)
    return pack_workspace(problem.space, origin, size, forces=forces)


def restrict_to_zones(setting: Real) -> Real:
    """Return a setting whose workspace consists only of the zones of the pivots.

    Zones can be checked without driving the linkage, which large numbers of descents require.
    """
    return np.concatenate([setting[:PATH_SETTING_SIZE], select_zones(setting[PATH_SETTING_SIZE:])])


def count_setting_margins(setting: Real) -> int:
    """Return the number of margins of a setting: those of its workspace first, then those of the constraints."""
    return int(count_margins(setting[PATH_SETTING_SIZE:])) + LIMIT_COUNT


def _intersect_regions(regions: list[Region | None], origin: complex, size: float) -> tuple[float, float, float, float]:
    """Return the box common to all given regions, shrunk by a margin: minimum and maximum x, minimum and maximum y.

    A narrow box keeps half of its width.
    """
    x, y = (-math.inf, math.inf), (-math.inf, math.inf)
    for region in regions:
        if region is not None:
            x = max(x[0], (region.x[0] - origin.real) / size), min(x[1], (region.x[1] - origin.real) / size)
            y = max(y[0], (region.y[0] - origin.imag) / size), min(y[1], (region.y[1] - origin.imag) / size)
    return *_shrink_interval(*x), *_shrink_interval(*y)


def _shrink_interval(low: float, high: float) -> tuple[float, float]:
    """Shrink an interval by the margin of regions, or by a quarter of its width on each side if that is less."""
    margin = min(REGION_MARGIN, 0.25 * (high - low))
    return low + margin, high - margin
