"""Measures of whether a linkage can be built: distances of its pins, and the widest links that planes allow.

A design without an arrangement in planes cannot be built at any size. A design that needs links narrower than
:data:`MIN_RELATIVE_WIDTH` of its longest link can be drawn but hardly made. Both are listed after all others
(:mod:`synthesis.results.practicality`). A block ``layout`` in the problem gives the width and the pins instead.
"""

from __future__ import annotations

from itertools import combinations
from typing import TypeVar

from kinematics.errors import MechanismError
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.model.answer import Verification
from synthesis.model.dimension import LENGTH
from synthesis.model.linkage.answer import BuildMetrics
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.protocols import DrivenDesign, SkeletonMechanism
from synthesis.verification.checks import check_minimum
from synthesis.verification.reconstruction import rebuild_mechanism

Design = TypeVar("Design", bound=DrivenDesign)

MIN_RELATIVE_WIDTH = 0.02
"""Minimum width of the links of a design that can be built, as a share of its longest link: a link of 100 mm is at
least 2 mm wide, a fifth of the default width of parts."""

COINCIDENCE_TOLERANCE = 1e-9
"""Distance of two pins, as a share of the longest link, below which they are one pin."""


def measure_build(problem: LinkageProblem, design: Design) -> Design:
    """Return a design with the measures of whether it can be built; unchanged if it already has them."""
    metrics = design.metrics
    if not isinstance(metrics, BuildMetrics) or metrics.min_pin_distance is not None:
        return design
    mechanism = rebuild_mechanism(design.mechanism, from_skeleton=True)
    if mechanism is None:
        return design
    pins, longest = measure_pin_distances(design.mechanism)
    width = _find_greatest_width(problem, mechanism, metrics)
    measured = {
        "min_pin_distance": pins,
        "max_link_width": width,
        "relative_link_width": None if width is None else width / longest,
    }
    return design.model_copy(update={"metrics": metrics.model_copy(update=measured)})


def is_buildable(design: DrivenDesign) -> bool:
    """Return whether a measured design can be built: with the sizes of the problem, otherwise with links of any size.

    A design that could not be measured counts as buildable.
    """
    if design.layout is not None:
        return design.layout.buildable
    metrics = design.metrics
    width = metrics.relative_link_width if isinstance(metrics, BuildMetrics) else None
    return width is None or width >= MIN_RELATIVE_WIDTH


def measure_pin_distances(mechanism: SkeletonMechanism) -> tuple[float, float]:
    """Measure the minimum distance of two different pins of one link, and the longest distance of two of its joints."""
    skeleton = mechanism.skeleton
    at = {name: complex(*place) for name, place in skeleton.joints.items()}
    links = [*(link.joints for link in skeleton.links)]
    sliding = {slide.joint for slide in skeleton.slides}
    # A joint of a single link without a slide, such as P, is a point and no pin.
    pins = {name for name in at if name in sliding or sum(name in joints for joints in links) > 1}
    sides = [abs(at[a] - at[b]) for joints in links for a, b in combinations(joints, 2)]
    longest = max(sides)
    apart = [abs(at[a] - at[b]) for joints in links for a, b in combinations([n for n in joints if n in pins], 2)]
    return min((side for side in apart if side > COINCIDENCE_TOLERANCE * longest), default=longest), longest


def check_pin_distance(problem: LinkageProblem, design: Design) -> Design:
    """Return a candidate with the check that the pins of each link keep the gap of the problem's layout."""
    sizes = problem.layout
    if sizes is None or any(check.name == "pin_distance" for check in design.verification.checks):
        return design
    least = measure_pin_distances(design.mechanism)[0]
    check = check_minimum("pin_distance", least, sizes.pin_diameter + sizes.gap, LENGTH)
    verification = Verification.from_checks([*design.verification.checks, check])
    return design.model_copy(update={"verification": verification})


def _find_greatest_width(problem: LinkageProblem, mechanism: Mechanism, metrics: BuildMetrics) -> float | None:
    # Local imports: the kernels for distances are loaded only once a design exists.
    from kinematics.linkage.layout import find_greatest_width
    from synthesis.analyses.linkages.cycle import find_built_range, get_used_range

    over = None if problem.layout is None else problem.layout.over
    try:
        used = find_built_range(mechanism, get_used_range(metrics), over)
        return None if used is None else find_greatest_width(mechanism, *used)
    # Too many plates to arrange, or a motion that cannot be driven: unknown.
    except MechanismError:
        return None
