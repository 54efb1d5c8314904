"""What each number measures: as the fields' own descriptions say it, and in the units of the problem."""

import pytest

from service.units import list_symbols
from synthesis.registry import KINDS, get_first_example, list_examples, parse_problem

# Numbers without a unit: ratios, shares, residuals by the task's size, relative errors, values of a function. A number
# that is in none of these models, or has another name, says what it measures.
CARRIED = {"body_travel_ratio", "body_turn_ratio"}
CARRIED_POWER = {"power_kw", "quality", "allowable_bending", "allowable_contact", "max_face_width"}

PURE = {
    "AgainstMotion": {"forward", "backward"},  # forces, or torques on a link
    "Allocation": {"cost"},
    "BalanceMetrics": {"value", "bound", "gap"},  # shares of what was before
    "Balancer": {"backward", "forward"},  # in units of m_B r
    "BarrelMetrics": {"curvature_ratio"},
    "CamForces": {"frequency_ratio"},
    "CamLimits": {"curvature_ratio"},
    "CamMetrics": {"curvature_ratio"},
    "Check": {"value", "limit"},  # of the check's own dimension
    "CognateTriples": {"largest_residual"},
    "Constraints": {"max_link_ratio", "max_joint_force_index"},
    "CurvePlacement": {"size"},  # times the stated curve
    "CylinderPressure": {"table"},  # columns of two units
    "DesignForces": {"joint_force_index"},
    "DwellMetrics": {"link_ratio", "relative_link_width", "reach", "quality"},
    "PlacedDwell": {"at"},
    "DwellRequest": {"at"},
    "EngineCylinder": {"place"},  # in spacings of the throws
    "EngineFlywheel": {"coefficient"},
    "EngineHarmonic": {"coefficient", "cos", "place_cos", "place_sin", "sin", "torque"},
    "EngineLayout": {"positions"},  # in spacings of the throws
    "EngineMetrics": {
        "binomial_terms",
        "primary_force",
        "primary_moment",
        "secondary_force",
        "secondary_moment",
        "torque",
    },
    "EngineProblem": {"rod_ratio"},
    "ErrorCurve": {"input"},
    "ErrorExtreme": {"input"},
    "ExactDesign": {"rms_residual"},
    "FollowerDynamics": {"damping", "damping_ratio", "min_frequency_ratio", "train_damping_ratio"},
    "ForceCaps": {"shaking_force", "shaking_moment", "drive", "joint_forces"},  # over what they were
    "MaxSlenderness": {"max"},  # radius over thickness
    "Fluctuation": {"first_order_coefficient"},
    "FlywheelMetrics": {"coefficient"},
    "FlywheelProblem": {"coefficient"},
    "ForceCurve": {"table"},  # columns of several units
    "ForceLevel": {"weight", "cap", "ratio"},
    "ForceWeights": {"shaking_force", "shaking_moment", "drive", "joint_forces"},
    "FunctionConstraints": {"max_link_ratio", "max_joint_force_index"},
    "FunctionMetrics": {"link_ratio", "relative_link_width", "reach", "rms_residual", "quality", *CARRIED},
    "FunctionProblem": {"scale_limits"},  # of input and output alike
    "FunctionStatement": {"x", "exponent", "base"},
    "FunctionTarget": {"input", "output", "residual"},
    "Gap": {"value", "limit"},  # of the check's own dimension
    "GasPressure": {"pressure"},  # columns of several units
    "GearPair": {"ratio"},
    "GearedInertia": {"ratio"},
    "FlywheelSpec": {"coefficient"},
    "IdleFlywheel": {"coefficient"},
    "Overbalance": {"share"},
    "Stance": {"speed_tolerance"},
    "GearSpec": {"ratio"},
    "GearTrainUnit": {"max_stage_ratio", "min_contact_ratio", "min_tip_thickness"},
    "CarriedPower": CARRIED_POWER,  # kW, MPa
    "PlanetPower": {*CARRIED_POWER, "load_sharing"},
    "StrengthFactors": {
        "form",
        "overload",
        "dynamic",
        "size",
        "load_distribution",
        "rim",
        "bending_geometry",
        "contact_geometry",
        "elastic",
    },
    "PairStrength": {  # N, m/s
        "tangential_force",
        "pitch_line_velocity",
        "dynamic",
        "load_distribution",
        "load_sharing",
        "contact_geometry",
        "sharing_ratio",
    },
    "StressedGear": {  # MPa
        "form",
        "size_factor",
        "bending_geometry",
        "bending_stress",
        "contact_stress",
        "bending_safety",
        "contact_safety",
    },
    "GearTrainMetrics": {"error", "relative_error", "largest_stage_ratio"},
    "GearTrainProblem": {"ratio", "max_stage_ratio", "tolerance", "min_contact_ratio", "min_tip_thickness"},
    "GearTrainSearch": {"least_error"},
    "GearboxMetrics": {"max_error", "torque"},  # times that of the input
    "GearboxProblem": {"tolerance"},
    "GearboxResult": {"progression_ratio"},
    "GearedFivebarMechanism": {"gear_ratio"},
    "GivenPivotSolutions": {"largest_residual"},
    "DwellShare": {"min", "max"},
    "IndexingDesign": {"dwell_share"},
    "IndexingConstraints": {"steady_share"},
    "IndexingMetrics": {"entry_speed", "steady_share"},  # speeds over the crank's
    "InputDial": {"at"},
    "LayshaftMetrics": {"max_error", "errors", "contact_ratios"},
    "LayshaftProblem": {"ratios", "reverse", "tolerance"},
    "LinkageMetrics": {"link_ratio", "relative_link_width", "reach", "rms_residual", "quality", *CARRIED},
    "MeshContact": {"contact_ratio"},
    "MeshGeometry": {"contact_ratio", "efficiency", "overlap_ratio", "total_contact_ratio"},
    "Optimality": {"value", "bound", "gap"},  # of its criterion
    "GearNumbers": {"driver", "driven"},
    "OutputDial": {"at"},
    "ParallelMotionMetrics": {"link_ratio", "relative_link_width", "reach", "rms_residual", "quality", *CARRIED},
    "ParetoLayshaft": {"max_error"},
    "ParetoPlanetaryTrain": {"error"},
    "ParetoSeries": {"error"},
    "ParetoTrain": {"relative_error"},
    "PathConstraints": {"max_link_ratio", "max_joint_force_index"},
    "PathMetrics": {
        "link_ratio",
        "relative_link_width",
        "reach",
        "rms_residual",
        "quality",
        "stance_speed_deviation",
        *CARRIED,
    },
    "PathProblem": {"gear_ratio"},
    "PinFriction": {"mu"},
    "PlanetaryMechanism": {"addendum"},  # in modules
    "PlanetaryUnit": {"mesh_efficiency", "min_contact_ratio"},
    "PlanetaryMetrics": {"error", "speeds", "efficiency", "rolling_power", "branch_power"},  # over the input's
    "PlanetaryProblem": {"ratio", "tolerance", "min_contact_ratio", "mesh_efficiency", "min_efficiency"},
    "Pulse": {"area"},  # an energy
    "Quality": {"yield"},
    "QuickReturnMetrics": {"time_ratio", "link_ratio", "relative_link_width", "reach", "quality"},
    "QuickReturnProblem": {"time_ratio"},
    "Ratcheting": {"friction"},
    "Ratio": {"value"},
    "RatioRange": {"least", "greatest"},
    "Reachable": {"max_link_ratio", "tolerance"},
    "Reading": {"amplitude"},  # in any unit
    "Rest": {"off_end"},
    "Sensitivity": {"x", "y", "travel", "share"},  # length by length
    "RotorMetrics": {"residual_vibration"},  # in the unit of the readings
    "RoundingCost": {"rms_residual"},
    "ShiftRange": {"min", "max"},  # in modules
    "SpindleSpeed": {"error"},
    "SpindleSpeeds": {"ratio"},
    "SecondMetrics": {"curvature_ratio"},
    "SpringChoice": {"gap"},
    "SpringMetrics": {"value", "bound", "gap", "energy_variation"},  # shares of what was before
    "Stage": {"diameter_quotient", "friction"},
    "StageRatio": {"min", "max"},
    "SpringSpec": {"damping"},  # by the sort of spring
    "RequestedStage": {"diameter_quotient", "friction"},
    "TorqueTable": {"table"},  # columns of two units
    "SteeringMetrics": {"link_ratio", "relative_link_width"},
    "StraightLineMetrics": {"link_ratio", "relative_link_width", "reach", "quality"},
    "StructureVerdict": {"max_error"},
    "TrainSeriesMetrics": {"error", "speeds", "efficiency"},  # over the input's
    "TrainSeriesProblem": {"ratio", "tolerance"},
    "TrainSeriesSearch": {"least_error"},
    "SuggestedShift": {"driver", "driven", "contact_ratio"},  # shifts in modules
    "TablePoint": {"x", "y"},
    "Holding": {"from", "to", "speed", "acceleration"},  # of an input that turns or slides
    "Sweep": {"from", "to", "speed", "acceleration"},  # of an input that turns or slides
    "Target": {"residual"},
    "TorqueCurve": {"table"},  # columns of several units
    "TrainVibration": {"frequency_ratio", "period_ratio"},
    "TurningShaft": {"axis"},  # a direction
    "VectorHarmonic": {"backward", "forward", "major", "minor"},
    "Yield": {"value", "low", "high"},
}


