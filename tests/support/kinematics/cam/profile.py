"""Code that several tests share: profile."""

from __future__ import annotations

from kinematics.cam.motion_laws import LAWS
from kinematics.cam.program import TURN, Program
from kinematics.cam.segments import dwell, law_segment


def double_dwell(lift: float = 1.0, law: str = "cycloidal") -> Program:
    quarter = TURN / 4.0
    return Program(
        [
            law_segment(LAWS[law], quarter, 0.0, lift),
            dwell(quarter, lift),
            law_segment(LAWS[law], quarter, lift, 0.0),
            dwell(quarter, 0.0),
        ]
    )
