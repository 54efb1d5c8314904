"""Start of the involute of a tooth, and contact beyond it: fillet interference.

A rack cuts an external gear. Its straight flank ends a depth k below its reference line, where the rounded corner
begins: k = h_f − ρ (1 − sin φ), all in modules. On the line of action of cutting, measured from its tangent point on
the base circle, the involute begins at

    f = r sin φ − m (k − x) / sin φ,

negative where the rack undercuts the gear; its involute then begins where the fillet crosses it, see
:func:`kinematics.gear.profile.find_involute_start`. A ring is shaped by a cutter with the teeth of a gear, whose tip
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

from kinematics.gear.teeth import Gear, Mesh

CUTTER_ADDENDUM = 1.25
"""Addendum of a cutter for rings, in modules: the dedendum that it leaves at no shift."""


def compute_rack_form(gear: Gear, depth: float) -> float:
    """Compute where the involute of a rack-cut external gear begins, from the base circle's tangent point.

    That is where the rack's straight flank ends; a negative value means undercut.

    ``depth`` is the depth of the rack's straight flank below its reference line, modules.
    """
    sine = math.sin(gear.pressure_angle)
    return gear.pitch_radius * sine - gear.module * (depth - gear.shift) / sine


@dataclass(frozen=True)
class ShapedRing:
    """A ring and the cutter that shapes it, without shift and with sharp corners; the cutter's depth makes the root.

    Raises
    ------
    DimensionError
        For a cutter with as many teeth as the ring, or a shift at which no cutter meshes with the ring.
    """

    ring: Gear
    cutter_teeth: int

    def __post_init__(self) -> None:
        # Raises if cutter and ring cannot mesh.
        _ = self.cutting

    @cached_property
    def cutting(self) -> Mesh:
        """Mesh of cutter and ring at the end of cutting, without play."""
        ring = self.ring
        cutter = Gear(self.cutter_teeth, ring.module, ring.pressure_angle, ring.dedendum, ring.dedendum)
        return Mesh(cutter, ring)

    @property
    def form(self) -> float:
        """End of the ring's involute, measured from the base circle's tangent point."""
        cutter = self.cutting.pinion
        reached = math.sqrt(cutter.tip_radius**2 - cutter.base_radius**2)
        return self.cutting.centre_distance * math.sin(self.cutting.pressure_angle) + reached

    @property
    def root_radius(self) -> float:
        """Radius of the circle that the tips of the cutter reach."""
        return self.cutting.centre_distance + self.cutting.pinion.tip_radius

    @property
    def is_trimmed(self) -> bool:
        """Whether the cutter trims the ring's tips, either outside the line of action or where it has no involute."""
        mesh = self.cutting
        tip = math.sqrt(max(self.ring.tip_radius**2 - self.ring.base_radius**2, 0.0))
        # The cutter's tangent point bounds the involute that it can generate.
        return mesh.tips_foul or tip < mesh.centre_distance * math.sin(mesh.pressure_angle)


@dataclass(frozen=True)
class Contact:
    """A mesh whose involutes begin at ``forms``, measured from the tangent points of the base circles.

    ``reaches`` are the deepest points that the mate's tip reaches on pinion and gear, measured in the same way.
    Specific sliding at a point of contact is the sliding velocity over the velocity of the contact along the flank. It
    is evaluated where it is largest on each flank, at the deepest point: −∞ if that lies on the base circle.
    """

    mesh: Mesh
    forms: tuple[float, float]

    @property
    def reaches(self) -> tuple[float, float]:
        """Deepest points of contact on pinion and gear; outermost points on a ring."""
        mesh, (one, two) = self.mesh, self._tips
        between = mesh.centre_distance * math.sin(mesh.pressure_angle)
        # Distances of both tips from the other gear's tangent point along the line of action.
        return (two - between, between + one) if mesh.gear.internal else (between - two, between - one)

    @property
    def _tips(self) -> tuple[float, float]:
        """Intersections of both tip circles with the line of action, each from its own tangent point."""
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
        """Maximum specific sliding of each flank, below its pitch circle: 1 − (u₂ z₁) / (u₁ z₂) on the pinion."""
        mesh, tips, deepest = self.mesh, self._tips, self.reaches
        teeth = mesh.pinion.teeth / mesh.gear.teeth
        return _compute_sliding(tips[1] * teeth, deepest[0]), _compute_sliding(tips[0] / teeth, deepest[1])

    @property
    def backlash(self) -> float:
        """Exact backlash on the working pitch circles: the pitch there minus the thickness of both teeth."""
        mesh = self.mesh
        # Ratio of working to standard pitch radii.
        wide = math.cos(mesh.pinion.pressure_angle) / math.cos(mesh.pressure_angle)
        radii = mesh.pinion.pitch_radius * wide, mesh.gear.pitch_radius * wide
        pitch = 2.0 * math.pi * radii[0] / mesh.pinion.teeth
        return pitch - mesh.pinion.thickness_at(radii[0]) - mesh.gear.thickness_at(radii[1])


def _compute_sliding(mate: float, own: float) -> float:
    # On the base circle the flank's own rolling velocity vanishes.
    return 1.0 - mate / own if own > 0.0 else -math.inf


def compute_tip_shortening(mesh: Mesh) -> float:
    """Compute by how many modules the tips of an external pair are shortened to keep the clearance of unshifted gears.

    The centre distance grows by less than the sum of the shifts; the tips lose the difference x₁ + x₂ − (C − C₀) / m.
    """
    if mesh.gear.internal:
        return 0.0
    apart = (mesh.centre_distance - mesh.standard_distance) / mesh.pinion.module
    # Tips are never lengthened.
    return max(0.0, mesh.pinion.shift + mesh.gear.shift - apart)
