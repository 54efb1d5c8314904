"""Verify a dwell sixbar: drive the crank through a full turn, and find the output's rests.

A dwell is where the output moves least while the crank turns by the required angle; two equal ones are searched near
the ends of the output's range, those with given places near these. The times of dwells within the turn are free.
"""

from __future__ import annotations

import math
from functools import partial
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from kinematics.errors import MechanismError
from kinematics.linkage.planar.branches import FULL_TURN, cycle_on
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.limits import branches, holding_reference
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.kinds.dwell.design import DwellDesign, DwellMechanism, DwellMetrics, PlacedDwell, Rest
from synthesis.kinds.dwell.problem import END, DwellProblem
from synthesis.kinds.dwell.rests import Resting, Turn, placed_rests, rests
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import OUTPUT
from synthesis.proof.checks import at_most, tolerated
from synthesis.proof.closer import extremes_of, least_angles, least_near
from synthesis.proof.constraints import constraint_checks
from synthesis.proof.measures import Measures, barker_within, diagonal, distances, fixed_pivots, measured, moving_pivots
from synthesis.proof.rebuilt import rebuilt

Real = NDArray[np.float64]

GRID = 2880
"""Number of crank angles of the turn: every eighth of a degree."""

WAY_MET = 1e-6
"""Maximum relative error of swing or stroke."""

CLOSED = 1e-9
"""Maximum distance of a joint from its place after a turn, as a share of the mechanism's size."""

NO_TOGGLE = 1e-6
"""Minimum sine of a transmission angle at which the mechanism still moves in a defined direction."""

SLIDERS = "dwell_slider", "dwell_watt_slider"
"""Types whose output slides."""


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
    mechanism = rebuilt(design)
    if mechanism is None:
        return None
    try:
        here = holding_reference(mechanism, branches(mechanism))
    except MechanismError:
        return None
    # The crank must turn through, and the linkage must repeat after one turn.
    if here is None or not here.full or cycle_on(mechanism, here) != FULL_TURN:
        return None
    inputs = float(mechanism.reference_input) + np.linspace(0.0, FULL_TURN, GRID + 1)
    motion = drive(mechanism, inputs, order=2)
    if not motion.smooth.all():
        return None
    places = np.concatenate([jet[0] for jet in motion.joints.values()])
    size = diagonal(places)
    slides = design.type in SLIDERS

    def output(motion: MechanismMotion) -> Real:
        return np.asarray(motion.slides["D"][0] if slides else np.degrees(motion.angles["output"][0]))

    values = output(motion)
    turned = abs(float(values[-1] - values[0]))
    closed = all(abs(jet[0, -1] - jet[0, 0]) <= CLOSED * size for jet in motion.joints.values())
    low, high = extremes_of(mechanism, inputs, values, output)
    way = high - low
    transmission = least_angles(partial(drive, mechanism, order=0), inputs, motion)
    # At a toggle the next position would be a matter of chance.
    if not min(transmission.values()) > NO_TOGGLE:
        return None
    # An output that does not return has turned through instead of swinging.
    if turned > 0.5 * way:
        return None

    def at(angles: Real) -> Real:
        return output(drive(mechanism, angles, order=0))

    turn = Turn(at, inputs, values, math.inf if slides else 360.0)
    found = _rests(problem, turn, (low, high))
    if not found:
        return None
    rates = [_peak(mechanism, inputs, motion, order, slides=slides) for order in (1, 2)]
    lengths = distances(mechanism)
    measures = measured(
        lengths,
        max(lengths),
        problem.way if slides else 2.0 * abs(complex(mechanism.joints["A"] - mechanism.joints["O2"])),
        transmission,
        places,
        barker=barker_within(mechanism),
        same_branch=closed,
        visits_in_order=closed,  # one direction of the crank has one order
        full_rotation=closed,
        used=(float(inputs[0]), float(inputs[-1])),
    )
    metrics = DwellMetrics(
        way=way,
        jitter=max(rest.jitter for rest in found),
        peak_velocity=rates[0],
        peak_acceleration=rates[1],
        **measures.within(DwellMetrics),
    )
    targets = [
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
    checks = _checks(problem, mechanism, measures, metrics.way, targets, found)
    return DwellDesign(
        mechanism=design,
        targets=targets,
        dwells=_placed(problem, found),
        verification=Verification.of(checks),
        metrics=metrics,
    )


def _rests(problem: DwellProblem, turn: Turn, way: tuple[float, float]) -> list[Resting]:
    if problem.dwells is None:
        return rests(turn, math.radians(problem.wanted[0].angle), problem.count, problem.allowed, way)
    return placed_rests(turn, problem.wanted, problem.allowed, way)


def _placed(problem: DwellProblem, found: list[Resting]) -> list[PlacedDwell] | None:
    if problem.dwells is None:
        return None
    pairs = zip(problem.wanted, found, strict=True)
    return [PlacedDwell(angle=wanted.angle, at=rest.share, error=rest.jitter) for wanted, rest in pairs]


def _checks(
    problem: DwellProblem,
    mechanism: Mechanism,
    measures: Measures,
    way: float,
    targets: list[Rest],
    found: list[Resting],
) -> list[Check]:
    off = abs(way - problem.way) / problem.way
    checks = [
        Check(name="crank_turns", passed=measures.full_rotation),
        tolerated("way", off, WAY_MET),
    ]
    for rest, wanted, resting in zip(targets, problem.wanted, found, strict=True):
        checks.append(at_most(f"dwell_{rest.index + 1}", rest.jitter, problem.allowed, OUTPUT))
        if wanted.place is None:
            # A dwell without a place may lie at either end.
            checks.append(at_most(f"dwell_{rest.index + 1}_at_end", rest.off_end, END))
        else:
            checks.append(at_most(f"dwell_{rest.index + 1}_at_place", abs(resting.share - wanted.place), END))
    if len(found) > 1:
        checks.append(Check(name="dwells_apart", passed=_apart(problem, found)))
    pivots = fixed_pivots(mechanism), moving_pivots(mechanism)
    return [*checks, *constraint_checks(problem.constraints, measures, *pivots)]


def _apart(problem: DwellProblem, found: list[Resting]) -> bool:
    """Return whether no rest begins before another one has ended."""
    timed = [(rest.begin, math.radians(wanted.angle)) for rest, wanted in zip(found, problem.wanted, strict=True)]
    for pair in combinations(timed, 2):
        for (begin, wide), (other, _) in (pair, pair[::-1]):
            if (other - begin) % math.tau < wide * (1.0 - WAY_MET):
                return False
    return True


def _peak(mechanism: Mechanism, inputs: Real, motion: MechanismMotion, order: int, *, slides: bool) -> float:
    """Return the maximum magnitude of the output's derivative of an order, at the inputs of a grid and between them."""

    def magnitude(motion: MechanismMotion) -> Real:
        return np.asarray(np.abs((motion.slides["D"] if slides else motion.angles["output"])[order]))

    known = -magnitude(motion)
    return -least_near(lambda closer: -magnitude(drive(mechanism, closer, order=order)), inputs, known)[1]
