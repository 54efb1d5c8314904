"""Involute spur teeth: circles, tooth thickness, meshes, contact ratio, interference, undercut, profile shift.

A :class:`Gear` is cut by a rack of module m and pressure angle φ (the coefficients of addendum and dedendum are shares
of m); z teeth give the pitch radius r = m z / 2 and the base radius r_b = r cos φ. The profile shift x·m moves the
teeth outward on external *and* internal gears.

A :class:`Mesh` of a pinion with an external or internal gear or a rack: on the common tangent of the base circles
(the line of action) contact runs from its intersection with the gear's tip circle to that with the pinion's. With the
pinion driving, the part cut by the gear's tip is the *approach* and the part cut by the pinion's tip the *recess*
(Norton, Design of Machinery, Sec. 9.2–9.5; Rao, Sec. 6.9–6.12). Beyond the points where the line touches the base
circles there is no involute: a tip that reaches further digs into the mate's flank, which is *interference*.

Angles are radians; lengths are in any consistent unit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

from kinematics.errors import DimensionError

FULL_DEPTH_ADDENDUM = 1.0
FULL_DEPTH_DEDENDUM = 1.25
"""Full-depth teeth, shares of the module (Norton, Table 9-1, coarse pitch)."""

TIP_ROUNDING = 0.38
"""Radius of the rack's rounded tip in modules (ISO 53, profile A); smaller if the tip is too narrow for it."""

PRESSURE_ANGLE = math.radians(20.0)
"""Default pressure angle, radians: 20°."""

LIMIT_TOLERANCE = 1e-12
"""Share of the limiting radius by which a tip may exceed it: teeth on the limit are sound, and rounding must not reject
them."""

UNDERCUT_TOLERANCE = 1e-9
"""Shift, in modules and per tooth, by which a gear may lie below its limit: fits place gears on it, to rounding."""


def involute(angle: float) -> float:
    """Return the involute function inv φ = tan φ − φ."""
    return math.tan(angle) - angle


def invert_involute_tangent(value: float, near: float = 0.0, tolerance: float = 4e-16) -> float:
    """Solve tan φ − φ = ``value`` > 0 for tan φ, φ in (0, π/2), by Newton's method; kernels compile it too.

    Parameters
    ----------
    value : float
    near : float
        First guess; estimated if not positive.
    tolerance : float
        Relative size of the last step; the error is about its square, by quadratic convergence.
    """
    # In t = tan φ the function t − atan t is convex and increasing: from a start above the root Newton falls onto it.
    # t − atan t ≥ t³/3/(1 + t²) gives the start for small values, t ≤ value + π/2 the one for large.
    t: float = near if near > 0.0 else min(value + 0.5 * math.pi, 1.2 * (3.0 * value) ** (1.0 / 3.0) + value)
    before = 0.0
    for left in range(59, -1, -1):
        step = (t - math.atan(t) - value) * (1.0 + t * t) / (t * t)
        last, t = t, t - step
        if abs(step) <= tolerance * t:
            break
        if t == before:
            # Rounding alternates between two neighbours: return the one that the full number of steps would end on.
            return t if left % 2 == 0 else last
        before = last
    return t


def invert_involute(value: float) -> float:
    """Solve tan φ − φ = ``value`` ≥ 0 for φ in [0, π/2), by Newton's method from above.

    Raises
    ------
    DimensionError
        For a negative value.
    """
    if not value >= 0.0:
        raise DimensionError("value", "kinematics-zero-or-more", value)
    if value == 0.0:
        return 0.0
    return math.atan(invert_involute_tangent(value))


def compute_corner_rounding(pressure_angle: float, dedendum: float) -> float:
    """Compute the radius of the rack's rounded tip, modules.

    Raises
    ------
    DimensionError
        If the rack's tooth comes to a point before it has cut to the root circle.
    """
    # Half the width of the rack's tooth at its tip.
    wide = 0.25 * math.pi - dedendum * math.tan(pressure_angle)
    if wide < 0.0:
        raise DimensionError("dedendum", "kinematics-depth-of-rack-tooth", dedendum)
    # At most the circle that touches both flanks at the tip.
    return min(TIP_ROUNDING, wide * math.cos(pressure_angle) / (1.0 - math.sin(pressure_angle)))


