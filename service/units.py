"""The unit of every number that is stated and answered: its dimension by the field, and the symbol by the problem.

The models hold plain numbers. What a field measures is one line here, by its name where it means the same everywhere,
and by ``Model.field`` or ``Model.*`` where it does not. Two dimensions depend on the problem: a *displacement* is that
of a cam's follower, a length or degrees of its arm; an *output* is the angle of a link or the place of a slider.
"""

from __future__ import annotations

from typing import Any, Literal

from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.dwell.problem import DwellProblem
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.quick_return.problem import QuickReturnProblem
from synthesis.model.statement import StatedProblem

Dimension = Literal[
    "length",
    "area",
    "inverse length",
    "angle",
    "displacement",
    "velocity",
    "acceleration",
    "jerk",
    "acceleration squared",
    "output",
    "output per radian",
    "output per radian squared",
    "length per radian",
    "rotational speed",
    "radian frequency",
    "force",
    "stiffness",
    "mass",
    "torque",
    "percent",
]

_BY_NAME: dict[str, Dimension] = {
    "x": "length",
    "y": "length",
    "angle": "angle",
    "rotation": "angle",
    "rotations": "angle",
    "swing": "angle",
    "stroke": "length",
    "fixed_pivot": "length",
    "fixed_pivots": "length",
    "moving_pivot": "length",
    "crank_pivot": "length",
    "rotopole": "length",
    "pivot": "length",
    "point": "length",
    "joints": "length",
    "links": "length",
    "start": "length",
    "distance": "length",
    "deviation": "length",
    "point_residual": "length",
    "length": "length",
    "crank": "length",
    "rocker_length": "length",
    "arm": "length",
    "arm_length": "length",
    "pivot_distance": "length",
    "face_offset": "length",
    "face_width": "length",
    "groove_width": "length",
    "offset": "length",
    "hub_radius": "length",
    "prime_radius": "length",
    "base_radius": "length",
    "roller_radius": "length",
    "cylinder_radius": "length",
    "turning_radius": "length",
    "min_radius": "length",
    "min_convex_radius": "length",
    "min_concave_radius": "length",
    "size": "length",
    "max_size": "length",
    "least_room": "length",
    "min_clearance": "length",
    "module": "length",
    "centre_distance": "length",
    "centre_distances": "length",
    "diametral_pitch": "inverse length",
    "track": "length",
    "wheelbase": "length",
    "bar_travel": "length",
    "translation": "length",
    "shift": "length",
    "max_distance": "length",
    "rms_distance": "length",
    "curve_distance": "length",
    "excursion": "length",
    "max_deviation": "length",
    "sum_of_squares": "area",
    "mean_velocity": "length per radian",
    "middle_velocity": "length per radian",
    "phase": "angle",
    "lock": "angle",
    "outer_lock": "angle",
    "dwell_angle": "angle",
    "direction": "angle",
    "input_angle": "angle",
    "body_angle": "angle",
    "crank_angle": "angle",
    "ground_angle": "angle",
    "link_angle": "angle",
    "slide_angle": "angle",
    "arm_angle": "angle",
    "angle_residual": "angle",
    "crank_range": "angle",
    "input_range": "angle",
    "range_limits": "angle",
    "input_rotation": "angle",
    "slow_rotation": "angle",
    "fast_rotation": "angle",
    "reference_input_angle": "angle",
    "reference_body_angle": "angle",
    "min_transmission_angle": "angle",
    "cycle_transmission_angle": "angle",
    "transmission_angle": "angle",
    "transmission_angles": "angle",
    "pressure_angle": "angle",
    "pressure_angle_fall": "angle",
    "max_pressure_angle_rise": "angle",
    "max_pressure_angle_fall": "angle",
    "wall_changes": "angle",
    "correct_at": "angle",
    "steering_error": "angle",
    "max_steering_error": "angle",
    "lift": "displacement",
    "displacement": "displacement",
    "output_range": "output",
    "max_structural_error": "output",
    "rms_structural_error": "output",
    "jitter": "output",
    "way": "output",
    "peak_velocity": "velocity",
    "peak_acceleration": "acceleration",
    "rms_acceleration": "acceleration",
    "peak_jerk": "jerk",
    "peak_inertia_torque": "acceleration squared",
    "speed_rpm": "rotational speed",
    "input_speed": "rotational speed",
    "natural_frequency": "radian frequency",
    "mass": "mass",
    "spring_rate": "stiffness",
    "preload": "force",
    "least_preload": "force",
    "least_force": "force",
    "min_contact_force": "force",
    "max_contact_force": "force",
    "min_torque": "torque",
    "max_torque": "torque",
    "max_velocity_variation": "percent",
    "velocity_variation": "percent",
    "straightness_error": "percent",
}

