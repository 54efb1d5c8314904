"""Ordinary gear trains for a speed ratio: exhaustive search in exact arithmetic."""
