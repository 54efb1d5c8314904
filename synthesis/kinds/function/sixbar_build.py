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
from numpy.typing import NDArray

from kinematics.linkage.planar.catalogue import SIXBAR_LINKS
from kinematics.linkage.planar.mechanism import GROUND
from synthesis.kinds.function.design import Dials
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.sixbar_descents import KINDS, Found
from synthesis.kinds.function.sixbar_followers import followed
from synthesis.kinds.function.sixbar_kernels import NUMBERS, START, STEPHENSON_2, STEPHENSON_3, A, B, C, K
from synthesis.kinds.function.task import USUAL_GROUND, FunctionTask, dials_of
from synthesis.model.linkage_answer import SixbarMechanism
from synthesis.model.linkages import to_complex
from synthesis.model.sixbars import lengths_of, sixbar_mechanism
from synthesis.numerics.placing import ROUNDING, Boxes, Placing, placed
from synthesis.outcome.placement import boxes

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

LOOKED_AT = 49
"""Number of samples of the motion at which a sixbar must be within the box."""

FINE = 6
"""Number of substeps between samples in which a Stephenson II is followed."""

DIRECTIONS, SIZES = 24, (1.0, 0.6, 1.6)
"""Number of directions, and size factors, tried for the second fourbar of a Watt II. With factor 1 the geometric means
of longest and shortest link agree in both fourbars."""

HULL = np.exp(1j * np.arange(48) * (math.tau / 48.0))
"""Directions in which the extreme points of a motion are determined."""

INSET = 2e-3
"""Margin of the extreme points from the box, as a share of its size, because points between directions lie farther out.
"""

TURNS = np.exp(1j * np.arange(72) * (math.tau / 72.0))
"""Directions tried in the placement of a sixbar."""

TRIED_SIZES, SMALLEST, LARGE, BEYOND = 10, 0.05, 0.6, 1.5
"""Placement sizes: number tried; minimum tried and minimum preferred, as shares of the maximum; and maximum relative to
the size that fills the widest box."""

NO_LENGTH = 1e-12
"""Minimum length, in ground lengths, in a ratio."""

SIZE_WEIGHT = 0.1
"""Weight of the logarithm of the size relative to that of the link ratio."""

LINKS = {
    name: {link: tuple(joint for joint in joints if joint != "P") for link, joints in SIXBAR_LINKS[name].items()}
    for name in KINDS
}
"""The joints on each link of the types."""


class _Frame(NamedTuple):
    """A sixbar over its motion: joints by name, shape (m,) each, and the reference angle of the output, degrees."""

    joints: dict[str, Complex]
    output_frame: float


def built(task: FunctionTask, found: Found) -> tuple[SixbarMechanism, Dials]:
    """Build a candidate sixbar in the problem's coordinates, at the first target, with its dials."""
    problem = task.problem
    frame, there = _fitting(problem, found, list(_frames(task, found)))
    joints = {name: there.origin + there.along * complex(places[0]) for name, places in frame.joints.items()}
    turned = math.degrees(cmath.phase(there.along))
    dials = dials_of(task, found.at, turned, turned + frame.output_frame)
    return sixbar_mechanism(found.type, joints, LINKS[found.type]), dials


def _fitting(problem: FunctionProblem, found: Found, frames: list[_Frame]) -> tuple[_Frame, Placing]:
    """Select the frame with the most even link lengths that can be placed; without one, the most even of all."""
    frames.sort(key=lambda frame: _unevenness(found, frame.joints))
    first: tuple[_Frame, Placing] | None = None
    for frame in frames:
        there = _placed(problem, found, frame)
        if there.fits:
            return frame, there
        first = first or (frame, there)
    assert first is not None
    return first


