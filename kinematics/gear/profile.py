"""Outlines of spur gears: the true involute, and the fillet that a rack with a rounded tip leaves.

In the frame of a tooth space whose middle lies on the positive real axis the flank of an external gear stands, at the
radius R ≥ r_b, at the angle π/z − t(R)/2R, t the arc thickness of the tooth. Below it the rounded corner of the rack
generates a trochoid: with the corner's centre a distance d below the pitch line and y beside the middle of the rack's
tooth, the point whose normal has turned by ψ from the radial one is met when the line of this normal passes through the
pitch point, that is after the rack has moved by s = d tan ψ − y,

    Q(ψ) = (r − d + i d tan ψ − ρ e^{−iψ}) e^{−is/r},       0 ≤ ψ ≤ π/2 − φ

(F. L. Litvin & A. Fuentes, Gear Geometry and Applied Theory, 2004, ch. 10). It meets the involute smoothly, or crosses
it where the gear is undercut: there its involute begins.

A helical gear is shown as the plane of rotation cuts it. There the rack is stretched by q = 1/cos β along its pitch
line, its corner with it: a normal that has turned by θ in the normal plane has turned by ψ here, tan ψ = tan θ / q, and
the point is met after s = d tan ψ + ρ sin θ (1/q − q) − q y, so that

    Q(θ) = (r − d + i d tan ψ − ρ (cos θ − i sin θ / q)) e^{−is/r},       0 ≤ θ ≤ π/2 − φ_n.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.gear.flanks import corner_rounding
from kinematics.gear.teeth import Gear, involute

Outline = NDArray[np.complex128]
Reals = NDArray[np.float64]

FLANK, FILLET, ARC = 24, 20, 4
"""Points on a flank, a fillet, and half of a tip or root arc: chords within about 1e-4 of a module of the curve."""


class _Corner(NamedTuple):
    """The rounded corner of the rack that cuts a gear: its centre from the pitch line and beside its tooth's middle.

    ``stretch`` is that of the plane of rotation over the normal plane, in which the corner is a circle and its normal
    turns by up to ``end``.
    """

    rounding: float
    below: float
    beside: float
    stretch: float
    end: float


def half_space(gear: Gear, helix_angle: float = 0.0) -> Outline:
    """From the middle of a tooth space, on the real axis, along root, fillet and flank to the middle of the tip.

    Parameters
    ----------
    gear : Gear
        In the plane of rotation.
    helix_angle : float
        Radians; of a helical gear, whose rack is that of the normal plane.

    Returns
    -------
    Outline
        Points with rising polar angle from 0 to π/z, gear centre at 0.

    Raises
    ------
    DimensionError
        Where the rack's tooth comes to a point before it has cut to the root circle.
    """
    return _internal(gear) if gear.internal else _external(gear, _corner(gear, helix_angle))


def outline(gear: Gear, tooth_at: float = 0.0, helix_angle: float = 0.0) -> Outline:
    """The closed outline of all teeth, one tooth's middle at the polar angle ``tooth_at``; counter-clockwise."""
    half = half_space(gear, helix_angle)
    # From tooth to tooth: the half space run backwards and mirrored, then forwards.
    space = np.concatenate([half[::-1].conj(), half[1:]])[:-1]
    pitch = 2.0 * math.pi / gear.teeth
    turns = np.exp(1j * (tooth_at + 0.5 * pitch + pitch * np.arange(gear.teeth)))
    return np.asarray((turns[:, None] * space[None, :]).ravel())


def _corner(gear: Gear, helix_angle: float) -> _Corner:
    """The corner of the rack; lengths of a helical gear are those of the normal plane, but for its place beside."""
    phi, m, dedendum, stretch = gear.pressure_angle, gear.module, gear.dedendum, 1.0
    if helix_angle:
        cosine = math.cos(helix_angle)
        phi, m, dedendum = math.atan(math.tan(phi) * cosine), m * cosine, dedendum / cosine
        stretch = 1.0 / cosine
    rounding = m * corner_rounding(phi, dedendum)
    wide = 0.25 * math.pi - dedendum * math.tan(phi)
    beside = m * wide + rounding * (math.tan(phi) - 1.0 / math.cos(phi))
    below = gear.module * (gear.dedendum - gear.shift) - rounding
    return _Corner(rounding, below, stretch * beside, stretch, 0.5 * math.pi - phi)


def _external(gear: Gear, corner: _Corner) -> Outline:
    fillet = _fillet(gear.pitch_radius, corner, np.linspace(0.0, _fillet_end(gear, corner), FILLET))
    start, tip = max(abs(fillet[-1]), gear.base_radius), _tip(gear)
    least, most = (math.sqrt(max((end / gear.base_radius) ** 2 - 1.0, 0.0)) for end in (start, tip))
    rolls = np.linspace(least, most, FLANK)
    radii = gear.base_radius * np.hypot(1.0, rolls)
    flank = np.array([r * np.exp(1j * _space_angle(gear, r)) for r in radii])
    root = _arc(gear.root_radius, 0.0, float(np.angle(fillet[0])))
    return _distinct(np.concatenate([root, fillet, flank, _arc(tip, float(np.angle(flank[-1])), math.pi / gear.teeth)]))


def _distinct(points: Outline) -> Outline:
    """Without points that repeat the one before."""
    kept = np.abs(np.diff(points)) > 1e-9 * np.abs(points[:-1])
    return np.asarray(points[np.concatenate([[True], kept])])


