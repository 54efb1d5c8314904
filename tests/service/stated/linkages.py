"""Rows of linkages: what all of them have, and what belongs to each kind."""

from __future__ import annotations

from typing import Any

from tests.service.stated.row import Row

WIDE = {"x": [-1e6, 1e6], "y": [-1e6, 1e6]}
FAR = [9e5, 1e6]

UNITS: dict[str, Any] = {"length_unit": Row("in", file="csv"), "seed": 7}

WEIGHED = {"gravity": {}, "loads": [{"joint": "A", "force": {"constant": [1.0, 2.0]}}], "speed_rpm": 30.0, "speed": 0.1}

DEMANDS: dict[str, Any] = {
    "dynamics": WEIGHED,
    **{
        f"constraints.max_{name}": Row(1e6, {"dynamics": WEIGHED})
        for name in ("drive_torque", "joint_force", "shaking_force", "shaking_moment", "power", "joint_force_index")
    },
    "space": {"box": [[-1e6, -1e6], [1e6, 1e6]]},
    "manufacture": {"tolerances": {"length": 1e-3}},
    "constraints": {"min_transmission_angle": 1.0},
    "constraints.min_transmission_angle": 1.0,
    "constraints.grashof": "non_grashof",
    "constraints.full_rotation": True,
    "constraints.same_branch": False,
    "constraints.in_order": False,
    "constraints.link_length": {"min": 1e-3, "max": 1e6},
    "constraints.link_length.min": Row(1e-3, {"constraints.link_length.max": 1e6}),
    "constraints.link_length.max": Row(1e6, {"constraints.link_length.min": 1e-3}),
    "constraints.max_link_ratio": 1e6,
    "constraints.fixed_pivot_region": WIDE,
    "constraints.fixed_pivot_region.x": Row(FAR, {"constraints.fixed_pivot_region": WIDE}),
    "constraints.fixed_pivot_region.y": Row(FAR, {"constraints.fixed_pivot_region": WIDE}),
    "constraints.moving_pivot_region": WIDE,
    "constraints.moving_pivot_region.x": Row(FAR, {"constraints.moving_pivot_region": WIDE}),
    "constraints.moving_pivot_region.y": Row(FAR, {"constraints.moving_pivot_region": WIDE}),
}
"""Demands that every design keeps are shown among its checks; a far region is kept by none."""


def layout_rows(wide: float, base: dict[str, Any] | None = None) -> dict[str, Any]:
    """Rows of the block ``layout``; links and pins ``wide`` get in one another's way, slender ones do not."""
    block = {"link_width": 0.2 * wide, "pin_diameter": 0.1 * wide, "thickness": 3.0}
    problem = {**(base or {}), "layout": block}
    return {
        "layout": Row(block, base or {}),
        "layout.link_width": Row(wide, problem),
        "layout.pin_diameter": Row(wide, {**problem, "layout": {**block, "link_width": wide}}),
        "layout.thickness": Row(4.0, problem),
        "layout.gap": Row(0.5 * wide, problem),
        "layout.max_planes": Row(20, problem),
        "layout.shafts": Row("both_sides", problem),
        "layout.over": Row("cycle", problem),
    }


def whole_turn(rows: dict[str, Any]) -> dict[str, Any]:
    """The rows of a kind whose used range is the cycle."""
    return {name: row for name, row in rows.items() if name != "layout.over"}


NONE_KEEPS = {"constraints.min_transmission_angle": 89.5}

