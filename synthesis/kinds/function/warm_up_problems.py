"""Problems that compile the kernels of function generation that its examples do not call."""

from __future__ import annotations

from synthesis.model.json_object import JsonObject


def list_warm_up_problems() -> list[JsonObject]:
    """Return problems with forces, and for sixbars of each type."""
    forces = {
        "dynamics": {"links": {"density": 1.0, "thickness": 1.0, "width": 1.0}, "speed_rpm": 1.0},
        "constraints": {"max_drive_torque": 1e6},  # a limit that every design keeps
    }
    sine = {
        "function": {"name": "sine", "x": [0.0, 90.0]},
        "input_range": 60.0,
        "output_range": 60.0,
    }
    plain = {"kind": "function", "max_designs": 1}
    return [
        plain | {"pairs": [{"input": 20.0 * x, "output": 9.0 * x + x * x} for x in range(4)]} | forces,
        plain | sine | {"mechanisms": ["stephenson_2", "stephenson_3"]},
    ]
