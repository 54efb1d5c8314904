"""Checks of a finished linkage against its workspace: pivots in their zones, and a motion without collisions.

The mechanism is rebuilt from its answer and swept over its motion (:mod:`kinematics.linkage.clearance`), so that no
contact between two positions is missed. An undecided check counts as failed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex
from kinematics.errors import MechanismError
from kinematics.linkage.clearance import Part, sweep_pairs
from kinematics.linkage.planar.limits import find_branches, find_reference_branch
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from synthesis.model.answer import Check
from synthesis.model.dimension import LENGTH
from synthesis.model.linkage.workspace import Space
from synthesis.model.linkage.zones import MovingZone, Zone
from synthesis.model.protocols import VerifiedRange
from synthesis.verification.branch_drive import MechanismOnBranch
from synthesis.verification.penetration import measure_penetration

WORKSPACE_CHECKS = ("fixed_pivot_zones", "moving_pivot_zones", "box", "obstacles")
"""Names of the workspace checks."""

BODY_POINT = "P"
"""Name of the body's point P, a joint that only the link with the body has."""


class FirstPosition(NamedTuple):
    """The body in its first position, as requested and as reached by the linkage.

    Attributes
    ----------
    point : complex
        Requested position of P.
    met : complex
        Position of P in the reference configuration.
    turned : float
        Rotation of the body in the reference configuration from the requested angle, radians.
    """

    point: complex
    met: complex
    turned: float

    def map_to_body(self, places: Complex) -> Complex:
        """Map points of the linkage in its reference configuration to the body in its requested position."""
        return np.asarray(self.point + (places - self.met) * np.exp(-1j * self.turned))

    def map_to_reference(self, places: Complex) -> Complex:
        """Map points of the body in its requested position to the reference configuration of the linkage."""
        return np.asarray(self.met + (places - self.point) * np.exp(1j * self.turned))


def check_space(
    space: Space, mechanism: Mechanism, used: VerifiedRange, first: FirstPosition | None = None
) -> list[Check]:
    """Check each constraint of the workspace.

    Parameters
    ----------
    space : Space
        The requested workspace.
    mechanism : Mechanism
        The finished linkage, in its reference configuration at the first target.
    used : VerifiedRange
        The motion over which it was verified.
    first : FirstPosition, optional
        The first position of the body, for a linkage that carries one.
    """
    checks = []
    sides = _list_sides(mechanism)
    for demanded, moving in ((space.fixed_pivots, False), (space.moving_pivots, True)):
        if demanded is None:
            continue
        gone = 0.0
        for zones, side in zip((demanded.input, demanded.output), sides, strict=True):
            if zones is not None:
                gone = max(gone, _measure_zone_distance(zones, mechanism, side.moving if moving else side.fixed, first))
        # The distance of a missing pivot is infinite, which is not a number in JSON: report no value.
        value = gone if math.isfinite(gone) else None
        checks.append(
            Check(name=WORKSPACE_CHECKS[moving], passed=gone == 0.0, value=value, limit=0.0, dimension=LENGTH)
        )
    return [*checks, *_check_sweep(space, mechanism, used, first)]


class _Side(NamedTuple):
    """Names of the pivots of the input side or the output side; None for a missing pivot."""

    fixed: str | None
    moving: str | None


def _list_sides(mechanism: Mechanism) -> tuple[_Side, _Side]:
    """Return the pivots of the input side and of the output side."""
    ground = mechanism.links[GROUND]
    crank = _Side("O2" if "O2" in ground else None, "A" if "A" in mechanism.joints else None)
    other = next((joint for joint in ("O4", "O5") if joint in ground), None)
    # If A is on a slide, B is not a pin of the output.
    pinned = "B" in mechanism.joints and not any(slide.joint == "A" for slide in mechanism.slides)
    output = _Side(other, "B" if pinned else None)
    # A driven slider is the input, so the sides change places.
    return (output, crank) if mechanism.has_slide_input else (crank, output)


def _measure_zone_distance(
    zones: Zone | Sequence[Zone], mechanism: Mechanism, joint: str | None, first: FirstPosition | None
) -> float:
    """Return the distance of a pivot from its zones; infinite for a linkage without this pivot."""
    if joint is None:
        return math.inf
    place = np.asarray(mechanism.joints[joint]).reshape(1)
    gone = []
    for zone in [zones] if isinstance(zones, Zone) else zones:
        on_body = isinstance(zone, MovingZone) and zone.frame == "body" and first is not None
        at = first.map_to_body(place) if on_body and first is not None else place
        gone.append(float(zone.compute_distances(at)[0]))
    return min(gone)


