"""The curves of a cam at the angles of its answer, by the textbooks: envelope of a roller, contacts of a face.

A cam that turns clockwise has the follower walk around it counter-clockwise; the other way it is mirrored.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from kinematics.arrays import Complex, Real
from tests.support.independent.cam_motion import Move, motion_at
from tests.support.independent.comparison import Beside

CURVES = ("profile", "outer_wall", "lower_wall", "upper_wall", "pitch_curve")

BREAK = 1e-6
"""Radians around a step of the acceleration within which a table may have the values of either side."""


def compare_curves(beside: Beside, moves: list[Move], unit: float) -> None:
    """The table of the motion, and the points of all curves; ``unit`` makes stated displacements lengths or radians."""
    mechanism = beside.design.mechanism
    table = mechanism.program
    at = np.radians(np.array(table.angle))
    motion = motion_at(moves, at)
    starts = np.concatenate([move.at[:, 0] for move in moves])
    near = np.clip(np.searchsorted(starts, at), 1, len(starts) - 1)
    apart = np.minimum(np.abs(at - starts[near]), np.abs(at - starts[near - 1]))
    inside = apart > BREAK
    for name, values in zip("svaj", motion, strict=True):
        stated = np.array(getattr(table, name)) * (unit if name == "s" else 1.0)
        scale = max(float(np.abs(stated).max()), 1e-300)
        off = np.abs(stated - values)
        off = off if name in "sv" else off[inside]
        beside.add("mechanism.program", float(off.max(initial=0.0)), 0.0, scale)
    for name in CURVES:
        curve = getattr(mechanism, name, None)
        if curve is None:
            continue
        angle = np.radians(np.array(curve.angle))
        found = _points(mechanism, name, angle, motion_at(moves, angle))
        stated = np.array(curve.x) + 1j * np.array(curve.y)
        beside.add(f"mechanism.{name}", float(np.abs(stated - found).max()), 0.0, float(np.abs(stated).max()))


def _points(mechanism: Any, name: str, angle: Real, motion: list[Real]) -> Complex:
    side = {"outer_wall": 1.0, "upper_wall": 1.0, "pitch_curve": 0.0}.get(name, -1.0)
    s, v, _, _ = motion
    follower = mechanism.follower
    if mechanism.type == "barrel_cam":
        radius = mechanism.cylinder_radius
        normal = (-v + 1j * radius) / np.hypot(radius, v)
        return np.asarray(radius * angle + 1j * s + side * follower.roller_radius * normal)
    if follower.type.endswith("flat"):
        radius, sense, pivot = mechanism.base_radius, follower.sense or 1, follower.pivot_distance
        if follower.type == "translating_flat":
            points = np.exp(1j * angle) * (radius + s + 1j * v)
        else:
            # The face's normal is a right angle less ψ off the line to the pivot, on the side to which the arm opens.
            offset = follower.face_offset or 0.0
            psi = math.asin((radius + offset) / pivot) + s
            normal = angle + sense * (0.5 * math.pi - psi)
            contact = pivot * np.sin(psi) - offset + 1j * pivot * np.cos(psi) * v / (1.0 - sense * v)
            points = np.exp(1j * normal) * contact
    else:
        if follower.type == "translating_roller":
            p = math.sqrt(mechanism.prime_radius**2 - follower.offset**2) + s + 1j * follower.offset
            along = v + 1j * p
        else:
            sense, arm, pivot = follower.sense or 1, follower.arm, follower.pivot_distance
            start = math.acos((pivot**2 + arm**2 - mechanism.prime_radius**2) / (2.0 * pivot * arm))
            swung = -arm * np.exp(-1j * sense * (start + s))
            p = pivot + swung
            along = -1j * sense * v * swung + 1j * p
        points = np.exp(1j * angle) * (p - 1j * side * follower.roller_radius * along / np.abs(along))
    return np.asarray(points if mechanism.rotation == "cw" else np.conj(points))
