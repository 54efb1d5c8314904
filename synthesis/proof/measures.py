"""What an answer says of a driven linkage, whatever its kind: transmission, link ratio, size, and quality.

    quality = sin μ / ((1 + (reach/3)²) · (1 + (ratio/8)²))

weighs what a designer looks at before anything else: how well force is transmitted, whether the linkage is small for
its task, and whether its links can be built together. docs/ranking.md explains the numbers and lists what each kind of
problem takes as the size of its task.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from itertools import combinations
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from kinematics.compiling import njit
from kinematics.linkage.fourbar import Fourbar, barker_class
from kinematics.linkage.fourbar.classification import BarkerClass
from kinematics.linkage.planar.mechanism import GROUND, Mechanism

Complex = NDArray[np.complex128]

BULKY = 3.0
"""A reach of this many task sizes halves the quality: such a linkage is large for what it does."""

UNEVEN = 8.0
"""A link ratio of this halves the quality; practice keeps link ratios below about 10."""

TURNS_THROUGH = ("double_crank", "crank_rocker")
"""Grashof's classes of fourbars whose input turns through."""


@njit(cache=True, nogil=True)
def quality(transmission_sine: float, reach: float, link_ratio: float) -> float:
    """Quality between 0 and 1.

    Parameters
    ----------
    transmission_sine : float
        Sine of the least transmission angle over the used range.
    reach : float
        Greatest distance between two joints of one link, in task sizes.
    link_ratio : float
        Longest link over shortest.
    """
    return transmission_sine / ((1.0 + (reach / BULKY) ** 2) * (1.0 + (link_ratio / UNEVEN) ** 2))


class Dimensioned(Protocol):
    """A mechanism of any answer: its link lengths, by name or as a model of them."""

    @property
    def links(self) -> Mapping[str, float] | BaseModel:
        """Link lengths."""


class Measures(NamedTuple):
    """What is measured of every driven linkage; the names are those of the fields of an answer's metrics.

    Attributes
    ----------
    grashof, barker : str or None
        Class and code of the fourbar that the linkage is or contains; None for others.
    min_transmission_angle : float
        Over the used range, degrees; the least of ``transmission_angles``.
    transmission_angles : dict of str to float
        The least at each closure by the name of its first link, and at each leg of a triad, degrees.
    same_branch, visits_in_order, full_rotation : bool
        Whether no toggle lies on the way, the way is gone through in order, and the input turns through.
    link_ratio : float
        Longest of ``lengths`` over shortest.
    reach : float or None
        Greatest distance between two joints of one link, in task sizes; None where a task has none.
    size : float
        Diagonal of the box around all joints: at the targets, or over the motion of a kind that has none.
    quality : float
        Between 0 and 1.
    used_range, used_stroke : (float, float) or None
        First and last input of the motion that is measured: absolute, degrees; or places along the line of an input
        that slides, length units. None for the other kind of input, and where no motion leads through the targets.
    lengths : list of float
        Of the links; no field of an answer.
    """

    grashof: str | None
    barker: str | None
    min_transmission_angle: float
    transmission_angles: dict[str, float]
    same_branch: bool
    visits_in_order: bool
    full_rotation: bool
    link_ratio: float
    reach: float | None
    size: float
    quality: float
    used_range: tuple[float, float] | None
    used_stroke: tuple[float, float] | None
    lengths: list[float]

    def within(self, metrics: type[BaseModel]) -> dict[str, Any]:
        """Of the measures those that a model of metrics has a field for."""
        return {name: getattr(self, name) for name in _in_common(metrics)}


@cache
def _in_common(metrics: type[BaseModel]) -> tuple[str, ...]:
    return tuple(name for name in Measures._fields if name in metrics.model_fields)


