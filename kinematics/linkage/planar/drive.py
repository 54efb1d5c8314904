"""Driving a mechanism: positions, velocities, accelerations and jerks of every link and joint, closure by closure.

This module arranges inputs and assemblies in rows for the compiled sweep (:mod:`drive_kernels`), and names its results.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Integers, Mask, Real
from kinematics.linkage.fourbar.closed_form import broadcast_shape, require
from kinematics.linkage.planar import drive_kernels as kernels
from kinematics.linkage.planar.closures import CACHE_SIZE, decompose
from kinematics.linkage.planar.mechanism import Mechanism, TopologyError
from kinematics.linkage.planar.program import Frame, Program, build_program, compute_unit_frame, find_assembly_signs
from kinematics.linkage.planar.settling import settle
from kinematics.linkage.planar.triad_transmission import compute_triad_sines, find_triad
from kinematics.linkage.planar.triads import MIN_CERTIFIED_STEP, Loops, Track, build_loop_equations, compute_rates

MAX_CLOSURES = 6
"""Number of closures of a mechanism with redundant constraints up to which all assemblies are tried."""


@dataclass(frozen=True)
class MechanismMotion:
    """Motion of a mechanism over designs × inputs; the first axis of a jet is value, velocity, acceleration, jerk.

    Attributes
    ----------
    valid : bool, shape S + (N,)
        Where the mechanism can be assembled; elsewhere positions are NaN.
    smooth : bool, shape S + (N,)
        Where derivatives exist too: valid and not at a toggle.
    input : float, shape (n,) + S + (N,)
        The input: angle of the input link, radians, or position along the slide.
    angles : dict of str to float, shape (n,) + S + (N,)
        Link angles in radians, and their rates in rad/s^n. Angles are the reference angle plus the rotation.
    joints : dict of str to complex, shape (n,) + S + (N,)
        Joints in the mechanism's own coordinates and their derivatives per s^n.
    slides : dict of str to float, shape (n,) + S + (N,)
        Position of each slide's joint along its line, and its rates relative to the line's link; by the names of
        :attr:`Mechanism.slide_names`.
    sines : dict of str to float, shape S + (N,)
        For each closure, by the name of its link: the sine that vanishes at its limit. Its magnitude is the sine of the
        transmission angle there; its sign changes from assembly to assembly. For a class III mechanism with a triad,
        by each leg of the triad (:mod:`triad_transmission`).
    margins : dict of str to float, shape (2,) + S + (N,), or (1,) + S + (N,) without derivatives
        For each closure: a smooth function that is positive where it exists, zero at its limit and negative beyond, and
        its rate; NaN where the closures before it do not exist. Where two links or a link and a slide close, it is the
        square of the sine; where a known joint slides in the link, |q − p|² − r² in unit coordinates, with q − p from
        the link's pin to that joint and r the line's distance from the pin.

    With redundant constraints there are neither sines nor margins: it is not determined which link closes a loop.
    """

    valid: Mask
    smooth: Mask
    input: Real
    angles: dict[str, Real]
    joints: dict[str, Complex]
    slides: dict[str, Real]
    sines: dict[str, Real]
    margins: dict[str, Real]


def drive(
    mechanism: Mechanism,
    input: ArrayLike,
    *,
    speed: ArrayLike = 1.0,
    acceleration: ArrayLike = 0.0,
    jerk: ArrayLike = 0.0,
    signs: tuple[Integers, ...] | None = None,
    order: int = 3,
) -> MechanismMotion:
    """Drive a mechanism to inputs: by its dyadic closures, or by continuation from the reference if it has none.

    Parameters
    ----------
    mechanism : Mechanism
        Designs of shape S.
    input : float
        Absolute input angles, radians, or positions along the input slide, broadcasting with S + (1,). Full turns
        matter for gears, so angles are not reduced.
    speed, acceleration, jerk : float
        Rates of the input, broadcasting with the inputs; with the defaults results are derivatives by the input.
    signs : tuple of int arrays, optional
        Assembly at each dyadic closure; by default those of the reference configuration.
    order : int
        Highest derivative computed, 0 to 3; jets have the length ``order + 1``.

    Returns
    -------
    MechanismMotion
        Arrays of shape S + (N,).

    Raises
    ------
    TopologyError
        For a class III mechanism with slides, gears or redundant constraints.
    DimensionError
        For an infinite input, signs other than +1 and −1 or not one for each closure, an order that is not 0 to 3, a
        link without length between the joints by which it closes, or a class III mechanism whose reference is at a
        toggle: two branches meet there, and a class III mechanism has no signs that could select one.
    ShapeError
        For inputs that do not broadcast.

    Examples
    --------
    The fourbar of Norton, Table P4-1, row a, from the catalogue:

    >>> from kinematics.linkage import Fourbar, catalogue
    >>> fourbar = catalogue.make_fourbar(Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0), input_angle=0.5)
    >>> float(np.degrees(drive(fourbar, np.radians([30.0])).angles["output"][0, 0]).round(1))
    117.3
    """
    require("order", "kinematics-derivative-order", np.asarray(order), np.bool_(order in (0, 1, 2, 3)))
    program = build_program(mechanism)
    chosen = program.signs
    if signs is not None:
        chosen, count = signs, len(program.steps)
        require(
            "signs", "kinematics-count-of-arrays", np.asarray(len(signs)), np.bool_(len(signs) == count), count=count
        )
        for sign in signs:
            require("signs", "kinematics-sign", np.asarray(sign), np.abs(sign) == 1)
    q = np.asarray(input, np.float64)
    require("input", "kinematics-finite", q, ~np.isinf(q))
    given = (q, *(np.asarray(rate, np.float64) for rate in (speed, acceleration, jerk)[:order]))
    shape = broadcast_shape(
        designs=(*mechanism.shape, 1),
        signs=(*broadcast_shape(**{f"sign {n}": np.shape(sign) for n, sign in enumerate(chosen)}), 1),
        **{f"input rate {n}" if n else "input": rate.shape for n, rate in enumerate(given)},
    )
    inputs = np.empty((order + 1, *shape))
    for n, values in enumerate(given):
        inputs[n, ...] = values
    designs = shape[:-1]
    rows = np.ones((len(program.code.rows), *designs), np.int64)
    for n, sign in enumerate(chosen):
        rows[n, ...] = sign
    # Index of the mechanism behind each broadcast design.
    own = np.broadcast_to(np.arange(len(program.code.frame)).reshape(mechanism.shape), designs).ravel()
    if mechanism.redundant:
        return _drive_redundant(mechanism, program, inputs, own, rows.reshape(len(rows), len(own)))
    return _run_sweep(mechanism, program, inputs, own, rows.reshape(len(rows), len(own)))


def drive_one(mechanism: Mechanism, input: Real, signs: Integers, order: int) -> MechanismMotion:
    """Drive one design at inputs (D, N) on assemblies (steps, D), without checks; used by root finding."""
    program = build_program(mechanism)
    inputs = np.zeros((order + 1, *input.shape))
    inputs[0], inputs[1:2] = input, 1.0
    return _run_sweep(mechanism, program, inputs, np.zeros(len(input), np.int64), signs)


def compute_margins(mechanism: Mechanism, input: Real, signs: Integers) -> Real:
    """Compute margins of one design's closures and rates at inputs (N,), assemblies (steps, N); (closures, 2, N)."""
    program, count = build_program(mechanism), len(input)
    moved = np.ones((count, 2, 1))
    moved[:, 0, 0] = input - program.reference_input[0]
    sines, margins = np.empty((len(program.closing), count, 1)), np.empty((len(program.closing), 2, count, 1))
    own = np.zeros(count, np.int64)
    # Without points the kernel skips everything but margins and sines.
    none, no_points = np.empty((0, 0, 0, 0)), np.empty((0, 0, 0, 0), np.complex128)
    results = kernels.Sweep(no_points, none, none, sines, margins, np.empty((2, 0, 0), np.bool_))
    kernels.drive(*program.code, own, signs, moved, none, *results)
    return margins[..., 0]


