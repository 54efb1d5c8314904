"""Rows of cams."""

from __future__ import annotations

from typing import Any

from tests.service.stated.row import Row

CAM: dict[str, Any] = {
    "kind": "cam",
    "segments": [
        {"motion": "dwell", "angle": 90.0},
        {"motion": "rise", "angle": 90.0, "lift": 25.0, "law": "modified_sine"},
        {"motion": "dwell", "angle": 90.0},
        {"motion": "return", "angle": 90.0, "law": "cycloidal"},
    ],
    "follower": {"type": "translating_roller", "roller_radius": 10.0},
    "profile_points": 360,
}
RFD = [
    {"motion": "rise", "angle": 90.0, "lift": 10.0, "law": "optimal"},
    {"motion": "fall", "angle": 90.0, "lift": 10.0, "law": "cycloidal"},
    {"motion": "dwell", "angle": 180.0},
]
"""One optimal move."""
INNER = {
    "segments": [{**RFD[0], "conditions": [{"angle": 45.0, "s": 5.0, "v": 13.0, "a": 0.0, "j": -60.0}]}, *RFD[1:]],
    "continuity": "jerk",
}
BAND = {"segments": [{**RFD[0], "bands": [{"start": 40.0, "end": 50.0, "lower": 4.9, "upper": 6.0}]}, *RFD[1:]]}
CONSTANT = {
    "segments": [
        {"motion": "constant_velocity", "angle": 180.0, "lift": 5.0},
        {"motion": "return", "angle": 180.0, "law": "auto"},
    ]
}
ENDS = [
    {"angle": 0.0, "s": 0.0, "v": 0.0, "a": 0.0, "j": 0.0},
    {"angle": 90.0, "s": 10.0, "v": 0.0, "a": 0.0, "j": 0.0},
]
POLYNOMIAL = {
    "segments": [
        {"motion": "dwell", "angle": 90.0},
        {"motion": "polynomial", "angle": 90.0, "conditions": [{"angle": 40.0, "s": 4.0}, *ENDS]},
        {"motion": "dwell", "angle": 90.0},
        {"motion": "return", "angle": 90.0, "law": "cycloidal"},
    ]
}
WITH_MORE = {
    "segments": [
        {"motion": "dwell", "angle": 90.0},
        {
            "motion": "polynomial",
            "angle": 90.0,
            "conditions": [*ENDS, {"angle": 40.0, "s": 4.0, "v": 8.0, "a": 1.0, "j": -10.0}],
        },
        {"motion": "dwell", "angle": 90.0},
        {"motion": "return", "angle": 90.0, "law": "cycloidal"},
    ]
}
ARM = {
    "follower": {"type": "oscillating_roller", "roller_radius": 5.0, "arm": 80.0, "pivot_distance": 100.0},
    "segments[1].lift": 10.0,
}
FLAT = {"follower": {"type": "translating_flat"}}
FLAT_ARM = {"follower": {"type": "oscillating_flat", "pivot_distance": 200.0}, "segments[1].lift": 10.0}
BARREL = {"follower": {"type": "barrel_roller", "roller_radius": 8.0}}
LOADED = {"dynamics": {"mass": 0.5, "spring_rate": 20.0, "preload": 100.0}, "speed_rpm": 200.0}
SPRUNG = {"dynamics": {"mass": 0.5, "spring_rate": {"min": 2.0, "max": 4.0}}, "speed_rpm": 600.0}
AUTO = {"segments[1].law": "auto"}
WHERE = "segments[1]"

