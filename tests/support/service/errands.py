"""Code that several tests share: errands."""

from __future__ import annotations


async def never() -> bool:
    """A client that waits."""
    return False
