"""Progress of a solver, as a bar or through a callback."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Protocol

ProgressCallback = Callable[[float, str], None]
"""Callback with the completed share, from 0 to 1, and the present step."""

Progress = bool | ProgressCallback
"""How to show progress: True shows a bar, False shows nothing, and a callback receives the reports.

The bar needs tqdm (``tqdm.auto``); without it, lines are written to standard error.
"""


_FORMAT = "{desc}{percentage:3.0f} %|{bar}| {elapsed}"


def ignore_progress(_fraction: float, _message: str) -> None:
    """Ignore a progress report."""


@contextmanager
def open_progress(progress: Progress) -> Iterator[ProgressCallback]:
    """Yield the progress callback for a solver, and close its bar at the end."""
    if callable(progress):
        yield progress
    elif not progress:
        yield ignore_progress
    else:
        try:
            # tqdm is optional; its module `auto` shows a widget in notebooks.
            bar = importlib.import_module("tqdm.auto").tqdm(total=100, bar_format=_FORMAT, leave=False)
        except ImportError:
            yield _Lines().report
            return
        with bar:
            yield lambda fraction, message: _move_bar(bar, fraction, message)


class _Bar(Protocol):
    """Interface of a progress bar of tqdm."""

    n: float

    def set_description(self, desc: str, refresh: bool) -> None: ...

    def update(self, n: float) -> object: ...


def _move_bar(bar: _Bar, fraction: float, message: str) -> None:
    bar.set_description(message, refresh=False)
    # The progress of a solver may step back, but a bar may not.
    bar.update(max(0.0, round(100.0 * fraction) - bar.n))


class _Lines:
    """Progress as lines on standard error: one line for each new step, and one for each further 10 %."""

    def __init__(self) -> None:
        self._last: tuple[int, str] | None = None

    def report(self, fraction: float, message: str) -> None:
        step = int(10.0 * fraction), message
        if step != self._last:
            self._last = step
            sys.stderr.write(f"{100.0 * fraction:3.0f} % {message}\n")
