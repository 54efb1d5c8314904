"""Rows of spring balancing."""

from __future__ import annotations

from typing import Any

from synthesis.registry import list_examples
from tests.service.stated.row import Row

SPRINGS: dict[str, Any] = list_examples("spring_balancing")[1]
LEVER, _, BOTH, SOUGHT = list_examples("spring_balancing")
PUSHED = {
    **{name: LEVER[name] for name in ("mechanism", "dynamics")},
    "motion": {"from": -20.0, "to": 60.0},
    "springs": [
        {
            "ends": [{"link": "ground", "point": [0.0, -150.0]}, {"link": "lever", "point": [150.0, 0.0]}],
            "min_free_length": 50.0,
            "max_free_length": 500.0,
            "form": "compression",
        }
    ],
}
FORMLESS = {**PUSHED, "springs": [{**PUSHED["springs"][0], "form": None}]}
ENDS = SPRINGS["springs"][0]["ends"]
WOUND = {"springs": [{"links": ["ground", "output"], "torsion": 3.0, "free_angle": 50.0}]}
TURNING = {"springs": [{"links": ["ground", "output"]}]}
HELD = {"springs": [{"ends": ENDS, "rate": 200.0, "free_length": 80.0, "preload": 4.0}]}
OPEN = {"mechanism": BOTH["mechanism"], "springs": BOTH["springs"]}

SPRINGS_ROWS: dict[str, Any] = {
    "length_unit": "cm",
    "max_designs": Row(1, {**SOUGHT, "max_designs": 10}),
    "seed": 7,
    "mechanism": {**SPRINGS["mechanism"], "assembly": "crossed"},
    "motion": {"from": 40.0, "to": 100.0},
    "motion.speed": 5.0,
    "motion.speed_rpm": 50.0,
    "motion.acceleration": 5.0,
    "motion.from": 45.0,
    "motion.to": 100.0,
    "motion.steps": 5000,
    "dynamics": {"gravity": {}, "bodies": {"coupler": {"mass": 3.0, "cg": {"distance": 100.0}}}},
    "norm": "rms",
    "springs": [{"links": ["ground", "output"], "max_torsion": 40.0}],
    "springs[].ends": [ENDS[0], {"link": "coupler", "point": {"distance": 20.0}}],
    "springs[].ends[].link": Row("output", at="springs[0].ends[1].link"),
    "springs[].ends[].point": [-80.0, 250.0],
    "springs[].ends[].point.distance": Row(130.0, at="springs[0].ends[1].point.distance"),
    "springs[].ends[].point.angle": Row(10.0, at="springs[0].ends[1].point.angle"),
    "springs[].ends[].within[].distance": Row(70.0, SOUGHT, at="springs[0].ends[1].within[0].distance"),
    "springs[].ends[].within[].angle": Row(15.0, SOUGHT, at="springs[0].ends[1].within[0].angle"),
    "springs[].ends[].within": Row([[-150.0, 0.0], [-60.0, 0.0]], OPEN),
    "springs[].rate": Row(300.0, HELD),
    "springs[].min_rate": 200.0,
    "springs[].max_rate": 50.0,
    "springs[].free_length": Row(70.0, HELD),
    "springs[].min_free_length": 90.0,
    "springs[].max_free_length": 80.0,
    "springs[].preload": Row(5.0, HELD),
    "springs[].max_preload": Row(30.0, {**SPRINGS, "springs": [{**SPRINGS["springs"][0], "max_preload": None}]}),
    "springs[].form": Row("compression", FORMLESS),
    "springs[].min_length": 150.0,
    "springs[].max_length": 220.0,
    "springs[].max_deflection": 155.0,
    "springs[].max_force": 10.0,
    "springs[].diameter": Row(20.0, PUSHED),
    "springs[].links": Row(["ground", "input"], TURNING),
    "springs[].torsion": Row(4.0, WOUND),
    "springs[].max_torsion": Row(2.0, TURNING),
    "springs[].free_angle": Row(60.0, WOUND),
    "springs[].min_free_angle": Row(90.0, TURNING),
    "springs[].max_free_angle": Row(-20.0, TURNING),
    "springs[].max_torque": Row(2.0, TURNING),
}