def _check_sweep(space: Space, mechanism: Mechanism, used: VerifiedRange, first: FirstPosition | None) -> list[Check]:
    """Check that links and body stay within the box and clear of the obstacles."""
    if not space.has_swept_constraints:
        return []
    span = _find_input_range(space, mechanism, used)
    moving = list_moving_parts(space, mechanism, first)
    checks = []
    if space.box is not None:
        # Without a motion nothing can be proven, so the check fails without a value.
        walls, away = _build_walls(space.box, mechanism, moving)
        nearest, kept = (None, False) if span is None else _measure_clearance(mechanism, moving, walls, span, away)
        # The walls are shifted outward by ``away``; a smaller clearance means that a part extends beyond its side.
        beyond = None if nearest is None else max(away - nearest, 0.0) if not kept else 0.0
        checks.append(Check(name="box", passed=kept, value=beyond, limit=0.0, dimension=LENGTH))
    if space.obstacles:
        obstacles = [Part(GROUND, *zone.outline) for zone in space.obstacles]
        nearest, kept = (
            (None, False) if span is None else _measure_clearance(mechanism, moving, obstacles, span, space.clearance)
        )
        checks.append(Check(name="obstacles", passed=kept, value=nearest, limit=space.clearance, dimension=LENGTH))
    return checks


def list_moving_parts(space: Space, mechanism: Mechanism, first: FirstPosition | None) -> list[Part]:
    """Return the moving parts in the reference configuration: the hulls of the links' joints, and the body."""
    body = space.body is not None and first is not None
    parts = []
    for link, joints in mechanism.links.items():
        if link == GROUND:
            continue
        # If the body has an outline, P does not extend the hull of its link.
        kept = [joint for joint in joints if not (body and joint == BODY_POINT)]
        hull = _build_hull(np.array([complex(mechanism.joints[joint]) for joint in kept]))
        parts.append(Part(link, hull, 0.5 * space.link_width))
    if space.body is not None and first is not None:
        outline = np.array([complex(*corner) for corner in space.body.outline])
        parts.append(Part(find_carrier(mechanism), first.map_to_reference(outline), 0.0))
    return parts


def find_carrier(mechanism: Mechanism) -> str:
    """Return the name of the link that carries the body, which has the joint P."""
    return next(link for link, joints in mechanism.links.items() if BODY_POINT in joints and link != GROUND)


def _build_hull(points: Complex) -> Complex:
    """Return the corners of the convex hull of one or more points."""
    from shapely import MultiPoint, get_coordinates

    hull = MultiPoint(np.stack([points.real, points.imag], axis=1)).convex_hull
    corners: Complex = get_coordinates(hull).view(np.complex128).ravel()
    # Shapely closes a polygon by repeating its first corner.
    return corners[:-1] if hull.geom_type == "Polygon" else corners


def _find_input_range(space: Space, mechanism: Mechanism, used: VerifiedRange) -> tuple[float, float] | None:
    """Return the minimum and maximum input of the motion to check, radians or length units; None if there is none."""
    if space.over == "used":
        ends = used.used_stroke
        if ends is None and used.used_range is not None:
            # An answer has degrees, the analysis core radians.
            ends = math.radians(used.used_range[0]), math.radians(used.used_range[1])
        return None if ends is None else (min(ends), max(ends))
    try:
        here = find_reference_branch(mechanism, find_branches(mechanism))
    # A change point in the motion leaves the branch undefined, so nothing can be proven.
    except MechanismError:
        return None
    return None if here is None else MechanismOnBranch(mechanism, here).range


def _measure_clearance(
    mechanism: Mechanism, moving: list[Part], fixed: list[Part], span: tuple[float, float], wanted: float
) -> tuple[float, bool]:
    """Return the minimum distance of moving parts from fixed ones, and whether it reaches the required one.

    If parts overlap the distance is negative: the depth, by which a part has to be shifted until it is outside.
    """
    pairs = [(n, len(moving) + k) for n in range(len(moving)) for k in range(len(fixed))]
    # Every pair must report its distance, because the answer contains the minimum.
    found = sweep_pairs(mechanism, [*moving, *fixed], pairs, *span, wanted, nearest="all")
    least = min(pair.least for pair in found)
    if least < 0.0:
        least = min(least, -measure_penetration(mechanism, [*moving, *fixed], pairs, *span))
    return least, all(pair.keeps for pair in found)


def _build_walls(
    box: tuple[tuple[float, float], tuple[float, float]], mechanism: Mechanism, moving: list[Part]
) -> tuple[list[Part], float]:
    """Build the four sides of a box, shifted outward by a distance ``away`` that no part can bridge.

    A part within the box is at least ``away`` from every shifted side. If the distance is smaller, the difference is
    the amount by which the part extends beyond the side. So the box is checked by the same sweep as obstacles.
    Return the sides and ``away``.
    """
    (left, low), (right, high) = box
    places = np.array([complex(z) for z in mechanism.joints.values()])
    middle = complex(0.5 * (left + right), 0.5 * (low + high))
    reach = float(np.abs(places - middle).max()) + sum(
        float(np.abs(part.points - part.points[0]).max()) for part in moving
    )
    # Twice the largest possible excursion, so that no part reaches a shifted side, where the distance would become 0.
    away = 2.0 * (reach + abs(complex(right - left, high - low)) + max(part.radius for part in moving))
    x, y = (left - away, right + away), (low - away, high + away)
    corners = np.array([complex(x[0], y[0]), complex(x[1], y[0]), complex(x[1], y[1]), complex(x[0], y[1])])
    return [Part(GROUND, corners[[n, (n + 1) % 4]], 0.0) for n in range(4)], away