def _run_sweep(mechanism: Mechanism, program: Program, inputs: Real, own: Integers, signs: Integers) -> MechanismMotion:
    """Run the compiled sweep, and name its results."""
    length, *shape = inputs.shape
    flat = len(own), shape[-1]
    moved = inputs.reshape(length, *flat).swapaxes(0, 1).copy()
    # The kernel works with rotations from the reference.
    moved[:, 0] -= program.reference_input[own, None]
    given = _follow_class_iii(mechanism, program, own, moved) if program.class_iii else np.empty((0, 0, 0, 0))
    points = np.empty((len(mechanism.joints), length, *flat), np.complex128)
    angles = np.empty((len(program.links), length, *flat))
    travels = np.empty((len(mechanism.slides), length, *flat))
    sines = np.empty((len(program.closing), *flat))
    margins = np.empty((len(program.closing), min(length, 2), *flat))
    masks = np.empty((2, *flat), np.bool_)
    results = kernels.Sweep(points, angles, travels, sines, margins, masks)
    kernels.drive(*program.code, own, signs, moved, given, *results)
    valid, smooth = masks.reshape(2, *shape)
    joints = dict(zip(mechanism.joints, points.reshape(-1, length, *shape), strict=True))
    closing = dict(zip(program.closing, sines.reshape(-1, *shape), strict=True))
    triad = find_triad(mechanism) if program.class_iii else None
    if triad is not None:
        closing.update(compute_triad_sines(triad, {name: jet[0] for name, jet in joints.items()}))
    return MechanismMotion(
        valid,
        smooth,
        inputs,
        dict(zip(program.links[1:], angles[1:].reshape(-1, length, *shape), strict=True)),
        joints,
        dict(zip(mechanism.slide_names, travels.reshape(-1, length, *shape), strict=True)),
        closing,
        dict(zip(program.closing, margins.reshape(-1, margins.shape[1], *shape), strict=True)),
    )


