"""Formulas of the textbooks for gears that no analysis offers, for the rows of the literature that ask for them."""

from __future__ import annotations

import math

from kinematics.errors import DimensionError
from kinematics.gear.bevel import BevelPair
from kinematics.gear.helical import USUAL_OVERLAP, HelicalGear
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, LIMIT_TOLERANCE, PRESSURE_ANGLE, Gear, Mesh, involute
from kinematics.gear.worm import WormSet


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


def helix_angle_for_face(normal_module: float, face: float, overlap: float = USUAL_OVERLAP) -> float:
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
    teeth: int, other: int, module: float, face: float, overlap: float = USUAL_OVERLAP
) -> tuple[HelicalGear, HelicalGear] | None:
    """Helical gears for a spur pair: same distance, ratio and cutter, the smallest helix angle that the face allows.

    None where no smaller number of teeth keeps the ratio and has enough overlap (Rao, Sec. 7.4).
    """
    distance, step = 0.5 * module * (teeth + other), math.gcd(teeth, other)
    for share in range(step - 1, 0, -1):
        pair = teeth // step * share, other // step * share
        angle = helix_angle_for_distance(*pair, module, distance)
        first, second = (HelicalGear(z, module, sign * angle) for z, sign in zip(pair, (1, -1), strict=True))
        if first.min_face_width(overlap) <= face:
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


INCH = 25.4
"""Millimetres in an inch: a module in mm is 25.4 / diametral pitch (Norton, eq. 9.4d)."""


def fine_pitch_dedendum(diametral_pitch: float) -> float:
    """Dedendum, in modules, of a fine-pitch gear: 1.2 + 0.002 in × p_d for p_d ≥ 20 (Norton, Table 9-1).

    Parameters
    ----------
    diametral_pitch : float
        Teeth per inch of pitch diameter.
    """
    return 1.2 + 0.002 * diametral_pitch


def rack_interferes(gear: Gear, rack_addendum: float) -> bool:
    """Whether a rack of this addendum (a length) reaches below the gear's base tangent: a > r sin² φ."""
    return rack_addendum > gear.pitch_radius * math.sin(gear.pressure_angle) ** 2 * (1.0 + LIMIT_TOLERANCE)


def rack_path(gear: Gear, rack_addendum: float) -> tuple[float, float]:
    """Approach and recess of a gear that drives a rack of this addendum (a length, not a share).

    The rack's tip line cuts the line of action at a / sin φ before the pitch point; contact cannot begin before the
    tangent point r sin φ of the base circle (see :func:`rack_interferes`).
    """
    phi = gear.pressure_angle
    recess = math.sqrt(gear.tip_radius**2 - gear.base_radius**2) - gear.base_radius * math.tan(phi)
    return rack_addendum / math.sin(phi), recess


def arc_of_contact(mesh: Mesh) -> float:
    """Path of contact over cos φ_w: the way a point of the working pitch circle goes while two teeth touch."""
    return mesh.path_of_contact / math.cos(mesh.pressure_angle)


def backlash(mesh: Mesh) -> float:
    """Play on the working pitch circles: 0 at the distance of a tight mesh."""
    wide = math.cos(mesh.pinion.pressure_angle) / math.cos(mesh.pressure_angle)
    radii = mesh.pinion.pitch_radius * wide, mesh.gear.pitch_radius * wide
    pitch = 2.0 * math.pi * radii[0] / mesh.pinion.teeth
    return pitch - mesh.pinion.thickness_at(radii[0]) - mesh.gear.thickness_at(radii[1])


def equivalent_radii(pair: BevelPair) -> tuple[float, float]:
    """Pitch radii of the spur gears that the back cones roll out to, r / cos γ (Tredgold)."""
    pinion, gear = (radius / math.cos(cone) for radius, cone in zip(pair.pitch_radii, pair.cones, strict=True))
    return pinion, gear