MOTION: dict[str, Any] = {
    "kind": "motion",
    "positions": [
        {"x": 0.0, "y": 0.0, "angle": 0.0},
        {"x": 40.0, "y": 15.0, "angle": -25.0},
        {"x": 75.0, "y": 5.0, "angle": -60.0},
    ],
    "input_side": {"moving_pivot": [-20.0, -30.0]},
    "output_side": {"moving_pivot": [30.0, -40.0]},
}
TWO = {"positions": [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 30.0, "y": 20.0, "angle": 45.0}]}
OPEN_INPUT = {"input_side": {}}
OPEN_OUTPUT = {"output_side": {}}
BOTH_OPEN = {**OPEN_INPUT, **OPEN_OUTPUT, "max_designs": 2}
FITTED = {
    "positions": [
        {"x": 0.0, "y": 0.0, "angle": 0.0},
        {"x": 12.0, "y": 7.0, "angle": -9.0},
        {"x": 26.0, "y": 12.0, "angle": -17.0},
        {"x": 41.0, "y": 14.0, "angle": -27.0},
        {"x": 55.0, "y": 13.0, "angle": -38.0},
        {"x": 75.0, "y": 5.0, "angle": -60.0},
    ],
    "max_designs": 1,
}
TOLERATED = {
    "positions": [
        {"x": 0.0, "y": 0.0, "angle": 0.0},
        {"x": 12.0, "y": 7.0, "angle": -9.0, "tolerance": {"x": 1.0, "y": 1.0, "angle": 3.0}},
        {"x": 26.0, "y": 12.0, "angle": -17.0, "tolerance": 1.0},
        {"x": 41.0, "y": 14.0, "angle": -27.0, "tolerance": 1.0},
        {"x": 55.0, "y": 13.0, "angle": -38.0, "tolerance": {"angle": 5.0}},
        {"x": 75.0, "y": 5.0, "angle": -60.0},
    ],
    "input_side": {},
    "output_side": {},
    "max_designs": 1,
}
DRIVEN = {
    **TWO,
    "input_side": {"fixed_pivot": [0.0, -40.0], "rotations": [50.0]},
    "output_side": {"fixed_pivot": [40.0, -40.0], "rotations": [40.0]},
    "max_designs": 2,
}

SIXBARS: dict[str, Any] = {
    "positions": [
        {"x": 0.0, "y": 0.0, "angle": 0.0},
        {"x": 35.0, "y": 12.0, "angle": 20.0},
        {"x": 70.0, "y": 8.0, "angle": 5.0},
        {"x": 100.0, "y": -20.0, "angle": -25.0},
        {"x": 115.0, "y": -60.0, "angle": -40.0},
    ],
    "input_side": {},
    "output_side": {},
    "mechanisms": ["watt_1"],
    "max_designs": 1,
}

