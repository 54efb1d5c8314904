"""Conversion between the analysis core and the answer: degrees and tables outside, radians and exact curves inside."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from kinematics.cam import follower as core
from kinematics.cam.barrel import BarrelCam
from kinematics.cam.local_curves import FEWEST_FOR_TWO, FEWEST_STEPS
from kinematics.cam.profile import Cam, even_angles
from kinematics.cam.program import TURN, Program
from kinematics.cam.settled import Stretches
from synthesis.kinds.cam.design import (
    BarrelCamMechanism,
    BarrelFollower,
    CamCurve,
    CamFollower,
    CamMechanism,
    ProgramTable,
)
from synthesis.mechanisms.cam import dimensions_of, follower_by_dimensions, follower_type

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

SAME_ANGLE_TOLERANCE = 1e-9
"""Angle in radians below which a joint and an equal step coincide."""

MAX_EQUAL_STEPS = 5760
"""Maximum number of equal steps of a profile."""

BESIDE_BREAK = 0.02
"""Minimum distance of an equal step from a break, in steps. In a chord much shorter than its neighbours, and in its
subdivisions, rounding leaves the curvature fewer digits."""

CROWDED = 0.1
"""Point spacing, in equal steps, below which no equal step is placed in between, for the same reason."""

MIN_CHORDS_OF_ROLLER = 5.0
"""Minimum number of chords of the profile that the roller's radius spans, so that its contact is resolved."""


CLOSER = 1.1
"""Minimum factor on the number of equal steps if the roller's radius spans too few chords."""

GRADED = 1.5
"""Length ratio to a neighbour up to which a step is not divided along with it."""

MAX_PARTS = 8
"""Maximum number of parts into which a step is divided at once."""

BESIDE = 1e-7
"""Angle in radians before a velocity jump at which the profile has a point of the side that ends there."""

SHORTEST = 1.5e-7
"""Radians up to which a stretch between breaks is not divided: the one next to a velocity jump, and no longer ones.
On longer ones the effect of rounding on the curvature is reported with it."""

MIN_STEPS = 2 * FEWEST_STEPS
"""Minimum number of steps of the profile between two sharp bends of the motion. Every second point is enough for one
of two curves."""


def profile_angles(program: Program, curve: Callable[[Real], Complex], roller_radius: float, count: int) -> Real:
    """Return the cam angles of a profile: equal steps, the bends, and closer points on short stretches between bends.

    A small roller also needs close points: its radius must span five chords of the curve that it touches.
    """
    breaks = np.union1d(np.union1d(program.joints[:-1], program.bends), _just_before(program))
    closer, step = _closer(breaks, np.append(np.union1d(program.joints[:-1], program.sharp_bends), TURN), count)
    while True:
        even = even_angles(count)
        # Bends are always points; equal steps that would crowd them or the closer points give way.
        even = even[_nearest(even, breaks) > BESIDE_BREAK * TURN / count]
        even = even[_gap(even, np.union1d(breaks, closer)) > CROWDED * TURN / count]
        others = np.union1d(even, _apart(closer, step, even))
        # A step next to a break would be a chord of no length.
        angle: Real = np.union1d(others[_nearest(others, breaks) > SAME_ANGLE_TOLERANCE], breaks)
        chord = np.abs(np.diff(curve(np.append(angle, TURN)))).max()
        if chord * MIN_CHORDS_OF_ROLLER <= roller_radius or roller_radius <= 0.0 or count >= MAX_EQUAL_STEPS:
            return angle
        # Chords shrink in proportion to the count; the factor makes sure of progress.
        count = min(math.ceil(count * max(chord * MIN_CHORDS_OF_ROLLER / roller_radius, CLOSER)), MAX_EQUAL_STEPS)


