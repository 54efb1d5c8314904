"""Functions: the greatest structural error of sixbars on the classical functions, beside the best fourbar's.

``fourbar`` is the optimum that the literature's tasks are known to have, at any transmission angle and link ratio, and
``at 25°`` the program's own fourbar. Sixbars have at least 25°. ``false`` counts designs that another formulation
(tests/oracles/loops.py) does not confirm: branch, errors, or transmission angles.
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

from synthesis.dispatch import solve
from synthesis.kinds.function.design import FunctionDesign, FunctionResult
from synthesis.registry import parse_problem
from tests.oracles.loops import Loops
from tests.support.sixbars.driven import transmits
from tests.support.synthesis.function_tasks import CASES, measured_function, task_of

TASKS = len(CASES)

TYPES = ["watt_2", "stephenson_2", "stephenson_3"]
LEAST = 25.0

LOGARITHM = {
    "id": "func_log_1_10_60_60",
    "inputs": {"func": "log10", "x0": 1.0, "x1": 10.0, "dphi_deg": 60.0, "dpsi_deg": 60.0},
    "reference": {"value": math.nan},
}


def solved(task: dict[str, Any], **more: Any) -> tuple[FunctionResult, float, float]:
    """The answer, and the seconds that it took: of the processor, and of the wall."""
    problem = parse_problem({"kind": "function", **task, "max_designs": 3, **more})
    wall, processor = time.perf_counter(), time.process_time()
    result = solve(problem)
    return result, time.process_time() - processor, time.perf_counter() - wall


def false_claim(design: FunctionDesign, x: Any, y: Any) -> str:
    """What another formulation does not confirm of a sixbar at some inputs and outputs; empty where it confirms all."""
    skeleton = design.mechanism.skeleton.model_dump(mode="json")
    links = {link["name"]: link["joints"] for link in skeleton["links"]}
    pivot, pin = (complex(*skeleton["joints"][name]) for name in links["output"][:2])
    skeleton["joints"]["P"] = skeleton["joints"][links["output"][1]]
    links["output"].append("P")
    dials = design.dials
    inputs = np.radians(dials.input.place + dials.input.scale * (x - dials.input.at))
    try:
        loops = Loops(skeleton)
        met = loops.followed(inputs - inputs[0])
    except AssertionError as error:
        return str(error)
    if not met.branch > 0.0:
        return "another branch"
    wanted = dials.output.place + dials.output.scale * (y - dials.output.at)
    errors = np.degrees(np.angle(pin - pivot) + met.turns) - wanted
    errors -= 360.0 * np.round(errors / 360.0)
    if np.abs(errors).max() > design.structural_error.max + 1e-7:
        return "another error"
    at = {"coupler": "B", "link_5": "D"}
    return "" if transmits(design, loops, met, at) else "transmission angle"


def table(tasks: int, seed: int) -> None:
    print(
        f"{'function':<26}{'fourbar':>10}{'at 25°':>10}"
        + "".join(f"{name:>14}" for name in TYPES)
        + f"{'share':>8}{'μ':>6}{'ratio':>7}{'CPU s':>7}{'wall s':>7}{'false':>7}"
    )
    for case in [*CASES[:tasks], LOGARITHM]:
        task = task_of(case)
        x = np.linspace(*task["function"]["x"], 41)
        y = measured_function(task["function"], x)
        limits = {"constraints": {"min_transmission_angle": LEAST, "max_link_ratio": None}, "seed": seed}
        fourbars = solved(task, **limits)[0].designs
        plain = fourbars[0].structural_error.max if fourbars else math.nan
        limits["constraints"] = {"min_transmission_angle": LEAST}
        best: dict[str, FunctionDesign] = {}
        processor = wall = 0.0
        wrong = driven = 0
        for name in TYPES:
            result, spent, took = solved(task, mechanisms=[name], **limits)
            processor, wall = processor + spent, wall + took
            sound = [design for design in result.designs if design.verification.passed]
            for design in sound:
                fault = false_claim(design, x, y)
                driven, wrong = driven + 1, wrong + bool(fault)
                if fault:
                    print(f"  {fault}: {design.mechanism.model_dump_json()}")
            if sound:
                best[name] = min(sound, key=lambda design: design.structural_error.max)
        first = min(best.values(), key=lambda design: design.structural_error.max)
        optimum = case["reference"]["value"]
        beside = plain if math.isnan(optimum) else optimum
        errors = (f"{best[name].structural_error.max:>14.7f}" if name in best else f"{'none':>14}" for name in TYPES)
        print(
            f"{case['id'].removeprefix('func_'):<26}{optimum:>10.6f}{plain:>10.6f}"
            + "".join(errors)
            + f"{first.structural_error.max / beside:>8.4f}{first.metrics.min_transmission_angle:>6.1f}"
            f"{first.metrics.link_ratio:>7.1f}{processor:>7.1f}{wall:>7.1f}{wrong:>4}/{driven}",
            flush=True,
        )
