"""Checks of the workspace on a finished linkage, common to all kinds and made after the kind's own checks."""

from __future__ import annotations

from typing import Any, TypeVar

from synthesis.model.answer import Verification
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.linkages import body_shift
from synthesis.model.statement import StatedProblem
from synthesis.proof.rebuilt import rebuilt
from synthesis.proof.space import BODY_POINT, ROOM, FirstPosition, space_checks

Design = TypeVar("Design")


def judged_by_room(problem: StatedProblem, design: Design) -> Design | None:
    """Return a verified design with the checks of its workspace; unchanged without a workspace or if it has them.

    Parameters
    ----------
    problem : StatedProblem
        The problem.
    design : a design
        Design with its mechanism, metrics and verification.

    Returns
    -------
    The design, or None if no mechanism can be built from its dimensions.
    """
    if not isinstance(problem, LinkageProblem) or problem.space is None or problem.space.empty:
        return design
    verified: Any = design
    if any(check.name in ROOM for check in verified.verification.checks):
        return design
    mechanism = rebuilt(verified.mechanism, from_skeleton=True)
    if mechanism is None:
        return None
    first = None
    if problem.first_pose is not None:
        point, angle = problem.first_pose
        met = complex(mechanism.joints[BODY_POINT])
        first = FirstPosition(point, met, body_shift(verified.mechanism, angle))
    checks = [*verified.verification.checks, *space_checks(problem.space, mechanism, verified.metrics, first)]
    judged: Design = verified.model_copy(update={"verification": Verification.of(checks)})
    return judged
