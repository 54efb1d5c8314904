"""Transmission angles of a triad: a link on three legs, each pinned to the input link or to the ground.

The pin of a two-force member pushes along the leg; the transmission angle there is the angle between the leg and the
normal of the path of the pushed point (Alt's definition; Norton, Sec. 4.10, for the fourbar). With the input fixed, the
two other legs alone leave the carried link one freedom. In that motion the inner pin of the leg moves along
v, and with the leg's direction e the sine is

    sin μ = e · v / |v|.

The three sines vanish together, where the legs meet in one point or are parallel, which is a toggle. Near a toggle they
may differ greatly: if two legs meet at the third's pin, that pin is pushed well but hardly moves, and both others point
at it. So each leg has its own angle. The twist of the carried link, (v, ω) with v at the pin, is reciprocal to both
other legs' lines: e_i · v + (q_i × e_i) ω = 0, with q_i the inner pins relative to that one. So it is the vector
product of the two rows, including parallel legs.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.planar.mechanism import GROUND, Mechanism


class Leg(NamedTuple):
    """A link with an outer pin on the input link or the ground, and an inner pin on the carried link."""

    link: str
    outer: str
    inner: str


Triad = tuple[Leg, Leg, Leg]
"""Two legs on one link (input or ground), and the third."""


def find_triad(mechanism: Mechanism) -> Triad | None:
    """Find the triad of a class III mechanism of four links besides input and ground; None for another structure."""
    moving = [name for name in mechanism.links if name not in (GROUND, mechanism.input)]
    if len(moving) != 4 or mechanism.slides or mechanism.gears:
        return None
    for carried in moving:
        legs: dict[str, list[Leg]] = {GROUND: [], mechanism.input: []}
        for name in moving:
            if name == carried:
                continue
            inner = [joint for joint in mechanism.links[name] if joint in mechanism.links[carried]]
            for end, listed in legs.items():
                outer = [joint for joint in mechanism.links[name] if joint in mechanism.links[end]]
                if len(inner) == len(outer) == 1 and inner != outer:
                    listed.append(Leg(name, outer[0], inner[0]))
        # Two legs on one end and one on the other make a triad.
        counts = sorted(len(listed) for listed in legs.values())
        if counts == [1, 2]:
            one, two = sorted(legs.values(), key=len)
            return two[0], two[1], one[0]
    return None


def compute_triad_sines(triad: Triad, joints: dict[str, Complex]) -> dict[str, Real]:
    """Compute the sines of the transmission angles by the legs' links, all of one sign, each of the joints' shape.

    The sine is 0 where a pin cannot move.
    """
    return {leg.link: _compute_sine(joints, leg, triad[n - 2], triad[n - 1]) for n, leg in enumerate(triad)}


def _compute_sine(joints: dict[str, Complex], leg: Leg, *others: Leg) -> Real:
    """Compute the sine of the transmission angle at a leg, given the two other legs."""
    pin = joints[leg.inner]
    with np.errstate(divide="ignore", invalid="ignore"):  # NaN where the mechanism cannot be assembled
        e1, e2 = (_compute_direction(joints, other) for other in others)
        q1, q2 = (joints[other.inner] - pin for other in others)
        m1, m2 = np.imag(np.conj(q1) * e1), np.imag(np.conj(q2) * e2)
        moved = (e1.imag * m2 - m1 * e2.imag) + 1j * (m1 * e2.real - e1.real * m2)
        sine = np.real(np.conj(_compute_direction(joints, leg)) * moved) / np.abs(moved)
    return np.asarray(np.where(moved == 0.0, 0.0, sine))


def _compute_direction(joints: dict[str, Complex], leg: Leg) -> Complex:
    vector = joints[leg.inner] - joints[leg.outer]
    return np.asarray(vector / np.abs(vector))


__all__ = ["Leg", "Triad", "compute_triad_sines", "find_triad"]
