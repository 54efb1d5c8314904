"""Code that several tests share: gears."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from dataclasses import dataclass, field
from random import Random
from typing import Any

from synthesis.analyses import parse_request
from synthesis.dispatch import solve
from synthesis.kinds.gear_train.design import GearTrainResult
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.mechanisms.base import MechanismError
from synthesis.registry import parse_problem
from tests.support.independent import typed_trains
from tests.support.independent.cut_gears import Run, external, involute_radius, is_undercut, rack, ring, run
from tests.support.independent.fitted_trains import best_train, same_answer, statements

EQUAL = 1e-6
"""Modules, or a contact ratio, within which the two have to agree."""

NEAR_LIMIT = 1e-4
"""Modules from a limit within which verdicts may differ."""

ANGLES = (17.5, 20.0, 22.5, 25.0)


@dataclass
class Compared:
    """What a comparison of pairs found; ``faults`` are pairs about which the two do not agree."""

    pairs: int = 0
    sound: int = 0
    measured: int = 0
    undercut: int = 0
    in_fillet: int = 0
    largest: dict[str, float] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)

    def differ(self, name: str, by: float, pair: dict[str, Any]) -> None:
        """Take note of a difference."""
        self.largest[name] = max(self.largest.get(name, 0.0), abs(by))
        if not abs(by) <= EQUAL:
            self.faults.append(f"{name} differs by {by:.3g}: {pair}")


def drawn_pair(rng: Random, internal: bool) -> dict[str, Any]:
    """A pair at random, as it is stated, at the tight distance."""
    pinion = rng.randint(8, 60)
    pair: dict[str, Any] = {
        "type": "gear_pair",
        "internal": internal,
        "pressure_angle": rng.choice(ANGLES),
        "shift": [round(rng.uniform(-0.5, 1.0), 3) for _ in range(2)],
    }
    if internal:
        wheel = rng.randint(pinion + 5, pinion + 90)
        pair["cutter_teeth"] = rng.randint(12, max(12, min(40, wheel - 6)))
        pair["addendum"] = [1.0, round(rng.uniform(0.5, 1.0), 2)]
        # The sum of shifts decides over the distance: rings are shifted about as much as their pinions.
        pair["shift"][1] = round(pair["shift"][0] + rng.uniform(-0.3, 0.3), 3)
        # The cut ring is told its shift by its spaces at the reference circle, which has to lie on its teeth.
        pair["addendum"][1] = max(pair["addendum"][1], min(1.25, round(pair["shift"][1] + 0.05, 2)))
    else:
        wheel = rng.randint(8, 140)
    return {**pair, "teeth": [pinion, wheel]}


def analysed(pair: dict[str, Any]) -> dict[str, Any] | None:
    """What the analysis says; None where there is no such pair."""
    request = parse_request({"mechanism": pair})
    if request.find_errors():
        return None
    try:
        return request.build_answer()
    except MechanismError:
        return None


def compare_pairs(number: int, seed: int) -> Compared:
    """Cut, turn and compare as many random pairs, every other one internal, every third one with play."""
    rng, found = Random(seed), Compared()
    while found.pairs < number:
        pair = drawn_pair(rng, found.pairs % 2 == 1)
        said = analysed(pair)
        if said is not None and found.pairs % 3 == 0:
            inwards = -1.0 if pair["internal"] else 1.0
            pair["centre_distance"] = said["tight_distance"] + inwards * rng.uniform(0.01, 0.2)
            said = analysed(pair)
        if said is not None:
            found.pairs += 1
            compare_pair(pair, said, found)
    return found


def compare_pair(pair: dict[str, Any], said: dict[str, Any], found: Compared) -> None:
    """One pair: verdicts wherever they mean something, numbers where the teeth have no faults."""
    tool = rack(math.radians(pair["pressure_angle"]))
    addenda = [a - said["tip_shortening"] for a in pair.get("addendum", [1.0, 1.0])]
    bodies = [external(pair["teeth"][0], pair["shift"][0], addenda[0], tool)]
    if pair["internal"]:
        bodies.append(ring(pair["teeth"][1], pair["shift"][1], addenda[1], tool, pair["cutter_teeth"]))
    else:
        bodies.append(external(pair["teeth"][1], pair["shift"][1], addenda[1], tool))
    for gear, body in zip(said["gears"], bodies, strict=True):
        if gear["least_shift"] is None or abs(gear["shift"] - gear["least_shift"]) < 10.0 * NEAR_LIMIT:
            continue
        if gear["undercut"] != is_undercut(body):
            found.faults.append(f"undercut of {gear['teeth']} teeth: {pair}")
        found.undercut += gear["undercut"]
        begins = involute_radius(body)
        if begins < body.tip - NEAR_LIMIT and abs(0.5 * gear["form_diameter"] - begins) > NEAR_LIMIT:
            found.faults.append(f"involute of {gear['teeth']} teeth begins at {begins:.5f}: {pair}")
    thin = any(gear["tip_thickness"] is None or gear["tip_thickness"] <= 0.0 for gear in said["gears"])
    cut = any(gear["undercut"] for gear in said["gears"])
    if thin or cut or said["interference"] or said["tips_foul"] or said["ring_trimmed"]:
        return
    turned = run(said["centre_distance"], *bodies)
    for gear, fillet in zip(said["gears"], turned.in_fillet, strict=True):
        if abs(gear["involute_left"]) > NEAR_LIMIT and gear["fillet_interference"] != fillet:
            found.faults.append(f"fillet of {gear['teeth']} teeth: {pair}")
    found.sound += said["sound"]
    if said["sound"] and any(turned.in_fillet):
        found.faults.append(f"an accepted pair has contact in a fillet: {pair}")
    if any(gear["fillet_interference"] for gear in said["gears"]):
        found.in_fillet += 1
        return
    compare_numbers(pair, said, turned, found)


def compare_numbers(pair: dict[str, Any], said: dict[str, Any], turned: Run, found: Compared) -> None:
    """Play, contact ratio and tips of a pair without faults."""
    found.measured += 1
    found.differ("backlash", said["backlash"] - turned.backlash, pair)
    found.differ("backlash", said["backlash"] - turned.other_backlash, pair)
    found.differ("contact_ratio", said["contact_ratio"] - turned.contact_ratio, pair)
    for gear, thickness in zip(said["gears"], turned.tip_thickness, strict=True):
        found.differ("tip_thickness", gear["tip_thickness"] - thickness, pair)


@dataclass
class Solved:
    """Tasks that were solved and looked through by brute force: with an answer, without, faults, CPU seconds."""

    some: int = 0
    none: int = 0
    spent: float = 0.0
    faults: list[str] = field(default_factory=list)

    def solve(self, statement: dict[str, Any]) -> tuple[GearTrainResult, bool]:
        """The solver's answer, and whether it has to be complete."""
        problem = parse_problem(statement)
        assert isinstance(problem, GearTrainProblem)
        started = time.process_time()
        result = solve(problem, lambda fraction, message: None)
        self.spent += time.process_time() - started
        assert isinstance(result, GearTrainResult)
        return result, not problem.searches_distances

    def note(self, statement: dict[str, Any], answered: bool, fault: str | None) -> None:
        """Take note of a comparison."""
        self.some, self.none = (self.some + 1, self.none) if answered else (self.some, self.none + 1)
        if fault is not None:
            self.faults.append(f"{fault}: {statement}")


def compare_trains(number: int, seed: int) -> Solved:
    """Solve as many random tasks with distances and shifts."""
    found = Solved()
    for statement in statements(number, seed):
        result, decided = found.solve(statement)
        best = best_train(statement)
        found.note(statement, best is not None, same_answer(result.model_dump(), best, decided))
    return found


def compare_typed(tasks: Iterable[dict[str, Any]]) -> Solved:
    """Solve tasks of typed stages."""
    found = Solved()
    for statement in tasks:
        result, _ = found.solve(statement)
        best = typed_trains.nearest(statement)
        found.note(statement, best is not None, typed_trains.same_answer(result.model_dump(), best))
    return found
