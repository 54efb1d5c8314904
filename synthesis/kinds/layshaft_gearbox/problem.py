"""Layshaft gearboxes of vehicles: given gears and reverse, with one tooth sum for all pairs."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.model.gears.request import MAX_TOOTH_SUM, CommonPressureAngle, Module, ToothRange, find_tooth_errors
from synthesis.model.problem import Contradiction, Flag, ProblemBase


class LayshaftProblem(ProblemBase):
    """Layshaft gearbox of a vehicle: tooth numbers for given gears and reverse, with one tooth sum for all pairs.

    A head pair turns the layshaft; each gear is a pair from there to the main shaft, in constant mesh. A gear of ratio
    1 is the direct drive. Reverse has an idler. Every tooth sum, head pair and gear pair within the limits is covered.
    """

    model_config = ConfigDict(
        title="Layshaft gearbox",
        json_schema_extra={
            "examples": [
                {
                    "kind": "layshaft_gearbox",
                    "ratios": [3.5, 2.1, 1.4, 1.0],
                    "reverse": 3.3,
                    "teeth": {"min": 14, "max": 60},
                    "tooth_sum": {"min": 50, "max": 70},
                    "interference": "report",
                    "module": 3.0,
                    "max_designs": 5,
                }
            ]
        },
    )

    kind: Literal["layshaft_gearbox"]
    ratios: list[Annotated[float, Field(strict=True, gt=0.05, le=50.0)]] = Field(
        min_length=1, max_length=12, description="Input over output speed of the forward gears, first gear first."
    )
    reverse: Annotated[float, Field(strict=True, gt=0.05, le=50.0)] | None = Field(
        default=None, description="Magnitude of the reverse gear's ratio. Default: no reverse."
    )
    direct: Flag = Field(
        default=True, description="Whether a gear of ratio 1 couples input and main shaft directly, without teeth."
    )
    teeth: ToothRange = ToothRange(min=18, max=80)
    tooth_sum: ToothRange = Field(default=ToothRange(min=50, max=110), description="Tooth sum of every pair.")
    interference: Literal["refuse", "report"] = Field(
        default="refuse", description="Pairs with interfering standard teeth: refused, or used and reported."
    )
    tolerance: Annotated[float, Field(strict=True, ge=0.0, lt=1.0)] | None = Field(
        default=None, description="Maximum relative error of any gear. Default: the best possible."
    )
    module: Module = Field(default=1.0, description="Module of all gears, in the length unit.")
    pressure_angle: CommonPressureAngle = Field(default=20.0, description="Pressure angle, degrees.")
    rank_by: Literal["error", "size"] = Field(
        default="error",
        description="error: smallest maximum error first. size: smallest tooth sum within the tolerance first.",
    )

    def find_contradictions(self) -> list[Contradiction]:
        """Return reversed limits, and gears out of order or given twice."""
        contradictions = find_tooth_errors(self.teeth, self.tooth_sum)
        for k, (before, after) in enumerate(zip(self.ratios, self.ratios[1:], strict=False), start=1):
            if after >= before:
                contradictions.append(Contradiction(f"/ratios/{k}", compose("layshaft_gearbox-ratios-not-falling")))
        if self.rank_by == "size" and self.tolerance is None:
            contradictions.append(Contradiction("/tolerance", compose("layshaft_gearbox-size-needs-tolerance")))
        if self.tooth_sum.max > MAX_TOOTH_SUM:
            contradictions.append(
                Contradiction("/tooth_sum/max", compose("layshaft_gearbox-tooth-sum-too-large", limit=MAX_TOOTH_SUM))
            )
        return contradictions
