"""Limits on forces as margins of a fourbar in its chart, and their rows in a fit.

The forces follow from the closed form (:mod:`kinematics.dynamics.fourbar`) at equal steps of the crank: over a full
turn of a crank, else from the first point to the last. In each of :data:`WINDOW_COUNT` windows of the motion the peak F
of each limited force has a margin, ln(limit / F), so that a fit sees every peak of a force curve and not only the
highest one. The derivatives are finite differences, because the weights of the links depend on the unknowns, too. The
evaluation of one linkage takes a few microseconds.

The packed limits follow those of a workspace (:mod:`synthesis.fit.workspace`), of which these margins are the last.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from kinematics.arrays import Real
from kinematics.compiling import njit
from kinematics.dynamics.fourbar import DRIVE, JOINT, SHAKING_FORCE, SHAKING_MOMENT, fill_peaks
from synthesis.fit.chart import LENGTHS, OPTIONS, POINT
from synthesis.fit.coupler_curve import close_two_bars, compute_unit_vector, find_crank_range
from synthesis.fit.fourbar_loads import (
    ABOUT,
    AT_POINT,
    COUPLES,
    FORCE,
    FORCES,
    GRAVITY,
    LINKS,
    LOADS,
    PINS,
    SPEED,
    pack_loads,
    weigh_links,
)
from synthesis.model.dynamics.request import DesignDynamics, ForceQuantity, LengthUnit

WINDOW_COUNT, POSITION_COUNT = 12, 145
"""Number of windows of the motion, and of positions in all of them together, both ends included."""

AIM_SHARE = 0.005
"""Share by which forces are kept below their limits: peaks lie between the positions."""

MAX_MARGIN = 1.0
"""Maximum margin. Larger ones are cut off, because a force below a third of its limit does not matter."""

DIFFERENCE_STEP = 1e-6
"""Step of the finite differences, in angles, logarithms of lengths, and places in task sizes."""

SIZE, LIMITS_INDEX, INDEX, STRENGTH, COUPLE, BLOCK = 0, 1, 5, 6, 7, 8
"""Indices of the packed limits: the task's size in the length unit of the forces, the limits of the first four peaks,
the limit of the joint force index, the strength of the load to which that index refers, the link of this load if it is
a torque (otherwise −1), and the beginning of the block of loads. An absent limit is infinite."""

QUANTITIES = 5
"""Number of limited quantities: drive torque, joint force, shaking force, shaking moment and joint force index."""

ARGUMENT_COUNT = 11
"""Number of arguments of the forces: the nine numbers of the chart, and the crank angles at the first and last
point."""

NO_FORCE_LIMITS = np.zeros(0)
"""Packed limits of a task without limits on forces."""


def pack_forces(
    dynamics: DesignDynamics | None,
    limits: Mapping[ForceQuantity, float],
    unit: LengthUnit,
    origin: complex,
    size: float,
) -> Real:
    """Pack limits on forces with their loads; empty without limits, or if the closed form does not cover the block.

    Parameters
    ----------
    dynamics : DesignDynamics or None
        Masses and loads of every design.
    limits : mapping of str to float
        Limits by the names of the forces.
    unit : str
        The length unit.
    origin, size : complex and float
        Origin and size of the task, in length units.
    """
    if dynamics is None or not limits or dynamics.speed_rpm is None:
        return NO_FORCE_LIMITS
    block = pack_loads(dynamics, unit, origin)
    if block is None:
        return NO_FORCE_LIMITS
    out = np.full(BLOCK, np.inf)
    out[SIZE], out[COUPLE], out[STRENGTH] = size * dynamics.scale(unit), -1.0, 1.0
    places: dict[ForceQuantity, int] = {
        "drive_torque": DRIVE,
        "joint_force": JOINT,
        "shaking_force": SHAKING_FORCE,
        "shaking_moment": SHAKING_MOMENT,
    }
    for name, place in places.items():
        if name in limits:
            out[LIMITS_INDEX + place] = limits[name]
    speed = abs(float(block[SPEED]))
    # At constant speed a power limit is a torque limit; the stricter of the two applies.
    if "power" in limits and speed > 0.0:
        out[LIMITS_INDEX + DRIVE] = min(out[LIMITS_INDEX + DRIVE], limits["power"] / speed)
    if "joint_force_index" in limits and dynamics.loads:
        # The index relates joint forces to the first load alone.
        first = dynamics.loads[0]
        out[INDEX] = limits["joint_force_index"]
        if first.force is None:
            out[COUPLE] = list(LINKS).index(str(first.link))
        elif first.joint in ("O2", "O4"):
            out[INDEX] = np.inf  # the load acts on the frame alone
        else:
            out[STRENGTH] = abs(complex(*(first.force.constant or (1.0, 0.0)))) or 1.0
    # Aim lower by the share that a peak between two positions may add.
    out[LIMITS_INDEX : INDEX + 1] *= 1.0 - AIM_SHARE
    return np.concatenate([out, block]) if np.isfinite(out[LIMITS_INDEX : INDEX + 1]).any() else NO_FORCE_LIMITS


@njit(**OPTIONS)
def count_force_margins(forces: Real) -> int:
    """Return the number of margins."""
    stated = 0
    for k in range(QUANTITIES if len(forces) else 0):
        if forces[LIMITS_INDEX + k] < np.inf:
            stated += 1
    return stated * WINDOW_COUNT


@njit(**OPTIONS)
def compute_window_peaks(charts: Real, lengths: Real, sign: float, ends: Real, forces: Real, out: Real) -> None:
    """Compute the peaks of n fourbars in each window, shape (n, WINDOW_COUNT, QUANTITIES); infinite if one is open.

    ``charts`` (n, 9) and ``lengths`` (n, 4) describe the linkages, and ``ends`` (n, 2) are their crank angles from the
    ground line at the first and the last point.
    """
    count, size, block = len(charts), forces[SIZE], forces[BLOCK:]
    loads = int(block[LOADS])
    o2s, o4s = np.empty(count, np.complex128), np.empty(count, np.complex128)
    about, points = np.empty(count, np.complex128), np.empty(count, np.complex128)
    starts, spans = np.empty(count), np.empty(count)
    mass, inertia, pins = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3))
    cg = np.empty((count, 3), np.complex128)
    arms, acting = np.empty((count, loads), np.complex128), np.empty((count, loads), np.complex128)
    joints = np.empty(5, np.complex128)
    sound = np.ones(count, np.bool_)
    for n in range(count):
        x, own = charts[n], lengths[n]
        # Weights are defined at the first target, because loads and centres of mass may be given in the plane there.
        ground, crank = compute_unit_vector(x[2]), compute_unit_vector(x[2] + ends[n, 0])
        closes, along = close_two_bars(own[0] * ground - own[1] * crank, own[2], own[3], sign)
        o2 = complex(x[0], x[1])
        joints[0], joints[1], joints[3] = o2, o2 + own[1] * crank, o2 + own[0] * ground
        joints[2] = joints[1] + own[2] * along
        joints[4] = joints[1] + complex(x[POINT], x[POINT + 1]) * along
        joints *= size
        o2s[n], o4s[n], points[n] = joints[0], joints[3], size * complex(x[POINT], x[POINT + 1])
        about[n] = complex(block[ABOUT], block[ABOUT + 1]) if block[AT_POINT] > 0.0 else joints[0]
        sound[n] = closes and weigh_links(block, joints, mass[n], cg[n], inertia[n], arms[n], acting[n])
        pins[n] = block[PINS : PINS + 3]
        low, high = find_crank_range(own[0], own[1], own[2], own[3])
        starts[n] = x[2] + ends[n, 0]
        # A crank repeats its forces every turn; a rocker is only driven between its ends.
        spans[n] = 2.0 * math.pi if low == 0.0 and high == math.pi else ends[n, 1] - ends[n, 0]
    on, turning = np.empty(loads, np.int64), np.empty(loads, np.bool_)
    for k in range(loads):
        on[k], turning[k] = int(block[FORCES + FORCE * k]), block[FORCES + FORCE * k + 6] > 0.0
    signs = np.full(count, sign)
    a, b, c = size * lengths[:, 1], size * lengths[:, 2], size * lengths[:, 3]
    found = np.empty((count, WINDOW_COUNT, 5))
    fill_peaks(
        o2s, o4s, a, b, c, points, signs, starts, spans, mass, cg, inertia, pins,
        complex(block[GRAVITY], block[GRAVITY + 1]), on, arms, acting, turning, block[COUPLES : COUPLES + 3], about,
        block[SPEED], POSITION_COUNT, found,
    )  # fmt: skip
    out[:, :, : QUANTITIES - 1] = found[:, :, : QUANTITIES - 1]
    if forces[INDEX] < np.inf:
        # Only the first of the loads, on links without mass.
        couples = np.zeros(3)
        first = 0 if forces[COUPLE] >= 0.0 else 1
        if first == 0:
            couples[int(forces[COUPLE])] = 1.0
        mass[:], inertia[:], pins[:] = 0.0, 0.0, 0.0
        fill_peaks(
            o2s, o4s, a, b, c, points, signs, starts, spans, mass, cg, inertia, pins, 0j, on[:first],
            np.ascontiguousarray(arms[:, :first]), np.ascontiguousarray(acting[:, :first]), turning[:first], couples,
            about, 0.0, POSITION_COUNT, found,
        )  # fmt: skip
        out[:, :, QUANTITIES - 1] = found[:, :, JOINT] / forces[STRENGTH]
    for n in range(count):
        # Reject linkages that do not close or whose holes leave nothing of a plate.
        if not sound[n]:
            out[n] = np.inf


@njit(**OPTIONS)
def compute_force_margins(x: Real, lengths: Real, sign: float, ends: Real, forces: Real, values: Real) -> bool:
    """Write the margins of one linkage; return False if it does not close all along its motion.

    Parameters
    ----------
    x, lengths : float, shapes (9 or more,) and (4,)
        Unknowns of the chart, and lengths.
    sign : float
        Assembly.
    ends : float, shape (2,)
        Crank angles from the ground line at the first point and the last.
    forces : float, shape (m,)
        Packed limits, see :func:`pack_forces`.
    values : float, shape (count_force_margins(forces),)
        Output: the margins.
    """
    found = np.empty((1, WINDOW_COUNT, QUANTITIES))
    charts, sizes, angles = np.empty((1, 9)), np.empty((1, 4)), np.empty((1, 2))
    charts[0], sizes[0], angles[0] = x[:9], lengths, ends
    compute_window_peaks(charts, sizes, sign, angles, forces, found)
    m = 0
    for k in range(QUANTITIES):
        limit = forces[LIMITS_INDEX + k]
        if limit == np.inf:
            continue
        for w in range(WINDOW_COUNT):
            force = found[0, w, k]
            if force == np.inf:
                return False
            # A force that vanishes, or is far below its limit, must not give an infinite margin.
            values[m] = min(math.log(limit / force), MAX_MARGIN) if force > 0.0 and limit > 0.0 else MAX_MARGIN
            # With a limit of 0 a logarithm does not exist; the force itself is the violation.
            if limit == 0.0 and force > 0.0:
                values[m] = -force
            m += 1
    return True


@njit(**OPTIONS)
def compute_force_slopes(
    x: Real, lengths: Real, slopes: Real, sign: float, ends: Real, turns: Real, forces: Real, rows: Real
) -> None:
    """Write the derivatives of the margins by the unknowns, shape (margins, unknowns).

    ``slopes`` are those of the lengths, ``turns``, shape (2, unknowns), those of the crank angles at both ends.
    """
    charts, sizes, angles = (
        np.empty((ARGUMENT_COUNT + 1, 9)),
        np.empty((ARGUMENT_COUNT + 1, 4)),
        np.empty((ARGUMENT_COUNT + 1, 2)),
    )
    # Row 0 is the linkage itself; row n + 1 has argument n perturbed. All are evaluated in one call.
    for n in range(ARGUMENT_COUNT + 1):
        charts[n], sizes[n], angles[n] = x[:9], lengths, ends
        move = n - 1
        # The lengths follow the chart to first order, so they need not be recomputed.
        if LENGTHS <= move < LENGTHS + 4:
            sizes[n] += DIFFERENCE_STEP * slopes[:, move - LENGTHS]
        elif move >= 9:
            angles[n, move - 9] += DIFFERENCE_STEP
        if 0 <= move < 9:
            charts[n, move] += DIFFERENCE_STEP
    found = np.empty((ARGUMENT_COUNT + 1, WINDOW_COUNT, QUANTITIES))
    compute_window_peaks(charts, sizes, sign, angles, forces, found)
    m = 0
    rows[:] = 0.0
    for k in range(QUANTITIES):
        if forces[LIMITS_INDEX + k] == np.inf:
            continue
        for w in range(WINDOW_COUNT):
            force = found[0, w, k]
            # A peak that vanishes or does not exist has no logarithm, so its row stays 0.
            if 0.0 < force < np.inf:
                for n in range(ARGUMENT_COUNT):
                    moved = found[n + 1, w, k]
                    # d ln(limit/F) = −dF/F.
                    by = (force - moved) / (DIFFERENCE_STEP * force) if moved < np.inf else 0.0
                    if n < 9:
                        rows[m, n] += by
                    # The end angles depend on all unknowns: apply the chain rule.
                    else:
                        rows[m] += by * turns[n - 9]
            m += 1


def compute_min_margins(charts: Real, lengths: Real, sign: float, ends: Real, forces: Real) -> Real:
    """Compute the minimum margin of each of n fourbars, shape (n,), as for :func:`compute_window_peaks`.

    −∞ if one does not close.
    """
    found = np.empty((len(charts), WINDOW_COUNT, QUANTITIES))
    compute_window_peaks(charts, lengths, sign, ends, forces, found)
    limits = forces[LIMITS_INDEX : LIMITS_INDEX + QUANTITIES]
    stated = np.isfinite(limits)
    with np.errstate(divide="ignore"):
        logs = np.log(limits[stated]) - np.log(found[:, :, stated].max(axis=1))
    # NaN arises for a force of 0 under a limit of 0, which is satisfied.
    return np.asarray(np.where(np.isnan(logs), MAX_MARGIN, logs).min(axis=1))
