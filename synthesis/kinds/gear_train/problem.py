"""The problem of an ordinary gear train: tooth numbers for a speed ratio."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict

from synthesis.kinds.gear_train.statement.contradictions import find_train_contradictions
from synthesis.kinds.gear_train.statement.train import GearTrainBase
from synthesis.model.problem import Contradiction


class GearTrainProblem(GearTrainBase):
    """An ordinary gear train of one to four stages for a speed ratio, proven to be the best.

    Every train within the ranges, or of the gears in stock, is covered in exact arithmetic. The answer contains the
    best trains in the order of the ranking, the number of ties, and the Pareto set of error against size. Stages are
    external spur gears, or given one by one: external, internal, helical, bevel, worm.
    """

    model_config = ConfigDict(
        title="Gear train",
        json_schema_extra={
            "examples": [
                {
                    "kind": "gear_train",
                    "ratio": "pi",
                    "max_stages": 2,
                    "teeth": {"min": 15, "max": 100},
                    "max_designs": 5,
                },
                {
                    "kind": "gear_train",
                    "ratio": "12",
                    "max_stages": 2,
                    "teeth": {"min": 12, "max": 60},
                    "reverted": True,
                    "tolerance": 0.0,
                },
                {
                    "kind": "gear_train",
                    "ratio": "pi",
                    "max_stages": 2,
                    "teeth": {"min": 17, "max": 100},
                    "reverted": True,
                    "modules": [1.0, 1.25, 1.5, 2.0],
                    "centre_distance": 120.0,
                    "tolerance": 1e-5,
                    "max_designs": 3,
                },
                {
                    "kind": "gear_train",
                    "ratio": "12",
                    "max_stages": 2,
                    "teeth": {"min": 18, "max": 90},
                    "modules": [1.5, 2.0, 2.5, 3.0],
                    "tolerance": 0.001,
                    "strength": {
                        "power_kw": 3.0,
                        "speed_rpm": 1450.0,
                        "allowable_bending": [200.0, 180.0],
                        "allowable_contact": [800.0, 750.0],
                        "max_face_width": 12.0,
                    },
                    "max_designs": 3,
                },
                {
                    "kind": "gear_train",
                    "ratio": "47",
                    "stages": [
                        {"type": "helical", "helix_angle": 15.0, "face_width": 40.0},
                        {"type": "internal"},
                        {"type": "external"},
                    ],
                    "teeth": {"min": 18, "max": 90},
                    "module": 2.0,
                    "max_designs": 3,
                },
                {
                    "kind": "gear_train",
                    "ratio": "100",
                    "stages": [
                        {"type": "bevel", "driver": 20, "driven": 30},
                        {"type": "worm", "driver": 2, "driven": {"min": 30, "max": 60}, "friction": 0.04},
                        {"type": "external"},
                    ],
                    "teeth": {"min": 18, "max": 60},
                    "module": [3.0, 4.0, 2.5],
                    "max_designs": 3,
                },
            ]
        },
    )

    kind: Literal["gear_train"]

    def find_contradictions(self) -> list[Contradiction]:
        """Return contradictions that no single field shows, and searches that would take too long."""
        return find_train_contradictions(self)
