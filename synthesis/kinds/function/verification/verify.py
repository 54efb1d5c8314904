"""Verification of function generators: drive the linkage over its range and read its output off the dials.

Only the dimensions and the dials are used: the input link is set to each value of its dial, and the output's position
is compared with the value that its dial should show. At the pairs and precision points both assemblies are examined, so
that a branch defect is recognised as such. Over the range the linkage stays in the assembly of its first target, and
the structural error is measured at two thousand inputs; its extremes are refined.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import simpson

from kinematics.arrays import Real
from kinematics.errors import DimensionError
from kinematics.linkage.refined_extremes import find_minimum_near
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
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.verification.drive import Drive, DrivenStates, make_drive
from synthesis.model.answer import Check, Verification
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.conversion import build_driven_fourbar
from synthesis.verification.checks import REACHES_TARGETS, TARGET_TOLERANCE, check_error, check_targets_reached
from synthesis.verification.constraints import check_constraints
from synthesis.verification.measures import list_link_lengths, measure_linkage

DENSE_SAMPLE_COUNT = 2001
"""Number of inputs over the range at which the structural error is measured."""

CURVE_SAMPLE_COUNT = 201
"""Number of returned points of the error curve."""

TARGET_SAMPLE_COUNT = 9
"""Number of inputs, including the ends, listed as targets of an approximation."""

LEVEL_TOLERANCE = 1e-3
"""Relative tolerance for extremes that reach the maximum error."""

OPPOSITE_ERROR_RATIO = 1e-3
"""Ratio of the error at a target in the opposite assembly to that in the linkage's own assembly, below which the
opposite assembly is used."""

DIAL_TOLERANCE = 1e-9
"""Tolerance of a dial relative to its given values, radians or shares of the range; it covers rounding."""


class _DialTargets(NamedTuple):
    """Targets according to the dials: input angles (radians) and positions of the output (radians or length)."""

    values: Real
    outputs: Real
    angles: Real
    places: Real


def _is_monotonic(values: Real) -> bool:
    """Return whether values always rise or always fall."""
    steps = np.diff(values)
    return bool(np.all(steps > 0.0) or np.all(steps < 0.0))


def _check_range(
    problem: FunctionProblem, dials: Dials, drive: Drive, *, on_circuit: bool, covered: bool
) -> list[Check]:
    """Check that the targets lie on one circuit, that the range is covered, and that the dials are as requested."""
    checks = [Check(name="same_circuit", passed=on_circuit)]
    if problem.function is not None:
        # A function must be generated over the whole range, not only at its targets.
        checks.append(Check(name="covers_range", passed=covered))
    return [*checks, check_error("dials", _measure_dial_deviation(problem, dials, drive), DIAL_TOLERANCE)]


def _list_targets(targets: _DialTargets, errors: Real, residuals: Real, unit: float) -> list[FunctionTarget]:
    """Return the targets as reported; ``unit`` converts the output's positions, as 180/π does radians to degrees."""
    return [
        FunctionTarget(
            index=k,
            input=float(targets.values[k]),
            output=float(targets.outputs[k]),
            input_angle=math.degrees(targets.angles[k]),
            output_place=float(targets.places[k] + errors[k]) * unit,
            error=float(errors[k]) * unit,
            residual=float(residuals[k]),
        )
        for k in range(len(residuals))
    ]


