"""Code that several tests share: gear train analysis."""

from __future__ import annotations

from typing import Any

from synthesis.analyses import parse_request
from synthesis.analyses.gears.gear_train import GearTrainAnalysis, GearTrainAnalysisRequest


def analysed(
    stages: list[dict[str, Any]], idlers: list[dict[str, int]] | None = None, **fields: Any
) -> GearTrainAnalysis:
    mechanism = {"type": "gear_train", "stages": stages, "idlers": idlers or [], **fields.pop("given", {})}
    request = parse_request({"mechanism": mechanism, **fields})
    assert isinstance(request, GearTrainAnalysisRequest)
    assert request.find_errors() == []
    return GearTrainAnalysis.model_validate(request.build_answer())
