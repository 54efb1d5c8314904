"""Clearances of a finished drive, measured on its outlines over an index and a rest."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.indexing.design import GenevaMechanism, IndexingDesign
from synthesis.kinds.indexing.polygons import measure_depth, measure_distance, measure_play, subdivide_outline
from synthesis.kinds.indexing.spherical_drive import measure_on_sphere

MOVING_POSITIONS, RESTING_POSITIONS = 173, 61
"""Numbers of positions of an index, different from those used to construct the disc, and of a rest."""

PASSING_POSITIONS = 721
"""Number of positions of a rest at which the distance of the rollers from the wheel is measured."""

MAX_PIECE_LENGTH = 1.0 / 60.0
"""Longest straight piece of an outline, in center distances."""

TRIAL_ANGLE = 0.005
"""Angle, radians, by which a resting wheel is turned beyond its play to test whether the disc holds it."""

CORNER_TOLERANCE = 1e-9
"""Share of a length within which a corner counts as on a line or a circle."""


@dataclass(frozen=True)
class MeasuredDrive:
    """Measurements on the outlines of a drive, in length units except for ``locked``.

    Attributes
    ----------
    roller : float
        Minimum distance of the roller's center from the wheel over an index.
    passing : float
        The same distance for rollers outside slots, over a rest and over the index of another roller. On a sphere, at
        most the diameter of the roller.
    overlap : float
        Maximum depth of the wheel in the disc over an index and a rest; 0 if they stay separate.
    locked : float
        Share of the rest over which the wheel cannot turn in either direction.
    locked_angle : float
        The locked part of the rest in degrees of the crank.
    play : float
        Degrees by which the wheel can be turned in the middle of a rest.
    wall, web : float
        Distances from a slot to a locking arc, and between neighbouring slots.
    inmost : float
        Distance from the wheel's axis to the nearest point of a slot.
    outmost : float
        Distance from the wheel's axis to the farthest point of its outline; for a ring, of its slots.
    neck : float
        Minimum radius of the disc about the crank's axis.
    size : float
        Extent of the wheel and the crank along the line of both axes, or diameter.
    """

    roller: float
    passing: float
    overlap: float
    locked: float
    locked_angle: float
    play: float
    wall: float
    web: float
    inmost: float
    outmost: float
    neck: float
    size: float


def measure_drive(design: IndexingDesign, half: float) -> MeasuredDrive:
    """Measure a drive; ``half`` is half of its index, radians of the crank."""
    mechanism = design.mechanism
    if not isinstance(mechanism, GenevaMechanism):
        return MeasuredDrive(**measure_on_sphere(mechanism))
    # In an internal drive the crank and the wheel's slots face the other way.
    c, sense = mechanism.center_distance, 1.0 if mechanism.type == "geneva_external" else -1.0
    outline = np.array(mechanism.profile.x) + 1j * np.array(mechanism.profile.y)
    stations = np.arange(mechanism.stations)
    arcs = c * np.exp(1j * math.pi * (2 * stations + 1) / mechanism.stations)
    points = subdivide_outline(outline, MAX_PIECE_LENGTH * c, arcs, mechanism.locking_arc_radius)
    alpha = np.linspace(-half, half, MOVING_POSITIONS)
    roller = c - sense * mechanism.crank_radius * np.exp(1j * alpha)
    turn = np.angle(roller)

    def find_deepest(crank: Real, wheel: Real) -> Real:
        """Return the maximum depth in each position: crank angles from mid-index, directions of slot 0."""
        seen = (points * np.exp(1j * wheel)[:, None] - c) * (-sense * np.exp(-1j * crank))[:, None]
        return np.asarray(measure_depth(mechanism.disc, seen).max(axis=1))

    # From the exit of one roller to the entry of the next.
    rest = np.linspace(half, 2.0 * math.pi / mechanism.rollers - half, RESTING_POSITIONS)
    still = np.full(RESTING_POSITIONS, turn[-1])
    # Play is measured at mid-rest, farthest from entry and exit.
    middle = float(rest[RESTING_POSITIONS // 2])
    play = measure_play(lambda by: find_deepest(np.full_like(by, middle), still[0] + by), math.pi / mechanism.stations)
    tried = TRIAL_ANGLE + play
    held = (find_deepest(rest, still + tried) > 0.0) & (find_deepest(rest, still - tried) > 0.0)
    overlap = max(float(find_deepest(alpha, turn).max()), float(find_deepest(rest, still).max()), 0.0)
    locked = float(held.mean())
    return MeasuredDrive(
        roller=measure_distance(outline, np.asarray(roller * np.exp(-1j * turn))),
        passing=_measure_passing(mechanism, outline, alpha, turn),
        overlap=overlap,
        locked=locked,
        play=math.degrees(play),
        locked_angle=locked * math.degrees(float(rest[-1] - rest[0])),
        **_measure_walls(mechanism, outline, arcs),
        outmost=float(np.abs(outline).max()),
        neck=min(mechanism.disc.outer_radius),
        size=_measure_extent(mechanism, outline, sense),
    )


def _measure_passing(mechanism: GenevaMechanism, outline: Complex, alpha: Real, turn: Real) -> float:
    """Return the minimum distance of rollers outside slots; ``alpha``, ``turn`` belong to the first roller's index."""
    c, sense = mechanism.center_distance, 1.0 if mechanism.type == "geneva_external" else -1.0
    half, pitch = float(alpha[-1]), 2.0 * math.pi / mechanism.rollers
    rest = np.linspace(half, pitch - half, PASSING_POSITIONS)
    # The first roller is in no slot during the rest and during the indexes of the other rollers.
    crank = np.concatenate([rest, *(alpha + pitch * k for k in range(1, mechanism.rollers))])
    others = pitch * np.arange(mechanism.rollers)[:, None]
    wheel = np.concatenate([np.full(PASSING_POSITIONS, turn[-1]), np.tile(turn, mechanism.rollers - 1)])
    at_rest = (rest + others[1:]).ravel()
    crank, wheel = np.append(crank, at_rest), np.append(wheel, np.full(len(at_rest), turn[-1]))
    places = np.asarray((c - sense * mechanism.crank_radius * np.exp(1j * crank)) * np.exp(-1j * wheel), np.complex128)
    # A roller farther from the wheel's circle than its own diameter cannot be near the wheel.
    apart = sense * (np.abs(places) - mechanism.wheel_radius)
    sampled = measure_distance(outline, places[apart < mechanism.roller_diameter])
    # Include corners that the path, a circle about the crank's axis, passes between two sampled positions.
    seen = (outline * np.exp(1j * turn[-1]) - c) * -sense
    passed = np.mod(np.angle(seen) - half, pitch) <= pitch - 2.0 * half
    return min(sampled, float(np.abs(np.abs(seen[passed]) - mechanism.crank_radius).min(initial=math.inf)))


