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
AROUND = [
    {"polygon": [[-2e3, -2e3], [2e3, -2e3], [2e3, -75.0], [-2e3, -75.0]]},
    {"polygon": [[-2e3, 25.0], [2e3, 25.0], [2e3, 2e3], [-2e3, 2e3]]},
]
SQUARE = [[-60.0, -60.0], [60.0, -60.0], [60.0, 60.0], [-60.0, 60.0]]
ABOVE = {"polygon": [[-200.0, 250.0], [300.0, 250.0], [300.0, 270.0], [-200.0, 270.0]]}
LAYOUT = {"link_width": 4.0, "pin_diameter": 2.0, "thickness": 2.0}

TOLD = {"include_failed", "layout", "dynamics", "constraints.same_branch", "constraints.in_order"}

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
POINTS = [(40.0, 30.0), (32.0, 42.0), (20.0, 45.0), (8.0, 40.0), (2.0, 30.0), (6.0, 20.0)]
PATH: dict[str, Any] = {
    "kind": "path",
    "points": [{"x": x, "y": y} for x, y in POINTS],
    "mechanisms": ["stephenson_3"],
    "max_designs": 1,
}
FITTED = {"method": "least_squares"}
WALKS = {**FITTED, "closed": True, "stance": {"points": [1, 3], "flatness": 4.0}}
EVENLY = {**FITTED, "closed": True, "stance": {"points": [1, 3], "speed": "constant", "speed_tolerance": 0.3}}
TOLERATED = {"points": [{"x": x, "y": y, "tolerance": 2.0} for x, y in POINTS]}
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
            "scale_limits": Row([1.2, 1.4], {**OF_PAIRS, "scales": {"output": None}}),
            "rank_by": Row("transmission_angle", {"max_designs": 3}),
            "constraints.max_link_ratio": 3.0,
            "constraints.link_length.max": Row(30.0, LENGTHS),
            "constraints.full_rotation": True,
            "layout.max_planes": Row(3, {"layout": LAYOUT}),
            "space.link_width": Row(4e4, {"space": {"obstacles": [BESIDE]}}),
            "space.over": Row("cycle", {"space": {"box": [[-60.0, -60.0], [160.0, 60.0]]}}),
            "range_limits": Row([50.0, 60.0], {"output_range": None, "range_limits": [100.0, 110.0]}),
            "pairs": Row(PAIRS[:5], OF_PAIRS),
            "pairs[].input": Row(-3.0, OF_PAIRS),
            "pairs[].output": Row(-3.0, OF_PAIRS),
            "precision_points": Row(7, {"precision_points": 6}),
            "spacing": Row("equal", {"precision_points": 6}),
            "function.name": "cosine",
            "function.exponent": Row(1.4, {"function": {"name": "power", "exponent": 1.5, "x": [1.0, 4.0]}}),
            "fixed_pivots.output": Row([90.0, 40.0], {"fixed_pivots": {"input": [10.0, 5.0], "output": [90.0, 30.0]}}),
        },
    ),
    "motion": (
        MOTION,
        {
            **OF_ALL,
            "include_failed": FAILS,
            "rank_by": Row("size", {"max_designs": 3}),
            "constraints.min_transmission_angle": 40.0,
            "constraints.max_link_ratio": 3.0,
            "constraints.link_length.min": Row(40.0, LENGTHS),
            "constraints.link_length.max": Row(150.0, LENGTHS),
            "constraints.fixed_pivot_region.y": Row(FAR, {"constraints.fixed_pivot_region": WIDE}),
            "constraints.moving_pivot_region.x": Row([-120.0, 30.0], {"constraints.moving_pivot_region": WIDE}),
            "constraints.max_joint_force": Row(1e-12, {"dynamics": WEIGHED}),
            "constraints.grashof": "double_rocker",
            "constraints.full_rotation": True,
            "constraints.same_branch": False,
            "constraints.in_order": False,
            "positions[].x": 3.0,
            "positions[].angle": 5.0,
            "positions[].tolerance": Row(2.0, at="positions[2].tolerance"),
            "positions[].tolerance.angle": Row(
                {"x": 1.0, "y": 1.0, "angle": 5.0},
                {"positions[2].tolerance": {"x": 1.0, "y": 1.0}},
                at="positions[2].tolerance",
            ),
            "space.box": Row([[-60.0, -140.0], [190.0, 60.0]], {"space": {"box": ANYWHERE}}),
            "space.obstacles": Row(AROUND, {"space": {"obstacles": [BESIDE]}}),
            "space.clearance": Row(5590.0, {"space": {"obstacles": [BESIDE]}}),
            "space.link_width": Row(11180.0, {"space": {"obstacles": [BESIDE]}}),
            "space.body": Row({"outline": SQUARE}, {"space": {"obstacles": [ABOVE], "clearance": 161.0}}),
            "layout": LAYOUT,
            "layout.max_planes": Row(2, {"layout": LAYOUT}),
            "dynamics": WEIGHED,
            "chain.links": Row([120.0, None], {"chain": {"elbow": "left"}}),
            "chain.fixed_pivot": Row([20.0, -110.0], {"chain": {"elbow": "left"}}),
            "chain.moving_pivot": Row([0.0, None], {"chain": {"elbow": "left"}}),
            "chain.elbow": Row("right", {"chain": {"elbow": "left"}}),
        },
    ),
    "path": (
        PATH,
        {
            **OF_ALL,
            "rank_by": Row("size", {"max_designs": 3}),
            "method": "least_squares",
            "closed": Row(True, FITTED),
            "points[].x": 42.0,
            "points[].y": Row(31.0, FITTED),
            "points[].tolerance": Row(0.1, TOLERATED),
            "mechanisms": ["watt_1"],
            "stance.flatness": Row(0.5, WALKS),
            "stance.points": Row([2, 4], WALKS),
            "stance.speed": Row("constant", WALKS),
            "stance.speed_tolerance": Row(0.1, EVENLY),
            "gear_ratio": Row(2.0, {"mechanisms": ["geared_fivebar", "watt_1"], "gear_ratio": 1.0}),
            "fixed_pivots": {"input": [20.0, 10.0]},
            "fixed_pivots.input": Row([22.0, 12.0], {"fixed_pivots": {"input": [20.0, 10.0]}}),
            "fixed_pivots.output": Row([70.0, 10.0], {"fixed_pivots": {"output": [60.0, 10.0]}}),
            "constraints.min_transmission_angle": 45.0,
            "constraints.max_link_ratio": 3.0,
            "constraints.link_length.min": Row(15.0, LENGTHS),
            "constraints.link_length.max": Row(50.0, LENGTHS),
            "constraints.fixed_pivot_region.x": Row([-10.0, 50.0], {"constraints.fixed_pivot_region": WIDE}),
            "constraints.moving_pivot_region.y": Row([0.0, 60.0], {"constraints.moving_pivot_region": WIDE}),
            "constraints.input_pivot_region.y": Row([-40.0, 0.0], {"constraints.input_pivot_region": WIDE}),
            "constraints.grashof": "double_crank",
            "space.box": Row([[-20.0, -20.0], [80.0, 80.0]], {"space": {"box": ANYWHERE}}),
            "space.obstacles": Row([OVER_ALL], {"space": {"obstacles": [BESIDE]}}),
            "space.clearance": Row(9e3, {"space": {"obstacles": [BESIDE]}}),
            "space.link_width": Row(4e4, {"space": {"obstacles": [BESIDE]}}),
            "space.over": Row("cycle", {"space": {"box": [[-20.0, -20.0], [80.0, 80.0]]}}),
            "layout": LAYOUT,
            "layout.max_planes": Row(2, {"layout": LAYOUT}),
            "dynamics": WEIGHED,
        },
    ),
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
            "rank_by": Row("size", {"max_designs": 3}),
            "dwells[].angle": 50.0,
            "dwells[].at": "low",
            "dwells": [{"angle": 50.0, "at": "low"}, {"angle": 30.0, "at": "high"}],
            "output": {"type": "rocker", "swing": 60.0},
            "output.stroke": 50.0,
            "mechanism": "pseudo_arc",
            "tolerance": 1e-5,
            "pivot": [30.0, 40.0],
            "crank": Row(20.0, {"output": {"type": "rocker", "swing": 40.0}}),
            "constraints.grashof": "double_crank",
            "constraints.link_length.max": Row(40.0, LENGTHS),
            "constraints.link_length.min": Row(12.0, LENGTHS),
            "constraints.moving_pivot_region.y": Row(FAR, {"constraints.moving_pivot_region": WIDE}),
            "space.box": Row([[2e3, 2e3], [2001.0, 2001.0]], {"space": {"box": ANYWHERE}}),
            "space.clearance": Row(9e3, {"space": {"obstacles": [BESIDE]}}),
            "space.link_width": Row(4e4, {"space": {"obstacles": [BESIDE]}}),
            "layout": LAYOUT,
            "layout.max_planes": Row(2, {"layout": LAYOUT}),
            "dynamics": WEIGHED,
        },
    ),
}

