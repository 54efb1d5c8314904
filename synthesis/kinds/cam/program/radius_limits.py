"""Limits on the radii of a cam: of its roller, and of the curvature of its face or pitch curve."""

from __future__ import annotations

from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.statement.followers import LengthRange, OscillatingFlat, TranslatingFlat
from synthesis.kinds.cam.statement.limits import CamLimits

MIN_CURVATURE_RATIO = 1.02
"""Minimum ratio of the pitch curve's radius of curvature to the roller's radius for any request: at 1 the cam has a
cusp."""

MIN_FACE_RADIUS_SHARE = 0.02
"""Radius of curvature, as a share of the travel, below which the cam under a flat face counts as an edge."""


def get_roller_radius_range(problem: CamProblem) -> tuple[float, float] | None:
    """Return the minimum and maximum roller radius; None for a flat face."""
    if isinstance(problem.follower, TranslatingFlat | OscillatingFlat):
        return None
    radius = problem.follower.roller_radius
    return (radius.min, radius.max) if isinstance(radius, LengthRange) else (radius, radius)


def compute_min_face_radius(problem: CamProblem) -> float:
    """Return the minimum radius of curvature of a cam under a flat face: the limit, or the smallest that is no edge."""
    # On an arm the travel is an angle; the pivot distance turns it into a length.
    reach = problem.follower.pivot_distance if isinstance(problem.follower, OscillatingFlat) else 1.0
    return max(problem.limits.min_radius, MIN_FACE_RADIUS_SHARE * problem.program.travel * reach)


def compute_min_pitch_radius(limits: CamLimits, roller_radius: float) -> float:
    """Return the minimum radius of curvature of the pitch curve: the limit, or the smallest that avoids a cusp."""
    return max(limits.curvature_ratio, MIN_CURVATURE_RATIO) * roller_radius