MOTION_ROWS: dict[str, Any] = {
    **UNITS,
    **DEMANDS,
    **layout_rows(60.0),
    "max_designs": Row(2, {**BOTH_OPEN, "max_designs": 1}),
    "include_failed": Row(True, NONE_KEEPS),
    "rank_by": Row("size", {**BOTH_OPEN, "max_designs": 3}),
    "positions": TWO["positions"],
    "positions[].x": 1.0,
    "positions[].y": 1.0,
    "positions[].angle": 1.0,
    "positions[].tolerance": Row(2.0, TOLERATED, at="positions[2].tolerance"),
    "positions[].tolerance.x": Row(2.0, TOLERATED, at="positions[1].tolerance.x"),
    "positions[].tolerance.y": Row(2.0, TOLERATED, at="positions[1].tolerance.y"),
    "positions[].tolerance.angle": Row(4.0, TOLERATED, at="positions[1].tolerance.angle"),
    "positions[].exact": Row(True, FITTED),
    "input_side": {"moving_pivot": [-25.0, -30.0]},
    "input_side.dyad": Row("PR", OPEN_INPUT),
    "input_side.fixed_pivot": Row([-60.0, -20.0], OPEN_INPUT),
    "input_side.moving_pivot": [-25.0, -30.0],
    "input_side.rotations": Row([20.0, 50.0], OPEN_INPUT),
    "input_side.link_angle": Row(40.0, {**OPEN_INPUT, "max_designs": 1}),
    "input_side.coupler_vector": Row({"length": 30.0, "angle": 60.0}, OPEN_INPUT),
    "input_side.coupler_vector.length": Row(31.0, {"input_side": {"coupler_vector": {"length": 30.0, "angle": 60.0}}}),
    "input_side.coupler_vector.angle": Row(61.0, {"input_side": {"coupler_vector": {"length": 30.0, "angle": 60.0}}}),
    "input_side.slide_angle": Row(15.0, {"input_side": {"dyad": "PR"}}),
    "output_side": {"moving_pivot": [35.0, -40.0]},
    "output_side.dyad": Row("PR", OPEN_OUTPUT),
    "output_side.fixed_pivot": Row([60.0, -90.0], OPEN_OUTPUT),
    "output_side.moving_pivot": [35.0, -40.0],
    "output_side.rotations": Row([20.0, 50.0], OPEN_OUTPUT),
    "output_side.link_angle": Row(40.0, {**OPEN_OUTPUT, "max_designs": 1}),
    "output_side.coupler_vector": Row({"length": 30.0, "angle": 60.0}, OPEN_OUTPUT),
    "output_side.coupler_vector.length": Row(
        31.0, {"output_side": {"coupler_vector": {"length": 30.0, "angle": 60.0}}}
    ),
    "output_side.coupler_vector.angle": Row(61.0, {"output_side": {"coupler_vector": {"length": 30.0, "angle": 60.0}}}),
    "output_side.slide_angle": Row(15.0, {"output_side": {"dyad": "PR"}}),
    "ground_line": Row({"point": [0.0, -60.0], "angle": 0.0}, BOTH_OPEN),
    "ground_line.point": Row([0.0, -70.0], {**BOTH_OPEN, "ground_line": {"point": [0.0, -60.0], "angle": 0.0}}),
    "ground_line.angle": Row(10.0, {**BOTH_OPEN, "ground_line": {"point": [0.0, -60.0], "angle": 0.0}}),
    "method": Row("least_squares", {"positions": [*FITTED["positions"][:4], FITTED["positions"][5]], **BOTH_OPEN}),
    "mechanisms": Row(["stephenson_3"], SIXBARS),
    "chain": Row({"elbow": "left", "fixed_pivot": [20.0, -110.0]}, SIXBARS),
    "chain.links": Row([120.0, None], {**SIXBARS, "chain": {"elbow": "left"}}),
    "chain.fixed_pivot": Row([20.0, -110.0], {**SIXBARS, "chain": {"elbow": "left"}}),
    "chain.moving_pivot": Row([0.0, None], {**SIXBARS, "chain": {"elbow": "left"}}),
    "chain.elbow": Row("left", {**SIXBARS, "chain": {"elbow": "right"}}),
    "driver_dyad": Row(True, DRIVEN),
    "driver_dyad.link": Row("output", {**DRIVEN, "driver_dyad": {"link": "input"}}),
    "driver_dyad.pivot_region": Row({"x": [-300.0, 300.0], "y": [-300.0, -60.0]}, {**DRIVEN, "driver_dyad": {}}),
    "driver_dyad.pivot_region.x": Row(FAR, {**DRIVEN, "driver_dyad": {"pivot_region": WIDE}}),
    "driver_dyad.pivot_region.y": Row(FAR, {**DRIVEN, "driver_dyad": {"pivot_region": WIDE}}),
}

TIMED = [
    {"x": -23.0, "y": 34.0, "crank_angle": 0.0},
    {"x": -17.0, "y": 32.0, "crank_angle": 40.0},
    {"x": -7.0, "y": 40.0, "crank_angle": 80.0},
    {"x": 4.0, "y": 55.0, "crank_angle": 120.0},
    {"x": 8.0, "y": 66.0, "crank_angle": 160.0},
]
PATH: dict[str, Any] = {"kind": "path", "timing": "prescribed", "points": TIMED, "max_designs": 2}
UNTIMED = {
    "timing": "free",
    "points": [{"x": p["x"], "y": p["y"]} for p in TIMED[:4]],
    "rounds": 1,
    "max_designs": 1,
    "fixed_pivots": {"input": [-10.0, 0.0], "output": [40.0, 10.0]},
}
ELLIPSE = {
    "timing": "free",
    "closed": True,
    "method": "curve_match",
    "points": [
        {"x": 53.0, "y": 71.0},
        {"x": 35.0, "y": 71.0},
        {"x": 14.0, "y": 60.0},
        {"x": 11.6, "y": 39.0},
        {"x": 11.6, "y": 18.0},
        {"x": 18.0, "y": 20.0},
        {"x": 38.0, "y": 39.0},
        {"x": 60.0, "y": 62.0},
    ],
    "max_designs": 1,
}

