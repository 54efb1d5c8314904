"""Verification of function generators: the linkage is driven over its range, and its output read off the dials.

From the dimensions and the dials alone: the input link is put where its dial has each value, and the output's place is
compared with what its dial should show. At the pairs and precision points both assemblies are looked at, so that a
branch defect is seen as one; over the range the linkage stays in the assembly of its first target, and the structural
error is measured at two thousand places, with its extremes looked for more and more closely.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import simpson

from kinematics.errors import DimensionError
from synthesis.kinds.function.design import (
    Dials,
    ErrorCurve,
    ErrorExtreme,
    FunctionDesign,
    FunctionMechanism,
    FunctionMetrics,
    FunctionTarget,
    InputDial,
    OutputDial,
    StructuralError,
)
from synthesis.kinds.function.drives import Drive, Driven, drive_of
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.linkage_answer import FourbarMechanism
from synthesis.model.linkages import driven_fourbar
from synthesis.proof.checks import REACHES_TARGETS, TARGET_REACHED, reaches_targets, tolerated
from synthesis.proof.closer import least_near
from synthesis.proof.constraints import constraint_checks
from synthesis.proof.measures import link_lengths, measured

Real = NDArray[np.float64]
DRIVEN = 2001
"""Places of the range at which the structural error is measured at first."""

SHOWN = 201
"""Places of the error curve that are returned."""

SHOWN_TARGETS = 9
"""Places, ends included, at which an approximation is listed as targets."""

LEVEL = 1e-3
"""Extremes within this share of the greatest error have reached it."""

CLEARLY_NEARER = 1e-3
"""Share of the own assembly's error at a target below which the opposite assembly is the one that was meant there."""

DIAL_KEPT = 1e-9
"""Deviation of a dial from what was stated, radians or shares of the range: what rounding leaves."""


class _Wanted(NamedTuple):
    """What the dials ask for: input angles (radians) and places of the output (radians or lengths)."""

    values: Real
    outputs: Real
    angles: Real
    places: Real


def verify_function(problem: FunctionProblem, mechanism: FunctionMechanism, dials: Dials) -> FunctionDesign | None:
    """Drive a linkage through a problem's range and measure its structural error.

    Parameters
    ----------
    problem : FunctionProblem
        What was asked.
    mechanism : FunctionMechanism
        Its dimensions; of a sixbar these are its skeleton.
    dials : Dials
        How the values are read off the links.

    Returns
    -------
    FunctionDesign or None
        None where the dimensions make no linkage, or it cannot be assembled at a target or somewhere in the range.
    """
    try:
        drive = drive_of(mechanism)
    except DimensionError:
        return None
    targets = _wanted(problem, dials, _target_values(problem), drive)
    met, assemblies = _met(drive, targets)
    if not np.all(np.isfinite(met.place)):
        return None
    own = bool(np.all(assemblies == drive.assembly))
    errors = _off(met.place, targets.places, drive.turns)
    structural = _structural_error(problem, dials, drive, targets, errors)
    if structural is None:
        return None
    error, whole = structural
    unit = _unit(problem)
    residuals = np.abs(errors) / (unit if problem.slides else 1.0)
    start, end = _range(problem, dials, targets)
    same_branch = own and drive.on_branch(start, end)
    on_circuit = same_branch or drive.one_circuit(targets.angles, assemblies)
    least = drive.least_transmissions(start, end) if same_branch else dict.fromkeys(drive.dyads, 0.0)
    steps = np.diff(targets.angles)
    in_order = on_circuit and bool(np.all(steps > 0.0) or np.all(steps < 0.0))
    joints = np.concatenate([met.moving.ravel(), drive.pivots])
    lengths = link_lengths(mechanism)
    measures = measured(
        lengths,
        max(lengths),
        unit if problem.slides else math.inf,  # angles have no size
        least,
        joints,
        barker=drive.barker,
        same_branch=same_branch,
        visits_in_order=in_order,
        full_rotation=drive.full,
        used=(start, end) if same_branch else None,
    )
    degrees = 1.0 if problem.slides else 180.0 / math.pi
    metrics = FunctionMetrics(
        input_rotation=math.degrees(end - start),
        rms_residual=math.sqrt(float(np.mean(residuals**2))),
        **measures.within(FunctionMetrics),
        max_structural_error=error.max,
        rms_structural_error=error.rms,
        output_range=_output_range(problem, dials),
    )
    checks = []
    if problem.aim == "precision":
        checks.append(reaches_targets(float(residuals.max())))
    checks.append(Check(name="same_circuit", passed=on_circuit))
    if problem.function is not None:
        checks.append(Check(name="covers_range", passed=whole and drive.on_branch(start, end)))
    kept = _dials_off(problem, dials, drive)
    checks.append(tolerated("dials", kept, DIAL_KEPT))
    first = [complex(z) for z in met.moving[:, 0]]
    checks += constraint_checks(problem.constraints, measures, drive.pivots, first)
    return FunctionDesign(
        mechanism=mechanism,
        dials=dials,
        targets=[
            FunctionTarget(
                index=k,
                input=float(targets.values[k]),
                output=float(targets.outputs[k]),
                input_angle=math.degrees(targets.angles[k]),
                output_place=float(targets.places[k] + errors[k]) * degrees,
                error=float(errors[k]) * degrees,
                residual=float(residuals[k]),
            )
            for k in range(len(residuals))
        ],
        verification=Verification.of(checks),
        metrics=metrics,
        structural_error=error,
    )


