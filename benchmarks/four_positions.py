"""Four positions by brute force: what a grid over the link rotations finds, for the search to be compared with.

Nothing of the solver is used. For every rotation β₂ of a link on a grid the compatibility equation of the standard form
(Norton 5.35, for four positions; Sandor & Erdman, *Advanced Mechanism Design*, 3.3)

    Δ₁ + Δ₂ e^{iβ₂} + Δ₃ e^{iβ₃} + Δ₄ e^{iβ₄} = 0

closes like a fourbar, in two ways; two of its three equations then give the link W and the coupler vector Z. All pairs
of the dyads are judged by the compiled kernel, and the best ones are driven by the analysis core.
"""

from __future__ import annotations

import math

import numpy as np

from synthesis.kinds.motion.dyads.equations import Dyads
from synthesis.kinds.motion.exact.screening import make_screening_constraints, screen
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar

GRID_DEGREES = 0.25
TRIED = 50

REACH = 50.0
"""Dyads with longer vectors, in task sizes, are left out: nobody would build them."""


def grid_dyads(task: MotionTask) -> Dyads:
    """Both dyads of every β₂ of the grid, where the compatibility equation closes."""
    spin = task.turns[1:] - 1.0
    shift = task.points[1:] - task.points[0]
    d2 = spin[1] * shift[2] - spin[2] * shift[1]
    d3 = spin[2] * shift[0] - spin[0] * shift[2]
    d4 = spin[0] * shift[1] - spin[1] * shift[0]
    beta2 = np.radians(np.arange(-180.0, 180.0, GRID_DEGREES) + GRID_DEGREES / 2.0)
    known = -(d2 + d3 + d4) + d2 * np.exp(1j * beta2)
    # known + d3 e^{iβ3} + d4 e^{iβ4} = 0: a triangle of sides |known|, |d3|, |d4|.
    cosine = (abs(d4) ** 2 - abs(d3) ** 2 - np.abs(known) ** 2) / (2.0 * abs(d3) * np.abs(known))
    closes = np.abs(cosine) < 1.0
    fixed, moving = [], []
    for sign in (1.0, -1.0):
        at = known[closes]
        e3 = at / np.abs(at) * np.exp(sign * 1j * np.arccos(cosine[closes])) * abs(d3) / d3
        e2 = np.exp(1j * beta2[closes])
        # W (e2 − 1) + Z spin₂ = shift₂,  W (e3 − 1) + Z spin₃ = shift₃
        determinant = (e2 - 1.0) * spin[1] - (e3 - 1.0) * spin[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            w = (shift[0] * spin[1] - shift[1] * spin[0]) / determinant
            z = ((e2 - 1.0) * shift[1] - (e3 - 1.0) * shift[0]) / determinant
        good = np.isfinite(w) & np.isfinite(z) & (np.abs(w) + np.abs(z) < REACH)
        moving.append(task.points[0] - z[good])
        fixed.append(task.points[0] - z[good] - w[good])
    return Dyads(np.concatenate(fixed), np.concatenate(moving))


def brute_force(problem: MotionProblem, least: float) -> float:
    """The greatest verified transmission angle, degrees, of the best pairs that reach ``least``; 0 if none does."""
    task = make_motion_task(problem)
    dyads = grid_dyads(task)
    links = np.abs(task.images(dyads.moving) - dyads.fixed[:, None])
    good = np.ptp(links, axis=1) < 1e-6 * (1.0 + links[:, 0])
    dyads = Dyads(dyads.fixed[good], dyads.moving[good])
    wanted = make_screening_constraints(problem.constraints, task, least, "transmission_angle")
    screening = screen(task, dyads, dyads, wanted)
    best = 0.0
    for k in np.argsort(-screening.score.ravel())[:TRIED]:
        i, j = np.unravel_index(k, screening.score.shape)
        if screening.score[i, j] <= 0.0:
            break
        pivots = [dyads.fixed[i], dyads.moving[i], dyads.moving[j], dyads.fixed[j]]
        o2, a, b, o4 = (task.to_problem(complex(z)) for z in pivots)
        design = verify(problem, build_fourbar(FourbarConfiguration(o2, a, b, o4, task.origin)))
        # The dyads of the grid carry rounding that the demand for 1e-9 may not forgive; the motion is what counts.
        if design is not None and design.metrics.same_branch and design.metrics.visits_in_order:
            best = max(best, design.metrics.min_transmission_angle)
            break
    return best if best >= least * (1.0 - 1e-9) and not math.isnan(best) else 0.0
