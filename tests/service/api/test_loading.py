"""Threads of the server import one after the other."""

from __future__ import annotations

import subprocess
import sys
import threading

import pytest

from service import render, warm_analysis
from service.loading import IMPORTS
from synthesis.dispatch import solve
from synthesis.registry import get_first_example, parse_problem


def drawn() -> None:
    problem = parse_problem(get_first_example("quick_return"))
    design = solve(problem, lambda fraction, message: None).designs[0]
    assert render.export_design(design, problem, "", "svg")


@pytest.mark.slow
@pytest.mark.parametrize("work", [drawn, warm_analysis.warm_up], ids=["drawing", "analyst"])
def test_who_imports_waits_for_another_import(work) -> None:
    work()
    thread = threading.Thread(target=work, daemon=True)
    with IMPORTS:
        thread.start()
        thread.join(1.0)
        assert thread.is_alive()
    thread.join(60.0)
    assert not thread.is_alive()


@pytest.mark.slow
def test_who_only_offers_files_loads_no_drawing_library() -> None:
    offered = (
        "import sys; from service.render import list_forms; from synthesis.registry import KINDS; "
        "assert all(list_forms(one) for kind in KINDS.values() for one in kind.mechanisms); "
        "print(sorted({'ezdxf', 'PIL', 'numba', 'scipy'} & set(sys.modules)))"
    )
    told = subprocess.run([sys.executable, "-c", offered], capture_output=True, text=True, check=True, timeout=100.0)
    assert told.stdout == "[]\n"
