"""Entry point to all solvers."""

from __future__ import annotations

import time
from typing import Any

from kinematics.compiled import LINKAGES, is_compiled
from kinematics.linkage import warm
from synthesis.model.answer import Reachable, Result
from synthesis.model.counting import agreeing, counted
from synthesis.model.kind import Kind, Progress, part_of
from synthesis.model.linkage_statement import FORCES, LinkageProblem
from synthesis.model.statement import StatedProblem
from synthesis.outcome.forces import all_with_forces, unknown_told
from synthesis.outcome.front import front_of
from synthesis.outcome.layout import all_laid_out
from synthesis.outcome.manufacture import all_made
from synthesis.outcome.measured_order import GRIDDED, LOOKED_AT, in_order, least_first, searched_for, searched_on
from synthesis.outcome.rounding import on_grid
from synthesis.outcome.usable import usable_first
from synthesis.registry import KINDS
from synthesis.relaxation import Relaxation, relaxation

__all__ = [
    "Progress",
    "compile_demands",
    "compile_kind",
    "load_linkages",
    "solve",
    "warm_up",
    "warm_up_rest",
]

LOOK_PERIOD_S = 1.0
"""Period, seconds, of polling whether the kernels of a kind have been compiled, which a mark on disk shows."""

SEARCH_SHARE = 0.9
"""Share of the progress for the search; the rest is for the nearest miss if no design passed."""


def _silent(_fraction: float, _message: str) -> None:
    pass


def solve(problem: StatedProblem, progress: Progress | None = None) -> Result[Any]:
    """Solve a problem and verify every design.

    Parameters
    ----------
    problem : StatedProblem
        A problem without contradictions.
    progress : callable, optional
        Progress callback.

    Raises
    ------
    ContradictionError
        If ``problem.contradictions()`` is not empty.
    """
    problem.require_consistent()
    told = _silent if progress is None else progress
    kind = KINDS[problem.kind]
    asked = searched_for(problem)
    result: Result[Any] = kind.solve(asked, part_of(told, 0.0, SEARCH_SHARE))
    if not any(design.verification.passed for design in result.designs):
        told(SEARCH_SHARE, "no design found; searching the nearest miss")
        rest = part_of(told, SEARCH_SHARE, 1.0)
        result = _relaxed(asked, result, relaxation(asked, kind.solve, rest, kind.verify, kind.nearer))
    # Order matters: expensive measures first select and rank, rounding changes designs, and missing results come last.
    if isinstance(problem, LinkageProblem):
        if problem.rank_by in LOOKED_AT:
            measured = _measured(problem, result, problem.rank_by)
            result = searched_on(problem, measured, lambda narrower: kind.solve(narrower, _silent))
        if problem.manufacture is not None and problem.manufacture.gridded:
            result = _rounded(problem, result, kind)
        designs, remark = usable_first(searched_for(problem), result.designs)
        if problem.rank_by in LOOKED_AT:
            result = least_first(problem, result.model_copy(update={"designs": designs}))
        else:
            result = result.model_copy(update={"designs": designs, "summary": result.summary + remark})
        result = unknown_told(problem, _measured(problem, result, "planes", "yield", *FORCES))
        result = result.model_copy(update={"front": front_of(result.designs)})
    told(1.0, "verified")
    return result


def _measured(problem: LinkageProblem, result: Result[Any], *orders: str) -> Result[Any]:
    """Add the results that these orders need to the finished designs, if the problem has the blocks for them."""
    if "planes" in orders and problem.layout is not None:
        result = all_laid_out(problem.layout, result)
    if "yield" in orders and problem.manufacture is not None:
        result = all_made(problem, result)
    return all_with_forces(problem, result) if set(FORCES) & set(orders) else result


def _rounded(problem: LinkageProblem, result: Result[Any], kind: Kind[Any, Any]) -> Result[Any]:
    """Round designs to the grid; if they are ranked by a measured quantity, round only the best ones."""
    if problem.rank_by not in LOOKED_AT:
        return on_grid(problem, result, kind.nearly)
    first = in_order(problem, result.designs)[: max(problem.max_designs, GRIDDED)]
    every = problem.model_copy(update={"max_designs": len(first) or 1})
    rounded = on_grid(every, result.model_copy(update={"designs": first}), kind.nearly)
    return _measured(problem, rounded, problem.rank_by)


