"""Interference depth of tips in the teeth cut by given tools, by simulation of the cutting.

A tool removes the material that it passes over while blank and tool roll on each other. A corner of a tip is placed at
every position of the mesh; it is free if some position of the tool has removed that point, and otherwise its depth is
the smallest distance to the removed region. The method needs neither the start of an involute nor the shape of a
fillet: the rack is a trapezium with rounded corners that moves along a line, the cutter of a ring is a gear with sharp
corners that turns.

Lengths are in the unit of the module, angles radians. Gears stand at 0 with the middle of a tooth space on the positive
real axis, their mates and tools in it.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.gear.teeth import Gear, Mesh, compute_corner_rounding

Freedom = Callable[[Complex, Real], Real]
"""Depth of points of a blank inside a tool, as a function of the points and the blank's rotation; negative outside."""

CORNER_POSITIONS = 121
"""Number of positions of a corner on its path through the mate."""

TOOL_POSITIONS, REFINED_POSITIONS, REFINEMENTS = 61, 13, 3
"""Tool positions tried for every point, positions between the neighbours of the best one, and number of refinements."""


def measure_tip_depth(mesh: Mesh, cutter_teeth: int) -> float:
    """Measure how deep the tips dig into their mates: the larger of two depths, at most zero if both run free.

    Parameters
    ----------
    mesh : Mesh
        External gears, each cut by its rack with the rounded corners of ISO 53; or a pinion in a ring.
    cutter_teeth : int
        Teeth of the cutter, without shift, that shapes a ring down to its dedendum.

    Returns
    -------
    float
        Depth in the unit of the module. Flanks in proper contact touch: zero to within 1e-8 of the module.
    """
    one, two, apart = mesh.pinion, mesh.gear, mesh.centre_distance
    if two.internal:
        return max(
            _measure_depth(one, _trace_corner_in_pinion(one, two, apart), _build_rack_freedom(one)),
            _measure_depth(two, _trace_corner_in_ring(one, two, apart), _build_cutter_freedom(two, cutter_teeth)),
        )
    return max(
        _measure_depth(one, _trace_corner_outside(one, two, apart), _build_rack_freedom(one)),
        _measure_depth(two, _trace_corner_outside(two, one, apart), _build_rack_freedom(two)),
    )


def _measure_depth(gear: Gear, corner: Complex, freedom: Freedom) -> float:
    """Measure the maximum depth of points in the material of a gear."""
    # Range of tool positions: its straight flank meets the tip this far from the middle, beyond any contact.
    most = 1.5 * (gear.addendum + gear.dedendum) * gear.module / math.sin(gear.pressure_angle) / gear.pitch_radius
    turns = np.broadcast_to(np.linspace(-most, most, TOOL_POSITIONS), (len(corner), TOOL_POSITIONS))
    step = turns[0, 1] - turns[0, 0]
    for _ in range(REFINEMENTS + 1):
        free = freedom(corner[:, None], turns)
        # Each point has its own best tool position; refine around it.
        best = np.take_along_axis(turns, np.argmax(free, axis=1)[:, None], axis=1)
        turns = best + np.linspace(-step, step, REFINED_POSITIONS)
        step *= 2.0 / (REFINED_POSITIONS - 1)
    beyond = np.abs(corner) - gear.tip_radius
    # A point beyond the tip circle lies outside the blank and is free as well.
    outside = -beyond if gear.internal else beyond
    return float(-np.maximum(free.max(axis=1), outside).min())


def _build_rack_freedom(gear: Gear) -> Freedom:
    """Build the freedom of points in an external gear's rack; its reference line is ``shift`` outside the pitch circle.

    The tooth is a trapezium, inset from flanks and tip of the rack by the radius of its corners and then widened by it.
    """
    m, phi = gear.module, gear.pressure_angle
    rounding = m * compute_corner_rounding(phi, gear.dedendum)
    sine, cosine = math.sin(phi), math.cos(phi)
    # Inset by the corner radius, which is added back at the end.
    deepest = m * gear.dedendum - rounding
    across = 0.25 * math.pi * m * cosine - rounding
    corner = (across - deepest * sine) / cosine

    def measure_freedom(points: Complex, turns: Real) -> Real:
        at = points * np.exp(1j * turns)
        beside = np.abs(at.imag - gear.pitch_radius * turns)
        depth = gear.pitch_radius + gear.shift * m - at.real
        below, off_flank = depth - deepest, beside * cosine + depth * sine - across
        # Outside the inset trapezium: beyond its flank, its tip, or its corner.
        over_flank = (beside - corner) * sine - below * cosine >= 0.0
        beyond = np.where(over_flank, off_flank, np.where(beside <= corner, below, np.hypot(beside - corner, below)))
        inside = np.maximum(below, off_flank)
        return np.asarray(rounding - np.where(inside <= 0.0, inside, beyond))

    return measure_freedom