def _frames(task: FunctionTask, found: Found) -> Iterator[_Frame]:
    """Yield the sixbar in its own frame, O2 at 0 and O4 at 1, in all relative placements of its fourbars.

    The first sample is the first target.
    """
    kind, at = KINDS[found.type], found.at
    first, last = float(task.inputs[0]), float(task.sample_inputs.max())
    low = float(task.sample_inputs.min())
    over = np.linspace(low, last, LOOKED_AT)
    inputs = np.concatenate([[first], over])
    pins = at[A] * np.exp(1j * (at[START] + at[K] * inputs))
    joints: dict[str, Complex] = {"O2": np.zeros_like(pins), "O4": np.ones_like(pins), "A": pins}
    bits = found.assembly & 1 == 1, found.assembly & 2 == 2
    if kind == STEPHENSON_2:
        moving = _second_stephenson(found, first, (low, last))
        still = {"O2": np.zeros_like(moving["A"]), "O4": np.ones_like(moving["A"])}
        yield _Frame(still | moving, 0.0)
        return
    joints["B"] = _closed(pins, joints["O4"], at[B], at[C], left=bits[0])
    rocker = joints["B"] - 1.0
    if kind == STEPHENSON_3:
        joints["C"] = pins + complex(at[7], at[8]) * (joints["B"] - pins) / at[B]
        joints["O6"] = np.full_like(pins, complex(at[9], at[10]))
        joints["D"] = _closed(joints["C"], joints["O6"], at[11], at[12], left=bits[1])
        yield _Frame(joints, 0.0)
        return
    crank = at[7] * np.exp(1j * at[10]) * rocker / at[C]
    pin = _closed(crank, joints["O4"], at[8], at[9], left=bits[1])
    lengths = np.array([1.0, *at[:3]]), np.array([1.0, *at[7:10]])
    agreeing = math.sqrt(math.prod([lengths[0].min() * lengths[0].max(), 1.0 / (lengths[1].min() * lengths[1].max())]))
    for size in SIZES:
        for turn in np.arange(DIRECTIONS) * (math.tau / DIRECTIONS):
            along = agreeing * size * cmath.rect(1.0, turn)
            second = {"C": 1.0 + along * crank, "D": 1.0 + along * pin, "O6": np.full_like(pins, 1.0 + along)}
            yield _Frame(joints | second, math.degrees(turn))


