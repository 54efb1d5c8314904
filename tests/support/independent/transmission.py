"""Transmission angles of a linkage, read off its joints: at each pair of links that follows from what moves already.

Two bars that meet in a pin: the acute angle between them. A bar to a pin on a line of the ground: the acute angle
between the bar and the line's normal. A link about a pin that slides past another pin: what the acute angle between its
line and the way from pin to pin lacks of a right one. A coupler on three bars, where no pair of links follows: at each
the acute angle between the bar and the normal of its pin's path, which passes the instant centre where the two others
meet.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import combinations

import numpy as np

from kinematics.arrays import Complex, Real
from tests.support.independent.drive import Drive
from tests.support.independent.extremes import least

Angle = Callable[[Complex], Real]


def acute(one: Complex, other: Complex) -> Real:
    """Acute angles between directions, radians."""
    return np.arctan2(np.abs((np.conj(one) * other).imag), np.abs((np.conj(one) * other).real))


def closures(drive: Drive) -> dict[frozenset[str], Angle]:
    """Transmission angles at joints (n, joints), by the one or two links that they belong to."""
    moving = {name: joints for name, joints in drive.links.items() if name != "ground"}
    known = set(drive.known)
    done = {name for name, joints in moving.items() if set(joints) <= known}
    found: dict[frozenset[str], Angle] = {}
    while len(done) < len(moving):
        new = _sliding(drive, moving, known, done) or _pair(moving, known, done) or _triad(moving, known, done)
        if new is None:
            raise ValueError("no closure for " + ", ".join(sorted(set(moving) - done)))
        found.update(new)
        for name in frozenset().union(*new):
            known.update(moving[name])
        done |= {name for name, joints in moving.items() if set(joints) <= known}
    return found


def _sliding(
    drive: Drive, moving: dict[str, list[int]], known: set[int], done: set[str]
) -> dict[frozenset[str], Angle] | None:
    for joint, link, _, along in drive.slides:
        if link == "ground" and joint not in known:
            for name, joints in moving.items():
                held = [k for k in joints if k in known]
                if joint in joints and held:
                    return {frozenset({name}): _to_line(held[0], joint, along)}
        elif link != "ground" and link not in done and joint in known:
            held = [k for k in moving[link] if k in known]
            if held:
                i, j = moving[link][:2]
                return {frozenset({link}): _past(held[0], joint, i, j, along / (drive.home[j] - drive.home[i]))}
    return None


def _pair(moving: dict[str, list[int]], known: set[int], done: set[str]) -> dict[frozenset[str], Angle] | None:
    for one, other in combinations([name for name in moving if name not in done], 2):
        shared = (set(moving[one]) & set(moving[other])) - known
        ends = [[k for k in moving[name] if k in known] for name in (one, other)]
        if shared and all(ends):
            return {frozenset({one, other}): _between(min(shared), ends[0][0], ends[1][0])}
    return None


def _triad(moving: dict[str, list[int]], known: set[int], done: set[str]) -> dict[frozenset[str], Angle] | None:
    """A coupler on three links that the ground or the input hold."""
    for coupler in (name for name in moving if name not in done):
        legs: dict[str, tuple[int, int]] = {}
        for name in (name for name in moving if name not in done and name != coupler):
            pins = set(moving[name]) & set(moving[coupler])
            ends = [k for k in moving[name] if k in known]
            if pins and ends:
                legs[name] = ends[0], min(pins)
        if len(legs) == 3:
            return {
                frozenset({coupler, name}): _pushed(*(legs[other] for other in legs if other != name), leg)
                for name, leg in legs.items()
            }
    return None


def _to_line(pivot: int, pin: int, along: complex) -> Angle:
    """A bar from a pivot to a pin on a line of the ground."""
    return lambda z: 0.5 * math.pi - acute(z[:, pin] - z[:, pivot], np.full(len(z), along))


def _past(pivot: int, pin: int, i: int, j: int, lean: complex) -> Angle:
    """A link about a pivot whose line, at a fixed angle to its joints i and j, passes a pin."""
    return lambda z: 0.5 * math.pi - acute(z[:, pin] - z[:, pivot], (z[:, j] - z[:, i]) * lean)


def _between(pin: int, first: int, second: int) -> Angle:
    """Two bars that meet in a pin."""
    return lambda z: acute(z[:, first] - z[:, pin], z[:, second] - z[:, pin])


def _pushed(one: tuple[int, int], other: tuple[int, int], pusher: tuple[int, int]) -> Angle:
    """A coupler on two bars, and the one that pushes it: each from its outer pin to the coupler's."""

    def angle(z: Complex) -> Real:
        # The instant centre lies on both links.
        crank, rocker = (z[:, pin] - z[:, pivot] for pivot, pin in (one, other))
        share = ((z[:, other[0]] - z[:, one[0]]) * np.conj(rocker)).imag / (crank * np.conj(rocker)).imag
        d, c = pusher
        return acute(z[:, d] - z[:, c], z[:, one[0]] + share * crank - z[:, c])

    return angle


def least_angles(drive: Drive, low: float, high: float) -> dict[frozenset[str], float]:
    """The least of each transmission angle while the input goes from one turn to another, degrees."""

    def at(angle: Angle) -> float:
        return math.degrees(least(lambda turns: angle(drive.at(turns)), low, high).value)

    return {links: at(angle) for links, angle in closures(drive).items()}
