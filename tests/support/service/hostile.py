"""Bodies that no honest client sends, made of every kind's example: each of its fields in turn is spoilt."""

import copy
import json
from collections.abc import Iterator

from synthesis.registry import get_first_example

SPOILT = {
    "nan": "NaN",
    "infinite": "1e999",
    "5000 digits": "1" * 5000,
    "an object": '{"$gt": ""}',
    "lone surrogate": '"\\ud800"',
    "deep": "[" * 50_000 + "]" * 50_000,
}
_MARK = "@spoilt@"


def of_kind(kind: str) -> Iterator[tuple[str, bytes]]:
    """Each field of the example, outermost first, with each of the spoilt values in its place."""
    problem = get_first_example(kind)
    for path in _fields(problem):
        body = copy.deepcopy(problem)
        place = body
        for step in path[:-1]:
            place = place[step]
        place[path[-1]] = _MARK
        text = json.dumps({"problem": body})
        for name, value in SPOILT.items():
            yield f"{kind} {'/'.join(map(str, path))} {name}", text.replace(f'"{_MARK}"', value).encode()


def _fields(problem: dict[str, object]) -> list[tuple[str | int, ...]]:
    fields: list[tuple[str | int, ...]] = []
    for name, value in problem.items():
        fields.append((name,))
        if isinstance(value, dict):
            fields += [(name, inner) for inner in value]
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            fields += [(name, 0, inner) for inner in value[0]]
    return fields
