"""Every type of given mechanism with every optional block is answered, or refused at a field: nothing escapes."""

import copy

import pytest

from service.answers.analysis import analyse
from service.refusals import Refusal
from synthesis.analyses import get_family
from tests.support.problems.fuzz_bodies import BLOCKS, FOURBAR_AS_SKELETON, analysis_corpus

POSES = [{"x": 1.0, "y": 2.0, "angle": 10.0}, {"x": 2.0, "y": 3.0, "angle": 20.0}]
ACCURACY = {"tolerances": {"length": 0.1}, "quality": {"max_error": 1.0}, "samples": 100}
FURTHER_BLOCKS = (
    {"manufacture": ACCURACY},
    {"targets": POSES, "manufacture": ACCURACY},
    {"targets": POSES, "manufacture": {"tolerances": {"length": 0.1, "pin_clearance": 0.05}, "samples": 100}},
    {"targets": POSES[:1], "manufacture": {"round": {"length": 0.5}}},
)
SHARES = 4
"""Number of shares of the blocks, one for each case."""

BODIES = [*analysis_corpus([]), {"mechanism": FOURBAR_AS_SKELETON}]


CASES = [
    pytest.param(
        body,
        share,
        id=f"{n} {body['mechanism']['type']}, share {share}",
        # The planes of this type take most of a second.
        marks=[pytest.mark.slow] if (body["mechanism"]["type"], share) == ("crank_shaper", 0) else [],
    )
    for n, body in enumerate(BODIES)
    for share in range(SHARES)
]


@pytest.mark.parametrize(("body", "share"), CASES)
def test_every_optional_block_is_answered_or_refused_at_a_field(body, share):
    known = get_family(body["mechanism"]).request.model_fields
    for block in (*BLOCKS, *FURTHER_BLOCKS)[share::SHARES]:
        # The longest motions take the time of all others together.
        if not known.keys() >= block.keys() or block.get("motion", {}).get("steps") == 9_999:
            continue
        refused = refuse({"motion": {"steps": 12}, **copy.deepcopy(body), **copy.deepcopy(block)})
        # A defect is a numerical error that no check has foreseen.
        assert refused is None or (refused.status, refused.defect, bool(refused.errors)) == (422, None, True), block


def refuse(body):
    """The refusal of an analysis; None where it is answered."""
    try:
        assert analyse(body)
    except Refusal as refusal:
        return refusal
    return None
