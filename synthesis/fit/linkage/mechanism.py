"""Convert a fitted linkage into an answer: its joints at the first target, in the problem's coordinates."""

from __future__ import annotations

import numpy as np

from synthesis.fit.linkage.closure import move_reference
from synthesis.fit.linkage.descent import Fit
from synthesis.model.linkage.answer import EightbarMechanism, SixbarMechanism
from synthesis.model.linkage.sixbars import build_eightbar, build_sixbar

MIN_LINK = 1e-6
"""Minimum distance of two pins of one link, as a share of the task's size."""


def build_fitted_linkage(
    kind: str, fit: Fit, centre: complex, size: float, body_angle: float | None = None
) -> SixbarMechanism | EightbarMechanism | None:
    """Return the linkage of a fit at its first input; None if it does not close there, or a link has no length.

    ``centre`` and ``size`` are the origin and the unit of the fit, in the problem's coordinates. ``body_angle`` is the
    body's angle at the first target, degrees, where that differs from the requested one.
    """
    topology, z = fit.topology, np.empty(2 * len(fit.topology.nodes))
    if not move_reference(topology.nodes, fit.x, float(fit.inputs[0]), z):
        return None
    names = topology.pin_names
    joints = {name: complex(centre + size * complex(*z[2 * k : 2 * k + 2])) for k, name in names.items()}
    links = {link: tuple(names[pin] for pin in pins) for link, pins in topology.links.items()}
    links[topology.body] += ("P",)
    if kind == "eightbar":
        made: SixbarMechanism | EightbarMechanism = build_eightbar(joints, links, body_angle=body_angle)
    else:
        made = build_sixbar(kind, joints, links, body_angle=body_angle)
    # Coinciding pins cannot be manufactured, nor driven reliably.
    return made if min(made.links.values()) > MIN_LINK * size else None