def _relaxed(problem: StatedProblem, result: Result[Any], found: Relaxation) -> Result[Any]:
    """Add designs found by ignoring constraints, or the nearest miss, to an answer without designs."""
    if not found.sound:
        miss = found.nearest_miss
        told = "" if miss is None else _longest_dwells(miss.reachable)
        return result.model_copy(update={"nearest_miss": miss, "summary": result.summary + told})
    designs = found.sound[: problem.max_designs]
    count, search = len(designs), result.search
    account = {"complete": False, "candidates": search.candidates + count, "accepted": count}
    those = f"{counted(count, 'design')}, found by ignoring the constraints,"
    summary = f"{those} {agreeing(count, 'satisfies', 'satisfy')} them anyway."
    return result.model_copy(
        update={
            "designs": [*designs, *result.designs][: problem.max_designs],
            "search": search.model_copy(update=account),
            "summary": summary,
        }
    )


def _longest_dwells(reachable: Reachable) -> str:
    longest = reachable.dwell_angles or ([] if reachable.dwell_angle is None else [reachable.dwell_angle])
    return f" The longest dwells found are {' and '.join(f'{angle:.4g}°' for angle in longest)}." if longest else ""


def warm_up() -> None:
    """Compile the kernels of the most common jobs or load them from cache; :func:`warm_up_rest` does the others."""
    motion = KINDS["motion"]
    solve(motion.problem.model_validate(motion.examples[0]))


def warm_up_rest() -> None:
    """Load everything else that the first jobs may need: the analysis core, and the solvers of all kinds.

    Each is loaded once its kernels have been compiled elsewhere: compiling them here would delay jobs.
    """
    waiting = [LINKAGES, *KINDS]
    while waiting:
        for part in [part for part in waiting if is_compiled(part)]:
            load_linkages() if part == LINKAGES else _load(part)
            waiting.remove(part)
        if waiting:
            time.sleep(LOOK_PERIOD_S)


def load_linkages() -> None:
    """Compile the kernels of the analysis of linkages or load them from cache."""
    warm.warm_up()


def compile_kind(name: str) -> None:
    """Compile all kernels that the solver of a kind may need: those that a worker loads, and those of its examples."""
    kind = KINDS[name]
    _load(name)
    if kind.warm_up is not None:
        for statement in kind.examples:
            solve(kind.problem.model_validate(statement))


def compile_demands() -> None:
    """Compile kernels that no example uses: for forces, manufacture, workspaces, and sixbars of each type.

    This includes motion sixbars on a given chain.
    """
    statement = KINDS["motion"].examples[0] | {
        "max_designs": 1,
        "dynamics": {"links": {"density": 1.0, "thickness": 1.0, "width": 1.0}, "speed_rpm": 1.0},
        "constraints": {"max_drive_torque": 1e6},
        "manufacture": {
            "round": {"length": 0.5, "coordinates": 0.5},
            "tolerances": {"length": 0.1},
            "quality": {"max_error": 1e3},
            "samples": 100,
        },
    }
    solve(KINDS["motion"].problem.model_validate(statement))
    positions = [{**position, "tolerance": 1.0} for position in KINDS["motion"].examples[0]["positions"]]
    room = {"box": [[-1e3, -1e3], [1e3, 1e3]], "obstacles": [{"circle": {"center": [900.0, 900.0], "radius": 1.0}}]}
    roomy = {"kind": "motion", "positions": positions, "space": room, "max_designs": 1}
    solve(KINDS["motion"].problem.model_validate(roomy))
    weighed = {name: statement[name] for name in ("dynamics", "constraints", "max_designs")}
    slides = {"kind": "motion", "positions": KINDS["motion"].examples[0]["positions"], "output_side": {"dyad": "PR"}}
    solve(KINDS["motion"].problem.model_validate(slides | weighed))
    turns = {"kind": "function", "pairs": [{"input": 20.0 * x, "output": 9.0 * x + x * x} for x in range(4)]}
    solve(KINDS["function"].problem.model_validate(turns | weighed))
    sixbars = {"mechanisms": ["stephenson_2", "stephenson_3"], "max_designs": 1}
    five = next(example["positions"] for example in KINDS["motion"].examples if example.get("mechanisms"))
    stated = {"kind": "motion", "positions": five, "mechanisms": ["watt_1"], "chain": {"elbow": "left"}}
    solve(KINDS["motion"].problem.model_validate(stated | {"max_designs": 1}))
    sine = {
        "kind": "function",
        "function": {"name": "sine", "x": [0.0, 90.0]},
        "input_range": 60.0,
        "output_range": 60.0,
    }
    solve(KINDS["function"].problem.model_validate(sine | sixbars))


def _load(name: str) -> None:
    """Load the kernels of a kind, by its ``warm_up`` or by solving its examples."""
    kind = KINDS[name]
    if kind.warm_up is not None:
        kind.warm_up()
        return
    for statement in kind.examples:
        solve(kind.problem.model_validate(statement))
