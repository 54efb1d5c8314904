"""Comparison of a given three-link chain with the chains from ground to body in a finished linkage."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from kinematics.arrays import Complex
from kinematics.linkage.planar.mechanism import GROUND
from synthesis.kinds.motion.statement.mechanism_types import Chain
from synthesis.model.problem import PartialPoint
from synthesis.verification.workspace import BODY_POINT

Links = Mapping[str, tuple[str, ...]]


def measure_chain_gap(requested: Chain, links: Links, joints: Mapping[str, Complex], size: float) -> float:
    """Measure the deviation of a linkage's best matching chain from a given one, as a share of the task's size.

    Parameters
    ----------
    requested : Chain
        Given values of G, H₁ and H₂.
    links : mapping
        The joints on each link.
    joints : mapping of str to complex, shape (targets,)
        Positions of the joints at the targets.
    size : float
        The task's size.

    Returns
    -------
    float
        The deviation; infinite if no chain bends to the given side, or there is no chain.
    """
    found = ((joints[pivot], joints[knee], joints[pin]) for pivot, knee, pin in _list_chains(links))
    return min((_measure_gap(requested, pivot, knee, pin, size) for pivot, knee, pin in found), default=math.inf)


def _list_chains(links: Links) -> Iterator[tuple[str, str, str]]:
    """Yield the joints G, H₁, H₂ of all chains ground – link – link – body."""
    body = next(name for name, listed in links.items() if BODY_POINT in listed)
    for first, of_first in links.items():
        for second, of_second in links.items():
            # Four different links: ground, both of the chain, and the body.
            if len({GROUND, first, second, body}) == 4:
                for pivot in set(of_first) & set(links[GROUND]):
                    for knee in set(of_first) & set(of_second):
                        for pin in set(of_second) & set(links[body]):
                            yield pivot, knee, pin


def _measure_gap(requested: Chain, pivot: Complex, knee: Complex, pin: Complex, size: float) -> float:
    gaps = [
        _measure_offset(requested.fixed_pivot, complex(pivot[0])),
        _measure_offset(requested.moving_pivot, complex(pin[0])),
    ]
    lengths = abs(knee[0] - pivot[0]), abs(pin[0] - knee[0])
    for length, wanted in zip(lengths, requested.links or (None, None), strict=True):
        gaps.append(0.0 if wanted is None else abs(float(length) - wanted))
    # The side of H₁ from the line G → H₂, which must be the same at all targets.
    side = ((pin - pivot).conjugate() * (knee - pivot)).imag
    bent = {"any": True, "left": bool((side > 0.0).all()), "right": bool((side < 0.0).all())}[requested.elbow]
    return max(gaps) / size if bent else math.inf


def _measure_offset(requested: PartialPoint | None, point: complex) -> float:
    """Return the largest deviation of a point from a given one, in the given coordinates."""
    x, y = requested or (None, None)
    return max(0.0 if x is None else abs(point.real - x), 0.0 if y is None else abs(point.imag - y))
