"""Layshaft gearboxes of vehicles: given gears and reverse, with one tooth sum for all pairs."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from synthesis.model.gear_statement import MOST_TOOTH_SUM, CommonPressureAngle, Module, ToothRange, tooth_faults
from synthesis.model.statement import Contradiction, Flag, StatedProblem


class LayshaftProblem(StatedProblem):
    """Layshaft gearbox of a vehicle: tooth numbers for given gears and reverse, with one tooth sum for all pairs.

    A head pair turns the layshaft; each gear is a pair from there to the main shaft, in constant mesh. A gear of ratio
    1 is direct drive. Reverse has an idler. Every tooth sum, head pair and gear pair within the limits is covered.
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
        default=None, description="Size of the ratio of the reverse gear. Left open: there is none."
    )
    direct: Flag = Field(default=True, description="A gear of ratio 1 joins input and main shaft, without gears.")
    teeth: ToothRange = ToothRange(min=18, max=80)
    tooth_sum: ToothRange = Field(default=ToothRange(min=50, max=110), description="Of every pair.")
    interference: Literal["refuse", "report"] = Field(
        default="refuse", description="Pairs whose standard teeth would interfere are not used, or used and told."
    )
    tolerance: Annotated[float, Field(strict=True, ge=0.0, lt=1.0)] | None = Field(
        default=None, description="Largest relative error of any gear. Left open: the best there is."
    )
    module: Module = Field(default=1.0, description="Of all gears, in the length unit.")
    pressure_angle: CommonPressureAngle = Field(default=20.0, description="Degrees.")
    rank_by: Literal["error", "size"] = Field(
        default="error", description="Least largest error first, or least tooth sum within the tolerance first."
    )

    def contradictions(self) -> list[Contradiction]:
        """Limits the wrong way round, gears out of order or stated twice."""
        contradictions = tooth_faults(self.teeth, self.tooth_sum)
        for k, (before, after) in enumerate(zip(self.ratios, self.ratios[1:], strict=False), start=1):
            if after >= before:
                contradictions.append(Contradiction(f"/ratios/{k}", "must be below the gear before it"))
        if self.rank_by == "size" and self.tolerance is None:
            contradictions.append(Contradiction("/tolerance", "ranking by size needs a tolerance for the ratios"))
        if self.tooth_sum.max > MOST_TOOTH_SUM:
            contradictions.append(Contradiction("/tooth_sum/max", f"at most {MOST_TOOTH_SUM}"))
        return contradictions
