"""Rows of gear trains and gearboxes."""

from __future__ import annotations

from typing import Any

from synthesis.kinds.train_series.units import POWER_FIELDS, SERIES_FIELDS
from tests.service.stated.row import Row

TRAIN: dict[str, Any] = {
    "kind": "gear_train",
    "ratio": "127/50",
    "max_stages": 2,
    "teeth": {"min": 15, "max": 40},
    "max_designs": 3,
}
PLACES = {
    "ratio": "6",
    "teeth": [{"min": 15, "max": 20}, {"min": 30, "max": 60}, {"min": 15, "max": 20}, {"min": 30, "max": 60}],
}
DISTANCE = {"centre_distance": 45.0, "modules": [1.0, 1.5]}
CARRY: dict[str, Any] = {
    "module": 2.0,
    "strength": {
        "power_kw": 0.5,
        "speed_rpm": 1000.0,
        "allowable_bending": [200.0, 180.0],
        "allowable_contact": [800.0, 750.0],
    },
}
FACTORS: dict[str, Any] = {
    "form": [0.3, 0.4],
    "overload": 1.25,
    "dynamic": 1.3,
    "size": [1.2, 1.1],
    "load_distribution": 1.5,
    "rim": 1.2,
    "bending_geometry": [0.3, 0.4],
    "contact_geometry": 0.1,
    "elastic": 160.0,
}
STAGES: dict[str, Any] = {
    "max_stages": None,
    "ratio": "10",
    "stages": [
        {"type": "external"},
        {"type": "helical", "helix_angle": 15.0, "face_width": 20.0, "driver": 18, "driven": 30},
        {"type": "internal", "ring": "driven", "driver": {"min": 15, "max": 25}, "driven": {"min": 30, "max": 60}},
    ],
}
CROSSING: dict[str, Any] = {
    "max_stages": None,
    "ratio": "30",
    "stages": [
        {"type": "worm", "driver": 2, "driven": 40, "hand": "right", "friction": 0.05, "diameter_quotient": 10.0},
        {"type": "bevel", "shaft_angle": 80.0, "driver": 20, "driven": {"min": 20, "max": 40}},
    ],
}
OF_CROSSING = ("shaft_angle", "diameter_quotient", "hand", "friction")
"""Fields of stages that a unit of a series cannot have: there they are refused."""

STOCK = {"teeth": None, "stock": [{"teeth": 20, "count": 1}, 20, 25, 30, 50, 51, 60]}

TRAIN_ROWS: dict[str, Any] = {
    "length_unit": Row("in", file="csv"),
    "seed": 7,
    "max_designs": 2,
    "ratio": "128/50",
    "direction": "opposite",
    "max_stages": 1,
    "stages": Row([{"type": "external"}, {"type": "internal"}], {"max_stages": None}),
    "stages[].type": Row("internal", STAGES),
    "stages[].helix_angle": Row(-15.0, STAGES, at="stages[1].helix_angle"),
    "stages[].face_width": Row(25.0, STAGES, at="stages[1].face_width"),
    "stages[].ring": Row(
        "driver", {"stages": [{"type": "internal", "ring": "driven"}], "max_stages": None, "ratio": "127/50"}
    ),
    "stages[].shaft_angle": Row(70.0, CROSSING, at="stages[1].shaft_angle"),
    "stages[].diameter_quotient": Row(12.0, CROSSING),
    "stages[].hand": Row("left", CROSSING),
    "stages[].friction": Row(0.2, CROSSING),
    "stages[].driver": Row(20, STAGES),
    "stages[].driver.min": Row(24, STAGES, at="stages[2].driver.min"),
    "stages[].driver.max": Row(15, STAGES, at="stages[2].driver.max"),
    "stages[].driven": Row(30, STAGES),
    "stages[].driven.min": Row(60, STAGES, at="stages[2].driven.min"),
    "stages[].driven.max": Row(35, STAGES, at="stages[2].driven.max"),
    "teeth": {"min": 15, "max": 39},
    "teeth.min": 20,
    "teeth.max": 30,
    "teeth[].min": Row(18, PLACES),
    "teeth[].max": Row(31, PLACES, at="teeth[1].max"),
    "stock": Row([20, 25, 30, 50, 52], STOCK),
    "stock[].teeth": Row(21, STOCK),
    "stock[].count": Row(2, {**STOCK, "stock": [{"teeth": 20, "count": 1}, 30, 50, 60], "ratio": "7.5"}),
    "max_stage_ratio": 1.6,
    "max_total_teeth": 100,
    "hunting_tooth": "require",
    "reverted": True,
    "module": 2.0,
    "diametral_pitch": 2.0,
    "modules": Row([1.25, 2.0], DISTANCE),
    "centre_distance": Row(46.0, DISTANCE),
    "centre_distance.min": Row(44.9, {"modules": [1.0, 1.5], "centre_distance": {"min": 40.0, "max": 45.0}}),
    "centre_distance.max": Row(41.0, {"modules": [1.0, 1.5], "centre_distance": {"min": 40.0, "max": 45.0}}),
    "shift": Row({"min": -0.1, "max": 0.1}, DISTANCE),
    "shift.min": Row(0.35, {**DISTANCE, "shift": {"min": -0.5, "max": 1.0}}),
    "shift.max": Row(0.1, {**DISTANCE, "shift": {"min": -0.5, "max": 1.0}}),
    "min_contact_ratio": Row(1.6, DISTANCE),
    "min_tip_thickness": Row(0.7, DISTANCE),
    "strength": Row({**CARRY["strength"], "power_kw": 50.0}, CARRY),
    "strength.method": Row("lewis", {"module": 2.0, "strength": {**CARRY["strength"], "allowable_contact": None}}),
    "strength.quality": Row(9.0, CARRY),
    "strength.factors": Row({"overload": 1.5}, CARRY),
    **{f"strength.factors.{name}": Row(value, CARRY) for name, value in FACTORS.items()},
    "strength.allowable_bending": Row([60.0, 60.0], CARRY),
    "strength.allowable_contact": Row([700.0, 700.0], CARRY),
    "strength.max_face_width": Row(2.0, CARRY),
    "strength.power_kw": Row(0.6, CARRY),
    "strength.speed_rpm": Row(900.0, CARRY),
    "pressure_angle": 25.0,
    "interference": Row("refuse", {"teeth": {"min": 10, "max": 40}}),
    "tolerance": 1e-9,
    "rank_by": "size",
    "size": Row("largest_gear", {"rank_by": "size"}),
}