def _build_cutter_freedom(ring: Gear, teeth: int) -> Freedom:
    """Build the freedom of points in a tooth of a ring's cutter, a gear whose addendum is the ring's dedendum."""
    cutter = Gear(teeth, ring.module, ring.pressure_angle, ring.dedendum, ring.dedendum)
    apart = Mesh(cutter, ring).centre_distance
    base = cutter.base_radius

    def measure_freedom(points: Complex, turns: Real) -> Real:
        # Rolling: the cutter turns by the ratio of the teeth.
        at = (points * np.exp(1j * turns) - apart) * np.exp(-1j * turns * ring.teeth / teeth)
        radius = np.abs(at)
        # Below the base circle the flank is taken as radial.
        flank = np.maximum(radius / base, 1.0)
        rolled = np.sqrt(flank**2 - 1.0)
        half = 0.5 * math.pi / teeth + math.tan(ring.pressure_angle) - ring.pressure_angle - rolled + np.arctan(rolled)
        # Parallel involutes of one base circle keep the distance of their starting points along it.
        return np.asarray(np.minimum(base * (half - np.abs(np.angle(at))), cutter.tip_radius - radius))

    return measure_freedom


def _trace_corner_outside(gear: Gear, mate: Gear, apart: float) -> Complex:
    """Trace a corner of an external mate's tip through an external gear, in that gear's frame."""
    turns = _list_turns_in_reach(mate.tip_radius, apart, gear.tip_radius)
    at = apart - mate.tip_radius * np.exp(1j * turns)
    return np.asarray(at * np.exp(1j * (turns - _compute_half_tip(mate)) * (mate.teeth / gear.teeth)))


def _trace_corner_in_pinion(pinion: Gear, ring: Gear, apart: float) -> Complex:
    """Trace a corner of a ring's tip through the pinion, in the pinion's frame."""
    turns = _list_turns_in_reach(ring.tip_radius, apart, pinion.tip_radius)
    at = ring.tip_radius * np.exp(1j * turns) - apart
    return np.asarray(at * np.exp(-1j * (turns - _compute_half_tip(ring)) * (ring.teeth / pinion.teeth)))


def _trace_corner_in_ring(pinion: Gear, ring: Gear, apart: float) -> Complex:
    """Trace a corner of the pinion's tip through the ring, in the ring's frame."""
    cosine = (ring.tip_radius**2 - apart**2 - pinion.tip_radius**2) / (2.0 * apart * pinion.tip_radius)
    most = math.acos(min(1.0, max(-1.0, cosine)))
    turns = np.linspace(-most, most, CORNER_POSITIONS)
    at = apart + pinion.tip_radius * np.exp(1j * turns)
    return np.asarray(at * np.exp(-1j * (turns - _compute_half_tip(pinion)) * (pinion.teeth / ring.teeth)))


def _list_turns_in_reach(radius: float, apart: float, reach: float) -> Real:
    """List the angles of a point on a circle, from the line of centres, at which it is within reach of another centre.

    If it never is, all angles are zero, the nearest position.
    """
    cosine = (apart**2 + radius**2 - reach**2) / (2.0 * apart * radius)
    most = math.acos(min(1.0, max(-1.0, cosine)))
    return np.linspace(-most, most, CORNER_POSITIONS)


def _compute_half_tip(gear: Gear) -> float:
    """Compute half the angle of a tooth on its tip circle; zero if the flanks meet below it."""
    # There is no involute below the base circle.
    radius = max(gear.tip_radius, gear.base_radius)
    return max(0.0, gear.thickness_at(radius) / (2.0 * radius))
