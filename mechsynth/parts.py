"""Components of problems: positions, points, limits, masses, loads, with the names of the API's schemas.

The units of a train series have no class here; they are given as mappings.
"""

from synthesis.kinds.balancing.statement.counterweights import (
    Counterweights,
    ForceCaps,
    ForceWeights,
)
from synthesis.kinds.balancing.statement.rotor import (
    BearingReading,
    Correction,
    Holes,
    Influence,
    Reading,
    RotorMass,
    RotorStock,
    TrialRun,
)
from synthesis.kinds.cam.statement.followers import (
    BarrelRoller,
    FollowerDynamics,
    LengthRange,
    OscillatingFlat,
    OscillatingRoller,
    RateRange,
    TranslatingFlat,
    TranslatingRoller,
)
from synthesis.kinds.cam.statement.limits import CamLimits
from synthesis.kinds.cam.statement.segments import (
    ConstantVelocity,
    DisplacementBand,
    Dwell,
    Move,
    Polynomial,
    ProgramCondition,
)
from synthesis.kinds.dwell.problem import (
    DwellRequest,
    RockerOutput,
    SliderOutput,
)
from synthesis.kinds.engine.problem import (
    ConnectingRod,
    CrankThrow,
    CylinderPressure,
    EngineLayout,
    EngineMasses,
    IdleFlywheel,
)
from synthesis.kinds.flywheel.problem import (
    FlywheelLimits,
    Machine,
    MaxLength,
    MaxRimSpeed,
    MaxSlenderness,
    MinLength,
    Thickness,
    TorqueTable,
)
from synthesis.kinds.function.problem import (
    FunctionConstraints,
    GroundPivots,
    Pair,
    Scales,
    Zeros,
)
from synthesis.kinds.function.statement.functions import (
    FunctionStatement,
    TablePoint,
)
from synthesis.kinds.gear_train.statement.stages import RequestedStage, StageTeethRange
from synthesis.kinds.gear_train.statement.train import StockedGear, TeethRange
from synthesis.kinds.gearbox.problem import (
    SpindleSpeeds,
    StageRatio,
)
from synthesis.kinds.indexing.problem import (
    Clearances,
    DwellShare,
    IndexingConstraints,
    Ratcheting,
)
from synthesis.kinds.motion.statement.dyad_choices import (
    CouplerVector,
    DriverDyad,
    DyadChoices,
    GroundLine,
)
from synthesis.kinds.motion.statement.mechanism_types import Chain
from synthesis.kinds.motion.statement.positions import (
    Position,
    Tolerance,
)
from synthesis.kinds.parallel_motion.problem import SourceLinkage
from synthesis.kinds.path.problem import (
    CouplerPointLimits,
    PathConstraints,
    PathPivots,
    PathPoint,
)
from synthesis.kinds.path.statement.stance import Stance
from synthesis.kinds.path.statement.start import StartFourbar
from synthesis.kinds.planetary_train.problem import PlanetaryTeeth
from synthesis.kinds.quick_return.problem import RockerPosition
from synthesis.kinds.spring_balancing.problem import Holding
from synthesis.kinds.spring_balancing.requested_springs import (
    SoughtEnd,
    SoughtSpring,
)
from synthesis.kinds.steering.problem import ArmLimits
from synthesis.model.dynamics.bodies import (
    BodySpec,
    LinkShape,
    Part,
    PointMass,
    PolarPoint,
    Shape,
)
from synthesis.model.dynamics.loads import (
    AgainstMotion,
    ForceCurve,
    GasPressure,
    LoadSpec,
    TorqueCurve,
)
from synthesis.model.dynamics.request import (
    DesignDynamics,
    DrivenSlide,
    DynamicsBlock,
    FlywheelSpec,
    FrictionSpec,
    Gravity,
    LoadedLinkage,
    PinFriction,
)
from synthesis.model.dynamics.springs import (
    SpringEnd,
    SpringSpec,
)
from synthesis.model.gears.planet_strength import PlanetPower
from synthesis.model.gears.request import (
    DistanceRange,
    ShiftRange,
    ToothRange,
)
from synthesis.model.gears.strength import (
    CarriedPower,
    StrengthFactors,
)
from synthesis.model.layout import LayoutSpec
from synthesis.model.linkage.given_linkage import (
    CouplerPointSpec,
    FixedPivotsSpec,
    FourbarLengths,
    GearSpec,
    LinkSpec,
    SkeletonSpec,
    SlideSpec,
)
from synthesis.model.linkage.input_motion import Sweep
from synthesis.model.linkage.problem import (
    Constraints,
    LengthLimits,
    Region,
)
from synthesis.model.linkage.workspace import (
    Body,
    FixedPivotZones,
    MovingPivotZones,
    Space,
)
from synthesis.model.linkage.zones import (
    Circle,
    MovingZone,
    Zone,
)
from synthesis.model.manufacture.request import (
    Manufacture,
    Quality,
    Rounding,
    Stock,
    Tolerances,
)

