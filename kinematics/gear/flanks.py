"""Where the involute of a tooth begins, and whether a mate's tip reaches beyond it: fillet interference.

A rack cuts an external gear. Its straight flank ends a depth k below its reference line, where the rounded corner
begins: k = h_f − ρ (1 − sin φ), all in modules. On the line of action of cutting, measured from where it touches the
base circle, the involute begins at

    f = r sin φ − m (k − x) / sin φ,

negative where the rack undercuts the gear; its involute then begins where the fillet crosses it, which
:func:`kinematics.gear.profile.involute_start` tells. A ring is shaped by a cutter with the teeth of a gear, whose tip
corner is sharp: with the distance a_c and the pressure angle φ_c of cutting the involute of the ring ends at

    f = a_c sin φ_c + √(r_ac² − r_bc²).

In a mesh the tip of the mate reaches down to u = C sin φ_w − √(r_a² − r_b²) on an external gear, and out to
u = C sin φ_w + √(r_a² − r_b²) on a ring: contact stays on involutes if u ≥ f on an external gear and u ≤ f on a ring
(J. R. Colbourne, The Geometry of Involute Gears, 1987, ch. 5 and 8).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from kinematics.errors import DimensionError
from kinematics.gear.teeth import Gear, Mesh

TIP_ROUNDING = 0.38
"""Radius of the rack's rounded tip in modules (ISO 53, profile A); less where the tip is not wide enough for it."""

CUTTER_ADDENDUM = 1.25
"""Addendum of a cutter for rings, in modules: the dedendum that it leaves at no shift."""


def corner_rounding(pressure_angle: float, dedendum: float) -> float:
    """Radius of the rack's rounded tip, modules.

    Raises
    ------
    DimensionError
        Where the rack's tooth comes to a point before it has cut to the root circle.
    """
    wide = 0.25 * math.pi - dedendum * math.tan(pressure_angle)
    if wide < 0.0:
        raise DimensionError("dedendum", "no deeper than the point of the rack's tooth", dedendum)
    return min(TIP_ROUNDING, wide * math.cos(pressure_angle) / (1.0 - math.sin(pressure_angle)))


def straight_depth(pressure_angle: float, dedendum: float) -> float:
    """How far below its reference line the straight flank of the rack reaches, modules.

    >>> round(straight_depth(math.radians(20.0), 1.25), 4)
    1.0
    """
    return dedendum - corner_rounding(pressure_angle, dedendum) * (1.0 - math.sin(pressure_angle))


def rack_cut_form(gear: Gear, depth: float) -> float:
    """Where the rack's straight flank ends on an external gear, from the base circle's tangent point on.

    There the involute begins; negative: undercut.

    ``depth``: how far below its reference line the straight flank of the rack reaches, modules.
    """
    sine = math.sin(gear.pressure_angle)
    return gear.pitch_radius * sine - gear.module * (depth - gear.shift) / sine


def least_shift_of_rack(teeth: float, pressure_angle: float, depth: float) -> float:
    """Shift below which a rack whose straight flank reaches this deep undercuts a gear: x = k − z sin² φ / 2."""
    return depth - 0.5 * teeth * math.sin(pressure_angle) ** 2


