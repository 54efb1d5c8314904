"""Closures: the order in which the links of a mechanism follow from its input, one small group after the other.

A link with known motion determines its joints. Each step determines one more link, or two:

    gear     a link on a known pin, geared to a known link;
    carried  a link on two known pins (in an overconstrained mechanism);
    RRP      a link on a known pin, one of whose joints slides on a line of a known link;
    RPR      a link on a known pin, on a line of which a known joint slides;
    RRR      two links, each on a known pin, that share a joint.

RRP, RPR and RRR come down to one equation Re(e^{−iφ} k) = r for the rotation φ of the (first) link from the reference,
where k and r are known jets:

    RRP   k = n conj(b),         r = Re(conj(n) (x − p))           n: normal of the line, x on it, b: pin to joint
    RPR   k = conj(n)(q − p),    r = Re(conj(n) (x − p))_reference
    RRR   k = conj(b)(q − p),    r = (|b|² + |q − p|² − c²)/2       c: length from the second pin to the joint

Each has two solutions; the reference configuration selects one by the sign of Im k there. Groups of more links (class
III) have no such steps; :mod:`kinematics.linkage.planar.triads` follows them by continuation.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Literal, NamedTuple

from kinematics.linkage.planar.mechanism import GROUND, GearPair, Mechanism, Slide

CACHE_SIZE = 8
"""Number of mechanisms whose closures are cached: root finding needs them dozens of times."""


class Step(NamedTuple):
    """One closure: ``link`` turns about the known joint ``pin``. The other fields depend on the kind.

    gear: ``other`` is the known link, ``ratio`` the rotation of ``link`` per rotation of ``other``. carried: ``joint``
    is the second known pin. RRP: ``joint`` of the link stays on ``slide``'s line in a known link. RPR: the known
    ``joint`` stays on ``slide``'s line in the link. RRR: the links ``link`` and ``other`` share ``joint``; ``other``
    turns about the known joint ``other_pin``.
    """

    kind: Literal["gear", "carried", "RRP", "RPR", "RRR"]
    link: str
    pin: str
    joint: str = ""
    other: str = ""
    other_pin: str = ""
    slide: Slide | None = None
    ratio: float = 0.0

    @property
    def has_two_solutions(self) -> bool:
        """Whether the step is a choice between two assemblies."""
        return self.kind in ("RRP", "RPR", "RRR")


class Decomposition(NamedTuple):
    """The steps in their order, and the links that no step reaches (a class III group)."""

    steps: tuple[Step, ...]
    left: tuple[str, ...]


@lru_cache(maxsize=CACHE_SIZE)
def decompose(mechanism: Mechanism) -> Decomposition:
    """Order the closures of a mechanism from its input."""
    return order_closures(mechanism.links, mechanism.input, mechanism.slides, mechanism.gears)


def order_closures(
    links: dict[str, tuple[str, ...]], input: str, slides: tuple[Slide, ...], gears: tuple[GearPair, ...]
) -> Decomposition:
    """Order the closures from the links, slides and gears alone; see :func:`decompose`."""
    known = [GROUND, input] if input in links else [GROUND]
    joints = {joint for link in known for joint in links[link]}
    if input not in links:
        joints.add(input)
    steps: list[Step] = []
    while True:
        step = _find_next_step(links, slides, gears, known, joints)
        if step is None:
            break
        steps.append(step)
        for link in (step.link, step.other if step.kind == "RRR" else ""):
            if link:
                known.append(link)
                joints.update(links[link])
    return Decomposition(tuple(steps), tuple(link for link in links if link not in known))


def _find_next_step(
    links: dict[str, tuple[str, ...]],
    slides: tuple[Slide, ...],
    gears: tuple[GearPair, ...],
    known: list[str],
    joints: set[str],
) -> Step | None:
    """Find the closure that follows from the known links and joints; None if no single step does."""
    unknown = [link for link in links if link not in known]
    pins = {link: [joint for joint in links[link] if joint in joints] for link in unknown}
    # Prefer single links to pairs: a link on two known pins first, then gears and slides, dyads last.
    for link in unknown:
        if len(pins[link]) >= 2:
            return Step("carried", link, pins[link][0], pins[link][1])
    for link in unknown:
        if not pins[link]:
            continue
        pin = pins[link][0]
        for gear in gears:
            if gear.second == link and gear.first in known:
                return Step("gear", link, pin, other=gear.first, ratio=gear.ratio)
            if gear.first == link and gear.second in known and gear.ratio != 0.0:
                return Step("gear", link, pin, other=gear.second, ratio=1.0 / gear.ratio)
        for slide in slides:
            if slide.link in known and slide.joint in links[link] and slide.joint not in joints:
                return Step("RRP", link, pin, slide.joint, slide=slide)
            if slide.link == link and slide.joint in joints and slide.joint != pin:
                return Step("RPR", link, pin, slide.joint, slide=slide)
    for link in unknown:
        for other in unknown:
            shared = [j for j in links[link] if j in links[other] and j not in joints]
            # Each pair once, in a reproducible order.
            if link < other and pins[link] and pins[other] and shared:
                return Step("RRR", link, pins[link][0], shared[0], other=other, other_pin=pins[other][0])
    return None
