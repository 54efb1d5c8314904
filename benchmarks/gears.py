"""Gears that are cut and turned against what the analysis says of them, and fitted trains against a brute force.

    python -m benchmarks.gears [--pairs 500] [--trains 100] [--typed 100] [--processes 3] [--seed 0]

Pairs, external and internal, are drawn at random and stated to the analysis `gear_pair`. The same gears are cut by a
rack, and rings by a cutter, point by point, and turned (`benchmarks.independent.cut_gears`): undercut, contact in
fillets, and of pairs without such faults play, contact ratio and tip thickness. Trains with centre distances and
profile shifts are searched by the solver and by a loop over all gears (`benchmarks.independent.fitted_trains`); so are
trains of typed stages (`benchmarks.independent.typed_trains`). Then as many fresh processes, which have their kernels
loaded but have fitted no such teeth, solve reverted trains of two stages, of which the CPU time is told.
"""

from __future__ import annotations

import argparse
import math
import multiprocessing
import resource
import time
from collections.abc import Iterable
from dataclasses import dataclass, field
from random import Random
from typing import Any

from benchmarks.independent import typed_trains
from benchmarks.independent.cut_gears import Run, external, involute_radius, is_undercut, rack, ring, run
from benchmarks.independent.fitted_trains import best_train, same_answer, statements
from synthesis.analyses import parse_request
from synthesis.dispatch import solve
from synthesis.kinds.gear_train.design import GearTrainResult
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.mechanisms.base import MechanismError
from synthesis.registry import parse_problem

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
    if request.faults():
        return None
    try:
        return request.answer()
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


TWO_STAGES: dict[str, Any] = {
    "kind": "gear_train",
    "ratio": "pi",
    "max_stages": 2,
    "teeth": {"min": 17, "max": 100},
    "reverted": True,
    "modules": [1.0, 1.25, 1.5, 2.0],
    "shift": {"min": -0.5, "max": 1.0},
}

DISTANCES: dict[str, Any] = {
    "no stated distance": {},
    "one distance": {"centre_distance": 120.0},
    "a range of distances": {"centre_distance": {"min": 60.0, "max": 140.0}},
}


def first_and_second(distance: dict[str, Any]) -> tuple[float, float]:
    """CPU seconds of a process for a train of two stages, and for the same once more; kernels are loaded before."""
    timed = Solved()
    timed.solve({**TWO_STAGES, **distance, "teeth": {"min": 17, "max": 24}, "shift": {"min": -0.4, "max": 0.9}})
    spent = [timed.spent]
    for _ in range(2):
        timed.solve({**TWO_STAGES, **distance})
        spent.append(timed.spent)
    return spent[1] - spent[0], spent[2] - spent[1]


def print_times(processes: int) -> None:
    """Of trains of two stages, each in as many fresh processes, one after another."""
    for name, distance in DISTANCES.items():
        with multiprocessing.get_context("spawn").Pool(1, maxtasksperchild=1) as pool:
            times = pool.map(first_and_second, [distance] * processes, chunksize=1)
        first, second = (", ".join(f"{one:.2f}" for one in column) for column in zip(*times, strict=True))
        print(f"two reverted stages of 17 to 100 teeth, four modules and shift, {name}: "
              f"{first} s of CPU, once more {second} s")  # fmt: skip


def main() -> None:
    """Print the comparisons and times."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=500)
    parser.add_argument("--trains", type=int, default=100)
    parser.add_argument("--typed", type=int, default=100)
    parser.add_argument("--processes", type=int, default=3)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    found = compare_pairs(options.pairs, options.seed)
    print(f"{found.pairs} pairs cut and turned: {found.sound} sound, {found.measured} measured, "
          f"{found.undercut} gears undercut, {found.in_fillet} pairs with contact in a fillet")  # fmt: skip
    for name, by in found.largest.items():
        print(f"  {name}: they differ by {by:.1e} at most")
    faults = list(found.faults)
    for name, told in (
        ("fitted", compare_trains(options.trains, options.seed)),
        ("typed", compare_typed(typed_trains.statements(options.typed, options.seed))),
    ):
        print(f"{told.some + told.none} {name} trains by brute force: {told.some} with an answer, {told.none} without; "
              f"solved in {told.spent:.1f} s of CPU")  # fmt: skip
        faults += told.faults
    for fault in faults:
        print("  FAULT", fault)
    if options.processes:
        print_times(options.processes)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"peak memory {peak:.0f} MiB")


if __name__ == "__main__":
    main()
