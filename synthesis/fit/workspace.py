"""A workspace packed for compiled fits: obstacles to avoid, a box to stay within, and zones for pivots.

The block ``space`` becomes one vector in task coordinates, :func:`pack_workspace`.
:mod:`synthesis.fit.workspace_margins` turns the joints of a linkage along its motion into these margins, in this order:

============ ======================================= ==========================================================
constraint   margins                                 value, in task sizes
============ ======================================= ==========================================================
pivot zones  one for each pivot that has zones       depth of the pivot in the nearest of them
box          four for each window of the motion      distance of the parts from a side, positive inside
obstacles    one for each window, part and obstacle  distance of the outlines minus the clearance; minus the depth
                                                     for outlines that overlap
forces       one for each window and limit           :mod:`synthesis.fit.fourbar_forces`, for fourbars only
============ ======================================= ==========================================================

The motion is divided into :data:`WINDOW_COUNT` windows of :data:`STEP_COUNT` steps each. In each window the nearest
place counts, also between the steps. So rows are few, and the nearest place may move along the motion while a fit
descends.
Obstacles and the body are convex pieces (:mod:`synthesis.fit.convex_pieces`).

All fits aim at slightly narrower limits than those checked (:data:`AIM_SHARE`), so that the sweep of the finished
linkage (:mod:`synthesis.verification.workspace`), which shares no code with this, confirms them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.fit.convex_pieces import decompose_convex
from synthesis.fit.fourbar_forces import NO_FORCE_LIMITS as NO_LIMITS
from synthesis.fit.fourbar_forces import count_force_margins
from synthesis.model.linkage.workspace import Space
from synthesis.model.linkage.zones import MovingZone, Zone

WINDOW_COUNT, STEP_COUNT = 12, 4
"""Number of windows of the motion, and of steps in each."""

AIM_SHARE = 1e-4
"""Amount by which all fits aim inside the checked limits, as a share of the task's size."""

NARROW_SHARE = 0.2
"""Maximum extra margin in a small zone, as a share of its half width."""

O2, A, B, O4, P, TURN = range(6)
"""Joints, in the order in which margins expect their places, followed by the rotation e^{iα} of a carried body."""

PLACES = 6
"""Number of these places."""

FOURBAR_PARTS = ((O2, A), (O4, B), (A, B, P))
"""Parts of a fourbar with a coupler point; with an outline of the body the coupler is A, B alone."""

MAX_PIECES = 120
"""Maximum number of convex pieces of all obstacles, and of the body, because a step of a fit examines each. Outlines
with more are simplified for the fit, but not for verification."""

MAX_GROUPS = 24
"""Maximum number of pieces of obstacles, and of the body, with margins of their own. If there are more, all pieces of
an outline share a margin."""

(
    COUNT_INDEX, HALF_WIDTH_INDEX, CLEARANCE_INDEX, LEFT_INDEX, RIGHT_INDEX, LOW_INDEX, HIGH_INDEX, HAS_BOX_INDEX,
    FIRST_X_INDEX, FIRST_Y_INDEX, CYCLE_INDEX, PART_COUNT_INDEX, BODY_COUNT_INDEX, GROUP_COUNT_INDEX, PIECE_COUNT_INDEX,
    ZONE_COUNT_INDEX, ZONES_START_INDEX, PARTS_START_INDEX, BODY_START_INDEX, PIECES_START_INDEX, EASED_INDEX,
    FORCE_COUNT_INDEX, FORCES_START_INDEX,
) = range(23)  # fmt: skip
"""Indices of a packed workspace: number of margins; half of a link's width; required clearance; the box, and whether
one exists; P of the body as drawn; whether the whole cycle counts; numbers of parts, of groups of the body's pieces, of
groups of the obstacles' pieces, of these pieces, and of pivots with zones; the beginnings of these tables; the easing
by which the body's limits are less narrow in the first and last window; number and beginning of the margins of forces
(:mod:`synthesis.fit.fourbar_forces`)."""

HEADER_SIZE = 23

NO_WORKSPACE = np.zeros(0)
"""Packed workspace without constraints."""


