"""Planted problems that tests and benchmarks share: fit."""
