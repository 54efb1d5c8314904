"""The range of the input that every linkage states: what stands in it, and that the linkage moves through it."""

import math

import numpy as np
import pytest

from kinematics.linkage.planar.drive import drive
from synthesis.dispatch import solve
from synthesis.model.linkage.answer import LinkageResult
from synthesis.registry import KINDS, list_examples, parse_problem
from synthesis.verification.reconstruction import rebuild_mechanism
from tests.campaign import further

LINKAGES = [
    (name, n)
    for name, kind in KINDS.items()
    if issubclass(kind.result, LinkageResult)
    for n in range(len(kind.examples))
]

ROUNDING = 1e-6
"""Degrees, or a share of a length."""


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "n"), further(LINKAGES, [case for case in LINKAGES if case[1] == 0]))
def test_the_linkage_moves_through_its_range_and_meets_its_targets_there(kind, n):
    problem = parse_problem(list_examples(kind)[n])
    designs = [design for design in solve(problem).designs if design.verification.passed]
    for design in designs[:3]:
        mechanism = rebuild_mechanism(design.mechanism, from_skeleton=True)
        slides = mechanism.has_slide_input
        used = design.metrics.used_stroke if slides else design.metrics.used_range
        assert (design.metrics.used_range is None) == slides
        start, end = used if slides else np.radians(used)
        assert start != end
        # A linkage may be verified up to its toggle, where rounding decides.
        inside = np.linspace(start, end, 181)[1:-1]
        assert drive(mechanism, inside, order=0).valid.all()
        low, high = min(used), max(used)
        for target in getattr(design, "targets", []):
            place = target.input_place if slides else target.input_angle
            turns = 0.0 if slides else 360.0 * math.ceil((low - place - ROUNDING) / 360.0)
            assert low - ROUNDING <= place + turns <= high + ROUNDING
