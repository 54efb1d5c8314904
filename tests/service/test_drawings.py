"""Drawings wait for each other, and nobody else waits for them."""

import asyncio
import copy
import json
import threading
from types import SimpleNamespace

import pytest
from starlette.concurrency import run_in_threadpool

from service import drawings
from service.api import designs
from service.api.errors import Refusal
from service.drawings import MAX_AT_ONCE, Busy, Drawings
from synthesis.registry import example

MANY = 60
"""More than the threads that the server has for everything."""


def test_who_does_not_draw_does_not_wait_for_who_does():
    release, lock = threading.Event(), threading.Lock()
    drawing, most = 0, 0

    def draw():
        nonlocal drawing, most
        with lock:
            drawing += 1
            most = max(most, drawing)
        release.wait(30)
        with lock:
            drawing -= 1
        return "drawn"

    async def ask():
        board = Drawings()
        under_way = [asyncio.ensure_future(board.call(draw)) for _ in range(MANY)]
        async with asyncio.timeout(20):
            while drawing < MAX_AT_ONCE:
                await asyncio.sleep(0.01)  # threads begin when they do
            assert await run_in_threadpool(lambda: "read") == "read"
        release.set()
        return await asyncio.gather(*under_way)

    assert asyncio.run(ask()) == ["drawn"] * MANY
    assert most == MAX_AT_ONCE


def test_nobody_waits_for_ever_and_a_turn_comes_back(monkeypatch):
    monkeypatch.setattr(drawings, "MAX_WAIT_S", 0.1)
    release = threading.Event()

    async def ask():
        board = Drawings()
        under_way = [asyncio.ensure_future(board.call(release.wait, 30)) for _ in range(MAX_AT_ONCE)]
        await asyncio.sleep(0)  # they take their turns
        with pytest.raises(Busy):
            await board.call(divmod, 7, 2)
        release.set()
        await asyncio.gather(*under_way)
        with pytest.raises(ZeroDivisionError):
            await board.call(divmod, 7, 0)
        return await board.call(divmod, 7, 2)

    assert asyncio.run(ask()) == (3, 1)


def test_a_drawing_that_finds_no_turn_is_refused():
    async def never(*_args):
        raise Busy

    with pytest.raises(Refusal) as refused:
        asyncio.run(designs.drawn(SimpleNamespace(call=never), divmod, 7, 2))
    assert (refused.value.status, refused.value.type) == (503, "/problems/busy")


LINKAGES = ("motion", "dwell", "straight_line", "quick_return", "steering", "parallel_motion")
FILES = [(kind, form) for kind in LINKAGES for form in ("svg", "gif") if (kind, form) != ("motion", "svg")]
"""The sheet of a fourbar is drawn from its dimensions alone."""


@pytest.mark.parametrize(("kind", "form"), FILES)
def test_a_design_beyond_what_can_be_stated_is_not_drawn_but_said_to_be_so(server, kind, form):
    found = server.post(problem=example(kind), wait=30)
    assert found["status"] == "succeeded"
    result = copy.deepcopy(found["result"])
    joints = result["designs"][0]["mechanism"]["skeleton"]["joints"]
    joints[next(iter(joints))] = [2e9, 0.0]
    row = SimpleNamespace(kind=kind, label=None, problem=json.dumps(found["problem"]))
    with pytest.raises(Refusal) as refused:
        designs._file(row, json.dumps(result), "0", form)
    assert (refused.value.status, refused.value.type) == (409, "/problems/no-drawing")
