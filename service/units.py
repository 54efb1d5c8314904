"""Unit symbols of dimensions in the units of a problem."""

from __future__ import annotations

from synthesis.model.dimension import Dimension
from synthesis.model.problem import ProblemBase

_SI = {
    Dimension.POWER: "W",
    Dimension.DENSITY: "kg/m³",
    Dimension.INERTIA: "kg·m²",
    Dimension.TORSION_STIFFNESS: "N·m/rad",
    Dimension.GRAVITY: "m/s²",
    Dimension.UNBALANCE: "g·mm",
    Dimension.SPEED: "m/s",
    Dimension.ENERGY: "J",
}
"""Units of masses, loads and flywheels, which are SI in any case."""


def list_symbols(problem: ProblemBase) -> dict[Dimension, str]:
    """Return the symbol of each dimension in the units of a problem; inches go with pounds-force and their mass."""
    length = problem.length_unit
    inches = length == "in"
    displacement, rate = ("°", "rad") if problem.is_oscillating else (length, length)
    output, way = (length, length) if problem.slides else ("°", "rad")
    force = "lbf" if inches else "N"
    symbols = {
        Dimension.FORCE: force,
        Dimension.STIFFNESS: f"{force}/{length}",
        Dimension.MASS: "lbf·s²/in" if inches else "kg",
        Dimension.TORQUE: f"{force}·{length}",
        **_SI,
    }
    if problem.force_units == "si":
        symbols |= {Dimension.FORCE: "N", Dimension.STIFFNESS: "N/m", Dimension.MASS: "kg", Dimension.TORQUE: "N·m"}
    elif problem.force_units == "consistent":
        symbols = dict.fromkeys(symbols, "")  # the client alone knows the units of this set
    return {
        Dimension.LENGTH: length,
        Dimension.AREA: f"{length}²",
        Dimension.INVERSE_LENGTH: f"1/{length}",
        Dimension.ANGLE: "°",
        Dimension.DISPLACEMENT: displacement,
        Dimension.VELOCITY: f"{rate}/rad",
        Dimension.ACCELERATION: f"{rate}/rad²",
        Dimension.JERK: f"{rate}/rad³",
        Dimension.ACCELERATION_SQUARED: f"{rate}²/rad³",
        Dimension.OUTPUT: output,
        Dimension.OUTPUT_PER_RADIAN: f"{way}/rad",
        Dimension.OUTPUT_PER_RADIAN_SQUARED: f"{way}/rad²",
        Dimension.LENGTH_PER_RADIAN: f"{length}/rad",
        Dimension.ANGLE_PER_LENGTH: f"°/{length}",
        Dimension.ROTATIONAL_SPEED: "1/min",
        Dimension.RADIAN_FREQUENCY: "rad/s",
        Dimension.PERCENT: "%",
        Dimension.GRADE: "mm/s",
        **symbols,
    }
