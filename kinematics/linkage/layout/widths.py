"""Greatest width of the links with which a linkage can be arranged in planes.

Pins, with their washers and heads, are taken as wide as the links, and no gap is required. Two parts then collide if
the distance of their cores (the hulls of joints, and the axes of pins) falls below a width of their own: the width w
itself for links and pins, and twice the distance of an axis or a hull from a gear, which keeps its radius. A linkage
can be built up to a width if planes exist for all pairs with smaller widths of their own, which bisection over the
sorted widths finds.

Distances are sampled over the motion, a degree apart over a full turn. Between two samples they may be smaller,
typically by less than a hundredth of the mechanism's size: greater widths are reliable, and smaller ones are too small
to be made.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.linkage.clearance.scene import Scene
from kinematics.linkage.layout.parts import Division, Parts, build_parts
from kinematics.linkage.layout.plan import is_buildable_in_planes, list_separable_pairs
from kinematics.linkage.layout.split_links import is_buildable_divided, list_divided_pairs, list_divisions
from kinematics.linkage.planar.mechanism import Mechanism

SAMPLE_COUNT = 361
"""Number of inputs at which distances are measured: a degree apart over a full turn."""

RELIABLE_SHARE = 0.01
"""Width, as a share of the mechanism's size, below which distances between two samples may be smaller."""

CONTACT_TOLERANCE = 1e-9
"""Width, as a share of the mechanism's size, up to which cores touch: rounding."""


def find_greatest_width(mechanism: Mechanism, low: float, high: float) -> float:
    """Find the greatest width of links and pins with which a linkage can be arranged in planes.

    Shafts may be held on one side or on both. If there is no arrangement between two bases at a reliable width, one
    link may be divided (:mod:`~kinematics.linkage.layout.split_links`).

    Parameters
    ----------
    mechanism : Mechanism
        One design, of shape ().
    low, high : float
        Minimum and maximum input of the motion, radians or positions along the input slide.

    Returns
    -------
    float
        In length units, at most the smallest distance of two pins of a link; 0 if there is no arrangement.

    Raises
    ------
    MechanismError
        For gears without shafts, and for more plates than can be arranged.
    """
    size = max(abs(complex(z) - complex(w)) for z, w in combinations(mechanism.joints.values(), 2))
    inputs = np.linspace(low, high, SAMPLE_COUNT) if high > low else np.array([low])
    parts = build_parts(mechanism, 0.0, 0.0, low, high)
    pairs = list_separable_pairs(parts)
    widths = _measure_widths(mechanism, parts, [_number_parts(len(parts.plates), *pair) for pair in pairs], inputs)

    def is_buildable(met: Sequence[int]) -> bool:
        meeting = [pairs[n] for n in met]
        return any(is_buildable_in_planes(parts, meeting, through=through) for through in (False, True))

    greatest = _bisect_width(widths, size, is_buildable)
    if greatest >= RELIABLE_SHARE * size:
        return greatest
    return max(
        [greatest, *(_find_divided_width(mechanism, way, low, high, inputs) for way in list_divisions(mechanism))]
    )


def _number_parts(count: int, plates: tuple[int, ...], pins: tuple[int, ...]) -> tuple[int, int]:
    """Return the numbers of two parts, of which ``count`` are plates, and pins follow."""
    one, other = (*plates, *(count + n for n in pins))
    return one, other


def _find_divided_width(mechanism: Mechanism, division: Division, low: float, high: float, inputs: Real) -> float:
    """Find the greatest width with one link divided into two plates."""
    parts = build_parts(mechanism, 0.0, 0.0, low, high, division=division)
    pairs = list_divided_pairs(parts, division)
    size = max(abs(complex(z) - complex(w)) for z, w in combinations(mechanism.joints.values(), 2))

    def is_buildable(met: Sequence[int]) -> bool:
        return is_buildable_divided(parts, division, [pairs[n] for n in met])

    return _bisect_width(_measure_widths(mechanism, parts, pairs, inputs), size, is_buildable)


def _measure_widths(
    mechanism: Mechanism, parts: Parts, pairs: Sequence[tuple[int, int]], inputs: Real
) -> NDArray[np.float64]:
    """Measure for each pair of parts of width 0 the width at which they touch, shape (pairs,)."""
    outlines = [plate.outline for plate in parts.plates] + [pin.outline for pin in parts.pins]
    scene = Scene(mechanism, outlines, pairs)
    rows = np.repeat(np.arange(len(pairs)), len(inputs))
    apart = scene.distances(rows, np.tile(inputs, len(pairs)), np.zeros(len(rows)))[0].reshape(len(pairs), -1)
    # The ends of a range may be toggles, without a position.
    least = np.nanmin(np.where(np.isfinite(apart), apart, np.inf), axis=1)
    # Each part with a width contributes half of it; a gear has a radius of its own.
    growing = np.array([sum(outlines[n].radius == 0.0 for n in pair) for pair in pairs])
    with np.errstate(divide="ignore", invalid="ignore"):
        widths = np.where(growing > 0, 2.0 * least / growing, np.where(least >= 0.0, np.inf, 0.0))
    widths[widths <= CONTACT_TOLERANCE * scene.size] = 0.0
    return widths


def _bisect_width(widths: Real, most: float, is_buildable: Callable[[Sequence[int]], bool]) -> float:
    """Return the greatest width, at most ``most``, up to which the colliding pairs permit an arrangement."""
    # Only widths at which another pair begins to collide matter.
    steps = [0.0, *sorted({float(width) for width in widths if 0.0 < width < most}), most]

    def is_buildable_up_to(n: int) -> bool:
        return is_buildable([k for k in range(len(widths)) if widths[k] < steps[n]])

    # The narrowest links with any width at all: if they collide, all others do.
    if not is_buildable_up_to(1):
        return 0.0
    low, high = 1, len(steps)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if is_buildable_up_to(middle) else (low, middle)
    return steps[low]