def _closed(q: Complex, o: Complex, d: float, e: float, *, left: bool) -> Complex:
    """Return the joint of a dyad from pins q and pivots o, to the left or right of the line from q to o."""
    across = o - q
    r = np.abs(across)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (d * d + r * r - e * e) / (2.0 * r)
    height = np.sqrt(np.maximum(d * d - along * along, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(q + across / r * (along + (1j if left else -1j) * height))


def _second_stephenson(found: Found, first: float, ends: tuple[float, float]) -> dict[str, Complex]:
    """Drive a Stephenson II from the first target to both ends of its range; the kernel follows τ in small steps."""
    at = found.at.copy()
    left = found.assembly & 1 == 1
    begun = followed(STEPHENSON_2, found.assembly, at, np.array([first]), np.zeros(1)).tau
    places = [(first, begun)]
    for end in ends:
        tau = begun
        for n, u in enumerate(np.linspace(first, end, FINE * LOOKED_AT + 1)):
            at[NUMBERS - 1] = tau
            tau = followed(STEPHENSON_2, found.assembly, at, np.array([u]), np.zeros(1)).tau
            if n % FINE == 0:
                places.append((float(u), tau))
    inputs, taus = np.array(places).T
    turn = np.exp(1j * (at[START] + at[K] * inputs))
    pin, c = at[A] * turn, complex(at[7], at[8]) * turn
    b = pin + at[B] * np.exp(1j * taus) * turn
    d = _closed(c, b, at[10], at[9], left=left)
    return {"A": pin, "B": b, "C": c, "D": d, "E": b + complex(at[11], at[12]) * (d - b) / at[9]}


def _unevenness(found: Found, joints: dict[str, Complex]) -> float:
    """Return the logarithm of the link ratio, plus a small weight of the logarithm of the size."""
    there = {name: complex(places[0]) for name, places in joints.items()}
    lengths = lengths_of(there, LINKS[found.type]).values()
    extent = np.ptp([z.real for z in there.values()]) + np.ptp([z.imag for z in there.values()])
    return math.log(max(lengths) / max(min(lengths), NO_LENGTH)) + SIZE_WEIGHT * math.log(float(extent))


def _placed(problem: FunctionProblem, found: Found, frame: _Frame) -> Placing:
    """Find the similarity that places a sixbar from its own frame into regions and box."""
    links, joints = LINKS[found.type], frame.joints
    still = links[GROUND]
    constraints, space = problem.constraints, problem.space
    moving = [name for name in joints if name not in still]
    regions = [constraints.fixed_pivot_region] * len(still) + [constraints.moving_pivot_region] * len(moving)
    points = [np.array([joints[name][0] for name in [*still, *moving]])]
    tables = [np.stack(boxes(regions))]
    if space is not None and space.box is not None:
        (left, low), (right, high) = space.box
        sides = np.array(space.box_of_joints(INSET * min(right - left, high - low)))
        swept = np.concatenate([*(joints[name][:1] for name in still), *(joints[name][1:] for name in moving)])
        outermost = swept[np.unique((swept[:, None] * HULL.conj()).real.argmax(axis=0))]
        points.append(outermost)
        tables.append(np.repeat(sides[:, None], len(outermost), axis=1))
    least, most = _sizes(problem, found, joints)
    limits = Boxes(*np.concatenate(tables, axis=1))
    if problem.fixed_pivots is not None:
        o2, there = to_complex(problem.fixed_pivots.input), to_complex(problem.fixed_pivots.output)
        ends = complex(joints[still[0]][0]), complex(joints[still[-1]][0])
        along = (there - o2) / (ends[1] - ends[0])
        origin = o2 - along * ends[0]
        kept = least <= abs(along) <= most and _within(origin + along * np.concatenate(points), limits)
        return Placing(origin, along, kept)
    if not np.isfinite(np.concatenate(tables, axis=1)).any() and constraints.link_length is None:
        return Placing(0j, complex(_preferred(joints)), True)
    tried = _tried(np.concatenate(points), limits, least, most, _preferred(joints))
    if tried.fits or len(points) > 1:
        return tried
    return placed(points[0], limits, least, most, complex(_preferred(joints)))


def _within(places: Complex, limits: Boxes) -> bool:
    """Return whether points lie in their boxes, apart from rounding."""
    margin = ROUNDING * float(np.abs(places).max())
    x, y = places.real, places.imag
    inside = (limits.left - margin <= x) & (x <= limits.right + margin)
    return bool(np.all(inside & (limits.low - margin <= y) & (y <= limits.high + margin)))


def _tried(points: Complex, limits: Boxes, least: float, most: float, preferred: float) -> Placing:
    """Try many directions and sizes to place points in boxes; return the closest if none fits.

    Among those that fit, select the one with the largest margin whose size is not much below the maximum.
    """
    sides = np.concatenate([limits.right - limits.left, limits.high - limits.low])
    extent = max(float(np.ptp(points.real)), float(np.ptp(points.imag)))
    finite = sides[np.isfinite(sides)]
    top = min(most, BEYOND * float(finite.max()) / extent if len(finite) else max(preferred, least))
    sizes = np.geomspace(max(least, SMALLEST * top), max(top, least, SMALLEST * top), TRIED_SIZES)
    along = (sizes[:, None] * TURNS).ravel()
    moved = along[:, None] * points
    left, right = (limits.left - moved.real).max(axis=1), (limits.right - moved.real).min(axis=1)
    low, high = (limits.low - moved.imag).max(axis=1), (limits.high - moved.imag).min(axis=1)
    room = np.minimum(right - left, high - low)
    fitting = room >= 0.0
    if fitting.any():
        large = fitting & (np.abs(along) >= LARGE * np.abs(along[fitting]).max())
        best = int(np.argmax(np.where(large, room, -np.inf)))
    else:
        best = int(np.argmax(room))
    return Placing(
        _between(left, right, best) + 1j * _between(low, high, best), complex(along[best]), bool(fitting[best])
    )


def _between(low: Real, high: Real, n: int) -> float:
    """Return the middle of a range, its only finite end, or 0 if it is unbounded."""
    ends = [float(end) for end in (low[n], high[n]) if math.isfinite(end)]
    return sum(ends) / len(ends) if ends else 0.0


def _preferred(joints: dict[str, Complex]) -> float:
    """Return the size at which the longest ground line has the default length."""
    still: Sequence[complex] = [complex(joints[name][0]) for name in ("O2", "O4", "O6") if name in joints]
    return USUAL_GROUND / max(abs(one - other) for one in still for other in still)


def _sizes(problem: FunctionProblem, found: Found, joints: dict[str, Complex]) -> tuple[float, float]:
    """Return the minimum and maximum size at which all lengths satisfy their limits."""
    limits = problem.constraints.link_length
    if limits is None:
        return 0.0, math.inf
    lengths = lengths_of({name: complex(places[0]) for name, places in joints.items()}, LINKS[found.type]).values()
    return limits.min / min(lengths), math.inf if limits.max is None else limits.max / max(lengths)