WALKS = {**ELLIPSE, "stance": {"points": [2, 4], "flatness": 3.0}}
EVENLY = {"points": [2, 4], "speed": "constant", "speed_tolerance": 0.4}

START = {"O2": [1.1, -2.0], "A": [1.6, -0.1], "B": [4.4, 5.2], "O4": [7.1, 1.0], "P": [1.3, 3.5]}
FIVE_POINTS = ((1.21, 1.77), (1.4, 2.9), (1.17, 3.51), (0.56, 3.55), (-0.15, 3.09))
FITTED_PATH = {
    "timing": "free",
    "method": "least_squares",
    "points": [{"x": x, "y": y} for x, y in FIVE_POINTS],
    "max_designs": 1,
}
FROM_START = {**FITTED_PATH, "start": START}
"""Many fourbars meet five points: a fit ends at one near its start."""

PATH_ROWS: dict[str, Any] = {
    **UNITS,
    **DEMANDS,
    **layout_rows(60.0),
    "constraints.input_pivot_region": WIDE,
    "constraints.input_pivot_region.x": Row(FAR, {"constraints.input_pivot_region": WIDE}),
    "constraints.input_pivot_region.y": Row(FAR, {"constraints.input_pivot_region": WIDE}),
    "constraints.coupler_point": {"along": [-1e6, 1e6]},
    "constraints.coupler_point.along": Row(FAR, {"constraints.coupler_point": {"along": [-1e6, 1e6]}}),
    "constraints.coupler_point.across": Row(FAR, {"constraints.coupler_point": {"across": [-1e6, 1e6]}}),
    "max_designs": 1,
    "include_failed": Row(True, {**NONE_KEEPS, "method": "exact"}),
    "rank_by": "size",
    "mechanisms": Row(["stephenson_3"], UNTIMED),
    "points": TIMED[:4],
    "points[].x": -24.0,
    "points[].y": 35.0,
    "points[].crank_angle": Row(45.0, at="points[1].crank_angle"),
    "timing": "free",
    "crank_phase": "absolute",
    "crank_direction": Row(
        "either", {"points": [{**p, "crank_angle": -p["crank_angle"]} for p in TIMED], "max_designs": 20}
    ),
    "closed": True,
    "method": "least_squares",
    "placement_free": Row(["position"], {**ELLIPSE, "fixed_pivots": {"input": [0.0, 0.0]}}),
    "points[].tolerance": Row(1.0, {"method": "least_squares"}),
    "mechanism": Row("slider_crank", UNTIMED),
    "gear_ratio": Row(2.0, {**UNTIMED, "mechanism": "geared_fivebar"}),
    "fixed_pivots": Row({"input": [-10.0, 0.0]}, {"points": TIMED[:4]}),
    "fixed_pivots.input": Row([-12.0, 0.0], {"points": TIMED[:3], "fixed_pivots": {"input": [-10.0, 0.0]}}),
    "fixed_pivots.output": Row([42.0, 10.0], {"points": TIMED[:4], "fixed_pivots": {"output": [40.0, 10.0]}}),
    "rounds": Row(2, {**UNTIMED, "fixed_pivots": {}}),
    "start": Row(START, FITTED_PATH),
    "start.O2": Row([1.3, -2.1], FROM_START),
    "start.A": Row([1.8, -0.2], FROM_START),
    "start.B": Row([4.6, 5.1], FROM_START),
    "start.O4": Row([7.3, 0.9], FROM_START),
    "start.P": Row([1.5, 3.4], FROM_START),
    "stance": Row(WALKS["stance"], ELLIPSE),
    "stance.points": Row([1, 3], WALKS),
    "stance.flatness": Row(0.5, WALKS),
    "stance.speed": Row("constant", WALKS),
    "stance.speed_tolerance": Row(0.2, {**ELLIPSE, "stance": EVENLY}),
}

