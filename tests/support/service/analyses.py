"""Code that several tests share: analyses."""

import numpy as np
import pytest

from synthesis.analyses.linkages.linkage import LinkageAnalysis, LinkageAnalysisRequest

EXAMPLE = LinkageAnalysisRequest.model_config["json_schema_extra"]["examples"][0]

FOURBAR = {
    "type": "fourbar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
}
STUCK = {**FOURBAR, "links": {"input": 5.0, "coupler": 4.0, "output": 3.2}}
"""Not a Grashof fourbar: its input turns through no full turn."""

SIXBAR = {
    "type": "stephenson_2",
    "skeleton": {
        "joints": {
            "O2": [0.0, 0.0], "O4": [4.0, 0.0], "A": [0.3, 1.0], "C": [0.8, 0.6],
            "B": [1.5, 3.0], "D": [3.0, 2.2], "E": [4.2, 2.0], "P": [3.0, 3.0],
        },
        "links": [
            {"name": "ground", "joints": ["O2", "O4"]},
            {"name": "input", "joints": ["O2", "A", "C"]},
            {"name": "link_3", "joints": ["A", "B"]},
            {"name": "link_4", "joints": ["B", "D", "E", "P"]},
            {"name": "link_5", "joints": ["C", "D"]},
            {"name": "output", "joints": ["O4", "E"]},
        ],
        "input_link": "input",
    },
}  # fmt: skip
"""Class III: no sequence of dyads closes it from this input."""


def assert_as_documented(found):
    """The answer has the shape of the model."""
    LinkageAnalysis.model_validate(found)


@pytest.fixture
def analyse(client):
    def ask(mechanism, motion=None):
        answer = client.post("/v1/analyses", json={"mechanism": mechanism} | ({"motion": motion} if motion else {}))
        assert answer.status_code == 200, answer.text
        assert "NaN" not in answer.text
        assert "Infinity" not in answer.text
        found = answer.json()
        assert_as_documented(found)
        return found

    return ask


def joint(found, name, order=""):
    """A joint's track as complex numbers; ``order`` is "", "v", "a" or "j"."""
    parts = [np.array(found["joints"][name][f"{order}{axis}"], float) for axis in "xy"]
    return parts[0] + 1j * parts[1]
