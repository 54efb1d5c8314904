"""Helical gears on parallel and on crossed shafts.

With the helix angle ψ and the normal module m_n the transverse module is m_n / cos ψ; the teeth are those of a spur
gear in the normal plane, of z / cos³ ψ virtual teeth (Norton, Design of Machinery, Sec. 9.4; Rao, Sec. 7.2–7.5).
Shafts that cross at the angle Σ take helix angles of ψ₁ + ψ₂ = Σ, of equal hand where both are positive. Angles are
radians.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from kinematics.errors import DimensionError
from kinematics.gear.teeth import PRESSURE_ANGLE, Gear

OVERLAP = 1.15
"""Usual least advance of the tooth over the face, in transverse pitches (Rao, Sec. 7.4)."""


@dataclass(frozen=True)
class HelicalGear:
    """A helical gear of full-depth teeth in the normal plane; a negative helix angle is of the other hand.

    Raises
    ------
    DimensionError
        For a helix angle of a right angle or more, or teeth and modules that no gear has.
    """

    teeth: int
    normal_module: float
    helix_angle: float
    normal_pressure_angle: float = PRESSURE_ANGLE

    def __post_init__(self) -> None:
        if not abs(self.helix_angle) < 0.5 * math.pi:
            raise DimensionError("helix_angle", "less than a right angle", self.helix_angle)
        if not (self.teeth > 0 and 0.0 < self.normal_module < math.inf):
            raise DimensionError("teeth and normal_module", "positive", (self.teeth, self.normal_module))

    @property
    def transverse_module(self) -> float:
        """Module in the plane of rotation, m_n / cos ψ."""
        return self.normal_module / math.cos(self.helix_angle)

    @property
    def pitch_radius(self) -> float:
        """z m_t / 2."""
        return 0.5 * self.teeth * self.transverse_module

    @property
    def transverse_pitch(self) -> float:
        """Circular pitch in the plane of rotation."""
        return math.pi * self.transverse_module

    @property
    def axial_pitch(self) -> float:
        """Distance of neighbouring teeth along the shaft, π m_n / sin ψ; infinite for spur teeth."""
        slope = math.sin(abs(self.helix_angle))
        return math.pi * self.normal_module / slope if slope else math.inf

    @property
    def transverse_pressure_angle(self) -> float:
        """tan φ_t = tan φ_n / cos ψ (Norton, eq. 9.10)."""
        return math.atan(math.tan(self.normal_pressure_angle) / math.cos(self.helix_angle))

    @property
    def virtual_teeth(self) -> float:
        """Teeth of the spur gear that the normal plane shows, z / cos³ ψ (Norton, eq. 9.11)."""
        return self.teeth / math.cos(self.helix_angle) ** 3

    @property
    def transverse_gear(self) -> Gear:
        """The spur gear of the transverse plane: its meshes have the transverse contact ratio."""
        shrunk = math.cos(self.helix_angle)
        return Gear(self.teeth, self.transverse_module, self.transverse_pressure_angle, shrunk, 1.25 * shrunk)

    def least_face_width(self, overlap: float = OVERLAP) -> float:
        """Face over which a tooth advances by ``overlap`` transverse pitches: overlap × axial pitch."""
        return overlap * self.axial_pitch


def helix_angle_for_distance(teeth: int, other: int, normal_module: float, distance: float) -> float:
    """Helix angle of two gears on parallel shafts at a distance: cos ψ = m_n (z₁ + z₂) / 2 C.

    Raises
    ------
    DimensionError
        Where even spur teeth are too large for the distance.
    """
    cosine = 0.5 * normal_module * (teeth + other) / distance
    if not 0.0 < cosine <= 1.0:
        raise DimensionError("distance", f"at least {0.5 * normal_module * (teeth + other):.6g}", distance)
    return math.acos(cosine)


def helix_angle_for_face(normal_module: float, face: float, overlap: float = OVERLAP) -> float:
    """Least helix angle with which a tooth advances enough over a face: sin ψ = overlap π m_n / F.

    Raises
    ------
    DimensionError
        For a face that is too narrow for any.
    """
    sine = overlap * math.pi * normal_module / face
    if not sine < 1.0:
        raise DimensionError("face", f"above {overlap * math.pi * normal_module:.6g}", face)
    return math.asin(sine)


def helical_replacement(
    teeth: int, other: int, module: float, face: float, overlap: float = OVERLAP
) -> tuple[HelicalGear, HelicalGear] | None:
    """Helical gears for a spur pair: same distance, ratio and cutter, the smallest helix angle that the face allows.

    None where no smaller number of teeth keeps the ratio and has enough overlap (Rao, Sec. 7.4).
    """
    distance, step = 0.5 * module * (teeth + other), math.gcd(teeth, other)
    for share in range(step - 1, 0, -1):
        pair = teeth // step * share, other // step * share
        angle = helix_angle_for_distance(*pair, module, distance)
        first, second = (HelicalGear(z, module, sign * angle) for z, sign in zip(pair, (1, -1), strict=True))
        if first.least_face_width(overlap) <= face:
            return first, second
    return None


def crossed_by_diameters(ratio: float, diameters: tuple[float, float], shaft_angle: float) -> tuple[float, float]:
    """Helix angles of crossed gears of given pitch diameters and ratio z₂/z₁: cos ψ₂ / cos ψ₁ = (z₂/z₁) D₁ / D₂.

    With ψ₁ + ψ₂ = Σ there is exactly one: tan ψ₁ = (G D₁/D₂ − cos Σ) / sin Σ.

    Raises
    ------
    DimensionError
        For parallel shafts, where the angle is not determined, or angles beyond a right one.
    """
    sine = math.sin(shaft_angle)
    if abs(sine) < 1e-12:
        raise DimensionError("shaft_angle", "not parallel", shaft_angle)
    first = math.atan((ratio * diameters[0] / diameters[1] - math.cos(shaft_angle)) / sine)
    second = shaft_angle - first
    if not abs(second) < 0.5 * math.pi:
        raise DimensionError("diameters", "such that both helix angles are below a right one", diameters)
    return first, second


def crossed_at_distance(
    teeth: tuple[int, int], normal_module: float, distance: float, shaft_angle: float
) -> list[tuple[float, float]]:
    """All helix angles ψ₁, ψ₂ of crossed gears at a distance, by rising ψ₁: m_n (z₁/cos ψ₁ + z₂/cos ψ₂) = 2 C.

    The distance grows without bound towards both ends of the range and has one minimum between them
    (:func:`least_crossed_distance`): two solutions, one or none.
    """
    lowest = least_crossed_distance(teeth, normal_module, shaft_angle)
    if distance < lowest[1]:
        return []
    low, high = shaft_angle - 0.5 * math.pi, 0.5 * math.pi
    found = []
    for far in (low, high):
        inside, outside = lowest[0], far
        for _ in range(200):
            middle = 0.5 * (inside + outside)
            beyond = _crossed_distance(teeth, normal_module, middle, shaft_angle) > distance
            inside, outside = (inside, middle) if beyond else (middle, outside)
        found.append((inside, shaft_angle - inside))
    return found if found[1][0] - found[0][0] > 1e-7 else found[:1]


def least_crossed_distance(teeth: tuple[int, int], normal_module: float, shaft_angle: float) -> tuple[float, float]:
    """ψ₁ and the centre distance where crossed gears are nearest, by golden section on a convex function."""
    low, high = max(shaft_angle, 0.0) - 0.5 * math.pi, min(shaft_angle, 0.0) + 0.5 * math.pi
    golden = 0.5 * (math.sqrt(5.0) - 1.0)
    for _ in range(120):
        one, other = high - golden * (high - low), low + golden * (high - low)
        left, right = (_crossed_distance(teeth, normal_module, angle, shaft_angle) for angle in (one, other))
        low, high = (low, other) if left < right else (one, high)
    at = 0.5 * (low + high)
    return at, _crossed_distance(teeth, normal_module, at, shaft_angle)


def _crossed_distance(teeth: tuple[int, int], normal_module: float, angle: float, shaft_angle: float) -> float:
    cosines = math.cos(angle), math.cos(shaft_angle - angle)
    if min(cosines) <= 0.0:
        return math.inf
    return 0.5 * normal_module * (teeth[0] / cosines[0] + teeth[1] / cosines[1])
