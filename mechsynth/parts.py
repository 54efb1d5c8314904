"""What statements are made of: positions, points, limits, masses, loads, under the names of the API's schemas.

Only the stock of a rotor has another one here, ``RotorStock``, because ``Stock`` is that of the bars of linkages. The
units of a series of trains are mappings.
"""

from synthesis.kinds.balancing.stated_rotor import (
    BearingReading,
    Correction,
    Holes,
    Influence,
    Reading,
    RotorMass,
    TrialRun,
)
from synthesis.kinds.balancing.stated_rotor import (
    Stock as RotorStock,
)
from synthesis.kinds.balancing.stated_weights import (
    Counterweights,
    ForceCaps,
    ForceWeights,
)
from synthesis.kinds.cam.followers import (
    BarrelRoller,
    FollowerDynamics,
    LengthRange,
    OscillatingFlat,
    OscillatingRoller,
    RateRange,
    TranslatingFlat,
    TranslatingRoller,
)
from synthesis.kinds.cam.limits import CamLimits
from synthesis.kinds.cam.segments import (
    ConstantVelocity,
    DisplacementBand,
    Dwell,
    Move,
    Polynomial,
    ProgramCondition,
)
from synthesis.kinds.dwell.problem import (
    RockerOutput,
    SliderOutput,
    StatedDwell,
)
from synthesis.kinds.engine.problem import (
    CylinderPressure,
    EngineLayout,
    EngineMasses,
    IdleFlywheel,
    StatedCrank,
    StatedRod,
)
from synthesis.kinds.flywheel.problem import (
    FastestRim,
    Flattest,
    FlywheelLimits,
    Least,
    Machine,
    Most,
    StatedTorque,
    Thickness,
)
from synthesis.kinds.function.functions import (
    FunctionStatement,
    TablePoint,
)
from synthesis.kinds.function.problem import (
    FunctionConstraints,
    GroundPivots,
    Pair,
    Scales,
    Zeros,
)
from synthesis.kinds.gear_train.stated_stages import StageTeethRange, StatedStage
from synthesis.kinds.gear_train.stated_train import StockedGear, TeethRange
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
from synthesis.kinds.motion.stated_dyads import (
    CouplerVector,
    DriverDyad,
    DyadChoices,
    GroundLine,
)
from synthesis.kinds.motion.stated_mechanisms import Chain
from synthesis.kinds.motion.stated_positions import (
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
from synthesis.kinds.path.stated_stance import Stance
from synthesis.kinds.path.stated_start import StartFourbar
from synthesis.kinds.planetary_train.problem import PlanetaryTeeth
from synthesis.kinds.quick_return.problem import RockerPosition
from synthesis.kinds.spring_balancing.problem import Holding
from synthesis.kinds.spring_balancing.stated_springs import (
    SoughtEnd,
    SoughtSpring,
)
from synthesis.kinds.steering.problem import ArmLimits
from synthesis.model.bodies import (
    LinkShape,
    Part,
    PointMass,
    PolarPlace,
    Shape,
    StatedBody,
)
from synthesis.model.dynamics import (
    DesignDynamics,
    DrivenSlide,
    DynamicsBlock,
    Gravity,
    PinFriction,
    StatedFlywheel,
    StatedFriction,
    WeighedLinkage,
)
from synthesis.model.gear_statement import (
    DistanceRange,
    ShiftRange,
    ToothRange,
)
from synthesis.model.gear_strength import (
    CarriedPower,
    StatedFactors,
)
from synthesis.model.layout import StatedLayout
from synthesis.model.linkage_statement import (
    Constraints,
    LengthLimits,
    Region,
)
from synthesis.model.loads import (
    AgainstMotion,
    ForceCourse,
    GasPressure,
    StatedLoad,
    TorqueCourse,
)
from synthesis.model.manufacture import (
    Manufacture,
    Quality,
    Rounding,
    Stock,
    Tolerances,
)
from synthesis.model.motions import Sweep
from synthesis.model.planet_strength import PlanetPower
from synthesis.model.space import (
    Body,
    FixedPivotZones,
    MovingPivotZones,
    Space,
)
from synthesis.model.springs import (
    SpringEnd,
    StatedSpring,
)
from synthesis.model.stated_linkage import (
    FourbarLengths,
    StatedCouplerPoint,
    StatedGear,
    StatedLink,
    StatedPivots,
    StatedSkeleton,
    StatedSlide,
)
from synthesis.model.zones import (
    Circle,
    MovingZone,
    Zone,
)

__all__ = [
    "AgainstMotion",
    "ArmLimits",
    "BarrelRoller",
    "BearingReading",
    "Body",
    "CamLimits",
    "CarriedPower",
    "Chain",
    "Circle",
    "Clearances",
    "ConstantVelocity",
    "Constraints",
    "Correction",
    "Counterweights",
    "CouplerPointLimits",
    "CouplerVector",
    "CylinderPressure",
    "DesignDynamics",
    "DisplacementBand",
    "DistanceRange",
    "DrivenSlide",
    "DriverDyad",
    "Dwell",
    "DwellShare",
    "DyadChoices",
    "DynamicsBlock",
    "EngineLayout",
    "EngineMasses",
    "FastestRim",
    "FixedPivotZones",
    "Flattest",
    "FlywheelLimits",
    "FollowerDynamics",
    "ForceCaps",
    "ForceCourse",
    "ForceWeights",
    "FourbarLengths",
    "FunctionConstraints",
    "FunctionStatement",
    "GasPressure",
    "Gravity",
    "GroundLine",
    "GroundPivots",
    "Holding",
    "Holes",
    "IdleFlywheel",
    "IndexingConstraints",
    "Influence",
    "Least",
    "LengthLimits",
    "LengthRange",
    "LinkShape",
    "Machine",
    "Manufacture",
    "Most",
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
    "PolarPlace",
    "Polynomial",
    "Position",
    "ProgramCondition",
    "Quality",
    "Ratcheting",
    "RateRange",
    "Reading",
    "Region",
    "RockerOutput",
    "RockerPosition",
    "RotorMass",
    "RotorStock",
    "Rounding",
    "Scales",
    "Shape",
    "ShiftRange",
    "SliderOutput",
    "SoughtEnd",
    "SoughtSpring",
    "SourceLinkage",
    "Space",
    "SpindleSpeeds",
    "SpringEnd",
    "StageRatio",
    "StageTeethRange",
    "Stance",
    "StartFourbar",
    "StatedBody",
    "StatedCouplerPoint",
    "StatedCrank",
    "StatedDwell",
    "StatedFactors",
    "StatedFlywheel",
    "StatedFriction",
    "StatedGear",
    "StatedLayout",
    "StatedLink",
    "StatedLoad",
    "StatedPivots",
    "StatedRod",
    "StatedSkeleton",
    "StatedSlide",
    "StatedSpring",
    "StatedStage",
    "StatedTorque",
    "Stock",
    "StockedGear",
    "Sweep",
    "TablePoint",
    "TeethRange",
    "Thickness",
    "Tolerance",
    "Tolerances",
    "ToothRange",
    "TorqueCourse",
    "TranslatingFlat",
    "TranslatingRoller",
    "TrialRun",
    "WeighedLinkage",
    "Zeros",
    "Zone",
]