def verify_function(problem: FunctionProblem, mechanism: FunctionMechanism, dials: Dials) -> FunctionDesign | None:
    """Drive a linkage through a problem's range and measure its structural error.

    Parameters
    ----------
    problem : FunctionProblem
        The problem.
    mechanism : FunctionMechanism
        The dimensions; for a sixbar these are its skeleton.
    dials : Dials
        Relation between the values and the positions of the links.

    Returns
    -------
    FunctionDesign or None
        None if the dimensions make no linkage, or if it cannot be assembled at a target or in the whole range.
    """
    try:
        drive = make_drive(mechanism)
    except DimensionError:
        return None
    targets = _make_dial_targets(problem, dials, _list_target_values(problem), drive)
    met, assemblies = _drive_to_targets(drive, targets)
    if not np.all(np.isfinite(met.place)):
        return None
    # All targets in the reference's own assembly.
    own = bool(np.all(assemblies == drive.assembly))
    errors = _compute_error(met.place, targets.places, drive.turns)
    structural = _measure_structural_error(problem, dials, drive, targets, errors)
    if structural is None:
        return None
    error, whole = structural
    unit = _get_output_unit(problem)
    residuals = np.abs(errors) / (unit if problem.slides else 1.0)
    start, end = _find_input_range(problem, dials, targets)
    # The used range is meaningless if targets lie in different assemblies.
    same_branch = own and drive.is_on_branch(start, end)
    on_circuit = same_branch or drive.is_one_circuit(targets.angles, assemblies)
    # A motion through a toggle transmits nothing there.
    least = drive.compute_min_transmissions(start, end) if same_branch else dict.fromkeys(drive.dyads, 0.0)
    in_order = on_circuit and _is_monotonic(targets.angles)
    joints = np.concatenate([met.moving.ravel(), drive.pivots])
    measures = measure_linkage(
        list_link_lengths(mechanism),
        max(list_link_lengths(mechanism)),
        unit if problem.slides else math.inf,  # with angular outputs the size of the linkage is free
        least,
        joints,
        barker=drive.barker,
        same_branch=same_branch,
        visits_in_order=in_order,
        full_rotation=drive.full,
        used=(start, end) if same_branch else None,
    )
    metrics = FunctionMetrics(
        input_rotation=math.degrees(end - start),
        rms_residual=math.sqrt(float(np.mean(residuals**2))),
        **measures.select_fields(FunctionMetrics),
        max_structural_error=error.max,
        rms_structural_error=error.rms,
        output_range=_compute_output_range(problem, dials),
    )
    checks = [check_targets_reached(float(residuals.max()))] if problem.aim == "precision" else []
    checks += _check_range(
        problem, dials, drive, on_circuit=on_circuit, covered=whole and drive.is_on_branch(start, end)
    )
    first = [complex(z) for z in met.moving[:, 0]]
    checks += check_constraints(problem.constraints, measures, drive.pivots, first)
    return FunctionDesign(
        mechanism=mechanism,
        dials=dials,
        targets=_list_targets(targets, errors, residuals, 1.0 if problem.slides else 180.0 / math.pi),
        verification=Verification.from_checks(checks),
        metrics=metrics,
        structural_error=error,
    )


def verify_with_tolerance(
    problem: FunctionProblem, design: FunctionDesign, mechanism: FunctionMechanism
) -> FunctionDesign | None:
    """Verify a linkage with dimensions rounded to a grid, by the dials of the exact design.

    Targets need not be met exactly. Dials with a given zero are measured from the ground line and turn with it.
    """
    dials = design.dials
    if isinstance(mechanism, FourbarMechanism) and isinstance(design.mechanism, FourbarMechanism):
        ground = [build_driven_fourbar(one).linkage.ground_angle for one in (design.mechanism, mechanism)]
        turned = math.degrees(math.remainder(float(ground[1] - ground[0]), math.tau))
        zeros = problem.zero_choice
        if zeros[0] is not None:
            dials = dials.model_copy(update={"input": _rotate_dial(dials.input, turned)})
        if zeros[1] is not None:
            dials = dials.model_copy(update={"output": _rotate_dial(dials.output, turned)})
    driven = verify_function(problem, mechanism, dials)
    if driven is None:
        return None
    # Rounded dimensions meet no target exactly; quality limits apply instead.
    checks = [check for check in driven.verification.checks if check.name != REACHES_TARGETS]
    return driven.model_copy(update={"verification": Verification.from_checks(checks)})


Dial = TypeVar("Dial", InputDial, OutputDial)


def _rotate_dial(dial: Dial, degrees: float) -> Dial:
    return dial.model_copy(update={"place": dial.place + degrees})


def _list_target_values(problem: FunctionProblem) -> Real:
    """Return the values of the input at the targets."""
    if problem.pairs is not None:
        return problem.values[:, 0]
    assert problem.function is not None
    low, high = problem.function.interval
    shares = problem.precision_shares if problem.aim == "precision" else np.linspace(0.0, 1.0, TARGET_SAMPLE_COUNT)
    return np.asarray(low + (high - low) * shares)


