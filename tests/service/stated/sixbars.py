"""Rows of sixbars: for functions, for motion, and those that dwell at stated places.

With every value the mechanisms that pass are others than without it, or there are none; of what is in ``TOLD`` it is
what the designs tell that is another.
"""

from __future__ import annotations

from typing import Any

from tests.service.stated.linkages import FAR, SIXBARS, WEIGHED, WIDE
from tests.service.stated.row import Row

ANYWHERE = [[-1e6, -1e6], [1e6, 1e6]]
BESIDE = {"polygon": [[4e3, 4e3], [5e3, 4e3], [5e3, 5e3], [4e3, 5e3]]}
OVER_ALL = {"polygon": [[-2e3, -2e3], [2e3, -2e3], [2e3, 2e3], [-2e3, 2e3]]}
LAYOUT = {"link_width": 4.0, "pin_diameter": 2.0, "thickness": 2.0}

TOLD = {"include_failed", "layout", "dynamics"}

FAILS = Row(True, {"dynamics": WEIGHED, "constraints.max_joint_force": 1e-12})
LENGTHS = {"constraints.link_length": {"min": 1e-3, "max": 1e6}}
OF_ALL: dict[str, Any] = {"seed": 7, "max_designs": 2}

FUNCTION: dict[str, Any] = {
    "kind": "function",
    "function": {"name": "sine", "x": [0.0, 90.0]},
    "input_range": 90.0,
    "output_range": 90.0,
    "mechanisms": ["watt_2"],
    "max_designs": 1,
}
MOTION: dict[str, Any] = {
    "kind": "motion",
    "positions": SIXBARS["positions"],
    "mechanisms": ["watt_1"],
    "max_designs": 1,
}
DWELL: dict[str, Any] = {
    "kind": "dwell",
    "dwells": [{"angle": 60.0, "at": "high"}],
    "output": {"type": "slider", "stroke": 40.0},
    "mechanism": "watt_2",
    "max_designs": 1,
}
PAIRS = [{"input": 15.0 * k, "output": 12.0 * k + k * k} for k in range(6)]
OF_PAIRS = {"function": None, "input_range": None, "output_range": None, "pairs": PAIRS}

TABLES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "function": (
        FUNCTION,
        {
            **OF_ALL,
            "include_failed": FAILS,
            "constraints.min_transmission_angle": 40.0,
            "constraints.fixed_pivot_region.y": Row(FAR, {"constraints.fixed_pivot_region": WIDE}),
            "constraints.moving_pivot_region.y": Row(FAR, {"constraints.moving_pivot_region": WIDE}),
            "constraints.link_length.min": Row(1e3, LENGTHS),
            "constraints.max_joint_force": Row(1e-12, {"dynamics": WEIGHED}),
            "constraints.grashof": "double_crank",
            "space.box": Row([[2e3, 2e3], [2001.0, 2001.0]], {"space": {"box": ANYWHERE}}),
            "space.obstacles": Row([OVER_ALL], {"space": {"obstacles": [BESIDE]}}),
            "space.clearance": Row(9e3, {"space": {"obstacles": [BESIDE]}}),
            "layout": LAYOUT,
            "dynamics": WEIGHED,
            "function.x": [0.0, 80.0],
            "input_range": 100.0,
            "output_range": 70.0,
            "either_direction": Row(True, {"mechanisms": ["stephenson_3"], "output_range": -90.0}),
            "criterion": "least_squares",
            "fixed_pivots": {"input": [10.0, 5.0], "output": [90.0, 30.0]},
            "scales": Row({"output": None}, {**OF_PAIRS, "scale_limits": [0.5, 0.7]}),
        },
    ),
    "motion": (MOTION, OF_ALL),
    "dwell": (
        DWELL,
        {
            **OF_ALL,
            "include_failed": FAILS,
            "constraints.max_link_ratio": 3.5,
            "constraints.min_transmission_angle": 40.0,
            "constraints.fixed_pivot_region.x": Row(FAR, {"constraints.fixed_pivot_region": WIDE}),
            "constraints.max_joint_force": Row(1e-12, {"dynamics": WEIGHED}),
            "space.obstacles": Row([OVER_ALL], {"space": {"obstacles": [BESIDE]}}),
        },
    ),
}