def measured(
    lengths: list[float],
    reach: float,
    task: float,
    transmission: Mapping[str, float],
    places: Complex,
    *,
    barker: BarkerClass | None,
    same_branch: bool,
    visits_in_order: bool,
    full_rotation: bool,
    used: tuple[float, float] | None,
    slides: bool = False,
    eased: float = 1.0,
) -> Measures:
    """The measures of a driven linkage.

    Parameters
    ----------
    lengths : list of float
        Of the links, as :func:`link_lengths` or :func:`distances` lists them.
    reach : float
        Greatest distance between two joints of one link: of :func:`reach_of` or :func:`reach_of_fourbar`.
    task : float
        The size of the task, in length units; infinite where a task has none, so that reach does not count.
    transmission : mapping of str to float
        The least transmission angle at each closure over the used range, radians; empty where there is no such range.
    places : complex, shape (n,)
        Where the joints stand: at the targets, or along the motion of a kind that has none.
    barker, same_branch, visits_in_order, full_rotation
        As in :class:`Measures`.
    used : (float, float) or None
        First and last input of the motion along which all this was measured, radians or length units; None where no
        motion leads through the targets.
    slides : bool
        Whether the input slides.
    eased : float
        Factor of the quality, for a linkage that carries a body: see :func:`synthesis.proof.carried.ease`.
    """
    least = min(transmission.values(), default=0.0)
    ratio = max(lengths) / min(lengths)
    return Measures(
        grashof=None if barker is None else barker.motion,
        barker=None if barker is None else barker.code,
        min_transmission_angle=math.degrees(least),
        transmission_angles={link: math.degrees(angle) for link, angle in transmission.items()},
        same_branch=same_branch,
        visits_in_order=visits_in_order,
        full_rotation=full_rotation,
        link_ratio=ratio,
        reach=reach / task if math.isfinite(task) else None,
        size=diagonal(places),
        quality=eased * quality(math.sin(least), reach / task, ratio),
        used_range=None if used is None or slides else (math.degrees(used[0]), math.degrees(used[1])),
        used_stroke=used if slides else None,
        lengths=lengths,
    )


def link_lengths(mechanism: Dimensioned) -> list[float]:
    """Lengths of the links as an answer states them; a block's arm of no length is no link."""
    links = mechanism.links.model_dump() if isinstance(mechanism.links, BaseModel) else mechanism.links
    return [length for length in links.values() if length > 0.0]


def distances(mechanism: Mechanism) -> list[float]:
    """Distances between two joints of one link, the ground and the coupler with its point among them."""
    return [
        abs(complex(mechanism.joints[first] - mechanism.joints[second]))
        for joints in mechanism.links.values()
        for first, second in combinations(joints, 2)
    ]


def reach_of(mechanism: Mechanism) -> float:
    """The greatest of :func:`distances`."""
    return max(distances(mechanism))


def reach_of_fourbar(linkage: Fourbar) -> float:
    """The same of a fourbar that is driven in closed form."""
    point, coupler = complex(linkage.coupler_point), float(linkage.coupler)
    ground = abs(complex(linkage.output_pivot - linkage.input_pivot))
    return max(ground, float(linkage.input), coupler, float(linkage.output), abs(point), abs(point - coupler))


def diagonal(places: Complex) -> float:
    """Diagonal of the box around places, those that are finite; 0 where there are none."""
    known = places[np.isfinite(places)]
    return math.hypot(np.ptp(known.real), np.ptp(known.imag)) if known.size else 0.0


def fixed_pivots(mechanism: Mechanism) -> list[complex]:
    """Joints of the ground."""
    return [complex(mechanism.joints[name]) for name in mechanism.links[GROUND]]


def moving_pivots(mechanism: Mechanism) -> list[complex]:
    """All other joints but P, in the reference configuration."""
    still = {*mechanism.links[GROUND], "P"}
    return [complex(place) for name, place in mechanism.joints.items() if name not in still]


def barker_of(mechanism: Mechanism, *joints: str) -> BarkerClass:
    """Grashof's class and Barker's code of the fourbar with the joints O2, A, B, O4, or others in that order."""
    o2, a, b, o4 = (complex(mechanism.joints[name]) for name in joints or ("O2", "A", "B", "O4"))
    return barker_class(Fourbar(o2, o4, abs(a - o2), abs(b - a), abs(b - o4)))


def barker_within(mechanism: Mechanism) -> BarkerClass | None:
    """The class of the fourbar O2 A B O4 within a linkage; None where links do not join these, as of Stephenson II."""
    sides = ({"O2", "A"}, {"A", "B"}, {"B", "O4"}, {"O4", "O2"})
    joined = all(any(side <= set(joints) for joints in mechanism.links.values()) for side in sides)
    return barker_of(mechanism) if joined else None
