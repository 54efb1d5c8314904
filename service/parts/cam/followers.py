"""Outlines of flat-faced followers: the plate on a slide, and the arm on a pivot."""

from __future__ import annotations

import cmath
import math

from service.parts.geometry.regions import Loop

FACE_THICKNESS = 0.6
"""Thickness of the plate behind a face on a slide, in link widths."""

FACE_EXTENSION = 0.25
"""Extension of a face beyond its contact, in link widths."""


def make_face_slide(face: float, stem: float, reach: tuple[float, float], width: float, end: float) -> Loop:
    """Return a face normal to x, with a stem along x that has a round end.

    Parameters
    ----------
    face, stem : float
        x of the face and y of the stem's axis.
    reach : pair of float
        Minimum and maximum y of the contact.
    width : float
        Width of the stem.
    end : float
        x of the centre of its round end.
    """
    beyond, half = FACE_EXTENSION * width, 0.5 * width
    # The face covers all contacts and at least the stem.
    low, high = min(reach[0], stem - half) - beyond, max(reach[1], stem + half) + beyond
    back = face + FACE_THICKNESS * width
    corners = (
        complex(face, high), complex(face, low), complex(back, low), complex(back, stem - half),
        complex(end, stem - half), complex(end, stem + half), complex(back, stem + half), complex(back, high),
    )  # fmt: skip
    return Loop(corners, (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0))


def make_face_arm(offset: float, reach: tuple[float, float], width: float) -> Loop:
    """Return an arm about a pivot at the origin with a face along x, on the side +y.

    Parameters
    ----------
    offset : float
        y of the face.
    reach : pair of float
        Minimum and maximum x of the contact.
    width : float
        Width of the arm, and of the round end about its pivot.
    """
    radius = 0.5 * width
    tip = reach[1] + FACE_EXTENSION * width
    top, bottom = complex(tip, offset), complex(tip, offset - 0.8 * width)
    # From the tip along the face, then around the pivot, and back along a tangent.
    last = cmath.phase(bottom) - math.acos(min(1.0, radius / abs(bottom)))
    # The face passes above the round end, crosses it, or passes below it.
    if offset >= radius:
        start = complex(max(0.0, reach[0] - FACE_EXTENSION * width), offset)
        first = cmath.phase(start) + math.acos(min(1.0, radius / abs(start)))
        before = [top, start]
    elif offset > -radius:
        first = math.asin(offset / radius)
        before = [top]
    else:
        first = 0.0
        before = [top, complex(radius, offset)]
    turn = (last - first) % (2.0 * math.pi)
    # Two arcs, neither of which exceeds half a turn.
    around = [radius * cmath.exp(1j * (first + share * turn)) for share in (0.0, 0.5, 1.0)]
    corners, bulge = [*before, *around, bottom], math.tan(0.125 * turn)
    bulges = [0.0] * len(before) + [bulge, bulge, 0.0, 0.0]
    return Loop(tuple(corners), tuple(bulges))


def make_bell_crank(first: complex, second: complex, radius: float) -> Loop:
    """Return the outline of two bars with round ends that meet at a pivot at the origin.

    The second bar is counter-clockwise of the first by less than π.

    Parameters
    ----------
    first, second : complex
        Centres of the round ends.
    radius : float
        Half the width of the bars.
    """
    angle = cmath.phase(second / first)
    across = [-1j * radius * z / abs(z) for z in (first, second)]
    # Intersection of the inner sides of the two bars.
    inner = cmath.rect(radius / math.sin(0.5 * angle), cmath.phase(first) + 0.5 * angle)
    corners = (across[0], first + across[0], first - across[0], inner, second + across[1], second - across[1],
               -across[1])  # fmt: skip
    return Loop(corners, (0.0, 1.0, 0.0, 0.0, 1.0, 0.0, math.tan(0.25 * (math.pi - angle))))
