"""Measured properties of every driven linkage: transmission angle, link ratio, size, and quality.

    quality = sin μ / ((1 + (reach/3)²) · (1 + (ratio/8)²))

with the minimum transmission angle μ, the reach and the link ratio, combines the first concerns of a designer: good
force transmission, a linkage that is small for its task, and links of similar lengths. docs/methods/ranking.md explains
the numbers and defines the size of the task for each kind of problem.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from itertools import combinations
from typing import NamedTuple, Self

import numpy as np
from pydantic import BaseModel

from kinematics.arrays import Complex
from kinematics.compiling import njit
from kinematics.linkage.fourbar import Fourbar, barker_class
from kinematics.linkage.fourbar.classification import BarkerClass
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from synthesis.model.json_object import JsonObject
from synthesis.model.protocols import LinkageMeasures, SkeletonMechanism

REACH_SCALE = 3.0
"""Reach, in task sizes, that halves the quality: such a linkage is large for its task."""

LINK_RATIO_SCALE = 8.0
"""Link ratio that halves the quality; practice keeps link ratios below about 10."""

ROTATING_INPUT_CLASSES = ("double_crank", "crank_rocker")
"""Grashof classes of fourbars whose input rotates fully."""


@njit(cache=True, nogil=True)
def compute_quality(transmission_sine: float, reach: float, link_ratio: float) -> float:
    """Compute the quality, between 0 and 1.

    Parameters
    ----------
    transmission_sine : float
        Sine of the minimum transmission angle over the used range.
    reach : float
        Maximum distance between two joints of one link, in task sizes.
    link_ratio : float
        Longest link over shortest link.
    """
    return transmission_sine / ((1.0 + (reach / REACH_SCALE) ** 2) * (1.0 + (link_ratio / LINK_RATIO_SCALE) ** 2))


class Measures(NamedTuple):
    """Measured properties of every driven linkage, named like the fields of an answer's metrics.

    Attributes
    ----------
    grashof, barker : str or None
        Class and code of the fourbar that the linkage is or contains; None for others.
    min_transmission_angle : float
        Minimum over the used range, degrees; the minimum of ``transmission_angles``.
    transmission_angles : dict of str to float
        Minimum over the used range at each closure, by the name of its first link, and at each leg of a triad, degrees.
    same_branch, visits_in_order, full_rotation : bool
        Whether no toggle lies in the used range, targets are visited in order, and the input rotates fully.
    link_ratio : float
        Longest of ``lengths`` over shortest.
    reach : float or None
        Maximum distance between two joints of one link, in task sizes; None if the task has no size.
    size : float
        Diagonal of the box around all joints: at the targets, or over the motion for kinds without targets.
    quality : float
        Quality, between 0 and 1.
    used_range, used_stroke : (float, float) or None
        First and last input of the measured motion: absolute angles (degrees) of a rotating input, or positions of a
        sliding input along its line (length units). The field for the other type of input is None; both are None if no
        motion passes through the targets.
    lengths : list of float
        Link lengths; not part of an answer.
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

    @classmethod
    def from_metrics(cls, metrics: LinkageMeasures, lengths: list[float]) -> Self:
        """Return the properties of a linkage from its metrics in an answer; a property that they lack is None."""
        known = metrics.model_dump(include=set(cls._fields))
        return cls(**{**dict.fromkeys(cls._fields), **known, "lengths": lengths})

    def select_fields(self, metrics: type[BaseModel]) -> JsonObject:
        """Return the measured properties for which a metrics model has a field."""
        return {name: getattr(self, name) for name in _list_common_fields(metrics)}


@cache
def _list_common_fields(metrics: type[BaseModel]) -> tuple[str, ...]:
    return tuple(name for name in Measures._fields if name in metrics.model_fields)


