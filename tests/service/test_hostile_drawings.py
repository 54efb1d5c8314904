"""Drawings that are made to cost the service time or memory, or are spoilt at random."""

import random

import pytest

from tests.campaign import further
from tests.service.drawn_files import dxf, page, read, refused
from tests.support.service.hostile_drawings import HOSTILE, everything, mutated
from tests.support.service.outlines import SHAPES


@pytest.mark.slow
@pytest.mark.parametrize("what", further(HOSTILE, list(HOSTILE)[::3]))
def test_hostile_drawings_are_refused_soon(client, what):
    make, status = HOSTILE[what]
    content = make()
    query = {"tolerance": 1e-9} if what == "a fine tolerance" else {}
    told = refused(client, content, status, **query)
    assert len(str(told)) < 20_000
    assert client.get("/healthz").status_code == 200


@pytest.mark.slow
def test_mutated_drawings_are_read_or_refused(client):
    svg = page("".join(SHAPES) + '<circle r="4"/>', width="9mm", viewBox="0 0 9 9")
    r12, r2018 = dxf(everything, dxfversion="R12"), dxf(everything, dxfversion="R2018")
    seen = set()
    for seed in range(300):
        rng = random.Random(seed)
        answer = read(client, mutated(rng.choice([svg, r12, r12, r2018]), rng))
        assert answer.status_code in (200, 400, 415, 422), (seed, answer.text)
        seen.add(answer.status_code)
    assert {200, 400} <= seen