PLANETARY: dict[str, Any] = {
    "kind": "planetary_train",
    "ratio": 5.5,
    "arrangement": "simple",
    "input": "sun",
    "output": "carrier",
    "fixed": "ring",
    "teeth": {"min": 17, "max": 60, "ring_max": 130},
    "max_designs": 3,
}
PLANETS_CARRY: dict[str, Any] = {
    "module": 2.0,
    "strength": {**CARRY["strength"], "power_kw": 5.0, "allowable_bending": [200.0, 190.0]},
}
PLANETARY_ROWS: dict[str, Any] = {
    "length_unit": Row("in", file="csv"),
    "seed": 7,
    "max_designs": 2,
    "ratio": 5.0,
    "arrangement": Row(
        "double_planet",
        {"ratio": 4.0, "teeth": {"min": 17, "max": 30, "ring_max": 90}, "input": None, "output": None, "fixed": None},
    ),
    "planets": 4,
    "spacing": Row("nearest", {"planets": 5}),
    "input": Row("carrier", {"ratio": 1.5, "input": None, "output": None, "fixed": None}),
    "output": Row("carrier", {"ratio": 1.5, "input": None, "output": None, "fixed": None}),
    "fixed": Row("sun", {"ratio": 1.5, "input": None, "output": None, "fixed": None}),
    "teeth": {"min": 18, "max": 60, "ring_max": 130},
    "teeth.min": 22,
    "teeth.max": 40,
    "teeth.ring_max": 100,
    "teeth.gears": {"sun": {"min": 25, "max": 30}},
    "teeth.gears{}.min": Row(26, {"teeth.gears": {"sun": {"min": 20, "max": 30}}}),
    "teeth.gears{}.max": Row(21, {"teeth.gears": {"sun": {"min": 20, "max": 30}}}),
    "module": 2.0,
    "modules": Row([2.0, 3.0], {**PLANETS_CARRY, "module": 1.0, "modules": [2.5, 3.0]}),
    "strength": Row({**PLANETS_CARRY["strength"], "power_kw": 50.0}, PLANETS_CARRY),
    "strength.method": Row(
        "lewis", {"module": 2.0, "strength": {**PLANETS_CARRY["strength"], "allowable_contact": None}}
    ),
    "strength.quality": Row(9.0, PLANETS_CARRY),
    "strength.factors": Row({"overload": 1.5}, PLANETS_CARRY),
    **{f"strength.factors.{name}": Row(value, PLANETS_CARRY) for name, value in FACTORS.items()},
    "strength.allowable_bending": Row([60.0, 60.0], PLANETS_CARRY),
    "strength.allowable_contact": Row([700.0, 700.0], PLANETS_CARRY),
    "strength.max_face_width": Row(2.0, PLANETS_CARRY),
    "strength.power_kw": Row(5.5, PLANETS_CARRY),
    "strength.speed_rpm": Row(900.0, PLANETS_CARRY),
    "strength.load_sharing": Row(1.1, PLANETS_CARRY),
    "pressure_angle": 25.0,
    "tolerance": 0.5,
    "max_size": 1e6,
    "max_ring_diameter": 1e6,
    "min_efficiency": 0.1,
    "min_clearance": 8.0,
    "min_contact_ratio": 1.1,
    "fillets": "refuse",
    "mesh_efficiency": 0.97,
    "rank_by": Row("size", {"tolerance": 0.1}),
}

