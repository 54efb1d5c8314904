"""The slider-crank in closed form: motion, limits, and its behaviour over a range of crank angles."""

from kinematics.linkage.slider_crank.closed_form import (
    CrankLimits,
    SliderCrank,
    SliderDerivatives,
    SliderMotion,
    SliderPositions,
    coupler_points,
    crank_limits,
    full_rotation,
    motion,
    positions,
    toggle_angles,
)

__all__ = [
    "CrankLimits",
    "SliderCrank",
    "SliderDerivatives",
    "SliderMotion",
    "SliderPositions",
    "coupler_points",
    "crank_limits",
    "full_rotation",
    "motion",
    "positions",
    "toggle_angles",
]
