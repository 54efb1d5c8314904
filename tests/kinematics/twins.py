"""The compiled sweeps written plainly in NumPy: what the kernels must agree with."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Real
from kinematics.linkage.fourbar import Fourbar, can_assemble, grashof_class
from kinematics.linkage.fourbar.circuit_kernels import CHANGE_POINT_TOLERANCE, TOGGLE_TOLERANCE
from kinematics.linkage.kernels import TOGGLE_SINE, TOGGLE_SLACK
from kinematics.linkage.slider_crank.closed_form import SliderCrank

Orders = list[dict[str, np.ndarray]]
"""Position and three derivatives, each with the fields of the result that it is the twin of."""


def fourbar(linkage: Fourbar, theta: ArrayLike, sign: ArrayLike, w2: float, a2: float, j2: float) -> Orders:
    """Circles met on the axis A → O4; the loop's derivatives solved as 2×2 systems by cross products."""
    b, c, sigma = linkage.coupler[..., None], linkage.output[..., None], np.asarray(sign)[..., None]
    crank = linkage.input[..., None] * np.exp(1j * np.asarray(theta))
    pin_a = linkage.input_pivot[..., None] + crank
    diagonal = (linkage.output_pivot - linkage.input_pivot)[..., None] - crank
    f = np.abs(diagonal)
    product = (b + c + f) * (b + c - f) * (f + (b - c)) * (f - (b - c))
    valid = (product >= -4.0 * TOGGLE_SLACK * f * f * b * c) & (f > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (f * f + (b - c) * (b + c)) / (2.0 * f)
        height = np.sqrt(np.where(valid, np.maximum(product, 0.0), np.nan)) / (2.0 * f)
        pin_b = pin_a + diagonal / f * (along + 1j * sigma * height)
        coupler, output = pin_b - pin_a, pin_b - linkage.output_pivot[..., None]
        determinant = cross(output, coupler)
        sound = valid & (np.abs(determinant) > TOGGLE_SINE * b * c)
        scale = np.where(sound, 1.0 / determinant, np.nan)

        def rates(right: Complex) -> tuple[Real, Real]:
            """Solve i·coupler·x3 − i·output·x4 = right for real x3, x4."""
            return cross(output, -1j * right) * scale, cross(coupler, -1j * right) * scale

        w3, w4 = rates(-1j * w2 * crank)
        a3, a4 = rates(-(1j * a2 - w2**2) * crank + w3**2 * coupler - w4**2 * output)
        j3, j4 = rates(-third(w2, a2, j2) * crank - third(w3, a3, 0.0) * coupler + third(w4, a4, 0.0) * output)
        arm = linkage.coupler_point[..., None] * coupler / b
    angles = {"coupler_angle": np.angle(coupler), "output_angle": np.angle(output)}
    position = {"valid": valid, "a": pin_a, "b": pin_b, "p": pin_a + arm, **angles}
    link = zip((w3, a3, j3), (w4, a4, j4), strict=True)
    named = [{"coupler": x, "output": y} for x, y in link]
    return [position, *carried(sound, crank, coupler, arm, (w2, a2, j2), (w3, a3, j3), named)]


def slider_crank(linkage: SliderCrank, theta: ArrayLike, sign: ArrayLike, w2: float, a2: float, j2: float) -> Orders:
    """The coupler from the crank pin to the slide; derivatives across the slide vanish, those along it are B's."""
    a, b, sigma = linkage.crank[..., None], linkage.coupler[..., None], np.asarray(sign)[..., None]
    slide = np.exp(1j * linkage.slide_angle)[..., None]
    crank = a * np.exp(1j * np.asarray(theta))
    pin_a = linkage.pivot[..., None] + crank
    to_a = np.conj(slide) * (pin_a - linkage.slide_point[..., None])
    across, offset = -to_a.imag, linkage.offset[..., None]
    square = (b - across) * (b + across)
    valid = square >= -2.0 * TOGGLE_SLACK * b * np.maximum(np.maximum(a, b), np.abs(offset))
    with np.errstate(divide="ignore", invalid="ignore"):
        local = sigma * np.sqrt(np.where(valid, np.maximum(square, 0.0), np.nan)) + 1j * across
        coupler, turned = slide * local, np.conj(slide) * crank
        sound = valid & (np.abs(local.real) > TOGGLE_SINE * b)
        scale = np.where(sound, 1.0 / local.real, np.nan)
        w3 = -(1j * w2 * turned).imag * scale
        a3 = -((1j * a2 - w2**2) * turned - w3**2 * local).imag * scale
        j3 = -(third(w2, a2, j2) * turned + third(w3, a3, 0.0) * local).imag * scale
        arm = linkage.coupler_point[..., None] * coupler / b
        travel = {"coupler_angle": np.angle(coupler), "travel": (to_a + local).real}
    position = {"valid": valid, "a": pin_a, "b": pin_a + coupler, "p": pin_a + arm, **travel}
    rest = carried(sound, crank, coupler, arm, (w2, a2, j2), (w3, a3, j3), [{"coupler": x} for x in (w3, a3, j3)])
    for order in rest:
        order["travel"] = (np.conj(slide) * order["b"]).real
    return [position, *rest]


def carried(sound, crank, coupler, arm, rates2, rates3, named):
    """Derivatives of A, B and P from those of crank and coupler angle."""
    (w2, a2, j2), (w3, a3, j3) = rates2, rates3
    factors = [(1j * w2, 1j * w3), (1j * a2 - w2**2, 1j * a3 - w3**2), (third(w2, a2, j2), third(w3, a3, j3))]
    return [
        {"valid": sound, "a": f * crank, "b": f * crank + g * coupler, "p": f * crank + g * arm, **names}
        for (f, g), names in zip(factors, named, strict=True)
    ]


def cross(u: Complex, v: Complex) -> Real:
    return u.real * v.imag - u.imag * v.real


def third(w: ArrayLike, alpha: ArrayLike, jerk: ArrayLike) -> Complex:
    """Factor of e^{iθ} in its third time derivative: i(θ''' − θ'³) − 3 θ' θ''."""
    w, alpha, jerk = np.asarray(w), np.asarray(alpha), np.asarray(jerk)
    return np.asarray(1j * (jerk - w**3) - 3.0 * w * alpha)


TURN = 2.0 * np.pi


def input_limits(linkage: Fourbar) -> tuple[Real, ...]:
    """Lower and upper limit of |δ|, and whether they are toggles."""
    a, b, c, d = linkage.input, linkage.coupler, linkage.output, linkage.ground
    slack, sound = CHANGE_POINT_TOLERANCE * (a + b + c + d), can_assemble(linkage)
    found = []
    for t, end in ((np.abs(b - c), 0.0), (b + c, np.pi)):
        below, above = t - np.abs(d - a), (d + a) - t
        numerator = np.where(below > slack, below, 0.0) * (t + np.abs(d - a))
        denominator = np.where(above > slack, above, 0.0) * ((d + a) + t)
        met = (below >= -slack) & (above >= -slack)
        angle = np.where(met, 2.0 * np.arctan2(np.sqrt(numerator), np.sqrt(denominator)), end)
        found.append((np.where(sound, angle, np.nan), met & sound))
    (lower, folded), (upper, extended) = found
    return lower, upper, folded, extended


def stays_on_branch(linkage: Fourbar, start: Real, end: Real) -> Real:
    """No toggle of any turn between the ends, and the middle within the limits."""
    lower, upper, folded, extended = input_limits(linkage)
    low, high = np.minimum(start, end) - linkage.ground_angle, np.maximum(start, end) - linkage.ground_angle
    free = can_assemble(linkage)
    for toggle, exists in ((lower, folded), (upper, extended)):
        for sign in (1.0, -1.0):
            turns = np.ceil((low - TOGGLE_TOLERANCE - sign * toggle) / TURN)
            free = free & ~(exists & (sign * toggle + turns * TURN <= high + TOGGLE_TOLERANCE))
    middle = np.abs(np.angle(np.exp(0.5j * (low + high))))
    return np.asarray(free & (lower <= middle) & (middle <= upper))


def same_circuit(linkage: Fourbar, angle: Real, assembly: Real, other_angle: Real, other_assembly: Real) -> Real:
    """By the number of toggles: of none the assembly tells the circuit, of both the side of the ground line."""
    _, _, folded, extended = input_limits(linkage)

    def side(theta: Real) -> Real:
        return np.asarray(np.sign(np.sin(theta - linkage.ground_angle)))

    crank, two_sided = ~folded & ~extended, folded & extended
    on_one = np.where(crank, assembly == other_assembly, ~two_sided | (side(angle) == side(other_angle)))
    return np.asarray(can_assemble(linkage) & ((grashof_class(linkage.lengths) == 3) | on_one))


def transmission_extremes(linkage: Fourbar, start: Real, end: Real) -> tuple[Real, Real]:
    """From the shortest and the longest diagonal of the range."""
    a, b, c, d = linkage.input, linkage.coupler, linkage.output, linkage.ground
    low, high = np.minimum(start, end) - linkage.ground_angle, np.maximum(start, end) - linkage.ground_angle
    ends = np.abs(d - a * np.exp(1j * np.array([low, high])))

    def passes(angle: float) -> Real:
        return np.asarray(np.floor((high - angle) / TURN) >= np.ceil((low - angle) / TURN))

    def included(f: Real) -> Real:
        numerator, denominator = (f + (b - c)) * (f - (b - c)), (b + c + f) * (b + c - f)
        return np.asarray(2.0 * np.arctan2(np.sqrt(np.maximum(numerator, 0.0)), np.sqrt(np.maximum(denominator, 0.0))))

    one = included(np.where(passes(0.0), np.abs(d - a), ends.min(axis=0)))
    two = included(np.where(passes(np.pi), d + a, ends.max(axis=0)))
    acute = np.minimum([one, two], [np.pi - one, np.pi - two])
    return acute.min(axis=0), np.where((one <= np.pi / 2) & (two >= np.pi / 2), np.pi / 2, acute.max(axis=0))


def barker_type(linkage: Fourbar) -> Real:
    """Barker's table by sorting the lengths."""
    lengths = linkage.lengths
    equal, kind = CHANGE_POINT_TOLERANCE * lengths.sum(axis=-1), grashof_class(lengths)
    ordered = np.sort(lengths, axis=-1)
    pairs = (ordered[..., 1] - ordered[..., 0] <= equal) & (ordered[..., 3] - ordered[..., 2] <= equal)
    special = np.where(pairs, 13, 9 + lengths.argmin(axis=-1))
    special = np.where(ordered[..., 3] - ordered[..., 0] <= equal, 14, special)
    found = np.where(kind == 1, 1 + lengths.argmin(axis=-1), np.where(kind == 2, 5 + lengths.argmax(axis=-1), special))
    return np.where(can_assemble(linkage), found, 0)
