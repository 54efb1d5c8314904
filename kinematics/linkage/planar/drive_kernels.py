"""Driving a mechanism as a compiled sweep over designs × inputs: the closures of :mod:`closures`, one after the other.

A mechanism is given as a *program*: rows of integers that specify the closure of each link and the joints that it
determines. At each position the kernel stores the value and the first derivatives (a jet) of every joint and of every
link's rotation φ, e^{iφ} and shift, and processes the rows in order.

Every closure is Re(e^{−iφ} k) = r. With d = sign · √(|k|² − r²) it is solved by e^{iφ} = k (r − i d) / |k|², without an
angle; angles are computed at the end. The derivatives follow from differentiating the equation:

    Re(e^{−iφ} k') + φ' d = r',
    Re(e^{−iφ} (k'' − 2iφ'k' − φ'²k)) + φ'' d = r'',
    Re(e^{−iφ} (k''' − 3iφ'k'' − 3(iφ'' + φ'²)k' + (iφ'³ − 3φ'φ'')k)) + φ''' d = r'''.

A closure's *margin* is the jet of |k|² − r², which changes sign at its limits, in a scale of its own: by |b|² for RRP
and by |b|² c² for RRR it is the square of the sine. Where k vanishes relative to its *reach* (|b|; 1 for RPR) any φ
solves the equation, or none does: the closure is undetermined, and no solution is returned.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Integers, Mask, Real
from kinematics.compiling import KernelOptions, njit
from kinematics.linkage.kernels import TOGGLE_SINE, TOGGLE_SLACK

GEAR, CARRIED_LINK, RRP, RPR, RRR, GIVEN_ROTATION = range(6)
"""Codes of closures. GIVEN_ROTATION is a link whose rotation is an argument (class III, solved by :mod:`triads`)."""

KIND, LINK, PIN, JOINT, OTHER_LINK, OTHER_PIN, SLIDE, CLOSING = range(8)
"""Columns of a program. CLOSING is the number of a closure among those with two solutions, −1 for others."""

COINCIDENCE_TOLERANCE = 1e-13
"""Length of the vector k, as a share of its reach, below which its direction is only rounding."""

LIMIT_TOLERANCE = 16.0 * TOGGLE_SLACK
"""Negative margin that still counts as zero, so that a mechanism exists at its own limits: a limit is known to the
rounding of an angle, times the margin's rate, which is up to about ten in unit coordinates."""


OPTIONS: KernelOptions = {"cache": True, "nogil": True, "error_model": "numpy"}
"""Options of the kernels."""

INLINE_OPTIONS: KernelOptions = {**OPTIONS, "forceinline": True}
"""Options of a step that is called in one place: LLVM inlines it, since a call would pass its arrays at each position.
Numba's own ``inline`` would make the sweep up to 20 % slower."""


class Code(NamedTuple):
    """M mechanisms of one topology, joints and lines in unit coordinates.

    ``rows`` (steps, 8) is the program, ``ratios`` (steps,) its gear ratios. ``gives`` (links, 1 + joints): the number
    of joints that a link determines, and their indices; link 0 is the ground. ``joints``, ``lines``, ``line_angles``
    and ``link_angles`` have the shape (M, count); ``frame`` (M, 2) is origin and size. ``slides`` (slides, 2): joint
    and link. ``driver``: the input link (or −1), its pin (or the input slide's joint), and the input slide.
    """

    rows: Integers
    ratios: Real
    gives: Integers
    joints: Complex
    lines: Complex
    line_angles: Real
    link_angles: Real
    frame: Complex
    slides: Integers
    driver: Integers


class Sweep(NamedTuple):
    """Results of the sweep for D designs at N inputs; n is the length of a jet.

    ``points`` (joints, n, D, N), ``angles`` (links, n, D, N), ``travels`` (slides, n, D, N); by closure, ``sines``
    (closures, D, N) and ``margins`` (closures, 1 or 2, D, N); ``masks`` (2, D, N): valid, smooth.
    """

    points: Complex
    angles: Real
    travels: Real
    sines: Real
    margins: Real
    masks: Mask


