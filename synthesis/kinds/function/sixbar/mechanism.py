"""Conversion of a candidate sixbar to a mechanism with dials, and its placement.

A function generator works alike in any position, direction and size; for a Watt II also the size and direction of its
second fourbar relative to the first are free. These are chosen to keep link lengths similar, pivots in their regions,
and all joints in the box throughout the motion.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.planar.mechanism import GROUND
from synthesis.kinds.function.design import Dials
from synthesis.kinds.function.fourbar.task import DEFAULT_GROUND_LENGTH, FunctionTask, make_dials
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.sixbar.fits import SixbarCandidate, measure_motion
from synthesis.model.linkage.answer import EightbarMechanism, SixbarMechanism
from synthesis.model.linkage.conversion import to_complex
from synthesis.model.linkage.sixbars import Links, build_eightbar, build_sixbar, list_lengths
from synthesis.numerics.box_placement import ROUNDING_TOLERANCE, Boxes, Placement, place_in_boxes
from synthesis.results.placement import convert_regions

SAMPLE_COUNT = 49
"""Number of samples of the motion at which a sixbar must be within the box."""

DIRECTION_COUNT, SIZE_FACTORS = 24, (1.0, 0.6, 1.6)
"""Number of directions, and size factors, tried for the second fourbar of a Watt II. With factor 1 the geometric means
of longest and shortest link agree in both fourbars."""

HULL_DIRECTIONS = np.exp(1j * np.arange(48) * (math.tau / 48.0))
"""Directions in which the extreme points of a motion are determined."""

BOX_INSET = 2e-3
"""Margin of the extreme points from the box, as a share of its size, because points between directions lie farther out.
"""

PLACEMENT_DIRECTIONS = np.exp(1j * np.arange(72) * (math.tau / 72.0))
"""Directions tried in the placement of a sixbar."""

SIZE_COUNT, MIN_SIZE_SHARE, PREFERRED_SIZE_SHARE, MAX_SIZE_FACTOR = 10, 0.05, 0.6, 1.5
"""Placement sizes: number tried; minimum tried and minimum preferred, as shares of the maximum; and maximum relative to
the size that fills the widest box."""

MIN_LENGTH = 1e-12
"""Minimum length, in ground lengths, in a ratio."""

SIZE_WEIGHT = 0.1
"""Weight of the logarithm of the size relative to that of the link ratio."""


class _Frame(NamedTuple):
    """A sixbar over its motion: joints by name, shape (m,) each, and the reference angle of the output, degrees."""

    joints: dict[str, Complex]
    output_frame: float


def build_function_linkage(
    task: FunctionTask, found: SixbarCandidate
) -> tuple[SixbarMechanism | EightbarMechanism, Dials]:
    """Build a candidate in the problem's coordinates, at the first target, with its dials."""
    problem = task.problem
    frame, there = _select_frame(problem, found, list(_list_frames(task, found)))
    joints = {name: there.origin + there.along * complex(places[0]) for name, places in frame.joints.items()}
    turned = math.degrees(cmath.phase(there.along))
    # In the fit both angles count from its x axis, here from the ground line.
    ground = _measure_ground_angle(found)
    generator = np.array([0.0, 0.0, 0.0, found.start - ground, -ground, *found.scales])
    dials = make_dials(task, generator, turned, turned + frame.output_frame)
    links = _list_link_joints(found)
    made = build_eightbar(joints, links) if found.type == "eightbar" else build_sixbar(found.type, joints, links)
    return made, dials


def _list_link_joints(found: SixbarCandidate) -> Links:
    """Return the joints on each link."""
    names = found.topology.pin_names
    return {link: tuple(names[pin] for pin in pins) for link, pins in found.topology.links.items()}


def _select_frame(problem: FunctionProblem, found: SixbarCandidate, frames: list[_Frame]) -> tuple[_Frame, Placement]:
    """Select the frame with the most even link lengths that can be placed; without one, the most even of all."""
    # Try the most even frame first; only Watt II sixbars have several.
    frames.sort(key=lambda frame: _measure_unevenness(found, frame.joints))
    first: tuple[_Frame, Placement] | None = None
    for frame in frames:
        there = _place_sixbar(problem, found, frame)
        if there.fits:
            return frame, there
        # Nothing fits: report the most even frame with its violations.
        first = first or (frame, there)
    assert first is not None
    return first


