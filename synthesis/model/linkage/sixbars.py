"""Sixbars and eightbars in answers, built from their joints in the first position."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from synthesis.model.linkage.answer import EightbarMechanism, SixbarMechanism
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
    with the suffixes ``_arm`` and ``_side``; those of a fourth pin end in ``_arm_2`` and ``_side_2``. The joint
    ``point`` is not a pin; it is None if all joints are pins.
    """
    lengths: dict[str, float] = {}
    for name, listed in links.items():
        pins = [joint for joint in listed if joint != point]
        lengths[name] = abs(joints[pins[1]] - joints[pins[0]])
        # Every further pin needs two more distances to be determined.
        for number, pin in enumerate(pins[2:], 1):
            suffix = "" if number == 1 else f"_{number}"
            lengths[f"{name}_arm{suffix}"] = abs(joints[pin] - joints[pins[0]])
            lengths[f"{name}_side{suffix}"] = abs(joints[pin] - joints[pins[1]])
    return lengths


def build_sixbar(
    kind: str, joints: Mapping[str, complex], links: Links, *, body_angle: float | None = None
) -> SixbarMechanism:
    """Build the sixbar with the given joints, driven by the link ``input``."""
    return SixbarMechanism.model_validate(
        {"type": kind, "reference_body_angle": body_angle, **_describe_linkage(joints, links)}
    )


def build_eightbar(
    joints: Mapping[str, complex], links: Links, *, body_angle: float | None = None
) -> EightbarMechanism:  # fmt: skip
    """Build the eightbar with the given joints, driven by the link ``input``."""
    return EightbarMechanism.model_validate({"reference_body_angle": body_angle, **_describe_linkage(joints, links)})


def _describe_linkage(joints: Mapping[str, complex], links: Links) -> dict[str, Any]:
    """Return the fields that sixbars and eightbars share."""
    return {
        "fixed_pivots": {name: to_point(joints[name]) for name in links["ground"]},
        "links": list_lengths(joints, links),
        "skeleton": build_skeleton(joints, links),
    }