def _closer(breaks: Real, sharp: Real, count: int) -> tuple[Real, Real]:
    """Return cam angles that divide each short stretch between sharp bends, and those from a sharp bend to another one.

    Parameters
    ----------
    breaks, sharp : float, shapes (b,) and (k,)
        All bends, and the sharp ones with the turn's end.
    count : int
        Equal steps of the turn; a stretch that has enough of them needs no others.

    Returns
    -------
    angle, step : float, shape (m,)
        The angles, and the distance of each from the next one of its stretch.
    """
    # Equal divisions of every short stretch between sharp bends.
    divided = [
        np.linspace(start, end, MIN_STEPS + 1)[1:-1]
        for start, end in pairwise(sharp)
        if SHORTEST < end - start < MIN_STEPS * TURN / count
    ]
    angle, step = _with_step(divided)
    ends = np.append(breaks, TURN)
    span = np.diff(ends)
    beside = np.isin(ends[:-1], sharp) | np.isin(ends[1:], sharp)
    few = np.diff(np.searchsorted(angle, ends)) < FEWEST_STEPS - 1
    # A curve must not run over a sharp bend just because another bend is near it.
    own = beside & few & (span > SHORTEST) & (span < FEWEST_STEPS * TURN / count)
    others = ~own[np.searchsorted(ends, angle, side="right") - 1]
    shortest = [np.linspace(ends[k], ends[k + 1], FEWEST_STEPS + 1)[1:-1] for k in np.flatnonzero(own)]
    added, added_step = _with_step(shortest)
    return np.append(angle[others], added), np.append(step[others], added_step)


def _with_step(divided: list[Real]) -> tuple[Real, Real]:
    """Concatenate equal divisions, with the step of each of their angles."""
    steps = [np.full(len(angles), angles[1] - angles[0]) for angles in divided]
    return np.concatenate([np.empty(0), *divided]), np.concatenate([np.empty(0), *steps])


def _nearest(angle: Real, breaks: Real) -> Real:
    """Return the distance of each angle from the nearest break, the first of which is 0."""
    before = angle - breaks[np.searchsorted(breaks, angle, side="right") - 1]
    after = np.append(breaks, TURN)[np.searchsorted(breaks, angle)] - angle
    return np.asarray(np.minimum(before, after))


def _gap(angle: Real, others: Real) -> Real:
    """Return the width of the gap between others in which each angle lies; the first of the others is 0."""
    after = np.searchsorted(others, angle, side="right")
    return np.asarray(np.append(others, TURN)[after] - others[after - 1])


def _apart(angle: Real, step: Real, even: Real) -> Real:
    """Drop the angles that almost coincide with an equal step, which replaces them."""
    if not len(even):
        return angle
    around = np.clip(np.searchsorted(even, angle)[:, None] - [1, 0], 0, None) % len(even)
    # 0.4 of a step: less than half, so that every stretch keeps at least the points of its division.
    return np.asarray(angle[np.abs(angle[:, None] - even[around]).min(axis=1) > 0.4 * step])


def _just_before(program: Program) -> Real:
    """Return cam angles just before velocity jumps, at which the profile's corners need a second point."""
    return np.sort(np.mod(program.velocity_jumps - BESIDE, TURN))


def refined(angle: Real, off: Real, allowed: float) -> Real:
    """Divide steps whose deviation exceeds half of the permitted one, and their neighbours.

    The deviation falls with the fourth power of the step if the curvature is smooth; at its bends it falls more slowly,
    and the next round divides again.
    """
    closed = np.append(angle, TURN + angle[0])
    # Fourth root: the number of parts that brings the deviation to half of the permitted value.
    parts = np.clip(np.ceil((off / (0.5 * allowed)) ** 0.25), 1.0, MAX_PARTS).astype(np.int64)
    whole = np.diff(closed)
    for beside in (-1, 1):
        # A step that is as short as its neighbour's parts stays as it is.
        longer = whole > GRADED * np.roll(whole / parts, beside)
        # A neighbour of a divided step is halved, so that step lengths change gradually.
        parts = np.where(longer, np.maximum(parts, np.minimum(np.roll(parts, beside), 2)), parts)
    # The tiny step before a velocity jump only closes the corner and is never divided.
    parts[whole < 2.0 * BESIDE] = 1
    low, step = np.repeat(closed[:-1], parts), np.repeat(whole / parts, parts)
    within = np.arange(len(low)) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.unique(np.mod(low + step * within, TURN))


