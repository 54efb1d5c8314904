"""Laws, segments and programs of the literature's rows as the analysis core takes them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.pieces import build_polynomial_pieces
from kinematics.cam.motion.program import Program
from kinematics.cam.motion.segments import Segment, build_dwell, build_law_segment

NAMES = {
    "const_velocity": "constant_velocity",
    "parabolic": "constant_acceleration",
    "shm": "simple_harmonic",
    "cycloid": "cycloidal",
    "trapezoid": "trapezoidal",
    "mod_trap": "modified_trapezoid",
    "mod_sine": "modified_sine",
    "poly23": "polynomial_23",
    "poly345": "polynomial_345",
    "poly4567": "polynomial_4567",
    "eighth_power": "eighth_power",
    "eighth_power_fall": "eighth_power_reversed",
    "double_harmonic": "double_harmonic",
    "double_harmonic_fall": "double_harmonic_reversed",
    "half_harmonic_1": "half_harmonic_start",
    "half_harmonic_2": "half_harmonic_end",
    "half_cycloid_1": "half_cycloidal_start",
    "half_cycloid_2": "half_cycloidal_end",
}
"""The rows' names of laws, and ours."""


def coefficient_segment(angle: float, coefficients: list[float]) -> Segment:
    """Σ c_k (θ/β)^k with Norton's coefficients, constant first."""
    return Segment("polynomial", build_polynomial_pieces([0.0, 1.0], np.atleast_2d(coefficients)).scale_to(angle, 1.0))


def segment_of(row: dict[str, Any]) -> Segment:
    angle = math.radians(row["beta_deg"])
    if "coef" in row:
        return coefficient_segment(angle, row["coef"])
    if row["law"] == "dwell":
        return build_dwell(angle, row["start"])
    end = row["start"] + row["scale"] if "scale" in row else row["end"]
    return build_law_segment(LAWS[NAMES[row["law"]]], angle, row["start"], end)


def program_of(rows: list[dict[str, Any]]) -> Program:
    return Program([segment_of(row) for row in rows])
