"""Output of a dwell sixbar over the turn of its crank, for many shapes at once.

A shape is a row of numbers in a frame with the crank's pivot O2 at the origin, a crank of 1 and O4 on the real axis:

    b, c, d, x, y        coupler, rocker, ground, and P in the coupler's frame, or in the rocker's with O4 at its origin
                         and B on its real axis; B to the left of A → O4
    rocker               R = P D, O6 (x, y), O6 D
    slider               R = P D, the line's distance from O2 to its left, its angle
    slot                 O6 (x, y)
    θ for each dwell     the crank's angle at which it begins

With r = |P − O6| the rocker's pin D lies at the angle ±arccos((c6² + r² − R²) / 2 c6 r) from the line O6 → P; on a
slide with unit vector u the place of D is Re(P ū) ± √(R² − y²), y being P's distance from the line; a slotted link
points from O6 to P.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, coupler_points
from synthesis.kinds.dwell.problem import Turning
from synthesis.numerics.narrowing import ShapeValues

Kind = Literal["rocker", "slider", "slot", "triad"]
Carrier = Literal["coupler", "rocker"]

CYCLE_SAMPLE_COUNT = 72
"""Number of crank angles of the turn at which the output is evaluated."""

DWELL_SAMPLE_COUNT = 21
"""Number of crank angles in a dwell, in Chebyshev's spacing."""

TRANSMISSION_STRIDE = 2
"""Number of the turn's crank angles per constraint on the transmission angles."""

PLACE_TOLERANCE = 0.03
"""Maximum distance of a dwell's mean from its place in the output's range, as a share of the range."""

MIN_GRASHOF_MARGIN = 0.02
"""Minimum margin of the crank's length in Grashof's condition."""

MIN_STROKE = 0.3
"""Minimum stroke of a slider in units of the ground link."""

MIN_SLOT_DISTANCE = 0.3
"""Minimum distance of P from the pivot of a slotted link, in crank lengths. A smaller distance would make the link turn
very fast."""


class Task(NamedTuple):
    """Requirements on a shape.

    Attributes
    ----------
    kind : str
        Kind of output.
    sign : int
        Assembly of the output.
    dwells : tuple of float
        Rotation of the crank during each dwell, radians.
    places : tuple of float
        Place of each dwell, as a share of the output's range: 0 the minimum, 1 the maximum.
    way : float
        Required swing, radians, or NaN for a slider, which is scaled afterwards.
    transmission : float
        Minimum sine of a transmission angle.
    link_ratio : float
        Maximum of the longest link over the shortest.
    carrier : str
        The link that carries P.
    turning : str
        Class of the fourbar O2 A B O4: its rocker swings, or turns through like its crank.
    """

    kind: Kind
    sign: int
    dwells: tuple[float, ...]
    places: tuple[float, ...]
    way: float
    transmission: float
    link_ratio: float
    carrier: Carrier = "coupler"
    turning: Turning = "crank_rocker"


def build_fourbars(shapes: Real) -> Fourbar:
    """Return the fourbars of shapes (m, ...)."""
    ones = np.ones(len(shapes))
    return Fourbar.from_lengths(ones, shapes[:, 0], shapes[:, 1], shapes[:, 2], shapes[:, 3] + 1j * shapes[:, 4])


def locate_points(shapes: Real, theta: Real, carrier: Carrier) -> Complex:
    """Return the positions of P at crank angles (N,) or (m, N), shape (m, N)."""
    linkage = build_fourbars(shapes)
    if carrier == "coupler":
        return coupler_points(linkage, theta, np.full(len(shapes), OPEN_ASSEMBLY)).p
    at_b = Fourbar.from_lengths(np.ones(len(shapes)), shapes[:, 0], shapes[:, 1], shapes[:, 2], shapes[:, 0] + 0j)
    pivot = shapes[:, 2, None]
    # Unit vector along the rocker: a coupler point at B gives B itself.
    arm = (coupler_points(at_b, theta, np.full(len(shapes), OPEN_ASSEMBLY)).p - pivot) / shapes[:, 1, None]
    return np.asarray(pivot + arm * (shapes[:, 3] + 1j * shapes[:, 4])[:, None])


