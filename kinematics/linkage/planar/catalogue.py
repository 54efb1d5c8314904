"""Catalogue of textbook mechanisms: joints, links, slides and gears of a :class:`Mechanism`.

Each function takes the usual dimensions of a mechanism and returns its skeleton at one input angle; the general solver
:func:`kinematics.linkage.planar.drive.drive` then handles all of them alike. Joints: O2, O4,
O5, O6 fixed pivots, A, B, C, D moving pivots, P the coupler point. Angles are radians, absolute.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from kinematics.errors import DimensionError
from kinematics.linkage.fourbar.closed_form import CROSSED_ASSEMBLY, OPEN_ASSEMBLY, Fourbar, positions, require
from kinematics.linkage.planar.mechanism import GearPair, Mechanism, Slide

PIVOT_TOLERANCE = 1e-14
"""Distance, as a share of the ground, within which a crank pin coincides with a pivot: its direction is then only
rounding."""


def _require_sign(name: str, sign: int) -> None:
    require(name, "kinematics-sign", np.asarray(sign), np.abs(sign) == 1)


def make_fourbar(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> Mechanism:
    """Build the pin-jointed fourbar at an input angle, as a mechanism with the designs' shape.

    Raises
    ------
    DimensionError
        If it cannot be assembled at that angle.
    """
    angle = np.asarray(input_angle, np.float64)
    at = positions(linkage, angle[..., None], assembly)
    if not at.valid.all():
        raise DimensionError("input_angle", "kinematics-fourbar-closes", float(angle.flat[0]))
    return Mechanism(
        {
            "O2": linkage.input_pivot,
            "O4": linkage.output_pivot,
            "A": at.a[..., 0],
            "B": at.b[..., 0],
            "P": at.p[..., 0],
        },
        {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B", "P"), "output": ("O4", "B")},
        "input",
    )


def make_slider_crank(
    pivot: complex,
    slide_point: complex,
    slide_angle: float,
    crank: float,
    coupler: float,
    crank_angle: float,
    assembly: int = OPEN_ASSEMBLY,
    coupler_point: complex = 0.0,
    driven_by: str = "crank",
) -> Mechanism:
    """Build the slider-crank, offset or in line (Norton, Sec. 4.5).

    ``open`` is the slider's position farther along the slide's direction. ``coupler_point`` is P in the coupler's
    frame, origin at A, real axis towards B. ``driven_by`` is ``crank`` or ``slider``.
    """
    _require_sign("assembly", assembly)
    direction = np.exp(1j * slide_angle)
    pin_a = pivot + crank * np.exp(1j * crank_angle)
    local = (pin_a - slide_point) * np.conj(direction)
    under = coupler**2 - local.imag**2
    if under < 0.0:
        raise DimensionError("crank_angle", "kinematics-slider-crank-closes", crank_angle)
    pin_b = slide_point + direction * (local.real + assembly * np.sqrt(under))
    return Mechanism(
        {"O2": pivot, "A": pin_a, "B": pin_b, "P": pin_a + coupler_point * (pin_b - pin_a) / coupler},
        {"ground": ("O2",), "crank": ("O2", "A"), "coupler": ("A", "B", "P")},
        "crank" if driven_by == "crank" else "B",
        slides=(Slide("B", "ground", np.asarray(slide_point), np.asarray(slide_angle)),),
    )


def make_inverted_slider_crank(
    o2: complex,
    o4: complex,
    crank: float,
    output: float,
    line_angle: float,
    crank_angle: float,
    assembly: int = OPEN_ASSEMBLY,
) -> Mechanism:
    """Build the inverted slider-crank (Norton, Sec. 4.7): crank pin A slides on a line fixed in the output link.

    The line passes through B, the end of the output link of length c from O4, at ``line_angle`` (Norton's γ, the angle
    of link 3 minus that of link 4) from the line O4 → B. The line is directed from B at that angle. In an ``open``
    mechanism A lies ahead of the point of the line nearest to O4, in a ``crossed`` one behind that point. With c = 0
    the line passes through O4, and B only marks the direction of the output link.

    Raises
    ------
    DimensionError
        If A lies on O4 or does not reach the line, or for an assembly other than +1 and −1.
    """
    _require_sign("assembly", assembly)
    pin_a = o2 + crank * np.exp(1j * crank_angle)
    reach = pin_a - o4
    if abs(reach) <= PIVOT_TOLERANCE * abs(o4 - o2):
        raise DimensionError("crank_angle", "kinematics-crank-pin-not-on-pivot", crank_angle)
    # The line's distance from O4 is c sin γ: a line at that distance has to pass through A.
    if abs(output * np.sin(line_angle)) > abs(reach):
        raise DimensionError("crank_angle", "kinematics-inverted-slider-crank-closes", crank_angle)
    # In the output's frame A lies on the line at t along it from B: |c + t e^{iγ}| = |reach|.
    along = -output * np.cos(line_angle) + assembly * np.sqrt(abs(reach) ** 2 - (output * np.sin(line_angle)) ** 2)
    local = output + along * np.exp(1j * line_angle)
    turned = reach / local
    turned = turned / abs(turned)
    return Mechanism(
        {"O2": o2, "O4": o4, "A": pin_a, "B": o4 + (output if output > 0.0 else abs(reach)) * turned},
        {"ground": ("O2", "O4"), "input": ("O2", "A"), "output": ("O4", "B")},
        "input",
        slides=(Slide("A", "output", np.asarray(o4 + output * turned), np.angle(turned * np.exp(1j * line_angle))),),
    )


def make_quick_return(
    o2: complex,
    o4: complex,
    crank: float,
    rocker: float,
    coupler: float,
    slide_point: complex,
    slide_angle: float,
    crank_angle: float,
    ram: int = OPEN_ASSEMBLY,
    rocker_side: int = OPEN_ASSEMBLY,
) -> Mechanism:
    """Build a crank-shaper (crank shorter than the ground) or Whitworth (longer) quick return.

    The crank pin A slides in the link that turns about O4, through O4 itself; its end C, ``rocker`` from O4 (on A's
    side for ``open``), drives the ram D through the coupler; the ram slides on the given line.
    """
    _require_sign("ram", ram)
    _require_sign("rocker_side", rocker_side)
    pin_a = o2 + crank * np.exp(1j * crank_angle)
    reach = pin_a - o4
    if abs(reach) <= PIVOT_TOLERANCE * abs(o4 - o2):
        raise DimensionError("crank_angle", "kinematics-crank-pin-not-on-pivot", crank_angle)
    pin_c = o4 + rocker_side * rocker * reach / abs(reach)
    direction = np.exp(1j * slide_angle)
    local = (pin_c - slide_point) * np.conj(direction)
    under = coupler**2 - local.imag**2
    if under < 0.0:
        raise DimensionError("coupler", "kinematics-reaches-ram-slide", coupler)
    pin_d = slide_point + direction * (local.real + ram * np.sqrt(under))
    return Mechanism(
        {"O2": o2, "O4": o4, "A": pin_a, "C": pin_c, "D": pin_d},
        {"ground": ("O2", "O4"), "input": ("O2", "A"), "rocker": ("O4", "C"), "coupler": ("C", "D")},
        "input",
        slides=(
            Slide("A", "rocker", np.asarray(o4), np.asarray(np.angle(reach))),
            Slide("D", "ground", np.asarray(slide_point), np.asarray(slide_angle)),
        ),
    )


def make_geared_fivebar(
    o2: complex,
    o5: complex,
    input: float,
    coupler_1: float,
    coupler_2: float,
    output: float,
    gear_ratio: float,
    phase: float,
    input_angle: float,
    assembly: int = OPEN_ASSEMBLY,
    coupler_point: complex = 0.0,
) -> Mechanism:
    """Build the geared fivebar (Norton, Sec. 4.8): θ5 = λ θ2 + φ, both from the ground line O2 → O5.

    ``open``: C, where the couplers meet, lies to the left of the directed line from A to B. ``coupler_point`` is P on
    coupler 1 in its frame, origin at A, real axis towards C. ``input_angle`` is not reduced by full turns.
    """
    _require_sign("assembly", assembly)
    require("gear_ratio", "kinematics-finite", np.asarray(gear_ratio), np.isfinite(gear_ratio))
    ground = float(np.angle(o5 - o2))
    pin_a = o2 + input * np.exp(1j * input_angle)
    pin_b = o5 + output * np.exp(1j * (ground + gear_ratio * (input_angle - ground) + phase))
    base = pin_b - pin_a
    f = abs(base)
    product = (coupler_1 + coupler_2 + f) * (coupler_1 + coupler_2 - f)
    # Heron's product in factored form, accurate near a toggle.
    product *= (f + (coupler_1 - coupler_2)) * (f - (coupler_1 - coupler_2))
    if product < 0.0 or f == 0.0:
        raise DimensionError("input_angle", "kinematics-geared-fivebar-closes", input_angle)
    along = (f * f + (coupler_1 - coupler_2) * (coupler_1 + coupler_2)) / (2.0 * f)
    pin_c = pin_a + base / f * (along + 1j * assembly * np.sqrt(product) / (2.0 * f))
    return Mechanism(
        {
            "O2": o2,
            "O5": o5,
            "A": pin_a,
            "B": pin_b,
            "C": pin_c,
            "P": pin_a + coupler_point * (pin_c - pin_a) / coupler_1,
        },
        {
            "ground": ("O2", "O5"),
            "input": ("O2", "A"),
            "coupler_1": ("A", "C", "P"),
            "coupler_2": ("B", "C"),
            "output": ("O5", "B"),
        },
        "input",
        gears=(GearPair("input", "output", gear_ratio),),
        turns=round((input_angle - float(np.angle(pin_a - o2))) / (2.0 * np.pi)),
    )


def make_peaucellier(o2: complex, o4: complex, crank: float, arm: float, side: float, input_angle: float) -> Mechanism:
    """Build Peaucellier's eightbar: P moves on a straight line exactly if the crank equals the distance O2 O4.

    ``arm`` is the length of the two links from O4 to the rhombus A B P C of the given ``side``; arm > side.
    """
    pin_a = o2 + crank * np.exp(1j * input_angle)
    reach = pin_a - o4
    f = abs(reach)
    half = (f * f + (arm - side) * (arm + side)) / (2.0 * f) if f > 0.0 else np.inf
    if not abs(half) < arm:
        raise DimensionError("input_angle", "kinematics-arms-reach-rhombus", input_angle)
    # B and C are symmetric about the line from O4 to A.
    unit, height = reach / f, np.sqrt((arm - half) * (arm + half))
    pin_b, pin_c = o4 + unit * (half + 1j * height), o4 + unit * (half - 1j * height)
    return Mechanism(
        {"O2": o2, "O4": o4, "A": pin_a, "B": pin_b, "C": pin_c, "P": pin_b + pin_c - pin_a},
        {
            "ground": ("O2", "O4"),
            "input": ("O2", "A"),
            "arm_1": ("O4", "B"),
            "arm_2": ("O4", "C"),
            "side_1": ("A", "B"),
            "side_2": ("A", "C"),
            "side_3": ("B", "P"),
            "side_4": ("C", "P"),
        },
        "input",
    )


def make_hart(
    o2: complex,
    o4: complex,
    crank: float,
    long: float,
    short: float,
    share: float,
    input_angle: float,
    side: int = OPEN_ASSEMBLY,
) -> Mechanism:
    """Build Hart's inversor, a sixbar: P moves on a straight line exactly if the crank equals the distance O2 O4.

    Crossed parallelogram B C E D with ``long`` links B C and D E and ``short`` links B D and C E. The fixed pivot O4 on
    B C, the crank pin A on B D and P on E C divide these links at the same ``share``, from B, B and E. They are
    collinear, parallel to B E and D C, with O4 A = share · D C and O4 P = (1 − share) · B E on the other side of O4,
    and by Ptolemy's theorem

        O4 A · O4 P = share (1 − share) (long² − short²)                              (Rao, Sec. 4.2.2).

    ``open``: B lies to the left of the directed line from A to O4.

    Raises
    ------
    DimensionError
        If the short and the long link cannot reach each other from A and O4, or for a share outside 0 … 1, a short link
        that is not the shorter one, or a side other than +1 and −1.
    """
    _require_sign("side", side)
    require("share", "kinematics-between-0-and-1", np.asarray(share), np.bool_(0.0 < share < 1.0))
    require("short", "kinematics-shorter-than-long-link", np.asarray(short), np.bool_(short < long))
    pin_a = o2 + crank * np.exp(1j * input_angle)
    reach = pin_a - o4
    # The distance D C follows from O4 A = share · D C.
    base = abs(reach) / share
    if not long - short < base < long + short:
        raise DimensionError("input_angle", "kinematics-links-reach-each-other", input_angle)
    # A trapezoid with the parallel sides B E and D C; x from A to O4, B and E on the side of positive y.
    top = (long - short) * (long + short) / base
    height = side * np.sqrt((short - 0.5 * (base - top)) * (short + 0.5 * (base - top)))
    corners = {
        "B": complex(-0.5 * top, height), "E": complex(0.5 * top, height),
        "D": complex(-0.5 * base, 0.0), "C": complex(0.5 * base, 0.0),
    }  # fmt: skip
    pivot = corners["B"] + share * (corners["C"] - corners["B"])
    unit = -reach / abs(reach)
    placed = {name: o4 + unit * (corner - pivot) for name, corner in corners.items()}
    return Mechanism(
        {"O2": o2, "O4": o4, "A": pin_a, **placed, "P": placed["E"] + share * (placed["C"] - placed["E"])},
        {
            "ground": ("O2", "O4"),
            "input": ("O2", "A"),
            "long_1": ("B", "O4", "C"),
            "short_1": ("B", "A", "D"),
            "short_2": ("E", "P", "C"),
            "long_2": ("D", "E"),
        },
        "input",
    )


def make_pantograph(
    o2: complex,
    o4: complex,
    crank: float,
    near: float,
    far: float,
    arm: float,
    input_angle: float,
    side: int = OPEN_ASSEMBLY,
) -> Mechanism:
    """Build the pantograph with its tracing pin P on a crank: Q draws the path of P enlarged by far / near about O4.

    The bar O4 A B has A at ``near`` and B at ``far`` from O4; A B D P is a parallelogram with A P = ``arm``, and Q
    lies on B D with B Q = arm · far / near, so that O4, P, Q are collinear (Rao, Sec. 4.4). ``open``: A lies to the
    left of the directed line from P to O4.

    Raises
    ------
    DimensionError
        If the bar and the arm do not reach from O4 to P, for ``far`` not longer than ``near``, or a side other than
        +1 and −1.
    """
    _require_sign("side", side)
    require("far", "kinematics-longer-than-near", np.asarray(far), np.bool_(far > near))
    pin_p = o2 + crank * np.exp(1j * input_angle)
    reach = o4 - pin_p
    f = abs(reach)
    if not abs(near - arm) < f < near + arm:
        raise DimensionError("input_angle", "kinematics-bar-and-arm-reach-crank-pin", input_angle)
    along = (f * f + (arm - near) * (arm + near)) / (2.0 * f)
    pin_a = pin_p + reach / f * (along + 1j * side * np.sqrt((arm - along) * (arm + along)))
    ratio = far / near
    pin_b, pin_q = o4 + ratio * (pin_a - o4), o4 + ratio * (pin_p - o4)
    return Mechanism(
        {"O2": o2, "O4": o4, "P": pin_p, "A": pin_a, "B": pin_b, "D": pin_b + (pin_p - pin_a), "Q": pin_q},
        {
            "ground": ("O2", "O4"),
            "input": ("O2", "P"),
            "bar": ("O4", "A", "B"),
            "arm": ("A", "P"),
            "follower": ("B", "D", "Q"),
            "strut": ("P", "D"),
        },
        "input",
    )


SIXBAR_LINKS: dict[str, dict[str, tuple[str, ...]]] = {
    "watt_1": {
        "ground": ("O2", "O4"),
        "input": ("O2", "A"),
        "coupler": ("A", "B", "C"),
        "output": ("O4", "B", "D"),
        "link_5": ("C", "E"),
        "link_6": ("D", "E", "P"),
    },
    "watt_2": {
        "ground": ("O2", "O4", "O6"),
        "input": ("O2", "A"),
        "coupler": ("A", "B", "P"),
        "rocker": ("O4", "B", "C"),
        "link_5": ("C", "D"),
        "output": ("O6", "D"),
    },
    "stephenson_1": {
        "ground": ("O2", "O4"),
        "input": ("O2", "A", "C"),
        "coupler": ("A", "B", "P"),
        "output": ("O4", "B", "D"),
        "link_5": ("C", "E"),
        "link_6": ("D", "E"),
    },
    "stephenson_2": {
        "ground": ("O2", "O4"),
        "input": ("O2", "A", "C"),
        "link_3": ("A", "B"),
        "link_4": ("B", "D", "E", "P"),
        "link_5": ("C", "D"),
        "output": ("O4", "E"),
    },
    "stephenson_3": {
        "ground": ("O2", "O4", "O6"),
        "input": ("O2", "A"),
        "coupler": ("A", "B", "C", "P"),
        "rocker": ("O4", "B"),
        "link_5": ("C", "D"),
        "output": ("O6", "D"),
    },
}
"""Links of the sixbars of Watt's and Stephenson's chains, with the names of their joints."""


def make_sixbar(kind: str, joints: Mapping[str, ArrayLike], input: str = "input") -> Mechanism:
    """Build a sixbar from the positions of its joints; ``kind`` is a key of :data:`SIXBAR_LINKS`, P is optional.

    ``input`` is any link that is pinned to the ground.
    """
    links = {name: tuple(j for j in listed if j in joints) for name, listed in SIXBAR_LINKS[kind].items()}
    return Mechanism(dict(joints), links, input)


ASSEMBLY_SIGNS = {"open": OPEN_ASSEMBLY, "crossed": CROSSED_ASSEMBLY}
"""Assembly signs by their names."""
