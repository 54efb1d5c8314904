"""Transmission angles at the three legs of a Stephenson II's triad, seen from the input link, with derivatives.

Link 4 is guided on the input link by the links 3 and 5, legs O₂A and O₄B, and on the ground by the output, leg jq: j is
the output's pin on the ground and q its other pin. The transmission angle at a leg is the angle between the leg and the
normal of the path on which the other two legs guide its pin on link 4
(:mod:`kinematics.linkage.planar.triad_transmission` has the formula that the core uses; here the path is the one about
the pole, the intersection of the other two legs). While the sines do not vanish, which they do together, the input
moves on whenever link 3 does.
"""

from __future__ import annotations

from kinematics.compiling import njit


@njit(cache=True, nogil=True, error_model="numpy")
def dot(u: complex, v: complex) -> float:
    """Return the scalar product of two vectors."""
    return u.real * v.real + u.imag * v.imag


@njit(cache=True, nogil=True, error_model="numpy")
def cross(u: complex, v: complex) -> float:
    """Return the vector product of two vectors."""
    return u.real * v.imag - u.imag * v.real


@njit(cache=True, nogil=True, error_model="numpy")
def find_push_direction(q: complex, o2: complex, a: complex, o4: complex, b: complex) -> complex:
    """Return the direction in which pin q of link 4 moves, normal to the line from the pole, where two legs meet.

    It is multiplied by the cross product of the legs, so that it also exists for parallel legs.
    """
    one, two = a - o2, b - o4
    # The pole is o2 + one · s with s = (o4 − o2) × two / (one × two).
    from_pole = (q - o2) * cross(one, two) - one * cross(o4 - o2, two)
    return from_pole * 1j


@njit(cache=True, nogil=True, error_model="numpy")
def permute_legs(
    leg: int, q: complex, j: complex, o2: complex, a: complex, o4: complex, b: complex
) -> tuple[complex, complex, complex, complex, complex, complex]:
    """Return the same pins, or their rates, with a leg in the output's place and the others after it in cyclic order.

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
    """Return the signed cosine and sine of the transmission angle at a leg; NaN if its pin cannot move."""
    q, j, o2, a, o4, b = permute_legs(leg, q, j, o2, a, o4, b)
    way, bar = find_push_direction(q, o2, a, o4, b), q - j
    size = abs(way) * abs(bar)
    return cross(bar, way) / size, dot(bar, way) / size


@njit(cache=True, nogil=True, error_model="numpy")
def find_min_slant(
    q: complex, j: complex, o2: complex, a: complex, o4: complex, b: complex
) -> tuple[float, float, int]:
    """Return the cosine and sine of the smallest of the three transmission angles, and its leg.

    The sine has the sign of the determinant of the legs' lines, for any of the legs.
    """
    cosine, sine = compute_leg_slant(0, q, j, o2, a, o4, b)
    least = 0
    for leg in range(1, 3):
        along, across = compute_leg_slant(leg, q, j, o2, a, o4, b)
        # The smallest angle has the smallest |sine|; comparing it avoids the arc function.
        if abs(across) < abs(sine):
            cosine, sine, least = along, across, leg
    return cosine, sine, least


@njit(cache=True, nogil=True, error_model="numpy")
def differentiate_push_direction(
    q: complex, o2: complex, a: complex, o4: complex, b: complex, by_q: complex, by_o2: complex, by_a: complex,
    by_o4: complex, by_b: complex,
) -> complex:  # fmt: skip
    """Return the rate of :func:`find_push_direction`, given the rates of the joints."""
    # Product rule, term by term, of the expression in find_push_direction.
    one, two, between = a - o2, b - o4, o4 - o2
    crossed, along = cross(one, two), cross(between, two)
    by_one, by_two = by_a - by_o2, by_b - by_o4
    by_crossed = cross(by_one, two) + cross(one, by_two)
    by_along = cross(by_o4 - by_o2, two) + cross(between, by_two)
    from_pole = (by_q - by_o2) * crossed + (q - o2) * by_crossed - by_one * along - one * by_along
    return from_pole * 1j


@njit(cache=True, nogil=True, error_model="numpy")
def differentiate_slant(leg: complex, way: complex, by_leg: complex, by_way: complex) -> float:
    """Return the rate of the cosine, given the leg q − j, its path direction and the rates of both."""
    long, wide = abs(leg), abs(way)
    cosine = cross(leg, way) / (long * wide)
    rate = (cross(by_leg, way) + cross(leg, by_way)) / (long * wide)
    # Quotient rule: normalizing both vectors subtracts their relative growth.
    return rate - cosine * (dot(leg, by_leg) / (long * long) + dot(way, by_way) / (wide * wide))


@njit(cache=True, nogil=True, error_model="numpy")
def differentiate_leg_slant(
    leg: int, pins: tuple[complex, complex, complex, complex, complex, complex],
    rates: tuple[complex, complex, complex, complex, complex, complex],
) -> float:  # fmt: skip
    """Return the rate of the cosine at a leg, given the six pins and their rates in the order of
    :func:`find_min_slant`."""
    q, j, o2, a, o4, b = permute_legs(leg, *pins)
    by_q, by_j, by_o2, by_a, by_o4, by_b = permute_legs(leg, *rates)
    by_way = differentiate_push_direction(q, o2, a, o4, b, by_q, by_o2, by_a, by_o4, by_b)
    return differentiate_slant(q - j, find_push_direction(q, o2, a, o4, b), by_q - by_j, by_way)