def compute_output(kind: Kind, sign: int, shapes: Real, p: Complex) -> tuple[Real, Real]:
    """Return the output and the sine of its transmission angle, both of shape (m, N).

    The output is an angle from a mean direction, radians, or a position along the slide. It is NaN where the links do
    not reach. For a slotted link the sine is replaced by P's distance from the link's pivot, at most 1.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        if kind == "slider":
            along = np.exp(1j * shapes[:, 7, None])
            across = (p * along.conj()).imag - shapes[:, 6, None]
            # NaN where P is farther from the slide than the link is long.
            sine = np.sqrt(1.0 - (across / shapes[:, 5, None]) ** 2)
            return (p * along.conj()).real + sign * shapes[:, 5, None] * sine, sine
        if kind == "slot":
            arm = p - (shapes[:, 5] + 1j * shapes[:, 6])[:, None]
            return _measure_angles(arm / np.abs(arm)), np.minimum(np.abs(arm) / MIN_SLOT_DISTANCE, 1.0)
        arm = p - (shapes[:, 6] + 1j * shapes[:, 7])[:, None]
        link, rocker, reach = shapes[:, 5, None], shapes[:, 8, None], np.abs(arm)
        cosine = (rocker**2 + reach**2 - link**2) / (2.0 * rocker * reach)
        lean = cosine + 1j * sign * np.sqrt(1.0 - cosine**2)
        at_pin = (rocker**2 + link**2 - reach**2) / (2.0 * rocker * link)
        return _measure_angles(arm / reach * lean), np.sqrt(1.0 - at_pin**2)


def _measure_angles(directions: Complex) -> Real:
    """Return the angles of directions from their mean direction; the output turns by less than half a turn."""
    # Angles about the mean direction do not jump by a full turn.
    mean = np.where(np.isfinite(directions), directions, 0.0).sum(axis=1, keepdims=True)
    return np.asarray(np.angle(directions * np.conj(mean)))


def find_extremes(values: Real) -> tuple[Real, Real]:
    """Return minimum and maximum of periodic samples (m, N), by the parabola through the neighbours of each."""
    found = []
    for sign in (-1.0, 1.0):
        signed = sign * values
        rows, top = np.arange(len(values)), signed.argmax(axis=1)
        before, at, after = (signed[rows, (top + k) % values.shape[1]] for k in (-1, 0, 1))
        bend = before - 2.0 * at + after
        with np.errstate(invalid="ignore", divide="ignore"):
            # Vertex of the parabola; a flat neighbourhood keeps the sample itself.
            peak = at - 0.125 * np.where(bend < 0.0, (after - before) ** 2 / bend, 0.0)
        found.append(sign * peak)
    return found[0], found[1]


def list_crank_angles(shapes: Real, task: Task, nodes: Real) -> Real:
    """Return crank angles of the dwells, (m, nodes · dwells), followed by those of the turn; ``nodes`` in [0, 1]."""
    count = len(task.dwells)
    resting = [shapes[:, -count + k, None] + dwell * nodes for k, dwell in enumerate(task.dwells)]
    turn = np.broadcast_to(
        np.linspace(0.0, 2.0 * np.pi, CYCLE_SAMPLE_COUNT, endpoint=False), (len(shapes), CYCLE_SAMPLE_COUNT)
    )
    return np.concatenate([*resting, turn], axis=1)


def evaluate_shapes(task: Task, nodes: Real, shapes: Real) -> ShapeValues:
    """Compute the objective, the output's movement during the dwells as a share of its range, and the constraints."""
    theta = list_crank_angles(shapes, task, nodes)
    p = locate_points(shapes, theta, task.carrier)
    out, sine = compute_output(task.kind, task.sign, shapes, p)
    banded, kept = evaluate_dwells(task, len(nodes), out, shapes[:, 2])
    positive = np.concatenate(
        [
            kept,
            sine[:, ::TRANSMISSION_STRIDE] ** 2 - task.transmission**2,
            _compute_fourbar_margins(shapes, task),
            *([_compute_slot_margin(shapes, p, task)] if task.kind == "slot" else []),
        ],
        axis=1,
    )
    return ShapeValues(banded, np.empty((len(shapes), 0)), positive)


