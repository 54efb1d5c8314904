"""Verify a dwell sixbar: drive the crank through a full turn, and find the output's rests.

A dwell is measured in the interval of the required crank rotation in which the output moves least. Two equal dwells are
searched near the ends of the output's range, dwells with requested places near those places. The times of the dwells
within the turn are free.
"""

from __future__ import annotations

import math
from functools import partial
from itertools import combinations

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.errors import MechanismError
from kinematics.linkage.planar.branches import FULL_TURN, compute_cycle_on_branch
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.limits import find_branches, find_reference_branch
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.linkage.refined_extremes import find_extremes, find_min_transmission_angles, find_minimum_near
from synthesis.kinds.dwell.design import DwellDesign, DwellMechanism, DwellMetrics, PlacedDwell, Rest
from synthesis.kinds.dwell.motion.rests import MeasuredRest, OutputCycle, find_placed_rests, find_rests
from synthesis.kinds.dwell.problem import PLACE_TOLERANCE, DwellProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import OUTPUT
from synthesis.verification.checks import check_error, check_maximum
from synthesis.verification.constraints import check_constraints
from synthesis.verification.measures import (
    Measures,
    classify_inner_fourbar,
    list_fixed_pivots,
    list_joint_distances,
    list_moving_pivots,
    measure_diagonal,
    measure_linkage,
)
from synthesis.verification.reconstruction import rebuild_mechanism

GRID_STEP_COUNT = 2880
"""Number of crank angles of the turn: every eighth of a degree."""

RANGE_TOLERANCE = 1e-6
"""Maximum relative error of swing or stroke."""

CLOSURE_TOLERANCE = 1e-9
"""Maximum distance of a joint from its place after a turn, as a share of the mechanism's size."""

MIN_TOGGLE_SINE = 1e-6
"""Minimum sine of a transmission angle at which the mechanism still moves in a defined direction."""

SLIDER_TYPES = "dwell_slider", "dwell_watt_slider"
"""Types whose output slides."""


def _turns_through(mechanism: Mechanism) -> bool:
    """Return whether the crank turns through and the linkage repeats after one turn."""
    try:
        here = find_reference_branch(mechanism, find_branches(mechanism))
    except MechanismError:
        return False
    return here is not None and here.full and compute_cycle_on_branch(mechanism, here) == FULL_TURN


def verify_dwell(problem: DwellProblem, design: DwellMechanism) -> DwellDesign | None:
    """Drive a sixbar through a turn of its crank and measure the dwells that a problem requests.

    Parameters
    ----------
    problem : DwellProblem
        The problem.
    design : DwellMechanism
        Dimensions.

    Returns
    -------
    DwellDesign or None
        None if the dimensions are no mechanism whose crank turns through.
    """
    mechanism = rebuild_mechanism(design)
    if mechanism is None:
        return None
    if not _turns_through(mechanism):
        return None
    inputs = float(mechanism.reference_input) + np.linspace(0.0, FULL_TURN, GRID_STEP_COUNT + 1)
    motion = drive(mechanism, inputs, order=2)
    if not motion.smooth.all():
        return None
    places = np.concatenate([jet[0] for jet in motion.joints.values()])
    size = measure_diagonal(places)
    slides = design.type in SLIDER_TYPES

    def get_output(motion: MechanismMotion) -> Real:
        return np.asarray(motion.slides["D"][0] if slides else np.degrees(motion.angles["output"][0]))

    values = get_output(motion)
    turned = abs(float(values[-1] - values[0]))
    closed = all(abs(jet[0, -1] - jet[0, 0]) <= CLOSURE_TOLERANCE * size for jet in motion.joints.values())
    low, high = find_extremes(mechanism, inputs, values, get_output)
    way = high - low
    transmission = find_min_transmission_angles(partial(drive, mechanism, order=0), inputs, motion)
    # At a toggle the next position would be a matter of chance.
    if not min(transmission.values()) > MIN_TOGGLE_SINE:
        return None
    # An output that does not return has turned through instead of swinging.
    if turned > 0.5 * way:
        return None

    def evaluate_output(angles: Real) -> Real:
        return get_output(drive(mechanism, angles, order=0))

    turn = OutputCycle(evaluate_output, inputs, values, math.inf if slides else 360.0)
    found = _find_rests(problem, turn, (low, high))
    if not found:
        return None
    rates = [_find_peak(mechanism, inputs, motion, order, slides=slides) for order in (1, 2)]
    crank = abs(complex(mechanism.joints["A"] - mechanism.joints["O2"]))
    task_size = problem.way if slides else 2.0 * crank
    measures = _measure_sixbar(mechanism, task_size, places, transmission, inputs, closed=closed)
    metrics = DwellMetrics(
        way=way,
        jitter=max(rest.jitter for rest in found),
        peak_velocity=rates[0],
        peak_acceleration=rates[1],
        **measures.select_fields(DwellMetrics),
    )
    targets = _list_rests(found)
    checks = _check_design(problem, mechanism, measures, metrics.way, targets, found)
    return DwellDesign(
        mechanism=design,
        targets=targets,
        dwells=_list_placed_dwells(problem, found),
        verification=Verification.from_checks(checks),
        metrics=metrics,
    )