CAM_ROWS: dict[str, Any] = {
    "length_unit": Row("in", file="csv"),
    "seed": 7,
    "include_failed": Row(True, {"limits.size": 12.0}),
    "segments": RFD,
    "segments[]<Dwell>.motion": "rise",
    "segments[]<Dwell>.angle": Row(80.0, {"segments[2].angle": 100.0}),
    "segments[]<Move>.motion": Row("fall", {"segments": RFD, "segments[0].law": "cycloidal"}, at="segments[0].motion"),
    "segments[]<Move>.angle": Row(100.0, {"segments[2].angle": 80.0}, at=f"{WHERE}.angle"),
    "segments[]<Move>.lift": Row(20.0, at=f"{WHERE}.lift"),
    "segments[]<Move>.law": Row("polynomial_345", at=f"{WHERE}.law"),
    "segments[]<Move>.conditions": Row([{"angle": 45.0, "s": 4.0}], {"segments": RFD}),
    "segments[]<Move>.conditions[].angle": Row(44.0, INNER),
    "segments[]<Move>.conditions[].s": Row(5.1, INNER),
    "segments[]<Move>.conditions[].v": Row(12.5, INNER),
    "segments[]<Move>.conditions[].a": Row(1.0, INNER),
    "segments[]<Move>.conditions[].j": Row(-50.0, INNER),
    "segments[]<Move>.bands": Row([{"start": 40.0, "end": 50.0, "lower": 5.5}], {"segments": RFD}),
    "segments[]<Move>.bands[].start": Row(30.0, BAND),
    "segments[]<Move>.bands[].end": Row(60.0, BAND),
    "segments[]<Move>.bands[].lower": Row(5.2, BAND),
    "segments[]<Move>.bands[].upper": Row(5.2, BAND),
    "segments[]<ConstantVelocity>.motion": Row("dwell", CONSTANT),
    "segments[]<ConstantVelocity>.angle": Row(170.0, {**CONSTANT, "segments[1].angle": 190.0}),
    "segments[]<ConstantVelocity>.lift": Row(4.0, CONSTANT),
    "segments[]<Polynomial>.motion": Row("dwell", POLYNOMIAL, at=f"{WHERE}.motion"),
    "segments[]<Polynomial>.angle": Row(
        91.0,
        {**POLYNOMIAL, "segments[1].conditions[2].angle": 91.0, "segments[2].angle": 89.0},
        at=f"{WHERE}.angle",
    ),
    "segments[]<Polynomial>.conditions": Row(ENDS, POLYNOMIAL, at=f"{WHERE}.conditions"),
    "segments[]<Polynomial>.conditions[].angle": Row(41.0, WITH_MORE, at=f"{WHERE}.conditions[2].angle"),
    "segments[]<Polynomial>.conditions[].s": Row(4.1, WITH_MORE, at=f"{WHERE}.conditions[2].s"),
    "segments[]<Polynomial>.conditions[].v": Row(8.1, WITH_MORE, at=f"{WHERE}.conditions[2].v"),
    "segments[]<Polynomial>.conditions[].a": Row(1.1, WITH_MORE, at=f"{WHERE}.conditions[2].a"),
    "segments[]<Polynomial>.conditions[].j": Row(-11.0, WITH_MORE, at=f"{WHERE}.conditions[2].j"),
    "follower": FLAT["follower"],
    "follower<TranslatingRoller>.type": Row("barrel_roller"),
    "follower<TranslatingRoller>.roller_radius": 9.0,
    "follower<TranslatingRoller>.roller_radius.min": Row(9.0, {"follower.roller_radius": {"min": 5.0, "max": 8.0}}),
    "follower<TranslatingRoller>.roller_radius.max": Row(7.0, {"follower.roller_radius": {"min": 5.0, "max": 8.0}}),
    "follower<TranslatingRoller>.offset": 3.0,
    "follower<TranslatingRoller>.prime_radius": 60.0,
    "follower<TranslatingRoller>.overhang": Row(70.0, {**LOADED, "follower.overhang": 60.0}),
    "follower<OscillatingRoller>.type": Row("translating_roller", ARM),
    "follower<OscillatingRoller>.roller_radius": Row(6.0, ARM),
    "follower<OscillatingRoller>.roller_radius.min": Row(
        9.0, {**ARM, "follower.roller_radius": {"min": 5.0, "max": 8.0}}
    ),
    "follower<OscillatingRoller>.roller_radius.max": Row(
        7.0, {**ARM, "follower.roller_radius": {"min": 5.0, "max": 8.0}}
    ),
    "follower<OscillatingRoller>.arm": Row(85.0, ARM),
    "follower<OscillatingRoller>.pivot_distance": Row(105.0, ARM),
    "follower<OscillatingRoller>.pivot_distance.min": Row(
        104.0, {**ARM, "follower.pivot_distance": {"min": 100.0, "max": 105.0}}
    ),
    "follower<OscillatingRoller>.pivot_distance.max": Row(
        85.5, {**ARM, "follower.pivot_distance": {"min": 85.0, "max": 90.0}}
    ),
    "follower<OscillatingRoller>.sense": Row(-1, ARM),
    "follower<OscillatingRoller>.prime_radius": Row(70.0, ARM),
    "follower<TranslatingFlat>.type": Row("translating_roller", FLAT),
    "follower<TranslatingFlat>.base_radius": Row(90.0, FLAT),
    "follower<TranslatingFlat>.offset": Row(3.0, FLAT),
    "follower<OscillatingFlat>.type": Row("translating_flat", FLAT_ARM),
    "follower<OscillatingFlat>.pivot_distance": Row(210.0, FLAT_ARM),
    "follower<OscillatingFlat>.face_offset": Row(5.0, FLAT_ARM),
    "follower<OscillatingFlat>.sense": Row(-1, FLAT_ARM),
    "follower<OscillatingFlat>.base_radius": Row(100.0, FLAT_ARM),
    "follower<BarrelRoller>.type": Row("translating_roller", BARREL),
    "follower<BarrelRoller>.roller_radius": Row(7.0, BARREL),
    "follower<BarrelRoller>.cylinder_radius": Row(70.0, BARREL),
    "limits": {"pressure_angle": 25.0},
    "limits.pressure_angle": 25.0,
    "limits.pressure_angle_fall": 25.0,
    "limits.curvature_ratio": 3.0,
    "limits.min_radius": Row(5.0, FLAT),
    "limits.face_width": Row(100.0, FLAT),
    "limits.hub_radius": 20.0,
    "limits.size": 60.0,
    "limits.overturning_moment": Row(1500.0, {**LOADED, "follower.overhang": 60.0}),
    "limits.velocity": Row(100.0, AUTO),
    "limits.acceleration": Row(200.0, AUTO),
    "limits.jerk": Row(2000.0, AUTO),
    "speed_rpm": Row(210.0, LOADED),
    "rotation": "cw",
    "minimize": Row("peak_velocity", AUTO),
    "closure": "form",
    "dynamics": Row({"mass": 0.6, "spring_rate": 20.0, "preload": 100.0}, LOADED),
    "dynamics.mass": Row(0.6, LOADED),
    "dynamics.spring_rate": Row(25.0, LOADED),
    "dynamics.spring_rate.min": Row(10.0, {**SPRUNG, "dynamics.spring_rate": {"min": 2.0, "max": 14.0}}),
    "dynamics.spring_rate.max": Row(3.5, SPRUNG),
    "dynamics.train_stiffness": Row(4000.0, LOADED),
    "dynamics.train_damping_ratio": Row(0.1, {**LOADED, "dynamics.train_stiffness": 4000.0}),
    "dynamics.max_rpm": Row(800.0, SPRUNG),
    "dynamics.min_frequency_ratio": Row(3.0, {**SPRUNG, "dynamics.spring_rate": "free"}),
    "dynamics.damping_ratio": Row(0.2, LOADED),
    "dynamics.damping": Row(0.5, LOADED),
    "dynamics.preload": Row(120.0, LOADED),
    "dynamics.least_force": Row(5.0, {"dynamics": {"mass": 0.5, "spring_rate": 20.0}, "speed_rpm": 200.0}),
    "continuity": Row("jerk", {"segments": RFD}),
    "accept_discontinuity": Row(True, {"segments[1].law": "simple_harmonic"}),
    "profile_points": 400,
}
