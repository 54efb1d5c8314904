"""Verify slider-cranks, geared fivebars and sixbars that guide a point: drive and measure them.

They are driven through their closures. The analysis core finds the branches by root finding. On the reference's branch
the input is searched at which P comes nearest to each point, in order, within one cycle: a turn of the crank, or as
many as its gears need.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from kinematics.errors import MechanismError
from kinematics.linkage.planar.branches import cycle_on
from kinematics.linkage.planar.limits import branches, holding_reference
from kinematics.linkage.planar.mechanism import GROUND
from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.passages import ordered_run
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification import AtPoints, Way, path_design
from synthesis.model.linkage_answer import GearedFivebarMechanism, SixbarMechanism, SliderCrankMechanism
from synthesis.proof.closer import GRID, least_angles
from synthesis.proof.measures import barker_within, fixed_pivots, link_lengths, measured, reach_of
from synthesis.proof.on_branch import OnBranch
from synthesis.proof.rebuilt import rebuilt
from synthesis.proof.space import BODY_POINT

TracedMechanism = SliderCrankMechanism | GearedFivebarMechanism | SixbarMechanism
"""Mechanisms that are driven through their closures."""


def verify_traced(problem: PathProblem, design: TracedMechanism) -> PathDesign | None:
    """Drive a slider-crank, geared fivebar or sixbar past a problem's points and measure it.

    Parameters
    ----------
    problem : PathProblem
        The problem.
    design : SliderCrankMechanism, GearedFivebarMechanism or SixbarMechanism
        Only the dimensions are used, not the skeleton, except for a sixbar, which has no other dimensions.

    Returns
    -------
    PathDesign or None
        None if the mechanism cannot be driven.
    """
    mechanism = rebuilt(design)
    if mechanism is None:
        return None
    try:
        # The branch on which the reference position lies is the one that the input can drive.
        here = holding_reference(mechanism, branches(mechanism))
    except MechanismError:
        return None
    if here is None:
        return None
    driven = OnBranch(mechanism, here)
    place = partial(driven.joint, "P")
    points = np.array([point.point for point in problem.points])
    # An input that turns through may begin anywhere in its cycle.
    period = cycle_on(mechanism, here) if here.full else None
    inputs = ordered_run(place, points, *driven.range, period)
    motion = driven.at(inputs)
    if not motion.valid.all():
        return None
    joints = {name: jet[0] for name, jet in motion.joints.items()}
    misses = np.abs(joints["P"] - points)
    whole = here.full and problem.closed
    used = float(inputs.min()), float(inputs.max())
    if whole:
        used = float(inputs[0]), float(inputs[0]) + cycle_on(mechanism, here)
    steps = np.diff(inputs)
    measures = measured(
        link_lengths(design),
        reach_of(mechanism),
        problem.task_size,
        least_angles(driven.at, np.linspace(*used, GRID)),
        np.concatenate(list(joints.values())),
        barker=barker_within(mechanism) if isinstance(design, SixbarMechanism) else None,
        same_branch=True,
        visits_in_order=bool(np.all(steps >= 0.0) or np.all(steps <= 0.0)) and bool(np.ptp(inputs) > 0.0),
        full_rotation=here.full,
        used=used,
    )
    # P may lie anywhere and is no pivot.
    still = {*mechanism.links[GROUND], BODY_POINT}
    moving = [complex(places[0]) for name, places in joints.items() if name not in still]
    at_points = AtPoints(np.degrees(inputs), misses, True, fixed_pivots(mechanism), moving)
    return path_design(problem, design, measures, at_points, [], Way(place, used))
