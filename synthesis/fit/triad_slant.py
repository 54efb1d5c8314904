"""How slantwise a Stephenson II sixbar pushes its output, seen from its input link, with rates.

Link 4 moves on the input link by the links 3 and 5, legs O₂A and O₄B, and pushes the output by a pin q; the output's
other pin j is on the ground. The triad transmits by the angle between the output and the normal of the way on which q
is pushed (:mod:`kinematics.linkage.planar.triad_transmission`, by whose formula the core measures it; here the way is
that about the pole of link 4 and the input). As long as its sine does not vanish, the input goes on where link 3 does.
"""

from __future__ import annotations

from kinematics.compiling import njit


@njit(cache=True, nogil=True, error_model="numpy")
def dot(u: complex, v: complex) -> float:
    """The scalar product of two vectors."""
    return u.real * v.real + u.imag * v.imag


@njit(cache=True, nogil=True, error_model="numpy")
def cross(u: complex, v: complex) -> float:
    """The vector product of two vectors."""
    return u.real * v.imag - u.imag * v.real


@njit(cache=True, nogil=True, error_model="numpy")
def pushed(q: complex, o2: complex, a: complex, o4: complex, b: complex) -> complex:
    """The direction in which the pin q of link 4 moves: at right angles to the way from the pole, where legs meet.

    It is multiplied by the cross product of the legs, so that it is there where they are parallel.
    """
    one, two = a - o2, b - o4
    # The pole is o2 + one · s with s = (o4 − o2) × two / (one × two).
    from_pole = (q - o2) * cross(one, two) - one * cross(o4 - o2, two)
    return from_pole * 1j


@njit(cache=True, nogil=True, error_model="numpy")
def slant(q: complex, j: complex, o2: complex, a: complex, o4: complex, b: complex) -> tuple[float, float]:
    """Cosine and signed sine of the transmission angle at the output; NaN where its pin cannot move."""
    way, leg = pushed(q, o2, a, o4, b), q - j
    size = abs(way) * abs(leg)
    return cross(leg, way) / size, dot(leg, way) / size


@njit(cache=True, nogil=True, error_model="numpy")
def pushed_rate(
    q: complex, o2: complex, a: complex, o4: complex, b: complex, by_q: complex, by_o2: complex, by_a: complex,
    by_o4: complex, by_b: complex,
) -> complex:  # fmt: skip
    """The rate of :func:`pushed` from those of the joints."""
    one, two, between = a - o2, b - o4, o4 - o2
    crossed, along = cross(one, two), cross(between, two)
    by_one, by_two = by_a - by_o2, by_b - by_o4
    by_crossed = cross(by_one, two) + cross(one, by_two)
    by_along = cross(by_o4 - by_o2, two) + cross(between, by_two)
    from_pole = (by_q - by_o2) * crossed + (q - o2) * by_crossed - by_one * along - one * by_along
    return from_pole * 1j


@njit(cache=True, nogil=True, error_model="numpy")
def slant_rate(leg: complex, way: complex, by_leg: complex, by_way: complex) -> float:
    """The rate of the cosine from leg and way, q − j and :func:`pushed`, and theirs."""
    long, wide = abs(leg), abs(way)
    cosine = cross(leg, way) / (long * wide)
    rate = (cross(by_leg, way) + cross(leg, by_way)) / (long * wide)
    return rate - cosine * (dot(leg, by_leg) / (long * long) + dot(way, by_way) / (wide * wide))
