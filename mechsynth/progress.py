"""How far a solver is: as a bar, or as whoever asks wants to be told."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

ProgressCallback = Callable[[float, str], None]
"""Is told the share that is done, from 0 to 1, and what is being done."""

Progress = bool | ProgressCallback
"""True: a bar, by ``tqdm.auto`` where tqdm is installed, otherwise lines on standard error. False: nothing."""


_FORMAT = "{desc}{percentage:3.0f} %|{bar}| {elapsed}"


def ignore_progress(_fraction: float, _message: str) -> None:
    """Tell nobody."""


@contextmanager
def open_progress(progress: Progress) -> Iterator[ProgressCallback]:
    """Whom a solver is to tell how far it is."""
    if callable(progress):
        yield progress
    elif not progress:
        yield ignore_progress
    else:
        try:
            bar = importlib.import_module("tqdm.auto").tqdm(total=100, bar_format=_FORMAT, leave=False)
        except ImportError:
            yield _Lines().report
            return
        with bar:
            yield lambda fraction, message: _move_bar(bar, fraction, message)


def _move_bar(bar: Any, fraction: float, message: str) -> None:
    bar.set_description(message, refresh=False)
    bar.update(max(0.0, round(100.0 * fraction) - bar.n))


class _Lines:
    """A line on standard error whenever something else is being done, or ten per cent more are."""

    def __init__(self) -> None:
        self._last: tuple[int, str] | None = None

    def report(self, fraction: float, message: str) -> None:
        step = int(10.0 * fraction), message
        if step != self._last:
            self._last = step
            sys.stderr.write(f"{100.0 * fraction:3.0f} % {message}\n")