def _drive_redundant(
    mechanism: Mechanism, program: Program, inputs: Real, own: Integers, signs: Integers
) -> MechanismMotion:
    """Drive a mechanism with redundant constraints: dyads give approximate positions, all constraints exact ones."""
    if program.class_iii:
        raise TopologyError("kinematics-redundant-needs-dyads")

    def drive_assembly(chosen: Integers) -> tuple[dict[str, Complex], dict[str, Real]]:
        motion = _run_sweep(mechanism, program, inputs[:1], own, chosen)
        return motion.joints, motion.angles

    assemblies = [signs]
    closing = [row for row, step in enumerate(program.steps) if step.has_two_solutions]
    if len(closing) <= MAX_CLOSURES:
        for turned in list(product((1, -1), repeat=len(closing)))[1:]:
            other = signs.copy()
            # Flip the chosen closures, for all designs at once.
            other[closing] *= np.array(turned).reshape(-1, 1)
            assemblies.append(other)
    found = settle(mechanism, own, inputs, map(drive_assembly, assemblies), program.reference_input)
    return MechanismMotion(found.valid, found.smooth, inputs, found.angles, found.joints, found.slides, {}, {})


def _follow_class_iii(mechanism: Mechanism, program: Program, own: Integers, moved: Real) -> Real:
    """Follow the rotations of all links of a class III mechanism, design by design; shape (links, D, n, N)."""
    designs, length, count = moved.shape
    given = np.full((len(program.links), designs, length, count), np.nan)
    for design in range(designs):
        loops, track = _build_track(mechanism, int(own[design]))
        numbers = [program.links.index(link) for link in loops.links]
        rotation = moved[design, 0]
        angles = track.find_rotations(rotation)
        given[numbers, design, 0] = angles
        if length > 1:
            given[numbers, design, 1:] = np.moveaxis(compute_rates(loops, rotation, angles, moved[design, 1:]), 0, 1)
    return given


def is_reachable(mechanism: Mechanism, inputs: Real) -> Mask:
    """Return whether a class III design reaches inputs, shape (N,), from the reference without a toggle.

    A branch of more than a turn contains some inputs twice, and :func:`drive` may return either position. Here each
    input counts with its own number of full turns.
    """
    at = float(mechanism.reference_input)
    there: Mask = np.isfinite(_build_track(mechanism, 0)[1].follow(inputs - at)[0])
    return there


def has_given_up(mechanism: Mechanism) -> bool:
    """Return whether continuation of this class III design was abandoned before its end in any drive up to now.

    Links of very different lengths can need too many certified steps. Positions beyond the last step are reported as
    not valid although they may exist.
    """
    return bool(decompose(mechanism).left) and _build_track(mechanism, 0)[1].has_given_up


@lru_cache(maxsize=CACHE_SIZE)
def _build_track(mechanism: Mechanism, design: int) -> tuple[Loops, Track]:
    """Build the loops of one design of a class III mechanism, and the cached track of their solutions."""
    joints = build_program(mechanism).code.joints[design]
    loops = build_loop_equations(mechanism, dict(zip(mechanism.joints, joints.tolist(), strict=True)))
    track = Track(loops)
    # A zero step means a toggle or more than one freedom; the rank distinguishes both.
    if track.first_step < MIN_CERTIFIED_STEP:
        constraints = mechanism.constraints(np.array([design]))
        free = int(constraints.mobility(constraints.reference)[0])
        if free != 1:
            raise TopologyError("kinematics-mobility-by-rank", mobility=free)
    at = build_program(mechanism).reference_input[design : design + 1]
    certified = np.bool_(track.first_step >= MIN_CERTIFIED_STEP)
    require("kinematics-reference-input", "kinematics-away-from-toggle", at, certified)
    return loops, track


__all__ = [
    "Frame",
    "MechanismMotion",
    "compute_unit_frame",
    "decompose",
    "drive",
    "find_assembly_signs",
    "has_given_up",
]
