"""Drawings that are made to cost the service time or memory, or are spoilt at random."""

import io
import random
import time

import ezdxf
import pytest

from tests.campaign import further
from tests.support.service.drawn_files import dxf, page, read, refused
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


def _nested_blocks(levels: int, repeated: int, *, empty: bool) -> bytes:
    """A drawing of blocks in blocks, each inserted so many times in a row and a column."""
    document = ezdxf.new()
    block = document.blocks.new("B0")
    if not empty:
        block.add_line((0.0, 0.0), (1.0, 1.0))
    grid = {"row_count": repeated, "column_count": repeated, "row_spacing": 1.0, "column_spacing": 1.0}
    for level in range(1, levels):
        document.blocks.new(f"B{level}").add_blockref(f"B{level - 1}", (0.0, 0.0), dxfattribs=grid)
    document.modelspace().add_blockref(f"B{levels - 1}", (0.0, 0.0), dxfattribs=grid)
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


@pytest.mark.parametrize("empty", [False, True])
def test_blocks_in_blocks_are_counted_before_they_are_expanded(client, empty):
    """Ten thousand copies of ten thousand copies: nothing of that is made, not even of a block with nothing in it."""
    began = time.monotonic()
    answer = client.post(
        "/v1/outlines", content=_nested_blocks(4, 100, empty=empty), headers={"Content-Type": "image/vnd.dxf"}
    )
    assert answer.status_code == 422
    assert "counting each insertion of a block" in answer.text
    assert time.monotonic() - began < 30.0  # the reader may have to be started on a busy machine
