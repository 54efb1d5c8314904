"""Conversion between the analysis core, with radians and exact curves, and the answer, with degrees and tables."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Literal

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.cam import follower as core
from kinematics.cam.barrel import BarrelCam
from kinematics.cam.finished.discretization import Stretches
from kinematics.cam.finished.local_curves import MIN_CHORDS, MIN_CHORDS_FOR_COARSER
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.profile import Cam, space_angles
from synthesis.kinds.cam.design import (
    BarrelCamMechanism,
    BarrelFollower,
    CamCurve,
    CamFollower,
    CamMechanism,
    ProgramTable,
)
from synthesis.mechanisms.cam import build_follower, get_follower_type, list_dimensions

SAME_ANGLE_TOLERANCE = 1e-9
"""Angle in radians below which a joint and one of the equal steps count as coincident."""

MAX_EQUAL_STEPS = 5760
"""Maximum number of equal steps of a profile."""

MIN_BREAK_DISTANCE = 0.02
"""Minimum distance of an equal step from a break, in steps. Rounding costs the curvature digits in a chord that is much
shorter than its neighbours, and in its subdivisions."""

MIN_POINT_SPACING = 0.1
"""Point spacing, in equal steps, below which no equal step is inserted between points, for the same reason."""

MIN_CHORDS_OF_ROLLER = 5.0
"""Minimum number of chords of the profile that the roller's radius must span to resolve the contact."""


MIN_COUNT_FACTOR = 1.1
"""Minimum growth factor of the number of equal steps while the roller's radius spans too few chords."""

MAX_STEP_RATIO = 1.5
"""Ratio of a step's length to the parts of a divided neighbour, up to which the step itself is not divided."""

MAX_PARTS = 8
"""Maximum number of parts into which a step is divided at once."""

JUMP_OFFSET = 1e-7
"""Distance in radians before a velocity jump at which an extra point closes the side of the profile that ends there."""

MIN_DIVIDED_ANGLE = 1.5e-7
"""Length in radians up to which a stretch between breaks is not divided. It includes the stretch next to a velocity
jump, but no longer ones: on these the effect of rounding on the curvature is reported with the curvature."""

MIN_STEPS = 2 * MIN_CHORDS
"""Minimum number of steps of the profile between two sharp bends of the motion, so that a second, coarser curve through
every other point still has enough chords."""


def choose_profile_angles(program: Program, curve: Callable[[Real], Complex], roller_radius: float, count: int) -> Real:
    """Return the cam angles of a profile: equal steps, the bends, and closer points on short stretches between bends.

    A small roller also needs close points, because its radius must span five chords of the curve that it touches.
    """
    breaks = np.union1d(np.union1d(program.joints[:-1], program.bends), _find_jump_angles(program))
    closer, step = _divide_short_stretches(
        breaks, np.append(np.union1d(program.joints[:-1], program.sharp_bends), TURN), count
    )
    while True:
        even = space_angles(count)
        # Bends are always points. Equal steps too near to bends, or to the closer points, are dropped.
        even = even[_measure_break_distance(even, breaks) > MIN_BREAK_DISTANCE * TURN / count]
        even = even[_measure_gap(even, np.union1d(breaks, closer)) > MIN_POINT_SPACING * TURN / count]
        others = np.union1d(even, _drop_duplicate_angles(closer, step, even))
        # A step that coincides with a break would make a chord of zero length.
        angle: Real = np.union1d(others[_measure_break_distance(others, breaks) > SAME_ANGLE_TOLERANCE], breaks)
        chord = np.abs(np.diff(curve(np.append(angle, TURN)))).max()
        if chord * MIN_CHORDS_OF_ROLLER <= roller_radius or roller_radius <= 0.0 or count >= MAX_EQUAL_STEPS:
            return angle
        # Chords shrink in proportion to the count. The minimum factor ensures progress.
        count = min(
            math.ceil(count * max(chord * MIN_CHORDS_OF_ROLLER / roller_radius, MIN_COUNT_FACTOR)), MAX_EQUAL_STEPS
        )


