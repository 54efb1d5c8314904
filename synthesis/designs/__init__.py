"""Answers: what the service returns, as pydantic models.

Angles are degrees, lengths are in the problem's unit. A design is a mechanism with the proof of what it does; a result
is the designs and how they were found. One module a kind of problem, and one for what linkages share.
"""

from synthesis.designs.base import Answer, Check, Point, Result, Search, Verification
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
from synthesis.designs.motion import MotionResult

__all__ = [
    "Answer",
    "Check",
    "CouplerPoint",
    "FixedPivots",
    "FourbarLinks",
    "FourbarMechanism",
    "GearPair",
    "Link",
    "LinkageDesign",
    "LinkageMetrics",
    "MotionResult",
    "Point",
    "Result",
    "Search",
    "Skeleton",
    "Slide",
    "Target",
    "Verification",
]
