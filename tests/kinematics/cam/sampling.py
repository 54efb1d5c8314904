"""Random programs and followers of ordinary proportions, for tests over many cams."""

from __future__ import annotations

import math

import numpy as np

from kinematics.cam.follower import Follower, OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import Segment, build_dwell, build_law_segment
from kinematics.cam.profile import Cam
from tests.oracles.cam_formulas import pressure_angle_extremes, undercut

SMOOTH_LAWS = ("cycloidal", "modified_trapezoid", "modified_sine", "polynomial_345", "polynomial_4567")
FOLLOWERS = ("translating_roller", "offset_roller", "oscillating_roller", "translating_flat", "oscillating_flat")


def random_program(rng: np.random.Generator, lift: float) -> Program:
    """Rises and falls between dwells, all laws smooth, with a lift of a given size."""
    count = int(rng.integers(3, 7))
    shares = rng.uniform(0.5, 1.0, count)
    angles = TURN * shares / shares.sum()
    heights = np.array([0.0, *rng.uniform(0.0, 1.0, count - 1), 0.0])
    rests = rng.uniform(size=count) < 0.3
    for k in range(1, count - 1):
        if rests[k]:
            heights[k + 1] = heights[k]
    heights *= lift / max(heights.max(), 1e-9)
    segments: list[Segment] = []
    for angle, start, end in zip(angles, heights, heights[1:], strict=False):
        law = LAWS[str(rng.choice(SMOOTH_LAWS))]
        segments.append(build_dwell(angle, start) if start == end else build_law_segment(law, angle, start, end))
    return Program(segments)


def sound_cam(rng: np.random.Generator, kind: str) -> Cam:
    """A cam without undercut, large enough for its lift."""
    rotation = "ccw" if rng.uniform() < 0.5 else "cw"
    sense = 1 if rng.uniform() < 0.5 else -1
    for size in (1.5, 2.0, 3.0, 5.0, 8.0, 14.0, 25.0, 50.0, 100.0):
        program = random_program(rng, 0.4 / size if kind.startswith("oscillating") else 1.0)
        follower: Follower
        if kind == "translating_roller":
            follower = TranslatingRoller(size, 0.3)
        elif kind == "offset_roller":
            follower = TranslatingRoller(size, 0.3, offset=float(rng.uniform(-0.4, 0.4)) * size)
        elif kind == "oscillating_roller":
            follower = OscillatingRoller(size, 0.2 * size, 1.4 * size, 1.7 * size, sense)
        elif kind == "translating_flat":
            follower = TranslatingFlat(size)
        else:
            follower = OscillatingFlat(size, 2.5 * size, 0.1 * size, sense)
        if kind == "oscillating_flat" and max(abs(program.peaks[1].least), program.peaks[1].greatest) > 0.8:
            continue
        cam = Cam(program, follower, rotation)
        if not undercut(cam) and pressure_angle_extremes(cam).largest < math.radians(50.0):
            return cam
    raise AssertionError(f"no sound cam of kind {kind} found")
