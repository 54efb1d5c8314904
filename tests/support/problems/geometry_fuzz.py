"""Code that several tests share: geometry fuzz."""

from __future__ import annotations

import json
import re
import resource
import time
import traceback
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import TimeoutError as TooLate
from dataclasses import dataclass, field
from multiprocessing import get_context
from typing import Any

from pebble import ProcessExpired, ProcessPool
from pydantic import ValidationError

from synthesis.registry import KINDS, parse_problem
from tests.support.problems.geometry_cases import case

CPU_S = 30
"""What a case may take; nothing that is asked here is a long search."""

WALL_S = 600.0
"""After so long a case is given up on even where the machine has not given it its CPU time."""

_FIELD = re.compile("[a-z_]+")

DRAWN, ANIMATED = 5, 25
"""Of so many cases one is drawn in every form, where it has designs; but animated, which takes longer than most cases
need to be solved, one of so many."""


@dataclass(slots=True)
class Outcome:
    """What became of one case."""

    what: str
    where: str = ""
    cpu_s: float = 0.0
    wrong: bool = False


@dataclass(slots=True)
class Tally:
    """What became of all of them."""

    results: Counter[str] = field(default_factory=Counter)
    refusals: Counter[str] = field(default_factory=Counter)
    wrong: list[tuple[int, Outcome]] = field(default_factory=list)
    slowest: tuple[float, int] = (0.0, -1)

    def add(self, number: int, outcome: Outcome) -> None:
        """One more."""
        self.slowest = max(self.slowest, (outcome.cpu_s, number))
        if outcome.wrong:
            self.wrong.append((number, outcome))
        self.results[outcome.what] += 1
        if outcome.what == "refused":
            self.refusals[outcome.where] += 1


def run(kind: str, number: int) -> Outcome:
    """One case, in this process."""
    began = time.process_time()
    soft, hard = resource.getrlimit(resource.RLIMIT_CPU)
    resource.setrlimit(resource.RLIMIT_CPU, (int(began) + CPU_S + 1, hard))
    try:
        outcome = _way(kind, number)
    except Exception as error:  # whatever a case raises is what is counted, as wrong
        place = traceback.extract_tb(error.__traceback__)[-1]
        said = f"{type(error).__name__}: {error} ({place.filename.rpartition('/')[2]}:{place.lineno})"
        outcome = Outcome("exception", said[:300], wrong=True)
    finally:
        resource.setrlimit(resource.RLIMIT_CPU, (soft, hard))
    outcome.cpu_s = time.process_time() - began
    return outcome


def _way(kind: str, number: int) -> Outcome:
    from synthesis.dispatch import solve

    try:
        problem = parse_problem(case(kind, number))
    except ValidationError as error:
        return Outcome("refused", _field(error.errors()[0]["loc"]))
    faults = problem.find_contradictions()
    if faults:
        return Outcome("refused", re.sub("/[0-9]+", "", faults[0].path))
    result = solve(problem, lambda fraction, message: None)
    numbers = result.model_dump(mode="python")
    if _not_finite(numbers):
        return Outcome("NaN", _not_finite(numbers), wrong=True)
    stored = result.model_dump_json()
    json.loads(stored, parse_constant=_no_constant)
    designs = KINDS[kind].result.model_validate_json(stored).designs
    if not problem.include_failed and not all(design.verification.passed for design in designs):
        return Outcome("unverified", "a design that failed its checks", wrong=True)
    if designs and number % DRAWN == 0:
        nan = _drawn(designs[0], problem, number % ANIMATED == 0) or _moved(stored)
        if nan:
            return Outcome("NaN", nan, wrong=True)
    if designs:
        return Outcome("designs")
    return Outcome("none exists" if result.search.complete else "none found")


def _field(location: Iterable[str | int]) -> str:
    """A place without the numbers of list members and the names of models."""
    return "/" + "/".join(step for step in location if isinstance(step, str) and _FIELD.fullmatch(step))


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} in the JSON of the result")


def _not_finite(value: Any, path: str = "") -> str:
    """Where there is a number that is none; empty where all are."""
    if isinstance(value, float):
        return "" if value - value == 0.0 else f"{path} is {value}"
    members: Iterator[tuple[Any, Any]] = iter(())
    if isinstance(value, dict):
        members = iter(value.items())
    elif isinstance(value, list | tuple):
        members = enumerate(value)
    return next((found for key, member in members if (found := _not_finite(member, f"{path}/{key}"))), "")


def _drawn(design: Any, problem: Any, animated: bool) -> str:
    from service import render

    for form in render.list_forms(design.mechanism.type):
        if form == "gif" and not animated:
            continue
        try:
            drawn = render.export_design(design, problem, "fuzz", form)
        except render.NotBuilt:
            continue
        if isinstance(drawn, str) and form != "dxf" and any(word in drawn for word in ('"nan', ",nan", ">nan", "inf,")):
            return f"the .{form} file has a number that is none"
    return ""


def _moved(stored: str) -> str:
    from service.answers.designs import move_design
    from service.refusals import Refusal

    try:
        answer = json.loads(move_design(stored, "0", 36))
    except Refusal:
        return ""
    if "valid" in answer and not any(answer["valid"]):
        return "the motion of the design is not valid anywhere"
    return ""


def _begin(kind: str) -> None:
    """Have the kernels compiled before the first case, which is not to be blamed for it."""
    from synthesis.dispatch import compile_kind

    compile_kind(kind)


def tally(kind: str, numbers: Iterable[int], workers: int = 1) -> Tally:
    """All the cases, each in a process that can be ended."""
    counted = Tally()
    # A process that has run out of its time is replaced, and nobody else waits.
    with ProcessPool(max_workers=workers, context=get_context("spawn"), initializer=_begin, initargs=[kind]) as pool:
        asked = [(number, pool.schedule(run, args=[kind, number], timeout=WALL_S)) for number in numbers]
        for number, answer in asked:
            try:
                outcome = answer.result()
            except ProcessExpired:
                outcome = Outcome("hang", f"more than {CPU_S} s of CPU, or the process died", CPU_S, wrong=True)
            except TooLate:
                outcome = Outcome("hang", f"more than {WALL_S:g} s", CPU_S, wrong=True)
            counted.add(number, outcome)
    return counted
