"""Sixbars of Watt's and Stephenson's chains in answers, built from their joints in the first position."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from synthesis.model.linkage.answer import SixbarMechanism
from synthesis.model.linkage.conversion import build_skeleton, to_point

Links = Mapping[str, Sequence[str]]
"""Joints on each link by name of the link; P is on the link that carries the body."""

SIXBAR_NAMES: Mapping[str, str] = {
    "watt_1": "Watt I sixbar",
    "watt_2": "Watt II sixbar",
    "stephenson_1": "Stephenson I sixbar",
    "stephenson_2": "Stephenson II sixbar",
    "stephenson_3": "Stephenson III sixbar",
}
"""Name of each type, for sentences and drawings."""


def list_lengths(joints: Mapping[str, complex], links: Links, *, point: str | None = "P") -> dict[str, float]:
    """Return the lengths of links by name: the distance between the first two pins of each link.

    A link with three pins also has the distances of its third pin from the first and from the second, under its name
    with the suffixes ``_arm`` and ``_side``. The joint ``point`` is not a pin; it is None if all joints are pins.
    """
    lengths: dict[str, float] = {}
    for name, listed in links.items():
        pins = [joint for joint in listed if joint != point]
        lengths[name] = abs(joints[pins[1]] - joints[pins[0]])
        # Ternary links need two more distances to be determined.
        if len(pins) > 2:
            lengths[f"{name}_arm"] = abs(joints[pins[2]] - joints[pins[0]])
            lengths[f"{name}_side"] = abs(joints[pins[2]] - joints[pins[1]])
    return lengths


def build_sixbar(
    kind: str, joints: Mapping[str, complex], links: Links, *, body_angle: float | None = None
) -> SixbarMechanism:
    """Build the sixbar with the given joints, driven by the link ``input``."""
    return SixbarMechanism.model_validate(
        {
            "type": kind,
            "fixed_pivots": {name: to_point(joints[name]) for name in links["ground"]},
            "links": list_lengths(joints, links),
            "reference_body_angle": body_angle,
            "skeleton": build_skeleton(joints, links),
        }
    )