def _pack_box(
    box: tuple[tuple[float, float], tuple[float, float]], origin: complex, size: float, aim: float
) -> tuple[float, float, float, float]:
    """Return left, right, low and high of a box in task coordinates, every side narrowed by the aim."""
    (left, low), (right, high) = box
    return (
        (left - origin.real) / size + aim,
        (right - origin.real) / size - aim,
        (low - origin.imag) / size + aim,
        (high - origin.imag) / size - aim,
    )


def pack_workspace(
    space: Space | None,
    origin: complex,
    size: float,
    *,
    first: complex | None = None,
    aim: float = AIM_SHARE,
    spare: float = np.inf,
    forces: Real = NO_LIMITS,
) -> Real:
    """Pack a workspace in task coordinates, with ``origin`` at 0 and ``size`` at 1; empty without constraints.

    Parameters
    ----------
    space : Space or None
        The requested workspace.
    origin, size : complex and float
        Origin and size of the task.
    first : complex, optional
        P of the body as drawn, in the problem's coordinates, for a linkage that carries one.
    aim : float
        Share of the task's size by which all limits are narrowed.
    spare : float
        Clearance of the body beyond the required one at the ends of the motion. The targets fix the body there, so
        its limits cannot be narrowed further.
    forces : float
        Limits on forces, packed by :func:`synthesis.fit.fourbar_forces.pack_forces`.
    """
    if space is None:
        return _append_forces(np.zeros(HEADER_SIZE), [[], [], [], []], forces) if len(forces) else NO_WORKSPACE
    zones = _pack_zones(space, origin, size, first is not None, aim)
    # Zones need only the first position; box and obstacles the whole motion.
    moves = space.has_swept_constraints
    carries = space.body is not None and first is not None
    # The body's outline stands for the coupler's third corner.
    links = [[joint for joint in part if not (carries and joint == P)] for part in FOURBAR_PARTS] if moves else []
    body: list[list[float]] = []
    if moves and space.body is not None and carries:
        outline = np.array([complex(*corner) for corner in space.body.outline])
        body = _pack_pieces([((outline - origin) / size, 0.0)])
    obstacles = (
        [] if not moves else [((points - origin) / size, radius / size) for points, radius in _list_outlines(space)]
    )
    pieces = _pack_pieces(obstacles)
    if not zones and not moves and not len(forces):
        return NO_WORKSPACE
    groups = len({piece[0] for piece in pieces})
    bodies = len({piece[0] for piece in body})
    windows = WINDOW_COUNT * (4 if space.box is not None else 0) + WINDOW_COUNT * (len(links) + bodies) * groups
    header = np.zeros(HEADER_SIZE)
    header[COUNT_INDEX] = len(zones) + windows
    header[HALF_WIDTH_INDEX], header[CLEARANCE_INDEX] = 0.5 * space.link_width / size, space.clearance / size + aim
    header[LEFT_INDEX : HIGH_INDEX + 1] = -np.inf, np.inf, -np.inf, np.inf
    if space.box is not None:
        header[LEFT_INDEX : HIGH_INDEX + 1] = _pack_box(space.box, origin, size, aim)
    header[HAS_BOX_INDEX], header[CYCLE_INDEX] = space.box is not None, space.over == "cycle"
    if first is not None:
        header[FIRST_X_INDEX] = (first.real - origin.real) / size
        header[FIRST_Y_INDEX] = (first.imag - origin.imag) / size
    header[PART_COUNT_INDEX], header[BODY_COUNT_INDEX], header[GROUP_COUNT_INDEX] = len(links), bodies, groups
    # Ease the aim of the body at the ends by the part that its spare clearance does not cover.
    header[PIECE_COUNT_INDEX], header[ZONE_COUNT_INDEX], header[EASED_INDEX] = (
        len(pieces),
        len(zones),
        aim - min(aim, max(spare / size, 0.0)),
    )
    tables: list[list[list[float]]] = [
        [one for listed in zones for one in listed],
        [[float(len(link)), *map(float, link), *[-1.0] * (3 - len(link))] for link in links],
        body,
        pieces,
    ]
    return _append_forces(header, tables, forces)