def numeric(schema):
    if schema.get("type") == "number":
        return True
    inner = [one for key in ("anyOf", "oneOf", "prefixItems") for one in schema.get(key, [])]
    inner += [schema[key] for key in ("items", "additionalProperties") if isinstance(schema.get(key), dict)]
    return any(numeric(one) for one in inner)


def numbers(kind):
    """Every number of a kind's problem and result: model, field and schema."""
    for model, mode in ((KINDS[kind].problem, "validation"), (KINDS[kind].result, "serialization")):
        root = model.model_json_schema(mode=mode)
        for name, part in [(model.__name__, root), *root.get("$defs", {}).items()]:
            for field, schema in part.get("properties", {}).items():
                if numeric(schema):
                    yield name, field, schema


@pytest.mark.parametrize("kind", KINDS)
def test_a_field_that_says_its_unit_has_the_dimension(kind):
    seen = 0
    for model, field, schema in numbers(kind):
        if field in PURE.get(model, ()):
            continue
        says, found = schema.get("description", "").lower(), schema.get("x-dimension")
        if "degrees, or length units" in says or "degrees, or place along" in says:
            assert found == "output", (model, field)
        elif "degrees" in says:
            assert found in ("angle", "output"), (model, field)
        elif "length units squared" in says:
            assert found == "area", (model, field)
        elif "revolutions a minute" in says or "revolutions per minute" in says:
            assert found == "rotational speed", (model, field)
        elif "length unit" in says:
            assert str(found).startswith(("length", "inverse length", "stiffness", "output")), (model, field)
        seen += 1
    assert seen > 3


