"""Flywheels: of every field a value with which the answer is another one."""

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