def least_pinion(ratio: float, pressure_angle: float = PRESSURE_ANGLE, addendum: float = FULL_DEPTH_ADDENDUM) -> float:
    """Real number of pinion teeth from which on a gear of ``ratio`` ≥ 1 times as many does not interfere.

    z = 2 k (G + √(G² + (1 + 2 G) sin² φ)) / ((1 + 2 G) sin² φ) (Norton, eq. 9.9; Rao, Sec. 6.12).
    """
    squared = (1.0 + 2.0 * ratio) * math.sin(pressure_angle) ** 2
    return 2.0 * addendum * (ratio + math.sqrt(ratio * ratio + squared)) / squared


def largest_addendum(pinion: int, gear: int, pressure_angle: float = PRESSURE_ANGLE) -> float:
    """Largest addendum coefficient of the gear that does not interfere with the pinion, at standard distance."""
    squared = math.sin(pressure_angle) ** 2
    return 0.5 * (math.sqrt(gear * gear + squared * (pinion * pinion + 2.0 * pinion * gear)) - gear)


def smallest_worm(ratio: int, axial_pitch: float, distance: float, most_threads: int) -> WormSet | None:
    """The set of so many threads at most whose worm is smallest: the more threads, the larger the gear.

    None where a gear of a single-threaded worm already fills the distance.
    """
    for threads in range(most_threads, 0, -1):
        gear = ratio * threads * axial_pitch / math.pi
        if gear < 2.0 * distance:
            return WormSet(threads, ratio * threads, axial_pitch, 2.0 * distance - gear)
    return None


def worm_of_lead(lead: float, ratio: int, distance: float) -> WormSet:
    """A single-threaded set of given lead, ratio and centre distance: D_g = ratio × L / π, the worm takes the rest."""
    rest = 2.0 * distance - ratio * lead / math.pi
    if not rest > 0.0:
        raise DimensionError("distance", f"above {0.5 * ratio * lead / math.pi:.6g}", distance)
    return WormSet(1, ratio, lead, rest)


def worm_of_helix(threads: int, gear_teeth: int, gear_diameter: float, gear_helix: float) -> WormSet:
    """A set of given gear: its helix angle is the worm's lead angle."""
    pitch = math.pi * gear_diameter / gear_teeth
    return WormSet(threads, gear_teeth, pitch, threads * pitch / (math.pi * math.tan(gear_helix)))


def trims(mesh: Mesh) -> bool:
    """Whether an internal pair cannot be brought together radially, only along its axes; external pairs always can.

    A pinion that is moved in towards the ring's teeth, or the cutter that shapes them, passes their tips where
    θ₁ + inv φ_a₁ − inv φ_w ≥ (z₂/z₁)(θ₂ + inv φ_a₂ − inv φ_w) with sin² θ₁ = (1 − (cos φ_a₁/cos φ_a₂)²)/(1 −
    (z₁/z₂)²) and sin² θ₂ = ((cos φ_a₂/cos φ_a₁)² − 1)/((z₂/z₁)² − 1) (SDP/SI, Elements of Metric Gear Technology,
    eq. 5-9, 5-10: trimming). It is no fault of gears that run: planets are put in along their axes. A ring whose
    tips lie below its base circle has no involute there; such a pair is taken to trim.
    """
    if not mesh.gear.internal:
        return False
    tips = [gear.base_radius / gear.tip_radius for gear in (mesh.pinion, mesh.gear)]
    if tips[1] > 1.0:
        return True
    if tips[0] >= tips[1]:
        # The room between the tips shrinks all the way in; it is there where the pair runs.
        return False
    teeth = mesh.gear.teeth / mesh.pinion.teeth
    quotient = tips[1] / tips[0]
    squares = (1.0 - 1.0 / quotient**2) / (1.0 - 1.0 / teeth**2), (quotient**2 - 1.0) / (teeth**2 - 1.0)
    if max(squares) > 1.0:
        # The pinion's tip circle is larger than the ring's.
        return True
    one, other = (
        math.asin(math.sqrt(square)) + involute(math.acos(tip)) - involute(mesh.pressure_angle)
        for square, tip in zip(squares, tips, strict=True)
    )
    return one < teeth * other
