"""Balancing: corrections of a rotor, and counterweights of a linkage."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.kinds.balancing.statement.counterweights import Counterweights, ForceCaps, ForceWeights
from synthesis.kinds.balancing.statement.rotor import RotorBase
from synthesis.model.dynamics.request import DynamicsBlock
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.input_motion import Sweep
from synthesis.model.problem import Contradiction

EXAMPLE_FOURBAR: JsonObject = {
    "mechanism": {
        "type": "fourbar",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [280.0, 0.0]},
        "links": {"input": 100.0, "coupler": 300.0, "output": 200.0},
    },
    "motion": {"speed_rpm": 300.0},
    "dynamics": {
        "bodies": {
            "input": {"mass": 0.5, "cg": {"distance": 50.0}, "inertia": 0.0006},
            "coupler": {"mass": 1.2, "cg": {"distance": 140.0, "angle": 8.0}, "inertia": 0.012},
            "output": {"mass": 0.9, "cg": {"distance": 90.0}, "inertia": 0.004},
        }
    },
}
"""A fourbar with masses, used by the examples."""

ROTOR_FIELDS = (
    *("masses", "bearing_readings", "influence", "rpm", "planes", "bearings", "rotor_mass", "max_grade", "correction"),
    *("units", "rank_by"),
)
LINKAGE_FIELDS = ("goal", "mechanism", "motion", "dynamics", "counterweights", "objective", "caps")
EXACT_FIELDS = ("radius", "mass")
MINIMIZED_FIELDS = ("reach", "max_mass", "total_mass", "max_gyration", "max_disc_radius")


class BalancingProblem(RotorBase):
    """Balancing of a rotor or a linkage: masses to add so that little or nothing shakes the frame.

    The unbalance of a rotor is known from its masses, from the forces on its bearings, or from runs with trial weights;
    among holes or stock weights those with the smallest residual are found. A linkage gets counterweights with which it
    exerts no force on its frame, or neither force nor moment; if none exist, that is proven.
    """

    model_config = ConfigDict(
        title="Balancing",
        json_schema_extra={
            "examples": [
                {
                    "kind": "balancing",
                    "object": "rotor",
                    "masses": [
                        {"mass": 1.2, "radius": 1135.0, "angle": 113.4, "z": 854.0},
                        {"mass": 1.8, "radius": 822.0, "angle": 48.8, "z": 1701.0},
                        {"mass": 2.4, "radius": 1040.0, "angle": 251.4, "z": 2396.0},
                    ],
                    "planes": [0.0, 3097.0],
                    "rpm": 300.0,
                    "correction": {"radius": 806.0},
                },
                {
                    "kind": "balancing",
                    "object": "rotor",
                    "influence": {
                        "initial": [{"amplitude": 8.5, "angle": 60.0}, {"amplitude": 6.5, "angle": 205.0}],
                        "trials": [
                            {
                                "mass": 0.01,
                                "radius": 125.0,
                                "angle": 270.0,
                                "readings": [{"amplitude": 6.0, "angle": 125.0}, {"amplitude": 4.5, "angle": 230.0}],
                            },
                            {
                                "mass": 0.012,
                                "radius": 125.0,
                                "angle": 180.0,
                                "readings": [{"amplitude": 6.0, "angle": 35.0}, {"amplitude": 10.5, "angle": 160.0}],
                            },
                        ],
                    },
                    "planes": [0.0, 400.0],
                    "rpm": 3000.0,
                    "rotor_mass": 40.0,
                    "max_grade": 6.3,
                    "correction": {"holes": {"angles": 12, "radius": 125.0, "step": 0.0005, "max_per_hole": 0.008}},
                    "rank_by": "places",
                    "max_designs": 3,
                },
                {
                    "kind": "balancing",
                    "object": "linkage",
                    "goal": "force",
                    **EXAMPLE_FOURBAR,
                    "counterweights": {"radius": 60.0},
                },
                {
                    "kind": "balancing",
                    "object": "linkage",
                    "goal": "force_and_moment",
                    "mechanism": EXAMPLE_FOURBAR["mechanism"],
                    "motion": {"speed_rpm": 300.0},
                    "dynamics": {
                        "bodies": {
                            "input": {"mass": 0.5, "cg": {"distance": 50.0}, "inertia": 0.0006},
                            "coupler": {"shape": {"density": 7800.0, "thickness": 8.0, "width": 25.0}},
                            "output": {"mass": 0.9, "cg": {"distance": 90.0}, "inertia": 0.004},
                        }
                    },
                    "counterweights": {"density": 7800.0, "thickness": 25.0},
                },
                {
                    "kind": "balancing",
                    "object": "linkage",
                    "goal": "minimize",
                    **EXAMPLE_FOURBAR,
                    "objective": {"shaking_force": 1.0, "shaking_moment": 0.5, "drive": 0.25},
                    "caps": {"drive": 1.0},
                    "counterweights": {"total_mass": 4.0, "reach": 150.0, "density": 7800.0, "thickness": 20.0},
                },
            ]
        },
    )

    kind: Literal["balancing"]
    object: Literal["rotor", "linkage"]
    goal: Literal["force", "force_and_moment", "minimize"] = Field(
        default="force",
        description="Goal for a linkage. force: no shaking force; a moment may remain. force_and_moment: neither, by "
        "gears on the cranks of a fourbar whose coupler's centre of gravity is on the line of its pins. minimize: the "
        "`objective` is as small as the counterweights permit, with a proven bound.",
    )
    mechanism: JsonObject | None = Field(default=None, description="Linkage, as in `POST /v1/analyses`.")
    motion: Sweep = Field(
        default=Sweep(),
        description="Motion of a linkage; by default a full turn at 1 rad/s, or for a driven slider from toggle to "
        "toggle.",
    )
    dynamics: DynamicsBlock | None = Field(
        default=None, description="Masses and loads of a linkage, as in `POST /v1/analyses`."
    )
    counterweights: Counterweights = Field(
        default=Counterweights(), description="Counterweights of a linkage: permitted links and sizes."
    )

    objective: ForceWeights = Field(default=ForceWeights(shaking_force=1.0), description="Quantities to minimize.")
    caps: ForceCaps = Field(default=ForceCaps(), description="Limits to keep while the objective is minimized.")

    @property
    def force_units(self) -> Literal["si", "consistent"]:
        """Unit system of the forces."""
        return self.units if self.dynamics is None else self.dynamics.units

    def find_contradictions(self) -> list[Contradiction]:
        """Return fields that belong to the other object (rotor or linkage), and errors in the fields of this one."""
        strange = LINKAGE_FIELDS if self.object == "rotor" else ROTOR_FIELDS
        fault = "balancing-field-not-for-rotor" if self.object == "rotor" else "balancing-field-not-for-linkage"
        found = [
            Contradiction(f"/{name}", compose(fault))
            for name in strange
            if getattr(self, name) != type(self).model_fields[name].default
        ]
        if found:
            return found
        return self.find_rotor_errors() if self.object == "rotor" else self._find_linkage_errors()

    def _find_linkage_errors(self) -> list[Contradiction]:
        missing = [name for name in ("mechanism", "dynamics") if getattr(self, name) is None]
        if missing:
            return [Contradiction(f"/{name}", compose("balancing-linkage-field-required")) for name in missing]
        assert self.mechanism is not None
        assert self.dynamics is not None
        if self.motion.rate == 0.0:
            return [Contradiction("/motion", compose("balancing-linkage-at-rest"))]
        # Imported here because it loads the analysis core, which parsing a problem should not wait for.
        from synthesis.kinds.balancing.statement.linkage_errors import find_linkage_errors

        joints = {
            "/objective/joint_forces": self.objective.joint_forces,
            "/caps/joint_forces": self.caps.joint_forces,
        }
        faults = self.motion.find_errors() or find_linkage_errors(
            self.mechanism, self.dynamics, self.length_unit, self.motion, self.counterweights, joints
        )
        found = [Contradiction(path, detail) for path, detail in faults]
        return found or self._find_goal_errors()

    def _find_goal_errors(self) -> list[Contradiction]:
        """Return fields that belong to another goal, and missing requirements of a minimum."""
        minimized, weights = self.goal == "minimize", self.counterweights
        found = [
            Contradiction(f"/counterweights/{name}", compose("balancing-field-not-for-goal", goal=self.goal))
            for name in (EXACT_FIELDS if minimized else MINIMIZED_FIELDS)
            if getattr(weights, name) is not None
        ]
        if not minimized:
            return found + [
                Contradiction(f"/{name}", compose("balancing-field-not-for-goal", goal=self.goal))
                for name in ("objective", "caps")
                if getattr(self, name) != type(self).model_fields[name].default
            ]
        if weights.total_mass is None and weights.max_mass is None:
            detail = compose("balancing-mass-unbounded")
            found.append(Contradiction("/counterweights/total_mass", detail))
        assert self.dynamics is not None
        if self.dynamics.friction is not None:
            detail = compose("balancing-friction-not-supported")
            found.append(Contradiction("/dynamics/friction", detail))
        return found