def involute_start(gear: Gear, helix_angle: float = 0.0) -> float:
    """Where the involute of an external gear begins as its rack leaves it, from the base circle's tangent point on.

    Without undercut it is :func:`kinematics.gear.flanks.rack_cut_form`; of an undercut gear it is where the fillet
    crosses the flank, above the base circle.

    Parameters
    ----------
    gear : Gear
        In the plane of rotation.
    helix_angle : float
        Radians; of a helical gear, whose rack is that of the normal plane.

    Raises
    ------
    DimensionError
        Where the rack's tooth comes to a point before it has cut to the root circle.
    """
    radius, corner = np.array([gear.pitch_radius]), _corner(gear, helix_angle)
    return float(_starts(radius, gear.pressure_angle, np.array([_base_space(gear)]), corner)[0])


def full_depth_starts(teeth: NDArray[np.float64], pressure_angle: float) -> NDArray[np.float64]:
    """Where the involutes of full-depth spur gears without shift begin, in modules, as :func:`involute_start`."""
    corner = _corner(Gear(10.0, 1.0, pressure_angle), 0.0)  # the rack is one, whatever the teeth
    space = 0.5 * math.pi / teeth - involute(pressure_angle)
    return _starts(0.5 * teeth, pressure_angle, space, corner)


def _starts(radius: Reals, phi: float, space: Reals, corner: _Corner) -> Reals:
    """Where involutes begin, of gears of these pitch radii with this half of a space on their base circles."""
    ends = _straight_ends(radius, phi, corner)
    starts = ends.copy()
    cut = ends < 0.0
    if cut.any():
        met = np.abs(_fillet(radius[cut], corner, _crossing(radius[cut], phi, space[cut], corner)))
        starts[cut] = np.sqrt(np.maximum(met**2 - (radius[cut] * math.cos(phi)) ** 2, 0.0))
    return starts


def _straight_ends(radius: Reals, phi: float, corner: _Corner) -> Reals:
    """Where the end of the rack's straight flank cuts, from the base circle's tangent point on; negative: undercut."""
    deep = corner.below + corner.rounding * math.cos(corner.end)
    return radius * math.sin(phi) - deep / math.sin(phi)


def _crossing(radius: Reals, phi: float, space: Reals, corner: _Corner) -> Reals:
    """The parameters at which the fillets of undercut gears cross their flanks.

    From the root up the fillet meets the base circle inside the tooth, beyond the flank, and ends at the same radius
    as a point of the flank, but in the space: in between it crosses once.
    """
    base = radius * math.cos(phi)

    def bisected(is_low: Callable[[Reals], NDArray[np.bool_]], low: Reals) -> Reals:
        high = np.full_like(low, corner.end)
        for _ in range(60):
            middle = 0.5 * (low + high)
            below = is_low(middle)
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return low

    def inside(theta: Reals) -> NDArray[np.bool_]:
        point = _fillet(radius, corner, theta)
        there = np.arccos(np.minimum(1.0, base / np.abs(point)))
        return np.asarray(np.angle(point) > space + np.tan(there) - there)

    at_base = bisected(lambda theta: np.abs(_fillet(radius, corner, theta)) < base, np.zeros_like(radius))
    return bisected(inside, at_base)


def _fillet_end(gear: Gear, corner: _Corner) -> float:
    """The parameter at which the fillet passes into the flank: tangent at the corner's end, or crossing it before."""
    radius, phi = np.array([gear.pitch_radius]), gear.pressure_angle
    if _straight_ends(radius, phi, corner)[0] >= 0.0:
        return corner.end
    return float(_crossing(radius, phi, np.array([_base_space(gear)]), corner)[0])


def _base_space(gear: Gear) -> float:
    """Half the angle of the space between two external teeth, continued to the base circle."""
    return math.pi / gear.teeth - gear.tooth_thickness / (2.0 * gear.pitch_radius) - involute(gear.pressure_angle)


def _fillet(r: float | Reals, corner: _Corner, theta: Reals) -> Outline:
    """Points of the trochoid of the rack's corner on gears of pitch radius ``r``, from the root circle up."""
    below, q = corner.below, corner.stretch
    along = below * (np.tan(theta) / q)
    moved = along - corner.beside + corner.rounding * np.sin(theta) * (1.0 / q - q)
    circle = corner.rounding * np.exp(-1j * theta)
    point = r - below + 1j * along - (circle.real + 1j * (circle.imag / q))
    return np.asarray(point * np.exp(-1j * moved / r))


def _space_angle(gear: Gear, radius: float) -> float:
    """Half the angle of the space between two external teeth at a radius."""
    return math.pi / gear.teeth - gear.thickness_at(max(radius, gear.base_radius)) / (2.0 * radius)


def _tip(gear: Gear) -> float:
    """Tip radius, or where the flanks meet."""
    if not gear.is_pointed:
        return gear.tip_radius
    low, high = gear.pitch_radius, gear.tip_radius
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if gear.thickness_at(middle) > 0.0 else (low, middle)
    return low


def _internal(gear: Gear) -> Outline:
    """An internal gear: root arc, flank down to the tip, tip arc; below the base circle the flank is radial."""
    low = max(gear.tip_radius, gear.base_radius)
    radii = np.linspace(gear.root_radius, low, FLANK)
    half = math.pi / gear.teeth
    angles = np.array([half - gear.thickness_at(r) / (2.0 * r) for r in radii])
    return _distinct(
        np.concatenate(
            [
                _arc(gear.root_radius, 0.0, angles[0]),
                radii * np.exp(1j * angles),
                _arc(gear.tip_radius, angles[-1], half),
            ]
        )
    )


def _arc(radius: float, start: float, end: float) -> Outline:
    return np.asarray(radius * np.exp(1j * np.linspace(start, end, ARC)))
