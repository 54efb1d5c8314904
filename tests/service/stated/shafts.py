"""Flywheels, engines and indexing drives: of every field a value with which the answer is another one."""

from __future__ import annotations

from typing import Any

from tests.service.stated.row import Row

TABLE = {"table": [[0.0, 10.0], [90.0, 160.0], [120.0, 160.0], [150.0, 10.0]]}
FLYWHEEL: dict[str, Any] = {
    "kind": "flywheel",
    "torque": TABLE,
    "speed_rpm": 300.0,
    "coefficient": 0.05,
    "form": "any",
    "density": 7800.0,
    "limits": {"radius": {"max": 250.0}, "thickness": {"min": 5.0, "max": 90.0}},
}
CRANK = {
    "mechanism": {
        "type": "slider_crank",
        "fixed_pivot": [0.0, 0.0],
        "links": {"crank": 50.0, "coupler": 180.0},
        "slide": {"point": [0.0, 0.0], "angle": 0.0},
    },
    "dynamics": {"point_masses": [{"joint": "B", "mass": 120.0}]},
}
BY_MACHINE = {"torque": None, "machine": CRANK}
FLYWHEEL_ROWS: dict[str, Any] = {
    "length_unit": Row("in", {"units": "consistent"}, file="dxf"),
    "max_designs": 1,
    "seed": 7,
    "coefficient": 0.04,
    "existing_inertia": 0.5,
    "units": Row("consistent", {"limits": {"radius": {"max": 0.3}, "wall": {"min": 0.01}}}),
    "torque": {"table": [[0.0, 10.0], [90.0, 150.0], [150.0, 10.0]]},
    "torque.table": [[0.0, 10.0], [90.0, 150.0], [150.0, 10.0]],
    "torque.interpolation": "periodic_cubic",
    "torque.turns": 2,
    "torque.side": "supply",
    "machine": Row(CRANK, {"torque": None}),
    "machine.mechanism": Row(
        {**CRANK["mechanism"], "links": {"crank": 45.0, "coupler": 180.0}},
        BY_MACHINE,
    ),
    "machine.dynamics": Row({"point_masses": [{"joint": "B", "mass": 110.0}]}, BY_MACHINE),
    "speed_rpm": 310.0,
    "form": "disc",
    "density": 7200.0,
    "limits": {"radius": {"max": 240.0}, "thickness": {"min": 5.0, "max": 90.0}},
    "limits.radius": {"max": 240.0},
    "limits.radius.max": 240.0,
    "limits.thickness": {"max": 95.0},
    "limits.thickness.min": 85.0,
    "limits.thickness.max": 95.0,
    "limits.wall": {"min": 100.0},
    "limits.wall.min": Row(120.0, {"limits": {"radius": {"max": 250.0}, "wall": {"min": 110.0}}}),
    "limits.rim_speed": {"max": 8.0},
    "limits.rim_speed.max": Row(7.9, {"limits": {"rim_speed": {"max": 8.0}, "thickness": {"max": 90.0}}}),
    "limits.radius_to_thickness": {"max": 4.0},
    "limits.radius_to_thickness.max": Row(
        3.5, {"limits": {"radius_to_thickness": {"max": 4.0}, "thickness": {"max": 90.0}}}
    ),
}

