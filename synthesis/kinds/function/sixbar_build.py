"""A sixbar of the search as a mechanism with its dials, put where it fits.

A function generator does the same wherever it stands, so that place, direction and size are free; of Watt II also the
size and the direction of its second fourbar beside the first. These are chosen so that links differ little in length,
pivots lie in their regions, and over the whole motion in the box.
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
"""Places of the motion at which a sixbar is to be within the box."""

FINE = 6
"""Steps from each of them to the next in which Stephenson II is followed."""

DIRECTIONS, SIZES = 24, (1.0, 0.6, 1.6)
"""Directions and sizes of the second fourbar of a Watt II that are tried; the size is first that with which the longest
and the shortest of both agree."""

HULL = np.exp(1j * np.arange(48) * (math.tau / 48.0))
"""Directions in which the outermost places of a motion are looked for."""

INSET = 2e-3
"""Share of the box by which these places lie farther inside: between the directions they lie farther out."""

TURNS = np.exp(1j * np.arange(72) * (math.tau / 72.0))
"""Directions in which a sixbar is tried."""

TRIED_SIZES, SMALLEST, LARGE, BEYOND = 10, 0.05, 0.6, 1.5
"""Sizes in which it is tried, the least of them and those that are taken as shares of the greatest, and the greatest
beside that with which it is as wide as the widest of its boxes."""

NO_LENGTH = 1e-12
"""A length of none, grounds."""

SIZE_WEIGHT = 0.1
"""Of the logarithm of the size beside that of the link ratio."""

LINKS = {
    name: {link: tuple(joint for joint in joints if joint != "P") for link, joints in SIXBAR_LINKS[name].items()}
    for name in KINDS
}
"""The joints on each link of the types."""


class _Frame(NamedTuple):
    """A sixbar over its motion: joints by name, shape (m,) each, and from which angle, degrees, the output counts."""

    joints: dict[str, Complex]
    output_frame: float


def built(task: FunctionTask, found: Found) -> tuple[SixbarMechanism, Dials]:
    """A sixbar of the search in the problem's coordinates, standing at the first target, with its dials."""
    problem = task.problem
    frame, there = _fitting(problem, found, list(_frames(task, found)))
    joints = {name: there.origin + there.along * complex(places[0]) for name, places in frame.joints.items()}
    turned = math.degrees(cmath.phase(there.along))
    dials = dials_of(task, found.at, turned, turned + frame.output_frame)
    return sixbar_mechanism(found.type, joints, LINKS[found.type]), dials


def _fitting(problem: FunctionProblem, found: Found, frames: list[_Frame]) -> tuple[_Frame, Placing]:
    """The most even frame of a sixbar that fits where it is to be; the most even of all where none does."""
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
    """The sixbar in its own frame, O2 at 0 and O4 at 1, in all ways in which it can be put together.

    The first of the places is that of the first target.
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
    """The joint of a dyad from pins q and pivots o, to the left of the way from q to o or to the right."""
    across = o - q
    r = np.abs(across)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (d * d + r * r - e * e) / (2.0 * r)
    height = np.sqrt(np.maximum(d * d - along * along, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(q + across / r * (along + (1j if left else -1j) * height))


def _second_stephenson(found: Found, first: float, ends: tuple[float, float]) -> dict[str, Complex]:
    """Joints of a Stephenson II at the first target and on to both ends of its range; the kernel follows its τ."""
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
    """Logarithm of the ratio of all lengths, and a little of the size beside it."""
    there = {name: complex(places[0]) for name, places in joints.items()}
    lengths = lengths_of(there, LINKS[found.type]).values()
    extent = np.ptp([z.real for z in there.values()]) + np.ptp([z.imag for z in there.values()])
    return math.log(max(lengths) / max(min(lengths), NO_LENGTH)) + SIZE_WEIGHT * math.log(float(extent))


def _placed(problem: FunctionProblem, found: Found, frame: _Frame) -> Placing:
    """The similarity that brings a sixbar from its own frame to where it fits."""
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
    """Whether places lie in their boxes, but for rounding."""
    margin = ROUNDING * float(np.abs(places).max())
    x, y = places.real, places.imag
    inside = (limits.left - margin <= x) & (x <= limits.right + margin)
    return bool(np.all(inside & (limits.low - margin <= y) & (y <= limits.high + margin)))


def _tried(points: Complex, limits: Boxes, least: float, most: float, preferred: float) -> Placing:
    """The similarity that brings points into boxes, of many directions and sizes; where none does, the nearest.

    Of those that do the one with the most room, and a size not much below the greatest.
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
    """The middle of a range, or the end that it has, or 0."""
    ends = [float(end) for end in (low[n], high[n]) if math.isfinite(end)]
    return sum(ends) / len(ends) if ends else 0.0


def _preferred(joints: dict[str, Complex]) -> float:
    """The size with which the longest ground line is the usual one."""
    still: Sequence[complex] = [complex(joints[name][0]) for name in ("O2", "O4", "O6") if name in joints]
    return USUAL_GROUND / max(abs(one - other) for one in still for other in still)


def _sizes(problem: FunctionProblem, found: Found, joints: dict[str, Complex]) -> tuple[float, float]:
    """Sizes with which all lengths keep their limits."""
    limits = problem.constraints.link_length
    if limits is None:
        return 0.0, math.inf
    lengths = lengths_of({name: complex(places[0]) for name, places in joints.items()}, LINKS[found.type]).values()
    return limits.min / min(lengths), math.inf if limits.max is None else limits.max / max(lengths)
