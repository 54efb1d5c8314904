"""Motion of a design over its cycle, as NumPy arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real


@dataclass(frozen=True, eq=False)
class Cycle:
    """Motion of a design over its cycle, at n = steps + 1 positions of its input.

    Attributes
    ----------
    input_angle : (n,) array
        Input angle in degrees; for a driving slider, its position along its line in length units.
    valid : (n,) array of bool
        Whether the mechanism can be assembled at this position; if not, all other values are NaN.
    joints : mapping of (n, 2) arrays
        x and y of each joint by name, in length units; P is the coupler point. Empty for mechanisms without joints.
    velocities, accelerations : mapping of (n, 2) arrays
        Time derivatives of the joints for an input speed of 1 rad/s (or 1 length unit/s).
    links : mapping of (n,) arrays
        Angle of each link by name, such as ``coupler``, in degrees.
    slides : mapping of (n,) arrays
        Position of each slide along its line, in length units.
    answer : mapping
        The complete answer of ``GET /v1/jobs/{id}/designs/{n}/motion``, under the names of the API. Lists of numbers
        are arrays; null is NaN.
    """

    input_angle: Real
    valid: NDArray[np.bool_]
    joints: Mapping[str, Real]
    velocities: Mapping[str, Real]
    accelerations: Mapping[str, Real]
    links: Mapping[str, Real]
    slides: Mapping[str, Real]
    answer: Mapping[str, Any]

    @classmethod
    def from_lists(cls, listed: Mapping[str, object]) -> Self:
        """Build a cycle from an answer with plain lists."""
        answer = {name: _convert_arrays(value) for name, value in listed.items()}
        at = answer["input_angle"]
        tracks, links, slides = (answer.get(name, {}) for name in ("joints", "links", "slides"))
        return cls(
            input_angle=at,
            valid=answer.get("valid", np.ones(len(at), dtype=bool)),
            joints={name: np.stack((track["x"], track["y"]), axis=-1) for name, track in tracks.items()},
            velocities={name: np.stack((track["vx"], track["vy"]), axis=-1) for name, track in tracks.items()},
            accelerations={name: np.stack((track["ax"], track["ay"]), axis=-1) for name, track in tracks.items()},
            links={name: link["angle"] for name, link in links.items()},
            slides={name: slide["position"] for name, slide in slides.items()},
            answer=answer,
        )

    def __len__(self) -> int:
        return len(self.input_angle)


def _convert_arrays(value: object) -> Any:
    if isinstance(value, dict):
        return {name: _convert_arrays(inner) for name, inner in value.items()}
    if not isinstance(value, list) or not value:
        return value
    if all(isinstance(inner, bool) for inner in value):
        return np.array(value, dtype=bool)
    if all(inner is None or isinstance(inner, int | float) for inner in value):
        return np.array(value, dtype=float)
    return [_convert_arrays(inner) for inner in value]
