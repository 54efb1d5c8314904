"""The rows of every kind."""

from __future__ import annotations

from typing import Any

from tests.service.stated import balancing, cams, gears, linkages, shafts, springs

TABLES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "motion": (linkages.MOTION, linkages.MOTION_ROWS),
    "path": (linkages.PATH, linkages.PATH_ROWS),
    "quick_return": (linkages.QUICK_RETURN, linkages.QUICK_RETURN_ROWS),
    "straight_line": (linkages.LINE, linkages.LINE_ROWS),
    "steering": (linkages.STEERING, linkages.STEERING_ROWS),
    "dwell": (linkages.DWELL, linkages.DWELL_ROWS),
    "parallel_motion": (linkages.PARALLEL, linkages.PARALLEL_ROWS),
    "gear_train": (gears.TRAIN, gears.TRAIN_ROWS),
    "planetary_train": (gears.PLANETARY, gears.PLANETARY_ROWS),
    "train_series": (gears.SERIES_OF_TRAINS, gears.SERIES_ROWS),
    "gearbox": (gears.GEARBOX, gears.GEARBOX_ROWS),
    "layshaft_gearbox": (gears.LAYSHAFT, gears.LAYSHAFT_ROWS),
    "cam": (cams.CAM, cams.CAM_ROWS),
    "function": (linkages.FUNCTION, linkages.FUNCTION_ROWS),
    "balancing": (balancing.ROTOR, balancing.ROTOR_ROWS),
    "spring_balancing": (springs.SPRINGS, springs.SPRINGS_ROWS),
    "flywheel": (shafts.FLYWHEEL, shafts.FLYWHEEL_ROWS),
    "engine": (shafts.ENGINE, shafts.ENGINE_ROWS),
    "indexing": (shafts.INDEXING, shafts.INDEXING_ROWS),
}

EXHAUSTIVE = "an exhaustive search returns nothing that fails"

NO_EFFECT = {
    ("cam", "max_designs"): "a program has one smallest cam",
    ("gear_train", "include_failed"): EXHAUSTIVE,
    ("planetary_train", "include_failed"): EXHAUSTIVE,
    ("train_series", "include_failed"): EXHAUSTIVE,
    ("gearbox", "include_failed"): EXHAUSTIVE,
    ("layshaft_gearbox", "include_failed"): EXHAUSTIVE,
    ("spring_balancing", "include_failed"): "the springs of a program keep the limits that are stated in it",
    ("flywheel", "include_failed"): "the lightest wheel within the limits keeps them",
    ("quick_return", "layout.over"): "the crank turns through: that is its used range",
    ("dwell", "layout.over"): "the crank turns through: that is its used range",
    ("parallel_motion", "linkage.reference_body_angle"): "taken because answers have it, and said not to be looked at",
}
"""Fields with which no answer changes, and why."""

ELSEWHERE = frozenset(
    {"PathProblem", "SkeletonSpec", "Space", "DesignDynamics", "DynamicsBlock", "Manufacture", "LoadedLinkage"}
)
"""Models whose fields have rows or tests of their own: paths, skeletons beside dimensions, rooms, masses, shops."""