def _list_frames(task: FunctionTask, found: SixbarCandidate) -> Iterator[_Frame]:
    """Yield the sixbar in its own frame, O2 at 0 and O4 at 1, in all relative placements of a Watt II's fourbars.

    The first sample is the first target, the configuration of the answer.
    """
    low, high = float(task.sample_inputs.min()), float(task.sample_inputs.max())
    inputs = np.concatenate([[float(task.inputs[0])], np.linspace(low, high, SAMPLE_COUNT)])
    motion = measure_motion(found, inputs)
    if motion is None:
        raise ValueError("the sixbar cannot be assembled at all inputs")
    joints = {name: motion.places[:, node] for name, node in found.topology.joints.items()}
    pivot, ground = joints["O2"], joints["O4"] - joints["O2"]
    joints = {name: (places - pivot) / ground for name, places in joints.items()}
    if found.type != "watt_2":
        yield _Frame(joints, 0.0)
        return
    centre, own = joints["O4"], ("C", "D", "O6")
    fourbars = (("O2", "A", "B"), ("O6", "D", "C"))
    # Size of the second fourbar at which both have the same geometric mean of longest and shortest link.
    first, second = (_measure_fourbar({name: joints[name][0] for name in ("O4", *names)}) for names in fourbars)
    agreeing = math.sqrt(first.min() * first.max() / (second.min() * second.max()))
    for size in SIZE_FACTORS:
        for turn in np.arange(DIRECTION_COUNT) * (math.tau / DIRECTION_COUNT):
            along = agreeing * size * cmath.rect(1.0, turn)
            # The second fourbar turns and grows about O4, which both share.
            moved = {name: centre + along * (joints[name] - centre) for name in own}
            yield _Frame(joints | moved, math.degrees(turn))


def _measure_ground_angle(found: SixbarCandidate) -> float:
    """Return the angle of O2 → O4 in a fit."""
    first, second, *_ = found.topology.fixed_pivots
    x, y = found.fit.x[2 * second : 2 * second + 2] - found.fit.x[2 * first : 2 * first + 2]
    return math.atan2(y, x)


def _measure_fourbar(loop: dict[str, complex]) -> Real:
    """Return the lengths of a fourbar from its joints in the order of its loop."""
    places = np.array(list(loop.values()))
    return np.asarray(np.abs(np.roll(places, -1) - places))


def _measure_unevenness(found: SixbarCandidate, joints: dict[str, Complex]) -> float:
    """Return the logarithm of the link ratio, plus a small weight of the logarithm of the size."""
    there = {name: complex(places[0]) for name, places in joints.items()}
    lengths = list_lengths(there, _list_link_joints(found)).values()
    extent = np.ptp([z.real for z in there.values()]) + np.ptp([z.imag for z in there.values()])
    return math.log(max(lengths) / max(min(lengths), MIN_LENGTH)) + SIZE_WEIGHT * math.log(float(extent))


def _place_sixbar(problem: FunctionProblem, found: SixbarCandidate, frame: _Frame) -> Placement:
    """Find the similarity that places a sixbar from its own frame into regions and box."""
    links, joints = _list_link_joints(found), frame.joints
    still = links[GROUND]
    constraints, space = problem.constraints, problem.space
    moving = [name for name in joints if name not in still]
    regions = [constraints.fixed_pivot_region] * len(still) + [constraints.moving_pivot_region] * len(moving)
    points = [np.array([joints[name][0] for name in [*still, *moving]])]
    tables = [np.stack(convert_regions(regions))]
    if space is not None and space.box is not None:
        (left, low), (right, high) = space.box
        # Joints have a width, so the box is shrunk before they are tested.
        sides = np.array(space.shrink_box_for_joints(BOX_INSET * min(right - left, high - low)))
        swept = np.concatenate([*(joints[name][:1] for name in still), *(joints[name][1:] for name in moving)])
        # Only extreme points can leave the box first.
        outermost = swept[np.unique((swept[:, None] * HULL_DIRECTIONS.conj()).real.argmax(axis=0))]
        points.append(outermost)
        tables.append(np.repeat(sides[:, None], len(outermost), axis=1))
    least, most = _limit_sizes(problem, found, joints)
    limits = Boxes(*np.concatenate(tables, axis=1))
    # Given pivots determine the placement completely; it can only be checked.
    if problem.fixed_pivots is not None:
        o2, there = to_complex(problem.fixed_pivots.input), to_complex(problem.fixed_pivots.output)
        ends = complex(joints[still[0]][0]), complex(joints[still[-1]][0])
        along = (there - o2) / (ends[1] - ends[0])
        origin = o2 - along * ends[0]
        kept = least <= abs(along) <= most and _is_within_boxes(origin + along * np.concatenate(points), limits)
        return Placement(origin, along, kept)
    # Any placement fits: keep the direction and use the default size.
    if not np.isfinite(np.concatenate(tables, axis=1)).any() and constraints.link_length is None:
        return Placement(0j, complex(_get_preferred_size(joints)), True)
    tried = _try_placements(np.concatenate(points), limits, least, most, _get_preferred_size(joints))
    # With a box the search over directions is final; without one the exact method follows.
    if tried.fits or len(points) > 1:
        return tried
    return place_in_boxes(points[0], limits, least, most, complex(_get_preferred_size(joints)))


