"""Convert a fitted sixbar into an answer: its joints at the first point, in the problem's coordinates."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Real
from synthesis.fit.chart import compute_lengths
from synthesis.fit.inverted_curve import A0, B0, GROUND_JOINT_COUNT, PIN, POINT, A, B, compute_inverted_joints
from synthesis.fit.sixbar_curve import COUPLER, CRANK, DYAD, GROUND, INPUT, ROCKER, locate_joints
from synthesis.kinds.path.sixbar.shape_matching import Form
from synthesis.model.linkage.answer import SixbarMechanism
from synthesis.model.linkage.sixbars import build_sixbar

MIN_LINK = 1e-6
"""Minimum distance of two pins of one link, as a share of the task's size."""

STEPHENSON_2_LINKS = {CRANK: "link_3", COUPLER: "link_4", ROCKER: "link_5"}
"""Links of a Stephenson II that may carry P, by their names in answers."""

TERNARY_LINKS = {CRANK: "input", COUPLER: "coupler", ROCKER: "output"}
"""Links that carry or hold a dyad, by their names in answers."""


def build_fitted_sixbar(
    kind: str, form: Form, x: Real, signs: Real, theta: float, centre: complex, size: float
) -> SixbarMechanism | None:
    """Return the sixbar of a fit with its crank at θ; None if it does not close there, or a link has no length.

    ``centre`` and ``size`` are the origin and the unit of the fit, in the problem's coordinates.
    """
    lengths, places = np.empty(4), np.empty(6, np.complex128)
    compute_lengths(form.family, x, lengths, np.empty((4, 4)))
    # A Stephenson II is solved from its input link outwards, with link 3 as the crank.
    if form.holder == INPUT:
        return _build_inverted(kind, form, x, lengths, signs, theta, centre, size)
    if not locate_joints(x, lengths, *_get_assembly(form, signs), theta, places):
        return None
    o2 = complex(x[0], x[1])
    o4 = o2 + lengths[0] * np.exp(1j * x[2])
    at = dict(zip(("A", "B", "C", "D", "E", "P"), places, strict=True)) | {"O2": o2, "O4": o4}
    links = {"ground": ["O2", "O4"], "input": ["O2", "A"], "coupler": ["A", "B"], "output": ["O4", "B"]}
    if form.holder == GROUND:
        # A Stephenson III's dyad is held by the ground: its pin D becomes the third pivot.
        at["O6"], at["D"] = at["D"], at.pop("E")
        links["rocker"] = links.pop("output")
        links["ground"].append("O6")
        links |= {"link_5": ["C", "D", "P"], "output": ["O6", "D"]}
    else:
        links[TERNARY_LINKS[form.holder]].append("D")
        links |= {"link_5": ["C", "E", "P"], "link_6": ["D", "E"]}
    links[TERNARY_LINKS[form.carrier]].append("C")
    return _build_sixbar(kind, at, links, centre, size)


def _build_inverted(
    kind: str, form: Form, x: Real, lengths: Real, signs: Real, theta: float, centre: complex, size: float
) -> SixbarMechanism | None:
    """Return the Stephenson II sixbar of a fit with its link 3 at θ relative to the input; None as above."""
    shown = np.empty(GROUND_JOINT_COUNT, np.complex128)
    if not compute_inverted_joints(x, lengths, float(signs[0]), form.carrier, float(signs[1]), theta, shown)[0]:
        return None
    o2 = complex(x[0], x[1])
    at = {"A": shown[A0], "B": shown[A], "C": shown[B0], "D": shown[B], "E": shown[PIN], "P": shown[POINT]}
    at |= {"O2": o2, "O4": o2 + np.exp(x[DYAD + 1] + 1j * x[2])}
    links = {"ground": ["O2", "O4"], "input": ["O2", "A", "C"], "link_3": ["A", "B"]}
    links |= {"link_4": ["B", "D", "E"], "link_5": ["C", "D"], "output": ["O4", "E"]}
    links[STEPHENSON_2_LINKS[form.carrier]].append("P")
    return _build_sixbar(kind, at, links, centre, size)


def _build_sixbar(
    kind: str, at: dict[str, complex], links: dict[str, list[str]], centre: complex, size: float
) -> SixbarMechanism | None:
    """Build the sixbar; return None if a link has no length."""
    made = build_sixbar(
        kind,
        {name: complex(centre + size * place) for name, place in at.items()},
        {name: tuple(listed) for name, listed in links.items()},
    )
    # Coinciding pins cannot be manufactured, nor driven reliably.
    return made if min(made.links.values()) > MIN_LINK * size else None


def _get_assembly(form: Form, signs: Real) -> tuple[float, int, int, float]:
    """Return the arguments of :func:`~synthesis.fit.sixbar_curve.locate_joints` that describe form and assembly."""
    return float(signs[0]), form.carrier, form.holder, float(signs[1])