__all__ = [
    "AgainstMotion",
    "ArmLimits",
    "BarrelRoller",
    "BearingReading",
    "Body",
    "BodySpec",
    "CamLimits",
    "CarriedPower",
    "Chain",
    "Circle",
    "Clearances",
    "ConnectingRod",
    "ConstantVelocity",
    "Constraints",
    "Correction",
    "Counterweights",
    "CouplerPointLimits",
    "CouplerPointSpec",
    "CouplerVector",
    "CrankThrow",
    "CylinderPressure",
    "DesignDynamics",
    "DisplacementBand",
    "DistanceRange",
    "DrivenSlide",
    "DriverDyad",
    "Dwell",
    "DwellRequest",
    "DwellShare",
    "DyadChoices",
    "DynamicsBlock",
    "EngineLayout",
    "EngineMasses",
    "FixedPivotZones",
    "FixedPivotsSpec",
    "FlywheelLimits",
    "FlywheelSpec",
    "FollowerDynamics",
    "ForceCaps",
    "ForceCurve",
    "ForceWeights",
    "FourbarLengths",
    "FrictionSpec",
    "FunctionConstraints",
    "FunctionStatement",
    "GasPressure",
    "GearSpec",
    "Gravity",
    "GroundLine",
    "GroundPivots",
    "Holding",
    "Holes",
    "IdleFlywheel",
    "IndexingConstraints",
    "Influence",
    "LayoutSpec",
    "LengthLimits",
    "LengthRange",
    "LinkShape",
    "LinkSpec",
    "LoadSpec",
    "LoadedLinkage",
    "Machine",
    "Manufacture",
    "MaxLength",
    "MaxRimSpeed",
    "MaxSlenderness",
    "MinLength",
    "Move",
    "MovingPivotZones",
    "MovingZone",
    "OscillatingFlat",
    "OscillatingRoller",
    "Pair",
    "Part",
    "PathConstraints",
    "PathPivots",
    "PathPoint",
    "PinFriction",
    "PlanetPower",
    "PlanetaryTeeth",
    "PointMass",
    "PolarPoint",
    "Polynomial",
    "Position",
    "ProgramCondition",
    "Quality",
    "Ratcheting",
    "RateRange",
    "Reading",
    "Region",
    "RequestedStage",
    "RockerOutput",
    "RockerPosition",
    "RotorMass",
    "RotorStock",
    "Rounding",
    "Scales",
    "Shape",
    "ShiftRange",
    "SkeletonSpec",
    "SlideSpec",
    "SliderOutput",
    "SoughtEnd",
    "SoughtSpring",
    "SourceLinkage",
    "Space",
    "SpindleSpeeds",
    "SpringEnd",
    "SpringSpec",
    "StageRatio",
    "StageTeethRange",
    "Stance",
    "StartFourbar",
    "Stock",
    "StockedGear",
    "StrengthFactors",
    "Sweep",
    "TablePoint",
    "TeethRange",
    "Thickness",
    "Tolerance",
    "Tolerances",
    "ToothRange",
    "TorqueCurve",
    "TorqueTable",
    "TranslatingFlat",
    "TranslatingRoller",
    "TrialRun",
    "Zeros",
    "Zone",
]