@njit(**OPTIONS)
def drive(
    rows: Integers,
    ratios: Real,
    gives: Integers,
    joints: Complex,
    lines: Complex,
    line_angles: Real,
    link_angles: Real,
    frame: Complex,
    slides: Integers,
    driver: Integers,
    own: Integers,
    signs: Integers,
    moved: Real,
    given: Real,
    points: Complex,
    angles: Real,
    travels: Real,
    sines: Real,
    margins: Real,
    masks: Mask,
) -> None:
    """Drive all designs: fill margins and sines and, unless ``points`` has no rows, all other results.

    The arrays of a :class:`Code` and of a :class:`Sweep` are separate arguments: unpacking a tuple of arrays costs 2 µs
    per call, a quarter of a call in root finding.

    own : (D,), index of the mechanism of each design. signs : (steps, D). moved : (D, n, N), input from the reference.
    given : (links, D, n, N), rotations of the links of kind GIVEN_ROTATION.
    """
    length = moved.shape[1]
    x = np.zeros((joints.shape[1], 4), np.complex128)
    rotation, turned = np.zeros((len(gives), 4)), np.zeros(len(gives), np.bool_)  # turned: φ is known, not only e^{iφ}
    unit, shift = np.zeros((len(gives), 4), np.complex128), np.zeros((len(gives), 4), np.complex128)
    k, r, base = np.zeros(4, np.complex128), np.zeros(4), np.zeros(4, np.complex128)
    arms, directions = np.zeros((len(rows), 2), np.complex128), np.zeros(len(rows), np.complex128)
    lengths, reaches, norms = np.zeros((len(rows), 2)), np.zeros(len(rows)), np.zeros(len(rows))
    unit[0, 0] = 1.0
    turned[0] = True
    for design in range(moved.shape[0]):
        m = own[design]
        place, line, along = joints[m], lines[m], line_angles[m]
        origin, size = frame[m, 0], frame[m, 1].real
        # Consecutive designs often repeat a mechanism: recompute its constants only on a change.
        if design == 0 or m != own[design - 1]:
            for n in range(1, gives[0, 0] + 1):
                x[gives[0, n], 0] = place[gives[0, n]]
            _compute_reference(rows, place, line, along, arms, directions, lengths, reaches, norms)
        for at in range(moved.shape[2]):
            if driver[0] < 0:
                joint, angle = driver[1], along[driver[2]]
                for n in range(length):
                    x[joint, n] = moved[design, n, at] * complex(math.cos(angle), math.sin(angle)) / size
                x[joint, 0] += place[joint]
            else:
                for n in range(length):
                    rotation[driver[0], n] = moved[design, n, at]
                turned[driver[0]] = True
                _place_link(driver[0], driver[1], place, gives, rotation, turned, unit, shift, x, length)
            for row in range(len(rows)):
                step = rows[row]
                kind, link, pin, joint = step[KIND], step[LINK], step[PIN], step[JOINT]
                other, other_pin, closing = step[OTHER_LINK], step[OTHER_PIN], step[CLOSING]
                if kind == GEAR:
                    # Gears need the angle itself, which dyads do not compute.
                    if not turned[other]:
                        rotation[other, 0] = math.atan2(unit[other, 0].imag, unit[other, 0].real)
                    for n in range(length):
                        rotation[link, n] = ratios[row] * rotation[other, n]
                    turned[link] = True
                elif kind == CARRIED_LINK:
                    _orient_link(link, pin, joint, arms[row, 0], rotation, unit, x, length)
                elif kind == GIVEN_ROTATION:
                    for n in range(length):
                        rotation[link, n] = given[link, design, n, at]
                    turned[link] = True
                elif kind == RRR:
                    # Solve for the shorter link: in an equation for the longer one its square would be lost to
                    # rounding.
                    first = 1 if lengths[row, 1] < lengths[row, 0] else 0
                    solved, sign = (other, -signs[row, design]) if first else (link, signs[row, design])
                    reach, far = lengths[row, first], lengths[row, 1 - first]
                    _equate_links(pin, other_pin, arms[row, first], first, reach, far, x, k, r, base, length)
                    square = base[0].real * base[0].real + base[0].imag * base[0].imag
                    sine = _close_loop(
                        k,
                        r,
                        reach,
                        norms[row],
                        square,
                        sign,
                        rotation,
                        unit,
                        solved,
                        margins,
                        closing,
                        design,
                        at,
                        length,
                    )
                    # Convert to the sine of the angle between the two links, which is the transmission angle.
                    sine *= math.sqrt(square) / far
                    sines[closing, design, at] = -sine if first else sine
                else:
                    if kind == RRP:
                        normal, on_line = directions[row], line[step[SLIDE]]
                        _equate_joint_on_line(
                            other, pin, arms[row, 0], normal, on_line, unit, shift, x, k, r, base, length
                        )
                    else:
                        _equate_line_on_joint(pin, joint, arms[row, 0], directions[row], x, k, r, length)
                    reach, norm, sign = reaches[row], norms[row], signs[row, design]
                    sines[closing, design, at] = _close_loop(
                        k, r, reach, norm, 0.0, sign, rotation, unit, link, margins, closing, design, at, length
                    )
                if kind == RRR and first:
                    _place_link(other, other_pin, place, gives, rotation, turned, unit, shift, x, length)
                    _place_joint(other, joint, place, unit, shift, x, length)
                    _orient_link(link, pin, joint, arms[row, 0], rotation, unit, x, length)
                _place_link(link, pin, place, gives, rotation, turned, unit, shift, x, length)
                if kind == RRR and first:
                    # Restore the joint: the longer link's pose has overwritten it with a larger rounding error.
                    _place_joint(other, joint, place, unit, shift, x, length)
                elif kind == RRR:
                    _orient_link(other, other_pin, joint, arms[row, 1], rotation, unit, x, length)
                    _place_link(other, other_pin, place, gives, rotation, turned, unit, shift, x, length)
            if not len(points):
                continue
            valid, smooth = _has_positions(x, length)
            masks[0, design, at], masks[1, design, at] = valid, smooth
            # At a toggle only the position is returned.
            known = length if smooth else (1 if valid else 0)
            _write_joints(x, origin, size, points, known, length, design, at)
            _write_rotations(rotation, unit, turned, link_angles[m], angles, known, length, design, at)
            _write_travels(x, unit, shift, slides, line, along, size, travels, known, length, design, at)
            if not valid:
                for closing in range(sines.shape[0]):
                    sines[closing, design, at] = np.nan


