"""Rows of balancing."""

from __future__ import annotations

from typing import Any

from tests.service.stated.row import Row

ROTOR: dict[str, Any] = {
    "kind": "balancing",
    "object": "rotor",
    "masses": [
        {"mass": 1.2, "radius": 40.0, "angle": 113.0, "z": 20.0},
        {"mass": 1.8, "radius": 30.0, "angle": 48.0, "z": 70.0},
    ],
    "planes": [0.0, 100.0],
    "rpm": 600.0,
    "rotor_mass": 50.0,
    "correction": {"radius": 50.0},
}
READINGS: dict[str, Any] = {
    "masses": [],
    "bearing_readings": [{"force": 5.0, "angle": 45.0, "z": 0.0}, {"force": 2.0, "angle": 240.0, "z": 80.0}],
}
RUNS: dict[str, Any] = {
    "masses": [],
    "planes": [0.0],
    "influence": {
        "initial": [{"amplitude": 8.5, "angle": 60.0}],
        "trials": [
            {"mass": 0.01, "radius": 125.0, "angle": 270.0, "readings": [{"amplitude": 6.0, "angle": 125.0}]},
        ],
    },
}
HOLES: dict[str, Any] = {
    "correction": {"holes": {"angles": 8, "radius": 50.0, "step": 0.05, "max_per_hole": 1.0}},
    "planes": [0.0],
}
STOCK: dict[str, Any] = {
    "correction": {"stock": {"angles": 8, "radius": 50.0, "masses": [0.3, 0.7]}},
    "planes": [0.0],
}

LINKAGE: dict[str, Any] = {
    "object": "linkage",
    "masses": [],
    "planes": [0.0],
    "rpm": None,
    "rotor_mass": None,
    "correction": None,
    "mechanism": {
        "type": "fourbar",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [280.0, 0.0]},
        "links": {"input": 100.0, "coupler": 300.0, "output": 200.0},
    },
    "motion": {"speed_rpm": 60.0},
    "dynamics": {
        "bodies": {
            "input": {"mass": 0.5, "cg": {"distance": 50.0}, "inertia": 0.0006},
            "coupler": {"mass": 1.2, "cg": {"distance": 140.0}, "inertia": 0.012},
            "output": {"mass": 0.9, "cg": {"distance": 90.0}, "inertia": 0.004},
        }
    },
}
DISCS = {**LINKAGE, "counterweights": {"density": 7800.0, "thickness": 20.0}}

LEAST = {
    **LINKAGE,
    "goal": "minimize",
    "objective": {"shaking_force": 1.0, "shaking_moment": 0.5, "joint_forces": {"A": 0.2}},
    "counterweights": {"total_mass": 2.0, "reach": 150.0, "density": 7800.0, "thickness": 20.0},
}

