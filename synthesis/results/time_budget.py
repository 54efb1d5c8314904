"""Time budget of the nearest-miss search.

Another run of a search is started only if a run as long as the longest one so far still fits the budget: the duration
of a run is known only afterwards, and the longest run of the same search is the estimate for the next one. The budget
can be exceeded by the first run of a search, which is always made, and by one run that is longer than all before. It is
processor time, not elapsed time, so that answers do not become poorer while the machine is busy.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from typing import Generic, ParamSpec, TypeVar

Arguments = ParamSpec("Arguments")
Found = TypeVar("Found")

MAX_SEARCH_SHARE = 4.0
"""Default budget, seconds of processor time. Most searches take less than one second; one longer run may raise the
total to about five seconds."""


class SearchBudget:
    """Budget of processor time that several searches share.

    Parameters
    ----------
    most : float
        Budget, seconds.
    clock : callable, optional
        Returns the processor time used so far, seconds.
    """

    def __init__(self, most: float = MAX_SEARCH_SHARE, clock: Callable[[], float] = time.process_time) -> None:
        self._most, self._clock = most, clock
        self._spent = 0.0

    def meter_search(self, search: Callable[Arguments, Found]) -> MeteredSearch[Arguments, Found]:
        """Return a search that charges its time to this budget."""
        return MeteredSearch(self, search)

    def run_metered(self, search: Callable[[], Found]) -> tuple[Found, float]:
        """Run a search and charge its time to the budget; return its result and its time in seconds."""
        begun = self._clock()
        try:
            # `finally` charges the time of a search that raises, too.
            found = search()
        finally:
            taken = self._clock() - begun
            self._spent += taken
        return found, taken

    def has_left(self, seconds: float) -> bool:
        """Return whether this many seconds are left."""
        return self._spent + seconds <= self._most


class MeteredSearch(Generic[Arguments, Found]):
    """A search that charges its time to a budget. It is called like the search itself."""

    def __init__(self, allowance: SearchBudget, search: Callable[Arguments, Found]) -> None:
        self._allowance, self._search = allowance, search
        # Each search has its own longest run, because the searches differ in duration.
        self._longest = 0.0

    def __call__(self, *arguments: Arguments.args, **named: Arguments.kwargs) -> Found:
        """Run the search, even if the budget is used up."""
        found, taken = self._allowance.run_metered(partial(self._search, *arguments, **named))
        self._longest = max(self._longest, taken)
        return found

    @property
    def fits(self) -> bool:
        """Whether another run, as long as the longest so far, fits into the budget."""
        return self._allowance.has_left(self._longest)