_BY_MODEL: dict[str, Dimension | None] = {
    "ArmLimits.*": "length",
    "LengthLimits.*": "length",
    "LengthRange.*": "length",
    "CouplerPointLimits.*": "length",
    "FourbarLinks.*": "length",
    "SliderCrankLinks.*": "length",
    "InvertedLinks.*": "length",
    "FivebarLinks.*": "length",
    "QuickReturnLinks.*": "length",
    "SourceLinks.*": "length",
    "FixedPivots.*": "length",
    "GroundPivots.*": "length",
    "PathPivots.*": "length",
    "SourcePivots.*": "length",
    "Position.tolerance": "length",
    "Link.joints": None,
    "TablePoint.*": None,
    "FunctionStatement.x": None,
    "CurvePlacement.size": None,
    "CamLimits.velocity": "velocity",
    "CamLimits.acceleration": "acceleration",
    "CamLimits.jerk": "jerk",
    "DisplacementBand.start": "angle",
    "DisplacementBand.end": "angle",
    "DisplacementBand.lower": "displacement",
    "DisplacementBand.upper": "displacement",
    "CamSegment.start": "angle",
    "ProgramCondition.s": "displacement",
    "ProgramCondition.v": "velocity",
    "ProgramCondition.a": "acceleration",
    "ProgramCondition.j": "jerk",
    "ProgramTable.s": "displacement",
    "ProgramTable.v": "velocity",
    "ProgramTable.a": "acceleration",
    "ProgramTable.j": "jerk",
    "Pair.input": "angle",
    "Pair.output": "output",
    "Zeros.input": "angle",
    "Zeros.output": "output",
    "DwellProblem.tolerance": "output",
    "DwellMetrics.peak_velocity": "output per radian",
    "DwellMetrics.peak_acceleration": "output per radian squared",
    "Rest.level": "output",
    "Rest.width": "angle",
    "FunctionTarget.output_place": "output",
    "FunctionTarget.error": "output",
    "ErrorExtreme.error": "output",
    "ErrorCurve.error": "output",
    "StructuralError.max": "output",
    "StructuralError.rms": "output",
    "LimitPosition.output": "output",
    "SteeringPosition.*": "angle",
    "SteeringPosition.index": None,
    "SteeringPosition.input_angle": None,
    "SpindleSpeeds.min": "rotational speed",
    "SpindleSpeeds.max": "rotational speed",
    "SpindleSpeed.speed": "rotational speed",
    "SpindleSpeed.nominal": "rotational speed",
    "SpindleSpeed.standard": "rotational speed",
    "ShaftSpeeds.speeds": "rotational speed",
    "GearTrainProblem.size": None,
    "GearTrainProblem.direction": None,
    "ParetoTrain.size": None,
    "Check.pressure_angle": "angle",
    "Check.shortest_link": "length",
    "Check.longest_link": "length",
    "Check.clearance": "length",
    "Check.peak_velocity": "velocity",
    "Check.peak_acceleration": "acceleration",
    "Check.table_jerk": "jerk",
}


def dimension(model: str, field: str) -> Dimension | None:
    """What a number measures; None for a pure number, a count or a number of teeth.

    >>> dimension("FourbarLinks", "coupler"), dimension("PathMetrics", "quality")
    ('length', None)
    """
    for key in (f"{model}.{field}", f"{model}.*"):
        if key in _BY_MODEL:
            return _BY_MODEL[key]
    return _BY_NAME.get(field)


def symbols(problem: StatedProblem) -> dict[Dimension, str]:
    """The symbol of each dimension in the units of a problem; forces and masses of inches are those of pounds-force."""
    length = problem.length_unit
    inches = length == "in"
    arm = isinstance(problem, CamProblem) and problem.follower.type.startswith("oscillating")
    lift, rate = ("°", "rad") if arm else (length, length)
    slides = (
        (isinstance(problem, FunctionProblem) and problem.mechanism == "slider_crank")
        or (isinstance(problem, DwellProblem) and problem.output.type == "slider")
        or (isinstance(problem, QuickReturnProblem) and problem.stroke is not None)
    )
    output, way = (length, length) if slides else ("°", "rad")
    force = "lbf" if inches else "N"
    return {
        "length": length,
        "area": f"{length}²",
        "inverse length": f"1/{length}",
        "angle": "°",
        "displacement": lift,
        "velocity": f"{rate}/rad",
        "acceleration": f"{rate}/rad²",
        "jerk": f"{rate}/rad³",
        "acceleration squared": f"{rate}²/rad³",
        "output": output,
        "output per radian": f"{way}/rad",
        "output per radian squared": f"{way}/rad²",
        "length per radian": f"{length}/rad",
        "rotational speed": "1/min",
        "radian frequency": "rad/s",
        "force": force,
        "stiffness": f"{force}/{length}",
        "mass": "lbf·s²/in" if inches else "kg",
        "torque": f"{force}·{length}",
        "percent": "%",
    }


def annotated(schema: dict[str, Any], model: str) -> dict[str, Any]:
    """A copy of a model's JSON schema in which the properties that have a dimension say it, as ``x-dimension``."""
    copy = dict(schema)
    if "$defs" in schema:
        copy["$defs"] = {name: annotated(one, name) for name, one in schema["$defs"].items()}
    if "properties" in schema:
        copy["properties"] = {
            name: one if (found := dimension(model, name)) is None else {**one, "x-dimension": found}
            for name, one in schema["properties"].items()
        }
    return copy
