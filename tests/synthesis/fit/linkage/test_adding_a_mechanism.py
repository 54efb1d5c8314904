"""The page about adding a mechanism: its one row is executed, and the search for paths takes it."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from synthesis.fit.linkage import topology
from synthesis.kinds.path.multiloop.solver import SIXBARS, solve_by_family
from synthesis.registry import parse_problem
from tests.oracles.loops import Loops

PAGE = Path(__file__).parents[4] / "docs" / "development" / "adding-a-mechanism.md"


@pytest.mark.slow
def test_one_row_adds_a_variant_that_paths_are_solved_with(monkeypatch) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    monkeypatch.setattr(topology, "SIXBAR_DYADS", dict(topology.SIXBAR_DYADS))
    topology.list_forms.cache_clear()
    exec(code, {})  # the page's own lines, which import the patched table
    try:
        turn = np.linspace(0.0, 2.0 * math.pi, 30, endpoint=False)
        points = 40.0 * np.cos(turn) + 12.0j * np.sin(turn) + 4.0 * np.cos(2.0 * turn)
        problem = parse_problem(
            {
                "kind": "path",
                "method": "curve_match",
                "closed": True,
                "points": [{"x": float(z.real), "y": float(z.imag)} for z in points],
                "mechanisms": ["stephenson_3"],
                "max_designs": 1,
            }
        )
        (design,) = solve_by_family(problem, SIXBARS, ("watt_2",), lambda *_: None).designs
    finally:
        topology.list_forms.cache_clear()
    assert design.mechanism.type == "watt_2"
    assert design.verification.passed
    skeleton = design.mechanism.skeleton.model_dump(mode="json")
    assert {"O2", "O4", "O6"} <= set(skeleton["joints"])
    followed = Loops(skeleton).followed(np.linspace(0.0, 2.0 * math.pi, 181))
    assert followed.branch > 0.0
    gaps = np.abs(points[:, None] - followed.points).min(axis=1)
    assert math.sqrt(np.mean(gaps**2)) < 0.03 * problem.task_size