def compute_straight_depth(pressure_angle: float, dedendum: float) -> float:
    """Compute the depth below its reference line that the rack's straight flank reaches, modules.

    >>> round(compute_straight_depth(math.radians(20.0), 1.25), 4)
    1.0
    """
    # A rack whose tooth comes to a point earlier has straight flanks down to there.
    point = 0.25 * math.pi / math.tan(pressure_angle)
    if dedendum >= point:
        return point
    return dedendum - compute_corner_rounding(pressure_angle, dedendum) * (1.0 - math.sin(pressure_angle))


def compute_min_shift(teeth: float, pressure_angle: float, depth: float) -> float:
    """Compute the shift below which a rack with this depth of straight flank undercuts a gear: x = k − z sin² φ / 2."""
    return depth - 0.5 * teeth * math.sin(pressure_angle) ** 2


@dataclass(frozen=True)
class Gear:
    """A spur gear; ``addendum``, ``dedendum`` and ``shift`` are shares of the module.

    ``teeth`` is whole, or the equivalent number of a bevel or helical gear. A gear with a ``helix_angle``, radians, is
    that of the plane of rotation; the rack that cuts it is given in the normal plane.

    Raises
    ------
    DimensionError
        For teeth, module, angle or depths that no gear has.
    """

    teeth: float
    module: float
    pressure_angle: float = PRESSURE_ANGLE
    addendum: float = FULL_DEPTH_ADDENDUM
    dedendum: float = FULL_DEPTH_DEDENDUM
    shift: float = 0.0
    internal: bool = False
    helix_angle: float = 0.0

    def __post_init__(self) -> None:
        if not self.teeth > 0:
            raise DimensionError("teeth", "kinematics-positive", self.teeth)
        if not 0.0 < self.module < math.inf:
            raise DimensionError("module", "kinematics-positive-and-finite", self.module)
        if not 0.0 < self.pressure_angle < 0.5 * math.pi:
            raise DimensionError("pressure_angle", "kinematics-between-0-and-half-pi", self.pressure_angle)
        if not (self.addendum > 0.0 and self.dedendum > 0.0):
            raise DimensionError(
                "kinematics-addendum-and-dedendum", "kinematics-positive", (self.addendum, self.dedendum)
            )
        if not (self.tip_radius > 0.0 and self.root_radius > 0.0):
            raise DimensionError(
                "kinematics-tip-and-root-radius", "kinematics-positive", (self.tip_radius, self.root_radius)
            )

    @property
    def _outward(self) -> float:
        return -1.0 if self.internal else 1.0

    @property
    def pitch_radius(self) -> float:
        """Pitch radius r = m z / 2."""
        return 0.5 * self.module * self.teeth

    @property
    def base_radius(self) -> float:
        """Base radius r_b = r cos φ."""
        return self.pitch_radius * math.cos(self.pressure_angle)

    @property
    def tip_radius(self) -> float:
        """Radius of the outside circle; of the inside circle for internal teeth."""
        return self.pitch_radius + self.module * (self.shift + self._outward * self.addendum)

    @property
    def root_radius(self) -> float:
        """Radius of the circle through the bottoms of the tooth spaces."""
        return self.pitch_radius + self.module * (self.shift - self._outward * self.dedendum)

    @property
    def circular_pitch(self) -> float:
        """Circular pitch P_c = π m, measured on the pitch circle."""
        return math.pi * self.module

    @property
    def base_pitch(self) -> float:
        """Base pitch P_b = π m cos φ, the distance of neighbouring teeth along the line of action."""
        return self.circular_pitch * math.cos(self.pressure_angle)

    @property
    def whole_depth(self) -> float:
        """Whole depth: addendum + dedendum, times the module."""
        return self.module * (self.addendum + self.dedendum)

    @property
    def tooth_thickness(self) -> float:
        """Thickness on the pitch circle, m (π/2 ± 2 x tan φ)."""
        return self.module * (0.5 * math.pi + self._outward * 2.0 * self.shift * math.tan(self.pressure_angle))

    def thickness_at(self, radius: float) -> float:
        """Return the arc thickness of a tooth at a radius: 2 ρ (t / 2r ± (inv φ − inv φ_ρ)), cos φ_ρ = r_b/ρ.

        Negative beyond the intersection of the flanks (a pointed tooth); nan below the base circle, without involute.
        """
        # Undefined below the base circle, not zero.
        if radius < self.base_radius:
            return math.nan
        # Rounding may put the quotient above 1 on the base circle itself.
        there = math.acos(min(1.0, self.base_radius / radius))
        half = self.tooth_thickness / (2.0 * self.pitch_radius)
        return 2.0 * radius * (half + self._outward * (involute(self.pressure_angle) - involute(there)))

    @property
    def is_pointed(self) -> bool:
        """Whether the flanks meet before the tip circle is reached."""
        return self.thickness_at(self.tip_radius) <= 0.0

    @property
    def straight_depth(self) -> float:
        """Depth below its reference line that the straight flank of the cutting rack reaches, modules."""
        shrunk = math.cos(self.helix_angle)
        normal = math.atan(math.tan(self.pressure_angle) * shrunk)
        return shrunk * compute_straight_depth(normal, self.dedendum / shrunk)

    @property
    def least_shift(self) -> float:
        """Shift below which the cutting rack undercuts the flank (Colbourne, The Geometry of Involute Gears, ch. 5)."""
        return compute_min_shift(self.teeth, self.pressure_angle, self.straight_depth)

    @property
    def is_undercut(self) -> bool:
        """Whether the rack that cuts this gear removes flank above the base circle; internal teeth are shaped."""
        return not self.internal and self.shift < self.least_shift - UNDERCUT_TOLERANCE * self.teeth


