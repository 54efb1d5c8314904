"""What may be spent on looking for what comes nearest: a search is begun while one as long as those before still fits.

How long a search takes is known only afterwards, so the longest of its sort so far stands for the next. What is spent
then exceeds the allowance by no more than a search that is longer than all before, and by the first, which is always
made. Time is that of the processor: an answer does not get poorer because the machine is busy with others.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

MOST = 4.0
"""Seconds of processor time. Most tasks are searched in less than one; with one search of a second more than the rest
this leaves five."""


class Allowance:
    """Processor time of which several sorts of searches spend.

    Parameters
    ----------
    most : float
        Seconds.
    clock : callable, optional
        Seconds that were spent until now.
    """

    def __init__(self, most: float = MOST, clock: Callable[[], float] = time.process_time) -> None:
        self._most, self._clock = most, clock
        self._spent = 0.0

    def sort(self, search: Callable[..., Any]) -> Metered:
        """A sort of search that spends of this."""
        return Metered(self, search)

    def measured(self, search: Callable[..., Any], arguments: tuple[Any, ...]) -> tuple[Any, float]:
        """What a search finds, and its time, which is spent."""
        begun = self._clock()
        try:
            found = search(*arguments)
        finally:
            taken = self._clock() - begun
            self._spent += taken
        return found, taken

    def leaves(self, seconds: float) -> bool:
        """Whether so much may still be spent."""
        return self._spent + seconds <= self._most


class Metered:
    """A sort of search: called like the search itself."""

    def __init__(self, allowance: Allowance, search: Callable[..., Any]) -> None:
        self._allowance, self._search = allowance, search
        self._longest = 0.0

    def __call__(self, *arguments: Any) -> Any:
        """Search, whatever is left."""
        found, taken = self._allowance.measured(self._search, arguments)
        self._longest = max(self._longest, taken)
        return found

    @property
    def fits(self) -> bool:
        """Whether one more, as long as the longest so far, may be made."""
        return self._allowance.leaves(self._longest)
