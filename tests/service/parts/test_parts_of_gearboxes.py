"""Parts of gearboxes of sliding gears through HTTP, speed by speed: what is in mesh, and how fast the output turns."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from service.parts.assembly.interference import find_overlaps
from service.parts.assembly.sizes import PartsQuery
from service.parts.gears.motion import TrainMotion
from service.parts.registry import make_parts
from synthesis.dispatch import solve
from synthesis.registry import list_examples, parse_problem
from tests.support.service.answers import finished
from tests.support.service.parts import bill, parts, refused
from tests.support.service.parts_of_gearboxes import BOX
from tests.support.service.parts_of_gears import PAIR


@pytest.fixture(scope="module")
def box(server: Any) -> tuple[str, dict[str, Any]]:
    """The place of a gearbox of one stage, and the design."""
    job = finished(server.client, BOX)
    return f"/v1/jobs/{job['id']}/designs/0", job["result"]["designs"][0]


def heights(view: dict[str, Any], name: str) -> tuple[float, float]:
    (part,) = (part for part in view["parts"] if part["name"] == name)
    return part["shapes"][0]["low"], part["shapes"][0]["high"]


@pytest.mark.parametrize("speed", [None, 3])
def test_one_pair_of_a_stage_is_in_mesh_and_the_output_turns_at_that_speed(client: Any, box: Any, speed: Any) -> None:
    place, design = box
    stated = {} if speed is None else {"speed": speed}
    answer = client.get(f"{place}/assembly", params={"positions": 5, **stated})
    assert answer.status_code == 200, answer.text
    view = answer.json()
    found = design["metrics"]["speeds"][(speed or 1) - 1]
    for pair in range(3):
        (low, high), (floor, ceiling) = (heights(view, f"gear_1_{pair + 1}_{role}") for role in ("driver", "driven"))
        if pair == found["engaged"][0]:
            assert (low, high) == pytest.approx((floor, ceiling))
        else:
            assert max(low, floor) > min(high, ceiling) + 1.0
    angles = {carrier["link"]: np.diff(carrier["angles"]) for carrier in view["carriers"]}
    assert angles["shaft_2"] / angles["shaft_1"] == pytest.approx(-found["speed"] / 200.0, rel=1e-9)
    assert any(f"Speed {speed or 1} of 3 is shown, {found['speed']:.6g} rev/min" in note for note in view["notes"])


@pytest.mark.slow
def test_the_same_parts_make_every_speed_and_slide_on_keys_as_long_as_their_way(client: Any, box: Any) -> None:
    place, _ = box
    rows, others = (bill(parts(client, place, speed=speed)) for speed in (1, 2))
    for row in (*rows.values(), *others.values()):
        del row["plane"]
    assert rows == others
    face, length = (float(rows[name]["thickness"]) for name in ("gear_1_1_driver", "key_input_shaft_1_4"))
    pitch = float(rows["hub_1_1"]["thickness"]) + face
    assert length == pytest.approx(3.0 * pitch + face, abs=0.5)
    assert rows["hub_1_1"]["holes"].startswith("bore with keyway")
    assert float(rows["key_input_shaft_5_6"]["thickness"]) == pytest.approx(pitch + face, abs=0.5)


@pytest.mark.parametrize("value", [0, 4, 1.5, "top"])
def test_a_speed_that_is_not_there_is_refused_by_its_path(client: Any, box: Any, value: Any) -> None:
    answer = refused(client, box[0], 422, speed=value)
    assert [fault["path"] for fault in answer["errors"]] == ["/query/speed"]


def test_a_train_has_no_speeds_to_choose_from(client: Any) -> None:
    place = f"/v1/jobs/{finished(client, PAIR)['id']}/designs/0"
    assert [fault["path"] for fault in refused(client, place, 422, speed=1)["errors"]] == ["/query/speed"]


@pytest.mark.slow
@pytest.mark.parametrize("process", ["laser", "mill"])
def test_no_two_parts_meet_in_any_speed(process: Any) -> None:
    problem = parse_problem(list_examples("gearbox")[0])
    design = solve(problem, lambda _fraction, _message: None).designs[0]
    for number in range(1, 7):
        whole = make_parts(design, problem, PartsQuery(process=process, speed=number))
        assert find_overlaps(whole, 72) == []
        assert isinstance(whole.motion, TrainMotion)
        turns = [body.speed for body in whole.motion.bodies.values()]
        assert turns[-1] == pytest.approx(design.metrics.speeds[number - 1].speed / 200.0, rel=1e-9)