@dataclass(frozen=True)
class Mesh:
    """A pinion with an external or internal gear, at the distance without backlash or at a given distance.

    Lengths along the line of action are measured from the pitch point. With the pinion driving, ``approach`` is the
    part before it, ``recess`` the part after it.

    Raises
    ------
    DimensionError
        For an internal pinion, unequal modules or pressure angles, an internal gear without more teeth than the
        pinion, shifts that no distance takes up, or a centre distance at which the base circles overlap.
    """

    pinion: Gear
    gear: Gear
    given_distance: float | None = None

    @classmethod
    def standard(cls, pair: tuple[int, int], module: float, pressure_angle: float) -> Mesh:
        """Make two external full-depth gears by their teeth, pinion first, at the distance of their pitch circles."""
        pinion, gear = (Gear(teeth, module, pressure_angle) for teeth in pair)
        return cls(pinion, gear)

    def __post_init__(self) -> None:
        one, two = self.pinion, self.gear
        if one.internal:
            raise DimensionError("pinion", "kinematics-external-gear", one)
        if (one.module, one.pressure_angle) != (two.module, two.pressure_angle):
            raise DimensionError("kinematics-module-and-pressure-angle", "kinematics-same-on-both-gears", (one, two))
        if two.internal and two.teeth <= one.teeth:
            raise DimensionError(
                "kinematics-internal-gear", "kinematics-more-teeth-than-pinion", (one.teeth, two.teeth)
            )
        if not 0.0 <= self.pressure_angle < 0.5 * math.pi:
            raise DimensionError("kinematics-centre-distance", "kinematics-base-circles-apart", self.given_distance)

    @property
    def _side(self) -> float:
        return -1.0 if self.gear.internal else 1.0

    @property
    def standard_distance(self) -> float:
        """Centre distance of the pitch circles, r₂ ± r₁."""
        return self.gear.pitch_radius + self._side * self.pinion.pitch_radius

    @cached_property
    def pressure_angle(self) -> float:
        """Working pressure angle.

        Without backlash inv φ_w = inv φ + 2 tan φ (x₂ ± x₁) / (z₂ ± z₁); at a given centre distance C
        cos φ_w = C₀ cos φ / C (Norton, Sec. 9.2, changing centre distance). Outside [0, π/2): no such mesh.
        """
        phi = self.pinion.pressure_angle
        if self.given_distance is not None:
            cosine = self.standard_distance * math.cos(phi) / self.given_distance
            # nan fails every comparison, so the constructor rejects it.
            return math.acos(cosine) if 0.0 < cosine <= 1.0 else math.nan
        taken_up = self.gear.shift + self._side * self.pinion.shift
        teeth = self.gear.teeth + self._side * self.pinion.teeth
        value = involute(phi) + 2.0 * math.tan(phi) * taken_up / teeth
        # Unshifted pairs keep φ exactly, without a round trip through the involute.
        return phi if taken_up == 0.0 else invert_involute(value) if value >= 0.0 else math.nan

    @property
    def centre_distance(self) -> float:
        """Centre distance: as given, or C₀ cos φ / cos φ_w."""
        if self.given_distance is not None:
            return self.given_distance
        return self.standard_distance * math.cos(self.pinion.pressure_angle) / math.cos(self.pressure_angle)

    @property
    def _tangents(self) -> tuple[float, float]:
        """Distances from the pitch point to the tangent points on the base circles of pinion and gear."""
        slope = math.tan(self.pressure_angle)
        return self.pinion.base_radius * slope, self.gear.base_radius * slope

    @property
    def approach(self) -> float:
        """Part of the path of contact bounded by the gear's tip circle."""
        tip, base = self.gear.tip_radius, self.gear.base_radius
        return self._side * (math.sqrt(max(tip * tip - base * base, 0.0)) - self._tangents[1])

    @property
    def recess(self) -> float:
        """Part of the path of contact bounded by the pinion's tip circle."""
        tip, base = self.pinion.tip_radius, self.pinion.base_radius
        return math.sqrt(max(tip * tip - base * base, 0.0)) - self._tangents[0]

    @property
    def path_of_contact(self) -> float:
        """Norton's length of action Z (eq. 9.2)."""
        return self.approach + self.recess

    @property
    def contact_ratio(self) -> float:
        """m_p = Z / p_b (Norton, eq. 9.7a): the mean number of pairs of teeth in contact."""
        return self.path_of_contact / self.pinion.base_pitch

    @property
    def gear_tip_limit(self) -> float:
        """Radius that the gear's tip must not pass (internal: not fall below): √(r_b₂² + (C sin φ_w)²)."""
        return math.hypot(self.gear.base_radius, self.centre_distance * math.sin(self.pressure_angle))

    @property
    def pinion_tip_limit(self) -> float:
        """Radius that the pinion's tip must not pass: √(r_b₁² + (C sin φ_w)²). An internal gear sets none."""
        if self.gear.internal:
            return math.inf
        return math.hypot(self.pinion.base_radius, self.centre_distance * math.sin(self.pressure_angle))

    @property
    def interferes(self) -> bool:
        """Whether a tip of one gear digs into the flank of this particular mate.

        A rack would be the worst mate; with a finite gear fewer teeth are sound (Norton, Tables 9-4, 9-5). Only the
        involute is considered, not the fillet below it: the tip of a full-depth ring may reach about 0.01 module into
        the fillet that a rack leaves on its pinion (ring of 60, pinion of 30 at 20°).
        """
        # Teeth exactly on the limit must not be rejected by rounding.
        slack = 1.0 + LIMIT_TOLERANCE
        if self.pinion.tip_radius > self.pinion_tip_limit * slack:
            return True
        if self.gear.internal:
            return self.gear.tip_radius * slack < self.gear_tip_limit or self.tips_foul
        return self.gear.tip_radius > self.gear_tip_limit * slack

    @property
    def tips_foul(self) -> bool:
        """Whether the tips of an internal pair meet outside the line of action; external pairs never.

        The pinion's tip corner passes the gear's tip circle at the angles δ₁, δ₂ from the line of centres; it is clear
        of the gear's tip corner where z₁ (inv φ_a₁ + δ₁) − z₂ (inv φ_a₂ + δ₂) + (z₂ − z₁) inv φ_w ≥ 0 (Colbourne, The
        Geometry of Involute Gears, 1987, ch. 8; trochoid interference in SDP/SI, Elements of Metric Gear Technology,
        eq. 5-6). With a small difference of teeth this limits planetary rings.
        """
        if not self.gear.internal:
            return False
        tip, gear_tip, distance = self.pinion.tip_radius, self.gear.tip_radius, self.centre_distance
        # The tip circles do not intersect.
        if gear_tip >= distance + tip:
            return False
        # The pinion's tips lie outside the ring's tip circle all around, or the ring has no involute there.
        if gear_tip <= abs(distance - tip) or gear_tip < self.gear.base_radius:
            return True
        at_pinion = math.acos((gear_tip**2 - tip**2 - distance**2) / (2.0 * tip * distance))
        at_gear = math.acos((distance**2 + gear_tip**2 - tip**2) / (2.0 * gear_tip * distance))
        flank = involute(math.acos(self.pinion.base_radius / tip))
        gear_flank = involute(math.acos(self.gear.base_radius / gear_tip))
        room = self.pinion.teeth * (flank + at_pinion) - self.gear.teeth * (gear_flank + at_gear)
        return room + (self.gear.teeth - self.pinion.teeth) * involute(self.pressure_angle) < 0.0

    @property
    def clearance(self) -> float:
        """Smaller clearance between a tip and the mate's root on the line of centres."""
        one, two, distance = self.pinion, self.gear, self.centre_distance
        if two.internal:
            return min(two.root_radius - distance - one.tip_radius, two.tip_radius - distance - one.root_radius)
        return min(distance - one.tip_radius - two.root_radius, distance - two.tip_radius - one.root_radius)

    @property
    def loss_factor(self) -> float:
        """Power lost per unit of friction coefficient, averaged over the mesh cycle.

        H = π (1/z₁ ± 1/z₂) (1 − ε + ε₁² + ε₂²), where ε₁ and ε₂ are recess and approach in base pitches and ε is the
        contact ratio (Niemann & Winter, Maschinenelemente II, 1983, Sec. 21.11; for 1 ≤ ε ≤ 2). Efficiency 1 − μ H.
        """
        teeth = 1.0 / self.pinion.teeth + self._side / self.gear.teeth
        recess, approach = (part / self.pinion.base_pitch for part in (self.recess, self.approach))
        return math.pi * teeth * (1.0 - self.contact_ratio + recess**2 + approach**2)


