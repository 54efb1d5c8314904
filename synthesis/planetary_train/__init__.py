"""Planetary trains for a speed ratio: every combination of tooth numbers, in exact integers."""