def evaluate_dwells(task: Task, count: int, out: Real, ground: Real) -> tuple[Real, Real]:
    """Compute the output's movement during the dwells, as shares of its range, and the margins of places and range.

    Parameters
    ----------
    task : Task
    count : int
        Number of crank angles of a dwell.
    out : float, shape (m, dwells · count + cycle samples)
        The output during the dwells, and then over the turn.
    ground : float, shape (m,)
        Lengths of the ground links.

    Returns
    -------
    banded, kept : float, shapes (m, dwells · count) and (m, ...)
    """
    low, high = find_extremes(out[:, -CYCLE_SAMPLE_COUNT:])
    way = high - low
    banded, at_place = [], []
    with np.errstate(invalid="ignore", divide="ignore"):
        for k, place in enumerate(task.places):
            resting = out[:, k * count : (k + 1) * count]
            level = resting.mean(axis=1)
            banded.append((resting - level[:, None]) / way[:, None])
            at_place += _compute_place_margins(place, low, high, level, way)
        # A slider's stroke is free in a unit frame, but a small one makes the scaled linkage large.
        slides = math.isnan(task.way)
        # Two opposite inequalities make an equation for the swing.
        swing = [way / ground - MIN_STROKE] if slides else [way / task.way - 1.0, 1.0 - way / task.way]
    return np.concatenate(banded, axis=1), np.stack([*at_place, *swing], axis=1)


def _compute_place_margins(place: float, low: Real, high: Real, level: Real, way: Real) -> list[Real]:
    """Return the margins of a dwell's mean from the limits about its place.

    A place at an end of the range has a limit on one side only, any other place on both sides.
    """
    if place in (0.0, 1.0):
        return [PLACE_TOLERANCE - (high - level if place else level - low) / way]
    off = (level - low) / way - place
    return [PLACE_TOLERANCE - off, PLACE_TOLERANCE + off]


def _compute_slot_margin(shapes: Real, p: Complex, task: Task) -> Real:
    """Return the margin of the link ratio for the slotted link, shape (m, 1).

    The length of the link is P's maximum distance from its pivot.
    """
    reach = np.abs(p - (shapes[:, 5] + 1j * shapes[:, 6])[:, None]).max(axis=1)
    return np.asarray(task.link_ratio / reach - 1.0)[:, None]


def compute_pin_distances(shapes: Real, kind: Kind, carrier: Carrier) -> list[Real]:
    """Return all distances between two pins of a link, shape (m,) each, b, c and d first.

    The crank, of length 1, is not among them.
    """
    b, c, d, x, y = shapes[:, :5].T
    lengths = [b, c, d, np.hypot(x, y), np.hypot(x - (b if carrier == "coupler" else c), y)]
    lengths += [shapes[:, k] for k in {"rocker": (5, 8), "slider": (5,), "slot": ()}[kind]]
    if kind != "slider":
        at = shapes[:, 6:8] if kind == "rocker" else shapes[:, 5:7]
        lengths += [np.hypot(at[:, 0], at[:, 1]), np.hypot(at[:, 0] - d, at[:, 1])]
    return lengths


def _compute_fourbar_margins(shapes: Real, task: Task) -> Real:
    """Return margins of Grashof's conditions, of sin² of the extreme transmission angles, and of the link ratio."""
    b, c, d = shapes[:, 0], shapes[:, 1], shapes[:, 2]
    sines = [1.0 - ((b * b + c * c - (d + k) ** 2) / (2.0 * b * c)) ** 2 - task.transmission**2 for k in (-1.0, 1.0)]
    lengths = compute_pin_distances(shapes, task.kind, task.carrier)
    if task.turning == "double_crank":
        # The ground is a double crank's shortest link; the crank of 1 takes its place among the others.
        shortest, lengths[2] = d, np.ones_like(d)
        uneven = [task.link_ratio * shortest / length - 1.0 for length in lengths]
        uneven += [length / shortest - 1.0 for length in lengths]
        grashof = [(room - MIN_GRASHOF_MARGIN) / d for room in (b + c - d - 1.0, c + 1.0 - b - d, b + 1.0 - c - d)]
        return np.stack([*sines, *grashof, *uneven], axis=1)
    uneven = [task.link_ratio / length - 1.0 for length in lengths] + [length - 1.0 for length in lengths]
    grashof = [
        b + c - d - 1.0 - MIN_GRASHOF_MARGIN,
        c + d - b - 1.0 - MIN_GRASHOF_MARGIN,
        b + d - c - 1.0 - MIN_GRASHOF_MARGIN,
    ]
    return np.stack([*sines, *grashof, *uneven], axis=1)
