"""Code that several tests share: request pools."""

from __future__ import annotations


async def never() -> bool:
    """A client that waits."""
    return False
