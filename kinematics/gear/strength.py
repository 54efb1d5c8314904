"""Strength of teeth, a first estimate: bending by Lewis and by AGMA, contact stress by AGMA.

Lewis treats the tooth as a beam with the whole tangential load at its tip. The line of the load crosses the middle of
the tooth at the apex of a parabola of constant strength; where this touches the profile, at the half thickness t/2 and
the depth l below the apex, the stress is σ = K_v W / (F m Y) with the form factor Y = t² / (6 l m).

AGMA applies the load at the highest point of single-pair contact, includes its radial part, and corrects for the
fillet:

    σ = W K_o K_v K_s K_m K_B / (F m J),    σ_c = C_p √(W K_o K_v K_s K_m / (d F I)),
    1/J = K_f m (cos φ_L / cos φ_w) (6 h / s² − tan φ_L / s),    I = cos φ_w sin φ_w / 2 · G / (G ± 1),

W stands on the working pitch circles, φ_w is the working pressure angle: the normal force is W / cos φ_w.
K_f = H + (s/ρ)^L (s/h)^M by Dolan and Broghamer (AGMA 908-B89; Budynas & Nisbett, Shigley's Mechanical Engineering
Design, 8th ed., ch. 14, whose equation numbers are cited with the factors). Units: newton, millimetre, MPa, m/s.

Helical teeth share the load: I is that of the plane of rotation divided by m_N, the face width over the minimum total
length of the lines of contact. Their J is read from charts (Figs. 14-7, 14-8) and has to be given by the user.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from kinematics.errors import DimensionError
from kinematics.gear.flanks import Contact
from kinematics.gear.profile import draw_half_space
from kinematics.gear.teeth import Gear, compute_corner_rounding, involute

STEEL_ELASTIC_COEFFICIENT = 191.0
"""Elastic coefficient C_p of steel gears, √MPa (Shigley, Table 14-8)."""

MILLIMETRES_PER_INCH = 25.4

MAX_FACE_WIDTH = 40.0
"""Face width, inches, up to which the load distribution factor is tabulated."""

FEET_PER_MINUTE = 60.0 / 0.3048
"""Feet per minute in one metre per second."""


def compute_barth_factor(speed: float) -> float:
    """Compute Lewis's velocity factor for cut or milled teeth, K_v = (1200 + V) / 1200, V in ft/min (eq. 14-4b)."""
    return (1200.0 + speed * FEET_PER_MINUTE) / 1200.0


def compute_dynamic_factor(speed: float, quality: float) -> float:
    """Compute AGMA's dynamic factor for a quality number Q_v of 3 to 12: ((A + √V) / A)^B (eq. 14-27, 14-28)."""
    # Constants A and B of the AGMA curves; metric speed converted to ft/min.
    b = 0.25 * (12.0 - quality) ** (2.0 / 3.0)
    a = 50.0 + 56.0 * (1.0 - b)
    return float(((a + math.sqrt(speed * FEET_PER_MINUTE)) / a) ** b)


def compute_size_factor(width: float, module: float, form: float) -> float:
    """Compute K_s = 1.192 (F √Y / P)^0.0535, F and 1/P in inches; at least 1 (Sec. 14-10)."""
    return max(
        1.0, 1.192 * math.pow(width / MILLIMETRES_PER_INCH * math.sqrt(form) * module / MILLIMETRES_PER_INCH, 0.0535)
    )


def compute_load_distribution(width: float, pinion_diameter: float) -> float:
    """Compute K_m of uncrowned teeth between close bearings in a commercial enclosed unit (eq. 14-30 to 14-35).

    The curves end at a face width of 40 inches; wider faces use that value.
    """
    # AGMA's lower limit of F/(10 d) is 0.05.
    face, share = min(width / MILLIMETRES_PER_INCH, MAX_FACE_WIDTH), max(0.05, width / (10.0 * pinion_diameter))
    if face <= 1.0:
        proportion = share - 0.025
    elif face <= 17.0:
        proportion = share - 0.0375 + 0.0125 * face
    else:
        proportion = share - 0.1109 + 0.0207 * face - 0.000228 * face**2
    return 1.0 + proportion + 0.127 + 0.0158 * face - 0.930e-4 * face**2


def compute_lewis_form(gear: Gear) -> float:
    """Compute Lewis's form factor Y of an external gear with the load at its tip.

    Raises
    ------
    DimensionError
        If the tooth has no section below its load.
    """
    apex, _ = _find_load_line(gear, gear.tip_radius)
    height, thick = _find_sections(gear, apex)
    # The weakest section: where the parabola of constant strength touches the profile.
    return float((thick**2 / (6.0 * height)).min())


def compute_bending_geometry(contact: Contact, second: bool) -> float:
    """Compute AGMA's factor J of the pinion of an external pair, or of the gear: spur teeth without load sharing.

    The load acts at the highest point of single-pair contact, one base pitch from the end of contact at the mate's tip.

    Raises
    ------
    DimensionError
        If the tooth has no section below its load, or the load does not bend it.
    """
    mesh = contact.mesh
    gear = mesh.gear if second else mesh.pinion
    # From the lowest point of contact, one base pitch up, a second pair takes over.
    highest = contact.reaches[1 if second else 0] + gear.base_pitch
    tip = math.sqrt(gear.tip_radius**2 - gear.base_radius**2)
    apex, angle = _find_load_line(gear, math.hypot(gear.base_radius, min(highest, tip)))
    height, thick = _find_sections(gear, apex)
    bent = 6.0 * height / thick**2 - math.tan(angle) / thick
    # The critical section is the one with the largest bending stress.
    at = int(np.argmax(bent))
    phi = gear.pressure_angle
    stress = math.cos(angle) / math.cos(mesh.pressure_angle) * float(bent[at])
    if not stress > 0.0:
        raise DimensionError("tooth", "kinematics-tooth-bent-by-load", gear)
    curved = _compute_fillet_radius(gear) / gear.module
    h, low, high = 0.34 - 0.4583662 * phi, 0.316 - 0.4583662 * phi, 0.290 + 0.4583662 * phi
    raised = h + (float(thick[at]) / curved) ** low * (float(thick[at]) / float(height[at])) ** high
    return float(1.0 / (raised * stress))