def compute_min_teeth(pressure_angle: float = PRESSURE_ANGLE, addendum: float = FULL_DEPTH_ADDENDUM) -> int:
    """Compute the minimum teeth that mesh with a rack, and so with every gear: z ≥ 2 k / sin² φ (Norton, eq. 9.8).

    >>> [compute_min_teeth(math.radians(angle)) for angle in (14.5, 20.0, 25.0)]
    [32, 18, 12]
    """
    return _round_up(2.0 * addendum / math.sin(pressure_angle) ** 2)


def find_largest_gear(
    pinion: int, pressure_angle: float = PRESSURE_ANGLE, addendum: float = FULL_DEPTH_ADDENDUM
) -> int | None:
    """Find the maximum teeth of an external gear that meshes with a pinion without interference (Norton, Table 9-5).

    From r_a₂² ≤ r_b₂² + C² sin² φ: z₂ ≤ (z₁² sin² φ − 4 k²) / (4 k − 2 z₁ sin² φ). None: every gear and the rack mesh.
    A result below ``pinion`` means that no gear with at least as many teeth as the pinion meshes.
    """
    squared = math.sin(pressure_angle) ** 2
    room = 4.0 * addendum - 2.0 * pinion * squared
    # A pinion sound with a rack is sound with every gear.
    if pinion >= compute_min_teeth(pressure_angle, addendum):
        return None
    return max(0, math.floor((pinion * pinion * squared - 4.0 * addendum**2) / room * (1.0 + LIMIT_TOLERANCE)))


