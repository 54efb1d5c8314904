"""Verify slider-cranks, geared fivebars, sixbars and eightbars that guide a point: drive and measure them.

They are driven through their closures. The analysis core finds the branches by root finding. On the reference's branch
the input is searched at which P comes nearest to each point, in order, within one cycle: a turn of the crank, or as
many as its gears need.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from kinematics.errors import MechanismError
from kinematics.linkage.planar.branches import compute_cycle_on_branch
from kinematics.linkage.planar.limits import find_branches, find_reference_branch
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.linkage.refined_extremes import GRID_SIZE, find_min_transmission_angles
from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification.fourbar import AtPoints, TracedPath, build_path_design
from synthesis.kinds.path.verification.passages import find_ordered_run
from synthesis.model.linkage.answer import (
    EightbarMechanism,
    GearedFivebarMechanism,
    MultiloopMechanism,
    SixbarMechanism,
    SliderCrankMechanism,
)
from synthesis.verification.branch_drive import MechanismOnBranch
from synthesis.verification.measures import (
    classify_inner_fourbar,
    list_fixed_pivots,
    list_link_lengths,
    measure_linkage,
    measure_reach,
)
from synthesis.verification.reconstruction import rebuild_mechanism
from synthesis.verification.workspace import BODY_POINT

TracedMechanism = SliderCrankMechanism | GearedFivebarMechanism | SixbarMechanism | EightbarMechanism
"""Mechanisms that are driven through their closures."""


def verify_traced(problem: PathProblem, design: TracedMechanism) -> PathDesign | None:
    """Drive a linkage other than a fourbar past a problem's points and measure it.

    Parameters
    ----------
    problem : PathProblem
        The problem.
    design : SliderCrankMechanism, GearedFivebarMechanism, SixbarMechanism or EightbarMechanism
        Only the dimensions are used, not the skeleton, except for sixbars and eightbars, which have no others.

    Returns
    -------
    PathDesign or None
        None if the mechanism cannot be driven.
    """
    mechanism = rebuild_mechanism(design)
    if mechanism is None:
        return None
    try:
        # The branch on which the reference position lies is the one that the input can drive.
        here = find_reference_branch(mechanism, find_branches(mechanism))
    except MechanismError:
        return None
    if here is None:
        return None
    driven = MechanismOnBranch(mechanism, here)
    place = partial(driven.locate_joint, "P")
    points = np.array([point.point for point in problem.points])
    # An input that turns through may begin anywhere in its cycle.
    period = compute_cycle_on_branch(mechanism, here) if here.full else None
    inputs = find_ordered_run(place, points, *driven.range, period)
    motion = driven.evaluate_motion(inputs)
    if not motion.valid.all():
        return None
    joints = {name: jet[0] for name, jet in motion.joints.items()}
    misses = np.abs(joints["P"] - points)
    whole = here.full and problem.closed
    used = float(inputs.min()), float(inputs.max())
    if whole:
        used = float(inputs[0]), float(inputs[0]) + compute_cycle_on_branch(mechanism, here)
    steps = np.diff(inputs)
    measures = measure_linkage(
        list_link_lengths(design),
        measure_reach(mechanism),
        problem.task_size,
        find_min_transmission_angles(driven.evaluate_motion, np.linspace(*used, GRID_SIZE)),
        np.concatenate(list(joints.values())),
        barker=classify_inner_fourbar(mechanism) if isinstance(design, MultiloopMechanism) else None,
        same_branch=True,
        visits_in_order=bool(np.all(steps >= 0.0) or np.all(steps <= 0.0)) and bool(np.ptp(inputs) > 0.0),
        full_rotation=here.full,
        used=used,
    )
    # P is not a pivot, so regions do not apply to it.
    still = {*mechanism.links[GROUND], BODY_POINT}
    moving = [complex(places[0]) for name, places in joints.items() if name not in still]
    at_points = AtPoints(np.degrees(inputs), misses, True, list_fixed_pivots(mechanism), moving)
    return build_path_design(problem, design, measures, at_points, [], TracedPath(place, used))