@njit(**OPTIONS)
def _compute_reference(
    rows: Integers,
    place: Complex,
    line: Complex,
    along: Real,
    arms: Complex,
    directions: Complex,
    lengths: Real,
    reaches: Real,
    norms: Real,
) -> None:
    """Compute the constants over all inputs: by row, the vectors from the pins to the joint, and the slide's normal."""
    for row in range(len(rows)):
        kind, pin, joint, slide = rows[row, KIND], rows[row, PIN], rows[row, JOINT], rows[row, SLIDE]
        if kind in (GEAR, GIVEN_ROTATION):
            continue
        arms[row, 0] = (line[slide] if kind == RPR else place[joint]) - place[pin]
        if kind == RRR:
            arms[row, 1] = place[joint] - place[rows[row, OTHER_PIN]]
        lengths[row, 0], lengths[row, 1] = abs(arms[row, 0]), abs(arms[row, 1])
        reaches[row], norms[row] = lengths[row, 0], lengths[row, 0] ** 2
        if kind == RPR:
            reaches[row], norms[row] = 1.0, 1.0
        elif kind == RRR:
            norms[row] *= lengths[row, 1] ** 2
        if slide >= 0:
            directions[row] = complex(-math.sin(along[slide]), math.cos(along[slide]))


@njit(**INLINE_OPTIONS)
def _equate_links(
    pin: int,
    other_pin: int,
    arm: complex,
    first: int,
    reach: float,
    far: float,
    x: Complex,
    k: Complex,
    r: Real,
    base: Complex,
    length: int,
) -> None:
    """Set k and r of two links that meet (RRR), for the link with the given arm of length ``reach``.

    ``first`` is 1 if that is the second of both links, whose base points backwards, and ``far`` is the length of the
    other one. With the base from its own pin to the other pin, k = arm̄ · base and r = (|base|² + reach² − far²)/2.
    """
    for n in range(length):
        base[n] = x[other_pin, n] - x[pin, n]
        k[n] = arm.conjugate() * (-base[n] if first else base[n])
    for n in range(length):
        r[n] = 0.0
        for j in range(n + 1):
            r[n] += 0.5 * _compute_binomial(n, j) * (base[j] * base[n - j].conjugate()).real
    # Factored difference of squares, against cancellation of nearly equal lengths.
    r[0] += (reach - far) * (reach + far) / 2.0


@njit(**INLINE_OPTIONS)
def _equate_joint_on_line(
    other: int,
    pin: int,
    arm: complex,
    normal: complex,
    on_line: complex,
    unit: Complex,
    shift: Complex,
    x: Complex,
    k: Complex,
    r: Real,
    base: Complex,
    length: int,
) -> None:
    """Set k and r of a link whose joint slides on a line of another link (RRP): its distance from the line is zero."""
    for n in range(length):
        k[n] = unit[other, n] * normal * arm.conjugate()
        base[n] = unit[other, n] * on_line + shift[other, n] - x[pin, n]
    for n in range(length):
        r[n] = 0.0
        for j in range(n + 1):
            r[n] += _compute_binomial(n, j) * ((unit[other, j] * normal).conjugate() * base[n - j]).real