def _divide_short_stretches(breaks: Real, sharp: Real, count: int) -> tuple[Real, Real]:
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
        if MIN_DIVIDED_ANGLE < end - start < MIN_STEPS * TURN / count
    ]
    angle, step = _with_step(divided)
    ends = np.append(breaks, TURN)
    span = np.diff(ends)
    beside = np.isin(ends[:-1], sharp) | np.isin(ends[1:], sharp)
    few = np.diff(np.searchsorted(angle, ends)) < MIN_CHORDS - 1
    # A curve must not run across a sharp bend just because another bend is near.
    own = beside & few & (span > MIN_DIVIDED_ANGLE) & (span < MIN_CHORDS * TURN / count)
    others = ~own[np.searchsorted(ends, angle, side="right") - 1]
    shortest = [np.linspace(ends[k], ends[k + 1], MIN_CHORDS + 1)[1:-1] for k in np.flatnonzero(own)]
    added, added_step = _with_step(shortest)
    return np.append(angle[others], added), np.append(step[others], added_step)


def _with_step(divided: list[Real]) -> tuple[Real, Real]:
    """Concatenate equal divisions, with the step of each of their angles."""
    steps = [np.full(len(angles), angles[1] - angles[0]) for angles in divided]
    return np.concatenate([np.empty(0), *divided]), np.concatenate([np.empty(0), *steps])


def _measure_break_distance(angle: Real, breaks: Real) -> Real:
    """Return the distance of each angle from the nearest break, the first of which is 0."""
    before = angle - breaks[np.searchsorted(breaks, angle, side="right") - 1]
    after = np.append(breaks, TURN)[np.searchsorted(breaks, angle)] - angle
    return np.asarray(np.minimum(before, after))


def _measure_gap(angle: Real, others: Real) -> Real:
    """Return the width of the gap between others in which each angle lies; the first of the others is 0."""
    after = np.searchsorted(others, angle, side="right")
    return np.asarray(np.append(others, TURN)[after] - others[after - 1])


def _drop_duplicate_angles(angle: Real, step: Real, even: Real) -> Real:
    """Drop the angles that almost coincide with an equal step, which replaces them."""
    if not len(even):
        return angle
    around = np.clip(np.searchsorted(even, angle)[:, None] - [1, 0], 0, None) % len(even)
    # 0.4 of a step is less than half a step, so that every stretch keeps at least the points of its division.
    return np.asarray(angle[np.abs(angle[:, None] - even[around]).min(axis=1) > 0.4 * step])


def _find_jump_angles(program: Program) -> Real:
    """Return cam angles just before velocity jumps, at which the corners of the profile need a second point."""
    return np.sort(np.mod(program.velocity_jumps - JUMP_OFFSET, TURN))


def refine_angles(angle: Real, off: Real, allowed: float) -> Real:
    """Divide the steps with a deviation above half of the permitted value, and their neighbours.

    The deviation falls with the fourth power of the step if the curvature is smooth. At bends of the curvature it falls
    more slowly, and the next round divides again.
    """
    closed = np.append(angle, TURN + angle[0])
    # The fourth root gives the number of parts that reduces the deviation to half of the permitted value.
    parts = np.clip(np.ceil((off / (0.5 * allowed)) ** 0.25), 1.0, MAX_PARTS).astype(np.int64)
    whole = np.diff(closed)
    for beside in (-1, 1):
        # A step about as short as its neighbour's parts is not divided.
        longer = whole > MAX_STEP_RATIO * np.roll(whole / parts, beside)
        # A neighbour of a divided step is halved, so that step lengths change gradually.
        parts = np.where(longer, np.maximum(parts, np.minimum(np.roll(parts, beside), 2)), parts)
    # The tiny step before a velocity jump only closes the corner and is never divided.
    parts[whole < 2.0 * JUMP_OFFSET] = 1
    low, step = np.repeat(closed[:-1], parts), np.repeat(whole / parts, parts)
    within = np.arange(len(low)) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.unique(np.mod(low + step * within, TURN))


def build_cam_mechanism(cam: Cam, angle: Real, groove: bool = False) -> CamMechanism:
    """Build the mechanism of a cam at given cam angles, with both walls of its groove or with one profile."""
    oscillating = isinstance(cam.follower, core.OscillatingRoller | core.OscillatingFlat)
    unit = 180.0 / math.pi if oscillating else 1.0
    degrees = np.degrees(angle).tolist()
    # The prime circle gives the size of a roller's cam, the base circle that of a face's cam.
    roller = isinstance(cam.follower, core.TranslatingRoller | core.OscillatingRoller)
    return CamMechanism(
        follower=CamFollower(
            type=get_follower_type(cam.follower),
            **_collect_dimensions(cam.follower),
        ),
        prime_radius=cam.size if roller else None,
        base_radius=None if roller else cam.size,
        rotation=cam.rotation,
        profile=_build_curve(degrees, cam.profile(angle)),
        outer_wall=_build_curve(degrees, cam.outer_wall(angle)) if groove else None,
        pitch_curve=_build_curve(degrees, cam.pitch_curve(angle)),
        program=_build_table(cam.program, angle, unit),
    )


