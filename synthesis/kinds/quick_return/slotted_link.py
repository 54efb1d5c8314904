"""Crank-shaper and Whitworth: the crank pin slides in a link about O4, whose end C drives a ram.

Both invert the slider-crank, with the crank shorter or longer than the ground. With δ = π (T − 1)/(T + 1):

* crank-shaper: the link swings by ψ between the tangents from O4 to the crank's circle, sin(ψ/2) = a/d, and the crank
  turns by π + ψ in the slow stroke: ψ = δ. Its arm O4–C of r = H/(2 sin(ψ/2)) has its ends at one height, so that a ram
  across the middle of the swing has the stroke H exactly; at the height in the middle of the arc's rise the coupler
  leans least, by sin⁻¹ of r (1 − cos(ψ/2))/2b. Near its ends the arc is steep, and a coupler square to it would turn
  the ram back before the link is there: with the line z above the ends it leans there by λ, sin λ = z/b, and the ram
  goes on where cos(ψ/2 + λ) > 0, z < b cos(ψ/2). From ratios of about 14 on the line is therefore lower.
* Whitworth: the link turns through. The ram's line passes through O4 square to the ground line; the ram's limits stand
  where C is on that line, H = 2r, and the crank turns by π + 2 sin⁻¹(d/a) in the slow stroke: d/a = sin(δ/2). The
  coupler leans most by sin⁻¹(r/b).

A ratio of 1 would require a crank-shaper's crank, or the distance of a Whitworth's pivots, to be zero. Every larger
ratio is reached.
"""

from __future__ import annotations

import cmath
import math

from kinematics.linkage.planar.catalogue import make_quick_return
from kinematics.message import compose
from synthesis.kinds.quick_return.alternatives import LIMIT_TOLERANCE
from synthesis.kinds.quick_return.design import QuickReturnLinks, QuickReturnMechanism, RatioRange
from synthesis.kinds.quick_return.problem import QuickReturnProblem, compute_stroke_imbalance
from synthesis.model.linkage.answer import FixedPivots, Line
from synthesis.model.linkage.conversion import build_skeleton, build_slide, to_point

MAX_PIN_REACH = 0.9
"""Maximum distance of the crank pin from O4 along the slotted link, as a share of the arm O4–C, so that the block stays
clear of C."""

SHAPER_COUPLER_RATIO = 1.0
"""Length of a crank-shaper's coupler, in strokes, unless a transmission angle requires a longer one."""

LINE_HEIGHT_SHARE = 0.9
"""Height of the ram's line over the ends of the arc, as a share of that at which the ram would turn back too early."""

WHITWORTH_COUPLER_RATIO = 4.0
"""Length of a Whitworth's coupler, in arms, unless a transmission angle requires a longer one; it gives 75.5°."""


def compute_crank_shaper_range(problem: QuickReturnProblem) -> RatioRange:
    """Return the time ratios of crank-shapers."""
    return _make_range_above_one(problem, "crank_shaper", compose("quick_return-equal-strokes-without-crank"))


def compute_whitworth_range(problem: QuickReturnProblem) -> RatioRange:
    """Return the time ratios of Whitworth mechanisms."""
    return _make_range_above_one(problem, "whitworth", compose("quick_return-equal-strokes-at-one-pivot"))


def build_crank_shapers(problem: QuickReturnProblem) -> list[QuickReturnMechanism]:
    """Return the crank-shaper, at the beginning of its slow stroke."""
    assert problem.stroke is not None
    half = 0.5 * compute_stroke_imbalance(problem.time_ratio)
    sine = math.sin(half)
    rocker = 0.5 * problem.stroke / sine
    # The pin is farthest from O4 at ground + crank, and must stay below the arm.
    ground = MAX_PIN_REACH * rocker / (1.0 + sine)
    rise = rocker * 2.0 * math.sin(0.5 * half) ** 2
    shortest = SHAPER_COUPLER_RATIO * problem.stroke
    above = min(0.5 * rise, LINE_HEIGHT_SHARE * shortest * math.cos(half))
    coupler = max(shortest, (rise - above) * _compute_coupler_ratio(problem))
    # With a longer coupler the line may be higher, and the coupler leans less than permitted.
    height = rocker * math.cos(half) + min(0.5 * rise, LINE_HEIGHT_SHARE * coupler * math.cos(half))
    return [_build_mechanism(problem, "crank_shaper", ground, ground * sine, rocker, coupler, height, -half)]


def build_whitworths(problem: QuickReturnProblem) -> list[QuickReturnMechanism]:
    """Return the Whitworth mechanism, at the beginning of its slow stroke."""
    assert problem.stroke is not None
    half = 0.5 * compute_stroke_imbalance(problem.time_ratio)
    # The arm's end moves the ram by twice its length.
    rocker = 0.5 * problem.stroke
    crank = MAX_PIN_REACH * rocker / (1.0 + math.sin(half))
    coupler = rocker * max(WHITWORTH_COUPLER_RATIO, _compute_coupler_ratio(problem))
    return [_build_mechanism(problem, "whitworth", crank * math.sin(half), crank, rocker, coupler, 0.0, -half)]


def _make_range_above_one(problem: QuickReturnProblem, name: str, reason: str) -> RatioRange:
    return RatioRange(
        type=name, least=1.0, least_included=False, greatest=None, reaches=problem.time_ratio > 1.0, reason=reason
    )


def _compute_coupler_ratio(problem: QuickReturnProblem) -> float:
    """Return the ratio of the coupler to the height that it spans, for the required transmission angle."""
    demanded = math.radians(problem.constraints.min_transmission_angle or 0.0)
    return (1.0 + LIMIT_TOLERANCE) / math.cos(demanded)


def _build_mechanism(
    problem: QuickReturnProblem,
    kind: str,
    ground: float,
    crank: float,
    rocker: float,
    coupler: float,
    height: float,
    crank_angle: float,
) -> QuickReturnMechanism:
    """Build the mechanism whose ram moves at ``height`` above O4, with O2 above O4.

    "Above" is perpendicular to the slide's direction. ``crank_angle``, radians, is measured from that perpendicular.
    """
    turn = math.radians(problem.direction)
    o2 = problem.o2
    up = 1j * cmath.exp(1j * turn)
    o4 = o2 - ground * up
    line = o4 + height * up
    mechanism = make_quick_return(o2, o4, crank, rocker, coupler, line, turn, crank_angle + turn)
    return QuickReturnMechanism.model_validate(
        {
            "type": kind,
            "fixed_pivots": FixedPivots(input=to_point(o2), output=to_point(o4)),
            "links": QuickReturnLinks(ground=ground, crank=crank, rocker=rocker, coupler=coupler),
            "slide": Line(point=to_point(line), angle=problem.direction),
            "assembly": "open",
            "reference_input_angle": math.degrees(crank_angle) + problem.direction,
            "skeleton": build_skeleton(
                {name: complex(z) for name, z in mechanism.joints.items()},
                mechanism.links,
                slides=[build_slide(at.joint, at.link, complex(at.point), float(at.angle)) for at in mechanism.slides],
            ),
        }
    )