@njit(**INLINE_OPTIONS)
def _equate_line_on_joint(
    pin: int, joint: int, arm: complex, normal: complex, x: Complex, k: Complex, r: Real, length: int
) -> None:
    """Set k and r of a link whose line slides on a known joint (RPR): the line keeps its distance from the pin."""
    for n in range(length):
        k[n] = normal.conjugate() * (x[joint, n] - x[pin, n])
        r[n] = 0.0
    r[0] = (normal.conjugate() * arm).real


@njit(**INLINE_OPTIONS)
def _has_positions(x: Complex, length: int) -> tuple[bool, bool]:
    """Return whether all joints have positions, and all their derivatives."""
    valid, smooth = True, True
    for joint in range(len(x)):
        valid = valid and np.isfinite(x[joint, 0])
        for n in range(1, length):
            smooth = smooth and np.isfinite(x[joint, n])
    return valid, smooth and valid


@njit(**INLINE_OPTIONS)
def _write_joints(
    x: Complex, origin: complex, size: float, points: Complex, known: int, length: int, design: int, at: int
) -> None:
    """Write joints in the mechanism's own coordinates; NaN from the derivative ``known`` on."""
    for joint in range(len(x)):
        points[joint, 0, design, at] = x[joint, 0] * size + origin if known else complex(np.nan, np.nan)
        for n in range(1, length):
            points[joint, n, design, at] = x[joint, n] * size if n < known else complex(np.nan, np.nan)


@njit(**INLINE_OPTIONS)
def _write_rotations(
    rotation: Real,
    unit: Complex,
    turned: Mask,
    reference: Real,
    angles: Real,
    known: int,
    length: int,
    design: int,
    at: int,
) -> None:
    """Write angles of the links, rotation plus reference angle; NaN from the derivative ``known`` on."""
    for link in range(1, len(rotation)):
        if not turned[link]:
            rotation[link, 0] = math.atan2(unit[link, 0].imag, unit[link, 0].real)
        angles[link, 0, design, at] = rotation[link, 0] + reference[link] if known else np.nan
        for n in range(1, length):
            angles[link, n, design, at] = rotation[link, n] if n < known else np.nan


@njit(**INLINE_OPTIONS)
def _write_travels(
    x: Complex,
    unit: Complex,
    shift: Complex,
    slides: Integers,
    line: Complex,
    along: Real,
    size: float,
    travels: Real,
    known: int,
    length: int,
    design: int,
    at: int,
) -> None:
    """Write positions of the slides' joints along their lines; NaN from the derivative ``known`` on."""
    for slide in range(len(slides)):
        joint, link = slides[slide, 0], slides[slide, 1]
        for n in range(length):
            travels[slide, n, design, at] = np.nan
            if n < known:
                travel = _compute_travel(x, unit, shift, joint, link, line[slide], along[slide], n)
                travels[slide, n, design, at] = size * travel


@njit(**OPTIONS)
def _magnitude(z: complex) -> float:
    """Return |z| for numbers near one, without protection from overflow."""
    return math.sqrt(z.real * z.real + z.imag * z.imag)


@njit(**OPTIONS)
def _compute_binomial(n: int, k: int) -> float:
    """Return the binomial coefficient n over k for n up to 3."""
    if k == 0 or k == n:
        return 1.0
    return float(n)


@njit(**OPTIONS)
def _compute_travel(
    x: Complex, unit: Complex, shift: Complex, joint: int, link: int, line: complex, angle: float, n: int
) -> float:
    """Return derivative n of a joint's position along a line fixed in a link."""
    direction = complex(math.cos(angle), math.sin(angle))
    total = 0.0
    for j in range(n + 1):
        offset = x[joint, n - j] - (unit[link, n - j] * line + shift[link, n - j])
        total += _compute_binomial(n, j) * ((unit[link, j] * direction).conjugate() * offset).real
    return total