QUICK_RETURN: dict[str, Any] = {
    "kind": "quick_return",
    "time_ratio": 1.25,
    "swing": 45.0,
    "mechanism": "fourbar",
    "max_designs": 2,
}
SLIDES = {"swing": None, "stroke": 100.0, "mechanism": "offset_slider_crank"}
LIMITS = [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 60.0, "y": 20.0, "angle": 50.0}]
CARRIED = {"swing": None, "positions": LIMITS}
QUICK_RETURN_ROWS: dict[str, Any] = {
    **UNITS,
    **DEMANDS,
    **whole_turn(layout_rows(1.6)),
    "max_designs": 1,
    "include_failed": Row(True, NONE_KEEPS),
    "rank_by": "size",
    "time_ratio": 1.3,
    "swing": 46.0,
    "stroke": Row(110.0, SLIDES),
    "positions": Row([LIMITS[0], {"x": 60.0, "y": 25.0, "angle": 50.0}], CARRIED),
    "positions[].x": Row(1.0, CARRIED),
    "positions[].y": Row(1.0, CARRIED),
    "positions[].angle": Row(1.0, CARRIED),
    "rotopole": [5.0, 5.0],
    "mechanism": Row("drag_link_rocker", {"mechanism": "auto"}),
    "rocker_length": 5.0,
    "crank_pivot": [3.0, 4.0],
    "ground_angle": 20.0,
}

LINE: dict[str, Any] = {"kind": "straight_line", "length": 100.0, "mechanism": "hoeken", "crank_range": 120.0}
LINE_ROWS: dict[str, Any] = {
    **UNITS,
    **DEMANDS,
    **layout_rows(160.0),
    "max_designs": Row(1, {"mechanism": "auto", "max_designs": 3}),
    "include_failed": Row(True, {"max_deviation": 1e-6}),
    "rank_by": Row("size", {"mechanism": "auto"}),
    "length": 90.0,
    "crank_range": 110.0,
    "optimize": "velocity",
    "mechanism": "peaucellier",
    "start": [3.0, 4.0],
    "direction": 10.0,
    "rotation": "cw",
    "max_deviation": 5.0,
    "max_velocity_variation": 90.0,
}

STEERING: dict[str, Any] = {
    "kind": "steering",
    "wheelbase": 2745.0,
    "pivot_distance": 1220.0,
    "lock": 40.0,
    "mechanism": "davis",
}
STEERING_ROWS: dict[str, Any] = {
    **UNITS,
    **DEMANDS,
    "constraints.max_drive_torque": Row(1e6, {"dynamics": WEIGHED, "mechanism": "ackermann"}),
    **layout_rows(1200.0),
    "max_designs": 1,
    "include_failed": Row(True, {"mechanism": "ackermann", "max_steering_error": 1e-3}),
    "rank_by": Row("size", {"mechanism": "auto"}),
    "wheelbase": 2800.0,
    "pivot_distance": 1200.0,
    "track": 1475.0,
    "wheel_width": Row(200.0, {"mechanism": "ackermann", "track": 1475.0}),
    "lock": 35.0,
    "mechanism": "ackermann",
    "tie_rod": "ahead",
    "arm_length": {"min": 150.0, "max": 160.0},
    "arm_length.min": Row(150.0, {"mechanism": "ackermann", "arm_length": {"min": 140.0, "max": 160.0}}),
    "arm_length.max": Row(150.0, {"mechanism": "ackermann", "arm_length": {"min": 140.0, "max": 160.0}}),
    "max_steering_error": 2.0,
}

