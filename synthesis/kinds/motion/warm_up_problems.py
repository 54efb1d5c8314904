"""Problems that compile the kernels of motion generation that its examples do not call."""

from __future__ import annotations

from collections.abc import Sequence

from synthesis.model.json_object import JsonObject

_FORCES: JsonObject = {
    "dynamics": {"links": {"density": 1.0, "thickness": 1.0, "width": 1.0}, "speed_rpm": 1.0},
    "constraints": {"max_drive_torque": 1e6},
    "max_designs": 1,
}
"""Fields of a problem with forces: link masses, and a limit that every design satisfies."""

_MANUFACTURE: JsonObject = {
    "round": {"length": 0.5, "coordinates": 0.5},
    "tolerances": {"length": 0.1},
    "quality": {"max_error": 1e3},
    "samples": 100,
}

_WORKSPACE: JsonObject = {
    "box": [[-1e3, -1e3], [1e3, 1e3]],
    "obstacles": [{"circle": {"center": [900.0, 900.0], "radius": 1.0}}],
}
"""A workspace far larger than any design."""


def list_warm_up_problems(examples: Sequence[JsonObject]) -> list[JsonObject]:
    """Return problems with forces, manufacture, a workspace, a slider, and sixbars of each type and on a given chain.

    Parameters
    ----------
    examples : sequence of dict
        The examples of the kind; the first one states positions that fourbars reach.
    """
    first = examples[0]
    positions = first["positions"]
    toleranced = [{**position, "tolerance": 1.0} for position in positions]
    five = next(example["positions"] for example in examples if example.get("mechanisms"))
    plain = {"kind": "motion", "max_designs": 1}
    return [
        first | _FORCES | {"manufacture": _MANUFACTURE},
        plain | {"positions": toleranced, "space": _WORKSPACE},
        plain | {"positions": positions, "output_side": {"dyad": "PR"}} | _FORCES,
        plain | {"positions": five, "mechanisms": ["watt_1"], "chain": {"elbow": "left"}},
    ]