TOGETHER: dict[str, dict[str, Any]] = {
    "function": {
        **FUNCTION,
        "constraints": {
            "min_transmission_angle": 35.0,
            "max_link_ratio": 5.0,
            "link_length": {"min": 20.0, "max": 150.0},
            "fixed_pivot_region": {"x": [0.0, 200.0], "y": [-100.0, 100.0]},
        },
    },
    "motion": {
        **MOTION,
        "constraints": {
            "min_transmission_angle": 30.0,
            "max_link_ratio": 6.0,
            "link_length": {"min": 20.0, "max": 200.0},
        },
        "dynamics": WEIGHED,
        "layout": LAYOUT,
    },
    "path": {
        **PATH,
        "constraints": {
            "grashof": "crank_rocker",
            "min_transmission_angle": 30.0,
            "max_link_ratio": 6.0,
            "fixed_pivot_region": {"x": [-60.0, 80.0], "y": [-60.0, 80.0]},
        },
        "space": {"box": [[-80.0, -80.0], [110.0, 110.0]]},
    },
    "dwell": {
        **DWELL,
        "constraints": {
            "grashof": "crank_rocker",
            "min_transmission_angle": 30.0,
            "max_link_ratio": 7.0,
            "link_length": {"min": 8.0, "max": 70.0},
            "fixed_pivot_region": {"x": [0.0, 150.0], "y": [-150.0, 150.0]},
        },
        "space": {"box": [[-200.0, -200.0], [300.0, 300.0]]},
    },
}
"""Demands of each kind that are kept together."""
