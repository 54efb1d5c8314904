"""Conjugate (desmodromic) cams: two cams on one shaft, whose rollers sit on one follower and push it both ways.

The second roller is fixed to the first, on the other side of the cam: on the same slide at a distance D, or on a second
arm at a fixed angle γ from the first. When the first roller is at s, the second is at s₂ = s_max − s with respect to
its own cam:

    D = d + d₂ + s_max        on a slide: its cam has the offset −e and is rotated by half a turn on the shaft
    γ = ψ₀ + ψ₀₂ + s_max      on arms: its cam is that of a follower of the opposite sense with the same pivot

(Norton, *Design of Machinery*, §8.1, §8.7). :mod:`kinematics.cam.follower` defines d and ψ₀.
"""

from __future__ import annotations

from kinematics.arrays import Complex
from kinematics.cam.follower import OscillatingRoller, Roller, TranslatingRoller
from kinematics.cam.motion.program import Program
from kinematics.cam.motion.segments import Segment


def reverse_program(program: Program) -> Program:
    """Return the program of the second roller: s_max − s, which is 0 where the first roller is highest."""
    top = program.peaks[0].greatest
    return Program([Segment(one.name, one.pieces.scale_to(one.angle, -1.0, top)) for one in program.segments])


def compute_span(first: Roller, second: Roller, top: float) -> float:
    """Return D, or γ in radians, from the maximum displacement s_max of the first roller."""
    if isinstance(first, TranslatingRoller) and isinstance(second, TranslatingRoller):
        return first.height + second.height + top
    assert isinstance(first, OscillatingRoller)
    assert isinstance(second, OscillatingRoller)
    return first.start_angle + second.start_angle + top


def transform_between_cams(follower: Roller, points: Complex) -> Complex:
    """Transform points between the frame of the second cam, whose roller lies on +x, and that of the first."""
    # On a slide the second roller is on the opposite side: half a turn, which is its own inverse.
    return -points if isinstance(follower, TranslatingRoller) else points