def _measure_walls(mechanism: GenevaMechanism, outline: Complex, arcs: Complex) -> dict[str, float]:
    """Measure wall, web and innermost point by the corners of the outline."""
    half_slot, step = 0.5 * mechanism.slot_width, math.pi / mechanism.stations
    on_arc = (
        np.abs(np.abs(outline - arcs[0]) - mechanism.locking_arc_radius)
        < CORNER_TOLERANCE * mechanism.locking_arc_radius
    )
    from_slot = np.abs(outline.imag)
    # Slot 0, with all points within half its width of its axis; and the next one.
    near = (from_slot <= half_slot * (1.0 + CORNER_TOLERANCE)) & (outline.real > 0.0)
    slot = outline[near]
    if not (on_arc.any() and near.any()):
        # An outline without slots or arcs at the reported places.
        return {"wall": 0.0, "web": 0.0, "inmost": 0.0}
    return {
        "wall": float(from_slot[on_arc].min()) - half_slot,
        "web": float(np.abs(slot[:, None] - slot * np.exp(2j * step)).min()),
        "inmost": float(np.abs(slot).min()),
    }


def _measure_extent(mechanism: GenevaMechanism, outline: Complex, sense: float) -> float:
    if mechanism.ring_radius is not None:
        return 2.0 * mechanism.ring_radius
    far = float(np.abs(outline).max())
    return far + mechanism.center_distance + mechanism.crank_radius + 0.5 * mechanism.roller_diameter * sense