def verify_nearly(
    problem: FunctionProblem, design: FunctionDesign, mechanism: FunctionMechanism
) -> FunctionDesign | None:
    """Drive another linkage by the dials of a design, whose targets it meets as nearly as it can: one on a grid.

    Dials with a stated zero are counted from the ground line, and turn with it.
    """
    dials = design.dials
    if isinstance(mechanism, FourbarMechanism) and isinstance(design.mechanism, FourbarMechanism):
        ground = [driven_fourbar(one).linkage.ground_angle for one in (design.mechanism, mechanism)]
        turned = math.degrees(math.remainder(float(ground[1] - ground[0]), math.tau))
        zeros = problem.stated_zeros
        if zeros[0] is not None:
            dials = dials.model_copy(update={"input": _turned(dials.input, turned)})
        if zeros[1] is not None:
            dials = dials.model_copy(update={"output": _turned(dials.output, turned)})
    driven = verify_function(problem, mechanism, dials)
    if driven is None:
        return None
    checks = [check for check in driven.verification.checks if check.name != REACHES_TARGETS]
    return driven.model_copy(update={"verification": Verification.of(checks)})


Dial = TypeVar("Dial", InputDial, OutputDial)


def _turned(dial: Dial, degrees: float) -> Dial:
    return dial.model_copy(update={"place": dial.place + degrees})


def _target_values(problem: FunctionProblem) -> Real:
    """Values of the input at the targets."""
    if problem.pairs is not None:
        return problem.values[:, 0]
    assert problem.function is not None
    low, high = problem.function.interval
    shares = problem.precision_shares if problem.aim == "precision" else np.linspace(0.0, 1.0, SHOWN_TARGETS)
    return np.asarray(low + (high - low) * shares)


def _wanted(problem: FunctionProblem, dials: Dials, values: Real, drive: Drive) -> _Wanted:
    """What the dials ask for at values of the input: pairs, or x of the function."""
    if problem.pairs is not None:
        outputs = problem.values[:, 1]
    else:
        assert problem.function is not None
        outputs = problem.function.values(values)
    places = _place(dials.output, outputs)
    if math.isfinite(drive.turns):
        places = np.radians(places)
    return _Wanted(values, outputs, np.radians(_place(dials.input, values)), places)


def _place(dial: InputDial | OutputDial, values: Real) -> Real:
    return np.asarray(dial.place + dial.scale * (values - dial.at))