def _measure_sixbar(
    mechanism: Mechanism,
    task_size: float,
    places: Complex,
    transmission: dict[str, float],
    inputs: Real,
    *,
    closed: bool,
) -> Measures:
    """Return the measures of a sixbar over its turn.

    Parameters
    ----------
    task_size : float
        Length by which the design's size is measured.
    places : complex
        Places of all joints over the turn.
    transmission : dict
        Minimum transmission angle of each dyad.
    closed : bool
        Whether all joints return after the turn.
    """
    lengths = list_joint_distances(mechanism)
    return measure_linkage(
        lengths,
        max(lengths),
        task_size,
        transmission,
        places,
        barker=classify_inner_fourbar(mechanism),
        same_branch=closed,
        visits_in_order=closed,  # one direction of the crank has one order
        full_rotation=closed,
        used=(float(inputs[0]), float(inputs[-1])),
    )


def _list_rests(found: list[MeasuredRest]) -> list[Rest]:
    """Return measured rests as reported, angles in degrees."""
    return [
        Rest(
            index=k,
            input_angle=math.degrees(rest.begin),
            level=rest.level,
            jitter=rest.jitter,
            width=math.degrees(rest.width),
            off_end=rest.off_end,
        )
        for k, rest in enumerate(found)
    ]


def _find_rests(problem: DwellProblem, turn: OutputCycle, way: tuple[float, float]) -> list[MeasuredRest]:
    if problem.dwells is None:
        return find_rests(turn, math.radians(problem.dwell_requests[0].angle), problem.count, problem.max_movement, way)
    return find_placed_rests(turn, problem.dwell_requests, problem.max_movement, way)


def _list_placed_dwells(problem: DwellProblem, found: list[MeasuredRest]) -> list[PlacedDwell] | None:
    if problem.dwells is None:
        return None
    pairs = zip(problem.dwell_requests, found, strict=True)
    return [PlacedDwell(angle=wanted.angle, at=rest.share, error=rest.jitter) for wanted, rest in pairs]


def _check_design(
    problem: DwellProblem,
    mechanism: Mechanism,
    measures: Measures,
    way: float,
    targets: list[Rest],
    found: list[MeasuredRest],
) -> list[Check]:
    off = abs(way - problem.way) / problem.way
    checks = [
        Check(name="crank_turns", passed=measures.full_rotation),
        check_error("way", off, RANGE_TOLERANCE),
    ]
    for rest, wanted, resting in zip(targets, problem.dwell_requests, found, strict=True):
        checks.append(check_maximum(f"dwell_{rest.index + 1}", rest.jitter, problem.max_movement, OUTPUT))
        if wanted.place is None:
            # A dwell without a place may lie at either end.
            checks.append(check_maximum(f"dwell_{rest.index + 1}_at_end", rest.off_end, PLACE_TOLERANCE))
        else:
            checks.append(
                check_maximum(f"dwell_{rest.index + 1}_at_place", abs(resting.share - wanted.place), PLACE_TOLERANCE)
            )
    if len(found) > 1:
        checks.append(Check(name="dwells_apart", passed=_is_separated(problem, found)))
    pivots = list_fixed_pivots(mechanism), list_moving_pivots(mechanism)
    return [*checks, *check_constraints(problem.constraints, measures, *pivots)]


def _is_separated(problem: DwellProblem, found: list[MeasuredRest]) -> bool:
    """Return whether no rest begins before another one has ended."""
    timed = [
        (rest.begin, math.radians(wanted.angle)) for rest, wanted in zip(found, problem.dwell_requests, strict=True)
    ]
    for pair in combinations(timed, 2):
        for (begin, wide), (other, _) in (pair, pair[::-1]):
            if (other - begin) % math.tau < wide * (1.0 - RANGE_TOLERANCE):
                return False
    return True


def _find_peak(mechanism: Mechanism, inputs: Real, motion: MechanismMotion, order: int, *, slides: bool) -> float:
    """Return the maximum magnitude of the output's derivative of an order, at the inputs of a grid and between them."""

    def measure_magnitude(motion: MechanismMotion) -> Real:
        return np.asarray(np.abs((motion.slides["D"] if slides else motion.angles["output"])[order]))

    known = -measure_magnitude(motion)
    return -find_minimum_near(lambda closer: -measure_magnitude(drive(mechanism, closer, order=order)), inputs, known)[
        1
    ]
