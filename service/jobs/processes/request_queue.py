"""The order in which a pool takes calls: tenants in turn, with a bound on long calls.

A call is *new* until it starts, and *long* once it has run longer than a short call may. The number of long calls that
run at once is bounded. A call that becomes long beyond this bound releases its process and waits with the long calls;
it starts again when its turn comes. So a process becomes free for a short call within a fraction of a second, even if
other tenants send long calls.
"""

from __future__ import annotations

import threading
import time
from collections import OrderedDict, deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any


@dataclass(eq=False)
class Call:
    """A function of a module, its arguments, and the number of requests that wait for its answer.

    ``abandoned`` is set when no request waits any more, ``running`` while a process executes the call. ``long`` means
    that the call turned out to be long, ``counted`` that it is counted among the running long calls.
    """

    work: Callable[..., object]
    args: tuple[object, ...]
    tenant: str
    future: Future[Any] = field(default_factory=Future)
    abandoned: threading.Event = field(default_factory=threading.Event)
    waiting: int = 0
    long: bool = False
    counted: bool = False
    running: bool = False


class _Rota:
    """Calls by tenant; each tenant in turn yields its oldest call."""

    def __init__(self) -> None:
        self._by_tenant: OrderedDict[str, deque[Call]] = OrderedDict()

    def append(self, call: Call, *, first: bool = False) -> None:
        calls = self._by_tenant.setdefault(call.tenant, deque())
        if first:
            calls.appendleft(call)
        else:
            calls.append(call)

    def pop(self) -> Call | None:
        """Return the next call that is not abandoned; None if there is none."""
        while self._by_tenant:
            tenant, calls = self._by_tenant.popitem(last=False)
            call = calls.popleft()
            # A tenant with further calls goes to the end of the line.
            if calls:
                self._by_tenant[tenant] = calls
            if not call.abandoned.is_set():
                return call
        return None

    def __len__(self) -> int:
        return sum(not call.abandoned.is_set() for calls in self._by_tenant.values() for call in calls)


class RequestQueue:
    """Waiting calls, and the count of running ones. Safe to use from all threads of a pool.

    Parameters
    ----------
    max_long : int
        Maximum number of long calls that run at once.
    """

    def __init__(self, max_long: int) -> None:
        self._max_long = max_long
        self._changed = threading.Condition()
        self._new, self._long = _Rota(), _Rota()
        self._running = self._running_long = 0
        self._closed = False

    def add(self, call: Call) -> None:
        """Queue a new call."""
        with self._changed:
            self._new.append(call)
            self._changed.notify()

    def take(self, timeout_s: float) -> Call | None:
        """Wait for the next call that may start; return None at the timeout or if the queue is closed."""
        latest = time.monotonic() + timeout_s
        with self._changed:
            while not self._closed:
                call = self._pop_next()
                if call is not None:
                    self._running += 1
                    return call
                left = latest - time.monotonic()
                if left <= 0.0:
                    return None
                self._changed.wait(left)
        return None

    def finish(self, call: Call) -> None:
        """Note that a call has ended, with or without an answer."""
        with self._changed:
            self._remove_running(call)

    def admit_as_long(self, call: Call) -> bool:
        """Count a running call as long; return False if the bound is reached and the call must release its process."""
        with self._changed:
            call.long = True
            if self._running_long >= self._max_long:
                return False
            self._running_long += 1
            call.counted = True
            return True

    def put_back(self, call: Call) -> None:
        """Queue a call that has released its process among the long calls, first of its tenant."""
        with self._changed:
            self._remove_running(call)
            self._long.append(call, first=True)
            self._changed.notify()

    def close(self) -> None:
        """Give out no further calls."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def count_calls(self) -> dict[str, int]:
        """Return the number of calls by state, for the metrics."""
        with self._changed:
            return {
                "running": self._running - self._running_long,
                "running_long": self._running_long,
                "waiting": len(self._new),
                "waiting_long": len(self._long),
            }

    def _remove_running(self, call: Call) -> None:
        self._running -= 1
        call.running = False
        if call.counted:
            self._running_long -= 1
            call.counted = False
        self._changed.notify()

    def _pop_next(self) -> Call | None:
        # Long calls first: their bound leaves the other processes to new calls, so neither sort starves.
        if self._running_long < self._max_long:
            call = self._long.pop()
            if call is not None:
                self._running_long += 1
                call.counted = True
                return call
        return self._new.pop()
