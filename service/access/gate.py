"""The gate: finds the tenant of a request and enforces the rate limit.

Without keys the service is open to this machine only (see :mod:`service.server.run`), and every request belongs to the
tenant :data:`ANYBODY`. Once the first key exists, each request needs a key.
"""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING

from starlette.concurrency import run_in_threadpool

from service.access.keys import Key, KeyStore, hash_key

if TYPE_CHECKING:
    from limits import RateLimitItem
    from limits.aio.strategies import SlidingWindowCounterRateLimiter

ANYBODY = ""
"""The tenant of all requests to a service without keys."""

FRESH_S = 1.0
"""Time for which the list of keys is cached, seconds; new and revoked keys take effect after it."""


@dataclass(frozen=True, slots=True)
class Allowance:
    """Rate limit of a key: its remaining requests, the seconds until all are available again, and the rule."""

    left: int
    reset_s: int
    limit: int
    window_s: int

    def format_headers(self) -> dict[str, str]:
        """Return the headers ``RateLimit`` and ``RateLimit-Policy`` (draft-ietf-httpapi-ratelimit-headers)."""
        return {
            "RateLimit": f'"key";r={self.left};t={self.reset_s}',
            "RateLimit-Policy": f'"key";q={self.limit};w={self.window_s}',
        }


class NoKey(Exception):
    """The request needs a key and has none, or an invalid one."""

    def __init__(self, given: bool) -> None:
        self.given = given
        super().__init__("a key is needed")


class TooOften(Exception):
    """The key has reached its rate limit."""

    def __init__(self, allowance: Allowance) -> None:
        self.allowance = allowance
        super().__init__("the rate limit is reached")


class Gate:
    """Admits requests, each for a tenant. For use on one event loop only."""

    def __init__(self, keys: KeyStore, rate_limit: str | None) -> None:
        self._keys = keys
        self._rate_limit = rate_limit
        self._holders: dict[str, Key] | None = None
        self._read_at = float("-inf")
        self._reading = asyncio.Lock()
        self._limiter: tuple[SlidingWindowCounterRateLimiter, RateLimitItem] | None = None

    async def admit(self, key: str | None) -> tuple[str, Allowance | None]:
        """Return the tenant of a request with ``key``, and the allowance left to the key.

        Raises
        ------
        NoKey, TooOften
            If the request is not admitted.
        """
        await self._refresh()
        if self._holders is None:
            return ANYBODY, None
        holder = None if key is None else self._holders.get(hash_key(key))
        if holder is None:
            raise NoKey(given=key is not None)
        if self._limiter is None:
            return holder.tenant, None
        limiter, rule = self._limiter
        let_in = await limiter.hit(rule, holder.id)
        window = await limiter.get_window_stats(rule, holder.id)
        allowance = Allowance(
            left=window.remaining if let_in else 0,
            reset_s=max(1, ceil(window.reset_time - time.time())),
            limit=rule.amount,
            window_s=rule.get_expiry(),
        )
        if not let_in:
            raise TooOften(allowance)
        return holder.tenant, allowance

    async def is_open(self) -> bool:
        """Return whether no keys exist, so that requests need none."""
        await self._refresh()
        return self._holders is None

    async def _refresh(self) -> None:
        if time.monotonic() - self._read_at < FRESH_S:
            return
        async with self._reading:
            if time.monotonic() - self._read_at < FRESH_S:
                return
            began = time.monotonic()
            self._holders = await run_in_threadpool(self._keys.load_holders)
            if self._holders is not None and self._limiter is None and self._rate_limit is not None:
                # In a thread and on demand: the import takes a while, and a service without keys does not need it.
                self._limiter = await run_in_threadpool(_create_limiter, self._rate_limit)
            self._read_at = began


def _create_limiter(rate_limit: str) -> tuple[SlidingWindowCounterRateLimiter, RateLimitItem]:
    from limits import parse
    from limits.aio.storage import MemoryStorage
    from limits.aio.strategies import SlidingWindowCounterRateLimiter

    return SlidingWindowCounterRateLimiter(MemoryStorage()), parse(rate_limit)