def _off(place: Real, wanted: Real, turn: float) -> Real:
    """Error of a place; angles without full turns."""
    off = place - wanted
    return np.asarray(off - turn * np.round(off / turn) if math.isfinite(turn) else off)


def _met(drive: Drive, targets: _Wanted) -> tuple[Driven, NDArray[np.int64]]:
    """The linkage at the targets, in its own assembly unless the other one is clearly meant; NaN where in none."""
    both = [drive.at(targets.angles, sign) for sign in (drive.assembly, -drive.assembly)]
    off = [np.where(d.valid, np.abs(_off(d.place, targets.places, drive.turns)), np.inf) for d in both]
    opposite = (off[0] > TARGET_REACHED) & (off[1] < CLEARLY_NEARER * off[0])
    # The reference is the first target's configuration: it is met there, or not at all.
    opposite[0] = False
    place, moving = (np.where(opposite, getattr(both[1], part), getattr(both[0], part)) for part in ("place", "moving"))
    return Driven(both[0].valid, place, moving), np.where(opposite, -drive.assembly, drive.assembly)


def _range(problem: FunctionProblem, dials: Dials, targets: _Wanted) -> tuple[float, float]:
    """The input's range, radians: over all of x, or from the first pair to the last."""
    if problem.function is None:
        angles = targets.angles
        onward = angles[-1] >= angles[0]
        return float(angles.min() if onward else angles.max()), float(angles.max() if onward else angles.min())
    start, end = np.radians(_place(dials.input, np.array(problem.function.interval)))
    return float(start), float(end)


def _output_range(problem: FunctionProblem, dials: Dials) -> float:
    """What the output dial turns, or moves, from the first value to the last: of all of x, or of the pairs."""
    if problem.function is None:
        values = problem.values[[0, -1], 1]
    else:
        values = problem.function.values(np.array(problem.function.interval))
    first, last = _place(dials.output, values)
    return float(last - first)