MASSES = {
    "piston": 0.35,
    "rod": {"mass": 0.45, "cg": 40.0, "inertia": 0.0012},
    "crank": {"mass": 1.0, "cg": 5.0, "inertia": 0.001},
}
GAS = {"table": [[0.0, 2e6], [60.0, 5e5], [180.0, 0.0], [540.0, 0.0], [660.0, 2e5]]}
ENGINE: dict[str, Any] = {
    "kind": "engine",
    "cylinders": 2,
    "stroke_cycle": 4,
    "bore": 70.0,
    "stroke": 70.0,
    "rod": 120.0,
    "masses": MASSES,
    "pressure": GAS,
    "speed_rpm": 2000.0,
    "layout": {"type": "inline", "throws": [0.0, 170.0], "spacing": 80.0},
    "flywheel": {"coefficient": 0.05, "speed_rpm": 800.0},
}
VEE = {"type": "vee", "vee_angle": 80.0, "throws": [0.0, 170.0]}
FOUR = {"cylinders": 4, "layout": VEE}
SOUGHT = {"cylinders": 4, "layout": {"type": "inline"}, "max_designs": 2}
ENGINE_ROWS: dict[str, Any] = {
    "length_unit": "cm",
    "max_designs": Row(1, SOUGHT),
    "include_failed": Row(True, {"firing_order": [1, 2], "firing_angles": [0.0, 30.0]}),
    "seed": 7,
    "units": Row("consistent", {"masses": {"piston": 0.35, "rod": {"mass": 0.45, "cg": 40.0}}, "flywheel": None}),
    "cylinders": Row(3, {"layout": {"type": "inline"}}),
    "stroke_cycle": Row(2, {"pressure": None}),
    "stroke": 72.0,
    "rod": 130.0,
    "rod_ratio": Row(3.6, {"rod": None, "masses": None, "pressure": None, "flywheel": None}),
    "bore": 72.0,
    "masses": {"piston": 0.4, "rod": {"mass": 0.45, "cg": 40.0}},
    "masses.piston": 0.4,
    "masses.rod": {"mass": 0.5, "cg": 40.0},
    "masses.rod.mass": 0.5,
    "masses.rod.cg": 41.0,
    "masses.rod.inertia": 0.0013,
    "masses.crank": {"mass": 1.0, "cg": -5.0},
    "masses.crank.mass": 1.1,
    "masses.crank.cg": -5.0,
    "masses.crank.inertia": 0.002,
    "pressure": {"table": [[0.0, 2e6], [60.0, 5e5], [180.0, 0.0]]},
    "pressure.table": [[0.0, 2e6], [60.0, 5e5], [180.0, 0.0]],
    "pressure.interpolation": "periodic_cubic",
    "speed_rpm": 2100.0,
    "layout": {"type": "inline", "throws": [0.0, 160.0]},
    "layout.type": Row("opposed", {"layout": {"type": "inline", "pins": "shared", "throws": [0.0]}, "cylinders": 1}),
    "layout.vee_angle": Row(70.0, FOUR),
    "layout.pins": Row("own", {"cylinders": 2, "layout": {"type": "opposed"}}),
    "layout.throws": [0.0, 160.0],
    "layout.positions": [0.0, 2.0],
    "layout.spacing": 90.0,
    "layout.numbering": Row("by_bank", FOUR),
    "layout.first_bank": Row("right", FOUR),
    "other_layouts": Row([{"type": "opposed", "pins": "own"}], SOUGHT),
    "other_layouts[].type": Row(
        "radial", SOUGHT | {"other_layouts": [{"type": "opposed"}], "stroke_cycle": 2, "pressure": None}
    ),
    "other_layouts[].vee_angle": Row(80.0, SOUGHT | {"other_layouts": [{"type": "vee", "vee_angle": 90.0}]}),
    "other_layouts[].pins": Row("own", SOUGHT | {"other_layouts": [{"type": "opposed"}]}),
    "other_layouts[].throws": Row([0.0, 0.0], SOUGHT | {"other_layouts": [{"type": "opposed"}]}),
    "other_layouts[].positions": Row(
        [0.0, 1.0, 2.0, 4.0], SOUGHT | {"layout": {"type": "radial"}, "other_layouts": [{"type": "inline"}]}
    ),
    "other_layouts[].spacing": Row(
        70.0, SOUGHT | {"layout": {"type": "radial"}, "other_layouts": [{"type": "inline", "spacing": 60.0}]}
    ),
    "other_layouts[].numbering": Row(
        "by_bank", SOUGHT | {"layout": {"type": "radial"}, "other_layouts": [{"type": "opposed"}]}
    ),
    "other_layouts[].first_bank": Row(
        "right", SOUGHT | {"layout": {"type": "radial"}, "other_layouts": [{"type": "opposed"}]}
    ),
    "throw_angles": Row([0.0, 90.0, 180.0], {"layout": {"type": "inline"}}),
    "moment_about": "middle",
    "method": "two_term",
    "avoid_adjacent": Row(False, {"cylinders": 6, "layout": {"type": "inline"}, "max_designs": 1}),
    "firing_order": [1, 2],
    "firing_angles": Row([0.0, 170.0], {"firing_order": [1, 2]}),
    "flywheel": {"coefficient": 0.04, "speed_rpm": 800.0},
    "flywheel.coefficient": 0.04,
    "flywheel.existing_inertia": 0.01,
    "flywheel.speed_rpm": 700.0,
}