UNIT_KINDS = {"PlanetaryUnit": "planetary_train", "GearTrainUnit": "gear_train"}
UNITS: dict[str, tuple[int, dict[str, Any]]] = {"PlanetaryUnit": (0, PLANETARY_ROWS), "GearTrainUnit": (1, TRAIN_ROWS)}


def unit_rows(model: str) -> dict[str, Any]:
    """The rows of a unit's fields: those of its kind, each stated in its unit of the series."""
    place, rows = UNITS[model]
    found: dict[str, Any] = {f"units[]<{model}>.type": Row("wheel", at=f"units[{place}].type")}
    for name, stated in rows.items():
        if name.split(".")[0] not in SERIES_FIELDS | POWER_FIELDS.get(UNIT_KINDS[model], set()):
            row = stated if isinstance(stated, Row) else Row(stated)
            if name.removeprefix("stages[].") in OF_CROSSING:
                row = Row(row.value, {"max_stages": None, "stages": [{"type": "external"}]})
            base = {f"units[{place}].{field}": value for field, value in row.base.items() if field not in SERIES_FIELDS}
            found[f"units[]<{model}>.{name}"] = Row(row.value, base, at=f"units[{place}].{row.at or name}")
    return found


SERIES_OF_TRAINS: dict[str, Any] = {
    "kind": "train_series",
    "ratio": 12.0,
    "units": [
        {"type": "planetary_train"} | {k: v for k, v in PLANETARY.items() if k not in ("kind", "ratio", "max_designs")},
        {"type": "gear_train", "max_stages": 2, "teeth": {"min": 15, "max": 40}},
    ],
    "max_designs": 3,
}
SERIES_ROWS: dict[str, Any] = {
    "length_unit": Row("in", file="csv"),
    "seed": 7,
    "max_designs": 2,
    "ratio": 13.0,
    "units": Row([SERIES_OF_TRAINS["units"][0]] * 2),
    "tolerance": 0.5,
    "rank_by": Row("size", {"tolerance": 0.1}),
    **unit_rows("PlanetaryUnit"),
    **unit_rows("GearTrainUnit"),
}

GEARBOX: dict[str, Any] = {
    "kind": "gearbox",
    "input_speed": 200.0,
    "speeds": {"min": 100.0, "max": 400.0, "count": 4},
    "stage_ratio": {"min": 0.25, "max": 2.0},
    "tooth_sum": {"min": 60, "max": 80},
    "max_designs": 2,
}
SERIES = {"speeds": {"min": 100.0, "count": 3, "series": "R10", "step": 2}}
GEARBOX_ROWS: dict[str, Any] = {
    "length_unit": Row("in", file="dxf"),
    "seed": 7,
    "max_designs": 1,
    "input_speed": 210.0,
    "speeds": {"min": 100.0, "max": 390.0, "count": 4},
    "speeds.min": 101.0,
    "speeds.count": 3,
    "speeds.max": 390.0,
    "speeds.ratio": Row(1.5, {"speeds": {"min": 100.0, "count": 4, "ratio": 1.4}}),
    "speeds.series": Row("R20", SERIES),
    "speeds.step": Row(1, SERIES),
    "structure": [4],
    "max_pairs": Row(2, {"speeds": {"min": 100.0, "max": 200.0, "count": 3}}),
    "fixed_stage": True,
    "teeth": {"min": 20, "max": 60},
    "teeth.min": Row(24, {"teeth": {"min": 18, "max": 60}}),
    "teeth.max": Row(45, {"teeth": {"min": 18, "max": 60}}),
    "tooth_sum": {"min": 60, "max": 70},
    "tooth_sum.min": 70,
    "tooth_sum.max": 70,
    "stage_ratio": {"min": 0.3, "max": 1.5},
    "stage_ratio.min": 0.6,
    "stage_ratio.max": 1.1,
    "cluster_difference": Row(6, {"speeds": {"min": 100.0, "max": 200.0, "count": 3}, "structure": [3]}),
    "tolerance": 0.1,
    "module": 2.0,
    "pressure_angle": 25.0,
    "rank_by": "size",
}

LAYSHAFT: dict[str, Any] = {
    "kind": "layshaft_gearbox",
    "ratios": [3.5, 2.1, 1.4, 1.0],
    "teeth": {"min": 14, "max": 60},
    "tooth_sum": {"min": 50, "max": 70},
    "interference": "report",
    "max_designs": 2,
}
LAYSHAFT_ROWS: dict[str, Any] = {
    "length_unit": Row("in", file="dxf"),
    "seed": 7,
    "max_designs": 1,
    "ratios": [3.4, 2.1, 1.4, 1.0],
    "reverse": 3.3,
    "direct": False,
    "teeth": {"min": 16, "max": 60},
    "teeth.min": 17,
    "teeth.max": 40,
    "tooth_sum": {"min": 50, "max": 60},
    "tooth_sum.min": 66,
    "tooth_sum.max": 55,
    "interference": "refuse",
    "tolerance": 0.5,
    "module": 2.0,
    "pressure_angle": 25.0,
    "rank_by": Row("size", {"tolerance": 0.1}),
}
