"""The slider-crank in closed form: motion, limits, and its behaviour over a range of crank angles."""

from kinematics.linkage.slider_crank.closed_form import (
    CrankLimits,
    SliderCrank,
    SliderDerivatives,
    SliderMotion,
    SliderPositions,
    coupler_points,
    find_crank_limits,
    find_toggle_angles,
    has_full_rotation,
    motion,
    positions,
)

__all__ = [
    "CrankLimits",
    "SliderCrank",
    "SliderDerivatives",
    "SliderMotion",
    "SliderPositions",
    "coupler_points",
    "find_crank_limits",
    "find_toggle_angles",
    "has_full_rotation",
    "motion",
    "positions",
]
