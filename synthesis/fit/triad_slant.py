"""How slantwise the three legs of a Stephenson II's triad push its link 4, seen from the input link, with rates.

Link 4 moves on the input link by the links 3 and 5, legs O₂A and O₄B, and on the ground by the output, leg jq: j is the
output's pin on the ground, q its other one. The transmission angle at a leg is that between it and the normal of the
way on which its pin on link 4 is moved by the other two (:mod:`kinematics.linkage.planar.triad_transmission`, by whose
formula the core measures it; here the way is that about the pole, where the other two legs meet). As long as the sines
do not vanish, which they do together, the input goes on where link 3 does.
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
def find_push_direction(q: complex, o2: complex, a: complex, o4: complex, b: complex) -> complex:
    """The direction in which the pin q of link 4 moves: at right angles to the way from the pole, where legs meet.

    It is multiplied by the cross product of the legs, so that it is there where they are parallel.
    """
    one, two = a - o2, b - o4
    # The pole is o2 + one · s with s = (o4 − o2) × two / (one × two).
    from_pole = (q - o2) * cross(one, two) - one * cross(o4 - o2, two)
    return from_pole * 1j


@njit(cache=True, nogil=True, error_model="numpy")
def permute_legs(
    leg: int, q: complex, j: complex, o2: complex, a: complex, o4: complex, b: complex
) -> tuple[complex, complex, complex, complex, complex, complex]:
    """The same pins, or their rates, with a leg in the output's place and the others after it in a circle.

    ``leg``: 0 for the output, 1 for link 3, 2 for link 5.
    """
    if leg == 1:
        return a, o2, o4, b, j, q
    if leg == 2:
        return b, o4, j, q, o2, a
    return q, j, o2, a, o4, b


@njit(cache=True, nogil=True, error_model="numpy")
def compute_leg_slant(
    leg: int, q: complex, j: complex, o2: complex, a: complex, o4: complex, b: complex
) -> tuple[float, float]:
    """Signed cosine and sine of the transmission angle at a leg; NaN where its pin cannot move."""
    q, j, o2, a, o4, b = permute_legs(leg, q, j, o2, a, o4, b)
    way, bar = find_push_direction(q, o2, a, o4, b), q - j
    size = abs(way) * abs(bar)
    return cross(bar, way) / size, dot(bar, way) / size


@njit(cache=True, nogil=True, error_model="numpy")
def find_min_slant(
    q: complex, j: complex, o2: complex, a: complex, o4: complex, b: complex
) -> tuple[float, float, int]:
    """Cosine and sine of the least of the three transmission angles, and the leg at which it is.

    The sine has the sign of the determinant of the legs' lines, whichever the leg is.
    """
    cosine, sine = compute_leg_slant(0, q, j, o2, a, o4, b)
    least = 0
    for leg in range(1, 3):
        along, across = compute_leg_slant(leg, q, j, o2, a, o4, b)
        if abs(across) < abs(sine):
            cosine, sine, least = along, across, leg
    return cosine, sine, least


@njit(cache=True, nogil=True, error_model="numpy")
def differentiate_push_direction(
    q: complex, o2: complex, a: complex, o4: complex, b: complex, by_q: complex, by_o2: complex, by_a: complex,
    by_o4: complex, by_b: complex,
) -> complex:  # fmt: skip
    """The rate of :func:`find_push_direction` from those of the joints."""
    one, two, between = a - o2, b - o4, o4 - o2
    crossed, along = cross(one, two), cross(between, two)
    by_one, by_two = by_a - by_o2, by_b - by_o4
    by_crossed = cross(by_one, two) + cross(one, by_two)
    by_along = cross(by_o4 - by_o2, two) + cross(between, by_two)
    from_pole = (by_q - by_o2) * crossed + (q - o2) * by_crossed - by_one * along - one * by_along
    return from_pole * 1j


@njit(cache=True, nogil=True, error_model="numpy")
def differentiate_slant(leg: complex, way: complex, by_leg: complex, by_way: complex) -> float:
    """The rate of the cosine from leg and way, q − j and :func:`find_push_direction`, and theirs."""
    long, wide = abs(leg), abs(way)
    cosine = cross(leg, way) / (long * wide)
    rate = (cross(by_leg, way) + cross(leg, by_way)) / (long * wide)
    return rate - cosine * (dot(leg, by_leg) / (long * long) + dot(way, by_way) / (wide * wide))


@njit(cache=True, nogil=True, error_model="numpy")
def differentiate_leg_slant(
    leg: int, pins: tuple[complex, complex, complex, complex, complex, complex],
    rates: tuple[complex, complex, complex, complex, complex, complex],
) -> float:  # fmt: skip
    """The rate of the cosine at a leg from the six pins, in the order of :func:`find_min_slant`, and theirs."""
    q, j, o2, a, o4, b = permute_legs(leg, *pins)
    by_q, by_j, by_o2, by_a, by_o4, by_b = permute_legs(leg, *rates)
    by_way = differentiate_push_direction(q, o2, a, o4, b, by_q, by_o2, by_a, by_o4, by_b)
    return differentiate_slant(q - j, find_push_direction(q, o2, a, o4, b), by_q - by_j, by_way)