INDEXING: dict[str, Any] = {
    "kind": "indexing",
    "drive": "geneva_external",
    "stations": 6,
    "center_distance": 80.0,
    "roller_diameter": 12.0,
    "speed_rpm": 60.0,
    "load_inertia": 0.02,
    "load_torque": 1.0,
}
LARGER_CRANK: dict[str, Any] = {
    "crank_radius": 41.0,
    "rollers": 1,
    "wall_thickness": 2.0,
    "clearances": {"slot": 1.0},
}
RATCHET: dict[str, Any] = {
    "drive": "ratchet",
    "stations": 36,
    "center_distance": None,
    "roller_diameter": None,
    "speed_rpm": None,
    "load_inertia": 0.0,
    "wall_thickness": 6.0,
}
INDEXING_ROWS: dict[str, Any] = {
    "length_unit": Row("in", {"units": "consistent"}, file="dxf"),
    "max_designs": 1,
    "include_failed": Row(True, {"constraints": {"pin_force": 1.0}}),
    "seed": 7,
    "units": "consistent",
    "drive": "geneva_internal",
    "driver": "drag_link",
    "stations": 5,
    "rollers": 1,
    "center_distance": 90.0,
    "sphere_radius": Row(50.0, {"drive": "geneva_spherical", "center_distance": None}),
    "crank_radius": Row(41.0, LARGER_CRANK | {"constraints": {"shock_free": False}, "crank_radius": 40.5}),
    "roller_diameter": 11.0,
    "wall_thickness": 5.0,
    "wheel_shaft_diameter": 20.0,
    "crank_shaft_diameter": 5.0,
    "clearances": {"slot": 0.1},
    "clearances.slot": 0.1,
    "clearances.locking": 0.1,
    "clearances.slot_end": 1.0,
    "clearances.relief": 1.0,
    "speed_rpm": 70.0,
    "load_inertia": 0.03,
    "load_torque": 2.0,
    "pawls": Row({"friction": 0.25}, RATCHET),
    "pawls.count": Row(2, RATCHET),
    "pawls.overlap": Row(2, RATCHET),
    "pawls.wheel_radius": Row(60.0, RATCHET),
    "pawls.tooth_height": Row(5.0, RATCHET),
    "pawls.length": Row(50.0, RATCHET),
    "pawls.friction": Row(0.25, RATCHET),
    "pawls.face_angle": Row(20.0, RATCHET),
    "pawls.reserve": Row(3.0, RATCHET),
    "constraints": {"size": 200.0},
    "constraints.dwell_share": {"min": 0.5},
    "constraints.dwell_share.min": Row(0.5, {"constraints": {"dwell_share": {"min": 0.1}}}),
    "constraints.dwell_share.max": Row(0.5, {"constraints": {"dwell_share": {"max": 0.9}}}),
    "constraints.peak_acceleration": 1.3,
    "constraints.drive_torque": 1.0,
    "constraints.pin_force": 20.0,
    "constraints.size": 150.0,
    "constraints.steady_share": 0.15,
    "constraints.min_transmission_angle": Row(42.0, {"driver": "drag_link"}),
    "constraints.shock_free": Row(False, LARGER_CRANK),
}