def _is_within_boxes(places: Complex, limits: Boxes) -> bool:
    """Return whether points lie in their boxes, apart from rounding."""
    margin = ROUNDING_TOLERANCE * float(np.abs(places).max())
    x, y = places.real, places.imag
    inside = (limits.left - margin <= x) & (x <= limits.right + margin)
    return bool(np.all(inside & (limits.low - margin <= y) & (y <= limits.high + margin)))


def _try_placements(points: Complex, limits: Boxes, least: float, most: float, preferred: float) -> Placement:
    """Try many directions and sizes to place points in boxes; return the closest if none fits.

    Among those that fit, select the one with the largest margin whose size is not much below the maximum.
    """
    sides = np.concatenate([limits.right - limits.left, limits.high - limits.low])
    extent = max(float(np.ptp(points.real)), float(np.ptp(points.imag)))
    finite = sides[np.isfinite(sides)]
    top = min(most, MAX_SIZE_FACTOR * float(finite.max()) / extent if len(finite) else max(preferred, least))
    sizes = np.geomspace(max(least, MIN_SIZE_SHARE * top), max(top, least, MIN_SIZE_SHARE * top), SIZE_COUNT)
    along = (sizes[:, None] * PLACEMENT_DIRECTIONS).ravel()
    moved = along[:, None] * points
    left, right = (limits.left - moved.real).max(axis=1), (limits.right - moved.real).min(axis=1)
    low, high = (limits.low - moved.imag).max(axis=1), (limits.high - moved.imag).min(axis=1)
    room = np.minimum(right - left, high - low)
    fitting = room >= 0.0
    if fitting.any():
        # Among large enough placements take the one with the largest margin.
        large = fitting & (np.abs(along) >= PREFERRED_SIZE_SHARE * np.abs(along[fitting]).max())
        best = int(np.argmax(np.where(large, room, -np.inf)))
    else:
        best = int(np.argmax(room))
    return Placement(
        _find_middle(left, right, best) + 1j * _find_middle(low, high, best), complex(along[best]), bool(fitting[best])
    )


def _find_middle(low: Real, high: Real, n: int) -> float:
    """Return the middle of a range, its only finite end, or 0 if it is unbounded."""
    ends = [float(end) for end in (low[n], high[n]) if math.isfinite(end)]
    return sum(ends) / len(ends) if ends else 0.0


def _get_preferred_size(joints: dict[str, Complex]) -> float:
    """Return the size at which the longest ground line has the default length."""
    still: Sequence[complex] = [complex(places[0]) for name, places in joints.items() if name.startswith("O")]
    return DEFAULT_GROUND_LENGTH / max(abs(one - other) for one in still for other in still)


def _limit_sizes(problem: FunctionProblem, found: SixbarCandidate, joints: dict[str, Complex]) -> tuple[float, float]:
    """Return the minimum and maximum size at which all lengths satisfy their limits."""
    limits = problem.constraints.link_length
    if limits is None:
        return 0.0, math.inf
    lengths = list_lengths(
        {name: complex(places[0]) for name, places in joints.items()}, _list_link_joints(found)
    ).values()
    return limits.min / min(lengths), math.inf if limits.max is None else limits.max / max(lengths)
