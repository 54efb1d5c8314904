"""The offset slider-crank of given stroke and time ratio with the best transmission angle, in closed form.

The crank turns by φ = π + δ, δ = π (T − 1)/(T + 1), from the position in which crank and coupler extend each other to
that in which they overlap. Seen from O2, the directions to B in these two positions differ by δ. With b = 1, x = a/b,
n = sin²(δ/2) and W = n + (1 − n) x² the triangle O2 B1 B2 gives the stroke and the offset

    H = 2 √W,        e = (1 − x²) √(n (1 − n))/√W,

and cos μ = x + e for the minimum transmission angle μ, which occurs when the crank is square to the slide. Its
derivative by x is a cubic in W with the factor (1 − n) W − n, which belongs to x = tan²(δ/2), and

    W² − n W − n = 0,        W = (n + √(n² + 4n))/2.

At x = tan²(δ/2) and at x = 1 cos μ is 1; below the first both limit positions do not lie on one side of the foot of O2
on the slide. Hence a design exists just where tan(δ/2) < 1, which is T < 3. With T = 1 (n = 0) the best has no crank:
μ grows to π/2 with the coupler's length.
"""

from __future__ import annotations

import cmath
import math

from scipy.optimize import brentq

from kinematics.message import compose
from synthesis.kinds.quick_return.alternatives import (
    LIMIT_TOLERANCE,
    MAX_LINK_RATIO,
    RANGE_END_TOLERANCE,
    list_shorter_members,
)
from synthesis.kinds.quick_return.design import RatioRange
from synthesis.kinds.quick_return.problem import QuickReturnProblem, compute_stroke_imbalance
from synthesis.model.linkage.answer import SliderCrankMechanism
from synthesis.model.linkage.conversion import build_slider_crank, remove_coupler_point


def compute_ratio_range(problem: QuickReturnProblem) -> RatioRange:
    """Return the time ratios of offset slider-cranks."""
    return RatioRange(
        type="offset_slider_crank",
        least=1.0,
        least_included=True,
        greatest=3.0,
        reaches=compute_stroke_imbalance(problem.time_ratio) < 0.5 * math.pi - RANGE_END_TOLERANCE,
        reason=compose("quick_return-coupler-square-to-slide"),
    )


def build_offset_slider_cranks(problem: QuickReturnProblem) -> list[SliderCrankMechanism]:
    """Return the best slider-crank within the limit of the link ratio, and some with shorter couplers."""
    assert problem.stroke is not None
    n = math.sin(0.5 * compute_stroke_imbalance(problem.time_ratio)) ** 2
    best = compute_best_ratio(n)
    # For nearly equal strokes the best coupler is very long; a shorter one transmits almost as well.
    x = max(best, 1.0 / MAX_LINK_RATIO)
    demanded = math.cos(math.radians(problem.constraints.min_transmission_angle or 0.0))
    # The shortened coupler fails the requirement that the best one satisfies: lengthen it just enough.
    if compute_cosine(best, n) < demanded < compute_cosine(x, n):
        x = float(brentq(lambda ratio: compute_cosine(ratio, n) - demanded, best, x, xtol=1e-300, rtol=1e-15))
    limit = problem.constraints.max_link_ratio
    if limit is not None:
        x = max(x, (1.0 + LIMIT_TOLERANCE) / limit)
    # The crank would be as long as the coupler: a change point.
    if x >= 1.0:
        return []
    shorter = list_shorter_members(1.0 / x, float, lambda ratio: math.acos(min(compute_cosine(1.0 / ratio, n), 1.0)))
    return [_build_mechanism(problem, member, n) for member in (x, *(1.0 / ratio for ratio in shorter))]


def compute_best_ratio(n: float) -> float:
    """Return the ratio of crank to coupler with the best transmission angle; 0 for equal strokes."""
    w = 0.5 * (n + math.sqrt(n * (n + 4.0)))
    return math.sqrt((w - n) / (1.0 - n))


def compute_cosine(x: float, n: float) -> float:
    """Return the cosine of the minimum transmission angle."""
    w = n + (1.0 - n) * x * x
    return x + ((1.0 - x) * (1.0 + x) * math.sqrt(n * (1.0 - n) / w) if w > 0.0 else 0.0)


def _build_mechanism(problem: QuickReturnProblem, x: float, n: float) -> SliderCrankMechanism:
    """Build the member with x = a/b in the position of extension, where its slow stroke begins."""
    assert problem.stroke is not None
    w = n + (1.0 - n) * x * x
    b = 0.5 * problem.stroke / math.sqrt(w)
    a = x * b
    e = b * (1.0 - x) * (1.0 + x) * math.sqrt(n * (1.0 - n) / w)
    along = cmath.exp(1j * math.radians(problem.direction))
    o2 = problem.o2
    far = complex(math.sqrt((a + b - e) * (a + b + e)), e) * along
    pin_a = o2 + a * far / abs(far)
    return remove_coupler_point(build_slider_crank(o2, pin_a, o2 + far, math.radians(problem.direction), pin_a))
