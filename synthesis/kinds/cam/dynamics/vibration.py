"""Vibration of a follower: a mass on the elastic train through which the cam drives it.

The train between cam and mass vibrates; the return spring only adds to its stiffness. The natural frequency is
ω_n = √((k + k_s)/m). If ω_n is less than ten times the cam's speed, the harmonics of the program excite the vibration
markedly. The ratio τ of the natural period to the duration of a move determines the residual vibration in the dwell
after the move (Norton §15.4; Koster, *Vibrations of Cam Mechanisms*, 1974).
"""

from __future__ import annotations

import math

from kinematics.cam.dynamics import RunningCam
from kinematics.cam.motion.program import TURN
from kinematics.cam.motion.segments import Segment
from kinematics.cam.response import FollowerTrain, Response
from kinematics.message import compose
from synthesis.kinds.cam.design import TrainVibration
from synthesis.kinds.cam.follower_loads import get_arm_length
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.statement.segments import Dwell

MIN_FREQUENCY_RATIO = 1.0
"""Ratio of natural frequency to cam speed below which the mass hardly follows the cam, so that its motion is not
reported."""


def compute_train_vibration(problem: CamProblem, running: RunningCam) -> tuple[TrainVibration | None, str | None]:
    """Compute the vibration of the given train under a running cam's load, and a warning; None without a train."""
    dynamics = problem.dynamics
    assert dynamics is not None
    if dynamics.train_stiffness is None:
        return None, None
    load, arm = running.load, get_arm_length(problem)
    stiffness, ratio = dynamics.train_stiffness * arm**2, dynamics.train_damping_ratio
    # The return spring acts in parallel with the train.
    natural = math.sqrt((stiffness + load.spring_rate) / load.mass)
    train = FollowerTrain(load.mass, stiffness, 2.0 * ratio * load.mass * natural, load.spring_rate, load.preload)
    response = Response(running.program, train, running.speed)
    # Without any move, compare the period with the whole turn.
    moves = [segment.angle for segment, rests in _list_segments(problem, running) if not rests]
    # Natural period over the duration of the shortest move.
    tau = TURN / natural * running.speed / min(moves, default=TURN)
    amplitude = least = greatest = None
    # At a resonance the steady state is unbounded.
    steady = response.frequency_ratio >= MIN_FREQUENCY_RATIO and not response.resonant
    if steady:
        force = response.contact_force
        least, greatest = float(force.min()) / arm, float(force.max()) / arm
        # Free vibration is only observable in dwells.
        at_rest = [
            x for x, (_, rests) in zip(response.residual(), _list_segments(problem, running), strict=True) if rests
        ]
        amplitude = float(max(at_rest)) / problem.displacement_unit if at_rest else None
    found = TrainVibration(
        natural_frequency=natural,
        damped_frequency=natural * math.sqrt(1.0 - ratio**2),
        frequency_ratio=response.frequency_ratio,
        period_ratio=tau,
        residual_amplitude=amplitude,
        min_contact_force=least,
        max_contact_force=greatest,
    )
    warning = None
    if response.too_slow:
        warning = compose("cam-train-too-soft", ratio=f"{response.frequency_ratio:.3g}", periods=f"{tau:.3g}")
    if response.frequency_ratio >= MIN_FREQUENCY_RATIO and response.resonant:
        warning = compose("cam-train-resonates")
    return found, warning


def _list_segments(problem: CamProblem, running: RunningCam) -> list[tuple[Segment, bool]]:
    """Return every segment of the program, and whether it is a dwell."""
    rests = [isinstance(stated, Dwell) for stated in problem.segments]
    return list(zip(running.program.segments, rests, strict=True))