DWELL: dict[str, Any] = {
    "kind": "dwell",
    "dwell_angle": 60.0,
    "output": {"type": "rocker", "swing": 90.0},
    "mechanism": "pseudo_arc",
    "max_designs": 1,
}
SLIDER = {"output": {"type": "slider", "stroke": 60.0}}
PLACED = {"dwell_angle": None, "dwells": [{"angle": 60.0, "at": "low"}], "output": {"type": "slider", "stroke": 60.0}}
DWELL_ROWS: dict[str, Any] = {
    **UNITS,
    **DEMANDS,
    **whole_turn(layout_rows(30.0)),
    **{
        f"constraints.{region}.{axis}": Row(FAR, {f"constraints.{region}": WIDE})
        for region in ("fixed_pivot_region", "moving_pivot_region")
        for axis in "xy"
    },
    "max_designs": 2,
    "include_failed": Row(True, {**SLIDER, "constraints.link_length": {"max": 20.0}}),
    "rank_by": "size",
    "dwell_angle": 50.0,
    "dwells": Row([{"angle": 60.0, "at": 0.5}], PLACED),
    "dwells[].angle": Row(50.0, PLACED),
    "dwells[].at": Row(0.6, PLACED),
    "output": SLIDER["output"],
    "output<RockerOutput>.type": Row("slider", {"output": {"type": "rocker", "swing": 90.0}}),
    "output<RockerOutput>.swing": 80.0,
    "output<SliderOutput>.type": Row("rocker", SLIDER),
    "output<SliderOutput>.stroke": Row(50.0, SLIDER),
    "count": Row(2, {"dwell_angle": 30.0, "output": {"type": "rocker", "swing": 40.0}, "tolerance": 2.0}),
    "mechanism": "straight_slot",
    "tolerance": 2.0,
    "crank": 12.0,
    "pivot": [3.0, 4.0],
}

PARALLEL: dict[str, Any] = {
    "kind": "parallel_motion",
    "linkage": {
        "fixed_pivots": {"input": [0.0, 0.0], "output": [60.0, 0.0]},
        "links": {"input": 20.0, "coupler": 70.0, "output": 90.0},
        "coupler_point": {"distance": 60.0, "angle": 30.0},
    },
    "include_cognates": False,
}
SKELETON = {
    "joints": {"O2": [0.0, 0.0], "O4": [60.0, 0.0], "A": [20.0, 0.0]},
    "links": [{"name": "ground", "joints": ["O2", "O4"]}, {"name": "input", "joints": ["O2", "A"]}],
    "input_link": "input",
}
"""Not that of a fourbar: whatever is changed of it is refused in other words."""

PARALLEL_ROWS: dict[str, Any] = {
    **UNITS,
    **DEMANDS,
    **layout_rows(60.0, {"include_cognates": True}),
    "max_designs": Row(1, {"include_cognates": True}),
    "include_failed": Row(True, NONE_KEEPS),
    "rank_by": Row("size", {"include_cognates": True}),
    "linkage": {**PARALLEL["linkage"], "assembly": "crossed"},
    "linkage.type": "slider_crank",
    "linkage.fixed_pivots": {"input": [0.0, 0.0], "output": [61.0, 0.0]},
    "linkage.fixed_pivots.input": [1.0, 1.0],
    "linkage.fixed_pivots.output": [61.0, 1.0],
    "linkage.links": {"input": 21.0, "coupler": 70.0, "output": 90.0},
    "linkage.links.ground": 50.0,
    "linkage.links.input": 21.0,
    "linkage.links.coupler": 71.0,
    "linkage.links.output": 91.0,
    "linkage.coupler_point": {"distance": 50.0, "angle": 30.0},
    "linkage.coupler_point.distance": 50.0,
    "linkage.coupler_point.angle": 40.0,
    "linkage.assembly": "crossed",
    "linkage.reference_input_angle": 77.0,
    "linkage.skeleton": SKELETON,
    "path": Row({**PATH, "max_designs": 1}, {"linkage": None, "path": PATH}),
    "include_cognates": True,
}

