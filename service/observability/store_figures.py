"""Figures of the job store for the metrics, without the library of the metrics, which workers do not load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class StoreFigures:
    """Figures of the store: unfinished jobs by state, the age of the oldest queued one in seconds, sizes in bytes."""

    unfinished: Mapping[str, int]
    oldest_queued_s: float
    size_bytes: int
    free_bytes: int | None
    """Free space on the disk of a SQLite file; None for other databases."""
