"""Loops over many small cases in one test, which fail with the complete list of cases that fail."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import pytest


def check_each(cases: Iterable[Any], check: Callable[..., None]) -> None:
    """Run a check on every case, a tuple being several arguments; fail once, with all cases that failed and why."""
    count, failures = 0, []
    for case in cases:
        count += 1
        arguments = case if isinstance(case, tuple) else (case,)
        try:
            check(*arguments)
        except Exception as error:
            failures.append(f"{case}: {type(error).__name__}: {error}")
    assert count, "there are no cases"
    if failures:
        pytest.fail(f"{len(failures)} of {count} cases fail\n" + "\n".join(failures), pytrace=False)