def measure_linkage(
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
    """Assemble the measured properties of a driven linkage.

    Parameters
    ----------
    lengths : list of float
        Link lengths, from :func:`list_link_lengths` or :func:`list_joint_distances`.
    reach : float
        Maximum distance between two joints of one link, from :func:`measure_reach` or :func:`measure_fourbar_reach`.
    task : float
        Size of the task, length units; infinite for a task without size, so that the reach does not count.
    transmission : mapping of str to float
        Minimum transmission angle at each closure over the used range, radians; empty without a used range.
    places : complex, shape (n,)
        Positions of the joints: at the targets, or along the motion for kinds without targets.
    barker, same_branch, visits_in_order, full_rotation
        As in :class:`Measures`.
    used : (float, float) or None
        First and last input of the measured motion, radians or length units; None if no motion passes through the
        targets.
    slides : bool
        Whether the input slides.
    eased : float
        Additional factor of the quality for a linkage that carries a body, from
        :func:`synthesis.verification.body_motion.compute_ease`.
    """
    # Without a used range there are no angles. The worst one, 0, makes the quality 0.
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
        # The size of a task without size is infinite: the reach then drops out of the quality and is not reported.
        reach=reach / task if math.isfinite(task) else None,
        size=measure_diagonal(places),
        quality=eased * compute_quality(math.sin(least), reach / task, ratio),
        used_range=None if used is None or slides else (math.degrees(used[0]), math.degrees(used[1])),
        used_stroke=used if slides else None,
        lengths=lengths,
    )


def list_link_lengths(mechanism: SkeletonMechanism) -> list[float]:
    """Return the link lengths of an answer's mechanism, without arms of length 0, which are not links."""
    links = mechanism.links.model_dump() if isinstance(mechanism.links, BaseModel) else mechanism.links
    return [length for length in links.values() if length > 0.0]


def list_joint_distances(mechanism: Mechanism) -> list[float]:
    """Return all distances between two joints of one link, including the ground and the coupler with its point."""
    return [
        abs(complex(mechanism.joints[first] - mechanism.joints[second]))
        for joints in mechanism.links.values()
        for first, second in combinations(joints, 2)
    ]


def measure_reach(mechanism: Mechanism) -> float:
    """Return the maximum distance between two joints of one link."""
    return max(list_joint_distances(mechanism))


def measure_fourbar_reach(linkage: Fourbar) -> float:
    """Return the maximum distance between two joints of one link, for a fourbar in closed form."""
    point, coupler = complex(linkage.coupler_point), float(linkage.coupler)
    ground = abs(complex(linkage.output_pivot - linkage.input_pivot))
    return max(ground, float(linkage.input), coupler, float(linkage.output), abs(point), abs(point - coupler))


def measure_diagonal(places: Complex) -> float:
    """Return the diagonal of the box around the finite points; 0 if there are none."""
    # NaN marks inputs at which the linkage does not close.
    known = places[np.isfinite(places)]
    return math.hypot(np.ptp(known.real), np.ptp(known.imag)) if known.size else 0.0


def list_fixed_pivots(mechanism: Mechanism) -> list[complex]:
    """Return the positions of the joints of the ground."""
    return [complex(mechanism.joints[name]) for name in mechanism.links[GROUND]]


def list_moving_pivots(mechanism: Mechanism) -> list[complex]:
    """Return the reference positions of all joints except those of the ground and P."""
    # P is a point of a link, not a pivot.
    still = {*mechanism.links[GROUND], "P"}
    return [complex(place) for name, place in mechanism.joints.items() if name not in still]


def classify_fourbar(mechanism: Mechanism, *joints: str) -> BarkerClass:
    """Classify (Grashof, Barker) the fourbar with the joints O2, A, B, O4, or with other joints in that order."""
    o2, a, b, o4 = (complex(mechanism.joints[name]) for name in joints or ("O2", "A", "B", "O4"))
    return barker_class(Fourbar(o2, o4, abs(a - o2), abs(b - a), abs(b - o4)))


def classify_inner_fourbar(mechanism: Mechanism) -> BarkerClass | None:
    """Classify the fourbar O2 A B O4 within a linkage; None if it contains none, such as a Stephenson II sixbar."""
    sides = ({"O2", "A"}, {"A", "B"}, {"B", "O4"}, {"O4", "O2"})
    # Each pair of neighbouring joints must belong to one link; some sixbars have no such loop.
    joined = all(any(side <= set(joints) for joints in mechanism.links.values()) for side in sides)
    return classify_fourbar(mechanism) if joined else None