def _structural_error(
    problem: FunctionProblem, dials: Dials, drive: Drive, targets: _Wanted, at_targets: Real
) -> tuple[StructuralError, bool] | None:
    """The error over the range or at the pairs, and whether the linkage goes through all of it; None where nowhere."""
    if problem.function is None:
        curve = _Curve(targets.values, targets.angles, at_targets)
        return _stated(problem, curve, curve, math.sqrt(float(np.mean(at_targets**2)))), True

    def curve_at(x: Real) -> _Curve:
        wanted = _wanted(problem, dials, x, drive)
        driven = drive.at(wanted.angles, drive.assembly)
        return _Curve(x, wanted.angles, np.where(driven.valid, _off(driven.place, wanted.places, drive.turns), np.nan))

    whole = curve_at(np.linspace(*problem.function.interval, DRIVEN))
    known = np.isfinite(whole.errors)
    if not known.any():
        return None
    part = _Curve(*(values[known] for values in whole))
    extremes = curve_at(_extremes(lambda x: curve_at(x).errors, part))
    rms = math.sqrt(_mean(part.errors**2, part.values))
    shown = _Curve(*(values[:: (DRIVEN - 1) // (SHOWN - 1)] for values in whole))
    shown = _Curve(*(values[np.isfinite(shown.errors)] for values in shown))
    return _stated(problem, extremes, shown, rms), bool(known.all())


def _mean(values: Real, places: Real) -> float:
    """The mean over a range, by Simpson's rule; where places of an even grid are left out, by trapezoids."""
    if len(places) < 2:
        return 0.0
    rule = simpson if len(places) == DRIVEN else np.trapezoid
    return float(rule(values, x=places) / np.ptp(places))


class _Curve(NamedTuple):
    """Structural error at places of the range: values of the input, input angles (radians), errors."""

    values: Real
    angles: Real
    errors: Real


def _extremes(errors: Callable[[Real], Real], curve: _Curve) -> Real:
    """Values of the input at the ends of a curve and at its extremes, which are looked for more and more closely."""
    x, e = curve.values, curve.errors
    steps = np.diff(e)
    turns = np.flatnonzero(steps[:-1] * steps[1:] < 0.0) + 1

    def extreme(k: int) -> float:
        upward = 1.0 if e[k] > e[k - 1] else -1.0
        near = slice(k - 1, k + 2)
        return least_near(lambda inputs: -upward * errors(inputs), x[near], -upward * e[near])[0]

    return np.array([x[0], *map(extreme, turns.tolist()), x[-1]])


def _stated(problem: FunctionProblem, extremes: _Curve, curve: _Curve, rms: float) -> StructuralError:
    """The error in degrees or length units."""
    unit = 1.0 if problem.slides else 180.0 / math.pi
    greatest = float(np.abs(extremes.errors).max())
    reached = np.sign(extremes.errors[np.abs(extremes.errors) >= (1.0 - LEVEL) * greatest])
    return StructuralError(
        unit="length" if problem.slides else "degrees",
        max=greatest * unit,
        rms=rms * unit,
        alternations=1 + int(np.count_nonzero(np.diff(reached))),
        extremes=[
            ErrorExtreme(input=float(x), input_angle=math.degrees(angle), error=float(error) * unit)
            for x, angle, error in zip(*extremes, strict=True)
        ],
        curve=ErrorCurve(
            input=curve.values.tolist(),
            input_angle=np.degrees(curve.angles).tolist(),
            error=(curve.errors * unit).tolist(),
        ),
    )


def _unit(problem: FunctionProblem) -> float:
    """The range of the output that is asked for, length units of a slider."""
    if problem.pairs is not None:
        moved = [pair.output for pair in problem.pairs]
        return max(moved) - min(moved)
    return abs(problem.span("output") or 1.0)


def _dials_off(problem: FunctionProblem, dials: Dials, drive: Drive) -> float:
    """How far the dials are from what was stated: radians, and shares of a range."""
    off = [0.0]
    radians = math.pi / 180.0
    sides: tuple[Literal["input", "output"], ...] = ("input", "output")
    for k, side in enumerate(sides):
        dial: InputDial | OutputDial = getattr(dials, side)
        slides = side == "output" and problem.slides
        stated = problem.stated_zeros[k]
        if problem.pairs is not None:
            scale = problem.scale_choice[k]
            low, high = problem.open_scale(k)
            off.append(_outside(dial.scale, (low, high) if scale is None else (scale, scale)))
            begins = dial.scale * getattr(problem.pairs[0], side)
            first = getattr(problem.pairs[0], side)
        else:
            assert problem.function is not None
            least, greatest = problem.function.interval if side == "input" else problem.function.extent()
            first = (
                least
                if side == "input"
                else float(problem.function.values(np.array([problem.function.interval[0]]))[0])
            )
            grows = 1.0 if side == "input" else problem.function.direction
            turned, span = dial.scale * (greatest - least) * grows, problem.span(side)
            if span is None or (side == "output" and problem.either_direction):
                turned = abs(turned)
            limits = problem.range_limits if span is None else (span, span)
            if span is not None and side == "output" and problem.either_direction:
                limits = abs(span), abs(span)
            off.append(_outside(turned, limits))
            begins = problem.first_value(side)
        if stated is None:
            continue
        stands = dial.place + dial.scale * (first - dial.at)
        if slides:
            off.append(abs(stands - stated - begins) / _unit(problem))
        else:
            turn = 180.0 if problem.from_ground else 360.0
            off.append(abs(math.remainder(stands - math.degrees(drive.frame) - stated - begins, turn)) * radians)
    return max(off)


def _outside(value: float, limits: tuple[float, float]) -> float:
    """How far a value lies outside of limits, as a share of them."""
    low, high = limits
    return max(low - value, value - high, 0.0) / max(abs(low), abs(high))
