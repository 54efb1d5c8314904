"""Planted problems that tests and benchmarks share: sixbars."""
