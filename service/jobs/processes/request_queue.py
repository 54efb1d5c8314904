"""The order in which a pool takes the calls of requests: tenants in turns, and long calls bounded.

A call is *new* until it has been begun, and *long* once it has run for longer than a short call does. At most so many
long calls run at once. A call that becomes long where that many run already gives its process up and waits as a long
one; it begins again when its turn comes. So a process is free for a short call after a fraction of a second, whatever
others have asked for.
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
    """A function of a module, its arguments, and who waits for what it returns.

    ``abandoned`` is set when nobody waits any more, ``running`` while a process does the call. ``long`` is whether the
    call has been found to be long, ``counted`` whether it is one of the long calls that run now.
    """

    work: Callable[..., Any]
    args: tuple[Any, ...]
    tenant: str
    future: Future[Any] = field(default_factory=Future)
    abandoned: threading.Event = field(default_factory=threading.Event)
    waiting: int = 0
    long: bool = False
    counted: bool = False
    running: bool = False


class _Rota:
    """Calls by tenant; each tenant in turn gives its oldest."""

    def __init__(self) -> None:
        self._by_tenant: OrderedDict[str, deque[Call]] = OrderedDict()

    def append(self, call: Call, *, first: bool = False) -> None:
        calls = self._by_tenant.setdefault(call.tenant, deque())
        if first:
            calls.appendleft(call)
        else:
            calls.append(call)

    def pop(self) -> Call | None:
        """The next call that somebody waits for."""
        while self._by_tenant:
            tenant, calls = self._by_tenant.popitem(last=False)
            call = calls.popleft()
            if calls:
                self._by_tenant[tenant] = calls
            if not call.abandoned.is_set():
                return call
        return None

    def __len__(self) -> int:
        return sum(not call.abandoned.is_set() for calls in self._by_tenant.values() for call in calls)


class RequestQueue:
    """Calls that wait, and how many long ones run. Safe to use from all threads of a pool.

    Parameters
    ----------
    max_long : int
        Long calls that run at once, at most.
    """

    def __init__(self, max_long: int) -> None:
        self._max_long = max_long
        self._changed = threading.Condition()
        self._new, self._long = _Rota(), _Rota()
        self._running = self._running_long = 0
        self._closed = False

    def put(self, call: Call) -> None:
        """Queue a new call."""
        with self._changed:
            self._new.append(call)
            self._changed.notify()

    def take(self, timeout_s: float) -> Call | None:
        """The next call that may begin; None where there is none for so long, or the queue is closed."""
        latest = time.monotonic() + timeout_s
        with self._changed:
            while not self._closed:
                call = self._next()
                if call is not None:
                    self._running += 1
                    return call
                left = latest - time.monotonic()
                if left <= 0.0:
                    return None
                self._changed.wait(left)
        return None

    def finish(self, call: Call) -> None:
        """The call has ended, however."""
        with self._changed:
            self._leave(call)

    def admit_as_long(self, call: Call) -> bool:
        """Count a running call as long; False where as many run as may, and the call is to give its process up."""
        with self._changed:
            call.long = True
            if self._running_long >= self._max_long:
                return False
            self._running_long += 1
            call.counted = True
            return True

    def put_back(self, call: Call) -> None:
        """Let a call that has given its process up wait for the turn of a long one."""
        with self._changed:
            self._leave(call)
            self._long.append(call, first=True)
            self._changed.notify()

    def close(self) -> None:
        """Give out nothing more."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def counts(self) -> dict[str, int]:
        """Calls by their state, for the metrics."""
        with self._changed:
            return {
                "running": self._running - self._running_long,
                "running_long": self._running_long,
                "waiting": len(self._new),
                "waiting_long": len(self._long),
            }

    def _leave(self, call: Call) -> None:
        self._running -= 1
        call.running = False
        if call.counted:
            self._running_long -= 1
            call.counted = False
        self._changed.notify()

    def _next(self) -> Call | None:
        # Long ones first: they leave the other processes to new ones, so that neither sort starves.
        if self._running_long < self._max_long:
            call = self._long.pop()
            if call is not None:
                self._running_long += 1
                call.counted = True
                return call
        return self._new.pop()
