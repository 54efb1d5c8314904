"""Digests of the answers to every example of every kind, and to the machines of docs/gallery.

    python -m benchmarks.example_answers --processes 2 --output before.txt
    python -m benchmarks.example_answers --processes 2 --compare before.txt

Two revisions that print the same line for an example give the same answer to it, bit for bit. A digest covers every
number of the answer in its order (dimensions, metrics, values of checks, counts), booleans, and words without spaces,
such as the type of a mechanism, the name of a check or a fraction. It leaves out sentences, which may be reworded.

The exit status is 1 where a comparable answer differs from the file given by ``--compare``, or is missing in it.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from hashlib import sha256
from multiprocessing import get_context
from pathlib import Path
from time import process_time
from typing import Any

from synthesis.dispatch import solve
from synthesis.registry import KINDS, parse_problem

GALLERY = Path(__file__).parents[1] / "docs" / "gallery"
WORD = re.compile(r"[A-Za-z0-9_.:/\-]+")
DIGEST_LENGTH = 16

FORCE_RANKINGS = {"drive_torque", "joint_force", "shaking_force", "shaking_moment", "power", "joint_force_index"}
"""Values of ``rank_by`` whose search ends when its CPU time is used up."""

Statement = dict[str, Any]


def list_statements(kind: str | None) -> dict[str, Statement]:
    """Return the statements by name: ``KIND-NUMBER`` for examples, ``gallery/NAME`` for machines."""
    named = {f"{name}-{number}": one for name in KINDS for number, one in enumerate(KINDS[name].examples)}
    for path in sorted(GALLERY.glob("*.json")):
        named[f"gallery/{path.stem}"] = json.loads(path.read_text("utf-8"))["problem"]
    return {name: one for name, one in named.items() if kind in (None, one["kind"])}


def explain_incomparable(statement: Statement) -> str:
    """Return why two runs of the same code may differ, or nothing."""
    if statement.get("rank_by") in FORCE_RANKINGS:
        return f"its search for the least {statement['rank_by']} ends when its CPU time is used up"
    return ""


def iterate_values(value: Any) -> Iterator[str]:
    """Yield the numbers, booleans, nulls and words of an answer as texts, with the fields that they stand in."""
    if isinstance(value, dict):
        for field, member in value.items():
            yield field
            yield from iterate_values(member)
    elif isinstance(value, list):
        yield f"[{len(value)}"
        for member in value:
            yield from iterate_values(member)
    elif isinstance(value, float):
        yield value.hex()
    elif not isinstance(value, str):
        yield repr(value)
    elif WORD.fullmatch(value):
        yield value


def digest_answer(named: tuple[str, Statement]) -> tuple[str, str, float]:
    """Solve one statement. Return its name, a line without the name, and the CPU time in seconds."""
    name, statement = named
    begun = process_time()
    answer: dict[str, Any] = solve(parse_problem(statement)).model_dump(mode="json")
    elapsed = process_time() - begun
    # Texts may be reworded, and their messages have other values then.
    for field in ("summary", "messages"):
        answer.pop(field, None)
    digest = sha256("\n".join(iterate_values(answer)).encode()).hexdigest()[:DIGEST_LENGTH]
    line = f"{digest} {len(answer['designs']):3d} designs"
    if reason := explain_incomparable(statement):
        line += f"  not comparable: {reason}"
    return name, line, elapsed


def compare_digests(lines: dict[str, str], earlier: dict[str, str]) -> list[str]:
    """Return the names of comparable answers that differ, or that only one run has."""
    return [
        name
        for name in sorted({*lines, *earlier})
        if lines.get(name) != earlier.get(name) and "not comparable" not in lines.get(name, "")
    ]


def read_digests(path: Path) -> dict[str, str]:
    """Return the lines of an earlier run by the names of their statements."""
    lines = path.read_text("utf-8").splitlines()
    return {line.split()[0]: line.split(maxsplit=1)[1] for line in lines}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kind", choices=sorted(KINDS), help="solve the statements of this kind only")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--output", type=Path, help="write the lines to this file as well")
    parser.add_argument("--compare", type=Path, help="an earlier output; differences set the exit status")
    asked = parser.parse_args()

    statements = list_statements(asked.kind)
    lines: dict[str, str] = {}
    seconds: dict[str, float] = {}
    # A spawned process starts as one of a user does: it inherits no kernels and no random state.
    with ProcessPoolExecutor(asked.processes, mp_context=get_context("spawn")) as pool:
        for name, line, elapsed in pool.map(digest_answer, statements.items()):
            lines[name], seconds[name] = line, elapsed
            print(f"{name:28} {line}", flush=True)
    heaviest = sorted(seconds, key=seconds.__getitem__, reverse=True)[:5]
    listed = ", ".join(f"{name} {seconds[name]:.1f} s" for name in heaviest)
    print(f"{sum(seconds.values()):.0f} s of CPU; the most: {listed}", file=sys.stderr)

    if asked.output:
        asked.output.write_text("".join(f"{name:28} {line}\n" for name, line in lines.items()), "utf-8")
    if asked.compare:
        earlier = read_digests(asked.compare)
        if asked.kind:
            earlier = {name: line for name, line in earlier.items() if name in statements}
        different = compare_digests(lines, earlier)
        print(f"{len(different)} of {len(lines)} answers differ", *different, sep="\n  ")
        return 1 if different else 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
