"""Comparison of a given three-link chain with the chains from ground to body in a finished linkage."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from kinematics.linkage.planar.mechanism import GROUND
from synthesis.kinds.motion.demanded import Complex
from synthesis.kinds.motion.stated_mechanisms import Chain
from synthesis.model.statement import PartialPoint
from synthesis.proof.space import BODY_POINT

Links = Mapping[str, tuple[str, ...]]


def chain_gap(stated: Chain, links: Links, joints: Mapping[str, Complex], size: float) -> float:
    """Measure the deviation of a linkage's best matching chain from a given one, as a share of the task's size.

    Parameters
    ----------
    stated : Chain
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
    found = ((joints[pivot], joints[knee], joints[pin]) for pivot, knee, pin in _chains(links))
    return min((_gap(stated, pivot, knee, pin, size) for pivot, knee, pin in found), default=math.inf)


def _chains(links: Links) -> Iterator[tuple[str, str, str]]:
    """Yield the joints G, H₁, H₂ of all chains ground – link – link – body."""
    body = next(name for name, listed in links.items() if BODY_POINT in listed)
    for first, of_first in links.items():
        for second, of_second in links.items():
            if len({GROUND, first, second, body}) == 4:
                for pivot in set(of_first) & set(links[GROUND]):
                    for knee in set(of_first) & set(of_second):
                        for pin in set(of_second) & set(links[body]):
                            yield pivot, knee, pin


def _gap(stated: Chain, pivot: Complex, knee: Complex, pin: Complex, size: float) -> float:
    gaps = [_off(stated.fixed_pivot, complex(pivot[0])), _off(stated.moving_pivot, complex(pin[0]))]
    lengths = abs(knee[0] - pivot[0]), abs(pin[0] - knee[0])
    for length, wanted in zip(lengths, stated.links or (None, None), strict=True):
        gaps.append(0.0 if wanted is None else abs(float(length) - wanted))
    side = ((pin - pivot).conjugate() * (knee - pivot)).imag
    bent = {"any": True, "left": bool((side > 0.0).all()), "right": bool((side < 0.0).all())}[stated.elbow]
    return max(gaps) / size if bent else math.inf


def _off(stated: PartialPoint | None, point: complex) -> float:
    """Return the largest deviation of a point from a given one, in the given coordinates."""
    x, y = stated or (None, None)
    return max(0.0 if x is None else abs(point.real - x), 0.0 if y is None else abs(point.imag - y))
