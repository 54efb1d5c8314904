"""Code that several tests share: profile."""

from __future__ import annotations

from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_dwell, build_law_segment


def double_dwell(lift: float = 1.0, law: str = "cycloidal") -> Program:
    quarter = TURN / 4.0
    return Program(
        [
            build_law_segment(LAWS[law], quarter, 0.0, lift),
            build_dwell(quarter, lift),
            build_law_segment(LAWS[law], quarter, lift, 0.0),
            build_dwell(quarter, 0.0),
        ]
    )