@njit(**OPTIONS)
def _place_link(
    link: int,
    pin: int,
    place: Complex,
    gives: Integers,
    rotation: Real,
    turned: Mask,
    unit: Complex,
    shift: Complex,
    x: Complex,
    length: int,
) -> None:
    """Place a link by its rotation (or e^{iφ} and rates) and its known pin: fill its shift and the joints that it
    determines."""
    if turned[link]:
        unit[link, 0] = complex(math.cos(rotation[link, 0]), math.sin(rotation[link, 0]))
    u = unit[link, 0]
    if length > 1:
        w = rotation[link, 1]
        unit[link, 1] = 1j * w * u
        if length > 2:
            alpha = rotation[link, 2]
            unit[link, 2] = complex(-w * w, alpha) * u
            if length > 3:
                unit[link, 3] = complex(-3.0 * w * alpha, rotation[link, 3] - w * w * w) * u
    for n in range(length):
        shift[link, n] = x[pin, n] - unit[link, n] * place[pin]
    for j in range(1, gives[link, 0] + 1):
        _place_joint(link, gives[link, j], place, unit, shift, x, length)


@njit(**OPTIONS)
def _place_joint(link: int, joint: int, place: Complex, unit: Complex, shift: Complex, x: Complex, length: int) -> None:
    """Place a joint on a link."""
    for n in range(length):
        x[joint, n] = unit[link, n] * place[joint] + shift[link, n]


@njit(**OPTIONS)
def _orient_link(
    link: int, pin: int, joint: int, arm: complex, rotation: Real, unit: Complex, x: Complex, length: int
) -> None:
    """Compute e^{iφ} of a link on two known joints, and the rates of φ, from the line between the joints."""
    line = x[joint, 0] - x[pin, 0]
    turned = line * arm.conjugate()
    unit[link, 0] = turned / _magnitude(turned)
    if length > 1:
        inverse = line.conjugate() / (line.real * line.real + line.imag * line.imag)
        first = (x[joint, 1] - x[pin, 1]) * inverse
        rotation[link, 1] = first.imag
        if length > 2:
            second = (x[joint, 2] - x[pin, 2]) * inverse
            rotation[link, 2] = (second - first * first).imag
            if length > 3:
                third = (x[joint, 3] - x[pin, 3]) * inverse
                rotation[link, 3] = (third - 3.0 * first * second + 2.0 * first * first * first).imag


@njit(**OPTIONS)
def _close_loop(
    k: Complex,
    r: Real,
    reach: float,
    norm: float,
    slack: float,
    sign: int,
    rotation: Real,
    unit: Complex,
    link: int,
    margins: Real,
    closing: int,
    design: int,
    at: int,
    length: int,
) -> float:
    """Solve a closure for e^{iφ}, rates of φ, margin and its rate; return the sine that vanishes at its limit.

    r is a difference of squares; ``slack`` is their size if that exceeds |k|, since r carries their rounding.
    """
    square = k[0].real * k[0].real + k[0].imag * k[0].imag
    size = math.sqrt(square)
    # |k|² − r², factored against cancellation near a limit.
    excess = (size - r[0]) * (size + r[0])
    exists = size > COINCIDENCE_TOLERANCE * reach and excess >= -LIMIT_TOLERANCE * size * max(size, slack)
    margins[closing, 0, design, at] = excess / norm
    if length > 1:
        margins[closing, 1, design, at] = 2.0 * ((k[0].conjugate() * k[1]).real - r[0] * r[1]) / norm
    if not exists:
        unit[link, 0] = complex(np.nan, np.nan)
        for n in range(1, length):
            rotation[link, n] = np.nan
        return np.nan
    root, along = math.sqrt(max(excess, 0.0)), min(max(r[0], -size), size)
    # Re(e^{−iφ} k) = r and Im(e^{−iφ} k) = sign · root
    u = k[0] * complex(along, -sign * root) / square
    unit[link, 0] = u
    if length > 1:
        e = u.conjugate()
        # NaN at a toggle, or where the closure is undetermined.
        scale = 1.0 / (sign * root) if root > TOGGLE_SINE * size and size > TOGGLE_SINE * reach else np.nan
        w = (r[1] - (e * k[1]).real) * scale
        rotation[link, 1] = w
        if length > 2:
            alpha = (r[2] - (e * (k[2] - 2j * w * k[1] - w * w * k[0])).real) * scale
            rotation[link, 2] = alpha
            if length > 3:
                third = k[3] - 3j * w * k[2] - 3.0 * complex(w * w, alpha) * k[1]
                third += complex(-3.0 * w * alpha, w * w * w) * k[0]
                rotation[link, 3] = (r[3] - (e * third).real) * scale
    return float(sign * root / size)