def cam_mechanism(cam: Cam, angle: Real, groove: bool = False) -> CamMechanism:
    """Build the mechanism of a cam at given cam angles, with both walls of its groove or with one profile."""
    oscillating = isinstance(cam.follower, core.OscillatingRoller | core.OscillatingFlat)
    unit = 180.0 / math.pi if oscillating else 1.0
    degrees = np.degrees(angle).tolist()
    # A roller's cam is sized by its prime circle, a face's by its base circle.
    roller = isinstance(cam.follower, core.TranslatingRoller | core.OscillatingRoller)
    return CamMechanism(
        follower=CamFollower(
            type=follower_type(cam.follower),
            **_dimensions(cam.follower),
        ),
        prime_radius=cam.size if roller else None,
        base_radius=None if roller else cam.size,
        rotation=cam.rotation,
        profile=_curve(degrees, cam.profile(angle)),
        outer_wall=_curve(degrees, cam.outer_wall(angle)) if groove else None,
        pitch_curve=_curve(degrees, cam.pitch_curve(angle)),
        program=_table(cam.program, angle, unit),
    )


def _dimensions(follower: core.Follower) -> dict[str, float]:
    """Return a follower's own dimensions; a face's offset does not change the cam and is given only if it is not 0."""
    own = {name: getattr(follower, name) for name in dimensions_of(type(follower))}
    if isinstance(follower, core.TranslatingFlat) and follower.offset == 0.0:
        del own["offset"]
    return own


def barrel_mechanism(barrel: BarrelCam, rotation: Literal["ccw", "cw"], angle: Real) -> BarrelCamMechanism:
    """Build the mechanism of a barrel cam at given cam angles."""
    degrees = np.degrees(angle).tolist()
    return BarrelCamMechanism(
        follower=BarrelFollower(roller_radius=barrel.roller_radius),
        cylinder_radius=barrel.radius,
        rotation=rotation,
        lower_wall=_curve(degrees, barrel.wall(angle, -1)),
        upper_wall=_curve(degrees, barrel.wall(angle, 1)),
        pitch_curve=_curve(degrees, barrel.pitch_curve(angle)),
        program=_table(barrel.program, angle, 1.0),
    )


def _table(program: Program, angle: Real, unit: float) -> ProgramTable:
    """Tabulate the program at cam angles; ``unit`` converts the core's displacement into the answer's."""
    motion, bends = program.motion(angle), np.union1d(program.bends, _just_before(program))
    breaks = np.searchsorted(angle, bends - SAME_ANGLE_TOLERANCE)
    return ProgramTable(
        angle=np.degrees(angle).tolist(),
        s=(motion.s * unit).tolist(),
        v=motion.v.tolist(),
        a=motion.a.tolist(),
        j=motion.j.tolist(),
        breaks=np.unique(np.degrees(angle[breaks])).tolist(),
    )


def _curve(degrees: list[float], points: Complex) -> CamCurve:
    return CamCurve(angle=degrees, x=points.real.tolist(), y=points.imag.tolist())


def core_follower(mechanism: CamMechanism) -> core.Follower:
    """Return the follower of a mechanism for the analysis core, from its dimensions alone.

    Raises
    ------
    DimensionError
        For dimensions that no follower can have.
    """
    stated = mechanism.follower
    radius = mechanism.prime_radius if stated.type.endswith("roller") else mechanism.base_radius
    return follower_by_dimensions(stated.type, radius or 0.0, stated)


def points_of(curve: CamCurve) -> Complex:
    """Return a curve's points as complex numbers."""
    return np.array(curve.x) + 1j * np.array(curve.y)


def stretches_of(program: ProgramTable) -> Stretches:
    """Return how the breaks of the motion divide a profile, which has the table's cam angles."""
    count = len(program.angle)
    breaks = np.flatnonzero(np.isin(program.angle, program.breaks))
    if not len(breaks):
        none = np.zeros(count, np.bool_)
        return Stretches(breaks, none, none, none)
    steps = np.append(breaks[1:], breaks[:1] + count) - breaks
    at = np.radians(program.angle)
    span = np.append(at[breaks[1:]], at[breaks[:1]] + TURN) - at[breaks]
    # A stretch with too few steps for a curve of its own is joined to its neighbours, and reported as blurred.
    crossed, few = steps < FEWEST_STEPS, steps < FEWEST_FOR_TWO
    # The first stretch begins at the first break, not at angle 0: rotate the flags into place.
    blurred, narrow, single = (
        np.roll(np.repeat(some, steps), breaks[0]) for some in (crossed, crossed & (span < SHORTEST), few & ~crossed)
    )
    return Stretches(breaks[~crossed | ~np.roll(crossed, 1)], blurred, narrow, single)


def table_angles(program: ProgramTable) -> Real:
    """Return the cam angles of a program's table, radians, within a turn."""
    return np.mod(np.radians(program.angle), TURN)
