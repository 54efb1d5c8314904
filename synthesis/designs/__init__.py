"""Answers: what the service returns, as pydantic models.

Angles are degrees, lengths are in the problem's unit. A design is a mechanism with the proof of what it does; a result
is the designs and how they were found. One module a kind of problem, and one for what linkages share.
"""

from synthesis.designs.base import Answer, Check, Point, Result, Search, Verification
from synthesis.designs.cam import CamDesign, CamResult
from synthesis.designs.gear_train import (
    GearTrainDesign,
    GearTrainMechanism,
    GearTrainMetrics,
    GearTrainResult,
    GearTrainSearch,
    Idler,
    MeshGeometry,
    ParetoTrain,
    Ratio,
    Stage,
)
from synthesis.designs.linkage import (
    CouplerPoint,
    FixedPivots,
    FourbarLinks,
    FourbarMechanism,
    GearPair,
    Link,
    LinkageDesign,
    LinkageMetrics,
    Skeleton,
    Slide,
    Target,
)
from synthesis.designs.motion import BurmesterBranch, MotionResult
from synthesis.designs.planetary_train import (
    MeshContact,
    ParetoPlanetaryTrain,
    PlanetaryDesign,
    PlanetaryMechanism,
    PlanetaryMetrics,
    PlanetaryResult,
    PlanetPlaces,
)

__all__ = [
    "Answer",
    "BurmesterBranch",
    "CamDesign",
    "CamResult",
    "Check",
    "CouplerPoint",
    "FixedPivots",
    "FourbarLinks",
    "FourbarMechanism",
    "GearPair",
    "GearTrainDesign",
    "GearTrainMechanism",
    "GearTrainMetrics",
    "GearTrainResult",
    "GearTrainSearch",
    "Idler",
    "Link",
    "LinkageDesign",
    "LinkageMetrics",
    "MeshContact",
    "MeshGeometry",
    "MotionResult",
    "ParetoPlanetaryTrain",
    "ParetoTrain",
    "PlanetPlaces",
    "PlanetaryDesign",
    "PlanetaryMechanism",
    "PlanetaryMetrics",
    "PlanetaryResult",
    "Point",
    "Ratio",
    "Result",
    "Search",
    "Skeleton",
    "Slide",
    "Stage",
    "Target",
    "Verification",
]