ROTOR_ROWS: dict[str, Any] = {
    "objective": Row({"shaking_force": 1.0}, LEAST),
    "objective.shaking_force": Row(0.5, LEAST),
    "objective.shaking_moment": Row(1.0, LEAST),
    "objective.drive": Row(1.0, LEAST),
    "objective.joint_forces": Row({"B": 0.2}, LEAST),
    "objective.norm": Row("rms", LEAST),
    "caps": Row({"drive": 0.95}, LEAST),
    "caps.shaking_force": Row(0.3, LEAST),
    "caps.shaking_moment": Row(0.8, LEAST),
    "caps.drive": Row(0.95, LEAST),
    "caps.joint_forces": Row({"A": 0.9}, LEAST),
    "counterweights.reach": Row(100.0, LEAST),
    "counterweights.max_mass": Row(0.3, LEAST),
    "counterweights.total_mass": Row(1.0, LEAST),
    "counterweights.max_gyration": Row(160.0, LEAST),
    "counterweights.max_disc_radius": Row(20.0, LEAST),
    "goal": Row("force_and_moment", LINKAGE),
    "mechanism": Row({**LINKAGE["mechanism"], "assembly": "crossed"}, LINKAGE),
    "motion": Row({"speed_rpm": 70.0}, LINKAGE),
    "motion.speed": Row(2.0, {**LINKAGE, "motion": {}}),
    "motion.speed_rpm": Row(70.0, LINKAGE),
    "motion.acceleration": Row(5.0, LINKAGE),
    "motion.from": Row(120.0, LINKAGE),
    "motion.to": Row(90.0, LINKAGE),
    "motion.steps": Row(5000, LINKAGE),
    "dynamics": Row({"bodies": {"coupler": {"mass": 1.0, "cg": {"distance": 140.0}, "inertia": 0.01}}}, LINKAGE),
    "counterweights": Row({"radius": 50.0}, LINKAGE),
    "counterweights.links": Row(["input", "coupler", "output"], {**LINKAGE, "counterweights": {"mass": 1.0}}),
    "counterweights.radius": Row(50.0, LINKAGE),
    "counterweights.mass": Row(1.0, LINKAGE),
    "counterweights.density": Row(2700.0, DISCS),
    "counterweights.thickness": Row(30.0, DISCS),
    "length_unit": "in",
    "units": "consistent",
    "object": Row("linkage", {**LINKAGE, "object": "rotor"}),
    "seed": 7,
    "max_designs": Row(1, HOLES),
    "include_failed": Row(True, {**HOLES, "max_grade": 10.0, "bearings": [0.0, 100.0]}),
    "masses": [{"mass": 1.3, "radius": 40.0, "angle": 113.0, "z": 20.0}],
    "masses[].mass": 1.3,
    "masses[].radius": 41.0,
    "masses[].angle": 114.0,
    "masses[].z": 21.0,
    "bearing_readings": Row([{"force": 5.0, "angle": 45.0, "z": 0.0}], READINGS),
    "bearing_readings[].force": Row(6.0, READINGS),
    "bearing_readings[].angle": Row(46.0, READINGS),
    "bearing_readings[].z": Row(1.0, READINGS),
    "influence": Row({**RUNS["influence"], "initial": [{"amplitude": 9.0, "angle": 60.0}]}, RUNS),
    "influence.initial": Row([{"amplitude": 9.0, "angle": 60.0}], RUNS),
    "influence.initial[].amplitude": Row(9.0, RUNS),
    "influence.initial[].angle": Row(61.0, RUNS),
    "influence.trials": Row([{**RUNS["influence"]["trials"][0], "mass": 0.02}], RUNS),
    "influence.trials[].mass": Row(0.02, RUNS),
    "influence.trials[].radius": Row(100.0, RUNS),
    "influence.trials[].angle": Row(271.0, RUNS),
    "influence.trials[].readings": Row([{"amplitude": 6.1, "angle": 125.0}], RUNS),
    "influence.trials[].readings[].amplitude": Row(6.1, RUNS),
    "influence.trials[].readings[].angle": Row(126.0, RUNS),
    "rpm": 700.0,
    "planes": [0.0, 90.0],
    "bearings": [-10.0, 110.0],
    "rotor_mass": 60.0,
    "max_grade": 6.3,
    "correction": {"mass": 0.5},
    "correction.radius": 60.0,
    "correction.mass": Row(0.6, {"correction": {"mass": 0.5}}),
    "correction.removed": True,
    "correction.holes": Row({"angles": 7, "radius": 50.0, "step": 0.05, "max_per_hole": 1.0}, HOLES),
    "correction.holes.angles": Row(7, HOLES),
    "correction.holes.radius": Row(60.0, HOLES),
    "correction.holes.max_places": Row(1, HOLES),
    "correction.holes.step": Row(0.1, HOLES),
    "correction.holes.max_per_hole": Row(0.4, HOLES),
    "correction.stock": Row({"angles": 8, "radius": 50.0, "masses": [0.3]}, STOCK),
    "correction.stock.angles": Row(7, STOCK),
    "correction.stock.radius": Row(60.0, STOCK),
    "correction.stock.max_places": Row(1, STOCK),
    "correction.stock.masses": Row([0.3, 0.6], STOCK),
    "rank_by": Row("places", HOLES),
}