def _make_dial_targets(problem: FunctionProblem, dials: Dials, values: Real, drive: Drive) -> _DialTargets:
    """Return the targets of the dials at values of the input: those of the pairs, or x of the function."""
    if problem.pairs is not None:
        outputs = problem.values[:, 1]
    else:
        assert problem.function is not None
        outputs = problem.function.values(values)
    places = _compute_place(dials.output, outputs)
    if math.isfinite(drive.turns):
        places = np.radians(places)
    return _DialTargets(values, outputs, np.radians(_compute_place(dials.input, values)), places)


def _compute_place(dial: InputDial | OutputDial, values: Real) -> Real:
    return np.asarray(dial.place + dial.scale * (values - dial.at))


def _compute_error(place: Real, wanted: Real, turn: float) -> Real:
    """Return the error of a position; angles modulo full turns."""
    off = place - wanted
    return np.asarray(off - turn * np.round(off / turn) if math.isfinite(turn) else off)


def _drive_to_targets(drive: Drive, targets: _DialTargets) -> tuple[DrivenStates, NDArray[np.int64]]:
    """Drive the linkage to its targets; errors are NaN where it closes in neither assembly.

    The linkage stays in its own assembly at a target unless the other one is clearly closer.
    """
    both = [drive.compute_positions(targets.angles, sign) for sign in (drive.assembly, -drive.assembly)]
    off = [np.where(d.valid, np.abs(_compute_error(d.place, targets.places, drive.turns)), np.inf) for d in both]
    opposite = (off[0] > TARGET_TOLERANCE) & (off[1] < OPPOSITE_ERROR_RATIO * off[0])
    # The reference is the first target's configuration, so the first target must be met in its assembly.
    opposite[0] = False
    place, moving = (np.where(opposite, getattr(both[1], part), getattr(both[0], part)) for part in ("place", "moving"))
    return DrivenStates(both[0].valid, place, moving), np.where(opposite, -drive.assembly, drive.assembly)


def _find_input_range(problem: FunctionProblem, dials: Dials, targets: _DialTargets) -> tuple[float, float]:
    """Return the input's range, radians: over the whole interval of x, or from the first pair to the last."""
    if problem.function is None:
        angles = targets.angles
        onward = angles[-1] >= angles[0]
        return float(angles.min() if onward else angles.max()), float(angles.max() if onward else angles.min())
    start, end = np.radians(_compute_place(dials.input, np.array(problem.function.interval)))
    return float(start), float(end)


def _compute_output_range(problem: FunctionProblem, dials: Dials) -> float:
    """Return the motion of the output dial from the first value to the last, of the interval of x or of the pairs."""
    if problem.function is None:
        values = problem.values[[0, -1], 1]
    else:
        values = problem.function.values(np.array(problem.function.interval))
    first, last = _compute_place(dials.output, values)
    return float(last - first)