def compute_contact_geometry(pressure_angle: float, ratio: float, internal: bool, sharing: float = 1.0) -> float:
    """Compute AGMA's factor I (eq. 14-23).

    ``ratio`` ≥ 1 is gear teeth over pinion teeth, and ``sharing`` is the load sharing ratio m_N.
    """
    share = ratio / (ratio - 1.0 if internal else ratio + 1.0)
    return 0.5 * math.cos(pressure_angle) * math.sin(pressure_angle) * share / sharing


def compute_load_sharing(contact_ratio: float, base_pitch: float, base_helix: float, width: float) -> float:
    """Compute AGMA's load sharing ratio m_N = F / L_min of helical teeth with a face of at least one axial pitch.

    The lines of contact cross a field as wide as the face F and as long as the path of contact. With the transverse
    contact ratio m_p, its fractional part n_r, and the axial pitch p_x, their total length is at least
    (m_p F − n p_x) / cos ψ_b. Here n depends on the fraction of the overlap (AGMA 908-B89); its maximum n_r (1 − n_r)
    is used, so that a wider face never shares the load worse. For an overlap above 2, m_N = cos ψ_b / (0.95 m_p) is
    usual (eq. 14-21).

    Parameters
    ----------
    contact_ratio : float
        Contact ratio in the plane of rotation.
    base_pitch : float
        Base pitch in the plane of rotation, in the unit of the width.
    base_helix : float
        Helix angle on the base cylinders, radians, positive.
    width : float
        Face width.
    """
    fraction = contact_ratio - math.floor(contact_ratio)
    lost = fraction * (1.0 - fraction) * base_pitch / math.tan(base_helix)
    return math.cos(base_helix) * width / (contact_ratio * width - lost)


def _find_load_line(gear: Gear, radius: float) -> tuple[float, float]:
    """Find where the flank's normal at a radius crosses the middle of the tooth, and its angle to the tangent."""
    there = math.acos(min(1.0, gear.base_radius / radius))
    half = gear.tooth_thickness / (2.0 * gear.pitch_radius) + involute(gear.pressure_angle) - involute(there)
    angle = there - half
    return gear.base_radius / math.cos(angle), angle


def _find_sections(gear: Gear, apex: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Find the heights of the apex above the sections of the tooth below it, and their thickness, in modules."""
    depth, half = _trace_tooth(gear)
    # Sections at the apex itself would divide by a vanishing height.
    below = (apex - depth > 1e-6 * gear.module) & (half > 0.0)
    if not below.any():
        raise DimensionError("tooth", "kinematics-tooth-with-section", gear)
    return (apex - depth[below]) / gear.module, 2.0 * half[below] / gear.module


@lru_cache(maxsize=1024)
def _trace_tooth(gear: Gear) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Trace one side of the tooth: distance from the centre along its middle, and half the thickness there."""
    points = draw_half_space(gear)
    # Rotate from the frame of the tooth space into that of the tooth.
    seen = points * np.exp(-1j * math.pi / gear.teeth)
    return np.asarray(seen.real), np.asarray(-seen.imag)


def _compute_fillet_radius(gear: Gear) -> float:
    """Compute the minimum radius of curvature of the fillet, at its root: ρ + b² / (r + b), b from the pitch circle
    (AGMA 908)."""
    rounding = gear.module * compute_corner_rounding(gear.pressure_angle, gear.dedendum)
    deep = gear.module * (gear.dedendum - gear.shift) - rounding
    return rounding + deep**2 / (gear.pitch_radius + deep)


@dataclass(frozen=True)
class Load:
    """A tangential load on a pair.

    ``force`` is in newtons, ``speed`` at the working pitch circles in m/s; face ``width``, ``module`` and
    ``pinion_diameter`` are in millimetres.
    """

    force: float
    speed: float
    width: float
    module: float
    pinion_diameter: float


@dataclass(frozen=True)
class Factors:
    """Factors of one gear; 1 for those that a method does not use."""

    overload: float
    dynamic: float
    size: float
    load_distribution: float
    rim: float


def compute_lewis_stress(load: Load, form: float, dynamic: float) -> float:
    """Compute the bending stress by Lewis, σ = K_v W / (F m Y) (eq. 14-8)."""
    return dynamic * load.force / (load.width * load.module * form)


def compute_bending_stress(load: Load, geometry: float, factors: Factors) -> float:
    """Compute AGMA's bending stress (eq. 14-15)."""
    raised = factors.overload * factors.dynamic * factors.size * factors.load_distribution * factors.rim
    return load.force * raised / (load.width * load.module * geometry)


def compute_contact_stress(load: Load, geometry: float, factors: Factors, elastic: float) -> float:
    """Compute AGMA's contact stress (eq. 14-16)."""
    raised = factors.overload * factors.dynamic * factors.size * factors.load_distribution
    return elastic * math.sqrt(load.force * raised / (load.pinion_diameter * load.width * geometry))