def _collect_dimensions(follower: core.Follower) -> dict[str, float]:
    """Return a follower's own dimensions; the offset of a face, which does not change the cam, only if it is not 0."""
    own = {name: getattr(follower, name) for name in list_dimensions(type(follower))}
    if isinstance(follower, core.TranslatingFlat) and follower.offset == 0.0:
        del own["offset"]
    return own


def build_barrel_mechanism(barrel: BarrelCam, rotation: Literal["ccw", "cw"], angle: Real) -> BarrelCamMechanism:
    """Build the mechanism of a barrel cam at given cam angles."""
    degrees = np.degrees(angle).tolist()
    return BarrelCamMechanism(
        follower=BarrelFollower(roller_radius=barrel.roller_radius),
        cylinder_radius=barrel.radius,
        rotation=rotation,
        lower_wall=_build_curve(degrees, barrel.wall(angle, -1)),
        upper_wall=_build_curve(degrees, barrel.wall(angle, 1)),
        pitch_curve=_build_curve(degrees, barrel.pitch_curve(angle)),
        program=_build_table(barrel.program, angle, 1.0),
    )


def _build_table(program: Program, angle: Real, unit: float) -> ProgramTable:
    """Tabulate the program at cam angles; ``unit`` converts the core's displacement into the answer's."""
    motion, bends = program.motion(angle), np.union1d(program.bends, _find_jump_angles(program))
    breaks = np.searchsorted(angle, bends - SAME_ANGLE_TOLERANCE)
    return ProgramTable(
        angle=np.degrees(angle).tolist(),
        s=(motion.s * unit).tolist(),
        v=motion.v.tolist(),
        a=motion.a.tolist(),
        j=motion.j.tolist(),
        breaks=np.unique(np.degrees(angle[breaks])).tolist(),
    )


def _build_curve(degrees: list[float], points: Complex) -> CamCurve:
    return CamCurve(angle=degrees, x=points.real.tolist(), y=points.imag.tolist())


def build_core_follower(mechanism: CamMechanism) -> core.Follower:
    """Build a mechanism's follower for the analysis core, from its dimensions alone.

    Raises
    ------
    DimensionError
        If no follower can have these dimensions.
    """
    stated = mechanism.follower
    radius = mechanism.prime_radius if stated.type.endswith("roller") else mechanism.base_radius
    return build_follower(stated.type, radius or 0.0, stated)


def read_points(curve: CamCurve) -> Complex:
    """Return a curve's points as complex numbers."""
    return np.array(curve.x) + 1j * np.array(curve.y)


def find_stretches(program: ProgramTable) -> Stretches:
    """Return the stretches into which the breaks of the motion divide a profile with the table's cam angles."""
    count = len(program.angle)
    breaks = np.flatnonzero(np.isin(program.angle, program.breaks))
    if not len(breaks):
        none = np.zeros(count, np.bool_)
        return Stretches(breaks, none, none, none)
    steps = np.append(breaks[1:], breaks[:1] + count) - breaks
    at = np.radians(program.angle)
    span = np.append(at[breaks[1:]], at[breaks[:1]] + TURN) - at[breaks]
    # A stretch with too few steps for a curve of its own is joined to its neighbours, and reported as blurred.
    crossed, few = steps < MIN_CHORDS, steps < MIN_CHORDS_FOR_COARSER
    # The first stretch begins at the first break, not at angle 0: rotate the flags into place.
    blurred, narrow, single = (
        np.roll(np.repeat(some, steps), breaks[0])
        for some in (crossed, crossed & (span < MIN_DIVIDED_ANGLE), few & ~crossed)
    )
    return Stretches(breaks[~crossed | ~np.roll(crossed, 1)], blurred, narrow, single)


def read_table_angles(program: ProgramTable) -> Real:
    """Return the cam angles of a program's table, radians, within a turn."""
    return np.mod(np.radians(program.angle), TURN)
