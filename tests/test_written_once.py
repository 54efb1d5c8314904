"""Nothing of more than a dozen lines stands twice in the product's code."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("kinematics", "synthesis", "service", "mechsynth")
MOST = 12
"""Lines of code that may stand in two places."""


def code_lines(source):
    """(line number, text) of the lines that do something: no blanks, comments, docstrings or imports."""
    left_out = set()
    for node in ast.walk(ast.parse(source)):
        says = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        if says or isinstance(node, ast.Import | ast.ImportFrom):
            left_out |= set(range(node.lineno, node.end_lineno + 1))
    lines = ((number, line.strip()) for number, line in enumerate(source.splitlines(), 1))
    return [(number, line) for number, line in lines if line and line[0] != "#" and number not in left_out]


def written_twice(sources):
    """Pairs of places (name, line) from which more than ``MOST`` lines of code are the same."""
    first, pairs = {}, []
    for name, source in sources.items():
        lines = code_lines(source)
        for k in range(len(lines) - MOST):
            run = tuple(text for _, text in lines[k : k + MOST + 1])
            place = name, lines[k][0]
            if first.setdefault(run, place) != place:
                pairs.append((first[run], place))
    return pairs


@pytest.mark.slow
def test_nothing_of_more_than_a_dozen_lines_stands_twice():
    files = [path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]
    assert len(files) > 300
    pairs = written_twice({str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in files})
    assert not pairs, "\n".join(f"{a}:{i} and {b}:{j}" for (a, i), (b, j) in pairs)


@pytest.mark.parametrize(("lines", "twice"), [(MOST, False), (MOST + 1, True)])
def test_what_stands_twice_is_seen(lines, twice):
    body = "".join(f"    x{k} = {k}\n" for k in range(lines))
    sources = {
        "a.py": f'def f():\n    """One."""\n{body}',
        "b.py": f"import a\n\n\ndef g():\n    # Two.\n{body}    a.f()\n",
    }
    assert bool(written_twice(sources)) == twice
