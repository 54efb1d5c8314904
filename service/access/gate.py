"""The gate: which tenant a request is for, and whether it has come too often.

Without keys the service is open, to this machine only (see :mod:`service.server.run`), and every request is for the
tenant :data:`ANYBODY`. From the first key on each request needs one.
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
"""How long the list of keys is taken for granted: so soon does a new key open and a revoked one close."""


@dataclass(frozen=True, slots=True)
class Allowance:
    """How much a key may still ask: requests left, seconds until they are all there again, and the rule."""

    left: int
    reset_s: int
    limit: int
    window_s: int

    def format_headers(self) -> dict[str, str]:
        """``RateLimit`` and ``RateLimit-Policy`` (draft-ietf-httpapi-ratelimit-headers)."""
        return {
            "RateLimit": f'"key";r={self.left};t={self.reset_s}',
            "RateLimit-Policy": f'"key";q={self.limit};w={self.window_s}',
        }


class NoKey(Exception):
    """The request needs a key and has none, or one that is not in force."""

    def __init__(self, given: bool) -> None:
        self.given = given
        super().__init__("a key is needed")


class TooOften(Exception):
    """The key has been used up for now."""

    def __init__(self, allowance: Allowance) -> None:
        self.allowance = allowance
        super().__init__("the rate limit is reached")


class Gate:
    """Lets requests in, each for a tenant. To be used on one event loop only."""

    def __init__(self, keys: KeyStore, rate_limit: str | None) -> None:
        self._keys = keys
        self._rate_limit = rate_limit
        self._holders: dict[str, Key] | None = None
        self._read_at = float("-inf")
        self._reading = asyncio.Lock()
        self._limiter: tuple[SlidingWindowCounterRateLimiter, RateLimitItem] | None = None

    async def admit(self, key: str | None) -> tuple[str, Allowance | None]:
        """The tenant of a request that came with ``key``, and what the key has left.

        Raises
        ------
        NoKey, TooOften
            When the request is not let in.
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
        """Whether there are no keys, so that requests need none."""
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
                # Its import takes a while, which a service without keys has no use for.
                self._limiter = await run_in_threadpool(_create_limiter, self._rate_limit)
            self._read_at = began


def _create_limiter(rate_limit: str) -> tuple[SlidingWindowCounterRateLimiter, RateLimitItem]:
    from limits import parse
    from limits.aio.storage import MemoryStorage
    from limits.aio.strategies import SlidingWindowCounterRateLimiter

    return SlidingWindowCounterRateLimiter(MemoryStorage()), parse(rate_limit)