@pytest.mark.slow
def test_every_number_has_a_dimension_or_is_known_to_be_pure():
    found = {}
    for kind in KINDS:
        for model, field, schema in numbers(kind):
            if "x-dimension" not in schema:
                found.setdefault(model, set()).add(field)
    assert found == PURE


@pytest.mark.parametrize("kind", KINDS)
def test_lengths_and_angles_by_their_names(kind):
    for model, field, schema in numbers(kind):
        if field.endswith("_angle"):
            assert schema.get("x-dimension") == "angle", (model, field)
        if field.endswith(("_radius", "_distance", "_length")):
            assert schema.get("x-dimension") == "length", (model, field)
        if field.endswith("_ratio"):
            assert schema.get("x-dimension") is None, (model, field)


@pytest.mark.parametrize("kind", KINDS)
def test_every_dimension_has_a_symbol(kind):
    units = list_symbols(parse_problem(get_first_example(kind)))
    for _, _, schema in numbers(kind):
        found = schema.get("x-dimension")
        assert found is None or units[found]


def test_the_units_are_those_of_the_problem():
    inches = list_symbols(parse_problem({**get_first_example("cam"), "length_unit": "in"}))
    assert (inches["length"], inches["area"], inches["force"]) == ("in", "in²", "lbf")
    linkage = list_symbols(parse_problem({**get_first_example("motion"), "length_unit": "in"}))
    assert (linkage["length"], linkage["force"], linkage["torque"]) == ("in", "N", "N·m"), "SI unless stated otherwise"
    flat = next(one for one in list_examples("cam") if one["follower"]["type"] == "translating_flat")
    assert list_symbols(parse_problem(flat))["displacement"] == "mm"
    arm = {"type": "oscillating_roller", "roller_radius": 5.0, "arm": 40.0, "pivot_distance": 60.0}
    turned = list_symbols(parse_problem({**get_first_example("cam"), "follower": arm}))
    assert (turned["displacement"], turned["velocity"]) == ("°", "rad/rad")
    assert list_symbols(parse_problem(list_examples("function")[2]))["output"] == "mm"
    assert list_symbols(parse_problem(list_examples("function")[1]))["output"] == "°"


def test_a_schema_says_what_its_numbers_measure():
    schema = KINDS["motion"].problem.model_json_schema()
    position = schema["$defs"]["Position"]["properties"]
    assert (position["x"]["x-dimension"], position["angle"]["x-dimension"]) == ("length", "angle")
    assert "x-dimension" not in schema["properties"]["max_designs"]
