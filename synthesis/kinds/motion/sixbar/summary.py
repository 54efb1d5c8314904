"""Summary of a search for sixbars that carry a body."""

from __future__ import annotations

from kinematics.message import compose, join_messages
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.ranking import get_rms_error
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.results.candidate_log import CandidateLog


def describe_sixbars(problem: MotionProblem, log: CandidateLog[LinkageDesign], effort: str) -> str:
    """Describe a search: its effort, the beginning of a sentence, and the best of the designs that passed."""
    if not log.passed:
        return join_messages(
            [
                compose("motion-no-sixbar-feasible", effort=effort),
                log.describe_reasons().strip(),
                compose("motion-unproven"),
            ]
        )
    found = [compose("motion-sixbars-verified", effort=effort, designs=len(log.passed))]
    if problem.is_least_squares:
        share = 100.0 * min(map(get_rms_error, log.passed))
        found.append(compose("motion-best-error", error=f"{share:.3g}"))
    best = max(design.metrics.min_transmission_angle for design in log.passed)
    return join_messages([*found, compose("motion-best-transmission-angle", angle=f"{best:.1f}")])