def _measure_structural_error(
    problem: FunctionProblem, dials: Dials, drive: Drive, targets: _DialTargets, at_targets: Real
) -> tuple[StructuralError, bool] | None:
    """Measure the error over the range or at the pairs, and whether the linkage covers it; None if not assembled."""
    if problem.function is None:
        curve = _Curve(targets.values, targets.angles, at_targets)
        return _report_error(problem, curve, curve, math.sqrt(float(np.mean(at_targets**2)))), True

    def evaluate_curve(x: Real) -> _Curve:
        wanted = _make_dial_targets(problem, dials, x, drive)
        driven = drive.compute_positions(wanted.angles, drive.assembly)
        return _Curve(
            x, wanted.angles, np.where(driven.valid, _compute_error(driven.place, wanted.places, drive.turns), np.nan)
        )

    whole = evaluate_curve(np.linspace(*problem.function.interval, DENSE_SAMPLE_COUNT))
    known = np.isfinite(whole.errors)
    if not known.any():
        return None
    part = _Curve(*(values[known] for values in whole))
    extremes = evaluate_curve(_find_extremes(lambda x: evaluate_curve(x).errors, part))
    rms = math.sqrt(_average_over_range(part.errors**2, part.values))
    shown = _Curve(*(values[:: (DENSE_SAMPLE_COUNT - 1) // (CURVE_SAMPLE_COUNT - 1)] for values in whole))
    shown = _Curve(*(values[np.isfinite(shown.errors)] for values in shown))
    return _report_error(problem, extremes, shown, rms), bool(known.all())


def _average_over_range(values: Real, places: Real) -> float:
    """Return the mean over a range, by Simpson's rule, or by the trapezoidal rule if points of the grid are missing."""
    if len(places) < 2:
        return 0.0
    rule = simpson if len(places) == DENSE_SAMPLE_COUNT else np.trapezoid
    return float(rule(values, x=places) / np.ptp(places))


class _Curve(NamedTuple):
    """Structural error over the range: values of the input, input angles (radians), errors."""

    values: Real
    angles: Real
    errors: Real


def _find_extremes(errors: Callable[[Real], Real], curve: _Curve) -> Real:
    """Return the values of the input at the ends of a curve and at its refined extremes."""
    x, e = curve.values, curve.errors
    steps = np.diff(e)
    turns = np.flatnonzero(steps[:-1] * steps[1:] < 0.0) + 1

    def refine_extreme(k: int) -> float:
        upward = 1.0 if e[k] > e[k - 1] else -1.0
        near = slice(k - 1, k + 2)
        return find_minimum_near(lambda inputs: -upward * errors(inputs), x[near], -upward * e[near])[0]

    return np.array([x[0], *map(refine_extreme, turns.tolist()), x[-1]])


def _report_error(problem: FunctionProblem, extremes: _Curve, curve: _Curve, rms: float) -> StructuralError:
    """Convert the error to degrees or length units, and count its alternations."""
    unit = 1.0 if problem.slides else 180.0 / math.pi
    greatest = float(np.abs(extremes.errors).max())
    reached = np.sign(extremes.errors[np.abs(extremes.errors) >= (1.0 - LEVEL_TOLERANCE) * greatest])
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


def _get_output_unit(problem: FunctionProblem) -> float:
    """Return the required range of the output, length units for a slider."""
    if problem.pairs is not None:
        moved = [pair.output for pair in problem.pairs]
        return max(moved) - min(moved)
    return abs(problem.span("output") or 1.0)


def _measure_dial_deviation(problem: FunctionProblem, dials: Dials, drive: Drive) -> float:
    """Return the largest deviation of the dials from their given values: radians, and shares of a range."""
    off = [0.0]
    radians = math.pi / 180.0
    sides: tuple[Literal["input", "output"], ...] = ("input", "output")
    for k, side in enumerate(sides):
        dial: InputDial | OutputDial = getattr(dials, side)
        slides = side == "output" and problem.slides
        stated = problem.zero_choice[k]
        if problem.pairs is not None:
            scale = problem.scale_choice[k]
            low, high = problem.open_scale(k)
            off.append(_measure_outside(dial.scale, (low, high) if scale is None else (scale, scale)))
            begins = dial.scale * getattr(problem.pairs[0], side)
            first = getattr(problem.pairs[0], side)
        else:
            assert problem.function is not None
            least, greatest = problem.function.interval if side == "input" else problem.function.find_extent()
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
            off.append(_measure_outside(turned, limits))
            begins = problem.first_value(side)
        if stated is None:
            continue
        stands = dial.place + dial.scale * (first - dial.at)
        if slides:
            off.append(abs(stands - stated - begins) / _get_output_unit(problem))
        else:
            # With "auto" zeros an angle may be that of the link's extension, hence modulo half a turn.
            turn = 180.0 if problem.from_ground else 360.0
            off.append(abs(math.remainder(stands - math.degrees(drive.frame) - stated - begins, turn)) * radians)
    return max(off)


def _measure_outside(value: float, limits: tuple[float, float]) -> float:
    """Return the distance of a value from its limits, as a share of these; 0 inside."""
    low, high = limits
    return max(low - value, value - high, 0.0) / max(abs(low), abs(high))
