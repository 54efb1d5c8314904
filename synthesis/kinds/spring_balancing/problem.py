"""Spring balancing: springs that hold a linkage against gravity and steady loads."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.kinds.spring_balancing.requested_springs import SoughtSpring
from synthesis.model.dynamics.request import DynamicsBlock
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.input_motion import Sweep
from synthesis.model.problem import Contradiction, ProblemBase

EXAMPLE_LEVER: JsonObject = {
    "mechanism": {
        "type": "skeleton",
        "skeleton": {
            "joints": {"O": [0.0, 0.0], "A": [400.0, 0.0]},
            "links": [{"name": "ground", "joints": ["O"]}, {"name": "lever", "joints": ["O", "A"]}],
            "input_link": "lever",
        },
    },
    "motion": {"from": -60.0, "to": 80.0},
    "dynamics": {"gravity": {}, "bodies": {"lever": {"mass": 5.0, "cg": [300.0, 0.0]}}},
}
"""A lever with a weight, used by the examples."""

EXAMPLE_ROCKER: JsonObject = {
    "mechanism": {
        "type": "fourbar",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [300.0, 0.0]},
        "links": {"input": 200.0, "coupler": 280.0, "output": 220.0},
    },
    "motion": {"from": 40.0, "to": 110.0},
    "dynamics": {
        "gravity": {},
        "bodies": {
            "input": {"mass": 1.0, "cg": {"distance": 100.0}},
            "coupler": {"mass": 4.0, "cg": {"distance": 150.0, "angle": 20.0}},
            "output": {"mass": 1.5, "cg": {"distance": 110.0}},
        },
        "loads": [{"joint": "B", "force": {"constant": [0.0, -40.0]}}],
    },
}
"""A lifting linkage with its weights and a load, used by the examples."""


class Holding(Sweep):
    """Equal steps of the input; without a speed the linkage is held at rest at every one of them."""

    @property
    def rate(self) -> float:
        """Input speed, rad/s (length unit/s for a driven slider); 0 by default."""
        return 0.0 if self.speed is None and self.speed_rpm is None else super().rate


class SpringBalancingProblem(ProblemBase):
    """Spring balancing: springs that minimize the drive of a linkage under its weights and loads.

    Rates, preloads and free lengths at given ends, and one open end of a zero-free-length spring, are optimal with a
    proven bound; so are both open ends of such springs if the bound is reached. Ends of other springs are searched. If
    springs balance a linkage at rest exactly, the energy of all that it carries is constant.
    """

    model_config = ConfigDict(
        title="Spring balancing",
        json_schema_extra={
            "examples": [
                {
                    "kind": "spring_balancing",
                    **EXAMPLE_LEVER,
                    "springs": [
                        {
                            "ends": [
                                {"link": "ground", "point": [0.0, 250.0]},
                                {"link": "lever", "within": [[50.0, 0.0], [200.0, 0.0]]},
                            ],
                            "max_rate": 1000.0,
                        }
                    ],
                },
                {
                    "kind": "spring_balancing",
                    **EXAMPLE_ROCKER,
                    "springs": [
                        {
                            "ends": [
                                {"link": "ground", "point": [-60.0, 260.0]},
                                {"link": "input", "point": {"distance": 120.0}},
                            ],
                            "min_free_length": 60.0,
                            "max_free_length": 120.0,
                            "max_rate": 5000.0,
                            "max_preload": 30.0,
                            "form": "extension",
                            "max_deflection": 200.0,
                        },
                        {"links": ["ground", "output"], "max_torsion": 40.0, "max_torque": 30.0},
                    ],
                },
                {
                    "kind": "spring_balancing",
                    **EXAMPLE_ROCKER,
                    "springs": [
                        {
                            "ends": [
                                {"link": "ground", "within": [[-150.0, 0.0], [-50.0, 0.0], [-50.0, 300.0]]},
                                {"link": "input", "within": [[0.0, 100.0], [80.0, 120.0]]},
                            ],
                            "max_rate": 2000.0,
                        }
                    ],
                },
                {
                    "kind": "spring_balancing",
                    **EXAMPLE_ROCKER,
                    "springs": [
                        {
                            "ends": [
                                {"link": "ground", "within": [[-150.0, -100.0], [-50.0, 50.0], [-50.0, 250.0]]},
                                {"link": "input", "within": [{"distance": 60.0}, {"distance": 180.0}]},
                            ],
                            "min_free_length": 50.0,
                            "max_free_length": 150.0,
                            "form": "extension",
                        }
                    ],
                    "norm": "rms",
                    "max_designs": 3,
                },
            ]
        },
    )

    kind: Literal["spring_balancing"]
    mechanism: JsonObject = Field(description="Linkage, as in `POST /v1/analyses`.")
    motion: Holding = Field(
        default=Holding(),
        description="Motion; by default a full turn, or for a driven slider from toggle to toggle; at rest without a "
        "speed.",
    )
    dynamics: DynamicsBlock = Field(description="Masses and loads of the linkage, as in `POST /v1/analyses`.")
    springs: list[SoughtSpring] = Field(min_length=1, max_length=6, description="The springs to be found.")
    norm: Literal["max", "rms"] = Field(
        default="max",
        description="Whether the peak of the drive over the motion is minimized, or its root mean square.",
    )

    @property
    def force_units(self) -> Literal["si", "consistent"]:
        """Unit system of the forces."""
        return self.dynamics.units

    def find_contradictions(self) -> list[Contradiction]:
        """Return errors in the linkage and its loads, and in the places of the springs' ends."""
        if self.dynamics.friction is not None:
            detail = compose("spring_balancing-friction-not-supported")
            return [Contradiction("/dynamics/friction", detail)]
        # Imported here because it loads the analysis core, which parsing a problem should not wait for.
        from synthesis.kinds.spring_balancing.errors import find_spring_errors

        faults = self.motion.find_errors() or find_spring_errors(
            self.mechanism, self.dynamics, self.length_unit, self.motion, self.springs
        )
        return [Contradiction(path, detail) for path, detail in faults]
