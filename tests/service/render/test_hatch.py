"""The lid of docs/mechanisms/space.md through HTTP: designs, and a message where the frame leaves no room."""

from __future__ import annotations

import copy
import json
import re
from pathlib import Path
from typing import Any

import pytest

from synthesis.kinds.motion.design import MotionResult
from tests.campaign import further
from tests.support.fit.verdict import violations
from tests.support.service.answers import finished

PAGE = Path(__file__).parents[3] / "docs" / "mechanisms" / "space.md"


def stated() -> tuple[dict[str, Any], dict[str, Any]]:
    """The statement of the page, and the obstacle with which it has no answer."""
    text = PAGE.read_text("utf-8")
    example, beam = (
        re.search(r"```json\n(.*?)```", text, re.DOTALL),
        re.search(r"beam .*?`(\[\[.*?\]\])`", text, re.DOTALL),
    )
    assert example is not None
    assert beam is not None
    return json.loads(example[1])["problem"], {"polygon": json.loads(beam[1])}


def floats(value: Any) -> Any:
    """JSON with every number a float, as the verdict takes it."""
    if isinstance(value, dict):
        return {name: floats(one) for name, one in value.items()}
    if isinstance(value, list):
        return [floats(one) for one in value]
    return float(value) if isinstance(value, int) else value


@pytest.mark.slow
def test_a_lid_is_carried_past_the_frame(client: Any) -> None:
    hatch, _ = stated()
    result = MotionResult.model_validate(finished(client, {**hatch, "max_designs": 4})["result"])
    assert len(result.designs) == 4
    for design in result.designs:
        assert design.verification.passed
        assert {"fixed_pivot_zones", "moving_pivot_zones", "obstacles"} <= {
            check.name for check in design.verification.checks
        }
        assert violations(floats(hatch), design) == []
    assert result.designs[0].metrics.min_transmission_angle > 50.0


@pytest.mark.slow
@pytest.mark.parametrize("beside", further(["constraints", "layout"], ["constraints"]))
def test_other_demands_are_kept_beside_the_room(client: Any, beside: str) -> None:
    hatch, _ = stated()
    more: dict[str, Any] = {
        "constraints": {"constraints": {"min_transmission_angle": 60.0, "max_link_ratio": 8.0}},
        "layout": {"layout": {"link_width": 16.0, "pin_diameter": 8.0, "thickness": 5.0, "max_planes": 3}},
    }[beside]
    result = MotionResult.model_validate(finished(client, {**hatch, **more, "max_designs": 2})["result"])
    assert result.designs
    for design in result.designs:
        assert violations(floats(hatch), design) == []
        if beside == "constraints":
            assert design.metrics.min_transmission_angle >= 60.0 - 1e-6
            assert design.metrics.link_ratio is not None
            assert design.metrics.link_ratio <= 8.0 + 1e-6
        else:
            assert design.layout is not None
            assert design.layout.count <= 3


@pytest.mark.slow
@pytest.mark.campaign
def test_a_beam_that_leaves_no_room_is_told_with_what_comes_nearest(client: Any) -> None:
    hatch, beam = stated()
    blocked = copy.deepcopy(hatch)
    blocked["space"]["obstacles"] = [beam]
    result = finished(client, blocked)["result"]
    assert result["designs"] == []
    assert not result["search"]["complete"]
    assert "a solution may still exist" in result["summary"]
    (gap,) = result["nearest_miss"]["gaps"]
    assert gap["check"] == "obstacles"
    assert gap["limit"] == 5.0
    assert 0.0 < gap["value"] < 5.0
    design = result["nearest_miss"]["design"]
    failed = [check["name"] for check in design["verification"]["checks"] if not check["passed"]]
    assert failed == ["obstacles"]
    closer = copy.deepcopy(blocked)
    closer["space"]["clearance"] = 0.9 * gap["value"]
    assert finished(client, {**closer, "max_designs": 1})["result"]["designs"]
