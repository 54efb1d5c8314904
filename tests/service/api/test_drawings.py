"""Designs that cannot be drawn are said to be so, and a drawing whose turn does not come is refused."""

import asyncio
import copy
import json
from types import SimpleNamespace

import pytest

from service.answers.designs import draw_design
from service.answers.job_result import SolvedJob
from service.api.http.computation import draw_in_turn
from service.api.http.problem_details import Refusal
from service.jobs.processes.request_pool import Busy, GivenUp
from synthesis.registry import get_first_example
from tests.support.service.request_pool import never


@pytest.mark.parametrize(
    ("raised", "status", "type_"),
    [(Busy(), 503, "/problems/busy"), (GivenUp("time"), 409, "/problems/no-drawing")],
)
def test_a_drawing_without_a_turn_or_beyond_its_limits_is_refused(raised, status, type_):
    async def fail(*_args):
        raise raised

    request = SimpleNamespace(is_disconnected=never)
    with pytest.raises(Refusal) as refused:
        asyncio.run(draw_in_turn(request, SimpleNamespace(draw=fail), "acme", divmod, 7, 2))
    assert (refused.value.status, refused.value.type) == (status, type_)


LINKAGES = ("motion", "dwell", "straight_line", "quick_return", "steering", "parallel_motion")
FILES = [(kind, form) for kind in LINKAGES for form in ("svg", "gif") if (kind, form) != ("motion", "svg")]
"""The sheet of a fourbar is drawn from its dimensions alone."""


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "form"), FILES)
def test_a_design_beyond_what_can_be_stated_is_not_drawn_but_said_to_be_so(server, kind, form):
    found = server.post(problem=get_first_example(kind), wait=30)
    assert found["status"] == "succeeded"
    result = copy.deepcopy(found["result"])
    joints = result["designs"][0]["mechanism"]["skeleton"]["joints"]
    joints[next(iter(joints))] = [2e9, 0.0]
    job = SolvedJob("01", kind, None, "", None, json.dumps(found["problem"]), json.dumps(result))
    with pytest.raises(Refusal) as refused:
        draw_design(job, "0", form)
    assert (refused.value.status, refused.value.type) == (409, "/problems/no-drawing")