def _append_forces(header: Real, tables: Sequence[list[list[float]]], forces: Real) -> Real:
    """Concatenate the numbers of a workspace, table after table, and the limits on forces after them."""
    numbers = [header]
    at = HEADER_SIZE
    for place, table in zip(
        (ZONES_START_INDEX, PARTS_START_INDEX, BODY_START_INDEX, PIECES_START_INDEX), tables, strict=True
    ):
        header[place] = at
        # A record never begins with a negative number, so −1 marks the end of a table.
        numbers.append(np.array([value for record in table for value in record] + [-1.0]))
        at += len(numbers[-1])
    header[FORCE_COUNT_INDEX], header[FORCES_START_INDEX] = count_force_margins(forces), at
    header[COUNT_INDEX] += header[FORCE_COUNT_INDEX]
    return np.concatenate([*numbers, forces])


def select_zones(room: Real) -> Real:
    """Return a packed workspace with the pivots' zones alone, which need no motion; empty without zones."""
    # With counts of zero the kernels skip the other tables, so the tables need not be removed.
    if not len(room) or room[ZONE_COUNT_INDEX] == 0.0:
        return NO_WORKSPACE
    zones = room.copy()
    zones[COUNT_INDEX], zones[HAS_BOX_INDEX], zones[GROUP_COUNT_INDEX], zones[FORCE_COUNT_INDEX] = (
        room[ZONE_COUNT_INDEX],
        0.0,
        0.0,
        0.0,
    )
    return zones


def _list_outlines(space: Space) -> list[tuple[Complex, float]]:
    return [zone.outline for zone in space.obstacles]


def _pack_pieces(outlines: Sequence[tuple[Complex, float]]) -> list[list[float]]:
    """Pack convex pieces as records: group, radius, middle, reach about it, number of corners, corners."""
    found = [decompose_convex(corners, 1.0, MAX_PIECES) for corners, _ in outlines]
    # The first pass limits the pieces of each outline; if there are too many in total, the outlines share the limit.
    if sum(len(pieces) for pieces, _ in found) > MAX_PIECES:
        share = max(MAX_PIECES // len(outlines), 1)
        found = [decompose_convex(corners, 1.0, share) for corners, _ in outlines]
    listed = [
        (number, piece, outlines[number][1] + beyond)
        for number, (pieces, beyond) in enumerate(found)
        for piece in pieces
    ]
    # Few pieces have margins of their own, which are smoother; otherwise each outline has one.
    alone = len(listed) <= MAX_GROUPS
    records = []
    for n, (number, piece, radius) in enumerate(listed):
        middle = complex(piece.mean())
        reach = float(np.abs(piece - middle).max())
        group = float(n if alone else number)
        head = [group, radius, middle.real, middle.imag, reach, float(len(piece))]
        records.append([*head, *np.ascontiguousarray(piece).view(np.float64).tolist()])
    return records


def _pack_zones(space: Space, origin: complex, size: float, carries: bool, aim: float) -> list[list[list[float]]]:
    """Pack the zones of each pivot as records.

    A record holds the joint, whether the zone is on the body, its radius, margin, number of corners, and corners.
    """
    fixed, moving = space.fixed_pivots, space.moving_pivots
    demanded = (
        fixed.input if fixed else None,
        fixed.output if fixed else None,
        moving.input if moving else None,
        moving.output if moving else None,
    )
    tables = []
    for zones, joint in zip(demanded, (O2, O4, A, B), strict=True):
        if zones is None:
            continue
        records = []
        for zone in [zones] if isinstance(zones, Zone) else zones:
            corners, radius = zone.outline
            corners = _orient_anticlockwise((corners - origin) / size)
            # A narrow zone must not vanish by the extra margin, so limit it to a share of the zone's half width.
            half = radius / size if len(corners) == 1 else _estimate_half_width(zone) / size
            # A linkage without a body has only the frame of the ground.
            on_body = carries and isinstance(zone, MovingZone) and zone.frame == "body"
            head = [float(joint), float(on_body), radius / size, min(aim, NARROW_SHARE * half), float(len(corners))]
            records.append([*head, *corners.view(np.float64).tolist()])
        tables.append(records)
    return tables


def _estimate_half_width(zone: Zone) -> float:
    """Estimate half of the maximum width of a polygon, from its area and bounding box."""
    left, right, low, high = zone.bounds
    return zone.size / (2.0 * max(right - left, high - low))


def _orient_anticlockwise(corners: Complex) -> Complex:
    area = float((corners.conj() * np.roll(corners, -1)).imag.sum())
    return np.ascontiguousarray(corners if area >= 0.0 else corners[::-1])