FUNCTION: dict[str, Any] = {
    "kind": "function",
    "pairs": [{"input": 40.0, "output": 70.0}, {"input": 45.0, "output": 76.0}, {"input": 60.0, "output": 90.0}],
}
POWER = {"name": "power", "exponent": 1.5, "x": [1.0, 4.0]}
FITS = {
    "pairs": None,
    "function": POWER,
    "input_range": 90.0,
    "output_range": 90.0,
    "criterion": "least_squares",
    "max_designs": 1,
}
PIVOTS = {"input": [10.0, 5.0], "output": [90.0, 30.0]}
FUNCTION_ROWS: dict[str, Any] = {
    **UNITS,
    "length_unit": Row("in", file="dxf"),
    **DEMANDS,
    **layout_rows(60.0, {"fixed_pivots": {"input": [10.0, 5.0], "output": [90.0, 30.0]}}),
    "max_designs": Row(1, {"pairs": [*FUNCTION["pairs"], {"input": 70.0, "output": 97.0}], "max_designs": 3}),
    "include_failed": Row(True, NONE_KEEPS),
    "rank_by": Row("size", {"pairs": [*FUNCTION["pairs"], {"input": 70.0, "output": 97.0}], "max_designs": 6}),
    "pairs": FUNCTION["pairs"][:2],
    "pairs[].input": 41.0,
    "pairs[].output": 71.0,
    "function": Row({**POWER, "exponent": 1.6}, FITS),
    "function.name": Row("sine", {**FITS, "function": {"name": "exponential", "x": [0.2, 1.2]}}),
    "function.x": Row([1.0, 3.0], FITS),
    "function.exponent": Row(1.4, FITS),
    "function.base": Row(3.0, {**FITS, "function": {"name": "exponential", "x": [0.0, 2.0]}}),
    "function.points": Row(
        [{"x": 0.0, "y": 0.0}, {"x": 1.0, "y": 1.0}, {"x": 2.0, "y": 2.6}, {"x": 3.0, "y": 4.0}],
        {
            **FITS,
            "function": {
                "name": "table",
                "points": [{"x": 0.0, "y": 0.0}, {"x": 1.0, "y": 1.0}, {"x": 2.0, "y": 2.5}, {"x": 3.0, "y": 4.0}],
            },
        },
    ),
    "function.points[].x": Row(
        0.1,
        {
            **FITS,
            "function": {
                "name": "table",
                "points": [{"x": 0.0, "y": 0.0}, {"x": 1.0, "y": 1.0}, {"x": 2.0, "y": 2.5}, {"x": 3.0, "y": 4.0}],
            },
        },
    ),
    "function.points[].y": Row(
        0.1,
        {
            **FITS,
            "function": {
                "name": "table",
                "points": [{"x": 0.0, "y": 0.0}, {"x": 1.0, "y": 1.0}, {"x": 2.0, "y": 2.5}, {"x": 3.0, "y": 4.0}],
            },
        },
    ),
    "input_range": Row(80.0, FITS),
    "output_range": Row(80.0, FITS),
    "either_direction": Row(True, {**FITS, "max_designs": 5}),
    "mechanisms": Row(["watt_2"], {**FITS, "criterion": "minimax"}),
    "range_limits": Row([30.0, 60.0], {**FITS, "output_range": None}),
    "scales": {"input": 1.0, "output": 1.1},
    "scales.input": Row(1.1, {"scales": {"input": 1.0, "output": 1.0}}),
    "scales.output": Row(1.1, {"scales": {"input": 1.0, "output": 1.0}}),
    "scale_limits": Row(
        [0.9, 1.1],
        {
            "scales": {"input": 1.0, "output": None},
            "zeros": {"input": 0.0, "output": 0.0},
            "pairs": [*FUNCTION["pairs"], {"input": 70.0, "output": 99.0}],
            "criterion": "least_squares",
        },
    ),
    "zeros": {"input": 10.0, "output": 5.0},
    "zeros.input": Row(10.0, {"zeros": {"input": 0.0, "output": 0.0}}),
    "zeros.output": Row(10.0, {"zeros": {"input": 0.0, "output": 0.0}}),
    "precision_points": Row(4, {**FITS, "criterion": "precision", "precision_points": 3}),
    "spacing": Row("equal", {**FITS, "criterion": "precision", "precision_points": 4}),
    "mechanism": Row("slider_crank", FITS),
    "criterion": Row("minimax", FITS),
    "fixed_pivots": PIVOTS,
    "fixed_pivots.input": Row([1.0, 2.0], {"fixed_pivots": PIVOTS}),
    "fixed_pivots.output": Row([101.0, 2.0], {"fixed_pivots": PIVOTS}),
}
