"""Exhaustive search for tooth numbers."""
