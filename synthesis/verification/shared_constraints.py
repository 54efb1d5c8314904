"""Check of a finished linkage against its workspace, common to all kinds and done after the kind's own checks."""

from __future__ import annotations

from typing import TypeVar, cast

from synthesis.model.answer import Verification
from synthesis.model.linkage.answer import LinkageMechanism
from synthesis.model.linkage.conversion import compute_body_shift
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import ProblemBase
from synthesis.model.protocols import DrivenDesign, VerifiedDesign
from synthesis.verification.reconstruction import rebuild_mechanism
from synthesis.verification.workspace import BODY_POINT, WORKSPACE_CHECKS, FirstPosition, check_space

Design = TypeVar("Design", bound=VerifiedDesign)


def check_workspace_of_design(problem: ProblemBase, design: Design) -> Design | None:
    """Return a verified design with the checks of its workspace.

    A design that already has these checks is returned unchanged, as is any design if there is no workspace.

    Parameters
    ----------
    problem : ProblemBase
        The problem.
    design : a design
        Design with its mechanism, metrics and verification.

    Returns
    -------
    Design or None
        None if no mechanism can be built from the dimensions of the design.
    """
    if not isinstance(problem, LinkageProblem) or problem.space is None or problem.space.is_empty:
        return design
    # Every design of a linkage problem is a driven linkage.
    verified = cast(DrivenDesign, design)
    # In this case the kind itself has checked the workspace, with knowledge that is not available here.
    if any(check.name in WORKSPACE_CHECKS for check in verified.verification.checks):
        return design
    # The outlines of links and bodies need joints that only the skeleton contains.
    mechanism = rebuild_mechanism(verified.mechanism, from_skeleton=True)
    if mechanism is None:
        return None
    first = None
    if problem.first_pose is not None:
        point, angle = problem.first_pose
        met = complex(mechanism.joints[BODY_POINT])
        carrying = cast(LinkageMechanism, verified.mechanism)
        first = FirstPosition(point, met, compute_body_shift(carrying, angle))
    checks = [*verified.verification.checks, *check_space(problem.space, mechanism, verified.metrics, first)]
    return design.model_copy(update={"verification": Verification.from_checks(checks)})
