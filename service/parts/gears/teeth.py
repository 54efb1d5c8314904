"""True tooth profiles as outlines of arcs: the involute and the fillet of :mod:`kinematics.gear.profile`.

Every tooth is made thinner by a play, as by a tool that is shifted sideways: both flanks are rotated about the axis and
remain the same involutes.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex
from kinematics.gear.profile import draw_half_space
from kinematics.gear.teeth import Gear
from service.parts.geometry.arc_chains import ArcChain, fit_chain
from service.parts.geometry.regions import Loop

AXIS_TOLERANCE = 1e-6
"""Share of a gear's radius within which an arc's centre is the axis."""


def make_teeth(gear: Gear, centre: complex, tooth_at: float, helix_angle: float = 0.0, play: float = 0.0) -> Loop:
    """Return the outline of all teeth, counter-clockwise; for an internal gear that of the hole.

    Parameters
    ----------
    gear : Gear
        Gear in millimetres, in the plane of rotation.
    centre : complex
    tooth_at : float
        Angle of a tooth's middle, radians.
    helix_angle : float
        Helix angle, radians.
    play : float
        Reduction of tooth thickness on the pitch circle, millimetres.

    Raises
    ------
    DimensionError
        If the cutter would come to a point.
    """
    half = fit_chain(_make_half_space(gear, helix_angle, play))
    return _repeat_spaces(half, round(gear.teeth), centre, tooth_at, gear.pitch_radius)


def make_bevel_teeth(virtual: Gear, teeth: int, cone: float, at: float, tooth_at: float, play: float = 0.0) -> Loop:
    """Return the outline of bevel teeth in a plane normal to the axis, about 0, with the same corners in every pitch.

    Tredgold's approximation: the profile of the spur gear on the developed back cone is wrapped back on the cone, and
    extended in straight lines to the apex (Norton, Design of Machinery, Sec. 9.5).

    Parameters
    ----------
    virtual : Gear
        The spur gear of the back cone at the large end, of z / cos γ teeth; millimetres.
    teeth : int
    cone : float
        The pitch cone angle γ, radians.
    at : float
        Distance of the plane from the apex, millimetres.
    tooth_at : float
        Angle of a tooth's middle, radians.
    play : float
        Reduction of tooth thickness on the pitch circle, millimetres.
    """
    half = _make_half_space(virtual, 0.0, play)
    distance = virtual.pitch_radius / math.tan(cone)
    angles = cone + np.arctan((np.abs(half) - virtual.pitch_radius) / distance)
    # Arc length on the pitch circle equals that on the back cone's.
    turned = np.angle(half) / math.cos(cone)
    space = _make_space(fit_chain(at * np.tan(angles) * np.exp(1j * turned)), at * math.tan(cone))
    pitch = 2.0 * math.pi / teeth
    turns = [complex(np.exp(1j * (tooth_at + (k + 0.5) * pitch))) for k in range(teeth)]
    return Loop(tuple(turn * z for turn in turns for z in space.corners[:-1]), tuple(space.bulges) * teeth)


def _repeat_spaces(half: ArcChain, teeth: int, centre: complex, tooth_at: float, pitch_radius: float) -> Loop:
    """Return all teeth from half of a space about 0, from its middle to that of a tip."""
    space = _make_space(half, pitch_radius)
    pitch = 2.0 * math.pi / teeth
    around = ArcChain([space.corners[0]], [])
    for k in range(teeth):
        turned = space.rotate(complex(np.exp(1j * k * pitch)))
        # Merge the corner in the middle of a tip.
        at = len(around.corners) - 1
        around = around.append(turned)
        if k:
            # The two halves of each tip arc become one arc.
            around = around.merge_edges(at, 0j, AXIS_TOLERANCE * pitch_radius)
    turn = complex(np.exp(1j * (tooth_at + 0.5 * pitch)))
    return Loop(tuple(centre + turn * z for z in around.corners[:-1]), tuple(around.bulges))


def _make_space(half: ArcChain, pitch_radius: float) -> ArcChain:
    """Return the chain from the middle of a tooth through a space to the middle of the next."""
    space = half.reverse().mirror().append(half)
    return space.merge_edges(len(half.corners) - 1, 0j, AXIS_TOLERANCE * pitch_radius)


def _make_half_space(gear: Gear, helix_angle: float, play: float) -> Complex:
    """Return points from the middle of a space along root, fillet and flank to the middle of a tip."""
    points = draw_half_space(gear, helix_angle)
    if play > 0.0:
        # Each flank gives half of the play.
        moved = points * np.exp(0.5j * play / gear.pitch_radius)
        # The space widens: add its new middle at the root.
        points = np.concatenate([[abs(points[0])], moved])
    end = math.pi / gear.teeth
    angles = np.angle(points)
    beyond = int(np.searchsorted(angles > end, True))
    if beyond < len(points):
        # Flanks that intersect below the tip leave a pointed tooth.
        share = (end - angles[beyond - 1]) / (angles[beyond] - angles[beyond - 1])
        points = np.append(points[:beyond], points[beyond - 1] + share * (points[beyond] - points[beyond - 1]))
    return points