@dataclass(frozen=True)
class ShapedRing:
    """A ring and the cutter, without shift and with sharp corners, that shapes it; the cutter's depth makes its root.

    Raises
    ------
    DimensionError
        For a cutter with as many teeth as the ring, or a shift at which no cutter meshes with the ring.
    """

    ring: Gear
    cutter_teeth: int

    def __post_init__(self) -> None:
        _ = self.cutting

    @cached_property
    def cutting(self) -> Mesh:
        """Cutter and ring as they mesh at the end of cutting, without play."""
        ring = self.ring
        cutter = Gear(self.cutter_teeth, ring.module, ring.pressure_angle, ring.dedendum, ring.dedendum)
        return Mesh(cutter, ring)

    @property
    def form(self) -> float:
        """Where the involute of the ring ends, from the base circle's tangent point on."""
        cutter = self.cutting.pinion
        reached = math.sqrt(cutter.tip_radius**2 - cutter.base_radius**2)
        return self.cutting.centre_distance * math.sin(self.cutting.pressure_angle) + reached

    @property
    def root_radius(self) -> float:
        """Radius of the circle that the tips of the cutter reach."""
        return self.cutting.centre_distance + self.cutting.pinion.tip_radius

    @property
    def is_trimmed(self) -> bool:
        """Whether the cutter takes off tips of the ring: outside the line of action, or where it has no involute."""
        mesh = self.cutting
        tip = math.sqrt(max(self.ring.tip_radius**2 - self.ring.base_radius**2, 0.0))
        return mesh.tips_foul or tip < mesh.centre_distance * math.sin(mesh.pressure_angle)


@dataclass(frozen=True)
class Contact:
    """A mesh whose involutes begin at ``forms``, from the tangent points of the base circles on.

    ``reaches`` are how deep the mate's tip reaches on pinion and gear, measured alike. Specific sliding at a point of
    contact is the sliding velocity over the velocity with which the point runs along the flank; it is given where it is
    greatest on each flank, at the deepest point reached: −∞ where that is on the base circle.
    """

    mesh: Mesh
    forms: tuple[float, float]

    @property
    def reaches(self) -> tuple[float, float]:
        """The deepest points of contact on pinion and gear; a ring is reached outwards."""
        mesh, (one, two) = self.mesh, self._tips
        between = mesh.centre_distance * math.sin(mesh.pressure_angle)
        return (two - between, between + one) if mesh.gear.internal else (between - two, between - one)

    @property
    def _tips(self) -> tuple[float, float]:
        """Where the tip circles of both gears cut the line of action, each from its own tangent point."""
        one, two = (
            math.sqrt(max(gear.tip_radius**2 - gear.base_radius**2, 0.0)) for gear in (self.mesh.pinion, self.mesh.gear)
        )
        return one, two

    @property
    def margins(self) -> tuple[float, float]:
        """Length of involute below the deepest point of contact, on pinion and gear; negative: contact in a fillet."""
        (one, two), (first, second) = self.reaches, self.forms
        return one - first, (second - two if self.mesh.gear.internal else two - second)

    @property
    def specific_sliding(self) -> tuple[float, float]:
        """The greatest specific sliding of each flank, below its pitch circle: 1 − (u₂ z₁) / (u₁ z₂) on the pinion."""
        mesh, tips, deepest = self.mesh, self._tips, self.reaches
        teeth = mesh.pinion.teeth / mesh.gear.teeth
        return _slid(tips[1] * teeth, deepest[0]), _slid(tips[0] / teeth, deepest[1])

    @property
    def backlash(self) -> float:
        """Play on the working pitch circles, exactly: the pitch there less the thickness of both teeth."""
        mesh = self.mesh
        wide = math.cos(mesh.pinion.pressure_angle) / math.cos(mesh.pressure_angle)
        radii = mesh.pinion.pitch_radius * wide, mesh.gear.pitch_radius * wide
        pitch = 2.0 * math.pi * radii[0] / mesh.pinion.teeth
        return pitch - mesh.pinion.thickness_at(radii[0]) - mesh.gear.thickness_at(radii[1])


def _slid(mate: float, own: float) -> float:
    return 1.0 - mate / own if own > 0.0 else -math.inf


def shortened_tips(mesh: Mesh) -> float:
    """By how much, in modules, the tips of an external pair are shortened to leave the clearance of unshifted gears.

    Shifted gears move apart by less than their shifts, x₁ + x₂ − (C − C₀) / m, and that is what their tips lose.
    """
    if mesh.gear.internal:
        return 0.0
    apart = (mesh.centre_distance - mesh.standard_distance) / mesh.pinion.module
    return max(0.0, mesh.pinion.shift + mesh.gear.shift - apart)