def find_saving_shift(mesh: Mesh, least_contact_ratio: float = 1.2) -> Mesh | None:
    """Find a profile shift that makes an undercut or interfering external pair sound, if one exists.

    The pinion is shifted until the rack no longer undercuts it. If the gear can take the opposite shift the centre
    distance stays (long and short addendum, Norton, Sec. 9.3); otherwise the centre distance increases.

    Parameters
    ----------
    least_contact_ratio : float
        Minimum contact ratio of the shifted pair; Norton, Sec. 9.5, recommends at least 1.2.

    Returns
    -------
    Mesh or None
        The same teeth, shifted; None if the pair needs no shift, is internal, or no such shift helps.
    """
    pinion, gear = mesh.pinion, mesh.gear
    if gear.internal or not (mesh.interferes or pinion.is_undercut or gear.is_undercut):
        return None
    need = max(0.0, pinion.least_shift), max(0.0, gear.least_shift)
    choices = [(need[0], -need[0])] if gear.least_shift <= -need[0] else []
    for shifts in [*choices, need]:
        pair = tuple(replace(g, shift=x) for g, x in zip((pinion, gear), shifts, strict=True))
        shifted = Mesh(pair[0], pair[1])
        sound = not (shifted.interferes or pair[0].is_pointed or pair[1].is_pointed)
        if sound and shifted.contact_ratio >= least_contact_ratio:
            return shifted
    return None


def _round_up(value: float) -> int:
    # A value that exceeds an integer only by rounding must not be rounded up.
    return math.ceil(value * (1.0 - LIMIT_TOLERANCE))
